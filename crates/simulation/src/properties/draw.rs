//! Plants drawn at random, each from one seed.

use crate::{
    displacement::{ByDisplacement, RateIndependent},
    energy::Contact,
};
use duhem::{Dahl, Input, InputError, LuGre, MaxwellSlip, Plant};
use std::f64::consts::TAU;

/// The generator splitmix64: the same numbers everywhere and for ever.
#[derive(Debug, Clone)]
pub(crate) struct Draw(pub u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        // The upper 53 bits are a fraction that f64 holds exactly.
        low + (high - low) * ((self.next() >> 11) as f64 / 9_007_199_254_740_992.0)
    }

    /// Between `low` and `high`, uniform in the logarithm.
    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// One of the `choices`.
    fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        let place = self.uniform(0.0, choices.len() as f64);
        let at = (1..choices.len()).take_while(|i| *i as f64 <= place).count();
        choices[at]
    }
}

/// A plant, a drive, a window of time and a state to begin with.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub contact: Contact,
    pub plant: Plant,
    pub input: Input,
    pub span: (f64, f64),
    pub y0: Vec<f64>,
}

impl Case {
    /// The plant with rate-independent friction; none for LuGre.
    pub(super) fn by_displacement(&self) -> Option<ByDisplacement> {
        let friction = match &self.contact {
            Contact::Dahl(model) => RateIndependent::Dahl(model.clone()),
            Contact::MaxwellSlip(model) => RateIndependent::MaxwellSlip(model.clone()),
            Contact::LuGre(_) => return None,
        };
        Some(ByDisplacement { friction, plant: self.plant, input: self.input.clone() })
    }

    /// Another state to begin with.
    pub(super) fn redraw(&self, draw: &mut Draw) -> Vec<f64> {
        let limit = draw.uniform(0.1, 2.0) / self.plant.stiffness;
        state(draw, &self.contact, limit, self.plant)
    }
}

/// The kinds of friction drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Dahl,
    MaxwellSlip,
    LuGre,
}

/// A case of this kind: a spring of 0.1 to 10 N/m with a mass of 0.1 to 10 kg, friction of 0.1 to 1 N on contacts
/// up to thirty times as stiff (LuGre: thirty thousand times), driven from below to far above friction, over up to twenty periods of the contact.
pub(super) fn case(draw: &mut Draw, kind: Kind) -> Result<Case, InputError> {
    let (mass, stiffness) = (draw.log_uniform(0.1, 10.0), draw.log_uniform(0.1, 10.0));
    let (limit, k) = (draw.log_uniform(0.1, 1.0), stiffness * draw.log_uniform(1.0, 30.0));
    let k = if kind == Kind::LuGre { k * draw.log_uniform(1.0, 1000.0) } else { k };
    let contact = match kind {
        Kind::Dahl => {
            let gamma = draw.pick(&[0.0, 0.5, 1.0, 2.0]);
            Contact::Dahl(Dahl { f_c: limit, sigma: k, gamma })
        }
        Kind::MaxwellSlip => Contact::MaxwellSlip(elements(draw, limit, k)),
        Kind::LuGre => Contact::LuGre(lugre(draw, limit, k, mass)),
    };
    let plant = Plant { mass, stiffness, gain: 1.0, offset: limit * draw.uniform(-0.5, 0.5) };
    let amplitude = limit * draw.log_uniform(0.3, 10.0);
    let omega = draw.log_uniform(0.05, 3.0) * (stiffness / mass).sqrt();
    let input = match draw.uniform(0.0, 3.0) {
        kind if kind < 1.0 => Input::cosine_offset(amplitude, omega)?,
        kind if kind < 1.5 && !matches!(contact, Contact::MaxwellSlip(_)) => {
            Input::triangle(amplitude, omega)?
        }
        _ => Input::sine(amplitude, omega)?,
    };
    let start = draw.uniform(0.0, TAU / omega);
    let end = start + draw.uniform(3.0, 20.0) * TAU / ((stiffness + k) / mass).sqrt();
    let y0 = state(draw, &contact, limit / stiffness, plant);
    Ok(Case { contact, plant, input, span: (start, end), y0 })
}

/// One to six elements that share the stiffness `k` [N/m]; now and then two have the same deadband.
fn elements(draw: &mut Draw, limit: f64, k: f64) -> MaxwellSlip {
    let n = draw.pick(&[1_u32, 2, 3, 6]);
    let mut delta: Vec<f64> = (0..n).map(|_| limit / k * draw.log_uniform(0.3, 3.0)).collect();
    if n > 2 && draw.uniform(0.0, 1.0) < 0.5 {
        delta[1] = delta[0];
    }
    MaxwellSlip { k: delta.iter().map(|_| k / f64::from(n)).collect(), delta }
}

/// With σ₂ ≥ σ₁(F_S − F_C)/F_C, which makes the model passive from u̇ to F.
fn lugre(draw: &mut Draw, f_c: f64, sigma_0: f64, mass: f64) -> LuGre {
    let excess = draw.uniform(0.0, 1.0);
    let sigma_1 = draw.uniform(0.0, 1.0) * (sigma_0 * mass).sqrt();
    let sigma_2 = sigma_1 * excess * draw.uniform(1.0, 2.0);
    let v_s = draw.log_uniform(0.03, 1.0) * f_c / (sigma_0 * mass).sqrt();
    LuGre { f_c, f_s: f_c * (1.0 + excess), v_s, sigma_0, sigma_1, sigma_2 }
}

/// A state within the friction's bounds, with q up to `size` [m].
fn state(draw: &mut Draw, contact: &Contact, size: f64, plant: Plant) -> Vec<f64> {
    let q = size * draw.uniform(-1.0, 1.0);
    let v = size * draw.uniform(-1.0, 1.0) * (plant.stiffness / plant.mass).sqrt();
    let mut y = vec![q, v];
    match contact {
        Contact::Dahl(model) => y.push(model.f_c * draw.uniform(-1.0, 1.0)),
        Contact::LuGre(model) => y.push(model.f_s / model.sigma_0 * draw.uniform(-1.0, 1.0)),
        Contact::MaxwellSlip(model) => {
            y.extend(model.delta.iter().map(|delta| q - delta * draw.uniform(-1.0, 1.0)));
        }
    }
    y
}
