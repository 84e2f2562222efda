//! Stress at any points of a mesh.

use fem::stress::PointRecovery;
use mesh::ElementKind;

use crate::support::grids::{Ends, mapped_grid, wavy_cube};
use crate::support::{assert_close, nodal_field};

/// Otherwise a probe would show the stress of another place: quadratic displacement has linear stress, which is exact
/// at every point of affine elements, whether it lies within an element, on a face, on an edge or on the boundary.
#[test]
fn a_linear_stress_field_is_exact_at_any_point() {
    let field = |[x, y, z]: [f64; 3]| [x * x + 0.5 * y * z, 0.3 * z * z - x * y, x * z + 0.2 * y * y];
    let strain = |[x, y, z]: [f64; 3]| [2.0 * x, -x, x, 0.5 * z - y, 0.6 * z + 0.4 * y, 0.5 * y + z];
    let material = fem::Material::new(1.0, 0.3, 1.0).unwrap();
    let map = |[x, y, z]: [f64; 3]| [x + 0.2 * y, 1.3 * y, z + 0.1 * x];
    for kind in [ElementKind::Hex20, ElementKind::Tet10] {
        let mesh = mapped_grid(kind, [2, 3, 2], Ends::Free, map);
        let n = 7;
        let points: Vec<[f64; 3]> = (0..n * n * n)
            .map(|i| map([i % n, i / n % n, i / n / n].map(|j| j as f64 / (n - 1) as f64)))
            .collect();
        let u = nodal_field(&mesh, field);
        let found = PointRecovery::new(&mesh, &material, &points).unwrap().stress(&u);
        for (x, stress) in points.iter().zip(found) {
            let expected = material.stress(strain(*x));
            for c in 0..6 {
                assert_close(
                    stress[c],
                    expected[c],
                    2e-13,
                    &format!("{} at {x:?}", kind.name()),
                );
            }
        }
    }
}

/// Otherwise a probe beside the body would silently show the stress of another place.
#[test]
fn a_point_outside_is_refused_with_its_place() {
    let material = fem::Material::new(1.0, 0.3, 1.0).unwrap();
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let error = PointRecovery::new(&mesh, &material, &[[0.5, 0.5, 0.5], [0.5, 1.6, 0.5]])
            .err()
            .expect("the second point is outside");
        let text = error.to_string();
        assert!(
            text.contains("no element holds the point (5.000000e-1, 1.600000e0, 5.000000e-1) m"),
            "{text}"
        );
    }
}
