//! Nodal forces against exact resultants.

use mesh::{ElementKind, Facet, Mesh};

use crate::support::grids::{ring, wavy_cube};
use crate::support::{assert_close, max_abs, max_difference, multiply, nodal_field, steel};

/// Resultant force and moment about the origin of nodal forces.
fn resultant(mesh: &Mesh, load: &[f64]) -> [f64; 6] {
    let modes = fem::rigid_modes(mesh, [0.0; 3]);
    modes.map(|mode| mode.iter().zip(load).map(|(v, f)| v * f).sum())
}

/// All facets of the boundary.
fn boundary(mesh: &Mesh) -> Vec<Facet> {
    mesh.groups.values().flatten().copied().collect()
}

/// Otherwise gravity would weigh wrong: the resultant is rho g V in the centre of mass.
#[test]
fn a_uniform_body_load_has_the_bodys_weight_in_its_centre_of_mass() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let body = fem::inertia(&mesh, &steel()).unwrap();
        let load = fem::body_load(&mesh, |_| [0.0, 0.0, -7800.0 * 9.81]).unwrap();
        let found = resultant(&mesh, &load);
        let weight = 9.81 * body.mass;
        let expected = [
            0.0,
            0.0,
            -weight,
            -weight * body.centre[1],
            weight * body.centre[0],
            0.0,
        ];
        assert!(
            max_difference(&found, &expected) < 1e-12 * weight,
            "{} {found:?}",
            kind.name()
        );
    }
}

/// Otherwise the load of rotation and the mass matrix would describe two bodies: both are integrated exactly.
#[test]
fn the_centrifugal_load_is_the_mass_times_the_acceleration() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let load = fem::centrifugal_load(&mesh, 7800.0, 20.0).unwrap();
        let m = fem::assemble_mass(&mesh, &steel()).unwrap();
        let expected = multiply(&m, &nodal_field(&mesh, |x| [400.0 * x[0], 400.0 * x[1], 0.0]));
        assert!(
            max_difference(&load, &expected) < 1e-13 * max_abs(&load) * 27.0,
            "{}",
            kind.name()
        );
        assert!(
            load.iter().sum::<f64>() > 0.0,
            "outward is positive in the octant of positive x and y"
        );
    }
}

/// Otherwise a submerged body would drift or spin: pressure on a closed surface has no resultant, curved facets
/// included.
#[test]
fn a_uniform_pressure_on_a_closed_surface_has_no_resultant() {
    for kind in ElementKind::ALL {
        let mesh = ring(kind, [2, 12, 2], [0.03, 0.04], 0.02, std::f64::consts::TAU);
        let surface: Vec<Facet> = ["x0", "x1", "z0", "z1"]
            .iter()
            .flat_map(|&g| mesh.group(g))
            .copied()
            .collect();
        let load = fem::pressure_load(&mesh, &surface, 1e6);
        assert!(
            max_abs(&resultant(&mesh, &load)) < 1e-12 * 1e6 * fem::area(&mesh, &surface),
            "{}",
            kind.name()
        );
        assert!(max_abs(&load) > 1.0);
    }
}

/// Otherwise pressure would pull: pressure on the side z = 1 pushes along -z with pressure times area, as the like
/// traction does.
#[test]
fn a_pressure_pushes_against_the_outward_normal() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 2);
        let load = fem::pressure_load(&mesh, mesh.group("z1"), 3.0);
        let expected = [0.0, 0.0, -3.0, -1.5, 1.5, 0.0];
        assert!(
            max_difference(&resultant(&mesh, &load), &expected) < 1e-14 * 30.0,
            "{}",
            kind.name()
        );
        let traction = fem::traction_load(&mesh, mesh.group("z1"), |_, n| n.map(|n| -3.0 * n));
        assert!(max_difference(&load, &traction) < 1e-14, "{}", kind.name());
    }
}

/// Otherwise a hydrostatic pressure would not lift by the weight of the fluid (Archimedes): divergence theorem on any
/// mesh.
#[test]
fn a_hydrostatic_traction_lifts_by_the_displaced_weight() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let load = fem::traction_load(&mesh, &boundary(&mesh), |x, n| n.map(|n| -(5.0 - 2.0 * x[2]) * n));
        let lift = resultant(&mesh, &load);
        assert_close(lift[2], 2.0 * fem::volume(&mesh).unwrap(), 1e-13, kind.name());
        assert_close(lift[0], 0.0, 1e-13, kind.name());
    }
}

/// Otherwise the mean motion of a bore would be biased: weights are sorted, sum to the area and integrate linear
/// fields exactly.
#[test]
fn facet_weights_integrate_linear_fields_over_the_surface() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let facets = mesh.group("x1");
        let weights = fem::facet_node_weights(&mesh, facets);
        let nodes: Vec<usize> = weights.iter().map(|w| w.0).collect();
        assert_eq!(nodes, mesh.group_nodes("x1"));
        assert_close(weights.iter().map(|w| w.1).sum(), 1.0, 1e-14, "area");
        assert_close(fem::area(&mesh, facets), 1.0, 1e-14, "area");
        let mean = |i: usize| {
            weights
                .iter()
                .map(|&(node, w)| w * mesh.nodes[node][i])
                .sum::<f64>()
        };
        assert_close(mean(1), 0.5, 1e-14, "mean y");
        assert_close(mean(2), 0.5, 1e-14, "mean z");
    }
}
