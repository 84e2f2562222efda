//! Stiffness by a stress that a body has.

use fem::{Pattern, assemble_node_prestress, assemble_sector_prestress, assemble_stiffness, volume};
use mesh::{ElementKind, Mesh, PERIODIC_TOLERANCE, find_periodicity};
use sprs::CsMat;

use crate::support::{grids, max_abs, max_difference, multiply, nodal_field, steel};

fn matrix(mesh: &Mesh, u: &[f64]) -> CsMat<f64> {
    assemble_node_prestress(&Pattern::new(mesh).unwrap(), mesh, &steel(), u).unwrap()
}

/// The product of a matrix between nodes with a nodal field.
fn product(k: &CsMat<f64>, w: &[f64]) -> Vec<f64> {
    let mut forces = vec![0.0; w.len()];
    for c in 0..3 {
        let component: Vec<f64> = w.iter().skip(c).step_by(3).copied().collect();
        let along = multiply(k, &component);
        along
            .iter()
            .enumerate()
            .for_each(|(node, f)| forces[3 * node + c] = *f);
    }
    forces
}

/// Wrong: the energy of a stress on the squares of displacement gradients would have another size or sign. A cube under
/// the tension s along x, moved across it by g x: the energy is s g^2 V / 2, that of a string; along y it has none.
#[test]
fn a_tension_holds_straight_what_turns_out_of_it() {
    let (strain, g) = (1e-4, 1e-3);
    let nu = steel().poisson_ratio;
    for kind in ElementKind::ALL {
        let mesh = grids::wavy_cube(kind, 2);
        let u = nodal_field(&mesh, |x| {
            [strain * x[0], -nu * strain * x[1], -nu * strain * x[2]]
        });
        let k = matrix(&mesh, &u);
        let energy =
            |w: &[f64]| -> f64 { 0.5 * product(&k, w).iter().zip(w).map(|(f, w)| f * w).sum::<f64>() };
        let exact = 0.5 * steel().young_modulus * strain * g * g * volume(&mesh).unwrap();
        let across = energy(&nodal_field(&mesh, |x| [0.0, 0.0, g * x[0]]));
        let along = energy(&nodal_field(&mesh, |x| [0.0, 0.0, g * x[1]]));
        assert!((across / exact - 1.0).abs() < 1e-10, "{kind:?}: {across} {exact}");
        assert!(along.abs() < 1e-10 * exact, "{kind:?}: {along}");
    }
}

/// Wrong: a body that turns as a whole would feel its stress otherwise than as the turned load that the stress
/// balances. On crooked elements and any stress: K (A x) = A (forces of u) to round-off, A skew; a translation has no
/// force.
#[test]
fn a_small_rotation_turns_the_load_that_the_stress_balances() {
    let turn = |[x, y, z]: [f64; 3]| [0.3 * z - 0.5 * y, 0.5 * x - 0.7 * z, 0.7 * y - 0.3 * x];
    for kind in ElementKind::ALL {
        let mesh = grids::crooked_cube(kind, 2);
        let u = nodal_field(&mesh, |[x, y, z]| {
            [
                1e-3 * (x * y - z),
                1e-3 * (x * x + z).sin(),
                1e-3 * (y - 0.5 * z * x),
            ]
        });
        let forces = multiply(&assemble_stiffness(&mesh, &steel()).unwrap(), &u);
        let turned: Vec<f64> = forces.as_chunks::<3>().0.iter().copied().flat_map(turn).collect();
        let k = matrix(&mesh, &u);
        let found = product(&k, &nodal_field(&mesh, turn));
        let size = max_abs(&turned);
        assert!(size > 1e3, "{kind:?}: {size}");
        let off = max_difference(&found, &turned);
        assert!(off < 1e-10 * size, "{kind:?}: {off:e} of {size:e}");
        let shifted = product(&k, &nodal_field(&mesh, |_| [1.0, -2.0, 0.5]));
        assert!(max_abs(&shifted) < 1e-9 * size, "{kind:?}");
        let asymmetric = (&k - &k.transpose_view().to_csr())
            .data()
            .iter()
            .any(|x| *x != 0.0);
        assert!(!asymmetric, "{kind:?}");
    }
}

/// Wrong: one sector would have another matrix than the ring that it is of. A ring that grows like one that turns, and
/// a field that is the same in all sectors: forces of the sector are those of the whole ring.
#[test]
fn a_sector_has_the_matrix_of_the_whole_ring() {
    for kind in ElementKind::ALL {
        let mut mesh = grids::ring(kind, [2, 12, 2], [0.02, 0.03], 0.01, std::f64::consts::TAU);
        mesh.groups.clear();
        let periodicity = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
        let round = |[r, z]: [f64; 2], [x, y]: [f64; 2], along: [f64; 3]| {
            let [a, b, c] = along.map(|along| along * r * (1.0 + 20.0 * z));
            [a * x / r - b * y / r, a * y / r + b * x / r, c]
        };
        let field = |along: [f64; 3]| nodal_field(&mesh, |[x, y, z]| round([x.hypot(y), z], [x, y], along));
        let (u, w) = (field([1e-3, 2e-4, -3e-4]), field([0.4, -0.7, 1.1]));
        let whole = product(&matrix(&mesh, &u), &w);
        let sector = assemble_sector_prestress(&mesh, &periodicity, &steel(), &u).unwrap();
        let cylindrical = |v: &[f64], node: usize| {
            let [x, y, _] = mesh.nodes[node];
            let (r, v) = (x.hypot(y), &v[3 * node..3 * node + 3]);
            [(x * v[0] + y * v[1]) / r, (x * v[1] - y * v[0]) / r, v[2]]
        };
        let mut forces = vec![[0.0; 3]; periodicity.n_section_nodes()];
        for (c, block) in sector.couplings.iter().zip(&sector.blocks) {
            let u = cylindrical(&w, periodicity.nodes()[c.column]);
            for i in 0..3 {
                forces[c.row][i] += (0..3).map(|j| block[3 * i + j] * u[j]).sum::<f64>();
            }
        }
        let size = max_abs(&whole);
        for (&node, found) in periodicity.nodes().iter().zip(&forces) {
            let off = max_difference(&cylindrical(&whole, node), found);
            assert!(off < 1e-10 * size, "{kind:?}, node {node}: {off:e} of {size:e}");
        }
    }
}
