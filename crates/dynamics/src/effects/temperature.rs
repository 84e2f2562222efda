//! Temperatures of rings, balls, shaft and housing: grooves and balls grow, and seats move with their partners.
//!
//! Each body has one temperature, and is free of strain at the reference. Its strain is alpha (T - T_ref), with alpha
//! of `[materials.rings]` and `[materials.balls]`; shaft and housing are of ring steel unless a key says otherwise.
//! What it does to rings, seats and clearance: [`crate::mounting`]. A clamped seat has the temperature of its partner,
//! which stresses the ring if they differ; a ring in its mean motion and a rigid one grow freely, unless a fit holds
//! them.
//!
//! Young's modulus, Hertz stiffness, masses and the speed of the cage stay those of the reference. Temperatures are
//! constant: they change in minutes, a motion takes milliseconds.
//!
//! Rule of thumb: change of the radial clearance over the approach of a ball.

use input::{Expansion, Problems, Temperature};
use serde::Deserialize;

use super::table::{self, About, Context, Need, SpeedRole, Trial};
use crate::mounting::{Conditions, Temperatures};

const EXAMPLE: &str = r#"[effects.temperature]           # needs expansion in [materials.rings] and [materials.balls]
inner = "60 degC"               # inner ring
outer = "45 degC"               # outer ring
balls = "65 degC"
shaft = "60 degC"               # optional, default: that of the inner ring
housing = "40 degC"             # optional, default: that of the outer ring
reference = "20 degC"           # optional, default 20 degC: at which all dimensions and fits hold
shaft_expansion = "11.5e-6 /K"  # optional, default: that of the rings
housing_expansion = "23e-6 /K"  # optional, default: that of the rings
"#;

/// Reference temperature of dimensions (ISO 1), K.
const REFERENCE: f64 = 293.15;
/// Between these bearing steel is elastic as at room temperature, degC.
const PLAUSIBLE_CELSIUS: std::ops::RangeInclusive<f64> = -200.0..=350.0;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.temperature]")]
pub struct Table {
    inner: Temperature,
    outer: Temperature,
    balls: Temperature,
    shaft: Option<Temperature>,
    housing: Option<Temperature>,
    reference: Option<Temperature>,
    shaft_expansion: Option<Expansion>,
    housing_expansion: Option<Expansion>,
}

impl table::Table for Table {
    fn about() -> About {
        About {
            name: "temperature",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[Need::Expansion],
            trial: Some(Trial {
                what: "inner ring, balls and shaft 10 K warmer",
                keys: &[("inner", "30 degC"), ("outer", "20 degC"), ("balls", "30 degC")],
            }),
        }
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        let given = [
            ("inner", Some(&self.inner)),
            ("outer", Some(&self.outer)),
            ("balls", Some(&self.balls)),
            ("shaft", self.shaft.as_ref()),
            ("housing", self.housing.as_ref()),
            ("reference", self.reference.as_ref()),
        ];
        for (key, temperature) in given {
            let Some(temperature) = temperature else { continue };
            problems.require(
                PLAUSIBLE_CELSIUS.contains(&temperature.celsius()),
                &format!("effects.temperature.{key}"),
                temperature,
                "expected -200 degC to 350 degC, where rings are elastic as they are at 20 degC",
            );
        }
        for (key, expansion) in [
            ("effects.temperature.shaft_expansion", &self.shaft_expansion),
            ("effects.temperature.housing_expansion", &self.housing_expansion),
        ] {
            if let Some(expansion) = expansion {
                expansion.check(key, problems);
            }
        }
    }

    fn mount(&self, conditions: &mut Conditions) {
        let [inner, outer] = [self.inner.kelvin(), self.outer.kelvin()];
        let or = |temperature: &Option<Temperature>, other| {
            temperature.as_ref().map_or(other, Temperature::kelvin)
        };
        let expansion = |expansion: &Option<Expansion>| expansion.as_ref().map(Expansion::per_kelvin);
        conditions.temperatures = Some(Temperatures {
            rings: [inner, outer],
            balls: self.balls.kelvin(),
            partners: [or(&self.shaft, inner), or(&self.housing, outer)],
            reference: or(&self.reference, REFERENCE),
            partner_expansion: [
                expansion(&self.shaft_expansion),
                expansion(&self.housing_expansion),
            ],
        });
    }
}
