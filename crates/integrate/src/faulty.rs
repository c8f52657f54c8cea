//! Methods that misbehave on purpose.

use crate::{Control, Failure, Order, Recorder, Segment, Solver};
use std::time::Duration;

/// One method for each way in which a solver can go wrong, for the tests of everything that has to
/// survive it. Not in [`crate::SOLVERS`], and in no set; found by name. Each takes a good first
/// step of a tenth of the segment, whatever the control, and then goes wrong. The one that never
/// calls back never returns.
pub const FAULTY: &[Solver] = &[
    faulty("faulty-diverges", diverges),
    faulty("faulty-nan", nan),
    faulty("faulty-panics", panics),
    faulty("faulty-never-calls-back", never_calls_back),
    faulty("faulty-calls-forever", calls_forever),
];

const fn faulty(
    name: &'static str,
    run: fn(&Segment<'_>, &Control, &mut Recorder<'_>) -> Result<(), Failure>,
) -> Solver {
    let defect = Some("misbehaves on purpose");
    Solver { name, library: "own", order: Order::Fixed(1), implicit: false, defect, run }
}

/// One good step of Euler's method.
fn first_step(
    segment: &Segment<'_>,
    recorder: &mut Recorder<'_>,
) -> Result<(f64, Vec<f64>), Failure> {
    let h = (segment.end - segment.start) / 10.0;
    let mut f = vec![0.0; segment.dimension()];
    segment.derivative(segment.start, &segment.y0, &mut f);
    let y: Vec<f64> = segment.y0.iter().zip(&f).map(|(y, f)| y + h * f).collect();
    recorder.accept(segment.start + h, &y)?;
    Ok((h, y))
}

fn diverges(
    segment: &Segment<'_>,
    _: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let (h, mut y) = first_step(segment, recorder)?;
    for k in 2.. {
        for (y, scale) in y.iter_mut().zip(segment.scale) {
            *y = 100.0 * (*y + scale);
        }
        recorder.accept(segment.start + h * f64::from(k), &y)?;
    }
    Ok(())
}

/// Claims success with a state that is not a number.
fn nan(segment: &Segment<'_>, _: &Control, recorder: &mut Recorder<'_>) -> Result<(), Failure> {
    let (_, mut y) = first_step(segment, recorder)?;
    y.fill(f64::NAN);
    recorder.accept(segment.end, &y)
}

fn panics(segment: &Segment<'_>, _: &Control, recorder: &mut Recorder<'_>) -> Result<(), Failure> {
    first_step(segment, recorder)?;
    panic!("this solver panics on purpose");
}

fn never_calls_back(
    segment: &Segment<'_>,
    _: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    first_step(segment, recorder)?;
    loop {
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn calls_forever(
    segment: &Segment<'_>,
    _: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let (h, y) = first_step(segment, recorder)?;
    let mut f = vec![0.0; segment.dimension()];
    loop {
        segment.derivative(segment.start + h, &y, &mut f);
    }
}
