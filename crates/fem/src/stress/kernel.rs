//! Strain inside one element from its nodal displacements.

use mesh::{ElementKind, Mesh};

use super::strain;
use crate::element::MAX_NODES;
use crate::geometry::{ElementCoordinates, InverseMap, invert};
use crate::material::hooke;
use crate::stiffness::modes::IncompatibleModes;
use crate::table::ShapeTable;

/// Points of the largest stiffness rule.
pub(crate) const MAX_POINTS: usize = 27;
/// Degrees of freedom of the three incompatible modes.
const MODE_DOFS: usize = 9;

/// Position and displacement of an element's nodes, m, `[MAX_NODES][6]`, zero beyond its nodes.
pub(crate) type NodeState = [[f64; 6]; MAX_NODES];

/// Positions and displacements of the nodes of an element, from node lists and displacements, `[3 n_nodes]`.
pub(crate) fn node_state(positions: &[[f64; 3]], element: &[usize], u: &[f64]) -> NodeState {
    let mut state = [[0.0; 6]; MAX_NODES];
    for (s, &node) in state.iter_mut().zip(element) {
        s[..3].copy_from_slice(&positions[node]);
        s[3..].copy_from_slice(&u[3 * node..3 * node + 3]);
    }
    state
}

/// The inverse map and the gradient of the nodal displacements, `du_i/dx_j`, at point `q` of a table.
pub(crate) fn displacement_gradient(
    table: &ShapeTable,
    q: usize,
    n_nodes: usize,
    state: &NodeState,
) -> (InverseMap, [[f64; 3]; 3]) {
    let dn = &table.gradients[q];
    // Derivatives of (x, u) with respect to the reference coordinates.
    let mut slopes = [[0.0; 6]; 3];
    for a in 0..n_nodes {
        for i in 0..3 {
            for c in 0..6 {
                slopes[i][c] += dn[i][a] * state[a][c];
            }
        }
    }
    let map = invert(&slopes.map(|s| [s[0], s[1], s[2]]));
    let mut gradient = [[0.0; 3]; 3];
    for c in 0..3 {
        for j in 0..3 {
            let row = &map.inverse[j];
            gradient[c][j] =
                row[0] * slopes[0][3 + c] + row[1] * slopes[1][3 + c] + row[2] * slopes[2][3 + c];
        }
    }
    (map, gradient)
}

/// Strain of the nodal displacements at the points of the stiffness rule, `[n_points]`, and the determinants, m^3.
pub(crate) fn compatible_strains(
    table: &ShapeTable,
    n_nodes: usize,
    state: &NodeState,
    strains: &mut [[f64; 6]; MAX_POINTS],
) -> [f64; MAX_POINTS] {
    let mut dets = [1.0; MAX_POINTS];
    for q in 0..table.n_points() {
        let (map, gradient) = displacement_gradient(table, q, n_nodes, state);
        dets[q] = map.det;
        strains[q] = strain(gradient);
    }
    dets
}

/// Incompatible modes of an 8-node element and their amplitudes, m, `[mode][component]`, in equilibrium with the
/// strains of its nodal displacements at the points of the stiffness rule: `K_mm alpha = -integral of B_m^T sigma`.
pub(crate) fn equilibrate_modes(
    table: &ShapeTable,
    state: &NodeState,
    strains: &[[f64; 6]; MAX_POINTS],
    dets: &[f64; MAX_POINTS],
    [lambda, mu]: [f64; 2],
) -> (IncompatibleModes, [[f64; 3]; 3]) {
    let mut x: ElementCoordinates = [[0.0; 3]; MAX_NODES];
    for a in 0..8 {
        x[a] = [state[a][0], state[a][1], state[a][2]];
    }
    let modes = IncompatibleModes::unchecked(&x);
    // Weighted stress moments, and integrals of the products of the modes' reference slopes.
    let (mut moments, mut products) = ([[0.0; 6]; 3], [[0.0; 3]; 3]);
    for q in 0..8 {
        let stress = hooke(lambda, mu, strains[q]);
        let slopes = table.points[q].map(|xi| -2.0 * xi * table.weights[q]);
        let scale = modes.det() / (table.weights[q] * dets[q]);
        for k in 0..3 {
            for c in 0..6 {
                moments[k][c] += slopes[k] * stress[c];
            }
            for l in 0..=k {
                products[k][l] += scale * slopes[k] * slopes[l];
            }
        }
    }
    let (mut matrix, mut load) = ([[0.0; MODE_DOFS]; MODE_DOFS], [0.0; MODE_DOFS]);
    let inverse = modes.inverse();
    for k in 0..3 {
        let [xx, yy, zz, xy, yz, xz] = moments[k];
        for (i, row) in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].into_iter().enumerate() {
            load[3 * k + i] = -(row[0] * inverse[0][k] + row[1] * inverse[1][k] + row[2] * inverse[2][k]);
        }
        for l in 0..=k {
            let (g, h) = ([0, 1, 2].map(|i| inverse[i][k]), [0, 1, 2].map(|i| inverse[i][l]));
            let dot = g[0] * h[0] + g[1] * h[1] + g[2] * h[2];
            for i in 0..3 {
                for j in 0..3 {
                    let diagonal = if i == j { mu * dot } else { 0.0 };
                    let block = lambda * g[i] * h[j] + mu * g[j] * h[i] + diagonal;
                    matrix[3 * k + i][3 * l + j] = products[k][l] * block;
                }
            }
        }
    }
    solve(&mut matrix, &mut load);
    let alpha = [0, 1, 2].map(|k| [load[3 * k], load[3 * k + 1], load[3 * k + 2]]);
    (modes, alpha)
}

/// Displacement gradient of the modes, `du_i/dx_j`, at a reference point with determinant `det`.
pub(crate) fn mode_gradient(
    modes: &IncompatibleModes,
    alpha: &[[f64; 3]; 3],
    xi: [f64; 3],
    det: f64,
) -> [[f64; 3]; 3] {
    let mut gradient = [[0.0; 3]; 3];
    for k in 0..3 {
        let slope = modes.gradient(k, xi, det);
        for i in 0..3 {
            for j in 0..3 {
                gradient[i][j] += alpha[k][i] * slope[j];
            }
        }
    }
    gradient
}

/// Strain at the points of the stiffness rule, `[n_points]`, incompatible modes of hex8 included; returns the volume,
/// m^3.
pub(crate) fn strains(
    table: &ShapeTable,
    state: &NodeState,
    lame: [f64; 2],
    strains: &mut [[f64; 6]; MAX_POINTS],
) -> f64 {
    // Constants let the compiler unroll the loops over nodes.
    let dets = match table.kind {
        ElementKind::Hex8 => compatible_strains(table, 8, state, strains),
        ElementKind::Hex20 => compatible_strains(table, 20, state, strains),
        ElementKind::Tet10 => compatible_strains(table, 10, state, strains),
    };
    if table.kind == ElementKind::Hex8 {
        let (modes, alpha) = equilibrate_modes(table, state, strains, &dets, lame);
        for q in 0..8 {
            let extra = strain(mode_gradient(&modes, &alpha, table.points[q], dets[q]));
            for c in 0..6 {
                strains[q][c] += extra[c];
            }
        }
    }
    table.weights.iter().zip(dets).map(|(w, det)| w * det).sum()
}

/// Strain at every point of any table in element `e`, from the modes found with the stiffness rule's table.
pub(crate) fn strains_at(
    mesh: &Mesh,
    e: usize,
    u: &[f64],
    lame: [f64; 2],
    stiffness: &ShapeTable,
    points: &ShapeTable,
) -> Vec<[f64; 6]> {
    let n = mesh.kind.n_nodes();
    let state = node_state(&mesh.nodes, mesh.element(e), u);
    let modes = (mesh.kind == ElementKind::Hex8).then(|| {
        let mut own = [[0.0; 6]; MAX_POINTS];
        let dets = compatible_strains(stiffness, n, &state, &mut own);
        equilibrate_modes(stiffness, &state, &own, &dets, lame)
    });
    let at_point = |q: usize| {
        let (map, mut gradient) = displacement_gradient(points, q, n, &state);
        if let Some((modes, alpha)) = &modes {
            let extra = mode_gradient(modes, alpha, points.points[q], map.det);
            for i in 0..3 {
                for j in 0..3 {
                    gradient[i][j] += extra[i][j];
                }
            }
        }
        strain(gradient)
    };
    (0..points.n_points()).map(at_point).collect()
}

/// Solves `A x = b` in place for symmetric positive definite A, given below its diagonal, by `L D L^T`.
fn solve(a: &mut [[f64; MODE_DOFS]; MODE_DOFS], b: &mut [f64; MODE_DOFS]) {
    // Column by column: a[r][c] becomes L_rc, the diagonal 1 / D.
    for c in 0..MODE_DOFS {
        let inverse = 1.0 / a[c][c];
        a[c][c] = inverse;
        let mut factors = [0.0; MODE_DOFS];
        for r in c + 1..MODE_DOFS {
            factors[r] = a[r][c] * inverse;
        }
        for r in c + 1..MODE_DOFS {
            let entry = a[r][c];
            for s in c + 1..=r {
                a[r][s] -= entry * factors[s];
            }
            a[r][c] = factors[r];
            b[r] -= factors[r] * b[c];
        }
    }
    for c in (0..MODE_DOFS).rev() {
        b[c] *= a[c][c];
        for r in c + 1..MODE_DOFS {
            b[c] -= a[r][c] * b[r];
        }
    }
}
