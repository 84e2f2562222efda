//! Bearings with free balls.

use contact::{BearingGeometry, HertzContact, Side};
use dynamics::effects::ball_centrifugal::BallCentrifugal;
use dynamics::effects::traction::FreeBalls;
use dynamics::interactions::traction::{Creep, PatchPoints, Traction, TractionLaw};
use dynamics::kinematics::{BallSpeeds, RingSpeeds};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Model, ShaftDof};

use crate::support::Case;

/// Coulomb friction with a slope at small slip.
pub fn coulomb(mu: f64, creep: Creep) -> Traction {
    Traction {
        law: TractionLaw::Coulomb(mu),
        creep,
        places: PatchPoints::new([3, 15]),
    }
}

/// Gives a model free balls.
pub fn freed(mut model: Model, traction: Traction, speeds: &RingSpeeds) -> Model {
    model.effects.push(Box::new(FreeBalls {
        traction,
        at_start: BallCentrifugal {
            speeds: speeds.clone(),
            slip: [0.0; 2],
            ball_speeds: BallSpeeds::OuterControl,
        },
    }));
    model
}

/// The 7010C under thrust.
pub fn thrust(axial: f64) -> Model {
    let mut case = Case::axial(axial);
    case.free_tilt = true;
    let mut model = case.rigid();
    model.shaft_mass = 1.0;
    model.shaft_inertia.transverse = 1e-3;
    model
}

/// Balls squeezed between grooves of the same bearing without contact angle, by an interference, m; negative is play.
/// The shaft is held.
pub fn radial(interference: f64) -> Model {
    let mut model = Case::axial(0.0).rigid();
    let mut geometry = BearingGeometry::reference_7010c();
    geometry.outer_raceway_diameter =
        geometry.inner_raceway_diameter + 2.0 * geometry.ball_diameter - interference;
    geometry.n_balls = 3;
    let steel = dynamics::model::elastic(&crate::support::steel());
    model.hertz = Side::BOTH.map(|side| HertzContact::new(&geometry, side, steel, steel));
    model.geometry = geometry;
    model.shaft = [ShaftDof::Prescribed(0.0); 5];
    // Groove centres of both rings in one plane, whatever the play.
    model.shaft[2] = ShaftDof::Prescribed(-geometry.axial_offset());
    model.effects.clear();
    model
}

/// Steps of a motion; `note` sees every state.
pub fn run(
    motion: &Motion<'_>,
    mut state: MotionState,
    n: usize,
    mut note: impl FnMut(&MotionState),
) -> MotionState {
    let mut cache = StepCache::default();
    for _ in 0..n {
        (state, _) = motion.step(&state, &mut cache).unwrap_or_else(|e| panic!("{e}"));
        note(&state);
    }
    state
}

pub fn settings(dt: f64, speeds: &RingSpeeds) -> MotionSettings {
    MotionSettings::conserving(dt, speeds.clone())
}

pub fn rpm(n: f64) -> f64 {
    n * std::f64::consts::PI / 30.0
}
