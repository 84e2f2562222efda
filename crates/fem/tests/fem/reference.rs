//! Shape functions and integration rules against their defining properties.

use fem::{element, facet, quadrature};
use mesh::{ElementKind, FacetKind};

use crate::support::assert_close;

const FACETS: [FacetKind; 3] = [FacetKind::Quad4, FacetKind::Quad8, FacetKind::Tri6];
/// Points inside every reference cell, without symmetry.
const INSIDE: [[f64; 3]; 3] = [[0.11, 0.23, 0.31], [0.4, 0.05, 0.17], [0.07, 0.52, 0.29]];
/// Sums of a few dozen products of numbers near 1.
const ROUND_OFF: f64 = 1e-14;

/// Otherwise a constant displacement would strain the element.
#[test]
fn shape_functions_sum_to_one_and_their_gradients_to_zero() {
    for kind in ElementKind::ALL {
        for xi in INSIDE {
            assert_close(element::shape(kind, xi).iter().sum(), 1.0, ROUND_OFF, kind.name());
            for i in 0..3 {
                let sum: f64 = element::gradients(kind, xi).iter().map(|dn| dn[i]).sum();
                assert_close(sum, 0.0, ROUND_OFF, kind.name());
            }
        }
    }
    for kind in FACETS {
        for [x, y, _] in INSIDE {
            assert_close(
                facet::shape(kind, [x, y]).iter().sum(),
                1.0,
                ROUND_OFF,
                &format!("{kind:?}"),
            );
        }
    }
}

/// Otherwise nodal values would not be values at the nodes, or nodes would be in another order than the mesh's.
#[test]
fn every_shape_function_is_one_at_its_node_and_zero_at_the_others() {
    for kind in ElementKind::ALL {
        let nodes = element::reference_nodes(kind);
        assert_eq!(nodes.len(), kind.n_nodes());
        for (b, &xi) in nodes.iter().enumerate() {
            for (a, n) in element::shape(kind, xi).into_iter().enumerate() {
                assert_close(
                    n,
                    if a == b { 1.0 } else { 0.0 },
                    ROUND_OFF,
                    &format!("{} N_{a} at {b}", kind.name()),
                );
            }
        }
    }
    for kind in FACETS {
        for (b, &xi) in facet::reference_nodes(kind).iter().enumerate() {
            for (a, n) in facet::shape(kind, xi).into_iter().enumerate() {
                assert_close(
                    n,
                    if a == b { 1.0 } else { 0.0 },
                    ROUND_OFF,
                    &format!("{kind:?} N_{a} at {b}"),
                );
            }
        }
    }
}

/// Otherwise strains and normals would be wrong; central differences of step 1e-5 err by 1e-10.
#[test]
fn gradients_equal_finite_differences() {
    let h = 1e-5;
    for xi in INSIDE {
        for i in 0..3 {
            let (mut up, mut down) = (xi, xi);
            up[i] += h;
            down[i] -= h;
            for kind in ElementKind::ALL {
                let (up, down) = (element::shape(kind, up), element::shape(kind, down));
                for (a, dn) in element::gradients(kind, xi).iter().enumerate() {
                    assert_close(dn[i], (up[a] - down[a]) / (2.0 * h), 1e-9, kind.name());
                }
            }
            for kind in FACETS.into_iter().filter(|_| i < 2) {
                let (up, down) = (
                    facet::shape(kind, [up[0], up[1]]),
                    facet::shape(kind, [down[0], down[1]]),
                );
                for (a, dn) in facet::gradients(kind, [xi[0], xi[1]]).iter().enumerate() {
                    assert_close(dn[i], (up[a] - down[a]) / (2.0 * h), 1e-9, &format!("{kind:?}"));
                }
            }
        }
    }
}

/// Otherwise surface loads and raceway interpolation would not match the displacements of the elements below.
#[test]
fn facet_functions_are_the_traces_of_element_functions_and_their_normals_point_outward() {
    for kind in ElementKind::ALL {
        let nodes = element::reference_nodes(kind);
        let inside = match kind {
            ElementKind::Tet10 => [0.25; 3],
            _ => [0.0; 3],
        };
        for face in 0..kind.n_faces() {
            let on_face = kind.face_nodes(face);
            let x: Vec<[f64; 3]> = on_face.iter().map(|&a| nodes[a]).collect();
            let xi = [0.21, 0.34];
            let (point, area) = facet::point_and_area(kind.facet_kind(), &x, xi);
            let outward: f64 = (0..3).map(|i| area[i] * (point[i] - inside[i])).sum();
            assert!(outward > 0.0, "{} face {face}", kind.name());
            let (all, own) = (element::shape(kind, point), facet::shape(kind.facet_kind(), xi));
            for a in 0..kind.n_nodes() {
                let expected = on_face
                    .iter()
                    .position(|&b| a == b)
                    .map_or(0.0, |place| own[place]);
                assert_close(
                    all[a],
                    expected,
                    ROUND_OFF,
                    &format!("{} face {face} node {a}", kind.name()),
                );
            }
        }
    }
}

/// Otherwise "exact" in the documents would not hold; exact integrals of monomials on the cube and the simplex.
#[test]
fn rules_integrate_monomials_up_to_their_degree_exactly_and_not_beyond() {
    for n in 1..=5 {
        let line = quadrature::gauss_legendre(n);
        let integral = |p: i32| line.iter().map(|(x, w)| w * x.powi(p)).sum::<f64>();
        for p in 0..2 * n as i32 {
            let exact = if p % 2 == 0 { 2.0 / (p + 1) as f64 } else { 0.0 };
            assert_close(integral(p), exact, ROUND_OFF, &format!("{n} points, x^{p}"));
        }
        let beyond = 2 * n as i32;
        assert!((integral(beyond) - 2.0 / (beyond + 1) as f64).abs() > 1e-4);
    }
    let factorial = |p: i32| (1..=p).map(f64::from).product::<f64>();
    let simplex =
        |p: [i32; 3]| factorial(p[0]) * factorial(p[1]) * factorial(p[2]) / factorial(p[0] + p[1] + p[2] + 3);
    for (rule, degree) in [(quadrature::tetrahedron_4(), 2), (quadrature::tetrahedron(5), 7)] {
        for (i, j, k) in powers(degree) {
            let terms = rule
                .points
                .iter()
                .map(|x| x[0].powi(i) * x[1].powi(j) * x[2].powi(k));
            let sum: f64 = terms.zip(&rule.weights).map(|(t, w)| t * w).sum();
            assert_close(
                sum,
                simplex([i, j, k]),
                1e-15,
                &format!("tetrahedron, powers {i} {j} {k}"),
            );
        }
    }
    let rule = quadrature::triangle(4);
    for (i, j, _) in powers(6).filter(|power| power.2 == 0) {
        let terms = rule.points.iter().map(|x| x[0].powi(i) * x[1].powi(j));
        let sum: f64 = terms.zip(&rule.weights).map(|(t, w)| t * w).sum();
        let exact = factorial(i) * factorial(j) / factorial(i + j + 2);
        assert_close(sum, exact, 1e-15, &format!("triangle, powers {i} {j}"));
    }
}

/// All powers of three variables up to a total degree.
fn powers(degree: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    (0..=degree)
        .flat_map(move |i| (0..=degree - i).flat_map(move |j| (0..=degree - i - j).map(move |k| (i, j, k))))
}
