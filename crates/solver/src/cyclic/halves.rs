//! Solves in two halves, between which loads on the nodes that trail come in.
//!
//! The motion of a raceway under known loads decides the contact forces, and these load the raceway alone. Of a ring
//! whose order ends with its raceway ([`super::CyclicRing::ending_with`]) the first half, which finishes the raceway,
//! is a forward sweep; contact forces cost a solve of the raceway's block; the second half is a backward sweep
//! ([`super::sweep`]). So known loads and contact forces take one solve, not two. The first group of harmonics, which
//! has the border, is solved in full by the first half, as is all of a ring in another order.

use std::marker::PhantomData;

use pulp::Arch;

use super::border::CyclicBordered;
use super::factor::{CyclicCholesky, Symmetry};
use super::number::{Form, Hermitian, Real};
use super::phases::LANES;
use super::ring::CyclicRing;
use super::sweep::{Solve, Sweeps};

impl CyclicBordered {
    /// Replaces one group's part of a right-hand side, `[low_len()]`, and in the first group the rows of the border,
    /// by its half solved form: final at the nodes that trail and in the border. Half solved vectors add up.
    ///
    /// # Panics
    /// When a length is another, or the group is another rank's.
    pub fn begin_group(&self, group: usize, low: &mut [f64], border: &mut [f64]) {
        self.halve_group(group, low, border, Sweeps::Begin);
    }

    /// The same of a right-hand side that is zero but at the nodes that trail, and in the first group anywhere.
    ///
    /// # Panics
    /// As [`CyclicBordered::begin_group`], and when it is not zero elsewhere.
    pub fn begin_trailing_group(&self, group: usize, low: &mut [f64], border: &mut [f64]) {
        let ring = self.inner().ring();
        let leading = 6 * LANES * ring.trailing(group);
        // All bits but that of the sign, in a form that the processor's vectors take.
        let bits = low[..leading].iter().fold(0, |all, x| all | (x.to_bits() << 1));
        assert_eq!(bits, 0, "loads on nodes that trail");
        self.halve_group(group, low, border, Sweeps::Trailing);
    }

    fn halve_group(
        &self,
        group: usize,
        low: &mut [f64],
        border: &mut [f64],
        sweeps: impl Fn(usize) -> Sweeps,
    ) {
        match self.inner().ring().trailing(group) {
            0 => self.solve_group(group, low, border),
            trailing => {
                assert!(border.is_empty(), "the border goes with the first group");
                self.inner().sweep(group, vec![low], sweeps(trailing));
            }
        }
    }

    /// Replaces one group's part of a half solved vector by the solution.
    ///
    /// # Panics
    /// When the length is another, or the group is another rank's.
    pub fn finish_group(&self, group: usize, low: &mut [f64]) {
        match self.inner().ring().trailing(group) {
            0 => {}
            trailing => self.inner().sweep(group, vec![low], Sweeps::Finish(trailing)),
        }
    }

    /// Replaces a right-hand side in harmonic space, `[harmonic_len()]`, and the rows of the border by its half
    /// solved form; collective where there is a border. The bits of [`CyclicBordered::begin_group`].
    ///
    /// # Panics
    /// When a length is another.
    pub fn begin_harmonic(&self, harmonics: &mut [f64], border: &mut [f64]) {
        self.halve_harmonic(harmonics, border, Sweeps::Begin);
    }

    /// The same of a right-hand side that is zero but at the nodes that trail, and in the first group anywhere. The
    /// bits of [`CyclicBordered::begin_trailing_group`].
    ///
    /// # Panics
    /// When a length is another.
    pub fn begin_trailing_harmonic(&self, harmonics: &mut [f64], border: &mut [f64]) {
        self.halve_harmonic(harmonics, border, Sweeps::Trailing);
    }

    fn halve_harmonic(
        &self,
        harmonics: &mut [f64],
        border: &mut [f64],
        sweeps: impl Fn(usize) -> Sweeps + Sync,
    ) {
        let ring = self.inner().ring();
        self.with_border(&mut [harmonics], border, |columns| {
            self.inner()
                .sweep_harmonic(columns, |group| match ring.trailing(group) {
                    0 => Sweeps::Whole,
                    trailing => sweeps(trailing),
                });
        });
    }

    /// Replaces a half solved vector, `[harmonic_len()]`, by the solution.
    ///
    /// # Panics
    /// When the length is another.
    pub fn finish_harmonic(&self, harmonics: &mut [f64]) {
        let ring = self.inner().ring();
        if ring.shared.trailing > 0 {
            self.inner()
                .sweep_harmonic(&mut [harmonics], |group| Sweeps::Finish(ring.trailing(group)));
        }
    }
}

impl CyclicCholesky {
    /// Solves one right-hand side for one group of this rank.
    pub(super) fn solve_one(&self, group: usize, column: &mut [f64]) {
        self.sweep(group, vec![column], Sweeps::Whole);
    }

    /// Does these sweeps for one group of this rank.
    pub(super) fn sweep(&self, group: usize, columns: Vec<&mut [f64]>, sweeps: Sweeps) {
        match self.symmetry() {
            Symmetry::Mirrored => self.sweep_form::<Real>(group, columns, sweeps),
            Symmetry::None => self.sweep_form::<Hermitian>(group, columns, sweeps),
        }
    }

    fn sweep_form<F: Form>(&self, group: usize, columns: Vec<&mut [f64]>, sweeps: Sweeps) {
        let (group_len, own) = (self.ring().factor_len::<F>(), self.ring().own_groups());
        let place = group.checked_sub(own.start).expect("a group of this rank");
        let values = &self.values[place * group_len..][..group_len];
        self.ring().sweep_group::<F>(values, columns, sweeps);
    }
}

impl CyclicRing {
    /// Does these sweeps with the factor `values` of a group, two vectors at a time.
    pub(super) fn sweep_group<F: Form>(&self, values: &[f64], columns: Vec<&mut [f64]>, sweeps: Sweeps) {
        let rows = &self.shared.rows;
        let (arch, form) = (Arch::new(), PhantomData);
        let mut columns = columns.into_iter();
        while let Some(first) = columns.next() {
            match columns.next() {
                Some(second) => arch.dispatch(Solve::<F, 2> {
                    rows,
                    values,
                    columns: [first, second],
                    sweeps,
                    form,
                }),
                None => arch.dispatch(Solve::<F, 1> {
                    rows,
                    values,
                    columns: [first],
                    sweeps,
                    form,
                }),
            }
        }
    }
}
