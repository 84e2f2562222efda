//! A ring whose seat is tied to an elastic body in functions of the seat.
//!
//! The solver holds the ring in its mean motion: K_h^-1 with B u = 0. A body of flexibility F takes the place of the
//! rigid partner by forces lam in the functions Phi of the seat, and the ring moves by R q as well:
//!
//! ```text
//! u = K_h^-1 (f + Phi lam) + R q
//! | A + F    Phi^T R |  | lam |      | Phi^T K_h^-1 f |
//! | R^T Phi     0    |  |  q  | = -  | R^T f          |,     A = Phi^T K_h^-1 Phi
//! ```
//!
//! The second row says that f + Phi lam is balanced. So the mean motion holds nothing, and it is no matter how it is
//! defined: the answer is that of the free ring on the body. The rigid motions are exact, because K R = 0 and the
//! solver leaves u + R q open for any q. Cost: one solve per function once, then two solves per load instead of one.

use std::sync::Arc;

use body::{SeatFunctions, SeatTie};
use dense::DenseLu;
use mesh::NodePositions;

use super::held::HeldFactor;
use crate::error::RingError;
use crate::model::RingModel;
use crate::vectors::dot;

/// Rigid motions of a ring.
const N_RIGID: usize = 6;

/// What a ring does when others move its seat by unit motions of the functions, and nothing else acts.
pub struct SeatResponse {
    /// Number of functions of the seat.
    pub n_functions: usize,
    /// Motion of the contacts, m/m, row-major `[2 n_contacts][n_functions]` over (contact, [radial, axial]).
    pub motion: Vec<f64>,
    /// Forces on the ring, N/m, `[n_functions][n_functions]` flat.
    pub forces: Vec<f64>,
}

/// The seat of a ring before a body is tied to it.
pub(super) struct SeatOfRing {
    functions: SeatFunctions,
    /// A, m/N, `[n][n]` flat.
    compliance: Vec<f64>,
}

/// The joint of a factored ring.
pub(super) struct RingTie {
    /// Rings of one type whose seats have the same functions share it.
    seat: Arc<SeatOfRing>,
    places: NodePositions,
    /// Factor over (lam, q / scale).
    saddle: DenseLu,
    /// Unit of q, m: makes both parts of the matrix equally large.
    scale: f64,
}

impl SeatOfRing {
    /// The functions of a seat and what they do to its ring in its mean motion. Cost: a solve per function.
    pub fn new(ring: &HeldFactor, functions: SeatFunctions) -> SeatOfRing {
        SeatOfRing {
            compliance: ring.seat_compliance(&functions),
            functions,
        }
    }
}

impl RingModel {
    /// Functions of the seat on the ring's side; None where no body is tied to it.
    pub fn seat_functions(&self, side: &'static str) -> Result<Option<SeatFunctions>, RingError> {
        let Some(tie) = &self.tie else { return Ok(None) };
        let areas = fem::facet_node_weights(&self.mesh, self.mesh.group(self.held_group));
        let what = format!("the {} of the {side} ring", self.held_group);
        let functions = SeatFunctions::new(&what, tie.space, &areas, |node| self.mesh.nodes[node]);
        functions.map(Some).map_err(|source| RingError::Body { source })
    }
}

impl RingTie {
    /// Ties a ring with its seat in its mean motion to a body.
    pub fn new(seat: Arc<SeatOfRing>, ring: &RingModel, tie: &Arc<SeatTie>) -> Result<RingTie, RingError> {
        let (functions, n) = (&seat.functions, seat.functions.n());
        let mut matrix = seat.compliance.clone();
        matrix.iter_mut().zip(&tie.flexibility).for_each(|(a, f)| *a += f);
        let scale = (0..n).map(|i| matrix[n * i + i]).fold(0.0, f64::max);
        let mut tied = vec![0.0; (n + N_RIGID) * (n + N_RIGID)];
        for (i, row) in matrix.chunks_exact(n).enumerate() {
            tied[(n + N_RIGID) * i..(n + N_RIGID) * i + n].copy_from_slice(row);
        }
        for k in 0..N_RIGID {
            let mut mode = vec![0.0; ring.mesh.n_dofs()];
            for (x, u) in ring.mesh.nodes.iter().zip(mode.chunks_exact_mut(3)) {
                u.copy_from_slice(&functions.space.rigid_motions(*x).map(|row| scale * row[k]));
            }
            for (i, value) in functions.measure(&mode).into_iter().enumerate() {
                tied[(n + N_RIGID) * i + n + k] = value;
                tied[(n + N_RIGID) * (n + k) + i] = value;
            }
        }
        let saddle = DenseLu::factor(n + N_RIGID, &tied).map_err(|source| RingError::Tie { source })?;
        Ok(RingTie {
            seat,
            places: ring.mesh.nodes.clone(),
            saddle,
            scale,
        })
    }

    /// The seat, if it has these functions.
    pub fn seat_with(&self, functions: &SeatFunctions) -> Option<Arc<SeatOfRing>> {
        (self.seat.functions == *functions).then(|| self.seat.clone())
    }

    /// Rows and columns of the saddle.
    pub fn n(&self) -> usize {
        self.seat.functions.n() + N_RIGID
    }

    /// Number of functions.
    pub fn n_functions(&self) -> usize {
        self.seat.functions.n()
    }

    /// Bytes of the joint.
    pub fn bytes(&self) -> usize {
        let matrices = self.n() * self.n() + self.seat.compliance.len();
        size_of::<f64>() * (matrices + 3 * self.places.len()) + self.seat.functions.bytes()
    }

    /// Nodes of the seat.
    pub fn nodes(&self) -> &[usize] {
        &self.seat.functions.nodes
    }

    /// Phi^T u and scale R^T f of a held displacement, m, and the load on the ring, N, that made it.
    pub fn coupling(&self, displacement: &[f64], load: &[f64]) -> Vec<f64> {
        let mut coupling = self.seat.functions.measure(displacement);
        let mut resultant = [0.0; N_RIGID];
        for (x, f) in self.places.iter().zip(load.chunks_exact(3)) {
            if f.iter().any(|f| *f != 0.0) {
                for (row, f) in self.seat.functions.space.rigid_motions(*x).iter().zip(f) {
                    (0..N_RIGID).for_each(|k| resultant[k] += row[k] * f);
                }
            }
        }
        coupling.extend(resultant.map(|sum| self.scale * sum));
        coupling
    }

    /// Forces lam and motions q for some couplings, column-major `[n][columns]`.
    pub fn answer(&self, couplings: &[f64]) -> Vec<f64> {
        let mut answer: Vec<f64> = couplings.iter().map(|b| -b).collect();
        self.saddle.solve(&mut answer, couplings.len() / self.n());
        answer
    }

    /// What motions d of the seat do: (lam, q) = M^-1 (d, 0) with the saddle M. Contacts that have these couplings
    /// `[n_contacts][n]` when they push move by their products with it, as M is symmetric.
    pub fn response(&self, couplings: &[f64]) -> SeatResponse {
        let (n, n_functions) = (self.n(), self.n_functions());
        let mut answers = vec![0.0; n * n_functions];
        (0..n_functions).for_each(|i| answers[n * i + i] = 1.0);
        self.saddle.solve(&mut answers, n_functions);
        let of_coupling = |coupling| answers.chunks_exact(n).map(move |answer| dot(coupling, answer));
        SeatResponse {
            n_functions,
            motion: couplings.chunks_exact(n).flat_map(of_coupling).collect(),
            forces: (0..n_functions)
                .flat_map(|i| answers.iter().skip(i).step_by(n))
                .copied()
                .collect(),
        }
    }

    /// Adds the forces of the body to a load.
    pub fn add_forces(&self, answer: &[f64], load: &mut [f64]) {
        self.seat.functions.add_load(&answer[..self.n_functions()], load);
    }

    /// Adds the rigid motion to a displacement.
    pub fn add_motion(&self, answer: &[f64], displacement: &mut [f64]) {
        let q = &answer[self.n_functions()..];
        for (x, u) in self.places.iter().zip(displacement.chunks_exact_mut(3)) {
            for (row, u) in self.seat.functions.space.rigid_motions(*x).iter().zip(u) {
                *u += self.scale * row.iter().zip(q).map(|(r, q)| r * q).sum::<f64>();
            }
        }
    }
}
