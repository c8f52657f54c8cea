//! A plant with friction, driven by a force.

use crate::{
    Motion,
    motion::{Pieces, jumps},
};
use duhem::{FrictionModel, Input, Plant, Slopes};
use integrate::{Dynamics, InitialValueProblem};

/// A plant with friction under a driving force w(t): the states are q, v and the model's x₁ … x_n, with
/// q̇ = v, v̇ = (w − k_s q − F)/m and ẋ the model's for u = q.
///
/// The right-hand side is smooth except where the drive has a corner, which is known beforehand, and
/// where v changes sign, which is not: a solver finds the reversals by itself or not at all.
#[derive(Debug)]
pub struct DrivenPlant {
    model: Box<dyn FrictionModel>,
    plant: Plant,
    input: Input,
    pieces: Pieces,
    scale: Vec<f64>,
}

impl DrivenPlant {
    /// The plant under `input` [N] or [A] with the friction of `model`, from `start` to `end` [s].
    pub fn new(
        model: Box<dyn FrictionModel>,
        plant: Plant,
        input: Input,
        span: (f64, f64),
    ) -> Self {
        let pieces = Pieces::new(span, jumps(&input, span));
        let (low, high) = input.range_on(span.0, span.1);
        let force = plant.drive(low).abs().max(plant.drive(high).abs());
        let scale = scale(model.as_ref(), &plant, force);
        Self { model, plant, input, pieces, scale }
    }

    /// The friction model.
    pub fn model(&self) -> &dyn FrictionModel {
        self.model.as_ref()
    }

    /// The plant.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// What drives it.
    pub fn input(&self) -> &Input {
        &self.input
    }

    /// First and last time [s].
    pub fn span(&self) -> (f64, f64) {
        (self.pieces.times[0], self.pieces.times[self.pieces.times.len() - 1])
    }

    /// The driving force w [N] at time `t` [s].
    pub fn drive(&self, t: f64) -> f64 {
        self.plant.drive(self.input.u(t))
    }
}

impl Motion for DrivenPlant {
    fn problem(&self, y0: Vec<f64>) -> InitialValueProblem<'_> {
        self.pieces.problem(self, y0)
    }

    fn corners(&self) -> &[f64] {
        self.pieces.corners()
    }

    fn force(&self, _t: f64, y: &[f64]) -> f64 {
        let mut x_dot = vec![0.0; y.len() - 2];
        self.model.x_dot(&y[2..], y[0], y[1], &mut x_dot);
        self.model.force(&y[2..], &x_dot, y[0], y[1])
    }

    fn response(&self, _t: f64, y: &[f64]) -> f64 {
        y[0]
    }
}

impl Dynamics for DrivenPlant {
    fn dimension(&self) -> usize {
        2 + self.model.states()
    }

    fn derivative(&self, t: f64, y: &[f64], _piece: Option<usize>, dy: &mut [f64]) {
        let (q, v, x) = (y[0], y[1], &y[2..]);
        let (motion, x_dot) = dy.split_at_mut(2);
        self.model.x_dot(x, q, v, x_dot);
        let friction = self.model.force(x, x_dot, q, v);
        motion[0] = v;
        motion[1] = self.plant.acceleration(q, self.drive(t), friction);
    }

    /// By the chain rule through ẋ; at v = 0 the mean of both directions.
    fn jacobian(&self, _t: f64, y: &[f64], _piece: Option<usize>, jacobian: &mut [f64]) {
        let (q, v, x) = (y[0], y[1], &y[2..]);
        let (n, m) = (x.len(), self.plant.mass);
        let mut slopes = Slopes::new(n);
        let mut by_x = vec![0.0; n * n];
        self.model.slopes(x, q, v, &mut slopes);
        self.model.jacobian(x, q, v, &mut by_x);
        let through_x_dot = |column: &mut dyn Iterator<Item = f64>| -> f64 {
            slopes.force_by_x_dot.iter().zip(column).map(|(f, x_dot)| f * x_dot).sum()
        };
        let by_q = slopes.force_by_u + through_x_dot(&mut slopes.x_dot_by_u.iter().copied());
        let by_v =
            slopes.force_by_u_dot + through_x_dot(&mut slopes.x_dot_by_u_dot.iter().copied());
        let (motion, rest) = jacobian.split_at_mut(2 * (n + 2));
        let (first, second) = motion.split_at_mut(n + 2);
        first.fill(0.0);
        first[1] = 1.0;
        second[0] = -(self.plant.stiffness + by_q) / m;
        second[1] = -by_v / m;
        for j in 0..n {
            let by_x_j =
                slopes.force_by_x[j] + through_x_dot(&mut by_x.iter().skip(j).step_by(n).copied());
            second[2 + j] = -by_x_j / m;
        }
        for (i, row) in rest.chunks_exact_mut(n + 2).enumerate() {
            row[0] = slopes.x_dot_by_u[i];
            row[1] = slopes.x_dot_by_u_dot[i];
            row[2..].copy_from_slice(&by_x[i * n..(i + 1) * n]);
        }
    }

    fn scale(&self) -> Vec<f64> {
        self.scale.clone()
    }
}

/// The natural size of q, v and x, by which absolute tolerances are chosen. One for all misses whole
/// slips: in the staircase of Figure 14 q goes to 5 m while a slip begins in a contact that is
/// deflected by 1.5e-5 m.
///
/// - q: how far the largest driving force stretches the spring, and not less than the friction can;
///   without a spring the contact stands for it, and where nothing holds the mass, one second of flight.
/// - v: the speed at which the mass rings on the stiffness of the contact when that is deflected to its
///   limit, or the speed over which the friction changes by itself (v_S) if that is less. It is what
///   the friction feels, and far below the speed of a slip.
/// - x: the model's own.
fn scale(model: &dyn FrictionModel, plant: &Plant, largest_force: f64) -> Vec<f64> {
    let x = model.scale();
    let mut slopes = Slopes::new(x.len());
    // The slowest motion there is, so that the contact is felt as it sticks.
    model.slopes(&vec![0.0; x.len()], 0.0, f64::MIN_POSITIVE, &mut slopes);
    let through_x = slopes.force_by_x.iter().zip(&slopes.x_dot_by_u_dot).map(|(f, x)| f * x);
    let contact = slopes.force_by_u + through_x.sum::<f64>();
    let friction = if x.is_empty() {
        model.force(&[], &[], 0.0, 1.0).abs()
    } else {
        slopes.force_by_x.iter().zip(&x).map(|(f, x)| (f * x).abs()).sum()
    };
    let springs = [plant.stiffness, contact, plant.mass];
    let holds = springs.into_iter().find(|k| *k > 0.0).unwrap_or(1.0);
    let q = largest_force.max(friction) / holds;
    let deflection = if contact > 0.0 { friction / contact } else { q };
    let ringing = deflection * ((holds + contact) / plant.mass).sqrt();
    let v = model.natural_speed().map_or(ringing, |speed| speed.min(ringing));
    [vec![q, v], x].concat()
}
