//! Bearings on a shaft, and their equilibrium.

use std::sync::Arc;

use contact::Side;
use dynamics::equilibrium::SearchScales;
use dynamics::statics::ContactColumns;
use dynamics::{Model, StaticSolution, StaticSolver};
use timer::Laps;

use crate::error::AssemblyError;
use crate::newton::{Mount, Problem, Scales, SettledShaft, settle};
use crate::place::Seating;
use crate::shaft::ShaftBody;
use crate::support::{BearingSupport, BearingSupports};

/// A bearing on the shaft. Its model is in its own frame: loads in space, spins and azimuths are turned with it, and it
/// has no load of the shaft.
pub struct MountedBearing {
    /// Its name in the scene.
    pub name: String,
    /// Where it sits.
    pub place: Seating,
    /// The bearing.
    pub model: Model,
}

/// Bearings, their shaft and its loads.
pub struct Assembly {
    /// Bearings in the order of the scene.
    pub bearings: Vec<MountedBearing>,
    /// The shaft without what bearings carry.
    pub shaft: ShaftBody,
    /// Loads on the shaft's dofs, N and N m.
    pub load: Vec<f64>,
}

/// Factors of the rings, one for each type, and what each bearing has found of them.
pub struct AssemblySolver {
    solvers: Vec<StaticSolver>,
    rigid: Vec<StaticSolver>,
    /// Number of its solver, by bearing.
    type_of: Vec<usize>,
    columns: Vec<ContactColumns>,
}

/// Equilibrium of an assembly.
pub struct AssemblySolution {
    /// Solution of every bearing, in its own frame.
    pub bearings: Vec<StaticSolution>,
    /// The shaft.
    pub shaft: SettledShaft,
}

impl Assembly {
    /// The places of the bearings on the shaft.
    pub fn mounts(&self) -> Vec<Mount> {
        let mount = |bearing: &MountedBearing| Mount {
            name: bearing.name.clone(),
            place: bearing.place,
            station: self.shaft.station(bearing.place.position),
        };
        self.bearings.iter().map(mount).collect()
    }

    /// Sizes of the search: those of the largest bearing.
    pub fn scales(&self) -> Scales {
        let mut scales = Scales {
            step: 0.0,
            stiffness: 0.0,
            tilt_arm: 0.0,
            tolerance: 1.0,
        };
        for bearing in &self.bearings {
            let model = &bearing.model;
            let hertz = model.hertz[0].stiffness.max(model.hertz[1].stiffness);
            let own = SearchScales::new(&model.geometry, hertz);
            scales.step = scales.step.max(own.step);
            scales.stiffness = scales.stiffness.max(own.stiffness);
            scales.tilt_arm = scales.tilt_arm.max(own.tilt_arm);
            scales.tolerance = scales.tolerance.min(model.tolerances.force);
        }
        scales
    }

    /// Force x, y, z, N, and moment about x and y, N m, about the origin of the shaft, by which a bearing pushes it.
    pub fn force_on_shaft(&self, bearing: usize, solution: &AssemblySolution) -> [f64; 5] {
        let orientation = self.bearings[bearing].place.orientation;
        let reaction = solution.bearings[bearing].shaft_reaction;
        orientation.turned(reaction).map(|f| 0.0 - f)
    }
}

impl AssemblySolver {
    /// Factors the rings of every type.
    pub fn new(assembly: &Assembly) -> Result<AssemblySolver, AssemblyError> {
        let mut first_of: Vec<usize> = Vec::new();
        let mut type_of = Vec::new();
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let known = first_of
                .iter()
                .position(|&k| have_same_rings(&assembly.bearings[k].model, &bearing.model));
            type_of.push(known.unwrap_or(first_of.len()));
            if known.is_none() {
                first_of.push(i);
            }
        }
        let of = |make: &dyn Fn(&Model) -> Result<StaticSolver, dynamics::DynamicsError>| {
            let solver = |&i: &usize| {
                let bearing = &assembly.bearings[i];
                make(&bearing.model).map_err(AssemblyError::of_bearing(&bearing.name))
            };
            first_of.iter().map(solver).collect::<Result<Vec<_>, _>>()
        };
        Ok(AssemblySolver {
            solvers: of(&StaticSolver::new)?,
            rigid: of(&|model| Ok(StaticSolver::rigid(model)))?,
            columns: type_of.iter().map(|_| ContactColumns::default()).collect(),
            type_of,
        })
    }

    /// The factors of each type, and the first bearing of it.
    pub fn types(&self) -> Vec<(usize, &StaticSolver)> {
        let first = |k: usize| self.type_of.iter().position(|t| *t == k).unwrap_or(0);
        self.solvers
            .iter()
            .enumerate()
            .map(|(k, s)| (first(k), s))
            .collect()
    }

    /// The factors of a bearing.
    pub fn of_bearing(&self, bearing: usize) -> &StaticSolver {
        &self.solvers[self.type_of[bearing]]
    }

    /// Wall time so far.
    pub fn laps(&self) -> Laps {
        let mut laps = Laps::default();
        for solver in self.solvers.iter().chain(&self.rigid) {
            laps.merge(&solver.laps());
        }
        laps
    }

    /// Equilibrium, from zero displacement or from an earlier solution of the same bearings and shaft. Without an
    /// earlier solution flexible rings start from where rigid ones leave the shaft.
    pub fn solve(
        &mut self,
        assembly: &mut Assembly,
        start: Option<&AssemblySolution>,
    ) -> Result<AssemblySolution, AssemblyError> {
        let is_flexible = |b: &MountedBearing| Side::BOTH.iter().any(|&side| b.model.ring(side).is_some());
        let at = match start {
            Some(solution) => solution.shaft.displacements.clone(),
            None if assembly.bearings.iter().any(is_flexible) => {
                let at = vec![0.0; assembly.shaft.n()];
                self.settle(assembly, SolvedRings::Rigid, &at, None)?
                    .0
                    .displacements
            }
            None => vec![0.0; assembly.shaft.n()],
        };
        let (shaft, bearings) = self.settle(assembly, SolvedRings::AsTheyAre, &at, start)?;
        Ok(AssemblySolution { bearings, shaft })
    }

    /// The shaft in balance on bearings with these rings, and their solutions.
    fn settle(
        &mut self,
        assembly: &mut Assembly,
        rings: SolvedRings,
        at: &[f64],
        start: Option<&AssemblySolution>,
    ) -> Result<(SettledShaft, Vec<StaticSolution>), AssemblyError> {
        let (mounts, scales) = (assembly.mounts(), assembly.scales());
        let problem = Problem {
            shaft: &assembly.shaft,
            load: &assembly.load,
            mounts: &mounts,
            scales,
        };
        let bearings = assembly
            .bearings
            .iter_mut()
            .zip(&mut self.columns)
            .zip(&self.type_of)
            .enumerate()
            .map(|(i, ((bearing, columns), &solver))| BearingSupport {
                model: &mut bearing.model,
                solver,
                columns,
                start: start.map(|solution| &solution.bearings[i]),
                last: None,
            });
        let mut supports = BearingSupports {
            bearings: bearings.collect(),
            solvers: match rings {
                SolvedRings::Rigid => &mut self.rigid,
                SolvedRings::AsTheyAre => &mut self.solvers,
            },
        };
        let settled = settle(&problem, &mut supports, at)?;
        let found = supports.bearings.into_iter();
        let found = found.map(|bearing| bearing.last.expect("every bearing has answered"));
        Ok((settled, found.collect()))
    }
}

/// With which rings.
#[derive(Clone, Copy)]
enum SolvedRings {
    Rigid,
    AsTheyAre,
}

/// Whether one factorisation serves both: the same rings, contacts found on them in the same way.
fn have_same_rings(a: &Model, b: &Model) -> bool {
    let same = |side: Side| match (&a.rings[side.index()], &b.rings[side.index()]) {
        (None, None) => true,
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        _ => false,
    };
    Side::BOTH.into_iter().all(same)
        && a.contact.mode == b.contact.mode
        && a.geometry.n_balls == b.geometry.n_balls
}
