//! A motion that is nudged towards the measured one: what it takes is the force that the model lacks.
//!
//! M v̇ = T(t, q, v) − F + D (v_m − v), with the measured displacement in T and F: D (v_m − v) is the residual force.
//! With D towards 0 the motion drifts away, with D towards infinity the noise of v_m is all that is seen; between
//! them no derivative of a measured signal is taken, and sticking costs nothing. Steps are implicit Euler's, so
//! many to each interval; the friction of each follows in closed form, as in [`super::march`].

use super::{
    Drive, Dual, Model,
    course::{course, rate},
    plant::Stage,
    stage::{Base, Seek, velocity},
};

/// A measured motion.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Times of the samples [s].
    pub time: &'a [f64],
    /// Displacement at each [m].
    pub q: &'a [f64],
    /// Velocity at each [m/s].
    pub v: &'a [f64],
    /// A force on the mass that was measured at each [N], in place of the plant's stiffness and constant force;
    /// none if empty.
    pub pull: &'a [f64],
}

/// Steps in an interval.
const STEPS: usize = 4;

/// The residual force [N] at each sample from the second on, pulled with `strength` D [N·s/m]; none where the model has no
/// finite motion.
pub fn observe(
    model: &Model<f64>,
    drive: &Drive<'_>,
    measured: &Measured<'_>,
    strength: f64,
) -> Option<Vec<f64>> {
    // The measured displacement is the load's: no joint's motor is seen behind it, and both move as one.
    let mut model = model.clone();
    model.effects.retain(|e| !e.kind.joins(&e.p));
    let model = &model;
    let mut probe = model.map(Dual::from);
    probe.balance.damping += Dual::from(strength);
    if !measured.pull.is_empty() {
        probe.balance.stiffness = Dual::from(0.0);
        probe.balance.cables = [[Dual::from(0.0); 2]; 2];
    }
    let constant = probe.balance.constant.re;
    let mut z = start(model, drive, measured);
    let mut memory = vec![0.0; model.effects.len()];
    let (mut v, mut left) = (measured.v[0], vec![0.0]);
    for i in 0..measured.time.len() - 1 {
        let dt = measured.time[i + 1] - measured.time[i];
        let delay = model.delay().map(|delay| (delay, measured.time));
        let course = course(drive, i, &[measured.q[i]], delay);
        let rate = model.balance.gain * rate(drive, measured.time, i);
        // What the sensor shows beside the velocity is no force.
        let shown =
            model.senses([measured.q[i], v, 0.0, 0.0, 0.0], ([rate, dt], None), &mut memory)[1] - v;
        for step in 1..=STEPS {
            let share = step as f64 / STEPS as f64;
            let between = |values: &[f64]| values[i] + share * (values[i + 1] - values[i]);
            let pull = if measured.pull.is_empty() { constant } else { between(measured.pull) };
            let toward = between(measured.v) - shown;
            probe.balance.constant = Dual::from(pull + strength * toward);
            let h = dt / STEPS as f64;
            let u = Dual::from(course.at(share));
            let stage = Stage::of(&probe, [measured.time[i] + share * dt, h], u);
            let base = Base {
                q: Dual::from(between(measured.q) - v * h),
                v: Dual::from(v),
                z: z.iter().map(|z| Dual::from(*z)).collect(),
            };
            let mut next = base.z.clone();
            let seek = Seek { guess: v, close: 0.0, way: None };
            (v, _) = velocity(&probe, &base, &stage, seek, &mut next)?;
            if !v.is_finite() {
                return None;
            }
            z = settled(&probe, &base, &stage, v);
            if step == STEPS {
                left.push(strength * (toward - v));
            }
        }
    }
    Some(left)
}

/// The states of contact and effects at the velocity `v` of a step.
fn settled(
    model: &Model<Dual<1>>,
    base: &Base<Dual<1>>,
    stage: &Stage<Dual<1>>,
    v: f64,
) -> Vec<f64> {
    let mut z = base.z.clone();
    let way = if v == 0.0 { 0.0 } else { v.signum() };
    let v = Dual::from(v);
    model.force(stage, &base.z, (base.q + v * stage.dt, v, way), &mut z);
    z.iter().map(|z| z.re).collect()
}

/// The states at the first sample: at rest they hold what drives the plant.
fn start(model: &Model<f64>, drive: &Drive<'_>, measured: &Measured<'_>) -> Vec<f64> {
    let u = course(drive, 0, &[measured.q[0]], None).ends[0];
    let others = model.effects_from(0.0, crate::effects::Past::unknown());
    let mut z = model.holding((measured.time[0], u), [measured.q[0], measured.v[0]], &others);
    z.extend(others);
    z
}
