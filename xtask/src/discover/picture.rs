//! The ladder of the gap, the ranking with whiskers, and the map over displacement and speed.

use super::{Told, shown::axis_unit};
use discover::{Ranked, Residual};
use experiment::four_digits;
use report::{FitCell, FitDrawing, FitHeat, FitLadder, FitRung};

/// The most candidates of a round that are shown.
const CANDIDATES: usize = 10;

/// Columns and rows of a map.
const COLUMNS: usize = 16;
const ROWS: usize = 9;

/// A cell needs so many samples to say anything.
const FEWEST: usize = 5;

/// From so many floors on a cell has the next shade [1].
const SHADES: [f64; 3] = [0.5, 2.0, 8.0];

/// Root mean square of the residuals in units of the floor: given, refitted, with each effect, with all.
pub(super) fn ladder(told: &Told) -> FitDrawing {
    let found = &told.found;
    let [given, refit, after] = found.chi_squared;
    let mut rungs = vec![("as given".to_owned(), given), ("refitted".to_owned(), refit)];
    let mut level = refit;
    for (n, effect) in found.effects.iter().enumerate() {
        level = 1.0 + (level - 1.0) * (1.0 - effect.shrink);
        // The last one is the final model, fitted once more.
        let last = n + 1 == found.effects.len();
        rungs.push((format!("+ {}", effect.name), if last { after } else { level }));
    }
    rungs.push(("floor".to_owned(), 1.0));
    let rungs = rungs.into_iter().map(|(name, level)| FitRung {
        chosen: name.starts_with('+'),
        name,
        value: level.max(0.0).sqrt(),
        whisker: None,
        note: four_digits(level.max(0.0).sqrt()),
    });
    FitDrawing::Ladder(FitLadder {
        title: "From the gap to the floor".to_owned(),
        caption: "Root mean square of the residuals of all channels on the blocks that were not fitted, in units of what \
                  noise alone leaves."
            .to_owned(),
        axis: "residual / floor [1]".to_owned(),
        log: true,
        rungs: rungs.collect(),
        against: Some(1.0),
    })
}

/// The candidates of each round.
pub(super) fn rankings(told: &Told) -> Vec<FitDrawing> {
    let all = &told.found.ranking;
    let rounds = all.iter().map(|r| r.round).max().map_or(0, |last| last + 1);
    let of = |round: usize| {
        let mut some: Vec<&Ranked> = all.iter().filter(|r| r.round == round).collect();
        some.sort_by(|a, b| b.shrink.total_cmp(&a.shrink));
        some.truncate(CANDIDATES);
        some
    };
    let rounds = (0..rounds).map(|round| (round, of(round))).filter(|(_, some)| !some.is_empty());
    rounds.map(|(round, some)| drawn(told, round, &some)).collect()
}

fn drawn(told: &Told, round: usize, some: &[&Ranked]) -> FitDrawing {
    let named = told.found.effects.get(round);
    let rung = |r: &&Ranked| {
        // Student's t is of the shrinking itself: its standard error is the shrinking by t.
        let error = (r.shrink / r.t).abs();
        let reach = 1.96 * error;
        // A rival that makes all worse would take the room of the others.
        let held = |value: f64| 100.0 * value.clamp(-0.25, 1.25);
        FitRung {
            name: r.name.to_owned(),
            value: held(r.shrink),
            whisker: Some([held(r.shrink - reach), held(r.shrink + reach)]),
            chosen: r.plausible && named.is_some_and(|effect| effect.set.contains(&r.name)),
            note: if r.plausible { String::new() } else { "not plausible".to_owned() },
        }
    };
    FitDrawing::Ladder(FitLadder {
        title: format!("Candidates, round {}", round + 1),
        caption: "What each candidate, refitted in full, takes away of the excess over the floor on the blocks that were \
                  not fitted, with its 95 % interval over the blocks. Bold is what was named or cannot be told from it."
            .to_owned(),
        axis: "taken away [%]".to_owned(),
        log: false,
        rungs: some.iter().map(rung).collect(),
        against: Some(0.0),
    })
}

/// The mean residual over displacement and speed, in units of the floor.
pub(super) fn heat(told: &Told, residuals: &[Option<Residual>; 3]) -> Option<FitDrawing> {
    let names = ["as given", "without what was found", "with it"];
    let first = residuals.iter().flatten().next()?;
    let (x, y) = (ends(&first.q), ends(&first.v));
    let maps = residuals
        .iter()
        .zip(names)
        .filter_map(|(residual, name)| Some((name.to_owned(), cells(residual.as_ref()?, x, y))));
    let [q, v] = ["displacement", "velocity"].map(|axis| axis_unit(told, axis));
    Some(FitDrawing::Heat(FitHeat {
        title: "The residual over displacement and speed".to_owned(),
        caption: "Mean residual in each cell, in units of its floor: orange is positive, blue negative. Cells without \
                  samples are empty."
            .to_owned(),
        x: (format!("displacement [{q}]"), x),
        y: (format!("velocity [{v}]"), y),
        columns: COLUMNS,
        maps: maps.collect(),
    }))
}

/// Where nearly all values lie: a few samples of noise do not make room for themselves.
fn ends(values: &[f64]) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    if n == 0 {
        return [0.0, 1.0];
    }
    [sorted[n / 500], sorted[n - 1 - n / 500]]
}

fn cells(residual: &Residual, x: [f64; 2], y: [f64; 2]) -> Vec<FitCell> {
    let mut sums = vec![(0.0, 0.0, 0_usize); COLUMNS * ROWS];
    for ((q, v), (force, floor)) in
        residual.q.iter().zip(&residual.v).zip(residual.force.iter().zip(&residual.floor))
    {
        let (Some(i), Some(j)) = (place(*q, x, COLUMNS), place(*v, y, ROWS)) else { continue };
        let cell = &mut sums[j * COLUMNS + i];
        *cell = (cell.0 + force, cell.1 + floor * floor, cell.2 + 1);
    }
    let cell = |(force, square, n): &(f64, f64, usize)| {
        let mean = force / (square * (*n).max(1) as f64).sqrt();
        if *n < FEWEST || !mean.is_finite() {
            return FitCell::default();
        }
        let steps = SHADES.iter().filter(|from| mean.abs() >= **from).count();
        let steps = i8::try_from(steps).unwrap_or(3);
        FitCell { text: short(mean), shade: Some(if mean < 0.0 { -steps } else { steps }) }
    };
    sums.iter().map(cell).collect()
}

/// In which of so many stripes between two ends a value lies.
fn place(value: f64, [low, high]: [f64; 2], many: usize) -> Option<usize> {
    let share = (value - low) / (high - low);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to many")]
    (0.0..=1.0).contains(&share).then(|| ((share * many as f64) as usize).min(many - 1))
}

/// A number of floors as a cell holds it.
fn short(value: f64) -> String {
    let size = value.abs();
    let text = if size < 0.05 {
        "0".to_owned()
    } else if size < 9.95 {
        format!("{size:.1}")
    } else if size < 999.5 {
        format!("{size:.0}")
    } else {
        format!("{size:.0e}")
    };
    if value < 0.0 && text != "0" { format!("−{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_holds_the_mean_residual_in_units_of_its_floor() {
        let n = 100;
        let residual = Residual {
            time: vec![0.0; n],
            q: vec![0.5; n],
            v: vec![-1.0; n],
            force: vec![-3.0; n],
            floor: vec![0.5; n],
        };
        let cells = cells(&residual, [0.0, 1.0], [-1.0, 1.0]);
        let full: Vec<(usize, &FitCell)> =
            cells.iter().enumerate().filter(|(_, c)| c.shade.is_some()).collect();
        assert_eq!(full.len(), 1, "{full:?}");
        assert_eq!(full[0].0, COLUMNS / 2, "the cell in the middle of the lowest row");
        assert_eq!((full[0].1.text.as_str(), full[0].1.shade), ("−6.0", Some(-2)));
    }

    #[test]
    fn a_value_outside_has_no_place_and_one_at_the_end_has_the_last() {
        assert_eq!(place(1.0, [0.0, 1.0], 4), Some(3));
        assert_eq!(place(0.0, [0.0, 1.0], 4), Some(0));
        for outside in [-0.1, 1.1, f64::NAN] {
            assert_eq!(place(outside, [0.0, 1.0], 4), None, "{outside}");
        }
        assert_eq!(place(1.0, [1.0, 1.0], 4), None, "between ends that are one");
    }
}
