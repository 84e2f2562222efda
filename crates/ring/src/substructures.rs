//! A ring as a sum of sectors: each sector's own stiffness and mass, the products with the sums, and their factor.
//!
//! Where several ranks run, each assembles, holds and factors its own sectors only; vectors are whole on all ranks. The
//! whole matrix exists nowhere. Sums over sectors run in the order of the sectors, so results have the same bits
//! on any number of threads and ranks. Cost of a product: one gather of the nodes of all sectors.

use std::borrow::Cow;
use std::ops::Range;

use comm::Communicator;
use rayon::prelude::*;
use solver::{Sector, SectorCholesky, SectorLayout, SectorSymbolic};
use sprs::CsMat;

use crate::division::sum_of_sectors;
use crate::error::RingError;
use crate::model::{RingModel, Sectors};
use crate::sparse::{node_product, product};

/// A ring cut into sectors.
pub struct Substructures {
    name: &'static str,
    comm: Communicator,
    n_dofs: usize,
    /// Elements, and positions of nodes, that this rank keeps, and those of the ring.
    n_elements: [usize; 2],
    n_nodes: [usize; 2],
    symbolic: SectorSymbolic,
    /// Matrices of the sectors that this rank owns.
    matrices: Vec<Matrices>,
}

/// A sector's own matrices.
struct Matrices {
    stiffness: CsMat<f64>,
    /// Mass between nodes, kg.
    node_mass: CsMat<f64>,
}

impl Substructures {
    /// Cuts the ring, assembles the sectors owned, and analyses them for rows of the dofs `free`, ascending.
    /// Collective.
    pub fn new(
        ring: &RingModel,
        name: &'static str,
        free: &[usize],
        sectors: Sectors,
    ) -> Result<Substructures, RingError> {
        Substructures::build(ring, name, free, sectors, |sector| assemble(ring, name, sector))
    }

    /// The same with zeros for numbers: enough for a forecast.
    pub fn pattern(
        ring: &RingModel,
        name: &'static str,
        free: &[usize],
        sectors: Sectors,
    ) -> Result<Substructures, RingError> {
        Substructures::build(ring, name, free, sectors, |sector| pattern(ring, name, sector))
    }

    fn build(
        ring: &RingModel,
        name: &'static str,
        free: &[usize],
        shared: Sectors,
        matrices: impl Fn(&Sector) -> Result<Matrices, RingError> + Sync,
    ) -> Result<Substructures, RingError> {
        let mesh = &ring.mesh;
        let solver_error = |source| RingError::Solver { side: name, source };
        let (per_element, comm) = (mesh.kind.n_nodes(), shared.comm);
        let cut = ring.sector_cut(name, shared)?;
        let owned = comm.share(cut.nodes.len());
        let layout = SectorLayout::of(cut, mesh.n_nodes(), free, owned.clone());
        let made: Result<Vec<Matrices>, RingError> = layout.sectors()[owned.clone()]
            .par_iter()
            .map(&matrices)
            .collect();
        let elsewhere = |rank, message| RingError::OnRank { rank, message };
        let matrices = comm.agree(made, elsewhere)?;
        let place = |node: usize| mesh.nodes[node];
        let cells = (
            &place as &(dyn Fn(usize) -> [f64; 3] + Sync),
            &mesh.connectivity[..],
            per_element,
        );
        let of = |s: usize| Cow::Borrowed(&matrices[s - owned.start].stiffness);
        let symbolic = SectorSymbolic::new(layout, comm, cells, of).map_err(solver_error)?;
        Ok(Substructures {
            name,
            comm,
            n_dofs: mesh.n_dofs(),
            n_elements: [mesh.n_elements(), ring.n_elements()],
            n_nodes: [mesh.nodes.n_kept(), mesh.n_nodes()],
            symbolic,
            matrices,
        })
    }

    /// Sectors, their order and costs.
    pub fn symbolic(&self) -> &SectorSymbolic {
        &self.symbolic
    }

    /// Number of sectors whose matrices this rank holds.
    pub fn n_own(&self) -> usize {
        self.matrices.len()
    }

    /// Stored entries of the stiffness matrix of each sector of this rank.
    pub fn entries(&self) -> Vec<usize> {
        self.matrices.iter().map(|m| m.stiffness.nnz()).collect()
    }

    /// K u of nodal vectors, N, `[n_dofs]`. Collective.
    pub fn nodal_stiffness_product(&self, u: &[f64]) -> Vec<f64> {
        self.sum(u, |matrices, u| product(&matrices.stiffness, u))
    }

    /// M u of nodal vectors, kg times u, `[n_dofs]`. Collective.
    pub fn nodal_mass_products(&self, u: &[f64]) -> Vec<f64> {
        self.sum(u, |matrices, u| node_product(&matrices.node_mass, u))
    }

    /// Factor of `mass` M + `stiffness` K of the free dofs. Collective.
    pub fn factor(&self, [mass, stiffness]: [f64; 2]) -> Result<SectorCholesky, RingError> {
        let first = self.owned().start;
        let of = |s: usize| Cow::Owned(self.matrices[s - first].combined([mass, stiffness]));
        let factor = self.symbolic.factor(of);
        factor.map_err(|source| RingError::Solver {
            side: self.name,
            source,
        })
    }

    /// What a log says of the cut: sectors, their sizes, and where they are.
    pub fn note(&self) -> String {
        let costs = self.symbolic.costs();
        let range = |of: &dyn Fn(usize) -> usize| {
            let values = (0..costs.len()).map(of);
            (values.clone().min().unwrap_or(0), values.max().unwrap_or(0))
        };
        let elements = range(&|i| costs[i].n_elements);
        let bytes = range(&|i| costs[i].factor_bytes);
        let n = self.symbolic.layout().sectors().len();
        let whose = match self.comm.size() {
            1 => String::new(),
            ranks => format!(
                " on {ranks} ranks, of which this one has {} and keeps {} of {} elements and {} of {} nodes",
                costs.len(),
                self.n_elements[0],
                self.n_elements[1],
                self.n_nodes[0],
                self.n_nodes[1]
            ),
        };
        format!(
            "{n} sectors{whose}, {} to {} elements and {:.1} to {:.1} MB of factor each, {:.1} MB of interface",
            elements.0,
            elements.1,
            bytes.0 as f64 / 1e6,
            bytes.1 as f64 / 1e6,
            self.symbolic.interface_bytes(self.owned()) as f64 / 1e6
        )
    }

    fn owned(&self) -> Range<usize> {
        self.symbolic.owned()
    }

    /// Sum over all sectors, in their order, of `of(matrices, u of the sector)`.
    fn sum(&self, u: &[f64], of: impl Fn(&Matrices, &[f64]) -> Vec<f64> + Sync) -> Vec<f64> {
        let sectors = self.symbolic.layout().sectors();
        let mine = &sectors[self.owned()];
        let parts: Vec<Vec<f64>> = mine
            .par_iter()
            .zip(&self.matrices)
            .map(|(sector, matrices)| {
                let nodes = sector.nodes.iter().flat_map(|&n| 3 * n..3 * n + 3);
                let own: Vec<f64> = nodes.map(|dof| u[dof]).collect();
                of(matrices, &own)
            })
            .collect();
        sum_of_sectors(self.comm, self.symbolic.layout().nodes(), &parts, self.n_dofs)
    }
}

impl Matrices {
    /// c_M M + c_K K. The entries of M between two nodes are the diagonal of their block.
    fn combined(&self, [mass, stiffness]: [f64; 2]) -> CsMat<f64> {
        let mut matrix = self.stiffness.map(|k| stiffness * k);
        if mass == 0.0 {
            return matrix;
        }
        let starts: Vec<usize> = matrix.indptr().raw_storage().to_vec();
        let values = matrix.data_mut();
        for (node, row) in self.node_mass.outer_iterator().enumerate() {
            for c in 0..3 {
                let start = starts[3 * node + c];
                for (k, m) in row.data().iter().enumerate() {
                    values[start + 3 * k + c] += mass * m;
                }
            }
        }
        matrix
    }
}

fn assemble(ring: &RingModel, name: &'static str, sector: &Sector) -> Result<Matrices, RingError> {
    let part = ring.mesh.part(&sector.elements, &sector.nodes);
    let assemble = || -> Result<Matrices, fem::FemError> {
        let pattern = fem::Pattern::new(&part)?;
        Ok(Matrices {
            stiffness: fem::assemble_stiffness(&part, &ring.material)?,
            node_mass: fem::assemble_node_mass(&pattern, &part, &ring.material)?,
        })
    };
    assemble().map_err(|source| RingError::Fem { side: name, source })
}

fn pattern(ring: &RingModel, name: &'static str, sector: &Sector) -> Result<Matrices, RingError> {
    let part = ring.mesh.part(&sector.elements, &sector.nodes);
    let pattern = fem::Pattern::new(&part).map_err(|source| RingError::Fem { side: name, source })?;
    Ok(Matrices {
        stiffness: pattern.matrix(vec![0.0; pattern.n_values()]),
        node_mass: CsMat::zero((0, 0)),
    })
}
