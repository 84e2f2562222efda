//! ```toml
#![doc = include_str!("example_life.toml")]
//! ```
//! What `raceway life` needs besides a run: ratings of a catalogue, reliability and lubrication. Nothing is guessed:
//! without viscosity or contamination there is no life with the factor a_ISO, and the command says so.

use input::{ANGLE, ANGULAR_SPEED, FORCE, Problems, Quantity, STRESS, Temperature, VISCOSITY};
use serde::Deserialize;

use super::oil::{ClassKeys, Oil};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [life]")]
pub struct RawLife {
    contact_angle: Option<Quantity<ANGLE>>,
    rating: Option<Quantity<FORCE>>,
    static_rating: Option<Quantity<FORCE>>,
    fatigue_limit: Option<Quantity<FORCE>>,
    #[serde(default)]
    grooves: LifeGrooves,
    reliability: Option<f64>,
    speed: Option<Quantity<ANGULAR_SPEED>>,
    viscosity_ratio: Option<f64>,
    viscosity: Option<Quantity<VISCOSITY>>,
    viscosity_class: Option<f64>,
    viscosity_at_100: Option<Quantity<VISCOSITY>>,
    temperature: Option<Temperature>,
    contamination: Option<f64>,
    shear_limit: Option<Quantity<STRESS>>,
}

/// Groove radii by which the rating is shared between the raceways.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum LifeGrooves {
    /// Those of the bearing.
    #[default]
    Own,
    /// 0.52 and 0.53 of the ball diameter, inside and outside: the reference of ISO 16281.
    Reference,
}

/// What a life needs besides loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Life {
    /// Nominal contact angle, rad; None for the free contact angle.
    pub contact_angle: Option<f64>,
    /// Dynamic rating C_r of a catalogue, N.
    pub rating: Option<f64>,
    /// Static rating C_0r of a catalogue, N.
    pub static_rating: Option<f64>,
    /// Fatigue load limit C_u, N.
    pub fatigue_limit: Option<f64>,
    /// Groove radii of the raceways' shares.
    pub grooves: LifeGrooves,
    /// Reliability, per cent.
    pub reliability: f64,
    /// Speed of the inner ring against the outer one, rad/s, for results without speeds.
    pub speed: Option<f64>,
    /// Lubricant.
    pub oil: Option<Oil>,
    /// Contamination factor e_C, above 0 to 1.
    pub contamination: Option<f64>,
    /// Shear stress below which a life from stress has no damage, Pa; None: 0.
    pub shear_limit: Option<f64>,
}

impl Default for Life {
    fn default() -> Life {
        Life {
            contact_angle: None,
            rating: None,
            static_rating: None,
            fatigue_limit: None,
            grooves: LifeGrooves::default(),
            reliability: RELIABILITIES[0],
            speed: None,
            oil: None,
            contamination: None,
            shear_limit: None,
        }
    }
}

/// Reliabilities for which ISO 281:2007, table 12, has the factor a_1, per cent.
const RELIABILITIES: [f64; 6] = [90.0, 95.0, 96.0, 97.0, 98.0, 99.0];

/// Largest nominal contact angle of a radial bearing (ISO 281, clause 3), rad, with round-off.
const MAX_CONTACT_ANGLE: f64 = std::f64::consts::FRAC_PI_4 * (1.0 + 1e-12);
/// No steel endures more shear, Pa.
const MOST_SHEAR: f64 = 2e9;
/// Largest plausible speed, rad/s, as in `[speed]`.
const MAX_SPEED: f64 = 1e5;

impl RawLife {
    /// Checks values and what belongs together; `has_speed`: whether the scene has `[speed]`.
    pub fn check(&self, has_speed: bool, problems: &mut Problems) -> Life {
        for (force, key) in [
            (&self.rating, "life.rating"),
            (&self.static_rating, "life.static_rating"),
            (&self.fatigue_limit, "life.fatigue_limit"),
        ] {
            if let Some(force) = force {
                problems.require_positive(force, key, "a rating");
            }
        }
        if let Some(angle) = &self.contact_angle {
            problems.require(
                (0.0..=MAX_CONTACT_ANGLE).contains(&angle.si()),
                "life.contact_angle",
                angle,
                "expected 0 deg to 45 deg; ISO 281 rates others as thrust bearings",
            );
        }
        let reliability = self.reliability.unwrap_or(RELIABILITIES[0]);
        problems.require(
            RELIABILITIES.contains(&reliability),
            "life.reliability",
            reliability,
            "expected 90, 95, 96, 97, 98 or 99 per cent",
        );
        if let Some(contamination) = self.contamination {
            problems.require(
                contamination > 0.0 && contamination <= 1.0,
                "life.contamination",
                contamination,
                "the factor e_C is above 0 (much dirt) and at most 1 (clean)",
            );
        }
        if let Some(limit) = &self.shear_limit {
            problems.require(
                (0.0..=MOST_SHEAR).contains(&limit.si()),
                "life.shear_limit",
                limit,
                "expected 0 to 2 GPa; hardened steel endures some hundred MPa of shear",
            );
        }
        self.check_speed(has_speed, problems);
        Life {
            contact_angle: self.contact_angle.as_ref().map(Quantity::si),
            rating: self.rating.as_ref().map(Quantity::si),
            static_rating: self.static_rating.as_ref().map(Quantity::si),
            fatigue_limit: self.fatigue_limit.as_ref().map(Quantity::si),
            grooves: self.grooves,
            reliability,
            speed: self.speed.as_ref().map(Quantity::si),
            oil: self.oil(problems),
            contamination: self.contamination,
            shear_limit: self.shear_limit.as_ref().map(Quantity::si),
        }
    }

    fn check_speed(&self, has_speed: bool, problems: &mut Problems) {
        let Some(speed) = &self.speed else { return };
        let size = speed.si().abs();
        problems.require(
            size > 0.0 && size <= MAX_SPEED,
            "life.speed",
            speed,
            "expected a speed of at most 1e5 rad/s (955 000 rpm), and not 0",
        );
        if has_speed {
            problems.add("life.speed is given, but [speed] says how fast the rings turn; remove life.speed");
        }
    }

    /// The lubricant: exactly one way to say it, or none.
    fn oil(&self, problems: &mut Problems) -> Option<Oil> {
        let given = [
            ("viscosity_ratio", self.viscosity_ratio.is_some()),
            ("viscosity", self.viscosity.is_some()),
            ("viscosity_class", self.viscosity_class.is_some()),
        ];
        let given: Vec<&str> = given
            .iter()
            .filter(|(_, is_given)| *is_given)
            .map(|(key, _)| *key)
            .collect();
        if let [first, second, ..] = given[..] {
            problems.add(format!(
                "life.{first} and life.{second} both say how thick the oil is; keep one of them"
            ));
            return None;
        }
        let keys = ClassKeys {
            table: "life",
            class: self.viscosity_class,
            at_100: self.viscosity_at_100.as_ref(),
            temperature_key: "temperature",
            temperature: self.temperature.as_ref(),
        };
        keys.check_idle(problems);
        match (self.viscosity_ratio, &self.viscosity, self.viscosity_class) {
            (Some(ratio), ..) => {
                problems.require(
                    ratio > 0.0 && ratio.is_finite(),
                    "life.viscosity_ratio",
                    ratio,
                    "kappa must be positive; ISO 281 knows 0.1 to 4",
                );
                Some(Oil::Ratio(ratio))
            }
            (_, Some(viscosity), _) => {
                problems.require_positive(viscosity, "life.viscosity", "a viscosity");
                Some(Oil::Viscosity(viscosity.si()))
            }
            (.., Some(class)) => keys.oil(class, problems),
            _ => None,
        }
    }
}
