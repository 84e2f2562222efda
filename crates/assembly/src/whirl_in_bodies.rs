//! The equations of a shaft that turns on bearings with elastic bodies under their rings.
//!
//! To the rows of [`crate::whirl`] come those of the oscillators of the bodies that swing ([`crate::whirl_bodies`]).
//! Each bearing has the rows of [`dynamics::moved_seat`]: its own, and for the functions of its seats the forces -p on
//! the ring by the motion d of the seat beyond what p itself makes of the body at rest. With F_own of that,
//!
//! ```text
//! d + (F_own - F_h) p - S xi = 0,      xi'' + omega^2 xi - S^T p = 0
//! ```
//!
//! What has no mass of its own is condensed out: the seats, the contacts of elastic rings, a sliding outer ring. The
//! masses of what follows, such as the oscillators above and the rings in their seats, follow with it (Guyan, AIAA J. 3
//! (1965) 380, doi:10.2514/3.2874). So elasticity of a ring is static, that of a body is not.
//!
//! Damping of rings in proportion to their stiffness is that of bodies too, as in motion.

use dense::linear_combinations;
use dynamics::condensation::Condensation;
use dynamics::moved_seat::{MovedSeats, SeatMatrices};
use dynamics::stiffness::{N_SHAFT, is_held};
use dynamics::whirl::TurningShaft;

use crate::error::AssemblyError;
use crate::whirl_bodies::WhirlBody;
use crate::whirl_kept::KeptRows;
use crate::whirl_rows::{RowPlaces, WhirlBearing, WhirlShaft};

/// The equations of linearised bearings and bodies under a shaft.
pub fn equations_in_bodies(
    shaft: &WhirlShaft,
    bearings: &[WhirlBearing<'_>],
    bodies: &[WhirlBody],
) -> Result<TurningShaft, AssemblyError> {
    let matrices: Vec<SeatMatrices> = bearings
        .iter()
        .enumerate()
        .map(|(b, bearing)| {
            let seats = bodies.iter().flat_map(|body| &body.seats);
            let sides: Vec<_> = seats
                .filter(|seat| seat.bearing == b)
                .map(|seat| seat.side)
                .collect();
            MovedSeats::new(&sides, bearing.solver, bearing.solution, bearing.linear).matrices()
        })
        .collect();
    let places = RowPlaces::new(shaft, &matrices, bodies);
    let mut all = AllRows::new(&places, shaft);
    for (b, (bearing, own)) in bearings.iter().zip(&matrices).enumerate() {
        all.add_bearing((b, bearing), own, bodies);
    }
    for (number, body) in bodies.iter().enumerate() {
        all.add_body(number, body);
    }
    let failed = |source| AssemblyError::Matrix { source };
    let condensation = Condensation::new(places.n, places.n_kept, &all.stiffness).map_err(failed)?;
    let mut kept = KeptRows::new(shaft, &places, [&all.stiffness, &all.damping], &condensation);
    for (b, bearing) in bearings.iter().enumerate() {
        kept.add_bearing(b, bearing);
    }
    for (number, body) in bodies.iter().enumerate() {
        kept.add_body(
            body,
            (number, &condensation.followed(&all.forces[number])),
            bearings,
        );
    }
    Ok(kept.equations(shaft, &all.held))
}

/// Stiffness and damping before anything is condensed out, row-major.
struct AllRows<'p> {
    places: &'p RowPlaces,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// Forces p on the functions of each body by all motions, and by velocities of damped rings.
    forces: Vec<Vec<f64>>,
    damped: Vec<Vec<f64>>,
    /// Damping of the rings over their stiffness, s.
    ring_damping: f64,
    /// Balls that nothing touches.
    held: Vec<usize>,
}

impl<'p> AllRows<'p> {
    fn new(places: &'p RowPlaces, shaft: &WhirlShaft) -> AllRows<'p> {
        let (n, n_shaft) = (places.n, places.n_shaft);
        let spread = |matrix: &[f64]| {
            let mut whole = vec![0.0; n * n];
            for (row, own) in whole.chunks_exact_mut(n).zip(matrix.chunks_exact(n_shaft)) {
                row[..n_shaft].copy_from_slice(own);
            }
            whole
        };
        let ends = places.functions.iter().skip(1).chain([&places.n]);
        let none: Vec<Vec<f64>> = places
            .functions
            .iter()
            .zip(ends)
            .map(|(start, end)| vec![0.0; n * (end - start)])
            .collect();
        AllRows {
            stiffness: spread(&shaft.matrices.stiffness),
            damping: spread(&shaft.matrices.rates),
            forces: none.clone(),
            damped: none,
            places,
            ring_damping: 0.0,
            held: Vec::new(),
        }
    }

    /// Adds the rows of a bearing; those of its seats are forces on bodies.
    fn add_bearing(
        &mut self,
        (b, bearing): (usize, &WhirlBearing<'_>),
        own: &SeatMatrices,
        bodies: &[WhirlBody],
    ) {
        let places = self.places;
        let spread = places.spread((b, bearing), own, bodies);
        let (n, m) = (places.n, spread.len());
        self.ring_damping = own.ring_damping;
        let forces_of = |row: usize| {
            let number = places.functions.iter().rposition(|first| *first <= row)?;
            Some((number, row - places.functions[number]))
        };
        for (i, to) in spread.iter().enumerate() {
            let stiffness = &own.stiffness[m * i..m * (i + 1)];
            let is_ball = (N_SHAFT..own.n_kept).contains(&i);
            if is_ball && !is_held(stiffness, i) {
                self.held.push(to[0].0);
            }
            let damping = own.damping.as_ref().map(|damping| &damping[m * i..m * (i + 1)]);
            for &(row, a) in to {
                let force = forces_of(row).filter(|_| i >= own.n_own);
                let (k, c, row, a) = match force {
                    // Of the ring on the body.
                    Some((number, f)) => (&mut self.forces[number], &mut self.damped[number], f, -a),
                    None => (&mut self.stiffness, &mut self.damping, row, a),
                };
                add_row(stiffness, &spread, a, &mut k[n * row..n * (row + 1)]);
                if let Some(damping) = damping {
                    add_row(damping, &spread, a, &mut c[n * row..n * (row + 1)]);
                }
            }
        }
    }

    /// Adds the rows of the functions and oscillators of a body.
    fn add_body(&mut self, number: usize, body: &WhirlBody) {
        let (n, m, forces) = (self.places.n, body.n_functions, &self.forces[number]);
        let (first, first_function) = (self.places.oscillators[number], self.places.functions[number]);
        // Seats.
        let pressed = linear_combinations(n, forces, m, &body.flexibility_beside, m);
        for (f, pressed) in pressed.chunks_exact(n).enumerate() {
            let row = &mut self.stiffness[n * (first_function + f)..][..n];
            row.iter_mut().zip(pressed).for_each(|(k, p)| *k += p);
            row[first_function + f] += 1.0;
            for (k, y) in body.rows.chunks_exact(m).enumerate() {
                row[first + k] -= y[f];
            }
        }
        // Oscillators.
        let count = body.squares.len();
        let loads = linear_combinations(n, forces, m, &body.rows, count);
        let damped = linear_combinations(n, &self.damped[number], m, &body.rows, count);
        for (k, square) in body.squares.iter().enumerate() {
            let rows = n * (first + k)..n * (first + k + 1);
            let minus = |to: &mut [f64], from: &[f64]| {
                to.iter_mut()
                    .zip(&from[n * k..n * (k + 1)])
                    .for_each(|(to, x)| *to -= x);
            };
            minus(&mut self.stiffness[rows.clone()], &loads);
            minus(&mut self.damping[rows.clone()], &damped);
            self.stiffness[rows.start + first + k] += square;
            self.damping[rows.start + first + k] += self.ring_damping * square;
        }
    }
}

/// Adds a row of a bearing, times a factor, to one of all.
fn add_row(own: &[f64], spread: &[Vec<(usize, f64)>], factor: f64, to: &mut [f64]) {
    for (entry, columns) in own.iter().zip(spread).filter(|(entry, _)| **entry != 0.0) {
        for &(column, a) in columns {
            to[column] += factor * entry * a;
        }
    }
}
