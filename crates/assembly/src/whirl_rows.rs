//! The rows of a shaft on bearings with elastic bodies: shaft, balls, oscillators; then what is condensed out.

use dynamics::moved_seat::SeatMatrices;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::whirl::WhirlMatrices;
use dynamics::{Linearisation, Model, StaticSolution, StaticSolver};
use ring::rigid::RigidInertia;

use crate::whirl_bodies::WhirlBody;

/// A linearised bearing on the shaft.
pub struct WhirlBearing<'a> {
    /// The bearing.
    pub model: &'a Model,
    /// Its factors.
    pub solver: &'a StaticSolver,
    /// Where it stands.
    pub solution: &'a StaticSolution,
    /// What it is to first order there.
    pub linear: &'a Linearisation,
    /// Motion of its place in its own frame by five dofs of the shaft.
    pub motion: ShaftMatrix,
    /// The first of these.
    pub first: usize,
    /// Its turn about its own z by that of the shaft: 1 or -1.
    pub way: f64,
    /// Inertia of a flexible inner ring that sits in no body with a mass.
    pub ring: Option<RigidInertia>,
}

/// A shaft with its own matrices, of which those of speed are in.
pub struct WhirlShaft {
    /// Matrices over its dofs.
    pub matrices: WhirlMatrices,
    /// Its free dofs.
    pub free: Vec<usize>,
    /// Its speed, rad/s.
    pub speed: f64,
}

/// Where everything is among the rows.
pub struct RowPlaces {
    /// Dofs of the shaft.
    pub n_shaft: usize,
    /// First ball, by bearing.
    pub balls: Vec<usize>,
    /// The same of what is condensed out.
    pub inner: Vec<usize>,
    /// First oscillator, by body.
    pub oscillators: Vec<usize>,
    /// First function, by body.
    pub functions: Vec<usize>,
    /// Rows that are kept.
    pub n_kept: usize,
    /// All rows.
    pub n: usize,
}

impl RowPlaces {
    pub fn new(shaft: &WhirlShaft, bearings: &[SeatMatrices], bodies: &[WhirlBody]) -> RowPlaces {
        let mut next = shaft.matrices.n;
        let mut starts = |sizes: Vec<usize>| -> Vec<usize> {
            let start = |size| {
                next += size;
                next - size
            };
            sizes.into_iter().map(start).collect()
        };
        let balls = starts(bearings.iter().map(|own| own.n_kept - N_SHAFT).collect());
        let oscillators = starts(bodies.iter().map(|body| body.squares.len()).collect());
        let n_kept = starts(vec![0])[0];
        let inner = starts(bearings.iter().map(|own| own.n_own - own.n_kept).collect());
        let functions = starts(bodies.iter().map(|body| body.n_functions).collect());
        RowPlaces {
            n_shaft: shaft.matrices.n,
            balls,
            inner,
            oscillators,
            functions,
            n_kept,
            n: next,
        }
    }

    /// A row of a bearing or a function of its seats: the rows among all, and their factors.
    pub fn spread(
        &self,
        bearing: (usize, &WhirlBearing<'_>),
        own: &SeatMatrices,
        bodies: &[WhirlBody],
    ) -> Vec<Vec<(usize, f64)>> {
        let (b, at) = bearing;
        let mut all: Vec<Vec<(usize, f64)>> = at
            .motion
            .iter()
            .map(|row| row.iter().enumerate().map(|(k, a)| (at.first + k, *a)).collect())
            .collect();
        all.extend((0..own.n_kept - N_SHAFT).map(|i| vec![(self.balls[b] + i, 1.0)]));
        all.extend((0..own.n_own - own.n_kept).map(|i| vec![(self.inner[b] + i, 1.0)]));
        let seats = bodies.iter().enumerate();
        let mut seats: Vec<_> = seats
            .flat_map(|(number, body)| body.seats.iter().map(move |seat| (number, seat)))
            .filter(|(_, seat)| seat.bearing == b)
            .filter_map(|(number, seat)| Some((own.functions[seat.side.index()].clone()?, number, seat)))
            .collect();
        seats.sort_by_key(|(functions, ..)| functions.start);
        for (_, number, seat) in seats {
            let first = self.functions[number];
            all.extend(seat.functions.clone().map(|f| vec![(first + f, 1.0)]));
        }
        all
    }
}
