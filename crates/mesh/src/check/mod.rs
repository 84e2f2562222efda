//! What must hold before a mesh is worth computing on: shape, topology, groups, and the bearing it is meant for.
//!
//! Every check names the file, Gmsh's tag of the node or element, and what to do.

mod fit;
mod groups;
mod shape;
mod topology;
mod whole;

use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::origin::Origin;

pub use fit::{check_torus, check_unit};
pub use groups::{require_apart, require_groups};
pub(crate) use shape::worst_element;
pub(crate) use topology::{check_coincident_nodes, check_connected};
pub use whole::{Coverage, Cylinder, CylinderPart, Revolved, check_whole, coverage};

/// Runs the checks that need nothing but the mesh: det J, coincident nodes, elements that stand twice, one connected
/// part. Cost: about 47 determinants per 20-node hexahedron and one sort of the nodes and of the elements.
pub fn check_mesh(mesh: &Mesh, origin: &Origin) -> Result<(), MeshError> {
    topology::check_coincident(mesh, origin)?;
    topology::check_once(mesh, origin)?;
    shape::check_shape(mesh, origin)?;
    check_connected(mesh.n_nodes(), mesh.kind.n_nodes(), &mesh.connectivity, origin)
}
