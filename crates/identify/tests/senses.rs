//! What sensors show of a motion, against what is known in closed form.

use identify::{
    Hold, Rig,
    fit::binding,
    march::{Drive, Start, Tolerance, march},
};

#[test]
fn a_late_velocity_follows_a_line_and_a_corner_as_a_first_order_filter_does() {
    let (mass, tau, step, corner) = (2.0, 0.03, 0.005, 40_u32);
    let text = format!(
        "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = {mass}\ngain = 1.0\noffset = 0.0\n\
         [friction]\nname = \"none\"\nsigma_2 = 0.0\n[channels]\ntime = \"t\"\nvoltage = \"u\"\n\
         position = \"q\"\nvelocity = \"v\"\n[[effect]]\nname = \"velocity_lag\"\ntau = {tau}\n"
    );
    let rig = Rig::parse(&text).expect("a rig");
    let model = binding::model::<f64>(&rig, &|_| None);
    let time: Vec<f64> = (0..200).map(|i| step * f64::from(i)).collect();
    let values: Vec<f64> = (0..200).map(|i| if i < corner { 1.0 } else { -3.0 }).collect();
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
    let start = Start { q: 0.0, v: 0.2, z: Vec::new() };
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
