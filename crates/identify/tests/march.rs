//! The march against the simulation's own methods and closed forms.

use identify::{
    Hold,
    march::{Balance, Contact, Drive, Model, Start, Tolerance, march},
};

fn p6() -> Model<f64> {
    Model {
        balance: Balance {
            mass: 3e-4,
            gain: 16.5,
            constant: 0.0,
            stiffness: 4.0 * 0.0254 * 0.0254,
            damping: 0.0,
            gravity: 0.0,
        },
        contact: Contact::LuGre {
            f_c: 0.6,
            f_s: 1.0,
            v_s: 1e-3,
            sigma_0: 1e3,
            sigma_1: 1000.0_f64.sqrt(),
        },
        sigma_2: 1.3,
        offset: 0.0,
    }
}

#[test]
fn speed() {
    let time: Vec<f64> = (0..5001).map(|i| f64::from(i) * 0.01).collect();
    let u: Vec<f64> = time.iter().map(|t| 0.05 * (0.2 * std::f64::consts::PI * t).sin()).collect();
    let start = Start { q: 0.0, v: 0.0, z: vec![0.0] };
    let drive = Drive::Recorded { values: &u, hold: Hold::Linear };
    let mut last: Option<Vec<f64>> = None;
    for e in [3, 4, 5, 6, 7, 8, 9] {
        let r = 10f64.powi(-e);
        let tol = Tolerance { q: r * 0.3, v: r * 0.2, z: r, steps: 10_000_000 };
        let t = std::time::Instant::now();
        let m = march(&p6(), &drive, &time, &start, &tol).unwrap();
        let dt = t.elapsed();
        let d = last.map_or(f64::NAN, |l| {
            l.iter().zip(&m.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        println!("{r:e} steps {} {dt:?} change {d:.1e} end {}", m.tape.steps(), m.q[5000]);
        last = Some(m.q);
    }
}
