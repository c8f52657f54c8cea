//! A saved run of the benchmark, made by hand.

use serde_json::{Value, json};

/// Repeats of about this time [s].
pub(crate) fn repeats(time: f64) -> Vec<f64> {
    (0..15).map(|i| time * (1.0 + 0.002 * f64::from(i % 5))).collect()
}

/// A row of P6 by this solver with this work and this time [s].
pub(crate) fn row(solver: &str, evaluations: u64, time: f64) -> Value {
    json!({
        "problem": "P6", "parameter": null, "solver": solver, "ours": solver.starts_with("our"),
        "control": {"rtol": 1e-6}, "restart": false, "error": 2e-6, "cpu_s": time,
        "evaluations": evaluations, "status": "solved", "jacobians": 7, "accepted": 100,
        "rejected": 3, "repeats_s": repeats(time),
    })
}

/// A run of these rows.
pub(crate) fn run(rows: &[Value]) -> Value {
    json!({
        "kind": "duhem benchmark", "format": 1,
        "machine": {
            "processor": "Some CPU (model 2)", "native": true, "target_features": ["avx2"],
            "rustc": "rustc 1.95.0",
        },
        "libraries": {"diffsol": "0.18.0"}, "patch": null, "quick": false,
        "references": [{
            "problem": "P6", "parameter": null, "way": "two ways", "error": 1e-11, "table": false,
            "apart": null,
        }],
        "rows": rows,
        "claims": [{"id": "dahl.energy", "verdict": "contradicted", "ours": 1.554, "error": 1e-9, "unit": "J"}],
        "measures": [{"id": "fig01.area", "value": 1.554, "error": 1e-9, "unit": "J"}],
    })
}
