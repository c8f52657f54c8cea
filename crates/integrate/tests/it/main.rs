//! What the solvers do, over their list.

mod common;
mod corners;
mod failures;
mod order;
mod radau;
mod versions;
mod work;
