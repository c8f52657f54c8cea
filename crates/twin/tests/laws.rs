//! What each effect does, against closed forms and against the other integrator with other parameters.

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{Run, apart, clean, off};

/// A frictionless axis of 2 kg that coasts.
const COAST: Run = Run {
    plant: "kind = 'axis'\ninertia = 2.0",
    friction: "name = 'none'",
    speed: 3.0,
    parts: &["shape = 'constant'\nvalue = 0.0"],
    sensors: &["voltage", "position", "velocity"],
};
/// The same from rest under 5 N.
const PUSH: Run = Run { speed: 0.0, parts: &["shape = 'constant'\nvalue = 5.0"], ..COAST };
/// An axis with Coulomb friction of 3 N under a force that grows by 2 N/s.
const RAMP: Run = Run {
    friction: "name = 'coulomb'\nf_c = 3.0",
    speed: 0.0,
    parts: &["shape = 'ramps'\ntimes = [0.0, 10.0]\nvalues = [0.0, 20.0]"],
    ..COAST
};
/// A mass on a spring with LuGre friction under two sines.
const LUGRE: Run = Run {
    plant: "kind = 'mass-spring'\nmass = 0.5\nstiffness = 30.0",
    friction: "name = 'lugre'\nf_c = 0.4\nf_s = 0.4\nv_s = 0.01\nsigma_0 = 1e3\nsigma_1 = 20.0\nsigma_2 = 0.5",
    speed: 0.0,
    parts: &[
        "shape = 'sine'\namplitude = 1.0\nomega = 3.0",
        "shape = 'sine'\namplitude = 0.5\nomega = 8.1",
    ],
    sensors: &["force", "position", "velocity"],
};
/// A drum between stiff springs, driven slowly.
const DRUM: Run = Run {
    plant: "kind = 'drum'\ninertia = 3e-4\nradius = 0.02\nk_1 = 200.0\nk_2 = 150.0\nf_10 = 9.0\nf_20 = 8.0\n\
            motor_constant = 1.0\ngear_ratio = 60.0",
    friction: "name = 'coulomb'\nf_c = 0.05\nsigma_2 = 0.05",
    speed: 0.0,
    parts: &["shape = 'sine'\namplitude = 0.15\nomega = 2.0"],
    sensors: &["current", "angle", "velocity", "force_1", "force_2"],
};
/// An imposed sine with Coulomb friction; v = 0.1 cos 2t.
const IMPOSED: Run = Run {
    plant: "kind = 'prescribed'",
    friction: "name = 'coulomb'\nf_c = 2.0",
    speed: 0.0,
    parts: &["shape = 'sine'\namplitude = 0.05\nomega = 2.0"],
    sensors: &["displacement", "velocity", "force"],
};

/// The worst distance of the force on an imposed sine from a function of t, q and v, while it slides.
fn force_off(effect: &str, exact: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let made = IMPOSED.with(&[effect]);
    let rows = clean(&made, "time_s").iter().zip(clean(&made, "force")).skip(1);
    let far = rows.map(|(t, force)| {
        let (q, v) = (0.05 * (2.0 * t).sin(), 0.1 * (2.0 * t).cos());
        if v.abs() < 1e-3 { 0.0 } else { (force - exact(*t, q, v)).abs() }
    });
    far.fold(0.0, f64::max)
}

/// When a plant that was at rest has moved [s].
fn starts(run: &Run, effects: &[&str]) -> f64 {
    let made = run.with(effects);
    let moved = clean(&made, "position").iter().position(|q| q.abs() > 1e-12);
    clean(&made, "time_s")[moved.unwrap_or(0)]
}

#[test]
fn a_current_bias_is_a_constant_added_to_the_input() {
    let parts: &'static [&'static str] = &[
        "shape = 'sine'\namplitude = 1.0\nomega = 3.0",
        "shape = 'sine'\namplitude = 0.5\nomega = 8.1",
        "shape = 'constant'\nvalue = 0.07",
    ];
    let hidden = LUGRE.with(&["current_bias\nbias = 0.07"]);
    let far = apart(&hidden, &Run { parts, ..LUGRE }.with(&[]), "position");
    assert!(far < 1e-8, "off by {far:.1e} m");
    assert!(apart(&hidden, &LUGRE.with(&[]), "force") < 1e-15, "the monitor shows the bias");
}

#[test]
fn the_velocity_sensors_errors_are_what_they_say() {
    let plain = DRUM.with(&["tach_gain\nerror = 0.0"]);
    let gain = DRUM.with(&["tach_gain\nerror = 0.03"]);
    let bias = DRUM.with(&["tach_bias\nbias = -0.02"]);
    for (k, v) in clean(&plain, "velocity").iter().enumerate() {
        assert_eq!(clean(&gain, "velocity")[k], 1.03 * v);
        assert_eq!(clean(&bias, "velocity")[k], v - 0.02);
    }
}

#[test]
fn a_lag_in_the_velocity_sensor_is_behind_a_constant_acceleration_by_its_exponential() {
    let made = PUSH.with(&["velocity_lag\ntau = 0.3"]);
    let far = off(&made, "velocity", |t| 2.5 * (t - 0.3 * (1.0 - (-t / 0.3).exp())));
    assert!(far < 1e-7, "off by {far:.1e} m/s");
}

/// An effect, and a spring's force by time and angle.
type Cell = (&'static str, fn(f64, f64) -> f64);

#[test]
fn load_cells_drift_and_springs_change_as_the_angle_says() {
    let force = |made: &twin::Made, exact: &dyn Fn(f64, f64) -> f64| {
        let rows = clean(made, "time_s").iter().zip(clean(made, "angle"));
        let far = rows.zip(clean(made, "force_1")).map(|((t, q), f)| (f - exact(*t, *q)).abs());
        far.fold(0.0, f64::max)
    };
    let cells: [Cell; 5] = [
        ("load_cell_drift\nrate = 0.01", |t, q| 9.0 + 4.0 * q + 0.01 * t),
        ("preload_asymmetry\nforce = 0.4", |_, q| 9.2 + 4.0 * q),
        ("cubic_spring\nk_3 = 5e5", |_, q| 9.0 + 4.0 * q + 5e5 * (0.02 * q).powi(3) / 2.0),
        ("cable_slack\nlevel = 8.5", |_, q| (0.5 + 4.0 * q).max(0.0)),
        ("foreign_winding\nratio = 0.1", |_, q| 9.0 + 4.0 * q * (1.0 + 0.05 * q)),
    ];
    for (effect, exact) in cells {
        let made = DRUM.with(&[effect]);
        let far = force(&made, &exact);
        assert!(far < 1e-12, "{effect}: off by {far:.1e} N");
        let moved = apart(&made, &DRUM.with(&[]), "angle");
        assert_eq!(moved > 1e-4, !effect.contains("drift"), "{effect}: moved by {moved:.1e} rad");
    }
}

#[test]
fn drag_slows_a_coasting_axis_as_its_law_says() {
    type Coast = (&'static str, fn(f64) -> f64);
    let laws: [Coast; 5] = [
        ("viscous\nsigma_2 = 0.8", |t| 3.0 * (-0.4 * t).exp()),
        ("viscous_asymmetry\nc = 0.8", |t| 3.0 * (-0.4 * t).exp()),
        ("quadratic_drag\nc = 0.5", |t| 3.0 / (1.0 + 0.25 * 3.0 * t)),
        // Far below v_0 it is viscous.
        ("sublinear_drag\nc = 0.8\nv_0 = 1e5", |t| 3.0 * (-0.4 * t).exp()),
        ("coulomb\nf_c = 2.0", |t| (3.0 - t).max(0.0)),
    ];
    for (effect, exact) in laws {
        let far = off(&COAST.with(&[effect]), "velocity", exact);
        assert!(far < 1e-7, "{effect}: off by {far:.1e} m/s");
    }
    let far = off(&COAST.with(&["sublinear_drag\nc = 800.0\nv_0 = 1e-3"]), "velocity", |t| {
        (3.0 - 0.4 * t).max(0.0)
    });
    assert!(far < 2e-6, "far above v_0 it is Coulomb's: off by {far:.1e} m/s");
}

#[test]
fn a_potential_keeps_its_energy() {
    let cases = [
        (COAST, "cogging\nsine = 1.5\ncosine = 0.7\nwavenumber = 5.0", 2.0, 0.0),
        (
            Run { friction: "name = 'none'", speed: 1.5, parts: COAST.parts, ..LUGRE },
            "cubic_spring\nk_3 = 200.0",
            0.5,
            30.0,
        ),
    ];
    for (run, effect, mass, stiffness) in cases {
        let made = run.with(&[effect]);
        let energy = |q: f64, v: f64| {
            let wave = (-1.5 * (5.0 * q).cos() + 0.7 * (5.0 * q).sin()) / 5.0;
            let hard = stiffness * q * q / 2.0 + 50.0 * q.powi(4);
            mass * v * v / 2.0 + if stiffness > 0.0 { hard } else { wave }
        };
        let rows = clean(&made, "position").iter().zip(clean(&made, "velocity"));
        let start = energy(0.0, run.speed);
        let far = rows.map(|(q, v)| (energy(*q, *v) - start).abs()).fold(0.0, f64::max);
        assert!(far < 1e-6 * start, "{effect}: {far:.1e} of {start} J");
    }
}

#[test]
fn what_is_stronger_at_rest_breaks_away_later() {
    let sample = 0.005;
    for (effect, force) in [
        ("stribeck\ndrop = 1.2\nv_s = 0.1", 4.2),
        ("coulomb_asymmetry\nratio = 0.3", 3.9),
        ("foreign_fault\nratio = 0.5\nfrom = -9.0\nto = 99.0", 4.5),
        ("position_friction\ncosine = 0.25\nwavenumber = 2.0", 3.75),
        // It carries half of its load more: F = 3 + F/2.
        ("load_friction\nratio = 0.5", 6.0),
    ] {
        let found = starts(&RAMP, &[effect]);
        assert!((found - force / 2.0).abs() < 2.0 * sample, "{effect}: at {found} s");
    }
    // 2 t = 3 + 1.5 (1 − exp(−t/0.8)), by repeated substitution.
    let exact = (0..200).fold(1.5, |t: f64, _| 1.5 + 0.75 * (1.0 - (-t / 0.8).exp()));
    let found = starts(&RAMP, &["dwell_stiction\ndrop = 1.5\ntau = 0.8"]);
    assert!((found - exact).abs() < 2.0 * sample, "aged: at {found} s, not {exact} s");
}

#[test]
fn age_is_lost_on_the_first_slip() {
    let made = RAMP.with(&["dwell_stiction\ndrop = 1.5\ntau = 0.8"]);
    let begin = (0..200).fold(1.5, |t: f64, _| 1.5 + 0.75 * (1.0 - (-t / 0.8).exp()));
    // Afterwards 2 v̇ = 2 t − 3.
    let late = |t: f64| {
        if t < begin { 0.0 } else { 0.5 * (t * (t - 3.0) - begin * (begin - 3.0)) }
    };
    let far = off(&made, "velocity", late);
    assert!(far < 0.02, "off by {far:.1e} m/s");
}

#[test]
fn the_friction_of_an_imposed_motion_is_what_the_law_says() {
    type Law = (&'static str, fn(f64, f64, f64) -> f64);
    let laws: [Law; 9] = [
        ("friction_drift\namount = 0.3\ntau = 1.7", |t, _, v| {
            2.0 * v.signum() * (1.0 + 0.3 * (1.0 - (-t / 1.7).exp()))
        }),
        ("position_friction\nsine = 0.2\ncosine = -0.1\nwavenumber = 80.0", |_, q, v| {
            2.0 * v.signum() * (1.0 + 0.2 * (80.0 * q).sin() - 0.1 * (80.0 * q).cos())
        }),
        ("position_friction\nslope = 3.0\nq_0 = 0.01", |_, q, v| {
            2.0 * v.signum() * (1.0 + 3.0 * (q - 0.01))
        }),
        ("coulomb_asymmetry\nratio = 0.1", |_, _, v| 2.0 * v.signum() + 0.2),
        ("stribeck\ndrop = 0.5\nv_s = 0.03", |_, _, v| {
            v.signum() * (2.0 + 0.5 * (-(v / 0.03).powi(2)).exp())
        }),
        ("sublinear_drag\nc = 4.0\nv_0 = 0.02", |_, _, v| {
            2.0 * v.signum() + 4.0 * v / (1.0 + (v / 0.02).powi(2)).sqrt()
        }),
        ("foreign_tone\nforce = 0.4\nomega = 9.0\nphase = 0.5", |t, _, v| {
            2.0 * v.signum() - 0.4 * (9.0 * t + 0.5).sin()
        }),
        ("foreign_detent\nratio = 0.4\nat = 0.02\nwidth = 0.005", |_, q, v| {
            2.0 * v.signum() * (1.0 + 0.4 * (-((q - 0.02) / 0.005).powi(2)).exp())
        }),
        ("foreign_outward\nratio = 0.2\nnear = 1e-9\nslow = 1e-9", |_, q, v| {
            2.0 * v.signum() * (1.0 + 0.2 * (q * v).signum())
        }),
    ];
    for (effect, exact) in laws {
        let far = force_off(effect, exact);
        assert!(far < 1e-7, "{effect}: off by {far:.1e} N");
    }
}

#[test]
fn an_effect_that_is_another_parameter_moves_the_plant_as_that_parameter_does() {
    let stribeck = LUGRE.friction.replace("f_s = 0.4", "f_s = 0.6");
    let dry = Run { friction: "name = 'coulomb'\nf_c = 0.4\nsigma_2 = 0.5", ..LUGRE };
    let heavy = "kind = 'mass-spring'\nmass = 0.6\nstiffness = 30.0";
    let pendulum = Run {
        plant: "kind = 'pendulum'\ninertia = 0.02\nmass = 0.3\nlength = 0.15\ntorque_constant = 0.3\nresistance = 0.3",
        friction: "name = 'none'",
        sensors: &["voltage", "angle", "velocity"],
        ..LUGRE
    };
    let more = "kind = 'pendulum'\ninertia = 0.02\nmass = 0.4\nlength = 0.15\ntorque_constant = 0.3\nresistance = 0.3";
    let stribeck: &'static str = stribeck.leak();
    let cases = [
        (LUGRE, "stribeck\ndrop = 0.2\nv_s = 0.01", Run { friction: stribeck, ..LUGRE }),
        (LUGRE, "inertia\nratio = 0.2", Run { plant: heavy, ..LUGRE }),
        (
            dry,
            "presliding\nsigma = 300.0",
            Run {
                friction: "name = 'dahl'\nf_c = 0.4\nsigma = 300.0\ngamma = 1.0\nsigma_2 = 0.5",
                ..LUGRE
            },
        ),
        (
            Run { friction: "name = 'maxwell-slip'\nk = [60.0]\ndelta = [5e-3]", ..LUGRE },
            "maxwell_slip\nk = 40.0\ndelta = 2e-3",
            Run {
                friction: "name = 'maxwell-slip'\nk = [60.0, 40.0]\ndelta = [5e-3, 2e-3]",
                ..LUGRE
            },
        ),
        (
            pendulum,
            "gravity_unbalance\nsine = 0.14715\ncosine = 0.0",
            Run { plant: more, ..pendulum },
        ),
    ];
    for (run, effect, other) in cases {
        let column = run.sensors[1];
        let far = apart(&run.with(&[effect]), &other.with(&[]), column);
        let moved = apart(&run.with(&[]), &other.with(&[]), column);
        assert!(far < 1e-4 * moved, "{effect}: off by {far:.1e} of {moved:.1e}");
    }
}

#[test]
fn a_delay_shifts_the_record_whole() {
    for (delay, samples) in [(0.05, 10), (0.0125, 5)] {
        let effect = format!("input_delay\ndelay = {delay:?}");
        let (late, plain) = (LUGRE.with(&[&effect]), LUGRE.with(&[]));
        let (late, plain) = (clean(&late, "position"), clean(&plain, "position"));
        if delay == 0.05 {
            let pairs = late[samples..].iter().zip(plain);
            let far = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(far < 1e-8, "off by {far:.1e} m");
        } else {
            // Two and a half samples: between the two neighbours.
            let far = (3..late.len())
                .map(|k| (late[k] - f64::midpoint(plain[k - 2], plain[k - 3])).abs());
            let far = far.fold(0.0, f64::max);
            assert!(far < 2e-5, "off by {far:.1e} m");
        }
    }
}

#[test]
fn an_amplifier_bends_a_constant_command() {
    for (effect, force) in [
        ("torque_saturation\nlimit = 4.0", 5.0 / (1.0_f64 + 1.25_f64.powi(8)).powf(0.125)),
        ("foreign_deadzone\nzone = 0.8", 4.2),
        ("foreign_motor_constant\nratio = 0.2\nu_0 = 10.0", 5.25),
    ] {
        let far = off(&PUSH.with(&[effect]), "velocity", |t| force / 2.0 * t);
        assert!(far < 1e-9, "{effect}: off by {far:.1e} m/s");
    }
}

#[test]
fn friction_that_grows_with_the_load_takes_its_share_of_the_drive() {
    let run = Run { friction: RAMP.friction, ..PUSH };
    let far =
        off(&run.with(&["load_friction\nratio = 0.1"]), "velocity", |t| (5.0 - 3.5) / 2.0 * t);
    assert!(far < 1e-9, "off by {far:.1e} m/s");
}

/// How far the motor of a drum is ahead of the load at each sample, by adding up its velocity.
fn ahead(made: &twin::Made) -> Vec<f64> {
    let (mut motor, mut last) = (0.0, 0.0);
    let rows = clean(made, "velocity").iter().zip(clean(made, "angle"));
    rows.map(|(v, q)| {
        motor += 0.005 * f64::midpoint(last, *v);
        last = *v;
        motor - q
    })
    .collect()
}

#[test]
fn a_compliant_joint_is_twisted_by_the_load_over_its_stiffness() {
    let made = DRUM.with(&["compliance\nstiffness = 3.0"]);
    let twist = ahead(&made);
    // The springs hold the load back with 0.14 N·m/rad and 0.02 N·m; it has 5 % of the inertia.
    let springs = clean(&made, "angle").iter().map(|q| (0.14 * q + 0.02) / 3.0);
    let far = twist.iter().zip(springs).skip(100).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let most = twist.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
    assert!(most > 0.02 && far < 0.02 * most, "off by {far:.1e} of {most:.1e} rad");
}

#[test]
fn play_lets_the_motor_be_half_a_gap_ahead_on_both_sides_and_no_more() {
    let made = DRUM.with(&["backlash\ngap = 0.04"]);
    let ahead = ahead(&made);
    let (low, high) = ahead.iter().fold((0.0, 0.0), |(l, h): (f64, f64), a| (l.min(*a), h.max(*a)));
    assert!((-0.0215..-0.0195).contains(&low), "behind by {low} rad");
    assert!((0.0195..0.0215).contains(&high), "ahead by {high} rad");
}

#[test]
fn a_foreign_effect_with_a_memory_forgets_or_keeps_it_as_it_says() {
    // ḟ = k v − f/τ on v = 0.1 cos 2t, from rest.
    let far = force_off("foreign_relaxation\nk = 30.0\ntau = 0.4", |t, _, v| {
        let (a, w, tau) = (3.0, 2.0, 0.4);
        let c = a * tau / (1.0 + w * w * tau * tau);
        2.0 * v.signum() + c * ((w * t).cos() + w * tau * (w * t).sin() - (-t / tau).exp())
    });
    assert!(far < 1e-6, "off by {far:.1e} N");
    // A loose mass of a fifth, in a narrow room: in the mean the axis is heavier by a fifth.
    let rattles = PUSH.with(&["foreign_rattle\nmass = 0.2\nroom = 1e-3\nfrequency = 40.0"]);
    let far = off(&rattles, "velocity", |t| 5.0 / 2.4 * t);
    assert!(far < 0.05, "off by {far:.1e} m/s of 8");
    let lag = PUSH.with(&["foreign_sensor_hysteresis\nwidth = 0.02"]);
    let far = off(&lag, "position", |t| {
        let q = 1.25 * t * t;
        q - 0.02 * (1.0 - (-q / 0.02).exp())
    });
    assert!(far < 1e-6, "off by {far:.1e} m");
}
