//! A ring cut by angle into sectors: each factored on its own, joined exactly at their interfaces.
//!
//! Rows of nodes inside one sector are its *interior*, those of nodes that sectors share the *interface*. With the
//! matrix as the sum of the sectors' own matrices, S = sum over s of S^(s), and i, b interior and boundary of a
//! sector,
//! ```text
//! S_ii = L L^T,    F = S_bi L^-T,    C = sum over s of (S_bb - F F^T)        (factor)
//! y_i = L^-1 f_i,  C x_b = f_b - sum over s of F y_i,  x_i = L^-T (y_i - F^T x_b)   (solve)
//! ```
//! (Przemieniecki, *Matrix structural analysis of substructures*, AIAA Journal 1, 1963, 138-147, doi:10.2514/3.1483.) A
//! cross-section meets its two neighbours only, so C is block cyclic tridiagonal; it is factored in the order of
//! cyclic reduction, every second cross-section first, and then again of those that stay (Golub and Van Loan, *Matrix
//! Computations*, 4th ed. 2013, section 4.5.4). A node that more than two sectors share, as with very thin ones, is
//! eliminated last. No step is iterative: the solution is that of the ring as a whole, to round-off.
//!
//! **Bits.** The number of sectors belongs to the problem. Threads and ranks decide only where a sector's work is done;
//! all sums over sectors run in their order. One rank factors the sectors that it owns, keeps their factors, and no
//! others; all ranks hold the interface of few sectors, and divide that of many ([`REDUCED_FROM`]).
//!
//! **Many right-hand sides**, such as the forces of all contacts, need not leave their sectors: [`SectorColumns`]
//! gives values at a few rows. [`SectorHalves`] stop half way and give products f S^-1 g; one sweep ends their sum.
//!
//! **Cost.** Cuts through a ring are the top separators of its dissection anyway, so fill and operations are those of
//! [`crate::SparseCholesky`] within a few per cent up to 32 sectors. The interface has about 2.3 n_sectors m^2
//! entries, m being the rows of a cross-section. A solve reads the factors twice; messages per solve: one gather of 2
//! m numbers per sector and right-hand side, and one of the solution; with a divided interface two more per level of
//! the reduction.

mod agree;
mod border;
mod columns;
mod cut;
mod factor;
mod halves;
mod interface;
mod layout;
mod part;
mod reduced;
mod reduction;
mod solve;

pub use border::{BorderedHalves, SectorBordered};
pub use columns::SectorColumns;
pub use factor::{SectorCholesky, SectorSymbolic};
pub use halves::SectorHalves;
pub use interface::REDUCED_FROM;
pub use layout::{Sector, SectorCut, SectorLayout, default_sectors};
pub use part::{Points, SectorCost};
