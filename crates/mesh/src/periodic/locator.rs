//! Finds the node at a point.

/// Direction in general position: no plane, axis or small-integer lattice of a mesh is perpendicular to it; length 1.
const DIRECTION: [f64; 3] = [0.521_340_721, 0.287_190_573, 0.803_573_201];

/// Nodes sorted along one direction, so that few have to be compared with a point.
pub(super) struct Locator<'a> {
    nodes: &'a [[f64; 3]],
    /// Place along the direction, m, and node, ascending.
    sorted: Vec<(f64, usize)>,
    tolerance: f64,
}

impl<'a> Locator<'a> {
    /// Sorts the nodes; they are found within `tolerance` metres.
    pub fn new(nodes: &'a [[f64; 3]], tolerance: f64) -> Locator<'a> {
        let mut sorted: Vec<(f64, usize)> = nodes
            .iter()
            .enumerate()
            .map(|(node, x)| (project(x), node))
            .collect();
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Locator {
            nodes,
            sorted,
            tolerance,
        }
    }

    /// Distance within which nodes are found, m.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The node nearest to `x` and its distance, m, if that is within the tolerance.
    pub fn find(&self, x: &[f64; 3]) -> Option<(usize, f64)> {
        let place = project(x);
        let first = self.sorted.partition_point(|s| s.0 < place - self.tolerance);
        let near = self.sorted[first..]
            .iter()
            .take_while(|s| s.0 <= place + self.tolerance)
            .map(|&(_, node)| (node, distance(&self.nodes[node], x)));
        near.min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|&(_, distance)| distance <= self.tolerance)
    }
}

fn project(x: &[f64; 3]) -> f64 {
    (0..3).map(|i| DIRECTION[i] * x[i]).sum()
}

/// Distance of two points, m.
pub(super) fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
