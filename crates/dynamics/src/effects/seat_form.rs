//! Seats that are not round: waves of the radius of shaft or housing, which a clamped ring takes over.
//!
//! ```text
//! u_r = amplitude cos(order (azimuth - crest))      on the bore or seat, u_psi = u_z = 0
//! ```
//!
//! The form belongs to the ring: it turns with it, in the frame of its mesh. Order 2 is an oval, order 3 what a
//! three-jaw chuck leaves. Order 0 is an interference, [`super::fit`], and order 1 a shift of the whole ring, which
//! loads do not feel. With a fit the waves of the pressure are compared with its mean, and a seat that lets go is
//! refused. Equations: [`crate::mounting`]; displacements of the seat across its radius are held.

use contact::Side;
use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::table::{self, About, Context, SpeedRole};
use crate::mounting::{self, Conditions};

const EXAMPLE: &str = r#"[[effects.seat_form]]           # a table for each wave
ring = "inner"                  # "inner" or "outer"; flexible, with support = "clamped"
order = 3                       # waves round the circumference, 2 to 100; six nodes of the seat for each, or more
amplitude = "5 um"              # deviation of the radius at a crest
azimuth = "0 deg"               # of a crest in the frame of the ring; optional, default 0 deg
"#;

/// Most waves that the mesh of a ring can follow.
const MOST_WAVES: i64 = 100;
/// Amplitude over the diameter beyond which it is a slip of the unit.
const MOST_AMPLITUDE: f64 = 0.005;

/// The tables of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(transparent)]
pub struct SeatFormTable(Vec<RawForm>);

/// One wave.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table [[effects.seat_form]]")]
struct RawForm {
    ring: String,
    order: i64,
    amplitude: Quantity<LENGTH>,
    azimuth: Option<Quantity<ANGLE>>,
}

impl table::EffectTable for SeatFormTable {
    fn about() -> About {
        About {
            name: "seat_form",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: None,
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        if self.0.is_empty() {
            problems.add("effects.seat_form is empty; add a table [[effects.seat_form]], or remove it");
        }
        for (number, form) in self.0.iter().enumerate() {
            form.check(&format!("effects.seat_form[{number}]"), context, problems);
        }
    }

    fn mount(&self, conditions: &mut Conditions) {
        let form = |form: &RawForm| {
            Some(mounting::SeatForm {
                side: form.side()?,
                order: form.order.unsigned_abs() as usize,
                amplitude: form.amplitude.si(),
                azimuth: form.azimuth.as_ref().map_or(0.0, Quantity::si),
            })
        };
        conditions.seat_forms = self.0.iter().filter_map(form).collect();
    }
}

impl RawForm {
    /// The ring; None for a name that is none, which `check` reports.
    fn side(&self) -> Option<Side> {
        Side::BOTH.into_iter().find(|side| side.name() == self.ring)
    }

    fn check(&self, table: &str, context: Context, problems: &mut Problems) {
        let Some(side) = self.side() else {
            let (key, ring) = (format!("{table}.ring"), format!("{:?}", self.ring));
            return problems.require(false, &key, ring, "expected \"inner\" or \"outer\"");
        };
        let order = format!("{table}.order");
        match self.order {
            0 => problems.add(format!(
                "{order} is 0, which is an interference; give it as [effects.fit.{}]",
                side.name()
            )),
            1 => problems.add(format!(
                "{order} is 1, which shifts the ring as a whole; expected 2 (an oval) or more"
            )),
            n => {
                problems.whole(n, &order, 2, MOST_WAVES);
            }
        }
        if let Some(seat) = context.seat_diameters[side.index()] {
            let share = self.amplitude.si().abs() / seat;
            problems.require(
                share <= MOST_AMPLITUDE,
                &format!("{table}.amplitude"),
                &self.amplitude,
                format!(
                    "that is {:.2} % of the seat's diameter, expected at most 0.5 %; check its unit",
                    100.0 * share
                ),
            );
        }
        if !context.is_flexible[side.index()] {
            problems.add(format!(
                "{table} gives the {name} ring the form of its seat, but it is rigid; give {name}.mesh, or \
                 remove the form",
                name = side.name()
            ));
        }
    }
}
