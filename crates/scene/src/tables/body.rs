//! `[[body]]`: an elastic body round the outer ring, or one on the shaft in which the inner ring sits.
//!
//! ```toml
#![doc = include_str!("example_body.toml")]
//! ```

mod matrix;

use std::path::{Path, PathBuf};

use assembly::Orientation;
use body::SeatBasis;
use body::matrix::MatrixFiles;
use input::{LENGTH, Problems, Quantity, RATE};
use serde::Deserialize;

use super::materials::{MaterialProperties, RawMaterial};
use super::ring::{MeshFiles, Support};
use super::ring_name::RingName;
use super::solver::BackendChoice;
use super::unit_key::unit_of;

/// Orders round a seat without a word.
const HARMONICS: i64 = 12;
/// Degrees across a seat without a word.
const ACROSS: i64 = 2;
/// Frequency up to which a moving body keeps its modes without a word, Hz.
const MODES_BELOW: f64 = 20e3;
/// Effects that act on a seat of which something else is assumed, and why not with a body round the outer ring.
const REFUSED_OUTSIDE: [(&str, &str); 4] = [
    ("fit", "its pressure is that of a rigid or round housing"),
    ("seat_form", "its form is pressed on by a rigid housing"),
    ("spring_preload", "its ring slides in a rigid housing"),
    ("temperature", "its seat grows with a rigid or round housing"),
];
/// The same of a body on the shaft.
const REFUSED_ON_SHAFT: [(&str, &str); 2] = [
    ("fit", "its pressure is that of a rigid or round shaft"),
    ("temperature", "its seat grows with a rigid or round shaft"),
];

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of a body round a ring")]
pub struct RawSceneBody {
    name: String,
    mesh: Option<String>,
    mesh_unit: Option<String>,
    material: Option<RawMaterial>,
    fixed: Option<Vec<String>>,
    stiffness: Option<String>,
    mass: Option<String>,
    nodes: Option<String>,
    seat_nodes: Option<String>,
    fixed_nodes: Option<String>,
    length_unit: Option<String>,
    stiffness_unit: Option<String>,
    mass_unit: Option<String>,
    modes_below: Option<Quantity<RATE>>,
    orientation: Option<String>,
    #[serde(default)]
    seat: Vec<RawBodySeat>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of a seat of a body")]
struct RawBodySeat {
    ring: RingName,
    /// Of a list of bearings alone, which takes it out.
    bearing: Option<String>,
    group: Option<String>,
    seat_nodes: Option<String>,
    reference_node: Option<i64>,
    harmonics: Option<i64>,
    across: Option<i64>,
    z: Option<Quantity<LENGTH>>,
}

/// A body of a checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBody {
    /// Its name.
    pub name: String,
    /// Where its stiffness comes from.
    pub source: BodySource,
    /// Facet group of its seat; empty for matrices, whose files name its nodes.
    pub group: String,
    /// Functions that are tied.
    pub basis: SeatBasis,
    /// The ring that sits in it: the outer one, or the inner one of a body that the shaft carries.
    pub ring: RingName,
    /// Whether it is turned by 180 deg about x.
    pub is_turned: bool,
    /// Whether it carries other bearings of a list as well.
    pub is_shared: bool,
    /// Frequency up to which its modes with a held seat move, Hz; None at rest.
    pub modes_below: Option<f64>,
    /// Whether the mass among its matrices is read: at rest only modes over the speed and loads on all of it do.
    pub reads_mass: bool,
    /// Whether an effect of the scene loads all of it.
    pub is_loaded: bool,
    /// Where the middle of the ring's seat stands along its own z, m; None: in the middle of the group.
    pub z: Option<f64>,
}

/// Mesh or matrices of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodySource {
    /// A mesh.
    Mesh {
        /// Gmsh file.
        mesh: PathBuf,
        /// Length of one unit of the file, m.
        mesh_unit: f64,
        /// What it is made of.
        material: MaterialProperties,
        /// Facet groups that are held.
        fixed: Vec<String>,
    },
    /// Matrices of another program.
    Matrix(MatrixFiles),
}

/// What bodies are checked against.
pub struct BodyContext<'a> {
    /// The scene file.
    pub scene: &'a Path,
    /// Whether files have to exist.
    pub files: MeshFiles,
    /// How the rings are held, as typed, inner first.
    pub supports: [Option<Support>; 2],
    /// Whether the scene says that the rings are rigid, inner first.
    pub is_rigid: [bool; 2],
    /// Whether the outer ring turns.
    pub turns_outer: bool,
    /// Linear solver of the rings.
    pub backend: BackendChoice,
    /// Whether the scene moves in time, or asks for natural modes.
    pub moves: bool,
    /// Effects of the scene.
    pub effects: Vec<&'static str>,
}

/// The bodies of both rings among the tables of a scene, inner first.
pub fn check_bodies(
    bodies: &[RawSceneBody],
    context: &BodyContext<'_>,
    problems: &mut Problems,
    assumed: &mut Vec<String>,
) -> [Option<SceneBody>; 2] {
    [RingName::Inner, RingName::Outer].map(|ring| {
        let own: Vec<&RawSceneBody> = bodies.iter().filter(|body| body.ring() == ring).collect();
        check_ring(ring, &own, context, problems, assumed)
    })
}

/// The body of one ring among those that name it.
fn check_ring(
    ring: RingName,
    bodies: &[&RawSceneBody],
    context: &BodyContext<'_>,
    problems: &mut Problems,
    assumed: &mut Vec<String>,
) -> Option<SceneBody> {
    let key = ring.key();
    let is_wanted = context.supports[ring as usize] == Some(Support::Body);
    let Some(first) = bodies.first() else {
        if is_wanted {
            problems.add(format!(
                "{key}.support is \"body\", but the scene has no body for it; add a table [[body]] with a \
                 [[body.seat]] of ring = \"{key}\", or set {key}.support = \"clamped\" or \"mean_motion\""
            ));
        }
        return None;
    };
    if let Some(second) = bodies.get(1) {
        problems.add(format!(
            "the scene has {} tables [[body]], such as {:?} and {:?}, for one {key} ring; expected one body, so mesh \
             what is joined as one",
            bodies.len(),
            first.name,
            second.name
        ));
    }
    if context.is_rigid[ring as usize] {
        problems.add(format!(
            "body {:?} carries the {key} ring, but that ring is rigid; set {key}.flexible = true or remove [[body]]",
            first.name
        ));
    } else if !is_wanted {
        problems.add(format!(
            "body {:?} is there, but {key}.support is not \"body\"; set {key}.support = \"body\" or remove [[body]]",
            first.name
        ));
    }
    refuse_beside_body(&first.name, ring, context, problems);
    first.check(ring, context, problems, assumed)
}

/// What a body does not go with.
fn refuse_beside_body(name: &str, ring: RingName, context: &BodyContext<'_>, problems: &mut Problems) {
    if context.backend.divides_rings() {
        problems.add(format!(
            "solver.backend is \"sector\", which does not tie a ring to a body ({name:?}); expected \"auto\", \
             \"cyclic\" or \"sparse\""
        ));
    }
    if context.turns_outer && ring == RingName::Outer {
        problems.add(format!(
            "speed.outer turns the outer ring, but body {name:?} carries it and stands; remove speed.outer or \
             [[body]]"
        ));
    }
    let refused = match ring {
        RingName::Inner => &REFUSED_ON_SHAFT[..],
        RingName::Outer => &REFUSED_OUTSIDE,
    };
    for (effect, why) in refused {
        if context.effects.contains(effect) {
            problems.add(format!(
                "effects.{effect}{} does not go with body {name:?}: {why}; remove one of them",
                if *effect == "spring_preload" {
                    ", or pairing.spring,"
                } else {
                    ""
                }
            ));
        }
    }
}

impl RawSceneBody {
    /// The ring that it carries: that of its first seat.
    fn ring(&self) -> RingName {
        self.seat.first().map_or(RingName::Outer, |seat| seat.ring)
    }

    fn check(
        &self,
        ring: RingName,
        context: &BodyContext<'_>,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> Option<SceneBody> {
        let key = format!("body {:?}", self.name);
        problems.require(
            !self.name.trim().is_empty() && self.name.len() <= 64,
            "body.name",
            format!("{:?}", self.name),
            "expected a name of 1 to 64 letters",
        );
        let source = self.check_source(&key, ring, context, (problems, &mut *assumed));
        let typed = self.orientation.as_deref().unwrap_or(Orientation::PlusZ.name());
        let orientation = Orientation::named(typed);
        problems.require(
            orientation.is_some(),
            &format!("{key}: orientation"),
            format!("{typed:?}"),
            "expected \"+z\", as the mesh stands, or \"-z\", turned by 180 deg about x",
        );
        let is_heavy = context.effects.contains(&"gravity");
        let grows = ring == RingName::Inner && context.effects.contains(&"frame_rotation");
        let is_loaded = is_heavy || grows;
        if is_heavy && self.stiffness.is_some() && self.mass.is_none() {
            assumed.push(format!(
                "{key} comes from matrices without a mass, so effects.gravity does not make it sag; add mass and \
                 mass_unit for that"
            ));
        }
        let modes_below = self.check_modes(&key, context, problems);
        let seat = self.check_seat(&key, problems)?;
        let harmonics = seat.harmonics.unwrap_or(HARMONICS);
        let across = seat.across.unwrap_or(ACROSS);
        let harmonics = SeatBasis::Harmonics {
            harmonics: problems.whole(harmonics, "body.seat.harmonics", 1, 64),
            across: problems.whole(across, "body.seat.across", 1, 8),
        };
        Some(SceneBody {
            basis: match seat.reference_node {
                Some(_) => SeatBasis::Rigid,
                None => harmonics,
            },
            name: self.name.clone(),
            ring,
            is_turned: orientation == Some(Orientation::MinusZ),
            is_shared: false,
            modes_below,
            reads_mass: context.moves || is_loaded,
            is_loaded,
            source: source?,
            group: seat.group.clone().unwrap_or_default(),
            z: seat.z.as_ref().map(Quantity::si),
        })
    }

    /// Of what its stiffness and mass are made: of one mesh, or of matrices.
    fn check_source(
        &self,
        key: &str,
        ring: RingName,
        context: &BodyContext<'_>,
        (problems, assumed): (&mut Problems, &mut Vec<String>),
    ) -> Option<BodySource> {
        match (&self.mesh, &self.stiffness) {
            (Some(_), Some(_)) => {
                problems.add(format!("{key} has both mesh and stiffness; keep one of them"));
                None
            }
            (None, None) => {
                problems.add(format!(
                    "{key} has neither mesh nor stiffness; add mesh, mesh_unit, material and fixed, or stiffness, \
                     nodes and seat_nodes of another program"
                ));
                None
            }
            (Some(mesh), None) => {
                self.refuse_matrix_keys(key, problems);
                self.check_mesh(key, mesh, context, problems, assumed)
            }
            (None, Some(_)) => {
                if ring == RingName::Inner {
                    problems.add(format!(
                        "{key} carries the inner ring and comes from a stiffness matrix, of which nothing says how it \
                         moves with the shaft; give it as a mesh"
                    ));
                }
                self.check_matrix(key, context, problems)
            }
        }
    }

    /// Frequency up to which the modes of a moving body are kept, Hz.
    fn check_modes(&self, key: &str, context: &BodyContext<'_>, problems: &mut Problems) -> Option<f64> {
        let below = self.modes_below.as_ref().map_or(MODES_BELOW, Quantity::si);
        problems.require(
            (1.0..=1e6).contains(&below),
            &format!("{key}: modes_below"),
            format!("{below} Hz"),
            "expected a frequency between 1 Hz and 1 MHz",
        );
        if !context.moves {
            if self.modes_below.is_some() {
                problems.add(format!(
                    "{key} has modes_below, but the scene has no [dynamic] or [modes], so it does not move; remove \
                     modes_below"
                ));
            }
            return None;
        }
        if self.stiffness.is_some() && self.mass.is_none() {
            problems.add(format!(
                "{key} comes from a stiffness matrix, which has no mass, but the scene has [dynamic] or [modes]; add \
                 mass and mass_unit, or use [static], [sweep] or [quasi_static]"
            ));
        }
        Some(below)
    }

    /// The one seat.
    fn check_seat(&self, key: &str, problems: &mut Problems) -> Option<&RawBodySeat> {
        if self.seat.iter().any(|seat| seat.bearing.is_some()) {
            problems.add(format!(
                "{key}: body.seat.bearing is for a list [[bearing]], but the scene has one bearing; remove it"
            ));
        }
        let seat = match self.seat.as_slice() {
            [seat] => seat,
            [] => {
                problems.add(format!(
                    "{key} has no seat; add a table [[body.seat]] with ring = \"outer\" or \"inner\" and the group of \
                     its surface"
                ));
                return None;
            }
            many => {
                problems.add(format!(
                    "{key} has {} tables [[body.seat]], but the bearing has one ring in it; expected one",
                    many.len()
                ));
                return None;
            }
        };
        if self.mesh.is_some() && seat.group.is_none() {
            problems.add(format!(
                "{key}: seat.group is missing; expected the facet group of its mesh that carries the ring"
            ));
        }
        Some(seat)
    }

    fn check_mesh(
        &self,
        key: &str,
        mesh: &str,
        context: &BodyContext<'_>,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> Option<BodySource> {
        let mesh = file(&format!("{key}: mesh"), mesh, context, problems);
        let unit = unit_of(
            &format!("{key}: mesh_unit"),
            self.mesh_unit.as_deref(),
            (LENGTH, "mm"),
            problems,
        );
        if self.material.is_none() {
            problems.add(format!(
                "{key}: material is missing; expected a table with young_modulus, poisson_ratio and density, or a name"
            ));
        }
        let fixed = self.fixed.clone().unwrap_or_default();
        if fixed.is_empty() {
            problems.add(format!(
                "{key}: fixed names no facet group, so nothing holds the body; expected such as fixed = [\"feet\"]"
            ));
        }
        let material = self
            .material
            .as_ref()?
            .check(&format!("{key}: material"), problems, assumed);
        Some(BodySource::Mesh {
            mesh,
            mesh_unit: unit?,
            material,
            fixed,
        })
    }
}

/// A file beside the scene.
fn file(key: &str, typed: &str, context: &BodyContext<'_>, problems: &mut Problems) -> PathBuf {
    let path = context.scene.parent().unwrap_or(Path::new("")).join(typed);
    if context.files == MeshFiles::MustExist && !path.is_file() {
        problems.add(format!(
            "{key} is {typed:?}, but there is no file {}; correct the path, which is relative to the scene file",
            path.display()
        ));
    }
    path
}
