//! The friction force under an imposed motion: no equation of motion, the displacement does all.

use crate::march::{Contact, Model, Real};

/// Calls `see(i, F)` with the friction force [N] at every sample of the displacement `u` [m] at `time` [s].
///
/// Between samples the velocity is constant, and every model has its exact answer; the velocity at a sample,
/// on which the force depends besides, is that of the parabola through it and its neighbours. The contact
/// starts with the force that was `seen` first.
pub(super) fn forces<D: Real>(
    model: &Model<D>,
    time: &[f64],
    u: &[f64],
    seen: f64,
    see: &mut dyn FnMut(usize, D),
) {
    let velocity = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(u.len() - 1));
        if before == after { 0.0 } else { (u[after] - u[before]) / (time[after] - time[before]) }
    };
    let viscous = |i: usize| model.sigma_2 * velocity(i) + model.offset;
    let mut z = model.contact.holding(-viscous(0) + seen);
    let mut direction = 0.0;
    for i in 0..u.len() {
        if i > 0 {
            let step = u[i] - u[i - 1];
            slide(&model.contact, &mut z, step, step / (time[i] - time[i - 1]));
            if step != 0.0 {
                direction = step.signum();
            }
        }
        see(i, force(&model.contact, &z, velocity(i), direction) + viscous(i));
    }
}

/// The states after the displacement has moved by `step` [m] at constant `speed` [m/s].
fn slide<D: Real>(contact: &Contact<D>, z: &mut [D], step: f64, speed: f64) {
    if step == 0.0 {
        return;
    }
    match contact {
        Contact::None | Contact::Coulomb { .. } => {}
        Contact::LuGre { f_c, f_s, v_s, sigma_0, .. } => {
            let s = v_s.recip() * speed;
            let r = (*f_c + (*f_s - *f_c) * (-s * s).exp()) / *sigma_0;
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
fn force<D: Real>(contact: &Contact<D>, z: &[D], v: f64, direction: f64) -> D {
    match contact {
        Contact::None => D::from(0.0),
        Contact::Coulomb { f_c } => *f_c * direction,
        Contact::Dahl { .. } => z[0],
        Contact::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } => {
            let s = v_s.recip() * v;
            let r = (*f_c + (*f_s - *f_c) * (-s * s).exp()) / *sigma_0;
            *sigma_0 * z[0] + *sigma_1 * (-z[0] / r * v.abs() + v)
        }
        Contact::MaxwellSlip { k, .. } => {
            k.iter().zip(z).fold(D::from(0.0), |sum, (k, z)| sum + *k * *z)
        }
    }
}
