//! What every step file says about its run besides the scene: where the scene and the meshes came from, so that a
//! resumed run can tell whether they are still the same.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, anyhow};
use contact::Side;
use scene::{FlexibleRing, Scene, StressOutput};

/// Scene file, relative to the result folder.
pub const SCENE_FILE: &str = "scene_file";
/// Its `--set` arguments, one per line.
pub const OVERRIDES: &str = "overrides";
/// Commit of the program's source, `unknown` when it was not built from a repository; `+` marks changes beside it.
pub const COMMIT: &str = "commit";
/// Where the stress of the step file lives, and what it contains.
pub const STRESS: &str = "stress";
/// Warnings of the start of the run, one per line.
pub const WARNINGS: &str = "warnings";

/// Commit of the source of this program, as [`COMMIT`] says it.
pub const SOURCE_COMMIT: &str = env!("RACEWAY_COMMIT");

/// The texts of a run that writes into `dir`.
pub fn about(scene: &Scene, dir: &Path, warnings: &[String]) -> anyhow::Result<BTreeMap<String, String>> {
    let absolute = |path: &Path| {
        std::path::absolute(path).with_context(|| format!("cannot tell where {} is", path.display()))
    };
    let file = relative(&absolute(&scene.path)?, &absolute(dir)?);
    let mut texts = BTreeMap::from([
        (SCENE_FILE.to_string(), file.to_string_lossy().into_owned()),
        (OVERRIDES.to_string(), scene.overrides.join("\n")),
        (WARNINGS.to_string(), warnings.join("\n")),
        (COMMIT.to_string(), SOURCE_COMMIT.to_string()),
        (STRESS.to_string(), stress_text(scene)),
    ]);
    for side in Side::BOTH {
        if let Some(ring) = flexible(scene, side) {
            texts.insert(mesh_key(side), mesh_text(ring)?);
        }
    }
    Ok(texts)
}

/// Where stress lives and whether it contains the near field.
fn stress_text(scene: &Scene) -> String {
    let place = match scene.output.stress {
        StressOutput::None => return "none".to_string(),
        StressOutput::Nodal => {
            "at nodes: extrapolated from the integration points of every element, averaged by volume"
        }
        StressOutput::IntegrationPoints => "at the integration points of the elements, as computed",
    };
    match scene.stress.near_field_reach {
        Some(reach) => format!(
            "{place}; with the near field of contacts within {reach} larger semi-axes of their patches"
        ),
        None => format!("{place}; near contacts that of the spread patch, not of the Hertz ellipse"),
    }
}

/// Fails unless the meshes of the scene are, byte for byte, those that `texts` tells of.
pub fn require_same_meshes(scene: &Scene, texts: &BTreeMap<String, String>) -> anyhow::Result<()> {
    for side in Side::BOTH {
        let now = flexible(scene, side).map(mesh_text).transpose()?;
        let then = texts.get(&mesh_key(side));
        if now.as_ref() != then {
            let or_none = |text: Option<&String>| text.map_or("no mesh".to_string(), String::clone);
            return Err(anyhow!(
                "the mesh of the {} ring has changed since the run: it was {}, now it is {}; resume with the mesh of \
                 the run",
                side.name(),
                or_none(then),
                or_none(now.as_ref())
            ));
        }
    }
    Ok(())
}

fn flexible(scene: &Scene, side: Side) -> Option<&FlexibleRing> {
    match side {
        Side::Inner => scene.inner.body.as_ref(),
        Side::Outer => scene.outer.body.as_ref(),
    }
}

fn mesh_key(side: Side) -> String {
    format!("{}_mesh", side.name())
}

fn mesh_text(ring: &FlexibleRing) -> anyhow::Result<String> {
    let (length, crc) = checkpoint::file_checksum(&ring.mesh)?;
    Ok(format!(
        "{} ({length} bytes, checksum {crc:08x})",
        ring.mesh_as_typed
    ))
}

/// The path that leads from the folder `from` to `to`; both absolute.
fn relative(to: &Path, from: &Path) -> PathBuf {
    let (to, from) = (normal(to), normal(from));
    let shared = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let up = from[shared..].iter().map(|_| Path::new(".."));
    up.chain(to[shared..].iter().map(Path::new)).collect()
}

/// Names of an absolute path, with `..` taken back.
fn normal(path: &Path) -> Vec<&std::ffi::OsStr> {
    let mut names = Vec::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                names.pop();
            }
            Component::Normal(name) => names.push(name),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a resumed run would look for its scene in another place.
    #[test]
    fn a_scene_is_found_from_its_results() {
        let from = |to: &str, dir: &str| relative(Path::new(to), Path::new(dir)).display().to_string();
        assert_eq!(from("/a/scenes/s.toml", "/a/results/s"), "../../scenes/s.toml");
        assert_eq!(from("/a/b/../s.toml", "/a/out"), "../s.toml");
        assert_eq!(from("/a/out/s.toml", "/a/out"), "s.toml");
    }
}
