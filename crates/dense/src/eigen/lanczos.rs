//! The lowest eigenpairs of K x = lambda M x by block Lanczos with shift and invert, full reorthogonalisation and thick
//! restarts.
//!
//! ```text
//! Q = block of random numbers, after one application of A = (K + s M)^-1 M
//! repeat
//!     V = [V, Q];   W = A Q - V H,   H = V^T M A Q        twice, by blocks in M: V stays orthonormal
//!     T = V^T M A V gains the rows and columns H          the projection of A, without use of its band
//!     W = Q' R;   T S = S Theta                           |A (V s) - theta V s|_M = |R s_last|
//!     V full? keep the best Ritz vectors V S and go on with Q'          (thick restart)
//! until the wanted pairs have converged
//! ```
//! The vector space is that of Wu and Simon, SIAM J. Matrix Anal. Appl. 22 (2000) 602, doi:10.1137/S0895479898334605,
//! with blocks.
//!
//! **Multiplicity.** A block of b vectors finds an eigenvalue of multiplicity b; a body of revolution has double
//! ones, a row of equal balls clusters as wide as their number. What a start block misses altogether is looked for:
//! once the pairs have converged, the search goes on from them and a fresh random block in their complement, until
//! the best new pair of the complement is known to a hundredth and none of the wanted has changed. That is a check,
//! no proof: a count of the negative pivots of K - lambda M would need an indefinite factorisation.
//!
//! **Start.** The random numbers are those of a fixed linear congruential generator, so equal problems give equal bits.
//! Everything here is sequential; the problem may use threads.
//!
//! Cost per step: one block solve, four products with M, and 8 n m b operations for m basis vectors. Memory: the
//! basis, 8 n [`LanczosSettings::capacity`] bytes, once more at a restart.

use super::basis::{Basis, OrthonormalBlock};
use super::problem::{EigenProblem, Eigenpairs};
use super::symmetric::symmetric_eigen;
use super::whole::dense_lowest;
use crate::error::DenseError;

/// Problems up to this size are solved by the dense method.
const DENSE_SIZE: usize = 300;
/// Residual of the best pair beyond the wanted ones, over its theta, at which the complement counts as searched.
const CHECKED: f64 = 1e-2;
/// Steps of the search in the complement, at least.
const CHECK_STEPS: usize = 2;

/// What is wanted and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanczosSettings {
    /// Number of pairs, from the lowest.
    pub n_pairs: usize,
    /// Vectors per block: at least the multiplicity expected.
    pub block: usize,
    /// Residual |A x - theta x|_M / theta at which a pair has converged.
    pub tolerance: f64,
    /// Blocks before giving up.
    pub max_steps: usize,
}

impl LanczosSettings {
    /// Settings for `n_pairs` pairs of multiplicity up to `block`.
    pub fn new(n_pairs: usize, block: usize) -> LanczosSettings {
        LanczosSettings {
            n_pairs,
            block,
            tolerance: 1e-8,
            max_steps: 500,
        }
    }

    /// Largest number of basis vectors.
    pub fn capacity(&self) -> usize {
        2 * self.n_pairs + 5 * self.block
    }
}

/// How far a search is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Searched {
    /// Blocks so far.
    pub steps: usize,
    /// Wanted pairs that have converged.
    pub converged: usize,
}

/// The lowest pairs; fewer than wanted when the problem has no more finite ones. `progress` is called after each step.
pub fn lowest_pairs(
    problem: &dyn EigenProblem,
    settings: LanczosSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<Eigenpairs, DenseError> {
    if problem.n() <= DENSE_SIZE.max(2 * settings.capacity()) {
        return dense_lowest(problem, settings.n_pairs);
    }
    lanczos(problem, settings, progress)
}

/// As [`lowest_pairs`], by Lanczos whatever the size.
pub fn lanczos(
    problem: &dyn EigenProblem,
    settings: LanczosSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<Eigenpairs, DenseError> {
    let mut search = Search::new(problem, settings);
    let mut checking = None;
    while search.steps < settings.max_steps {
        let exhausted = search.expand();
        let ritz = search.ritz()?;
        let converged = search.converged(&ritz);
        progress(Searched {
            steps: search.steps,
            converged,
        });
        let all = converged >= settings.n_pairs.min(ritz.thetas.len());
        if exhausted || (all && search.is_checked(&ritz, checking)) {
            return search.finish(&ritz);
        }
        if all && checking.is_none() {
            search.restart(&ritz, settings.n_pairs);
            search.next = search.random_block();
            checking = Some(search.steps);
        } else if search.basis.len() + search.next.width > settings.capacity() {
            search.restart(&ritz, settings.n_pairs + settings.block);
        }
    }
    let ritz = search.ritz()?;
    Err(DenseError::SearchNotConverged {
        wanted: settings.n_pairs,
        converged: search.converged(&ritz),
        steps: search.steps,
    })
}

/// Ritz pairs of the operator, largest theta first.
struct Ritz {
    thetas: Vec<f64>,
    /// Coefficients in the basis, column-major `[m][m]`.
    vectors: Vec<f64>,
    /// |A x - theta x|_M / theta.
    residuals: Vec<f64>,
}

struct Search<'a> {
    problem: &'a dyn EigenProblem,
    settings: LanczosSettings,
    basis: Basis,
    /// V^T M A V, row-major `[m][m]`.
    projected: Vec<f64>,
    /// The block to be appended; its factor couples it to the last columns of the basis.
    next: OrthonormalBlock,
    random: Random,
    steps: usize,
}

impl<'a> Search<'a> {
    fn new(problem: &'a dyn EigenProblem, settings: LanczosSettings) -> Search<'a> {
        let empty = OrthonormalBlock {
            vectors: Vec::new(),
            mass: Vec::new(),
            width: 0,
            factor: Vec::new(),
        };
        let mut search = Search {
            problem,
            settings,
            basis: Basis::new(problem.n()),
            projected: Vec::new(),
            next: empty,
            random: Random(SEED),
            steps: 0,
        };
        search.next = search.random_block();
        search
    }

    /// Appends the next block, projects the operator on it and finds the block after it; true when there is none.
    fn expand(&mut self) -> bool {
        let width = self.next.width;
        self.basis.append(&self.next.vectors);
        let w = self.problem.solve(std::mem::take(&mut self.next.mass), width);
        let (next, columns) = self.basis.orthonormalise(self.problem, w, width);
        self.project(&columns, width);
        self.next = next;
        self.steps += 1;
        if self.next.width < width {
            self.refill(width);
        }
        self.next.width == 0
    }

    /// Adds the last `width` columns V^T M A Q, column-major `[m][width]`, to the projection.
    fn project(&mut self, columns: &[f64], width: usize) {
        let m = self.basis.len();
        let old = m - width;
        let mut projected = vec![0.0; m * m];
        for i in 0..old {
            projected[m * i..m * i + old].copy_from_slice(&self.projected[old * i..old * (i + 1)]);
        }
        for j in 0..width {
            for i in 0..m {
                let mirrored = if i < old {
                    columns[m * j + i]
                } else {
                    0.5 * (columns[m * j + i] + columns[m * (i - old) + old + j])
                };
                projected[m * i + old + j] = mirrored;
                projected[m * (old + j) + i] = mirrored;
            }
        }
        self.projected = projected;
    }

    /// Fills a block that has lost columns, because their part of the space is exhausted, with random ones.
    fn refill(&mut self, width: usize) {
        let lost = width - self.next.width;
        let n_columns = self.next.factor.len().checked_div(self.next.width).unwrap_or(0);
        let m = self.basis.len();
        self.basis.append(&self.next.vectors);
        let fresh = random_in(&self.basis, self.problem, &mut self.random, lost);
        self.basis.truncate(m);
        let (old, new) = (self.next.width, self.next.width + fresh.width);
        let mut factor = vec![0.0; new * n_columns];
        for j in 0..n_columns {
            factor[new * j..new * j + old].copy_from_slice(&self.next.factor[old * j..old * (j + 1)]);
        }
        self.next.vectors.extend(fresh.vectors);
        self.next.mass.extend(fresh.mass);
        self.next.width = new;
        self.next.factor = factor;
    }

    /// A random block orthogonal to the basis.
    fn random_block(&mut self) -> OrthonormalBlock {
        let mut block = random_in(&self.basis, self.problem, &mut self.random, self.settings.block);
        block.factor.clear();
        block
    }

    fn ritz(&self) -> Result<Ritz, DenseError> {
        let m = self.basis.len();
        let (ascending, columns) = symmetric_eigen(m, &self.projected)?;
        let thetas: Vec<f64> = ascending.iter().rev().copied().collect();
        let vectors: Vec<f64> = columns
            .rchunks_exact(m.max(1))
            .flat_map(|column| column.iter().copied())
            .collect();
        let residual = |(theta, s): (&f64, &[f64])| self.outside(s) / theta.abs().max(f64::MIN_POSITIVE);
        let residuals = thetas.iter().zip(vectors.chunks_exact(m.max(1))).map(residual);
        Ok(Ritz {
            residuals: residuals.collect(),
            thetas,
            vectors,
        })
    }

    /// |R s_last|: the part of A V s outside the basis.
    fn outside(&self, s: &[f64]) -> f64 {
        let width = self.next.width;
        let n_columns = self.next.factor.len().checked_div(width).unwrap_or(0);
        let last = &s[s.len() - n_columns..];
        let mut square = 0.0;
        for i in 0..width {
            let sum: f64 = last
                .iter()
                .enumerate()
                .map(|(j, s)| self.next.factor[width * j + i] * s)
                .sum();
            square += sum * sum;
        }
        square.sqrt()
    }

    /// Number of wanted pairs that have converged.
    fn converged(&self, ritz: &Ritz) -> usize {
        let wanted = ritz.residuals.iter().take(self.settings.n_pairs);
        wanted.filter(|r| **r <= self.settings.tolerance).count()
    }

    /// Whether the complement of the wanted pairs has been searched since the step `checking`.
    fn is_checked(&self, ritz: &Ritz, checking: Option<usize>) -> bool {
        let enough = checking.is_some_and(|start| self.steps >= start + CHECK_STEPS);
        enough
            && ritz
                .residuals
                .get(self.settings.n_pairs)
                .is_none_or(|r| *r <= CHECKED)
    }

    /// Keeps the first Ritz vectors as the basis; the next block stays.
    fn restart(&mut self, ritz: &Ritz, keep: usize) {
        let m = self.basis.len();
        let keep = keep.min(m);
        self.basis.replace(&ritz.vectors[..m * keep], keep);
        self.projected = vec![0.0; keep * keep];
        for (i, theta) in ritz.thetas.iter().take(keep).enumerate() {
            self.projected[keep * i + i] = *theta;
        }
    }

    /// The wanted pairs, evaluated with the true matrices.
    fn finish(self, ritz: &Ritz) -> Result<Eigenpairs, DenseError> {
        let m = self.basis.len();
        let positive = ritz.thetas.iter().take(self.settings.n_pairs);
        let kept = positive.take_while(|theta| **theta > 0.0).count();
        let vectors = self.basis.combine(&ritz.vectors[..m * kept], kept);
        // Once more through the operator: what round-off has brought into dofs without mass, which M does not see,
        // goes.
        let vectors = self.problem.solve(self.problem.mass(&vectors, kept), kept);
        let capacity = self.settings.capacity();
        let (steps, problem) = (self.steps, self.problem);
        drop(self);
        let pairs = Eigenpairs::new(problem, vectors)?;
        Ok(Eigenpairs {
            steps,
            basis: capacity,
            ..pairs
        })
    }
}

/// Block of random vectors, smoothed by one application of the operator, orthonormal and orthogonal to `basis`.
fn random_in(
    basis: &Basis,
    problem: &dyn EigenProblem,
    random: &mut Random,
    width: usize,
) -> OrthonormalBlock {
    let n = problem.n();
    let noise: Vec<f64> = (0..n * width).map(|_| random.next()).collect();
    let smooth = problem.solve(problem.mass(&noise, width), width);
    basis.orthonormalise(problem, smooth, width).0
}

/// Any number will do; it is fixed so that equal problems give equal bits.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// Numbers in (-1, 1): Knuth's linear congruential generator with the constants of MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
