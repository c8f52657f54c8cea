//! Who takes part in an anchor, and what each delivers.

use super::{Anchor, RTOLS, Row, RowControl, SOLVED, Timing, error, time};
use crate::{Delivered, Method, Motion, Solves, methods};
use duhem::ParameterError;
use integrate::{
    Control, Corners, InitialValueProblem, Limits, Order, Outcome, Sampling, Solver, deliver,
};

/// What a run of the benchmark asks of all who take part.
#[derive(Debug, Clone)]
pub struct Contest {
    /// The relative tolerances.
    pub rtols: Vec<f64>,
    /// Where a run is stopped.
    pub limits: Limits,
    /// How it is timed.
    pub timing: Timing,
}

/// The rows of an anchor: each method is looked at first and timed if it is right. `clock` tells the CPU
/// time of this thread [s].
pub fn run(
    anchor: &Anchor,
    reference: &[f64],
    contest: &Contest,
    clock: &mut dyn FnMut() -> f64,
) -> Result<Vec<Row>, ParameterError> {
    let motion = anchor.task.motion()?;
    let (problem, own) = (motion.problem(anchor.task.y0.clone()), own(anchor));
    let mut states = vec![0.0; anchor.grid.len() * anchor.task.y0.len()];
    let looked_at = |contestant| {
        let on = (anchor, motion.as_ref());
        Verified::new(contestant, on, reference, &contest.limits, &mut states)
    };
    let all = contestants(&own, &problem, &contest.rtols);
    let mut all: Vec<Verified<'_>> = all.into_iter().map(looked_at).collect();
    time(&mut all, (&anchor.grid, &contest.limits), &contest.timing, &mut states, clock);
    Ok(all.into_iter().map(|verified| verified.row).collect())
}

/// A method with what it is asked for.
#[derive(Debug)]
pub struct Contestant<'a> {
    name: &'static str,
    rtol: Option<f64>,
    restart: bool,
    how: How<'a>,
}

#[derive(Debug)]
enum How<'a> {
    Own(&'a dyn Solves),
    Library(&'static Solver, &'a InitialValueProblem<'a>),
}

/// Our own methods that hold for the anchor, and what they are made of it: built before any clock runs.
pub(super) fn own(anchor: &Anchor) -> Vec<(Method, Box<dyn Solves>)> {
    let build = |method: Method| match method {
        Method::Exact(own) | Method::Adaptive(own) => {
            (own.build)(&anchor.task).ok().map(|ready| (method, ready))
        }
        Method::Solver(_) => None,
    };
    methods().filter_map(build).collect()
}

/// All who take part: our own methods that hold, the exact ones once and the adaptive ones at each
/// tolerance, and every adaptive solver of the list, at the reversals of the input restarted or not.
pub fn contestants<'a>(
    own: &'a [(Method, Box<dyn Solves>)],
    problem: &'a InitialValueProblem<'a>,
    rtols: &[f64],
) -> Vec<Contestant<'a>> {
    let turns = !problem.breakpoints.is_empty();
    let mut all = Vec::new();
    for (method, ready) in own {
        let how = || How::Own(ready.as_ref());
        let name = method.name();
        if matches!(method, Method::Exact(_)) {
            all.push(Contestant { name, rtol: None, restart: turns, how: how() });
        } else {
            let at =
                |rtol: &f64| Contestant { name, rtol: Some(*rtol), restart: turns, how: how() };
            all.extend(rtols.iter().map(at));
        }
    }
    for method in methods() {
        let Method::Solver(solver) = method else { continue };
        if matches!(solver.order, Order::Fixed(_)) {
            continue;
        }
        for restart in [true, false].into_iter().filter(|restart| turns || !restart) {
            all.extend(rtols.iter().map(|rtol| Contestant {
                name: solver.name,
                rtol: Some(*rtol),
                restart,
                how: How::Library(solver, problem),
            }));
        }
    }
    all
}

impl Contestant<'_> {
    /// Solves the anchor and writes the states on its grid; this alone is timed.
    pub fn deliver(&self, grid: &[f64], limits: &Limits, states: &mut [f64]) -> Delivered {
        let rtol = self.rtol.unwrap_or(RTOLS[0]);
        match self.how {
            How::Own(ready) => ready.deliver(rtol, limits, grid, states),
            How::Library(solver, problem) => {
                let corners = if self.restart { Corners::Restart } else { Corners::Ignore };
                let control = Control::Tolerance { rtol };
                let sampling = Sampling { control, corners, limits: *limits, times: grid };
                let (work, outcome) = deliver(solver, problem, &sampling, states);
                Delivered { work, outcome }
            }
        }
    }

    /// Whether it is ours.
    pub fn ours(&self) -> bool {
        matches!(self.how, How::Own(_))
    }
}

/// A contestant whose answer has been looked at.
#[derive(Debug)]
pub struct Verified<'a> {
    /// The contestant.
    pub contestant: Contestant<'a>,
    /// Its row, without a time yet.
    pub row: Row,
}

impl<'a> Verified<'a> {
    /// Delivers once and compares with the reference.
    pub fn new(
        contestant: Contestant<'a>,
        (anchor, motion): (&Anchor, &dyn Motion),
        reference: &[f64],
        limits: &Limits,
        states: &mut [f64],
    ) -> Self {
        // What the last one left would be taken for an answer.
        states.fill(f64::NAN);
        let Delivered { work, outcome } = contestant.deliver(&anchor.grid, limits, states);
        let (status, error) = match outcome {
            Outcome::Solved => (SOLVED, Some(error(&anchor.quantity(motion, states), reference))),
            Outcome::Failed { why, .. } => (why.name(), None),
        };
        let row = Row {
            problem: anchor.problem.to_owned(),
            parameter: anchor.parameter,
            solver: contestant.name.to_owned(),
            ours: contestant.ours(),
            control: contestant.rtol.map(|rtol| RowControl { rtol }),
            restart: contestant.restart,
            error: error.filter(|error| error.is_finite()),
            cpu_s: None,
            evaluations: work.evaluations,
            status: status.to_owned(),
            jacobians: work.jacobians,
            accepted: work.accepted,
            rejected: work.rejected,
            repeats_s: Vec::new(),
        };
        Self { contestant, row }
    }
}
