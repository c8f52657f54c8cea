//! Adapters to the solver libraries.
