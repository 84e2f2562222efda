//! Stiffness and mass: symmetry, zero-energy motions, total mass, same bits.

use fem::{
    Pattern, assemble_azimuthal_mass, assemble_mass, assemble_node_mass, assemble_stiffness,
    stiffness_product,
};
use mesh::{ElementKind, Mesh};
use sprs::CsMat;

use crate::support::grids::{Ends, crooked_cube, mapped_grid, ring, wavy_cube};
use crate::support::{assert_close, eigenvalues, max_abs, multiply, nodal_field, steel};

/// One distorted element of a kind, curved where it can be.
fn single(kind: ElementKind) -> Mesh {
    let mut mesh = mapped_grid(kind, [1; 3], Ends::Free, |[x, y, z]| {
        [
            x + 0.1 * y * z + 0.05 * x * x,
            1.2 * y - 0.1 * x * z,
            0.8 * z + 0.1 * x * y,
        ]
    });
    // The first tetrahedron of the cube alone.
    if kind == ElementKind::Tet10 {
        mesh.connectivity.truncate(10);
        let used = mesh.connectivity.clone();
        mesh.nodes = used.iter().map(|&node| mesh.nodes[node]).collect();
        mesh.connectivity = (0..10).collect();
        mesh.groups.clear();
    }
    mesh
}

/// Fewer: a body could not move freely; more: hourglasses. Zero is 1e-12 of the largest, round-off of the eigenvalues.
#[test]
fn elements_and_meshes_have_six_and_only_six_motions_without_energy() {
    for kind in ElementKind::ALL {
        for mesh in [single(kind), crooked_cube(kind, 2)] {
            let values = eigenvalues(&assemble_stiffness(&mesh, &steel()).unwrap());
            let largest = values[values.len() - 1];
            assert!(values[5] < 1e-12 * largest, "{} {:?}", kind.name(), &values[..8]);
            assert!(values[0] > -1e-12 * largest, "{} {:?}", kind.name(), &values[..8]);
            assert!(values[6] > 1e-5 * largest, "{} {:?}", kind.name(), &values[..8]);
        }
    }
}

/// Otherwise a rigid motion would load the body; forces are sums of some hundred terms of the size of K.
#[test]
fn rigid_modes_are_the_motions_without_force() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let k = assemble_stiffness(&mesh, &steel()).unwrap();
        let modes = fem::rigid_modes(&mesh, [0.3, -0.2, 0.7]);
        for mode in &modes {
            assert!(
                max_abs(&multiply(&k, mode)) < 1e-13 * max_abs(k.data()),
                "{}",
                kind.name()
            );
        }
        // Rotation about z through (0.3, -0.2): counter-clockwise.
        let node = mesh.nodes[5];
        assert_eq!(modes[5][15..18], [-(node[1] - -0.2), node[0] - 0.3, 0.0]);
    }
}

/// Otherwise solvers that store one triangle would solve another problem.
#[test]
fn stiffness_and_mass_are_exactly_symmetric() {
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 3);
        for matrix in [
            assemble_stiffness(&mesh, &steel()).unwrap(),
            assemble_mass(&mesh, &steel()).unwrap(),
        ] {
            for (&value, (r, c)) in matrix.iter() {
                assert_eq!(Some(&value), matrix.get(c, r), "{} ({r}, {c})", kind.name());
            }
        }
    }
}

/// Otherwise the reaction of a moved surface would not be that of the matrix that is factored.
#[test]
fn the_product_without_a_matrix_is_that_of_the_matrix() {
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 3);
        let u: Vec<f64> = (0..mesh.n_dofs()).map(|i| (0.7 * i as f64).sin()).collect();
        let matrix = assemble_stiffness(&mesh, &steel()).unwrap();
        let expected = multiply(&matrix, &u);
        let found = stiffness_product(&mesh, &steel(), &u).unwrap();
        let largest = expected.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        for (a, b) in found.iter().zip(expected.iter()) {
            assert!((a - b).abs() < 1e-13 * largest, "{}: {a} {b}", kind.name());
        }
    }
}

/// Otherwise inertia forces would be wrong: `1^T M 1 = rho V` and the kinetic energy of a spin is that of its inertia.
#[test]
fn the_consistent_mass_carries_the_mass_and_inertia_of_the_body() {
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let m = assemble_mass(&mesh, &steel()).unwrap();
        let body = fem::inertia(&mesh, &steel()).unwrap();
        assert_close(body.mass, 7800.0 * fem::volume(&mesh).unwrap(), 1e-9, "mass");
        let modes = fem::rigid_modes(&mesh, body.centre);
        for (k, mode) in modes.iter().enumerate() {
            let momentum = multiply(&m, mode);
            for (l, other) in modes.iter().enumerate() {
                let product: f64 = momentum.iter().zip(other).map(|(p, v)| p * v).sum();
                let expected = match (k < 3, l < 3) {
                    (true, true) => body.mass * f64::from(u8::from(k == l)),
                    (false, false) => body.tensor[k - 3][l - 3],
                    _ => 0.0,
                };
                assert_close(
                    product,
                    expected,
                    1e-12 * body.mass,
                    &format!("{} {k} {l}", kind.name()),
                );
            }
        }
    }
}

/// Otherwise the small mass matrix would be another one than the large.
#[test]
fn the_mass_between_nodes_is_the_mass_of_every_component() {
    for kind in ElementKind::ALL {
        let mesh = crooked_cube(kind, 2);
        let pattern = Pattern::new(&mesh).unwrap();
        let small = assemble_node_mass(&pattern, &mesh, &steel()).unwrap();
        let large = assemble_mass(&mesh, &steel()).unwrap();
        for (&value, (r, c)) in large.iter() {
            let expected = if r % 3 == c % 3 {
                small.get(r / 3, c / 3).copied()
            } else {
                Some(0.0)
            };
            assert_eq!(Some(value), expected);
        }
    }
}

/// Otherwise a run on more threads would be another run.
#[test]
fn one_thread_and_two_give_the_same_bits() {
    let run = |threads: usize, mesh: &Mesh| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let k: CsMat<f64> = assemble_stiffness(mesh, &steel()).unwrap();
            let m = assemble_mass(mesh, &steel()).unwrap();
            let load = fem::centrifugal_load(mesh, 7800.0, 188.5).unwrap();
            let recovery = fem::StressRecovery::new(mesh, &steel()).unwrap();
            let stress = (recovery.nodal(&load), recovery.integration_points(&load));
            (k, m, stress, fem::inertia(mesh, &steel()).unwrap(), load)
        })
    };
    for kind in ElementKind::ALL {
        // More elements than two waves of the parallel loop hold.
        let mesh = wavy_cube(kind, if kind == ElementKind::Tet10 { 6 } else { 11 });
        assert!(mesh.n_elements() > 1024);
        assert!(run(1, &mesh) == run(2, &mesh), "{}", kind.name());
    }
}

/// Wrong: a shaft would whirl with another gyroscopic moment. Of tilts by the velocity of others it is half the polar
/// moment of inertia, of translations nothing, and no motion has power of its own.
#[test]
fn azimuthal_mass_has_half_the_polar_inertia_of_tilts() {
    for kind in ElementKind::ALL {
        let mesh = ring(kind, [2, 16, 2], [0.3, 0.5], 0.4, std::f64::consts::TAU);
        let matrix = assemble_azimuthal_mass(&mesh, &steel()).unwrap();
        let inertia = fem::inertia(&mesh, &steel()).unwrap();
        let [tilt_x, tilt_y, x] = [
            nodal_field(&mesh, |[_, y, z]| [0.0, -z, y]),
            nodal_field(&mesh, |[x, _, z]| [z, 0.0, -x]),
            nodal_field(&mesh, |_| [1.0, 0.0, 0.0]),
        ];
        let form = |a: &[f64], b: &[f64]| -> f64 {
            let moved = multiply(&matrix, b);
            a.iter().zip(moved).map(|(a, b)| a * b).sum()
        };
        let polar = inertia.tensor[2][2];
        let error = (2.0 * form(&tilt_x, &tilt_y) / polar - 1.0).abs();
        // Straight edges of a mesh that is not round.
        assert!(error < 1e-12, "{}: {error:e}", kind.name());
        assert!((form(&tilt_x, &tilt_y) + form(&tilt_y, &tilt_x)).abs() < 1e-14 * polar);
        assert!(form(&x, &tilt_y).abs() < 1e-13 * inertia.mass && form(&x, &x).abs() < 1e-13 * inertia.mass);
    }
}
