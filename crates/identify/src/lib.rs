//! A record of a real drive and the model of its rig: the fit, and what the record cannot tell.
//!
//! **Invariant**: knows no files, no plots, no answer keys and not the `twin`; a rig file comes as text, a
//! record as columns of numbers.
//!
//! Read first: [`Rig`], the plant, its friction and which column of a record is what; [`Recording`], the
//! columns as channels in SI units.

pub mod doctor;
pub mod effects;
pub mod export;
pub mod fit;
pub mod known;
pub mod march;
mod recording;
pub mod regression;
pub mod rig;

pub use recording::{Columns, Recording, RecordingError};
pub use rig::{Channel, Controller, Effect, Friction, Hold, Rig, RigError, Shaft};

/// Runs `job` on `threads` threads, or on as many as there are processors. The answer is the same.
pub fn on_threads<T: Send>(threads: Option<usize>, job: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build() {
        Ok(pool) => pool.install(job),
        // Without a pool of its own it runs on the common one.
        Err(_) => job(),
    }
}
