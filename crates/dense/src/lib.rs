//! Dense matrices of up to a few hundred rows: Cholesky and LU factors, symmetric eigenpairs. And the lowest
//! eigenpairs of matrices that only act ([`eigen`]).
//!
//! Sequential and deterministic: the same matrix gives the same bits. Matrices are row-major, `a[n * i + j]`;
//! right-hand sides are column-major, `[n][n_rhs]`.
//! ```
//! use dense::DenseCholesky;
//! let mut x = vec![6.0, 7.0];
//! DenseCholesky::factor(2, &[4.0, 2.0, 2.0, 5.0])?.solve(&mut x, 1);
//! assert_eq!(x, [1.0, 1.0]);
//! # Ok::<(), dense::DenseError>(())
//! ```

mod blocks;
pub mod eigen;
mod error;
mod factors;
mod forms;

pub use blocks::BlockLu;
pub use eigen::{
    ComplexNumber, ComplexPair, EigenProblem, Eigenpairs, LanczosSettings, Searched, add_combinations,
    dense_lowest, general_eigen, inner_products, lanczos, linear_combinations, lowest_pairs, symmetric_eigen,
};
pub use error::DenseError;
pub use factors::{DenseCholesky, DenseLu, cholesky_in_place};
pub use forms::{inverse_form, symmetric_form, symmetric_product, update};
