//! Tensors at points of a ring that are no nodes, such as the integration points of its elements, by the weights of
//! one sector.
//!
//! A point belongs to a *class* of points that turns take into each other; the rows of the operator are the classes
//! in place of the section nodes, and a line holds the points of a class by the sector of the node that each is
//! attached to.

use rayon::prelude::*;

use super::{CyclicStencil, turned};
use crate::cyclic::pattern::Coupling;
use crate::cyclic::ring::CyclicRing;

/// Elements of one task.
const ELEMENTS: usize = 256;

/// An operator from nodal vectors to tensors at points.
#[derive(Clone, Debug)]
pub struct PointStencil {
    stencil: CyclicStencil,
    points_per_element: usize,
}

impl CyclicRing {
    /// The operator with the blocks `blocks`, row-major `[n_couplings][6][3]`, where the row of a coupling is one of
    /// `n_classes` of points, and its shift that from the node to which the point is attached. Points come in
    /// elements of `points_per_element` classes.
    ///
    /// # Panics
    /// When the lengths disagree, or a coupling reaches farther than those of the ring.
    pub fn point_stencil(
        &self,
        (n_classes, points_per_element): (usize, usize),
        couplings: &[Coupling],
        blocks: &[f64],
    ) -> PointStencil {
        PointStencil {
            stencil: self.stencil_of_rows(6, (n_classes, |row| row), couplings, blocks),
            points_per_element,
        }
    }
}

impl PointStencil {
    /// Tensors in Cartesian components, order xx yy zz xy yz xz, at the points of elements,
    /// `[n_elements][points_per_element]`, for displacements `x` (Cartesian, `[n]`). `elements` has the class of
    /// elements of each, and the caller's node to which its points are attached.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn tensors(&self, x: &[f64], elements: &[[usize; 2]]) -> Vec<[f64; 6]> {
        let (ring, n_points) = (&self.stencil.ring, self.points_per_element);
        let mut lines = vec![0.0; ring.lines_len()];
        ring.to_lines(x, &mut lines);
        let mut product = vec![0.0; self.stencil.product_len()];
        self.stencil.add_product(&lines, &mut product);
        let (stride, reach, width) = (ring.stride(), ring.reach(), ring.n_section_nodes());
        let mut tensors = vec![[0.0; 6]; n_points * elements.len()];
        tensors
            .par_chunks_mut(n_points * ELEMENTS)
            .zip(elements.par_chunks(ELEMENTS))
            .for_each(|(tensors, elements)| {
                for (tensors, &[class, node]) in tensors.chunks_exact_mut(n_points).zip(elements) {
                    let site = ring.shared.sites[node];
                    for (point, tensor) in tensors.iter_mut().enumerate() {
                        let first = 6 * (n_points * class + point) * stride + reach + site / width;
                        let values = std::array::from_fn(|i| product[first + i * stride]);
                        *tensor = turned(values, ring.shared.directions[site]);
                    }
                }
            });
        tensors
    }

    /// Bytes of the blocks.
    pub fn bytes(&self) -> usize {
        self.stencil.bytes()
    }
}
