//! Orders of convergence with a manufactured solution on distorted meshes.

use fem::{StressRecovery, assemble_stiffness, body_load, norms};
use mesh::ElementKind;

use crate::support::grids::wavy_cube;
use crate::support::{assert_order, clamp, solve};

const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;

/// Wave numbers and amplitudes of `u_i = a_i sin(k_i . x + i)`.
const WAVES: [[f64; 3]; 3] = [[1.0, 1.4, 0.6], [1.2, -0.7, 0.9], [0.5, 0.8, -1.3]];
const AMPLITUDES: [f64; 3] = [1.0, -0.8, 0.6];

fn phase(i: usize, x: [f64; 3]) -> f64 {
    WAVES[i][0] * x[0] + WAVES[i][1] * x[1] + WAVES[i][2] * x[2] + i as f64
}

fn displacement(x: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| AMPLITUDES[i] * phase(i, x).sin())
}

fn exact_strain(x: [f64; 3]) -> [f64; 6] {
    let gradient = |i: usize, j: usize| AMPLITUDES[i] * WAVES[i][j] * phase(i, x).cos();
    let shear = |i: usize, j: usize| gradient(i, j) + gradient(j, i);
    [
        gradient(0, 0),
        gradient(1, 1),
        gradient(2, 2),
        shear(0, 1),
        shear(1, 2),
        shear(0, 2),
    ]
}

/// `b = -(lambda + mu) grad div u - mu laplace u`.
fn force(x: [f64; 3]) -> [f64; 3] {
    let lambda = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let mu = YOUNG / (2.0 * (1.0 + POISSON));
    [0, 1, 2].map(|i| {
        let mut sum = 0.0;
        for j in 0..3 {
            let second = AMPLITUDES[j] * phase(j, x).sin() * WAVES[j][j] * WAVES[j][i];
            sum += (lambda + mu) * second;
            sum += mu * AMPLITUDES[i] * phase(i, x).sin() * WAVES[i][j] * WAVES[i][j];
        }
        sum
    })
}

/// Errors on a mesh: displacement (L2), strain energy, and nodal stress (root mean square).
fn errors(kind: ElementKind, n: usize) -> [f64; 3] {
    let material = fem::Material::new(YOUNG, POISSON, 1.0).unwrap();
    let mesh = wavy_cube(kind, n);
    let k = assemble_stiffness(&mesh, &material).unwrap();
    let load = body_load(&mesh, force).unwrap();
    let u = solve(
        &k,
        &load,
        &clamp(&mesh, &["x0", "x1", "y0", "y1", "z0", "z1"], displacement),
    );
    let stress = StressRecovery::new(&mesh, &material).unwrap().nodal(&u);
    let mut squared = 0.0;
    for (x, stress) in mesh.nodes.iter().zip(stress) {
        let expected = material.stress(exact_strain(*x));
        squared += (0..6).map(|c| (stress[c] - expected[c]).powi(2)).sum::<f64>() / mesh.n_nodes() as f64;
    }
    let energy = norms::energy_error(&mesh, &material, &u, exact_strain).unwrap();
    [
        norms::l2_error(&mesh, &u, displacement).unwrap(),
        energy,
        squared.sqrt(),
    ]
}

/// Checks order p + 1 of the displacement, p of the energy, and that nodal stress is no worse than the energy.
fn check(kind: ElementKind, sizes: &[usize], p: f64) {
    let found: Vec<[f64; 3]> = sizes.iter().map(|&n| errors(kind, n)).collect();
    let column = |c: usize| found.iter().map(|errors| errors[c]).collect::<Vec<_>>();
    let ratios: Vec<f64> = sizes
        .windows(2)
        .map(|pair| pair[1] as f64 / pair[0] as f64)
        .collect();
    assert_order(
        &column(0),
        &ratios,
        p + 1.0,
        &format!("{} displacement", kind.name()),
    );
    assert_order(&column(1), &ratios, p, &format!("{} energy", kind.name()));
    assert_order(&column(2), &ratios, p, &format!("{} nodal stress", kind.name()));
}

/// Otherwise the incompatible modes would spoil the trilinear element's order.
#[test]
fn hex8_converges_with_order_two_and_its_energy_with_order_one() {
    check(ElementKind::Hex8, &[4, 8, 12], 1.0);
}

/// Otherwise mid-nodes, full integration or the order of the nodes would be wrong.
#[test]
fn hex20_converges_with_order_three_and_its_energy_with_order_two() {
    check(ElementKind::Hex20, &[3, 5, 7], 2.0);
}

/// Otherwise four points would not be enough for curved tetrahedra, or the order of the nodes would be wrong.
#[test]
fn tet10_converges_with_order_three_and_its_energy_with_order_two() {
    check(ElementKind::Tet10, &[2, 4, 6], 2.0);
}
