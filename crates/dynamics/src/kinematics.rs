//! Kinematics of rings, cage and balls.
//!
//! The rings turn by the prescribed theta_i(t) and theta_o(t). Pure rolling gives the cage (Harris, 4th ed., eq.
//! 8.24; the paper's eq. 10):
//!
//! ```text
//! omega_c = omega_i / 2 (1 - (D_w / D_m) cos a0) + omega_o / 2 (1 + (D_w / D_m) cos a0)
//! ```
//!
//! Slip ratios are the share of the inner and outer rolling motion that is lost. Rings of equal speed carry cage and
//! balls round with them, and nothing rolls.

use contact::{BearingGeometry, BySide, Side};
use input::schedule::piecewise_linear;
use serde::Deserialize;

use crate::effects::loads::Now;
use crate::pose::Pose;

/// Speed of a ring as a piecewise linear function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Speed {
    /// Times, s, growing, `[n]`, n at least 1; constant speed before the first and after the last.
    pub times: Vec<f64>,
    /// Speeds, rad/s, `[n]`.
    pub values: Vec<f64>,
}

impl Speed {
    /// Constant speed, rad/s.
    pub fn constant(speed: f64) -> Speed {
        Speed {
            times: vec![0.0],
            values: vec![speed],
        }
    }

    /// Linear between the given times (s, growing) and speeds (rad/s).
    pub fn table(times: Vec<f64>, values: Vec<f64>) -> Speed {
        assert!(
            !times.is_empty() && times.len() == values.len(),
            "a speed table has as many speeds as times"
        );
        Speed { times, values }
    }

    /// Whether it is 0 at all times.
    pub fn is_zero(&self) -> bool {
        self.values.iter().all(|speed| *speed == 0.0)
    }

    /// Speed, rad/s.
    pub fn at(&self, t: f64) -> f64 {
        piecewise_linear(&self.times, &self.values, t)[0]
    }

    /// Angular acceleration, rad/s^2.
    pub fn rate(&self, t: f64) -> f64 {
        piecewise_linear(&self.times, &self.values, t)[1]
    }

    /// Largest magnitude at any time, rad/s.
    pub fn largest(&self) -> f64 {
        self.values
            .iter()
            .fold(0.0, |largest, speed| speed.abs().max(largest))
    }

    /// Largest magnitude of the angular acceleration at any time, rad/s^2.
    pub fn largest_rate(&self) -> f64 {
        let slopes = self.times.windows(2).zip(self.values.windows(2));
        let slopes = slopes.map(|(times, speeds)| (speeds[1] - speeds[0]) / (times[1] - times[0]));
        slopes.fold(0.0, |largest, slope| slope.abs().max(largest))
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

/// Speeds of both rings.
#[derive(Clone, Debug, PartialEq)]
pub struct RingSpeeds {
    /// Of the inner ring.
    pub inner: Speed,
    /// Of the outer ring.
    pub outer: Speed,
}

/// The inner ring turns, the outer one stands.
impl From<Speed> for RingSpeeds {
    fn from(inner: Speed) -> RingSpeeds {
        let outer = Speed::constant(0.0);
        RingSpeeds { inner, outer }
    }
}

/// Both rings stand.
impl Default for RingSpeeds {
    fn default() -> RingSpeeds {
        Speed::constant(0.0).into()
    }
}

impl RingSpeeds {
    /// Of one ring.
    pub fn of(&self, side: Side) -> &Speed {
        side.choose(&self.inner, &self.outer)
    }

    /// Whether both rings stand at all times.
    pub fn is_zero(&self) -> bool {
        self.inner.is_zero() && self.outer.is_zero()
    }

    /// Whether a ring changes its speed.
    pub fn changes(&self) -> bool {
        Side::BOTH.iter().any(|side| self.of(*side).values.len() > 1)
    }

    /// Speed of the inner ring seen from the outer one, rad/s.
    pub fn relative(&self, t: f64) -> f64 {
        self.inner.at(t) - self.outer.at(t)
    }

    /// The speeds `[inner, outer]`, rad/s, at the time at which a size of them is largest. Speeds are linear between
    /// their times, so that sums and differences of them are largest at one of these.
    pub fn at_largest(&self, size: impl Fn(BothRings) -> f64) -> BothRings {
        let times = self.inner.times.iter().chain(&self.outer.times);
        let speeds = times.map(|t| Side::BOTH.map(|side| self.of(side).at(*t)));
        let largest = speeds.reduce(|a, b| if size(b) > size(a) { b } else { a });
        largest.unwrap_or_default()
    }
}

/// A number of each ring, the inner one first.
pub type BothRings = BySide<f64>;

/// Share of the rolling motion that is lost at the inner and at the outer raceway, 0 to below 1; 0 is pure rolling.
pub type SlipRatios = BothRings;

/// Turning of cage and balls per turn of the inner ring, seen from the outer ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// Cage speed over inner ring speed.
    pub cage: f64,
    /// Ball spin about its own axis over inner ring speed.
    pub ball: f64,
}

impl Kinematics {
    /// Rolling with slip ratios at the inner and outer raceway, both in 0..1; 0 is pure rolling.
    pub fn new(geometry: &BearingGeometry, [inner_slip, outer_slip]: SlipRatios) -> Kinematics {
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

    /// What the cage has of both rings: of their speeds its own, of their angles the angle it has turned.
    pub fn of_cage(&self, [inner, outer]: BothRings) -> f64 {
        self.cage * inner + (1.0 - self.cage) * outer
    }

    /// Speed of the cage at a time, rad/s.
    pub fn cage_speed(&self, speeds: &RingSpeeds, time: f64) -> f64 {
        self.of_cage(Side::BOTH.map(|side| speeds.of(side).at(time)))
    }

    /// Angle the cage has turned since t = 0, rad.
    pub fn cage_angle(&self, speeds: &RingSpeeds, time: f64) -> f64 {
        self.of_cage(Side::BOTH.map(|side| speeds.of(side).angle(time)))
    }

    /// Speed of a ball's rotation about its own axis relative to the cage at a time, rad/s (Harris, 4th ed., eq.
    /// 8.25). It turns against the inner ring, and + goes with that ring's positive speed relative to the outer one.
    pub fn spin(&self, speeds: &RingSpeeds, time: f64) -> f64 {
        self.ball * speeds.relative(time)
    }

    /// Angle by which a ball has rolled about its own axis when the rings `[inner, outer]` have turned by these, rad:
    /// the integral of [`Kinematics::spin`].
    pub fn rolled(&self, [inner, outer]: BothRings) -> f64 {
        self.ball * (inner - outer)
    }

    /// Rolling at the contact angles `[inner, outer]`, rad, about an axis pitched by beta (`pitch_angle`): the
    /// surface of the ball has cos(a - beta) of its largest speed at a contact (Harris, 4th ed., chapter 8; Jones
    /// 1959). Without slip omega_c = omega_i (1 - D_w / D_m cos a_i) / (1 + cos(a_i - a_o)).
    pub fn outer_control(geometry: &BearingGeometry, slip: SlipRatios, angles: BothRings) -> Kinematics {
        let ratio = geometry.ball_diameter / geometry.pitch_diameter();
        let pitch = pitch_angle(geometry, angles[1]);
        let rolling = |side: Side| {
            let angle = angles[side.index()];
            let radius = 1.0 + side.sign() * ratio * angle.cos();
            (1.0 - slip[side.index()]) * radius / (angle - pitch).cos()
        };
        let [inner, outer] = Side::BOTH.map(rolling);
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
    pub fn of_ball(self, geometry: &BearingGeometry, now: &Now, slip: SlipRatios, ball: usize) -> Kinematics {
        match self {
            BallSpeeds::FreeAngle => Kinematics::new(geometry, slip),
            BallSpeeds::OuterControl => {
                let angles = Side::BOTH.map(|side| now.contact_angle(geometry, ball, side));
                Kinematics::outer_control(geometry, slip, angles)
            }
        }
    }
}

/// Turning of all parts over time: speeds of the rings and the rolling they drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Rolling {
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
    /// What follows from them.
    pub kinematics: Kinematics,
}

impl Rolling {
    /// Rolling in a bearing with slip ratios at the inner and outer raceway.
    pub fn new(geometry: &BearingGeometry, speeds: impl Into<RingSpeeds>, slip: SlipRatios) -> Rolling {
        Rolling {
            speeds: speeds.into(),
            kinematics: Kinematics::new(geometry, slip),
        }
    }

    /// Where the parts stand at a time, s.
    pub fn pose(&self, time: f64) -> Pose {
        let ring_angles = Side::BOTH.map(|side| self.speeds.of(side).angle(time));
        Pose {
            now: Now {
                time,
                width: 0.0,
                cage_angle: self.kinematics.cage_angle(&self.speeds, time),
                angles: None,
                seen: None,
            },
            rolled: self.kinematics.rolled(ring_angles),
            ring_angles,
        }
    }

    /// Speed of the cage at a time, rad/s.
    pub fn cage_speed(&self, time: f64) -> f64 {
        self.kinematics.cage_speed(&self.speeds, time)
    }

    /// Speed of a ball's rotation about its own axis relative to the cage at a time, rad/s.
    pub fn spin(&self, time: f64) -> f64 {
        self.kinematics.spin(&self.speeds, time)
    }
}

/// d/dpsi over the balls of a bearing on one course, row-major, by whether something touches each: that of the
/// trigonometric polynomial through them, 0 of a ball that nothing touches (Trefethen, Spectral Methods in MATLAB,
/// 2000, ch. 3).
pub fn course_slopes(touched: &[bool]) -> Vec<f64> {
    let balls = touched.len();
    let entry = |k: usize| {
        let (i, j) = (k / balls, k % balls);
        if i == j || !touched[i] || !touched[j] {
            return 0.0;
        }
        let sign = if (i + j).is_multiple_of(2) { 0.5 } else { -0.5 };
        let half = 0.5 * std::f64::consts::TAU * (i as f64 - j as f64) / balls as f64;
        match balls.is_multiple_of(2) {
            true => sign / half.tan(),
            false => sign / half.sin(),
        }
    };
    (0..balls * balls).map(entry).collect()
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

    /// Wrong: what an outer ring does to cage and balls. Both rings superpose; the frequencies of a point of each ring
    /// change places when the other ring turns; rings of equal speed carry all with them.
    #[test]
    fn both_rings_drive_the_cage() {
        let turning = Kinematics::new(&BearingGeometry::reference_7010c(), [0.0; 2]);
        let passing = |speeds: [f64; 2]| {
            let cage = turning.of_cage(speeds);
            [(speeds[0] - cage).abs(), (cage - speeds[1]).abs()]
        };
        let ([inner, outer], [mirrored, seen]) = (passing([30.0, 0.0]), passing([0.0, 30.0]));
        assert!((inner - mirrored).abs() < 1e-13 && (outer - seen).abs() < 1e-13);
        assert!((turning.of_cage([0.0, 30.0]) - 30.0 * (1.0 - turning.cage)).abs() < 1e-13);
        assert!((turning.of_cage([30.0, 30.0]) - 30.0).abs() < 1e-13);
        let speeds = RingSpeeds {
            inner: Speed::table(vec![0.0, 1.0], vec![0.0, 30.0]),
            outer: Speed::table(vec![0.5, 2.0], vec![-40.0, 10.0]),
        };
        assert_eq!(
            speeds.at_largest(|[inner, outer]| (inner - outer).abs()),
            [15.0, -40.0]
        );
        assert_eq!(speeds.at_largest(|[inner, _]| inner.abs())[0], 30.0);
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

    /// Wrong: lines would be looked for at other frequencies than those of the textbooks. The 7010C at 1800 rpm with
    /// the free contact angle 19.57 deg, which a larger clearance on the same pitch circle gives: f_c = f/2 (1 -
    /// gamma), BPFO = 18 f_c, BPFI = 18 (f - f_c), BSF = D_m/(2 D) f (1 - gamma^2), gamma = D cos(a)/D_m (Harris, 4th
    /// ed., chapter 8). Numbers to their last digit, those of the balls' passing from the cage's.
    #[test]
    fn frequencies_at_a_contact_angle_are_those_of_textbooks() {
        let mut geometry = BearingGeometry::reference_7010c();
        let angle = 19.57f64.to_radians();
        let wider = 2.0 * geometry.groove_distance() * (1.0 - angle.cos());
        let clearance =
            geometry.outer_raceway_diameter - geometry.inner_raceway_diameter - 2.0 * geometry.ball_diameter;
        let more = 0.5 * (wider - clearance);
        geometry.outer_raceway_diameter += more;
        geometry.inner_raceway_diameter -= more;
        assert!((geometry.free_contact_angle() - angle).abs() < 1e-12);
        let kinematics = Kinematics::new(&geometry, [0.0; 2]);
        let cage = 30.0 * kinematics.cage;
        let spin = kinematics.rolled([30.0, 0.0]).abs();
        for (found, expected, digit) in [
            (cage, 13.044, 1e-3),
            (18.0 * cage, 234.79, 1e-2),
            (18.0 * (30.0 - cage), 305.21, 1e-2),
            // The balls' circle is 7 um smaller on these grooves.
            (spin, 106.53, 2e-2),
        ] {
            assert!((found - expected).abs() < 0.6 * digit, "{found} {expected}");
        }
    }
}
