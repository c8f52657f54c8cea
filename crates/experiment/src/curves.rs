//! The curves of figures: the exact answer's loops, and the steps that solvers took.

use crate::{
    discoveries, fits,
    plan::{Plan, Point, Study, control_name, solver_names},
    quantities::View,
    run::Finished,
    solved::solved,
    spec::{FigureSpec, PanelSpec, RunSpec},
};
use duhem::{
    Dahl, FrictionModel, LuGre,
    closed_form::dahl::settling::{Contact, HeldMass},
};
use integrate::Corners;
use record::{CurveRow, PanelRow};
use simulation::Method;

/// Points drawn on each arc between two corners.
const PER_ARC: u32 = 100;
/// Stretches of time that a plant's curve is cut into.
const STRETCHES: u32 = 600;
/// The largest number of swings that is drawn, as a power of two.
const SWINGS: u32 = 16;
/// Parts into which a stretch is cut over which the value changes visibly: a slip lasts seconds of hours.
const PARTS: u32 = 12;
/// The share of an axis below which nobody sees a difference.
const SEEN: f64 = 2e-3;
/// Periods after which a loop is the limit cycle to more digits than a figure shows.
const SETTLED: f64 = 40.0;

/// The panels and curves of all figures that have panels.
pub(crate) fn curves(
    plan: &Plan,
    finished: &[Finished],
) -> Result<(Vec<PanelRow>, Vec<CurveRow>), String> {
    let (mut panels, mut curves) = (Vec::new(), Vec::new());
    for figure in &plan.figures {
        for panel in &figure.panel {
            panels.push(axes(figure, panel));
            let named = |name: &String| Some(name) == figure.study.as_ref();
            let fit = plan.fits.iter().find(|f| named(&f.name));
            let search = plan.discoveries.iter().find(|d| named(&d.name));
            let drawn = match (panel.show.as_str(), fit, search) {
                (_, Some(fit), _) => fits::series(&fits::Runs::of_fit(fit)?, panel)?,
                (_, None, Some(search)) => discoveries::series(search, panel)?,
                (show, None, None) => of_study(plan, (figure, panel), show, finished)?,
            };
            for (series, points) in drawn {
                let row = |(x, y)| CurveRow {
                    figure: figure.name.clone(),
                    panel: panel.title.clone(),
                    series: series.clone(),
                    x,
                    y,
                };
                curves.extend(points.into_iter().map(row));
            }
        }
    }
    Ok((panels, curves))
}

fn of_study(
    plan: &Plan,
    (figure, panel): (&FigureSpec, &PanelSpec),
    show: &str,
    finished: &[Finished],
) -> Result<Series, String> {
    match show {
        "step-time" => steps(plan, figure, panel, finished),
        "rest-swings" => settling(plan, figure, panel),
        _ if of_plant(plan, figure, panel)? => plants(plan, figure, panel),
        "steady-force" => steady(plan, figure, panel),
        _ => forces(plan, figure, panel),
    }
}

/// Curves by their labels.
pub(crate) type Series = Vec<(String, Vec<(f64, f64)>)>;

fn axes(figure: &FigureSpec, panel: &PanelSpec) -> PanelRow {
    PanelRow {
        figure: figure.name.clone(),
        panel: panel.title.clone(),
        x: panel.x.clone(),
        y: panel.y.clone(),
        x_min: panel.x_range[0],
        x_max: panel.x_range[1],
        y_min: panel.y_range[0],
        y_max: panel.y_range[1],
        x_log: panel.x_log,
        y_log: panel.y_log,
    }
}

fn shown<'a>(
    plan: &'a Plan,
    figure: &FigureSpec,
    panel: &PanelSpec,
) -> Result<(usize, &'a Study, Vec<&'a Point>), String> {
    let name = panel.study.as_ref().or(figure.study.as_ref()).ok_or("a panel without a study")?;
    let index = plan.studies.iter().position(|s| s.name == *name).ok_or("an unknown study")?;
    let study = &plan.studies[index];
    let select =
        if figure.study.as_ref() == Some(name) { figure.select.clone() } else { <_>::default() };
    let points = study.selected(&select).map_err(|c| c.found)?;
    Ok((index, study, points))
}

/// The friction at the rest that a swinging mass is nearest to, |F|/F_C over the number of swings, from
/// turning points of several forces at F_e = 0.
fn settling(plan: &Plan, figure: &FigureSpec, panel: &PanelSpec) -> Result<Series, String> {
    let (_, _, points) = shown(plan, figure, panel)?;
    let point = points.first().ok_or("no point of the sweep")?;
    let dahl = Dahl::new(&point.parameters).map_err(|e| e.to_string())?;
    let stiffness = point.plant.ok_or("an imposed motion where a plant is needed")?.stiffness;
    let held = HeldMass { dahl, stiffness, drive: 0.0 };
    let from = |share: f64| {
        let start = Contact { q: 2.0 * held.dahl.f_c / stiffness, force: share * held.dahl.f_c };
        let at = |n: u32| {
            let rest = held.settle(start, 1 << n).rest.force;
            (f64::from(1_u32 << n), rest.abs() / held.dahl.f_c)
        };
        (0..=SWINGS).map(at).collect()
    };
    let starts = [("from F = −F_C", -1.0), ("from F = 0", 0.0), ("from F = 0.9 F_C", 0.9)];
    Ok(starts.map(|(name, share)| (name.to_owned(), from(share))).into())
}

fn of_plant(plan: &Plan, figure: &FigureSpec, panel: &PanelSpec) -> Result<bool, String> {
    Ok(shown(plan, figure, panel)?.1.plant.is_some())
}

/// What a plant does, at times that do not depend on the steps of the answer: of each stretch of time its
/// start, and for a history the smallest and the largest value, so that no slip is left out.
fn plants(plan: &Plan, figure: &FigureSpec, panel: &PanelSpec) -> Result<Series, String> {
    let (_, study, points) = shown(plan, figure, panel)?;
    let mut series = Series::new();
    for point in points {
        let index = study.points.iter().position(|p| p.label == point.label).ok_or("no point")?;
        let (solved, motion) = (study.exact(index)?.solved()?, study.driven(index)?);
        let view = View::new(&solved.first, &motion, None);
        let [from, to] = panel.between.unwrap_or([0.0, study.span]);
        let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(STRETCHES);
        let y = |t: f64| match panel.show.split_once('-').map(|(y, _)| y) {
            Some("force") => view.force(t),
            Some("velocity") => view.v(t),
            Some("drive") => view.drive(t),
            _ => view.q(t),
        };
        let x = |t: f64| match panel.show.split_once('-').map(|(_, x)| x) {
            Some("displacement") => view.q(t),
            Some("velocity") => view.v(t),
            Some("drive") => view.drive(t),
            _ => t,
        };
        let visible = SEEN * (panel.y_range[1] - panel.y_range[0]).abs();
        let mut drawn = Vec::new();
        for i in 0..STRETCHES {
            let (from, to) = (at(i), at(i + 1));
            let parts = if (y(to) - y(from)).abs() > 10.0 * visible { PARTS } else { 1 };
            let part = |k: u32| from + (to - from) * f64::from(k) / f64::from(parts);
            for k in 0..parts {
                let (t, next) = (part(k), part(k + 1));
                drawn.push((x(t), y(t)));
                let ends = view.ends((t, next), &y);
                let beyond = |end: &f64| (end - y(t)).abs().min((end - y(next)).abs()) > visible;
                if panel.show.ends_with("-time") && ends.iter().any(beyond) {
                    drawn.extend(ends.map(|y| (0.5 * (t + next), y)));
                }
            }
        }
        drawn.push((x(to), y(to)));
        series.push((pretty(&point.label, study), drawn));
    }
    Ok(series)
}

fn forces(plan: &Plan, figure: &FigureSpec, panel: &PanelSpec) -> Result<Series, String> {
    let (_, study, points) = shown(plan, figure, panel)?;
    let mut all: Vec<(&Study, &Point)> = points.into_iter().map(|point| (study, point)).collect();
    for name in &panel.also {
        let more = plan.studies.iter().find(|s| s.name == *name).ok_or("an unknown study")?;
        all.extend(more.points.iter().map(|point| (more, point)));
    }
    let mut series = Series::new();
    let xy = |(u, u_dot, f)| if panel.show == "force-velocity" { (u_dot, f) } else { (u, f) };
    for (study, point) in all {
        let drawn_alone = study.reference.is_none() && !panel.runs.is_empty();
        if !drawn_alone {
            let span = if panel.from == "settled" {
                let periods = SETTLED.max((study.span / study.period).ceil());
                (periods * study.period, (periods + 1.0) * study.period)
            } else {
                (0.0, study.span)
            };
            let mut path = path(study, point, span)?;
            // A settled loop is closed, also where the force jumps with the speed.
            if panel.from == "settled" {
                path.extend(path.first().copied());
            }
            series.push((pretty(&point.label, study), path.into_iter().map(xy).collect()));
        }
        for run in &panel.runs {
            series.push(of_solver(study, point, run, xy)?);
        }
    }
    Ok(series)
}

/// A solver's own path, at its accepted steps.
fn of_solver(
    study: &Study,
    point: &Point,
    run: &RunSpec,
    xy: impl Fn((f64, f64, f64)) -> (f64, f64),
) -> Result<(String, Vec<(f64, f64)>), String> {
    let solver = integrate::solver(&run.solver).ok_or("an unknown solver")?;
    let corners = if run.corners == "restart" { Corners::Restart } else { Corners::Ignore };
    let found = solved(study, point, (solver, run.value), corners)?;
    let mut label = if control_name(Method::Solver(solver)) == "step" {
        format!("{}, {} steps", run.solver, run.value)
    } else {
        format!("{}, {:e}", run.solver, run.value)
    };
    if let integrate::Outcome::Failed { why, .. } = &found.run.outcome {
        label = format!("{label}: {}", why.name());
    }
    Ok((label, found.path.into_iter().map(xy).collect()))
}

/// The steady force, equation 21, over the panel's speeds, both sides of its jump at zero.
fn steady(plan: &Plan, figure: &FigureSpec, panel: &PanelSpec) -> Result<Series, String> {
    let (_, study, points) = shown(plan, figure, panel)?;
    let curve = |point: &&Point| {
        let lugre = LuGre::new(&point.parameters).map_err(|e| e.to_string())?;
        let grid = |end: f64| {
            // Denser towards zero, where the force falls within a few v_S.
            let at = move |i: u32| end * (f64::from(i) / f64::from(2 * PER_ARC)).powi(3);
            (0..=2 * PER_ARC).map(at)
        };
        let nearest = |v: f64, end: f64| if v == 0.0 { f64::MIN_POSITIVE.copysign(end) } else { v };
        let [left, right] = panel.x_range;
        let down = grid(left).map(|v| nearest(v, left)).collect::<Vec<_>>().into_iter().rev();
        let speeds = down.chain(grid(right).map(|v| nearest(v, right)));
        let points = speeds.map(|v| (v, lugre.steady_force(v))).collect();
        Ok((pretty(&point.label, study), points))
    };
    points.iter().map(curve).collect()
}

/// The exact answer's u, u̇ and F over a span, both sides of each corner.
fn path(study: &Study, point: &Point, span: (f64, f64)) -> Result<Vec<(f64, f64, f64)>, String> {
    let model = study.model_at(point)?;
    let reference = match &study.reference {
        Some(answers) => Some(answers.closed(study, point, (0.0, span.1))?),
        None if model.states() == 0 => None,
        None => return Err(format!("study `{}` has no exact answer to draw", study.name)),
    };
    let mut bounds = vec![span.0];
    bounds.extend(study.input.corners(span.0, span.1));
    bounds.push(span.1);
    let mut x = vec![0.0; model.states()];
    let mut path = Vec::new();
    for arc in bounds.windows(2) {
        for i in 0..=PER_ARC {
            // Denser towards the turns, where the force changes most for the time.
            let share =
                0.5 - 0.5 * (std::f64::consts::PI * f64::from(i) / f64::from(PER_ARC)).cos();
            let t = arc[0] + share * (arc[1] - arc[0]);
            if let Some(reference) = &reference {
                reference.state(t, &mut x);
            }
            let (u, u_dot) = (study.input.u(t), study.input.u_dot_on(arc[0], arc[1], t));
            path.push((u, u_dot, force(model.as_ref(), &x, u, inner(u_dot, arc, study))));
        }
    }
    Ok(path)
}

/// At a turn the speed is zero and the force of a static model undefined: take the arc's own side.
fn inner(u_dot: f64, arc: &[f64], study: &Study) -> f64 {
    let middle = study.input.u_dot_on(arc[0], arc[1], 0.5 * (arc[0] + arc[1]));
    if u_dot == 0.0 { f64::MIN_POSITIVE.copysign(middle) } else { u_dot }
}

fn force(model: &dyn FrictionModel, x: &[f64], u: f64, u_dot: f64) -> f64 {
    let mut x_dot = vec![0.0; x.len()];
    model.x_dot(x, u, u_dot, &mut x_dot);
    model.force(x, &x_dot, u, u_dot)
}

fn steps(
    plan: &Plan,
    figure: &FigureSpec,
    panel: &PanelSpec,
    finished: &[Finished],
) -> Result<Series, String> {
    let (index, study, points) = shown(plan, figure, panel)?;
    let (mut series, solvers) = (Vec::new(), solver_names(&figure.solvers));
    for (case, finished) in plan.cases.iter().zip(finished) {
        if case.study != index {
            continue;
        }
        let label = &study.points[case.point].label;
        let wanted = points.iter().any(|p| p.label == *label)
            && (solvers.is_empty() || solvers.contains(&case.solver.name()));
        if let (true, Some(history)) = (wanted, &finished.record.history) {
            let xy = history.t.iter().copied().zip(history.step.iter().copied()).collect();
            series.push((pretty(label, study), xy));
        }
    }
    Ok(series)
}

/// A curve's label: the sweep's point, or the study's own without one.
fn pretty(label: &str, study: &Study) -> String {
    if label.is_empty() { study.label.clone() } else { label.to_owned() }
}
