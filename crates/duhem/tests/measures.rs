//! The measures against curves whose numbers are known.

use duhem::{
    Dahl,
    closed_form::dahl,
    measures::{self, Memory, Orientation},
};
use std::f64::consts::{PI, TAU};

/// An ellipse with the half axes 2 m and 3 N, run through clockwise.
fn ellipse(n: u32) -> (Vec<f64>, Vec<f64>) {
    let phase = |i| TAU * f64::from(i) / f64::from(n);
    (0..n).map(|i| (2.0 * phase(i).sin(), 3.0 * phase(i).cos())).unzip()
}

#[test]
fn the_area_of_an_ellipse_comes_with_an_error_that_covers_it() {
    for n in [64, 65, 1000] {
        let (u, f) = ellipse(n);
        let area = measures::area(&u, &f);
        let off = (area.value - 6.0 * PI).abs();
        assert!(
            off <= 1.1 * area.error && area.error < 20.0 * off + 1e-12,
            "{area:?}, off {off:e}"
        );
    }
}

#[test]
fn clockwise_loses_energy_and_counterclockwise_gains_it() {
    let (mut u, mut f) = ellipse(100);
    assert_eq!(measures::orientation(&u, &f), Orientation::Clockwise);
    u.reverse();
    f.reverse();
    assert_eq!(measures::orientation(&u, &f), Orientation::Counterclockwise);
    assert_eq!(measures::orientation(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0]), Orientation::None);
    // With the axes exchanged it turns the other way: the paper's sentence holds there only.
    let (u, f) = ellipse(100);
    assert_eq!(measures::orientation(&f, &u), Orientation::Counterclockwise);
}

#[test]
fn the_settled_dahl_loop_is_clockwise_with_its_area_and_width() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 };
    let settled = dahl::Loop::new(&dahl, (-1.0, 1.0));
    let n = 4000;
    let at = |i: i32| f64::from(i - n) / f64::from(n);
    let up = (0..2 * n).map(|i| (at(i), settled.force(at(i), true)));
    let down = (0..2 * n).map(|i| (-at(i), settled.force(-at(i), false)));
    let (u, f): (Vec<f64>, Vec<f64>) = up.chain(down).unzip();
    let area = measures::area(&u, &f);
    assert_eq!(measures::orientation(&u, &f), Orientation::Clockwise);
    let off = (area.value - settled.area()).abs();
    assert!(off < 1.1 * area.error && area.error < 1e-6, "{area:?}, off by {off:e} J");
    let width = 2.0 * (1.0 - settled.lag());
    assert!((measures::width_at_zero_force(&u, &f).unwrap() - width).abs() < 1e-7);
    let at_zero = measures::forces_at(&u, &f, 0.0);
    assert!((at_zero[0] - settled.force(0.0, true)).abs() < 1e-12 && at_zero.len() == 2);
    assert_eq!(measures::memory(&f, &f, 0.0), Memory::Local);
}

#[test]
fn a_loop_above_zero_has_no_width_there() {
    let (u, f): (Vec<f64>, Vec<f64>) = (vec![0.0, 1.0, 0.5], vec![1.0, 2.0, 3.0]);
    assert_eq!(measures::zero_force(&u, &f), []);
    assert_eq!(measures::width_at_zero_force(&u, &f), None);
    assert_eq!(measures::area(&[], &[]).value, 0.0);
}

#[test]
fn the_work_of_a_spring_is_its_energy() {
    let u: Vec<f64> = (0..=10).map(f64::from).collect();
    let f: Vec<f64> = u.iter().map(|u| 2.0 * u).collect();
    let work = measures::work(&u, &f);
    assert!((work.value - 100.0).abs() < 1e-12 && work.error < 1e-12, "{work:?}");
}
