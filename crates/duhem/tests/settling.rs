//! Where a mass on a spring with Dahl friction settles at a constant force, and how slowly.

use duhem::{
    Dahl,
    closed_form::dahl::{
        advance,
        quasi_static::{QuasiStaticLoop, first_way},
        settling::{Contact, HeldMass},
    },
};

/// The mass-spring of Figure 13, held at `drive` [N].
fn held(drive: f64) -> HeldMass {
    HeldMass { dahl: Dahl { f_c: 0.75, sigma: 7.5, gamma: 1.0 }, stiffness: 1.5, drive }
}

/// Turning points over the plane of states that can stand: q in the range of the spring, F within F_C.
fn grid(plant: &HeldMass) -> Vec<Contact> {
    let rest = plant.drive / plant.stiffness;
    let mut states = Vec::new();
    for i in -4_i32..=4 {
        for j in -4_i32..=4 {
            let (dq, f) = (0.5 * f64::from(i), 0.25 * f64::from(j) * 0.999);
            states.push(Contact { q: rest + dq, force: plant.dahl.f_c * f });
        }
    }
    states
}

/// ∫(F_e − k_s q − F) dq [J] by Simpson's rule.
fn work_by_quadrature(plant: &HeldMass, from: Contact, to: Contact) -> f64 {
    let (n, way) = (20_000_i32, to.q - from.q);
    let mut sum = 0.0;
    for i in 0..=n {
        let dq = way * f64::from(i) / f64::from(n);
        let at = Contact { q: from.q + dq, force: advance(&plant.dahl, from.force, dq) };
        let weight = if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        sum += weight * plant.net_force(at);
    }
    sum * way / f64::from(3 * n)
}

#[test]
fn at_a_turning_point_the_net_force_has_done_no_work() {
    for gamma in [0.0, 0.5, 1.0, 2.0] {
        let mut plant = held(2.0);
        plant.dahl.gamma = gamma;
        for from in grid(&plant) {
            let Some(to) = plant.next_turn(from) else { continue };
            let (work, scale) = (work_by_quadrature(&plant, from, to), plant.stiffness);
            // The quadrature's own error at the kink of γ < 1 is of second order in its step.
            let most = if gamma < 1.0 { 1e-5 } else { 1e-9 };
            assert!(work.abs() < most * scale, "γ = {gamma}, {from:?}: {work:e} J are left");
        }
    }
}

#[test]
fn a_moving_mass_turns_where_its_kinetic_energy_is_spent() {
    let plant = held(2.0);
    let from = Contact { q: 0.3, force: 0.2 };
    for (s, kinetic) in [(1.0, 0.4), (-1.0, 0.4), (-1.0, 3.0)] {
        let to = plant.first_turn(from, s, kinetic);
        let left = kinetic + work_by_quadrature(&plant, from, to);
        assert!(left.abs() < 1e-9, "{left:e} J are left at {} m", to.q);
        assert!(s * (to.q - from.q) > 0.0, "went the wrong way");
    }
}

#[test]
fn any_force_between_the_coulomb_forces_is_a_rest() {
    let plant = held(2.0);
    for force in [-0.75, -0.3, 0.0, 0.5, 0.75] {
        let mut at = Contact { q: (plant.drive - force) / plant.stiffness, force };
        // Rounding may leave the last bit of a net force: a rest is one that a neighbour of q has.
        at.q = [at.q.next_down(), at.q, at.q.next_up()]
            .into_iter()
            .find(|q| plant.net_force(Contact { q: *q, force }) == 0.0)
            .unwrap_or(at.q);
        if let Some(next) = plant.next_turn(at) {
            assert!((next.q - at.q).abs() < 1e-14, "left the rest at F = {force} N");
        }
    }
}

#[test]
fn swings_die_out_as_one_over_n_and_take_the_friction_to_zero() {
    for gamma in [0.5, 1.0, 2.0] {
        let mut plant = held(2.0);
        plant.dahl.gamma = gamma;
        let Dahl { f_c, sigma, .. } = plant.dahl;
        let from = Contact { q: 0.0, force: 0.0 };
        let (some, many) = (plant.settle(from, 3000), plant.settle(from, 30_000));
        // δ → 3F_C K/(2γσ²n) with n counted in cycles of two swings.
        let theory = 3.0 * f_c * (plant.stiffness + sigma) / (gamma * sigma * sigma);
        let found = many.swing * 30_000.0;
        assert!((found / theory - 1.0).abs() < 2e-3, "γ = {gamma}: {found} m, expected {theory} m");
        let slope = (many.rest.force / some.rest.force).abs().log10();
        let theory = -3.0 * plant.stiffness / sigma;
        assert!((slope - theory).abs() < 2e-3, "γ = {gamma}: n^{slope}, expected n^{theory}");
    }
}

#[test]
fn no_trajectory_settles_where_the_paper_has_it() {
    for drive in [-3.0, 0.0, 2.0, 5.0] {
        let plant = held(drive);
        for from in grid(&plant) {
            let now = plant.settle(from, 400);
            if now.swing == 0.0 {
                continue;
            }
            let later = plant.settle(from, 4000);
            let share = |at: f64| at.abs() / plant.dahl.f_c;
            let (now_f, later_f) = (share(now.rest.force), share(later.rest.force));
            // Only what starts on the brink of rest is still near it; ten times as many swings take it
            // away too, by 10^(−3k_s/σ) = 0.25 once the swings are small.
            let brink = plant.net_force(from).abs() < 1e-3;
            assert!(brink || now_f < 0.08, "F_e = {drive} N, {from:?}: |F| = {now_f} F_C");
            assert!(later_f < 0.6 * now_f, "{from:?}: from {now_f} to {later_f} F_C only");
            let (low, high) = plant.range_of_rest(&now);
            let inside = low - 1e-12 <= later.rest.q && later.rest.q <= high + 1e-12;
            assert!(inside, "{} m left [{low}, {high}] m", later.rest.q);
        }
    }
}

#[test]
fn the_slow_loop_of_figure_13_has_its_turns_where_spring_and_friction_balance() {
    let plant = held(0.0);
    let slow = QuasiStaticLoop::new(&plant.dahl, plant.stiffness, 5.0);
    // k_s q + F_C tanh(σq/F_C) = F_e, F_C tanh = F_C to 1e-24: q_max = (5 − 0.75)/1.5 m.
    assert!((slow.q_max() - 4.25 / 1.5).abs() < 1e-14, "q_max = {} m", slow.q_max());
    // ∮F dq of γ = 1: 4F_C q_max − (4F_C²/2σ)·2 tanh(σq_max/F_C), the tanh again 1.
    let area = 4.0 * 0.75 * slow.q_max() - 4.0 * 0.75 * 0.75 / 7.5;
    assert!((slow.area() - area).abs() < 1e-13, "area {} J, expected {area} J", slow.area());
    let by_drive: f64 = (0..4000)
        .map(|i| {
            let f_e = -5.0 + 10.0 * (f64::from(i) + 0.5) / 4000.0;
            (slow.q(f_e, false) - slow.q(f_e, true)) * 10.0 / 4000.0
        })
        .sum();
    assert!((by_drive - area).abs() < 1e-4, "∮q dF_e = {by_drive} J, ∮F_e dq = {area} J");
    assert!((slow.width() - 1.0).abs() < 1e-8, "width {} m", slow.width());
}

#[test]
fn the_slow_first_peak_of_figure_18_is_where_torque_and_friction_balance() {
    let dahl = Dahl { f_c: 0.84, sigma: 7.5, gamma: 1.0 };
    let (k_s, torque) = (4.0 * 0.0254 * 0.0254, 16.5 * 0.05);
    let theta = first_way(&dahl, k_s, torque);
    let left = torque - k_s * theta - dahl.f_c * -(-dahl.sigma * theta / dahl.f_c).exp_m1();
    assert!(left.abs() < 1e-14, "{left:e} N·m are left at {theta} rad");
    assert_eq!(first_way(&dahl, k_s, -torque), -theta);
}
