//! `[bearing]`: the macro-geometry of the bearing.
//!
//! Diameters are catalogue values. With ball diameter D_w, raceway (groove-bottom) diameters d_i and D_e and
//! groove radii R_i and R_o:
//!
//! - diametral clearance P_d = D_e - d_i - 2 D_w,
//! - groove distance A = R_i + R_o - D_w,
//! - free contact angle a0 from cos a0 = 1 - P_d / (2 A).
//!
//! Reference: Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, chapter 2.

use std::f64::consts::PI;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ball_diameters::RawBallDiameters;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [bearing]")]
pub struct RawBearing {
    balls: i64,
    ball_diameter: Quantity<LENGTH>,
    inner_raceway_diameter: Quantity<LENGTH>,
    outer_raceway_diameter: Quantity<LENGTH>,
    inner_groove_radius: Quantity<LENGTH>,
    outer_groove_radius: Quantity<LENGTH>,
    bore_diameter: Quantity<LENGTH>,
    outside_diameter: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    first_ball_azimuth: Option<Quantity<ANGLE>>,
    pub(super) ball_diameters: Option<RawBallDiameters>,
}

/// The macro-geometry of the bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing {
    /// Number of balls, at least 3.
    pub balls: usize,
    /// Ball diameter D_w, m.
    pub ball_diameter: f64,
    /// Diameter of the bottom of the inner groove d_i, m.
    pub inner_raceway_diameter: f64,
    /// Diameter of the bottom of the outer groove D_e, m.
    pub outer_raceway_diameter: f64,
    /// Radius of the inner groove's section R_i, m.
    pub inner_groove_radius: f64,
    /// Radius of the outer groove's section R_o, m.
    pub outer_groove_radius: f64,
    /// Bore diameter d, m.
    pub bore_diameter: f64,
    /// Outside diameter D, m.
    pub outside_diameter: f64,
    /// Width B, m.
    pub width: f64,
    /// Azimuth of the first ball, rad, from +x towards +y.
    pub first_ball_azimuth: f64,
}

/// Largest groove radius over ball diameter: catalogue bearings have 0.515 to 0.53.
const MAX_CONFORMITY: f64 = 0.6;
/// Lengths outside this range are slips of the unit, m.
const PLAUSIBLE_LENGTH: std::ops::Range<f64> = 1e-5..100.0;
/// More balls than any bearing has; bounds the memory of the contact problem.
const MAX_BALLS: i64 = 1000;

impl RawBearing {
    /// Checks every value, then, when all are sane, how they fit together; `None` when there are problems, so
    /// that nothing else is compared with a bearing that cannot be.
    pub fn check(&self, problems: &mut Problems) -> Option<Bearing> {
        let before = problems.len();
        let balls = problems.whole(self.balls, "bearing.balls", 3, MAX_BALLS);
        self.check_lengths(problems);
        let bearing = Bearing {
            balls,
            ball_diameter: self.ball_diameter.si(),
            inner_raceway_diameter: self.inner_raceway_diameter.si(),
            outer_raceway_diameter: self.outer_raceway_diameter.si(),
            inner_groove_radius: self.inner_groove_radius.si(),
            outer_groove_radius: self.outer_groove_radius.si(),
            bore_diameter: self.bore_diameter.si(),
            outside_diameter: self.outside_diameter.si(),
            width: self.width.si(),
            first_ball_azimuth: self.first_ball_azimuth.as_ref().map_or(0.0, Quantity::si),
        };
        if problems.len() == before {
            self.check_diameters(problems);
            self.check_grooves(problems);
        }
        if problems.len() == before {
            bearing.check_contact_angle(problems);
            self.check_balls(&bearing, problems);
        }
        (problems.len() == before).then_some(bearing)
    }

    fn check_lengths(&self, problems: &mut Problems) {
        let lengths = [
            (&self.ball_diameter, "bearing.ball_diameter", "a diameter"),
            (
                &self.inner_raceway_diameter,
                "bearing.inner_raceway_diameter",
                "a diameter",
            ),
            (
                &self.outer_raceway_diameter,
                "bearing.outer_raceway_diameter",
                "a diameter",
            ),
            (
                &self.inner_groove_radius,
                "bearing.inner_groove_radius",
                "a radius",
            ),
            (
                &self.outer_groove_radius,
                "bearing.outer_groove_radius",
                "a radius",
            ),
            (&self.bore_diameter, "bearing.bore_diameter", "a diameter"),
            (&self.outside_diameter, "bearing.outside_diameter", "a diameter"),
            (&self.width, "bearing.width", "a width"),
        ];
        for (length, key, noun) in lengths {
            problems.require_positive(length, key, noun);
            let plausible = length.si() <= 0.0 || PLAUSIBLE_LENGTH.contains(&length.si());
            problems.require(plausible, key, length, "check its unit, expected 10 um to 100 m");
        }
    }

    fn check_diameters(&self, problems: &mut Problems) {
        let rising = [
            ("bearing.bore_diameter", &self.bore_diameter),
            ("bearing.inner_raceway_diameter", &self.inner_raceway_diameter),
            ("bearing.outer_raceway_diameter", &self.outer_raceway_diameter),
            ("bearing.outside_diameter", &self.outside_diameter),
        ];
        for pair in rising.windows(2) {
            let ((small_key, small), (large_key, large)) = (pair[0], pair[1]);
            let rule = format!("it must be less than {large_key}, which is {large}");
            problems.require(small.si() < large.si(), small_key, small, rule);
        }
        let rule = format!(
            "it must be at least the ball diameter {}, or the balls stand out of the rings",
            self.ball_diameter
        );
        problems.require(
            self.width.si() >= self.ball_diameter.si(),
            "bearing.width",
            &self.width,
            rule,
        );
    }

    fn check_grooves(&self, problems: &mut Problems) {
        let ball_radius = 0.5 * self.ball_diameter.si();
        let grooves = [
            ("bearing.inner_groove_radius", &self.inner_groove_radius),
            ("bearing.outer_groove_radius", &self.outer_groove_radius),
        ];
        for (key, groove) in grooves {
            let usual = "0.515 to 0.53 of the ball diameter is usual";
            let ball = Quantity::<LENGTH>::about(ball_radius);
            let rule = format!("it must be more than the ball radius {ball}, {usual}");
            problems.require(groove.si() > ball_radius, key, groove, rule);
            let conformity = groove.si() / self.ball_diameter.si();
            let rule =
                format!("that is {conformity:.3} of the ball diameter, more than {MAX_CONFORMITY}; {usual}");
            problems.require(conformity <= MAX_CONFORMITY, key, groove, rule);
        }
    }

    /// The balls must fit side by side on the pitch circle and between the grooves.
    fn check_balls(&self, bearing: &Bearing, problems: &mut Problems) {
        let pitch = 0.5 * (bearing.inner_raceway_diameter + bearing.outer_raceway_diameter);
        let chord = pitch * (PI / bearing.balls as f64).sin();
        if chord < bearing.ball_diameter {
            let fit = (PI / (bearing.ball_diameter / pitch).min(1.0).asin()).floor();
            problems.add(format!(
                "bearing.balls is {}; the balls overlap on the pitch circle of {}, at most {fit} of {} fit",
                bearing.balls,
                Quantity::<LENGTH>::about(pitch),
                self.ball_diameter,
            ));
        }
    }
}

impl Bearing {
    /// Diametral clearance P_d, m.
    pub fn clearance(&self) -> f64 {
        self.outer_raceway_diameter - self.inner_raceway_diameter - 2.0 * self.ball_diameter
    }

    /// Distance of the groove centres when the balls just touch, A, m.
    pub fn groove_distance(&self) -> f64 {
        self.inner_groove_radius + self.outer_groove_radius - self.ball_diameter
    }

    fn check_contact_angle(&self, problems: &mut Problems) {
        let (clearance, distance) = (self.clearance(), self.groove_distance());
        let angle = |rule: &str| {
            format!(
                "bearing has the diametral clearance {:.4} mm (outer_raceway_diameter - inner_raceway_diameter \
                 - 2 ball_diameter) and the groove distance {:.4} mm, so that the cosine of the free contact \
                 angle, 1 - clearance / (2 groove distance), is {:.4}; {rule}",
                1e3 * clearance,
                1e3 * distance,
                1.0 - clearance / (2.0 * distance),
            )
        };
        if clearance < -2.0 * distance {
            problems.add(angle(
                "so large an interference is beyond small strain, check the diameters",
            ));
        } else if clearance >= 2.0 * distance {
            problems.add(angle(
                "the balls would touch at 90 degrees or not at all, check the diameters",
            ));
        }
    }
}
