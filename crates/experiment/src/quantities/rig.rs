//! Quantities of the rig itself: its springs, its motor.

use super::{Measured, Quantity};
use crate::plan::{Plan, Point, Study, Subject};
use duhem::{MaxwellSlip, Rig, closed_form::maxwell_slip::saturation_force};

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, ($method:expr, $second:expr), $code:literal, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "",
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            code: $code,
            takes: &[],
            measure: $measure,
        };
    };
}

quantity!(
    STIFFNESS,
    "rig_stiffness",
    "N/m",
    "stiffness of the springs at the drum, (k_1 + k_2) r²",
    ("equation 41", "the torque of equation 37 at 0.1 rad and at 0, per angle"),
    "crates/duhem/src/plant/rig.rs, plant",
    |plan, subject| {
        let (_, point) = at(plan, subject)?;
        let rig = rig(point)?;
        let torque = |theta| rig.net_torque(theta, 0.0, 0.0);
        let second = (torque(0.0) - torque(0.1)) / 0.1;
        Ok(Measured::of(rig.plant().stiffness, second))
    }
);

quantity!(
    DRIVE_AMPLITUDE,
    "drive_amplitude",
    "N",
    "largest driving force",
    ("the plant's drive at the input's largest value", "the largest drive on a fine grid of times"),
    "crates/duhem/src/plant/mod.rs, drive",
    |plan, subject| {
        let (study, point) = at(plan, subject)?;
        let plant = point.plant.ok_or("an imposed motion where a plant is needed")?;
        let period = study.input.period().ok_or("an input without a period")?;
        let times = (0..=4000).map(|i| period * f64::from(i) / 4000.0);
        let second = times.map(|t| plant.drive(study.input.u(t)).abs()).fold(0.0, f64::max);
        Ok(Measured::of(plant.drive(study.input.range().1), second))
    }
);

quantity!(
    SLACK_ANGLE,
    "slack_angle",
    "m",
    "smallest angle of the drum at which a spring goes slack",
    (
        "F_10/(k_1 r), F_20/(k_2 r)",
        "bisection for the first angle at which a spring's force is zero"
    ),
    "crates/duhem/src/plant/rig.rs, slack_angle",
    |plan, subject| {
        let (_, point) = at(plan, subject)?;
        let rig = rig(point)?;
        let slack = |theta: f64| {
            let both = [rig.spring_forces(theta), rig.spring_forces(-theta)];
            both.iter().any(|(f_1, f_2)| f_1.min(*f_2) <= 0.0)
        };
        let (mut low, mut high) = (0.0, 1e6);
        while 0.5 * (low + high) > low && 0.5 * (low + high) < high {
            let middle = 0.5 * (low + high);
            if slack(middle) { high = middle } else { low = middle }
        }
        Ok(Measured::of(rig.slack_angle(), high))
    }
);

quantity!(
    FULL_SLIP_FORCE,
    "full_slip_force",
    "N",
    "friction when all elements slip, Σ k_i Δ_i",
    ("the sum of products", "the force of the model with every element drawn to its deadband"),
    "crates/duhem/src/closed_form/maxwell_slip.rs, saturation_force",
    |plan, subject| {
        let (study, point) = at(plan, subject)?;
        let elements = MaxwellSlip::new(&point.parameters).map_err(|e| e.to_string())?;
        let model = study.model_at(point)?;
        let x: Vec<f64> = model.scale().iter().map(|delta| -delta).collect();
        let second = model.force(&x, &vec![0.0; x.len()], 0.0, 1.0);
        Ok(Measured::of(saturation_force(&elements), second))
    }
);

fn at<'a>(plan: &'a Plan, subject: &Subject) -> Result<(&'a Study, &'a Point), String> {
    let study = &plan.studies[subject.study];
    let point = subject.points.first().ok_or("no point of the sweep")?;
    Ok((study, &study.points[*point]))
}

fn rig(point: &Point) -> Result<Rig, String> {
    Rig::new(&point.plant_parameters).map_err(|e| e.to_string())
}
