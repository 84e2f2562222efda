//! Real surfaces and changing temperatures over a part of a step.
//!
//! A contact keeps the surface of the part's weighted time, so that its forces have a potential. What the surface gives
//! to or takes from the contact as it moves on is work of profiles: over the first share of the part with the lengths
//! of its start, over the rest with those of its end. The sum of all parts telescopes: it is the change of the contact
//! energies that the contacts' forces did not make. Temperatures are kept and accounted for in the same way.

use contact::{SeenMeridian, Side};

use super::free_state::FreeState;
use super::ledger::Ledger;
use super::run::Motion;
use super::solve::StepSolution;
use super::span::PartSpan;
use super::state::MotionState;
use crate::bearing::{BearingParts, lengths};
use crate::interactions::free_contact::FoundContact;
use crate::interactions::free_contact::orientation::{Quaternion, at_start, in_ball};
use crate::interactions::free_contact::rolling_surface::{RollingSurface, WornBall};
use crate::interactions::raceway_contact::Site;
use crate::surfaces::{StripBearing, Strips, SurfacePlace, Surfaces};

impl Motion<'_> {
    /// Surfaces of the bearing.
    pub fn surfaces(&self) -> &Surfaces {
        &self.model.surfaces
    }

    /// Whether contacts of a raceway are strips: their surfaces then have a line in the ledger.
    pub fn has_strips(&self) -> bool {
        self.model.surfaces.has_strips()
    }

    /// Contacts on the surfaces over which they roll in a part.
    pub(super) fn on_surfaces(&self, span: PartSpan, mut sites: Vec<Site>) -> Vec<Site> {
        // A free ball's contact finds its surfaces with the ball's place.
        if !self.model.surfaces.has_strips() || self.model.traction().is_some() {
            return sites;
        }
        for site in &mut sites {
            let place = |time: f64| SurfacePlace {
                azimuth: self.ball_azimuth(site.ball, time) - self.frame_angle(site.side, time),
                rolled: self
                    .kinematics
                    .rolled(Side::BOTH.map(|side| self.frame_angle(side, time))),
                seen: None,
            };
            let middle = place(self.weighted_time(span));
            let strips = self.model.surfaces.at(site.ball, site.side, middle);
            let ends = [0.0, 1.0].map(|share| place(span.at(share)));
            site.strips = strips.map(|strips| strips.between(ends));
        }
        sites
    }

    /// The surfaces over which a free ball's contact rolls in a part; None where they are smooth.
    pub(super) fn rolling_surface(
        &self,
        (free, angle): (&FreeState, f64),
        span: PartSpan,
        site: &Site,
    ) -> Option<RollingSurface> {
        let strips = site.strips.clone()?;
        let [start, end] = [0.0, 1.0].map(|share| self.frame_angle(site.side, span.at(share)));
        let orientation = free
            .orientations
            .get(site.ball)
            .filter(|_| strips.equator().is_some());
        Some(RollingSurface {
            ring_angle: start,
            ring_turn: end - start,
            ball: orientation.map(|orientation| WornBall {
                orientation: *orientation,
                angle,
            }),
            strips,
        })
    }

    /// Orientations of free balls at the start; none where all are spheres.
    pub(super) fn orientations_at_start(&self) -> Vec<Quaternion> {
        let worn = self.model.surfaces.balls.values().next();
        let Some([ball, _]) = worn else { return Vec::new() };
        let at_start = |i: usize| at_start(self.model.geometry.azimuth(i), ball.equator());
        (0..self.n_balls()).map(at_start).collect()
    }
}

impl Motion<'_> {
    /// How a contact carries its load in a state, beside Hertz's ellipse of this force, N; None: its raceway
    /// has no strips.
    pub(super) fn strip_bearing(
        &self,
        state: &MotionState,
        (ball, side): (usize, Side),
        force: f64,
    ) -> Option<StripBearing> {
        let index = 2 * ball + side.index();
        let strips = self.strips_at((state, self.time(state.step)), (ball, side))?;
        let axes = self.model.hertz[side.index()].semi_axes(force);
        Some(strips.bearing(state.approaches[index], state.angles[index], axes))
    }

    /// The strips under a contact as it stands in a state at a time, s; None: its raceway has none.
    pub(super) fn strips_at(
        &self,
        (state, time): (&MotionState, f64),
        (ball, side): (usize, Side),
    ) -> Option<Strips> {
        if !self.has_strips() {
            return None;
        }
        let turned = Side::BOTH.map(|side| self.frame_angle(side, time));
        let (azimuth, angle) = (
            self.azimuth_now(state, ball),
            state.angles[2 * ball + side.index()],
        );
        let free = state.free.as_ref();
        let seen = |q: &Quaternion| {
            let (sin, cos) = azimuth.sin_cos();
            SeenMeridian {
                out: in_ball(*q, [cos, sin, 0.0]),
                axial: in_ball(*q, [0.0, 0.0, 1.0]),
                angle,
            }
        };
        let place = SurfacePlace {
            azimuth: azimuth - turned[side.index()],
            rolled: self.kinematics.rolled(turned),
            seen: free.and_then(|free| free.orientations.get(ball)).map(seen),
        };
        self.model.surfaces.at(ball, side, place)
    }
}

impl BearingParts {
    /// Puts the strips over which the contacts of free balls rolled.
    pub(super) fn roll_over(&mut self, found: &[FoundContact]) {
        for (site, found) in self.contacts.sites.iter_mut().zip(found) {
            if let Some(surface) = &found.surface {
                site.strips = Some(surface.strips.clone());
            }
        }
    }
}

/// Takes what temperatures do out of the ledger's work of patches, which has the energies `start` and `end` of a part
/// as the bearing is mounted in its middle: the sum of all parts telescopes as that of surfaces does.
pub(super) fn note_temperature_work(
    ledger: &mut Ledger,
    parts: &BearingParts,
    solution: &StepSolution,
    (start, end): (f64, f64),
) {
    if let Some(own) = parts.contacts.energies_as_mounted(lengths(&solution.reaches)) {
        let [first, last] = [start - own[0], own[1] - end];
        ledger.temperature_work += first + last;
        ledger.patch_work -= first;
        ledger.hertz = own[1];
    }
}

/// Takes what surfaces do out of the ledger's work of patches, which has the energies `start` and `end` of a part on
/// the surfaces of its middle.
pub(super) fn note_profile_work(
    ledger: &mut Ledger,
    parts: &BearingParts,
    solution: &StepSolution,
    (start, end): (f64, f64),
) {
    if let Some(own) = parts.contacts.energies_on_surfaces(lengths(&solution.reaches)) {
        let [first, last] = [start - own[0], own[1] - end];
        ledger.profile_work += first + last;
        ledger.patch_work -= first;
        ledger.hertz = own[1];
    }
}
