//! One node per place, one element per place, and one connected body.

use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::origin::Origin;

/// Nodes nearer than this share of the size of the smaller element at them are one node. Interfaces that were
/// not merged differ by rounding (1e-15 to 1e-9); neighbours in a usable element by more than 1e-3.
const COINCIDENT: f64 = 1e-5;

/// No two nodes may be at one place.
pub(crate) fn check_coincident(mesh: &Mesh, origin: &Origin) -> Result<(), MeshError> {
    check_coincident_nodes(&mesh.nodes, mesh.kind.n_nodes(), &mesh.connectivity, origin)
}

/// The same for nodes and elements of any kind, `n_per_element` nodes each.
pub(crate) fn check_coincident_nodes(
    nodes: &[[f64; 3]],
    n_per_element: usize,
    connectivity: &[usize],
    origin: &Origin,
) -> Result<(), MeshError> {
    let size = sizes_at_nodes(nodes, n_per_element, connectivity);
    let Some((i, j, distance)) = find_coincident(nodes, &size) else {
        return Ok(());
    };
    let (first, second) = (origin.node_tags[i.min(j)], origin.node_tags[i.max(j)]);
    Err(MeshError::CoincidentNodes {
        path: origin.path.clone(),
        first,
        second,
        distance,
        size: size[i].min(size[j]),
    })
}

/// Extent of the smallest element at each node: the largest side of its bounding box.
fn sizes_at_nodes(nodes: &[[f64; 3]], n_per_element: usize, connectivity: &[usize]) -> Vec<f64> {
    let mut size = vec![f64::INFINITY; nodes.len()];
    for element in connectivity.chunks_exact(n_per_element) {
        let mut extent: f64 = 0.0;
        for c in 0..3 {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for &n in element {
                low = low.min(nodes[n][c]);
                high = high.max(nodes[n][c]);
            }
            extent = extent.max(high - low);
        }
        for &n in element {
            size[n] = size[n].min(extent);
        }
    }
    size
}

/// The first pair of nodes at one place. Nodes are sorted along a direction in general position, so that each
/// has few neighbours within the tolerance: n log n.
fn find_coincident(nodes: &[[f64; 3]], size: &[f64]) -> Option<(usize, usize, f64)> {
    // No plane, axis or small-integer lattice of a mesh is perpendicular to it; its length is 1.
    const DIRECTION: [f64; 3] = [0.521_340_721, 0.287_190_573, 0.803_573_201];
    let along = |x: &[f64; 3]| x[0] * DIRECTION[0] + x[1] * DIRECTION[1] + x[2] * DIRECTION[2];
    let mut order: Vec<(f64, usize)> = nodes.iter().enumerate().map(|(i, x)| (along(x), i)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (k, &(s, i)) in order.iter().enumerate() {
        for &(_, j) in order[k + 1..]
            .iter()
            .take_while(|(t, _)| t - s <= COINCIDENT * size[i])
        {
            let d2: f64 = (0..3).map(|c| (nodes[i][c] - nodes[j][c]).powi(2)).sum();
            let distance = d2.sqrt();
            if distance <= COINCIDENT * size[i].min(size[j]) {
                return Some((i, j, distance));
            }
        }
    }
    None
}

/// No two elements may have the same corners: the body would be twice as stiff and heavy there.
pub(crate) fn check_once(mesh: &Mesh, origin: &Origin) -> Result<(), MeshError> {
    let corners = |element: usize| {
        let mut corners = mesh.element(element)[..mesh.kind.n_corners()].to_vec();
        corners.sort_unstable();
        corners
    };
    let lowest = |element: usize| mesh.element(element)[..mesh.kind.n_corners()].iter().min();
    let mut order: Vec<usize> = (0..mesh.n_elements()).collect();
    order.sort_by_key(|&element| lowest(element));
    for at_node in order.chunk_by(|&a, &b| lowest(a) == lowest(b)) {
        let mut at_node: Vec<(Vec<usize>, usize)> = at_node.iter().map(|&e| (corners(e), e)).collect();
        at_node.sort_unstable();
        if let Some(pair) = at_node.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(MeshError::SameCorners {
                path: origin.path.clone(),
                first: origin.element_tags[pair[0].1],
                second: origin.element_tags[pair[1].1],
            });
        }
    }
    Ok(())
}

/// The elements must hang together by common nodes.
pub(crate) fn check_connected(
    n_nodes: usize,
    n_per_element: usize,
    connectivity: &[usize],
    origin: &Origin,
) -> Result<(), MeshError> {
    let mut parent: Vec<usize> = (0..n_nodes).collect();
    for element in connectivity.chunks_exact(n_per_element) {
        let mut a = root(&mut parent, element[0]);
        for &n in &element[1..] {
            let b = root(&mut parent, n);
            // The smaller index is the root, whatever the order of the elements.
            (parent[a.max(b)], a) = (a.min(b), a.min(b));
        }
    }
    // Elements and first element of each part, by root.
    let mut parts: Vec<(usize, usize)> = vec![(0, 0); n_nodes];
    for (e, element) in connectivity.chunks_exact(n_per_element).enumerate() {
        let part = &mut parts[root(&mut parent, element[0])];
        *part = if part.0 == 0 { (1, e) } else { (part.0 + 1, part.1) };
    }
    parts.retain(|part| part.0 > 0);
    if parts.len() <= 1 {
        return Ok(());
    }
    let (count, first) = parts.iter().min().copied().unwrap_or_default();
    let (path, element) = (origin.path.clone(), origin.element_tags[first]);
    Err(MeshError::Disconnected {
        path,
        parts: parts.len(),
        element,
        count,
    })
}

/// Root of a node's part, halving paths on the way.
fn root(parent: &mut [usize], mut n: usize) -> usize {
    while parent[n] != n {
        parent[n] = parent[parent[n]];
        n = parent[n];
    }
    n
}
