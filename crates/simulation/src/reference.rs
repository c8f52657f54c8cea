//! A plant solved in two independent ways: what solvers are judged by where no closed form is.

use crate::{DrivenPlant, Motion, Path};
use duhem::{
    FrictionModel, Input, MODELS, Parameters, Plant,
    closed_form::{Reference, ReferenceError},
};
use integrate::{Control, Corners, Dynamics, Limits};

/// A plant solved in two independent ways; the first is the answer, their difference its error.
#[derive(Debug, Clone)]
pub struct PlantReference {
    /// The answer.
    pub first: Path,
    /// The same in another way.
    pub second: Path,
    /// The largest |q₁ − q₂| over the nodes of both [m].
    bound: f64,
}

impl PlantReference {
    /// The answer and its second parent.
    pub fn of(first: Path, second: Path) -> Self {
        let apart = |t: &f64| (first.q(*t) - second.q(*t)).abs();
        let bound = first.t().iter().chain(second.t()).map(apart).fold(0.0, f64::max);
        Self { first, second, bound }
    }
}

impl Reference for PlantReference {
    fn state(&self, t: f64, x: &mut [f64]) {
        self.first.state(t, x);
    }

    fn error_bound(&self) -> f64 {
        self.bound
    }

    fn kinks(&self) -> Vec<f64> {
        self.first.reversals()
    }
}

/// One reference of the list.
#[derive(Debug, Clone, Copy)]
pub struct PlantReferenceEntry {
    /// Its name in the experiments: the model's.
    pub name: &'static str,
    /// The two ways.
    pub ways: [&'static str; 2],
    /// The answer for these parameters of the model, this plant and this input from the state y₀ over the
    /// span [s].
    pub build: fn(
        &Parameters,
        &Plant,
        &Input,
        &[f64],
        (f64, f64),
    ) -> Result<PlantReference, ReferenceError>,
}

/// The references of plants.
pub const PLANT_REFERENCES: &[PlantReferenceEntry] = &[
    PlantReferenceEntry {
        name: "dahl",
        ways: ["bdf", "tsit45"],
        build: |p, plant, input, y0, span| build("dahl", p, (plant, input), (y0, span)),
    },
    PlantReferenceEntry {
        name: "lugre",
        ways: ["bdf", "tsit45"],
        build: |p, plant, input, y0, span| build("lugre", p, (plant, input), (y0, span)),
    },
    PlantReferenceEntry {
        name: "maxwell-slip",
        ways: ["bdf", "tsit45"],
        build: |p, plant, input, y0, span| build("maxwell-slip", p, (plant, input), (y0, span)),
    },
];

fn build(
    name: &str,
    parameters: &Parameters,
    (plant, input): (&Plant, &Input),
    (y0, span): (&[f64], (f64, f64)),
) -> Result<PlantReference, ReferenceError> {
    let model = || -> Result<Box<dyn FrictionModel>, ReferenceError> {
        let entry = MODELS.iter().find(|m| m.name == name);
        let nameless = ReferenceError::NoPeriod;
        Ok((entry.ok_or(nameless)?.build)(parameters)?)
    };
    let motion = DrivenPlant::new(model()?, *plant, input.clone(), span);
    Ok(PlantReference::of(solve(&motion, "bdf", (y0, 1e-8)), solve(&motion, "bdf", (y0, 1e-9))))
}

/// The accepted steps of a library's method.
fn solve(motion: &DrivenPlant, solver: &str, (y0, rtol): (&[f64], f64)) -> Path {
    let (mut path, mut dy) = (Path::new(y0.len()), vec![0.0; y0.len()]);
    let Some(solver) = integrate::solver(solver) else { return path };
    let limits = Limits { evaluations: 50_000_000 };
    let control = Control::Tolerance { rtol };
    let problem = motion.problem(y0.to_vec());
    let run = integrate::solve(solver, &problem, &control, Corners::Restart, &limits);
    for (i, t) in run.trajectory.t.iter().enumerate() {
        let y = run.trajectory.state(i);
        motion.derivative(*t, y, None, &mut dy);
        path.push(*t, y, &dy);
    }
    path
}
