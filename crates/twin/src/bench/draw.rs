//! Values of effects: sized by the record without them, and made as visible as was drawn.

use super::{foreign, octaves, sign, visible};
use crate::hidden as nature;
use crate::{HiddenEffect, PlantKind, Quantity, Scenario, Sensor, TwinError, make};
use rand::RngExt;
use rand_chacha::ChaCha20Rng;
use std::f64::consts::TAU;

/// What an effect is sized by.
pub(super) struct Sizes {
    /// Force against which the plant is driven: the Coulomb level, or a third of the drive [N] or [N·m].
    pub(super) level: f64,
    /// Root mean square of the speed.
    pub(super) speed: f64,
    /// Least and largest displacement.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Largest input, and the force of one.
    pub(super) peak: f64,
    pub(super) gain: f64,
    /// The plant.
    pub(super) plant: PlantKind,
    /// Four numbers between 0 and 1 that give the effect its shape, and a sign.
    pub(super) shape: [f64; 4],
    pub(super) sign: f64,
    /// Where a law has several forms, the uncommon one.
    pub(super) other: bool,
}

impl Sizes {
    /// Half of the way between the ends of the motion.
    pub(super) fn travel(&self) -> f64 {
        (self.high - self.low) / 2.0
    }

    /// A wavenumber with one to four waves on the way; in the other form with up to sixty, of which no sample
    /// skips more than a sixth.
    fn wavenumber(&self) -> f64 {
        let way = 2.0 * self.travel();
        if self.other {
            let most = (way * super::RATE / (12.0 * self.speed)).clamp(4.0, 60.0);
            return TAU * self.from(0, 4.0, most) / way;
        }
        TAU * (1.0 + 3.0 * self.shape[0]) / way
    }

    /// Sine and cosine parts of a wave of this size.
    fn wave(&self, size: f64) -> (f64, f64) {
        let (sin, cos) = (TAU * self.shape[1]).sin_cos();
        (size * sin, size * cos)
    }

    /// A value between two, by octaves, from the n-th number.
    pub(super) fn from(&self, n: usize, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.shape[n])
    }
}

/// An effect of this name whose local visibility was drawn: between 10 and 100 for four records in five, between
/// 1 and 10 for the others, if a plausible size can be seen so well.
pub(super) fn calibrated(
    without: &Scenario,
    name: &str,
    other: bool,
    (seed, stream): (u64, &mut ChaCha20Rng),
) -> Result<HiddenEffect, TwinError> {
    let sizes = Sizes { other, ..sizes(without, seed, stream)? };
    let small = stream.random::<f64>() < 0.2;
    let target = if small { octaves(1.0, 10.0, stream) } else { octaves(10.0, 100.0, stream) };
    // Less than 2 % of the friction is nothing one would look for; a joint or a sensor shows much less.
    let contact = friction(name, LEAST, &sizes).is_some() && name != "presliding";
    let least = if contact { LEAST } else { LEAST / 20.0 };
    let least = if small { least / 5.0 } else { least };
    let alone = visible::shown(without, seed)?;
    let mut strength: f64 = 0.1;
    for _ in 0..4 {
        let effect = effect(name, strength, &sizes)?;
        let mut with = without.clone();
        with.hidden.push(effect);
        let visible = visible::visible(&visible::shown(&with, seed)?, &alone);
        let seen = visible::most(&visible, steady(name, without));
        let factor = (target / seen.max(1e-9)).clamp(0.05, 20.0);
        let next = (strength * factor).clamp(least, MOST);
        if (0.7..1.4).contains(&factor) || next == strength {
            break;
        }
        strength = next;
    }
    effect(name, strength, &sizes)
}

/// The least and the largest size of an effect, as a share of what it acts on.
const LEAST: f64 = 0.02;
const MOST: f64 = 0.6;

/// Whether an effect shows as something steady, which a line through every second would take away.
pub(super) fn steady(name: &str, scenario: &Scenario) -> bool {
    use PlantKind::{MassSpring, Pendulum};
    match name {
        "load_cell_drift" | "tach_bias" | "preload_asymmetry" | "cable_slack" => true,
        "current_bias" => matches!(scenario.plant, MassSpring { .. } | Pendulum { .. }),
        _ => false,
    }
}

/// The record without effects, as sensors of everything see it.
fn sizes(without: &Scenario, seed: u64, stream: &mut ChaCha20Rng) -> Result<Sizes, TwinError> {
    use Quantity as Q;
    let (input, displacement) = match without.plant {
        PlantKind::Drum { .. } => (Q::Current, Q::Angle),
        PlantKind::MassSpring { .. } => (Q::Force, Q::Position),
        PlantKind::Axis { .. } => (Q::Voltage, Q::Position),
        PlantKind::Pendulum { .. } => (Q::Voltage, Q::Angle),
        PlantKind::Prescribed { .. } => (Q::Displacement, Q::Force),
    };
    let mut probe = without.clone();
    let perfect = |quantity: Quantity| Sensor {
        quantity,
        column: quantity.name().to_owned(),
        unit: None,
        at_motor: false,
        gain: 1.0,
        bias: 0.0,
        noise: 0.0,
        quantum: 0.0,
    };
    probe.sensors = [input, displacement, Q::Velocity].map(perfect).to_vec();
    let made = make(&probe, seed)?;
    let values = |n: usize| made.clean[n].1.as_slice();
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let motion = if input == Q::Displacement { values(1) } else { values(2) };
    let speeds = values(3);
    let gain = without.plant.balance().map_or(1.0, |b| b.gain);
    let peak = largest(values(1));
    let level = without.friction.level();
    Ok(Sizes {
        level: if level > 0.0 { level } else { gain * peak / 3.0 },
        speed: (speeds.iter().map(|v| v * v).sum::<f64>() / speeds.len() as f64).sqrt(),
        low: motion.iter().copied().fold(f64::INFINITY, f64::min),
        high: motion.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        peak,
        gain,
        plant: without.plant,
        shape: [stream.random(), stream.random(), stream.random(), stream.random()],
        sign: sign(stream),
        other: false,
    })
}

/// An effect of this strength, a share of what it acts on.
fn effect(name: &str, s: f64, sizes: &Sizes) -> Result<HiddenEffect, TwinError> {
    friction(name, s, sizes)
        .or_else(|| drive(name, s, sizes))
        .or_else(|| load(name, s, sizes))
        .or_else(|| sensor(name, s, sizes))
        .or_else(|| foreign::effect(name, s, sizes))
        .ok_or_else(|| {
            let expected = format!("one of {}", HiddenEffect::NAMES.join(", "));
            TwinError::value("effect", format!("`{name}`"), &expected)
        })
}

/// What is in the contact.
fn friction(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let (level, speed, signed) = (sizes.level, sizes.speed, s * sizes.sign);
    let other = sizes.other;
    Some(match name {
        "viscous" => E::Viscous(nature::Viscous { sigma_2: s * level / speed }),
        "stribeck" => E::Stribeck(nature::Stribeck {
            drop: s * level,
            v_s: speed * sizes.from(0, 0.03, 0.3),
            power: if other { 1.0 } else { 2.0 },
        }),
        "quadratic_drag" => {
            E::QuadraticDrag(nature::QuadraticDrag { c: s * level / (speed * speed) })
        }
        "sublinear_drag" => {
            let v_0 = speed * sizes.from(0, 0.1, 0.5);
            E::SublinearDrag(nature::SublinearDrag { c: s * level / v_0, v_0 })
        }
        "coulomb" => E::Coulomb(nature::Coulomb { f_c: s * level }),
        "coulomb_asymmetry" => E::CoulombAsymmetry(nature::CoulombAsymmetry { ratio: signed }),
        "viscous_asymmetry" => {
            E::ViscousAsymmetry(nature::ViscousAsymmetry { c: signed * level / speed })
        }
        "position_friction" => E::PositionFriction(position_friction(s, sizes)),
        "load_friction" => E::LoadFriction(nature::LoadFriction { ratio: s / 2.0, level: other }),
        "friction_drift" => E::FrictionDrift(nature::FrictionDrift {
            amount: signed,
            tau: sizes.from(0, 5.0, 40.0),
            level: other,
        }),
        "dwell_stiction" => E::DwellStiction(nature::DwellStiction {
            drop: s * level,
            tau: sizes.from(0, 0.2, 1.5),
            wear: if other { sizes.from(1, 3.0, 30.0) } else { 1.0 },
        }),
        "presliding" => E::Presliding(nature::Presliding {
            sigma: level / (s * 0.1 * sizes.travel()).max(1e-12),
        }),
        "maxwell_slip" => {
            let delta = sizes.travel() * sizes.from(0, 0.01, 0.2);
            E::MaxwellSlip(nature::MaxwellSlip { k: s * level / delta, delta })
        }
        "cogging" => {
            let (sine, cosine) = sizes.wave(s * level);
            E::Cogging(nature::Cogging { sine, cosine, wavenumber: sizes.wavenumber() })
        }
        _ => return None,
    })
}

/// A wave for two records in three, a slow change for the third.
fn position_friction(s: f64, sizes: &Sizes) -> nature::PositionFriction {
    let none = nature::PositionFriction {
        sine: 0.0,
        cosine: 0.0,
        wavenumber: 0.0,
        slope: 0.0,
        q_0: 0.0,
        level: sizes.other,
    };
    if sizes.shape[2] < 0.33 {
        let q_0 = f64::midpoint(sizes.low, sizes.high);
        return nature::PositionFriction { slope: s * sizes.sign / sizes.travel(), q_0, ..none };
    }
    let (sine, cosine) = sizes.wave(s);
    nature::PositionFriction { sine, cosine, wavenumber: sizes.wavenumber(), ..none }
}

/// What is in converter, amplifier and motor.
fn drive(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let full = sizes.gain * sizes.peak;
    Some(match name {
        "current_bias" => {
            E::CurrentBias(nature::CurrentBias { bias: s * sizes.sign * sizes.level / sizes.gain })
        }
        // At the peak of the drive, s of it is lost.
        "torque_saturation" => {
            let power = if sizes.other { sizes.from(0, 2.0, 8.0) } else { 8.0 };
            let bent = ((1.0 - s).powf(-power) - 1.0).powf(1.0 / power);
            E::TorqueSaturation(nature::TorqueSaturation { limit: full / bent, power })
        }
        // A delay is made of whole microseconds.
        "input_delay" => {
            E::InputDelay(nature::InputDelay { delay: (s * 0.05 * 1e6).round() / 1e6 })
        }
        "inertia" => E::Inertia(nature::Inertia { ratio: 5.0 * s }),
        _ => return None,
    })
}

/// What is at the load and on the way to it.
fn load(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let travel = sizes.travel();
    Some(match (name, sizes.plant) {
        ("preload_asymmetry", PlantKind::Drum { f_10, .. }) => {
            E::PreloadAsymmetry(nature::PreloadAsymmetry { force: s * sizes.sign * f_10 })
        }
        ("backlash", _) => E::Backlash(nature::Backlash { gap: 0.2 * s * travel }),
        ("compliance", _) => {
            E::Compliance(nature::Compliance { stiffness: sizes.level / (0.1 * s * travel) })
        }
        ("cubic_spring", PlantKind::Drum { radius, k_1, .. }) => {
            E::CubicSpring(nature::CubicSpring { k_3: 2.0 * s * k_1 / (radius * travel).powi(2) })
        }
        ("cubic_spring", PlantKind::MassSpring { stiffness, .. }) => {
            E::CubicSpring(nature::CubicSpring { k_3: s * stiffness / (travel * travel) })
        }
        ("cable_slack", PlantKind::Drum { radius, k_1, k_2, f_10, f_20, .. }) => {
            // At this level the cable that is drawn less begins to hang at a part of the way.
            let least = (f_10 + k_1 * radius * sizes.low).min(f_20 - k_2 * radius * sizes.high);
            let level = (least + s * k_1.max(k_2) * radius * travel).max(0.0);
            E::CableSlack(nature::CableSlack { level })
        }
        ("gravity_unbalance", _) => {
            let (sine, cosine) = sizes.wave(s * sizes.level);
            E::GravityUnbalance(nature::GravityUnbalance { sine, cosine })
        }
        _ => return None,
    })
}

/// What is in the sensors.
fn sensor(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let signed = s * sizes.sign;
    Some(match (name, sizes.plant) {
        ("velocity_lag", _) => E::VelocityLag(nature::VelocityLag { tau: 0.1 * s }),
        ("tach_gain", _) => E::TachGain(nature::TachGain { error: 0.5 * signed }),
        ("tach_bias", _) => E::TachBias(nature::TachBias { bias: signed * sizes.speed }),
        ("load_cell_drift", PlantKind::Drum { radius, k_1, .. }) => {
            let whole = k_1 * radius * sizes.travel();
            E::LoadCellDrift(nature::LoadCellDrift { rate: signed * whole / super::DURATION })
        }
        _ => return None,
    })
}
