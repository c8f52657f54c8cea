//! Adapters to the solver libraries; their types stay in these files.

pub(crate) mod ode_solvers;

pub(crate) mod diffsol;
