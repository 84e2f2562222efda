//! The nodes of the raceways in the step files, in coordinates of their grooves.
//!
//! A node belongs to a raceway if it lies on its torus. Its azimuth is that in space: the inner ring of a motion is
//! turned in the step files.

use std::collections::BTreeMap;
use std::path::Path;

use checkpoint::{Grid, StepRecord};
use contact::{BearingGeometry, Groove, Side};
use results::table::Table;
use scene::{MeshFiles, Scene, geometry};

use super::quantity::DEGREE;

/// Value of the cell array `body` on the balls.
const BALLS: u8 = 2;

/// Cells of the balls.
pub fn ball_cells(grid: &Grid) -> impl Iterator<Item = usize> {
    (0..grid.body.len()).filter(|&cell| grid.body[cell] == BALLS)
}

/// How far a node may lie off the torus, in groove radii: meshes are exact to rounding in their files.
const ON_TORUS: f64 = 1e-4;

/// A node of a raceway with its stress.
#[derive(Clone, Copy, Debug)]
pub struct RacewayNode {
    /// Azimuth in space, deg, 0 to 360.
    pub azimuth: f64,
    /// Groove angle, deg, + as contact angles are.
    pub groove_angle: f64,
    /// Von Mises stress, Pa.
    pub von_mises: f64,
}

/// What the scene of a step says of its raceways.
pub struct Raceways {
    /// The grooves, inner first.
    pub grooves: [Groove; 2],
    /// What a reader must know of their stress.
    pub note: &'static str,
}

/// Where the stress under a ball is not that of its contact.
const WITHOUT_NEAR_FIELD: &str = "Without near field: stress of forces spread over the contact patches, \
                                  far below that under a ball";

/// Where it is, nodes alone show it.
const AT_NODES: &str =
    "Stress at the nodes of the mesh, that of the Hertz contacts included; its peak may lie between nodes";

/// The raceways of a step.
pub fn raceways(record: &StepRecord) -> anyhow::Result<Raceways> {
    let scene = Scene::parse(
        &record.scene,
        Path::new("scene of the step"),
        &[],
        MeshFiles::MayBeMissing,
    )?;
    let geometry = geometry(&scene);
    Ok(Raceways {
        grooves: Side::BOTH.map(|side| groove(&geometry, side)),
        note: match scene.stress.near_field_reach {
            Some(_) => AT_NODES,
            None => WITHOUT_NEAR_FIELD,
        },
    })
}

/// The largest of the values of the nodes of a body: one scale for all figures of a ring.
pub fn largest_of_body(grid: &Grid, values: &[f64], body: u8) -> f64 {
    let cells = grid.offsets.windows(2).zip(&grid.body);
    let of_body = cells.filter(|(_, b)| **b == body).map(|(ends, _)| ends);
    let nodes = of_body.flat_map(|ends| &grid.connectivity[ends[0] as usize..ends[1] as usize]);
    nodes.map(|&node| values[node as usize]).fold(0.0, f64::max)
}

fn groove(geometry: &BearingGeometry, side: Side) -> Groove {
    let centre = geometry.groove_centre(side);
    Groove {
        side,
        centre_radius: centre.radial,
        groove_radius: geometry.groove_radius(side),
        centre_z: centre.axial,
    }
}

/// The nodes on a groove with their stress; none if the step has no nodal stress.
pub fn nodes(grid: &Grid, record: &StepRecord, groove: &Groove) -> Vec<RacewayNode> {
    let Some(von_mises) = &record.points.von_mises else {
        return Vec::new();
    };
    let places = grid.points.iter().zip(&record.points.displacement);
    let own = |x: &[f64; 3]| x[1].atan2(x[0]);
    let moved = |x: &[f64; 3], u: &[f64; 3]| (x[1] + u[1]).atan2(x[0] + u[0]);
    // Nodes whose displacement is not kept (output.region) have turned with the others of the ring.
    let mut on_ring = places.clone().filter(|(x, _)| on_torus(**x, groove));
    let known = on_ring.find(|(_, u)| !u[0].is_nan());
    let turn = known.map_or(0.0, |(x, u)| moved(x, u) - own(x));
    let nodes: Vec<RacewayNode> = places
        .zip(von_mises)
        .filter(|((x, _), _)| on_torus(**x, groove))
        .map(|((x, u), &von_mises)| {
            let [_, angle] = groove.coordinates(*x);
            let azimuth = if u[0].is_nan() { own(x) + turn } else { moved(x, u) };
            RacewayNode {
                azimuth: azimuth.to_degrees().rem_euclid(360.0),
                groove_angle: angle.to_degrees(),
                von_mises,
            }
        })
        .collect();
    // A ring of which nothing is kept (output.region) has no figure.
    match nodes.iter().all(|node| node.von_mises.is_nan()) {
        true => Vec::new(),
        false => nodes,
    }
}

/// Whether a point of the mesh is on a raceway.
pub fn on_torus(x: [f64; 3], groove: &Groove) -> bool {
    let radial = x[0].hypot(x[1]) - groove.centre_radius;
    let distance = radial.hypot(x[2] - groove.centre_z);
    let towards_raceway = radial * groove.side.sign() > 0.0;
    towards_raceway && (distance / groove.groove_radius - 1.0).abs() < ON_TORUS
}

/// Nodes by their groove angle in rows, each row in the order of its azimuths; the raceways of revolved meshes are such
/// grids, a free mesh gives rows of few nodes.
pub fn rows(nodes: &[RacewayNode]) -> BTreeMap<i64, Vec<RacewayNode>> {
    let mut rows: BTreeMap<i64, Vec<RacewayNode>> = BTreeMap::new();
    for node in nodes {
        rows.entry((1e3 * node.groove_angle).round() as i64)
            .or_default()
            .push(*node);
    }
    for row in rows.values_mut() {
        row.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth));
    }
    rows
}

/// Stress at an azimuth from the nodes of a row, linear between neighbours.
pub fn at_azimuth(row: &[RacewayNode], azimuth: f64) -> f64 {
    let azimuth = azimuth.rem_euclid(360.0);
    let after = row.partition_point(|node| node.azimuth <= azimuth);
    let (before, next) = (row[(after + row.len() - 1) % row.len()], row[after % row.len()]);
    let gap = (next.azimuth - before.azimuth).rem_euclid(360.0);
    if gap == 0.0 {
        return before.von_mises;
    }
    let part = (azimuth - before.azimuth).rem_euclid(360.0) / gap;
    before.von_mises + part * (next.von_mises - before.von_mises)
}

/// Forces that differ by less, relative to the largest, are equal: round-off does not choose the ball.
const EQUAL: f64 = 1e-6;

/// The first of the balls with the largest force on a raceway in a step, and its azimuth, deg: by the table of balls,
/// or without it by the forces in the step file. None if no ball is loaded there.
pub fn most_loaded(
    table: Option<&Table>,
    (grid, record): (&Grid, &StepRecord),
    groove: &Groove,
) -> anyhow::Result<Option<(usize, f64)>> {
    match table {
        Some(table) => most_loaded_row(table, record.step, groove).map(Some),
        None => Ok(most_loaded_point(grid, record, groove.side)),
    }
}

fn most_loaded_point(grid: &Grid, record: &StepRecord, side: Side) -> Option<(usize, f64)> {
    let points = &record.points;
    let forces = side.choose(&points.force_inner, &points.force_outer).as_ref()?;
    let balls: Vec<usize> = ball_cells(grid)
        .filter_map(|cell| grid.cell(cell).next())
        .collect();
    let force = |&point: &usize| forces[point].iter().map(|f| f * f).sum::<f64>().sqrt();
    let largest = balls.iter().map(force).fold(0.0, f64::max);
    let ball = balls
        .iter()
        .position(|point| largest > 0.0 && force(point) >= largest * (1.0 - EQUAL))?;
    let (x, u) = (grid.points[balls[ball]], points.displacement[balls[ball]]);
    let azimuth = (x[1] + u[1]).atan2(x[0] + u[0]);
    Some((ball, (azimuth * DEGREE.factor).rem_euclid(360.0)))
}

fn most_loaded_row(table: &Table, step: u64, groove: &Groove) -> anyhow::Result<(usize, f64)> {
    let force = table.column(&format!("{}_force_n", groove.side.name()))?;
    let (steps, ball, azimuth) = (
        table.column("step")?,
        table.column("ball")?,
        table.column("azimuth_rad")?,
    );
    let rows: Vec<usize> = (0..table.n_rows())
        .filter(|&row| steps[row] == step as f64)
        .collect();
    let largest = rows.iter().map(|&row| force[row]).fold(0.0, f64::max);
    let row = rows
        .into_iter()
        .find(|&row| force[row] >= largest * (1.0 - EQUAL));
    let row = row.ok_or_else(|| anyhow::anyhow!("balls.csv has no rows of step {step}"))?;
    Ok((
        ball[row] as usize,
        (azimuth[row] * DEGREE.factor).rem_euclid(360.0),
    ))
}

#[cfg(test)]
mod tests {
    use checkpoint::PointFields;

    use super::*;

    /// Wrong: places of which nothing is kept (`output.region`) would get the stress of their neighbours, or stand
    /// where the ring was before it turned. Two nodes of a groove of radius 1 on a circle of 10, at 0 and 90 degrees;
    /// the ring has turned by 30.
    #[test]
    fn nodes_outside_the_region_turn_with_the_ring_and_have_no_stress() {
        let groove = Groove {
            side: Side::Outer,
            centre_radius: 10.0,
            groove_radius: 1.0,
            centre_z: 0.0,
        };
        let grid = Grid {
            points: vec![[0.0, 11.0, 0.0], [11.0, 0.0, 0.0]],
            connectivity: Vec::new(),
            offsets: vec![0],
            types: Vec::new(),
            body: Vec::new(),
            radius: Vec::new(),
        };
        let (sin, cos) = 30.0_f64.to_radians().sin_cos();
        let record = StepRecord {
            points: PointFields {
                displacement: vec![[f64::NAN; 3], [11.0 * (cos - 1.0), 11.0 * sin, 0.0]],
                von_mises: Some(vec![f64::NAN, 1e6]),
                ..PointFields::default()
            },
            ..StepRecord::default()
        };
        let found = nodes(&grid, &record, &groove);
        assert!((found[0].azimuth - 120.0).abs() < 1e-9 && found[0].von_mises.is_nan());
        assert!((found[1].azimuth - 30.0).abs() < 1e-9 && found[1].von_mises == 1e6);
    }
}
