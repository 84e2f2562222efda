//! Minimum-degree order of a small part, counting the separator nodes around it.
//!
//! Exact degrees on bit sets: the neighbours of an eliminated node become a clique. Nodes already placed (the halo)
//! are eliminated later, so they count as neighbours and are never candidates. Time O(n_nodes^2 (n_nodes + n_halo) /
//! 64).

use super::part::Subdomain;

/// Largest part for which bit sets are worth their quadratic memory; parts that no plane can cut may be larger and
/// stay in their own order.
const MOST_NODES: usize = 4000;

/// Local nodes in elimination order, `[n_nodes]`.
pub(super) fn minimum_degree(part: &Subdomain) -> Vec<usize> {
    let n = part.n_nodes();
    if n > MOST_NODES {
        return (0..n).collect();
    }
    let words = (n + part.n_halo()).div_ceil(64);
    let mut rows = adjacency(part, words);
    let mut degree: Vec<u32> = rows.chunks_exact(words.max(1)).map(count).collect();
    let mut waiting: Vec<usize> = (0..n).collect();
    let mut order = Vec::with_capacity(n);
    let mut pivot_row = vec![0; words];
    while let Some(place) = (0..waiting.len()).min_by_key(|&place| (degree[waiting[place]], waiting[place])) {
        let pivot = waiting.swap_remove(place);
        order.push(pivot);
        pivot_row.copy_from_slice(&rows[words * pivot..words * (pivot + 1)]);
        for &node in waiting.iter().filter(|&&node| contains(&pivot_row, node)) {
            let row = &mut rows[words * node..words * (node + 1)];
            row.iter_mut()
                .zip(&pivot_row)
                .for_each(|(word, pivot_word)| *word |= pivot_word);
            row[pivot / 64] &= !(1 << (pivot % 64));
            row[node / 64] &= !(1 << (node % 64));
            degree[node] = count(row);
        }
    }
    order
}

/// Bit rows of the neighbours of each node to be ordered, `[n_nodes][words]`, without the node itself.
fn adjacency(part: &Subdomain, words: usize) -> Vec<u64> {
    let mut rows = vec![0_u64; words * part.n_nodes()];
    for e in 0..part.n_elements() {
        for &node in part.element_nodes(e) {
            for &neighbour in part
                .all_element_nodes(e)
                .iter()
                .filter(|&&neighbour| neighbour != node)
            {
                rows[words * node + neighbour / 64] |= 1 << (neighbour % 64);
            }
        }
    }
    rows
}

fn contains(row: &[u64], node: usize) -> bool {
    row[node / 64] >> (node % 64) & 1 == 1
}

fn count(row: &[u64]) -> u32 {
    row.iter().map(|word| word.count_ones()).sum()
}
