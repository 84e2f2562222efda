//! Rigid motions of a periodic ring in harmonic space, which its strain energy leaves out.
//!
//! Displacements are total, so a ring that its shaft has moved by d has w = R d + e with a small e. K R = 0, but w K w
//! / 2 has a round-off of some 1e-16 k d^2, k a stiffness between neighbouring nodes. Under loads of some newtons that
//! is more of the energy than the ledger tolerates. (w - R q) K w / 2 is the same energy for every q; with the q that
//! brings w - R q down to the size of e its round-off is smaller by e / d. Rigid motions have harmonics 0 and 1 only,
//! which the first group has.

use solver::CyclicRing;
use solver::cyclic::HarmonicOperator;

use super::space_defect::SpaceDefect;
use crate::coordinates::RIGID_MOTIONS;
use crate::matrices::{Matrix, Nodes};
use crate::vectors::dot;

/// Orthonormal rigid motions that strain nothing.
pub(super) struct RigidMotions {
    /// The first group with the border.
    low: Vec<Vec<f64>>,
    /// K R, which is round-off, but the same in every step: the motion obeys it, and so the energy has it, R q K w / 2.
    residue: Vec<Vec<f64>>,
    /// Their values on the rows of a defect, and the defect's part of K R.
    on_defect: Vec<[Vec<f64>; 2]>,
}

impl RigidMotions {
    /// Those of the ring with all rows of the regular one, as its `nodes` are held.
    pub fn new(
        ring: &CyclicRing,
        nodes: Nodes<'_>,
        stiffness: &HarmonicOperator,
        defect: Option<&SpaceDefect>,
    ) -> RigidMotions {
        let coordinates = nodes.coordinates;
        let (shaft, _) = coordinates.shaft();
        let mut low: Vec<Vec<f64>> = Vec::new();
        for motion in coordinates.rigid_motions() {
            let mut q = [0.0; RIGID_MOTIONS];
            q[motion] = 1.0;
            let at = |&dof: &usize| coordinates.whole_rigid_motion(nodes.positions[dof / 3], q)[dof % 3];
            let free: Vec<f64> = coordinates.free().iter().map(at).collect();
            let border: Vec<f64> = shaft.iter().map(|&dof| q[dof]).collect();
            let mut next = ring.to_low(&free, &border);
            // Twice: tilts and translations of a ring far from its origin are nearly parallel.
            for _ in 0..2 {
                low.iter().for_each(|known| take_out(ring, known, &mut next));
            }
            let size = low_dot(ring, &next, &next).sqrt();
            next.iter_mut().for_each(|x| *x /= size);
            low.push(next);
        }
        let (low_len, len) = (ring.low_len(), ring.harmonic_len());
        let on_rows = |defect: &SpaceDefect| {
            let whole = |low: &Vec<f64>| {
                let mut whole = vec![0.0; len + shaft.len()];
                if ring.has_first_group() {
                    whole[..low_len].copy_from_slice(&low[..low_len]);
                }
                whole[len..].copy_from_slice(&low[low_len..]);
                whole
            };
            let rows = |low: &Vec<f64>| {
                let rows = defect.values(&whole(low));
                let residue = defect.product(Matrix::Stiffness, &rows);
                [rows, residue]
            };
            low.iter().map(rows).collect()
        };
        let product = |low: &Vec<f64>| {
            let mut product = vec![0.0; low.len()];
            stiffness.group_product(0, low, &mut product);
            product
        };
        RigidMotions {
            residue: low.iter().map(product).collect(),
            on_defect: defect.map_or_else(Vec::new, on_rows),
            low,
        }
    }

    /// Whether the ring can move as a whole.
    pub fn is_empty(&self) -> bool {
        self.low.is_empty()
    }

    /// The part of the displacement `w` of the first group with the border that is no rigid motion.
    pub fn strained(&self, ring: &CyclicRing, w: &[f64]) -> Vec<f64> {
        let mut strained = w.to_vec();
        self.low
            .iter()
            .for_each(|rigid| take_out(ring, rigid, &mut strained));
        strained
    }

    /// Twice the energy that the round-off of K R has at a displacement whose first group with the border is `w`.
    pub fn twice_residual_energy(&self, ring: &CyclicRing, w: &[f64]) -> f64 {
        let pairs = self.low.iter().zip(&self.residue);
        pairs
            .map(|(rigid, residue)| low_dot(ring, rigid, w) * low_dot(ring, residue, w))
            .sum()
    }

    /// Twice the energy of a defect with the stiffness product `product` at the values `rows` of a displacement whose
    /// first group with the border is `w`.
    pub fn twice_defect_energy(&self, ring: &CyclicRing, w: &[f64], [rows, product]: [&[f64]; 2]) -> f64 {
        let mut residual = 0.0;
        for (rigid, [_, residue]) in self.low.iter().zip(&self.on_defect) {
            residual += low_dot(ring, rigid, w) * dot(residue, rows);
        }
        dot(&self.strained_rows(ring, w, rows), product) + residual
    }

    /// The values on the rows of a defect, `rows`, of a displacement whose first group with the border is `w`, less
    /// those of its rigid motion.
    fn strained_rows(&self, ring: &CyclicRing, w: &[f64], rows: &[f64]) -> Vec<f64> {
        let mut strained = rows.to_vec();
        for (rigid, [on_rows, _]) in self.low.iter().zip(&self.on_defect) {
            let share = low_dot(ring, rigid, w);
            strained
                .iter_mut()
                .zip(on_rows)
                .for_each(|(x, r)| *x -= share * r);
        }
        strained
    }
}

/// Takes the share of an orthonormal vector out of another one.
fn take_out(ring: &CyclicRing, unit: &[f64], x: &mut [f64]) {
    let share = low_dot(ring, unit, x);
    x.iter_mut().zip(unit).for_each(|(x, unit)| *x -= share * unit);
}

/// Scalar product of two vectors of the first group with the border.
fn low_dot(ring: &CyclicRing, a: &[f64], b: &[f64]) -> f64 {
    let low = ring.low_len();
    ring.group_dot(0, &a[..low], &b[..low]) + dot(&a[low..], &b[low..])
}
