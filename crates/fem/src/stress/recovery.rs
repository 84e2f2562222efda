//! Stress at integration points and at nodes.
//!
//! Nodal stress: inside every element the stress of the integration points is projected by weighted least squares,
//! which is L2 on the reference cell, onto the trilinear (hex) or linear (tet) functions of the corners; the values
//! at a node are averaged over its elements with their volumes as weights, in ascending order of the elements. A
//! linear stress field on affine elements is reproduced exactly. Reference: Hinton and Campbell, International
//! Journal for Numerical Methods in Engineering 8, 1974, 461-480, doi:10.1002/nme.1620080303.
//!
//! Across a jump of material or over a re-entrant corner the average smears; integration points do not.
//!
//! Cost: geometry is recomputed, so memory is the corner stresses of all elements (hex 384 B, tet 192 B each) in the
//! workspace and 20 B per element node in the recovery itself.

use mesh::{ElementKind, Mesh};
use rayon::prelude::*;

use super::kernel::{MAX_POINTS, NodeState, node_state, strains};
use crate::element;
use crate::error::FemError;
use crate::geometry::{check_connectivity, checked_map, coordinates, position};
use crate::material::{Material, hooke};
use crate::pattern::ElementsOfNodes;
use crate::quadrature::{self, VolumeRule};
use crate::table::ShapeTable;

/// Elements or nodes of one task.
const TASK: usize = 256;
/// Corners of the largest element.
const MAX_CORNERS: usize = 8;

/// What stress recovery needs to know of a mesh and its material.
pub struct StressRecovery {
    /// Node coordinates, m, `[n_nodes][3]`.
    positions: Vec<[f64; 3]>,
    /// Element nodes, flat.
    connectivity: Vec<usize>,
    /// Lamé's constants, Pa.
    lame: [f64; 2],
    /// Shape functions at the stress points.
    table: ShapeTable,
    /// From stress points to corners, `[n_corners][n_points]`.
    projection: Vec<Vec<f64>>,
    /// The two corners whose mean is the value at a node of an element, `[kind.n_nodes()]`.
    ends: Vec<[usize; 2]>,
    /// Elements around every node.
    elements: ElementsOfNodes,
    /// Volume of the elements around every node, m^3, `[n_nodes]`.
    volumes: Vec<f64>,
}

/// Buffers of nodal recovery, reusable from step to step.
#[derive(Clone, Debug, Default)]
pub struct StressWorkspace {
    /// Corner stresses times element volumes, `[n_elements][n_corners]`, flat.
    corners: Vec<[f64; 6]>,
}

impl StressRecovery {
    /// Prepares recovery; refuses a bad material, a broken connectivity and inverted elements.
    pub fn new(mesh: &Mesh, material: &Material) -> Result<StressRecovery, FemError> {
        material.validate()?;
        check_connectivity(mesh)?;
        let rule = quadrature::stiffness_rule(mesh.kind);
        let table = ShapeTable::new(mesh.kind, &rule);
        let mut volumes = vec![0.0; mesh.n_nodes()];
        for e in 0..mesh.n_elements() {
            let x = coordinates(mesh, e);
            let mut volume = 0.0;
            for q in 0..table.n_points() {
                volume += table.weights[q] * checked_map(&table, q, &x, e)?.det;
            }
            for &node in mesh.element(e) {
                volumes[node] += volume;
            }
        }
        Ok(StressRecovery {
            positions: mesh.nodes.to_vec(),
            connectivity: mesh.connectivity.clone(),
            lame: [material.lame_lambda(), material.shear_modulus()],
            projection: projection(mesh.kind, &rule),
            ends: ends(mesh.kind),
            elements: ElementsOfNodes::new(mesh),
            volumes,
            table,
        })
    }

    /// Stress points of one element: 8, 27 or 4.
    pub fn points_per_element(&self) -> usize {
        self.table.n_points()
    }

    /// Positions of the stress points, m, `[n_elements * points_per_element][3]`.
    pub fn point_positions(&self) -> Vec<[f64; 3]> {
        let zero = vec![0.0; 3 * self.positions.len()];
        let mut points = Vec::with_capacity(self.n_elements() * self.points_per_element());
        for e in 0..self.n_elements() {
            let state = node_state(&self.positions, self.element(e), &zero);
            let x = state.map(|s| [s[0], s[1], s[2]]);
            points.extend((0..self.points_per_element()).map(|q| position(&self.table, q, &x)));
        }
        points
    }

    /// Stress at the stress points, Pa, `[n_elements * points_per_element][6]`, from displacements, m, `[3 n_nodes]`.
    ///
    /// # Panics
    /// If `u` has another length.
    pub fn integration_points(&self, u: &[f64]) -> Vec<[f64; 6]> {
        assert_eq!(
            u.len(),
            3 * self.positions.len(),
            "displacements must have three values per node"
        );
        let n = self.points_per_element();
        let mut stress = vec![[0.0; 6]; n * self.n_elements()];
        stress
            .par_chunks_mut(n * TASK)
            .enumerate()
            .for_each(|(task, stress)| {
                for (i, stress) in stress.chunks_exact_mut(n).enumerate() {
                    let points = self.element_stress(task * TASK + i, u).0;
                    stress.copy_from_slice(&points[..n]);
                }
            });
        stress
    }

    /// Stress at the nodes, Pa, `[n_nodes][6]`, from displacements, m, `[3 n_nodes]`; zero at nodes of no element.
    ///
    /// # Panics
    /// If `u` has another length.
    pub fn nodal(&self, u: &[f64]) -> Vec<[f64; 6]> {
        let mut stress = vec![[0.0; 6]; self.positions.len()];
        self.nodal_into(u, &mut StressWorkspace::default(), &mut stress);
        stress
    }

    /// [`Self::nodal`] into an array, `[n_nodes][6]`, with buffers that may be used again.
    ///
    /// # Panics
    /// If `u` or `stress` has another length.
    pub fn nodal_into(&self, u: &[f64], workspace: &mut StressWorkspace, stress: &mut [[f64; 6]]) {
        assert_eq!(
            u.len(),
            3 * self.positions.len(),
            "displacements must have three values per node"
        );
        assert_eq!(
            stress.len(),
            self.positions.len(),
            "stress must have one entry per node"
        );
        self.sums_into(u, workspace, stress);
        for (stress, &volume) in stress.iter_mut().zip(&self.volumes) {
            let inverse = inverse(volume);
            *stress = stress.map(|s| s * inverse);
        }
    }

    /// Stress of the elements around every node times their volume, summed, N m, `[n_nodes][6]`: divided by
    /// [`Self::volumes`] it is the stress at the nodes. These sums and volumes of the parts of a mesh may be added.
    ///
    /// # Panics
    /// If `u` has another length than three values per node.
    pub fn volume_sums(&self, u: &[f64]) -> Vec<[f64; 6]> {
        assert_eq!(
            u.len(),
            3 * self.positions.len(),
            "displacements must have three values per node"
        );
        let mut sums = vec![[0.0; 6]; self.positions.len()];
        self.sums_into(u, &mut StressWorkspace::default(), &mut sums);
        sums
    }

    /// Volume of the elements around every node, m^3, `[n_nodes]`.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    fn sums_into(&self, u: &[f64], workspace: &mut StressWorkspace, sums: &mut [[f64; 6]]) {
        let n = self.table.kind.n_corners();
        workspace.corners.resize(n * self.n_elements(), [0.0; 6]);
        workspace
            .corners
            .par_chunks_mut(n * TASK)
            .enumerate()
            .for_each(|(task, corners)| {
                for (i, corners) in corners.chunks_exact_mut(n).enumerate() {
                    self.corner_stress(task * TASK + i, u, corners);
                }
            });
        let corners = &workspace.corners;
        sums.par_chunks_mut(TASK).enumerate().for_each(|(task, sums)| {
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum = self.sum(task * TASK + i, corners);
            }
        });
    }

    /// Number of elements.
    pub(super) fn n_elements(&self) -> usize {
        self.connectivity.len() / self.table.kind.n_nodes()
    }

    /// Node coordinates, m.
    pub(super) fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Shape functions at the stress points.
    pub(super) fn table(&self) -> &ShapeTable {
        &self.table
    }

    /// Lamé's constants, Pa.
    pub(super) fn lame(&self) -> [f64; 2] {
        self.lame
    }

    /// Nodes of element `e`.
    pub(super) fn element(&self, e: usize) -> &[usize] {
        let n = self.table.kind.n_nodes();
        &self.connectivity[n * e..n * (e + 1)]
    }

    /// Number of nodes.
    pub(super) fn n_nodes(&self) -> usize {
        self.positions.len()
    }

    /// Stress at the stress points of element `e`, Pa, and its volume, m^3.
    fn element_stress(&self, e: usize, u: &[f64]) -> ([[f64; 6]; MAX_POINTS], f64) {
        self.state_stress(&node_state(&self.positions, self.element(e), u))
    }

    /// Stress at the stress points of an element whose nodes are at and move by `state`, Pa, and its volume, m^3.
    pub(super) fn state_stress(&self, state: &NodeState) -> ([[f64; 6]; MAX_POINTS], f64) {
        let mut values = [[0.0; 6]; MAX_POINTS];
        let volume = strains(&self.table, state, self.lame, &mut values);
        for value in &mut values[..self.table.n_points()] {
            *value = hooke(self.lame[0], self.lame[1], *value);
        }
        (values, volume)
    }

    /// Corner stresses of element `e` times its volume, N m, `[n_corners][6]`.
    fn corner_stress(&self, e: usize, u: &[f64], corners: &mut [[f64; 6]]) {
        self.project(self.element_stress(e, u), corners);
    }

    /// The same of an element in any state, zero beyond its corners.
    pub(super) fn weighted_corners(&self, state: &NodeState) -> [[f64; 6]; MAX_CORNERS] {
        let mut corners = [[0.0; 6]; MAX_CORNERS];
        self.project(self.state_stress(state), &mut corners);
        corners
    }

    /// Corner stresses times the volume from those at the stress points.
    pub(super) fn project(&self, (points, volume): ([[f64; 6]; MAX_POINTS], f64), corners: &mut [[f64; 6]]) {
        for (corner, factors) in corners.iter_mut().zip(&self.projection) {
            let mut sum = [0.0; 6];
            for (point, factor) in points.iter().zip(factors) {
                for c in 0..6 {
                    sum[c] += factor * point[c];
                }
            }
            *corner = sum.map(|s| volume * s);
        }
    }

    /// Stress at the nodes, Pa, from corner stresses times element volumes, `[n_elements][n_corners]` flat.
    pub(super) fn average(&self, corners: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let of_node = |(node, &volume): (usize, &f64)| self.sum(node, corners).map(|s| s * inverse(volume));
        self.volumes.iter().enumerate().map(of_node).collect()
    }

    /// Sum over the elements of a node, N m.
    fn sum(&self, node: usize, corners: &[[f64; 6]]) -> [f64; 6] {
        let n = self.table.kind.n_corners();
        let mut sum = [0.0; 6];
        for &(e, a) in self.elements.of(node) {
            let value = self.at_node(a as usize, &corners[n * e as usize..][..n]);
            (0..6).for_each(|c| sum[c] += value[c]);
        }
        sum
    }

    /// What an element gives to the mean of `node`, its node `a`, Pa, from its corner stresses times its volume.
    pub(super) fn node_share(&self, node: usize, a: usize, corners: &[[f64; 6]]) -> [f64; 6] {
        let inverse = inverse(self.volumes[node]);
        self.at_node(a, corners).map(|s| s * inverse)
    }

    /// Value at node `a` of an element.
    fn at_node(&self, a: usize, corners: &[[f64; 6]]) -> [f64; 6] {
        let [first, second] = self.ends[a];
        std::array::from_fn(|c| 0.5 * (corners[first][c] + corners[second][c]))
    }
}

/// One over a volume; 0 at nodes of no element.
fn inverse(volume: f64) -> f64 {
    if volume > 0.0 { 1.0 / volume } else { 0.0 }
}

/// The corners between which a node lies; a corner lies between itself and itself.
fn ends(kind: ElementKind) -> Vec<[usize; 2]> {
    let node_ends = |&xi: &[f64; 3]| {
        let values = element::corner_shape(kind, xi);
        let mut near = (0..kind.n_corners()).filter(|&corner| values[corner] > 0.25);
        let first = near
            .next()
            .expect("every node lies on an edge, where a corner function is at least a half");
        [first, near.next().unwrap_or(first)]
    };
    element::reference_nodes(kind).iter().map(node_ends).collect()
}

/// Weighted least squares from stress points to corners, `(N^T W N)^-1 N^T W`, `[n_corners][n_points]`.
fn projection(kind: ElementKind, rule: &VolumeRule) -> Vec<Vec<f64>> {
    let (n_corners, n_points) = (kind.n_corners(), rule.weights.len());
    let values: Vec<_> = rule
        .points
        .iter()
        .map(|&xi| element::corner_shape(kind, xi))
        .collect();
    let mut normal = [[0.0; MAX_CORNERS]; MAX_CORNERS];
    let mut right = vec![vec![0.0; n_points]; n_corners];
    for a in 0..n_corners {
        for q in 0..n_points {
            right[a][q] = rule.weights[q] * values[q][a];
            for b in 0..n_corners {
                normal[a][b] += right[a][q] * values[q][b];
            }
        }
    }
    // Gauss-Jordan; the normal matrix is positive definite, so no pivoting is needed.
    for c in 0..n_corners {
        let pivot_row = normal[c];
        let pivot_right = right[c].clone();
        for r in (0..n_corners).filter(|&r| r != c) {
            let factor = normal[r][c] / pivot_row[c];
            for s in 0..n_corners {
                normal[r][s] -= factor * pivot_row[s];
            }
            for q in 0..n_points {
                right[r][q] -= factor * pivot_right[q];
            }
        }
    }
    for (c, row) in right.iter_mut().enumerate() {
        row.iter_mut().for_each(|value| *value /= normal[c][c]);
    }
    right
}
