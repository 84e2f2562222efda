//! What must hold before a mesh is worth computing on: shape, topology, groups, and the bearing it is meant for.
//!
//! Every check names the file, Gmsh's tag of the node or element, and what to do.

mod fit;
mod shape;
mod topology;
mod whole;

use std::path::Path;

use crate::error::{MeshError, quoted_list};
use crate::mesh::Mesh;
use crate::origin::Origin;

pub use fit::{Torus, check_torus, check_unit};
pub(crate) use shape::worst_element;
pub(crate) use topology::{check_coincident_nodes, check_connected};
pub use whole::{Coverage, Cylinder, Revolved, check_whole, coverage};

/// Runs the checks that need nothing but the mesh: det J, coincident nodes, one connected part.
/// Cost: about 47 determinants per 20-node hexahedron and one sort of the nodes.
pub fn check_mesh(mesh: &Mesh, origin: &Origin) -> Result<(), MeshError> {
    topology::check_coincident(mesh, origin)?;
    shape::check_shape(mesh, origin)?;
    check_connected(mesh.n_nodes(), mesh.kind.n_nodes(), &mesh.connectivity, origin)
}

/// Every name must be a facet group of `mesh` with at least one facet; `path` is for the message.
pub fn require_groups(mesh: &Mesh, path: impl AsRef<Path>, names: &[&str]) -> Result<(), MeshError> {
    let missing = |problem, name: &str| MeshError::MissingGroup {
        path: path.as_ref().to_path_buf(),
        problem,
        name: name.to_string(),
        groups: quoted_list(mesh.groups.keys().map(String::as_str)),
    };
    for &name in names {
        match mesh.groups.get(name) {
            None => return Err(missing("no", name)),
            Some(facets) if facets.is_empty() => return Err(missing("an empty", name)),
            Some(_) => {}
        }
    }
    Ok(())
}
