//! The force that a model lacks, over time, with its floor.

use identify::{
    Rig,
    effects::Channel,
    fit::{
        Data, binding,
        floor::{timed, turns_at_once},
        simulate,
    },
    known::rested,
    march::{Drive, Measured, Model, observe},
    regression::filter::{LowPass, differences},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The residual force of a model on a record, sample by sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Residual {
    /// Times [s].
    pub time: Vec<f64>,
    /// The measured displacement [m].
    pub q: Vec<f64>,
    /// The measured velocity [m/s], or that of the measured displacement.
    pub v: Vec<f64>,
    /// The residual force on the mass [N].
    pub force: Vec<f64>,
    /// Its standard deviation if there were noise alone [N].
    pub floor: Vec<f64>,
}

/// The strength of the pull D, of F_C/v_rms [1].
const STRENGTH: f64 = 0.5;

/// The residual must follow what it shows within so many samples [1].
const FOLLOWS: f64 = 10.0;

/// Where the velocity was not measured: the cut-off of the zero-phase filter, of half the sampling frequency [1].
const CUTOFF: f64 = 0.2;

/// How many times the measured signals are perturbed by their own noise.
const TIMES: u64 = 4;

/// The floor is local: over so many seconds on either side [s].
const LOCAL: f64 = 0.05;

/// The residual force of the model of `rig` on `data`; none where the model has no finite motion. `seed` is that of the
/// perturbations by which the floor is found.
///
/// It is D (v_m − v) of a motion that is nudged towards the measured one; under imposed motion it is the measured
/// force less the simulated one.
pub fn residual(rig: &Rig, data: &Data, seed: u64) -> Option<Residual> {
    if data.time.len() < 8 {
        return None;
    }
    let seen = Signals::of(data)?;
    let model = torque_alone(rig, data);
    let strength = strength(&model, data, &seen.v);
    let run = |signals: &Signals| match &data.force {
        // It rests where its sensor trembles.
        Some(_) => imposed(rig, &rested(&Data { input: signals.input.clone(), ..data.clone() })),
        None => signals.run(&model, data, strength),
    };
    let force = run(&seen)?;
    // Beside the noise of the force itself one that turns at once, or at a corner, is worth what its time is.
    let turns = timed(data, turns_at_once(&model), Vec::new());
    let own = |i: usize| match &data.force {
        Some(seen) => seen.noise.hypot(turns[i]),
        None => 0.0,
    };
    let mut squares: Vec<f64> = (0..force.len()).map(|i| own(i).powi(2)).collect();
    for time in 0..TIMES {
        let mut random = ChaCha8Rng::seed_from_u64(seed.wrapping_add(time));
        let other = run(&seen.perturbed(data, &mut random))?;
        for (sum, (a, b)) in squares.iter_mut().zip(force.iter().zip(&other)) {
            *sum += (a - b).powi(2) / TIMES as f64;
        }
    }
    let around = around(data);
    let floor = (0..squares.len()).map(|i| {
        let near = &squares[i.saturating_sub(around)..(i + around + 1).min(squares.len())];
        (near.iter().sum::<f64>() / near.len() as f64).sqrt()
    });
    Some(Residual { time: data.time.clone(), floor: floor.collect(), q: seen.q, v: seen.v, force })
}

/// Displacement [m], velocity [m/s] and residual force [N] of every sample, without a floor.
pub(crate) struct Left {
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) force: Vec<f64>,
    /// The residual force lags behind the lacking one, as a mass M that D pulls along does: by M/D, in samples [1].
    pub(crate) lag: f64,
}

/// What a model leaves; none as of [`residual`].
pub(crate) fn left(rig: &Rig, data: &Data) -> Option<Left> {
    let seen = Signals::of(data)?;
    if data.force.is_some() {
        let force = imposed(rig, data)?;
        return Some(Left { q: seen.q, v: seen.v, force, lag: 0.0 });
    }
    let model = torque_alone(rig, data);
    let strength = strength(&model, data, &seen.v);
    let force = seen.run(&model, data, strength)?;
    let lag = model.balance.mass / (strength * data.sample_time());
    Some(Left { q: seen.q, v: seen.v, force, lag })
}

/// How many samples are near on either side.
fn around(data: &Data) -> usize {
    let many = (LOCAL / data.sample_time()).clamp(1.0, 1e6);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let many = many as usize;
    many
}

/// Under imposed motion: measured less simulated [N].
fn imposed(rig: &Rig, data: &Data) -> Option<Vec<f64>> {
    let run = simulate(rig, data, None).ok()?;
    let trace = run.traces.into_iter().next()?;
    Some(trace.measured.iter().zip(&trace.after).map(|(m, s)| m - s).collect())
}

/// The model; where the load cells say what the springs do, without what acts on these.
fn torque_alone(rig: &Rig, data: &Data) -> Model<f64> {
    let mut model = binding::model::<f64>(rig, &|_| None);
    if data.loads.is_some() {
        model.effects.retain(|e| e.kind.about().channel != Channel::Loads);
    }
    model
}

/// The strength of the pull D [N·s/m].
fn strength(model: &Model<f64>, data: &Data, v: &[f64]) -> f64 {
    let rms = (v.iter().map(|v| v * v).sum::<f64>() / v.len().max(1) as f64).sqrt();
    let by_friction = STRENGTH * model.contact.level() / rms.max(f64::MIN_POSITIVE);
    by_friction.max(model.balance.mass / (FOLLOWS * data.sample_time()))
}

/// What was measured, as the observer needs it.
#[derive(Debug, Clone)]
struct Signals {
    input: Vec<f64>,
    q: Vec<f64>,
    v: Vec<f64>,
    loads: Option<[Vec<f64>; 2]>,
}

impl Signals {
    fn of(data: &Data) -> Option<Self> {
        let loads = data.loads.as_ref().map(|l| [0, 1].map(|i| l[i].values.clone()));
        let moved = data.displacement.as_ref().map_or(&data.input, |seen| &seen.values);
        let v = match &data.velocity {
            Some(seen) => seen.values.clone(),
            None => speed(moved, data.sample_time())?,
        };
        Some(Self { input: data.input.clone(), q: moved.clone(), v, loads })
    }

    /// The same with the noise of each signal once more; where the velocity was not measured, through its filter.
    fn perturbed(&self, data: &Data, random: &mut ChaCha8Rng) -> Self {
        let mut add = |values: &[f64], size: f64| -> Vec<f64> {
            let mut drawn = || -> f64 { StandardNormal.sample(random) };
            values.iter().map(|value| value + size * drawn()).collect()
        };
        let noise = |seen: Option<&identify::fit::Seen>| seen.map_or(0.0, |seen| seen.noise);
        let input = add(&self.input, identify::doctor::noise(&self.input));
        let q = add(&self.q, noise(data.displacement.as_ref()));
        let v = match &data.velocity {
            Some(seen) => add(&self.v, seen.noise),
            None => speed(&q, data.sample_time()).unwrap_or_else(|| self.v.clone()),
        };
        let loads = self.loads.as_ref().map(|loads| {
            let size = |i: usize| noise(data.loads.as_ref().map(|l| &l[i]));
            [add(&loads[0], size(0)), add(&loads[1], size(1))]
        });
        Self { input, q, v, loads }
    }

    fn run(&self, model: &Model<f64>, data: &Data, strength: f64) -> Option<Vec<f64>> {
        let pull: Vec<f64> = self.loads.as_ref().map_or_else(Vec::new, |[first, second]| {
            first
                .iter()
                .zip(second)
                .map(|(first, second)| -model.radius * (first - second))
                .collect()
        });
        let drive = Drive::Recorded { values: &self.input, first: 0, hold: data.hold };
        let measured = Measured { time: &data.time, q: &self.q, v: &self.v, pull: &pull };
        observe(model, &drive, &measured, strength)
    }
}

/// The velocity [m/s] of a displacement sampled every `step` [s]: a zero-phase Butterworth filter of order 4, run both
/// ways, and central differences.
fn speed(q: &[f64], step: f64) -> Option<Vec<f64>> {
    let filtered = LowPass::butterworth(2, CUTOFF).both_ways(q);
    let v = differences(&filtered, step);
    v.iter().all(|v| v.is_finite()).then_some(v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walk::made::{slide, slides};
    use identify::fit::Seen;

    const RIG: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n\
        velocity = \"v\"\n";

    /// x = sin ωt under the force that the rig's equation asks for, and `more` of it.
    fn record(more: impl Fn(f64, f64) -> f64) -> Data {
        let omega = 2.0;
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let of = |f: &dyn Fn(f64) -> f64| time.iter().map(|t| f(omega * t)).collect::<Vec<f64>>();
        let (q, v) = (of(&f64::sin), of(&|p| omega * p.cos()));
        let input =
            q.iter().zip(&v).map(|(q, v)| (3.0 - 2.0 * omega * omega) * q + 0.5 * v - more(*q, *v));
        let input = input.collect();
        let position = Seen::new("position", q, 0.0);
        let velocity = Some(Seen::new("velocity", v, 0.0));
        Data { velocity, ..Data::driven(time, input, identify::Hold::Linear, position) }
    }

    #[test]
    fn the_residual_is_the_force_that_the_model_lacks() {
        let rig = Rig::parse(RIG).unwrap();
        for lacks in [|_: f64, _: f64| 0.3, |q: f64, _: f64| 0.4 * q, |_: f64, v: f64| -0.1 * v] {
            let data = record(lacks);
            let left = residual(&rig, &data, 1).unwrap();
            // It follows within ten samples of 5 ms at 2 rad/s: 10 % of a quarter period, and the steps' own error.
            for i in 200..4000 {
                let lacking = lacks(left.q[i], left.v[i]);
                let off = (left.force[i] - lacking).abs();
                assert!(off < 0.06, "{} N for {lacking} N at {} s", left.force[i], left.time[i]);
            }
        }
    }

    #[test]
    fn a_right_model_leaves_no_force() {
        let rig = Rig::parse(RIG).unwrap();
        let data = record(|_, _| 0.0);
        let left = residual(&rig, &data, 1).unwrap();
        let most = left.force.iter().skip(200).fold(0.0, |m: f64, f| m.max(f.abs()));
        let drives = data.input.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        assert!(most < 0.01 * drives, "{most} N of {drives} N");
    }

    #[test]
    fn what_noise_leaves_of_an_imposed_motion_is_its_floor() {
        let data = slide(1e-6);
        // How many of the samples are further off than three standard deviations of noise.
        let off = |f_c: f64| {
            let left = residual(&slides(f_c), &data, 1).unwrap();
            let far = |i: &usize| left.force[*i].abs() > 3.0 * left.floor[*i];
            (200..8000).filter(far).count()
        };
        let (right, wrong) = (off(1.5), off(1.6));
        assert!(right < 78 && wrong > 4000, "{right} and {wrong} of 7800");
    }

    #[test]
    fn the_floor_of_a_force_that_turns_knows_when_it_turns() {
        // Without a tremble the force turns by 3 N at one sample, and when it does is known to a part of the sampling
        // time; the mean of 21 samples has that one.
        let left = residual(&slides(1.5), &slide(0.0), 1).unwrap();
        let (turns, slides) = (left.floor[500], left.floor[550]);
        assert!(turns > 0.04 && slides < 2e-3, "{turns} N and {slides} N");
    }

    #[test]
    fn without_a_velocity_sensor_the_displacement_tells_it() {
        let rig = Rig::parse(&RIG.replace("velocity = \"v\"\n", "")).unwrap();
        let data = Data { velocity: None, ..record(|_, _| 0.3) };
        let left = residual(&rig, &data, 1).unwrap();
        for i in 200..3800 {
            assert!(
                (left.force[i] - 0.3).abs() < 0.06,
                "{} N at {} s",
                left.force[i],
                left.time[i]
            );
        }
    }

    #[test]
    fn a_joint_between_motor_and_load_lends_no_force_to_a_displacement_that_is_the_loads() {
        let joint =
            "[[effect]]\nname = \"backlash\"\ngap = 1e-6\nratio = 0.2\nrubs = 0.01\nteeth = 1e-3\n";
        let data = record(|_, _| 0.0);
        let rigid = residual(&Rig::parse(RIG).unwrap(), &data, 1).unwrap();
        let joined = residual(&Rig::parse(&format!("{RIG}{joint}")).unwrap(), &data, 1).unwrap();
        assert_eq!(rigid, joined);
    }
}
