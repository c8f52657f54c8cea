//! Quantities of the input and of the model's make, to be set beside what a figure shows.

use super::{Measured, Quantity};
use crate::plan::Study;

/// Points of a period at which the input is looked at.
const POINTS: u32 = 1000;

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, ($method:literal, $second:literal), $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "",
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            takes: &[],
            code: concat!("crates/experiment/src/quantities/input.rs, ", stringify!($const)),
            measure: $measure,
        };
    };
}

quantity!(
    LARGEST_DISPLACEMENT,
    "largest_displacement",
    "m",
    "largest u of the input",
    ("the input's range", "the largest u at 1000 times of a period and at the turns"),
    |plan, subject| {
        let study = &plan.studies[subject.study];
        Ok(Measured::of(study.input.range().1, seen(study).1))
    }
);

quantity!(
    SMALLEST_DISPLACEMENT,
    "smallest_displacement",
    "m",
    "smallest u of the input",
    ("the input's range", "the smallest u at 1000 times of a period and at the turns"),
    |plan, subject| {
        let study = &plan.studies[subject.study];
        Ok(Measured::of(study.input.range().0, seen(study).0))
    }
);

quantity!(
    LARGEST_SPEED,
    "largest_speed",
    "m/s",
    "largest |u̇| of a sinusoidal input",
    ("half the input's range times ω", "the largest |u̇| at 1000 times of a period"),
    |plan, subject| {
        let study = &plan.studies[subject.study];
        let (u_min, u_max) = study.input.range();
        let omega = std::f64::consts::TAU / study.period;
        let speed = |i: u32| study.input.u_dot(time(study, i)).abs();
        let seen = (0..=POINTS).map(speed).fold(0.0, f64::max);
        Ok(Measured::of(0.5 * (u_max - u_min) * omega, seen))
    }
);

quantity!(
    STATES,
    "states",
    "1",
    "number of the model's internal states; of Maxwell-slip elements their number N",
    ("the model's dimension", "the entries of ẋ that the model writes"),
    |plan, subject| {
        let study = &plan.studies[subject.study];
        let point = &study.points[*subject.points.first().ok_or("no point of the sweep")?];
        let model = study.model_at(point)?;
        let mut written = vec![f64::NAN; model.states()];
        model.x_dot(&study.initial, 0.0, 1.0, &mut written);
        let count = written.iter().filter(|x_dot| x_dot.is_finite()).count();
        Ok(Measured::of(model.states() as f64, count as f64))
    }
);

fn time(study: &Study, i: u32) -> f64 {
    study.span - study.period * f64::from(i) / f64::from(POINTS)
}

/// The smallest and the largest u on a grid of one period, and at its turns.
fn seen(study: &Study) -> (f64, f64) {
    let corners = study.input.corners(study.span - study.period, study.span);
    let grid = (0..=POINTS).map(|i| time(study, i)).chain(corners);
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    grid.map(|t| study.input.u(t)).fold(ends, |(low, high), u| (low.min(u), high.max(u)))
}
