//! ```toml
#![doc = include_str!("example_life.toml")]
//! ```
//! What `raceway life` needs besides a run: ratings of a catalogue, reliability and lubrication. Nothing is guessed:
//! without viscosity or contamination there is no life with the factor a_ISO, and the command says so.

use input::{ANGLE, ANGULAR_SPEED, FORCE, Problems, Quantity, Temperature, VISCOSITY};
use serde::Deserialize;

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

/// What is known of the lubricant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Oil {
    /// Viscosity ratio kappa, dimensionless.
    Ratio(f64),
    /// Kinematic viscosity at the temperature of the contacts, m2/s.
    Viscosity(f64),
    /// A class of ISO 3448 at a temperature.
    Class {
        /// Kinematic viscosity at 40 degC, m2/s.
        at_40: f64,
        /// At 100 degC, m2/s; None at 40 degC, where it is not needed.
        at_100: Option<f64>,
        /// Temperature of the contacts, K.
        temperature: f64,
    },
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
        }
    }
}

/// Reliabilities for which ISO 281:2007, table 12, has the factor a_1, per cent.
const RELIABILITIES: [f64; 6] = [90.0, 95.0, 96.0, 97.0, 98.0, 99.0];

/// Viscosity classes of ISO 3448:1992 and their mid-point viscosities at 40 degC, mm2/s.
const CLASSES: [[f64; 2]; 20] = [
    [2.0, 2.2],
    [3.0, 3.2],
    [5.0, 4.6],
    [7.0, 6.8],
    [10.0, 10.0],
    [15.0, 15.0],
    [22.0, 22.0],
    [32.0, 32.0],
    [46.0, 46.0],
    [68.0, 68.0],
    [100.0, 100.0],
    [150.0, 150.0],
    [220.0, 220.0],
    [320.0, 320.0],
    [460.0, 460.0],
    [680.0, 680.0],
    [1000.0, 1000.0],
    [1500.0, 1500.0],
    [2200.0, 2200.0],
    [3200.0, 3200.0],
];

/// Largest nominal contact angle of a radial bearing (ISO 281, clause 3), rad, with round-off.
const MAX_CONTACT_ANGLE: f64 = std::f64::consts::FRAC_PI_4 * (1.0 + 1e-12);
/// Oils are liquid and bearing steel keeps its hardness between these, degC.
const PLAUSIBLE_CELSIUS: std::ops::RangeInclusive<f64> = -60.0..=300.0;
/// Below 2 mm2/s the equation of Walther needs further terms (ASTM D341), m2/s.
const MIN_WALTHER: f64 = 2e-6;
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
        if self.viscosity_class.is_none() {
            for (key, is_given) in [
                ("temperature", self.temperature.is_some()),
                ("viscosity_at_100", self.viscosity_at_100.is_some()),
            ] {
                if is_given {
                    problems.add(format!(
                        "life.{key} does nothing without life.viscosity_class; add the class, or remove it"
                    ));
                }
            }
        }
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
            (.., Some(class)) => self.class(class, problems),
            _ => None,
        }
    }

    /// An oil by its class and temperature.
    fn class(&self, class: f64, problems: &mut Problems) -> Option<Oil> {
        let Some([_, at_40]) = CLASSES.iter().find(|[name, _]| *name == class) else {
            let names: Vec<String> = CLASSES.iter().map(|[name, _]| name.to_string()).collect();
            problems.require(
                false,
                "life.viscosity_class",
                class,
                format!("expected a class of ISO 3448: {}", names.join(", ")),
            );
            return None;
        };
        let at_40 = at_40 * 1e-6;
        let Some(temperature) = &self.temperature else {
            problems.add(format!(
                "life.viscosity_class is {class}, the viscosity at 40 degC; add life.temperature of the oil in the \
                 contacts, or give life.viscosity at that temperature"
            ));
            return None;
        };
        problems.require(
            PLAUSIBLE_CELSIUS.contains(&temperature.celsius()),
            "life.temperature",
            temperature,
            "expected -60 degC to 300 degC",
        );
        if let Some(at_100) = &self.viscosity_at_100 {
            problems.require(
                (MIN_WALTHER..at_40).contains(&at_100.si()),
                "life.viscosity_at_100",
                at_100,
                format!(
                    "expected 2 mm2/s to less than the {} mm2/s at 40 degC",
                    1e6 * at_40
                ),
            );
        } else if (temperature.celsius() - 40.0).abs() > 1e-9 {
            problems.add(format!(
                "life.temperature is {temperature}; how an oil thins from 40 degC takes a second viscosity: add \
                 life.viscosity_at_100 from its data sheet, or give life.viscosity at that temperature"
            ));
            return None;
        }
        Some(Oil::Class {
            at_40,
            at_100: self.viscosity_at_100.as_ref().map(Quantity::si),
            temperature: temperature.kelvin(),
        })
    }
}
