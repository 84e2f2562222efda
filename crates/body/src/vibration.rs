//! A body in motion, reduced to its seats and its own modes: Craig and Bampton, AIAA J. 6 (1968) 1313,
//! doi:10.2514/3.4741, with the functions of the seats in the place of boundary nodes.
//!
//! The displacement is that of forces lam on the seats at rest, and of modes phi in which the seats stand,
//!
//! ```text
//! u = X lam + phi eta,     X = K^-1 Phi,     Phi^T phi = 0,     phi^T M phi = 1,     phi^T K phi = omega_f^2
//! K_r = diag(F, omega_f^2),     M_r = | X^T M X    X^T M phi |
//!                                     | phi^T M X      1     |
//! ```
//!
//! At rest nothing is left out. In motion the modes phi above a frequency are. The reduced body is a list of
//! oscillators xi, its own modes with free seats: M_r V = 1, K_r V = omega^2 in V^T . V; the seats have g = F V_lam xi.
//!
//! A body that a shaft carries ([`crate::carried`]) moves by R q as well, q free. Its first oscillators are rigid,
//! omega = 0, and move it by Q xi, Q^T (R^T M R) Q = 1. The others have no momentum: with W = Q^T R^T M (X, phi) they
//! are those of M_r - W^T W, and take the shaft along by q = -Q W V xi.

use std::f64::consts::TAU;

use dense::{
    DenseCholesky, DenseError, EigenProblem, Eigenpairs, LanczosSettings, dense_lowest, inner_products,
    lowest_pairs, symmetric_product,
};
use rayon::prelude::*;
use solver::LinearSolver;
use sprs::CsMat;

use crate::carried::{N_SHAFT, combined, dot};
use crate::error::SurroundingError;
use crate::oscillators::{BodyModes, ShaftShares, shaft_motion};
use crate::rigid_part::RigidPart;
use crate::surrounding::Surrounding;

/// Modes that are looked for at first.
pub(crate) const FIRST_SEARCH: usize = 12;
/// Most modes with held seats.
const MOST_MODES: usize = 384;
/// Vectors of a block of the search.
const BLOCK: usize = 4;
/// Shapes of a block of products. Fixed, so that threads change no bit.
pub(crate) const AT_A_TIME: usize = 32;

/// How so many modes with held seats are looked for.
pub(crate) fn search_settings(wanted: usize) -> LanczosSettings {
    LanczosSettings::new(wanted, BLOCK)
}

impl Surrounding {
    /// The body as oscillators, with its modes of held seats up to a frequency, Hz.
    pub fn modes(&self, below_hz: f64) -> Result<BodyModes, SurroundingError> {
        let no_mass = || SurroundingError::NoMass {
            body: self.name.clone(),
        };
        let matrices = self.matrices()?.ok_or_else(no_mass)?;
        let [stiffness, mass] = &*matrices;
        let failed = |source| SurroundingError::Modes {
            body: self.name.clone(),
            below_hz,
            source,
        };
        let columns = self.seat_columns();
        let held = HeldSeats {
            body: self,
            stiffness,
            mass,
            columns: &columns,
            flexibility: DenseCholesky::factor(self.n_functions(), &self.flexibility).map_err(failed)?,
        };
        let fixed = held.below(below_hz)?;
        let reduced = Reduced::new(&held, &fixed).map_err(failed)?;
        let n_fixed = fixed.values.len();
        let mut modes = reduced
            .oscillators(below_hz, n_fixed, fixed.vectors)
            .map_err(failed)?;
        let flexibility = held.flexibility;
        drop(matrices);
        if let (Some(_), Some((mesh, material))) = (&self.carried, &self.mesh) {
            modes.frame = Some(Box::new(self.frame_forms((mesh, material), &modes, columns)?));
        }
        let by_forces = |seats: &[f64]| {
            let mut forces = seats.to_vec();
            flexibility.solve(&mut forces, 1);
            forces
        };
        modes.loads = self.modal_loads(&modes, &fixed.values, by_forces).map(Box::new);
        Ok(modes)
    }

    /// Displacement of the body, m, `[n_nodes][3]` flat, under oscillators.
    pub fn moved(&self, modes: &BodyModes, oscillators: &[f64]) -> Vec<f64> {
        let mut field = self.displacement(&combined(&modes.forces, oscillators));
        let shares = combined(&modes.shares, oscillators);
        for (mode, share) in modes.fixed.chunks_exact(self.free.len()).zip(shares) {
            for (&dof, u) in self.free.iter().zip(mode) {
                field[dof] += share * u;
            }
        }
        if let Some(shares) = &modes.on_shaft {
            self.add_shaft_motion(shaft_motion(&shares.rows, oscillators), &mut field);
        }
        field
    }
}

/// The body with seats that stand, on its free dofs.
struct HeldSeats<'a> {
    body: &'a Surrounding,
    stiffness: &'a CsMat<f64>,
    mass: &'a CsMat<f64>,
    /// X = K^-1 Phi, column-major.
    columns: &'a [f64],
    flexibility: DenseCholesky,
}

impl HeldSeats<'_> {
    /// Its modes up to a frequency.
    fn below(&self, below_hz: f64) -> Result<Eigenpairs, SurroundingError> {
        let most = (TAU * below_hz).powi(2);
        // What the seats leave free has no more; beyond are the seats themselves, at frequencies of round-off.
        let most_pairs = self.n().saturating_sub(self.body.n_functions());
        let mut wanted = FIRST_SEARCH.min(most_pairs);
        loop {
            let found = lowest_pairs(self, search_settings(wanted), &mut |_| ());
            let mut found = found.map_err(|source| SurroundingError::Modes {
                body: self.body.name.clone(),
                below_hz,
                source,
            })?;
            let kept = found.values.iter().take_while(|value| **value <= most).count();
            if kept < found.values.len() || found.values.len() < wanted || wanted == most_pairs {
                found.values.truncate(kept);
                found.vectors.truncate(kept * self.n());
                return Ok(found);
            }
            if wanted >= MOST_MODES {
                return Err(SurroundingError::TooManyModes {
                    body: self.body.name.clone(),
                    below_hz,
                    most: MOST_MODES,
                    doubt: self.doubt(),
                });
            }
            wanted = (2 * wanted).min(most_pairs);
        }
    }

    /// What is odd of the body's matrices, for the end of a message.
    fn doubt(&self) -> String {
        let doubts = self
            .body
            .apparent
            .map(|apparent| apparent.doubts(&self.body.name));
        doubts
            .iter()
            .flatten()
            .map(|doubt| format!("; {doubt}"))
            .collect()
    }

    /// Takes the forces that hold the seats out of a block of vectors of forces. X is read once for all.
    fn without_reactions(&self, forces: &mut [f64], n_vectors: usize) {
        let n = self.n();
        let blocks = self.columns.par_chunks(AT_A_TIME * n);
        let motions: Vec<_> = blocks
            .map(|columns| inner_products(n, columns, columns.len() / n, forces, n_vectors))
            .collect();
        for (vector, force) in forces.chunks_exact_mut(n).enumerate() {
            let own = |block: &Vec<f64>| {
                let width = block.len() / n_vectors;
                block[width * vector..width * (vector + 1)].to_vec()
            };
            let mut reactions: Vec<f64> = motions.iter().flat_map(own).collect();
            self.flexibility.solve(&mut reactions, 1);
            let loads = self.body.seat_loads(&reactions);
            force.iter_mut().zip(loads).for_each(|(f, load)| *f -= load);
        }
    }
}

impl EigenProblem for HeldSeats<'_> {
    fn n(&self) -> usize {
        self.body.free.len()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn stiffness(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        solver::products(self.stiffness, x, n_vectors)
    }

    fn mass(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        solver::products(self.mass, x, n_vectors)
    }

    fn solve(&self, mut b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        self.without_reactions(&mut b, n_vectors);
        self.body.factor.solve(&mut b, n_vectors);
        b
    }

    fn remove_reactions(&self, force: &mut [f64]) {
        self.without_reactions(force, 1);
    }
}

/// The reduced body in coordinates (lam / scale, eta).
struct Reduced<'a> {
    flexibility: &'a [f64],
    /// Units of lam that make the diagonal of its mass one, N.
    scales: Vec<f64>,
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    factor: DenseCholesky,
    rigid: Option<RigidPart<'a>>,
}

impl<'a> Reduced<'a> {
    fn new(held: &HeldSeats<'a>, fixed: &Eigenpairs) -> Result<Reduced<'a>, DenseError> {
        let (rows, m) = (held.n(), held.body.n_functions());
        let of_fixed = fixed.vectors.chunks_exact(rows);
        let shapes: Vec<&[f64]> = held.columns.chunks_exact(rows).chain(of_fixed).collect();
        let n = shapes.len();
        let of_block = |block: &[&[f64]]| -> Vec<Vec<f64>> {
            let moved = solver::products(held.mass, &block.concat(), block.len());
            let [seats, own] = [held.columns, &fixed.vectors[..]]
                .map(|all| inner_products(rows, all, all.len() / rows, &moved, block.len()));
            let row = |k: usize| [&seats[m * k..m * (k + 1)], &own[(n - m) * k..(n - m) * (k + 1)]].concat();
            (0..block.len()).map(row).collect()
        };
        let blocks: Vec<_> = shapes.par_chunks(AT_A_TIME).map(of_block).collect();
        let mut lower = blocks.concat();
        lower
            .iter_mut()
            .enumerate()
            .for_each(|(i, row)| row.truncate(i + 1));
        let rigid = held.body.carried.as_ref();
        let rigid = rigid.map(|carried| RigidPart::new(carried, &shapes));
        if let Some(rigid) = &rigid {
            rigid.relieve(&mut lower);
        }
        let scale = |i: usize| if i < m { lower[i][i].sqrt().recip() } else { 1.0 };
        let scales: Vec<f64> = (0..n).map(scale).collect();
        let (mut mass, mut stiffness) = (vec![0.0; n * n], vec![0.0; n * n]);
        for (i, row) in lower.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                let both = scales[i] * scales[j];
                (mass[n * i + j], mass[n * j + i]) = (both * value, both * value);
                if i < m {
                    let value = both * held.body.flexibility[m * i + j];
                    (stiffness[n * i + j], stiffness[n * j + i]) = (value, value);
                }
            }
        }
        for (i, square) in fixed.values.iter().enumerate() {
            stiffness[(n + 1) * (m + i)] = *square;
        }
        Ok(Reduced {
            flexibility: &held.body.flexibility,
            factor: DenseCholesky::factor(n, &stiffness)?,
            scales,
            stiffness,
            mass,
            rigid,
        })
    }

    /// A X of one of its matrices, column-major.
    fn products(&self, a: &[f64], x: &[f64]) -> Vec<f64> {
        let of_column = |column: &[f64]| symmetric_product(a, column, 1);
        x.chunks_exact(self.n()).flat_map(of_column).collect()
    }

    /// Its modes as oscillators.
    fn oscillators(self, below_hz: f64, n_fixed: usize, fixed: Vec<f64>) -> Result<BodyModes, DenseError> {
        let (n, m) = (self.n(), self.n() - n_fixed);
        let pairs = dense_lowest(&self, n)?;
        let moved = self.mass(&pairs.vectors, n);
        let mut modes = BodyModes {
            below_hz,
            n_fixed,
            fixed,
            ..BodyModes::rigid()
        };
        if let Some(rigid) = &self.rigid {
            self.add_rigid(rigid, &mut modes)?;
        }
        for (vector, moved) in pairs.vectors.chunks_exact(n).zip(moved.chunks_exact(n)) {
            let lam: Vec<f64> = vector[..m].iter().zip(&self.scales).map(|(v, s)| v * s).collect();
            let mut seat: Vec<f64> = self
                .flexibility
                .chunks_exact(m)
                .map(|row| dot(row, &lam))
                .collect();
            if let (Some(rigid), Some(shares)) = (&self.rigid, &mut modes.on_shaft) {
                let all: Vec<f64> = lam.iter().chain(&vector[m..]).copied().collect();
                let q = rigid.taken_along(&all);
                let along = rigid.carried.seat_motion(q);
                seat.iter_mut().zip(along).for_each(|(y, r)| *y += r);
                shares.rows.push(q);
            }
            modes.seat.extend(seat);
            modes
                .of_forces
                .extend(moved[..m].iter().zip(&self.scales).map(|(v, s)| v / s));
            modes.forces.extend(lam);
            modes.shares.extend(&vector[m..]);
        }
        modes.squares.extend(pairs.values);
        Ok(modes)
    }

    /// The rigid oscillators of a body that a shaft carries: they come first.
    fn add_rigid(&self, rigid: &RigidPart<'_>, modes: &mut BodyModes) -> Result<(), DenseError> {
        let (n_fixed, m) = (modes.n_fixed, self.n() - modes.n_fixed);
        let flexibility = DenseCholesky::factor(m, self.flexibility)?;
        let mut reactions = Vec::with_capacity(N_SHAFT * m);
        for (r, motion) in rigid.motions.iter().enumerate() {
            let coupling: Vec<f64> = rigid.coupling[..m].iter().map(|w| w[r]).collect();
            let mut reaction = coupling.clone();
            flexibility.solve(&mut reaction, 1);
            modes.seat.extend(rigid.carried.seat_motion(*motion));
            modes.of_forces.extend(coupling);
            modes.forces.extend(vec![0.0; m]);
            modes.shares.extend(vec![0.0; n_fixed]);
            reactions.extend(reaction);
        }
        modes.squares = vec![0.0; N_SHAFT];
        modes.on_shaft = Some(ShaftShares {
            rows: rigid.motions.to_vec(),
            of_motion: rigid.motions.map(|motion| rigid.carried.momentum(motion)),
            reactions,
        });
        Ok(())
    }
}

impl EigenProblem for Reduced<'_> {
    fn n(&self) -> usize {
        self.scales.len()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn stiffness(&self, x: &[f64], _: usize) -> Vec<f64> {
        self.products(&self.stiffness, x)
    }

    fn mass(&self, x: &[f64], _: usize) -> Vec<f64> {
        self.products(&self.mass, x)
    }

    fn solve(&self, mut b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        self.factor.solve(&mut b, n_vectors);
        b
    }
}
