//! The ring without its defect: the regular ring, what holds it, and which of its nodes the true ring has.
//!
//! A section node is held in the regular ring when it is held in most sectors. Nodes that are held besides are like absent ones:
//! the regular ring has rows there that the true one lacks. A node that is free where most of its images are held would be a row that
//! the regular ring lacks: such a ring is not solved by harmonics.

use std::collections::BTreeSet;

use mesh::{Mesh, NearlyPeriodic};

use crate::model::{RACEWAY_GROUP, RingModel};

/// The regular ring of a ring with a defect.
pub struct RegularRing {
    /// Its mesh, without groups: nodes and elements of the true mesh, then what that lacks.
    pub mesh: Mesh,
    /// Section nodes that are held, ascending.
    pub held_section: Vec<usize>,
    /// Nodes that are held, ascending.
    pub held: Vec<usize>,
    /// Nodes of the true ring that are held besides, ascending.
    pub held_besides: Vec<usize>,
    /// Section nodes of the raceway, ascending.
    pub raceway: Vec<usize>,
    /// Free nodes of the true ring among those of the regular one, ascending.
    pub seen: Vec<usize>,
}

impl RegularRing {
    /// The regular ring of `ring`, of which the nodes `held` are held; the error says why harmonics do not solve it.
    pub fn new(ring: &RingModel, nearly: &NearlyPeriodic, held: &[usize]) -> Result<RegularRing, String> {
        let periodicity = &nearly.periodicity;
        let (n_nodes, sites) = (ring.mesh.n_nodes(), periodicity.sites());
        let mut held_in = vec![0; periodicity.n_section_nodes()];
        let mut is_held = vec![false; sites.len()];
        for &node in held {
            held_in[sites[node].section_node] += 1;
            is_held[node] = true;
        }
        let is_section_held: Vec<bool> = held_in.iter().map(|n| 2 * n > periodicity.n_sectors()).collect();
        let is_regular = |node: usize| is_section_held[sites[node].section_node];
        if let Some(node) = (0..n_nodes).find(|&node| is_regular(node) && !is_held[node]) {
            return Err(format!(
                "what holds it is not the same in all sectors: node {node} is free where most sectors are held"
            ));
        }
        let raceway = ring.mesh.group_nodes(RACEWAY_GROUP);
        if let Some(node) = raceway.iter().find(|&&node| is_held[node]) {
            return Err(format!("its raceway touches what is held, at node {node}"));
        }
        let raceway: BTreeSet<usize> = raceway.iter().map(|&node| sites[node].section_node).collect();
        let free = (0..sites.len()).filter(|&node| !is_regular(node));
        let seen = free
            .enumerate()
            .filter(|&(_, node)| node < n_nodes && !is_held[node]);
        Ok(RegularRing {
            mesh: nearly.regular(&ring.mesh),
            held_section: (0..is_section_held.len())
                .filter(|&k| is_section_held[k])
                .collect(),
            held: (0..sites.len()).filter(|&node| is_regular(node)).collect(),
            held_besides: held.iter().copied().filter(|&node| !is_regular(node)).collect(),
            raceway: raceway.into_iter().collect(),
            seen: seen.map(|(place, _)| place).collect(),
        })
    }
}
