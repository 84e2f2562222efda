//! Where a mesh came from, so that errors can name the file and Gmsh's own numbers.

use std::path::{Path, PathBuf};

use crate::mesh::Mesh;

/// File, unit and tags of a mesh. Kept beside [`Mesh`], 8 bytes per node and element.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// File the mesh was read from, or a description of how it was made.
    pub path: PathBuf,
    /// Metres per unit of the file.
    pub unit: f64,
    /// Gmsh tags of the nodes, `[n_nodes]`, increasing.
    pub node_tags: Vec<u64>,
    /// Gmsh tags of the elements, `[n_elements]`, increasing.
    pub element_tags: Vec<u64>,
}

impl Origin {
    /// Origin of a mesh made in the program: tags count from 1, as [`crate::write_msh`] writes them.
    pub fn of_generated(name: impl AsRef<Path>, unit: f64, mesh: &Mesh) -> Origin {
        Origin {
            path: name.as_ref().to_path_buf(),
            unit,
            node_tags: (1..=mesh.n_nodes() as u64).collect(),
            element_tags: (1..=mesh.n_elements() as u64).collect(),
        }
    }
}
