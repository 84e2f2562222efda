//! Sparse supernodal Cholesky factorisation S = L L^T of a permuted matrix.
//!
//! Cost on one core of a 2-core Xeon at 2.3 GHz, loaded, ring of 59 400 dof (`benches/sparse.rs`, November 2026): order
//! 0.04 s, analysis 0.09 s, factorisation 0.33 s (12 GFlop/s, 128 MB), one right-hand side 20 ms, which is 1.5 times
//! the time to read the factor twice, 36 right-hand sides 108 ms. Sequential by choice: faer's own threads
//! gained nothing on these matrices.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::LltRef;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use sprs::CsMat;

use crate::error::SolverError;
use crate::linear_solver::LinearSolver;
use crate::symbolic::{Symbolic, stored_side, supernodes};

/// Smallest accepted pivot relative to its diagonal entry. The last pivots of a body that is free to move are pure
/// round-off: on spring rings of 96 to 59 400 dof, ten of eleven came out negative and one 7e-15 of its diagonal
/// (measured). A free steel ring held only by its inertia over a step as long as 0.1 s keeps about 1e-8 (estimate).
pub(crate) const PIVOT_LIMIT: f64 = 1e-12;

/// Refuses a pivot, given relative to its diagonal entry, that is round-off or not a number.
pub(crate) fn check_pivot(row: usize, n: usize, relative_pivot: f64) -> Result<(), SolverError> {
    if relative_pivot.is_nan() {
        return Err(SolverError::NotPositiveDefinite { row, n });
    }
    if relative_pivot < PIVOT_LIMIT {
        return Err(SolverError::Singular {
            row,
            n,
            relative_pivot,
            limit: PIVOT_LIMIT,
        });
    }
    Ok(())
}

/// A Cholesky factor; [`LinearSolver::solve`] uses it.
#[derive(Debug)]
pub struct SparseCholesky {
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl Symbolic {
    /// Factors a matrix of the analysed pattern, on the calling thread. Time `flops() / (10..40 GFlop/s)`.
    pub fn factor(&self, matrix: &CsMat<f64>) -> Result<SparseCholesky, SolverError> {
        self.require_pattern(matrix)?;
        SparseCholesky::new(self.clone(), matrix)
    }
}

impl SparseCholesky {
    /// Factors `matrix`, whose pattern is that of `symbolic`.
    pub(crate) fn new(symbolic: Symbolic, matrix: &CsMat<f64>) -> Result<Self, SolverError> {
        check_finite(matrix)?;
        let n = symbolic.n();
        let faer = &symbolic.shared.faer;
        let bytes = symbolic.peak_bytes();
        let out_of_memory = || SolverError::OutOfMemory { n, bytes };
        // Memory that the system hands out zeroed is touched first by the factorisation, in its own order; asking
        // before taking it turns a lack of memory into an error.
        Vec::<f64>::new()
            .try_reserve_exact(faer.len_val())
            .map_err(|_| out_of_memory())?;
        let mut values = vec![0.0; faer.len_val()];
        let mut memory = MemBuffer::try_new(symbolic.factor_scratch()).map_err(|_| out_of_memory())?;
        let indptr = matrix.indptr();
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, indptr.raw_storage(), None, matrix.indices());
        let result = faer.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, matrix.data()),
            stored_side(matrix),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        if let Err(LltError::NonPositivePivot { index }) = result {
            return Err(SolverError::NotPositiveDefinite {
                row: symbolic.order()[index],
                n,
            });
        }
        let factor = SparseCholesky { symbolic, values };
        factor.check_pivots(matrix)?;
        Ok(factor)
    }

    /// The analysis and the values of the factor, in the layout of faer's supernodes.
    pub(crate) fn into_parts(self) -> (Symbolic, Vec<f64>) {
        (self.symbolic, self.values)
    }

    /// The analysis this factor was made with.
    pub fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }

    /// Refuses factors whose smallest pivot is round-off.
    fn check_pivots(&self, matrix: &CsMat<f64>) -> Result<(), SolverError> {
        let diagonal: Vec<f64> = matrix
            .diag_iter()
            .map(|value| value.copied().unwrap_or(0.0))
            .collect();
        let mut worst = (f64::INFINITY, 0);
        for (place, root) in self.root_pivots().into_iter().enumerate() {
            let row = self.symbolic.order()[place];
            let ratio = root * root / diagonal[row];
            if ratio.is_nan() {
                return check_pivot(row, self.n(), ratio);
            }
            if ratio < worst.0 {
                worst = (ratio, row);
            }
        }
        check_pivot(worst.1, self.n(), worst.0)
    }

    /// Diagonal of L in elimination order, `[n]`.
    fn root_pivots(&self) -> Vec<f64> {
        let mut roots = Vec::with_capacity(self.n());
        let Some(supernodal) = supernodes(&self.symbolic.shared.faer) else {
            return roots;
        };
        for s in 0..supernodal.n_supernodes() {
            let width = supernodal.supernode_end()[s] - supernodal.supernode_begin()[s];
            let height = width + supernodal.supernode(s).pattern().len();
            let start = supernodal.col_ptr_for_val()[s];
            roots.extend((0..width).map(|column| self.values[start + column * (height + 1)]));
        }
        roots
    }
}

impl LinearSolver for SparseCholesky {
    fn n(&self) -> usize {
        self.symbolic.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        let faer = &self.symbolic.shared.faer;
        let mut memory = MemBuffer::new(faer.solve_in_place_scratch::<f64>(n_rhs, Par::Seq));
        LltRef::new(faer, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, n_rhs),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    fn factor_bytes(&self) -> usize {
        size_of::<f64>() * self.values.capacity()
    }

    fn name(&self) -> &'static str {
        "sparse Cholesky"
    }
}

/// Refuses infinite entries and those that are not a number.
fn check_finite(matrix: &CsMat<f64>) -> Result<(), SolverError> {
    if matrix.data().iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    let bad = matrix.iter().find(|(value, _)| !value.is_finite());
    bad.map_or(Ok(()), |(&value, (row, column))| {
        Err(SolverError::NonFinite { row, column, value })
    })
}
