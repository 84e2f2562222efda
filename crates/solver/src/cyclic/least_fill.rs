//! Elimination order that makes few new couplings: the next node is always the one that makes the fewest (minimum
//! deficiency; W. F. Tinney and J. W. Walker, Direct solutions of sparse network equations by optimally ordered
//! triangular factorization, Proceedings of the IEEE 55, 1967, 1801-1809, doi:10.1109/PROC.1967.6011).
//!
//! Cost: of n nodes with fronts of f nodes about n f^2 / 64 words of n bits; memory n^2 bits.

/// The order, in which the nodes of `last` come after all others. Equals are taken in an order that `seed` mixes.
pub(super) fn least_fill(neighbours: &[Vec<usize>], last: &[usize], seed: u64) -> Vec<usize> {
    let n = neighbours.len();
    let mut graph = Graph::new(neighbours);
    let mut rank: Vec<Option<Rank>> = (0..n).map(|node| Some(graph.rank(node, seed))).collect();
    let mut is_last = vec![false; n];
    last.iter().for_each(|&node| is_last[node] = true);
    let mut order = Vec::with_capacity(n);
    for phase in [false, true] {
        let open = |rank: &[Option<Rank>]| {
            let nodes = (0..n).filter(|&node| is_last[node] == phase);
            let ranked = nodes.filter_map(|node| rank[node].map(|rank| (rank, node)));
            ranked.min().map(|(_, node)| node)
        };
        while let Some(node) = open(&rank) {
            rank[node] = None;
            order.push(node);
            for changed in graph.eliminate(node) {
                rank[changed] = Some(graph.rank(changed, seed));
            }
        }
    }
    order
}

/// New couplings twice, neighbours, and a number that decides between equals.
type Rank = (usize, usize, u64);

/// Nodes that are not eliminated, with the couplings that elimination has made, as sets of bits.
struct Graph {
    /// Words per node.
    words: usize,
    bits: Vec<u64>,
}

impl Graph {
    fn new(neighbours: &[Vec<usize>]) -> Graph {
        let words = neighbours.len().div_ceil(64);
        let mut bits = vec![0; words * neighbours.len()];
        for (row, list) in bits.chunks_exact_mut(words.max(1)).zip(neighbours) {
            list.iter()
                .for_each(|&other| row[other / 64] |= 1 << (other % 64));
        }
        Graph { words, bits }
    }

    fn row(&self, node: usize) -> &[u64] {
        &self.bits[self.words * node..self.words * (node + 1)]
    }

    fn rank(&self, node: usize, seed: u64) -> Rank {
        let row = self.row(node);
        let around = members(row);
        let missing = |&other: &usize| {
            let both = row
                .iter()
                .zip(self.row(other))
                .map(|(a, b)| (a & b).count_ones() as usize);
            around.len() - 1 - both.sum::<usize>()
        };
        let new: usize = around.iter().map(missing).sum();
        // Steele, Lea and Flood 2014: the finaliser of SplitMix.
        let mut mixed = (node as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (new, around.len(), mixed)
    }

    /// Couples the neighbours of a node with each other and takes it out; the nodes whose rank may have changed.
    fn eliminate(&mut self, node: usize) -> Vec<usize> {
        let row = self.row(node).to_vec();
        let around = members(&row);
        let mut changed = row.clone();
        for &other in &around {
            let own = &mut self.bits[self.words * other..self.words * (other + 1)];
            for ((own, new), changed) in own.iter_mut().zip(&row).zip(&mut changed) {
                *own |= new;
                *changed |= *own;
            }
            own[other / 64] &= !(1 << (other % 64));
            own[node / 64] &= !(1 << (node % 64));
        }
        if self.words > 0 {
            changed[node / 64] &= !(1 << (node % 64));
        }
        members(&changed)
    }
}

/// Members of a set of bits, ascending.
fn members(row: &[u64]) -> Vec<usize> {
    let of_word = |(k, &word): (usize, &u64)| {
        (0..64)
            .filter(move |bit| word >> bit & 1 == 1)
            .map(move |bit| 64 * k + bit)
    };
    row.iter().enumerate().flat_map(of_word).collect()
}
