//! A plant with Dahl friction under a harmonic drive, by power series from reversal to reversal.
//!
//! Between reversals everything is analytic: the drive is a sine, the plant linear, and F a function of
//! the displacement alone. A series of high order goes as far as its coefficients say, its polynomial is
//! what is delivered, and the roots of its velocity are the reversals, found to the last digit.
//! No reversal is too small to count except one that rounding cannot tell from a touch of v = 0.

mod run;
mod series;
mod turn;

use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{Dahl, sgn};
use integrate::{Failure, Limits, Outcome, Work};
use run::Run;
use series::{Equations, Series, State, TERMS};

/// A plant with Dahl friction under a harmonic drive.
pub(super) const METHOD: Own = Own {
    name: "dahl-series",
    holds: "a plant with Dahl friction, γ ≥ 1, under a sine, an offset cosine or a constant drive",
    build: |task| Ok(Box::new(DahlSeries::new(task)?)),
};

#[derive(Debug)]
struct DahlSeries {
    equations: Equations,
    y0: [f64; 3],
    span: (f64, f64),
}

impl DahlSeries {
    fn new(task: &Task) -> Result<Self, NotHere> {
        let refuse = |found: String, expected| NotHere { method: "dahl-series", found, expected };
        if task.model.name != "dahl" {
            return Err(refuse(format!("the model {}", task.model.name), "dahl"));
        }
        let dahl = Dahl::new(&task.parameters)
            .map_err(|error| refuse(error.to_string(), "the parameters of Dahl"))?;
        if dahl.gamma < 1.0 {
            let why = "γ ≥ 1: below, F arrives at F_C where it has no series";
            return Err(refuse(format!("γ = {}", dahl.gamma), why));
        }
        let Some(plant) = task.plant else {
            return Err(refuse("an imposed motion".to_owned(), "a plant"));
        };
        if !(plant.mass > 0.0 && plant.stiffness >= 0.0) {
            return Err(refuse(format!("{plant:?}"), "a positive mass and no negative stiffness"));
        }
        let Some(drive) = task.input.harmonic() else {
            let why = "a sine, an offset cosine or a constant";
            return Err(refuse("a drive that is no sine".to_owned(), why));
        };
        let (start, end) = task.span;
        if !(start.is_finite() && end.is_finite() && start < end) {
            return Err(refuse(format!("the span [{start}, {end}] s"), "a finite span that rises"));
        }
        match task.y0[..] {
            [q, v, f] if q.is_finite() && v.is_finite() && f.abs() <= dahl.f_c => {
                let equations = Equations { dahl, plant, drive };
                Ok(Self { equations, y0: [q, v, f], span: task.span })
            }
            _ => {
                let found = format!("the initial state {:?}", task.y0);
                Err(refuse(found, "q, v and F, all finite, with |F| ≤ F_C"))
            }
        }
    }
}

impl Solves for DahlSeries {
    fn deliver(&self, rtol: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        states.fill(f64::NAN);
        if !(rtol > 0.0 && rtol.is_finite()) {
            let why = Failure::Stopped(format!("a tolerance must be positive, found {rtol}"));
            let outcome = Outcome::Failed { at: self.span.0, why };
            return Delivered { work: Work::default(), outcome };
        }
        let of = &self.equations;
        let [q, v, f] = self.y0;
        // Without a direction w is told from F as if it went forwards.
        let s = if v == 0.0 { 1.0 } else { sgn(v) };
        let from = State { t: self.span.0, q, v, w: 1.0 - s * f / of.dahl.f_c, s };
        let stiffness = of.plant.stiffness + of.dahl.d_plus(-of.dahl.f_c);
        let h = 2.0 / (stiffness / of.plant.mass).sqrt();
        let mut run = Run {
            of,
            rtol,
            most: limits.evaluations,
            end: self.span.1,
            series: Series::new(order(rtol), h, from),
            grid,
            states,
            work: Work { rejected: Some(0), ..Work::default() },
        };
        let outcome = match run.march(from) {
            Ok(()) => Outcome::Solved,
            Err((at, why)) => Outcome::Failed { at, why },
        };
        Delivered { work: run.work, outcome }
    }
}

/// The order of the series: half a swing of the mass is one of them at any tolerance.
fn order(rtol: f64) -> usize {
    let digits = -rtol.log10().clamp(-16.0, -1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "15 to 35")]
    let order = (14.0 + 4.0 / 3.0 * digits).round() as usize;
    order.min(TERMS - 2)
}
