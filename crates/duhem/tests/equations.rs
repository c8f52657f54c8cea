//! Each equation against a value worked out by hand.

use duhem::{
    Coulomb, Dahl, DuhemForm, FrictionModel, LuGre, MaxwellSlip, closed_form::dahl, form,
    models::step, sgn,
};

fn near(found: f64, by_hand: f64) {
    let error = (found - by_hand).abs();
    assert!(
        error <= 4.0 * f64::EPSILON * by_hand.abs(),
        "{found}, by hand {by_hand}: off by {error:e}"
    );
}

fn x_dot(model: &dyn FrictionModel, x: &[f64], u: f64, u_dot: f64) -> Vec<f64> {
    let mut out = vec![0.0; model.states()];
    model.x_dot(x, u, u_dot, &mut out);
    out
}

fn lugre() -> LuGre {
    LuGre { f_c: 1.0, f_s: 1.5, v_s: 0.001, sigma_0: 1e5, sigma_1: 1e5_f64.sqrt(), sigma_2: 0.4 }
}

#[test]
fn sgn_of_zero_is_zero() {
    assert_eq!([sgn(-0.0), sgn(0.0), sgn(-3.0), sgn(1e-300)], [0.0, 0.0, -1.0, 1.0]);
    assert!(sgn(f64::NAN).is_nan());
}

#[test]
fn coulomb_opposes_the_motion() {
    let coulomb = Coulomb { f_c: 0.75 };
    let force = |u_dot| coulomb.force(&[], &[], 0.0, u_dot);
    assert_eq!([force(2.0), force(0.0), force(-1e-9)], [0.75, 0.0, -0.75]);
}

#[test]
fn dahl_by_hand() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 2.0 };
    // 1 − 0.375/0.75 = 1/2 up, 3/2 down.
    near(x_dot(&dahl, &[0.375], 0.0, 0.2)[0], 1.5 * 0.25 * 0.2);
    near(x_dot(&dahl, &[0.375], 0.0, -0.2)[0], -1.5 * 2.25 * 0.2);
    near(dahl.d_plus(0.375), 0.375);
    near(dahl.d_minus(0.375), 3.375);
    near(dahl.x_dot_as_printed(0.375, 0.2), 1.5 * 0.375 * 0.2);
    // Outside ±F_C the force comes back.
    near(x_dot(&dahl, &[1.5], 0.0, 0.2)[0], -0.3);
}

#[test]
fn dahl_with_gamma_zero_is_stiff_up_to_f_c_and_then_flat() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 0.0 };
    assert_eq!(x_dot(&dahl, &[0.74], 0.0, 0.2), [1.5 * 0.2]);
    assert_eq!(x_dot(&dahl, &[0.75], 0.0, 0.2), [0.0]);
    assert_eq!(x_dot(&dahl, &[0.76], 0.0, 0.2), [-1.5 * 0.2]);
}

#[test]
fn lugre_by_hand() {
    let lugre = lugre();
    near(lugre.r(0.0), 1.5e-5);
    near(lugre.r(-0.001), (1.0 + 0.5 / std::f64::consts::E) * 1e-5);
    near(lugre.steady_force(0.1), 1.04);
    assert_eq!(lugre.steady_force(0.0), 0.0);
    near(x_dot(&lugre, &[5e-6], 0.0, 0.1)[0], 0.1 - 0.1 / 1e-5 * 5e-6);
    near(lugre.force(&[5e-6], &[0.05], 0.0, 0.1), 0.5 + 0.05 * 1e5_f64.sqrt() + 0.04);
    near(lugre.h(&[5e-6], &[0.05], 0.0, 0.1), 0.5 + 0.05 * 1e5_f64.sqrt() + 0.04);
}

#[test]
fn a_maxwell_element_slips_at_its_deadband_and_only_there() {
    assert_eq!([step(0.0), step(-1e-300)], [1.0, 0.0]);
    let model = MaxwellSlip { k: vec![2.0, 3.0], delta: vec![0.25, 1.5] };
    let x = [0.0, 0.0];
    assert_eq!(x_dot(&model, &x, 0.25, 3.0), [3.0, 0.0]);
    assert_eq!(x_dot(&model, &x, 0.25, -3.0), [0.0, 0.0]);
    assert_eq!(x_dot(&model, &x, -0.25, -3.0), [-3.0, 0.0]);
    near(model.force(&[0.5, 1.0], &[], 0.25, 0.0), 2.0 * -0.25 + 3.0 * -0.75);
}

#[test]
fn equation_24_as_printed_sticks_at_the_lower_edge_only() {
    let model = MaxwellSlip { k: vec![2.0], delta: vec![0.25] };
    let printed = |u: f64, u_dot: f64| {
        let mut out = [0.0];
        model.x_dot_as_printed(&[0.0], u, u_dot, &mut out);
        out[0]
    };
    assert_eq!([printed(0.25, 3.0), printed(-0.25, -3.0), printed(-0.26, -3.0)], [3.0, 0.0, -3.0]);
}

#[test]
fn the_displacement_is_as_good_an_independent_variable_as_time() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 2.0 };
    assert_eq!(form::dx_du(&dahl, &[0.375], 0.0, true).unwrap(), [dahl.d_plus(0.375)]);
    assert_eq!(form::dx_du(&dahl, &[0.375], 0.0, false).unwrap(), [dahl.d_minus(0.375)]);
    assert_eq!(form::homogeneous_g(&dahl, -2.0).unwrap(), [-0.0, -2.0]);
    assert_eq!(form::y(&dahl, &[0.375], 0.0, false), Some(0.375));
    assert_eq!(form::y(&Coulomb { f_c: 0.75 }, &[], 0.0, false), Some(-0.75));
    assert_eq!(form::dx_du(&lugre(), &[0.0], 0.0, true), None);
    assert_eq!([form::positive_part(-2.0), form::negative_part(-2.0)], [0.0, -2.0]);
}

#[test]
fn corollary_1_by_hand() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 };
    let (e2, range) = (2.0_f64.exp(), (-1.0, 1.0));
    near(dahl::contraction(&dahl, 2.0), (-8.0_f64).exp());
    near(dahl::alpha_plus(&dahl, 2.0), -0.75 * 2.0_f64.tanh());
    near(dahl::rising(&dahl, range, -1.0), -0.75 * 2.0_f64.tanh());
    near(dahl::falling(&dahl, range, 1.0), 0.75 * 2.0_f64.tanh());
    near(dahl::falling(&dahl, range, 0.0), 0.75 * 2.0_f64.tanh() / e2 - 0.75 * (1.0 - 1.0 / e2));
    near(
        dahl::falling_as_printed(&dahl, range, 0.0),
        0.75 * 2.0_f64.tanh() / e2 - 0.75 * (1.0 - e2),
    );
}
