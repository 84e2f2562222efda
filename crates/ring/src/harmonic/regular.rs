//! The ring without its defect: the regular ring, what holds it, and which of its nodes the true ring has.
//!
//! A section node is held in the regular ring when it is held in most sectors. Nodes that are held besides are like
//! absent ones: the regular ring has rows there that the true one lacks. Nodes that are free where most of their
//! images are held are *loose*: rows that the regular ring lacks. A ring whose holds reach less than half round has no
//! regular ring, which would be held nowhere: its matrix at rest is singular.

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
    /// Nodes of the true ring that are free though most of their images are held, ascending.
    pub loose: Vec<usize>,
    /// Section nodes of the raceway, ascending.
    pub raceway: Vec<usize>,
    /// Each free node of the true ring among those of the regular one, ascending; None for loose ones.
    pub seen: Vec<Option<usize>>,
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
        if !held.is_empty() && !is_section_held.contains(&true) {
            return Err("what holds it reaches less than half round".to_string());
        }
        let is_regular = |node: usize| is_section_held[sites[node].section_node];
        let raceway = ring.mesh.group_nodes(RACEWAY_GROUP);
        if let Some(node) = raceway.iter().find(|&&node| is_held[node]) {
            return Err(format!("its raceway touches what is held, at node {node}"));
        }
        let raceway: BTreeSet<usize> = raceway.iter().map(|&node| sites[node].section_node).collect();
        let mut n_free = 0;
        let mut seen = Vec::with_capacity(n_nodes);
        for node in 0..n_nodes {
            if !is_held[node] {
                seen.push((!is_regular(node)).then_some(n_free));
            }
            n_free += usize::from(!is_regular(node));
        }
        Ok(RegularRing {
            mesh: nearly.regular(&ring.mesh),
            held_section: (0..is_section_held.len())
                .filter(|&k| is_section_held[k])
                .collect(),
            held: (0..sites.len()).filter(|&node| is_regular(node)).collect(),
            held_besides: held.iter().copied().filter(|&node| !is_regular(node)).collect(),
            raceway: raceway.into_iter().collect(),
            loose: (0..n_nodes)
                .filter(|&node| is_regular(node) && !is_held[node])
                .collect(),
            seen,
        })
    }
}
