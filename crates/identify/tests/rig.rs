//! The rig file: what it takes, what it refuses and in which words.

use duhem::{MODELS, Parameter};
use identify::rig::KINDS;
use identify::{Hold, Rig, RigError, Shaft};

/// The example of the design.
const GEARBOX: &str = include_str!("rigs/gearbox.toml");

const SLIP: &str = r#"
title = "slip"
[plant]
kind = "axis"
inertia = 95
gain = 35.15
[friction]
name = "maxwell-slip"
k = [1.0, 2.0, 3.0]
delta = [1e-3, 2e-3, 3e-3]
sigma_2 = 200.0
[fit]
free = ["k", "delta[2]", "offset", "gain"]
[channels]
time = "t"
voltage = { column = "u", unit = "-mV", hold = "zero-order" }
position = "q"
reference = "r"
[controller]
kind = "pd"
kp = 160.18
kv = 243.45
limit = 10
sample_time = 1e-3
"#;

fn rig(text: &str) -> Rig {
    Rig::parse(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn refused(text: &str) -> String {
    Rig::parse(text).expect_err(text).to_string()
}

#[test]
fn the_designs_example_is_read_as_it_stands() {
    let rig = rig(GEARBOX);
    assert_eq!((rig.kind, rig.title.as_str()), ("drum", "gearbox rig"));
    assert_eq!(rig.value("inertia"), Some(3e-4));
    assert_eq!(rig.value("offset"), Some(0.0), "offset [N·m] where the file says none");
    assert_eq!(rig.value("sigma_2"), Some(1.3), "the viscous term [N·m·s/rad] of LuGre");
    assert_eq!(rig.friction.sigma_2, 0.0, "LuGre's viscous term [N·m·s/rad] must not count twice");
    assert_eq!(rig.unit("sigma_0"), "N·m/rad");
    assert_eq!(rig.channels["angle"].quantum, Some(1e-4));
    assert_eq!(rig.channels["velocity"].at, Shaft::Motor);
    assert_eq!(rig.free.len(), 6);
    assert!(!rig.tied());
}

#[test]
fn elements_of_lists_count_from_one_and_a_bare_list_frees_them_all() {
    let mut rig = rig(SLIP);
    let free = ["k[1]", "k[2]", "k[3]", "delta[2]", "offset", "gain"];
    assert_eq!(rig.free_parameters(), free);
    assert_eq!(rig.value("k[2]"), Some(2.0));
    for wrong in ["k[0]", "k[4]", "k", "k[02]", "k[+2]", "k[-1]", "k[", "k]", "f_c[1]", "x.y", ""] {
        assert_eq!(rig.value(wrong), None, "{wrong}");
        assert!(rig.set(wrong, 1.0).is_err(), "{wrong}");
    }
    rig.set("k[2]", 7.5).expect("k[2]");
    assert_eq!(rig.friction.parameters.0["k"], Parameter::List(vec![1.0, 7.5, 3.0]));
    assert_eq!(rig.channels["voltage"].unit.as_deref(), Some("-mV"));
    assert_eq!(rig.controller.as_ref().map(|c| c.hold), Some(Hold::ZeroOrder));
}

#[test]
fn lugre_without_a_stribeck_effect_gets_none_when_only_f_c_moves() {
    let none = GEARBOX.replace("f_s     = 1.0", "f_s     = 0.6");
    let mut tied = rig(&none);
    assert!(tied.tied());
    tied.set("f_c", 0.7).expect("f_c");
    assert_eq!(tied.value("f_s"), Some(0.7), "f_s [N·m] follows f_c");
    tied.set("f_s", 0.9).expect("f_s");
    tied.set("f_c", 0.8).expect("f_c");
    assert_eq!(tied.value("f_s"), Some(0.9), "f_s [N·m] that differs stays");
    let mut both = rig(&none.replace("free = [", "free = [\"f_s\", "));
    both.set("f_c", 0.7).expect("f_c");
    assert_eq!(both.value("f_s"), Some(0.6), "f_s [N·m] that is free itself stays");
    // However it was rounded when the file was written; a real one is further off.
    let rounded = rig(&none.replace("f_s     = 0.6", "f_s     = 0.6000012"));
    assert!(rounded.tied() && rounded.value("f_s") == Some(0.6));
    assert!(!rig(&none.replace("f_s     = 0.6", "f_s     = 0.6006")).tied());
}

#[test]
fn every_parameter_that_can_be_named_can_be_set_within_its_bounds_and_not_outside() {
    for text in [GEARBOX, SLIP] {
        let rig = rig(text);
        for name in rig.parameters() {
            let (low, high) = rig.bounds(&name);
            for value in [low, high, 0.5 * high] {
                let mut other = rig.clone();
                other.set(&name, value).unwrap_or_else(|e| panic!("{e}"));
                assert_eq!(other.value(&name), Some(value), "{name}");
                assert_eq!(Rig::parse(&other.write()).as_ref(), Ok(&other), "{name} = {value:e}");
            }
            for value in [low - high, f64::INFINITY, f64::NAN, 2.0 * high] {
                let mut other = rig.clone();
                let error = other.set(&name, value).expect_err(&name).to_string();
                assert!(error.starts_with(&format!("{name} = ")), "{error}");
                assert!(error.contains(rig.unit(&name)), "{error}");
                assert!(other == rig, "{name} moved by a value that was refused");
            }
        }
    }
}

/// What stands in the file, what is put for it, and what the error says.
const WRONG: &[(&str, &str, &str)] = &[
    (
        "inertia        = 3e-4",
        "inertia = 0",
        "line 6: inertia = 0: expected a positive, finite number [kg·m²]",
    ),
    ("inertia        = 3e-4", "inertia = nan", "line 6: inertia = nan: expected a positive"),
    ("inertia        = 3e-4", "inertia = 1e308", "line 6: inertia = 1e308: expected a positive"),
    ("inertia        = 3e-4", "inertia = \"3\"", "line 6: inertia = \"3\": expected a positive"),
    (
        "inertia        = 3e-4",
        "inerta = 3e-4",
        "line 6: unknown key in [plant] \"inerta\": expected one of kind, inertia, radius",
    ),
    ("inertia        = 3e-4", "inerta = 3e-4", "(did you mean `inertia`?)"),
    (
        "inertia        = 3e-4",
        "",
        "line 4: inertia in [plant] is missing: expected a positive, finite number [kg·m²]",
    ),
    (
        "kind           = \"drum\"",
        "kind = \"drums\"",
        "line 5: unknown kind of plant \"drums\": expected one of drum, mass-spring, axis, pendulum, prescribed (did you mean `drum`?)",
    ),
    ("name    = \"lugre\"", "name = \"lugr\"", "(did you mean `lugre`?)"),
    (
        "f_c     = 0.6",
        "f_c = -0.6",
        "line 17: f_c = -0.6: expected a finite number [N·m], from 1e-60",
    ),
    (
        "sigma_1 = 31.6",
        "sigma_1 = -1.0",
        "line 21: sigma_1 = -1.0: expected a finite number [N·m·s/rad], from 0e0",
    ),
    ("f_c     = 0.6", "f_c = [0.6]", "f_c = [0.6]"),
    ("v_s     = 0.001", "", "line 15: v_s in [friction] is missing: expected a number [rad/s]"),
    ("\"k_2\"]", "\"k_3\"]", "line 25: unknown parameter \"k_3\""),
    ("\"k_2\"]", "\"k_1\"]", "free = \"k_1\": expected each parameter once"),
    ("\"k_2\"]", "3]", "line 25: free = 3: expected a list of names of parameters"),
    ("time     = \"time_s\"", "", "line 27: time in [channels] is missing"),
    ("current  = \"current_a\"", "", "current in [channels] is missing"),
    (
        "current  = \"current_a\"",
        "current = \"time_s\"",
        "expected a column other than that of time",
    ),
    (
        "current  = \"current_a\"",
        "voltage = \"u\"",
        "line 29: unknown key in [channels] \"voltage\"",
    ),
    (
        "quantum = 1e-4",
        "unit = \"mm\"",
        "unit = \"mm\", a unit of length: expected a unit of angle: rad, mrad, deg, °, rev",
    ),
    ("quantum = 1e-4", "unit = \"furlong\"", "unit = \"furlong\": expected a unit of angle"),
    ("quantum = 1e-4", "quantum = -1", "quantum = -1: expected a positive"),
    ("quantum = 1e-4", "colour = 1", "unknown key in angle \"colour\""),
    (
        "quantum = 1e-4",
        "hold = \"cubic\"",
        "hold = \"cubic\": expected \"linear\", \"smooth\" or \"zero-order\"",
    ),
    ("at = \"motor\"", "at = \"shaft\"", "expected \"motor\" or \"drum\""),
    (
        "current  = \"current_a\"",
        "current = { column = \"i\", at = \"motor\" }",
        "only for angle and velocity of a drum",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"coging\"\n[fit]",
        "line 25: unknown effect \"coging\": expected one of current_bias, coulomb_asymmetry, ",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"map-1\"\n[fit]",
        "line 25: unknown effect \"map-1\": expected one of current_bias, ",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"viscous\"\nsigma_2 = 1\n[[effect]]\nname = \"viscous\"\n[fit]",
        "line 28: name = \"viscous\": expected each effect once",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"stribeck\"\ndrop = 0.1\n[fit]",
        "line 24: v_s in [[effect]] is missing",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"stribeck\"\ndrop = 0.1\nv_s = 0\n[fit]",
        "line 27: v_s = 0: expected a positive, finite number [rad/s]",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"stribeck\"\ndrop = -0.1\nv_s = 1\n[fit]",
        "line 26: drop = -0.1: expected a finite number, zero or more [N·m]",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"coulomb_asymmetry\"\nratio = 0.1\nform = 7\n[fit]",
        "line 27: form = 7: expected one of 1, 2, 3",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"tach_gain\"\nerror = 1.5\n[fit]",
        "line 26: error = 1.5: expected a finite number, from -9e-1 to 9e-1",
    ),
    (
        "[fit]",
        "[[effect]]\nname = \"stribeck\"\ndrop = 0.1\nv_s = 1\nf_s = 1\n[fit]",
        "line 28: unknown key in [[effect]] \"f_s\"",
    ),
    ("[fit]", "[fits]", "unknown key in the rig file \"fits\""),
    ("[fit]", "[[effect]]\n[fit]", "name in [[effect]] is missing"),
    ("[fit]", "effect = 3\n[fit]", "unknown key in [friction] \"effect\""),
    ("[friction]", "[friction", "line 15: "),
    ("title = \"gearbox rig\"", "", "title in the rig file is missing"),
    ("title = \"gearbox rig\"", "title = 3", "title = 3: expected a text"),
];

#[test]
fn what_cannot_be_meant_is_refused_with_line_key_and_what_was_expected() {
    for (from, to, says) in WRONG {
        assert!(GEARBOX.contains(from), "the example has no `{from}`");
        let error = refused(&GEARBOX.replacen(from, to, 1));
        assert!(error.contains(says), "{from} -> {to}:\n{error}\nexpected: {says}");
    }
}

#[test]
fn what_a_drive_needs_and_what_a_controller_needs_is_asked_for() {
    let cases = [
        ("gain = 35.15", "", "gain in [plant] is missing"),
        ("voltage = {", "force = {", "unit = \"-mV\", a unit of voltage"),
        (
            "voltage = { column = \"u\", unit = \"-mV\", hold = \"zero-order\" }",
            "force = \"u\"",
            "gain = 35.15: expected no gain",
        ),
        (
            "voltage = {",
            "force = \"f\"\nvoltage = {",
            "expected one of force and voltage, not both",
        ),
        (
            "voltage = { column = \"u\", unit = \"-mV\", hold = \"zero-order\" }",
            "",
            "force or voltage in [channels] is missing",
        ),
        ("reference = \"r\"", "", "reference in [channels] is missing"),
        ("kind = \"pd\"", "kind = \"pid\"", "kind = \"pid\": expected \"pd\""),
        (
            "sample_time = 1e-3",
            "sample_time = 0",
            "sample_time = 0: expected a positive, finite number [s]",
        ),
        ("limit = 10\n", "", "limit in [controller] is missing"),
        ("3e-3]", "3e-3, 4e-3]", "one deadband [m] for each of the 3 stiffnesses"),
        ("2e-3, 3e-3]", "-2e-3, 3e-3]", "line 10: delta = [0.001, -0.002, 0.003]"),
        (
            "[1.0, 2.0, 3.0]",
            &format!("[{}]", "1, ".repeat(1001)),
            "k = a list of 1001: expected a list of at most 1000",
        ),
        ("\"k\", ", "\"k\", \"k[1]\", ", "free = \"k[1]\": expected each parameter once"),
    ];
    for (from, to, says) in cases {
        assert!(SLIP.contains(from), "the example has no `{from}`");
        let error = refused(&SLIP.replacen(from, to, 1));
        assert!(error.contains(says), "{from} -> {to}:\n{error}\nexpected: {says}");
    }
}

#[test]
fn hostile_text_ends_in_an_error_and_is_shown_escaped() {
    let deep = |open: &str, n| format!("title = {}", open.repeat(n));
    for text in [
        deep("[", 100_000),
        deep("{a=", 100_000),
        format!("{}b = 1", "a.".repeat(400_000)),
        format!("[{}b]\n", "a.".repeat(400_000)),
        format!("[{}b]\n", "a.\u{20}".repeat(300_000)),
        format!("[[{}b]]\n", "a.".repeat(400_000)),
        "[[a]]\n".repeat(100_000),
        "a = 1\n".repeat(100_000),
        "x".repeat((1 << 20) + 1),
        String::new(),
        "\u{0}\u{1}".to_owned(),
    ] {
        let error = refused(&text);
        assert!(error.len() < 600, "an error of {} bytes", error.len());
    }
    let error = refused(&GEARBOX.replace("\"lugre\"", "\"\\u001b[31m<script>\""));
    assert!(error.contains("\\u{1b}[31m<script>") && !error.contains('\u{1b}'), "{error}");
}

#[test]
fn a_byte_order_mark_and_crlf_are_no_matter() {
    let text = format!("\u{feff}{}", GEARBOX.trim_start().replace('\n', "\r\n"));
    assert_eq!(rig(&text), rig(GEARBOX));
    let error = refused(&text.replace("inertia        = 3e-4", "inertia = 0"));
    assert!(error.starts_with("line 5: inertia = 0"), "{error}");
}

#[test]
fn every_kind_has_time_first_and_names_channels_that_it_has() {
    for kind in KINDS {
        assert_eq!(kind.channels[0].name, "time", "{}", kind.name);
        let named = kind.drives.iter().copied().chain([kind.displacement]).chain(kind.velocity);
        for name in named {
            assert!(kind.channel(name).is_some(), "{}: no channel {name}", kind.name);
        }
        let missing = RigError::Missing { line: None, key: String::new(), expected: String::new() };
        assert!(!missing.to_string().is_empty());
        for entry in MODELS {
            for unit in entry.units {
                let turned = kind.friction_unit(unit);
                assert_eq!(turned.is_empty(), unit.is_empty(), "{}: [{unit}]", entry.name);
                assert_eq!(
                    turned == *unit,
                    !kind.turns() || unit.is_empty(),
                    "[{unit}] as [{turned}]"
                );
            }
        }
    }
}

#[test]
fn who_names_an_element_0_counts_from_there() {
    let free = |names: &str| {
        let text = SLIP.replace("[\"k\", \"delta[2]\", \"offset\", \"gain\"]", names);
        Rig::parse(&text).map(|rig| rig.free_parameters())
    };
    assert_eq!(free("[\"k[0]\", \"delta[2]\"]").unwrap(), ["k[1]", "delta[3]"]);
    assert_eq!(free("[\"k[1]\", \"delta[2]\"]").unwrap(), ["k[1]", "delta[2]"]);
    assert!(free("[\"k[0]\", \"k[3]\"]").is_err(), "there are three");
}

#[test]
fn what_a_law_usually_is_need_not_be_said() {
    let with = |effect: &str| rig(&format!("{SLIP}[[effect]]\n{effect}\n"));
    let drag = with("name = \"sublinear_drag\"\nc = 1.0\nv_0 = 0.1");
    assert_eq!(drag.value("sublinear_drag.bend"), Some(1.0));
    let stribeck = with("name = \"stribeck\"\ndrop = 1.0\nv_s = 0.1");
    assert_eq!(stribeck.value("stribeck.form"), Some(1.0));
    let said = refused(&format!("{SLIP}[[effect]]\nname = \"stribeck\"\ndrop = 1.0\n"));
    assert!(said.contains("v_s"), "{said}");
}
