//! Stress of a ring as a body under its contacts: that of fits, temperatures, speed and bending, without the contacts'
//! own.

use contact::halfspace::subsurface;
use contact::near_field::in_axes;
use contact::{LoadedPatch, NearField, RingPoint, Side};
use fem::stress::PointRecovery;

use super::shown::{Shown, add};
use crate::failure::Failure;

/// How far patches are taken out, in their larger semi-axes.
const REACH: f64 = 8.0;

/// A loaded contact and the ring under it.
#[derive(Clone, Copy, Debug)]
pub struct BodyUnderContact {
    /// The contact.
    pub patch: LoadedPatch,
    /// Radius of the raceway there, m.
    pub radius: f64,
    /// Stress of the ring at the depth of the contact's largest von Mises stress, Pa: gg tt dd gt td gd, g along the
    /// groove, t in the rolling direction, d into the ring.
    pub stress: [f64; 6],
}

/// All contacts of a flexible ring, by ball; None for a rigid ring or facets.
pub fn under_contacts(shown: &Shown<'_>, side: Side) -> Result<Option<Vec<BodyUnderContact>>, Failure> {
    let (Some(ring), Some(field)) = (shown.model().ring(side), shown.ring(side)) else {
        return Ok(None);
    };
    let patches = shown.patches(side).map_err(Failure::solving)?;
    if patches.is_empty() {
        return Ok(None);
    }
    let place = |patch: &LoadedPatch| {
        let minor = patch.semi_axes.minor();
        let depth = match minor > 0.0 {
            true => {
                subsurface(patch.semi_axes, ring.material.poisson_ratio)
                    .von_mises
                    .depth_over_minor_axis
            }
            false => 0.0,
        };
        RingPoint {
            azimuth: patch.azimuth,
            angle: patch.angle,
            depth: depth * minor,
        }
    };
    let points: Vec<RingPoint> = patches.iter().map(place).collect();
    let positions: Vec<[f64; 3]> = points.iter().map(|point| point.position(&ring.groove)).collect();
    let recovery = PointRecovery::new(&ring.mesh, &ring.material, &positions)?;
    let mut stress = recovery.stress(&field.strained);
    if let Some(own) = &field.own_stress {
        add(&mut stress, &recovery.interpolate(&own.nodal));
    }
    NearField::new(ring.groove, ring.material.poisson_ratio, REACH, &positions)
        .take_out(&patches, &mut stress);
    let contacts = patches.iter().zip(&points).zip(stress);
    let found = contacts.map(|((patch, point), stress)| BodyUnderContact {
        patch: *patch,
        radius: ring.groove.radius(patch.angle),
        stress: in_axes(stress, &point.axes(&ring.groove)),
    });
    Ok(Some(found.collect()))
}
