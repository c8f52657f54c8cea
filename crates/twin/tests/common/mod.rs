//! What the tests share.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use twin::{Made, Scenario, make};

/// The record of a scenario's text.
pub(crate) fn made(text: &str) -> Made {
    make(&Scenario::parse(text).unwrap(), 1).unwrap()
}

/// A true column of a record, by its header.
pub(crate) fn clean<'a>(made: &'a Made, column: &str) -> &'a [f64] {
    &made.clean.iter().find(|(name, _)| name == column).unwrap().1
}

/// The largest distance of a true column from a function of time.
pub(crate) fn off(made: &Made, column: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let pairs = clean(made, "time_s").iter().zip(clean(made, column));
    pairs.map(|(t, found)| (found - exact(*t)).abs()).fold(0.0, f64::max)
}

/// Perfect sensors of these quantities, each in a column of its name.
pub(crate) fn sensors(quantities: &[&str]) -> String {
    let one = |q: &&str| format!("\n[[sensor]]\nquantity = \"{q}\"\ncolumn = \"{q}\"\n");
    quantities.iter().map(one).collect()
}

/// Friction models that suit a force of about 1 N.
pub(crate) const FRICTION: [&str; 6] = [
    "name = 'none'\nsigma_2 = 0.5",
    "name = 'coulomb'\nf_c = 0.4\nsigma_2 = 0.5",
    "name = 'dahl'\nf_c = 0.4\nsigma = 60.0\ngamma = 0.5\nsigma_2 = 0.5",
    "name = 'dahl'\nf_c = 0.4\nsigma = 60.0\ngamma = 1.0\nsigma_2 = 0.2",
    "name = 'lugre'\nf_c = 0.4\nf_s = 0.6\nv_s = 0.002\nsigma_0 = 1e3\nsigma_1 = 20.0\nsigma_2 = 0.5",
    "name = 'maxwell-slip'\nk = [20.0, 40.0, 60.0]\ndelta = [1e-3, 3e-3, 4e-3]\nsigma_2 = 0.5",
];

/// Plants with what they measure, and the size of their drive.
pub(crate) const PLANTS: [(&str, &[&str], f64); 5] = [
    (
        "kind = 'drum'\ninertia = 3e-4\nradius = 0.0254\nk_1 = 20.0\nk_2 = 15.0\nf_10 = 2.0\nf_20 = 2.1\n\
         motor_constant = 1.0\ngear_ratio = 68.8",
        &["current", "angle", "velocity", "force_1", "force_2"],
        1.0,
    ),
    ("kind = 'mass-spring'\nmass = 0.5\nstiffness = 3.0", &["force", "position", "velocity"], 1.0),
    ("kind = 'axis'\ninertia = 0.5\ngain = 1.0", &["voltage", "position", "velocity"], 1.0),
    (
        "kind = 'pendulum'\ninertia = 0.02\nmass = 0.3\nlength = 0.15\ntorque_constant = 0.3\nresistance = 0.3",
        &["voltage", "angle", "velocity"],
        1.0,
    ),
    ("kind = 'prescribed'", &["displacement", "velocity", "force"], 0.02),
];

/// A plant with a friction, on which effects are put.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage {
    pub(crate) plant: (&'static str, &'static [&'static str], f64),
    pub(crate) friction: &'static str,
}

impl Stage {
    /// Every plant with every friction.
    pub(crate) fn all() -> Vec<Self> {
        let with = |friction| PLANTS.iter().map(move |plant| Self { plant: *plant, friction });
        FRICTION.iter().flat_map(|friction| with(*friction)).collect()
    }

    /// Its scenario: 2.5 s of two sines, without noise, with these effects (name and values, without brackets).
    pub(crate) fn text(&self, effects: &[&str]) -> String {
        let (plant, quantities, size) = self.plant;
        let hidden = |effect: &&str| {
            let (name, values) = effect.split_once('\n').unwrap();
            format!("\n[[hidden]]\nname = '{name}'\n{values}\n")
        };
        format!(
            "title = 't'\nduration = 2.5\nrate = 100.0\n[plant]\n{plant}\n[friction]\n{}\n[[input.part]]\n\
             shape = 'sine'\namplitude = {size:?}\nomega = 3.0\n[[input.part]]\nshape = 'sine'\namplitude = {:?}\n\
             omega = 7.7\n{}{}",
            self.friction,
            0.4 * size,
            sensors(quantities),
            effects.iter().map(hidden).collect::<String>()
        )
    }

    /// The record with an effect; with none if its text is empty.
    pub(crate) fn record(&self, effect: &str) -> Made {
        self.try_record(effect).unwrap()
    }

    /// The same; nothing if the effect cannot be had there.
    pub(crate) fn try_record(&self, effect: &str) -> Option<Made> {
        let effects: &[&str] = if effect.is_empty() { &[] } else { &[effect] };
        match Scenario::parse(&self.text(effects)) {
            Ok(scenario) => match make(&scenario, 1) {
                Ok(made) => Some(made),
                Err(error) => panic!("{self:?}\n{effect}: {error}"),
            },
            Err(twin::TwinError::Value { key, .. }) if key == "hidden" => None,
            Err(error) => panic!("{error}"),
        }
    }
}

/// Largest less smallest value.
pub(crate) fn span(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (v.min(low), v.max(high)));
    high - low
}

/// A short scenario in a few words.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    pub(crate) plant: &'static str,
    pub(crate) friction: &'static str,
    /// Speed at the start.
    pub(crate) speed: f64,
    /// The drive's parts, without brackets.
    pub(crate) parts: &'static [&'static str],
    pub(crate) sensors: &'static [&'static str],
}

impl Run {
    /// 4 s of it at 200 Hz with these effects: name, new line, values.
    pub(crate) fn with(&self, effects: &[&str]) -> Made {
        let part = |text: &&str| format!("\n[[input.part]]\n{text}\n");
        let hidden = |effect: &&str| {
            let (name, values) = effect.split_once('\n').unwrap();
            format!("\n[[hidden]]\nname = '{name}'\n{values}\n")
        };
        made(&format!(
            "title = 't'\nduration = 4.0\nrate = 200.0\n[plant]\n{}\n[friction]\n{}\n[start]\nvelocity = {:?}\n{}{}{}",
            self.plant,
            self.friction,
            self.speed,
            self.parts.iter().map(part).collect::<String>(),
            sensors(self.sensors),
            effects.iter().map(hidden).collect::<String>()
        ))
    }
}

/// The largest distance between the same true column of two records.
pub(crate) fn apart(a: &Made, b: &Made, column: &str) -> f64 {
    let pairs = clean(a, column).iter().zip(clean(b, column));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
