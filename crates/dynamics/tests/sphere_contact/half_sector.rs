//! Half a sector of a ring of the 7010C, from the meridian plane of a ball to that midway to the next one, and how its
//! raceway yields under pressures.

use std::f64::consts::PI;

use contact::{Groove, SemiAxes, Side};
use dynamics::Hold;
use fem::facet;
use fem::quadrature::quadrilateral;
use mesh::{ElementKind, Facet, Mesh};
use solver::{
    SparseVector, Symbolic, TriangularFactor, angular_dissection, expand, restrict, restrict_order,
};

use super::sphere::{Rectangle, Sphere};
use crate::support::graded::graded;
use crate::support::rings::{Columns, groove, measures, revolved};
use crate::support::steel;

/// Elements along both semi-axes of an ellipse, and in depth along its smaller one.
pub const ELEMENTS: [f64; 3] = [8.0, 6.0, 4.0];
/// Half-widths of the part of the raceway that may touch, in semi-axes.
const REACH: [f64; 2] = [1.2, 1.35];
/// How much larger an element is than its neighbour towards the contact.
const GROWTH: f64 = 1.6;
/// Angle of half a sector of 18 balls, rad.
const HALF_SECTOR: f64 = PI / 18.0;
/// Springs on the plane midway between two balls over the stiffness of its nodes.
const STIFF: f64 = 1e5;

/// About where a ball touches: contact angle, rad, and semi-axes, m. It places the elements, no more.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub angle: f64,
    pub semi_axes: SemiAxes,
}

/// A facet of the raceway under one pressure.
pub struct Cell {
    /// Points on the raceway, m, and their shares of the area.
    pub points: Vec<([f64; 3], f64)>,
    /// The cell, and its mirror image beyond the plane of the ball.
    pub flat: [Rectangle; 2],
    /// Motion into the ring, weighted by area: dofs and shares.
    mean: SparseVector,
}

/// The part of a raceway that a ball may touch.
pub struct Raceway {
    pub cells: Vec<Cell>,
    /// Mean motion of a cell into the ring per force on another one and on its mirror image, m/N, `[n][n]` flat.
    pub compliance: Vec<f64>,
    pub n_dofs: usize,
}

impl Raceway {
    pub fn new(side: Side, hold: Hold, place: Place, finer: f64) -> Raceway {
        let mesh = half_sector(side, place, finer);
        let cells = cells(&mesh, side, place);
        let compliance = compliance(&mesh, side, hold, &cells);
        Raceway {
            cells,
            compliance,
            n_dofs: mesh.n_dofs(),
        }
    }

    /// Cells of the same sizes on a half-space instead of a ring.
    pub fn on_half_space(side: Side, place: Place, finer: f64) -> Raceway {
        let own = groove(side);
        let [a, b] = place.semi_axes.into();
        let counts = [0, 1].map(|k| (REACH[k] * ELEMENTS[k] * finer).round());
        let step = [
            REACH[0] * a / own.groove_radius,
            REACH[1] * b / own.radius(place.angle),
        ];
        let step = [step[0] / counts[0], step[1] / counts[1]];
        let sign = own.side.sign();
        let at = |angle: f64, azimuth: f64| {
            let r = own.centre_radius + sign * own.groove_radius * angle.cos();
            let z = sign * own.groove_radius * angle.sin();
            [r * azimuth.cos(), r * azimuth.sin(), z]
        };
        let rule = quadrilateral(4);
        let mut cells = Vec::new();
        for i in -counts[0] as i32..counts[0] as i32 {
            for j in 0..counts[1] as i32 {
                let place = |x: f64, y: f64| {
                    let angle = place.angle + step[0] * (f64::from(i) + 0.5 + 0.5 * x);
                    at(angle, step[1] * (f64::from(j) + 0.5 + 0.5 * y))
                };
                let points = rule.points.iter().zip(&rule.weights);
                let centre = place(0.0, 0.0);
                let corners = [[-1.0, -1.0], [1.0, 1.0]].map(|[x, y]| place(x, y));
                let area = step[0] * own.groove_radius * step[1] * centre[0].hypot(centre[1]);
                cells.push(Cell {
                    points: points.map(|(x, w)| (place(x[0], x[1]), 0.25 * w)).collect(),
                    flat: [1.0, -1.0]
                        .map(|y| flat(&own, [centre[0], y * centre[1], centre[2]], &corners, area)),
                    mean: SparseVector::new(),
                });
            }
        }
        let plane = Sphere::half_space(&steel(), 1.0);
        let yields = |at: &Cell, load: &Cell| {
            load.flat
                .iter()
                .map(|flat| plane.between(&at.flat[0], flat))
                .sum()
        };
        let all = cells
            .iter()
            .flat_map(|at| cells.iter().map(move |load| (at, load)));
        Raceway {
            compliance: all.map(|(at, load)| yields(at, load)).collect(),
            n_dofs: 0,
            cells,
        }
    }
}

fn half_sector(side: Side, place: Place, finer: f64) -> Mesh {
    let (seat, shoulder, group) = measures(side);
    let own = groove(side);
    let edge = (own.side.sign() * (shoulder - own.centre_radius) / own.groove_radius).acos();
    let axial = own.side.sign() * place.angle;
    let [a, b] = place.semi_axes.into();
    let fine = |axis: f64, k: usize, reach: f64, radius: f64| {
        [axis / (ELEMENTS[k] * finer) / radius, reach * axis / radius]
    };
    let along = fine(a, 0, REACH[0], own.groove_radius);
    let up = graded(along, GROWTH, edge - axial, 0.1);
    let down = graded(along, GROWTH, edge + axial, 0.1);
    let angles = down
        .iter()
        .rev()
        .map(|x| axial - x)
        .chain(up[1..].iter().map(|x| axial + x));
    let thickness = (seat - own.radius(0.0)).abs();
    let rows = graded(fine(b, 2, 1.0, 1.0), GROWTH, thickness, thickness);
    let rolling = fine(b, 1, REACH[1], own.radius(place.angle));
    let azimuths = graded(rolling, GROWTH, HALF_SECTOR, 0.5 * HALF_SECTOR);
    let (layers, n) = (azimuths.len() - 1, azimuths.len() + 3);
    let columns = Columns {
        shares: angles.map(|x| x / edge).collect(),
        rows: rows.iter().map(|x| x / thickness).collect(),
        shoulder_elements: 2,
    };
    let ring = revolved(own, seat, shoulder, group, &columns, n, ElementKind::Hex20);
    let turn = |x: [f64; 3]| x[1].atan2(x[0]).rem_euclid(2.0 * PI) / (2.0 * PI) * n as f64;
    let lost: Vec<bool> = (0..ring.n_elements())
        .map(|e| turn(ring.element_centre(e)) > layers as f64)
        .collect();
    let (mut mesh, _) = ring.without_elements(|e| lost[e]);
    for x in &mut mesh.nodes {
        // Planes of corners, and of mid-edge nodes half-way between them.
        let half_plane = (2.0 * turn(*x)).round() as usize % (2 * n);
        let azimuth = 0.5 * (azimuths[half_plane / 2] + azimuths[half_plane.div_ceil(2)]);
        let r = x[0].hypot(x[1]);
        (x[0], x[1]) = (r * azimuth.cos(), r * azimuth.sin());
    }
    mesh
}

fn cells(mesh: &Mesh, side: Side, place: Place) -> Vec<Cell> {
    let own = groove(side);
    let reach = [
        REACH[0] * place.semi_axes.groove / own.groove_radius,
        REACH[1] * place.semi_axes.rolling / own.radius(place.angle),
    ];
    let is_near = |f: &&Facet| {
        let nodes: Vec<[f64; 3]> = mesh.facet_nodes(**f).map(|n| mesh.nodes[n]).collect();
        let centre = [0, 1, 2].map(|i| nodes.iter().map(|x| x[i]).sum::<f64>() / nodes.len() as f64);
        let off = (angle_of(&own, centre) - place.angle).abs();
        off < reach[0] && centre[1].atan2(centre[0]) < reach[1]
    };
    let near = mesh.group("raceway").iter().filter(is_near);
    near.map(|&facet| cell(mesh, &own, facet)).collect()
}

/// Contact angle of a ball that touches the groove at a point.
fn angle_of(own: &Groove, x: [f64; 3]) -> f64 {
    let sign = own.side.sign();
    (sign * x[2]).atan2(sign * (x[0].hypot(x[1]) - own.centre_radius))
}

/// Unit vector into the ring at a point of the raceway.
fn inwards(own: &Groove, x: [f64; 3]) -> [f64; 3] {
    let r = x[0].hypot(x[1]);
    let from = [r - own.centre_radius, x[2]].map(|c| c / own.groove_radius);
    [from[0] * x[0] / r, from[0] * x[1] / r, from[1]]
}

fn cell(mesh: &Mesh, own: &Groove, facet: Facet) -> Cell {
    let kind = mesh.kind.facet_kind();
    let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
    let x: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.nodes[n]).collect();
    let rule = quadrilateral(4);
    let (mut points, mut mean) = (Vec::new(), SparseVector::new());
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        let (position, area) = facet::point_and_area(kind, &x, *xi);
        let area = weight * area.iter().map(|c| c * c).sum::<f64>().sqrt();
        points.push((position, area));
        let into = inwards(own, position);
        for (&node, share) in nodes.iter().zip(facet::shape(kind, *xi)) {
            mean.extend((0..3).map(|c| (3 * node + c, area * share * into[c])));
        }
    }
    let area: f64 = points.iter().map(|(_, area)| area).sum();
    points.iter_mut().for_each(|(_, share)| *share /= area);
    mean.sort_by_key(|&(dof, _)| dof);
    mean.dedup_by(|(dof, more), (kept, value)| {
        let same = dof == kept;
        *value += if same { *more } else { 0.0 };
        same
    });
    mean.iter_mut().for_each(|(_, value)| *value /= area);
    let (centre, _) = facet::point_and_area(kind, &x, [0.0, 0.0]);
    Cell {
        points,
        flat: [1.0, -1.0].map(|y| flat(own, [centre[0], y * centre[1], centre[2]], &x, area)),
        mean,
    }
}

/// The rectangle of a cell, in its tangent plane: as wide in the rolling direction as the facet, and of its area.
fn flat(own: &Groove, centre: [f64; 3], nodes: &[[f64; 3]], area: f64) -> Rectangle {
    let r = centre[0].hypot(centre[1]);
    let rolling = [-centre[1] / r, centre[0] / r, 0.0];
    let into = inwards(own, centre);
    let azimuths = nodes.iter().map(|x| x[1].atan2(x[0]));
    let width = r * (azimuths.clone().fold(f64::MIN, f64::max) - azimuths.fold(f64::MAX, f64::min));
    Rectangle {
        centre,
        axes: [contact::cross(into, rolling), rolling],
        sides: [area / width, width],
    }
}

/// Compliance of the cells: planes of symmetry at both ends, and the hold of the seat.
fn compliance(mesh: &Mesh, side: Side, hold: Hold, cells: &[Cell]) -> Vec<f64> {
    let mut stiffness = fem::assemble_stiffness(mesh, &steel()).unwrap();
    let mut free = vec![true; mesh.n_dofs()];
    let normal = [-HALF_SECTOR.sin(), HALF_SECTOR.cos()];
    for (node, x) in mesh.nodes.iter().enumerate() {
        let azimuth = x[1].atan2(x[0]);
        if azimuth < 1e-9 {
            free[3 * node + 1] = false;
        } else if azimuth > HALF_SECTOR - 1e-9 {
            let size = STIFF * stiffness.get(3 * node, 3 * node).unwrap();
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                *stiffness.get_mut(3 * node + i, 3 * node + j).unwrap() += size * normal[i] * normal[j];
            }
        }
    }
    let seat = mesh.group(measures(side).2);
    let weights = fem::facet_node_weights(mesh, seat);
    let seat_area: f64 = weights.iter().map(|(_, w)| w).sum();
    let mut loads: Vec<SparseVector> = cells.iter().map(|cell| cell.mean.clone()).collect();
    match hold {
        Hold::Clamped => {
            for &(node, _) in &weights {
                (0..3).for_each(|c| free[3 * node + c] = false);
            }
        }
        Hold::MeanMotion => {
            // Symmetry leaves the motion along the axis alone, held by an even traction; a node holds what is balanced.
            free[3 * weights[0].0 + 2] = false;
            for load in &mut loads {
                let along: f64 = load.iter().filter(|(dof, _)| dof % 3 == 2).map(|(_, f)| f).sum();
                load.extend(
                    weights
                        .iter()
                        .map(|&(node, w)| (3 * node + 2, -along * w / seat_area)),
                );
            }
        }
        Hold::Free => unreachable!("a free ring has no equilibrium"),
    }
    let keep: Vec<usize> = (0..free.len()).filter(|&dof| free[dof]).collect();
    let order = expand(
        &angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes()),
        3,
    );
    let held = restrict(&stiffness, &keep);
    let factor = Symbolic::new(&held, &restrict_order(&order, &keep))
        .unwrap()
        .factor(&held)
        .unwrap();
    let number = |dof: usize| keep.binary_search(&dof).ok();
    for load in &mut loads {
        *load = load
            .iter()
            .filter_map(|&(dof, f)| Some((number(dof)?, f)))
            .collect();
    }
    let columns = TriangularFactor::new(factor).columns(&loads);
    columns.products(&columns)
}
