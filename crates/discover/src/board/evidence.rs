//! How sure it is that an effect is there, by what it changes.
//!
//! Where an effect shows in a few blocks, and little there, what it takes off each block's sum of squares is mostly noise,
//! and most of it that of blocks in which it cannot show. What it says it changes, d = r − r′ of the residuals without and
//! with it, tells where to look: the residuals without it lie along d by â = Σ s/Σ I of it, s = r·d and I = d·d of each block.
//! That amount is 1 in the mean if the effect is there and 0 if not, and its spread is seen by leaving out block after
//! block (Rao's score test; the jackknife is Quenouille's and Tukey's: Miller, Biometrika 61, 1974, 1–15), whatever the
//! residuals of one block have to do with each other.

use super::{Board, Fitted};
use identify::fit::{FitError, window::Window};

/// So few blocks tell nothing of their spread.
const BLOCKS: usize = 6;

/// Twice the blocks tell it √2 times as surely. Half of them are what the effect was fitted to, and so tell for it without
/// it, though by no more than a few: what all tell counts for so much, and for no more than so many times what the others do.
const ALL: f64 = 0.75;
const OTHERS: f64 = 1.5;

impl Board<'_> {
    /// Student's t of the amount of what the model `with` an effect changes of that `without` it: on the judging blocks,
    /// which neither was fitted to, or, where all are surer, on all of them.
    pub(crate) fn evidence(&self, without: &Fitted, with: &Fitted) -> Result<f64, FitError> {
        let parts = self.parts(without, with)?;
        let judging = parts.iter().zip(&self.trains).filter(|(_, trains)| !**trains);
        let judging: Vec<[f64; 2]> = judging.map(|(part, _)| *part).collect();
        Ok(surer(student(&judging), student(&parts)))
    }

    /// What each block tells of it: s and I, worth the less the more is left there.
    fn parts(&self, without: &Fitted, with: &Fitted) -> Result<Vec<[f64; 2]>, FitError> {
        let (without, with) = (self.rows(without)?, self.rows(with)?);
        let one = |(without, with): (&Vec<f64>, &Vec<f64>)| -> [f64; 2] {
            let changes = || without.iter().zip(with).map(|(a, b)| (a, a - b));
            let worth = 1.0 / mean_square(without).max(mean_square(with)).max(1.0);
            let sums: [f64; 2] =
                [changes().map(|(a, d)| a * d).sum(), changes().map(|(_, d)| d * d).sum()];
            sums.map(|sum| worth * sum)
        };
        Ok(without.iter().zip(&with).map(one).collect())
    }

    /// The residuals of the blocks, those of the load cells after the others.
    fn rows(&self, fitted: &Fitted) -> Result<Vec<Vec<f64>>, FitError> {
        let held = fitted.held();
        let problem = self.problem(&held, |_| true)?;
        let (channels, (loads, _)) = (problem.channels(), problem.cells(&[]));
        let samples: usize = self.windows.iter().map(Window::len).sum();
        let first = self.windows.first().map_or(0, |window| window.first);
        let mut rows = vec![Vec::new(); self.trains.len()];
        for (w, window) in self.windows.iter().enumerate() {
            let block: &mut Vec<f64> = &mut rows[self.block(w)];
            block.extend(self.own(&fitted.pieces, w, channels));
            for cell in loads.chunks_exact(samples) {
                block.extend(&cell[window.first - first..window.end - first]);
            }
        }
        Ok(rows)
    }
}

/// How sure what the `judging` blocks tell is with what `all` do [1].
fn surer(judging: f64, all: f64) -> f64 {
    judging.max((ALL * all).min(OTHERS * judging))
}

/// The mean square of residuals [1].
fn mean_square(rows: &[f64]) -> f64 {
    rows.iter().map(|r| r * r).sum::<f64>() / rows.len().max(1) as f64
}

/// Student's t of Σ s/Σ I of these `parts` s and I; 0 where they do not tell it.
fn student(parts: &[[f64; 2]]) -> f64 {
    let n = parts.len() as f64;
    let all = parts.iter().fold([0.0, 0.0], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
    let others: Vec<f64> = parts.iter().map(|[s, i]| (all[0] - s) / (all[1] - i)).collect();
    let mean = others.iter().sum::<f64>() / n;
    let squares: f64 = others.iter().map(|other| (other - mean).powi(2)).sum();
    let t = all[0] / all[1] / (squares * (n - 1.0) / n).sqrt();
    if parts.len() < BLOCKS || !t.is_finite() { 0.0 } else { t }
}

#[cfg(test)]
mod tests {
    use super::{Board, student, surer};
    use crate::walk::made;
    use identify::effects::Kind;

    #[test]
    fn where_all_blocks_tell_as_much_it_is_students_t_of_the_mean() {
        let s = [3.0, 5.0, 4.0, 6.0, 2.0, 4.0, 4.5, 3.5];
        let parts: Vec<[f64; 2]> = s.iter().map(|s| [*s, 4.0]).collect();
        let t = crate::decide::student(&s);
        assert!((student(&parts) - t).abs() < 1e-12 * t, "{} and {t}", student(&parts));
        assert_eq!(student(&parts[..3]), 0.0, "too few");
    }

    #[test]
    fn all_blocks_are_surer_than_half_of_them_but_not_without_these() {
        assert_eq!(surer(5.0, 8.0), 6.0);
        assert_eq!(surer(6.0, 7.0), 6.0);
        assert_eq!(surer(2.0, 40.0), 3.0);
        assert_eq!(surer(-2.0, 40.0), -2.0);
    }

    #[test]
    fn the_blocks_that_were_fitted_tell_of_an_effect_as_well() {
        let data = made::data();
        let board = Board::of(&made::rig(2.0), &data, 1, Vec::new()).unwrap();
        let model = |bias: f64| {
            board.judged(&made::with(&made::rig(2.0), Kind::CurrentBias, &[bias]), None).unwrap()
        };
        let (without, with) = (model(0.97 * made::BIAS), model(made::BIAS));
        let parts = board.parts(&without, &with).unwrap();
        let judging: Vec<[f64; 2]> =
            (0..parts.len()).filter(|k| !board.trains[*k]).map(|k| parts[k]).collect();
        let (half, told) = (student(&judging), board.evidence(&without, &with).unwrap());
        assert!(half > 3.0 && told > 1.02 * half, "{told} where half of the blocks tell {half}");
    }

    #[test]
    fn one_block_tells_nothing_by_itself() {
        let mut parts = vec![[0.01, 1.0]; 20];
        parts[0] = [900.0, 1000.0];
        assert!(student(&parts) < 3.0, "{}", student(&parts));
        // And blocks in which nothing can show hide nothing.
        let mut parts: Vec<[f64; 2]> = (0..6).map(|k| [40.0 + f64::from(k), 42.0]).collect();
        let few = student(&parts);
        parts.extend((0..20).map(|k| [0.3 * f64::from(k % 3 - 1), 0.01]));
        assert!(student(&parts) > 0.9 * few, "{} of {few}", student(&parts));
    }
}
