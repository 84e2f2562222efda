//! Where a contact force acts on a flexible ring: a patch on the torus, or one facet of the mesh.

use std::ops::RangeInclusive;
use std::sync::Arc;

use contact::facets::FacetContact;
use contact::patch_shape::PatchShape;
use contact::{
    ContactError, FacetSurface, Groove, Meridian, NodalWeights, Patch, RacewaySurface, SemiAxes, Side,
    Unevenness,
};
use mesh::NodePositions;
use rayon::prelude::*;

use crate::error::DynamicsError;
use crate::interactions::raceway_contact::{RacewayContacts, Site, SiteState};
use crate::model::{ContactMode, Model, elastic};
use crate::mounting::Mounting;
use crate::raceway::Raceway;
use ring::RingModel;

/// Groove angle kept from the rim by a contact that is not on the groove, as a share of the groove.
const RIM_SHARE: f64 = 0.05;
/// Force over the largest below which a contact is unloaded: what Newton leaves on balls that touch without load.
const LOADED_SHARE: f64 = 1e-9;
/// Force over the largest on the same raceway below which a contact may stand beyond the rim of a flexible ring's
/// groove, and acts on the ring just inside it: a ball that lies between the shoulders by its own weight, or that its
/// centrifugal force presses on the other raceway, changes next to nothing.
const SLIGHT_SHARE: f64 = 1e-2;

/// Samples of a faceted groove from rim to rim.
const FACET_SAMPLES: usize = 200;
/// How far facets are searched, in ball radii.
const SEARCH_REACH: f64 = 1.1;

/// Place of one contact on a ring.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// Nodal weights.
    pub weights: NodalWeights,
    /// Semi-axes of the spread patch, m; None on a facet.
    pub semi_axes: Option<SemiAxes>,
    /// The Hertz ellipse reaches beyond the groove.
    pub truncated: bool,
    /// Groove angles from rim to rim, rad.
    pub groove: RangeInclusive<f64>,
}

impl Footprint {
    /// Whether an ellipse reaches beyond the groove, or a contact at this angle, rad, stands beyond its rim.
    pub fn is_beyond(&self, angle: f64) -> bool {
        self.truncated || !self.groove.contains(&angle)
    }
}

/// Places all contacts of one ring of a bearing that is mounted so, which stand at `states` with these site forces, and
/// sets the laws (patch compliance) and, for facets, the unevenness of the grooves.
pub fn place(
    model: &Model,
    mounting: &Mounting,
    side: Side,
    raceway: &Raceway,
    contacts: &mut RacewayContacts,
    states: &[SiteState],
    forces: &[Meridian],
) -> Result<Vec<Footprint>, DynamicsError> {
    let ring = model.ring(side).expect("only flexible rings have footprints");
    let n_balls = model.geometry.n_balls;
    let loaded = loaded(sizes(forces));
    let mut feet = Vec::with_capacity(n_balls);
    for ball in 0..n_balls {
        let index = 2 * ball + side.index();
        let (site, angle) = (&mut contacts.sites[index], states[index].angle);
        let foot = match model.contact.mode {
            ContactMode::Facet => place_facet(model, ring, raceway, site, angle, forces[index])?,
            _ => place_patch(model, ring, raceway, site, angle, forces[index], loaded[index])?,
        };
        site.reach = model.reach(mounting, side, Some(&foot.weights));
        feet.push(foot);
    }
    Ok(feet)
}

fn place_patch(
    model: &Model,
    ring: &RingModel,
    raceway: &Raceway,
    site: &mut Site,
    angle: f64,
    force: Meridian,
    loaded: bool,
) -> Result<Footprint, DynamicsError> {
    let load = force.norm();
    let angle = on_groove(&raceway.surface, angle, loaded);
    let hertz = model.hertz[site.side.index()].semi_axes(load);
    let least = model.contact.least_patch;
    let shape = PatchShape::new(&raceway.surface, site.ring_azimuth, angle, hertz, least)?;
    let patch = Patch::new(
        &raceway.surface,
        &ring.mesh.nodes,
        &raceway.rule,
        shape,
        elastic(&ring.material),
    )?;
    site.law.patch_compliance = patch.compliance;
    Ok(Footprint {
        weights: patch.weights,
        semi_axes: Some(shape.semi_axes),
        truncated: shape.truncated,
        groove: raceway.surface.angle_range.clone(),
    })
}

/// Force up to which a contact is unloaded, from the sizes of all forces, N.
pub fn least_load(forces: impl Iterator<Item = f64>) -> f64 {
    LOADED_SHARE * forces.fold(0.0, f64::max)
}

/// Which contacts carry load, by site, from the sizes of their forces, N.
pub fn loaded(forces: impl Iterator<Item = f64> + Clone) -> Vec<bool> {
    let limit = least_load(forces.clone());
    forces.map(|force| force > limit).collect()
}

/// Which contacts carry more than a slight load, over the largest on their raceway; inner and outer sites take turns.
pub fn well_loaded(forces: impl Iterator<Item = f64> + Clone) -> Vec<bool> {
    let largest = |side| forces.clone().skip(side).step_by(2).fold(0.0, f64::max);
    let limits = [0, 1].map(|side| SLIGHT_SHARE * largest(side));
    let sites = forces.clone().enumerate();
    sites.map(|(site, force)| force > limits[site % 2]).collect()
}

/// Sizes of forces, N.
pub fn sizes(forces: &[Meridian]) -> impl Iterator<Item = f64> + Clone {
    forces.iter().map(|force| force.norm())
}

/// The contact angle if it is on the groove, else the nearest place inside the rim: unloaded balls may be anywhere, and
/// loaded ones on their way to equilibrium.
pub fn on_groove(surface: &RacewaySurface, angle: f64, loaded: bool) -> f64 {
    let (low, high) = surface.angle_range.clone().into_inner();
    if loaded && low < angle && angle < high {
        return angle;
    }
    let rim = RIM_SHARE * (high - low);
    angle.clamp(low + rim, high - rim)
}

/// Fails when a ball of an equilibrium that carries more than a slight load lies beyond the rim of a flexible ring's
/// groove.
pub fn check_on_groove(
    surface: &RacewaySurface,
    sites: &[Site],
    states: &[SiteState],
    forces: &[Meridian],
) -> Result<(), DynamicsError> {
    let of_ring = |site: &Site| site.side == surface.groove.side;
    let contacts = sites.iter().zip(states).zip(well_loaded(sizes(forces)));
    for ((site, state), _) in contacts.filter(|((site, _), presses)| *presses && of_ring(site)) {
        require_on_groove(surface, site.ball, state.angle)?;
    }
    Ok(())
}

/// Fails when a loaded ball of an equilibrium presses where no groove can be: on a rigid ring nothing else says so.
pub fn check_in_grooves(
    sites: &[Site],
    states: &[SiteState],
    forces: &[Meridian],
) -> Result<(), DynamicsError> {
    let contacts = sites.iter().zip(states).zip(loaded(sizes(forces)));
    for ((site, state), _) in contacts.filter(|(_, loaded)| *loaded) {
        require_in_groove(site, state.angle)?;
    }
    Ok(())
}

/// Fails when a contact angle, rad, is 90 deg or more, or beyond the edges of its groove where it has any.
pub fn require_in_groove(site: &Site, angle: f64) -> Result<(), DynamicsError> {
    let (ball, side) = (site.ball, site.side);
    let edges = site.strips.as_ref().and_then(|strips| strips.surface.edges());
    if let Some(groove) = edges.filter(|groove| !groove.contains(&angle)) {
        let beyond = ContactError::BeyondShoulder {
            ball,
            side: side.name(),
            angle_deg: angle.to_degrees(),
            low_deg: groove.start().to_degrees(),
            high_deg: groove.end().to_degrees(),
        };
        return Err(beyond.into());
    }
    if angle.abs() < std::f64::consts::FRAC_PI_2 {
        return Ok(());
    }
    let off = ContactError::OffGroove {
        ball,
        side: side.name(),
        angle_deg: angle.to_degrees(),
    };
    Err(off.into())
}

/// Fails when a contact angle lies beyond the rim of the groove.
pub fn require_on_groove(surface: &RacewaySurface, ball: usize, angle: f64) -> Result<(), DynamicsError> {
    let (low, high) = surface.angle_range.clone().into_inner();
    if low < angle && angle < high {
        return Ok(());
    }
    let off = ContactError::OffRaceway {
        ball,
        side: surface.groove.side.name(),
        angle_deg: angle.to_degrees(),
        low_deg: low.to_degrees(),
        high_deg: high.to_degrees(),
    };
    Err(off.into())
}

/// Foot point on the facet under the ball. The offsets of the facets along the groove are sampled once; the ring's
/// deformation comes in through the motion measured at the foot.
fn place_facet(
    model: &Model,
    ring: &RingModel,
    raceway: &Raceway,
    site: &mut Site,
    angle: f64,
    force: Meridian,
) -> Result<Footprint, DynamicsError> {
    let search = FacetSearch::new(model, ring, raceway, site);
    if site.unevenness.is_none() {
        site.unevenness = Some(Arc::new(search.unevenness(&raceway.surface)?));
    }
    // The rim itself is left out: a foot point beyond it is on no facet.
    let contact = search.foot(on_groove(&raceway.surface, angle, false))?;
    let hertz = model.hertz[site.side.index()].semi_axes(force.norm());
    let weights = NodalWeights::interpolation(contact.nodes, &contact.weights, site.ring_azimuth);
    Ok(Footprint {
        weights,
        semi_axes: None,
        truncated: hertz.groove > raceway.surface.rim_distance(angle),
        groove: raceway.surface.angle_range.clone(),
    })
}

/// The facets of one ring as the ball of one site sees them.
struct FacetSearch<'a> {
    facets: &'a FacetSurface,
    nodes: &'a NodePositions,
    groove: Groove,
    /// Distance from groove centre to a touching ball's centre, and ball radius, m.
    touching: f64,
    radius: f64,
    /// Azimuth of the ball on the mesh, rad.
    azimuth: f64,
    ball: usize,
}

impl<'a> FacetSearch<'a> {
    fn new(model: &Model, ring: &'a RingModel, raceway: &'a Raceway, site: &Site) -> FacetSearch<'a> {
        FacetSearch {
            facets: raceway
                .facets
                .as_ref()
                .expect("facet mode builds the facet search of every flexible ring"),
            nodes: &ring.mesh.nodes,
            groove: ring.groove,
            touching: site.touching,
            radius: 0.5 * model.geometry.ball_diameter,
            azimuth: site.ring_azimuth,
            ball: site.ball,
        }
    }

    /// Foot point of a ball that touches the torus at a groove angle.
    fn foot(&self, angle: f64) -> Result<FacetContact, DynamicsError> {
        let (sin, cos) = self.azimuth.sin_cos();
        let direction = self.groove.direction(angle);
        let radial = self.groove.centre_radius + self.touching * direction[0];
        let centre = [
            radial * cos,
            radial * sin,
            self.groove.centre_z + self.touching * direction[1],
        ];
        self.facets
            .foot(centre, SEARCH_REACH * self.radius, |node| self.nodes[node])
            .ok_or(DynamicsError::NoFacet {
                ball: self.ball,
                side: self.groove.side.name(),
            })
    }

    fn unevenness(&self, surface: &RacewaySurface) -> Result<Unevenness, DynamicsError> {
        let (low, high) = surface.angle_range.clone().into_inner();
        let rim = RIM_SHARE * (high - low);
        let range = [low + rim, high - rim];
        let step = (range[1] - range[0]) / (FACET_SAMPLES - 1) as f64;
        let angles: Vec<f64> = (0..FACET_SAMPLES).map(|i| range[0] + step * i as f64).collect();
        let offset = |angle: &f64| {
            let foot = self.foot(*angle)?;
            let positions = foot.nodes.iter().map(|&node| self.nodes[node]);
            Ok::<f64, DynamicsError>(
                self.groove
                    .chord_offset(*angle, positions.zip(foot.weights.iter().copied())),
            )
        };
        let offsets: Result<Vec<f64>, DynamicsError> = angles.par_iter().map(offset).collect();
        Ok(Unevenness::new(range, offsets?))
    }
}
