//! The trapezoidal rule followed by BDF2 of diffsol.

use super::{Order, Solver};
use crate::libraries::diffsol;

pub(super) const SOLVER: Solver = Solver {
    name: "tr_bdf2",
    library: "diffsol",
    order: Order::Adaptive(2),
    implicit: true,
    defect: None,
    run: diffsol::tr_bdf2,
};
