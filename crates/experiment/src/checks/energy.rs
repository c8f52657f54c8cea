//! What the paper says of energy.

use super::{Check, Checked};
use crate::plan::{Plan, Subject};
use duhem::{
    Dahl,
    closed_form::dahl::Loop,
    measures::{Orientation, orientation},
};

/// Points on each branch of the loop.
const POINTS: u32 = 2000;

/// The way the loop is run through with u horizontal and F vertical, against `expect`.
pub(super) const ORIENTATION: Check = Check {
    name: "orientation",
    model: "dahl",
    expects: &["clockwise", "counterclockwise"],
    takes: &[],
    many: false,
    code: "crates/experiment/src/checks/energy.rs, turning",
    run: turning,
};

fn turning(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let study = &plan.studies[subject.study];
    let point = &study.points[*subject.points.first().ok_or("no point")?];
    let dahl = Dahl::new(&point.parameters).map_err(|e| e.to_string())?;
    let (u_min, u_max) = study.input.range();
    let settled = Loop::new(&dahl, (u_min, u_max));
    let along = |i: u32| u_min + (u_max - u_min) * f64::from(i) / f64::from(POINTS);
    let up = (0..=POINTS).map(|i| (along(i), settled.force(along(i), true)));
    let down = (0..=POINTS).rev().map(|i| (along(i), settled.force(along(i), false)));
    let (u, f): (Vec<f64>, Vec<f64>) = up.chain(down).unzip();
    let found = match orientation(&u, &f) {
        Orientation::Clockwise => "clockwise",
        Orientation::Counterclockwise => "counterclockwise",
        Orientation::None => return Err("the loop encloses nothing".to_owned()),
    };
    // The area that a counterclockwise path encloses is positive: minus ∮F du.
    let signed: f64 = (1..u.len()).map(|i| 0.5 * (f[i] + f[i - 1]) * (u[i] - u[i - 1])).sum();
    Ok(Checked {
        holds: found == subject.expect,
        value: Some(-signed),
        error: Some((signed - settled.area()).abs()),
        unit: "J",
        how: format!(
            "area enclosed by the settled loop in the plane of the paper's figures, positive if it is run \
             through counterclockwise: it is run through {found}"
        ),
    })
}
