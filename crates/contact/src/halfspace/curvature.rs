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

use pulp::{Simd, WithSimd};

use super::confocal::LANES;
use super::rays::{Directions, FarLoads, Rays};
use super::stress::EllipticPressure;
use super::target::Target;

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
    sixteen: FarLoads,
    four: FarLoads,
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

impl CurvatureRules {
    /// Points and weights.
    pub fn new() -> CurvatureRules {
        CurvatureRules {
            slender: Rays::new(SLENDER.rays),
            round: Rays::new(ROUND.rays),
            rough: Rays::new(ROUGH.rays),
            sixteen: FarLoads::sixteen(),
            four: FarLoads::four(),
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
        let axes = pressure.semi_axes.into();
        let (major, minor) = (pressure.semi_axes.major(), pressure.semi_axes.minor());
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
            axes: pressure.semi_axes.into(),
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
