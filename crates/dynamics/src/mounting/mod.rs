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
//! Rigid rings grow as thick tubes from seat to groove bottom ([`tube`]), 8 % more than the ring of a 7010C.
//! Energies are counted from the mounted state: w does no work on what loads add. Cost: [`ring::seat`] at the start;
//! per contact and placing of its patch one more product with its weights. Absent: nothing.

pub mod clearance;
pub mod conditions;
mod seat;
pub mod tube;
mod unmounted;

use std::sync::Arc;

use contact::{BySide, Meridian, NodalWeights, Side};

pub use clearance::{Clearance, Clearances};
pub use conditions::{Conditions, Fit, SeatForm, Temperatures};
pub use seat::SeatReport;
pub use unmounted::Unmounted;

use crate::error::DynamicsError;
use seat::{MountedSeat, RingSeat};

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
}

/// What mounting does to a ring.
#[derive(Clone, Debug, Default)]
pub struct MountedRing {
    /// Free thermal strain, counted from the reference temperature.
    pub expansion: f64,
    /// Radial growth of the circle of groove centres by temperature, m.
    pub centre_growth: f64,
    /// Growth of the groove's radius by temperature, m.
    pub groove_radius_growth: f64,
    /// Mean motion of the groove by the seat [radial, axial], m.
    pub groove: Meridian,
    /// Nodal displacement of a flexible ring by its seat, in the frame of its mesh, m, `[n_nodes][3]` flat; None: none.
    pub field: Option<Arc<Vec<f64>>>,
}

/// Clearance, seats and warnings.
#[derive(Clone, Debug, PartialEq)]
pub struct MountingReport {
    /// Clearance before and after mounting, and warm.
    pub clearances: Clearances,
    /// Seats with a fit, inner first.
    pub seats: BySide<Option<SeatReport>>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// Thermal strains, counted from the reference temperature.
#[derive(Clone, Copy, Debug, Default)]
struct Strains {
    rings: BySide<f64>,
    balls: f64,
    partners: BySide<f64>,
}

impl Mounting {
    /// Mounts a bearing.
    pub fn new(bearing: &Unmounted, conditions: &Conditions) -> Result<Mounting, DynamicsError> {
        if conditions.is_none() {
            return Ok(Mounting::default());
        }
        let strains = Strains::new(bearing, conditions);
        let mount = |strains: &Strains| -> Result<BySide<MountedSeat>, DynamicsError> {
            let [inner, outer] = Side::BOTH.map(|side| {
                let i = side.index();
                let seat = RingSeat::new(bearing, conditions, side)?;
                seat.mounted(strains.partners[i] - strains.rings[i])
            });
            Ok([inner?, outer?])
        };
        let (cold, warm) = (mount(&Strains::default())?, mount(&strains)?);
        let grooves = |seats: &BySide<MountedSeat>| seats.each_ref().map(|seat| seat.groove[0]);
        let common = strains.rings[1];
        let relative = Strains {
            rings: strains.rings.map(|e| e - common),
            balls: strains.balls - common,
            ..strains
        };
        let geometry = bearing.geometry;
        let clearances = Clearances {
            unmounted: Clearance::new(geometry, [0.0; 2], 0.0, [0.0; 2]),
            mounted: Clearance::new(geometry, [0.0; 2], 0.0, grooves(&cold)),
            operating: Clearance::new(geometry, relative.rings, relative.balls, grooves(&warm))
                .scaled(1.0 + common),
        };
        let mut warnings = hot(conditions);
        warnings.extend(warm.iter().flat_map(|seat| seat.warnings.clone()));
        let seats = warm.each_ref().map(|seat| seat.report);
        let ring = |side: Side| {
            let seat = &warm[side.index()];
            let strain = relative.rings[side.index()];
            MountedRing {
                expansion: strains.rings[side.index()],
                centre_growth: strain * geometry.centre_radius(side),
                groove_radius_growth: strain * geometry.groove_radius(side),
                groove: seat.groove,
                field: seat.field.clone(),
            }
        };
        Ok(Mounting {
            rings: Side::BOTH.map(ring),
            ball_radius_growth: 0.5 * relative.balls * geometry.ball_diameter,
            report: Some(MountingReport {
                clearances,
                seats,
                warnings,
            }),
        })
    }

    /// Motion of the groove centre of a ring by mounting [radial, axial], m, measured by the weights of a contact.
    pub fn groove_motion(&self, side: Side, weights: Option<&NodalWeights>) -> Meridian {
        let ring = &self.rings[side.index()];
        let [radial, axial] = match (&ring.field, weights) {
            (Some(field), Some(weights)) => weights.measure(field),
            _ => ring.groove,
        };
        [ring.centre_growth + radial, axial]
    }

    /// Growth of the distance from groove centre to the centre of a touching ball, m.
    pub fn touching_growth(&self, side: Side) -> f64 {
        self.rings[side.index()].groove_radius_growth - self.ball_radius_growth
    }
}

impl Strains {
    fn new(bearing: &Unmounted, conditions: &Conditions) -> Strains {
        let Some(warm) = &conditions.temperatures else {
            return Strains::default();
        };
        let [rings, balls] = bearing.expansion;
        let strain = |expansion: f64, temperature: f64| expansion * (temperature - warm.reference);
        Strains {
            rings: warm.rings.map(|t| strain(rings, t)),
            balls: strain(balls, warm.balls),
            partners: [0, 1].map(|i| strain(warm.partner_expansion[i].unwrap_or(rings), warm.partners[i])),
        }
    }
}

/// Warns of rings that change their size for good.
fn hot(conditions: &Conditions) -> Vec<String> {
    let Some(warm) = &conditions.temperatures else {
        return Vec::new();
    };
    let hot = Side::BOTH
        .into_iter()
        .filter(|side| warm.rings[side.index()] > STABLE);
    hot.map(|side| {
        format!(
            "the {} ring is at {:.0} degC: beyond {:.0} degC a ring grows for good unless its steel is tempered for it \
             (DIN 623-1: SN to 120, S0 to 150, S1 to 200 degC); its clearance here has the elastic part alone",
            side.name(),
            warm.rings[side.index()] - CELSIUS_ZERO,
            STABLE - CELSIUS_ZERO,
        )
    })
    .collect()
}
