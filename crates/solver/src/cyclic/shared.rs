//! A ring whose harmonics ranks share: each has the groups of its own of a vector in harmonic space, and what they
//! exchange.
//!
//! No harmonic meets another but at the nodes: matrices and solves need no message. Sums over the groups, what the
//! border gives the first group, and fields at nodes do, and are collective. A field at the nodes of a part of the
//! section, such as a raceway, needs the harmonics of these nodes alone. Sums are taken in the order of the groups, so
//! that bits do not depend on the ranks.

use std::borrow::Cow;
use std::ops::Range;

use comm::Communicator;
use fft::num_complex::Complex;

use super::phases::{LANES, NODE_LEN};
use super::ring::CyclicRing;

/// The harmonics of a vector at some places, of all groups.
pub(super) struct AtPlaces<'a> {
    numbers: Cow<'a, [f64]>,
    /// Numbers of one group.
    group_len: usize,
    /// Whether `numbers` has these places alone.
    is_packed: bool,
}

impl AtPlaces<'_> {
    /// Harmonic k of a component at the i-th of the places, which is `place` in the section.
    pub(super) fn harmonic(&self, k: usize, (i, place): (usize, usize), component: usize) -> Complex<f64> {
        let node = if self.is_packed { i } else { place };
        let start = (k / LANES) * self.group_len + 2 * LANES * (3 * node + component) + k % LANES;
        Complex::new(self.numbers[start], self.numbers[start + LANES])
    }
}

impl CyclicRing {
    /// Whether ranks share its harmonics.
    pub fn is_shared(&self) -> bool {
        self.comm.size() > 1
    }

    /// The same ring with all harmonics on this rank.
    pub fn alone(&self) -> CyclicRing {
        self.clone().shared_by(Communicator::Serial)
    }

    /// Whether the first group of harmonics is on this rank.
    pub fn has_first_group(&self) -> bool {
        self.own_groups().contains(&0)
    }

    /// Where the harmonics of this rank are in a vector of all.
    pub fn own_harmonics(&self) -> Range<usize> {
        let Range { start, end } = self.own_groups();
        start * self.group_len()..end * self.group_len()
    }

    /// Sums over all groups, in their order, of the terms of this rank's groups. Collective.
    pub fn sum_groups<const K: usize>(&self, own: &[[f64; K]]) -> [f64; K] {
        let all = self.of_all_groups(own.as_flattened(), K);
        let terms = all.chunks_exact(K.max(1));
        terms.fold([0.0; K], |sum, term| std::array::from_fn(|i| sum[i] + term[i]))
    }

    /// Overwrites numbers that only the rank of the first group knows, on all ranks. Collective.
    pub fn share_first(&self, numbers: &mut [f64]) {
        if !self.is_shared() || numbers.is_empty() {
            return;
        }
        let shares = self.comm.shares(self.shared.phases.n_groups());
        let length = |share: &Range<usize>| if share.contains(&0) { numbers.len() } else { 0 };
        let lengths: Vec<usize> = shares.iter().map(length).collect();
        let own = if self.has_first_group() {
            numbers.to_vec()
        } else {
            Vec::new()
        };
        numbers.copy_from_slice(&self.comm.all_gather(own, &lengths));
    }

    /// The harmonics of all ranks, `[whole_len()]`, on rank 0; None on others. Collective.
    pub fn to_root(&self, harmonic: &[f64]) -> Option<Vec<f64>> {
        let shares = self.comm.shares(self.shared.phases.n_groups());
        let mut whole = self.comm.is_root().then(|| Vec::with_capacity(self.whole_len()));
        for (rank, share) in shares.iter().enumerate() {
            let own = if rank == self.comm.rank() {
                harmonic.to_vec()
            } else {
                Vec::new()
            };
            let part = self.comm.to_root(rank, own, share.len() * self.group_len());
            if let (Some(whole), Some(part)) = (&mut whole, part) {
                whole.extend(part);
            }
        }
        whole
    }

    /// The harmonics of `harmonic`, `[harmonic_len()]`, at some places, of all groups. Collective.
    pub(super) fn at_places<'a>(&self, places: &[usize], harmonic: &'a [f64]) -> AtPlaces<'a> {
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        if !self.is_shared() {
            return AtPlaces {
                numbers: Cow::Borrowed(harmonic),
                group_len: self.group_len(),
                is_packed: false,
            };
        }
        let node = |group: &'a [f64], place: usize| &group[NODE_LEN * place..][..NODE_LEN];
        let mut packed = Vec::with_capacity(NODE_LEN * places.len() * self.own_groups().len());
        for group in harmonic.chunks_exact(self.group_len().max(1)) {
            places
                .iter()
                .for_each(|&place| packed.extend_from_slice(node(group, place)));
        }
        let group_len = NODE_LEN * places.len();
        AtPlaces {
            numbers: Cow::Owned(self.of_all_groups(&packed, group_len).into_owned()),
            group_len,
            is_packed: true,
        }
    }

    /// The `len` numbers of each group, of all of them in their order. Collective.
    fn of_all_groups<'a>(&self, own: &'a [f64], len: usize) -> Cow<'a, [f64]> {
        if !self.is_shared() {
            return Cow::Borrowed(own);
        }
        let shares = self.comm.shares(self.shared.phases.n_groups());
        let lengths: Vec<usize> = shares.iter().map(|share| len * share.len()).collect();
        Cow::Owned(self.comm.all_gather(own.to_vec(), &lengths))
    }
}
