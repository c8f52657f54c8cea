//! Motor and load as two masses, against what is known in closed form.

use identify::{
    Hold, Rig,
    fit::binding,
    march::{Drive, Dual, Model, Motion, Start, Tolerance, march, replay},
};

const MASS: f64 = 1.5;
const RATIO: f64 = 0.25;
const STEP: f64 = 1e-3;

/// An axis of two masses without friction of the motor's.
fn rig(effect: &str) -> Rig {
    let text = format!(
        "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = {MASS}\ngain = 1.0\noffset = 0.0\n\
         [friction]\nname = \"none\"\nsigma_2 = 0.0\n[channels]\ntime = \"t\"\nvoltage = \"u\"\n\
         position = \"q\"\n[[effect]]\n{effect}\nratio = {RATIO}\n"
    );
    Rig::parse(&text).expect("a rig")
}

/// The masses of motor and load [kg].
fn masses() -> (f64, f64) {
    (MASS / (1.0 + RATIO), MASS * RATIO / (1.0 + RATIO))
}

/// The load's displacement and the motor's velocity, the motor at `ahead` of a load at rest at 0, with the velocity `v`.
fn moved(rig: &Rig, (ahead, v): (f64, f64), time: &[f64], push: f64) -> Motion {
    let model = binding::model::<f64>(rig, &|_| None);
    let values = vec![push; time.len()];
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::Linear };
    let start = Start { q: ahead, v, z: vec![0.0; model.states()], shown: None };
    let tolerance = Tolerance { q: 1e-10, v: 1e-9, z: 1e-9, steps: 10_000_000 };
    march(&model, &drive, time, &start, &tolerance).expect("a motion")
}

fn times(n: u32) -> Vec<f64> {
    (0..n).map(|i| STEP * f64::from(i)).collect()
}

#[test]
fn a_load_rings_on_a_compliant_gear_as_in_closed_form() {
    let (compliance, damping, ahead) = (4e-4, 0.1, 1e-3);
    let rig = rig(&format!(
        "name = \"compliance\"\ncompliance = {compliance}\ndamping = {damping}\nrubs = 1e-12"
    ));
    let time = times(400);
    let motion = moved(&rig, (ahead, 0.0), &time, 0.0);
    let (motor, load) = masses();
    let both = motor * load / MASS;
    let k = 1.0 / compliance;
    let a = 2.0 * damping * (k * load).sqrt() / (2.0 * both);
    let w = (k / both - a * a).sqrt();
    let center = motor * ahead / MASS;
    for (t, q) in time.iter().zip(&motion.q) {
        let apart = ahead * (-a * t).exp() * ((w * t).cos() + a / w * (w * t).sin());
        let exact = center - motor / MASS * apart;
        assert!((q - exact).abs() < 1e-6 * ahead, "{t} s: {q} for {exact}");
    }
    // It rings several times and is damped: the test says something.
    assert!(w * time[399] > 20.0 && a * time[399] > 1.0, "{w} rad/s, {a} 1/s");
}

/// A motor that runs through its gap alone to a load at rest on teeth of this damping ratio, and throws it ahead with so much
/// of its speed.
fn meets(zeta: f64, restitution: f64) {
    let (gap, speed) = (0.01, 0.1);
    let rig =
        rig(&format!("name = \"backlash\"\ngap = {gap}\nrubs = 1e-9\nteeth = 1e-4\nzeta = {zeta}"));
    let time = times(400);
    let motion = moved(&rig, (-0.5 * gap, speed), &time, 0.0);
    let (motor, load) = masses();
    let touch = gap / speed;
    let after = speed * (motor - load * restitution) / MASS;
    let along = speed * motor / MASS * (1.0 + restitution);
    // Until the load has run through the gap and meets the other tooth.
    let parts = gap / (speed * restitution);
    for (i, t) in time.iter().enumerate() {
        let (q, v) = (motion.q[i], motion.v[i]);
        if *t < touch - STEP {
            assert!(q.abs() < 1e-12 && (v - speed).abs() < 1e-9, "{t} s: {q} m, {v} m/s");
        } else if *t > touch + 5e-3 && *t < touch + 0.9 * parts {
            // The impact takes some times that in which the teeth give way.
            let exact = along * (t - touch);
            assert!((v - after).abs() < 1e-6 * speed, "{t} s: {v} m/s for {after} m/s");
            assert!((q - exact).abs() < 2e-3 * gap, "{t} s: {q} m for {exact} m");
        }
    }
}

/// The damping ratio of the reduced mass on teeth of stiffness m/τ² and damping 2ζm/τ, m the load's mass.
fn reduced(zeta: f64) -> f64 {
    zeta * (MASS / masses().0).sqrt()
}

#[test]
fn a_motor_runs_through_its_gap_alone_and_then_takes_the_load_along() {
    // Damped more than critically the teeth part when their force is zero, with a small restitution (Schwager and
    // Pöschel 2007).
    let zeta = reduced(1.0);
    let root = (zeta * zeta - 1.0).sqrt();
    let restitution = (-(zeta / root) * ((zeta + root) / (zeta - root)).ln()).exp();
    assert!((0.05..0.15).contains(&restitution), "{restitution}");
    meets(1.0, restitution);
}

#[test]
fn a_load_bounces_off_teeth_that_are_damped_little() {
    // The same where β < ω: e = exp(−β/ω (π − arctan(2βω/(ω² − β²)))).
    let zeta = reduced(0.2);
    let root = (1.0 - zeta * zeta).sqrt();
    let touches = std::f64::consts::PI - (2.0 * zeta * root / (root * root - zeta * zeta)).atan();
    let restitution = (-(zeta / root) * touches).exp();
    assert!((0.5..0.7).contains(&restitution), "{restitution}");
    meets(0.2, restitution);
}

/// A load that leaves its tooth with this `speed` [m/s] while its motor, which goes at `v` [m/s], is pulled back.
fn coasting(rig: &Rig, time: &[f64], (gap, speed): (f64, f64), v: f64) -> Motion {
    let model = binding::model::<f64>(rig, &|_| None);
    let values = vec![-1.0; time.len()];
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::Linear };
    let mut z = vec![0.0; model.states()];
    z[1] = speed;
    let start = Start { q: 0.5 * gap - 1e-9, v, z, shown: None };
    let tolerance = Tolerance { q: 1e-10, v: 1e-9, z: 1e-9, steps: 10_000_000 };
    march(&model, &drive, time, &start, &tolerance).expect("a motion")
}

#[test]
fn a_load_in_its_gap_is_stopped_by_its_own_friction() {
    let (gap, speed, rubs) = (0.2, 0.1, 0.1);
    let rig = rig(&format!("name = \"backlash\"\ngap = {gap}\nrubs = {rubs}\nteeth = 1e-4"));
    let time = times(900);
    let (motor, load) = masses();
    // The motor pushes it for a while and is then pulled back: the load coasts by v²/2 over its deceleration.
    let motion = coasting(&rig, &time, (gap, speed), speed);
    let slows = rubs / load;
    let coasts = speed * speed / (2.0 * slows);
    let rests = speed / slows;
    // Before the motor, pulled back from its own speed, has come through the gap, the load rests.
    let comes = (speed + (speed * speed + 2.0 * gap / motor).sqrt()) * motor;
    assert!(rests < comes && rests < 0.8, "{rests} s, {comes} s");
    let i = time.iter().position(|t| *t > rests + STEP).expect("a sample");
    assert!((motion.q[i] - coasts).abs() < 1e-5 * coasts, "{} m for {coasts} m", motion.q[i]);
}

#[test]
fn a_load_in_its_gap_is_slowed_by_its_own_viscous_friction() {
    let (gap, speed, drags) = (0.2, 0.1, 2.0);
    let rig = rig(&format!(
        "name = \"backlash\"\ngap = {gap}\nrubs = 1e-12\nteeth = 1e-4\ndrags = {drags}"
    ));
    let time = times(500);
    let (_, load) = masses();
    // The motor goes away from the load, which coasts on.
    let motion = coasting(&rig, &time, (gap, speed), 0.0);
    // Until the motor's other tooth has come: x = v m/d (1 − e^(−t d/m)).
    let fades = load / drags;
    for (q, t) in motion.q.iter().zip(&time).filter(|(_, t)| **t < 2.0 * fades) {
        let exact = speed * fades * (1.0 - (-t / fades).exp());
        assert!((q - exact).abs() < 1e-6 * gap, "{t} s: {q} m for {exact} m");
    }
    assert!(2.0 * fades < time[time.len() - 1], "{fades} s");
}

#[test]
fn the_friction_of_a_load_builds_up_on_its_way() {
    let (gap, speed, rubs, gives) = (0.2, 0.1, 0.1, 0.01);
    let rig = rig(&format!(
        "name = \"backlash\"\ngap = {gap}\nrubs = {rubs}\nteeth = 1e-4\ngives = {gives}"
    ));
    let time = times(700);
    let (_, load) = masses();
    // The motor goes away from the load, which coasts on with bristles that are not bent yet.
    let motion = coasting(&rig, &time, (gap, speed), 0.0);
    // Until it turns: m v²/2 = φ (x − d (1 − e^(−x/d))), by equation (24) with γ = 1.
    let energy = 0.5 * load * speed * speed;
    let taken = |x: f64| rubs * (x - gives * (1.0 - (-x / gives).exp()));
    let (mut low, mut high) = (0.0, 0.1);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if taken(middle) < energy { low = middle } else { high = middle }
    }
    let furthest = motion.q.iter().copied().fold(0.0, f64::max);
    assert!((furthest - low).abs() < 1e-4 * low, "{furthest} m for {low} m");
    // With dry friction it would have come to v²/2 over its deceleration.
    let dry = speed * speed * load / (2.0 * rubs);
    assert!(low > 1.2 * dry, "{low} m, {dry} m");
    let last = motion.q.last().copied().unwrap_or(0.0);
    assert!(last < furthest - 0.1 * gives, "it is thrown back by its bristles");
}

#[test]
fn the_derivatives_of_a_motion_with_a_joint_are_those_of_its_differences() {
    let time = times(300);
    // The time of an impact moves with the gap: in the stage in which the teeth meet they damp for their part of it, or
    // the force would jump there, and the derivative by the gap, over fixed steps, would be off by a third. Where the
    // load's friction builds up within no way at all, differences of motions are those of their steps.
    let joints = [
        (
            "compliance",
            "compliance = 4e-4\ndamping = 0.1\nrubs = 1e-12\ndrags = 0.5",
            ["compliance", "ratio", "damping", "drags"].as_slice(),
            1e-5,
        ),
        (
            "backlash",
            "gap = 1e-3\nrubs = 0.03\nteeth = 2e-3\ngives = 1e-6\ndrags = 0.1",
            &["gap", "ratio", "teeth", "drags"],
            1e-2,
        ),
    ];
    for (name, values, keys, most) in joints {
        let rig = rig(&format!("name = \"{name}\"\n{values}"));
        for key in keys {
            let key = format!("{name}.{key}");
            let value = rig.value(&key).expect("a value");
            let here = moved(&rig, (0.0, 0.0), &time, 2.0);
            let model: Model<Dual<2>> =
                binding::model(&rig, &|own| (own == key).then(|| Dual::variable(value, 0)));
            let drive = vec![2.0; time.len()];
            let drive = Drive::Recorded { values: &drive, first: 0, hold: Hold::Linear };
            let zero = Dual::<2>::from(0.0);
            let start = Start { q: zero, v: zero, z: vec![zero; model.states()], shown: None };
            let mut by = Vec::new();
            replay(&model, (&drive, &time), &here.tape, &start, &mut |_, q, _, _| {
                by.push(q.eps[0]);
            });
            let to = |value: f64| {
                let mut rig = rig.clone();
                rig.set(&key, value).expect("a value");
                moved(&rig, (0.0, 0.0), &time, 2.0)
            };
            let step = 1e-4 * value;
            let (low, high) = (to(value - step), to(value + step));
            let size = by.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            assert!(size > 0.0, "q does not depend on {key}");
            let off = (0..time.len())
                .map(|i| ((high.q[i] - low.q[i]) / (2.0 * step) - by[i]).abs())
                .fold(0.0, f64::max);
            assert!(off < most * size, "{key}: off by {:.1e} of the largest", off / size);
        }
    }
}

#[test]
fn an_encoder_on_the_motor_shows_the_motor_and_hides_the_load() {
    let (compliance, ahead) = (4e-4, 1e-3);
    let joint =
        format!("name = \"compliance\"\ncompliance = {compliance}\ndamping = 0.1\nrubs = 1e-12");
    let time = times(400);
    let [load, motor] = [1, 2].map(|encoder| {
        moved(&rig(&format!("{joint}\nencoder = {encoder}")), (ahead, 0.0), &time, 0.0)
    });
    let (motors, loads) = masses();
    assert_eq!((load.q[0], motor.q[0]), (0.0, ahead));
    for ((load, motor), v) in load.q.iter().zip(&motor.q).zip(&motor.v) {
        // Nothing pushes: the middle of both masses stays where it is.
        let middle = (motors * motor + loads * load) / MASS;
        assert!((middle - motors * ahead / MASS).abs() < 1e-6 * ahead, "{middle} m at {v} m/s");
    }
}
