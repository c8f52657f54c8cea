//! Quantities of the Maxwell-slip model: element by element, and as one operator by Masing's rule.

use super::{Measured, Quantity};
use crate::plan::{Plan, Study, Subject};
use duhem::{
    MaxwellSlip,
    closed_form::{
        masing,
        maxwell_slip::{Loop, Trajectory, dissipation_as_printed},
    },
};

const EXACT: &str = "element by element, stop operators";
const MASING: &str = "virgin curve and Masing's rule with wiping-out, no element followed";
const ENERGY: &str =
    "energy stored at the end plus k_iΔ_i for each metre slipped, by play operators";

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, ($method:expr, $second:expr), $code:literal, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "maxwell-slip",
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            takes: &[],
            code: concat!("crates/duhem/src/closed_form/maxwell_slip.rs, ", $code),
            measure: $measure,
        };
    };
}

quantity!(
    FORCE_MAX,
    "force_max",
    "N",
    "largest force over the span, from the initial positions",
    (EXACT, MASING),
    "Trajectory::largest_force",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let run = from_start(&model, study, study.span)?;
        let turns = run.turns();
        let forces = (1..=turns.len()).map(|n| masing::force(&model, &turns[..n]));
        Ok(Measured::of(run.largest_force(), forces.fold(f64::NEG_INFINITY, f64::max)))
    }
);

quantity!(
    FORCE_AT_TURN,
    "force_at_turn",
    "N",
    "force at the right turning point of the settled loop",
    (EXACT, MASING),
    "Loop::force_at_u_max",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let ours = settled(&model, study)?;
        Ok(Measured::of(ours.force_at_u_max(), after(&model, study, &[ours.u_min, ours.u_max])?))
    }
);

quantity!(
    FORCE_AT_LEFT_TURN,
    "force_at_left_turn",
    "N",
    "force at the left turning point of the settled loop",
    (EXACT, MASING),
    "Loop::force",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let ours = settled(&model, study)?;
        let second = after(&model, study, &[ours.u_max, ours.u_min])?;
        Ok(Measured::of(ours.force(ours.u_min, true), second))
    }
);

quantity!(
    FORCE_RISING_AT_ZERO,
    "force_rising_at_zero",
    "N",
    "force of the settled loop at u = 0, u increasing",
    (EXACT, MASING),
    "Loop::force",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let ours = settled(&model, study)?;
        Ok(Measured::of(ours.force(0.0, true), after(&model, study, &[ours.u_min, 0.0])?))
    }
);

quantity!(
    LOOP_AREA,
    "loop_area",
    "J",
    "area of the settled loop, ∮F du",
    (EXACT, "Masing's rule: twice the area between the virgin curve, doubled, and its chord"),
    "Loop::area",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let ours = settled(&model, study)?;
        Ok(Measured::of(ours.area(), masing::area(&model, ours.u_max - ours.u_min)))
    }
);

quantity!(
    FIRST_PERIOD_WORK,
    "first_period_work",
    "J",
    "work of friction over the first period, from the initial positions",
    (EXACT, ENERGY),
    "Trajectory::work",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let run = from_start(&model, study, study.period)?;
        Ok(Measured::of(run.work(), masing::work(&model, &run.turns())))
    }
);

quantity!(
    LAG,
    "lag",
    "m",
    "displacement from the turning point to F = 0",
    (EXACT, "Masing's rule and bisection"),
    "Loop::lag",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let ours = settled(&model, study)?;
        let lag = ours.lag().ok_or("the force does not change sign on the settled loop")?;
        Ok(Measured::of(lag, masing::lag(&model, ours.u_max - ours.u_min)))
    }
);

quantity!(
    AS_PRINTED,
    "paper_formula",
    "J",
    "Σ k_iΔ_i², the paper's formula for the energy lost",
    (
        "the sum",
        "the energy that the springs give back in one cycle of the settled loop, from its turns"
    ),
    "dissipation_as_printed",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        Ok(Measured::of(dissipation_as_printed(&model), settled(&model, study)?.returned()))
    }
);

pub(crate) fn model<'a>(
    plan: &'a Plan,
    subject: &Subject,
) -> Result<(MaxwellSlip, &'a Study), String> {
    let study = &plan.studies[subject.study];
    let point = &study.points[*subject.points.first().ok_or("no point of the sweep")?];
    Ok((MaxwellSlip::new(&point.parameters).map_err(|e| e.to_string())?, study))
}

/// The exact motion from the study's initial positions to `end`.
pub(crate) fn from_start(
    model: &MaxwellSlip,
    study: &Study,
    end: f64,
) -> Result<Trajectory, String> {
    Trajectory::new(model, &study.input, &study.initial, (0.0, end)).map_err(|e| e.to_string())
}

/// The loop of the last period of the span.
pub(crate) fn settled(model: &MaxwellSlip, study: &Study) -> Result<Loop, String> {
    let run = from_start(model, study, study.span)?;
    Ok(Loop::of(&run, &study.input, (study.period, study.span)))
}

/// The force after the study's span and then the way through `turns`, by Masing's rule.
fn after(model: &MaxwellSlip, study: &Study, turns: &[f64]) -> Result<f64, String> {
    let rest = study.initial.iter().all(|x| *x == study.input.u(0.0));
    if !rest {
        return Err("Masing's rule starts from relaxed springs".to_owned());
    }
    let path = [from_start(model, study, study.span)?.turns(), turns.to_vec()].concat();
    Ok(masing::force(model, &path))
}
