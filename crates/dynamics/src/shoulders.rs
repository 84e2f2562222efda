//! Shoulders of a bearing, as far as its scene tells of them: the direction in which an angular contact bearing
//! carries, and where the grooves of rigid rings end. The contacts know nothing of them: a ball that leans on a
//! shoulder that is not there still carries, so that whoever reads the result is told.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use contact::Side;

use crate::balls::BallResult;

/// Beyond this angle on the other side of its bottom a groove carries nothing, rad: 2 degrees. The groove of an angular
/// contact bearing ends a little past its bottom, and balls under radial load or at high speed stand about there.
const PAST_THE_BOTTOM: f64 = 2.0 * PI / 180.0;

/// What a scene tells of the shoulders; the default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shoulders {
    /// Sign of the contact angles for which an angular contact bearing is made, 1 or -1; None: balls may lean to both
    /// sides, as in a deep groove bearing.
    pub direction: Option<f64>,
    /// Groove angles at which the grooves of rigid rings end, rad, inner first; None: a mesh tells, or nothing does.
    pub ends: [Option<RangeInclusive<f64>>; 2],
}

impl Shoulders {
    /// Whether a contact angle, rad, is against the direction for which the bearing is made.
    pub fn is_against(&self, angle: f64) -> bool {
        self.direction.is_some_and(|sign| sign * angle < -PAST_THE_BOTTOM)
    }

    /// Whether an ellipse, as long as `reach` from its centre in groove angle, rad, reaches beyond the groove of a
    /// rigid ring.
    pub fn is_beyond(&self, side: Side, angle: f64, reach: f64) -> bool {
        let beyond =
            |groove: &RangeInclusive<f64>| reach > (angle - groove.start()).min(groove.end() - angle);
        self.ends[side.index()].as_ref().is_some_and(beyond)
    }

    /// A warning of balls that carry against the direction for which the bearing is made; `is_loaded` by site.
    pub fn warning(&self, is_loaded: &[bool], balls: &[BallResult]) -> Option<String> {
        let leans = |ball: usize, side: Side| {
            is_loaded[2 * ball + side.index()] && self.is_against(balls[ball].contact(side).contact_angle_rad)
        };
        let wrong: Vec<usize> = (0..balls.len())
            .filter(|&ball| Side::BOTH.into_iter().any(|side| leans(ball, side)))
            .collect();
        let first = *wrong.first()?;
        let of_first = Side::BOTH.into_iter().find(|&side| leans(first, side))?;
        Some(format!(
            "{} of {} balls carry on the wrong shoulder, ball {first} on the {} raceway at a contact angle of {:.1} \
             deg: {MEANING}",
            wrong.len(),
            balls.len(),
            of_first.name(),
            balls[first].contact(of_first).contact_angle_rad.to_degrees(),
        ))
    }
}

/// What a ball on the wrong shoulder means, and what to try.
pub const MEANING: &str = "an angular contact bearing has a low shoulder there or none and comes apart, but this model \
                           carries on; look at the axial force, the preload and the orientation, or give a deep \
                           groove bearing a clearance in place of contact_angle";

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREE: f64 = PI / 180.0;

    /// Wrong: a deep groove bearing would be warned, or an angular contact bearing that carries as made or stands on
    /// the bottom of its groove.
    #[test]
    fn only_angles_against_the_direction_of_an_angular_contact_bearing_are_wrong() {
        let made = |direction| Shoulders {
            direction,
            ends: [None, None],
        };
        for (direction, angle, is_against) in [
            (None, -40.0, false),
            (None, 40.0, false),
            (Some(1.0), 40.0, false),
            (Some(1.0), -1.9, false),
            (Some(1.0), -2.1, true),
            (Some(-1.0), -40.0, false),
            (Some(-1.0), 1.9, false),
            (Some(-1.0), 2.1, true),
        ] {
            let found = made(direction).is_against(angle * DEGREE);
            assert_eq!(found, is_against, "{direction:?} {angle}");
        }
    }

    /// Wrong: an ellipse over the edge of a rigid groove would pass, or one at the other ring would be blamed.
    #[test]
    fn an_ellipse_over_the_end_of_a_rigid_groove_is_beyond_it() {
        let shoulders = Shoulders {
            direction: None,
            ends: [None, Some(-10.0 * DEGREE..=30.0 * DEGREE)],
        };
        let beyond = |side, angle: f64| shoulders.is_beyond(side, angle * DEGREE, 4.0 * DEGREE);
        assert!(beyond(Side::Outer, 27.0) && beyond(Side::Outer, 35.0) && beyond(Side::Outer, -7.0));
        assert!(!beyond(Side::Outer, 20.0) && !beyond(Side::Inner, 35.0));
    }
}
