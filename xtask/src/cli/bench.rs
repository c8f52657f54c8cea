//! The flags of `bench`.

use super::{cases, records, seconds};
use clap::{Args, Subcommand, builder::PossibleValuesParser};
use simulation::anchors::PROBLEMS;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, arg_required_else_help = true)]
pub(crate) struct BenchArgs {
    /// What; the anchors if it is not said.
    #[command(subcommand)]
    pub(crate) what: Option<Bench>,
    #[command(flatten)]
    pub(crate) anchors: AnchorsArgs,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Bench {
    /// Time our methods and the libraries on P1 to P6 at equal delivered error.
    Anchors(AnchorsArgs),
    /// Time many rigs at once, on one thread and on several.
    Ensemble(EnsembleArgs),
    /// Try the properties of plants with friction on cases drawn at random.
    Properties(PropertiesArgs),
    /// Fit records of known truth, and count how often the intervals hold it.
    Coverage(CoverageArgs),
    /// Time the fit of LuGre's six parameters to the record of P6.
    Fit(FitBenchArgs),
    /// Hide effects in records, look for them, and count how often they are named rightly.
    ///
    /// Seeds below 100000 are for tuning, those from 1000000 on for scoring. Ends with 1 if an aim is not reached.
    HiddenEffects(HiddenArgs),
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own on the command line")]
pub(crate) struct AnchorsArgs {
    /// The problems; all if none is named.
    #[arg(value_name = "PROBLEM", value_parser = PossibleValuesParser::new(PROBLEMS))]
    pub(crate) problems: Vec<String>,
    /// The rows as JSON, one a line.
    #[arg(long)]
    pub(crate) json: bool,
    /// A folder of references made elsewhere, as P5_0.txt: a line `t quantity …` for each time.
    #[arg(long, value_name = "DIR")]
    pub(crate) refs: Option<PathBuf>,
    /// Build for the processor at hand; so it is if nothing is said.
    #[arg(long, conflicts_with = "portable")]
    pub(crate) native: bool,
    /// Build for any processor of the kind.
    #[arg(long)]
    pub(crate) portable: bool,
    /// Every second tolerance, less work allowed, fewer repeats: half a minute and the build.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Keep the run under this name, for `compare`.
    #[arg(long, value_name = "NAME")]
    pub(crate) save: Option<String>,
    /// Build with a changed library, as diffsol=PATH.
    #[arg(long, value_name = "LIBRARY=PATH")]
    pub(crate) patch: Option<String>,
    /// Run nothing and show a run that was kept: its name or its file.
    #[arg(long, value_name = "RUN", conflicts_with_all = ["problems", "refs", "native", "portable", "quick", "save", "patch"])]
    pub(crate) saved: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct EnsembleArgs {
    /// A table of friction parameters, f_c,f_s,v_s,sigma_0,sigma_1,sigma_2; drawn if not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) parameters: Option<PathBuf>,
    /// How many runs; of a table, its first ones.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) runs: u32,
    /// Threads, beside one.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: u16,
    /// Build for any processor of the kind.
    #[arg(long)]
    pub(crate) portable: bool,
    /// The rows as JSON, one a line.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CoverageArgs {
    /// The friction models; all if none is named.
    #[arg(long, value_name = "MODEL", value_delimiter = ',')]
    pub(crate) models: Vec<String>,
    /// How many records of each model.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = records)]
    pub(crate) records: usize,
    /// The first seed; each record has the next.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// Threads; as many as there are processors if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Keep the table as data/benchmarks/coverage.csv.
    #[arg(long)]
    pub(crate) save: bool,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// How many records the full benchmark of hidden effects has.
pub(crate) const HIDDEN: usize = 950;

/// The first of its seeds: those before it were looked at while the method was made.
pub(crate) const SCORED: u64 = 8_011_218;

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own on the command line")]
pub(crate) struct HiddenArgs {
    /// How many records; with --from its first ones, all if not given, else as many as the README's table has.
    #[arg(long, value_name = "N", value_parser = records)]
    pub(crate) records: Option<usize>,
    /// The first seed; each record has the next. Below 100000 for tuning, from 1000000 on for scoring.
    #[arg(long, value_name = "N", default_value_t = SCORED, value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seed: u64,
    /// How many records at a time; as many as there are processors if not given. Times are told as on a machine of
    /// one's own with 1.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Keep the table as data/benchmarks/hidden-effects.csv, and draw truth against answer beside it, as .svg.
    #[arg(long)]
    pub(crate) save: bool,
    /// Run nothing and tell of the table that is kept; with --save the figure is drawn anew.
    #[arg(long, conflicts_with_all = ["records", "seed", "threads"])]
    pub(crate) kept: bool,
    /// Run the records in this folder, which --write has made, one at a time. What was answered is kept in answers/ in
    /// it and not searched again by the same search, so that a run that was ended goes on where it was.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["seed", "threads", "kept"])]
    pub(crate) from: Option<PathBuf>,
    /// Run nothing and write records with their rig files here, and their truths and keys to truth/ in it.
    #[arg(long, value_name = "DIR", requires = "seeds", conflicts_with_all = ["records", "seed", "threads", "save", "kept", "from", "markdown", "json"])]
    pub(crate) write: Option<PathBuf>,
    /// The seeds of the records to be written.
    #[arg(long, value_name = "N", value_delimiter = ',', requires = "write", value_parser = clap::value_parser!(u64).range(..1 << 62))]
    pub(crate) seeds: Vec<u64>,
    /// How many seconds of each are written.
    #[arg(long, value_name = "SECONDS", requires = "write", default_value_t = 60.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// As a table for the README.
    #[arg(long, conflicts_with = "json")]
    pub(crate) markdown: bool,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FitBenchArgs {
    /// How many times each fit is repeated.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeats: u32,
    /// Build for any processor of the kind.
    #[arg(long)]
    pub(crate) portable: bool,
    /// The rows as JSON, one a line.
    #[arg(long)]
    pub(crate) json: bool,
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
