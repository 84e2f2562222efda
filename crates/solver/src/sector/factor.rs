//! Analysis, factorisation and solution of a ring in sectors, spread over threads and ranks.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use comm::Communicator;
use rayon::prelude::*;
use sprs::CsMat;

use super::interface::InterfaceSymbolic;
use super::layout::{Sector, SectorLayout};
use super::part::{Part, PartSymbolic, SectorCost};
use crate::cholesky::SparseCholesky;
use crate::error::SolverError;
use crate::linear_solver::LinearSolver;

/// Analysis of a ring in sectors: of those that this rank owns, and of the interface.
#[derive(Clone, Debug)]
pub struct SectorSymbolic {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    layout: SectorLayout,
    comm: Communicator,
    /// Analyses of the sectors owned.
    parts: Vec<PartSymbolic>,
    interface: Option<InterfaceSymbolic>,
}

/// Factor of a ring in sectors.
#[derive(Debug)]
pub struct SectorCholesky {
    shared: Arc<Shared>,
    parts: Vec<Part>,
    interface: Option<SparseCholesky>,
}

impl SectorSymbolic {
    /// Analyses a ring. `points`, `elements` and `nodes_per_element` are those of the layout; `matrix(s)` has the pattern of the
    /// own matrix of sector s, all dofs of its nodes, and is asked for the sectors of this rank only. Collective.
    pub fn new<'m>(
        layout: SectorLayout,
        comm: Communicator,
        (points, elements, nodes_per_element): (&[[f64; 3]], &[usize], usize),
        matrix: impl Fn(usize) -> Cow<'m, CsMat<f64>> + Sync,
    ) -> Result<SectorSymbolic, SolverError> {
        let analyse = |s: usize| {
            let sector = &layout.sectors()[s];
            PartSymbolic::new(sector, points, elements, nodes_per_element, &matrix(s))
        };
        let owned = comm.share(layout.sectors().len());
        let parts: Result<Vec<PartSymbolic>, SolverError> = owned.into_par_iter().map(analyse).collect();
        let parts = agree(comm, parts)?;
        Ok(SectorSymbolic {
            shared: Arc::new(Shared {
                interface: InterfaceSymbolic::new(&layout)?,
                parts,
                layout,
                comm,
            }),
        })
    }

    /// The sectors.
    pub fn layout(&self) -> &SectorLayout {
        &self.shared.layout
    }

    /// Sectors that this rank owns.
    pub fn owned(&self) -> Range<usize> {
        self.shared.owned()
    }

    /// Sizes and costs of the sectors owned.
    pub fn costs(&self) -> Vec<SectorCost> {
        let sectors = &self.shared.layout.sectors()[self.owned()];
        let parts = self.shared.parts.iter().zip(sectors);
        parts.map(|(part, sector)| part.cost(sector)).collect()
    }

    /// Bytes of the interface's factor, which every rank holds.
    pub fn interface_bytes(&self) -> usize {
        self.shared
            .interface
            .as_ref()
            .map_or(0, InterfaceSymbolic::factor_bytes)
    }

    /// Bytes at the peak of the factorisation on this rank, matrices not counted: all factors, and the work space of as
    /// many sectors as threads work at.
    pub fn peak_bytes(&self, n_threads: usize) -> usize {
        let factors: usize = self.costs().iter().map(|c| c.factor_bytes).sum();
        let mut spaces: Vec<usize> = self
            .shared
            .parts
            .iter()
            .zip(self.costs())
            .map(|(part, cost)| part.peak_bytes() - cost.factor_bytes)
            .collect();
        spaces.sort_unstable();
        factors + self.interface_bytes() + spaces.iter().rev().take(n_threads).sum::<usize>()
    }

    /// Factors the ring whose sectors have the matrices `matrix(s)`. Collective: all ranks succeed, or all fail.
    pub fn factor<'m>(
        &self,
        matrix: impl Fn(usize) -> Cow<'m, CsMat<f64>> + Sync,
    ) -> Result<SectorCholesky, SolverError> {
        let shared = &self.shared;
        let first = self.owned().start;
        let factor = |(i, part): (usize, &PartSymbolic)| {
            let sector = &shared.layout.sectors()[first + i];
            let factored = part.factor(sector, &matrix(first + i));
            factored.map_err(|error| in_ring(error, sector, shared.layout.n()))
        };
        let parts: Result<Vec<(Part, Vec<f64>)>, SolverError> =
            shared.parts.par_iter().enumerate().map(factor).collect();
        let (parts, complements): (Vec<Part>, Vec<Vec<f64>>) = agree(shared.comm, parts)?.into_iter().unzip();
        let interface = match &shared.interface {
            None => None,
            Some(interface) => {
                let lengths = shared.lengths(|s| s.boundary.len() * (s.boundary.len() + 1) / 2);
                let all = shared.comm.all_gather(complements.concat(), &lengths);
                Some(interface.factor(&shared.layout, &all)?)
            }
        };
        Ok(SectorCholesky {
            shared: self.shared.clone(),
            parts,
            interface,
        })
    }
}

impl Shared {
    fn owned(&self) -> Range<usize> {
        self.comm.share(self.layout.sectors().len())
    }

    fn own_sectors(&self) -> &[Sector] {
        &self.layout.sectors()[self.owned()]
    }

    /// Numbers that each rank contributes to a gathering of `of(sector)` numbers per sector.
    fn lengths(&self, of: impl Fn(&Sector) -> usize) -> Vec<usize> {
        let sectors = self.layout.sectors();
        let sum = |range: Range<usize>| sectors[range].iter().map(&of).sum();
        let shares = self.comm.shares(sectors.len());
        shares.into_iter().map(sum).collect()
    }
}

impl LinearSolver for SectorCholesky {
    fn n(&self) -> usize {
        self.shared.layout.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        let mut local = self.forward(rhs, n_rhs);
        let boundary = self.solve_interface(rhs, n_rhs, &local);
        let sectors = self.shared.own_sectors();
        let pairs = local.par_iter_mut().zip(&self.parts).zip(sectors);
        pairs.for_each(|((x, part), sector)| {
            for (place, &row) in part.places.iter().enumerate().skip(sector.n_interior) {
                let at = n_rhs * sector.boundary[row - sector.n_interior];
                x[n_rhs * place..n_rhs * (place + 1)].copy_from_slice(&boundary[at..at + n_rhs]);
            }
            part.backward(x, n_rhs);
        });
        self.collect(rhs, n_rhs, &local, &boundary);
    }

    /// Bytes of the factors on this rank.
    fn factor_bytes(&self) -> usize {
        self.parts.iter().map(Part::bytes).sum::<usize>()
            + self.interface.as_ref().map_or(0, LinearSolver::factor_bytes)
    }

    fn name(&self) -> &'static str {
        "sector Cholesky"
    }
}

impl SectorCholesky {
    /// y and -F y of the sectors owned, by places, `[places][n_rhs]` each.
    fn forward(&self, rhs: &[f64], n_rhs: usize) -> Vec<Vec<f64>> {
        let n = self.n();
        let sectors = self.shared.own_sectors();
        let pairs = self.parts.par_iter().zip(sectors);
        pairs
            .map(|(part, sector)| {
                let mut x = vec![0.0; n_rhs * sector.n_rows()];
                let interior = part.places.iter().take(sector.n_interior);
                for (x, &row) in x.chunks_exact_mut(n_rhs).zip(interior) {
                    let row = sector.rows[row];
                    x.iter_mut().enumerate().for_each(|(r, x)| *x = rhs[n * r + row]);
                }
                part.forward(&mut x, n_rhs);
                x
            })
            .collect()
    }

    /// The solution on the interface, `[places][n_rhs]`, on all ranks.
    fn solve_interface(&self, rhs: &[f64], n_rhs: usize, local: &[Vec<f64>]) -> Vec<f64> {
        let Some(interface) = &self.interface else {
            return Vec::new();
        };
        let (shared, n) = (&self.shared, self.n());
        let mut sent = Vec::new();
        for ((x, part), sector) in local.iter().zip(&self.parts).zip(shared.own_sectors()) {
            let first = sent.len();
            sent.resize(first + n_rhs * sector.boundary.len(), 0.0);
            for (place, &row) in part.places.iter().enumerate().skip(sector.n_interior) {
                let at = first + n_rhs * (row - sector.n_interior);
                sent[at..at + n_rhs].copy_from_slice(&x[n_rhs * place..n_rhs * (place + 1)]);
            }
        }
        let lengths = shared.lengths(|s| n_rhs * s.boundary.len());
        let all = shared.comm.all_gather(sent, &lengths);
        let rows = shared.layout.interface();
        let mut x = vec![0.0; n_rhs * rows.len()];
        for (column, values) in x.chunks_exact_mut(rows.len()).zip(rhs.chunks_exact(n)) {
            column.iter_mut().zip(rows).for_each(|(x, &row)| *x = values[row]);
        }
        let mut parts = all.chunks_exact(n_rhs);
        for sector in shared.layout.sectors() {
            for (&place, values) in sector.boundary.iter().zip(parts.by_ref()) {
                for (r, value) in values.iter().enumerate() {
                    x[rows.len() * r + place] += value;
                }
            }
        }
        interface.solve(&mut x, n_rhs);
        let by_place = |k: usize| x[rows.len() * (k % n_rhs) + k / n_rhs];
        (0..x.len()).map(by_place).collect()
    }

    /// Puts the solutions of all sectors and of the interface in place.
    fn collect(&self, rhs: &mut [f64], n_rhs: usize, local: &[Vec<f64>], boundary: &[f64]) {
        let (shared, n) = (&self.shared, self.n());
        let column = |(r, column): (usize, &mut [f64])| {
            for (&row, values) in shared.layout.interface().iter().zip(boundary.chunks_exact(n_rhs)) {
                column[row] = values[r];
            }
            for ((x, part), sector) in local.iter().zip(&self.parts).zip(shared.own_sectors()) {
                for (place, &row) in part.places.iter().enumerate().take(sector.n_interior) {
                    column[sector.rows[row]] = x[n_rhs * place + r];
                }
            }
        };
        rhs.par_chunks_exact_mut(n).enumerate().for_each(column);
        if shared.comm.size() == 1 {
            return;
        }
        let mut sent = Vec::new();
        for sector in shared.own_sectors() {
            for column in rhs.chunks_exact(n) {
                sent.extend(sector.rows[..sector.n_interior].iter().map(|&row| column[row]));
            }
        }
        let all = shared
            .comm
            .all_gather(sent, &shared.lengths(|s| n_rhs * s.n_interior));
        let mut values = all.iter();
        for sector in shared.layout.sectors() {
            for column in rhs.chunks_exact_mut(n) {
                for (&row, value) in sector.rows[..sector.n_interior].iter().zip(values.by_ref()) {
                    column[row] = *value;
                }
            }
        }
    }
}

/// The result of all ranks: an error on one is an error on all.
fn agree<T>(comm: Communicator, result: Result<T, SolverError>) -> Result<T, SolverError> {
    comm.agree(result, |rank, message| SolverError::OnRank { rank, message })
}

/// Names the row of the ring in an error about a sector's row.
fn in_ring(error: SolverError, sector: &Sector, n: usize) -> SolverError {
    match error {
        SolverError::NotPositiveDefinite { row, .. } => SolverError::NotPositiveDefinite {
            row: sector.rows[row],
            n,
        },
        SolverError::Singular {
            row,
            relative_pivot,
            limit,
            ..
        } => SolverError::Singular {
            row: sector.rows[row],
            n,
            relative_pivot,
            limit,
        },
        SolverError::NonFinite { row, column, value } => SolverError::NonFinite {
            row: sector.rows[row],
            column: sector.rows[column],
            value,
        },
        other => other,
    }
}
