//! What the paper says of the Maxwell-slip model.

use super::{Check, Checked, fails};
use crate::{
    plan::{Plan, Subject},
    quantities::maxwell_slip::{from_start, model, settled},
    solved::solved,
};
use duhem::{
    Dahl, FrictionModel, Input, MaxwellSlip,
    closed_form::{
        dahl,
        maxwell_slip::{Loop, Trajectory, saturation_force, stop},
    },
};
use integrate::{Corners, Outcome};

macro_rules! check {
    ($name:literal, $run:ident) => {
        Check {
            name: $name,
            model: "maxwell-slip",
            expects: &[],
            takes: &[],
            many: false,
            code: concat!("crates/experiment/src/checks/maxwell_slip.rs, ", stringify!($run)),
            run: $run,
        }
    };
}

/// Each element alone is Dahl with γ = 0.
pub(super) const IS_DAHL: Check = check!("element-is-dahl", element_is_dahl);
/// Below the deadband an element's force is k_i u.
pub(super) const PRESLIDING: Check = check!("presliding-force", presliding_force);
/// The settled loop depends on the initial positions.
pub(super) const NONLOCAL: Check = check!("nonlocal-memory", nonlocal_memory);
/// The loop's area is Σ k_iΔ_i², at every amplitude above all deadbands.
pub(super) const ENERGY: Check = check!("energy-formula", energy_formula);
/// The springs return none of the energy they store.
pub(super) const RETURNED: Check = check!("springs-return-nothing", springs_return);
/// F changes sign after u̇ does.
pub(super) const LAG: Check = check!("friction-lag", friction_lag);
/// Equation 24 as printed slips at a deflection of exactly Δ_i in both directions.
pub(super) const MIRROR: Check = check!("slips-at-the-deadband", slips_at_the_deadband);
/// A deflection beyond the deadband never comes back.
pub(super) const OVERSHOOT: Check = check!("overshoot-stays", overshoot_stays);
/// A closed minor loop leads back to where it began.
pub(super) const RETURN_POINT: Check = check!("return-point", return_point);
/// A larger excursion wipes out what smaller ones left.
pub(super) const WIPING_OUT: Check = check!("wiping-out", wiping_out);

/// Times of a span at which forces are compared.
const POINTS: u32 = 1000;
/// Forces closer than this, relative to saturation, are the same.
const SAME: f64 = 1e-12;

fn element_is_dahl(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let span = (0.0, study.span);
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (k, delta) in whole.k.iter().zip(&whole.delta) {
        let element = MaxwellSlip { k: vec![*k], delta: vec![*delta] };
        let twin = Dahl { f_c: k * delta, sigma: *k, gamma: 0.0 };
        let ours =
            Trajectory::new(&element, &study.input, &[study.input.u(0.0)], span).map_err(fails)?;
        let theirs = dahl::Trajectory::new(&twin, &study.input, 0.0, span).map_err(fails)?;
        for i in 0..=POINTS {
            let t = study.span * f64::from(i) / f64::from(POINTS);
            worst = worst.max((ours.force(t) - theirs.force(t)).abs() / (k * delta));
        }
        largest = largest.max(rates_differ(&element, &twin));
    }
    Ok(Checked {
        holds: worst < SAME && largest < SAME,
        value: Some(worst.max(largest)),
        error: Some(f64::EPSILON),
        unit: "1",
        how: format!(
            "largest relative distance between each element and Dahl with γ = 0, σ = k_i, F_C = k_iΔ_i: of their exact \
             forces under the study's input, and of Ḟ on −F_C ≤ F ≤ F_C; holds below {SAME:e}"
        ),
    })
}

/// The largest distance of Ḟ, relative to σ|u̇|, at forces up to ±F_C and both directions.
fn rates_differ(element: &MaxwellSlip, twin: &Dahl) -> f64 {
    let (mut worst, k) = (0.0_f64, element.k[0]);
    for share in [-1.0, -0.5, 0.0, 0.7, 1.0] {
        for u_dot in [-2.0, 0.3] {
            let (mut x_dot, mut f_dot) = ([0.0], [0.0]);
            element.x_dot(&[-share * element.delta[0]], 0.0, u_dot, &mut x_dot);
            twin.x_dot(&[share * twin.f_c], 0.0, u_dot, &mut f_dot);
            worst = worst.max((k * (u_dot - x_dot[0]) - f_dot[0]).abs() / (k * f64::abs(u_dot)));
        }
    }
    worst
}

fn presliding_force(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let run = from_start(&whole, study, study.span)?;
    let mut worst = (0.0_f64, 0.0);
    for i in 0..=POINTS {
        let t = study.span * f64::from(i) / f64::from(POINTS);
        let u = study.input.u(t);
        for ((k, delta), z) in whole.k.iter().zip(&whole.delta).zip(run.deflections(t)) {
            let off = k * (z - u);
            if z.abs() < delta * (1.0 - 1e-9) && off.abs() > worst.0 {
                worst = (off.abs(), k * z);
            }
        }
    }
    Ok(Checked {
        holds: worst.0 < SAME * saturation_force(&whole),
        value: Some(worst.0),
        error: Some(16.0 * f64::EPSILON * worst.0),
        unit: "N",
        how: format!(
            "largest distance of an element's force from k_i u while its deflection is below Δ_i, at {POINTS} times of \
             the study; there the force is k_i(u − x_i) = {:.4} N",
            worst.1
        ),
    })
}

fn nonlocal_memory(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let ours = settled(&whole, study)?;
    // The same input, begun with every spring stretched to its limit, to the right and to the left.
    let from = |share: f64| {
        let x: Vec<f64> = whole.delta.iter().map(|delta| ours.u_min - share * delta).collect();
        Loop::new(&whole, (ours.u_min, ours.u_max), ours.u_min, &x)
    };
    let at = |l: &Loop| l.force_at_u_max();
    let (high, low) = (at(&from(1.0)), at(&from(-1.0)));
    // Second: only elements with 2Δ_i above the width remember, and they keep all of 2k_i(Δ_i − β/2).
    let beta = ours.u_max - ours.u_min;
    let kept: f64 =
        whole.k.iter().zip(&whole.delta).map(|(k, d)| k * (2.0 * d - beta).max(0.0)).sum();
    Ok(Checked {
        holds: high - low > SAME * saturation_force(&whole),
        value: Some(high - low),
        error: Some((high - low - kept).abs().max(f64::EPSILON * high.abs())),
        unit: "N",
        how: format!(
            "distance between the settled loops of the same input from springs all stretched to the right and all to \
             the left, at the right turning point, against Σ k_i max(0, 2Δ_i − β); the study's own loop has {:.4} N there",
            at(&ours)
        ),
    })
}

fn energy_formula(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let (u_min, u_max) = study.input.range();
    let largest = whole.delta.iter().copied().fold(0.0, f64::max);
    if u_max <= largest || u_min != -u_max {
        return Err("the formula is stated for symmetric inputs above all deadbands".to_owned());
    }
    let area = |a: f64| Loop::new(&whole, (-a, a), 0.0, &vec![0.0; whole.k.len()]).area();
    let printed = duhem::closed_form::maxwell_slip::dissipation_as_printed(&whole);
    let (ratio, twice) = (area(u_max) / printed, area(2.0 * u_max) / printed);
    let again = duhem::closed_form::masing::area(&whole, 2.0 * u_max) / printed;
    Ok(Checked {
        holds: (ratio - 1.0).abs() < 1e-9 && (twice - 1.0).abs() < 1e-9,
        value: Some(ratio),
        error: Some((ratio - again).abs().max(f64::EPSILON)),
        unit: "1",
        how: format!(
            "area of the settled loop over Σ k_iΔ_i², at the study's amplitude; at twice the amplitude it is {twice:.3}; \
             holds if both are 1"
        ),
    })
}

fn springs_return(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let ours = settled(&whole, study)?;
    let returned = ours.returned();
    // A second way: the negative part of the power of each element over both branches, by its polygon.
    let beta = ours.u_max - ours.u_min;
    let n = 200_000;
    let element = |((k, delta), z0): ((&f64, &f64), &f64)| {
        let (mut z, mut sum) = (*z0, 0.0);
        for i in 0..2 * n {
            let step = if i < n { beta } else { -beta } / f64::from(n);
            let next = stop(z, step, *delta);
            let power = 0.5 * (z + next) * step;
            sum -= k * power.min(0.0);
            z = next;
        }
        sum
    };
    let again: f64 = whole.k.iter().zip(&whole.delta).zip(&ours.z_at_u_min).map(element).sum();
    Ok(Checked {
        holds: returned < SAME * ours.area(),
        value: Some(returned),
        error: Some((returned - again).abs()),
        unit: "J",
        how: format!(
            "energy that the springs return in one cycle of the settled loop, Σ ½k_iΔ_i² at either end, against the \
             negative work of each element in {n} steps a branch; holds if it is none"
        ),
    })
}

fn friction_lag(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let ours = settled(&whole, study)?;
    let lag = ours.lag().ok_or("the force does not change sign")?;
    let again = duhem::closed_form::masing::lag(&whole, ours.u_max - ours.u_min);
    Ok(Checked {
        holds: ours.force_at_u_max() > 0.0 && ours.force(ours.u_min, true) < 0.0,
        value: Some(lag),
        error: Some((lag - again).abs().max(f64::EPSILON * lag)),
        unit: "m",
        how: "travel from the reversal to F = 0 on the settled loop, against Masing's rule; holds if at both \
              reversals F still has the sign of the motion that ends"
            .to_owned(),
    })
}

fn slips_at_the_deadband(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, _) = model(plan, subject)?;
    let n = whole.k.len();
    // Positions with every deflection u − x at ±Δ exactly, u = 0; the share of u̇ that x moves with.
    let share = |side: f64, printed: bool| {
        let x: Vec<f64> = whole.delta.iter().map(|delta| -side * delta).collect();
        let mut x_dot = vec![0.0; n];
        if printed {
            whole.x_dot_as_printed(&x, 0.0, side, &mut x_dot);
        } else {
            whole.x_dot(&x, 0.0, side, &mut x_dot);
        }
        x_dot.iter().map(|v| v * side).sum::<f64>().abs() / n as f64
    };
    let (up, down) = (share(1.0, true), share(-1.0, true));
    Ok(Checked {
        holds: up == 1.0 && down == 1.0,
        value: Some(down),
        error: Some(f64::EPSILON),
        unit: "1",
        how: format!(
            "ẋ_i/u̇ by (24) as printed at a deflection of exactly −Δ_i, u decreasing; at +Δ_i, u increasing, it is {up}; \
             as read, with U(x_i − u − Δ_i), it is {} and {}; holds if the print gives 1 both ways",
            share(1.0, false),
            share(-1.0, false)
        ),
    })
}

/// Steps per period of the coarse run that overshoots.
const COARSE: f64 = 33.0;

fn overshoot_stays(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    // To the letter and as read: 1 % beyond the deadband, the position moves with u and stays behind.
    let beyond = |printed: bool| {
        let x: Vec<f64> = whole.delta.iter().map(|delta| -1.01 * delta).collect();
        let mut x_dot = vec![0.0; x.len()];
        if printed {
            whole.x_dot_as_printed(&x, 0.0, 1.0, &mut x_dot);
        } else {
            whole.x_dot(&x, 0.0, 1.0, &mut x_dot);
        }
        x_dot.iter().all(|v| *v == 1.0)
    };
    let euler = integrate::solver("explicit-euler").ok_or("no explicit-euler")?;
    let point = &study.points[*subject.points.first().ok_or("no point")?];
    let over = |steps: f64| {
        let run = solved(study, point, (euler, steps), Corners::Ignore)?;
        let force = run.path.iter().map(|(_, _, f)| f.abs()).fold(0.0, f64::max);
        Ok::<_, String>((
            force / saturation_force(&whole) - 1.0,
            run.run.outcome == Outcome::Solved,
        ))
    };
    let (coarse, fine) = (over(COARSE)?, over(2.0 * COARSE)?);
    let largest = from_start(&whole, study, study.span)?.largest_force();
    Ok(Checked {
        holds: beyond(true) && beyond(false) && coarse.0 > 1e-3 && coarse.1,
        value: Some(coarse.0),
        error: Some(f64::EPSILON),
        unit: "1",
        how: format!(
            "how far the largest force of explicit Euler with {COARSE} steps a period is above Σ k_iΔ_i, relative to it; \
             the run ends as solved; with twice the steps it is {:.4}, exactly the force is {:.4} of Σ k_iΔ_i; a \
             deflection 1 % beyond Δ_i has ẋ_i = u̇ by (24), printed or read, and stays",
            fine.0,
            largest / saturation_force(&whole)
        ),
    })
}

/// The deflections after a way through `turns` from deflections `z` at `u`.
fn through(whole: &MaxwellSlip, z: &[f64], u: f64, turns: &[f64]) -> Result<Vec<f64>, String> {
    let times: Vec<f64> = (0..=turns.len()).map(|i| i as f64).collect();
    let path: Vec<f64> = std::iter::once(u).chain(turns.iter().copied()).collect();
    let input = Input::sampled(times, path).map_err(fails)?;
    let x: Vec<f64> = z.iter().map(|z| u - z).collect();
    let end = turns.len() as f64;
    let run = Trajectory::new(whole, &input, &x, (0.0, end)).map_err(fails)?;
    Ok(run.deflections(end))
}

/// The largest distance of force between two states.
fn apart(whole: &MaxwellSlip, a: &[f64], b: &[f64]) -> f64 {
    whole.k.iter().zip(a.iter().zip(b)).map(|(k, (a, b))| k * (a - b).abs()).sum()
}

fn return_point(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let (u_min, u_max) = study.input.range();
    let rest = vec![0.0; whole.k.len()];
    let (mut worst, mut away) = (0.0_f64, 0.0_f64);
    for i in 1..20 {
        for j in 1..20 {
            let (a, b) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
            // Up to the right turn, back by a share a, there again by a share b of that, and back.
            let down = u_max - a * (u_max - u_min);
            let up = down + b * (u_max - down);
            let once = through(&whole, &rest, 0.0, &[u_max, down])?;
            let again = through(&whole, &once, down, &[up, down])?;
            worst = worst.max(apart(&whole, &once, &again));
            away = away.max(apart(&whole, &once, &through(&whole, &once, down, &[up])?));
        }
    }
    Ok(Checked {
        holds: worst < SAME * saturation_force(&whole),
        value: Some(worst),
        error: Some(f64::EPSILON * saturation_force(&whole)),
        unit: "N",
        how: format!(
            "largest force by which the elements miss the state they left, after 361 closed minor loops inside the \
             major one; on the way they were up to {away:.3} N from it"
        ),
    })
}

fn wiping_out(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (whole, study) = model(plan, subject)?;
    let (u_min, u_max) = study.input.range();
    let rest = vec![0.0; whole.k.len()];
    let (mut worst, mut left) = (0.0_f64, 0.0_f64);
    for i in 1..20 {
        for j in 1..20 {
            let (a, b) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
            let down = u_max - a * (u_max - u_min);
            let up = down + b * (u_max - down);
            let straight = through(&whole, &rest, 0.0, &[u_max, u_min])?;
            let by_way = through(&whole, &rest, 0.0, &[u_max, down, up, u_min])?;
            worst = worst.max(apart(&whole, &straight, &by_way));
            // Not yet wiped out: half of the minor loop back.
            let middle = 0.5 * (down + up);
            let straight = through(&whole, &rest, 0.0, &[u_max, middle])?;
            let by_way = through(&whole, &rest, 0.0, &[u_max, down, up, middle])?;
            left = left.max(apart(&whole, &straight, &by_way));
        }
    }
    Ok(Checked {
        holds: worst < SAME * saturation_force(&whole) && left > 1e-3 * saturation_force(&whole),
        value: Some(worst),
        error: Some(f64::EPSILON * saturation_force(&whole)),
        unit: "N",
        how: format!(
            "largest force that 361 minor loops leave behind once u has passed their turning points; before that they \
             leave up to {left:.3} N"
        ),
    })
}
