//! What a pass does with one group of harmonics. Vectors of a group are `[low_len()]`, in the first with the rows of the border.

use std::ops::Range;

use rayon::prelude::*;

use super::{Buffers, Change, Found, FrameLoads, FrameTurn, Increment, Pass, RingState, Written};
use super::{advance_part, total, within_part};
use crate::solution::dot;

/// A turning frame and what its inertia needs of the ring.
pub(super) type Turning<'a> = (FrameTurn, &'a FrameLoads);

impl Buffers {
    /// All of one length.
    pub(super) fn of(&mut self, len: usize) -> [&mut [f64]; 9] {
        self.0.each_mut().map(|buffer| &mut buffer[..len])
    }
}

impl<'a> Pass<'a> {
    pub(super) fn turning(&self, turn: Option<FrameTurn>) -> Option<Turning<'a>> {
        turn.map(|turn| (turn, self.space.frame(self.nodes)))
    }

    fn buffers(&self) -> Buffers {
        let len = self.space.ring.low_len() + self.space.n_shaft;
        Buffers([(); 9].map(|()| vec![0.0; len]))
    }

    fn n_groups(&self) -> usize {
        let ring = &self.space.ring;
        ring.harmonic_len().checked_div(ring.low_len()).unwrap_or(0)
    }

    fn part_len(&self, group: usize) -> usize {
        self.space.part_len(group)
    }

    /// Where the pieces of a group begin in a vector, and where they are in its part: harmonics, and in the first group the border.
    pub(super) fn pieces(&self, group: usize) -> impl Iterator<Item = (usize, Range<usize>)> + use<> {
        let (low, len) = (self.space.ring.low_len(), self.space.ring.harmonic_len());
        let border = (group == 0).then(|| (len, low..low + self.space.n_shaft));
        [(low * group, 0..low)].into_iter().chain(border)
    }

    /// Does `work` for each group, given by its number, with buffers for its vectors and with its parts of the vectors that are written,
    /// and completes these by the rows of the border, which the first group has found.
    pub(super) fn over_groups(
        &self,
        mut vectors: Written<'_>,
        work: impl Fn(usize, [&mut [f64]; 9], Written<'_>) -> Found + Sync,
    ) -> Vec<Found> {
        let low = self.space.ring.low_len().max(1);
        let mut outs: Vec<Written<'_>> = (0..self.n_groups()).map(|_| Written::default()).collect();
        for (which, vector) in vectors.iter_mut().enumerate() {
            let parts = outs.iter_mut().zip(vector.chunks_exact_mut(low));
            parts.for_each(|(out, part)| out[which] = part);
        }
        let found: Vec<Found> = outs
            .into_par_iter()
            .enumerate()
            .map_init(
                || self.buffers(),
                |buffers, (group, out)| work(group, buffers.of(self.part_len(group)), out),
            )
            .collect();
        if let Some(first) = found.first() {
            for (vector, rows) in vectors.into_iter().zip(&first.border) {
                if !vector.is_empty() {
                    vector[self.space.ring.harmonic_len()..].copy_from_slice(rows);
                }
            }
        }
        found
    }

    /// Writes a group's part where it is wanted.
    pub(super) fn keep(&self, part: &[f64], out: &mut [f64], border: &mut Vec<f64>) {
        if !out.is_empty() {
            let (harmonics, rows) = part.split_at(out.len());
            out.copy_from_slice(harmonics);
            *border = rows.to_vec();
        }
    }

    /// The whole increment of a ring that ranks share.
    pub(super) fn whole_if_shared<'i>(&self, increment: Increment<'i>) -> Increment<'i> {
        match increment {
            Increment::Forces {
                loads,
                border,
                predictor,
            } if self.factor.solver.is_shared() => {
                let mut dw = vec![0.0; predictor.len()];
                let (harmonics, rows) = dw.split_at_mut(self.space.ring.harmonic_len());
                loads.write(harmonics);
                rows.copy_from_slice(&border);
                self.factor.solve_in_place(&mut dw);
                crate::motion::vectors::add(&mut dw, predictor);
                Increment::Found(dw)
            }
            other => other,
        }
    }

    pub(super) fn solve_if_shared(&self, side: &mut [f64]) {
        if self.factor.solver.is_shared() {
            self.factor.solve_in_place(side);
        }
    }

    /// S^-1 of one group, but of a ring that ranks share.
    pub(super) fn solve_part(&self, group: usize, part: &mut [f64]) {
        if !self.factor.solver.is_shared() {
            let (harmonics, border) = part.split_at_mut(self.space.ring.low_len());
            self.factor.solver.solve_group(group, harmonics, border);
        }
    }

    pub(super) fn add_part(&self, group: usize, x: &[f64], part: &mut [f64]) {
        for (first, range) in self.pieces(group) {
            let terms = part[range].iter_mut().zip(&x[first..]);
            terms.for_each(|(part, x)| *part += x);
        }
    }

    pub(super) fn increment_part(&self, group: usize, increment: &Increment<'_>, dw: &mut [f64]) {
        dw.fill(0.0);
        match increment {
            Increment::Forces {
                loads,
                border,
                predictor,
            } => {
                let (harmonics, rows) = dw.split_at_mut(self.space.ring.low_len());
                loads.write_group(group, harmonics);
                rows.copy_from_slice(&border[..rows.len()]);
                self.solve_part(group, dw);
                self.add_part(group, predictor, dw);
            }
            Increment::Found(whole) => self.add_part(group, whole, dw),
        }
    }

    /// Scalar product of one group's part of the vector x with the part y.
    pub(super) fn dot_with(&self, group: usize, x: &[f64], y: &[f64]) -> f64 {
        let mut pieces = self.pieces(group);
        let (first, range) = pieces.next().expect("a group has harmonics");
        let low = self
            .space
            .ring
            .group_dot(group, &x[first..first + range.len()], &y[range]);
        pieces.fold(low, |sum, (first, range)| {
            sum + dot(&x[first..first + range.len()], &y[range])
        })
    }

    /// Displacement and velocity at the weighted time of a step with the increment `dw`.
    pub(super) fn within(&self, group: usize, old: &RingState, dw: &[f64], [w, v]: [&mut [f64]; 2]) {
        for (first, range) in self.pieces(group) {
            let part = old.part(first, range.len());
            let to = [&mut w[range.clone()], &mut v[range.clone()]];
            within_part(self.integrator, self.dt, Some(&dw[range]), part, to);
        }
    }

    /// State at the end of a step with the increment `dw`.
    pub(super) fn advance(&self, group: usize, old: &RingState, dw: &[f64], [w, v, a]: [&mut [f64]; 3]) {
        for (first, range) in self.pieces(group) {
            let part = old.part(first, range.len());
            let to = [
                &mut w[range.clone()],
                &mut v[range.clone()],
                &mut a[range.clone()],
            ];
            advance_part(self.integrator, self.dt, &dw[range], part, to);
        }
    }

    /// M (m0 v + m1 a) + K (k0 v + k1 a - w), into `side`; twice the energies.
    pub(super) fn balance(
        &self,
        group: usize,
        [w, v, a]: [&[f64]; 3],
        [product, side, mixed]: [&mut [f64]; 3],
    ) -> [f64; 2] {
        let ([m, k], space) = (self.history, self.space);
        space.mass.group_product(group, v, product);
        let kinetic = space.part_dot(group, v, product);
        side.iter_mut().zip(&*product).for_each(|(s, p)| *s = m[0] * p);
        space.stiffness.group_product(group, w, product);
        let strain = space.part_dot(group, w, product);
        if m[1] == 0.0 && k == [0.0; 2] {
            side.iter_mut().zip(&*product).for_each(|(s, p)| *s -= p);
            return [kinetic, strain];
        }
        let terms = mixed.iter_mut().zip(v.iter().zip(a));
        terms.for_each(|(x, (v, a))| *x = m[0] * v + m[1] * a);
        space.mass.group_product(group, mixed, side);
        let terms = mixed.iter_mut().zip(w.iter().zip(v.iter().zip(a)));
        terms.for_each(|(x, (w, (v, a)))| *x = k[0] * v + k[1] * a - w);
        space.stiffness.group_product(group, mixed, product);
        side.iter_mut().zip(&*product).for_each(|(s, p)| *s += p);
        [kinetic, strain]
    }

    /// Adds the known loads of the next step to its balance `side` and solves.
    pub(super) fn predict_part(
        &self,
        group: usize,
        (load, turning): (Option<&[f64]>, Option<Turning<'_>>),
        [w, v, a]: [&[f64]; 3],
        [side, within_w, within_v, field, guess]: [&mut [f64]; 5],
        ([inertia, solved], border): ([&mut [f64]; 2], &mut [Vec<f64>; 6]),
    ) {
        if let Some(load) = load {
            self.add_part(group, load, side);
        }
        if let Some(turning) = turning {
            // First guess: the velocity stays.
            within_part(
                self.integrator,
                self.dt,
                None,
                [w, v, a],
                [&mut *within_w, &mut *within_v],
            );
            self.space
                .frame_part(turning, group, [&*within_w, &*within_v], field, guess);
            side.iter_mut().zip(&*guess).for_each(|(s, f)| *s += f);
            self.keep(guess, inertia, &mut border[4]);
        }
        self.solve_part(group, side);
        self.keep(side, solved, &mut border[5]);
    }

    /// Replaces a new load by its difference from the one `used`, and adds both to the sums.
    pub(super) fn compare(&self, group: usize, new: &mut [f64], used: &[f64], found: &mut Found) {
        found.squares[1] = self.space.part_dot(group, new, new);
        for (first, range) in self.pieces(group) {
            let terms = new[range].iter_mut().zip(&used[first..]);
            terms.for_each(|(new, used)| *new -= used);
        }
        found.squares[0] = self.space.part_dot(group, new, new);
        let low = self.space.ring.low_len();
        found.lines = self.space.ring.line_squares(group, &new[..low]);
        found.rows = new[low..].iter().map(|x| x.abs()).sum();
    }

    /// The change that all groups make.
    pub(super) fn change(&self, found: &[Found]) -> Change {
        let [square, new_square] = total(found, |f| f.squares);
        let mut lines = vec![[0.0; 2]; self.space.ring.n_section_nodes()];
        for group in found {
            for (sum, part) in lines.iter_mut().zip(&group.lines) {
                (0..2).for_each(|i| sum[i] += part[i]);
            }
        }
        // Of n numbers with the sum of squares s the sum of magnitudes is at most the root of n s. In the plane it holds for the
        // lengths of n vectors, whose components have at most root 2 times their length.
        let n = self.space.ring.n_sectors() as f64;
        let bound = lines
            .iter()
            .map(|[plane, axial]| (2.0 * n * plane).sqrt() + (n * axial).sqrt());
        Change {
            square,
            bound: bound.sum::<f64>() + found.first().map_or(0.0, |first| first.rows),
            new_square,
        }
    }
}
