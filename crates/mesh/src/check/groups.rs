//! Are the groups there that a mesh must have, and apart from each other?

use std::collections::BTreeSet;
use std::path::Path;

use crate::error::{MeshError, quoted_list};
use crate::mesh::{Facet, Mesh};
use crate::origin::Origin;

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

/// No facet may be in both groups.
pub fn require_apart(mesh: &Mesh, origin: &Origin, [first, second]: [&str; 2]) -> Result<(), MeshError> {
    let others: BTreeSet<Facet> = mesh.group(second).iter().copied().collect();
    let both = mesh.group(first).iter().find(|facet| others.contains(facet));
    both.map_or(Ok(()), |facet| {
        Err(MeshError::InBothGroups {
            path: origin.path.clone(),
            element: origin.element_tags[facet.element],
            first: first.to_string(),
            second: second.to_string(),
        })
    })
}
