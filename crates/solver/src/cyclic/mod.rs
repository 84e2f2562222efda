//! Rotationally periodic rings: one small system per harmonic in place of one large system.
//!
//! In cylindrical components the matrix of a ring of N equal sectors is block-circulant,
//! `(A u)_s = A_0 u_s + A_1 u_{s+1} + A_1^T u_{s-1}`. The discrete Fourier transform over the sectors splits A x = b
//! into N/2 + 1 independent systems of the size of one section,
//! ```text
//! A_k = A_0 + A_1 exp(2 pi i k / N) + A_1^T exp(-2 pi i k / N),    k = 0..=N/2
//! ```
//! (Davis, *Circulant Matrices*, 1979, section 5.6; for cyclic structures Thomas, International Journal for Numerical
//! Methods in Engineering 14, 1979, 81-102, doi:10.1002/nme.1620140107). If the section is its own mirror image, as a
//! revolved one is, A_k is real symmetric once the azimuthal component is multiplied by i and each node has the phase
//! of its own azimuth; otherwise it is Hermitian.
//!
//! **Vectors** come in two forms. *Nodal*: Cartesian, the caller's order, `[n]`. *Harmonic*: groups of four harmonics,
//! `[n_groups][n_section_nodes][3][2][4]`: section nodes in elimination order, components (radial, azimuthal, axial),
//! real and imaginary part, harmonic of the group; unused harmonics of the last group are zero. Of a ring that ranks
//! share, each has its own groups of a harmonic vector (`shared`). A state can stay in harmonic space: solve, product,
//! scalar product and loads of single nodes are there; output needs a transform.
//!
//! **Order.** Section nodes are eliminated in the order, of several, whose factor has the fewest blocks (`order`). It
//! can end with chosen nodes ([`CyclicRing::ending_with`]): a solve then comes in two halves, between which loads on
//! these nodes come in (`halves`).
//!
//! **Bits.** The work on one group is sequential and groups write to places of their own, so results are the same
//! for any number of threads. They do depend on the processor's vector instructions (fused multiply-add).
//!
//! Cost, with m dofs per section and bandwidth b: factor N m b^2 / 2 and solve 2 N m b multiplications and additions,
//! memory N m b / 2 numbers; without mirror symmetry four, two and two times as much. Measured with
//! `benches/cyclic.rs` (hex8, one core of a 2-core AMD EPYC 9004 that others used as well, November 2026, ms;
//! mirrored sections; sparse is [`crate::SparseCholesky`]: factor, MB, solve, 36 columns):
//!
//! | dof | factor | MB | solve in harmonic space | 36 columns | matrix product | transform there, back | sparse |
//! |---|---|---|---|---|---|---|---|
//! | 65 k | 0.85 | 5.0 | 0.20 | 7.1 | 0.28 | 0.27, 0.28 | 303, 144, 26, 123 |
//! | 151 k | 2.7 | 15.6 | 0.64 | 21 | 0.65 | 0.57, 0.60 | 1600, 560, 98, 420 |
//! | 410 k | 12 | 57 | 3.9 | 72 | 1.75 | 2.2, 2.3 | not run |
//!
//! These are the best of several runs on a loaded machine. A solve takes 1.5-3.2 times as long as reading the factor
//! once.

mod assemble;
mod border;
mod defect;
mod definite;
mod factor;
mod factor_rows;
mod halves;
mod kernel;
mod least_fill;
mod loose;
mod matrix;
mod mirrored;
mod number;
mod operator;
mod order;
mod part_field;
mod patch;
mod pattern;
mod phases;
mod product;
mod response;
mod ring;
mod row_responses;
mod shared;
mod sites;
mod sloan;
mod stencil;
mod sweep;
mod transform;

pub use border::CyclicBordered;
pub use defect::{Change, CyclicDefect, Defect, conjugate_gradients};
pub use definite::{Definite, DefiniteTest};
pub use factor::{CyclicCholesky, Symmetry};
pub use loose::Loose;
pub use matrix::CyclicMatrix;
pub use operator::{HarmonicOperator, turned};
pub use part_field::{PartField, PartHarmonics, PartLoads};
pub use patch::PatchWeights;
pub use pattern::Coupling;
pub use phases::NODE_LEN;
pub use response::{PairWeights, ResponseTable};
pub use ring::CyclicRing;
pub use row_responses::RowResponses;
pub use sites::NodalLoad;
pub use stencil::{CyclicStencil, PointStencil};
pub use transform::SectionPart;
