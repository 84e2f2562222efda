//! Rings, balls and shaft as one eigenproblem.
//!
//! Unknowns y: coordinates of the inner ring, of the outer ring, then the small dofs p (balls, shaft of a rigid
//! ring). Interactions, constraints and the masses of mean motions act on a ring through few columns a_j, so K + s M is
//! solved by the rings' factors and one dense system. With forces t of the columns and z = S^-1 b of the rings, r = z
//! - X t with X = S^-1 [a_j], C = [a_i]^T X and l = a^T r + b^T p (a = -W, the patch weights, for a contact):
//!
//! ```text
//! link        t - D l = 0            D its tangent, of a contact 2 x 2 and zero without load
//! mass m_s    t - s m_s a^T r = 0
//! constraint  a^T r = 0
//! small dofs  s m p + sum of b t = f
//! ```
//!
//! No tangent or mass is inverted, so unloaded contacts and dofs without mass are nothing special. X costs one block
//! solve per ring; after that the operator costs one solve per ring and vector.

use dense::{DenseLu, EigenProblem};

use super::columns::{Column, LinkTangent, Role, columns, reactions};
use crate::error::DynamicsError;
use ring::VibratingRing;
use ring::sparse::sparse_dot;
use ring::vectors::dot;

/// The bearing's own dofs among the small ones.
#[derive(Default)]
pub(super) struct BearingDofs {
    /// Number of balls: the first small dofs, [radial, axial] each.
    pub n_balls: usize,
    /// Shaft dof and place among the small dofs, of a rigid inner ring.
    pub shaft: Vec<(usize, usize)>,
    /// Place of the seat of a rigid outer ring that slides.
    pub seat: Option<usize>,
    /// Radius at which tilts count as displacements, m.
    pub tilt_arm: f64,
}

/// The eigenproblem of rings, balls and shaft.
pub struct VibratingBearing {
    pub(super) rings: [Option<VibratingRing>; 2],
    /// Masses of the small dofs, kg.
    small_mass: Vec<f64>,
    link_tangents: Vec<LinkTangent>,
    columns: Vec<Column>,
    /// S^-1 of the columns of each ring, column-major, and their numbers.
    answers: [Answer; 2],
    /// Unit of the forces t, N per m.
    force_unit: f64,
    dense: Option<DenseLu>,
    /// Orthonormal directions of the constraint forces of each ring.
    reactions: [Vec<Vec<f64>>; 2],
    shift: f64,
    pub(super) dofs: BearingDofs,
}

/// X of one ring.
#[derive(Default)]
struct Answer {
    numbers: Vec<usize>,
    columns: Vec<f64>,
}

impl VibratingBearing {
    /// A system of rings, small dofs of given masses and what couples them.
    pub fn new(
        rings: [Option<VibratingRing>; 2],
        small_mass: Vec<f64>,
        link_tangents: Vec<LinkTangent>,
        shift: f64,
    ) -> Result<VibratingBearing, DynamicsError> {
        let columns = columns(&rings, &link_tangents);
        let entries = link_tangents.iter().flat_map(|c| &c.tangent);
        let largest = entries.fold(0.0f64, |m, x| m.max(x.abs()));
        let mut system = VibratingBearing {
            reactions: [0, 1].map(|i| reactions(&rings, &columns, i)),
            rings,
            small_mass,
            link_tangents,
            columns,
            answers: Default::default(),
            force_unit: if largest > 0.0 { largest } else { 1.0 },
            dense: None,
            shift,
            dofs: BearingDofs::default(),
        };
        let (inner, outer) = rayon::join(|| system.answer(0), || system.answer(1));
        system.answers = [inner, outer];
        let n = system.columns.len() + system.small_mass.len();
        if n > 0 {
            let dense = DenseLu::factor(n, &system.matrix());
            system.dense = Some(dense.map_err(|source| DynamicsError::Modes { source })?);
        }
        Ok(system)
    }

    /// Says which small dofs are balls and shaft.
    pub(super) fn set_bearing(&mut self, dofs: BearingDofs) {
        self.dofs = dofs;
    }

    /// First unknowns of the rings, of the small dofs, and their number.
    pub(super) fn starts(&self) -> [usize; 4] {
        let [inner, outer] = [0, 1].map(|i| self.rings[i].as_ref().map_or(0, VibratingRing::n));
        [0, inner, inner + outer, inner + outer + self.small_mass.len()]
    }

    /// Part of a ring or, for 2, of the small dofs.
    pub(super) fn part<'y>(&self, y: &'y [f64], i: usize) -> &'y [f64] {
        let starts = self.starts();
        &y[starts[i]..starts[i + 1]]
    }

    /// Kinetic energy, over omega^2/2: inner ring, outer ring, balls, shaft.
    pub(super) fn kinetic(&self, y: &[f64]) -> [f64; 4] {
        let mut parts = [0.0; 4];
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(ring) = ring {
                let y = self.part(y, i);
                parts[i] = dot(y, &ring.mass(y, 1));
                for (load, mass) in &ring.lumps {
                    // The shaft carries the inner ring; what slides with the outer one counts as that ring.
                    parts[if i == 0 { 3 } else { 1 }] += mass * sparse_dot(load, y).powi(2);
                }
            }
        }
        let small = self.part(y, 2).iter().zip(&self.small_mass);
        for (k, (x, mass)) in small.enumerate() {
            let owner = match k {
                _ if k < 2 * self.dofs.n_balls => 2,
                _ if Some(k) == self.dofs.seat => 1,
                _ => 3,
            };
            parts[owner] += mass * x * x;
        }
        parts
    }

    /// S^-1 of the columns of one ring.
    fn answer(&self, i: usize) -> Answer {
        let Some(ring) = &self.rings[i] else {
            return Answer::default();
        };
        let of_ring = |column: &Column| column.ring.as_ref().is_some_and(|r| r.0 == i);
        let numbers: Vec<usize> = (0..self.columns.len())
            .filter(|&j| of_ring(&self.columns[j]))
            .collect();
        let mut columns = vec![0.0; ring.n() * numbers.len()];
        for (column, &j) in columns.chunks_exact_mut(ring.n()).zip(&numbers) {
            if let Some((_, load)) = &self.columns[j].ring {
                load.iter().for_each(|&(k, value)| column[k] += value);
            }
        }
        ring.solve(&mut columns, numbers.len());
        Answer { numbers, columns }
    }

    /// Motion a^T r of the column `j` in a field of its ring.
    fn motion(&self, j: usize, field: &[f64]) -> f64 {
        let ring = self.columns[j].ring.as_ref();
        ring.map_or(0.0, |(_, load)| sparse_dot(load, field))
    }

    /// The dense matrix over (t in units of force, p), row-major.
    fn matrix(&self) -> Vec<f64> {
        let (n_columns, n_small) = (self.columns.len(), self.small_mass.len());
        let n = n_columns + n_small;
        // Motion of every column under every force, and under every small dof.
        let mut motion = vec![0.0; n_columns * n];
        for (i, answer) in self.answers.iter().enumerate() {
            let Some(ring) = &self.rings[i] else { continue };
            for (&k, x) in answer.numbers.iter().zip(answer.columns.chunks_exact(ring.n())) {
                for &j in &answer.numbers {
                    motion[n * j + k] = -self.force_unit * self.motion(j, x);
                }
            }
        }
        for (j, column) in self.columns.iter().enumerate() {
            for &(k, value) in &column.small {
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
            for &(k, value) in &self.columns[j].small {
                matrix[n * (n_columns + k) + j] += value * self.force_unit;
            }
        }
        for (k, mass) in self.small_mass.iter().enumerate() {
            matrix[(n + 1) * (n_columns + k)] += self.shift * mass;
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

    /// Adds coefficient(column) times its own motion to the forces: K of contacts, M of carried masses.
    fn add_columns(&self, y: &[f64], result: &mut [f64], force: impl Fn(usize, &[f64]) -> f64) {
        if self.columns.is_empty() {
            return;
        }
        let starts = self.starts();
        let lengths: Vec<f64> = (0..self.columns.len())
            .map(|j| {
                let column = &self.columns[j];
                let ring = column.ring.as_ref();
                ring.map_or(0.0, |(i, load)| sparse_dot(load, self.part(y, *i)))
                    + sparse_dot(&column.small, self.part(y, 2))
            })
            .collect();
        for (j, column) in self.columns.iter().enumerate() {
            let force = force(j, &lengths);
            if let Some((i, load)) = &column.ring {
                load.iter()
                    .for_each(|&(k, value)| result[starts[*i] + k] += value * force);
            }
            let small = column.small.iter();
            small.for_each(|&(k, value)| result[starts[2] + k] += value * force);
        }
    }

    /// Bearing of a ring of a block of vectors, column-major.
    fn parts(&self, x: &[f64], i: usize) -> Vec<f64> {
        let columns = x.chunks_exact(self.n());
        columns.flat_map(|y| self.part(y, i).iter().copied()).collect()
    }

    /// Products of the rings' own matrices with a block; `small` gives the factor of each small dof.
    fn ring_products(
        &self,
        x: &[f64],
        product: impl Fn(&VibratingRing, Vec<f64>) -> Vec<f64> + Sync,
        small: impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let starts = self.starts();
        let of_ring = |i: usize| Some(product(self.rings[i].as_ref()?, self.parts(x, i)));
        let (inner, outer) = rayon::join(|| of_ring(0), || of_ring(1));
        let mut result = x.to_vec();
        for (i, part) in [inner, outer].iter().enumerate() {
            self.put(&mut result, i, part.as_deref());
        }
        for y in result.chunks_exact_mut(self.n()) {
            let dofs = y[starts[2]..].iter_mut().enumerate();
            dofs.for_each(|(k, x)| *x *= small(k));
        }
        result
    }

    /// Replaces the part of a ring in a block.
    fn put(&self, x: &mut [f64], i: usize, part: Option<&[f64]>) {
        let (Some(part), starts) = (part, self.starts()) else {
            return;
        };
        let columns = x.chunks_exact_mut(self.n());
        for (y, new) in columns.zip(part.chunks_exact(starts[i + 1] - starts[i])) {
            y[starts[i]..starts[i + 1]].copy_from_slice(new);
        }
    }

    /// Corrects the rings' answers z of one vector for what couples them.
    fn couple(&self, y: &mut [f64]) {
        let Some(dense) = &self.dense else { return };
        let starts = self.starts();
        let n_columns = self.columns.len();
        let mut rhs = vec![0.0; n_columns + self.small_mass.len()];
        let motion = |(j, column): (usize, &Column)| {
            let ring = column.ring.as_ref();
            ring.map_or(0.0, |(i, _)| self.motion(j, &y[starts[*i]..starts[*i + 1]]))
        };
        let motions: Vec<f64> = self.columns.iter().enumerate().map(motion).collect();
        for j in 0..n_columns {
            rhs[j] = self.law(j).1.iter().map(|&(k, share)| share * motions[k]).sum();
        }
        rhs[n_columns..].copy_from_slice(&y[starts[2]..]);
        dense.solve(&mut rhs, 1);
        for (i, answer) in self.answers.iter().enumerate() {
            let part = &mut y[starts[i]..starts[i + 1]];
            if part.is_empty() {
                continue;
            }
            for (&j, x) in answer.numbers.iter().zip(answer.columns.chunks_exact(part.len())) {
                let force = self.force_unit * rhs[j];
                part.iter_mut().zip(x).for_each(|(y, x)| *y -= force * x);
            }
        }
        y[starts[2]..].copy_from_slice(&rhs[n_columns..]);
    }
}

impl EigenProblem for VibratingBearing {
    fn n(&self) -> usize {
        self.starts()[3]
    }

    fn shift(&self) -> f64 {
        self.shift
    }

    fn stiffness(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        let mut result = self.ring_products(x, |ring, y| ring.stiffness(&y, n_vectors), |_| 0.0);
        for (y, result) in x.chunks_exact(self.n()).zip(result.chunks_exact_mut(self.n())) {
            self.add_columns(y, result, |j, lengths| match self.columns[j].role {
                Role::Link(..) => self.law(j).1.iter().map(|&(k, share)| share * lengths[k]).sum(),
                Role::Mass(_) | Role::Constraint => 0.0,
            });
        }
        result
    }

    fn mass(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        let mut result = self.ring_products(x, |ring, y| ring.mass(&y, n_vectors), |k| self.small_mass[k]);
        for (y, result) in x.chunks_exact(self.n()).zip(result.chunks_exact_mut(self.n())) {
            self.add_columns(y, result, |j, lengths| match self.columns[j].role {
                Role::Mass(mass) => mass * lengths[j],
                Role::Link(..) | Role::Constraint => 0.0,
            });
        }
        result
    }

    fn solve(&self, mut b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        let solved = |i: usize| {
            let ring = self.rings[i].as_ref()?;
            let mut part = self.parts(&b, i);
            ring.solve(&mut part, n_vectors);
            Some(part)
        };
        let (inner, outer) = rayon::join(|| solved(0), || solved(1));
        for (i, part) in [inner, outer].iter().enumerate() {
            self.put(&mut b, i, part.as_deref());
        }
        b.chunks_exact_mut(self.n()).for_each(|y| self.couple(y));
        b
    }

    fn remove_reactions(&self, force: &mut [f64]) {
        let starts = self.starts();
        for (i, directions) in self.reactions.iter().enumerate() {
            let part = &mut force[starts[i]..starts[i + 1]];
            self.rings[i].iter().for_each(|ring| ring.remove_reactions(part));
            for direction in directions {
                let size = dot(part, direction);
                part.iter_mut().zip(direction).for_each(|(f, d)| *f -= size * d);
            }
        }
    }
}
