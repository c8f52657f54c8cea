//! Measures of hysteresis from samples of a loop.
