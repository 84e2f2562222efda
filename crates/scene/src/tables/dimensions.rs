//! Where the raceways of a bearing lie, from whatever two numbers a catalogue or a drawing gives.
//!
//! Groove radii are given, or are a ratio of the ball diameter. With them two numbers are left: the raceway diameters
//! d_i and D_e. They follow from two of
//!
//! - `inner_raceway_diameter` d_i, `outer_raceway_diameter` D_e and `pitch_diameter` d_m,
//!
//! or from one of these and one of
//!
//! - `contact_angle` a0, free of load,
//! - `radial_clearance` P_d = D_e - d_i - 2 D_w = 2 A (1 - cos a0): the whole way from one extreme to the opposite, as
//!   the radial internal clearance of ISO 5753,
//! - `axial_clearance` P_e = 2 A sin a0: the whole way from one extreme to the other,
//!
//! where A = R_i + R_o - D_w. The pitch circle is that of the centres of balls that just touch both raceways:
//!
//! ```text
//! d_i = d_m - 2 R_i + (2 R_i - D_w) cos a0        D_e = d_m + 2 R_o - (2 R_o - D_w) cos a0
//! ```
//!
//! and with interference (P_d < 0) d_i = d_m - D_w - P_d/2 and D_e = d_m + D_w + P_d/2. Reference: Harris and Kotzalas,
//! Essential Concepts of Bearing Technology, 5th ed. 2006, chapter 2, equations (2.3), (2.9) and (2.12).
//!
//! More than two numbers are accepted where they agree. Typed diameters are used as they are.

use input::{ANGLE, LENGTH, Problems, Quantity};

/// Groove radius over ball diameter where a scene says nothing: the largest for which the ratings of ISO 281 hold.
pub const DEFAULT_INNER_RATIO: f64 = 0.52;
/// The same of the outer groove.
pub const DEFAULT_OUTER_RATIO: f64 = 0.53;
/// A number beyond the first two may differ from what they give by this: clearances relative, diameters relative,
/// angles in rad. Catalogues round.
const AGREEMENT: Agreement = Agreement {
    clearance: 0.02,
    diameter: 1e-4,
    angle: 1.8e-3,
};
/// What may be given, for messages.
const EXPECTED: &str = "expected two of inner_raceway_diameter, outer_raceway_diameter and pitch_diameter, or one of \
                        them and one of contact_angle, radial_clearance and axial_clearance";

struct Agreement {
    clearance: f64,
    diameter: f64,
    angle: f64,
}

/// What a scene says of the place of the raceways.
#[derive(Clone, Copy)]
pub struct RacewayKeys<'a> {
    /// Diameter of the bottom of the inner groove.
    pub inner: Option<&'a Quantity<LENGTH>>,
    /// Diameter of the bottom of the outer groove.
    pub outer: Option<&'a Quantity<LENGTH>>,
    /// Diameter of the circle of ball centres.
    pub pitch: Option<&'a Quantity<LENGTH>>,
    /// Free contact angle.
    pub angle: Option<&'a Quantity<ANGLE>>,
    /// Radial clearance, from extreme to extreme.
    pub radial: Option<&'a Quantity<LENGTH>>,
    /// Axial clearance, from extreme to extreme.
    pub axial: Option<&'a Quantity<LENGTH>>,
}

/// The balls and the sections of the grooves, m.
#[derive(Clone, Copy)]
pub struct Grooves {
    /// Ball diameter D_w.
    pub ball: f64,
    /// Radius R_i of the inner groove.
    pub inner: f64,
    /// Radius R_o of the outer groove.
    pub outer: f64,
}

/// Diameters of the bottoms of both grooves, m.
#[derive(Clone, Copy, Debug)]
pub struct Diameters {
    /// Of the inner ring.
    pub inner: f64,
    /// Of the outer ring.
    pub outer: f64,
}

/// Where the raceways lie.
#[derive(Debug)]
pub struct RacewayPlace {
    /// Diameters of their bottoms.
    pub diameters: Diameters,
    /// The keys that they were computed from; `None` where both were given.
    pub computed_from: Option<String>,
}

impl Grooves {
    /// Distance of the groove centres of a ball that touches both raceways, A, m.
    pub fn distance(&self) -> f64 {
        self.inner + self.outer - self.ball
    }

    /// Raceway diameters on a pitch circle, m.
    fn on_pitch(&self, pitch: f64, clearance: f64) -> Diameters {
        if clearance < 0.0 {
            return Diameters {
                inner: pitch - self.ball - 0.5 * clearance,
                outer: pitch + self.ball + 0.5 * clearance,
            };
        }
        let cos = 1.0 - clearance / (2.0 * self.distance());
        Diameters {
            inner: pitch - 2.0 * self.inner + (2.0 * self.inner - self.ball) * cos,
            outer: pitch + 2.0 * self.outer - (2.0 * self.outer - self.ball) * cos,
        }
    }

    /// Radial clearance with an inner raceway on a pitch circle, m. For the outer one take both negative.
    fn clearance_on(&self, groove: f64, raceway: f64, pitch: f64) -> f64 {
        // The bottom of the groove at zero clearance lies half a ball from the pitch circle.
        let gap = pitch - self.ball - raceway;
        if gap < 0.0 {
            return 2.0 * gap;
        }
        // gap = (2 R - D_w) (1 - cos a0)
        2.0 * self.distance() * gap / (2.0 * groove - self.ball)
    }

    /// Free contact angle at a radial clearance, rad; not a number where there is none.
    fn angle(&self, clearance: f64) -> f64 {
        (1.0 - clearance.max(0.0) / (2.0 * self.distance())).acos()
    }
}

impl RacewayKeys<'_> {
    /// Finds the raceways, and reports what is missing or contradicts itself.
    pub fn resolve(&self, grooves: &Grooves, problems: &mut Problems) -> Option<RacewayPlace> {
        let before = problems.len();
        self.require_ranges(grooves, problems);
        if problems.len() > before {
            return None;
        }
        let Some((diameters, used)) = self.of_two(grooves) else {
            problems.add(self.missing());
            return None;
        };
        let computed_from = (used != [INNER, OUTER]).then(|| used.join(" and "));
        let found = AllNumbers::new(grooves, diameters);
        // Two diameters may have a clearance that no bearing has: that is said where all bearings are checked.
        if found.angle.is_finite() {
            self.require_agreement(&found, used, problems);
        }
        (problems.len() == before).then_some(RacewayPlace {
            diameters,
            computed_from,
        })
    }

    fn of_two(&self, grooves: &Grooves) -> Option<(Diameters, [&'static str; 2])> {
        let clearance = self.clearance(grooves);
        let si = |length: &Quantity<LENGTH>| length.si();
        let (inner, outer, pitch) = (self.inner.map(si), self.outer.map(si), self.pitch.map(si));
        let from_inner = |inner: f64, clearance: f64| Diameters {
            inner,
            outer: inner + 2.0 * grooves.ball + clearance,
        };
        let from_outer = |outer: f64, clearance: f64| Diameters {
            inner: outer - 2.0 * grooves.ball - clearance,
            outer,
        };
        Some(match (inner, outer, pitch, clearance) {
            (Some(inner), Some(outer), ..) => (Diameters { inner, outer }, [INNER, OUTER]),
            (Some(inner), None, Some(pitch), _) => {
                let clearance = grooves.clearance_on(grooves.inner, inner, pitch);
                (from_inner(inner, clearance), [INNER, PITCH])
            }
            (None, Some(outer), Some(pitch), _) => {
                let clearance = grooves.clearance_on(grooves.outer, -outer, -pitch);
                (from_outer(outer, clearance), [OUTER, PITCH])
            }
            (Some(inner), None, None, Some((clearance, key))) => (from_inner(inner, clearance), [INNER, key]),
            (None, Some(outer), None, Some((clearance, key))) => (from_outer(outer, clearance), [OUTER, key]),
            (None, None, Some(pitch), Some((clearance, key))) => {
                (grooves.on_pitch(pitch, clearance), [PITCH, key])
            }
            _ => return None,
        })
    }

    /// Radial clearance, m, and the key it comes from.
    fn clearance(&self, grooves: &Grooves) -> Option<(f64, &'static str)> {
        let of_angle = |angle: f64| 2.0 * grooves.distance() * (1.0 - angle.cos());
        if let Some(angle) = self.angle {
            return Some((of_angle(angle.si()), ANGLE_KEY));
        }
        if let Some(radial) = self.radial {
            return Some((radial.si(), RADIAL));
        }
        let axial = self.axial?.si() / (2.0 * grooves.distance());
        Some((of_angle(axial.asin()), AXIAL))
    }

    fn require_ranges(&self, grooves: &Grooves, problems: &mut Problems) {
        for (key, length) in [(INNER, self.inner), (OUTER, self.outer), (PITCH, self.pitch)] {
            if let Some(length) = length {
                problems.require_positive(length, &full(key), "a diameter");
            }
        }
        if let Some(angle) = self.angle {
            let rule = "expected 0 deg to less than 90 deg, 15, 25 or 40 deg are usual";
            let holds = (0.0..std::f64::consts::FRAC_PI_2).contains(&angle.si());
            problems.require(holds, &full(ANGLE_KEY), angle, rule);
        }
        let distance = grooves.distance();
        let grooves = |most: f64| {
            format!(
                "grooves whose centres are {} apart allow {}",
                Quantity::<LENGTH>::about(distance),
                Quantity::<LENGTH>::about(most)
            )
        };
        if let Some(radial) = self.radial {
            let holds = (-2.0 * distance..2.0 * distance).contains(&radial.si());
            let rule = format!(
                "expected less than that, {}: check its unit, um is usual",
                grooves(2.0 * distance)
            );
            problems.require(holds, &full(RADIAL), radial, rule);
        }
        if let Some(axial) = self.axial {
            let holds = (0.0..2.0 * distance).contains(&axial.si());
            let rule = format!(
                "expected 0 or more and less than what {}",
                grooves(2.0 * distance)
            );
            problems.require(holds, &full(AXIAL), axial, rule);
        }
    }

    /// Every number beyond the first two must be what they give.
    fn require_agreement(&self, found: &AllNumbers, used: [&str; 2], problems: &mut Problems) {
        let mut compare = |key: &str, typed: String, is_near: bool, value: String| {
            if !used.contains(&key) && !is_near {
                problems.add(format!(
                    "{} is {typed}, but {} and {} give {value}; leave one of the three out",
                    full(key),
                    used[0],
                    used[1]
                ));
            }
        };
        let near = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance;
        let about = Quantity::<LENGTH>::about;
        let diameters = [
            (INNER, self.inner, found.inner),
            (OUTER, self.outer, found.outer),
            (PITCH, self.pitch, found.pitch),
        ];
        for (key, typed, value) in diameters {
            if let Some(typed) = typed {
                let is_near = near(typed.si(), value, AGREEMENT.diameter * value);
                compare(key, typed.to_string(), is_near, about(value).to_string());
            }
        }
        if let Some(angle) = self.angle {
            let is_near = near(angle.si(), found.angle, AGREEMENT.angle);
            let value = format!("{:.4} deg", found.angle.to_degrees());
            compare(ANGLE_KEY, angle.to_string(), is_near, value);
        }
        for (key, typed, value) in [
            (RADIAL, self.radial, found.radial),
            (AXIAL, self.axial, found.axial),
        ] {
            if let Some(typed) = typed {
                let is_near = near(typed.si(), value, AGREEMENT.clearance * value.abs());
                compare(key, typed.to_string(), is_near, about(value).to_string());
            }
        }
    }

    fn missing(&self) -> String {
        let given = [
            (INNER, self.inner.is_some()),
            (OUTER, self.outer.is_some()),
            (PITCH, self.pitch.is_some()),
            (ANGLE_KEY, self.angle.is_some()),
            (RADIAL, self.radial.is_some()),
            (AXIAL, self.axial.is_some()),
        ];
        let given: Vec<&str> = given
            .iter()
            .filter(|(_, is_given)| *is_given)
            .map(|(key, _)| *key)
            .collect();
        let found = match given.as_slice() {
            [] => "no key that places the raceways".to_string(),
            [one] => format!("only {one} to place the raceways"),
            more => format!("{} but no diameter to place the raceways", more.join(", ")),
        };
        format!("bearing has {found}; {EXPECTED}")
    }
}

/// All numbers of a bearing's raceways, m and rad.
struct AllNumbers {
    inner: f64,
    outer: f64,
    pitch: f64,
    angle: f64,
    radial: f64,
    axial: f64,
}

impl AllNumbers {
    fn new(grooves: &Grooves, Diameters { inner, outer }: Diameters) -> AllNumbers {
        let radial = outer - inner - 2.0 * grooves.ball;
        let angle = grooves.angle(radial);
        let cos = angle.cos();
        let pitch = match radial < 0.0 {
            true => 0.5 * (inner + outer),
            false => inner + 2.0 * grooves.inner - (2.0 * grooves.inner - grooves.ball) * cos,
        };
        AllNumbers {
            inner,
            outer,
            pitch,
            angle,
            radial,
            axial: 2.0 * grooves.distance() * angle.sin(),
        }
    }
}

const INNER: &str = "inner_raceway_diameter";
const OUTER: &str = "outer_raceway_diameter";
const PITCH: &str = "pitch_diameter";
const ANGLE_KEY: &str = "contact_angle";
const RADIAL: &str = "radial_clearance";
const AXIAL: &str = "axial_clearance";

fn full(key: &str) -> String {
    format!("bearing.{key}")
}
