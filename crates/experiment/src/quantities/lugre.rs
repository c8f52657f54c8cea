//! Quantities of the LuGre model: the closed forms, and the same by Runge-Kutta steps.

use super::{Measured, Quantity};
use crate::plan::{Plan, Study, Subject};
use duhem::{
    Dahl, Input, LuGre,
    closed_form::{
        dahl,
        lugre::{self, Trajectory, second_way},
    },
};

const SETTLED: &str = "variation of constants over the period that repeats itself";
const FROM_REST: &str = "variation of constants";
const RUNGE_KUTTA: &str = "fourth-order Runge-Kutta steps in time, 100 over a travel of r";
const STEADY: &str = "equation 21";
const AT_REST: &str = "equations 18 and 19 stepped at constant speed until the bristles rest";

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, ($method:expr, $second:expr), $file:literal, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "lugre",
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            takes: &[],
            code: concat!("crates/duhem/src/", $file),
            measure: $measure,
        };
    };
}

quantity!(
    FORCE_MAX,
    "force_max",
    "N",
    "largest force on the settled loop",
    (SETTLED, RUNGE_KUTTA),
    "closed_form/lugre/trajectory.rs, Trajectory::largest_force",
    |plan, subject| {
        let (ours, second) = settled(plan, subject)?;
        Ok(Measured::of(ours.largest_force(), second.largest_force()))
    }
);

quantity!(
    FORCE_MAX_FROM_START,
    "force_max_from_start",
    "N",
    "largest force over the span, from the initial state",
    (FROM_REST, RUNGE_KUTTA),
    "closed_form/lugre/trajectory.rs, Trajectory::largest_force",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let (ours, second) = both(&model, study, study.span)?;
        Ok(Measured::of(ours.largest_force(), second.largest_force()))
    }
);

quantity!(
    FORCE_AT_TURN,
    "force_at_turn",
    "N",
    "force at the right turning point of the settled loop",
    (SETTLED, RUNGE_KUTTA),
    "closed_form/lugre/trajectory.rs, Trajectory::force",
    |plan, subject| {
        let (_, study) = model(plan, subject)?;
        let (ours, second) = settled(plan, subject)?;
        let (_, u_max) = study.input.range();
        let at = |t: &f64| (study.input.u(*t) - u_max).abs();
        let turns = study.input.corners(0.0, study.period);
        let turn = turns.iter().min_by(|a, b| at(a).total_cmp(&at(b))).ok_or("no turn")?;
        Ok(Measured::of(ours.force(*turn), second.force_at_right_turn()))
    }
);

quantity!(
    LOOP_AREA,
    "loop_area",
    "J",
    "area of the settled loop, ∮F du",
    (SETTLED, RUNGE_KUTTA),
    "closed_form/lugre/trajectory.rs, Trajectory::work",
    |plan, subject| {
        let (ours, second) = settled(plan, subject)?;
        Ok(Measured::of(ours.work(), second.work))
    }
);

quantity!(
    FIRST_PERIOD_WORK,
    "first_period_work",
    "J",
    "work of friction over the first period, from the initial deflection",
    (FROM_REST, RUNGE_KUTTA),
    "closed_form/lugre/trajectory.rs, Trajectory::work",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let (ours, second) = both(&model, study, study.period)?;
        Ok(Measured::of(ours.work(), second.work))
    }
);

quantity!(
    SLOW_LIMIT_AREA,
    "slow_limit_area",
    "J",
    "limit of the settled loop's area for ω → 0",
    (
        "the settled loop of Dahl, γ = 1, with F_C = F_S and σ = σ₀, in closed form",
        "LuGre's areas under sines of ω = 4, 2 and 1 mrad/s, extrapolated to ω = 0"
    ),
    "closed_form/dahl/settled.rs, Loop::area",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let range = study.input.range();
        let twin = Dahl { f_c: model.f_s, sigma: model.sigma_0, gamma: 1.0 };
        Ok(Measured::of(dahl::Loop::new(&twin, range).area(), extrapolated(&model, range)?))
    }
);

quantity!(
    SPEED_AT_MAXIMUM,
    "speed_at_steady_maximum",
    "m/s",
    "speed from which the steady force decreases",
    ("bisection on 2s e^(−s²) = σ₂v_S/(F_S − F_C)", "the main branch of Lambert's W"),
    "closed_form/lugre/steady.rs, steady_extrema",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        let ours = lugre::steady_extrema(&model).ok_or("the steady force is monotone")?;
        Ok(Measured::of(ours.maximum, second_way::steady_extrema(&model).0))
    }
);

quantity!(
    SPEED_AT_MINIMUM,
    "speed_at_steady_minimum",
    "m/s",
    "speed of the smallest steady force at positive speed",
    ("bisection on 2s e^(−s²) = σ₂v_S/(F_S − F_C)", "the lower branch of Lambert's W"),
    "closed_form/lugre/steady.rs, steady_extrema",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        let ours = lugre::steady_extrema(&model).ok_or("the steady force is monotone")?;
        Ok(Measured::of(ours.minimum, second_way::steady_extrema(&model).1))
    }
);

quantity!(
    STEADY_MINIMUM,
    "steady_minimum",
    "N",
    "smallest steady force at positive speed, beyond its maximum",
    (STEADY, AT_REST),
    "models/lugre.rs, LuGre::steady_force",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        let ours = lugre::steady_extrema(&model).ok_or("the steady force is monotone")?;
        let again = second_way::steady_extrema(&model).1;
        let second = second_way::steady_force(&model, again);
        Ok(Measured::of(model.steady_force(ours.minimum), second))
    }
);

quantity!(
    STEADY_AT_STRIBECK,
    "steady_force_at_stribeck_velocity",
    "N",
    "steady force at v_S",
    (STEADY, AT_REST),
    "models/lugre.rs, LuGre::steady_force",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        let second = second_way::steady_force(&model, model.v_s);
        Ok(Measured::of(model.steady_force(model.v_s), second))
    }
);

quantity!(
    STEADY_AT_LARGEST_SPEED,
    "steady_force_at_largest_speed",
    "N",
    "steady force at the input's largest speed",
    (STEADY, AT_REST),
    "models/lugre.rs, LuGre::steady_force",
    |plan, subject| {
        let (model, study) = model(plan, subject)?;
        let (u_min, u_max) = study.input.range();
        let speed = 0.5 * (u_max - u_min) * std::f64::consts::TAU / study.period;
        let second = second_way::steady_force(&model, speed);
        Ok(Measured::of(model.steady_force(speed), second))
    }
);

quantity!(
    DISSIPATIVE_SPEED,
    "dissipative_speed",
    "m/s",
    "speed up to which no deflection whatever makes the power lost negative",
    (
        "|u̇|/r(u̇) = 4σ₀(σ₁ + σ₂)/σ₁², by bisection",
        "bisection on the smallest power lost over the deflections, by golden sections"
    ),
    "closed_form/lugre/passivity.rs, dissipative_speed",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        // Far beyond the deflection at which the quadratic form first loses its sign, 2r(1 + σ₂/σ₁).
        let most = 100.0 * model.f_s.max(model.f_c) / model.sigma_0;
        let second = second_way::returning_speed(&model, most, FASTEST).ok_or("no such speed")?;
        Ok(Measured::of(lugre::dissipative_speed(&model), second))
    }
);

quantity!(
    RETURNING_SPEED,
    "returning_speed",
    "m/s",
    "speed up to which no motion from rest, |x| ≤ F_S/σ₀, gives energy back",
    (
        "σ₀ r ξ² = (σ₁(ξ − 1) − σ₂)|u̇| at the largest ξ = x/r, by bisection",
        "bisection on the smallest power lost over the deflections, by golden sections"
    ),
    "closed_form/lugre/passivity.rs, returning_speed",
    |plan, subject| {
        let (model, _) = model(plan, subject)?;
        let none = "the model gives energy back at no speed";
        let ours = lugre::returning_speed(&model).ok_or(none)?;
        let most = model.f_s.max(model.f_c) / model.sigma_0;
        let second = second_way::returning_speed(&model, most, FASTEST).ok_or(none)?;
        Ok(Measured::of(ours, second))
    }
);

/// Speeds are sought below this [m/s].
const FASTEST: f64 = 10.0;

pub(crate) fn model<'a>(plan: &'a Plan, subject: &Subject) -> Result<(LuGre, &'a Study), String> {
    let study = &plan.studies[subject.study];
    let point = &study.points[*subject.points.first().ok_or("no point of the sweep")?];
    Ok((LuGre::new(&point.parameters).map_err(|e| e.to_string())?, study))
}

/// The settled period in both ways.
fn settled(plan: &Plan, subject: &Subject) -> Result<(Trajectory, second_way::Path), String> {
    let (model, study) = model(plan, subject)?;
    let ours = lugre::settled(&model, &study.input).map_err(|e| e.to_string())?;
    Ok((ours, second_way::Path::settled(&model, &study.input, study.period)))
}

/// The motion from the study's initial state to `end` in both ways.
fn both(model: &LuGre, study: &Study, end: f64) -> Result<(Trajectory, second_way::Path), String> {
    let (x0, span) = (study.initial[0], (0.0, end));
    let ours = Trajectory::new(model, &study.input, x0, span).map_err(|e| e.to_string())?;
    Ok((ours, second_way::Path::new(model, &study.input, x0, span)))
}

/// The area at ω = 0 from three slow sines: the parabola through areas at 4, 2 and 1 mrad/s.
fn extrapolated(model: &LuGre, (u_min, u_max): (f64, f64)) -> Result<f64, String> {
    let area = |omega: f64| {
        let input = Input::sine(0.5 * (u_max - u_min), omega).map_err(|e| e.to_string())?;
        lugre::settled(model, &input).map(|path| path.work()).map_err(|e| e.to_string())
    };
    Ok((area(4e-3)? - 6.0 * area(2e-3)? + 8.0 * area(1e-3)?) / 3.0)
}
