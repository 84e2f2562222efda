//! Vectors of a ring by groups of harmonics, each group's part one slice: the first with the rows of the border, of
//! which there is a copy.

use rayon::prelude::*;

use super::super::space::HarmonicSpace;

/// A vector that is read.
pub(in super::super) struct Parts<'a> {
    whole: &'a [f64],
    /// The first group with the border.
    first: Vec<f64>,
    low: usize,
}

impl Parts<'_> {
    /// The part of a group.
    pub fn of(&self, group: usize) -> &[f64] {
        match group {
            0 => &self.first,
            _ => &self.whole[self.low * group..][..self.low],
        }
    }
}

impl HarmonicSpace {
    /// A vector by groups.
    pub(in super::super) fn parts<'a>(&self, whole: &'a [f64]) -> Parts<'a> {
        let (low, len) = (self.ring.low_len(), self.ring.harmonic_len());
        Parts {
            first: [&whole[..low], &whole[len..]].concat(),
            whole,
            low,
        }
    }

    /// Does `work` for each group, given by its number, with B buffers of its length and with its parts of the
    /// vectors that are written; of empty vectors they are empty. What it returns comes in the order of the groups.
    pub(in super::super) fn over_groups<const W: usize, const B: usize, T: Send>(
        &self,
        mut vectors: [&mut [f64]; W],
        work: impl Fn(usize, [&mut [f64]; B], [&mut [f64]; W]) -> T + Sync,
    ) -> Vec<T> {
        let (low, len) = (self.ring.low_len(), self.ring.harmonic_len());
        let n_groups = len.checked_div(low).unwrap_or(0);
        let first_len = self.part_len(0);
        let mut first = vectors.each_ref().map(|x| vec![0.0; first_len.min(x.len())]);
        let mut outs: Vec<[&mut [f64]; W]> = Vec::with_capacity(n_groups);
        outs.push(first.each_mut().map(Vec::as_mut_slice));
        outs.resize_with(n_groups, || [(); W].map(|()| Default::default()));
        for (which, vector) in vectors.iter_mut().enumerate() {
            let parts = outs.iter_mut().zip(vector.chunks_exact_mut(low.max(1)));
            parts.skip(1).for_each(|(out, part)| out[which] = part);
        }
        let found = outs
            .into_par_iter()
            .enumerate()
            .map_init(
                || [(); B].map(|()| vec![0.0; first_len]),
                |buffers, (group, out)| {
                    let len = self.part_len(group);
                    work(group, buffers.each_mut().map(|b| &mut b[..len]), out)
                },
            )
            .collect();
        let written = vectors.into_iter().zip(&first).filter(|(x, _)| !x.is_empty());
        for (vector, first) in written {
            vector[..low].copy_from_slice(&first[..low]);
            vector[len..].copy_from_slice(&first[low..]);
        }
        found
    }
}
