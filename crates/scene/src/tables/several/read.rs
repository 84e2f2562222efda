//! Reads scenes of either kind: with one bearing, or with a list of them.

use std::path::Path;

use input::Problems;
use toml_edit::DocumentMut;

use super::compose::{Composer, apply};
use super::{RawSeveral, SeveralScene, bodies, is_of_type, is_plain};
use crate::tables::messages::Messages;
use crate::tables::ring::MeshFiles;
use crate::tables::sweep::Analysis;
use crate::tables::{Scene, SceneError, include};

/// A scene of either kind.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyScene {
    /// With one bearing.
    One(Box<Scene>),
    /// With a list of bearings.
    Several(Box<SeveralScene>),
}

impl AnyScene {
    /// Reads and checks a scene file; `overrides` are `path=value`. Mesh files must exist.
    pub fn load(path: &Path, overrides: &[String]) -> Result<AnyScene, SceneError> {
        AnyScene::load_with(path, overrides, MeshFiles::MustExist)
    }

    /// The same without its unbalance, and whether it had one.
    pub fn without_unbalance(self) -> (AnyScene, bool) {
        match self {
            AnyScene::One(mut scene) => {
                let had = scene.effects.unbalance.take().is_some();
                (AnyScene::One(scene), had)
            }
            AnyScene::Several(mut list) => {
                for bearing in &mut list.bearings {
                    bearing.scene.effects.unbalance = None;
                }
                let had = list.effects.unbalance.take().is_some();
                (AnyScene::Several(list), had)
            }
        }
    }

    /// Reads and checks a scene file; `mesh_files` says whether the meshes have to be there already.
    pub fn load_with(
        path: &Path,
        overrides: &[String],
        mesh_files: MeshFiles,
    ) -> Result<AnyScene, SceneError> {
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::unreadable(path, &error))?;
        AnyScene::parse(&text, path, overrides, mesh_files)
    }

    /// Checks the text of a scene; `path` is for messages and its folder is where relative paths start.
    pub fn parse(
        text: &str,
        path: &Path,
        overrides: &[String],
        mesh_files: MeshFiles,
    ) -> Result<AnyScene, SceneError> {
        let whole = include::whole(text, path, overrides)?;
        let messages = Messages {
            path,
            whole: &whole,
            overrides,
        };
        let is_list = |document: &DocumentMut| {
            document
                .get("bearing")
                .is_some_and(|item| item.is_array_of_tables() || item.is_array())
        };
        let document = match messages.document(&whole.text) {
            Ok(document) if is_list(&document) => document,
            _ => {
                return Scene::parse_one(text, path, overrides, mesh_files)
                    .map(|s| AnyScene::One(Box::new(s)));
            }
        };
        let composer = Composer {
            path,
            overrides,
            mesh_files,
            whole: &whole,
            messages,
        };
        several(&composer, document)
    }
}

impl Scene {
    /// Reads and checks a scene file; `overrides` are `path=value`. Mesh files must exist.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
        Scene::load_with(path, overrides, MeshFiles::MustExist)
    }

    /// Reads and checks a scene file; `mesh_files` says whether the meshes have to be there already.
    pub fn load_with(path: &Path, overrides: &[String], mesh_files: MeshFiles) -> Result<Scene, SceneError> {
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::unreadable(path, &error))?;
        Scene::parse(&text, path, overrides, mesh_files)
    }

    /// Checks the text of a scene; `path` is for messages and its folder is where relative paths start. A list of
    /// bearings is no such scene, unless it has one bearing and says no more than one table does.
    pub fn parse(
        text: &str,
        path: &Path,
        overrides: &[String],
        mesh_files: MeshFiles,
    ) -> Result<Scene, SceneError> {
        match AnyScene::parse(text, path, overrides, mesh_files)? {
            AnyScene::One(scene) => Ok(*scene),
            AnyScene::Several(_) => Err(SceneError::Several {
                path: path.to_path_buf(),
            }),
        }
    }

    /// The same scene with its shaft prescribed at a displacement, m and rad: what a bearing of a list leaves behind
    /// can be run by itself.
    pub fn with_shaft_at(&self, displacement: [f64; 5]) -> Result<Scene, SceneError> {
        let overrides: Vec<String> = ["x", "y", "z", "tilt_x", "tilt_y"]
            .iter()
            .zip(displacement)
            .enumerate()
            .map(|(i, (key, q))| {
                let unit = if i < 3 { "m" } else { "rad" };
                format!("shaft.{key}=\"{q:?} {unit}\"")
            })
            .collect();
        let scene = Scene::parse(&self.text, &self.path, &overrides, MeshFiles::MayBeMissing)?;
        Ok(Scene {
            overrides: self.overrides.clone(),
            ..scene
        })
    }
}

impl SeveralScene {
    /// The scenes of the points of a sweep, in order; none for any other scene.
    pub fn sweep_scenes(&self) -> Result<Vec<SeveralScene>, SceneError> {
        let Analysis::Sweep(sweep) = &self.analysis else {
            return Ok(Vec::new());
        };
        let point = |text: &str| -> Result<SeveralScene, SceneError> {
            match AnyScene::parse(text, &self.path, &self.type_overrides(), MeshFiles::MayBeMissing)? {
                AnyScene::Several(scene) => Ok(*scene),
                AnyScene::One(_) => Err(SceneError::Invalid {
                    path: self.path.clone(),
                    overrides: Vec::new(),
                    problems: vec!["a point of the sweep has one bearing alone; expected a list".to_string()],
                }),
            }
        };
        sweep.points.iter().map(|p| point(&p.text)).collect()
    }
}

/// The scene of a list, which `document` is before overrides.
fn several(composer: &Composer<'_>, mut document: DocumentMut) -> Result<AnyScene, SceneError> {
    let of_list = |o: &&String| !include::is_of_include(o) && !is_of_type(o);
    for argument in composer.overrides.iter().filter(of_list) {
        apply(&mut document, argument)?;
    }
    let text = document.to_string();
    let raw: RawSeveral = composer.messages.read(&text)?;
    let mut problems = Problems::default();
    if is_plain(&raw) {
        raw.bearing[0].check(1, &mut problems);
        bodies::check(&raw.body, &raw.names(), &mut problems);
        return match problems.into_texts() {
            none if none.is_empty() => composer
                .plain(&raw.bearing[0], document)
                .map(|s| AnyScene::One(Box::new(s))),
            texts => Err(composer.messages.invalid(texts)),
        };
    }
    let scene = composer.listed(raw, text, &document)?;
    check_points(composer, &scene)?;
    Ok(AnyScene::Several(Box::new(scene)))
}

/// Every point of a sweep must be a valid scene before the first is solved.
fn check_points(composer: &Composer<'_>, scene: &SeveralScene) -> Result<(), SceneError> {
    let Analysis::Sweep(sweep) = &scene.analysis else {
        return Ok(());
    };
    for (i, point) in sweep.points.iter().enumerate() {
        let found = AnyScene::parse(
            &point.text,
            composer.path,
            &scene.type_overrides(),
            MeshFiles::MayBeMissing,
        );
        if let Err(error) = found {
            let reason = match error {
                SceneError::Invalid { problems, .. } => problems.join("; "),
                SceneError::Format { message, .. } => message,
                other => other.to_string(),
            };
            return Err(composer.messages.invalid(vec![format!(
                "point {i} of the sweep ({} = {}): {reason}",
                sweep.column, point.value
            )]));
        }
    }
    Ok(())
}
