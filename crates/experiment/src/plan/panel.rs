//! What a panel draws besides the exact answer of its own study.

use super::{Study, control_name, methods, study};
use crate::{
    error::{Complaint, one_of},
    spec::{FigureSpec, PanelSpec},
};
use simulation::Method;

/// Further studies, runs of solvers and the steady force are checked before anything runs.
pub(super) fn check(
    panel: &PanelSpec,
    figure: &FigureSpec,
    studies: &[Study],
) -> Result<(), Complaint> {
    let find = |name: &String| studies.iter().find(|s| s.name == *name);
    for name in &panel.also {
        let known = studies.iter().map(|s| s.name.as_str());
        find(name)
            .ok_or_else(|| Complaint::new("also", format!("`{name}`"), one_of(name, known)))?;
    }
    if panel.show == "steady-force"
        && let Some(study) = panel.study.as_ref().or(figure.study.as_ref()).and_then(find)
        && study.model.name != "lugre"
    {
        let found = format!("`{}`, whose model is {}", study.name, study.model.name);
        return Err(Complaint::new("study", found, "a study of the lugre model, for equation 21"));
    }
    for (i, run) in panel.runs.iter().enumerate() {
        let under = |c: Complaint| c.under(&format!("runs[{i}]"));
        let solvers = methods::named(std::slice::from_ref(&run.solver)).map_err(under)?;
        study::corners(std::slice::from_ref(&run.corners)).map_err(under)?;
        let [solver @ Method::Solver(_)] = solvers[..] else {
            let expected = "one solver of a right-hand side, no set";
            return Err(under(Complaint::new("solver", &run.solver, expected)));
        };
        let (range, expected) = if control_name(solver) == "step" {
            (1.0..=1e6, "steps per period, from 1 to 1e6")
        } else {
            (1e-14..=0.5, "a relative tolerance, from 1e-14 to 0.5")
        };
        if !range.contains(&run.value) {
            return Err(under(Complaint::new("value", run.value.to_string(), expected)));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::Plan;
    use std::path::Path;

    /// A LuGre and a Dahl study, and one panel with `lines` of its own.
    fn with_panel(lines: &str) -> Result<Plan, String> {
        let text = format!(
            r#"
title = "t"
paper = "p"
text = "x"
[[study]]
name = "s"
title = "t"
model = {{ name = "lugre", f_c = 1.0, f_s = 1.5, v_s = 1e-3, sigma_0 = 1e5, sigma_1 = 300.0, sigma_2 = 0.4 }}
input = {{ shape = "triangle", amplitude = 1e-4, omega = 1.0 }}
periods = 1
[[study]]
name = "d"
title = "t"
model = {{ name = "dahl", f_c = 0.75, sigma = 1.5, gamma = 1.0 }}
input = {{ shape = "polyline", t = [0.0, 1.0, 3.0], u = [0.0, 1.0, 0.0] }}
periods = 1
[[figure]]
name = "f"
kind = "loop"
title = "t"
description = "d"
caption = "c"
[[figure.panel]]
title = ""
x = "x"
y = "y"
x_range = [-1.0, 1.0]
y_range = [-1.0, 1.0]
{lines}
"#
        );
        Plan::from_text("t", Path::new("t.toml"), &text, &["loop"]).map_err(|e| e.to_string())
    }

    #[test]
    fn a_panel_that_cannot_be_drawn_is_refused_where_it_is_written() {
        let run = |solver: &str, value: &str| {
            format!(
                "study = \"s\"\nshow = \"force-displacement\"\nfrom = \"from-start\"\n\
                 runs = [{{ solver = \"{solver}\", value = {value}, corners = \"restart\" }}]"
            )
        };
        let steady = |study: &str| format!("study = \"{study}\"\nshow = \"steady-force\"");
        assert!(with_panel(&run("bdf", "1e-9")).is_ok() && with_panel(&run("rk4", "33")).is_ok());
        assert!(with_panel(&steady("s")).is_ok());
        for (lines, words) in [
            (run("@implicit", "1e-9"), "one solver"),
            (run("bfd", "1e-9"), "bdf"),
            (run("bdf", "33"), "relative tolerance"),
            (run("rk4", "1e-9"), "steps per period"),
            (run("rk4", "nan"), "steps per period"),
            (steady("d"), "lugre"),
            (format!("{}\nalso = [\"e\"]", steady("s")), "also"),
        ] {
            let error = with_panel(&lines).err().unwrap_or_default();
            assert!(
                error.contains("figure[0].panel[0]") && error.contains(words),
                "{lines}: {error}"
            );
        }
    }
}
