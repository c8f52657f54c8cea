//! Friction models against their closed forms.

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{clean, made, off, sensors};

const LUGRE: (f64, f64, f64, f64, f64, f64) = (1.0, 1.5, 0.001, 1e5, 316.2, 0.4);

/// Deflection that the bristle tends to [m], and the whole steady force [N].
fn steady(v: f64) -> (f64, f64) {
    let (f_c, f_s, v_s, sigma_0, _, sigma_2) = LUGRE;
    let force = f_c + (f_s - f_c) * (-(v / v_s) * (v / v_s)).exp();
    (force / sigma_0, force + sigma_2 * v)
}

fn lugre() -> String {
    let (f_c, f_s, v_s, sigma_0, sigma_1, sigma_2) = LUGRE;
    format!(
        "name = 'lugre'\nf_c = {f_c:?}\nf_s = {f_s:?}\nv_s = {v_s:?}\nsigma_0 = {sigma_0:?}\n\
         sigma_1 = {sigma_1:?}\nsigma_2 = {sigma_2:?}\n"
    )
}

fn imposed(friction: &str, part: &str, duration: f64, rate: f64) -> twin::Made {
    made(&format!(
        "title = 't'\nduration = {duration:?}\nrate = {rate:?}\n[plant]\nkind = 'prescribed'\n[friction]\n\
         {friction}[[input.part]]\n{part}{}",
        sensors(&["displacement", "force"])
    ))
}

#[test]
fn lugre_at_constant_speed_bends_exponentially_with_the_travel_and_slides_at_its_steady_force() {
    for v in [2e-4, 1e-3, 5e-3, 0.05] {
        let travel = 3e-4;
        let part =
            format!("shape = 'ramps'\ntimes = [0.0, 1000.0]\nvalues = [0.0, {:?}]\n", 1000.0 * v);
        let record = imposed(&lugre(), &part, travel / v, 300.0 * v / travel);
        let (r, f_ss) = steady(v);
        let worst = off(&record, "force", |t| {
            let left = (-v * t / r).exp();
            f_ss - LUGRE.3 * r * left + LUGRE.4 * v * left
        });
        assert!(worst < 1e-6, "{v} m/s: off by {worst:.1e} N");
        let last = clean(&record, "force").last().unwrap();
        assert!((last - f_ss).abs() < 1e-6, "{v} m/s: slides at {last} N, not at {f_ss} N");
    }
}

#[test]
fn a_lugre_axis_pulled_beyond_its_stiction_slides_where_the_steady_force_is_the_pull() {
    let text = format!(
        "title = 't'\nduration = 60.0\nrate = 10.0\n[plant]\nkind = 'axis'\ninertia = 1.0\n[friction]\n{}\
         [[input.part]]\nshape = 'constant'\nvalue = 1.8\n{}",
        lugre(),
        sensors(&["velocity"])
    );
    let record = made(&text);
    let v = *clean(&record, "velocity").last().unwrap();
    assert!(
        (steady(v).1 - 1.8).abs() < 1e-9,
        "slides at {v} m/s, where friction is {} N",
        steady(v).1
    );
}

#[test]
fn a_stuck_lugre_mass_rings_as_a_damped_spring() {
    // A speed of 1 µm/s bends the bristles to 1e-4 of what they can: linear to about as much.
    let text = format!(
        "title = 't'\nduration = 0.02\nrate = 20000.0\n[plant]\nkind = 'axis'\ninertia = 1.0\n[friction]\n{}\
         [start]\nvelocity = 1e-6\n[[input.part]]\nshape = 'constant'\nvalue = 0.0\n{}",
        lugre(),
        sensors(&["velocity"])
    );
    let rate = f64::midpoint(LUGRE.4, LUGRE.5);
    let omega = (LUGRE.3 - rate * rate).sqrt();
    let worst = off(&made(&text), "velocity", |t| {
        1e-6 * (-rate * t).exp() * ((omega * t).cos() - rate / omega * (omega * t).sin())
    });
    assert!(worst < 2e-10, "off by {worst:.1e} m/s of 1e-6 m/s");
}

#[test]
fn dahl_under_a_sine_settles_on_its_closed_loop_for_every_gamma() {
    let (f_c, sigma) = (0.75, 1.5);
    let travel: f64 = 2.0 * sigma / f_c;
    // The force at the turn, as a share of F_C: roots of (1+a)^(1-γ) − (1−a)^(1-γ) = (1-γ) βσ/F_C.
    let quadratic = (-1.0 + (1.0 + travel * travel).sqrt()) / travel;
    for (gamma, share) in [(0.0, 1.0), (0.5, 1.0), (1.0, (travel / 2.0).tanh()), (2.0, quadratic)] {
        let friction = format!("name = 'dahl'\nf_c = {f_c}\nsigma = {sigma}\ngamma = {gamma:?}\n");
        let part = format!("shape = 'sine'\namplitude = 1.0\nomega = {}\n", std::f64::consts::TAU);
        let record = imposed(&friction, &part, 40.0, 400.0);
        let force = clean(&record, "force");
        let turn = force[39 * 400 + 100];
        assert!(
            (turn - share * f_c).abs() < 1e-9,
            "γ = {gamma}: {turn} N at the turn, not {}",
            share * f_c
        );
        let highest = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        assert!(highest <= f_c, "γ = {gamma}: {highest} N is more than F_C");
    }
}

#[test]
fn dahl_loses_along_a_swing_what_its_closed_form_says() {
    let text = format!(
        "title = 't'\nduration = 0.3\nrate = 1000.0\n[plant]\nkind = 'mass-spring'\nmass = 1.0\nstiffness = 100.0\n\
         [friction]\nname = 'dahl'\nf_c = 3.0\nsigma = 40.0\ngamma = 1.0\n[start]\nposition = 1.0\n[[input.part]]\n\
         shape = 'constant'\nvalue = 0.0\n{}",
        sensors(&["position", "velocity"])
    );
    let record = made(&text);
    let (q, v) = (clean(&record, "position"), clean(&record, "velocity"));
    assert!(v[1..].iter().all(|v| *v < 0.0), "it should not reverse within 0.3 s");
    for k in 0..q.len() {
        let travel = 1.0 - q[k];
        let lost = 3.0 * (travel - 3.0 / 40.0 * (1.0 - (-40.0 / 3.0 * travel).exp()));
        let energy = 0.5 * v[k] * v[k] + 50.0 * q[k] * q[k] + lost;
        assert!((energy - 50.0).abs() < 1e-6, "sample {k}: {energy} J, not 50 J");
    }
}

#[test]
fn the_loop_of_maxwell_slip_encloses_four_k_delta_times_what_each_element_slips() {
    // At 0.01 m/s and 200 Hz a sample is 50 µm: every kink lies on one.
    let part = "shape = 'triangle'\namplitude = 0.02\nperiod = 8.0\n";
    let friction = "name = 'maxwell-slip'\nk = [2.0, 3.0]\ndelta = [2.5e-3, 15e-3]\n";
    let record = imposed(friction, part, 26.0, 200.0);
    let (u, f) = (clean(&record, "displacement"), clean(&record, "force"));
    let cycle = 2000..3600;
    let area: f64 = cycle.map(|k| (u[k + 1] - u[k]) * f64::midpoint(f[k], f[k + 1])).sum();
    let exact = 4.0 * (2.0 * 2.5e-3 * 17.5e-3 + 3.0 * 15e-3 * 5e-3);
    assert!((area - exact).abs() < 1e-12, "{area} J, not {exact} J");
}

#[test]
fn a_maxwell_slip_mass_pulled_slowly_stands_where_springs_and_slipped_elements_balance_the_pull() {
    // Pulled up to 12 N and let go again to 4 N, slowly and overdamped.
    let text = format!(
        "title = 't'\nduration = 400.0\nrate = 1.0\n[plant]\nkind = 'mass-spring'\nmass = 1.0\nstiffness = 100.0\n\
         [friction]\nname = 'maxwell-slip'\nk = [200.0, 300.0]\ndelta = [0.005, 0.02]\nsigma_2 = 60.0\n\
         [[input.part]]\nshape = 'ramps'\ntimes = [0.0, 150.0, 200.0, 350.0]\nvalues = [0.0, 12.0, 12.0, 4.0]\n{}",
        sensors(&["position"])
    );
    let record = made(&text);
    let q = clean(&record, "position");
    // Up: 1 N and 6 N slip from 0.02 m on: 100 q + 7 = 12.
    assert!((q[200] - 0.05).abs() < 1e-9, "{} m at 12 N", q[200]);
    // Back by d: the first element slips the other way from d = 2 · 0.005 m on, and 100 (q−d) − 1 + (6 − 300 d) = 4.
    assert!((q[400] - 0.035).abs() < 1e-9, "{} m at 4 N", q[400]);
}

#[test]
fn coulomb_under_an_imposed_motion_opposes_it_and_keeps_its_force_in_a_dwell() {
    let part = "shape = 'ramps'\ntimes = [0.0, 1.0, 2.0, 3.0]\nvalues = [0.0, 0.1, 0.1, 0.0]\n";
    let record = imposed("name = 'coulomb'\nf_c = 2.0\nsigma_2 = 1.0\n", part, 3.0, 10.0);
    let f = clean(&record, "force");
    for (k, exact) in [(5, 2.1), (15, 2.0), (25, -2.1)] {
        assert!((f[k] - exact).abs() < 1e-12, "sample {k}: {} N, not {exact} N", f[k]);
    }
}
