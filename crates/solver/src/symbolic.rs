//! Symbolic analysis: where the factor's entries are and what it will cost, before any number is touched.

use std::sync::Arc;

use faer::dyn_stack::StackReq;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use faer::{Par, Side};
use sprs::CsMat;

use crate::elimination_tree::postordered;
use crate::error::SolverError;
use crate::permutation::invert;

/// Adjacent supernodes are merged when the first number bounds their columns and the second their fraction of zeros.
/// Rings have three degrees of freedom per node, so narrow supernodes are merged more eagerly than faer does by
/// default: 2-7 % more bytes, 4-18 % less time to factor (best of 5, loaded 2-core Xeon; hex8, tet10, hex20 of 34-90
/// k dof).
const RELAX: &[(usize, f64)] = &[(12, 1.0), (36, 0.5), (96, 0.2), (usize::MAX, 0.05)];

/// Analysis of one sparsity pattern and one elimination order. Any number of matrices of that pattern, such as those
/// of several step sizes, are factored with it; clones share it.
#[derive(Clone, Debug)]
pub struct Symbolic {
    pub(crate) shared: Arc<PatternAnalysis>,
}

/// What the clones share.
#[derive(Debug)]
pub(crate) struct PatternAnalysis {
    pub(crate) faer: SymbolicCholesky<usize>,
    /// `order[k]` is the caller's row eliminated in place k, postordered.
    pub(crate) order: Vec<usize>,
    /// Fingerprint of the pattern analysed.
    pub(crate) pattern: PatternFingerprint,
    flops: f64,
}

/// Identifies a sparsity pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PatternFingerprint {
    pub(crate) n_entries: usize,
    hash: u64,
    by_columns: bool,
}

impl Symbolic {
    /// Analyses the pattern of a symmetric matrix, given whole or by its lower triangle, for the elimination order
    /// `order` (`order[k]` is the row eliminated in place k, `[n]`; see [`crate::angular_dissection`]). The order is
    /// postordered first, which changes neither fill nor flops. Time O(n_entries + n_supernodal_indices).
    pub fn new(matrix: &CsMat<f64>, order: &[usize]) -> Result<Self, SolverError> {
        Symbolic::with_tail(matrix, order, 0)
    }

    /// The same with the last `n_tail` rows of `order` kept last, in any order among themselves. A postorder may put
    /// columns that do not depend on them behind them; moving these forward again changes no entry of the factor.
    pub(crate) fn with_tail(
        matrix: &CsMat<f64>,
        order: &[usize],
        n_tail: usize,
    ) -> Result<Self, SolverError> {
        let n = square_size(matrix)?;
        let inverse = invert(order, n)?;
        let (head, tail): (Vec<usize>, Vec<usize>) = postordered(matrix, order, &inverse)
            .into_iter()
            .partition(|&row| inverse[row] < n - n_tail);
        let order = [head, tail].concat();
        let inverse = invert(&order, n)?;
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            supernodal_params: SymbolicSupernodalParams { relax: Some(RELAX) },
            ..Default::default()
        };
        let indptr = matrix.indptr();
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, indptr.raw_storage(), None, matrix.indices());
        let faer = factorize_symbolic_cholesky(
            pattern,
            stored_side(matrix),
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &inverse, n)),
            params,
        )
        .map_err(|_| SolverError::OutOfMemory {
            n,
            bytes: 8 * matrix.nnz(),
        })?;
        let flops = supernodes(&faer).map_or(0.0, count_flops);
        let pattern = PatternFingerprint::of(matrix);
        Ok(Symbolic {
            shared: Arc::new(PatternAnalysis {
                faer,
                order,
                pattern,
                flops,
            }),
        })
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.shared.order.len()
    }

    /// Elimination order after postordering, `[n]`.
    pub fn order(&self) -> &[usize] {
        &self.shared.order
    }

    /// Bytes of the factor's values: what [`crate::LinearSolver::factor_bytes`] will say. A solve reads them twice.
    /// Includes the upper corners and the zeros of merged supernodes, 15-25 % of nnz(L) at 60-90 k dof.
    pub fn factor_bytes(&self) -> usize {
        size_of::<f64>() * self.shared.faer.len_val()
    }

    /// Multiplications and additions of a numeric factorisation, the sum over columns of their squared lengths.
    pub fn flops(&self) -> f64 {
        self.shared.flops
    }

    /// Number of stored entries of the matrix analysed.
    pub fn n_entries(&self) -> usize {
        self.shared.pattern.n_entries
    }

    /// Bytes of this analysis, which a factor keeps: the row indices of all supernodes, once by columns and once by
    /// rows at most, and eight arrays of n.
    pub fn bytes(&self) -> usize {
        let n_indices = supernodes(&self.shared.faer).map_or(0, |supernodal| {
            (0..supernodal.n_supernodes())
                .map(|s| supernodal.supernode(s).pattern().len())
                .sum()
        });
        size_of::<usize>() * (2 * n_indices + 8 * self.n())
    }

    /// Bytes allocated at the peak of [`Self::factor`]: factor, permuted copy of the matrix and work space. The
    /// caller's matrix and this analysis are not in it.
    pub fn peak_bytes(&self) -> usize {
        self.factor_bytes() + self.factor_scratch().unaligned_bytes_required()
    }

    /// Fails unless a matrix has the analysed pattern.
    pub(crate) fn require_pattern(&self, matrix: &CsMat<f64>) -> Result<(), SolverError> {
        square_size(matrix)?;
        if PatternFingerprint::of(matrix) != self.shared.pattern {
            let expected = self.shared.pattern.n_entries;
            return Err(SolverError::PatternChanged {
                found: matrix.nnz(),
                expected,
            });
        }
        Ok(())
    }

    pub(crate) fn factor_scratch(&self) -> StackReq {
        self.shared
            .faer
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
    }
}

impl PatternFingerprint {
    fn of(matrix: &CsMat<f64>) -> Self {
        // FNV-1a on whole words: a different matrix of equal size must not slip through, malice is not expected.
        let indptr = matrix.indptr();
        let words = indptr.raw_storage().iter().chain(matrix.indices());
        let hash = words.fold(0xcbf2_9ce4_8422_2325, |hash: u64, &word| {
            (hash ^ word as u64)
                .wrapping_mul(0x0000_0100_0000_01b3)
                .rotate_left(23)
        });
        PatternFingerprint {
            n_entries: matrix.nnz(),
            hash,
            by_columns: matrix.is_csc(),
        }
    }
}

/// Number of rows of a square matrix.
fn square_size(matrix: &CsMat<f64>) -> Result<usize, SolverError> {
    let (rows, columns) = matrix.shape();
    if rows != columns {
        return Err(SolverError::NotSquare { rows, columns });
    }
    Ok(rows)
}

/// Triangle that holds the matrix's lower triangle once its storage is read as compressed columns.
pub(crate) fn stored_side(matrix: &CsMat<f64>) -> Side {
    if matrix.is_csc() { Side::Lower } else { Side::Upper }
}

/// Supernodal structure, which is what the analysis was asked for.
pub(crate) fn supernodes(faer: &SymbolicCholesky<usize>) -> Option<&SymbolicSupernodalCholesky<usize>> {
    match faer.raw() {
        SymbolicCholeskyRaw::Supernodal(supernodal) => Some(supernodal),
        SymbolicCholeskyRaw::Simplicial(_) => None,
    }
}

fn count_flops(supernodal: &SymbolicSupernodalCholesky<usize>) -> f64 {
    let mut flops = 0.0;
    for s in 0..supernodal.n_supernodes() {
        let width = supernodal.supernode_end()[s] - supernodal.supernode_begin()[s];
        let below = supernodal.supernode(s).pattern().len();
        flops += (1..=width).map(|k| ((k + below) as f64).powi(2)).sum::<f64>();
    }
    flops
}
