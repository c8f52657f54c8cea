//! What sensors show of a motion, against what is known in closed form.

use identify::{
    Hold, Rig,
    fit::binding,
    march::{Drive, Shown, Start, Tolerance, march},
};

/// An axis of this mass [kg] whose velocity comes late.
fn late(mass: f64, tau: f64) -> Rig {
    let text = format!(
        "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = {mass}\ngain = 1.0\noffset = 0.0\n\
         [friction]\nname = \"none\"\nsigma_2 = 0.0\n[channels]\ntime = \"t\"\nvoltage = \"u\"\n\
         position = \"q\"\nvelocity = \"v\"\n[[effect]]\nname = \"velocity_lag\"\ntau = {tau}\n"
    );
    Rig::parse(&text).expect("a rig")
}

#[test]
fn a_late_velocity_begins_with_what_is_shown() {
    // At 0.2 m/s for long, and from the first sample on driven by 1 N.
    let (mass, tau) = (2.0, 0.03);
    let model = binding::model::<f64>(&late(mass, tau), &|_| None);
    let time: Vec<f64> = (0..100).map(|i| 0.005 * f64::from(i)).collect();
    let values = vec![1.0; time.len()];
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
    let tolerance = Tolerance { q: 1e-9, v: 1e-9, z: 1e-9, steps: 100_000 };
    let worst = |shown: Option<Shown>| {
        let start = Start { q: 0.0, v: 0.2, z: Vec::new(), shown };
        let motion = march(&model, &drive, &time, &start, &tolerance).expect("a motion");
        let exact = |t: f64| 0.2 + (t - tau * (1.0 - (-t / tau).exp())) / mass;
        time.iter().zip(&motion.v).map(|(t, v)| (v - exact(*t)).abs()).fold(0.0, f64::max)
    };
    let shown = |half: f64| worst(Some(Shown { v: 0.2, half }));
    assert!(shown(1e-6) < 1e-9, "{}", shown(1e-6));
    // As if it had been driven so for long it begins with 0.2 m/s less τ times the acceleration.
    assert!((worst(None) - tau / mass).abs() < 1e-9);
    assert!((shown(tau) - 0.5 * tau / mass).abs() < 1e-9);
}

#[test]
fn a_late_velocity_follows_a_line_and_a_corner_as_a_first_order_filter_does() {
    let (mass, tau, step, corner) = (2.0, 0.03, 0.005, 40_u32);
    let rig = late(mass, tau);
    let model = binding::model::<f64>(&rig, &|_| None);
    let time: Vec<f64> = (0..200).map(|i| step * f64::from(i)).collect();
    let values: Vec<f64> = (0..200).map(|i| if i < corner { 1.0 } else { -3.0 }).collect();
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
    let start = Start { q: 0.0, v: 0.2, z: Vec::new(), shown: None };
    let tolerance = Tolerance { q: 1e-9, v: 1e-9, z: 1e-9, steps: 100_000 };
    let motion = march(&model, &drive, &time, &start, &tolerance).expect("a motion");
    let (before, after) = (1.0 / mass, -3.0 / mass);
    let turn = step * f64::from(corner);
    for (t, shown) in time.iter().zip(&motion.v) {
        let exact = if *t <= turn {
            0.2 + before * (t - tau)
        } else {
            let forgotten = (-(t - turn) / tau).exp();
            0.2 + before * turn + after * (t - turn - tau) + (after - before) * tau * forgotten
        };
        assert!((shown - exact).abs() < 1e-9, "{t} s: {shown} m/s for {exact} m/s");
    }
}
