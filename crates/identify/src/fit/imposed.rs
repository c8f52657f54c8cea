//! The friction force under an imposed motion: no equation of motion, the displacement does all.

use super::displacement::Course;
use crate::{
    effects::{Acts, At},
    march::{Contact, Model, Real, deflection},
};

/// Calls `see(i, F)` with the friction force [N] at every sample of the displacement `u` [m] at `time` [s], of which `course` is the
/// [`Course`].
///
/// Between samples the displacement follows the cubic through the four samples around it, in pieces of constant
/// velocity, on which every model has its exact answer; the velocity at a sample, on which the force depends
/// besides, is that of the quartic through it and its neighbours. The contact starts with the force that was
/// `seen` first.
pub(super) fn forces<D: Real>(
    model: &Model<D>,
    (time, u, course): (&[f64], &[f64], &Course),
    seen: f64,
    see: &mut dyn FnMut(usize, D),
) {
    let mut sliding = Sliding::begun(model, seen, course.velocity[0]);
    for i in 0..u.len() {
        let way = if i > 0 { course.way(i) } else { &[] };
        let velocity = course.velocity[i];
        see(i, sliding.step(&Step { time: near(time, i), u: near(u, i), velocity, way }));
    }
}

/// The value at sample `i` and that before it.
pub(super) fn near(values: &[f64], i: usize) -> [f64; 2] {
    [values[i.saturating_sub(1)], values[i]]
}

/// The way to a sample from that before it; to the first from itself.
pub(super) struct Step<'a> {
    /// The times of both [s].
    pub(super) time: [f64; 2],
    /// Their displacements [m].
    pub(super) u: [f64; 2],
    /// The velocity at the sample [m/s].
    pub(super) velocity: f64,
    /// The pieces of constant velocity: where each ends [m], and its velocity [m/s].
    pub(super) way: &'a [(f64, f64)],
}

/// What slides, and what it remembers from sample to sample.
#[derive(Debug, Clone)]
pub(super) struct Sliding<'a, D> {
    model: &'a Model<D>,
    /// The contact's states.
    z: Vec<D>,
    /// Those of the effects.
    aged: Vec<D>,
    /// The direction of the last motion.
    direction: f64,
    /// The states at the beginning of a step, and room for others.
    base: Vec<D>,
    before: Vec<D>,
    other: Vec<D>,
}

impl<'a, D: Real> Sliding<'a, D> {
    /// With the force [N] that is `seen` at the first sample, at the velocity `v` [m/s].
    pub(super) fn begun(model: &'a Model<D>, seen: f64, v: f64) -> Self {
        let viscous = model.sigma_2 * v + model.offset;
        let z = model.contact.holding(begun(&model.contact, -viscous + seen, v));
        let aged = model.effects_from(0.0, crate::effects::Past::unknown());
        let (base, before, other) = (aged.clone(), z.clone(), aged.clone());
        Self { model, z, aged, direction: 0.0, base, before, other }
    }

    /// The states of the contact and then those of the effects.
    pub(super) fn states(&self) -> impl Iterator<Item = &D> {
        self.z.iter().chain(&self.aged)
    }

    /// One of them.
    pub(super) fn state(&mut self, k: usize) -> &mut D {
        let own = self.z.len();
        if k < own { &mut self.z[k] } else { &mut self.aged[k - own] }
    }

    /// The friction force [N] at the next sample.
    pub(super) fn step(&mut self, step: &Step<'_>) -> D {
        let Self { model, z, aged, direction, base, before, other } = self;
        let ([t_0, t], [u_0, u], v) = (step.time, step.u, step.velocity);
        let mut act = Acts::none();
        let dt = t - t_0;
        base.copy_from_slice(aged);
        before.copy_from_slice(z);
        let motion = (u, (u - u_0) / dt.max(f64::MIN_POSITIVE));
        let now = at(model, (t, dt), motion, before);
        if !model.effects.is_empty() {
            act = model.acts(&now, base, aged);
        }
        // The contact as it is there: the level at which it slips may differ from place to place, and by direction.
        let levels = act.level.is_some();
        let raised = |q: f64, v: f64| {
            let at = At { q: D::from(q), v: D::from(v), ..now };
            model.contact.raised(None, model.acts(&at, base, &mut base.clone()).level)
        };
        let mut last = u_0;
        for &(next, speed) in step.way {
            let grown = levels.then(|| raised(0.5 * (last + next), speed));
            let contact = grown.as_ref().unwrap_or(&model.contact);
            slide(contact, z, next - last, (speed, act.rise));
            last = next;
        }
        if !step.way.is_empty() && v != 0.0 {
            *direction = v.signum();
        }
        if !model.effects.is_empty() {
            // What depends on the velocity depends on that of the sample, what slides on that of the step.
            let now = At { v: D::from(v), dt: 0.0, ..now };
            let here = model.acts(&now, aged, other);
            let Acts { force, more, rise, drag, thicker, .. } = here;
            act = Acts { force, more, rise, drag, thicker, ..act };
            act.risen(|| model.contact.level(), model.contact.bristles());
        }
        let grown = levels.then(|| raised(u, v));
        let contact = grown.as_ref().unwrap_or(&model.contact);
        let own = force(contact, z, (v, act.rise), *direction);
        let sign = own.re().partial_cmp(&0.0).map_or(0.0, |order| f64::from(order as i8));
        let mut all = act.grown(own, sign);
        if let Some(dry) = act.dry {
            all += dry * *direction;
        }
        if let Some(force) = act.force {
            all += force;
        }
        if let Some(more) = act.viscous(model.sigma_2, D::from(v)) {
            all += more;
        }
        all + model.sigma_2 * v + model.offset
    }
}

/// The force [N] that a contact holds at rest in the state in which it shows the `force` at the velocity `v` [m/s].
fn begun<D: Real>(contact: &Contact<D>, force: D, v: f64) -> D {
    let Contact::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } = contact else { return force };
    let r = deflection([*f_c, *f_s, *v_s], *sigma_0, (D::from(v), None));
    let shown = *sigma_0 - *sigma_1 / r * v.abs();
    // Where the damping of the bristles undoes their stiffness nothing is seen of them.
    if shown.re() < HALF * sigma_0.re() {
        return force;
    }
    (force - *sigma_1 * v) / shown * *sigma_0
}

/// So much of the bristles' force must be seen at the first sample.
const HALF: f64 = 0.5;

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
fn slide<D: Real>(contact: &Contact<D>, z: &mut [D], step: f64, (speed, rise): (f64, Option<D>)) {
    if step == 0.0 {
        return;
    }
    match contact {
        Contact::None | Contact::Coulomb { .. } => {}
        Contact::LuGre { f_c, f_s, v_s, sigma_0, .. } => {
            let r = deflection([*f_c, *f_s, *v_s], *sigma_0, (D::from(speed), rise));
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
fn force<D: Real>(contact: &Contact<D>, z: &[D], (v, rise): (f64, Option<D>), direction: f64) -> D {
    match contact {
        Contact::None => D::from(0.0),
        Contact::Coulomb { f_c } => *f_c * direction,
        Contact::Dahl { .. } => z[0],
        Contact::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } => {
            let r = deflection([*f_c, *f_s, *v_s], *sigma_0, (D::from(v), rise));
            *sigma_0 * z[0] + *sigma_1 * (-z[0] / r * v.abs() + v)
        }
        Contact::MaxwellSlip { k, .. } => {
            k.iter().zip(z).fold(D::from(0.0), |sum, (k, z)| sum + *k * *z)
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::{Contact, Course, Model, forces};
    use crate::{Rig, fit::binding};

    const RIG: &str = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[channels]\ntime = \"t\"\n\
        displacement = \"x\"\nforce = \"f\"\n[friction]\n";

    fn driven(
        model: &Model<f64>,
        (time, u): (&[f64], &[f64]),
        seen: f64,
        see: &mut dyn FnMut(usize, f64),
    ) {
        forces(model, (time, u, &Course::of(time, u)), seen, see);
    }

    /// That of a slide with this friction.
    pub(in crate::fit) fn model(friction: &str) -> Model<f64> {
        binding::model(&Rig::parse(&format!("{RIG}{friction}\n")).unwrap(), &|_| None)
    }

    /// The forces on a displacement that goes forth with 0.1 m/s, and from 0.1037 s on back with 0.05 m/s.
    fn forth_and_back(model: &Model<f64>) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..41).map(|i| 0.005 * f64::from(i)).collect();
        let turn = 0.1037;
        let x = |t: f64| if t < turn { 0.1 * t } else { 0.1 * turn - 0.05 * (t - turn) };
        let u: Vec<f64> = time.iter().map(|t| x(*t)).collect();
        let mut seen = Vec::new();
        driven(model, (&time, &u), 0.0, &mut |_, f| seen.push(f));
        (time, seen)
    }

    #[test]
    fn a_turn_between_samples_is_reached() {
        // An element of 200 N/m that yields at 2 mm: from the turn on it lets go along a line.
        let model = model("name = \"maxwell-slip\"\nk = [200.0]\ndelta = [2e-3]\nsigma_2 = 0.0");
        let (time, seen) = forth_and_back(&model);
        for (t, f) in time.iter().zip(seen).skip(21) {
            let truth = (0.4 - 200.0 * 0.05 * (t - 0.1037)).max(-0.4);
            assert!((f - truth).abs() < 1e-12, "{f} N of {truth} N at {t} s");
        }
    }

    #[test]
    fn a_motion_that_comes_to_rest_does_not_swing_back() {
        // With 0.02 m/s and a trembling of 3 µm, at rest from 0.1002 s on; no smooth curve is led into the rest.
        let x = |t: f64, i: u32| 0.02 * t + if i.is_multiple_of(2) { 3e-6 } else { -3e-6 };
        let time: Vec<f64> = (0..41).map(|i| 0.005 * f64::from(i)).collect();
        let moving = |i: u32| x(0.005 * f64::from(i), i);
        let u: Vec<f64> = (0..41).map(|i| if i < 21 { moving(i) } else { 0.02 * 0.1002 }).collect();
        for friction in [
            "name = \"coulomb\"\nf_c = 1.5\nsigma_2 = 10.0",
            "name = \"maxwell-slip\"\nk = [3e5]\ndelta = [5e-6]\nsigma_2 = 0.0",
        ] {
            let mut seen = Vec::new();
            driven(&model(friction), (&time, &u), 0.0, &mut |_, f| seen.push(f));
            // At the sample at which it comes to rest there are two velocities.
            for (t, f) in time.iter().zip(seen).skip(22) {
                assert!((f - 1.5).abs() < 1e-12, "{f} N of 1.5 N at {t} s");
            }
        }
    }

    #[test]
    fn friction_that_falls_by_its_level_alone_keeps_its_stiffness() {
        // Half of 2 N from the first instant on, over 1 mm at 0.1 m/s: F = L (1 − exp(−σu/L)), whole or by its level.
        let sigma = 1e4;
        for (form, stiffness, level) in [(1, 0.5 * sigma, 1.0), (2, sigma, 1.0)] {
            let text = "name = \"dahl\"\nf_c = 2.0\nsigma = 1e4\ngamma = 1.0\n[[effect]]\nname = \"friction_drift\"\n\
                amount = -0.5\ntau = 1e-9";
            let model = model(&format!("{text}\nform = {form}.0"));
            let time: Vec<f64> = (0..41).map(|i| 2.5e-4 * f64::from(i)).collect();
            let u: Vec<f64> = time.iter().map(|t| 0.1 * t).collect();
            let mut seen = Vec::new();
            driven(&model, (&time, &u), 0.0, &mut |_, f| seen.push(f));
            for (u, f) in u.iter().zip(seen).skip(1) {
                let truth = level * (1.0 - (-stiffness * u / level).exp());
                assert!((f - truth).abs() < 1e-9, "form {form}: {f} N of {truth} N at {u} m");
            }
            assert!(form == 2 || self::model(text) == model, "the first form if none is said");
        }
    }

    #[test]
    fn a_level_that_differs_from_place_to_place_does_so_between_samples() {
        // dF/du = σ (1 − F/L), L = 2 (1 + 0.3 sin ku), by Runge and Kutta's method; six samples a wave.
        let (sigma, k) = (2e3, 2000.0);
        let model = model(
            "name = \"dahl\"\nf_c = 2.0\nsigma = 2e3\ngamma = 1.0\n[[effect]]\nname = \"position_friction\"\n\
             sine = 0.3\ncosine = 0.0\nwavenumber = 2000.0\nform = 2.0",
        );
        let time: Vec<f64> = (0..200).map(|i| 0.005 * f64::from(i)).collect();
        let u: Vec<f64> = time.iter().map(|t| 0.1 * t).collect();
        let mut seen = Vec::new();
        driven(&model, (&time, &u), 0.0, &mut |_, f| seen.push(f));
        let slope = |u: f64, f: f64| sigma * (1.0 - f / (2.0 + 0.6 * (k * u).sin()));
        let (mut truth, h) = (0.0, 5e-6);
        for i in 0..199 {
            for step in 0..100 {
                let at = u[i] + f64::from(step) * h;
                let a = slope(at, truth);
                let b = slope(at + 0.5 * h, truth + 0.5 * h * a);
                let c = slope(at + 0.5 * h, truth + 0.5 * h * b);
                let d = slope(at + h, truth + h * c);
                truth += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            }
            // Four pieces an interval, in each the level of its middle: (kh/8)²/6 of the wave's 0.6 N and less.
            assert!((seen[i + 1] - truth).abs() < 2e-3, "{} N of {truth} N", seen[i + 1]);
        }
    }

    #[test]
    fn friction_that_differs_by_direction_does_so_in_each_of_its_forms() {
        // At the end of each way F_C = 2 N, to which 2000 N/m come within a millimetre, and 10 N·s/m of 0.1 and 0.05 m/s.
        let element = "name = \"maxwell-slip\"\nk = [2000.0]\ndelta = [1e-3]\nsigma_2 = 10.0";
        let dahl = "name = \"dahl\"\nf_c = 2.0\nsigma = 2e5\ngamma = 1.0\nsigma_2 = 10.0";
        for (form, [forth, back]) in
            [(1, [2.6 + 1.0, -1.4 - 0.5]), (2, [3.9, -1.75]), (3, [3.6, -1.9])]
        {
            let effect =
                format!("[[effect]]\nname = \"coulomb_asymmetry\"\nratio = 0.3\nform = {form}");
            let beside = "sigma_2 = 0.0\n[[effect]]\nname = \"viscous\"\nsigma_2 = 10.0";
            for friction in [element, dahl, &dahl.replace("sigma_2 = 10.0", beside)] {
                let (_, seen) = forth_and_back(&model(&format!("{friction}\n{effect}")));
                for (f, truth) in [(seen[19], forth), (seen[40], back)] {
                    assert!(
                        (f - truth).abs() < 1e-9,
                        "form {form}: {f} N of {truth} N, {friction}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_bristle_begins_where_its_first_force_has_it() {
        // From rest, relaxed, at once with 0.1 m/s: the first force is the damping's alone, σ₁v.
        let model = model(
            "name = \"lugre\"\nf_c = 1.0\nf_s = 1.0\nv_s = 0.01\nsigma_0 = 1e3\nsigma_1 = 2.0\nsigma_2 = 0.0",
        );
        let Contact::LuGre { sigma_0, sigma_1, .. } = model.contact else { panic!("a bristle") };
        let time: Vec<f64> = (0..20).map(|i| 0.005 * f64::from(i)).collect();
        let u: Vec<f64> = time.iter().map(|t| 0.1 * t).collect();
        let mut seen = Vec::new();
        driven(&model, (&time, &u), sigma_1 * 0.1, &mut |_, f| seen.push(f));
        for (t, f) in time.iter().zip(seen) {
            // z = r (1 − exp(−vt/r)) with r = F_C/σ₀, and ż = v exp(−vt/r).
            let left = (-0.1 * t / 1e-3).exp();
            let truth = sigma_0 * 1e-3 * (1.0 - left) + sigma_1 * 0.1 * left;
            assert!((f - truth).abs() < 1e-9, "{f} N of {truth} N at {t} s");
        }
    }
}
