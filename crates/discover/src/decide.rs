//! Whether one model is better than another on blocks that neither was fitted to.

/// χ² of every judging block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judged {
    /// The mean squared residual of each block, in units of the floor [1].
    pub(crate) blocks: Vec<f64>,
    /// How many residuals each block has [1].
    pub(crate) counts: Vec<f64>,
}

impl Judged {
    /// From the sums of squares of all blocks, and the number of residuals of each.
    pub(crate) fn of(blocks: &[Vec<f64>], counts: &[f64], trains: &[bool]) -> Self {
        let mean = |(block, count): (&Vec<f64>, &f64)| block.iter().sum::<f64>() / count;
        let judging = || blocks.iter().zip(counts).zip(trains).filter(|(_, trains)| !**trains);
        Self {
            blocks: judging().map(|(block, _)| mean(block)).collect(),
            counts: judging().map(|((_, count), _)| *count).collect(),
        }
    }

    /// The mean over the blocks [1].
    pub(crate) fn mean(&self) -> f64 {
        self.blocks.iter().sum::<f64>() / self.blocks.len().max(1) as f64
    }

    /// The middle of the blocks, by their logarithms [1]: one bad block does not decide.
    pub(crate) fn level(&self) -> f64 {
        let logs: f64 = self.blocks.iter().map(|b| b.max(1e-300).ln()).sum();
        (logs / self.blocks.len().max(1) as f64).exp()
    }

    /// The same without the worst tenth of the blocks [1]: a few that went astray say nothing.
    pub(crate) fn mostly(&self) -> f64 {
        let mut blocks = self.blocks.clone();
        blocks.sort_by(f64::total_cmp);
        blocks.truncate((9 * blocks.len()).div_ceil(10));
        Self { counts: Vec::new(), blocks }.level()
    }

    /// The logarithms of the ratios of the blocks, positive where `other` is better.
    fn logarithms(&self, other: &Self) -> Vec<f64> {
        let pairs = self.blocks.iter().zip(&other.blocks);
        pairs.map(|(a, b)| (a.max(1e-300) / b.max(1e-300)).ln()).collect()
    }

    /// Student's t of the logarithms of the ratios of the blocks, positive where `other` is better.
    pub(crate) fn against(&self, other: &Self) -> f64 {
        student(&self.logarithms(other))
    }

    /// The same by the ranks of the logarithms: sure as well where `other` is better everywhere, but not alike.
    pub(crate) fn everywhere(&self, other: &Self) -> f64 {
        signed_ranks(&self.logarithms(other))
    }

    /// By how much the sum of squares is less with `other` [1]: so many squared standard errors.
    pub(crate) fn gained(&self, other: &Self) -> f64 {
        let pairs = self.blocks.iter().zip(&other.blocks).zip(&self.counts);
        pairs.map(|((a, b), count)| count * (a - b)).sum()
    }

    /// The same besides the two blocks that gain most; 0 where others lose more than a fifth of what is gained.
    pub(crate) fn gained_besides(&self, other: &Self) -> f64 {
        let pairs = self.blocks.iter().zip(&other.blocks).zip(&self.counts);
        let mut gains: Vec<f64> = pairs.map(|((a, b), count)| count * (a - b)).collect();
        gains.sort_by(f64::total_cmp);
        let most: f64 = gains.iter().rev().take(2).sum();
        let lost: f64 = -gains.iter().filter(|gain| **gain < 0.0).sum::<f64>();
        let net = gains.iter().sum::<f64>();
        if lost > 0.2 * (net + lost) { 0.0 } else { net - most }
    }
}

/// Student's t of the mean of `values`.
pub(crate) fn student(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    if values.len() < 2 {
        return 0.0;
    }
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    mean / (variance / n).sqrt().max(1e-9)
}

/// Wilcoxon's sum of signed ranks of `values`, as a normal deviate (Hollander, Wolfe and Chicken, Nonparametric
/// Statistical Methods, 3rd ed., Wiley 2014, section 3.1).
fn signed_ranks(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| *v != 0.0).collect();
    sorted.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let sum: f64 = sorted.iter().zip(1..).map(|(v, rank)| v.signum() * f64::from(rank)).sum();
    let n = sorted.len() as f64;
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
    if variance > 0.0 { sum / variance.sqrt() } else { 0.0 }
}

/// How much of the excess over the floor is gone [1].
pub(crate) fn shrink(before: f64, with: f64) -> f64 {
    if before > 1.0 { (before - with) / (before - 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{Judged, shrink, signed_ranks, student};

    #[test]
    fn t_is_students() {
        // By hand: mean 2, variance 1, n 3.
        assert!((student(&[1.0, 2.0, 3.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-12);
        assert!((shrink(5.0, 2.0) - 0.75).abs() < 1e-15 && shrink(0.9, 0.5) == 0.0);
    }

    #[test]
    fn the_model_with_the_smaller_blocks_is_better() {
        let of = |blocks: [f64; 4]| Judged { blocks: blocks.to_vec(), counts: vec![10.0; 4] };
        let (one, other) = (of([4.0, 5.0, 6.0, 4.5]), of([1.0, 1.2, 1.1, 1.3]));
        assert!(one.against(&other) > 3.0 && other.against(&one) < -3.0);
        assert!((one.gained(&other) - 149.0).abs() < 1e-9);
    }

    #[test]
    fn what_a_few_blocks_gain_counts_besides_the_two_that_gain_most() {
        let of = |blocks: [f64; 5]| Judged { blocks: blocks.to_vec(), counts: vec![10.0; 5] };
        let now = of([9.0, 5.0, 2.0, 1.5, 1.0]);
        // 80, 40, 10, 5 and 0.
        assert!((now.gained_besides(&of([1.0; 5])) - 15.0).abs() < 1e-9);
        // 80 - 30 + 10: what is lost is a third of what is gained.
        assert_eq!(now.gained_besides(&of([1.0, 5.0, 5.0, 0.5, 1.0])), 0.0);
        // 80 + 40 - 10 + 10: it is a thirteenth.
        assert!((now.gained_besides(&of([1.0, 1.0, 3.0, 0.5, 1.0])) - 0.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_better_everywhere_is_surely_so_however_unlike() {
        // By hand: ranks 1 to 4 with the third negative, 1 + 2 − 3 + 4 of the variance 4·5·9/6.
        assert!((signed_ranks(&[0.1, -0.3, 0.2, 7.0]) - 4.0 / 30f64.sqrt()).abs() < 1e-12);
        // One block that is far better hides from Student that all of them are better.
        let logs: Vec<f64> =
            (0..20).map(|k| if k == 0 { 9.0 } else { 0.01 * f64::from(k) }).collect();
        assert!(student(&logs) < 2.0 && signed_ranks(&logs) > 3.5, "{}", signed_ranks(&logs));
    }
}
