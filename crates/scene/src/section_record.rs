//! What a mesh of `raceway mesh` was made from, kept in its file, so that a stale mesh is not solved in silence.
//!
//! The record lists the values of the scene that the mesh follows from, as `key = value` with lengths in mm. A scene
//! whose
//! `[inner.section]` or dimensions say something else is refused with the values and the command that builds its mesh.

use contact::Side;
use input::{shell_quoted, shell_word};
use mesh::MeshError;

use crate::error::BuildError;
use crate::tables::{FlexibleRing, MeshedSection, Scene, SectionElement};

/// What stands between two values.
const SEPARATOR: &str = "; ";

/// The record of the mesh of one ring.
pub fn record(scene: &Scene, side: Side, body: &FlexibleRing, section: &MeshedSection) -> String {
    let entries = entries(scene, side, body, section).into_iter();
    let entries: Vec<String> = entries.map(|(key, value)| format!("{key} = {value}")).collect();
    entries.join(SEPARATOR)
}

/// Fails when the file of a ring's mesh says that it was made from other values than the scene has. A file without a
/// record, and a scene without a section, cannot be compared.
pub fn require_fresh(
    scene: &Scene,
    side: Side,
    body: &FlexibleRing,
    section: Option<&MeshedSection>,
) -> Result<(), BuildError> {
    let Some(section) = section else { return Ok(()) };
    let Some(found) = mesh::read_record(&body.mesh)? else {
        return Ok(());
    };
    let differences = differences(&found, &entries(scene, side, body, section));
    if differences.is_empty() {
        return Ok(());
    }
    Err(BuildError::StaleMesh {
        path: body.mesh.clone(),
        differences: differences.join(", "),
        command: build_command(scene),
        key: side.name(),
    })
}

/// A sentence on a ring's mesh that cannot be compared with the section of its scene; None where it can, or where the
/// scene has none.
pub fn unrecorded(
    scene: &Scene,
    side: Side,
    body: &FlexibleRing,
    section: Option<&MeshedSection>,
) -> Option<String> {
    section?;
    // A file that cannot be read was refused before.
    if mesh::read_record(&body.mesh).ok()?.is_some() {
        return None;
    }
    Some(format!(
        "mesh {} does not say from which section it was made, so that it may be another one than [{}.section]; if \
         raceway mesh made it, build it anew: {}, which needs Gmsh",
        body.mesh.display(),
        side.name(),
        build_command(scene)
    ))
}

/// The command that builds the meshes of a scene anew.
pub fn build_command(scene: &Scene) -> String {
    let set = |argument: &String| format!(" --set {}", shell_quoted(argument));
    let overrides: String = scene.overrides.iter().map(set).collect();
    let file = shell_word(scene.path.display());
    format!("raceway mesh {file}{overrides} --force")
}

/// A misfit of groove and mesh with the command that builds the mesh, where the scene describes it.
pub fn with_command(mut error: MeshError, scene: &Scene, section: Option<&MeshedSection>) -> MeshError {
    if let (MeshError::OffTorus { advice, .. }, Some(_)) = (&mut error, section) {
        let command = build_command(scene);
        *advice = format!("{advice}, or build the mesh of this scene: {command}, which needs Gmsh").into();
    }
    error
}

/// Keys of the scene and their values.
fn entries(scene: &Scene, side: Side, body: &FlexibleRing, section: &MeshedSection) -> Vec<(String, String)> {
    let (b, ring) = (&scene.bearing, side.name());
    let held = [
        ("bore_diameter", b.bore_diameter),
        ("outside_diameter", b.outside_diameter),
    ][side.index()];
    let raceway = [b.inner_raceway_diameter, b.outer_raceway_diameter][side.index()];
    let groove = [b.inner_groove_radius, b.outer_groove_radius][side.index()];
    let element = match section.element {
        SectionElement::Hex8 => "hex8",
        SectionElement::Hex20 => "hex20",
        SectionElement::Tet10 => "tet10",
    };
    let shoulders = section.shoulder_diameters;
    let (low, high) = (millimetres(shoulders.at_low_z), millimetres(shoulders.at_high_z));
    let of_bearing = [
        (held.0.to_string(), millimetres(held.1)),
        (format!("{ring}_raceway_diameter"), millimetres(raceway)),
        (format!("{ring}_groove_radius"), millimetres(groove)),
        ("width".to_string(), millimetres(b.width)),
    ];
    let of_section = [
        ("shoulder_diameters", format!("[{low}, {high}]")),
        ("element", element.to_string()),
        ("sectors", section.sectors.to_string()),
        ("groove_elements", section.groove_elements.to_string()),
        ("thickness_elements", section.thickness_elements.to_string()),
        ("shoulder_elements", section.shoulder_elements.to_string()),
        ("grading", section.grading.to_string()),
    ];
    let of_bearing = of_bearing.map(|(key, value)| (format!("bearing.{key}"), value));
    let of_section = of_section.map(|(key, value)| (format!("{ring}.section.{key}"), value));
    let of_ring = (format!("{ring}.groove_z"), millimetres(body.groove_z));
    of_bearing
        .into_iter()
        .chain([of_ring])
        .chain(of_section)
        .collect()
}

/// The values that two records of one program have otherwise: `key = first and second`.
pub fn disagreements(first: &str, second: &str) -> Vec<String> {
    let pairs = first.split(SEPARATOR).zip(second.split(SEPARATOR));
    let values = pairs.filter(|(a, b)| a != b);
    values
        .map(|(a, b)| format!("{a} and {}", b.split_once(" = ").map_or(b, |(_, value)| value)))
        .collect()
}

/// A sentence for each value that a record has otherwise.
fn differences(record: &str, wanted: &[(String, String)]) -> Vec<String> {
    let known: Vec<(&str, &str)> = record
        .split(SEPARATOR)
        .filter_map(|entry| entry.split_once(" = "))
        .collect();
    let difference = |(key, value): &(String, String)| {
        let (_, made) = known.iter().find(|(known, _)| known == key)?;
        (made != value).then(|| format!("{key} = {made}, but the scene says {value}"))
    };
    wanted.iter().filter_map(difference).collect()
}

/// A length in mm to 1e-9 mm.
fn millimetres(metres: f64) -> String {
    let text = format!("{:.9}", 1e3 * metres);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    format!("{} mm", if text == "-0" { "0" } else { text })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a mesh of another section would pass, or one whose record knows fewer or more keys would be refused.
    #[test]
    fn only_values_that_differ_are_named() {
        let wanted = [
            ("a.b".to_string(), "6".to_string()),
            ("c".to_string(), "2 mm".to_string()),
        ];
        assert!(differences("a.b = 6; c = 2 mm; later = 1", &wanted).is_empty());
        assert!(differences("a.b = 6", &wanted).is_empty());
        assert_eq!(
            differences("a.b = 6; c = 2.5 mm", &wanted),
            ["c = 2.5 mm, but the scene says 2 mm"]
        );
        assert_eq!(
            disagreements("a.b = 6; c = 2 mm", "a.b = 7; c = 2 mm"),
            ["a.b = 6 and 7"]
        );
    }
}
