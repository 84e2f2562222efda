//! Patches that go along with their contacts, as a part of the tangent of an equilibrium.
//!
//! On a flexible ring a contact acts on a patch at its contact angle alpha, of the size of its force Q. Newton keeps
//! them, and rounds of an equilibrium move them. With the nodal weights w(alpha, Q) of a contact, the ring's field u
//! and the force f on it, a patch that moves changes the motions g that all contacts measure,
//!
//! ```text
//! dg_i = W_i^T K^-1 dw f + (dw^T u if i is the contact itself)
//! ```
//!
//! and what the mesh yields besides Hertz's law ([`contact::Patch`]), which changes the force at a given approach. As
//! the force of a patch changes with its size, dQ = Q_x dx + Q_alpha dalpha + Q_size dQ.
//!
//! Cost: the compliance of two patches for each contact, its own and one whose two directions are dw f over alpha and
//! over Q.

use std::collections::BTreeMap;

use contact::{Meridian, NodalWeights, Side};
use timer::SharedLaps;

use crate::error::DynamicsError;
use crate::following::{ContactGrowths, add_to_column};
use crate::footprint::place;
use crate::interactions::raceway_contact::{RacewayContacts, SiteState};
use crate::loading::LoadCase;
use crate::solution::StaticSolution;
use crate::statics::{StaticRing, StaticSolver};

/// Step of a contact angle, rad: a small part of an element across the groove.
const ANGLE_STEP: f64 = 1e-3;
/// Step of a force over it.
const SIZE_STEP: f64 = 1e-2;

/// What the patches of a ring do as the bearing moves.
pub(crate) struct PatchGrowth {
    /// Motions of the contacts that they add, by the unknowns of the bearing: m, `[2 n_balls][n]`.
    pub moved: Vec<f64>,
    /// Growth of the load on the ring with the angle and with the size of each patch.
    pub loads: Vec<NodalWeights>,
    /// Growth of angles and of sizes with the unknowns, `[n_balls][n]` each.
    pub places: [Vec<f64>; 2],
}

/// What a ring and its contacts do while one patch moves and grows.
struct OfPatch {
    /// Growth of the residual with angle and size.
    residual: [Vec<f64>; 2],
    /// Growth of the motions that contacts measure.
    moved: [Vec<f64>; 2],
    /// Growth of the contact's own force with the angle, N/rad.
    force_by_angle: f64,
    /// The same with the force by which its size goes.
    force_by_size: f64,
}

/// Patches of a ring that stand beside those of an equilibrium.
struct Beside {
    contacts: RacewayContacts,
    weights: Vec<NodalWeights>,
}

/// An equilibrium whose patches are moved.
struct Moving<'a> {
    case: &'a LoadCase<'a>,
    solution: &'a StaticSolution,
    x: &'a [f64],
    states: Vec<SiteState>,
    forces: Vec<Meridian>,
}

/// Adds to a tangent at the unknowns `x` that the patches of flexible rings move and grow; what they do, by side.
pub(crate) fn add_moving_patches(
    solver: &StaticSolver,
    solution: &StaticSolution,
    (case, growths): (&LoadCase, &ContactGrowths),
    x: &[f64],
    stiffness: &mut [f64],
) -> Result<[Option<PatchGrowth>; 2], DynamicsError> {
    let moving = Moving {
        case,
        solution,
        x,
        states: case.parts.states(x),
        forces: case.parts.forces_at(&solution.displacements),
    };
    let mut found = [None, None];
    for side in Side::BOTH {
        if let (Some(ring), Some(field)) = (solver.ring(side), &solution.elastic[side.index()]) {
            found[side.index()] = Some(moving.of_ring((side, ring), field, growths, stiffness)?);
        }
    }
    Ok(found)
}

impl Moving<'_> {
    /// Adds those of one ring.
    fn of_ring(
        &self,
        (side, ring): (Side, &StaticRing),
        field: &[f64],
        growths: &ContactGrowths,
        stiffness: &mut [f64],
    ) -> Result<PatchGrowth, DynamicsError> {
        let at = |angle: f64, size: f64| self.beside((side, ring), angle, size);
        let beside = [
            [at(-ANGLE_STEP, 1.0)?, at(ANGLE_STEP, 1.0)?],
            [at(0.0, 1.0 - SIZE_STEP)?, at(0.0, 1.0 + SIZE_STEP)?],
        ];
        let (n, n_balls) = (self.x.len(), self.case.model.geometry.n_balls);
        let loads = self.growths_of_loads(side, &beside);
        let own = self
            .solution
            .footprints(side)
            .iter()
            .map(|foot| foot.weights.clone());
        let weights: Vec<NodalWeights> = own.chain(loads.iter().cloned()).collect();
        let compliance = ring.solver.compliance(&weights);
        let mut growth = PatchGrowth {
            moved: vec![0.0; 2 * n_balls * n],
            loads,
            places: [(); 2].map(|()| vec![0.0; n_balls * n]),
        };
        for ball in (0..n_balls).filter(|ball| !self.is_unloaded(2 * ball + side.index())) {
            let patch = self.of_patch((side, ball), &beside, (field, &compliance));
            let site = 2 * ball + side.index();
            for column in 0..n {
                let [angle, at_place] = growths.of(site, column);
                // The force of a patch changes with its angle and its size.
                let size = (at_place + patch.force_by_angle * angle) / (1.0 - patch.force_by_size);
                for (k, grown) in [angle, size].into_iter().enumerate() {
                    growth.places[k][n * ball + column] = grown;
                    add_to_column(stiffness, (n, column), &patch.residual[k], grown);
                    add_to_column(&mut growth.moved, (n, column), &patch.moved[k], grown);
                }
            }
        }
        Ok(growth)
    }

    /// Growth of the load of each contact on its ring with angle and size of the patch.
    fn growths_of_loads(&self, side: Side, beside: &[[Beside; 2]; 2]) -> Vec<NodalWeights> {
        let forces = self.case.ring_forces(&self.forces);
        let of_ball = |ball: usize| {
            let site = 2 * ball + side.index();
            if self.is_unloaded(site) {
                return self.solution.footprints(side)[ball].weights.clone();
            }
            let pairs = [0, 1].map(|k| {
                let pair = beside[k].each_ref().map(|patches| &patches.weights[ball]);
                (pair, self.step(k, site))
            });
            growth_of_load(pairs, forces[site])
        };
        (0..self.case.model.geometry.n_balls).map(of_ball).collect()
    }

    /// One patch.
    fn of_patch(
        &self,
        (side, ball): (Side, usize),
        beside: &[[Beside; 2]; 2],
        (field, compliance): (&[f64], &[f64]),
    ) -> OfPatch {
        let (n, site) = (2 * self.case.model.geometry.n_balls, 2 * ball + side.index());
        let moved = [0, 1].map(|k| {
            let of_row = |row: usize| compliance[2 * n * row + n + 2 * ball + k];
            let mut moved: Vec<f64> = (0..n).map(of_row).collect();
            let [low, high] = beside[k]
                .each_ref()
                .map(|patch| patch.weights[ball].measure(field));
            for i in 0..2 {
                moved[2 * ball + i] += (high[i] - low[i]) / self.step(k, site);
            }
            moved
        });
        let [angle, size] =
            [0, 1].map(|k| self.change((side, ball), &beside[k], &moved[k], self.step(k, site)));
        OfPatch {
            residual: [angle.0, size.0],
            moved,
            force_by_angle: angle.1,
            force_by_size: size.1,
        }
    }

    /// Distance of the patches beside a loaded contact: of the first kind of angles, rad, of the second of forces, N.
    fn step(&self, kind: usize, site: usize) -> f64 {
        match kind {
            0 => 2.0 * ANGLE_STEP,
            _ => 2.0 * SIZE_STEP * self.forces[site].norm(),
        }
    }

    fn is_unloaded(&self, site: usize) -> bool {
        self.forces[site] == Meridian::default()
    }

    /// Patches of a ring at contact angles that are larger by `angle` and of forces `size` times as large.
    fn beside(
        &self,
        (side, ring): (Side, &StaticRing),
        angle: f64,
        size: f64,
    ) -> Result<Beside, DynamicsError> {
        let model = self.case.model;
        let mounting = model.mounting.at(self.case.pose.now.time);
        let mut states = self.states.clone();
        states.iter_mut().for_each(|state| state.angle += angle);
        let forces: Vec<Meridian> = self.forces.iter().map(|f| f.map(|x| size * x)).collect();
        let mut contacts = self.case.parts.contacts.clone();
        let feet = place(
            model,
            &mounting,
            side,
            &ring.raceway,
            &mut contacts,
            &states,
            &forces,
        )?;
        Ok(Beside {
            contacts,
            weights: feet.into_iter().map(|foot| foot.weights).collect(),
        })
    }

    /// Growth of the residual, and of the contact's own force, between two places of one patch.
    fn change(
        &self,
        (side, ball): (Side, usize),
        patches: &[Beside; 2],
        moved: &[f64],
        step: f64,
    ) -> (Vec<f64>, f64) {
        let site = 2 * ball + side.index();
        let at = |place: usize| {
            let mut parts = self.case.parts.clone();
            parts.contacts.sites[site] = patches[place].contacts.sites[site].clone();
            let mut rings = parts.rings.clone();
            let share = [-0.5, 0.5][place] * step;
            if let Some(ports) = &mut rings[side.index()] {
                let offsets = ports.offset.iter_mut().zip(moved);
                offsets.for_each(|(offset, moved)| *offset += share * moved);
            }
            parts.set_rings(rings, &self.solution.displacements.grooves);
            let residual = parts.system().evaluate(self.x, &SharedLaps::default()).residual;
            (residual, parts.states(self.x)[site].force.force)
        };
        let ((low, low_force), (high, high_force)) = (at(0), at(1));
        let change = low.iter().zip(&high).map(|(low, high)| (high - low) / step);
        (change.collect(), (high_force - low_force) / step)
    }
}

/// The load dw f of a contact whose patch moves, per radian, as the first direction, and per newton of its size as the
/// second; from the weights below and above, apart by the steps.
fn growth_of_load(pairs: [([&NodalWeights; 2], f64); 2], force: Meridian) -> NodalWeights {
    let mut sums: BTreeMap<usize, [[f64; 3]; 2]> = BTreeMap::new();
    for (k, (pair, step)) in pairs.into_iter().enumerate() {
        for (weights, sign) in pair.into_iter().zip([-1.0, 1.0]) {
            for (&node, [radial, axial]) in weights.nodes.iter().zip(&weights.coefficients) {
                let sum = &mut sums.entry(node).or_default()[k];
                for i in 0..3 {
                    sum[i] += sign * (radial[i] * force.radial + axial[i] * force.axial) / step;
                }
            }
        }
    }
    let (nodes, coefficients) = sums.into_iter().unzip();
    NodalWeights { nodes, coefficients }
}
