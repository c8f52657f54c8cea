//! One record of the benchmark: what was hidden in it, and what was answered.

use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// A change of nature is visible from so many standard deviations on [σ].
pub(super) const VISIBLE: f64 = 5.0;

/// What is hidden in a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Kind {
    /// Nothing: every parameter is 2 % wrong, as always.
    Nothing,
    /// One free parameter is very wrong.
    Parameter,
    /// One effect of the library.
    Single,
    /// Two effects of the library.
    Pair,
    /// An effect that is in no library.
    Foreign,
}

impl Kind {
    const ALL: [Self; 5] =
        [Self::Nothing, Self::Parameter, Self::Single, Self::Pair, Self::Foreign];

    /// As the table has it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Parameter => "parameter",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Foreign => "foreign",
        }
    }
}

/// An effect as it was named: itself first, then every name it was said not to be told from.
pub(super) type Set = Vec<String>;

/// One record. Of the clock there is nothing in it but `seconds`, which the table does not keep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    pub(super) seed: u64,
    pub(super) family: String,
    pub(super) excitation: String,
    pub(super) noise: String,
    pub(super) friction: String,
    pub(super) kind: Kind,
    /// The names of the hidden effects, or of the wrong parameter.
    pub(super) truth: Vec<String>,
    /// How well each of them can be seen beside all that is free [σ].
    pub(super) seen: Vec<f64>,
    /// The verdict's name, or `error`.
    pub(super) verdict: String,
    /// What was named.
    pub(super) named: Vec<Set>,
    /// The nominal parameters that were called wrong.
    pub(super) moved: Vec<String>,
    /// How much of the excess the first effect takes away [1].
    pub(super) shrink: Option<f64>,
    /// Root mean square over the channels of gap after against floor [1].
    pub(super) gap: Option<f64>,
    /// Relative error of the value of a single effect that was named [1].
    pub(super) error: Option<f64>,
    /// Wall time of the answer alone [s].
    pub(super) seconds: Option<f64>,
}

/// The header of the table that is kept.
const HEADER: &str = "seed,family,excitation,noise,friction,kind,truth,visible_sigma,verdict,names,sets,moved,\
                      shrink,gap_ratio,value_error";

impl Row {
    /// Whether all that is hidden is visible.
    pub(super) fn visible(&self) -> bool {
        self.seen.iter().all(|sigmas| *sigmas >= VISIBLE)
    }

    /// Whether names were given to what is missing.
    pub(super) fn names(&self) -> bool {
        !self.named.is_empty()
    }

    /// Itself as a line of the table that is kept: parts of a list are parted by `+`, names of a set by `|`.
    fn line(&self) -> String {
        let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.3e}"));
        let sets: Vec<String> = self.named.iter().map(|set| set.join("|")).collect();
        let first: Vec<&str> =
            self.named.iter().filter_map(|s| s.first()).map(String::as_str).collect();
        let seen: Vec<String> = self.seen.iter().map(|v| format!("{v:.3e}")).collect();
        [
            self.seed.to_string(),
            self.family.clone(),
            self.excitation.clone(),
            self.noise.clone(),
            self.friction.clone(),
            self.kind.name().to_owned(),
            self.truth.join("+"),
            seen.join("+"),
            self.verdict.clone(),
            first.join("+"),
            sets.join("+"),
            self.moved.join("+"),
            number(self.shrink),
            number(self.gap),
            number(self.error),
        ]
        .join(",")
    }

    /// The row of such a line.
    fn parse(line: &str) -> Result<Self, String> {
        let cells: Vec<&str> = line.split(',').collect();
        let expected = HEADER.split(',').count();
        if cells.len() != expected {
            return Err(format!("{} cells, expected {expected}", cells.len()));
        }
        let list = |cell: &str| -> Vec<String> {
            cell.split('+').filter(|part| !part.is_empty()).map(str::to_owned).collect()
        };
        let number = |cell: &str| -> Result<Option<f64>, String> {
            let parsed = |_| format!("`{cell}`, expected a number");
            if cell.is_empty() { Ok(None) } else { cell.parse().map(Some).map_err(parsed) }
        };
        let kind = Kind::ALL.into_iter().find(|kind| kind.name() == cells[5]);
        let known = Kind::ALL.map(Kind::name).join(", ");
        let seen: Result<Vec<Option<f64>>, String> =
            list(cells[7]).iter().map(|cell| number(cell)).collect();
        Ok(Self {
            seed: cells[0].parse().map_err(|_| format!("`{}`, expected a seed", cells[0]))?,
            family: cells[1].to_owned(),
            excitation: cells[2].to_owned(),
            noise: cells[3].to_owned(),
            friction: cells[4].to_owned(),
            kind: kind.ok_or_else(|| format!("`{}`, expected one of {known}", cells[5]))?,
            truth: list(cells[6]),
            seen: seen?.into_iter().flatten().collect(),
            verdict: cells[8].to_owned(),
            named: list(cells[10])
                .iter()
                .map(|set| set.split('|').map(str::to_owned).collect())
                .collect(),
            moved: list(cells[11]),
            shrink: number(cells[12])?,
            gap: number(cells[13])?,
            error: number(cells[14])?,
            seconds: None,
        })
    }
}

/// The table that is kept: the command, the header, a line for each record. Times are not in it.
pub(super) fn csv(rows: &[Row], command: &str) -> String {
    let mut text = format!("# {command}\n{HEADER}\n");
    for row in rows {
        let _ = writeln!(text, "{}", row.line());
    }
    text
}

/// The rows of such a table.
pub(super) fn parse(text: &str) -> Result<Vec<Row>, String> {
    let numbered = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#'));
    let mut rows = Vec::new();
    for (n, line) in numbered {
        if line == HEADER {
            continue;
        }
        rows.push(Row::parse(line).map_err(|why| format!("line {}: {why}", n + 1))?);
    }
    Ok(rows)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    fn strings(list: &[&str]) -> Vec<String> {
        list.iter().map(|&s| s.to_owned()).collect()
    }

    /// A row by hand: what is hidden, what is said of it, and the named sets.
    pub(in super::super) fn row(
        kind: Kind,
        truth: &[&str],
        verdict: &str,
        named: &[&[&str]],
    ) -> Row {
        Row {
            seed: 7,
            family: "pendulum".to_owned(),
            excitation: "sine".to_owned(),
            noise: "low".to_owned(),
            friction: "lu_gre".to_owned(),
            kind,
            truth: strings(truth),
            seen: truth.iter().map(|_| 40.0).collect(),
            verdict: verdict.to_owned(),
            named: named.iter().map(|set| strings(set)).collect(),
            moved: vec![],
            shrink: None,
            gap: None,
            error: None,
            seconds: None,
        }
    }

    #[test]
    fn a_row_is_read_as_it_was_written_but_for_the_clock() {
        let mut one = row(
            Kind::Pair,
            &["cogging", "tach_bias"],
            "effect",
            &[&["cogging", "gravity_unbalance"], &["tach_bias"]],
        );
        (one.shrink, one.gap, one.error) = (Some(0.5), Some(1.015), Some(0.002));
        one.moved = strings(&["f_c", "k[2]"]);
        let text = csv(&[one.clone()], "cargo xtask bench hidden-effects --seed 1");
        assert!(text.starts_with("# cargo xtask bench hidden-effects --seed 1\nseed,"), "{text}");
        assert_eq!(parse(&text), Ok(vec![one.clone()]), "{text}");
        one.seconds = Some(3.0);
        assert_eq!(csv(&[one], "cargo xtask bench hidden-effects --seed 1"), text, "no clock");
        let other = "1,2\n";
        assert_eq!(parse(other), Err("line 1: 2 cells, expected 15".to_owned()));
    }
}
