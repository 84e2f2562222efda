//! Stress of a ring in sectors: every rank recovers that of the sectors it owns, rank 0 puts it together.
//!
//! At a node, the stress of the elements around it times their volume is summed within each sector, in ascending
//! order of the elements; the sums and the volumes of the sectors are added in the order of the sectors, and divided.
//! At integration points a sector has the stress of its elements. So the bits depend on the sectors, but not on ranks
//! and threads, and the stress at nodes is that of the whole ring ([`fem::StressRecovery`]) to round-off.
//!
//! Messages: one per sector to rank 0, 48 B per node of the sector or per integration point. Memory: 20 B per element
//! node and 24 B per node of the sectors owned, corner stresses of one sector at a time; rank 0 has the stress of the
//! ring, and one sector's message.

use comm::Communicator;
use fem::StressRecovery;

use crate::division::{SectorLists, wide};
use crate::error::RingError;
use crate::model::{RingModel, Sectors};

/// Where stress is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressPlaces {
    /// At the nodes, averaged over their elements.
    Nodes,
    /// At the integration points of the elements.
    IntegrationPoints,
}

/// Stress recovery of a ring in sectors.
pub struct SharedStress {
    comm: Communicator,
    places: StressPlaces,
    points_per_element: usize,
    /// The sectors this rank owns.
    parts: Vec<OwnedSector>,
    /// What rank 0 puts together.
    whole: JoinedStress,
}

/// One sector.
struct OwnedSector {
    /// Its nodes.
    nodes: Vec<usize>,
    recovery: StressRecovery,
}

/// How the stress of the ring is made of that of its sectors.
struct JoinedStress {
    /// Values of each place of a sector: 1 per node, or the points of an element.
    per_place: usize,
    /// Nodes or elements of each sector; on other ranks than 0 empty.
    places: Vec<Vec<u32>>,
    /// Number of values of each sector.
    lengths: Vec<usize>,
    /// Nodes or elements of the ring.
    n_places: usize,
    /// Volume of the elements around every node, m^3, on rank 0; empty for integration points.
    volumes: Vec<f64>,
}

impl SharedStress {
    /// Prepares a ring's stress; `side` is `inner` or `outer`. Collective.
    pub fn new(
        ring: &RingModel,
        side: &'static str,
        sectors: Sectors,
        places: StressPlaces,
    ) -> Result<SharedStress, RingError> {
        let (mesh, comm) = (&ring.mesh, sectors.comm);
        let cut = ring.sector_cut(side, sectors)?;
        let n_sectors = cut.nodes.len();
        let part = |s: usize| -> Result<OwnedSector, RingError> {
            let (elements, nodes) = (&cut.elements[s], wide(&cut.nodes[s]));
            let recovery = StressRecovery::new(&mesh.part(elements, &nodes), &ring.material)
                .map_err(|source| RingError::Fem { side, source })?;
            Ok(OwnedSector { nodes, recovery })
        };
        let parts: Result<Vec<OwnedSector>, RingError> = comm.share(n_sectors).map(part).collect();
        let elsewhere = |rank, message| RingError::OnRank { rank, message };
        let parts = comm.agree(parts, elsewhere)?;
        let points_per_element = fem::quadrature::stiffness_rule(mesh.kind).points.len();
        let (per_place, n_places, of_sectors) = match places {
            StressPlaces::Nodes => (1, mesh.n_nodes(), SectorLists::nodes(&cut, comm)),
            StressPlaces::IntegrationPoints => {
                let elements = ring.elements_of_sectors(&cut, comm);
                (points_per_element, ring.n_elements(), elements)
            }
        };
        let mut stress = SharedStress {
            comm,
            places,
            points_per_element,
            parts,
            whole: JoinedStress {
                per_place,
                lengths: of_sectors.lengths.iter().map(|n| per_place * n).collect(),
                places: of_sectors.lists,
                n_places,
                volumes: Vec::new(),
            },
        };
        if places == StressPlaces::Nodes {
            let own = stress.parts.iter().map(|part| part.recovery.volumes());
            let own = own
                .map(|volumes| volumes.iter().map(|&v| [v]).collect())
                .collect();
            let volumes = stress.collect(own);
            stress.whole.volumes = volumes.into_iter().flatten().flatten().collect();
        }
        Ok(stress)
    }

    /// Stress points of one element: 8, 27 or 4.
    pub fn points_per_element(&self) -> usize {
        self.points_per_element
    }

    /// Positions of the integration points in the order of the elements, m, `[n_elements * points_per_element][3]`,
    /// on rank 0, None on the others. Collective.
    ///
    /// # Panics
    /// When the stress is that at nodes.
    pub fn point_positions(&self) -> Option<Vec<[f64; 3]>> {
        assert_eq!(self.places, StressPlaces::IntegrationPoints, "points of elements");
        let own = self.parts.iter().map(|part| part.recovery.point_positions());
        self.collect(own.collect())
    }

    /// Stress of the sectors this rank owns, as [`Self::gather`] takes it, from displacements of the ring, m, `[3
    /// n_nodes]`.
    pub fn recover(&self, u: &[f64]) -> Vec<Vec<[f64; 6]>> {
        let of_part = |part: &OwnedSector| {
            let nodes = part.nodes.iter().flat_map(|&node| &u[3 * node..3 * node + 3]);
            let own: Vec<f64> = nodes.copied().collect();
            match self.places {
                StressPlaces::Nodes => part.recovery.volume_sums(&own),
                StressPlaces::IntegrationPoints => part.recovery.integration_points(&own),
            }
        };
        // One after the other, each with all threads: the workspace is that of one sector.
        self.parts.iter().map(of_part).collect()
    }

    /// Stress of the ring from that of the sectors of all ranks, Pa, `[n_nodes][6]` or `[n_elements *
    /// points_per_element][6]`, on rank 0, None on the others. Collective.
    pub fn gather(&self, own: Vec<Vec<[f64; 6]>>) -> Option<Vec<[f64; 6]>> {
        let mut stress = self.collect(own)?;
        for (stress, &volume) in stress.iter_mut().zip(&self.whole.volumes) {
            let inverse = if volume > 0.0 { 1.0 / volume } else { 0.0 };
            *stress = stress.map(|s| s * inverse);
        }
        Some(stress)
    }

    /// Sum of the values of all sectors at their places, on rank 0, in the order of the sectors.
    fn collect<const W: usize>(&self, own: Vec<Vec<[f64; W]>>) -> Option<Vec<[f64; W]>> {
        let (comm, whole) = (self.comm, &self.whole);
        let n = if comm.is_root() {
            whole.per_place * whole.n_places
        } else {
            0
        };
        let mut sum = vec![[0.0; W]; n];
        let mut own = own.into_iter();
        for (rank, share) in comm.shares(whole.lengths.len()).into_iter().enumerate() {
            for s in share {
                let mine = if comm.rank() == rank { own.next() } else { None };
                let sent = mine.map(Vec::into_flattened).unwrap_or_default();
                let Some(values) = comm.to_root(rank, sent, W * whole.lengths[s]) else {
                    continue;
                };
                let values = values.as_chunks::<W>().0.chunks_exact(whole.per_place);
                for (&place, values) in whole.places[s].iter().zip(values) {
                    let place = place as usize;
                    let sum = &mut sum[whole.per_place * place..whole.per_place * (place + 1)];
                    for (sum, value) in sum.iter_mut().zip(values) {
                        (0..W).for_each(|c| sum[c] += value[c]);
                    }
                }
            }
        }
        comm.is_root().then_some(sum)
    }
}
