//! The region in which a scene keeps fields: of which points and cells, and what is left of a step outside.
//!
//! A node is inside by its place in the mesh of its ring, moved along the axis to where the ring sits, as `mesh.hdf`
//! shows it; a cell is inside if one of its nodes is. Balls are always inside.

use anyhow::anyhow;
use checkpoint::StepRecord;
use contact::{Groove, Side};
use dynamics::{Model, RingModel};
use scene::{Kept, OutputRegion, Scene};

use crate::failure::Failure;

/// Points and cells of which fields are kept.
#[derive(Clone, Debug)]
pub struct Region {
    /// The fields that are kept there only.
    fields: Kept,
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
            let inside = nodes_inside(asked, ring, side, model.ring_shift(side));
            let elements = ring.mesh.connectivity.chunks_exact(ring.mesh.kind.n_nodes());
            cells.extend(elements.map(|nodes| mark(nodes.iter().any(|&node| inside[node]))));
            points.extend(inside.into_iter().map(mark));
            found.push(extents(ring, side, model.ring_shift(side)));
        }
        if points.iter().all(|&inside| inside == 0.0) {
            return Err(Failure::User(anyhow!(
                "[output.region] holds no node: {}; expected a region with at least one of them",
                found.join("; ")
            )));
        }
        let n_balls = model.geometry.n_balls;
        points.resize(points.len() + n_balls, 1.0);
        cells.resize(cells.len() + n_balls, 1.0);
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
    pub fn fields(&self) -> Kept {
        self.fields
    }
}

fn mark(inside: bool) -> f64 {
    if inside { 1.0 } else { 0.0 }
}

/// Puts NaN into the rows outside.
fn leave(inside: &[f64], values: &mut [f64]) {
    let width = values.len() / inside.len();
    let rows = values.chunks_exact_mut(width).zip(inside);
    rows.filter(|(_, inside)| **inside == 0.0)
        .for_each(|(row, _)| row.fill(f64::NAN));
}

/// Whether each node of a ring is inside; `shift` moves its mesh along the axis to where it sits, m.
fn nodes_inside(asked: &OutputRegion, ring: &RingModel, side: Side, shift: f64) -> Vec<bool> {
    let inside = |&[x, y, z]: &[f64; 3]| {
        asked.rings[side.index()]
            && asked.has_azimuth(y.atan2(x))
            && asked.has_coordinates([x, y, z + shift])
            && asked
                .raceway_distance
                .is_none_or(|most| distance(&ring.groove, [x, y, z]) <= most)
    };
    ring.mesh.nodes.iter().map(inside).collect()
}

/// Distance of a place from the torus of a groove, m.
fn distance(groove: &Groove, [x, y, z]: [f64; 3]) -> f64 {
    let radial = x.hypot(y) - groove.centre_radius;
    (radial.hypot(z - groove.centre_z) - groove.groove_radius).abs()
}

/// What a ring has, for messages.
fn extents(ring: &RingModel, side: Side, shift: f64) -> String {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
            [a.min(x), b.max(x)]
        });
        format!("{:.3} to {:.3} mm", 1e3 * least, 1e3 * most)
    };
    let nodes = &ring.mesh.nodes;
    format!(
        "the {} ring has nodes {} from its groove, with z from {}",
        side.name(),
        range(&mut nodes.iter().map(|&place| distance(&ring.groove, place))),
        range(&mut nodes.iter().map(|place| place[2] + shift))
    )
}
