//! `cargo xtask bench`: what takes long and is run on request only.

mod anchors;
mod built;
mod coverage;
mod ensemble;
mod fit;
mod hidden;
mod machine;
mod patch;
mod properties;
mod table;

use crate::{
    cli::{Bench, BenchArgs},
    exit::{Exit, Failure},
};
use std::path::Path;

/// Runs what was asked for; the anchors if nothing is named.
pub(crate) fn bench(root: &Path, arguments: &BenchArgs) -> Result<Exit, Failure> {
    match &arguments.what {
        Some(Bench::Properties(arguments)) => Ok(properties::run(arguments)),
        Some(Bench::Ensemble(arguments)) => ensemble::run(root, arguments),
        Some(Bench::Anchors(arguments)) => anchors::run(root, arguments),
        Some(Bench::Coverage(arguments)) => coverage::run(root, arguments),
        Some(Bench::Fit(arguments)) => fit::run(root, arguments),
        Some(Bench::HiddenEffects(arguments)) => hidden::run(root, arguments),
        None => anchors::run(root, &arguments.anchors),
    }
}
