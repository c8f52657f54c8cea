//! Alexander's L-stable method of order 3 with three stages, and the method of order 2 inside it.

/// γ, the root of γ³ − 3γ² + 3γ/2 − 1/6 = 0 for which the method is L-stable.
pub(super) const GAMMA: f64 = 0.435_866_521_508_459;

/// The weights of a step's earlier stages in each stage's base.
pub(super) const A: [[f64; 2]; 3] = [[0.0, 0.0], [0.5 * (1.0 - GAMMA), 0.0], [B_1, B_2]];

const B_1: f64 = -(6.0 * GAMMA * GAMMA - 16.0 * GAMMA + 1.0) / 4.0;
const B_2: f64 = (6.0 * GAMMA * GAMMA - 20.0 * GAMMA + 5.0) / 4.0;

/// When the stages are, in steps.
pub(super) const C: [f64; 3] = [GAMMA, 0.5 * (1.0 + GAMMA), 1.0];

/// The second stage's weight in the method of order 2 that uses the first two stages only.
const SECOND: f64 = (1.0 - 2.0 * GAMMA) / (1.0 - GAMMA);

/// What the stages' derivatives weigh in the estimated error of a step.
pub(super) const ERROR: [f64; 3] = [B_1 - (1.0 - SECOND), B_2 - SECOND, GAMMA];
