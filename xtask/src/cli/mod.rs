//! The commands and their flags.

mod bench;

pub(crate) use bench::*;

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Duhem: the paper's experiments, reproduced.
///
/// Exit codes: 0 done; 1 a check failed; 2 usage; 3 regression; 4 bad input; 5 interrupted, everything
/// resumable; 6 disk or environment; 70 a bug in the project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, disable_help_subcommand = true)]
pub(crate) struct Cli {
    /// The project's folder; found from the current one if not given.
    #[arg(long, global = true, value_name = "DIR")]
    pub(crate) root: Option<PathBuf>,
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run the experiments, write reports/ and print the claims.
    Reproduce(ReproduceArgs),
    /// List the experiments.
    List {
        /// As JSON.
        #[arg(long)]
        json: bool,
    },
    /// Show one experiment, resolved.
    Show {
        /// The experiment.
        name: String,
        /// As JSON.
        #[arg(long)]
        json: bool,
    },
    /// Print the committed ledger of claims and measures.
    Claims {
        /// As JSON.
        #[arg(long)]
        json: bool,
        /// As the table in the README.
        #[arg(long, conflicts_with = "json")]
        markdown: bool,
    },
    /// Say what is wrong with a record of a drive, and what it cannot tell.
    ///
    /// Ends with 1 if there are problems; notes are none. The record is CSV, Parquet or MATLAB 5.
    CheckData(CheckDataArgs),
    /// Fit the free parameters of a rig file to a record of its drive, with intervals and rival models.
    Fit(FitArgs),
    /// Run a rig's model on a record's inputs, beside the record.
    Simulate(SimulateArgs),
    /// Find where a rig's model and a record of its drive disagree, and name what the model lacks.
    ///
    /// Ends with 0 whatever the verdict is.
    Discover(DiscoverArgs),
    /// Print the library of effects that a model can lack, with their equations and parameters.
    Effects {
        /// As JSON.
        #[arg(long)]
        json: bool,
        /// As the table in the README.
        #[arg(long, conflicts_with = "json")]
        markdown: bool,
    },
    /// Time the methods on the anchors, or run what else takes long.
    Bench(BenchArgs),
    /// Compare two saved runs of the benchmark.
    ///
    /// Work is compared exactly, row for row. Ends with 3 if there is more of it, or if a row that was right
    /// is not any more, provided both runs are of one processor and one kind of build.
    Compare(CompareArgs),
    /// Make a synthetic record of a rig, with its card, and its truth kept apart.
    Record(RecordArgs),
    /// Start something new.
    New {
        /// What.
        #[command(subcommand)]
        what: New,
    },
    /// Check the house rules.
    Tidy {
        /// As JSON.
        #[arg(long)]
        json: bool,
        /// Print the index of equations for the README and check nothing.
        #[arg(long, conflicts_with = "json")]
        equations: bool,
    },
}

#[derive(Debug, Args)]
pub(crate) struct CheckDataArgs {
    /// The record.
    pub(crate) record: PathBuf,
    /// The rig file that says which column is what; without, each column is examined for itself.
    #[arg(long, value_name = "RIG")]
    pub(crate) rig: Option<PathBuf>,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// How a fit is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FitMethod {
    /// On simulated motions.
    Simulation,
    /// On the filtered position's differences, by linear least squares.
    Regression,
}

#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    /// The record: CSV, Parquet or MATLAB 5.
    pub(crate) record: PathBuf,
    /// The rig file: plant, friction, what is free, which column is what.
    #[arg(long, value_name = "RIG")]
    pub(crate) rig: PathBuf,
    /// How.
    #[arg(long, value_enum, default_value_t = FitMethod::Simulation)]
    pub(crate) method: FitMethod,
    /// A record that is not fitted, to judge by.
    #[arg(long, value_name = "RECORD")]
    pub(crate) holdout: Option<PathBuf>,
    /// Where the model goes: model.toml, model.h, fit.json, simulated.csv.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Simulate in windows of so many seconds; found from the record if not given.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) window: Option<f64>,
    /// Starts beside the nominal one.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u8).range(..=100))]
    pub(crate) starts: u8,
    /// Seed of starts and bootstrap.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// No profile intervals and no rival models.
    #[arg(long)]
    pub(crate) quick: bool,
    /// A friction for each direction, by regression.
    #[arg(long)]
    pub(crate) by_direction: bool,
    /// Threads; as many as there are processors if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// The record: CSV, Parquet or MATLAB 5.
    pub(crate) record: PathBuf,
    /// The rig file.
    #[arg(long, value_name = "RIG")]
    pub(crate) rig: PathBuf,
    /// In windows of so many seconds, each from its own start; in one run if not given.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) window: Option<f64>,
    /// Where simulated.csv goes.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DiscoverArgs {
    /// The record: CSV, Parquet or MATLAB 5.
    pub(crate) record: PathBuf,
    /// The rig file: plant, friction, what is free, which column is what.
    #[arg(long, value_name = "RIG")]
    pub(crate) rig: PathBuf,
    /// A record that is not used otherwise, on which the model with the effect is run.
    #[arg(long, value_name = "RECORD")]
    pub(crate) holdout: Option<PathBuf>,
    /// Where the model with the effect, the answer and its page go: model.toml, answer.json, page.html.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Seed of the perturbations that make the floor.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The run before: its name or its file.
    pub(crate) a: String,
    /// The run after.
    pub(crate) b: String,
    /// Compare times too; end with 3 if one is slower beyond doubt.
    #[arg(long)]
    pub(crate) times: bool,
    /// As a table for a pull request.
    #[arg(long)]
    pub(crate) markdown: bool,
    /// As JSON.
    #[arg(long, conflicts_with = "markdown")]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct RecordArgs {
    /// A scenario that has a name.
    #[arg(conflicts_with = "scenario")]
    pub(crate) name: Option<String>,
    /// A scenario in a TOML file.
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// The record, as .parquet or .csv; its card goes beside it, as .toml.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// What it was made from; truth/ beside the record if not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) truth: Option<PathBuf>,
    /// Seed of the noise and of random drives.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// List the scenarios that have a name.
    #[arg(long, conflicts_with_all = ["name", "scenario", "out", "truth"])]
    pub(crate) list: bool,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

fn records(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (1..=1_000_000).contains(&n) => Ok(n),
        _ => Err("expected a number of records, from 1 to 1000000".to_owned()),
    }
}

fn cases(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (1..=10_000_000).contains(&n) => Ok(n),
        _ => Err("expected a number of cases, from 1 to 10000000".to_owned()),
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum New {
    /// An experiment that runs, to be filled.
    Experiment {
        /// Its name: lower case letters, digits and dashes.
        name: String,
    },
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own on the command line")]
pub(crate) struct ReproduceArgs {
    /// The experiments; all if none is named.
    pub(crate) names: Vec<String>,
    /// Only the first two steps and tolerances of every study, written beside the record store.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Run everything afresh, write nothing; fail if anything committed would change.
    #[arg(long, conflicts_with = "quick")]
    pub(crate) check: bool,
    /// Ignore the records of earlier runs.
    #[arg(long)]
    pub(crate) fresh: bool,
    /// Say for each case why it ran or was reused.
    #[arg(long)]
    pub(crate) explain: bool,
    /// Cases at once; as many as there are processors if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Where finished cases are kept; target/duhem/records if not given.
    #[arg(long, value_name = "DIR")]
    pub(crate) store: Option<PathBuf>,
    /// Seconds after which a case that never calls back is given up.
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0, value_parser = seconds)]
    pub(crate) watchdog: f64,
    /// Print the claims as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(s) if s > 0.0 && s <= 86_400.0 => Ok(s),
        _ => Err("expected seconds, above 0 and at most 86400".to_owned()),
    }
}
