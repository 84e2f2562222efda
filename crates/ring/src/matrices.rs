//! Stiffness and mass of a ring in its coordinates: of a periodic ring through one sector, of one in sectors as their
//! sum, of any other as sparse matrices.
//!
//! Coordinates y and nodal values w = T y: K acts as T^T K T. Cost of a product: of a periodic ring 9 multiplications
//! and additions per coupling of nodes with weights in the cache; else one reading of the matrix from memory.

use mesh::NodePositions;
use solver::CyclicStencil;
use solver::{SolverError, SparseCholesky, Symbolic, restrict_lower};
use sprs::CsMat;

use crate::coordinates::Coordinates;
use crate::error::RingError;
use crate::harmonic::defect::RingDefect;
use crate::model::RingModel;
use crate::sparse::{elimination_order, kronecker, node_product, product};
use crate::substructures::Substructures;
use crate::vectors::{add, dot};

/// K and M of one ring.
pub trait NodalMatrices: Send + Sync {
    /// Number of matrices: K and M, whole, of one sector, or of each sector on this rank.
    fn n_matrices(&self) -> usize;

    /// K x of coordinates, `[n]`.
    fn stiffness_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64>;

    /// The same of a block of vectors, column-major `[n][n_vectors]`.
    fn stiffness_products(&self, coordinates: &Coordinates, x: &[f64], n_vectors: usize) -> Vec<f64> {
        let columns = x.chunks_exact((x.len() / n_vectors.max(1)).max(1));
        columns
            .flat_map(|x| self.stiffness_product(coordinates, x))
            .collect()
    }

    /// M of a nodal field, `[n_nodes][3]` flat.
    fn nodal_mass_product(&self, field: &[f64]) -> Vec<f64>;

    /// Forces by the stress of a turning ring at unit speed, K_1 of a nodal field, N s^2, `[n_nodes][3]` flat; None
    /// where that does not stiffen the ring.
    fn nodal_stress_product(&self, _field: &[f64]) -> Option<Vec<f64>> {
        None
    }

    /// M x of coordinates, `[n]`.
    fn mass_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64> {
        coordinates.reduce(&self.nodal_mass_product(&coordinates.expand(x)))
    }

    /// M a + K b of coordinates, `[n]`.
    fn sum_of_products(&self, coordinates: &Coordinates, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut sum = self.mass_product(coordinates, a);
        let k = self.stiffness_product(coordinates, b);
        sum.iter_mut().zip(&k).for_each(|(m, k)| *m += k);
        sum
    }

    /// v M v / 2 and w K w / 2, J.
    fn energies(&self, coordinates: &Coordinates, v: &[f64], w: &[f64]) -> [f64; 2] {
        [
            0.5 * dot(v, &self.mass_product(coordinates, v)),
            0.5 * dot(w, &self.stiffness_product(coordinates, w)),
        ]
    }

    /// Energies of a state, J, and what the next step has on its right-hand side but loads, `[n]`. K w serves both.
    fn of_state(&self, coordinates: &Coordinates, state: &StateVectors) -> ([f64; 2], Vec<f64>) {
        let (v, w) = (state.velocity, &state.strained);
        let stiff = self.stiffness_product(coordinates, w);
        let energies = [
            0.5 * dot(v, &self.mass_product(coordinates, v)),
            0.5 * dot(w, &stiff),
        ];
        let mut side = self.mass_product(coordinates, &state.inertial);
        side.iter_mut().zip(&stiff).for_each(|(side, k)| *side -= k);
        if state.damped.iter().any(|&x| x != 0.0) {
            add(&mut side, &self.stiffness_product(coordinates, &state.damped));
        }
        (energies, side)
    }
}

/// Vectors of a state that K and M meet at the end of a step and the begin of the next, coordinates.
pub struct StateVectors<'a> {
    /// v.
    pub velocity: &'a [f64],
    /// w less the rigid motion of the ring's partner, which K does not see.
    pub strained: Vec<f64>,
    /// Of v and a, what M meets in the next step.
    pub inertial: Vec<f64>,
    /// Of v and a, what K meets, which is damping; zero without.
    pub damped: Vec<f64>,
}

/// Which of the matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matrix {
    /// M.
    Mass,
    /// K.
    Stiffness,
    /// K_1, the stiffness by the stress of turning with unit speed, kg.
    Stress,
}

/// Matrices of a ring that is not periodic, one each.
pub struct SparseMatrices {
    /// K of the coordinates.
    stiffness: CsMat<f64>,
    /// Mass between nodes.
    node_mass: CsMat<f64>,
    /// K_1 between nodes, where the stress of turning stiffens the ring.
    node_stress: Option<CsMat<f64>>,
}

/// Matrices of a periodic ring: blocks of one sector of the whole ring.
pub struct Stencils {
    /// K.
    pub stiffness: Box<CyclicStencil>,
    /// M.
    pub mass: Box<CyclicStencil>,
    /// K_1, where the stress of turning stiffens the ring.
    pub stress: Option<Box<CyclicStencil>>,
    /// What a defect adds.
    pub defect: Option<Box<RingDefect>>,
}

impl SparseMatrices {
    /// Assembles the ring, stiffened by the stress of an `expansion`, see [`crate::expansion`].
    pub fn new(
        ring: &RingModel,
        side: &'static str,
        coordinates: &Coordinates,
        expansion: Option<&[f64]>,
    ) -> Result<SparseMatrices, RingError> {
        let fem_error = |source| RingError::Fem { side, source };
        let mesh = &ring.mesh;
        let stiffness = fem::assemble_stiffness(mesh, &ring.material).map_err(fem_error)?;
        let pattern = fem::Pattern::new(mesh).map_err(fem_error)?;
        let stress = |u: &[f64]| fem::assemble_node_prestress(&pattern, mesh, &ring.material, u);
        Ok(SparseMatrices {
            stiffness: coordinates.reduce_matrix(&stiffness),
            node_mass: fem::assemble_node_mass(&pattern, mesh, &ring.material).map_err(fem_error)?,
            node_stress: expansion.map(stress).transpose().map_err(fem_error)?,
        })
    }

    /// Stored entries of K.
    pub fn n_entries(&self) -> usize {
        self.stiffness.nnz()
    }

    /// Analysis of c_M M + c_K K.
    pub fn analyse(&self, ring: &RingModel, coordinates: &Coordinates) -> Result<Symbolic, SolverError> {
        let mut order = elimination_order(&ring.mesh, coordinates.free());
        order.extend(coordinates.free().len()..coordinates.n());
        Symbolic::new(&self.effective(coordinates, [1.0; 2]), &order)
    }

    /// c_M M + c_K K, its lower triangle.
    fn effective(&self, coordinates: &Coordinates, [c_mass, c_stiffness]: [f64; 2]) -> CsMat<f64> {
        let rows: Vec<usize> = (0..coordinates.n()).collect();
        let mass = coordinates.reduce_matrix(&kronecker(&self.node_mass));
        let mass = restrict_lower(&mass, &rows).map(|x| c_mass * x);
        &mass + &restrict_lower(&self.stiffness, &rows).map(|x| c_stiffness * x)
    }

    /// Factor of c_M M + c_K K.
    pub fn factor(
        &self,
        symbolic: &Symbolic,
        coordinates: &Coordinates,
        coefficients: [f64; 2],
    ) -> Result<SparseCholesky, SolverError> {
        symbolic.factor(&self.effective(coordinates, coefficients))
    }
}

impl NodalMatrices for SparseMatrices {
    fn n_matrices(&self) -> usize {
        2 + usize::from(self.node_stress.is_some())
    }

    fn nodal_stress_product(&self, field: &[f64]) -> Option<Vec<f64>> {
        Some(node_product(self.node_stress.as_ref()?, field))
    }

    fn stiffness_product(&self, _: &Coordinates, x: &[f64]) -> Vec<f64> {
        product(&self.stiffness, x)
    }

    fn stiffness_products(&self, _: &Coordinates, x: &[f64], n_vectors: usize) -> Vec<f64> {
        solver::products(&self.stiffness, x, n_vectors)
    }

    fn nodal_mass_product(&self, field: &[f64]) -> Vec<f64> {
        node_product(&self.node_mass, field)
    }
}

impl NodalMatrices for Substructures {
    fn n_matrices(&self) -> usize {
        2 * self.n_own()
    }

    fn stiffness_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64> {
        coordinates.reduce(&self.nodal_stiffness_product(&coordinates.expand(x)))
    }

    fn nodal_mass_product(&self, field: &[f64]) -> Vec<f64> {
        self.nodal_mass_products(field)
    }
}

impl NodalMatrices for Stencils {
    fn n_matrices(&self) -> usize {
        2 + usize::from(self.stress.is_some())
    }

    fn nodal_stress_product(&self, field: &[f64]) -> Option<Vec<f64>> {
        Some(self.stress.as_ref()?.apply(field))
    }

    fn stiffness_product(&self, coordinates: &Coordinates, x: &[f64]) -> Vec<f64> {
        let x = coordinates.expand(x);
        let mut product = self.stiffness.apply(&x);
        if let Some(defect) = &self.defect {
            defect.add_stiffness_product(&x, &mut product);
        }
        coordinates.reduce(&product)
    }

    fn nodal_mass_product(&self, field: &[f64]) -> Vec<f64> {
        let mut product = self.mass.apply(field);
        if let Some(defect) = &self.defect {
            defect.add_mass_product(field, &mut product);
        }
        product
    }

    fn sum_of_products(&self, coordinates: &Coordinates, a: &[f64], b: &[f64]) -> Vec<f64> {
        let ring = self.mass.ring();
        let mut lines = vec![0.0; ring.lines_len()];
        let mut sum = vec![0.0; self.mass.product_len()];
        let [a, b] = [a, b].map(|x| coordinates.expand(x));
        for (operator, x) in [(&self.mass, &a), (&self.stiffness, &b)] {
            ring.to_lines(x, &mut lines);
            operator.add_product(&lines, &mut sum);
        }
        let mut nodal = vec![0.0; coordinates.expanded()];
        ring.add_from_lines(&sum, &mut nodal);
        if let Some(defect) = &self.defect {
            defect.add_mass_product(&a, &mut nodal);
            defect.add_stiffness_product(&b, &mut nodal);
        }
        coordinates.reduce(&nodal)
    }

    fn energies(&self, coordinates: &Coordinates, v: &[f64], w: &[f64]) -> [f64; 2] {
        let square = |operator: &CyclicStencil, x: &[f64]| {
            let ring = operator.ring();
            let mut lines = vec![0.0; ring.lines_len()];
            ring.to_lines(x, &mut lines);
            let mut product = vec![0.0; operator.product_len()];
            operator.add_product(&lines, &mut product);
            operator.lines_dot(&lines, &product)
        };
        let [v, w] = [v, w].map(|x| coordinates.expand(x));
        let (mut kinetic, mut strain) =
            rayon::join(|| square(&self.mass, &v), || square(&self.stiffness, &w));
        if let Some(defect) = &self.defect {
            kinetic += defect.mass_square(&v);
            strain += defect.stiffness_square(&w);
        }
        [0.5 * kinetic, 0.5 * strain]
    }
}

/// A ring's matrices between nodes, from which harmonics take what the dofs of its partner add.
#[derive(Clone, Copy)]
pub(crate) struct Nodes<'a> {
    pub coordinates: &'a Coordinates,
    pub matrices: &'a dyn NodalMatrices,
    /// m, `[n_nodes][3]` flat.
    pub positions: &'a NodePositions,
}

impl Nodes<'_> {
    /// Columns of c_M M + c_K K that belong to the shaft dofs: the rows of the free dofs, column-major, and those of
    /// the shaft, row-major.
    pub fn border(&self, [cm, ck]: [f64; 2]) -> [Vec<f64>; 2] {
        self.border_of(|k| {
            let [m, k] = [cm, ck].map(|c| self.unit(k, c));
            self.matrices.sum_of_products(self.coordinates, &m, &k)
        })
    }

    /// The same of K_1, which the ring must have.
    pub fn stress_border(&self) -> [Vec<f64>; 2] {
        self.border_of(|k| {
            let field = self.coordinates.expand(&self.unit(k, 1.0));
            let product = self.matrices.nodal_stress_product(&field);
            self.coordinates
                .reduce(&product.expect("the stress stiffens the ring"))
        })
    }

    /// The border of a matrix by its columns of coordinates.
    fn border_of(&self, column: impl Fn(usize) -> Vec<f64>) -> [Vec<f64>; 2] {
        let (n_free, n) = (self.coordinates.free().len(), self.coordinates.n());
        let (mut border, mut corner) = (Vec::new(), Vec::new());
        for k in n_free..n {
            let column = column(k);
            border.extend_from_slice(&column[..n_free]);
            corner.extend_from_slice(&column[n_free..]);
        }
        [border, corner]
    }

    /// Generalised loads M P x and M J x of the node positions x, with P u = (u_x, u_y, 0) and J u = (u_y, -u_x, 0).
    pub fn inertia_of_positions(&self) -> [Vec<f64>; 2] {
        self.inertia_of(self.positions.as_flattened())
    }

    /// The same of the motion of the held nodes with a dof of the shaft.
    pub fn inertia_of_shaft(&self, k: usize) -> [Vec<f64>; 2] {
        let n_free = self.coordinates.free().len();
        self.inertia_of(&self.coordinates.expand(&self.unit(n_free + k, 1.0)))
    }

    fn inertia_of(&self, u: &[f64]) -> [Vec<f64>; 2] {
        let load = |field: Vec<f64>| self.coordinates.reduce(&self.matrices.nodal_mass_product(&field));
        let own = u.chunks_exact(3).flat_map(|u| [u[0], u[1], 0.0]);
        let turned = u.chunks_exact(3).flat_map(|u| [u[1], -u[0], 0.0]);
        [load(own.collect()), load(turned.collect())]
    }

    /// Coordinates that are zero but for one.
    fn unit(&self, index: usize, value: f64) -> Vec<f64> {
        let mut unit = vec![0.0; self.coordinates.n()];
        unit[index] = value;
        unit
    }
}
