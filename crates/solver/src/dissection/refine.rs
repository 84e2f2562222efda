//! Improves a bisection of elements by moving single elements across, so that fewer nodes are shared.
//!
//! Fiduccia and Mattheyses, *A linear-time heuristic for improving network partitions*, Proc. 19th Design
//! Automation Conf. (1982) 175, doi:10.1109/DAC.1982.1585498, with elements as cells and nodes as nets: passes of
//! tentative moves, best first, each element at most once, that may get worse on the way; the best state of
//! a pass is kept.

use std::collections::BinaryHeap;

use super::part::{CutSizes, Subdomain};

/// Passes end with the first that gains nothing, at the latest here.
const MOST_PASSES: usize = 10;

/// Moves the sides of a cut (`[n_elements]`) until no pass improves its cost, which is returned.
pub(super) fn refine(part: &Subdomain, side: &mut [bool]) -> f64 {
    let mut state = State::new(part, side);
    for _ in 0..MOST_PASSES {
        if !state.pass() {
            break;
        }
    }
    state.sizes.cost()
}

/// A bisection under improvement.
struct State<'a> {
    part: &'a Subdomain,
    side: &'a mut [bool],
    /// Elements on either side of each node.
    counts: Vec<[usize; 2]>,
    sizes: CutSizes,
    /// Nodes that leave the separator, less those that enter it, when the element moves.
    gain: Vec<i32>,
    /// Elements that have moved in this pass.
    locked: Vec<bool>,
    /// Candidates of either side by gain, latest first; entries whose gain is outdated are skipped.
    queues: [BinaryHeap<(i32, usize, usize)>; 2],
    n_queued: usize,
}

impl<'a> State<'a> {
    fn new(part: &'a Subdomain, side: &'a mut [bool]) -> Self {
        let mut counts = vec![[0; 2]; part.n_nodes()];
        for (node, count) in counts.iter_mut().enumerate() {
            part.node_elements(node)
                .iter()
                .for_each(|&e| count[usize::from(side[e])] += 1);
        }
        let mut sizes = CutSizes {
            separator: 0,
            sides: [0; 2],
        };
        for count in &counts {
            *sizes.place(count) += 1;
        }
        let n = part.n_elements();
        let queues = [BinaryHeap::new(), BinaryHeap::new()];
        State {
            part,
            side,
            counts,
            sizes,
            gain: vec![0; n],
            locked: vec![false; n],
            queues,
            n_queued: 0,
        }
    }

    /// One pass; says whether it lowered the cost.
    fn pass(&mut self) -> bool {
        self.prepare();
        // A straight cut between planes of nodes, which every move lengthens, is a firm minimum.
        let has_free_move = self
            .queues
            .iter()
            .any(|q| q.peek().is_some_and(|&(gain, _, _)| gain >= 0));
        if !has_free_move {
            return false;
        }
        let patience = 50 + self.sizes.separator;
        let start = self.sizes.cost();
        let (mut best, mut best_length) = (start, 0);
        let mut moved = Vec::new();
        while moved.len() < best_length + patience {
            let Some(e) = self.next_move() else {
                break;
            };
            self.locked[e] = true;
            self.move_element(e);
            moved.push(e);
            let cost = self.sizes.cost();
            if cost < best {
                (best, best_length) = (cost, moved.len());
            }
        }
        for &e in moved[best_length..].iter().rev() {
            self.move_element(e);
        }
        best < start
    }

    /// Unlocks all elements and queues those at the separator.
    fn prepare(&mut self) {
        self.locked.fill(false);
        self.queues.iter_mut().for_each(BinaryHeap::clear);
        for e in 0..self.part.n_elements() {
            let nodes = self.part.element_nodes(e);
            self.gain[e] = nodes
                .iter()
                .map(|&node| gain_of(self.counts[node], self.side[e]))
                .sum();
            if nodes
                .iter()
                .any(|&node| self.counts[node].iter().all(|&count| count > 0))
            {
                self.queue(e);
            }
        }
    }

    fn queue(&mut self, e: usize) {
        self.n_queued += 1;
        self.queues[usize::from(self.side[e])].push((self.gain[e], self.n_queued, e));
    }

    /// The element of highest gain among the sides that may give one: both, unless one is much the smaller.
    fn next_move(&mut self) -> Option<usize> {
        let [a, b] = self.sizes.sides;
        let may_give = [3 * a >= b, 3 * b >= a];
        let mut chosen: Option<(i32, usize, usize)> = None;
        for giver in 0..2 {
            while let Some(&(gain, _, e)) = self.queues[giver].peek() {
                if !self.locked[e] && self.gain[e] == gain && usize::from(self.side[e]) == giver {
                    break;
                }
                self.queues[giver].pop();
            }
            if let Some(&top) = self.queues[giver].peek().filter(|_| may_give[giver]) {
                chosen = chosen.max(Some(top));
            }
        }
        chosen.map(|(_, _, e)| e)
    }

    /// Moves an element to the other side and updates counts, sizes and the gains around it.
    fn move_element(&mut self, e: usize) {
        let part = self.part;
        let (from, to) = (usize::from(self.side[e]), usize::from(!self.side[e]));
        self.side[e] = !self.side[e];
        for &node in part.element_nodes(e) {
            let before = self.counts[node];
            self.counts[node][from] -= 1;
            self.counts[node][to] += 1;
            let after = self.counts[node];
            *self.sizes.place(&before) -= 1;
            *self.sizes.place(&after) += 1;
            for &neighbour in part.node_elements(node) {
                let change = gain_of(after, self.side[neighbour]) - gain_of(before, self.side[neighbour]);
                if neighbour != e && change != 0 {
                    self.gain[neighbour] += change;
                    if !self.locked[neighbour] {
                        self.queue(neighbour);
                    }
                }
            }
        }
    }
}

impl CutSizes {
    /// The number to which a node with these counts of elements contributes.
    fn place(&mut self, counts: &[usize; 2]) -> &mut usize {
        match counts {
            [_, 0] => &mut self.sides[0],
            [0, _] => &mut self.sides[1],
            _ => &mut self.separator,
        }
    }
}

/// What one node contributes to the gain of moving an element away from `side`.
fn gain_of(counts: [usize; 2], side: bool) -> i32 {
    let (own, other) = (counts[usize::from(side)], counts[usize::from(!side)]);
    match (own, other) {
        (1, 0) => 0,
        (1, _) => 1,
        (_, 0) => -1,
        _ => 0,
    }
}
