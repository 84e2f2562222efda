//! What the curvature of a surface changes in the stress under a pressure, to first order.
//!
//! A half-space wrapped round a curved surface (arcs x and y on the surface, depth z, stress in the directions of these coordinates at the
//! point itself) keeps the surface tractions, but is neither in equilibrium nor compatible: pushing the bottom of a groove outwards
//! stretches it along the groove. Below semi-axes of 1.2 and 0.12 mm on a groove of 4.65 mm that is 0.1 of the peak pressure.
//!
//! **Point load.** With curvature k along x, positive where the surface is concave, a point load P adds to Boussinesq's stress
//!
//! ```text
//! k P / (2 pi rho) [ A(n) + (1 - 2 nu) B(n) ],    rho the distance from the load, n = (x, y, z)/rho
//! A_xx = 3/2 x^4 (1 + 5 z^2)    A_yy = 3/2 x^2 y^2 (1 + 5 z^2)    A_zz = 3/2 x^2 z^2 (5 z^2 - 1)
//! A_xy = 3/2 x^3 y (1 + 5 z^2)  A_yz = 15/2 x^2 y z^3             A_xz = 15/2 x^3 z^3
//! ```
//!
//! and B, polynomials of n over (1 + z)^2 to (1 + z)^4, as in the code. Derivation: the half-space tangent to the surface at the load is an exact field; taken to the wrapped coordinates,
//! x -> x + k x z, z -> z - k x^2/2, its tensor turned by k x, it leaves shear tractions k x (sigma_xx, sigma_xy) on the surface, which a
//! half-space with the opposite shear removes (three harmonic functions: ln(rho + z) and (x + i y)^2/(rho + z)^2 with their integrals over z).
//! Curvature along y: x and y change places. The two add up.
//!
//! **Pressure.** The kernel falls as 1/rho, so in polar coordinates about the foot of the point nothing is singular. The ellipse is taken for a
//! circle; then angles are stretched so that those across a slender ellipse get their share, and along each ray r = r0 + (r1 - r0) sin^2 phi takes
//! out the root of the pressure. Far from the ellipse few rays do.
//!
//! Error of the quadrature: 3e-4 of the peak pressure for a semi-axis of a quarter of the radius; the second order in size over radius is left out.

use std::f64::consts::{FRAC_PI_2, PI};

use super::stress::EllipticPressure;
use crate::quadrature::gauss_legendre;

/// Rays over all angles for a point above the ellipse, over the angles of the ellipse for one beside it, and points on a ray: for points near
/// a slender ellipse, near another one, and further from the centre than [`FAR`] larger semi-axes.
const NEAR_SLENDER: [usize; 3] = [32, 28, 10];
const NEAR: [usize; 3] = [16, 14, 8];
const AWAY: [usize; 3] = [12, 6, 4];
/// Ratio of the semi-axes of a slender ellipse.
const SLENDER: f64 = 3.0;
const FAR: f64 = 2.0;

/// A surface with constant curvatures, ready to correct the stress under pressures on it.
pub struct CurvedSurface {
    /// Curvatures along x and y, 1/m, positive where concave: the centre of curvature is outside the body.
    curvatures: [f64; 2],
    near_slender: Rays,
    near: Rays,
    away: Rays,
}

impl CurvedSurface {
    /// A surface with curvatures along x and y, 1/m, positive where concave.
    pub fn new(curvatures: [f64; 2]) -> CurvedSurface {
        CurvedSurface {
            curvatures,
            near_slender: Rays::new(NEAR_SLENDER),
            near: Rays::new(NEAR),
            away: Rays::new(AWAY),
        }
    }

    /// What the curvatures add to the stress xx yy zz xy yz xz, Pa, of a pressure at the point [x, y, depth], m.
    pub fn stress(&self, pressure: &EllipticPressure, point: [f64; 3]) -> [f64; 6] {
        let axes = pressure.semi_axes;
        let point = [point[0], point[1], point[2].max(0.0)];
        let distance = point.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (major, minor) = (axes[0].max(axes[1]), axes[0].min(axes[1]));
        let rays = if distance > FAR * major {
            &self.away
        } else if major > SLENDER * minor {
            &self.near_slender
        } else {
            &self.near
        };
        let mut sum = [0.0; 6];
        rays.for_each([point[0] / axes[0], point[1] / axes[1]], axes, |at, weight| {
            let from = [point[0] - axes[0] * at[0], point[1] - axes[1] * at[1], point[2]];
            let added = point_load(self.curvatures, pressure.poisson_ratio, from);
            for c in 0..6 {
                sum[c] += weight * added[c];
            }
        });
        sum.map(|s| pressure.peak * axes[0] * axes[1] * s)
    }
}

/// Stress xx yy zz xy yz xz, 1/m^2, that curvatures [along x, along y], 1/m, add at a place [x, y, depth] from a unit load.
pub fn point_load(curvatures: [f64; 2], poisson_ratio: f64, [x, y, z]: [f64; 3]) -> [f64; 6] {
    let over = 1.0 / (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x * over, y * over, z * over];
    let depth = Depth::new(z, poisson_ratio);
    let along = depth.one_curvature(x, y);
    let [yy, xx, zz, xy, xz, yz] = depth.one_curvature(y, x);
    let across = [xx, yy, zz, xy, yz, xz];
    let scale = over / (2.0 * PI);
    std::array::from_fn(|c| scale * (curvatures[0] * along[c] + curvatures[1] * across[c]))
}

/// A(n) and (1 - 2 nu) B(n) as polynomials of x^2, whose coefficients are functions of the third component z of n.
struct Depth {
    z: f64,
    /// Coefficient of x^2 in the x^4, x^2 y^2 and x^3 y of A.
    a: f64,
    a_zz: f64,
    a_shear: f64,
    /// Coefficients of B: of x^4 in xx, yy and of x^2 in xy; of x^2 and 1 in xx and yy; of 1 in xy.
    e: f64,
    xx: [f64; 2],
    yy: [f64; 2],
    xy: f64,
    /// Of x^2 and 1.
    zz: [f64; 2],
    yz: [f64; 2],
    xz: [f64; 2],
}

impl Depth {
    fn new(z: f64, nu: f64) -> Depth {
        let (z2, w) = (z * z, 1.0 / (1.0 + z));
        let (z3, z4) = (z * z2, z2 * z2);
        let normal = (1.0 - 2.0 * nu) * w * w;
        let (shear, plane) = (normal * w, 0.5 * normal * w * w);
        let e = 3.0 * z4 + 12.0 * z3 + 14.0 * z2 - 4.0 * z + 5.0 - 4.0 * nu;
        let xx = 3.0 * z4 * z2 + 12.0 * z4 * z + 12.0 * z4 - 12.0 * z3 - (5.0 + 8.0 * nu) * z2
            + (4.0 - 8.0 * nu) * z
            - 6.0;
        let xx_0 =
            (2.0 - 4.0 * nu) * z4 - (1.0 + 10.0 * nu) * z3 - (8.0 + 8.0 * nu) * z2 - (5.0 + 2.0 * nu) * z;
        let yy = -9.0 * z4 - 36.0 * z3 - (20.0 + 4.0 * nu) * z2 + 4.0 * z + 4.0 * nu - 3.0;
        let yy_0 = -2.0 * z4 * z2 - 8.0 * z4 * z - 4.0 * z4
            + (9.0 + 2.0 * nu) * z3
            + (8.0 + 4.0 * nu) * z2
            + (1.0 + 2.0 * nu) * z;
        let xy = -4.0 * z4 - 16.0 * z3 - (8.0 + 4.0 * nu) * z2 + (2.0 - 4.0 * nu) * z - 2.0;
        Depth {
            z,
            a: 1.5 * (1.0 + 5.0 * z2),
            a_zz: 1.5 * z2 * (5.0 * z2 - 1.0),
            a_shear: 7.5 * z2,
            e: plane * e,
            xx: [plane * xx, plane * xx_0],
            yy: [plane * yy, plane * yy_0],
            xy: plane * xy,
            zz: [normal * (z + 2.0), normal * (z3 + 2.0 * z2 - 1.0)],
            yz: [2.0 * shear * (z + 3.0), shear * (z3 + 3.0 * z2 + z - 1.0)],
            xz: [2.0 * shear * (z + 3.0), 2.0 * shear * (z3 + 3.0 * z2 - 2.0)],
        }
    }

    /// A(n) + (1 - 2 nu) B(n) for a curvature along x.
    fn one_curvature(&self, x: f64, y: f64) -> [f64; 6] {
        let (z, x2) = (self.z, x * x);
        let a = self.a * x2;
        [
            x2 * (a - x2 * self.e - self.xx[0]) - self.xx[1],
            y * y * a + x2 * (x2 * self.e + self.yy[0]) + self.yy[1],
            x2 * self.a_zz + z * (x2 * self.zz[0] + self.zz[1]),
            x * y * (a - x2 * self.e - self.xy),
            y * z * (x2 * (self.a_shear + self.yz[0]) + self.yz[1]),
            x * z * (x2 * (self.a_shear + self.xz[0]) + self.xz[1]),
        ]
    }
}

/// Quadrature of a semi-ellipsoidal pressure over the unit disc about any foot.
struct Rays {
    /// Number of angles over the full circle.
    n_round: usize,
    /// Angles -pi/2..pi/2 and weights.
    beside: Vec<(f64, f64)>,
    /// Shares sin^2 phi of a ray and weights.
    along: Vec<(f64, f64)>,
}

impl Rays {
    fn new([n_round, n_beside, n_along]: [usize; 3]) -> Rays {
        let scaled = |n: usize, scale: f64, shift: f64| {
            gauss_legendre(n)
                .into_iter()
                .map(move |(x, w)| (scale * (x + shift), scale * w))
        };
        let along = scaled(n_along, 0.25 * PI, 1.0).map(|(phi, w)| {
            let s2 = phi.sin().powi(2);
            (s2, w * 2.0 * phi.sin() * phi.cos())
        });
        Rays {
            n_round,
            beside: scaled(n_beside, FRAC_PI_2, 0.0).collect(),
            along: along.collect(),
        }
    }

    /// Calls `add` with places on the unit disc and the integral of sqrt(1 - r^2) that they stand for. `foot` is that of the point on the
    /// disc, whose stretched axes are `axes`.
    fn for_each(&self, foot: [f64; 2], axes: [f64; 2], mut add: impl FnMut([f64; 2], f64)) {
        let stretch = (axes[0] / axes[1]).sqrt();
        let d2 = foot[0] * foot[0] + foot[1] * foot[1];
        if d2 < 1.0 {
            let step = 2.0 * PI / self.n_round as f64;
            for i in 0..self.n_round {
                self.ray(foot, stretched((i as f64 + 0.5) * step, stretch), step, &mut add);
            }
            return;
        }
        // The rays that meet the disc.
        let (centre, half) = ((-foot[1]).atan2(-foot[0]), (1.0 / d2.sqrt()).min(1.0).asin());
        let [first, last] = [centre - half, centre + half].map(|angle| shrunk(angle, stretch));
        for &(t, weight) in &self.beside {
            let phi = 0.5 * (first + last) + 0.5 * (last - first) * t.sin();
            let weight = 0.5 * (last - first) * t.cos() * weight;
            self.ray(foot, stretched(phi, stretch), weight, &mut add);
        }
    }

    /// One ray in the direction [cos, sin] and the derivative of its angle.
    fn ray(
        &self,
        foot: [f64; 2],
        ([cos, sin], slope): ([f64; 2], f64),
        weight: f64,
        add: &mut impl FnMut([f64; 2], f64),
    ) {
        let m = foot[0] * cos + foot[1] * sin;
        let inside = 1.0 - foot[0] * foot[0] - foot[1] * foot[1];
        let root = m * m + inside;
        if root <= 0.0 {
            return;
        }
        let (back, end) = (-m - root.sqrt(), -m + root.sqrt());
        let start = back.max(0.0);
        for &(share, own) in &self.along {
            let r = start + (end - start) * share;
            let pressure = ((end - r) * (r - back)).max(0.0).sqrt();
            let w = weight * slope * own * (end - start) * pressure * r;
            add([foot[0] + r * cos, foot[1] + r * sin], w);
        }
    }
}

/// Direction [cos, sin] of a stretched angle, tan = q tan(phi), and the derivative of the angle by phi.
fn stretched(phi: f64, q: f64) -> ([f64; 2], f64) {
    let (sin, cos) = phi.sin_cos();
    let length = (cos * cos + q * q * sin * sin).sqrt();
    ([cos / length, q * sin / length], q / (length * length))
}

/// The inverse of [`stretched`], continuous in the angle.
fn shrunk(angle: f64, q: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let turn = (sin * cos - q * sin * cos).atan2(q * cos * cos + sin * sin);
    angle + turn
}
