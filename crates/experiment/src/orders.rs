//! Observed orders: the slope of the error over a solver's controls.

use crate::plan::{Plan, control_name, corners_name};
use integrate::{Order, solver};
use record::{CaseRow, OrderRow};
use std::collections::BTreeMap;

/// Errors below this are round-off, and no slope is taken through them.
const FLOOR: f64 = 1e-12;
/// The slope is taken over the finest controls, so many of them; the coarse ones are not asymptotic yet.
const FINEST: usize = 4;

/// Where a case belongs: study, point, solver and way of treating corners, in the order of the plan.
type Group = (usize, usize, usize, &'static str);

/// The cases of each group by their indices, coarse controls first.
fn groups(plan: &Plan) -> BTreeMap<Group, Vec<usize>> {
    let mut groups: BTreeMap<Group, Vec<usize>> = BTreeMap::new();
    for (i, case) in plan.cases.iter().enumerate() {
        // What has no control has no slope against it.
        if control_name(case.solver) == "none" {
            continue;
        }
        let solvers = &plan.studies[case.study].solvers;
        let place =
            solvers.iter().position(|s| s.name() == case.solver.name()).unwrap_or(solvers.len());
        groups
            .entry((case.study, case.point, place, corners_name(case.corners)))
            .or_default()
            .push(i);
    }
    groups
}

/// One row for each group, in their order.
pub(crate) fn orders(plan: &Plan, cases: &[CaseRow]) -> Vec<OrderRow> {
    let rows = groups(plan).into_values();
    rows.filter_map(|group| order(&group.iter().map(|i| &cases[*i]).collect::<Vec<_>>())).collect()
}

/// Writes into each case the slope from its next coarser neighbour.
pub(crate) fn local(plan: &Plan, cases: &mut [CaseRow]) {
    for group in groups(plan).into_values() {
        for pair in group.windows(2) {
            let ends: Vec<(f64, f64)> =
                pair.iter().filter_map(|i| point(&cases[*i], against(&cases[*i]))).collect();
            cases[pair[1]].order = slope(&ends);
        }
    }
}

/// What slopes are taken against. An adaptive method restarts with short steps: on a few pieces that
/// distorts a slope against its steps.
fn against(row: &CaseRow) -> &'static str {
    if row.control == "step" { "steps" } else { "rtol" }
}

/// The logarithms of the control and the error, if the case was solved above round-off.
fn point(row: &CaseRow, against: &str) -> Option<(f64, f64)> {
    let error = row.error_max.filter(|e| *e > FLOOR && row.status == "solved")?;
    let x = if against == "rtol" { row.value } else { 1.0 / row.accepted as f64 };
    Some((x.ln(), error.ln()))
}

fn order(rows: &[&CaseRow]) -> Option<OrderRow> {
    let first = rows.first()?;
    let declared = solver(&first.solver).map(|s| s.order);
    let against = against(first);
    let mut points: Vec<(f64, f64)> = rows.iter().filter_map(|row| point(row, against)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.truncate(FINEST);
    Some(OrderRow {
        study: first.study.clone(),
        point: first.point.clone(),
        solver: first.solver.clone(),
        library: first.library.clone(),
        declared: match declared {
            Some(Order::Fixed(order) | Order::Adaptive(order)) => Some(u64::from(order)),
            _ => None,
        },
        corners: first.corners.clone(),
        against: against.to_owned(),
        order: slope(&points),
        points: points.len() as u64,
        failed: rows.iter().filter(|row| row.status != "solved").count() as u64,
        irreproducible: first.irreproducible.clone(),
    })
}

/// The least-squares slope; none through fewer than two different abscissae.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (points.len() >= 2 && xx > 1e-6).then(|| xy / xx)
}

#[cfg(test)]
mod tests {
    use super::slope;

    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        let points: Vec<(f64, f64)> =
            (1..6).map(f64::from).map(|x| (x.ln(), (3.0 * x.powf(2.5)).ln())).collect();
        let found = slope(&points).unwrap();
        assert!((found - 2.5).abs() < 1e-12, "slope {found}");
    }

    #[test]
    fn one_point_has_no_slope() {
        assert_eq!(slope(&[(0.0, 1.0)]), None);
        assert_eq!(slope(&[(0.0, 1.0), (0.0, 2.0)]), None);
    }
}
