//! The explicit method of Tsitouras of order 5(4) of diffsol.

use super::{Order, Solver};
use crate::libraries::diffsol;

pub(super) const SOLVER: Solver = Solver {
    name: "tsit45",
    library: "diffsol",
    order: Order::Adaptive(5),
    implicit: false,
    defect: None,
    run: diffsol::tsit45,
};
