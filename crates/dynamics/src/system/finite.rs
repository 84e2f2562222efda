//! Lengths between a point in a meridian plane and a circle that a body carries, under finite rotation.
//!
//! A body displaced by d and rotated by R about its origin o carries a circle about its axis, of radius rho, with its
//! centre in o. A point at (r, z) in the meridian plane of the azimuth psi is seen from the body at
//!
//! ```text
//! b = R^T p,   p = (r cos psi, r sin psi, z) - d
//! lengths      hypot(b_x, b_y) - rho,  b_z          from the circle to the point, in the body's meridian plane
//! ```
//!
//! R = exp [phi] with the rotation vector phi = (tilt x, tilt y, 0) (Rodrigues). The linear lengths, r - rho - d_r and
//! z - d_z + rho phi_psi, are terms of the link; what is missing in them is evaluated here without cancellation, by its
//! components along e_r, e_psi and z:
//!
//! ```text
//! b = p - s phi x p + c phi x (phi x p),   s = sin(t)/t,  c = (1 - cos t)/t^2,  t = |phi|
//! ```
//!
//! Forces F on the lengths act on d by -(R n) F, on the point by its components of it, and on phi by J (n x b) F, with
//! the gradient n of a length over b and the left Jacobian J = I + c [phi] + e [phi]^2, e = (t - sin t)/t^3 (e.g.
//! Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2, section 10.6): moments in the deformed state.

use super::lumped::Body;

/// Coordinates that the lengths depend on: five of the body, two of the point.
pub const N_FINITE: usize = 7;

/// Growth of both lengths with each of these coordinates.
pub type FiniteRows = [[f64; 2]; N_FINITE];

/// Growth of the forces on each coordinate with each, N/m and N m, symmetric.
pub type Curvature = [[f64; N_FINITE]; N_FINITE];

/// Gauss points of a mean over an interval; exact for slopes that are cubic in it.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Step of a difference quotient of slopes, over the radius.
const DIFFERENCE: f64 = 1e-6;
/// t^2 below which the functions of the angle are taken by their series.
const SMALL: f64 = 0.25;

/// A circle that a lumped body carries and a point that another one places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedCircle {
    /// Number of the body with the coordinates x, y, z, tilt x, tilt y.
    pub carrier: usize,
    /// Number of the body with the coordinates radial, axial.
    pub point: usize,
    /// Where both are when all coordinates are zero.
    pub circle: Circle,
}

/// A circle and a point in the meridian plane of an azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Cosine and sine of the azimuth.
    pub azimuth: [f64; 2],
    /// Radius of the circle, m.
    pub radius: f64,
    /// From circle to point [radial, axial] when all coordinates are zero, m.
    pub reach: [f64; 2],
}

/// The point as the body sees it, by components [e_r, e_psi, z] of its azimuth.
struct Seen {
    /// Rotation vector [e_r, e_psi], rad.
    tilt: [f64; 2],
    /// c and e.
    functions: [f64; 2],
    /// p less the radius along e_r, m.
    near: [f64; 3],
    /// b - p, m.
    turned: [f64; 3],
    /// b, m.
    place: [f64; 3],
}

/// A circle and a point at given coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteMotion {
    /// Both when all coordinates are zero.
    pub circle: Circle,
    /// The coordinates: x, y, z, tilt x, tilt y of the circle, radial, axial of the point, m and rad.
    pub at: [f64; N_FINITE],
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
    /// The coordinates, in the order of their rows.
    pub fn coordinates(&self) -> [(Body, usize); N_FINITE] {
        let of = |k: usize| match k {
            0..5 => (Body::Lumped(self.carrier), k),
            _ => (Body::Lumped(self.point), k - 5),
        };
        [0, 1, 2, 3, 4, 5, 6].map(of)
    }
}

impl Circle {
    /// What the lengths have beyond their linear terms at the coordinates `q`, m.
    pub fn lengths(&self, q: [f64; N_FINITE]) -> [f64; 2] {
        let Seen {
            tilt: [tr, tp],
            functions: [c, e],
            near,
            turned,
            place: [a, t, _],
        } = self.seen(q);
        let square = tr * tr + tp * tp;
        let radial = turned[0] + t * t / (a.hypot(t) + a);
        let s = 1.0 - square * e;
        // s p_r - rho without the difference of two radii.
        let lever = near[0] - square * e * (self.radius + near[0]);
        [radial, tp * lever - s * tr * near[1] - c * square * near[2]]
    }

    /// Growth of both with the coordinates.
    pub fn rows(&self, q: [f64; N_FINITE]) -> FiniteRows {
        let seen = self.seen(q);
        let [a, t, b] = seen.place;
        let distance = a.hypot(t);
        let (n, m) = (a / distance, t / distance);
        // Gradients over b, and their vector products with it.
        let radial = self.along(seen.in_space([n, m, 0.0]), seen.on_tilt([m * b, -n * b]));
        let axial = self.along(seen.in_space([0.0, 0.0, 1.0]), seen.on_tilt([-t, a]));
        let linear = self.linear_rows();
        std::array::from_fn(|k| [radial[k] - linear[k][0], axial[k] - linear[k][1]])
    }

    /// Mean growth between two instants, with which rows times changes are the change of the lengths.
    pub fn mean_rows(&self, start: [f64; N_FINITE], end: [f64; N_FINITE]) -> FiniteRows {
        let between = |share: f64| self.rows(std::array::from_fn(|k| start[k] + share * (end[k] - start[k])));
        let [first, second] = GAUSS.map(between);
        std::array::from_fn(|k| [0, 1].map(|i| 0.5 * (first[k][i] + second[k][i])))
    }

    /// Growth of the forces on the coordinates with the coordinates when `force` acts on the lengths: symmetric.
    pub fn curvature(&self, q: [f64; N_FINITE], force: [f64; 2]) -> Curvature {
        let step = |k: usize| {
            if (3..5).contains(&k) {
                DIFFERENCE
            } else {
                DIFFERENCE * self.radius
            }
        };
        let column = |k: usize| {
            let at = |sign: f64| {
                let mut moved = q;
                moved[k] += sign * step(k);
                self.rows(moved)
            };
            let (low, high) = (at(-1.0), at(1.0));
            let slope = |i: usize| {
                let change = [0, 1].map(|row| high[i][row] - low[i][row]);
                (change[0] * force[0] + change[1] * force[1]) / (2.0 * step(k))
            };
            std::array::from_fn::<f64, N_FINITE, _>(slope)
        };
        let columns: Curvature = std::array::from_fn(column);
        std::array::from_fn(|i| std::array::from_fn(|k| 0.5 * (columns[k][i] + columns[i][k])))
    }

    fn linear_rows(&self) -> FiniteRows {
        let [cos, sin] = self.azimuth;
        [
            [-cos, 0.0],
            [-sin, 0.0],
            [0.0, -1.0],
            [0.0, -self.radius * sin],
            [0.0, self.radius * cos],
            [1.0, 0.0],
            [0.0, 1.0],
        ]
    }

    fn seen(&self, q: [f64; N_FINITE]) -> Seen {
        let [cos, sin] = self.azimuth;
        let along = |x: f64, y: f64| [x * cos + y * sin, y * cos - x * sin];
        let (d, [tr, tp]) = (along(q[0], q[1]), along(q[3], q[4]));
        let functions = angle_functions(tr * tr + tp * tp);
        let [c, e] = functions;
        let near = [self.reach[0] + q[5] - d[0], -d[1], self.reach[1] + q[6] - q[2]];
        let p = [self.radius + near[0], near[1], near[2]];
        let s = 1.0 - (tr * tr + tp * tp) * e;
        let turned = [
            -s * tp * p[2] + c * tp * (tr * p[1] - tp * p[0]),
            s * tr * p[2] + c * tr * (tp * p[0] - tr * p[1]),
            s * (tp * p[0] - tr * p[1]) - c * (tr * tr + tp * tp) * p[2],
        ];
        Seen {
            tilt: [tr, tp],
            functions,
            near,
            turned,
            place: [0, 1, 2].map(|i| p[i] + turned[i]),
        }
    }

    /// Rows of a length with this gradient over p and this one over the rotation vector, by components of the azimuth.
    fn along(&self, v: [f64; 3], tilt: [f64; 2]) -> [f64; N_FINITE] {
        let [cos, sin] = self.azimuth;
        let space = |a: f64, b: f64| [a * cos - b * sin, a * sin + b * cos];
        let (d, t) = (space(v[0], v[1]), space(tilt[0], tilt[1]));
        [-d[0], -d[1], -v[2], t[0], t[1], v[0], v[2]]
    }
}

impl Seen {
    /// R v.
    fn in_space(&self, v: [f64; 3]) -> [f64; 3] {
        let ([tr, tp], [c, e]) = (self.tilt, self.functions);
        let s = 1.0 - (tr * tr + tp * tp) * e;
        let once = [tp * v[2], -tr * v[2], tr * v[1] - tp * v[0]];
        let twice = [tp * once[2], -tr * once[2], tr * once[1] - tp * once[0]];
        [0, 1, 2].map(|i| v[i] + s * once[i] + c * twice[i])
    }

    /// J (v, 0), without its part along z.
    fn on_tilt(&self, v: [f64; 2]) -> [f64; 2] {
        let ([tr, tp], [_, e]) = (self.tilt, self.functions);
        let across = tr * v[1] - tp * v[0];
        [v[0] + e * tp * across, v[1] - e * tr * across]
    }
}

/// c = (1 - cos t)/t^2 and e = (t - sin t)/t^3 of t^2.
pub fn angle_functions(square: f64) -> [f64; 2] {
    if square < SMALL {
        // 1/2! - t^2/4! + ..., 1/3! - t^2/5! + ...: the next term is below 1e-17.
        let series = |first: f64| {
            (0..7).rev().fold(0.0, |sum, k| {
                let k = 2.0 * f64::from(k) + first;
                1.0 - square / ((k + 1.0) * (k + 2.0)) * sum
            })
        };
        return [0.5 * series(2.0), series(3.0) / 6.0];
    }
    let t = square.sqrt();
    [(1.0 - t.cos()) / square, (t - t.sin()) / (square * t)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CIRCLE: Circle = Circle {
        azimuth: [0.8, 0.6],
        radius: 0.0326,
        reach: [-1.5e-4, 2.1e-4],
    };

    fn places() -> [[f64; N_FINITE]; 4] {
        [
            [1e-5, -2e-5, 3e-5, 1e-3, -4e-4, 2e-6, -1e-6],
            [1e-4, 2e-4, -3e-4, 0.03, -0.04, 5e-5, -8e-5],
            [1e-3, 2e-3, -1e-3, 0.3, 0.45, 1e-4, 1e-4],
            [0.0, 0.0, 1e-5, 0.0, 0.0, 3e-6, 4e-6],
        ]
    }

    /// R^T of a rotation vector (x, y, 0) by Rodrigues' formula, on a vector.
    fn back([x, y]: [f64; 2], p: [f64; 3]) -> [f64; 3] {
        let angle = x.hypot(y);
        if angle == 0.0 {
            return p;
        }
        let k = [-x / angle, -y / angle, 0.0];
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let (once, twice) = (cross(k, p), cross(k, cross(k, p)));
        [0, 1, 2].map(|i| p[i] + angle.sin() * once[i] + (1.0 - angle.cos()) * twice[i])
    }

    /// Whole lengths by their definition.
    fn defined(circle: &Circle, q: [f64; N_FINITE]) -> [f64; 2] {
        let [cos, sin] = circle.azimuth;
        let r = circle.radius + circle.reach[0] + q[5];
        let p = [r * cos - q[0], r * sin - q[1], circle.reach[1] + q[6] - q[2]];
        let [x, y, z] = back([q[3], q[4]], p);
        [x.hypot(y) - circle.radius, z]
    }

    fn whole(circle: &Circle, q: [f64; N_FINITE]) -> [f64; 2] {
        let (linear, more) = (circle.linear_rows(), circle.lengths(q));
        [0, 1].map(|i| circle.reach[i] + more[i] + (0..N_FINITE).map(|k| linear[k][i] * q[k]).sum::<f64>())
    }

    /// Wrong: the lengths without cancellation are not those of their definition. Round-off of the radius.
    #[test]
    fn lengths_are_those_of_the_rotated_body() {
        for q in places() {
            let (found, exact) = (whole(&CIRCLE, q), defined(&CIRCLE, q));
            (0..2).for_each(|i| assert!((found[i] - exact[i]).abs() < 2e-17, "{q:?}: {found:?} {exact:?}"));
        }
    }

    /// Wrong: forces would act in another direction or at another lever than lengths grow. Difference quotients.
    #[test]
    fn rows_are_slopes_and_curvature_is_theirs() {
        for q in places() {
            let (rows, linear) = (CIRCLE.rows(q), CIRCLE.linear_rows());
            let force = [-300.0, 90.0];
            let curvature = CIRCLE.curvature(q, force);
            for k in 0..N_FINITE {
                let h = if (3..5).contains(&k) { 1e-5 } else { 1e-7 };
                let (mut low, mut high) = (q, q);
                (low[k], high[k]) = (low[k] - h, high[k] + h);
                let (a, b) = (defined(&CIRCLE, low), defined(&CIRCLE, high));
                let size = if (3..5).contains(&k) { CIRCLE.radius } else { 1.0 };
                for i in 0..2 {
                    let slope = (b[i] - a[i]) / (2.0 * h);
                    let found = rows[k][i] + linear[k][i];
                    assert!(
                        (slope - found).abs() < 2e-9 * size,
                        "{q:?} {k} {i}: {slope} {found}"
                    );
                }
                let (a, b) = (CIRCLE.rows(low), CIRCLE.rows(high));
                for i in 0..N_FINITE {
                    let change = [0, 1].map(|l| (b[i][l] - a[i][l]) / (2.0 * h) * force[l]);
                    let (slope, found) = (change[0] + change[1], curvature[i][k]);
                    assert!(
                        (slope - found).abs() < 1e-5 * (1.0 + slope.abs()),
                        "{q:?} {i} {k}: {slope} {found}"
                    );
                }
            }
        }
    }

    /// Wrong: contacts would make or lose energy over a step, because forces act through other slopes than lengths
    /// change. Steps far larger than any of a motion.
    #[test]
    fn mean_rows_give_the_change_of_the_lengths() {
        let start = places()[1];
        let change = [2e-6, -1e-6, 1e-6, 1e-4, -2e-4, 1e-6, 2e-6];
        let end: [f64; N_FINITE] = std::array::from_fn(|k| start[k] + change[k]);
        let rows = CIRCLE.mean_rows(start, end);
        let (before, after) = (CIRCLE.lengths(start), CIRCLE.lengths(end));
        for i in 0..2 {
            let grown: f64 = (0..N_FINITE).map(|k| rows[k][i] * change[k]).sum();
            assert!(
                (grown - (after[i] - before[i])).abs() < 1e-13 * grown.abs(),
                "{grown}"
            );
        }
    }

    /// Wrong: a contact would feel where it stands round the bearing. Everything turned about the axis.
    #[test]
    fn turning_everything_about_the_axis_changes_nothing() {
        for q in places() {
            let (sin, cos) = 1.1f64.sin_cos();
            let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
            let circle = Circle {
                azimuth: turn(CIRCLE.azimuth),
                ..CIRCLE
            };
            let ([x, y], [tilt_x, tilt_y]) = (turn([q[0], q[1]]), turn([q[3], q[4]]));
            let turned = circle.lengths([x, y, q[2], tilt_x, tilt_y, q[5], q[6]]);
            let found = CIRCLE.lengths(q);
            (0..2).for_each(|i| assert!((turned[i] - found[i]).abs() < 1e-14 * (found[i].abs() + 1e-5)));
        }
    }

    /// Wrong: the functions of the angle jump where their series ends.
    #[test]
    fn series_and_closed_forms_meet() {
        let (below, above) = (angle_functions(SMALL * (1.0 - 1e-15)), angle_functions(SMALL));
        (0..2).for_each(|i| assert!((below[i] - above[i]).abs() < 2e-15, "{below:?} {above:?}"));
        assert_eq!(angle_functions(0.0), [0.5, 1.0 / 6.0]);
    }
}
