//! One pass over the harmonics of a periodic ring: the end of a step, and the solve that the next one begins with.
//!
//! Between the contact forces of a step and the motion of the raceway under the known loads of the next, no harmonic meets another.
//! So one group of harmonics after the other goes all the way while it is in the cache, and its factor is read from memory once:
//! ```text
//! dw = predictor + S^-1 (forces of contacts and partner)
//! w, v, a at the end; M v, K w, energies; work of the loads
//! predictor of the next step = S^-1 (its known loads - K w + M (history))
//! ```
//! The rows of the border go with the first group. Sums over the groups are taken in their order. A predictor that is found on its own
//! ([`Pass::predict`]: at the start, after a change of the step size, after a step file) comes from the same functions and has the
//! same bits. Solves of a ring that ranks share are collective, so that there the parts of a pass follow each other for the whole ring.

use solver::cyclic::PartHarmonics;

use super::effective::CyclicFactor;
use super::integrator::Integrator;
use super::ring_state::{RingState, advance_part, within_part};
use super::space::{FrameLoads, HarmonicSpace, Nodes};
use crate::effects::FrameTurn;

/// A ring and its scheme.
#[derive(Clone, Copy)]
pub(super) struct Pass<'a> {
    pub space: &'a HarmonicSpace,
    pub nodes: Nodes<'a>,
    pub factor: &'a CyclicFactor,
    pub integrator: Integrator,
    pub dt: f64,
    /// Factors of v and a under M, and under K, on the right-hand side.
    pub history: [[f64; 2]; 2],
}

/// The increment of a step.
pub(super) enum Increment<'a> {
    /// The predictor plus S^-1 of loads on touched nodes and border.
    Forces {
        loads: PartHarmonics<'a>,
        border: Vec<f64>,
        predictor: &'a [f64],
    },
    /// Itself, harmonics and border.
    Found(Vec<f64>),
}

/// What acts in a step besides contacts and partner, in the ring's space.
#[derive(Clone, Copy, Default)]
pub(super) struct Acting<'a> {
    pub load: Option<&'a [f64]>,
    /// Inertia of the turning frame.
    pub inertia: Option<&'a [f64]>,
    /// Turning of the frame, when the inertia that fits the increment is to be found.
    pub turn: Option<FrameTurn>,
}

/// What is known of the loads of the next step.
#[derive(Clone, Copy, Default)]
pub(super) struct Coming<'a> {
    pub load: Option<&'a [f64]>,
    pub turn: Option<FrameTurn>,
}

/// The answer of a ring to known loads.
pub(super) struct Predicted {
    /// S^-1 of the right-hand side.
    pub solved: Vec<f64>,
    /// First guess of the inertia of the turning frame; empty without one.
    pub inertia: Vec<f64>,
}

/// The end of a step.
pub(super) struct Ended {
    pub state: RingState,
    /// Work of the load and of the inertia of the frame, J.
    pub works: [f64; 2],
    /// Inertia that fits the increment, and its difference from that which acted.
    pub renewed: (Vec<f64>, Change),
    pub next: Option<Predicted>,
}

/// Difference of two loads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Change {
    /// Sum of the squares of its coordinates.
    pub square: f64,
    /// Not less than the sum of their magnitudes.
    pub bound: f64,
    /// Sum of the squares of the coordinates of the new load.
    pub new_square: f64,
}

/// The increment of a step as the inertia of the turning frame meets it.
pub(super) struct Turned {
    /// Inertia that fits it.
    pub inertia: Vec<f64>,
    pub change: Change,
    /// The predictor under the new inertia.
    pub predictor: Vec<f64>,
}

/// Vectors of one group, with the border in the first.
struct Buffers([Vec<f64>; 9]);

/// The vectors that a pass writes, or one group's parts of them without the border: w, v, a, the renewed inertia, the guess of the next,
/// the solution. Those that are not wanted are empty.
type Written<'a> = [&'a mut [f64]; 6];

/// What a group adds to the sums, and the rows of the border from the first.
#[derive(Default)]
struct Found {
    energies: [f64; 2],
    works: [f64; 2],
    squares: [f64; 2],
    /// Squares of a change by section node, in the plane and along the axis, and magnitudes of the rows of its border.
    lines: Vec<[f64; 2]>,
    rows: f64,
    /// Of the vectors of [`Written`].
    border: [Vec<f64>; 6],
}

impl Pass<'_> {
    /// Ends a step from `old`; with `coming`, finds the predictor of the next.
    pub fn end(
        &self,
        old: &RingState,
        increment: Increment<'_>,
        acting: Acting<'_>,
        coming: Option<Coming<'_>>,
    ) -> Ended {
        let increment = self.whole_if_shared(increment);
        let turning = self.turning(acting.turn);
        let coming = coming.map(|c| (c.load, self.turning(c.turn)));
        let n = old.displacement().len();
        let vector = |wanted: Option<()>| vec![0.0; wanted.map_or(0, |()| n)];
        let [mut w, mut v, mut a] = [(); 3].map(|()| vec![0.0; n]);
        let mut renewed = vector(turning.map(|_| ()));
        let mut inertia = vector(coming.and_then(|c| c.1).map(|_| ()));
        let mut solved = vector(coming.map(|_| ()));
        let vectors = [
            &mut w[..],
            &mut v,
            &mut a,
            &mut renewed,
            &mut inertia,
            &mut solved,
        ];
        let found = self.over_groups(
            vectors,
            |group, buffers, [state @ .., renewed, inertia, solved]| {
                let [dw, w, v, a, product, side, within_w, within_v, field] = buffers;
                let mut found = Found::default();
                self.increment_part(group, &increment, dw);
                let work = |load: Option<&[f64]>| load.map_or(0.0, |load| self.dot_with(group, load, dw));
                found.works = [work(acting.load), work(acting.inertia)];
                if let (Some(turning), Some(used)) = (turning, acting.inertia) {
                    self.within(group, old, dw, [&mut *within_w, &mut *within_v]);
                    self.space
                        .frame_part(turning, group, [&*within_w, &*within_v], field, side);
                    self.keep(side, renewed, &mut found.border[3]);
                    self.compare(group, side, used, &mut found);
                }
                self.advance(group, old, dw, [&mut *w, &mut *v, &mut *a]);
                let state: [_; 3] = state;
                let state = state.into_iter().zip([&*w, &*v, &*a]).zip(&mut found.border);
                state.for_each(|((out, x), border)| self.keep(x, out, border));
                found.energies =
                    self.balance(group, [&*w, &*v, &*a], [&mut *product, &mut *side, &mut *field]);
                if let Some(coming) = coming {
                    let rest = [side, within_w, within_v, field, product];
                    let outs = ([inertia, solved], &mut found.border);
                    self.predict_part(group, coming, [&*w, &*v, &*a], rest, outs);
                }
                found
            },
        );
        if coming.is_some() {
            self.solve_if_shared(&mut solved);
        }
        let mut state = RingState::new(w, v, a);
        state.keep(total(&found, |f| f.energies).map(|twice| 0.5 * twice));
        Ended {
            state,
            works: total(&found, |f| f.works),
            renewed: (renewed, self.change(&found)),
            next: coming.map(|_| Predicted { solved, inertia }),
        }
    }

    /// The answer of a ring in the state `state` to the known loads of a step from there.
    pub fn predict(&self, state: &RingState, coming: Coming<'_>) -> Predicted {
        let coming = (coming.load, self.turning(coming.turn));
        let n = state.displacement().len();
        let (mut inertia, mut solved) = (vec![0.0; coming.1.map_or(0, |_| n)], vec![0.0; n]);
        let vectors = [&mut [][..], &mut [], &mut [], &mut [], &mut inertia, &mut solved];
        self.over_groups(vectors, |group, buffers, [.., inertia, solved]| {
            let [_, w, v, a, product, side, within_w, within_v, field] = buffers;
            let mut found = Found::default();
            for (first, range) in self.pieces(group) {
                let from = first..first + range.len();
                w[range.clone()].copy_from_slice(&state.displacement()[from.clone()]);
                v[range.clone()].copy_from_slice(&state.velocity()[from.clone()]);
                a[range].copy_from_slice(&state.acceleration()[from]);
            }
            self.balance(group, [&*w, &*v, &*a], [&mut *product, &mut *side, &mut *field]);
            let rest = [side, within_w, within_v, field, product];
            let outs = ([inertia, solved], &mut found.border);
            self.predict_part(group, coming, [&*w, &*v, &*a], rest, outs);
            found
        });
        self.solve_if_shared(&mut solved);
        Predicted { solved, inertia }
    }

    /// The inertia of the turning frame that fits an increment, and the predictor with it in place of `used`.
    pub fn turn(
        &self,
        old: &RingState,
        increment: Increment<'_>,
        (turn, used): (FrameTurn, &[f64]),
        predictor: &[f64],
    ) -> Turned {
        let increment = self.whole_if_shared(increment);
        let turning = (turn, self.space.frame(self.nodes));
        let n = old.displacement().len();
        let [mut inertia, mut solved] = [(); 2].map(|()| vec![0.0; n]);
        let vectors = [&mut [][..], &mut [], &mut [], &mut inertia, &mut [], &mut solved];
        let found = self.over_groups(vectors, |group, buffers, [.., renewed, _, solved]| {
            let [dw, .., side, within_w, within_v, field] = buffers;
            let mut found = Found::default();
            self.increment_part(group, &increment, dw);
            self.within(group, old, dw, [&mut *within_w, &mut *within_v]);
            self.space
                .frame_part(turning, group, [&*within_w, &*within_v], field, side);
            self.keep(side, renewed, &mut found.border[3]);
            self.compare(group, side, used, &mut found);
            self.solve_part(group, side);
            if !self.factor.solver.is_shared() {
                self.add_part(group, predictor, side);
            }
            self.keep(side, solved, &mut found.border[5]);
            found
        });
        if self.factor.solver.is_shared() {
            self.factor.solve_in_place(&mut solved);
            super::vectors::add(&mut solved, predictor);
        }
        Turned {
            inertia,
            change: self.change(&found),
            predictor: solved,
        }
    }
}

/// Sums over the groups, in their order.
fn total(found: &[Found], of: impl Fn(&Found) -> [f64; 2]) -> [f64; 2] {
    found
        .iter()
        .map(of)
        .fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d])
}

mod group;
