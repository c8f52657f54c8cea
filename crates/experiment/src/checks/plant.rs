//! What the paper says of a mass on a spring and of the rig.

use super::{Check, Checked};
use crate::{
    plan::{Plan, Study, Subject},
    quantities::{RINGING, View},
};
use duhem::{
    Dahl, Input, LuGre, Parameter, Rig,
    closed_form::dahl::settling::{Contact, HeldMass},
};
use integrate::Outcome;
use simulation::{DrivenPlant, plant_reference::solve_located};

macro_rules! check {
    ($(#[$doc:meta])* $const:ident, $name:literal, $model:literal, $takes:expr, $many:literal, $run:ident) => {
        $(#[$doc])*
        pub(super) const $const: Check = Check {
            name: $name,
            code: concat!("crates/experiment/src/checks/plant.rs, ", stringify!($run)),
            model: $model,
            expects: &[],
            takes: $takes,
            many: $many,
            run: $run,
        };
    };
}

check!(
    /// Where the mass settles at constant forces, from many states: at F = ±F_C, as the paper says?
    SETTLES_AT_F_C, "settles-at-f-c", "dahl", &[], false, settles_at_f_c
);
check!(
    /// Whether the mass comes to rest at constant forces, from many states, and where.
    COMES_TO_REST, "comes-to-rest", "lugre", &[], false, comes_to_rest
);
check!(
    /// Whether nearly all of the way is made in slips.
    STAIRCASE, "staircase", "lugre", &[], true, staircase
);
check!(
    /// Whether the friction exceeds F_S before the first slip.
    EXCEEDS_F_S, "exceeds-f-s", "lugre", &[], true, exceeds_f_s
);
check!(
    /// Whether the first slip is the same whatever the swept parameter.
    SAME_SLIP, "same-slip", "lugre", &[], true, same_slip
);
check!(
    /// Whether a mass gives both a rise and a friction after the stop that round to the printed ones.
    TOGETHER, "rise-and-drop-together", "lugre", &["rise", "force"], true, together
);
check!(
    /// Whether angle and speed stay within a figure's axes and fill more than half of each.
    WITHIN_AXES, "within-axes", "", &["angle", "speed"], false, within_axes
);
check!(
    /// Whether the drum turns less than the angle at which a spring goes slack.
    PRESTRESSED, "prestressed", "", &[], false, prestressed
);
check!(
    /// Whether the rig's own equation 40 and the mass-spring's, through 41, give the same acceleration.
    EQUIVALENT, "equivalent", "", &[], false, equivalent
);
check!(
    /// Whether the drum rests for a part of every period.
    RESTS, "rests", "", &["below"], false, rests
);

/// Time after which a mass with LuGre friction is looked at again [s], and how far it may have crept by then,
/// as a share of the deflection that breaks away.
const SETTLED: (f64, f64) = (100.0, 1e-3);
/// Swings after which the mass is near its rest.
const SWINGS: usize = 3000;
/// A force this near to F_C counts as F_C, and the first slip so near to another counts as the same.
const NEAR: f64 = 0.01;
/// The least share of the way that a staircase makes in its slips.
const IN_SLIPS: f64 = 0.9;

fn one<'a>(plan: &'a Plan, subject: &Subject) -> Result<(&'a Study, usize), String> {
    let point = subject.points.first().ok_or("no point of the sweep")?;
    Ok((&plan.studies[subject.study], *point))
}

fn v_s(study: &Study, point: usize) -> Option<f64> {
    match study.points[point].parameters.0.get("v_s") {
        Some(Parameter::Scalar(v_s)) => Some(*v_s),
        _ => None,
    }
}

/// Something seen in the first way a plant was solved in.
fn seen<T>(
    study: &Study,
    point: usize,
    of: impl Fn(&View) -> Result<T, String>,
) -> Result<T, String> {
    let motion = study.driven(point)?;
    of(&View::new(&study.exact(point)?.solved()?.first, &motion, v_s(study, point)))
}

fn settles_at_f_c(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let dahl = Dahl::new(&study.points[point].parameters).map_err(|e| e.to_string())?;
    let plant = study.points[point].plant.ok_or("no plant")?;
    let amplitude = plant.drive(study.input.range().1);
    let (mut least, mut most, mut spread, mut count, mut near) = (1.0_f64, 0.0_f64, 0.0_f64, 0, 0);
    for force in [-0.6, -0.1, 0.0, 0.3, 1.0] {
        let drive = force * amplitude;
        let held = HeldMass { dahl: dahl.clone(), stiffness: plant.stiffness, drive };
        for displaced in [-2.0, -0.5, 0.25, 1.0, 3.0] {
            for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                let q = (drive + displaced * dahl.f_c) / plant.stiffness;
                let settled = held.settle(Contact { q, force: share * dahl.f_c }, SWINGS);
                // A state that is a rest already shows nothing.
                if settled.swings == 0 {
                    continue;
                }
                let rest = settled.rest.force.abs() / dahl.f_c;
                (least, most) = (least.min(rest), most.max(rest));
                spread = spread.max(settled.spread * (plant.stiffness + dahl.sigma) / dahl.f_c);
                count += 1;
                near += u32::from(rest > 1.0 - NEAR);
            }
        }
    }
    Ok(Checked {
        holds: near == count,
        value: Some(most),
        error: Some(spread),
        unit: "1",
        how: format!(
            "largest |F|/F_C near rest, after {SWINGS} swings by the energy balance between turning points \
             (which the mass does not enter), over {count} combinations of constant force and initial state that is no \
             rest; the smallest is {least:.1e}; at F = ±F_C to 1 % come to rest {near} of them"
        ),
    })
}

fn comes_to_rest(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let lugre = LuGre::new(&study.points[point].parameters).map_err(|e| e.to_string())?;
    let plant = study.points[point].plant.ok_or("no plant")?;
    let amplitude = plant.drive(study.input.range().1);
    let largest = lugre.f_s / lugre.sigma_0;
    let (mut crept, mut least, mut most, mut count) = (0.0_f64, f64::INFINITY, 0.0_f64, 0);
    for force in [-0.6, -0.1, 0.0, 0.3, 1.0] {
        let drive = force * amplitude;
        let input =
            Input::sampled(vec![0.0, 1.0], vec![drive, drive]).map_err(|e| e.to_string())?;
        let span = (0.0, 2.0 * SETTLED.0);
        let motion = DrivenPlant::new(study.model_at(&study.points[point])?, plant, input, span);
        for displaced in [-2.0, -0.5, 0.5, 3.0] {
            for (v, x) in [(0.0, 0.0), (0.0, 0.9), (0.3, -0.5), (-1.0, 0.0)] {
                let q = (drive + displaced * lugre.f_s) / plant.stiffness;
                let located = solve_located(&motion, &[q, v, x * largest], 1e-9);
                if located.outcome != Outcome::Solved {
                    return Err(format!("a run at a constant force: {}", located.outcome));
                }
                let path = &located.path;
                crept = crept.max((path.q(2.0 * SETTLED.0) - path.q(SETTLED.0)).abs() / largest);
                let rest = (drive - plant.stiffness * path.q(2.0 * SETTLED.0)).abs();
                (least, most, count) = (least.min(rest), most.max(rest), count + 1);
            }
        }
    }
    Ok(Checked {
        holds: crept < SETTLED.1,
        value: Some(crept),
        error: None,
        unit: "1",
        how: format!(
            "largest creep between {} and {} s in units of F_S/σ₀, over {count} combinations of constant force \
             and initial state; it rests if below {}. The friction at rest is between {least:.3} and {most:.3} N \
             in size",
            SETTLED.0,
            2.0 * SETTLED.0,
            SETTLED.1
        ),
    })
}

fn staircase(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let study = &plan.studies[subject.study];
    let mut share = 1.0_f64;
    let mut fewest = usize::MAX;
    for point in &subject.points {
        let (slips, inside) = seen(study, *point, |view| {
            let slips = view.slips()?;
            let all: f64 = slips.iter().map(|s| (view.q(s.stop) - view.q(s.onset)).abs()).sum();
            let last = slips.last().map_or(0.0, |s| s.stop);
            Ok((slips.len(), all / (view.q(last) - view.q(0.0)).abs()))
        })?;
        (share, fewest) = (share.min(inside), fewest.min(slips));
    }
    Ok(Checked {
        holds: fewest >= 2 && share > IN_SLIPS,
        value: Some(share),
        error: None,
        unit: "1",
        how: format!(
            "smallest share of the displacement up to the last stop that is made in slips, over all points of \
             the sweep, of at least {fewest} slips each; a staircase if above {IN_SLIPS}"
        ),
    })
}

fn exceeds_f_s(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let study = &plan.studies[subject.study];
    let mut largest = 0.0_f64;
    for point in &subject.points {
        let f_s = LuGre::new(&study.points[*point].parameters).map_err(|e| e.to_string())?.f_s;
        let peak =
            seen(study, *point, |view| Ok(view.extreme_f((0.0, view.slip(1.0)?.onset), 1.0)))?;
        largest = largest.max(peak / f_s);
    }
    Ok(Checked {
        holds: largest > 1.0,
        value: Some(largest),
        error: None,
        unit: "1",
        how: "largest friction before the first slip in units of F_S, over all points of the sweep; it exceeds \
              F_S above 1"
            .to_owned(),
    })
}

fn same_slip(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let study = &plan.studies[subject.study];
    let (mut low, mut high, mut slipless) = (f64::INFINITY, 0.0_f64, 0);
    for point in &subject.points {
        let rise = seen(study, *point, |view| {
            let slips = view.slips()?;
            Ok(slips.first().map(|slip| view.q(slip.stop) - view.q(slip.onset)))
        })?;
        match rise {
            Some(rise) => (low, high) = (low.min(rise), high.max(rise)),
            None => slipless += 1,
        }
    }
    let apart = (high - low) / high;
    let without = if slipless == 0 {
        String::new()
    } else {
        format!("; with {slipless} of the values the mass slides on and does not stop")
    };
    Ok(Checked {
        holds: apart < NEAR && slipless == 0,
        value: Some(apart),
        error: None,
        unit: "1",
        how: format!(
            "by how much the first slip's rise differs over the values of the sweep, {low:.4} to {high:.4} m, \
             relative to the largest; the same if below {NEAR}{without}"
        ),
    })
}

fn together(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let study = &plan.studies[subject.study];
    let ([rise, rise_digit], [force, force_digit]) =
        (subject.argument("rise")?, subject.argument("force")?);
    let mut words = Vec::new();
    let mut nearest = f64::INFINITY;
    for point in &subject.points {
        let (ours, least) = seen(study, *point, |view| {
            let slip = view.slip(1.0)?;
            Ok((view.q(slip.stop) - view.q(slip.onset), view.force(slip.stop + RINGING)))
        })?;
        words.push(format!("{}: {ours:.3} m, {least:.3} N", study.points[*point].label));
        let off = (ours - rise).abs() / rise_digit;
        nearest = nearest.min(off.max((least - force).abs() / force_digit));
    }
    Ok(Checked {
        holds: nearest <= 0.5,
        value: Some(nearest),
        error: None,
        unit: "1",
        how: format!(
            "how far the rise of the first slip and the friction 0.2 s after its stop are from the printed {rise} m and {force} N \
             together, in units of the last printed digit, at the best point of the sweep (they agree below 0.5): {}",
            words.join("; ")
        ),
    })
}

fn within_axes(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let ([low, high], [slow, fast]) = (subject.argument("angle")?, subject.argument("speed")?);
    let (q, v) = seen(study, point, |view| {
        let span = (0.0, view.end());
        let q = (view.extreme_q(f64::min), view.extreme_q(f64::max));
        Ok((q, (view.extreme_v(span, -1.0), view.extreme_v(span, 1.0))))
    })?;
    let inside = low <= q.0 && q.1 <= high && slow <= v.0 && v.1 <= fast;
    let filled = ((q.1 - q.0) / (high - low)).min((v.1 - v.0) / (fast - slow));
    Ok(Checked {
        holds: inside && filled > 0.5,
        value: Some(filled),
        error: None,
        unit: "1",
        how: format!(
            "smaller share of an axis that is filled: angle from {:.4} to {:.4} rad on an axis from {low} to \
             {high}, speed from {:.4} to {:.4} rad/s on an axis from {slow} to {fast}; holds if inside and more \
             than half",
            q.0, q.1, v.0, v.1
        ),
    })
}

fn prestressed(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let rig = Rig::new(&study.points[point].plant_parameters).map_err(|e| e.to_string())?;
    let largest = |path: &simulation::Path| {
        let motion = study.driven(point)?;
        let view = View::new(path, &motion, None);
        Ok::<f64, String>(view.extreme_q(f64::max).max(-view.extreme_q(f64::min)))
    };
    let solved = study.exact(point)?.solved()?;
    let (ours, second) = (largest(&solved.first)?, largest(&solved.second)?);
    Ok(Checked {
        holds: ours < rig.slack_angle(),
        value: Some(ours),
        error: Some((ours - second).abs()),
        unit: "rad",
        how: format!(
            "largest angle of the drum, against {:.4} rad at which a spring goes slack",
            rig.slack_angle()
        ),
    })
}

fn equivalent(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let rig = Rig::new(&study.points[point].plant_parameters).map_err(|e| e.to_string())?;
    let plant = rig.plant();
    let mut worst = 0.0_f64;
    for theta in [-0.5, -0.1, 0.0, 0.3, 1.0] {
        for current in [-0.05, 0.0, 0.02, 0.05] {
            for friction in [-1.0, -0.3, 0.0, 0.84] {
                let ours = rig.acceleration(theta, rig.motor_torque(current), friction);
                let mapped = plant.acceleration(theta, plant.drive(current), friction);
                worst = worst.max((ours - mapped).abs() / (1.0 / rig.inertia));
            }
        }
    }
    Ok(Checked {
        holds: worst < 1e-14,
        value: Some(worst),
        error: Some(f64::EPSILON),
        unit: "N·m",
        how: "largest difference, as a torque, between the rig's equation 40 and the mass-spring's through 41, \
              over 80 combinations of angle, current and friction; equal below 1e-14 N·m"
            .to_owned(),
    })
}

fn rests(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (study, point) = one(plan, subject)?;
    let [below] = subject.argument("below")?;
    let share = seen(study, point, |view| Ok(view.rest_share(below, 20_000)))?;
    Ok(Checked {
        holds: share > 0.1,
        value: Some(share),
        error: None,
        unit: "1",
        how: format!(
            "share of the second half of the run in which the speed is below {below} rad/s; it rests if that is \
             more than a tenth"
        ),
    })
}
