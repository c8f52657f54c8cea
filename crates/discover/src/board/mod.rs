//! The blocks of a record, which of them are fitted and which judge.

mod ahead;
mod evidence;
mod loose;
mod mute;
mod near;
mod noises;
mod race;
mod scale;
mod steps;

pub(crate) use ahead::Ahead;
pub(crate) use loose::{OFFSET, loose, loosened, strays, tied};
pub(crate) use steps::{FINE, ROUGH};

use identify::{
    Rig,
    fit::{
        Data, FitError,
        binding::Scale,
        blocks,
        descent::descend,
        models,
        problem::{Piece, Problem, Weights},
        search::Patience,
        starts,
        whitening::Whitening,
        window::Window,
        work::Work,
    },
};
use loose::{DRIVES, LOOSE, prestress};
use noises::noises;
use std::{borrow::Cow, sync::Arc};

/// The record on its blocks.
#[derive(Debug, Clone)]
pub(crate) struct Board<'a> {
    /// The record.
    pub(crate) data: &'a Data,
    /// Its windows, simulated each from its own start; where the motion is imposed the whole record is one run.
    pub(crate) windows: Vec<Window>,
    /// How many windows a block has.
    pub(crate) per_block: usize,
    /// Which of the blocks are fitted.
    pub(crate) trains: Vec<bool>,
    /// The noise of the sensors.
    pub(crate) weights: Weights,
    /// By how much more the force at each sample spreads under an imposed motion, because that is noisy, than to first
    /// order, which is whitened [N].
    pub(crate) spread: Vec<f64>,
    /// What makes the residuals under an imposed motion independent of each other; driven ones' windows have their own.
    pub(crate) whitening: Option<Arc<Whitening>>,
    /// The parameters that are not free but may be a little off: their names and given values.
    pub(crate) loose: Vec<(String, f64)>,
    /// What the steps may be wrong by, of the spans [1].
    pub(crate) tolerance: f64,
    /// What has been simulated for it.
    pub(crate) work: Work,
}

/// A model, fitted on the training blocks.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    /// Its rig with the fitted values.
    pub(crate) rig: Rig,
    /// The variables, in the order of the rig's free parameters.
    pub(crate) x: Vec<f64>,
    /// Every block's motion.
    pub(crate) pieces: Vec<Piece>,
    /// The sum of squared residuals of every block, by channel.
    pub(crate) blocks: Vec<Vec<f64>>,
}

impl Fitted {
    /// Its rig with nothing free.
    pub(crate) fn held(&self) -> Rig {
        Self::holding(&self.rig)
    }

    /// The sum of all squared residuals [1].
    pub(crate) fn sum(&self) -> f64 {
        self.blocks.iter().flatten().sum()
    }

    /// `rig` with nothing free.
    pub(crate) fn holding(rig: &Rig) -> Rig {
        Rig { free: Vec::new(), ..rig.clone() }
    }
}

/// Mean squared residual from which on a window is softened.
pub(crate) const SOFT: f64 = 4.0;

/// The same for the motion along which derivatives are taken.
const SLOPES: f64 = 1e-4;

/// A start is known well if a parabola fits the samples around it but for so many times their noise.
const SMOOTH: f64 = 3.0;

/// The sample around `about` at which the plant has come furthest since it last turned, so that the contact's state
/// there is known, and moves smoothly if it does so anywhere; at most `room` samples away.
fn settled(data: &Data, about: usize, room: usize) -> usize {
    let stride = (room / 6).max(1);
    let end = (about + room + 1).min(data.time.len() - 8);
    let candidates = (about.saturating_sub(room)..end).step_by(stride);
    let far = |i: usize| Window::come(data, i, (i + 16).min(data.time.len())).abs();
    let all: Vec<(f64, usize)> = candidates.map(|i| (far(i), i)).collect();
    let furthest = |smooth: bool| {
        let fits = |i: usize| !smooth || Window::smooth(data, i) < SMOOTH;
        let all = all.iter().filter(|(far, i)| *far > 0.0 && fits(*i));
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, i)| *i)
    };
    furthest(true).or_else(|| furthest(false)).unwrap_or(about)
}

/// The length of a block [s], and at least so many, unless they get shorter than [`SHORTEST`]: where little is seen but the
/// start of a window, which is free, a wrong model does as well as a right one.
const BLOCK: f64 = 1.5;
const LEAST: f64 = 32.0;
const SHORTEST: f64 = 0.6;

/// `rig` with the values of the variables `x`.
fn with_values(rig: &Rig, problem: &Problem<'_>, x: &[f64]) -> Rig {
    let mut rig = rig.clone();
    for (i, free) in problem.free.iter().enumerate() {
        identify::fit::binding::set(&mut rig, &free.name, problem.value(i, x));
    }
    rig
}

/// The record in so many windows, each begun where the plant moves.
fn windows(data: &Data, many: usize) -> Vec<Window> {
    let n = data.time.len();
    let bound = |i: usize| match i {
        0 => 0,
        i if i == many => n,
        i => settled(data, i * n / many, n / many / 4),
    };
    let bounds: Vec<usize> = (0..=many).map(bound).collect();
    let window = |ends: &[usize]| Window::new(data, ends[0], ends[1]).remembering(data);
    bounds.windows(2).map(window).collect()
}

impl<'a> Board<'a> {
    /// The blocks of `data` with so many windows each, weighed by the noise of its channels.
    pub(crate) fn of(
        rig: &Rig,
        data: &'a Data,
        per_block: usize,
        loose: Vec<(String, f64)>,
    ) -> Result<Self, FitError> {
        let weights = Problem::unfree(rig, data)?.weights;
        let duration = data.time[data.time.len() - 1] - data.time[0];
        let length = BLOCK.min((duration / LEAST).max(SHORTEST));
        let blocks = blocks::blocks(data, Some(length));
        let windows = windows(data, blocks.len() * per_block);
        let trains = (0..blocks.len()).map(|k| k.count_ones() % 2 == 0).collect();
        Ok(Self {
            data,
            windows,
            per_block,
            trains,
            weights: noises((rig, data), weights),
            spread: Vec::new(),
            whitening: None,
            loose,
            tolerance: steps::LONGEST,
            work: Work::default(),
        })
    }

    /// The same with so many windows in each block.
    pub(crate) fn cut(&self, per_block: usize) -> Self {
        let windows = windows(self.data, self.trains.len() * per_block);
        Self { windows, per_block, ..self.clone() }
    }

    /// The block of window `w`.
    pub(crate) fn block(&self, w: usize) -> usize {
        w / self.per_block
    }

    /// How many samples each block has.
    pub(crate) fn samples(&self) -> Vec<f64> {
        let mut samples = vec![0.0; self.trains.len()];
        for (w, window) in self.windows.iter().enumerate() {
            samples[self.block(w)] += window.len() as f64;
        }
        samples
    }

    /// Whether the motion is imposed.
    pub(crate) fn imposed(&self) -> bool {
        self.data.force.is_some()
    }

    /// Whether a value is held near the given one.
    pub(crate) fn holds(&self, name: &str) -> bool {
        self.loose.iter().any(|(loose, _)| loose == name)
    }

    /// The problem of `rig` on the blocks that `take` says.
    pub(crate) fn problem<'r>(
        &'r self,
        rig: &'r Rig,
        take: impl Fn(usize) -> bool,
    ) -> Result<Problem<'r>, FitError> {
        let free = !rig.free.is_empty();
        let base =
            if free { Problem::of(rig, self.data)? } else { Problem::unfree(rig, self.data)? };
        let tolerance = self.tolerance;
        // The prior is about the value given in the rig file, wherever the variable is counted from.
        let held = self.loose.iter().filter(|(name, _)| base.free.iter().any(|f| f.name == *name));
        let spread = |name: &str, given: f64| match base.free.iter().find(|f| f.name == name) {
            Some(free) if name == OFFSET => LOOSE * prestress(rig) / free.slope(0.0),
            Some(free) if !matches!(free.scale, Scale::Logarithm(_)) => {
                LOOSE * given / free.slope(given).abs()
            }
            _ => LOOSE,
        };
        let priors: Vec<(String, f64, f64)> =
            held.map(|(name, given)| (name.clone(), *given, spread(name, *given))).collect();
        let spread = Cow::Borrowed(self.spread.as_slice());
        let base = Problem {
            weights: self.weights,
            spread,
            closed_loop: false,
            tolerance,
            slopes: SLOPES,
            bends: true,
            priors,
            work: self.work.clone(),
            ..base
        };
        let taken = self.windows.iter().enumerate().filter(|(w, _)| take(self.block(*w)));
        if !self.imposed() {
            return Ok(Problem { windows: taken.map(|(_, w)| w.clone()).collect(), ..base });
        }
        let mut shares = vec![0.0; self.data.time.len()];
        for (_, window) in taken {
            shares[window.first..window.end].fill(1.0);
        }
        let windows = base.windows.iter().map(|window| {
            let whitening = self.whitening.clone();
            Window { whitening, ..window.clone() }
        });
        Ok(Problem { windows: windows.collect(), shares, ..base })
    }

    /// Fits `rig` on the training blocks from `x` and the `pieces` of all blocks, or from its own values.
    pub(crate) fn fit(
        &self,
        rig: &Rig,
        from: Option<(&[f64], &[Piece])>,
        patience: &Patience,
    ) -> Result<Fitted, FitError> {
        let problem = self.problem(rig, |k| self.trains[k])?;
        // A driven motion's windows are worth their logarithms in the search itself.
        let shares = match from {
            Some((_, [piece])) if self.imposed() => self.softened(&problem.shares, piece),
            _ => problem.shares,
        };
        let problem = Problem { shares, ..problem };
        if problem.free.is_empty() {
            return self.judged(rig, from.map(|(_, pieces)| pieces));
        }
        let x = from.map_or_else(|| starts::nominal(&problem), |(x, _)| x.to_vec());
        let trains = |w: usize| self.imposed() || self.trains[self.block(w)];
        let trained: Option<Vec<Piece>> = from.map(|(_, pieces)| {
            let all = pieces.iter().enumerate().filter(|(w, _)| trains(*w));
            all.map(|(_, p)| p.clone()).collect()
        });
        let found = descend(&problem, (&x, trained.as_deref()), patience);
        let rig = with_values(rig, &problem, &found.x);
        let mut found = found.pieces.into_iter();
        let all: Option<Vec<Piece>> = from.and_then(|(_, pieces)| {
            let own =
                |(w, p): (usize, &Piece)| if trains(w) { found.next() } else { Some(p.clone()) };
            pieces.iter().enumerate().map(own).collect()
        });
        self.judged(&rig, all.as_deref())
    }

    /// Fits `rig` from its own values and by way of `short` windows, which come near where long ones meet other minima.
    pub(crate) fn refit(
        &self,
        rig: &Rig,
        short: Option<&Board<'_>>,
        patience: &Patience,
    ) -> Result<Fitted, FitError> {
        let Some(short) = short else { return self.fit(rig, None, patience) };
        let problem = short.problem(rig, |k| short.trains[k])?;
        if problem.free.is_empty() {
            return self.judged(rig, None);
        }
        let found = descend(&problem, (&starts::nominal(&problem), None), patience);
        self.fit(&with_values(rig, &problem, &found.x), None, patience)
    }

    /// The shares of an imposed motion's residuals, less by what a model still leaves of each window: one that is far off,
    /// for whatever reason, must not decide over all others, and every window is worth its logarithm.
    fn softened(&self, shares: &[f64], piece: &Piece) -> Vec<f64> {
        let mut shares = shares.to_vec();
        for window in &self.windows {
            let rows = &piece.residuals[window.first..window.end];
            let mean = rows.iter().map(|r| r * r).sum::<f64>() / rows.len().max(1) as f64;
            if mean.is_finite() && mean > SOFT {
                for share in &mut shares[window.first..window.end] {
                    *share /= mean.sqrt();
                }
            }
        }
        shares
    }

    /// A fitted model once more, as the board now weighs it, nothing moved but the starts.
    pub(crate) fn again(&self, fitted: &Fitted) -> Result<Fitted, FitError> {
        self.judged(&fitted.rig, Some(&fitted.pieces))
    }

    /// Counts the noise of the input anew, on its way through this model.
    pub(crate) fn refloor(&mut self, fitted: &Fitted, seed: u64) -> Result<(), FitError> {
        if self.imposed() {
            let floor = crate::floor::imposed(self, fitted, seed)?;
            (self.spread, self.whitening) = (floor.spread, floor.whitening);
            return Ok(());
        }
        let all = crate::floor::whitened(self, fitted)?;
        for (window, whitening) in self.windows.iter_mut().zip(all) {
            window.whitening = whitening;
        }
        Ok(())
    }

    /// The logarithms of the sums of squares on the training blocks.
    pub(crate) fn trained(&self, fitted: &Fitted) -> f64 {
        let trained = fitted.blocks.iter().zip(&self.trains).filter(|(_, trains)| **trains);
        trained.map(|(block, _)| block.iter().sum::<f64>().max(f64::MIN_POSITIVE).ln()).sum()
    }

    /// The model `rig` on every block, its windows begun where they did in `pieces` of a model nearby.
    pub(crate) fn judged(&self, rig: &Rig, pieces: Option<&[Piece]>) -> Result<Fitted, FitError> {
        let held = Fitted::holding(rig);
        let problem = self.problem(&held, |_| true)?;
        let most = if pieces.is_some() { 3 } else { 8 };
        let pieces = models::converged(&problem, &[], pieces, most);
        let pieces = models::rescued(&problem, &[], pieces);
        let blocks = self.sums(&problem, &[], &pieces);
        // The variables are counted from the values that the rig has.
        let x = starts::nominal(&self.problem(rig, |_| true)?);
        Ok(Fitted { rig: rig.clone(), x, pieces, blocks })
    }

    /// The residuals of window `w` in so many channels, sample by sample.
    fn own<'p>(&self, pieces: &'p [Piece], w: usize, channels: usize) -> &'p [f64] {
        let window = &self.windows[w];
        if self.imposed() {
            return &pieces[0].residuals[window.first..window.end];
        }
        &pieces[w].residuals[..window.len() * channels]
    }

    /// The sums of squared residuals, by block and channel; those of the load cells last.
    pub(crate) fn sums(&self, problem: &Problem<'_>, x: &[f64], pieces: &[Piece]) -> Vec<Vec<f64>> {
        let channels = problem.channels();
        let loads = problem.cells(x).0;
        let samples: usize = self.windows.iter().map(Window::len).sum();
        let first = self.windows.first().map_or(0, |w| w.first);
        let one = |k: usize| {
            let window = &self.windows[k];
            let rows = self.own(pieces, k, channels);
            let mut sums = vec![0.0; channels];
            for (i, r) in rows.iter().enumerate() {
                sums[i % channels] += r * r;
            }
            sums[0] += self.mute(k);
            if !loads.is_empty() {
                for cell in 0..2 {
                    let from = cell * samples + window.first - first;
                    sums.push(loads[from..from + window.len()].iter().map(|r| r * r).sum());
                }
            }
            sums
        };
        let mut blocks: Vec<Vec<f64>> = vec![Vec::new(); self.trains.len()];
        for w in 0..self.windows.len() {
            let sums = one(w);
            let block = &mut blocks[self.block(w)];
            block.resize(sums.len(), 0.0);
            for (block, sum) in block.iter_mut().zip(sums) {
                *block += sum;
            }
        }
        blocks
    }
}
