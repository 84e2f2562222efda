//! Rows that a ring has and its regular ring lacks, such as nodes that are free where most sectors are held.
//!
//! With b these rows and t their neighbours the matrix is [A_tt A_tb; A_bt A_bb]. b is eliminated first: the ring
//! gets the loads f_t - A_tb A_bb^-1 f_b, its change has -A_tb A_bb^-1 A_bt more, and x_b = A_bb^-1 (f_b - A_bt x_t)
//! follows. Cost: m^2 + 2 m n for m rows and n neighbours.

use dense::DenseCholesky;

use crate::error::SolverError;

/// Rows beyond those of the regular ring.
#[derive(Clone, Debug)]
pub struct Loose {
    /// Their numbers, b.
    rows: Vec<usize>,
    /// Rows that they couple with, t.
    neighbours: Vec<usize>,
    /// A_bb.
    own: DenseCholesky,
    /// A_bt, row-major.
    coupling: Vec<f64>,
}

impl Loose {
    /// Rows with A_bb `own`, `[m][m]`, and A_bt `coupling`, `[m][n]`, both row-major.
    pub(super) fn new(
        rows: Vec<usize>,
        neighbours: Vec<usize>,
        own: &[f64],
        coupling: Vec<f64>,
    ) -> Result<Loose, SolverError> {
        assert_eq!(
            coupling.len(),
            rows.len() * neighbours.len(),
            "rows by neighbours"
        );
        Ok(Loose {
            own: DenseCholesky::factor(rows.len(), own)?,
            rows,
            neighbours,
            coupling,
        })
    }

    /// Moves the loads on b to t: what a ring without b must bear. Returns A_bb^-1 f_b.
    pub fn take(&self, loads: &mut [f64]) -> Vec<f64> {
        let mut alone: Vec<f64> = self
            .rows
            .iter()
            .map(|&row| std::mem::take(&mut loads[row]))
            .collect();
        self.own.solve(&mut alone, 1);
        for (x, coupling) in alone
            .iter()
            .zip(self.coupling.chunks_exact(self.neighbours.len().max(1)))
        {
            for (&row, a) in self.neighbours.iter().zip(coupling) {
                loads[row] -= a * x;
            }
        }
        alone
    }

    /// Writes x_b into a solution, from what [`Loose::take`] returned.
    pub fn put(&self, alone: &[f64], x: &mut [f64]) {
        let rows = self.coupling.chunks_exact(self.neighbours.len().max(1));
        let pull = |coupling: &[f64]| -> f64 {
            let pairs = self.neighbours.iter().zip(coupling);
            pairs.map(|(&row, a)| a * x[row]).sum()
        };
        let mut pulled: Vec<f64> = rows.map(pull).collect();
        self.own.solve(&mut pulled, 1);
        for ((&row, alone), pulled) in self.rows.iter().zip(alone).zip(&pulled) {
            x[row] = alone - pulled;
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}
