//! The factor of the interface by cyclic reduction, and its solution: see [`super::reduction`].

use comm::Communicator;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::layout::SectorLayout;
use super::reduction::{OwnInterface, Reduction, Step, starts};
use crate::error::SolverError;

/// The factor: its analysis, and what a rank holds of it.
#[derive(Debug)]
pub(super) struct ReducedFactor {
    reduction: Reduction,
    own: OwnInterface,
}

impl ReducedFactor {
    /// Factors the sum of the complements of all sectors, of which those of the sectors owned are given. Collective.
    pub(super) fn new(
        reduction: &Reduction,
        layout: &SectorLayout,
        comm: Communicator,
        complements: Vec<Vec<f64>>,
    ) -> Result<ReducedFactor, SolverError> {
        Ok(ReducedFactor {
            own: reduction.eliminated(layout, comm, complements)?,
            reduction: reduction.clone(),
        })
    }

    /// Bytes of the factor.
    pub(super) fn bytes(&self) -> usize {
        let all = self.own.triangles.values().chain(self.own.couplings.values());
        size_of::<f64>() * all.map(|m| m.nrows() * m.ncols()).sum::<usize>()
    }

    /// Solves in place, row-major `[places][n_rhs]`, the same on all ranks. Collective.
    pub(super) fn solve(&self, comm: Communicator, x: &mut [f64], n_rhs: usize) {
        if n_rhs == 0 {
            return;
        }
        for level in &self.reduction.levels {
            let found = self.on_own(level, |step| self.forward(step, x, n_rhs));
            let lengths = |step: &Step| {
                let below = step.neighbours.iter().map(|&a| self.reduction.rows(a));
                n_rhs * (self.reduction.rows(step.section) + below.sum::<usize>())
            };
            self.gather(comm, level, found, lengths, |step, values| {
                let (own, mut rest) = values.split_at(n_rhs * self.reduction.rows(step.section));
                self.of(x, step.section, n_rhs).copy_from_slice(own);
                for &a in &step.neighbours {
                    let target = self.of(x, a, n_rhs);
                    let (change, others) = rest.split_at(target.len());
                    target.iter_mut().zip(change).for_each(|(x, change)| *x -= change);
                    rest = others;
                }
            });
        }
        for level in self.reduction.levels.iter().rev() {
            let found = self.on_own(level, |step| self.backward(step, x, n_rhs));
            let lengths = |step: &Step| n_rhs * self.reduction.rows(step.section);
            self.gather(comm, level, found, lengths, |step, values| {
                self.of(x, step.section, n_rhs).copy_from_slice(values);
            });
        }
    }

    /// y_k, then the products of all W with it.
    fn forward(&self, step: &Step, x: &[f64], n_rhs: usize) -> Vec<f64> {
        let k = step.section;
        let mut result = self.values(x, k, n_rhs).to_vec();
        let y = MatMut::from_row_major_slice_mut(&mut result, self.reduction.rows(k), n_rhs);
        solve_lower_triangular_in_place(self.own.triangles[&k].as_ref(), y, Par::Seq);
        for &a in &step.neighbours {
            let (first, rows) = (result.len(), self.reduction.rows(a));
            result.resize(first + n_rhs * rows, 0.0);
            let (y, product) = result.split_at_mut(first);
            let y = MatRef::from_row_major_slice(
                &y[..n_rhs * self.reduction.rows(k)],
                self.reduction.rows(k),
                n_rhs,
            );
            let product = MatMut::from_row_major_slice_mut(product, rows, n_rhs);
            matmul(
                product,
                Accum::Replace,
                self.own.couplings[&[a, k]].as_ref(),
                y,
                1.0,
                Par::Seq,
            );
        }
        result
    }

    /// x_k.
    fn backward(&self, step: &Step, x: &[f64], n_rhs: usize) -> Vec<f64> {
        let k = step.section;
        let mut result = self.values(x, k, n_rhs).to_vec();
        let mut y = MatMut::from_row_major_slice_mut(&mut result, self.reduction.rows(k), n_rhs);
        for &a in &step.neighbours {
            let known = MatRef::from_row_major_slice(self.values(x, a, n_rhs), self.reduction.rows(a), n_rhs);
            let w = self.own.couplings[&[a, k]].transpose();
            matmul(y.as_mut(), Accum::Add, w, known, -1.0, Par::Seq);
        }
        solve_upper_triangular_in_place(self.own.triangles[&k].transpose(), y, Par::Seq);
        result
    }

    fn values<'x>(&self, x: &'x [f64], section: usize, n_rhs: usize) -> &'x [f64] {
        let places = &self.reduction.sections[section];
        &x[n_rhs * places.start..n_rhs * places.end]
    }

    fn of<'x>(&self, x: &'x mut [f64], section: usize, n_rhs: usize) -> &'x mut [f64] {
        let places = &self.reduction.sections[section];
        &mut x[n_rhs * places.start..n_rhs * places.end]
    }

    /// Results of the steps of a level that this rank does, in their order, side by side.
    fn on_own(&self, level: &[Step], run: impl Fn(&Step) -> Vec<f64> + Sync + Send) -> Vec<Vec<f64>> {
        let mine: Vec<&Step> = level.iter().filter(|step| self.reduction.is_mine(step)).collect();
        mine.into_par_iter().map(run).collect()
    }

    /// Hands the results of all steps of a level, in their order, to `take`. Collective.
    fn gather(
        &self,
        comm: Communicator,
        level: &[Step],
        found: Vec<Vec<f64>>,
        length: impl Fn(&Step) -> usize,
        mut take: impl FnMut(&Step, &[f64]),
    ) {
        let mut lengths = vec![0; self.reduction.n_ranks];
        let owner = |step: &Step| self.reduction.owner[step.section];
        level.iter().for_each(|step| lengths[owner(step)] += length(step));
        let all = comm.all_gather(found.concat(), &lengths);
        let mut next = starts(&lengths);
        for step in level {
            let at = &mut next[owner(step)];
            take(step, &all[*at..*at + length(step)]);
            *at += length(step);
        }
    }
}
