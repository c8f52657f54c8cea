//! The second way of a plant with rate-independent friction.

use duhem::{
    Dahl, Harmonic, Input, MaxwellSlip, Plant, Rig,
    closed_form::dahl::settling::{Contact, HeldMass},
};
use simulation::{
    Path, SimulationError,
    displacement::{ByDisplacement, RateIndependent, Steps},
    exact::SlipPlant,
};

/// The ten elements of Figure 22.
fn ten() -> MaxwellSlip {
    MaxwellSlip {
        k: vec![2.60, 4.68, 6.76, 8.84, 10.92, 13.0, 15.08, 17.16, 19.24, 21.32],
        delta: [1.5, 2.4, 3.3, 4.2, 5.1, 6.0, 6.9, 7.8, 8.7, 9.6].map(|d| d * 1e-3).to_vec(),
    }
}

fn rig(friction: RateIndependent) -> ByDisplacement {
    let input = Input::sine(0.05, 0.2 * std::f64::consts::PI).expect("the current of the paper");
    ByDisplacement { friction, plant: Rig::PAPER.plant(), input }
}

fn range(path: &Path) -> (f64, f64) {
    let q = (0..path.t().len()).map(|i| path.node(i)[0]);
    q.fold((0.0, 0.0), |(low, high), q| (q.min(low), q.max(high)))
}

fn apart(one: &Path, other: &Path) -> f64 {
    let nodes = one.t().iter().chain(other.t());
    nodes.map(|t| (one.q(*t) - other.q(*t)).abs()).fold(0.0, f64::max)
}

/// The path, and how far it moves when the steps are twice as long [m].
fn refined(by: &ByDisplacement, y0: &[f64], end: f64) -> (Path, f64) {
    let steps = by.steps();
    let fine = by.solve(y0, (0.0, end), steps).expect("a path");
    let coarse = Steps { h: 2.0 * steps.h, every: steps.every / 2 };
    let coarse = by.solve(y0, (0.0, end), coarse).expect("a path");
    let moved = apart(&fine, &coarse);
    (fine, moved)
}

/// A constant force: an input that the plant's gain of 0 keeps out.
fn held(friction: RateIndependent, mass: f64) -> ByDisplacement {
    let plant = Plant { mass, stiffness: 1.5, gain: 0.0, offset: 2.0 };
    ByDisplacement { friction, plant, input: Input::sine(1.0, 1e-6).expect("any input") }
}

#[test]
fn figure_22_comes_out_the_same_on_both_ways() {
    let by = rig(RateIndependent::MaxwellSlip(ten()));
    let exact = SlipPlant::new(ten(), &by.plant, &by.input).unwrap();
    let exact = exact.solve(&[0.0; 12], (0.0, 50.0)).unwrap().path(1e-10);
    let second = by.solve(&[0.0; 12], (0.0, 50.0), by.steps()).unwrap();
    let worst = apart(&exact, &second);
    assert!(worst < 1e-8, "θ differs by {worst:e} rad");
    let (one, other) = (exact.reversals(), second.reversals());
    assert_eq!(one.len(), other.len(), "so often they turn");
    let worst = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-7, "a turn differs by {worst:e} s");
    let (mut a, mut b) = ([0.0; 12], [0.0; 12]);
    for i in 0..5000 {
        let t = 0.01 * f64::from(i);
        exact.state(t, &mut a);
        second.state(t, &mut b);
        let x = a[2..].iter().zip(&b[2..]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(x < 1e-7, "an element differs by {x:e} rad at {t} s");
    }
}

#[test]
fn figure_18_does_not_depend_on_the_step() {
    let by = rig(RateIndependent::Dahl(Dahl { f_c: 0.84, sigma: 7.5, gamma: 1.0 }));
    let (path, moved) = refined(&by, &[0.0; 3], 50.0);
    assert!(moved < 2e-9, "θ moves by {moved:e} rad");
    // The inertia carries the first peak 3.5 % beyond the quasi-static 0.4426 rad.
    let (low, high) = range(&path);
    assert!((high - 0.458_123_8).abs() < 1e-7, "θ goes up to {high} rad");
    assert!((low + 0.123_717_7).abs() < 1e-7, "θ goes down to {low} rad");
}

#[test]
fn figure_13_does_not_depend_on_the_step() {
    let by = ByDisplacement {
        friction: RateIndependent::Dahl(Dahl { f_c: 0.75, sigma: 7.5, gamma: 1.0 }),
        plant: Plant::mass_spring(1.0, 1.5),
        input: Input::sine(5.0, 0.001).unwrap(),
    };
    let (path, moved) = refined(&by, &[0.0; 3], 14_500.0);
    assert!(moved < 1e-8, "q moves by {moved:e} m");
    let (low, high) = range(&path);
    assert!((high - 2.856_197_54).abs() < 1e-7, "q goes up to {high} m");
    assert!((low + 2.835_527_36).abs() < 1e-7, "q goes down to {low} m");
}

#[test]
fn under_a_constant_force_it_turns_where_the_energy_balance_says_whatever_the_mass() {
    for gamma in [0.0, 0.5, 1.0, 2.0] {
        let dahl = Dahl { f_c: 0.75, sigma: 7.5, gamma };
        let balance = HeldMass { dahl: dahl.clone(), stiffness: 1.5, drive: 2.0 };
        let expected = balance.turns(Contact { q: 0.0, force: 0.0 }, 20);
        for mass in [0.3, 1.0, 7.0] {
            let by = held(RateIndependent::Dahl(dahl.clone()), mass);
            let path = by.solve(&[0.0; 3], (0.0, 30.0 * mass.sqrt()), by.steps()).unwrap();
            let turns = path.reversals();
            for (t, expected) in turns.iter().zip(&expected) {
                let off = (path.q(*t) - expected.q).abs();
                assert!(off < 1e-9, "γ = {gamma}, {mass} kg: {off:e} m off at {t} s");
            }
            assert!(turns.len() > 10, "{} turns only", turns.len());
        }
    }
}

#[test]
fn dahl_with_gamma_0_is_one_element_of_maxwell_slip() {
    let (k, delta) = (7.5, 0.1);
    let mut by = held(RateIndependent::Dahl(Dahl { f_c: k * delta, sigma: k, gamma: 0.0 }), 1.0);
    by.plant.gain = 3.0;
    by.input = Input::sine(1.0, 0.7).unwrap();
    let path = by.solve(&[0.0; 3], (0.0, 60.0), by.steps()).unwrap();
    let slip = SlipPlant {
        model: MaxwellSlip { k: vec![k], delta: vec![delta] },
        mass: 1.0,
        stiffness: 1.5,
        drive: Harmonic { amplitude: 3.0, omega: 0.7, phase: 0.0, constant: 2.0 },
    };
    let exact = slip.solve(&[0.0; 3], (0.0, 60.0)).unwrap().path(1e-10);
    let off = apart(&path, &exact);
    assert!(off < 1e-8, "q differs by {off:e} m");
}

#[test]
fn what_cannot_begin_is_refused_in_words() {
    let by = held(RateIndependent::Dahl(Dahl { f_c: 0.75, sigma: 7.5, gamma: 1.0 }), 1.0);
    let words = |y0: &[f64], end: f64, h: f64| match by.solve(y0, (0.0, end), Steps { h, every: 1 })
    {
        Ok(_) => "solved".to_owned(),
        Err(error) => error.to_string(),
    };
    assert!(words(&[0.0, 0.0, 0.8], 1.0, 0.01).contains("|F| ≤ F_C = 0.75 N"));
    assert!(words(&[0.0, 0.0], 1.0, 0.01).contains("q, v and F"));
    assert!(words(&[0.0; 3], 1.0, 0.0).contains("steps"));
    assert!(words(&[0.0; 3], 0.0, 0.1).contains("span"));
    let many = by.solve(&[0.0; 3], (0.0, 1e9), by.steps());
    assert!(matches!(many, Err(SimulationError::TooLong { .. })));
}
