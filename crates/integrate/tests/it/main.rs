//! What the solvers do, over their list.

mod common;
mod order;
mod versions;
