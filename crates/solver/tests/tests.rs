//! Tests of the solvers, one file or folder per area, in one program, so that their libraries are linked once.

mod bordered;
mod cholesky;
mod common;
mod cyclic;
mod dense;
mod dissection;
mod lanczos;
mod sector;
mod triangular;
