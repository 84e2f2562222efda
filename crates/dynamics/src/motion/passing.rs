//! How fast contacts close because balls on the course of the cage pass along rings that stand off the axis or yield:
//! what damping of contacts feels besides the motion of balls, shaft and rings.
//!
//! A contact on a rigid ring is measured where its azimuth is in space: a ball passes there with the speed of the cage.
//! One on an elastic ring is measured at nodes that turn with the ring: their motion in a step has what the turning of
//! the ring brings to them, and the ball passes with the difference of both speeds. What it passes is the slope of all
//! of the ring's motion along the groove, at the start of the step. The motion of what carries the ring, which is known
//! before the step, brings it to the weighted time.

use contact::{BySide, Meridian, Side};
use ring::ElasticStep;

use super::run::Motion;
use super::span::PartSpan;
use super::state::{MotionState, PatchPlace};
use crate::interactions::raceway_contact::Site;

/// How balls pass along rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassedRings {
    /// Angular speed of the balls round the axis, rad/s.
    orbit: f64,
    /// Displacement of both carriers at the weighted time, as it is expected.
    carriers: BySide<[f64; 5]>,
}

impl PassedRings {
    /// How fast a contact on a rigid ring closes at a contact angle, m/s.
    pub fn rigid(&self, site: &Site, angle: f64) -> f64 {
        closing(
            site,
            angle,
            self.orbit,
            growth(site, self.carriers[site.side.index()]),
        )
    }
}

impl Motion<'_> {
    /// How balls on the course of the cage pass an inner ring that goes on with the shaft as that moves, and an outer
    /// one that stays; None where nothing damps, or nothing turns.
    pub(super) fn passed(&self, state: &MotionState, span: PartSpan) -> Option<PassedRings> {
        self.settings.contact_damping.as_ref()?;
        let ahead = (1.0 - self.settings.integrator.alpha_f) * span.dt;
        let shaft = std::array::from_fn(|i| state.shaft[i] + ahead * state.shaft_velocity[i]);
        let [from, to] = [0.0, 1.0].map(|share| self.cage_angle(span.at(share)));
        let orbit = (to - from) / span.dt;
        let carriers = [shaft, [0.0; 5]];
        let is_turned =
            |side: Side| self.rings[side.index()].is_some() && self.frame_speed(side, span) != 0.0;
        let turns = orbit != 0.0 || Side::BOTH.into_iter().any(is_turned);
        turns.then_some(PassedRings { orbit, carriers })
    }

    /// Mean speed of a ring's frame over a part, rad/s.
    pub(super) fn frame_speed(&self, side: Side, span: PartSpan) -> f64 {
        let [from, to] = [0.0, 1.0].map(|share| self.frame_angle(side, span.at(share)));
        (to - from) / span.dt
    }

    /// Puts into the contacts on elastic rings, placed at `places`, how balls of the cage's kinematics pass them.
    pub(super) fn pass_elastic(
        &self,
        (state, span): (&MotionState, PartSpan),
        places: &[PatchPlace],
        rings: &BySide<Option<Box<dyn ElasticStep + '_>>>,
        sites: &mut [Site],
    ) {
        let passed = self.passed(state, span).filter(|_| state.free.is_none());
        let Some(passed) = passed else { return };
        for (side, step) in Side::BOTH.into_iter().zip(rings) {
            let Some(step) = step else { continue };
            let (i, turning) = (side.index(), self.frame_speed(side, span));
            // At the start the nodes of the contact were behind where they are at the weighted time.
            let turned = turning * (1.0 - self.settings.integrator.alpha_f) * span.dt;
            let carrier = [state.shaft, [0.0; 5]][i];
            let seen = step.answer().seen.as_chunks::<2>().0.iter();
            let sites = sites.iter_mut().zip(places).skip(i).step_by(2);
            for ((site, place), seen) in sites.zip(seen) {
                let before = Site {
                    azimuth: site.azimuth - turned,
                    ..site.clone()
                };
                let moved = growth(site, passed.carriers[i]) - growth(&before, carrier);
                let slope = Meridian::from(*seen) + moved;
                site.passing = closing(site, place.angle, passed.orbit - turning, slope);
            }
        }
    }
}

/// Growth of the motion of a groove with the azimuth as a carrier displaces it, m/rad.
fn growth(site: &Site, carrier: [f64; 5]) -> Meridian {
    let rows = site.carrier_growth().into_iter().zip(carrier);
    rows.fold(Meridian::default(), |sum, (row, x)| sum + row.map(|r| r * x))
}

/// How fast a contact at a contact angle closes as its ball passes with `speed`, rad/s, over a slope of the groove,
/// m/s: l is to the ball, so it shrinks where the groove comes near.
fn closing(site: &Site, angle: f64, speed: f64, slope: Meridian) -> f64 {
    let normal = Meridian::new(angle.cos(), angle.sin()).map(|x| site.side.sign() * x);
    -speed * normal.dot(slope)
}
