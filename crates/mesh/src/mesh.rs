//! The mesh of one ring: nodes, elements of one kind, and named groups of boundary facets.

use std::collections::BTreeMap;

use crate::element::ElementKind;
use crate::positions::NodePositions;

/// One face of one element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Facet {
    /// Element index.
    pub element: usize,
    /// Face of that element, in the order of [`ElementKind::face_nodes`].
    pub face: usize,
}

/// A mesh of one body. Node order inside an element is VTK's, see [`crate::element`].
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Kind of every element.
    pub kind: ElementKind,
    /// Node coordinates, m, `[n_nodes][3]`.
    pub nodes: NodePositions,
    /// Node indices of the elements, `[n_elements][kind.n_nodes()]`, flat.
    pub connectivity: Vec<usize>,
    /// Boundary facets by physical name (`raceway`, `seat`, `bore`, ...).
    pub groups: BTreeMap<String, Vec<Facet>>,
}

impl Mesh {
    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Number of degrees of freedom, three per node.
    pub fn n_dofs(&self) -> usize {
        3 * self.nodes.len()
    }

    /// Number of elements.
    pub fn n_elements(&self) -> usize {
        self.connectivity.len() / self.kind.n_nodes()
    }

    /// Node indices of element `e`.
    pub fn element(&self, e: usize) -> &[usize] {
        let n = self.kind.n_nodes();
        &self.connectivity[n * e..n * (e + 1)]
    }

    /// Global node indices of a facet: corners, then mid-nodes, outward normal by the right-hand rule.
    pub fn facet_nodes(&self, facet: Facet) -> impl Iterator<Item = usize> + '_ {
        let element = self.element(facet.element);
        self.kind.face_nodes(facet.face).iter().map(move |&i| element[i])
    }

    /// Facets of a named group, empty when there is none.
    pub fn group(&self, name: &str) -> &[Facet] {
        self.groups.get(name).map_or(&[], Vec::as_slice)
    }

    /// Sorted distinct nodes of a named group.
    pub fn group_nodes(&self, name: &str) -> Vec<usize> {
        let mut nodes: Vec<usize> = self
            .group(name)
            .iter()
            .flat_map(|&f| self.facet_nodes(f))
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The mesh with some of its elements only, ascending, numbered 0.. in this order: all nodes stay, groups lose
    /// the facets of other elements.
    pub fn with_elements(mut self, elements: &[usize]) -> Mesh {
        let n = self.kind.n_nodes();
        for (place, &e) in elements.iter().enumerate() {
            self.connectivity.copy_within(n * e..n * (e + 1), n * place);
        }
        self.connectivity.truncate(n * elements.len());
        self.connectivity.shrink_to_fit();
        for facets in self.groups.values_mut() {
            let kept = |facet: &Facet| {
                let element = elements.binary_search(&facet.element).ok()?;
                Some(Facet { element, ..*facet })
            };
            *facets = facets.iter().filter_map(kept).collect();
        }
        self
    }

    /// The mesh without the elements for which `is_lost`, such as those of a keyway; nodes that no other element has
    /// and facets of these elements go with them. What stays keeps its order; faces that become free belong to no
    /// group. Also the old numbers of the nodes.
    pub fn without_elements(self, is_lost: impl Fn(usize) -> bool) -> (Mesh, Vec<usize>) {
        let kept: Vec<usize> = (0..self.n_elements()).filter(|&e| !is_lost(e)).collect();
        let mut mesh = self.with_elements(&kept);
        let mut number = vec![usize::MAX; mesh.n_nodes()];
        mesh.connectivity.iter().for_each(|&node| number[node] = 0);
        let nodes: Vec<usize> = (0..number.len()).filter(|&node| number[node] == 0).collect();
        for (place, &node) in nodes.iter().enumerate() {
            number[node] = place;
        }
        mesh.nodes = nodes.iter().map(|&node| mesh.nodes[node]).collect();
        mesh.connectivity
            .iter_mut()
            .for_each(|node| *node = number[*node]);
        (mesh, nodes)
    }

    /// Mean of the nodes of element `e`, m.
    pub fn element_centre(&self, e: usize) -> [f64; 3] {
        let nodes = self.element(e);
        let mean = |i: usize| nodes.iter().map(|&n| self.nodes[n][i]).sum::<f64>() / nodes.len() as f64;
        [0, 1, 2].map(mean)
    }

    /// The mesh of some elements alone, without groups. `nodes` are the nodes of these elements, ascending; the part
    /// numbers them 0.. in this order.
    ///
    /// # Panics
    /// When `nodes` lacks a node of an element.
    pub fn part(&self, elements: &[usize], nodes: &[usize]) -> Mesh {
        let local = |node: &usize| {
            let found = nodes.binary_search(node);
            found.expect("the nodes of a part are those of its elements")
        };
        Mesh {
            kind: self.kind,
            nodes: nodes.iter().map(|&node| self.nodes[node]).collect(),
            connectivity: elements
                .iter()
                .flat_map(|&e| self.element(e))
                .map(local)
                .collect(),
            groups: BTreeMap::new(),
        }
    }
}
