//! Stress in an elastic half-space under a semi-ellipsoidal pressure, in closed form, anywhere.
//!
//! p = p0 sqrt(1 - x^2/a^2 - y^2/b^2) on z = 0; the body is z >= 0, the depth; x, y along the semi-axes a >= b (the
//! code takes them in either order). With Boussinesq's potentials phi = integral of p/rho and psi, d psi/dz = phi
//! (Love 1929; Johnson 1985, eq. 3.14 to 3.18),
//!
//! ```text
//! 2 pi sigma_x = 2 nu phi_z - z phi_xx - (1 - 2 nu) psi_xx,    2 pi tau_xy = -z phi_xy - (1 - 2 nu) psi_xy
//! 2 pi sigma_z = phi_z - z phi_zz,                             2 pi tau_xz = -z phi_xz
//! ```
//!
//! phi is that of a flattened homogeneous ellipsoid (Johnson 1985, 3.5): with l the confocal coordinate and D(s) =
//! sqrt((a^2 + s)(b^2 + s) s), phi = (pi a b p0/2) integral over l..inf of (1 - x^2/(a^2+s) - y^2/(b^2+s) - z^2/s)/D
//! ds. Its derivatives need I_a = integral of ds/((a^2+s) D) = 2/3 R_D(l, b^2+l, a^2+l), I_b likewise, and I_z =
//! 2/D(l) - I_a - I_b. psi_x = -integral of phi_x over z..inf becomes, by parts, pi a b p0 x (J_a - z I_a), where J_a
//! is elementary because sqrt(s) cancels:
//!
//! ```text
//! psi_xx / (pi a b p0) = -z I_a + E_a - 2 x^2 E_aa - y^2 E_ab,     psi_xy / (pi a b p0) = -x y E_ab
//! E_a = int ds/((a^2+s) sqrt(P)),  E_aa = int ds/((a^2+s)^2 sqrt(P)),  E_ab = int ds/((a^2+s)(b^2+s) sqrt(P)),
//! P(s) = (a^2+s)(b^2+s) - x^2 (b^2+s) - y^2 (a^2+s)
//! ```
//!
//! With w = 1/(a^2+s), c = a^2 - b^2 and v = w/(1 + w sqrt(P)), ds/((a^2+s) sqrt(P)) = 2 dv/(1 - c x^2 v^2), hence
//! E_a = 2 artanh(sqrt(c) |x| v)/(sqrt(c) |x|), and an arctan for E_b. The results are those of Sackfield and Hills
//! (1983), Journal of Strain Analysis 18, 101-105, doi:10.1243/03093247V182101, in a form that stays exact on the
//! axes, on the surface and for circles.
//!
//! Error: some units of 1e-14 of p0.

use std::f64::consts::PI;

use pulp::{Simd, WithSimd};

use super::carlson::{n_duplications, rd_pair};
use super::confocal::{LANES, PointLanes, confocal};
use crate::semi_axes::SemiAxes;

/// c w below which E_aa and E_ab are integrated numerically: the closed forms divide by c.
const NEARLY_CIRCULAR: f64 = 0.05;
/// Gauss points and weights on 0..1 for rational integrands whose poles are at least four intervals away: error below
/// 1e-16.
const GAUSS: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_64, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// A semi-ellipsoidal pressure on a half-space, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticPressure {
    /// Semi-axes, m: along the groove is x, the rolling direction y.
    pub semi_axes: SemiAxes,
    /// Peak pressure p0, Pa.
    pub peak: f64,
    /// Larger and smaller semi-axis over the larger one, squared.
    a2: f64,
    b2: f64,
    /// x and y change places, because the larger semi-axis is along y.
    swapped: bool,
    pub(super) poisson_ratio: f64,
    n_duplications: usize,
}

impl EllipticPressure {
    /// A pressure that carries `force` (N) over semi-axes, m, on a body of a given Poisson's ratio.
    pub fn of_force(force: f64, semi_axes: SemiAxes, poisson_ratio: f64) -> EllipticPressure {
        let peak = 1.5 * force / (PI * semi_axes.groove * semi_axes.rolling);
        Self::of_peak(peak, semi_axes, poisson_ratio)
    }

    /// A pressure of a given peak, Pa.
    pub fn of_peak(peak: f64, semi_axes: SemiAxes, poisson_ratio: f64) -> EllipticPressure {
        let ratio = semi_axes.minor() / semi_axes.major();
        let b2 = ratio * ratio;
        EllipticPressure {
            semi_axes,
            peak,
            a2: 1.0,
            b2,
            swapped: semi_axes.rolling > semi_axes.groove,
            poisson_ratio,
            n_duplications: n_duplications(1.0, b2),
        }
    }

    /// Stress xx yy zz xy yz xz, Pa, at one point [x, y, depth], m.
    pub fn stress(&self, point: [f64; 3]) -> [f64; 6] {
        let mut stress = [[0.0; 6]];
        self.stresses(&[point], &mut stress);
        stress[0]
    }

    /// Stress xx yy zz xy yz xz, Pa, `[n][6]`, at points [x, y, depth], m, `[n][3]`; a negative depth counts as the
    /// surface. The stress of a point does not depend on the other points.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn stresses(&self, points: &[[f64; 3]], stress: &mut [[f64; 6]]) {
        assert_eq!(points.len(), stress.len(), "one stress per point");
        pulp::Arch::new().dispatch(Stresses {
            pressure: self,
            points,
            stress,
        });
    }

    /// Stress at points in units of the larger semi-axis, which is along x, by components.
    #[inline(always)]
    fn lanes(&self, x: &[PointLanes; 3]) -> [PointLanes; 6] {
        let (a2, b2) = (self.a2, self.b2);
        let mut squares = *x;
        squares.as_flattened_mut().iter_mut().for_each(|x| *x *= *x);
        let lambda = confocal(&squares, a2, b2);
        let (mut a2_l, mut b2_l) = (lambda, lambda);
        for i in 0..LANES {
            a2_l[i] += a2;
            b2_l[i] += b2;
        }
        let [i_a, i_b] = rd_pair(&lambda, &b2_l, &a2_l, self.n_duplications);
        let places = ConfocalPoints {
            x: *x,
            lambda,
            semi2: [a2_l, b2_l],
            c: a2 - b2,
        };
        let zeta = places.zeta();
        let flat = places.surface(&zeta);
        let factor = 0.5 * self.peak * b2.sqrt();
        let mut stress = [[0.0; LANES]; 6];
        for i in 0..LANES {
            let integrals = [2.0 / 3.0 * i_a[i], 2.0 / 3.0 * i_b[i]];
            let surface = [flat[0][i], flat[1][i], flat[2][i]];
            let own = places.stress(i, zeta[i], integrals, surface, self.poisson_ratio);
            for c in 0..6 {
                stress[c][i] = factor * own[c];
            }
        }
        stress
    }
}

/// [`EllipticPressure::stresses`], to be compiled for the vectors of each kind of processor.
struct Stresses<'a> {
    pressure: &'a EllipticPressure,
    points: &'a [[f64; 3]],
    stress: &'a mut [[f64; 6]],
}

impl WithSimd for Stresses<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (first, second) = if self.pressure.swapped { (1, 0) } else { (0, 1) };
        let order = if self.pressure.swapped {
            [1, 0, 2, 3, 5, 4]
        } else {
            [0, 1, 2, 3, 4, 5]
        };
        let scale = 1.0 / self.pressure.semi_axes.major();
        for (points, stress) in self.points.chunks(LANES).zip(self.stress.chunks_mut(LANES)) {
            let mut x = [[0.0; LANES]; 3];
            for (i, point) in points.iter().enumerate() {
                x[0][i] = scale * point[first];
                x[1][i] = scale * point[second];
                x[2][i] = scale * point[2].max(0.0);
            }
            let found = self.pressure.lanes(&x);
            for (i, stress) in stress.iter_mut().enumerate() {
                *stress = order.map(|c| found[c][i]);
            }
        }
    }
}

/// Points with their confocal ellipsoids, in units of the larger semi-axis.
struct ConfocalPoints {
    x: [PointLanes; 3],
    lambda: PointLanes,
    /// a^2 + l and b^2 + l.
    semi2: [PointLanes; 2],
    /// a^2 - b^2.
    c: f64,
}

impl ConfocalPoints {
    /// z / sqrt(l), which is the pressure's square root where l and z vanish.
    #[inline(always)]
    fn zeta(&self) -> PointLanes {
        let mut zeta = [0.0; LANES];
        for i in 0..LANES {
            let [x, y, z] = [self.x[0][i], self.x[1][i], self.x[2][i]];
            let pressure = (1.0 - x * x / self.semi2[0][i] - y * y / self.semi2[1][i]).max(0.0);
            let ratio = z / self.lambda[i].sqrt();
            zeta[i] = if self.lambda[i] > 0.0 {
                ratio
            } else {
                pressure.sqrt()
            };
        }
        zeta
    }

    /// Stress of lane i over p0 a b / 2, from [I_a, I_b] and the elementary parts.
    #[inline(always)]
    fn stress(&self, i: usize, zeta: f64, [i_a, i_b]: [f64; 2], flat: [f64; 3], nu: f64) -> [f64; 6] {
        let [x, y, z] = [self.x[0][i], self.x[1][i], self.x[2][i]];
        let (a2, b2, lambda) = (self.semi2[0][i], self.semi2[1][i], self.lambda[i]);
        let s = (a2 * b2).sqrt();
        let (xa, yb) = (x / a2, y / b2);
        // The gradient of l contains 1/H = l/d; all that it multiplies vanishes where d does, on the edge.
        let d = lambda * (xa * xa + yb * yb) + zeta * zeta;
        let over = if d > 0.0 { 1.0 / (d * s) } else { 0.0 };
        let (zi_a, zi_b) = (z * i_a, z * i_b);
        let zi_z = 2.0 * zeta / s - zi_a - zi_b;
        let slope = 2.0 * zeta * lambda * over;
        let shear = 2.0 * zeta * zeta * lambda.sqrt() * over;
        let poisson = 1.0 - 2.0 * nu;
        let xx = -2.0 * nu * zi_z + zi_a - slope * xa * xa - poisson * (flat[0] - zi_a);
        let yy = -2.0 * nu * zi_z + zi_b - slope * yb * yb - poisson * (flat[1] - zi_b);
        [
            xx,
            yy,
            -2.0 * zeta * zeta * zeta * over,
            poisson * flat[2] - slope * xa * yb,
            -shear * yb,
            -shear * xa,
        ]
    }

    /// The elementary parts of psi_xx, psi_yy and -psi_xy.
    #[inline(always)]
    fn surface(&self, zeta: &PointLanes) -> [PointLanes; 3] {
        let c = self.c;
        let (mut ratio, mut v_a, mut v_b) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let [w_a, w_b] = [1.0 / self.semi2[0][i], 1.0 / self.semi2[1][i]];
            ratio[i] = (self.semi2[1][i] * w_a).sqrt();
            v_a[i] = w_a / (1.0 + zeta[i] * ratio[i]);
            v_b[i] = w_b / (1.0 + zeta[i] / ratio[i]);
        }
        let (mut e_a, mut e_b) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            e_a[i] = 2.0 * v_a[i] * artanh_over(c.sqrt() * self.x[0][i].abs() * v_a[i]);
            e_b[i] = 2.0 * v_b[i] * arctan_over(c.sqrt() * self.x[1][i].abs() * v_b[i]);
        }
        let mut flat = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let (x2, y2) = (self.x[0][i] * self.x[0][i], self.x[1][i] * self.x[1][i]);
            let x2_e_aa = (zeta[i] * ratio[i] - 1.0 + 0.5 * (c + x2 + y2) * e_a[i]) / c;
            let e_ab = (e_b[i] - e_a[i]) / c;
            flat[0][i] = e_a[i] - 2.0 * x2_e_aa - y2 * e_ab;
            flat[2][i] = self.x[0][i] * self.x[1][i] * e_ab;
        }
        for i in 0..LANES {
            if c / self.semi2[0][i] <= NEARLY_CIRCULAR {
                [flat[0][i], flat[2][i]] = self.nearly_circular(i, v_a[i], e_a[i]);
            }
        }
        for i in 0..LANES {
            // psi is harmonic: psi_xx + psi_yy + phi_z = 0, and the parts with z I cancel.
            flat[1][i] = 2.0 * zeta[i] / (self.semi2[0][i] * self.semi2[1][i]).sqrt() - flat[0][i];
        }
        flat
    }

    /// The first and the last of them in lane i, where the closed forms would lose digits.
    fn nearly_circular(&self, i: usize, v_a: f64, e_a: f64) -> [f64; 2] {
        let ([x, y], c) = ([self.x[0][i], self.x[1][i]], self.c);
        let (x2, y2) = (x * x, y * y);
        let mut sums = [0.0; 2];
        for (point, weight) in GAUSS {
            let v = point * v_a;
            let q = 1.0 - c * x2 * v * v;
            let p = weight * v_a * 2.0 * v * (2.0 - (c + x2 + y2) * v) / q;
            sums[0] += p / q;
            sums[1] += p / ((1.0 - c * v) * (1.0 - c * v) + c * y2 * v * v);
        }
        [e_a - 2.0 * x2 * sums[0] - y2 * sums[1], x * y * sums[1]]
    }
}

/// artanh(g)/g.
fn artanh_over(g: f64) -> f64 {
    if g < 1e-3 {
        let g2 = g * g;
        return 1.0 + g2 * (1.0 / 3.0 + g2 * (0.2 + g2 / 7.0));
    }
    g.atanh() / g
}

/// arctan(g)/g.
fn arctan_over(g: f64) -> f64 {
    if g < 1e-3 {
        let g2 = g * g;
        return 1.0 - g2 * (1.0 / 3.0 - g2 * (0.2 - g2 / 7.0));
    }
    g.atan() / g
}
