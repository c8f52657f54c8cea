//! One stage: the velocity for which force and momentum balance.

use super::{Dual, Model, Real, plant::Stage};

/// Where a stage starts from: the states it would have if nothing happened in its own share of the step.
#[derive(Debug, Clone)]
pub(super) struct Base<D> {
    /// Displacement [m].
    pub(super) q: D,
    /// Velocity [m/s].
    pub(super) v: D,
    /// States of the contact.
    pub(super) z: Vec<D>,
}

/// The momentum [N·s] that is left over at the velocity `v`: M(v − v_b) − γh (T − F); writes the states. Coulomb
/// friction slides in the direction `way`, or is left out if that is 0.
pub(super) fn excess<D: Real>(
    model: &Model<D>,
    base: &Base<D>,
    stage: &Stage<D>,
    (v, way): (D, f64),
    z: &mut [D],
) -> D {
    let force = model.force(stage, &base.z, (base.q + v * stage.dt, v, way), z);
    stage.mass * (v - base.v) - force * stage.dt
}

/// How the velocity of a stage is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seek {
    /// Where to begin [m/s].
    pub(super) guess: f64,
    /// A Newton step so short is the last one [m/s], if none below the last digits comes before.
    pub(super) close: f64,
    /// The direction in which Coulomb friction is to slide, whatever the velocity; its own if not given.
    pub(super) way: Option<f64>,
}

/// The velocity of a stage [m/s] and the direction in which it slides, 0 where Coulomb friction holds it; none
/// if there is no finite one. The states at that velocity go to `z`: those where it was looked for last, moved along
/// their slopes.
pub(super) fn velocity(
    model: &Model<Dual<1>>,
    base: &Base<Dual<1>>,
    stage: &Stage<Dual<1>>,
    seek: Seek,
    z: &mut [Dual<1>],
) -> Option<(f64, f64)> {
    let mut last = 0.0;
    let found = sought(seek, model.sticks(), |v, way| {
        last = v;
        let g = excess(model, base, stage, (Dual::variable(v, 0), way), z);
        (g.re, g.eps[0])
    });
    let (v, _) = found?;
    for z in z {
        z.re += z.eps[0] * (v - last);
    }
    found
}

/// Where the excess `at` a velocity and a direction vanishes, and in which direction; 0 where friction that `sticks` holds.
fn sought(
    seek: Seek,
    sticks: bool,
    mut at: impl FnMut(f64, f64) -> (f64, f64),
) -> Option<(f64, f64)> {
    if !sticks {
        return root(|v| at(v, 0.0), seek, None).map(|v| (v, v.signum()));
    }
    if let Some(way) = seek.way {
        return root(|v| at(v, way), seek, None).map(|v| (v, way));
    }
    // The excess grows with v: where it is negative at rest although friction holds against it, the plant slides forth, and
    // where it is positive, back. It is the likelier way that is asked first, for then the other is none.
    let likely = if seek.guess < 0.0 { -1.0 } else { 1.0 };
    let mut holds = |side: f64| side * at(0.0, side).0 >= 0.0;
    let side = if !holds(likely) {
        likely
    } else if !holds(-likely) {
        -likely
    } else {
        return Some((0.0, 0.0));
    };
    let guess = if seek.guess * side > 0.0 { seek.guess } else { 0.0 };
    root(|v| at(v, side), Seek { guess, ..seek }, Some(side)).map(|v| (v, side))
}

/// The step of Newton's method after which there is no other, of the velocity.
const CLOSE: f64 = 1e-10;

/// Where an increasing function vanishes, by Newton's method inside a bracket that closes.
///
/// LuGre's excess may fall in the Stribeck zone; then it is the root that Newton's method or the bracket
/// meets first, and the step's error estimate that judges it.
fn root(
    mut f: impl FnMut(f64) -> (f64, f64),
    Seek { guess, close, .. }: Seek,
    side: Option<f64>,
) -> Option<f64> {
    let mut low = if side.is_some_and(|s| s > 0.0) { 0.0 } else { f64::NEG_INFINITY };
    let mut high = if side.is_some_and(|s| s < 0.0) { 0.0 } else { f64::INFINITY };
    let mut v = guess;
    let mut last = f64::INFINITY;
    for _ in 0..200 {
        let (value, slope) = f(v);
        if !value.is_finite() || !slope.is_finite() {
            return None;
        }
        if value == 0.0 {
            return Some(v);
        }
        if value > 0.0 {
            high = v;
        } else {
            low = v;
        }
        let step = -value / slope;
        let mut next = v + step;
        // A Newton step of a ten-thousand-millionth leaves an error of its square; and near rest, where the
        // last digits of the forces are many of the velocity's, there is nothing more to gain.
        if step.abs() <= (CLOSE * v.abs()).max(close) {
            return Some(next.clamp(low, high));
        }
        let inside = next > low && next < high;
        if !inside || (step.abs() > 0.5 * last && high - low < f64::INFINITY) {
            if high - low == f64::INFINITY {
                // Away from the bracket's end, further each time.
                let away = 2.0 * (v - guess).abs() + step.abs().min(1e150) + f64::MIN_POSITIVE;
                next = v - value.signum() * away;
            } else {
                next = 0.5 * (low + high);
            }
        }
        if (next - v).abs() <= CLOSE * v.abs() || next == v {
            return Some(next);
        }
        last = (next - v).abs();
        v = next;
    }
    Some(v)
}
