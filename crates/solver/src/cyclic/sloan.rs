//! Elimination orders of a section's nodes that keep the front short.
//!
//! Sloan's algorithm (S. W. Sloan, A FORTRAN program for profile and wavefront reduction, International Journal for
//! Numerical Methods in Engineering 28, 1989, 2651-2679, doi:10.1002/nme.1620281111), from several ends and forwards
//! and backwards. On a grid of n by m nodes it is about as good as counting across the shorter side. Time: rows times
//! width of the front.

use std::collections::VecDeque;

/// Weights of distance and of growth of the front in Sloan's priority, tried in turn.
const WEIGHTS: [[i64; 2]; 3] = [[1, 2], [2, 1], [16, 1]];

/// Sloan's orders from both ends and backwards, of all weights.
pub(super) fn sloan_orders(neighbours: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut orders = Vec::new();
    for weights in WEIGHTS {
        for end in [0, 1] {
            let forward = sloan(neighbours, weights, end);
            orders.push(forward.iter().rev().copied().collect());
            orders.push(forward);
        }
    }
    orders
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
