//! An isotropic linear elastic material.

use crate::error::FemError;

/// Constants of an isotropic linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, Pa.
    pub young_modulus: f64,
    /// Poisson's ratio, dimensionless.
    pub poisson_ratio: f64,
    /// Mass density, kg/m^3.
    pub density: f64,
}

impl Material {
    /// A material with E in Pa, Poisson's ratio and density in kg/m^3, checked by [`Self::validate`].
    pub fn new(young_modulus: f64, poisson_ratio: f64, density: f64) -> Result<Material, FemError> {
        let material = Material {
            young_modulus,
            poisson_ratio,
            density,
        };
        material.validate()?;
        Ok(material)
    }

    /// Refuses constants outside `E > 0`, `-1 < nu < 1/2`, `rho > 0`, and non-finite ones.
    ///
    /// These are the bounds for which the strain energy is positive (Timoshenko and Goodier, Theory of
    /// Elasticity, 3rd ed., 1970, art. 90).
    pub fn validate(&self) -> Result<(), FemError> {
        let refuse = |quantity, value, expected| {
            Err(FemError::InvalidMaterial {
                quantity,
                value,
                expected,
            })
        };
        if !(self.young_modulus > 0.0 && self.young_modulus.is_finite()) {
            return refuse(
                "young's modulus",
                self.young_modulus,
                "a positive number of pascals",
            );
        }
        if !(self.poisson_ratio > -1.0 && self.poisson_ratio < 0.5) {
            return refuse(
                "poisson's ratio",
                self.poisson_ratio,
                "a number above -1 and below 0.5",
            );
        }
        if !(self.density > 0.0 && self.density.is_finite()) {
            return refuse("density", self.density, "a positive number of kg/m^3");
        }
        Ok(())
    }

    /// Lamé's first constant, `E nu / ((1 + nu)(1 - 2 nu))`, Pa.
    pub fn lame_lambda(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.young_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Shear modulus, `E / (2 (1 + nu))`, Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.young_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// Hooke's law: stress, Pa, from strain with engineering shear, both in the order of [`crate::stress`].
    pub fn stress(&self, strain: [f64; 6]) -> [f64; 6] {
        hooke(self.lame_lambda(), self.shear_modulus(), strain)
    }
}

/// Stress `lambda tr(e) I + 2 mu e`, Pa, from strain with engineering shear.
pub(crate) fn hooke(lambda: f64, mu: f64, strain: [f64; 6]) -> [f64; 6] {
    let pressure = lambda * (strain[0] + strain[1] + strain[2]);
    [
        pressure + 2.0 * mu * strain[0],
        pressure + 2.0 * mu * strain[1],
        pressure + 2.0 * mu * strain[2],
        mu * strain[3],
        mu * strain[4],
        mu * strain[5],
    ]
}
