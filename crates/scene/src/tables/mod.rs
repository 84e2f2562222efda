//! Scene files: the bearing, its meshes, its loads and what is computed, as TOML.
//!
//! Every quantity is a string with its unit, see [`input::units`]. Every table is checked against the list of its
//! keys. An effect is a table `[effects.*]`: without the table there is no effect. Exactly one of `[static]`,
//! `[sweep]`, `[quasi_static]`, `[dynamic]` and `[modes]` says what is computed. Axis z is axial, + is the direction
//! of preload; azimuth runs from +x to +y; displacements count from the state where all balls just touch both
//! raceways.
//!
//! Reading goes through two levels: the tables as typed (`Raw*`, private, in the file of their table), and
//! the checked [`Scene`] in plain SI numbers and enums. A text that is not of the format stops at the first
//! error with its line and column; values that make no sense are reported all together. `--set path=value`
//! edits the text before it is read; the edited text is kept in the scene, for checkpoints.
//!
//! The whole format, with every key:
//!
//! ```toml
#![doc = include_str!("example.toml")]
//! ```
//!
//! A scene of motion in time has the same tables and these:
//!
//! ```toml
#![doc = include_str!("example_dynamic.toml")]
//! ```
//!
//! A scene of natural modes has the tables of a scene at rest and, as its analysis, this one:
//!
//! ```toml
#![doc = include_str!("example_modes.toml")]
//! ```
//!
//! A bearing may be given as catalogues give it, and materials by name: see the files of these tables, `bearing.rs`
//! and `materials.rs`.
//!
//! Any scene may have tables `[stress]`, `[probes.*]`, `[life]`, `[heat]` and `[lubricant]`, and motion without inertia
//! is a table of its own, `[quasi_static]`: see the files of these names.

mod analyses;
mod analysis;
mod ball_diameters;
mod balls;
mod bearing;
mod body;
mod cage;
mod contact;
mod cut;
mod dent;
mod difference;
mod dimensions;
mod dynamic;
mod edit;
mod error;
mod gather;
mod gauges;
mod heat;
mod heights;
mod hints;
mod include;
mod life;
mod locate;
mod lubricant;
mod materials;
mod messages;
mod modes;
mod oil;
mod optional;
mod output;
mod pocket;
mod probes;
mod profile_place;
mod profiles;
mod quasi_static;
mod random;
pub mod reference;
mod ring;
mod ring_inertia;
mod ring_name;
mod section;
mod several;
mod shaft;
mod solver;
mod speed;
mod start;
mod steps;
mod stress;
mod stress_probes;
mod sweep;
#[cfg(test)]
mod tests;
mod unit_key;

use std::path::{Path, PathBuf};

pub use dynamics::ContactMode;
use dynamics::effects::Effects;
use dynamics::interactions::cage::Cage;
pub use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::kinematics::{BallSpeeds, RingSpeeds};
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml_edit::DocumentMut;

pub use self::balls::BallMotion;
pub use self::bearing::Bearing;
pub use self::body::{BodySource, SceneBody};
pub(crate) use self::contact::unusual_stiffnesses;
pub use self::contact::{BallElasticity, Contact, SeenGroove};
pub use self::difference::difference;
pub use self::dynamic::{Dynamic, IntegratorChoice};
pub use self::error::SceneError;
pub use self::gauges::{Across, GaugeProbe, Tachometer};
pub use self::heat::{BODIES, FrictionLaw, Heat, SURROUNDINGS};
pub use self::life::{Life, LifeGrooves};
pub use self::locate::locate;
pub use self::lubricant::{Lubrication, Roughness};
pub use self::materials::{MaterialProperties, Materials};
pub use self::modes::{ModeBody, ModeSupport, Modes};
pub use self::oil::Oil;
pub use self::output::{
    CycleDamage, DamageNodes, DamageStress, Every, FieldPrecision, KeptFields, OutputReduction, OutputRegion,
    OutputSettings, RingFrame, StressOutput,
};
pub use self::probes::{Axes, ContactProbe, NodeProbe, Probes, SectionPoint};
pub use self::profiles::SurfaceProfiles;
pub use self::quasi_static::QuasiStatic;
pub use self::ring::{FlexibleRing, MeshFiles, Ring, Support};
pub use self::ring_inertia::RingInertia;
pub use self::ring_name::RingName;
pub use self::section::{MeshedSection, SectionElement, ShoulderDiameters};
pub use self::several::{
    AnyScene, BearingOnShaft, CommonShaft, ON_SHAFT, Pairing, RigidShaft, SeveralScene, ShaftKind, ShaftLoad,
    SpringPairing, names_of_bearings, overrides_of_types,
};
pub use self::shaft::{Shaft, ShaftMotion};
pub use self::solver::{BackendChoice, Solver};
pub use self::start::Start;
pub use self::stress::Stress;
pub use self::stress_probes::StressLine;
pub use self::sweep::{Analysis, SweepPoint};

use self::balls::RawBalls;
use self::bearing::RawBearing;
use self::body::RawSceneBody;
use self::cage::RawCage;
use self::contact::RawContact;
use self::dynamic::RawDynamic;
use self::heat::RawHeat;
use self::life::RawLife;
use self::lubricant::RawLubricant;
use self::materials::RawMaterials;
use self::messages::Messages;
use self::modes::{ModesContext, RawModes};
use self::output::RawOutput;
use self::probes::RawProbes;
use self::profiles::RawProfiles;
use self::quasi_static::RawQuasiStatic;
use self::ring::{RawRing, RingContext};
use self::shaft::RawShaft;
use self::solver::RawSolver;
use self::speed::RawSpeed;
use self::stress::RawStress;
use self::sweep::{RawStatic, RawSweep};
use input::Problems;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a scene")]
struct RawScene {
    title: Option<String>,
    /// Taken out of the text before it is read; here so that messages name it.
    #[serde(rename = "include")]
    _include: Option<IgnoredAny>,
    bearing: RawBearing,
    materials: RawMaterials,
    contact: RawContact,
    #[serde(default)]
    profiles: RawProfiles,
    #[serde(default)]
    inner: RawRing,
    #[serde(default)]
    outer: RawRing,
    #[serde(default)]
    body: Vec<RawSceneBody>,
    shaft: RawShaft,
    #[serde(default)]
    balls: RawBalls,
    cage: Option<RawCage>,
    speed: Option<RawSpeed>,
    #[serde(default)]
    effects: Effects,
    #[serde(default)]
    solver: RawSolver,
    #[serde(default)]
    output: RawOutput,
    #[serde(default)]
    stress: RawStress,
    #[serde(default)]
    probes: RawProbes,
    life: Option<RawLife>,
    heat: Option<RawHeat>,
    lubricant: Option<RawLubricant>,
    r#static: Option<RawStatic>,
    sweep: Option<RawSweep>,
    quasi_static: Option<RawQuasiStatic>,
    dynamic: Option<RawDynamic>,
    modes: Option<RawModes>,
}

/// A checked scene, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The scene file.
    pub path: PathBuf,
    /// Its text with all that it includes and the overrides applied: with the path, all that is needed to read the
    /// scene again.
    pub text: String,
    /// The `--set` arguments in it.
    pub overrides: Vec<String>,
    /// Free text for people.
    pub title: Option<String>,
    /// Macro-geometry.
    pub bearing: Bearing,
    /// What the bodies are made of.
    pub materials: Materials,
    /// How balls and raceways push on each other.
    pub contact: Contact,
    /// By what raceways and balls differ from smooth grooves and equal spheres.
    pub profiles: SurfaceProfiles,
    /// The ring on the shaft.
    pub inner: Ring,
    /// The ring in the housing.
    pub outer: Ring,
    /// The elastic bodies in which the rings sit, inner first: one on the shaft, one round the outer ring.
    pub bodies: [Option<SceneBody>; 2],
    /// Freedoms of the shaft.
    pub shaft: Shaft,
    /// How the balls move.
    pub balls: BallMotion,
    /// A free cage.
    pub cage: Option<Cage>,
    /// Speeds of the rings; none turns when `None`.
    pub speed: Option<RingSpeeds>,
    /// Whether the table `[speed]` names a ring, inner first.
    pub has_speed: [bool; 2],
    /// Contact angles that the speeds of balls follow.
    pub ball_speeds: BallSpeeds,
    /// Loads and other effects.
    pub effects: Effects,
    /// How the equations are solved.
    pub solver: Solver,
    /// What is written.
    pub output: OutputSettings,
    /// How stress is computed.
    pub stress: Stress,
    /// Single numbers that are written at every step.
    pub probes: Probes,
    /// What a life needs besides loads.
    pub life: Option<Life>,
    /// What a heat balance needs besides the bearing.
    pub heat: Option<Heat>,
    /// What lubricates the contacts.
    pub lubricant: Option<Lubrication>,
    /// What is computed.
    pub analysis: Analysis,
    /// What the scene leaves open and the program has filled in: a sentence each.
    pub assumed: Vec<String>,
}

impl Scene {
    /// Checks the text of a scene whose bearing is a table; `path` is for messages and its folder is where relative
    /// paths start.
    fn parse_one(
        text: &str,
        path: &Path,
        overrides: &[String],
        mesh_files: MeshFiles,
    ) -> Result<Scene, SceneError> {
        let whole = include::whole(text, path, overrides)?;
        let source = TextSource {
            path,
            overrides,
            mesh_files,
            messages: Messages {
                path,
                whole: &whole,
                overrides,
            },
        };
        let mut document = source.messages.document(&whole.text)?;
        for argument in overrides.iter().filter(|o| !include::is_of_include(o)) {
            edit::apply_override(&mut document, argument).map_err(|reason| SceneError::Override {
                argument: argument.clone(),
                reason,
            })?;
        }
        let text = if overrides.is_empty() {
            whole.text.clone()
        } else {
            document.to_string()
        };
        let scene = source.check(text, &document)?;
        source.check_points(&scene)?;
        Ok(scene)
    }

    /// The scenes of the points of a sweep, in order; none for any other scene.
    pub fn sweep_scenes(&self) -> Result<Vec<Scene>, SceneError> {
        let Analysis::Sweep(sweep) = &self.analysis else {
            return Ok(Vec::new());
        };
        let point = |p: &SweepPoint| Scene::parse_one(&p.text, &self.path, &[], MeshFiles::MayBeMissing);
        sweep.points.iter().map(point).collect()
    }
}

/// The text of a scene with all that it includes; `overrides` may name other files to include.
pub fn whole_text(text: &str, path: &Path, overrides: &[String]) -> Result<String, SceneError> {
    Ok(include::whole(text, path, overrides)?.text)
}

/// Where a text comes from and how strictly it is checked.
struct TextSource<'a> {
    path: &'a Path,
    overrides: &'a [String],
    mesh_files: MeshFiles,
    messages: Messages<'a>,
}

impl TextSource<'_> {
    /// The tables of the text, or all that is wrong with their format.
    fn read(&self, text: &str, document: &DocumentMut) -> Result<RawScene, SceneError> {
        self.messages
            .read_beside(text, |found| analyses::not_one_of_text(document, found))
    }

    fn check(&self, text: String, document: &DocumentMut) -> Result<Scene, SceneError> {
        let raw = self.read(&text, document)?;
        let mut problems = Problems::default();
        let mut assumed = Vec::new();
        let bearing = raw.bearing.check(&mut problems, &mut assumed);
        let materials = raw.materials.check(&mut problems, &mut assumed);
        let known = (bearing.as_ref(), materials.as_ref());
        let (contact, profiles) = self.contacts(&raw, known, &mut problems);
        let [inner, outer] = self.rings(&raw, known, contact.mode, (&mut problems, &mut assumed));
        let flexible = [inner.body.is_some(), outer.body.is_some()];
        let shaft = raw.shaft.check(bearing.as_ref(), raw.clock(), &mut problems);
        let context = raw.effects_context(flexible, known, (&shaft, &inner), &profiles);
        raw.effects.check(context, &mut problems);
        let balls = raw.balls.check(raw.balls_context(), &mut problems);
        let cage = raw.cage(balls, bearing.as_ref(), materials.as_ref(), &mut problems);
        let (speed, ball_speeds) = raw.speeds(&mut problems);
        let has_speed = raw.has_speed();
        let solver = raw.solver.check(&mut problems);
        let bodies = raw.bodies(self, solver.backend, &mut problems, &mut assumed);
        let output = raw.output.check(raw.output_context(flexible), &mut problems);
        let stress = raw.stress_of(contact.mode, &mut problems);
        let probes = raw.probes_of(bearing.as_ref(), &mut problems);
        let lubricant = raw.lubricant(speed.as_ref(), &mut problems);
        let life = raw.life(&mut problems);
        let heat = raw.heat(&mut problems);
        let modes = ModesContext::new(flexible, contact.mode, solver.backend);
        let analysis = raw.analysis(document, (&shaft, modes), &mut problems);
        match (bearing, materials, analysis, problems.into_texts()) {
            (Some(bearing), Some(materials), Some(analysis), texts) if texts.is_empty() => Ok(Scene {
                path: self.path.to_path_buf(),
                text,
                overrides: self.overrides.to_vec(),
                title: raw.title,
                bearing,
                materials,
                contact,
                effects: analysis.at_start(raw.effects, &profiles),
                profiles,
                inner,
                outer,
                bodies,
                shaft,
                balls,
                cage,
                speed,
                has_speed,
                ball_speeds,
                solver,
                output,
                stress,
                probes,
                life,
                heat,
                lubricant,
                analysis,
                assumed,
            }),
            (.., texts) => Err(self.messages.invalid(texts)),
        }
    }

    /// How balls and raceways push on each other, on which surfaces.
    fn contacts(
        &self,
        raw: &RawScene,
        (bearing, materials): (Option<&Bearing>, Option<&Materials>),
        problems: &mut Problems,
    ) -> (Contact, SurfaceProfiles) {
        let mut contact = raw
            .contact
            .check(bearing, materials, raw.moving_balls(), problems);
        let surfaces = raw.surfaces_context(bearing, self.path, self.mesh_files);
        let diameters = raw.bearing.ball_diameters.as_ref();
        let profiles = raw.profiles.check(diameters, surfaces, &mut contact, problems);
        (contact, profiles)
    }

    /// The rings, inner first.
    fn rings(
        &self,
        raw: &RawScene,
        (bearing, materials): (Option<&Bearing>, Option<&Materials>),
        mode: ContactMode,
        (problems, assumed): (&mut Problems, &mut Vec<String>),
    ) -> [Ring; 2] {
        let context = RingContext {
            bearing,
            density: materials.map(|m| m.rings.density),
            mode,
            scene: self.path,
            overridden: !self.overrides.is_empty(),
            mesh_files: self.mesh_files,
        };
        let inner = raw.inner.check(RingName::Inner, context, problems, assumed);
        let outer = raw.outer.check(RingName::Outer, context, problems, assumed);
        // Without a sound bearing shoulders have no size.
        if let (Some(inner), Some(outer), Some(_)) = (&inner.section, &outer.section, bearing) {
            section::check_gap(inner, outer, problems);
        }
        [inner, outer]
    }

    /// Every point of a sweep must be a valid scene before the first is solved.
    fn check_points(&self, scene: &Scene) -> Result<(), SceneError> {
        let Analysis::Sweep(sweep) = &scene.analysis else {
            return Ok(());
        };
        let mut problems = Vec::new();
        for (i, point) in sweep.points.iter().enumerate() {
            let error = match Scene::parse_one(&point.text, self.path, &[], MeshFiles::MayBeMissing) {
                Ok(_) => continue,
                Err(SceneError::Invalid { problems, .. }) => problems.join("; "),
                Err(SceneError::Format { message, .. }) => {
                    // The key or the kind of its values: wrong in every point.
                    problems.push(format!("sweep.key is {:?}; {message}", sweep.key));
                    break;
                }
                Err(other) => other.to_string(),
            };
            problems.push(format!(
                "point {i} of the sweep ({} = {}): {error}",
                sweep.column, point.value
            ));
        }
        if problems.is_empty() {
            Ok(())
        } else {
            Err(self.messages.invalid(problems))
        }
    }
}
