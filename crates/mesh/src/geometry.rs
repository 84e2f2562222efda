//! Jacobians and volumes of the elements, as the checks of a mesh need them.
//!
//! Shape functions: trilinear and serendipity hexahedron, quadratic tetrahedron, in the reference coordinates
//! and node order of VTK (Zienkiewicz, Taylor, Zhu, "The Finite Element Method", 7th ed. 2013, sec. 6.2).
//! Elasticity uses the elements of the crate `fem`; here only det J matters.

use crate::element::ElementKind;
use crate::mesh::Mesh;

/// Reference corners of the hexahedron.
const HEX_CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Reference corners of the tetrahedron.
const TET_CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Derivatives of the shape functions in the reference coordinates; the first `n_nodes` rows count.
pub(crate) type Gradients = [[f64; 3]; 20];

/// Reference coordinates of the nodes.
pub(crate) fn reference_nodes(kind: ElementKind) -> Vec<[f64; 3]> {
    let corners: &[[f64; 3]] = match kind {
        ElementKind::Hex8 | ElementKind::Hex20 => &HEX_CORNERS,
        ElementKind::Tet10 => &TET_CORNERS,
    };
    let mut nodes = corners.to_vec();
    if kind != ElementKind::Hex8 {
        let mid = |&[a, b]: &[usize; 2]| std::array::from_fn(|i| 0.5 * (corners[a][i] + corners[b][i]));
        nodes.extend(kind.edges().iter().map(mid));
    }
    nodes
}

/// Shape function gradients at the reference point `xi`.
pub(crate) fn gradients(kind: ElementKind, xi: [f64; 3]) -> Gradients {
    match kind {
        ElementKind::Hex8 => hex8_gradients(xi),
        ElementKind::Hex20 => hex20_gradients(xi),
        ElementKind::Tet10 => tet10_gradients(xi),
    }
}

fn hex8_gradients(xi: [f64; 3]) -> Gradients {
    let mut g = [[0.0; 3]; 20];
    for (a, corner) in HEX_CORNERS.iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|i| 1.0 + xi[i] * corner[i]);
        for i in 0..3 {
            g[a][i] = 0.125 * corner[i] * f[(i + 1) % 3] * f[(i + 2) % 3];
        }
    }
    g
}

fn hex20_gradients(xi: [f64; 3]) -> Gradients {
    let mut g = [[0.0; 3]; 20];
    for (a, node) in reference_nodes(ElementKind::Hex20).iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|i| 1.0 + xi[i] * node[i]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let bubble = |l: usize| if node[l] == 0.0 { 1.0 - xi[l] * xi[l] } else { f[l] };
            g[a][i] = if a < 8 {
                let sum = xi[0] * node[0] + xi[1] * node[1] + xi[2] * node[2] - 2.0;
                0.125 * node[i] * f[j] * f[k] * (sum + f[i])
            } else if node[i] == 0.0 {
                -0.5 * xi[i] * f[j] * f[k]
            } else {
                0.25 * node[i] * bubble(j) * bubble(k)
            };
        }
    }
    g
}

fn tet10_gradients(xi: [f64; 3]) -> Gradients {
    let l = [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]];
    let dl = [
        [-1.0, -1.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let mut g = [[0.0; 3]; 20];
    for i in 0..3 {
        for a in 0..4 {
            g[a][i] = (4.0 * l[a] - 1.0) * dl[a][i];
        }
        for (e, &[a, b]) in ElementKind::Tet10.edges().iter().enumerate() {
            g[4 + e][i] = 4.0 * (l[a] * dl[b][i] + l[b] * dl[a][i]);
        }
    }
    g
}

/// Shape functions at the reference point `xi`; the first `n_nodes` count.
pub(crate) fn values(kind: ElementKind, xi: [f64; 3]) -> [f64; 20] {
    let mut n = [0.0; 20];
    if kind == ElementKind::Tet10 {
        let l = [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]];
        (0..4).for_each(|a| n[a] = l[a] * (2.0 * l[a] - 1.0));
        for (e, &[a, b]) in kind.edges().iter().enumerate() {
            n[4 + e] = 4.0 * l[a] * l[b];
        }
        return n;
    }
    for (a, node) in reference_nodes(kind).iter().enumerate() {
        let factor = |i: usize| match node[i] == 0.0 {
            true => 1.0 - xi[i] * xi[i],
            false => 1.0 + xi[i] * node[i],
        };
        let product = factor(0) * factor(1) * factor(2);
        let sum = (0..3).map(|i| xi[i] * node[i]).sum::<f64>() - 2.0;
        n[a] = match (kind, a < 8) {
            (ElementKind::Hex20, true) => 0.125 * product * sum,
            (ElementKind::Hex20, false) => 0.25 * product,
            _ => 0.125 * product,
        };
    }
    n
}

/// Points and weights that integrate det J exactly: Gauss 2x2x2 and 3x3x3, and for the tetrahedron the
/// five-point rule of degree 3 (Stroud 1971, T3: 3-1).
pub(crate) fn quadrature(kind: ElementKind) -> Vec<([f64; 3], f64)> {
    let line: &[(f64, f64)] = match kind {
        ElementKind::Hex8 => &[(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)],
        ElementKind::Hex20 => &[
            (-0.774_596_669_241_483_4, 5.0 / 9.0),
            (0.0, 8.0 / 9.0),
            (0.774_596_669_241_483_4, 5.0 / 9.0),
        ],
        ElementKind::Tet10 => {
            let mut points = vec![([0.25; 3], -4.0 / 30.0)];
            let (a, b) = (0.5, 1.0 / 6.0);
            points.extend([[b, b, b], [a, b, b], [b, a, b], [b, b, a]].map(|p| (p, 9.0 / 120.0)));
            return points;
        }
    };
    let mut points = Vec::with_capacity(27);
    for &(z, wz) in line {
        for &(y, wy) in line {
            points.extend(line.iter().map(|&(x, wx)| ([x, y, z], wx * wy * wz)));
        }
    }
    points
}

/// det J of an element with node coordinates `x` (m, `[n_nodes][3]`), m^3 per unit of reference volume.
pub(crate) fn determinant(x: &[[f64; 3]], gradients: &Gradients) -> f64 {
    let mut j = [[0.0; 3]; 3];
    for (p, g) in x.iter().zip(gradients) {
        for r in 0..3 {
            for c in 0..3 {
                j[r][c] += p[r] * g[c];
            }
        }
    }
    j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0])
        + j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0])
}

/// Coordinates of the nodes of element `e`, relative to its first node so that det J does not lose digits.
pub(crate) fn element_coordinates(mesh: &Mesh, e: usize, x: &mut Vec<[f64; 3]>) {
    let nodes = mesh.element(e);
    let origin = mesh.nodes[nodes[0]];
    x.clear();
    x.extend(
        nodes
            .iter()
            .map(|&n| std::array::from_fn(|i| mesh.nodes[n][i] - origin[i])),
    );
}

/// Volume of the mesh, m^3: the exact integral of det J, summed in element order.
pub fn volume(mesh: &Mesh) -> f64 {
    let points: Vec<(Gradients, f64)> = quadrature(mesh.kind)
        .into_iter()
        .map(|(xi, w)| (gradients(mesh.kind, xi), w))
        .collect();
    let mut x = Vec::with_capacity(20);
    let mut total = 0.0;
    for e in 0..mesh.n_elements() {
        element_coordinates(mesh, e, &mut x);
        total += points.iter().map(|(g, w)| w * determinant(&x, g)).sum::<f64>();
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: centres and moments of meshes would be those of other bodies.
    #[test]
    fn shape_functions_reproduce_linear_and_quadratic_fields() {
        for kind in ElementKind::ALL {
            let nodes = reference_nodes(kind);
            for xi in [[0.1, 0.2, 0.3], [0.0, 0.0, 0.0], [0.25, 0.5, 0.125]] {
                let n = values(kind, xi);
                let value = |f: &dyn Fn(&[f64; 3]) -> f64| -> f64 {
                    nodes.iter().zip(&n).map(|(p, n)| f(p) * n).sum()
                };
                assert!((value(&|_| 1.0) - 1.0).abs() < 1e-14, "{kind:?}");
                for i in 0..3 {
                    let j = (i + 1) % 3;
                    assert!((value(&|p| p[i]) - xi[i]).abs() < 1e-14, "{kind:?}");
                    if kind != ElementKind::Hex8 {
                        assert!(
                            (value(&|p| p[i] * p[j]) - xi[i] * xi[j]).abs() < 1e-14,
                            "{kind:?}"
                        );
                    }
                }
            }
        }
    }

    /// If this failed, det J would not be the derivative of the element's map, and every check of shape would lie.
    #[test]
    fn gradients_reproduce_linear_and_quadratic_fields() {
        for kind in ElementKind::ALL {
            let nodes = reference_nodes(kind);
            for xi in [[0.1, 0.2, 0.3], [0.0, 0.0, 0.0], [0.25, 0.5, 0.125]] {
                let g = gradients(kind, xi);
                for i in 0..3 {
                    let slope = |f: &dyn Fn(&[f64; 3]) -> f64| -> f64 {
                        nodes.iter().zip(&g).map(|(p, g)| f(p) * g[i]).sum()
                    };
                    // Rounding of at most 20 products of size one.
                    assert!(slope(&|_| 1.0).abs() < 1e-14, "{kind:?} constant");
                    assert!((slope(&|p| p[i]) - 1.0).abs() < 1e-14, "{kind:?} linear");
                    if kind != ElementKind::Hex8 {
                        let j = (i + 1) % 3;
                        assert!(
                            (slope(&|p| p[i] * p[j]) - xi[j]).abs() < 1e-14,
                            "{kind:?} bilinear"
                        );
                        assert!(
                            (slope(&|p| p[i] * p[i]) - 2.0 * xi[i]).abs() < 1e-14,
                            "{kind:?} quadratic"
                        );
                    }
                }
            }
        }
    }
}
