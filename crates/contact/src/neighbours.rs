//! Which quadrilateral facet lies across an edge of another: two that share the corners of an edge.

use mesh::FacetKind;

/// Number of an edge that has one facet.
const NONE: u32 = u32::MAX;

/// Facets across the edges 01, 12, 23 and 30 of all facets; none of triangles, which are searched in bins.
pub(crate) struct Neighbours(Vec<[u32; 4]>);

impl Neighbours {
    /// Of facets with the nodes `nodes`, `[n_facets][kind.n_nodes()]`, flat.
    pub fn new(kind: FacetKind, nodes: &[usize]) -> Neighbours {
        if kind == FacetKind::Tri6 {
            return Neighbours(Vec::new());
        }
        let facets: Vec<&[usize]> = nodes.chunks_exact(kind.n_nodes()).collect();
        let mut edges: Vec<([usize; 2], usize, usize)> = Vec::with_capacity(4 * facets.len());
        for (facet, nodes) in facets.iter().enumerate() {
            for edge in 0..4 {
                let mut ends = [nodes[edge], nodes[(edge + 1) % 4]];
                ends.sort_unstable();
                edges.push((ends, facet, edge));
            }
        }
        edges.sort_unstable();
        let mut across = vec![[NONE; 4]; facets.len()];
        for pair in edges.windows(2) {
            let [(ends, a, i), (same, b, j)] = [pair[0], pair[1]];
            if ends == same {
                (across[a][i], across[b][j]) = (b as u32, a as u32);
            }
        }
        Neighbours(across)
    }

    /// The facet on the side where a point with reference coordinates `xi` of a facet lies farthest out.
    #[inline]
    pub fn across(&self, facet: usize, xi: [f64; 2]) -> Option<usize> {
        let edge = match (xi[0].abs() > xi[1].abs(), xi[0] > 0.0, xi[1] > 0.0) {
            (true, true, _) => 1,
            (true, false, _) => 3,
            (false, _, true) => 2,
            (false, _, false) => 0,
        };
        let next = self.0.get(facet)?[edge];
        (next != NONE).then_some(next as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the way to a point would lead across another edge than the one beyond which it lies, or over the rim.
    #[test]
    fn facets_are_neighbours_across_the_edge_that_they_share() {
        // Nodes 0 1 2 / 3 4 5; the second facet begins at another corner.
        let nodes = [0, 1, 4, 3, 2, 5, 4, 1];
        let neighbours = Neighbours::new(FacetKind::Quad4, &nodes);
        assert_eq!(neighbours.across(0, [1.5, 1.2]), Some(1));
        assert_eq!(neighbours.across(0, [-1.5, 0.0]), None);
        assert_eq!(neighbours.across(0, [0.3, 1.1]), None);
        // Edge 41 is the third of the second facet.
        assert_eq!(neighbours.across(1, [0.2, 1.7]), Some(0));
        assert_eq!(neighbours.across(1, [0.2, -1.7]), None);
    }
}
