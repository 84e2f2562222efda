//! `[[profiles.dent]]`: a round dent with a raised rim on a raceway or a ball; see [`super::profiles`] and
//! [`contact::surface::Dent`] for its shape.

use contact::surface::Dent;
use input::{LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::bearing::Bearing;
use super::profile_place::{RawAngle, RawBody, RawPlace, WornBody};
use super::ring_name::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.dent]]")]
pub(super) struct RawDent {
    ring: Option<RingName>,
    ball: Option<i64>,
    azimuth: RawAngle,
    groove_angle: RawAngle,
    longitude: RawAngle,
    latitude: RawAngle,
    diameter: Quantity<LENGTH>,
    depth: Quantity<LENGTH>,
    rim_height: Option<Quantity<LENGTH>>,
    rim_width: Option<Quantity<LENGTH>>,
}

impl RawDent {
    /// What has it.
    pub fn body(&self) -> RawBody {
        RawBody {
            ring: self.ring,
            ball: self.ball,
        }
    }

    /// The dent, checked.
    pub fn check(
        &self,
        number: usize,
        body: Option<WornBody>,
        bearing: Option<&Bearing>,
        problems: &mut Problems,
    ) -> Dent {
        let table = format!("profiles.dent {number}");
        let key = |name: &str| format!("{table}: {name}");
        let place = RawPlace {
            azimuth: self.azimuth.clone(),
            groove_angle: self.groove_angle.clone(),
            longitude: self.longitude.clone(),
            latitude: self.latitude.clone(),
        };
        let angles = place.check(&table, body, problems);
        problems.require_positive(&self.diameter, &key("diameter"), "a diameter");
        problems.require_positive(&self.depth, &key("depth"), "a depth");
        let diameter = self.diameter.si();
        problems.require(
            self.depth.si() <= 0.5 * diameter,
            &key("depth"),
            &self.depth,
            format!(
                "expected at most half the diameter, {}, a few hundredths of it are usual",
                Quantity::<LENGTH>::about(0.5 * diameter)
            ),
        );
        let dent = Dent {
            azimuth: angles.along,
            groove_angle: angles.across,
            diameter,
            depth: self.depth.si(),
            rim_height: self.rim_height.as_ref().map_or(0.0, Quantity::si),
            rim_width: self.rim_width.as_ref().map_or(0.0, Quantity::si),
        };
        place.check_across(&table, body, (dent.reach(), bearing), problems);
        self.check_rim(&key, problems);
        let Some(bearing) = bearing else { return dent };
        let [least, most] = [1e-3, 1.0].map(|share| share * bearing.ball_diameter);
        problems.require(
            diameter >= least && 2.0 * dent.reach() <= most,
            &key("diameter"),
            &self.diameter,
            format!(
                "expected a thousandth of the ball diameter, {}, to the whole of it, {}, the rim included",
                Quantity::<LENGTH>::about(least),
                Quantity::<LENGTH>::about(most)
            ),
        );
        dent
    }

    fn check_rim(&self, key: &dyn Fn(&str) -> String, problems: &mut Problems) {
        let (height, width) = match (&self.rim_height, &self.rim_width) {
            (None, None) => return,
            (Some(height), Some(width)) => (height, width),
            (Some(_), None) => {
                return problems.add(format!(
                    "{} is missing; expected a length beside rim_height",
                    key("rim_width")
                ));
            }
            (None, Some(_)) => {
                return problems.add(format!(
                    "{} is missing; expected a height beside rim_width",
                    key("rim_height")
                ));
            }
        };
        problems.require(
            height.si() >= 0.0 && height.si() <= self.depth.si(),
            &key("rim_height"),
            height,
            "expected 0 to the depth",
        );
        let diameter = self.diameter.si();
        problems.require(
            width.si() >= 0.01 * diameter && width.si() <= diameter,
            &key("rim_width"),
            width,
            format!(
                "expected a hundredth of the diameter, {}, to the whole of it",
                Quantity::<LENGTH>::about(0.01 * diameter)
            ),
        );
    }
}
