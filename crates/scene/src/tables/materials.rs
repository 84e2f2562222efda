//! `[materials.rings]` and `[materials.balls]`: linear elastic, isotropic.

use input::{DENSITY, Expansion, Problems, Quantity, STRESS};
use serde::Deserialize;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the tables [materials.rings] and [materials.balls]"
)]
pub struct RawMaterials {
    rings: RawMaterial,
    balls: RawMaterial,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with young_modulus, poisson_ratio, density"
)]
struct RawMaterial {
    young_modulus: Quantity<STRESS>,
    poisson_ratio: f64,
    density: Quantity<DENSITY>,
    expansion: Option<Expansion>,
    yield_strength: Option<Quantity<STRESS>>,
}

/// What the bodies are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Both rings.
    pub rings: Material,
    /// All balls.
    pub balls: Material,
}

/// A linear elastic, isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus E, Pa.
    pub young_modulus: f64,
    /// Poisson's ratio nu, dimensionless, 0 to 0.49.
    pub poisson_ratio: f64,
    /// Density rho, kg/m3.
    pub density: f64,
    /// Thermal expansion alpha, 1/K; None: not given.
    pub expansion: Option<f64>,
    /// Yield strength, Pa; None: not given, and nothing is compared with it.
    pub yield_strength: Option<f64>,
}

impl Materials {
    /// Whether the thermal expansion of rings and balls is given.
    pub fn has_expansion(&self) -> [bool; 2] {
        [self.rings, self.balls].map(|material| material.expansion.is_some())
    }
}

/// Softer or stiffer than any solid: a slip of the unit, Pa.
const PLAUSIBLE_MODULUS: std::ops::RangeInclusive<f64> = 1e3..=1e13;
/// Lighter or heavier than any solid: a slip of the unit, kg/m3.
const PLAUSIBLE_DENSITY: std::ops::RangeInclusive<f64> = 1.0..=1e5;
/// Displacement elements lock when the material is nearly incompressible.
const MAX_POISSON_RATIO: f64 = 0.49;

impl RawMaterials {
    /// Checks both materials; `None` when there are problems.
    pub fn check(&self, problems: &mut Problems) -> Option<Materials> {
        let before = problems.len();
        let rings = self.rings.check("materials.rings", problems);
        let balls = self.balls.check("materials.balls", problems);
        (problems.len() == before).then_some(Materials { rings, balls })
    }
}

impl RawMaterial {
    fn check(&self, table: &str, problems: &mut Problems) -> Material {
        let (modulus, nu, density) = (self.young_modulus.si(), self.poisson_ratio, self.density.si());
        let key = format!("{table}.young_modulus");
        problems.require(
            PLAUSIBLE_MODULUS.contains(&modulus),
            &key,
            &self.young_modulus,
            "expected 1 kPa to 10 TPa",
        );
        let key = format!("{table}.poisson_ratio");
        if nu > MAX_POISSON_RATIO && nu < 0.5 {
            problems.require(
                false,
                &key,
                nu,
                "displacement elements lock above 0.49, such a material needs a mixed formulation",
            );
        } else {
            problems.require(
                (0.0..0.5).contains(&nu),
                &key,
                nu,
                "expected 0 to 0.49, steel has 0.3",
            );
        }
        let key = format!("{table}.density");
        problems.require(
            PLAUSIBLE_DENSITY.contains(&density),
            &key,
            &self.density,
            "expected 1 kg/m3 to 1e5 kg/m3, steel has 7800 kg/m3",
        );
        if let Some(expansion) = &self.expansion {
            expansion.check(&format!("{table}.expansion"), problems);
        }
        if let Some(strength) = &self.yield_strength {
            problems.require_positive(strength, &format!("{table}.yield_strength"), "a strength");
        }
        Material {
            young_modulus: modulus,
            poisson_ratio: nu,
            density,
            expansion: self.expansion.as_ref().map(Expansion::per_kelvin),
            yield_strength: self.yield_strength.as_ref().map(Quantity::si),
        }
    }
}
