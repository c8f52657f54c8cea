//! What residuals are divided by.

use crate::Rig;

/// The standard deviation that a residual of each channel is divided by, in the channel's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Of the displacement.
    pub displacement: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Of the input that the controller makes.
    pub input: f64,
    /// Of the force under an imposed motion.
    pub force: f64,
    /// Of the two load cells.
    pub loads: [f64; 2],
}

impl Weights {
    /// The same with the noise of the measured angle in that of the load cells: their springs are followed along it, so
    /// that k r of it lies beside their own.
    #[must_use]
    pub fn along_angle(mut self, rig: &Rig) -> Self {
        for (cell, spring) in self.loads.iter_mut().zip(["k_1", "k_2"]) {
            let by = rig.value(spring).zip(rig.value("radius")).map_or(0.0, |(k, r)| k * r);
            *cell = cell.hypot(by * self.displacement);
        }
        self
    }
}

/// By how much `values` bend around sample `i` [their unit]: their largest second difference within two samples of it.
pub(super) fn bend(values: &[f64], i: usize) -> f64 {
    let around = &values[i.saturating_sub(3)..values.len().min(i + 4)];
    around.windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{Weights, bend};
    use crate::Rig;

    #[test]
    fn the_noise_of_the_angle_is_in_that_of_the_cells() {
        let rig = Rig::parse(include_str!("../../tests/rigs/gearbox.toml")).expect("a rig");
        let value = |key: &str| rig.value(key).expect("a parameter");
        let alone = Weights {
            displacement: 0.1,
            velocity: 1.0,
            input: 1.0,
            force: 1.0,
            loads: [3e-3, 0.0],
        };
        let both = alone.along_angle(&rig);
        // By hand: the second cell has no noise of its own.
        let springs = ["k_1", "k_2"].map(|k| 0.1 * value(k) * value("radius"));
        assert!((both.loads[0].powi(2) - springs[0].powi(2) - 9e-6).abs() < 1e-15);
        assert!((both.loads[1] - springs[1]).abs() < 1e-15 && springs[1] > 0.0);
        assert_eq!(Weights { loads: alone.loads, ..both }, alone);
    }

    #[test]
    fn a_velocity_bends_where_a_break_away_is_and_not_where_it_grows() {
        // At rest for ten samples, then faster by 0.3 a sample.
        let values: Vec<f64> = (0..20).map(|i| 0.3 * (f64::from(i) - 9.0).max(0.0)).collect();
        let bends: Vec<usize> = (1..19).filter(|i| bend(&values, *i) > 0.29).collect();
        assert_eq!(bends[..5], [7, 8, 9, 10, 11], "and at the end, beyond which nothing is");
        assert!(bends[5..].iter().all(|i| *i > 16) && bend(&values, 14) < 1e-12);
    }
}
