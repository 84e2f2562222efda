//! Stress of a half-space under a semi-ellipsoidal pressure.

use std::f64::consts::PI;

use contact::halfspace::EllipticPressure;

use crate::quadrature;

const NU: f64 = 0.3;

fn unit(axes: [f64; 2]) -> EllipticPressure {
    EllipticPressure::of_peak(1.0, axes.into(), NU)
}

#[track_caller]
fn assert_same(what: &str, found: [f64; 6], expected: [f64; 6], tolerance: f64) {
    let error = (0..6).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max);
    assert!(
        error <= tolerance,
        "{what}: error {error:.2e} of p0\nfound    {found:?}\nexpected {expected:?}"
    );
}

/// Ellipses on all branches of the code, both orientations: circle, nearly circles, ball bearing, slender.
const ELLIPSES: [[f64; 2]; 8] = [
    [1.0, 1.0],
    [1.0, 1.0 - 1e-9],
    [1.0, 0.99],
    [1.0, 0.974],
    [0.97, 1.0],
    [1.0, 0.5],
    [0.12, 1.0],
    [1.0, 0.05],
];

/// Points below, in units of the semi-axes and the smaller one for the depth: under the centre, on both axes, off
/// them, inside, under the edge, outside, far away.
const PLACES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.6],
    [0.0, 0.0, 2.0],
    [0.7, 0.0, 0.5],
    [0.0, -0.8, 0.5],
    [0.5, 0.4, 0.45],
    [0.6, -0.8, 0.4],
    [-1.0, 0.0, 0.5],
    [1.3, 0.9, 0.5],
    [-2.0, 4.0, 3.0],
    [8.0, 20.0, 15.0],
];

/// Wrong: the closed forms, in any of six components, on or off the axes. The sum of point loads knows nothing of them.
#[test]
fn stress_is_the_sum_of_point_loads() {
    for axes in ELLIPSES {
        let depth = axes[0].min(axes[1]);
        for place in PLACES {
            let x = [place[0] * axes[0], place[1] * axes[1], place[2] * depth];
            let slender = depth < 0.3;
            let expected = quadrature::stress(axes, NU, x, if slender { [400, 1400] } else { [80, 500] });
            assert_same(
                &format!("{axes:?} at {place:?}"),
                unit(axes).stress(x),
                expected,
                1e-10,
            );
        }
    }
}

/// Wrong: the circular limit off the axis. Huber (1904), Annalen der Physik 319, 153-163; as in Johnson (1985), 3.4.
#[test]
fn a_circle_has_the_stress_of_huber() {
    let (a, circle) = (1.0f64, unit([1.0, 1.0]));
    for r in [1e-6, 0.2, 0.7, 1.0, 1.3, 3.0] {
        for z in [1e-9, 0.01, 0.3, 0.48, 1.0, 4.0] {
            let shift: f64 = r * r + z * z - a * a;
            let root = (shift * shift + 4.0 * a * a * z * z).sqrt();
            let u = if shift > 0.0 {
                0.5 * (shift + root)
            } else {
                2.0 * z * z / (root - shift)
            };
            let (k, su) = (z / u.sqrt(), u.sqrt());
            let poisson = (1.0 - 2.0 * NU) / 3.0 / (r * r) * (1.0 - k.powi(3));
            let bulk = u * (1.0 - NU) / (1.0 + u);
            let arc = (1.0 + NU) * su * (1.0 / su).atan();
            let denominator = u * u + z * z;
            let radial = poisson + k.powi(3) * u / denominator + k * (bulk + arc - 2.0);
            let hoop = -poisson - k * (2.0 * NU + bulk - arc);
            let expected = [
                radial,
                hoop,
                -k.powi(3) * u / denominator,
                0.0,
                0.0,
                -r * z * z / denominator * su / (1.0 + u),
            ];
            // Huber's first term subtracts equal numbers at small r.
            let tolerance = 1e-12 + 1e-15 / (r * r);
            assert_same(
                &format!("r {r}, z {z}"),
                circle.stress([r, 0.0, z]),
                expected,
                tolerance.min(2e-3),
            );
        }
    }
}

/// Wrong: the limit of a long ellipse, a roller's contact. McEwen (1949); Johnson (1985), eq. 4.49. At a/b = 1e7 the
/// ends are felt by some b/a.
#[test]
fn a_slender_ellipse_has_the_stress_of_a_line_contact() {
    let (b, slender) = (1.0f64, unit([1e7, 1.0]));
    for y in [-2.0, -1.0, -0.5, 0.0, 0.3, 0.9, 1.5] {
        for z in [1e-3, 0.1, 0.5, 0.786, 1.5, 4.0] {
            let q: f64 = b * b - y * y + z * z;
            let s = (q * q + 4.0 * y * y * z * z).sqrt();
            let m = if q > 0.0 {
                (0.5 * (s + q)).sqrt()
            } else {
                (2.0 * y * y * z * z / (s - q)).sqrt()
            };
            let n = y.signum() * (0.5 * (s - q)).max(0.0).sqrt();
            let share = (z * z + n * n) / (m * m + n * n);
            let (yy, zz) = (-(m * (1.0 + share) - 2.0 * z), -m * (1.0 - share));
            let yz = -n * (m * m - z * z) / (m * m + n * n);
            let expected = [NU * (yy + zz), yy, zz, 0.0, yz, 0.0];
            assert_same(
                &format!("y {y}, z {z}"),
                slender.stress([0.0, y, z]),
                expected,
                1e-6,
            );
        }
    }
}

/// Wrong: the limit itself. McEwen's formula against the sum of Flamant's line loads, sigma_r = -2/(pi r) cos(theta),
/// which only balances a load on every half circle.
#[test]
fn the_line_contact_is_the_sum_of_line_loads() {
    let slender = unit([1e7, 1.0]);
    let rule = quadrature::gauss_legendre(400);
    for y in [-1.5, 0.0, 0.3, 0.9] {
        for z in [0.2, 0.5, 0.786, 1.5] {
            let mut sum = [0.0; 3];
            for &(node, weight) in &rule {
                // y = sin t: the pressure cos t, its load cos^2 t dt.
                let t = 0.5 * PI * node;
                let (from, load) = (y - t.sin(), 0.5 * PI * weight * t.cos() * t.cos());
                let r2 = from * from + z * z;
                let stress = -2.0 / PI * load * z / (r2 * r2);
                sum[0] += stress * from * from;
                sum[1] += stress * z * z;
                sum[2] += stress * from * z;
            }
            let [yy, zz, yz] = sum;
            let expected = [NU * (yy + zz), yy, zz, 0.0, yz, 0.0];
            let what = format!("y {y}, z {z}");
            assert_same(&what, slender.stress([0.0, y, z]), expected, 1e-6);
        }
    }
}

/// Wrong: the surface, where cracks start: against the sum of point loads, at the centre, at the ends of both axes
/// and between.
#[test]
fn the_surface_is_the_sum_of_point_loads() {
    for axes in [[1.0, 1.0], [1.0, 0.99], [1.0, 0.5], [1.0, 0.12], [0.3, 1.0]] {
        for place in [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.0, -0.6],
            [0.4, 0.3],
            [-0.2, 0.7],
        ] {
            let [x, y] = [place[0] * axes[0], place[1] * axes[1]];
            let [xx, yy, zz, xy] = quadrature::surface_stress(axes, NU, [x, y]);
            let found = unit(axes).stress([x, y, 0.0]);
            let what = format!("{axes:?} at {place:?}");
            assert_same(&what, found, [xx, yy, zz, xy, 0.0, 0.0], 1e-8);
        }
    }
}

/// Wrong: the surface again, in closed form. Centre and ends of the axes: Johnson (1985), eq. 4.29 and 4.30.
#[test]
fn the_surface_has_its_closed_forms_at_centre_and_ends() {
    for (a, b) in [(1.0, 0.99f64), (1.0, 0.5), (1.0, 0.12), (2.0, 0.1)] {
        let ellipse = unit([a, b]);
        let (p, ratio) = (1.0 - 2.0 * NU, b / a);
        let e = (1.0f64 - ratio * ratio).sqrt();
        let centre = [
            -2.0 * NU - p * b / (a + b),
            -2.0 * NU - p * a / (a + b),
            -1.0,
            0.0,
            0.0,
            0.0,
        ];
        assert_same("centre", ellipse.stress([0.0; 3]), centre, 1e-14);
        let long = p * ratio / (e * e) * (e.atanh() / e - 1.0);
        let end = ellipse.stress([a, 0.0, 0.0]);
        assert_same(
            "end of the long axis",
            end,
            [long, -long, 0.0, 0.0, 0.0, 0.0],
            1e-8,
        );
        let short = p * ratio / (e * e) * (1.0 - ratio / e * (e / ratio).atan());
        let end = ellipse.stress([0.0, b, 0.0]);
        assert_same(
            "end of the short axis",
            end,
            [-short, short, 0.0, 0.0, 0.0, 0.0],
            1e-8,
        );
    }
}

/// Wrong: the added field would load the raceway where nothing touches it, or push with another pressure than the
/// contact's.
#[test]
fn the_surface_carries_the_pressure_and_nothing_else() {
    for axes in ELLIPSES {
        for i in -15..=15 {
            for j in -15..=15 {
                let place = [0.1 * i as f64, 0.1 * j as f64];
                let inside: f64 = 1.0 - place[0] * place[0] - place[1] * place[1];
                let s = unit(axes).stress([place[0] * axes[0], place[1] * axes[1], 0.0]);
                // The square root makes a rounding of the place into one of its root on the edge.
                let error = (s[2] + inside.max(0.0).sqrt()).abs();
                assert!(
                    error < 1e-7 && (inside.abs() < 1e-9 || error < 1e-13),
                    "{axes:?} {place:?}: {s:?}"
                );
                assert!(
                    s[4].abs() < 1e-7 && s[5].abs() < 1e-7,
                    "{axes:?} {place:?}: {s:?}"
                );
                assert!(s.iter().all(|x| x.is_finite()));
            }
        }
    }
}

/// Wrong: the field would need body forces. Divergence by central differences of fourth order; exact fields leave
/// only their error.
#[test]
fn stress_is_in_equilibrium() {
    for axes in ELLIPSES {
        let (ellipse, minor) = (unit(axes), axes[0].min(axes[1]));
        let h = 4e-3 * minor;
        for place in PLACES {
            let x = [place[0] * axes[0], place[1] * axes[1], place[2] * minor];
            let slope = |direction: usize, c: usize| {
                let at = |n: f64| {
                    let mut y = x;
                    y[direction] += n * h;
                    ellipse.stress(y)[c]
                };
                (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h)
            };
            let rows = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
            for row in rows {
                let divergence: f64 = (0..3).map(|j| slope(j, row[j])).sum();
                assert!(
                    (divergence * minor).abs() < 2e-8,
                    "{axes:?} at {place:?}: divergence {divergence:e} p0 per minor axis"
                );
            }
        }
    }
}

/// Wrong: the displacements that belong to the stress would not fit together (Beltrami-Michell: the sum of normal
/// stresses is harmonic).
#[test]
fn the_sum_of_normal_stresses_is_harmonic() {
    for axes in ELLIPSES {
        let (ellipse, minor) = (unit(axes), axes[0].min(axes[1]));
        let h = 1e-2 * minor;
        for place in PLACES {
            let x = [place[0] * axes[0], place[1] * axes[1], place[2] * minor];
            let sum = |y: [f64; 3]| ellipse.stress(y)[..3].iter().sum::<f64>();
            let mut laplacian = 0.0;
            for direction in 0..3 {
                let at = |n: f64| {
                    let mut y = x;
                    y[direction] += n * h;
                    sum(y)
                };
                laplacian +=
                    (16.0 * (at(1.0) + at(-1.0)) - (at(2.0) + at(-2.0)) - 30.0 * at(0.0)) / (12.0 * h * h);
            }
            assert!(
                (laplacian * minor * minor).abs() < 1e-5,
                "{axes:?} at {place:?}: {laplacian:e}"
            );
        }
    }
}

/// Wrong: far away an ellipse and a spread patch of the same force would differ by more than their second moments,
/// (size/distance)^4.
#[test]
fn far_away_only_the_force_counts() {
    let force = 1.0;
    let field = |axes: [f64; 2], r: f64| {
        EllipticPressure::of_force(force, axes.into(), NU).stress([0.6 * r, 0.48 * r, 0.64 * r])
    };
    let gap = |r: f64| {
        let (true_one, spread) = (field([0.3, 0.04], r), field([1.0, 0.8], r));
        (0..6)
            .map(|c| (true_one[c] - spread[c]).abs())
            .fold(0.0, f64::max)
    };
    let order = (gap(10.0) / gap(20.0)).log2();
    assert!((order - 4.0).abs() < 0.05, "{order}");
}

/// Wrong: a probe would show other bits than the field, or results depend on how points are shared among threads.
#[test]
fn the_stress_of_a_point_does_not_depend_on_its_neighbours() {
    for axes in ELLIPSES {
        let ellipse = unit(axes);
        let points: Vec<_> = PLACES
            .iter()
            .map(|p| [p[0] * axes[0], p[1] * axes[1], p[2]])
            .collect();
        let mut together = vec![[0.0; 6]; points.len()];
        ellipse.stresses(&points, &mut together);
        for (point, stress) in points.iter().zip(together) {
            assert_eq!(ellipse.stress(*point), stress);
        }
    }
}
