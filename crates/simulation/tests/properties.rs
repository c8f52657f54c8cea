//! What holds for every plant with friction, on cases drawn at random; and that it could fail.

use duhem::{Dahl, FrictionModel, Harmonic, Input, LuGre, MaxwellSlip, Plant};
use simulation::{
    Path,
    displacement::{ByDisplacement, RateIndependent},
    energy::{Contact, account},
    exact::SlipPlant,
    properties::{PROPERTIES, Property, moved_apart, open},
};

#[test]
fn every_property_holds_on_two_hundred_cases() {
    for property in PROPERTIES {
        let report = property.check(1, 200);
        assert!(report.holds(), "{}: {report:?}", property.says);
    }
}

#[test]
fn the_same_seed_draws_the_same_case() {
    for property in PROPERTIES {
        assert_eq!(property.check(7, 3), property.check(7, 3), "{}", property.name);
    }
}

#[test]
fn a_report_tells_what_is_violated_where_and_what_has_no_solution() {
    let broken = Property {
        name: "broken",
        says: "no seed is above 5, and 3 has a solution",
        tolerance: 5.0,
        violation: |seed| match seed {
            3 => None,
            9 => Some(f64::NAN),
            _ => Some(seed as f64),
        },
    };
    let report = broken.check(1, 9);
    assert_eq!((report.unsolved, report.violations, report.seed), (1, 4, 9));
    assert!(report.worst.is_nan() && !report.holds());
}

/// A plant with Dahl friction and its path.
fn dahl() -> (ByDisplacement, Contact, Path) {
    let model = Dahl { f_c: 0.75, sigma: 7.5, gamma: 1.0 };
    let by = ByDisplacement {
        friction: RateIndependent::Dahl(model.clone()),
        plant: Plant { mass: 1.0, stiffness: 1.5, gain: 1.0, offset: 0.2 },
        input: Input::sine(2.0, 0.7).expect("an input"),
    };
    let path = by.resolve(&[0.1, 0.0, 0.3], (0.0, 20.0)).expect("a path");
    (by, Contact::Dahl(model), path)
}

/// The path with every node changed.
fn changed(path: &Path, change: impl Fn(&mut [f64], &mut [f64])) -> Path {
    let mut changed = Path::new(path.states());
    for i in 0..path.t().len() {
        let (mut y, mut y_dot) = (path.node(i).to_vec(), path.node_dot(i).to_vec());
        change(&mut y, &mut y_dot);
        changed.push(path.t()[i], &y, &y_dot);
    }
    changed
}

#[test]
fn the_account_does_not_close_on_what_is_no_solution() {
    let (by, contact, path) = dahl();
    let relative = |path: &Path, contact: &Contact, plant: &Plant| {
        open(&account(path, contact, plant, &by.input).0)
    };
    let residue = relative(&path, &contact, &by.plant);
    assert!(residue < 1e-9, "a solution leaves {residue:e} open");
    // One percent more mass, and one percent more friction.
    let heavier = Plant { mass: 1.01, ..by.plant };
    let residue = relative(&path, &contact, &heavier);
    assert!(residue > 1e-5, "one percent of mass: {residue:e} open");
    let more = changed(&path, |y, y_dot| (y[2], y_dot[2]) = (1.01 * y[2], 1.01 * y_dot[2]));
    let residue = relative(&more, &contact, &by.plant);
    assert!(residue > 1e-4, "one percent of friction: {residue:e} open");
}

/// Dahl friction by plain Runge–Kutta steps; `sign` = −1 has it brake, 1 has it push.
fn by_plain_steps(by: &ByDisplacement, model: &Dahl, sign: f64) -> Path {
    let h = 1e-3;
    let slope = |t: f64, y: [f64; 3]| {
        let mut force_dot = [0.0];
        model.x_dot(&y[2..], y[0], y[1], &mut force_dot);
        let drive = by.plant.drive(by.input.u(t));
        [y[1], by.plant.acceleration(y[0], drive, -sign * y[2]), force_dot[0]]
    };
    let add = |y: [f64; 3], h: f64, k: [f64; 3]| [0, 1, 2].map(|i| y[i] + h * k[i]);
    let (mut y, mut path) = ([0.1, 0.0, 0.3], Path::new(3));
    for n in 0..20_000 {
        let t = f64::from(n) * h;
        let k1 = slope(t, y);
        path.push(t, &y, &k1);
        let k2 = slope(t + 0.5 * h, add(y, 0.5 * h, k1));
        let k3 = slope(t + 0.5 * h, add(y, 0.5 * h, k2));
        let k4 = slope(t + h, add(y, h, k3));
        y = add(y, h / 6.0, [0, 1, 2].map(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    path
}

#[test]
fn friction_with_the_wrong_sign_is_found() {
    let (by, contact, _) = dahl();
    let Contact::Dahl(model) = &contact else { panic!("Dahl") };
    let residue = |sign: f64| {
        open(&account(&by_plain_steps(&by, model, sign), &contact, &by.plant, &by.input).0)
    };
    let (right, wrong) = (residue(-1.0), residue(1.0));
    assert!(right < 1e-6, "plain steps leave {right:e} open");
    assert!(wrong > 0.1, "pushing friction leaves {wrong:e} open only");
}

#[test]
fn negative_damping_gives_heat_back() {
    let model = LuGre { f_c: 1.0, f_s: 1.5, v_s: 0.1, sigma_0: 50.0, sigma_1: 5.0, sigma_2: -6.0 };
    let mut path = Path::new(3);
    for (t, v) in [(0.0, 1.0), (1.0, 1.0)] {
        path.push(t, &[v * t, v, 0.0], &[v, 0.0, 0.0]);
    }
    let (by, ..) = dahl();
    let (energy, least) = account(&path, &Contact::LuGre(model), &by.plant, &by.input);
    // σ₁v² + σ₂v² = −1 W for one second with x = 0.
    assert!((least + 1.0).abs() < 1e-12 && energy.dissipated == least, "{least} J");
}

#[test]
fn solutions_under_different_drives_do_move_apart() {
    let plant = |constant: f64| SlipPlant {
        model: MaxwellSlip { k: vec![2.0, 3.0], delta: vec![0.1, 0.25] },
        mass: 1.0,
        stiffness: 4.0,
        drive: Harmonic { amplitude: 2.0, omega: 1.3, phase: 0.0, constant },
    };
    let solve = |constant: f64, q: f64| {
        plant(constant).solve(&[q, 0.0, q, q], (0.0, 30.0)).expect("a solution")
    };
    let same = moved_apart(&solve(0.0, 0.0), &solve(0.0, 0.3));
    assert!(same < 1e-12, "under one drive they move apart by {same:e}");
    let other = moved_apart(&solve(0.0, 0.0), &solve(0.1, 0.3));
    assert!(other > 1e-3, "under two drives they move apart by {other:e} only");
}
