//! `cargo xtask`: the only program, and the only place that prints.

mod bench;
mod check_data;
mod claims;
mod cli;
mod compare;
mod discover;
mod effects;
mod exit;
mod fit;
mod list;
mod new;
mod output;
mod progress;
mod recorded;
mod reproduce;
mod root;
mod saved;
mod screen;
mod synthetic;
mod tidy;

use clap::Parser;
use cli::{Cli, Command};
use exit::{Exit, Failure};
use std::{panic, process::ExitCode};

fn main() -> ExitCode {
    quiet_panics_of_solvers();
    let cli = Cli::parse();
    let code = match panic::catch_unwind(|| run(&cli)) {
        Ok(Ok(Exit::Done)) if output::lost() => Exit::Environment,
        Ok(Ok(exit)) => exit,
        Ok(Err(failure)) => {
            output::error(&format!("{:#}", failure.error));
            failure.exit
        }
        // The hook has said what and where.
        Err(_) => Exit::Bug,
    };
    ExitCode::from(code as u8)
}

fn run(cli: &Cli) -> Result<Exit, Failure> {
    let root = root::find(cli.root.as_deref())?;
    match &cli.command {
        Command::Reproduce(arguments) => reproduce::reproduce(&root, arguments),
        Command::List { json } => list::list(&root, *json),
        Command::Show { name, json } => list::show(&root, name, *json),
        Command::Claims { markdown: true, .. } => claims::markdown(&root),
        Command::Claims { json, .. } => claims::claims(&root, *json),
        Command::Effects { json, markdown } => Ok(effects::effects(*json, *markdown)),
        Command::CheckData(arguments) => check_data::check_data(arguments),
        Command::Bench(arguments) => bench::bench(&root, arguments),
        Command::Fit(arguments) => fit::fit(arguments),
        Command::Simulate(arguments) => fit::simulate(arguments),
        Command::Discover(arguments) => discover::discover(arguments),
        Command::Compare(arguments) => compare::compare(&root, arguments),
        Command::Record(arguments) => synthetic::record(&root, arguments),
        Command::New { what } => new::new(&root, what),
        Command::Tidy { equations: true, .. } => tidy::equations(&root),
        Command::Tidy { json, .. } => tidy::tidy(&root, *json),
    }
}

/// A solver that panics is a result; the case tells of it, and standard error need not.
fn quiet_panics_of_solvers() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !integrate::solving() {
            usual(info);
        }
    }));
}
