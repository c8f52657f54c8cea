//! Quantities of a plant with friction: taken of each of the two ways it was solved in.

use super::{Measured, Quantity, path::View};
use crate::plan::{Plan, Study, Subject};
use duhem::Parameter;

const FIRST: &str = "the plant solved (see the study's reference), first way";
const SECOND: &str = "the same quantity of the plant solved in the second way";
const CODE: &str = "crates/experiment/src/quantities/plant.rs";

/// What two ways share, as the rounding of one model, their difference does not show: the bound is this many
/// times as wide.
const SHARED: f64 = 10.0;

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:literal, $what:literal, $takes:expr, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: "",
            unit: $unit,
            what: $what,
            method: FIRST,
            second: SECOND,
            code: CODE,
            takes: $takes,
            measure: $measure,
        };
    };
}

quantity!(Q_MAX, "q_max", "m", "largest displacement", &[], |plan, subject| both(
    plan,
    subject,
    |view| Ok(view.extreme_q(f64::max))
));

quantity!(Q_MIN, "q_min", "m", "smallest displacement", &[], |plan, subject| both(
    plan,
    subject,
    |view| Ok(view.extreme_q(f64::min))
));

quantity!(V_MAX, "v_max", "m/s", "largest velocity", &[], |plan, subject| both(
    plan,
    subject,
    |view| Ok(view.extreme_v((0.0, view.end()), 1.0))
));

quantity!(V_MIN, "v_min", "m/s", "smallest velocity", &[], |plan, subject| both(
    plan,
    subject,
    |view| Ok(view.extreme_v((0.0, view.end()), -1.0))
));

quantity!(
    DISPLACEMENT_DIFFERENCE,
    "displacement_difference",
    "m",
    "displacement after the first of two numbers of half periods of the input, less that after the second",
    &["half_periods"],
    |plan, subject| {
        let [first, second] = subject.argument("half_periods")?;
        let half = 0.5 * period(plan, subject)?;
        both(plan, subject, |view| Ok(view.q(first * half) - view.q(second * half)))
    }
);

quantity!(
    TURN_TIME,
    "turn_time",
    "s",
    "time of a reversal of the displacement, by its number",
    &["number"],
    |plan, subject| {
        let [number] = subject.argument("number")?;
        both(plan, subject, |view| view.turn(number))
    }
);

quantity!(
    TURN_DISPLACEMENT,
    "turn_displacement",
    "m",
    "displacement at a reversal, by its number",
    &["number"],
    |plan, subject| {
        let [number] = subject.argument("number")?;
        both(plan, subject, |view| Ok(view.q(view.turn(number)?)))
    }
);

quantity!(
    WORK_OF_DRIVE,
    "work_of_drive",
    "J",
    "∮ of the driving force over the displacement, between two numbers of periods of the input",
    &["periods"],
    |plan, subject| {
        let [from, to] = subject.argument("periods")?;
        let period = period(plan, subject)?;
        both(plan, subject, |view| Ok(view.work((from * period, to * period))))
    }
);

quantity!(
    SLIPS,
    "slips",
    "1",
    "number of slips: onsets, where |v| rises through v_S",
    &[],
    |plan, subject| exact(both(plan, subject, |view| Ok(view.slips()?.len() as f64)))
);

quantity!(
    SLIP_ONSET_TIME,
    "slip_onset_time",
    "s",
    "time of a slip's onset, where |v| rises through v_S",
    &["number"],
    |plan, subject| slip(plan, subject, |_, slip| Ok(slip.onset))
);

quantity!(
    SLIP_ONSET_DRIVE,
    "slip_onset_drive",
    "N",
    "driving force at a slip's onset",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| Ok(view.drive(slip.onset)))
);

quantity!(
    SLIP_RISE,
    "slip_rise",
    "m",
    "displacement from a slip's onset to its stop, the first v = 0 after it",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| Ok(view.q(slip.stop) - view.q(slip.onset)))
);

quantity!(
    SLIP_PEAK_SPEED,
    "slip_peak_speed",
    "m/s",
    "largest speed of a slip",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| {
        let span = (slip.onset, slip.stop);
        Ok(view.extreme_v(span, 1.0).abs().max(view.extreme_v(span, -1.0).abs()))
    })
);

quantity!(
    SLIP_FORCE_PEAK,
    "slip_force_peak",
    "N",
    "largest friction force from t = 0 to a slip's onset",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| Ok(view.extreme_f((0.0, slip.onset), 1.0)))
);

quantity!(
    SLIP_FORCE_MIN,
    "slip_force_min",
    "N",
    "smallest friction force from a slip's onset to 0.2 s after its stop, while the contact rings",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| {
        Ok(view.extreme_f((slip.onset, slip.stop + super::path::RINGING), -1.0))
    })
);

quantity!(
    SLIP_FORCE_REST,
    "slip_force_rest",
    "N",
    "friction force 0.2 s after a slip's stop",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| {
        Ok(view.force(slip.stop + super::path::RINGING))
    })
);

quantity!(
    SLIP_FORCE_DROP,
    "slip_force_drop",
    "N",
    "how far the friction force falls in a slip: its largest value before the onset less that 0.2 s after the stop",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| {
        let peak = view.extreme_f((0.0, slip.onset), 1.0);
        Ok(peak - view.force(slip.stop + super::path::RINGING))
    })
);

quantity!(
    SLIP_FORCE_AMPLITUDE,
    "slip_force_amplitude",
    "N",
    "half of how far the friction force swings in a slip: from its largest value before the onset to that 0.2 s after the stop",
    &["number"],
    |plan, subject| slip(plan, subject, |view, slip| {
        let peak = view.extreme_f((0.0, slip.onset), 1.0);
        Ok(0.5 * (peak - view.force(slip.stop + super::path::RINGING)))
    })
);

quantity!(
    STICK_DRIVE,
    "stick_drive",
    "N",
    "how far the driving force rises while the mass sticks: from a slip's stop to the next onset",
    &["number"],
    |plan, subject| {
        let [number] = subject.argument("number")?;
        both(plan, subject, |view| {
            let (this, next) = (view.slip(number)?, view.slip(number + 1.0)?);
            Ok(view.drive(next.onset) - view.drive(this.stop))
        })
    }
);

quantity!(
    FULL_SLIPS,
    "full_slips",
    "1",
    "reversals out of a state in which all elements slip",
    &[],
    |plan, subject| exact(both(plan, subject, |view| Ok(view.full_slips())))
);

quantity!(
    REST_SHARE,
    "rest_share",
    "1",
    "share of the second half of the run in which the speed is below a given one",
    &["below"],
    |plan, subject| {
        let [below] = subject.argument("below")?;
        let fine = both(plan, subject, |view| Ok(view.rest_share(below, 200_000)))?;
        let coarse = both(plan, subject, |view| Ok(view.rest_share(below, 20_000)))?;
        // It is counted on a grid of times, and is as good as a coarser one shows.
        let error = fine.error + (fine.value - coarse.value).abs() + 1.0 / 20_000.0;
        Ok(Measured { error, ..fine })
    }
);

quantity!(
    FIRST_PEAK,
    "first_peak",
    "m",
    "largest displacement in the first period of the input",
    &[],
    |plan, subject| {
        let period = period(plan, subject)?;
        both(plan, subject, |view| Ok(view.extreme((0.0, period), 1.0, |t| view.q(t))))
    }
);

fn study<'a>(plan: &'a Plan, subject: &Subject) -> (&'a Study, usize) {
    (&plan.studies[subject.study], subject.points.first().copied().unwrap_or(0))
}

fn period(plan: &Plan, subject: &Subject) -> Result<f64, String> {
    study(plan, subject).0.input.period().ok_or_else(|| "an input without a period".to_owned())
}

/// The quantity of both ways.
fn both(
    plan: &Plan,
    subject: &Subject,
    of: impl Fn(&View) -> Result<f64, String>,
) -> Result<Measured, String> {
    let (study, point) = study(plan, subject);
    let solved = study.exact(point)?.solved()?;
    let motion = study.driven(point)?;
    let v_s = match study.points[point].parameters.0.get("v_s") {
        Some(Parameter::Scalar(v_s)) => Some(*v_s),
        _ => None,
    };
    let ours = of(&View::new(&solved.first, &motion, v_s))?;
    let measured = Measured::of(ours, of(&View::new(&solved.second, &motion, v_s))?);
    Ok(Measured { error: SHARED * measured.error, ..measured })
}

/// The quantity of the slip whose number is given.
fn slip(
    plan: &Plan,
    subject: &Subject,
    of: impl Fn(&View, super::path::Slip) -> Result<f64, String>,
) -> Result<Measured, String> {
    let [number] = subject.argument("number")?;
    both(plan, subject, |view| of(view, view.slip(number)?))
}

/// A count: exact if both ways agree, and an error of ours if not.
fn exact(count: Result<Measured, String>) -> Result<Measured, String> {
    let Measured { value, error } = count?;
    if error > 0.5 {
        return Err(format!("the two ways count differently: {value} and {error} apart"));
    }
    Ok(Measured { value, error: 0.0 })
}
