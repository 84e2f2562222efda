//! Points under a curved surface, and what point loads add to their stress: see [`super::curvature`].

use std::f64::consts::PI;

use super::confocal::{LANES, PointLanes};
use super::stress::EllipticPressure;

/// Points whose stress is being summed up.
pub(super) struct Target {
    /// [x, y, depth], m.
    pub(super) point: [PointLanes; 3],
    pub(super) axes: [f64; 2],
    pub(super) curvatures: [f64; 2],
    pub(super) poisson_ratio: f64,
    pub(super) sum: [PointLanes; 6],
}

impl Target {
    /// The feet of the points on the unit disc.
    #[inline(always)]
    pub fn foot(&self) -> [PointLanes; 2] {
        let mut foot = [[0.0; LANES]; 2];
        for i in 0..LANES {
            foot[0][i] = self.point[0][i] / self.axes[0];
            foot[1][i] = self.point[1][i] / self.axes[1];
        }
        foot
    }

    /// Adds loads at places on the unit disc, with the integral of sqrt(1 - r^2) that each stands for.
    #[inline(always)]
    pub fn add(&mut self, at: &[PointLanes; 2], weight: &PointLanes) {
        for i in 0..LANES {
            let from = [
                self.point[0][i] - self.axes[0] * at[0][i],
                self.point[1][i] - self.axes[1] * at[1][i],
                self.point[2][i],
            ];
            let added = point_load(self.curvatures, self.poisson_ratio, from);
            for c in 0..6 {
                self.sum[c][i] += weight[i] * added[c];
            }
        }
    }

    #[inline(always)]
    pub fn add_to(&self, pressure: &EllipticPressure, own: &[usize], stress: &mut [[f64; 6]]) {
        let scale = pressure.peak * self.axes[0] * self.axes[1];
        for (i, &point) in own.iter().enumerate() {
            for c in 0..6 {
                stress[point][c] += scale * self.sum[c][i];
            }
        }
    }
}

/// Stress xx yy zz xy yz xz, 1/m^2, that curvatures [along x, along y], 1/m, add at a place [x, y, depth] from a unit
/// load.
#[inline(always)]
pub fn point_load(curvatures: [f64; 2], poisson_ratio: f64, [x, y, z]: [f64; 3]) -> [f64; 6] {
    // A load at the point itself stands for no force: any finite number does.
    let over = 1.0 / (x * x + y * y + z * z).max(f64::MIN_POSITIVE).sqrt();
    let [x, y, z] = [x * over, y * over, z * over];
    let depth = Depth::new(z, poisson_ratio);
    let along = depth.one_curvature(x, y);
    let [yy, xx, zz, xy, xz, yz] = depth.one_curvature(y, x);
    let across = [xx, yy, zz, xy, yz, xz];
    let scale = over / (2.0 * PI);
    let mut sum = [0.0; 6];
    for c in 0..6 {
        sum[c] = scale * (curvatures[0] * along[c] + curvatures[1] * across[c]);
    }
    sum
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
    #[inline(always)]
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
    #[inline(always)]
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
