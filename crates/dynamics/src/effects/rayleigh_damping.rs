//! Damping matrix of the rings, C = mass M + stiffness K, in motion.
//!
//! A mode of angular frequency w has the damping ratio (mass / w + stiffness w) / 2. The first term holds back a
//! ring as a whole, too. Rule of thumb: that of [`contact_damping`](super::contact_damping).

use input::{Problems, Quantity, RATE, TIME};
use serde::Deserialize;

use super::table::{self, About, Context, Need, RingDamping, SpeedRole, Trial};

const EXAMPLE: &str = r#"[effects.rayleigh_damping]      # needs [dynamic]
mass = "0 1/s"                  # factor of the mass matrix
stiffness = "1e-7 s"            # factor of the stiffness matrix
"#;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.rayleigh_damping]")]
pub struct RayleighDampingTable {
    mass: Quantity<RATE>,
    stiffness: Quantity<TIME>,
}

impl table::EffectTable for RayleighDampingTable {
    fn about() -> About {
        About {
            name: "rayleigh_damping",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[Need::Inertia],
            trial: Some(Trial {
                what: "1e-7 s times stiffness",
                keys: &[("mass", "0 1/s"), ("stiffness", "1e-7 s")],
            }),
        }
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        let rule = "damping must not be negative, it would feed energy into the rings";
        problems.require(
            self.mass.si() >= 0.0,
            "effects.rayleigh_damping.mass",
            &self.mass,
            rule,
        );
        problems.require(
            self.stiffness.si() >= 0.0,
            "effects.rayleigh_damping.stiffness",
            &self.stiffness,
            rule,
        );
    }

    fn ring_damping(&self) -> Option<RingDamping> {
        Some(RingDamping {
            mass: self.mass.si(),
            stiffness: self.stiffness.si(),
        })
    }
}
