//! Invariants of a stress tensor.

/// Rotations after which Jacobi's method has converged to round-off from any start (usually 2 or 3 suffice).
const MAX_SWEEPS: usize = 12;

/// Von Mises stress, Pa, from stress in the order xx yy zz xy yz xz.
pub fn von_mises(stress: [f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

/// Principal stresses, Pa, descending, from stress in the order xx yy zz xy yz xz.
///
/// Cyclic Jacobi rotations: unlike the trigonometric solution they keep their accuracy when two values are close
/// (Golub and Van Loan, Matrix Computations, 4th ed., 2013, section 8.5).
pub fn principal(stress: [f64; 6]) -> [f64; 3] {
    let [xx, yy, zz, xy, yz, xz] = stress;
    let mut s = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    for _ in 0..MAX_SWEEPS {
        if s[0][1] == 0.0 && s[1][2] == 0.0 && s[0][2] == 0.0 {
            break;
        }
        for [p, q] in [[0, 1], [1, 2], [0, 2]] {
            rotate(&mut s, p, q);
        }
    }
    let mut values = [s[0][0], s[1][1], s[2][2]];
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// One Jacobi rotation that makes entry (p, q) zero.
fn rotate(s: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let off = s[p][q];
    if off == 0.0 {
        return;
    }
    let r = 3 - p - q;
    let ratio = (s[q][q] - s[p][p]) / (2.0 * off);
    let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    s[p][p] -= tangent * off;
    s[q][q] += tangent * off;
    let (rp, rq) = (s[r][p], s[r][q]);
    s[p][q] = 0.0;
    s[q][p] = 0.0;
    s[r][p] = cosine * rp - sine * rq;
    s[p][r] = s[r][p];
    s[r][q] = sine * rp + cosine * rq;
    s[q][r] = s[r][q];
}
