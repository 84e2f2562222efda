//! The sparsity pattern shared by stiffness and mass: 3 x 3 blocks between nodes that share an element.
//!
//! Rows are compressed (CSR); row `3 a + i` has the columns `3 b + j` of the sorted neighbours b of node a, itself
//! included. The pattern is symmetric, so the arrays are CSC as well. Stiffness and mass have the same values layout:
//! `c K + d M` is a loop over two value arrays. Memory: one index per node pair and two bytes per node pair of every
//! element.

use mesh::Mesh;
use rayon::prelude::*;
use sprs::CsMat;

use crate::error::FemError;
use crate::geometry::check_connectivity;

/// Nodes whose neighbours are found as one task.
const TASK: usize = 512;
/// Elements whose places are found as one task.
const ELEMENT_TASK: usize = 256;

/// Which degrees of freedom are coupled, and where each element's entries go.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// Where each node's neighbours start, `[n_nodes + 1]`.
    starts: Vec<usize>,
    /// Sorted neighbours of all nodes, flat.
    neighbours: Vec<usize>,
    /// Rank of node b among the neighbours of node a, `[n_elements][n][n]`, flat.
    ranks: Vec<u16>,
    /// Nodes of one element, n.
    nodes_per_element: usize,
}

impl Pattern {
    /// Finds the pattern of a mesh; refuses a mesh with a broken connectivity.
    pub fn new(mesh: &Mesh) -> Result<Pattern, FemError> {
        check_connectivity(mesh)?;
        let (starts, neighbours) = neighbours(mesh)?;
        let n = mesh.kind.n_nodes();
        let mut ranks = vec![0_u16; n * mesh.connectivity.len()];
        ranks
            .par_chunks_mut(ELEMENT_TASK * n * n)
            .enumerate()
            .for_each(|(task, ranks)| {
                for (i, ranks) in ranks.chunks_exact_mut(n * n).enumerate() {
                    fill_ranks(mesh.element(task * ELEMENT_TASK + i), &starts, &neighbours, ranks);
                }
            });
        Ok(Pattern {
            starts,
            neighbours,
            ranks,
            nodes_per_element: n,
        })
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored values of a matrix of all degrees of freedom.
    pub fn n_values(&self) -> usize {
        9 * self.neighbours.len()
    }

    /// Sorted neighbours of a node, itself included.
    pub fn neighbours(&self, node: usize) -> &[usize] {
        &self.neighbours[self.starts[node]..self.starts[node + 1]]
    }

    /// Row pointers of a matrix of all degrees of freedom, `[3 n_nodes + 1]`.
    pub fn row_starts(&self) -> Vec<usize> {
        let mut row_starts = Vec::with_capacity(3 * self.n_nodes() + 1);
        for node in 0..self.n_nodes() {
            let width = 3 * self.neighbours(node).len();
            row_starts.extend((0..3).map(|i| 9 * self.starts[node] + i * width));
        }
        row_starts.push(self.n_values());
        row_starts
    }

    /// Column indices of a matrix of all degrees of freedom, `[n_values]`.
    pub fn columns(&self) -> Vec<usize> {
        let mut columns = Vec::with_capacity(self.n_values());
        for node in 0..self.n_nodes() {
            let first = columns.len();
            columns.extend(
                self.neighbours(node)
                    .iter()
                    .flat_map(|&b| [3 * b, 3 * b + 1, 3 * b + 2]),
            );
            let end = columns.len();
            columns.extend_from_within(first..end);
            columns.extend_from_within(first..end);
        }
        columns
    }

    /// The `[3 n_nodes][3 n_nodes]` CSR matrix of an array of values, `[n_values]`.
    pub fn matrix(&self, values: Vec<f64>) -> CsMat<f64> {
        let n = 3 * self.n_nodes();
        CsMat::new((n, n), self.row_starts(), self.columns(), values)
    }

    /// The `[n_nodes][n_nodes]` CSR matrix of an array of values, one per pair of neighbours.
    pub fn node_matrix(&self, values: Vec<f64>) -> CsMat<f64> {
        let n = self.n_nodes();
        CsMat::new((n, n), self.starts.clone(), self.neighbours.clone(), values)
    }

    /// Adds an element matrix, `[3 n][3 n]`, to the values of a matrix of all degrees of freedom.
    pub(crate) fn add_blocks(&self, e: usize, nodes: &[usize], matrix: &[f64], values: &mut [f64]) {
        let n = self.nodes_per_element;
        let ranks = &self.ranks[e * n * n..(e + 1) * n * n];
        for (a, &node) in nodes.iter().enumerate() {
            let width = 3 * self.neighbours(node).len();
            let block_row = &mut values[9 * self.starts[node]..][..3 * width];
            for (i, row) in block_row.chunks_exact_mut(width).enumerate() {
                let entries = &matrix[(3 * a + i) * 3 * n..][..3 * n];
                for (entry, &rank) in entries.chunks_exact(3).zip(&ranks[a * n..(a + 1) * n]) {
                    let place = &mut row[3 * rank as usize..][..3];
                    place[0] += entry[0];
                    place[1] += entry[1];
                    place[2] += entry[2];
                }
            }
        }
    }

    /// Adds an element matrix between nodes, `[n][n]`, to values with one entry per pair of neighbours.
    pub(crate) fn add_scalars(&self, e: usize, nodes: &[usize], matrix: &[f64], values: &mut [f64]) {
        let n = self.nodes_per_element;
        let ranks = &self.ranks[e * n * n..(e + 1) * n * n];
        for (a, &node) in nodes.iter().enumerate() {
            let row = &mut values[self.starts[node]..self.starts[node + 1]];
            for b in 0..n {
                row[ranks[a * n + b] as usize] += matrix[a * n + b];
            }
        }
    }

    /// Number of pairs of neighbours.
    pub(crate) fn n_pairs(&self) -> usize {
        self.neighbours.len()
    }

    /// Spreads values between nodes over the three components: `m_ab` becomes `m_ab I`, with explicit zeros.
    pub(crate) fn spread(&self, scalars: &[f64], values: &mut [f64]) {
        values.fill(0.0);
        for node in 0..self.n_nodes() {
            let (start, end) = (self.starts[node], self.starts[node + 1]);
            let width = 3 * (end - start);
            for i in 0..3 {
                for (rank, &scalar) in scalars[start..end].iter().enumerate() {
                    values[9 * start + i * width + 3 * rank + i] = scalar;
                }
            }
        }
    }
}

/// Sorted neighbours of all nodes.
fn neighbours(mesh: &Mesh) -> Result<(Vec<usize>, Vec<usize>), FemError> {
    let elements = ElementsOfNodes::new(mesh);
    let n_tasks = mesh.n_nodes().div_ceil(TASK);
    let tasks: Vec<(Vec<usize>, Vec<usize>)> = (0..n_tasks)
        .into_par_iter()
        .map(|task| {
            let (mut counts, mut all, mut own) = (Vec::new(), Vec::new(), Vec::new());
            for node in task * TASK..((task + 1) * TASK).min(mesh.n_nodes()) {
                own.clear();
                own.extend(
                    elements
                        .of(node)
                        .iter()
                        .flat_map(|&(e, _)| mesh.element(e as usize)),
                );
                own.sort_unstable();
                own.dedup();
                counts.push(own.len());
                all.extend_from_slice(&own);
            }
            (counts, all)
        })
        .collect();
    let (mut starts, mut end) = (vec![0], 0);
    let mut neighbours = Vec::with_capacity(tasks.iter().map(|(_, all)| all.len()).sum());
    for (counts, all) in tasks {
        for count in counts {
            if count > u16::MAX as usize {
                let node = starts.len() - 1;
                let limit = u16::MAX as usize;
                return Err(FemError::TooManyNeighbours {
                    node,
                    neighbours: count,
                    limit,
                });
            }
            end += count;
            starts.push(end);
        }
        neighbours.extend(all);
    }
    Ok((starts, neighbours))
}

/// Ranks of an element's nodes among each other's neighbours, `[n][n]`.
fn fill_ranks(nodes: &[usize], starts: &[usize], neighbours: &[usize], ranks: &mut [u16]) {
    for (a, &node) in nodes.iter().enumerate() {
        let sorted = &neighbours[starts[node]..starts[node + 1]];
        for (b, other) in nodes.iter().enumerate() {
            ranks[a * nodes.len() + b] = sorted.partition_point(|neighbour| neighbour < other) as u16;
        }
    }
}

/// The elements of every node, ascending.
#[derive(Clone, Debug)]
pub(crate) struct ElementsOfNodes {
    /// Where each node's elements start, `[n_nodes + 1]`.
    starts: Vec<usize>,
    /// Element index and the node's place in it.
    entries: Vec<(u32, u32)>,
}

impl ElementsOfNodes {
    /// Inverts the connectivity.
    pub fn new(mesh: &Mesh) -> ElementsOfNodes {
        let mut starts = vec![0; mesh.n_nodes() + 1];
        for &node in &mesh.connectivity {
            starts[node + 1] += 1;
        }
        for node in 0..mesh.n_nodes() {
            starts[node + 1] += starts[node];
        }
        let mut free = starts.clone();
        let mut entries = vec![(0, 0); mesh.connectivity.len()];
        for e in 0..mesh.n_elements() {
            for (a, &node) in mesh.element(e).iter().enumerate() {
                entries[free[node]] = (e as u32, a as u32);
                free[node] += 1;
            }
        }
        ElementsOfNodes { starts, entries }
    }

    /// Elements of a node and its place in each.
    pub fn of(&self, node: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[node]..self.starts[node + 1]]
    }
}
