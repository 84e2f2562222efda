//! A block-circulant symmetric matrix, held as the blocks of one sector.

use std::sync::Arc;

use super::pattern::{Coupling, CyclicPattern};
use crate::error::SolverError;

/// Entries of opposite blocks may differ by this share of the largest entry: rounding of sums over elements.
const SYMMETRY: f64 = 1e-12;

/// A symmetric matrix of a rotationally periodic ring in cylindrical components:
/// `(A u)_{s,a} = sum over couplings (a, b, d) of C_abd u_{s+d,b}` for every sector s.
///
/// Memory: one 3 x 3 block per coupling of one sector. Clones and combinations share the pattern.
#[derive(Clone, Debug)]
pub struct CyclicMatrix {
    pub(crate) pattern: Arc<CyclicPattern>,
    /// Blocks in the pattern's order, `[n_couplings][3][3]` over (radial, azimuthal, axial).
    pub(crate) blocks: Vec<[f64; 9]>,
}

impl CyclicMatrix {
    /// A matrix from couplings in any order and their blocks, row-major `[n_couplings][3][3]`. Couplings come in
    /// opposite pairs, whose blocks are transposes, and include every node with itself.
    ///
    /// # Panics
    /// When there are not as many blocks as couplings, or no sectors.
    pub fn new(
        n_sectors: usize,
        n_section_nodes: usize,
        couplings: &[Coupling],
        blocks: &[[f64; 9]],
    ) -> Result<CyclicMatrix, SolverError> {
        assert_eq!(couplings.len(), blocks.len(), "one block per coupling");
        assert!(n_sectors > 0, "a ring has at least one sector");
        let (pattern, places) = CyclicPattern::new(n_sectors, n_section_nodes, couplings)?;
        let matrix = CyclicMatrix {
            pattern: Arc::new(pattern),
            blocks: places.iter().map(|&place| blocks[place]).collect(),
        };
        matrix.check_finite()?;
        matrix.check_symmetric()?;
        Ok(matrix)
    }

    /// Another matrix with the couplings of this one, in the order they were given to [`CyclicMatrix::new`].
    pub fn with_blocks(
        &self,
        couplings: &[Coupling],
        blocks: &[[f64; 9]],
    ) -> Result<CyclicMatrix, SolverError> {
        let other = CyclicMatrix::new(self.n_sectors(), self.pattern.n_section_nodes, couplings, blocks)?;
        self.check_pattern(&other.pattern)?;
        Ok(CyclicMatrix {
            pattern: self.pattern.clone(),
            blocks: other.blocks,
        })
    }

    /// The sum `factor A + other_factor B` with a matrix of the same couplings.
    pub fn combined(
        &self,
        factor: f64,
        other_factor: f64,
        other: &CyclicMatrix,
    ) -> Result<CyclicMatrix, SolverError> {
        self.check_pattern(&other.pattern)?;
        let sum =
            |(a, b): (&[f64; 9], &[f64; 9])| std::array::from_fn(|ij| factor * a[ij] + other_factor * b[ij]);
        Ok(CyclicMatrix {
            pattern: self.pattern.clone(),
            blocks: self.blocks.iter().zip(&other.blocks).map(sum).collect(),
        })
    }

    /// The matrix without the section nodes that `keep` (ascending) does not name: whole rings of nodes are held.
    ///
    /// # Panics
    /// When `keep` is not ascending or names a node outside.
    pub fn restricted(&self, keep: &[usize]) -> CyclicMatrix {
        check_ascending(keep, self.pattern.n_section_nodes);
        let (pattern, places) = self.pattern.restrict(keep);
        CyclicMatrix {
            pattern: Arc::new(pattern),
            blocks: places.iter().map(|&place| self.blocks[place]).collect(),
        }
    }

    /// Number of sectors N.
    pub fn n_sectors(&self) -> usize {
        self.pattern.n_sectors
    }

    /// Number of couplings of one sector, 3 x 3 numbers each.
    pub fn n_couplings(&self) -> usize {
        self.blocks.len()
    }

    /// Number of rows of the whole ring.
    pub fn n(&self) -> usize {
        3 * self.pattern.n_sectors * self.pattern.n_section_nodes
    }

    /// Largest magnitude of an entry.
    pub(crate) fn largest(&self) -> f64 {
        self.blocks.iter().flatten().fold(0.0, |m, x| m.max(x.abs()))
    }

    /// Refuses a pattern other than this matrix'.
    pub(crate) fn check_pattern(&self, other: &Arc<CyclicPattern>) -> Result<(), SolverError> {
        if Arc::ptr_eq(&self.pattern, other) || self.pattern == *other {
            return Ok(());
        }
        Err(SolverError::PatternChanged {
            found: other.couplings.len(),
            expected: self.pattern.couplings.len(),
        })
    }

    fn check_finite(&self) -> Result<(), SolverError> {
        for (c, block) in self.pattern.couplings.iter().zip(&self.blocks) {
            if let Some(ij) = block.iter().position(|x| !x.is_finite()) {
                return Err(SolverError::NonFinite {
                    row: 3 * c.row + ij / 3,
                    column: 3 * c.column + ij % 3,
                    value: block[ij],
                });
            }
        }
        Ok(())
    }

    fn check_symmetric(&self) -> Result<(), SolverError> {
        let limit = SYMMETRY * self.largest();
        for (&c, block) in self.pattern.couplings.iter().zip(&self.blocks) {
            let Some(place) = self.pattern.place(self.pattern.opposite(c)) else {
                continue;
            };
            let back = &self.blocks[place];
            let difference = (0..9)
                .map(|ij| (block[ij] - back[3 * (ij % 3) + ij / 3]).abs())
                .fold(0.0, f64::max);
            if difference > limit {
                let Coupling { row, column, shift } = c;
                return Err(SolverError::NotSymmetric {
                    row,
                    column,
                    shift,
                    difference,
                    limit,
                });
            }
        }
        Ok(())
    }
}

/// `keep` must be ascending and below `n`.
pub(crate) fn check_ascending(keep: &[usize], n: usize) {
    assert!(
        keep.windows(2).all(|pair| pair[0] < pair[1]) && keep.last().is_none_or(|&last| last < n),
        "the section nodes to keep must be ascending and below {n}"
    );
}
