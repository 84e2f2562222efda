//! A scene of one bearing out of a list and the file of its type.
//!
//! The tables of the list that are not the bearing's are blanked, so that every line keeps its number; the type file is
//! included as `include` does it; what depends on the place is set: the shaft is prescribed, azimuth, weight and speeds
//! are turned into the bearing's frame.

use std::path::Path;

use assembly::Orientation;
use dynamics::ContactMode;
use dynamics::effects::{Context, Effects};
use input::{Clock, Problems};
use toml_edit::{DocumentMut, Item, Table, Value};

use super::super::messages::Messages;
use super::super::ring::MeshFiles;
use super::super::speed::RawSpeed;
use super::super::{Scene, SceneError, TextSource, edit, include};
use super::bodies;
use super::mounted::{BearingOnShaft, RawMounted, check_places};
use super::pairing::Pairing;
use super::shaft::{CommonShaft, ShaftKind};
use super::turned::{turn_region, turn_speed, turn_speeds, turn_weight};
use super::{OF_TYPE, ON_SHAFT, RawSeveral, SeveralScene, is_of_type, set};
use crate::tables::shaft::ShaftMotion;

/// Tables of the list that no bearing has, or that are given to it apart, or that a list is refused with.
const OF_LIST: [&str; 15] = [
    "bearing",
    "shaft",
    "pairing",
    "static",
    "sweep",
    "quasi_static",
    "dynamic",
    "modes",
    "profiles",
    "balls",
    "cage",
    "probes",
    "life",
    "heat",
    "lubricant",
];
/// Analyses over time, which every bearing has as the list has them.
const OVER_TIME: [&str; 2] = ["quasi_static", "dynamic"];

/// What a list is made into scenes with.
pub struct Composer<'a> {
    pub path: &'a Path,
    pub overrides: &'a [String],
    pub mesh_files: MeshFiles,
    pub whole: &'a include::WholeText,
    pub messages: Messages<'a>,
}

impl Composer<'_> {
    /// The scene of a list of bearings, checked.
    pub fn listed(
        &self,
        raw: RawSeveral,
        text: String,
        document: &DocumentMut,
    ) -> Result<SeveralScene, SceneError> {
        let mut problems = Problems::default();
        check_list(&raw, &mut problems);
        check_output(&raw, document, &mut problems);
        let pairing = raw.pairing.as_ref().map(|p| p.check(&raw.bearing, &mut problems));
        let pairing = pairing.unwrap_or_default();
        let at_rest = raw.analysis(document, &mut problems);
        let (scenes, told) = self.scenes(&raw, document, &pairing)?;
        let analysis = match raw.has_time() || raw.modes.is_some() {
            true => scenes.iter().flatten().map(|s| s.analysis.clone()).next(),
            false => at_rest,
        };
        check_places(&raw.bearing, &scenes, &mut problems);
        check_tangents(&raw.bearing, &scenes, &mut problems);
        let balls = scenes.iter().flatten().map(|s| s.bearing.ball_diameter);
        let largest_ball = balls.fold(0.0, f64::max);
        let shaft = raw.shaft.check(largest_ball, &mut problems);
        if let Some(shaft) = &shaft {
            check_ends(&raw.bearing, &scenes, shaft, &mut problems);
            check_axis(&raw.bearing, &pairing, shaft, &mut problems);
            check_unbalance(&raw, shaft, &mut problems);
        }
        let is_sound = problems.is_empty() && told.is_empty();
        let scenes: Option<Vec<Scene>> = scenes.into_iter().collect();
        let (Some(shaft), Some(analysis), Some(scenes), true) = (shaft, analysis, scenes, is_sound) else {
            return Err(self.invalid(problems.into_texts(), told));
        };
        let mounted = |(raw, scene): (&RawMounted, Scene)| BearingOnShaft {
            name: raw.name.clone(),
            position: raw.position.si(),
            orientation: raw.orientation().unwrap_or(Orientation::PlusZ),
            type_file: raw.r#type.clone(),
            scene,
        };
        let mut bearings: Vec<BearingOnShaft> = raw.bearing.iter().zip(scenes).map(mounted).collect();
        note_what_is_shared(&mut bearings, &raw);
        check_carried(&bearings, &shaft, &mut problems);
        if !problems.is_empty() {
            return Err(self.messages.invalid(problems.into_texts()));
        }
        let speed = speeds_of_shaft(&bearings[0]);
        Ok(SeveralScene {
            path: self.path.to_path_buf(),
            text,
            overrides: self.overrides.to_vec(),
            title: raw.title,
            bearings,
            shaft,
            pairing,
            effects: raw.effects,
            speed,
            analysis,
        })
    }

    /// Problems of the list, and those of its bearings, which say their lines already.
    fn invalid(&self, texts: Vec<String>, told: Vec<String>) -> SceneError {
        match self.messages.invalid(texts) {
            SceneError::Invalid {
                path,
                overrides,
                problems,
            } => SceneError::Invalid {
                path,
                overrides,
                problems: [problems, told].concat(),
            },
            other => other,
        }
    }

    /// The scene of every bearing that has one, and what is wrong with the others, each problem once.
    fn scenes(
        &self,
        raw: &RawSeveral,
        document: &DocumentMut,
        pairing: &Pairing,
    ) -> Result<(Vec<Option<Scene>>, Vec<String>), SceneError> {
        let (mut scenes, mut told) = (Vec::new(), Vec::new());
        for (number, bearing) in raw.bearing.iter().enumerate() {
            let sliding = pairing.spring.as_ref().filter(|spring| spring.bearing == number);
            match self.scene_of(bearing, document, sliding.map(|spring| spring.force)) {
                Ok(scene) => scenes.push(Some(scene)),
                Err(SceneError::Invalid { problems, .. }) => {
                    for problem in problems {
                        if !told.contains(&problem) {
                            told.push(problem);
                        }
                    }
                    scenes.push(None);
                }
                Err(other) => return Err(other),
            }
        }
        Ok((scenes, told))
    }

    /// The scene of a bearing, whose outer ring may be pressed by a spring, N.
    fn scene_of(
        &self,
        bearing: &RawMounted,
        list: &DocumentMut,
        spring: Option<f64>,
    ) -> Result<Scene, SceneError> {
        self.made(bearing, |document| {
            let orientation = bearing.orientation().unwrap_or(Orientation::PlusZ);
            OF_LIST
                .iter()
                .filter(|name| **name != "bearing")
                .for_each(|name| {
                    document.remove(name);
                });
            copy_shared(list, document, &ON_SHAFT);
            bodies::place(list, document, (&bearing.name, orientation));
            if let Some(azimuth) = &bearing.first_ball_azimuth {
                let own = orientation.turned_angle(azimuth.si());
                set(
                    document,
                    "bearing.first_ball_azimuth",
                    &format!("\"{own:?} rad\""),
                );
            }
            turn_weight(document, orientation);
            turn_speed(document, orientation);
            turn_region(document, orientation);
            if let Some(force) = spring {
                set(
                    document,
                    "effects.spring_preload.force",
                    &format!("\"{force:?} N\""),
                );
            }
            for (key, unit) in [
                ("x", "m"),
                ("y", "m"),
                ("z", "m"),
                ("tilt_x", "rad"),
                ("tilt_y", "rad"),
            ] {
                set(document, &format!("shaft.{key}"), &format!("\"0 {unit}\""));
            }
            set(document, "shaft.load_point", "\"0 m\"");
            for name in OVER_TIME {
                if let Some(analysis) = list.get(name) {
                    document.insert(name, analysis.clone());
                    return;
                }
            }
            edit::remove_series(document);
            match list.get("modes") {
                Some(modes) => document.insert("modes", modes.clone()),
                None => document.insert("static", Item::Table(Table::new())),
            };
        })
    }

    /// The scene with one table that a list of one bearing stands for.
    pub fn plain(&self, bearing: &RawMounted, list: DocumentMut) -> Result<Scene, SceneError> {
        self.made(bearing, |document| {
            for name in OF_LIST.iter().filter(|name| **name != "bearing") {
                if let Some(item) = list.get(name) {
                    document.insert(name, item.clone());
                }
            }
            copy_shared(&list, document, &[]);
            bodies::place(&list, document, (&bearing.name, Orientation::PlusZ));
            if let Some(shaft) = document.get_mut("shaft").and_then(Item::as_table_like_mut) {
                shaft.remove("model");
                if !shaft.contains_key("load_point") {
                    shaft.insert("load_point", Item::Value(Value::from("0 m")));
                }
            }
            if let Some(azimuth) = &bearing.first_ball_azimuth {
                set(document, "bearing.first_ball_azimuth", &format!("\"{azimuth}\""));
            }
        })
    }

    /// The scene of a type file and of what `change` makes of the tables that all bearings share.
    fn made(&self, bearing: &RawMounted, change: impl FnOnce(&mut DocumentMut)) -> Result<Scene, SceneError> {
        let is_shared = |names: &[String]| {
            let of_shaft = names.len() == 2 && names[0] == "effects" && ON_SHAFT.contains(&names[1].as_str());
            !of_shaft && !names.first().is_some_and(|name| OF_LIST.contains(&name.as_str()))
        };
        let whole = self
            .whole
            .with_type((&bearing.name, &bearing.r#type), &OF_TYPE, is_shared)
            .map_err(|error| self.at_bearing(error))?;
        let source = TextSource {
            path: self.path,
            overrides: self.overrides,
            mesh_files: self.mesh_files,
            messages: Messages {
                path: self.path,
                whole: &whole,
                overrides: self.overrides,
            },
        };
        let mut document = source.messages.document(&whole.text)?;
        for argument in self.overrides.iter().filter(|o| is_of_type(o)) {
            apply(&mut document, argument)?;
        }
        change(&mut document);
        let text = document.to_string();
        let document = source.messages.document(&text)?;
        let scene = source.check(text, &document)?;
        source.check_points(&scene)?;
        Ok(scene)
    }

    /// What is wrong with the file of a type.
    fn at_bearing(&self, error: include::TypeError) -> SceneError {
        match error {
            include::TypeError::There(error) => error,
            include::TypeError::Here(problem) => SceneError::Invalid {
                path: self.path.to_path_buf(),
                overrides: self.overrides.to_vec(),
                problems: vec![problem],
            },
        }
    }
}

/// Notes which bodies carry several bearings, and that an unbalance of the shaft turns the courses of their balls.
fn note_what_is_shared(bearings: &mut [BearingOnShaft], raw: &RawSeveral) {
    for bearing in bearings.iter_mut().filter(|_| raw.effects.unbalance.is_some()) {
        bearing.scene.effects.orbit_inertia = None;
    }
    let bodies = |bearing: &BearingOnShaft| bearing.scene.bodies.clone().into_iter().flatten();
    let names: Vec<String> = bearings.iter().flat_map(bodies).map(|body| body.name).collect();
    for body in bearings
        .iter_mut()
        .flat_map(|bearing| bearing.scene.bodies.iter_mut())
        .flatten()
    {
        body.is_shared = names.iter().filter(|name| **name == body.name).count() > 1;
    }
}

/// A body that carries several inner rings is the shaft between them, so nothing else may be.
fn check_carried(bearings: &[BearingOnShaft], shaft: &CommonShaft, problems: &mut Problems) {
    let on_shaft = bearings
        .iter()
        .filter_map(|bearing| bearing.scene.bodies[0].as_ref());
    let shared = on_shaft
        .filter(|body| body.is_shared)
        .map(|body| &body.name)
        .next();
    if let (Some(name), ShaftKind::Beam(_)) = (shared, &shaft.kind) {
        problems.add(format!(
            "shaft.model is \"beam\", but body {name:?} carries several inner rings, so that it is the shaft between \
             them; expected shaft.model = \"rigid\", which moves what is fixed of the body"
        ));
    }
}

/// Checks what is of the list alone.
fn check_list(raw: &RawSeveral, problems: &mut Problems) {
    raw.refuse(problems);
    check_loads(raw, problems);
    for (number, bearing) in (1..).zip(&raw.bearing) {
        bearing.check(number, problems);
    }
    bodies::check(&raw.body, &raw.names(), problems);
    if raw.bearing.is_empty() {
        problems.add("bearing is an empty list; expected at least one table [[bearing]]");
    }
}

/// Refuses tables of `[output]` that a list has over time only.
fn check_output(raw: &RawSeveral, list: &DocumentMut, problems: &mut Problems) {
    let output = list.get("output").and_then(Item::as_table_like);
    let output = output.filter(|_| !raw.has_time());
    let given = |name: &&str| output.is_some_and(|output| output.contains_key(name));
    for name in edit::OF_SERIES.into_iter().filter(given) {
        problems.add(format!(
            "[output.{name}] is for a list of bearings over time, [quasi_static] or [dynamic], only: at rest every \
             bearing has its own [static] or [modes] files; remove it"
        ));
    }
}

/// Checks the effects that load the shaft, which no bearing has.
fn check_loads(raw: &RawSeveral, problems: &mut Problems) {
    let turns = raw.effects.unbalance.is_some();
    let on_shaft = Effects {
        axial_force: raw.effects.axial_force.clone(),
        radial_force: raw.effects.radial_force.clone(),
        moment: raw.effects.moment.clone(),
        unbalance: raw.effects.unbalance.clone(),
        // It acts in every bearing, which does not know what turns with the shaft.
        orbit_inertia: raw.effects.orbit_inertia.clone().filter(|_| turns),
        ..Effects::default()
    };
    let context = Context {
        is_without_inertia: raw.dynamic.is_none(),
        clock: match raw.has_time() {
            true => Clock::Running,
            false => Clock::AtRest,
        },
        has_speed: raw.speed.as_ref().map_or([false; 2], RawSpeed::has),
        is_flexible: [false; 2],
        seat_diameters: [None; 2],
        has_expansion: [true; 2],
        has_lubricant: false,
        turning_mass: None,
        parts_courses: turns.then_some("[effects.unbalance]"),
        // Each bearing tells by itself.
        has_ball_centrifugal: true,
    };
    on_shaft.check(context, problems);
}

/// Applies a `--set` argument.
pub fn apply(document: &mut DocumentMut, argument: &str) -> Result<(), SceneError> {
    edit::apply_override(document, argument).map_err(|reason| SceneError::Override {
        argument: argument.to_string(),
        reason,
    })
}

/// Brings what the command line has changed in tables that all bearings share, and takes out what it has taken out;
/// `left_out` are effects.
fn copy_shared(list: &DocumentMut, document: &mut DocumentMut, left_out: &[&str]) {
    let is_shared = |name: &str| {
        !(OF_LIST.contains(&name) || OF_TYPE.contains(&name) || ["body", "include"].contains(&name))
    };
    document.retain(|name, _| !is_shared(name) || list.contains_key(name));
    for (name, item) in list.iter().filter(|(name, _)| is_shared(name)) {
        let mut item = item.clone();
        if let (true, Some(effects)) = (name == "effects", item.as_table_like_mut()) {
            left_out.iter().for_each(|effect| {
                effects.remove(effect);
            });
        }
        document.insert(name, item);
    }
}

/// The shaft is balanced by the tangents of its bearings, which facets and edges of grooves do not have.
fn check_tangents(raw: &[RawMounted], scenes: &[Option<Scene>], problems: &mut Problems) {
    for (bearing, scene) in raw.iter().zip(scenes) {
        let Some(scene) = scene else { continue };
        let (key, instead) = match (scene.contact.mode, scene.contact.edges) {
            (ContactMode::Facet, _) => ("contact.mode is \"facet\"", "contact.mode = \"patch\""),
            (_, true) => ("contact.edges is true", "contact.edges = false"),
            _ => continue,
        };
        problems.add(format!(
            "{key} in the type of bearing {:?}, {}: a list balances its shaft by the stiffness of each bearing, and \
             such contacts change it wherever a ball stands; expected {instead}, or one table [bearing]",
            bearing.name, bearing.r#type
        ));
    }
}

/// Bearings lie on the shaft.
fn check_ends(raw: &[RawMounted], scenes: &[Option<Scene>], shaft: &CommonShaft, problems: &mut Problems) {
    let (ends, text) = shaft.ends();
    let (first, last) = ends.into_inner();
    for (bearing, scene) in raw.iter().zip(scenes) {
        let Some(scene) = scene else { continue };
        let slack = scene.bearing.inner_groove_radius - 0.5 * scene.bearing.ball_diameter;
        let half = match shaft.kind {
            ShaftKind::Rigid(_) => 0.0,
            ShaftKind::Beam(_) => 0.5 * scene.bearing.width - slack,
        };
        let at = bearing.position.si();
        if at - half < first || at + half > last {
            problems.add(format!(
                "bearing.position of {:?} is {}: with its width of {:.3} mm it reaches beyond the shaft; expected \
                 {text}",
                bearing.name,
                bearing.position,
                1e3 * scene.bearing.width
            ));
        }
    }
}

/// Speeds as seen along the shaft, by those of one bearing.
fn speeds_of_shaft(bearing: &BearingOnShaft) -> Option<dynamics::kinematics::RingSpeeds> {
    let mut speeds = bearing.scene.speed.clone()?;
    turn_speeds(&mut speeds, bearing.orientation);
    Some(speeds)
}

/// The mass off the axis is on the shaft.
fn check_unbalance(raw: &RawSeveral, shaft: &CommonShaft, problems: &mut Problems) {
    let Some(unbalance) = &raw.effects.unbalance else {
        return;
    };
    let (ends, text) = shaft.ends();
    let at = unbalance.position();
    if !ends.contains(&at) {
        problems.add(format!(
            "effects.unbalance.position is {:.3} mm, which is off the shaft; expected {text}",
            1e3 * at
        ));
    }
}

/// Something holds the shaft along z.
fn check_axis(raw: &[RawMounted], pairing: &Pairing, shaft: &CommonShaft, problems: &mut Problems) {
    let is_free = match &shaft.kind {
        ShaftKind::Rigid(rigid) => rigid.motions[2] == ShaftMotion::Free,
        ShaftKind::Beam(_) => true,
    };
    let fixed = raw.len() - usize::from(pairing.spring.is_some());
    if is_free && fixed == 0 {
        problems.add(format!(
            "nothing holds the shaft along z: the outer ring of {:?}, the only bearing, slides; add a bearing whose \
             outer ring is fixed, or lock shaft.z of a rigid shaft",
            raw[0].name
        ));
    }
}
