//! The matrix of the interface: the sum of the sectors' Schur complements, block cyclic tridiagonal, and its factor.
//!
//! Few sectors: all ranks hold and solve all of it, which takes one message. From [`REDUCED_FROM`] sectors on it
//! would be most of what a rank holds and does, and cross-sections are divided among the ranks
//! ([`super::reduction`]). The number of sectors decides, not that of the ranks, so that the bits stay.

use comm::Communicator;
use sprs::CsMat;

use super::layout::SectorLayout;
use super::reduced::ReducedFactor;
use super::reduction::Reduction;
use crate::cholesky::SparseCholesky;
use crate::error::SolverError;
use crate::linear_solver::LinearSolver;
use crate::symbolic::Symbolic;

/// Sectors from which ranks divide the interface: with as many ranks, the interface is then as much as a sector.
pub const REDUCED_FROM: usize = 16;

/// Analysis of the interface.
#[derive(Debug)]
pub(super) enum InterfaceSymbolic {
    /// Of all of it, on all ranks.
    Whole(WholeSymbolic),
    /// Divided among the ranks.
    Reduced(Reduction),
}

/// Factor of the interface.
#[derive(Debug)]
pub(super) enum Interface {
    /// All of it.
    Whole(SparseCholesky),
    /// What this rank has of it.
    Reduced(ReducedFactor),
}

/// Analysis of the interface as one sparse matrix.
#[derive(Debug)]
pub(super) struct WholeSymbolic {
    symbolic: Symbolic,
    /// Lower triangle by columns: starts, and rows in ascending order.
    starts: Vec<usize>,
    rows: Vec<usize>,
}

impl InterfaceSymbolic {
    /// Analyses the interface of a layout, whose order is kept; None without interface.
    pub(super) fn new(
        layout: &SectorLayout,
        comm: Communicator,
    ) -> Result<Option<InterfaceSymbolic>, SolverError> {
        if layout.interface().is_empty() {
            return Ok(None);
        }
        let in_sections: usize = layout.sections.iter().map(|s| s.len()).sum();
        // Nodes that more than two sectors share couple all their cross-sections.
        let is_circle = in_sections == layout.interface().len();
        if is_circle && layout.sectors().len() >= REDUCED_FROM {
            return Ok(Some(InterfaceSymbolic::Reduced(Reduction::new(layout, comm))));
        }
        WholeSymbolic::new(layout).map(|whole| Some(InterfaceSymbolic::Whole(whole)))
    }

    /// Bytes of the factor on a rank that owns the given sectors.
    pub(super) fn factor_bytes(&self, owned: std::ops::Range<usize>) -> usize {
        match self {
            InterfaceSymbolic::Whole(whole) => whole.symbolic.factor_bytes(),
            InterfaceSymbolic::Reduced(reduction) => reduction.factor_bytes(owned),
        }
    }

    /// Factors the sum of the complements of all sectors, added in their order; given are those of the sectors owned.
    /// Collective.
    pub(super) fn factor(
        &self,
        layout: &SectorLayout,
        comm: Communicator,
        complements: Vec<Vec<f64>>,
    ) -> Result<Interface, SolverError> {
        match self {
            InterfaceSymbolic::Whole(whole) => {
                let packed = |n: usize| n * (n + 1) / 2;
                let length = |range: std::ops::Range<usize>| {
                    let sectors = &layout.sectors()[range];
                    sectors.iter().map(|s| packed(s.boundary.len())).sum()
                };
                let shares = comm.shares(layout.sectors().len());
                let lengths: Vec<usize> = shares.into_iter().map(length).collect();
                let all = comm.all_gather(complements.concat(), &lengths);
                drop(complements);
                whole.factor(layout, &all).map(Interface::Whole)
            }
            InterfaceSymbolic::Reduced(reduction) => {
                ReducedFactor::new(reduction, layout, comm, complements).map(Interface::Reduced)
            }
        }
    }
}

impl Interface {
    /// Bytes of the factor on this rank.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Interface::Whole(factor) => factor.factor_bytes(),
            Interface::Reduced(factor) => factor.bytes(),
        }
    }

    /// Solves in place, row-major `[places][n_rhs]`, the same on all ranks. Collective.
    pub(super) fn solve(&self, comm: Communicator, x: &mut [f64], n_rhs: usize) {
        match self {
            Interface::Reduced(factor) => factor.solve(comm, x, n_rhs),
            Interface::Whole(factor) => {
                let n = factor.n();
                let mut columns: Vec<f64> = (0..x.len()).map(|i| x[n_rhs * (i % n) + i / n]).collect();
                factor.solve(&mut columns, n_rhs);
                (0..x.len()).for_each(|i| x[n_rhs * (i % n) + i / n] = columns[i]);
            }
        }
    }
}

impl WholeSymbolic {
    fn new(layout: &SectorLayout) -> Result<WholeSymbolic, SolverError> {
        let n = layout.interface().len();
        let mut touching = vec![Vec::new(); n];
        for sector in layout.sectors() {
            for (i, &place) in sector.boundary.iter().enumerate() {
                touching[place].push(&sector.boundary[i..]);
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for tails in touching {
            let mut column = tails.concat();
            column.sort_unstable();
            column.dedup();
            rows.extend(column);
            starts.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        let pattern = CsMat::new_csc((n, n), starts.clone(), rows.clone(), values);
        let natural: Vec<usize> = (0..n).collect();
        Ok(WholeSymbolic {
            symbolic: Symbolic::new(&pattern, &natural)?,
            starts,
            rows,
        })
    }

    /// Factors the sum of the complements of all sectors, one after the other in `complements`.
    fn factor(&self, layout: &SectorLayout, complements: &[f64]) -> Result<SparseCholesky, SolverError> {
        let n = layout.interface().len();
        let mut values = vec![0.0; self.rows.len()];
        let mut first = 0;
        for sector in layout.sectors() {
            let boundary = &sector.boundary;
            let size = boundary.len();
            let packed = &complements[first..first + size * (size + 1) / 2];
            first += packed.len();
            for (j, &column) in boundary.iter().enumerate() {
                let mut at = self.starts[column];
                for (i, &row) in boundary.iter().enumerate().skip(j) {
                    while self.rows[at] != row {
                        at += 1;
                    }
                    values[at] += packed[i * (i + 1) / 2 + j];
                }
            }
        }
        let matrix = CsMat::new_csc((n, n), self.starts.clone(), self.rows.clone(), values);
        let factored = self.symbolic.factor(&matrix);
        factored.map_err(|error| error.in_whole(layout.n(), |row| layout.interface()[row]))
    }
}
