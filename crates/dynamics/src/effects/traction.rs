//! Traction of free balls on the raceways: friction with spin, differential slip and elastic creep.
//!
//! Needs `balls.motion = "free"`, and free balls need it: what carries a ball round is friction. The equations stand in
//! [`crate::interactions::traction`] and [`crate::interactions::free_contact`].
//!
//! Other laws in the place of `friction`:
//!
//! ```text
//! law = "curve"           at_rest = 0.02, most = 0.07, slip_of_most = "0.1 m/s", at_large = 0.03    Gupta's curve
//! law = "curve"           slips = ["0 m/s", "0.1 m/s", "2 m/s"], coefficients = [0.0, 0.07, 0.04]   a table
//! law = "limiting_shear"  eyring_stress = "5 MPa", limit = 0.08                   the film of [lubricant]
//! ```
//!
//! In an equilibrium every ball rolls steadily where it stands ([`super::steady_balls`]); a motion starts from there.
//! Creep has the shear moduli of ball and ring, a rigid ring those of the rings' steel.
//!
//! Rule of thumb: balls keep rolling while F_a > 10 Z F_c, F_c the centrifugal force of a ball (Hirano, ASLE Trans. 8
//! (1965) 425).

use contact::film::Lubricant;
use input::{Problems, Quantity, SPEED, STRESS};
use serde::Deserialize;

use super::ball_centrifugal::BallCentrifugal;
use super::loads::{Loads, Now};
use super::rules::{Case, Remark};
use super::steady_balls::SteadyBalls;
use super::table::{self, About, Context, Setting, SpeedRole};
use crate::error::DynamicsError;
use crate::interactions::traction::law::{CurvePoints, SlipTable};
use crate::interactions::traction::{Creep, Curve, LimitingShear, PatchPoints, Traction, TractionLaw};
use crate::kinematics::{BallSpeeds, RingSpeeds};
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.traction]              # needs [balls] with motion = "free"
law = "coulomb"                 # or "curve", "limiting_shear"
friction = 0.07                 # coefficient of friction: 0.07 to 0.15 dry or with boundary lubrication
# at_rest = 0.0                 # of "curve": coefficient without slip,
# most = 0.07                   # the largest one,
# slip_of_most = "0.1 m/s"      # the slip that has it,
# at_large = 0.03               # and that of large slip; or a table over slips:
# slips = ["0 m/s", "0.1 m/s"]
# coefficients = [0.0, 0.07]
# eyring_stress = "5 MPa"       # of "limiting_shear", with [lubricant]: stress at which the oil begins to thin,
# limit = 0.08                  # and largest shear stress over the pressure
creep = "elastic"               # optional: force at small slip by elastic creep, or a slip ratio such as 1e-3
points = [3, 15]                # optional: places over the ellipse, along the rolling direction and across it
"#;

/// Effects that free balls make wrong, and why.
pub const REPLACED_BY_FREE_BALLS: [(&str, &str); 4] = [
    (
        "ball_centrifugal",
        "the centrifugal force of a free ball is its inertia, it would act twice",
    ),
    (
        "gyroscopic_moment",
        "traction carries the gyroscopic moment of a free ball, it would act twice",
    ),
    (
        "orbit_inertia",
        "in equilibria free balls have no inertia along and across their orbits",
    ),
    ("cage_slip", "the slip of a free ball is a result, not given"),
];

/// Largest coefficient of friction that is no slip of the finger.
const MOST_FRICTION: f64 = 2.0;
/// Most places in a direction: the error is below that of the law itself long before.
const MOST_PLACES: usize = 63;
/// PatchPoints without the key.
const DEFAULT_PLACES: [usize; 2] = [3, 15];
/// Axial load per ball over its centrifugal force below which balls skid (Hirano).
const HIRANO: f64 = 10.0;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.traction]")]
pub struct TractionTable {
    law: Law,
    friction: Option<f64>,
    at_rest: Option<f64>,
    most: Option<f64>,
    slip_of_most: Option<Quantity<SPEED>>,
    at_large: Option<f64>,
    slips: Option<Vec<Quantity<SPEED>>>,
    coefficients: Option<Vec<f64>>,
    eyring_stress: Option<Quantity<STRESS>>,
    limit: Option<f64>,
    creep: Option<RawCreep>,
    points: Option<[usize; 2]>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum Law {
    Coulomb,
    Curve,
    LimitingShear,
}

#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged, expecting = "\"elastic\" or a slip ratio such as 1e-3")]
enum RawCreep {
    Name(CreepName),
    Ratio(f64),
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum CreepName {
    Elastic,
}

impl table::EffectTable for TractionTable {
    fn about() -> About {
        About {
            name: "traction",
            example: EXAMPLE,
            speed: SpeedRole::Optional,
            needs: &[],
            // It comes with another kind of balls, which is not varied.
            trial: None,
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let Some(table) = table else { return Vec::new() };
        let (force, axial) = (case.centrifugal_force(), case.load.axial / case.n_balls());
        let mut advice = Vec::new();
        if !case.speeds.is_zero() && axial <= HIRANO * force {
            let text = format!(
                "[effects.traction] is on, and balls may skid: F_a / (Z F_c) = {:.1}, and pure rolling needs more than \
                 {HIRANO:.0} (Hirano); look at the slip of the contacts and at cage_speed_rad_per_s",
                axial / force
            );
            advice.push(text.into());
        }
        if table.law == Law::LimitingShear {
            let text = "[effects.traction] has law = \"limiting_shear\", which is isothermal: above some 1 m/s of slip \
                        an oil warms and thins, and its traction is less; look at the slip of the contacts";
            advice.push(text.to_string().into());
        }
        advice
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        self.check_law(context.has_lubricant, problems);
        if let Some(RawCreep::Ratio(ratio)) = self.creep {
            problems.require(
                (1e-9..=1.0).contains(&ratio),
                "effects.traction.creep",
                ratio,
                "expected \"elastic\" or a slip ratio of 1e-9 to 1, the slip over the rolling speed up to which force \
                 grows in proportion",
            );
        }
        for (i, n) in self.points.iter().flatten().enumerate() {
            problems.require(
                (1..=MOST_PLACES).contains(n),
                &format!("effects.traction.points[{i}]"),
                n,
                "expected 1 to 63 places; 3 along the rolling direction and 15 across it are good to 1 %",
            );
        }
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(FreeBalls {
            traction: self.traction(setting.lubricant),
            at_start: BallCentrifugal {
                speeds: setting.speeds.clone(),
                slip: setting.slip,
                ball_speeds: BallSpeeds::OuterControl,
            },
        })))
    }
}

impl TractionTable {
    fn check_law(&self, has_lubricant: bool, problems: &mut Problems) {
        let points = [&self.at_rest, &self.most, &self.at_large];
        let has_points = points.iter().any(|x| x.is_some()) || self.slip_of_most.is_some();
        let has_table = self.slips.is_some() || self.coefficients.is_some();
        match self.law {
            Law::Coulomb => {
                if has_points || has_table {
                    problems.add(
                        "[effects.traction] has law = \"coulomb\", which takes friction alone; remove the keys of a \
                         curve, or write law = \"curve\"",
                    );
                }
                match self.friction {
                    Some(mu) => require_coefficient(mu, "friction", problems),
                    None => problems.add(
                        "[effects.traction] needs friction, the coefficient of law = \"coulomb\", such as 0.07; 0 is \
                         frictionless",
                    ),
                }
            }
            Law::Curve => {
                if self.friction.is_some() {
                    problems.add(
                        "effects.traction.friction does nothing with law = \"curve\"; remove it, or write law = \
                         \"coulomb\"",
                    );
                }
                match (has_points, has_table) {
                    (true, false) => self.check_points(problems),
                    (false, true) => self.check_table(problems),
                    _ => problems.add(
                        "[effects.traction] has law = \"curve\" and needs either at_rest, most, slip_of_most and \
                         at_large, or slips and coefficients",
                    ),
                }
            }
            Law::LimitingShear => {
                if has_points || has_table || self.friction.is_some() {
                    problems.add(
                        "[effects.traction] has law = \"limiting_shear\", whose coefficients follow from the film; \
                         remove friction and the keys of a curve",
                    );
                }
                if !has_lubricant {
                    problems.add(
                        "[effects.traction] has law = \"limiting_shear\", which shears a film; add the table \
                         [lubricant] with viscosity and pressure_coefficient",
                    );
                }
                self.check_film(problems);
            }
        }
        let has_film = self.eyring_stress.is_some() || self.limit.is_some();
        if has_film && self.law != Law::LimitingShear {
            problems.add(
                "[effects.traction]: eyring_stress and limit do nothing without law = \"limiting_shear\"; remove them",
            );
        }
    }

    fn check_film(&self, problems: &mut Problems) {
        let (Some(stress), Some(limit)) = (&self.eyring_stress, self.limit) else {
            problems.add(
                "[effects.traction] has law = \"limiting_shear\" and needs eyring_stress, such as \"5 MPa\", and \
                 limit, such as 0.08",
            );
            return;
        };
        problems.require_positive(
            stress,
            "effects.traction.eyring_stress",
            "the stress at which an oil begins to thin",
        );
        problems.require(
            limit > 0.0 && limit <= 1.0,
            "effects.traction.limit",
            limit,
            "expected above 0 to 1, the largest shear stress over the pressure: 0.05 to 0.1",
        );
    }

    fn check_points(&self, problems: &mut Problems) {
        let (Some(at_rest), Some(most), Some(slip), Some(at_large)) =
            (self.at_rest, self.most, &self.slip_of_most, self.at_large)
        else {
            problems
                .add("[effects.traction] needs all of at_rest, most, slip_of_most and at_large of its curve");
            return;
        };
        for (value, key) in [(at_rest, "at_rest"), (most, "most"), (at_large, "at_large")] {
            require_coefficient(value, key, problems);
        }
        problems.require_positive(
            slip,
            "effects.traction.slip_of_most",
            "the slip of the largest coefficient",
        );
        problems.require(
            most > at_rest && most > at_large,
            "effects.traction.most",
            most,
            "it must be more than at_rest and at_large, it is the peak of the curve",
        );
    }

    fn check_table(&self, problems: &mut Problems) {
        let (Some(slips), Some(coefficients)) = (&self.slips, &self.coefficients) else {
            problems.add("[effects.traction] needs both slips and coefficients of its curve");
            return;
        };
        if slips.len() != coefficients.len() || slips.len() < 2 {
            problems.add(format!(
                "[effects.traction] has {} slips and {} coefficients; expected as many of both, at least two",
                slips.len(),
                coefficients.len()
            ));
            return;
        }
        problems.require(
            slips[0].si() == 0.0,
            "effects.traction.slips[0]",
            &slips[0],
            "a curve begins without slip, at \"0 m/s\"",
        );
        for (i, pair) in slips.windows(2).enumerate() {
            problems.require(
                pair[0].si() < pair[1].si(),
                &format!("effects.traction.slips[{}]", i + 1),
                &pair[1],
                "slips must grow",
            );
        }
        for (i, mu) in coefficients.iter().enumerate() {
            require_coefficient(*mu, &format!("coefficients[{i}]"), problems);
        }
    }

    /// What a checked table says.
    fn traction(&self, oil: Option<Lubricant>) -> Traction {
        let film = self.eyring_stress.as_ref().zip(self.limit).zip(oil);
        let law = match (self.law, self.most, &self.slips) {
            (Law::Curve, Some(most), _) => TractionLaw::Curve(Curve::new(CurvePoints {
                at_rest: self.at_rest.unwrap_or_default(),
                most,
                slip_of_most: self.slip_of_most.as_ref().map_or(1.0, Quantity::si),
                at_large: self.at_large.unwrap_or_default(),
            })),
            (Law::Curve, None, Some(slips)) => TractionLaw::Table(SlipTable::new(
                slips.iter().map(Quantity::si).collect(),
                self.coefficients.clone().unwrap_or_default(),
            )),
            _ => match film {
                Some(((stress, limit), lubricant)) => TractionLaw::LimitingShear(LimitingShear {
                    eyring: stress.si(),
                    limit,
                    lubricant,
                }),
                None => TractionLaw::Coulomb(self.friction.unwrap_or_default()),
            },
        };
        Traction {
            law,
            creep: match self.creep {
                Some(RawCreep::Ratio(ratio)) => Creep::Ratio(ratio),
                Some(RawCreep::Name(CreepName::Elastic)) | None => Creep::Elastic,
            },
            places: PatchPoints::new(self.points.unwrap_or(DEFAULT_PLACES)),
        }
    }
}

fn require_coefficient(mu: f64, key: &str, problems: &mut Problems) {
    problems.require(
        (0.0..=MOST_FRICTION).contains(&mu),
        &format!("effects.traction.{key}"),
        mu,
        "expected a coefficient of friction from 0 to 2",
    );
}

/// Free balls: their traction, and what an equilibrium needs to be their start.
pub struct FreeBalls {
    /// Traction.
    pub traction: Traction,
    /// Centrifugal forces in an equilibrium, as long as nothing is known of the contacts.
    pub at_start: BallCentrifugal,
}

impl Effect for FreeBalls {
    fn name(&self) -> &'static str {
        "traction"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        // Over a step centrifugal force is inertia.
        if now.width > 0.0 {
            return Ok(());
        }
        match SteadyBalls::of(model, now)? {
            Some(balls) => balls.add_loads(model, now, loads),
            None => self.at_start.add_loads(model, now, loads)?,
        }
        Ok(())
    }

    fn rolling_speeds(&self) -> Option<&RingSpeeds> {
        Some(&self.at_start.speeds)
    }

    fn traction(&self) -> Option<&Traction> {
        Some(&self.traction)
    }
}
