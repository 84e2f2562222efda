//! From a scene with a list of bearings to the bearings on their shaft.

use assembly::{Assembly, AssemblyError, MountedBearing, Seating, ShaftBody, ShaftLoads};
use contact::Side;
use dynamics::Model;
use dynamics::effects::{Loads, Now, Setting};

use crate::build::{NodeTags, build_model, model_with_rings};
use crate::error::BuildError;
use crate::housing::{Rings, tie_together};
use crate::tables::{ON_SHAFT, RigidShaft, Scene, SeveralScene, ShaftKind, ShaftMotion};

/// The effect that has a place of its own on the shaft.
const UNBALANCE: &str = "unbalance";

/// The bearings of a scene on their shaft, and the numbers of the nodes of each in the mesh files. Reads the meshes of
/// each type once.
pub fn build_assembly(scene: &SeveralScene) -> Result<(Assembly, Vec<NodeTags>), BuildError> {
    let mut rings: Vec<Rings> = Vec::new();
    let mut tags: Vec<NodeTags> = Vec::new();
    let mut shifts: [Vec<f64>; 2] = Default::default();
    for (i, bearing) in scene.bearings.iter().enumerate() {
        let like = (0..i).find(|&k| have_same_rings(&scene.bearings[k].scene, &bearing.scene));
        match like {
            Some(k) => {
                rings.push(rings[k].clone());
                tags.push(tags[k].clone());
                shifts.iter_mut().for_each(|of_side| of_side.push(of_side[k]));
            }
            None => {
                let (model, of_model) = build_model(&bearing.scene)?;
                let origin = model.geometry.axial_offset();
                for (side, of_side) in Side::BOTH.into_iter().zip(&mut shifts) {
                    of_side.push(model.ring_shift(side) - origin);
                }
                rings.push(model.rings);
                tags.push(of_model);
            }
        }
    }
    tie_together(&scene.bearings, &mut rings, &shifts)?;
    Ok((assembly_with_rings(scene, rings)?, tags))
}

/// The same with rings that were read before, by bearing: the points of a sweep share them.
pub fn assembly_with_rings(scene: &SeveralScene, rings: Vec<Rings>) -> Result<Assembly, BuildError> {
    let mut bearings = Vec::new();
    for (number, (bearing, rings)) in scene.bearings.iter().zip(rings).enumerate() {
        bearings.push(MountedBearing {
            name: bearing.name.clone(),
            place: Seating {
                position: bearing.position,
                orientation: bearing.orientation,
                shift: scene.pairing.shift(number),
            },
            model: Model {
                weighs_carried: false,
                ..model_with_rings(&bearing.scene, rings)?
            },
        });
    }
    let shaft = shaft(scene)?;
    let load = loads(scene, (&shaft, &bearings), &Now::default())?;
    let mut assembly = Assembly {
        bearings,
        shaft,
        load,
    };
    assembly.be_linear_in_bodies();
    Ok(assembly)
}

/// Whether two scenes have the same finite-element rings, so that one factorisation serves both.
pub fn have_same_rings(a: &Scene, b: &Scene) -> bool {
    let grooves = |s: &Scene| {
        let b = &s.bearing;
        [
            b.inner_raceway_diameter,
            b.outer_raceway_diameter,
            b.inner_groove_radius,
            b.outer_groove_radius,
        ]
    };
    let same_bodies = a.inner.body == b.inner.body && a.outer.body == b.outer.body;
    let rigid = a.inner.body.is_none() && a.outer.body.is_none();
    same_bodies
        && a.bodies == b.bodies
        && a.contact.mode == b.contact.mode
        && (rigid || (a.materials.rings == b.materials.rings && grooves(a) == grooves(b)))
}

/// The shaft with the masses along it.
fn shaft(scene: &SeveralScene) -> Result<ShaftBody, AssemblyError> {
    let shaft = &scene.shaft;
    let mut body = match &shaft.kind {
        ShaftKind::Rigid(rigid) => rigid_shaft(rigid),
        ShaftKind::Beam(beam) => {
            let bearings = scene.bearings.iter().map(|b| b.position);
            let loads = shaft.loads.iter().map(|l| l.position);
            let masses = shaft.masses.iter().map(|m| m.position);
            let effects = scene.effects.names();
            let has_load = effects
                .iter()
                .any(|name| ON_SHAFT.contains(name) && *name != UNBALANCE);
            let load_point = has_load.then_some(shaft.load_point);
            let unbalance = scene.effects.unbalance.iter().map(|u| u.position());
            let places = bearings.chain(loads).chain(masses).chain(load_point);
            let stations: Vec<f64> = places.chain(unbalance).collect();
            ShaftBody::beam(beam, &stations)?
        }
    };
    shaft.masses.iter().for_each(|mass| body.add_mass(mass));
    Ok(body)
}

fn rigid_shaft(rigid: &RigidShaft) -> ShaftBody {
    let inertia = assembly::RigidInertia {
        mass: rigid.mass,
        first_moment: 0.0,
        transverse: rigid.transverse,
        polar: rigid.polar,
    };
    let held = rigid.motions.map(|motion| match motion {
        ShaftMotion::Free => None,
        ShaftMotion::Locked => Some(0.0),
        ShaftMotion::Prescribed(value) => Some(value),
    });
    ShaftBody::rigid(inertia, held)
}

/// Loads on the shaft at an instant, or their means over an interval about it: those along the shaft, those of
/// effects at the load point, the pull of an unbalance where it is, its weight, and that of bodies on it.
pub fn loads(
    scene: &SeveralScene,
    (shaft, bearings): (&ShaftBody, &[MountedBearing]),
    now: &Now<'_>,
) -> Result<ShaftLoads, BuildError> {
    // The effects ask for a bearing: any is right.
    let model = &bearings[0].model;
    let mut sum = ShaftLoads::none(shaft);
    for load in &scene.shaft.loads {
        let ([x, y, z], [about_x, about_y]) = (load.force, load.moment);
        sum.add(&shaft.station(load.position), [x, y, z, about_x, about_y]);
    }
    let rigid = [None, None];
    let found = scene.effects.loads(Setting {
        speeds: &scene.speed.clone().unwrap_or_default(),
        slip: scene.effects.slip(),
        ball_speeds: scene.bearings[0].scene.ball_speeds,
        rings: &rigid,
        lubricant: None,
    })?;
    let none = || Loads::none(model.geometry.n_balls);
    let mut of_effects = none();
    for effect in found.iter().filter(|effect| ON_SHAFT.contains(&effect.name())) {
        if effect.name() == UNBALANCE {
            let (mut of_unbalance, unbalance) = (none(), scene.effects.unbalance.as_ref());
            effect.add_loads(model, now, &mut of_unbalance)?;
            // Its moment about the origin follows from its place on the shaft.
            let [x, y, ..] = of_unbalance.shaft;
            let position = unbalance.map_or(0.0, |unbalance| unbalance.position());
            sum.add(&shaft.station(position), [x, y, 0.0, 0.0, 0.0]);
            continue;
        }
        // The load point of a bearing's model is its origin: forces have no lever.
        effect.add_loads(model, now, &mut of_effects)?;
    }
    sum.add(&shaft.station(scene.shaft.load_point), of_effects.shaft);
    if let Some(gravity) = &scene.effects.gravity {
        let g = gravity.acceleration_at(now);
        match &scene.shaft.kind {
            ShaftKind::Beam(_) => {
                let weight = shaft.weight(g);
                sum.on_dofs.iter_mut().zip(weight).for_each(|(sum, w)| *sum += w);
            }
            ShaftKind::Rigid(rigid) => {
                let own = (0.0, rigid.mass);
                let points = scene.shaft.masses.iter().map(|m| (m.position, m.mass));
                for (position, mass) in points.chain([own]) {
                    let [x, y, z] = g.map(|a| mass * a);
                    sum.add(&shaft.station(position), [x, y, z, 0.0, 0.0]);
                }
            }
        }
        bearings
            .iter()
            .for_each(|bearing| add_weight(shaft, bearing, g, &mut sum));
    }
    Ok(sum)
}

/// Adds the weight of the body on the shaft under a bearing, as of a rigid one.
fn add_weight(shaft: &ShaftBody, bearing: &MountedBearing, g: [f64; 3], loads: &mut ShaftLoads) {
    let Some(inertia) = bearing.model.carried_inertia() else {
        return;
    };
    let Seating {
        position,
        orientation,
        ..
    } = bearing.place;
    let [_, _, moment] = orientation.turned_vector([0.0, 0.0, inertia.first_moment]);
    let [x, y, z] = g.map(|a| inertia.mass * a);
    // The arm stands at the bearing: a beam has a node there.
    let about = [-moment * g[1], moment * g[0]];
    loads.add(&shaft.station(position), [x, y, z, about[0], about[1]]);
    loads.add_arm(g.map(|a| moment * a));
}
