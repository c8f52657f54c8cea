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

#[cfg(test)]
mod tests {
    use super::Band;
    use crate::{
        Hold, Rig,
        fit::{
            Data, Seen,
            problem::{Problem, Weights},
            window::{START, Window},
        },
    };

    /// A mass of 1 kg with a drag in which it comes to its speed in 2 ms, far less than a sample.
    const QUICK: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 20.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 500.0\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n\
        velocity = \"v\"\n";

    #[test]
    fn noise_hangs_together_where_all_of_a_window_is_in_the_band() {
        let rig = Rig::parse(QUICK).unwrap();
        let time: Vec<f64> = (0..100).map(|i| 0.005 * f64::from(i)).collect();
        let wave = || time.iter().map(|t| (20.0 * t).sin()).collect::<Vec<f64>>();
        let seen = |name: &str| Seen::new(name, wave(), 0.0);
        let driven = Data::driven(time.clone(), wave(), Hold::Linear, seen("position"));
        let driven = Data { velocity: Some(seen("velocity")), ..driven };
        let white = |band: Option<Band>| {
            let data = Data { band, ..driven.clone() };
            let weights = Weights {
                displacement: 1e-5,
                velocity: 4e-4,
                input: 1.0,
                force: 1.0,
                loads: [1.0; 2],
            };
            let problem = Problem { weights, ..Problem::unfree(&rig, &data).unwrap() };
            let window = Window::new(&data, 20, 80);
            let piece = problem.piece(&[], &window, [0.0; START]);
            let whitening = problem.whitening(&[], (&window, &piece), 0.5).unwrap();
            let mut rows = vec![1.0; 120];
            whitening.apply(&mut rows);
            rows
        };
        let outside = |i: usize| {
            let mut inside = vec![true; 100];
            inside[i] = false;
            white(Some(Band { edge: 0.2, inside }))
        };
        assert_eq!(outside(50), white(None));
        assert_ne!(outside(90), white(None));
    }
}
