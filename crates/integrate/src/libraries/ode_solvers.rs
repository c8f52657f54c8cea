//! Adapter to ode_solvers.
//!
//! What it works around, and why:
//! - Tolerances are two numbers for all states, so the library is given z = y/scale and atol =
//!   rtol: that is `rtol * scale` for each state.
//! - A run stops with "needs more than 100 000 steps" or "seems to become stiff", the latter on
//!   a test of every 1000th step only; both are raised out of reach, and our budget stops it.
//! - Output is Sparse: dense output has a wrong last point, and its `solout` is not given the state
//!   the solver is at.
//! - `Stats` does not count the steps rejected before the first accepted one; rejections follow
//!   from our count of evaluations instead.
//! - `Rk4` overshoots the end unless the span is a multiple of the step *in rounded arithmetic*,
//!   its clock adds up rounding, and it stores every step in memory reserved at the start. It is
//!   asked for half a step less than the span, which its own ceiling makes the right number of
//!   steps, in chunks that start at exact grid times.
//! - Vectors of up to five states live on the stack; the library copies them freely.

use crate::{Control, Failure, Grid, Recorder, Segment};
use ode_solvers::dop_shared::IntegrationError;
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
struct Gridded<'a, 'r> {
    segment: &'a Segment<'a>,
    recorder: &'r mut Recorder,
    grid: Grid,
    k: u64,
}

impl Ask for Gridded<'_, '_> {
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
    recorder: &mut Recorder,
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
struct Scaled<'a, 'r> {
    segment: &'a Segment<'a>,
    recorder: &'r mut Recorder,
    /// Unscaled states.
    y: RefCell<Vec<f64>>,
    autonomous: bool,
    tally: Tally,
}

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

impl Ask for Scaled<'_, '_> {
    fn system(&self, t: f64, z: &[f64], dz: &mut [f64]) {
        let segment = self.segment;
        let n = segment.dimension();
        let mut y = self.y.borrow_mut();
        for i in 0..n {
            y[i] = z[i] * segment.scale[i];
        }
        let t = if self.autonomous { segment.start + z[n] * TIME_SCALE } else { t };
        segment.derivative(t, &y, &mut dz[..n]);
        for (dz, scale) in dz.iter_mut().zip(segment.scale) {
            *dz /= scale;
        }
        dz[n..].fill(1.0 / TIME_SCALE);
    }

    fn accept(&mut self, t: f64, z: &[f64]) -> Result<(), Failure> {
        let mut y = self.y.borrow_mut();
        for i in 0..y.len() {
            y[i] = z[i] * self.segment.scale[i];
        }
        let tally = &mut self.tally;
        tally.accepted += 1;
        let spent = self.segment.evaluations() - tally.before;
        let attempts = (spent - TO_START - tally.accepted * tally.on_accept) / tally.attempt;
        let rejected = attempts - tally.accepted;
        self.recorder.reject(rejected - tally.rejected);
        tally.rejected = rejected;
        self.recorder.accept(snap(self.segment, t), &y)
    }
}

impl<'a, 'r> Scaled<'a, 'r> {
    fn new(
        segment: &'a Segment<'a>,
        recorder: &'r mut Recorder,
        autonomous: bool,
        (attempt, on_accept): (u64, u64),
    ) -> Self {
        recorder.reject(0);
        let before = segment.evaluations();
        let y = RefCell::new(vec![0.0; segment.dimension()]);
        let tally = Tally { before, attempt, on_accept, accepted: 0, rejected: 0 };
        Scaled { segment, recorder, y, autonomous, tally }
    }

    /// The initial state as the library sees it.
    fn z0(&self) -> Vec<f64> {
        let segment = self.segment;
        let mut z: Vec<f64> = segment.y0.iter().zip(segment.scale).map(|(y, s)| y / s).collect();
        if self.autonomous {
            z.push(0.0);
        }
        z
    }
}

pub(crate) fn dopri5(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder,
) -> Result<(), Failure> {
    let rtol = control.rtol()?;
    let (t, end) = (segment.start, segment.end);
    let ask = Scaled::new(segment, recorder, false, (6, 0));
    let z = ask.z0();
    let mut failure = None;
    let asked = Asked { ask, failure: &mut failure };
    // The numbers are the library's own defaults: safety, beta, least and largest step factor.
    let result = with_vector!(z => y, Dopri5::from_param(
        asked, t, end, end - t, y, rtol, rtol, 0.9, 0.04, 0.2, 10.0, end - t, 0.0,
        u32::MAX, u32::MAX, OutputType::Sparse,
    ).integrate().map(|_| ()));
    failure.map_or(result.map_err(in_our_words), Err)
}

pub(crate) fn dop853(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder,
    autonomous: bool,
) -> Result<(), Failure> {
    let rtol = control.rtol()?;
    let (t, end) = (segment.start, segment.end);
    let ask = Scaled::new(segment, recorder, autonomous, (11, 1));
    let z = ask.z0();
    let mut failure = None;
    let asked = Asked { ask, failure: &mut failure };
    let result = with_vector!(z => y, Dop853::from_param(
        asked, t, end, end - t, y, rtol, rtol, 0.9, 0.0, 0.333, 6.0, end - t, 0.0,
        u32::MAX, u32::MAX, OutputType::Sparse,
    ).integrate().map(|_| ()));
    failure.map_or(result.map_err(in_our_words), Err)
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
