//! What the solvers do, over their list.

mod collocation;
mod common;
mod corners;
mod deliver;
mod failures;
mod order;
mod radau;
mod versions;
mod work;
