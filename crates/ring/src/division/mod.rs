//! A ring's mesh divided between ranks: each keeps the elements of its sectors and the positions of their nodes.
//!
//! Every rank also keeps the elements with facets of the raceway and of the surface that is held, where patches and
//! partner meet the ring, and the positions of the nodes of these facets. Rank 0 cuts the parts out of the whole
//! mesh, which it alone has read, and sends them; then it keeps its own only. What is a field or an integral over the
//! ring is made by sector ([`NodePlaces`]). Cost: one message per rank, 12 bytes per element node and 28 per node of
//! its part.

pub mod known;
mod part;
mod places;

use std::ops::Range;

use comm::Communicator;
use mesh::Mesh;
use solver::{SectorCut, default_sectors};

use crate::error::RingError;
use crate::model::{Backend, RingModel, Sectors};
use known::Division;
use part::RingPart;
pub use places::NodePlaces;

/// Nodes or elements of all sectors by their numbers in the ring.
pub struct SectorLists {
    /// How many each sector has.
    pub lengths: Vec<usize>,
    /// Which; on other ranks than 0 empty.
    pub lists: Vec<Vec<u32>>,
}

impl RingModel {
    /// Cuts a ring that this process keeps whole; `side` is `inner` or `outer`. It is asked for its sectors often,
    /// which are then found once.
    pub fn divide(mut self, side: &'static str, sectors: Sectors) -> Result<RingModel, RingError> {
        let cut = self.sector_cut(side, sectors)?;
        self.sectors.division = Some(Division {
            lengths: cut.elements.iter().map(Vec::len).collect(),
            elements: self.elements_of_sectors(&cut, sectors.comm).lists,
            cut,
        });
        Ok(self)
    }

    /// What a rank, given by its number and that of all ranks, keeps of a ring that is whole here, with the positions
    /// of the nodes `more` besides. What only the whole mesh tells must have been asked for: the mass of its nodes,
    /// probes, its periodicity.
    pub fn kept_by(self, cut: &SectorCut, rank: [usize; 2], more: &[usize]) -> RingModel {
        let part = RingPart::new(&self, cut, rank, more);
        let RingModel {
            material,
            hold,
            held_group,
            groove,
            tie,
            mesh,
            ..
        } = self;
        drop(mesh);
        part.ring(|mesh| RingModel {
            mesh,
            material,
            hold,
            held_group,
            groove,
            tie,
            sectors: Default::default(),
        })
    }

    /// Divides a `ring` that rank 0 has read between all ranks: the others, which give None, make theirs by `model`
    /// of the mesh they get. Rank 0 keeps the positions of the nodes `more` besides. Conditions as for
    /// [`RingModel::kept_by`]. Collective.
    pub fn deal(
        ring: Option<RingModel>,
        side: &'static str,
        sectors: Sectors,
        more: &[usize],
        model: impl FnOnce(Mesh) -> RingModel,
    ) -> Result<RingModel, RingError> {
        let comm = sectors.comm;
        let cut = ring
            .as_ref()
            .map(|ring| ring.sector_cut(side, sectors))
            .transpose();
        let cut = comm.agree(cut, |rank, message| RingError::OnRank { rank, message })?;
        let bytes = comm.deal(|rank| match (&ring, &cut) {
            (Some(ring), Some(cut)) => RingPart::new(ring, cut, [rank, comm.size()], &[]).to_bytes(),
            _ => unreachable!("rank 0 has the ring"),
        });
        Ok(match (ring, cut) {
            (Some(ring), Some(cut)) => ring.kept_by(&cut, [comm.rank(), comm.size()], more),
            _ => RingPart::from_bytes(&bytes).ring(model),
        })
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

    /// The sectors of the ring. Elements are numbered as in the mesh kept here; those of sectors that it lacks are
    /// missing.
    pub fn sector_cut(&self, side: &'static str, sectors: Sectors) -> Result<SectorCut, RingError> {
        if let Some(division) = &self.sectors.division {
            return Ok(division.cut.clone());
        }
        let mesh = &self.mesh;
        let n_sectors = sectors
            .n_sectors
            .unwrap_or_else(|| default_sectors(mesh.n_dofs()));
        SectorCut::new(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes(), n_sectors)
            .map_err(|source| RingError::Solver { side, source })
    }

    /// Where the nodes are.
    pub fn places(&self, side: &'static str, backend: Backend) -> Result<NodePlaces, RingError> {
        let positions = self.mesh.nodes.clone();
        Ok(match backend {
            Backend::Sector(sectors) => {
                NodePlaces::shared(positions, &self.sector_cut(side, sectors)?.nodes, sectors.comm)
            }
            Backend::Auto | Backend::Cyclic | Backend::Sparse => NodePlaces::whole(positions),
        })
    }

    /// The elements of the sectors of `cut` in the ring.
    pub fn elements_of_sectors(&self, cut: &SectorCut, comm: Communicator) -> SectorLists {
        if let Some(division) = &self.sectors.division {
            return SectorLists {
                lengths: division.lengths.clone(),
                lists: division.elements.clone(),
            };
        }
        let small = |list: &Vec<usize>| list.iter().map(|&e| part::small(e)).collect();
        SectorLists {
            lengths: cut.elements.iter().map(Vec::len).collect(),
            lists: match comm.is_root() {
                true => cut.elements.iter().map(small).collect(),
                false => Vec::new(),
            },
        }
    }

    /// Elements of each sector that every rank keeps, whoever owns it, when `sectors` are the elements of each.
    pub fn kept_everywhere<'s>(&self, sectors: impl Iterator<Item = &'s [usize]>) -> Vec<usize> {
        let mut is_surface = vec![false; self.mesh.n_elements()];
        part::surface(self).for_each(|facet| is_surface[facet.element] = true);
        let count = |elements: &[usize]| elements.iter().filter(|&&e| is_surface[e]).count();
        sectors.map(count).collect()
    }

    /// Nodes of the surfaces whose positions every rank keeps, ascending.
    pub fn surface_nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = part::surface(self)
            .flat_map(|facet| self.mesh.facet_nodes(facet))
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

impl SectorLists {
    /// The nodes of the sectors of `cut`.
    pub fn nodes(cut: &SectorCut, comm: Communicator) -> SectorLists {
        SectorLists {
            lengths: cut.nodes.iter().map(Vec::len).collect(),
            lists: if comm.is_root() {
                cut.nodes.to_vec()
            } else {
                Vec::new()
            },
        }
    }
}

/// Nodal forces of a force per volume (N/m^3, a function of the position in m) on a ring, N, `[n_dofs]`, as
/// [`fem::body_load`]. Of a ring in sectors each rank integrates its own. Collective.
pub fn body_load(
    ring: &RingModel,
    side: &'static str,
    backend: Backend,
    force: impl Fn([f64; 3]) -> [f64; 3] + Sync,
) -> Result<Vec<f64>, RingError> {
    let of = |mesh: &Mesh| {
        let load = fem::body_load(mesh, &force);
        load.map_err(|source| RingError::Fem { side, source })
    };
    let Backend::Sector(sectors) = backend else {
        return of(&ring.mesh);
    };
    let cut = ring.sector_cut(side, sectors)?;
    let own = |s: usize| of(&ring.mesh.part(&cut.elements[s], &wide(&cut.nodes[s])));
    let parts: Result<Vec<Vec<f64>>, RingError> = sectors.comm.share(cut.nodes.len()).map(own).collect();
    let elsewhere = |rank, message| RingError::OnRank { rank, message };
    let parts = sectors.comm.agree(parts, elsewhere)?;
    Ok(sum_of_sectors(
        sectors.comm,
        &cut.nodes,
        &parts,
        ring.mesh.n_dofs(),
    ))
}

/// Numbers of nodes as a mesh takes them.
pub(crate) fn wide(nodes: &[u32]) -> Vec<usize> {
    nodes.iter().map(|&node| node as usize).collect()
}

/// Sum of nodal vectors of all sectors, `[n_dofs]`, in the order of the sectors, from those of the sectors of this
/// rank, `[3 nodes[s].len()]` each. Collective.
pub fn sum_of_sectors(comm: Communicator, nodes: &[Vec<u32>], own: &[Vec<f64>], n_dofs: usize) -> Vec<f64> {
    let length = |range: Range<usize>| nodes[range].iter().map(|nodes| 3 * nodes.len()).sum();
    let lengths: Vec<usize> = comm.shares(nodes.len()).into_iter().map(length).collect();
    let all = comm.all_gather(own.concat(), &lengths);
    let mut sum = vec![0.0; n_dofs];
    for (&node, value) in nodes.iter().flatten().zip(all.as_chunks::<3>().0) {
        (0..3).for_each(|c| sum[3 * node as usize + c] += value[c]);
    }
    sum
}
