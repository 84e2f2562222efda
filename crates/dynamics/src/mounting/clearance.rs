//! Radial clearance and free contact angle of a bearing whose grooves and balls have grown.
//!
//! ```text
//! P_d = D_e (1 + e_o) - d_i (1 + e_i) - 2 D_w (1 + e_b) + 2 (g_o - g_i),    cos a0 = 1 - P_d / (2 A)
//! A = R_i (1 + e_i) + R_o (1 + e_o) - D_w (1 + e_b)
//! ```
//!
//! e are thermal strains, g the growth of the groove bottoms' radii by their seats. Harris, Rolling Bearing Analysis,
//! 4th ed., chapters 2 and 3.

use contact::{BearingGeometry, BySide};

/// Clearance of a bearing without load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Radial (diametral) clearance P_d, m; negative is interference.
    pub radial: f64,
    /// Free contact angle a0, rad; 0 with interference.
    pub free_contact_angle: f64,
}

/// Clearance before mounting, mounted at the reference temperature, and at its temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearances {
    /// Of the bearing in its box.
    pub unmounted: Clearance,
    /// With its fits, at the reference temperature.
    pub mounted: Clearance,
    /// With its fits and temperatures.
    pub operating: Clearance,
}

impl Clearance {
    /// Clearance with strains of rings and balls, and growth of the groove bottoms' radii, m, inner first.
    pub fn new(
        geometry: &BearingGeometry,
        rings: BySide<f64>,
        balls: f64,
        grooves: BySide<f64>,
    ) -> Clearance {
        let mut grown = *geometry;
        grown.ball_diameter *= 1.0 + balls;
        grown.inner_raceway_diameter *= 1.0 + rings[0];
        grown.inner_raceway_diameter += 2.0 * grooves[0];
        grown.outer_raceway_diameter *= 1.0 + rings[1];
        grown.outer_raceway_diameter += 2.0 * grooves[1];
        grown.inner_groove_radius *= 1.0 + rings[0];
        grown.outer_groove_radius *= 1.0 + rings[1];
        Clearance {
            radial: grown.clearance(),
            free_contact_angle: grown.free_contact_angle(),
        }
    }

    /// The same of a bearing of another size.
    pub fn scaled(self, factor: f64) -> Clearance {
        Clearance {
            radial: factor * self.radial,
            ..self
        }
    }
}
