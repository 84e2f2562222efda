//! The confocal coordinate of a point about an ellipse, for a few points at once.
//!
//! lambda >= 0 is the largest root of `x^2/(a^2 + l) + y^2/(b^2 + l) + z^2/l = 1`: the ellipsoid with these semi-axes
//! squared that is confocal with the ellipse goes through the point. It is 0 on the ellipse itself.

/// Points that are worked on together, so that the compiler uses vector instructions.
pub(super) const LANES: usize = 8;
/// One number per point.
pub(super) type PointLanes = [f64; LANES];

/// Relative change at which the iteration has converged: it is quadratic.
const CONVERGED: f64 = 1e-13;
/// More rounds than any point of any ellipse needs.
const MAX_ROUNDS: usize = 60;

/// lambda of points with squared coordinates, for squared semi-axes `a2 >= b2`, all in the same unit.
///
/// Each round replaces k(l) = 1 - x^2/(a^2 + l) - y^2/(b^2 + l), which is concave, by its tangent and solves the
/// quadratic l k(l) = z^2. The tangent lies above k, so the roots approach from below, also at the edge of the
/// ellipse, where the root is double. The start takes the larger of two lower bounds: both terms with a^2, and the
/// second term alone. A lane that has converged is frozen: its number does not depend on its neighbours.
#[inline(always)]
pub(super) fn confocal([x2, y2, z2]: &[PointLanes; 3], a2: f64, b2: f64) -> PointLanes {
    let mut lambda = [0.0; LANES];
    for i in 0..LANES {
        let both = oblate(x2[i] + y2[i], z2[i], a2);
        lambda[i] = both.max(oblate(y2[i], z2[i], b2));
    }
    let mut done = [false; LANES];
    for _ in 0..MAX_ROUNDS {
        let mut all = true;
        for i in 0..LANES {
            let (u, v) = (1.0 / (a2 + lambda[i]), 1.0 / (b2 + lambda[i]));
            let value = 1.0 - x2[i] * u - y2[i] * v;
            let slope = x2[i] * u * u + y2[i] * v * v;
            let next = root(slope, value - slope * lambda[i], z2[i]);
            let converged = done[i] || (next - lambda[i]).abs() <= CONVERGED * next;
            lambda[i] = if done[i] { lambda[i] } else { next };
            done[i] = converged;
            all &= converged;
        }
        if all {
            break;
        }
    }
    lambda
}

/// The root for equal semi-axes: r^2/(a^2 + l) + z^2/l = 1.
#[inline(always)]
fn oblate(r2: f64, z2: f64, a2: f64) -> f64 {
    // l^2 + (a^2 - r^2 - z^2) l - a^2 z^2 = 0.
    root(1.0, a2 - r2 - z2, a2 * z2)
}

/// The root >= 0 of s l^2 + q l - p = 0 with s, p >= 0, without cancellation.
#[inline(always)]
fn root(s: f64, q: f64, p: f64) -> f64 {
    let size = (q * q + 4.0 * s * p).sqrt();
    if q > 0.0 {
        2.0 * p / (q + size)
    } else {
        (size - q) / (2.0 * s)
    }
}
