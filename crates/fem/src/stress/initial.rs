//! Stress of a body that is held still while it strains by itself, equally in all directions, as by temperature.
//!
//! ```text
//! sigma_0 = D (B_m a - e I),   a = -K_mm^-1 integral of B_m^T D (-e I),   f = -integral of B^T sigma_0
//! ```
//!
//! e is the strain by itself, B_m the incompatible modes of an 8-node element, which yield to it, a their amplitudes;
//! other elements have none. The nodal forces f move the body: K u = f, and its stress is that of u plus sigma_0
//! (Hughes, The Finite Element Method, 1987, section 2.12). Where e is the gradient of nothing else than temperature
//! and free, u is the free expansion and the sum is zero. Exact for a strain that is linear over an affine element.

use super::StressRecovery;
use super::kernel::{
    MAX_POINTS, NodeState, compatible_strains, equilibrate_modes, mode_gradient, node_state,
};
use super::strain;
use crate::element::MAX_NODES;
use crate::geometry::{invert, jacobian, position};
use crate::material::hooke;
use mesh::ElementKind;

impl StressRecovery {
    /// The stress sigma_0 at the stress points, Pa, `[n_elements * points_per_element][6]`; the strain by itself is a
    /// function of the position, m.
    pub fn held_stress<F>(&self, own_strain: F) -> Vec<[f64; 6]>
    where
        F: Fn([f64; 3]) -> f64,
    {
        let still = vec![0.0; 3 * self.n_nodes()];
        let mut stress = Vec::with_capacity(self.n_elements() * self.points_per_element());
        for e in 0..self.n_elements() {
            let state = node_state(self.positions(), self.element(e), &still);
            stress.extend(self.held_element(&state, &own_strain));
        }
        stress
    }

    /// The same of one element.
    fn held_element<F>(&self, state: &NodeState, own_strain: &F) -> Vec<[f64; 6]>
    where
        F: Fn([f64; 3]) -> f64,
    {
        let (table, lame) = (self.table(), self.lame());
        let x = state.map(|s| [s[0], s[1], s[2]]);
        let mut strains = [[0.0; 6]; MAX_POINTS];
        let dets = compatible_strains(table, table.kind.n_nodes(), state, &mut strains);
        for (q, strain) in strains.iter_mut().enumerate().take(table.n_points()) {
            let e = -own_strain(position(table, q, &x));
            *strain = [e, e, e, 0.0, 0.0, 0.0];
        }
        if table.kind == ElementKind::Hex8 {
            let (modes, amplitudes) = equilibrate_modes(table, state, &strains, &dets, lame);
            for q in 0..table.n_points() {
                let yielded = strain(mode_gradient(&modes, &amplitudes, table.points[q], dets[q]));
                strains[q].iter_mut().zip(yielded).for_each(|(sum, e)| *sum += e);
            }
        }
        let points = strains[..table.n_points()].iter();
        points.map(|e| hooke(lame[0], lame[1], *e)).collect()
    }

    /// Nodal forces f of a stress at the stress points, N, `[3 n_nodes]`: what moves a body that it holds.
    pub fn released_load(&self, stress: &[[f64; 6]]) -> Vec<f64> {
        let (table, mut load) = (self.table(), vec![0.0; 3 * self.n_nodes()]);
        let n = table.kind.n_nodes();
        for (e, stress) in stress.chunks_exact(table.n_points()).enumerate() {
            let mut x = [[0.0; 3]; MAX_NODES];
            for (x, &node) in x.iter_mut().zip(self.element(e)) {
                *x = self.positions()[node];
            }
            for (q, [xx, yy, zz, xy, yz, xz]) in stress.iter().copied().enumerate() {
                let map = invert(&jacobian(n, &table.gradients[q], &x));
                let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                let weight = table.weights[q] * map.det;
                for (a, &node) in self.element(e).iter().enumerate() {
                    let slope = [0, 1, 2].map(|j| {
                        (0..3)
                            .map(|k| map.inverse[j][k] * table.gradients[q][k][a])
                            .sum::<f64>()
                    });
                    for (i, row) in rows.iter().enumerate() {
                        let force: f64 = row.iter().zip(slope).map(|(s, g)| s * g).sum();
                        load[3 * node + i] -= weight * force;
                    }
                }
            }
        }
        load
    }

    /// Stress at the nodes, Pa, `[n_nodes][6]`, from that at the stress points, as [`StressRecovery::nodal`] averages
    /// it.
    pub fn nodal_of_points(&self, stress: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let still = vec![0.0; 3 * self.n_nodes()];
        let (n_points, n_corners) = (self.points_per_element(), self.table().kind.n_corners());
        let mut corners = vec![[0.0; 6]; n_corners * self.n_elements()];
        for (e, corners) in corners.chunks_exact_mut(n_corners).enumerate() {
            let mut points = [[0.0; 6]; MAX_POINTS];
            points[..n_points].copy_from_slice(&stress[n_points * e..n_points * (e + 1)]);
            let state = node_state(self.positions(), self.element(e), &still);
            let volume = self.state_stress(&state).1;
            self.project((points, volume), corners);
        }
        self.average(&corners)
    }
}
