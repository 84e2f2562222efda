//! Carlson's elliptic integrals of the second kind, in the pair that an ellipse needs.
//!
//! R_D(x, y, z) = 3/2 integral over 0..inf of dt / ((t + z) sqrt((t+x)(t+y)(t+z))). Duplication changes all three
//! arguments symmetrically, so R_D(x, y, z) and R_D(x, z, y) share it. Reference: Carlson (1995), Numerical
//! Algorithms 10, 13-26, doi:10.1007/BF02198293; NIST DLMF 19.26.18, 19.36.2.

use super::confocal::{LANES, PointLanes};

/// Relative distance of the arguments at which the series of fifth order is exact to the last bits.
const CLOSE: f64 = 2e-3;

/// Duplications that bring (0, b2, a2) together; any (l, b2 + l, a2 + l) with l > 0 is closer from the start.
pub(super) fn n_duplications(a2: f64, b2: f64) -> usize {
    let mut x = [0.0, b2, a2];
    let mut n = 0;
    loop {
        let mean = (x[0] + x[1] + x[2]) / 3.0;
        let far = x.iter().map(|xi| (xi - mean).abs()).fold(0.0, f64::max);
        if far <= CLOSE * mean {
            return n;
        }
        x = duplicate(x);
        n += 1;
    }
}

fn duplicate(x: [f64; 3]) -> [f64; 3] {
    let r = x.map(f64::sqrt);
    let shift = r[0] * r[1] + r[1] * r[2] + r[2] * r[0];
    x.map(|xi| 0.25 * (xi + shift))
}

/// [R_D(x, y, z), R_D(x, z, y)] after `n` duplications; x may be zero.
#[inline(always)]
pub(super) fn rd_pair(x: &PointLanes, y: &PointLanes, z: &PointLanes, n: usize) -> [PointLanes; 2] {
    let (mut x, mut y, mut z) = (*x, *y, *z);
    let mut sums = [[0.0; LANES]; 2];
    let mut power = 1.0;
    for _ in 0..n {
        for i in 0..LANES {
            let (rx, ry, rz) = (x[i].sqrt(), y[i].sqrt(), z[i].sqrt());
            let shift = rx * ry + rz * (rx + ry);
            sums[0][i] += power / (rz * (z[i] + shift));
            sums[1][i] += power / (ry * (y[i] + shift));
            x[i] = 0.25 * (x[i] + shift);
            y[i] = 0.25 * (y[i] + shift);
            z[i] = 0.25 * (z[i] + shift);
        }
        power *= 0.25;
    }
    let mut pair = [[0.0; LANES]; 2];
    for i in 0..LANES {
        pair[0][i] = 3.0 * sums[0][i] + power * series(x[i], y[i], z[i]);
        pair[1][i] = 3.0 * sums[1][i] + power * series(x[i], z[i], y[i]);
    }
    pair
}

/// R_D(x, y, z) for close arguments: the terms to fifth order of DLMF 19.36.2.
#[inline(always)]
fn series(x: f64, y: f64, z: f64) -> f64 {
    let mean = 0.2 * (x + y + 3.0 * z);
    let inverse = 1.0 / mean;
    let (dx, dy) = ((mean - x) * inverse, (mean - y) * inverse);
    let dz = -(dx + dy) / 3.0;
    let xy = dx * dy;
    let zz = dz * dz;
    let e2 = xy - 6.0 * zz;
    let e3 = (3.0 * xy - 8.0 * zz) * dz;
    let e4 = 3.0 * (xy - zz) * zz;
    let e5 = xy * zz * dz;
    let sum =
        1.0 - 3.0 / 14.0 * e2 + e3 / 6.0 + 9.0 / 88.0 * e2 * e2 - 3.0 / 22.0 * e4 - 9.0 / 52.0 * e2 * e3
            + 3.0 / 26.0 * e5;
    sum * inverse * inverse.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: every stress under an ellipse. Values: Carlson (1995), section 3: R_D(0, 2, 1) and R_D(2, 3, 4).
    #[test]
    fn rd_matches_published_values() {
        let n = n_duplications(4.0, 1.0);
        for (x, y, z, value) in [
            (0.0, 2.0, 1.0, 1.7972103521033883),
            (2.0, 3.0, 4.0, 0.16510527294261053),
        ] {
            let lanes = |v: f64| [v; LANES];
            let [direct, _] = rd_pair(&lanes(x), &lanes(y), &lanes(z), n);
            let [_, swapped] = rd_pair(&lanes(x), &lanes(z), &lanes(y), n);
            for found in [direct[0], swapped[LANES - 1]] {
                assert!(
                    (found / value - 1.0).abs() < 1e-14,
                    "{x} {y} {z}: {found}, {value}"
                );
            }
        }
    }
}
