//! The kernels on plain numbers and in vector registers.

use super::super::number::{Hermitian, Real};
use super::super::order::ordered;
use super::super::sweep::{Solve, Sweeps};
use super::*;

/// Numbers between -1 and 1 by a fixed rule.
fn numbers(n: usize) -> Vec<f64> {
    let mixed = |i: u64| (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11;
    (0..n as u64)
        .map(|i| mixed(i) as f64 / (1_u64 << 52) as f64 - 1.0)
        .collect()
}

/// Solution of one system by the processor's registers or, with `simd`, by plain numbers.
fn solution<F: Form>(simd: Option<pulp::Scalar>) -> Vec<f64> {
    let neighbours = vec![vec![1, 3], vec![0, 2], vec![1, 3, 4], vec![0, 2], vec![2]];
    let (_, rows) = ordered(&neighbours, &[]);
    let n = rows.n();
    let len = 9 * F::PARTS * LANES;
    let mut values = numbers(len * rows.n_blocks());
    for i in 0..n {
        let diagonal = &mut values[rows.place(i, i) * len..][..len];
        for component in 0..3 {
            let entry = &mut diagonal[4 * component * F::PARTS * LANES..][..F::PARTS * LANES];
            entry[..LANES].iter_mut().for_each(|x| *x += 40.0);
            entry[LANES..].fill(0.0);
        }
    }
    let mut ratios = vec![0.0; 3 * LANES * n];
    let mut x = numbers(6 * LANES * n);
    let factorise = Factorise::<F> {
        rows: &rows,
        values: &mut values,
        ratios: &mut ratios,
        form: PhantomData,
    };
    match simd {
        Some(simd) => factorise.with_simd(simd),
        None => pulp::Arch::new().dispatch(factorise),
    }
    assert!(ratios.iter().all(|&ratio| ratio > 0.5 && ratio <= 1.0));
    let solve = Solve::<F, 1> {
        rows: &rows,
        values: &values,
        columns: [&mut x],
        sweeps: Sweeps::Whole,
        form: PhantomData,
    };
    match simd {
        Some(simd) => solve.with_simd(simd),
        None => pulp::Arch::new().dispatch(solve),
    }
    x
}

/// Wrong: a processor without vector instructions would get other solutions, and nobody would notice on one that has
/// them.
#[test]
fn plain_numbers_and_vector_registers_give_the_same_solution() {
    let pairs = [
        (
            solution::<Real>(Some(pulp::Scalar::new())),
            solution::<Real>(None),
        ),
        (
            solution::<Hermitian>(Some(pulp::Scalar::new())),
            solution::<Hermitian>(None),
        ),
    ];
    for (plain, vector) in pairs {
        let largest = plain.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (a, b) in plain.iter().zip(&vector) {
            // Fused multiplication and addition rounds once less.
            assert!((a - b).abs() <= 1e-14 * largest, "{a:e} {b:e}");
        }
    }
}
