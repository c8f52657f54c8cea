//! The list of solvers. A new one is a file here and a line in [`SOLVERS`].

mod bdf;
mod dop853;
mod dop853_autonomous;
mod dopri5;
mod esdirk34;
mod explicit_euler;
mod heun;
mod implicit_euler;
mod implicit_midpoint;
mod ode_solvers_rk4;
mod rk4;
mod tr_bdf2;
mod trapezoidal;
mod tsit45;

use crate::{Control, FAULTY, Failure, Recorder, Segment};

/// The order of a method, and with it what controls its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// One-step method with fixed steps: needs [`Control::Step`].
    Fixed(u32),
    /// One-step method that chooses its steps: needs [`Control::Tolerance`].
    Adaptive(u32),
    /// Multistep method that chooses its steps and its order: needs [`Control::Tolerance`].
    Variable,
}

/// One entry of the list.
#[derive(Debug, Clone, Copy)]
pub struct Solver {
    /// Name, as an experiment writes it.
    pub name: &'static str,
    /// Where it comes from: "own", "ode_solvers" or "diffsol".
    pub library: &'static str,
    /// Order of convergence.
    pub order: Order,
    /// Whether a step solves an equation.
    pub implicit: bool,
    /// A known fault of the library, in words; the order test asserts it as it is.
    pub defect: Option<&'static str>,
    /// Integrates one segment: tells the recorder every accepted step, hands on its failures, and
    /// returns at the segment's end. Called through [`crate::solve`].
    pub run: fn(&Segment<'_>, &Control, &mut Recorder<'_>) -> Result<(), Failure>,
}

/// All solvers that are compared.
pub const SOLVERS: &[Solver] = &[
    explicit_euler::SOLVER,
    heun::SOLVER,
    rk4::SOLVER,
    implicit_euler::SOLVER,
    implicit_midpoint::SOLVER,
    trapezoidal::SOLVER,
    ode_solvers_rk4::SOLVER,
    dopri5::SOLVER,
    dop853::SOLVER,
    dop853_autonomous::SOLVER,
    tsit45::SOLVER,
    bdf::SOLVER,
    tr_bdf2::SOLVER,
    esdirk34::SOLVER,
];

/// The named sets of [`set`].
pub const SETS: &[&str] =
    &["@all", "@fixed", "@adaptive", "@explicit", "@implicit", "@own", "@ode_solvers", "@diffsol"];

/// The solver of this name, from [`SOLVERS`] or [`FAULTY`].
pub fn solver(name: &str) -> Option<&'static Solver> {
    SOLVERS.iter().chain(FAULTY).find(|s| s.name == name)
}

/// The solvers of a named set, in the order of the list; none if there is no such set.
pub fn set(name: &str) -> Option<Vec<&'static Solver>> {
    let belongs: fn(&Solver) -> bool = match name {
        "@all" => |_| true,
        "@fixed" => |s| matches!(s.order, Order::Fixed(_)),
        "@adaptive" => |s| !matches!(s.order, Order::Fixed(_)),
        "@explicit" => |s| !s.implicit,
        "@implicit" => |s| s.implicit,
        "@own" => |s| s.library == "own",
        "@ode_solvers" => |s| s.library == "ode_solvers",
        "@diffsol" => |s| s.library == "diffsol",
        _ => return None,
    };
    Some(SOLVERS.iter().filter(|s| belongs(s)).collect())
}

/// Takes a fixed-step method over its grid. `step` gets t, h and the state, which it moves on.
fn march(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
    mut step: impl FnMut(f64, f64, &mut [f64]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let grid = control.grid(segment)?;
    let mut y = segment.y0.clone();
    for k in 0..grid.steps {
        step(grid.time(k), grid.h, &mut y)?;
        recorder.accept(grid.time(k + 1), &y)?;
    }
    Ok(())
}
