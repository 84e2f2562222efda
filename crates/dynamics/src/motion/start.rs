//! The start of a motion: static equilibrium, at rest but for the turning of the inner ring.

use contact::Side;

use super::ledger::Ledger;
use super::ring::{RingMotion, RingState};
use super::run::Motion;
use super::state::MotionState;
use crate::error::DynamicsError;
use crate::model::{ContactMode, Hold, Model, ShaftDof};
use crate::schedule::Schedule;
use crate::solution::StaticSolution;

impl Motion<'_> {
    /// The state at static equilibrium, at rest but for the turning of the inner ring.
    pub fn start(&self, solution: &StaticSolution) -> MotionState {
        let model = self.model;
        let q = solution.displacements.shaft;
        let omega = self.settings.speed.at(0.0);
        let ring = |side: Side| {
            let motion = self.rings[side.index()].as_ref()?;
            let elastic = solution.elastic[side.index()].as_ref()?;
            Some(ring_at_start(
                motion,
                elastic,
                if side == Side::Inner { q } else { [0.0; 5] },
                omega,
            ))
        };
        let forces = solution.balls.iter().flat_map(|b| {
            [(Side::Inner, &b.inner), (Side::Outer, &b.outer)].map(|(side, c)| {
                let (sin, cos) = c.contact_angle_rad.sin_cos();
                [side.sign() * c.force_n * cos, side.sign() * c.force_n * sin]
            })
        });
        let angles = solution
            .balls
            .iter()
            .flat_map(|b| [b.inner.contact_angle_rad, b.outer.contact_angle_rad]);
        let mut state = MotionState {
            step: 0,
            rings: [ring(Side::Inner), ring(Side::Outer)],
            balls: solution.displacements.balls.clone(),
            ball_velocities: vec![[0.0; 2]; model.geometry.n_balls],
            shaft: q,
            shaft_velocity: [0.0; 5],
            forces: forces.collect(),
            angles: angles.collect(),
            approaches: solution
                .balls
                .iter()
                .flat_map(|b| [b.inner.approach_m, b.outer.approach_m])
                .collect(),
            ledger: Ledger::default(),
        };
        state.ledger.hertz = solution.hertz_energy;
        self.measure_energies(&mut state);
        state.ledger.initial = state.ledger.total();
        state.ledger.note_scale();
        state
    }
}

/// Coordinates of a ring at static equilibrium: elastic part plus the shaft's motion, and the velocity that a
/// displacement fixed in space has in the turning frame.
fn ring_at_start(motion: &RingMotion, elastic: &[f64], q: [f64; 5], omega: f64) -> RingState {
    let coordinates = &motion.coordinates;
    let (dofs, first) = coordinates.shaft();
    let field = |q: [f64; 5]| {
        let mut y = vec![0.0; coordinates.n()];
        for (i, &dof) in coordinates.free().iter().enumerate() {
            y[i] = coordinates.rigid_motion(dof, q);
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
    let mut state = RingState::at_rest(w);
    state.v = field([omega * q[1], -omega * q[0], 0.0, omega * q[4], -omega * q[3]]);
    state
}

/// Refuses what statics knows and motion does not.
pub(super) fn check_supported(model: &Model) -> Result<(), DynamicsError> {
    let refuse = |what: &'static str| Err(DynamicsError::NotInMotion { what });
    if model.contact.mode == ContactMode::Facet {
        return refuse("contact.mode = \"facet\"; use \"patch\"");
    }
    if model.rings.iter().flatten().any(|r| r.hold == Hold::MeanMotion) {
        return refuse("support = \"mean_motion\"; use \"clamped\"");
    }
    if (0..5).any(|i| model.shaft[i] != ShaftDof::Free && model.shaft_schedules[i] != Schedule::Constant) {
        return refuse("an imposed shaft displacement with a schedule");
    }
    if model.effects.iter().any(|e| e.name() == "gyroscopic_moment") {
        return refuse("[effects.gyroscopic_moment]");
    }
    let same = |a: usize, b: usize| {
        matches!((model.shaft[a], model.shaft[b]), (ShaftDof::Free, ShaftDof::Free))
            || (model.shaft[a] == ShaftDof::Prescribed(0.0) && model.shaft[b] == ShaftDof::Prescribed(0.0))
    };
    let axial = matches!(model.shaft[2], ShaftDof::Free) || model.shaft[2] == ShaftDof::Prescribed(0.0);
    if model.ring(Side::Inner).is_some() && !(same(0, 1) && same(3, 4) && axial) {
        return refuse(
            "a flexible inner ring whose shaft has x and y, or both tilts, held differently or driven",
        );
    }
    Ok(())
}
