//! How often the intervals held the truth.

use super::case::{Case, Drawn};
use identify::fit::{Estimate, Fit, search::End};
use serde_json::{Value, json};
use std::fmt::Write;

/// One parameter of one case.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Tally {
    parameter: String,
    /// Records fitted.
    records: usize,
    /// How often the record identified it, by the fit's word.
    identified: usize,
    /// How often the profile interval held the truth, where it was identified.
    profile: usize,
    /// How often the asymptotic interval did, there.
    asymptotic: usize,
    /// The sum of the standard errors, of the truth [1].
    errors: f64,
    /// The sum of the squared distances from the truth, in standard errors [1].
    squares: f64,
}

/// One case.
#[derive(Debug, Clone, Default)]
pub(super) struct Score {
    model: &'static str,
    parameters: Vec<Tally>,
    /// Fits that did not say they had converged.
    unconverged: usize,
    /// Fits that ended at their start and said they had converged.
    at_start: usize,
    /// Records that could not be fitted at all.
    pub(super) failed: usize,
    /// CPU time of all records, made and fitted [s].
    pub(super) seconds: f64,
}

/// So near its start, of its value, a parameter counts as not moved [1]; the truth is 0.02 away at least.
const STAYED: f64 = 1e-3;

/// Within these the share of intervals must lie that hold the truth, of all parameters of a case together …
const ALL: [f64; 2] = [0.93, 0.97];
/// … and of each.
const EACH: [f64; 2] = [0.90, 0.99];

impl Score {
    /// Nothing counted yet.
    pub(super) fn new(case: &Case) -> Self {
        let named = |parameter| Tally { parameter, ..Tally::default() };
        let parameters = case.rig.free_parameters().into_iter().map(named).collect();
        Self { model: case.name, parameters, ..Self::default() }
    }

    /// Counts one fit.
    pub(super) fn count(&mut self, fit: &Fit, drawn: &Drawn) {
        let converged = fit.end == End::Converged;
        self.unconverged += usize::from(!converged);
        let stayed = |p: &Estimate| (p.found - p.given).abs() < STAYED * p.given.abs();
        self.at_start += usize::from(converged && fit.parameters.iter().all(stayed));
        let rows = self.parameters.iter_mut().zip(&fit.parameters).zip(&drawn.truth);
        for ((tally, p), truth) in rows {
            tally.records += 1;
            let ([Some(low), Some(high)], true, true) = (p.interval, p.identified, converged)
            else {
                continue;
            };
            tally.identified += 1;
            tally.profile += usize::from((low..=high).contains(truth));
            tally.asymptotic += usize::from((p.asymptotic[0]..=p.asymptotic[1]).contains(truth));
            tally.errors += p.standard_error / truth.abs();
            tally.squares += ((p.found - truth) / p.standard_error).powi(2);
        }
    }

    /// Adds what another thread counted.
    pub(super) fn add(&mut self, other: &Self) {
        for (one, more) in self.parameters.iter_mut().zip(&other.parameters) {
            one.add(more);
        }
        self.unconverged += other.unconverged;
        self.at_start += other.at_start;
        self.failed += other.failed;
    }

    /// The rows of the table: every parameter, and all together.
    fn rows(&self) -> Vec<Tally> {
        let mut all = Tally { parameter: "all".to_owned(), ..Tally::default() };
        for tally in &self.parameters {
            all.add(tally);
        }
        self.parameters.iter().cloned().chain([all]).collect()
    }

    fn records(&self) -> usize {
        self.failed + self.parameters.first().map_or(0, |p| p.records)
    }

    /// What does not hold, in words.
    pub(super) fn breaches(&self) -> Vec<String> {
        let mut breaches = Vec::new();
        for row in self.rows() {
            let [low, high] = if row.parameter == "all" { ALL } else { EACH };
            let share = row.share(row.profile);
            if !(low..=high).contains(&share) {
                breaches.push(format!(
                    "{}: {:.1} % of {} intervals hold the truth, expected {:.0} to {:.0} %",
                    row.parameter,
                    100.0 * share,
                    row.identified,
                    100.0 * low,
                    100.0 * high
                ));
            }
        }
        if self.at_start > 0 {
            breaches.push(format!("{} fits ended at their start, \"converged\"", self.at_start));
        }
        breaches
    }

    /// As lines for a screen.
    pub(super) fn words(&self) -> String {
        let mut text = format!(
            "{}: {} records, {} not converged, {} not fitted, {} stayed at the start; {:.2} s of CPU time each\n",
            self.model,
            self.records(),
            self.unconverged,
            self.failed,
            self.at_start,
            self.seconds / self.records().max(1) as f64,
        );
        for row in self.rows() {
            let _ = writeln!(
                text,
                "  {:8} {:5} intervals, profile {:5.1} %, asymptotic {:5.1} %; standard error {:.1e}, χ² {:.2}",
                row.parameter,
                row.identified,
                100.0 * row.share(row.profile),
                100.0 * row.share(row.asymptotic),
                row.error(),
                row.chi(),
            );
        }
        for breach in self.breaches() {
            let _ = writeln!(text, "  x {breach}");
        }
        text
    }
}

impl Tally {
    fn add(&mut self, more: &Self) {
        self.records += more.records;
        self.identified += more.identified;
        self.profile += more.profile;
        self.asymptotic += more.asymptotic;
        self.errors += more.errors;
        self.squares += more.squares;
    }

    /// What share of the intervals `held` is [1].
    fn share(&self, held: usize) -> f64 {
        held as f64 / self.intervals()
    }

    /// The mean standard error, relative to the value [1].
    fn error(&self) -> f64 {
        self.errors / self.intervals()
    }

    /// The mean square of what the value is off by, in standard errors [1].
    fn chi(&self) -> f64 {
        self.squares / self.intervals()
    }

    fn intervals(&self) -> f64 {
        self.identified.max(1) as f64
    }
}

/// The table that is kept. Times are not in it.
pub(super) fn csv(scores: &[Score], command: &str) -> String {
    let mut text = format!("# {command}\n");
    text.push_str(
        "model,parameter,records,intervals,covered,share,asymptotic_share,identified_share,\
         relative_standard_error,not_converged\n",
    );
    for score in scores {
        for row in score.rows() {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{:.4},{:.4},{:.4},{:.2e},{}",
                score.model,
                row.parameter,
                row.records,
                row.identified,
                row.profile,
                row.share(row.profile),
                row.share(row.asymptotic),
                row.identified as f64 / row.records.max(1) as f64,
                row.error(),
                score.unconverged,
            );
        }
    }
    text
}

/// All of it.
pub(super) fn json(scores: &[Score], seed: u64) -> Value {
    let models = scores.iter().map(|score| {
        let rows = score.rows().into_iter().map(|row| {
            json!({
                "parameter": row.parameter, "intervals": row.identified, "covered": row.profile,
                "share": row.share(row.profile), "asymptotic_share": row.share(row.asymptotic),
                "identified_share": row.identified as f64 / row.records.max(1) as f64,
            })
        });
        json!({
            "model": score.model, "records": score.records(), "not_converged": score.unconverged,
            "not_fitted": score.failed, "at_start": score.at_start,
            "seconds": score.seconds / score.records().max(1) as f64,
            "parameters": rows.collect::<Vec<_>>(), "breaches": score.breaches(),
        })
    });
    let models: Vec<Value> = models.collect();
    let held = scores.iter().all(|score| score.breaches().is_empty());
    json!({ "format": record::FORMAT, "first_seed": seed, "held": held, "models": models })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn score(profile: usize) -> Score {
        let tally = Tally {
            parameter: "f_c".to_owned(),
            records: 100,
            identified: 100,
            profile,
            asymptotic: 94,
            ..Tally::default()
        };
        Score { model: "coulomb", parameters: vec![tally], ..Score::default() }
    }

    #[test]
    fn too_many_intervals_without_the_truth_are_a_breach_and_so_are_too_few() {
        assert_eq!(score(95).breaches(), Vec::<String>::new());
        assert_eq!(score(92).breaches().len(), 1, "{:?}", score(92).breaches());
        assert_eq!(score(89).breaches().len(), 2, "{:?}", score(89).breaches());
        assert_eq!(score(100).breaches().len(), 2, "{:?}", score(100).breaches());
    }

    #[test]
    fn the_table_says_how_it_was_made_and_how_many_intervals_hold_the_truth() {
        let text = csv(&[score(95)], "cargo xtask bench coverage --seed 1");
        assert!(text.starts_with("# cargo xtask bench coverage --seed 1\nmodel,"), "{text}");
        assert!(text.contains("coulomb,f_c,100,100,95,0.9500,0.9400,1.0000,"), "{text}");
    }

    #[test]
    fn errors_and_squares_are_told_as_means_over_the_intervals() {
        let mut score = score(95);
        (score.parameters[0].errors, score.parameters[0].squares) = (5.0, 90.0);
        let text = csv(std::slice::from_ref(&score), "");
        assert!(text.contains(",1.0000,5.00e-2,"), "{text}");
        let words = score.words();
        assert!(words.contains("standard error 5.0e-2, χ² 0.90"), "{words}");
    }
}
