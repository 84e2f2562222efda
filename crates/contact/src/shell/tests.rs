//! Shells against Lame, the solid ball, and finite elements along the radius.

use super::*;

const NU: f64 = 0.3;

/// Of a solid sphere, Lurie's closed form.
fn solid(n: u32) -> f64 {
    let n_f = f64::from(n);
    match n {
        1 => 0.3 * (1.0 - 2.0 * NU) / (1.0 + NU),
        _ => {
            (2.0 * n_f * n_f * (1.0 - NU) + n_f * NU - 1.0 + 2.0 * NU)
                / (2.0 * (n_f - 1.0) * (n_f * n_f + n_f + 1.0 + (2.0 * n_f + 1.0) * NU))
        }
    }
}

/// Wrong: the shell does not become the solid ball, for a small cavity or a high degree.
#[test]
fn a_small_cavity_leaves_the_solid_ball() {
    for n in 0..40 {
        let found = pressed_in(n, NU, 1e-4).unwrap_or(solid(n));
        assert!((found / solid(n) - 1.0).abs() < 1e-11, "{n}: {found}");
    }
    for (n, ratio) in [(40, 0.6), (100, 0.8), (2000, 0.99)] {
        let found = pressed_in(n, NU, ratio).unwrap();
        assert!((found / solid(n) - 1.0).abs() < 1e-8, "{n}: {found}");
    }
    assert_eq!(pressed_in(200, NU, 0.5), None);
}

/// Wrong: Lame's shell under a uniform pressure outside. Timoshenko and Goodier, Theory of Elasticity, 3rd ed.,
/// section 136: u = p a [(1 - 2 nu) a^3 + (1 + nu) b^3/2]/[E (a^3 - b^3)]; a thin wall t has p a^2 (1 - nu)/(2 E t).
#[test]
fn uniform_pressure_squeezes_a_shell_as_lame_says() {
    let young = 2.0 * (1.0 + NU);
    let thick = pressed_in(0, NU, 0.5).unwrap();
    let expected = ((1.0 - 2.0 * NU) + (1.0 + NU) / 16.0) / (young * 0.875);
    assert!((thick / expected - 1.0).abs() < 1e-14);
    let thin = pressed_in(0, NU, 0.999).unwrap();
    assert!(
        (thin * 2.0 * young * 1e-3 / (1.0 - NU) - 1.0).abs() < 5e-3,
        "{thin}"
    );
}

/// Wrong: a part of the field, its stress, or the body force of degree 1. Finite elements in U and V along the radius,
/// whose energy knows nothing of the powers: linear ones, extrapolated from two meshes.
#[test]
fn degrees_are_those_of_finite_elements_along_the_radius() {
    for ratio in [0.3, 0.6, 0.8] {
        for n in [1, 2, 3, 5, 9] {
            let [coarse, fine] = [100, 200].map(|elements| by_elements(n, ratio, elements));
            let expected = (4.0 * fine - coarse) / 3.0;
            let found = pressed_in(n, NU, ratio).unwrap();
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "{n} {ratio}: {found} {expected}"
            );
        }
    }
}

/// The energy of a degree over its norm is the integral of
/// r^2 [L/2 (U' + s)^2 + U'^2 + s^2/2 + m V^2/(2 r^2) + q g^2/2], with s = (2 U - q V)/r, g = V' - V/r + U/r,
/// q = n (n + 1), m = q (n - 1)(n + 2): pressed by -1 outside.
fn by_elements(n: u32, ratio: f64, elements: usize) -> f64 {
    let n = f64::from(n);
    let (q, lambda) = (n * (n + 1.0), 2.0 * NU / (1.0 - 2.0 * NU));
    let m = q * (n - 1.0) * (n + 2.0);
    let (h, size) = ((1.0 - ratio) / elements as f64, 2 * (elements + 1));
    let mut matrix = vec![vec![0.0; size]; size];
    let (mut load, mut volume) = (vec![0.0; size], vec![0.0; size]);
    for e in 0..elements {
        for (s, weight) in [
            (0.5 - 0.75f64.sqrt() / 3.0, 0.5),
            (0.5 + 0.75f64.sqrt() / 3.0, 0.5),
        ] {
            let r = ratio + h * (e as f64 + s);
            // Rows over [U0, V0, U1, V1].
            let (a, b, d) = (1.0 - s, s, 1.0 / h);
            let strain = [-d, 0.0, d, 0.0];
            let side = [2.0 * a / r, -q * a / r, 2.0 * b / r, -q * b / r];
            let shear = [a / r, -d - a / r, b / r, d - b / r];
            let along = [0.0, a / r, 0.0, b / r];
            let w = weight * h * r * r;
            for i in 0..4 {
                for j in 0..4 {
                    let both = (strain[i] + side[i]) * (strain[j] + side[j]);
                    matrix[2 * e + i][2 * e + j] += w
                        * (lambda * both
                            + 2.0 * strain[i] * strain[j]
                            + side[i] * side[j]
                            + m * along[i] * along[j]
                            + q * shear[i] * shear[j]);
                }
                volume[2 * e + i] += w * [a, 2.0 * a, b, 2.0 * b][i];
            }
        }
    }
    load[size - 2] = -1.0;
    if n == 1.0 {
        // The body force that the pressure accelerates, and one displacement held.
        let whole: f64 = volume.iter().sum();
        (0..size).for_each(|i| load[i] += volume[i] / whole);
        matrix[size - 1] = vec![0.0; size];
        (matrix[size - 1][size - 1], load[size - 1]) = (1.0, 0.0);
    }
    let u = solved(matrix, load);
    let whole: f64 = volume.iter().sum();
    let centre = volume.iter().zip(&u).map(|(v, u)| v * u).sum::<f64>() / whole;
    if n == 1.0 {
        centre - u[size - 2]
    } else {
        -u[size - 2]
    }
}

/// Gauss within the band of two elements.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let size = b.len();
    for p in 0..size {
        let row = a[p].clone();
        for i in p + 1..size.min(p + 4) {
            let factor = a[i][p] / row[p];
            (p..size.min(p + 4)).for_each(|j| a[i][j] -= factor * row[j]);
            b[i] -= factor * b[p];
        }
    }
    for p in (0..size).rev() {
        let sum: f64 = (p + 1..size.min(p + 4)).map(|j| a[p][j] * b[j]).sum();
        b[p] = (b[p] - sum) / a[p][p];
    }
    b
}
