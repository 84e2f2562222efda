//! A ring and the body to which it is tied as one vibrating body.
//!
//! Coordinates are those of the free ring, y, then the oscillators of the body, xi ([`body::BodyModes`]); both move the
//! functions of the seat alike, Phi y = V^T xi. With forces lam of the joint on the ring and S = K + s M of the ring
//! alone, loads f and p are answered by
//!
//! ```text
//! y  = S^-1 (f + Phi^T lam),     xi = (p - V lam) / (omega^2 + s)
//! (A + D) lam = V^T (p / (omega^2 + s)) - Phi S^-1 f,     A = Phi S^-1 Phi^T,   D = V diag(1 / (omega^2 + s)) V^T
//! ```
//!
//! Cost: once a solve of the ring per function, then two solves per load instead of one. No column is kept.

use std::sync::Arc;

use body::{SeatFunctions, SeatModes, SeatTie};
use dense::DenseCholesky;
use solver::LinearSolver;

use crate::error::RingError;
use crate::mount::MountRows;
use crate::sparse::fill;
use crate::vectors::dot;

/// Functions whose columns are solved at a time.
const AT_A_TIME: usize = 32;

/// The joint of a vibrating ring, and its body.
pub(crate) struct VibratingTie {
    tie: Arc<SeatTie>,
    modes: SeatModes,
    /// Phi in the coordinates of the ring.
    mount: MountRows,
    /// Coordinates of the ring.
    n_ring: usize,
    /// omega^2 + s of the oscillators.
    effective: Vec<f64>,
    /// A + D.
    joint: DenseCholesky,
    /// Phi Phi^T + V^T V.
    gram: DenseCholesky,
}

impl VibratingTie {
    /// The joint of a ring with `n_ring` coordinates, whose K + `shift` M is factored.
    pub fn new(
        tie: &Arc<SeatTie>,
        functions: &SeatFunctions,
        (ring, n_ring): (&dyn LinearSolver, usize),
        shift: f64,
    ) -> Result<VibratingTie, RingError> {
        let failed = |source| RingError::Tie { source };
        let modes = tie.modes.clone();
        let modes = modes.expect("the modes of a body are found before its ring vibrates");
        let mount = MountRows::of_seat(functions);
        let effective: Vec<f64> = modes.squares().iter().map(|square| square + shift).collect();
        let n = mount.len();
        let mut joint = Vec::with_capacity(n * n);
        for rows in mount.rows.chunks(AT_A_TIME) {
            let mut columns = vec![0.0; n_ring * rows.len()];
            fill(&mut columns, rows, n_ring);
            ring.solve(&mut columns, rows.len());
            joint.extend(columns.chunks_exact(n_ring).flat_map(|y| mount.measure(y)));
        }
        // A rigid body gives nothing.
        let add = |sum: &mut [f64], of_body: Vec<f64>| sum.iter_mut().zip(of_body).for_each(|(s, d)| *s += d);
        add(&mut joint, modes.softness(&modes, &effective));
        let mut gram = mount.gram();
        add(&mut gram, modes.softness(&modes, &vec![1.0; modes.n()]));
        Ok(VibratingTie {
            joint: DenseCholesky::factor(n, &joint).map_err(failed)?,
            gram: DenseCholesky::factor(n, &gram).map_err(failed)?,
            tie: tie.clone(),
            modes,
            mount,
            n_ring,
            effective,
        })
    }

    /// Number of oscillators.
    pub fn n_oscillators(&self) -> usize {
        self.modes.n()
    }

    fn n(&self) -> usize {
        self.n_ring + self.modes.n()
    }

    /// What the ring has of a block of vectors.
    pub fn of_ring(&self, y: &[f64]) -> Vec<f64> {
        let columns = y.chunks_exact(self.n());
        columns.flat_map(|y| &y[..self.n_ring]).copied().collect()
    }

    /// A block of vectors from what the ring has of it, and from the oscillators of another times a factor of their
    /// omega^2.
    pub fn joined(&self, ring: &[f64], y: &[f64], factor: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut all = Vec::with_capacity(y.len());
        for (ring, y) in ring.chunks_exact(self.n_ring).zip(y.chunks_exact(self.n())) {
            all.extend_from_slice(ring);
            let oscillators = self.modes.squares().iter().zip(&y[self.n_ring..]);
            all.extend(oscillators.map(|(square, xi)| factor(*square) * xi));
        }
        all
    }

    /// (K + s M)^-1 of a block of loads with the factor of the ring alone.
    pub fn solve(&self, ring: &dyn LinearSolver, loads: &mut [f64]) {
        let n_vectors = loads.len() / self.n();
        let mut forces = self.of_ring(loads);
        let mut moved = forces.clone();
        ring.solve(&mut moved, n_vectors);
        let of_ring = forces
            .chunks_exact_mut(self.n_ring)
            .zip(moved.chunks_exact(self.n_ring));
        for (load, (force, moved)) in loads.chunks_exact_mut(self.n()).zip(of_ring) {
            let oscillators = &mut load[self.n_ring..];
            let free: Vec<f64> = oscillators
                .iter()
                .zip(&self.effective)
                .map(|(p, s)| p / s)
                .collect();
            let mut lam = self.gap(moved, &free);
            lam.iter_mut().for_each(|gap| *gap = -*gap);
            self.joint.solve(&mut lam, 1);
            self.mount.loads(&lam).for_each(|(i, f)| force[i] += f);
            let rows = self.modes.rows().zip(&self.effective);
            for ((xi, free), (row, s)) in oscillators.iter_mut().zip(free).zip(rows) {
                *xi = free - dot(row, &lam) / s;
            }
        }
        ring.solve(&mut forces, n_vectors);
        for (load, y) in loads
            .chunks_exact_mut(self.n())
            .zip(forces.chunks_exact(self.n_ring))
        {
            load[..self.n_ring].copy_from_slice(y);
        }
    }

    /// Phi y - V^T xi.
    fn gap(&self, ring: &[f64], oscillators: &[f64]) -> Vec<f64> {
        let mut gap = self.mount.measure(ring);
        let of_body = self.modes.motion(oscillators);
        gap.iter_mut().zip(of_body).for_each(|(g, y)| *g -= y);
        gap
    }

    /// Takes the forces of the joint out of a vector of forces: what is orthogonal to all of them stays.
    pub fn remove_reactions(&self, force: &mut [f64]) {
        let (ring, oscillators) = force.split_at_mut(self.n_ring);
        let mut lam = self.gap(ring, oscillators);
        self.gram.solve(&mut lam, 1);
        self.mount.loads(&lam).for_each(|(i, f)| ring[i] -= f);
        for (p, row) in oscillators.iter_mut().zip(self.modes.rows()) {
            *p += dot(row, &lam);
        }
    }

    /// What of y^T M y belongs to the body.
    pub fn body_mass(&self, y: &[f64]) -> f64 {
        let oscillators = &y[self.n_ring..];
        dot(oscillators, oscillators)
    }

    /// Displacement of the body, `[n_nodes][3]` flat; None of a rigid one.
    pub fn body_displacement(&self, y: &[f64]) -> Option<Vec<f64>> {
        let body = self.tie.body.as_ref()?;
        Some(body.moved(&self.modes.of_body, &y[self.n_ring..]))
    }
}
