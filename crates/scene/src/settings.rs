//! What a scene says about a motion, as the solver wants it.

use dynamics::effects::Context;
use dynamics::kinematics::RingSpeeds;
use dynamics::motion::{Integrator, Ladder, MotionSettings};
use input::Clock;

use crate::tables::{Analysis, Dynamic, IntegratorChoice, Scene};

fn integrator_of(dynamic: &Dynamic) -> Integrator {
    match dynamic.integrator {
        IntegratorChoice::AverageAcceleration => Integrator::average_acceleration(),
        IntegratorChoice::ChungHulbert { rho } => Integrator::chung_hulbert(rho),
        IntegratorChoice::Hht { alpha } => Integrator::hht(alpha),
        IntegratorChoice::Newmark { beta, gamma } => Integrator::newmark(beta, gamma),
    }
}

/// All choices of a motion.
pub fn settings(scene: &Scene, dynamic: &Dynamic) -> MotionSettings {
    let integrator = integrator_of(dynamic);
    MotionSettings {
        dt: dynamic.step,
        ladder: Ladder {
            halvings: dynamic.halvings,
            tolerance: dynamic.adaptive,
        },
        integrator,
        scheme: dynamic.contact,
        speeds: speeds(scene),
        slip: scene.effects.slip(),
        contact_damping: scene.effects.contact_damping(),
        rayleigh: scene.effects.ring_damping().unwrap_or_default(),
    }
}

/// What the effects of a checked scene had to go with.
pub fn effects_context(scene: &Scene) -> Context {
    let analysis = &scene.analysis;
    let is_at_rest = matches!(
        analysis,
        Analysis::Static | Analysis::Sweep(_) | Analysis::Modes(_)
    );
    Context {
        is_without_inertia: !matches!(analysis, Analysis::Dynamic(_)),
        clock: if is_at_rest { Clock::AtRest } else { Clock::Running },
        has_speed: scene.has_speed,
        is_flexible: [scene.inner.body.is_some(), scene.outer.body.is_some()],
        seat_diameters: [scene.bearing.bore_diameter, scene.bearing.outside_diameter].map(Some),
        has_expansion: scene.materials.has_expansion(),
        has_lubricant: scene.lubricant.is_some(),
        turning_mass: scene.shaft.turning_mass(&scene.inner),
        parts_courses: scene.profiles.parts_courses(&scene.effects),
        has_ball_centrifugal: scene.effects.ball_centrifugal.is_some(),
    }
}

/// Speeds of the rings; at rest when the scene names none.
pub fn speeds(scene: &Scene) -> RingSpeeds {
    scene.speed.clone().unwrap_or_default()
}
