//! Areas that belong to nodes of a cylinder of which no facets are known: Voronoi cells on the unrolled surface.
//!
//! The cell of a node are the points that are nearer to it than to any other, cut off at the ends of the seat. It is
//! found exactly, by cutting a rectangle with the bisectors to the other nodes, nearest first. On a mesh of rows and
//! columns these are the areas of bilinear facets. Cost: the square of the number of nodes, 0.1 s for 2000.

use std::f64::consts::TAU;

use crate::seat::SeatCylinder;

/// Area of every node, m^2, in their order; nodes lie on the cylinder.
pub fn cylinder_areas(cylinder: &SeatCylinder, nodes: &[[f64; 3]]) -> Vec<f64> {
    let circle = TAU * cylinder.radius;
    let flat: Vec<[f64; 2]> = nodes
        .iter()
        .map(|x| [cylinder.radius * x[1].atan2(x[0]), x[2]])
        .collect();
    let cell = |i: usize| {
        let mut others: Vec<[f64; 2]> = Vec::with_capacity(flat.len());
        for (j, x) in flat.iter().enumerate() {
            if i != j {
                // The nearest image round the cylinder.
                let along = x[0] - flat[i][0];
                others.push([along - circle * (along / circle).round(), x[1] - flat[i][1]]);
            }
        }
        let size = |x: &[f64; 2]| x[0] * x[0] + x[1] * x[1];
        others.sort_by(|a, b| size(a).total_cmp(&size(b)));
        let [low, high] = cylinder.ends.map(|end| end - flat[i][1]);
        let half = 0.5 * circle;
        let mut polygon = vec![[-half, low], [half, low], [half, high], [-half, high]];
        for other in &others {
            let reach = polygon.iter().map(size).fold(0.0, f64::max);
            // A node farther than twice the farthest corner cuts nothing.
            if size(other) > 4.0 * reach {
                break;
            }
            polygon = cut(&polygon, other);
        }
        area(&polygon)
    };
    (0..flat.len()).map(cell).collect()
}

/// What of a convex polygon is nearer to the origin than to `other`.
fn cut(polygon: &[[f64; 2]], other: &[f64; 2]) -> Vec<[f64; 2]> {
    let half = 0.5 * (other[0] * other[0] + other[1] * other[1]);
    let beyond = |x: &[f64; 2]| x[0] * other[0] + x[1] * other[1] - half;
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (da, db) = (beyond(a), beyond(b));
        if da <= 0.0 {
            left.push(*a);
        }
        if (da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0) {
            let share = da / (da - db);
            left.push([0, 1].map(|c| a[c] + share * (b[c] - a[c])));
        }
    }
    left
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let twice: f64 = (0..polygon.len())
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum();
    0.5 * twice
}
