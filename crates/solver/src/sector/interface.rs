//! The matrix of the interface: the sum of the sectors' Schur complements, block cyclic tridiagonal, and its factor.

use sprs::CsMat;

use super::layout::SectorLayout;
use crate::cholesky::SparseCholesky;
use crate::error::SolverError;
use crate::symbolic::Symbolic;

/// Analysis of the interface.
#[derive(Debug)]
pub(super) struct InterfaceSymbolic {
    symbolic: Symbolic,
    /// Lower triangle by columns: starts, and rows in ascending order.
    starts: Vec<usize>,
    rows: Vec<usize>,
}

impl InterfaceSymbolic {
    /// Analyses the interface of a layout, whose order is kept; None without interface.
    pub(super) fn new(layout: &SectorLayout) -> Result<Option<InterfaceSymbolic>, SolverError> {
        let n = layout.interface().len();
        if n == 0 {
            return Ok(None);
        }
        let mut touching = vec![Vec::new(); n];
        for sector in layout.sectors() {
            for (i, &place) in sector.boundary.iter().enumerate() {
                touching[place].push(&sector.boundary[i..]);
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for tails in touching {
            let mut column = tails.concat();
            column.sort_unstable();
            column.dedup();
            rows.extend(column);
            starts.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        let pattern = CsMat::new_csc((n, n), starts.clone(), rows.clone(), values);
        let natural: Vec<usize> = (0..n).collect();
        Ok(Some(InterfaceSymbolic {
            symbolic: Symbolic::new(&pattern, &natural)?,
            starts,
            rows,
        }))
    }

    /// Bytes of the factor.
    pub(super) fn factor_bytes(&self) -> usize {
        self.symbolic.factor_bytes()
    }

    /// Factors the sum of the complements of all sectors, one after the other in `complements`, added in their order.
    pub(super) fn factor(
        &self,
        layout: &SectorLayout,
        complements: &[f64],
    ) -> Result<SparseCholesky, SolverError> {
        let n = layout.interface().len();
        let mut values = vec![0.0; self.rows.len()];
        let mut first = 0;
        for sector in layout.sectors() {
            let boundary = &sector.boundary;
            let size = boundary.len();
            let packed = &complements[first..first + size * (size + 1) / 2];
            first += packed.len();
            for (j, &column) in boundary.iter().enumerate() {
                let mut at = self.starts[column];
                for (i, &row) in boundary.iter().enumerate().skip(j) {
                    while self.rows[at] != row {
                        at += 1;
                    }
                    values[at] += packed[i * (i + 1) / 2 + j];
                }
            }
        }
        let matrix = CsMat::new_csc((n, n), self.starts.clone(), self.rows.clone(), values);
        self.symbolic.factor(&matrix).map_err(|error| match error {
            SolverError::NotPositiveDefinite { row, .. } => SolverError::NotPositiveDefinite {
                row: layout.interface()[row],
                n: layout.n(),
            },
            SolverError::Singular {
                row,
                relative_pivot,
                limit,
                ..
            } => SolverError::Singular {
                row: layout.interface()[row],
                n: layout.n(),
                relative_pivot,
                limit,
            },
            other => other,
        })
    }
}
