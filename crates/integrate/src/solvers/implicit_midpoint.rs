//! yₙ₊₁ = yₙ + h f(tₙ + h/2, (yₙ + yₙ₊₁)/2), solved for the midpoint: Y = yₙ + h/2 f(tₙ + h/2, Y),
//! yₙ₊₁ = 2Y − yₙ

use super::{Order, Solver, march};
use crate::newton::Newton;
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "implicit-midpoint",
    library: "own",
    order: Order::Fixed(2),
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
        newton.solve(segment, (t + h / 2.0, h / 2.0), &base, y)?;
        for i in 0..y.len() {
            y[i] = 2.0 * y[i] - base[i];
        }
        Ok(())
    })
}
