//! The names of methods and of sets of them, and where a method of our own holds.

use super::Study;
use crate::error::{Complaint, one_of};
use integrate::SETS;
use simulation::{Method, adaptive::ADAPTIVE, exact::EXACT, methods};

/// The sets of our own methods that are given the task; the others are those of [`integrate::set`].
const OURS: [(&str, fn() -> Vec<Method>); 2] = [
    ("@exact", || EXACT.iter().map(Method::Exact).collect()),
    ("@ours", || ADAPTIVE.iter().map(Method::Adaptive).collect()),
];

/// What a method's work is controlled by: `step`, `rtol`, or `none` for an exact one.
pub fn control_name(method: Method) -> &'static str {
    match method {
        Method::Solver(solver) => match solver.order {
            integrate::Order::Fixed(_) => "step",
            integrate::Order::Adaptive(_) | integrate::Order::Variable => "rtol",
        },
        Method::Adaptive(_) => "rtol",
        Method::Exact(_) => "none",
    }
}

/// The methods of these names and sets, each once, in the order of the names and within a set of the list.
pub(crate) fn named(names: &[String]) -> Result<Vec<Method>, Complaint> {
    let mut found: Vec<Method> = Vec::new();
    for name in names {
        for method in members(name)? {
            if !found.iter().any(|m| m.name() == method.name()) {
                found.push(method);
            }
        }
    }
    Ok(found)
}

/// The members of a set, or the one method of this name.
fn members(name: &str) -> Result<Vec<Method>, Complaint> {
    let solvers = |all: Vec<&'static _>| all.into_iter().map(Method::Solver).collect();
    let ours = OURS.iter().find(|(set, _)| *set == name).map(|(_, members)| members());
    let one = integrate::solver(name).map(Method::Solver).or_else(|| simulation::method(name));
    let found = if name.starts_with('@') {
        ours.or_else(|| integrate::set(name).map(solvers))
    } else {
        one.map(|method| vec![method])
    };
    let sets = SETS.iter().copied().chain(OURS.iter().map(|(set, _)| *set));
    let known = || methods().map(|method| method.name()).chain(sets);
    found.ok_or_else(|| Complaint::new("solvers", format!("`{name}`"), one_of(name, known())))
}

impl Study {
    /// Whether a method takes this point, or why not; a solver of a right-hand side takes any.
    pub(crate) fn holds(&self, point: usize, method: Method) -> Result<(), String> {
        match method {
            Method::Solver(_) => Ok(()),
            Method::Exact(own) | Method::Adaptive(own) => {
                (own.build)(&self.task(point)?).map(|_| ()).map_err(|e| e.to_string())
            }
        }
    }

    /// The methods of these names and sets that take this study: one that is named has to take every point,
    /// of a set those are kept that take one.
    pub(super) fn taken(&self, names: &[String]) -> Result<Vec<Method>, Complaint> {
        let points = || 0..self.points.len();
        for name in names.iter().filter(|name| !name.starts_with('@')) {
            let single = named(std::slice::from_ref(name))?;
            let refused = |method: &Method| points().find_map(|p| self.holds(p, *method).err());
            if let Some(why) = single.iter().find_map(refused) {
                let expected = "a method that takes every point of this study";
                return Err(Complaint::new("solvers", why, expected));
            }
        }
        let mut methods = named(names)?;
        methods.retain(|method| points().any(|point| self.holds(point, *method).is_ok()));
        if methods.is_empty() && !names.is_empty() {
            let expected = "a method that takes a point of this study";
            return Err(Complaint::new("solvers", format!("{names:?}"), expected));
        }
        Ok(methods)
    }
}

#[cfg(test)]
mod tests {
    use crate::Plan;
    use std::path::Path;

    const BASE: &str = r#"
title = "t"
paper = "p"
text = "x"
[[study]]
name = "s"
title = "t"
model = { name = "dahl", f_c = 0.75, sigma = 1.5 }
input = { shape = "sine", amplitude = 1.0, omega = 0.1 }
sweep = { gamma = [0.5, 1.0] }
periods = 1
solvers = ["dopri5"]
rtol = [1e-3, 1e-5]
corners = ["restart", "ignore"]
reference = "dahl"
"#;

    fn with(solvers: &str) -> Result<Plan, String> {
        let text = BASE.replacen("\"dopri5\"", solvers, 1);
        Plan::from_text("t", Path::new("t.toml"), &text, &[]).map_err(|e| e.to_string())
    }

    fn cases(plan: &Plan) -> Vec<(&'static str, usize, f64)> {
        plan.cases.iter().map(|case| (case.solver.name(), case.point, case.value)).collect()
    }

    #[test]
    fn a_set_gives_each_point_the_exact_methods_that_hold_there_once() {
        let plan = with("\"@exact\", \"exact-dahl\"").unwrap();
        let expected =
            [("exact-dahl", 0, 0.0), ("exact-dahl", 1, 0.0), ("exact-semilinear", 1, 0.0)];
        assert_eq!(cases(&plan), expected);
    }

    #[test]
    fn an_adaptive_method_of_ours_has_a_case_for_each_tolerance_and_finds_the_corners() {
        let text = BASE
            .replace("gamma = [0.5, 1.0]", "gamma = [1.0]")
            .replace(
                "input = ",
                "plant = { kind = \"mass-spring\", mass = 1.0, stiffness = 1.5 }\ninput = ",
            )
            .replace("\"dopri5\"", "\"dopri5\", \"@ours\"")
            .replace("[\"restart\", \"ignore\"]", "[\"ignore\"]");
        let plan = Plan::from_text("t", Path::new("t.toml"), &text, &[]).unwrap();
        let ours = plan.cases.iter().filter(|case| case.solver.name() == "dahl-series");
        let ours: Vec<_> = ours.map(|case| (case.value, case.corners)).collect();
        let restart = integrate::Corners::Restart;
        assert_eq!(ours, [(1e-3, restart), (1e-5, restart)]);
    }

    #[test]
    fn a_method_that_is_named_and_does_not_hold_is_refused_in_words() {
        for (solvers, words) in [
            ("\"exact-semilinear\"", "exact-semilinear does not hold here: dahl with γ = 0.5"),
            ("\"exact-lugre\"", "the model dahl"),
            ("\"radau-located\"", "an imposed motion"),
            ("\"@ours\"", "a method that takes a point of this study"),
            ("\"exact-dal\"", "did you mean `exact-dahl`?"),
            ("\"@exakt\"", "did you mean `@exact`?"),
        ] {
            let message = with(solvers).map(|_| ()).expect_err(solvers);
            assert!(message.contains("study[0].solvers: "), "{solvers}: {message}");
            assert!(message.contains(words), "{solvers}: {message}");
        }
    }
}
