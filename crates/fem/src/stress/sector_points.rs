//! Stress at the integration points of a rotationally periodic ring by the weights of one sector.
//!
//! The elements of a ring fall into classes whose members turns take into each other ([`Periodicity::elements`] names
//! one of each). In the cylindrical components of the nodes, and along the directions (radial, azimuthal, axial) at
//! the first node of an element, stress at its points has the same weights in the whole class, if the nodes of all
//! its elements are in the same order. The incompatible modes of hex8 are in the weights.
//!
//! Cost: 3 n stresses per element of one sector, n nodes each; memory 144 B per point and node of such an element.

use std::collections::BTreeMap;

use mesh::{Mesh, Periodicity};

use super::recovery::StressRecovery;
use super::sector::{cylindrical, for_each_unit};
use crate::sector::{SectorCoupling, azimuth_directions, coupling};

/// Stress at the points of one element of every class.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorPoints {
    /// Couplings of points with the nodes of their element, class by class, point by point: the row is the class of
    /// the element times the points of an element, plus the point, and the shift that from the first node of the
    /// element.
    pub couplings: Vec<SectorCoupling>,
    /// Stress in the order rr tt zz rt tz rz, at the first node of the element, per displacement along (radial,
    /// azimuthal, axial), Pa/m, `[n_couplings][6][3]`.
    pub weights: Vec<[[f64; 3]; 6]>,
    /// Class and first node of every element of the mesh, `[n_elements]`.
    pub elements: Vec<[usize; 2]>,
    /// Points of an element.
    pub points_per_element: usize,
}

impl StressRecovery {
    /// The weights of one sector of the mesh, which `periodicity` describes; None when elements of one class have
    /// their nodes in different orders, and so their points.
    ///
    /// # Panics
    /// If mesh or periodicity are others than this recovery's.
    pub fn sector_points(&self, mesh: &Mesh, periodicity: &Periodicity) -> Option<SectorPoints> {
        let n_nodes = periodicity.sites().len();
        assert_eq!(mesh.n_nodes(), n_nodes, "the periodicity belongs to another mesh");
        assert_eq!(self.n_nodes(), n_nodes, "the recovery belongs to another mesh");
        let elements = classes(mesh, periodicity)?;
        let n_points = self.points_per_element();
        let directions = azimuth_directions(mesh);
        let (mut couplings, mut weights) = (Vec::new(), Vec::new());
        for (class, &e) in periodicity.elements().iter().enumerate() {
            let nodes = mesh.element(e);
            let first = couplings.len();
            for point in 0..n_points {
                couplings.extend(nodes.iter().map(|&node| SectorCoupling {
                    row: n_points * class + point,
                    ..coupling(periodicity, nodes[0], node)
                }));
            }
            weights.resize(couplings.len(), [[0.0; 3]; 6]);
            self.add_element(mesh, e, &directions, &mut weights[first..]);
        }
        Some(SectorPoints {
            couplings,
            weights,
            elements,
            points_per_element: n_points,
        })
    }

    /// Writes the weights of one element, `[points][nodes]`.
    fn add_element(&self, mesh: &Mesh, e: usize, directions: &[[f64; 2]], weights: &mut [[[f64; 3]; 6]]) {
        let nodes = mesh.element(e);
        for_each_unit(mesh, nodes, directions, |[b, j], state| {
            let (points, _) = self.state_stress(state);
            for (weights, stress) in weights.chunks_exact_mut(nodes.len()).zip(points) {
                let stress = cylindrical(stress, directions[nodes[0]]);
                weights[b]
                    .iter_mut()
                    .zip(stress)
                    .for_each(|(row, value)| row[j] = value);
            }
        });
    }
}

/// Class and first node of every element; None when nodes of a class come in different orders.
fn classes(mesh: &Mesh, periodicity: &Periodicity) -> Option<Vec<[usize; 2]>> {
    // Section nodes of an element and the sectors to them from the first.
    let key = |e: usize| -> Vec<(usize, i32)> {
        let nodes = mesh.element(e);
        let there = nodes.iter().map(|&node| coupling(periodicity, nodes[0], node));
        there.map(|c| (c.column, c.shift)).collect()
    };
    let of_class: BTreeMap<Vec<(usize, i32)>, usize> =
        periodicity.elements().iter().map(|&e| key(e)).zip(0..).collect();
    let class = |e: usize| Some([*of_class.get(&key(e))?, mesh.element(e)[0]]);
    (0..mesh.n_elements()).map(class).collect()
}
