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
    let in_block = |i: usize| blocks.iter().any(|block| block.contains(&i));
    let rest: Vec<usize> = (0..n).filter(|i| !in_block(*i)).collect();
    let m = rest.len();
    let row_of = |i: &usize| {
        let row = &a[n * i..n * (i + 1)];
        rest.iter().map(|j| row[*j]).collect::<Vec<f64>>()
    };
    let mut left: Vec<f64> = rest.iter().flat_map(row_of).collect();
    let mut right: Vec<f64> = rest.iter().map(|i| rhs[*i]).collect();
    let mut inner = Vec::new();
    for block in blocks {
        let size = block.len();
        let own: Vec<f64> = block
            .clone()
            .flat_map(|i| a[n * i + block.start..n * i + block.end].to_vec())
            .collect();
        let lu = DenseLu::factor(size, &own)?;
        let is_some = |j: &usize| block.clone().any(|i| a[n * i + rest[*j]] != 0.0);
        let columns: Vec<usize> = (0..m).filter(is_some).collect();
        // A^-1 [B, rhs], column-major.
        let mut solved: Vec<f64> = columns
            .iter()
            .flat_map(|j| block.clone().map(|i| a[n * i + rest[*j]]))
            .chain(rhs[block.clone()].iter().copied())
            .collect();
        lu.solve(&mut solved, columns.len() + 1);
        let (x, y) = solved.split_at(size * columns.len());
        for (k, i) in rest.iter().enumerate() {
            let row = &a[n * i + block.start..n * i + block.end];
            if row.iter().all(|c| *c == 0.0) {
                continue;
            }
            let product = |v: &[f64]| row.iter().zip(v).map(|(c, v)| c * v).sum::<f64>();
            for (column, x) in columns.iter().zip(x.chunks_exact(size)) {
                left[m * k + column] -= product(x);
            }
            right[k] -= product(y);
        }
        inner.push((columns, solved));
    }
    if m > 0 {
        DenseLu::factor(m, &left)?.solve(&mut right, 1);
    }
    for (block, (columns, solved)) in blocks.iter().zip(inner) {
        let size = block.len();
        let (x, y) = solved.split_at(size * columns.len());
        rhs[block.clone()].copy_from_slice(y);
        for (column, x) in columns.iter().zip(x.chunks_exact(size)) {
            for (value, x) in rhs[block.clone()].iter_mut().zip(x) {
                *value -= x * right[*column];
            }
        }
    }
    rest.iter().zip(right).for_each(|(i, value)| rhs[*i] = value);
    Ok(())
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
