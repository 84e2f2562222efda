//! A periodic ring's matrix with a border, applied in harmonic space, and what else a state in harmonic space needs:
//! no transform.
//!
//! Vectors hold the harmonics and then the rows of the border, `[harmonic_len() + m]`. The border is that of
//! [`super::border`]: rigid motions, which are harmonics 0 and 1, so that it touches the first group alone. *Low*
//! vectors hold that group and the border, `[low_len() + m]`.

use pulp::Arch;

use super::factor::Symmetry;
use super::matrix::CyclicMatrix;
use super::mirrored::{Mirrored, MirroredProduct};
use super::phases::{LANES, NODE_LEN};
use super::ring::CyclicRing;
use crate::error::SolverError;

/// `[A B; B^T D]` with a cyclic A.
#[derive(Clone, Debug)]
pub struct HarmonicOperator {
    ring: CyclicRing,
    matrix: CyclicMatrix,
    /// The matrix when its sections are their own mirror images.
    mirrored: Option<Mirrored>,
    /// B and D, m low vectors.
    border: Vec<Vec<f64>>,
}

impl HarmonicOperator {
    /// Borders `matrix`, of the couplings of `ring`, with B, nodal, column-major `[n][m]`, of which the first group
    /// of harmonics counts, and D, row-major `[m][m]`.
    ///
    /// # Panics
    /// When the sizes disagree.
    pub fn new(
        ring: &CyclicRing,
        matrix: &CyclicMatrix,
        border: &[f64],
        corner: &[f64],
    ) -> Result<HarmonicOperator, SolverError> {
        matrix.check_pattern(&ring.shared.pattern)?;
        let m = corner.len().isqrt();
        assert_eq!(border.len(), ring.n() * m, "a border of {m} columns");
        let low = |k: usize| {
            let column = &border[ring.n() * k..ring.n() * (k + 1)];
            ring.to_low(column, &corner[m * k..m * (k + 1)])
        };
        Ok(HarmonicOperator {
            border: (0..m).map(low).collect(),
            ring: ring.clone(),
            mirrored: match ring.symmetry(matrix) {
                Symmetry::Mirrored => Some(Mirrored::new(&ring.shared, matrix)),
                Symmetry::None => None,
            },
            matrix: matrix.clone(),
        })
    }

    /// The ring.
    pub fn ring(&self) -> &CyclicRing {
        &self.ring
    }

    /// Overwrites one group's part of a product, `[low_len()]`, of the first group with the border, a low vector:
    /// what a pass over the groups does while they are in the cache.
    ///
    /// # Panics
    /// When a length is another.
    pub fn group_product(&self, group: usize, x: &[f64], y: &mut [f64]) {
        let low = self.ring.low_len();
        let m = if group == 0 { self.border.len() } else { 0 };
        assert_eq!(x.len(), low + m, "one group of harmonics");
        assert_eq!(y.len(), low + m, "one group of harmonics");
        let ((x, q), (y, rows)) = (x.split_at(low), y.split_at_mut(low));
        self.harmonics_product(group, x, y);
        rows.fill(0.0);
        for (k, (q, column)) in q.iter().zip(&self.border).enumerate() {
            let (harmonics, corner) = column.split_at(low);
            y.iter_mut().zip(harmonics).for_each(|(y, b)| *y += q * b);
            rows.iter_mut().zip(corner).for_each(|(y, d)| *y += q * d);
            rows[k] += self.ring.group_dot(0, harmonics, x);
        }
    }

    fn harmonics_product(&self, group: usize, x: &[f64], y: &mut [f64]) {
        match &self.mirrored {
            Some(matrix) => Arch::new().dispatch(MirroredProduct {
                shared: &self.ring.shared,
                matrix,
                group,
                x,
                y,
            }),
            None => self.ring.apply_group(&self.matrix, group, x, y),
        }
    }

    /// Bytes of blocks and border.
    pub fn bytes(&self) -> usize {
        let border: usize = self.border.iter().map(Vec::capacity).sum();
        let mirrored = self.mirrored.as_ref().map_or(0, Mirrored::bytes);
        size_of::<f64>() * (9 * self.matrix.n_couplings() + border) + mirrored
    }
}

impl CyclicRing {
    /// Length of the first group's part of a vector in harmonic space.
    pub fn low_len(&self) -> usize {
        self.group_len()
    }

    /// The low vector of the nodal vector `nodal` (Cartesian, `[n]`), which is of harmonics 0 and 1, and of the
    /// border's rows `border`.
    ///
    /// # Panics
    /// When the length is another.
    pub fn to_low(&self, nodal: &[f64], border: &[f64]) -> Vec<f64> {
        let mut harmonic = vec![0.0; self.whole_len()];
        self.alone().to_harmonic(nodal, &mut harmonic);
        harmonic.truncate(self.low_len());
        harmonic.extend_from_slice(border);
        harmonic
    }
}

/// The field at a section node in harmonic space with the radial and azimuthal components of x, and those of z turned
/// by a right angle about the axis, e_z x z.
pub fn turned(x: &[f64; NODE_LEN], z: &[f64; NODE_LEN]) -> [f64; NODE_LEN] {
    let mut y = [0.0; NODE_LEN];
    for lane in 0..LANES {
        let [r, i, s, j] = [0, 1, 2, 3].map(|part| part * LANES + lane);
        // The azimuthal component is divided by i, so turning, (-u_t, u_r), is -i times the other one.
        y[r] = x[r] + z[j];
        y[i] = x[i] - z[s];
        y[s] = x[s] + z[i];
        y[j] = x[j] - z[r];
    }
    y
}
