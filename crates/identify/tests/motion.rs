//! The march against closed forms and against the methods that locate their events.

use identify::{
    Hold, Rig,
    fit::binding,
    march::{Balance, Contact, Drive, Model, Motion, Start, Tolerance, march},
};
use simulation::{DrivenPlant, anchors::anchors, plant_reference::solve_located};

/// A mass of 1 kg with nothing else.
fn mass(contact: Contact<f64>) -> Model<f64> {
    let balance = Balance::alone(1.0);
    Model { balance, contact, sigma_2: 0.0, offset: 0.0, radius: 1.0, effects: Vec::new() }
}

fn times(step: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|i| step * f64::from(i)).collect()
}

fn run(model: &Model<f64>, u: &[f64], time: &[f64], [q, v]: [f64; 2], rtol: f64) -> Motion {
    let start = Start { q, v, z: vec![0.0; model.contact.states()], shown: None };
    let tolerance = Tolerance { q: rtol, v: rtol, z: rtol, steps: 10_000_000 };
    march(
        model,
        &Drive::Recorded { values: u, first: 0, hold: Hold::Linear },
        time,
        &start,
        &tolerance,
    )
    .expect("a value")
}

#[test]
fn a_thrown_mass_stops_by_coulomb_friction_where_its_energy_is_used_up() {
    // ½v² = F_C q and v = F_C t: it stops between two samples, at 0.5 m after 1.0 s, and stays.
    let model = mass(Contact::Coulomb { f_c: 1.0 });
    let time = times(0.03, 60);
    let motion = run(&model, &vec![0.0; 61], &time, [0.0, 1.0], 1e-6);
    for (i, t) in time.iter().enumerate() {
        let t = t.min(1.0);
        let off = (motion.q[i] - (t - 0.5 * t * t)).abs();
        assert!(off < 1e-12, "at {t} s it is {off:.1e} m off");
    }
    assert_eq!(motion.v[60], 0.0);
}

#[test]
fn a_mass_under_a_rising_force_breaks_away_and_turns_when_the_force_does() {
    // Force t [N] against F_C = 1 N: rest until 1 s, then q = (t − 1)³/6.
    let model = mass(Contact::Coulomb { f_c: 1.0 });
    let time = times(0.07, 40);
    let motion = run(&model, &time, &time, [0.0, 0.0], 1e-9);
    for (i, t) in time.iter().enumerate() {
        let right = (t - 1.0).max(0.0).powi(3) / 6.0;
        let off = (motion.q[i] - right).abs();
        assert!(off < 1e-7, "at {t} s it is {off:.1e} m off");
    }
    // Thrown at 1 m/s against −2 N it turns at 1/3 s, 1/6 m away, and comes back with 1 m/s².
    let motion = run(&model, &vec![-2.0; 41], &time, [0.0, 1.0], 1e-3);
    for (i, t) in time.iter().enumerate() {
        let back = t - 1.0 / 3.0;
        let right = if back < 0.0 { t - 1.5 * t * t } else { 1.0 / 6.0 - 0.5 * back * back };
        let off = (motion.q[i] - right).abs();
        assert!(off < 1e-9, "at {t} s it is {off:.1e} m off");
    }
}

#[test]
fn a_mass_on_a_spring_with_one_slip_element_swings_as_two_parabolas_of_energy_say() {
    // Inside the deadband it is a spring of k + k_s: q = v/ω sin ωt.
    let mut model = mass(Contact::MaxwellSlip { k: vec![3.0], delta: vec![1.0] });
    model.balance.stiffness = 1.0;
    let time = times(0.01, 300);
    let motion = run(&model, &vec![0.0; 301], &time, [0.0, 1.0], 1e-8);
    for (i, t) in time.iter().enumerate() {
        let off = (motion.q[i] - 0.5 * (2.0 * t).sin()).abs();
        assert!(off < 1e-6, "at {t} s it is {off:.1e} m off");
    }
    // With a velocity of 4 m/s it yields at q = 1 m: there ½v² = ½16 − ½4, and it turns where the rest is used
    // up by the spring and the yielding element, ½v² = 3(q − 1) + ½(q² − 1): q = −3 + √28.
    let motion = run(&model, &vec![0.0; 301], &time, [0.0, 4.0], 1e-8);
    let furthest = motion.q.iter().copied().fold(0.0, f64::max);
    let right = -3.0 + 28.0_f64.sqrt();
    // A sample is at most 5 ms from the turn, where the acceleration is k_s q + 3 N.
    let seen = 0.5 * (right + 3.0) * 0.005_f64.powi(2);
    let off = right - furthest;
    assert!(off > -1e-6 && off < seen + 1e-6, "it turns {off:.1e} m before {right} m");
}

#[test]
fn a_pendulum_without_friction_keeps_its_energy() {
    let text = "title = \"t\"\n[plant]\nkind = \"pendulum\"\ninertia = 0.02\nmass = 0.4\nlength = 0.2\n\
                torque_constant = 1e-9\nresistance = 1.0\n[friction]\nname = \"none\"\n\
                [channels]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"q\"\n";
    let model = binding::model::<f64>(&Rig::parse(text).expect("a value"), &|_| None);
    let time = times(0.01, 2000);
    let energy = |q: f64, v: f64| 0.5 * 0.02 * v * v - 0.4 * 9.81 * 0.2 * q.cos();
    let motion = run(&model, &vec![0.0; 2001], &time, [2.5, 0.0], 1e-9);
    let first = energy(2.5, 0.0);
    for (q, v) in motion.q.iter().zip(&motion.v) {
        let off = (energy(*q, *v) - first).abs();
        assert!(off < 1e-5, "{off:.1e} J of {first:.2} J are lost at {q} rad");
    }
}

/// The largest difference in q from the method that locates its events, of the largest q.
fn off(problem: &str, rtol: f64) -> f64 {
    let anchor =
        anchors().expect("a value").into_iter().find(|a| a.problem == problem).expect("a value");
    let task = &anchor.task;
    let plant = task.plant.expect("a value");
    let motion =
        DrivenPlant::new(task.friction().expect("a value"), plant, task.input.clone(), task.span);
    let right = solve_located(&motion, &task.y0, 1e-11).path;
    let text = "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 3e-4\nradius = 0.0254\nk_1 = 2.0\n\
                k_2 = 2.0\nf_10 = 0.01\nf_20 = 0.01\nmotor_constant = 16.5\ngear_ratio = 68.8\n\
                [friction]\nname = \"lugre\"\nf_c = 0.6\nf_s = 1.0\nv_s = 1e-3\nsigma_0 = 1e3\n\
                sigma_1 = 31.622776601683793\nsigma_2 = 1.3\n\
                [channels]\ntime = \"t\"\ncurrent = \"u\"\nangle = \"q\"\n";
    let model = binding::model::<f64>(&Rig::parse(text).expect("a value"), &|_| None);
    let time = times(0.005, 10_000);
    let u: Vec<f64> = time.iter().map(|t| task.input.u(*t)).collect();
    let ours = run(&model, &u, &time, [0.0, 0.0], rtol);
    let largest = time.iter().map(|t| right.q(*t).abs()).fold(0.0, f64::max);
    let apart = time.iter().zip(&ours.q).map(|(t, q)| (right.q(*t) - q).abs());
    apart.fold(0.0, f64::max) / largest
}

#[test]
fn the_rig_with_lugre_moves_as_the_method_that_locates_its_events_says() {
    // The current goes straight from sample to sample, (ωh)²/8 = 1.2e-6 off the sine in the middle.
    let (coarse, fine) = (off("P6", 1e-5), off("P6", 1e-8));
    assert!(coarse < 2e-3, "q is {coarse:.1e} of its largest value off at 1e-5");
    assert!(fine < 2e-5, "q is {fine:.1e} of its largest value off at 1e-8");
}

/// A mass on a spring with effects of every kind that acts at rest: a force, a share by place and by side, a level
/// that rises.
const HELD: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
    [friction]\nFRICTION\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n\
    [[effect]]\nname = \"cubic_spring\"\nk_3 = 30.0\n\
    [[effect]]\nname = \"coulomb_asymmetry\"\nratio = 0.3\n\
    [[effect]]\nname = \"position_friction\"\nsine = 0.3\ncosine = 0.1\nwavenumber = 4.0\n\
    [[effect]]\nname = \"maxwell_slip\"\nk = 20.0\ndelta = 0.01\n\
    [[effect]]\nname = \"dwell_stiction\"\ndrop = 0.2\ntau = 1e9\n";

#[test]
fn a_contact_that_holds_the_drive_with_effects_rests() {
    let frictions = [
        "name = \"dahl\"\nf_c = 1.0\nsigma = 1e4\ngamma = 1.0",
        "name = \"lugre\"\nf_c = 1.0\nf_s = 1.2\nv_s = 0.01\nsigma_0 = 1e4\nsigma_1 = 100.0",
        "name = \"maxwell-slip\"\nk = [1e4, 2e4]\ndelta = [4e-5, 3e-5]",
    ];
    let time = times(0.01, 100);
    for friction in frictions {
        let rig = Rig::parse(&HELD.replace("FRICTION", friction)).expect("a rig");
        let model = binding::model::<f64>(&rig, &|_| None);
        for (q, u) in [(0.1, 0.6), (0.1, -0.2), (-0.15, 0.2)] {
            // As an element of its own left it, half way through its deadband.
            let others = vec![0.5; model.states() - model.contact.states()];
            let z = model.holding((0.0, u), [q, 0.0], &others);
            let start = Start { q, v: 0.0, z: [z, others].concat(), shown: None };
            let tolerance = Tolerance { q: 1e-12, v: 1e-12, z: 1e-9, steps: 1_000_000 };
            let drive = Drive::Recorded { values: &vec![u; 101], first: 0, hold: Hold::Linear };
            let motion = march(&model, &drive, &time, &start, &tolerance).expect("a motion");
            // A force of 0.01 N that is not held stretches the softest of the bristles by 0.3 to 1 μm.
            let moved = motion.q.iter().map(|x| (x - q).abs()).fold(0.0, f64::max);
            assert!(moved < 3e-9, "{friction}: from {q} m it moved by {moved:.1e} m");
        }
    }
}
