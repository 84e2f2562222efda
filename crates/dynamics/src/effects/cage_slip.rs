//! Slip of balls on the raceways: the cage is slower or faster than pure rolling has it.
//!
//! A ratio is the share of the rolling motion that is lost at a raceway; [`crate::kinematics`] turns both into the
//! speeds of cage and balls. It is given, not computed: there is no traction.
//!
//! Rule of thumb: balls keep rolling while F_a > 10 Z F_c, F_c the centrifugal force of a ball (Hirano, ASLE Trans.
//! 8 (1965) 425; Harris, Rolling Bearing Analysis, 4th ed., chapter 13).

use input::Problems;
use serde::Deserialize;

use super::rules::{Case, Remark};
use super::table::{self, About, Context, SpeedRole, Trial};
use crate::kinematics::SlipRatios;

const EXAMPLE: &str = "[effects.cage_slip]             # needs [speed]
inner = 0.02                    # share of the rolling motion that is lost at the inner raceway, 0 to below 1
outer = 0.0                     # at the outer raceway
";

/// Axial load per ball over its centrifugal force below which balls skid (Hirano).
const HIRANO: f64 = 10.0;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.cage_slip]")]
pub struct CageSlipTable {
    inner: f64,
    outer: f64,
}

impl table::EffectTable for CageSlipTable {
    fn about() -> About {
        About {
            name: "cage_slip",
            example: EXAMPLE,
            speed: SpeedRole::Rolling,
            needs: &[],
            trial: Some(Trial {
                what: "2 % at the inner raceway",
                keys: &[("inner", "0.02"), ("outer", "0.0")],
            }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let (force, axial) = (case.centrifugal_force(), case.load.axial / case.n_balls());
        let is_rolling = axial > HIRANO * force;
        if case.ball_load() == 0.0 || case.speeds.is_zero() || is_rolling || table.is_some() {
            return Vec::new();
        }
        let text = format!(
            "[effects.cage_slip] is off, but balls may skid: F_a / (Z F_c) = {:.1}, and pure rolling needs more than \
             {HIRANO:.0} (Hirano)",
            axial / force
        );
        vec![text.into()]
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        for (key, slip) in [
            ("effects.cage_slip.inner", self.inner),
            ("effects.cage_slip.outer", self.outer),
        ] {
            let rule = "expected 0 (pure rolling) to below 1, the share of the rolling motion that is lost";
            problems.require((0.0..1.0).contains(&slip), key, slip, rule);
        }
    }

    fn slip(&self) -> Option<SlipRatios> {
        Some([self.inner, self.outer])
    }
}
