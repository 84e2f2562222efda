//! A cage with six dofs: its pockets push balls, and a land of a ring may guide it.
//!
//! The cage is rigid. Its tilts are small, its turn theta is any. A pocket is a cylinder whose axis is radial; with u =
//! b - x_c from the centre of the cage to the ball, and e_psi, e_z directions of the pocket in the cage,
//!
//! ```text
//! d = (u . e_psi,  u_z + tilt_y u_x - tilt_x u_y)          from the pocket's centre to the ball's
//! overlap |d| - c_p/2,   force k overlap^1.5 along d,   energy 2/5 k overlap^2.5
//! ```
//!
//! c_p is the diametral clearance. The land holds the ends of the cage: in the planes z = -w/2 and w/2 of the cage the
//! overlap is the eccentricity less c_g/2, by the same law. Forces over a step are discrete gradients
//! ([`super::discrete_gradient`]), and what they do on the coordinates is such that their work is exactly the change of
//! the stored energy.
//!
//! **Impacts** lose energy by Hunt and Crossley's factor ([`impact`]), so that the restitution is the one given, at any
//! speed. **Friction** of balls in pockets and of the cage on its land is Coulomb's, at the slip of the end of the step
//! as the traction of the raceways ([`super::free_contact`]); where that would do work, at the slip of the middle.
//! **Drag** of the land is Petroff's, 2 pi eta R^3 w / (c_g/2) times the relative speed, as if concentric.
//!
//! The land belongs to what carries the ring: deformation of the ring there is left out. Moment of momentum about the
//! axis is kept to the second order in the tilts.

pub mod design;
pub mod impact;
pub mod land;
pub mod links;
pub mod pocket;

pub use self::design::{Cage, Land};

use super::free_contact::jet::Jet;

/// Least slip, m/s, below which friction grows in proportion to slip.
const LEAST_SLIP: f64 = 1e-3;
/// The same over the speed of the ball's surface.
const SHARE_OF_SURFACE: f64 = 1e-3;

/// Slip below which friction grows in proportion to it, of a surface that moves at `speed` m/s.
pub fn small_slip(speed: f64) -> f64 {
    LEAST_SLIP.max(SHARE_OF_SURFACE * speed.abs())
}

/// What a contact of the cage does over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CageForce {
    /// Normal force: in a pocket on the ball along e_psi and e_z, on a land on the cage along x and y, N.
    pub normal: [f64; 2],
    /// Energy stored at start and end, J.
    pub energy: [f64; 2],
    /// Energy lost to impacts, J.
    pub impact_loss: f64,
    /// Work of friction on both bodies, J: never positive once the step is solved.
    pub friction_work: f64,
    /// Part of it at the slip that friction follows, J.
    pub work_at_slip: f64,
    /// Torque of friction about the axis on the cage, N m.
    pub torque: f64,
    /// Whether it touches at the end.
    pub touches: bool,
}

/// Coulomb's friction under the force `normal` at a slip, on the body whose slip it is.
fn friction(coefficient: f64, normal: Jet, slip: [Jet; 2], small: f64) -> [Jet; 2] {
    let size = (slip[0] * slip[0] + slip[1] * slip[1] + small * small).sqrt();
    let share = normal * size.recip() * -coefficient;
    slip.map(|s| share * s)
}
