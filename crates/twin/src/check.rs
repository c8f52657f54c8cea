//! Whether a scenario makes sense.

use crate::signal::count;
use crate::{Controller, Friction, Input, Part, PlantKind, Quantity, Scenario, Sensor, TwinError};

/// The longest record [samples].
const MOST_SAMPLES: f64 = 2e7;
/// The most legs that converters and corners cut a drive into.
const MOST_LEGS: f64 = 1e8;

impl Scenario {
    /// How many samples the record has, the first at t = 0.
    pub fn samples(&self) -> usize {
        // A duration of 0.3 s at 10 Hz has its sample at 0.3 s, whatever the last bits say.
        count(self.duration * self.rate * (1.0 + 1e-12)) + 1
    }

    /// Whether it makes sense.
    ///
    /// # Errors
    /// The first value that does not.
    pub fn check(&self) -> Result<(), TwinError> {
        positive("duration", self.duration)?;
        positive("rate", self.rate)?;
        if self.duration * self.rate > MOST_SAMPLES {
            let found = self.duration * self.rate;
            return Err(TwinError::value("duration × rate", found, "at most 2e7 samples"));
        }
        finite("start.position", self.start.position)?;
        finite("start.velocity", self.start.velocity)?;
        self.plant()?;
        self.friction()?;
        self.input.check(self.duration)?;
        self.imposed()?;
        self.controller()?;
        for (i, sensor) in self.sensors.iter().enumerate() {
            sensor.check(self)?;
            let before = &self.sensors[..i];
            if before.iter().any(|s| s.quantity == sensor.quantity || s.column == sensor.column) {
                let expected = "each quantity and each column once";
                return Err(TwinError::value("sensor", &sensor.column, expected));
            }
        }
        self.hidden.iter().try_for_each(|hidden| hidden.check(self))
    }

    /// A controller has an axis, and gains; what only a controller has needs one.
    fn controller(&self) -> Result<(), TwinError> {
        let Some(Controller::Pd { kp, kv, limit }) = self.controller else {
            let lost = self.added_input.is_some()
                || self.shows(Quantity::Reference)
                || self.shows(Quantity::AddedInput);
            let expected = "a controller for a reference or an added input";
            return if lost {
                Err(TwinError::value("controller", "none", expected))
            } else {
                Ok(())
            };
        };
        if !matches!(self.plant, PlantKind::Axis { .. }) {
            return Err(TwinError::value("controller", self.plant.kind(), "an axis"));
        }
        finite("controller.kp", kp)?;
        finite("controller.kv", kv)?;
        positive("controller.limit", limit)?;
        self.added_input.iter().try_for_each(|input| input.check(self.duration))
    }

    fn plant(&self) -> Result<(), TwinError> {
        finite("plant.offset", self.plant.offset())?;
        match self.plant {
            PlantKind::Drum {
                radius, k_1, k_2, f_10, f_20, motor_constant, gear_ratio, ..
            } => {
                positive("plant.radius", radius)?;
                not_negative("plant.k_1", k_1)?;
                not_negative("plant.k_2", k_2)?;
                finite("plant.f_10", f_10)?;
                finite("plant.f_20", f_20)?;
                finite("plant.motor_constant", motor_constant)?;
                positive("plant.gear_ratio", gear_ratio)?;
            }
            PlantKind::MassSpring { stiffness, .. } => not_negative("plant.stiffness", stiffness)?,
            PlantKind::Axis { gain, .. } => finite("plant.gain", gain)?,
            PlantKind::Pendulum { mass, length, torque_constant, resistance, .. } => {
                not_negative("plant.mass", mass)?;
                not_negative("plant.length", length)?;
                finite("plant.torque_constant", torque_constant)?;
                positive("plant.resistance", resistance)?;
            }
            PlantKind::Prescribed { .. } => {}
        }
        match self.plant.balance() {
            Some(balance) => positive("plant's inertia", balance.inertia),
            None => Ok(()),
        }
    }

    fn friction(&self) -> Result<(), TwinError> {
        let viscous = match self.friction {
            Friction::None { sigma_2 } => sigma_2,
            Friction::Coulomb { f_c, sigma_2 } => {
                not_negative("friction.f_c", f_c)?;
                sigma_2
            }
            Friction::Dahl { f_c, sigma, gamma, sigma_2 } => {
                positive("friction.f_c", f_c)?;
                positive("friction.sigma", sigma)?;
                not_negative("friction.gamma", gamma)?;
                sigma_2
            }
            Friction::LuGre { f_c, f_s, v_s, sigma_0, sigma_1, sigma_2 } => {
                positive("friction.f_c", f_c)?;
                positive("friction.f_s", f_s)?;
                positive("friction.v_s", v_s)?;
                positive("friction.sigma_0", sigma_0)?;
                not_negative("friction.sigma_1", sigma_1)?;
                sigma_2
            }
            Friction::MaxwellSlip { ref k, ref delta, sigma_2 } => {
                if k.len() != delta.len() || k.is_empty() {
                    let found = format!("{} and {}", k.len(), delta.len());
                    let expected = "as many stiffnesses as deadbands, and one at least";
                    return Err(TwinError::value("friction.k, friction.delta", found, expected));
                }
                for (k, delta) in k.iter().zip(delta) {
                    positive("friction.k", *k)?;
                    positive("friction.delta", *delta)?;
                }
                sigma_2
            }
        };
        finite("friction.sigma_2", viscous)
    }

    /// An imposed displacement has no jumps, for its speed would have no bound.
    fn imposed(&self) -> Result<(), TwinError> {
        let jumps = |part: &Part| matches!(part, Part::Steps { .. } | Part::RandomSteps { .. });
        let imposed = self.plant.balance().is_none();
        if imposed && (self.input.hold.is_some() || self.input.parts.iter().any(jumps)) {
            let expected = "an imposed displacement without jumps: no `hold` and no steps";
            return Err(TwinError::value("input", "one that jumps", expected));
        }
        Ok(())
    }
}

impl Input {
    fn check(&self, duration: f64) -> Result<(), TwinError> {
        if let Some(hold) = self.hold {
            positive("input.hold", hold)?;
            legs(duration / hold)?;
        }
        self.parts.iter().try_for_each(|part| part.check(duration))
    }
}

impl Part {
    fn check(&self, duration: f64) -> Result<(), TwinError> {
        match self {
            Self::Constant { value } => finite("value", *value),
            Self::Sine { amplitude, omega, phase } => {
                finite("amplitude", *amplitude)?;
                finite("omega", *omega)?;
                finite("phase", *phase)
            }
            Self::Chirp { amplitude, omega_start, omega_end, over } => {
                finite("amplitude", *amplitude)?;
                finite("omega_start", *omega_start)?;
                finite("omega_end", *omega_end)?;
                positive("over", *over)
            }
            Self::Triangle { amplitude, period } => {
                finite("amplitude", *amplitude)?;
                positive("period", *period)?;
                legs(2.0 * duration / period)
            }
            Self::RandomSteps { amplitude, every } => {
                finite("amplitude", *amplitude)?;
                positive("every", *every)?;
                legs(duration / every)
            }
            Self::Steps { times, values } | Self::Ramps { times, values } => points(times, values),
        }
    }
}

impl Sensor {
    fn check(&self, scenario: &Scenario) -> Result<(), TwinError> {
        let plant = &scenario.plant;
        plant.read(self.quantity, &crate::plant::Instant::default())?;
        self.quantity.unit(self.unit.as_deref(), plant.rotary())?;
        let key = |what: &str| format!("{what} of the sensor `{}`", self.column);
        finite(&key("gain"), self.gain)?;
        finite(&key("bias"), self.bias)?;
        not_negative(&key("noise"), self.noise)?;
        not_negative(&key("quantum"), self.quantum)?;
        let turns = matches!(self.quantity, Quantity::Angle | Quantity::Velocity);
        if self.at_motor && !(turns && plant.kind() == "drum") {
            let expected = "a motor's shaft only for angle and velocity of a drum";
            return Err(TwinError::value(key("at_motor"), true, expected));
        }
        Ok(())
    }
}

fn points(times: &[f64], values: &[f64]) -> Result<(), TwinError> {
    if times.len() != values.len() || times.is_empty() {
        let found = format!("{} and {}", times.len(), values.len());
        return Err(TwinError::value("times, values", found, "as many times as values"));
    }
    values.iter().try_for_each(|value| finite("values", *value))?;
    times.iter().try_for_each(|time| finite("times", *time))?;
    match times.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(TwinError::value(
            "times",
            format!("{} after {}", pair[1], pair[0]),
            "times that increase",
        )),
        None => Ok(()),
    }
}

fn legs(count: f64) -> Result<(), TwinError> {
    if count <= MOST_LEGS {
        return Ok(());
    }
    Err(TwinError::value("input", format!("{count:.0} corners"), "at most 1e8"))
}

fn finite(key: &str, value: f64) -> Result<(), TwinError> {
    if value.is_finite() { Ok(()) } else { Err(TwinError::value(key, value, "a finite number")) }
}

fn positive(key: &str, value: f64) -> Result<(), TwinError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(TwinError::value(key, value, "a finite number above 0"))
}

fn not_negative(key: &str, value: f64) -> Result<(), TwinError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(TwinError::value(key, value, "a finite number, 0 or above"))
}
