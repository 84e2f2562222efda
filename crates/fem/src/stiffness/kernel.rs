//! Element stiffness matrices.
//!
//! The number of functions is a constant so that the loops over node pairs are unrolled and kept in registers; nothing
//! outside this file sees it.

use mesh::Mesh;

use super::modes::IncompatibleModes;
use crate::error::FemError;
use crate::geometry::{checked_map, coordinates, physical};
use crate::table::ShapeTable;

/// Points of the largest stiffness rule, hex20's.
const MAX_POINTS: usize = 27;
/// Functions of the hex8 with its three incompatible modes.
const WITH_MODES: usize = 11;
/// Degrees of freedom of the three incompatible modes.
const MODE_DOFS: usize = 9;
/// Degrees of freedom of the 8 nodes.
const NODE_DOFS: usize = 24;

/// Products `T_ij` of gradients, integrated, for ij = xx yy zz xy yz xz, `[6][N][N]`.
type Products<const N: usize> = [[[f64; N]; N]; 6];

/// Components of the six products.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

/// Stiffness of element `e` with N nodes and compatible displacements, N/m, `[3 N][3 N]`.
pub(crate) fn compatible<const N: usize>(
    table: &ShapeTable,
    mesh: &Mesh,
    e: usize,
    lambda: f64,
    mu: f64,
    matrix: &mut [f64],
) -> Result<(), FemError> {
    let x = coordinates(mesh, e);
    let mut gradients = [[[0.0; N]; 3]; MAX_POINTS];
    let mut weights = [0.0; MAX_POINTS];
    for q in 0..table.n_points() {
        let map = checked_map(table, q, &x, e)?;
        weights[q] = table.weights[q] * map.det;
        node_gradients(&table.gradients[q], &map.inverse, N, &mut gradients[q]);
    }
    let products = integrate_products(&gradients[..table.n_points()], &weights);
    expand(&products, lambda, mu, matrix);
    Ok(())
}

/// Stiffness of the 8-node element `e` with condensed incompatible modes, N/m, `[24][24]`.
pub(crate) fn with_modes(
    table: &ShapeTable,
    mesh: &Mesh,
    e: usize,
    lambda: f64,
    mu: f64,
    matrix: &mut [f64],
) -> Result<(), FemError> {
    let x = coordinates(mesh, e);
    let modes = IncompatibleModes::new(&x, e)?;
    let mut gradients = [[[0.0; WITH_MODES]; 3]; 8];
    let mut weights = [0.0; MAX_POINTS];
    for q in 0..table.n_points() {
        let map = checked_map(table, q, &x, e)?;
        weights[q] = table.weights[q] * map.det;
        node_gradients(&table.gradients[q], &map.inverse, 8, &mut gradients[q]);
        for k in 0..3 {
            let gradient = modes.gradient(k, table.points[q], map.det);
            for i in 0..3 {
                gradients[q][i][8 + k] = gradient[i];
            }
        }
    }
    let products = integrate_products(&gradients, &weights);
    let mut full = [0.0; 9 * WITH_MODES * WITH_MODES];
    expand(&products, lambda, mu, &mut full);
    condense(&full, matrix);
    Ok(())
}

/// Physical gradients of the first `n` functions, 1/m, by component.
fn node_gradients<const N: usize>(
    dn: &[[f64; crate::element::MAX_NODES]; 3],
    inverse: &[[f64; 3]; 3],
    n: usize,
    gradients: &mut [[f64; N]; 3],
) {
    for a in 0..n {
        let gradient = physical(inverse, [dn[0][a], dn[1][a], dn[2][a]]);
        for i in 0..3 {
            gradients[i][a] = gradient[i];
        }
    }
}

/// `T_ij[a][b] = sum_q w_q dN_a/dx_i dN_b/dx_j`, m, in the order of [`PAIRS`].
fn integrate_products<const N: usize>(gradients: &[[[f64; N]; 3]], weights: &[f64]) -> Products<N> {
    let mut products = [[[0.0; N]; N]; 6];
    for (product, [i, j]) in products.iter_mut().zip(PAIRS) {
        for (a, row) in product.iter_mut().enumerate() {
            let mut sum = [0.0; N];
            for (gradient, &w) in gradients.iter().zip(weights) {
                let factor = w * gradient[i][a];
                for b in 0..N {
                    sum[b] += factor * gradient[j][b];
                }
            }
            *row = sum;
        }
    }
    products
}

/// Writes `K_ij = lambda T_ij + mu T_ji + mu tr(T) I_ij`; entries below the diagonal copy those above.
fn expand<const N: usize>(products: &Products<N>, lambda: f64, mu: f64, matrix: &mut [f64]) {
    let [xx, yy, zz, xy, yz, xz] = products;
    let n = 3 * N;
    for a in 0..N {
        for b in a..N {
            let t = [
                [xx[a][b], xy[a][b], xz[a][b]],
                [xy[b][a], yy[a][b], yz[a][b]],
                [xz[b][a], yz[b][a], zz[a][b]],
            ];
            let trace = mu * (t[0][0] + t[1][1] + t[2][2]);
            for i in 0..3 {
                for j in 0..3 {
                    let shear = if i == j {
                        mu * t[i][i] + trace
                    } else {
                        mu * t[j][i]
                    };
                    let value = lambda * t[i][j] + shear;
                    matrix[(3 * a + i) * n + 3 * b + j] = value;
                    matrix[(3 * b + j) * n + 3 * a + i] = value;
                }
            }
        }
    }
}

/// Eliminates the modes: `K_uu - K_um K_mm^-1 K_mu`, with `K_mm = L L^T` (positive definite: the modes' strains are
/// independent at the 8 points).
fn condense(full: &[f64], matrix: &mut [f64]) {
    const N: usize = 3 * WITH_MODES;
    let mut factor = [[0.0; MODE_DOFS]; MODE_DOFS];
    // Rows of L^-1 K_mu.
    let mut coupling = [[0.0; NODE_DOFS]; MODE_DOFS];
    for r in 0..MODE_DOFS {
        let row = &full[(NODE_DOFS + r) * N..][..N];
        coupling[r].copy_from_slice(&row[..NODE_DOFS]);
        for c in 0..r {
            let mut entry = row[NODE_DOFS + c];
            for k in 0..c {
                entry -= factor[r][k] * factor[c][k];
            }
            let entry = entry / factor[c][c];
            factor[r][c] = entry;
            let done = coupling[c];
            for s in 0..NODE_DOFS {
                coupling[r][s] -= entry * done[s];
            }
        }
        let mut pivot = row[NODE_DOFS + r];
        for k in 0..r {
            pivot -= factor[r][k] * factor[r][k];
        }
        factor[r][r] = pivot.sqrt();
        for s in 0..NODE_DOFS {
            coupling[r][s] /= factor[r][r];
        }
    }
    for r in 0..NODE_DOFS {
        let mut row = [0.0; NODE_DOFS];
        row.copy_from_slice(&full[r * N..][..NODE_DOFS]);
        for done in &coupling {
            for s in r..NODE_DOFS {
                row[s] -= done[r] * done[s];
            }
        }
        for s in r..NODE_DOFS {
            matrix[r * NODE_DOFS + s] = row[s];
            matrix[s * NODE_DOFS + r] = row[s];
        }
    }
}
