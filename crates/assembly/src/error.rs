//! What can go wrong with bearings on a shaft.

use dense::DenseError;
use dynamics::DynamicsError;
use thiserror::Error;

/// Why there is no result.
#[derive(Debug, Error)]
pub enum AssemblyError {
    /// A bearing has no solution.
    #[error("bearing {name:?}: {source}")]
    Bearing {
        /// Its name.
        name: String,
        /// Why.
        source: DynamicsError,
    },
    /// The shaft leaves a bearing.
    #[error(
        "there is no equilibrium: {dof} of the shaft in bearing {name:?} moves beyond {limit}; check the loads, and \
         that bearings hold the shaft along the axis in both directions"
    )]
    NoEquilibrium {
        /// The bearing.
        name: String,
        /// What moves.
        dof: &'static str,
        /// How far it may, with its unit.
        limit: String,
    },
    /// A free motion of the shaft without stiffness.
    #[error(
        "nothing holds {dof} of the shaft at the solution: the bearings have {stiffness:.1e} of a contact's stiffness \
         there; preload them, or add a load that keeps them together"
    )]
    Unheld {
        /// The motion.
        dof: &'static str,
        /// Stiffness over that of a contact.
        stiffness: f64,
    },
    /// Newton did not end.
    #[error(
        "the shaft on its bearings does not settle: after {iterations} iterations the residual is {residual:.1e} of \
         the largest force, and the limit is {limit:.1e}; last residuals {history:?}"
    )]
    NotSettled {
        /// Iterations.
        iterations: usize,
        /// Residual over the largest force.
        residual: f64,
        /// Its limit.
        limit: f64,
        /// The last residuals.
        history: Vec<f64>,
    },
    /// A shaft that is no shaft.
    #[error("{problem}")]
    ShaftBody {
        /// What is wrong, where, what was expected.
        problem: String,
    },
    /// A matrix of the shaft has no factors.
    #[error("the matrix of the shaft on its bearings cannot be factored: {source}")]
    Matrix {
        /// Why.
        source: DenseError,
    },
    /// Patches or frames of the bearings keep changing.
    #[error("patches and frames of the bearings do not settle in {rounds} rounds; take a smaller step")]
    RoundsNotSettled {
        /// Rounds.
        rounds: usize,
    },
    /// The flexibility of a body has no inverse at a seat.
    #[error(
        "the forces of bearing {bearing:?} on body {body:?} cannot be found: the body does not tell the functions of \
         its seat apart; lower harmonics or across of [[body.seat]], or mesh it finer there"
    )]
    NoSeatForces {
        /// Name of the body.
        body: String,
        /// Name of the bearing.
        bearing: String,
    },
    /// The search for natural modes failed.
    #[error(transparent)]
    Modes {
        /// Why.
        source: DynamicsError,
    },
    /// Forces on a body that carries several bearings keep changing.
    #[error(
        "the forces on body {body:?}, which carries several bearings, still change by {change:.1e} of their size after \
         {rounds} rounds; take a smaller step if it moves, stiffen what holds it, or give each bearing a body of its \
         own"
    )]
    BodiesNotSettled {
        /// Name of the body.
        body: String,
        /// Rounds.
        rounds: usize,
        /// Change of the last over the size.
        change: f64,
    },
    /// A number of the shaft's step is none.
    #[error("a force on the shaft is not finite; take a smaller step")]
    NotFinite,
    /// A step has no solution, however small.
    #[error("the step of {dt:.3e} s from t = {time:.6e} s on, halved {halvings} times, failed: {source}")]
    StepFailed {
        /// The smallest step tried, s.
        dt: f64,
        /// Halvings.
        halvings: u32,
        /// Its start, s.
        time: f64,
        /// Why.
        source: Box<AssemblyError>,
    },
    /// Modes without mass.
    #[error("{dof} of the shaft is free and has no inertia; give {key}")]
    NoInertia {
        /// The motion.
        dof: &'static str,
        /// What gives it one.
        key: &'static str,
    },
}

impl AssemblyError {
    /// What is wrong in a bearing.
    pub fn of_bearing(name: &str) -> impl Fn(DynamicsError) -> AssemblyError + Copy {
        move |source| AssemblyError::Bearing {
            name: name.to_string(),
            source,
        }
    }

    /// Whether a smaller step may have a solution.
    pub fn may_pass_with_smaller_step(&self) -> bool {
        match self {
            AssemblyError::Bearing { source, .. } => source.may_pass_with_smaller_step(),
            AssemblyError::RoundsNotSettled { .. }
            | AssemblyError::BodiesNotSettled { .. }
            | AssemblyError::NotFinite
            | AssemblyError::NotSettled { .. }
            | AssemblyError::Matrix { .. } => true,
            _ => false,
        }
    }
}
