//! One elastic ring as a moving body: its coordinates, matrices and mount; energies, losses, inertia of its frame.
//!
//! **Mount.** The ring's partner (shaft or housing) meets it in a few *functionals* of the coordinates, the rigid
//! motion of its bore or seat: for a clamped bore the five shaft dofs that carry it, which are coordinates; for a
//! mean-motion hold the six rows B of the area-weighted rigid motion, w stays free. Forces of the partner act through
//! the same functionals. A clamped seat has none: its nodes are held.
//!
//! **Vectors.** Displacements, velocities, loads of a body are vectors of its own kind: coordinates, or harmonics of
//! a periodic ring. Only the body knows which. Of harmonics that ranks share, each rank has its own; rank 0 gets all of
//! a vector where results ask for it ([`ElasticBody::to_root`]).

use std::sync::Arc;

use body::BesideRing;
use contact::cross;
use solver::cyclic::Definite;

use crate::coordinates::{Coordinates, RIGID_MOTIONS};
use crate::division::NodePlaces;
use crate::error::RingError;
use crate::integrator::Integrator;
use crate::integrator::StepScheme;
use crate::inventory::Inventory;
use crate::matrices::{Matrix, NodalMatrices, Nodes};
use crate::memory::MotionMemory;
use crate::model::{Backend, Hold, RingModel};
use crate::mount::MountRows;
use crate::oscillators::Oscillators;
use crate::sparse::{SparseLoad, sparse_dot};
use crate::state::RingState;
use crate::step::{FrameTurn, StepFactor};
use crate::support::mean_motion;
use crate::vectors::combined;

/// The rigid body that holds a ring: shaft or housing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partner {
    /// Which of its dofs x, y, z, tilt x, tilt y move: coordinates of a clamped ring.
    pub moves: [bool; 5],
}

impl Partner {
    /// A shaft, which may move in all of them.
    pub const SHAFT: Partner = Partner { moves: [true; 5] };
    /// A housing that does not move.
    pub const AT_REST: Partner = Partner { moves: [false; 5] };

    /// Dofs that move, ascending.
    pub fn moving(&self) -> Vec<usize> {
        (0..5).filter(|&dof| self.moves[dof]).collect()
    }
}

/// How a ring is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// How its surface follows.
    pub hold: Hold,
    /// What it follows.
    pub partner: Partner,
}

impl Held {
    /// Number of functionals of the mount.
    pub(crate) fn n_mount(&self) -> usize {
        match self.hold {
            Hold::Clamped => self.partner.moving().len(),
            Hold::MeanMotion => 6,
            Hold::Free => 0,
        }
    }
}

/// Whether the inertia of a ring's turning frame acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// It does not.
    Still,
    /// It does.
    Turning,
    /// It does, and the stress of the turning ring stiffens it ([`crate::expansion`]).
    Stiffened,
}

/// A ring as it is held and damped.
pub struct HeldRing {
    /// `inner` or `outer`.
    pub name: &'static str,
    /// Coordinates of the ring.
    pub coordinates: Coordinates,
    /// Functionals of the mount: translations, tilts, and for a mean-motion hold the rotation about z.
    pub mount: MountRows,
    /// Where the nodes are.
    pub places: NodePlaces,
    /// Rayleigh damping: C = a M + b K with `[a, b]`.
    pub damping: [f64; 2],
}

/// Vectors of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RingShape {
    /// Length of each, of all ranks together.
    pub length: usize,
    /// What they are: `coordinates` or `harmonics`.
    pub kind: &'static str,
    /// Oscillators of a body to which the ring is tied.
    pub oscillators: usize,
}

/// An elastic ring with its linear solver.
pub trait ElasticBody: Send + Sync {
    /// How it is held.
    fn held(&self) -> &HeldRing;

    /// Its matrices in coordinates.
    fn matrices(&self) -> &dyn NodalMatrices;

    /// Name of the linear solver, as a scene has it.
    fn solver_name(&self) -> &'static str;

    /// The linear solver and why it is that one, for a log.
    fn solver_note(&self) -> String;

    /// Forecast of the memory of its motion; None of a ring in sectors.
    fn memory(&self) -> Option<MotionMemory>;

    /// What its vectors are.
    fn shape(&self) -> RingShape;

    /// The vector with the coordinates `y`.
    fn of_coordinates(&self, y: Vec<f64>) -> Vec<f64>;

    /// The same of a state of the ring: rows that only a regular ring has move as its statics has them.
    fn state_of_coordinates(&self, y: Vec<f64>) -> Vec<f64>;

    /// Coordinates of a vector. Collective.
    fn coordinates(&self, x: &[f64]) -> Vec<f64>;

    /// Nodal values, `[n_nodes][3]` flat, of a vector. Collective.
    fn nodal(&self, x: &[f64]) -> Vec<f64> {
        self.held().coordinates.expand(&self.coordinates(x))
    }

    /// Whether each rank has a part of a vector only.
    fn is_divided(&self) -> bool {
        false
    }

    /// All of a vector, on rank 0 and where each rank has all of it; None elsewhere. Collective.
    fn to_root(&self, x: &[f64]) -> Option<Vec<f64>> {
        Some(x.to_vec())
    }

    /// The vector of this rank that is all of a vector on all ranks together.
    fn own(&self, whole: Vec<f64>) -> Vec<f64> {
        whole
    }

    /// Nodal values, `[n_nodes][3]` flat, of all of a vector; by this rank alone.
    fn nodal_of_whole(&self, whole: &[f64]) -> Vec<f64> {
        self.nodal(whole)
    }

    /// The same at the chosen nodes, to the bit; others may be NaN.
    fn nodal_at(&self, whole: &[f64], nodes: &[usize]) -> Vec<f64>;

    /// a A b of a matrix A; 0 with that of the stress where it does not stiffen the ring.
    fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64;

    /// Kinetic and strain energy, J.
    fn energies(&self, state: &RingState) -> [f64; 2];

    /// Whether all natural frequencies of the ring, whose partner is at rest, are above one, rad/s; unknown where that
    /// takes a search. Collective.
    fn vibrates_above(&self, _frequency: f64) -> Result<Definite, RingError> {
        Ok(Definite::Unknown)
    }

    /// The body to which the ring is tied, if there is one.
    fn tied(&self) -> Option<&Oscillators> {
        None
    }

    /// The effective matrix of a scheme, factored. Collective.
    fn step_factor(self: Arc<Self>, scheme: StepScheme) -> Result<Box<dyn StepFactor>, RingError>;
}

impl HeldRing {
    /// A ring that is held in this way, without damping.
    pub(crate) fn new(
        name: &'static str,
        ring: &RingModel,
        how: Held,
        backend: Backend,
    ) -> Result<HeldRing, RingError> {
        let (coordinates, mount) = hold(ring, how);
        Ok(HeldRing {
            name,
            coordinates,
            mount: MountRows::new(mount),
            places: ring.places(name, backend)?,
            damping: [0.0; 2],
        })
    }

    /// Factors of M and K in the effective matrix of a step.
    pub(crate) fn effective(&self, StepScheme { integrator, dt }: StepScheme) -> [f64; 2] {
        let [m, c, k] = integrator.effective(dt);
        [m + c * self.damping[0], k + c * self.damping[1]]
    }

    /// Factors of v and a under M, and under K, on the right-hand side.
    pub(crate) fn history(&self, StepScheme { integrator, dt }: StepScheme) -> [[f64; 2]; 2] {
        let [mass, damping] = integrator.history(dt);
        let [am, ak] = self.damping;
        [
            [mass[0] + am * damping[0], mass[1] + am * damping[1]],
            [ak * damping[0], ak * damping[1]],
        ]
    }

    /// The displacement `w`, of coordinates, less the rigid motion of the ring's partner. That strains nothing; in the
    /// energy of total displacements it would leave its round-off, which is large beside the energy of small loads.
    /// Collective.
    pub(crate) fn without_rigid_motion(&self, w: &[f64]) -> Vec<f64> {
        let mut strained = w.to_vec();
        let (shaft, first) = self.coordinates.shaft();
        let mut q = [0.0; RIGID_MOTIONS];
        for (k, row) in self.mount.rigid().iter().enumerate() {
            q[shaft.get(k).copied().unwrap_or(k)] = sparse_dot(row, w);
        }
        if q == [0.0; RIGID_MOTIONS] {
            return strained;
        }
        let rigid = self.places.field(|x| self.coordinates.whole_rigid_motion(x, q));
        let free = strained.iter_mut().zip(self.coordinates.free());
        free.for_each(|(w, &dof)| *w -= rigid[dof]);
        let of_shaft = strained[first..].iter_mut().zip(shaft);
        of_shaft.for_each(|(w, &dof)| *w -= q[dof]);
        strained
    }

    /// What harmonics take of the matrices.
    pub(crate) fn nodes<'a>(&'a self, matrices: &'a dyn NodalMatrices) -> Nodes<'a> {
        Nodes {
            coordinates: &self.coordinates,
            matrices,
            positions: self.places.positions(),
        }
    }

    /// Whether S has a border: shaft dofs among the coordinates.
    pub(crate) fn is_bordered(&self) -> bool {
        !self.coordinates.shaft().0.is_empty()
    }
}

impl dyn ElasticBody + '_ {
    /// Number of generalised coordinates.
    pub fn n(&self) -> usize {
        self.held().coordinates.n()
    }

    /// A state of which rank 0 has all, where ranks have parts of vectors; others keep theirs. Collective.
    pub fn state_to_root(&self, state: RingState) -> RingState {
        state.with_vectors(|x| self.to_root(&x).unwrap_or(x))
    }

    /// This rank's part of a state of which each rank has all.
    pub fn own_state(&self, whole: RingState) -> RingState {
        whole.with_vectors(|x| self.own(x))
    }

    /// The vector of a nodal load, `[n_nodes][3]` flat.
    pub fn load(&self, nodal: &[f64]) -> Vec<f64> {
        self.of_coordinates(self.held().coordinates.reduce(nodal))
    }

    /// Coordinates and matrices; those of the factors are counted by the motion.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.n(),
            matrices: self.matrices().n_matrices(),
        }
    }

    /// Linear momentum, kg m/s, and moment of momentum about the point z = 0 of the mesh's axis, kg m^2/s.
    pub fn momentum(&self, state: &RingState) -> [[f64; 3]; 2] {
        let p = self.matrices().nodal_mass_product(&self.nodal(state.velocity()));
        resultant(&self.held().places, Some(&self.nodal(state.displacement())), &p)
    }

    /// Energy that Rayleigh damping took in a step, J: C v[1-af] times dw.
    pub fn rayleigh_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        let s = integrator.alpha_f;
        let v = combined([s, 1.0 - s], old.velocity(), new.velocity());
        let change = combined([-1.0, 1.0], old.displacement(), new.displacement());
        let [am, ak] = self.held().damping;
        let mut loss = 0.0;
        if am != 0.0 {
            loss += am * self.form(Matrix::Mass, &change, &v);
        }
        if ak != 0.0 {
            loss += ak * self.form(Matrix::Stiffness, &change, &v);
        }
        let of_body = |body: &Oscillators| body.rayleigh_loss(integrator, self.held().damping, [old, new]);
        self.tied().map_or(loss, |body| loss + of_body(body))
    }

    /// Energy that the integrator took in a step, J. The balance of the step, M a[1-am] + C v[1-af] + K w[1-af] = f,
    /// times dw, is the work of f; the numerical dissipation is what of it is neither stored nor lost in C.
    pub fn numerical_loss(&self, integrator: Integrator, old: &RingState, new: &RingState) -> f64 {
        if integrator.is_conserving() {
            return 0.0;
        }
        let change = combined([-1.0, 1.0], old.displacement(), new.displacement());
        let s = integrator.alpha_m;
        let a = combined([s, 1.0 - s], old.acceleration(), new.acceleration());
        let v = combined([0.5; 2], old.velocity(), new.velocity());
        let gain = combined([-1.0, 1.0], old.velocity(), new.velocity());
        let loss = self.form(Matrix::Mass, &change, &a) - self.form(Matrix::Mass, &v, &gain)
            + (0.5 - integrator.alpha_f) * self.form(Matrix::Stiffness, &change, &change);
        let of_body = |body: &Oscillators| body.numerical_loss(integrator, [old, new]);
        self.tied().map_or(loss, |body| loss + of_body(body))
    }

    /// State of a ring: elastic nodal displacements `[n_dofs]` plus the rigid motion `q`, with the velocity of
    /// another rigid motion `rate`, both in its own frame. What is `acting` acts on its body besides the ring. A
    /// body on the shaft stands in space with its ring while the frame turns with `speed`, rad/s.
    pub fn rigid_state(
        &self,
        (elastic, acting): (&[f64], BesideRing<'_>),
        [q, rate]: [[f64; 5]; 2],
        speed: f64,
    ) -> RingState {
        let held = self.held();
        let coordinates = &held.coordinates;
        let (dofs, first) = coordinates.shaft();
        let field = |q: [f64; 5]| {
            let mut y = vec![0.0; coordinates.n()];
            let rigid = held
                .places
                .field(|x| [0, 1, 2].map(|component| coordinates.rigid_motion(component, x, q)));
            for (y, &dof) in y.iter_mut().zip(coordinates.free()) {
                *y = rigid[dof];
            }
            dofs.iter()
                .enumerate()
                .for_each(|(k, &dof)| y[first + k] = q[dof]);
            y
        };
        let mut w = field(q);
        coordinates
            .free()
            .iter()
            .enumerate()
            .for_each(|(i, &dof)| w[i] += elastic[dof]);
        let mut v = field(rate);
        let body = self.tied().map(|body| match body.on_shaft() {
            Some(_) => body.at_rest(elastic, acting, ([q, rate], speed)),
            None => body.at_rest(&coordinates.expand(&w), acting, ([[0.0; 5]; 2], 0.0)),
        });
        if self.tied().is_some_and(|body| body.on_shaft().is_some()) {
            let turned = |dof: usize| match dof % 3 {
                0 => speed * elastic[dof + 1],
                1 => -speed * elastic[dof - 1],
                _ => 0.0,
            };
            let free = v.iter_mut().zip(coordinates.free());
            free.for_each(|(v, &dof)| *v += turned(dof));
        }
        let [w, v] = [w, v].map(|y| self.state_of_coordinates(y));
        let a = vec![0.0; w.len()];
        RingState::new(w, v, a).with_body(body)
    }
}

/// Sum of nodal vectors `f`, and of their moments about the point z = 0 of the mesh's axis, at nodes that have moved by
/// `w`. Collective.
pub(crate) fn resultant(places: &NodePlaces, w: Option<&[f64]>, f: &[f64]) -> [[f64; 3]; 2] {
    let sums = places.sum(|node, x| {
        let at = |c: usize| w.map_or(0.0, |w| w[3 * node + c]);
        let f = [0, 1, 2].map(|c| f[3 * node + c]);
        let [mx, my, mz] = cross([0, 1, 2].map(|c| x[c] + at(c)), f);
        [f[0], f[1], f[2], mx, my, mz]
    });
    [[sums[0], sums[1], sums[2]], [sums[3], sums[4], sums[5]]]
}

/// Generalised inertia load of a turning frame, of coordinates, at displacement and velocity `w` and `v`, less what the
/// stress of the turning ring holds against `w`.
pub(crate) fn frame_load(
    held: &HeldRing,
    matrices: &dyn NodalMatrices,
    turn: FrameTurn,
    [w, v]: [Vec<f64>; 2],
) -> Vec<f64> {
    let (u, v) = (held.coordinates.expand(&w), held.coordinates.expand(&v));
    let field = frame_inertia(held, turn, [&u, &v]);
    let mut load = matrices.nodal_mass_product(&field);
    if let Some(stress) = matrices.nodal_stress_product(&u) {
        load.iter_mut()
            .zip(&stress)
            .for_each(|(load, f)| *load -= turn.speed * turn.speed * f);
    }
    held.coordinates.reduce(&load)
}

/// Inertia of a turning frame per mass, m/s^2, of nodal displacements and velocities in it.
pub(crate) fn frame_inertia(held: &HeldRing, turn: FrameTurn, [u, v]: [&[f64]; 2]) -> Vec<f64> {
    let (speed, acceleration) = (turn.speed, turn.acceleration);
    let mut field = vec![0.0; u.len()];
    // Of a ring that ranks share, the product takes the field at the nodes of own sectors only.
    for (i, place) in held.places.positions().kept() {
        let [x, y] = [0, 1].map(|c| place[c] + u[3 * i + c]);
        let (vx, vy) = (v[3 * i], v[3 * i + 1]);
        let f = &mut field[3 * i..3 * i + 3];
        f[0] = speed * speed * x + 2.0 * speed * vy + acceleration * y;
        f[1] = speed * speed * y - 2.0 * speed * vx - acceleration * x;
    }
    field
}

/// Coordinates and mount of a held ring.
fn hold(ring: &RingModel, Held { hold, partner }: Held) -> (Coordinates, Vec<SparseLoad>) {
    let (mesh, origin) = (&ring.mesh, ring.groove.centre_z);
    match hold {
        Hold::Clamped => {
            let held = mesh.group_nodes(ring.held_group);
            let moving = partner.moving();
            let n_mount = moving.len();
            let coordinates = Coordinates::new(mesh, &held, moving, origin);
            let first = coordinates.free().len();
            let mount = (0..n_mount).map(|k| vec![(first + k, 1.0)]);
            (coordinates, mount.collect())
        }
        Hold::MeanMotion => {
            let weights = fem::facet_node_weights(mesh, mesh.group(ring.held_group));
            let rows = mean_motion(mesh, weights, origin);
            (Coordinates::new(mesh, &[], Vec::new(), origin), rows.to_vec())
        }
        Hold::Free => (Coordinates::new(mesh, &[], Vec::new(), origin), Vec::new()),
    }
}
