//! The terms of which a plant's force is the sum: what each column of the regression is.

/// A column, as a function of position, velocity and acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// q̈ [m/s²] or [rad/s²].
    Acceleration,
    /// q̇ [m/s] or [rad/s].
    Velocity,
    /// sgn q̇ [1]: 0 at rest.
    Direction,
    /// q [m] or [rad].
    Position,
    /// sin q [1].
    Sine,
    /// 1.
    One,
    /// q̇ where it is positive, and 0 [m/s] or [rad/s].
    VelocityUp,
    /// q̇ where it is negative, and 0 [m/s] or [rad/s].
    VelocityDown,
    /// 1 where q̇ is positive, and 0.
    Up,
    /// −1 where q̇ is negative, and 0.
    Down,
}

impl Column {
    /// Its value at the position `q`, the velocity `v` and the acceleration `a`, in SI units.
    pub fn at(self, q: f64, v: f64, a: f64) -> f64 {
        match self {
            Self::Acceleration => a,
            Self::Velocity => v,
            Self::Direction => duhem::sgn(v),
            Self::Position => q,
            Self::Sine => q.sin(),
            Self::One => 1.0,
            Self::VelocityUp => v.max(0.0),
            Self::VelocityDown => v.min(0.0),
            Self::Up => f64::from(u8::from(v > 0.0)),
            Self::Down => -f64::from(u8::from(v < 0.0)),
        }
    }
}

/// A term: a parameter times a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    /// The parameter's key.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is multiplied by.
    pub column: Column,
}

/// A plant that is linear in its parameters, without its friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Linear {
    /// Its kind, as a rig file names it.
    pub kind: &'static str,
    /// Whether it turns: units of torque and angle.
    turns: bool,
    /// Inertia and what holds it.
    body: &'static [Term],
}

/// The plants whose force is linear in their parameters.
///
/// - `axis`: F_e = M q̈ + F
/// - `mass-spring`: F_e = m q̈ + k_s q + F
/// - `drum`: k_m i = I θ̈ + (k₁ + k₂)r²θ + T_f, where `offset` holds (F₁₀ − F₂₀)r as well
/// - `pendulum`: K_t (V − K_t θ̇)/R = I θ̈ + m g l sin θ + T_f
/// - `prescribed`: the force measured is F
pub const LINEAR: &[Linear] = &[
    Linear { kind: "axis", turns: false, body: &[INERTIA] },
    Linear { kind: "mass-spring", turns: false, body: &[MASS, STIFFNESS] },
    Linear { kind: "drum", turns: true, body: &[INERTIA_OF_TURNING, STIFFNESS_OF_TURNING] },
    Linear { kind: "pendulum", turns: true, body: &[INERTIA_OF_TURNING, GRAVITY] },
    Linear { kind: "prescribed", turns: false, body: &[] },
];

const INERTIA: Term = Term { name: "inertia", unit: "kg", column: Column::Acceleration };
const MASS: Term = Term { name: "mass", unit: "kg", column: Column::Acceleration };
const STIFFNESS: Term = Term { name: "stiffness", unit: "N/m", column: Column::Position };
const INERTIA_OF_TURNING: Term =
    Term { name: "inertia", unit: "kg·m²", column: Column::Acceleration };
const STIFFNESS_OF_TURNING: Term =
    Term { name: "stiffness", unit: "N·m/rad", column: Column::Position };
const GRAVITY: Term = Term { name: "gravity", unit: "N·m", column: Column::Sine };

/// Friction on a straight and on a turning plant: F = σ₂ q̇ + F_C sgn q̇ + offset.
const FRICTION: [&[Term]; 2] = [
    &[
        Term { name: "sigma_2", unit: "N·s/m", column: Column::Velocity },
        Term { name: "f_c", unit: "N", column: Column::Direction },
        Term { name: "offset", unit: "N", column: Column::One },
    ],
    &[
        Term { name: "sigma_2", unit: "N·m·s/rad", column: Column::Velocity },
        Term { name: "f_c", unit: "N·m", column: Column::Direction },
        Term { name: "offset", unit: "N·m", column: Column::One },
    ],
];

/// The same with a pair of coefficients for each direction. An offset is contained in it, as half the
/// difference of the two F_C.
const BY_DIRECTION: [&[Term]; 2] = [
    &[
        Term { name: "sigma_2_up", unit: "N·s/m", column: Column::VelocityUp },
        Term { name: "f_c_up", unit: "N", column: Column::Up },
        Term { name: "sigma_2_down", unit: "N·s/m", column: Column::VelocityDown },
        Term { name: "f_c_down", unit: "N", column: Column::Down },
    ],
    &[
        Term { name: "sigma_2_up", unit: "N·m·s/rad", column: Column::VelocityUp },
        Term { name: "f_c_up", unit: "N·m", column: Column::Up },
        Term { name: "sigma_2_down", unit: "N·m·s/rad", column: Column::VelocityDown },
        Term { name: "f_c_down", unit: "N·m", column: Column::Down },
    ],
];

impl Linear {
    /// The plant of this `kind`, if it is one of [`LINEAR`].
    pub fn of(kind: &str) -> Option<&'static Self> {
        LINEAR.iter().find(|plant| plant.kind == kind)
    }

    /// Its terms: the body's, then those of its friction.
    pub fn terms(&self, by_direction: bool) -> Vec<Term> {
        let friction = if by_direction { BY_DIRECTION } else { FRICTION };
        [self.body, friction[usize::from(self.turns)]].concat()
    }
}
