//! The meshes of the rings cut along a half-plane through the axis.
//!
//! An element is divided into tetrahedra between its centre and the triangles of its faces; a face of four corners is
//! four triangles about its middle. Centres have the mean of the corners. A field is linear in each tetrahedron, so it
//! is linear in each triangle of the cut. Nodes between corners are not used. A mesh with nodes in the plane is cut
//! along their faces.

use checkpoint::Grid;
use figure::Triangle;

/// Faces of a hexahedron and of a tetrahedron, by the corners in the order of VTK.
const HEXAHEDRON: [&[usize]; 6] = [
    &[0, 3, 2, 1],
    &[4, 5, 6, 7],
    &[0, 1, 5, 4],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[3, 0, 4, 7],
];
const TETRAHEDRON: [&[usize]; 4] = [&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3]];
/// Parts of the distance from the axis that count as no distance from the plane: rings that tilt move nodes by less,
/// and would be cut into slivers.
const IN_PLANE: f64 = 1e-3;
/// Parts of the radius squared that are no area.
const NO_AREA: f64 = 1e-12;

/// The faces of a cell, by its VTK type; none for what is no body.
fn faces(vtk_type: u8) -> Option<(usize, &'static [&'static [usize]])> {
    match vtk_type {
        12 | 25 => Some((8, &HEXAHEDRON)),
        10 | 24 => Some((4, &TETRAHEDRON)),
        _ => None,
    }
}

/// A point of the mesh as the plane sees it: distance from the plane, place along it, z, and the value.
type Seen = [f64; 4];

/// The triangles of a body, `[axial place, radius]` in m, in the half-plane at an azimuth, rad.
pub fn at_azimuth(grid: &Grid, points: &[[f64; 3]], values: &[f64], body: u8, azimuth: f64) -> Vec<Triangle> {
    let (sin, cos) = azimuth.sin_cos();
    let seen = |node: usize| -> Seen {
        let [x, y, z] = points[node];
        [y * cos - x * sin, x * cos + y * sin, z, values[node]]
    };
    let mut triangles = Vec::new();
    for (cell, &vtk_type) in grid.types.iter().enumerate() {
        let Some((n_corners, faces)) = faces(vtk_type).filter(|_| grid.body[cell] == body) else {
            continue;
        };
        let first = grid.offsets[cell] as usize;
        let corners: Vec<Seen> = grid.connectivity[first..first + n_corners]
            .iter()
            .map(|&node| in_plane(seen(node as usize)))
            .collect();
        let has = |side: f64| corners.iter().any(|p| side * p[0] > 0.0);
        let centre = mean(&corners);
        if !has(1.0) || !has(-1.0) || centre[1] <= 0.0 {
            continue;
        }
        for face in faces {
            let of_face: Vec<Seen> = face.iter().map(|&i| corners[i]).collect();
            match of_face.as_slice() {
                [a, b, c] => cut([*a, *b, *c, centre], &mut triangles),
                four => {
                    let middle = mean(four);
                    for i in 0..four.len() {
                        cut(
                            [four[i], four[(i + 1) % four.len()], middle, centre],
                            &mut triangles,
                        );
                    }
                }
            }
        }
    }
    triangles
}

/// A node in the plane counts as one before it, so that one of the two cells that share it is cut.
fn in_plane(mut point: Seen) -> Seen {
    let tiny = IN_PLANE * point[1].abs();
    if point[0].abs() <= tiny {
        point[0] = f64::MIN_POSITIVE;
    }
    point
}

fn mean(points: &[Seen]) -> Seen {
    std::array::from_fn(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64)
}

/// Cuts a tetrahedron: nothing, a triangle, or a quadrangle as two.
fn cut(corners: [Seen; 4], triangles: &mut Vec<Triangle>) {
    let (before, behind): (Vec<Seen>, Vec<Seen>) = corners.iter().partition(|p| p[0] > 0.0);
    let on = |p: &Seen, q: &Seen| -> Seen {
        let t = p[0] / (p[0] - q[0]);
        std::array::from_fn(|k| p[k] + t * (q[k] - p[k]))
    };
    let mut add = |corners: [Seen; 3]| {
        let triangle = Triangle {
            corners: corners.map(|p| [p[2], p[1]]),
            values: corners.map(|p| p[3]),
        };
        if area(&triangle.corners).abs() > NO_AREA * corners[0][1].powi(2) {
            triangles.push(triangle);
        }
    };
    match (before.as_slice(), behind.as_slice()) {
        ([a], [p, q, r]) | ([p, q, r], [a]) => add([on(a, p), on(a, q), on(a, r)]),
        ([a, b], [p, q]) => {
            let [ap, aq, bq, bp] = [on(a, p), on(a, q), on(b, q), on(b, p)];
            add([ap, aq, bq]);
            add([ap, bq, bp]);
        }
        _ => {}
    }
}

/// Area of a triangle with its sign.
fn area([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of corners about (3, 0, 0), as one hexahedron, with edge 2.
    fn cube() -> Grid {
        let corner = |i: usize| {
            let [x, y] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][i % 4];
            [3.0 + x, y, if i < 4 { -1.0 } else { 1.0 }]
        };
        Grid {
            points: (0..8).map(corner).collect(),
            connectivity: (0..8).collect(),
            offsets: vec![0, 8],
            types: vec![12],
            body: vec![1],
            radius: vec![0.0],
        }
    }

    fn cut_of(azimuth: f64, value: impl Fn([f64; 3]) -> f64) -> Vec<Triangle> {
        let grid = cube();
        let values: Vec<f64> = grid.points.iter().map(|&x| value(x)).collect();
        at_azimuth(&grid, &grid.points, &values, 1, azimuth)
    }

    /// Wrong: a section would have holes, or show the field of another place.
    #[test]
    fn a_cut_covers_the_section_and_keeps_linear_fields() {
        let field = |x: [f64; 3]| 2.0 * x[0] - 5.0 * x[1] + 7.0 * x[2];
        // At 0 the section is 2 x 2; the faces at y = +-1 end at atan(1/4) for the far side.
        for azimuth in [0.0f64, 0.1, -0.2] {
            let triangles = cut_of(azimuth, field);
            let total: f64 = triangles.iter().map(|t| area(&t.corners).abs()).sum();
            let exact = 2.0 * 2.0 / azimuth.cos();
            assert!((total - exact).abs() < 1e-12, "{azimuth}: {total} {exact}");
            for t in &triangles {
                for (corner, value) in t.corners.iter().zip(t.values) {
                    let x = [corner[1] * azimuth.cos(), corner[1] * azimuth.sin(), corner[0]];
                    assert!((value - field(x)).abs() < 1e-12);
                }
            }
        }
        assert!(
            cut_of(std::f64::consts::PI, field).is_empty(),
            "the other half-plane"
        );
    }

    /// Wrong: a section through the nodes, where balls of symmetric scenes are, would be empty or drawn twice.
    #[test]
    fn faces_in_the_plane_are_cut_once() {
        let mut grid = cube();
        // Two cubes that share the face y = 0.
        for x in &mut grid.points {
            x[1] -= 1.0;
        }
        let other: Vec<[f64; 3]> = grid.points.iter().map(|x| [x[0], x[1] + 2.0, x[2]]).collect();
        grid.points.extend(other);
        grid.connectivity.extend(8..16);
        grid.offsets.push(16);
        grid.types.push(12);
        grid.body.push(1);
        let values = vec![1.0; 16];
        let triangles = at_azimuth(&grid, &grid.points, &values, 1, 0.0);
        let total: f64 = triangles.iter().map(|t| area(&t.corners).abs()).sum();
        assert!((total - 4.0).abs() < 1e-6, "{total}");
    }
}
