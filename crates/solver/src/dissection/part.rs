//! A set of elements and their nodes that are still to be ordered, with local numbers.

/// Elements 0.. of a part and its nodes 0.., each in a list of the other.
pub(super) struct Subdomain {
    /// Global numbers of the nodes to be ordered, `[n_nodes]`, in order of first appearance.
    pub(super) nodes: Vec<usize>,
    /// Local nodes of each element, compressed; then nodes already placed, numbered from `n_nodes`.
    element_starts: Vec<usize>,
    element_nodes: Vec<usize>,
    /// Where in each element's list the placed nodes begin.
    halo_starts: Vec<usize>,
    node_starts: Vec<usize>,
    node_elements: Vec<usize>,
    n_halo: usize,
}

impl Subdomain {
    /// Gathers the nodes of the elements `set`. `local` is scratch, `[n_global_nodes]`, all `usize::MAX` on entry and
    /// return.
    pub(super) fn new(
        set: &[usize],
        elements: &[usize],
        nodes_per_element: usize,
        placed: &[bool],
        local: &mut [usize],
    ) -> Self {
        let list = |e: usize| &elements[nodes_per_element * e..nodes_per_element * (e + 1)];
        let (mut nodes, mut halo) = (Vec::new(), Vec::new());
        for &node in set.iter().flat_map(|&e| list(e)) {
            if local[node] == usize::MAX {
                let group = if placed[node] { &mut halo } else { &mut nodes };
                local[node] = group.len();
                group.push(node);
            }
        }
        halo.iter().for_each(|&node| local[node] += nodes.len());
        let (mut element_starts, mut element_nodes, mut halo_starts) = (vec![0], Vec::new(), Vec::new());
        for &e in set {
            element_nodes.extend(
                list(e)
                    .iter()
                    .filter(|&&node| !placed[node])
                    .map(|&node| local[node]),
            );
            halo_starts.push(element_nodes.len());
            element_nodes.extend(
                list(e)
                    .iter()
                    .filter(|&&node| placed[node])
                    .map(|&node| local[node]),
            );
            element_starts.push(element_nodes.len());
        }
        nodes
            .iter()
            .chain(&halo)
            .for_each(|&node| local[node] = usize::MAX);
        let mut part = Subdomain {
            n_halo: halo.len(),
            nodes,
            element_starts,
            element_nodes,
            halo_starts,
            node_starts: Vec::new(),
            node_elements: Vec::new(),
        };
        part.list_elements_of_nodes();
        part
    }

    fn list_elements_of_nodes(&mut self) {
        let n = self.n_nodes();
        let mut starts = vec![0; n + 1];
        for e in 0..self.n_elements() {
            self.element_nodes(e)
                .iter()
                .for_each(|&node| starts[node + 1] += 1);
        }
        for node in 0..n {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut lists = vec![0; starts[n]];
        for e in 0..self.n_elements() {
            for &node in self.element_nodes(e) {
                lists[next[node]] = e;
                next[node] += 1;
            }
        }
        (self.node_starts, self.node_elements) = (starts, lists);
    }

    /// Number of nodes to be ordered.
    pub(super) fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Number of placed nodes that the part touches.
    pub(super) fn n_halo(&self) -> usize {
        self.n_halo
    }

    pub(super) fn n_elements(&self) -> usize {
        self.halo_starts.len()
    }

    /// Local nodes of an element that are to be ordered.
    pub(super) fn element_nodes(&self, e: usize) -> &[usize] {
        &self.element_nodes[self.element_starts[e]..self.halo_starts[e]]
    }

    /// Local nodes of an element, placed ones included.
    pub(super) fn all_element_nodes(&self, e: usize) -> &[usize] {
        &self.element_nodes[self.element_starts[e]..self.element_starts[e + 1]]
    }

    /// Elements of a local node.
    pub(super) fn node_elements(&self, node: usize) -> &[usize] {
        &self.node_elements[self.node_starts[node]..self.node_starts[node + 1]]
    }

    /// Global nodes with elements on both sides.
    pub(super) fn separator(&self, side: &[bool]) -> Vec<usize> {
        let is_cut = |&node: &usize| {
            let elements = self.node_elements(node);
            elements.iter().any(|&e| side[e]) && elements.iter().any(|&e| !side[e])
        };
        (0..self.n_nodes())
            .filter(is_cut)
            .map(|node| self.nodes[node])
            .collect()
    }
}

/// Nodes on either side of a cut and on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CutSizes {
    pub(super) separator: usize,
    pub(super) sides: [usize; 2],
}

/// A cut must leave at least this fraction of the nodes on its smaller side.
const LEAST_BALANCE: f64 = 0.3;

impl CutSizes {
    /// Price of a cut: its separator, dearer when the sides differ. Infinite when a side is empty.
    pub(super) fn cost(self) -> f64 {
        let [a, b] = self.sides.map(|side| side as f64);
        let least = a.min(b);
        if least == 0.0 {
            return f64::INFINITY;
        }
        let balance = least / (a + b);
        let separator = self.separator as f64 + 0.5;
        // Beyond the limit the price rises steeply but stays finite, so that the best of bad cuts is found.
        let excess = (LEAST_BALANCE / balance).max(1.0);
        separator * (1.0 + (1.0 - 2.0 * balance).powi(2)) * excess.powi(4)
    }
}
