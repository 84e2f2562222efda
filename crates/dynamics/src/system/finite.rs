//! The finite rotation of a circle that a body carries, as links in meridian planes see it.
//!
//! A body displaced by d and rotated by R about its origin carries a circle of radius rho about its axis. Its point at
//! the azimuth psi has moved by d + rho (R - 1) e_r, of which links take the components along e_r and z:
//!
//! ```text
//! R e_r . e_r = 1 - c t_psi^2,   R e_r . e_z = -s t_psi,    s = sin(t)/t,  c = (1 - cos t)/t^2,  t = |phi|
//! ```
//!
//! with the rotation vector phi = (tilt x, tilt y, 0) and its part t_psi along e_psi (Rodrigues). The part linear in
//! phi is in the terms of a link; the rest, c rho t_psi^2 and -(s - 1) rho t_psi taken from its lengths, is here.
//! Forces act on phi through its slopes: moments with the levers of the rotated body. What the circle's own curvature
//! gives a point that lies beside it, d_psi^2 / (2 rho), is left out with the force across the meridian plane that
//! would belong to it.

use super::lumped::BodyId;

/// Coordinates that the lengths depend on: both tilts.
pub const N_FINITE: usize = 2;

/// Growth of the first two lengths with each of these coordinates.
pub type FiniteRows = [[f64; 2]; N_FINITE];

/// Growth of the forces on each coordinate with each, N m, symmetric.
pub type Curvature = [[f64; N_FINITE]; N_FINITE];

/// Gauss points of a mean over an interval; exact for slopes that are cubic in it.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Step of a difference quotient of slopes, rad.
const DIFFERENCE: f64 = 1e-6;
/// t^2 below which the functions of the angle are taken by their series.
const SMALL: f64 = 0.25;

/// A circle that a lumped body with the coordinates x, y, z, tilt x, tilt y carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedCircle {
    /// Number of the body.
    pub carrier: usize,
    /// The circle.
    pub circle: Circle,
}

/// A circle at an azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Cosine and sine of the azimuth.
    pub azimuth: [f64; 2],
    /// Radius, m.
    pub radius: f64,
}

/// A circle and the tilts of what carries it, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteMotion {
    /// The circle.
    pub circle: Circle,
    /// The tilts.
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
    pub fn coordinates(&self) -> [(BodyId, usize); N_FINITE] {
        [3, 4].map(|k| (BodyId::Lumped(self.carrier), k))
    }
}

impl Circle {
    /// What the lengths from the circle [radial, axial] have beyond their linear terms, m.
    pub fn lengths(&self, tilt: [f64; N_FINITE]) -> [f64; 2] {
        let (across, square) = (self.across(tilt), square(tilt));
        let [c, e] = angle_functions(square);
        let lever = self.radius * across;
        [c * lever * across, -square * e * lever]
    }

    /// Growth of both with the tilts.
    pub fn rows(&self, tilt: [f64; N_FINITE]) -> FiniteRows {
        let (across, square) = (self.across(tilt), square(tilt));
        let [c, e] = angle_functions(square);
        let lever = self.radius * across;
        let [cos, sin] = self.azimuth;
        let slopes = [-sin, cos];
        [0, 1].map(|k| {
            let growth = 2.0 * c_slope(square, c, e) * lever * across * tilt[k];
            [
                2.0 * c * lever * slopes[k] + growth,
                -self.radius * square * e * slopes[k] - (c - e) * lever * tilt[k],
            ]
        })
    }

    /// Mean growth between two instants, with which rows times changes are the change of the lengths.
    pub fn mean_rows(&self, start: [f64; N_FINITE], end: [f64; N_FINITE]) -> FiniteRows {
        let between = |share: f64| self.rows([0, 1].map(|k| start[k] + share * (end[k] - start[k])));
        let [first, second] = GAUSS.map(between);
        [0, 1].map(|k| [0, 1].map(|i| 0.5 * (first[k][i] + second[k][i])))
    }

    /// Growth of the forces on the tilts with the tilts when `force` acts on the lengths.
    pub fn curvature(&self, tilt: [f64; N_FINITE], force: [f64; 2]) -> Curvature {
        let column = |k: usize| {
            let at = |sign: f64| {
                let mut moved = tilt;
                moved[k] += sign * DIFFERENCE;
                self.rows(moved)
            };
            let (low, high) = (at(-1.0), at(1.0));
            [0, 1].map(|i| {
                let change = [0, 1].map(|row| high[i][row] - low[i][row]);
                (change[0] * force[0] + change[1] * force[1]) / (2.0 * DIFFERENCE)
            })
        };
        let columns = [column(0), column(1)];
        [0, 1].map(|i| [0, 1].map(|k| 0.5 * (columns[k][i] + columns[i][k])))
    }

    /// The tilt along e_psi.
    fn across(&self, [x, y]: [f64; N_FINITE]) -> f64 {
        let [cos, sin] = self.azimuth;
        y * cos - x * sin
    }
}

fn square([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
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
mod tests {
    use super::*;

    const CIRCLE: Circle = Circle {
        azimuth: [0.8, 0.6],
        radius: 0.0326,
    };
    const TILTS: [[f64; 2]; 4] = [[1e-3, -4e-4], [0.03, -0.04], [0.3, 0.45], [0.0, 0.0]];

    /// rho (R - 1) e_r by Rodrigues' formula, along e_r and z.
    fn moved(circle: &Circle, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = circle.azimuth;
        let (e, angle) = ([cos, sin, 0.0], x.hypot(y));
        if angle == 0.0 {
            return [0.0; 2];
        }
        let k = [x / angle, y / angle, 0.0];
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let (once, twice) = (cross(k, e), cross(k, cross(k, e)));
        let change = [0, 1, 2].map(|i| angle.sin() * once[i] + (1.0 - angle.cos()) * twice[i]);
        [
            circle.radius * (change[0] * cos + change[1] * sin),
            circle.radius * change[2],
        ]
    }

    /// What the linear terms of a link say of the same motion.
    fn linear(circle: &Circle, tilt: [f64; 2]) -> [f64; 2] {
        [0.0, -circle.radius * circle.across(tilt)]
    }

    /// Wrong: lengths are not those from the rotated circle.
    #[test]
    fn lengths_are_those_of_the_rotated_circle() {
        for tilt in TILTS {
            let (found, exact, linear) = (CIRCLE.lengths(tilt), moved(&CIRCLE, tilt), linear(&CIRCLE, tilt));
            for i in 0..2 {
                assert!(
                    (found[i] - (linear[i] - exact[i])).abs() < 2e-17,
                    "{tilt:?}: {found:?}"
                );
            }
        }
    }

    /// Wrong: forces would act at another lever than lengths grow. Difference quotients.
    #[test]
    fn rows_are_slopes_and_curvature_is_theirs() {
        for tilt in TILTS {
            let (rows, force) = (CIRCLE.rows(tilt), [-300.0, 90.0]);
            let curvature = CIRCLE.curvature(tilt, force);
            for k in 0..2 {
                let (h, mut low, mut high) = (1e-5, tilt, tilt);
                (low[k], high[k]) = (low[k] - h, high[k] + h);
                let (a, b) = (CIRCLE.lengths(low), CIRCLE.lengths(high));
                let (slopes, moved) = (CIRCLE.rows(low), CIRCLE.rows(high));
                for i in 0..2 {
                    assert!(
                        ((b[i] - a[i]) / (2.0 * h) - rows[k][i]).abs() < 1e-11,
                        "{tilt:?} {k} {i}"
                    );
                    let change: f64 = (0..2).map(|l| (moved[i][l] - slopes[i][l]) * force[l]).sum();
                    assert!(
                        (change / (2.0 * h) - curvature[i][k]).abs() < 1e-7,
                        "{tilt:?} {i} {k}"
                    );
                }
            }
        }
    }

    /// Wrong: contacts would make or lose energy over a step, because forces act through other slopes than lengths
    /// change. A step far larger than any of a motion.
    #[test]
    fn mean_rows_give_the_change_of_the_lengths() {
        let (start, change) = (TILTS[1], [1e-4, -2e-4]);
        let end = [0, 1].map(|k| start[k] + change[k]);
        let rows = CIRCLE.mean_rows(start, end);
        let (before, after) = (CIRCLE.lengths(start), CIRCLE.lengths(end));
        for i in 0..2 {
            let grown: f64 = (0..2).map(|k| rows[k][i] * change[k]).sum();
            assert!(
                (grown - (after[i] - before[i])).abs() < 1e-13 * grown.abs(),
                "{grown}"
            );
        }
    }

    /// Wrong: a contact would feel where it stands round the bearing. Everything turned about the axis.
    #[test]
    fn turning_everything_about_the_axis_changes_nothing() {
        for tilt in TILTS {
            let (sin, cos) = 1.1f64.sin_cos();
            let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
            let circle = Circle {
                azimuth: turn(CIRCLE.azimuth),
                ..CIRCLE
            };
            let (found, turned) = (CIRCLE.lengths(tilt), circle.lengths(turn(tilt)));
            (0..2).for_each(|i| assert!((turned[i] - found[i]).abs() <= 1e-14 * found[i].abs()));
        }
    }

    /// Wrong: the functions of the angle jump where their series end.
    #[test]
    fn series_and_closed_forms_meet() {
        let (below, above) = (angle_functions(SMALL * (1.0 - 1e-15)), angle_functions(SMALL));
        (0..2).for_each(|i| assert!((below[i] - above[i]).abs() < 2e-15, "{below:?} {above:?}"));
        let [c, e] = above;
        let slopes = [SMALL * (1.0 - 1e-15), SMALL].map(|square| c_slope(square, c, e));
        assert!((slopes[0] - slopes[1]).abs() < 1e-13, "{slopes:?}");
        assert_eq!(angle_functions(0.0), [0.5, 1.0 / 6.0]);
    }
}
