//! Solutions of many right-hand sides that stay where they are: each rank has those of its sectors, all have the
//! interface.
//!
//! What leaves a rank are values at a few rows. Memory: one number per row of the sectors owned and right-hand side,
//! and of the interface. All functions are collective.

use std::sync::Arc;

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
}
