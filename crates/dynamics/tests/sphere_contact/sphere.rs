//! A solid sphere under normal loads on its surface, by a Legendre series.
//!
//! A field of degree n without load inside has two regular parts, in powers of the radius (radius and shear modulus 1):
//! U = n r^(n-1), V = r^(n-1), and U = A r^(n+1), V = B r^(n+1) with A (n + 5 - 4 nu) = B (n + 1)(n - 2 + 4 nu), of
//! the displacement U P_n along the radius and V dP_n/dt across it. Both together take a normal traction P_n without
//! shear. Degree 1 has no such field and is a rigid motion, which is left to the ball.
//!
//! A force is singular at its place as on the tangent plane, 1/(chord), and as the logarithm of the chord; what is
//! left is smooth, and its series is summed.

use std::f64::consts::PI;

use fem::Material;

/// Terms of the series.
const TERMS: usize = 6000;
/// Steps of the table of the smooth rest, in the angle.
const STEPS: usize = 1500;

/// Displacements of the surface under forces on it.
pub struct Sphere {
    /// Radius, m.
    radius: f64,
    /// (1 - nu^2) / (pi E), 1/Pa.
    pub plane: f64,
    /// Displacement of the logarithm of the chord over the diameter, m/N.
    logarithm: f64,
    /// The smooth rest at equal steps of the angle over 0..pi, m/N.
    rest: Vec<f64>,
}

/// A rectangle on the surface, its sides along the groove and in the rolling direction.
pub struct Rectangle {
    pub centre: [f64; 3],
    pub axes: [[f64; 3]; 2],
    pub sides: [f64; 2],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Motion inwards, in radii over the shear modulus, under the normal pressure P_n.
fn yields(n: usize, nu: f64) -> f64 {
    let lambda = 2.0 * nu / (1.0 - 2.0 * nu);
    if n == 0 {
        return 1.0 / (3.0 * lambda + 2.0);
    }
    if n == 1 {
        return 0.0;
    }
    let n = n as f64;
    let (a, b) = ((n + 1.0) * (n - 2.0 + 4.0 * nu), n + 5.0 - 4.0 * nu);
    // [stress along the radius, shear] of both parts; the second has a change of volume.
    let first = [2.0 * n * (n - 1.0), 2.0 * (n - 1.0)];
    let volume = (n + 3.0) * a - n * (n + 1.0) * b;
    let second = [lambda * volume + 2.0 * (n + 1.0) * a, n * b + a];
    // -1 along the radius, no shear.
    let determinant = first[0] * second[1] - first[1] * second[0];
    let (x, y) = (-second[1] / determinant, first[1] / determinant);
    -(x * n + y * a)
}

impl Sphere {
    pub fn new(material: &Material, radius: f64) -> Sphere {
        let nu = material.poisson_ratio;
        let shear = material.shear_modulus();
        let unit = 1.0 / (4.0 * PI * radius * shear);
        let plane = 2.0 * (1.0 - nu);
        let of_logarithm = (1.0 - 2.0 * nu).powi(2) / (2.0 * (1.0 - nu));
        let terms: Vec<f64> = (0..TERMS)
            .map(|n| {
                let logarithm = if n == 0 { 0.0 } else { of_logarithm / n as f64 };
                (2 * n + 1) as f64 * yields(n, nu) - plane * (1.0 + logarithm)
            })
            .collect();
        let rest = |step: usize| {
            let cos = (PI * step as f64 / STEPS as f64).cos();
            let (mut p, mut next, mut sum) = (1.0, cos, 0.0);
            for (n, term) in terms.iter().enumerate() {
                sum += term * p;
                let n = n as f64;
                (p, next) = (next, ((2.0 * n + 3.0) * cos * next - (n + 1.0) * p) / (n + 2.0));
            }
            // Of the logarithm's series, -ln(s + s^2) with s the chord over the diameter, the part that is smooth.
            let s = (0.5 * PI * step as f64 / STEPS as f64).sin();
            unit * (sum - plane * of_logarithm * s.ln_1p())
        };
        Sphere {
            radius,
            plane: (1.0 - nu * nu) / (PI * material.young_modulus),
            logarithm: -unit * plane * of_logarithm,
            rest: (0..=STEPS).map(rest).collect(),
        }
    }

    /// A ball that yields as half-spaces do.
    pub fn half_space(material: &Material, radius: f64) -> Sphere {
        Sphere {
            logarithm: 0.0,
            rest: vec![0.0; STEPS + 1],
            ..Sphere::new(material, radius)
        }
    }

    /// What a force at a chord adds to the motion inwards on a half-space, m/N.
    pub fn beyond_plane(&self, chord: f64) -> f64 {
        let share = (0.5 * chord / self.radius).min(1.0);
        let at = 2.0 * share.asin() / PI * STEPS as f64;
        let k = (at as usize).min(STEPS - 1);
        let t = at - k as f64;
        self.logarithm * share.ln() + (1.0 - t) * self.rest[k] + t * self.rest[k + 1]
    }

    /// Motion inwards opposite a force, m/N; none if the ball is half-spaces.
    pub fn across(&self, chord: f64) -> f64 {
        if self.logarithm == 0.0 {
            return 0.0;
        }
        self.plane / chord + self.beyond_plane(chord)
    }

    /// Mean motion inwards of a rectangle per force on another one, m/N.
    pub fn between(&self, at: &Rectangle, load: &Rectangle) -> f64 {
        let arm = [0, 1, 2].map(|i| at.centre[i] - load.centre[i]);
        let mut chord = dot(arm, arm).sqrt();
        let on_plane = self.plane * plane_mean(at, load, chord);
        // Mean of the logarithm of two points of a rectangle: that of 0.2235 times both its sides.
        chord = chord.max(0.2235 * (load.sides[0] + load.sides[1]));
        on_plane + self.beyond_plane(chord)
    }
}

/// Mean of 1/distance of the points of two rectangles, 1/m: of near ones that of their plane.
fn plane_mean(at: &Rectangle, load: &Rectangle, chord: f64) -> f64 {
    if chord > 5.0 * load.sides[0].max(load.sides[1]) {
        return 1.0 / chord;
    }
    let arm = [0, 1, 2].map(|i| at.centre[i] - load.centre[i]);
    let flat = load.axes.map(|axis| dot(arm, axis));
    let size = flat[0].hypot(flat[1]);
    let stretch = if size > 0.0 { chord / size } else { 1.0 };
    let gauss = fem::quadrature::quadrilateral(4);
    let mean = |point: &[f64; 2]| {
        let place = [0, 1].map(|k| stretch * flat[k] + 0.5 * at.sides[k] * point[k]);
        potential(load.sides, place) / (load.sides[0] * load.sides[1])
    };
    let points = gauss.points.iter().zip(&gauss.weights);
    points.map(|(point, weight)| 0.25 * weight * mean(point)).sum()
}

/// Integral of 1/distance over a rectangle about the origin (Love, Phil. Trans. R. Soc. A 228 (1929) 377), m.
fn potential(sides: [f64; 2], place: [f64; 2]) -> f64 {
    let corner = |x: f64, y: f64| {
        let r = x.hypot(y);
        let part = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        if r == 0.0 { 0.0 } else { part(x, y) + part(y, x) }
    };
    let [x0, x1] = [-0.5, 0.5].map(|s| s * sides[0] - place[0]);
    let [y0, y1] = [-0.5, 0.5].map(|s| s * sides[1] - place[1]);
    corner(x1, y1) - corner(x1, y0) - corner(x0, y1) + corner(x0, y0)
}

/// Wrong: a term of the series. Two opposite forces F at the ends of a diameter D change the volume of the ball by
/// -(1 - 2 nu) F D / E (Betti). A drop that keeps its volume yields to degree n by n (2 n + 1) over
/// 2 (n - 1)(2 n^2 + 4 n + 3), as the tides of an elastic globe do (Love, Theory of Elasticity, art. 184).
#[test]
fn the_sphere_of_the_series_shrinks_as_betti_says() {
    let steel = crate::support::steel();
    let radius = 4.5e-3;
    let sphere = Sphere::new(&steel, radius);
    let (n, mut volume) = (4000, 0.0);
    for i in 0..n {
        let angle = PI * (f64::from(i) + 0.5) / f64::from(n);
        let w = |chord: f64| sphere.plane / chord + sphere.beyond_plane(chord);
        let both = w(2.0 * radius * (0.5 * angle).sin()) + w(2.0 * radius * (0.5 * angle).cos());
        volume += 2.0 * PI * radius * radius * both * angle.sin() * PI / f64::from(n);
    }
    let expected = (1.0 - 2.0 * steel.poisson_ratio) * 2.0 * radius / steel.young_modulus;
    assert!((volume / expected - 1.0).abs() < 1e-4, "{volume} {expected}");
    for (n, order) in [(2, 2.0f64), (3, 3.0), (40, 40.0)] {
        let (found, square) = (yields(n, 0.5 - 1e-9), order * order);
        let love = order * (2.0 * order + 1.0) / (2.0 * (order - 1.0) * (2.0 * square + 4.0 * order + 3.0));
        assert!((found / love - 1.0).abs() < 1e-6, "{n}: {found} {love}");
    }
}

/// Wrong: forces on rectangles would be those on points, or their mean a value. Four quarters are the whole.
#[test]
fn rectangles_add_up() {
    let square = |x: f64, y: f64, side: f64| Rectangle {
        centre: [x, y, 0.0],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        sides: [side, side],
    };
    let whole = plane_mean(&square(0.0, 0.0, 2.0), &square(0.0, 0.0, 2.0), 0.0);
    let quarters = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(|[x, y]| square(x, y, 1.0));
    let mut sum = 0.0;
    for a in &quarters {
        for b in &quarters {
            let arm = [0, 1, 2].map(|i| a.centre[i] - b.centre[i]);
            sum += plane_mean(a, b, dot(arm, arm).sqrt()) / 16.0;
        }
    }
    // 4 ln(1 + sqrt 2) - 4/3 (sqrt 2 - 1) of a unit square.
    let exact = 0.5 * (4.0 * (1.0 + 2f64.sqrt()).ln() - 4.0 / 3.0 * (2f64.sqrt() - 1.0));
    assert!(
        (whole / exact - 1.0).abs() < 2e-3 && (sum / exact - 1.0).abs() < 2e-3,
        "{whole} {sum} {exact}"
    );
}
