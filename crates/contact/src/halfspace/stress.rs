//! Stress in an elastic half-space under a semi-ellipsoidal pressure, in closed form, anywhere.
//!
//! p = p0 sqrt(1 - x^2/a^2 - y^2/b^2) on z = 0; the body is z >= 0, the depth; x, y along the semi-axes a >= b (the code takes them in
//! either order). With Boussinesq's potentials phi = integral of p/rho and psi, d psi/dz = phi (Love 1929; Johnson 1985, eq. 3.14 to 3.18),
//!
//! ```text
//! 2 pi sigma_x = 2 nu phi_z - z phi_xx - (1 - 2 nu) psi_xx,    2 pi tau_xy = -z phi_xy - (1 - 2 nu) psi_xy
//! 2 pi sigma_z = phi_z - z phi_zz,                             2 pi tau_xz = -z phi_xz
//! ```
//!
//! phi is that of a flattened homogeneous ellipsoid (Johnson 1985, 3.5): with l the confocal coordinate and
//! D(s) = sqrt((a^2 + s)(b^2 + s) s), phi = (pi a b p0/2) integral over l..inf of (1 - x^2/(a^2+s) - y^2/(b^2+s) - z^2/s)/D ds. Its
//! derivatives need I_a = integral of ds/((a^2+s) D) = 2/3 R_D(l, b^2+l, a^2+l), I_b likewise, and I_z = 2/D(l) - I_a - I_b.
//! psi_x = -integral of phi_x over z..inf becomes, by parts, pi a b p0 x (J_a - z I_a), where J_a is elementary because sqrt(s) cancels:
//!
//! ```text
//! psi_xx / (pi a b p0) = -z I_a + E_a - 2 x^2 E_aa - y^2 E_ab,     psi_xy / (pi a b p0) = -x y E_ab
//! E_a = int ds/((a^2+s) sqrt(P)),  E_aa = int ds/((a^2+s)^2 sqrt(P)),  E_ab = int ds/((a^2+s)(b^2+s) sqrt(P)),
//! P(s) = (a^2+s)(b^2+s) - x^2 (b^2+s) - y^2 (a^2+s)
//! ```
//!
//! With w = 1/(a^2+s), c = a^2 - b^2 and v = w/(1 + w sqrt(P)), ds/((a^2+s) sqrt(P)) = 2 dv/(1 - c x^2 v^2), hence
//! E_a = 2 artanh(sqrt(c) |x| v)/(sqrt(c) |x|), and an arctan for E_b. The results are those of Sackfield and Hills (1983), Journal of
//! Strain Analysis 18, 101-105, doi:10.1243/03093247V182101, in a form that stays exact on the axes, on the surface and for circles.
//!
//! Error: some units of 1e-14 of p0.

use std::f64::consts::PI;

use super::carlson::{n_duplications, rd_pair};
use super::confocal::{LANES, Lanes, confocal};

/// c w below which E_aa and E_ab are integrated numerically: the closed forms divide by c.
const NEARLY_CIRCULAR: f64 = 0.05;
/// Gauss points and weights on 0..1 for rational integrands whose poles are at least four intervals away: error below 1e-16.
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
    /// Semi-axes along x and y, m.
    pub semi_axes: [f64; 2],
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
    /// A pressure that carries `force` (N) over semi-axes along [x, y], m, on a body of a given Poisson's ratio.
    pub fn of_force(force: f64, semi_axes: [f64; 2], poisson_ratio: f64) -> EllipticPressure {
        let peak = 1.5 * force / (PI * semi_axes[0] * semi_axes[1]);
        Self::of_peak(peak, semi_axes, poisson_ratio)
    }

    /// A pressure of a given peak, Pa.
    pub fn of_peak(peak: f64, semi_axes: [f64; 2], poisson_ratio: f64) -> EllipticPressure {
        let swapped = semi_axes[1] > semi_axes[0];
        let ratio = semi_axes[0].min(semi_axes[1]) / semi_axes[0].max(semi_axes[1]);
        let b2 = ratio * ratio;
        EllipticPressure {
            semi_axes,
            peak,
            a2: 1.0,
            b2,
            swapped,
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

    /// Stress xx yy zz xy yz xz, Pa, `[n][6]`, at points [x, y, depth], m, `[n][3]`; a negative depth counts as the surface. The stress of
    /// a point does not depend on the other points.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn stresses(&self, points: &[[f64; 3]], stress: &mut [[f64; 6]]) {
        assert_eq!(points.len(), stress.len(), "one stress per point");
        let scale = 1.0 / self.semi_axes[0].max(self.semi_axes[1]);
        for (points, stress) in points.chunks(LANES).zip(stress.chunks_mut(LANES)) {
            let mut x = [[0.0; LANES]; 3];
            for (i, point) in points.iter().enumerate() {
                let [first, second] = if self.swapped { [1, 0] } else { [0, 1] };
                x[0][i] = scale * point[first];
                x[1][i] = scale * point[second];
                x[2][i] = scale * point[2].max(0.0);
            }
            let found = self.lanes(&x);
            for (stress, found) in stress.iter_mut().zip(found) {
                *stress = if self.swapped {
                    let [xx, yy, zz, xy, yz, xz] = found;
                    [yy, xx, zz, xy, xz, yz]
                } else {
                    found
                };
            }
        }
    }

    /// Stress at points in units of the larger semi-axis, which is along x.
    fn lanes(&self, x: &[Lanes; 3]) -> [[f64; 6]; LANES] {
        let (a2, b2) = (self.a2, self.b2);
        let lambda = confocal(&x.map(|x| x.map(|x| x * x)), a2, b2);
        let (a2_l, b2_l) = (lambda.map(|l| a2 + l), lambda.map(|l| b2 + l));
        let [i_a, i_b] = rd_pair(&lambda, &b2_l, &a2_l, self.n_duplications);
        std::array::from_fn(|i| {
            let at = Place {
                x: [x[0][i], x[1][i], x[2][i]],
                lambda: lambda[i],
                semi2: [a2_l[i], b2_l[i]],
                c: a2 - b2,
            };
            let factor = 0.5 * self.peak * b2.sqrt();
            let integrals = [2.0 / 3.0 * i_a[i], 2.0 / 3.0 * i_b[i]];
            at.stress(integrals, self.poisson_ratio).map(|s| factor * s)
        })
    }
}

/// A point with its confocal ellipsoid, in units of the larger semi-axis.
struct Place {
    x: [f64; 3],
    lambda: f64,
    /// a^2 + l and b^2 + l.
    semi2: [f64; 2],
    /// a^2 - b^2.
    c: f64,
}

impl Place {
    /// Stress over p0 a b / 2, from [I_a, I_b].
    fn stress(&self, [i_a, i_b]: [f64; 2], nu: f64) -> [f64; 6] {
        let [x, y, z] = self.x;
        let [a2, b2] = self.semi2;
        // z / sqrt(l), which is the pressure's square root where l and z vanish.
        let zeta = if self.lambda > 0.0 {
            z / self.lambda.sqrt()
        } else {
            (1.0 - x * x / a2 - y * y / b2).max(0.0).sqrt()
        };
        let s = (a2 * b2).sqrt();
        let (xa, yb) = (x / a2, y / b2);
        // The gradient of l contains 1/H = l/d; all that it multiplies vanishes where d does, on the edge.
        let d = self.lambda * (xa * xa + yb * yb) + zeta * zeta;
        let over = if d > 0.0 { 1.0 / (d * s) } else { 0.0 };
        let (zi_a, zi_b) = (z * i_a, z * i_b);
        let zi_z = 2.0 * zeta / s - zi_a - zi_b;
        let slope = 2.0 * zeta * self.lambda * over;
        let shear = 2.0 * zeta * zeta * self.lambda.sqrt() * over;
        let flat = self.surface(zeta);
        let poisson = 1.0 - 2.0 * nu;
        let xx = -2.0 * nu * zi_z + zi_a - slope * xa * xa - poisson * (flat.xx - zi_a);
        let yy = -2.0 * nu * zi_z + zi_b - slope * yb * yb - poisson * (flat.yy - zi_b);
        [
            xx,
            yy,
            -2.0 * zeta * zeta * zeta * over,
            poisson * flat.xy - slope * xa * yb,
            -shear * yb,
            -shear * xa,
        ]
    }

    /// The elementary parts of psi_xx, psi_yy and -psi_xy.
    fn surface(&self, zeta: f64) -> Surface {
        let [x, y, _] = self.x;
        let (x2, y2, c) = (x * x, y * y, self.c);
        let [w_a, w_b] = self.semi2.map(|s| 1.0 / s);
        let ratio = (self.semi2[1] * w_a).sqrt();
        let r_a = zeta * ratio;
        let v_a = w_a / (1.0 + r_a);
        let v_b = w_b / (1.0 + zeta / ratio);
        let e_a = 2.0 * v_a * artanh_over(c.sqrt() * x.abs() * v_a);
        let e_b = 2.0 * v_b * arctan_over(c.sqrt() * y.abs() * v_b);
        let b = c + x2 + y2;
        let (x2_e_aa, e_ab) = if c * w_a > NEARLY_CIRCULAR {
            ((r_a - 1.0 + 0.5 * b * e_a) / c, (e_b - e_a) / c)
        } else {
            let mut sums = [0.0; 2];
            for (point, weight) in GAUSS {
                let v = point * v_a;
                let q = 1.0 - c * x2 * v * v;
                let p = weight * v_a * 2.0 * v * (2.0 - b * v) / q;
                sums[0] += p / q;
                sums[1] += p / ((1.0 - c * v) * (1.0 - c * v) + c * y2 * v * v);
            }
            (x2 * sums[0], sums[1])
        };
        let xx = e_a - 2.0 * x2_e_aa - y2 * e_ab;
        // psi is harmonic: psi_xx + psi_yy + phi_z = 0, and the parts with z I cancel.
        let yy = 2.0 * zeta / (self.semi2[0] * self.semi2[1]).sqrt() - xx;
        Surface {
            xx,
            yy,
            xy: x * y * e_ab,
        }
    }
}

struct Surface {
    xx: f64,
    yy: f64,
    xy: f64,
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
