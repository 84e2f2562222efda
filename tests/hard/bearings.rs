//! Bearings and loads of the cases: a 7010C with rigid rings, or flexible ones of 2 052 dofs each.

use dynamics::effects::{AxialForce, Effect, Moment, RadialForce};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings};
use dynamics::{ContactMode, Hold, Model, StaticSolution, StaticSolver};
use input::Schedule;

use super::course::{Course, from_equilibrium};
use super::support::Case;
use super::support::rings::Level;

/// Mass of the shaft in motion, kg.
pub const SHAFT_MASS: f64 = 0.5;

/// A mesh of 54 sectors, three from ball to ball.
pub const SMALL: Level = Level::hex8(54, 6, 1, 2);

/// One turn per minute, rad/s.
pub const RPM: f64 = std::f64::consts::PI / 30.0;

/// A load and its schedule, N.
#[derive(Clone)]
pub struct Load(pub f64, pub Schedule);

impl Load {
    /// From `from` to `to` between 0 and 10 us.
    pub fn jump(from: f64, to: f64) -> Load {
        let (from, to) = (from / 1e4, to / 1e4);
        Load(
            1e4,
            Schedule::Ramp {
                from,
                to,
                start: 0.0,
                duration: 1e-5,
            },
        )
    }

    /// Always there.
    pub fn dead(force: f64) -> Load {
        Load(force, Schedule::Constant)
    }
}

/// Rigid rings and a shaft with mass, tilts locked.
pub fn rigid(axial: Load, radial: Load) -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.shaft_mass = SHAFT_MASS;
    set_loads(&mut model, axial, radial);
    model
}

/// Flexible rings, bore and seat clamped, tilts locked.
pub fn flexible(axial: Load, radial: Load) -> Model {
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    set_loads(&mut model, axial, radial);
    model
}

/// Replaces the loads.
pub fn set_loads(model: &mut Model, Load(axial, along): Load, Load(radial, across): Load) {
    let axial = AxialForce {
        value: axial,
        schedule: along,
    };
    let radial = RadialForce {
        value: radial,
        direction: 0.0,
        schedule: across,
    };
    let effects: [Box<dyn Effect>; 2] = [Box::new(axial), Box::new(radial)];
    model.effects = effects.into();
}

/// Adds a moment about x, N m.
pub fn add_moment(model: &mut Model, moment: f64) {
    let schedule = Schedule::Constant;
    model.effects.push(Box::new(Moment {
        value: [moment, 0.0],
        schedule,
    }));
}

/// Static equilibrium under the loads of a time, s.
pub fn equilibrium_at(model: &Model, time: f64) -> Result<StaticSolution, dynamics::DynamicsError> {
    let mut pose = dynamics::Pose::default();
    pose.now.time = time;
    StaticSolver::new(model)?.solve_at(model, &pose, None)
}

/// Conserving settings at rest.
pub fn conserving(dt: f64) -> MotionSettings {
    MotionSettings {
        ladder: halvings(4),
        ..MotionSettings::conserving(dt, Speed::constant(0.0))
    }
}

/// Steps may be halved so often when they fail.
pub fn halvings(halvings: u32) -> dynamics::motion::Ladder {
    dynamics::motion::Ladder {
        halvings,
        tolerance: None,
    }
}

/// Motion under the model's loads from the equilibrium under those of t = 0, for `duration` seconds.
pub fn transient(model: &Model, settings: MotionSettings, duration: f64) -> Course {
    let start = equilibrium_at(model, 0.0).unwrap();
    let n = (duration / settings.dt).round() as usize;
    from_equilibrium(model, &start, settings, n)
}

/// Motion of a bearing that nothing has deformed, with its shaft at `q`.
pub fn released(model: &Model, settings: MotionSettings, q: [f64; 5], duration: f64) -> Course {
    let n = (duration / settings.dt).round() as usize;
    let motion = Motion::new(model, settings).unwrap();
    let state = motion.with_accelerations(motion.rest(q, [0.0; 5])).unwrap();
    super::course::march(&motion, state, n)
}

/// Largest ball force of an equilibrium, N.
pub fn largest_ball_force(solution: &StaticSolution) -> f64 {
    let forces = solution
        .balls
        .iter()
        .map(|b| b.inner.force_n.max(b.outer.force_n));
    forces.fold(0.0, f64::max)
}
