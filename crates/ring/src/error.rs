//! Errors of one ring.

use body::SurroundingError;
use dense::DenseError;
use fem::FemError;
use solver::SolverError;

/// Why a ring could not be made or solved.
#[derive(Debug, thiserror::Error)]
pub enum RingError {
    /// A ring's matrix is not positive definite.
    #[error(
        "the {side} ring is not held: its stiffness matrix is singular at node {node}; \
         check that the facet group \"{group}\" covers a surface and that the mesh is one connected part"
    )]
    NotHeld {
        /// `inner` or `outer`.
        side: &'static str,
        /// Node index in the mesh, from 0.
        node: usize,
        /// Held group.
        group: &'static str,
    },
    /// A ring that the cyclic solver was asked for is not rotationally periodic.
    #[error(
        "the {side} ring is not rotationally periodic, so solver.backend = \"cyclic\" cannot be: {reason}; \
         use \"auto\" or \"sparse\""
    )]
    NotPeriodic {
        /// `inner` or `outer`.
        side: &'static str,
        /// The first difference.
        reason: String,
    },
    /// A free ring without an inertia against all of its rigid motions.
    #[error("the mass of the {side} ring does not resist all of its rigid motions: {source}")]
    RigidMass {
        /// `inner` or `outer`.
        side: &'static str,
        /// Why not.
        source: DenseError,
    },
    /// Harmonics do not give the modes of a ring with a defect.
    #[error(
        "the {side} ring is rotationally periodic only up to a defect, whose natural modes solver.backend \
         = \"cyclic\" does not find; use \"auto\" or \"sparse\""
    )]
    ModesOfDefect {
        /// `inner` or `outer`.
        side: &'static str,
    },
    /// A ring whose stress of turning does not stiffen it.
    #[error(
        "effects.frame_rotation.stress_stiffening is not there for the {side} ring: {reason}; \
         remove it, or set it to false"
    )]
    NoStressStiffening {
        /// `inner` or `outer`.
        side: &'static str,
        /// Why not.
        reason: String,
    },
    /// The first natural frequency of a ring is not found.
    #[error(
        "the first natural frequency of the {side} ring is not found: {source}; \
         with effects.frame_rotation.negligible = 0 it is not asked for"
    )]
    FirstFrequency {
        /// `inner` or `outer`.
        side: &'static str,
        /// Cause.
        source: DenseError,
    },
    /// Another rank has failed.
    #[error("on rank {rank}: {message}")]
    OnRank {
        /// The rank.
        rank: usize,
        /// Its error.
        message: String,
    },
    /// The linear solver failed otherwise.
    #[error("{side} ring: {source}")]
    Solver {
        /// `inner` or `outer`.
        side: &'static str,
        /// Cause.
        source: SolverError,
    },
    /// The functions of a seat cannot be tied.
    #[error(transparent)]
    Body {
        /// Cause.
        source: SurroundingError,
    },
    /// Ring and body make no joint.
    #[error("the ring cannot be tied to its body: {source}; use fewer harmonics or across in the seat")]
    Tie {
        /// Cause.
        source: DenseError,
    },
    /// Finite elements failed.
    #[error("{side} ring: {source}")]
    Fem {
        /// `inner` or `outer`.
        side: &'static str,
        /// Cause.
        source: FemError,
    },
}

impl RingError {
    /// A ring whose stress does not stiffen it, and why.
    pub(crate) fn no_stress_stiffening(side: &'static str, reason: &str) -> RingError {
        RingError::NoStressStiffening {
            side,
            reason: reason.to_string(),
        }
    }

    /// Whether the cause is in what a user gave, not in its solution: a surface that holds nothing, an element, too
    /// many sectors, a backend that cannot be.
    pub fn is_of_input(&self) -> bool {
        matches!(
            self,
            RingError::NotHeld { .. }
                | RingError::NotPeriodic { .. }
                | RingError::ModesOfDefect { .. }
                | RingError::NoStressStiffening { .. }
                | RingError::Fem { .. }
                | RingError::Body { .. }
                | RingError::Solver {
                    source: SolverError::BadSectors { .. },
                    ..
                }
        )
    }
}
