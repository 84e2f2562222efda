//! Mounting: what fits, temperatures and seats that are not round make of a bearing before any load.
//!
//! Everything but the contacts is linear, so rings keep their state of mounting beside what loads add to it:
//!
//! ```text
//! u = w + (what loads do),   sigma = D eps(u)       on the freely expanded ring
//! l = (ball) - (groove centre) - W^T w,   touching at  R (1 + e_r) - r (1 + e_b)
//! ```
//!
//! w are fields of the seat ([`ring::seat`]), W the weights of a contact's patch. A uniform temperature strains a free
//! ring by e = alpha dT without stress, so D (eps - alpha dT) is the stress of w and loads alone; with the strain e_p
//! of its partner its seat moves by (e_p - e) x, x the place from the point of the axis in the plane of the groove
//! centres, and the interference is I + (e_p - e) d. Grooves and balls have the strains e_r = e - e_o and e_b, counted
//! from that of the outer ring e_o: a change of size of the whole bearing is a change of scale, and is left out with
//! all that it does to forces, of order e_o.
//!
//! A temperature that varies with the radius counts by its mean over the tube from seat to groove bottom: of a free
//! tube both surfaces move by that (Timoshenko and Goodier, 3rd ed. 1970, art. 151). So does a rigid ring; in a
//! flexible one the strain about the mean adds a field, and D times it is taken from the stress.
//!
//! Rigid rings grow as thick tubes from seat to groove bottom ([`tube`]), 8 % more than the ring of a 7010C.
//! Energies are counted from the mounted state: w does no work on what loads add. Cost: [`ring::seat`] at the start;
//! per contact and placing of its patch one more product with its weights. Absent: nothing.
//!
//! **Over time** ([`Mounting::at`]) temperatures are linear between the corners of their schedules, and so are w and
//! the pressures of seats: what holds at all corners holds always, and is checked there. Bodies are warm at once, and
//! their growth has no inertia. Cost: a sum of fields for every instant that is asked for.

pub mod clearance;
pub mod conditions;
mod mounted;
mod seat;
mod timed;
pub mod tube;
mod unmounted;

use std::borrow::Cow;
use std::sync::Arc;

use contact::{BySide, Meridian, NodalWeights, Side};

pub use clearance::{Clearance, Clearances};
pub use conditions::{Conditions, Fit, RingTemperature, SeatForm, TemperatureSchedule, Temperatures};
pub use mounted::MountedRing;
pub use ring::RadialProfile;
pub use seat::SeatReport;
pub use unmounted::Unmounted;

use crate::error::DynamicsError;
use mounted::Grown;
use timed::Warmed;

/// Highest temperature to which every catalogue bearing keeps its size (DIN 623-1, suffix SN), K.
const STABLE: f64 = 393.15;
/// 0 degC, K.
const CELSIUS_ZERO: f64 = 273.15;

/// What mounting does to a bearing; the default is nothing.
#[derive(Clone, Debug, Default)]
pub struct Mounting {
    /// Rings, inner first.
    pub rings: BySide<MountedRing>,
    /// Growth of the balls' radius, m.
    pub ball_radius_growth: f64,
    /// What a reader of a result sees of it; None where no effect asks for any.
    pub report: Option<MountingReport>,
    /// The bearing with its schedules; None where no temperature changes. All else is that of time 0.
    warmed: Option<Arc<Warmed>>,
}

/// Clearance, seats and warnings.
#[derive(Clone, Debug, PartialEq)]
pub struct MountingReport {
    /// Clearance before and after mounting, and warm: with schedules, at their end.
    pub clearances: Clearances,
    /// Clearance at time 0, where temperatures change.
    pub at_start: Option<Clearance>,
    /// Seats with a fit, inner first; with schedules, at their end.
    pub seats: BySide<Option<SeatReport>>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

impl Mounting {
    /// Mounts a bearing.
    pub fn new(bearing: &Unmounted, conditions: &Conditions) -> Result<Mounting, DynamicsError> {
        if conditions.is_none() {
            return Ok(Mounting::default());
        }
        let warmed = Warmed::new(bearing, conditions)?;
        let (corners, found) = (warmed.corners(), warmed.seats_at_corners()?);
        let mut warnings = hot(conditions, &warmed);
        for warning in found.iter().flatten().flat_map(|seat| &seat.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        let (cold, end) = (warmed.cold_seats()?, corners[corners.len() - 1]);
        let last = &found[found.len() - 1];
        let clearances = Clearances {
            unmounted: Clearance::new(bearing.geometry, [0.0; 2], 0.0, [0.0; 2]),
            mounted: Clearance::new(
                bearing.geometry,
                [0.0; 2],
                0.0,
                cold.each_ref().map(|seat| seat.groove.radial),
            ),
            operating: warmed.clearance(end, last),
        };
        let start = warmed.seats_at(0.0)?;
        let report = MountingReport {
            clearances,
            at_start: warmed.changes().then(|| warmed.clearance(0.0, &start)),
            seats: last.each_ref().map(|seat| seat.report),
            warnings,
        };
        let mounting = Mounting::from(warmed.grown(0.0, &start));
        Ok(Mounting {
            report: Some(report),
            warmed: warmed.changes().then(|| Arc::new(warmed)),
            ..mounting
        })
    }

    /// Whether temperatures change over time.
    pub fn changes(&self) -> bool {
        self.warmed.is_some()
    }

    /// The mounting at a time, s; without its report where temperatures change.
    pub fn at(&self, time: f64) -> Cow<'_, Mounting> {
        let Some(warmed) = &self.warmed else {
            return Cow::Borrowed(self);
        };
        let seats = warmed.seats_at(time);
        let seats = seats.expect("seats hold at all corners, so between them too");
        Cow::Owned(Mounting::from(warmed.grown(time, &seats)))
    }

    /// Motion of the groove centre of a ring by mounting, m, measured by the weights of a contact.
    pub fn groove_motion(&self, side: Side, weights: Option<&NodalWeights>) -> Meridian {
        let ring = &self.rings[side.index()];
        let moved = match (&ring.field, weights) {
            (Some(field), Some(weights)) => weights.measure(field).into(),
            _ => ring.groove,
        };
        Meridian::new(ring.centre_growth + moved.radial, moved.axial)
    }

    /// Growth of the distance from groove centre to the centre of a touching ball, m.
    pub fn touching_growth(&self, side: Side) -> f64 {
        self.rings[side.index()].groove_radius_growth - self.ball_radius_growth
    }
}

impl From<Grown> for Mounting {
    fn from(grown: Grown) -> Mounting {
        Mounting {
            rings: grown.rings,
            ball_radius_growth: grown.ball_radius_growth,
            report: None,
            warmed: None,
        }
    }
}

/// Warns of rings that change their size for good.
fn hot(conditions: &Conditions, warmed: &Warmed) -> Vec<String> {
    if conditions.temperatures.is_none() {
        return Vec::new();
    }
    let warmest = warmed.warmest_rings();
    let hot = Side::BOTH
        .into_iter()
        .filter(|side| warmest[side.index()] > STABLE);
    hot.map(|side| {
        format!(
            "the {} ring is at {:.0} degC: beyond {:.0} degC a ring grows for good unless its steel is tempered for it \
             (DIN 623-1: SN to 120, S0 to 150, S1 to 200 degC); its clearance here has the elastic part alone",
            side.name(),
            warmest[side.index()] - CELSIUS_ZERO,
            STABLE - CELSIUS_ZERO,
        )
    })
    .collect()
}
