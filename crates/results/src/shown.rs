//! One instant of a run, as fields and probes show it.
//!
//! A ring's field is known in the frame of its mesh, which is turned in space by the ring's angle. It is shown as it
//! stands in space: its displacement is that from the mesh, turning included, and its stress tensors are turned.

use std::borrow::Cow;
use std::sync::Arc;

use contact::{BearingGeometry, LoadedPatch, Side};
use dynamics::balls::BallResult;
use dynamics::frame::turn;
use dynamics::motion::{Motion, MotionState};
use dynamics::{DynamicsError, Model, OwnStress, StaticSolution};
use mesh::NodePositions;

/// Bearing, kinematics and state of one instant.
#[derive(Clone, Copy)]
pub enum Shown<'a> {
    /// An equilibrium. Points of a sweep may differ in the places of balls and rings; `placed` is the bearing of the
    /// mesh file, from whose places displacements are shown.
    Equilibrium {
        /// The bearing with its loads.
        model: &'a Model,
        /// Bearing of the mesh file.
        placed: &'a BearingGeometry,
        /// Its equilibrium.
        solution: &'a StaticSolution,
    },
    /// An instant of a motion.
    Motion {
        /// The bearing with its loads.
        model: &'a Model,
        /// Kinematics and coordinates.
        motion: &'a Motion<'a>,
        /// The instant.
        state: &'a MotionState,
    },
}

/// A flexible ring at one instant.
pub struct RingField<'a> {
    /// Axial position of the groove centres in the mesh, m.
    centre_z: f64,
    /// Where its nodes are in the mesh; of a ring that ranks share at first those that this rank keeps.
    pub places: NodePositions,
    /// Stress besides that of `strained`, from the ring's own strain; None: none.
    pub own_stress: Option<Arc<OwnStress>>,
    /// Displacement by mounting and loads up to a rigid motion, in the ring's frame, m, `[n_nodes][3]` flat.
    pub strained: Cow<'a, [f64]>,
    /// Free thermal strain, without stress: not in `strained`.
    expansion: f64,
    /// That rigid motion: shaft dofs in the ring's frame, m and rad; None when it is contained or zero.
    rigid: Option<[f64; 5]>,
    /// From the ring's frame to space.
    pub turn: Turn,
}

impl<'a> Shown<'a> {
    /// An equilibrium.
    pub fn at_rest(model: &'a Model, placed: &'a BearingGeometry, solution: &'a StaticSolution) -> Shown<'a> {
        Shown::Equilibrium {
            model,
            placed,
            solution,
        }
    }

    /// The bearing with its loads.
    pub fn model(&self) -> &'a Model {
        match self {
            Shown::Equilibrium { model, .. } | Shown::Motion { model, .. } => model,
        }
    }

    /// The bearing from whose places displacements are shown.
    pub fn placed(&self) -> &'a BearingGeometry {
        match self {
            Shown::Equilibrium { placed, .. } => placed,
            Shown::Motion { model, .. } => &model.geometry,
        }
    }

    /// From the frame of a ring to space.
    pub fn turn(&self, side: Side) -> Turn {
        Turn::new(match self {
            Shown::Equilibrium { solution, .. } => solution.pose.frame_angle(side),
            Shown::Motion { motion, state, .. } => motion.angle_of_frame(state, side),
        })
    }

    /// Motion of the shaft in the frame of a ring at an equilibrium, from where the mesh file has it, m and
    /// rad; None in motion, where fields contain it.
    pub fn shaft_in_frame(&self, side: Side) -> Option<[f64; 5]> {
        let Shown::Equilibrium {
            model,
            placed,
            solution,
        } = self
        else {
            return None;
        };
        let mut q = solution.displacements.shaft;
        q[2] = q[2] + model.geometry.axial_offset() - placed.axial_offset();
        Some(turn(q, -solution.pose.frame_angle(side)))
    }

    /// All balls.
    pub fn balls(&self) -> Cow<'a, [BallResult]> {
        match self {
            Shown::Equilibrium { solution, .. } => Cow::Borrowed(&solution.balls),
            Shown::Motion { motion, state, .. } => Cow::Owned(motion.balls(state)),
        }
    }

    /// Time of the instant, s.
    pub fn time(&self) -> f64 {
        match self {
            Shown::Equilibrium { solution, .. } => solution.pose.now.time,
            Shown::Motion { motion, state, .. } => motion.time(state.step),
        }
    }

    /// Contact forces on a ring and the patches over which they are spread, by ball; empty for a rigid ring or facets.
    pub fn patches(&self, side: Side) -> Result<Vec<LoadedPatch>, DynamicsError> {
        match self {
            Shown::Equilibrium { solution, .. } => Ok(solution.patches(side)),
            Shown::Motion { motion, state, .. } => motion.patches(state, side),
        }
    }

    /// A ring; None when it is rigid, or its field was not kept.
    pub fn ring(&self, side: Side) -> Option<RingField<'a>> {
        self.ring_moved(side, |motion, state| motion.ring_displacement(state, side))
    }

    /// The same with a field of which only the chosen nodes may be asked for: all that is transformed of a ring in
    /// motion.
    pub fn ring_at(&self, side: Side, nodes: &[usize]) -> Option<RingField<'a>> {
        self.ring_moved(side, |motion, state| {
            motion.ring_displacement_at(state, side, nodes)
        })
    }

    /// Accelerations of the chosen nodes of a ring in its frame, m/s^2, `[n_nodes][3]` flat; None at rest and of a
    /// rigid ring.
    pub fn accelerations_at(&self, side: Side, nodes: &[usize]) -> Option<Vec<f64>> {
        match self {
            Shown::Equilibrium { .. } => None,
            Shown::Motion { motion, state, .. } => motion.ring_acceleration_at(state, side, nodes),
        }
    }

    /// A ring; in motion with the displacements (m, `[n_nodes][3]` flat) and the angle that `moved` finds.
    fn ring_moved(
        &self,
        side: Side,
        moved: impl FnOnce(&Motion<'_>, &MotionState) -> Option<(Vec<f64>, f64)>,
    ) -> Option<RingField<'a>> {
        let ring = self.model().ring(side)?;
        let mounting = self.model().mounting.at(self.time());
        let mounted = &mounting.rings[side.index()];
        let (centre_z, expansion) = (ring.groove.centre_z, mounted.expansion);
        let mount = |mut field: Cow<'a, [f64]>| {
            if let Some(mounted) = &mounted.field {
                let sum = field.to_mut().iter_mut().zip(mounted.iter());
                sum.for_each(|(u, w)| *u += w);
            }
            field
        };
        match self {
            Shown::Equilibrium { solution, .. } => {
                let strained = solution.elastic[side.index()].as_ref()?;
                let angle = solution.pose.frame_angle(side);
                let rigid = match side {
                    Side::Inner => self.shaft_in_frame(side),
                    Side::Outer => {
                        let seat = solution.displacements.seat;
                        (seat != 0.0).then_some([0.0, 0.0, seat, 0.0, 0.0])
                    }
                };
                Some(RingField {
                    centre_z,
                    expansion,
                    own_stress: mounted.own_stress.clone(),
                    places: ring.mesh.nodes.clone(),
                    strained: mount(Cow::Borrowed(strained)),
                    rigid,
                    turn: Turn::new(angle),
                })
            }
            Shown::Motion { motion, state, .. } => {
                let (field, angle) = moved(motion, state)?;
                Some(RingField {
                    centre_z,
                    expansion,
                    own_stress: mounted.own_stress.clone(),
                    places: ring.mesh.nodes.clone(),
                    strained: mount(Cow::Owned(field)),
                    rigid: None,
                    turn: Turn::new(angle),
                })
            }
        }
    }
}

impl RingField<'_> {
    /// Total displacement of a node in the ring's frame, m.
    pub fn displacement(&self, node: usize) -> [f64; 3] {
        let u = &self.strained[3 * node..3 * node + 3];
        let mut u = [u[0], u[1], u[2]];
        if let Some([x, y, z, tilt_x, tilt_y]) = self.rigid {
            let [node_x, node_y, node_z] = self.places[node];
            let arm = node_z - self.centre_z;
            u[0] += x + tilt_y * arm;
            u[1] += y - tilt_x * arm;
            u[2] += z + tilt_x * node_y - tilt_y * node_x;
        }
        if self.expansion != 0.0 {
            let [node_x, node_y, node_z] = self.places[node];
            u[0] += self.expansion * node_x;
            u[1] += self.expansion * node_y;
            u[2] += self.expansion * (node_z - self.centre_z);
        }
        u
    }

    /// Displacement of a node in space from its place in the mesh, turning included, m.
    pub fn shown_displacement(&self, node: usize) -> [f64; 3] {
        let u = self.turn.vector(self.displacement(node));
        // Without turning this is the displacement itself, to the last bit.
        let moved = match self.turn.is_none() {
            true => [0.0; 3],
            false => self.turn.moved(self.places[node]),
        };
        [0, 1, 2].map(|i| u[i] + moved[i])
    }

    /// Displacements of all nodes in space, m.
    pub fn shown_displacements(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.places.len()).map(|node| self.shown_displacement(node))
    }

    /// Whether displacements as they are shown depend on where the nodes are.
    pub fn needs_places(&self) -> bool {
        self.rigid.is_some() || !self.turn.is_none() || self.expansion != 0.0
    }
}

/// Adds stress to stress, place by place.
pub fn add(sum: &mut [[f64; 6]], more: &[[f64; 6]]) {
    for (sum, more) in sum.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
        *sum += more;
    }
}

/// A turn about z.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    /// By an angle from +x towards +y, rad.
    pub fn new(angle: f64) -> Turn {
        let (sin, cos) = angle.sin_cos();
        Turn { sin, cos }
    }

    /// Whether it turns nothing.
    fn is_none(&self) -> bool {
        (self.sin, self.cos) == (0.0, 1.0)
    }

    /// How far a place moves.
    fn moved(&self, place: [f64; 3]) -> [f64; 3] {
        let turned = self.vector(place);
        [0, 1, 2].map(|i| turned[i] - place[i])
    }

    /// Displacement in space of a place that is displaced so before it turns, m; without turning the same bits.
    pub fn displacement(&self, place: [f64; 3], displacement: [f64; 3]) -> [f64; 3] {
        if self.is_none() {
            return displacement;
        }
        let (u, moved) = (self.vector(displacement), self.moved(place));
        [0, 1, 2].map(|i| u[i] + moved[i])
    }

    /// A vector, turned.
    pub fn vector(&self, v: [f64; 3]) -> [f64; 3] {
        [
            self.cos * v[0] - self.sin * v[1],
            self.sin * v[0] + self.cos * v[1],
            v[2],
        ]
    }

    /// R s R^T for xx yy zz xy yz xz.
    pub fn tensor(&self, [xx, yy, zz, xy, yz, xz]: [f64; 6]) -> [f64; 6] {
        let (c, s) = (self.cos, self.sin);
        [
            c * c * xx - 2.0 * c * s * xy + s * s * yy,
            s * s * xx + 2.0 * c * s * xy + c * c * yy,
            zz,
            c * s * (xx - yy) + (c * c - s * s) * xy,
            s * xz + c * yz,
            c * xz - s * yz,
        ]
    }
}

#[cfg(test)]
mod tests {
    use fem::stress::von_mises;

    use super::*;

    /// Wrong: stress of the turning ring would be shown in the wrong directions.
    #[test]
    fn turning_a_tensor_keeps_its_invariants_and_turns_its_axes() {
        let turn = Turn::new(0.7);
        let s = turn.tensor([3.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let axis = turn.vector([1.0, 0.0, 0.0]);
        let traction = [s[0] * axis[0] + s[3] * axis[1], s[3] * axis[0] + s[1] * axis[1]];
        assert!((traction[0] - 3.0 * axis[0]).abs() < 1e-15 && (traction[1] - 3.0 * axis[1]).abs() < 1e-15);
        let full = [1.0, -2.0, 0.5, 0.3, 0.8, -0.4];
        assert!((von_mises(turn.tensor(full)) - von_mises(full)).abs() < 1e-14);
        let shear = turn.tensor([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert!((shear[5] - 0.7f64.cos()).abs() < 1e-15 && (shear[4] - 0.7f64.sin()).abs() < 1e-15);
    }
}
