//! The commands and their flags.

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
    /// Run what takes long, on request.
    Bench {
        /// What.
        #[command(subcommand)]
        what: Bench,
    },
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

#[derive(Debug, Subcommand)]
pub(crate) enum Bench {
    /// Try the properties of plants with friction on cases drawn at random.
    Properties(PropertiesArgs),
}

#[derive(Debug, Args)]
pub(crate) struct PropertiesArgs {
    /// How many cases of each property.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = cases)]
    pub(crate) cases: usize,
    /// The first seed; each case has the next.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// Threads; as many as there are processors if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
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
