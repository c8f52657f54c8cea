//! What the section says first: who gets there, who is cheap, who says solved and is not, and whose they are.

use super::{Problem, Silence, cheapest};
use crate::chapter::Chapter;
use crate::number;
use crate::select::{by_solver, distinct, is_ours};

/// The findings, computed from the tables.
pub(super) fn findings(problems: &[Problem], solvers: &[&str]) -> String {
    let runs: usize = problems.iter().map(|problem| problem.cases.len()).sum();
    let mut text = format!(
        "{} solvers ran {} times on {} (a study at one point of its sweep).",
        solvers.len(),
        number::count(u64::try_from(runs).unwrap_or(u64::MAX)),
        match problems.len() {
            1 => "1 problem".to_owned(),
            n => format!("{n} problems"),
        }
    );
    reliable(&mut text, problems, solvers);
    cheap(&mut text, problems);
    silent(&mut text, problems, solvers);
    text
}

/// Who delivers 10⁻³ on most problems, and who on the fewest, of those they were run on.
fn reliable(text: &mut String, problems: &[Problem], solvers: &[&str]) {
    let reached = |solver: &&str| {
        let run = problems.iter().filter(|p| p.of(solver).next().is_some());
        let n = run.clone().filter(|p| cheapest(p.of(solver), 1e-3).is_some()).count();
        (n, run.count())
    };
    // A method of ours is run only where it holds, and told apart.
    let given = |solver: &&&str| problems.iter().flat_map(|p| p.of(solver)).any(|c| !is_ours(c));
    let solvers: Vec<&str> = solvers.iter().filter(given).copied().collect();
    let counts: Vec<(usize, usize)> = solvers.iter().map(reached).collect();
    let most = counts.iter().map(|(n, _)| *n).max().unwrap_or(0);
    let least = counts.iter().map(|(n, _)| *n).min().unwrap_or(0);
    if most == 0 {
        text.push_str(" An error of 10⁻³ is delivered by nobody.");
        return;
    }
    let with = |wanted: usize| {
        let named = solvers.iter().zip(&counts).filter(|(_, (n, _))| *n == wanted);
        named.map(|(name, (n, of))| format!("{name} ({n} of {of})")).collect::<Vec<_>>()
    };
    let told = |names: &[String]| joined(names.iter().map(String::as_str).collect());
    put!(text, " An error of 10⁻³ is delivered on most problems by {}", told(&with(most)));
    if least < most {
        put!(text, ", on the fewest by {}", told(&with(least)));
    }
    text.push_str(", of those each was run on.");
}

/// Who is cheapest most often at 10⁻⁶.
fn cheap(text: &mut String, problems: &[Problem]) {
    let winners = problems.iter().filter_map(|problem| cheapest(problem.of_solvers(), 1e-6));
    let wins = by_solver(winners);
    let reached: usize = wins.iter().map(|(_, cases)| cases.len()).sum();
    let most = wins.iter().map(|(_, cases)| cases.len()).max().unwrap_or(0);
    if most == 0 {
        text.push_str(" At 10⁻⁶ nobody arrives.");
        return;
    }
    let names = wins.iter().filter(|(_, cases)| cases.len() == most).map(|(name, _)| *name);
    put!(
        text,
        " At 10⁻⁶ the cheapest of them is most often {}, on {most} of the {reached} problems that anybody brings there.",
        joined(names.collect())
    );
}

/// Who has gross silent failures and how many, and who none.
fn silent(text: &mut String, problems: &[Problem], solvers: &[&str]) {
    let gross = |solver: &&str| {
        let own = |p: &Problem| {
            p.of(solver).filter(|case| p.silence(case) == Some(Silence::Gross)).count()
        };
        problems.iter().map(own).sum::<usize>()
    };
    let counts: Vec<(&str, usize)> = solvers.iter().map(|name| (*name, gross(name))).collect();
    let (mut some, none): (Vec<_>, Vec<_>) = counts.into_iter().partition(|(_, n)| *n > 0);
    let total: usize = some.iter().map(|(_, n)| n).sum();
    text.push_str(
        " A run that said solved and whose largest error is above 0.1 is a *gross silent failure*:",
    );
    if total == 0 {
        text.push_str(" there is none.");
        return;
    }
    some.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    let told = some.iter().map(|(name, n)| format!("{name} {n}")).collect::<Vec<_>>();
    let total = number::count(u64::try_from(total).unwrap_or(u64::MAX));
    put!(text, " there are {total} ({}).", told.join(", "));
    if none.is_empty() {
        text.push_str(" No solver is without.");
    } else {
        let names = none.into_iter().map(|(name, _)| name).collect();
        put!(text, " Without any: {}.", joined(names));
    }
}

/// What an error, a cost and a corner are, and which library each solver is from.
pub(super) fn terms(chapters: &[Chapter], problems: &[Problem]) -> String {
    let mut text = "Errors are the largest of a run, relative to the largest response; \
                    costs are evaluations of the right-hand side. \
                    *Corners* are the instants at which the motion turns and the right-hand side has a kink: \
                    a run is restarted there, or ignores them."
        .to_owned();
    let cases = problems.iter().flat_map(|problem| problem.cases.iter().copied());
    let mut from: Vec<String> = Vec::new();
    for library in distinct(cases.clone().map(|case| case.library.as_str())) {
        let own = by_solver(cases.clone().filter(|case| case.library == library));
        let names = joined(own.into_iter().map(|(name, _)| name).collect());
        let key = format!("version {library}");
        let version = chapters.iter().map(|c| c.summary.about(&key)).find(|v| !v.is_empty());
        from.push(match (library, version) {
            ("", _) => format!("of a library that is not told: {names}"),
            ("own", _) => format!("our own: {names}"),
            (library, Some(version)) => format!("from {library} {version}: {names}"),
            (library, None) => format!("from {library}: {names}"),
        });
    }
    put!(text, " The solvers are {}.", from.join("; "));
    if cases.clone().any(|case| case.solver == "dop853-autonomous") {
        text.push_str(" dop853-autonomous is dop853 with the time as one more state.");
    }
    text
}

/// `a, b and c`.
pub(super) fn joined(mut names: Vec<&str>) -> String {
    let last = names.pop().unwrap_or_default();
    if names.is_empty() { last.to_owned() } else { format!("{} and {last}", names.join(", ")) }
}
