//! The Dahl closed form against the second way, which shares no formula with it.

use duhem::{
    Dahl, Input,
    closed_form::{Reference, dahl, second_way},
};

/// Around both exponents where the formulas change their kind, and between.
const GAMMAS: [f64; 13] =
    [0.0, 0.25, 0.5, 0.9, 0.999_999, 1.0, 1.000_001, 1.5, 1.999_999, 2.0, 2.5, 3.0, 0.75];

/// Widths of loops, in units of F_C/σ: small, middling, wide.
const WAYS: [f64; 6] = [0.01, 0.3, 1.0, 4.0, 12.0, 200.0];

fn model(gamma: f64) -> Dahl {
    Dahl { f_c: 0.75, sigma: 1.5, gamma }
}

fn agree(what: &str, found: f64, second: f64, (relative, absolute): (f64, f64)) {
    let off = (found - second).abs();
    assert!(
        off <= relative * second.abs() + absolute,
        "{what}: {found} against {second}, off by {:.1e} of it",
        off / second.abs()
    );
}

#[test]
fn the_settled_loop_is_the_same_both_ways() {
    for gamma in GAMMAS {
        for way in WAYS {
            let dahl = model(gamma);
            let range = (-0.3, -0.3 + way * 0.5);
            let (one, two) = (dahl::Loop::new(&dahl, range), second_way::Loop::new(&dahl, range));
            let name = |what: &str| format!("{what} at γ = {gamma}, βσ/F_C = {way}");
            agree(&name("force at u_max"), one.force_at_u_max, two.force_at_u_max(), (1e-12, 0.0));
            // The area of an elastic loop is zero, of a small one of third order in its width.
            agree(&name("area"), one.area(), two.area(), (1e-12, 1e-15 * way));
            agree(&name("lag"), one.lag(), two.lag(), (1e-12, 0.0));
            for part in [0.1, 0.5, 0.9] {
                let u = range.0 + part * (range.1 - range.0);
                for rising in [true, false] {
                    let (a, b) = (one.force(u, rising), two.force(u, rising));
                    agree(&name("force"), a, b, (1e-12, 1e-15));
                }
            }
        }
    }
}

#[test]
fn a_trajectory_is_within_its_bound_of_the_second_way() {
    let input = Input::sine(1.0, 0.1).unwrap();
    let span = (0.0, 150.0);
    for gamma in GAMMAS {
        let dahl = model(gamma);
        let run = dahl::Trajectory::new(&dahl, &input, 0.1, span).unwrap();
        let (mut force, mut u) = (0.1, 0.0);
        for t in input.corners(span.0, span.1).into_iter().chain([span.1]) {
            force = second_way::advance(&dahl, force, input.u(t) - u);
            u = input.u(t);
            let off = (run.force(t) - force).abs();
            assert!(off <= run.error_bound(), "γ = {gamma}, {t} s: off by {off:e} N");
        }
        assert!(run.error_bound() < 2e-12, "{:e} N", run.error_bound());
    }
}

#[test]
fn the_saturation_travel_is_the_same_both_ways() {
    for gamma in GAMMAS {
        match (dahl::saturation_travel(&model(gamma)), second_way::saturation_travel(&model(gamma)))
        {
            (Some(one), Some(two)) => agree(&format!("γ = {gamma}"), one, two, (1e-12, 0.0)),
            (one, two) => assert_eq!(one, two, "γ = {gamma}"),
        }
    }
}

#[test]
fn a_monotone_displacement_is_the_same_both_ways() {
    for gamma in GAMMAS {
        for force in [-0.75, -0.74, -0.3, 0.0, 0.2, 0.7499] {
            for delta_u in [1e-3, -1e-3, 0.1, -0.1, 2.0, -2.0, 40.0] {
                let dahl = model(gamma);
                let name = format!("γ = {gamma}, F = {force} N, Δu = {delta_u} m");
                let one = dahl::advance(&dahl, force, delta_u);
                agree(&name, one, second_way::advance(&dahl, force, delta_u), (1e-12, 1e-15));
                let one = dahl::work(&dahl, force, delta_u);
                agree(&name, one, second_way::work(&dahl, force, delta_u), (1e-12, 1e-15));
            }
        }
    }
}

#[test]
fn the_force_on_a_monotone_piece_is_that_of_the_second_way() {
    for gamma in GAMMAS {
        let dahl = model(gamma);
        for (way, s) in WAYS.into_iter().flat_map(|way| [(way, 1.0), (way, -1.0)]) {
            for share in [-0.8, 0.0, 0.5, 0.999] {
                let (f0, start) = (share * dahl.f_c, 0.7);
                let mut force: Vec<f64> =
                    [0.0, 0.2, 1.0].map(|p| start + s * p * 0.5 * way).to_vec();
                let u = force.clone();
                dahl::Piece::new(&dahl, f0, start, s).forces(&mut force);
                for (u, force) in u.iter().zip(&force) {
                    let second = second_way::advance(&dahl, f0, u - start);
                    let what = format!("force from {f0} N to u = {u} m at γ = {gamma}");
                    agree(&what, *force, second, (0.0, 3e-13 * dahl.f_c));
                    assert!(force.abs() <= dahl.f_c, "{what}: {force} N");
                }
            }
        }
    }
}

#[test]
fn a_small_change_of_the_force_keeps_its_digits() {
    // σΔu to first order in Δu, the next term being γΔuσ/2F_C of it.
    for gamma in GAMMAS {
        let (dahl, way) = (model(gamma), 1e-9);
        let change = dahl::Piece::new(&dahl, 0.0, 0.0, 1.0).force(way);
        let next = 0.5 * gamma * way * dahl.sigma / dahl.f_c;
        agree(&format!("γ = {gamma}"), change, dahl.sigma * way * (1.0 - next), (1e-15, 0.0));
    }
}
