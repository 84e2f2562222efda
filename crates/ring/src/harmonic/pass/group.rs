//! What a pass does with one group of harmonics. Vectors of a group are `[low_len()]`, in the first with the rows of
//! the border.

use solver::cyclic::PartHarmonics;

use super::super::space::FrameLoads;
use super::{FrameTurn, KnownLoad, Parts, Pass};
use crate::state::within_part;
use crate::vectors::{add_part, combine_part};

/// A turning frame and what its inertia needs of the ring.
pub(super) type Turning<'a> = (FrameTurn, &'a FrameLoads);

/// Known loads of the next step by groups.
pub(super) type LoadParts<'a> = (Option<Parts<'a>>, Option<Turning<'a>>);

impl<'a> Pass<'a> {
    pub(super) fn turning(&self, turn: Option<FrameTurn>) -> Option<Turning<'a>> {
        turn.map(|turn| (turn, self.space.frame(self.nodes)))
    }

    pub(super) fn by_groups<'c>(&self, known: &'c KnownLoad) -> LoadParts<'c>
    where
        'a: 'c,
    {
        let load = known.load.as_deref().map(|load| self.space.parts(load));
        (load, self.turning(known.turn))
    }

    /// The first half of S^-1 of one group.
    pub(super) fn begin_part(&self, group: usize, part: &mut [f64]) {
        let (harmonics, border) = part.split_at_mut(self.space.ring.low_len());
        self.factor.solver.begin_group(group, harmonics, border);
    }

    /// The increment: the second half of S^-1 of the first half of forces and of the predictor `rest`.
    pub(super) fn increment_part(
        &self,
        group: usize,
        (loads, border): &(PartHarmonics<'_>, Vec<f64>),
        rest: &[f64],
        dw: &mut [f64],
    ) {
        dw.fill(0.0);
        let (harmonics, rows) = dw.split_at_mut(self.space.ring.low_len());
        loads.write_group(group, harmonics);
        rows.copy_from_slice(&border[..rows.len()]);
        self.factor.solver.begin_trailing_group(group, harmonics, rows);
        add_part(dw, rest);
        let low = self.space.ring.low_len();
        self.factor.solver.finish_group(group, &mut dw[..low]);
    }

    /// Inertia of the turning frame at the weighted time of a step from `[w, v, a]` with an increment, or at which
    /// the acceleration stays.
    pub(super) fn frame_part(
        &self,
        turning: Turning<'_>,
        group: usize,
        (start, dw): ([&[f64]; 3], Option<&[f64]>),
        field: &mut [f64],
        load: &mut [f64],
    ) {
        let motion = |first: usize, to: [&mut [f64]; 2]| {
            let range = first..first + to[0].len();
            let start = start.map(|x| &x[range.clone()]);
            within_part(self.scheme, dw.map(|dw| &dw[range]), start, to);
        };
        self.space.frame_part(turning, group, motion, field, load);
    }

    /// The first half of S^-1 of the known loads of the next step, M (m0 v + m1 a) + K (k0 v + k1 a - w) + load +
    /// inertia, into `solved`; `mv` and `kw` are M v and K w, and are overwritten.
    pub(super) fn predict_part(
        &self,
        group: usize,
        (load, turning): &LoadParts<'_>,
        [w, v, a]: [&[f64]; 3],
        [mv, kw, field]: [&mut [f64]; 3],
        [guess, solved]: [&mut [f64]; 2],
    ) {
        let ([m, k], space) = (self.history, self.space);
        let mut of_mass = m[0];
        if m[1] != 0.0 {
            combine_part(m, [v, a], field);
            space.mass.group_product(group, field, mv);
            of_mass = 1.0;
        }
        combine_part([of_mass, -1.0], [mv, kw], solved);
        if k != [0.0; 2] {
            combine_part(k, [v, a], field);
            space.stiffness.group_product(group, field, kw);
            add_part(solved, kw);
        }
        if let Some(load) = load {
            add_part(solved, load.of(group));
        }
        if let Some(turning) = turning {
            // First guess: the acceleration stays.
            self.frame_part(*turning, group, ([w, v, a], None), field, guess);
            add_part(solved, guess);
        }
        self.begin_part(group, solved);
    }

    /// The difference of a new load from the one used; the squares of both.
    pub(super) fn compare(&self, group: usize, [new, used]: [&[f64]; 2], difference: &mut [f64]) -> [f64; 2] {
        combine_part([1.0, -1.0], [new, used], difference);
        [&*difference, new].map(|x| self.space.part_dot(group, x, x))
    }
}
