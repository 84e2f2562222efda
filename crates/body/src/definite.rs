//! What matrices of another program have to be: a stiffness that rigid motions do not strain, a positive mass.

use solver::{SolverError, Symbolic, angular_dissection, expand};
use sprs::CsMat;

use crate::error::{AXES, SurroundingError, direction};
use crate::matrix::MatrixBody;

/// Largest force by a translation over the sum of the sizes of all terms of its row: entries with seven digits.
const OF_TRANSLATION: f64 = 1e-6;
/// The same by a rotation, to which the digits of the nodes' places come.
const OF_ROTATION: f64 = 1e-5;
/// Share of its diagonal that a mass is given before it is factored: one that is zero in some motion, as of elements
/// with few integration points, has pivots of round-off.
const SEMIDEFINITE: f64 = 1e-8;

impl MatrixBody {
    /// Fails where some nodes are held although the matrix is not that of a free body: K R = 0. A matrix without such
    /// nodes holds its supports itself, and has no motion that strains nothing.
    pub(crate) fn require_free(&self, name: &str) -> Result<(), SurroundingError> {
        if !self.fixed.contains(&true) {
            return Ok(());
        }
        let n = self.places.len() as f64;
        let middle = [0, 1, 2].map(|c| self.places.iter().map(|x| x[c]).sum::<f64>() / n);
        for motion in 0..6 {
            let of_rows = |(x, &is_rotation): (&[f64; 3], &bool)| match is_rotation {
                true => rotation(motion),
                false => rigid_motion(motion, [0, 1, 2].map(|c| x[c] - middle[c])),
            };
            let rows = self.places.iter().zip(&self.is_rotation);
            let moved: Vec<f64> = rows.flat_map(of_rows).collect();
            let (dof, force, share) = self.strained_most(&moved);
            let limit = if motion < 3 { OF_TRANSLATION } else { OF_ROTATION };
            if share <= limit {
                continue;
            }
            let axis = AXES[motion % 3];
            let (motion, per) = match motion {
                0..3 => (format!("along {axis}"), "m"),
                _ => (format!("about {axis}"), "rad"),
            };
            let (node, direction) = (self.tags[dof / 3], direction(&self.is_rotation, dof));
            let unit = if self.is_rotation[dof / 3] { "N m" } else { "N" };
            return Err(SurroundingError::StrainedByMotion {
                body: name.to_string(),
                found: format!(
                    "moved as a whole {motion}, which should strain nothing, it asks for {force:.3e} {unit} at node \
                     {node} in {direction} per {per}, {share:.1e} of the entries of its row; expected at most \
                     {limit:.0e}"
                ),
            });
        }
        Ok(())
    }

    /// The dof whose force under a motion is largest over the terms of its row, the force and that share.
    fn strained_most(&self, moved: &[f64]) -> (usize, f64, f64) {
        let mut most = (0, 0.0, 0.0);
        for (dof, row) in self.stiffness.outer_iterator().enumerate() {
            let (mut force, mut size) = (0.0, 0.0);
            for (column, k) in row.iter() {
                force += k * moved[column];
                size += (k * moved[column]).abs();
            }
            let share = force.abs() / f64::max(size, f64::MIN_POSITIVE);
            if share > most.2 {
                most = (dof, force, share);
            }
        }
        most
    }
}

/// A unit translation or rotation at a place.
fn rigid_motion(motion: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
    match motion {
        0 => [1.0, 0.0, 0.0],
        1 => [0.0, 1.0, 0.0],
        2 => [0.0, 0.0, 1.0],
        3 => [0.0, -z, y],
        4 => [z, 0.0, -x],
        _ => [-y, x, 0.0],
    }
}

/// The rotation of a unit translation or rotation.
fn rotation(motion: usize) -> [f64; 3] {
    [3, 4, 5].map(|own| if own == motion { 1.0 } else { 0.0 })
}

/// Fails where the mass of the free dofs is not positive, by its Cholesky factor. `pairs` are nodes with a common
/// entry.
pub(crate) fn require_positive_mass(
    matrix: &MatrixBody,
    (name, mass): (&str, &CsMat<f64>),
    (free, pairs): (&[usize], &[usize]),
) -> Result<(), SurroundingError> {
    let mut lower = solver::restrict_lower(mass, free);
    for (row, mut vector) in lower.outer_iterator_mut().enumerate() {
        let own = vector.iter_mut().filter(|(column, _)| *column == row);
        own.for_each(|(_, m)| *m *= 1.0 + SEMIDEFINITE);
    }
    let nodes = angular_dissection(&matrix.places, pairs, 2);
    let order = solver::restrict_order(&expand(&nodes, 3), free);
    let factored = Symbolic::new(&lower, &order).and_then(|symbolic| symbolic.factor(&lower));
    match factored {
        Ok(_) => Ok(()),
        Err(SolverError::NotPositiveDefinite { row, .. } | SolverError::Singular { row, .. }) => {
            Err(SurroundingError::MassNotPositive {
                body: name.to_string(),
                node: matrix.tags[free[row] / 3],
                axis: direction(&matrix.is_rotation, free[row]),
            })
        }
        Err(source) => Err(SurroundingError::Solver {
            body: name.to_string(),
            source,
        }),
    }
}
