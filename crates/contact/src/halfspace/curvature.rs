//! What the curvature of a surface changes in the stress under a pressure, to first order.
//!
//! A half-space wrapped round a curved surface (arcs x and y on the surface, depth z, stress in the directions of
//! these coordinates at the point itself) keeps the surface tractions, but is neither in equilibrium nor compatible:
//! pushing the bottom of a groove outwards stretches it along the groove. Below semi-axes of 1.2 and 0.12 mm on a
//! groove of 4.65 mm that is 0.1 of the peak pressure.
//!
//! **Point load.** With curvature k along x, positive where the surface is concave, a point load P adds to
//! Boussinesq's stress
//!
//! ```text
//! k P / (2 pi rho) [ A(n) + (1 - 2 nu) B(n) ],    rho the distance from the load, n = (x, y, z)/rho
//! A_xx = 3/2 x^4 (1 + 5 z^2)    A_yy = 3/2 x^2 y^2 (1 + 5 z^2)    A_zz = 3/2 x^2 z^2 (5 z^2 - 1)
//! A_xy = 3/2 x^3 y (1 + 5 z^2)  A_yz = 15/2 x^2 y z^3             A_xz = 15/2 x^3 z^3
//! ```
//!
//! and B, polynomials of n over (1 + z)^2 to (1 + z)^4, as in the code. Derivation: the half-space tangent to the
//! surface at the load is an exact field; taken to the wrapped coordinates, x -> x + k x z, z -> z - k x^2/2, its
//! tensor turned by k x, it leaves shear tractions k x (sigma_xx, sigma_xy) on the surface, which a half-space with
//! the opposite shear removes (three harmonic functions: ln(rho + z) and (x + i y)^2/(rho + z)^2 with their integrals
//! over z). Curvature along y: x and y change places. The two add up.
//!
//! **Pressure.** Near the ellipse an integral along rays from the foot of the point, which nothing makes singular;
//! away from it a few point loads (file `rays.rs`). Error: 3e-4 of the peak pressure for a semi-axis of a quarter of
//! the radius, or of the given larger pressure; the second order in size over radius is left out.
//!
//! Points are worked on side by side in lanes, by the vectors of the processor; no product is fused with a sum, so
//! the bits do not depend on it, nor those of a point on the other points.

use std::f64::consts::PI;

use pulp::{Simd, WithSimd};

use super::confocal::{LANES, Lanes};
use super::rays::{Directions, Loads, Rays};
use super::stress::EllipticPressure;

/// What is near, and how it is integrated.
struct Rule {
    /// Distances from the centre, in larger semi-axes, beyond which sixteen and four loads do.
    far: [f64; 2],
    /// Rays over all angles for points above the ellipse, over the angles of the ellipse for points beside it, and
    /// points on a ray.
    rays: [usize; 3],
}

/// For slender ellipses, errors up to 1e-4 of the peak pressure for a semi-axis of a quarter of the radius; for
/// others; and for pressures that count little: errors up to 5e-3 of their own peak.
const SLENDER: Rule = Rule {
    far: [1.5, 3.0],
    rays: [32, 28, 10],
};
const ROUND: Rule = Rule {
    far: [2.0, 4.0],
    rays: [16, 14, 8],
};
const ROUGH: Rule = Rule {
    far: [1.75, 2.5],
    rays: [12, 12, 5],
};
/// Ratio of the semi-axes of a slender ellipse.
const SLENDER_RATIO: f64 = 3.0;
/// Share of the pressure that errors are counted by, below which a pressure counts little.
const SMALL_SHARE: f64 = 0.15;

/// The quadratures of all pressures and surfaces.
pub struct CurvatureRules {
    slender: Rays,
    round: Rays,
    rough: Rays,
    sixteen: Loads,
    four: Loads,
}

/// A surface with constant curvatures, ready to correct the stress under pressures on it.
pub struct CurvedSurface<'a> {
    /// Curvatures along x and y, 1/m, positive where concave: the centre of curvature is outside the body.
    curvatures: [f64; 2],
    rules: &'a CurvatureRules,
}

/// Points by the quadrature they need.
#[derive(Default)]
struct Groups {
    above: Vec<usize>,
    beside: Vec<usize>,
    far: Vec<usize>,
    farther: Vec<usize>,
}

/// [`CurvedSurface::add_stresses`], to be compiled for the vectors of each kind of processor.
struct Addition<'a> {
    surface: &'a CurvedSurface<'a>,
    pressure: &'a EllipticPressure,
    scale: f64,
    points: &'a [[f64; 3]],
    stress: &'a mut [[f64; 6]],
}

impl WithSimd for Addition<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.surface
            .add_in_lanes(self.pressure, self.scale, self.points, self.stress);
    }
}

/// Points whose stress is being summed up.
pub(super) struct Target {
    /// [x, y, depth], m.
    point: [Lanes; 3],
    axes: [f64; 2],
    curvatures: [f64; 2],
    poisson_ratio: f64,
    sum: [Lanes; 6],
}

impl CurvatureRules {
    /// Points and weights.
    pub fn new() -> CurvatureRules {
        CurvatureRules {
            slender: Rays::new(SLENDER.rays),
            round: Rays::new(ROUND.rays),
            rough: Rays::new(ROUGH.rays),
            sixteen: Loads::sixteen(),
            four: Loads::four(),
        }
    }
}

impl Default for CurvatureRules {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> CurvedSurface<'a> {
    /// A surface with curvatures along x and y, 1/m, positive where concave.
    pub fn new(rules: &'a CurvatureRules, curvatures: [f64; 2]) -> CurvedSurface<'a> {
        CurvedSurface { curvatures, rules }
    }

    /// Adds what the curvatures change in the stress xx yy zz xy yz xz, Pa, `[n][6]`, of a pressure at points
    /// [x, y, depth], m, `[n][3]`; a negative depth counts as the surface. Errors count by the peak pressure `scale`,
    /// Pa: that of the pressure, or a larger one.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn add_stresses(
        &self,
        pressure: &EllipticPressure,
        scale: f64,
        points: &[[f64; 3]],
        stress: &mut [[f64; 6]],
    ) {
        assert_eq!(points.len(), stress.len(), "one stress per point");
        pulp::Arch::new().dispatch(Addition {
            surface: self,
            pressure,
            scale,
            points,
            stress,
        });
    }

    #[inline(always)]
    fn add_in_lanes(
        &self,
        pressure: &EllipticPressure,
        scale: f64,
        points: &[[f64; 3]],
        stress: &mut [[f64; 6]],
    ) {
        let axes = pressure.semi_axes;
        let (major, minor) = (axes[0].max(axes[1]), axes[0].min(axes[1]));
        let counts = pressure.peak > SMALL_SHARE * scale;
        let (far, rays) = match (counts, major > SLENDER_RATIO * minor) {
            (false, _) => (ROUGH.far, &self.rules.rough),
            (true, true) => (SLENDER.far, &self.rules.slender),
            (true, false) => (ROUND.far, &self.rules.round),
        };
        let groups = Groups::new(points, axes, far.map(|far| far * major));
        let directions = Directions::new(rays, axes);
        for own in groups.above.chunks(LANES) {
            let mut target = self.target(pressure, points, own);
            rays.above(&directions, &mut target);
            target.add_to(pressure, own, stress);
        }
        for own in groups.beside.chunks(LANES) {
            let mut target = self.target(pressure, points, own);
            rays.beside(axes, &mut target);
            target.add_to(pressure, own, stress);
        }
        for (group, loads) in [
            (&groups.far, &self.rules.sixteen),
            (&groups.farther, &self.rules.four),
        ] {
            for own in group.chunks(LANES) {
                let mut target = self.target(pressure, points, own);
                loads.add(&mut target);
                target.add_to(pressure, own, stress);
            }
        }
    }

    /// Some points; lanes without one repeat the first.
    #[inline(always)]
    fn target(&self, pressure: &EllipticPressure, points: &[[f64; 3]], own: &[usize]) -> Target {
        let mut point = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let [x, y, z] = points[own[if i < own.len() { i } else { 0 }]];
            (point[0][i], point[1][i], point[2][i]) = (x, y, z.max(0.0));
        }
        Target {
            point,
            axes: pressure.semi_axes,
            curvatures: self.curvatures,
            poisson_ratio: pressure.poisson_ratio,
            sum: [[0.0; LANES]; 6],
        }
    }
}

impl Groups {
    fn new(points: &[[f64; 3]], axes: [f64; 2], [far, farther]: [f64; 2]) -> Groups {
        let mut groups = Groups::default();
        for (i, &[x, y, z]) in points.iter().enumerate() {
            let (u, v) = (x / axes[0], y / axes[1]);
            let square = x * x + y * y + z * z;
            let group = if square > farther * farther {
                &mut groups.farther
            } else if square > far * far {
                &mut groups.far
            } else if u * u + v * v < 1.0 {
                &mut groups.above
            } else {
                &mut groups.beside
            };
            group.push(i);
        }
        groups
    }
}

impl Target {
    /// The feet of the points on the unit disc.
    #[inline(always)]
    pub fn foot(&self) -> [Lanes; 2] {
        let mut foot = [[0.0; LANES]; 2];
        for i in 0..LANES {
            foot[0][i] = self.point[0][i] / self.axes[0];
            foot[1][i] = self.point[1][i] / self.axes[1];
        }
        foot
    }

    /// Adds loads at places on the unit disc, with the integral of sqrt(1 - r^2) that each stands for.
    #[inline(always)]
    pub fn add(&mut self, at: &[Lanes; 2], weight: &Lanes) {
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
    fn add_to(&self, pressure: &EllipticPressure, own: &[usize], stress: &mut [[f64; 6]]) {
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
