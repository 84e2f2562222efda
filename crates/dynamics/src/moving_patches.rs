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

use contact::{NodalWeights, Side};
use timer::SharedLaps;

use crate::error::DynamicsError;
use crate::following::{ContactGrowths, add_to_column};
use crate::interactions::raceway_contact::{Site, SiteState, on_rings};
use crate::loading::LoadCase;
use crate::patches_beside::{KINDS, PatchesBeside, StandingContacts};
use crate::solution::StaticSolution;
use crate::statics::{StaticRing, StaticSolver};

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

/// An equilibrium whose patches are moved.
struct Moving<'a> {
    case: &'a LoadCase<'a>,
    solution: &'a StaticSolution,
    x: &'a [f64],
    states: Vec<SiteState>,
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
        let standing = StandingContacts {
            model: self.case.model,
            time: self.case.pose.now.time,
            contacts: &self.case.parts.contacts,
            states: &self.states,
        };
        let beside = PatchesBeside::new(&standing, side, &ring.raceway)?;
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
        for ball in (0..n_balls).filter(|ball| beside.is_loaded(*ball)) {
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
    fn growths_of_loads(&self, side: Side, beside: &PatchesBeside) -> Vec<NodalWeights> {
        let forces = self.case.ring_forces(&on_rings(&self.states));
        let of_ball = |ball: usize| match beside.is_loaded(ball) {
            true => beside.growth_of_load(ball, forces[2 * ball + side.index()]),
            false => self.solution.footprints(side)[ball].weights.clone(),
        };
        (0..self.case.model.geometry.n_balls).map(of_ball).collect()
    }

    /// One patch.
    fn of_patch(
        &self,
        (side, ball): (Side, usize),
        beside: &PatchesBeside,
        (field, compliance): (&[f64], &[f64]),
    ) -> OfPatch {
        let n = 2 * self.case.model.geometry.n_balls;
        let moved = KINDS.map(|k| {
            let of_row = |row: usize| compliance[2 * n * row + n + 2 * ball + k];
            let mut moved: Vec<f64> = (0..n).map(of_row).collect();
            let own = beside.growth_of_motion(k, ball, field).to_array();
            own.iter()
                .enumerate()
                .for_each(|(i, more)| moved[2 * ball + i] += more);
            moved
        });
        let [angle, size] = KINDS.map(|k| {
            self.change(
                (side, ball),
                beside.sites(k, ball),
                &moved[k],
                beside.step(k, ball),
            )
        });
        OfPatch {
            residual: [angle.0, size.0],
            moved,
            force_by_angle: angle.1,
            force_by_size: size.1,
        }
    }

    /// Growth of the residual, and of the contact's own force, between two places of one patch.
    fn change(
        &self,
        (side, ball): (Side, usize),
        patches: [&Site; 2],
        moved: &[f64],
        step: f64,
    ) -> (Vec<f64>, f64) {
        let site = 2 * ball + side.index();
        let at = |place: usize| {
            let mut parts = self.case.parts.clone();
            parts.contacts.sites[site] = patches[place].clone();
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
