//! A hollow ball as a spherical shell under normal tractions on its outer surface.
//!
//! A field of degree n without load inside is U(r) P_n along the radius and V(r) dP_n/dt across it. Of the powers U =
//! alpha r^k and V = beta r^k four have equilibrium (Lurie, Theory of Elasticity, 2005, section 8.3):
//!
//! ```text
//! k = n - 1:   (n, 1)                                    k = n + 1:  ((n + 1)(n - 2 + 4 nu), n + 5 - 4 nu)
//! k = -n - 2:  (-(n + 1), 1)                             k = -n:     (n (n + 3 - 4 nu), 4 - n - 4 nu)
//! ```
//!
//! the second line from the first by n -> -n - 1. With the shear modulus and the outer radius 1, L = 2 nu/(1 - 2 nu),
//! such a power has on spheres the stress
//!
//! ```text
//! [L ((k + 2) alpha - n (n + 1) beta) + 2 k alpha, (k - 1) beta + alpha] r^(k - 1)
//! ```
//!
//! along the radius, of P_n, and across it, of dP_n/dt. A pressure P_n outside and nothing inside gives the four parts.
//! The singular ones fade as (inner over outer radius)^(2 n + 1): for large n the shell is the solid ball.
//!
//! Degree 0 is Lame's. Degree 1 has a resultant, which accelerates the ball: a uniform body force frees both parts
//! of r^2, and a translation puts the centre of mass where it was.

/// Product of the singular parts below which a degree is that of a solid ball.
const NEGLIGIBLE: f64 = 1e-22;

/// A power of the radius, (k; alpha, beta).
#[derive(Clone, Copy)]
struct Power {
    exponent: i32,
    parts: [f64; 2],
}

/// By how much the surface of a shell is pressed in against its centre of mass per unit of the pressure P_n, in outer
/// radii over the shear modulus; None where the cavity cannot be felt. `ratio` is the inner radius over the outer one.
pub fn pressed_in(n: u32, poisson_ratio: f64, ratio: f64) -> Option<f64> {
    let nu = poisson_ratio;
    let cube = ratio.powi(3);
    if n == 0 {
        // Lame, with E = 2 (1 + nu) G.
        return Some((1.0 - 2.0 * nu + 0.5 * (1.0 + nu) * cube) / (2.0 * (1.0 + nu) * (1.0 - cube)));
    }
    let degree = i32::try_from(n).unwrap_or(i32::MAX / 4);
    if ratio.powi(2 * degree) < NEGLIGIBLE {
        return None;
    }
    let (regular, singular) = (regular(degree, nu), singular(degree, nu));
    let stress = |powers: [Power; 2], scales: [f64; 2]| {
        let columns = [0, 1].map(|j| traction(degree, nu, powers[j]).map(|s| s * scales[j]));
        [0, 1].map(|i| [columns[0][i], columns[1][i]])
    };
    // Regular parts have size 1 outside, the stress of singular ones has it inside.
    let inwards = regular.map(|power| ratio.powi(power.exponent - 1));
    let outwards = singular.map(|power| ratio.powi(1 - power.exponent));
    let cavity = solve(stress(singular, [1.0; 2]), stress(regular, inwards));
    let (outer, from_cavity) = (
        stress(regular, [1.0; 2]),
        product(stress(singular, outwards), cavity),
    );
    let sums = [0, 1].map(|i| [0, 1].map(|j| outer[i][j] - from_cavity[i][j]));
    let found = solve(sums, [[-1.0, 0.0], [0.0, 0.0]]);
    let first = [found[0][0], found[1][0]];
    let second = [0, 1].map(|i| -(cavity[i][0] * first[0] + cavity[i][1] * first[1]));
    let moved = |i: usize| first[i] * regular[i].parts[0] + second[i] * outwards[i] * singular[i].parts[0];
    let mut inward = -(moved(0) + moved(1));
    if n == 1 {
        let of = |power: Power, ratio: f64| (power.parts[0] + 2.0 * power.parts[1]) * mean(power, ratio);
        let parts = [0, 1]
            .map(|i| first[i] * of(regular[i], ratio) + second[i] * outwards[i] * of(singular[i], ratio));
        inward += (parts[0] + parts[1]) / (1.0 - cube);
    }
    Some(inward)
}

fn regular(n: i32, nu: f64) -> [Power; 2] {
    let power = |exponent: i32, parts: [f64; 2]| Power { exponent, parts };
    if n == 1 {
        return [power(2, [1.0, 0.0]), power(2, [0.0, 1.0])];
    }
    let n_f = f64::from(n);
    [
        power(n - 1, [n_f, 1.0]),
        power(
            n + 1,
            [(n_f + 1.0) * (n_f - 2.0 + 4.0 * nu), n_f + 5.0 - 4.0 * nu],
        ),
    ]
}

fn singular(n: i32, nu: f64) -> [Power; 2] {
    let n_f = f64::from(n);
    let power = |exponent: i32, parts: [f64; 2]| Power { exponent, parts };
    [
        power(-n - 2, [-(n_f + 1.0), 1.0]),
        power(-n, [n_f * (n_f + 3.0 - 4.0 * nu), 4.0 - n_f - 4.0 * nu]),
    ]
}

/// Stress along and across the radius where r^(k - 1) is 1.
fn traction(n: i32, nu: f64, Power { exponent, parts }: Power) -> [f64; 2] {
    let (n, k, [alpha, beta]) = (f64::from(n), f64::from(exponent), parts);
    let volume = (k + 2.0) * alpha - n * (n + 1.0) * beta;
    [
        2.0 * nu / (1.0 - 2.0 * nu) * volume + 2.0 * k * alpha,
        (k - 1.0) * beta + alpha,
    ]
}

/// Integral of r^(k + 2) over the wall; none where k is -3, which moves no centre of mass.
fn mean(power: Power, ratio: f64) -> f64 {
    match power.exponent + 3 {
        0 => 0.0,
        sum => (1.0 - ratio.powi(sum)) / f64::from(sum),
    }
}

/// The matrix X of A X = B.
fn solve(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let inverse = [[a[1][1], -a[0][1]], [-a[1][0], a[0][0]]].map(|row| row.map(|x| x / determinant));
    product(inverse, b)
}

fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

#[cfg(test)]
mod tests;
