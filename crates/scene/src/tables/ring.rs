//! `[inner]` and `[outer]`: each ring, flexible or rigid, and how it is held.

use std::path::{Path, PathBuf};

use input::{KINDS, LENGTH, Problems, Quantity, parse_unit, shell_word};
use serde::Deserialize;

use super::bearing::Bearing;
use super::cut::{Cut, RawCut};
use super::ring_inertia::{self, InertiaSource, RingInertia};
use super::ring_name::RingName;
use super::section::{MeshedSection, RawSection};
use dynamics::ContactMode;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of one ring")]
pub struct RawRing {
    flexible: Option<bool>,
    mesh: Option<String>,
    mesh_unit: Option<String>,
    support: Option<Support>,
    groove_z: Option<Quantity<LENGTH>>,
    partial: Option<bool>,
    section: Option<RawSection>,
    inertia: Option<InertiaSource>,
    #[serde(default)]
    cut: Vec<RawCut>,
}

/// How a surface may be held, for messages.
const SUPPORTS: &str = "\"clamped\" or \"mean_motion\", or \"body\" with a table [[body]]";

/// How the bore follows the shaft, or the seat the housing.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Support {
    /// Every node of the surface moves with the rigid shaft or housing.
    Clamped,
    /// Only the mean motion of the surface does; it may become oval.
    MeanMotion,
    /// The surface is tied to the elastic body of `[[body]]`.
    Body,
}

/// One ring of a checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// The finite-element body, `None` for a rigid ring.
    pub body: Option<FlexibleRing>,
    /// The section `raceway mesh` builds, when given.
    pub section: Option<MeshedSection>,
    /// Inertia of a rigid ring, where it has its own.
    pub inertia: Option<RingInertia>,
}

/// A ring that is a finite-element body.
#[derive(Clone, Debug, PartialEq)]
pub struct FlexibleRing {
    /// Mesh file, resolved against the scene file's folder.
    pub mesh: PathBuf,
    /// The same as typed in the scene.
    pub mesh_as_typed: String,
    /// Length of one unit of the mesh file, m.
    pub mesh_unit: f64,
    /// How the bore or the seat is held.
    pub support: Support,
    /// Axial position of the groove's centre plane in the mesh, m.
    pub groove_z: f64,
    /// Whether the groups of the mesh may be parts of their surfaces.
    pub is_partial: bool,
    /// Regions whose elements are left out.
    pub cuts: Vec<Cut>,
}

/// Whether mesh files have to be there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFiles {
    /// A missing file is a problem: for runs.
    MustExist,
    /// Files are not looked for: to build meshes, to read a scene back from a checkpoint.
    MayBeMissing,
}

/// What a ring is checked against.
#[derive(Clone, Copy, Debug)]
pub struct RingContext<'a> {
    /// Macro-geometry, when it is sound.
    pub bearing: Option<&'a Bearing>,
    /// Density of the rings, kg/m^3, when it is sound.
    pub density: Option<f64>,
    /// Contact mode of the scene.
    pub mode: ContactMode,
    /// The scene file; relative paths start at its folder.
    pub scene: &'a Path,
    /// Whether the command line changes values of the scene.
    pub overridden: bool,
    /// Whether mesh files have to exist.
    pub mesh_files: MeshFiles,
}

impl RawRing {
    /// How it is held, as typed.
    pub fn support(&self) -> Option<Support> {
        self.support
    }

    /// Whether the scene says that the ring does not deform.
    pub fn is_rigid(&self) -> bool {
        !self.flexible.unwrap_or(true)
    }

    /// Checks the ring. A rigid ring may keep the other keys, unused, so that one `--set` switches it.
    pub fn check(
        &self,
        ring: RingName,
        context: RingContext<'_>,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> Ring {
        let key = ring.key();
        let section = self
            .section
            .as_ref()
            .map(|s| s.check(ring, context.bearing, problems, assumed));
        if self.is_rigid() {
            let inertia = self.check_inertia(ring, section.as_ref(), context, problems, assumed);
            return Ring {
                body: None,
                section,
                inertia,
            };
        }
        if context.mode == ContactMode::Rigid {
            let typed = if self.flexible.is_some() {
                ""
            } else {
                " (the default)"
            };
            problems.add(format!(
                "{key}.flexible is true{typed} but contact.mode is \"rigid\"; set {key}.flexible = false, or \
                 contact.mode = \"patch\" to let the ring deform"
            ));
            return Ring {
                body: None,
                section,
                inertia: None,
            };
        }
        Ring {
            body: self.check_flexible(ring, context, problems),
            section,
            inertia: None,
        }
    }

    /// Inertia of a rigid ring that asks for that of its section.
    fn check_inertia(
        &self,
        ring: RingName,
        section: Option<&MeshedSection>,
        context: RingContext<'_>,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> Option<RingInertia> {
        let InertiaSource::Section = self.inertia?;
        if ring == RingName::Outer {
            problems.add(ring_inertia::OF_OUTER);
            return None;
        }
        let Some(section) = section else {
            problems.add(ring_inertia::NO_SECTION);
            return None;
        };
        let measures = section.measures(context.bearing?, ring);
        ring_inertia::of_section(&measures, context.density?, problems, assumed)
    }

    fn check_flexible(
        &self,
        ring: RingName,
        context: RingContext<'_>,
        problems: &mut Problems,
    ) -> Option<FlexibleRing> {
        let key = ring.key();
        let held = ring.held_surface();
        let mut missing = |name: &str, meaning: &str| {
            problems.add(format!(
                "{key}.{name} is missing; a flexible ring needs {meaning}, or set {key}.flexible = false"
            ));
        };
        if self.mesh.is_none() {
            missing("mesh", "a mesh file");
        }
        if self.mesh_unit.is_none() {
            missing("mesh_unit", "the unit of its mesh such as \"mm\"");
        }
        if self.support.is_none() {
            missing("support", &format!("to know how its {held} is held, {SUPPORTS}"));
        }
        let mesh_unit = self.mesh_unit.as_ref().and_then(|text| {
            let unit = parse_unit(text, &KINDS[LENGTH]);
            unit.map_err(|e| problems.add(format!("{key}.mesh_unit: {e}")))
                .ok()
        });
        let groove_z = self.check_groove_z(key, context.bearing, problems);
        let cuts = self.cut.iter().zip(1..);
        let cuts = cuts
            .map(|(cut, number)| cut.check(ring, number, problems))
            .collect();
        let typed = self.mesh.as_ref()?;
        let mesh = context.scene.parent().unwrap_or(Path::new("")).join(typed);
        if context.mesh_files == MeshFiles::MustExist && mesh.exists() && !mesh.is_file() && !mesh.is_dir() {
            problems.add(format!(
                "{key}.mesh is {typed:?}, but {} is no plain file; expected a mesh that Gmsh or raceway mesh wrote",
                mesh.display()
            ));
        } else if context.mesh_files == MeshFiles::MustExist && !mesh.is_file() {
            problems.add(format!(
                "{key}.mesh is {typed:?}, but there is no file {}; {}correct the path, which is relative to the \
                 scene file",
                mesh.display(),
                self.how_to_build(context)
            ));
        }
        Some(FlexibleRing {
            mesh,
            mesh_as_typed: typed.clone(),
            mesh_unit: mesh_unit?,
            support: self.support?,
            groove_z,
            is_partial: self.partial.unwrap_or(false),
            cuts,
        })
    }

    /// The command that builds a missing mesh; empty when the scene does not describe its section.
    fn how_to_build(&self, context: RingContext<'_>) -> String {
        if self.section.is_none() {
            return String::new();
        }
        let same = if context.overridden {
            " and the same --set"
        } else {
            ""
        };
        format!(
            "build it with \"raceway mesh {}\"{same}, which needs Gmsh, or ",
            shell_word(context.scene.display())
        )
    }

    fn check_groove_z(&self, key: &str, bearing: Option<&Bearing>, problems: &mut Problems) -> f64 {
        let Some(groove_z) = &self.groove_z else {
            return 0.0;
        };
        problems.require(
            bearing.is_none_or(|b| groove_z.si().abs() <= 10.0 * b.width),
            &format!("{key}.groove_z"),
            groove_z,
            "that is more than ten bearing widths from the origin of the mesh, check its unit",
        );
        groove_z.si()
    }
}
