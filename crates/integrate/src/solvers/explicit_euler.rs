//! yₙ₊₁ = yₙ + h f(tₙ, yₙ)

use super::{Order, Solver, march};
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "explicit-euler",
    library: "own",
    order: Order::Fixed(1),
    implicit: false,
    defect: None,
    run,
};

fn run(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let mut f = vec![0.0; segment.dimension()];
    march(segment, control, recorder, |t, h, y| {
        segment.derivative(t, y, &mut f);
        for i in 0..y.len() {
            y[i] += h * f[i];
        }
        Ok(())
    })
}
