//! The controlled axis.

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{clean, made, sensors};
use twin::Made;

fn controlled(hidden: &str, quantum: &str) -> Made {
    made(&format!(
        "title = 't'\nduration = 6.0\nrate = 200.0\n[plant]\nkind = 'axis'\ninertia = 16.0\ngain = 35.0\n[friction]\n\
         name = 'coulomb'\nf_c = 20.0\nsigma_2 = 150.0\n[[input.part]]\nshape = 'sine'\namplitude = 0.1\nomega = 2.0\n\
         [controller]\nkind = 'pd'\nkp = 10.0\nkv = 20.0\nlimit = 10.0\n[[added_input.part]]\nshape = 'steps'\n\
         times = [1.0, 1.5]\nvalues = [2.0, 0.0]\n{}{quantum}{hidden}",
        sensors(&["reference", "added_input", "voltage", "velocity", "position"])
    ))
}

#[test]
fn the_command_can_be_computed_from_the_columns_without_any_delay() {
    let made = controlled("", "noise = 1e-6\nquantum = 1e-5\n");
    let column = |name: &str| &made.columns.iter().find(|(known, _)| known == name).unwrap().1;
    let (q, r) = (column("position"), column("reference"));
    for k in 2..q.len() {
        let speed = (q[k] - q[k - 2]) / 2.0 * 200.0;
        let u = (20.0 * (10.0 * (r[k] - q[k]) - speed)).clamp(-10.0, 10.0);
        let told = column("voltage")[k] - column("added_input")[k];
        assert!((u - told).abs() < 1e-9, "sample {k}: {told} V, not {u} V");
    }
    let tracking = q.iter().zip(r).skip(200).map(|(q, r)| (q - r).abs()).fold(0.0, f64::max);
    assert!((1e-3..0.05).contains(&tracking), "it follows to {tracking} m");
}

#[test]
fn the_axis_obeys_its_own_voltage() {
    // M v̇ = g V − F: momentum against the voltage's, over a stretch of motion one way.
    let made = controlled("", "");
    let (v, u) = (clean(&made, "velocity"), clean(&made, "voltage"));
    let q = clean(&made, "position");
    let from = (400..v.len()).find(|k| v[*k] > 0.05).unwrap_or(0);
    let to = from + 60;
    assert!(v[from..=to].iter().all(|v| *v > 0.0), "it turns in between");
    let pushed: f64 = u[from..to].iter().map(|u| 35.0 * u * 0.005).sum();
    let rubbed = 20.0 * 60.0 * 0.005 + 150.0 * (q[to] - q[from]);
    let gained = 16.0 * (v[to] - v[from]);
    assert!((gained - pushed + rubbed).abs() < 1e-6, "{gained} N·s, not {}", pushed - rubbed);
}

#[test]
fn a_bias_behind_a_controller_is_a_constant_added_to_the_added_input() {
    let bias = controlled("\n[[hidden]]\nname = 'current_bias'\nbias = 0.3\n", "");
    let plain = controlled("", "");
    let moved = common::apart(&bias, &plain, "position");
    assert!(moved > 1e-4, "moved by {moved} m only");
    let late = controlled("\n[[hidden]]\nname = 'input_delay'\ndelay = 0.005\n", "");
    let moved = common::apart(&late, &plain, "position");
    assert!(moved > 1e-6, "a delay of a sample moved it by {moved} m only");
}
