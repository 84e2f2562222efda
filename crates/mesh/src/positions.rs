//! Positions of the nodes of a ring: of all, or on a rank that shares the ring of those that it needs.
//!
//! Nodes keep their numbers in the ring. A list of the kept ones, 4 bytes each, leads to their positions; asking for
//! another node, or for all of a ring of which some are not kept, panics. Copies share the positions.

use std::ops::{Deref, DerefMut, Index, IndexMut};
use std::sync::Arc;

/// Positions of nodes, m; as a slice those of all, `[n_nodes][3]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodePositions {
    points: Arc<Vec<[f64; 3]>>,
    /// None where all nodes are kept.
    kept: Option<Arc<Kept>>,
}

/// Which nodes of a ring are kept.
#[derive(Debug, PartialEq)]
struct Kept {
    /// Their numbers, ascending.
    numbers: Vec<u32>,
    /// Number of nodes of the ring.
    n_nodes: usize,
}

impl NodePositions {
    /// Positions `points`, m, of the nodes `numbers`, ascending, of a ring of `n_nodes`.
    ///
    /// # Panics
    /// When there is not one point per number, or numbers do not grow or are too large.
    pub fn of(numbers: Vec<u32>, points: Vec<[f64; 3]>, n_nodes: usize) -> NodePositions {
        assert_eq!(numbers.len(), points.len(), "a point per node");
        assert!(numbers.is_sorted_by(|a, b| a < b), "nodes in ascending order");
        assert!(
            numbers.last().is_none_or(|&last| (last as usize) < n_nodes),
            "nodes of the ring"
        );
        let all = numbers.len() == n_nodes;
        NodePositions {
            points: Arc::new(points),
            kept: (!all).then(|| Arc::new(Kept { numbers, n_nodes })),
        }
    }

    /// Number of nodes of the ring.
    pub fn len(&self) -> usize {
        self.kept.as_ref().map_or(self.points.len(), |kept| kept.n_nodes)
    }

    /// Whether the ring has no nodes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of nodes whose positions are kept.
    pub fn n_kept(&self) -> usize {
        self.points.len()
    }

    /// Nodes whose positions are kept, ascending, and these.
    pub fn kept(&self) -> impl Iterator<Item = (usize, [f64; 3])> + '_ {
        let number = |place: usize| match &self.kept {
            Some(kept) => kept.numbers[place] as usize,
            None => place,
        };
        let points = self.points.iter().enumerate();
        points.map(move |(place, &x)| (number(place), x))
    }

    /// Adds a node behind all others.
    pub fn push(&mut self, point: [f64; 3]) {
        self.extend([point]);
    }

    /// Where the position of a node is.
    fn place(&self, node: usize) -> usize {
        let Some(kept) = &self.kept else { return node };
        let found = u32::try_from(node).ok();
        let found = found.and_then(|node| kept.numbers.binary_search(&node).ok());
        found.unwrap_or_else(|| panic!("the position of node {node} is not kept on this rank"))
    }

    fn require_all(&self) {
        assert!(
            self.kept.is_none(),
            "of {} nodes only {} positions are kept on this rank",
            self.len(),
            self.n_kept()
        );
    }
}

impl Index<usize> for NodePositions {
    type Output = [f64; 3];

    fn index(&self, node: usize) -> &[f64; 3] {
        &self.points[self.place(node)]
    }
}

impl IndexMut<usize> for NodePositions {
    fn index_mut(&mut self, node: usize) -> &mut [f64; 3] {
        let place = self.place(node);
        &mut Arc::make_mut(&mut self.points)[place]
    }
}

impl Deref for NodePositions {
    type Target = [[f64; 3]];

    fn deref(&self) -> &[[f64; 3]] {
        self.require_all();
        &self.points
    }
}

impl DerefMut for NodePositions {
    fn deref_mut(&mut self) -> &mut [[f64; 3]] {
        self.require_all();
        Arc::make_mut(&mut self.points).as_mut_slice()
    }
}

impl<'p> IntoIterator for &'p NodePositions {
    type Item = &'p [f64; 3];
    type IntoIter = std::slice::Iter<'p, [f64; 3]>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'p> IntoIterator for &'p mut NodePositions {
    type Item = &'p mut [f64; 3];
    type IntoIter = std::slice::IterMut<'p, [f64; 3]>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

impl From<Vec<[f64; 3]>> for NodePositions {
    fn from(points: Vec<[f64; 3]>) -> NodePositions {
        NodePositions {
            points: Arc::new(points),
            kept: None,
        }
    }
}

impl FromIterator<[f64; 3]> for NodePositions {
    fn from_iter<I: IntoIterator<Item = [f64; 3]>>(points: I) -> NodePositions {
        points.into_iter().collect::<Vec<[f64; 3]>>().into()
    }
}

impl Extend<[f64; 3]> for NodePositions {
    fn extend<I: IntoIterator<Item = [f64; 3]>>(&mut self, points: I) {
        self.require_all();
        Arc::make_mut(&mut self.points).extend(points);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> NodePositions {
        NodePositions::of(vec![1, 4, 7], vec![[1.0; 3], [4.0; 3], [7.0; 3]], 9)
    }

    /// Wrong: a node would be given the place of another one, or the ring the size of what is kept.
    #[test]
    fn nodes_are_found_by_their_numbers_in_the_ring() {
        let nodes = some();
        assert_eq!([nodes[1], nodes[4], nodes[7]], [[1.0; 3], [4.0; 3], [7.0; 3]]);
        assert_eq!((nodes.len(), nodes.n_kept()), (9, 3));
        assert!(nodes.kept().all(|(node, x)| x == [node as f64; 3]));
        let whole = NodePositions::of(vec![0, 1], vec![[0.0; 3]; 2], 2);
        assert_eq!(whole.iter().len(), 2);
    }

    /// Wrong: a rank would go on with the position of another node where it lacks one.
    #[test]
    #[should_panic(expected = "the position of node 5 is not kept on this rank")]
    fn a_node_that_is_not_kept_has_no_position() {
        let _ = some()[5];
    }

    /// Wrong: a loop over all nodes would go over some of them, with wrong numbers.
    #[test]
    #[should_panic(expected = "of 9 nodes only 3 positions are kept on this rank")]
    fn some_positions_are_not_those_of_all_nodes() {
        let _ = some().iter();
    }
}
