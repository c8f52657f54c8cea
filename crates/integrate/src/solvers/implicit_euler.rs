//! yₙ₊₁ = yₙ + h f(tₙ + h, yₙ₊₁)

use super::{Order, Solver, march};
use crate::newton::Newton;
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "implicit-euler",
    library: "own",
    order: Order::Fixed(1),
    implicit: true,
    defect: None,
    run,
};

fn run(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let mut newton = Newton::new(segment.dimension());
    let mut base = segment.y0.clone();
    march(segment, control, recorder, |t, h, y| {
        base.copy_from_slice(y);
        newton.solve(segment, (t + h, h), &base, y)
    })
}
