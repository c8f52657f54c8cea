//! Observed orders: the slope of the error over a solver's controls.

use crate::plan::Plan;
use integrate::{Order, solver};
use record::{CaseRow, OrderRow};
use std::collections::BTreeMap;

/// Errors below this are round-off, and no slope is taken through them.
const FLOOR: f64 = 1e-12;
/// The slope is taken over the finest controls, so many of them; the coarse ones are not asymptotic yet.
const FINEST: usize = 4;

/// One row for each study, point, solver and way of treating corners, in the order of the cases.
pub(crate) fn orders(plan: &Plan, cases: &[CaseRow]) -> Vec<OrderRow> {
    let mut groups: BTreeMap<(usize, usize, usize, &str), Vec<&CaseRow>> = BTreeMap::new();
    for (case, row) in plan.cases.iter().zip(cases) {
        let solvers = &plan.studies[case.study].solvers;
        let place = solvers.iter().position(|s| s.name == row.solver).unwrap_or(solvers.len());
        groups.entry((case.study, case.point, place, &row.corners)).or_default().push(row);
    }
    groups.values().filter_map(|rows| order(rows)).collect()
}

fn order(rows: &[&CaseRow]) -> Option<OrderRow> {
    let first = rows.first()?;
    let declared = solver(&first.solver).map(|s| s.order);
    // An adaptive method restarts with short steps: on a few pieces that distorts a slope against its steps.
    let against = if matches!(declared, Some(Order::Fixed(_))) { "steps" } else { "rtol" };
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.status == "solved")
        .filter_map(|row| {
            let error = row.error_max.filter(|e| *e > FLOOR)?;
            let x = if against == "rtol" { row.value } else { 1.0 / row.accepted as f64 };
            Some((x.ln(), error.ln()))
        })
        .collect();
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
