//! Links whose tangent is not symmetric, as of patches that go along, in an eigenproblem that is.
//!
//! The symmetric half of a tangent T gives the first order of each frequency exactly, but not what the ring answers to
//! the half that is missing, and a load beside a patch moves the ring much there. With the compliance P of the rings at
//! the lengths of the link, others see of it t = T_r l, where l is what they do to the lengths,
//!
//! ```text
//! T_r = T (1 + P T)^-1,       T' = T_s (1 - P T_s)^-1,       T_s the symmetric half of T_r
//! ```
//!
//! T' is symmetric, and they see T_s of it. What is left out is of the second order in the answers of other links.

use std::ops::Range;

use dense::{DenseError, DenseLu};
use ring::VibratingRings;

use super::blocks::Answer;
use super::columns::{Column, LinkTangent};

/// Difference of entries that mirror each other, over the largest, below which a tangent is symmetric to round-off.
const ROUND_OFF: f64 = 1e-12;

/// Makes the tangents of all links symmetric, whose `columns` come first, by what the rings answer to these.
pub fn make_symmetric(
    links: &mut [LinkTangent],
    columns: &[Column],
    (groups, answers): (&[VibratingRings], &[Answer]),
) -> Result<(), DenseError> {
    let mut first = 0;
    for link in links {
        let n = link.lengths.len();
        if !is_symmetric(n, &link.tangent) {
            let compliance = compliance(columns, first..first + n, (groups, answers));
            link.tangent = symmetric_tangent(n, &link.tangent, &compliance)?;
        }
        first += n;
    }
    Ok(())
}

fn is_symmetric(n: usize, tangent: &[f64]) -> bool {
    let largest = tangent.iter().fold(0.0f64, |most, entry| most.max(entry.abs()));
    let parts = |e: usize| tangent[e] - tangent[n * (e % n) + e / n];
    (0..n * n).all(|e| parts(e).abs() <= ROUND_OFF * largest)
}

/// Motions of columns under the unit forces of each other, of the rings alone, m/N: row-major.
fn compliance(
    columns: &[Column],
    own: Range<usize>,
    (groups, answers): (&[VibratingRings], &[Answer]),
) -> Vec<f64> {
    let n = own.len();
    let mut compliance = vec![0.0; n * n];
    for (i, (answer, group)) in answers.iter().zip(groups).enumerate() {
        let fields = answer.numbers.iter().zip(answer.columns.chunks_exact(group.n()));
        for (&k, field) in fields.filter(|(k, _)| own.contains(k)) {
            for j in own.clone() {
                let growth = &columns[j].growth;
                if growth.ring.as_ref().is_some_and(|(of, _)| *of == i) {
                    compliance[n * (j - own.start) + k - own.start] = growth.in_rings(|_| field);
                }
            }
        }
    }
    compliance
}

/// T' of a tangent and the compliance, m/N, of the rings at its `n` lengths, row-major, `[n][n]` each.
fn symmetric_tangent(n: usize, tangent: &[f64], compliance: &[f64]) -> Result<Vec<f64>, DenseError> {
    let seen = over(n, tangent, compliance, 1.0)?;
    let half = symmetric_half(n, &seen);
    Ok(symmetric_half(n, &over(n, &half, compliance, -1.0)?))
}

/// T (1 + sign P T)^-1.
fn over(n: usize, tangent: &[f64], compliance: &[f64], sign: f64) -> Result<Vec<f64>, DenseError> {
    let mut matrix = product(n, compliance, tangent);
    matrix.iter_mut().for_each(|entry| *entry *= sign);
    (0..n).for_each(|i| matrix[n * i + i] += 1.0);
    Ok(product(n, tangent, &DenseLu::factor(n, &matrix)?.inverse()))
}

fn product(n: usize, a: &[f64], b: &[f64]) -> Vec<f64> {
    let entry = |e: usize| (0..n).map(|k| a[n * (e / n) + k] * b[n * k + e % n]).sum();
    (0..n * n).map(entry).collect()
}

fn symmetric_half(n: usize, a: &[f64]) -> Vec<f64> {
    let entry = |e: usize| 0.5 * (a[e] + a[n * (e % n) + e / n]);
    (0..n * n).map(entry).collect()
}
