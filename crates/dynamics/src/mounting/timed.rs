//! A bearing on its seats at any time of its temperatures.

use contact::{BearingGeometry, BySide, Side};
use ring::RadialProfile;

use super::clearance::Clearance;
use super::conditions::{Conditions, RingTemperature, TemperatureSchedule};
use super::mounted::{Grown, MountedRing};
use super::seat::{MountedSeat, RingSeat, SeatStrain};
use super::unmounted::Unmounted;
use crate::error::DynamicsError;

/// A bearing on its seats, with the temperatures of its bodies.
#[derive(Debug)]
pub struct Warmed {
    geometry: BearingGeometry,
    seats: BySide<RingSeat>,
    /// None: all is at the reference temperature.
    bodies: Option<BodyTemperatures>,
}

/// Temperatures and expansion of all bodies.
#[derive(Debug)]
struct BodyTemperatures {
    /// Means of the rings, inner first.
    rings: BySide<TemperatureSchedule>,
    balls: TemperatureSchedule,
    partners: BySide<TemperatureSchedule>,
    reference: f64,
    /// Thermal expansion of the rings, of the balls, 1/K.
    expansion: BySide<f64>,
    partner_expansion: BySide<f64>,
    /// Highest temperature of each ring, K.
    warmest_rings: BySide<f64>,
}

/// Thermal strains, counted from the reference temperature.
#[derive(Clone, Copy, Debug, Default)]
struct Strains {
    rings: BySide<f64>,
    balls: f64,
    partners: BySide<f64>,
}

impl Warmed {
    /// Finds what each seat does to its ring.
    pub fn new(bearing: &Unmounted, conditions: &Conditions) -> Result<Warmed, DynamicsError> {
        let bodies = BodyTemperatures::new(bearing, conditions);
        let seat = |side: Side| {
            let own = own_strain(bearing, conditions, bodies.as_ref(), side);
            RingSeat::new(bearing, conditions, side, own)
        };
        let [inner, outer] = Side::BOTH.map(seat);
        Ok(Warmed {
            geometry: *bearing.geometry,
            seats: [inner?, outer?],
            bodies,
        })
    }

    /// Whether a temperature changes.
    pub fn changes(&self) -> bool {
        self.bodies
            .iter()
            .any(|bodies| bodies.schedules().any(TemperatureSchedule::changes))
    }

    /// Times, s, growing, between which all is linear; at least one.
    pub fn corners(&self) -> Vec<f64> {
        let schedules = self.bodies.iter().flat_map(BodyTemperatures::schedules);
        let changing = schedules.filter(|schedule| schedule.changes());
        let mut times: Vec<f64> = changing.flat_map(|schedule| &schedule.times).copied().collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.is_empty() {
            times.push(0.0);
        }
        times
    }

    /// Highest temperature of each ring, K.
    pub fn warmest_rings(&self) -> BySide<f64> {
        self.bodies
            .as_ref()
            .map_or([0.0; 2], |bodies| bodies.warmest_rings)
    }

    /// Both seats at the reference temperature.
    pub fn cold_seats(&self) -> Result<BySide<MountedSeat>, DynamicsError> {
        let [inner, outer] = self
            .seats
            .each_ref()
            .map(|seat| seat.mounted(SeatStrain::default()));
        Ok([inner?, outer?])
    }

    /// Both seats at a time, s.
    pub fn seats_at(&self, time: f64) -> Result<BySide<MountedSeat>, DynamicsError> {
        let strains = self.strains(time);
        let mounted = |side: Side| {
            let i = side.index();
            self.seats[i].mounted(SeatStrain {
                partner: strains.partners[i] - strains.rings[i],
                own: 1.0,
            })
        };
        let [inner, outer] = Side::BOTH.map(mounted);
        Ok([inner?, outer?])
    }

    /// Both seats at all corners; fails where a ring that turns is loose at some and pressed at others: between them it
    /// lets go.
    pub fn seats_at_corners(&self) -> Result<Vec<BySide<MountedSeat>>, DynamicsError> {
        let found: Result<Vec<_>, _> = self
            .corners()
            .into_iter()
            .map(|time| self.seats_at(time))
            .collect();
        let found = found?;
        for (side, seat) in Side::BOTH.into_iter().zip(&self.seats) {
            let reports = found.iter().filter_map(|seats| seats[side.index()].report);
            let least = reports
                .clone()
                .min_by(|a, b| a.interference.total_cmp(&b.interference));
            if let Some(least) = least
                && least.pressure == 0.0
                && reports.into_iter().any(|report| report.pressure > 0.0)
            {
                seat.check_turning(&least)?;
            }
        }
        Ok(found)
    }

    /// Radial clearance at a time, s, with its seats.
    pub fn clearance(&self, time: f64, seats: &BySide<MountedSeat>) -> Clearance {
        let (strains, common) = self.relative(time);
        let grooves = seats.each_ref().map(|seat| seat.groove.radial);
        Clearance::new(&self.geometry, strains.rings, strains.balls, grooves).scaled(1.0 + common)
    }

    /// What mounting does at a time, s, with its seats.
    pub fn grown(&self, time: f64, seats: &BySide<MountedSeat>) -> Grown {
        let (strains, relative) = (self.strains(time), self.relative(time).0);
        let ring = |side: Side| {
            let seat = &seats[side.index()];
            let strain = relative.rings[side.index()];
            MountedRing {
                expansion: strains.rings[side.index()],
                centre_growth: strain * self.geometry.centre_radius(side),
                groove_radius_growth: strain * self.geometry.groove_radius(side),
                groove: seat.groove,
                field: seat.field.clone(),
                own_stress: seat.own_stress.clone(),
            }
        };
        Grown {
            rings: Side::BOTH.map(ring),
            ball_radius_growth: 0.5 * relative.balls * self.geometry.ball_diameter,
        }
    }

    fn strains(&self, time: f64) -> Strains {
        self.bodies
            .as_ref()
            .map_or(Strains::default(), |bodies| bodies.strains(time))
    }

    /// Strains of rings and balls counted from that of the outer ring, and that.
    fn relative(&self, time: f64) -> (Strains, f64) {
        let strains = self.strains(time);
        let common = strains.rings[1];
        let relative = Strains {
            rings: strains.rings.map(|e| e - common),
            balls: strains.balls - common,
            ..strains
        };
        (relative, common)
    }
}

impl BodyTemperatures {
    fn new(bearing: &Unmounted, conditions: &Conditions) -> Option<BodyTemperatures> {
        let warm = conditions.temperatures.as_ref()?;
        let [rings, balls] = bearing.expansion;
        let mean = |side: Side| match &warm.rings[side.index()] {
            RingTemperature::Uniform(schedule) => schedule.clone(),
            RingTemperature::Radial(profile) => {
                TemperatureSchedule::constant(profile.tube_mean(bearing.tube_radii(side)))
            }
        };
        let partner = |side: Side| match (&warm.partners[side.index()], &warm.rings[side.index()]) {
            (Some(schedule), _) | (None, RingTemperature::Uniform(schedule)) => schedule.clone(),
            (None, RingTemperature::Radial(profile)) => {
                TemperatureSchedule::constant(profile.at(bearing.tube_radii(side)[0]))
            }
        };
        let warmest = |ring: &RingTemperature| {
            let values = match ring {
                RingTemperature::Uniform(schedule) => schedule.values.iter(),
                RingTemperature::Radial(profile) => profile.values.iter(),
            };
            values.fold(0.0, |most: f64, value| most.max(*value))
        };
        Some(BodyTemperatures {
            rings: Side::BOTH.map(mean),
            balls: warm.balls.clone(),
            partners: Side::BOTH.map(partner),
            reference: warm.reference,
            expansion: [rings, balls],
            partner_expansion: warm.partner_expansion.map(|expansion| expansion.unwrap_or(rings)),
            warmest_rings: warm.rings.each_ref().map(warmest),
        })
    }

    fn schedules(&self) -> impl Iterator<Item = &TemperatureSchedule> {
        self.rings.iter().chain([&self.balls]).chain(&self.partners)
    }

    fn strains(&self, time: f64) -> Strains {
        let strain =
            |expansion: f64, body: &TemperatureSchedule| expansion * (body.at(time) - self.reference);
        let [rings, balls] = self.expansion;
        Strains {
            rings: self.rings.each_ref().map(|body| strain(rings, body)),
            balls: strain(balls, &self.balls),
            partners: [0, 1].map(|i| strain(self.partner_expansion[i], &self.partners[i])),
        }
    }
}

/// Strain of a flexible ring about its mean; None: it has one temperature.
fn own_strain(
    bearing: &Unmounted,
    conditions: &Conditions,
    bodies: Option<&BodyTemperatures>,
    side: Side,
) -> Option<RadialProfile> {
    let (warm, bodies) = (conditions.temperatures.as_ref()?, bodies?);
    let RingTemperature::Radial(profile) = &warm.rings[side.index()] else {
        return None;
    };
    let mean = bodies.rings[side.index()].at(0.0);
    Some(profile.map(|kelvin| bearing.expansion[0] * (kelvin - mean)))
}
