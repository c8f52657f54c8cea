//! The march against the located method of `simulation`, which shares no code with it, and a closed form.

use duhem::{Input, MODELS, Parameters, Plant, Rig};
use identify::{
    Hold,
    fit::binding,
    march::{Balance, Contact, Drive, Dual, Model, Motion, Start, Tolerance, march, replay},
};
use integrate::{Limits, Outcome};
use simulation::{Task, adaptive::ADAPTIVE};

fn times(samples: u32, rate: f64) -> Vec<f64> {
    (0..=samples).map(|i| f64::from(i) / rate).collect()
}

fn driven(plant: &Plant, contact: Contact<f64>, sigma_2: f64) -> Model<f64> {
    let balance = Balance {
        gain: plant.gain,
        constant: plant.offset,
        stiffness: plant.stiffness,
        ..Balance::alone(plant.mass)
    };
    Model { balance, contact, sigma_2, offset: 0.0, radius: 1.0, effects: Vec::new() }
}

fn go(model: &Model<f64>, values: &[f64], time: &[f64], (q, tight): (f64, f64)) -> Motion {
    let drive = Drive::Recorded { values, first: 0, hold: Hold::Linear };
    let start = Start { q, v: 0.0, z: vec![0.0; model.contact.states()], shown: None };
    let tolerance = Tolerance { q: 0.3 * tight, v: 0.2 * tight, z: tight, steps: 10_000_000 };
    march(model, &drive, time, &start, &tolerance).expect("a motion")
}

/// The displacement by the located method at rtol 1e-9, the same straight lines between the samples.
fn located(
    name: &str,
    parameters: &Parameters,
    plant: Plant,
    (u, time): (&[f64], &[f64]),
) -> Vec<f64> {
    // After the span it returns to its first value, as a period has to.
    let after = |all: &[f64], last: f64| [all, &[last]].concat();
    let input = Input::polyline(after(time, time[time.len() - 1] + 1.0), after(u, u[0]));
    let task = Task {
        model: MODELS.iter().find(|m| m.name == name).expect("a model of the list"),
        parameters: parameters.clone(),
        plant: Some(plant),
        input: input.expect("an input"),
        y0: vec![0.0; 3],
        span: (time[0], time[time.len() - 1]),
    };
    let own = ADAPTIVE.iter().find(|own| own.name == "radau-located").expect("in the list");
    let mut states = vec![0.0; 3 * time.len()];
    let limits = Limits::default();
    let delivered = (own.build)(&task).expect("it holds").deliver(1e-9, &limits, time, &mut states);
    assert_eq!(delivered.outcome, Outcome::Solved, "{name}");
    states.iter().step_by(3).copied().collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0, |m: f64, q| m.max(q.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

#[test]
fn the_drum_moves_as_by_the_located_method_and_closer_with_shorter_steps() {
    let plant = Rig::PAPER.plant();
    let time = times(2000, 100.0);
    let u: Vec<f64> = time.iter().map(|t| 0.05 * (0.2 * std::f64::consts::PI * t).sin()).collect();
    let sigma_1 = 1000.0_f64.sqrt();
    let keys = [
        ("f_c", 0.6),
        ("f_s", 1.0),
        ("v_s", 1e-3),
        ("sigma_0", 1e3),
        ("sigma_1", sigma_1),
        ("sigma_2", 1.3),
    ];
    let right = located("lugre", &keys.into_iter().collect(), plant, (&u, &time));
    let contact = Contact::LuGre { f_c: 0.6, f_s: 1.0, v_s: 1e-3, sigma_0: 1e3, sigma_1 };
    let model = driven(&plant, contact, 1.3);
    // The tolerance of a fit, and a hundred times as close.
    for (tight, most) in [(1e-5, 1e-5), (1e-7, 1e-7)] {
        let error = apart(&go(&model, &u, &time, (0.0, tight)).q, &right);
        assert!(error < most, "LuGre at {tight:e}: off by {error:e} of the largest angle");
    }
}

#[test]
fn a_mass_with_dahl_friction_moves_as_by_the_located_method() {
    let plant = Plant::mass_spring(1.0, 1.5);
    let time = times(1500, 50.0);
    let u: Vec<f64> = time.iter().map(|t| 5.0 * (0.7 * t).sin()).collect();
    let keys = [("f_c", 0.75), ("sigma", 75.0), ("gamma", 1.0)];
    let right = located("dahl", &keys.into_iter().collect(), plant, (&u, &time));
    let contact = Contact::Dahl { f_c: 0.75, sigma: 75.0, gamma: 1.0 };
    let error = apart(&go(&driven(&plant, contact, 0.0), &u, &time, (0.0, 1e-7)).q, &right);
    assert!(error < 1e-5, "off by {error:e} of the largest displacement");
}

#[test]
fn a_mass_with_coulomb_friction_loses_two_f_c_over_k_each_half_swing_and_stops() {
    // From q₀ at rest the turning points are q₀ − 2nF_C/k in size, π√(m/k) apart, until k|q| < F_C.
    let (mass, stiffness, f_c, q_0) = (2.0, 50.0, 3.0, 0.5_f64);
    let half = std::f64::consts::PI * f64::sqrt(mass / stiffness);
    let time: Vec<f64> = (0..=8).map(|n| f64::from(n) * half).collect();
    let u = vec![0.0; time.len()];
    let model = driven(&Plant::mass_spring(mass, stiffness), Contact::Coulomb { f_c }, 0.0);
    let motion = go(&model, &u, &time, (q_0, 1e-8));
    let (mut q, mut sign) = (q_0, 1.0);
    for (n, found) in motion.q.iter().enumerate() {
        assert!((found - sign * q).abs() < 1e-6, "turn {n}: {found} m for {} m", sign * q);
        if stiffness * q > f_c {
            (q, sign) = (q - 2.0 * f_c / stiffness, -sign);
        }
    }
    assert_eq!(motion.v.last(), Some(&0.0), "it sticks exactly");
}

#[test]
fn a_held_force_that_comes_late_moves_a_mass_as_its_own_steps_do() {
    let text = |delay: f64| {
        format!(
            "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 1e-9\n[friction]\n\
             name = \"none\"\nsigma_2 = 0.0\n[[effect]]\nname = \"input_delay\"\ndelay = {delay}\n[channels]\n\
             time = \"t\"\nforce = \"f\"\nposition = \"x\"\n"
        )
    };
    let time = times(40, 100.0);
    let values: Vec<f64> = (0..time.len()).map(|i| [3.0, -1.0, 0.5, 2.0, -4.0][i % 5]).collect();
    for (delay, back) in [(0.0037, 0), (0.0237, 2)] {
        let rig = identify::Rig::parse(&text(delay)).expect("a rig");
        let model = binding::model::<f64>(&rig, &|_| None);
        let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
        let start = Start { q: 0.0, v: 0.0, z: vec![0.0; model.contact.states()], shown: None };
        let tolerance = Tolerance { q: 1e-9, v: 1e-9, z: 1e-9, steps: 100_000 };
        let motion = march(&model, &drive, &time, &start, &tolerance).expect("a motion");
        // Until the edge the last value acts, from there on the next.
        let (mut q, mut v) = (0.0, 0.0);
        let mut slide = |force: f64, dt: f64| {
            q += dt * (v + 0.25 * force * dt);
            v += 0.5 * force * dt;
            (q, v)
        };
        for i in 0..40 {
            let at = |late: usize| values[usize::saturating_sub(i, late)];
            slide(at(back + 1), 0.0037);
            let (q, v) = slide(at(back), 0.0063);
            let (found_q, found_v) = (motion.q[i + 1], motion.v[i + 1]);
            assert!(
                (found_v - v).abs() < 1e-7,
                "{delay} s late, sample {i}: {found_v} for {v} m/s"
            );
            assert!((found_q - q).abs() < 1e-7, "{delay} s late, sample {i}: {found_q} for {q} m");
        }
        // A window that begins later still gets what was on its way when it did.
        let first = 17;
        let drive = Drive::Recorded { values: &values, first, hold: Hold::ZeroOrder };
        let start = Start { q: motion.q[first], v: motion.v[first], z: start.z, shown: None };
        let later = march(&model, &drive, &time[first..], &start, &tolerance).expect("a motion");
        for (i, (found, whole)) in later.v.iter().zip(&motion.v[first..]).enumerate() {
            assert!(
                (found - whole).abs() < 1e-9,
                "{delay} s late, {i} on: {found}, not {whole} m/s"
            );
        }
        assert_eq!(later.q.len(), time.len() - first);
    }
}

#[test]
fn a_held_force_that_comes_late_finds_a_plant_that_settles_between_two_samples() {
    // M v̇ = u − c v settles within M/c = 0.3 ms, a thirtieth of the interval: v = u/c (1 − e^(−c t/M)) from the jump on.
    let text = |delay: f64| {
        format!(
            "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 3e-4\nstiffness = 1e-9\n[friction]\n\
             name = \"none\"\nsigma_2 = 1.0\n[[effect]]\nname = \"input_delay\"\ndelay = {delay}\n[fit]\n\
             free = [\"input_delay.delay\"]\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n"
        )
    };
    let time = times(4, 100.0);
    let values = [0.0, 0.0, 1.0, 1.0, -1.0];
    let run = |delay: f64| {
        let rig = identify::Rig::parse(&text(delay)).expect("a rig");
        let model = binding::model::<f64>(&rig, &|_| None);
        let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
        let start = Start { q: 0.0, v: 0.0, z: vec![0.0; model.contact.states()], shown: None };
        let tolerance = Tolerance { q: 1e-9, v: 1e-7, z: 1e-9, steps: 100_000 };
        march(&model, &drive, &time, &start, &tolerance).expect("a motion")
    };
    for delay in [0.0, 0.0004, 0.002, 0.0098] {
        let motion = run(delay);
        let (since, settles) = (0.01 - delay, 3e-4);
        let v = 1.0 - f64::exp(-since / settles);
        let q = since - settles * v;
        assert!((motion.v[3] - v).abs() < 1e-5, "{delay} s late: {} for {v} m/s", motion.v[3]);
        assert!((motion.q[3] - q).abs() < 1e-7, "{delay} s late: {} for {q} m", motion.q[3]);
        // And the derivatives by the delay: −v of the displacement.
        let rig = identify::Rig::parse(&text(delay)).expect("a rig");
        let model = binding::model::<Dual<2>>(&rig, &|name| {
            (name == "input_delay.delay").then(|| Dual::variable(delay, 0))
        });
        let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
        let zero = Dual::from(0.0);
        let start = Start { q: zero, v: zero, z: vec![zero; model.contact.states()], shown: None };
        replay(&model, (&drive, &time), &motion.tape, &start, &mut |i, q, _, _| {
            if i == 3 {
                assert!((q.eps[0] + v).abs() < 1e-4, "{delay} s late: {} for {}", q.eps[0], -v);
            }
        });
    }
}

#[test]
fn a_drum_is_pulled_by_the_cables_that_are_taut_alone() {
    let text = "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.1\nk_1 = 3.0\nk_2 = 5.0\n\
        f_10 = 0.2\nf_20 = 0.1\nmotor_constant = 1.0\ngear_ratio = 1.0\n[friction]\nname = \"none\"\n[channels]\n\
        time = \"t\"\ncurrent = \"i\"\nangle = \"q\"\n[[effect]]\nname = \"cable_slack\"\namount = 1.0\n";
    let rig = identify::Rig::parse(text).expect("a rig");
    let model = binding::model::<f64>(&rig, &|_| None);
    for q in [-1.0, -0.5, 0.0, 0.1, 1.0] {
        let (one, other): (f64, f64) = (0.2 + 3.0 * 0.1 * q, 0.1 - 5.0 * 0.1 * q);
        let pull = 0.1 * (one.max(0.0) - other.max(0.0));
        let moved = go(&model, &[0.0, 0.0], &[0.0, 1e-4], (q, 1e-12));
        let expected = -pull / 1e-3 * 1e-4;
        assert!(
            (moved.v[1] - expected).abs() < 1e-4 * expected.abs() + 1e-9,
            "{q} rad: {} for {expected} rad/s",
            moved.v[1]
        );
    }
}
