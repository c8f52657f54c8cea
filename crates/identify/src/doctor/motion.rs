//! The motion that a record shows.

use super::series::{median_step, quantile};
use super::{Facts, Findings, Motion, Series};
use crate::recording::{FEWEST_ROWS, usable};
use crate::rig::{Kind, Rig};

/// The rows of a record that can be used together.
#[derive(Debug)]
pub(super) struct Track<'a> {
    pub(super) kind: &'static Kind,
    /// The usual step of the clock [s].
    pub(super) step: f64,
    pub(super) time: Vec<f64>,
    pub(super) position: Vec<f64>,
    pub(super) drive: Vec<f64>,
    pub(super) velocity: Option<Vec<f64>>,
    /// The load cells of a drum.
    pub(super) cells: Vec<(&'a str, Vec<f64>)>,
    /// The smallest change of position that is no noise.
    pub(super) grain: f64,
    /// The speed at each sample, from the position, over [`Self::reach`] samples to either side.
    pub(super) speed: Vec<f64>,
    pub(super) reach: usize,
    /// Where the motion turns, as samples of this track.
    pub(super) turns: Vec<usize>,
    /// Noise of the drive, in its unit.
    pub(super) drive_noise: f64,
}

/// A speed below this share of the fastest is rest.
const REST: f64 = 1e-3;

impl<'a> Track<'a> {
    /// The rows where time goes on and all channels of motion have numbers.
    pub(super) fn new(
        rig: &Rig,
        time: &Series,
        all: &'a [Series],
        findings: &mut Findings,
    ) -> Option<Self> {
        let kind = Kind::of(rig.kind)?;
        let named = |name: &str| all.iter().find(|s| s.name == name && s.facts.is_some());
        let position = named(kind.displacement)?;
        let drive = kind.drives.iter().find_map(|name| named(name))?;
        let velocity = kind.velocity.and_then(named);
        let cells: Vec<&Series> = ["force_1", "force_2"].iter().filter_map(|c| named(c)).collect();
        let parts: Vec<&Series> =
            [position, drive].into_iter().chain(velocity).chain(cells.iter().copied()).collect();
        let mut rows = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for (i, t) in time.values.iter().enumerate() {
            if usable(*t) && *t > last && parts.iter().all(|s| usable(s.values[i])) {
                last = *t;
                rows.push(i);
            }
        }
        if rows.len() < FEWEST_ROWS {
            let text = format!("only {} rows have numbers in all channels", rows.len());
            findings.problem("motion", "", text, "the motion is not examined; mend the rows first");
            return None;
        }
        let take = |s: &Series| rows.iter().map(|i| s.values[*i]).collect::<Vec<f64>>();
        let time = take(time);
        let mut track = Self {
            kind,
            step: median_step(&time),
            time,
            position: take(position),
            drive: take(drive),
            velocity: velocity.map(take),
            cells: cells.iter().map(|s| (s.name.as_str(), take(s))).collect(),
            grain: position.facts.as_ref().map_or(0.0, |f| grain(f, position.stated)),
            speed: Vec::new(),
            reach: 1,
            turns: Vec::new(),
            drive_noise: drive.facts.as_ref().map_or(0.0, |f| f.noise),
        };
        track.find_speed();
        track.find_turns();
        Some(track)
    }

    /// Widens the reach until the grain of the position is a hundredth of the fastest speed.
    fn find_speed(&mut self) {
        let most = (self.time.len() / 8).clamp(1, 32);
        for reach in [1, 2, 4, 8, 16, 32] {
            if reach > most {
                break;
            }
            self.reach = reach;
            self.speed = self.speed_over(reach);
            if self.resolution() <= 0.01 * self.fast() {
                break;
            }
        }
    }

    fn speed_over(&self, reach: usize) -> Vec<f64> {
        let last = self.time.len() - 1;
        let at = |i: usize| {
            let (a, b) = (i.saturating_sub(reach), (i + reach).min(last));
            (self.position[b] - self.position[a]) / (self.time[b] - self.time[a])
        };
        (0..=last).map(at).collect()
    }

    /// The speed that can be told from rest.
    pub(super) fn resolution(&self) -> f64 {
        self.grain / (2.0 * self.reach as f64 * self.step)
    }

    fn fast(&self) -> f64 {
        quantile(&mut self.speed.iter().map(|v| v.abs()).collect::<Vec<f64>>(), 0.99)
    }

    /// The speed below which the motion counts as rest.
    pub(super) fn rest(&self) -> f64 {
        self.resolution().max(REST * self.fast())
    }

    /// The speeds of the samples that move.
    pub(super) fn moving(&self) -> Vec<f64> {
        let rest = self.rest();
        self.speed.iter().copied().filter(|v| v.abs() > rest).collect()
    }

    /// Where the position has come back from an extreme by more than its grain and noise.
    fn find_turns(&mut self) {
        let range = self.range();
        let back = (3.0 * self.grain).max(1e-4 * range);
        let (mut low, mut high) = (0, 0);
        let mut rising: Option<bool> = None;
        for (i, q) in self.position.iter().enumerate() {
            if *q > self.position[high] {
                high = i;
            }
            if *q < self.position[low] {
                low = i;
            }
            if rising != Some(false) && self.position[high] - q > back {
                if rising.is_some() {
                    self.turns.push(high);
                }
                (rising, low) = (Some(false), i);
            } else if rising != Some(true) && q - self.position[low] > back {
                if rising.is_some() {
                    self.turns.push(low);
                }
                (rising, high) = (Some(true), i);
            }
        }
    }

    /// How far apart the extremes of the position are.
    pub(super) fn range(&self) -> f64 {
        let (low, high) = self
            .position
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), q| (l.min(*q), h.max(*q)));
        high - low
    }

    /// The fastest acceleration, but for 0.1 %, and the smallest that can be told.
    pub(super) fn acceleration(&self) -> (f64, f64) {
        let mut found = (0.0, f64::INFINITY);
        let most = (self.time.len() / 8).clamp(1, 32);
        for reach in [1, 2, 4, 8, 16, 32].into_iter().filter(|r| *r <= most) {
            let over = reach as f64 * self.step;
            let second = self.position.windows(2 * reach + 1);
            let size = |w: &[f64]| (w[2 * reach] - 2.0 * w[reach] + w[0]).abs() / (over * over);
            let fastest = quantile(&mut second.map(size).collect::<Vec<f64>>(), 0.999);
            found = (fastest, 2.0 * self.grain / (over * over));
            if found.1 <= 0.2 * found.0 {
                break;
            }
        }
        found
    }

    /// The motion in numbers.
    pub(super) fn motion(&self) -> Motion {
        let mut moving: Vec<f64> = self.moving().iter().map(|v| v.abs()).collect();
        let swings = self.turns.windows(2).map(|w| self.position[w[1]] - self.position[w[0]]);
        let halves: Vec<f64> = swings.map(|s| 0.5 * s.abs()).collect();
        let smallest = halves.iter().copied().reduce(f64::min).unwrap_or(0.0);
        Motion {
            reversals: self.turns.len(),
            amplitudes: (smallest, halves.iter().copied().fold(0.0, f64::max)),
            at_rest: 1.0 - moving.len() as f64 / self.speed.len() as f64,
            speeds: (quantile(&mut moving, 0.01), quantile(&mut moving, 0.99)),
            resolution: self.resolution(),
        }
    }
}

/// The smallest change that is no noise: the quantum, or three times the noise.
fn grain(facts: &Facts, stated: Option<f64>) -> f64 {
    facts.quantum.unwrap_or(0.0).max(stated.unwrap_or(0.0)).max(3.0 * facts.noise)
}
