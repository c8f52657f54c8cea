//! The noise of an input that was cut to its band: it hangs together from sample to sample.

use super::{
    data::{Band, Data},
    window::Window,
};

/// How the errors of an input hang together from sample to sample: e_k = a_1 e_{k−1} + a_2 e_{k−2} + b w, with w white.
pub(super) struct Colour {
    /// Their a_1 and a_2 [1].
    pub(super) by: [f64; 2],
    /// The b [the input's unit].
    pub(super) new: f64,
}

impl Colour {
    /// White where all of the noise is there, and else as dense as that below the edge of its band, above which it falls with the
    /// fourth power of the frequency, as Butterworth's second-order filter has it.
    pub(super) fn of(data: &Data, window: &Window, noise: f64) -> Self {
        let inside =
            |band: &&Band| band.inside[window.first..window.end].iter().all(|inside| *inside);
        let Some(band) = data.band.as_ref().filter(inside) else {
            return Self { by: [0.0; 2], new: noise };
        };
        Self::within(band, noise)
    }

    /// That of all that is left in a band of white `noise`.
    pub(super) fn within(band: &Band, noise: f64) -> Self {
        // The poles e^{ω(−1 ± i)/√2}.
        let part = band.edge / 2f64.sqrt();
        let by = [2.0 * (-part).exp() * part.cos(), -(-2.0 * part).exp()];
        Self { by, new: noise * (1.0 - by[0] - by[1]) }
    }

    /// How many errors are kept of so many that are.
    pub(super) fn remembers(&self, kept: usize) -> usize {
        if self.by == [0.0; 2] { kept } else { kept.max(2) }
    }

    /// The covariance of two errors so many samples apart.
    pub(super) fn together(&self, apart: usize) -> f64 {
        let [one, two] = self.by;
        let own =
            self.new * self.new * (1.0 - two) / ((1.0 + two) * ((1.0 - two).powi(2) - one * one));
        let mut all = [own, own * one / (1.0 - two)];
        for _ in 0..apart {
            all = [all[1], one * all[1] + two * all[0]];
        }
        all[0]
    }
}
