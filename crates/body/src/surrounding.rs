//! An elastic body at rest, condensed exactly to the functions of its seats.

use std::borrow::Cow;
use std::ops::Range;
use std::time::Instant;

use fem::Material;
use mesh::{Coverage, CylinderPart, Mesh, Origin};
use rayon::prelude::*;
use solver::{LinearSolver, SolverError, SparseCholesky, Symbolic, angular_dissection, expand};
use sprs::CsMat;

use crate::apparent::Apparent;
use crate::carried::Carried;
use crate::definite::require_positive_mass;
use crate::error::{SurroundingError, direction, mesh_advice};
use crate::joint::{BodySeat, SeatJoint, joint, refuse_fixed};
use crate::loads::UnitLoads;
use crate::matrix::MatrixBody;
use crate::seat::SeatFunctions;

/// Columns that are solved for together: a factor is read once for them. Fixed, so that threads change no bit.
const BLOCK: usize = 16;

/// Distance from the cylinder of a seat within which a node is on it, over its radius.
const ON_SEAT: f64 = 1e-4;

/// A held elastic body, factored.
pub struct Surrounding {
    /// Its name.
    pub name: String,
    /// Mesh and material; None for a body from matrices.
    pub mesh: Option<(Mesh, Material)>,
    /// What is added to its z for the coordinates of the ring of its first seat, m.
    pub shift: f64,
    /// Its seats.
    pub seats: Vec<SeatFunctions>,
    /// Whether the ring of each seat stands turned by 180 deg about x.
    pub(crate) turned: Vec<bool>,
    /// Middles of the seats along the body's z, m.
    pub middles: Vec<f64>,
    /// F over the functions of all seats, m/N, `[n][n]` flat, symmetric.
    pub flexibility: Vec<f64>,
    /// Dofs.
    pub n_dofs: usize,
    /// Bytes of the factor, the functionals and the flexibility.
    pub bytes: usize,
    /// Seats of a mesh that lack facets, and what they have of their cylinder between their ends.
    pub gaps: Vec<(String, Coverage)>,
    /// What its numbers would mean, of a body of matrices.
    pub apparent: Option<Apparent>,
    /// How a shaft carries it; None of a body that stands.
    pub carried: Option<Carried>,
    /// What loads on all of it do, where a scene asks for any.
    pub loads: Option<UnitLoads>,
    /// Bytes of K.
    pub(crate) matrix_bytes: usize,
    /// Wall time of assembly, factor and columns, s.
    pub seconds: f64,
    pub(crate) free: Vec<usize>,
    pub(crate) factor: SparseCholesky,
    /// Of a body from matrices that have a mass, K and M of the free dofs.
    matrices: Option<[CsMat<f64>; 2]>,
}

/// What is common to meshes and matrices.
struct Unfactored<'a> {
    name: String,
    stiffness: &'a CsMat<f64>,
    places: &'a [[f64; 3]],
    tags: &'a [u64],
    /// Which threes of rows are rotations; empty: none.
    is_rotation: &'a [bool],
    fixed: Vec<bool>,
    /// Elements, for the order of elimination.
    cliques: &'a [usize],
    clique: usize,
}

impl Surrounding {
    /// A body of a mesh, held at the facet groups `fixed`.
    pub fn of_mesh(
        name: &str,
        (mesh, origin): (Mesh, &Origin),
        material: Material,
        fixed: &[String],
        seats: &[BodySeat],
    ) -> Result<Surrounding, SurroundingError> {
        let start = Instant::now();
        for group in fixed {
            require_group(name, &mesh, group, "`fixed`")?;
        }
        let mut is_fixed = vec![false; mesh.n_nodes()];
        for node in fixed.iter().flat_map(|group| mesh.group_nodes(group)) {
            is_fixed[node] = true;
        }
        let mut joints = Vec::new();
        for seat in seats {
            require_group(name, &mesh, &seat.name, "the `group` of its seat")?;
            let areas = fem::facet_node_weights(&mesh, mesh.group(&seat.name));
            joints.push(joint(name, seat, &areas, &mesh.nodes, &origin.node_tags)?);
            refuse_fixed(name, seat, &areas, &is_fixed, &origin.node_tags)?;
        }
        let fem = |source| SurroundingError::Fem {
            body: name.to_string(),
            source,
        };
        let stiffness = fem::assemble_stiffness(&mesh, &material).map_err(fem)?;
        let held = Unfactored {
            name: name.to_string(),
            stiffness: &stiffness,
            places: &mesh.nodes,
            tags: &origin.node_tags,
            is_rotation: &[],
            fixed: is_fixed,
            cliques: &mesh.connectivity,
            clique: mesh.kind.n_nodes(),
        };
        let mut body = held.condense(joints, start)?;
        body.gaps = seats.iter().filter_map(|seat| gap(&mesh, &seat.name)).collect();
        body.mesh = Some((mesh, material));
        Ok(body)
    }

    /// A body of the matrices of another program; `seats` as its files name them.
    pub fn of_matrix(
        name: &str,
        matrix: &MatrixBody,
        seats: &[BodySeat],
    ) -> Result<Surrounding, SurroundingError> {
        assert_eq!(seats.len(), matrix.n_seats(), "a seat for each file of nodes");
        Surrounding::of_nodes(name, matrix, seats).map_err(SurroundingError::of_matrices)
    }

    fn of_nodes(
        name: &str,
        matrix: &MatrixBody,
        seats: &[BodySeat],
    ) -> Result<Surrounding, SurroundingError> {
        let start = Instant::now();
        let joint = |seat| matrix.joint(name, seat);
        let joints = seats.iter().enumerate().map(joint).collect::<Result<_, _>>()?;
        matrix.require_free(name)?;
        let pairs = matrix.neighbours();
        let held = Unfactored {
            name: name.to_string(),
            stiffness: &matrix.stiffness,
            places: &matrix.places,
            tags: &matrix.tags,
            is_rotation: &matrix.is_rotation,
            fixed: matrix.fixed.clone(),
            cliques: &pairs,
            clique: 2,
        };
        let mut body = held.condense(joints, start)?;
        body.apparent = matrix.apparent();
        let free = |of: &CsMat<f64>| solver::restrict(of, &body.free);
        if let Some(mass) = &matrix.mass {
            require_positive_mass(matrix, (name, mass), (&body.free, &pairs))?;
            body.matrices = Some([free(&matrix.stiffness), free(mass)]);
        }
        Ok(body)
    }

    /// Whether it has a mass: one from matrices may come without.
    pub fn has_mass(&self) -> bool {
        self.mesh.is_some() || self.matrices.is_some()
    }

    /// K and M of the free dofs; None of a body without a mass.
    pub(crate) fn matrices(&self) -> Result<Option<Cow<'_, [CsMat<f64>; 2]>>, SurroundingError> {
        let Some((mesh, material)) = &self.mesh else {
            return Ok(self.matrices.as_ref().map(Cow::Borrowed));
        };
        let fem = |source| SurroundingError::Fem {
            body: self.name.clone(),
            source,
        };
        // The matrix of all dofs goes before the next one is made.
        let free = |of: CsMat<f64>| solver::restrict(&of, &self.free);
        let stiffness = free(fem::assemble_stiffness(mesh, material).map_err(fem)?);
        let mass = free(fem::assemble_mass(mesh, material).map_err(fem)?);
        Ok(Some(Cow::Owned([stiffness, mass])))
    }

    /// Bytes of K and M of the free dofs that a body of matrices keeps.
    pub(crate) fn own_matrix_bytes(&self) -> usize {
        let entries = self.matrices.iter().flatten().map(CsMat::nnz).sum::<usize>();
        entries * (size_of::<f64>() + size_of::<usize>())
    }

    /// Number of functions of all seats.
    pub fn n_functions(&self) -> usize {
        self.seats.iter().map(SeatFunctions::n).sum()
    }

    /// Numbers of the functions of a seat among those of all seats.
    pub fn functions_of(&self, seat: usize) -> Range<usize> {
        let first = self.seats[..seat].iter().map(SeatFunctions::n).sum();
        first..first + self.seats[seat].n()
    }

    /// Displacement under the forces lam on its seats, N, `[n_functions]`: m, `[n_nodes][3]` flat.
    pub fn displacement(&self, lam: &[f64]) -> Vec<f64> {
        let mut moved = self.seat_loads(lam);
        self.factor.solve(&mut moved, 1);
        self.on_all_dofs(&moved)
    }
}

impl Unfactored<'_> {
    /// Factors the stiffness and finds the flexibility.
    fn condense(self, joints: Vec<SeatJoint>, start: Instant) -> Result<Surrounding, SurroundingError> {
        self.require_spanning()?;
        let free: Vec<usize> = (0..3 * self.places.len())
            .filter(|dof| !self.fixed[dof / 3])
            .collect();
        let lower = solver::restrict_lower(self.stiffness, &free);
        let nodes = angular_dissection(self.places, self.cliques, self.clique);
        let order = solver::restrict_order(&expand(&nodes, 3), &free);
        let failed = |source| self.failed(source, &free);
        let symbolic = Symbolic::new(&lower, &order).map_err(failed)?;
        let factor = symbolic.factor(&lower).map_err(failed)?;
        let shift = joints.first().map_or(0.0, |joint| joint.shift);
        let turned = joints.iter().map(|joint| joint.is_turned).collect();
        let middles = joints.iter().map(|joint| joint.middle).collect();
        let seats: Vec<SeatFunctions> = joints.into_iter().map(|joint| joint.functions).collect();
        let functional_bytes: usize = seats.iter().map(SeatFunctions::bytes).sum();
        let n_functions: usize = seats.iter().map(SeatFunctions::n).sum();
        let flexibility_bytes = n_functions * n_functions * size_of::<f64>();
        let mut body = Surrounding {
            name: self.name,
            mesh: None,
            gaps: Vec::new(),
            apparent: None,
            carried: None,
            loads: None,
            shift,
            flexibility: Vec::new(),
            n_dofs: 3 * self.places.len(),
            bytes: factor.factor_bytes() + functional_bytes + flexibility_bytes,
            matrix_bytes: self.stiffness.nnz() * (size_of::<f64>() + size_of::<usize>()),
            seconds: 0.0,
            seats,
            middles,
            turned,
            free,
            factor,
            matrices: None,
        };
        body.flexibility = body.flexibility_of_seats();
        body.seconds = start.elapsed().as_secs_f64();
        Ok(body)
    }

    /// Fixed nodes must span a plane, or the body can turn.
    fn require_spanning(&self) -> Result<(), SurroundingError> {
        let fixed: Vec<[f64; 3]> = (0..self.places.len())
            .filter(|&node| self.fixed[node])
            .map(|node| self.places[node])
            .collect();
        // Without its rotation a node holds all of the body.
        if self
            .is_rotation
            .iter()
            .zip(&self.fixed)
            .any(|(r, fixed)| *r && *fixed)
        {
            return Ok(());
        }
        let Some(first) = fixed.first() else {
            // A matrix may hold its supports itself; if not, its factor says so.
            return Ok(());
        };
        let arm = |x: &[f64; 3]| [0, 1, 2].map(|c| x[c] - first[c]);
        let size = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let far = fixed.iter().map(arm).max_by(|a, b| size(*a).total_cmp(&size(*b)));
        let far = far.unwrap_or_default();
        let across = |x: &[f64; 3]| {
            let a = arm(x);
            size([0, 1, 2].map(|c| a[(c + 1) % 3] * far[(c + 2) % 3] - a[(c + 2) % 3] * far[(c + 1) % 3]))
        };
        let widest = fixed.iter().map(across).fold(0.0, f64::max);
        if widest > 1e-6 * size(far) * size(far) {
            return Ok(());
        }
        Err(SurroundingError::FixedOnLine {
            body: self.name.clone(),
            count: fixed.len(),
        })
    }

    /// The error of a factorisation, with the node that nothing holds.
    fn failed(&self, source: SolverError, free: &[usize]) -> SurroundingError {
        match source {
            SolverError::NotPositiveDefinite { row, .. } | SolverError::Singular { row, .. } => {
                SurroundingError::NotHeld {
                    body: self.name.clone(),
                    node: self.tags[free[row] / 3],
                    axis: direction(self.is_rotation, free[row]),
                    advice: mesh_advice::HELD,
                }
            }
            source => SurroundingError::Solver {
                body: self.name.clone(),
                source,
            },
        }
    }
}

impl Surrounding {
    /// F = Phi^T K^-1 Phi, made exactly symmetric.
    fn flexibility_of_seats(&self) -> Vec<f64> {
        let n = self.n_functions();
        let columns = |chunk: &[(usize, usize)]| -> Vec<f64> {
            let mut columns = vec![0.0; self.free.len() * chunk.len()];
            self.solve_units(chunk, &mut columns);
            let mut measured = Vec::with_capacity(n * chunk.len());
            let mut field = vec![0.0; self.n_dofs];
            for column in columns.chunks_exact(self.free.len()) {
                for (&dof, u) in self.free.iter().zip(column) {
                    field[dof] = *u;
                }
                measured.extend(self.seats.iter().flat_map(|seat| seat.measure(&field)));
            }
            measured
        };
        let chunks = self.owners();
        let mut flexibility: Vec<f64> = chunks.par_chunks(BLOCK).map(columns).collect::<Vec<_>>().concat();
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (flexibility[n * i + j] + flexibility[n * j + i]);
                (flexibility[n * i + j], flexibility[n * j + i]) = (mean, mean);
            }
        }
        flexibility
    }

    /// Seat and number there of every function.
    fn owners(&self) -> Vec<(usize, usize)> {
        let of_seat = |(seat, functions): (usize, &SeatFunctions)| (0..functions.n()).map(move |f| (seat, f));
        self.seats.iter().enumerate().flat_map(of_seat).collect()
    }

    /// K^-1 of unit forces on some functions, on free dofs, column-major into `columns`.
    fn solve_units(&self, functions: &[(usize, usize)], columns: &mut [f64]) {
        let mut field = vec![0.0; self.n_dofs];
        let loads = columns.chunks_exact_mut(self.free.len());
        for (&(seat, function), load) in functions.iter().zip(loads) {
            field.fill(0.0);
            self.seats[seat].add_unit_load(function, 1.0, &mut field);
            load.iter_mut()
                .zip(&self.free)
                .for_each(|(f, &dof)| *f = field[dof]);
        }
        self.factor.solve(columns, functions.len());
    }

    /// K^-1 Phi of all functions, on free dofs, column-major.
    pub(crate) fn seat_columns(&self) -> Vec<f64> {
        let owners = self.owners();
        let mut columns = vec![0.0; self.free.len() * owners.len()];
        columns
            .par_chunks_mut(BLOCK * self.free.len())
            .zip(owners.par_chunks(BLOCK))
            .for_each(|(columns, chunk)| self.solve_units(chunk, columns));
        columns
    }

    /// A displacement of the free dofs on all of them.
    pub(crate) fn on_all_dofs(&self, moved: &[f64]) -> Vec<f64> {
        let mut field = vec![0.0; self.n_dofs];
        for (&dof, u) in self.free.iter().zip(moved) {
            field[dof] = *u;
        }
        field
    }

    /// Phi lam, loads of forces on all functions, on free dofs.
    pub(crate) fn seat_loads(&self, lam: &[f64]) -> Vec<f64> {
        let mut load = vec![0.0; self.n_dofs];
        let mut rest = lam;
        for seat in &self.seats {
            let (own, others) = rest.split_at(seat.n());
            seat.add_load(own, &mut load);
            rest = others;
        }
        self.free.iter().map(|&dof| load[dof]).collect()
    }
}

/// What a seat has of its cylinder between its ends, where it lacks facets.
fn gap(mesh: &Mesh, group: &str) -> Option<(String, Coverage)> {
    let band = CylinderPart::of_group(mesh, group);
    let found = mesh::coverage(mesh, group, &band, ON_SEAT * band.cylinder.radius);
    found.map(|coverage| (group.to_string(), coverage))
}

fn require_group(body: &str, mesh: &Mesh, group: &str, key: &'static str) -> Result<(), SurroundingError> {
    if !mesh.group(group).is_empty() {
        return Ok(());
    }
    let known: Vec<String> = mesh.groups.keys().map(|name| format!("{name:?}")).collect();
    Err(SurroundingError::UnknownGroup {
        body: body.to_string(),
        group: group.to_string(),
        known: known.join(", "),
        key,
    })
}
