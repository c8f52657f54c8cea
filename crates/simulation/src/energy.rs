//! Where the energy of a plant with friction goes.

use crate::Path;
use duhem::{Dahl, FrictionModel, Input, LuGre, MaxwellSlip, Plant, sgn};

/// The energy account of a plant over a span [J].
///
/// The parts are computed each for itself, so that their balance is a check of the solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// Work of the drive ∫ w dq.
    pub drive_work: f64,
    /// Kinetic energy, and that of the spring and the contact, at the end less that at the start.
    pub stored: f64,
    /// What friction turns into heat.
    pub dissipated: f64,
    /// The largest of work taken in, energy stored and heat on the way, to compare the balance with.
    pub scale: f64,
}

impl Energy {
    /// What the account leaves open: zero but for the error of the solution.
    pub fn residue(&self) -> f64 {
        self.drive_work - self.stored - self.dissipated
    }
}

/// A friction model with a known store of energy.
#[derive(Debug, Clone, PartialEq)]
pub enum Contact {
    /// Stores F²/2σ.
    Dahl(Dahl),
    /// Stores ½Σ kᵢzᵢ².
    MaxwellSlip(MaxwellSlip),
    /// Stores ½σ₀x².
    LuGre(LuGre),
}

impl Contact {
    /// The energy stored at the displacement `q` in the model's states `x` [J].
    pub fn stored(&self, q: f64, x: &[f64]) -> f64 {
        match self {
            Self::Dahl(model) => 0.5 * x[0] * x[0] / model.sigma,
            Self::LuGre(model) => 0.5 * model.sigma_0 * x[0] * x[0],
            Self::MaxwellSlip(model) => {
                model.k.iter().zip(x).map(|(k, x)| 0.5 * k * (q - x) * (q - x)).sum()
            }
        }
    }

    /// F u̇ less what is stored per time [W], in the state `y` = [q, v, x…]; of Maxwell-slip nothing, whose
    /// heat is that of finite slips.
    fn heating(&self, y: &[f64]) -> f64 {
        let (q, v, x) = (y[0], y[1], &y[2..]);
        match self {
            Self::Dahl(model) => {
                let w = 1.0 - x[0] / model.f_c * sgn(v);
                x[0] * v * (1.0 - w.abs().powf(model.gamma) * sgn(w))
            }
            Self::LuGre(model) => {
                let mut x_dot = [0.0];
                model.x_dot(x, q, v, &mut x_dot);
                model.force(x, &x_dot, q, v) * v - model.sigma_0 * x[0] * x_dot[0]
            }
            Self::MaxwellSlip(_) => 0.0,
        }
    }

    /// Σ kᵢzᵢ dxᵢ [J] from one node to the next: zᵢ = ±Δᵢ while an element slips.
    fn slip_heat(&self, from: &[f64], to: &[f64]) -> f64 {
        let Self::MaxwellSlip(model) = self else { return 0.0 };
        let element =
            |(k, (a, b)): (&f64, (&f64, &f64))| 0.5 * k * (from[0] - a + to[0] - b) * (b - a);
        model.k.iter().zip(from[2..].iter().zip(&to[2..])).map(element).sum()
    }
}

/// Nodes and weights of the Gauss–Legendre rule of order 6 on [0, 1].
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// The energy account of a solved plant, and the least heat on any interval between nodes [J], which is
/// negative only if friction gives energy back.
///
/// The solution may come from any method; between its nodes it is what [`Path`] says.
pub fn account(path: &Path, contact: &Contact, plant: &Plant, input: &Input) -> (Energy, f64) {
    let total = |y: &[f64]| {
        let (q, v) = (y[0], y[1]);
        0.5 * (plant.mass * v * v + plant.stiffness * q * q) + contact.stored(q, &y[2..])
    };
    let mut y = vec![0.0; path.states()];
    let (mut drive_work, mut dissipated, mut taken) = (0.0, 0.0, 0.0_f64);
    let (mut least, mut largest) = (0.0_f64, 0.0_f64);
    for (i, ends) in path.t().windows(2).enumerate() {
        let h = ends[1] - ends[0];
        let mut heat = contact.slip_heat(path.node(i), path.node(i + 1));
        for (node, weight) in GAUSS.iter().filter(|_| h > 0.0) {
            let t = ends[0] + node * h;
            path.state(t, &mut y);
            let power = plant.drive(input.u(t)) * y[1];
            drive_work += weight * h * power;
            taken += weight * h * power.abs();
            heat += weight * h * contact.heating(&y);
        }
        dissipated += heat;
        least = least.min(heat);
        largest = largest.max(total(path.node(i)));
    }
    let stored = path.end().map_or(0.0, |(_, end)| total(end) - total(path.node(0)));
    let scale = taken.max(largest).max(dissipated.abs());
    (Energy { drive_work, stored, dissipated, scale }, least)
}
