//! Stress at a few nodes: the same numbers as [`StressRecovery::nodal`], bit for bit, from the elements around them.

use mesh::Mesh;

use super::StressRecovery;
use crate::error::FemError;
use crate::material::Material;

/// Recovery at chosen nodes. Cost of a recovery: the elements around these nodes; memory likewise.
pub struct NodeRecovery {
    /// Nodes of the elements around the chosen nodes, ascending.
    gathered: Vec<usize>,
    /// The chosen nodes among them, in the order they were given.
    chosen: Vec<usize>,
    /// Recovery on these elements, which keep their order, so that every sum is that of the whole mesh.
    recovery: StressRecovery,
}

impl NodeRecovery {
    /// Prepares recovery at the given nodes.
    ///
    /// # Panics
    /// If a node is not of the mesh.
    pub fn new(mesh: &Mesh, material: &Material, nodes: &[usize]) -> Result<NodeRecovery, FemError> {
        let mut is_chosen = vec![false; mesh.n_nodes()];
        nodes.iter().for_each(|&node| is_chosen[node] = true);
        let around: Vec<usize> = (0..mesh.n_elements())
            .filter(|&e| mesh.element(e).iter().any(|&node| is_chosen[node]))
            .collect();
        let mut gathered: Vec<usize> = around.iter().flat_map(|&e| mesh.element(e)).copied().collect();
        gathered.extend_from_slice(nodes);
        gathered.sort_unstable();
        gathered.dedup();
        let place = |node: &usize| {
            gathered
                .binary_search(node)
                .expect("all nodes of these elements were gathered")
        };
        let part = Mesh {
            kind: mesh.kind,
            nodes: gathered.iter().map(|&node| mesh.nodes[node]).collect(),
            connectivity: around.iter().flat_map(|&e| mesh.element(e)).map(place).collect(),
            groups: Default::default(),
        };
        Ok(NodeRecovery {
            recovery: StressRecovery::new(&part, material)?,
            chosen: nodes.iter().map(place).collect(),
            gathered,
        })
    }

    /// Nodes whose displacements a recovery reads, ascending.
    pub fn nodes(&self) -> &[usize] {
        &self.gathered
    }

    /// Number of elements that a recovery looks at.
    pub fn n_elements(&self) -> usize {
        self.recovery.n_elements()
    }

    /// Values at the chosen nodes of what is known at all nodes of the mesh, `[n][6]`.
    pub fn pick(&self, nodal: &[[f64; 6]]) -> Vec<[f64; 6]> {
        self.chosen.iter().map(|&own| nodal[self.gathered[own]]).collect()
    }

    /// Stress at the chosen nodes, Pa, `[n][6]`, from the displacements of all nodes of the mesh, m, `[3 n_nodes]`.
    ///
    /// # Panics
    /// If `u` is shorter than the mesh needs.
    pub fn stress(&self, u: &[f64]) -> Vec<[f64; 6]> {
        let own: Vec<f64> = self
            .gathered
            .iter()
            .flat_map(|&node| &u[3 * node..3 * node + 3])
            .copied()
            .collect();
        let stress = self.recovery.nodal(&own);
        self.chosen.iter().map(|&node| stress[node]).collect()
    }
}
