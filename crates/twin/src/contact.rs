//! Friction, in the variables in which it is simplest.
//!
//! A rate-independent model is a function of the travel since the last reversal; whoever moves the contact says
//! when it reverses. LuGre has a bristle, whose state z is carried by the integrator.

use crate::Friction;

/// A contact with its memory.
#[derive(Debug, Clone)]
pub(crate) struct Contact {
    law: Law,
    /// The bristle; without one, σ₀ = σ₁ = 0.
    pub(crate) bristle: Bristle,
    /// Viscous coefficient σ₂ [N·s/m].
    pub(crate) sigma_2: f64,
    /// Direction of motion since the last reversal, ±1; 0 while stuck.
    pub(crate) way: f64,
    /// Displacement at the last reversal [m].
    turned_at: f64,
}

/// The part of friction that knows no rate.
#[derive(Debug, Clone)]
enum Law {
    Free,
    Coulomb {
        f_c: f64,
    },
    /// `force` is the one at the last reversal [N].
    Dahl {
        f_c: f64,
        sigma: f64,
        gamma: f64,
        force: f64,
    },
    /// Stiffness, deadband, and deflection at the last reversal of each element.
    MaxwellSlip(Vec<[f64; 3]>),
}

/// The bristle of LuGre, ż = v − |v| z / r(v).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Bristle {
    /// Deflection in slow sliding F_S/σ₀ less that in fast sliding [m].
    drop: f64,
    /// Deflection in fast sliding F_C/σ₀ [m].
    fast: f64,
    /// Stribeck velocity v_S [m/s].
    v_s: f64,
    /// Stiffness σ₀ [N/m].
    pub(crate) sigma_0: f64,
    /// Damping σ₁ [N·s/m].
    pub(crate) sigma_1: f64,
}

impl Bristle {
    /// |v| / r(v) [1/s], and its slope over v [1/m].
    fn wear(&self, v: f64) -> (f64, f64) {
        let ratio = v / self.v_s;
        let dip = self.drop * (-ratio * ratio).exp();
        let r = self.fast + dip;
        let r_slope = -2.0 * ratio / self.v_s * dip;
        (v.abs() / r, v.signum() * (1.0 - v * r_slope / r) / r)
    }

    /// Deflection z in steady sliding r(v) [m].
    pub(crate) fn settled(&self, v: f64) -> f64 {
        let ratio = v / self.v_s;
        self.fast + self.drop * (-ratio * ratio).exp()
    }

    /// ż [m/s], its slope over v, and over z at constant v [1/s].
    pub(crate) fn rate(&self, v: f64, z: f64) -> (f64, f64, f64) {
        if self.sigma_0 == 0.0 {
            return (0.0, 0.0, 0.0);
        }
        let (wear, slope) = self.wear(v);
        (v - wear * z, 1.0 - slope * z, -wear)
    }
}

impl Friction {
    /// Coulomb level F_C, the force in long slow sliding but for Stribeck's [N]; 0 if there is none.
    pub(crate) fn level(&self) -> f64 {
        match self {
            Self::None { .. } => 0.0,
            Self::Coulomb { f_c, .. } | Self::Dahl { f_c, .. } | Self::LuGre { f_c, .. } => *f_c,
            Self::MaxwellSlip { k, delta, .. } => k.iter().zip(delta).map(|(k, d)| k * d).sum(),
        }
    }

    /// Slip that renews the contact [m]: a deflection of its bristles; for Coulomb's, which has none, 10 µm.
    pub(crate) fn grain(&self) -> f64 {
        match self {
            Self::None { .. } | Self::Coulomb { .. } => 1e-5,
            Self::Dahl { f_c, sigma, .. } => f_c / sigma,
            Self::LuGre { f_c, sigma_0, .. } => f_c / sigma_0,
            Self::MaxwellSlip { delta, .. } => delta.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }
}

impl Contact {
    /// A contact with relaxed bristles at displacement q.
    pub(crate) fn new(friction: &Friction, q: f64) -> Self {
        let mut bristle = Bristle::default();
        let (law, sigma_2) = match *friction {
            Friction::None { sigma_2 } => (Law::Free, sigma_2),
            Friction::Coulomb { f_c, sigma_2 } => (Law::Coulomb { f_c }, sigma_2),
            Friction::Dahl { f_c, sigma, gamma, sigma_2 } => {
                (Law::Dahl { f_c, sigma, gamma, force: 0.0 }, sigma_2)
            }
            Friction::LuGre { f_c, f_s, v_s, sigma_0, sigma_1, sigma_2 } => {
                let (fast, drop) = (f_c / sigma_0, (f_s - f_c) / sigma_0);
                bristle = Bristle { drop, fast, v_s, sigma_0, sigma_1 };
                (Law::Free, sigma_2)
            }
            Friction::MaxwellSlip { ref k, ref delta, sigma_2 } => {
                let elements = k.iter().zip(delta).map(|(k, delta)| [*k, *delta, 0.0]);
                (Law::MaxwellSlip(elements.collect()), sigma_2)
            }
        };
        Self { law, bristle, sigma_2, way: 0.0, turned_at: q }
    }

    /// Whether a reversal of the motion has to be told to it.
    pub(crate) fn remembers(&self) -> bool {
        !matches!(self.law, Law::Free)
    }

    /// The largest force that holds it without any motion [N]; 0 if every force moves it.
    pub(crate) fn hold(&self) -> f64 {
        if let Law::Coulomb { f_c } = self.law { f_c } else { 0.0 }
    }

    /// Whether it knows rest, as Coulomb's does.
    pub(crate) fn sticks(&self) -> bool {
        matches!(self.law, Law::Coulomb { .. })
    }

    /// Rate-independent force at q [N] and its slope [N/m].
    pub(crate) fn force(&self, q: f64) -> (f64, f64) {
        let travel = self.way * (q - self.turned_at);
        match &self.law {
            Law::Free => (0.0, 0.0),
            Law::Coulomb { f_c } => (self.way * f_c, 0.0),
            Law::Dahl { f_c, sigma, gamma, force } => {
                let left = left(1.0 - self.way * force / f_c, *gamma, sigma / f_c * travel);
                let slope = if left > 0.0 { sigma * left.powf(*gamma) } else { 0.0 };
                (self.way * f_c * (1.0 - left), slope)
            }
            Law::MaxwellSlip(elements) => elements.iter().fold((0.0, 0.0), |sum, element| {
                let [k, delta, _] = element;
                let z = deflection(element, self.way * travel);
                (sum.0 + k * z, sum.1 + if z.abs() < *delta { *k } else { 0.0 })
            }),
        }
    }

    /// The motion reverses at q and goes on this way (±1; 0 to stick).
    pub(crate) fn turn(&mut self, q: f64, way: f64) {
        let (now, _) = self.force(q);
        let moved = q - self.turned_at;
        match &mut self.law {
            Law::Dahl { force, f_c, .. } => *force = now.clamp(-*f_c, *f_c),
            Law::MaxwellSlip(elements) => {
                for element in elements {
                    element[2] = deflection(element, moved);
                }
            }
            Law::Free | Law::Coulomb { .. } => {}
        }
        self.turned_at = q;
        self.way = way;
    }
}

/// What is left to saturation, w = 1 ∓ F/F_C, after a travel of d in units of F_C/σ, where dw/dd = −w^γ.
fn left(start: f64, gamma: f64, d: f64) -> f64 {
    if gamma == 1.0 {
        return start * (-d).exp();
    }
    let power = 1.0 - gamma;
    (start.powf(power) - power * d).max(0.0).powf(1.0 / power)
}

/// Deflection of an element after a monotone motion since the last reversal [m].
fn deflection([_, delta, z]: &[f64; 3], moved: f64) -> f64 {
    (z + moved).clamp(-delta, *delta)
}
