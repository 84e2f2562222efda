//! Damping of contacts along their normal, in motion.
//!
//! A force c(d) dd/dt, d the approach; c rises by a cubic step from 0 at d = 0 to `coefficient` at d =
//! `full_approach`. The law itself acts inside the raceway contact ([`crate::interactions::discrete_gradient`]).
//!
//! Rule of thumb: an undamped motion rings on, and its transients outlive any run.

use input::{DAMPING, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::rules::{Case, Remark};
use super::table::{self, About, Context, Need, SpeedRole, Trial};
use crate::interactions::contact_damping::ContactDamping;

const EXAMPLE: &str = r#"[effects.contact_damping]       # needs [dynamic]
coefficient = "5e-2 N s/mm"     # largest coefficient
full_approach = "1 um"          # approach at which it is reached
"#;

/// Contacts approach by micrometres: more is a slip of the unit, m.
const MAX_FULL_APPROACH: f64 = 1e-3;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.contact_damping]")]
pub struct ContactDampingTable {
    coefficient: Quantity<DAMPING>,
    full_approach: Quantity<LENGTH>,
}

impl table::EffectTable for ContactDampingTable {
    fn about() -> About {
        About {
            name: "contact_damping",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[Need::Inertia],
            trial: Some(Trial {
                what: "0.05 N s/mm from 1 um on",
                keys: &[("coefficient", "5e-2 N s/mm"), ("full_approach", "1 um")],
            }),
        }
    }

    fn advice(_table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        if !case.has_inertia || case.is_damped || !case.changes_in_time {
            return Vec::new();
        }
        let text = "[effects.contact_damping] and [effects.rayleigh_damping] are off, but loads or speed change in \
                    time: what they set ringing never dies away";
        vec![text.to_string().into()]
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        problems.require_positive(
            &self.coefficient,
            "effects.contact_damping.coefficient",
            "a damping",
        );
        let approach = self.full_approach.si();
        problems.require(
            approach > 0.0 && approach <= MAX_FULL_APPROACH,
            "effects.contact_damping.full_approach",
            &self.full_approach,
            "expected more than 0 and at most 1 mm, 1 um is usual",
        );
    }

    fn contact_damping(&self) -> Option<ContactDamping> {
        Some(ContactDamping {
            coefficient: self.coefficient.si(),
            full_approach: self.full_approach.si(),
        })
    }
}
