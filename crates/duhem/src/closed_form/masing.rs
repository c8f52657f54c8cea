//! The Maxwell-slip model a second time, with no formula of [`super::maxwell_slip`]: the whole model as
//! one Prandtl–Ishlinskii operator.
//!
//! From rest it follows the virgin curve f(u) = Σ kᵢ min(|u|, Δᵢ) sgn u. After a turn at (u₁, F₁) it
//! follows Masing's rule, F = F₁ ± 2f(|u − u₁|/2), until it meets the turn before, which is then wiped
//! out. What is remembered is a list of turns, each nearer than the one before, and no position of any
//! element. Energies come from the positions, which are the play operator's: x = clamp(x, u ± Δ).

use crate::MaxwellSlip;

/// f(u) [N]: the force after the displacement `u` [m] from rest.
pub fn virgin(model: &MaxwellSlip, u: f64) -> f64 {
    let element = |(k, delta): (&f64, &f64)| k * u.abs().min(*delta);
    model.k.iter().zip(&model.delta).map(element).sum::<f64>() * crate::sgn(u)
}

/// ∫f du [J] from 0 to `u` [m] ≥ 0: a triangle and a rectangle for each element.
fn under(model: &MaxwellSlip, u: f64) -> f64 {
    let element = |(k, delta): (&f64, &f64)| {
        let stuck = u.min(*delta);
        k * stuck * (u - 0.5 * stuck)
    };
    model.k.iter().zip(&model.delta).map(element).sum()
}

/// The force [N] at the end of the path through `turns` [m], from rest at the first of them.
pub fn force(model: &MaxwellSlip, turns: &[f64]) -> f64 {
    let Some((start, path)) = turns.split_first() else { return 0.0 };
    // The turns remembered, from the rest position; the last one is where the path is.
    let mut memory: Vec<f64> = vec![0.0];
    for u in path.iter().map(|u| u - start) {
        loop {
            let n = memory.len();
            if n >= 2 && (u - memory[n - 1]) * (memory[n - 1] - memory[n - 2]) >= 0.0 {
                // On in the same direction: the last place was no turn.
                memory.truncate(n - 1);
            } else if n >= 3 && beyond(memory[n - 2], memory[n - 1], u) {
                // Back through the turn before the last: both are forgotten.
                memory.truncate(n - 2);
            } else if n == 2 && u.abs() >= memory[1].abs() {
                // Farther from rest than ever: the virgin curve again.
                memory.truncate(1);
            } else {
                break;
            }
        }
        memory.push(u);
    }
    let mut total = memory.get(1).map_or(0.0, |first| virgin(model, *first));
    for pair in memory.windows(2).skip(1) {
        total += 2.0 * virgin(model, 0.5 * (pair[1] - pair[0]));
    }
    total
}

/// Whether a path that turned at `last`, after `before`, has come back to `before` or beyond at `u`.
fn beyond(before: f64, last: f64, u: f64) -> bool {
    (u - last) * (before - last) >= (before - last) * (before - last)
}

/// ∮F du [J] of the loop of the width `beta` [m]: two branches 2f(v/2) of the width β.
pub fn area(model: &MaxwellSlip, beta: f64) -> f64 {
    8.0 * under(model, 0.5 * beta) - 2.0 * beta * virgin(model, 0.5 * beta)
}

/// Displacement [m] from the turn of a loop of the width `beta` [m] about F = 0 to F = 0, by bisection.
pub fn lag(model: &MaxwellSlip, beta: f64) -> f64 {
    let half = 0.5 * virgin(model, 0.5 * beta);
    let (mut low, mut high) = (0.0, beta);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if virgin(model, 0.5 * middle) < half { low = middle } else { high = middle }
    }
    high
}

/// ∫F du [J] along the path through `turns` [m] from rest at the first of them: what the springs hold at
/// the end, and kᵢΔᵢ for each metre that a position has slipped.
pub fn work(model: &MaxwellSlip, turns: &[f64]) -> f64 {
    let element = |(k, delta): (&f64, &f64)| {
        let mut x = turns.first().copied().unwrap_or(0.0);
        let (mut slipped, mut u) = (0.0, x);
        for next in turns {
            u = *next;
            let moved = x.clamp(u - delta, u + delta);
            slipped += (moved - x).abs();
            x = moved;
        }
        k * (0.5 * (u - x) * (u - x) + delta * slipped)
    };
    model.k.iter().zip(&model.delta).map(element).sum()
}
