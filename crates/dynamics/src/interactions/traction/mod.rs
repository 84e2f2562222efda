//! Traction of a ball on a raceway: friction over the ellipse of the contact, with spin and differential slip.
//!
//! Frame of a contact: t the direction of rolling, n the normal from the ball's centre to the raceway, q = n x t along
//! the groove. In the tangent plane at the place x t + y q of the ellipse, with dw the angular velocity of the ball
//! less that of the ring and s_0 the slip at the contact's centre,
//!
//! ```text
//! s_t = s_0t - dw_n y + dw_q z        z = -y^2 / (2 R_d),  R_d = 2 R r / (R + r)
//! s_q = s_0q + dw_n x - dw_t z
//! f   = -mu(|s|) Q w s / sqrt(s^2 + s_v^2)      on the ball; the ring gets -f at the same place
//! ```
//!
//! w is the share of the place in Hertz's pressure. R_d is the radius of the deformed surface across the track
//! (Heathcote 1921; Johnson, Contact Mechanics, 1985, 8.5): it embraces the ball, so z is negative towards its centre.
//! Power f . s is never positive. The slip s_v below which force grows in proportion to slip is that of elastic creep
//! ([`Creep`]).
//!
//! Validity: Coulomb's law at each place by itself; the stick zone of full rolling contact theory is smeared over s_v.
//! Cost: one square root per place, 45 places by default.

pub mod creep;
pub mod law;
pub mod limiting_shear;
pub mod patch;
pub mod pv;

pub use creep::Creep;
pub use law::{Curve, TractionLaw};
pub use limiting_shear::LimitingShear;
pub use patch::{Ellipse, PatchPoints, Resultant, Slip};
pub use pv::{PressureLine, largest_pv};

/// What a scene says of traction.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction {
    /// Coefficient over slip.
    pub law: TractionLaw,
    /// Slope at small slip.
    pub creep: Creep,
    /// PatchPoints over the ellipse.
    pub places: PatchPoints,
}
