//! The finite motion of a circle that a body carries, as links in planes through the axis see it.
//!
//! A body displaced by d and rotated by R about its origin carries a circle of radius rho about its axis. A link at the
//! azimuth psi sees the point in which the moved circle meets its half-plane. That point stands at the azimuth psi +
//! delta of the body, and of its place links take the components along e_r and z. With the rotation vector phi = (tilt
//! x, tilt y, 0), its parts p and q along e_r and e_psi, t = |phi|, s = sin(t)/t and c = (1 - cos t)/t^2 (Rodrigues):
//!
//! ```text
//! place . e_psi = 0:   d_psi + rho c p q cos(delta) + rho (1 - c p^2) sin(delta) = 0
//! place . e_r - rho = d_r - rho [1 - (1 - c q^2) cos(delta) - c p q sin(delta)]
//! place . z         = d_z - rho s q cos(delta) + rho s p sin(delta)
//! ```
//!
//! The part linear in d and phi, (d_r, d_z - rho q), is in the terms of a link; the rest, taken from its lengths, is
//! here. To second order it is d_psi^2/(2 rho) + rho q^2/2 and d_psi p. Of a circle that is projected, links see the
//! point at their own azimuth of the body: delta = 0. Forces act on d and phi through its slopes: with their part
//! across the plane, and moments with the levers of the moved body. The section of a torus about the moved circle is a
//! circle about that point to second order: its distance from a point at l in the plane is |l| (1 - g^2/2), with the
//! slope g of the moved circle along l, a tilt at most.

use super::lumped::BodyId;

/// Coordinates that the lengths depend on: displacements across the axis, then both tilts.
pub const N_FINITE: usize = 4;

/// Values of the coordinates, m and rad.
pub type FiniteCoordinates = [f64; N_FINITE];

/// Growth of the first two lengths with each of these coordinates.
pub type FiniteRows = [[f64; 2]; N_FINITE];

/// Growth of the forces on each coordinate with each, symmetric: N/m, N/rad and N m.
pub type Curvature = [[f64; N_FINITE]; N_FINITE];

/// Gauss points of a mean over an interval; exact for slopes that are cubic in it.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Step of a difference quotient of slopes, rad, and of a displacement over the radius.
const DIFFERENCE: f64 = 1e-6;
/// t^2 below which the functions of the angle are taken by their series.
const SMALL: f64 = 0.25;
/// Displacement over the radius beyond which a circle goes on straight; far beyond that of any bearing.
const FAR: f64 = 0.5;

/// A circle that a lumped body with the coordinates x, y, z, tilt x, tilt y carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedCircle {
    /// Number of the body.
    pub carrier: usize,
    /// The circle.
    pub circle: Circle,
    /// Lengths of the link that have its motion.
    pub lengths: CircleLengths,
}

/// Which lengths of a link have the motion of a circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CircleLengths {
    /// The first two: from the circle.
    FromCircle,
    /// This one and the next: how far the circle moves, which grows against the first.
    OfCircle(usize),
}

/// A circle at an azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Cosine and sine of the azimuth.
    pub azimuth: [f64; 2],
    /// Radius, m.
    pub radius: f64,
    /// Whether links see its point at their azimuth, projected onto their half-plane, and not where it meets that.
    pub is_projected: bool,
}

/// A circle and the motion of what carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteMotion {
    /// The circle.
    pub circle: Circle,
    /// The coordinates.
    pub at: FiniteCoordinates,
}

impl FiniteMotion {
    /// [`Circle::lengths`].
    pub fn lengths(&self) -> [f64; 2] {
        self.circle.lengths(self.at)
    }

    /// [`Circle::rows`].
    pub fn rows(&self) -> FiniteRows {
        self.circle.rows(self.at)
    }
}

impl CarriedCircle {
    /// Numbers of the coordinates among those of the body.
    pub const COORDINATES: [usize; N_FINITE] = [0, 1, 3, 4];

    /// The first of the lengths, and how they grow with those from the circle.
    pub(super) fn place(&self) -> (usize, f64) {
        match self.lengths {
            CircleLengths::FromCircle => (0, 1.0),
            CircleLengths::OfCircle(first) => (first, -1.0),
        }
    }

    /// The coordinates of a body, of whose five these are four.
    pub fn of(body: &[f64; 5]) -> FiniteCoordinates {
        CarriedCircle::COORDINATES.map(|k| body[k])
    }

    /// The coordinates, in the order of their rows.
    pub fn coordinates(&self) -> [(BodyId, usize); N_FINITE] {
        CarriedCircle::COORDINATES.map(|k| (BodyId::Lumped(self.carrier), k))
    }
}

/// Motions that matter: along e_psi, and the tilts about e_r and e_psi.
type Local = [f64; 3];

/// The point in which a moved circle meets a half-plane.
struct Crossing {
    radius: f64,
    /// Tilts about e_r and e_psi.
    tilt: [f64; 2],
    /// t^2, then c, e = (t - sin t)/t^3 and s.
    square: f64,
    c: f64,
    e: f64,
    s: f64,
    /// rho c p q and rho (1 - c p^2).
    across: [f64; 2],
    /// Cosine and sine of delta.
    turned: [f64; 2],
    /// Growth of the place along e_psi with delta, m; infinite where delta is 0 by definition.
    per_angle: f64,
    /// Whether the displacement is too large for a circle.
    is_far: bool,
}

impl Crossing {
    fn new(circle: &Circle, [along, p, q]: Local) -> Crossing {
        let radius = circle.radius;
        let square = p * p + q * q;
        let [c, e] = angle_functions(square);
        let across = [radius * c * p * q, radius * (1.0 - c * p * p)];
        let [a, b] = across;
        let whole = (a * a + b * b).max(f64::MIN_POSITIVE);
        let far = FAR * whole.sqrt();
        let d = along.clamp(-far, far);
        let root = (whole - d * d).sqrt();
        let (turned, per_angle) = match circle.is_projected {
            true => ([1.0, 0.0], f64::INFINITY),
            false => ([(b * root - a * d) / whole, -(a * root + b * d) / whole], root),
        };
        Crossing {
            radius,
            tilt: [p, q],
            square,
            c,
            e,
            s: 1.0 - square * e,
            across,
            turned,
            per_angle,
            is_far: d != along,
        }
    }

    /// 1 - cos(delta), without cancellation.
    fn versine(&self) -> f64 {
        let [cos, sin] = self.turned;
        sin * sin / (1.0 + cos)
    }

    /// What the lengths have beyond their linear terms.
    fn lengths(&self) -> [f64; 2] {
        let ([p, q], [_, sin], versine) = (self.tilt, self.turned, self.versine());
        let bent = self.radius * self.c * q * q;
        [
            versine * (self.radius - bent) + bent - self.across[0] * sin,
            -self.radius * (q * (versine * self.s + self.square * self.e) + self.s * p * sin),
        ]
    }

    /// Growth of both with each motion.
    fn rows(&self) -> [[f64; 2]; 3] {
        let ([p, q], [cos, sin]) = (self.tilt, self.turned);
        let a = self.across[0];
        let (radius, c, s) = (self.radius, self.c, self.s);
        let slope = 2.0 * c_slope(self.square, c, self.e);
        let by_turn = [
            sin * radius * (1.0 - c * q * q) - a * cos,
            -radius * s * (q * sin + p * cos),
        ];
        let of_tilt = |k: usize| {
            let (of_p, of_q) = if k == 0 { (1.0, 0.0) } else { (0.0, 1.0) };
            let (of_c, of_s) = (slope * self.tilt[k], -(c - self.e) * self.tilt[k]);
            let of_a = radius * (of_c * p * q + c * (of_p * q + p * of_q));
            let of_b = -radius * (of_c * p * p + 2.0 * c * p * of_p);
            let of_bent = radius * (of_c * q * q + 2.0 * c * q * of_q);
            let turn = -(of_a * cos + of_b * sin) / self.per_angle;
            let versine = self.versine();
            let axial = q * (versine * of_s - of_s)
                + of_q * (versine * s + self.square * self.e)
                + (of_s * p + s * of_p) * sin;
            [
                of_bent * cos - of_a * sin + by_turn[0] * turn,
                -radius * axial + by_turn[1] * turn,
            ]
        };
        let along = if self.is_far { 0.0 } else { -1.0 / self.per_angle };
        [by_turn.map(|growth| growth * along), of_tilt(0), of_tilt(1)]
    }
}

impl Circle {
    /// What the lengths from the circle [radial, axial] have beyond their linear terms, m.
    pub fn lengths(&self, at: FiniteCoordinates) -> [f64; 2] {
        Crossing::new(self, self.local(at)).lengths()
    }

    /// Growth of both with the coordinates.
    pub fn rows(&self, at: FiniteCoordinates) -> FiniteRows {
        let local = Crossing::new(self, self.local(at)).rows();
        self.directions()
            .map(|motions| [0, 1].map(|i| motions.iter().map(|(of, share)| share * local[*of][i]).sum()))
    }

    /// Force that keeps the link in its half-plane, along e_psi, N, when `force` acts on the lengths: what the circle
    /// exerts across the plane.
    pub fn across(&self, at: FiniteCoordinates, force: [f64; 2]) -> f64 {
        let [along, ..] = Crossing::new(self, self.local(at)).rows();
        along[0] * force[0] + along[1] * force[1]
    }

    /// Growth of both with the azimuth of the link, m/rad, while what carries the circle stays.
    pub fn along(&self, at: FiniteCoordinates) -> [f64; 2] {
        let ([cos, sin], [x, y, ..]) = (self.azimuth, at);
        let local = self.local(at);
        let [_, p, q] = local;
        let turned = [-(x * cos + y * sin), q, -p];
        let rows = Crossing::new(self, local).rows();
        [0, 1].map(|i| rows.iter().zip(turned).map(|(row, moved)| row[i] * moved).sum())
    }

    /// Mean growth between two instants, with which rows times changes are the change of the lengths.
    pub fn mean_rows(&self, start: FiniteCoordinates, end: FiniteCoordinates) -> FiniteRows {
        let between = |share: f64| self.rows(std::array::from_fn(|k| start[k] + share * (end[k] - start[k])));
        let [first, second] = GAUSS.map(between);
        std::array::from_fn(|k| [0, 1].map(|i| 0.5 * (first[k][i] + second[k][i])))
    }

    /// Growth of the forces on the coordinates with them when `force` acts on the lengths.
    pub fn curvature(&self, at: FiniteCoordinates, force: [f64; 2]) -> Curvature {
        let local = self.local(at);
        let column = |k: usize| {
            let step = if k == 0 {
                DIFFERENCE * self.radius
            } else {
                DIFFERENCE
            };
            let at = |sign: f64| {
                let mut moved = local;
                moved[k] += sign * step;
                let rows = Crossing::new(self, moved).rows();
                rows.map(|row| row[0] * force[0] + row[1] * force[1])
            };
            let (low, high) = (at(-1.0), at(1.0));
            [0, 1, 2].map(|i| (high[i] - low[i]) / (2.0 * step))
        };
        let columns = [column(0), column(1), column(2)];
        let value = |i: usize, k: usize| 0.5 * (columns[k][i] + columns[i][k]);
        let directions = self.directions();
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let mut sum = 0.0;
                for (a, of_a) in directions[i] {
                    for (b, of_b) in directions[k] {
                        sum += of_a * value(a, b) * of_b;
                    }
                }
                sum
            })
        })
    }

    /// By coordinate: the motions that it makes, and their growth with it.
    fn directions(&self) -> [[(usize, f64); 2]; N_FINITE] {
        let [cos, sin] = self.azimuth;
        [
            [(0, -sin), (0, 0.0)],
            [(0, cos), (0, 0.0)],
            [(1, cos), (2, -sin)],
            [(1, sin), (2, cos)],
        ]
    }

    fn local(&self, [x, y, tilt_x, tilt_y]: FiniteCoordinates) -> Local {
        let [cos, sin] = self.azimuth;
        [
            y * cos - x * sin,
            tilt_x * cos + tilt_y * sin,
            tilt_y * cos - tilt_x * sin,
        ]
    }
}

/// c = (1 - cos t)/t^2 and e = (t - sin t)/t^3 of t^2.
pub fn angle_functions(square: f64) -> [f64; 2] {
    if square < SMALL {
        return [0.5 * series(2, square), series(3, square) / 6.0];
    }
    let t = square.sqrt();
    [(1.0 - t.cos()) / square, (t - t.sin()) / (square * t)]
}

/// dc/d(t^2) = (g - e)/2 with g = (1 - 2 c)/t^2.
fn c_slope(square: f64, c: f64, e: f64) -> f64 {
    let g = if square < SMALL {
        series(4, square) / 12.0
    } else {
        (1.0 - 2.0 * c) / square
    };
    0.5 * (g - e)
}

/// 1 - t^2 n!/(n + 2)! + t^4 n!/(n + 4)! - ...: the next term is below 1e-17.
fn series(n: u32, square: f64) -> f64 {
    (0..7).rev().fold(0.0, |sum, k| {
        let k = f64::from(2 * k + n);
        1.0 - square / ((k + 1.0) * (k + 2.0)) * sum
    })
}

#[cfg(test)]
pub(super) mod tests;
