//! `[[profiles.*]]` and `[bearing.ball_diameters]`: by what raceways and balls differ from smooth grooves and equal
//! spheres.
//!
//! ```toml
#![doc = include_str!("example_profiles.toml")]
//! ```
//! Heights are positive above the smooth groove. The profiles of a ring add up.

use std::collections::BTreeMap;
use std::path::Path;

use contact::surface::{Heights, Profiles, Spall, Wave};
use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ball_diameters::RawBallDiameters;
use super::balls::BallMotion;
use super::bearing::Bearing;
use super::contact::{BallElasticity, Contact, ContactMode};
use super::dent::{RawDent, check_groove_angle};
use super::random::SplitMix64;
use super::ring::{MeshFiles, RingName};

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
    ring: RingName,
    azimuth: Quantity<ANGLE>,
    groove_angle: Quantity<ANGLE>,
    length: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    depth: Quantity<LENGTH>,
    edge: Option<Quantity<LENGTH>>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.waviness]]")]
struct RawWaviness {
    ring: RingName,
    order: i64,
    amplitude: Quantity<LENGTH>,
    phase: Option<Quantity<ANGLE>>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.random]]")]
struct RawRandom {
    ring: RingName,
    orders: [i64; 2],
    amplitude: Quantity<LENGTH>,
    slope: f64,
    seed: i64,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.table]]")]
struct RawHeights {
    ring: RingName,
    file: String,
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
    /// How the balls move.
    pub balls: BallMotion,
}

/// Real surfaces of a checked scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceProfiles {
    /// Profiles of the raceways, inner first.
    pub raceways: [Profiles; 2],
    /// How much larger the diameter of each ball is, m; empty: all are equal.
    pub oversizes: Vec<f64>,
}

/// Highest order of waves: 10 um of a ring of 70 mm.
const MAX_ORDER: i64 = 20_000;
/// Largest amplitude of waves, m, and height of a table: more is no surface but another groove.
const MAX_HEIGHT: f64 = 0.1e-3;
/// Columns of a table of heights.
const COLUMNS: &str = "azimuth_deg,groove_angle_deg,height_um";

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
        for (number, spall) in (1..).zip(&self.spall) {
            spall.check(number, context.bearing, problems);
            found.raceways[index(spall.ring)].spalls.push(spall.spall());
        }
        for (number, dent) in (1..).zip(&self.dent) {
            let checked = dent.check(number, context.bearing, problems);
            found.raceways[index(dent.ring())].dents.push(checked);
        }
        for (number, wave) in (1..).zip(&self.waviness) {
            let key = format!("profiles.waviness {number}: order");
            let order = problems.whole(wave.order, &key, 1, MAX_ORDER);
            check_height(
                &wave.amplitude,
                &format!("profiles.waviness {number}: amplitude"),
                problems,
            );
            found.raceways[index(wave.ring)].waves.push(Wave {
                order,
                amplitude: wave.amplitude.si(),
                phase: wave.phase.as_ref().map_or(0.0, Quantity::si),
            });
        }
        for (number, random) in (1..).zip(&self.random) {
            let waves = random.waves(number, problems);
            found.raceways[index(random.ring)].waves.extend(waves);
        }
        for (number, table) in (1..).zip(&self.table) {
            match table.read(context) {
                Ok(heights) => found.raceways[index(table.ring)].tables.extend(heights),
                Err(problem) => problems.add(format!("profiles.table {number}: {problem}")),
            }
        }
        if let (Some(balls), Some(bearing)) = (balls, context.bearing) {
            found.oversizes = balls.check(bearing.balls, bearing.ball_diameter, problems);
        }
        self.check_contact(&found, context, contact, problems);
        found
    }

    /// What real surfaces cannot go with.
    fn check_contact(
        &self,
        found: &SurfaceProfiles,
        context: ProfilesContext<'_>,
        contact: &mut Contact,
        problems: &mut Problems,
    ) {
        let has_profiles =
            found.raceways.iter().any(|profiles| !profiles.is_empty()) || !self.table.is_empty();
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
        if context.balls == BallMotion::Free {
            problems.add(format!(
                "{what} stands beside balls.motion = \"free\", which is not computed; use balls.motion = \
                 \"kinematic\""
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
        contact.ball = BallElasticity::HalfSpace;
    }
}

fn index(ring: RingName) -> usize {
    match ring {
        RingName::Inner => 0,
        RingName::Outer => 1,
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
    fn check(&self, number: usize, bearing: Option<&Bearing>, problems: &mut Problems) {
        let key = |name: &str| format!("profiles.spall {number}: {name}");
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
        check_groove_angle(&self.groove_angle, &key("groove_angle"), problems);
        let Some(bearing) = bearing else { return };
        let round = std::f64::consts::PI * bearing.inner_raceway_diameter;
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

    fn spall(&self) -> Spall {
        Spall {
            azimuth: self.azimuth.si(),
            groove_angle: self.groove_angle.si(),
            length: self.length.si(),
            width: self.width.si(),
            depth: self.depth.si(),
            edge: self.edge.as_ref().map_or(0.0, Quantity::si),
        }
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

impl RawHeights {
    /// The heights of the file; None where it may be missing and is.
    fn read(&self, context: ProfilesContext<'_>) -> Result<Option<Heights>, String> {
        let path = context.scene.parent().unwrap_or(Path::new(".")).join(&self.file);
        if context.files == MeshFiles::MayBeMissing && !path.exists() {
            return Ok(None);
        }
        let text = std::fs::read_to_string(&path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        heights(&text)
            .map(Some)
            .map_err(|problem| format!("{}, {problem}", path.display()))
    }
}

/// A table of heights from its text: lines of azimuth, groove angle and height that make a full grid.
fn heights(text: &str) -> Result<Heights, String> {
    let lines = text
        .lines()
        .zip(1..)
        .filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#'));
    let mut lines = lines.map(|(line, number)| (line.trim(), number));
    let head = lines
        .next()
        .map_or(String::new(), |(line, _)| line.replace(' ', ""));
    if head != COLUMNS {
        return Err(format!("line 1 is {head:?}; expected the columns {COLUMNS}"));
    }
    let mut rows: BTreeMap<u64, BTreeMap<u64, f64>> = BTreeMap::new();
    for (line, number) in lines {
        let cells: Vec<Option<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
        let [Some(azimuth), Some(angle), Some(height)] = cells[..] else {
            return Err(format!("line {number} is {line:?}; expected three numbers"));
        };
        let most = 1e6 * MAX_HEIGHT;
        let is_sane = (0.0..360.0).contains(&azimuth) && angle.abs() < 90.0 && height.abs() <= most;
        if !is_sane {
            return Err(format!(
                "line {number} is {line:?}; expected an azimuth from 0 to below 360 deg, a groove angle between -90 \
                 and 90 deg and a height of at most 100 um"
            ));
        }
        let row = rows.entry(ordered(azimuth)).or_default();
        if row.insert(ordered(angle), 1e-6 * height).is_some() {
            return Err(format!(
                "line {number} gives {line:?} again; expected each point once"
            ));
        }
    }
    let angles: Vec<u64> = rows
        .values()
        .next()
        .map(|row| row.keys().copied().collect())
        .unwrap_or_default();
    if angles.is_empty() {
        return Err(format!("there is no line below the columns {COLUMNS}"));
    }
    for (azimuth, row) in &rows {
        if !row.keys().eq(&angles) {
            return Err(format!(
                "the azimuth {} deg has other groove angles than the first one; expected a full grid",
                value(*azimuth)
            ));
        }
    }
    Ok(Heights {
        azimuths: rows.keys().map(|azimuth| value(*azimuth).to_radians()).collect(),
        angles: angles.iter().map(|angle| value(*angle).to_radians()).collect(),
        heights: rows.values().flat_map(|row| row.values().copied()).collect(),
    })
}

/// A whole number in the order of the numbers.
fn ordered(x: f64) -> u64 {
    // Adding zero makes a negative zero positive.
    let bits = (x + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(ordered: u64) -> f64 {
    f64::from_bits(if ordered >> 63 == 1 {
        ordered & !(1 << 63)
    } else {
        !ordered
    })
}

impl SurfaceProfiles {
    /// Numbers that came from files beside the scene: with its text, all that profiles depend on.
    pub fn from_files(&self) -> impl Iterator<Item = f64> + '_ {
        let tables = self.raceways.iter().flat_map(|profiles| &profiles.tables);
        tables.flat_map(|table| {
            [&table.azimuths, &table.angles, &table.heights]
                .into_iter()
                .flatten()
                .copied()
        })
    }
}
