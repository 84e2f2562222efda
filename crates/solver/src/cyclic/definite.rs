//! Whether a matrix of a periodic ring is positive definite, harmonic by harmonic: an elimination that keeps no factor.
//!
//! All eigenvalues of K x = lambda M x are larger than s exactly when K - s M is positive definite (Sylvester's law of
//! inertia; Parlett, *The Symmetric Eigenvalue Problem*, 1998, section 3.3). So one elimination proves a lower bound of
//! the lowest eigenvalue, of whatever multiplicity, where an iteration for its vector can miss it.
//!
//! **Held by functionals.** Of a ring that moves with B u = 0 only, the matrix A needs to be positive definite on these
//! u alone; with its rigid motions it is indefinite. Springs E k E^T on one ring of nodes
//! ([`CyclicRing::factor_unheld`]) make T = A + E k E^T, which has a Cholesky factor, and
//!
//! ```text
//! A > 0 where B u = 0   <=>   1/k - E^T Q E > 0,      Q = T^-1 - T^-1 B^T (B T^-1 B^T)^-1 B T^-1
//! ```
//!
//! Q is the compliance of T with B u = 0: without its springs the ring still stands. It follows from the inertia of
//! `[T B^T E; B 0 0; E^T 0 1/k]`, eliminated from either end (Haynsworth, Linear Algebra and its Applications 1, 1968,
//! 73-81). B and E are in the first group of harmonics. Where T itself is not positive definite in harmonics 0 and 1,
//! the answer is not known.
//!
//! **Round-off** moves eigenvalues by some 1e-16 of the largest one, per row of a section: a hundredth from s is far.
//!
//! Cost: that of a factorisation, and 12 solves of the first group; memory of one group for each thread.

use dense::{DenseCholesky, inverse_form};
use rayon::prelude::*;

use super::factor::{FactoredGroup, PIVOT_LIMIT, Restraint, SPRINGS, Symmetry};
use super::matrix::CyclicMatrix;
use super::number::{Form, Hermitian, Real};
use super::phases::{LANES, NODE_LEN};
use super::ring::CyclicRing;
use super::sweep::Sweeps;
use crate::error::SolverError;
use crate::linear_solver::SparseVector;

/// Whether a matrix is positive definite. In the order of the weights of answers: one No decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Definite {
    /// It is not.
    No,
    /// It may be.
    Unknown,
    /// It is.
    Yes,
}

/// A ring whose matrices are tried, without what the functionals move that hold it.
pub struct DefiniteTest<'a> {
    ring: &'a CyclicRing,
    /// First group of harmonics of the functionals, `[m][group]`.
    held: Vec<f64>,
}

impl<'a> DefiniteTest<'a> {
    /// A ring that is held by its matrix, or by nodal functionals, six of which a rigid motion moves.
    pub fn new(ring: &'a CyclicRing, held: &[SparseVector]) -> Result<DefiniteTest<'a>, SolverError> {
        let n = ring.n();
        let mut columns = vec![0.0; n * held.len()];
        for (column, functional) in columns.chunks_exact_mut(n.max(1)).zip(held) {
            functional.iter().for_each(|&(row, value)| column[row] += value);
        }
        let held = ring.first_group(&columns)?;
        Ok(DefiniteTest { ring, held })
    }

    /// Whether a matrix of the ring's couplings is positive definite; collective when ranks share the ring. The answer
    /// does not depend on the number of threads or ranks.
    pub fn of(&self, matrix: &CyclicMatrix) -> Result<Definite, SolverError> {
        matrix.check_pattern(&self.ring.shared.pattern)?;
        let own = match self.ring.symmetry(matrix) {
            Symmetry::Mirrored => self.of_form::<Real>(matrix),
            Symmetry::None => self.of_form::<Hermitian>(matrix),
        };
        let comm = self.ring.comm;
        // Words and not numbers: no rank takes another's way by a number that is spoiled.
        let is_given = |answer: Definite| {
            let word = (own == answer).then(|| format!("{answer:?}"));
            comm.first_text(word).is_some()
        };
        let others = [Definite::No, Definite::Unknown];
        Ok(others
            .into_iter()
            .find(|&answer| is_given(answer))
            .unwrap_or(Definite::Yes))
    }

    /// The answer of the groups of this rank.
    fn of_form<F: Form>(&self, matrix: &CyclicMatrix) -> Definite {
        let ring = self.ring;
        let hold = match self.held.is_empty() {
            true => Restraint::Matrix,
            false => Restraint::Springs,
        };
        let values = || vec![0.0; ring.factor_len::<F>()];
        let answers = ring
            .own_groups()
            .into_par_iter()
            .map_init(values, |values, group| {
                let factored = ring.factor_group::<F>((matrix, group), hold, values);
                let is_positive = positive_lanes::<F>(ring, values, &factored);
                match (group, hold) {
                    (0, Restraint::Springs) => self.of_first_group::<F>(values, &factored, is_positive),
                    _ if is_positive == [true; LANES] => Definite::Yes,
                    _ => Definite::No,
                }
            });
        answers.min().unwrap_or(Definite::Yes)
    }

    /// The answer of the first group, whose springs go.
    fn of_first_group<F: Form>(
        &self,
        factor: &[f64],
        factored: &FactoredGroup,
        is_positive: [bool; LANES],
    ) -> Definite {
        match is_positive {
            [true, true, true, true] => {}
            [_, _, true, true] => return Definite::Unknown,
            _ => return Definite::No,
        }
        let (ring, len) = (self.ring, self.ring.group_len());
        let springs = springs(ring, factored);
        let loads: Vec<f64> = springs
            .iter()
            .flat_map(|spring| &spring.functional)
            .copied()
            .collect();
        let loads = [loads, self.held.clone()].concat();
        let mut moved = loads.clone();
        ring.sweep_group::<F>(factor, moved.chunks_exact_mut(len).collect(), Sweeps::Whole);
        let work = |i: usize, j: usize| ring.group_dot(0, &loads[len * i..][..len], &moved[len * j..][..len]);
        let (n, m) = (springs.len(), self.held.len() / len);
        let block = |rows: usize, first: [usize; 2], columns: usize| -> Vec<f64> {
            let row = |i: usize| (0..columns).map(move |j| work(first[0] + i, first[1] + j));
            (0..rows).flat_map(row).collect()
        };
        let of_held = block(m, [n, n], m);
        let Ok(without_held) = inverse_form(m, n, &of_held, &block(m, [n, 0], n)) else {
            return Definite::Unknown;
        };
        // Rows over the spring's stiffness: numbers of the order of one.
        let mut left: Vec<f64> = block(n, [0, 0], n);
        left.iter_mut()
            .zip(without_held)
            .for_each(|(q, held)| *q = held - *q);
        for (i, a) in springs.iter().enumerate() {
            for (j, b) in springs.iter().enumerate() {
                left[n * i + j] *= (a.stiffness * b.stiffness).sqrt();
            }
            left[n * i + i] += 1.0;
        }
        match DenseCholesky::factor(n, &left) {
            Ok(_) => Definite::Yes,
            Err(_) => Definite::No,
        }
    }
}

/// A spring on a harmonic's amplitude.
struct Spring {
    /// The amplitude as a functional of the first group.
    functional: Vec<f64>,
    /// N/m.
    stiffness: f64,
}

/// The springs on a ring that nothing holds: one on each amplitude of harmonic 0, which is real, two in harmonic 1.
fn springs(ring: &CyclicRing, factored: &FactoredGroup) -> Vec<Spring> {
    let last = NODE_LEN * (ring.n_section_nodes() - 1);
    let mut springs = Vec::with_capacity(6);
    for ((harmonic, component), stiffness) in SPRINGS.into_iter().zip(factored.springs) {
        // The azimuthal component has the factor -i.
        let parts = match (harmonic, component) {
            (0, 1) => 1..2,
            (0, _) => 0..1,
            _ => 0..2,
        };
        for part in parts {
            let mut functional = vec![0.0; ring.group_len()];
            let place = last + LANES * (2 * component + part) + harmonic;
            functional[place] = 1.0;
            let weight = ring.group_dot(0, &functional, &functional);
            functional[place] = 1.0 / weight;
            springs.push(Spring {
                functional,
                stiffness: stiffness * weight,
            });
        }
    }
    springs
}

/// Whether all pivots of each harmonic of a group are positive.
fn positive_lanes<F: Form>(ring: &CyclicRing, factor: &[f64], factored: &FactoredGroup) -> [bool; LANES] {
    let (rows, len) = (&ring.shared.rows, 9 * F::PARTS * LANES);
    let mut is_positive = [true; LANES];
    for (i, ratios) in factored.ratios.chunks_exact(3 * LANES).enumerate() {
        let block = &factor[rows.place(i, i) * len..][..len];
        for (component, ratios) in ratios.chunks_exact(LANES).enumerate() {
            // The diagonal holds inverse roots: no number where the pivot is negative, its diagonal entry as well.
            let roots = &block[4 * component * F::PARTS * LANES..][..LANES];
            for ((is_positive, ratio), root) in is_positive.iter_mut().zip(ratios).zip(roots) {
                *is_positive &= *ratio >= PIVOT_LIMIT && root.is_finite();
            }
        }
    }
    is_positive
}
