//! Factors of a dense matrix in which some small blocks of unknowns see only themselves and the rest.

use std::borrow::Cow;
use std::ops::Range;

use crate::error::DenseError;
use crate::factors::DenseLu;

/// LU factors of a matrix `[n][n]` whose `blocks` are eliminated first: unknowns of different blocks must not be
/// coupled. What is left, the Schur complement D - sum C A^-1 B, is factored as a whole. Without blocks this is
/// [`DenseLu`].
///
/// Cost: the cube of what is left, and of each block its few rows and columns that are not zero.
#[derive(Clone, Debug)]
pub struct BlockLu {
    n: usize,
    blocks: Vec<Eliminated>,
    /// Unknowns outside of all blocks.
    rest: Vec<usize>,
    left: Option<DenseLu>,
}

impl BlockLu {
    /// Factors `a`, row-major `[n][n]`.
    ///
    /// # Panics
    /// When `a.len() != n * n`.
    pub fn factor(n: usize, a: &[f64], blocks: &[Range<usize>]) -> Result<BlockLu, DenseError> {
        assert_eq!(a.len(), n * n, "a matrix of {n} rows");
        let ranges = outside(n, blocks);
        let rest: Vec<usize> = ranges.iter().cloned().flatten().collect();
        let m = rest.len();
        let mut left = Cow::Borrowed(a);
        if !blocks.is_empty() {
            let mut part = Vec::with_capacity(m * m);
            for row in rest.iter().map(|i| &a[n * i..n * (i + 1)]) {
                ranges
                    .iter()
                    .for_each(|range| part.extend_from_slice(&row[range.clone()]));
            }
            left = Cow::Owned(part);
        }
        let eliminate = |block: &Range<usize>| {
            let eliminated = Eliminated::new((n, a), block, &rest)?;
            eliminated.subtract_from(m, left.to_mut());
            Ok(eliminated)
        };
        let blocks = blocks.iter().map(eliminate).collect::<Result<_, DenseError>>()?;
        let left = (m > 0).then(|| DenseLu::factor(m, &left)).transpose()?;
        Ok(BlockLu {
            n,
            blocks,
            rest,
            left,
        })
    }

    /// Replaces a right-hand side by the solution.
    ///
    /// # Panics
    /// When `rhs.len()` is not the number of rows.
    pub fn solve(&self, rhs: &mut [f64]) {
        assert_eq!(rhs.len(), self.n, "a right-hand side of {} rows", self.n);
        let mut right: Vec<f64> = self.rest.iter().map(|i| rhs[*i]).collect();
        for block in &self.blocks {
            let x = block.inverse_times(rhs);
            for (k, couples) in block.couples() {
                right[k] -= couples.iter().zip(&x).map(|(c, x)| c * x).sum::<f64>();
            }
            rhs[block.range.clone()].copy_from_slice(&x);
        }
        if let Some(left) = &self.left {
            left.solve(&mut right, 1);
        }
        for block in &self.blocks {
            let width = block.columns.len().max(1);
            for (value, row) in rhs[block.range.clone()].iter_mut().zip(block.x.chunks(width)) {
                let coupled = block.columns.iter().zip(row).map(|(j, x)| x * right[*j]);
                *value -= coupled.sum::<f64>();
            }
        }
        self.rest.iter().zip(right).for_each(|(i, value)| rhs[*i] = value);
    }
}

/// What no block has, ascending.
fn outside(n: usize, blocks: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut sorted: Vec<&Range<usize>> = blocks.iter().collect();
    sorted.sort_unstable_by_key(|block| block.start);
    let ends = sorted.iter().map(|block| block.end);
    let starts = sorted.iter().map(|block| block.start);
    std::iter::once(0)
        .chain(ends)
        .zip(starts.chain([n]))
        .map(|(start, end)| start..end)
        .filter(|range| !range.is_empty())
        .collect()
}

/// A block, and the parts of B and C that are not zero.
#[derive(Clone, Debug)]
struct Eliminated {
    range: Range<usize>,
    /// Column-major.
    inverse: Vec<f64>,
    /// Columns of B that are not zero, among those outside of all blocks.
    columns: Vec<usize>,
    /// A^-1 B, row-major.
    x: Vec<f64>,
    /// Rows of C that are not zero, likewise.
    rows: Vec<usize>,
    /// These, row-major.
    c: Vec<f64>,
}

impl Eliminated {
    fn new(
        (n, a): (usize, &[f64]),
        block: &Range<usize>,
        outside: &[usize],
    ) -> Result<Eliminated, DenseError> {
        let size = block.len();
        let mut own = Vec::with_capacity(size * size);
        let mut is_some = vec![false; outside.len()];
        for i in block.clone() {
            let row = &a[n * i..n * (i + 1)];
            own.extend_from_slice(&row[block.clone()]);
            is_some
                .iter_mut()
                .zip(outside)
                .for_each(|(is, j)| *is |= row[*j] != 0.0);
        }
        let columns: Vec<usize> = (0..outside.len()).filter(|k| is_some[*k]).collect();
        let mut inverse: Vec<f64> = (0..size * size)
            .map(|i| f64::from(u8::from(i % (size + 1) == 0)))
            .collect();
        DenseLu::factor(size, &own)?.solve(&mut inverse, size);
        let mut x = vec![0.0; size * columns.len()];
        for (i, inverse) in block.clone().zip(inverse.chunks_exact(size)) {
            let row: Vec<f64> = columns.iter().map(|k| a[n * i + outside[*k]]).collect();
            for (x, factor) in x.chunks_exact_mut(row.len().max(1)).zip(inverse) {
                x.iter_mut().zip(&row).for_each(|(x, b)| *x += factor * b);
            }
        }
        let couples = |i: usize| &a[n * i..][block.clone()];
        let is_coupled = |k: &usize| couples(outside[*k]).iter().any(|c| *c != 0.0);
        let rows: Vec<usize> = (0..outside.len()).filter(is_coupled).collect();
        let c = rows.iter().flat_map(|k| couples(outside[*k])).copied().collect();
        Ok(Eliminated {
            range: block.clone(),
            inverse,
            columns,
            x,
            rows,
            c,
        })
    }

    /// Rows of C that are not zero, each with its number outside.
    fn couples(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.rows
            .iter()
            .copied()
            .zip(self.c.chunks_exact(self.range.len().max(1)))
    }

    /// Subtracts C A^-1 B from what is left, row-major `[m][m]`.
    fn subtract_from(&self, m: usize, left: &mut [f64]) {
        let width = self.columns.len().max(1);
        for (k, couples) in self.couples() {
            let row = &mut left[m * k..m * (k + 1)];
            for (c, x) in couples.iter().zip(self.x.chunks(width)) {
                if *c != 0.0 {
                    self.columns.iter().zip(x).for_each(|(j, x)| row[*j] -= c * x);
                }
            }
        }
    }

    /// A^-1 of the block's part of a vector.
    fn inverse_times(&self, rhs: &[f64]) -> Vec<f64> {
        let size = self.range.len();
        let mut x = vec![0.0; size];
        for (column, value) in self
            .inverse
            .chunks_exact(size.max(1))
            .zip(&rhs[self.range.clone()])
        {
            x.iter_mut().zip(column).for_each(|(x, a)| *x += a * value);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: an elimination that forgets a coupling. The same solution as that of the whole matrix, with blocks at the
    /// start, in the middle, all over, and none.
    #[test]
    fn blocks_change_nothing_but_the_cost() {
        let n = 11;
        for blocks in [
            vec![],
            vec![1..3, 3..6, 8..10],
            vec![0..4, 4..9],
            vec![0..5, 5..11],
        ] {
            let of = |i: usize| blocks.iter().position(|block: &Range<usize>| block.contains(&i));
            let entry = |i: usize, j: usize| match (of(i), of(j)) {
                (Some(a), Some(b)) if a != b => 0.0,
                _ if i == j => 7.0,
                _ => ((i * 13 + j * 7) % 11) as f64 / 5.0 - 1.0,
            };
            let a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
            let rhs: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
            let (mut x, mut expected) = (rhs.clone(), rhs);
            BlockLu::factor(n, &a, &blocks).unwrap().solve(&mut x);
            DenseLu::factor(n, &a).unwrap().solve(&mut expected, 1);
            for (x, e) in x.iter().zip(&expected) {
                assert!((x - e).abs() < 1e-12, "{blocks:?}: {x} {e}");
            }
        }
    }
}
