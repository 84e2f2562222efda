//! What a defect changes in the matrices of a ring's coordinates.
//!
//! T^T A T of the defect's elements as they are less what it would be in the regular ring, each with the T of its own
//! coordinates, taken at the nodes' own places. Coordinates that only the true ring has (nodes that are free alone)
//! and those that only the regular ring has (absent nodes, and nodes that are held besides) come last and are
//! condensed ([`solver::cyclic::Change::condensed`]), for each step size by itself: the condensed change of c_M M +
//! c_K K is not the sum of those of M and K.

use std::collections::{BTreeMap, BTreeSet};

use mesh::Mesh;
use solver::SolverError;
use solver::cyclic::Change;
use sprs::CsMat;

use crate::coordinates::Coordinates;
use crate::model::RingModel;

/// Elements of the defect.
pub(crate) struct DefectElements {
    /// Positions of the nodes, m.
    pub positions: Vec<[f64; 3]>,
    /// `[3 n][3 n]`.
    pub stiffness: CsMat<f64>,
    /// Mass between nodes, `[n][n]`.
    pub node_mass: CsMat<f64>,
}

/// Changes of the matrices of a ring's coordinates.
pub struct Changes {
    /// Coordinates of the true ring, ascending.
    rows: Vec<usize>,
    /// Coordinates that the regular ring lacks, ascending.
    loose: Vec<usize>,
    /// Coordinates of the regular ring that the true one lacks, ascending.
    gone: Vec<usize>,
    /// Of M and K, row-major: rows, loose ones, and coordinates that the true ring lacks.
    values: [Vec<f64>; 2],
}

/// A coordinate of one of the two rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Row {
    /// Of the true ring, in a dof that both rings have.
    True(usize),
    /// Of the true ring, in a dof that is held in the regular one.
    Loose(usize),
    /// Of a dof that only the regular ring has.
    Gone(usize),
}

/// Rows of T: the coordinates that move a dof and by how much.
type CoordinateRows = Vec<Vec<(Row, f64)>>;

impl Changes {
    /// The changes by elements with the `nodes` (ascending) of the regular ring, as they are and as they would be.
    pub(crate) fn new(
        nodes: &[usize],
        patches: &[DefectElements; 2],
        coordinates: &Coordinates,
        regular: &Coordinates,
    ) -> Changes {
        let terms = [
            true_terms(nodes, &patches[0].positions, coordinates, regular),
            regular_terms(nodes, &patches[1].positions, coordinates, regular),
        ];
        let all: BTreeSet<Row> = terms.iter().flatten().flatten().map(|&(row, _)| row).collect();
        let place: BTreeMap<Row, usize> = all.into_iter().zip(0..).collect();
        let n = place.len();
        let mut values = [vec![0.0; n * n], vec![0.0; n * n]];
        for ((patch, terms), sign) in patches.iter().zip(&terms).zip([1.0, -1.0]) {
            let mut add = |of: usize, i: usize, j: usize, value: f64| {
                for &(row, a) in &terms[i] {
                    for &(column, b) in &terms[j] {
                        values[of][n * place[&row] + place[&column]] += sign * a * b * value;
                    }
                }
            };
            for (&m, (a, b)) in patch.node_mass.iter() {
                (0..3).for_each(|c| add(0, 3 * a + c, 3 * b + c, m));
            }
            for (&k, (i, j)) in patch.stiffness.iter() {
                add(1, i, j, k);
            }
        }
        values.iter_mut().for_each(|values| symmetrise(n, values));
        let (mut rows, mut loose, mut gone) = (Vec::new(), Vec::new(), Vec::new());
        for row in place.keys() {
            match row {
                Row::True(row) => rows.push(*row),
                Row::Loose(row) => loose.push(*row),
                Row::Gone(dof) => {
                    let node = regular.free_node(dof / 3);
                    gone.push(3 * node.expect("it is free in the regular ring") + dof % 3);
                }
            }
        }
        Changes {
            rows,
            loose,
            gone,
            values,
        }
    }

    /// Coordinates of the true ring, ascending.
    pub(crate) fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Coordinates that the regular ring lacks, ascending.
    pub(crate) fn loose(&self) -> &[usize] {
        &self.loose
    }

    /// Coordinates of the regular ring that the true one lacks, ascending.
    pub(crate) fn gone(&self) -> &[usize] {
        &self.gone
    }

    /// Changes of M and K, row-major, symmetric: rows, loose ones, those that are gone.
    pub(crate) fn values(&self) -> [&[f64]; 2] {
        [&self.values[0], &self.values[1]]
    }

    /// The change of `mass` M + `stiffness` K.
    pub fn of(&self, [mass, stiffness]: [f64; 2]) -> Result<Change, SolverError> {
        let pairs = self.values[0].iter().zip(&self.values[1]);
        let values: Vec<f64> = pairs.map(|(m, k)| mass * m + stiffness * k).collect();
        Change::condensed(self.rows.clone(), self.loose.clone(), &values)
    }
}

impl DefectElements {
    pub fn new(part: Mesh, ring: &RingModel) -> Result<DefectElements, fem::FemError> {
        let n = part.n_nodes();
        if part.connectivity.is_empty() {
            return Ok(DefectElements {
                positions: part.nodes.to_vec(),
                stiffness: CsMat::zero((3 * n, 3 * n)),
                node_mass: CsMat::zero((n, n)),
            });
        }
        let pattern = fem::Pattern::new(&part)?;
        Ok(DefectElements {
            stiffness: fem::assemble_stiffness(&part, &ring.material)?,
            node_mass: fem::assemble_node_mass(&pattern, &part, &ring.material)?,
            positions: part.nodes.to_vec(),
        })
    }
}

/// Terms of the dofs of `nodes` in the true ring's coordinates; absent nodes have none.
fn true_terms(
    nodes: &[usize],
    positions: &[[f64; 3]],
    coordinates: &Coordinates,
    regular: &Coordinates,
) -> CoordinateRows {
    let row = |i: usize| match coordinates.free().get(i) {
        Some(dof) if regular.free_node(dof / 3).is_none() => Row::Loose(i),
        _ => Row::True(i),
    };
    let terms = |dof: usize, x: [f64; 3]| {
        let terms = match dof < coordinates.expanded() {
            true => coordinates.terms(dof, x),
            false => Vec::new(),
        };
        terms.into_iter().map(|(i, a)| (row(i), a)).collect()
    };
    let of_node = |(&node, &x): (&usize, &[f64; 3])| [0, 1, 2].map(|c| terms(3 * node + c, x));
    nodes.iter().zip(positions).flat_map(of_node).collect()
}

/// The same of the regular ring, in true coordinates where there are such.
fn regular_terms(
    nodes: &[usize],
    positions: &[[f64; 3]],
    coordinates: &Coordinates,
    regular: &Coordinates,
) -> CoordinateRows {
    let [(_, first), (_, first_regular)] = [coordinates, regular].map(Coordinates::shaft);
    let row = |i: usize| match i.checked_sub(first_regular) {
        Some(k) => Row::True(first + k),
        None => {
            let dof = regular.free()[i];
            let is_there = dof < coordinates.expanded();
            let node = is_there.then(|| coordinates.free_node(dof / 3)).flatten();
            node.map_or(Row::Gone(dof), |node| Row::True(3 * node + dof % 3))
        }
    };
    let terms = |dof: usize, x: [f64; 3]| -> Vec<(Row, f64)> {
        let terms = regular.terms(dof, x).into_iter();
        terms.map(|(i, a)| (row(i), a)).collect()
    };
    let of_node = |(&node, &x): (&usize, &[f64; 3])| [0, 1, 2].map(|c| terms(3 * node + c, x));
    nodes.iter().zip(positions).flat_map(of_node).collect()
}

fn symmetrise(n: usize, values: &mut [f64]) {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (values[n * i + j] + values[n * j + i]);
            (values[n * i + j], values[n * j + i]) = (mean, mean);
        }
    }
}
