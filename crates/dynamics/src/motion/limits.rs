//! Where the contacts of a motion leave what Hertz's theory and bearing steel can do: said, not refused.

use contact::Side;
use contact::patch_shape::is_truncated;

use super::run::{Motion, MovingRing};
use super::state::MotionState;
use crate::footprint::loaded;
use crate::footprint::sizes;
use crate::solution::STATIC_LIMIT;
use crate::surfaces::EllipseKind;

/// What a contact can exceed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLimit {
    /// The ellipse reaches beyond the groove of a flexible ring, or of any ring with edges.
    Edge,
    /// The peak pressure exceeds the static limit of bearing steel (ISO 76, 4.2 GPa).
    StaticPressure,
    /// A ball carries on the shoulder that an angular contact bearing does not have.
    WrongShoulder,
}

impl ContactLimit {
    /// All limits.
    pub const ALL: [ContactLimit; 3] = [
        ContactLimit::Edge,
        ContactLimit::StaticPressure,
        ContactLimit::WrongShoulder,
    ];
}

/// A contact beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// The limit.
    pub limit: ContactLimit,
    /// Ball.
    pub ball: usize,
    /// Raceway.
    pub side: Side,
    /// Peak pressure, Pa.
    pub pressure: f64,
}

impl Motion<'_> {
    /// Contacts beyond a limit: mean forces of the last step, contact angles at its end.
    pub fn exceeded(&self, state: &MotionState) -> Vec<Exceeded> {
        let carries = loaded(sizes(&state.forces));
        let mut found = Vec::new();
        for (index, force) in state.forces.iter().enumerate().filter(|(i, _)| carries[*i]) {
            let (ball, side) = (index / 2, Side::BOTH[index % 2]);
            let (hertz, force) = (&self.model.hertz[side.index()], force.norm());
            let axes = hertz.semi_axes(force);
            let bearing = self.strip_bearing(state, (ball, side), force);
            let peak = bearing.as_ref().map_or(1.0, |bearing| bearing.peak);
            let pressure = peak * hertz.peak_pressure(force);
            let mut add = |limit| {
                found.push(Exceeded {
                    limit,
                    ball,
                    side,
                    pressure,
                })
            };
            let beyond =
                |moving: &MovingRing| is_truncated(&moving.raceway.surface, state.angles[index], axes);
            let is_beyond = match self.model.surfaces.edges(side) {
                Some(_) => bearing.is_some_and(|bearing| bearing.kind == EllipseKind::Edge),
                None => {
                    let reach = axes.groove / self.model.geometry.groove_radius(side);
                    let shoulders = &self.model.shoulders;
                    self.rings[side.index()].as_ref().is_some_and(beyond)
                        || shoulders.is_beyond(side, state.angles[index], reach)
                }
            };
            if is_beyond {
                add(ContactLimit::Edge);
            }
            if pressure > STATIC_LIMIT {
                add(ContactLimit::StaticPressure);
            }
            if self.model.shoulders.is_against(state.angles[index]) {
                add(ContactLimit::WrongShoulder);
            }
        }
        found
    }
}
