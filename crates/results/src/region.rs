//! The region in which a scene keeps fields: of which points and cells, and what is left of a step outside.
//!
//! A node is inside by its place in the mesh of its ring, moved along the axis to where the ring sits, as `mesh.hdf`
//! shows it; a cell is inside if one of its nodes is. Balls are always inside. A body round the outer ring has no
//! groove: it is outside where the region has a distance from one, or one ring.

use anyhow::anyhow;
use checkpoint::StepRecord;
use contact::{Groove, Side};
use dynamics::{Model, RingModel};
use mesh::Mesh;
use scene::{KeptFields, OutputRegion, Scene};

use super::bodies::{ShownBody, bodies_of};
use crate::failure::Failure;

/// Points and cells of which fields are kept.
#[derive(Clone, Debug)]
pub struct Region {
    /// The fields that are kept there only.
    fields: KeptFields,
    /// 1 inside, 0 outside, `[n_points]`.
    points: Vec<f64>,
    /// The same of cells, `[n_cells]`.
    cells: Vec<f64>,
}

impl Region {
    /// The region of a scene, of rings whose meshes are whole; None if it has none. Fails if it holds no node.
    pub fn new(scene: &Scene, model: &Model) -> Result<Option<Region>, Failure> {
        let Some(asked) = &scene.output.region else {
            return Ok(None);
        };
        let (mut points, mut cells, mut found) = (Vec::new(), Vec::new(), Vec::new());
        for side in Side::BOTH {
            let Some(ring) = model.ring(side) else { continue };
            let shift = [0.0, 0.0, model.ring_shift(side)];
            let is_near = |place| {
                asked
                    .raceway_distance
                    .is_none_or(|most| distance(&ring.groove, place) <= most)
            };
            let inside = nodes_inside(asked, &ring.mesh, shift, |place| {
                asked.rings[side.index()] && is_near(place)
            });
            mark_all(&inside, &ring.mesh, &mut points, &mut cells);
            found.push(extents(ring, side, shift));
        }
        let n_balls = model.geometry.n_balls;
        let mut of_body = (Vec::new(), Vec::new());
        for ShownBody {
            body, mesh, shift, ..
        } in bodies_of(model)
        {
            let is_of_rings = asked.raceway_distance.is_some() || asked.rings != [true; 2];
            let inside = nodes_inside(asked, mesh, shift, |_| !is_of_rings);
            mark_all(&inside, mesh, &mut of_body.0, &mut of_body.1);
            found.push(format!(
                "body {:?} has nodes with {}",
                body.name,
                range_of_z(mesh, shift)
            ));
        }
        if found.is_empty() {
            found.push("rigid rings have none".to_string());
        }
        if points.iter().chain(&of_body.0).all(|&inside| inside == 0.0) {
            return Err(Failure::User(anyhow!(
                "[output.region] holds no node: {}; expected a region with at least one of them",
                found.join("; ")
            )));
        }
        points.resize(points.len() + n_balls, 1.0);
        cells.resize(cells.len() + n_balls, 1.0);
        points.extend(of_body.0);
        cells.extend(of_body.1);
        Ok(Some(Region {
            fields: asked.fields,
            points,
            cells,
        }))
    }

    /// Takes the fields outside out of a step.
    pub fn apply(&self, record: &mut StepRecord) {
        let (points, cells) = (&mut record.points, &mut record.cells);
        if self.fields.displacement && !points.displacement.is_empty() {
            leave(&self.points, points.displacement.as_flattened_mut());
            points.in_region = Some(self.points.clone());
        }
        if !self.fields.stress {
            return;
        }
        if let Some(stress) = &mut points.stress {
            leave(&self.points, stress.as_flattened_mut());
            points.in_region = Some(self.points.clone());
        }
        if let Some(von_mises) = &mut points.von_mises {
            leave(&self.points, von_mises);
        }
        if let Some(stress) = &mut cells.stress_integration_points {
            leave(&self.cells, &mut stress.values);
            cells.in_region = Some(self.cells.clone());
        }
        if let Some(von_mises) = &mut cells.von_mises_largest {
            leave(&self.cells, von_mises);
        }
    }

    /// Share of the points that is inside, and of the cells.
    pub fn shares(&self) -> [f64; 2] {
        [&self.points, &self.cells].map(|inside| inside.iter().sum::<f64>() / inside.len() as f64)
    }

    /// The fields that are kept in it only.
    pub fn fields(&self) -> KeptFields {
        self.fields
    }
}

/// Adds the marks of the nodes of a mesh and of its elements.
fn mark_all(inside: &[bool], mesh: &Mesh, points: &mut Vec<f64>, cells: &mut Vec<f64>) {
    let mark = |inside: bool| if inside { 1.0 } else { 0.0 };
    let elements = mesh.connectivity.chunks_exact(mesh.kind.n_nodes());
    cells.extend(elements.map(|nodes| mark(nodes.iter().any(|&node| inside[node]))));
    points.extend(inside.iter().map(|&inside| mark(inside)));
}

/// Puts NaN into the rows outside.
fn leave(inside: &[f64], values: &mut [f64]) {
    let width = values.len() / inside.len();
    let rows = values.chunks_exact_mut(width).zip(inside);
    rows.filter(|(_, inside)| **inside == 0.0)
        .for_each(|(row, _)| row.fill(f64::NAN));
}

/// Whether each node of a mesh is inside; `shift` moves it to where it stands, m, and `is_asked` tells of a place in
/// the mesh what the region asks besides azimuth and coordinates.
fn nodes_inside(
    asked: &OutputRegion,
    mesh: &Mesh,
    shift: [f64; 3],
    is_asked: impl Fn([f64; 3]) -> bool,
) -> Vec<bool> {
    let inside = |&place: &[f64; 3]| {
        let [x, y, z] = std::array::from_fn(|i| place[i] + shift[i]);
        is_asked(place) && asked.has_azimuth(y.atan2(x)) && asked.has_coordinates([x, y, z])
    };
    mesh.nodes.iter().map(inside).collect()
}

/// Distance of a place from the torus of a groove, m.
fn distance(groove: &Groove, [x, y, z]: [f64; 3]) -> f64 {
    let radial = x.hypot(y) - groove.centre_radius;
    (radial.hypot(z - groove.centre_z) - groove.groove_radius).abs()
}

/// What a ring has, for messages.
fn extents(ring: &RingModel, side: Side, shift: [f64; 3]) -> String {
    let distances = ring.mesh.nodes.iter().map(|&place| distance(&ring.groove, place));
    format!(
        "the {} ring has nodes {} from its groove, with {}",
        side.name(),
        range(distances),
        range_of_z(&ring.mesh, shift)
    )
}

fn range_of_z(mesh: &Mesh, shift: [f64; 3]) -> String {
    format!(
        "z from {}",
        range(mesh.nodes.iter().map(|place| place[2] + shift[2]))
    )
}

/// Least and largest value of some, m.
fn range(values: impl Iterator<Item = f64>) -> String {
    let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
        [a.min(x), b.max(x)]
    });
    format!("{:.3} to {:.3} mm", 1e3 * least, 1e3 * most)
}
