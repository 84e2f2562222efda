//! Quadratures of a semi-ellipsoidal pressure about points near and far: where its parts are taken as point loads.
//!
//! **Near.** A kernel that falls as 1/rho has no singularity in polar coordinates about the foot of the point. The
//! ellipse is taken for the unit disc; then angles are stretched so that those across a slender ellipse get their
//! share, and along each ray r = r0 + (r1 - r0) sin^2 phi takes out the root of the pressure.
//!
//! **Far.** Two circles of eight loads, exact for polynomials of seventh degree: with v = r^2 the pressure is
//! sqrt(1 - v) dv, and v^2 - 8/9 v + 8/63 is orthogonal to what it must be. Further away four loads, exact for the
//! third degree.

use std::f64::consts::{FRAC_PI_2, PI};

use super::confocal::{LANES, PointLanes};
use super::target::Target;
use crate::quadrature::gauss_legendre;

/// Terms of the series of sine and cosine up to a right angle: error 4e-14.
const TERMS: usize = 10;

/// Rays about any foot.
pub(super) struct Rays {
    /// Number of angles over the full circle.
    n_round: usize,
    /// Sines of angles -pi/2..pi/2, and weights times the cosines.
    beside: Vec<(f64, f64)>,
    /// Shares sin^2 phi of a ray and weights.
    along: Vec<(f64, f64)>,
}

/// Rays from a foot inside a disc that was stretched.
pub(super) struct Directions {
    /// [cos, sin] and weight.
    rays: Vec<([f64; 2], f64)>,
}

/// Loads that do for all points far from the ellipse.
pub(super) struct FarLoads {
    /// Place on the unit disc and weight.
    loads: Vec<([f64; 2], f64)>,
}

impl Rays {
    /// Rays over the full circle, rays over the angles of the disc, and points on a ray.
    pub fn new([n_round, n_beside, n_along]: [usize; 3]) -> Rays {
        let along = gauss_legendre(n_along).into_iter().map(|(x, w)| {
            let (sin, cos) = (0.25 * PI * (x + 1.0)).sin_cos();
            (sin * sin, 0.5 * PI * w * sin * cos)
        });
        let beside = gauss_legendre(n_beside).into_iter().map(|(x, w)| {
            let (sin, cos) = (FRAC_PI_2 * x).sin_cos();
            (sin, FRAC_PI_2 * w * cos)
        });
        Rays {
            n_round,
            beside: beside.collect(),
            along: along.collect(),
        }
    }

    /// Adds the loads for points whose feet are inside the disc.
    #[inline(always)]
    pub fn above(&self, directions: &Directions, target: &mut Target) {
        let foot = target.foot();
        for ([cos, sin], weight) in &directions.rays {
            self.ray(&foot, &[[*cos; LANES], [*sin; LANES]], &[*weight; LANES], target);
        }
    }

    /// Adds the loads for points whose feet are outside the disc, whose stretched axes are `axes`: along the rays
    /// that meet it.
    #[inline(always)]
    pub fn beside(&self, axes: [f64; 2], target: &mut Target) {
        let (foot, stretch) = (target.foot(), (axes[0] / axes[1]).sqrt());
        let (mut middle, mut half) = ([[0.0; LANES]; 2], [0.0; LANES]);
        for i in 0..LANES {
            let (x, y) = (foot[0][i], foot[1][i]);
            let (centre, width) = ((-y).atan2(-x), (1.0 / (x * x + y * y).sqrt()).min(1.0).asin());
            let [first, last] = [centre - width, centre + width].map(|angle| shrunk(angle, stretch));
            let (sin, cos) = (0.5 * (first + last)).sin_cos();
            (middle[0][i], middle[1][i], half[i]) = (cos, sin, 0.5 * (last - first));
        }
        for &(share, own) in &self.beside {
            let (mut direction, mut weight) = ([[0.0; LANES]; 2], [0.0; LANES]);
            let mut from_middle = half;
            from_middle.iter_mut().for_each(|angle| *angle *= share);
            let turned = turns(&from_middle);
            for i in 0..LANES {
                let (c, s) = (turned[0][i], turned[1][i]);
                let cos = middle[0][i] * c - middle[1][i] * s;
                let sin = stretch * (middle[1][i] * c + middle[0][i] * s);
                let length2 = cos * cos + sin * sin;
                let over = 1.0 / length2.sqrt();
                (direction[0][i], direction[1][i]) = (cos * over, sin * over);
                weight[i] = half[i] * own * stretch / length2;
            }
            self.ray(&foot, &direction, &weight, target);
        }
    }

    /// Adds the loads on one ray from each foot, of a weight in angle.
    #[inline(always)]
    fn ray(
        &self,
        foot: &[PointLanes; 2],
        direction: &[PointLanes; 2],
        weight: &PointLanes,
        target: &mut Target,
    ) {
        let (mut back, mut start, mut end) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let (x, y) = (foot[0][i], foot[1][i]);
            let m = x * direction[0][i] + y * direction[1][i];
            // A ray that misses the disc by a rounding has no length.
            let root = (m * m + 1.0 - x * x - y * y).max(0.0).sqrt();
            back[i] = -m - root;
            start[i] = back[i].max(0.0);
            end[i] = (root - m).max(start[i]);
        }
        for &(share, own) in &self.along {
            let (mut at, mut loads) = ([[0.0; LANES]; 2], [0.0; LANES]);
            for i in 0..LANES {
                let length = end[i] - start[i];
                let r = start[i] + length * share;
                let pressure = ((end[i] - r) * (r - back[i])).max(0.0).sqrt();
                loads[i] = weight[i] * own * length * pressure * r;
                at[0][i] = foot[0][i] + r * direction[0][i];
                at[1][i] = foot[1][i] + r * direction[1][i];
            }
            target.add(&at, &loads);
        }
    }
}

impl Directions {
    /// For an ellipse of semi-axes `axes`.
    pub fn new(rays: &Rays, axes: [f64; 2]) -> Directions {
        let (stretch, step) = ((axes[0] / axes[1]).sqrt(), 2.0 * PI / rays.n_round as f64);
        let ray = |i: usize| {
            let (sin, cos) = ((i as f64 + 0.5) * step).sin_cos();
            let length2 = cos * cos + stretch * stretch * sin * sin;
            let over = 1.0 / length2.sqrt();
            ([cos * over, stretch * sin * over], step * stretch / length2)
        };
        Directions {
            rays: (0..rays.n_round).map(ray).collect(),
        }
    }
}

impl FarLoads {
    /// Sixteen loads, of seventh degree.
    pub fn sixteen() -> FarLoads {
        let root = (64.0f64 / 81.0 - 32.0 / 63.0).sqrt();
        let v = [4.0 / 9.0 + 0.5 * root, 4.0 / 9.0 - 0.5 * root];
        // Weights that give 1 and the mean of v, 2/5.
        let outer = (0.4 - v[1]) / root;
        FarLoads {
            loads: [circle(8, v[0], outer), circle(8, v[1], 1.0 - outer)].concat(),
        }
    }

    /// Four loads, of third degree.
    pub fn four() -> FarLoads {
        FarLoads {
            loads: circle(4, 0.4, 1.0),
        }
    }

    /// Adds the loads.
    #[inline(always)]
    pub fn add(&self, target: &mut Target) {
        for ([x, y], weight) in &self.loads {
            target.add(&[[*x; LANES], [*y; LANES]], &[*weight; LANES]);
        }
    }
}

/// Equal loads on a circle of a squared radius, with their share of the pressure, whose integral is 2 pi/3.
fn circle(n: usize, square: f64, share: f64) -> Vec<([f64; 2], f64)> {
    let load = |i: usize| {
        let (sin, cos) = (2.0 * PI * (i as f64 + 0.5) / n as f64).sin_cos();
        let radius = square.sqrt();
        ([radius * cos, radius * sin], 2.0 * PI / 3.0 * share / n as f64)
    };
    (0..n).map(load).collect()
}

/// [cos, sin] of angles up to a right angle, by their series, which vectors can do.
#[inline(always)]
fn turns(angles: &PointLanes) -> [PointLanes; 2] {
    let (mut cos, mut sin) = ([1.0; LANES], [1.0; LANES]);
    for k in (1..=TERMS).rev() {
        let k = k as f64;
        let (even, odd) = (
            1.0 / ((2.0 * k - 1.0) * 2.0 * k),
            1.0 / (2.0 * k * (2.0 * k + 1.0)),
        );
        for i in 0..LANES {
            let square = angles[i] * angles[i];
            cos[i] = 1.0 - even * square * cos[i];
            sin[i] = 1.0 - odd * square * sin[i];
        }
    }
    for i in 0..LANES {
        sin[i] *= angles[i];
    }
    [cos, sin]
}

/// The angle whose tangent is 1/q of that of `angle`, continuous in it.
fn shrunk(angle: f64, q: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let turn = (sin * cos - q * sin * cos).atan2(q * cos * cos + sin * sin);
    angle + turn
}
