//! One pass over the harmonics of a periodic ring: the end of a step, and the half of a solve that the next one
//! begins with.
//!
//! Between the contact forces of a step and the motion of the raceway under the known loads of the next, no harmonic
//! meets another. So one group of harmonics after the other goes all the way while it is in the cache, and its factor
//! is read from memory once:
//! ```text
//! dw = second half of S^-1 of predictor + first half of (forces of contacts and partner)
//! w, v, a at the end; M v, K w, energies; work of the loads
//! predictor of the next step = first half of S^-1 (its known loads - K w + M (history))
//! ```
//! The first half is a forward sweep, after which raceway and mount have moved as they do under these loads alone;
//! forces on them take a solve of their own block, and the second half is a backward sweep ([`solver::cyclic`]). So a
//! step takes one solve of a ring. The rows of the border go with the first group ([`parts`]). Sums over the groups
//! are taken in their order. A predictor that is found on its own ([`Pass::predict`]: at the start, after a change of
//! the step size, after a step file) comes from the same functions and has the same bits. Ranks that share a ring pass
//! over their own groups each, and exchange sums and the border.

use solver::cyclic::PartHarmonics;

use super::factor::CyclicFactor;
use super::space::HarmonicSpace;
use crate::integrator::StepScheme;
use crate::matrices::Nodes;
use crate::pool::PooledVector;
use crate::settling::LoadChange;
use crate::state::{RingState, RowValues, advance_part};
use crate::step::{FrameTurn, KnownLoad};
use crate::vectors;
use parts::Parts;

/// A ring and its scheme.
#[derive(Clone, Copy)]
pub(super) struct Pass<'a> {
    pub space: &'a HarmonicSpace,
    pub nodes: Nodes<'a>,
    pub factor: &'a CyclicFactor,
    pub scheme: StepScheme,
    /// Factors of v and a under M, and under K, on the right-hand side.
    pub history: [[f64; 2]; 2],
}

/// The increment of a step.
pub(super) struct Increment<'a> {
    /// Loads on touched nodes, and on the border.
    pub forces: (PartHarmonics<'a>, Vec<f64>),
    /// The predictor, of which and of the forces the increment is the second half: harmonics and border.
    pub rest: &'a [f64],
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

/// The answer of a ring to known loads.
pub(super) struct Predicted {
    /// The first half of S^-1 of the right-hand side: the motion of touched nodes and border.
    pub solved: PooledVector,
    /// First guess of the inertia of the turning frame; empty without one.
    pub inertia: PooledVector,
}

/// The end of a step.
pub(super) struct PassEnd {
    pub state: RingState,
    /// Kinetic and strain energy, J.
    pub energies: [f64; 2],
    /// Values on the rows of a defect.
    pub rows: Option<RowValues>,
    /// Work of the load and of the inertia of the frame, J.
    pub works: [f64; 2],
    /// Inertia that fits the increment, and its difference from that which acted.
    pub renewed: (PooledVector, LoadChange),
    pub next: Option<Predicted>,
}

/// The increment of a step as the inertia of the turning frame meets it.
pub(super) struct Turned {
    /// Inertia that fits it.
    pub inertia: PooledVector,
    pub change: LoadChange,
    /// The predictor under the new inertia.
    pub predictor: PooledVector,
    /// The increment on the rows of a defect.
    pub rows: Option<Vec<f64>>,
}

impl Pass<'_> {
    /// Ends a step from `old`; with `next`, finds the predictor of the next under these loads. Collective, as all
    /// passes are.
    pub fn end(
        &self,
        old: &RingState,
        increment: Increment<'_>,
        acting: Acting<'_>,
        next: Option<&KnownLoad>,
    ) -> PassEnd {
        let (space, pool) = (self.space, &self.space.pool);
        let Increment { forces, rest } = increment;
        let rest = space.parts(rest);
        let turning = self.turning(acting.turn);
        let [load, inertia] = [acting.load, acting.inertia].map(|x| x.map(|x| space.parts(x)));
        let next = next.map(|next| self.by_groups(next));
        let start = old.vectors().map(|x| space.parts(x));
        let [mut w, mut v, mut a] = [(); 3].map(|()| pool.take());
        let mut renewed = pool.take_if(turning);
        let mut guess = pool.take_if(next.as_ref().and_then(|next| next.1));
        let mut solved = pool.take_if(next.as_ref());
        let vectors = [&mut w, &mut v, &mut a, &mut renewed, &mut guess, &mut solved].map(|x| &mut x[..]);
        let found = space.over_groups(
            vectors,
            |group, [dw, mv, kw, field], [w, v, a, renewed, guess, solved]| {
                let start = start.each_ref().map(|x| x.of(group));
                self.increment_part(group, &forces, rest.of(group), dw);
                let end = [&mut *w, &mut *v, &mut *a];
                advance_part(self.scheme, dw, start, end);
                let dot = |load: &Parts<'_>| space.part_dot(group, load.of(group), dw);
                let [by_load, by_frame] = [&load, &inertia].map(|load| load.as_ref().map_or(0.0, dot));
                let mut squares = [0.0; 2];
                if let (Some(turning), Some(used)) = (turning, &inertia) {
                    self.frame_part(turning, group, (start, Some(dw)), field, renewed);
                    squares = self.compare(group, [renewed, used.of(group)], field);
                }
                let [kinetic, strain] = space.products(group, [w, v], [&mut *mv, &mut *kw]);
                if let Some(next) = &next {
                    self.predict_part(group, next, [w, v, a], [mv, kw, field], [guess, solved]);
                }
                [kinetic, strain, by_load, by_frame, squares[0], squares[1]]
            },
        );
        let [kinetic, strain, by_load, by_frame, square, new_square] = found;
        let state = RingState::new(w, v, a);
        let rows = space.defect.as_ref().map(|defect| defect.of_state(&state));
        PassEnd {
            energies: space.with_defect(&state, [0.5 * kinetic, 0.5 * strain], rows.as_ref()),
            state,
            rows,
            works: [by_load, by_frame],
            renewed: (renewed, LoadChange { square, new_square }),
            next: next.map(|_| Predicted {
                solved,
                inertia: guess,
            }),
        }
    }

    /// The answer of a ring in the state `state` to the known loads of a step from there.
    pub fn predict(&self, state: &RingState, load: &KnownLoad) -> Predicted {
        let (space, pool) = (self.space, &self.space.pool);
        let load = self.by_groups(load);
        let state = state.vectors().map(|x| space.parts(x));
        let (mut inertia, mut solved) = (pool.take_if(load.1), pool.take());
        let vectors = [&mut inertia, &mut solved].map(|x| &mut x[..]);
        space.over_groups(vectors, |group, [mv, kw, field], outs| {
            let [w, v, a] = state.each_ref().map(|x| x.of(group));
            space.products(group, [w, v], [&mut *mv, &mut *kw]);
            self.predict_part(group, &load, [w, v, a], [mv, kw, field], outs);
            []
        });
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
        let (space, pool) = (self.space, &self.space.pool);
        let Increment { forces, rest } = increment;
        let rest = space.parts(rest);
        let turning = (turn, space.frame(self.nodes));
        let [used, before] = [used, predictor].map(|x| space.parts(x));
        let start = old.vectors().map(|x| space.parts(x));
        let [mut inertia, mut solved] = [(); 2].map(|()| pool.take());
        let mut whole = pool.take_if(space.defect.as_ref());
        let vectors = [&mut inertia, &mut solved, &mut whole].map(|x| &mut x[..]);
        let [square, new_square] =
            space.over_groups(vectors, |group, [dw, field], [renewed, solved, whole]| {
                let start = start.each_ref().map(|x| x.of(group));
                self.increment_part(group, &forces, rest.of(group), dw);
                if !whole.is_empty() {
                    whole.copy_from_slice(dw);
                }
                self.frame_part(turning, group, (start, Some(dw)), field, renewed);
                let squares = self.compare(group, [renewed, used.of(group)], solved);
                self.begin_part(group, solved);
                vectors::add_part(solved, before.of(group));
                squares
            });
        Turned {
            inertia,
            change: LoadChange { square, new_square },
            predictor: solved,
            rows: space.defect.as_ref().map(|defect| defect.values(&whole)),
        }
    }
}

mod group;
mod parts;
