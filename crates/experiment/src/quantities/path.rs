//! What is read off a solved plant: extremes, turns, slips, work.

use duhem::sgn;
use simulation::{DrivenPlant, Motion, Path};

/// How long the contact rings after a slip's stop [s]; by then it is at rest.
pub(crate) const RINGING: f64 = 0.2;
/// Parts into which the stretch between two nodes is cut to look for an extreme.
const PARTS: u32 = 4;

/// One slip of a stick-slip motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slip {
    /// Where |v| rises through v_S [s].
    pub(crate) onset: f64,
    /// The first v = 0 after it [s].
    pub(crate) stop: f64,
}

/// A solved plant with its model, to be looked at.
#[derive(Debug)]
pub(crate) struct View<'a> {
    path: &'a Path,
    motion: &'a DrivenPlant,
    /// The Stribeck velocity [m/s], of a model that has one.
    v_s: Option<f64>,
}

impl<'a> View<'a> {
    pub(crate) fn new(path: &'a Path, motion: &'a DrivenPlant, v_s: Option<f64>) -> Self {
        Self { path, motion, v_s }
    }

    pub(crate) fn end(&self) -> f64 {
        self.path.end().map_or(0.0, |(t, _)| t)
    }

    pub(crate) fn q(&self, t: f64) -> f64 {
        self.path.q(t)
    }

    pub(crate) fn v(&self, t: f64) -> f64 {
        self.path.v(t)
    }

    /// The friction force [N].
    pub(crate) fn force(&self, t: f64) -> f64 {
        let mut y = vec![0.0; self.path.states()];
        self.path.state(t, &mut y);
        self.motion.force(t, &y)
    }

    /// The driving force [N].
    pub(crate) fn drive(&self, t: f64) -> f64 {
        self.motion.plant().drive(self.motion.input().u(t))
    }

    /// The largest or the smallest q: at the ends or at a turn.
    pub(crate) fn extreme_q(&self, better: fn(f64, f64) -> f64) -> f64 {
        let ends = [self.path.t().first().copied().unwrap_or(0.0), self.end()];
        let times = self.path.reversals().into_iter().chain(ends);
        times.map(|t| self.q(t)).fold(self.q(ends[0]), better)
    }

    /// The largest v over a span for `side` 1, the smallest for −1.
    pub(crate) fn extreme_v(&self, span: (f64, f64), side: f64) -> f64 {
        self.extreme(span, side, |t| self.v(t))
    }

    /// The same of the friction force.
    pub(crate) fn extreme_f(&self, span: (f64, f64), side: f64) -> f64 {
        self.extreme(span, side, |t| self.force(t))
    }

    /// The largest value over a span for `side` 1, the smallest for −1.
    pub(crate) fn extreme(&self, span: (f64, f64), side: f64, of: impl Fn(f64) -> f64) -> f64 {
        let found = self.path.largest(span, |t| side * of(t));
        side * found.map_or_else(|| side * of(span.0), |(_, largest)| largest)
    }

    /// The nodes of a span with points between them.
    fn grid(&self, (from, to): (f64, f64)) -> Vec<f64> {
        let nodes = self.path.t();
        let inside =
            &nodes[nodes.partition_point(|t| *t <= from)..nodes.partition_point(|t| *t < to)];
        let ends: Vec<f64> = [from].into_iter().chain(inside.iter().copied()).chain([to]).collect();
        let between = |pair: &[f64]| {
            let (a, b) = (pair[0], pair[1]);
            (0..PARTS)
                .map(move |i| a + (b - a) * f64::from(i) / f64::from(PARTS))
                .collect::<Vec<_>>()
        };
        ends.windows(2).flat_map(between).chain([to]).collect()
    }

    /// The smallest and the largest value of a function of time on a stretch, at its nodes and its ends; in
    /// the order in which they come.
    pub(crate) fn ends(&self, span: (f64, f64), of: &dyn Fn(f64) -> f64) -> [f64; 2] {
        let grid = self.grid(span);
        let values: Vec<f64> = grid.iter().map(|t| of(*t)).collect();
        let by = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let low = (0..values.len()).min_by(by).unwrap_or(0);
        let high = (0..values.len()).max_by(by).unwrap_or(0);
        [values[low.min(high)], values[low.max(high)]]
    }

    /// The time of the reversal of this number, from 1.
    pub(crate) fn turn(&self, number: f64) -> Result<f64, String> {
        let turns = self.path.reversals();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small number"
        )]
        let found = turns.get((number as usize).wrapping_sub(1)).copied();
        found.ok_or_else(|| format!("there are {} reversals, not {number}", turns.len()))
    }

    /// ∫ drive dq over a span: Simpson's rule on drive · v between nodes.
    pub(crate) fn work(&self, span: (f64, f64)) -> f64 {
        let power = |t: f64| self.drive(t) * self.v(t);
        let simpson = |pair: &[f64]| {
            let (a, b) = (pair[0], pair[1]);
            (b - a) / 6.0 * (power(a) + 4.0 * power(0.5 * (a + b)) + power(b))
        };
        self.grid(span).windows(2).map(simpson).sum()
    }

    /// The slips, in order: |v| rises through v_S, and not because the contact still rings.
    pub(crate) fn slips(&self) -> Result<Vec<Slip>, String> {
        let v_s = self.v_s.ok_or("slips are told by v_S, which the model has not")?;
        let turns = self.path.reversals();
        let mut slips: Vec<Slip> = Vec::new();
        for onset in self.path.onsets(v_s) {
            if slips.last().is_some_and(|s| onset < s.stop + RINGING) {
                continue;
            }
            let next = turns.partition_point(|t| *t <= onset);
            let Some(stop) = turns.get(next) else { break };
            slips.push(Slip { onset, stop: *stop });
        }
        Ok(slips)
    }

    /// The slip of this number, from 1.
    pub(crate) fn slip(&self, number: f64) -> Result<Slip, String> {
        let slips = self.slips()?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small number"
        )]
        let found = slips.get((number as usize).wrapping_sub(1)).copied();
        found.ok_or_else(|| format!("there are {} slips, not {number}", slips.len()))
    }

    /// The share of the second half of the run in which the speed is below `speed` [m/s], at so
    /// many times.
    pub(crate) fn rest_share(&self, speed: f64, looks: u32) -> f64 {
        let half = 0.5 * self.end();
        let at = |i: u32| self.v(half * (1.0 + f64::from(i) / f64::from(looks))).abs();
        (0..=looks).filter(|i| at(*i) < speed).count() as f64 / f64::from(looks + 1)
    }

    /// How often the motion turns while every element slips: all deflections at their deadbands.
    pub(crate) fn full_slips(&self) -> f64 {
        let delta = self.motion.model().scale();
        let mut y = vec![0.0; self.path.states()];
        let mut count = 0.0;
        for turn in self.path.reversals() {
            self.path.state(turn, &mut y);
            let z: Vec<f64> = y[2..].iter().map(|x| y[0] - x).collect();
            let at_limit = |(z, delta): (&f64, &f64)| z.abs() >= delta * (1.0 - 1e-9);
            let one_way = z.iter().all(|other| sgn(*other) == sgn(z[0]));
            if one_way && z.iter().zip(&delta).all(at_limit) {
                count += 1.0;
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::{Slip, View};
    use duhem::{Input, MODELS, Parameters, Plant};
    use simulation::{DrivenPlant, Path};
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    /// A Coulomb contact on a spring under 2 sin(0.5 t) N.
    fn plant() -> DrivenPlant {
        let entry = MODELS.iter().find(|m| m.name == "coulomb").unwrap();
        let model = (entry.build)(&Parameters::from_iter([("f_c", 0.5)])).unwrap();
        let input = Input::sine(2.0, 0.5).unwrap();
        DrivenPlant::new(model, Plant::mass_spring(1.0, 1.0), input, (0.0, TAU))
    }

    /// q = a sin t, with nodes where no extreme is.
    fn sine(a: f64) -> Path {
        let mut path = Path::new(2);
        for i in 0..=700 {
            let t = TAU * f64::from(i) / 700.0;
            path.push(t, &[a * t.sin(), a * t.cos()], &[a * t.cos(), -a * t.sin()]);
        }
        path
    }

    #[test]
    fn extremes_turns_and_work_of_a_sine_are_found() {
        let (path, motion) = (sine(3.0), plant());
        let view = View::new(&path, &motion, None);
        assert!((view.extreme_q(f64::max) - 3.0).abs() < 1e-12);
        assert!((view.extreme_q(f64::min) + 3.0).abs() < 1e-12);
        assert!((view.extreme_v((1.0, 5.0), -1.0) + 3.0).abs() < 1e-9);
        assert!((view.extreme_v((1.0, 2.0), 1.0) - 3.0 * 1.0_f64.cos()).abs() < 1e-9);
        assert!((view.turn(1.0).unwrap() - FRAC_PI_2).abs() < 1e-9, "{:?}", view.turn(1.0));
        assert!((view.turn(2.0).unwrap() - 3.0 * FRAC_PI_2).abs() < 1e-9);
        assert!(view.turn(3.0).is_err() && view.turn(0.0).is_err());
        // ∫ 2 sin(t/2) 3 cos t dt over (0, 2π) = −8.
        assert!((view.work((0.0, TAU)) + 8.0).abs() < 1e-9, "{}", view.work((0.0, TAU)));
        assert!((view.extreme_f((0.1, 1.0), 1.0) - 0.5).abs() < 1e-15);
        assert!((view.drive(PI) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_slip_begins_where_the_speed_rises_through_v_s_and_ends_at_the_next_turn() {
        let (path, motion) = (sine(1.0), plant());
        let view = View::new(&path, &motion, Some(0.5));
        // |cos t| rises through 1/2 at 2π/3 and 5π/3; the second time there is no turn after it.
        let slips = view.slips().unwrap();
        assert_eq!(slips.len(), 1, "{slips:?}");
        let Slip { onset, stop } = slips[0];
        assert!((onset - TAU / 3.0).abs() < 1e-9 && (stop - 3.0 * FRAC_PI_2).abs() < 1e-9);
        assert!(
            View::new(&path, &motion, None).slips().is_err(),
            "without v_S nothing tells a slip"
        );
        // |cos t| is below 1/2 for a third of the time.
        assert!(
            (view.rest_share(0.5, 20_000) - 1.0 / 3.0).abs() < 1e-3,
            "{}",
            view.rest_share(0.5, 20_000)
        );
    }

    #[test]
    fn a_stretch_shows_its_smallest_and_largest_value_in_their_order() {
        let (path, motion) = (sine(1.0), plant());
        let view = View::new(&path, &motion, None);
        let [first, second] = view.ends((0.0, PI), &|t| view.v(t));
        assert!((first - 1.0).abs() < 1e-12 && (second + 1.0).abs() < 1e-12);
    }
}
