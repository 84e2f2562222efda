//! Picks the ring out of a file: its elements, its nodes and its named boundary, by index instead of tag.

use std::collections::BTreeMap;
use std::path::Path;

use super::block::ElementBlock;
use super::raw::RawMsh;
use super::tags::TagMap;
use super::types::{gmsh_type, remedy};
use crate::error::{MeshError, quoted_list};

/// Name of the physical group that holds the ring's elements.
pub(crate) const BODY: &str = "ring";

/// What a body is made of.
pub(crate) struct Wanted {
    /// Name of the physical group.
    pub(crate) name: &'static str,
    /// 3 for a mesh, 2 for a section.
    pub(crate) dimension: usize,
    /// Gmsh element types that are read.
    pub(crate) types: &'static [i64],
    /// The same in words.
    pub(crate) expected: &'static str,
}

impl Wanted {
    fn noun(&self) -> &'static str {
        if self.dimension == 3 { "Volume" } else { "Surface" }
    }
}

/// Elements of one type and their nodes, both in the order of their tags.
pub(crate) struct MeshBody {
    /// Gmsh element type of all.
    pub(crate) gmsh_type: i64,
    /// Nodes per element.
    pub(crate) n_nodes: usize,
    pub(crate) node_tags: Vec<u64>,
    /// Coordinates in the file's unit.
    pub(crate) nodes: Vec<[f64; 3]>,
    pub(crate) element_tags: Vec<u64>,
    /// Node indices in Gmsh's order, `[n_elements][n_nodes]`, flat.
    pub(crate) connectivity: Vec<usize>,
}

/// A named element of the boundary: its tag and node indices.
pub(crate) type BoundaryElement = (u64, Vec<usize>);

/// Extracts the elements of the wanted group.
pub(crate) fn select_body(raw: &RawMsh, path: &Path, wanted: &Wanted) -> Result<MeshBody, MeshError> {
    let numbers = raw.numbers(wanted.dimension, wanted.name);
    let blocks = blocks_of(raw, wanted.dimension, &numbers);
    let Some(first) = blocks.first() else {
        return Err(MeshError::NoBody {
            path: path.to_path_buf(),
            kind: wanted.noun(),
            name: wanted.name,
            groups: quoted_list(raw.names_of(wanted.dimension)),
        });
    };
    let gmsh_type = first.gmsh_type;
    let n_nodes = first.n_nodes;
    check_types(&blocks, path, wanted)?;

    let all_tags: Vec<u64> = raw.nodes.iter().map(|node| node.0).collect();
    let map = TagMap::new(&all_tags);
    let used = check_nodes(raw, &numbers, path, wanted, &map)?;
    let mut index = vec![usize::MAX; all_tags.len()];
    let (mut node_tags, mut nodes) = (Vec::new(), Vec::new());
    for (i, node) in raw
        .nodes
        .iter()
        .enumerate()
        .filter(|(i, _)| used[*i] == Use::Body)
    {
        index[i] = nodes.len();
        node_tags.push(node.0);
        nodes.push(node.1);
    }

    let mut elements: Vec<(u64, &[u64])> = Vec::new();
    for block in &blocks {
        elements.extend(block.tags.iter().copied().zip(block.nodes.chunks_exact(n_nodes)));
    }
    elements.sort_unstable_by_key(|element| element.0);
    let element_tags = elements.iter().map(|element| element.0).collect();
    let known = |tag: &u64| map.get(*tag).map(|i| index[i]);
    let connectivity = elements
        .iter()
        .flat_map(|element| element.1.iter().filter_map(known))
        .collect();
    Ok(MeshBody {
        gmsh_type,
        n_nodes,
        node_tags,
        nodes,
        element_tags,
        connectivity,
    })
}

fn blocks_of<'a>(raw: &'a RawMsh, dimension: usize, numbers: &[i64]) -> Vec<&'a ElementBlock> {
    let of_group =
        |b: &&ElementBlock| b.dimension == dimension && b.physical.iter().any(|p| numbers.contains(p));
    raw.blocks
        .iter()
        .filter(of_group)
        .filter(|b| !b.tags.is_empty())
        .collect()
}

/// All elements must be of one type, and that one of those wanted.
fn check_types(blocks: &[&ElementBlock], path: &Path, wanted: &Wanted) -> Result<(), MeshError> {
    let mut counts: BTreeMap<i64, (usize, u64)> = BTreeMap::new();
    for block in blocks {
        let entry = counts.entry(block.gmsh_type).or_insert((0, block.tags[0]));
        entry.0 += block.tags.len();
    }
    let name = |number: i64| gmsh_type(number).map_or("unknown", |t| t.2);
    if let Some((&number, &(count, element))) =
        counts.iter().find(|(number, _)| !wanted.types.contains(number))
    {
        return Err(MeshError::UnsupportedElement {
            path: path.to_path_buf(),
            found: name(number).to_string(),
            count,
            element,
            expected: wanted.expected,
            remedy: if wanted.dimension == 2 {
                "make the section of transfinite, recombined surfaces and mesh with `gmsh -2 -order 1`"
            } else {
                remedy(number)
            },
        });
    }
    if counts.len() > 1 {
        let list: Vec<String> = counts
            .iter()
            .map(|(&n, &(count, _))| format!("{count} x {}", name(n)))
            .collect();
        return Err(MeshError::MixedKinds {
            path: path.to_path_buf(),
            found: list.join(", "),
        });
    }
    Ok(())
}

/// What a node is used by.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    Nothing,
    Construction,
    OtherBody,
    Body,
}

/// Checks that all elements name nodes that exist and that all nodes are used by an element of the dimension.
fn check_nodes(
    raw: &RawMsh,
    numbers: &[i64],
    path: &Path,
    wanted: &Wanted,
    map: &TagMap<'_>,
) -> Result<Vec<Use>, MeshError> {
    let mut used = vec![Use::Nothing; raw.nodes.len()];
    for block in &raw.blocks {
        let is_body = block.physical.iter().any(|p| numbers.contains(p));
        let mark = match (block.dimension == wanted.dimension, is_body) {
            (true, true) => Use::Body,
            (true, false) => Use::OtherBody,
            (false, _) => Use::Nothing,
        };
        for (&element, nodes) in block.tags.iter().zip(block.nodes.chunks_exact(block.n_nodes)) {
            for &node in nodes {
                let unknown = || MeshError::UnknownNode {
                    path: path.to_path_buf(),
                    element,
                    node,
                };
                let i = map.get(node).ok_or_else(unknown)?;
                used[i] = used[i].max(mark);
            }
        }
    }
    for (slot, node) in used
        .iter_mut()
        .zip(&raw.nodes)
        .filter(|(slot, _)| **slot == Use::Nothing)
    {
        if raw.construction.binary_search(&node.0).is_ok() {
            *slot = Use::Construction;
        }
    }
    let count = used.iter().filter(|&&u| u == Use::Nothing).count();
    if let Some(first) = used.iter().position(|&u| u == Use::Nothing) {
        return Err(MeshError::OrphanNodes {
            path: path.to_path_buf(),
            node: raw.nodes[first].0,
            kind: if wanted.dimension == 3 {
                "volume"
            } else {
                "surface"
            },
            count,
        });
    }
    Ok(used)
}

/// The named groups one dimension below the body, with their elements by increasing tag. A group that is named
/// but has no element is there, and empty.
pub(crate) fn named_boundary(
    raw: &RawMsh,
    body: &MeshBody,
    path: &Path,
    dimension: usize,
) -> Result<BTreeMap<String, Vec<BoundaryElement>>, MeshError> {
    let map = TagMap::new(&body.node_tags);
    let mut groups = BTreeMap::new();
    for name in raw.names_of(dimension) {
        let mut elements = Vec::new();
        for block in blocks_of(raw, dimension, &raw.numbers(dimension, name)) {
            for (&element, tags) in block.tags.iter().zip(block.nodes.chunks_exact(block.n_nodes)) {
                let nodes: Option<Vec<usize>> = tags.iter().map(|&tag| map.get(tag)).collect();
                let Some(nodes) = nodes else {
                    return Err(not_boundary(
                        path,
                        name,
                        element,
                        "on nodes no element of \"ring\" has",
                    ));
                };
                elements.push((element, nodes));
            }
        }
        elements.sort_unstable();
        groups.insert(name.to_string(), elements);
    }
    Ok(groups)
}

/// The error that a named element is not a boundary face of the body.
pub(crate) fn not_boundary(path: &Path, group: &str, element: u64, problem: &'static str) -> MeshError {
    MeshError::NotBoundary {
        path: path.to_path_buf(),
        group: group.to_string(),
        element,
        problem,
    }
}
