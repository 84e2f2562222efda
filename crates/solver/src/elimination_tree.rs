//! Elimination tree of a symmetric pattern and the postorder of a permutation.
//!
//! A postorder is equivalent to the original order (same fill, same flops), but puts every subtree into consecutive
//! columns, so that columns of equal pattern become one supernode. Measured on a 60 k dof ring: without it 1.8x as
//! many supernodes, factorisation 1.4x and solve 1.3x slower. Liu, *The role of elimination trees in sparse
//! factorization*, SIAM J. Matrix Anal. Appl. 11 (1990) 134, sections 3 and 6, doi:10.1137/0611010. Time
//! O(nnz(A) log n) at worst, in practice O(nnz(A)).

use sprs::CsMat;

const NONE: usize = usize::MAX;

/// Reorders `order` (with inverse `inverse`) by a postorder of the elimination tree of the permuted matrix, of which
/// the lower triangle is read. Children come by increasing subtree size, so that the largest is adjacent to its
/// parent and may merge with it.
pub(crate) fn postordered(matrix: &CsMat<f64>, order: &[usize], inverse: &[usize]) -> Vec<usize> {
    let parent = elimination_tree(matrix, inverse);
    postorder(&parent).into_iter().map(|k| order[k]).collect()
}

/// Parent of each column of the permuted matrix, `NONE` for roots.
fn elimination_tree(matrix: &CsMat<f64>, inverse: &[usize]) -> Vec<usize> {
    let n = inverse.len();
    let (starts, columns) = permuted_upper(matrix, inverse);
    let mut parent = vec![NONE; n];
    let mut ancestor = vec![NONE; n];
    for row in 0..n {
        for &column in &columns[starts[row]..starts[row + 1]] {
            let mut node = column;
            while node != NONE && node != row {
                let next = std::mem::replace(&mut ancestor[node], row);
                if next == NONE {
                    parent[node] = row;
                }
                node = next;
            }
        }
    }
    parent
}

/// For each permuted row the permuted columns left of the diagonal, compressed.
fn permuted_upper(matrix: &CsMat<f64>, inverse: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let n = inverse.len();
    let mut starts = vec![0; n + 1];
    for_each_below(matrix, inverse, |row, _| starts[row + 1] += 1);
    for row in 0..n {
        starts[row + 1] += starts[row];
    }
    let mut next = starts.clone();
    let mut columns = vec![0; starts[n]];
    for_each_below(matrix, inverse, |row, column| {
        columns[next[row]] = column;
        next[row] += 1;
    });
    (starts, columns)
}

/// Calls `visit(row, column)`, both permuted, for every entry below the diagonal of the unpermuted matrix.
fn for_each_below(matrix: &CsMat<f64>, inverse: &[usize], mut visit: impl FnMut(usize, usize)) {
    let by_columns = matrix.is_csc();
    for (outer, vector) in matrix.outer_iterator().enumerate() {
        for &inner in vector.indices() {
            let is_below = if by_columns { inner > outer } else { inner < outer };
            if is_below {
                let (a, b) = (inverse[outer], inverse[inner]);
                visit(a.max(b), a.min(b));
            }
        }
    }
}

/// Postorder of a forest given by parents larger than their children.
fn postorder(parent: &[usize]) -> Vec<usize> {
    let n = parent.len();
    let mut size = vec![1_usize; n + 1];
    let up = |k: usize| if parent[k] == NONE { n } else { parent[k] };
    for k in 0..n {
        size[up(k)] += size[k];
    }
    // Linked lists of children, smallest subtree last in the list: the stack below reverses it.
    let mut by_size: Vec<usize> = (0..n).collect();
    by_size.sort_by_key(|&k| (size[k], k));
    let (mut first, mut sibling) = (vec![NONE; n + 1], vec![NONE; n]);
    for &k in &by_size {
        sibling[k] = std::mem::replace(&mut first[up(k)], k);
    }
    // Pre-order with children largest first, written from the back, is a postorder with the largest last.
    let mut result = vec![0; n];
    let mut place = n;
    let mut stack = Vec::new();
    push_children(&mut stack, first[n], &sibling);
    while let Some(node) = stack.pop() {
        place -= 1;
        result[place] = node;
        push_children(&mut stack, first[node], &sibling);
    }
    result
}

/// Pushes a child list so that its head, the largest, is popped first.
fn push_children(stack: &mut Vec<usize>, head: usize, sibling: &[usize]) {
    let start = stack.len();
    let mut child = head;
    while child != NONE {
        stack.push(child);
        child = sibling[child];
    }
    stack[start..].reverse();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this failed, supernodes would be torn apart and the factorisation slow, or rows lost.
    #[test]
    fn a_postorder_puts_every_subtree_into_consecutive_places() {
        // Two roots, 6 and 7; 6 has the children 2 (of 0, 1) and 5 (of 4 of 3).
        let parent = [2, 2, 6, 4, 5, 6, NONE, NONE];
        let post = postorder(&parent);
        let mut place = [0; 8];
        post.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let size = [1, 1, 3, 1, 2, 3, 7, 1];
        for node in 0..8 {
            let mut subtree: Vec<usize> = (0..8)
                .filter(|&k| {
                    let mut up = k;
                    while up != node && up != NONE {
                        up = parent[up];
                    }
                    up == node
                })
                .map(|k| place[k])
                .collect();
            subtree.sort_unstable();
            let expected: Vec<usize> = (place[node] + 1 - size[node]..=place[node]).collect();
            assert_eq!(subtree, expected, "subtree of {node}");
        }
    }

    /// If this failed, the tree would belong to another matrix: in an arrow with its tip last all columns hang on
    /// the tip, with its tip first the factor fills and the tree is a chain.
    #[test]
    fn the_tree_of_an_arrow_is_a_star_or_a_chain() {
        let (rows, columns): (Vec<usize>, Vec<usize>) = (0..5)
            .flat_map(|i| if i < 4 { vec![(i, i), (4, i)] } else { vec![(4, 4)] })
            .unzip();
        let arrow: CsMat<f64> = sprs::TriMat::from_triplets((5, 5), rows, columns, vec![1.0; 9]).to_csc();
        assert_eq!(elimination_tree(&arrow, &[0, 1, 2, 3, 4]), [4, 4, 4, 4, NONE]);
        assert_eq!(elimination_tree(&arrow, &[1, 2, 3, 4, 0]), [1, 2, 3, 4, NONE]);
        assert_eq!(
            elimination_tree(&arrow.to_csr(), &[0, 1, 2, 3, 4]),
            [4, 4, 4, 4, NONE]
        );
    }
}
