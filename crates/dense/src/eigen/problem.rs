//! The eigenproblem K x = lambda M x of free vibration, its lowest pairs, and how good they are.
//!
//! K and M are symmetric and positive semi-definite, and K + s M is positive definite for the shift s > 0: rigid
//! motions (K x = 0) and dofs without mass (M x = 0) are both allowed. Pairs are sought through the operator A = (K +
//! s M)^-1 M, which is self-adjoint in the inner product of M and has the eigenvalues theta = 1/(lambda + s): the
//! lowest lambda are its largest, well separated ones (Ericsson and Ruhe, Math. Comp. 35 (1980) 1251,
//! doi:10.1090/S0025-5718-1980-0583502-2). Dofs without mass follow the others; their infinite lambda do not appear.
//!
//! Linear constraints are the problem's own business: its solve then stays in the space of the constraints, and
//! [`EigenProblem::remove_reactions`] takes their forces out of a residual.
//!
//! **Bound.** With r = K x - lambda M x, A x - theta x = -theta (K + s M)^-1 r. A is self-adjoint, so an eigenvalue
//! theta* has
//! |theta* - theta| <= theta eta with eta = |(K + s M)^-1 r|_M / |x|_M, and with it
//! |lambda* - lambda| <= (lambda + s) eta/(1 - eta) (Parlett, *The Symmetric Eigenvalue Problem*, 1998, theorem
//! 4.5.1). It counts round-off of K x as far as it matters, while the plain |r| is full of the highest frequencies.

use crate::error::DenseError;

/// A symmetric eigenproblem with a factorisation of K + s M. Blocks of vectors are column-major `[n][n_vectors]`.
pub trait EigenProblem {
    /// Number of unknowns.
    fn n(&self) -> usize;

    /// The shift s, in the unit of lambda.
    fn shift(&self) -> f64;

    /// K X.
    fn stiffness(&self, x: &[f64], n_vectors: usize) -> Vec<f64>;

    /// M X.
    fn mass(&self, x: &[f64], n_vectors: usize) -> Vec<f64>;

    /// (K + s M)^-1 B.
    fn solve(&self, b: Vec<f64>, n_vectors: usize) -> Vec<f64>;

    /// Takes the forces that hold the constraints out of a vector of forces.
    fn remove_reactions(&self, _force: &mut [f64]) {}
}

/// Lowest eigenpairs, ascending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Eigenpairs {
    /// Eigenvalues lambda, `[n_pairs]`; those of rigid motions are zero up to round-off, of either sign.
    pub values: Vec<f64>,
    /// Eigenvectors, x^T M x = 1, column-major `[n][n_pairs]`.
    pub vectors: Vec<f64>,
    /// Largest possible error of each eigenvalue, `[n_pairs]`: see the module.
    pub bounds: Vec<f64>,
    /// |K x - lambda M x| / |(K + s M) x| without the forces of constraints, `[n_pairs]`.
    pub residuals: Vec<f64>,
    /// Blocks the operator was applied to; 0 by the dense method.
    pub steps: usize,
    /// Dimension of the largest basis; n by the dense method.
    pub basis: usize,
}

impl Eigenpairs {
    /// Pairs from vectors that are eigenvectors to working precision: Rayleigh quotients, residuals and bounds, in
    /// ascending order. `vectors` is column-major `[n][n_pairs]`.
    pub(crate) fn new(problem: &dyn EigenProblem, mut vectors: Vec<f64>) -> Result<Eigenpairs, DenseError> {
        let n = problem.n();
        let n_pairs = vectors.len().checked_div(n).unwrap_or(0);
        let mass = problem.mass(&vectors, n_pairs);
        for (x, mx) in vectors.chunks_exact_mut(n).zip(mass.chunks_exact(n)) {
            let scale = dot(x, mx).sqrt().recip();
            x.iter_mut().for_each(|value| *value *= scale);
        }
        let (mass, stiffness) = (
            problem.mass(&vectors, n_pairs),
            problem.stiffness(&vectors, n_pairs),
        );
        let (mut values, mut residuals) = (Vec::new(), Vec::new());
        let mut errors = Vec::with_capacity(vectors.len());
        for ((x, mx), kx) in vectors
            .chunks_exact(n)
            .zip(mass.chunks_exact(n))
            .zip(stiffness.chunks_exact(n))
        {
            let value = dot(x, kx);
            let combine = |c: f64| kx.iter().zip(mx).map(|(k, m)| k + c * m).collect::<Vec<f64>>();
            let (mut residual, mut whole) = (combine(-value), combine(problem.shift()));
            problem.remove_reactions(&mut residual);
            problem.remove_reactions(&mut whole);
            residuals.push((dot(&residual, &residual) / dot(&whole, &whole)).sqrt());
            values.push(value);
            errors.extend(residual);
        }
        let errors = problem.solve(errors, n_pairs);
        let mass_errors = problem.mass(&errors, n_pairs);
        let bounds = errors.chunks_exact(n).zip(mass_errors.chunks_exact(n));
        let bounds: Vec<f64> = bounds
            .zip(&values)
            .map(|((e, me), value)| {
                let eta = dot(e, me).max(0.0).sqrt();
                (value + problem.shift()) * eta / (1.0 - eta.min(0.5))
            })
            .collect();
        Eigenpairs {
            values,
            vectors,
            bounds,
            residuals,
            steps: 0,
            basis: n,
        }
        .sorted(n)
    }

    fn sorted(self, n: usize) -> Result<Eigenpairs, DenseError> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|&a, &b| self.values[a].total_cmp(&self.values[b]));
        let pick = |list: &[f64]| order.iter().map(|&i| list[i]).collect::<Vec<f64>>();
        let vectors = order
            .iter()
            .flat_map(|&i| self.vectors[n * i..n * (i + 1)].iter().copied());
        let pairs = Eigenpairs {
            values: pick(&self.values),
            vectors: vectors.collect(),
            bounds: pick(&self.bounds),
            residuals: pick(&self.residuals),
            ..self
        };
        let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
        if finite(&pairs.values) && finite(&pairs.bounds) {
            Ok(pairs)
        } else {
            Err(DenseError::EigenNotFinite)
        }
    }
}

/// a . b in the order of the entries.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
