//! Whether one model is better than another on blocks that neither was fitted to.

/// χ² of every judging block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judged {
    /// The mean squared residual of each block, in units of the floor [1].
    pub(crate) blocks: Vec<f64>,
}

impl Judged {
    /// From the sums of squares of all blocks, and the number of residuals of each.
    pub(crate) fn of(blocks: &[Vec<f64>], counts: &[f64], trains: &[bool]) -> Self {
        let mean = |(block, count): (&Vec<f64>, &f64)| block.iter().sum::<f64>() / count;
        let judging = blocks.iter().zip(counts).zip(trains).filter(|(_, trains)| !**trains);
        Self { blocks: judging.map(|(block, _)| mean(block)).collect() }
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

    /// The median over the blocks [1]: a few that went astray say nothing.
    pub(crate) fn middle(&self) -> f64 {
        let mut sorted = self.blocks.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    /// Student's t of the logarithms of the ratios of the blocks, positive where `other` is better.
    pub(crate) fn against(&self, other: &Self) -> f64 {
        let logs: Vec<f64> = self
            .blocks
            .iter()
            .zip(&other.blocks)
            .map(|(a, b)| (a.max(1e-300) / b.max(1e-300)).ln())
            .collect();
        student(&logs)
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

/// How much of the excess over the floor is gone [1].
pub(crate) fn shrink(before: f64, with: f64) -> f64 {
    if before > 1.0 { (before - with) / (before - 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{Judged, shrink, student};

    #[test]
    fn t_is_students() {
        // By hand: mean 2, variance 1, n 3.
        assert!((student(&[1.0, 2.0, 3.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-12);
        assert!((shrink(5.0, 2.0) - 0.75).abs() < 1e-15 && shrink(0.9, 0.5) == 0.0);
    }

    #[test]
    fn the_model_with_the_smaller_blocks_is_better() {
        let one = Judged { blocks: vec![4.0, 5.0, 6.0, 4.5] };
        let other = Judged { blocks: vec![1.0, 1.2, 1.1, 1.3] };
        assert!(one.against(&other) > 3.0 && other.against(&one) < -3.0);
    }
}
