//! What a pass does with one group of harmonics. Vectors of a group are `[low_len()]`, in the first with the rows of
//! the border.

use solver::cyclic::PartHarmonics;

use super::super::space::FrameLoads;
use super::{Cow, FrameTurn, Increment, KnownLoad, Parts, Pass};
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

    /// The whole increment of a ring that ranks share.
    pub(super) fn whole_if_shared<'i>(&self, increment: Increment<'i>) -> Increment<'i> {
        match increment.forces {
            Some((loads, border)) if self.factor.solver.is_shared() => {
                let dw = self.factor.finish((loads, border), &increment.rest);
                Increment {
                    forces: None,
                    rest: Cow::Owned(dw),
                }
            }
            forces => Increment { forces, ..increment },
        }
    }

    /// The first half of S^-1 of a ring that ranks share.
    pub(super) fn begin_if_shared(&self, side: &mut [f64]) {
        if self.factor.solver.is_shared() {
            self.factor.begin_in_place(side);
        }
    }

    /// The first half of S^-1 of one group, but of a ring that ranks share.
    pub(super) fn begin_part(&self, group: usize, part: &mut [f64]) {
        if !self.factor.solver.is_shared() {
            let (harmonics, border) = part.split_at_mut(self.space.ring.low_len());
            self.factor.solver.begin_group(group, harmonics, border);
        }
    }

    /// The increment: the second half of S^-1 of the first half of forces and of the predictor `rest`; without forces
    /// `rest` itself.
    pub(super) fn increment_part(
        &self,
        group: usize,
        forces: &Option<(PartHarmonics<'_>, Vec<f64>)>,
        rest: &[f64],
        dw: &mut [f64],
    ) {
        let Some((loads, border)) = forces else {
            dw.copy_from_slice(rest);
            return;
        };
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

    /// M v and K w into `mv` and `kw`; twice the energies, that of K without the round-off of rigid motions.
    pub(super) fn products(&self, group: usize, [w, v]: [&[f64]; 2], [mv, kw]: [&mut [f64]; 2]) -> [f64; 2] {
        let space = self.space;
        space.mass.group_product(group, v, mv);
        space.stiffness.group_product(group, w, kw);
        let strained = space.strained_part(group, w);
        let strain = space.part_dot(group, &strained, kw) + space.residual_energy(group, w);
        [space.part_dot(group, v, mv), strain]
    }

    /// The first half of S^-1 of the known loads of the next step, M (m0 v + m1 a) + K (k0 v + k1 a - w) + load +
    /// inertia, into `solved`; `mv` and `kw` are the products of [`Pass::products`], and are overwritten.
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
