//! The rig as nature: synthetic records of drives, with their own equations and their own integrator.
//!
//! **Invariant**: knows no other crate of the project, so that no equation, no solver and no mistake is
//! shared with those who analyse its records.
