//! Reads a section from a 2-D Gmsh file: x = r, y = z, physical surface `ring`, named physical curves.

use std::path::Path;

use super::Section;
use crate::error::MeshError;
use crate::msh::{BODY, RawMsh, Wanted, check_scale, named_boundary, not_boundary, select_body};
use crate::origin::Origin;

/// The surface elements that are read.
const QUADS: Wanted = Wanted {
    name: BODY,
    dimension: 2,
    types: &[3],
    expected: "4-node quadrangles",
};

/// A node is in the plane when its third coordinate is below this share of the section's extent.
const PLANAR: f64 = 1e-9;

/// Reads the section of a ring from an MSH file whose lengths are in units of `unit` metres.
pub fn read_section(path: impl AsRef<Path>, unit: f64) -> Result<Section, MeshError> {
    read_section_with_origin(path, unit).map(|(section, _)| section)
}

/// The same, with the tags of its nodes and quads.
pub fn read_section_with_origin(path: impl AsRef<Path>, unit: f64) -> Result<(Section, Origin), MeshError> {
    check_scale(unit)?;
    section_of(&RawMsh::read(path.as_ref())?, path.as_ref(), unit)
}

/// Builds the section of a file's contents.
pub(crate) fn section_of(raw: &RawMsh, path: &Path, unit: f64) -> Result<(Section, Origin), MeshError> {
    let body = select_body(raw, path, &QUADS)?;
    let extent = body.nodes.iter().flatten().fold(0.0_f64, |e, c| e.max(c.abs()));
    if let Some(i) = body.nodes.iter().position(|x| x[2].abs() > PLANAR * extent) {
        let (tag, z) = (body.node_tags[i], body.nodes[i][2]);
        let problem = format!(
            "node {tag} has the third coordinate {z:e}; expected 0, a section lies in the plane x = radius, y = axial \
             position; turn the drawing, or read a 3-D mesh as such"
        );
        return Err(MeshError::Section {
            path: path.to_path_buf(),
            problem,
        });
    }
    let mut groups = std::collections::BTreeMap::new();
    for (name, lines) in named_boundary(raw, &body, path, 1)? {
        let mut edges = Vec::with_capacity(lines.len());
        for (tag, nodes) in lines {
            let Ok(pair) = <[usize; 2]>::try_from(nodes) else {
                return Err(not_boundary(
                    path,
                    &name,
                    tag,
                    "of another order than the edges of the quads",
                ));
            };
            edges.push((tag, pair));
        }
        groups.insert(name, edges);
    }
    let points = body.nodes.iter().map(|x| [x[0] * unit, x[1] * unit]).collect();
    let quads = body
        .connectivity
        .chunks_exact(4)
        .map(|q| [q[0], q[1], q[2], q[3]])
        .collect();
    let (node_tags, element_tags) = (body.node_tags, body.element_tags);
    let origin = Origin {
        path: path.to_path_buf(),
        unit,
        node_tags,
        element_tags,
    };
    let section = Section::checked(points, quads, groups, &origin)?;
    Ok((section, origin))
}
