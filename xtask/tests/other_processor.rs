//! `--check` holds on another processor: the C library is made to choose its code without FMA and AVX2.
//!
//! Where the C library is not glibc the variable means nothing, and the test shows only that a fresh run
//! on the same processor passes.

mod common;

use common::{Project, REAL};

#[test]
fn the_tables_of_one_processor_pass_the_check_on_another() {
    let project = Project::new(&[("dahl-gamma-sweep.toml", REAL)]);
    let ran = project.run(&["reproduce"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let output = project
        .command(&["reproduce", "--check", "--fresh"])
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F")
        .output()
        .expect("the built program");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
