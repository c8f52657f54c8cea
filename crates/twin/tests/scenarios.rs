//! Scenarios that make no sense are refused in words.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use twin::{SCENARIOS, Scenario, scenario};

/// The gearbox with one thing replaced, and what is said of it.
fn said(from: &str, to: &str) -> String {
    let (_, text) = SCENARIOS.iter().find(|(name, _)| *name == "gearbox").unwrap();
    assert!(text.contains(from), "{from}");
    Scenario::parse(&text.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn a_value_that_makes_no_sense_is_named_with_what_was_expected() {
    for (from, to, words) in [
        ("v_s     = 0.0012", "v_s     = 0.0", "friction.v_s: found 0"),
        ("inertia        = 3e-4", "inertia        = -1.0", "plant's inertia: found -1"),
        ("rate     = 100.0", "rate     = nan", "rate: found NaN"),
        ("rate     = 100.0", "rate     = 1e9", "at most 2e7 samples"),
        (
            "unit     = \"rpm\"",
            "unit     = \"furlong\"",
            "`furlong`, expected one of rad/s, deg/s, rpm",
        ),
        (
            "column   = \"angle_rad\"",
            "column   = \"current_a\"",
            "each quantity and each column once",
        ),
        (
            "quantity = \"force_2\"",
            "quantity = \"voltage\"",
            "current, angle, velocity, force_1 or force_2",
        ),
        ("times  = [0.0, 0.2, 2.0, 6.0]", "times  = [0.0, 3.0, 2.0, 6.0]", "found 2 after 3"),
        ("times  = [0.0, 0.2, 2.0, 6.0]", "times  = [0.0]", "as many times as values"),
        ("radius         = 0.0254", "radios         = 0.0254", "unknown field `radios`"),
        ("name    = \"lugre\"", "name    = \"bristle\"", "unknown variant `bristle`"),
    ] {
        let said = said(from, to);
        assert!(said.contains(words), "{to}: says `{said}`, not `{words}`");
    }
}

#[test]
fn an_imposed_displacement_may_not_jump() {
    let (_, text) = SCENARIOS.iter().find(|(name, _)| *name == "prescribed").unwrap();
    let held = text.replacen("[[input.part]]", "[input]\nhold = 0.01\n[[input.part]]", 1);
    let said = Scenario::parse(&held).unwrap_err().to_string();
    assert!(said.contains("without jumps"), "{said}");
}

#[test]
fn a_name_that_is_in_no_list_is_answered_with_the_list() {
    let said = scenario("gear-box").unwrap_err().to_string();
    for (name, _) in SCENARIOS {
        assert!(said.contains(name), "{said}");
    }
}
