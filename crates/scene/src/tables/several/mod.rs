//! `[[bearing]]`, `[pairing]` and `[shaft]` with `[[shaft.section]]`: several bearings on one shaft.
//!
//! ```toml
#![doc = include_str!("../example_several.toml")]
//! ```
//!
//! Each bearing is a scene of its own ([`compose`]): the tables of its type file with those of the scene that all
//! bearings have, such as `[solver]` and `[effects.gravity]`. It stands in its own frame, with the shaft prescribed.
//! What loads the shaft is kept apart. So every check of a bearing's tables is that of a scene with one bearing.
//!
//! Positions count along the shaft. That of a bearing is the position of the plane of its inner groove centres, to
//! which the displacements of a scene with one bearing refer too.

mod bodies;
mod compose;
mod load;
mod mounted;
mod pairing;
mod read;
mod shaft;
mod turned;

use std::path::PathBuf;

use dynamics::effects::Effects;
use dynamics::kinematics::RingSpeeds;
use input::Problems;
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml_edit::{DocumentMut, Item};

use self::bodies::RawListedBody;
pub use self::load::ShaftLoad;
pub use self::mounted::BearingOnShaft;
use self::mounted::RawMounted;
use self::pairing::RawPairing;
pub use self::pairing::{Pairing, SpringPairing};
pub use self::read::AnyScene;
use self::shaft::RawCommonShaft;
pub use self::shaft::{CommonShaft, RigidShaft, ShaftKind};
use super::dynamic::RawDynamic;
use super::edit;
use super::modes::RawModes;
use super::quasi_static::RawQuasiStatic;
use super::speed::RawSpeed;
use super::sweep::{Analysis, RawStatic, RawSweep};

/// Effects that load the shaft.
pub const ON_SHAFT: [&str; 4] = ["axial_force", "moment", "radial_force", "unbalance"];
/// Tables that a type file may have.
const OF_TYPE: [&str; 5] = ["bearing", "materials", "contact", "inner", "outer"];
/// Effects that act in every bearing.
const IN_BEARINGS: [&str; 10] = [
    "ball_centrifugal",
    "cage_slip",
    "contact_damping",
    "fit",
    "frame_rotation",
    "gravity",
    "gyroscopic_moment",
    "orbit_inertia",
    "rayleigh_damping",
    "temperature",
];

/// As typed; tables of bearings are read with their types.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the tables of a scene with a list of bearings"
)]
pub struct RawSeveral {
    title: Option<String>,
    #[serde(rename = "include")]
    _include: Option<IgnoredAny>,
    bearing: Vec<RawMounted>,
    shaft: RawCommonShaft,
    pairing: Option<RawPairing>,
    #[serde(default)]
    body: Vec<RawListedBody>,
    #[serde(rename = "materials")]
    _materials: Option<IgnoredAny>,
    #[serde(rename = "contact")]
    _contact: Option<IgnoredAny>,
    #[serde(rename = "inner")]
    _inner: Option<IgnoredAny>,
    #[serde(rename = "outer")]
    _outer: Option<IgnoredAny>,
    speed: Option<RawSpeed>,
    #[serde(default)]
    effects: Effects,
    #[serde(rename = "solver")]
    _solver: Option<IgnoredAny>,
    #[serde(rename = "output")]
    _output: Option<IgnoredAny>,
    #[serde(rename = "stress")]
    _stress: Option<IgnoredAny>,
    r#static: Option<RawStatic>,
    sweep: Option<RawSweep>,
    profiles: Option<IgnoredAny>,
    balls: Option<IgnoredAny>,
    cage: Option<IgnoredAny>,
    probes: Option<IgnoredAny>,
    life: Option<IgnoredAny>,
    heat: Option<IgnoredAny>,
    lubricant: Option<IgnoredAny>,
    quasi_static: Option<RawQuasiStatic>,
    dynamic: Option<RawDynamic>,
    modes: Option<RawModes>,
}

/// A checked scene with a list of bearings, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct SeveralScene {
    /// The scene file.
    pub path: PathBuf,
    /// Its text with all that it includes, but for the types of bearings, and the overrides applied.
    pub text: String,
    /// The `--set` arguments in it.
    pub overrides: Vec<String>,
    /// Free text for people.
    pub title: Option<String>,
    /// The bearings, in the order of the scene.
    pub bearings: Vec<BearingOnShaft>,
    /// The shaft.
    pub shaft: CommonShaft,
    /// What presses the bearings together.
    pub pairing: Pairing,
    /// All effects; those of the list [`ON_SHAFT`] are not in the scenes of the bearings.
    pub effects: Effects,
    /// Speeds of the rings in the frame of the shaft; none turns when `None`.
    pub speed: Option<RingSpeeds>,
    /// What is computed.
    pub analysis: Analysis,
}

/// Those `--set` arguments that are of the types of the bearings: they are not in the text of a list.
pub fn overrides_of_types(overrides: &[String]) -> Vec<String> {
    overrides.iter().filter(|o| is_of_type(o)).cloned().collect()
}

/// Whether a `--set` argument is of the type of the bearings.
fn is_of_type(argument: &str) -> bool {
    let root = argument.split(['.', '=']).next().unwrap_or_default().trim();
    root != "bearing" && OF_TYPE.contains(&root)
}

/// Names of the bearings in the text of a list that was read before.
pub fn names_of_bearings(text: &str) -> Vec<String> {
    let document: DocumentMut = text.parse().unwrap_or_default();
    let tables = document.get("bearing").and_then(Item::as_array_of_tables);
    let names = tables
        .into_iter()
        .flatten()
        .filter_map(|table| table.get("name")?.as_str());
    names.map(str::to_string).collect()
}

impl SeveralScene {
    /// The `--set` arguments that are of the types of the bearings: they are not in the text.
    pub fn type_overrides(&self) -> Vec<String> {
        overrides_of_types(&self.overrides)
    }
}

impl RawSeveral {
    /// Names of the bearings.
    fn names(&self) -> Vec<&str> {
        self.bearing.iter().map(|bearing| bearing.name.as_str()).collect()
    }

    /// Reports tables that a list of bearings does not go with.
    fn refuse(&self, problems: &mut Problems) {
        if let Some(dynamic) = &self.dynamic {
            dynamic.refuse_in_list(problems);
        }
        if let Some(modes) = &self.modes {
            modes.refuse_in_list(problems);
        }
        if self.effects.unbalance.is_some() && !self.has_time() {
            problems.add(
                "effects.unbalance of a list of bearings is for [quasi_static] and [dynamic]: it turns with the shaft; \
                 at rest write [[shaft.load]] with its force m e Omega^2",
            );
        }
        let others = [
            ("profiles", &self.profiles),
            ("balls", &self.balls),
            ("cage", &self.cage),
            ("probes", &self.probes),
            ("life", &self.life),
            ("heat", &self.heat),
            ("lubricant", &self.lubricant),
        ];
        for (name, _) in others.iter().filter(|(_, table)| table.is_some()) {
            problems.add(format!(
                "[{name}] is not for a list of bearings yet; remove it, or give one table [bearing]"
            ));
        }
        let known = [&ON_SHAFT[..], &IN_BEARINGS[..]].concat();
        for name in self.effects.names().iter().filter(|name| !known.contains(name)) {
            let instead = match *name {
                "spring_preload" => "write [pairing] with spring and sliding",
                _ => "remove it, or give one table [bearing]",
            };
            problems.add(format!("effects.{name} is not for a list of bearings; {instead}"));
        }
    }

    /// Whether loads have a course over time.
    fn has_time(&self) -> bool {
        self.dynamic.is_some() || self.quasi_static.is_some()
    }

    /// The analysis of a list at rest; those over time and modes are read with the bearings.
    fn analysis(&self, document: &DocumentMut, problems: &mut Problems) -> Option<Analysis> {
        let given = [
            ("[static]", self.r#static.is_some()),
            ("[sweep]", self.sweep.is_some()),
            ("[quasi_static]", self.quasi_static.is_some()),
            ("[dynamic]", self.dynamic.is_some()),
            ("[modes]", self.modes.is_some()),
        ];
        let given: Vec<&str> = given
            .iter()
            .filter(|(_, is)| *is)
            .map(|(name, _)| *name)
            .collect();
        match given[..] {
            [_] => match &self.sweep {
                Some(sweep) => sweep.check(document, problems).map(Analysis::Sweep),
                None => Some(Analysis::Static),
            },
            [] => {
                problems.add(
                    "the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and \
                     [modes]",
                );
                None
            }
            [a, b] => {
                problems.add(format!(
                    "the scene has both {a} and {b}; keep exactly one analysis"
                ));
                None
            }
            _ => {
                problems.add(format!(
                    "the scene has {}; keep exactly one analysis",
                    given.join(", ")
                ));
                None
            }
        }
    }
}

/// Whether a scene is a list of one bearing that a scene with one table says as well.
fn is_plain(raw: &RawSeveral) -> bool {
    let [bearing] = raw.bearing.as_slice() else {
        return false;
    };
    bearing.is_plain() && raw.shaft.is_plain() && raw.pairing.is_none()
}

/// Sets a value of a document by its dotted path.
fn set(document: &mut DocumentMut, path: &str, value: &str) {
    edit::apply_override(document, &format!("{path}={value}")).expect("the path is one of the program");
}
