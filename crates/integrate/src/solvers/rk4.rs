//! The classical Runge-Kutta method:
//! yₙ₊₁ = yₙ + h/6 (k₁ + 2k₂ + 2k₃ + k₄)

use super::{Order, Solver, march};
use crate::{Control, Failure, Recorder, Segment};

pub(super) const SOLVER: Solver = Solver {
    name: "rk4",
    library: "own",
    order: Order::Fixed(4),
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
    let [mut k1, mut k2, mut k3, mut k4, mut stage] = std::array::from_fn(|_| vec![0.0; n]);
    march(segment, control, recorder, |t, h, y| {
        segment.derivative(t, y, &mut k1);
        ahead(y, h / 2.0, &k1, &mut stage);
        segment.derivative(t + h / 2.0, &stage, &mut k2);
        ahead(y, h / 2.0, &k2, &mut stage);
        segment.derivative(t + h / 2.0, &stage, &mut k3);
        ahead(y, h, &k3, &mut stage);
        segment.derivative(t + h, &stage, &mut k4);
        for i in 0..n {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        Ok(())
    })
}

/// stage = y + h k
fn ahead(y: &[f64], h: f64, k: &[f64], stage: &mut [f64]) {
    for i in 0..y.len() {
        stage[i] = y[i] + h * k[i];
    }
}
