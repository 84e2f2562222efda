//! A strain gauge on a tube that becomes oval, against the closed form.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use fem::stress::{GaugePoint, MeshPoint, StrainGauge};
use fem::{StressRecovery, assemble_stiffness, traction_load};
use mesh::{ElementKind, Facet, Mesh};

use crate::support::grids::ring;
use crate::support::{assert_close, assert_order, solve, steel};

const INNER: f64 = 0.028;
const OUTER: f64 = 0.040;
const YOUNG: f64 = 207e9;
const POISSON: f64 = 0.3;
const PRESSURE: f64 = 50e6;

/// Hoop strain of the outer surface over cos 2 psi, of a tube under p cos 2 psi on it in plane strain: Michell's
/// solution (Timoshenko and Goodier, Theory of Elasticity, 3rd ed., 1970, art. 43) with the stress function (A r^2 +
/// B r^4 + C / r^2 + D) cos 2 psi:
/// s_r = -(2 A + 6 C / r^4 + 4 D / r^2), s_t = 2 A + 12 B r^2 + 6 C / r^4, t = 2 A + 6 B r^2 - 6 C / r^4 - 2 D / r^2.
fn hoop_strain() -> f64 {
    let row_r = |r: f64| [-2.0, 0.0, -6.0 / r.powi(4), -4.0 / (r * r)];
    let row_t = |r: f64| [2.0, 6.0 * r * r, -6.0 / r.powi(4), -2.0 / (r * r)];
    let mut m = [row_r(INNER), row_t(INNER), row_r(OUTER), row_t(OUTER)];
    let mut right = [0.0, 0.0, -PRESSURE, 0.0];
    for i in 0..4 {
        let pivot = (i..4)
            .max_by(|a, b| m[*a][i].abs().total_cmp(&m[*b][i].abs()))
            .unwrap();
        m.swap(i, pivot);
        right.swap(i, pivot);
        for j in i + 1..4 {
            let factor = m[j][i] / m[i][i];
            (0..4).for_each(|k| m[j][k] -= factor * m[i][k]);
            right[j] -= factor * right[i];
        }
    }
    let mut x = [0.0; 4];
    for i in (0..4).rev() {
        let known: f64 = (i + 1..4).map(|k| m[i][k] * x[k]).sum();
        x[i] = (right[i] - known) / m[i][i];
    }
    let [a, b, c, _] = x;
    let hoop = 2.0 * a + 12.0 * b * OUTER * OUTER + 6.0 * c / OUTER.powi(4);
    ((1.0 - POISSON * POISSON) * hoop + POISSON * (1.0 + POISSON) * PRESSURE) / YOUNG
}

/// A quarter of the tube with n cells through its wall under p cos 2 psi, between rigid plane ends.
fn oval(n: usize) -> (Mesh, Vec<f64>) {
    let mesh = ring(
        ElementKind::Hex20,
        [n, 3 * n, 1],
        [INNER, OUTER],
        0.006,
        FRAC_PI_2,
    );
    let k = assemble_stiffness(&mesh, &steel()).unwrap();
    let load = traction_load(&mesh, mesh.group("x1"), |[x, y, _], normal| {
        let p = PRESSURE * (x * x - y * y) / (x * x + y * y);
        normal.map(|n| -p * n)
    });
    let mut fixed = BTreeMap::new();
    for (group, i) in [("y0", 1), ("y1", 0), ("z0", 2), ("z1", 2)] {
        for node in mesh.group_nodes(group) {
            fixed.insert(3 * node + i, 0.0);
        }
    }
    let u = solve(&k, &load, &fixed);
    (mesh, u)
}

/// Azimuth of a point of a facet, rad.
fn azimuth(mesh: &Mesh, place: &MeshPoint) -> f64 {
    let shape = fem::element::shape(mesh.kind, place.xi);
    let nodes = mesh.element(place.element).iter().zip(shape);
    let [x, y] = nodes.fold([0.0; 2], |[x, y], (&node, value)| {
        [x + value * mesh.nodes[node][0], y + value * mesh.nodes[node][1]]
    });
    y.atan2(x)
}

/// A point of a hoop gauge.
fn point(mesh: &Mesh, facet: Facet, xi: [f64; 2]) -> GaugePoint {
    let place = MeshPoint::on_facet(mesh, facet, xi);
    let (sin, cos) = azimuth(mesh, &place).sin_cos();
    GaugePoint {
        place,
        direction: [-sin, cos, 0.0],
    }
}

/// Wrong: a gauge would read another strain than that of its place, or none that gets better with the mesh. A hoop
/// gauge from 0 to 30 deg on the outer surface, 2 x 2 Gauss points a facet: its mean is that of cos 2 psi, sin(60
/// deg)/(60 deg). Hex20, whose strain is of second order, and of the fourth where it is sampled at these points.
#[test]
fn a_gauge_on_an_oval_tube_converges_to_the_closed_form() {
    let third = std::f64::consts::FRAC_PI_3;
    let expected = hoop_strain() * third.sin() / third;
    let error = |n: usize| {
        let (mesh, u) = oval(n);
        let g = 1.0 / 3f64.sqrt();
        let mut points = Vec::new();
        for facet in mesh.group("x1") {
            let own = [[-g, -g], [g, -g], [-g, g], [g, g]].map(|xi| point(&mesh, *facet, xi));
            if azimuth(&mesh, &own[0].place) < 0.5 * third {
                points.extend(own);
            }
        }
        assert_eq!(points.len(), 4 * n, "facets of the gauge");
        let found = StrainGauge::new(&mesh, &steel(), &points).strain(&u);
        println!("{n}: {found:e} {expected:e}");
        (found - expected).abs() / expected.abs()
    };
    let errors = [error(2), error(4)];
    assert!(errors[1] < 5e-3, "{errors:?}");
    assert_order(&errors, &[2.0], 4.0, "oval tube, hoop gauge");
}

/// Wrong: a short gauge would read something else than the strain of the node on which it lies. In the limit it is the
/// mean of the strains of the elements round the node; that of the nodal stress, by Hooke's law, and the closed form
/// are met with the mesh: within 2 % and 0.5 %.
#[test]
fn a_gauge_of_no_length_reads_the_strain_of_its_node() {
    let (mesh, u) = oval(6);
    let stress = StressRecovery::new(&mesh, &steel()).unwrap().nodal(&u);
    // The corner of facets at 30 deg and the lower end.
    let wanted = [OUTER * 0.75f64.sqrt(), 0.5 * OUTER, 0.0];
    let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let short = |share: f64| {
        let mut points = Vec::new();
        for facet in mesh.group("x1") {
            for corner in corners {
                let at = point(&mesh, *facet, corner);
                let shape = fem::element::shape(mesh.kind, at.place.xi);
                let nodes = mesh.element(at.place.element).iter().zip(shape);
                let place = nodes.fold([0.0; 3], |sum, (&node, value)| {
                    [0, 1, 2].map(|i| sum[i] + value * mesh.nodes[node][i])
                });
                if (0..3).all(|i| (place[i] - wanted[i]).abs() < 1e-9) {
                    points.push(point(&mesh, *facet, corner.map(|x| (1.0 - share) * x)));
                }
            }
        }
        assert_eq!(points.len(), 2);
        StrainGauge::new(&mesh, &steel(), &points)
    };
    let limit = short(0.0).strain(&u);
    let mut off = f64::INFINITY;
    for share in [1e-1, 1e-2, 1e-3] {
        let next = (short(share).strain(&u) - limit).abs();
        assert!(next < 0.2 * off, "{share}: {next} after {off}");
        off = next;
    }
    let expected = 0.5 * hoop_strain();
    assert_close(limit, expected, 2e-2 * expected.abs(), "closed form");
    let of_node = short(0.0).strain_of_stress(&stress);
    assert_close(limit, of_node, 2e-2 * expected.abs(), "nodal stress");
}
