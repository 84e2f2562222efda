//! Are the groups there that a mesh must have?

use std::path::Path;

use crate::error::{MeshError, quoted_list};
use crate::mesh::Mesh;

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
