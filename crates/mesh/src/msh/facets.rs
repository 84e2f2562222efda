//! Finds the volume element behind each named surface element.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::body::{BoundaryElement, not_boundary};
use crate::error::MeshError;
use crate::mesh::{Facet, Mesh};

/// Sorted corners of a face; a triangle has `usize::MAX` last.
type FaceCorners = [usize; 4];

/// The facets of one key: the first, and how many there are.
type Behind = HashMap<FaceCorners, (Facet, usize)>;

/// Facet groups of `mesh` (whose groups are still empty) from surface elements, sorted by element and face.
pub(crate) fn facet_groups(
    mesh: &Mesh,
    path: &Path,
    surfaces: &BTreeMap<String, Vec<BoundaryElement>>,
) -> Result<BTreeMap<String, Vec<Facet>>, MeshError> {
    let behind = faces_near(mesh, surfaces);
    let mut groups = BTreeMap::new();
    for (name, elements) in surfaces {
        let mut facets = Vec::with_capacity(elements.len());
        for (tag, nodes) in elements {
            let facet =
                find(mesh, &behind, nodes).map_err(|problem| not_boundary(path, name, *tag, problem))?;
            facets.push((facet, *tag));
        }
        facets.sort_unstable();
        if let Some(pair) = facets.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(not_boundary(
                path,
                name,
                pair[1].1,
                "the same face as another element of the group",
            ));
        }
        groups.insert(name.clone(), facets.into_iter().map(|(facet, _)| facet).collect());
    }
    Ok(groups)
}

/// The one facet with these nodes, or what is wrong.
fn find(mesh: &Mesh, behind: &Behind, nodes: &[usize]) -> Result<Facet, &'static str> {
    let kind = mesh.kind.facet_kind();
    if nodes.len() != kind.n_nodes() {
        return Err("of another order or shape than the faces of the volume elements");
    }
    let (facet, count) = behind
        .get(&key(nodes[..kind.n_corners()].iter().copied()))
        .ok_or("no face of it")?;
    if *count > 1 {
        return Err("inside it, between two elements");
    }
    let mut mine: Vec<usize> = nodes.to_vec();
    let mut theirs: Vec<usize> = mesh.facet_nodes(*facet).collect();
    mine.sort_unstable();
    theirs.sort_unstable();
    if mine == theirs {
        Ok(*facet)
    } else {
        Err("a face of it with other mid-nodes")
    }
}

/// All faces of the volume elements whose corners lie on named surfaces.
fn faces_near(mesh: &Mesh, surfaces: &BTreeMap<String, Vec<BoundaryElement>>) -> Behind {
    let mut on_surface = vec![false; mesh.n_nodes()];
    for (_, nodes) in surfaces.values().flatten() {
        nodes.iter().for_each(|&n| on_surface[n] = true);
    }
    let n_corners = mesh.kind.facet_kind().n_corners();
    let mut behind = Behind::new();
    for element in 0..mesh.n_elements() {
        for face in 0..mesh.kind.n_faces() {
            let facet = Facet { element, face };
            if mesh.facet_nodes(facet).take(n_corners).all(|n| on_surface[n]) {
                let corners = key(mesh.facet_nodes(facet).take(n_corners));
                behind.entry(corners).or_insert((facet, 0)).1 += 1;
            }
        }
    }
    behind
}

fn key(corners: impl Iterator<Item = usize>) -> FaceCorners {
    let mut key = [usize::MAX; 4];
    for (slot, corner) in key.iter_mut().zip(corners) {
        *slot = corner;
    }
    key.sort_unstable();
    key
}
