//! Principal submatrices, with which clamped degrees of freedom are taken out.

use sprs::CsMat;

/// Rows and columns `keep` of a square matrix, in that order: entry (i, j) of the result is entry `(keep[i], keep[j])`.
/// `keep` holds distinct rows. Storage (rows or columns) is kept. Time O(nnz) for increasing `keep`.
///
/// # Panics
/// When the matrix is not square, or `keep` repeats a row or names one outside.
pub fn restrict(matrix: &CsMat<f64>, keep: &[usize]) -> CsMat<f64> {
    select(matrix, keep, |_, _| true)
}

/// The lower triangle, diagonal included, of [`restrict`]: all that [`crate::Symbolic`] needs of a symmetric matrix,
/// with half its memory here and in the permuted copy that a factorisation makes.
///
/// # Panics
/// As [`restrict`].
pub fn restrict_lower(matrix: &CsMat<f64>, keep: &[usize]) -> CsMat<f64> {
    if matrix.is_csc() {
        select(matrix, keep, |column, row| row >= column)
    } else {
        select(matrix, keep, |row, column| column <= row)
    }
}

/// Entries of the rows and columns `keep` for which `is_wanted(outer, inner)`, in the new numbering.
fn select(matrix: &CsMat<f64>, keep: &[usize], is_wanted: impl Fn(usize, usize) -> bool) -> CsMat<f64> {
    let n = matrix.rows();
    assert_eq!(n, matrix.cols(), "a principal submatrix needs a square matrix");
    let mut new_index = vec![usize::MAX; n];
    for (new, &old) in keep.iter().enumerate() {
        assert!(new_index[old] == usize::MAX, "row {old} is kept twice");
        new_index[old] = new;
    }
    let is_kept = |outer: usize, inner: usize| inner != usize::MAX && is_wanted(outer, inner);
    let mut indptr = Vec::with_capacity(keep.len() + 1);
    indptr.push(0);
    let mut n_entries = 0;
    for (outer, &old) in keep.iter().enumerate() {
        let vector = matrix.outer_view(old);
        n_entries += vector.map_or(0, |vector| {
            let indices = vector.indices().iter();
            indices.filter(|&&inner| is_kept(outer, new_index[inner])).count()
        });
        indptr.push(n_entries);
    }
    let (mut indices, mut data) = (Vec::with_capacity(n_entries), Vec::with_capacity(n_entries));
    let increasing = keep.windows(2).all(|pair| pair[0] < pair[1]);
    let mut entries = Vec::new();
    for (outer, &old) in keep.iter().enumerate() {
        let Some(vector) = matrix.outer_view(old) else {
            continue;
        };
        entries.clear();
        let renumbered = vector.iter().map(|(inner, &value)| (new_index[inner], value));
        entries.extend(renumbered.filter(|&(inner, _)| is_kept(outer, inner)));
        if !increasing {
            entries.sort_unstable_by_key(|&(inner, _)| inner);
        }
        indices.extend(entries.iter().map(|&(inner, _)| inner));
        data.extend(entries.iter().map(|&(_, value)| value));
    }
    let shape = (keep.len(), keep.len());
    if matrix.is_csc() {
        CsMat::new_csc(shape, indptr, indices, data)
    } else {
        CsMat::new(shape, indptr, indices, data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this failed, a clamped ring would be solved with the stiffness of other degrees of freedom.
    #[test]
    fn a_submatrix_has_the_entries_of_the_rows_and_columns_kept() {
        let n = 7;
        let mut triplets = sprs::TriMat::new((n, n));
        for i in 0..n {
            for j in (0..n).filter(|j| (i + j) % 3 != 1) {
                triplets.add_triplet(i, j, (10 * i + j) as f64 + 1.0);
            }
        }
        for matrix in [triplets.to_csr::<usize>(), triplets.to_csc()] {
            for keep in [vec![], vec![3], vec![0, 2, 3, 6], vec![6, 1, 4], (0..n).collect()] {
                let (part, lower) = (restrict(&matrix, &keep), restrict_lower(&matrix, &keep));
                assert_eq!(part.shape(), (keep.len(), keep.len()));
                assert_eq!(part.is_csc(), matrix.is_csc());
                for (i, &old_i) in keep.iter().enumerate() {
                    for (j, &old_j) in keep.iter().enumerate() {
                        assert_eq!(
                            part.get(i, j),
                            matrix.get(old_i, old_j),
                            "entry {i}, {j} of {keep:?}"
                        );
                        let expected = part.get(i, j).filter(|_| j <= i);
                        assert_eq!(lower.get(i, j), expected, "lower entry {i}, {j} of {keep:?}");
                    }
                }
            }
        }
    }
}
