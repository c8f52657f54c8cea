//! What the paper says of the Dahl model.

use super::{Check, Checked};
use crate::plan::{Plan, Study, Subject};
use duhem::{
    Dahl, FrictionModel,
    closed_form::{
        dahl::{
            Loop, Trajectory, advance, contraction, falling, falling_as_printed, rising, travel,
        },
        second_way,
        semilinear::{self, Semilinear},
    },
};

/// A check and the place of its code.
macro_rules! check {
    ($name:literal, $run:ident, many: $many:literal) => {
        Check {
            name: $name,
            model: "dahl",
            expects: &[],
            takes: &[],
            many: $many,
            code: concat!("crates/experiment/src/checks/dahl.rs, ", stringify!($run)),
            run: $run,
        }
    };
}

/// Corollary 1: equation 17 is the limiting loop, and Theorem 1's equation 10 the same.
pub(super) const COROLLARY_1: Check = check!("corollary-1", corollary_1, many: false);
/// The limiting loop does not depend on F(0).
pub(super) const LOCAL_MEMORY: Check = check!("local-memory", local_memory, many: false);
/// F changes sign after u̇ does.
pub(super) const FRICTION_LAG: Check = check!("friction-lag", friction_lag, many: true);
/// Equation 14 equals equation 11.
pub(super) const EQUATION_14: Check = check!("equation-14", equation_14, many: false);
/// F reaches F_C in finite travel if and only if γ < 1.
pub(super) const FINITE_SATURATION: Check =
    check!("finite-saturation", finite_saturation, many: true);

/// Points at which loops are compared.
const POINTS: u32 = 400;
/// Loops closer than this, relative to F_C, are the same.
const SAME: f64 = 1e-12;
/// Periods after which a trajectory has forgotten its start.
const PERIODS: f64 = 12.0;

fn dahls(plan: &Plan, subject: &Subject) -> Result<Vec<Dahl>, String> {
    let study = &plan.studies[subject.study];
    let dahl = |i: &usize| Dahl::new(&study.points[*i].parameters).map_err(|e| e.to_string());
    subject.points.iter().map(dahl).collect()
}

fn one(plan: &Plan, subject: &Subject) -> Result<Dahl, String> {
    dahls(plan, subject)?.into_iter().next().ok_or_else(|| "no point of the sweep".to_owned())
}

/// A distance in words, where the digits of one at round-off would be those of the processor.
fn within(distance: f64) -> String {
    const ROUND_OFF: f64 = 1e-13;
    if distance < ROUND_OFF {
        format!("to {ROUND_OFF:e} N")
    } else {
        format!("to {distance:.0e} N only")
    }
}

/// The displacements of a loop's range.
fn along((u_min, u_max): (f64, f64)) -> impl Iterator<Item = f64> {
    (0..=POINTS).map(move |i| u_min + (u_max - u_min) * f64::from(i) / f64::from(POINTS))
}

/// The forces over one late period from F(0) = `f0`, up and down the loop's range.
fn late(dahl: &Dahl, study: &Study, f0: f64) -> Result<Vec<f64>, String> {
    let end = PERIODS * study.period;
    let path = Trajectory::new(dahl, &study.input, f0, (0.0, end)).map_err(|e| e.to_string())?;
    let t = |i| end - study.period * f64::from(i) / f64::from(POINTS);
    Ok((0..=POINTS).map(|i| path.force(t(i))).collect())
}

/// The largest distance between the late periods from the ends and the middle of −F_C..F_C.
fn spread(dahl: &Dahl, study: &Study) -> Result<f64, String> {
    let middle = late(dahl, study, 0.0)?;
    let mut worst = 0.0_f64;
    for share in [-1.0, -0.5, 0.5, 1.0] {
        let other = late(dahl, study, share * dahl.f_c)?;
        worst = middle.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
    }
    Ok(worst)
}

fn corollary_1(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (dahl, study) = (one(plan, subject)?, &plan.studies[subject.study]);
    let range = study.input.range();
    let settled = Loop::new(&dahl, range);
    let theorem = Semilinear::of_dahl(&dahl).and_then(|model| semilinear::Loop::new(&model, range));
    let theorem = theorem.map_err(|e| e.to_string())?;
    let worst = |off: &dyn Fn(f64) -> f64| along(range).map(|u| off(u).abs()).fold(0.0, f64::max);
    let up = worst(&|u| rising(&dahl, range, u) - settled.force(u, true));
    let printed = worst(&|u| falling_as_printed(&dahl, range, u) - settled.force(u, false));
    let mended = worst(&|u| falling(&dahl, range, u) - settled.force(u, false));
    let ten = worst(&|u| theorem.y(u, true) - settled.force(u, true))
        .max(worst(&|u| theorem.y(u, false) - settled.force(u, false)));
    let starts = spread(&dahl, study)?;
    let error = up.max(mended).max(ten).max(starts);
    Ok(Checked {
        holds: up.max(printed).max(ten).max(starts) < SAME * dahl.f_c,
        value: Some(printed),
        error: Some(error.max(16.0 * f64::EPSILON * printed)),
        unit: "N",
        how: format!(
            "largest distance of the printed F₋ from the limiting loop; F₊, F₋ with its sign mended, (10) and the \
             trajectories from five initial forces all agree with the loop {}",
            within(error)
        ),
    })
}

fn local_memory(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (dahl, study) = (one(plan, subject)?, &plan.studies[subject.study]);
    let (u_min, u_max) = study.input.range();
    let round = |f: f64| advance(&dahl, advance(&dahl, f, u_max - u_min), u_min - u_max);
    let forgets = (round(dahl.f_c) - round(-dahl.f_c)) / (2.0 * dahl.f_c);
    let left = spread(&dahl, study)?;
    let theory = contraction(&dahl, u_max - u_min);
    Ok(Checked {
        holds: left < SAME * dahl.f_c && forgets < 1.0,
        value: Some(forgets),
        error: Some((forgets - theory).abs().max(f64::EPSILON)),
        unit: "1",
        how: format!(
            "share of a difference in F(0) that is left after one period, against (16); after {PERIODS} periods \
             from five initial forces the loops agree {}",
            within(left)
        ),
    })
}

fn friction_lag(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let range = plan.studies[subject.study].input.range();
    let (mut lags, mut shortest, mut error) = (true, f64::INFINITY, 0.0_f64);
    for dahl in dahls(plan, subject)? {
        let (settled, second) = (Loop::new(&dahl, range), second_way::Loop::new(&dahl, range));
        // A force that still has the sign of the motion when the motion turns is behind it.
        lags &= settled.force(range.1, true) > 0.0 && settled.force(range.0, false) < 0.0;
        shortest = shortest.min(settled.lag());
        error = error.max((settled.lag() - second.lag()).abs());
    }
    Ok(Checked {
        holds: lags,
        value: Some(shortest),
        error: Some(error.max(4.0 * f64::EPSILON * shortest)),
        unit: "m",
        how: "travel from the reversal to F = 0 on the settled loop; holds if at both reversals F still has the \
              sign of the motion that ends"
            .to_owned(),
    })
}

fn equation_14(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let dahl = one(plan, subject)?;
    let ratio = |force: f64| {
        let mut f_dot = [0.0];
        dahl.x_dot(&[force], 0.0, 1.0, &mut f_dot);
        dahl.x_dot_as_printed(force, 1.0) / f_dot[0]
    };
    let ratios: Vec<f64> =
        [-0.9, -0.3, 0.0, 0.4, 0.8].map(|share| ratio(share * dahl.f_c)).to_vec();
    let first = ratios[0];
    let error = ratios.iter().map(|r| (r - first).abs()).fold(f64::EPSILON, f64::max);
    Ok(Checked {
        holds: (first - 1.0).abs() < SAME,
        value: Some(first),
        error: Some(error),
        unit: "1",
        how: "ratio of the right side of (14) as printed to that of (11), at five forces; holds if it is 1".to_owned(),
    })
}

/// For γ ≥ 1 the travel to F_C(1 − ε) has to grow without bound: it is taken over these ε.
const SHORT_OF: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

fn finite_saturation(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (mut longest, mut holds, mut grown) = (0.0_f64, true, f64::INFINITY);
    let mut error = 0.0_f64;
    for dahl in dahls(plan, subject)? {
        let whole = travel(&dahl, -dahl.f_c, dahl.f_c);
        if dahl.gamma < 1.0 {
            let whole = whole.ok_or("no travel for γ < 1")?;
            longest = longest.max(whole);
            let second = second_way::saturation_travel(&dahl).ok_or("no travel a second way")?;
            error = error.max((whole - second).abs());
            // Arrived within the travel, and not before it.
            holds &= advance(&dahl, -dahl.f_c, whole * (1.0 + 1e-12)) == dahl.f_c;
            holds &= advance(&dahl, -dahl.f_c, whole * 0.99) < dahl.f_c;
        } else {
            holds &= whole.is_none();
            let to = |short: f64| travel(&dahl, -dahl.f_c, dahl.f_c * (1.0 - short));
            let travels: Vec<f64> = SHORT_OF.iter().filter_map(|short| to(*short)).collect();
            let steps = travels.windows(2).map(|w| w[1] - w[0]);
            grown = grown.min(steps.fold(f64::INFINITY, f64::min));
            holds &= travels.len() == SHORT_OF.len();
        }
    }
    holds &= grown > 0.1;
    Ok(Checked {
        holds,
        value: Some(longest),
        error: Some(error.max(4.0 * f64::EPSILON * longest)),
        unit: "m",
        how: format!(
            "longest travel from −F_C to F_C among γ < 1; for γ ≥ 1 there is none: each factor 10⁻³ nearer to F_C \
             costs at least {grown:.2} m more"
        ),
    })
}
