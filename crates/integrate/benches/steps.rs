//! Time of a step of each family, everything around it included.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use integrate::{Control, Corners, Dynamics, InitialValueProblem, Limits, Order, solve, solver};
use std::hint::black_box;

/// A forced pendulum with damping: cheap to evaluate, so that the method is what is timed.
struct Pendulum;

impl Dynamics for Pendulum {
    fn dimension(&self) -> usize {
        2
    }
    fn derivative(&self, t: f64, y: &[f64], _: Option<usize>, dy: &mut [f64]) {
        dy[0] = y[1];
        dy[1] = t.cos() - y[0].sin() - 0.1 * y[1];
    }
    fn jacobian(&self, _: f64, y: &[f64], _: Option<usize>, jacobian: &mut [f64]) {
        jacobian.copy_from_slice(&[0.0, 1.0, -y[0].cos(), -0.1]);
    }
    fn scale(&self) -> Vec<f64> {
        vec![1.0, 1.0]
    }
}

fn steps(criterion: &mut Criterion) {
    let problem = InitialValueProblem {
        dynamics: &Pendulum,
        start: 0.0,
        end: 100.0,
        y0: vec![1.0, 0.0],
        breakpoints: Vec::new(),
    };
    let mut group = criterion.benchmark_group("steps");
    for name in [
        "rk4",
        "implicit-midpoint",
        "ode_solvers-rk4",
        "dopri5",
        "dop853-autonomous",
        "tsit45",
        "bdf",
        "tr_bdf2",
        "esdirk34",
    ] {
        let Some(solver) = solver(name) else { continue };
        let control = match solver.order {
            Order::Fixed(_) => Control::Step(0.05),
            Order::Adaptive(_) | Order::Variable => Control::Tolerance { rtol: 1e-6 },
        };
        let run = || solve(solver, &problem, &control, Corners::Restart, &Limits::default());
        group.throughput(Throughput::Elements(run().work.accepted));
        group.bench_function(name, |bencher| bencher.iter(|| black_box(run())));
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
