//! Interference fits of the inner ring on its shaft and of the outer ring in its housing.
//!
//! The ring is wider or narrower than its partner by the interference; a pressure makes them one. Shaft and housing
//! give as thick tubes. A clamped ring is moved at its seat, one in its mean motion pressed, and a rigid one grows as
//! a tube: [`crate::mounting`], with equations and validity. The speed at which the ring lets go is found; a run that
//! reaches it, and a clamped ring that its fit does not press, are refused. A ring in its mean motion or a rigid one
//! may be loose: then nothing presses it.
//!
//! The pressure is that without loads and speed; what these do to the seat is in the stress of the ring.

use input::{DENSITY, LENGTH, Problems, Quantity, STRESS};
use serde::Deserialize;

use super::table::{self, About, Context, SpeedRole, Trial};
use crate::mounting::{Conditions, Fit};

const EXAMPLE: &str = r#"[effects.fit]                   # one ring or both
[effects.fit.inner]             # the inner ring on its shaft
interference = "10 um"          # diametral, at the reference temperature; negative: clearance
shaft_bore = "20 mm"            # optional, default 0 mm: a solid shaft
young_modulus = "207 GPa"       # of the shaft; optional, default: that of the rings
poisson_ratio = 0.3             # of the shaft; optional, default: that of the rings
density = "7800 kg/m3"          # of the shaft; optional, default: that of the rings
[effects.fit.outer]             # the outer ring in its housing
interference = "5 um"           # diametral; negative: clearance
housing_diameter = "160 mm"     # outside diameter of the housing, a thick tube
young_modulus = "70 GPa"        # of the housing; optional, default: that of the rings
poisson_ratio = 0.33            # of the housing; optional, default: that of the rings
density = "2700 kg/m3"          # of the housing; optional, default: that of the rings
"#;

/// Interference over the diameter beyond which it is a slip of the unit: it would strain the ring beyond any yield.
const MOST_INTERFERENCE: f64 = 0.01;

/// The tables of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(
    deny_unknown_fields,
    expecting = "the tables [effects.fit.inner] and [effects.fit.outer]"
)]
pub struct FitTable {
    inner: Option<ShaftFit>,
    outer: Option<HousingFit>,
}

/// The table of the inner ring.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.fit.inner]")]
struct ShaftFit {
    interference: Quantity<LENGTH>,
    shaft_bore: Option<Quantity<LENGTH>>,
    young_modulus: Option<Quantity<STRESS>>,
    poisson_ratio: Option<f64>,
    density: Option<Quantity<DENSITY>>,
}

/// The table of the outer ring.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.fit.outer]")]
struct HousingFit {
    interference: Quantity<LENGTH>,
    housing_diameter: Quantity<LENGTH>,
    young_modulus: Option<Quantity<STRESS>>,
    poisson_ratio: Option<f64>,
    density: Option<Quantity<DENSITY>>,
}

/// What both tables have.
struct Joint<'a> {
    table: &'static str,
    interference: &'a Quantity<LENGTH>,
    young_modulus: Option<&'a Quantity<STRESS>>,
    poisson_ratio: Option<f64>,
    density: Option<&'a Quantity<DENSITY>>,
}

impl table::EffectTable for FitTable {
    fn about() -> About {
        About {
            name: "fit",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: Some(Trial {
                what: "5 um of interference of the inner ring on a solid shaft",
                keys: &[("inner.interference", "5 um")],
            }),
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        if self.inner.is_none() && self.outer.is_none() {
            problems.add(
                "[effects.fit] has no ring; add [effects.fit.inner] or [effects.fit.outer], or remove it",
            );
        }
        let [bore, outside] = context.seat_diameters;
        if let Some(fit) = &self.inner {
            fit.joint().check(bore, problems);
            if let (Some(hole), Some(seat)) = (&fit.shaft_bore, bore) {
                let rule = format!(
                    "expected 0 mm (a solid shaft) to less than the bore of the bearing, {}",
                    Quantity::<LENGTH>::about(seat)
                );
                let key = "effects.fit.inner.shaft_bore";
                problems.require((0.0..seat).contains(&hole.si()), key, hole, rule);
            }
        }
        if let Some(fit) = &self.outer {
            fit.joint().check(outside, problems);
            if let Some(seat) = outside {
                let rule = format!(
                    "expected more than the outside diameter of the bearing, {}",
                    Quantity::<LENGTH>::about(seat)
                );
                let key = "effects.fit.outer.housing_diameter";
                problems.require(fit.housing_diameter.si() > seat, key, &fit.housing_diameter, rule);
            }
        }
    }

    fn mount(&self, conditions: &mut Conditions) {
        let inner = self.inner.as_ref().map(|fit| {
            let bore = fit.shaft_bore.as_ref().map_or(0.0, Quantity::si);
            fit.joint().fit(bore)
        });
        let outer = self.outer.as_ref();
        let outer = outer.map(|fit| fit.joint().fit(fit.housing_diameter.si()));
        conditions.fits = [inner, outer];
    }
}

impl ShaftFit {
    fn joint(&self) -> Joint<'_> {
        Joint {
            table: "effects.fit.inner",
            interference: &self.interference,
            young_modulus: self.young_modulus.as_ref(),
            poisson_ratio: self.poisson_ratio,
            density: self.density.as_ref(),
        }
    }
}

impl HousingFit {
    fn joint(&self) -> Joint<'_> {
        Joint {
            table: "effects.fit.outer",
            interference: &self.interference,
            young_modulus: self.young_modulus.as_ref(),
            poisson_ratio: self.poisson_ratio,
            density: self.density.as_ref(),
        }
    }
}

impl Joint<'_> {
    /// Checks a fit on a seat of a diameter, m; None where the bearing is wrong itself.
    fn check(&self, seat: Option<f64>, problems: &mut Problems) {
        let table = self.table;
        if let Some(seat) = seat {
            let share = self.interference.si().abs() / seat;
            problems.require(
                share <= MOST_INTERFERENCE,
                &format!("{table}.interference"),
                self.interference,
                format!(
                    "that is {:.2} % of the diameter of {}, no ring takes more than 1 %; check its unit",
                    100.0 * share,
                    Quantity::<LENGTH>::about(seat)
                ),
            );
        }
        if let Some(modulus) = self.young_modulus {
            problems.require_positive(modulus, &format!("{table}.young_modulus"), "a modulus");
        }
        if let Some(density) = self.density {
            problems.require_positive(density, &format!("{table}.density"), "a density");
        }
        if let Some(nu) = self.poisson_ratio {
            let key = format!("{table}.poisson_ratio");
            problems.require(
                (0.0..0.5).contains(&nu),
                &key,
                nu,
                "expected 0 to below 0.5, steel has 0.3",
            );
        }
    }

    /// The fit, with the other diameter of the partner, m.
    fn fit(&self, partner_diameter: f64) -> Fit {
        Fit {
            interference: self.interference.si(),
            partner_diameter,
            young_modulus: self.young_modulus.map(Quantity::si),
            poisson_ratio: self.poisson_ratio,
            density: self.density.map(Quantity::si),
        }
    }
}
