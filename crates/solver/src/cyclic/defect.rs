//! A periodic ring with a defect: a few rows and columns of its matrix are others.
//!
//! With A the matrix of the ring without the defect, P the unit vectors of the n rows that the defect touches, and D
//! the change there, the true matrix is A + P D P^T. Conjugate gradients on it with A^-1 as preconditioner start from
//! x0 = A^-1 b, and then never leave the space of A^-1 P: all residuals are P times n numbers. So they need the
//! compliance G = P^T A^-1 P of those rows and nothing else of the ring ([`conjugate_gradients`]), and instead of
//! iterating, the n unknown forces of the defect follow directly,
//! ```text
//! x = x0 + A^-1 P f,    f = -S P^T x0,    S = (G + D^-1)^-1 = D - D (G^-1 + D)^-1 D
//! ```
//! (Woodbury; Golub and Van Loan, *Matrix Computations*, 4th ed. 2013, section 2.1.4). D need not be invertible: with
//! G = L L^T, (G^-1 + D)^-1 = L (1 + L^T D L)^-1 L^T, and the matrix in brackets is positive definite exactly when
//! the true one is. Solutions are those of the true matrix to round-off.
//!
//! **Rows that are gone.** The regular ring may have rows h that the true one lacks: nodes that only missing elements
//! have, or that are held besides. All that they couple with is in the change, A_hh = -D_hh and A_hr = -D_hr, as the
//! true matrix is zero there. Nothing loads them, so the regular ring answers at the other rows r as its Schur
//! complement, and the change from that to the true matrix is D_rr - D_rh D_hh^-1 D_hr ([`Change::condensed`]).
//! Callers never see h ([`super::CyclicRing::seen_at`]). Rows that the true ring has and the regular one lacks are
//! eliminated ([`super::Loose`]).
//!
//! Cost: a solve for every component of every section node that the defect touches, 4 n^3 operations, 16 n^2 bytes;
//! then two solves per right-hand side in place of one for each iteration.

use std::ops::Range;

use dense::{inverse_form, symmetric_form, symmetric_product, update};

use super::border::CyclicBordered;
use super::loose::Loose;
use super::response::ResponseTable;
use super::transform::SectionPart;
use crate::error::SolverError;
use crate::linear_solver::LinearSolver;

/// Residual over the first one, both in the norm of A^-1, at which [`conjugate_gradients`] stops.
const TOLERANCE: f64 = 1e-10;

/// The change of a matrix in a few rows.
#[derive(Clone, Debug)]
pub struct Change {
    /// Its rows, the caller's, those of a border last; distinct, `[n]`.
    pub rows: Vec<usize>,
    /// D, symmetric, row-major `[n][n]`.
    pub values: Vec<f64>,
    /// Rows that the regular ring lacks.
    pub loose: Option<Loose>,
}

/// The answer of a ring to the change of its matrix.
#[derive(Clone, Debug)]
pub struct Defect {
    rows: Vec<usize>,
    /// S, row-major.
    reduced: Vec<f64>,
    /// G, row-major.
    compliance: Vec<f64>,
    iterations: usize,
    loose: Option<Loose>,
}

/// Factor of a periodic ring with a defect.
#[derive(Clone, Debug)]
pub struct CyclicDefect {
    base: CyclicBordered,
    defect: Defect,
    part: SectionPart,
}

impl Change {
    /// The change in the rows `rows` of a ring that has the rows `loose` more than the regular one, and lacks others:
    /// D of all, row-major, symmetric, in this order. Both must be held by `rows`.
    ///
    /// # Panics
    /// When there are fewer values than rows.
    pub fn condensed(rows: Vec<usize>, loose: Vec<usize>, values: &[f64]) -> Result<Change, SolverError> {
        let (n, size) = (rows.len(), values.len().isqrt());
        let known = n + loose.len();
        assert!(
            size >= known && size * size == values.len(),
            "{known} rows and those that are gone"
        );
        let part = |rows: Range<usize>, columns: Range<usize>, sign: f64| -> Vec<f64> {
            let row = |i: usize| values[size * i..][columns.clone()].iter().map(move |d| sign * d);
            rows.flat_map(row).collect()
        };
        let mut kept = part(0..n, 0..n, 1.0);
        // Rows of the true ring and rows of the regular one, of which there is the negative matrix.
        for (range, sign) in [(n..known, 1.0), (known..size, -1.0)] {
            if !range.is_empty() {
                let (own, coupling) = (
                    part(range.clone(), range.clone(), sign),
                    part(range.clone(), 0..n, 1.0),
                );
                let more = inverse_form(range.len(), n, &own, &coupling)?;
                kept.iter_mut().zip(more).for_each(|(d, m)| *d -= sign * m);
            }
        }
        let own = part(n..known, n..known, 1.0);
        let with_loose = || Loose::new(loose, rows.clone(), &own, part(n..known, 0..n, 1.0));
        Ok(Change {
            loose: (known > n).then(with_loose).transpose()?,
            rows,
            values: kept,
        })
    }
}

impl Defect {
    /// The answer of the ring whose regular factor is `base`; `table` has the responses without the border of all
    /// section nodes that the change touches.
    ///
    /// # Panics
    /// When sizes disagree or the table lacks a node.
    pub fn new(base: &CyclicBordered, table: &ResponseTable, change: &Change) -> Result<Defect, SolverError> {
        let n = change.rows.len();
        assert_eq!(change.values.len(), n * n, "{n} rows and columns");
        let compliance = compliance(base, table, &change.rows);
        let reduced = update(n, &compliance, &change.values)
            .map_err(|error| SolverError::from(error).in_whole(base.n(), |row| change.rows[row]))?;
        // Displacements under forces that alternate, as no rigid motion does.
        let load: Vec<f64> = (0..n).map(|i| [1.0, -0.6, 0.3, -0.8][i % 4]).collect();
        let at = product(&compliance, &load);
        let (_, iterations) = conjugate_gradients(&compliance, &change.values, &at);
        Ok(Defect {
            rows: change.rows.clone(),
            reduced,
            compliance,
            iterations,
            loose: change.loose.clone(),
        })
    }

    /// Rows that the change touches.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Iterations that conjugate gradients preconditioned by the regular ring take to reduce the residual to 1e-10 of
    /// the first: how much the defect disturbs the ring.
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Rows that the regular ring lacks: to be eliminated before it is solved.
    pub fn loose(&self) -> Option<&Loose> {
        self.loose.as_ref()
    }

    /// Forces of the defect on its rows, f = -S x, from the displacements there without it.
    pub fn forces(&self, at: &[f64]) -> Vec<f64> {
        let mut forces = symmetric_product(&self.reduced, at, 1);
        forces.iter_mut().for_each(|f| *f = -*f);
        forces
    }

    /// G f: displacements of the rows under the forces `forces` on them, without the defect.
    pub fn moved(&self, forces: &[f64]) -> Vec<f64> {
        symmetric_product(&self.compliance, forces, 1)
    }

    /// V^T S V, row-major `[width][width]`, exactly symmetric, of displacements V, row-major `[n][width]`.
    pub fn form(&self, at: &[f64], width: usize) -> Vec<f64> {
        symmetric_form(&self.reduced, at, width)
    }

    /// Bytes of S and G.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * (self.reduced.capacity() + self.compliance.capacity())
    }
}

impl CyclicDefect {
    /// Changes the matrix of `base` by `change`.
    ///
    /// # Panics
    /// When sizes disagree.
    pub fn new(base: CyclicBordered, change: &Change) -> Result<CyclicDefect, SolverError> {
        let factor = base.inner();
        let (ring, n) = (factor.ring(), factor.n());
        let nodes = change.rows.iter().filter(|&&row| row < n).map(|row| row / 3);
        let section = ring.section_nodes(nodes.clone());
        let table = ResponseTable::new(factor, &section);
        Ok(CyclicDefect {
            defect: Defect::new(&base, &table, change)?,
            part: ring.section_part(&[], nodes),
            base,
        })
    }

    /// The answer to the change.
    pub fn defect(&self) -> &Defect {
        &self.defect
    }
}

impl LinearSolver for CyclicDefect {
    fn n(&self) -> usize {
        self.base.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        let (ring, rows) = (self.base.inner().ring(), &self.defect.rows);
        let mut harmonic = vec![0.0; ring.harmonic_len()];
        let (mut more, mut sparse) = (harmonic.clone(), vec![0.0; n]);
        for column in rhs.chunks_exact_mut(n.max(1)) {
            let loose = self.defect.loose.as_ref();
            let alone = loose.map(|loose| (loose, loose.take(column)));
            let (nodal, border) = column.split_at_mut(ring.n());
            ring.to_harmonic(nodal, &mut harmonic);
            self.base.solve_harmonic(&mut [&mut harmonic], border);
            let (at, at_border) = sparse.split_at_mut(ring.n());
            ring.from_harmonic_at(&self.part, &harmonic, at);
            at_border.copy_from_slice(border);
            let at: Vec<f64> = rows.iter().map(|&row| sparse[row]).collect();
            sparse.fill(0.0);
            let forces = self.defect.forces(&at);
            rows.iter().zip(forces).for_each(|(&row, f)| sparse[row] = f);
            let (loads, border_loads) = sparse.split_at_mut(ring.n());
            ring.to_harmonic_from(&self.part, loads, &mut more);
            self.base.solve_harmonic(&mut [&mut more], border_loads);
            harmonic.iter_mut().zip(&more).for_each(|(x, d)| *x += d);
            border.iter_mut().zip(&*border_loads).for_each(|(x, d)| *x += d);
            ring.from_harmonic(&harmonic, nodal);
            if let Some((loose, alone)) = alone {
                loose.put(&alone, column);
            }
        }
    }

    fn factor_bytes(&self) -> usize {
        self.base.factor_bytes() + self.defect.bytes()
    }

    fn name(&self) -> &'static str {
        "cyclic Cholesky with a defect"
    }
}

/// G: displacements of the rows under unit forces on them, row-major.
fn compliance(base: &CyclicBordered, table: &ResponseTable, rows: &[usize]) -> Vec<f64> {
    let (n, n_free) = (rows.len(), base.inner().n());
    let border = BorderColumns::new(base);
    // Values of the border's columns at the rows, [n][m].
    let touched: Vec<Vec<f64>> = rows.iter().map(|&row| border.row(row)).collect();
    let mut compliance = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let value = match (rows[i].checked_sub(n_free), rows[j].checked_sub(n_free)) {
                (None, None) => {
                    let direct = table.between(rows[i], rows[j]);
                    direct + border.between(&touched[i], &touched[j])
                }
                (Some(k), _) => touched[j][k],
                (None, Some(k)) => touched[i][k],
            };
            (compliance[n * i + j], compliance[n * j + i]) = (value, value);
        }
    }
    compliance
}

/// Columns of the inverse that belong to the border.
struct BorderColumns {
    /// Column-major `[n][m]`.
    columns: Vec<f64>,
    /// Inverse of their rows of the border, row-major `[m][m]`.
    inverse: Vec<f64>,
    n: usize,
}

impl BorderColumns {
    fn new(base: &CyclicBordered) -> BorderColumns {
        let (n, n_free) = (base.n(), base.inner().n());
        let m = n - n_free;
        let mut columns = vec![0.0; n * m];
        (0..m).for_each(|k| columns[n * k + n_free + k] = 1.0);
        if m > 0 {
            base.solve(&mut columns, m);
        }
        let corner: Vec<f64> = (0..m * m)
            .map(|kl| columns[n * (kl / m) + n_free + kl % m])
            .collect();
        let inverse = dense::DenseCholesky::factor(m, &corner)
            .expect("the compliance of a positive definite matrix' border is positive definite")
            .inverse();
        BorderColumns { columns, inverse, n }
    }

    fn row(&self, row: usize) -> Vec<f64> {
        self.columns.chunks_exact(self.n).map(|c| c[row]).collect()
    }

    fn between(&self, a: &[f64], b: &[f64]) -> f64 {
        let m = a.len();
        (0..m * m)
            .map(|kl| a[kl / m] * self.inverse[kl] * b[kl % m])
            .sum()
    }
}

/// Forces f of the defect by conjugate gradients on the true matrix with the regular ring as preconditioner, from the
/// displacements `at` of the defect's rows without it; and the number of iterations. `compliance` is G, `change` D,
/// both row-major.
///
/// # Panics
/// When sizes disagree.
pub fn conjugate_gradients(compliance: &[f64], change: &[f64], at: &[f64]) -> (Vec<f64>, usize) {
    let n = at.len();
    // The residual is P r, its preconditioned form A^-1 P r, of which only g = G r counts.
    let mut r: Vec<f64> = product(change, at).iter().map(|x| -x).collect();
    let mut g = product(compliance, &r);
    let (mut p, mut gp, mut f) = (r.clone(), g.clone(), vec![0.0; n]);
    let first = dot(&r, &g);
    let mut square = first;
    for iteration in 0..10 * n.max(1) {
        if square <= TOLERANCE * TOLERANCE * first {
            return (f, iteration);
        }
        let dp = product(change, &gp);
        let ap: Vec<f64> = p.iter().zip(&dp).map(|(p, d)| p + d).collect();
        let alpha = square / dot(&gp, &ap);
        for i in 0..n {
            f[i] += alpha * p[i];
            r[i] -= alpha * ap[i];
        }
        g = product(compliance, &r);
        let next = dot(&r, &g);
        let beta = next / square;
        square = next;
        for i in 0..n {
            p[i] = r[i] + beta * p[i];
            gp[i] = g[i] + beta * gp[i];
        }
    }
    (f, 10 * n.max(1))
}

/// A x, A row-major.
fn product(a: &[f64], x: &[f64]) -> Vec<f64> {
    a.chunks_exact(x.len().max(1)).map(|row| dot(row, x)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
