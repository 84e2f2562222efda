//! The body round the outer ring, from what a scene says of it.

use std::sync::Arc;

use assembly::Orientation;
use body::matrix::MatrixBody;
use body::{BodySeat, SeatCylinder, SeatSpace, SeatTie, Surrounding};
use dynamics::RingModel;
use fem::Material;

use crate::error::BuildError;
use crate::tables::{BodySource, Scene, SceneBody};

/// The joint of the outer ring with the body of the scene, if there is one: reads, factors and condenses it.
pub fn seat_tie(scene: &Scene, ring: &RingModel) -> Result<Option<Arc<SeatTie>>, BuildError> {
    let Some(body) = &scene.body else { return Ok(None) };
    let nodes = ring.mesh.group_nodes(ring.held_group);
    let what = "the seat of the outer ring";
    let numbered = nodes.iter().map(|&node| (node as u64 + 1, ring.mesh.nodes[node]));
    let cylinder = SeatCylinder::of_nodes(what, numbered)?;
    let seat = BodySeat {
        group: body.group.clone(),
        space: SeatSpace::on(&cylinder, body.basis),
        middle: body.z.map(|z| frame(body).turned_vector([0.0, 0.0, z])[2]),
    };
    // The ring must tell the functions apart too: sooner than after a long factorisation.
    let areas = fem::facet_node_weights(&ring.mesh, ring.mesh.group(ring.held_group));
    body::SeatFunctions::new(what, seat.space, &areas, |node| ring.mesh.nodes[node])?;
    let tie = SeatTie::to_body(Arc::new(surrounding(body, &seat)?));
    Ok(Some(Arc::new(match body.modes_below {
        Some(below) => tie.in_motion(below)?,
        None => tie,
    })))
}

fn surrounding(body: &SceneBody, seat: &BodySeat) -> Result<Surrounding, BuildError> {
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
            let seats = std::slice::from_ref(seat);
            let made_of = Material::new(m.young_modulus, m.poisson_ratio, m.density)?;
            Ok(Surrounding::of_mesh(
                &body.name,
                (mesh, &origin),
                made_of,
                fixed,
                seats,
            )?)
        }
        BodySource::Matrix(files) => {
            let mut matrix = MatrixBody::read(files)?;
            if body.is_turned {
                matrix.half_turn();
            }
            Ok(Surrounding::of_matrix(&body.name, &matrix, seat)?)
        }
    }
}

/// How a body stands to its mesh.
fn frame(body: &SceneBody) -> Orientation {
    match body.is_turned {
        true => Orientation::MinusZ,
        false => Orientation::PlusZ,
    }
}
