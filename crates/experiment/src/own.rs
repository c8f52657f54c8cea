//! A run of a method of our own: it is given the task, and delivers the states at the times asked for.

use crate::plan::{Case, Study};
use integrate::{Failure, Limits, Outcome, Run, Trajectory, Work};
use simulation::{Delivered, Own};
use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
};

/// Times a period at which errors are taken, besides the kinks.
const PER_PERIOD: f64 = 200.0;
/// The same over a span that is no matter of periods.
const PER_SPAN: f64 = 2000.0;

/// The case's run, on the study's [`grid`]: as its trajectory the errors are taken on.
pub(crate) fn run(
    study: &Study,
    case: &Case,
    own: &'static Own,
    kinks: &[f64],
) -> Result<Run, String> {
    let task = study.task(case.point)?;
    let method = (own.build)(&task).map_err(|error| error.to_string())?;
    let (n, mut t) = (task.y0.len(), grid(study, kinks));
    let mut y = vec![f64::NAN; n * t.len()];
    let limits = Limits { evaluations: study.budget };
    // As of a solver, a panic is a result; unlike theirs it is our own, and heard.
    let delivered =
        catch_unwind(AssertUnwindSafe(|| method.deliver(case.value, &limits, &t, &mut y)));
    let Delivered { work, outcome } = delivered.unwrap_or_else(|words| Delivered {
        work: Work::default(),
        outcome: Outcome::Failed { at: 0.0, why: panicked(words.as_ref()) },
    });
    if let Outcome::Failed { at, .. } = &outcome {
        let reached =
            y.chunks(n).zip(&t).take_while(|(y, t)| **t <= *at && y.iter().all(|y| y.is_finite()));
        let reached = reached.count();
        t.truncate(reached);
        y.truncate(n * reached);
    }
    Ok(Run { trajectory: Trajectory { t, y, n }, work, outcome })
}

/// The times errors are taken at: start, kinks and end, and equal ones between.
fn grid(study: &Study, kinks: &[f64]) -> Vec<f64> {
    let parts = if study.period < study.span {
        PER_PERIOD * (study.span / study.period)
    } else if study.input.period() == Some(study.span) {
        PER_PERIOD
    } else {
        PER_SPAN
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 2e6")]
    let parts = parts.ceil() as u32;
    let equal = (0..=parts).map(|i| study.span * (f64::from(i) / f64::from(parts)));
    let inside = kinks.iter().copied().filter(|t| *t > 0.0 && *t < study.span);
    let mut times: Vec<f64> = equal.chain(inside).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

fn panicked(words: &(dyn Any + Send)) -> Failure {
    let text = words.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| words.downcast_ref::<&str>().copied());
    Failure::Panicked(text.unwrap_or("without words").to_owned())
}
