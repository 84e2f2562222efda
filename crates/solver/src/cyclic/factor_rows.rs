//! Which blocks a factor of a section has: exactly those that elimination makes.
//!
//! Column j of the factor couples the nodes that node j is coupled with when it is eliminated: its neighbours and
//! those of the columns that have j as their first row (George and Liu, *Computer Solution of Large Sparse Positive
//! Definite Systems*, 1981, section 5.2).

/// Rows of a block factor: row i has blocks at ascending columns, the last one on the diagonal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FactorRows {
    /// Where each row begins among the blocks, `[n + 1]`.
    starts: Vec<usize>,
    /// Column of each block.
    columns: Vec<usize>,
    pub(super) memory: Memory,
}

/// How blocks follow each other in memory, which is read fastest in ascending order: as the sweep meets them that
/// reads them first, before they are in the cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Memory {
    /// Row by row: forwards.
    Forward,
    /// The other way round, the last row's diagonal first: backwards.
    Backward,
}

/// Neighbouring blocks of one row, by their number in ascending order of columns.
#[derive(Clone, Copy)]
pub(super) struct BlockRun<'a> {
    pub(super) columns: &'a [usize],
    /// Place in memory of the one that is first there.
    pub(super) first: usize,
    memory: Memory,
}

impl BlockRun<'_> {
    /// Place in the memory of the run of block k.
    #[inline(always)]
    pub(super) fn place(&self, k: usize) -> usize {
        match self.memory {
            Memory::Forward => k,
            Memory::Backward => self.columns.len() - 1 - k,
        }
    }
}

impl FactorRows {
    /// Rows of an order. `neighbours[a]` lists the nodes coupled with node a.
    pub(crate) fn new(neighbours: &[Vec<usize>], order: &[usize], memory: Memory) -> FactorRows {
        let n = order.len();
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let mut rows: Vec<Vec<usize>> = vec![Vec::new(); n];
        // What eliminated columns leave to the column that is their first row.
        let mut left: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (j, &node) in order.iter().enumerate() {
            let mut below = std::mem::take(&mut left[j]);
            below.extend(neighbours[node].iter().map(|&other| place[other]));
            below.retain(|&i| i > j);
            below.sort_unstable();
            below.dedup();
            below.iter().for_each(|&i| rows[i].push(j));
            rows[j].push(j);
            if let Some(&first) = below.first() {
                left[first].extend(below);
            }
        }
        let mut starts = vec![0];
        starts.extend(rows.iter().scan(0, |end, row| {
            *end += row.len();
            Some(*end)
        }));
        FactorRows {
            starts,
            columns: rows.concat(),
            memory,
        }
    }

    /// Number of block rows.
    pub(crate) fn n(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of blocks.
    pub(crate) fn n_blocks(&self) -> usize {
        self.columns.len()
    }

    /// Columns of row i, ascending, the last one i.
    pub(crate) fn columns(&self, i: usize) -> &[usize] {
        &self.columns[self.starts[i]..self.starts[i + 1]]
    }

    /// All blocks of row i.
    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> BlockRun<'_> {
        self.run(self.starts[i], self.starts[i + 1])
    }

    /// Blocks of row i at the columns from `first` on.
    #[inline(always)]
    pub(super) fn since_column(&self, i: usize, first: usize) -> BlockRun<'_> {
        let skipped = match first {
            0 => 0,
            first => self.columns(i).partition_point(|&j| j < first),
        };
        self.run(self.starts[i] + skipped, self.starts[i + 1])
    }

    /// Blocks of row i at the columns before `end`.
    #[inline(always)]
    pub(super) fn before_column(&self, i: usize, end: usize) -> BlockRun<'_> {
        let start = self.starts[i];
        self.run(start, start + self.columns(i).partition_point(|&j| j < end))
    }

    #[inline(always)]
    fn run(&self, start: usize, end: usize) -> BlockRun<'_> {
        BlockRun {
            columns: &self.columns[start..end],
            first: match self.memory {
                Memory::Forward => start,
                Memory::Backward => self.n_blocks() - end,
            },
            memory: self.memory,
        }
    }

    /// Place in memory of block (i, j), which exists.
    pub(crate) fn place(&self, i: usize, j: usize) -> usize {
        let row = self.row(i);
        let k = row.columns.binary_search(&j);
        row.first + row.place(k.expect("a coupling is in the factor"))
    }

    /// Products of blocks in a factorisation.
    pub(crate) fn n_products(&self) -> usize {
        let mut below = vec![0; self.n()];
        self.columns.iter().for_each(|&j| below[j] += 1);
        below
            .iter()
            .map(|&with_diagonal| with_diagonal * (with_diagonal - 1) / 2)
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a block that elimination makes would be missing, or one stored that is always zero.
    #[test]
    fn rows_hold_what_elimination_makes() {
        // A path 0-1-2-3-4 with 0-3; eliminating 0 couples 1 and 3, 1 then 2 and 3.
        let neighbours = vec![vec![1, 3], vec![0, 2], vec![1, 3], vec![0, 2, 4], vec![3]];
        let rows = FactorRows::new(&neighbours, &[0, 1, 4, 2, 3], Memory::Forward);
        let columns: Vec<&[usize]> = (0..5).map(|i| rows.columns(i)).collect();
        assert_eq!(columns, [&[0][..], &[0, 1], &[2], &[1, 3], &[0, 1, 2, 3, 4]]);
        assert_eq!((rows.n(), rows.n_blocks()), (5, 11));
        // Columns with 2, 2, 1, 1 and 0 blocks below the diagonal.
        assert_eq!(rows.n_products(), 3 + 3 + 1 + 1);
        assert_eq!([rows.place(0, 0), rows.place(4, 2), rows.place(4, 4)], [0, 8, 10]);
        let backward = FactorRows::new(&neighbours, &[0, 1, 4, 2, 3], Memory::Backward);
        let places = [backward.place(0, 0), backward.place(4, 2), backward.place(4, 4)];
        assert_eq!(places, [10, 2, 0]);
    }
}
