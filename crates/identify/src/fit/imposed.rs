//! The friction force under an imposed motion: no equation of motion, the displacement does all.

use crate::{
    effects::{Act, At},
    march::{Contact, Model, Real, deflection},
};

/// Calls `see(i, F)` with the friction force [N] at every sample of the displacement `u` [m] at `time` [s].
///
/// Between samples the displacement follows the cubic through the four samples around it, in pieces of constant
/// velocity, on which every model has its exact answer; the velocity at a sample, on which the force depends
/// besides, is that of the quartic through it and its neighbours. The contact starts with the force that was
/// `seen` first.
pub(super) fn forces<D: Real>(
    model: &Model<D>,
    time: &[f64],
    u: &[f64],
    seen: f64,
    see: &mut dyn FnMut(usize, D),
) {
    let corners = corners(u);
    let velocity = |i: usize| velocity(time, (u, &corners), i);
    let viscous = |i: usize| model.sigma_2 * velocity(i) + model.offset;
    let mut z = model.contact.holding(-viscous(0) + seen);
    let mut direction = 0.0;
    let mut aged = model.effects_from(0.0, &[]);
    for i in 0..u.len() {
        let mut act = Act::none();
        let dt = if i > 0 { time[i] - time[i - 1] } else { 0.0 };
        let step = if i > 0 { u[i] - u[i - 1] } else { 0.0 };
        let base = aged.clone();
        let before = z.clone();
        let motion = (u[i], step / dt.max(f64::MIN_POSITIVE));
        let now = at(model, (time[i], dt), motion, &before);
        if !model.effects.is_empty() {
            act = model.acts(&now, &base, &mut aged);
        }
        if i > 0 {
            let mut last = u[i - 1];
            for piece in 1..=PIECES {
                let share = piece as f64 / PIECES as f64;
                let next = if piece == PIECES { u[i] } else { between((u, &corners), i, share) };
                slide(
                    &model.contact,
                    &mut z,
                    next - last,
                    ((next - last) * PIECES as f64 / dt, act.rise),
                );
                last = next;
            }
            if velocity(i) != 0.0 {
                direction = velocity(i).signum();
            }
        }
        if !model.effects.is_empty() {
            // What depends on the velocity depends on that of the sample, what slides on that of the step.
            let now = At { v: D::from(velocity(i)), dt: 0.0, ..now };
            let here = model.acts(&now, &aged, &mut base.clone());
            act = Act { force: here.force, more: here.more, rise: here.rise, ..act };
            act.risen(|| model.contact.level(), model.contact.bristles());
        }
        let own = force(&model.contact, &z, (velocity(i), act.rise), direction);
        let sign = own.re().partial_cmp(&0.0).map_or(0.0, |order| f64::from(order as i8));
        let grown = own + own * (act.more + act.skew * sign) + act.dry * direction;
        see(i, grown + act.force + viscous(i));
    }
}

/// Samples that are this evenly spaced tell the velocity to fourth order [of the sampling time].
const EVEN: f64 = 1e-3;

/// A second difference so many times as large as those around it is a corner.
const SHARP: f64 = 8.0;

/// Whether the displacement `u` has a corner at each sample: its second difference stands out from those two and three
/// samples away. No smooth curve is led across it.
pub fn corners(u: &[f64]) -> Vec<bool> {
    let bend = |i: usize| match (i.checked_sub(1), u.get(i + 1)) {
        (Some(before), Some(after)) => (after - 2.0 * u[i] + u[before]).abs(),
        _ => 0.0,
    };
    let around = |i: usize| {
        let far = [2, 3].into_iter().flat_map(|k| [i.checked_sub(k), Some(i + k)]);
        far.flatten().map(bend).fold(0.0, f64::max)
    };
    (0..u.len()).map(|i| bend(i) > SHARP * around(i) && bend(i) > 0.0).collect()
}

/// The velocity [m/s] at sample `i`: of the quartic through five samples, or of the parabola through three where they
/// are too few, not evenly spaced, or a corner is among them; next to a corner, of the line on this side of it.
fn velocity(time: &[f64], (u, corners): (&[f64], &[bool]), i: usize) -> f64 {
    let (mut before, mut after) = (i.saturating_sub(1), (i + 1).min(u.len() - 1));
    if corners[after] && !corners[before] && i > before {
        after = i;
    } else if corners[before] && !corners[after] && after > i {
        before = i;
    }
    if before == after {
        return 0.0;
    }
    let near = (u[after] - u[before]) / (time[after] - time[before]);
    if i < 2 || i + 2 >= u.len() || after - before != 2 {
        return near;
    }
    let (far, wide) = (time[i + 2] - time[i - 2], time[after] - time[before]);
    if (far - 2.0 * wide).abs() > EVEN * wide || corners[i - 1..i + 2].contains(&true) {
        return near;
    }
    (4.0 * near - (u[i + 2] - u[i - 2]) / far) / 3.0
}

/// The pieces of constant velocity from sample to sample.
const PIECES: usize = 4;

/// The displacement at a `share` of the way from sample `i − 1` to `i`, by the cubic through four samples; the way is
/// straight at the ends of a record, next to a corner, and where nothing moves.
fn between((u, corners): (&[f64], &[bool]), i: usize, share: f64) -> f64 {
    let (a, b) = (u[i - 1], u[i]);
    let straight = a + (b - a) * share;
    if i < 2 || i + 1 >= u.len() || a == b || corners[i] || corners[i - 1] {
        return straight;
    }
    let (before, after) = (u[i - 2], u[i + 1]);
    // Newton's form: second differences on both sides.
    let (left, right) = (before - 2.0 * a + b, a - 2.0 * b + after);
    let bend = share * (share - 1.0) / 6.0;
    straight + bend * ((2.0 - share) * left + (1.0 + share) * right)
}

/// The instant as a law sees it, the contact's states being `z`.
fn at<'a, D: Real>(
    model: &'a Model<D>,
    (t, dt): (f64, f64),
    (q, v): (f64, f64),
    z: &'a [D],
) -> At<'a, D> {
    At {
        t,
        dt,
        drive: D::from(0.0),
        q: D::from(q),
        v: D::from(v),
        radius: 1.0,
        contact: (&model.contact, z),
        balance: &model.balance,
        mass: model.balance.mass,
    }
}

/// The states after the displacement has moved by `step` [m] at constant `speed` [m/s].
fn slide<D: Real>(contact: &Contact<D>, z: &mut [D], step: f64, (speed, rise): (f64, D)) {
    if step == 0.0 {
        return;
    }
    match contact {
        Contact::None | Contact::Coulomb { .. } => {}
        Contact::LuGre { f_c, f_s, v_s, sigma_0, .. } => {
            let s = v_s.recip() * speed;
            let r = deflection([*f_c, *f_s, *sigma_0], s) + rise / *sigma_0;
            let end = r * step.signum();
            z[0] = end + (z[0] - end) * (-r.recip() * step.abs()).exp();
        }
        Contact::Dahl { f_c, sigma, gamma } => {
            let end = *f_c * step.signum();
            let w = -z[0] / end + 1.0;
            z[0] = end * (-decayed(w, *sigma * step.abs() / *f_c, *gamma) + 1.0);
        }
        Contact::MaxwellSlip { delta, .. } => {
            for (z, delta) in z.iter_mut().zip(delta) {
                let next = *z + step;
                *z = if next.re() > delta.re() {
                    *delta
                } else if next.re() < -delta.re() {
                    -*delta
                } else {
                    next
                };
            }
        }
    }
}

/// w after the `path` σ|Δu|/F_C, from dw/dpath = −|w|^γ sgn w: |w|^(1−γ) falls by (1 − γ) path, down to zero
/// for γ < 1.
fn decayed<D: Real>(w: D, path: D, gamma: D) -> D {
    if w.re() == 0.0 {
        return D::from(0.0);
    }
    let (sign, p) = (w.re().signum(), -gamma + 1.0);
    let size = w * sign;
    // Near γ = 1 the power is the exponential to the last digits, and its derivative by γ is its limit's.
    if p.re().abs() < 1e-7 {
        let log = size.ln();
        return size * (-path).exp() * (p * path * (log - path * 0.5) + 1.0) * sign;
    }
    let left = (size.ln() * p).exp() - p * path;
    if left.re() <= 0.0 {
        return D::from(0.0);
    }
    (left.ln() / p).exp() * sign
}

/// The force [N] without the viscous part; `direction` is that of the last motion.
fn force<D: Real>(contact: &Contact<D>, z: &[D], (v, rise): (f64, D), direction: f64) -> D {
    match contact {
        Contact::None => D::from(0.0),
        Contact::Coulomb { f_c } => *f_c * direction,
        Contact::Dahl { .. } => z[0],
        Contact::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } => {
            let s = v_s.recip() * v;
            let r = deflection([*f_c, *f_s, *sigma_0], s) + rise / *sigma_0;
            *sigma_0 * z[0] + *sigma_1 * (-z[0] / r * v.abs() + v)
        }
        Contact::MaxwellSlip { k, .. } => {
            k.iter().zip(z).fold(D::from(0.0), |sum, (k, z)| sum + *k * *z)
        }
    }
}
