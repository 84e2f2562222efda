//! Stress recovery and invariants.

use fem::stress::NodeRecovery;
use fem::{StressRecovery, principal, von_mises};
use mesh::ElementKind;

use crate::support::grids::{Ends, crooked_cube, mapped_grid, wavy_cube};
use crate::support::{assert_close, nodal_field, steel};

/// Otherwise a spinning ring would be stressed by its spin; round-off of E times 1e-16 times some hundred terms.
#[test]
fn a_rigid_rotation_has_no_stress() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let recovery = StressRecovery::new(&mesh, &steel()).unwrap();
        for mode in fem::rigid_modes(&mesh, [0.5, 2.0, -1.0]) {
            for stress in recovery
                .nodal(&mode)
                .into_iter()
                .chain(recovery.integration_points(&mode))
            {
                assert!(von_mises(stress) < 207e9 * 1e-13, "{} {stress:?}", kind.name());
            }
        }
    }
}

/// Otherwise extrapolation to the nodes would be biased: quadratic displacement has linear stress, which the
/// projection keeps on affine elements. (Interpolated by hex8 it is not in equilibrium, so only the quadratic
/// elements are asked.)
#[test]
fn a_linear_stress_field_is_exact_at_every_node_and_point() {
    let field = |[x, y, z]: [f64; 3]| [x * x + 0.5 * y * z, 0.3 * z * z - x * y, x * z + 0.2 * y * y];
    let strain = |[x, y, z]: [f64; 3]| [2.0 * x, -x, x, 0.5 * z - y, 0.6 * z + 0.4 * y, 0.5 * y + z];
    let material = fem::Material::new(1.0, 0.3, 1.0).unwrap();
    for kind in [ElementKind::Hex20, ElementKind::Tet10] {
        let mesh = mapped_grid(kind, [2, 3, 2], Ends::Free, |[x, y, z]| {
            [x + 0.2 * y, 1.3 * y, z + 0.1 * x]
        });
        let u = nodal_field(&mesh, field);
        let recovery = StressRecovery::new(&mesh, &material).unwrap();
        let points = recovery
            .point_positions()
            .into_iter()
            .zip(recovery.integration_points(&u));
        for (x, stress) in mesh.nodes.iter().copied().zip(recovery.nodal(&u)).chain(points) {
            let expected = material.stress(strain(x));
            for c in 0..6 {
                assert_close(
                    stress[c],
                    expected[c],
                    2e-14,
                    &format!("{} at {x:?}", kind.name()),
                );
            }
        }
    }
}

/// Otherwise the recovered incompatible modes would not be those of the stiffness: the stress must do the work of K,
/// `u^T f = integral of sigma : D^-1 sigma`, exactly.
#[test]
fn the_energy_of_the_recovered_stress_is_that_of_the_stiffness() {
    let material = steel();
    let nu = material.poisson_ratio;
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 1);
        let u = nodal_field(&mesh, |[x, y, z]| {
            [
                (3.0 * x + y).sin() * 1e-3,
                (2.0 * y * z).cos() * 1e-3,
                (x * y - 2.0 * z).sin() * 1e-3,
            ]
        });
        let k = fem::assemble_stiffness(&mesh, &material).unwrap();
        let work: f64 = crate::support::multiply(&k, &u)
            .iter()
            .zip(&u)
            .map(|(f, u)| f * u)
            .sum();
        let recovery = StressRecovery::new(&mesh, &material).unwrap();
        let rule = fem::quadrature::stiffness_rule(kind);
        let mut energy = 0.0;
        for (place, s) in recovery.integration_points(&u).into_iter().enumerate() {
            let (e, q) = (
                place / recovery.points_per_element(),
                place % recovery.points_per_element(),
            );
            let dn = fem::element::gradients(kind, rule.points[q]);
            let mut j = [[0.0; 3]; 3];
            for (a, &node) in mesh.element(e).iter().enumerate() {
                for i in 0..3 {
                    for c in 0..3 {
                        j[i][c] += dn[a][i] * mesh.nodes[node][c];
                    }
                }
            }
            let det = (0..3)
                .map(|i| {
                    let (k, l) = ((i + 1) % 3, (i + 2) % 3);
                    j[0][i] * (j[1][k] * j[2][l] - j[1][l] * j[2][k])
                })
                .sum::<f64>();
            let trace = s[0] + s[1] + s[2];
            let squares: f64 = (0..6).map(|c| s[c] * s[c] * if c < 3 { 1.0 } else { 2.0 }).sum();
            energy += rule.weights[q] * det * ((1.0 + nu) * squares - nu * trace * trace) / 207e9;
        }
        assert_close(energy / work, 1.0, 1e-12, kind.name());
    }
}

/// Otherwise the yield measure would be wrong: textbook cases (uniaxial s, pure shear sqrt(3) t, hydrostatic 0).
#[test]
fn von_mises_of_simple_states_is_the_textbooks() {
    assert_close(von_mises([-7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0, 1e-15, "uniaxial");
    assert_close(
        von_mises([0.0, 0.0, 0.0, 0.0, 2.0, 0.0]),
        2.0 * 3.0_f64.sqrt(),
        1e-15,
        "shear",
    );
    assert_eq!(von_mises([5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
}

/// Otherwise principal stresses would be unsorted or inaccurate, near-equal ones above all.
#[test]
fn principal_stresses_are_sorted_and_accurate_even_when_nearly_equal() {
    assert_eq!(principal([1.0, 3.0, 2.0, 0.0, 0.0, 0.0]), [3.0, 2.0, 1.0]);
    let shear = principal([0.0, 0.0, 0.0, 0.0, 0.0, -4.0]);
    assert_close(shear[0], 4.0, 1e-15, "shear");
    assert_close(shear[2], -4.0, 1e-15, "shear");
    // Rotate a known diagonal by a rotation that is no multiple of a right angle.
    let (c, s) = (0.8, 0.6);
    for known in [[3.0, -1.0, -1.0 - 1e-9], [1e9, 1.0, 0.0], [2.0, 2.0, 2.0]] {
        let [a, b, d] = known;
        let (xx, yy, xy) = (c * c * a + s * s * b, s * s * a + c * c * b, c * s * (a - b));
        // Then about x.
        let tensor = [
            xx,
            c * c * yy + s * s * d,
            s * s * yy + c * c * d,
            c * xy,
            c * s * (yy - d),
            s * xy,
        ];
        let found = principal(tensor);
        for i in 0..3 {
            let size = known[0].abs();
            assert_close(found[i], known[i], 4e-16 * size * 4.0, &format!("{known:?}"));
        }
    }
}

/// Otherwise the average would not be weighted by volume: a slice of volume 1 with stress 1 beside one of volume 3
/// without.
#[test]
fn nodal_stress_is_the_volume_weighted_mean_of_its_elements() {
    let material = fem::Material::new(1.0, 0.0, 1.0).unwrap();
    let mesh = mapped_grid(ElementKind::Hex8, [2, 1, 1], Ends::Free, |[x, y, z]| {
        [if x <= 0.5 { 2.0 * x } else { 6.0 * x - 2.0 }, y, z]
    });
    let u = nodal_field(&mesh, |x| [x[0].min(1.0), 0.0, 0.0]);
    let stress = StressRecovery::new(&mesh, &material).unwrap().nodal(&u);
    for (x, stress) in mesh.nodes.iter().zip(stress) {
        let expected = if x[0] < 0.5 {
            1.0
        } else if x[0] < 1.5 {
            0.25
        } else {
            0.0
        };
        assert_close(stress[0], expected, 1e-14, &format!("at {x:?}"));
    }
}

/// Otherwise a history of the stress at a node would not be that of the fields, or would cost as much as they do: the
/// same bits, from the elements around the nodes alone.
#[test]
fn stress_at_chosen_nodes_has_the_bits_of_the_whole_field() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 4);
        let u = nodal_field(&mesh, |[x, y, z]| [x * y - z * z, (2.0 * x).sin() * z, y * y * x]);
        let whole = StressRecovery::new(&mesh, &steel()).unwrap().nodal(&u);
        let nodes = [mesh.n_nodes() - 1, 7, mesh.n_nodes() / 2, 7];
        let chosen = NodeRecovery::new(&mesh, &steel(), &nodes).unwrap();
        let stress = chosen.stress(&u);
        for (&node, found) in nodes.iter().zip(stress) {
            assert_eq!(found, whole[node], "{} node {node}", kind.name());
        }
        assert!(
            chosen.n_elements() < mesh.n_elements() / 2,
            "{}",
            chosen.n_elements()
        );
    }
}
