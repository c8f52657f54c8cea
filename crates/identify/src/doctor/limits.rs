//! What a record cannot tell, and what to record next.

use super::motion::Track;
use super::series::{n, quantile};
use super::{Findings, Motion, Severity};
use crate::rig::Rig;
use duhem::Parameter;

/// The fewest samples from which a stretch of motion is known.
const SAMPLES: usize = 10;

/// Finds the parameters that this record cannot tell; a problem where one of them is free.
pub(super) fn examine(rig: &Rig, track: &Track, motion: &Motion, findings: &mut Findings) {
    let mut limits = Limits { rig, track, motion, findings };
    if !limits.slides() {
        return;
    }
    limits.direction();
    limits.presliding();
    limits.stribeck();
    limits.viscous();
    limits.inertia();
    limits.springs();
}

struct Limits<'a> {
    rig: &'a Rig,
    track: &'a Track<'a>,
    motion: &'a Motion,
    findings: &'a mut Findings,
}

impl Limits<'_> {
    /// Says that `names` cannot be told, those of them that this rig has and does not leave out.
    fn cannot(&mut self, names: &[&str], because: &str, next: &str) {
        let free = self.rig.free_parameters();
        let of = |full: &String, name: &str| full == name || full.starts_with(&format!("{name}["));
        let is_free = |name: &&&str| free.iter().any(|full| of(full, name));
        let all = self.rig.parameters();
        let there = |name: &&&str| {
            all.iter().any(|full| of(full, name) && self.rig.value(full) != Some(0.0))
                || is_free(name)
        };
        let wanted: Vec<&str> = names.iter().filter(is_free).copied().collect();
        let named: Vec<&str> = if wanted.is_empty() {
            names.iter().filter(there).copied().collect()
        } else {
            wanted.clone()
        };
        if named.is_empty() {
            return;
        }
        let severity = if wanted.is_empty() { Severity::Note } else { Severity::Problem };
        let text = format!("this record cannot tell {}, because {because}", named.join(" and "));
        let channel = self.track.kind.displacement;
        self.findings.add(severity, "cannot-tell", channel, (text, next));
    }

    fn units(&self) -> (&'static str, &'static str) {
        (self.track.kind.displacement_unit, self.track.kind.velocity_unit)
    }

    /// The deflection F_C/σ₀ up to which the nominal friction is elastic, and its words.
    fn presliding_deflection(&self) -> Option<(f64, &'static str)> {
        let value = |key: &str| self.rig.value(key);
        match self.rig.friction.name.as_str() {
            "lugre" => Some((value("f_c")? / value("sigma_0")?, "f_c/sigma_0")),
            "dahl" => Some((value("f_c")? / value("sigma")?, "f_c/sigma")),
            "maxwell-slip" => match self.rig.friction.parameters.0.get("delta")? {
                Parameter::List(list) => {
                    let least = list.iter().copied().reduce(f64::min)?;
                    Some((least, "min delta"))
                }
                Parameter::Scalar(_) => None,
            },
            _ => None,
        }
    }

    /// Whether it slides at all; without, little else can be said.
    fn slides(&mut self) -> bool {
        let (unit, _) = self.units();
        let range = self.track.range();
        let elastic = self.presliding_deflection().map_or(0.0, |(z, _)| z);
        let least = (3.0 * elastic).max(3.0 * self.track.grain);
        let slides = range > least && self.motion.at_rest < 0.99;
        if !slides {
            let because = format!(
                "nothing slides: it is at rest {} % of the time and travels {} {unit} in all, where {} {unit} \
                 would be sliding",
                n(100.0 * self.motion.at_rest),
                n(range),
                n(least)
            );
            let next = "drive it harder, until it slides both ways";
            self.cannot(&["f_c", "f_s", "v_s", "sigma_2", "delta", "k"], &because, next);
            if self.rig.friction.name == "none" {
                let text = format!("moves only {} {unit}", n(range));
                self.findings.problem("still", self.track.kind.displacement, text, next);
            }
        }
        slides
    }

    /// Sliding one way only leaves F_C and a constant force one and the same.
    fn direction(&mut self) {
        let moving = self.track.moving();
        let up = moving.iter().filter(|v| **v > 0.0).count();
        let fewer = up.min(moving.len() - up);
        if fewer < SAMPLES.max(moving.len() / 100) {
            let because = format!(
                "of {} samples in motion only {fewer} go the other way: a constant force and the friction \
                 are one and the same",
                moving.len()
            );
            let next = "record motion both ways";
            self.cannot(&["f_c", "offset"], &because, next);
        }
    }

    /// The elastic part: seen only after a turn, in steps of the encoder and of the clock.
    fn presliding(&mut self) {
        let Some((z, words)) = self.presliding_deflection() else { return };
        let (unit, speed_unit) = self.units();
        let names: &[&str] = &["sigma_0", "sigma_1", "sigma", "gamma", "k", "delta"];
        let grain = self.track.grain;
        if grain > z / 3.0 {
            let because = format!(
                "the position's step, or three times its noise, is {} {unit}, above a third of the presliding \
                 deflection {words} = {} {unit}",
                n(grain),
                n(z)
            );
            let geared = self.track.kind.geared();
            let shaft = if geared { ", or at the motor's shaft" } else { "" };
            let next =
                format!("measure the position in steps of at most {} {unit}{shaft}", n(z / 10.0));
            self.cannot(names, &because, &next);
            return;
        }
        let (count, most) = self.samples_within(z);
        if most >= SAMPLES {
            return;
        }
        let slow = z / (10.0 * self.track.step);
        let because = if count == 0 {
            format!(
                "it never turns, so the presliding deflection {words} = {} {unit} is not seen",
                n(z)
            )
        } else {
            format!(
                "at none of its {count} turns more than {most} samples fall within the presliding \
                 deflection {words} = {} {unit}",
                n(z)
            )
        };
        let next = format!(
            "record a slow reversal of at least {} s next, at no more than {} {speed_unit} within {} {unit} \
             of the turn",
            n(40.0 * self.track.step),
            n(slow),
            n(2.0 * z)
        );
        self.cannot(names, &because, &next);
    }

    /// How many turns there are, and the most samples that one of them has within `z` of it.
    fn samples_within(&self, z: f64) -> (usize, usize) {
        let position = &self.track.position;
        let near = |turn: &usize| {
            let close = |q: &&f64| (**q - position[*turn]).abs() <= z;
            position[*turn..].iter().take_while(close).count()
        };
        let counts = self.track.turns.iter().map(near);
        (self.track.turns.len(), counts.max().unwrap_or(0))
    }

    /// The Stribeck effect: seen only below some v_S.
    fn stribeck(&mut self) {
        let Some(v_s) = self.rig.value("v_s") else { return };
        let names: &[&str] = if self.rig.tied() { &["v_s"] } else { &["f_s", "v_s"] };
        let free = self.rig.free_parameters();
        if self.rig.tied() && !free.iter().any(|name| name == "v_s") {
            return;
        }
        let (_, unit) = self.units();
        let below = self.track.moving().iter().filter(|v| v.abs() < v_s).count();
        if below >= SAMPLES {
            return;
        }
        let (slowest, resolution) = (self.motion.speeds.0, self.motion.resolution);
        let because = if resolution > v_s {
            format!(
                "speeds below {} {unit} cannot be told from rest, and the Stribeck velocity is {} {unit}",
                n(resolution),
                n(v_s)
            )
        } else {
            format!(
                "{below} samples slide slower than the Stribeck velocity {} {unit}; the slowest speed is \
                 {} {unit}",
                n(v_s),
                n(slowest)
            )
        };
        let next = format!(
            "record steady sliding at {} to {} {unit}, some seconds at each speed",
            n(0.3 * v_s),
            n(10.0 * v_s)
        );
        self.cannot(names, &because, &next);
    }

    /// The viscous term: seen only where the speed varies, and by enough force.
    fn viscous(&mut self) {
        let Some(sigma_2) = self.rig.value("sigma_2") else { return };
        let (_, unit) = self.units();
        let mut moving: Vec<f64> = self.track.moving().iter().map(|v| v.abs()).collect();
        let (slow, fast) = (quantile(&mut moving, 0.1), quantile(&mut moving, 0.9));
        let (force, force_unit) = (self.drive_force(), self.track.kind.force_unit);
        if fast < 2.0 * slow {
            let because = format!(
                "the speeds span less than a factor of 2: {} to {} {unit} (10 to 90 %)",
                n(slow),
                n(fast)
            );
            let next = format!("record sliding at {} {unit} too", n(5.0 * fast));
            self.cannot(&["sigma_2"], &because, &next);
        } else if sigma_2 > 0.0 && force > 0.0 && sigma_2 * fast < 0.005 * force {
            let because = format!(
                "at the fastest speed, {} {unit}, it makes {} {force_unit} of the drive's {} {force_unit}",
                n(fast),
                n(sigma_2 * fast),
                n(force)
            );
            let next = format!("record motion at {} {unit}", n(0.05 * force / sigma_2));
            self.cannot(&["sigma_2"], &because, &next);
        }
    }

    /// The inertia: seen only where it takes a part of the drive.
    fn inertia(&mut self) {
        let key = if self.rig.kind == "mass-spring" { "mass" } else { "inertia" };
        let Some(inertia) = self.rig.value(key) else { return };
        let (fastest, resolution) = self.track.acceleration();
        let (force, unit) = (self.drive_force(), self.track.kind.force_unit);
        let part = inertia * fastest;
        let noise = self.track.drive_noise * self.gain();
        let rate = if self.track.kind.turns() { "rad/s²" } else { "m/s²" };
        if part < (0.01 * force).max(3.0 * noise) || resolution > fastest {
            let because = format!(
                "accelerations reach {} {rate}: {} {unit} of the drive's {} {unit} (noise {} {unit})",
                n(fastest),
                n(part),
                n(force),
                n(noise)
            );
            let next = format!(
                "record quick turns, accelerating at {} {rate} or more",
                n((0.1 * force).max(10.0 * noise) / inertia)
            );
            self.cannot(&[key], &because, &next);
        }
    }

    /// The largest force of the drive but for 1 %, about its middle.
    fn drive_force(&self) -> f64 {
        let mut drive = self.track.drive.clone();
        let (low, high) = (quantile(&mut drive, 0.01), quantile(&mut drive, 0.99));
        0.5 * (high - low) * self.gain()
    }

    /// Force or torque for a unit of the drive.
    fn gain(&self) -> f64 {
        let value = |key: &str| self.rig.value(key);
        let motor = value("torque_constant").zip(value("resistance")).map(|(k, r)| k / r);
        value("motor_constant").or(value("gain")).or(motor).unwrap_or(1.0)
    }

    /// Without load cells, only the sum of the springs and the sum of the constant forces act.
    fn springs(&mut self) {
        if self.rig.kind != "drum" || !self.track.cells.is_empty() {
            return;
        }
        let free = self.rig.free_parameters();
        let frees = |names: &[&'static str]| -> Vec<&'static str> {
            names.iter().filter(|n| free.iter().any(|f| f == *n)).copied().collect()
        };
        let next = "map the load cells force_1 and force_2, or free one of them only";
        let springs = frees(&["k_1", "k_2"]);
        if springs.len() > 1 {
            let because = "without load cells only their sum acts";
            self.cannot(&springs, because, next);
        }
        let constants = frees(&["f_10", "f_20", "offset"]);
        if constants.len() > 1 {
            let because = "without load cells only one constant torque of them all acts";
            self.cannot(&constants, because, next);
        }
    }
}
