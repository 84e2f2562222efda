//! `[cage]`: a cage with six dofs.
//!
//! ```toml
#![doc = include_str!("example_cage.toml")]
//! ```
//!
//! Without the table cage and balls follow the kinematics of rolling, or free balls have no cage.

use std::f64::consts::PI;

use contact::Side;
use dynamics::interactions::cage::{Cage, Land};
use input::{DENSITY, DYNAMIC_VISCOSITY, HERTZ_STIFFNESS, INERTIA, LENGTH, MASS, Problems, Quantity, STRESS};
use serde::Deserialize;

use super::balls::BallMotion;
use super::bearing::Bearing;
use super::materials::MaterialProperties;
use super::pocket::{PocketFit, PocketKeys};

/// How the cage moves.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum CageMotion {
    #[default]
    Kinematic,
    Free,
}

/// What guides it.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum Guidance {
    #[default]
    Balls,
    InnerLand,
    OuterLand,
}

/// As typed.
#[derive(Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [cage]")]
pub struct RawCage {
    #[serde(default)]
    motion: CageMotion,
    bore_diameter: Option<Quantity<LENGTH>>,
    outside_diameter: Option<Quantity<LENGTH>>,
    width: Option<Quantity<LENGTH>>,
    mass: Option<Quantity<MASS>>,
    density: Option<Quantity<DENSITY>>,
    inertia_z: Option<Quantity<INERTIA>>,
    inertia_t: Option<Quantity<INERTIA>>,
    pocket_clearance: Option<Quantity<LENGTH>>,
    pocket_stiffness: Option<Quantity<HERTZ_STIFFNESS>>,
    young_modulus: Option<Quantity<STRESS>>,
    poisson_ratio: Option<f64>,
    pocket_offsets: Option<Vec<Quantity<LENGTH>>>,
    #[serde(default)]
    guidance: Guidance,
    guidance_clearance: Option<Quantity<LENGTH>>,
    friction: Option<f64>,
    restitution: Option<f64>,
    land_viscosity: Option<Quantity<DYNAMIC_VISCOSITY>>,
}

/// Diameters of bore and outside, and width of a cage, m.
#[derive(Clone, Copy)]
struct CageTube {
    bore: f64,
    outside: f64,
    width: f64,
}

/// No cage grips more than its own weight twice.
const MOST_FRICTION: f64 = 2.0;
/// Less would stop a ball in its pocket.
const LEAST_RESTITUTION: f64 = 0.05;

impl RawCage {
    /// Checks the cage of a bearing whose balls move in this way; None where it is not free, or wrong.
    pub fn check(
        &self,
        (balls, is_dynamic): (BallMotion, bool),
        bearing: Option<&Bearing>,
        ball: Option<&MaterialProperties>,
        problems: &mut Problems,
    ) -> Option<Cage> {
        if self.motion == CageMotion::Kinematic {
            if self != &RawCage::default() {
                problems.add(
                    "[cage] has keys of a free cage, but cage.motion is \"kinematic\"; write motion = \"free\", or \
                     remove them",
                );
            }
            return None;
        }
        if balls != BallMotion::Free {
            problems.add(
                "cage.motion is \"free\", but the balls are kinematic and would not feel it; write [balls] with motion \
                 = \"free\"",
            );
        }
        if !is_dynamic {
            problems.add(
                "cage.motion is \"free\", which only motion in time computes; use [dynamic], or remove [cage]: balls \
                 of an equilibrium roll as if it let each go its own way",
            );
        }
        let bearing = bearing?;
        let tube = self.tube(bearing, problems);
        let inertia = self.inertia(tube, problems);
        let clearance = self.clearance(
            "pocket_clearance",
            &self.pocket_clearance,
            0.5 * bearing.ball_diameter,
            problems,
        );
        let stiffness = self.stiffness(clearance.zip(ball), bearing.ball_diameter, problems);
        let [friction, restitution] = self.coefficients(problems);
        let offsets = self.offsets(bearing, problems);
        let land = self.land(tube, problems);
        let [mass, polar, transverse] = inertia?;
        Some(Cage {
            mass,
            polar,
            transverse,
            pocket_clearance: clearance?,
            pocket_offsets: offsets,
            stiffness: stiffness?,
            restitution: restitution?,
            friction: friction?,
            land: land?,
        })
    }

    /// Stiffness of a pocket of this clearance, m, with a ball of this material and diameter, m.
    fn stiffness(
        &self,
        pocket: Option<(f64, &MaterialProperties)>,
        diameter: f64,
        problems: &mut Problems,
    ) -> Option<f64> {
        let keys = PocketKeys {
            stiffness: self.pocket_stiffness.as_ref(),
            young_modulus: self.young_modulus.as_ref(),
            poisson_ratio: self.poisson_ratio,
        };
        let fit = pocket.map(|(clearance, material)| PocketFit {
            diameter,
            clearance,
            material,
        });
        keys.check(fit, problems)
    }

    /// The cage as a tube, if its dimensions are given; they must hold the pitch circle between them.
    fn tube(&self, bearing: &Bearing, problems: &mut Problems) -> Option<CageTube> {
        let keys = [
            ("bore_diameter", &self.bore_diameter),
            ("outside_diameter", &self.outside_diameter),
            ("width", &self.width),
        ];
        if keys.iter().all(|(_, value)| value.is_none()) {
            return None;
        }
        for (key, value) in keys {
            match value {
                Some(value) => problems.require_positive(value, &format!("cage.{key}"), "a length"),
                None => problems.add(format!(
                    "[cage] needs {key}: bore_diameter, outside_diameter and width belong together"
                )),
            }
        }
        let (Some(bore), Some(outside), Some(width)) =
            (&self.bore_diameter, &self.outside_diameter, &self.width)
        else {
            return None;
        };
        let pitch = 0.5 * (bearing.inner_raceway_diameter + bearing.outer_raceway_diameter);
        problems.require(
            bore.si() < pitch,
            "cage.bore_diameter",
            bore,
            format!(
                "expected less than the pitch diameter of {:.3} mm, on which the pockets stand",
                1e3 * pitch
            ),
        );
        problems.require(
            outside.si() > pitch,
            "cage.outside_diameter",
            outside,
            format!(
                "expected more than the pitch diameter of {:.3} mm, on which the pockets stand",
                1e3 * pitch
            ),
        );
        Some(CageTube {
            bore: bore.si(),
            outside: outside.si(),
            width: width.si(),
        })
    }

    /// Mass, moment of inertia about the axis and across it.
    fn inertia(&self, tube: Option<CageTube>, problems: &mut Problems) -> Option<[f64; 3]> {
        let mass = self.of_mass(tube, problems)?;
        let of_tube = tube.map(|CageTube { bore, outside, width }| {
            let squares = 0.25 * (bore * bore + outside * outside);
            [
                0.5 * mass * squares,
                mass / 12.0 * (3.0 * squares + width * width),
            ]
        });
        let given = [("inertia_z", &self.inertia_z), ("inertia_t", &self.inertia_t)];
        let mut found = [None; 2];
        for (i, (key, value)) in given.into_iter().enumerate() {
            found[i] = match (value, of_tube) {
                (Some(value), _) => {
                    problems.require_positive(value, &format!("cage.{key}"), "a moment of inertia");
                    Some(value.si())
                }
                (None, Some(tube)) => Some(tube[i]),
                (None, None) => {
                    problems.add(format!(
                        "[cage] needs {key}, or bore_diameter, outside_diameter and width to take it of a tube"
                    ));
                    None
                }
            };
        }
        let [polar, transverse] = [found[0]?, found[1]?];
        if polar > 2.0 * transverse {
            problems.add(format!(
                "cage.inertia_z is {polar} kg m2 and cage.inertia_t {transverse} kg m2; no body has more than twice as \
                 much about its axis as across it"
            ));
        }
        Some([mass, polar, transverse])
    }

    fn of_mass(&self, tube: Option<CageTube>, problems: &mut Problems) -> Option<f64> {
        match (&self.mass, &self.density, tube) {
            (Some(_), Some(_), _) => {
                problems.add("cage.mass and cage.density both say how heavy the cage is; keep one of them");
                None
            }
            (Some(mass), None, _) => {
                problems.require_positive(mass, "cage.mass", "a mass");
                Some(mass.si())
            }
            (None, Some(density), Some(CageTube { bore, outside, width })) => {
                problems.require_positive(density, "cage.density", "a density");
                Some(density.si() * 0.25 * PI * (outside * outside - bore * bore) * width)
            }
            (None, Some(_), None) => {
                problems.add(
                    "cage.density needs the tube that it fills: bore_diameter, outside_diameter, width; or give mass",
                );
                None
            }
            (None, None, _) => {
                problems.add("[cage] needs mass, such as \"12 g\", or density and the dimensions of a tube");
                None
            }
        }
    }

    fn clearance(
        &self,
        key: &str,
        value: &Option<Quantity<LENGTH>>,
        most: f64,
        problems: &mut Problems,
    ) -> Option<f64> {
        let Some(value) = value else {
            problems.add(format!(
                "[cage] needs {key}, the diametral clearance, such as \"0.2 mm\""
            ));
            return None;
        };
        problems.require(
            (0.0..=most).contains(&value.si()),
            &format!("cage.{key}"),
            value,
            format!("expected a diametral clearance of 0 to {:.3} mm", 1e3 * most),
        );
        Some(value.si())
    }

    fn coefficients(&self, problems: &mut Problems) -> [Option<f64>; 2] {
        match self.friction {
            Some(friction) => problems.require(
                (0.0..=MOST_FRICTION).contains(&friction),
                "cage.friction",
                friction,
                "expected a coefficient of friction from 0 to 2",
            ),
            None => problems.add("[cage] needs friction, a coefficient such as 0.1; 0 is frictionless"),
        }
        match self.restitution {
            Some(restitution) => problems.require(
                (LEAST_RESTITUTION..=1.0).contains(&restitution),
                "cage.restitution",
                restitution,
                "expected 0.05 to 1, the share of the speed that an impact leaves; 1 loses nothing",
            ),
            None => problems.add("[cage] needs restitution, from 0.05 to 1, such as 0.6; 1 loses nothing"),
        }
        [self.friction, self.restitution]
    }

    /// Offsets of the pockets, rad.
    fn offsets(&self, bearing: &Bearing, problems: &mut Problems) -> Vec<f64> {
        let Some(offsets) = &self.pocket_offsets else {
            return Vec::new();
        };
        if offsets.len() != bearing.balls {
            problems.add(format!(
                "cage.pocket_offsets has {} values for {} balls; give one for each pocket",
                offsets.len(),
                bearing.balls
            ));
        }
        for (i, offset) in offsets.iter().enumerate() {
            problems.require(
                offset.si().abs() <= 0.1 * bearing.ball_diameter,
                &format!("cage.pocket_offsets[{i}]"),
                offset,
                "expected at most a tenth of the ball, to either side",
            );
        }
        let radius = 0.25 * (bearing.inner_raceway_diameter + bearing.outer_raceway_diameter);
        offsets.iter().map(|offset| offset.si() / radius).collect()
    }

    /// The land, if one guides it; None where it is wrong.
    fn land(&self, tube: Option<CageTube>, problems: &mut Problems) -> Option<Option<Land>> {
        let side = match self.guidance {
            Guidance::Balls => {
                for (key, given) in [
                    ("guidance_clearance", self.guidance_clearance.is_some()),
                    ("land_viscosity", self.land_viscosity.is_some()),
                ] {
                    if given {
                        problems.add(format!(
                            "cage.{key} does nothing where the balls guide the cage; write guidance = \"inner_land\" \
                             or \"outer_land\", or remove it"
                        ));
                    }
                }
                return Some(None);
            }
            Guidance::InnerLand => Side::Inner,
            Guidance::OuterLand => Side::Outer,
        };
        if tube.is_none() {
            problems.add(
                "[cage] needs bore_diameter, outside_diameter and width to meet the land of cage.guidance",
            );
        }
        let clearance = self.clearance("guidance_clearance", &self.guidance_clearance, 5e-3, problems);
        let viscosity = self.land_viscosity.as_ref();
        if let Some(viscosity) = viscosity {
            problems.require_positive(viscosity, "cage.land_viscosity", "a viscosity");
            if clearance == Some(0.0) {
                problems.add(
                    "cage.land_viscosity needs a gap to shear; give guidance_clearance above 0, or remove it",
                );
            }
        }
        let CageTube { bore, outside, width } = tube?;
        Some(Some(Land {
            side,
            radius: 0.5 * side.choose(bore, outside),
            width,
            clearance: clearance?,
            viscosity: viscosity.map_or(0.0, Quantity::si),
        }))
    }
}
