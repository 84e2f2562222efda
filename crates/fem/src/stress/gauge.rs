//! Mean strain of a body along given directions at given points: what a strain gauge of this size reads.
//!
//! ```text
//! e = sum over points of (w / sum w) n . E n,   E the small strain of the element at the point
//! ```
//!
//! E is that of the shape functions and, in 8-node elements, of their incompatible modes: that of which the stress at
//! integration points is Hooke's law. It is linear in the displacements, so that a gauge is one weight per dof.
//! It is not averaged over elements: across their borders it jumps, as derivatives of finite elements do.
//!
//! Cost: at the start a strain per dof and point of every element under the gauge; then a product with the
//! displacements of their nodes.

use std::collections::BTreeMap;

use mesh::{Facet, Mesh};

use super::kernel::strains_at;
use super::points::MeshPoint;
use crate::element::{self, MAX_NODES};
use crate::facet;
use crate::material::Material;
use crate::quadrature::{self, VolumeRule};
use crate::table::ShapeTable;

/// A point of a gauge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugePoint {
    /// Where it lies.
    pub place: MeshPoint,
    /// Direction of its strain, a unit vector.
    pub direction: [f64; 3],
}

/// Mean strain over points.
#[derive(Clone, Debug, PartialEq)]
pub struct StrainGauge {
    /// Nodes, ascending, and the strain per displacement of each, 1/m.
    displacement: Vec<(usize, [f64; 3])>,
    /// The same nodes, and the strain per stress there, 1/Pa.
    stress: Vec<(usize, [f64; 6])>,
}

impl MeshPoint {
    /// The point of a facet at reference coordinates of the facet.
    pub fn on_facet(mesh: &Mesh, facet: Facet, xi: [f64; 2]) -> MeshPoint {
        let shape = facet::shape(mesh.kind.facet_kind(), xi);
        let corners = element::reference_nodes(mesh.kind);
        let mut place = [0.0; 3];
        for (&node, value) in mesh.kind.face_nodes(facet.face).iter().zip(shape) {
            for i in 0..3 {
                place[i] += value * corners[node][i];
            }
        }
        MeshPoint {
            element: facet.element,
            xi: place,
        }
    }
}

impl StrainGauge {
    /// The mean over points that count alike, in a mesh whose elements are sound.
    ///
    /// # Panics
    /// Without points.
    pub fn new(mesh: &Mesh, material: &Material, points: &[GaugePoint]) -> StrainGauge {
        assert!(!points.is_empty(), "a gauge has at least one point");
        let mut by_element: BTreeMap<usize, Vec<GaugePoint>> = BTreeMap::new();
        for point in points {
            by_element.entry(point.place.element).or_default().push(*point);
        }
        let share = 1.0 / points.len() as f64;
        let (mut displacement, mut stress) = (BTreeMap::new(), BTreeMap::new());
        for (&e, points) in &by_element {
            let rows = element_rows(mesh, material, e, points);
            for (a, &node) in mesh.element(e).iter().enumerate() {
                let sum: &mut [f64; 3] = displacement.entry(node).or_default();
                (0..3).for_each(|i| sum[i] += share * rows[a][i]);
                let of_stress: &mut [f64; 6] = stress.entry(node).or_default();
                for point in points {
                    let value = share * element::shape(mesh.kind, point.place.xi)[a];
                    let row = compliance(material, point.direction);
                    (0..6).for_each(|c| of_stress[c] += value * row[c]);
                }
            }
        }
        StrainGauge {
            displacement: displacement.into_iter().collect(),
            stress: stress.into_iter().collect(),
        }
    }

    /// Nodes whose displacements it reads, ascending.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.displacement.iter().map(|(node, _)| *node)
    }

    /// Strain under displacements of all nodes of the mesh, m, `[3 n_nodes]`.
    pub fn strain(&self, u: &[f64]) -> f64 {
        let of_node = |(node, w): &(usize, [f64; 3])| (0..3).map(|i| w[i] * u[3 * node + i]).sum::<f64>();
        self.displacement.iter().map(of_node).sum()
    }

    /// Strain by Hooke's law under stress that is known at all nodes of the mesh, Pa, `[n_nodes][6]`.
    pub fn strain_of_stress(&self, nodal: &[[f64; 6]]) -> f64 {
        let of_node = |(node, w): &(usize, [f64; 6])| (0..6).map(|c| w[c] * nodal[*node][c]).sum::<f64>();
        self.stress.iter().map(of_node).sum()
    }
}

/// Sum over points of one element of n . E n per displacement of its nodes, 1/m.
fn element_rows(mesh: &Mesh, material: &Material, e: usize, points: &[GaugePoint]) -> [[f64; 3]; MAX_NODES] {
    let rule = VolumeRule {
        points: points.iter().map(|point| point.place.xi).collect(),
        weights: vec![1.0; points.len()],
    };
    let mut nodes = mesh.element(e).to_vec();
    nodes.sort_unstable();
    let own = mesh.part(&[e], &nodes);
    let (table, stiffness) = (
        ShapeTable::new(mesh.kind, &rule),
        ShapeTable::new(mesh.kind, &quadrature::stiffness_rule(mesh.kind)),
    );
    let lame = [material.lame_lambda(), material.shear_modulus()];
    let mut rows = [[0.0; 3]; MAX_NODES];
    let mut u = vec![0.0; own.n_dofs()];
    for (a, &node) in own.element(0).iter().enumerate() {
        for i in 0..3 {
            u[3 * node + i] = 1.0;
            let strains = strains_at(&own, 0, &u, lame, &stiffness, &table);
            let along = strains.iter().zip(points).map(|(e, p)| along(*e, p.direction));
            rows[a][i] = along.sum();
            u[3 * node + i] = 0.0;
        }
    }
    rows
}

/// n . E n of a strain with engineering shear.
fn along([xx, yy, zz, xy, yz, xz]: [f64; 6], [x, y, z]: [f64; 3]) -> f64 {
    xx * x * x + yy * y * y + zz * z * z + xy * x * y + yz * y * z + xz * x * z
}

/// n . E n per stress: E = ((1 + nu) s - nu tr(s) I) / E.
fn compliance(material: &Material, [x, y, z]: [f64; 3]) -> [f64; 6] {
    let (young, nu) = (material.young_modulus, material.poisson_ratio);
    let normal = |n: f64| ((1.0 + nu) * n * n - nu) / young;
    let shear = |product: f64| 2.0 * (1.0 + nu) * product / young;
    [
        normal(x),
        normal(y),
        normal(z),
        shear(x * y),
        shear(y * z),
        shear(x * z),
    ]
}
