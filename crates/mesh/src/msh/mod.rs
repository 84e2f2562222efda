//! Reads and writes Gmsh's MSH files.
//!
//! Read: MSH 4.1, text and binary of either byte order, partitioned or not, with any numbering; MSH 2.2 text.
//! The elements of the physical volume `ring` are the mesh, each named physical surface is a facet group; points,
//! lines, unnamed groups, `$Periodic`, `$Comments` and unknown sections are skipped. Nodes and elements come in
//! the order of their tags, so that the same mesh, partitioned or not, gives the same bits. Every mesh read has
//! passed the checks of [`crate::check`].
//!
//! Cost: the file and its tables are held in memory, about four times the size of a binary file.

mod block;
mod body;
mod cursor;
mod facets;
mod raw;
pub mod record;
mod tags;
mod types;
mod v22;
mod v41;
pub mod write;

use std::path::Path;

use crate::check::check_mesh;
use crate::element::ElementKind;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::origin::Origin;

pub(crate) use body::{BODY, Wanted, named_boundary, not_boundary, select_body};
pub(crate) use raw::RawMsh;

/// The volume elements that are read.
const VOLUMES: Wanted = Wanted {
    name: BODY,
    dimension: 3,
    types: &[5, 17, 11],
    expected: "8-node hexahedra, 20-node hexahedra or 10-node tetrahedra",
};

/// Reads the ring of an MSH file whose lengths are in units of `unit` metres (0.001 for mm), and checks it.
pub fn read_msh(path: impl AsRef<Path>, unit: f64) -> Result<Mesh, MeshError> {
    read_msh_with_origin(path, unit).map(|(mesh, _)| mesh)
}

/// The same, with the tags by which later errors name nodes and elements.
pub fn read_msh_with_origin(path: impl AsRef<Path>, unit: f64) -> Result<(Mesh, Origin), MeshError> {
    check_scale(unit)?;
    mesh_of(&RawMsh::read(path.as_ref())?, path.as_ref(), unit)
}

/// The same of a body round a ring, such as a housing: the elements of the physical volume `body`.
pub fn read_body_msh(path: impl AsRef<Path>, unit: f64) -> Result<(Mesh, Origin), MeshError> {
    check_scale(unit)?;
    let wanted = Wanted {
        name: "body",
        ..VOLUMES
    };
    wanted_mesh(&RawMsh::read(path.as_ref())?, path.as_ref(), unit, &wanted)
}

/// Builds and checks the mesh of a file's contents.
pub(crate) fn mesh_of(raw: &RawMsh, path: &Path, unit: f64) -> Result<(Mesh, Origin), MeshError> {
    wanted_mesh(raw, path, unit, &VOLUMES)
}

fn wanted_mesh(raw: &RawMsh, path: &Path, unit: f64, wanted: &Wanted) -> Result<(Mesh, Origin), MeshError> {
    let body = select_body(raw, path, wanted)?;
    let surfaces = named_boundary(raw, &body, path, 2)?;
    let kind = match body.gmsh_type {
        17 => ElementKind::Hex20,
        11 => ElementKind::Tet10,
        _ => ElementKind::Hex8,
    };
    let order = kind.gmsh_order();
    let elements = body.connectivity.chunks_exact(body.n_nodes);
    let connectivity = elements
        .flat_map(|nodes| order.iter().map(|&i| nodes[i]))
        .collect();
    let nodes = body.nodes.iter().map(|x| x.map(|c| c * unit)).collect();
    let mut mesh = Mesh {
        kind,
        nodes,
        connectivity,
        groups: Default::default(),
    };
    mesh.groups = facets::facet_groups(&mesh, path, &surfaces)?;
    let origin = Origin {
        path: path.to_path_buf(),
        unit,
        node_tags: body.node_tags,
        element_tags: body.element_tags,
    };
    check_mesh(&mesh, &origin)?;
    Ok((mesh, origin))
}

/// A unit must be a positive finite length.
pub(crate) fn check_scale(unit: f64) -> Result<(), MeshError> {
    if unit.is_finite() && unit > 0.0 {
        Ok(())
    } else {
        Err(MeshError::BadUnit { unit })
    }
}

#[cfg(test)]
mod tests;
