//! yₙ₊₁ = yₙ + h/2 (f(tₙ, yₙ) + f(tₙ + h, yₙ₊₁))

use super::{Order, Solver, march};
use crate::newton::Newton;
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "trapezoidal",
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
    let n = segment.dimension();
    let mut newton = Newton::new(n);
    let [mut f, mut base] = std::array::from_fn(|_| vec![0.0; n]);
    march(segment, control, recorder, |t, h, y| {
        segment.derivative(t, y, &mut f);
        for i in 0..n {
            base[i] = y[i] + h / 2.0 * f[i];
        }
        newton.solve(segment, (t + h, h / 2.0), &base, y)
    })
}
