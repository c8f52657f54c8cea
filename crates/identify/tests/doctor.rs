//! The record's doctor: a clean record is found clean, and each fault planted in it is found.

mod made;

use identify::doctor::{Examination, FINDINGS, Finding, Severity, examine};
use identify::rig::KINDS;
use identify::{Recording, Rig};
use made::{Made, record, rig_of};
use proptest::prelude::*;

fn look(rig: &Rig, made: &Made) -> Examination {
    let names: Vec<&str> = made.columns.iter().map(|(name, _)| name.as_str()).collect();
    examine(Some(rig), &names, &|name| made.column(name))
}

fn told(findings: &[Finding]) -> String {
    let lines = findings.iter().map(|f| {
        format!("{:?} {} {} {:?}: {}; {}", f.severity, f.kind, f.channel, f.rows, f.text, f.remedy)
    });
    lines.collect::<Vec<_>>().join("\n")
}

const FRICTIONS: &[&str] = &["coulomb", "dahl", "lugre", "maxwell-slip", "none"];

#[test]
fn a_clean_record_of_every_plant_and_model_gives_no_finding() {
    for kind in KINDS {
        for friction in FRICTIONS {
            let rig = rig_of(kind.name, friction);
            let made = record(&rig);
            let seen = look(&rig, &made);
            assert!(
                seen.findings.is_empty(),
                "{} {friction}:\n{}",
                kind.name,
                told(&seen.findings)
            );
            let recording = Recording::new(&rig, &|name| made.column(name)).expect("a record");
            assert!(
                (recording.sample_time() - made::STEP).abs() < 1e-9,
                "{} s",
                recording.sample_time()
            );
            assert_eq!(recording.gaps(), Vec::<usize>::new());
        }
    }
}

#[test]
fn the_facts_of_a_record_are_those_it_was_made_with() {
    let rig = rig_of("axis", "lugre");
    let seen = look(&rig, &record(&rig));
    let fact =
        |name: &str| seen.channels.iter().find(|f| f.name == name).expect("a channel").clone();
    let quantum = fact("position").quantum.expect("a quantum");
    assert!((quantum / made::QUANTUM - 1.0).abs() < 1e-6, "quantum {quantum:e} m");
    let noise = fact("force").noise;
    assert!(
        (noise / made::NOISE - 1.0).abs() < 0.05,
        "noise {noise:e} N, made with {:e}",
        made::NOISE
    );
    let motion = seen.motion.expect("a motion");
    let amplitude = motion.amplitudes.1;
    assert!((amplitude / made::AMPLITUDE - 1.0).abs() < 1e-3, "amplitude {amplitude} m");
    assert_eq!(motion.reversals, made::turns(), "turns");
    let sampling = seen.sampling.expect("a clock");
    assert!((sampling.step - made::STEP).abs() < 1e-9, "step {} s", sampling.step);
}

type Plant = fn(&mut Rig, &mut Made);

/// A fault: the plant, the friction, the kind of finding, what it says, and what is done to the record.
const FAULTS: &[(&str, &str, &str, &str, Plant)] = &[
    ("axis", "lugre", "column", "no column", |_, made| made.drop("position")),
    ("axis", "lugre", "rows", "too few", |_, made| made.cut(5)),
    ("axis", "lugre", "missing", "3 of", |_, made| {
        made.of("force")[100..103].fill(f64::NAN);
    }),
    ("axis", "lugre", "not-finite", "2 samples are infinite", |_, made| {
        made.of("force")[100] = f64::INFINITY;
        made.of("force")[101] = 1e308;
    }),
    ("axis", "lugre", "duplicate", "1 stamps repeat", |_, made| {
        made.of("time")[200] = made.of("time")[199];
    }),
    ("axis", "lugre", "backward", "1 stamps go back", |_, made| {
        made.of("time")[200] = made.of("time")[197];
    }),
    (
        "axis",
        "lugre",
        "gap",
        "1 gaps above 1.5 steps of 0.002 s, the longest 0.042 s",
        |_, made| {
            made.remove(5000..5020);
        },
    ),
    ("axis", "lugre", "jitter", "the steps vary by", |_, made| {
        for (i, t) in made.of("time").iter_mut().enumerate() {
            *t += 1e-4 * (i as f64).sin();
        }
    }),
    ("axis", "lugre", "clock", "no stamp is later", |_, made| made.of("time").fill(1.0)),
    ("axis", "lugre", "controller", "samples every 0.01 s, the record every 0.002 s", |rig, _| {
        rig.controller = Some(identify::rig::Controller {
            kind: "pd".to_owned(),
            kp: 1.0,
            kv: 1.0,
            limit: 10.0,
            sample_time: 0.01,
            hold: identify::Hold::ZeroOrder,
        });
    }),
    ("axis", "lugre", "constant", "is 3 m/s throughout", |_, made| made.of("velocity").fill(3.0)),
    ("axis", "lugre", "saturated", "it looks saturated there", |_, made| {
        made.of("force").iter_mut().for_each(|f| *f = f.clamp(-40.0, 40.0));
    }),
    ("axis", "lugre", "outlier", "1 single samples leave", |_, made| {
        made.of("velocity")[777] = 9.0;
    }),
    ("axis", "lugre", "quantum", "where the rig file states 1e-7 m", |rig, _| {
        rig.channels.get_mut("position").expect("position").quantum = Some(1e-7);
    }),
    ("axis", "lugre", "quantum", "is smoother than steps of 1e-4 m", |rig, _| {
        rig.channels.get_mut("position").expect("position").quantum = Some(1e-4);
    }),
    ("axis", "lugre", "rows", "no column of numbers", |_, made| made.columns.clear()),
    ("axis", "lugre", "sign", "its sign is the other way", |_, made| made.scale("velocity", -1.0)),
    ("axis", "lugre", "sign", "takes energy out", |_, made| made.scale("force", -1.0)),
    ("drum", "lugre", "sign", "the wrong way", |_, made| made.swap("force_1", "force_2")),
    ("drum", "lugre", "sign", "the wrong way", |_, made| made.scale("force_1", -1.0)),
    ("axis", "lugre", "scale", "velocity looks like mm/s", |_, made| made.scale("velocity", 1e3)),
    ("axis", "lugre", "scale", "position looks like mm", |_, made| made.scale("position", 1e3)),
    ("drum", "lugre", "scale", "looks like rpm read as rad/s", |_, made| {
        made.scale("velocity", 9.5493);
    }),
    ("drum", "lugre", "scale", "looks like rev/s", |_, made| made.scale("velocity", 0.159_155)),
    ("drum", "lugre", "scale", "angle looks like deg", |_, made| made.scale("angle", 57.2958)),
    ("drum", "lugre", "scale", "the motor's, not the drum's", |_, made| {
        made.scale("velocity", 68.8);
    }),
    ("drum", "lugre", "scale", "rpm read as rad/s; velocity looks like the motor's", |_, made| {
        made.scale("velocity", 9.5493 * 68.8);
    }),
    ("axis", "lugre", "scale", "does not fit the derivative", |_, made| {
        made.scale("velocity", 1.4);
    }),
    ("axis", "lugre", "delay", "comes 3", |_, made| made.of("velocity").rotate_right(3)),
    ("drum", "lugre", "slope", "where k_1·radius is", |_, made| made.scale("force_1", 1e3)),
    ("axis", "lugre", "unlike", "does not follow the derivative", |_, made| {
        let other: Vec<f64> = made.of("velocity").iter().map(|v| v * v).collect();
        made.of("velocity").copy_from_slice(&other);
    }),
    ("axis", "none", "still", "moves only", |_, made| {
        made.of("position").iter_mut().enumerate().for_each(|(i, q)| *q = 1e-6 * (i % 2) as f64);
    }),
    ("axis", "lugre", "motion", "rows have numbers in all channels", |_, made| {
        for (i, f) in made.of("force").iter_mut().enumerate() {
            *f = if i % 5000 == 0 { *f } else { f64::NAN };
        }
    }),
    (
        "axis",
        "lugre",
        "cannot-tell",
        "cannot tell sigma_0 and sigma_1, because the position's step",
        |_, made| {
            made.of("position").iter_mut().for_each(|q| *q = (*q / 1e-4).round() * 1e-4);
        },
    ),
    (
        "axis",
        "lugre",
        "cannot-tell",
        "cannot tell sigma_0 and sigma_1, because at none of its",
        |_, made| {
            made.keep_from(40.0);
            made.thin(10);
        },
    ),
    ("axis", "lugre", "cannot-tell", "cannot tell f_s and v_s, because", |rig, _| {
        rig.set("v_s", 1e-6).expect("v_s");
    }),
    (
        "axis",
        "lugre",
        "cannot-tell",
        "cannot tell f_c and f_s and v_s and sigma_2, because nothing slides",
        |rig, _| {
            rig.set("sigma_0", 100.0).expect("sigma_0");
        },
    ),
    ("axis", "lugre", "cannot-tell", "cannot tell f_c and offset, because of", |_, made| {
        let there = made.of("velocity").iter().skip(10).position(|v| *v < 0.0).expect("a turn");
        made.cut(there);
    }),
    (
        "axis",
        "lugre",
        "cannot-tell",
        "cannot tell sigma_2, because at the fastest speed",
        |rig, _| {
            rig.set("sigma_2", 0.1).expect("sigma_2");
        },
    ),
    (
        "axis",
        "coulomb",
        "cannot-tell",
        "cannot tell sigma_2, because the speeds span",
        |_, made| {
            let triangle = |i: usize| (i % 2000).min(2000 - i % 2000) as f64;
            made.of("position").iter_mut().enumerate().for_each(|(i, q)| *q = 1e-5 * triangle(i));
        },
    ),
    (
        "axis",
        "lugre",
        "cannot-tell",
        "cannot tell inertia, because accelerations reach",
        |rig, _| {
            rig.set("inertia", 1e-3).expect("inertia");
        },
    ),
    (
        "drum",
        "lugre",
        "cannot-tell",
        "cannot tell k_1 and k_2, because without load cells",
        |rig, _| {
            rig.channels.remove("force_1");
            rig.channels.remove("force_2");
        },
    ),
];

#[test]
fn each_fault_planted_is_found_and_said() {
    for (kind, friction, finding, says, plant) in FAULTS {
        let mut rig = rig_of(kind, friction);
        let mut made = record(&rig);
        plant(&mut rig, &mut made);
        let seen = look(&rig, &made);
        let found = seen.findings.iter().any(|f| f.kind == *finding && f.text.contains(says));
        assert!(
            found,
            "{kind} {friction}: no {finding} with `{says}` among\n{}",
            told(&seen.findings)
        );
        assert!(seen.findings.iter().all(|f| !f.remedy.is_empty() && FINDINGS.contains(&f.kind)));
    }
}

#[test]
fn every_kind_of_finding_is_planted() {
    for kind in FINDINGS {
        assert!(FAULTS.iter().any(|fault| fault.2 == *kind), "{kind} is planted nowhere");
    }
}

#[test]
fn what_is_not_free_and_cannot_be_told_is_a_note() {
    let mut rig = rig_of("axis", "lugre");
    rig.set("v_s", 1e-6).expect("v_s");
    let made = record(&rig_of("axis", "lugre"));
    assert_eq!(look(&rig, &made).findings[0].severity, Severity::Problem);
    rig.free = vec!["f_c".to_owned()];
    assert_eq!(look(&rig, &made).findings[0].severity, Severity::Note);
}

#[test]
fn without_a_rig_the_time_is_guessed_and_each_column_stands_for_itself() {
    let rig = rig_of("axis", "lugre");
    let mut made = record(&rig);
    let names: Vec<String> = made.columns.iter().map(|(name, _)| name.clone()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let seen = examine(None, &names, &|name| made.column(name));
    let kinds: Vec<&str> = seen.findings.iter().map(|f| f.kind).collect();
    assert_eq!(kinds, ["clock"], "{}", told(&seen.findings));
    assert_eq!(seen.sampling.map(|s| s.column).as_deref(), Some("time"));
    made.of("force")[7] = f64::NAN;
    let seen = examine(None, &names, &|name| made.column(name));
    assert!(seen.findings.iter().any(|f| f.kind == "missing" && f.rows == Some((7, 7))));
}

fn cell() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0_f64,
        2 => proptest::sample::select(vec![0.0, -0.0, 1.0, 1e308, -1e308, 1e-308, 5e-324, 1e15, 1e16]),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => any::<f64>(),
    ]
}

fn strange() -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        proptest::collection::vec(cell(), 0..60),
        (cell(), 0..60_usize).prop_map(|(v, n)| vec![v; n]),
        (cell(), cell(), 0..80_usize)
            .prop_map(|(a, d, n)| (0..n).map(|i| a + d * i as f64).collect()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn no_record_is_too_strange_to_be_examined(
        columns in proptest::collection::vec(strange(), 8), kind in 0..5_usize, friction in 0..5_usize,
    ) {
        let rig = rig_of(KINDS[kind].name, FRICTIONS[friction]);
        let named = KINDS[kind].channels.iter().map(|c| c.name.to_owned()).zip(columns);
        let made = Made { columns: named.collect() };
        let names: Vec<&str> = made.columns.iter().map(|(name, _)| name.as_str()).collect();
        let seen = look(&rig, &made);
        let _ = examine(None, &names, &|name| made.column(name));
        if let Err(error) = Recording::new(&rig, &|name| made.column(name)) {
            prop_assert!(!seen.findings.is_empty(), "{error}, and the doctor finds nothing");
        }
    }
}

#[test]
fn a_recording_refuses_what_cannot_be_used_and_names_the_row() {
    let rig = rig_of("drum", "lugre");
    let refuse = |plant: &dyn Fn(&mut Made)| {
        let mut made = record(&rig);
        plant(&mut made);
        Recording::new(&rig, &|name| made.column(name)).expect_err("a record that cannot be used")
    };
    let cases: &[(&dyn Fn(&mut Made), Option<usize>, &str)] = &[
        (&|m| m.of("angle")[9] = f64::NAN, Some(9), "column \"angle\": found no number"),
        (&|m| m.of("angle")[9] = f64::INFINITY, Some(9), "found inf: expected a finite number"),
        (&|m| m.of("current")[3] = 1e308, Some(3), "found 1e308: expected a finite number"),
        (&|m| m.of("time")[5] = 0.0, Some(5), "the time 0 s after 0.008 s"),
        (&|m| m.cut(7), None, "found 7 rows: expected at least 8"),
        (&|m| m.cut(0), None, "found 0 rows: expected at least 8"),
        (&|m| m.drop("angle"), None, "channel angle: no column"),
        (&|m| m.of_vec("angle").truncate(100), None, "found 100 rows: expected"),
    ];
    for (plant, row, says) in cases {
        let error = refuse(*plant);
        assert!(error.to_string().contains(says), "{error}\nexpected: {says}");
        assert_eq!(error.row(), *row, "{error}");
    }
}

#[test]
fn a_channel_in_another_unit_or_at_the_motor_is_the_same_in_the_recording() {
    let rig = rig_of("drum", "lugre");
    let made = record(&rig);
    let plain = Recording::new(&rig, &|name| made.column(name)).expect("a record");
    let text = rig.write().replace(
        "velocity = \"velocity\"",
        "velocity = { column = \"velocity\", unit = \"-rpm\", at = \"motor\", quantum = 0.0688 }",
    );
    let motor = Rig::parse(&text).expect("a rig");
    let mut turned = made.clone();
    turned.scale("velocity", -68.8 * 60.0 / std::f64::consts::TAU);
    let recording = Recording::new(&motor, &|name| turned.column(name)).expect("a record");
    for (a, b) in plain.channels["velocity"].iter().zip(&recording.channels["velocity"]) {
        assert!((a - b).abs() <= 1e-14 + 1e-14 * a.abs(), "{a} rad/s is {b} rad/s");
    }
    assert!(
        (recording.quantum["velocity"] - 1e-3).abs() < 1e-15,
        "the quantum at the drum [rad/s]"
    );
    assert!(look(&motor, &turned).findings.is_empty());
}

#[test]
fn a_step_in_the_columns_own_unit_is_taken_for_that_where_the_samples_move_so() {
    let rig = rig_of("drum", "lugre");
    let mut made = record(&rig);
    let degrees = |q: f64| (q.to_degrees() / 0.01).round() * 0.01;
    made.of("angle").iter_mut().for_each(|q| *q = degrees(*q));
    for (written, found) in
        [(0.01, 0.01_f64.to_radians()), (0.01_f64.to_radians(), 0.01_f64.to_radians())]
    {
        let mut rig = rig.clone();
        let channel = rig.channels.get_mut("angle").expect("an angle");
        (channel.unit, channel.quantum) = (Some("deg".to_owned()), Some(written));
        let recording = Recording::new(&rig, &|name| made.column(name)).expect("a record");
        let quantum = recording.quantum["angle"];
        assert!((quantum / found - 1.0).abs() < 1e-9, "{written}: {quantum} rad for {found} rad");
    }
}
