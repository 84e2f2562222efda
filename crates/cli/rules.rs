//! Rules of thumb for `raceway check`: which effects a scene leaves off although they matter, and which it pays for
//! although they do not. The rule of an effect stands in its own file ([`dynamics::effects`]); that of rings that
//! are taken as rigid stands here.
//!
//! ```text
//! flexibility            u / d: hoop stretch of a ring that nothing holds, u = Z Q cos a r / (2 pi E A)
//! shaft.z                0 is the just-touching state; grooves opposite each other are at -A sin a, A their distance
//! ```
//!
//! Q is the load of a ball, d its Hertz approach and a the free contact angle ([`dynamics::effects::rules`]).

use dynamics::Model;
use dynamics::effects::rules::{Case, MATTERS, percent};
use results::failure::Failure;
use scene::{Analysis, Motion, Scene, material, speeds};

/// What the rules of thumb say about the effects of a scene: a sentence each, with estimate and formula.
pub fn advice(scene: &Scene, model: &Model) -> Result<Vec<String>, Failure> {
    let effects = &scene.effects;
    let speeds = &speeds(scene);
    let [inner, _] = speeds.at_largest(|[inner, _]| inner.abs());
    let case = Case {
        model,
        load: effects.peak_load(inner),
        speeds,
        slip: effects.slip(),
        ring_steel: material(&scene.materials.rings)?,
        bore_diameter: scene.bearing.bore_diameter,
        outside_diameter: scene.bearing.outside_diameter,
        width: scene.bearing.width,
        has_inertia: matches!(scene.analysis, Analysis::Dynamic(_)),
        is_damped: effects.contact_damping().is_some() || effects.ring_damping().is_some(),
        changes_in_time: effects.are_scheduled() || speeds.changes(),
    };
    let mut lines = effects.advice(&case);
    lines.extend(flexibility(scene, &case));
    zero_of_the_shaft(scene, model, &mut lines);
    Ok(lines)
}

/// Displacements count from the just-touching state, which is not the middle of the axial play.
fn zero_of_the_shaft(scene: &Scene, model: &Model, lines: &mut Vec<String>) {
    let geometry = &model.geometry;
    let angle = geometry.free_contact_angle();
    let play = geometry.groove_distance() * angle.sin();
    if scene.shaft.z != Motion::Locked || play <= 0.0 || model.seat().is_some() {
        return;
    }
    lines.push(format!(
        "shaft.z is \"locked\" at 0, where all balls just touch at the free contact angle of {:.2} deg; with the \
         grooves opposite each other, as in a deep groove bearing without thrust, it is shaft.z = \"{:.3} um\"",
        angle.to_degrees(),
        -1e6 * play
    ));
}

fn flexibility(scene: &Scene, case: &Case<'_>) -> Vec<String> {
    // Modes and imposed displacements alone have no load to compare with.
    if case.ball_load() == 0.0 {
        return Vec::new();
    }
    let b = &scene.bearing;
    let young = scene.materials.rings.young_modulus;
    let z = case.n_balls();
    let rings = [
        (
            "inner",
            &scene.inner,
            0.5 * b.inner_raceway_diameter,
            0.5 * b.bore_diameter,
        ),
        (
            "outer",
            &scene.outer,
            0.5 * b.outer_raceway_diameter,
            0.5 * b.outside_diameter,
        ),
    ];
    let mut lines = Vec::new();
    for (name, ring, raceway, held) in rings {
        let area = (raceway - held).abs() * b.width;
        let mean = 0.5 * (raceway + held);
        let stretch = z * case.ball_load() * case.contact_angle().cos() * mean
            / (2.0 * std::f64::consts::PI * young * area);
        let ratio = stretch / case.approach();
        if ring.body.is_none() && ratio >= MATTERS {
            lines.push(format!(
                "{name}.flexible is false, but a ring that nothing holds stretches by Z Q cos a r / (2 pi E A) = {:.2} um, {} \
                 of the Hertz approach; less on a solid shaft or in a solid housing",
                1e6 * stretch,
                percent(ratio)
            ));
        }
    }
    lines
}
