//! What a run can do with but is most likely a slip: a material like no other, a mesh of other main dimensions than the
//! scene's, a step that is too long for what happens.
//!
//! Results never depend on `bearing.bore_diameter`, `outside_diameter` and `width` where there is a mesh, so that a
//! mesh of another size is no error: a groove that does not fit is one. But the scene then says something else than
//! what is solved.

use std::ops::RangeInclusive;

use body::Surrounding;
use contact::Side;
use contact::surface::felt::felt;
use dynamics::kinematics::BallSpeeds;
use dynamics::mounting::RingTemperature;
use dynamics::{Model, RingModel};
use input::{DENSITY, LENGTH, Quantity, STRESS};
use mesh::Coverage;

use crate::build::{coverages, torus};
use crate::coarse_round::reaches_next_ball;
use crate::resolution::unresolved;
use crate::section_record::unrecorded;
use crate::surfaces::track_radius;
use crate::tables::{BodySource, Lubrication, MaterialProperties, Scene, unusual_stiffnesses};

/// Young's modulus of what rings and balls are made of, Pa: from soft plastics to diamond.
const MODULI: RangeInclusive<f64> = 4e8..=1.3e12;
/// Their density, kg/m3: from foamed plastics to tungsten.
const DENSITIES: RangeInclusive<f64> = 500.0..=25_000.0;
/// What rings sit on and in.
const PARTNERS: &str = "shafts and housings";
/// Dynamic viscosity of oils in bearings, Pa s.
const VISCOSITIES: RangeInclusive<f64> = 1e-3..=5.0;
/// Relative difference of a diameter, and of a width, from which a mesh is said to have another.
const OTHER_DIAMETER: f64 = 2e-3;
const OTHER_WIDTH: f64 = 2e-2;

/// Share of a wave's amplitude below which it is said that an ellipse filters it.
const LEAST_FELT: f64 = 0.95;

/// What real surfaces do not change.
const WHOLE_ELLIPSES: &str = "contacts on real surfaces have their forces and peak pressures by strips; ellipses and \
                              near field are still those of Hertz's whole ellipse under these forces: at edges stress \
                              is higher";

/// What `speed.ball_speeds = "outer_control"` takes as given.
const OUTER_CONTROL: &str = "speed.ball_speeds = \"outer_control\" assumes that balls spin on the inner raceway alone; \
                             friction shares the spin between both raceways, about half each at low speed: \
                             balls.motion = \"free\" finds the shares";

/// A sentence for each slip or assumption; `model` has whole meshes.
pub fn doubts(scene: &Scene, model: &Model) -> Vec<String> {
    let materials = &scene.materials;
    let mut lines = Vec::new();
    doubt_material("materials.rings", "rings and balls", &materials.rings, &mut lines);
    doubt_material("materials.balls", "rings and balls", &materials.balls, &mut lines);
    doubt_bodies(scene, &mut lines);
    doubt_partners(scene, &mut lines);
    doubt_lubricant(scene, &mut lines);
    for (side, table) in Side::BOTH.into_iter().zip([&scene.inner, &scene.outer]) {
        if let (Some(ring), Some(body)) = (&model.rings[side.index()], &table.body) {
            let path = body.mesh.display().to_string();
            doubt_size(scene, side, ring, &path, &mut lines);
            lines.extend(reaches_next_ball(model, side, ring, &path));
            lines.extend(unrecorded(scene, side, body, table.section.as_ref()));
            if body.is_partial {
                say_parts(ring, &path, &mut lines);
            }
        }
    }
    if scene.ball_speeds == BallSpeeds::OuterControl {
        lines.push(OUTER_CONTROL.to_string());
    }
    lines.extend(odd_matrices(model));
    lines.extend(seats_with_gaps(model));
    lines.extend(unusual_stiffnesses(&scene.contact, &scene.bearing, materials));
    lines.extend(unresolved(scene, &model.geometry, model.surfaces.half_widths));
    lines.extend(filtered(scene, model));
    let mounted = model.mounting.report.iter();
    lines.extend(mounted.flat_map(|report| report.warnings.clone()));
    if model.surfaces.has_strips() {
        lines.push(WHOLE_ELLIPSES.to_string());
    }
    lines
}

/// Says which bodies of matrices are like no solid.
fn odd_matrices(model: &Model) -> Vec<String> {
    let doubts = |body: &Surrounding| Some(body.apparent?.doubts(&body.name));
    bodies(model).filter_map(doubts).flatten().collect()
}

/// Bodies in which rings of the bearing sit.
fn bodies(model: &Model) -> impl Iterator<Item = &Surrounding> {
    let tie = |side| model.tied(side).and_then(|ring| ring.tie.as_ref());
    Side::BOTH
        .into_iter()
        .filter_map(move |side| tie(side)?.body.as_deref())
}

/// Says which seats of bodies lack facets of their cylinder.
fn seats_with_gaps(model: &Model) -> Vec<String> {
    let gap = |(body, (group, coverage)): (&Surrounding, &(String, Coverage))| {
        format!(
            "body {:?}: group \"{group}\" of its seat has {coverage} that the mesh has on this cylinder between the \
             ends of the seat; the ring is held by that part alone",
            body.name
        )
    };
    let gaps = bodies(model).flat_map(|body| body.gaps.iter().map(move |seat| (body, seat)));
    gaps.map(gap).collect()
}

/// Says how weakly ellipses feel the shortest waves of a ring, or of a ball.
fn filtered(scene: &Scene, model: &Model) -> Vec<String> {
    let (geometry, widths) = (&model.geometry, model.surfaces.half_widths);
    let ring = |side: Side| {
        let profiles = &scene.profiles.raceways[side.index()];
        let size = (widths[side.index()], track_radius(geometry, side));
        (profiles, format!("the {} ring", side.name()), size)
    };
    let widest = widths[0].max(widths[1]);
    let ball = |(ball, profiles)| {
        (
            profiles,
            format!("ball {ball}"),
            (widest, 0.5 * geometry.ball_diameter),
        )
    };
    let bodies = Side::BOTH.into_iter().map(ring);
    let mut lines = Vec::new();
    for (profiles, body, (half_width, radius)) in bodies.chain(scene.profiles.balls.iter().map(ball)) {
        let Some(order) = profiles.waves.iter().map(|wave| wave.order).max() else {
            continue;
        };
        let share = felt(order as f64 * half_width / radius);
        if share < LEAST_FELT {
            lines.push(format!(
                "waves of order {order} of {body} are felt with {share:.3} of their amplitude: ellipses under the \
                 mean load at the start reach {:.3} mm to both sides along the track",
                1e3 * half_width
            ));
        }
    }
    lines
}

/// Says how much of their surfaces groups have that may be parts of them.
fn say_parts(ring: &RingModel, path: &str, lines: &mut Vec<String>) {
    for (group, coverage) in coverages(&ring.mesh, ring.held_group, &torus(&ring.groove)) {
        if let Some(coverage) = coverage {
            lines.push(format!(
                "mesh {path}: group \"{group}\" has {coverage} of its surface"
            ));
        }
    }
}

fn doubt_material(table: &str, of: &str, material: &MaterialProperties, lines: &mut Vec<String>) {
    doubt_modulus(table, of, material.young_modulus, lines);
    doubt_density(table, of, material.density, lines);
}

fn doubt_modulus(table: &str, of: &str, modulus: f64, lines: &mut Vec<String>) {
    if !MODULI.contains(&modulus) {
        lines.push(format!(
            "{table}.young_modulus is {}; {of} have 0.4 GPa (plastics) to 1300 GPa (diamond), steel 207 GPa: check \
             its unit",
            Quantity::<STRESS>::about(modulus)
        ));
    }
}

fn doubt_density(table: &str, of: &str, density: f64, lines: &mut Vec<String>) {
    if !DENSITIES.contains(&density) {
        lines.push(format!(
            "{table}.density is {}; {of} have 500 kg/m3 (plastics) to 25000 kg/m3 (heavy metals), steel 7800 kg/m3: \
             check its unit",
            Quantity::<DENSITY>::about(density)
        ));
    }
}

/// What shafts and housings are made of that have a mesh.
fn doubt_bodies(scene: &Scene, lines: &mut Vec<String>) {
    for body in scene.bodies.iter().flatten() {
        if let BodySource::Mesh { material, .. } = &body.source {
            let table = format!("[[body]] \"{}\": material", body.name);
            doubt_material(&table, PARTNERS, material, lines);
        }
    }
}

/// What the tubes of fits are made of, and whether temperatures over the radius are those of the ring.
fn doubt_partners(scene: &Scene, lines: &mut Vec<String>) {
    let conditions = scene.effects.conditions();
    for side in Side::BOTH {
        let (name, bearing) = (side.name(), &scene.bearing);
        if let Some(fit) = &conditions.fits[side.index()] {
            let table = format!("effects.fit.{name}");
            if let Some(modulus) = fit.young_modulus {
                doubt_modulus(&table, PARTNERS, modulus, lines);
            }
            if let Some(density) = fit.density {
                doubt_density(&table, PARTNERS, density, lines);
            }
        }
        let temperatures = conditions.temperatures.as_ref();
        let Some(RingTemperature::Radial(profile)) = temperatures.map(|t| &t.rings[side.index()]) else {
            continue;
        };
        let [from, to] = [
            [bearing.bore_diameter, bearing.outer_raceway_diameter],
            [bearing.inner_raceway_diameter, bearing.outside_diameter],
        ][side.index()]
        .map(|diameter| 0.5 * diameter);
        let [first, last] = [profile.radii[0], profile.radii[profile.radii.len() - 1]];
        if last < from || to < first {
            lines.push(format!(
                "effects.temperature.{name}.radii reach from {:.1} to {:.1} mm, and the ring lies between radii of \
                 {:.1} and {:.1} mm: all of it has one temperature; check that they are radii, in their unit",
                1e3 * first,
                1e3 * last,
                1e3 * from,
                1e3 * to
            ));
        }
    }
}

/// The oil of films.
fn doubt_lubricant(scene: &Scene, lines: &mut Vec<String>) {
    if let Some(Lubrication { lubricant, .. }) = &scene.lubricant
        && !VISCOSITIES.contains(&lubricant.viscosity)
    {
        lines.push(format!(
            "the dynamic viscosity of the lubricant is {:.3e} Pa s; oils in bearings have 1 mPa s (hot spindle oil) to \
             5 Pa s (cold gear oil): check its unit",
            lubricant.viscosity
        ));
    }
}

/// Compares the held surface and the width of a mesh with the scene.
fn doubt_size(scene: &Scene, side: Side, ring: &RingModel, path: &str, lines: &mut Vec<String>) {
    let (key, stated) = side.choose(
        ("bearing.bore_diameter", scene.bearing.bore_diameter),
        ("bearing.outside_diameter", scene.bearing.outside_diameter),
    );
    let (mesh, group) = (&ring.mesh, ring.held_group);
    let mut say = |what: &str, key: &str, found: f64, stated: f64| {
        let [found, stated] = [found, stated].map(Quantity::<LENGTH>::about);
        lines.push(format!(
            "mesh {path} has {what} of {found}, but {key} is {stated}; what is solved is the mesh"
        ));
    };
    let nodes = mesh.group_nodes(group);
    let radii = nodes.iter().map(|&n| mesh.nodes[n][0].hypot(mesh.nodes[n][1]));
    let diameter = 2.0 * radii.sum::<f64>() / nodes.len().max(1) as f64;
    if (diameter / stated - 1.0).abs() > OTHER_DIAMETER {
        say(&format!("a {group} with a mean diameter"), key, diameter, stated);
    }
    let (low, high) = mesh
        .nodes
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x[2]), high.max(x[2]))
        });
    let width = scene.bearing.width;
    if ((high - low) / width - 1.0).abs() > OTHER_WIDTH {
        say("a width", "bearing.width", high - low, width);
    }
}
