//! The two ways to the motion of a plant agree, and with what can be known without either.

use duhem::{
    Dahl, Input, LuGre, Parameter, Parameters, Plant, Rig,
    closed_form::{Reference, ReferenceError},
};
use integrate::{Control, Corners, Dynamics, Limits, Outcome, solve, solver};
use simulation::{
    DrivenPlant, Motion, PLANT_REFERENCES, Path, PlantReference,
    plant_reference::{along, solve_located},
};

fn reference(
    name: &str,
    model: &[(&str, f64)],
    plant: &Plant,
    input: &Input,
    end: f64,
) -> PlantReference {
    let entry = PLANT_REFERENCES.iter().find(|entry| entry.name == name).expect("an entry");
    let parameters: Parameters = model.iter().copied().collect();
    (entry.build)(&parameters, plant, input, &[0.0; 3], (0.0, end)).expect("an answer")
}

fn figure_14() -> [(&'static str, f64); 6] {
    let damping = 1e5_f64.sqrt();
    [
        ("f_c", 1.0),
        ("f_s", 1.5),
        ("v_s", 1e-3),
        ("sigma_0", 1e5),
        ("sigma_1", damping),
        ("sigma_2", 0.4),
    ]
}

/// What every reference has to keep: 1e-6 m or rad everywhere, and 1e-6 m/s where it reverses.
fn agree(reference: &PlantReference) {
    let (apart, left) = (reference.error_bound(), reference.speed_at_reversals());
    assert!(apart < 1e-6, "the two ways are {apart:e} m apart");
    assert!(left < 1e-6, "one way moves at {left:e} m/s where the other turns");
}

#[test]
fn the_staircase_of_figure_14_is_the_same_by_two_ways() {
    let input = Input::sine(10.0, 1e-3).unwrap();
    let plant = Plant::mass_spring(1.0, 2.0);
    let staircase = reference("lugre", &figure_14(), &plant, &input, 7000.0);
    agree(&staircase);
    let late = staircase.onset_difference(1e-3);
    assert!(late.is_some_and(|late| late < 1e-6), "slips set in {late:?} s apart");
    let slips = staircase.first.onsets(1e-3);
    let drive = plant.drive(input.u(slips[0]));
    assert!((drive - 1.5).abs() < 0.01, "the first slip sets in at {drive} N");
}

#[test]
fn an_explicit_method_finds_the_staircase_of_the_implicit_ones() {
    let input = Input::sine(10.0, 1e-3).unwrap();
    let model = LuGre {
        f_c: 1.0,
        f_s: 1.5,
        v_s: 1e-3,
        sigma_0: 1e5,
        sigma_1: 1e5_f64.sqrt(),
        sigma_2: 0.4,
    };
    let motion =
        DrivenPlant::new(Box::new(model), Plant::mass_spring(1.0, 2.0), input, (0.0, 600.0));
    let located = solve_located(&motion, &[0.0; 3], 1e-11);
    let (control, limits) = (Control::Tolerance { rtol: 1e-11 }, Limits::default());
    let dopri5 = solver("dopri5").unwrap();
    let run = solve(dopri5, &motion.problem(vec![0.0; 3]), &control, Corners::Restart, &limits);
    assert_eq!((&located.outcome, &run.outcome), (&Outcome::Solved, &Outcome::Solved));
    let explicit = along(&motion, &run.trajectory);
    let both = PlantReference::new(located.path, explicit, ["radau", "dopri5"]);
    assert!(both.error_bound() < 1e-9, "{:e} m apart", both.error_bound());
    assert!(both.onset_difference(1e-3).is_some_and(|late| late < 1e-8));
}

#[test]
fn the_rig_with_lugre_is_the_same_by_two_ways() {
    let damping = 1e3_f64.sqrt();
    let model = [
        ("f_c", 0.6),
        ("f_s", 1.0),
        ("v_s", 1e-3),
        ("sigma_0", 1e3),
        ("sigma_1", damping),
        ("sigma_2", 1.3),
    ];
    let input = Input::sine(0.05, 0.2 * std::f64::consts::PI).unwrap();
    let rig = reference("lugre", &model, &Rig::PAPER.plant(), &input, 50.0);
    agree(&rig);
    assert!(rig.error_bound() < 1e-9, "{:e} rad apart", rig.error_bound());
    let late = rig.reversal_difference();
    assert!(late.is_some_and(|late| late < 1e-6), "reversals are {late:?} s apart");
    assert_eq!(rig.kinks().len(), 10, "two reversals in each of five periods");
}

#[test]
fn dahl_friction_on_spring_and_rig_is_the_same_by_two_ways() {
    let figure_13 = [("f_c", 0.75), ("sigma", 7.5), ("gamma", 1.0)];
    let slow = Input::sine(5.0, 1e-3).unwrap();
    agree(&reference("dahl", &figure_13, &Plant::mass_spring(1.0, 1.5), &slow, 14_500.0));
    let figure_18 = [("f_c", 0.84), ("sigma", 7.5), ("gamma", 1.0)];
    let current = Input::sine(0.05, 0.2 * std::f64::consts::PI).unwrap();
    agree(&reference("dahl", &figure_18, &Rig::PAPER.plant(), &current, 50.0));
}

#[test]
fn the_rig_with_maxwell_slip_is_the_same_by_two_ways() {
    let delta = [1.5, 2.4, 3.3, 4.2, 5.1, 6.0, 6.9, 7.8, 8.7, 9.6].map(|d| d * 1e-3).to_vec();
    let k = vec![2.60, 4.68, 6.76, 8.84, 10.92, 13.0, 15.08, 17.16, 19.24, 21.32];
    let model: Parameters =
        [("k", Parameter::List(k)), ("delta", delta.into())].into_iter().collect();
    let current = Input::sine(0.05, 0.2 * std::f64::consts::PI).unwrap();
    let entry = PLANT_REFERENCES.iter().find(|entry| entry.name == "maxwell-slip").unwrap();
    let figure_22 = (entry.build)(&model, &Rig::PAPER.plant(), &current, &[0.0; 12], (0.0, 50.0));
    let figure_22 = figure_22.unwrap();
    agree(&figure_22);
    let late = figure_22.reversal_difference();
    assert!(late.is_some_and(|late| late < 1e-6), "reversals are {late:?} s apart");
    let triangle = Input::triangle(0.05, 1.0).unwrap();
    let refused = (entry.build)(&model, &Rig::PAPER.plant(), &triangle, &[0.0; 12], (0.0, 50.0));
    assert!(matches!(refused, Err(ReferenceError::Unanswered { .. })), "a triangle has corners");
}

/// The first turning point under a constant force from rest at 0: where the work of the force is that
/// of spring and friction, F_e q − k_s q²/2 − F_C (q − F_C/σ (1 − exp(−σ q/F_C))) = 0.
fn turning_point(f_e: f64, k_s: f64, dahl: &Dahl) -> f64 {
    let length = dahl.f_c / dahl.sigma;
    let left =
        |q: f64| f_e - 0.5 * k_s * q - dahl.f_c * (1.0 + (-q / length).exp_m1() * length / q);
    let (mut low, mut high) = (1e-6, 2.0 * f_e / k_s);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if left(middle) > 0.0 { low = middle } else { high = middle }
    }
    low
}

#[test]
fn a_mass_turns_where_the_energy_is_spent_however_heavy_it_is() {
    let dahl = Dahl { f_c: 0.75, sigma: 7.5, gamma: 1.0 };
    let expected = turning_point(2.0, 1.5, &dahl);
    for mass in [0.01, 1.0, 30.0_f64] {
        let input = Input::sampled(vec![0.0, 1.0], vec![2.0, 2.0]).unwrap();
        let end = 8.0 * mass.sqrt();
        let motion = DrivenPlant::new(
            Box::new(dahl.clone()),
            Plant::mass_spring(mass, 1.5),
            input,
            (0.0, end),
        );
        let located = solve_located(&motion, &[0.0; 3], 1e-11);
        assert_eq!(located.outcome, Outcome::Solved);
        let turn = located.path.reversals()[0];
        let error = (located.path.q(turn) - expected).abs();
        assert!(error < 1e-10, "{mass} kg turns {error:e} m off {expected} m");
    }
}

/// Numbers in [0, 1) from a seed: splitmix64.
struct Draws(u64);

impl Draws {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two positive numbers, every decade as likely as the next.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.number())
    }
}

/// LuGre on a mass on a spring, over five decades of stiffness and four of mass, driven by a sine, a
/// triangle or a constant force.
fn drawn(seed: u64) -> DrivenPlant {
    let mut draws = Draws(seed);
    let (f_c, mass) = (draws.decades(0.3, 3.0), draws.decades(1e-3, 10.0));
    let sigma_0 = draws.decades(1e2, 1e6);
    let model = LuGre {
        f_c,
        f_s: f_c * (1.0 + draws.number()),
        v_s: draws.decades(1e-4, 0.1),
        sigma_0,
        sigma_1: 2.0 * draws.number() * (sigma_0 * mass).sqrt(),
        sigma_2: draws.number(),
    };
    let (omega, amplitude) = (draws.decades(0.05, 20.0), f_c * draws.decades(0.3, 5.0));
    let input = match seed % 3 {
        0 => Input::sine(amplitude, omega),
        1 => Input::triangle(amplitude, omega),
        _ => Input::sampled(vec![0.0, 1.0], vec![amplitude; 2]),
    };
    let plant = Plant::mass_spring(mass, draws.decades(0.01, 100.0));
    DrivenPlant::new(Box::new(model), plant, input.expect("an input"), (0.0, 30.0 / omega))
}

#[test]
fn plants_drawn_at_random_are_the_same_by_two_ways() {
    for seed in 0..30 {
        let motion = drawn(seed);
        let y0 = [1e-3 * motion.scale()[0], 0.0, 0.0];
        let located = solve_located(&motion, &y0, 1e-10);
        assert_eq!(located.outcome, Outcome::Solved, "seed {seed}");
        let control = Control::Tolerance { rtol: 1e-12 };
        let limits = Limits { evaluations: 20_000_000 };
        let bdf = solver("bdf").unwrap();
        let run = solve(bdf, &motion.problem(y0.to_vec()), &control, Corners::Restart, &limits);
        assert_eq!(run.outcome, Outcome::Solved, "seed {seed}");
        let (t, path) = (located.path.t().to_vec(), located.path);
        let size = t.iter().map(|t| path.q(*t).abs()).fold(0.0, f64::max);
        let both = PlantReference::new(path, along(&motion, &run.trajectory), ["radau", "bdf"]);
        let apart = both.error_bound() / size;
        assert!(apart < 1e-7, "seed {seed}: {apart:e} of the motion apart");
    }
}

#[test]
fn the_energy_account_of_the_first_slip_closes() {
    // Between the nodes too: the quadrature uses the path as anyone would.
    let model = LuGre {
        f_c: 1.0,
        f_s: 1.5,
        v_s: 1e-3,
        sigma_0: 1e5,
        sigma_1: 1e5_f64.sqrt(),
        sigma_2: 0.4,
    };
    let (plant, input) = (Plant::mass_spring(1.0, 2.0), Input::sine(10.0, 1e-3).unwrap());
    let motion = DrivenPlant::new(Box::new(model), plant, input, (0.0, 160.0));
    let path = solve_located(&motion, &[0.0; 3], 1e-11).path;
    let power = |t: f64| {
        let mut y = [0.0; 3];
        path.state(t, &mut y);
        (motion.drive(t) - motion.force(t, &y)) * y[1]
    };
    let simpson = |w: &[f64]| {
        let h = w[1] - w[0];
        h / 6.0 * (power(w[0]) + 4.0 * power(0.5 * (w[0] + w[1])) + power(w[1]))
    };
    let work: f64 = path.t().windows(2).map(simpson).sum();
    let y = path.end().unwrap().1;
    let stored = 0.5 * plant.mass * y[1] * y[1] + 0.5 * plant.stiffness * y[0] * y[0];
    assert!((work - stored).abs() < 1e-8, "{work} J went in, {stored} J are there");
}

#[test]
fn the_difference_of_two_ways_is_seen_wherever_it_is() {
    let line = |slope: f64, nodes: &[f64]| {
        let mut path = Path::new(2);
        for t in nodes {
            path.push(*t, &[slope * t, slope], &[slope, 0.0]);
        }
        path
    };
    let both = PlantReference::new(line(1.0, &[0.0, 2.0]), line(1.5, &[0.0, 1.0, 2.0]), ["a", "b"]);
    assert!((both.error_bound() - 1.0).abs() < 1e-15, "{} m", both.error_bound());
    assert_eq!((both.reversal_difference(), both.speed_at_reversals()), (Some(0.0), 0.0));
    let turning = |at: f64| {
        let mut path = Path::new(2);
        path.push(0.0, &[0.0, -at], &[-at, 1.0]);
        path.push(2.0, &[2.0 - 2.0 * at, 2.0 - at], &[2.0 - at, 1.0]);
        path
    };
    let both = PlantReference::new(turning(0.5), turning(0.75), ["a", "b"]);
    assert_eq!((both.reversal_difference(), both.speed_at_reversals()), (Some(0.25), 0.25));
}

#[test]
fn an_answer_that_cannot_be_had_is_refused_in_words() {
    let input = Input::sine(1.0, 1.0).unwrap();
    let plant = Plant::mass_spring(1.0, 1.0);
    let good: Parameters = [("f_c", 0.75), ("sigma", 7.5), ("gamma", 1.0)].into_iter().collect();
    let dahl = PLANT_REFERENCES.iter().find(|entry| entry.name == "dahl").unwrap();
    let build = |y0: &[f64], span| (dahl.build)(&good, &plant, &input, y0, span).map(|_| ());
    assert!(matches!(
        build(&[0.0; 2], (0.0, 1.0)),
        Err(ReferenceError::InitialState { expected: 3, .. })
    ));
    assert!(matches!(build(&[0.0; 3], (1.0, 1.0)), Err(ReferenceError::Span { .. })));
    let sharp: Parameters = [("f_c", 0.75), ("sigma", 7.5), ("gamma", 0.5)].into_iter().collect();
    let error =
        (dahl.build)(&sharp, &plant, &input, &[0.0; 3], (0.0, 1.0)).unwrap_err().to_string();
    assert!(error.contains("γ = 0.5") && error.contains("t = 0 s"), "{error}");
    let bad: Parameters = [("f_c", -0.75)].into_iter().collect();
    let wrong = (dahl.build)(&bad, &plant, &input, &[0.0; 3], (0.0, 1.0));
    assert!(matches!(wrong, Err(ReferenceError::Parameters(_))));
}
