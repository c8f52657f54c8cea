//! What an effect says of itself: its name, its physics, its parameters.

use crate::{Rig, rig::Kind as Plant};

/// Which channel shows an effect first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// The balance of torques or forces.
    Torque,
    /// Displacement against velocity.
    Kinematics,
    /// The load cells.
    Loads,
}

/// What a parameter is measured in: its unit and its natural size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// A pure number.
    One,
    /// The amplitude of a wave, a pure number: of a long one a record sees a part, and the rest may be anything.
    Amplitude,
    /// The drive's own unit: A, V, N or N·m.
    Input,
    /// N or N·m.
    Force,
    /// N, also on a drum, whose springs are pulled.
    Pull,
    /// N/s.
    PullRate,
    /// N·s/m or N·m·s/rad.
    Damping,
    /// N·s²/m² or N·m·s²/rad².
    Drag,
    /// N/m or N·m/rad.
    Stiffness,
    /// m/N or rad/(N·m).
    Flexibility,
    /// N/m³.
    Cubic,
    /// m/s or rad/s.
    Speed,
    /// m or rad.
    Length,
    /// 1/m or 1/rad.
    Wavenumber,
    /// s.
    Time,
}

impl Measure {
    /// The units of what slides and of what turns; of an input those of a force.
    pub fn units(self) -> [&'static str; 2] {
        match self {
            Self::One | Self::Amplitude => ["", ""],
            Self::Input | Self::Force => ["N", "N·m"],
            Self::Pull => ["N", "N"],
            Self::PullRate => ["N/s", "N/s"],
            Self::Damping => ["N·s/m", "N·m·s/rad"],
            Self::Drag => ["N·s²/m²", "N·m·s²/rad²"],
            Self::Stiffness => ["N/m", "N·m/rad"],
            Self::Flexibility => ["m/N", "rad/(N·m)"],
            Self::Cubic => ["N/m³", "N·m/rad³"],
            Self::Speed => ["m/s", "rad/s"],
            Self::Length => ["m", "rad"],
            Self::Wavenumber => ["1/m", "1/rad"],
            Self::Time => ["s", "s"],
        }
    }
}

/// Which values are plausible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// Of either sign.
    Any,
    /// Not negative.
    Positive,
    /// Not positive.
    Negative,
}

/// Whether a parameter is how much of the effect there is, or what the effect is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// How much: at zero there is no effect.
    Amount,
    /// What it is like: always positive, probed at a few values, and fitted with the amount.
    Fitted,
    /// What it is like, probed at a few values and then kept.
    Probed,
    /// What more of the same is like: as usual until it is asked for, and then fitted.
    Spare,
}

/// No number in a rig file is larger, nor smaller than one over it.
const LARGEST: f64 = 1e60;

/// A parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// Its key in the rig file.
    pub name: &'static str,
    /// Its unit and natural size.
    pub measure: Measure,
    /// Amount or shape.
    pub shape: Shape,
    /// Which values are plausible.
    pub sign: Sign,
    /// The largest plausible size, of its natural one.
    pub most: f64,
    /// What it is where a rig file does not say it.
    pub usual: Option<f64>,
}

impl Key {
    /// An amount of either sign, up to `most` of its natural size.
    pub const fn amount(name: &'static str, measure: Measure, most: f64) -> Self {
        Self { name, measure, shape: Shape::Amount, sign: Sign::Any, most, usual: None }
    }

    /// An amount that cannot be negative.
    pub const fn positive(name: &'static str, measure: Measure, most: f64) -> Self {
        Self { sign: Sign::Positive, ..Self::amount(name, measure, most) }
    }

    /// A shape that is fitted.
    pub const fn fitted(name: &'static str, measure: Measure) -> Self {
        Self { shape: Shape::Fitted, ..Self::positive(name, measure, 1e3) }
    }

    /// A shape that is probed, 1 where a rig file does not say it.
    pub const fn probed(name: &'static str, measure: Measure) -> Self {
        Self { shape: Shape::Probed, usual: Some(1.0), ..Self::positive(name, measure, 1e3) }
    }

    /// A shape of more of the same, which is `usual` until it is asked for.
    pub const fn spare(name: &'static str, measure: Measure, usual: f64) -> Self {
        Self { shape: Shape::Spare, ..Self::fitted(name, measure).usually(usual) }
    }

    /// The same, but for what it is where a rig file does not say it [its unit].
    #[must_use]
    pub const fn usually(self, value: f64) -> Self {
        Self { usual: Some(value), ..self }
    }

    /// The same, but with another largest plausible size, of its natural one.
    #[must_use]
    pub const fn up_to(self, most: f64) -> Self {
        Self { most, ..self }
    }

    /// The smallest and the largest value that can be meant whatever the record: a shape is positive, an amount has
    /// its sign, and one that is a pure number is no larger than plausible.
    pub fn bounds(&self) -> (f64, f64) {
        let pure = self.measure == Measure::One && self.shape == Shape::Amount;
        let most = if pure { self.most } else { LARGEST };
        match (self.shape, self.sign) {
            (Shape::Fitted | Shape::Probed | Shape::Spare, _) => (1.0 / LARGEST, LARGEST),
            (Shape::Amount, Sign::Any) => (-most, most),
            (Shape::Amount, Sign::Positive) => (0.0, most),
            (Shape::Amount, Sign::Negative) => (-most, 0.0),
        }
    }

    /// What the bounds leave, in words.
    pub(crate) fn words(&self) -> &'static str {
        match (self.shape, self.sign) {
            (Shape::Fitted | Shape::Probed | Shape::Spare, _) => "a positive, finite number",
            (Shape::Amount, Sign::Any) => "a finite number",
            (Shape::Amount, Sign::Positive) => "a finite number, zero or more",
            (Shape::Amount, Sign::Negative) => "a finite number, zero or less",
        }
    }
}

/// So many wavenumbers that a record shows most of are kept.
pub const WAVES: usize = 6;

/// The sizes of a record, in which effects are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Context {
    /// Largest input [its unit].
    pub input: f64,
    /// Size of the friction [N], or of the drive where there is none.
    pub force: f64,
    /// Largest drive [N].
    pub drive: f64,
    /// How many load cells there are.
    pub cells: usize,
    /// Size of what the load cells show [N].
    pub pull: f64,
    /// Largest speed [m/s].
    pub speed: f64,
    /// The smallest displacement [m].
    pub low: f64,
    /// How far the displacement goes, from the smallest to the largest [m].
    pub span: f64,
    /// The distance over which the contact forgets where it was [m].
    pub memory: f64,
    /// Length of the record [s].
    pub duration: f64,
    /// Sampling time [s].
    pub sample_time: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Whether the plant turns.
    pub turns: bool,
    /// Whether springs or weight pull.
    pub loaded: bool,
    /// Whether the displacement may be the motor's, with a load hidden beyond it.
    pub hidden: bool,
    /// The wavenumbers that the record shows most of, in a force and in friction; 0 for none [1/m].
    pub waves: [[f64; WAVES]; 2],
    /// Up to so many half waves on the whole way are tried one after another, if more than an effect asks for.
    pub halves: u32,
}

impl Context {
    /// The natural size of a measure.
    pub fn size(&self, measure: Measure) -> f64 {
        match measure {
            Measure::One | Measure::Amplitude => 1.0,
            Measure::Input => self.input,
            Measure::Force => self.force,
            Measure::Pull => self.pull,
            Measure::PullRate => self.pull / self.duration,
            Measure::Damping => self.force / self.speed,
            Measure::Drag => self.force / (self.speed * self.speed),
            Measure::Stiffness => self.force / self.span,
            Measure::Flexibility => self.span / self.force,
            Measure::Cubic => self.force / (0.5 * self.span).powi(3),
            Measure::Speed => self.speed,
            Measure::Length => self.span,
            Measure::Wavenumber => std::f64::consts::TAU / self.span,
            Measure::Time => self.sample_time,
        }
    }
}

/// What an effect says of itself.
#[derive(Debug)]
pub struct About {
    /// Its name, as rig files and answers have it.
    pub name: &'static str,
    /// Its physics, in a line.
    pub physics: &'static str,
    /// What it changes: F is the friction of the model, u its input, q its displacement; the parameters go by their keys.
    pub equation: &'static str,
    /// The channel that shows it first.
    pub channel: Channel,
    /// Its parameters.
    pub keys: &'static [Key],
    /// The shapes that are tried: for each probe the values of the keys that are shapes, in their order; none
    /// where the record cannot show it.
    pub probes: fn(&Context) -> Vec<Vec<f64>>,
    /// When a model can lack it.
    pub applies: fn(&Rig) -> bool,
    /// What it is confused with.
    pub confused: &'static [&'static str],
    /// What would separate it from those.
    pub separated_by: &'static str,
    /// The amount used in its own tests, of its natural size.
    pub test: f64,
}

impl About {
    /// One probe, of an effect that has no shape.
    pub fn no_shape(_: &Context) -> Vec<Vec<f64>> {
        vec![Vec::new()]
    }

    /// The unit of a parameter in `rig`.
    pub fn unit(&self, key: &str, rig: &Rig) -> &'static str {
        let Some(key) = self.keys.iter().find(|k| k.name == key) else { return "" };
        let turns = Plant::of(rig.kind).is_some_and(Plant::turns);
        let unit = key.measure.units()[usize::from(turns)];
        if key.measure == Measure::Input {
            let seen = |(channel, unit)| rig.channels.contains_key(channel).then_some(unit);
            let own = [("current", "A"), ("voltage", "V")].into_iter().find_map(seen);
            return own.unwrap_or(unit);
        }
        unit
    }
}

#[cfg(test)]
mod tests {
    use crate::effects::{LAWS, Shape};

    #[test]
    fn an_equation_has_every_amount_and_every_shape_that_is_fitted() {
        for about in LAWS.iter().map(|kind| kind.about()) {
            let words = || about.equation.split(|c: char| !c.is_alphanumeric() && c != '_');
            // A second one of the same is told by the first, and of which form it is where the table is.
            let told = |name: &str| {
                let first = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
                words().any(|word| word == name || word.trim_end_matches("_i") == first)
            };
            for key in about.keys.iter().filter(|key| key.shape != Shape::Spare) {
                let said = key.name == "form" || told(key.name);
                assert!(said, "{}: {} is not in \"{}\"", about.name, key.name, about.equation);
            }
        }
    }
}
