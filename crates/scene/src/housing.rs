//! The bodies in which rings sit, from what a scene says of them.

use std::sync::Arc;

use assembly::Orientation;
use body::matrix::{MatrixBody, MatrixSeat};
use body::{BodySeat, SeatCylinder, SeatSpace, SeatTie, Surrounding};
use contact::Side;
use dynamics::RingModel;
use fem::Material;

use crate::error::BuildError;
use crate::tables::{BearingOnShaft, BodySource, RingName, Scene, SceneBody, SeveralScene};

/// Rings of a bearing, inner first.
pub type Rings = [Option<Arc<RingModel>>; 2];

/// Allowed difference of the distances of two seats in a body and of their bearings on the shaft, widths of a seat. The
/// rings of a bearing that just touches stand off each other along z: a share of the ball, with either sign.
const SEAT_DISTANCE_TOLERANCE: f64 = 0.05;
/// The same of inner rings, which stand off nothing.
const SHAFT_DISTANCE_TOLERANCE: f64 = 1e-3;

impl Scene {
    /// The same where the natural modes of its bodies are wanted although it does not move: modes over the speed.
    pub fn moving_by_modes(mut self) -> Scene {
        for body in self.bodies.iter_mut().flatten() {
            body.reads_mass = true;
        }
        self
    }
}

impl SeveralScene {
    /// The same of all bearings.
    pub fn moving_by_modes(mut self) -> SeveralScene {
        for bearing in &mut self.bearings {
            bearing.scene = bearing.scene.clone().moving_by_modes();
        }
        self
    }
}

/// The joint of a ring with its body in the scene, if there is one of its own: reads, factors and condenses it.
pub fn seat_tie(scene: &Scene, side: Side, ring: &RingModel) -> Result<Option<Arc<SeatTie>>, BuildError> {
    let body = scene.bodies[side.index()].as_ref();
    let Some(body) = body.filter(|body| !body.is_shared) else {
        return Ok(None);
    };
    let seats = [body_seat(body, ring)?];
    let body_of_ring = Arc::new(surrounding(&[body], &seats, &[ring])?);
    Ok(ties(body, body_of_ring)?.pop())
}

/// Ties the rings of a list to the bodies that carry several of them. `shifts` are those from the coordinates of the
/// rings of each side, inner first, to the place of its bearing on the shaft, that of the inner groove centres, m.
pub fn tie_together(
    bearings: &[BearingOnShaft],
    rings: &mut [Rings],
    shifts: &[Vec<f64>; 2],
) -> Result<(), BuildError> {
    Side::BOTH
        .into_iter()
        .try_for_each(|side| tie_side(side, bearings, rings, shifts))
}

fn tie_side(
    side: Side,
    bearings: &[BearingOnShaft],
    rings: &mut [Rings],
    shifts: &[Vec<f64>; 2],
) -> Result<(), BuildError> {
    let at = side.index();
    let shared = |i: &usize| {
        bearings[*i].scene.bodies[at]
            .as_ref()
            .filter(|body| body.is_shared)
    };
    let mut left: Vec<usize> = (0..bearings.len()).filter(|i| shared(i).is_some()).collect();
    while let Some(first) = left.first().copied() {
        let Some(body) = shared(&first) else { break };
        let in_body = |i: &usize| shared(i).is_some_and(|other| other.name == body.name);
        let (own, others): (Vec<usize>, Vec<usize>) = left.into_iter().partition(in_body);
        left = others;
        let (mut seats, mut of_seats) = (Vec::new(), Vec::new());
        for i in &own {
            if let (Some(of_bearing), Some(ring)) = (shared(i), &rings[*i][at]) {
                of_seats.push(of_bearing);
                seats.push(BodySeat {
                    is_turned: bearings[*i].orientation != bearings[first].orientation,
                    ..body_seat(of_bearing, ring)?
                });
            }
        }
        let sitting: Vec<&RingModel> = own.iter().filter_map(|&i| rings[i][at].as_deref()).collect();
        let made = Arc::new(surrounding(&of_seats, &seats, &sitting)?);
        let places: Vec<f64> = own
            .iter()
            .zip(&seats)
            .map(|(&i, seat)| {
                let along =
                    bearings[i]
                        .orientation
                        .turned_vector([0.0, 0.0, seat.space.middle + shifts[at][i]])[2];
                bearings[i].position + along
            })
            .collect();
        let names: Vec<&str> = own.iter().map(|&i| bearings[i].name.as_str()).collect();
        require_distances(&made, &names, &places, bearings[first].orientation)?;
        for (tie, i) in ties(body, made)?.into_iter().zip(own) {
            let ring = rings[i][at].as_mut().and_then(Arc::get_mut);
            ring.expect("the ring of a seat belongs to it alone").tie = Some(tie);
        }
    }
    Ok(())
}

/// Seats stand as far from each other as their bearings do on the shaft. `places` are those of the seats along it, m.
fn require_distances(
    body: &Surrounding,
    names: &[&str],
    places: &[f64],
    orientation: Orientation,
) -> Result<(), BuildError> {
    for k in 1..places.len() {
        let of_body = body.middles[k] - body.middles[0];
        let found = orientation.turned_vector([0.0, 0.0, of_body])[2];
        let expected = places[k] - places[0];
        let share = match body.carried {
            Some(_) => SHAFT_DISTANCE_TOLERANCE,
            None => SEAT_DISTANCE_TOLERANCE,
        };
        let limit = share * 2.0 * body.seats[k].space.half_width;
        if (found - expected).abs() > limit {
            return Err(BuildError::SeatDistance {
                body: body.name.clone(),
                bearings: [names[0].to_string(), names[k].to_string()],
                found_mm: 1e3 * found,
                expected_mm: 1e3 * expected,
                limit_mm: 1e3 * limit,
            });
        }
    }
    Ok(())
}

/// Share of its inertia by which a body on the shaft may differ from one of revolution, as which it turns and weighs.
const MOST_ASYMMETRY: f64 = 0.01;

/// The seat of a ring in its body.
fn body_seat(body: &SceneBody, ring: &RingModel) -> Result<BodySeat, BuildError> {
    let nodes = ring.mesh.group_nodes(ring.held_group);
    let what = match body.ring {
        RingName::Inner => "the bore of the inner ring",
        RingName::Outer => "the seat of the outer ring",
    };
    let numbered = nodes.iter().map(|&node| (node as u64 + 1, ring.mesh.nodes[node]));
    let cylinder = SeatCylinder::of_nodes(what, numbered)?;
    let seat = BodySeat {
        name: seat_name(body),
        space: SeatSpace::on(&cylinder, body.basis).on_ring(nodes.iter().map(|&node| ring.mesh.nodes[node])),
        middle: body.z.map(|z| frame(body).turned_vector([0.0, 0.0, z])[2]),
        is_turned: false,
    };
    // The ring must tell the functions apart too: sooner than after a long factorisation.
    let areas = fem::facet_node_weights(&ring.mesh, ring.mesh.group(ring.held_group));
    body::SeatFunctions::new(what, seat.space, &areas, |node| ring.mesh.nodes[node])?;
    Ok(seat)
}

/// The joints of all seats of a body, in their order.
fn ties(body: &SceneBody, made: Arc<Surrounding>) -> Result<Vec<Arc<SeatTie>>, BuildError> {
    let modes = body.modes_below.map(|below| made.modes(below)).transpose()?;
    let modes = modes.map(Arc::new);
    let tie = |seat: usize| {
        let tie = SeatTie::to_seat(made.clone(), seat);
        Arc::new(match &modes {
            Some(modes) => tie.in_motion(modes.clone()),
            None => tie,
        })
    };
    Ok((0..made.seats.len()).map(tie).collect())
}

/// What messages call the seat of a body: its facet group, the file of its nodes, or its reference node.
fn seat_name(body: &SceneBody) -> String {
    match &body.source {
        BodySource::Mesh { .. } => body.group.clone(),
        BodySource::Matrix(files) => {
            let name = |seat: &MatrixSeat| match seat {
                MatrixSeat::Nodes(path) => path.file_name().map(|name| name.to_string_lossy().into_owned()),
                MatrixSeat::Reference(tag) => Some(format!("node {tag}")),
            };
            files.seats.iter().filter_map(name).collect()
        }
    }
}

/// A body of the scenes `of_seats`, which are the same but for their seats, with the shaft that carries it under the
/// `rings` in its seats, or one that stands.
fn surrounding(
    of_seats: &[&SceneBody],
    seats: &[BodySeat],
    rings: &[&RingModel],
) -> Result<Surrounding, BuildError> {
    let body = of_seats[0];
    let loaded = |made: Surrounding, matrix: Option<&MatrixBody>| match body.is_loaded {
        true => made.with_loads(matrix),
        false => Ok(made),
    };
    match &body.source {
        BodySource::Mesh {
            mesh,
            mesh_unit,
            material: m,
            fixed,
        } => {
            let (mut mesh, origin) = mesh::read_body_msh(mesh, *mesh_unit)?;
            let turned = |x: &mut [f64; 3]| *x = frame(body).turned_vector(*x);
            mesh.nodes.iter_mut().for_each(turned);
            let made_of = Material::new(m.young_modulus, m.poisson_ratio, m.density)?;
            let made = Surrounding::of_mesh(&body.name, (mesh, &origin), made_of, fixed, seats)?;
            Ok(loaded(carried(made, body, rings)?, None)?)
        }
        BodySource::Matrix(files) => {
            let mut files = files.clone();
            files.mass = files.mass.filter(|_| body.reads_mass);
            files.seats = of_seats.iter().flat_map(|body| seats_of(body)).cloned().collect();
            let mut matrix = MatrixBody::read(&files)?;
            if body.is_turned {
                matrix.half_turn();
            }
            let made = Surrounding::of_matrix(&body.name, &matrix, seats)?;
            Ok(loaded(carried(made, body, rings)?, Some(&matrix))?)
        }
    }
}

/// Where the seats of a scene are in the matrices; none of a mesh.
fn seats_of(body: &SceneBody) -> &[MatrixSeat] {
    match &body.source {
        BodySource::Mesh { .. } => &[],
        BodySource::Matrix(files) => &files.seats,
    }
}

/// A body with the shaft that carries it under the `rings` in its seats, or one that stands.
fn carried(made: Surrounding, body: &SceneBody, rings: &[&RingModel]) -> Result<Surrounding, BuildError> {
    if body.ring == RingName::Outer {
        return Ok(made);
    }
    let origins: Vec<f64> = rings.iter().map(|ring| ring.groove.centre_z).collect();
    let made = made.on_shaft(&origins)?;
    let asymmetry = made.carried.as_ref().map_or(0.0, |carried| carried.asymmetry);
    if asymmetry > MOST_ASYMMETRY {
        return Err(BuildError::NotOfRevolution {
            body: body.name.clone(),
            found: 100.0 * asymmetry,
            limit: 100.0 * MOST_ASYMMETRY,
        });
    }
    Ok(made)
}

/// How a body stands to its mesh.
fn frame(body: &SceneBody) -> Orientation {
    match body.is_turned {
        true => Orientation::MinusZ,
        false => Orientation::PlusZ,
    }
}
