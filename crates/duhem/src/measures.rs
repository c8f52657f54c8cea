//! Measures of hysteresis from samples of a loop: for what has no closed form.
//!
//! A loop is two slices, the displacements u [m] and the forces F [N] in the order of travel, over one
//! period, with or without the first point repeated at the end.

/// A number with what a coarser look at the same samples says about its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its estimated error, in the same unit.
    pub error: f64,
}

/// How a loop is run through, as plotted with u horizontal and F vertical.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Orientation {
    /// ∮F du > 0: F is larger on the way up (in u) than on the way down. Energy is lost.
    ///
    /// The paper (p. 96) says counterclockwise. So it is with F horizontal and u vertical, which is how
    /// Figures 13 and 14 plot a drive, but none of its plots of friction.
    Clockwise,
    /// ∮F du < 0.
    Counterclockwise,
    /// ∮F du = 0.
    None,
}

/// Whether the settled loop remembers where it came from (p. 92).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    /// The hysteresis map does not depend on the initial state.
    Local,
    /// It does.
    Nonlocal,
}

/// ∫F du [J] along the samples by the trapezoidal rule; its error is that of every second sample
/// less a third, as the rule's order two has it where F is smooth between samples.
///
/// Samples at the turning points and at kinks of F make it so; elsewhere the estimate is rough.
pub fn work(u: &[f64], f: &[f64]) -> Estimate {
    let value = trapezoid(u.iter().zip(f));
    let coarse = trapezoid(thinned(u).zip(thinned(f)));
    Estimate { value, error: (value - coarse).abs() / 3.0 }
}

/// ∮F du [J] over a closed loop, positive when energy is lost.
pub fn area(u: &[f64], f: &[f64]) -> Estimate {
    let (u, f) = (closed(u), closed(f));
    work(&u, &f)
}

/// How the loop turns in the plane of u (horizontal) and F (vertical).
pub fn orientation(u: &[f64], f: &[f64]) -> Orientation {
    // Green: ∮F du is minus the area that a counterclockwise curve encloses.
    match area(u, f).value {
        area if area > 0.0 => Orientation::Clockwise,
        area if area < 0.0 => Orientation::Counterclockwise,
        _ => Orientation::None,
    }
}

/// The displacements [m] where the loop crosses F = 0, in the order of travel; linear between samples.
pub fn zero_force(u: &[f64], f: &[f64]) -> Vec<f64> {
    crossings(f, u)
}

/// The forces [N] where the loop crosses u = `at` [m], in the order of travel.
pub fn forces_at(u: &[f64], f: &[f64], at: f64) -> Vec<f64> {
    let shifted: Vec<f64> = u.iter().map(|u| u - at).collect();
    crossings(&shifted, f)
}

/// The width [m] of the loop at F = 0: the distance between its outermost crossings, if there are two.
pub fn width_at_zero_force(u: &[f64], f: &[f64]) -> Option<f64> {
    let crossings = zero_force(u, f);
    let low = crossings.iter().copied().reduce(f64::min)?;
    let high = crossings.iter().copied().reduce(f64::max)?;
    (crossings.len() > 1).then_some(high - low)
}

/// The memory that two settled loops under the same input show, from different initial states and
/// sampled at the same phases: nonlocal if their forces differ by more than `tolerance` [N] anywhere.
pub fn memory(first: &[f64], second: &[f64], tolerance: f64) -> Memory {
    let alike = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance;
    if first.len() == second.len() && first.iter().zip(second).all(alike) {
        Memory::Local
    } else {
        Memory::Nonlocal
    }
}

fn trapezoid<'a>(samples: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    let mut sum = 0.0;
    let mut last: Option<(f64, f64)> = None;
    for (u, f) in samples {
        if let Some((u0, f0)) = last {
            sum += 0.5 * (f + f0) * (u - u0);
        }
        last = Some((*u, *f));
    }
    sum
}

/// Every second sample, and the last.
fn thinned(list: &[f64]) -> impl Iterator<Item = &f64> {
    let last = if list.len().is_multiple_of(2) { list.last() } else { None };
    list.iter().step_by(2).chain(last)
}

fn closed(list: &[f64]) -> Vec<f64> {
    list.iter().chain(list.first()).copied().collect()
}

/// The values of `along` where the closed loop's `level` crosses zero.
fn crossings(level: &[f64], along: &[f64]) -> Vec<f64> {
    let n = level.len().min(along.len());
    let side = |i: usize| {
        let j = (i + 1) % n;
        let (a, b) = (level[i], level[j]);
        // A sample on zero counts with the side that leaves it.
        let crosses = a != b && ((a <= 0.0 && b > 0.0) || (a >= 0.0 && b < 0.0));
        crosses.then(|| along[i] + (along[j] - along[i]) * (a / (a - b)))
    };
    (0..n).filter_map(side).collect()
}
