//! Where a turn by one sector takes nodes, elements and facets.

use std::f64::consts::TAU;

use super::locator::Locator;
use super::reason::NotPeriodic;
use crate::mesh::{Facet, Mesh};

/// Nodes of an element or facet, ascending, filled up with `usize::MAX`: equal for equal sets of nodes.
pub(super) type Key<const N: usize> = [usize; N];

/// The node that each node becomes when turned by a sector, and the largest distance between the two, m.
pub(super) fn node_images(
    mesh: &Mesh,
    locator: &Locator,
    n_sectors: usize,
) -> Result<(Vec<usize>, f64), NotPeriodic> {
    let (sin, cos) = (TAU / n_sectors as f64).sin_cos();
    let mut images = Vec::with_capacity(mesh.n_nodes());
    let mut is_taken = vec![false; mesh.n_nodes()];
    let mut deviation: f64 = 0.0;
    for (node, &[x, y, z]) in mesh.nodes.iter().enumerate() {
        let turned = [cos * x - sin * y, sin * x + cos * y, z];
        let found = locator
            .find(&turned)
            .filter(|&(image, _)| !std::mem::replace(&mut is_taken[image], true));
        let Some((image, distance)) = found else {
            return Err(NotPeriodic::Node {
                n_sectors,
                node,
                position: [x, y, z],
                tolerance: locator.tolerance(),
            });
        };
        deviation = deviation.max(distance);
        images.push(image);
    }
    Ok((images, deviation))
}

/// The element that each element becomes.
pub(super) fn element_images(
    mesh: &Mesh,
    images: &[usize],
    n_sectors: usize,
) -> Result<Vec<usize>, NotPeriodic> {
    let sorted = sorted_elements(mesh);
    let image = |element: usize| {
        let turned: Key<20> = key(mesh.element(element).iter().map(|&node| images[node]));
        sorted
            .binary_search_by(|(nodes, _)| nodes.cmp(&turned))
            .map(|place| sorted[place].1)
            .map_err(|_| NotPeriodic::Element { n_sectors, element })
    };
    (0..mesh.n_elements()).map(image).collect()
}

/// The elements by their nodes.
pub(super) fn sorted_elements(mesh: &Mesh) -> Vec<(Key<20>, usize)> {
    let mut sorted: Vec<(Key<20>, usize)> = (0..mesh.n_elements())
        .map(|e| (key(mesh.element(e).iter().copied()), e))
        .collect();
    sorted.sort_unstable();
    sorted
}

/// Checks that every group of facets becomes itself.
pub(super) fn facet_images(mesh: &Mesh, images: &[usize], n_sectors: usize) -> Result<(), NotPeriodic> {
    for (name, facets) in &mesh.groups {
        let mut sorted: Vec<Key<8>> = facets.iter().map(|&f| key(mesh.facet_nodes(f))).collect();
        sorted.sort_unstable();
        for &facet in facets {
            let turned: Key<8> = key(mesh.facet_nodes(facet).map(|node| images[node]));
            if sorted.binary_search(&turned).is_err() {
                let Facet { element, face } = facet;
                let group = name.clone();
                return Err(NotPeriodic::Facet {
                    n_sectors,
                    group,
                    element,
                    face,
                });
            }
        }
    }
    Ok(())
}

/// The key of a set of nodes.
pub(super) fn key<const N: usize>(nodes: impl Iterator<Item = usize>) -> Key<N> {
    let mut key = [usize::MAX; N];
    key.iter_mut().zip(nodes).for_each(|(place, node)| *place = node);
    key.sort_unstable();
    key
}
