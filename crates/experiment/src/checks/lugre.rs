//! What the paper says of the LuGre model.

use super::{Check, Checked, fails};
use crate::{
    plan::{Plan, Subject},
    quantities::lugre::model,
};
use duhem::{
    Dahl, FrictionModel, Input, LuGre,
    closed_form::lugre::{self, Trajectory, settled},
};

macro_rules! check {
    ($name:literal, $run:ident) => {
        Check {
            name: $name,
            model: "lugre",
            expects: &[],
            takes: &[],
            many: false,
            code: concat!("crates/experiment/src/checks/lugre.rs, ", stringify!($run)),
            run: $run,
        }
    };
}

/// Without Stribeck effect and damping LuGre is Dahl with γ = 1 and σ = 1.
pub(super) const IS_DAHL: Check = check!("lugre-is-dahl", is_dahl);
/// The settled loop changes with the frequency.
pub(super) const LOOP_CHANGES: Check = check!("loop-changes-with-frequency", loop_changes);
/// The settled loop at this frequency is that of infinitely slow motion.
pub(super) const SLOW_ENOUGH: Check = check!("slow-enough", slow_enough);
/// The steady force falls from F_S towards F_C within a few v_S.
pub(super) const STRIBECK: Check = check!("stribeck-drop", stribeck);
/// The settled loop does not depend on x(0).
pub(super) const LOCAL_MEMORY: Check = check!("local-memory", local_memory);
/// In sliding F peaks at F_S, drops with the speed by a good part of F_S − F_C, and lags.
pub(super) const SLIDING: Check = check!("stribeck-in-sliding", sliding);
/// Under the condition on the speed the power lost is never negative, beyond it it can be.
pub(super) const DISSIPATES: Check = check!("dissipates-below-its-speed", dissipates);

fn is_dahl(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, _) = model(plan, subject)?;
    let bare = LuGre { f_s: model.f_c, sigma_1: 0.0, sigma_2: 0.0, ..model };
    // Ḟ over Ḟ of Dahl with stiffness σ, at the same force.
    let ratio = |share: f64, u_dot: f64, sigma: f64| {
        let dahl = Dahl { f_c: bare.f_c, sigma, gamma: 1.0 };
        let (force, mut x_dot, mut f_dot) = (share * bare.f_c, [0.0], [0.0]);
        bare.x_dot(&[force / bare.sigma_0], 0.0, u_dot, &mut x_dot);
        dahl.x_dot(&[force], 0.0, u_dot, &mut f_dot);
        bare.sigma_0 * x_dot[0] / f_dot[0]
    };
    let places = [(-0.9, 0.1), (-0.4, 1e-4), (0.0, -2.0), (0.5, -0.01), (0.8, 3.0)];
    let off = |sigma: f64, goal: f64| {
        let each =
            places.iter().map(|(share, u_dot)| (ratio(*share, *u_dot, sigma) / goal - 1.0).abs());
        each.fold(0.0, f64::max)
    };
    let one = ratio(0.0, 1.0, 1.0);
    let mended = off(bare.sigma_0, 1.0);
    Ok(Checked {
        holds: off(1.0, 1.0) < 1e-12,
        value: Some(one),
        error: Some(one * off(1.0, one).max(f64::EPSILON)),
        unit: "1",
        how: format!(
            "Ḟ of LuGre with F_S = F_C and σ₁ = σ₂ = 0 over Ḟ of Dahl with γ = 1 and σ = 1 N/m, at five forces and \
             speeds; holds if it is 1; with σ = σ₀ it is 1 {}",
            if mended < 1e-12 { "to 1e-12" } else { "nowhere" }
        ),
    })
}

/// A sine of the study's range at `share` of its frequency.
fn slower(range: (f64, f64), omega: f64, share: f64) -> Result<Input, String> {
    Input::sine(0.5 * (range.1 - range.0), omega * share).map_err(fails)
}

fn loop_changes(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, study) = model(plan, subject)?;
    let omega = std::f64::consts::TAU / study.period;
    let mut areas = Vec::new();
    for share in [1.0, 0.5, 0.1, 0.01] {
        let input = slower(study.input.range(), omega, share)?;
        areas.push(settled(&model, &input).map_err(fails)?.work());
    }
    let slowest = areas[3];
    let change = areas[0] / slowest - 1.0;
    // A half-period map of another kind: twice as far from the start, the loop is the same.
    let input = slower(study.input.range(), omega, 1.0)?;
    let late = Trajectory::new(&model, &input, 0.0, (0.0, 2.0 * study.period)).map_err(fails)?;
    let first = Trajectory::new(&model, &input, 0.0, (0.0, study.period)).map_err(fails)?;
    let second = (late.work() - first.work()) / slowest - 1.0;
    Ok(Checked {
        holds: areas.windows(2).all(|pair| (pair[0] / pair[1] - 1.0).abs() > 1e-6),
        value: Some(change),
        error: Some((change - second).abs().max(1e-13)),
        unit: "1",
        how: format!(
            "relative change of the settled loop's area from ω = {:.3} to {omega:.3} rad/s, also as the work of the \
             second period from rest; holds if the areas at ω, ω/2, ω/10 and ω/100 all differ by more than 1e-6",
            omega / 100.0
        ),
    })
}

fn slow_enough(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, study) = model(plan, subject)?;
    let twin = Dahl { f_c: model.f_s, sigma: model.sigma_0, gamma: 1.0 };
    let limit = duhem::closed_form::dahl::Loop::new(&twin, study.input.range()).area();
    let here = settled(&model, &study.input).map_err(fails)?.work() / limit - 1.0;
    let again = lugre::second_way::Path::settled(&model, &study.input, study.period);
    Ok(Checked {
        holds: here.abs() < 0.005,
        value: Some(here),
        error: Some((here - (again.work / limit - 1.0)).abs().max(1e-13)),
        unit: "1",
        how: "relative distance of the loop's area from its limit for ω → 0; holds below 0.5 %"
            .to_owned(),
    })
}

fn stribeck(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, _) = model(plan, subject)?;
    let extrema = lugre::steady_extrema(&model).ok_or("the steady force is monotone")?;
    let (top, few) = (model.steady_force(extrema.maximum), 3.0 * model.v_s);
    let left = (model.steady_force(few) - model.f_c) / (top - model.f_c);
    let again = lugre::second_way::steady_force(&model, few);
    let second = (again - model.f_c) / (top - model.f_c);
    Ok(Checked {
        holds: (top / model.f_s - 1.0).abs() < 1e-3 && left < 0.01,
        value: Some(left),
        error: Some((left - second).abs().max(1e-14)),
        unit: "1",
        how: format!(
            "share of F_S − F_C that F_ss has left above F_C at 3 v_S; holds if its maximum, {top:.4} N, is F_S \
             within 0.1 % and the share is below 1 %"
        ),
    })
}

fn local_memory(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, study) = (model(plan, subject)?.0, &plan.studies[subject.study]);
    let most = model.scale()[0];
    let run = |x0: f64, periods: f64| {
        Trajectory::new(&model, &study.input, x0, (0.0, periods * study.period)).map_err(fails)
    };
    let after = |x0: f64| run(x0, 1.0).map(|path| path.deflection(study.period));
    let left = (after(most)? - after(-most)?) / (2.0 * most);
    // The same share without the model's answer: e^(−∫|u̇|/r(u̇) dt).
    let n = 200_000;
    let h = study.period / f64::from(n);
    let rate = |i: i32| {
        let u_dot = study.input.u_dot(h * (f64::from(i) + 0.5));
        u_dot.abs() / model.r(u_dot)
    };
    let share = (-h * (0..n).map(rate).sum::<f64>()).exp();
    let settled = settled(&model, &study.input).map_err(fails)?;
    let mut worst = 0.0_f64;
    for start in [-1.0, -0.3, 0.0, 0.7, 1.0] {
        let path = run(start * most, 6.0)?;
        for i in 0..100 {
            let t = study.period * f64::from(i) / 100.0;
            worst = worst.max((path.force(5.0 * study.period + t) - settled.force(t)).abs());
        }
    }
    Ok(Checked {
        holds: worst < 1e-9 * model.f_c && left < 1.0,
        value: Some(left),
        error: Some((left - share).abs().max(f64::EPSILON)),
        unit: "1",
        how: "share of a difference in x(0) that is left after one period, against e^(−∫|u̇|/r dt); in the sixth \
              period from five initial deflections F is that of the settled loop to 1e-9 of F_C"
            .to_owned(),
    })
}

fn sliding(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, study) = model(plan, subject)?;
    let path = Trajectory::new(&model, &study.input, study.initial[0], (0.0, study.period))
        .map_err(fails)?;
    let top = path.largest_force();
    // The way up is the second half of the period; its middle is the fastest.
    let fastest = path.force(0.75 * study.period);
    let drop = (top - fastest) / (model.f_s - model.f_c);
    let steady = lugre::second_way::steady_force(&model, study.input.u_dot(0.75 * study.period));
    let second = (top - steady) / (model.f_s - model.f_c);
    let lags = path.force(0.5 * study.period) < 0.0;
    Ok(Checked {
        holds: (top / model.f_s - 1.0).abs() < 0.01 && drop > 0.1 && lags,
        value: Some(drop),
        error: Some((drop - second).abs()),
        unit: "1",
        how: format!(
            "share of F_S − F_C by which F falls from its peak, {top:.4} N, to its value at the largest speed, against \
             the steady force there; holds if the peak is F_S within 1 %, the fall at least a tenth, and F at the \
             reversal still has the sign of the motion before"
        ),
    })
}

/// Random closed polylines in each of the two halves of the check.
const LOOPS: u32 = 100;
/// The smallest of uniform numbers used as a time or way.
const LEAST: f64 = 0.01;

fn dissipates(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (model, study) = model(plan, subject)?;
    let speed = lugre::returning_speed(&model).ok_or("the model gives energy back at no speed")?;
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut least, mut worst) = (f64::INFINITY, 0.0_f64);
    for _ in 0..LOOPS {
        let input = closed_loop(&mut random, speed * (1.0 - 1e-9), model.scale()[0])?;
        let path = settled(&model, &input).map_err(fails)?;
        let period = input.period().ok_or("no period")?;
        least = least.min(path.work());
        let again = lugre::second_way::Path::settled(&model, &input, period);
        worst = worst.max((path.work() - again.work).abs());
    }
    let returned = settled(&model, &study.input).map_err(fails)?.work();
    Ok(Checked {
        holds: least > 0.0 && returned < 0.0,
        value: Some(least),
        error: Some(worst),
        unit: "J",
        how: format!(
            "smallest energy lost in one settled period of {LOOPS} random closed polylines, none faster than \
             {speed:.6} m/s; holds if it is positive while the study's own input, which is faster, loses {returned:.3e} J"
        ),
    })
}

/// A closed polyline of 3 to 8 pieces, some creeping, some at nearly `fastest` [m/s], of a size of a few `r` [m].
fn closed_loop(random: &mut Random, fastest: f64, r: f64) -> Result<Input, String> {
    let pieces = 3 + (0..5).filter(|_| random.next() < 0.5).count();
    let mut u: Vec<f64> = (0..pieces).map(|_| 20.0 * r * (random.next() - 0.5)).collect();
    u.push(u[0]);
    let mut t = vec![0.0];
    for pair in u.windows(2) {
        let way = (pair[1] - pair[0]).abs().max(LEAST * r);
        // Half of the pieces at the limit, half over four decades below it.
        let slower = if random.next() < 0.5 { 1.0 } else { 10f64.powf(-4.0 * random.next()) };
        t.push(t.last().unwrap_or(&0.0) + way / (fastest * slower));
    }
    Input::polyline(t, u).map_err(fails)
}

/// Uniform numbers in [0, 1) that are the same everywhere: a multiplicative generator (xorshift*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / 9_007_199_254_740_992.0
    }
}
