//! A bearing in bodies that others move as well, about an equilibrium to first order.
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
//! L^T C^-1 L + S in its own. Both rings may be in such bodies. All but d and what is kept of shaft and balls, q, are
//! condensed out:
//!
//! ```text
//! |  dr |   | H_qq  H_qd |  | dq |
//! | -dp | = | H_dq  H_dd |  | dd |
//! ```
//!
//! r is the load on q. Patches that go along with their contacts ([`crate::moving_patches`]) move these by D dx besides
//! and change the load on the ring by dw f: L^T C^-1 D and -dw f in the rows of d. Cost: the compliance of the contacts
//! once more, and dense factors.

use std::ops::Range;

use contact::Side;

use crate::condensation::Condensation;
use crate::error::DynamicsError;
use crate::solution::StaticSolution;
use crate::statics::StaticSolver;
use crate::stiffness::{Linearisation, N_SHAFT, RingPorts};
use ring::statics::SeatResponse;

/// H of the module.
pub struct SeatStiffness {
    /// Rows of shaft (x, y, z, tilt_x, tilt_y) and balls ([radial, axial] each) that come first.
    pub n_kept: usize,
    /// Numbers of the functions of the seats of both rings among all functions, inner first; None of a ring that no
    /// one else moves.
    pub functions: [Option<Range<usize>>; 2],
    /// Number of all functions.
    n_functions: usize,
    /// Over what is kept, then the functions, row-major.
    matrix: Vec<f64>,
}

/// A bearing with its moved seats, before anything is condensed out.
pub struct SeatMatrices {
    /// Rows of shaft and balls, which come first.
    pub n_kept: usize,
    /// Rows of all that the bearing has of its own: then come those of the functions of its seats.
    pub n_own: usize,
    /// Numbers of the functions of the seats of both rings among all functions, inner first.
    pub functions: [Option<Range<usize>>; 2],
    /// Loads by motions, row-major over `n_own` and the functions; those of functions are -p, on the ring.
    pub stiffness: Vec<f64>,
    /// The same by velocities, if there is damping: of contacts, and of rings in proportion to their stiffness.
    pub damping: Option<Vec<f64>>,
    /// Damping of the rings over their stiffness, s.
    pub ring_damping: f64,
}

/// The seat of a ring in a body that others move.
struct MovedSeat<'l> {
    ports: &'l RingPorts,
    response: SeatResponse,
    /// C^-1 L by rows of g, then functions.
    pulled: Vec<f64>,
    /// What the load of a patch that moves and grows does to the functions, `[n_balls][2][n_functions]`.
    of_patches: Vec<f64>,
    first: usize,
}

/// A bearing with its moved seats.
pub struct MovedSeats<'l> {
    linear: &'l Linearisation,
    seats: Vec<MovedSeat<'l>>,
    functions: [Option<Range<usize>>; 2],
    n_functions: usize,
}

impl<'l> MovedSeats<'l> {
    /// Of a bearing that was linearised anew, whose rings of these sides are in bodies that others move.
    pub fn new(
        sides: &[Side],
        solver: &StaticSolver,
        solution: &StaticSolution,
        linear: &'l Linearisation,
    ) -> MovedSeats<'l> {
        let mut all = MovedSeats {
            linear,
            seats: Vec::new(),
            functions: [None, None],
            n_functions: 0,
        };
        for &side in sides {
            let (Some(ring), Some(ports)) = (solver.ring(side), &linear.ports[side.index()]) else {
                continue;
            };
            let footprints = solution.footprints(side).iter();
            let weights: Vec<_> = footprints.map(|f| f.weights.clone()).collect();
            if let Some(response) = ring.solver.seat_response(&weights) {
                let first = all.n_functions;
                all.n_functions += response.n_functions;
                all.functions[side.index()] = Some(first..all.n_functions);
                let patches = ports.patches.as_ref();
                let of_patches = patches.and_then(|patches| ring.solver.seat_response(&patches.loads));
                all.seats.push(MovedSeat {
                    ports,
                    pulled: pulled(ports, &response),
                    response,
                    of_patches: of_patches.map_or(Vec::new(), |found| found.motion),
                    first,
                });
            }
        }
        all
    }

    /// H over the shaft.
    pub fn of_shaft(&self) -> Result<SeatStiffness, DynamicsError> {
        self.condensed(N_SHAFT)
    }

    /// All rows.
    pub fn matrices(&self) -> SeatMatrices {
        let (own, n) = (self.linear.n, self.linear.n + self.n_functions);
        let spread = |matrix: &[f64], ring_damping: Option<f64>| {
            let mut whole = vec![0.0; n * n];
            for seat in &self.seats {
                seat.add(n, own + seat.first, |unknown| unknown, &mut whole);
                if ring_damping.is_none() {
                    seat.add_patches(n, own + seat.first, |unknown| unknown, &mut whole);
                }
            }
            let factor = ring_damping.unwrap_or(1.0);
            whole.iter_mut().for_each(|entry| *entry *= factor);
            for (row, to) in matrix.chunks_exact(own).zip(whole.chunks_exact_mut(n)) {
                to[..own].copy_from_slice(row);
            }
            whole
        };
        let ring_damping = self.linear.ring_damping;
        SeatMatrices {
            n_kept: N_SHAFT + 2 * self.linear.n_balls,
            n_own: own,
            functions: self.functions.clone(),
            stiffness: spread(&self.linear.stiffness, None),
            damping: self
                .linear
                .damping
                .as_ref()
                .map(|c| spread(c, Some(ring_damping))),
            ring_damping,
        }
    }

    /// H over the first rows of the bearing.
    fn condensed(&self, n_kept: usize) -> Result<SeatStiffness, DynamicsError> {
        let (own, m) = (self.linear.n, self.n_functions);
        let n = own + m;
        // What is kept, the seats, then all that is condensed out.
        let place = |unknown: usize| unknown + if unknown < n_kept { 0 } else { m };
        let mut matrix = vec![0.0; n * n];
        for (i, row) in self.linear.stiffness.chunks_exact(own).enumerate() {
            for (j, entry) in row.iter().enumerate() {
                matrix[n * place(i) + place(j)] = *entry;
            }
        }
        for seat in &self.seats {
            seat.add(n, n_kept + seat.first, place, &mut matrix);
            seat.add_patches(n, n_kept + seat.first, place, &mut matrix);
        }
        let condensation = Condensation::new(n, n_kept + m, &matrix)
            .map_err(|source| DynamicsError::ContactSystem { source })?;
        Ok(SeatStiffness {
            n_kept,
            functions: self.functions.clone(),
            n_functions: m,
            matrix: condensation.apply(&matrix),
        })
    }
}

impl MovedSeat<'_> {
    /// Adds its rows to a matrix of `n` rows, where its functions begin at `first` and unknowns of the bearing are at
    /// their `place`.
    fn add(&self, n: usize, first: usize, place: impl Fn(usize) -> usize, matrix: &mut [f64]) {
        let (ports, response, m) = (self.ports, &self.response, self.response.n_functions);
        let (motion, pulled) = (&response.motion, &self.pulled);
        for (unknown, row) in ports.unknowns.clone().zip(pulled.chunks_exact(m)) {
            for (function, pull) in row.iter().enumerate() {
                matrix[n * place(unknown) + first + function] = -pull;
                matrix[n * (first + function) + place(unknown)] = -pull;
            }
        }
        for (i, row) in response.forces.chunks_exact(m).enumerate() {
            for (j, force) in row.iter().enumerate() {
                let contacts = motion.chunks_exact(m).zip(pulled.chunks_exact(m));
                let of_contacts: f64 = contacts.map(|(l, pull)| l[i] * pull[j]).sum();
                matrix[n * (first + i) + first + j] = force + of_contacts;
            }
        }
    }

    /// Adds what patches that go along do to its functions; all is as in [`Self::add`].
    fn add_patches(&self, n: usize, first: usize, place: impl Fn(usize) -> usize, matrix: &mut [f64]) {
        let m = self.response.n_functions;
        let Some(patches) = &self.ports.patches else {
            return;
        };
        let own = patches.moved.len() / self.ports.unknowns.len();
        for function in 0..m {
            let row = n * (first + function);
            let by_motions = self.pulled.iter().skip(function).step_by(m);
            for (pull, moved) in by_motions.zip(patches.moved.chunks_exact(own)) {
                for (unknown, moved) in moved.iter().enumerate() {
                    matrix[row + place(unknown)] += pull * moved;
                }
            }
            for (k, places) in patches.places.iter().enumerate() {
                let loads = self.of_patches.iter().skip(m * k + function).step_by(2 * m);
                for (load, places) in loads.zip(places.chunks_exact(own)) {
                    for (unknown, grown) in places.iter().enumerate() {
                        matrix[row + place(unknown)] -= load * grown;
                    }
                }
            }
        }
    }
}

/// C^-1 L of a ring, by rows of g, then functions.
fn pulled(ports: &RingPorts, response: &SeatResponse) -> Vec<f64> {
    let m = response.n_functions;
    let pulled = |row: &[f64], function: usize| -> f64 {
        let column = response.motion.iter().skip(function).step_by(m);
        row.iter().zip(column).map(|(c, l)| c * l).sum()
    };
    let rows = ports.stiffness.chunks_exact(ports.unknowns.len());
    rows.flat_map(|row| (0..m).map(move |k| pulled(row, k))).collect()
}

impl SeatStiffness {
    /// A row of what is kept: by what is kept, and by all functions.
    pub fn kept_row(&self, row: usize) -> (&[f64], &[f64]) {
        let n = self.n_kept + self.n_functions;
        self.matrix[n * row..n * (row + 1)].split_at(self.n_kept)
    }

    /// The same of a function.
    pub fn function_row(&self, function: usize) -> (&[f64], &[f64]) {
        self.kept_row(self.n_kept + function)
    }
}
