//! The workspace of one flexible ring in statics: its factored stiffness and the displacement under loads.
//!
//! Cost: one factorisation; then one triangular solve per right-hand side. Displacements are elastic, relative
//! to the rigid partner (see [`crate::support`]).

use std::time::Instant;

use contact::quadrature::PressureRule;
use contact::{FacetSurface, NodalWeights, RacewaySurface, Side};
use mesh::Mesh;
use solver::{LinearSolver, SolverError, Symbolic};
use sprs::CsMat;

use crate::error::DynamicsError;
use crate::inventory::Inventory;
use crate::memory::RingMemory;
use crate::model::{Backend, ContactMode, Model, RACEWAY_GROUP, RingModel, Sectors};
use crate::substructures::Substructures;
use crate::support::Support;

/// Factored stiffness, raceway search and rule of one ring.
pub struct RingSolver {
    support: Support,
    factor: Box<dyn LinearSolver>,
    n_dofs: usize,
    /// Raceway in (azimuth, groove angle).
    pub surface: RacewaySurface,
    /// Raceway facets under boxes, in `facet` mode.
    pub facets: Option<FacetSurface>,
    /// Integration rule of the patches.
    pub rule: PressureRule,
    /// Seconds of assembly and of factorisation (ordering and analysis included).
    pub seconds: [f64; 2],
    /// Memory forecast from the analysis, before the factorisation.
    pub memory: RingMemory,
}

impl RingSolver {
    /// Assembles and factors the stiffness of the ring on `side`.
    pub fn new(model: &Model, side: Side, ring: &RingModel) -> Result<RingSolver, DynamicsError> {
        let start = Instant::now();
        let mesh = &ring.mesh;
        let weights = fem::surface::facet_node_weights(mesh, mesh.group(ring.held_group));
        let support = Support::new(mesh, ring.hold, weights);
        let n_balls = model.geometry.n_balls;
        let (factor, memory, assembled) = match model.backend {
            Backend::Sector(sectors) => sector_factor(side, ring, &support, n_balls, sectors)?,
            _ => sparse_factor(side, ring, &support, n_balls)?,
        };
        let facets = matches!(model.contact.mode, ContactMode::Facet)
            .then(|| FacetSurface::new(mesh, mesh.group(RACEWAY_GROUP), ring.groove));
        Ok(RingSolver {
            n_dofs: mesh.n_dofs(),
            surface: RacewaySurface::new(mesh, mesh.group(RACEWAY_GROUP), ring.groove),
            facets,
            rule: PressureRule::new(),
            seconds: [assembled, start.elapsed().as_secs_f64() - assembled],
            memory,
            support,
            factor,
        })
    }

    /// Elastic displacements, m, column-major `[n_dofs][n]`, under `n` load vectors (N) of the same layout.
    pub fn solve(&self, mut loads: Vec<f64>, n: usize) -> Vec<f64> {
        let n_free = self.support.free.len();
        let mut rhs = Vec::with_capacity(n_free * n);
        for load in loads.chunks_exact_mut(self.n_dofs) {
            self.support.balance(load);
            rhs.extend(self.support.free.iter().map(|&d| load[d]));
        }
        self.factor.solve(&mut rhs, n);
        for (displacement, x) in loads.chunks_exact_mut(self.n_dofs).zip(rhs.chunks_exact(n_free)) {
            displacement.fill(0.0);
            for (&d, &value) in self.support.free.iter().zip(x) {
                displacement[d] = value;
            }
            self.support.remove_rigid(displacement);
        }
        loads
    }

    /// Compliance of contacts, m/N, row-major `[2 n][2 n]` over (contact, [radial, axial]): motion of every groove
    /// centre under a unit force at every other. Symmetric to round-off, then made so exactly.
    pub fn compliance(&self, contacts: &[NodalWeights]) -> Vec<f64> {
        let n = 2 * contacts.len();
        let mut loads = vec![0.0; self.n_dofs * n];
        for (j, load) in loads.chunks_exact_mut(self.n_dofs).enumerate() {
            let unit = if j % 2 == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
            contacts[j / 2].add_load(unit, load);
        }
        let columns = self.solve(loads, n);
        let mut compliance = vec![0.0; n * n];
        for (j, column) in columns.chunks_exact(self.n_dofs).enumerate() {
            for (i, weights) in contacts.iter().enumerate() {
                let motion = weights.measure(column);
                compliance[n * (2 * i) + j] = motion[0];
                compliance[n * (2 * i + 1) + j] = motion[1];
            }
        }
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (compliance[n * i + j] + compliance[n * j + i]);
                (compliance[n * i + j], compliance[n * j + i]) = (mean, mean);
            }
        }
        compliance
    }

    /// Dofs, and the factor.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.n_dofs,
            matrices: [&self.factor].len(),
        }
    }

    /// Number of dofs of the ring, held ones included.
    pub fn n_dofs(&self) -> usize {
        self.n_dofs
    }
}

/// A factor, the forecast of its memory, and the seconds of its assembly.
type Made = (Box<dyn LinearSolver>, RingMemory, f64);

/// The stiffness of a held ring as one sparse matrix.
fn sparse_factor(
    side: Side,
    ring: &RingModel,
    support: &Support,
    n_balls: usize,
) -> Result<Made, DynamicsError> {
    let (start, mesh) = (Instant::now(), &ring.mesh);
    // Only the lower triangle outlives the assembly: the whole matrix takes half as much as a hex8 ring's factor.
    let full = fem::assemble_stiffness(mesh, &ring.material).map_err(|source| DynamicsError::Fem {
        side: side.name(),
        source,
    })?;
    let (stiffness, n_entries) = (solver::restrict_lower(&full, &support.free), full.nnz());
    drop(full);
    let assembled = start.elapsed().as_secs_f64();
    let symbolic = analyse(mesh, support, &stiffness).map_err(|e| named(e, side, ring, support))?;
    let memory = RingMemory::new(mesh, n_entries, &symbolic, n_balls);
    let factor = symbolic
        .factor(&stiffness)
        .map_err(|e| named(e, side, ring, support))?;
    Ok((Box::new(factor), memory, assembled))
}

/// The same in sectors.
fn sector_factor(
    side: Side,
    ring: &RingModel,
    support: &Support,
    n_balls: usize,
    sectors: Sectors,
) -> Result<Made, DynamicsError> {
    let start = Instant::now();
    let parts = Substructures::new(ring, side.name(), &support.free, sectors)?;
    let assembled = start.elapsed().as_secs_f64();
    let memory = RingMemory::of_sectors(&ring.mesh, &parts, n_balls, rayon::current_num_threads());
    let factor = parts.factor([0.0, 1.0]).map_err(|error| match error {
        DynamicsError::Solver { source, .. } => named(source, side, ring, support),
        other => other,
    })?;
    Ok((Box::new(factor), memory, assembled))
}

/// Analysis of the factorisation of a held ring, from its matrix' lower triangle.
fn analyse(mesh: &Mesh, support: &Support, stiffness: &CsMat<f64>) -> Result<Symbolic, SolverError> {
    Symbolic::new(stiffness, &elimination_order(mesh, &support.free))
}

/// Elimination order of the free dofs of a ring (nodal dofs, ascending).
pub(crate) fn elimination_order(mesh: &Mesh, free: &[usize]) -> Vec<usize> {
    let nodes = solver::angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
    solver::restrict_order(&solver::expand(&nodes, 3), free)
}

/// What the static factor of a ring will cost.
pub struct Forecast {
    /// Bytes by phase.
    pub memory: RingMemory,
    /// Bytes of the factor.
    pub factor_bytes: usize,
    /// Operations of the factorisation.
    pub flops: f64,
    /// The ring in sectors, when the scene asks for them.
    pub parts: Option<Substructures>,
}

/// Forecast of a ring in a bearing of `n_balls` balls: no number is computed.
pub fn forecast(
    side: Side,
    ring: &RingModel,
    n_balls: usize,
    backend: Backend,
) -> Result<Forecast, DynamicsError> {
    let mesh = &ring.mesh;
    let support = Support::new(
        mesh,
        ring.hold,
        fem::facet_node_weights(mesh, mesh.group(ring.held_group)),
    );
    if let Backend::Sector(sectors) = backend {
        let parts = Substructures::pattern(ring, side.name(), &support.free, sectors)?;
        let costs = parts.symbolic().costs();
        return Ok(Forecast {
            memory: RingMemory::of_sectors(mesh, &parts, n_balls, rayon::current_num_threads()),
            factor_bytes: costs.iter().map(|c| c.factor_bytes).sum::<usize>()
                + parts.symbolic().interface_bytes(),
            flops: costs.iter().map(|c| c.flops).sum(),
            parts: Some(parts),
        });
    }
    let fem_error = |source| DynamicsError::Fem {
        side: side.name(),
        source,
    };
    let pattern = fem::Pattern::new(mesh).map_err(fem_error)?;
    let full = pattern.matrix(vec![0.0; pattern.n_values()]);
    let lower = solver::restrict_lower(&full, &support.free);
    let symbolic = analyse(mesh, &support, &lower).map_err(|e| named(e, side, ring, &support))?;
    Ok(Forecast {
        memory: RingMemory::new(mesh, full.nnz(), &symbolic, n_balls),
        factor_bytes: symbolic.factor_bytes(),
        flops: symbolic.flops(),
        parts: None,
    })
}

fn named(error: SolverError, side: Side, ring: &RingModel, support: &Support) -> DynamicsError {
    match error {
        SolverError::NotPositiveDefinite { row, .. } => DynamicsError::NotHeld {
            side: side.name(),
            node: support.free[row] / 3,
            group: ring.held_group,
        },
        source => DynamicsError::Solver {
            side: side.name(),
            source,
        },
    }
}
