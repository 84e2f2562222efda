//! A bearing in a body that others move as well, about an equilibrium to first order.
//!
//! Others move the seat of a ring by d, of an inner ring beside the shaft, a number for each of its functions. Where no
//! contact force changes, that moves the contacts by L d and changes the forces on the ring by S d
//! ([`ring::statics::SeatResponse`]). With the compliance C of the contacts and the motions g of the grooves there,
//!
//! ```text
//! contact forces on the ring  dF = C^-1 (dg - L dd),      forces on the body  dp = L^T dF - S dd
//! ```
//!
//! So d takes rows of its own beside those of the bearing ([`crate::stiffness`]): -C^-1 L in the rows of g and
//! L^T C^-1 L + S in its own. All but shaft and d are condensed out:
//!
//! ```text
//! |  dr |   | H_qq  H_qd |  | dq |
//! | -dp | = | H_dq  H_dd |  | dd |
//! ```
//!
//! r is the load on the shaft, q its displacement. Cost: the compliance of the contacts once more, and dense factors.

use contact::Side;

use crate::condensation::Condensation;
use crate::error::DynamicsError;
use crate::solution::StaticSolution;
use crate::statics::StaticSolver;
use crate::stiffness::{Linearisation, N_SHAFT, RingPorts};
use ring::statics::SeatResponse;

/// H of the module.
pub struct SeatStiffness {
    /// Functions of the seat.
    pub n_functions: usize,
    /// Over the shaft (x, y, z, tilt_x, tilt_y), then the functions, row-major.
    pub matrix: Vec<f64>,
}

impl SeatStiffness {
    /// Of a bearing that was linearised anew, and its ring of one side; None where no body is tied to that.
    pub fn new(
        side: Side,
        solver: &StaticSolver,
        solution: &StaticSolution,
        linear: &Linearisation,
    ) -> Result<Option<SeatStiffness>, DynamicsError> {
        let (Some(ring), Some(ports)) = (solver.ring(side), &linear.ports[side.index()]) else {
            return Ok(None);
        };
        let footprints = solution.footprints(side).iter();
        let weights: Vec<_> = footprints.map(|f| f.weights.clone()).collect();
        let Some(response) = ring.solver.seat_response(&weights) else {
            return Ok(None);
        };
        SeatStiffness::condensed(linear, ports, &response).map(Some)
    }

    fn condensed(
        linear: &Linearisation,
        ports: &RingPorts,
        response: &SeatResponse,
    ) -> Result<SeatStiffness, DynamicsError> {
        let (own, m) = (linear.n, response.n_functions);
        let (n, kept) = (own + m, N_SHAFT + m);
        // The shaft, the seat, then all that is condensed out.
        let place = |unknown: usize| unknown + if unknown < N_SHAFT { 0 } else { m };
        let mut matrix = vec![0.0; n * n];
        for (i, row) in linear.stiffness.chunks_exact(own).enumerate() {
            for (j, entry) in row.iter().enumerate() {
                matrix[n * place(i) + place(j)] = *entry;
            }
        }
        // C^-1 L by rows of g.
        let motion = &response.motion;
        let pulled = |row: &[f64], function: usize| -> f64 {
            let column = motion.iter().skip(function).step_by(m);
            row.iter().zip(column).map(|(c, l)| c * l).sum()
        };
        let rows = ports.stiffness.chunks_exact(ports.unknowns.len());
        let pulled: Vec<f64> = rows.flat_map(|row| (0..m).map(move |k| pulled(row, k))).collect();
        for (unknown, row) in ports.unknowns.clone().zip(pulled.chunks_exact(m)) {
            for (function, pull) in row.iter().enumerate() {
                matrix[n * place(unknown) + N_SHAFT + function] = -pull;
                matrix[n * (N_SHAFT + function) + place(unknown)] = -pull;
            }
        }
        for (i, row) in response.forces.chunks_exact(m).enumerate() {
            for (j, force) in row.iter().enumerate() {
                let contacts = motion.chunks_exact(m).zip(pulled.chunks_exact(m));
                let of_contacts: f64 = contacts.map(|(l, pull)| l[i] * pull[j]).sum();
                matrix[n * (N_SHAFT + i) + N_SHAFT + j] = force + of_contacts;
            }
        }
        let condensation =
            Condensation::new(n, kept, &matrix).map_err(|source| DynamicsError::ContactSystem { source })?;
        Ok(SeatStiffness {
            n_functions: m,
            matrix: condensation.apply(&matrix),
        })
    }

    /// A row: of the shaft's dofs, then of the functions.
    pub fn row(&self, row: usize) -> &[f64] {
        let n = N_SHAFT + self.n_functions;
        &self.matrix[n * row..n * (row + 1)]
    }
}
