//! Inputs of piecewise constant velocity: samples and staircases.

use super::error::{InputError, all_finite, positive};

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Polyline {
    t: Vec<f64>,
    u: Vec<f64>,
}

impl Polyline {
    pub(super) fn new(t: Vec<f64>, u: Vec<f64>) -> Result<Self, InputError> {
        if t.len() < 2 {
            let expected = "at least 2".to_owned();
            return Err(InputError::Length { key: "t", found: t.len(), expected });
        }
        if t.len() != u.len() {
            let expected = format!("{}, as many as t", t.len());
            return Err(InputError::Length { key: "u", found: u.len(), expected });
        }
        all_finite("t", &t)?;
        all_finite("u", &u)?;
        match (1..t.len()).find(|i| t[*i] <= t[i - 1]) {
            Some(index) => Err(InputError::Order { index, found: t[index], before: t[index - 1] }),
            None => Ok(Self { t, u }),
        }
    }

    pub(super) fn staircase(levels: Vec<f64>, rise: f64, hold: f64) -> Result<Self, InputError> {
        if levels.is_empty() {
            let expected = "at least 1".to_owned();
            return Err(InputError::Length { key: "levels", found: 0, expected });
        }
        all_finite("levels", &levels)?;
        positive("rise_time", rise, "a positive, finite time [s]")?;
        positive("hold_time", hold, "a positive, finite time [s]")?;
        let starts = (0..levels.len()).map(|i| i as f64 * (rise + hold));
        let t = starts.flat_map(|start| [start, start + hold]).collect();
        Self::new(t, levels.into_iter().flat_map(|level| [level, level]).collect())
    }

    pub(super) fn u(&self, t: f64) -> f64 {
        let last = self.t.len() - 1;
        match self.piece(t) {
            0 => self.u[0],
            after if after > last => self.u[last],
            k => {
                let part = (t - self.t[k - 1]) / (self.t[k] - self.t[k - 1]);
                self.u[k - 1] + (self.u[k] - self.u[k - 1]) * part
            }
        }
    }

    pub(super) fn u_dot(&self, t: f64) -> f64 {
        self.slope(self.piece(t))
    }

    pub(super) fn range(&self) -> (f64, f64) {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        self.u.iter().fold(ends, |(low, high), u| (low.min(*u), high.max(*u)))
    }

    /// The samples where the slope changes.
    pub(super) fn corners(&self) -> Vec<f64> {
        let changes = (0..self.t.len()).filter(|k| self.slope(*k) != self.slope(k + 1));
        changes.map(|k| self.t[k]).collect()
    }

    /// Piece k ends at sample k; piece 0 lies before the first sample.
    fn piece(&self, t: f64) -> usize {
        self.t.partition_point(|sample| *sample <= t)
    }

    fn slope(&self, piece: usize) -> f64 {
        if piece == 0 || piece == self.t.len() {
            return 0.0;
        }
        (self.u[piece] - self.u[piece - 1]) / (self.t[piece] - self.t[piece - 1])
    }
}
