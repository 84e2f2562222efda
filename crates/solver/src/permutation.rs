//! Elimination orders: `order[k]` is the row eliminated in place `k`.

use crate::error::SolverError;

/// Order of degrees of freedom from an order of nodes: node `i` owns the rows `dofs_per_node * i ..`, which stay
/// together. Output `[dofs_per_node * order.len()]`.
pub fn expand(order: &[usize], dofs_per_node: usize) -> Vec<usize> {
    order
        .iter()
        .flat_map(|&node| (0..dofs_per_node).map(move |dof| dofs_per_node * node + dof))
        .collect()
}

/// Order of the rows that stay when only `keep` (distinct rows, in the order of the new numbering) is kept.
/// Goes with [`crate::restrict`]. Rows of `keep` that `order` does not name are left out, which
/// [`crate::Symbolic::new`] reports.
pub fn restrict_order(order: &[usize], keep: &[usize]) -> Vec<usize> {
    let n = order.iter().chain(keep).max().map_or(0, |&row| row + 1);
    let mut new_row = vec![usize::MAX; n];
    for (new, &old) in keep.iter().enumerate() {
        new_row[old] = new;
    }
    order
        .iter()
        .map(|&row| new_row[row])
        .filter(|&row| row != usize::MAX)
        .collect()
}

/// Inverse of an order of `n` rows: `inverse[order[k]] = k`.
pub(crate) fn invert(order: &[usize], n: usize) -> Result<Vec<usize>, SolverError> {
    let length = order.len();
    let mut inverse = vec![usize::MAX; n];
    for (position, &row) in order.iter().enumerate() {
        if row >= n || inverse[row] != usize::MAX {
            return Err(SolverError::NotPermutation { length, n, position });
        }
        inverse[row] = position;
    }
    if length != n {
        return Err(SolverError::NotPermutation {
            length,
            n,
            position: length,
        });
    }
    Ok(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this failed, the order of a clamped ring would name rows that no longer exist.
    #[test]
    fn a_restricted_order_keeps_the_sequence_and_renumbers() {
        let order = expand(&[2, 0, 1], 2);
        assert_eq!(order, [4, 5, 0, 1, 2, 3]);
        assert_eq!(restrict_order(&order, &[1, 2, 5]), [2, 0, 1]);
        assert!(restrict_order(&order, &[]).is_empty());
    }

    /// If this failed, a wrong order would reach the factorisation, which trusts it.
    #[test]
    fn an_order_that_repeats_or_lacks_a_row_is_refused_at_its_position() {
        assert_eq!(invert(&[1, 0, 2], 3), Ok(vec![1, 0, 2]));
        for (order, position) in [
            (vec![0, 1, 1], 2),
            (vec![0, 3, 1], 1),
            (vec![0, 1], 2),
            (vec![0, 1, 2, 0], 3),
        ] {
            let length = order.len();
            assert_eq!(
                invert(&order, 3),
                Err(SolverError::NotPermutation {
                    length,
                    n: 3,
                    position
                })
            );
        }
    }
}
