//! The exact plant with Maxwell-slip: against other closed forms, its own energy, and dense sampling.

use duhem::{
    Dahl, Harmonic, Input, MaxwellSlip, Rig,
    closed_form::dahl::settling::{Contact, HeldMass},
};
use simulation::{
    SimulationError,
    exact::{EventKind, SlipPlant},
};

/// The rig of Figure 22 with `share` of its torque.
fn rig(share: f64) -> SlipPlant {
    let model = MaxwellSlip {
        k: vec![2.60, 4.68, 6.76, 8.84, 10.92, 13.0, 15.08, 17.16, 19.24, 21.32],
        delta: [1.5, 2.4, 3.3, 4.2, 5.1, 6.0, 6.9, 7.8, 8.7, 9.6].map(|d| d * 1e-3).to_vec(),
    };
    let input =
        Input::sine(0.05 * share, 0.2 * std::f64::consts::PI).expect("the rig of the paper");
    SlipPlant::new(model, &Rig::PAPER.plant(), &input).expect("the rig of the paper")
}

/// A small plant of two elements under a sine of this angular frequency.
fn small(stiffness: f64, omega: f64) -> SlipPlant {
    SlipPlant {
        model: MaxwellSlip { k: vec![2.0, 3.0], delta: vec![0.1, 0.25] },
        mass: 1.0,
        stiffness,
        drive: Harmonic { amplitude: 2.0, omega, phase: 0.3, constant: 0.1 },
    }
}

#[test]
fn the_energy_account_closes_on_the_rig_of_figure_22() {
    let energy = rig(1.0).solve(&[0.0; 12], (0.0, 50.0)).unwrap().energy();
    let residue = energy.residue() / energy.scale;
    assert!(residue.abs() < 1e-12, "{residue:e} of {} J is open", energy.scale);
    assert!(energy.dissipated > 10.0, "dissipates {} J only", energy.dissipated);
}

#[test]
fn a_thousandth_of_torque_moves_the_angle_of_figure_22_by_a_third() {
    let largest = |share| {
        let path = rig(share).solve(&[0.0; 12], (0.0, 50.0)).unwrap().path(1e-10);
        (0..path.t().len()).map(|i| path.node(i)[0]).fold(0.0, f64::max)
    };
    let (full, less) = (largest(1.0), largest(0.999));
    let share = 1.0 - less / full;
    assert!((share - 0.335).abs() < 0.001, "from {full} rad to {less} rad: {share}");
}

#[test]
fn the_path_is_the_solution_between_its_nodes_too() {
    let solution = rig(1.0).solve(&[0.0; 12], (0.0, 50.0)).unwrap();
    let path = solution.path(1e-10);
    let (mut exact, mut hermite) = ([0.0; 12], [0.0; 12]);
    let (mut worst_q, mut worst_x) = (0.0_f64, 0.0_f64);
    for nodes in path.t().windows(2) {
        let t = nodes[0] + 0.37 * (nodes[1] - nodes[0]);
        solution.state(t, &mut exact);
        path.state(t, &mut hermite);
        worst_q = worst_q.max((exact[0] - hermite[0]).abs());
        let errors = exact[2..].iter().zip(&hermite[2..]).map(|(a, b)| (a - b).abs());
        worst_x = errors.fold(worst_x, f64::max);
    }
    assert!(worst_q < 1e-12, "q is off by {worst_q:e} rad between the nodes");
    assert!(worst_x < 1.01e-10, "x is off by {worst_x:e} rad between the nodes");
    let turns = solution.events().iter().filter(|e| matches!(e.kind, EventKind::Turn { .. }));
    let turns: Vec<f64> = turns.map(|event| event.t).collect();
    let reversals = path.reversals();
    let other = reversals.iter().zip(&turns).find(|(path, exact)| path != exact);
    assert_eq!(other, None, "the path turns at another time");
    assert_eq!(reversals.len(), turns.len(), "so often turn the path and the solution");
}

#[test]
fn the_motion_solves_its_equation_between_events() {
    // Resonant with both elements stuck (Ω = 3), beside it, far from it, and without a spring.
    for (stiffness, omega) in [(4.0, 3.0), (4.0, 3.0 + 1e-9), (4.0, 0.2), (4.0, 40.0), (0.0, 1.7)] {
        let plant = small(stiffness, omega);
        let y0 = [0.05, 0.02, 0.0, -0.1];
        let solution = plant.solve(&y0, (0.0, 20.0)).unwrap();
        let events = solution.events();
        for (one, next) in events.iter().zip(&events[1..]) {
            let (h, t) = (1e-3, 0.5 * (one.t + next.t));
            if next.t - one.t < 4.0 * h {
                continue;
            }
            let at = |t: f64| {
                let mut y = [0.0; 4];
                solution.state(t, &mut y);
                y
            };
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            let friction = 2.0 * (now[0] - now[2]) + 3.0 * (now[0] - now[3]);
            let expected = plant.drive.u(t) - stiffness * now[0] - friction;
            let a = (after[1] - before[1]) / (2.0 * h);
            let v = (after[0] - before[0]) / (2.0 * h);
            let size = omega.max(4.0).powi(2);
            assert!((a - expected).abs() < 1e-6 * size, "ω = {omega}, {t} s: {a}, {expected} m/s²");
            assert!(
                (v - now[1]).abs() < 1e-6 * size,
                "ω = {omega}, {t} s: q̇ = {v}, v = {}",
                now[1]
            );
        }
        let energy = solution.energy();
        let residue = energy.residue().abs() / energy.scale;
        assert!(residue < 1e-12, "k_s = {stiffness}, ω = {omega}: {residue:e} is open");
        assert!(events.len() > 5, "{} events only", events.len());
    }
}

#[test]
fn no_turn_and_no_slip_is_missed() {
    for omega in [0.2, 2.9, 13.0, 40.0] {
        let plant = small(4.0, omega);
        let solution = plant.solve(&[0.0; 4], (0.0, 60.0)).unwrap();
        let turns = |kind: fn(&EventKind) -> bool| {
            solution.events().iter().filter(|e| kind(&e.kind)).count()
        };
        let (mut y, mut sampled, mut s) = ([0.0; 4], 0, 0.0);
        for i in 1..=6_000_000 {
            solution.state(f64::from(i) * 1e-5, &mut y);
            if y[1] * s < 0.0 {
                sampled += 1;
            }
            s = if y[1] == 0.0 { s } else { y[1].signum() };
            let beyond = ((y[0] - y[2]).abs() - 0.1).max((y[0] - y[3]).abs() - 0.25);
            assert!(beyond < 1e-13, "a deflection is {beyond:e} m beyond its deadband");
        }
        let found = turns(|kind| matches!(kind, EventKind::Turn { .. }));
        assert_eq!(found, sampled, "turns at ω = {omega} rad/s, found and sampled");
    }
}

#[test]
fn one_element_under_a_constant_force_turns_where_dahl_with_gamma_0_does() {
    let model = MaxwellSlip { k: vec![7.5], delta: vec![0.1] };
    let drive = Harmonic { amplitude: 0.0, omega: 0.0, phase: 0.0, constant: 2.0 };
    let dahl = Dahl { f_c: 0.75, sigma: 7.5, gamma: 0.0 };
    let held = HeldMass { dahl, stiffness: 1.5, drive: 2.0 };
    for mass in [0.3, 5.0] {
        let plant = SlipPlant { model: model.clone(), mass, stiffness: 1.5, drive };
        let solution = plant.solve(&[0.0; 3], (0.0, 40.0)).unwrap();
        let turns = solution.events().iter().filter(|e| matches!(e.kind, EventKind::Turn { .. }));
        let expected = held.turns(Contact { q: 0.0, force: 0.0 }, 1000);
        let mut y = [0.0; 3];
        let mut count = 0;
        for (turn, expected) in turns.zip(expected) {
            solution.state(turn.t, &mut y);
            let off = (y[0] - expected.q).abs();
            assert!(off < 1e-13, "turn {count} is off by {off:e} m with {mass} kg");
            count += 1;
        }
        assert!(count > 5, "{count} turns only");
    }
}

#[test]
fn equal_deadbands_slip_as_one() {
    let two = SlipPlant {
        model: MaxwellSlip { k: vec![2.0, 3.0, 1.0], delta: vec![0.1, 0.25, 0.1] },
        ..small(4.0, 1.3)
    };
    let one = SlipPlant {
        model: MaxwellSlip { k: vec![3.0, 3.0], delta: vec![0.1, 0.25] },
        ..small(4.0, 1.3)
    };
    let (two, one) = (two.solve(&[0.0; 5], (0.0, 60.0)), one.solve(&[0.0; 4], (0.0, 60.0)));
    let (two, one) = (two.unwrap(), one.unwrap());
    let (mut a, mut b) = ([0.0; 5], [0.0; 4]);
    for i in 0..=600 {
        let t = 0.1 * f64::from(i);
        two.state(t, &mut a);
        one.state(t, &mut b);
        assert!((a[0] - b[0]).abs() < 1e-12, "{} m and {} m at {t} s", a[0], b[0]);
    }
}

#[test]
fn a_plant_in_balance_stays() {
    let mut plant = small(4.0, 0.0);
    plant.drive = Harmonic { amplitude: 0.0, omega: 0.0, phase: 0.0, constant: 2.5 };
    // k_s q + 2·0.25 + 0 = 2.5 N at q = 0.5 m, the first element stuck at 0.05 m below its limit.
    plant.model = MaxwellSlip { k: vec![2.0], delta: vec![0.3] };
    let solution = plant.solve(&[0.5, 0.0, 0.25], (0.0, 10.0)).unwrap();
    let mut y = [0.0; 3];
    solution.state(7.0, &mut y);
    assert_eq!(y, [0.5, 0.0, 0.25]);
    assert!(solution.events().is_empty());
}

#[test]
fn what_has_no_exact_solution_is_refused_in_words() {
    let plant = small(4.0, 1.0);
    let words = |result: Result<_, SimulationError>| match result {
        Ok(_) => "solved".to_owned(),
        Err(error) => error.to_string(),
    };
    let outside = words(plant.solve(&[0.0, 0.0, 0.2, 0.0], (0.0, 1.0)));
    assert!(outside.contains("|q - x_i| ≤ Δ_i"), "{outside}");
    assert!(words(plant.solve(&[], (0.0, 1.0))).contains("2 positions"));
    assert!(words(plant.solve(&[0.0; 4], (1.0, 1.0))).contains("span"));
    assert!(words(plant.solve(&[0.0; 4], (0.0, 1e9))).contains("shorter span"));
    let massless = SlipPlant { mass: 0.0, ..plant.clone() };
    assert!(words(massless.solve(&[0.0; 4], (0.0, 1.0))).contains("mass"));
    let triangle = Input::triangle(1.0, 1.0).unwrap();
    let error = SlipPlant::new(plant.model, &Rig::PAPER.plant(), &triangle).unwrap_err();
    assert_eq!(error, SimulationError::Drive);
}
