//! The factored harmonics of a rotationally periodic ring.

use std::marker::PhantomData;

use pulp::Arch;
use rayon::prelude::*;

use super::assemble::Fill;
use super::kernel::Factorise;
use super::matrix::CyclicMatrix;
use super::number::{Form, Hermitian, Real};
use super::phases::LANES;
use super::ring::{CyclicRing, OrderedCoupling};
use super::sweep::Sweeps;
use crate::error::SolverError;
use crate::linear_solver::LinearSolver;

/// A section is taken for its own mirror image when no entry contradicts it by more than this share of the largest
/// one. Assembled sections of revolved meshes differ by 1e-15 to 1e-13 of it (rounding).
const MIRROR: f64 = 1e-12;

/// Smallest accepted pivot relative to its diagonal entry, as for the sparse factorisation.
pub(super) const PIVOT_LIMIT: f64 = 1e-12;

/// Right-hand sides transformed to harmonic space at a time.
const COLUMNS: usize = 8;

/// Cholesky factors of all harmonics of a [`CyclicMatrix`].
#[derive(Clone, Debug)]
pub struct CyclicCholesky {
    ring: CyclicRing,
    symmetry: Symmetry,
    hold: Restraint,
    /// Groups of this rank, `[n_groups][n_blocks][3][3][parts][LANES]`.
    pub(super) values: Vec<f64>,
}

/// What the harmonics are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// The section is its own mirror image: real symmetric harmonics.
    Mirrored,
    /// Hermitian harmonics: twice the memory, about four times the operations.
    None,
}

impl Symmetry {
    /// Numbers per entry of a factor.
    fn parts(self) -> usize {
        match self {
            Symmetry::Mirrored => 1,
            Symmetry::None => 2,
        }
    }
}

/// What keeps a ring from moving as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Restraint {
    /// Supports or inertia, which are in the matrix.
    Matrix,
    /// Springs added to it, see [`CyclicRing::factor_unheld`].
    Springs,
}

/// Harmonic and component of the springs that hold a ring: (azimuthal, axial) and (radial, axial).
pub(super) const SPRINGS: [(usize, usize); 4] = [(0, 1), (0, 2), (1, 0), (1, 2)];

/// What the factorisation of a group of harmonics tells.
pub(super) struct FactoredGroup {
    /// Every pivot divided by its diagonal entry, `[n][3][LANES]`.
    pub(super) ratios: Vec<f64>,
    /// Stiffness of the springs that were added, in the first group of [`Restraint::Springs`].
    pub(super) springs: [f64; SPRINGS.len()],
}

impl CyclicRing {
    /// Factors a positive definite matrix of this ring's couplings, harmonics in parallel; the bits do not
    /// depend on the number of threads. The error names the caller's row, of sector 0, where elimination breaks down.
    pub fn factor(&self, matrix: &CyclicMatrix) -> Result<CyclicCholesky, SolverError> {
        self.factor_into(matrix, Restraint::Matrix, Vec::new())
    }

    /// Factors the stiffness of a ring that nothing holds, with the least that holds it: springs on the mean axial
    /// and azimuthal motion of one ring of nodes (harmonic 0), and on its radial and axial motion in harmonic 1. They
    /// carry a load's resultants and nothing else. So for loads without resultant force and moment the solution is
    /// one of the ring free in space, exactly; others differ by a rigid motion, which is the caller's to choose.
    pub fn factor_unheld(&self, matrix: &CyclicMatrix) -> Result<CyclicCholesky, SolverError> {
        self.factor_into(matrix, Restraint::Springs, Vec::new())
    }

    /// Factors in memory that may be there already.
    fn factor_into(
        &self,
        matrix: &CyclicMatrix,
        hold: Restraint,
        values: Vec<f64>,
    ) -> Result<CyclicCholesky, SolverError> {
        matrix.check_pattern(&self.shared.pattern)?;
        match self.symmetry(matrix) {
            Symmetry::Mirrored => self.factor_form::<Real>(matrix, Symmetry::Mirrored, hold, values),
            Symmetry::None => self.factor_form::<Hermitian>(matrix, Symmetry::None, hold, values),
        }
    }

    /// Bytes of a factor's values, known before anything is factored: to compare with
    /// [`crate::Symbolic::factor_bytes`].
    pub fn factor_bytes(&self, symmetry: Symmetry) -> usize {
        let group = 9 * symmetry.parts() * LANES * self.shared.rows.n_blocks();
        size_of::<f64>() * group * self.shared.phases.n_groups()
    }

    /// Multiplications and additions of a factorisation but for the section's pivots, to compare with
    /// [`crate::Symbolic::flops`]: few wide sectors can cost more than the ring as a whole.
    pub fn flops(&self, symmetry: Symmetry) -> f64 {
        let per_product = (54 * symmetry.parts() * symmetry.parts()) as f64;
        per_product * self.shared.rows.n_products() as f64 * self.shared.phases.n_harmonics() as f64
    }

    /// What the harmonics of a matrix are: the section is its own mirror image when the block at the angle of a
    /// step and the one at the opposite angle are each other's images, `S C S`, S = diag(1, -1, 1).
    pub fn symmetry(&self, matrix: &CyclicMatrix) -> Symmetry {
        let shared = &self.shared;
        if !shared.may_be_mirrored {
            return Symmetry::None;
        }
        let limit = MIRROR * matrix.largest();
        let period = 2 * self.n_sectors() as i32;
        for link in &shared.links {
            let angle = (-shared.steps[link.step]).rem_euclid(period);
            let image = shared.links.iter_row(link.row).find(|other| {
                other.column == link.column && shared.steps[other.step].rem_euclid(period) == angle
            });
            let block = &matrix.blocks[link.block];
            let zero = [0.0; 9];
            let image = image.map_or(&zero, |other| &matrix.blocks[other.block]);
            let sign = |ij: usize| if (ij / 3 == 1) == (ij % 3 == 1) { 1.0 } else { -1.0 };
            if (0..9).any(|ij| (block[ij] - sign(ij) * image[ij]).abs() > limit) {
                return Symmetry::None;
            }
        }
        Symmetry::Mirrored
    }

    fn factor_form<F: Form>(
        &self,
        matrix: &CyclicMatrix,
        symmetry: Symmetry,
        hold: Restraint,
        mut values: Vec<f64>,
    ) -> Result<CyclicCholesky, SolverError> {
        let group_len = self.factor_len::<F>();
        let own = self.own_groups();
        let len = group_len * own.len();
        values.truncate(len);
        let reserved = values.try_reserve_exact(len - values.len());
        self.agree(reserved.map_err(|_| SolverError::OutOfMemory {
            n: self.n(),
            bytes: size_of::<f64>() * len,
        }))?;
        values.resize(len, 0.0);
        let outcomes: Vec<Result<(), SolverError>> = values
            .par_chunks_mut(group_len.max(1))
            .zip(own)
            .map(|(values, group)| {
                self.check_pivots(&self.factor_group::<F>((matrix, group), hold, values).ratios)
            })
            .collect();
        self.agree(outcomes.into_iter().collect::<Result<(), SolverError>>())?;
        Ok(CyclicCholesky {
            ring: self.clone(),
            symmetry,
            hold,
            values,
        })
    }

    /// Numbers of the factor of a group.
    pub(super) fn factor_len<F: Form>(&self) -> usize {
        9 * F::PARTS * LANES * self.shared.rows.n_blocks()
    }

    /// Factors a group of harmonics in `values`, whatever was there.
    pub(super) fn factor_group<F: Form>(
        &self,
        (matrix, group): (&CyclicMatrix, usize),
        hold: Restraint,
        values: &mut [f64],
    ) -> FactoredGroup {
        let (shared, arch) = (&self.shared, Arch::new());
        arch.dispatch(Fill::<F> {
            shared,
            matrix,
            group,
            values,
            form: PhantomData,
        });
        let springs = match hold {
            Restraint::Springs if group == 0 => self.add_springs::<F>(values),
            _ => [0.0; SPRINGS.len()],
        };
        let mut ratios = vec![0.0; 3 * LANES * self.n_section_nodes()];
        arch.dispatch(Factorise::<F> {
            rows: &shared.rows,
            values,
            ratios: &mut ratios,
            form: PhantomData,
        });
        FactoredGroup { ratios, springs }
    }

    /// A failure of one rank is one of all.
    #[track_caller]
    pub(super) fn agree<T>(&self, result: Result<T, SolverError>) -> Result<T, SolverError> {
        self.comm
            .agree(result, |rank, message| SolverError::OnRank { rank, message })
    }

    /// Doubles the diagonal entries of the node eliminated last that hold the ring, [`SPRINGS`]. What it adds.
    fn add_springs<F: Form>(&self, values: &mut [f64]) -> [f64; SPRINGS.len()] {
        let rows = &self.shared.rows;
        let Some(last) = rows.n().checked_sub(1) else {
            return [0.0; SPRINGS.len()];
        };
        let block = &mut values[rows.place(last, last) * 9 * F::PARTS * LANES..];
        SPRINGS.map(|(harmonic, component)| {
            let entry = &mut block[4 * component * F::PARTS * LANES + harmonic];
            let stiffness = *entry;
            *entry *= 2.0;
            stiffness
        })
    }

    /// Refuses pivots that are not positive or nothing but round-off.
    fn check_pivots(&self, ratios: &[f64]) -> Result<(), SolverError> {
        let n = self.n();
        let mut worst = (f64::INFINITY, 0);
        for (dof, lanes) in ratios.chunks_exact(LANES).enumerate() {
            for &ratio in lanes {
                // Written so that NaN is refused as well.
                if ratio.is_nan() || ratio <= 0.0 {
                    let row = self.row(dof / 3, dof % 3);
                    return Err(SolverError::NotPositiveDefinite { row, n });
                }
                if ratio < worst.0 {
                    worst = (ratio, dof);
                }
            }
        }
        let (relative_pivot, dof) = worst;
        if relative_pivot < PIVOT_LIMIT {
            return Err(SolverError::Singular {
                row: self.row(dof / 3, dof % 3),
                n,
                relative_pivot,
                limit: PIVOT_LIMIT,
            });
        }
        Ok(())
    }
}

/// The links of a row.
trait RowLinks {
    fn iter_row(&self, row: usize) -> impl Iterator<Item = &OrderedCoupling>;
}

impl RowLinks for Vec<OrderedCoupling> {
    fn iter_row(&self, row: usize) -> impl Iterator<Item = &OrderedCoupling> {
        let first = self.partition_point(|link| link.row < row);
        self[first..].iter().take_while(move |link| link.row == row)
    }
}

impl CyclicCholesky {
    /// The factor of another matrix of the same ring, such as that of another step size, in this one's memory.
    pub fn refactored(self, matrix: &CyclicMatrix) -> Result<CyclicCholesky, SolverError> {
        let CyclicCholesky {
            ring, hold, values, ..
        } = self;
        ring.factor_into(matrix, hold, values)
    }

    /// The same factor for vectors that hold some of the caller's nodes alone, see [`CyclicRing::seen_at`].
    pub fn seen_at(self, nodes: &[Option<usize>]) -> CyclicCholesky {
        CyclicCholesky {
            ring: self.ring.seen_at(nodes),
            ..self
        }
    }

    /// The ring.
    pub fn ring(&self) -> &CyclicRing {
        &self.ring
    }

    /// What the harmonics are.
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// Replaces right-hand sides in harmonic space, `[harmonic_len()]` each, by the solutions; harmonics in parallel.
    ///
    /// # Panics
    /// When a column has another length.
    pub fn solve_harmonic(&self, columns: &mut [&mut [f64]]) {
        self.sweep_harmonic(columns, |_| Sweeps::Whole);
    }

    /// The sweeps `of_group` in each group of this rank.
    pub(super) fn sweep_harmonic(
        &self,
        columns: &mut [&mut [f64]],
        of_group: impl Fn(usize) -> Sweeps + Sync,
    ) {
        for column in columns.iter() {
            assert_eq!(
                column.len(),
                self.ring.harmonic_len(),
                "a vector in harmonic space"
            );
        }
        if columns.is_empty() || self.n() == 0 {
            return;
        }
        let (group_len, own) = (self.ring.group_len(), self.ring.own_groups());
        let mut groups: Vec<Vec<&mut [f64]>> =
            own.clone().map(|_| Vec::with_capacity(columns.len())).collect();
        for column in columns.iter_mut() {
            let parts = column.chunks_exact_mut(group_len);
            groups
                .iter_mut()
                .zip(parts)
                .for_each(|(group, part)| group.push(part));
        }
        groups
            .into_par_iter()
            .zip(own)
            .for_each(|(columns, group)| self.sweep(group, columns, of_group(group)));
    }

    /// Solves one right-hand side for the first group of harmonics alone; collective.
    pub(super) fn solve_first_group(&self, low: &mut [f64]) {
        if self.ring.has_first_group() {
            self.solve_one(0, low);
        }
        self.ring.share_first(low);
    }
}

impl LinearSolver for CyclicCholesky {
    fn n(&self) -> usize {
        self.ring.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        let mut harmonic = vec![vec![0.0; self.ring.harmonic_len()]; n_rhs.min(COLUMNS)];
        for block in rhs.chunks_mut(n * COLUMNS) {
            let used = &mut harmonic[..block.len() / n];
            for (nodal, w) in block.chunks_exact(n).zip(&mut *used) {
                self.ring.to_harmonic(nodal, w);
            }
            self.solve_harmonic(&mut used.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>());
            for (nodal, w) in block.chunks_exact_mut(n).zip(&*used) {
                self.ring.from_harmonic(w, nodal);
            }
        }
    }

    fn factor_bytes(&self) -> usize {
        size_of::<f64>() * self.values.capacity()
    }

    fn name(&self) -> &'static str {
        "cyclic Cholesky"
    }
}
