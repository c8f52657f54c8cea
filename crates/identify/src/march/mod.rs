//! A plant with friction, marched through the samples of a record, with its sensitivities.
//!
//! M q̈ = T(t, q, q̇) − F − σ₂q̇ − offset, where F is the friction of a model of the list and T all that
//! drives the plant. Between two samples the input is what its hold says, and every step ends at a sample at
//! the latest. A step is Alexander's SDIRK method of order 3 (L-stable, its last stage is the result), in
//! which each stage is one equation for one unknown, the velocity: the friction of a stage follows from it in
//! closed form. So Coulomb friction sticks exactly, Maxwell-slip elements yield exactly, and stiff bristles
//! cost nothing.
//!
//! The steps are taken with plain numbers first and kept ([`Tape`]); sensitivities come from going over the
//! same steps once more with dual numbers, each stage's velocity by the implicit function theorem. They are
//! the derivatives of the computed motion itself, so a fit that uses them does not stall.

mod contact;
mod course;
mod drive;
mod dual;
mod observer;
mod plant;
mod replay;
mod run;
mod stage;
mod tableau;
mod tape;

pub use contact::Contact;
pub(crate) use contact::deflection;
pub use course::errors;
pub use drive::{Drive, Feedback};
pub use dual::{Dual, Real};
pub use observer::{Measured, observe};
pub use plant::{Balance, Model};
pub use replay::{Passage, deviations, passages, replay};
pub use run::{MotionError, Shown, Start, Tolerance, march};
pub use tape::{Motion, Tape};

/// The absolute value, whose derivative at zero is that from the right.
fn size<D: Real>(x: D) -> D {
    if x.re() < 0.0 { -x } else { x }
}
