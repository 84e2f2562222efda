//! Forecast of the memory of one rank that shares rings in sectors with others, or of all when it is alone.
//!
//! Bytes of one ring with n nodes, N = 3 n dofs, e elements of p nodes, s nodes in the lists of all sectors (n, and
//! those they share again); of its sectors owned: o elements, k nodes, E stored entries of K, factors of F bytes with
//! analyses of A and r rows; b balls. A worker is a thread that factors a sector.
//!
//! | part | bytes | what it is |
//! |---|---|---|
//! | mesh | 28 n' + 8 e' p; alone 24 n + 8 e p | n', e': of the sectors owned and of surfaces that all keep |
//! | lists | 4 s + 12 N + 8 r + 8 k + 16 o; in motion 4 N more | nodes of sectors, owners, free dofs, own rows |
//! | vectors | 24 N in statics, 152 N in motion | whole |
//! | matrices | 16 E (1 + 1/9) | K and the mass between nodes |
//! | factors | F + A | |
//! | interface | as the solver says | all of it with few sectors |
//! | columns | 8 r (2 b + 1) | solutions under all contact forces, and what of them is on interfaces |
//! | work | 16 E_s + work space of s, per worker | the matrix that is factored, and fronts, of the largest sectors |
//! | results | rank 0: 240 n + 8 e + 24 o p + 48 o c; alone 24 e p for 24 o p | stress of the elements owned, output |
//! | | others: 24 r + 24 o p + 48 f c | stress of the elements owned, f in the largest sector |
//! | reading | 3 (24 n + 8 e p) + 18 e | on rank 0 of several, at first: both meshes, and `mesh.hdf` in the writing |
//!
//! Statics has the matrices of one ring at a time and lets go of them; motion keeps those of both. Alone and with
//! several threads both rings are made at once.

use std::ops::Range;

use comm::Communicator;
use solver::SectorLayout;

use crate::memory::{PROGRAM_BYTES, RingMemory, forecast_peak};
use crate::model::RingModel;
use crate::substructures::Substructures;

/// Bytes of one stored entry: value and column index.
const ENTRY_BYTES: usize = 16;
/// The message passing library itself, and its buffers per rank of a node, bytes, measured with Open MPI 4.1.
const MESSAGE_BYTES: [usize; 2] = [6_000_000, 5_000_000];

/// Bytes of one ring on one rank: see the module.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RankMemory {
    /// Whole meshes while they are read.
    pub reading: usize,
    /// Nodes and connectivity.
    pub mesh: usize,
    /// Lists of nodes and rows, in statics and in motion.
    pub lists: [usize; 2],
    /// Displacements, velocities, loads, in statics and in motion.
    pub vectors: [usize; 2],
    /// Stiffness and mass of the sectors owned.
    pub matrices: usize,
    /// Their factors.
    pub factors: usize,
    /// Factor of the interface.
    pub interface: usize,
    /// Solutions under all contact forces.
    pub columns: usize,
    /// Work space of the factorisation.
    pub work: usize,
    /// Stress, and on rank 0 record and output.
    pub results: usize,
}

/// One of several ranks.
#[derive(Clone, Debug)]
pub struct Share {
    /// Its number.
    pub rank: usize,
    /// How many there are.
    pub n_ranks: usize,
    /// Threads of each.
    pub n_threads: usize,
}

impl Share {
    /// That of this process.
    pub fn of(comm: Communicator) -> Share {
        Share {
            rank: comm.rank(),
            n_ranks: comm.size(),
            n_threads: rayon::current_num_threads(),
        }
    }

    /// Whether both rings are made at the same time.
    fn makes_both(&self) -> bool {
        self.n_ranks == 1 && self.n_threads > 1
    }

    fn owned(&self, n_sectors: usize) -> Range<usize> {
        comm::shares(n_sectors, self.n_ranks)[self.rank].clone()
    }
}

impl RankMemory {
    /// Forecast for a ring of which this process has at least the sectors of `share`.
    pub fn new(ring: &RingModel, parts: &Substructures, n_balls: usize, share: &Share) -> RankMemory {
        let mesh = &ring.mesh;
        let symbolic = parts.symbolic();
        let owned = share.owned(symbolic.layout().sectors().len());
        let first = symbolic.owned().start;
        let here = owned.start - first..owned.end - first;
        let (costs, entries) = (&symbolic.costs()[here.clone()], &parts.entries()[here]);
        let per_element = 8 * mesh.kind.n_nodes();
        let (n_dofs, n_elements) = (mesh.n_dofs(), ring.n_elements());
        let own_elements: usize = costs.iter().map(|c| c.n_elements).sum();
        let largest = costs.iter().map(|c| c.n_elements).max().unwrap_or(0);
        let corners = 48 * mesh.kind.n_corners();
        let rows: usize = costs.iter().map(|c| c.n_rows).sum();
        let listed: usize = symbolic.layout().nodes().iter().map(Vec::len).sum();
        let own_nodes: usize = symbolic.layout().nodes()[owned.clone()]
            .iter()
            .map(Vec::len)
            .sum();
        let whole_mesh = 8 * n_dofs + per_element * n_elements;
        let (is_alone, is_root) = (share.n_ranks == 1, share.rank == 0);
        let own = 3 * per_element * own_elements;
        let mut work: Vec<usize> = costs
            .iter()
            .zip(entries)
            .map(|(cost, entries)| ENTRY_BYTES * entries + cost.work_bytes)
            .collect();
        work.sort_unstable();
        RankMemory {
            reading: if is_root && !is_alone {
                3 * whole_mesh + 18 * n_elements
            } else {
                0
            },
            mesh: match is_alone {
                true => whole_mesh,
                false => {
                    28 * kept_nodes(ring, symbolic.layout(), &owned)
                        + per_element * kept_elements(ring, symbolic.layout(), &owned)
                }
            },
            lists: [12, 16]
                .map(|bytes| bytes * n_dofs + 4 * listed + 8 * rows + 8 * own_nodes + 16 * own_elements),
            vectors: [24, 152].map(|bytes| bytes * n_dofs),
            matrices: ENTRY_BYTES * entries.iter().sum::<usize>() * 10 / 9,
            factors: costs.iter().map(|c| c.factor_bytes + c.analysis_bytes).sum(),
            interface: symbolic.interface_bytes(owned),
            columns: 8 * (rows + symbolic.layout().interface().len()) * (2 * n_balls + 1),
            work: work.iter().rev().take(share.n_threads).sum(),
            results: match (is_root, is_alone) {
                (true, true) => 80 * n_dofs + own + corners * own_elements,
                (true, false) => 80 * n_dofs + 8 * n_elements + own + corners * own_elements,
                _ => 24 * rows + own + corners * largest,
            },
        }
    }

    /// As the phases of a static run.
    pub(crate) fn phases(&self) -> RingMemory {
        let kept = self.kept();
        RingMemory {
            mesh: self.mesh,
            assembly: self.lists[0] + self.matrices,
            factorisation: kept + self.matrices + self.work,
            kept,
            columns: kept + self.columns,
            results: self.results,
        }
    }

    /// What stays from statics: factors and lists.
    fn kept(&self) -> usize {
        self.lists[0] + self.vectors[0] + self.factors + self.interface
    }
}

/// Nodes whose positions the rank with the sectors `owned` keeps.
fn kept_nodes(ring: &RingModel, layout: &SectorLayout, owned: &Range<usize>) -> usize {
    let mut is_kept = vec![false; ring.mesh.n_nodes()];
    let own = layout.nodes()[owned.clone()].iter().flatten();
    own.for_each(|&node| is_kept[node as usize] = true);
    ring.surface_nodes()
        .into_iter()
        .for_each(|node| is_kept[node] = true);
    is_kept.into_iter().filter(|&kept| kept).count()
}

/// Elements that the rank with the sectors `owned` keeps.
fn kept_elements(ring: &RingModel, layout: &SectorLayout, owned: &Range<usize>) -> usize {
    if !ring.is_whole() {
        return ring.mesh.n_elements();
    }
    let elements = || layout.sectors().iter().map(|sector| sector.elements.as_slice());
    let everywhere = ring.kept_everywhere(elements());
    let of_sector = |(s, elements): (usize, &[usize])| {
        if owned.contains(&s) {
            elements.len()
        } else {
            everywhere[s]
        }
    };
    elements().enumerate().map(of_sector).sum()
}

/// Forecast of the largest resident memory of one rank in statics and in motion, bytes; inner ring first, None is
/// rigid.
pub fn forecast_rank_peak(rings: &[Option<RankMemory>; 2], share: &Share) -> [usize; 2] {
    let messages = match share.n_ranks {
        1 => 0,
        n => MESSAGE_BYTES[0] + MESSAGE_BYTES[1] * n,
    };
    let at_once = if share.makes_both() { share.n_threads } else { 1 };
    let statics = messages + forecast_peak(rings.map(|ring| ring.map(|r| r.phases())), at_once);
    let [a, b] = rings.map(Option::unwrap_or_default);
    let lasting = |r: RankMemory| r.mesh + r.results;
    let base = PROGRAM_BYTES + messages + lasting(a) + lasting(b);
    let held = |r: RankMemory| r.lists[1] + r.vectors[1] + r.factors + r.interface + r.matrices;
    let more = if share.makes_both() {
        (a.work + b.work).max(a.columns + b.columns)
    } else {
        a.work.max(b.work).max(a.columns + b.columns)
    };
    let reading = PROGRAM_BYTES + messages + a.reading + b.reading;
    [statics, base + held(a) + held(b) + more].map(|peak| peak.max(reading))
}
