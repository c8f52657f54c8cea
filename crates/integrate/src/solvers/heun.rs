//! yₙ₊₁ = yₙ + h/2 (k₁ + k₂), k₁ = f(tₙ, yₙ), k₂ = f(tₙ + h, yₙ + h k₁)

use super::{Order, Solver, march};
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "heun",
    library: "own",
    order: Order::Fixed(2),
    implicit: false,
    defect: None,
    run,
};

fn run(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let n = segment.dimension();
    let [mut k1, mut k2, mut stage] = std::array::from_fn(|_| vec![0.0; n]);
    march(segment, control, recorder, |t, h, y| {
        segment.derivative(t, y, &mut k1);
        for i in 0..n {
            stage[i] = y[i] + h * k1[i];
        }
        segment.derivative(t + h, &stage, &mut k2);
        for i in 0..n {
            y[i] += h / 2.0 * (k1[i] + k2[i]);
        }
        Ok(())
    })
}
