//! Solution of a dense system in which some small blocks of unknowns see only themselves and the rest.

use std::ops::Range;

use crate::error::DenseError;
use crate::factors::DenseLu;

/// Solves a x = rhs, `a` row-major `[n][n]`, by eliminating `blocks` first: unknowns of different blocks must not be
/// coupled. What is left, the Schur complement D - sum C A^-1 B, is factored as a whole. Without blocks this is
/// [`DenseLu`].
///
/// Cost: the cube of what is left, and of each block its few rows and columns that are not zero.
///
/// # Panics
/// When `a.len() != n * n` or `rhs.len() != n`.
pub fn solve_with_blocks(
    n: usize,
    a: &[f64],
    blocks: &[Range<usize>],
    rhs: &mut [f64],
) -> Result<(), DenseError> {
    assert_eq!(
        (a.len(), rhs.len()),
        (n * n, n),
        "a matrix of {n} rows and its right-hand side"
    );
    if blocks.is_empty() {
        DenseLu::factor(n, a)?.solve(rhs, 1);
        return Ok(());
    }
    let rest = outside(n, blocks);
    let m: usize = rest.iter().map(Range::len).sum();
    let add_rest = |row: &[f64], all: &mut Vec<f64>| {
        rest.iter()
            .for_each(|range| all.extend_from_slice(&row[range.clone()]));
    };
    let rows: Vec<usize> = rest.iter().cloned().flatten().collect();
    let mut left = Vec::with_capacity(m * m);
    rows.iter().for_each(|i| add_rest(&a[n * i..], &mut left));
    let mut right = Vec::with_capacity(m);
    add_rest(rhs, &mut right);
    let mut eliminated = Vec::with_capacity(blocks.len());
    for block in blocks {
        let solved = eliminate((n, a), block, &rows, rhs)?;
        let (width, columns) = (solved.columns.len() + 1, &solved.columns);
        for (k, &i) in rows.iter().enumerate() {
            let couples = &a[n * i..][block.clone()];
            for (c, x) in couples.iter().zip(solved.x.chunks_exact(width)) {
                if *c == 0.0 {
                    continue;
                }
                let row = &mut left[m * k..m * (k + 1)];
                columns.iter().zip(x).for_each(|(j, x)| row[*j] -= c * x);
                right[k] -= c * x[width - 1];
            }
        }
        eliminated.push(solved);
    }
    if m > 0 {
        DenseLu::factor(m, &left)?.solve(&mut right, 1);
    }
    for (block, Eliminated { columns, x }) in blocks.iter().zip(eliminated) {
        for (value, x) in rhs[block.clone()]
            .iter_mut()
            .zip(x.chunks_exact(columns.len() + 1))
        {
            let coupled = columns.iter().zip(x).map(|(j, x)| x * right[*j]);
            *value = x[columns.len()] - coupled.sum::<f64>();
        }
    }
    rows.iter().zip(right).for_each(|(i, value)| rhs[*i] = value);
    Ok(())
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

/// A^-1 [B, rhs] of a block.
struct Eliminated {
    /// Columns of B that are not zero, among those outside of all blocks.
    columns: Vec<usize>,
    /// Row-major.
    x: Vec<f64>,
}

fn eliminate(
    (n, a): (usize, &[f64]),
    block: &Range<usize>,
    outside: &[usize],
    rhs: &[f64],
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
    // Column-major.
    let mut inverse: Vec<f64> = (0..size * size)
        .map(|i| f64::from(u8::from(i % (size + 1) == 0)))
        .collect();
    DenseLu::factor(size, &own)?.solve(&mut inverse, size);
    let mut x = vec![0.0; size * (columns.len() + 1)];
    for (j, i) in block.clone().enumerate() {
        let coupled = columns.iter().map(|k| a[n * i + outside[*k]]);
        let row: Vec<f64> = coupled.chain([rhs[i]]).collect();
        for (x, factor) in x.chunks_exact_mut(row.len()).zip(&inverse[size * j..]) {
            x.iter_mut().zip(&row).for_each(|(x, b)| *x += factor * b);
        }
    }
    Ok(Eliminated { columns, x })
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
            solve_with_blocks(n, &a, &blocks, &mut x).unwrap();
            DenseLu::factor(n, &a).unwrap().solve(&mut expected, 1);
            for (x, e) in x.iter().zip(&expected) {
                assert!((x - e).abs() < 1e-12, "{blocks:?}: {x} {e}");
            }
        }
    }
}
