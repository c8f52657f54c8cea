//! A friction model under an input, as an initial-value problem a solver can take: under an imposed
//! motion, or in a plant that a force drives.
//!
//! **Invariant**: knows no files and no plots; the models are `duhem`'s, the solvers `integrate`'s, and
//! here they meet for the first time.
//!
//! Read first: [`Motion`], what a solver is run on and judged in; [`PrescribedMotion`] and
//! [`DrivenPlant`], the two of them; [`Path`], a plant's motion once solved. Then [`PlantReference`], by which
//! the solvers of a plant are judged, and [`anchors`], the problems on which all methods are timed.

pub mod adaptive;
pub mod anchors;
pub mod displacement;
mod driven;
pub mod energy;
mod ensemble;
mod error;
pub mod exact;
mod methods;
mod motion;
mod path;
pub mod plant_reference;
mod prescribed;
pub mod properties;
mod task;

pub use driven::DrivenPlant;
pub use energy::Energy;
pub use ensemble::{Ensemble, best};
pub use error::SimulationError;
pub use methods::{Delivered, Method, NotHere, Own, Solves, method, methods};
pub use motion::Motion;
pub use path::Path;
pub use plant_reference::{PLANT_REFERENCES, PlantReference, PlantReferenceEntry};
pub use prescribed::PrescribedMotion;
pub use task::Task;
