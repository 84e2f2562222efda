//! Angles modulo a turn.

use std::f64::consts::PI;

/// The angle equal to `angle` modulo a turn that lies within half a turn of `reference`.
#[inline]
pub fn unwrap_near(angle: f64, reference: f64) -> f64 {
    if (angle - reference).abs() < PI {
        return angle;
    }
    angle - 2.0 * PI * ((angle - reference) / (2.0 * PI)).round()
}
