//! Kinematics of cage, balls and inner ring.
//!
//! The inner ring turns by the prescribed theta_i(t). Pure rolling gives the cage (Harris, 4th ed., eq. 8.24; the
//! paper's eq. 10): omega_c = omega_i / 2 (1 - (D_w / D_m) cos a0), with slip ratios the share of the inner and outer
//! rolling motion that is lost.

use contact::{BearingGeometry, Side};
use input::schedule::piecewise_linear;
use serde::Deserialize;

use crate::effects::Now;
use crate::model::Model;
use crate::pose::Pose;

/// Inner ring speed as a piecewise linear function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Speed {
    /// Times, s, growing; constant speed before the first and after the last.
    times: Vec<f64>,
    /// Speeds, rad/s.
    speeds: Vec<f64>,
}

impl Speed {
    /// Constant speed, rad/s.
    pub fn constant(speed: f64) -> Speed {
        Speed {
            times: vec![0.0],
            speeds: vec![speed],
        }
    }

    /// Linear between the given times (s, growing) and speeds (rad/s).
    pub fn table(times: Vec<f64>, speeds: Vec<f64>) -> Speed {
        assert!(
            !times.is_empty() && times.len() == speeds.len(),
            "a speed table has as many speeds as times"
        );
        Speed { times, speeds }
    }

    /// Whether it is 0 at all times.
    pub fn is_zero(&self) -> bool {
        self.speeds.iter().all(|speed| *speed == 0.0)
    }

    /// Speed, rad/s.
    pub fn at(&self, t: f64) -> f64 {
        piecewise_linear(&self.times, &self.speeds, t)[0]
    }

    /// Angular acceleration, rad/s^2.
    pub fn rate(&self, t: f64) -> f64 {
        piecewise_linear(&self.times, &self.speeds, t)[1]
    }

    /// Angle turned since t = 0, rad: the exact integral.
    pub fn angle(&self, t: f64) -> f64 {
        let (mut angle, mut from) = (0.0, 0.0);
        for &corner in self.times.iter().filter(|x| **x > 0.0 && **x < t) {
            angle += 0.5 * (self.at(from) + self.at(corner)) * (corner - from);
            from = corner;
        }
        // A corner belongs to the segment that begins there, so the last speed is taken from inside the segment.
        angle + 0.5 * (self.at(from) + self.at(t)) * (t - from)
    }
}

/// Share of the rolling motion that is lost at the inner and at the outer raceway, 0 to below 1; 0 is pure rolling.
pub type SlipRatios = [f64; 2];

/// Turning of cage and balls per turn of the inner ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// Cage speed over inner ring speed.
    pub cage: f64,
    /// Ball spin about its own axis over inner ring speed.
    pub ball: f64,
}

impl Kinematics {
    /// Rolling with slip ratios at the inner and outer raceway, both in 0..1; 0 is pure rolling.
    pub fn new(geometry: &BearingGeometry, [inner_slip, outer_slip]: [f64; 2]) -> Kinematics {
        let ratio = geometry.ball_diameter / geometry.pitch_diameter();
        let gamma = ratio * geometry.free_contact_angle().cos();
        // Rolling: the raceway speeds relative to the cage drive the ball's surface with what slip leaves of them.
        let (inner, outer) = (
            (1.0 - inner_slip) * (1.0 - gamma),
            (1.0 - outer_slip) * (1.0 + gamma),
        );
        let cage = inner / (inner + outer);
        Kinematics {
            cage,
            ball: (1.0 - cage) * inner / ratio,
        }
    }

    /// Rolling at the contact angles `[inner, outer]`, rad, about an axis pitched by beta (`pitch_angle`): the
    /// surface of the ball has cos(a - beta) of its largest speed at a contact (Harris, 4th ed., chapter 8; Jones
    /// 1959). Without slip omega_c = omega_i (1 - D_w / D_m cos a_i) / (1 + cos(a_i - a_o)).
    pub fn outer_control(geometry: &BearingGeometry, slip: [f64; 2], angles: [f64; 2]) -> Kinematics {
        let ratio = geometry.ball_diameter / geometry.pitch_diameter();
        let pitch = pitch_angle(geometry, angles[1]);
        let rolling = |side: Side| {
            let angle = angles[side.index()];
            let radius = 1.0 + side.sign() * ratio * angle.cos();
            (1.0 - slip[side.index()]) * radius / (angle - pitch).cos()
        };
        let (inner, outer) = (rolling(Side::Inner), rolling(Side::Outer));
        let cage = inner / (inner + outer);
        Kinematics {
            cage,
            ball: (1.0 - cage) * inner / ratio,
        }
    }
}

/// Pitch angle beta of a ball's axis under outer raceway control, rad: without pivoting on the outer raceway
/// tan beta = sin a_o / (cos a_o + D_w / D_m) (Harris, 4th ed., chapter 8).
pub fn pitch_angle(geometry: &BearingGeometry, outer_angle: f64) -> f64 {
    let (sin, cos) = outer_angle.sin_cos();
    sin.atan2(cos + geometry.ball_diameter / geometry.pitch_diameter())
}

/// Contact angles that the speeds of a ball follow, for its centrifugal force and gyroscopic moment.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BallSpeeds {
    /// Those of the kinematic cage: the free contact angle.
    #[default]
    FreeAngle,
    /// Outer raceway control: the contact angles that each ball has.
    OuterControl,
}

impl BallSpeeds {
    /// Turning of one ball at an instant, with slip ratios at the inner and outer raceway.
    pub fn of_ball(self, model: &Model, now: &Now, slip: [f64; 2], ball: usize) -> Kinematics {
        match self {
            BallSpeeds::FreeAngle => Kinematics::new(&model.geometry, slip),
            BallSpeeds::OuterControl => {
                let angles = Side::BOTH.map(|side| now.contact_angle(model, ball, side));
                Kinematics::outer_control(&model.geometry, slip, angles)
            }
        }
    }
}

/// Turning of all parts over time: a speed of the inner ring and the rolling it drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Rolling {
    /// Speed of the inner ring.
    pub speed: Speed,
    /// What follows from it.
    pub kinematics: Kinematics,
}

impl Rolling {
    /// Rolling in a bearing with slip ratios at the inner and outer raceway.
    pub fn new(geometry: &BearingGeometry, speed: Speed, slip: [f64; 2]) -> Rolling {
        Rolling {
            speed,
            kinematics: Kinematics::new(geometry, slip),
        }
    }

    /// Where the parts stand at a time, s.
    pub fn pose(&self, time: f64) -> Pose {
        let inner_angle = self.speed.angle(time);
        Pose {
            now: Now {
                time,
                width: 0.0,
                cage_angle: self.kinematics.cage * inner_angle,
                angles: None,
            },
            inner_angle,
        }
    }

    /// Speed of a ball's rotation about its own axis relative to the cage at a time, rad/s (Harris, 4th ed., eq.
    /// 8.25). It turns against the inner ring, and + goes with a positive speed of that ring.
    pub fn spin(&self, time: f64) -> f64 {
        self.kinematics.ball * self.speed.at(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: ball-passing frequencies. 7010C at 1800 rpm: 18 balls pass the outer ring at 234 Hz, the inner at 306 Hz.
    #[test]
    fn ball_passing_frequencies_of_the_7010c() {
        let kinematics = Kinematics::new(&BearingGeometry::reference_7010c(), [0.0; 2]);
        let shaft = 1800.0 / 60.0;
        let (outer, inner) = (
            18.0 * shaft * kinematics.cage,
            18.0 * shaft * (1.0 - kinematics.cage),
        );
        assert!((outer - 234.0).abs() < 1.0, "{outer}");
        assert!((inner - 306.0).abs() < 1.0, "{inner}");
        assert!((outer + inner - 540.0).abs() < 1e-9);
    }

    /// Wrong: the spin of balls. Pure rolling: the ball's surface moves with both raceways, seen from the cage, and
    /// Harris' n_R = n_i D_m / (2 D_w) (1 - gamma^2).
    #[test]
    fn rolling_balls_spin_as_both_raceways_drive_them() {
        let geometry = BearingGeometry::reference_7010c();
        let rolling = Rolling::new(&geometry, Speed::constant(100.0), [0.0; 2]);
        let (ratio, angle) = (
            geometry.ball_diameter / geometry.pitch_diameter(),
            geometry.free_contact_angle(),
        );
        let gamma = ratio * angle.cos();
        let harris = 100.0 / (2.0 * ratio) * (1.0 - gamma * gamma);
        assert!(
            (rolling.spin(3.0) / harris - 1.0).abs() < 1e-14,
            "{}",
            rolling.spin(3.0)
        );
        let surface = rolling.spin(0.0) * ratio;
        let cage = rolling.kinematics.cage * 100.0;
        assert!((surface - (100.0 - cage) * (1.0 - gamma)).abs() < 1e-12 * surface);
        assert!((surface - cage * (1.0 + gamma)).abs() < 1e-12 * surface);
    }

    /// Wrong: the angle would not be the integral of the speed, so contacts would slip against the kinematics.
    #[test]
    fn the_angle_is_the_integral_of_the_speed() {
        let speed = Speed::table(vec![0.0, 1.0, 3.0], vec![10.0, 20.0, 0.0]);
        for (t, angle) in [(0.5, 6.25), (1.0, 15.0), (2.0, 30.0), (3.0, 35.0), (4.0, 35.0)] {
            assert!((speed.angle(t) - angle).abs() < 1e-12, "{t}: {}", speed.angle(t));
        }
        assert_eq!(speed.rate(0.5), 10.0);
        assert_eq!(speed.rate(2.0), -10.0);
    }
}
