//! Vectors of a ring by groups of harmonics, each group's part one slice: the first with the rows of the border, of
//! which there is a copy. Of a ring that ranks share, each has its own groups, and all have the rows of the border.

use rayon::prelude::*;

use super::super::space::HarmonicSpace;

/// A vector that is read.
pub(in super::super) struct Parts<'a> {
    own: &'a [f64],
    /// The first group with the border; empty where another rank has it.
    first: Vec<f64>,
    /// The first of the own groups.
    start: usize,
    low: usize,
}

impl Parts<'_> {
    /// The part of a group.
    pub fn of(&self, group: usize) -> &[f64] {
        match group {
            0 => &self.first,
            _ => &self.own[self.low * (group - self.start)..][..self.low],
        }
    }
}

impl HarmonicSpace {
    /// A vector by groups.
    pub(in super::super) fn parts<'a>(&self, own: &'a [f64]) -> Parts<'a> {
        Parts {
            first: match self.ring.has_first_group() {
                true => self.low_of(own),
                false => Vec::new(),
            },
            own,
            start: self.ring.own_groups().start,
            low: self.ring.low_len(),
        }
    }

    /// Does `work` for each group of this rank, given by its number, with B buffers of its length and with its parts of
    /// the vectors that are written; of empty vectors they are empty. Returns the sums over all groups of what it
    /// returns. Collective.
    pub(in super::super) fn over_groups<const W: usize, const B: usize, const K: usize>(
        &self,
        mut vectors: [&mut [f64]; W],
        work: impl Fn(usize, [&mut [f64]; B], [&mut [f64]; W]) -> [f64; K] + Sync,
    ) -> [f64; K] {
        let (low, groups) = (self.ring.low_len(), self.ring.own_groups());
        let (first_len, n_first) = (self.part_len(0), usize::from(self.ring.has_first_group()));
        let written = |x: &[f64]| if x.is_empty() { 0 } else { first_len };
        let mut first = vectors.each_ref().map(|x| vec![0.0; written(x)]);
        let mut outs: Vec<[&mut [f64]; W]> = Vec::with_capacity(groups.len());
        outs.resize_with(groups.len(), || [(); W].map(|()| Default::default()));
        for (which, vector) in vectors.iter_mut().enumerate() {
            let parts = outs.iter_mut().zip(vector.chunks_exact_mut(low.max(1)));
            parts.skip(n_first).for_each(|(out, part)| out[which] = part);
        }
        if n_first > 0 {
            outs[0] = first.each_mut().map(Vec::as_mut_slice);
        }
        let found: Vec<[f64; K]> = outs
            .into_par_iter()
            .zip(groups)
            .map_init(
                || [(); B].map(|()| vec![0.0; first_len]),
                |buffers, (out, group)| {
                    let len = self.part_len(group);
                    work(group, buffers.each_mut().map(|b| &mut b[..len]), out)
                },
            )
            .collect();
        let written = vectors.into_iter().zip(&first).filter(|(x, _)| !x.is_empty());
        self.put_first(written);
        self.ring.sum_groups(&found)
    }

    /// Puts first groups with the border, which only their rank knows, into vectors; all ranks get the border.
    fn put_first<'a>(&self, written: impl Iterator<Item = (&'a mut [f64], &'a Vec<f64>)>) {
        let (low, len) = (self.ring.low_len(), self.ring.harmonic_len());
        let (mut vectors, mut border) = (Vec::new(), Vec::new());
        for (vector, first) in written {
            let (harmonics, rows) = first.split_at(low);
            if self.ring.has_first_group() {
                vector[..low].copy_from_slice(harmonics);
            }
            border.extend_from_slice(rows);
            vectors.push(&mut vector[len..]);
        }
        self.ring.share_first(&mut border);
        let rows = border.chunks_exact(self.n_shaft.max(1));
        vectors
            .into_iter()
            .zip(rows)
            .for_each(|(to, rows)| to.copy_from_slice(rows));
    }
}
