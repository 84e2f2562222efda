//! What a rank gets of a ring's mesh, cut out of the whole mesh and sent by the rank that has read it.

use std::collections::BTreeMap;
use std::sync::Arc;

use mesh::{ElementKind, Facet, Mesh, NodePositions};
use serde::{Deserialize, Serialize};
use solver::SectorCut;

use super::known::Division;
use crate::model::{NodeMasses, RACEWAY_GROUP, RingModel};

/// Part of a mesh, with node numbers of the ring and its own element numbers.
#[derive(Serialize, Deserialize)]
pub(super) struct RingPart {
    /// Place of the kind of element among [`ElementKind::ALL`].
    kind: u8,
    n_nodes: usize,
    /// Nodes whose positions it has, ascending, and these, m.
    kept: Vec<u32>,
    points: Vec<[f64; 3]>,
    connectivity: Vec<u32>,
    /// Element and face of the facets of each group.
    groups: BTreeMap<String, Vec<(u32, u8)>>,
    /// Nodes of all sectors.
    sector_nodes: Vec<Vec<u32>>,
    /// Elements of the sectors owned; empty for others.
    sector_elements: Vec<Vec<u32>>,
    /// Number of elements of each sector.
    lengths: Vec<usize>,
    /// Elements of each sector in the ring, for rank 0.
    ring_elements: Vec<Vec<u32>>,
    node_masses: Option<NodeMasses>,
}

pub(super) fn small(number: usize) -> u32 {
    u32::try_from(number).expect("meshes of 2^32 nodes or elements fit into no memory")
}

/// Elements with facets where contacts or the partner meet the ring, and the nodes of these facets.
pub(super) fn surface(ring: &RingModel) -> impl Iterator<Item = Facet> + '_ {
    let facets = [RACEWAY_GROUP, ring.held_group].map(|group| ring.mesh.group(group));
    facets.into_iter().flatten().copied()
}

/// Nodes whose positions a part has: those of its `own` sectors, at the surfaces that are met, and `more`, growing.
fn kept_nodes(ring: &RingModel, own: &[Vec<u32>], more: &[usize]) -> Vec<u32> {
    let mesh = &ring.mesh;
    let mut is_kept = vec![false; mesh.n_nodes()];
    let at_surface = surface(ring).flat_map(|facet| mesh.facet_nodes(facet));
    let inside = own.iter().flatten().map(|&node| node as usize);
    let kept = at_surface.chain(inside).chain(more.iter().copied());
    kept.for_each(|node| is_kept[node] = true);
    (0..mesh.n_nodes())
        .filter(|&node| is_kept[node])
        .map(small)
        .collect()
}

impl RingPart {
    /// The part of one rank of a ring that is whole here and was cut, with the positions of the nodes `more` besides.
    pub(super) fn new(
        ring: &RingModel,
        cut: &SectorCut,
        [rank, n_ranks]: [usize; 2],
        more: &[usize],
    ) -> RingPart {
        let mesh = &ring.mesh;
        let owned = comm::shares(cut.elements.len(), n_ranks)[rank].clone();
        let mut elements: Vec<usize> = cut.elements[owned.clone()].concat();
        elements.extend(surface(ring).map(|facet| facet.element));
        elements.sort_unstable();
        elements.dedup();
        let held = |&e: &usize| small(elements.binary_search(&e).expect("own elements are kept"));
        let own = |s: usize| match owned.contains(&s) {
            true => cut.elements[s].iter().map(held).collect(),
            false => Vec::new(),
        };
        let facet = |facet: &Facet| {
            let element = elements.binary_search(&facet.element).ok()?;
            Some((small(element), facet.face as u8))
        };
        let groups = mesh.groups.iter().map(|(name, facets)| {
            let kept = facets.iter().filter_map(facet).collect();
            (name.clone(), kept)
        });
        let kept = kept_nodes(ring, &cut.nodes[owned.clone()], more);
        let ring_elements = match rank {
            0 => cut
                .elements
                .iter()
                .map(|list| list.iter().map(|&e| small(e)).collect())
                .collect(),
            _ => Vec::new(),
        };
        RingPart {
            kind: ElementKind::ALL
                .iter()
                .position(|&kind| kind == mesh.kind)
                .expect("all kinds are listed") as u8,
            n_nodes: mesh.n_nodes(),
            points: kept.iter().map(|&node| mesh.nodes[node as usize]).collect(),
            kept,
            connectivity: elements
                .iter()
                .flat_map(|&e| mesh.element(e))
                .map(|&node| small(node))
                .collect(),
            groups: groups.collect(),
            sector_nodes: cut.nodes.to_vec(),
            sector_elements: (0..cut.elements.len()).map(own).collect(),
            lengths: cut.elements.iter().map(Vec::len).collect(),
            ring_elements,
            node_masses: ring.known_node_masses().map(|masses| NodeMasses::clone(masses)),
        }
    }

    /// The part as bytes.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("a part is plain data in memory")
    }

    /// The part from the bytes of the rank that made it.
    pub(super) fn from_bytes(bytes: &[u8]) -> RingPart {
        postcard::from_bytes(bytes).expect("messages of the same program arrive as they were sent")
    }

    /// The ring with this mesh; `model` makes it of a mesh.
    pub(super) fn ring(self, model: impl FnOnce(Mesh) -> RingModel) -> RingModel {
        let wide = |list: Vec<u32>| list.into_iter().map(|e| e as usize).collect::<Vec<usize>>();
        let facets = |list: Vec<(u32, u8)>| {
            let facet = |(element, face)| Facet {
                element: element as usize,
                face: face as usize,
            };
            list.into_iter().map(facet).collect()
        };
        let mut ring = model(Mesh {
            kind: ElementKind::ALL[self.kind as usize],
            nodes: NodePositions::of(self.kept, self.points, self.n_nodes),
            connectivity: wide(self.connectivity),
            groups: self
                .groups
                .into_iter()
                .map(|(name, list)| (name, facets(list)))
                .collect(),
        });
        if let Some(masses) = self.node_masses {
            ring.set_node_masses(masses);
        }
        ring.sectors.division = Some(Division {
            cut: SectorCut {
                elements: self.sector_elements.into_iter().map(wide).collect(),
                nodes: Arc::new(self.sector_nodes),
            },
            lengths: self.lengths,
            elements: self.ring_elements,
        });
        ring
    }
}
