//! What is to be made: plant, friction, drive and sensors, as its TOML says.

use crate::{HiddenEffect, Quantity, TwinError};
use serde::{Deserialize, Serialize};

/// A record to be made. All values are in SI units, but for those of a sensor, which are in its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What it is, in a line.
    pub title: String,
    /// What the card of the record says to its reader, who is not to know the truth.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub text: String,
    /// Length [s].
    pub duration: f64,
    /// Sampling rate [Hz].
    pub rate: f64,
    /// The plant.
    pub plant: PlantKind,
    /// Its friction.
    pub friction: Friction,
    /// Where it starts.
    #[serde(default)]
    pub start: Start,
    /// What drives it; for an imposed motion, its displacement; for a controlled axis, its reference [m].
    pub input: Input,
    /// The controller of an axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub controller: Option<Controller>,
    /// What is added to the controller's command [V].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_input: Option<Input>,
    /// What is measured.
    #[serde(rename = "sensor")]
    pub sensors: Vec<Sensor>,
    /// What is hidden in it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hidden: Vec<HiddenEffect>,
}

/// V = clip(kᵥ (kₚ (q_ref − q) − q̇), ±limit) + added input, with q as the sensor reads it and q̇ the difference of
/// the means of two readings each; held until the next sample of the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Controller {
    /// Position and speed.
    Pd {
        /// Position gain kₚ [1/s].
        kp: f64,
        /// Velocity gain kᵥ [V·s/m].
        kv: f64,
        /// Largest command [V].
        limit: f64,
    },
}

/// A plant with its parameters. Each has an `offset`, a constant part of the friction force or torque.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum PlantKind {
    /// The paper's drum between two springs, I θ̈ = k_m i − T_f − r (F₁ − F₂).
    Drum {
        /// Inertia I [kg·m²].
        inertia: f64,
        /// Radius r [m].
        radius: f64,
        /// Stiffness of the first spring k₁ [N/m].
        k_1: f64,
        /// Stiffness of the second spring k₂ [N/m].
        k_2: f64,
        /// Force of the first spring at θ = 0, F₁₀ [N].
        f_10: f64,
        /// Force of the second spring at θ = 0, F₂₀ [N].
        f_20: f64,
        /// Motor constant at the drum k_m [N·m/A].
        motor_constant: f64,
        /// Turns of the motor for one of the drum.
        gear_ratio: f64,
        /// Friction-side offset [N·m].
        #[serde(default)]
        offset: f64,
    },
    /// A mass on a spring, m q̈ + k_s q = F_e − F.
    MassSpring {
        /// Mass m [kg].
        mass: f64,
        /// Stiffness k_s [N/m].
        stiffness: f64,
        /// Friction-side offset [N].
        #[serde(default)]
        offset: f64,
    },
    /// A drive without spring, M q̈ = g V − F.
    Axis {
        /// Inertia M [kg].
        inertia: f64,
        /// Force per volt g [N/V]; 1 if the input is the force itself.
        #[serde(default = "one")]
        gain: f64,
        /// Friction-side offset [N].
        #[serde(default)]
        offset: f64,
    },
    /// A pendulum driven by a motor under voltage, I θ̈ = K_t (V − K_t θ̇)/R − m g l sin θ − T_f.
    Pendulum {
        /// Inertia about the pivot, complete, I [kg·m²].
        inertia: f64,
        /// Mass m [kg].
        mass: f64,
        /// Length from the pivot to the centre of mass l [m].
        length: f64,
        /// Torque constant K_t [N·m/A].
        torque_constant: f64,
        /// Resistance R [Ω].
        resistance: f64,
        /// Friction-side offset [N·m].
        #[serde(default)]
        offset: f64,
    },
    /// The displacement is imposed and the force measured.
    Prescribed {
        /// Friction-side offset [N].
        #[serde(default)]
        offset: f64,
    },
}

/// A friction model with its parameters, each with a viscous coefficient σ₂ [N·s/m].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Friction {
    /// Nothing but the viscous part.
    None {
        /// Viscous coefficient σ₂ [N·s/m].
        #[serde(default)]
        sigma_2: f64,
    },
    /// Set-valued: stuck within ±F_C, F_C against the motion while sliding.
    Coulomb {
        /// Coulomb force F_C [N].
        f_c: f64,
        /// Viscous coefficient σ₂ [N·s/m].
        #[serde(default)]
        sigma_2: f64,
    },
    /// Dahl's model.
    Dahl {
        /// Coulomb force F_C [N].
        f_c: f64,
        /// Rest stiffness σ [N/m].
        sigma: f64,
        /// Shape γ.
        gamma: f64,
        /// Viscous coefficient σ₂ [N·s/m].
        #[serde(default)]
        sigma_2: f64,
    },
    /// The LuGre model.
    #[serde(rename = "lugre")]
    LuGre {
        /// Coulomb force F_C [N].
        f_c: f64,
        /// Stiction force F_S [N].
        f_s: f64,
        /// Stribeck velocity v_S [m/s].
        v_s: f64,
        /// Bristle stiffness σ₀ [N/m].
        sigma_0: f64,
        /// Bristle damping σ₁ [N·s/m].
        sigma_1: f64,
        /// Viscous coefficient σ₂ [N·s/m].
        #[serde(default)]
        sigma_2: f64,
    },
    /// Springs that slip, side by side.
    MaxwellSlip {
        /// Stiffnesses kᵢ [N/m].
        k: Vec<f64>,
        /// Deadbands Δᵢ [m].
        delta: Vec<f64>,
        /// Viscous coefficient σ₂ [N·s/m].
        #[serde(default)]
        sigma_2: f64,
    },
}

/// The state at t = 0; the bristles are relaxed there.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// Displacement [m].
    pub position: f64,
    /// Speed [m/s].
    pub velocity: f64,
}

/// The drive: the sum of its parts, continuous or held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Sample time of the converter that holds the drive between its samples [s]; continuous if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<f64>,
    /// What is added up.
    #[serde(rename = "part")]
    pub parts: Vec<Part>,
}

/// A part of the drive, in the drive's unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "shape", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Part {
    /// A constant.
    Constant {
        /// The value.
        value: f64,
    },
    /// a sin(ωt + φ).
    Sine {
        /// Amplitude a.
        amplitude: f64,
        /// Angular frequency ω [rad/s].
        omega: f64,
        /// Phase φ [rad].
        #[serde(default)]
        phase: f64,
    },
    /// A sine whose frequency grows linearly in time, and stays when the end is reached.
    Chirp {
        /// Amplitude.
        amplitude: f64,
        /// Angular frequency at the start [rad/s].
        omega_start: f64,
        /// Angular frequency at the end [rad/s].
        omega_end: f64,
        /// Time from the one to the other [s].
        over: f64,
    },
    /// A triangle that rises through 0 at t = 0.
    Triangle {
        /// Amplitude.
        amplitude: f64,
        /// Period [s].
        period: f64,
    },
    /// 0, and from each time on the value that belongs to it.
    Steps {
        /// Times, increasing [s].
        times: Vec<f64>,
        /// Values.
        values: Vec<f64>,
    },
    /// Straight from each value to the next, constant before and after: trapezoids and ramps.
    Ramps {
        /// Times, increasing [s].
        times: Vec<f64>,
        /// Values.
        values: Vec<f64>,
    },
    /// Steps to values drawn uniformly from ±amplitude, by the record's seed.
    RandomSteps {
        /// Largest value.
        amplitude: f64,
        /// Time between steps [s].
        every: f64,
    },
}

/// A sensor and its column: value = round to quantum of (gain × quantity + bias + noise), in its own unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// What it measures.
    pub quantity: Quantity,
    /// The header of its column.
    pub column: String,
    /// Its unit; SI if none is said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Whether it sits on the motor's shaft, where the gear makes angles and speeds larger.
    #[serde(default, skip_serializing_if = "is_false")]
    pub at_motor: bool,
    /// Gain, 1 for a true sensor.
    #[serde(default = "one")]
    pub gain: f64,
    /// Bias, in its unit.
    #[serde(default)]
    pub bias: f64,
    /// Standard deviation of its white noise, in its unit.
    #[serde(default)]
    pub noise: f64,
    /// Step of its encoder or converter, in its unit; 0 if there is none.
    #[serde(default)]
    pub quantum: f64,
}

fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
fn is_false(value: &bool) -> bool {
    !value
}

impl Scenario {
    /// Whether one of its sensors measures this.
    pub fn shows(&self, quantity: Quantity) -> bool {
        self.sensors.iter().any(|sensor| sensor.quantity == quantity)
    }

    /// The scenario that a TOML file holds.
    pub fn parse(text: &str) -> Result<Self, TwinError> {
        let scenario: Self =
            toml::from_str(text).map_err(|e| TwinError::Syntax(e.to_string().trim().to_owned()))?;
        scenario.check()?;
        Ok(scenario)
    }
}
