//! Variation of constants over one panel of time, by Gauss quadrature of eight points.

use crate::{LuGre, closed_form::Arcs};

/// Nodes and weights on [−1, 1], mirrored.
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// ∫ f dt from `start` to `end`.
pub(super) fn gauss((start, end): (f64, f64), mut f: impl FnMut(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let pairs = NODES.iter().map(|(node, weight)| {
        let offset = node * half;
        weight * (f(middle - offset) + f(middle + offset))
    });
    half * pairs.sum::<f64>()
}

/// The deflection at `end` from `x` at `start`, both within the arc `k`:
/// x e^(−Λ(start, end)) + ∫ e^(−Λ(t, end)) u̇ dt, with Λ the integral of |u̇|/r(u̇).
pub(super) fn advance(
    lugre: &LuGre,
    (arcs, k): (&Arcs, usize),
    x: f64,
    (start, end): (f64, f64),
) -> f64 {
    let rate = |t: f64| {
        let u_dot = arcs.velocity(k, t);
        u_dot.abs() / lugre.r(u_dot)
    };
    let decay = |from: f64| (-gauss((from, end), rate)).exp();
    decay(start) * x + gauss((start, end), |t| decay(t) * arcs.velocity(k, t))
}

/// How many panels of equal time make arc `k` smooth in each: the travel is a fraction of the shortest
/// r, the change of velocity a fraction of v_S.
pub(super) fn count(lugre: &LuGre, arcs: &Arcs, k: usize) -> f64 {
    let shortest = lugre.f_c.min(lugre.f_s) / lugre.sigma_0;
    let (start, end) = arcs.ends(k);
    let at = |part: f64| arcs.velocity(k, start + part * (end - start)).abs();
    let fastest = (0..=8).map(|i| at(f64::from(i) / 8.0)).fold(0.0, f64::max);
    let by_travel = 1.5 * fastest * (end - start) / shortest;
    let by_velocity = 8.0 * fastest / lugre.v_s;
    by_travel.max(by_velocity).max(4.0).ceil()
}
