//! Real surfaces of a scene: raceways of strips with their shoulders and profiles.

use std::ops::RangeInclusive;
use std::sync::Arc;

use contact::{BearingGeometry, HertzContact, Side, StripLaw, StripSurface};
use dynamics::kinematics::BothRings;
use dynamics::shoulders::Shoulders;
use dynamics::{RACEWAY_GROUP, RingModel, Surfaces};

use crate::error::BuildError;
use crate::marks::marks;
use crate::tables::{self, Scene, ShoulderDiameters};
use crate::worn_balls::{too_fine, worn_balls};

/// The surfaces that a scene asks for; nothing where it does not.
pub fn surfaces(
    scene: &Scene,
    geometry: &BearingGeometry,
    hertz: &[HertzContact; 2],
    rings: &[Option<Arc<RingModel>>; 2],
    half_widths: BothRings,
) -> Result<Surfaces, BuildError> {
    let mut strips = [None, None];
    for side in Side::BOTH {
        let ring = rings[side.index()].as_deref();
        let (hertz, half_width) = (&hertz[side.index()], half_widths[side.index()]);
        strips[side.index()] = strips_of(scene, (geometry, side), (hertz, half_width), ring)?;
    }
    Ok(Surfaces {
        strips,
        oversizes: scene.profiles.oversizes.clone(),
        balls: worn_balls(scene, geometry, half_widths)?,
        half_widths,
    })
}

fn strips_of(
    scene: &Scene,
    (geometry, side): (&BearingGeometry, Side),
    (hertz, half_width): (&HertzContact, f64),
    ring: Option<&RingModel>,
) -> Result<Option<Arc<StripSurface>>, BuildError> {
    let profiles = &scene.profiles.raceways[side.index()];
    if profiles.is_empty() && !scene.contact.edges && scene.profiles.balls.is_empty() {
        return Ok(None);
    }
    let refuse = |problem: String| {
        Err(BuildError::Surface {
            path: scene.path.clone(),
            problem,
        })
    };
    // In sectors a rank may hold a part of a ring only, which does not tell where its groove ends.
    let is_divided = scene.solver.backend.divides_rings();
    if is_divided && scene.contact.edges {
        return refuse(
            "contact.edges is true and solver.backend is \"sector\"; grooves that are divided into sectors have no \
             edges yet, use \"auto\", \"cyclic\" or \"sparse\""
                .to_string(),
        );
    }
    let ring = ring.filter(|_| !is_divided);
    let shoulders = groove_ends(scene, (geometry, side), ring);
    if shoulders.is_none() && scene.contact.edges {
        return refuse(format!(
            "contact.edges is true, but nothing says where the groove of the rigid {0} ring ends; expected \
             [{0}.section] with its shoulder_diameters",
            side.name()
        ));
    }
    let marks = marks(profiles);
    if let (Some(groove), radius) = (&shoulders, geometry.groove_radius(side)) {
        let (low, high) = (*groove.start(), *groove.end());
        for mark in &marks {
            let half = 0.5 * mark.width / radius;
            if mark.groove_angle + half <= low || mark.groove_angle - half >= high {
                return refuse(format!(
                    "{} of the {} ring lies at the groove angle {:.2} deg beyond the groove, which goes \
                     from {:.2} to {:.2} deg",
                    mark.name,
                    side.name(),
                    mark.groove_angle.to_degrees(),
                    low.to_degrees(),
                    high.to_degrees()
                ));
            }
        }
    }
    let law = StripLaw::new(hertz, geometry.groove_radius(side));
    let edges = shoulders.filter(|_| scene.contact.edges);
    let felt = profiles.felt_by(half_width, track_radius(geometry, side));
    match StripSurface::new(law, (geometry, side), edges, &felt) {
        Some(surface) => Ok(Some(Arc::new(surface))),
        None => refuse(too_fine(&format!("the {} ring", side.name()))),
    }
}

/// Radius of the track at the free contact angle, m.
pub fn track_radius(geometry: &BearingGeometry, side: Side) -> f64 {
    let out = geometry.groove_radius(side) * geometry.free_contact_angle().cos();
    geometry.centre_radius(side) + side.sign() * out
}

/// What a scene tells of the shoulders of its bearing. Unequal shoulders of a ring say where it carries: a positive
/// contact angle has the higher one at -z inside, at +z outside. Else a contact angle says that it carries on the side
/// where its balls begin.
pub fn shoulders(
    scene: &Scene,
    geometry: &BearingGeometry,
    rings: &[Option<Arc<RingModel>>; 2],
) -> Shoulders {
    let unequal = |table: &tables::Ring| {
        let ShoulderDiameters { at_low_z, at_high_z } = table.section?.shoulder_diameters;
        (at_low_z != at_high_z).then(|| (at_low_z - at_high_z).signum())
    };
    let drawn: Vec<f64> = [&scene.inner, &scene.outer]
        .into_iter()
        .filter_map(unequal)
        .collect();
    let is_one = drawn.iter().all(|sign| *sign == drawn[0]);
    Shoulders {
        direction: match drawn.first() {
            Some(sign) => is_one.then_some(*sign),
            None => scene.bearing.has_contact_angle.then_some(1.0),
        },
        ends: Side::BOTH.map(|side| match rings[side.index()] {
            Some(_) => None,
            None => groove_ends(scene, (geometry, side), None),
        }),
    }
}

/// Groove angles where a groove ends, rad: those of its mesh, else of its section; None where neither is there.
fn groove_ends(
    scene: &Scene,
    (geometry, side): (&BearingGeometry, Side),
    ring: Option<&RingModel>,
) -> Option<RangeInclusive<f64>> {
    if let Some(ring) = ring {
        let nodes = ring.mesh.group_nodes(RACEWAY_GROUP);
        let angles = nodes
            .iter()
            .map(|&node| ring.groove.coordinates(ring.mesh.nodes[node])[1]);
        let range = |[low, high]: [f64; _], a: f64| [low.min(a), high.max(a)];
        let found = angles.fold([f64::INFINITY, f64::NEG_INFINITY], range);
        if found[0] < found[1] {
            return Some(found[0]..=found[1]);
        }
    }
    let table = [&scene.inner, &scene.outer][side.index()];
    let section = table.section?;
    // The groove meets its shoulder where its distance from the axis is that of the shoulder.
    let angle = |diameter: f64| {
        let height = side.sign() * (0.5 * diameter - geometry.centre_radius(side));
        (height / geometry.groove_radius(side)).acos()
    };
    let shoulders = section.shoulder_diameters;
    let (at_low_z, at_high_z) = (angle(shoulders.at_low_z), angle(shoulders.at_high_z));
    // A positive groove angle points outwards along +z, on the inner ring along -z.
    Some(if side.sign() > 0.0 {
        -at_low_z..=at_high_z
    } else {
        -at_high_z..=at_low_z
    })
}
