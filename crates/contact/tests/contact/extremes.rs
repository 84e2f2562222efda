//! The largest stresses below a contact.

use contact::halfspace::{EllipticPressure, Extreme, subsurface};
use fem::stress::{principal, von_mises};

use crate::quadrature;

const NU: f64 = 0.3;

/// A number of a stress tensor.
type Measure<'a> = &'a dyn Fn([f64; 6]) -> f64;

#[track_caller]
fn assert_extreme(what: &str, found: Extreme, [stress, depth]: [f64; 2], tolerance: f64) {
    let close = |x: f64, y: f64| (x - y).abs() <= tolerance;
    assert!(
        close(found.over_peak_pressure, stress) && close(found.depth_over_minor_axis, depth),
        "{what}: {found:?}, expected {stress} at {depth}"
    );
}

/// Wrong: size or depth of the largest shear. Johnson (1985), table 4.1, for Poisson's ratio 0.3: its printed depths
/// are off by up to 0.006 where the sum of point loads (below) confirms ours to 1e-6; its shear is not.
#[test]
fn maximum_shear_is_that_of_the_table() {
    for (ratio, depth, shear) in [
        (0.2, 0.745, 0.322),
        (0.4, 0.665, 0.325),
        (0.6, 0.590, 0.323),
        (0.8, 0.530, 0.317),
        (1.0, 0.480, 0.310),
    ] {
        let found = subsurface([1.0, ratio].into(), NU).maximum_shear;
        assert!(
            (found.over_peak_pressure - shear).abs() < 1e-3,
            "b/a = {ratio}: {found:?}"
        );
        assert!(
            (found.depth_over_minor_axis - depth).abs() < 7e-3,
            "b/a = {ratio}: {found:?}"
        );
    }
}

/// Wrong: the closed forms of lines: maximum shear 0.300 p0 at 0.786 b (Johnson 1985, 4.2). On the axis
/// (sigma_y - sigma_z)/2 = p0 (z - z^2/sqrt(b^2 + z^2))/b, largest where (1 + z^2)^1.5 = z (2 + z^2).
#[test]
fn a_line_has_its_largest_shear_in_closed_form() {
    let (mut low, mut high) = (0.5f64, 1.0f64);
    for _ in 0..60 {
        let z = 0.5 * (low + high);
        if (1.0 + z * z).powf(1.5) > z * (2.0 + z * z) {
            low = z
        } else {
            high = z
        }
    }
    let shear = low - low * low / (1.0 + low * low).sqrt();
    assert!(
        (low - 0.786).abs() < 5e-4 && (shear - 0.300).abs() < 5e-4,
        "{low} {shear}"
    );
    assert_extreme(
        "line",
        subsurface([1e7, 1.0].into(), NU).maximum_shear,
        [shear, low],
        1e-6,
    );
}

/// Wrong: the circle. On its axis sigma_r - sigma_z = 3/2/(1 + z^2) - (1 + nu)(1 - z arctan(1/z)) (Johnson 1985, eq.
/// 3.45); both the shear, half of it, and von Mises stress are largest where it is.
#[test]
fn a_circle_has_its_largest_stresses_in_closed_form() {
    let difference = |z: f64| 1.5 / (1.0 + z * z) - (1.0 + NU) * (1.0 - z * (1.0 / z).atan());
    let slope =
        |z: f64| -3.0 * z / (1.0 + z * z).powi(2) + (1.0 + NU) * ((1.0 / z).atan() - z / (1.0 + z * z));
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let z = 0.5 * (low + high);
        if slope(z) > 0.0 { low = z } else { high = z }
    }
    let found = subsurface([1.0, 1.0].into(), NU);
    assert_extreme("shear", found.maximum_shear, [0.5 * difference(low), low], 1e-6);
    assert_extreme("von Mises", found.von_mises, [difference(low), low], 1e-6);
}

/// Wrong: an ellipse between, those of the table above among them. The sum of point loads has the same values there,
/// and its slope vanishes at the same depth: with a curvature of about 1 the depth is right to 1e-6 if the difference
/// quotient is below.
#[test]
fn an_ellipse_has_its_largest_stresses_where_the_sum_of_point_loads_has_them() {
    for axes in [
        [1.0, 1.0],
        [1.0, 0.8],
        [1.0, 0.6],
        [1.0, 0.4],
        [1.0, 0.2],
        [1.0, 0.12],
        [0.3, 1.0],
    ] {
        let minor = f64::min(axes[0], axes[1]);
        let found = subsurface(axes.into(), NU);
        let shear = |s: [f64; 6]| {
            let s = principal(s);
            0.5 * (s[0] - s[2])
        };
        let measures: [(Extreme, Measure<'_>); 2] = [
            (found.maximum_shear, &shear),
            (found.von_mises, &|s| von_mises(s)),
        ];
        for (extreme, measure) in measures {
            let at = |z: f64| measure(quadrature::stress(axes, NU, [0.0, 0.0, z * minor], [300, 400]));
            let z = extreme.depth_over_minor_axis;
            assert!(
                (at(z) - extreme.over_peak_pressure).abs() < 1e-9,
                "{axes:?}: {extreme:?}, {}",
                at(z)
            );
            let (low, high, h) = (at(z - 1e-3), at(z + 1e-3), 1e-3);
            let (slope, curvature) = ((high - low) / (2.0 * h), (high - 2.0 * at(z) + low) / (h * h));
            assert!(
                (slope / curvature).abs() < 1e-6,
                "{axes:?}: {extreme:?}, {}",
                slope / curvature
            );
        }
    }
}

/// Wrong: the orthogonal shear on which Lundberg and Palmgren's life rests. With b/a = sqrt((t^2 - 1)(2 t - 1)) it is
/// p0 sqrt(2 t - 1)/(2 t (t + 1)) at the depth b/((t + 1) sqrt(2 t - 1)) (Harris, 4th ed., eq. 6.71 to 6.73).
#[test]
fn orthogonal_shear_is_that_of_lundberg_and_palmgren() {
    for t in [1.0000001f64, 1.02, 1.1, 1.15] {
        let ratio = ((t * t - 1.0) * (2.0 * t - 1.0)).sqrt();
        let expected = [
            (2.0 * t - 1.0).sqrt() / (2.0 * t * (t + 1.0)),
            1.0 / ((t + 1.0) * (2.0 * t - 1.0).sqrt()),
        ];
        assert_extreme(
            &format!("b/a = {ratio}"),
            subsurface([1.0, ratio].into(), NU).orthogonal_shear,
            expected,
            1e-6,
        );
    }
    // The same numbers are in the field itself: a scan of it finds nothing larger.
    let axes = [1.0, 0.12];
    let (found, field) = (
        subsurface(axes.into(), NU).orthogonal_shear,
        EllipticPressure::of_peak(1.0, axes.into(), NU),
    );
    let mut largest = 0.0f64;
    for i in 0..400 {
        for j in 0..200 {
            let s = field.stress([0.0, 0.12 * 0.005 * i as f64, 0.12 * 0.005 * j as f64]);
            largest = largest.max(s[4].abs());
        }
    }
    assert!(
        largest <= found.over_peak_pressure && largest > found.over_peak_pressure - 1e-4,
        "{largest} {found:?}"
    );
}
