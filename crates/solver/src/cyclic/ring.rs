//! A rotationally periodic ring: where its nodes are in the caller's vectors and in harmonic space, and in which order
//! its section is eliminated.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use comm::Communicator;
use fft::{ComplexToReal, RealToComplex};

use super::factor_rows::FactorRows;
use super::matrix::{CyclicMatrix, check_ascending};
use super::order::ordered;
use super::pattern::CyclicPattern;
use super::phases::{LANES, Phases};
use crate::error::SolverError;
use crate::permutation::invert;

/// A ring of N equal sectors; clones share everything. Vectors of the ring come in two forms, see [`crate::cyclic`].
#[derive(Clone)]
pub struct CyclicRing {
    pub(crate) shared: Arc<SharedRing>,
    /// The ranks that factor and solve its harmonics.
    pub(super) comm: Communicator,
}

/// In [`SharedRing::nodes`] a node that the caller's vectors lack, in [`SharedRing::sites`] one that the ring lacks.
pub(crate) const ABSENT: usize = usize::MAX;

/// What clones share. Places count section nodes in elimination order.
#[derive(Clone)]
pub(crate) struct SharedRing {
    pub(crate) pattern: Arc<CyclicPattern>,
    /// Place of every section node.
    pub(crate) place: Vec<usize>,
    /// Blocks of the factor.
    pub(crate) rows: FactorRows,
    /// First place of the nodes that trail, see [`CyclicRing::ending_with`].
    pub(crate) trailing: usize,
    /// Half sectors from the first plane to the node, 0 or 1, by place.
    pub(crate) halves: Vec<i32>,
    /// Whether the offsets are known, so that the section may be its own mirror image.
    pub(crate) may_be_mirrored: bool,
    /// The caller's node by sector and place, or [`ABSENT`], `[n_sectors][n_section_nodes]`.
    pub(crate) nodes: Vec<usize>,
    /// Where each of the caller's nodes is in `nodes`, or [`ABSENT`].
    pub(crate) sites: Vec<usize>,
    /// (cos, sin) of its azimuth, in the layout of `nodes`.
    pub(crate) directions: Vec<[f64; 2]>,
    pub(crate) phases: Phases,
    /// Most sectors between coupled nodes.
    pub(crate) reach: usize,
    /// Half sectors between coupled nodes, the different values, ascending.
    pub(crate) steps: Vec<i32>,
    /// Couplings by (row, step), which the products run over.
    pub(crate) links: Vec<OrderedCoupling>,
    /// Block of the factor of each link, `usize::MAX` of those above the diagonal.
    pub(crate) link_blocks: Vec<usize>,
    pub(crate) forward: Arc<dyn RealToComplex<f64>>,
    pub(crate) inverse: Arc<dyn ComplexToReal<f64>>,
}

/// A coupling in elimination order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OrderedCoupling {
    /// Place of the row's node.
    pub(crate) row: usize,
    /// Index of the step in [`SharedRing::steps`].
    pub(crate) step: usize,
    /// Place of the column's node.
    pub(crate) column: usize,
    /// Place of the block in the matrix.
    pub(crate) block: usize,
}

impl CyclicRing {
    /// A ring with the couplings of `matrix`. `nodes` is the caller's node at each (sector, section node),
    /// `[n_sectors][n_section_nodes]` flat, each node once; `directions` the (cos, sin) of the azimuth of each of the
    /// caller's nodes; `half_way` says which section nodes lie half a sector beyond the plane of the others, `None`
    /// when nodes lie anywhere. Finds the elimination order; no number is factored.
    ///
    /// # Panics
    /// When the lengths disagree.
    pub fn new(
        matrix: &CyclicMatrix,
        nodes: &[usize],
        directions: &[[f64; 2]],
        half_way: Option<&[bool]>,
    ) -> Result<CyclicRing, SolverError> {
        CyclicRing::arranged(matrix.pattern.clone(), nodes, directions, half_way, &[])
    }

    /// The same with the section nodes `last` at the end of the order, when there are any.
    fn arranged(
        pattern: Arc<CyclicPattern>,
        nodes: &[usize],
        directions: &[[f64; 2]],
        half_way: Option<&[bool]>,
        last: &[usize],
    ) -> Result<CyclicRing, SolverError> {
        let (n_sectors, width) = (pattern.n_sectors, pattern.n_section_nodes);
        assert_eq!(nodes.len(), n_sectors * width, "one node per site");
        assert_eq!(directions.len(), nodes.len(), "one direction per node");
        invert(nodes, nodes.len())?;
        let (order, rows) = ordered(&pattern.neighbours(), last);
        let halves: Vec<i32> = match half_way {
            None => vec![0; width],
            Some(half_way) => {
                assert_eq!(half_way.len(), width, "one offset per section node");
                order.iter().map(|&node| i32::from(half_way[node])).collect()
            }
        };
        let mut place = vec![0; width];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let (steps, links) = links(&pattern, &place, &halves);
        let block = |link: &OrderedCoupling| match link.row < link.column {
            true => usize::MAX,
            false => rows.place(link.row, link.column),
        };
        let nodes: Vec<usize> = nodes
            .chunks_exact(width.max(1))
            .flat_map(|sector| order.iter().map(|&node| sector[node]))
            .collect();
        Ok(CyclicRing {
            comm: Communicator::Serial,
            shared: Arc::new(SharedRing {
                sites: invert(&nodes, nodes.len())?,
                directions: nodes.iter().map(|&node| directions[node]).collect(),
                phases: Phases::new(n_sectors),
                reach: pattern
                    .couplings
                    .iter()
                    .map(|c| c.shift.unsigned_abs() as usize)
                    .max()
                    .unwrap_or(0),
                forward: fft::forward(n_sectors),
                inverse: fft::inverse(n_sectors),
                may_be_mirrored: half_way.is_some(),
                trailing: if last.is_empty() { 0 } else { width - last.len() },
                link_blocks: links.iter().map(block).collect(),
                pattern,
                place,
                rows,
                halves,
                nodes,
                steps,
                links,
            }),
        })
    }

    /// The same ring in an order that ends with the section nodes `last` (distinct): loads on them can then be added
    /// to a solve between its forward and its backward sweep ([`super::CyclicBordered::begin_group`]). Vectors in
    /// harmonic space have another order. None: as [`CyclicRing::new`] makes it. Not for a ring
    /// [`CyclicRing::seen_at`] some of its nodes.
    ///
    /// # Panics
    /// When a section node does not exist or comes twice, or a node of the ring is not seen.
    pub fn ending_with(&self, last: &[usize]) -> Result<CyclicRing, SolverError> {
        let (shared, width) = (&self.shared, self.n_section_nodes());
        assert!(!self.shared.nodes.contains(&ABSENT), "all nodes are seen");
        let mut sorted = last.to_vec();
        sorted.sort_unstable();
        check_ascending(&sorted, width);
        let sectors = shared.nodes.chunks_exact(width.max(1));
        let nodes: Vec<usize> = sectors
            .flat_map(|sector| shared.place.iter().map(|&place| sector[place]))
            .collect();
        let directions: Vec<[f64; 2]> = shared.sites.iter().map(|&site| shared.directions[site]).collect();
        let half_way: Vec<bool> = shared
            .place
            .iter()
            .map(|&place| shared.halves[place] == 1)
            .collect();
        let half_way = shared.may_be_mirrored.then_some(half_way.as_slice());
        let ring = CyclicRing::arranged(shared.pattern.clone(), &nodes, &directions, half_way, last)?;
        Ok(ring.shared_by(self.comm))
    }

    /// First place of the nodes that trail in the order of a group: the first group is solved in full.
    pub(super) fn trailing(&self, group: usize) -> usize {
        if group == 0 { 0 } else { self.shared.trailing }
    }

    /// The ring whose groups of harmonics are dealt out to the ranks of `comm`, in equal runs: each factors and
    /// solves its own, and has those of a vector in harmonic space alone (`shared`).
    pub fn shared_by(self, comm: Communicator) -> CyclicRing {
        CyclicRing { comm, ..self }
    }

    /// Groups of harmonics of this rank.
    pub fn own_groups(&self) -> Range<usize> {
        self.comm.share(self.shared.phases.n_groups())
    }

    /// The ring of the section nodes `keep` (ascending) alone; the others are held. The caller's vectors then hold the
    /// nodes that stay, in the order they had. Goes with [`CyclicMatrix::restricted`], whose result is `matrix`.
    ///
    /// # Panics
    /// When `keep` is not ascending or names a node outside.
    pub fn restricted(&self, matrix: &CyclicMatrix, keep: &[usize]) -> Result<CyclicRing, SolverError> {
        let shared = &self.shared;
        let width = self.n_section_nodes();
        check_ascending(keep, width);
        let mut kept: Vec<(usize, usize)> = Vec::with_capacity(keep.len() * self.n_sectors());
        for sector in 0..self.n_sectors() {
            kept.extend(keep.iter().map(|&node| {
                let site = sector * width + shared.place[node];
                (shared.nodes[site], site)
            }));
        }
        let mut ranks: Vec<usize> = (0..kept.len()).collect();
        ranks.sort_unstable_by_key(|&i| kept[i].0);
        let mut nodes = vec![0; kept.len()];
        let mut directions = Vec::with_capacity(kept.len());
        for (rank, &i) in ranks.iter().enumerate() {
            nodes[i] = rank;
            directions.push(shared.directions[kept[i].1]);
        }
        let half_way: Vec<bool> = keep
            .iter()
            .map(|&node| shared.halves[shared.place[node]] == 1)
            .collect();
        let half_way = shared.may_be_mirrored.then_some(half_way.as_slice());
        Ok(CyclicRing::new(matrix, &nodes, &directions, half_way)?.shared_by(self.comm))
    }

    /// The same ring for vectors that hold the caller's nodes `nodes` (ascending) alone, in this order. The other
    /// nodes are there and move, but nothing loads or measures them. `None` is a node that the ring lacks: it bears
    /// no load and does not move.
    ///
    /// # Panics
    /// When `nodes` is not ascending or names a node outside.
    pub fn seen_at(&self, nodes: &[Option<usize>]) -> CyclicRing {
        let there: Vec<usize> = nodes.iter().flatten().copied().collect();
        check_ascending(&there, self.shared.sites.len());
        let site = |node: &Option<usize>| node.map_or(ABSENT, |node| self.shared.sites[node]);
        let sites: Vec<usize> = nodes.iter().map(site).collect();
        let mut seen = vec![ABSENT; self.shared.nodes.len()];
        let of_ring = sites.iter().enumerate().filter(|(_, site)| **site != ABSENT);
        of_ring.for_each(|(node, &site)| seen[site] = node);
        CyclicRing {
            comm: self.comm,
            shared: Arc::new(SharedRing {
                nodes: seen,
                sites,
                ..SharedRing::clone(&self.shared)
            }),
        }
    }

    /// Cartesian components of a nodal vector at a site, zero of a node that it lacks.
    pub(crate) fn at_site(&self, nodal: &[f64], site: usize) -> [f64; 3] {
        match self.shared.nodes[site] {
            ABSENT => [0.0; 3],
            node => [0, 1, 2].map(|j| nodal[3 * node + j]),
        }
    }

    /// Number of sectors N.
    pub fn n_sectors(&self) -> usize {
        self.shared.pattern.n_sectors
    }

    /// Nodes per sector.
    pub fn n_section_nodes(&self) -> usize {
        self.shared.pattern.n_section_nodes
    }

    /// Length of the caller's vectors, three per node.
    pub fn n(&self) -> usize {
        3 * self.shared.sites.len()
    }

    /// Length of a vector in harmonic space: this rank's groups of four harmonics, the last one of all filled up with
    /// zeros.
    pub fn harmonic_len(&self) -> usize {
        self.own_groups().len() * self.group_len()
    }

    /// The same of the groups of all ranks.
    pub fn whole_len(&self) -> usize {
        self.shared.phases.n_groups() * self.group_len()
    }

    /// Length of one group's part of a vector in harmonic space.
    pub(crate) fn group_len(&self) -> usize {
        6 * LANES * self.n_section_nodes()
    }

    /// The caller's row of component `component` of the node at a place, of the first sector where the caller has it.
    pub(crate) fn row(&self, place: usize, component: usize) -> usize {
        let mut images = self
            .shared
            .nodes
            .iter()
            .skip(place)
            .step_by(self.n_section_nodes());
        let node = images.find(|&&node| node != ABSENT);
        3 * node.copied().unwrap_or_default() + component
    }
}

impl fmt::Debug for CyclicRing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CyclicRing")
            .field("n_sectors", &self.n_sectors())
            .field("n_section_nodes", &self.n_section_nodes())
            .finish_non_exhaustive()
    }
}

/// Steps that occur, and the couplings sorted by row and step.
fn links(pattern: &CyclicPattern, place: &[usize], halves: &[i32]) -> (Vec<i32>, Vec<OrderedCoupling>) {
    let step = |row: usize, column: usize, shift: i32| 2 * shift + halves[column] - halves[row];
    let mut steps: Vec<i32> = pattern
        .couplings
        .iter()
        .map(|c| step(place[c.row], place[c.column], c.shift))
        .collect();
    let of_couplings = steps.clone();
    steps.sort_unstable();
    steps.dedup();
    let mut links: Vec<OrderedCoupling> = pattern
        .couplings
        .iter()
        .enumerate()
        .map(|(block, c)| OrderedCoupling {
            row: place[c.row],
            step: steps.partition_point(|&s| s < of_couplings[block]),
            column: place[c.column],
            block,
        })
        .collect();
    links.sort_unstable();
    (steps, links)
}
