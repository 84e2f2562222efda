//! One flexible ring as a moving body: its coordinates, matrices and mount; energies, losses, inertia of its frame.
//!
//! **Mount.** The ring's partner (shaft or housing) meets it in a few *functionals* of the coordinates, the rigid motion of
//! its bore or seat: for a clamped bore the five shaft dofs that carry it, which are coordinates; for a mean-motion
//! hold the six rows B of the area-weighted rigid motion, w stays free. Forces of the partner act through the same
//! functionals. A clamped seat has none: its nodes are held. Cost: K (nnz entries) and the scalar node mass.

use contact::quadrature::PressureRule;
use contact::{RacewaySurface, Side};
use mesh::Mesh;
use solver::SectorBordered;

use super::by_sector::SectorFactor;
use super::coordinates::Coordinates;
use super::effective::{Effective, Factored, prepare};
use super::integrator::Integrator;
use super::matrices::RingMatrices;
use super::ring::RingState;
use crate::effects::FrameTurn;
use crate::error::DynamicsError;
use crate::inventory::Inventory;
use crate::model::{Backend, Hold, RACEWAY_GROUP, RingModel};
use crate::solution::dot;
use crate::sparse::SparseLoad;
use crate::support::mean_motion;

/// A ring's matrices, raceway and mount.
pub struct RingBody {
    /// Coordinates of the ring.
    pub coordinates: Coordinates,
    /// Raceway in (azimuth, groove angle).
    pub surface: RacewaySurface,
    /// Integration rule of the patches.
    pub rule: PressureRule,
    /// Functionals of the mount: translations, tilts, and for a mean-motion hold the rotation about z.
    pub mount: Vec<SparseLoad>,
    /// `inner` or `outer`.
    pub name: &'static str,
    pub(super) matrices: RingMatrices,
    /// Node positions, m, `[n_nodes][3]` flat.
    positions: Vec<f64>,
    /// Rayleigh damping: C = damping[0] M + damping[1] K.
    pub(super) damping: [f64; 2],
    effective: Effective,
}

impl RingBody {
    /// Assembles the ring on `side` and prepares the factorisation of its effective matrix.
    pub fn new(
        side: Side,
        ring: &RingModel,
        damping: [f64; 2],
        backend: Backend,
    ) -> Result<RingBody, DynamicsError> {
        let mesh = &ring.mesh;
        let (coordinates, mount) = hold(mesh, side, ring);
        let (matrices, effective) = prepare(ring, side.name(), backend, &coordinates)?;
        Ok(RingBody {
            surface: RacewaySurface::new(mesh, mesh.group(RACEWAY_GROUP), ring.groove),
            rule: PressureRule::new(),
            positions: mesh.nodes.concat(),
            name: side.name(),
            coordinates,
            mount,
            matrices,
            damping,
            effective,
        })
    }

    /// The effective matrix S of a step of `dt` seconds, factored.
    pub fn factor(&self, integrator: Integrator, dt: f64) -> Result<Factored, DynamicsError> {
        let [m, c, k] = integrator.effective(dt);
        let (cm, ck) = (m + c * self.damping[0], k + c * self.damping[1]);
        let factored = match (&self.effective, &self.matrices) {
            (Effective::Sparse(symbolic, _), RingMatrices::Sparse(matrices)) => matrices
                .factor(symbolic, &self.coordinates, [cm, ck])
                .map(Factored::Sparse),
            (Effective::Sectors(parts), _) => {
                let inner = parts.factor([cm, ck])?;
                let [border, corner] = self.border([cm, ck]);
                let columns = border.chunks_exact(self.coordinates.free().len().max(1));
                let entries = |(row, &value): (usize, &f64)| (value != 0.0).then_some((row, value));
                let sparse = columns.map(|column| column.iter().enumerate().filter_map(entries).collect());
                SectorBordered::new(inner, sparse.collect(), &corner)
                    .map(|solver| Factored::Sectors(Box::new(SectorFactor::new(solver, &self.mount))))
            }
            (Effective::Cyclic(harmonics), _) => {
                let border = self.border([cm, ck]);
                let n_free = self.coordinates.free().len();
                let mounted = self.mount.iter().flatten().map(|&(i, _)| i);
                let nodes = mounted.filter(|&i| i < n_free).map(|i| i / 3);
                harmonics.factor([cm, ck], border, nodes)
            }
            (Effective::Sparse(..), _) => {
                unreachable!("a sparse factor comes with sparse matrices")
            }
        };
        factored.map_err(|source| DynamicsError::Solver {
            side: self.name,
            source,
        })
    }

    /// Columns of c_M M + c_K K that belong to the shaft dofs: the rows of the free dofs, column-major, and those of the
    /// shaft, row-major.
    fn border(&self, [cm, ck]: [f64; 2]) -> [Vec<f64>; 2] {
        let (n_free, n) = (self.coordinates.free().len(), self.coordinates.n());
        let (mut border, mut corner) = (Vec::new(), Vec::new());
        for k in n_free..n {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            let [m, k] = [cm, ck].map(|c| unit.iter().map(|x| c * x).collect::<Vec<f64>>());
            let column = self.matrices.sum_of_products(&self.coordinates, &m, &k);
            border.extend_from_slice(&column[..n_free]);
            corner.extend_from_slice(&column[n_free..]);
        }
        [border, corner]
    }

    /// Whether S has a border: shaft dofs among the coordinates.
    pub fn is_bordered(&self) -> bool {
        !self.coordinates.shaft().0.is_empty()
    }

    /// The ring's linear solver and why it is that one, for a log.
    pub fn solver_note(&self) -> String {
        self.effective.note()
    }

    /// Name of the ring's linear solver.
    pub fn solver_name(&self) -> &'static str {
        self.effective.name()
    }

    /// Coordinates and matrices; those of the factors are counted by the motion.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.coordinates.n(),
            matrices: self.matrices.n_matrices(),
        }
    }

    /// M x of coordinates, `[n]`.
    pub fn mass_product(&self, x: &[f64]) -> Vec<f64> {
        self.matrices.mass_product(&self.coordinates, x)
    }

    /// K x of coordinates, `[n]`.
    pub fn stiffness_product(&self, x: &[f64]) -> Vec<f64> {
        self.matrices.stiffness_product(&self.coordinates, x)
    }

    /// Kinetic and strain energy, J.
    pub fn energies(&self, state: &RingState) -> [f64; 2] {
        self.matrices.energies(&self.coordinates, &state.v, &state.w)
    }

    /// Generalised inertia load of the turning frame at displacement `w` and velocity `v` of the coordinates.
    pub fn frame_load(&self, turn: FrameTurn, w: &[f64], v: &[f64]) -> Vec<f64> {
        let (speed, acceleration) = (turn.speed, turn.acceleration);
        let (u, v) = (self.coordinates.expand(w), self.coordinates.expand(v));
        let mut field = vec![0.0; u.len()];
        for (i, f) in field.chunks_exact_mut(3).enumerate() {
            let [x, y] = [0, 1].map(|c| self.positions[3 * i + c] + u[3 * i + c]);
            let (vx, vy) = (v[3 * i], v[3 * i + 1]);
            f[0] = speed * speed * x + 2.0 * speed * vy + acceleration * y;
            f[1] = speed * speed * y - 2.0 * speed * vx - acceleration * x;
        }
        self.coordinates.reduce(&self.matrices.nodal_mass_product(&field))
    }

    /// Linear momentum, kg m/s, and moment of momentum about the point z = 0 of the mesh's axis, kg m^2/s, at the
    /// undeformed places of the nodes.
    pub fn momentum(&self, state: &RingState) -> [[f64; 3]; 2] {
        let p = self
            .matrices
            .nodal_mass_product(&self.coordinates.expand(&state.v));
        let mut sums = [[0.0; 3]; 2];
        for (x, p) in self.positions.chunks_exact(3).zip(p.chunks_exact(3)) {
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sums[0][i] += p[i];
                sums[1][i] += x[j] * p[k] - x[k] * p[j];
            }
        }
        sums
    }

    /// Energy that Rayleigh damping took in a step, J: C v[1-af] times dw.
    pub fn rayleigh_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        let v = weighted(integrator.alpha_f, &old.v, &new.v);
        let change = difference(&old.w, &new.w);
        let [am, ak] = self.damping;
        let mut loss = 0.0;
        if am != 0.0 {
            loss += am * dot(&change, &self.mass_product(&v));
        }
        if ak != 0.0 {
            loss += ak * dot(&change, &self.stiffness_product(&v));
        }
        loss
    }

    /// Energy that the integrator took in a step, J. The balance of the step, M a[1-am] + C v[1-af] + K w[1-af] = f, times dw, is
    /// the work of f; the numerical dissipation is what of it is neither stored nor lost in C.
    pub fn numerical_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        if integrator.is_conserving() {
            return 0.0;
        }
        let change = difference(&old.w, &new.w);
        let a = weighted(integrator.alpha_m, &old.a, &new.a);
        let v = weighted(0.5, &old.v, &new.v);
        let gain = difference(&old.v, &new.v);
        dot(&change, &self.mass_product(&a)) - dot(&v, &self.mass_product(&gain))
            + (0.5 - integrator.alpha_f) * dot(&change, &self.stiffness_product(&change))
    }
}

/// s x0 + (1 - s) x1.
fn weighted(s: f64, x0: &[f64], x1: &[f64]) -> Vec<f64> {
    x0.iter().zip(x1).map(|(a, b)| s * a + (1.0 - s) * b).collect()
}

/// x1 - x0.
fn difference(x0: &[f64], x1: &[f64]) -> Vec<f64> {
    x0.iter().zip(x1).map(|(a, b)| b - a).collect()
}

/// Coordinates and mount of a held ring.
fn hold(mesh: &Mesh, side: Side, ring: &RingModel) -> (Coordinates, Vec<SparseLoad>) {
    let origin = ring.groove.centre_z;
    match (ring.hold, side) {
        (Hold::Clamped, Side::Inner) => {
            let held = mesh.group_nodes(ring.held_group);
            let coordinates = Coordinates::new(mesh, &held, vec![0, 1, 2, 3, 4], origin);
            let first = coordinates.free().len();
            (coordinates, (0..5).map(|k| vec![(first + k, 1.0)]).collect())
        }
        (Hold::Clamped, Side::Outer) => {
            let held = mesh.group_nodes(ring.held_group);
            (Coordinates::new(mesh, &held, Vec::new(), origin), Vec::new())
        }
        (Hold::MeanMotion, _) => {
            let weights = fem::facet_node_weights(mesh, mesh.group(ring.held_group));
            let rows = mean_motion(mesh, weights, origin);
            (Coordinates::new(mesh, &[], Vec::new(), origin), rows.to_vec())
        }
        (Hold::Free, _) => (Coordinates::new(mesh, &[], Vec::new(), origin), Vec::new()),
    }
}
