//! A record of the benchmark, made, given to the analyst, and answered.
//!
//! The analyst gets the rig's text and the record; the key goes past it to the row.

use super::{
    row::{Kind, Row},
    value,
};
use crate::exit::{Exit, Failure};
use anyhow::anyhow;
use discover::{Discovery, Options, Verdict, discover};
use identify::{Recording, Rig, fit::Data};
use std::time::Instant;
use twin::bench::{Case, Hides};

/// All that an analyst is given.
#[derive(Debug)]
pub(super) struct Given {
    pub(super) rig: Rig,
    pub(super) data: Data,
    /// How long the record is, in records of 60 s at 200 Hz [1].
    pub(super) length: f64,
}

impl Given {
    /// From the rig file's text and the record's columns.
    pub(super) fn new<'a>(
        rig: &str,
        columns: &dyn Fn(&str) -> Option<&'a [f64]>,
    ) -> Result<Self, Failure> {
        let bug = |why: String| Failure { exit: Exit::Bug, error: anyhow!(why) };
        let rig = Rig::parse(rig).map_err(|e| bug(e.to_string()))?;
        let column = |name: &str| columns(name).ok_or_else(|| format!("no column {name}"));
        let recording = Recording::new(&rig, &column).map_err(|e| bug(e.to_string()))?;
        let data = Data::of(&rig, &recording);
        let length = data.input.len() as f64 / (twin::bench::DURATION * twin::bench::RATE);
        Ok(Self { rig, data, length })
    }

    /// The answer, and the wall time it took, scaled to 60 s at 200 Hz [s].
    #[expect(clippy::disallowed_methods, reason = "the time of an answer is what is asked for")]
    fn answered(&self) -> (Option<Discovery>, f64) {
        let begun = Instant::now();
        let answer = discover(&self.rig, &self.data, &Options::default()).ok();
        (answer, begun.elapsed().as_secs_f64() / self.length)
    }
}

/// The row of a seed.
pub(super) fn run(seed: u64) -> Result<Row, Failure> {
    let case = twin::bench::case(seed)?;
    let made = twin::make(&case.scenario, case.seed)?;
    let column = |name: &str| {
        made.columns.iter().find(|(known, _)| known == name).map(|(_, values)| values.as_slice())
    };
    let given = Given::new(&case.rig, &column)?;
    judged(&case, &given, case.seen()?)
}

/// What is answered to a record, beside its key and how well each of what is hidden can be seen.
pub(super) fn judged(case: &Case, given: &Given, seen: Vec<f64>) -> Result<Row, Failure> {
    let (answer, seconds) = given.answered();
    let (kind, truth) = hidden(case);
    let mut row = Row {
        seed: case.seed,
        family: word(&case.recipe.family)?,
        excitation: word(&case.recipe.excitation)?,
        noise: word(&case.recipe.noise)?,
        friction: word(&case.recipe.friction)?,
        kind,
        truth,
        seen,
        verdict: "error".to_owned(),
        named: vec![],
        moved: vec![],
        shrink: None,
        gap: None,
        error: None,
        seconds: Some(seconds),
    };
    if let Some(answer) = answer {
        told(&mut row, &answer);
        if kind == Kind::Single {
            row.error = value::error(&case.scenario, &answer);
        }
    }
    Ok(row)
}

fn told(row: &mut Row, answer: &Discovery) {
    answer.verdict.name().clone_into(&mut row.verdict);
    // Under the other verdicts nothing is named, whatever was tried.
    let naming = matches!(answer.verdict, Verdict::Effect | Verdict::Partial);
    row.named = answer
        .effects
        .iter()
        .filter(|_| naming)
        .map(|found| {
            // Itself stands first, whatever the order of its set.
            let others = found.set.iter().filter(|name| **name != found.name);
            [found.name].iter().chain(others).map(|&name| name.to_owned()).collect()
        })
        .collect();
    let moved = answer.parameters.iter().filter(|p| p.moved);
    row.moved = moved.map(|p| p.found.name.clone()).collect();
    row.shrink = answer.effects.first().map(|found| found.shrink);
    let squares: Vec<f64> = answer.gap.iter().map(|g| (g.after / g.floor).powi(2)).collect();
    row.gap = (!squares.is_empty())
        .then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        .filter(|ratio| ratio.is_finite());
}

/// The kind of a case, and the names in its key.
fn hidden(case: &Case) -> (Kind, Vec<String>) {
    match &case.recipe.hides {
        Hides::Nothing => (Kind::Nothing, vec![]),
        Hides::Parameter => {
            (Kind::Parameter, case.key.parameter.iter().map(|p| p.name.clone()).collect())
        }
        Hides::Effects(names) => {
            let kind = match &case.key.effects[..] {
                effects if effects.iter().any(twin::HiddenEffect::foreign) => Kind::Foreign,
                [_] => Kind::Single,
                _ => Kind::Pair,
            };
            (kind, names.clone())
        }
    }
}

/// A word of the recipe as files have it.
fn word(value: &impl serde::Serialize) -> Result<String, Failure> {
    let bug = |why: String| Failure { exit: Exit::Bug, error: anyhow!(why) };
    let value = serde_json::to_value(value).map_err(|e| bug(e.to_string()))?;
    value.as_str().map(str::to_owned).ok_or_else(|| bug(format!("{value}: expected a word")))
}
