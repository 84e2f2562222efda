//! One ring as a vibrating body: K and M in its coordinates, the factor of K + s M, and what its partner imposes.
//!
//! With a clamped surface that moves with q dofs of the partner, w = T y, the matrices are
//! `[A_ff, B; B^T, C]`, B = A R at the free dofs, C = R^T A R with the motions R of the clamped nodes: solved by the factor of
//! the free block and a Schur complement of q rows. A mean-motion hold leaves all nodes free; its held motions are
//! constraints c^T w = 0, where c takes the area-weighted least-squares rigid motion of the surface.

use contact::Side;
use dense::DenseCholesky;
use mesh::Mesh;
use solver::{CyclicMatrix, CyclicStencil, LinearSolver, SolverError, Symbolic};
use sprs::CsMat;

use super::coordinates::Coordinates;
use super::products::products;
use crate::error::RingError;
use crate::harmonic::periodic::{Periodic, Sectors};
use crate::model::{Backend, Hold, RingModel};
use crate::sparse::elimination_order;
use crate::sparse::{SparseLoad, sparse_dot};
use crate::support::mean_motion;
use crate::vectors::dot;

/// The rigid body that holds a ring: shaft or housing.
pub struct Partner {
    /// Dofs that move, of x, y, z, tilt x, tilt y.
    moving: Vec<usize>,
    /// Mass that its translations carry, kg.
    mass: f64,
}

impl Partner {
    /// A partner with moving dofs.
    pub fn new(moving: Vec<usize>, mass: f64) -> Partner {
        Partner { moving, mass }
    }

    /// A partner that does not move.
    pub fn at_rest() -> Partner {
        Partner::new(Vec::new(), 0.0)
    }
}

/// A symmetric matrix in the coordinates of a ring.
struct Bordered {
    /// Free block.
    block: Block,
    /// Columns of the moving partner dofs, `[n_moving][n_free]`.
    border: Vec<Vec<f64>>,
    /// Their own block, row-major.
    corner: Vec<f64>,
}

/// The free block of a matrix.
enum Block {
    /// Both triangles.
    Sparse(CsMat<f64>),
    /// Of a periodic ring: the blocks of one sector.
    Sectors(Box<CyclicStencil>),
}

/// A ring ready to vibrate.
pub struct RingBody {
    /// Its coordinates.
    pub coordinates: Coordinates,
    /// Partner dofs that move the ring: the last coordinates of a clamped ring.
    pub moving: Vec<usize>,
    /// Held motions of a mean-motion hold, as generalised loads.
    pub constraints: Vec<SparseLoad>,
    /// Masses that a mean motion carries: generalised load and kg.
    pub lumps: Vec<(SparseLoad, f64)>,
    /// Mean motions x, y, z, tilt x, tilt y of the held surface; empty when it is clamped or free.
    pub mean: Vec<SparseLoad>,
    /// Mass of the partner that the moving coordinates carry, kg.
    pub partner_mass: f64,
    stiffness: Bordered,
    mass: Bordered,
    factor: Box<dyn LinearSolver>,
    /// (K + s M)_ff^-1 times the border, column-major `[n_free][n_moving]`.
    columns: Vec<f64>,
    schur: Option<DenseCholesky>,
    /// Border of K + s M, `[n_moving][n_free]`.
    border: Vec<Vec<f64>>,
}

impl RingBody {
    /// Assembles and factors the ring on `side`, held by a partner or free.
    pub fn new(
        side: Side,
        ring: &RingModel,
        partner: Option<Partner>,
        shift: f64,
        backend: Backend,
    ) -> Result<RingBody, RingError> {
        let mesh = &ring.mesh;
        let motions = fem::rigid_modes(mesh, [0.0, 0.0, ring.groove.centre_z]);
        let (clamped, moving) = match (&partner, ring.hold) {
            (Some(partner), Hold::Clamped) => (mesh.group_nodes(ring.held_group), partner.moving.clone()),
            _ => (Vec::new(), Vec::new()),
        };
        let moved: Vec<&Vec<f64>> = moving.iter().map(|&dof| &motions[dof]).collect();
        let coordinates = Coordinates::new(mesh.n_dofs(), &clamped, &moved);
        let parts = match Periodic::for_modes(ring, side.name(), backend, &clamped)? {
            Ok(Periodic { whole, held, .. }) => cyclic_parts(&whole, &held.sectors, &coordinates, shift),
            Err(_) => sparse_parts(ring, side, &coordinates, shift)?,
        };
        let Parts {
            stiffness,
            mut mass,
            factor,
        } = parts.map_err(|source| RingError::Solver {
            side: side.name(),
            source,
        })?;
        let mut body = Holding::default();
        let mut partner_mass = 0.0;
        if let Some(partner) = &partner {
            match ring.hold {
                Hold::Clamped => {
                    partner_mass = partner.mass;
                    mass.add_to_translations(&moving, partner.mass);
                }
                Hold::MeanMotion => body = Holding::mean(mesh, ring, partner, &coordinates),
                Hold::Free => {}
            }
        }
        let (border, columns, schur) = eliminate(&*factor, &stiffness, &mass, shift);
        Ok(RingBody {
            coordinates,
            moving,
            constraints: body.constraints,
            lumps: body.lumps,
            mean: body.mean,
            partner_mass,
            stiffness,
            mass,
            factor,
            columns,
            schur,
            border,
        })
    }

    /// Number of coordinates.
    pub fn n(&self) -> usize {
        self.coordinates.n()
    }

    /// K Y of a block of vectors, column-major, without what constraints and contacts add.
    pub fn stiffness(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        self.stiffness.times(y, n_vectors)
    }

    /// M Y of a block of vectors without the masses that mean motions carry.
    pub fn mass(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        self.mass.times(y, n_vectors)
    }

    /// (K + s M)^-1 of a block of `n_vectors` loads, column-major `[n][n_vectors]`.
    pub fn solve(&self, loads: &mut [f64], n_vectors: usize) {
        let (n, m) = (self.n(), self.border.len());
        let n_free = n - m;
        let Some(schur) = &self.schur else {
            self.factor.solve(loads, n_vectors);
            return;
        };
        let columns = loads.chunks_exact(n);
        let mut free: Vec<f64> = columns.flat_map(|load| load[..n_free].to_vec()).collect();
        self.factor.solve(&mut free, n_vectors);
        for (load, z) in loads.chunks_exact_mut(n).zip(free.chunks_exact(n_free)) {
            let mut q: Vec<f64> = (0..m)
                .map(|k| load[n_free + k] - dot(&self.border[k], z))
                .collect();
            schur.solve(&mut q, 1);
            load[..n_free].copy_from_slice(z);
            for (column, q) in self.columns.chunks_exact(n_free).zip(&q) {
                load[..n_free]
                    .iter_mut()
                    .zip(column)
                    .for_each(|(y, x)| *y -= x * q);
            }
            load[n_free..].copy_from_slice(&q);
        }
    }

    /// Motion x, y, z, tilt x, tilt y of the partner, m and rad.
    pub fn partner_motion(&self, y: &[f64]) -> [f64; 5] {
        let mut motion = [0.0; 5];
        let n_free = self.n() - self.moving.len();
        for (&dof, q) in self.moving.iter().zip(&y[n_free..]) {
            motion[dof] = *q;
        }
        for (q, mean) in motion.iter_mut().zip(&self.mean) {
            *q = sparse_dot(mean, y);
        }
        motion
    }
}

/// What a mean-motion hold adds to a ring.
#[derive(Default)]
struct Holding {
    constraints: Vec<SparseLoad>,
    lumps: Vec<(SparseLoad, f64)>,
    mean: Vec<SparseLoad>,
}

impl Holding {
    fn mean(mesh: &Mesh, ring: &RingModel, partner: &Partner, coordinates: &Coordinates) -> Holding {
        let weights = fem::facet_node_weights(mesh, mesh.group(ring.held_group));
        let rows = mean_motion(mesh, weights, ring.groove.centre_z);
        let mut functionals: Vec<SparseLoad> = rows
            .into_iter()
            .map(|row| coordinates.reduce(row.into_iter()))
            .collect();
        let constraints = (0..6).filter(|dof| !partner.moving.contains(dof));
        let lumps = (0..3).filter(|dof| partner.mass > 0.0 && partner.moving.contains(dof));
        Holding {
            constraints: constraints.map(|dof| functionals[dof].clone()).collect(),
            lumps: lumps
                .map(|dof| (functionals[dof].clone(), partner.mass))
                .collect(),
            mean: {
                functionals.truncate(5);
                functionals
            },
        }
    }
}

impl Block {
    /// Product with a block of vectors, column-major.
    fn times(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        match self {
            Block::Sparse(matrix) => products(matrix, x, n_vectors),
            Block::Sectors(operator) => {
                let columns = x.chunks_exact((x.len() / n_vectors.max(1)).max(1));
                columns.flat_map(|x| operator.apply(x)).collect()
            }
        }
    }
}

impl Bordered {
    /// A matrix from its free block and the product of the whole one with a nodal vector.
    fn new(block: Block, whole: impl Fn(&[f64]) -> Vec<f64>, coordinates: &Coordinates) -> Bordered {
        let free = &coordinates.free;
        let m = coordinates.n_moving();
        let motions: Vec<Vec<f64>> = (0..m).map(|k| coordinates.held_motion(k)).collect();
        let forces: Vec<Vec<f64>> = motions.iter().map(|motion| whole(motion)).collect();
        let mut corner = vec![0.0; m * m];
        for k in 0..m {
            for l in 0..m {
                corner[m * k + l] = 0.5 * (dot(&motions[k], &forces[l]) + dot(&motions[l], &forces[k]));
            }
        }
        Bordered {
            block,
            border: forces
                .iter()
                .map(|force| free.iter().map(|&dof| force[dof]).collect())
                .collect(),
            corner,
        }
    }

    /// Adds a mass to the translations among the moving dofs.
    fn add_to_translations(&mut self, moving: &[usize], mass: f64) {
        for (k, &dof) in moving.iter().enumerate() {
            if dof < 3 {
                self.corner[moving.len() * k + k] += mass;
            }
        }
    }

    /// Product with a block of vectors, column-major.
    fn times(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        let m = self.border.len();
        if m == 0 {
            return self.block.times(y, n_vectors);
        }
        let n_free = self.border[0].len();
        let columns = y.chunks_exact(n_free + m);
        let free: Vec<f64> = columns.clone().flat_map(|y| y[..n_free].to_vec()).collect();
        let inner = self.block.times(&free, n_vectors);
        let mut result = Vec::with_capacity(y.len());
        for (y, inner) in columns.zip(inner.chunks_exact(n_free)) {
            let (free, q) = y.split_at(n_free);
            let start = result.len();
            result.extend_from_slice(inner);
            for (border, q) in self.border.iter().zip(q) {
                result[start..]
                    .iter_mut()
                    .zip(border)
                    .for_each(|(r, b)| *r += b * q);
            }
            let rows = self.border.iter().zip(self.corner.chunks_exact(m));
            result.extend(rows.map(|(border, corner)| dot(border, free) + dot(corner, q)));
        }
        result
    }
}

/// Matrices and factor of a ring's free block.
struct Parts {
    stiffness: Bordered,
    mass: Bordered,
    factor: Box<dyn LinearSolver>,
}

/// Those of a periodic ring, `held` without its clamped nodes.
fn cyclic_parts(
    whole: &Sectors,
    held: &Sectors,
    coordinates: &Coordinates,
    shift: f64,
) -> Result<Parts, SolverError> {
    let bordered = |of_whole: &CyclicMatrix, of_held: &CyclicMatrix| -> Result<Bordered, SolverError> {
        let operator = whole.ring.operator(of_whole)?;
        let block = Block::Sectors(Box::new(held.ring.operator(of_held)?));
        Ok(Bordered::new(block, |x| operator.apply(x), coordinates))
    };
    let shifted = held.stiffness.combined(1.0, shift, &held.mass)?;
    Ok(Parts {
        stiffness: bordered(&whole.stiffness, &held.stiffness)?,
        mass: bordered(&whole.mass, &held.mass)?,
        factor: Box::new(held.ring.factor(&shifted)?),
    })
}

/// Those of any other ring; the inner error is the factorisation's.
fn sparse_parts(
    ring: &RingModel,
    side: Side,
    coordinates: &Coordinates,
    shift: f64,
) -> Result<Result<Parts, SolverError>, RingError> {
    let fem_error = |source| RingError::Fem {
        side: side.name(),
        source,
    };
    // The whole matrices go as soon as they are reduced.
    let bordered = |full: CsMat<f64>| {
        let block = solver::restrict(&full, &coordinates.free);
        let border = |x: &[f64]| products(&full, x, 1);
        Bordered::new(Block::Sparse(block), border, coordinates)
    };
    let (mesh, material) = (&ring.mesh, &ring.material);
    let stiffness = fem::assemble_stiffness(mesh, material)
        .map(bordered)
        .map_err(fem_error)?;
    let mass = fem::assemble_mass(mesh, material)
        .map(bordered)
        .map_err(fem_error)?;
    let (Block::Sparse(k), Block::Sparse(m)) = (&stiffness.block, &mass.block) else {
        unreachable!("both were just made from sparse matrices")
    };
    // Only lower triangles are added: the factorisation needs no more.
    let all: Vec<usize> = (0..coordinates.free.len()).collect();
    let [k, m] = [k, m].map(|a| solver::restrict_lower(a, &all));
    let lower = &k + &m.map(|x| shift * x);
    drop((k, m));
    let order = elimination_order(mesh, &coordinates.free);
    let factor = Symbolic::new(&lower, &order).and_then(|symbolic| symbolic.factor(&lower));
    Ok(factor.map(|factor| Parts {
        stiffness,
        mass,
        factor: Box::new(factor),
    }))
}

/// Border of K + s M, its solution by the free block, and the Schur complement of the moving dofs.
fn eliminate(
    factor: &dyn LinearSolver,
    stiffness: &Bordered,
    mass: &Bordered,
    shift: f64,
) -> (Vec<Vec<f64>>, Vec<f64>, Option<DenseCholesky>) {
    let m = stiffness.border.len();
    let pairs = stiffness.border.iter().zip(&mass.border);
    let border: Vec<Vec<f64>> = pairs
        .map(|(k, m)| k.iter().zip(m).map(|(k, m)| k + shift * m).collect())
        .collect();
    if m == 0 {
        return (border, Vec::new(), None);
    }
    let mut columns = border.concat();
    factor.solve(&mut columns, m);
    let n_free = columns.len() / m;
    let mut schur = vec![0.0; m * m];
    for k in 0..m {
        for l in 0..m {
            let corner = stiffness.corner[m * k + l] + shift * mass.corner[m * k + l];
            schur[m * k + l] = corner - dot(&border[k], &columns[n_free * l..n_free * (l + 1)]);
        }
    }
    let schur = DenseCholesky::factor(m, &schur)
        .expect("K + s M of a ring with mass is positive definite, and so is its Schur complement");
    (border, columns, Some(schur))
}
