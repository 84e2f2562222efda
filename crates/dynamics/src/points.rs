//! Equilibria of one bearing at several points, loads of a sweep or instants in time: what each of them starts from.
//!
//! A point starts from an earlier one, and its last digits depend on which. To solve several at the same time to the
//! same bits on any number of threads, the number of the earlier one follows from that of the point alone:
//!
//! ```text
//! 0: undeformed;   1 .. 8: from 0;   9 .. 16: from 8;   17 .. 24: from 16;   ...
//! ```
//! Of each eight points the last is the start of the next eight. Where the earlier one is too far away, the point
//! starts from the one just before it instead, see [`again_from`].
//!
//! An equilibrium has no history: from another start it is the same but for the tolerance. Facets make forces jump, and
//! free balls may roll in more than one way. Each of their points starts from the one before, to stay on its branch.
//!
//! Cost: eight points on, a start costs hardly more than one point on. For the 7010C turning at 1800 rpm, 21 instants
//! from ball to ball, 13.15 Newton iterations an instant became 13.16, and rounds stayed 4.00.

use comm::Communicator;
use timer::Laps;

use crate::displacements::Displacements;
use crate::error::DynamicsError;
use crate::model::{ContactMode, Model};
use crate::pose::Pose;
use crate::solution::StaticSolution;
use crate::statics::{ContactColumns, StaticSolver};

/// Points that start from the same one.
const GROUP: u64 = 8;

/// What an equilibrium leaves to those that start from it.
#[derive(Clone, Debug, PartialEq)]
pub struct PointStart {
    /// Its displacements.
    pub displacements: Displacements,
    /// Its tangents of the contacts.
    pub columns: ContactColumns,
}

/// The equilibrium of a point.
pub struct SolvedPoint {
    /// The equilibrium.
    pub solution: StaticSolution,
    /// Tangents of the contacts when it was found.
    pub columns: ContactColumns,
    /// Wall time of its thread, effects apart.
    pub laps: Laps,
}

impl SolvedPoint {
    /// What it leaves to those that start from it.
    pub fn start(&self) -> PointStart {
        PointStart {
            displacements: self.solution.displacements.clone(),
            columns: self.columns.clone(),
        }
    }
}

/// How many points of a model start from the same one.
pub fn points_per_start(model: &Model) -> u64 {
    let may_jump = model.contact.mode == ContactMode::Facet || model.traction().is_some();
    if may_jump { 1 } else { GROUP }
}

/// The number of the point from which point `n`, the first is 0, starts, where `group` start from the same.
pub fn start_of(n: u64, group: u64) -> Option<u64> {
    n.checked_sub(1).map(|before| before / group * group)
}

/// The number of the point from which point `n` starts when it has no equilibrium from [`start_of`].
pub fn again_from(n: u64, group: u64) -> Option<u64> {
    let before = n.checked_sub(1)?;
    (start_of(n, group) != Some(before)).then_some(before)
}

/// Threads that solve points at the same time: those of the run, one where ranks share the rings.
pub fn threads_of_points() -> usize {
    match Communicator::world().size() {
        1 => rayon::current_num_threads(),
        _ => 1,
    }
}

/// Most points that are solved or under way before the first of them is taken: one more for each thread than it is
/// busy with, and the start of the next ones.
pub fn most_ahead(n_threads: usize) -> usize {
    2 * n_threads + 1
}

impl StaticSolver {
    /// Equilibrium of a model at an instant, from zero displacement or from another point. Any number of threads may
    /// ask at the same time, unless ranks share the rings.
    pub fn point(
        &self,
        model: &Model,
        pose: &Pose,
        start: Option<&PointStart>,
    ) -> Result<SolvedPoint, DynamicsError> {
        let columns = start.map(|start| start.columns.clone()).unwrap_or_default();
        let mut solver = self.beside(columns);
        let solution = solver.solve_from(model, pose, start.map(|start| &start.displacements))?;
        let (columns, laps) = solver.into_point();
        Ok(SolvedPoint {
            solution,
            columns,
            laps,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a point would start from one that comes after it, or that another number of points changes.
    #[test]
    fn a_point_starts_from_the_last_of_the_eight_before_it() {
        let starts = |group| (0..20).map(|n| start_of(n, group)).collect::<Vec<_>>();
        let expected = [vec![None], vec![Some(0); 8], vec![Some(8); 8], vec![Some(16); 3]];
        assert_eq!(starts(GROUP), expected.concat());
        assert_eq!(
            starts(1),
            (0..20u64).map(|n| n.checked_sub(1)).collect::<Vec<_>>()
        );
    }

    /// Wrong: a point that failed would be tried again from where it has failed, or not at all.
    #[test]
    fn a_point_is_tried_again_from_the_one_before_unless_it_has_started_there() {
        let again: Vec<u64> = (0..18).filter(|&n| again_from(n, GROUP).is_none()).collect();
        assert_eq!(again, [0, 1, 9, 17]);
        assert_eq!(again_from(8, GROUP), Some(7));
        assert!((0..18).all(|n| again_from(n, 1).is_none()));
    }
}
