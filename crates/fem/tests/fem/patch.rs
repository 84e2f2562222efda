//! Patch tests: fields the elements must reproduce on any mesh.

use fem::{StressRecovery, assemble_stiffness};
use mesh::ElementKind;

use crate::support::grids::{Ends, crooked_cube, mapped_grid};
use crate::support::{assert_close, clamp, max_abs, max_difference, nodal_field, solve, steel};

/// A displacement of order 1e-3 m with constant strain and a rotation, not aligned with anything.
fn linear(x: [f64; 3]) -> [f64; 3] {
    [
        1e-3 * (0.3 + 0.7 * x[0] - 0.2 * x[1] + 0.5 * x[2]),
        1e-3 * (-0.1 + 0.4 * x[0] + 0.6 * x[1] - 0.3 * x[2]),
        1e-3 * (0.2 - 0.5 * x[0] + 0.1 * x[1] - 0.9 * x[2]),
    ]
}

/// Strain of [`linear`].
const STRAIN: [f64; 6] = [0.7e-3, 0.6e-3, -0.9e-3, 0.2e-3, -0.2e-3, 0.0];

/// Otherwise the elements would not converge on distorted meshes. Round-off: condition of K, some 1e3, times 1e-16,
/// times u.
#[test]
fn a_linear_boundary_displacement_gives_constant_stress_on_distorted_meshes() {
    let material = steel();
    let expected = material.stress(STRAIN);
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 3);
        let k = assemble_stiffness(&mesh, &material).unwrap();
        let fixed = clamp(&mesh, &["x0", "x1", "y0", "y1", "z0", "z1"], linear);
        assert!(fixed.len() < mesh.n_dofs(), "the patch needs nodes inside");
        let u = solve(&k, &vec![0.0; mesh.n_dofs()], &fixed);
        assert!(
            max_difference(&u, &nodal_field(&mesh, linear)) < 1e-15,
            "{}",
            kind.name()
        );
        let recovery = StressRecovery::new(&mesh, &material).unwrap();
        for stress in recovery
            .integration_points(&u)
            .into_iter()
            .chain(recovery.nodal(&u))
        {
            for c in 0..6 {
                assert_close(stress[c], expected[c], 1e-11 * 207e9 * 1e-3, kind.name());
            }
        }
    }
}

/// Otherwise loads and stress would disagree: the tractions of a constant stress must hold it in equilibrium by
/// themselves.
#[test]
fn the_tractions_of_a_constant_stress_balance_its_internal_forces() {
    let material = steel();
    let [xx, yy, zz, xy, yz, xz] = material.stress(STRAIN);
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 2);
        let k = assemble_stiffness(&mesh, &material).unwrap();
        let surface: Vec<_> = mesh.groups.values().flatten().copied().collect();
        let load = fem::traction_load(&mesh, &surface, |_, n| {
            [
                xx * n[0] + xy * n[1] + xz * n[2],
                xy * n[0] + yy * n[1] + yz * n[2],
                xz * n[0] + yz * n[1] + zz * n[2],
            ]
        });
        let internal = crate::support::multiply(&k, &nodal_field(&mesh, linear));
        // Facets of a crooked hexahedron are no planes: their normals are not polynomials, but `n |a|` is.
        assert!(
            max_difference(&load, &internal) < 1e-10 * 207e9 * 1e-3,
            "{}",
            kind.name()
        );
    }
}

/// Otherwise condensed modes would be worthless: one element through the thickness must bend as a beam does.
#[test]
fn one_layer_of_hex8_bends_as_a_beam() {
    let material = fem::Material::new(1.0, 0.3, 1.0).unwrap();
    let mesh = crate::support::grids::mapped_grid(
        ElementKind::Hex8,
        [10, 1, 1],
        crate::support::grids::Ends::Free,
        |[x, y, z]| [10.0 * x, y, z],
    );
    let k = assemble_stiffness(&mesh, &material).unwrap();
    let mut fixed = clamp(&mesh, &[], |_| [0.0; 3]);
    // Pure bending leaves the plane x = 0 plane and lets it contract.
    for node in mesh.group_nodes("x0") {
        fixed.insert(3 * node, 0.0);
    }
    for dof in [1, 2] {
        fixed.insert(dof, 0.0);
    }
    let other = (0..mesh.n_nodes())
        .find(|&n| mesh.nodes[n] == [0.0, 1.0, 0.0])
        .unwrap();
    fixed.insert(3 * other + 2, 0.0);
    let load = fem::traction_load(&mesh, mesh.group("x1"), |x, _| [x[2] - 0.5, 0.0, 0.0]);
    let u = solve(&k, &load, &fixed);
    // Curvature 1 (M = I, E = 1): the line y = z = 0 falls by x^2 / 2, exact in pure bending.
    let tip = (0..mesh.n_nodes())
        .find(|&n| mesh.nodes[n] == [10.0, 0.0, 0.0])
        .unwrap();
    assert_close(u[3 * tip + 2].abs(), 50.0, 1e-9, "tip deflection");
}

/// Otherwise a warm body would be stressed that is free to grow. A strain by itself that is linear in space stresses no
/// free body (Boley and Weiner, Theory of Thermal Stresses, 1960, section 3.8): e = c + g x bends it by
/// u = c x + g (x^2 - y^2 - z^2)/2 and so on. Forces and stresses cancel to round-off; 8-node elements take the bending
/// by their modes, if they are rectangular.
#[test]
fn a_linear_temperature_bends_a_free_body_without_stress() {
    let (c, g) = (2e-4, [3e-4, -1e-4, 2e-4]);
    let own = |x: [f64; 3]| c + (0..3).map(|i| g[i] * x[i]).sum::<f64>();
    let square = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
    let free = |x: [f64; 3]| {
        let along: f64 = (0..3).map(|i| g[i] * x[i]).sum();
        std::array::from_fn(|i| c * x[i] + along * x[i] - 0.5 * g[i] * square(x))
    };
    for kind in ElementKind::ALL {
        let mesh = mapped_grid(kind, [3, 2, 2], Ends::Free, |x| x);
        let recovery = StressRecovery::new(&mesh, &steel()).unwrap();
        let held = recovery.held_stress(own);
        let u = nodal_field(&mesh, free);
        let largest = held.iter().flatten().fold(0.0, |m: f64, s| m.max(s.abs()));
        for (moved, held) in recovery.integration_points(&u).iter().zip(&held) {
            for i in 0..6 {
                assert_close(moved[i] + held[i], 0.0, 1e-11 * largest, kind.name());
            }
        }
        let forces = fem::stiffness_product(&mesh, &steel(), &u).unwrap();
        let load = recovery.released_load(&held);
        assert!(
            max_difference(&forces, &load) < 1e-11 * max_abs(&load),
            "{}",
            kind.name()
        );
    }
}
