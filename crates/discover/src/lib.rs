//! Where a model and a record of its drive disagree, what the model lacks, and how much of the gap that closes.
//!
//! **Invariant**: knows no files, no plots, no answer keys and not the `twin`.
//!
//! The record is cut into at least 32 blocks of at most 1.5 s, half of them fitted, the others judging. Every block is simulated from its
//! own estimated start, so that neither drift nor phase stands for physics. Against the noise of the sensors and of
//! the recorded input stands what the refitted nominal model leaves; each effect of the library is first scored
//! along its derivative, then refitted in full, and decided on the judging blocks.
//!
//! Read first: [`discover`], the whole way; [`Discovery`], its answer.

mod board;
mod confirm;
mod decide;
mod floor;
mod gram;
mod maps;
mod model;
mod nudge;
mod screen;
mod verdict;
mod walk;
mod wind;
mod wrong;

pub use confirm::{Confirmed, confirm};
pub use maps::Of;
pub use nudge::{Residual, residual};
pub use verdict::{
    Discovery, Found, Gap, Limit, MapOf, Moved, Options, Ranked, Share, Value, Verdict,
};
pub use walk::discover;
