//! A periodic ring whose held nodes follow a rigid partner: a border that touches the lowest harmonics only.
//!
//! Rigid translations and tilts of a ring of nodes are harmonics 0 and 1. So the columns of the border, and A^-1 times
//! them, are zero beyond the first group of harmonics, and the border costs next to nothing: the block elimination of
//! [`crate::bordered`], in harmonic space.

use dense::DenseCholesky;

use super::factor::CyclicCholesky;
use super::ring::CyclicRing;
use crate::bordered::factor_complement;
use crate::error::SolverError;
use crate::linear_solver::LinearSolver;

/// Largest share of a border's column beyond the first group: rounding of transforms and of coordinates.
const BEYOND: f64 = 1e-9;

/// Factor of `[A B; B^T D]` with a cyclic A; the rows of the border come last.
#[derive(Clone, Debug)]
pub struct CyclicBordered {
    factor: CyclicCholesky,
    /// First group of the harmonics of A^-1 B, `[m][group]`.
    columns: Vec<f64>,
    schur: DenseCholesky,
}

impl CyclicBordered {
    /// Borders the matrix of `factor` with B, nodal, column-major `[n][m]`, and the symmetric D, row-major `[m][m]`, of
    /// which the lower triangle counts. Columns that reach beyond the first group of harmonics are an error, see
    /// [`crate::Bordered`] for those.
    ///
    /// # Panics
    /// When the sizes disagree.
    pub fn new(
        factor: CyclicCholesky,
        border: &[f64],
        m: usize,
        corner: &[f64],
    ) -> Result<CyclicBordered, SolverError> {
        let (n, ring) = (factor.n(), factor.ring().clone());
        assert_eq!(border.len(), n * m, "a border of {m} columns of {n} rows");
        assert_eq!(corner.len(), m * m, "a corner of {m} rows");
        let group_len = ring.group_len();
        let rows = ring.first_group(border)?;
        let mut columns = rows.clone();
        columns
            .chunks_exact_mut(group_len.max(1))
            .for_each(|column| factor.solve_first_group(column));
        let mut complement = corner.to_vec();
        for i in 0..m {
            for j in 0..=i {
                let (b, z) = (&rows[group_len * i..], &columns[group_len * j..]);
                complement[m * i + j] -= ring.group_dot(0, &b[..group_len], &z[..group_len]);
            }
        }
        Ok(CyclicBordered {
            schur: ring.agree(factor_complement(n, &complement, corner))?,
            factor,
            columns,
        })
    }

    /// The same factor for vectors that hold some of the caller's nodes alone, see [`super::CyclicRing::seen_at`].
    pub fn seen_at(self, nodes: &[Option<usize>]) -> CyclicBordered {
        CyclicBordered {
            factor: self.factor.seen_at(nodes),
            ..self
        }
    }

    /// The factor inside.
    pub fn inner(&self) -> &CyclicCholesky {
        &self.factor
    }

    /// Replaces right-hand sides by solutions: `columns` in harmonic space, `[harmonic_len()]` each, and the rows of
    /// the border `border`, `[columns.len()][m]`. Collective where there is a border.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn solve_harmonic(&self, columns: &mut [&mut [f64]], border: &mut [f64]) {
        self.with_border(columns, border, |columns| self.factor.solve_harmonic(columns));
    }

    /// The border before and after the solves `solve` of the harmonics, the first group in full.
    pub(super) fn with_border(
        &self,
        columns: &mut [&mut [f64]],
        border: &mut [f64],
        solve: impl FnOnce(&mut [&mut [f64]]),
    ) {
        let m = self.schur.n();
        assert_eq!(border.len(), m * columns.len(), "{m} rows of border per column");
        let (low, has_first) = (self.factor.ring().low_len(), self.factor.ring().has_first_group());
        let n_first = if has_first { columns.len() } else { 0 };
        for (w, q) in columns[..n_first].iter().zip(border.chunks_exact_mut(m.max(1))) {
            self.reduce_border(&w[..low], q);
        }
        self.factor.ring().share_first(border);
        solve(columns);
        for (w, q) in columns[..n_first].iter_mut().zip(border.chunks_exact(m.max(1))) {
            self.follow_border(q, &mut w[..low]);
        }
    }

    /// Replaces one group's part of a right-hand side, `[low_len()]`, and in the first group the rows of the border,
    /// by the solution, for passes over the groups while they are in the cache: the bits of
    /// [`CyclicBordered::solve_harmonic`].
    ///
    /// # Panics
    /// When a length is another, or the group is another rank's.
    pub fn solve_group(&self, group: usize, low: &mut [f64], border: &mut [f64]) {
        let m = if group == 0 { self.schur.n() } else { 0 };
        assert_eq!(border.len(), m, "the border goes with the first group");
        if m > 0 {
            self.reduce_border(low, border);
        }
        self.factor.solve_one(group, low);
        if m > 0 {
            self.follow_border(border, low);
        }
    }

    /// The rows q of the border of a solution, from those of the right-hand side and its first group.
    fn reduce_border(&self, low: &[f64], q: &mut [f64]) {
        for (q, z) in q.iter_mut().zip(self.columns.chunks_exact(low.len().max(1))) {
            *q -= self.factor.ring().group_dot(0, z, low);
        }
        self.schur.solve(q, 1);
    }

    /// What the rows q of the border do to the first group of a solution.
    fn follow_border(&self, q: &[f64], low: &mut [f64]) {
        for (q, z) in q.iter().zip(self.columns.chunks_exact(low.len().max(1))) {
            low.iter_mut().zip(z).for_each(|(w, z)| *w -= q * z);
        }
    }
}

impl CyclicRing {
    /// First group of the harmonics of nodal columns, column-major `[n][m]`, that reach no further: `[m][group]`.
    pub(super) fn first_group(&self, nodal: &[f64]) -> Result<Vec<f64>, SolverError> {
        let (n, group_len) = (self.n(), self.group_len());
        let mut rows = Vec::with_capacity(group_len * nodal.len().checked_div(n).unwrap_or(0));
        let (alone, mut harmonic) = (self.alone(), vec![0.0; self.whole_len()]);
        for (column, nodal) in nodal.chunks_exact(n.max(1)).enumerate() {
            alone.to_harmonic(nodal, &mut harmonic);
            let (low, high) = harmonic.split_at(group_len);
            let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let share = largest(high) / largest(low).max(f64::MIN_POSITIVE);
            // Written so that NaN is refused as well.
            let is_low = share <= BEYOND && low.iter().all(|x| x.is_finite());
            if !is_low {
                return Err(SolverError::BorderBeyond { column, share });
            }
            rows.extend_from_slice(low);
        }
        Ok(rows)
    }
}

impl LinearSolver for CyclicBordered {
    fn n(&self) -> usize {
        self.factor.n() + self.schur.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let (n, m, ring) = (self.factor.n(), self.schur.n(), self.factor.ring());
        assert_eq!(
            rhs.len(),
            (n + m) * n_rhs,
            "{n_rhs} right-hand sides of {} rows",
            n + m
        );
        let mut harmonic = vec![0.0; ring.harmonic_len()];
        for column in rhs.chunks_exact_mut((n + m).max(1)) {
            let (nodal, border) = column.split_at_mut(n);
            ring.to_harmonic(nodal, &mut harmonic);
            self.solve_harmonic(&mut [&mut harmonic], border);
            ring.from_harmonic(&harmonic, nodal);
        }
    }

    fn factor_bytes(&self) -> usize {
        self.factor.factor_bytes() + self.schur.factor_bytes() + size_of::<f64>() * self.columns.capacity()
    }

    fn name(&self) -> &'static str {
        self.factor.name()
    }
}
