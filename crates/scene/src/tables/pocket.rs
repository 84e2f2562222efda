//! Stiffness of a cage's pockets: as given, or Hertz's of the ball in a cylinder of the cage's material.

use std::ops::RangeInclusive;

use contact::hertz::{Elastic, HertzContact};
use input::{HERTZ_STIFFNESS, Problems, Quantity, STRESS};

use super::materials::MaterialProperties;

/// Softest and stiffest pocket, N/m^1.5: rubber to a ball on a steel flat.
const STIFFNESSES: RangeInclusive<f64> = 1e4..=1e12;
/// Soft plastics to steel, Pa.
const MODULI: RangeInclusive<f64> = 1e8..=5e11;

/// What the scene says of it.
#[derive(Clone, Copy)]
pub struct PocketKeys<'a> {
    pub stiffness: Option<&'a Quantity<HERTZ_STIFFNESS>>,
    pub young_modulus: Option<&'a Quantity<STRESS>>,
    pub poisson_ratio: Option<f64>,
}

/// A ball and the diametral clearance that it has, m.
pub struct PocketFit<'a> {
    pub diameter: f64,
    pub clearance: f64,
    pub material: &'a MaterialProperties,
}

impl PocketKeys<'_> {
    /// Force over overlap^1.5, N/m^1.5; None where something is wrong, or the pocket is not known.
    pub fn check(self, fit: Option<PocketFit<'_>>, problems: &mut Problems) -> Option<f64> {
        match (self.stiffness, self.young_modulus) {
            (Some(_), Some(_)) => {
                problems.add(
                    "cage.pocket_stiffness and cage.young_modulus both say how stiff pockets are; keep one of them",
                );
                None
            }
            (Some(stiffness), None) => {
                self.refuse_poisson_ratio(problems);
                problems.require(
                    STIFFNESSES.contains(&stiffness.si()),
                    "cage.pocket_stiffness",
                    stiffness,
                    "expected 1e4 to 1e12 N/m^1.5; polymer cages have about 1e8, steel ones 1e9 to 1e10",
                );
                Some(stiffness.si())
            }
            (None, Some(modulus)) => self.hertz(modulus, fit, problems),
            (None, None) => {
                self.refuse_poisson_ratio(problems);
                problems.add(
                    "[cage] needs pocket_stiffness, such as \"2e8 N/m^1.5\": force over overlap^1.5 in a pocket; or \
                     young_modulus, such as \"3 GPa\", and poisson_ratio of its material",
                );
                None
            }
        }
    }

    fn refuse_poisson_ratio(self, problems: &mut Problems) {
        if self.poisson_ratio.is_some() {
            problems
                .add("cage.poisson_ratio does nothing without cage.young_modulus; add it, or remove this");
        }
    }

    /// That of a ball in a cylinder whose axis points to the axis of the bearing.
    fn hertz(
        self,
        modulus: &Quantity<STRESS>,
        fit: Option<PocketFit<'_>>,
        problems: &mut Problems,
    ) -> Option<f64> {
        problems.require(
            MODULI.contains(&modulus.si()),
            "cage.young_modulus",
            modulus,
            "expected 0.1 to 500 GPa; polymer cages have 2 to 10 GPa, brass 100 GPa, steel 207 GPa",
        );
        let Some(ratio) = self.poisson_ratio else {
            problems.add("[cage] needs poisson_ratio beside young_modulus, such as 0.4");
            return None;
        };
        problems.require(
            (0.0..=0.49).contains(&ratio),
            "cage.poisson_ratio",
            ratio,
            "expected 0 to 0.49",
        );
        let fit = fit?;
        if fit.clearance == 0.0 {
            problems.add(
                "cage.young_modulus needs a pocket_clearance above 0: a ball that fills its pocket is no Hertz \
                 contact; or give pocket_stiffness",
            );
            return None;
        }
        let compliance = |young_modulus, poisson_ratio| {
            let elastic = Elastic {
                young_modulus,
                poisson_ratio,
            };
            elastic.plane_compliance()
        };
        let ball = fit.material;
        let sum = compliance(modulus.si(), ratio) + compliance(ball.young_modulus, ball.poisson_ratio);
        let [ball_curvature, pocket_curvature] =
            [fit.diameter, fit.diameter + fit.clearance].map(|diameter| 2.0 / diameter);
        let round = ball_curvature - pocket_curvature;
        Some(HertzContact::from_curvatures(round, ball_curvature, 1.0 / sum).stiffness)
    }
}
