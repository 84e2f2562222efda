//! What every step file says about its run besides the scene: where the scene and the meshes came from, so that a
//! resumed run can tell whether they are still the same.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, anyhow};
use contact::Side;
use scene::{FlexibleRing, Scene, StressOutput, difference, named_files};

/// Scene file, relative to the result folder.
pub const SCENE_FILE: &str = "scene_file";
/// Its `--set` arguments, one per line.
pub const OVERRIDES: &str = "overrides";
/// Commit of the program's source, `unknown` when it was not built from a repository; `+` marks changes beside it.
pub const COMMIT: &str = "commit";
/// Other files that the scene names, such as tables of profiles and matrices of bodies: a line for the key and checksum
/// of each.
const FILES: &str = "files";
/// Where the stress of the step file lives, and what it contains.
pub const STRESS: &str = "stress";
/// Warnings of the start of the run, one per line.
pub const WARNINGS: &str = "warnings";

/// Commit of the source of this program, as [`COMMIT`] says it.
pub const SOURCE_COMMIT: &str = env!("RACEWAY_COMMIT");

/// Keys and tables of a scene that a resumed run may change: none of them touches what it computes.
pub const MAY_CHANGE: [&str; 6] = [
    "dynamic.duration",
    "dynamic.output_every",
    "quasi_static.duration",
    "quasi_static.output_every",
    "output",
    "life",
];

/// Identity of a run, which all its files carry: a fingerprint of its scene, without [`MAY_CHANGE`], and of its
/// meshes. Runs with one identity compute the same, so that a file of one is as good as that of another. The form
/// of the fingerprint must not change: a resumed run finds its own files by it.
pub fn identity(scene: &Scene) -> anyhow::Result<String> {
    let keys = difference("", &scene.text)?;
    let lasting = keys.iter().filter(|key| !key.is_below(&MAY_CHANGE));
    let mut lines: Vec<String> = lasting
        .map(|key| format!("{} = {}", key.key, key.after.as_deref().unwrap_or_default()))
        .collect();
    for side in Side::BOTH {
        let mesh = flexible(scene, side).map(mesh_text).transpose()?;
        lines.push(format!("{} {}", side.name(), mesh.unwrap_or_default()));
    }
    let of_bodies = files(scene)?
        .into_iter()
        .filter(|(key, _)| key.starts_with("body."));
    lines.extend(of_bodies.map(|(key, text)| format!("{key} {text}")));
    let numbers: Vec<u8> = scene.profiles.from_files().flat_map(f64::to_le_bytes).collect();
    if !numbers.is_empty() {
        lines.push(format!("profiles {:016x}", fingerprint(&numbers)));
    }
    Ok(format!("{:016x}", fingerprint(lines.join("\n").as_bytes())))
}

/// FNV-1a of 64 bits (Fowler, Noll, Vo 1991): told apart, not protected against forgery.
fn fingerprint(bytes: &[u8]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

/// The texts of a run that writes into `dir`.
pub fn about(scene: &Scene, dir: &Path, warnings: &[String]) -> anyhow::Result<BTreeMap<String, String>> {
    let file = path_from(dir, &scene.path)?;
    let mut texts = BTreeMap::from([
        (SCENE_FILE.to_string(), file.to_string_lossy().into_owned()),
        (OVERRIDES.to_string(), scene.overrides.join("\n")),
        (WARNINGS.to_string(), warnings.join("\n")),
        (COMMIT.to_string(), SOURCE_COMMIT.to_string()),
        (STRESS.to_string(), stress_text(scene)),
    ]);
    let files = files(scene)?.into_iter();
    let files: Vec<String> = files.map(|(key, text)| format!("{key} {text}")).collect();
    if !files.is_empty() {
        texts.insert(FILES.to_string(), files.join("\n"));
    }
    for side in Side::BOTH {
        if let Some(ring) = flexible(scene, side) {
            texts.insert(mesh_key(side), mesh_text(ring)?);
        }
    }
    Ok(texts)
}

/// Where stress lives and whether it contains the near field; which contacts are not Hertz's.
fn stress_text(scene: &Scene) -> String {
    if scene.output.stress == StressOutput::None {
        return "none".to_string();
    }
    let marked = match scene.contact.edges || scene.profiles.has_profiles() {
        true => "; not Hertz's at contacts that balls.csv marks as edge or profile",
        false => "",
    };
    stress_place(scene) + marked
}

fn stress_place(scene: &Scene) -> String {
    let rounded = scene
        .output
        .stress_error
        .map_or(String::new(), |error| format!("; rounded, by at most {error} Pa"));
    let place = match scene.output.stress {
        StressOutput::None => "none",
        StressOutput::Nodal => {
            "at nodes: extrapolated from the integration points of every element, averaged by volume"
        }
        StressOutput::IntegrationPoints => "at the integration points of the elements, as computed",
    };
    match scene.stress.near_field_reach {
        Some(reach) => format!(
            "{place}; with the near field of contacts within {reach} larger semi-axes of their patches{rounded}"
        ),
        None => format!("{place}; near contacts that of the spread patch, not of the Hertz ellipse{rounded}"),
    }
}

/// Fails unless meshes and other files of the scene are, byte for byte, those that `texts` tells of.
pub fn require_named_files(scene: &Scene, texts: &BTreeMap<String, String>) -> anyhow::Result<()> {
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
    require_same_files(scene, texts.get(FILES))
}

/// Fails unless the other files are those of a text.
fn require_same_files(scene: &Scene, then: Option<&String>) -> anyhow::Result<()> {
    let now = files(scene)?;
    let lines = then.map_or("", String::as_str).lines();
    for (key, was) in lines.filter_map(|line| line.split_once(' ')) {
        let is = now.iter().find(|(name, _)| name == key).map(|(_, text)| text);
        if is.is_none_or(|is| is != was) {
            return Err(anyhow!(
                "the file of {key} has changed since the run: it was {was}, now it is {}; resume with the file of the \
                 run",
                is.map_or("not there", String::as_str)
            ));
        }
    }
    Ok(())
}

/// Keys and checksums of files that touch what a scene computes, but those of rings.
fn files(scene: &Scene) -> anyhow::Result<Vec<(String, String)>> {
    let is_mesh = |key: &str| {
        Side::BOTH
            .iter()
            .any(|side| key == format!("{}.mesh", side.name()))
    };
    let may_change = |key: &str| MAY_CHANGE.iter().any(|root| key.starts_with(&format!("{root}.")));
    let named = named_files(scene)?.into_iter();
    let lasting = named.filter(|(key, _)| !is_mesh(key) && !may_change(key));
    lasting
        .map(|(key, path)| Ok((key, checksum_text(&path)?)))
        .collect()
}

fn flexible(scene: &Scene, side: Side) -> Option<&FlexibleRing> {
    side.choose(scene.inner.body.as_ref(), scene.outer.body.as_ref())
}

fn mesh_key(side: Side) -> String {
    format!("{}_mesh", side.name())
}

fn mesh_text(ring: &FlexibleRing) -> anyhow::Result<String> {
    Ok(format!("{} {}", ring.mesh_as_typed, checksum_text(&ring.mesh)?))
}

/// Length and checksum of a file.
pub fn checksum_text(path: &Path) -> anyhow::Result<String> {
    let (length, crc) = checkpoint::file_checksum(path)?;
    Ok(format!("({length} bytes, checksum {crc:08x})"))
}

/// The scene file that a step file of the folder `dir` tells of.
pub fn scene_file(dir: &Path, stored: &str) -> PathBuf {
    let path = dir.join(stored);
    // Earlier versions made the path by its text, which fails behind a link.
    let by_text = || {
        let absolute = std::path::absolute(dir).ok()?.join(stored);
        let names = normal(&absolute).into_iter();
        let path = names.fold(PathBuf::from("/"), |path, name| path.join(name));
        path.exists().then_some(path)
    };
    if path.exists() {
        return tidy(&path);
    }
    by_text().unwrap_or(path)
}

/// The path that leads from a folder to a file, both given from here.
pub fn path_from(dir: &Path, file: &Path) -> anyhow::Result<PathBuf> {
    let absolute = |path: &Path| {
        std::path::absolute(path).with_context(|| format!("cannot tell where {} is", path.display()))
    };
    let whole = absolute(file)?;
    let (folder, name) = (whole.parent(), whole.file_name());
    // Meshes are found from the folder of the scene as it was typed: a scene that is a link itself stays one.
    let file = physical(folder.unwrap_or(Path::new("/"))).join(name.unwrap_or_default());
    Ok(relative(&file, &physical(&absolute(dir)?)))
}

/// The path without steps into a folder and out again, for people: `scenes/a.toml` for `studies/../scenes/a.toml`.
/// Left as it is where that would lead elsewhere, as through a link.
pub fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        let can_go_back = matches!(tidy.components().next_back(), Some(Component::Normal(_)));
        match part {
            Component::ParentDir if can_go_back => {
                tidy.pop();
            }
            _ => tidy.push(part),
        }
    }
    let same = tidy.canonicalize().ok() == path.canonicalize().ok();
    if same { tidy } else { path.to_path_buf() }
}

/// A folder without links, as the system follows a path from it; as it is if it is not there.
fn physical(folder: &Path) -> PathBuf {
    folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf())
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

    /// Wrong: results of an earlier version would be taken for those of another run. The values are those of
    /// the published test vectors of FNV-1a.
    #[test]
    fn fingerprints_stay_as_they_are() {
        assert_eq!(fingerprint(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fingerprint(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fingerprint(b"foobar"), 0x8594_4171_f739_67e8);
    }

    /// Wrong: a resumed run would look for its scene in another place.
    #[test]
    fn a_scene_is_found_from_its_results() {
        let from = |to: &str, dir: &str| relative(Path::new(to), Path::new(dir)).display().to_string();
        assert_eq!(from("/a/scenes/s.toml", "/a/results/s"), "../../scenes/s.toml");
        assert_eq!(from("/a/b/../s.toml", "/a/out"), "../s.toml");
        assert_eq!(from("/a/out/s.toml", "/a/out"), "s.toml");
    }
}
