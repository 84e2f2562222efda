//! A ring's mesh divided between ranks: each keeps the elements of its sectors.
//!
//! Every rank also keeps the elements with facets of the raceway and of the surface that is held, where patches and partner meet the
//! ring, and the positions of all nodes, 8 bytes per dof, as much as one vector. What is an integral over the ring is summed over
//! the sectors in their order.

use std::ops::Range;

use comm::Communicator;
use mesh::Mesh;
use solver::{SectorCut, default_sectors};

use crate::error::DynamicsError;
use crate::model::{Backend, RACEWAY_GROUP, RingModel, Sectors};

/// What a rank knows of a mesh that is divided.
#[derive(Debug)]
pub struct Division {
    /// Nodes of all sectors, and elements of those that this rank owns by their numbers in the mesh it keeps.
    cut: SectorCut,
    /// Number of elements of each sector.
    lengths: Vec<usize>,
    /// Elements of each sector by their numbers in the ring, on rank 0; empty on others.
    elements: Vec<Vec<usize>>,
}

/// Nodes or elements of all sectors by their numbers in the ring.
pub struct SectorLists {
    /// How many each sector has.
    pub lengths: Vec<usize>,
    /// Which; on other ranks than 0 empty.
    pub lists: Vec<Vec<usize>>,
}

impl RingModel {
    /// Divides the mesh between the ranks that share the ring; `side` is `inner` or `outer`. What only the whole mesh tells must have been
    /// asked for: the mass of its nodes, probes, its periodicity.
    pub fn divide(mut self, side: &'static str, sectors: Sectors) -> Result<RingModel, DynamicsError> {
        let mut cut = self.sector_cut(side, sectors)?;
        let n_sectors = cut.elements.len();
        let owned = sectors.comm.share(n_sectors);
        let lengths: Vec<usize> = cut.elements.iter().map(Vec::len).collect();
        let elements = if sectors.comm.is_root() {
            cut.elements.clone()
        } else {
            Vec::new()
        };
        let mut kept: Vec<usize> = cut.elements[owned.clone()].concat();
        kept.extend(self.surface_elements());
        kept.sort_unstable();
        kept.dedup();
        self.mesh = self.mesh.with_elements(&kept);
        let held = |e: &mut usize| *e = kept.binary_search(e).expect("own elements are kept");
        for (s, elements) in cut.elements.iter_mut().enumerate() {
            if owned.contains(&s) {
                elements.iter_mut().for_each(held);
            } else {
                *elements = Vec::new();
            }
        }
        self.sectors.division = Some(Division {
            cut,
            lengths,
            elements,
        });
        Ok(self)
    }

    /// Whether the mesh has all elements of the ring.
    pub fn is_whole(&self) -> bool {
        let division = self.sectors.division.as_ref();
        division.is_none_or(|d| d.lengths.iter().sum::<usize>() == self.mesh.n_elements())
    }

    /// Number of elements of the ring.
    pub fn n_elements(&self) -> usize {
        let division = self.sectors.division.as_ref();
        division.map_or(self.mesh.n_elements(), |d| d.lengths.iter().sum())
    }

    /// The sectors of the ring. Elements are numbered as in the mesh kept here; those of sectors that it lacks are missing.
    pub fn sector_cut(&self, side: &'static str, sectors: Sectors) -> Result<SectorCut, DynamicsError> {
        if let Some(division) = &self.sectors.division {
            return Ok(division.cut.clone());
        }
        let mesh = &self.mesh;
        let n_sectors = sectors
            .n_sectors
            .unwrap_or_else(|| default_sectors(mesh.n_dofs()));
        SectorCut::new(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes(), n_sectors)
            .map_err(|source| DynamicsError::Solver { side, source })
    }

    /// The elements of the sectors of `cut` in the ring.
    pub fn elements_of_sectors(&self, cut: &SectorCut, comm: Communicator) -> SectorLists {
        match &self.sectors.division {
            Some(division) => SectorLists {
                lengths: division.lengths.clone(),
                lists: division.elements.clone(),
            },
            None => SectorLists::on_root(cut.elements.clone(), comm),
        }
    }

    /// Elements of each sector that every rank keeps, whoever owns it, when `sectors` are the elements of each.
    pub fn kept_everywhere<'s>(&self, sectors: impl Iterator<Item = &'s [usize]>) -> Vec<usize> {
        let mut is_surface = vec![false; self.mesh.n_elements()];
        self.surface_elements().for_each(|e| is_surface[e] = true);
        let count = |elements: &[usize]| elements.iter().filter(|&&e| is_surface[e]).count();
        sectors.map(count).collect()
    }

    /// Elements with facets where contacts or the partner meet the ring.
    fn surface_elements(&self) -> impl Iterator<Item = usize> {
        let facets = [RACEWAY_GROUP, self.held_group].map(|group| self.mesh.group(group));
        facets.into_iter().flatten().map(|facet| facet.element)
    }
}

impl SectorLists {
    /// These lists, which only rank 0 keeps.
    pub fn on_root(lists: Vec<Vec<usize>>, comm: Communicator) -> SectorLists {
        SectorLists {
            lengths: lists.iter().map(Vec::len).collect(),
            lists: if comm.is_root() { lists } else { Vec::new() },
        }
    }
}

/// Nodal forces of a force per volume (N/m^3, a function of the position in m) on a ring, N, `[n_dofs]`, as [`fem::body_load`]. Of
/// a ring in sectors each rank integrates its own. Collective.
pub fn body_load(
    ring: &RingModel,
    side: &'static str,
    backend: Backend,
    force: impl Fn([f64; 3]) -> [f64; 3] + Sync,
) -> Result<Vec<f64>, DynamicsError> {
    let of = |mesh: &Mesh| {
        let load = fem::body_load(mesh, &force);
        load.map_err(|source| DynamicsError::Fem { side, source })
    };
    let Backend::Sector(sectors) = backend else {
        return of(&ring.mesh);
    };
    let cut = ring.sector_cut(side, sectors)?;
    let own = |s: usize| of(&ring.mesh.part(&cut.elements[s], &cut.nodes[s]));
    let parts: Result<Vec<Vec<f64>>, DynamicsError> = sectors.comm.share(cut.nodes.len()).map(own).collect();
    let elsewhere = |rank, message| DynamicsError::OnRank { rank, message };
    let parts = sectors.comm.agree(parts, elsewhere)?;
    let nodes: Vec<&[usize]> = cut.nodes.iter().map(Vec::as_slice).collect();
    Ok(sum_of_sectors(sectors.comm, &nodes, &parts, ring.mesh.n_dofs()))
}

/// Sum of nodal vectors of all sectors, `[n_dofs]`, in the order of the sectors, from those of the sectors of this rank,
/// `[3 nodes[s].len()]` each. Collective.
pub fn sum_of_sectors(comm: Communicator, nodes: &[&[usize]], own: &[Vec<f64>], n_dofs: usize) -> Vec<f64> {
    let length = |range: Range<usize>| nodes[range].iter().map(|nodes| 3 * nodes.len()).sum();
    let lengths: Vec<usize> = comm.shares(nodes.len()).into_iter().map(length).collect();
    let all = comm.all_gather(own.concat(), &lengths);
    let mut sum = vec![0.0; n_dofs];
    for (&node, value) in nodes.iter().copied().flatten().zip(all.chunks_exact(3)) {
        (0..3).for_each(|c| sum[3 * node + c] += value[c]);
    }
    sum
}
