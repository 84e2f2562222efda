//! `[[profiles.*]]` and `[bearing.ball_diameters]`: by what raceways and balls differ from smooth grooves and equal
//! spheres.
//!
//! ```toml
#![doc = include_str!("example_profiles.toml")]
//! ```
//! Heights are positive above the smooth groove. The profiles of a ring add up.

use std::collections::BTreeMap;
use std::path::Path;

use contact::surface::{Profiles, Spall, Wave};
use input::{LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ball_diameters::RawBallDiameters;
use super::bearing::Bearing;
use super::contact::{BallElasticity, Contact};
use super::dent::RawDent;
use super::heights::RawHeights;
use super::profile_place::{RawAngle, RawBody, RawPlace, WornBody};
use super::random::SplitMix64;
use super::ring::MeshFiles;
use super::ring_name::RingName;
use dynamics::ContactMode;
use dynamics::effects::Effects;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables [[profiles.*]]")]
pub struct RawProfiles {
    #[serde(default)]
    spall: Vec<RawSpall>,
    #[serde(default)]
    dent: Vec<RawDent>,
    #[serde(default)]
    waviness: Vec<RawWaviness>,
    #[serde(default)]
    random: Vec<RawRandom>,
    #[serde(default)]
    table: Vec<RawHeights>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.spall]]")]
struct RawSpall {
    ring: Option<RingName>,
    ball: Option<i64>,
    azimuth: RawAngle,
    groove_angle: RawAngle,
    longitude: RawAngle,
    latitude: RawAngle,
    length: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    depth: Quantity<LENGTH>,
    edge: Option<Quantity<LENGTH>>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.waviness]]")]
struct RawWaviness {
    ring: Option<RingName>,
    ball: Option<i64>,
    order: i64,
    amplitude: Quantity<LENGTH>,
    phase: RawAngle,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.random]]")]
struct RawRandom {
    ring: Option<RingName>,
    ball: Option<i64>,
    orders: [i64; 2],
    amplitude: Quantity<LENGTH>,
    slope: f64,
    seed: i64,
}

/// What profiles are checked against.
#[derive(Clone, Copy, Debug)]
pub struct ProfilesContext<'a> {
    /// Macro-geometry, when it is sound.
    pub bearing: Option<&'a Bearing>,
    /// The scene file; relative paths start at its folder.
    pub scene: &'a Path,
    /// Whether files have to be there.
    pub files: MeshFiles,
    /// What balls yield, as typed.
    pub ball: Option<BallElasticity>,
    /// Whether the analysis is that of natural modes.
    pub is_modes: bool,
    /// Whether the speeds of balls follow their contact angles.
    pub follows_angles: bool,
}

/// Real surfaces of a checked scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceProfiles {
    /// Profiles of the raceways, inner first.
    pub raceways: [Profiles; 2],
    /// Profiles of balls, by number: their azimuths are longitudes, their groove angles latitudes.
    pub balls: BTreeMap<usize, Profiles>,
    /// How much larger the diameter of each ball is, m; empty: all are equal.
    pub oversizes: Vec<f64>,
}

impl SurfaceProfiles {
    /// Whether anything differs from smooth grooves and spheres.
    pub fn has_profiles(&self) -> bool {
        !self.balls.is_empty() || self.raceways.iter().any(|raceway| !raceway.is_empty())
    }

    /// What keeps balls from following each other on one course that stands in space, by its key.
    pub fn parts_courses(&self, effects: &Effects) -> Option<&'static str> {
        let causes = [
            (self.has_profiles(), "[[profiles.*]]"),
            (!self.oversizes.is_empty(), "[bearing.ball_diameters]"),
            (effects.unbalance.is_some(), "[effects.unbalance]"),
        ];
        causes
            .into_iter()
            .find_map(|(is_there, key)| is_there.then_some(key))
    }
}

/// Highest order of waves: 10 um of a ring of 70 mm.
const MAX_ORDER: i64 = 20_000;
/// Largest amplitude of waves, m: more is no surface but another groove.
const MAX_HEIGHT: f64 = 0.1e-3;

impl RawProfiles {
    /// Checks all profiles, and sets what balls yield beside them: half-spaces, where the scene does not say.
    pub fn check(
        &self,
        balls: Option<&RawBallDiameters>,
        context: ProfilesContext<'_>,
        contact: &mut Contact,
        problems: &mut Problems,
    ) -> SurfaceProfiles {
        let mut found = SurfaceProfiles::default();
        self.check_marks(context, &mut found, problems);
        self.check_heights(context, &mut found, problems);
        if let (Some(balls), Some(bearing)) = (balls, context.bearing) {
            found.oversizes = balls.check(bearing.balls, bearing.ball_diameter, problems);
        }
        self.check_contact(&found, context, contact, problems);
        found
    }

    /// Spalls and dents.
    fn check_marks(
        &self,
        context: ProfilesContext<'_>,
        found: &mut SurfaceProfiles,
        problems: &mut Problems,
    ) {
        for (number, spall) in (1..).zip(&self.spall) {
            let body = spall
                .body()
                .check(&format!("profiles.spall {number}"), context.bearing, problems);
            let checked = spall.check(number, body, context.bearing, problems);
            if let Some(body) = body {
                found.of(body).spalls.push(checked);
            }
        }
        for (number, dent) in (1..).zip(&self.dent) {
            let body = dent
                .body()
                .check(&format!("profiles.dent {number}"), context.bearing, problems);
            let checked = dent.check(number, body, context.bearing, problems);
            if let Some(body) = body {
                found.of(body).dents.push(checked);
            }
        }
    }

    /// Waves and tables.
    fn check_heights(
        &self,
        context: ProfilesContext<'_>,
        found: &mut SurfaceProfiles,
        problems: &mut Problems,
    ) {
        let body_of = |table: String, ring, ball, problems: &mut Problems| {
            RawBody { ring, ball }.check(&table, context.bearing, problems)
        };
        for (number, wave) in (1..).zip(&self.waviness) {
            let table = format!("profiles.waviness {number}");
            let order = problems.whole(wave.order, &format!("{table}: order"), 1, MAX_ORDER);
            check_height(&wave.amplitude, &format!("{table}: amplitude"), problems);
            let checked = Wave {
                order,
                amplitude: wave.amplitude.si(),
                phase: wave.phase.as_ref().map_or(0.0, Quantity::si),
            };
            if let Some(body) = body_of(table, wave.ring, wave.ball, problems) {
                found.of(body).waves.push(checked);
            }
        }
        for (number, random) in (1..).zip(&self.random) {
            let waves = random.waves(number, problems);
            let table = format!("profiles.random {number}");
            if let Some(body) = body_of(table, random.ring, random.ball, problems) {
                found.of(body).waves.extend(waves);
            }
        }
        for (number, table) in (1..).zip(&self.table) {
            let name = format!("profiles.table {number}");
            let Some(body) = body_of(name.clone(), table.ring, table.ball, problems) else {
                continue;
            };
            match table.read(body, context.scene, context.files) {
                Ok(heights) => found.of(body).tables.extend(heights),
                Err(problem) => problems.add(format!("{name}: {problem}")),
            }
        }
    }

    /// What real surfaces cannot go with.
    fn check_contact(
        &self,
        found: &SurfaceProfiles,
        context: ProfilesContext<'_>,
        contact: &mut Contact,
        problems: &mut Problems,
    ) {
        let has_profiles = found.bodies().any(|profiles| !profiles.is_empty()) || !self.table.is_empty();
        let what = if has_profiles {
            "profiles"
        } else if contact.edges {
            "contact.edges"
        } else if !found.oversizes.is_empty() {
            "bearing.ball_diameters"
        } else {
            return;
        };
        if contact.mode == ContactMode::Facet {
            problems.add(format!(
                "contact.mode is \"facet\"; {what} needs exact grooves, use \"patch\" or \"rigid\""
            ));
        }
        if what == "bearing.ball_diameters" {
            return;
        }
        if context.is_modes {
            problems.add(format!(
                "{what} has no natural modes: a contact on a real surface has another tangent wherever it stands; \
                 leave out [modes] or {what}"
            ));
        }
        if context.ball == Some(BallElasticity::Sphere) {
            problems.add(format!(
                "contact.ball is \"sphere\"; beside {what} both contacts of a ball are on their own, use \"half_space\""
            ));
        }
        if context.follows_angles && !found.balls.is_empty() {
            problems.add(
                "speed.ball_speeds is \"outer_control\" beside profiles of a ball; a ball then rolls about an axis \
                 that follows its contact angles, and where its profiles are is not computed: use \"free_angle\""
                    .to_string(),
            );
        }
        contact.ball = BallElasticity::HalfSpace;
    }
}

fn check_height(amplitude: &Quantity<LENGTH>, key: &str, problems: &mut Problems) {
    problems.require(
        amplitude.si() > 0.0 && amplitude.si() <= MAX_HEIGHT,
        key,
        amplitude,
        "expected more than 0 and at most 0.1 mm, a fraction of a micrometre is usual",
    );
}

impl RawSpall {
    fn body(&self) -> RawBody {
        RawBody {
            ring: self.ring,
            ball: self.ball,
        }
    }

    fn check(
        &self,
        number: usize,
        body: Option<WornBody>,
        bearing: Option<&Bearing>,
        problems: &mut Problems,
    ) -> Spall {
        let table = format!("profiles.spall {number}");
        let place = RawPlace {
            azimuth: self.azimuth.clone(),
            groove_angle: self.groove_angle.clone(),
            longitude: self.longitude.clone(),
            latitude: self.latitude.clone(),
        };
        let angles = place.check(&table, body, problems);
        place.check_across(&table, body, (0.5 * self.width.si(), bearing), problems);
        self.check_sizes(&table, problems);
        if let Some(bearing) = bearing {
            self.check_on(&table, (body, angles.across), bearing, problems);
        }
        Spall {
            azimuth: angles.along,
            groove_angle: angles.across,
            length: self.length.si(),
            width: self.width.si(),
            depth: self.depth.si(),
            edge: self.edge.as_ref().map_or(0.0, Quantity::si),
        }
    }

    fn check_sizes(&self, table: &str, problems: &mut Problems) {
        let key = |name: &str| format!("{table}: {name}");
        let sizes = [
            ("length", &self.length),
            ("width", &self.width),
            ("depth", &self.depth),
        ];
        for (name, size) in sizes {
            problems.require_positive(size, &key(name), &format!("a {name}"));
        }
        let least = self.length.si().min(self.width.si());
        if let Some(edge) = &self.edge {
            problems.require(
                edge.si() >= 0.0 && edge.si() <= 0.5 * least,
                &key("edge"),
                edge,
                format!(
                    "the ramps lie within length and width: expected 0 to half of the smaller one, {}",
                    Quantity::<LENGTH>::about(0.5 * least)
                ),
            );
        }
    }

    /// Checks the sizes against those of the body on which it is, at an angle across the track.
    fn check_on(
        &self,
        table: &str,
        (body, angle): (Option<WornBody>, f64),
        bearing: &Bearing,
        problems: &mut Problems,
    ) {
        let key = |name: &str| format!("{table}: {name}");
        let diameter = match body {
            Some(WornBody::Ball(_)) => bearing.ball_diameter * angle.cos(),
            _ => bearing.inner_raceway_diameter,
        };
        let round = std::f64::consts::PI * diameter;
        problems.require(
            self.length.si() < round,
            &key("length"),
            &self.length,
            format!("the track is only {} round", Quantity::<LENGTH>::about(round)),
        );
        let radius = 0.5 * bearing.ball_diameter;
        problems.require(
            self.depth.si() <= radius,
            &key("depth"),
            &self.depth,
            format!(
                "expected at most the ball radius {}, check its unit",
                Quantity::<LENGTH>::about(radius)
            ),
        );
        let finest = 1e-3 * bearing.ball_diameter;
        problems.require(
            self.length.si() >= finest,
            &key("length"),
            &self.length,
            format!(
                "expected at least a thousandth of the ball diameter, {}, check its unit",
                Quantity::<LENGTH>::about(finest)
            ),
        );
    }
}

impl RawRandom {
    fn waves(&self, number: usize, problems: &mut Problems) -> Vec<Wave> {
        let key = |name: &str| format!("profiles.random {number}: {name}");
        let [low, high] = self
            .orders
            .map(|order| problems.whole(order, &key("orders"), 1, MAX_ORDER));
        problems.require(
            low <= high,
            &key("orders"),
            format!("{low} to {high}"),
            "expected the lower one first",
        );
        check_height(&self.amplitude, &key("amplitude"), problems);
        problems.require(
            (0.0..=10.0).contains(&self.slope),
            &key("slope"),
            self.slope,
            "expected 0 (all orders alike) to 10, 1 to 2 is usual",
        );
        let mut random = SplitMix64::new(self.seed);
        let wave = |order: usize| Wave {
            order,
            amplitude: self.amplitude.si() * (order as f64 / low as f64).powf(-self.slope),
            phase: std::f64::consts::TAU * random.next(),
        };
        (low..=high).map(wave).collect()
    }
}

impl SurfaceProfiles {
    /// The profiles of a body.
    pub(super) fn of(&mut self, body: WornBody) -> &mut Profiles {
        match body {
            WornBody::Ring(RingName::Inner) => &mut self.raceways[0],
            WornBody::Ring(RingName::Outer) => &mut self.raceways[1],
            WornBody::Ball(ball) => self.balls.entry(ball).or_default(),
        }
    }

    /// Profiles of all bodies.
    fn bodies(&self) -> impl Iterator<Item = &Profiles> {
        self.raceways.iter().chain(self.balls.values())
    }

    /// Numbers that came from files beside the scene: with its text, all that profiles depend on.
    pub fn from_files(&self) -> impl Iterator<Item = f64> + '_ {
        let tables = self.bodies().flat_map(|profiles| &profiles.tables);
        tables.flat_map(|table| {
            [&table.azimuths, &table.angles, &table.heights]
                .into_iter()
                .flatten()
                .copied()
        })
    }
}
