//! The slip below which traction grows in proportion to it.
//!
//! Elastic bodies creep: for small slip s at the rolling speed V the force is G a b C_11 s / V (Kalker 1967, linear
//! theory). The regularised law mu Q s / s_v has that slope for
//!
//! ```text
//! s_v = V mu Q / (G a b C_11)
//! ```
//!
//! C_11 for Poisson's ratio 0.25 by b/a, b the semi-axis along the rolling direction; across it the coefficient C_22 is
//! a quarter less, and C_11 stands for both. Q/(a b) goes with Q^(1/3), so a light load is no special case.

use contact::SemiAxes;

/// How the slope at small slip is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Creep {
    /// From elastic creep.
    Elastic,
    /// s_v over the rolling speed.
    Ratio(f64),
}

/// Least s_v, m/s: what rolls at no speed has no creep of its own.
pub const LEAST_SLIP: f64 = 1e-6;

/// b/a and C_11 (Kalker 1967, nu = 0.25).
const C_11: [[f64; 2]; 5] = [[0.1, 3.31], [0.2, 3.37], [0.3, 3.44], [0.5, 3.62], [1.0, 4.12]];

/// What creep depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingContact {
    /// Speed with which material runs through the contact, m/s.
    pub speed: f64,
    /// Force, N.
    pub force: f64,
    /// Semi-axes of the ellipse, m.
    pub semi_axes: SemiAxes,
    /// Combined shear modulus, 2/G = 1/G_1 + 1/G_2, Pa.
    pub shear_modulus: f64,
}

impl Creep {
    /// s_v for the coefficient `mu` at small slip, m/s.
    pub fn slip(&self, mu: f64, rolling: &RollingContact) -> f64 {
        let ratio = match self {
            Creep::Ratio(ratio) => *ratio,
            Creep::Elastic => {
                let [a, b] = rolling.semi_axes.into();
                mu * rolling.force / (rolling.shear_modulus * a * b * creep_coefficient(b / a))
            }
        };
        (ratio * rolling.speed.abs()).max(LEAST_SLIP)
    }
}

/// Kalker's C_11 at b/a, linear between the values of his table and constant beyond them.
fn creep_coefficient(ratio: f64) -> f64 {
    let after = C_11.iter().position(|[at, _]| *at > ratio);
    match after {
        Some(0) => C_11[0][1],
        None => C_11[C_11.len() - 1][1],
        Some(i) => {
            let ([x0, y0], [x1, y1]) = (C_11[i - 1], C_11[i]);
            y0 + (y1 - y0) * (ratio - x0) / (x1 - x0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::hertz::Elastic;
    use contact::{BearingGeometry, HertzContact, Side};

    /// Wrong: the slope at small slip. 7010C at 332 N and mu = 0.07: s_v/V = 8.4e-4 inside and 8.2e-4 outside, two
    /// digits.
    #[test]
    fn creep_of_the_7010c_is_that_of_linear_theory() {
        let steel = Elastic {
            young_modulus: 207e9,
            poisson_ratio: 0.3,
        };
        let geometry = BearingGeometry::reference_7010c();
        for (side, expected) in [(Side::Inner, 8.4e-4), (Side::Outer, 8.2e-4)] {
            let rolling = RollingContact {
                speed: 3.0,
                force: 332.0,
                semi_axes: HertzContact::new(&geometry, side, steel, steel).semi_axes(332.0),
                shear_modulus: 207e9 / 2.6,
            };
            let found = Creep::Elastic.slip(0.07, &rolling) / 3.0;
            assert!((found / expected - 1.0).abs() < 0.02, "{side:?}: {found}");
        }
    }

    /// Wrong: a ratio given by the user would be scaled by load or material, or a bearing at rest divide by zero.
    #[test]
    fn a_given_ratio_is_taken_as_it_is() {
        let mut rolling = RollingContact {
            speed: -2.0,
            force: 1.0,
            semi_axes: SemiAxes::new(1e-3, 1e-4),
            shear_modulus: 8e10,
        };
        assert_eq!(Creep::Ratio(1e-3).slip(0.1, &rolling), 2e-3);
        rolling.speed = 0.0;
        assert_eq!(Creep::Ratio(1e-3).slip(0.1, &rolling), LEAST_SLIP);
    }
}
