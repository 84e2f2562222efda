//! Nodal fields of one instant of a motion. Rings are shown as they stand in space: the inner ring is turned by its
//! angle, and so are its displacements and its stress tensors, unless the scene asks for its own frame. The state of the run is stored beside, bit for bit.

use checkpoint::StepRecord;
use contact::Side;
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use fem::stress::StressRecovery;

use super::fields::{add_balls, point_fields};
use super::state_arrays::{self, Arrays};
use crate::scene::{InnerRingFrame, Scene};

/// One instant as it is shown, but for the stress: that is recovered when the record is made.
pub struct Shown {
    step: u64,
    time: f64,
    /// Displacement of every point, m.
    displacement: Vec<[f64; 3]>,
    /// Displacement of the flexible rings in their own frames, m, flat, and their turn.
    rings: [Option<(Vec<f64>, Turn)>; 2],
    forces: [Vec<[f64; 3]>; 2],
    state: Arrays,
    scene: String,
}

impl Shown {
    /// Places of rings and balls at one instant.
    pub fn new(model: &Model, motion: &Motion<'_>, state: &MotionState, scene: &Scene) -> Shown {
        let (mut displacement, mut rings) = (Vec::new(), [None, None]);
        for side in Side::BOTH {
            let (Some(ring), Some((field, angle))) =
                (model.ring(side), motion.ring_displacement(state, side))
            else {
                continue;
            };
            let turn = Turn::new(match (side, scene.output.inner_ring) {
                (Side::Inner, InnerRingFrame::OwnFrame) => 0.0,
                (Side::Inner | Side::Outer, _) => angle,
            });
            for (x, u) in ring.mesh.nodes.iter().zip(field.chunks_exact(3)) {
                let now = turn.vector([x[0] + u[0], x[1] + u[1], u[2]]);
                displacement.push([now[0] - x[0], now[1] - x[1], now[2]]);
            }
            rings[side.index()] = Some((field, turn));
        }
        let forces = add_balls(model, &model.geometry, &motion.balls(state), &mut displacement);
        Shown {
            step: state.step,
            time: motion.time(state.step),
            displacement,
            rings,
            forces,
            state: state_arrays::store(state, &motion.shape()),
            scene: scene.text.clone(),
        }
    }

    /// The record of the instant, with stress where it is recovered.
    pub fn record(self, recoveries: &[Option<StressRecovery>; 2]) -> StepRecord {
        let with_stress = recoveries.iter().any(Option::is_some);
        let mut stress = Vec::new();
        for (ring, recovery) in self.rings.iter().zip(recoveries) {
            if let (Some((field, turn)), Some(recovery)) = (ring, recovery) {
                stress.extend(recovery.nodal(field).into_iter().map(|s| turn.tensor(s)));
            }
        }
        StepRecord {
            step: self.step,
            time: self.time,
            points: point_fields(self.displacement, with_stress.then_some(stress), self.forces),
            scene: self.scene,
            state: self.state,
        }
    }
}

/// A turn about z.
struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    fn new(angle: f64) -> Turn {
        let (sin, cos) = angle.sin_cos();
        Turn { sin, cos }
    }

    fn vector(&self, v: [f64; 3]) -> [f64; 3] {
        [
            self.cos * v[0] - self.sin * v[1],
            self.sin * v[0] + self.cos * v[1],
            v[2],
        ]
    }

    /// R s R^T for xx yy zz xy yz xz.
    fn tensor(&self, [xx, yy, zz, xy, yz, xz]: [f64; 6]) -> [f64; 6] {
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
