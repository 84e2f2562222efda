//! Forward solutions Z = L^-1 W of loads with few entries: blocks of the panels that they reach.

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::tree::{NONE, Piece, Tree};
use crate::linear_solver::SparseVector;

/// Columns of Z = L^-1 W. Memory: one number per column and place that it reaches.
#[derive(Clone, Debug, Default)]
pub struct ForwardColumns {
    n_columns: usize,
    /// By pieces of the tree.
    pieces: Vec<PieceColumns>,
}

/// What one piece has.
#[derive(Clone, Debug, Default)]
struct PieceColumns {
    /// Ascending in their panels.
    blocks: Vec<Block>,
    /// Columns of the blocks, one block after the other.
    columns: Vec<u32>,
    values: Vec<f64>,
}

/// The columns that reach a panel.
#[derive(Clone, Debug)]
struct Block {
    panel: usize,
    /// Places among all.
    places: Range<usize>,
    /// Where its columns stand in the list.
    columns: Range<usize>,
    /// Where its values start, row-major `[places][columns]`.
    values: usize,
}

/// What the columns of a subtree add to the top, row-major `[boundary][columns]`.
#[derive(Default)]
struct Sums {
    columns: Vec<u32>,
    values: Vec<f64>,
}

/// Entry of a load in a piece: column, place in the piece, value.
type Entry = (u32, usize, f64);

impl ForwardColumns {
    /// Those of loads whose rows have these `places`.
    pub(super) fn new(tree: &Tree, places: &[usize], loads: &[SparseVector]) -> ForwardColumns {
        let (subtrees, top) = tree.split();
        let mut entries: Vec<Vec<Entry>> = vec![Vec::new(); subtrees.len() + 1];
        for (column, load) in loads.iter().enumerate() {
            for &(row, value) in load {
                let place = places[row];
                let piece = subtrees.partition_point(|piece| piece.places.end <= place);
                let first = subtrees.get(piece).unwrap_or(top).places.start;
                entries[piece].push((column as u32, place - first, value));
            }
        }
        let of_top = entries.pop().unwrap_or_default();
        let jobs = subtrees.par_iter().zip(&entries);
        let (mut pieces, sums): (Vec<_>, Vec<_>) = jobs
            .map(|(piece, entries)| eliminate(tree, piece, entries, &[]))
            .unzip();
        let sums: Vec<(&[usize], Sums)> = subtrees.iter().map(|piece| &*piece.boundary).zip(sums).collect();
        pieces.push(eliminate(tree, top, &of_top, &sums).0);
        ForwardColumns {
            n_columns: loads.len(),
            pieces,
        }
    }

    /// Number of columns.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// Z^T z of values by places, `[n]`: one number per column.
    pub fn values(&self, z: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.n_columns];
        for (columns, places, block) in self.blocks() {
            for (row, z) in block.chunks_exact(columns.len()).zip(&z[places]) {
                columns
                    .iter()
                    .zip(row)
                    .for_each(|(&c, x)| values[c as usize] += z * x);
            }
        }
        values
    }

    /// z + Z f, `[n]`.
    pub fn add_to(&self, z: &mut [f64], f: &[f64]) {
        for (columns, places, block) in self.blocks() {
            for (row, z) in block.chunks_exact(columns.len()).zip(&mut z[places]) {
                *z += columns
                    .iter()
                    .zip(row)
                    .map(|(&c, x)| f[c as usize] * x)
                    .sum::<f64>();
            }
        }
    }

    /// Z^T Y of two sets of columns of one factor, row-major `[n_columns][other.n_columns]`.
    pub fn products(&self, other: &ForwardColumns) -> Vec<f64> {
        let mut products = vec![0.0; self.n_columns * other.n_columns];
        let mut square = Vec::new();
        for (a, b) in self.pieces.iter().zip(&other.pieces) {
            let mut theirs = b.blocks.iter().peekable();
            for own in &a.blocks {
                while theirs.next_if(|their| their.panel < own.panel).is_some() {}
                let Some(their) = theirs.peek().filter(|their| their.panel == own.panel) else {
                    continue;
                };
                let (mine, others) = (&a.columns[own.columns.clone()], &b.columns[their.columns.clone()]);
                square.clear();
                square.resize(mine.len() * others.len(), 0.0);
                matmul(
                    MatMut::from_row_major_slice_mut(&mut square, mine.len(), others.len()),
                    Accum::Replace,
                    a.matrix(own).transpose(),
                    b.matrix(their),
                    1.0,
                    Par::Seq,
                );
                for (&i, row) in mine.iter().zip(square.chunks_exact(others.len())) {
                    let sums = &mut products[other.n_columns * i as usize..][..other.n_columns];
                    others.iter().zip(row).for_each(|(&j, x)| sums[j as usize] += x);
                }
            }
        }
        products
    }

    /// Bytes of the values.
    pub fn bytes(&self) -> usize {
        self.pieces.iter().map(|piece| size_of_val(&*piece.values)).sum()
    }

    /// Columns, places and values of all blocks.
    fn blocks(&self) -> impl Iterator<Item = (&[u32], Range<usize>, &[f64])> {
        self.pieces.iter().flat_map(|piece| {
            piece.blocks.iter().map(move |block| {
                let columns = &piece.columns[block.columns.clone()];
                (columns, block.places.clone(), piece.of(block))
            })
        })
    }
}

impl PieceColumns {
    fn of(&self, block: &Block) -> &[f64] {
        &self.values[block.values..block.values + block.places.len() * block.columns.len()]
    }

    fn matrix(&self, block: &Block) -> MatRef<'_, f64> {
        MatRef::from_row_major_slice(self.of(block), block.places.len(), block.columns.len())
    }
}

/// Which columns reach which panels of a piece: pairs (panel, column), ascending.
fn reach(tree: &Tree, piece: &Piece, entries: &[Entry], sums: &[(&[usize], Sums)]) -> Vec<(u32, u32)> {
    let mut marks = vec![NONE; piece.panels.len()];
    let mut reached = Vec::new();
    let mut climb = |place: usize, column: u32| {
        let mut panel = tree.panel_of[piece.places.start + place];
        while panel != NONE && marks[panel as usize - piece.panels.start] != column {
            marks[panel as usize - piece.panels.start] = column;
            reached.push((panel, column));
            panel = tree.parents[panel as usize];
        }
    };
    entries
        .iter()
        .for_each(|&(column, place, _)| climb(place, column));
    for (boundary, sums) in sums {
        // The rows above a subtree are on one way up, which the first of them begins.
        let first = boundary.iter().take(1);
        first.for_each(|&row| sums.columns.iter().for_each(|&column| climb(row, column)));
    }
    reached.sort_unstable();
    reached.dedup();
    reached
}

/// Blocks for the pairs of [`reach`], all zero, and the values that they take.
fn blocks(tree: &Tree, piece: &Piece, reached: &[(u32, u32)]) -> (Vec<Block>, usize) {
    let (mut blocks, mut n_values): (Vec<Block>, usize) = (Vec::new(), 0);
    let mut first = 0;
    for group in reached.chunk_by(|a, b| a.0 == b.0) {
        let panel = group[0].0 as usize;
        let own = tree.panels.places(panel);
        blocks.push(Block {
            panel,
            places: piece.places.start + own.start..piece.places.start + own.end,
            columns: first..first + group.len(),
            values: n_values,
        });
        n_values += own.len() * group.len();
        first += group.len();
    }
    (blocks, n_values)
}

/// Where the values of some rows of a piece stand.
struct BlockPlace<'a> {
    /// Rows in the piece.
    rows: Range<usize>,
    /// First value, row-major `[rows][columns]`.
    values: usize,
    columns: &'a [u32],
}

/// Each column once, ascending.
fn distinct(mut columns: Vec<u32>) -> Vec<u32> {
    columns.sort_unstable();
    columns.dedup();
    columns
}

/// The block of each panel of a piece; [`NONE`] where no column reaches it.
fn blocks_of_panels(piece: &Piece, blocks: &[Block]) -> Vec<u32> {
    let mut block_of = vec![NONE; piece.panels.len()];
    for (k, block) in blocks.iter().enumerate() {
        block_of[block.panel - piece.panels.start] = k as u32;
    }
    block_of
}

/// Forward solutions in one piece, and what they add to the top.
fn eliminate(
    tree: &Tree,
    piece: &Piece,
    entries: &[Entry],
    sums: &[(&[usize], Sums)],
) -> (PieceColumns, Sums) {
    let reached = reach(tree, piece, entries, sums);
    if reached.is_empty() {
        return Default::default();
    }
    let (blocks, n_values) = blocks(tree, piece, &reached);
    let columns: Vec<u32> = reached.iter().map(|pair| pair.1).collect();
    let all = distinct(columns.clone());
    let block_of = blocks_of_panels(piece, &blocks);
    let inside = piece.places.len();
    let target = |row: usize| {
        if row >= inside {
            return BlockPlace {
                rows: inside..inside + piece.boundary.len(),
                values: n_values,
                columns: &all,
            };
        }
        let panel = tree.panel_of[piece.places.start + row] as usize;
        let block = &blocks[block_of[panel - piece.panels.start] as usize];
        BlockPlace {
            rows: block.places.start - piece.places.start..block.places.end - piece.places.start,
            values: block.values,
            columns: &columns[block.columns.clone()],
        }
    };
    let (mut values, mut buffer) = (vec![0.0; n_values + all.len() * piece.boundary.len()], Vec::new());
    for &(column, place, value) in entries {
        add_rows(&mut values, target, &[column], &[place], &[value]);
    }
    for (boundary, sums) in sums.iter().filter(|(_, sums)| !sums.columns.is_empty()) {
        add_rows(&mut values, target, &sums.columns, boundary, &sums.values);
    }
    for block in &blocks {
        let own = &columns[block.columns.clone()];
        let n_own = block.places.len() * own.len();
        let below = tree.panels.below(block.panel);
        buffer.clear();
        buffer.extend_from_slice(&values[block.values..block.values + n_own]);
        buffer.resize(n_own + below.len() * own.len(), 0.0);
        tree.panels.eliminate(block.panel, &mut buffer, own.len());
        values[block.values..block.values + n_own].copy_from_slice(&buffer[..n_own]);
        add_rows(&mut values, target, own, below, &buffer[n_own..]);
    }
    let above = Sums {
        values: values.split_off(n_values),
        columns: all,
    };
    let own = PieceColumns {
        blocks,
        columns,
        values,
    };
    (own, above)
}

/// Adds values, row-major `[rows][columns]`, to some rows, ascending, of the blocks that have them.
fn add_rows<'a>(
    values: &mut [f64],
    target: impl Fn(usize) -> BlockPlace<'a>,
    columns: &[u32],
    rows: &[usize],
    added: &[f64],
) {
    let mut next = 0;
    let mut positions = Vec::with_capacity(columns.len());
    while next < rows.len() {
        let target = target(rows[next]);
        let n_target = target.columns.len();
        positions.clear();
        let mut at = 0;
        for &column in columns {
            at += target.columns[at..].partition_point(|&c| c < column);
            positions.push(at);
        }
        let count = rows[next..].partition_point(|&row| row < target.rows.end);
        for k in next..next + count {
            let first = target.values + n_target * (rows[k] - target.rows.start);
            let row = &mut values[first..first + n_target];
            let added = &added[columns.len() * k..columns.len() * (k + 1)];
            if n_target == columns.len() {
                row.iter_mut().zip(added).for_each(|(x, v)| *x += v);
            } else {
                positions.iter().zip(added).for_each(|(&at, v)| row[at] += v);
            }
        }
        next += count;
    }
}
