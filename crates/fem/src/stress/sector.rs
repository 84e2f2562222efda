//! Stress at the nodes of a rotationally periodic ring by the weights of one sector.
//!
//! Nodal stress ([`super::recovery`]) is linear in the displacements. In the cylindrical components of each node
//! ([`crate::sector`]) the weights are the same in every sector, so the elements of one sector give all: an element
//! between nodes (s_a, a) and (s_b, b) adds its share of the stress at a per displacement of b to the coupling of a
//! with b at the shift s_b - s_a. The incompatible modes of hex8 are in the weights.
//!
//! Cost: 3 n stresses per element of one sector, n nodes each; memory 144 B per coupling.

use std::collections::BTreeMap;

use mesh::{Mesh, Periodicity};

use super::kernel::NodeState;
use super::recovery::StressRecovery;
use crate::element::MAX_NODES;
use crate::sector::{SectorCoupling, azimuth_directions, coupling, couplings};

/// Stress at the nodes of one sector per displacement of the nodes around.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorStress {
    /// Couplings of nodes with the nodes of their elements, ascending.
    pub couplings: Vec<SectorCoupling>,
    /// Stress in the order rr tt zz rt tz rz per displacement along (radial, azimuthal, axial), Pa/m,
    /// `[n_couplings][6][3]`.
    pub weights: Vec<[[f64; 3]; 6]>,
}

impl StressRecovery {
    /// The weights of one sector of the mesh, which `periodicity` describes.
    ///
    /// # Panics
    /// If mesh or periodicity are others than this recovery's.
    pub fn sector(&self, mesh: &Mesh, periodicity: &Periodicity) -> SectorStress {
        let n_nodes = periodicity.sites().len();
        assert_eq!(mesh.n_nodes(), n_nodes, "the periodicity belongs to another mesh");
        assert_eq!(self.n_nodes(), n_nodes, "the recovery belongs to another mesh");
        let couplings = couplings(mesh, periodicity);
        let places: BTreeMap<SectorCoupling, usize> = couplings.iter().copied().zip(0..).collect();
        let directions = azimuth_directions(mesh);
        let mut weights = vec![[[0.0; 3]; 6]; couplings.len()];
        for &e in periodicity.elements() {
            let nodes = mesh.element(e);
            for_each_unit(mesh, nodes, &directions, |[b, j], state| {
                let corners = self.weighted_corners(state);
                for (a, &node_a) in nodes.iter().enumerate() {
                    let share = self.node_share(node_a, a, &corners);
                    let there = &mut weights[places[&coupling(periodicity, node_a, nodes[b])]];
                    for (row, value) in there.iter_mut().zip(cylindrical(share, directions[node_a])) {
                        row[j] += value;
                    }
                }
            });
        }
        SectorStress { couplings, weights }
    }
}

/// Gives the state of an element with the nodes `nodes` of which node b alone moves, by one along its component j,
/// for all `[b, j]`.
pub(super) fn for_each_unit(
    mesh: &Mesh,
    nodes: &[usize],
    directions: &[[f64; 2]],
    mut give: impl FnMut([usize; 2], &NodeState),
) {
    let mut state: NodeState = [[0.0; 6]; MAX_NODES];
    for (state, &node) in state.iter_mut().zip(nodes) {
        state[..3].copy_from_slice(&mesh.nodes[node]);
    }
    for (b, &node) in nodes.iter().enumerate() {
        let [c, s] = directions[node];
        let units = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
        for (j, unit) in units.into_iter().enumerate() {
            state[b][3..].copy_from_slice(&unit);
            give([b, j], &state);
        }
        state[b][3..].fill(0.0);
    }
}

/// Components rr tt zz rt tz rz of a tensor xx yy zz xy yz xz at the azimuth of the direction (cos, sin).
pub(super) fn cylindrical([xx, yy, zz, xy, yz, xz]: [f64; 6], [c, s]: [f64; 2]) -> [f64; 6] {
    let twice = 2.0 * c * s * xy;
    [
        c * c * xx + s * s * yy + twice,
        s * s * xx + c * c * yy - twice,
        zz,
        c * s * (yy - xx) + (c * c - s * s) * xy,
        c * yz - s * xz,
        c * xz + s * yz,
    ]
}
