//! Effects that are neutral, and the two integrators against each other.

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{FRICTION, Stage, span};
use twin::{HiddenEffect, Scenario, make_hidden};

/// Every effect with values at which it does nothing.
const NEUTRAL: &[&str] = &[
    "current_bias\nbias = 0.0",
    "preload_asymmetry\nforce = 0.0",
    "viscous\nsigma_2 = 0.0",
    "stribeck\ndrop = 0.0\nv_s = 0.01",
    "quadratic_drag\nc = 0.0",
    "sublinear_drag\nc = 0.0\nv_0 = 0.1",
    "coulomb\nf_c = 0.0",
    "coulomb_asymmetry\nratio = 0.0",
    "viscous_asymmetry\nc = 0.0",
    "position_friction\nsine = 0.0\nwavenumber = 3.0",
    "load_friction\nratio = 0.0",
    "friction_drift\namount = 0.0\ntau = 5.0",
    "dwell_stiction\ndrop = 0.0\ntau = 1.0",
    "presliding\nsigma = inf",
    "maxwell_slip\nk = 0.0\ndelta = 0.01",
    "cogging\nsine = 0.0\ncosine = 0.0\nwavenumber = 5.0",
    "backlash\ngap = 0.0",
    "compliance\nstiffness = inf",
    "cubic_spring\nk_3 = 0.0",
    "cable_slack\nlevel = 0.0",
    "torque_saturation\nlimit = inf",
    "input_delay\ndelay = 0.0",
    "velocity_lag\ntau = 0.0",
    "tach_gain\nerror = 0.0",
    "tach_bias\nbias = 0.0",
    "load_cell_drift\nrate = 0.0",
    "gravity_unbalance\nsine = 0.0\ncosine = 0.0",
    "inertia\nratio = 0.0",
    "foreign_detent\nratio = 0.0\nat = 0.1\nwidth = 0.1",
    "foreign_acceleration\nratio = 0.0\nhalf = 1.0\ntau = 0.01",
    "foreign_rattle\nmass = 1e-300\nroom = 0.01\nfrequency = 50.0",
    "foreign_heat\nratio = 0.0\nenergy = 1.0\ntau = 5.0",
    "foreign_motor_constant\nratio = 0.0\nu_0 = 1.0",
    "foreign_tone\nforce = 0.0\nomega = 3.0\nphase = 0.0",
    "foreign_random_walk\namount = 0.0\nover = 60.0\nseed = 1",
    "foreign_winding\nratio = 0.0",
    "foreign_deadzone\nzone = 0.0",
    "foreign_sensor_hysteresis\nwidth = 0.0",
    "foreign_fault\nratio = 0.0\nfrom = 2.0\nto = 5.0",
    "foreign_outward\nratio = 0.0\nnear = 0.01\nslow = 0.01",
    "foreign_relaxation\nk = 0.0\ntau = 1.0",
];

#[test]
fn every_effect_is_in_the_list_of_neutral_ones() {
    let named: Vec<&str> = NEUTRAL.iter().filter_map(|text| text.lines().next()).collect();
    assert_eq!(named, HiddenEffect::NAMES);
}

/// Effects that carry states, with which steps are other ones.
const STATES: [&str; 7] =
    ["friction_drift", "dwell", "maxwell", "coulomb\n", "presliding", "foreign_", "velocity_lag"];

/// The worst distance of two records, as a share of the span of its column.
fn apart(a: &twin::Made, b: &twin::Made) -> f64 {
    let columns = a.clean[1..].iter().zip(&b.clean[1..]);
    let far = columns.map(|((_, a), (_, b))| {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        off / span(a).max(1e-30)
    });
    far.fold(0.0, f64::max)
}

#[test]
fn an_effect_with_neutral_values_gives_back_the_record_of_without() {
    for stage in Stage::all() {
        // The one integrator against the other; then neutral effects against each other.
        let without = stage.record("");
        let viscous = stage.record("viscous\nsigma_2 = 0.0");
        let mut fit = 0;
        for effect in NEUTRAL {
            let Some(with) = stage.try_record(effect) else { continue };
            fit += 1;
            let far = apart(&without, &with);
            assert!(far < 1e-6, "{stage:?}\n{effect}\nis off by {far:.1e} of the span");
            if !STATES.iter().any(|name| effect.starts_with(name)) {
                let far = apart(&viscous, &with);
                assert!(far < 1e-9, "{stage:?}\n{effect}\nis off by {far:.1e} of the span");
            }
        }
        assert!(fit > 8, "{stage:?}: only {fit} effects fit");
    }
}

#[test]
fn two_tolerances_agree_to_a_millionth_of_the_span_whatever_is_hidden() {
    struct Nothing;
    impl twin::Hidden for Nothing {}
    const HIDDEN: &[&str] = &[
        "stribeck\ndrop = 0.1\nv_s = 0.02",
        "dwell_stiction\ndrop = 0.2\ntau = 0.5",
        "maxwell_slip\nk = 20.0\ndelta = 5e-3",
        "position_friction\nsine = 0.2\nwavenumber = 30.0",
        "backlash\ngap = 0.01",
        "compliance\nstiffness = 50.0",
        "torque_saturation\nlimit = 0.9",
        "input_delay\ndelay = 0.013",
        "foreign_rattle\nmass = 0.2\nroom = 0.02\nfrequency = 30.0",
        "foreign_heat\nratio = 0.2\nenergy = 0.2\ntau = 3.0",
        "foreign_acceleration\nratio = 0.1\nhalf = 10.0\ntau = 0.1",
        "foreign_random_walk\namount = 0.3\nover = 8.0\nseed = 3",
    ];
    // Every other one: each plant and each friction is among them.
    for stage in Stage::all().into_iter().step_by(2) {
        for effect in HIDDEN {
            let Ok(scenario) = Scenario::parse(&stage.text(&[effect])) else { continue };
            let made = |coarser| make_hidden(&scenario, 1, &Nothing, coarser).unwrap();
            let far = apart(&made(1.0), &made(0.03));
            // Each impact multiplies what differs before it: what rattles is not determined to more.
            let limit = match effect.split_once('\n').unwrap().0 {
                "foreign_rattle" => 3e-2,
                "backlash" => 1e-4,
                // Friction that falls by 5 N·s/m where the drag is 0.5 N·s/m lets a light drum stick and slip.
                "stribeck" => 3e-5,
                _ => 1e-6,
            };
            assert!(far < limit, "{stage:?}\n{effect}\nmoves by {far:.1e} of the span");
        }
    }
}

#[test]
fn an_imposed_motion_that_rests_first_is_relaxed_until_it_moves() {
    // Rest, forth, rest, back, rest.
    let input = "\n[[input.part]]\nshape = 'ramps'\ntimes = [0.0, 0.5, 0.7, 1.2, 1.3, 2.0]\n\
        values = [0.0, 0.0, 0.02, 0.02, -0.01, -0.01]\n";
    let sensor = "\n[[sensor]]\nquantity = 'force'\ncolumn = 'force'\n";
    for friction in FRICTION {
        let made = |effect: &str| {
            let text = format!(
                "title = 't'\nduration = 2.0\nrate = 100.0\n[plant]\nkind = 'prescribed'\n[friction]\n{friction}\n\
                 {input}{sensor}{effect}"
            );
            twin::make(&Scenario::parse(&text).unwrap(), 1).unwrap()
        };
        let without = made("");
        let with = made("\n[[hidden]]\nname = 'viscous'\nsigma_2 = 0.0\n");
        let force = &with.clean[1].1;
        assert!(force[..50].iter().all(|f| *f == 0.0), "{friction}: {} N at rest", force[20]);
        let far = apart(&without, &with);
        assert!(far < 1e-6, "{friction}\nis off by {far:.1e} of the span");
    }
}
