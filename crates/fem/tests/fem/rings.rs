//! Rings against closed forms.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fem::{StressRecovery, assemble_stiffness, norms};
use mesh::{ElementKind, Mesh};

use crate::support::grids::ring;
use crate::support::{assert_close, assert_order, solve, steel};

const INNER: f64 = 0.028;
const OUTER: f64 = 0.040;
const HEIGHT: f64 = 0.006;
const YOUNG: f64 = 207e9;
const POISSON: f64 = 0.3;

/// A quarter of the ring with n cells through its wall.
fn quarter(kind: ElementKind, n: usize) -> Mesh {
    ring(
        kind,
        [n, 3 * n, (n / 2).max(1)],
        [INNER, OUTER],
        HEIGHT,
        FRAC_PI_2,
    )
}

/// Symmetry about the planes y = 0 and x = 0, and no axial displacement on the named sides.
fn symmetry(mesh: &Mesh, axial: &[&str]) -> BTreeMap<usize, f64> {
    let mut fixed = BTreeMap::new();
    let mut fix = |group: &str, i: usize| {
        for node in mesh.group_nodes(group) {
            fixed.insert(3 * node + i, 0.0);
        }
    };
    fix("y0", 1);
    fix("y1", 0);
    axial.iter().for_each(|group| fix(group, 2));
    fixed
}

/// A radial displacement as a vector.
fn radial(x: [f64; 3], u: f64) -> [f64; 3] {
    let r = x[0].hypot(x[1]);
    [u * x[0] / r, u * x[1] / r, 0.0]
}

/// Orders to expect: displacement p + 1.
const ORDERS: [(ElementKind, [usize; 2], f64); 3] = [
    (ElementKind::Hex8, [4, 8], 2.0),
    (ElementKind::Hex20, [2, 4], 3.0),
    (ElementKind::Tet10, [2, 4], 3.0),
];

/// Otherwise pressure or stiffness would be wrong. Lamé's ring with free ends (Timoshenko and Goodier, Theory of
/// Elasticity, 3rd ed., 1970, art. 28, eq. 45): with C = p a^2 / (b^2 - a^2), s_r = C (1 - b^2/r^2), s_t = C (1 +
/// b^2/r^2), and the axial contraction is uniform, so the plane-stress solution is exact in three dimensions.
#[test]
fn a_thick_ring_under_internal_pressure_converges_to_lame() {
    let pressure = 50e6;
    let c = pressure * INNER * INNER / (OUTER * OUTER - INNER * INNER);
    let exact = |x: [f64; 3]| {
        let r = x[0].hypot(x[1]);
        let u = c / YOUNG * ((1.0 - POISSON) * r + (1.0 + POISSON) * OUTER * OUTER / r);
        let [ux, uy, _] = radial(x, u);
        [ux, uy, -2.0 * POISSON * c / YOUNG * x[2]]
    };
    for (kind, sizes, order) in ORDERS {
        let mut errors = Vec::new();
        for n in sizes {
            let mesh = quarter(kind, n);
            let k = assemble_stiffness(&mesh, &steel()).unwrap();
            let load = fem::pressure_load(&mesh, mesh.group("x0"), pressure);
            let u = solve(&k, &load, &symmetry(&mesh, &["z0"]));
            errors.push(norms::l2_error(&mesh, &u, exact).unwrap());
            if n == sizes[1] {
                check_hoop_stress(&mesh, &u, c);
            }
        }
        assert_order(&errors, &[2.0], order, &format!("lame, {}", kind.name()));
    }
}

/// Hoop stress at the bore within 3 % (largest element size 1.5 to 3 mm on a bore of 28 mm, one-sided extrapolation).
fn check_hoop_stress(mesh: &Mesh, u: &[f64], c: f64) {
    let stress = StressRecovery::new(mesh, &steel()).unwrap().nodal(u);
    let expected = c * (1.0 + OUTER * OUTER / (INNER * INNER));
    for node in mesh.group_nodes("x0") {
        let [x, y, _] = mesh.nodes[node];
        let (cos, sin) = (x / INNER, y / INNER);
        let [xx, yy, _, xy, _, _] = stress[node];
        let hoop = sin * sin * xx + cos * cos * yy - 2.0 * sin * cos * xy;
        assert_close(hoop, expected, 0.03 * expected, mesh.kind.name());
    }
}

/// Otherwise the centrifugal load would be wrong. Rotating ring between rigid plane ends: the disk of Timoshenko and
/// Goodier, Theory of Elasticity, 3rd ed., 1970, art. 32, with E/(1 - nu^2) for E and nu/(1 - nu) for nu (plane
/// strain).
#[test]
fn a_rotating_ring_converges_to_the_closed_form() {
    let (density, omega) = (7800.0, 3000.0);
    let (e, nu) = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let exact = |x: [f64; 3]| {
        let r = x[0].hypot(x[1]);
        let (a2, b2) = (INNER * INNER, OUTER * OUTER);
        let load = density * omega * omega;
        let shape = (3.0 + nu) / 8.0;
        let s_r = shape * load * (a2 + b2 - a2 * b2 / (r * r) - r * r);
        let s_t = shape * load * (a2 + b2 + a2 * b2 / (r * r) - (1.0 + 3.0 * nu) / (3.0 + nu) * r * r);
        radial(x, r / e * (s_t - nu * s_r))
    };
    for (kind, sizes, order) in ORDERS {
        let mut errors = Vec::new();
        for n in sizes {
            let mesh = quarter(kind, n);
            let k = assemble_stiffness(&mesh, &steel()).unwrap();
            let load = fem::centrifugal_load(&mesh, density, omega).unwrap();
            let u = solve(&k, &load, &symmetry(&mesh, &["z0", "z1"]));
            errors.push(norms::l2_error(&mesh, &u, exact).unwrap());
        }
        assert_order(&errors, &[2.0], order, &format!("rotating, {}", kind.name()));
    }
}

/// Otherwise warm rings would grow wrongly, or carry a wrong stress. A tube between rigid plane ends whose own strain
/// e(r) is linear (Timoshenko and Goodier, Theory of Elasticity, 3rd ed., 1970, art. 151, with u_z = 0): u = (1 +
/// nu)/((1 - nu) r) [J(r) + ((1 - 2 nu) r^2 + a^2)/(b^2 - a^2) J(b)], J(r) the integral of e r from a on; the hoop
/// stress is E/((1 - nu) r^2) [(r^2 + a^2)/(b^2 - a^2) J(b) + J(r) - e r^2].
#[test]
fn a_ring_with_a_radial_temperature_converges_to_the_closed_form() {
    let own = |r: f64| 1e-4 + 0.02 * (r - INNER);
    let integral = |r: f64| {
        let (e0, slope) = (1e-4 - 0.02 * INNER, 0.02);
        0.5 * e0 * (r * r - INNER * INNER) + slope / 3.0 * (r.powi(3) - INNER.powi(3))
    };
    let (a2, b2, nu) = (INNER * INNER, OUTER * OUTER, POISSON);
    let exact = |x: [f64; 3]| {
        let r = x[0].hypot(x[1]);
        let whole = ((1.0 - 2.0 * nu) * r * r + a2) / (b2 - a2) * integral(OUTER);
        radial(x, (1.0 + nu) / (1.0 - nu) / r * (integral(r) + whole))
    };
    let hoop = |r: f64| {
        let mean = (r * r + a2) / (b2 - a2) * integral(OUTER);
        YOUNG / ((1.0 - nu) * r * r) * (mean + integral(r) - own(r) * r * r)
    };
    for (kind, sizes, order) in ORDERS {
        let mut errors = Vec::new();
        for n in sizes {
            let mesh = quarter(kind, n);
            let k = assemble_stiffness(&mesh, &steel()).unwrap();
            let recovery = StressRecovery::new(&mesh, &steel()).unwrap();
            let held = recovery.held_stress(|x| own(x[0].hypot(x[1])));
            let u = solve(
                &k,
                &recovery.released_load(&held),
                &symmetry(&mesh, &["z0", "z1"]),
            );
            errors.push(norms::l2_error(&mesh, &u, exact).unwrap());
            if n == sizes[1] {
                let (moved, held) = (recovery.nodal(&u), recovery.nodal_of_points(&held));
                // The stress range is 44 MPa; linear stress inside an element of 1.5 to 3 mm bends by 1 MPa.
                for node in mesh.group_nodes("x0") {
                    let [x, y, _] = mesh.nodes[node];
                    let (cos, sin) = (x / INNER, y / INNER);
                    let [xx, yy, _, xy, ..] =
                        std::array::from_fn::<f64, 6, _>(|c| moved[node][c] + held[node][c]);
                    let found = sin * sin * xx + cos * cos * yy - 2.0 * sin * cos * xy;
                    assert_close(found, hoop(INNER), 1.5e6, kind.name());
                }
            }
        }
        assert_order(&errors, &[2.0], order, &format!("warm, {}", kind.name()));
    }
}

/// Otherwise mass properties would be wrong. Straight chords err with order 2, arcs through mid-nodes with order 4.
#[test]
fn volume_mass_and_inertia_of_a_ring_converge_to_the_exact_ones() {
    let volume = PI * (OUTER * OUTER - INNER * INNER) * HEIGHT;
    let mass = 7800.0 * volume;
    let polar = 0.5 * mass * (INNER * INNER + OUTER * OUTER);
    let transverse = 0.5 * polar + mass * HEIGHT * HEIGHT / 12.0;
    for (kind, order) in [
        (ElementKind::Hex8, 2.0),
        (ElementKind::Hex20, 4.0),
        (ElementKind::Tet10, 4.0),
    ] {
        let mut errors = [const { Vec::new() }; 3];
        for n in [16, 32] {
            let mesh = ring(kind, [2, n, 1], [INNER, OUTER], HEIGHT, TAU);
            let body = fem::inertia(&mesh, &steel()).unwrap();
            errors[0].push((fem::volume(&mesh).unwrap() / volume - 1.0).abs());
            errors[1].push((body.tensor[2][2] / polar - 1.0).abs());
            errors[2].push((body.tensor[0][0] / transverse - 1.0).abs());
            assert_close(
                body.tensor[0][0],
                body.tensor[1][1],
                1e-13 * transverse,
                "transverse inertia",
            );
            for (found, expected) in body.centre.into_iter().zip([0.0, 0.0, 0.5 * HEIGHT]) {
                assert_close(found, expected, 1e-15, "centre");
            }
        }
        for (errors, what) in errors
            .iter()
            .zip(["volume", "polar inertia", "transverse inertia"])
        {
            assert_order(errors, &[2.0], order, &format!("{what}, {}", kind.name()));
        }
    }
}
