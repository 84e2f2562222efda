//! Elimination order of a section's nodes: of several, the one whose factor has the fewest blocks.
//!
//! Every solve reads each block twice, so blocks count, not the operations of the factorisation. Orders are Sloan's
//! ([`super::sloan`]), in which neighbours stand together: products and stress at the nodes run through the nodes in
//! that order, and orders of least fill would make them 1.3 to 1.9 times as slow for 0 to 7 % fewer blocks. Where
//! nodes are to come last, in motion, orders of least fill ([`super::least_fill`]) are tried as well: a line of nodes
//! along the longer side then costs 6 % more blocks of 19 by 9 nodes and 45 % of 21 by 4.

use super::factor_rows::{FactorRows, Memory};
use super::least_fill::least_fill;
use super::sloan::sloan_orders;

/// Orders of least fill that are tried, with equals taken differently; each saves about 1 %.
const TRIES: u64 = 4;

/// Largest section, nodes, for which it is sought: half a second.
const MOST_NODES: usize = 3000;

/// The best order found, in which the nodes `last` come after all others, and the rows of its factor. `neighbours[a]`
/// lists the nodes coupled with node a. With nodes that come last, whose solves are in two halves, the backward sweep
/// reads the factor from memory.
pub(crate) fn ordered(neighbours: &[Vec<usize>], last: &[usize]) -> (Vec<usize>, FactorRows) {
    let mut is_last = vec![false; neighbours.len()];
    last.iter().for_each(|&node| is_last[node] = true);
    let memory = if last.is_empty() {
        Memory::Forward
    } else {
        Memory::Backward
    };
    let of_sloan = sloan_orders(neighbours).into_iter().map(|order| {
        let (late, mut early): (Vec<usize>, Vec<usize>) = order.into_iter().partition(|&node| is_last[node]);
        early.extend(late);
        early
    });
    let tries = match memory {
        Memory::Backward if neighbours.len() <= MOST_NODES => TRIES,
        _ => 0,
    };
    let of_fill = (0..tries).map(|seed| least_fill(neighbours, last, seed));
    let all = of_sloan.chain(of_fill).map(|order| {
        let rows = FactorRows::new(neighbours, &order, memory);
        (rows.n_blocks(), order, rows)
    });
    let best = all.min_by_key(|(n_blocks, ..)| *n_blocks);
    best.map(|(_, order, rows)| (order, rows))
        .expect("there is an order of Sloan's")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` by `m` nodes, each coupled with its eight neighbours.
    fn grid(n: usize, m: usize) -> Vec<Vec<usize>> {
        let around = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        (0..n * m)
            .map(|node| {
                let (i, j) = (node / m, node % m);
                let all = around(i, n).flat_map(|p| around(j, m).map(move |q| p * m + q));
                all.filter(|&other| other != node).collect()
            })
            .collect()
    }

    /// Wrong: the factor would take more memory and time than counting across the shorter side does.
    #[test]
    fn the_order_is_nearly_as_good_as_counting_across_the_shorter_side() {
        for (n, m) in [(19, 10), (12, 5), (10, 4), (26, 12)] {
            let rows: Vec<usize> = (0..n * m).collect();
            let by_hand = FactorRows::new(&grid(n, m), &rows, Memory::Forward);
            // The same nodes numbered along the longer side, so that the natural order is a bad one.
            let (order, found) = ordered(&grid(m, n), &[]);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, rows, "a permutation");
            let ratio = found.n_blocks() as f64 / by_hand.n_blocks() as f64;
            assert!(ratio < 1.15, "{n} x {m}: {ratio}");
        }
    }

    /// Wrong: a raceway whose nodes come last would cost more than the solve that it saves, half of all blocks; or a
    /// node of it would not come last.
    #[test]
    fn a_line_along_the_longer_side_that_comes_last_costs_little() {
        for (n, m, of_raceway, most) in [(21, 4, 3..18, 1.5), (19, 9, 3..16, 1.1), (26, 11, 4..22, 1.1)] {
            let neighbours = grid(n, m);
            let last: Vec<usize> = of_raceway.map(|i| i * m).collect();
            let (order, rows) = ordered(&neighbours, &last);
            let mut end = order[n * m - last.len()..].to_vec();
            end.sort_unstable();
            assert_eq!(end, last);
            let by_hand =
                FactorRows::new(&neighbours, &(0..n * m).collect::<Vec<_>>(), Memory::Forward).n_blocks();
            let ratio = rows.n_blocks() as f64 / by_hand as f64;
            assert!(ratio < most, "{n} x {m}: {ratio}");
        }
    }

    /// Wrong: a section in two parts, or without nodes, would lose nodes.
    #[test]
    fn parts_without_connection_are_ordered_all() {
        let neighbours = vec![vec![2], vec![3], vec![0], vec![1], vec![]];
        for last in [&[][..], &[2, 4]] {
            let (mut order, rows) = ordered(&neighbours, last);
            assert!(last.iter().all(|node| order[5 - last.len()..].contains(node)));
            order.sort_unstable();
            assert_eq!(order, [0, 1, 2, 3, 4]);
            assert_eq!(rows.n_blocks(), 7);
        }
        assert_eq!(ordered(&[], &[]).0, [0; 0]);
    }
}
