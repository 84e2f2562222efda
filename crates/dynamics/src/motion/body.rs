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
use super::space::{Frame, Nodes, Space};
use super::space_defect::Matrix;
use super::vectors::combined;
use crate::division::NodePlaces;
use crate::effects::FrameTurn;
use crate::error::DynamicsError;
use crate::inventory::Inventory;
use crate::memory::MotionSizes;
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
    /// Where the nodes are.
    pub(super) places: NodePlaces,
    /// Rayleigh damping: C = damping[0] M + damping[1] K.
    pub(super) damping: [f64; 2],
    effective: Effective,
    /// Where its vectors live.
    pub space: Space,
}

impl RingBody {
    /// Assembles the ring on `side` and prepares the factorisation of its effective matrix.
    pub fn new(
        side: Side,
        ring: &RingModel,
        damping: [f64; 2],
        backend: Backend,
        frame: Frame,
    ) -> Result<RingBody, DynamicsError> {
        let mesh = &ring.mesh;
        let (coordinates, mount) = hold(mesh, side, ring);
        let (matrices, effective) = prepare(ring, side.name(), backend, &coordinates)?;
        let places = ring.places(side.name(), backend)?;
        let nodes = Nodes {
            coordinates: &coordinates,
            matrices: &matrices,
            positions: places.positions(),
        };
        let space = effective
            .space(nodes, frame)
            .map_err(|source| DynamicsError::Solver {
                side: side.name(),
                source,
            })?;
        Ok(RingBody {
            surface: RacewaySurface::new(mesh, mesh.group(RACEWAY_GROUP), ring.groove),
            rule: PressureRule::new(),
            places,
            name: side.name(),
            coordinates,
            mount,
            matrices,
            damping,
            effective,
            space,
        })
    }

    /// The effective matrix S of a step of `dt` seconds, factored.
    pub fn factor(&self, integrator: Integrator, dt: f64) -> Result<Factored, DynamicsError> {
        let [cm, ck] = self.effective_coefficients(integrator, dt);
        let factored = match (&self.effective, &self.matrices) {
            (Effective::Sparse(symbolic, _), RingMatrices::Sparse(matrices)) => matrices
                .factor(symbolic, &self.coordinates, [cm, ck])
                .map(Factored::Sparse),
            (Effective::Sectors(parts), _) => {
                let inner = parts.factor([cm, ck])?;
                let [border, corner] = self.nodes().border([cm, ck]);
                let columns = border.chunks_exact(self.coordinates.free().len().max(1));
                let entries = |(row, &value): (usize, &f64)| (value != 0.0).then_some((row, value));
                let sparse = columns.map(|column| column.iter().enumerate().filter_map(entries).collect());
                SectorBordered::new(inner, sparse.collect(), &corner)
                    .map(|solver| Factored::Sectors(Box::new(SectorFactor::new(solver, &self.mount))))
            }
            (Effective::Cyclic(harmonics), _) => {
                let border = harmonics.border([cm, ck], self.nodes());
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

    /// Factors of M and K in the effective matrix of a step of `dt` seconds.
    pub(super) fn effective_coefficients(&self, integrator: Integrator, dt: f64) -> [f64; 2] {
        let [m, c, k] = integrator.effective(dt);
        [m + c * self.damping[0], k + c * self.damping[1]]
    }

    pub(super) fn nodes(&self) -> Nodes<'_> {
        Nodes {
            coordinates: &self.coordinates,
            matrices: &self.matrices,
            positions: self.places.positions(),
        }
    }

    /// The nodes whose matrices act on the vectors of harmonic space.
    pub(super) fn regular_nodes(&self) -> Nodes<'_> {
        self.effective.regular_nodes(self.nodes())
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

    /// What its motion holds; None of a ring that harmonics do not solve.
    pub fn sizes(&self) -> Option<MotionSizes> {
        let sizes = self.effective.sizes()?;
        Some(MotionSizes {
            n_mount: self.mount.len(),
            ..sizes
        })
    }

    /// Coordinates and matrices; those of the factors are counted by the motion.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.coordinates.n(),
            matrices: self.matrices.n_matrices(),
        }
    }

    /// M x of coordinates.
    pub fn mass_product(&self, x: &[f64]) -> Vec<f64> {
        self.matrices.mass_product(&self.coordinates, x)
    }

    /// a M b or a K b of vectors of the ring's space.
    fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        let (matrices, coordinates) = (&self.matrices, &self.coordinates);
        match (&self.space, matrix) {
            (Space::Nodal, Matrix::Mass) => dot(a, &self.mass_product(b)),
            (Space::Nodal, Matrix::Stiffness) => dot(a, &matrices.stiffness_product(coordinates, b)),
            (Space::Harmonic(space), _) => space.form(matrix, a, b),
        }
    }

    /// M (m[0] v + m[1] a) + K (k[0] v + k[1] a - w) of coordinates; in harmonic space a part of [`super::pass::Pass`].
    pub(super) fn balance(&self, state: &RingState, m: [f64; 2], k: [f64; 2]) -> Vec<f64> {
        let (v, a) = (state.velocity(), state.acceleration());
        let inertial = combined(m, v, a);
        let mut elastic = combined(k, v, a);
        let terms = elastic.iter_mut().zip(state.displacement());
        terms.for_each(|(c, w)| *c -= w);
        self.matrices
            .sum_of_products(&self.coordinates, &inertial, &elastic)
    }

    /// Kinetic and strain energy, J.
    pub fn energies(&self, state: &RingState) -> [f64; 2] {
        match (&self.space, state.energies()) {
            (_, Some(known)) => known,
            (Space::Nodal, None) => {
                self.matrices
                    .energies(&self.coordinates, state.velocity(), state.displacement())
            }
            (Space::Harmonic(space), None) => space.energies(state),
        }
    }

    /// Generalised inertia load of the turning frame, of coordinates, at the weighted time of a step from `old` with the increment `dw`, in
    /// which the velocity stays when there is none; in harmonic space a part of `pass::Pass`.
    pub fn frame_load(
        &self,
        turn: FrameTurn,
        (integrator, dt): (Integrator, f64),
        old: &RingState,
        dw: Option<&[f64]>,
    ) -> Vec<f64> {
        let (speed, acceleration) = (turn.speed, turn.acceleration);
        let [w, v] = old.within(integrator, dt, dw);
        let (u, v) = (self.coordinates.expand(&w), self.coordinates.expand(&v));
        let mut field = vec![0.0; u.len()];
        // Of a ring that ranks share, the product takes the field at the nodes of own sectors only.
        for (i, place) in self.places.positions().kept() {
            let [x, y] = [0, 1].map(|c| place[c] + u[3 * i + c]);
            let (vx, vy) = (v[3 * i], v[3 * i + 1]);
            let f = &mut field[3 * i..3 * i + 3];
            f[0] = speed * speed * x + 2.0 * speed * vy + acceleration * y;
            f[1] = speed * speed * y - 2.0 * speed * vx - acceleration * x;
        }
        self.coordinates.reduce(&self.matrices.nodal_mass_product(&field))
    }

    /// Nodal values, `[n_nodes][3]` flat, of a vector of the ring's space.
    pub fn nodal(&self, x: &[f64]) -> Vec<f64> {
        match &self.space {
            Space::Nodal => self.coordinates.expand(x),
            Space::Harmonic(_) => self.coordinates.expand(&self.space.coordinates(x)),
        }
    }

    /// The same at the chosen nodes, to the bit; others may be NaN. Of harmonics only the section nodes of these are transformed.
    pub fn nodal_at(&self, x: &[f64], nodes: &[usize]) -> Vec<f64> {
        let Space::Harmonic(space) = &self.space else {
            return self.nodal(x);
        };
        let (harmonics, q) = x.split_at(space.ring.harmonic_len());
        let free = nodes.iter().filter_map(|&node| self.coordinates.free_node(node));
        let part = space.ring.section_part(&[], free);
        let found = space.ring.field_at(&part, harmonics);
        let mut field = vec![f64::NAN; self.coordinates.expanded()];
        for &node in nodes {
            let u = match self.coordinates.free_node(node) {
                Some(number) => [0, 1, 2].map(|i| found.value(3 * number + i)),
                None => self.coordinates.held_displacement(node, q),
            };
            field[3 * node..3 * node + 3].copy_from_slice(&u);
        }
        field
    }

    /// Linear momentum, kg m/s, and moment of momentum about the point z = 0 of the mesh's axis, kg m^2/s, at the
    /// undeformed places of the nodes.
    pub fn momentum(&self, state: &RingState) -> [[f64; 3]; 2] {
        let p = self.matrices.nodal_mass_product(&self.nodal(state.velocity()));
        let sums = self.places.sum(|node, x| {
            let p = &p[3 * node..3 * node + 3];
            let moment = [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                x[j] * p[k] - x[k] * p[j]
            });
            [p[0], p[1], p[2], moment[0], moment[1], moment[2]]
        });
        [[sums[0], sums[1], sums[2]], [sums[3], sums[4], sums[5]]]
    }

    /// Energy that Rayleigh damping took in a step, J: C v[1-af] times dw.
    pub fn rayleigh_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        let s = integrator.alpha_f;
        let v = combined([s, 1.0 - s], old.velocity(), new.velocity());
        let change = combined([-1.0, 1.0], old.displacement(), new.displacement());
        let [am, ak] = self.damping;
        let mut loss = 0.0;
        if am != 0.0 {
            loss += am * self.form(Matrix::Mass, &change, &v);
        }
        if ak != 0.0 {
            loss += ak * self.form(Matrix::Stiffness, &change, &v);
        }
        loss
    }

    /// Energy that the integrator took in a step, J. The balance of the step, M a[1-am] + C v[1-af] + K w[1-af] = f, times dw, is
    /// the work of f; the numerical dissipation is what of it is neither stored nor lost in C.
    pub fn numerical_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        if integrator.is_conserving() {
            return 0.0;
        }
        let change = combined([-1.0, 1.0], old.displacement(), new.displacement());
        let s = integrator.alpha_m;
        let a = combined([s, 1.0 - s], old.acceleration(), new.acceleration());
        let v = combined([0.5; 2], old.velocity(), new.velocity());
        let gain = combined([-1.0, 1.0], old.velocity(), new.velocity());
        self.form(Matrix::Mass, &change, &a) - self.form(Matrix::Mass, &v, &gain)
            + (0.5 - integrator.alpha_f) * self.form(Matrix::Stiffness, &change, &change)
    }
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
