//! Lists of 7010C on a shaft.

use assembly::ShaftLoads;
use assembly::shaft::ShaftBody;
use assembly::{Assembly, MountedBearing, Orientation, Seating};
use dynamics::{ContactMode, Hold, Model};

use crate::support::Case;
use crate::support::rings::Level;

const SMALL: Level = Level::hex8(54, 6, 1, 2);

/// A 7010C with rigid rings and no load.
pub fn bare() -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.effects.clear();
    model
}

/// The same with elastic rings.
pub fn flexible() -> Model {
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    model.effects.clear();
    model
}

/// Position, m, orientation, and shift, m.
pub type At = (f64, Orientation, f64);

/// Bearings at places with shifts, on a shaft without load.
pub fn on_shaft(shaft: ShaftBody, places: &[At], make: impl Fn() -> Model) -> Assembly {
    let first = make();
    let bearing = |(i, (position, orientation, shift)): (usize, &At)| {
        let mut model = make();
        model.rings = first.rings.clone();
        MountedBearing {
            name: format!("number {i}"),
            place: Seating {
                position: *position,
                orientation: *orientation,
                shift: *shift,
            },
            model,
        }
    };
    let load = ShaftLoads::none(&shaft);
    Assembly {
        bearings: places.iter().enumerate().map(bearing).collect(),
        shaft,
        load,
    }
}
