//! Rules of thumb for `raceway check`: which effects a scene leaves off although they matter, and which it pays for
//! although they do not. The rule of an effect stands in its own file ([`dynamics::effects`]); that of rings that
//! are taken as rigid stands here.
//!
//! ```text
//! flexibility            u / d: hoop stretch of a ring that nothing holds, u = Z Q cos a r / (2 pi E A)
//! body.seat.harmonics    more than the number of balls
//! dynamic.start.rolling  omega_c sqrt(m / k): swing of balls that start at rest in their planes, over the displacement
//! shaft.z                0 is the just-touching state; grooves opposite each other are at -A sin a, A their distance
//!                        free without an axial load: an angular contact bearing comes apart, a from 14 deg on
//! ```
//!
//! Q is the load of a ball, d its Hertz approach and a the free contact angle ([`dynamics::effects::rules`]).

use contact::Side;
use dynamics::Model;
use dynamics::effects::orbit_inertia::share_of_stiffness;
use dynamics::effects::rules::{Case, MATTERS, PeakLoad, Remark, judge_key, share_of};
use dynamics::kinematics::RingSpeeds;
use results::failure::Failure;
use scene::{Analysis, Scene, Shaft, ShaftMotion, Start, material, speeds};

use crate::bodies::orders_of_seats;
use crate::periodic_gain;

/// What the rules of thumb say about the effects of a scene: a sentence each, with estimate and formula.
pub fn advice(scene: &Scene, model: &Model) -> Result<Vec<String>, Failure> {
    let speeds = &speeds(scene);
    let [inner, _] = speeds.at_largest(|[inner, _]| inner.abs());
    let load = on_balls(&scene.shaft, scene.effects.peak_load(inner));
    let case = case_of(scene, model, (speeds, load))?;
    let mut lines: Vec<String> = of_case(scene, &case)
        .into_iter()
        .map(|remark| remark.text)
        .collect();
    zero_of_the_shaft(scene, model, &mut lines);
    lines.extend(free_without_thrust(scene, &case));
    lines.extend(rigid_ring_without_inertia(scene, &case));
    lines.extend(mass_beside_load_point(scene));
    lines.extend(of_meshes(scene, model));
    Ok(lines)
}

/// What they say of one of several bearings on a shaft, which carries a part of the loads on it. What acts on the
/// shaft is not judged: other bearings carry it too.
pub fn remarks_on_shaft(
    bearing: &Scene,
    model: &Model,
    load: PeakLoad,
    changes_in_time: bool,
) -> Result<Vec<Remark>, Failure> {
    let speeds = &speeds(bearing);
    let case = case_of(bearing, model, (speeds, load))?;
    let case = Case {
        changes_in_time: changes_in_time || case.changes_in_time,
        has_own_shaft: false,
        ..case
    };
    let mut remarks = of_case(bearing, &case);
    remarks.extend(of_meshes(bearing, model).into_iter().map(Remark::from));
    Ok(remarks)
}

/// What a scene is judged by, at its largest speeds and loads.
fn case_of<'a>(
    scene: &Scene,
    model: &'a Model,
    (speeds, load): (&'a RingSpeeds, PeakLoad),
) -> Result<Case<'a>, Failure> {
    let effects = &scene.effects;
    Ok(Case {
        model,
        load,
        speeds,
        slip: effects.slip(),
        ring_steel: material(&scene.materials.rings)?,
        bore_diameter: scene.bearing.bore_diameter,
        outside_diameter: scene.bearing.outside_diameter,
        width: scene.bearing.width,
        has_inertia: matches!(scene.analysis, Analysis::Dynamic(_)),
        is_damped: effects.contact_damping().is_some() || effects.ring_damping().is_some(),
        changes_in_time: effects.are_scheduled() || speeds.changes(),
        has_own_shaft: true,
    })
}

/// Of effects, of rings that are taken as rigid, and of the start.
fn of_case(scene: &Scene, case: &Case<'_>) -> Vec<Remark> {
    let mut lines = scene.effects.advice(case);
    lines.extend(flexibility(scene, case).into_iter().map(Remark::from));
    lines.extend(start_at_rest(scene, case));
    lines
}

fn of_meshes(scene: &Scene, model: &Model) -> Vec<String> {
    let mut lines = periodic_gain::advice(scene, model);
    lines.extend(orders_of_seats(scene, model));
    lines
}

/// The part of loads on the shaft that balls carry: none of those along axes in which the shaft is held.
fn on_balls(shaft: &Shaft, load: PeakLoad) -> PeakLoad {
    let is_held = |motions: &[ShaftMotion]| motions.iter().all(|motion| *motion != ShaftMotion::Free);
    PeakLoad {
        axial: if is_held(&[shaft.z]) {
            load.spring
        } else {
            load.axial
        },
        radial: if is_held(&[shaft.x, shaft.y]) {
            0.0
        } else {
            load.radial
        },
        ..load
    }
}

/// Play in which balls cannot be told from balls that just touch, m: a thousandth of what micrometers show.
const NO_PLAY: f64 = 1e-9;

/// Displacements count from the just-touching state, which is not the middle of the axial play.
fn zero_of_the_shaft(scene: &Scene, model: &Model, lines: &mut Vec<String>) {
    let geometry = &model.geometry;
    let angle = geometry.free_contact_angle();
    let play = geometry.groove_distance() * angle.sin();
    let is_zero = matches!(scene.shaft.z, ShaftMotion::Locked | ShaftMotion::Prescribed(0.0));
    if !is_zero || play <= NO_PLAY || model.seat().is_some() {
        return;
    }
    lines.push(format!(
        "shaft.z is held at 0, where all balls just touch at the free contact angle of {:.2} deg; with the \
         grooves opposite each other, as in a deep groove bearing without thrust, it is shaft.z = \"{:.3} um\"",
        angle.to_degrees(),
        -1e6 * play
    ));
}

/// Least free contact angle of an angular contact bearing, rad: 14 degrees.
const ANGULAR: f64 = 14.0 * std::f64::consts::PI / 180.0;

/// A radial force alone drives the rings of an angular contact bearing apart along the axis.
fn free_without_thrust(scene: &Scene, case: &Case<'_>) -> Option<String> {
    let angle = case.contact_angle();
    let is_held = scene.shaft.z != ShaftMotion::Free || case.model.seat().is_some();
    if is_held || case.load.axial != 0.0 || case.load.radial == 0.0 || angle < ANGULAR {
        return None;
    }
    Some(format!(
        "shaft.z is \"free\" and no load acts along the axis: from the free contact angle of {:.2} deg the radial \
         force drives the rings apart until contact angles are about 0; an angular contact bearing needs \
         [effects.axial_force], [effects.spring_preload] or a shaft.z that is held",
        angle.to_degrees()
    ))
}

/// Whether the analysis takes the inertia of the shaft.
fn asks_for_inertia(scene: &Scene) -> bool {
    matches!(scene.analysis, Analysis::Dynamic(_) | Analysis::Modes(_))
}

/// The mass of a shaft that tilts has its inertia at the axis point, wherever its weight acts.
fn mass_beside_load_point(scene: &Scene) -> Option<String> {
    let shaft = &scene.shaft;
    let tilts = [shaft.tilt_x, shaft.tilt_y].contains(&ShaftMotion::Free);
    let apart = shaft.load_point;
    if !asks_for_inertia(scene) || !tilts || shaft.mass == 0.0 || apart == 0.0 {
        return None;
    }
    Some(format!(
        "shaft.mass has its inertia at the axis point, though its weight acts {:.1} mm beside it, at \
         shaft.load_point: what couples a tilt with a displacement of the mass is left out; where the mass stands \
         there, a list of one bearing with a beam or a body as shaft has it",
        1e3 * apart
    ))
}

/// A rigid inner ring has the inertia that the scene gives the shaft; what a tube of its size has is said where there
/// is none: m = rho pi (R^2 - r^2) b, I_p = m (R^2 + r^2) / 2, I = I_p / 2 + m b^2 / 12.
fn rigid_ring_without_inertia(scene: &Scene, case: &Case<'_>) -> Option<String> {
    let shaft = &scene.shaft;
    if !asks_for_inertia(scene) || scene.inner.body.is_some() {
        return None;
    }
    let is_free = |motions: &[ShaftMotion]| motions.contains(&ShaftMotion::Free);
    let of_mass = is_free(&[shaft.x, shaft.y, shaft.z]) && shaft.mass == 0.0;
    let of_tilt = is_free(&[shaft.tilt_x, shaft.tilt_y]) && shaft.inertia.transverse == 0.0;
    let missing = match (of_mass, of_tilt) {
        (false, false) => return None,
        (true, false) => "shaft.mass is",
        (false, true) => "shaft.transverse_inertia is",
        (true, true) => "shaft.mass and shaft.transverse_inertia are",
    };
    let (radius, bore) = case.radii(Side::Inner);
    let mass = case.inner_ring_mass();
    let polar = 0.5 * mass * (radius * radius + bore * bore);
    Some(format!(
        "{missing} 0 and the inner ring is rigid: what is free there follows the forces without inertia; a tube of \
         the ring's size has {mass:.3} kg, across the axis {:.2e} kg m2 and about it {polar:.2e} kg m2 \
         (shaft.polar_inertia)",
        0.5 * polar + mass * case.width * case.width / 12.0
    ))
}

/// Balls that start at rest in their planes are struck by the course on which they go round: they swing by its speed
/// over their own frequency.
fn start_at_rest(scene: &Scene, case: &Case<'_>) -> Vec<Remark> {
    let Analysis::Dynamic(dynamic) = &scene.analysis else {
        return Vec::new();
    };
    let is_struck =
        dynamic.start == Start::Static && case.load.radial > 0.0 && case.model.traction().is_none();
    if !is_struck {
        return Vec::new();
    }
    let ratio = share_of_stiffness(case).sqrt();
    let estimate = format!(
        "balls that start at rest in their planes make what is free swing by about {}, omega_c sqrt(m / k)",
        share_of(ratio, "its displacement")
    );
    judge_key("[dynamic.start.rolling]", false, ratio, &estimate)
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
                "{name}.flexible is false, but a ring that nothing holds stretches by Z Q cos a r / (2 pi E A) = {:.2} \
                 um, {}; less on a solid shaft or in a solid housing",
                1e6 * stretch,
                share_of(ratio, "the Hertz approach")
            ));
        }
    }
    lines
}
