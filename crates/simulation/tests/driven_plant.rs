//! A driven plant is its equation of motion, its Jacobian the derivative of that, its sizes the physics'.

use duhem::{FrictionModel, Input, MODELS, Parameter, Plant, Rig};
use integrate::{Control, Corners, Dynamics, Limits, Outcome, solve, solver};
use simulation::{DrivenPlant, Motion};

fn model(name: &str) -> Box<dyn FrictionModel> {
    let entry = MODELS.iter().find(|entry| entry.name == name).expect("a model of the list");
    let value = |key: &str| -> Parameter {
        match key {
            "f_s" => 1.5.into(),
            "f_c" | "gamma" => 1.0.into(),
            "sigma" => 7.5.into(),
            "v_s" => 0.001.into(),
            "sigma_0" => 1e5.into(),
            "sigma_1" => 1e5_f64.sqrt().into(),
            "sigma_2" => 0.4.into(),
            "k" => vec![2.0, 3.0].into(),
            "delta" => vec![2.5e-3, 15e-3].into(),
            other => panic!("no value for a new key {other}: give it one here"),
        }
    };
    (entry.build)(&entry.keys.iter().map(|key| (*key, value(key))).collect())
        .expect("its parameters")
}

fn driven(name: &str) -> DrivenPlant {
    let input = Input::sine(10.0, 0.001).expect("a sine");
    DrivenPlant::new(model(name), Plant::mass_spring(0.8, 2.0), input, (0.0, 7000.0))
}

fn derivative(motion: &DrivenPlant, t: f64, y: &[f64]) -> Vec<f64> {
    let mut dy = vec![f64::NAN; y.len()];
    motion.derivative(t, y, None, &mut dy);
    dy
}

#[test]
fn the_friction_is_fed_back_into_the_equation_of_motion() {
    for entry in MODELS {
        let motion = driven(entry.name);
        let x: Vec<f64> = motion.model().scale().iter().map(|x| 0.3 * x).collect();
        let y = [&[0.01, -2e-3][..], &x].concat();
        let dy = derivative(&motion, 300.0, &y);
        let mut x_dot = vec![0.0; x.len()];
        motion.model().x_dot(&x, 0.01, -2e-3, &mut x_dot);
        let friction = motion.model().force(&x, &x_dot, 0.01, -2e-3);
        assert_eq!(motion.force(300.0, &y), friction, "{}", entry.name);
        assert_eq!((dy[0], &dy[2..]), (-2e-3, &x_dot[..]), "{}", entry.name);
        // (28): what is left over of the forces.
        let left = 0.8 * dy[1] + 2.0 * 0.01 - (10.0 * 0.3_f64.sin() - friction);
        assert!(left.abs() < 1e-14, "{}: {left:e} N", entry.name);
        assert_eq!(motion.response(300.0, &y), 0.01);
    }
}

#[test]
fn the_jacobian_is_what_differences_say() {
    for entry in MODELS {
        let motion = driven(entry.name);
        let scale = motion.model().scale();
        for (q, v, part) in [(0.02, 3e-3, 0.4), (-0.02, -5e-4, 0.7), (0.0, 0.2, -0.5)] {
            let at = if entry.name == "maxwell-slip" { q } else { 0.0 };
            let x: Vec<f64> = scale.iter().map(|s| at + part * s).collect();
            let y = [&[q, v][..], &x].concat();
            let n = y.len();
            let mut jacobian = vec![f64::NAN; n * n];
            motion.jacobian(10.0, &y, None, &mut jacobian);
            for j in 0..n {
                let h = 1e-5 * [&[0.01, v.abs()][..], &scale].concat()[j];
                let (mut up, mut down) = (y.clone(), y.clone());
                up[j] += h;
                down[j] -= h;
                let (up, down) = (derivative(&motion, 10.0, &up), derivative(&motion, 10.0, &down));
                for i in 0..n {
                    let difference = (up[i] - down[i]) / (2.0 * h);
                    let error = (jacobian[i * n + j] - difference).abs();
                    let size = up[i].abs().max(1e-6) / h;
                    assert!(
                        error <= 1e-5 * difference.abs() + 1e-11 * size,
                        "{}: row {i}, column {j}: {}, by difference {difference}",
                        entry.name,
                        jacobian[i * n + j]
                    );
                }
            }
        }
    }
}

#[test]
fn sizes_span_the_decades_of_the_staircase() {
    assert_eq!(driven("lugre").scale(), [5.0, 0.001, 1.5e-5]);
    let dahl = driven("dahl").scale();
    let ringing = 1.0 / 7.5 * (9.5_f64 / 0.8).sqrt();
    assert!((dahl[1] - ringing).abs() < 1e-15 && dahl[0] == 5.0 && dahl[2] == 1.0, "{dahl:?}");
    let unsprung = Plant { stiffness: 0.0, ..Plant::mass_spring(1.0, 1.0) };
    for entry in MODELS {
        for plant in [unsprung, Rig::PAPER.plant()] {
            let input = Input::sine(0.05, 1.0).unwrap();
            let scale = DrivenPlant::new(model(entry.name), plant, input, (0.0, 1.0)).scale();
            assert!(scale.iter().all(|s| s.is_finite() && *s > 0.0), "{}: {scale:?}", entry.name);
        }
    }
}

#[test]
fn a_drive_has_corners_where_its_slope_jumps_and_not_where_it_turns() {
    let corners = |input: Input| {
        DrivenPlant::new(model("dahl"), Plant::mass_spring(1.0, 1.0), input, (0.0, 10.0))
            .corners()
            .to_vec()
    };
    assert_eq!(corners(Input::sine(1.0, 1.0).unwrap()), [0.0; 0]);
    assert_eq!(corners(Input::triangle(1.0, 1.0).unwrap()).len(), 3);
    assert_eq!(corners(Input::staircase(vec![0.0, 1.0], 1.0, 2.0).unwrap()), [2.0, 3.0]);
}

#[test]
fn with_the_contact_stuck_the_mass_rings_on_spring_and_bristles() {
    // Deflected by a thousandth of the limit and let go: a damped oscillator of stiffness k_s + σ₀.
    let input = Input::sine(1e-9, 1e-3).unwrap();
    let plant = Plant::mass_spring(1.0, 2.0);
    let motion = DrivenPlant::new(model("lugre"), plant, input, (0.0, 0.02));
    let x = 1e-9;
    let run = solve(
        solver("esdirk34").unwrap(),
        &motion.problem(vec![x, 0.0, x]),
        &Control::Tolerance { rtol: 1e-9 },
        Corners::Restart,
        &Limits::default(),
    );
    assert_eq!(run.outcome, Outcome::Solved);
    let (t, y) = run.trajectory.last().unwrap();
    let (damping, stiffness) = (0.5 * (1e5_f64.sqrt() + 0.4), 1e5 + 2.0);
    let omega = (stiffness - damping * damping).sqrt();
    let expected =
        x * (-damping * t).exp() * ((omega * t).cos() + damping / omega * (omega * t).sin());
    // r is 1.5e-5 m: the bristles slip by the part |Δq|/r of x.
    assert!((y[0] - expected).abs() < 1e-4 * x, "{} m, not {expected} m", y[0]);
}
