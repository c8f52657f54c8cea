//! What stands in the header.

use super::{friction, rig, run};
use duhem::Parameters;
use identify::{Effect, export::c_header};

#[test]
fn a_title_cannot_leave_its_comment() {
    let mut rig = rig("prescribed", &[], friction("none", Parameters::default(), 0.5));
    for title in ["*/ int x; /*", "/*/", "a\nb\r\0", "*\u{202e}/ \\", "??/", "Prüfstand ÷ 2"] {
        title.clone_into(&mut rig.title);
        let rows = run(&rig, include_str!("friction.c"), &[(2.0, 0.1)]);
        assert_eq!(rows, [[1.0]], "{title}");
    }
}

#[test]
fn numbers_come_back_bit_for_bit() {
    for value in [0.1 + 0.2, 1e-60, 1.234_567_890_123_456_7e60, 35.150_651_882_485_47] {
        let none = friction("none", Parameters::default(), 0.0);
        let rows = run(
            &rig("prescribed", &[("offset", value)], none),
            include_str!("friction.c"),
            &[(0.0, 0.1)],
        );
        assert_eq!(rows[0][0].to_bits(), value.to_bits(), "{value:e} N");
    }
}

#[test]
fn what_c_cannot_hold_is_refused_in_words() {
    let none = || friction("none", Parameters::default(), 0.0);
    let said = |rig| c_header(&rig).expect_err("it is refused").to_string();
    let mut biased = rig("prescribed", &[], none());
    biased.effects = vec![Effect { name: "current_bias".to_owned(), values: [].into() }];
    assert!(said(biased).starts_with("effect current_bias has no model in C"));
    assert_eq!(
        said(rig("pendulum", &[("inertia", 1.0)], none())),
        "mass is missing in pendulum: expected a value"
    );
    assert_eq!(
        said(rig("wheel", &[], none())),
        "plant wheel has no model in C: expected one of drum, mass-spring, axis, pendulum, prescribed"
    );
    assert_eq!(
        said(rig("axis", &[("inertia", f64::NAN)], none())),
        "inertia is not finite: expected a number"
    );
    let negative = friction("coulomb", [("f_c", -1.0)].into_iter().collect(), 0.0);
    assert!(said(rig("prescribed", &[], negative)).starts_with("f_c = -1: expected"));
    let unknown = friction("stribeck", Parameters::default(), 0.0);
    assert_eq!(
        said(rig("prescribed", &[], unknown)),
        "friction stribeck has no model in C: expected one of coulomb, dahl, lugre, maxwell-slip, none"
    );
}
