//! The axis about which a ring would be a body of revolution: that of its moments of inertia.

use std::f64::consts::TAU;

use crate::geometry::{determinant, element_coordinates, gradients, quadrature};
use crate::mesh::Mesh;

/// An axis other than z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnAxis {
    /// A point on it, m: where it meets the plane z = 0, or the centre of the volume if it lies across z.
    pub point: [f64; 3],
    /// Its angle with z, rad.
    pub tilt: f64,
    /// Azimuth towards which its upper end is tilted, rad, in [0, 2 pi).
    pub azimuth: f64,
}

impl OwnAxis {
    /// Whether it is within `tolerance` (m) of z all along a mesh.
    pub(super) fn is_z(&self, mesh: &Mesh, tolerance: f64) -> bool {
        let [x, y, _] = self.point;
        let height = mesh.nodes.iter().map(|x| x[2].abs()).fold(0.0, f64::max);
        x.hypot(y) + height * self.tilt.tan().abs() <= tolerance
    }
}

/// Sweeps of Jacobi's method: it converges by squares.
const SWEEPS: usize = 12;
/// Cosine of the angle with z, 84 degrees, from which an axis lies across z: where it meets z = 0 may be far away.
const LEAST_COSINE: f64 = 0.1;

/// The axis of a mesh by the moments of inertia of its volume, and the mesh about z.
pub(super) fn about_own_axis(mesh: &Mesh) -> Option<(OwnAxis, Mesh)> {
    let (centre, moments) = volume_moments(mesh);
    let (values, vectors) = eigenpairs(moments);
    // Two moments are equal; the axis is that of the third.
    let apart = |i: usize| (values[(i + 1) % 3] - values[(i + 2) % 3]).abs();
    let third = (0..3).min_by(|&a, &b| apart(a).total_cmp(&apart(b)))?;
    let mut along = vectors[third];
    if along[2] < 0.0 {
        along = along.map(|c| -c);
    }
    let point = match along[2] > LEAST_COSINE {
        true => [0, 1, 2].map(|i| centre[i] - centre[2] / along[2] * along[i]),
        false => centre,
    };
    let axis = OwnAxis {
        point,
        tilt: along[0].hypot(along[1]).atan2(along[2]),
        azimuth: along[1].atan2(along[0]).rem_euclid(TAU),
    };
    let mut moved = mesh.clone();
    let across = across(along);
    let other = cross(along, across);
    moved.nodes.iter_mut().for_each(|x| {
        let d = [0, 1, 2].map(|i| x[i] - point[i]);
        *x = [across, other, along].map(|e| dot(e, d));
    });
    Some((axis, moved))
}

/// A direction of length 1 across another one.
fn across(along: [f64; 3]) -> [f64; 3] {
    // That of x, y and z which is farthest from it.
    let far = (0..3)
        .min_by(|&a, &b| along[a].abs().total_cmp(&along[b].abs()))
        .unwrap_or(0);
    let mut raw = along.map(|c| -c * along[far]);
    raw[far] += 1.0;
    let length = dot(raw, raw).sqrt();
    raw.map(|c| c / length)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Centre of volume, m, and the integrals of d_i d_j about it, m5. The rules of the elements are of degree 3 and more:
/// exact for straight-sided tetrahedra, close for others, and as symmetric as the mesh.
fn volume_moments(mesh: &Mesh) -> ([f64; 3], [[f64; 3]; 3]) {
    let rule: Vec<_> = quadrature(mesh.kind)
        .into_iter()
        .map(|(xi, w)| {
            (
                crate::geometry::values(mesh.kind, xi),
                gradients(mesh.kind, xi),
                w,
            )
        })
        .collect();
    let (mut volume, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
    let mut x = Vec::with_capacity(20);
    for e in 0..mesh.n_elements() {
        element_coordinates(mesh, e, &mut x);
        let origin = mesh.nodes[mesh.element(e)[0]];
        for (values, gradients, weight) in &rule {
            let weight = weight * determinant(&x, gradients);
            let mut at = origin;
            for (value, x) in values.iter().zip(&x) {
                (0..3).for_each(|i| at[i] += value * x[i]);
            }
            volume += weight;
            for i in 0..3 {
                first[i] += weight * at[i];
                (0..3).for_each(|j| second[i][j] += weight * at[i] * at[j]);
            }
        }
    }
    let centre = first.map(|c| c / volume);
    for i in 0..3 {
        (0..3).for_each(|j| second[i][j] -= volume * centre[i] * centre[j]);
    }
    (centre, second)
}

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations.
fn eigenpairs(mut a: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let angle = 0.5 * (2.0 * a[p][q]).atan2(a[p][p] - a[q][q]);
            let (s, c) = angle.sin_cos();
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] + s * row[q], c * row[q] - s * row[p]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] + s * a[q][k], c * a[q][k] - s * a[p][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] + s * v[q][k], c * v[q][k] - s * v[p][k]);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}
