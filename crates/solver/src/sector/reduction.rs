//! Block cyclic reduction of the interface, divided among ranks: each factors and keeps the cross-sections behind its
//! sectors.
//!
//! ```text
//! of a level, cross-sections k with the neighbours a, b that stay:
//!     A_kk = L L^T,    W_a = A_ak L^-T,    W_b = A_bk L^-T
//!     A_aa -= W_a W_a^T,    A_bb -= W_b W_b^T,    A_ab -= W_a W_b^T              (factor)
//!     y_k = L^-1 f_k,    f_a -= W_a y_k,    f_b -= W_b y_k                       (forwards)
//!     x_k = L^-T (y_k - W_a^T x_a - W_b^T x_b)                                   (backwards, levels in reverse)
//! ```
//! (Golub and Van Loan, *Matrix Computations*, 4th ed. 2013, section 4.5.4.) Blocks go where they are eliminated;
//! sums run in the order of sectors or cross-sections, so the bits do not depend on the ranks. Vectors of the
//! interface are whole on all ranks. Memory 3 m^2 numbers per cross-section owned; messages per solve: one gather per
//! level, forwards and backwards, in all 4 m numbers per cross-section and right-hand side.

use std::collections::BTreeMap;
use std::ops::Range;

use comm::Communicator;
use dense::cholesky_in_place;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, Par};
use rayon::prelude::*;

use super::agree::agree;
use super::layout::{SectorLayout, reduction};
use crate::cholesky::check_pivot;
use crate::error::SolverError;

/// Elimination of one cross-section.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) section: usize,
    /// Neighbours that stay: two, or one or none at the end.
    pub(super) neighbours: Vec<usize>,
}

/// A block of the matrix: rows and columns by cross-section, the columns being eliminated no later than the rows.
pub(super) type BlockPosition = [usize; 2];

/// A block that a rank adds to the matrix.
#[derive(Clone, Copy, Debug)]
struct Addend {
    source: usize,
    block: BlockPosition,
}

/// The blocks held, by rows and columns.
pub(super) type Blocks = BTreeMap<BlockPosition, Mat<f64>>;

/// What a rank holds of the factor.
#[derive(Debug)]
pub(super) struct OwnInterface {
    /// L of the cross-sections owned.
    pub(super) triangles: BTreeMap<usize, Mat<f64>>,
    /// W by neighbour and cross-section owned.
    pub(super) couplings: Blocks,
}

/// Analysis: who eliminates what when.
#[derive(Clone, Debug)]
pub(super) struct Reduction {
    /// Places of the cross-sections.
    pub(super) sections: Vec<Range<usize>>,
    pub(super) levels: Vec<Vec<Step>>,
    /// Number in the order of elimination.
    turn: Vec<usize>,
    /// Rank of each cross-section.
    pub(super) owner: Vec<usize>,
    pub(super) n_ranks: usize,
    rank: usize,
}

impl Reduction {
    pub(super) fn new(layout: &SectorLayout, comm: Communicator) -> Reduction {
        let n = layout.sectors().len();
        let shares = comm.shares(n);
        let owner = shares
            .iter()
            .enumerate()
            .flat_map(|(r, share)| share.clone().map(move |_| r));
        let mut stay: Vec<usize> = (0..n).collect();
        let (mut levels, mut turn, mut turns) = (Vec::new(), vec![0; n], 0..n);
        for level in reduction(n) {
            let mut steps = Vec::new();
            for &section in &level {
                turn[section] = turns.next().unwrap_or(n);
                let i = stay.binary_search(&section).expect("it has not been eliminated");
                let mut neighbours = vec![
                    stay[(i + stay.len() - 1) % stay.len()],
                    stay[(i + 1) % stay.len()],
                ];
                neighbours.dedup();
                neighbours.retain(|&other| other != section);
                steps.push(Step { section, neighbours });
            }
            stay.retain(|section| !level.contains(section));
            levels.push(steps);
        }
        Reduction {
            sections: layout.sections.clone(),
            levels,
            turn,
            owner: owner.collect(),
            n_ranks: shares.len(),
            rank: comm.rank(),
        }
    }

    /// Bytes of the factor on a rank that owns the given sectors.
    pub(super) fn factor_bytes(&self, owned: Range<usize>) -> usize {
        let own = self
            .levels
            .iter()
            .flatten()
            .filter(|step| owned.contains(&step.section));
        let entries = own.map(|step| {
            let below: usize = step.neighbours.iter().map(|&a| self.rows(a)).sum();
            self.rows(step.section) * (self.rows(step.section) + below)
        });
        size_of::<f64>() * entries.sum::<usize>()
    }

    pub(super) fn rows(&self, section: usize) -> usize {
        self.sections[section].len()
    }

    pub(super) fn is_mine(&self, step: &Step) -> bool {
        self.owner[step.section] == self.rank
    }

    /// The block between two cross-sections.
    fn block(&self, a: usize, b: usize) -> BlockPosition {
        if self.turn[a] >= self.turn[b] {
            [a, b]
        } else {
            [b, a]
        }
    }

    /// Adds the `addends` of all ranks, in their order, to the blocks; `own` are those of this rank, in the same
    /// order. Collective.
    fn add(&self, comm: Communicator, addends: &[Addend], own: Vec<Mat<f64>>, blocks: &mut Blocks) {
        let holder = |addend: &Addend| self.owner[addend.block[1]];
        let size = |addend: &Addend| self.rows(addend.block[0]) * self.rows(addend.block[1]);
        let mut sent = vec![Vec::new(); self.n_ranks];
        let mine = addends.iter().filter(|addend| addend.source == self.rank);
        for (addend, matrix) in mine.zip(own) {
            let message = &mut sent[holder(addend)];
            (0..matrix.ncols()).for_each(|j| message.extend(matrix.col(j).iter()));
        }
        let mut lengths = vec![0; self.n_ranks];
        let kept = || addends.iter().filter(|addend| holder(addend) == self.rank);
        kept().for_each(|addend| lengths[addend.source] += size(addend));
        let received = comm.exchange(sent, &lengths);
        let mut next = starts(&lengths);
        for addend in kept() {
            let [rows, columns] = addend.block.map(|section| self.rows(section));
            let at = &mut next[addend.source];
            let values = &received[*at..*at + size(addend)];
            *at += size(addend);
            let sum = blocks
                .entry(addend.block)
                .or_insert_with(|| Mat::zeros(rows, columns));
            for (j, values) in values.chunks_exact(rows.max(1)).enumerate() {
                let column = sum.col_mut(j).iter_mut();
                column.zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
    }

    /// Eliminates the sum of the complements of all sectors, of which those of the sectors owned are given. Collective.
    pub(super) fn eliminated(
        &self,
        layout: &SectorLayout,
        comm: Communicator,
        complements: Vec<Vec<f64>>,
    ) -> Result<OwnInterface, SolverError> {
        let mut blocks = self.assemble(layout, comm, complements);
        let is_diagonal = |(block, _): &(&BlockPosition, &Mat<f64>)| block[0] == block[1];
        let diagonals: BTreeMap<usize, Vec<f64>> = blocks
            .iter()
            .filter(is_diagonal)
            .map(|(block, matrix)| (block[0], (0..matrix.nrows()).map(|i| matrix[(i, i)]).collect()))
            .collect();
        let (mut triangles, mut couplings) = (BTreeMap::new(), Blocks::new());
        for level in &self.levels {
            let mine: Vec<&Step> = level.iter().filter(|step| self.is_mine(step)).collect();
            let columns: Vec<BlockColumn> = mine.iter().map(|step| self.take(&mut blocks, step)).collect();
            let done: Result<Vec<_>, SolverError> = columns
                .into_par_iter()
                .zip(&mine)
                .map(|(column, step)| {
                    let done = eliminate(column, &diagonals[&step.section]);
                    let places = &layout.interface()[self.sections[step.section].clone()];
                    done.map_err(|error| error.in_whole(layout.n(), |row| places[row]))
                })
                .collect();
            let mut updates = Vec::new();
            for (step, ((triangle, below), update)) in mine.iter().zip(agree(comm, done)?) {
                triangles.insert(step.section, triangle);
                let named = step.neighbours.iter().map(|&a| [a, step.section]);
                couplings.extend(named.zip(below));
                updates.extend(self.oriented(step, update));
            }
            let addends: Vec<Addend> = level.iter().flat_map(|step| self.addends(step)).collect();
            self.add(comm, &addends, updates, &mut blocks);
        }
        Ok(OwnInterface { triangles, couplings })
    }

    /// The blocks of the interface at their holders. Collective.
    fn assemble(&self, layout: &SectorLayout, comm: Communicator, complements: Vec<Vec<f64>>) -> Blocks {
        let n = self.sections.len();
        let of_sector = |s: usize| {
            let (before, behind) = ((s + n - 1) % n, s);
            [[before, before], [behind, behind], self.block(before, behind)]
        };
        let source = |s: usize| self.owner[s];
        let addends: Vec<Addend> = (0..n)
            .flat_map(|s| {
                of_sector(s).map(|block| Addend {
                    source: source(s),
                    block,
                })
            })
            .collect();
        let mine = (0..n).filter(|&s| source(s) == self.rank);
        let mut own = Vec::new();
        for (s, packed) in mine.zip(complements) {
            let boundary = &layout.sectors()[s].boundary;
            let first = |section: usize| {
                let start = self.sections[section].start;
                boundary.partition_point(|&place| place < start)
            };
            for [a, b] in of_sector(s) {
                let (i0, j0) = (first(a), first(b));
                own.push(Mat::from_fn(self.rows(a), self.rows(b), |i, j| {
                    let (i, j) = ((i0 + i).max(j0 + j), (i0 + i).min(j0 + j));
                    packed[i * (i + 1) / 2 + j]
                }));
            }
        }
        let mut blocks = Blocks::new();
        self.add(comm, &addends, own, &mut blocks);
        blocks
    }

    /// Takes the column of a cross-section out of the blocks.
    fn take(&self, blocks: &mut Blocks, step: &Step) -> BlockColumn {
        let k = step.section;
        let mut take = |a: usize| {
            let found = blocks.remove(&[a, k]);
            found.unwrap_or_else(|| Mat::zeros(self.rows(a), self.rows(k)))
        };
        (take(k), step.neighbours.iter().map(|&a| take(a)).collect())
    }

    /// Blocks that an elimination changes: the diagonal ones of its neighbours, then the one between them.
    fn addends(&self, step: &Step) -> Vec<Addend> {
        let mut blocks: Vec<BlockPosition> = step.neighbours.iter().map(|&a| [a, a]).collect();
        if let [a, b] = step.neighbours[..] {
            blocks.push(self.block(a, b));
        }
        let source = self.owner[step.section];
        blocks.into_iter().map(|block| Addend { source, block }).collect()
    }

    /// The changes of an elimination as the blocks are stored; the last is that of rows a and columns b.
    fn oriented(&self, step: &Step, mut updates: Vec<Mat<f64>>) -> Vec<Mat<f64>> {
        if let [a, b] = step.neighbours[..]
            && self.block(a, b) != [a, b]
            && let Some(last) = updates.pop()
        {
            updates.push(last.transpose().to_owned());
        }
        updates
    }
}

/// A diagonal block and those below it.
type BlockColumn = (Mat<f64>, Vec<Mat<f64>>);

/// L and all W of a column, and what they change: -W_a W_a^T of each, and -W_a W_b^T.
fn eliminate(
    (mut matrix, mut below): BlockColumn,
    diagonal: &[f64],
) -> Result<(BlockColumn, Vec<Mat<f64>>), SolverError> {
    cholesky_in_place(matrix.as_mut())?;
    for (row, d) in diagonal.iter().enumerate() {
        let relative_pivot = matrix[(row, row)] * matrix[(row, row)] / d;
        check_pivot(row, matrix.nrows(), relative_pivot)?;
    }
    for w in &mut below {
        solve_lower_triangular_in_place(matrix.as_ref(), w.transpose_mut(), Par::Seq);
    }
    let product = |a: &Mat<f64>, b: &Mat<f64>| {
        let mut product = Mat::zeros(a.nrows(), b.nrows());
        matmul(product.as_mut(), Accum::Replace, a, b.transpose(), -1.0, Par::Seq);
        product
    };
    let mut updates: Vec<Mat<f64>> = below.iter().map(|w| product(w, w)).collect();
    if let [a, b] = &below[..] {
        updates.push(product(a, b));
    }
    Ok(((matrix, below), updates))
}

/// Where each of consecutive pieces starts.
pub(super) fn starts(lengths: &[usize]) -> Vec<usize> {
    let start = |sum: &mut usize, length: &usize| {
        *sum += length;
        Some(*sum - length)
    };
    lengths.iter().scan(0, start).collect()
}
