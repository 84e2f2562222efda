//! From a scene to the Model: reads and checks the meshes, evaluates Hertz theory, constructs the effects.

use std::sync::Arc;

use contact::hertz::Elastic;
use contact::{BearingGeometry, Groove, HertzContact, LeastSize, Side, SphereCompliance, sphere};
use dynamics::RACEWAY_GROUP;
use dynamics::effects::Setting;
use dynamics::kinematics::Rolling;
use dynamics::model::{ShaftInertia, elastic};
use dynamics::mounting::{Mounting, Unmounted};
use dynamics::{ContactSettings, Hold, Model, RingModel, ShaftDof, Surfaces, Tolerances};
use fem::Material;
use mesh::{Coverage, Cylinder, Mesh, Torus};

use crate::error::BuildError;
use crate::films::film_lift;
use crate::half_widths::half_widths;
use crate::housing::seat_tie;
use crate::marks::require_raceway_under_marks;
use crate::resolution::require_resolvable;
use crate::section_record::{require_fresh, with_command};
use crate::settings::speeds;
use crate::surfaces::{shoulders, surfaces};
use crate::tables::{self, FlexibleRing, Scene};

/// Least semi-axis of a patch on quadratic elements in the rolling direction, ball diameters. A patch of one such
/// element has a pressure that grows with refinement, and so have the errors of the stress beside it (docs/stress.md).
const LEAST_QUADRATIC_PATCH: f64 = 0.21;

/// Deviation of raceway nodes from the scene's torus that is taken for round-off of a file, over the groove
/// radius.
const TORUS_TOLERANCE: f64 = 2e-4;

/// Deviation of the corners of a bore or seat from a cylinder that is taken for round-off of a file, over its radius.
const CYLINDER_TOLERANCE: f64 = 1e-5;

/// Gmsh tags of the nodes of flexible rings, inner first, `[n_nodes]`.
pub type NodeTags = [Option<Vec<u64>>; 2];

/// The model of a scene, and the numbers of its nodes in the mesh files. Reads both meshes.
pub fn build_model(scene: &Scene) -> Result<(Model, NodeTags), BuildError> {
    let geometry = geometry(scene);
    geometry.validate()?;
    require_resolvable(scene, &geometry)?;
    // Before the meshes are read: whether a hollow ball has contacts.
    let materials = [
        material(&scene.materials.balls)?,
        material(&scene.materials.rings)?,
    ];
    let hertz = hertz(scene, &geometry, materials.each_ref().map(elastic));
    require_wall(scene, geometry.ball_diameter, &hertz)?;
    let [inner, outer] = Side::BOTH;
    let rings = rayon::join(|| ring(scene, &geometry, inner), || ring(scene, &geometry, outer));
    let (inner, inner_tags) = rings.0?.unzip();
    let (outer, outer_tags) = rings.1?.unzip();
    for (side, ring) in Side::BOTH.into_iter().zip([&inner, &outer]) {
        if let Some(ring) = ring {
            require_raceway_under_marks(scene, &geometry, side, ring)?;
        }
    }
    let model = model_with_rings(scene, [inner.map(Arc::new), outer.map(Arc::new)])?;
    Ok((model, [inner_tags, outer_tags]))
}

/// How balls and cage roll; None when the scene has no speed.
pub fn rolling(scene: &Scene) -> Option<Rolling> {
    let speeds = scene.speed.clone();
    speeds.map(|speeds| Rolling::new(&geometry(scene), speeds, scene.effects.slip()))
}

/// The model of a scene with rings that were read before: the points of a sweep share them.
pub fn model_with_rings(scene: &Scene, rings: [Option<Arc<RingModel>>; 2]) -> Result<Model, BuildError> {
    let geometry = geometry(scene);
    let (ring_steel, ball_steel) = (
        material(&scene.materials.rings)?,
        material(&scene.materials.balls)?,
    );
    let elastics = [&ball_steel, &ring_steel].map(elastic);
    let hertz = hertz(scene, &geometry, elastics);
    require_wall(scene, geometry.ball_diameter, &hertz)?;
    let sphere = sphere_compliance(scene, &geometry, elastics[0], &hertz);
    let effects = scene.effects.loads(Setting {
        speeds: &speeds(scene),
        slip: scene.effects.slip(),
        ball_speeds: scene.ball_speeds,
        rings: &rings,
        lubricant: scene.lubricant.map(|lubrication| lubrication.lubricant),
    })?;
    let mounting = mounting(scene, &geometry, &rings)?;
    let (shaft, ring) = (&scene.shaft, scene.inner.inertia);
    let contact = contact_settings(scene, &geometry, &rings);
    let shoulders = shoulders(scene, &geometry, &rings);
    let dofs = [shaft.x, shaft.y, shaft.z, shaft.tilt_x, shaft.tilt_y].map(|motion| match motion {
        tables::ShaftMotion::Free => ShaftDof::Free,
        tables::ShaftMotion::Locked => ShaftDof::Prescribed(0.0),
        tables::ShaftMotion::Prescribed(value) => ShaftDof::Prescribed(value),
    });
    let mut model = Model {
        geometry,
        hertz,
        sphere,
        surfaces: Surfaces::default(),
        film_lift: [0.0; 2],
        shoulders,
        rings,
        other_seats: [None, None],
        weighs_carried: true,
        mounting,
        ball_material: ball_steel,
        ball_inner_diameter: scene.bearing.ball_inner_diameter,
        ring_material: ring_steel,
        shaft: dofs,
        shaft_schedules: shaft.schedules.clone(),
        shaft_mass: shaft.mass + ring.map_or(0.0, |r| r.mass),
        shaft_inertia: ShaftInertia {
            transverse: shaft.inertia.transverse + ring.map_or(0.0, |r| r.transverse),
            polar: shaft.inertia.polar + ring.map_or(0.0, |r| r.polar),
        },
        load_point: shaft.load_point,
        cage: scene.cage.clone(),
        contact,
        effects,
        backend: scene.solver.of_rings(),
        tolerances: Tolerances {
            force: scene.solver.tolerance,
            max_rounds: scene.solver.max_iterations,
        },
    };
    add_surfaces(scene, &mut model)?;
    Ok(model)
}

/// Real surfaces, and films between them.
fn add_surfaces(scene: &Scene, model: &mut Model) -> Result<(), BuildError> {
    let half_widths = half_widths(scene, model);
    model.surfaces = surfaces(scene, &model.geometry, &model.hertz, &model.rings, half_widths)?;
    model.film_lift = film_lift(scene, model, rolling(scene));
    Ok(())
}

/// Laws of the contacts of balls and rings of these elasticities.
fn hertz(scene: &Scene, geometry: &BearingGeometry, [ball, ring]: [Elastic; 2]) -> [HertzContact; 2] {
    let given = [scene.contact.inner_stiffness, scene.contact.outer_stiffness];
    Side::BOTH.map(|side| {
        let exact = HertzContact::new(geometry, side, ball, ring);
        given[side.index()].map_or(exact, |k| exact.with_stiffness(k))
    })
}

/// Fails if the wall of a hollow ball is too thin for its contacts, of balls of this diameter.
fn require_wall(scene: &Scene, diameter: f64, hertz: &[HertzContact; 2]) -> Result<(), BuildError> {
    let cavity = scene.bearing.ball_inner_diameter;
    let (wall, least) = (0.5 * (diameter - cavity), sphere::least_wall(hertz));
    if cavity > 0.0 && wall < least {
        return Err(BuildError::ThinWall {
            path: scene.path.clone(),
            cavity_mm: 1e3 * cavity,
            wall_mm: 1e3 * wall,
            least_mm: 1e3 * least,
            most_mm: 1e3 * (diameter - 2.0 * least),
        });
    }
    Ok(())
}

/// What balls yield beyond half-spaces.
fn sphere_compliance(
    scene: &Scene,
    geometry: &BearingGeometry,
    ball: Elastic,
    hertz: &[HertzContact; 2],
) -> SphereCompliance {
    let (diameter, cavity) = (geometry.ball_diameter, scene.bearing.ball_inner_diameter);
    match scene.contact.ball {
        tables::BallElasticity::Sphere => SphereCompliance::of_shell(ball, diameter, cavity, hertz),
        tables::BallElasticity::HalfSpace => SphereCompliance::default(),
    }
}

/// How contacts press on rings.
fn contact_settings(
    scene: &Scene,
    geometry: &BearingGeometry,
    rings: &[Option<Arc<RingModel>>; 2],
) -> ContactSettings {
    let is_quadratic = |ring: &RingModel| ring.mesh.kind.n_nodes() > ring.mesh.kind.n_corners();
    let least_length = match rings.iter().flatten().any(|ring| is_quadratic(ring)) {
        true => LEAST_QUADRATIC_PATCH * geometry.ball_diameter,
        false => 0.0,
    };
    let patch_length = scene.contact.patch_length.unwrap_or(least_length);
    ContactSettings {
        mode: scene.contact.mode,
        least_patch: LeastSize {
            spacings: scene.contact.patch_elements,
            rolling: patch_length,
        },
        projects_grooves: scene.contact.groove_circle == tables::SeenGroove::Projected,
    }
}

/// What fits and temperatures do to the bearing.
fn mounting(
    scene: &Scene,
    geometry: &BearingGeometry,
    rings: &[Option<Arc<RingModel>>; 2],
) -> Result<Mounting, BuildError> {
    let materials = &scene.materials;
    let speeds = speeds(scene);
    let largest = |side: Side| {
        speeds
            .of(side)
            .values
            .iter()
            .fold(0.0, |most: f64, v| most.max(v.abs()))
    };
    let bearing = Unmounted {
        geometry,
        seat_diameters: [scene.bearing.bore_diameter, scene.bearing.outside_diameter],
        rings,
        ring_material: material(&materials.rings)?,
        expansion: [materials.rings, materials.balls].map(|m| m.expansion.unwrap_or(0.0)),
        yield_strength: materials.rings.yield_strength,
        speeds: Side::BOTH.map(largest),
        backend: scene.solver.of_rings(),
    };
    Ok(Mounting::new(&bearing, &scene.effects.conditions())?)
}

/// Dimensions of the bearing, for the contacts.
pub fn geometry(scene: &Scene) -> BearingGeometry {
    let b = &scene.bearing;
    BearingGeometry {
        n_balls: b.balls,
        ball_diameter: b.ball_diameter,
        inner_raceway_diameter: b.inner_raceway_diameter,
        outer_raceway_diameter: b.outer_raceway_diameter,
        inner_groove_radius: b.inner_groove_radius,
        outer_groove_radius: b.outer_groove_radius,
        first_ball_azimuth: b.first_ball_azimuth,
    }
}

/// A material, checked.
pub fn material(m: &tables::MaterialProperties) -> Result<Material, BuildError> {
    Ok(Material::new(m.young_modulus, m.poisson_ratio, m.density)?)
}

/// Reads and checks the mesh of one ring, and tells its nodes' tags; None for a rigid ring.
fn ring(
    scene: &Scene,
    geometry: &BearingGeometry,
    side: Side,
) -> Result<Option<(RingModel, Vec<u64>)>, BuildError> {
    let (ring, held_group, diameter) = of_side(scene, side);
    let Some(body) = &ring.body else { return Ok(None) };
    let section = ring.section.as_ref();
    require_fresh(scene, side, body, section)?;
    let (mesh, origin) = mesh::read_msh_with_origin(&body.mesh, body.mesh_unit)?;
    mesh::check_unit(&mesh, &origin, diameter)?;
    mesh::require_groups(&mesh, &body.mesh, &[RACEWAY_GROUP, held_group])?;
    mesh::require_apart(&mesh, &origin, [RACEWAY_GROUP, held_group])?;
    let groove = groove(geometry, side, body.groove_z);
    let torus = torus(&groove);
    mesh::check_torus(
        &mesh,
        &origin,
        RACEWAY_GROUP,
        &torus,
        TORUS_TOLERANCE * groove.groove_radius,
    )
    .map_err(|error| with_command(error, scene, section))?;
    if !body.is_partial {
        let remedy = format!("say so in the scene: {}.partial = true", side.name());
        for (group, coverage) in coverages(&mesh, held_group, &torus) {
            mesh::check_whole(&mesh, &origin, group, coverage, &remedy)?;
        }
    }
    let (mesh, nodes) = cut(mesh, body)?;
    let node_tags = nodes.iter().map(|&node| origin.node_tags[node]).collect();
    let steel = material(&scene.materials.rings)?;
    let Some(mut ring) = ring_of(scene, side, steel, mesh) else {
        return Ok(None);
    };
    if body.support == tables::Support::Body {
        ring.tie = seat_tie(scene, side, &ring)?;
    }
    Ok(Some((ring, node_tags)))
}

/// What the groups of a ring have of the surfaces of revolution that they should be the whole of: raceway, and bore or
/// seat.
pub fn coverages(
    mesh: &Mesh,
    held_group: &'static str,
    torus: &Torus,
) -> [(&'static str, Option<Coverage>); 2] {
    let cylinder = Cylinder::of_group(mesh, held_group);
    let tolerance = TORUS_TOLERANCE * torus.groove_radius;
    let raceway = mesh::coverage(mesh, RACEWAY_GROUP, torus, tolerance);
    let held = mesh::coverage(mesh, held_group, &cylinder, CYLINDER_TOLERANCE * cylinder.radius);
    [(RACEWAY_GROUP, raceway), (held_group, held)]
}

/// The mesh of a ring without what the scene cuts out, and the old numbers of its nodes.
fn cut(mesh: Mesh, body: &FlexibleRing) -> Result<(Mesh, Vec<usize>), BuildError> {
    if body.cuts.is_empty() {
        let nodes = (0..mesh.n_nodes()).collect();
        return Ok((mesh, nodes));
    }
    let user = |problem: String| {
        Err(BuildError::Cut {
            path: body.mesh.clone(),
            problem,
        })
    };
    let mut is_lost = vec![false; mesh.n_elements()];
    for (cut, number) in body.cuts.iter().zip(1..) {
        let held: Vec<usize> = (0..is_lost.len())
            .filter(|&e| cut.holds(mesh.element_centre(e)))
            .collect();
        if held.is_empty() {
            return user(format!(
                "no element has its centre in the region of cut {number}; expected one at least, check its azimuth, \
                 radius and z"
            ));
        }
        held.into_iter().for_each(|e| is_lost[e] = true);
    }
    let groups: Vec<String> = mesh.groups.keys().cloned().collect();
    let (left, nodes) = mesh.without_elements(|e| is_lost[e]);
    if let Some(group) = groups.iter().find(|name| left.group(name).is_empty()) {
        return user(format!(
            "the cuts take all facets of the group \"{group}\"; cut less"
        ));
    }
    Ok((left, nodes))
}

/// The ring of one side with a mesh that was checked; None for a rigid ring.
pub fn ring_of(scene: &Scene, side: Side, material: Material, mesh: Mesh) -> Option<RingModel> {
    let body = of_side(scene, side).0.body.as_ref()?;
    Some(RingModel {
        mesh,
        material,
        hold: match body.support {
            tables::Support::Clamped => Hold::Clamped,
            // A body takes the place of the rigid partner.
            tables::Support::MeanMotion | tables::Support::Body => Hold::MeanMotion,
        },
        held_group: of_side(scene, side).1,
        groove: groove(&geometry(scene), side, body.groove_z),
        tie: None,
        sectors: Default::default(),
    })
}

/// The ring of one side in the scene, the facet group that is held, and the diameter by which the unit of its mesh is
/// checked, m.
fn of_side(scene: &Scene, side: Side) -> (&tables::Ring, &'static str, f64) {
    side.choose(
        (&scene.inner, "bore", scene.bearing.inner_raceway_diameter),
        (&scene.outer, "seat", scene.bearing.outside_diameter),
    )
}

/// The surface of a groove.
pub fn torus(groove: &Groove) -> Torus {
    Torus {
        centre_radius: groove.centre_radius,
        groove_radius: groove.groove_radius,
        centre_z: groove.centre_z,
    }
}

fn groove(geometry: &BearingGeometry, side: Side, centre_z: f64) -> Groove {
    Groove {
        side,
        centre_radius: geometry.centre_radius(side),
        groove_radius: geometry.groove_radius(side),
        centre_z,
    }
}
