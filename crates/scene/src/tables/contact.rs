//! `[contact]`: how balls and raceways push on each other.

use dynamics::ContactMode;
use input::{HERTZ_STIFFNESS, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::balls::BallMotion;
use super::bearing::Bearing;
use super::materials::{MaterialProperties, Materials};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [contact]")]
pub struct RawContact {
    mode: ContactMode,
    inner_stiffness: Option<Quantity<HERTZ_STIFFNESS>>,
    outer_stiffness: Option<Quantity<HERTZ_STIFFNESS>>,
    patch_elements: Option<f64>,
    patch_length: Option<Quantity<LENGTH>>,
    pub(super) ball: Option<BallElasticity>,
    groove_circle: Option<SeenGroove>,
    edges: Option<bool>,
}

/// What a ball yields besides its Hertz contacts.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BallElasticity {
    /// What a solid sphere between both contacts yields less than two half-spaces.
    Sphere,
    /// Nothing: Hertz's law alone.
    HalfSpace,
}

/// What a ball sees of the circle of groove centres of an inner ring that moves.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum SeenGroove {
    /// Where the moved circle meets the ball's meridian plane: the groove is a torus.
    Exact,
    /// Its point at the ball's azimuth, projected onto that plane, as in the methods of Jones and Harris.
    Projected,
}

/// How balls and raceways push on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Representation of the raceways.
    pub mode: ContactMode,
    /// K of Q = K d^1.5 between ball and inner ring, N/m^1.5; exact Hertz when `None`.
    pub inner_stiffness: Option<f64>,
    /// The same for the outer ring, N/m^1.5.
    pub outer_stiffness: Option<f64>,
    /// Least semi-axis of a contact patch, in element sizes.
    pub patch_elements: f64,
    /// Least semi-axis of a contact patch in the rolling direction, m; None: by the elements, 0.21 ball diameters where
    /// a ring has quadratic ones.
    pub patch_length: Option<f64>,
    /// What balls yield. By default spheres, but half-spaces with rigid rings (the Jones-Harris limit), with facets
    /// (the paper's way) and where a stiffness is given.
    pub ball: BallElasticity,
    /// What they see of the inner groove: projected by default, but a torus of balls that move freely.
    pub groove_circle: SeenGroove,
    /// Whether grooves end at their shoulders.
    pub edges: bool,
}

/// Smaller patches see single elements (design number: the structural compliance is then mesh-independent).
const DEFAULT_PATCH_ELEMENTS: f64 = 2.0;
/// A given K may differ from E* sqrt(D_w), the size of exact Hertz, by this factor, such as to compare with rigid
/// contacts: more is nothing that numbers of 16 digits can solve.
const SLIP_FACTOR: f64 = 1e8;
/// From this factor on a given K is said to be unusual: N/m^1.5 for N/mm^1.5 is 3e4.
const UNUSUAL_FACTOR: f64 = 100.0;

/// A sentence for each given stiffness that is most likely a slip of its unit.
pub fn unusual_stiffnesses(contact: &Contact, bearing: &Bearing, materials: &Materials) -> Vec<String> {
    let hertz = hertz_scale(bearing, materials);
    let given = [
        ("contact.inner_stiffness", contact.inner_stiffness),
        ("contact.outer_stiffness", contact.outer_stiffness),
    ];
    let unusual = |(key, stiffness): (&str, Option<f64>)| {
        let stiffness = stiffness?;
        let ratio = stiffness / hertz;
        let is_usual = (1.0 / UNUSUAL_FACTOR..=UNUSUAL_FACTOR).contains(&ratio);
        (!is_usual).then(|| {
            format!(
                "{key} is {}, {ratio:.1e} times E* sqrt(ball_diameter), the size of exact Hertz; check its unit, \
                 N/mm^1.5 is usual",
                Quantity::<HERTZ_STIFFNESS>::about(stiffness)
            )
        })
    };
    given.into_iter().filter_map(unusual).collect()
}

impl RawContact {
    /// Checks the table; bearing and materials are there when they are sound, to judge the size of a
    /// stiffness. How balls move decides what is usual.
    pub fn check(
        &self,
        bearing: Option<&Bearing>,
        materials: Option<&Materials>,
        balls: BallMotion,
        problems: &mut Problems,
    ) -> Contact {
        self.check_free(balls, problems);
        let patch_elements = self.patch_elements.unwrap_or(DEFAULT_PATCH_ELEMENTS);
        problems.require(
            (0.5..=20.0).contains(&patch_elements),
            "contact.patch_elements",
            patch_elements,
            "expected 0.5 to 20 element sizes, 2 is usual",
        );
        let patch_length = self.least_length(bearing, problems);
        let hertz = bearing.zip(materials).map(|(b, m)| hertz_scale(b, m));
        let stiffnesses = [
            ("contact.inner_stiffness", &self.inner_stiffness),
            ("contact.outer_stiffness", &self.outer_stiffness),
        ];
        for (key, stiffness) in stiffnesses {
            let Some(stiffness) = stiffness else { continue };
            problems.require_positive(stiffness, key, "a stiffness");
            let Some(ratio) = hertz.map(|h| stiffness.si() / h).filter(|r| *r > 0.0) else {
                continue;
            };
            problems.require(
                (1.0 / SLIP_FACTOR..=SLIP_FACTOR).contains(&ratio),
                key,
                stiffness,
                format!(
                    "that is {ratio:.1e} times E* sqrt(ball_diameter), check its unit, N/mm^1.5 is usual"
                ),
            );
        }
        let is_hertz = self.inner_stiffness.is_none() && self.outer_stiffness.is_none();
        let usual = match self.mode {
            ContactMode::Patch if is_hertz => BallElasticity::Sphere,
            _ => BallElasticity::HalfSpace,
        };
        Contact {
            groove_circle: self.seen_groove(balls),
            ball: self.ball.unwrap_or(usual),
            mode: self.mode,
            edges: self.edges.unwrap_or(false),
            inner_stiffness: self.inner_stiffness.as_ref().map(Quantity::si),
            outer_stiffness: self.outer_stiffness.as_ref().map(Quantity::si),
            patch_elements,
            patch_length,
        }
    }

    /// Refuses what free balls in motion do not know.
    fn check_free(&self, balls: BallMotion, problems: &mut Problems) {
        if balls != BallMotion::Free {
            return;
        }
        if self.groove_circle == Some(SeenGroove::Projected) {
            problems.add(
                "contact.groove_circle is \"projected\", but free balls in motion see a torus: remove it, or use \
                 balls.motion = \"kinematic\"",
            );
        }
    }

    fn seen_groove(&self, balls: BallMotion) -> SeenGroove {
        let usual = match balls {
            BallMotion::Kinematic => SeenGroove::Projected,
            BallMotion::Free => SeenGroove::Exact,
        };
        self.groove_circle.unwrap_or(usual)
    }

    /// Least semi-axis of a patch in the rolling direction, m, if it is typed.
    fn least_length(&self, bearing: Option<&Bearing>, problems: &mut Problems) -> Option<f64> {
        let (diameter, typed) = (bearing?.ball_diameter, self.patch_length.as_ref()?);
        problems.require(
            (0.0..=diameter).contains(&typed.si()),
            "contact.patch_length",
            typed,
            "expected 0 mm to a ball diameter, 0.21 of one is usual",
        );
        Some(typed.si())
    }
}

/// E* sqrt(D_w), N/m^1.5, with 1/E* = the sum of (1 - nu^2)/E: the size of a Hertz stiffness, within a few
/// times.
fn hertz_scale(bearing: &Bearing, materials: &Materials) -> f64 {
    let compliance = |m: MaterialProperties| (1.0 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus;
    bearing.ball_diameter.sqrt() / (compliance(materials.rings) + compliance(materials.balls))
}
