//! Functionals of a seat as numbers: of each function a factor per node and component, and the directions of these.
//!
//! Functions of one order and degree differ by their component alone, so a row over x, y, z of the nodes is a factor of
//! the node times a direction there. Kept apart these take a ninth of the numbers, and one pass measures three
//! components.

/// Sums that run side by side, in an order that no compiler may choose.
const LANES: usize = 8;

/// Functionals over x, y, z of some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatRows {
    n_nodes: usize,
    kind: RowForm,
}

#[derive(Clone, Debug, PartialEq)]
enum RowForm {
    /// `[n][3 n_nodes]` flat.
    Whole(Vec<f64>),
    /// Three functions for each row of factors, `[n / 3][n_nodes]` flat, and the directions of the three at each node.
    Cylinder {
        factors: Vec<f64>,
        directions: Vec<[[f64; 3]; 3]>,
    },
}

impl SeatRows {
    /// Rows `[n][3 n_nodes]` flat.
    pub(crate) fn whole(n_nodes: usize, rows: Vec<f64>) -> SeatRows {
        SeatRows {
            n_nodes,
            kind: RowForm::Whole(rows),
        }
    }

    /// Three functions for each row of `factors`, `[n / 3][n_nodes]` flat, with the directions at each node.
    pub(crate) fn cylinder(factors: Vec<f64>, directions: Vec<[[f64; 3]; 3]>) -> SeatRows {
        SeatRows {
            n_nodes: directions.len(),
            kind: RowForm::Cylinder { factors, directions },
        }
    }

    /// Number of functions.
    pub fn n(&self) -> usize {
        match &self.kind {
            RowForm::Whole(rows) => rows.len() / (3 * self.n_nodes).max(1),
            RowForm::Cylinder { factors, .. } => 3 * (factors.len() / self.n_nodes.max(1)),
        }
    }

    /// Bytes.
    pub fn bytes(&self) -> usize {
        size_of::<f64>()
            * match &self.kind {
                RowForm::Whole(rows) => rows.len(),
                RowForm::Cylinder { factors, directions } => factors.len() + 9 * directions.len(),
            }
    }

    /// Takes vectors of a frame that is turned by 180 deg about x.
    pub(crate) fn half_turn(&mut self) {
        let turn = |v: &mut [f64; 3]| (v[1], v[2]) = (-v[1], -v[2]);
        match &mut self.kind {
            RowForm::Whole(rows) => rows.as_chunks_mut::<3>().0.iter_mut().for_each(turn),
            RowForm::Cylinder { directions, .. } => directions.as_flattened_mut().iter_mut().for_each(turn),
        }
    }

    /// Values of all functionals from vectors at the nodes, `[n_nodes][3]` flat.
    pub fn measure(&self, here: &[f64]) -> Vec<f64> {
        match &self.kind {
            RowForm::Whole(rows) => {
                let row = |row: &[f64]| row.iter().zip(here).map(|(a, b)| a * b).sum();
                rows.chunks_exact((3 * self.n_nodes).max(1)).map(row).collect()
            }
            RowForm::Cylinder { factors, directions } => {
                let mut parts = [const { Vec::new() }; 3];
                for (e, u) in directions.iter().zip(here.as_chunks::<3>().0) {
                    for (part, e) in parts.iter_mut().zip(e) {
                        part.push(e[0] * u[0] + e[1] * u[1] + e[2] * u[2]);
                    }
                }
                let rows = factors.chunks_exact(self.n_nodes.max(1));
                rows.flat_map(|row| parts.each_ref().map(|part| lane_dot(row, part)))
                    .collect()
            }
        }
    }

    /// Adds what forces on all functions do to the nodes, `[n_nodes][3]` flat.
    pub fn add_loads(&self, forces: &[f64], here: &mut [f64]) {
        match &self.kind {
            RowForm::Whole(rows) => {
                for (row, force) in rows.chunks_exact((3 * self.n_nodes).max(1)).zip(forces) {
                    here.iter_mut().zip(row).for_each(|(load, w)| *load += force * w);
                }
            }
            RowForm::Cylinder { factors, directions } => {
                let mut parts = [const { Vec::new() }; 3].map(|mut part: Vec<f64>| {
                    part.resize(self.n_nodes, 0.0);
                    part
                });
                let rows = factors.chunks_exact(self.n_nodes.max(1));
                for (row, force) in rows.zip(forces.as_chunks::<3>().0) {
                    for (part, force) in parts.iter_mut().zip(force) {
                        part.iter_mut().zip(row).for_each(|(p, w)| *p += force * w);
                    }
                }
                for (node, (load, e)) in here.as_chunks_mut::<3>().0.iter_mut().zip(directions).enumerate() {
                    for (part, e) in parts.iter().zip(e) {
                        (0..3).for_each(|d| load[d] += part[node] * e[d]);
                    }
                }
            }
        }
    }

    /// One functional, `[n_nodes][3]` flat.
    pub fn row(&self, function: usize) -> Vec<f64> {
        match &self.kind {
            RowForm::Whole(rows) => {
                rows[3 * self.n_nodes * function..3 * self.n_nodes * (function + 1)].to_vec()
            }
            RowForm::Cylinder { factors, directions } => {
                let row = &factors[self.n_nodes * (function / 3)..self.n_nodes * (function / 3 + 1)];
                let nodes = row.iter().zip(directions);
                nodes.flat_map(|(w, e)| e[function % 3].map(|e| w * e)).collect()
            }
        }
    }
}

/// Adds factors times rows of the length of the sum, four in a pass over it.
pub(crate) fn add_rows<'a>(sum: &mut [f64], row: impl Fn(usize) -> &'a [f64], factors: &[f64]) {
    let n = sum.len();
    let (fours, rest) = factors.as_chunks::<4>();
    for (i, f) in fours.iter().enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| &row(4 * i + k)[..n]);
        for (k, s) in sum.iter_mut().enumerate() {
            *s += (f[0] * a[k] + f[1] * b[k]) + (f[2] * c[k] + f[3] * d[k]);
        }
    }
    for (i, factor) in rest.iter().enumerate() {
        let row = row(4 * fours.len() + i);
        sum.iter_mut().zip(row).for_each(|(s, r)| *s += factor * r);
    }
}

/// Scalar product, in lanes.
pub fn lane_dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (whole, rest) = a.as_chunks::<LANES>();
    let (others, rest_of_others) = b.as_chunks::<LANES>();
    for (a, b) in whole.iter().zip(others) {
        (0..LANES).for_each(|i| lanes[i] += a[i] * b[i]);
    }
    let rest: f64 = rest.iter().zip(rest_of_others).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f64>() + rest
}
