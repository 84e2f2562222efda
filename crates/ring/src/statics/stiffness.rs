//! The stiffness of a held ring before a number is factored, whatever solves it.

use ::solver::{LinearSolver, SolverError};

use crate::error::RingError;
use crate::memory::{MotionMemory, RingMemory};
use crate::model::RingModel;
use crate::substructures::Substructures;
use crate::support::AppliedHold;

/// What the matrices of a [`super::Prepared`] ring hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// The ring's own numbers.
    Assembled,
    /// Zeros where they will stand: enough for a forecast, nothing that can be factored. One sector is assembled all
    /// the same.
    Pattern,
}

/// The stiffness of a held ring and the linear solver that fits it.
pub trait HeldStiffness: Send {
    /// Name of the linear solver, as a scene has it.
    fn solver_name(&self) -> &'static str;

    /// The linear solver and why it is that one, for a log.
    fn note(&self) -> String;

    /// Forecast of its memory.
    fn memory(&self) -> RingMemory;

    /// Columns to solve for together: all contacts with a factor that is then read once.
    fn block(&self, n_contacts: usize) -> usize {
        2 * n_contacts
    }

    /// Bytes of the factor.
    fn factor_bytes(&self) -> usize;

    /// Multiplications and additions of the factorisation.
    fn flops(&self) -> f64;

    /// Forecast of the memory of its motion, where there is one.
    fn motion(&self) -> Option<MotionMemory> {
        None
    }

    /// The ring in sectors, when the scene asks for them.
    fn parts(&self) -> Option<&Substructures> {
        None
    }

    /// Factors the free dofs of `support`. Collective.
    fn factor(self: Box<Self>, name: &'static str, ring: &RingModel, support: &AppliedHold) -> Factored;
}

/// A factor of the free dofs of a ring, and of a ring with a defect the iterations it stands for, see
/// [`solver::cyclic::Defect::iterations`].
pub type Factored = Result<(Box<dyn LinearSolver>, Option<usize>), RingError>;

/// The error of a factorisation, with the node that nothing holds.
pub(crate) fn named(
    error: SolverError,
    side: &'static str,
    ring: &RingModel,
    support: &AppliedHold,
) -> RingError {
    match error {
        SolverError::NotPositiveDefinite { row, .. } => RingError::NotHeld {
            side,
            node: support.free[row] / 3,
            group: ring.held_group,
        },
        source => RingError::Solver { side, source },
    }
}
