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
//! A body that a shaft carries ([`crate::carried`]) moves by R q as well, q free. Its first oscillators are rigid, omega
//! = 0, and move it by Q xi, Q^T (R^T M R) Q = 1. The others have no momentum: with W = Q^T R^T M (X, phi) they are those
//! of M_r - W^T W, and take the shaft along by q = -Q W V xi.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use dense::{
    DenseCholesky, DenseError, EigenProblem, Eigenpairs, LanczosSettings, dense_lowest, lowest_pairs,
    symmetric_product,
};
use rayon::prelude::*;
use solver::LinearSolver;
use sprs::CsMat;

use crate::carried::{Carried, N_SHAFT, ShaftPlace};
use crate::error::SurroundingError;
use crate::surrounding::Surrounding;

/// Modes that are looked for at first.
const FIRST_SEARCH: usize = 12;
/// Most modes with held seats.
const MOST_MODES: usize = 384;
/// Vectors of a block of the search.
const BLOCK: usize = 4;

/// A body as oscillators.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyModes {
    /// Squares of their angular frequencies, rad^2/s^2, ascending.
    pub squares: Vec<f64>,
    /// Motion of the seat functions, m per unit of an oscillator (m kg^1/2), `[n_oscillators][n_functions]` flat.
    pub seat: Vec<f64>,
    /// Oscillators in which the body stands under static forces, per N, `[n_oscillators][n_functions]` flat.
    pub of_forces: Vec<f64>,
    /// Frequency up to which modes with held seats are kept, Hz.
    pub below_hz: f64,
    /// How many these are.
    pub n_fixed: usize,
    /// Static forces on the seats, N per unit, `[n_oscillators][n_functions]` flat.
    forces: Vec<f64>,
    /// Shares of the modes with held seats, `[n_oscillators][n_fixed]` flat.
    shares: Vec<f64>,
    /// These modes on the free dofs, column-major.
    fixed: Vec<f64>,
    /// Of a body that a shaft carries.
    pub(crate) on_shaft: Option<ShaftShares>,
}

/// How oscillators move the shaft that carries their body, at the bearing of its first seat. The first [`N_SHAFT`] are
/// rigid.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftShares {
    /// Motion of the shaft per unit of an oscillator, m and rad.
    rows: Vec<[f64; N_SHAFT]>,
    /// Rigid oscillators of the body that moves with the shaft: by unit motions of it, `[rigid][motion]`.
    of_motion: [[f64; N_SHAFT]; N_SHAFT],
    /// Static forces on the functions of all seats that unit accelerations of the rigid oscillators ask for, N,
    /// `[rigid][n_functions]` flat.
    reactions: Vec<f64>,
}

/// The shaft at the bearing of a seat.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftAtSeat {
    /// Motion of the shaft there per unit of an oscillator, m and rad.
    pub rows: Vec<[f64; N_SHAFT]>,
    /// Rigid oscillators of the body that moves with it: by unit motions there, `[rigid][motion]`.
    of_motion: [[f64; N_SHAFT]; N_SHAFT],
}

impl ShaftAtSeat {
    /// The shaft at a place on it.
    pub(crate) fn new(shares: &ShaftShares, place: &ShaftPlace) -> ShaftAtSeat {
        let unit = |k: usize| {
            let mut q = [0.0; N_SHAFT];
            q[k] = 1.0;
            place.here(q)
        };
        let of_motion = |row: &[f64; N_SHAFT]| [0, 1, 2, 3, 4].map(|k| dot(row, &unit(k)));
        ShaftAtSeat {
            rows: shares.rows.iter().map(|row| place.there(*row)).collect(),
            of_motion: shares.of_motion.each_ref().map(of_motion),
        }
    }

    /// Motion of the shaft under oscillators, m and rad.
    pub fn motion(&self, oscillators: &[f64]) -> [f64; N_SHAFT] {
        shaft_motion(&self.rows, oscillators)
    }

    /// Adds the oscillators of a motion or velocity with the shaft.
    pub fn add_motion(&self, q: [f64; N_SHAFT], oscillators: &mut [f64]) {
        for (x, row) in oscillators.iter_mut().zip(&self.of_motion) {
            *x += dot(row, &q);
        }
    }
}

fn shaft_motion(rows: &[[f64; N_SHAFT]], oscillators: &[f64]) -> [f64; N_SHAFT] {
    let mut q = [0.0; N_SHAFT];
    for (row, x) in rows.iter().zip(oscillators) {
        (0..N_SHAFT).for_each(|k| q[k] += row[k] * x);
    }
    q
}

impl BodyModes {
    /// A rigid body: no oscillators.
    pub fn rigid() -> BodyModes {
        BodyModes {
            squares: Vec::new(),
            seat: Vec::new(),
            of_forces: Vec::new(),
            below_hz: f64::INFINITY,
            n_fixed: 0,
            forces: Vec::new(),
            shares: Vec::new(),
            fixed: Vec::new(),
            on_shaft: None,
        }
    }

    /// Number of oscillators.
    pub fn n(&self) -> usize {
        self.squares.len()
    }

    /// Motion of the functions of all seats under oscillators, m.
    pub fn seat_motion(&self, oscillators: &[f64]) -> Vec<f64> {
        combined(&self.seat, oscillators)
    }

    /// Oscillators in which the body stands under forces on the functions of all seats, N.
    pub fn at_rest(&self, forces: &[f64]) -> Vec<f64> {
        let rows = self.of_forces.chunks_exact(forces.len().max(1));
        rows.map(|row| dot(row, forces)).collect()
    }

    /// Forces on the functions of all seats of a body on a shaft, N, by which its oscillators move so: `driven` are
    /// minus accelerations and damping of rigid ones, and of the others minus what they would stand for at rest.
    pub fn forces_on_shaft(&self, driven: &[f64]) -> Vec<f64> {
        let mut forces = combined(&self.forces, driven);
        if let Some(shares) = &self.on_shaft {
            let of_rigid = combined(&shares.reactions, &driven[..N_SHAFT]);
            forces.iter_mut().zip(of_rigid).for_each(|(f, r)| *f += r);
        }
        forces
    }

    /// Bytes of all.
    pub fn bytes(&self) -> usize {
        let lists = [
            &self.squares,
            &self.seat,
            &self.of_forces,
            &self.forces,
            &self.shares,
            &self.fixed,
        ];
        size_of::<f64>() * lists.iter().map(|list| list.len()).sum::<usize>()
    }
}

/// The oscillators of a body as one of its seats sees them.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatModes {
    /// The body.
    pub of_body: Arc<BodyModes>,
    /// Numbers of the functions of the seat among those of all seats.
    pub own: Range<usize>,
    /// The shaft that carries the body; None of one that stands.
    pub on_shaft: Option<ShaftAtSeat>,
}

impl SeatModes {
    /// A rigid body: no oscillators.
    pub fn rigid() -> SeatModes {
        SeatModes {
            of_body: Arc::new(BodyModes::rigid()),
            own: 0..0,
            on_shaft: None,
        }
    }

    /// Number of oscillators.
    pub fn n(&self) -> usize {
        self.of_body.n()
    }

    /// Squares of their angular frequencies, rad^2/s^2.
    pub fn squares(&self) -> &[f64] {
        &self.of_body.squares
    }

    /// Motion of the functions of the seat, m per unit of each oscillator.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        let BodyModes { seat, .. } = &*self.of_body;
        let width = seat.len().checked_div(self.n()).unwrap_or(0);
        seat.chunks_exact(width.max(1)).map(|row| &row[self.own.clone()])
    }

    /// Motion of the functions of the seat under oscillators, m; of a rigid body none.
    pub fn motion(&self, oscillators: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.own.len()];
        for (row, factor) in self.rows().zip(oscillators) {
            sum.iter_mut().zip(row).for_each(|(s, r)| *s += factor * r);
        }
        sum
    }

    /// Forces on the oscillators of forces lam on the functions of the seat, N.
    pub fn loads(&self, lam: &[f64]) -> Vec<f64> {
        self.rows().map(|row| dot(row, lam)).collect()
    }

    /// D = V diag(1/s) V^T of the functions of the seat for effective masses s of the oscillators,
    /// `[n_functions]^2` flat; empty for a rigid body.
    pub fn softness(&self, effective: &[f64]) -> Vec<f64> {
        let n = self.own.len();
        let mut softness = vec![0.0; n * n];
        for (row, s) in self.rows().zip(effective) {
            for (to, v) in softness.chunks_exact_mut(n).zip(row) {
                let by = v / s;
                to.iter_mut().zip(row).for_each(|(d, w)| *d += by * w);
            }
        }
        softness
    }
}

/// Rows of a matrix times one number each, summed.
fn combined(rows: &[f64], factors: &[f64]) -> Vec<f64> {
    let width = rows.len().checked_div(factors.len()).unwrap_or(0);
    let mut sum = vec![0.0; width];
    for (row, factor) in rows.chunks_exact(width.max(1)).zip(factors) {
        sum.iter_mut().zip(row).for_each(|(s, r)| *s += factor * r);
    }
    sum
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
        reduced
            .oscillators(below_hz, n_fixed, fixed.vectors)
            .map_err(failed)
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
        let mut wanted = FIRST_SEARCH;
        loop {
            let found = lowest_pairs(self, LanczosSettings::new(wanted, BLOCK), &mut |_| ());
            let mut found = found.map_err(|source| SurroundingError::Modes {
                body: self.body.name.clone(),
                below_hz,
                source,
            })?;
            let kept = found.values.iter().take_while(|value| **value <= most).count();
            if kept < found.values.len() || found.values.len() < wanted {
                found.values.truncate(kept);
                found.vectors.truncate(kept * self.n());
                return Ok(found);
            }
            if wanted >= MOST_MODES {
                return Err(SurroundingError::TooManyModes {
                    body: self.body.name.clone(),
                    below_hz,
                    most: MOST_MODES,
                });
            }
            wanted *= 2;
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
        b.chunks_exact_mut(self.n())
            .for_each(|force| self.remove_reactions(force));
        self.body.factor.solve(&mut b, n_vectors);
        b
    }

    fn remove_reactions(&self, force: &mut [f64]) {
        let columns = self.columns.par_chunks_exact(force.len());
        let mut reactions: Vec<f64> = columns.map(|column| dot(column, force)).collect();
        self.flexibility.solve(&mut reactions, 1);
        let loads = self.body.seat_loads(&reactions);
        force.iter_mut().zip(loads).for_each(|(f, load)| *f -= load);
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

/// The rigid motions of a body that a shaft carries.
struct RigidPart<'a> {
    carried: &'a Carried,
    /// Q, by rigid oscillator.
    motions: [[f64; N_SHAFT]; N_SHAFT],
    /// W, by coordinate.
    coupling: Vec<[f64; N_SHAFT]>,
}

impl<'a> RigidPart<'a> {
    fn new(carried: &'a Carried, shapes: &[&[f64]]) -> RigidPart<'a> {
        let motions = carried.orthonormal();
        let coupled = |shape: &&[f64]| {
            let pushed = [0, 1, 2, 3, 4].map(|k| dot(&carried.pushes[k], shape));
            motions.map(|motion| dot(&motion, &pushed))
        };
        RigidPart {
            carried,
            motions,
            coupling: shapes.par_iter().map(coupled).collect(),
        }
    }

    /// Takes the momentum of the coordinates out of their mass, by rows of its lower triangle.
    fn relieve(&self, lower: &mut [Vec<f64>]) {
        for (i, row) in lower.iter_mut().enumerate() {
            let others = self.coupling.iter();
            row.iter_mut()
                .zip(others)
                .for_each(|(m, w)| *m -= dot(&self.coupling[i], w));
        }
    }

    /// Motion of the shaft that coordinates take along.
    fn taken_along(&self, coordinates: &[f64]) -> [f64; N_SHAFT] {
        let mut q = [0.0; N_SHAFT];
        for (w, z) in self.coupling.iter().zip(coordinates) {
            for (motion, w) in self.motions.iter().zip(w) {
                (0..N_SHAFT).for_each(|k| q[k] -= motion[k] * w * z);
            }
        }
        q
    }
}

impl<'a> Reduced<'a> {
    fn new(held: &HeldSeats<'a>, fixed: &Eigenpairs) -> Result<Reduced<'a>, DenseError> {
        let (rows, m) = (held.n(), held.body.n_functions());
        let of_fixed = fixed.vectors.chunks_exact(rows);
        let shapes: Vec<&[f64]> = held.columns.chunks_exact(rows).chain(of_fixed).collect();
        let n = shapes.len();
        let row = |i: usize| -> Vec<f64> {
            let moved = solver::products(held.mass, shapes[i], 1);
            shapes[..=i].iter().map(|shape| dot(shape, &moved)).collect()
        };
        let mut lower: Vec<Vec<f64>> = (0..n).into_par_iter().map(row).collect();
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
