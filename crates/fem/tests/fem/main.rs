//! Tests of the finite elements: one binary, one file per subject.

mod convergence;
mod errors;
mod gauge;
mod loads;
mod matrices;
mod patch;
mod points;
mod prestress;
mod reference;
mod rings;
mod sector;
mod stress;
mod support;
mod tube_gauge;
mod waves;
