//! What the steps of an encoder leave: while a motion is slow or rests, its neighbouring samples are off by the same.

use super::{Walk, left::lasts};
use crate::board::Fitted;
use std::f64::consts::{PI, TAU};

/// So many waves of the saw's teeth are added up.
const WAVES: u8 = 20;

impl Walk<'_> {
    /// Over how many samples that hangs together which the encoder's steps leave of a driven motion as a right model has
    /// it [1]: 1 where there are none, or where noise is larger than they are.
    pub(super) fn grained(&self, fitted: &Fitted) -> f64 {
        let seen = self.board.data.displacement.as_ref().filter(|seen| seen.quantum > 0.0);
        let Some(quantum) = seen.map(|seen| seen.quantum) else { return 1.0 };
        let noise = self.board.weights.displacement;
        let trembles = (noise * noise - quantum * quantum / 12.0).max(0.0).sqrt() / quantum;
        let rows = |q: &Vec<f64>| -> Vec<f64> {
            q.iter().map(|q| rounded(q / quantum, trembles)).collect()
        };
        let all: Vec<Vec<f64>> = fitted.pieces.iter().map(|piece| rows(&piece.motion.q)).collect();
        let (mut count, mut squares) = (0.0, 0.0);
        for row in all.iter().flatten() {
            count += 1.0;
            squares += row * row;
        }
        // The rest of the steps' noise is another one in each sample.
        let white = (count * (noise / quantum).powi(2) - squares).max(0.0);
        lasts(all.iter().map(|rows| &rows[..]), white)
    }
}

/// By how much a place is rounded up in the mean, in steps, where it `trembles` by this standard deviation: the saw's
/// Fourier series, whose waves fade by the tremble's characteristic function.
fn rounded(place: f64, trembles: f64) -> f64 {
    if trembles == 0.0 {
        return place.round() - place;
    }
    let wave = |k: u8| {
        let k = f64::from(k);
        let fades = (-0.5 * (TAU * k * trembles).powi(2)).exp();
        fades * (TAU * k * (place - 0.5)).sin() / (PI * k)
    };
    (1..=WAVES).map(wave).sum()
}

#[cfg(test)]
mod tests {
    use super::rounded;
    use crate::walk::made;
    use identify::fit::Seen;

    #[test]
    fn a_place_that_does_not_tremble_is_rounded_to_the_nearest_step() {
        for place in [0.1_f64, 0.4, 0.6, 7.3, -0.2] {
            let sharp: f64 = place.round() - place;
            assert_eq!(rounded(place, 0.0), sharp);
            // The series of a place that hardly trembles, away from where it jumps.
            assert!((rounded(place, 0.03) - sharp).abs() < 2e-3, "at {place}");
        }
        // One that trembles by half a step is rounded up as often as down.
        assert!((0..100).all(|i| rounded(0.01 * f64::from(i), 0.5).abs() < 3e-3));
    }

    #[test]
    fn what_steps_leave_hangs_together_where_they_are_larger_than_what_a_sample_moves() {
        let of = |quantum: f64, noise: f64| {
            let mut data = made::data();
            let seen = data.displacement.as_mut().expect("it is seen");
            *seen = Seen::new("position", seen.values.clone(), quantum);
            let mut walk = made::walk(&made::rig(2.0), &data, &[]);
            walk.board.weights.displacement = noise;
            walk.grained(&walk.best)
        };
        // It moves by 6 mm a sample in the mean: steps of 0.2 m are those of some 31. A saw's correlation, 1 − 6s(1 − s) a
        // share s of a step later, is positive over a fifth of it and comes to 0.096 steps there: 1 + 2(0.096·31 − ½).
        let coarse = of(0.2, 0.2 / 12f64.sqrt());
        assert!((4.0..7.0).contains(&coarse), "{coarse}");
        assert!(of(1e-3, 1e-3) < 1.2, "steps that are as large as the noise");
        assert_eq!(of(0.0, 1e-3), 1.0, "none");
    }
}
