//! Stiffness and mass of a moving ring: of a periodic ring through one sector, of any other as sparse matrices.
//!
//! Coordinates y and nodal values w = T y: K acts as T^T K T. Cost of a product: of a periodic ring 9 multiplications and
//! additions per coupling of nodes with weights in the cache; else one reading of the matrix from memory.

use std::sync::Arc;

use solver::{CyclicStencil, LinearSolver, SolverError, Symbolic};
use sprs::CsMat;

use super::coordinates::Coordinates;
use crate::defect::RingDefect;
use crate::error::DynamicsError;
use crate::model::RingModel;
use crate::ring::elimination_order;
use crate::solution::dot;
use crate::sparse::{kronecker, node_product, product};
use crate::substructures::Substructures;

/// K and M of one ring.
pub enum RingMatrices {
    /// As one matrix each.
    Sparse(SparseMatrices),
    /// Blocks of one sector of the whole ring.
    Sectors {
        /// K.
        stiffness: Box<CyclicStencil>,
        /// M.
        mass: Box<CyclicStencil>,
        /// What a defect adds.
        defect: Option<Box<RingDefect>>,
    },
    /// As sums of sectors cut by angle.
    Cut(Arc<Substructures>),
}

/// Matrices of a ring that is not periodic.
pub struct SparseMatrices {
    /// K of the coordinates.
    stiffness: CsMat<f64>,
    /// Mass between nodes.
    node_mass: CsMat<f64>,
}

impl SparseMatrices {
    /// Assembles the ring.
    pub fn new(
        ring: &RingModel,
        side: &'static str,
        coordinates: &Coordinates,
    ) -> Result<SparseMatrices, DynamicsError> {
        let fem_error = |source| DynamicsError::Fem { side, source };
        let mesh = &ring.mesh;
        let stiffness = fem::assemble_stiffness(mesh, &ring.material).map_err(fem_error)?;
        let pattern = fem::Pattern::new(mesh).map_err(fem_error)?;
        Ok(SparseMatrices {
            stiffness: coordinates.reduce_matrix(&stiffness),
            node_mass: fem::assemble_node_mass(&pattern, mesh, &ring.material).map_err(fem_error)?,
        })
    }

    /// Analysis of c_M M + c_K K.
    pub fn analyse(&self, ring: &RingModel, coordinates: &Coordinates) -> Result<Symbolic, SolverError> {
        let mut order = elimination_order(&ring.mesh, coordinates.free());
        order.extend(coordinates.free().len()..coordinates.n());
        let mass = coordinates.reduce_matrix(&kronecker(&self.node_mass));
        Symbolic::new(&(&mass + &self.stiffness), &order)
    }

    /// Factor of c_M M + c_K K.
    pub fn factor(
        &self,
        symbolic: &Symbolic,
        coordinates: &Coordinates,
        [c_mass, c_stiffness]: [f64; 2],
    ) -> Result<Box<dyn LinearSolver>, SolverError> {
        let mass = coordinates.reduce_matrix(&kronecker(&self.node_mass));
        let effective = &mass.map(|x| c_mass * x) + &self.stiffness.map(|x| c_stiffness * x);
        drop(mass);
        Ok(Box::new(symbolic.factor(&effective)?))
    }
}

impl RingMatrices {
    /// Number of matrices: K and M, whole, of one sector, or of each sector on this rank.
    pub fn n_matrices(&self) -> usize {
        match self {
            RingMatrices::Sparse(_) | RingMatrices::Sectors { .. } => 2,
            RingMatrices::Cut(parts) => parts.n_matrices(),
        }
    }

    /// K x of coordinates, `[n]`.
    pub fn stiffness_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64> {
        match self {
            RingMatrices::Sparse(matrices) => product(&matrices.stiffness, x),
            RingMatrices::Cut(parts) => coordinates.reduce(&parts.stiffness_product(&coordinates.expand(x))),
            RingMatrices::Sectors {
                stiffness, defect, ..
            } => {
                let x = coordinates.expand(x);
                let mut product = stiffness.apply(&x);
                if let Some(defect) = defect {
                    defect.add_stiffness_product(&x, &mut product);
                }
                coordinates.reduce(&product)
            }
        }
    }

    /// M x of coordinates, `[n]`.
    pub fn mass_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64> {
        coordinates.reduce(&self.nodal_mass_product(&coordinates.expand(x)))
    }

    /// M of a nodal field, `[n_nodes][3]` flat.
    pub fn nodal_mass_product(&self, field: &[f64]) -> Vec<f64> {
        match self {
            RingMatrices::Sparse(matrices) => node_product(&matrices.node_mass, field),
            RingMatrices::Cut(parts) => parts.mass_product(field),
            RingMatrices::Sectors { mass, defect, .. } => {
                let mut product = mass.apply(field);
                if let Some(defect) = defect {
                    defect.add_mass_product(field, &mut product);
                }
                product
            }
        }
    }

    /// M a + K b of coordinates, `[n]`.
    pub fn sum_of_products(&self, coordinates: &Coordinates, a: &[f64], b: &[f64]) -> Vec<f64> {
        let RingMatrices::Sectors {
            stiffness,
            mass,
            defect,
        } = self
        else {
            let (mut sum, k) = (
                self.mass_product(coordinates, a),
                self.stiffness_product(coordinates, b),
            );
            sum.iter_mut().zip(&k).for_each(|(m, k)| *m += k);
            return sum;
        };
        let ring = mass.ring();
        let mut lines = vec![0.0; ring.lines_len()];
        let mut sum = vec![0.0; mass.product_len()];
        let [a, b] = [a, b].map(|x| coordinates.expand(x));
        for (operator, x) in [(mass, &a), (stiffness, &b)] {
            ring.to_lines(x, &mut lines);
            operator.add_product(&lines, &mut sum);
        }
        let mut nodal = vec![0.0; coordinates.expanded()];
        ring.add_from_lines(&sum, &mut nodal);
        if let Some(defect) = defect {
            defect.add_mass_product(&a, &mut nodal);
            defect.add_stiffness_product(&b, &mut nodal);
        }
        coordinates.reduce(&nodal)
    }

    /// v M v / 2 and w K w / 2, J.
    pub fn energies(&self, coordinates: &Coordinates, v: &[f64], w: &[f64]) -> [f64; 2] {
        let RingMatrices::Sectors {
            stiffness,
            mass,
            defect,
        } = self
        else {
            return [
                0.5 * dot(v, &self.mass_product(coordinates, v)),
                0.5 * dot(w, &self.stiffness_product(coordinates, w)),
            ];
        };
        let square = |operator: &CyclicStencil, x: &[f64]| {
            let ring = operator.ring();
            let mut lines = vec![0.0; ring.lines_len()];
            ring.to_lines(x, &mut lines);
            let mut product = vec![0.0; operator.product_len()];
            operator.add_product(&lines, &mut product);
            operator.lines_dot(&lines, &product)
        };
        let [v, w] = [v, w].map(|x| coordinates.expand(x));
        let (mut kinetic, mut strain) = rayon::join(|| square(mass, &v), || square(stiffness, &w));
        if let Some(defect) = defect {
            kinetic += defect.mass_square(&v);
            strain += defect.stiffness_square(&w);
        }
        [0.5 * kinetic, 0.5 * strain]
    }
}
