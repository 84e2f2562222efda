//! A cage and its land, as a scene describes them.

use contact::{ContactLaw, Side};

/// A cage, as a scene describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cage {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about its axis, kg m^2.
    pub polar: f64,
    /// The same across it.
    pub transverse: f64,
    /// Diametral clearance of a ball in its pocket, m.
    pub pocket_clearance: f64,
    /// Azimuths of the pockets beyond equal spacing, rad, by ball.
    pub pocket_offsets: Vec<f64>,
    /// Force over overlap^1.5, N/m^1.5.
    pub stiffness: f64,
    /// What an impact leaves of the speed.
    pub restitution: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// The land that guides it; None: the balls do.
    pub land: Option<Land>,
}

/// The land that guides a cage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Land {
    /// Its ring.
    pub side: Side,
    /// Its radius, m.
    pub radius: f64,
    /// Axial width of the cage, m.
    pub width: f64,
    /// Diametral clearance, m.
    pub clearance: f64,
    /// Viscosity of what fills the gap, Pa s; 0: no drag.
    pub viscosity: f64,
}

impl Land {
    /// Torque of the drag over the relative speed, N m s (Petroff).
    pub fn drag(&self) -> f64 {
        if self.viscosity == 0.0 {
            return 0.0;
        }
        2.0 * std::f64::consts::PI * self.viscosity * self.radius.powi(3) * self.width
            / (0.5 * self.clearance)
    }
}

impl Cage {
    /// Force over overlap.
    pub fn law(&self) -> ContactLaw {
        ContactLaw {
            stiffness: self.stiffness,
            patch_compliance: 0.0,
            ball_compliance: 0.0,
        }
    }

    /// Mass of each of its coordinates: kg, then kg m^2 of tilts and turn.
    pub fn masses(&self) -> [f64; 6] {
        let (m, t) = (self.mass, self.transverse);
        [m, m, m, t, t, self.polar]
    }

    /// How many ends a land guides.
    pub fn n_ends(&self) -> usize {
        self.land.map_or(0, |_| 2)
    }
}
