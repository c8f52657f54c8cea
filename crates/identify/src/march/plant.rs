//! The plant as the march sees it: one equation for all five kinds.

use super::{
    Contact, Real,
    run::{Shown, Tolerance},
};
use crate::effects::{Acts, At, Past, Sense, Term};

/// What drives the plant beside friction: T = gain·u + constant − stiffness·q − damping·v − gravity·sin q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance<D> {
    /// Mass M [kg] or inertia [kg·m²].
    pub mass: D,
    /// Driving force per unit of input [N per unit].
    pub gain: D,
    /// Constant driving force [N].
    pub constant: D,
    /// Stiffness [N/m].
    pub stiffness: D,
    /// Damping that is no friction of the contact, as a motor's back-EMF [N·s/m].
    pub damping: D,
    /// Largest moment of gravity m g l [N·m].
    pub gravity: D,
    /// The torque of each cable of a drum at q = 0 [N·m], and by how much it grows with q, or falls [N·m/rad]; their
    /// difference is part of `constant` and `stiffness`.
    pub cables: [[D; 2]; 2],
}

impl<D: Real> Balance<D> {
    /// A `mass` [kg] that its input drives with so many newtons, and nothing else.
    pub fn alone(mass: D) -> Self {
        let none = D::from(0.0);
        Self {
            mass,
            gain: D::from(1.0),
            constant: none,
            stiffness: none,
            damping: none,
            gravity: none,
            cables: [[none; 2]; 2],
        }
    }
}

/// A plant and its friction.
#[derive(Debug, Clone, PartialEq)]
pub struct Model<D> {
    /// The plant.
    pub balance: Balance<D>,
    /// The friction.
    pub contact: Contact<D>,
    /// Viscous coefficient σ₂ [N·s/m].
    pub sigma_2: D,
    /// A constant force on the side of the friction [N].
    pub offset: D,
    /// Radius of a drum [m], 1 for others.
    pub radius: f64,
    /// The effects that are part of the model.
    pub effects: Vec<Term<D>>,
}

impl<D: Real> Model<D> {
    /// The force [N] on the mass, all but the friction of the contact and of the effects, at the input `u`.
    pub fn drive(&self, u: D, q: D, v: D) -> D {
        self.rest(self.driving(u), q, v)
    }

    /// What drives the plant [N] at the recorded input `u`.
    pub(super) fn driving(&self, u: D) -> D {
        let mut u = u;
        for e in &self.effects {
            e.kind.input(&e.p, &mut u);
        }
        let mut force = self.balance.gain * u;
        for e in &self.effects {
            e.kind.drive(&e.p, &mut force);
        }
        force
    }

    /// The force on the mass [N] where the drive is `driving`.
    fn rest(&self, driving: D, q: D, v: D) -> D {
        let b = &self.balance;
        let mut force =
            driving + b.constant - b.stiffness * q - (b.damping + self.sigma_2) * v - self.offset;
        if b.gravity.re() != 0.0 {
            force -= b.gravity * q.sin();
        }
        force
    }

    /// The mass [kg] that moves.
    pub(super) fn mass(&self) -> D {
        let mut mass = self.balance.mass;
        for e in &self.effects {
            if e.kind.joins(&e.p) {
                mass = mass / (e.p[1] + 1.0);
            } else {
                e.kind.mass(&e.p, &mut mass);
            }
        }
        mass
    }

    /// The number of states, the contact's and then the effects'.
    pub fn states(&self) -> usize {
        self.contact.states() + self.effects.iter().map(|e| e.kind.states()).sum::<usize>()
    }

    /// The force on the mass [N] at a stage that ends at `q` with the velocity `v`, its states from `base`
    /// written to `z`; where Coulomb friction slides in the direction `way`, with its force.
    pub(super) fn force(
        &self,
        stage: &Stage<D>,
        base: &[D],
        (q, v, way): (D, D, f64),
        z: &mut [D],
    ) -> D {
        let n = self.contact.states();
        let mut force = self.rest(stage.driving, q, v);
        let dry = self.contact.dry();
        if self.effects.is_empty() {
            let friction = self.contact.stage(&base[..n], stage.dt, (v, None, None), &mut z[..n]);
            if let (Some(f_c), true) = (dry, way != 0.0) {
                force -= f_c * way;
            }
            return force - friction;
        }
        let at = self.at(stage, [q, v], &base[..n]);
        let mut all = self.acts(&at, &base[n..], &mut z[n..]);
        let how = (v, all.rise, all.level);
        let friction = self.contact.stage(&base[..n], stage.dt, how, &mut z[..n]);
        all.risen(|| self.contact.level(), self.contact.bristles());
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        force -= all.grown(friction, sign(friction.re()));
        if let Some(more) = all.force {
            force -= more;
        }
        if let Some(more) = all.viscous(self.sigma_2, v) {
            force -= more;
        }
        if way != 0.0 {
            let level = |f_c: D| all.level.map_or(f_c, |share| f_c + f_c * share);
            let mut held = dry.map_or(D::from(0.0), |f_c| all.grown(level(f_c), way));
            if let Some(more) = all.dry {
                held += more;
            }
            force -= held * way;
        }
        force
    }

    /// An instant, as the effects see it; the contact began the stage with the states `base`.
    fn at<'a>(&'a self, stage: &Stage<D>, [q, v]: [D; 2], base: &'a [D]) -> At<'a, D> {
        let (t, dt, radius) = (stage.t, stage.dt, self.radius);
        let (balance, drive, mass) = (&self.balance, stage.driving, stage.mass);
        let contact = (&self.contact, base);
        At { t, dt, drive, q, v, radius, contact, balance, mass }
    }

    /// Where the load's states begin among all, if it is not one with the motor.
    pub(super) fn joint(&self) -> Option<usize> {
        let mut first = self.contact.states();
        for e in &self.effects {
            if e.kind.joins(&e.p) {
                return Some(first);
            }
            first += e.kind.states();
        }
        None
    }

    /// Whether the displacement that is measured is the motor's, with a load beyond it.
    pub(crate) fn hides_load(&self) -> bool {
        self.effects.iter().any(|e| e.kind.joins(&e.p) && crate::effects::hides_load(&e.p))
    }

    /// The displacement that is measured [m]: the load's, if it is not hidden.
    pub(super) fn displacement(&self, q: D, z: &[D]) -> D {
        self.joint().filter(|_| !self.hides_load()).map_or(q, |first| z[first])
    }

    /// The motor's displacement [m] where the one that is measured is `q`, the load's speed `v`, driven by the input `u` `how`
    /// [`Joint::ahead`](crate::effects::Joint::ahead) has it; the load's own goes to the states `z`.
    pub(crate) fn motor(&self, u: D, [q, v]: [D; 2], how: (f64, D), z: &mut [D]) -> D {
        let Some(first) = self.joint() else { return q };
        (z[first], z[first + 1]) = (q, v);
        let stage = Stage::of(self, [0.0, 0.0], u);
        let at = self.at(&stage, [q, v], &z[..self.contact.states()]);
        let joint = self.effects.iter().find_map(|e| e.kind.joint(&e.p, &at));
        let Some(joint) = joint else { return q };
        let ahead = joint.ahead(&at, how);
        z[first + 2] = joint.gives * how.0;
        if self.hides_load() {
            z[first] = q - ahead;
            return q;
        }
        q + ahead
    }

    /// What the effects add to the friction, all together.
    pub(crate) fn acts(&self, at: &At<D>, base: &[D], z: &mut [D]) -> Acts<D> {
        let mut all = Acts::none();
        let mut first = 0;
        for e in &self.effects {
            let end = first + e.kind.states();
            let (base, z) = (&base[first..end], &mut z[first..end]);
            let act = if let Some(joint) = e.kind.joint(&e.p, at) {
                joint.act(at, base, z)
            } else {
                z.copy_from_slice(base);
                e.kind.act(&e.p, at, base, z)
            };
            all.add(act);
            first = end;
        }
        all
    }

    /// The states of the contact at rest at the time `t` [s] that hold what the effects, in the states `others`, leave
    /// of the drive at the input `u`. What a joint passes on is not known before the load is: it counts as the springs
    /// and the weight of a load at rest.
    pub fn holding(&self, (t, u): (f64, D), [q, v]: [D; 2], others: &[D]) -> Vec<D> {
        let force = self.drive(u, q, v);
        // As if there were no effects: of its state they see only what share of its level it holds.
        let z = self.contact.holding(force);
        if self.effects.is_empty() {
            return z;
        }
        let at = self.at(&Stage::of(self, [t, 0.0], u), [q, v], &z);
        let (mut all, mut first, mut after) = (Acts::none(), 0, others.to_vec());
        for e in &self.effects {
            let end = first + e.kind.states();
            if !e.kind.joins(&e.p) {
                all.add(e.kind.act(&e.p, &at, &others[first..end], &mut after[first..end]));
            }
            first = end;
        }
        all.risen(|| self.contact.level(), self.contact.bristles());
        let mut left = all.force.map_or(force, |more| force - more);
        if let Some(more) = all.viscous(self.sigma_2, v) {
            left -= more;
        }
        let way = if left.re() == 0.0 { 0.0 } else { left.re().signum() };
        let share = all.share(way).map_or(D::from(1.0), |share| share + 1.0);
        // Friction that pushes holds nothing: then as if it were the nominal one.
        let left = if share.re() > 0.0 { left / share } else { left };
        self.contact.raised(all.rise, all.level).holding(left)
    }

    /// Whether friction can hold whatever the velocity does next.
    pub(super) fn sticks(&self) -> bool {
        self.contact.dry().is_some() || self.effects.iter().any(|e| e.kind.dry())
    }

    /// The states of the effects after long sliding in the direction `way`, or at rest if it is 0.
    pub fn effects_from(&self, way: f64, past: Past<'_>) -> Vec<D> {
        let grain = self.contact.grain();
        let of = |e: &'_ Term<D>| -> Vec<D> {
            (0..e.kind.states()).map(|i| e.kind.start(&e.p, i, (way, grain, past))).collect()
        };
        self.effects.iter().flat_map(of).collect()
    }

    /// What a step may be wrong by in every state: the contact's by its own size, the load's as the motor's, those of
    /// other effects of 1.
    pub(super) fn allowed(&self, tolerance: &Tolerance) -> Vec<f64> {
        let mut allowed = vec![tolerance.z; self.states()];
        allowed[..self.contact.states()].fill(tolerance.z * self.contact.scale());
        if let Some(first) = self.joint() {
            allowed[first..first + 2].copy_from_slice(&[tolerance.q, tolerance.v]);
        }
        allowed
    }

    /// By how much the input comes late [s], where it does.
    pub(crate) fn delay(&self) -> Option<D> {
        self.effects.iter().find_map(|e| e.kind.delay(&e.p))
    }

    /// What the sensors show of the displacement and the velocity [m, m/s], at the first sample beside what is `shown` there;
    /// `memory` has a number for each effect.
    pub(super) fn senses(
        &self,
        [q, v, bulge, slope, bend]: [D; 5],
        ([rate, dt], shown): ([f64; 2], Option<Shown>),
        memory: &mut [D],
    ) -> [D; 2] {
        let mut sense = Sense { q, v, bulge, slope, bend, rate, dt, shown };
        for (e, memory) in self.effects.iter().zip(memory) {
            e.kind.sense(&e.p, &mut sense, memory);
        }
        [sense.q, sense.v]
    }

    /// The same with every number turned into another kind.
    pub fn map<E: Real>(&self, to: impl Fn(D) -> E) -> Model<E> {
        let b = &self.balance;
        Model {
            balance: Balance {
                mass: to(b.mass),
                gain: to(b.gain),
                constant: to(b.constant),
                stiffness: to(b.stiffness),
                damping: to(b.damping),
                gravity: to(b.gravity),
                cables: b.cables.map(|cable| cable.map(&to)),
            },
            contact: self.contact.map(&to),
            sigma_2: to(self.sigma_2),
            offset: to(self.offset),
            radius: self.radius,
            effects: self.effects.iter().map(|e| e.map(&to)).collect(),
        }
    }
}

/// Where and when a stage is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stage<D> {
    /// Time since the record began [s].
    pub(super) t: f64,
    /// Its own share of the step, γh [s].
    pub(super) dt: f64,
    /// What drives the plant [N].
    pub(super) driving: D,
    /// The mass that moves [kg].
    pub(super) mass: D,
}

impl<D: Real> Stage<D> {
    /// At the time `t` [s] with the share `dt` [s] of the step, where the recorded input is `u`.
    pub(super) fn of(model: &Model<D>, at: [f64; 2], u: D) -> Self {
        Self::moving(model.mass(), model, at, u)
    }

    /// The same where the model's [`Model::mass`] is known: it is the same all along a motion.
    pub(super) fn moving(mass: D, model: &Model<D>, [t, dt]: [f64; 2], u: D) -> Self {
        Self { t, dt, driving: model.driving(u), mass }
    }
}
