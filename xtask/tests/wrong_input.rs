//! Wrong input gets one clear error with file, line and key, exit code 4, and nothing is written.

mod common;

use common::{Project, REAL, small};

/// Runs a TOML that must be refused; the error must hold each of `words`.
fn refused(text: &str, words: &[&str]) {
    let project = Project::new(&[("wrong.toml", text)]);
    let before = project.files("");
    let ran = project.run(&["reproduce", "wrong"]);
    assert_eq!(ran.code, Some(4), "{words:?}: {ran:?}");
    assert_eq!(ran.err.matches("error:").count(), 1, "{}", ran.err);
    assert!(ran.err.len() < 1000, "an error of {} bytes", ran.err.len());
    assert!(ran.err.contains("wrong.toml:"), "no file and line: {}", ran.err);
    for word in words {
        assert!(ran.err.contains(word), "no `{word}` in: {}", ran.err);
    }
    assert_eq!(
        common::difference(&before, &project.files("")),
        None,
        "{words:?}: something was written"
    );
}

/// The line that holds `mark` in a text, as an error names it.
fn line(text: &str, mark: &str) -> String {
    let index = text.lines().position(|line| line.contains(mark)).expect("the mark");
    format!("wrong.toml:{}:", index + 1)
}

fn changed(from: &str, to: &str) -> String {
    let text = small("\"rk4\", \"dopri5\"");
    assert!(text.contains(from), "the small experiment has no `{from}`");
    text.replacen(from, to, 1)
}

#[test]
fn the_small_experiment_itself_is_accepted() {
    let project = Project::new(&[("right.toml", &small("\"rk4\""))]);
    let ran = project.run(&["reproduce", "right"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
}

#[test]
fn a_negative_gamma_is_refused() {
    let text = changed("gamma = [1.0, 2.0]", "gamma = [-1.0]");
    refused(&text, &[&line(&text, "sweep "), "study[0].sweep.gamma", "-1", "zero or more"]);
}

#[test]
fn a_negative_coulomb_force_is_refused() {
    let text = changed("f_c = 0.75", "f_c = -0.75");
    refused(&text, &[&line(&text, "model "), "study[0].model.f_c", "-0.75", "positive"]);
}

#[test]
fn a_nan_is_refused() {
    let text = changed("sigma = 1.5", "sigma = nan");
    refused(&text, &["study[0].model.sigma", "NaN", "finite"]);
    let text = changed("amplitude = 1.0", "amplitude = nan");
    refused(&text, &[&line(&text, "input "), "study[0].input.amplitude", "NaN"]);
    let text = changed("rtol      = [1e-3, 1e-6]", "rtol = [nan]");
    refused(&text, &["study[0].rtol", "NaN", "from 1e-14"]);
}

#[test]
fn an_unknown_key_is_refused_with_the_near_miss() {
    let text = changed("periods   = 1", "periodes  = 1");
    refused(&text, &[&line(&text, "periodes"), "periodes", "did you mean `periods`?"]);
    let text = changed("sigma = 1.5", "sgima = 1.5");
    refused(&text, &[&line(&text, "sgima"), "study[0].model.sgima", "did you mean `sigma`?"]);
    let text = changed("amplitude = 1.0", "amplitud = 1.0");
    refused(&text, &["study[0].input.amplitud", "did you mean `amplitude`?"]);
}

#[test]
fn an_unknown_solver_is_refused_with_the_near_miss() {
    let text = changed("\"dopri5\"", "\"dorpi5\"");
    refused(
        &text,
        &[&line(&text, "solvers "), "study[0].solvers", "`dorpi5`", "did you mean `dopri5`?"],
    );
    let text = changed("\"dopri5\"", "\"@implict\"");
    refused(&text, &["study[0].solvers", "did you mean `@implicit`?"]);
}

#[test]
fn other_unknown_names_are_refused_with_the_near_miss() {
    let text = changed("name = \"dahl\"", "name = \"dahll\"");
    refused(&text, &["study[0].model.name", "did you mean `dahl`?"]);
    let text = changed("shape = \"sine\"", "shape = \"sin\"");
    refused(&text, &["study[0].input.shape", "did you mean `sine`?"]);
    let text = changed("kind        = \"work_precision\"", "kind = \"work_precison\"");
    refused(&text, &["figure[0].kind", "did you mean `work_precision`?"]);
    let text = changed("corners   = [\"restart\"]", "corners = [\"restarts\"]");
    refused(&text, &["study[0].corners", "did you mean `restart`?"]);
}

#[test]
fn an_empty_sweep_is_refused() {
    let text = changed("gamma = [1.0, 2.0]", "gamma = []");
    refused(&text, &[&line(&text, "sweep "), "study[0].sweep.gamma", "an empty list"]);
}

#[test]
fn impossible_steps_are_refused() {
    for (step, shown) in
        [("0", "0.0"), ("1e-300", "1e-300"), ("-8", "-8.0"), ("1e9", "1000000000.0")]
    {
        let text = changed("steps     = [33, 65]", &format!("steps = [33, {step}]"));
        refused(&text, &[&line(&text, "steps "), "study[0].steps", shown, "whole number"]);
    }
}

#[test]
fn a_toml_of_ten_megabytes_is_refused() {
    let text = format!("{}\n# {}", small("\"rk4\""), "x".repeat(10 << 20));
    refused(&text, &["wrong.toml:1:", "bytes", "at most"]);
}

#[test]
fn nesting_a_hundred_thousand_deep_is_refused() {
    let text = format!("deep = {}{}\n", "[".repeat(100_000), "]".repeat(100_000));
    refused(&text, &["wrong.toml:1:"]);
    let text = format!("deep = {}1{}\n", "{ a = ".repeat(100_000), "}".repeat(100_000));
    refused(&text, &["wrong.toml:1:"]);
}

#[test]
fn a_broken_toml_is_refused_at_its_line() {
    let text = changed("periods   = 1", "periods   = ");
    refused(&text, &[&line(&text, "periods   =")]);
    let project = Project::new(&[]);
    std::fs::write(project.path().join("experiments/wrong.toml"), [0x74, 0xff, 0xfe]).unwrap();
    let ran = project.run(&["reproduce", "wrong"]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.err.contains("UTF-8"), "{}", ran.err);
}

#[test]
fn an_unknown_measure_in_a_text_is_refused() {
    let text = REAL.replacen("{fig02.speed-at-zero-force}", "{fig02.sped-at-zero-force}", 1);
    refused(&text, &["did you mean `fig02.speed-at-zero-force`?"]);
}

#[test]
fn one_wrong_experiment_keeps_all_from_running() {
    let wrong = changed("f_c = 0.75", "f_c = 0");
    let project = Project::new(&[("a.toml", &small("\"rk4\"")), ("b.toml", &wrong)]);
    let ran = project.run(&["reproduce"]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(project.files("reports").is_empty() && project.files("target").is_empty());
}

#[test]
fn an_experiments_name_that_is_no_name_is_a_usage_error() {
    let project = Project::new(&[("small.toml", &small("\"rk4\""))]);
    for name in ["../../x", "/etc/passwd", "", "smal", "small.toml", "small/../small", "ſmall"] {
        let before = project.files("");
        let ran = project.run(&["reproduce", name]);
        assert_eq!(ran.code, Some(2), "`{name}`: {ran:?}");
        assert_eq!(common::difference(&before, &project.files("")), None);
    }
    assert!(project.run(&["reproduce", "smal"]).err.contains("did you mean `small`?"));
    for arguments in [
        vec!["reproduce", "--threads", "0"],
        vec!["reproduce", "--watchdog", "-1"],
        vec!["reproduce", "--check", "--quick"],
        vec!["frobnicate"],
        vec!["show", "../../x"],
        vec!["new", "experiment", "../x"],
        vec!["new", "experiment", "small"],
    ] {
        assert_eq!(project.run(&arguments).code, Some(2), "{arguments:?}");
    }
}

#[test]
fn a_new_experiment_runs_as_it_stands() {
    let project = Project::new(&[]);
    assert_eq!(project.run(&["new", "experiment", "mine"]).code, Some(0));
    let ran = project.run(&["reproduce", "mine"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(project.path().join("reports/index.html").is_file());
}

/// The real experiment with one thing changed.
fn real(from: &str, to: &str) -> String {
    assert!(REAL.contains(from), "the γ sweep has no `{from}`");
    REAL.replacen(from, to, 1)
}

#[test]
fn a_slip_in_a_claim_cannot_change_its_verdict() {
    let text = real("expect = \"rate-independent\"", "expect = \"rate-indpendent\"");
    refused(&text, &[".check.expect", "did you mean `rate-independent`?"]);
    let text = real(", expect = \"static\"", "");
    refused(&text, &[".check.expect", "one of static, semilinear, generalized"]);
    for (to, words) in [
        ("{ value = 2.6, digits = 0, unit = \"J\" }", "from 1 to 17"),
        ("{ value = 0.0, digits = 2, unit = \"J\" }", "not zero"),
        ("{ value = inf, digits = 2, unit = \"J\" }", "finite"),
        ("{ value = 2.6, digits = 2, unit = \"N\" }", "the unit of fig01.gamma=1.area"),
    ] {
        let text = real("{ value = 2.6, digits = 2, unit = \"J\" }", to);
        refused(&text, &[&line(&text, "printed = "), "claim[0].printed", words]);
    }
    let text = real(
        "name = \"corollary-1\", study = \"fig01\", gamma = 1.0",
        "name = \"corollary-1\", study = \"fig01\"",
    );
    refused(&text, &["claim[1].check", "6 points of the sweep"]);
    let text = real(
        "name = \"corollary-1\", study = \"fig01\", gamma = 1.0",
        "name = \"corollary-1\", study = \"fig02-coulomb\"",
    );
    refused(&text, &["claim[1].check.study", "a study of the dahl model"]);
    refused(
        &real("figure  = \"fig01\"", "figure  = \"fig1\""),
        &["claim[0].figure", "did you mean `fig01`?"],
    );
}

#[test]
fn a_measure_that_cannot_be_taken_is_refused_before_anything_runs() {
    let from = "quantity = \"saturation_travel\", gamma = 0.25";
    refused(
        &real(from, "quantity = \"saturation_travel\", gamma = 1.0"),
        &["measure[", "].what", "never arrives"],
    );
    refused(&real("unit  = \"J\"", "unit  = \"kg\""), &["].unit", "`kg`", "`J`"]);
}

#[test]
fn controls_out_of_order_or_twice_are_refused() {
    refused(&changed("steps     = [33, 65]", "steps = [65, 33]"), &["study[0].steps", "ascending"]);
    refused(&changed("steps     = [33, 65]", "steps = [33, 33]"), &["study[0].steps", "each once"]);
    refused(
        &changed("rtol      = [1e-3, 1e-6]", "rtol = [1e-6, 1e-3]"),
        &["study[0].rtol", "descending"],
    );
    let text = changed("corners   = [\"restart\"]", "corners = [\"restart\", \"restart\"]");
    refused(&text, &["study[0].corners", "each once"]);
    let text = changed("sigma = 1.5 }", "sigma = 1.5, gamma = 1.0 }");
    refused(&text, &["study[0].sweep.gamma", "not in both"]);
}

#[test]
fn sizes_that_would_take_for_ever_are_refused() {
    refused(&changed("f_c = 0.75", "f_c = 1e-310"), &["study[0].model.f_c", "from 1e-60"]);
    let many = (0..2000).map(|i| format!("{}.0", i + 1)).collect::<Vec<_>>().join(", ");
    let sweep = format!("sweep = {{ f_c = [{many}], gamma = [{many}], sigma = [{many}] }}");
    let text = changed("sweep     = { gamma = [1.0, 2.0] }", &sweep)
        .replace("f_c = 0.75, sigma = 1.5", "");
    let text = text.replace("{ name = \"dahl\",  }", "{ name = \"dahl\" }");
    refused(&text, &["study[0].sweep", "more than 10000 points"]);
}

#[test]
fn a_wrong_type_is_told_with_its_key() {
    refused(
        &changed("periods   = 1", "periods   = \"one\""),
        &["study[0].periods", "string \"one\""],
    );
    refused(&changed("title     = \"The first\"\n", ""), &["study[0]", "nothing", "`title`"]);
    let text = changed("periods   = 1", "periods   = 1\nperiods   = 2");
    refused(&text, &["duplicate key"]);
}

#[test]
fn a_file_that_can_name_no_experiment_is_refused() {
    for name in ["a b.toml", "Ü.toml", "<b>.toml", ".toml.toml"] {
        let project = Project::new(&[(name, &small("\"rk4\""))]);
        let ran = project.run(&["reproduce"]);
        assert_eq!(ran.code, Some(4), "{name}: {ran:?}");
        assert!(project.files("reports").is_empty());
    }
}

/// A plant that can be read and has no answer is the TOML's mistake, found where it is solved for.
#[test]
fn a_plant_without_an_answer_is_told_with_its_study() {
    const PLANT: &str = r#"title = "plant"
paper = "none"
text  = "A test."

[[study]]
name      = "held"
title     = "Held"
model     = { name = "dahl", f_c = 0.75, sigma = 7.5, gamma = 1.0 }
plant     = { kind = "mass-spring", mass = 1.0, stiffness = 1.5 }
input     = { shape = "sine", amplitude = 5.0, omega = 1.0 }
span      = 5.0
reference = "dahl"
"#;
    let right = Project::new(&[("plant.toml", PLANT)]).run(&["reproduce", "plant"]);
    assert_eq!(right.code, Some(0), "{right:?}");
    for (from, to, word) in [
        ("gamma = 1.0", "gamma = 0.5", "at least 1"),
        ("mass = 1.0", "mass = 1e-50", "steps"),
        ("reference = \"dahl\"", "reference = \"lugre\"", "the study's model"),
    ] {
        let ran = Project::new(&[("plant.toml", &PLANT.replacen(from, to, 1))])
            .run(&["reproduce", "plant"]);
        assert_eq!(ran.code, Some(4), "`{to}`: {ran:?}");
        assert!(ran.err.contains("plant.toml") && ran.err.contains(word), "`{to}`: {}", ran.err);
    }
}
