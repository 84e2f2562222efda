//! What a scene says about a motion, as the solver wants it.

use dynamics::interactions::discrete_gradient::{ContactDamping, ContactScheme};
use dynamics::kinematics::Speed;
use dynamics::motion::{Integrator, Ladder, MotionSettings};

use crate::tables::{self, Dynamic, IntegratorChoice, Scene};

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
        scheme: match dynamic.contact {
            tables::ContactScheme::DiscreteGradient => ContactScheme::DiscreteGradient,
            tables::ContactScheme::Pointwise => ContactScheme::Pointwise,
        },
        speed: speed(scene),
        slip: scene.effects.cage_slip.unwrap_or([0.0; 2]),
        contact_damping: scene.effects.contact_damping.map(|d| ContactDamping {
            coefficient: d.coefficient,
            full_approach: d.full_approach,
        }),
        rayleigh: scene
            .effects
            .rayleigh_damping
            .map_or([0.0; 2], |d| [d.mass, d.stiffness]),
    }
}

/// Speed of the inner ring; at rest when the scene names none.
pub fn speed(scene: &Scene) -> Speed {
    match &scene.speed {
        Some(table) => Speed::table(table.times.clone(), table.values.clone()),
        None => Speed::constant(0.0),
    }
}
