//! Functions of a seat: how the displacement of a cylinder is measured, and how tractions on it become nodal forces.
//!
//! In cylinder components (radial, tangential, axial), with the azimuth theta and zeta = 2 (z - z_0)/width,
//!
//! ```text
//! u(theta, zeta) = sum_n sum_j g (1 | cos n theta | sin n theta) P_j(zeta),     n = 0..N, j = 0..P
//! g = M^-1 sum_i w_i phi(x_i) u_i,     M = sum_i w_i phi(x_i) phi(x_i)^T,     w_i = integral of N_i dA
//! ```
//!
//! The rule of the sums are the nodes of the surface with the areas that belong to them, the one by which the program
//! takes a mean motion. With M of the same rule g are the weighted least-squares coefficients: whatever the mesh,
//! a displacement of this space is measured exactly, rigid motions (n <= 1, j <= 1) among it. A quadrature inside the
//! facets would see chords instead of the cylinder, and two meshes would disagree on a rigid turn.
//!
//! The dual of g, lam (N), is a force per function. Its nodal forces are the transpose; as a traction it is
//! t(theta, zeta) = phi^T M^-1 lam (Pa), smooth whatever the mesh.
//!
//! Order of functions: 3 (K n' + j) + component, with n' = 0, 1 (cos theta), 2 (sin theta), 3 ..., K = P + 1.
//!
//! Where 2 N nodes of a ring stand evenly round it, sin N (theta - theta_0) is zero at all of them, theta_0 being the
//! azimuth of one. Of the order N there is only cos N (theta - theta_0) then. With P + 1 rows of nodes the functions
//! are all motions of the nodes.

use dense::DenseCholesky;

use crate::error::{SurroundingError, mesh_advice};
use crate::rows::SeatRows;

/// Largest condition number of M: below 10 for even meshes that resolve the functions; 1e6 where they cannot be told
/// apart.
const WORST_CONDITION: f64 = 1e6;
/// Radii of nodes of a cylinder may differ by this share: chords of coarse quadratic tetrahedra.
const ROUNDNESS: f64 = 1e-3;
/// Largest sine of an order at a node that is zero: one that is not makes M that much worse, to the square.
const NO_SINE: f64 = 1e-3;

/// Which functions tie a seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeatBasis {
    /// Fourier x Legendre.
    Harmonics {
        /// Largest n.
        harmonics: usize,
        /// Largest degree j.
        across: usize,
    },
    /// The same, but of the order `harmonics` only the cosine through a node of the ring.
    HalfRound {
        /// Largest n, half the number of nodes round the ring.
        harmonics: usize,
        /// Largest degree j.
        across: usize,
    },
    /// The six rigid motions of the seat alone: translations x, y, z, rotations x, y, z.
    Rigid,
}

impl SeatBasis {
    /// Number of functions.
    pub fn n_functions(self) -> usize {
        match self {
            SeatBasis::Harmonics { harmonics, across } => 3 * (2 * harmonics + 1) * (across + 1),
            SeatBasis::HalfRound { harmonics, across } => 3 * (2 * harmonics) * (across + 1),
            SeatBasis::Rigid => 6,
        }
    }

    /// Largest n and largest j; None for rigid ones.
    pub fn largest(self) -> Option<[usize; 2]> {
        match self {
            SeatBasis::Harmonics { harmonics, across } | SeatBasis::HalfRound { harmonics, across } => {
                Some([harmonics, across])
            }
            SeatBasis::Rigid => None,
        }
    }

    /// Order n and degree j of a function; None for rigid ones.
    pub fn order_and_degree(self, function: usize) -> Option<[usize; 2]> {
        let [_, across] = self.largest()?;
        let scalar = function / 3;
        Some([(scalar / (across + 1)).div_ceil(2), scalar % (across + 1)])
    }
}

/// The cylinder about z on which nodes lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatCylinder {
    /// Radius, m: the median.
    pub radius: f64,
    /// Ends along z, m.
    pub ends: [f64; 2],
}

impl SeatCylinder {
    /// That of some nodes (number for messages, position); refuses nodes away from it.
    pub fn of_nodes(
        what: &str,
        nodes: impl Iterator<Item = (u64, [f64; 3])>,
    ) -> Result<SeatCylinder, SurroundingError> {
        let nodes: Vec<(u64, [f64; 3])> = nodes.collect();
        let radius_of = |x: &[f64; 3]| x[0].hypot(x[1]);
        let mut radii: Vec<f64> = nodes.iter().map(|(_, x)| radius_of(x)).collect();
        radii.sort_unstable_by(f64::total_cmp);
        let radius = radii.get(radii.len() / 2).copied().unwrap_or(0.0);
        let off = |x: &[f64; 3]| (radius_of(x) - radius).abs();
        let worst = nodes.iter().max_by(|a, b| off(&a.1).total_cmp(&off(&b.1)));
        if let Some((node, x)) = worst.filter(|(_, x)| off(x) > ROUNDNESS * radius) {
            return Err(SurroundingError::NoCylinder {
                what: what.to_string(),
                node: *node,
                radius_mm: 1e3 * radius_of(x),
                most_mm: 1e3 * radius,
                advice: mesh_advice::CYLINDER,
            });
        }
        let ends = nodes
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, x)| {
                [low.min(x[2]), high.max(x[2])]
            });
        Ok(SeatCylinder { radius, ends })
    }

    /// Width, m.
    pub fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Middle along z, m.
    pub fn middle(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }
}

/// The functions of one joint, the same on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatSpace {
    /// Which functions.
    pub basis: SeatBasis,
    /// Middle of the seat along z, m, in the coordinates of the ring.
    pub middle: f64,
    /// Half of its width, m.
    pub half_width: f64,
    /// Its radius, m: the unit of arms.
    pub radius: f64,
    /// Azimuth of a crest of the only function of the last order, rad; 0 where there are two.
    pub crest: f64,
}

impl SeatSpace {
    /// Rigid motions at a place, `[component][motion]`: translations and rotations x, y, z about the middle of the
    /// seat, whose arms are in radii.
    pub fn rigid_motions(&self, [x, y, z]: [f64; 3]) -> [[f64; 6]; 3] {
        let [x, y, z] = [x, y, z - self.middle].map(|arm| arm / self.radius);
        [
            [1.0, 0.0, 0.0, 0.0, z, -y],
            [0.0, 1.0, 0.0, -z, 0.0, x],
            [0.0, 0.0, 1.0, y, -x, 0.0],
        ]
    }

    /// Functions on the seat of a ring.
    pub fn on(cylinder: &SeatCylinder, basis: SeatBasis) -> SeatSpace {
        SeatSpace {
            basis,
            middle: cylinder.middle(),
            half_width: 0.5 * cylinder.width(),
            radius: cylinder.radius,
            crest: 0.0,
        }
    }

    /// The same on a ring whose seat has nodes at these places: of an order whose sine is zero at all of them only the
    /// cosine is left.
    pub fn on_ring(self, mut places: impl Iterator<Item = [f64; 3]>) -> SeatSpace {
        let (SeatBasis::Harmonics { harmonics, across }, Some(first)) = (self.basis, places.next()) else {
            return self;
        };
        let crest = first[1].atan2(first[0]);
        let phase = |x: [f64; 3]| harmonics as f64 * (x[1].atan2(x[0]) - crest);
        if places.any(|x| phase(x).sin().abs() > NO_SINE) {
            return self;
        }
        SeatSpace {
            basis: SeatBasis::HalfRound { harmonics, across },
            crest,
            ..self
        }
    }

    /// (1 | cos | sin)(n theta) P_j at an azimuth, rad, and a place across in half widths from the middle.
    pub fn scalars(&self, azimuth: f64, across: f64) -> Vec<f64> {
        let Some([harmonics, degree]) = self.basis.largest() else {
            return Vec::new();
        };
        let is_half = matches!(self.basis, SeatBasis::HalfRound { .. });
        let legendre = legendre(degree, across);
        let mut values = Vec::with_capacity(self.basis.n_functions() / 3);
        values.extend(&legendre);
        let both = if is_half { harmonics - 1 } else { harmonics };
        for n in 1..=both {
            let (sin, cos) = (n as f64 * azimuth).sin_cos();
            values.extend(legendre.iter().map(|p| cos * p));
            values.extend(legendre.iter().map(|p| sin * p));
        }
        if is_half {
            let cos = (harmonics as f64 * (azimuth - self.crest)).cos();
            values.extend(legendre.iter().map(|p| cos * p));
        }
        values
    }
}

/// P_0 .. P_degree.
fn legendre(degree: usize, x: f64) -> Vec<f64> {
    let mut p = vec![1.0, x];
    for k in 1..degree.max(1) {
        let k_real = k as f64;
        p.push(((2.0 * k_real + 1.0) * x * p[k] - k_real * p[k - 1]) / (k_real + 1.0));
    }
    p.truncate(degree + 1);
    p
}

/// One side of a joint: functionals of its nodal displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatFunctions {
    /// The functions.
    pub space: SeatSpace,
    /// Nodes of the seat, ascending.
    pub nodes: Vec<usize>,
    /// Functionals over x, y, z of the nodes.
    rows: SeatRows,
    /// M^-1 of a component, m^-2, `[n][n]` flat; of rigid functions empty.
    inverse: Vec<f64>,
}

impl SeatFunctions {
    /// M times coefficients, m^2 of them: products with others are integrals over the seat. Of rigid functions the
    /// coefficients themselves.
    pub fn integrals(&self, coefficients: &[f64]) -> Vec<f64> {
        let n = coefficients.len() / 3;
        if self.inverse.is_empty() {
            return coefficients.to_vec();
        }
        let factor = DenseCholesky::factor(n, &self.inverse);
        let factor = factor.expect("M can be inverted, and so can its inverse");
        let mut sums = vec![0.0; coefficients.len()];
        for c in 0..3 {
            let mut own: Vec<f64> = coefficients.iter().skip(c).step_by(3).copied().collect();
            factor.solve(&mut own, 1);
            sums.iter_mut()
                .skip(c)
                .step_by(3)
                .zip(own)
                .for_each(|(sum, x)| *sum = x);
        }
        sums
    }

    /// Functionals of nodes with areas (m^2), which stand at `place(node)`, m, in the coordinates of the ring. `what`
    /// is for messages.
    pub fn new(
        what: &str,
        space: SeatSpace,
        areas: &[(usize, f64)],
        place: impl Fn(usize) -> [f64; 3],
    ) -> Result<SeatFunctions, SurroundingError> {
        let nodes: Vec<usize> = areas.iter().map(|a| a.0).collect();
        let n_scalars = match space.basis {
            SeatBasis::Harmonics { .. } | SeatBasis::HalfRound { .. } => space.basis.n_functions() / 3,
            SeatBasis::Rigid => 6,
        };
        let too_few = || SurroundingError::TooFewNodes {
            what: what.to_string(),
            nodes: nodes.len(),
            functions: n_scalars,
            advice: mesh_advice::NODES,
        };
        let places: Vec<[f64; 3]> = nodes.iter().map(|&node| place(node)).collect();
        let weights: Vec<f64> = areas.iter().map(|a| a.1).collect();
        let (rows, inverse) = match space.basis {
            SeatBasis::Harmonics { .. } | SeatBasis::HalfRound { .. } => {
                harmonic_rows(&space, &places, &weights)
            }
            SeatBasis::Rigid => rigid_rows(&space, &places, &weights)
                .map(|rows| (SeatRows::whole(places.len(), rows), Vec::new())),
        }
        .ok_or_else(too_few)?;
        Ok(SeatFunctions {
            space,
            nodes,
            rows,
            inverse,
        })
    }

    /// The six rigid motions of a seat that moves with a node, whose rows are its displacement and then its rotation.
    /// `nodes` are the numbers of these two threes of rows, `arm` leads from the node to the middle of the seat, m.
    pub(crate) fn of_reference(space: SeatSpace, nodes: [usize; 2], arm: [f64; 3]) -> SeatFunctions {
        let [x, y, z] = arm;
        // Rows over u and theta: u + theta x arm, and theta.
        let turned = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
        let mut rows = vec![0.0; 36];
        for i in 0..3 {
            rows[6 * i + i] = 1.0;
            rows[6 * i + 3..6 * i + 6].copy_from_slice(&turned[i]);
            rows[6 * (3 + i) + 3 + i] = 1.0;
        }
        SeatFunctions {
            space,
            nodes: nodes.to_vec(),
            rows: SeatRows::whole(2, rows),
            inverse: Vec::new(),
        }
    }

    /// Number of functions.
    pub fn n(&self) -> usize {
        self.space.basis.n_functions()
    }

    /// Takes displacements of a body in whose frame the ring stands turned by 180 deg about x.
    pub(crate) fn half_turn(&mut self) {
        self.rows.half_turn();
    }

    /// Bytes of the functionals.
    pub fn bytes(&self) -> usize {
        self.rows.bytes() + size_of::<f64>() * self.inverse.len()
    }

    /// Coefficients g of a displacement, m, `[3 n_nodes of the mesh]`: m.
    pub fn measure(&self, displacement: &[f64]) -> Vec<f64> {
        let here: Vec<f64> = self
            .nodes
            .iter()
            .flat_map(|&node| &displacement[3 * node..3 * node + 3])
            .copied()
            .collect();
        self.rows.measure(&here)
    }

    /// The functionals over x, y, z of the nodes.
    pub fn rows(&self) -> &SeatRows {
        &self.rows
    }

    /// Each functional as its entries that are not zero: dof and value.
    pub fn sparse_rows(&self) -> Vec<Vec<(usize, f64)>> {
        let dofs = || {
            self.nodes
                .iter()
                .flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2])
        };
        let row = |function: usize| {
            dofs()
                .zip(self.rows.row(function))
                .filter(|entry| entry.1 != 0.0)
                .collect()
        };
        (0..self.n()).map(row).collect()
    }

    /// Adds the nodal forces of lam, N, to a load, N, `[3 n_nodes of the mesh]`.
    pub fn add_load(&self, lam: &[f64], load: &mut [f64]) {
        let mut here = vec![0.0; 3 * self.nodes.len()];
        self.rows.add_loads(lam, &mut here);
        for (&node, f) in self.nodes.iter().zip(here.as_chunks::<3>().0) {
            (0..3).for_each(|c| load[3 * node + c] += f[c]);
        }
    }

    /// The same of one function.
    pub fn add_unit_load(&self, function: usize, force: f64, load: &mut [f64]) {
        let row = self.rows.row(function);
        for (&node, row) in self.nodes.iter().zip(row.chunks_exact(3)) {
            (0..3).for_each(|c| load[3 * node + c] += force * row[c]);
        }
    }

    /// Coefficients of the traction of lam (N), Pa, in the order of the functions; empty for rigid functions.
    pub fn traction(&self, lam: &[f64]) -> Vec<f64> {
        if self.inverse.is_empty() {
            return Vec::new();
        }
        let n = self.n() / 3;
        let coefficient = |function: usize| {
            let row = &self.inverse[n * (function / 3)..n * (function / 3 + 1)];
            let own = lam.iter().skip(function % 3).step_by(3);
            row.iter().zip(own).map(|(a, b)| a * b).sum()
        };
        (0..3 * n).map(coefficient).collect()
    }
}

/// Functionals and M^-1, if M can be inverted.
fn harmonic_rows(space: &SeatSpace, places: &[[f64; 3]], weights: &[f64]) -> Option<(SeatRows, Vec<f64>)> {
    let n = space.basis.n_functions() / 3;
    let values: Vec<f64> = places
        .iter()
        .flat_map(|x| space.scalars(x[1].atan2(x[0]), (x[2] - space.middle) / space.half_width))
        .collect();
    let inverse = inverse_gram(n, values.chunks_exact(n).zip(weights.iter().copied()))?;
    let mut factors = vec![0.0; n * places.len()];
    let mut directions = Vec::with_capacity(places.len());
    for (i, ((x, phi), w)) in places.iter().zip(values.chunks_exact(n)).zip(weights).enumerate() {
        let r = x[0].hypot(x[1]);
        let (cos, sin) = (x[0] / r, x[1] / r);
        directions.push([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]);
        for k in 0..n {
            let row = &inverse[n * k..n * (k + 1)];
            factors[places.len() * k + i] = w * row.iter().zip(phi).map(|(a, b)| a * b).sum::<f64>();
        }
    }
    Some((SeatRows::cylinder(factors, directions), inverse))
}

/// Functionals of the rigid motion in the least-squares sense about the middle of the seat; rotations in rad.
fn rigid_rows(space: &SeatSpace, places: &[[f64; 3]], weights: &[f64]) -> Option<Vec<f64>> {
    let modes: Vec<[f64; 6]> = places.iter().flat_map(|&x| space.rigid_motions(x)).collect();
    let spread = weights.iter().flat_map(|&w| [w; 3]);
    let inverse = inverse_gram(6, modes.iter().map(|m| m.as_slice()).zip(spread.clone()))?;
    let mut rows = Vec::with_capacity(6 * modes.len());
    for k in 0..6 {
        let unit = if k < 3 { 1.0 } else { 1.0 / space.radius };
        for (mode, w) in modes.iter().zip(spread.clone()) {
            rows.push(unit * w * (0..6).map(|l| inverse[6 * k + l] * mode[l]).sum::<f64>());
        }
    }
    Some(rows)
}

/// Inverse of the sum of w v v^T; None where it is singular or nearly so.
fn inverse_gram<'a>(n: usize, rows: impl Iterator<Item = (&'a [f64], f64)>) -> Option<Vec<f64>> {
    let mut gram = vec![0.0; n * n];
    for (v, w) in rows {
        for i in 0..n {
            let wi = w * v[i];
            (0..n).for_each(|j| gram[n * i + j] += wi * v[j]);
        }
    }
    let inverse = DenseCholesky::factor(n, &gram).ok()?.inverse();
    let size = |a: &[f64]| {
        a.chunks_exact(n)
            .map(|row| row.iter().map(|x| x.abs()).sum::<f64>())
            .fold(0.0, f64::max)
    };
    let condition = size(&gram) * size(&inverse);
    (condition.is_finite() && condition < WORST_CONDITION).then_some(inverse)
}
