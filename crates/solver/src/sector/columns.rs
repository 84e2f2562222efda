//! Solutions of many right-hand sides that stay where they are: each rank has those of its sectors, all have the
//! interface.
//!
//! What leaves a rank are values at a few rows, and sums of all solutions, one vector instead of one per right-hand
//! side. Memory: one number per row of the sectors owned and right-hand side, and of the interface. All functions are
//! collective.

use std::sync::Arc;

use rayon::prelude::*;

use super::factor::SharedAnalysis;
use super::layout::RowPlace;
use super::reduction::starts;

/// Solutions by sector: see the module.
#[derive(Debug)]
pub struct SectorColumns {
    pub(super) shared: Arc<SharedAnalysis>,
    pub(super) n_columns: usize,
    /// Of the sectors owned, by places of their factors, row-major `[n_rows][n_columns]`.
    pub(super) local: Vec<Vec<f64>>,
    /// Of the interface, row-major `[places][n_columns]`.
    pub(super) interface: Vec<f64>,
}

impl SectorColumns {
    /// Number of solutions.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        let local: usize = self.local.iter().map(Vec::len).sum();
        size_of::<f64>() * (local + self.interface.len())
    }

    /// Values at some rows on all ranks, row-major `[rows.len()][n_columns]`.
    pub fn values_at(&self, rows: &[usize]) -> Vec<f64> {
        let (shared, n) = (&*self.shared, self.n_columns);
        let shares = shared.comm.shares(shared.layout.sectors().len());
        let rank_of: Vec<usize> = shares
            .iter()
            .enumerate()
            .flat_map(|(rank, share)| share.clone().map(move |_| rank))
            .collect();
        let owned = shared.owned();
        let (mut lengths, mut sent) = (vec![0; shares.len()], Vec::new());
        for &row in rows {
            if let RowPlace::Inside(s) = shared.layout.place(row) {
                lengths[rank_of[s]] += n;
                if owned.contains(&s) {
                    sent.extend_from_slice(self.inside(s - owned.start, row));
                }
            }
        }
        let all = shared.comm.all_gather(sent, &lengths);
        let mut next = starts(&lengths);
        let mut values = Vec::with_capacity(n * rows.len());
        for &row in rows {
            match shared.layout.place(row) {
                RowPlace::Shared(place) => {
                    values.extend_from_slice(&self.interface[n * place..n * (place + 1)]);
                }
                RowPlace::Inside(s) => {
                    let at = &mut next[rank_of[s]];
                    values.extend_from_slice(&all[*at..*at + n]);
                    *at += n;
                }
            }
        }
        values
    }

    /// Values of the i-th sector owned at a row inside it, `[n_columns]`.
    fn inside(&self, i: usize, row: usize) -> &[f64] {
        let local_row = self.shared.own_sectors()[i].inside(row);
        let place = self.shared.parts[i].places[local_row] as usize;
        &self.local[i][self.n_columns * place..self.n_columns * (place + 1)]
    }

    /// The sum of all columns of `terms` times their factors, `[n]`, on all ranks.
    ///
    /// # Panics
    /// When there is no term, or a term has another number of factors than columns.
    pub fn sum(terms: &[(&SectorColumns, &[f64])]) -> Vec<f64> {
        let shared = &*terms[0].0.shared;
        for (columns, factors) in terms {
            assert_eq!(columns.n_columns, factors.len(), "one factor per column");
        }
        let sectors = shared.own_sectors();
        let inside = |i: usize| -> Vec<f64> {
            let places = shared.parts[i].places.iter().take(sectors[i].n_interior);
            places
                .map(|&place| combine(terms, place as usize, |columns| &columns.local[i]))
                .collect()
        };
        let parts: Vec<Vec<f64>> = (0..sectors.len()).into_par_iter().map(inside).collect();
        let lengths = shared.lengths(|s| s.n_interior);
        let all = shared.comm.all_gather(parts.concat(), &lengths);
        let mut sum = vec![0.0; shared.layout.n()];
        shared.layout.each_row(|row, place| {
            sum[row] = match place {
                RowPlace::Inside(place) => all[place],
                RowPlace::Shared(place) => combine(terms, place, |columns| &columns.interface),
            };
        });
        sum
    }

    /// The first column alone.
    pub fn first(&self) -> SectorColumns {
        let first = |values: &Vec<f64>| values.iter().step_by(self.n_columns).copied().collect();
        SectorColumns {
            shared: self.shared.clone(),
            n_columns: 1,
            local: self.local.iter().map(first).collect(),
            interface: first(&self.interface),
        }
    }

    /// Adds the first column of `other` to the first of these.
    ///
    /// # Panics
    /// When they have different sizes.
    pub fn add_to_first(&mut self, other: &SectorColumns) {
        let (n, m) = (self.n_columns, other.n_columns);
        let pairs = self.local.iter_mut().zip(&other.local);
        for (own, more) in pairs.chain([(&mut self.interface, &other.interface)]) {
            assert_eq!(own.len() / n, more.len() / m, "columns of the same ring");
            let firsts = own.iter_mut().step_by(n).zip(more.iter().step_by(m));
            firsts.for_each(|(x, y)| *x += y);
        }
    }
}

/// The sum of all columns at one place of an array of each term.
fn combine<'t>(
    terms: &[(&'t SectorColumns, &[f64])],
    place: usize,
    array: impl Fn(&'t SectorColumns) -> &'t [f64],
) -> f64 {
    let mut sum = 0.0;
    for (columns, factors) in terms {
        let n = columns.n_columns;
        let values = &array(columns)[n * place..n * (place + 1)];
        values.iter().zip(*factors).for_each(|(x, f)| sum += f * x);
    }
    sum
}
