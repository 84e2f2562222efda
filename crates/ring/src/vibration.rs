//! Rings that vibrate: K and M in their coordinates, the factor of K + s M, and what their partners impose.
//!
//! A clamped surface that moves with dofs of the partner has these as coordinates. A mean-motion hold leaves all
//! nodes free; its held motions are constraints c^T w = 0, where c takes the area-weighted least-squares rigid motion
//! of the surface. A mass of the partner acts on the motions that it follows. Rings that are tied to a body have the
//! oscillators of this after their own coordinates (`tied::vibration`). Of a body on the shaft these know the motion of
//! the shaft: the partner of its rings acts on them.

use std::sync::Arc;

use body::SeatTie;
use contact::NodalWeights;
use rayon::prelude::*;
use solver::LinearSolver;

use crate::body::{Held, HeldRing, Partner};
use crate::error::RingError;
use crate::harmonic::harmonics::Harmonics;
use crate::harmonic::periodic::Periodic;
use crate::matrices::{NodalMatrices, SparseMatrices};
use crate::model::{Backend, Hold, RingModel};
use crate::sparse::{SparseLoad, sparse_dot};
use crate::tied::vibration::{VibratingJoint, VibratingSeat, VibratingTie};
use crate::vectors::rows_of;

/// What is made ready to vibrate.
#[derive(Clone, Copy)]
pub struct RingToVibrate<'a> {
    /// `inner` or `outer`.
    pub name: &'static str,
    /// The ring.
    pub ring: &'a RingModel,
    /// Its partner, whose dofs x, y, z, tilt x, tilt y carry masses, kg and kg m^2; without one it floats.
    pub partner: Option<(Partner, [f64; 5])>,
}

impl RingToVibrate<'_> {
    /// The joint with a body, where a partner is there.
    fn tie(&self) -> Option<&Arc<SeatTie>> {
        self.ring.tie.as_ref().filter(|_| self.partner.is_some())
    }

    /// How it is held, and by what.
    fn held(&self) -> (Hold, Partner) {
        match self.partner {
            Some((partner, _)) => (self.ring.hold, partner),
            None => (Hold::Free, Partner::AT_REST),
        }
    }

    /// Whether it is alone what another is: masses of partners and bodies apart.
    fn is_like(&self, other: &RingToVibrate<'_>) -> bool {
        let space = |of: &RingToVibrate<'_>| of.tie().map(|tie| tie.space);
        let is_same = std::ptr::eq(self.ring, other.ring);
        (self.name, self.held()) == (other.name, other.held())
            && space(self) == space(other)
            && (is_same || self.ring.is_like(other.ring))
    }

    /// Whether it is tied to the body of another ring: they vibrate together.
    pub fn shares_body(&self, other: &RingToVibrate<'_>) -> bool {
        let body = |of: &RingToVibrate<'_>| {
            let tie = of.ring.tie.as_ref().filter(|_| of.partner.is_some())?;
            Some(Arc::as_ptr(tie.body.as_ref()?))
        };
        body(self).is_some_and(|own| body(other) == Some(own))
    }
}

/// A ring as it vibrates alone: what does not depend on masses of its partner, or to which body it is tied.
struct RingAlone {
    held: HeldRing,
    matrices: Box<dyn NodalMatrices>,
    /// Of K + s M.
    factor: Box<dyn LinearSolver>,
    /// Of a tied ring.
    seat: Option<Arc<VibratingSeat>>,
}

/// A ring ready to vibrate.
pub struct VibratingRing {
    /// Rings that are alike share it.
    alone: Arc<RingAlone>,
    /// Its first coordinate in its group.
    first: usize,
    /// Held motions as generalised loads, in coordinates of the group.
    constraints: Vec<SparseLoad>,
    /// Masses of the partner: generalised load of the motion that one follows, and kg or kg m^2.
    lumps: Vec<(SparseLoad, f64)>,
    /// Motions x, y, z, tilt x, tilt y of the partner, where the ring knows them.
    partner: [Option<SparseLoad>; 5],
    /// Whether all of these follow from those of another ring on the same body.
    follows: bool,
}

/// A ring alone, or rings that are tied to one body, with it.
pub struct VibratingRings {
    rings: Vec<VibratingRing>,
    /// The body to which they are tied.
    tie: Option<VibratingTie>,
}

impl RingAlone {
    /// Assembles a ring and factors K + `shift` M.
    fn new(of: &RingToVibrate<'_>, shift: f64, backend: Backend) -> Result<RingAlone, RingError> {
        let (name, ring, (hold, partner)) = (of.name, of.ring, of.held());
        let held = HeldRing::new(name, ring, Held { hold, partner }, backend)?;
        let error = |source| RingError::Solver { side: name, source };
        let coefficients = [shift, 1.0];
        let (matrices, factor): (Box<dyn NodalMatrices>, Box<dyn LinearSolver>) =
            match Periodic::for_modes(ring, name, backend, &held.coordinates.held_nodes())? {
                Ok(periodic) => {
                    let (harmonics, stencils) = Harmonics::new(ring, &held, periodic)?;
                    let factor = harmonics
                        .bordered(&held, &stencils, coefficients)
                        .map_err(error)?;
                    (Box::new(stencils), Box::new(factor))
                }
                Err(_) => {
                    let matrices = SparseMatrices::new(ring, name, &held.coordinates, None)?;
                    let symbolic = matrices.analyse(ring, &held.coordinates).map_err(error)?;
                    let factor = matrices.factor(&symbolic, &held.coordinates, coefficients);
                    (Box::new(matrices), Box::new(factor.map_err(error)?))
                }
            };
        let functions = of.tie().map(|_| ring.seat_functions(name)).transpose()?.flatten();
        let of_ring = (&*factor, held.coordinates.n());
        let seat = functions.map(|functions| Arc::new(VibratingSeat::new(&functions, of_ring)));
        Ok(RingAlone {
            held,
            matrices,
            factor,
            seat,
        })
    }
}

impl VibratingRing {
    fn new(wanted: &RingToVibrate<'_>, alone: Arc<RingAlone>) -> (VibratingRing, Option<VibratingJoint>) {
        let (of, masses) = wanted.partner.unwrap_or((Partner::AT_REST, [0.0; 5]));
        let joint = wanted.tie().zip(alone.seat.clone());
        let joint = joint.map(|(tie, seat)| VibratingJoint::new(tie, seat));
        let (hold, held) = (wanted.held().0, &alone.held);
        // A tied ring meets no rigid partner.
        let hold = if joint.is_some() { Hold::Free } else { hold };
        let known = match hold {
            Hold::MeanMotion | Hold::Clamped => motions_of_mount(hold, held, of),
            Hold::Free => [const { None }; 5],
        };
        let mut made = VibratingRing {
            lumps: Vec::new(),
            constraints: Vec::new(),
            partner: [const { None }; 5],
            follows: joint.as_ref().is_some_and(|joint| joint.tie().seat > 0),
            first: 0,
            alone,
        };
        made.meet(known, of, masses);
        if hold == Hold::MeanMotion {
            let held = (0..6).filter(|&dof| dof == 5 || !of.moves[dof]);
            let rows = held.filter_map(|dof| made.alone.held.mount.rows.get(dof).cloned());
            made.constraints = rows.collect();
        }
        (made, joint)
    }

    /// Notes the motions of the partner and the masses that follow them.
    fn meet(&mut self, motions: [Option<SparseLoad>; 5], of: Partner, masses: [f64; 5]) {
        let carries = |dof: &usize| masses[*dof] > 0.0 && of.moves[*dof];
        let lumps = (0..5)
            .filter(carries)
            .filter_map(|dof| Some((motions[dof].clone()?, masses[dof])));
        self.lumps = lumps.collect();
        self.partner = motions;
    }

    /// How it is held.
    pub fn held(&self) -> &HeldRing {
        &self.alone.held
    }

    /// Number of its own coordinates, without those of a body.
    fn n(&self) -> usize {
        self.alone.held.coordinates.n()
    }

    /// Held motions as generalised loads.
    pub fn constraints(&self) -> &[SparseLoad] {
        &self.constraints
    }

    /// Masses of the partner: generalised load of the motion that one follows, and kg or kg m^2.
    pub fn lumps(&self) -> &[(SparseLoad, f64)] {
        &self.lumps
    }

    /// Generalised load of a motion (0 to 4: x, y, z, tilt x, tilt y) of the partner, where the ring knows it.
    pub fn partner_load(&self, dof: usize) -> Option<&SparseLoad> {
        self.partner[dof].as_ref()
    }

    /// Whether the partner's motions are those that the body has given to another ring already.
    pub fn follows_body(&self) -> bool {
        self.follows
    }

    /// Generalised loads of a unit force in each direction of a contact.
    pub fn contact_loads(&self, weights: &NodalWeights) -> [SparseLoad; 2] {
        let own = self.alone.held.coordinates.reduce_weights(weights);
        own.map(|load| shifted(load, self.first))
    }

    /// Motion x, y, z, tilt x, tilt y of the partner, m and rad.
    pub fn partner_motion(&self, y: &[f64]) -> [f64; 5] {
        let value = |motion: &Option<SparseLoad>| motion.as_ref().map_or(0.0, |m| sparse_dot(m, y));
        self.partner.each_ref().map(value)
    }

    /// Displacement of its nodes, `[n_nodes][3]` flat.
    pub fn displacement(&self, y: &[f64]) -> Vec<f64> {
        self.alone.held.coordinates.expand(self.own(y))
    }

    /// Its own among the coordinates of its group.
    fn own<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        &y[self.first..self.first + self.n()]
    }

    /// What of y^T M y is its own, without its body and the masses of its partner.
    pub fn mass_of(&self, y: &[f64]) -> f64 {
        let own = self.own(y);
        let moved = self
            .alone
            .matrices
            .mass_product(&self.alone.held.coordinates, own);
        own.iter().zip(moved).map(|(y, m)| y * m).sum()
    }
}

/// Motions of the partner that a mount has. A clamped surface has those that move, a mean motion all.
fn motions_of_mount(hold: Hold, held: &HeldRing, of: Partner) -> [Option<SparseLoad>; 5] {
    let of_mount = |k: usize| held.mount.rows.get(k).cloned();
    if hold == Hold::MeanMotion {
        return [0, 1, 2, 3, 4].map(of_mount);
    }
    let mut motions = [const { None }; 5];
    let moving = (0..5).filter(|&dof| of.moves[dof]);
    moving.enumerate().for_each(|(k, dof)| motions[dof] = of_mount(k));
    motions
}

fn shifted(mut load: SparseLoad, by: usize) -> SparseLoad {
    load.iter_mut().for_each(|(i, _)| *i += by);
    load
}

impl VibratingRings {
    /// Assembles rings that are tied to one body, or one ring, and factors K + `shift` M of each.
    pub fn new(
        rings: &[RingToVibrate<'_>],
        shift: f64,
        backend: Backend,
    ) -> Result<VibratingRings, RingError> {
        let mut groups = VibratingRings::of_groups(&[rings.to_vec()], shift, backend)?;
        Ok(groups.pop().expect("one group"))
    }

    /// The same of several groups. Rings that are alike are factored once.
    pub fn of_groups(
        groups: &[Vec<RingToVibrate<'_>>],
        shift: f64,
        backend: Backend,
    ) -> Result<Vec<VibratingRings>, RingError> {
        let all: Vec<&RingToVibrate<'_>> = groups.iter().flatten().collect();
        let first_like = |i: usize| (0..i).find(|&k| all[k].is_like(all[i])).unwrap_or(i);
        let firsts: Vec<usize> = (0..all.len()).map(first_like).collect();
        let make = |(i, &first): (usize, &usize)| {
            let is_first = (i == first).then(|| RingAlone::new(all[i], shift, backend));
            is_first.transpose().map(|alone| alone.map(Arc::new))
        };
        let made: Result<Vec<Option<Arc<RingAlone>>>, RingError> =
            firsts.par_iter().enumerate().map(make).collect();
        let made = made?;
        let alone = |&first: &usize| made[first].clone().expect("the first of its kind is made");
        let mut alone = firsts.iter().map(alone);
        let of_group = |rings: &Vec<RingToVibrate<'_>>| {
            let rings = rings.iter().zip(alone.by_ref());
            let (made, joints) = rings.map(|(ring, alone)| VibratingRing::new(ring, alone)).unzip();
            (made, joints)
        };
        let parts: Vec<_> = groups.iter().map(of_group).collect();
        let group = |(parts, rings)| VibratingRings::joined(parts, rings, shift);
        parts.into_par_iter().zip(groups).map(group).collect()
    }

    /// A group of rings, one behind the other.
    fn joined(
        (mut made, joints): (Vec<VibratingRing>, Vec<Option<VibratingJoint>>),
        rings: &Vec<RingToVibrate<'_>>,
        shift: f64,
    ) -> Result<VibratingRings, RingError> {
        let mut first = 0;
        for ring in &mut made {
            ring.first = first;
            let loads = ring
                .constraints
                .iter_mut()
                .chain(ring.partner.iter_mut().flatten());
            let loads = loads.chain(ring.lumps.iter_mut().map(|(load, _)| load));
            loads.for_each(|load| *load = shifted(std::mem::take(load), first));
            first += ring.n();
        }
        let joints: Vec<VibratingJoint> = joints.into_iter().flatten().collect();
        let tie = (!joints.is_empty()).then(|| VibratingTie::new(joints, shift));
        let tie = tie.transpose()?;
        let all = VibratingRings { rings: made, tie };
        Ok(all.on_shaft(rings))
    }

    /// The same where the oscillators of a body know the motion of the shaft that carries it.
    fn on_shaft(mut self, rings: &[RingToVibrate<'_>]) -> VibratingRings {
        let Some(tie) = &self.tie else { return self };
        let first: usize = self.rings.iter().map(VibratingRing::n).sum();
        for ((ring, joint), of) in self.rings.iter_mut().zip(tie.joints()).zip(rings) {
            let (Some(shaft), Some((partner, masses))) = (&joint.modes().on_shaft, of.partner) else {
                continue;
            };
            let motion = |dof: usize| {
                let rows = shaft.rows.iter().enumerate();
                Some(rows.map(|(i, row)| (first + i, row[dof])).collect())
            };
            let motions: [Option<SparseLoad>; 5] = [0, 1, 2, 3, 4].map(motion);
            let held = (0..5).filter(|&dof| !partner.moves[dof] && !ring.follows);
            ring.constraints = held.filter_map(|dof| motions[dof].clone()).collect();
            ring.meet(motions, partner, masses);
        }
        self
    }

    /// The rings, in their order.
    pub fn rings(&self) -> &[VibratingRing] {
        &self.rings
    }

    /// Number of coordinates, with those of a body to which they are tied.
    pub fn n(&self) -> usize {
        let of_body = self.tie.as_ref().map_or(0, VibratingTie::n_oscillators);
        self.rings.iter().map(VibratingRing::n).sum::<usize>() + of_body
    }

    /// K Y of a block of vectors, column-major, without what constraints and contacts add.
    pub fn stiffness(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        let product = |ring: &VibratingRing, y: &[f64]| {
            let coordinates = &ring.alone.held.coordinates;
            ring.alone.matrices.stiffness_products(coordinates, y, n_vectors)
        };
        self.products(y, n_vectors, product, |square| square)
    }

    /// M Y of a block of vectors without the masses of the partner.
    pub fn mass(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        let product = |ring: &VibratingRing, y: &[f64]| -> Vec<f64> {
            let columns = y.chunks_exact((y.len() / n_vectors.max(1)).max(1));
            columns
                .flat_map(|y| ring.alone.matrices.mass_product(&ring.alone.held.coordinates, y))
                .collect()
        };
        self.products(y, n_vectors, product, |_| 1.0)
    }

    /// A product of each ring's own coordinates, and the oscillators of their body times a factor of their omega^2.
    fn products(
        &self,
        y: &[f64],
        n_vectors: usize,
        product: impl Fn(&VibratingRing, &[f64]) -> Vec<f64> + Sync,
        of_oscillator: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        let Some(tie) = &self.tie else {
            return product(&self.rings[0], y);
        };
        let n = self.n();
        let of_ring = |ring: &VibratingRing| {
            let own = rows_of(y, n, &(ring.first..ring.first + ring.n()));
            product(ring, &own)
        };
        let products: Vec<Vec<f64>> = self.rings.par_iter().map(of_ring).collect();
        let mut rings = Vec::with_capacity(products.iter().map(Vec::len).sum());
        for column in 0..n_vectors {
            for (ring, product) in self.rings.iter().zip(&products) {
                rings.extend_from_slice(&product[ring.n() * column..ring.n() * (column + 1)]);
            }
        }
        tie.joined(&rings, y, of_oscillator)
    }

    /// (K + s M)^-1 of a block of `n_vectors` loads, column-major `[n][n_vectors]`.
    pub fn solve(&self, loads: &mut [f64], n_vectors: usize) {
        match &self.tie {
            None => self.rings[0].alone.factor.solve(loads, n_vectors),
            Some(tie) => {
                let factors: Vec<&dyn LinearSolver> =
                    self.rings.iter().map(|ring| &*ring.alone.factor).collect();
                tie.solve(&factors, loads);
            }
        }
    }

    /// Takes the forces that tie them to a body out of a vector of forces.
    pub fn remove_reactions(&self, force: &mut [f64]) {
        if let Some(tie) = &self.tie {
            tie.remove_reactions(force);
        }
    }

    /// Displacement of the body to which they are tied; None where there is none, or a rigid one.
    pub fn body_displacement(&self, y: &[f64]) -> Option<Vec<f64>> {
        self.tie.as_ref()?.body_displacement(y)
    }

    /// What of y^T M y belongs to that body.
    pub fn body_mass(&self, y: &[f64]) -> f64 {
        self.tie.as_ref().map_or(0.0, |tie| tie.body_mass(y))
    }
}
