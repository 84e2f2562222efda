//! Matrices and checks shared by the tests.

use sprs::{CsMat, TriMat};

/// Deterministic numbers in (-1, 1): a linear congruential generator (Knuth, MMIX constants).
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Numbers(seed)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// A ring of hexahedra: `n_theta` sectors of a section of `n_z` by `n_r` elements.
pub struct Ring {
    pub points: Vec<[f64; 3]>,
    pub elements: Vec<usize>,
}

impl Ring {
    pub fn new(n_theta: usize, n_z: usize, n_r: usize) -> Self {
        let node = |i: usize, j: usize, k: usize| ((i % n_theta) * (n_z + 1) + j) * (n_r + 1) + k;
        let mut points = Vec::new();
        for i in 0..n_theta {
            let angle = std::f64::consts::TAU * i as f64 / n_theta as f64;
            for j in 0..=n_z {
                for k in 0..=n_r {
                    let r = 0.028 + 0.006 * k as f64 / n_r as f64;
                    points.push([r * angle.cos(), r * angle.sin(), 0.016 * j as f64 / n_z as f64]);
                }
            }
        }
        let mut elements = Vec::new();
        for i in 0..n_theta {
            for j in 0..n_z {
                for k in 0..n_r {
                    for (a, b, c) in [
                        (0, 0, 0),
                        (0, 0, 1),
                        (1, 0, 1),
                        (1, 0, 0),
                        (0, 1, 0),
                        (0, 1, 1),
                        (1, 1, 1),
                        (1, 1, 0),
                    ] {
                        elements.push(node(i + a, j + b, k + c));
                    }
                }
            }
        }
        Ring { points, elements }
    }

    pub fn n_dofs(&self) -> usize {
        3 * self.points.len()
    }

    /// Stiffness of springs between all nodes that share an element, each along its own direction plus a fifth of it
    /// across: positive semi-definite, and rigid translations (not rotations) are free.
    pub fn springs(&self) -> CsMat<f64> {
        let n = self.points.len();
        let mut pairs = std::collections::BTreeSet::new();
        for element in self.elements.chunks_exact(8) {
            for &a in element {
                pairs.extend(element.iter().filter(|&&b| b > a).map(|&b| (a, b)));
            }
        }
        let mut triplets = TriMat::new((3 * n, 3 * n));
        for (a, b) in pairs {
            let along: Vec<f64> = (0..3).map(|i| self.points[b][i] - self.points[a][i]).collect();
            let square: f64 = along.iter().map(|x| x * x).sum();
            for i in 0..3 {
                for j in 0..3 {
                    let value = along[i] * along[j] / square + if i == j { 0.2 } else { 0.0 };
                    triplets.add_triplet(3 * a + i, 3 * a + j, value);
                    triplets.add_triplet(3 * b + i, 3 * b + j, value);
                    triplets.add_triplet(3 * a + i, 3 * b + j, -value);
                    triplets.add_triplet(3 * b + i, 3 * a + j, -value);
                }
            }
        }
        triplets.to_csr()
    }

    /// The springs with a mass term on the diagonal.
    pub fn stiffness_with_mass(&self, mass: f64) -> CsMat<f64> {
        shifted(&self.springs(), mass)
    }

    pub fn order(&self) -> Vec<usize> {
        solver::expand(&solver::angular_dissection(&self.points, &self.elements, 8), 3)
    }
}

/// The matrix plus a multiple of the identity.
pub fn shifted(matrix: &CsMat<f64>, shift: f64) -> CsMat<f64> {
    let mut shifted = matrix.clone();
    for i in 0..shifted.rows() {
        *shifted.get_mut(i, i).expect("a stiffness has its whole diagonal") += shift;
    }
    shifted
}

/// Row-major copy.
pub fn dense(matrix: &CsMat<f64>) -> Vec<f64> {
    let n = matrix.rows();
    let mut dense = vec![0.0; n * n];
    matrix
        .iter()
        .for_each(|(&value, (i, j))| dense[n * i + j] = value);
    dense
}

/// Largest difference relative to the largest entry of `expected`.
pub fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    found.iter().zip(expected).fold(
        0.0,
        |m: f64, (x, y)| if (x - y).abs() <= m { m } else { (x - y).abs() },
    ) / largest
}

/// Fails with both numbers when the relative error exceeds `tolerance`.
#[track_caller]
pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    let error = relative_error(found, expected);
    assert!(
        error <= tolerance,
        "relative error {error:.2e} exceeds {tolerance:.1e}"
    );
}

/// Entries of L and sum of squared column lengths, by walking row subtrees (Liu 1990): an independent count.
pub fn count_fill(matrix: &CsMat<f64>, order: &[usize]) -> (usize, f64) {
    let n = order.len();
    let mut inverse = vec![0; n];
    order.iter().enumerate().for_each(|(k, &row)| inverse[row] = k);
    let (mut parent, mut mark, mut length) = (vec![n; n], vec![n; n], vec![1_usize; n]);
    for k in 0..n {
        mark[k] = k;
        for &column in matrix.outer_view(order[k]).expect("row of the matrix").indices() {
            let mut node = inverse[column];
            while node < k && mark[node] != k {
                parent[node] = parent[node].min(k);
                length[node] += 1;
                mark[node] = k;
                node = parent[node];
            }
        }
    }
    (length.iter().sum(), length.iter().map(|&h| (h * h) as f64).sum())
}

/// Matrix times vector.
pub fn product(matrix: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; matrix.rows()];
    matrix.iter().for_each(|(&value, (i, j))| y[i] += value * x[j]);
    y
}
