//! What comes before the first step of a motion: static equilibrium, at rest or rolling, or a state that the scene
//! gives.

use contact::Side;
use dynamics::motion::{EquilibriumRates, Motion, MotionState};
use dynamics::{DynamicsError, Model, RingMemory, StaticSolution, StaticSolver};
use results::failure::Failure;
use scene::{Dynamic, Scene, Start, rolling};
use timer::Laps;

use crate::progress::Progress;

/// The static start, when there is one, and its costs.
#[derive(Default)]
pub struct Settled {
    equilibrium: Option<StaticSolution>,
    rates: Option<EquilibriumRates>,
    /// Forecast of the memory of both rings.
    pub forecast: [Option<RingMemory>; 2],
    /// Wall time of the static solution.
    pub timing: Laps,
}

/// Static equilibrium at t = 0, if the motion starts from it. Its factors are not kept: the motion has its own.
pub fn settle(
    scene: &Scene,
    model: &Model,
    dynamic: &Dynamic,
    progress: &Progress,
) -> Result<Settled, Failure> {
    dynamics::motion::check_supported(model).map_err(Failure::solving)?;
    if let Start::Given { .. } = dynamic.start {
        return Ok(Settled::default());
    }
    progress.stage("static start");
    let mut statics = StaticSolver::new(model).map_err(Failure::solving)?;
    let equilibrium = statics.solve(model, None).map_err(at_the_start)?;
    let rates = rolling(scene)
        .filter(|_| dynamic.start == Start::Rolling)
        .map(|rolling| EquilibriumRates::find(&mut statics, (model, &rolling), &equilibrium))
        .transpose()
        .map_err(Failure::solving)?;
    Ok(Settled {
        equilibrium: Some(equilibrium),
        rates,
        forecast: Side::BOTH.map(|side| statics.ring(side).map(|r| r.solver.memory)),
        timing: statics.timing,
    })
}

/// The failure of an equilibrium from which a motion should start.
fn at_the_start(error: DynamicsError) -> Failure {
    let is_unheld = matches!(error, DynamicsError::Unheld { .. });
    let failure = Failure::solving(error);
    if is_unheld {
        let start = "a motion starts from its equilibrium under the loads of t = 0, where schedules may be 0; with \
                     [dynamic.start.free] it starts from rest without one";
        return failure.context(start.to_string());
    }
    failure
}

impl Settled {
    /// The state at t = 0.
    pub fn first_state(&self, motion: &Motion<'_>, dynamic: &Dynamic) -> Result<MotionState, Failure> {
        let state = match (&self.equilibrium, dynamic.start) {
            (Some(equilibrium), _) => motion.start_with(equilibrium, self.rates.as_ref()),
            (
                None,
                Start::Given {
                    displacement,
                    velocity,
                },
            ) => motion.rest(displacement, velocity),
            (None, Start::Static | Start::Rolling) => unreachable!("a static start has its equilibrium"),
        };
        motion.with_accelerations(state).map_err(Failure::solving)
    }

    /// What the static solution warns of.
    pub fn warnings(&self) -> Vec<String> {
        self.equilibrium
            .as_ref()
            .map_or_else(Vec::new, |e| e.warnings.clone())
    }
}
