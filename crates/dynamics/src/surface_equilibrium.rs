//! Equilibrium on real surfaces: that of smooth grooves first, whose energy is convex, then that of the surfaces.
//!
//! The energy of a contact at an edge or over a profile is not convex in the contact angle, so that Newton may stall
//! from far away. Where it does, the profiles grow in stages.

use crate::bearing::BearingParts;
use crate::displacements::Displacements;
use crate::equilibrium::{SearchScales, minimise};
use crate::error::DynamicsError;
use crate::surfaces::Strips;

/// Stages in which profiles grow where they are too much at once.
const STAGES: usize = 8;

/// Displacements of an equilibrium, and the iterations it took; without strips the minimum of the energy.
pub fn settle_on_surfaces(
    parts: &mut BearingParts,
    start: &Displacements,
    scales: SearchScales,
) -> Result<(Displacements, usize), DynamicsError> {
    if parts.contacts.sites.iter().all(|site| site.strips.is_none()) {
        return minimise(parts, start, scales);
    }
    let full: Vec<Option<Strips>> = parts
        .contacts
        .sites
        .iter_mut()
        .map(|site| site.strips.take())
        .collect();
    let smooth = minimise(parts, start, scales);
    put(parts, &full, 1.0);
    let (smooth, mut sum) = smooth?;
    match minimise(parts, &smooth, scales) {
        Ok((u, iterations)) => return Ok((u, sum + iterations)),
        Err(DynamicsError::NewtonStalled { .. } | DynamicsError::NoEquilibrium { .. }) => {}
        Err(error) => return Err(error),
    }
    let mut u = smooth;
    for stage in 1..=STAGES {
        put(parts, &full, stage as f64 / STAGES as f64);
        let found = minimise(parts, &u, scales);
        if found.is_err() {
            put(parts, &full, 1.0);
        }
        let (next, iterations) = found?;
        sum += iterations;
        u = next;
    }
    put(parts, &full, 1.0);
    Ok((u, sum))
}

/// Gives the contacts their strips with this share of what is missing.
fn put(parts: &mut BearingParts, full: &[Option<Strips>], share: f64) {
    for (site, strips) in parts.contacts.sites.iter_mut().zip(full) {
        site.strips = match strips {
            Some(strips) if share < 1.0 => Some(strips.scaled(share)),
            _ => strips.clone(),
        };
    }
}
