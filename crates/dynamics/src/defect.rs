//! The defect of a ring that is periodic but for some nodes: what its elements add to the matrices of the regular ring.
//!
//! K = K_regular + the difference of the defect's elements, assembled twice: with their nodes where they are, and where they would
//! be in the regular ring. The same for M. Products use the sum; factors follow from those of the regular ring
//! ([`solver::cyclic::CyclicDefect`]). Cost: 16 n^2 bytes for n rows.

use std::collections::BTreeMap;

use mesh::Mesh;
use solver::cyclic::Change;
use sprs::CsMat;

use crate::error::DynamicsError;
use crate::model::RingModel;
use crate::motion::coordinates::Coordinates;
use crate::sparse::{node_product, product};

/// Most rows of a defect: beyond, its dense system costs more than harmonics save.
const MOST_ROWS: usize = 1500;

/// A defect in nodal dofs.
pub struct RingDefect {
    /// Nodes of its elements, ascending.
    nodes: Vec<usize>,
    /// Where they are, and where they would be, m.
    positions: [Vec<[f64; 3]>; 2],
    /// Stiffness of its elements as they are, and as they would be, `[3 n][3 n]`.
    stiffness: [CsMat<f64>; 2],
    /// The same of the mass between nodes, `[n][n]`.
    node_mass: [CsMat<f64>; 2],
    /// Their differences.
    change: [CsMat<f64>; 2],
    note: String,
    bytes: usize,
}

/// Changes of the matrices of a ring's coordinates.
pub struct Changes {
    rows: Vec<usize>,
    /// Of M and K, row-major.
    values: [Vec<f64>; 2],
}

impl RingDefect {
    /// The defect of a ring without equal sectors; the inner error says why it cannot be solved as one.
    pub fn new(ring: &RingModel, side: &'static str) -> Result<Result<RingDefect, String>, DynamicsError> {
        let (mesh, Some(nearly)) = (&ring.mesh, ring.nearly_periodic()) else {
            return Ok(Err("it is not periodic up to a defect either".to_string()));
        };
        let elements = nearly.elements(mesh);
        let mut nodes: Vec<usize> = elements.iter().flat_map(|&e| mesh.element(e)).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        if 3 * nodes.len() > MOST_ROWS {
            return Ok(Err(format!(
                "it is periodic up to a defect that touches {} dofs, more than {MOST_ROWS}",
                3 * nodes.len()
            )));
        }
        let regular = nearly.regular(mesh);
        let parts = [mesh, &regular].map(|mesh| mesh.part(&elements, &nodes));
        let assemble = |part: &Mesh| {
            let pattern = fem::Pattern::new(part)?;
            Ok((
                fem::assemble_stiffness(part, &ring.material)?,
                fem::assemble_node_mass(&pattern, part, &ring.material)?,
            ))
        };
        let fem_error = |source| DynamicsError::Fem { side, source };
        let (k, m) = assemble(&parts[0]).map_err(fem_error)?;
        let (k_regular, m_regular) = assemble(&parts[1]).map_err(fem_error)?;
        let first = nearly.moved[0].0;
        let note = format!(
            "{} equal sectors but for {} nodes of {} elements in {} of them, the first node {first}, at most {:.1e} m from \
             their places",
            nearly.periodicity.n_sectors(),
            nearly.moved.len(),
            elements.len(),
            nearly.n_sectors_moved(),
            nearly.largest_move
        );
        Ok(Ok(RingDefect {
            change: [&m - &m_regular, &k - &k_regular],
            stiffness: [k, k_regular],
            node_mass: [m, m_regular],
            positions: parts.map(|part| part.nodes),
            bytes: 6 * size_of::<f64>() * (3 * nodes.len()).pow(2),
            nodes,
            note,
        }))
    }

    /// Nodes of its elements, ascending.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Bytes of its dense matrices while the ring is factored.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// What and where it is, for a log.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Adds the defect's part of K x to the regular ring's, both nodal, `[n_dofs]`.
    pub fn add_stiffness_product(&self, x: &[f64], sum: &mut [f64]) {
        self.add(&product(&self.change[1], &self.values(x)), sum);
    }

    /// The same of M x.
    pub fn add_mass_product(&self, x: &[f64], sum: &mut [f64]) {
        self.add(&node_product(&self.change[0], &self.values(x)), sum);
    }

    /// The defect's part of x K x.
    pub fn stiffness_square(&self, x: &[f64]) -> f64 {
        let x = self.values(x);
        crate::solution::dot(&x, &product(&self.change[1], &x))
    }

    /// The same of x M x.
    pub fn mass_square(&self, x: &[f64]) -> f64 {
        let x = self.values(x);
        crate::solution::dot(&x, &node_product(&self.change[0], &x))
    }

    fn values(&self, x: &[f64]) -> Vec<f64> {
        let of_node = |&node: &usize| [x[3 * node], x[3 * node + 1], x[3 * node + 2]];
        self.nodes.iter().flat_map(of_node).collect()
    }

    fn add(&self, values: &[f64], sum: &mut [f64]) {
        for (&node, value) in self.nodes.iter().zip(values.chunks_exact(3)) {
            (0..3).for_each(|i| sum[3 * node + i] += value[i]);
        }
    }

    /// The changes in the coordinates of a ring: T^T A T as it is less what it would be, T taken at the nodes' places.
    pub fn changes(&self, coordinates: &Coordinates) -> Changes {
        let terms = self.positions.each_ref().map(|positions| {
            let of_node =
                |(&node, &x): (&usize, &[f64; 3])| [0, 1, 2].map(|i| coordinates.terms(3 * node + i, x));
            let terms: Vec<_> = self.nodes.iter().zip(positions).flat_map(of_node).collect();
            terms
        });
        let mut rows: Vec<usize> = terms[0].iter().flatten().map(|&(row, _)| row).collect();
        rows.sort_unstable();
        rows.dedup();
        let place: BTreeMap<usize, usize> = rows.iter().copied().zip(0..).collect();
        let n = rows.len();
        let mut values = [vec![0.0; n * n], vec![0.0; n * n]];
        for (which, sign) in [(0, 1.0), (1, -1.0)] {
            let mut add = |of: usize, i: usize, j: usize, value: f64| {
                for &(row, a) in &terms[which][i] {
                    for &(column, b) in &terms[which][j] {
                        values[of][n * place[&row] + place[&column]] += sign * a * b * value;
                    }
                }
            };
            for (&m, (a, b)) in self.node_mass[which].iter() {
                (0..3).for_each(|c| add(0, 3 * a + c, 3 * b + c, m));
            }
            for (&k, (i, j)) in self.stiffness[which].iter() {
                add(1, i, j, k);
            }
        }
        values.iter_mut().for_each(|values| symmetrise(n, values));
        Changes { rows, values }
    }
}

impl Changes {
    /// Coordinates whose rows change, ascending.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// The change of `mass` M + `stiffness` K.
    pub fn of(&self, [mass, stiffness]: [f64; 2]) -> Change {
        let pairs = self.values[0].iter().zip(&self.values[1]);
        Change {
            rows: self.rows.clone(),
            values: pairs.map(|(m, k)| mass * m + stiffness * k).collect(),
        }
    }
}

fn symmetrise(n: usize, values: &mut [f64]) {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (values[n * i + j] + values[n * j + i]);
            (values[n * i + j], values[n * j + i]) = (mean, mean);
        }
    }
}
