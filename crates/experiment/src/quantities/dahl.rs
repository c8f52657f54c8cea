//! Quantities of the Dahl model: the closed form, and the same by quadrature and root finding.

use super::{Measured, Quantity};
use crate::plan::{Plan, Study, Subject};
use duhem::{
    Dahl,
    closed_form::{
        dahl::{
            Loop, alpha_plus, contraction, falling, falling_as_printed, saturation_travel,
            work_over,
        },
        second_way,
        semilinear::Semilinear,
    },
};

const CLOSED: &str = "closed form";
const QUADRATURE: &str = "double-exponential quadrature of du = dF/D±(F) and bisection";
const THEOREM_1: &str = "Theorem 1, equations 9 and 10, by matrix exponentials";

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, ($method:expr, $second:expr), $file:literal, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "dahl",
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            takes: &[],
            code: concat!("crates/duhem/src/closed_form/dahl/", $file),
            measure: $measure,
        };
    };
}

quantity!(
    FORCE_AT_TURN,
    "force_at_turn",
    "N",
    "force at the right turning point of the settled loop",
    (CLOSED, QUADRATURE),
    "settled.rs, Loop::new",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.force_at_u_max, second.force_at_u_max()))
    }
);

quantity!(
    LOOP_AREA,
    "loop_area",
    "J",
    "area of the settled loop, ∮F du",
    (CLOSED, QUADRATURE),
    "settled.rs, Loop::area",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.area(), second.area()))
    }
);

quantity!(
    FORCE_RISING_AT_ZERO,
    "force_rising_at_zero",
    "N",
    "force of the settled loop at u = 0, u increasing",
    (CLOSED, QUADRATURE),
    "settled.rs, Loop::force",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.force(0.0, true), second.force(0.0, true)))
    }
);

quantity!(
    LAG,
    "lag",
    "m",
    "displacement from the turning point to F = 0",
    (CLOSED, QUADRATURE),
    "settled.rs, Loop::lag",
    |plan, subject| {
        let (ours, second) = loops(plan, subject)?;
        Ok(Measured::of(ours.lag(), second.lag()))
    }
);

quantity!(
    SATURATION_TRAVEL,
    "saturation_travel",
    "m",
    "displacement from F = −F_C to F = F_C",
    (CLOSED, QUADRATURE),
    "mod.rs, saturation_travel",
    |plan, subject| {
        let (dahl, _) = model(plan, subject)?;
        let infinite = || "the force never arrives for γ ≥ 1".to_owned();
        let ours = saturation_travel(&dahl).ok_or_else(infinite)?;
        Ok(Measured::of(ours, second_way::saturation_travel(&dahl).ok_or_else(infinite)?))
    }
);

quantity!(
    FIRST_PERIOD_WORK,
    "first_period_work",
    "J",
    "work of friction over the first period, from the initial force",
    (CLOSED, QUADRATURE),
    "work.rs, work_over",
    |plan, subject| {
        let (dahl, study) = model(plan, subject)?;
        let span = (0.0, study.period);
        let ours = work_over(&dahl, &study.input, study.initial[0], span);
        Ok(Measured::of(ours, work_again(&dahl, study)))
    }
);

quantity!(
    CONTRACTION,
    "contraction",
    "1",
    "left side of (16): what is left of a difference in force after one period",
    (CLOSED, THEOREM_1),
    "corollary.rs, contraction",
    |plan, subject| {
        let (dahl, study) = model(plan, subject)?;
        let (u_min, u_max) = study.input.range();
        let theorem = Semilinear::of_dahl(&dahl).map_err(|e| e.to_string())?;
        let beta = u_max - u_min;
        Ok(Measured::of(contraction(&dahl, beta), theorem.spectral_radius(beta)))
    }
);

quantity!(
    ALPHA_PLUS,
    "alpha_plus",
    "N",
    "α₊ of (17): force at the left turning point",
    (CLOSED, QUADRATURE),
    "corollary.rs, alpha_plus",
    |plan, subject| {
        let (dahl, study) = model(plan, subject)?;
        let (u_min, u_max) = study.input.range();
        let (_, second) = loops(plan, subject)?;
        Ok(Measured::of(alpha_plus(&dahl, u_max - u_min), -second.force_at_u_max()))
    }
);

quantity!(
    F_MINUS_AT_ZERO,
    "f_minus_at_zero",
    "N",
    "F₋(0) of (17) with the sign mended",
    (CLOSED, QUADRATURE),
    "corollary.rs, falling",
    |plan, subject| {
        let (dahl, study) = model(plan, subject)?;
        let (_, second) = loops(plan, subject)?;
        Ok(Measured::of(falling(&dahl, study.input.range(), 0.0), second.force(0.0, false)))
    }
);

quantity!(
    F_MINUS_AT_ZERO_AS_PRINTED,
    "f_minus_at_zero_as_printed",
    "N",
    "F₋(0) of (17) to the letter",
    ("closed form", "the mended F₋ plus what the misprint adds, 2 F_C sinh(βσ/(2F_C))"),
    "corollary.rs, falling_as_printed",
    |plan, subject| {
        let (dahl, study) = model(plan, subject)?;
        let (u_min, u_max) = study.input.range();
        let (_, second) = loops(plan, subject)?;
        let misprint = 2.0 * dahl.f_c * (dahl.sigma * (u_max - u_min) / (2.0 * dahl.f_c)).sinh();
        let ours = falling_as_printed(&dahl, (u_min, u_max), 0.0);
        Ok(Measured::of(ours, second.force(0.0, false) + misprint))
    }
);

quantity!(
    SPEED_AT_ZERO_FORCE,
    "speed_at_zero_force",
    "m/s",
    "speed when F passes zero on the settled loop, a magnitude",
    (CLOSED, "the lag by quadrature, the speed from the input at the time found by bisection"),
    "settled.rs, Loop::lag",
    |plan, subject| {
        let (_, study) = model(plan, subject)?;
        let (ours, second) = loops(plan, subject)?;
        let (u_min, u_max) = study.input.range();
        // Of a harmonic motion about the middle: u̇² = ω²(a² − (u − middle)²).
        let (a, omega) = (0.5 * (u_max - u_min), std::f64::consts::TAU / study.period);
        let from_middle = a - ours.lag();
        let speed = omega * (a * a - from_middle * from_middle).sqrt();
        Ok(Measured::of(speed, speed_again(study, u_max - second.lag())))
    }
);

fn model<'a>(plan: &'a Plan, subject: &Subject) -> Result<(Dahl, &'a Study), String> {
    let study = &plan.studies[subject.study];
    if study.plant.is_some() {
        return Err("a plant where an imposed motion is needed".to_owned());
    }
    let point = &study.points[*subject.points.first().ok_or("no point of the sweep")?];
    Ok((Dahl::new(&point.parameters).map_err(|e| e.to_string())?, study))
}

/// The settled loop in both ways.
fn loops(plan: &Plan, subject: &Subject) -> Result<(Loop, second_way::Loop), String> {
    let (dahl, study) = model(plan, subject)?;
    let range = study.input.range();
    Ok((Loop::new(&dahl, range), second_way::Loop::new(&dahl, range)))
}

/// The work over the first period, arc by arc, by quadrature.
fn work_again(dahl: &Dahl, study: &Study) -> f64 {
    let mut bounds = vec![0.0];
    bounds.extend(study.input.corners(0.0, study.period));
    bounds.push(study.period);
    let (mut force, mut work) = (study.initial[0], 0.0);
    for arc in bounds.windows(2) {
        let travel = study.input.u(arc[1]) - study.input.u(arc[0]);
        work += second_way::work(dahl, force, travel);
        force = second_way::advance(dahl, force, travel);
    }
    work
}

/// The speed where u falls through `u`, after the first right turning point.
fn speed_again(study: &Study, u: f64) -> f64 {
    let (_, u_max) = study.input.range();
    let corners = study.input.corners(-0.01 * study.period, 2.0 * study.period);
    let top =
        corners.iter().find(|t| (study.input.u(**t) - u_max).abs() < 1e-9 * u_max.abs().max(1.0));
    let mut low = top.copied().unwrap_or(0.0);
    let mut high = low + 0.5 * study.period;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if study.input.u(middle) > u { low = middle } else { high = middle }
    }
    study.input.u_dot(low).abs()
}
