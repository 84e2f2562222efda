//! Solves S x = b for a fixed symmetric positive definite S: factor once, many right-hand sides.
//!
//! The crate knows matrices, not meshes; the only geometry it sees are the points and element cliques from which
//! [`angular_dissection`] makes an elimination order. Dense matrices are those of the crate `dense`.
//!
//! A ring is solved in five lines:
//! ```
//! # use solver::*;
//! # let s = sprs::CsMat::new((3, 3), vec![0, 1, 2, 3], vec![0, 1, 2], vec![4.0, 16.0, 64.0]);
//! # let (points, elements) = (vec![[1.0, 0.0, 0.0]], vec![0_usize]);
//! let nodes = angular_dissection(&points, &elements, 1);
//! let symbolic = Symbolic::new(&s, &expand(&nodes, 3))?;
//! let factor = symbolic.factor(&s)?;
//! let mut x = vec![4.0, 16.0, 64.0];
//! factor.solve(&mut x, 1);
//! # assert_eq!(x, [1.0, 1.0, 1.0]);
//! # Ok::<(), SolverError>(())
//! ```
//! Clamped degrees of freedom are taken out with [`restrict_lower`] (matrix) and [`restrict_order`] (order).
//!
//! A ring whose sectors are equal is solved harmonic by harmonic ([`cyclic`]), two orders of magnitude cheaper, through
//! the same trait. A few dense rows more, such as those of a rigid partner, are a [`Bordered`] factor.
//!
//! Any other ring is cut by angle into sectors ([`sector`]), which are factored and solved in parallel and joined
//! exactly.
//!
//! A sparse factor whose halves come apart takes one solve where forces at a few rows follow from the motion there
//! ([`triangular`]).
//!
//! The cyclic solver, sectors and these halves run their harmonics, sectors and subtrees in parallel, each in its own
//! place, and sum in a fixed order; all else is sequential. So the bits of a result cannot depend on the number of
//! threads.

pub mod cyclic;
pub mod dissection;
pub mod sector;
pub mod triangular;

pub mod bordered;
mod cholesky;
mod elimination_tree;
mod error;
mod kernel;
mod linear_solver;
mod panels;
mod permutation;
mod products;
mod refinement;
mod submatrix;
mod symbolic;

pub use bordered::Bordered;
pub use cholesky::SparseCholesky;
pub use cyclic::{
    Coupling, CyclicBordered, CyclicCholesky, CyclicMatrix, CyclicRing, CyclicStencil, NodalLoad,
    PatchWeights, ResponseTable, SectionPart, Symmetry,
};
pub use dissection::angular_dissection;
pub use error::SolverError;
pub use linear_solver::{LinearSolver, SparseVector};
pub use permutation::{expand, restrict_order};
pub use products::products;
pub use refinement::{Refined, solve_refined};
pub use sector::{
    BorderedHalves, Points, Sector, SectorBordered, SectorCholesky, SectorColumns, SectorCost, SectorCut,
    SectorHalves, SectorLayout, SectorSymbolic, default_sectors,
};
pub use submatrix::{restrict, restrict_lower};
pub use symbolic::Symbolic;
pub use triangular::{ForwardColumns, TriangularFactor};
