//! Adapter to ode_solvers.
//!
//! What it works around, and why:
//! - Tolerances are two numbers for all states, so the library is given z = y/scale and atol =
//!   rtol: that is `rtol * scale` for each state.
//! - A run stops with "needs more than 100 000 steps" or "seems to become stiff", the latter on
//!   a test of every 1000th step only; both are raised out of reach, and our budget stops it.
//! - Dense output has a wrong last point if the end lies on its grid: it is asked for to a thousandth of
//!   the spacing beyond the end. Its `solout` is not given the state the solver is at, and `Dopri5` calls
//!   it at each point put out as well as at each step; both are told apart by the time. A state before a
//!   failure is then known only at the points put out. Where the times asked for are not equally spaced
//!   from start to end, the run is stopped at each.
//! - Otherwise output is Sparse.
//! - `Stats` does not count the steps rejected before the first accepted one; rejections follow
//!   from our count of evaluations instead.
//! - `Rk4` overshoots the end unless the span is a multiple of the step *in rounded arithmetic*,
//!   its clock adds up rounding, and it stores every step in memory reserved at the start. It is
//!   asked for half a step less than the span, which its own ceiling makes the right number of
//!   steps, in chunks that start at exact grid times.
//! - Vectors of up to five states live on the stack; the library copies them freely.

use crate::{Control, Failure, Grid, Recorder, Segment};
use ode_solvers::dop_shared::{IntegrationError, SolverResult};
use ode_solvers::{DVector, Dop853, Dopri5, OutputType, Rk4, SVector, System};
use std::cell::RefCell;

/// Steps of `Rk4` between two settings of its clock.
const CHUNK: u64 = 128;

/// Makes `$y` of the slice `$z`, on the stack if it is short, and evaluates `$body` with it.
macro_rules! with_vector {
    ($z:expr => $y:ident, $body:expr) => {
        match $z.len() {
            1 => with_vector!(@ SVector::<f64, 1>, $z => $y, $body),
            2 => with_vector!(@ SVector::<f64, 2>, $z => $y, $body),
            3 => with_vector!(@ SVector::<f64, 3>, $z => $y, $body),
            4 => with_vector!(@ SVector::<f64, 4>, $z => $y, $body),
            5 => with_vector!(@ SVector::<f64, 5>, $z => $y, $body),
            _ => with_vector!(@ DVector::<f64>, $z => $y, $body),
        }
    };
    (@ $vector:ty, $z:expr => $y:ident, $body:expr) => {{
        let $y = <$vector>::from_column_slice(&$z);
        $body
    }};
}

/// What the library calls back, on slices whatever its vector.
trait Ask {
    fn system(&self, t: f64, z: &[f64], dz: &mut [f64]);
    fn accept(&mut self, t: f64, z: &[f64]) -> Result<(), Failure>;
}

/// An [`Ask`] as the library wants it, holding the failure that stopped the solver.
struct Asked<'r, A> {
    ask: A,
    failure: &'r mut Option<Failure>,
}

impl<A: Ask> Asked<'_, A> {
    fn stop(&mut self, t: f64, z: &[f64]) -> bool {
        *self.failure = self.ask.accept(t, z).err();
        self.failure.is_some()
    }
}

impl<A: Ask, const N: usize> System<f64, SVector<f64, N>> for Asked<'_, A> {
    fn system(&self, t: f64, z: &SVector<f64, N>, dz: &mut SVector<f64, N>) {
        self.ask.system(t, z.as_slice(), dz.as_mut_slice());
    }
    fn solout(&mut self, t: f64, z: &SVector<f64, N>, _: &SVector<f64, N>) -> bool {
        self.stop(t, z.as_slice())
    }
}

impl<A: Ask> System<f64, DVector<f64>> for Asked<'_, A> {
    fn system(&self, t: f64, z: &DVector<f64>, dz: &mut DVector<f64>) {
        self.ask.system(t, z.as_slice(), dz.as_mut_slice());
    }
    fn solout(&mut self, t: f64, z: &DVector<f64>, _: &DVector<f64>) -> bool {
        self.stop(t, z.as_slice())
    }
}

/// The fixed grid of `Rk4`: step k + 1 is recorded at its grid time, not at the library's.
struct Gridded<'a, 'r, 'g> {
    segment: &'a Segment<'a>,
    recorder: &'r mut Recorder<'g>,
    grid: Grid,
    k: u64,
}

impl Ask for Gridded<'_, '_, '_> {
    fn system(&self, t: f64, y: &[f64], dy: &mut [f64]) {
        self.segment.derivative(t, y, dy);
    }
    fn accept(&mut self, _: f64, y: &[f64]) -> Result<(), Failure> {
        self.k += 1;
        self.recorder.accept(self.grid.time(self.k), y)
    }
}

pub(crate) fn rk4(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let grid = control.grid(segment)?;
    let mut y = segment.y0.clone();
    for k in (0..grid.steps).step_by(usize::try_from(CHUNK).unwrap_or(usize::MAX)) {
        let steps = CHUNK.min(grid.steps - k);
        let start = grid.time(k);
        let end = start + (steps as f64 - 0.5) * grid.h;
        let mut failure = None;
        let ask = Gridded { segment, recorder: &mut *recorder, grid, k };
        let asked = Asked { ask, failure: &mut failure };
        with_vector!(y => y0, Rk4::new(asked, start, y0, end, grid.h).integrate().map(|_| ()))
            .map_err(in_our_words)?;
        if let Some(why) = failure {
            return Err(why);
        }
        y.copy_from_slice(recorder.last_state());
    }
    Ok(())
}

/// Scaled states, and the time as one more state if the method is autonomous.
struct Scaled<'a, 'r, 'g> {
    segment: &'a Segment<'a>,
    recorder: &'r mut Recorder<'g>,
    /// Unscaled states.
    y: RefCell<Vec<f64>>,
    ways: Ways,
    tally: Tally,
    output: Output,
    /// The last time `Dopri5` was at a point it put out, or the start.
    put_out: f64,
}

/// What the library is asked to put out.
#[derive(Clone, Copy)]
enum Output {
    /// Every step.
    Steps,
    /// Points of this spacing, from the start.
    Points(f64),
}

impl Output {
    /// The library's name for it, the spacing, and the end it is given: beyond the segment's, where its
    /// dense output would spoil the last point.
    fn told(self, segment: &Segment<'_>) -> (OutputType, f64, f64) {
        let (start, end) = (segment.start, segment.end);
        match self {
            Output::Steps => (OutputType::Sparse, end - start, end),
            Output::Points(dx) => (OutputType::Dense, dx, end + BEYOND * dx),
        }
    }
}

/// How far beyond the end dense output goes, in spacings.
const BEYOND: f64 = 1e-3;

/// Least spacing of dense output: how near to the end the library takes a point for it is 1e-9.
const FINEST: f64 = 1e-5;

/// Evaluations as the method spends them, from which the rejected steps follow.
struct Tally {
    /// Evaluations before this segment.
    before: u64,
    /// Each attempted step, and each accepted one on top.
    attempt: u64,
    on_accept: u64,
    accepted: u64,
    rejected: u64,
}

/// Evaluations before the first step: two to guess its size, one to begin it.
const TO_START: u64 = 3;

/// Scale of the time as a state. So large that the time weighs nothing beside the other states,
/// neither in the error nor in the first step, and a power of two, so that nothing is rounded.
const TIME_SCALE: f64 = (1_u64 << 60) as f64;

impl Ask for Scaled<'_, '_, '_> {
    fn system(&self, t: f64, z: &[f64], dz: &mut [f64]) {
        let segment = self.segment;
        let n = segment.dimension();
        let mut y = self.y.borrow_mut();
        for i in 0..n {
            y[i] = z[i] * segment.scale[i];
        }
        let t = if self.ways.autonomous { segment.start + z[n] * TIME_SCALE } else { t };
        segment.derivative(t, &y, &mut dz[..n]);
        for (dz, scale) in dz.iter_mut().zip(segment.scale) {
            *dz /= scale;
        }
        dz[n..].fill(1.0 / TIME_SCALE);
    }

    fn accept(&mut self, t: f64, z: &[f64]) -> Result<(), Failure> {
        // A point put out is told with the time of the next, which is after the step's end.
        if matches!(self.output, Output::Points(_)) && self.ways.tells_points && t > self.put_out {
            self.put_out = t;
            return Ok(());
        }
        let tally = &mut self.tally;
        tally.accepted += 1;
        let spent = self.segment.evaluations() - tally.before;
        let attempts = (spent - TO_START - tally.accepted * tally.on_accept) / tally.attempt;
        let rejected = attempts - tally.accepted;
        self.recorder.reject(rejected - tally.rejected);
        tally.rejected = rejected;
        if matches!(self.output, Output::Points(_)) {
            self.recorder.count();
            return Ok(());
        }
        let mut y = self.y.borrow_mut();
        for i in 0..y.len() {
            y[i] = z[i] * self.segment.scale[i];
        }
        self.recorder.accept(snap(self.segment, t), &y)
    }
}

/// How one of the two methods goes about it.
#[derive(Clone, Copy)]
struct Ways {
    autonomous: bool,
    /// Evaluations of each attempted step, of each accepted one on top, and of its dense output.
    costs: (u64, u64, u64),
    /// Whether `solout` is called at each point of dense output as well.
    tells_points: bool,
}

impl<'a, 'r, 'g> Scaled<'a, 'r, 'g> {
    fn new(
        segment: &'a Segment<'a>,
        recorder: &'r mut Recorder<'g>,
        output: Output,
        ways: Ways,
    ) -> Self {
        recorder.reject(0);
        let before = segment.evaluations();
        let y = RefCell::new(vec![0.0; segment.dimension()]);
        let (attempt, accept, dense) = ways.costs;
        let on_accept = if matches!(output, Output::Steps) { accept } else { accept + dense };
        let tally = Tally { before, attempt, on_accept, accepted: 0, rejected: 0 };
        let put_out = segment.start;
        Scaled { segment, recorder, y, ways, tally, output, put_out }
    }

    /// The initial state as the library sees it.
    fn z0(&self) -> Vec<f64> {
        let segment = self.segment;
        let mut z: Vec<f64> = segment.y0.iter().zip(segment.scale).map(|(y, s)| y / s).collect();
        if self.ways.autonomous {
            z.push(0.0);
        }
        z
    }
}

/// Runs one of the methods over a segment with the output that suits what is asked for.
fn adaptive(
    segment: &Segment<'_>,
    recorder: &mut Recorder<'_>,
    method: impl Fn(&Segment<'_>, &mut Recorder<'_>, Output) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let due = recorder.all_due(segment.end);
    if due.is_empty() {
        return method(segment, recorder, Output::Steps);
    }
    if let Some(spacing) = spacing(segment, due) {
        return method(segment, recorder, Output::Points(spacing));
    }
    let mut segment = segment.clone();
    let end = segment.end;
    for t in due.iter().filter(|t| **t < end).chain([&end]) {
        segment.end = *t;
        method(&segment, recorder, Output::Steps)?;
        let y = recorder.last_state().to_vec();
        if recorder.due(*t).is_some() {
            recorder.deliver(&y)?;
        }
        (segment.start, segment.y0) = (*t, y);
    }
    Ok(())
}

/// The spacing of the times, if they are equally spaced from the start to the end and the library can
/// deliver them so.
fn spacing(segment: &Segment<'_>, times: &[f64]) -> Option<f64> {
    let (start, end) = (segment.start, segment.end);
    let dx = (end - start) / times.len() as f64;
    let rounding = 1e-9 * dx + 8.0 * f64::EPSILON * end.abs();
    let equal = |(i, t): (usize, &f64)| (start + (i + 1) as f64 * dx - t).abs() <= rounding;
    (start >= 0.0 && dx > FINEST && times.iter().enumerate().all(equal)).then_some(dx)
}

/// Delivers the points of a run with dense output; a run that got to its end is there.
fn hand_on<'z>(
    segment: &Segment<'_>,
    recorder: &mut Recorder<'_>,
    points: impl Iterator<Item = &'z [f64]>,
    result: Result<(), Failure>,
) -> Result<(), Failure> {
    let mut y = segment.y0.clone();
    let due = recorder.all_due(segment.end).len();
    // The first point is the start.
    for z in points.skip(1).take(due) {
        for ((y, z), scale) in y.iter_mut().zip(z).zip(segment.scale) {
            *y = z * scale;
        }
        recorder.deliver(&y)?;
    }
    result?;
    recorder.arrive(segment.end, &y)
}

/// Makes a stepper of `$method`, runs it over `$segment` and hands on what it delivers.
macro_rules! integrate {
    ($method:ident, $segment:expr, $recorder:expr, ($output:expr, $ways:expr, $rtol:expr), $numbers:expr) => {{
        let (segment, recorder, output, rtol): (&Segment<'_>, &mut Recorder<'_>, Output, f64) =
            ($segment, $recorder, $output, $rtol);
        let (beta, least, most) = $numbers;
        let (kind, dx, end) = output.told(segment);
        let (t, span) = (segment.start, end - segment.start);
        let ask = Scaled::new(segment, &mut *recorder, output, $ways);
        let z = ask.z0();
        let mut failure = None;
        let asked = Asked { ask, failure: &mut failure };
        with_vector!(z => y, {
            let mut stepper = $method::from_param(
                asked, t, end, dx, y, rtol, rtol, 0.9, beta, least, most, span, 0.0,
                u32::MAX, u32::MAX, kind,
            );
            let result = stepper.integrate().map(|_| ()).map_err(in_our_words);
            let results = SolverResult::from(stepper);
            let result = failure.map_or(result, Err);
            match output {
                Output::Steps => result,
                Output::Points(_) => {
                    let points = results.get().1.iter().map(|z| z.as_slice());
                    hand_on(segment, recorder, points, result)
                }
            }
        })
    }};
}

pub(crate) fn dopri5(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let rtol = control.rtol()?;
    let ways = Ways { autonomous: false, costs: (6, 0, 0), tells_points: true };
    // The numbers are the library's own defaults: beta, least and largest step factor.
    adaptive(segment, recorder, |segment, recorder, output| {
        integrate!(Dopri5, segment, recorder, (output, ways, rtol), (0.04, 0.2, 10.0))
    })
}

pub(crate) fn dop853(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
    autonomous: bool,
) -> Result<(), Failure> {
    let rtol = control.rtol()?;
    let ways = Ways { autonomous, costs: (11, 1, 3), tells_points: false };
    adaptive(segment, recorder, |segment, recorder, output| {
        integrate!(Dop853, segment, recorder, (output, ways, rtol), (0.0, 0.333, 6.0))
    })
}

/// The end, for a time that misses it by no more than rounding: the library adds its last step.
fn snap(segment: &Segment<'_>, t: f64) -> f64 {
    let rounding = 4.0 * f64::EPSILON * segment.start.abs().max(segment.end.abs());
    if (t - segment.end).abs() <= rounding { segment.end } else { t }
}

#[expect(clippy::needless_pass_by_value, reason = "it stands in map_err")]
fn in_our_words(error: IntegrationError) -> Failure {
    match error {
        IntegrationError::MaxNumStepReached { .. } => Failure::TooManyEvaluations,
        IntegrationError::StepSizeUnderflow { .. } => Failure::StepTooSmall,
        IntegrationError::StiffnessDetected { .. } => Failure::Stopped(error.to_string()),
    }
}
