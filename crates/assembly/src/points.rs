//! Equilibria of a list at several points of a run: what each of them starts from is that of one bearing
//! ([`dynamics::points`]).

use dynamics::Pose;
use dynamics::statics::ContactColumns;
use timer::Laps;

use crate::assembly::{Assembly, AssemblySolution, AssemblySolver, AssemblyStart};
use crate::error::AssemblyError;

/// What an equilibrium leaves to those that start from it.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyPointStart {
    /// Where shaft and bearings stand.
    pub equilibrium: AssemblyStart,
    /// Tangents of the contacts, by bearing.
    pub columns: Vec<ContactColumns>,
}

/// The equilibrium of a point.
pub struct AssemblyPoint {
    /// The equilibrium.
    pub solution: AssemblySolution,
    /// Tangents of the contacts when it was found, by bearing.
    pub columns: Vec<ContactColumns>,
    /// Wall time, by type of bearing, effects apart.
    pub laps: Vec<Laps>,
}

impl AssemblyPoint {
    /// What it leaves to those that start from it.
    pub fn start(&self) -> AssemblyPointStart {
        AssemblyPointStart {
            equilibrium: self.solution.as_start(),
            columns: self.columns.clone(),
        }
    }
}

/// How many points of a list start from the same one: as the bearing asks that may have the fewest.
pub fn points_per_start(assembly: &Assembly) -> u64 {
    let bearings = assembly.bearings.iter();
    let sizes = bearings.map(|bearing| dynamics::points::points_per_start(&bearing.model));
    sizes.min().unwrap_or(1)
}

impl AssemblySolver {
    /// Equilibrium at an instant, from zero displacement or from another point. Any number of threads may ask at the
    /// same time, each for an assembly of its own, unless ranks share the rings.
    pub fn point(
        &self,
        assembly: &mut Assembly,
        poses: &[Pose],
        start: Option<&AssemblyPointStart>,
    ) -> Result<AssemblyPoint, AssemblyError> {
        let mut solver = self.beside(start.map(|start| start.columns.clone()));
        let equilibrium = start.map(|start| &start.equilibrium);
        let solution = solver.solve_at(assembly, poses, equilibrium)?;
        let (columns, laps) = solver.into_point();
        Ok(AssemblyPoint {
            solution,
            columns,
            laps,
        })
    }
}
