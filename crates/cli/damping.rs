//! The damping of linearised bearings: what a scene asks for, and what is said of it.

use contact::Side;
use dynamics::effects::Effects;
use dynamics::{DampingLaws, Model};

/// Damping laws among the effects of a scene.
pub fn laws(effects: &Effects) -> DampingLaws {
    DampingLaws {
        contacts: effects.contact_damping(),
        rings: effects.ring_damping(),
    }
}

/// What the damping of bearings has in it, or why there is none.
pub fn damping_note<'m>(laws: DampingLaws, models: impl IntoIterator<Item = &'m Model>) -> String {
    let is_elastic = |model: &Model| Side::BOTH.iter().any(|side| model.ring(*side).is_some());
    let has_rings = models.into_iter().any(is_elastic);
    let of_contacts = laws.contacts.map(|_| "contacts along their normal");
    let of_rings = laws.rings.filter(|rings| has_rings && rings.stiffness > 0.0);
    let of_rings = of_rings.map(|_| "rings in proportion to their stiffness");
    let parts: Vec<&str> = of_contacts.into_iter().chain(of_rings).collect();
    let left_out = match laws.rings {
        Some(rings) if has_rings && rings.mass > 0.0 => {
            "; the part of the rings in proportion to mass is left out"
        }
        _ => "",
    };
    match parts.is_empty() {
        true => format!(
            "none: the scene has neither contact_damping nor rayleigh_damping, which take [dynamic]{left_out}"
        ),
        false => format!("{}, of slow motions{left_out}", parts.join(" and ")),
    }
}
