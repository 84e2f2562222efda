//! Rings and the body to which they are tied as one vibrating body.
//!
//! Coordinates are those of the free rings, y, one after the other, then the oscillators of the body, xi
//! ([`body::BodyModes`]). Rings and body move the functions of their seats alike, Phi y = V^T xi. With forces lam of
//! the joints on the rings and S = K + s M of the rings alone, loads f and p are answered by
//!
//! ```text
//! y  = S^-1 (f + Phi^T lam),     xi = (p - V lam) / (omega^2 + s)
//! (A + D) lam = V^T (p / (omega^2 + s)) - Phi S^-1 f,     A = Phi S^-1 Phi^T,   D = V diag(1 / (omega^2 + s)) V^T
//! ```
//!
//! S and A have a block for each ring; D couples the seats of one body.
//!
//! Cost: once a solve of each ring per function, then two solves per load instead of one. No column is kept.

use std::ops::Range;
use std::sync::Arc;

use body::{SeatFunctions, SeatModes, SeatTie};
use dense::{DenseCholesky, linear_combinations};
use rayon::prelude::*;
use solver::LinearSolver;

use crate::error::RingError;
use crate::mount::MountRows;
use crate::sparse::fill;
use crate::vectors::{dot, rows_of};

/// Functions whose columns are solved at a time.
const AT_A_TIME: usize = 32;

/// The seat of a vibrating ring as no body is tied to it; rings that are alike share it.
pub(crate) struct VibratingSeat {
    /// Phi in the coordinates of the ring.
    mount: MountRows,
    /// Coordinates of the ring.
    n_ring: usize,
    /// A, `[n][n]` flat.
    softness: Vec<f64>,
}

impl VibratingSeat {
    /// The seat of a ring with `n_ring` coordinates, whose K + s M is factored.
    pub fn new(functions: &SeatFunctions, (ring, n_ring): (&dyn LinearSolver, usize)) -> VibratingSeat {
        let mount = MountRows::of_seat(functions);
        let n = mount.len();
        let mut softness = Vec::with_capacity(n * n);
        for rows in mount.rows.chunks(AT_A_TIME) {
            let mut columns = vec![0.0; n_ring * rows.len()];
            fill(&mut columns, rows, n_ring);
            ring.solve(&mut columns, rows.len());
            softness.extend(columns.chunks_exact(n_ring).flat_map(|y| mount.measure(y)));
        }
        VibratingSeat {
            mount,
            n_ring,
            softness,
        }
    }
}

/// The joint of a vibrating ring with its seat.
pub(crate) struct VibratingJoint {
    tie: Arc<SeatTie>,
    modes: SeatModes,
    ring: Arc<VibratingSeat>,
}

impl VibratingJoint {
    /// The joint of a ring.
    pub fn new(tie: &Arc<SeatTie>, ring: Arc<VibratingSeat>) -> VibratingJoint {
        let modes = tie.modes.clone();
        VibratingJoint {
            tie: tie.clone(),
            modes: modes.expect("the modes of a body are found before its ring vibrates"),
            ring,
        }
    }

    /// The joint.
    pub fn tie(&self) -> &SeatTie {
        &self.tie
    }

    /// How the oscillators of its body are seen from here.
    pub fn modes(&self) -> &SeatModes {
        &self.modes
    }
}

/// The joints of vibrating rings with a body, and that body.
pub(crate) struct VibratingTie {
    joints: Vec<VibratingJoint>,
    /// Motion of the functions of all joints by unit oscillators, `[n_oscillators][n]` flat.
    rows: Vec<f64>,
    /// omega^2 + s of the oscillators.
    effective: Vec<f64>,
    /// A + D.
    joint: DenseCholesky,
    /// Phi Phi^T + V^T V.
    gram: DenseCholesky,
}

impl VibratingTie {
    /// The joints of one body.
    pub fn new(joints: Vec<VibratingJoint>, shift: f64) -> Result<VibratingTie, RingError> {
        let failed = |source| RingError::Tie { source };
        let modes = &joints[0].modes;
        let effective: Vec<f64> = modes.squares().iter().map(|square| square + shift).collect();
        let of_joints: Vec<Vec<&[f64]>> = joints.iter().map(|joint| joint.modes.rows().collect()).collect();
        let mut rows = Vec::new();
        for i in 0..modes.n() {
            of_joints.iter().for_each(|own| rows.extend_from_slice(own[i]));
        }
        let n: usize = joints.iter().map(|joint| joint.ring.mount.len()).sum();
        let with_body = |block: &dyn Fn(&VibratingJoint) -> Vec<f64>, effective: &[f64]| {
            let mut sum = vec![0.0; n * n];
            for (joint, own) in joints.iter().zip(functions_of(&joints)) {
                let block = block(joint);
                for (row, values) in own.clone().zip(block.chunks_exact(own.len())) {
                    sum[n * row..][own.clone()].copy_from_slice(values);
                }
            }
            // A rigid body gives nothing.
            let of_body = softness(&rows, effective, n);
            sum.iter_mut().zip(of_body).for_each(|(s, d)| *s += d);
            sum
        };
        let joint = with_body(&|joint| joint.ring.softness.clone(), &effective);
        let gram = with_body(&|joint| joint.ring.mount.gram(), &vec![1.0; modes.n()]);
        Ok(VibratingTie {
            joint: DenseCholesky::factor(n, &joint).map_err(failed)?,
            gram: DenseCholesky::factor(n, &gram).map_err(failed)?,
            joints,
            rows,
            effective,
        })
    }

    /// Number of oscillators.
    pub fn n_oscillators(&self) -> usize {
        self.effective.len()
    }

    /// The joints, in the order of the rings.
    pub fn joints(&self) -> &[VibratingJoint] {
        &self.joints
    }

    /// Coordinates of all rings.
    fn n_rings(&self) -> usize {
        self.joints.iter().map(|joint| joint.ring.n_ring).sum()
    }

    fn n(&self) -> usize {
        self.n_rings() + self.n_oscillators()
    }

    /// Row of an oscillator over the functions of all joints; empty for a rigid body.
    fn row(&self, oscillator: usize) -> &[f64] {
        let n = self.rows.len() / self.n_oscillators();
        &self.rows[n * oscillator..n * (oscillator + 1)]
    }

    /// Oscillators of a block of vectors times a factor of their omega^2, behind what the rings have.
    pub fn joined(&self, rings: &[f64], y: &[f64], factor: impl Fn(f64) -> f64) -> Vec<f64> {
        let (n_rings, squares) = (self.n_rings(), self.joints[0].modes.squares());
        let mut all = Vec::with_capacity(y.len());
        for (rings, y) in rings.chunks_exact(n_rings).zip(y.chunks_exact(self.n())) {
            all.extend_from_slice(rings);
            let oscillators = squares.iter().zip(&y[n_rings..]);
            all.extend(oscillators.map(|(square, xi)| factor(*square) * xi));
        }
        all
    }

    /// (K + s M)^-1 of a block of loads with the factors of the rings alone.
    pub fn solve(&self, rings: &[&dyn LinearSolver], loads: &mut [f64]) {
        let (n, n_rings) = (self.n(), self.n_rings());
        let mut forces = rows_of(loads, n, &(0..n_rings));
        let moved = self.solved(rings, &forces);
        let of_rings = forces.chunks_exact_mut(n_rings).zip(moved.chunks_exact(n_rings));
        for (load, (force, moved)) in loads.chunks_exact_mut(n).zip(of_rings) {
            let oscillators = &mut load[n_rings..];
            let free: Vec<f64> = oscillators
                .iter()
                .zip(&self.effective)
                .map(|(p, s)| p / s)
                .collect();
            let mut lam = self.gap(moved, &free);
            lam.iter_mut().for_each(|gap| *gap = -*gap);
            self.joint.solve(&mut lam, 1);
            self.add_loads(&lam, 1.0, force);
            for (i, (xi, free)) in oscillators.iter_mut().zip(free).enumerate() {
                *xi = free - dot(self.row(i), &lam) / self.effective[i];
            }
        }
        let forces = self.solved(rings, &forces);
        for (load, y) in loads.chunks_exact_mut(n).zip(forces.chunks_exact(n_rings)) {
            load[..n_rings].copy_from_slice(y);
        }
    }

    /// S^-1 of a block of loads on all rings.
    fn solved(&self, rings: &[&dyn LinearSolver], loads: &[f64]) -> Vec<f64> {
        if let [ring] = rings {
            let mut all = loads.to_vec();
            ring.solve(&mut all, loads.len() / self.n_rings());
            return all;
        }
        let n_rings = self.n_rings();
        let places: Vec<Range<usize>> = places_of(&self.joints);
        let of_ring = |(ring, place): (&&dyn LinearSolver, &Range<usize>)| {
            let mut own = rows_of(loads, n_rings, place);
            ring.solve(&mut own, loads.len() / n_rings);
            own
        };
        let solved: Vec<Vec<f64>> = rings.par_iter().zip(&places).map(of_ring).collect();
        let mut all = loads.to_vec();
        for (own, place) in solved.iter().zip(&places) {
            for (y, own) in all.chunks_exact_mut(n_rings).zip(own.chunks_exact(place.len())) {
                y[place.clone()].copy_from_slice(own);
            }
        }
        all
    }

    /// Adds forces lam on the functions, times a factor, to loads of the rings.
    fn add_loads(&self, lam: &[f64], factor: f64, rings: &mut [f64]) {
        let places = places_of(&self.joints)
            .into_iter()
            .zip(functions_of(&self.joints));
        for (joint, (place, own)) in self.joints.iter().zip(places) {
            let ring = &mut rings[place];
            joint
                .ring
                .mount
                .loads(&lam[own])
                .for_each(|(i, f)| ring[i] += factor * f);
        }
    }

    /// Phi y - V^T xi.
    fn gap(&self, rings: &[f64], oscillators: &[f64]) -> Vec<f64> {
        let mut gap = Vec::new();
        for (joint, place) in self.joints.iter().zip(places_of(&self.joints)) {
            let mut own = joint.ring.mount.measure(&rings[place]);
            let of_body = joint.modes.motion(oscillators);
            own.iter_mut().zip(of_body).for_each(|(g, y)| *g -= y);
            gap.extend(own);
        }
        gap
    }

    /// Takes the forces of the joints out of a vector of forces: what is orthogonal to all of them stays.
    pub fn remove_reactions(&self, force: &mut [f64]) {
        let (rings, oscillators) = force.split_at_mut(self.n_rings());
        let mut lam = self.gap(rings, oscillators);
        self.gram.solve(&mut lam, 1);
        self.add_loads(&lam, -1.0, rings);
        for (i, p) in oscillators.iter_mut().enumerate() {
            *p += dot(self.row(i), &lam);
        }
    }

    /// What of y^T M y belongs to the body.
    pub fn body_mass(&self, y: &[f64]) -> f64 {
        let oscillators = &y[self.n_rings()..];
        dot(oscillators, oscillators)
    }

    /// Displacement of the body, `[n_nodes][3]` flat, in the frame of its first seat's bearing; None of a rigid one.
    pub fn body_displacement(&self, y: &[f64]) -> Option<Vec<f64>> {
        let joint = &self.joints[0];
        let body = joint.tie.body.as_ref()?;
        Some(body.moved(&joint.modes.of_body, &y[self.n_rings()..]))
    }
}

/// Coordinates of the ring of each joint.
fn places_of(joints: &[VibratingJoint]) -> Vec<Range<usize>> {
    one_by_one(joints.iter().map(|joint| joint.ring.n_ring))
}

/// Numbers of the functions of each joint among those of all.
fn functions_of(joints: &[VibratingJoint]) -> Vec<Range<usize>> {
    one_by_one(joints.iter().map(|joint| joint.ring.mount.len()))
}

fn one_by_one(lengths: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let mut first = 0;
    let next = |length: usize| {
        first += length;
        first - length..first
    };
    lengths.map(next).collect()
}

/// D = V diag(1/s) V^T of `n` functions, `[n][n]` flat; rows of V by oscillator.
fn softness(rows: &[f64], effective: &[f64], n: usize) -> Vec<f64> {
    let n_oscillators = effective.len();
    if n_oscillators == 0 {
        return vec![0.0; n * n];
    }
    let over = |j: usize| {
        let row = rows.iter().skip(j).step_by(n).zip(effective);
        row.map(|(v, s)| v / s)
    };
    let over: Vec<f64> = (0..n).flat_map(over).collect();
    linear_combinations(n, rows, n_oscillators, &over, n)
}
