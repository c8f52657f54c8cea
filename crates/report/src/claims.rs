//! The claims: which part of the front each stands in, how they are counted, what is told of one.

use crate::chapter::Chapter;
use crate::number;
use record::ClaimRow;

/// The part of the front that a claim stands in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The paper says it, and it does not hold.
    Contradicted,
    /// The paper says it, and what is printed does not decide it, or not by a number.
    Undecided,
    /// The paper says it, and it holds.
    Reproduced,
    /// We say it: a statement that is measured besides those of the paper.
    Ours,
}

impl Part {
    /// The part of this claim: by whose it is, then by its verdict alone.
    pub(crate) fn of(claim: &ClaimRow) -> Self {
        match claim.verdict.as_str() {
            _ if is_ours(claim) => Self::Ours,
            "reproduced" => Self::Reproduced,
            "contradicted" => Self::Contradicted,
            _ => Self::Undecided,
        }
    }
}

/// Whether a statement is our own: its place says so with its first word.
fn is_ours(claim: &ClaimRow) -> bool {
    let rest = claim.place.trim_start().strip_prefix("ours");
    rest.is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// The claims of one part with their chapters, in the chapters' order.
pub(crate) fn of_part<'a, 'b>(
    chapters: &'b [Chapter<'a>],
    part: Part,
) -> Vec<(&'b Chapter<'a>, &'a ClaimRow)> {
    let of = |chapter: &'b Chapter<'a>| {
        chapter.claims_of(part).into_iter().map(move |claim| (chapter, claim))
    };
    chapters.iter().flat_map(of).collect()
}

/// Whether the claims that hold are so few that a front can show a line of each.
pub(crate) fn few_held(chapters: &[Chapter]) -> bool {
    of_part(chapters, Part::Reproduced).len() <= 30
}

/// The heading of the claims that are contradicted.
pub(crate) const OPEN: &str = "What does not hold";
/// The heading of the claims that are reproduced.
pub(crate) const HELD: &str = "What holds";

const VERDICTS: [&str; 4] = ["reproduced", "contradicted", "under-specified", "qualitative"];

/// The verdicts of these claims, counted; `are` stands behind the first number.
fn verdicts(claims: &[&ClaimRow], are: bool) -> String {
    let count = |kind: &str| claims.iter().filter(|claim| claim.verdict == kind).count();
    let mut counts: Vec<(usize, &str)> = VERDICTS.iter().map(|kind| (count(kind), *kind)).collect();
    let known: usize = counts.iter().map(|(n, _)| n).sum();
    counts.push((claims.len() - known, "judged otherwise"));
    counts.retain(|(n, _)| *n > 0);
    let told = |(i, (n, kind)): (usize, &(usize, &str))| match (are && i == 0, n) {
        (true, 1) => format!("1 is {kind}"),
        (true, n) => format!("{n} are {kind}"),
        (false, n) => format!("{n} {kind}"),
    };
    let mut told: Vec<String> = counts.iter().enumerate().map(told).collect();
    let last = told.pop().unwrap_or_default();
    if told.is_empty() { last } else { format!("{} and {last}", told.join(", ")) }
}

/// What the front says first: how many claims the paper makes, and what became of them.
pub(crate) fn tally(claims: &[&ClaimRow]) -> String {
    let of_paper = |claim: &&ClaimRow| Part::of(claim) != Part::Ours;
    let paper: Vec<&ClaimRow> = claims.iter().copied().filter(of_paper).collect();
    let ours = claims.len() - paper.len();
    let first = match paper.len() {
        0 => "No claim of the paper is tested here.".to_owned(),
        1 => format!("Of 1 claim of the paper, {}.", verdicts(&paper, true)),
        n => format!("Of {n} claims of the paper, {}.", verdicts(&paper, true)),
    };
    match ours {
        0 => first,
        1 => format!("{first} 1 statement of our own is measured besides."),
        n => format!("{first} {n} statements of our own are measured besides."),
    }
}

/// The line before the claims that are not decided: their verdicts, counted.
pub(crate) fn undecided(claims: &[(&Chapter, &ClaimRow)]) -> String {
    verdicts(&claims.iter().map(|(_, claim)| *claim).collect::<Vec<_>>(), false)
}

/// A verdict's sign, told apart without colour.
pub(crate) fn sign(verdict: &str) -> &'static str {
    match verdict {
        "reproduced" => "✓",
        "contradicted" => "✗",
        "under-specified" => "?",
        "qualitative" => "≈",
        _ => "·",
    }
}

/// Our number against a printed one, with four digits.
pub(crate) fn ours(claim: &ClaimRow) -> String {
    match (claim.printed, claim.ours) {
        (Some(_), Some(value)) => number::four_digits(value, &claim.unit),
        _ => number::NONE.to_owned(),
    }
}

/// A number with its unit and the printed one before it, as the line of a claim that holds ends; often nothing.
pub(crate) fn in_short(claim: &ClaimRow) -> String {
    match (claim.printed, claim.ours) {
        (Some(_), Some(_)) => {
            let printed = number::printed(claim.printed, claim.digits, &claim.unit);
            format!("printed {printed}, ours {}", ours(claim))
        }
        _ => String::new(),
    }
}

/// How a claim was decided, and the number that was found, with its error.
pub(crate) fn decided(claim: &ClaimRow) -> Option<String> {
    let number = claim.ours.map(|value| number::with_error(value, claim.error, &claim.unit));
    let parts = [Some(claim.how.clone()), number].into_iter().flatten();
    let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
    (!parts.is_empty()).then(|| format!("Decided by: {}", parts.join("; found: ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(verdict: &str, place: &str) -> ClaimRow {
        ClaimRow { verdict: verdict.to_owned(), place: place.to_owned(), ..ClaimRow::default() }
    }

    #[test]
    fn the_front_counts_verdicts_and_our_own_statements_are_none_of_the_paper() {
        let claims = [
            claim("reproduced", "p. 97"),
            claim("contradicted", "p. 97"),
            claim("contradicted", "oursins, p. 3"),
            claim("qualitative", "p. 97"),
            claim("under-specified", "p. 97"),
            claim("reproduced", "ours; equation 24"),
            claim("contradicted", " ours"),
        ];
        let all: Vec<&ClaimRow> = claims.iter().collect();
        assert_eq!(
            tally(&all),
            "Of 5 claims of the paper, 1 is reproduced, 2 contradicted, 1 under-specified and 1 qualitative. \
             2 statements of our own are measured besides."
        );
        assert_eq!(tally(&all[1..3]), "Of 2 claims of the paper, 2 are contradicted.");
        assert_eq!(
            tally(&[&claim("guessed", "")]),
            "Of 1 claim of the paper, 1 is judged otherwise."
        );
        assert_eq!(tally(&[]), "No claim of the paper is tested here.");
    }
}
