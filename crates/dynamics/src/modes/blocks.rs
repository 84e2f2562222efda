//! Blocks of vectors over groups of rings and small dofs: taken apart group by group, and put together.

use dense::add_combinations;
use rayon::prelude::*;
use ring::VibratingRings;
use ring::vectors::rows_of;

/// What one group answers to forces on its columns.
pub struct Answer {
    /// Numbers of the columns.
    pub numbers: Vec<usize>,
    /// S^-1 of them, column-major.
    pub columns: Vec<f64>,
}

impl Answer {
    /// Takes off what forces do to a block of vectors: rows of blocks of `n` unknowns, in a unit, N.
    pub fn subtract(&self, (unknowns, n): (&[f64], usize), unit: f64, block: &mut [f64]) {
        let n_own = self.numbers.len();
        if n_own == 0 {
            return;
        }
        let (n_rows, n_vectors) = (self.columns.len() / n_own, unknowns.len() / n);
        let forces = |rhs: &[f64]| self.numbers.iter().map(|&j| rhs[j]).collect::<Vec<f64>>();
        let forces: Vec<f64> = unknowns.chunks_exact(n).flat_map(forces).collect();
        add_combinations(n_rows, block, (&self.columns, n_own), (&forces, n_vectors), -unit);
    }
}

/// What each group makes of its rows of a block of vectors of `n` rows, column-major.
pub fn of_each_group(
    groups: &[VibratingRings],
    (x, n): (&[f64], usize),
    make: impl Fn(&VibratingRings, Vec<f64>) -> Vec<f64> + Sync,
) -> Vec<Vec<f64>> {
    let of_group = |(i, group): (usize, &VibratingRings)| {
        let start: usize = groups[..i].iter().map(VibratingRings::n).sum();
        make(group, rows_of(x, n, &(start..start + group.n())))
    };
    groups.par_iter().enumerate().map(of_group).collect()
}

/// Blocks of all groups as one of `n_vectors` vectors of `n` rows; zero for the small dofs.
pub fn together(groups: &[VibratingRings], parts: &[Vec<f64>], [n, n_vectors]: [usize; 2]) -> Vec<f64> {
    let mut all = vec![0.0; n * n_vectors];
    let mut start = 0;
    for (group, part) in groups.iter().zip(parts) {
        for (y, own) in all.chunks_exact_mut(n).zip(part.chunks_exact(group.n())) {
            y[start..start + group.n()].copy_from_slice(own);
        }
        start += group.n();
    }
    all
}
