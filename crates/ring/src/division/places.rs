//! Fields and integrals over the places of all nodes of a ring, of which a rank keeps some.
//!
//! A node belongs to the first sector that has it. Each rank works on the nodes that belong to its sectors; a field
//! is then gathered, a sum is added in the order of the sectors, so that its bits do not depend on ranks.

use std::sync::Arc;

use comm::Communicator;
use mesh::NodePositions;

/// Where the nodes of a ring are, and which rank knows it.
#[derive(Clone, Debug)]
pub struct NodePlaces {
    positions: NodePositions,
    shares: Option<Shares>,
}

/// Nodes of a ring in sectors.
#[derive(Clone, Debug)]
struct Shares {
    comm: Communicator,
    /// The nodes that belong to each sector, ascending.
    own: Arc<Vec<Vec<u32>>>,
}

impl NodePlaces {
    /// A ring of which this process knows all positions.
    pub fn whole(positions: NodePositions) -> NodePlaces {
        NodePlaces {
            positions,
            shares: None,
        }
    }

    /// A ring in sectors with the given `nodes`, ascending, of which each rank keeps at least those of its own.
    pub fn shared(positions: NodePositions, nodes: &[Vec<u32>], comm: Communicator) -> NodePlaces {
        let own = Arc::new(own_nodes(positions.len(), nodes));
        NodePlaces {
            positions,
            shares: Some(Shares { comm, own }),
        }
    }

    /// The positions that this rank keeps.
    pub fn positions(&self) -> &NodePositions {
        &self.positions
    }

    /// Values of a function of the position at all nodes, `[n_nodes][3]` flat. Collective.
    pub fn field(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let Some(Shares { comm, own }) = self.divided() else {
            return self.positions.iter().flat_map(|&x| f(x)).collect();
        };
        let at = |node: &u32| f(self.positions[*node as usize]);
        let mine: Vec<f64> = own[comm.share(own.len())].iter().flatten().flat_map(at).collect();
        let length = |share: std::ops::Range<usize>| own[share].iter().map(|nodes| 3 * nodes.len()).sum();
        let lengths: Vec<usize> = comm.shares(own.len()).into_iter().map(length).collect();
        let all = comm.all_gather(mine, &lengths);
        let mut field = vec![0.0; 3 * self.positions.len()];
        for (&node, value) in own.iter().flatten().zip(all.as_chunks::<3>().0) {
            field[3 * node as usize..][..3].copy_from_slice(value);
        }
        field
    }

    /// Sum over all nodes of values at a node and its position. Collective.
    pub fn sum<const W: usize>(&self, f: impl Fn(usize, [f64; 3]) -> [f64; W]) -> [f64; W] {
        let add = |mut sum: [f64; W], value: [f64; W]| {
            (0..W).for_each(|i| sum[i] += value[i]);
            sum
        };
        let Some(Shares { comm, own }) = &self.shares else {
            let values = self.positions.iter().enumerate().map(|(node, &x)| f(node, x));
            return values.fold([0.0; W], add);
        };
        let of_sector = |nodes: &Vec<u32>| {
            let values = nodes
                .iter()
                .map(|&node| f(node as usize, self.positions[node as usize]));
            values.fold([0.0; W], add)
        };
        let mine: Vec<f64> = own[comm.share(own.len())].iter().flat_map(of_sector).collect();
        let shares = comm.shares(own.len());
        let lengths: Vec<usize> = shares.into_iter().map(|share| W * share.len()).collect();
        let all = comm.all_gather(mine, &lengths);
        all.as_chunks::<W>().0.iter().copied().fold([0.0; W], add)
    }

    /// The positions of all nodes, on rank 0, None on the others. Collective.
    pub fn to_root(&self) -> Option<NodePositions> {
        let Some(Shares { comm, own }) = self.divided() else {
            return Some(self.positions.clone());
        };
        let n_nodes = if comm.is_root() { self.positions.len() } else { 0 };
        let mut all = vec![[0.0; 3]; n_nodes];
        for (rank, share) in comm.shares(own.len()).into_iter().enumerate() {
            for nodes in &own[share] {
                let here = comm.rank() == rank;
                let mine = nodes
                    .iter()
                    .take(if here { nodes.len() } else { 0 })
                    .flat_map(|&node| self.positions[node as usize]);
                if let Some(points) = comm.to_root(rank, mine.collect(), 3 * nodes.len()) {
                    let points = nodes.iter().zip(points.as_chunks::<3>().0);
                    points.for_each(|(&node, &x)| all[node as usize] = x);
                }
            }
        }
        comm.is_root().then(|| all.into())
    }

    /// How several ranks share the ring, if they do.
    fn divided(&self) -> Option<&Shares> {
        self.shares.as_ref().filter(|shares| shares.comm.size() > 1)
    }
}

/// The nodes that belong to each sector, of the nodes of each, ascending.
fn own_nodes(n_nodes: usize, nodes: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut is_owned = vec![false; n_nodes];
    let first = |nodes: &Vec<u32>| {
        let own = nodes.iter().copied();
        own.filter(|&node| !std::mem::replace(&mut is_owned[node as usize], true))
            .collect()
    };
    nodes.iter().map(first).collect()
}
