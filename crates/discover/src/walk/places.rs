//! Where what a model leaves acts: at what time, and in what state of the motion.

use super::Walk;
use crate::{
    board::{Fitted, SOFT},
    verdict::Share,
};
use identify::fit::Data;

/// The parts of a record, and the states of a motion.
const THIRDS: [&str; 3] = ["first third", "second third", "last third"];
const STATES: [&str; 4] = ["sticking", "break-away", "sliding forward", "sliding back"];

/// Slower than this share of the largest velocity is at rest.
const SLOW: f64 = 0.01;

/// So many samples after a rest a motion still breaks away.
const AFTER: usize = 10;

/// So many samples to either side tell the velocity where it was not measured.
const BESIDE: usize = 2;

/// So little of a sample's noise is no excess.
const NONE: f64 = 0.1;

/// One sample's squared residuals above what the floor leaves, and where it is.
#[derive(Debug, Clone, Copy)]
struct Excess {
    sample: usize,
    velocity: f64,
    /// Above the floor, as much as its window is worth [1].
    above: f64,
}

impl Walk<'_> {
    /// The shares of the excess of a model, by thirds of the record and by the state of the motion; each of the two
    /// adds up to 1. However far off a window is it counts as a few floors: which
    /// of them are the farthest is another on each processor. None where there is no excess.
    pub(super) fn shares(&self, refit: &Fitted) -> Vec<Share> {
        let all = self.excess(refit);
        let count = self.board.data.time.len().max(1);
        if all.iter().map(|e| e.above).sum::<f64>() < NONE * count as f64 {
            return Vec::new();
        }
        let thirds = summed(&THIRDS, all.iter().map(|e| (3 * e.sample / count, e.above)));
        let states = states(&all);
        let states = summed(&STATES, states.into_iter().zip(&all).map(|(s, e)| (s, e.above)));
        thirds.into_iter().chain(states).collect()
    }

    /// Every sample of the windows, in the order of time.
    fn excess(&self, refit: &Fitted) -> Vec<Excess> {
        let data = self.board.data;
        let mut all = Vec::new();
        for (k, window) in self.board.windows.iter().enumerate() {
            let imposed = self.board.imposed();
            let piece = &refit.pieces[if imposed { 0 } else { k }];
            let channels = if imposed { 1 } else { 1 + usize::from(data.velocity.is_some()) };
            let rows = if imposed { window.first..window.end } else { 0..window.len() * channels };
            let own = piece.residuals.get(rows).unwrap_or(&[]);
            let mean = own.iter().map(|r| r * r).sum::<f64>() / own.len().max(1) as f64;
            let worth = SOFT / (SOFT + mean);
            for i in 0..window.len() {
                let sample = window.first + i;
                let row = if imposed { sample } else { i * channels };
                let Some(rows) = piece.residuals.get(row..row + channels) else { continue };
                let above = worth * rows.iter().map(|r| r * r - 1.0).sum::<f64>();
                all.push(Excess { sample, velocity: velocity(data, sample), above });
            }
        }
        all
    }
}

/// The velocity of the record at a sample, as measured or as its displacement shows it: a model that lacks something
/// may stick where the plant moves.
fn velocity(data: &Data, sample: usize) -> f64 {
    if let Some(seen) = &data.velocity {
        return seen.values[sample];
    }
    let moved = data.displacement.as_ref().map_or(&data.input, |seen| &seen.values);
    let (before, after) = (sample.saturating_sub(BESIDE), (sample + BESIDE).min(moved.len() - 1));
    (moved[after] - moved[before]) / (data.time[after] - data.time[before])
}

/// The state of the motion at every sample, as a place in [`STATES`].
fn states(all: &[Excess]) -> Vec<usize> {
    let fastest = all.iter().map(|e| e.velocity.abs()).fold(0.0, f64::max);
    let mut since_rest = usize::MAX;
    let one = |e: &Excess| {
        if e.velocity.abs() <= SLOW * fastest {
            since_rest = 0;
            return 0;
        }
        since_rest = since_rest.saturating_add(1);
        match e.velocity > 0.0 {
            _ if since_rest <= AFTER => 1,
            true => 2,
            false => 3,
        }
    };
    all.iter().map(one).collect()
}

/// The share of each part in what is above the floor.
fn summed<const N: usize>(
    names: &[&'static str; N],
    all: impl Iterator<Item = (usize, f64)>,
) -> Vec<Share> {
    let mut sums = [0.0; N];
    for (place, above) in all {
        sums[place.min(N - 1)] += above;
    }
    let sums = sums.map(|sum: f64| sum.max(0.0));
    let whole = sums.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    names.iter().zip(sums).map(|(part, sum)| Share { part, share: sum / whole }).collect()
}

#[cfg(test)]
mod tests {
    use super::{Data, Excess, STATES, states, summed, velocity};
    use identify::{Hold, fit::Seen};

    #[test]
    fn a_motion_rests_breaks_away_and_slides_forth_and_back() {
        let velocities = [0.0, 0.0, 0.3].into_iter().chain([1.0; 12]).chain([-1.0; 2]);
        let all: Vec<Excess> = velocities
            .enumerate()
            .map(|(sample, velocity)| Excess { sample, velocity, above: 1.0 })
            .collect();
        let found = states(&all);
        assert_eq!(found[..3], [0, 0, 1], "rest, then break-away");
        assert_eq!((found[11], found[12], found[14], found[16]), (1, 2, 2, 3), "{found:?}");
        let shares = summed(&STATES, found.into_iter().zip(&all).map(|(s, e)| (s, e.above)));
        let of = |i: usize| shares[i].share * 17.0;
        let expected = [2.0, 10.0, 3.0, 2.0];
        assert!((0..4).all(|i| (of(i) - expected[i]).abs() < 1e-9), "{shares:?}");
    }

    #[test]
    fn a_motion_is_seen_in_the_record_whatever_a_model_does() {
        let time: Vec<f64> = (0..9).map(|i| 0.1 * f64::from(i)).collect();
        let at = |t: &f64| 3.0 * t;
        let angle = Seen::new("angle", time.iter().map(at).collect(), 0.0);
        let data = Data::driven(time, vec![0.0; 9], Hold::ZeroOrder, angle);
        let all = (0..9).map(|sample| velocity(&data, sample));
        assert!(all.into_iter().all(|v| (v - 3.0).abs() < 1e-12));
        let measured = Seen::new("speed", vec![2.0; 9], 0.0);
        assert_eq!(velocity(&Data { velocity: Some(measured), ..data }, 4), 2.0);
    }

    #[test]
    fn what_is_below_the_floor_is_no_excess() {
        let shares = summed(&["a", "b"], [(0, -3.0), (1, 2.0)].into_iter());
        assert_eq!((shares[0].share, shares[1].share), (0.0, 1.0));
        let none = summed(&["a", "b"], [(0, -3.0)].into_iter());
        assert!(none.iter().all(|s| s.share == 0.0), "{none:?}");
    }
}
