//! A fit under an imposed displacement that was measured with noise.

use identify::{
    Hold, Rig,
    fit::{Data, Fit, Options, Seen, fit, simulate},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The truth: `F_C`, `F_S` [N], `v_S` [m/s], σ₀ [N/m], σ₁ and σ₂ [N·s/m].
const TRUTH: [(&str, f64); 6] = [
    ("f_c", 1.0),
    ("f_s", 1.3),
    ("v_s", 0.01),
    ("sigma_0", 2e3),
    ("sigma_1", 3.0),
    ("sigma_2", 4.0),
];

/// Sampling time [s].
const DT: f64 = 0.005;

/// The friction force [N] of LuGre's model at every sample of a displacement [m], from nothing: by the midpoint rule in 400 steps a
/// sample, from its equations.
fn friction(way: &dyn Fn(f64) -> f64, samples: usize) -> Vec<f64> {
    let [f_c, f_s, v_s, sigma_0, sigma_1, sigma_2] = TRUTH.map(|(_, value)| value);
    let h = DT / 400.0;
    let speed = |t: f64| (way(t + 0.1 * h) - way(t)) / (0.1 * h);
    let rate = |z: f64, v: f64| {
        let level = f_c + (f_s - f_c) * (-(v / v_s).powi(2)).exp();
        v - sigma_0 * v.abs() / level * z
    };
    let (mut z, mut force) = (0.0, Vec::new());
    for i in 0..samples {
        let t = i as f64 * DT;
        let v = speed(t);
        force.push(sigma_0 * z + sigma_1 * rate(z, v) + sigma_2 * v);
        for k in 0..400 {
            let t = t + f64::from(k) * h;
            let half = z + 0.5 * h * rate(z, speed(t));
            z += h * rate(half, speed(t + 0.5 * h));
        }
    }
    force
}

/// The fit of a record of this displacement, seen with so much noise [m] and its force to 1 mN, from values 2 % off.
fn fitted(way: &dyn Fn(f64) -> f64, noise: f64) -> Fit {
    let samples = 8000;
    let mut random = ChaCha8Rng::seed_from_u64(21);
    let mut noisy = |value: f64, size: f64| -> f64 {
        let drawn: f64 = StandardNormal.sample(&mut random);
        value + size * drawn
    };
    let time: Vec<f64> = (0..samples).map(|i| i as f64 * DT).collect();
    let input = time.iter().map(|t| noisy(way(*t), noise)).collect();
    let force = friction(way, samples).into_iter().map(|f| noisy(f, 1e-3)).collect();
    let seen = Seen::new("force", force, 0.0);
    let driven = Data::driven(time, input, Hold::Linear, seen.clone());
    let data = Data { displacement: None, force: Some(seen), ..driven };
    let given = |(i, (name, value)): (usize, (&str, f64))| {
        format!("{name} = {}\n", value * if i % 2 == 0 { 1.02 } else { 0.98 })
    };
    let values: String = TRUTH.into_iter().enumerate().map(given).collect();
    let free = TRUTH.map(|(name, _)| format!("\"{name}\"")).join(", ");
    let rig = format!(
        "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"lugre\"\n{values}\
         [fit]\nfree = [{free}]\n[channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n"
    );
    let rig = Rig::parse(&rig).expect("a rig file");
    let options = Options { profiles: false, bootstrap: 0, models: false, ..Options::default() };
    let fit = fit(&rig, &data, &options).expect("a fit");
    // The gap is what the traces differ by, in newtons, and what a simulation of the fitted rig says.
    let (trace, gap) = (&fit.traces[0], fit.gap[0].after);
    let off = trace.measured.iter().zip(&trace.after).map(|(m, s)| (m - s).powi(2));
    let rms = (off.sum::<f64>() / samples as f64).sqrt();
    assert!((rms / gap - 1.0).abs() < 1e-6, "{gap} N, by the traces {rms} N");
    let again = simulate(&fit.rig, &data, None).expect("a motion").gap[0].after;
    assert!((again / gap - 1.0).abs() < 0.01, "{gap} N, simulated {again} N");
    fit
}

/// Every parameter within so many of its standard errors, which are less than this share of it.
fn is_found(fit: &Fit, errors: f64, share: f64) {
    for (name, truth) in TRUTH {
        let found = fit.parameters.iter().find(|p| p.name == name).expect("it is free");
        let (off, error) = (found.found - truth, found.standard_error);
        assert!(off.abs() < errors * error, "{name} is {off} off, ± {error}");
        assert!(error < share * truth, "{name}: ± {error} of {truth}");
    }
}

#[test]
fn the_noise_of_a_displacement_does_not_weaken_a_bristle() {
    let sine = |t: f64| 3e-3 * (4.0 * t).sin() + 1e-3 * (9.1 * t).sin();
    let fit = fitted(&sine, 3e-6);
    is_found(&fit, 4.0, 0.012);
    assert!((fit.variance - 1.0).abs() < 0.2, "{} of the noise's variance", fit.variance);
}

#[test]
fn the_force_that_is_seen_where_a_displacement_turns_does_not_decide_over_a_bristle() {
    // Forth and back at six speeds, with rests, every turn at a sample, which shows the force after it.
    let (long, speeds) = (0.405, [0.1, 0.0, -0.02, 0.005, 0.0, -0.1, 0.03, -0.015]);
    let way = |t: f64| {
        let share = (t / (8.0 * long)).rem_euclid(1.0) * 8.0;
        let gone = |(k, v): (usize, &f64)| v * long * (share - k as f64).clamp(0.0, 1.0);
        speeds.iter().enumerate().map(gone).sum()
    };
    is_found(&fitted(&way, 1e-7), 4.0, 0.02);
}
