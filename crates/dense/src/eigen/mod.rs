//! Eigenpairs: all of a dense matrix, symmetric or not, or the lowest of K x = lambda M x, whose K and M only act.

mod basis;
mod general;
mod lanczos;
mod problem;
mod symmetric;
mod whole;

pub use basis::{add_combinations, inner_products, linear_combinations};
pub use general::{ComplexNumber, ComplexPair, general_eigen};
pub use lanczos::{LanczosSettings, Searched, lanczos, lowest_pairs};
pub use problem::{EigenProblem, Eigenpairs};
pub use symmetric::symmetric_eigen;
pub use whole::dense_lowest;
