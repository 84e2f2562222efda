//! `[bearing]`: the macro-geometry of the bearing.
//!
//! Diameters are catalogue values. With ball diameter D_w, raceway (groove-bottom) diameters d_i and D_e and
//! groove radii R_i and R_o:
//!
//! - diametral clearance P_d = D_e - d_i - 2 D_w,
//! - groove distance A = R_i + R_o - D_w,
//! - free contact angle a0 from cos a0 = 1 - P_d / (2 A),
//! - axial clearance P_e = 2 A sin a0, from one stop to the other.
//!
//! One of `outer_raceway_diameter`, `radial_clearance` (P_d), `axial_clearance` and `free_contact_angle` is given;
//! they are those of the unmounted bearing.
//!
//! Reference: Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, chapter 2.

use std::f64::consts::PI;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [bearing]")]
pub struct RawBearing {
    balls: i64,
    ball_diameter: Quantity<LENGTH>,
    inner_raceway_diameter: Quantity<LENGTH>,
    outer_raceway_diameter: Option<Quantity<LENGTH>>,
    radial_clearance: Option<Quantity<LENGTH>>,
    axial_clearance: Option<Quantity<LENGTH>>,
    free_contact_angle: Option<Quantity<ANGLE>>,
    inner_groove_radius: Quantity<LENGTH>,
    outer_groove_radius: Quantity<LENGTH>,
    bore_diameter: Quantity<LENGTH>,
    outside_diameter: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    first_ball_azimuth: Option<Quantity<ANGLE>>,
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
        let outer_raceway = self.outer_raceway(problems)?;
        self.check_lengths(&outer_raceway, problems);
        let bearing = Bearing {
            balls,
            ball_diameter: self.ball_diameter.si(),
            inner_raceway_diameter: self.inner_raceway_diameter.si(),
            outer_raceway_diameter: outer_raceway.si(),
            inner_groove_radius: self.inner_groove_radius.si(),
            outer_groove_radius: self.outer_groove_radius.si(),
            bore_diameter: self.bore_diameter.si(),
            outside_diameter: self.outside_diameter.si(),
            width: self.width.si(),
            first_ball_azimuth: self.first_ball_azimuth.as_ref().map_or(0.0, Quantity::si),
        };
        if problems.len() == before {
            self.check_diameters(&outer_raceway, problems);
            self.check_grooves(problems);
        }
        if problems.len() == before {
            bearing.check_contact_angle(problems);
            self.check_balls(&bearing, problems);
        }
        (problems.len() == before).then_some(bearing)
    }

    /// Diameter of the outer groove's bottom, given or from the clearance; None where it is not said, or twice.
    fn outer_raceway(&self, problems: &mut Problems) -> Option<Quantity<LENGTH>> {
        let given = [
            ("outer_raceway_diameter", self.outer_raceway_diameter.is_some()),
            ("radial_clearance", self.radial_clearance.is_some()),
            ("axial_clearance", self.axial_clearance.is_some()),
            ("free_contact_angle", self.free_contact_angle.is_some()),
        ];
        let given: Vec<&str> = given.iter().filter(|(_, is)| *is).map(|(key, _)| *key).collect();
        match given[..] {
            [_] => {}
            [] => {
                problems.add(
                    "[bearing] has no outer_raceway_diameter; add it, or what it follows from: radial_clearance, \
                     axial_clearance or free_contact_angle of the unmounted bearing",
                );
                return None;
            }
            [first, second, ..] => {
                problems.add(format!(
                    "bearing.{first} and bearing.{second} both say how much clearance there is; keep one of them"
                ));
                return None;
            }
        }
        if let Some(diameter) = &self.outer_raceway_diameter {
            return Some(diameter.clone());
        }
        let twice =
            2.0 * (self.inner_groove_radius.si() + self.outer_groove_radius.si() - self.ball_diameter.si());
        let clearance = self.clearance(twice, problems)?;
        let inner = self.inner_raceway_diameter.si() + 2.0 * self.ball_diameter.si();
        Some(Quantity::from_si(inner + clearance))
    }

    /// Radial clearance, m, as it is given; `twice` is twice the groove distance.
    fn clearance(&self, twice: f64, problems: &mut Problems) -> Option<f64> {
        if let Some(radial) = &self.radial_clearance {
            return Some(radial.si());
        }
        if let Some(axial) = &self.axial_clearance {
            let share = axial.si() / twice;
            let holds = (0.0..1.0).contains(&share);
            let most = Quantity::<LENGTH>::about(twice);
            let rule = format!(
                "expected 0 mm to less than 2 (inner_groove_radius + outer_groove_radius - ball_diameter), {most}"
            );
            problems.require(holds, "bearing.axial_clearance", axial, rule);
            return holds.then(|| twice * (1.0 - (1.0 - share * share).sqrt()));
        }
        let angle = self.free_contact_angle.as_ref()?;
        let holds = (0.0..0.5 * PI).contains(&angle.si());
        let rule = "expected 0 deg to below 90 deg";
        problems.require(holds, "bearing.free_contact_angle", angle, rule);
        holds.then(|| twice * (1.0 - angle.si().cos()))
    }

    fn check_lengths(&self, outer_raceway: &Quantity<LENGTH>, problems: &mut Problems) {
        let lengths = [
            (&self.ball_diameter, "bearing.ball_diameter", "a diameter"),
            (
                &self.inner_raceway_diameter,
                "bearing.inner_raceway_diameter",
                "a diameter",
            ),
            (outer_raceway, "bearing.outer_raceway_diameter", "a diameter"),
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

    fn check_diameters(&self, outer_raceway: &Quantity<LENGTH>, problems: &mut Problems) {
        let rising = [
            ("bearing.bore_diameter", &self.bore_diameter),
            ("bearing.inner_raceway_diameter", &self.inner_raceway_diameter),
            ("bearing.outer_raceway_diameter", outer_raceway),
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
