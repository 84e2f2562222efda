//! Loads on single nodes in harmonic space, without transforming the whole field.
//!
//! Cost: N/2 + 1 harmonics for each node, three components; for a few hundred nodes less than one transform of the
//! field.

use rayon::prelude::*;

use super::phases::LANES;
use super::ring::CyclicRing;

/// Force on one of the caller's nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodalLoad {
    /// The caller's node.
    pub node: usize,
    /// Cartesian force, N.
    pub force: [f64; 3],
}

impl CyclicRing {
    /// Adds the harmonics of loads on single nodes to `harmonic`, `[harmonic_len()]`.
    ///
    /// # Panics
    /// When the length is another, or a node does not exist.
    pub fn add_loads(&self, loads: &[NodalLoad], harmonic: &mut [f64]) {
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        let shared = &self.shared;
        let sites: Vec<NodeSite> = loads.iter().map(|load| self.site(load.node)).collect();
        let forces: Vec<[f64; 3]> = loads
            .iter()
            .zip(&sites)
            .map(|(load, site)| {
                let ([c, s], [x, y, z]) = (site.direction, load.force);
                [c * x + s * y, c * y - s * x, z]
            })
            .collect();
        let first = self.own_groups().start;
        harmonic
            .par_chunks_mut(self.group_len().max(1))
            .enumerate()
            .for_each(|(i, lanes)| {
                let group = first + i;
                let last = shared.phases.n_harmonics().min((group + 1) * LANES);
                for (site, [radial, azimuthal, axial]) in sites.iter().zip(&forces) {
                    let node = &mut lanes[6 * LANES * site.place..][..6 * LANES];
                    for k in group * LANES..last {
                        let [cos, sin] = shared.phases.of(k, site.halves);
                        let parts = [
                            radial * cos,
                            -radial * sin,
                            -azimuthal * sin,
                            -azimuthal * cos,
                            axial * cos,
                            -axial * sin,
                        ];
                        for (part, value) in parts.into_iter().enumerate() {
                            node[part * LANES + k % LANES] += value;
                        }
                    }
                }
            });
    }

    fn site(&self, node: usize) -> NodeSite {
        let shared = &self.shared;
        let (site, width) = (shared.sites[node], self.n_section_nodes());
        let place = site % width;
        NodeSite {
            place,
            halves: 2 * (site / width) as i32 + shared.halves[place],
            direction: shared.directions[site],
        }
    }
}

/// Where a node is.
struct NodeSite {
    place: usize,
    /// Azimuth in half sectors.
    halves: i32,
    /// (cos, sin) of it.
    direction: [f64; 2],
}
