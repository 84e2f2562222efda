//! Rings, balls and shaft as one eigenproblem.
//!
//! Unknowns y: coordinates of the rings, then the small dofs p (balls, shaft of a rigid ring or of several bearings),
//! with matrices m and k of their own. Rings that are tied to one body are a group with it. Interactions, constraints
//! and the masses of mean motions act on a ring through few columns a_j, so K + s M is solved by the rings' factors and
//! one dense system. With forces t of the columns and z = S^-1 b of the rings, r = z - X t with X = S^-1 [a_j],
//! C = [a_i]^T X and l = a^T r + b^T p (a = -W, the patch weights, for a contact):
//!
//! ```text
//! link        t - D l = 0            D its tangent, of a contact 2 x 2 and zero without load
//! mass m_s    t - s m_s a^T r = 0
//! constraint  a^T r = 0
//! small dofs  (k + s m) p + sum of b t = f
//! ```
//!
//! No tangent or mass is inverted, so unloaded contacts and dofs without mass are nothing special. X costs one block
//! solve per ring; after that the operator costs one solve per ring and vector.

use dense::{DenseLu, EigenProblem};
use rayon::prelude::*;

use super::blocks::{Answer, of_each_group, together};
use super::columns::{Column, LengthGrowth, LinkTangent, Role, columns};
use super::small::{SmallDofs, SmallEntries};
use super::symmetric::make_symmetric;
use crate::error::DynamicsError;
use ring::VibratingRings;
use ring::sparse::{SparseLoad, sparse_dot};
use ring::vectors::{dot, rows_of};

/// The eigenproblem of rings, balls and shaft.
pub struct VibratingSystem {
    pub(super) groups: Vec<VibratingRings>,
    pub(super) small: SmallDofs,
    link_tangents: Vec<LinkTangent>,
    columns: Vec<Column>,
    /// S^-1 of the columns of each group, column-major, and their numbers.
    answers: Vec<Answer>,
    /// Unit of the forces t, N per m.
    force_unit: f64,
    dense: Option<DenseLu>,
    /// Orthonormal directions of the constraint forces.
    reactions: Vec<Vec<f64>>,
    shift: f64,
}

impl VibratingSystem {
    /// A system of groups of rings, small dofs, what couples them, and `joints` that stay closed.
    pub fn new(
        groups: Vec<VibratingRings>,
        small: SmallDofs,
        link_tangents: Vec<LinkTangent>,
        joints: Vec<LengthGrowth>,
        shift: f64,
    ) -> Result<VibratingSystem, DynamicsError> {
        let columns = columns(&groups, &link_tangents, joints);
        let entries = link_tangents.iter().flat_map(|c| &c.tangent);
        let largest = entries.fold(0.0f64, |m, x| m.max(x.abs()));
        let mut system = VibratingSystem {
            groups,
            small,
            link_tangents,
            columns,
            answers: Vec::new(),
            force_unit: if largest > 0.0 { largest } else { 1.0 },
            dense: None,
            reactions: Vec::new(),
            shift,
        };
        system.reactions = system.directions();
        system.answers = (0..system.groups.len())
            .into_par_iter()
            .map(|i| system.answer(i))
            .collect();
        let failed = |source| DynamicsError::Modes { source };
        let answered = (&system.groups[..], &system.answers[..]);
        make_symmetric(&mut system.link_tangents, &system.columns, answered).map_err(failed)?;
        let n = system.columns.len() + system.small.n();
        if n > 0 {
            system.dense = Some(DenseLu::factor(n, &system.matrix()).map_err(failed)?);
        }
        Ok(system)
    }

    /// First unknown of a group, or for the number of groups of the small dofs.
    fn start(&self, i: usize) -> usize {
        self.groups[..i].iter().map(VibratingRings::n).sum()
    }

    /// Part of a group or, for the number of groups, of the small dofs.
    pub(super) fn part<'y>(&self, y: &'y [f64], i: usize) -> &'y [f64] {
        let n = self.groups.get(i).map_or(self.small.n(), VibratingRings::n);
        &y[self.start(i)..][..n]
    }

    /// The small dofs.
    pub(super) fn small_part<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        self.part(y, self.groups.len())
    }

    /// Orthonormal directions of the constraint forces, beside those that tie rings to bodies, by Gram-Schmidt.
    fn directions(&self) -> Vec<Vec<f64>> {
        let mut directions: Vec<Vec<f64>> = Vec::new();
        for column in &self.columns {
            let Role::Constraint = column.role else { continue };
            let mut direction = vec![0.0; self.n()];
            self.add_force(column, 1.0, &mut direction);
            for _ in 0..2 {
                self.remove_ties(&mut direction);
                for other in &directions {
                    let size = dot(&direction, other);
                    direction.iter_mut().zip(other).for_each(|(d, o)| *d -= size * o);
                }
            }
            let length = dot(&direction, &direction).sqrt();
            direction.iter_mut().for_each(|d| *d /= length);
            directions.push(direction);
        }
        directions
    }

    /// Takes the forces that tie rings to bodies out of a vector of forces.
    fn remove_ties(&self, force: &mut [f64]) {
        for (i, group) in self.groups.iter().enumerate() {
            group.remove_reactions(&mut force[self.start(i)..][..group.n()]);
        }
    }

    /// Adds the load of a force on a column.
    fn add_force(&self, column: &Column, force: f64, to: &mut [f64]) {
        let LengthGrowth { ring, small } = &column.growth;
        let of_group = ring.iter().map(|(i, load)| (self.start(*i), load));
        let small = (self.start(self.groups.len()), small);
        for (start, load) in of_group.chain([small]) {
            load.iter().for_each(|&(k, value)| to[start + k] += value * force);
        }
    }

    /// S^-1 of the columns of one group.
    fn answer(&self, i: usize) -> Answer {
        let ring = &self.groups[i];
        let columns = self.columns.iter().enumerate();
        let own = columns.filter_map(|(j, column)| match &column.growth.ring {
            Some((group, load)) if *group == i => Some((j, load)),
            _ => None,
        });
        let (numbers, loads): (Vec<usize>, Vec<&SparseLoad>) = own.unzip();
        let mut columns = vec![0.0; ring.n() * numbers.len()];
        for (column, load) in columns.chunks_exact_mut(ring.n()).zip(loads) {
            load.iter().for_each(|&(k, value)| column[k] += value);
        }
        ring.solve(&mut columns, numbers.len());
        Answer { numbers, columns }
    }

    /// The dense matrix over (t in units of force, p), row-major.
    fn matrix(&self) -> Vec<f64> {
        let (n_columns, n_small) = (self.columns.len(), self.small.n());
        let n = n_columns + n_small;
        // Motion of every column under every force, and under every small dof.
        let mut motion = vec![0.0; n_columns * n];
        for (answer, ring) in self.answers.iter().zip(&self.groups) {
            for (&k, x) in answer.numbers.iter().zip(answer.columns.chunks_exact(ring.n())) {
                for &j in &answer.numbers {
                    motion[n * j + k] = -self.force_unit * self.columns[j].growth.in_rings(|_| x);
                }
            }
        }
        for (j, column) in self.columns.iter().enumerate() {
            for &(k, value) in &column.growth.small {
                motion[n * j + n_columns + k] += value;
            }
        }
        let mut matrix = vec![0.0; n * n];
        for j in 0..n_columns {
            let (own, shares) = self.law(j);
            matrix[n * j + j] = own * self.force_unit;
            for (k, share) in shares {
                for c in 0..n {
                    matrix[n * j + c] -= share * motion[n * k + c];
                }
            }
            for &(k, value) in &self.columns[j].growth.small {
                matrix[n * (n_columns + k) + j] += value * self.force_unit;
            }
        }
        for &(i, k, mass) in &self.small.mass {
            matrix[n * (n_columns + i) + n_columns + k] += self.shift * mass;
        }
        for &(i, k, stiffness) in &self.small.stiffness {
            matrix[n * (n_columns + i) + n_columns + k] += stiffness;
        }
        matrix
    }

    /// own t_j - sum of share l_k = 0: the law of a column's force.
    fn law(&self, j: usize) -> (f64, Vec<(usize, f64)>) {
        match self.columns[j].role {
            Role::Link(c, row) => {
                let n = self.link_tangents[c].lengths.len();
                let shares = self.link_tangents[c].tangent[n * row..n * (row + 1)]
                    .iter()
                    .enumerate();
                (1.0, shares.map(|(k, share)| (j - row + k, *share)).collect())
            }
            Role::Mass(mass) => (1.0, vec![(j, self.shift * mass)]),
            Role::Constraint => (0.0, vec![(j, 1.0)]),
        }
    }

    /// A product with a matrix: of the rings, of the small dofs, and the forces of the columns by all their lengths: K
    /// of contacts, M of carried masses.
    fn product(
        &self,
        (x, n_vectors): (&[f64], usize),
        of_rings: fn(&VibratingRings, &[f64], usize) -> Vec<f64>,
        of_small: &SmallEntries,
        force: impl Fn(usize, &[f64]) -> f64,
    ) -> Vec<f64> {
        let (n, start) = (self.n(), self.start(self.groups.len()));
        let parts = of_each_group(&self.groups, (x, n), |group, y| of_rings(group, &y, n_vectors));
        let mut result = together(&self.groups, &parts, [n, n_vectors]);
        for (y, result) in x.chunks_exact(n).zip(result.chunks_exact_mut(n)) {
            let small = &y[start..];
            SmallDofs::add_product(of_small, small, &mut result[start..]);
            let of_column = |column: &Column| {
                column.growth.in_rings(|i| self.part(y, i)) + sparse_dot(&column.growth.small, small)
            };
            let lengths: Vec<f64> = self.columns.iter().map(of_column).collect();
            for (j, column) in self.columns.iter().enumerate() {
                self.add_force(column, force(j, &lengths), result);
            }
        }
        result
    }

    /// Corrects the groups' answers for what couples them; of `small`, the loads on the small dofs, column-major, the
    /// answers are returned.
    fn couple(&self, parts: &mut [Vec<f64>], small: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        let Some(dense) = &self.dense else { return small };
        let (n_columns, n_small) = (self.columns.len(), self.small.n());
        let n = n_columns + n_small;
        let mut unknowns = vec![0.0; n * n_vectors];
        for (vector, rhs) in unknowns.chunks_exact_mut(n).enumerate() {
            let field = |i: usize| &parts[i][self.groups[i].n() * vector..];
            let motions: Vec<f64> = self.columns.iter().map(|c| c.growth.in_rings(field)).collect();
            for j in 0..n_columns {
                rhs[j] = self.law(j).1.iter().map(|&(k, share)| share * motions[k]).sum();
            }
            rhs[n_columns..].copy_from_slice(&small[n_small * vector..n_small * (vector + 1)]);
        }
        dense.solve(&mut unknowns, n_vectors);
        let answers = parts.par_iter_mut().zip(&self.answers);
        answers.for_each(|(part, answer)| answer.subtract((&unknowns, n), self.force_unit, part));
        rows_of(&unknowns, n, &(n_columns..n))
    }
}

impl EigenProblem for VibratingSystem {
    fn n(&self) -> usize {
        self.start(self.groups.len()) + self.small.n()
    }

    fn shift(&self) -> f64 {
        self.shift
    }

    fn stiffness(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        let (rings, small) = (VibratingRings::stiffness, &self.small.stiffness);
        self.product((x, n_vectors), rings, small, |j, lengths| {
            match self.columns[j].role {
                Role::Link(..) => self.law(j).1.iter().map(|&(k, share)| share * lengths[k]).sum(),
                Role::Mass(_) | Role::Constraint => 0.0,
            }
        })
    }

    fn mass(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        let (rings, small) = (VibratingRings::mass, &self.small.mass);
        self.product((x, n_vectors), rings, small, |j, lengths| {
            match self.columns[j].role {
                Role::Mass(mass) => mass * lengths[j],
                Role::Link(..) | Role::Constraint => 0.0,
            }
        })
    }

    fn solve(&self, b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        let (n, start) = (self.n(), self.start(self.groups.len()));
        let mut parts = of_each_group(&self.groups, (&b, n), |group, mut loads| {
            group.solve(&mut loads, n_vectors);
            loads
        });
        let small = rows_of(&b, n, &(start..n));
        drop(b);
        let small = self.couple(&mut parts, small, n_vectors);
        let mut x = together(&self.groups, &parts, [n, n_vectors]);
        let columns = x.chunks_exact_mut(n).zip(small.chunks_exact((n - start).max(1)));
        columns.for_each(|(y, small)| y[start..].copy_from_slice(small));
        x
    }

    fn remove_reactions(&self, force: &mut [f64]) {
        self.remove_ties(force);
        for direction in &self.reactions {
            let size = dot(force, direction);
            force.iter_mut().zip(direction).for_each(|(f, d)| *f -= size * d);
        }
    }
}
