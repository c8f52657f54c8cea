//! The plants of the benchmark, with their friction and their sensors.

use super::{Between, DURATION, Hides, RATE, Recipe, between, pick, sign};
use crate::{Controller, Friction, HiddenEffect, Input, Part, PlantKind, Quantity, Scenario};
use crate::{Sensor, Start};
use rand_chacha::ChaCha20Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A plant with what is measured of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// The drum with load cells and a velocity sensor.
    DrumCells,
    /// The drum with current and angle only.
    DrumAngle,
    /// A mass on a spring, with force and position only.
    MassSpring,
    /// An axis under an open-loop voltage.
    Axis,
    /// An axis under a controller.
    AxisPd,
    /// A pendulum with voltage, angle and velocity.
    Pendulum,
    /// An imposed motion with its force.
    Prescribed,
}

/// The noise of the sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Noise {
    /// A good laboratory.
    Low,
    /// A good machine.
    Middle,
    /// A cheap machine.
    High,
}

/// A friction model of the benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionKind {
    /// LuGre whose stiction is its Coulomb force.
    LuGre,
    /// LuGre with Stribeck's drop.
    LuGreStribeck,
    /// Dahl with γ = 1.
    Dahl,
    /// Four springs that slip.
    MaxwellSlip,
    /// Coulomb.
    Coulomb,
    /// Nothing but the viscous part.
    None,
}

use FrictionKind as F;

impl Noise {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Low, Self::Middle, Self::High];

    fn of(self, levels: [f64; 3]) -> f64 {
        levels[self as usize]
    }
}

/// What a family's friction and drive are sized by.
struct Size {
    /// Coulomb level [N] or [N·m].
    level: f64,
    /// Deflection at which contacts slip [m] or [rad].
    grain: f64,
    viscous: f64,
    v_s: f64,
    /// Bristle damping over bristle stiffness [s].
    damping: f64,
    /// A drive of one, in its unit.
    drive: f64,
}

impl Family {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::DrumCells,
        Self::DrumAngle,
        Self::MassSpring,
        Self::Axis,
        Self::AxisPd,
        Self::Pendulum,
        Self::Prescribed,
    ];

    /// The friction models it may have.
    pub fn frictions(self) -> &'static [FrictionKind] {
        match self {
            Self::DrumCells | Self::DrumAngle => {
                &[F::LuGre, F::LuGreStribeck, F::LuGreStribeck, F::Dahl, F::MaxwellSlip]
            }
            _ => &[F::LuGre, F::LuGreStribeck, F::Dahl, F::MaxwellSlip, F::Coulomb],
        }
    }

    /// The friction that an effect needs, or the one there is.
    pub fn friction_for(self, effect: &str, friction: FrictionKind) -> FrictionKind {
        match effect {
            "coulomb" => F::None,
            "presliding" => F::Coulomb,
            "stribeck" if friction == F::LuGreStribeck => F::LuGre,
            _ => friction,
        }
    }

    /// The effects that can be hidden in it, and told from a free parameter.
    pub fn effects(self, friction: FrictionKind, foreign: bool) -> Vec<&'static str> {
        let drum = matches!(self, Self::DrumCells | Self::DrumAngle);
        let rubs = friction != F::None;
        let suits = |name: &str| match name {
            "viscous" | "sublinear_drag" => {
                rubs && matches!(self, Self::MassSpring | Self::Pendulum | Self::Prescribed)
            }
            "coulomb" => matches!(self, Self::MassSpring | Self::Pendulum) && rubs,
            "presliding" => !drum && friction == F::Coulomb,
            "stribeck" | "coulomb_asymmetry" | "position_friction" | "friction_drift"
            | "dwell_stiction" => rubs,
            "load_friction" => rubs && self != Self::Prescribed,
            // Where load cells see it, the preloads are free and take it up.
            "preload_asymmetry" => false,
            "cable_slack" | "load_cell_drift" | "foreign_winding" => self == Self::DrumCells,
            "velocity_lag" | "tach_gain" | "tach_bias" => {
                matches!(self, Self::DrumCells | Self::Pendulum)
            }
            "cubic_spring" => matches!(self, Self::DrumCells | Self::MassSpring),
            "gravity_unbalance" | "inertia" => drum,
            "current_bias"
            | "backlash"
            | "compliance"
            | "torque_saturation"
            | "input_delay"
            | "foreign_rattle"
            | "foreign_motor_constant"
            | "foreign_deadzone"
            | "foreign_sensor_hysteresis" => self != Self::Prescribed,
            _ => true,
        };
        let names = HiddenEffect::NAMES.iter().copied();
        names.filter(|n| n.starts_with("foreign_") == foreign && suits(n)).collect()
    }

    fn plant(self, stream: &mut ChaCha20Rng) -> (PlantKind, Size) {
        let offset = 0.0;
        let mut near = |value: f64| value * between(0.8, 1.25, stream);
        match self {
            Self::DrumCells | Self::DrumAngle => {
                let (inertia, radius, motor_constant) = (near(3e-4), 0.0254, near(16.5));
                let level = near(0.6);
                let size = size(level, near(6e-4), near(1.3), near(1e-3));
                let size = Size { damping: 0.03, drive: level / motor_constant, ..size };
                let (near_1, near_2, near_3, near_4) = (near(1.0), near(1.0), near(1.0), near(1.0));
                // Stiff springs are seen by load cells only; without them their 2 % would be an effect.
                let soft = self == Self::DrumAngle || near(1.0) < 1.0;
                let k = if soft { 2.0 } else { 150.0 };
                let taut = 2.0 * k * radius;
                let (k_1, k_2, f_10, f_20) = (k * near_1, k * near_2, taut * near_3, taut * near_4);
                let gear_ratio = 68.8;
                let plant = PlantKind::Drum {
                    inertia,
                    radius,
                    k_1,
                    k_2,
                    f_10,
                    f_20,
                    motor_constant,
                    gear_ratio,
                    offset,
                };
                (plant, size)
            }
            Self::MassSpring => {
                let (mass, stiffness) = (near(1.0), near(150.0));
                let plant = PlantKind::MassSpring { mass, stiffness, offset };
                let size = size(near(2.0), near(3e-5), near(6.0), near(5e-3));
                (plant, Size { drive: size.level, ..size })
            }
            Self::Axis | Self::AxisPd => {
                let (inertia, gain) = (near(16.0), near(35.0));
                let size = size(near(20.0), near(2e-5), near(150.0), near(0.01));
                let drive = if self == Self::Axis { size.level / gain } else { 0.05 };
                (PlantKind::Axis { inertia, gain, offset }, Size { drive, ..size })
            }
            Self::Pendulum => {
                let (inertia, mass, length) = (near(0.012), near(0.3), near(0.18));
                let (torque_constant, resistance) = (near(0.15), near(1.5));
                let plant = PlantKind::Pendulum {
                    inertia,
                    mass,
                    length,
                    torque_constant,
                    resistance,
                    offset,
                };
                let size = size(near(0.03), near(1e-3), near(0.004), near(0.05));
                (plant, Size { drive: 0.06 * resistance / torque_constant, ..size })
            }
            Self::Prescribed => {
                let size = size(near(1.0), near(5e-4), near(4.0), near(5e-3));
                (PlantKind::Prescribed { offset }, Size { drive: near(0.01), ..size })
            }
        }
    }
}

fn size(level: f64, grain: f64, viscous: f64, v_s: f64) -> Size {
    Size { level, grain, viscous, v_s, damping: 0.005, drive: 1.0 }
}

fn friction(kind: FrictionKind, size: &Size, stream: &mut ChaCha20Rng) -> Friction {
    let (f_c, sigma_2) = (size.level, size.viscous);
    let stiffness = f_c / size.grain;
    let lugre = |f_s| Friction::LuGre {
        f_c,
        f_s,
        v_s: size.v_s,
        sigma_0: stiffness,
        sigma_1: size.damping * stiffness,
        sigma_2,
    };
    match kind {
        F::LuGre => lugre(f_c),
        F::LuGreStribeck => lugre(f_c * between(1.3, 1.7, stream)),
        F::Dahl => Friction::Dahl { f_c, sigma: stiffness, gamma: 1.0, sigma_2 },
        F::MaxwellSlip => {
            let delta: Vec<f64> = [0.5, 1.0, 2.0, 4.0].map(|d| d * size.grain).to_vec();
            let parts = [0.3, 0.3, 0.2, 0.2].iter().zip(&delta);
            let k = parts.map(|(part, delta)| part * f_c / delta * between(0.9, 1.1, stream));
            Friction::MaxwellSlip { k: k.collect(), delta, sigma_2 }
        }
        F::Coulomb => Friction::Coulomb { f_c, sigma_2 },
        F::None => Friction::None { sigma_2 },
    }
}

/// The scenario of a recipe with nothing hidden in it.
pub(super) fn scenario(recipe: &Recipe, stream: &mut ChaCha20Rng) -> Scenario {
    let family = recipe.family;
    let (plant, mut size) = family.plant(stream);
    if let Hides::Effects(names) = &recipe.hides
        && names.iter().any(|name| name == "viscous" || name == "sublinear_drag")
    {
        // The drag is what is missing.
        size.viscous = 0.0;
    }
    let friction = friction(recipe.friction, &size, stream);
    let motion = matches!(family, Family::AxisPd | Family::Prescribed);
    let parts = recipe.excitation.parts(size.drive, motion, stream);
    let held = family != Family::Prescribed && recipe.input != Between::Smooth;
    let hold = held.then_some(1.0 / RATE);
    let pd = family == Family::AxisPd;
    let gains = Controller::Pd { kp: 10.0, kv: between(15.0, 22.0, stream), limit: 10.0 };
    Scenario {
        title: format!("benchmark: {family:?}, {:?}, {:?}", recipe.friction, recipe.excitation),
        text: String::new(),
        duration: DURATION,
        rate: RATE,
        plant,
        friction,
        start: Start::default(),
        input: Input { hold, parts },
        controller: pd.then_some(gains),
        added_input: pd.then(|| Input { hold, parts: vec![pulses(stream)] }),
        sensors: sensors(family, &plant, &size, recipe.noise),
        hidden: Vec::new(),
    }
}

/// Pulses of 2 V for half a second, now and then [V].
fn pulses(stream: &mut ChaCha20Rng) -> Part {
    let (mut times, mut values, mut t) = (Vec::new(), Vec::new(), 1.0);
    while t < DURATION {
        times.extend([t, t + 0.5]);
        values.extend([2.0 * sign(stream), 0.0]);
        t += pick(&[1.5, 2.5, 3.5], stream);
    }
    Part::Steps { times, values }
}

fn sensors(family: Family, plant: &PlantKind, size: &Size, noise: Noise) -> Vec<Sensor> {
    use Quantity as Q;
    let sensor = |quantity: Quantity, column: &str, (white, quantum): (f64, f64)| Sensor {
        quantity,
        column: column.to_owned(),
        unit: None,
        at_motor: false,
        gain: 1.0,
        bias: 0.0,
        noise: white,
        quantum,
    };
    let drive = (size.drive * noise.of([5e-5, 3e-4, 1.5e-3]), 0.0);
    // An encoder's light bar trembles by a fifth of a step.
    let encoder = |levels: [f64; 3]| (0.2 * noise.of(levels), noise.of(levels));
    match (family, plant) {
        (Family::DrumCells | Family::DrumAngle, PlantKind::Drum { radius, k_1, .. }) => {
            let mut all = vec![
                sensor(Q::Current, "current_a", drive),
                sensor(Q::Angle, "angle_rad", encoder([2e-5, 1e-4, 4e-4])),
            ];
            if family == Family::DrumCells {
                let cell = k_1 * radius * noise.of([1e-3, 4e-3, 1.6e-2]);
                all.push(sensor(
                    Q::Velocity,
                    "velocity_rad_s",
                    (noise.of([5e-4, 2e-3, 8e-3]), 0.0),
                ));
                all.push(sensor(Q::Force1, "force1_n", (cell, cell / 8.0)));
                all.push(sensor(Q::Force2, "force2_n", (cell, cell / 8.0)));
            }
            all
        }
        (Family::MassSpring, _) => vec![
            sensor(Q::Force, "force_n", drive),
            sensor(Q::Position, "position_m", encoder([1e-7, 1e-6, 1e-5])),
        ],
        (Family::Axis, _) => vec![
            sensor(Q::Voltage, "voltage_v", drive),
            sensor(Q::Position, "position_m", encoder([1e-7, 1e-6, 1e-5])),
        ],
        (Family::AxisPd, _) => vec![
            sensor(Q::Voltage, "voltage_v", (noise.of([2e-5, 2e-4, 1e-3]), 0.0)),
            // The controller sees what the encoder shows.
            sensor(Q::Position, "position_m", (0.0, noise.of([1e-7, 1e-6, 5e-6]))),
            sensor(Q::Reference, "reference_m", (0.0, 0.0)),
            sensor(Q::AddedInput, "added_v", (0.0, 0.0)),
        ],
        (Family::Pendulum, _) => vec![
            sensor(Q::Voltage, "voltage_v", drive),
            sensor(Q::Angle, "angle_rad", encoder([65536.0, 16384.0, 4096.0].map(|n| TAU / n))),
            sensor(Q::Velocity, "velocity_rad_s", (noise.of([2e-3, 1e-2, 5e-2]), 0.0)),
        ],
        _ => vec![
            sensor(
                Q::Displacement,
                "displacement_m",
                (size.grain * noise.of([2e-4, 1e-3, 5e-3]), 0.0),
            ),
            sensor(Q::Force, "force_n", (size.level * noise.of([2e-4, 1e-3, 5e-3]), 0.0)),
        ],
    }
}
