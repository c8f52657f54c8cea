//! Quantities of a plant with Dahl friction in the limit of an infinitely slow drive.

use super::{Measured, Quantity};
use crate::plan::{Plan, Subject};
use duhem::{
    Dahl, Plant,
    closed_form::{
        dahl::quasi_static::{QuasiStaticLoop, first_way},
        second_way,
    },
};

const FIRST: &str = "k_s q + F(q) = F_e along the closed form of F";
const SECOND: &str =
    "the same balance by bisection, with F from double-exponential quadrature of dq = dF/D±(F)";

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "dahl",
            unit: $unit,
            what: $what,
            method: FIRST,
            second: SECOND,
            code: "crates/duhem/src/closed_form/dahl/quasi_static.rs",
            takes: &[],
            measure: $measure,
        };
    };
}

quantity!(
    Q_MAX,
    "quasi_static_q_max",
    "m",
    "largest displacement of the quasi-static loop",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.q_max(), second.0))
    }
);

quantity!(
    AREA,
    "quasi_static_area",
    "J",
    "area of the quasi-static loop, ∮F_e dq",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.area(), second.1))
    }
);

quantity!(
    FIRST_PEAK,
    "quasi_static_first_peak",
    "m",
    "displacement at the first peak of the drive from rest, quasi-static",
    |plan, subject| {
        let (dahl, plant, amplitude) = of(plan, subject)?;
        let ours = first_way(&dahl, plant.stiffness, amplitude);
        let left = |q: f64| amplitude - plant.stiffness * q - second_way::advance(&dahl, 0.0, q);
        Ok(Measured::of(ours, bisect(amplitude / plant.stiffness, &left)))
    }
);

/// The model, the plant, and the amplitude of the force that drives it.
fn of(plan: &Plan, subject: &Subject) -> Result<(Dahl, Plant, f64), String> {
    let study = &plan.studies[subject.study];
    let point = &study.points[subject.points.first().copied().ok_or("no point of the sweep")?];
    let plant = point.plant.ok_or("an imposed motion where a plant is needed")?;
    let dahl = Dahl::new(&point.parameters).map_err(|e| e.to_string())?;
    let (low, high) = study.input.range();
    let (low, high) = (plant.drive(low), plant.drive(high));
    if (low + high).abs() > 1e-12 * high.abs() {
        return Err("the quasi-static loop is that of a drive as far up as down".to_owned());
    }
    Ok((dahl, plant, high))
}

/// The loop, and the second way's largest displacement and area.
fn loops(plan: &Plan, subject: &Subject) -> Result<(QuasiStaticLoop, (f64, f64)), String> {
    let (dahl, plant, amplitude) = of(plan, subject)?;
    let settled = |q: f64| second_way::Loop::new(&dahl, (-q, q));
    let left = |q: f64| amplitude - plant.stiffness * q - settled(q).force_at_u_max();
    let q_max = bisect(amplitude / plant.stiffness, &left);
    let area = settled(q_max).area();
    Ok((QuasiStaticLoop::new(&dahl, plant.stiffness, amplitude), (q_max, area)))
}

/// Where a falling function is zero between 0 and `high`, to the last digit.
fn bisect(mut high: f64, left: &dyn Fn(f64) -> f64) -> f64 {
    let mut low = 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if left(middle) > 0.0 { low = middle } else { high = middle }
    }
}
