//! Rings of a rectangular section, revolved: the matrices of the benchmarks.

use std::collections::BTreeMap;

use mesh::{ElementKind, Mesh, Section, revolve};

/// Shift by the mass, 1/s^2: that of a step of 1e-5 s.
pub const SHIFT: f64 = 4e10;

/// A ring of hexahedra, 25 to 29 mm in radius and 16 mm wide, of `n_z` x `n_r` nodes in each of its sections.
pub fn ring(n_sectors: usize, [n_z, n_r]: [usize; 2]) -> Mesh {
    let mut points = Vec::new();
    for j in 0..n_z {
        for i in 0..n_r {
            points.push([
                0.025 + 0.004 * i as f64 / (n_r - 1) as f64,
                0.016 * j as f64 / (n_z - 1) as f64,
            ]);
        }
    }
    let at = |i: usize, j: usize| j * n_r + i;
    let quads = (0..n_z - 1)
        .flat_map(|j| (0..n_r - 1).map(move |i| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let section =
        Section::new(points, quads.collect(), &BTreeMap::new()).expect("a grid of rectangles is a section");
    revolve(&section, n_sectors, ElementKind::Hex8, &[]).expect("a grid can be revolved")
}
