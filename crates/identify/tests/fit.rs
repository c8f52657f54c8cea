//! What a fit says: values, intervals, what a record cannot tell, and how it ended.

use identify::{
    Effect, Hold, Rig,
    fit::{
        Data, Fit, FitError, Options, Seen, Way, binding,
        data::Band,
        fit, hold, models,
        problem::{Piece, Problem},
        search::End,
        simulate,
        window::Window,
    },
    march::{Drive, Start, Tolerance, march},
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const RATE: f64 = 100.0;
const SAMPLES: u32 = 1200;
/// Standard deviation of the sensors [m] and [m/s].
const NOISE: [f64; 2] = [2e-4, 5e-3];

fn rig(friction: &str, free: &str) -> Rig {
    let text = format!(
        "title = \"a mass on a spring\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 20.0\n\
         [friction]\n{friction}\n[fit]\nfree = [{free}]\n\
         [channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"q\"\nvelocity = \"v\"\n"
    );
    Rig::parse(&text).expect("a rig file")
}

/// A record of `rig` under a force of this `amplitude` [N], with noise of its own.
fn record(rig: &Rig, amplitude: f64, seed: u64) -> Data {
    held(rig, Hold::Linear, (amplitude, seed))
}

/// The same, its input doing so between samples.
fn held(rig: &Rig, hold: Hold, drawn: (f64, u64)) -> Data {
    sampled(rig, hold, drawn, RATE)
}

/// The same with so many samples a second.
fn sampled(rig: &Rig, hold: Hold, (amplitude, seed): (f64, u64), rate: f64) -> Data {
    let time: Vec<f64> = (0..SAMPLES).map(|i| f64::from(i) / rate).collect();
    let wave = |t: f64| (1.3 * t).sin() + 0.5 * (4.1 * t).sin();
    let input: Vec<f64> = time.iter().map(|t| amplitude * wave(*t)).collect();
    let model = binding::model::<f64>(rig, &|_| None);
    let drive = Drive::Recorded { values: &input, first: 0, hold };
    let start = Start { q: 0.0, v: 0.0, z: vec![0.0; model.contact.states()], shown: None };
    let fine = Tolerance { q: 1e-9, v: 1e-9, z: 1e-8, steps: 10_000_000 };
    let motion = march(&model, &drive, &time, &start, &fine).expect("a motion");
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = |values: &[f64], noise: f64| -> Vec<f64> {
        // The sum of twelve even numbers is nearly normal.
        let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        values.iter().map(|v| v + noise * normal()).collect()
    };
    let position = Seen::new("position", noisy(&motion.q, NOISE[0]), 0.0);
    let velocity = Some(Seen::new("velocity", noisy(&motion.v, NOISE[1]), 0.0));
    Data { velocity, ..Data::driven(time, input, hold, position) }
}

fn quick() -> Options {
    Options { starts: 2, bootstrap: 200, models: false, ..Options::default() }
}

fn off_by(rig: &Rig, factor: f64) -> Rig {
    let mut off = rig.clone();
    for name in rig.free_parameters() {
        let value = rig.value(&name).expect("a parameter");
        off.set(&name, value * factor).expect("within its bounds");
    }
    off
}

fn found_within(fit: &Fit, rig: &Rig, errors: f64) {
    for p in &fit.parameters {
        let truth = rig.value(&p.name).expect("a parameter");
        let off = (p.found - truth).abs() / p.standard_error;
        let (found, error) = (p.found, p.standard_error);
        assert!(off < errors, "{}: {found} ± {error} for {truth}, {off:.1} errors off", p.name);
        assert!(error < 0.2 * truth.abs(), "{}: ± {error} says nothing of {truth}", p.name);
    }
}

#[test]
fn residuals_are_freed_of_what_the_inputs_noise_does() {
    // Of a density 1/(1 + (ω/ω_c)⁴) there is ω_c/(2√2) in all, of white noise's π over all frequencies.
    let in_all = together(0.1, 0) * 8f64.sqrt() / 0.1;
    assert!((in_all - 1.0).abs() < 0.05, "{in_all} of Butterworth's");
    for hold in [Hold::ZeroOrder, Hold::Linear, Hold::Smooth] {
        for late in [None, Some(0.0013)] {
            for edge in [None, Some(0.3)] {
                freed(hold, late, edge);
            }
        }
    }
}

/// By how much two errors so many samples apart go together, of the variance of all, where what is above the `edge` of a band
/// falls as Butterworth's second-order filter has it: from the spectrum, by the sum over its frequencies.
fn together(edge: f64, apart: usize) -> f64 {
    let (decay, turn) = ((-edge / 2f64.sqrt()).exp(), edge / 2f64.sqrt());
    let by = [2.0 * decay * turn.cos(), -decay * decay];
    let n = 20_000;
    let one = |k: i32| {
        let w = std::f64::consts::PI * (f64::from(k) + 0.5) / f64::from(n);
        let real = 1.0 - by[0] * w.cos() - by[1] * (2.0 * w).cos();
        let imaginary = by[0] * w.sin() + by[1] * (2.0 * w).sin();
        let gain = (1.0 - by[0] - by[1]).powi(2) / (real * real + imaginary * imaginary);
        gain * (w * apart as f64).cos() / f64::from(n)
    };
    (0..n).map(one).sum()
}

/// What the noise of an input, so late [s] and of a band with this `edge`, does is taken out of the residuals.
fn freed(hold: Hold, late: Option<f64>, edge: Option<f64>) {
    let friction = "name = \"lugre\"\nf_c = 2.0\nf_s = 2.0\nv_s = 0.1\nsigma_0 = 2e4\nsigma_1 = 20.0\nsigma_2 = 0.5";
    let mut rig = rig(friction, "\"f_c\"");
    let mut data = held(&rig, hold, (20.0, 7));
    data.band = edge.map(|edge| Band { edge, inside: vec![true; data.time.len()] });
    rig.effects.extend(late.map(|delay| Effect {
        name: "input_delay".to_owned(),
        values: [("delay".to_owned(), delay)].into(),
    }));
    let start = Window::new(&data, 110, 122).start;
    let residuals = |data: &Data| {
        let problem =
            Problem { tolerance: 1e-9, ..Problem::unfree(&rig, data).expect("a problem") };
        let window = Window::new(data, 110, 122);
        let piece = problem.piece(&[], &window, start);
        let whitening = problem.whitening(&[], (&window, &piece), 0.05);
        (piece.residuals, whitening.expect("noise that is seen"))
    };
    let (_, whitening) = residuals(&data);
    // What each sample's input does to the residuals, by differences of the motions themselves; that of a few before and
    // after the window as well.
    let by = |k: usize| {
        let moved = |by: f64| {
            let mut data = data.clone();
            data.input[108 + k] += by;
            residuals(&data).0
        };
        let (more, less) = (moved(1e-3), moved(-1e-3));
        DVector::from_fn(24, |i, _| 0.05 * (more[i] - less[i]) / 2e-3)
    };
    let b = DMatrix::from_columns(&(0..16).map(by).collect::<Vec<_>>());
    assert!(b.norm() > 1.0, "the noise is seen: {}", b.norm());
    let mut w = DMatrix::identity(24, 24);
    whitening.apply_all(&mut w);
    let white = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let errors = DMatrix::from_fn(16, 16, |i, j| {
        edge.map_or_else(|| white(i, j), |edge| together(edge, i.abs_diff(j)))
    });
    let covariance = DMatrix::identity(24, 24) + &b * errors * b.transpose();
    let white = &w * &covariance * w.transpose();
    let off = (&white - DMatrix::identity(24, 24)).amax();
    assert!(off < 1e-3, "off by {off}, {hold:?}, late by {late:?}, {edge:?}");
}

#[test]
fn what_an_input_does_between_its_samples_is_told_by_the_record() {
    let truth = rig("name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 0.5", "\"f_c\", \"sigma_2\"");
    let wrong = off_by(&truth, 1.2);
    assert_eq!(wrong.unsaid(), Some("force"));
    for hold in [Hold::Linear, Hold::Smooth, Hold::ZeroOrder] {
        // Whatever was thought of it before. Between its few samples a line is a hundredth off the smooth curve.
        let data = Data { hold: Hold::Linear, ..sampled(&truth, hold, (20.0, 7), RATE / 5.0) };
        let told = hold::told(&wrong, &data).unwrap().map(|told| (told.hold, told.sure));
        assert_eq!(told, Some((hold, true)), "{hold:?}");
        let says = wrong.clone().saying(Some(hold));
        assert_eq!((says.unsaid(), hold::told(&says, &data)), (None, Ok(None)), "as its file says");
        assert_eq!(says.asking(), wrong);
    }
}

#[test]
fn every_friction_model_is_found_from_thirty_per_cent_off() {
    let models = [
        ("name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 1.5", "\"f_c\", \"sigma_2\", \"mass\""),
        (
            "name = \"dahl\"\nf_c = 2.0\nsigma = 4000.0\nsigma_2 = 1.5",
            "\"f_c\", \"sigma\", \"sigma_2\"",
        ),
        (
            "name = \"lugre\"\nf_c = 2.0\nf_s = 3.0\nv_s = 0.05\nsigma_0 = 5e3\nsigma_1 = 80.0\nsigma_2 = 1.5",
            "\"f_c\", \"f_s\", \"v_s\", \"sigma_0\", \"sigma_1\", \"sigma_2\"",
        ),
        (
            "name = \"maxwell-slip\"\nk = [2e3, 1e3]\ndelta = [5e-4, 1.5e-3]\nsigma_2 = 1.5",
            "\"k\", \"delta\", \"sigma_2\"",
        ),
    ];
    for (i, (friction, free)) in models.into_iter().enumerate() {
        let truth = rig(friction, free);
        let data = record(&truth, 6.0, 11 + i as u64);
        let fit = fit(&off_by(&truth, 1.3), &data, &quick()).expect("a fit");
        assert_eq!(fit.end, End::Converged, "{friction}: {:?}", fit.end);
        assert_eq!(fit.way, Way::OneRun, "{friction}: noise alone is left, so one run will do");
        assert!((0.8..1.25).contains(&fit.variance), "{friction}: variance {}", fit.variance);
        assert!(fit.step_error < 0.3, "{friction}: steps add {} errors", fit.step_error);
        found_within(&fit, &truth, 4.0);
    }
}

#[test]
fn what_a_record_does_not_show_is_said_so_and_not_made_up() {
    // The force never reaches F_C: the mass sticks, and any larger F_C would hold it as well.
    let truth =
        rig("name = \"dahl\"\nf_c = 20.0\nsigma = 4000.0\ngamma = 0.0", "\"f_c\", \"sigma\"");
    let data = record(&truth, 6.0, 5);
    let fit = fit(&truth, &data, &quick()).expect("a fit");
    assert_eq!(
        fit.end,
        End::Converged,
        "{:?} {:?} {}",
        fit.parameters,
        fit.simulations,
        fit.step_error
    );
    let f_c = &fit.parameters[0];
    assert!(!f_c.identified, "F_C {:?} of a contact that never slides", f_c.interval);
    assert_eq!(f_c.interval[1], None, "no largest F_C");
    let sigma = &fit.parameters[1];
    assert!(sigma.identified, "σ {:?} is what sticking shows", sigma.interval);
    assert!((sigma.found - 4000.0).abs() < 4.0 * sigma.standard_error, "σ = {}", sigma.found);
}

#[test]
fn three_kinds_of_interval_agree_where_the_model_is_right() {
    let truth =
        rig("name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 1.5", "\"f_c\", \"sigma_2\", \"mass\"");
    let fit = fit(&truth, &record(&truth, 6.0, 3), &quick()).expect("a fit");
    for p in &fit.parameters {
        let width = |[low, high]: [f64; 2]| high - low;
        let [Some(low), Some(high)] = p.interval else { panic!("{}: {:?}", p.name, p.interval) };
        let (profile, plain) = (width([low, high]), width(p.asymptotic));
        let drawn = width(p.bootstrap.expect("drawn"));
        assert!((profile / plain - 1.0).abs() < 0.25, "{}: {profile} and {plain}", p.name);
        assert!((drawn / plain - 1.0).abs() < 0.5, "{}: {drawn} and {plain}", p.name);
    }
}

#[test]
fn the_model_that_made_the_record_wins_on_blocks_it_did_not_see() {
    let truth = rig(
        "name = \"lugre\"\nf_c = 2.0\nf_s = 3.0\nv_s = 0.05\nsigma_0 = 5e3\nsigma_1 = 80.0\nsigma_2 = 1.5",
        "\"f_c\", \"f_s\", \"v_s\", \"sigma_0\", \"sigma_1\", \"sigma_2\"",
    );
    let options = Options { profiles: false, models: true, ..quick() };
    let fit = fit(&truth, &record(&truth, 6.0, 7), &options).expect("a fit");
    assert_eq!(fit.models[0].name, "lugre", "{:?}", fit.models);
    let error = fit.models[0].held_out_error;
    assert!((0.8..1.3).contains(&error), "{error} of the noise on blocks not seen");
    assert!(fit.models.last().is_some_and(|m| m.held_out_error > 2.0 * error), "{:?}", fit.models);
}

#[test]
fn a_windows_start_is_not_taken_for_sliding_where_the_drive_rests() {
    // A slow force on a stiff contact: rests of seconds between the slides.
    let truth = rig(
        "name = \"lugre\"\nf_c = 4.0\nf_s = 5.0\nv_s = 0.05\nsigma_0 = 8e3\nsigma_1 = 180.0\nsigma_2 = 1.5",
        "\"f_c\", \"sigma_0\"",
    );
    let data = record(&truth, 6.0, 9);
    let run = simulate(&truth, &data, Some(0.7)).expect("a run");
    let misfit = &run.gap[0];
    assert!(misfit.after < 1.5 * NOISE[0], "{} m in windows, noise {}", misfit.after, NOISE[0]);
}

#[test]
fn a_window_that_decides_late_between_resting_and_slipping_is_begun_where_its_first_samples_say() {
    // A slow force on a mass whose friction falls with the speed: it creeps, sticks and breaks away.
    let truth = Rig::parse(
        "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 20.0\n[friction]\n\
         name = \"lugre\"\nf_c = 4.0\nf_s = 6.0\nv_s = 0.01\nsigma_0 = 2e5\nsigma_1 = 300.0\nsigma_2 = 5.0\n\
         [fit]\nfree = [\"f_c\"]\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"q\"\n",
    )
    .expect("a rig file");
    let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
    let input: Vec<f64> =
        time.iter().map(|t| 7.0 * (0.5 * t).sin() + 1.5 * (4.1 * t).sin()).collect();
    let model = binding::model::<f64>(&truth, &|_| None);
    let drive = Drive::Recorded { values: &input, first: 0, hold: Hold::Linear };
    let start = Start { q: 0.0, v: 0.0, z: vec![0.0], shown: None };
    let fine = Tolerance { q: 1e-10, v: 1e-10, z: 1e-8, steps: 10_000_000 };
    let q = march(&model, &drive, &time, &start, &fine).expect("a motion").q;
    let q = q.iter().map(|q| 1e-7 * (1e7 * q).round()).collect();
    let data = Data::driven(time, input, Hold::Linear, Seen::new("position", q, 1e-7));
    let base = Problem::unfree(&truth, &data).expect("a problem");
    let windows = (1..26).map(|k| Window::new(&data, 150 * k, 150 * k + 150).remembering(&data));
    let problem = Problem { windows: windows.collect(), tolerance: 1e-8, ..base };
    let worst = |pieces: &[Piece]| {
        let mean = |p: &Piece| p.misfit() / p.residuals.len() as f64;
        pieces.iter().map(mean).fold(0.0, f64::max)
    };
    let first = models::converged(&problem, &[], None, 8);
    assert!(worst(&first) > 1e4, "one went another way: {}", worst(&first));
    // With whole windows alone it stays 9000 times the noise off.
    let all = models::rescued(&problem, &[], first);
    assert!(worst(&all) < 3.0, "{}", worst(&all));
}

#[test]
fn a_run_once_more_begins_where_it_began() {
    let truth =
        rig("name = \"dahl\"\nf_c = 2.0\nsigma = 2e3\ngamma = 1.0\nsigma_2 = 1.0", "\"f_c\"");
    let data = record(&truth, 6.0, 9);
    let run = simulate(&truth, &data, None).expect("a run");
    assert_eq!(run.once_more(&truth, &data).expect("a run"), run.traces, "the same input");
    let mut pushed = data.clone();
    pushed.input.iter_mut().for_each(|u| *u += 0.1);
    let other = run.once_more(&truth, &pushed).expect("a run");
    let [own, other] = [&run.traces[0].after, &other[0].after];
    assert_eq!(own[0], other[0], "where the record began, not where the push would have it");
    assert!((own[900] - other[900]).abs() > 3.0 * NOISE[0], "{} m", own[900] - other[900]);
}

#[test]
fn a_window_without_a_motion_says_nothing_of_the_others() {
    let truth = rig("name = \"coulomb\"\nf_c = 2.0", "\"f_c\"");
    let mut data = record(&truth, 6.0, 9);
    let middle = data.input.len() / 2;
    data.input[middle] = f64::INFINITY;
    let run = simulate(&truth, &data, Some(0.7)).expect("a run");
    let moves = run.traces[0].after.iter().filter(|q| q.is_finite()).count();
    let lost = data.input.len() - moves;
    assert!(lost > 0 && lost < moves / 4, "{lost} samples are lost, {moves} are not");
    assert_eq!(simulate(&truth, &data, None).err(), Some(FitError::NoMotion), "in one run");
}

#[test]
fn a_small_load_on_a_hard_joint_is_simulated_with_rougher_steps() {
    // A load of 0.7 % of the motor behind a hard joint: a window runs out of steps as short as a fit takes them.
    let text = "title = \"a drum\"\n[plant]\nkind = \"drum\"\ninertia = 3.15e-4\nradius = 0.05456\nk_1 = 5.124\n\
        k_2 = 6.306\nf_10 = 0.01274\nf_20 = 0.01352\nmotor_constant = 10.69\ngear_ratio = 68.8\n[friction]\n\
        name = \"lugre\"\nf_c = 0.6948\nf_s = 0.9429\nv_s = 0.01081\nsigma_0 = 685.5\nsigma_1 = 24.18\n\
        sigma_2 = 3.687\n[fit]\nfree = [\"f_c\"]\n[channels]\ntime = \"t\"\ncurrent = \"i\"\nangle = \"q\"\n\
        velocity = \"v\"\n[[effect]]\nname = \"compliance\"\ncompliance = 0.14706\ndamping = 0.28905\n\
        encoder = 1.0\ngives = 0.0030426\nratio = 0.0070267\nrubs = 0.01303\n";
    let rig = Rig::parse(text).expect("a rig file");
    let time: Vec<f64> = (0..1200).map(|i| 0.005 * f64::from(i)).collect();
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut seen = |size: f64, turn: f64, noise: f64| -> Vec<f64> {
        let one = |t: &f64| size * (3.0 * t + turn).sin() + noise * (random.random::<f64>() - 0.5);
        time.iter().map(one).collect()
    };
    let (input, q, v) = (seen(0.35, 0.0, 0.0), seen(0.3, -1.0, 3e-6), seen(0.9, 0.57, 3e-4));
    let driven = Data::driven(time.clone(), input, Hold::ZeroOrder, Seen::new("angle", q, 0.0));
    let data = Data { velocity: Some(Seen::new("velocity", v, 0.0)), ..driven };
    let run = simulate(&rig, &data, Some(3.0)).expect("a run");
    assert_eq!((run.way, run.windows), (Way::Windows, 2));
    assert!(run.traces[0].after.iter().all(|q| q.abs() < 2.0), "it moves, and not away");
}

#[test]
fn a_record_without_a_motion_or_with_nothing_free_is_refused() {
    let truth = rig("name = \"coulomb\"\nf_c = 2.0", "\"f_c\"");
    let mut data = record(&truth, 6.0, 3);
    data.time.truncate(7);
    assert!(matches!(fit(&truth, &data, &quick()), Err(FitError::TooShort { found: 7, .. })));
    let none = Rig { free: Vec::new(), ..rig("name = \"none\"", "") };
    assert_eq!(fit(&none, &record(&truth, 6.0, 3), &quick()).err(), Some(FitError::NothingFree));
}

#[test]
fn when_an_input_jumped_between_two_samples_is_not_held_against_a_model() {
    let truth = rig("name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 0.5", "\"f_c\"");
    let data = held(&truth, Hold::Linear, (20.0, 7));
    let mut jumped = data.clone();
    let from = data.input[140];
    for (i, u) in jumped.input.iter_mut().enumerate() {
        *u = if i < 150 { from } else { from + 50.0 };
    }
    let whitened = |data: &Data, noise: f64| {
        let problem = Problem::unfree(&truth, data).expect("a problem");
        let window = Window::new(data, 145, 155);
        let piece = problem.piece(&[], &window, window.start);
        problem.whitening(&[], (&window, &piece), noise)
    };
    assert!(
        whitened(&jumped, 0.0).is_some(),
        "it jumps, and goes on straight from sample to sample"
    );
    let held = Data { hold: Hold::ZeroOrder, ..jumped.clone() };
    assert!(whitened(&held, 0.0).is_none(), "what is held jumps at its sample");
    let mut smooth = jumped.clone();
    for (i, u) in smooth.input.iter_mut().enumerate() {
        *u = 0.1 * i as f64;
    }
    assert!(whitened(&smooth, 0.0).is_none(), "what rises steadily does not jump");
}
