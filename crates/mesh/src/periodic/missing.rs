//! Elements that a ring lacks: those of most sectors that are not in the others.

use std::collections::BTreeSet;

use super::images::{Key, key, sorted_elements};
use super::reason::NotNearlyPeriodic;
use crate::mesh::Mesh;

/// Most missing elements: beyond, the nodes that they leave are too many rows.
const MOST_ELEMENTS: usize = 2000;

/// Nodes of the missing elements of a mesh whose nodes turn by one of `n_sectors` sectors into `images`, flat,
/// `[n_missing][kind.n_nodes()]`. An element that most sectors lack is an error.
pub(super) fn missing_elements(
    mesh: &Mesh,
    images: &[usize],
    n_sectors: usize,
) -> Result<Vec<usize>, NotNearlyPeriodic> {
    let sorted = sorted_elements(mesh);
    let is_there = |nodes: &[usize]| {
        let key: Key<20> = key(nodes.iter().copied());
        sorted.binary_search_by(|(nodes, _)| nodes.cmp(&key)).is_ok()
    };
    let turned = |nodes: &[usize]| nodes.iter().map(|&node| images[node]).collect::<Vec<usize>>();
    let mut known: BTreeSet<Key<20>> = BTreeSet::new();
    let mut missing = Vec::new();
    for element in 0..mesh.n_elements() {
        let mut nodes = turned(mesh.element(element));
        if is_there(&nodes) || known.contains(&key(nodes.iter().copied())) {
            continue;
        }
        // All turns of an element before a gap.
        let mut gaps = Vec::new();
        for _ in 1..n_sectors {
            if !is_there(&nodes) {
                gaps.push(nodes.clone());
            }
            nodes = turned(&nodes);
        }
        if 2 * gaps.len() >= n_sectors {
            return Err(NotNearlyPeriodic::MoreElements { n_sectors, element });
        }
        for gap in gaps {
            if known.insert(key(gap.iter().copied())) {
                missing.extend(gap);
            }
        }
        if known.len() > MOST_ELEMENTS {
            return Err(NotNearlyPeriodic::Large {
                n_sectors,
                limit: MOST_ELEMENTS,
            });
        }
    }
    Ok(missing)
}
