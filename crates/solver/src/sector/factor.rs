//! Analysis, factorisation and solution of a ring in sectors, spread over threads and ranks.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use comm::Communicator;
use rayon::prelude::*;
use sprs::CsMat;

use super::agree::agree;
use super::interface::{Interface, InterfaceSymbolic};
use super::layout::{Sector, SectorLayout};
use super::part::{Part, PartSymbolic, Points, SectorCost};
use crate::error::SolverError;

/// Analysis of a ring in sectors: of those that this rank owns, and of the interface.
#[derive(Clone, Debug)]
pub struct SectorSymbolic {
    shared: Arc<SharedAnalysis>,
}

/// What an analysis shares with its factors and their solutions.
#[derive(Debug)]
pub(super) struct SharedAnalysis {
    pub(super) layout: SectorLayout,
    pub(super) comm: Communicator,
    /// Analyses of the sectors owned.
    pub(super) parts: Vec<PartSymbolic>,
    interface: Option<InterfaceSymbolic>,
}

/// Factor of a ring in sectors.
#[derive(Debug)]
pub struct SectorCholesky {
    pub(super) shared: Arc<SharedAnalysis>,
    pub(super) parts: Vec<Part>,
    pub(super) interface: Option<Interface>,
}

impl SectorSymbolic {
    /// Analyses a ring. `points`, `elements` and `nodes_per_element` are those of the layout, at least of the sectors
    /// of this rank; `matrix(s)` has the pattern of the own matrix of sector s, all dofs of its nodes, and is asked
    /// for the sectors of this rank only. Collective.
    pub fn new<'m>(
        layout: SectorLayout,
        comm: Communicator,
        (points, elements, nodes_per_element): (&Points<'_>, &[usize], usize),
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
            shared: Arc::new(SharedAnalysis {
                interface: InterfaceSymbolic::new(&layout, comm)?,
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

    /// Bytes of the interface's factor on a rank that owns the given sectors.
    pub fn interface_bytes(&self, owned: Range<usize>) -> usize {
        let interface = self.shared.interface.as_ref();
        interface.map_or(0, |interface| interface.factor_bytes(owned))
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
            factored.map_err(|error| error.in_whole(shared.layout.n(), |row| sector.rows[row] as usize))
        };
        let parts: Result<Vec<(Part, Vec<f64>)>, SolverError> =
            shared.parts.par_iter().enumerate().map(factor).collect();
        let (parts, complements): (Vec<Part>, Vec<Vec<f64>>) = agree(shared.comm, parts)?.into_iter().unzip();
        let interface = match &shared.interface {
            None => None,
            Some(interface) => Some(interface.factor(&shared.layout, shared.comm, complements)?),
        };
        Ok(SectorCholesky {
            shared: self.shared.clone(),
            parts,
            interface,
        })
    }
}

impl SharedAnalysis {
    pub(super) fn owned(&self) -> Range<usize> {
        self.comm.share(self.layout.sectors().len())
    }

    pub(super) fn own_sectors(&self) -> &[Sector] {
        &self.layout.sectors()[self.owned()]
    }

    /// Numbers that each rank contributes to a gathering of `of(sector)` numbers per sector.
    pub(super) fn lengths(&self, of: impl Fn(&Sector) -> usize) -> Vec<usize> {
        let sectors = self.layout.sectors();
        let sum = |range: Range<usize>| sectors[range].iter().map(&of).sum();
        let shares = self.comm.shares(sectors.len());
        shares.into_iter().map(sum).collect()
    }
}
