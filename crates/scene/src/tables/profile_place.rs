//! Where a profile of `[[profiles.*]]` lies: on a ring or on a ball, at two angles.

use contact::surface::ball::MOST_LATITUDE;
use input::{ANGLE, Problems, Quantity};

use super::bearing::Bearing;
use super::ring_name::RingName;

/// What has a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WornBody {
    /// A ring.
    Ring(RingName),
    /// A ball, from 0.
    Ball(usize),
}

/// The keys that say what has a profile, as typed.
#[derive(Clone, Copy, Debug)]
pub(super) struct RawBody {
    pub ring: Option<RingName>,
    pub ball: Option<i64>,
}

/// An angle as typed, or none.
pub(super) type RawAngle = Option<Quantity<ANGLE>>;

/// Where a mark lies on its body, rad.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlaceAngles {
    /// Azimuth, or longitude.
    pub along: f64,
    /// Groove angle, or latitude.
    pub across: f64,
}

/// The keys that say where on it a mark lies, as typed: azimuth and groove angle of a ring, longitude and latitude of a
/// ball.
#[derive(Clone, Debug)]
pub(super) struct RawPlace {
    pub azimuth: RawAngle,
    pub groove_angle: RawAngle,
    pub longitude: RawAngle,
    pub latitude: RawAngle,
}

impl RawBody {
    /// What has the profile of a table such as `profiles.spall 1`; None: there is a problem.
    pub fn check(&self, table: &str, bearing: Option<&Bearing>, problems: &mut Problems) -> Option<WornBody> {
        match (self.ring, self.ball) {
            (Some(ring), None) => Some(WornBody::Ring(ring)),
            (None, Some(ball)) => {
                let last = bearing.map_or(i64::MAX, |bearing| bearing.balls as i64 - 1);
                let before = problems.len();
                let ball = problems.whole(ball, &format!("{table}: ball"), 0, last);
                (problems.len() == before).then_some(WornBody::Ball(ball))
            }
            (Some(_), Some(_)) => {
                problems.add(format!(
                    "{table}: ring and ball are both given; expected one, a table of its own for each"
                ));
                None
            }
            (None, None) => {
                problems.add(format!(
                    "{table}: ring or ball is missing; expected ring = \"inner\" or \"outer\", or ball = 0 and so on"
                ));
                None
            }
        }
    }
}

impl RawPlace {
    /// The two angles on a body, rad; those of the other kind of body, and missing ones, are problems.
    pub fn check(&self, table: &str, body: Option<WornBody>, problems: &mut Problems) -> PlaceAngles {
        let of_ring = [("azimuth", &self.azimuth), ("groove_angle", &self.groove_angle)];
        let of_ball = [("longitude", &self.longitude), ("latitude", &self.latitude)];
        let (own, other, what) = match body {
            Some(WornBody::Ring(_)) => (of_ring, of_ball, "ring"),
            Some(WornBody::Ball(_)) => (of_ball, of_ring, "ball"),
            None => return PlaceAngles::default(),
        };
        for (name, angle) in other {
            if angle.is_some() {
                problems.add(format!(
                    "{table}: {name} stands beside {what}; a place on a {what} has {} and {}",
                    own[0].0, own[1].0
                ));
            }
        }
        let [along, across] = own.map(|(name, angle)| {
            if angle.is_none() {
                problems.add(format!(
                    "{table}: {name} is missing; expected an angle beside {what}"
                ));
            }
            angle.as_ref().map_or(0.0, Quantity::si)
        });
        PlaceAngles { along, across }
    }

    /// Requires the angle across the track to lie on the body, with half the width of a mark, m, on a ball.
    pub fn check_across(
        &self,
        table: &str,
        body: Option<WornBody>,
        (half, bearing): (f64, Option<&Bearing>),
        problems: &mut Problems,
    ) {
        if let (Some(WornBody::Ring(_)), Some(angle)) = (body, &self.groove_angle) {
            problems.require(
                angle.si().abs() < std::f64::consts::FRAC_PI_2,
                &format!("{table}: groove_angle"),
                angle,
                "expected -90 to 90 deg",
            );
        }
        if let (Some(WornBody::Ball(_)), Some(angle), Some(bearing)) = (body, &self.latitude, bearing) {
            problems.require(
                angle.si().abs() + 2.0 * half / bearing.ball_diameter <= MOST_LATITUDE,
                &format!("{table}: latitude"),
                angle,
                format!(
                    "expected -{0:.0} to {0:.0} deg, the width included: raceways never touch a ball at the ends of \
                     the axis about which it rolls",
                    MOST_LATITUDE.to_degrees()
                ),
            );
        }
    }
}
