//! Elimination order of a section's nodes and the profile (envelope) of its factor.
//!
//! Order: Sloan's algorithm (S. W. Sloan, A FORTRAN program for profile and wavefront reduction, International Journal
//! for Numerical Methods in Engineering 28, 1989, 2651-2679, doi:10.1002/nme.1620281111), from several ends and forwards
//! and backwards, whichever needs the fewest operations. On a grid of n by m nodes it is about as good as counting across
//! the shorter side, which reverse Cuthill-McKee is not. Time: rows times width of the front.

use std::collections::VecDeque;

/// Weights of distance and of growth of the front in Sloan's priority, tried in turn.
const WEIGHTS: [[i64; 2]; 3] = [[1, 2], [2, 1], [16, 1]];

/// Rows of a block factor: row i has the blocks `first[i]..=i`, stored from `starts[i]` on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Profile {
    pub(crate) first: Vec<usize>,
    pub(crate) starts: Vec<usize>,
}

impl Profile {
    /// Profile of an order.
    fn new(neighbours: &[Vec<usize>], order: &[usize]) -> Profile {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let (mut first, mut starts) = (Vec::with_capacity(order.len()), vec![0]);
        for (k, &node) in order.iter().enumerate() {
            let lowest = neighbours[node].iter().map(|&other| place[other]).min();
            let lowest = lowest.map_or(k, |lowest| lowest.min(k));
            first.push(lowest);
            starts.push(starts[k] + k - lowest + 1);
        }
        Profile { first, starts }
    }

    /// Number of block rows.
    pub(crate) fn n(&self) -> usize {
        self.first.len()
    }

    /// Number of blocks.
    pub(crate) fn n_blocks(&self) -> usize {
        self.starts[self.n()]
    }

    /// Place of block (i, j), j in the profile of row i.
    pub(crate) fn place(&self, i: usize, j: usize) -> usize {
        self.starts[i] + j - self.first[i]
    }

    /// Products of blocks in a factorisation.
    pub(crate) fn n_products(&self) -> usize {
        let row = |i: usize| -> usize {
            let first = self.first[i];
            (first..=i).map(|j| j - first.max(self.first[j])).sum()
        };
        (0..self.n()).map(row).sum()
    }
}

/// The best order found and its profile. `neighbours[a]` lists the nodes coupled with node a.
pub(crate) fn ordered(neighbours: &[Vec<usize>]) -> (Vec<usize>, Profile) {
    let natural: Vec<usize> = (0..neighbours.len()).collect();
    let profile = Profile::new(neighbours, &natural);
    let mut best = (profile.n_products(), natural, profile);
    for weights in WEIGHTS {
        for end in [0, 1] {
            let forward = sloan(neighbours, weights, end);
            let backward: Vec<usize> = forward.iter().rev().copied().collect();
            for order in [forward, backward] {
                let profile = Profile::new(neighbours, &order);
                let n_products = profile.n_products();
                if n_products < best.0 {
                    best = (n_products, order, profile);
                }
            }
        }
    }
    (best.1, best.2)
}

/// Sloan's order of every connected part, from one end of it to the other (`end` 1: the other way).
fn sloan(neighbours: &[Vec<usize>], weights: [i64; 2], end: usize) -> Vec<usize> {
    let mut order = Vec::with_capacity(neighbours.len());
    let mut is_done = vec![false; neighbours.len()];
    for node in 0..neighbours.len() {
        if !is_done[node] {
            let mut ends = far_ends(neighbours, node);
            if end == 1 {
                ends.swap(0, 1);
            }
            sloan_part(neighbours, weights, ends, &mut is_done, &mut order);
        }
    }
    order
}

/// What Sloan's algorithm knows of a node.
#[derive(Clone, Copy, PartialEq)]
enum Status {
    Inactive,
    Waiting,
    Active,
    Done,
}

/// Orders the part of the graph that holds `start` and `end`.
fn sloan_part(
    neighbours: &[Vec<usize>],
    [distance_weight, growth_weight]: [i64; 2],
    [start, end]: [usize; 2],
    is_done: &mut [bool],
    order: &mut Vec<usize>,
) {
    let mut priority: Vec<i64> = distances(neighbours, end)
        .into_iter()
        .zip(neighbours)
        .map(|(distance, list)| distance_weight * distance as i64 - growth_weight * (list.len() as i64 + 1))
        .collect();
    let mut status = vec![Status::Inactive; neighbours.len()];
    let mut queue = vec![start];
    status[start] = Status::Waiting;
    while let Some(place) = (0..queue.len()).max_by_key(|&p| (priority[queue[p]], usize::MAX - queue[p])) {
        let node = queue.swap_remove(place);
        let mut raise = |other: usize, status: &mut [Status]| {
            priority[other] += growth_weight;
            if status[other] == Status::Inactive {
                status[other] = Status::Waiting;
                queue.push(other);
            }
        };
        if status[node] == Status::Waiting {
            neighbours[node]
                .iter()
                .filter(|&&other| !is_done[other])
                .for_each(|&other| raise(other, &mut status));
        }
        status[node] = Status::Done;
        is_done[node] = true;
        order.push(node);
        for &other in &neighbours[node] {
            if status[other] == Status::Waiting {
                status[other] = Status::Active;
                raise(other, &mut status);
                for &third in neighbours[other].iter().filter(|&&third| !is_done[third]) {
                    raise(third, &mut status);
                }
            }
        }
    }
}

/// Two nodes about as far from each other as any of their part (Gibbs, Poole and Stockmeyer 1976).
fn far_ends(neighbours: &[Vec<usize>], node: usize) -> [usize; 2] {
    let farthest = |from: usize| {
        let reached = distances(neighbours, from);
        let last = (0..reached.len())
            .filter(|&n| reached[n] != usize::MAX)
            .max_by_key(|&n| (reached[n], usize::MAX - neighbours[n].len(), usize::MAX - n))
            .unwrap_or(from);
        (last, reached[last])
    };
    let (mut start, _) = farthest(node);
    let (mut end, mut length) = farthest(start);
    loop {
        let (next, next_length) = farthest(end);
        if next_length <= length {
            return [start, end];
        }
        (start, end, length) = (end, next, next_length);
    }
}

/// Edges from a node to every other, `usize::MAX` for those of other parts.
fn distances(neighbours: &[Vec<usize>], from: usize) -> Vec<usize> {
    let mut reached = vec![usize::MAX; neighbours.len()];
    reached[from] = 0;
    let mut queue = VecDeque::from([from]);
    while let Some(node) = queue.pop_front() {
        for &other in &neighbours[node] {
            if reached[other] == usize::MAX {
                reached[other] = reached[node] + 1;
                queue.push_back(other);
            }
        }
    }
    reached
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
            let by_hand = Profile::new(&grid(n, m), &rows);
            // The same nodes numbered along the longer side, so that the natural order is a bad one.
            let (order, profile) = ordered(&grid(m, n));
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, rows, "a permutation");
            let ratio = profile.n_products() as f64 / by_hand.n_products() as f64;
            assert!(ratio < 1.15, "{n} x {m}: {ratio}");
        }
    }

    /// Wrong: a section in two parts would lose nodes.
    #[test]
    fn parts_without_connection_are_ordered_one_after_the_other() {
        let neighbours = vec![vec![2], vec![3], vec![0], vec![1], vec![]];
        let (mut order, profile) = ordered(&neighbours);
        order.sort_unstable();
        assert_eq!(order, [0, 1, 2, 3, 4]);
        assert_eq!(profile.n_blocks(), 7);
    }
}
