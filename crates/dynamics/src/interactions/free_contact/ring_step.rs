//! The ring's side of a contact over a step, and where its forces act.

use super::jet::{Jet, N_LENGTHS, Vector, dot};
use super::place::{ContactFrame, SlipJets};

/// Nodal weights of a contact on an elastic ring on which forces act: groove r, z; patch t, q.
pub const FREE_FEET: usize = 2;
/// Functionals of a contact on an elastic ring: two of all its nodal weights.
pub const FREE_PORTS: usize = 2 * FREE_FEET;
/// Lengths of a contact that are those of its ball: displacement and rotation vector.
pub const BALL_LENGTHS: usize = 6;
/// First of the lengths of a contact that are the motion of an elastic ring's ports.
pub const GROOVE_LENGTH: usize = 6;

/// The ring's side of a contact over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RingStep {
    /// What carries the ring at the start: displacement and velocity; zero of an elastic ring.
    pub carrier: [[f64; 5]; 2],
    /// Whether a dof of the carrier has inertia: else its velocity is the mean over the step.
    pub has_inertia: [bool; 5],
    /// Of an elastic ring; None: it is rigid.
    pub elastic: Option<ElasticPlace>,
    /// Mean speed of the ring over the step, and that at its end, rad/s.
    pub spin: [f64; 2],
}

/// An elastic ring at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticPlace {
    /// Motion of groove (r, z) and patch (t, q) at the start, m.
    pub start: [f64; FREE_PORTS],
    /// Growth of the groove's motion (r, z) with the azimuth, mean over the step, m/rad.
    pub slope: [f64; 2],
}

impl RingStep {
    /// What carries the ring at the end, for the lengths there; zero of an elastic ring.
    pub(super) fn carrier_at_end(&self, x: &[Jet; N_LENGTHS]) -> [Jet; 5] {
        match self.elastic {
            Some(_) => [Jet::default(); 5],
            None => std::array::from_fn(|i| x[6 + i]),
        }
    }
}

/// The middle of a step.
pub(super) struct Middle {
    /// Directions there.
    pub frame: ContactFrame,
    /// From the ring's centre to the ball's, m.
    pub arm: Vector,
    /// Slip there.
    pub slip: SlipJets,
}

impl Middle {
    /// Adds a force and a moment about the ring's centre, both on the ring, to what resists the carrier's motion.
    pub(super) fn add_to_ring(&self, force: Vector, moment: Vector, resists: &mut [Jet; N_LENGTHS]) {
        for i in 0..3 {
            resists[6 + i] = resists[6 + i] - force[i];
        }
        for (i, turning) in self.frame.tilts.into_iter().enumerate() {
            resists[9 + i] = resists[9 + i] - dot(turning, moment);
        }
    }
}

/// A force on a ball by the slope of a ring or of its surface, over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlopeForce {
    /// Along the rolling direction, N.
    pub force: f64,
    /// Its work on the ball and, of a surface, on the ring, J.
    pub work: f64,
    /// Its torque about the axis, N m.
    pub torque: f64,
}
