//! `[bearing]`: the macro-geometry of the bearing.
//!
//! The raceways are given by their diameters and groove radii, or as a catalogue gives them ([`super::dimensions`]):
//!
//! ```toml
#![doc = include_str!("example_catalogue.toml")]
//! ```
//!
//! With ball diameter D_w, raceway (groove-bottom) diameters d_i and D_e and
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
use super::dimensions::{DEFAULT_INNER_RATIO, DEFAULT_OUTER_RATIO, Diameters, Grooves, RacewayKeys};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [bearing]")]
pub struct RawBearing {
    balls: i64,
    ball_diameter: Quantity<LENGTH>,
    inner_raceway_diameter: Option<Quantity<LENGTH>>,
    outer_raceway_diameter: Option<Quantity<LENGTH>>,
    pitch_diameter: Option<Quantity<LENGTH>>,
    #[serde(alias = "free_contact_angle")]
    contact_angle: Option<Quantity<ANGLE>>,
    radial_clearance: Option<Quantity<LENGTH>>,
    axial_clearance: Option<Quantity<LENGTH>>,
    inner_groove_radius: Option<Quantity<LENGTH>>,
    outer_groove_radius: Option<Quantity<LENGTH>>,
    inner_curvature_ratio: Option<f64>,
    outer_curvature_ratio: Option<f64>,
    #[serde(alias = "bore")]
    bore_diameter: Quantity<LENGTH>,
    #[serde(alias = "outside")]
    outside_diameter: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    first_ball_azimuth: Option<Quantity<ANGLE>>,
    ball_inner_diameter: Option<Quantity<LENGTH>>,
    pub(super) ball_diameters: Option<RawBallDiameters>,
}

/// A length of the bearing, typed or computed.
struct Length {
    /// For messages, with what it was computed from.
    key: String,
    value: Quantity<LENGTH>,
}

/// The raceways: diameters and groove radii, inner first.
struct RacewayLengths {
    diameters: [Length; 2],
    groove_radii: [Length; 2],
}

/// The macro-geometry of the bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing {
    /// Number of balls, at least 3.
    pub balls: usize,
    /// Ball diameter D_w, m.
    pub ball_diameter: f64,
    /// Diameter of the cavity of a hollow ball, m; 0: it is solid.
    pub ball_inner_diameter: f64,
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
    /// Whether it has a contact angle in its scene, as angular contact bearings do: they carry in one direction.
    pub has_contact_angle: bool,
}

/// Largest groove radius over ball diameter: catalogue bearings have 0.515 to 0.53.
const MAX_CONFORMITY: f64 = 0.6;
/// Lengths outside this range are slips of the unit, m.
const PLAUSIBLE_LENGTH: std::ops::Range<f64> = 1e-5..100.0;
/// More balls than any bearing has; bounds the memory of the contact problem.
const MAX_BALLS: i64 = 1000;

impl RawBearing {
    /// Checks every value, then, when all are sane, how they fit together; `None` when there are problems, so
    /// that nothing else is compared with a bearing that cannot be. `assumed` is told what the scene leaves open.
    pub fn check(&self, problems: &mut Problems, assumed: &mut Vec<String>) -> Option<Bearing> {
        let before = problems.len();
        let balls = problems.whole(self.balls, "bearing.balls", 3, MAX_BALLS);
        self.check_lengths(problems);
        let raceways = self.raceways(problems.len() == before, problems, assumed)?;
        let [inner_raceway_diameter, outer_raceway_diameter] =
            [0, 1].map(|side| raceways.diameters[side].value.si());
        let [inner_groove_radius, outer_groove_radius] =
            [0, 1].map(|side| raceways.groove_radii[side].value.si());
        let bearing = Bearing {
            balls,
            ball_diameter: self.ball_diameter.si(),
            ball_inner_diameter: self.ball_inner_diameter.as_ref().map_or(0.0, Quantity::si),
            inner_raceway_diameter,
            outer_raceway_diameter,
            inner_groove_radius,
            outer_groove_radius,
            bore_diameter: self.bore_diameter.si(),
            outside_diameter: self.outside_diameter.si(),
            width: self.width.si(),
            first_ball_azimuth: self.first_ball_azimuth.as_ref().map_or(0.0, Quantity::si),
            has_contact_angle: self.contact_angle.as_ref().is_some_and(|angle| angle.si() > 0.0),
        };
        if problems.len() == before {
            self.check_diameters(&raceways, problems);
            self.check_grooves(&raceways, problems);
        }
        if problems.len() == before {
            bearing.check_contact_angle(problems);
            self.check_balls(&bearing, problems);
        }
        (problems.len() == before).then_some(bearing)
    }

    /// The raceways; `None` where they do not follow from the scene. They are searched where lengths are sane.
    fn raceways(
        &self,
        is_sane: bool,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> Option<RacewayLengths> {
        let groove_radii = self.groove_radii(problems, assumed)?;
        let given = RacewayKeys {
            inner: self.inner_raceway_diameter.as_ref(),
            outer: self.outer_raceway_diameter.as_ref(),
            pitch: self.pitch_diameter.as_ref(),
            angle: self.contact_angle.as_ref(),
            radial: self.radial_clearance.as_ref(),
            axial: self.axial_clearance.as_ref(),
        };
        let grooves = Grooves {
            ball: self.ball_diameter.si(),
            inner: groove_radii[0].value.si(),
            outer: groove_radii[1].value.si(),
        };
        let has_both = given.inner.is_some() && given.outer.is_some();
        let has_distance = 2.0 * grooves.inner.min(grooves.outer) > grooves.ball;
        if !has_both && !has_distance {
            // Without room between ball and grooves no clearance says anything.
            self.check_groove(&groove_radii[0], problems);
            self.check_groove(&groove_radii[1], problems);
        }
        if !is_sane || !has_distance {
            return self.typed_raceways(groove_radii);
        }
        let found = given.resolve(&grooves, problems)?;
        let length = |key: &str, typed: &Option<Quantity<LENGTH>>, value: f64| Length {
            key: match &found.computed_from {
                Some(keys) if typed.is_none() => format!("bearing.{key} (from {keys})"),
                _ => format!("bearing.{key}"),
            },
            value: typed.clone().unwrap_or_else(|| Quantity::about(value)),
        };
        let Diameters { inner, outer } = found.diameters;
        if let Some(keys) = &found.computed_from {
            let radial = outer - inner - 2.0 * grooves.ball;
            assumed.push(format!(
                "bearing: {keys} place the raceways at {:.4} mm and {:.4} mm; radial clearance {:.1} um, free contact \
                 angle {:.3} deg",
                1e3 * inner,
                1e3 * outer,
                1e6 * radial,
                (1.0 - radial.max(0.0) / (2.0 * grooves.distance())).acos().to_degrees(),
            ));
        }
        Some(RacewayLengths {
            diameters: [
                length("inner_raceway_diameter", &self.inner_raceway_diameter, inner),
                length("outer_raceway_diameter", &self.outer_raceway_diameter, outer),
            ],
            groove_radii,
        })
    }

    /// The raceways as typed, where both diameters are, to be checked further.
    fn typed_raceways(&self, groove_radii: [Length; 2]) -> Option<RacewayLengths> {
        let length = |key: &str, typed: &Option<Quantity<LENGTH>>| {
            Some(Length {
                key: format!("bearing.{key}"),
                value: typed.clone()?,
            })
        };
        Some(RacewayLengths {
            diameters: [
                length("inner_raceway_diameter", &self.inner_raceway_diameter)?,
                length("outer_raceway_diameter", &self.outer_raceway_diameter)?,
            ],
            groove_radii,
        })
    }

    /// Groove radii: typed, by their ratio to the ball diameter, or by the usual ratio.
    fn groove_radii(&self, problems: &mut Problems, assumed: &mut Vec<String>) -> Option<[Length; 2]> {
        let typed = [&self.inner_groove_radius, &self.outer_groove_radius];
        let ratios = [self.inner_curvature_ratio, self.outer_curvature_ratio];
        let mut radii = Vec::new();
        for (side, name) in ["inner", "outer"].into_iter().enumerate() {
            let [radius_key, ratio_key] =
                ["groove_radius", "curvature_ratio"].map(|key| format!("bearing.{name}_{key}"));
            radii.push(match (typed[side], ratios[side]) {
                (Some(_), Some(_)) => {
                    problems.add(format!(
                        "{radius_key} and {ratio_key} are the same length twice; leave one out"
                    ));
                    return None;
                }
                (Some(radius), None) => Length {
                    key: radius_key,
                    value: radius.clone(),
                },
                (None, given) => {
                    let ratio = given.unwrap_or([DEFAULT_INNER_RATIO, DEFAULT_OUTER_RATIO][side]);
                    let rule = format!("expected more than 0.5 and at most {MAX_CONFORMITY}; 0.515 to 0.53 is usual");
                    problems.require(ratio > 0.5 && ratio <= MAX_CONFORMITY, &ratio_key, ratio, rule);
                    let value = Quantity::from_si(ratio * self.ball_diameter.si());
                    if given.is_none() {
                        assumed.push(format!(
                            "{radius_key} is {ratio} of the ball diameter, {:.4} mm, as in the ratings of ISO 281; \
                             {ratio_key} changes it",
                            1e3 * value.si()
                        ));
                    }
                    Length {
                        key: format!("{radius_key} (from {name}_curvature_ratio)"),
                        value,
                    }
                }
            });
        }
        radii.try_into().ok()
    }

    fn check_lengths(&self, problems: &mut Problems) {
        let typed = [
            (Some(&self.ball_diameter), "bearing.ball_diameter", "a diameter"),
            (
                self.inner_raceway_diameter.as_ref(),
                "bearing.inner_raceway_diameter",
                "a diameter",
            ),
            (
                self.outer_raceway_diameter.as_ref(),
                "bearing.outer_raceway_diameter",
                "a diameter",
            ),
            (
                self.pitch_diameter.as_ref(),
                "bearing.pitch_diameter",
                "a diameter",
            ),
            (
                self.inner_groove_radius.as_ref(),
                "bearing.inner_groove_radius",
                "a radius",
            ),
            (
                self.outer_groove_radius.as_ref(),
                "bearing.outer_groove_radius",
                "a radius",
            ),
            (
                self.ball_inner_diameter.as_ref(),
                "bearing.ball_inner_diameter",
                "a diameter",
            ),
            (Some(&self.bore_diameter), "bearing.bore_diameter", "a diameter"),
            (
                Some(&self.outside_diameter),
                "bearing.outside_diameter",
                "a diameter",
            ),
            (Some(&self.width), "bearing.width", "a width"),
        ];
        for (length, key, noun) in typed {
            let Some(length) = length else { continue };
            problems.require_positive(length, key, noun);
            let plausible = length.si() <= 0.0 || PLAUSIBLE_LENGTH.contains(&length.si());
            problems.require(plausible, key, length, "check its unit, expected 10 um to 100 m");
        }
    }

    fn check_diameters(&self, raceways: &RacewayLengths, problems: &mut Problems) {
        if let Some(cavity) = &self.ball_inner_diameter {
            let rule = format!(
                "it must be less than bearing.ball_diameter, which is {}",
                self.ball_diameter
            );
            let is_less = cavity.si() < self.ball_diameter.si();
            problems.require(is_less, "bearing.ball_inner_diameter", cavity, rule);
        }
        let [inner, outer] = &raceways.diameters;
        let rising = [
            ("bearing.bore_diameter", &self.bore_diameter),
            (inner.key.as_str(), &inner.value),
            (outer.key.as_str(), &outer.value),
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

    fn check_grooves(&self, raceways: &RacewayLengths, problems: &mut Problems) {
        for groove in &raceways.groove_radii {
            self.check_groove(groove, problems);
        }
    }

    fn check_groove(&self, groove: &Length, problems: &mut Problems) {
        if groove.key.ends_with("_curvature_ratio)") {
            // Its ratio was checked.
            return;
        }
        let ball_radius = 0.5 * self.ball_diameter.si();
        let usual = "0.515 to 0.53 of the ball diameter is usual";
        let ball = Quantity::<LENGTH>::about(ball_radius);
        let (key, radius) = (groove.key.as_str(), &groove.value);
        let rule = format!("it must be more than the ball radius {ball}, {usual}");
        problems.require(radius.si() > ball_radius, key, radius, rule);
        let conformity = radius.si() / self.ball_diameter.si();
        let rule =
            format!("that is {conformity:.3} of the ball diameter, more than {MAX_CONFORMITY}; {usual}");
        problems.require(conformity <= MAX_CONFORMITY, key, radius, rule);
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

    /// Free contact angle a0, rad; 0 with interference.
    pub fn free_contact_angle(&self) -> f64 {
        let cos = 1.0 - self.clearance() / (2.0 * self.groove_distance());
        cos.clamp(-1.0, 1.0).acos()
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
