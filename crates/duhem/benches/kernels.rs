//! One right-hand side of each model, and one closed-form update.

use criterion::{Criterion, criterion_group, criterion_main};
use duhem::{
    Coulomb, Dahl, FrictionModel, LuGre, MaxwellSlip,
    closed_form::{dahl, lugre, maxwell_slip},
};
use std::hint::black_box;

fn models() -> Vec<(&'static str, Box<dyn FrictionModel>)> {
    let k = (0..10).map(|i| 1.0 + 0.8 * f64::from(i)).collect();
    let delta = (0..10).map(|i| 1.5e-3 + 0.9e-3 * f64::from(i)).collect();
    let lugre = LuGre { f_c: 1.0, f_s: 1.5, v_s: 1e-3, sigma_0: 1e5, sigma_1: 316.0, sigma_2: 0.4 };
    vec![
        ("coulomb", Box::new(Coulomb { f_c: 0.75 })),
        ("dahl", Box::new(Dahl { f_c: 0.75, sigma: 1.5, gamma: 0.25 })),
        ("lugre", Box::new(lugre)),
        ("maxwell-slip", Box::new(MaxwellSlip { k, delta })),
    ]
}

fn right_hand_sides(c: &mut Criterion) {
    for (name, model) in models() {
        let x = model.scale().iter().map(|scale| 0.5 * scale).collect::<Vec<f64>>();
        let mut x_dot = x.clone();
        c.bench_function(&format!("right-hand side/{name}"), |b| {
            b.iter(|| {
                model.x_dot(black_box(&x), black_box(1e-3), black_box(0.1), &mut x_dot);
                model.force(black_box(&x), black_box(&x_dot), 1e-3, 0.1)
            });
        });
    }
}

fn updates(c: &mut Criterion) {
    for gamma in [0.25, 1.0, 2.0] {
        let model = Dahl { f_c: 0.75, sigma: 1.5, gamma };
        c.bench_function(&format!("update/dahl, gamma {gamma}"), |b| {
            b.iter(|| dahl::advance(&model, black_box(0.1), black_box(0.2)));
        });
    }
    let model = LuGre { f_c: 1.0, f_s: 1.5, v_s: 1e-3, sigma_0: 1e5, sigma_1: 316.0, sigma_2: 0.4 };
    c.bench_function("update/lugre", |b| {
        b.iter(|| lugre::advance(&model, black_box(1e-6), black_box(1e-5), black_box(1e-3)));
    });
    c.bench_function("update/maxwell-slip, one element", |b| {
        b.iter(|| maxwell_slip::stop(black_box(1e-3), black_box(2e-3), black_box(2e-3)));
    });
}

criterion_group!(kernels, right_hand_sides, updates);
criterion_main!(kernels);
