//! Contact sites and patches in the middle of a part of a step.
//!
//! A patch lies at the contact angle and has the size of the force *of its own part*, both at the weighted time: the
//! middle, for schemes that conserve. They are found with the forces: a first guess goes on from the three parts
//! before, and where forces show that a patch lay elsewhere, it is moved and the forces are found again; each round
//! contracts by about 0.03.
//!
//! A patch that lags behind its contact, by a part of a step or by some play, lies off the dent that it made before.
//! The work of moving it then feeds the ball's transverse modes, which nothing damps (measured on the 7010C at steps
//! of 20 us: a lag of half a step blows up within 40 ms; play of a tenth of a patch pumps 1.2 mJ into a revolution, 4
//! % of the energy). The middle of the part is the same seen forwards and backwards in time, so nothing is pumped.

use std::borrow::Cow;

use contact::patch_shape::PatchShape;
use contact::{NodalWeights, Patch, Side};
use rayon::prelude::*;

use super::passing::PassedRings;
use super::run::Motion;
use super::solve::StepSolution;
use super::state::{MotionState, PatchPlace};
use crate::bearing::BearingParts;
use crate::error::DynamicsError;
use crate::footprint::{loaded, on_groove, require_on_groove, well_loaded};
use crate::interactions::discrete_gradient::MeanForce;
use crate::interactions::raceway_contact::Site;
use crate::model::{Model, elastic};
use crate::mounting::Mounting;

/// Distance of a patch from its contact at which it counts as in place, semi-axes, times the share of its force in
/// the largest.
const ANGLE_TOLERANCE: f64 = 1e-4;
/// Difference of a patch's semi-axes from those of its force at which it counts as of that size, over the largest.
const SIZE_TOLERANCE: f64 = 1e-3;

/// One contact as it is placed.
struct Placed {
    site: Site,
    /// On a flexible ring of its groove, and of a free ball of its patch too.
    weights: Vec<NodalWeights>,
    /// Of a free ball on a flexible ring, of its slope.
    slope: Option<NodalWeights>,
    /// Half of the patch along the groove, rad; infinite on a rigid ring.
    half_angle: f64,
}

/// Where balls are in the middle of a part.
pub(super) struct Course {
    /// Weighted time of the part, s.
    pub time: f64,
    /// Azimuths, rad, by ball.
    pub azimuths: Vec<f64>,
    /// Whether contacts are those of free balls, with traction and slope.
    pub is_free: bool,
    /// How balls pass the rings, where that damps.
    pub passed: Option<PassedRings>,
    /// Start of the part, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
}

/// The mounting in the middle of a part and, where temperatures change, at its ends.
struct PartMounting<'m> {
    middle: Cow<'m, Mounting>,
    ends: Option<[Cow<'m, Mounting>; 2]>,
}

impl<'m> PartMounting<'m> {
    fn new(mounting: &'m Mounting, course: &Course) -> PartMounting<'m> {
        PartMounting {
            middle: mounting.at(course.time),
            ends: mounting
                .changes()
                .then(|| [course.start, course.end].map(|time| mounting.at(time))),
        }
    }

    /// Puts a contact where it is mounted, measured by its weights where they are known.
    fn place(&self, model: &Model, site: &mut Site, weights: Option<&NodalWeights>) {
        if weights.is_some() {
            site.reach = model.reach(&self.middle, site.side, weights);
        }
        let ends = self.ends.as_ref();
        site.ends = ends.map(|ends| ends.each_ref().map(|end| site.mounted_end(model, end, weights)));
    }
}

/// All contacts as they are placed.
pub(super) struct Placing {
    pub sites: Vec<Site>,
    /// Nodal weights of the contacts on each flexible ring, those of a contact together.
    pub feet: [Vec<NodalWeights>; 2],
    /// Nodal weights of the slopes of each flexible ring along the way of balls, where they are asked for.
    pub slopes: [Vec<NodalWeights>; 2],
    /// Half of every patch along the groove, rad, by site.
    half_angles: Vec<f64>,
}

impl Placing {
    /// Whether patches placed at `wanted` lie where the contacts were `met`.
    pub fn holds(&self, wanted: &[PatchPlace], met: &[PatchPlace]) -> bool {
        let largest = met.iter().fold(0.0, |most: f64, m| most.max(m.force));
        let close = |((w, m), half): ((&PatchPlace, &PatchPlace), &f64)| {
            half.is_infinite()
                || ((w.angle - m.angle).abs() * m.force <= ANGLE_TOLERANCE * half * largest
                    && (w.force.cbrt() - m.force.cbrt()).abs() <= SIZE_TOLERANCE * largest.cbrt())
        };
        wanted.iter().zip(met).zip(&self.half_angles).all(close)
    }
}

/// Weights of the last three parts, the last first, in what is expected of the next: the mean of linear and quadratic
/// extrapolation. Either is wrong by -i x^3 or +i x^3 in an oscillation that turns by x in a part, which feeds it or
/// takes from it; their mean by -i x^5 / 2.
const EXPECTED: [f64; 3] = [2.5, -2.0, 0.5];

impl MotionState {
    /// Where the contacts of the next part are expected, by site.
    pub(super) fn expected_places(&self) -> Vec<PatchPlace> {
        expected(self.places.each_ref().map(Vec::as_slice))
    }
}

/// The same after parts in which they lay at `places`, the last first.
pub(super) fn expected(places: [&[PatchPlace]; 3]) -> Vec<PatchPlace> {
    let sum = |of: &dyn Fn(&[PatchPlace]) -> f64| {
        let terms = EXPECTED.iter().zip(&places).map(|(c, part)| c * of(part));
        terms.sum::<f64>()
    };
    let place = |site: usize| PatchPlace {
        angle: sum(&|part| part[site].angle),
        force: sum(&|part| part[site].force).max(0.0),
    };
    (0..places[0].len()).map(place).collect()
}

impl BearingParts {
    /// Where the contacts of the part were at its weighted time, by site.
    pub(super) fn places(&self, solution: &StepSolution) -> Vec<PatchPlace> {
        let start = self.contacts.means.map_or(0.0, |means| means.weight);
        let place = |(index, (site, force)): (usize, (&Site, &MeanForce))| {
            let [l0, l1] = solution.reach(index);
            let l = l0.map(|x| start * x) + l1.map(|x| (1.0 - start) * x);
            let l = l.map(|x| site.side.sign() * x).to_array();
            PatchPlace {
                angle: l[1].atan2(l[0]),
                force: force.force[0].hypot(force.force[1]),
            }
        };
        let contacts = self.contacts.sites.iter().zip(&solution.forces);
        contacts.enumerate().map(place).collect()
    }
}

impl Motion<'_> {
    /// Contacts in the middle of a part at their places, by site.
    pub(super) fn place(&self, places: &[PatchPlace], course: &Course) -> Result<Placing, DynamicsError> {
        let mounting = PartMounting::new(&self.model.mounting, course);
        let placed: Result<Vec<_>, DynamicsError> = loaded(places.iter().map(|place| place.force))
            .into_par_iter()
            .zip(places)
            .enumerate()
            .map(|(index, (loaded, place))| self.place_contact(index, *place, loaded, course, &mounting))
            .collect();
        let mut placing = Placing {
            sites: Vec::new(),
            feet: [Vec::new(), Vec::new()],
            slopes: [Vec::new(), Vec::new()],
            half_angles: Vec::new(),
        };
        for placed in placed? {
            let side = placed.site.side.index();
            placing.feet[side].extend(placed.weights);
            placing.slopes[side].extend(placed.slope);
            placing.sites.push(placed.site);
            placing.half_angles.push(placed.half_angle);
        }
        Ok(placing)
    }

    /// One contact: its site and, on a flexible ring, its patch.
    fn place_contact(
        &self,
        index: usize,
        PatchPlace { angle, force }: PatchPlace,
        loaded: bool,
        course: &Course,
        mounting: &PartMounting<'_>,
    ) -> Result<Placed, DynamicsError> {
        let model = self.model;
        let (ball, side) = (index / 2, Side::BOTH[index % 2]);
        let azimuth = course.azimuths[ball];
        let mut site = Site::new(model, &mounting.middle, ball, side, azimuth);
        let (Some(ring), Some(moving)) = (model.ring(side), &self.rings[side.index()]) else {
            mounting.place(model, &mut site, None);
            if let Some(passed) = &course.passed {
                site.passing = passed.rigid(&site, angle);
            }
            return Ok(Placed {
                site,
                weights: Vec::new(),
                slope: None,
                half_angle: f64::INFINITY,
            });
        };
        let shape = PatchShape::new(
            &moving.raceway.surface,
            azimuth - self.frame_angle(side, course.time),
            on_groove(&moving.raceway.surface, angle, loaded),
            model.hertz[side.index()].semi_axes(force),
            model.contact.least_patch,
        )?;
        let (surface, nodes, rule) = (&moving.raceway.surface, &ring.mesh.nodes, &moving.raceway.rule);
        let material = elastic(&ring.material);
        let (patch, [traction, slope]) = if course.is_free {
            let (patch, more) = Patch::of_free_ball(surface, nodes, rule, shape, material)?;
            (patch, more.map(Some))
        } else if course.passed.is_some() {
            let (patch, slope) = Patch::with_slope(surface, nodes, rule, shape, material)?;
            (patch, [None, Some(slope)])
        } else {
            (Patch::new(surface, nodes, rule, shape, material)?, [None, None])
        };
        site.law.patch_compliance = patch.compliance;
        mounting.place(model, &mut site, Some(&patch.weights));
        Ok(Placed {
            site,
            weights: std::iter::once(patch.weights).chain(traction).collect(),
            slope,
            half_angle: shape.semi_axes.groove / ring.groove.groove_radius,
        })
    }

    /// Fails when a ball of a part that carries more than a slight load lies beyond the rim of a flexible ring's
    /// groove.
    pub(super) fn check_on_grooves(&self, met: &[PatchPlace]) -> Result<(), DynamicsError> {
        let presses = well_loaded(met.iter().map(|place| place.force));
        for (index, (place, presses)) in met.iter().zip(presses).enumerate() {
            if let (Some(moving), true) = (&self.rings[index % 2], presses) {
                require_on_groove(&moving.raceway.surface, index / 2, place.angle)?;
            }
        }
        Ok(())
    }
}
