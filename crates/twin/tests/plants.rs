//! Plants against closed forms and conservation laws.

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{clean, made, off, sensors};
use std::f64::consts::{FRAC_PI_2, PI};

const STILL: &str = "[[input.part]]\nshape = \"constant\"\nvalue = 0.0\n";

#[test]
fn a_mass_on_a_spring_loses_two_coulomb_deflections_of_its_amplitude_per_half_swing_and_then_rests()
{
    // ω = 10 rad/s; sampled at the turning points, one every π/10 s.
    let text = format!(
        "title = 't'\nduration = 6.0\nrate = {}\n[plant]\nkind = 'mass-spring'\nmass = 1.0\nstiffness = 100.0\n\
         [friction]\nname = 'coulomb'\nf_c = 5.0\n[start]\nposition = 0.97\n{STILL}{}",
        10.0 / PI,
        sensors(&["position", "velocity"])
    );
    let record = made(&text);
    let (q, v) = (clean(&record, "position"), clean(&record, "velocity"));
    let mut turns = 0.97;
    for (n, q) in q.iter().enumerate().take(11) {
        assert!((q - turns).abs() < 1e-8, "turn {n}: {q} m, not {turns} m");
        turns = 0.1_f64.copysign(turns) - turns;
    }
    assert!(q[11..].iter().all(|p| *p == q[11]), "it creeps while stuck: {:?} m", &q[11..]);
    assert!(v[11..].iter().all(|v| *v == 0.0), "it moves while stuck: {:?} m/s", &v[11..]);
}

#[test]
fn a_stuck_axis_does_not_move_at_all_before_the_force_exceeds_coulomb_and_then_as_the_cube_of_time()
{
    let text = format!(
        "title = 't'\nduration = 5.0\nrate = 100.0\n[plant]\nkind = 'axis'\ninertia = 2.0\noffset = 0.5\n\
         [friction]\nname = 'coulomb'\nf_c = 3.0\n[[input.part]]\nshape = 'ramps'\ntimes = [0.0, 10.0]\n\
         values = [0.0, 17.0]\n{}",
        sensors(&["force", "position"])
    );
    let record = made(&text);
    let start = 3.5 / 1.7;
    let worst = off(&record, "position", |t| 1.7 * (t - start).max(0.0).powi(3) / 12.0);
    assert!(worst < 1e-9, "off by {worst:.1e} m");
    let stuck = clean(&record, "position").iter().take_while(|q| **q == 0.0).count();
    assert_eq!(stuck, 206, "samples up to 3.5 N at 2.0588 s");
}

#[test]
fn a_free_pendulum_keeps_its_energy_and_has_the_period_of_the_elliptic_integral() {
    let period = {
        // AGM: T = 2π/ω₀ / agm(1, cos θ₀/2).
        let (mut a, mut b) = (1.0_f64, (2.5_f64 / 2.0).cos());
        for _ in 0..10 {
            (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
        }
        2.0 * PI / (0.3 * 9.81 * 0.2 / 0.015_f64).sqrt() / a
    };
    let text = format!(
        "title = 't'\nduration = {}\nrate = {}\n[plant]\nkind = 'pendulum'\ninertia = 0.015\nmass = 0.3\n\
         length = 0.2\ntorque_constant = 0.0\nresistance = 1.0\n[friction]\nname = 'none'\n\
         [start]\nposition = 2.5\n{STILL}{}",
        10.0 * period,
        10.0 / period,
        sensors(&["angle", "velocity"])
    );
    let record = made(&text);
    let (q, v) = (clean(&record, "angle"), clean(&record, "velocity"));
    let energy = |k: usize| 0.0075 * v[k] * v[k] + 0.3 * 9.81 * 0.2 * (1.0 - q[k].cos());
    for k in 0..q.len() {
        let lost = (energy(k) - energy(0)).abs() / energy(0);
        assert!(lost < 1e-7, "sample {k}: {lost:.1e} of the energy");
    }
    for n in 0..=10 {
        let back = (q[10 * n] - 2.5).abs();
        assert!(back < 1e-6, "after {n} periods off by {back:.1e} rad");
    }
}

#[test]
fn a_pendulums_motor_brakes_by_its_back_emf_as_its_voltage_drives_it() {
    // Without weight, the speed goes to V/K_t with the rate K_t²/(R I).
    let text = format!(
        "title = 't'\nduration = 2.0\nrate = 100.0\n[plant]\nkind = 'pendulum'\ninertia = 0.01\nmass = 0.0\n\
         length = 0.0\ntorque_constant = 0.2\nresistance = 2.0\n[friction]\nname = 'none'\n\
         [[input.part]]\nshape = 'constant'\nvalue = 3.0\n{}",
        sensors(&["voltage", "velocity"])
    );
    let worst = off(&made(&text), "velocity", |t| 15.0 * (1.0 - (-2.0 * t).exp()));
    assert!(worst < 1e-7, "off by {worst:.1e} rad/s");
}

#[test]
fn a_drum_without_friction_swings_about_the_angle_at_which_its_springs_balance() {
    let text = format!(
        "title = 't'\nduration = 60.0\nrate = 50.0\n[plant]\nkind = 'drum'\ninertia = 3e-4\nradius = 0.0254\n\
         k_1 = 2.0\nk_2 = 1.5\nf_10 = 0.01\nf_20 = 0.03\nmotor_constant = 16.5\ngear_ratio = 68.8\n\
         offset = 1e-4\n[friction]\nname = 'none'\n{STILL}{}\n[[sensor]]\nquantity = 'velocity'\n\
         column = 'rpm'\nunit = 'rpm'\nat_motor = true\n",
        sensors(&["angle", "force_1", "force_2"])
    );
    let record = made(&text);
    let stiffness = 3.5 * 0.0254 * 0.0254;
    let omega = f64::sqrt(stiffness / 3e-4);
    let rest = (0.02 * 0.0254 - 1e-4) / stiffness;
    let theta = |t: f64| rest * (1.0 - (omega * t).cos());
    let rpm = |t: f64| rest * omega * (omega * t).sin() * 68.8 * 30.0 / PI;
    for (column, worst, allowed) in [
        ("angle", off(&record, "angle", theta), 1e-7),
        ("force_1", off(&record, "force_1", |t| 0.01 + 2.0 * 0.0254 * theta(t)), 1e-8),
        ("force_2", off(&record, "force_2", |t| 0.03 - 1.5 * 0.0254 * theta(t)), 1e-8),
        ("rpm", off(&record, "rpm", rpm), 1e-4),
    ] {
        assert!(worst < allowed, "{column}: off by {worst:.1e}");
    }
}

#[test]
fn an_axis_under_a_held_random_drive_moves_as_its_exact_recursion_from_sample_to_sample() {
    let text = format!(
        "title = 't'\nduration = 20.0\nrate = 100.0\n[plant]\nkind = 'axis'\ninertia = 2.0\ngain = 5.0\n\
         [friction]\nname = 'none'\nsigma_2 = 3.0\n[input]\nhold = 0.01\n[[input.part]]\nshape = 'random-steps'\n\
         amplitude = 1.0\nevery = 0.2\n[[input.part]]\nshape = 'sine'\namplitude = 0.5\nomega = 7.0\n{}",
        sensors(&["voltage", "velocity"])
    );
    let record = made(&text);
    let (u, v) = (clean(&record, "voltage"), clean(&record, "velocity"));
    let decay = (-1.5 * 0.01_f64).exp();
    let mut exact = 0.0;
    for k in 0..v.len() {
        assert!((v[k] - exact).abs() < 1e-7, "sample {k}: {} m/s, not {exact} m/s", v[k]);
        exact = decay * exact + (1.0 - decay) * 5.0 * u[k] / 3.0;
    }
}

#[test]
fn a_mass_driven_at_its_resonance_answers_with_the_phase_and_size_of_its_transfer_function() {
    let text = format!(
        "title = 't'\nduration = 100.0\nrate = 20.0\n[plant]\nkind = 'mass-spring'\nmass = 2.0\nstiffness = 8.0\n\
         [friction]\nname = 'none'\nsigma_2 = 1.0\n[[input.part]]\nshape = 'sine'\namplitude = 3.0\nomega = 2.0\n{}",
        sensors(&["force", "position"])
    );
    let record = made(&text);
    // At resonance q = a/(σ₂ω) sin(ωt − π/2) once settled: 90 s are 22 times its decay.
    let late = clean(&record, "time_s").iter().zip(clean(&record, "position")).skip(1800);
    let worst =
        late.map(|(t, q)| (q - 1.5 * (2.0 * t - FRAC_PI_2).sin()).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-7, "off by {worst:.1e} m");
}
