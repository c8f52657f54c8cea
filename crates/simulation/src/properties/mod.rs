//! What holds for every plant with friction, tried on plants drawn at random.
//!
//! A property computes by how much one case, drawn from one seed, violates it; zero but for the errors of
//! the solution. [`PROPERTIES`] is the list, [`Property::check`] tries one on many seeds.

mod draw;

use crate::{
    DrivenPlant, Energy, Path,
    energy::{Contact, account},
    exact::{ExactSolution, SlipPlant},
    plant_reference::solve_located,
};
pub(crate) use draw::Draw;
use draw::{Case, Kind, case};
use duhem::{FrictionModel, LuGre};
use integrate::Outcome;

/// One property of the list.
#[derive(Debug, Clone, Copy)]
pub struct Property {
    /// Its name.
    pub name: &'static str,
    /// What it says.
    pub says: &'static str,
    /// What a violation may be, relative to the case's own scale: the errors of the solution.
    pub tolerance: f64,
    /// The violation by the case of this seed; none if the case could not be solved.
    pub violation: fn(u64) -> Option<f64>,
}

/// What came of many cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// The property.
    pub property: &'static str,
    /// How many cases were tried.
    pub cases: usize,
    /// How many could not be solved.
    pub unsolved: usize,
    /// How many violate the property beyond its tolerance.
    pub violations: usize,
    /// The worst violation, relative to the case's scale.
    pub worst: f64,
    /// The seed of the worst case, which alone draws it again.
    pub seed: u64,
}

impl Report {
    /// Whether every case was solved and none violates the property.
    pub fn holds(&self) -> bool {
        self.unsolved == 0 && self.violations == 0
    }
}

/// The properties. Heat is for good: what comes back of it counts as a violation.
pub const PROPERTIES: &[Property] = &[
    Property {
        name: "energy-dahl",
        says: "with Dahl friction, which stores F²/2σ, the drive's work is stored or becomes heat",
        tolerance: 1e-7,
        violation: |seed| energy(seed, Kind::Dahl),
    },
    Property {
        name: "energy-maxwell-slip",
        says: "with Maxwell-slip the drive's work is stored or becomes heat",
        tolerance: 1e-7,
        violation: |seed| energy(seed, Kind::MaxwellSlip),
    },
    Property {
        name: "energy-lugre",
        says: "with LuGre and σ₂ ≥ σ₁(F_S − F_C)/F_C the drive's work is stored or becomes heat",
        tolerance: 1e-9,
        violation: |seed| energy(seed, Kind::LuGre),
    },
    Property {
        name: "energy-exact",
        says: "the exact solution with Maxwell-slip keeps the energy account to rounding",
        tolerance: 1e-13,
        violation: |seed| {
            let (case, plant) = slip_case(seed)?;
            Some(open(&plant.solve(&case.y0, case.span).ok()?.energy()))
        },
    },
    Property {
        name: "two-ways",
        says: "with Maxwell-slip the exact way and the second way give the same displacement",
        tolerance: 1e-6,
        violation: two_ways,
    },
    Property {
        name: "non-expansive",
        says: "with Maxwell-slip two solutions under one drive never move apart in energy",
        tolerance: 1e-10,
        violation: |seed| {
            let (case, plant) = slip_case(seed)?;
            let other = case.redraw(&mut Draw(!seed));
            let one = plant.solve(&case.y0, case.span).ok()?;
            Some(moved_apart(&one, &plant.solve(&other, case.span).ok()?))
        },
    },
];

impl Property {
    /// Tries the cases of the seeds `first`, `first` + 1, ….
    pub fn check(&self, first: u64, cases: usize) -> Report {
        let (property, seed) = (self.name, first);
        let mut report = Report { property, cases, unsolved: 0, violations: 0, worst: 0.0, seed };
        for (seed, _) in (first..).zip(0..cases) {
            let Some(violation) = (self.violation)(seed) else {
                report.unsolved += 1;
                continue;
            };
            // Not a number is the worst there is.
            let within = violation <= self.tolerance;
            report.violations += usize::from(!within);
            if violation > report.worst || violation.is_nan() {
                (report.worst, report.seed) = (violation, seed);
            }
        }
        report
    }
}

/// What an energy account leaves open, relative to its scale.
pub fn open(energy: &Energy) -> f64 {
    energy.residue().abs() / energy.scale
}

/// What the account leaves open, or the heat that comes back on the worst interval if that is more.
fn energy(seed: u64, kind: Kind) -> Option<f64> {
    let case = case(&mut Draw(seed), kind).ok()?;
    let (energy, least) = account(&path(&case)?, &case.contact, &case.plant, &case.input);
    Some(open(&energy).max(-least / energy.scale))
}

/// The case solved: the rate-independent models by displacement, LuGre by our stiff method.
fn path(case: &Case) -> Option<Path> {
    if let Contact::LuGre(model) = &case.contact {
        return lugre_path(case, model);
    }
    case.by_displacement()?.resolve(&case.y0, case.span).ok()
}

fn lugre_path(case: &Case, model: &LuGre) -> Option<Path> {
    let model: Box<dyn FrictionModel> = Box::new(model.clone());
    let plant = DrivenPlant::new(model, case.plant, case.input.clone(), case.span);
    let solved = solve_located(&plant, &case.y0, 1e-11);
    (solved.outcome == Outcome::Solved).then_some(solved.path)
}

fn slip_case(seed: u64) -> Option<(Case, SlipPlant)> {
    let case = case(&mut Draw(seed), Kind::MaxwellSlip).ok()?;
    let Contact::MaxwellSlip(model) = &case.contact else { return None };
    let plant = SlipPlant::new(model.clone(), &case.plant, &case.input).ok()?;
    Some((case, plant))
}

fn two_ways(seed: u64) -> Option<f64> {
    let (case, plant) = slip_case(seed)?;
    let (exact, second) = (plant.solve(&case.y0, case.span).ok()?, path(&case)?);
    let mut y = vec![0.0; case.y0.len()];
    let (mut apart, mut size) = (0.0_f64, 0.0_f64);
    for t in second.t() {
        exact.state(*t, &mut y);
        apart = apart.max((y[0] - second.q(*t)).abs());
        size = size.max(y[0].abs());
    }
    Some(apart / size)
}

/// The largest growth of ½mΔv² + ½k_sΔq² + ½Σ kᵢΔzᵢ² from one of some hundred times to the next, relative
/// to its value at the start.
pub fn moved_apart(one: &ExactSolution, other: &ExactSolution) -> f64 {
    let plant = one.plant();
    let (start, end) = one.span();
    let (mut a, mut b) = (vec![0.0; plant.model.k.len() + 2], vec![0.0; plant.model.k.len() + 2]);
    let mut times: Vec<f64> =
        (0..=400).map(|i| start + (end - start) * f64::from(i) / 400.0).collect();
    times.extend(one.events().iter().chain(other.events()).map(|event| event.t));
    times.sort_by(f64::total_cmp);
    let mut distance = |t: f64| {
        one.state(t, &mut a);
        other.state(t, &mut b);
        let difference: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
        plant.stored(&difference)
    };
    let first = distance(start);
    let (mut worst, mut last) = (0.0_f64, first);
    for t in times {
        let now = distance(t);
        worst = worst.max(now - last);
        last = now;
    }
    worst / first
}
