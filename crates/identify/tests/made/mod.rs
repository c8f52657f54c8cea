//! Records made by inverse dynamics: the motion is imposed, the drive is what it takes.

use duhem::{FrictionModel, MODELS};
use identify::Rig;
use identify::rig::Kind;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::ops::Range;

/// Step of the clock [s].
pub(crate) const STEP: f64 = 2e-3;
/// Step of the encoder [m] or [rad].
pub(crate) const QUANTUM: f64 = 1e-6;
/// Standard deviation of the noise of the drive, in force or torque [N] or [N·m].
pub(crate) const NOISE: f64 = 0.05;
/// Amplitude of the motion [m] or [rad].
pub(crate) const AMPLITUDE: f64 = 0.1;
const DURATION: f64 = 60.0;
/// The lowest and the highest frequency [Hz].
const SWEEP: (f64, f64) = (0.05, 2.0);

/// A record in columns of the channels' names.
#[derive(Debug, Clone)]
pub(crate) struct Made {
    pub(crate) columns: Vec<(String, Vec<f64>)>,
}

impl Made {
    pub(crate) fn column(&self, name: &str) -> Result<&[f64], String> {
        let found = self.columns.iter().find(|(column, _)| column == name);
        found.map(|(_, values)| values.as_slice()).ok_or_else(|| format!("no column {name}"))
    }

    pub(crate) fn of_vec(&mut self, name: &str) -> &mut Vec<f64> {
        &mut self.columns.iter_mut().find(|(column, _)| column == name).expect("a column").1
    }

    pub(crate) fn of(&mut self, name: &str) -> &mut [f64] {
        self.of_vec(name)
    }

    pub(crate) fn drop(&mut self, name: &str) {
        self.columns.retain(|(column, _)| column != name);
    }

    pub(crate) fn cut(&mut self, rows: usize) {
        self.columns.iter_mut().for_each(|(_, values)| values.truncate(rows));
    }

    pub(crate) fn remove(&mut self, rows: Range<usize>) {
        self.columns.iter_mut().for_each(|(_, values)| {
            values.drain(rows.clone());
        });
    }

    pub(crate) fn keep_from(&mut self, time: f64) {
        let rows = self.of("time").iter().filter(|t| **t < time).count();
        self.remove(0..rows);
    }

    pub(crate) fn thin(&mut self, every: usize) {
        for (_, values) in &mut self.columns {
            *values = values.iter().copied().step_by(every).collect();
        }
    }

    pub(crate) fn scale(&mut self, name: &str, factor: f64) {
        self.of(name).iter_mut().for_each(|v| *v *= factor);
    }

    pub(crate) fn swap(&mut self, a: &str, b: &str) {
        let other = self.of_vec(a).clone();
        let old = std::mem::replace(self.of_vec(b), other);
        *self.of_vec(a) = old;
    }
}

/// A rig whose columns bear the names of its channels; all that a record can tell is free.
pub(crate) fn rig_of(kind: &str, friction: &str) -> Rig {
    let (plant, free, channels) = match kind {
        "drum" => (
            "inertia = 10\nradius = 0.1\nk_1 = 5\nk_2 = 4\nf_10 = 1\nf_20 = 1.5\nmotor_constant = 16.5\ngear_ratio = 68.8",
            "\"inertia\", \"k_1\", \"k_2\", \"f_10\", \"f_20\"",
            "current angle velocity force_1 force_2",
        ),
        "mass-spring" => {
            ("mass = 10\nstiffness = 300", "\"mass\", \"stiffness\"", "force position velocity")
        }
        "axis" => ("inertia = 10", "\"inertia\"", "force position velocity"),
        "pendulum" => (
            "inertia = 10\nmass = 3\nlength = 0.5\ntorque_constant = 2\nresistance = 1.5",
            "\"inertia\"",
            "voltage angle velocity",
        ),
        "prescribed" => ("", "", "displacement force"),
        other => panic!("no plant {other}"),
    };
    let (friction_keys, friction_free) = match friction {
        "coulomb" => ("f_c = 20", "\"f_c\""),
        "dahl" => ("f_c = 20\nsigma = 1e5", "\"f_c\", \"sigma\""),
        "lugre" => (
            "f_c = 20\nf_s = 30\nv_s = 0.01\nsigma_0 = 1e5\nsigma_1 = 300",
            "\"f_c\", \"f_s\", \"v_s\", \"sigma_0\", \"sigma_1\"",
        ),
        "maxwell-slip" => ("k = [4e4, 2e4]\ndelta = [2e-4, 6e-4]", "\"k\", \"delta\""),
        _ => ("", ""),
    };
    let parts = [free, friction_free, "\"sigma_2\"", "\"offset\""];
    let free: Vec<&str> = parts.into_iter().filter(|p| !p.is_empty()).collect();
    let channels = format!("time {channels}");
    let channels: Vec<String> = channels.split(' ').map(|c| format!("{c} = \"{c}\"\n")).collect();
    let text = format!(
        "title = \"made\"\n[plant]\nkind = \"{kind}\"\noffset = 2.0\n{plant}\n[friction]\nname = \"{friction}\"\n\
         sigma_2 = 50\n{friction_keys}\n[fit]\nfree = [{}]\n[channels]\n{}",
        free.join(", "),
        channels.concat()
    );
    Rig::parse(&text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The phase of the sweep and its rate [rad/s] and [rad/s²].
fn phase(t: f64) -> (f64, f64, f64) {
    let (low, high) = SWEEP;
    let rate = (high / low).ln() / DURATION;
    let omega = TAU * low * (rate * t).exp();
    ((omega - TAU * low) / rate, omega, rate * omega)
}

/// Position, velocity and acceleration.
fn motion(t: f64) -> [f64; 3] {
    let (p, w, a) = phase(t);
    [AMPLITUDE * p.sin(), AMPLITUDE * w * p.cos(), AMPLITUDE * (a * p.cos() - w * w * p.sin())]
}

/// How often the motion turns.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
pub(crate) fn turns() -> usize {
    ((phase(DURATION).0 / TAU * 2.0) + 0.5).floor() as usize
}

/// The friction [N] along the motion, by short steps of Heun's method.
fn friction(rig: &Rig, rows: usize) -> Vec<f64> {
    let Some(entry) = MODELS.iter().find(|m| m.name == rig.friction.name) else {
        return vec![0.0; rows];
    };
    let model = (entry.build)(&rig.friction.parameters).expect("a model");
    let mut x = vec![0.0; model.states()];
    (0..rows).map(|i| sample(model.as_ref(), &mut x, i as f64 * STEP)).collect()
}

fn sample(model: &dyn FrictionModel, x: &mut [f64], t: f64) -> f64 {
    const PARTS: usize = 20;
    let h = STEP / PARTS as f64;
    let (mut a, mut b) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    let [q, v, _] = motion(t);
    model.x_dot(x, q, v, &mut a);
    let force = model.force(x, &a, q, v);
    for part in 0..PARTS {
        let t = t + part as f64 * h;
        let ([q, v, _], [q_1, v_1, _]) = (motion(t), motion(t + h));
        model.x_dot(x, q, v, &mut a);
        let guess: Vec<f64> = x.iter().zip(&a).map(|(x, a)| x + h * a).collect();
        model.x_dot(&guess, q_1, v_1, &mut b);
        x.iter_mut().zip(a.iter().zip(&b)).for_each(|(x, (a, b))| *x += 0.5 * h * (a + b));
    }
    force
}

/// A clean record of this rig.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
pub(crate) fn record(rig: &Rig) -> Made {
    let rows = (DURATION / STEP).round() as usize;
    let kind = Kind::of(rig.kind).expect("a kind");
    let forces = friction(rig, rows);
    let value = |key: &str| rig.value(key).unwrap_or(0.0);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    // Twelve uniform numbers make a normal one, closely enough for a noise.
    let mut normal = |std: f64| std * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0);
    let mut made = Made { columns: Vec::new() };
    let mut add = |name: &str, values: Vec<f64>| made.columns.push((name.to_owned(), values));
    let sliding = value("sigma_2").max(rig.friction.sigma_2);
    let mut drive = Vec::new();
    let own = rig.friction.name == "lugre";
    for (i, force) in forces.iter().enumerate() {
        let [q, v, a] = motion(i as f64 * STEP);
        let resist = force + if own { 0.0 } else { sliding * v } + value("offset") + normal(NOISE);
        let spring = value("radius") * (value("f_10") - value("f_20"))
            + value("radius").powi(2) * (value("k_1") + value("k_2")) * q;
        drive.push(match rig.kind {
            "drum" => (value("inertia") * a + resist + spring) / value("motor_constant"),
            "mass-spring" => value("mass") * a + value("stiffness") * q + resist,
            "axis" => value("inertia") * a + resist,
            "pendulum" => {
                let gravity = value("mass") * 9.81 * value("length") * q.sin();
                let torque = value("inertia") * a + gravity + resist;
                torque * value("resistance") / value("torque_constant")
                    + value("torque_constant") * v
            }
            _ => resist,
        });
    }
    let times: Vec<f64> = (0..rows).map(|i| i as f64 * STEP).collect();
    let of = |f: &mut dyn FnMut([f64; 3]) -> f64| {
        times.iter().map(|t| f(motion(*t))).collect::<Vec<f64>>()
    };
    let position = of(&mut |[q, ..]| (q / QUANTUM).round() * QUANTUM);
    let velocity = of(&mut |[_, v, _]| v + normal(1e-3));
    let stretch = value("radius");
    let cell_1 = of(&mut |[q, ..]| value("f_10") + value("k_1") * stretch * q + normal(1e-3));
    let cell_2 = of(&mut |[q, ..]| value("f_20") - value("k_2") * stretch * q + normal(1e-3));
    add("time", times.clone());
    add(kind.drives[0], drive);
    add(kind.displacement, position);
    if kind.velocity.is_some() {
        add("velocity", velocity);
    }
    if rig.kind == "drum" {
        add("force_1", cell_1);
        add("force_2", cell_2);
    }
    made
}
