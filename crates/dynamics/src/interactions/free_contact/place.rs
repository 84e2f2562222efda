//! Where a free ball stands in a groove: lengths, frame and slip at one instant.
//!
//! With o the centre of the groove circle, d and R displacement and rotation of what carries the ring, and u the motion
//! of an elastic groove [radial, axial],
//!
//! ```text
//! b' = R^T (b - o - d)
//! l  = (hypot(b'_x, b'_y) - rho - u_r,  b'_z - u_z)        exact for any azimuth and small or large displacements
//! n  = l / |l| in the meridian plane,  t = e_psi,  q = n x t
//! s  = v + omega x (c n) - v_ring,  v_ring = d' + W x (C - o - d) + patch',  W = spin R e_z + tilt rates
//! ```
//!
//! c is the lever, the radius of the ball less its share of the approach, and C = b + c n. R is Rodrigues' rotation by
//! the vector (tilt_x, tilt_y, 0); its series has lost nothing at the largest tilt allowed. Tilt rates turn by the
//! vectors J of the rotation (second order of the series, whose error is tilt^3 / 24).

use super::jet::{Jet, Vector, cross, dot, fixed, minus, plus, scaled, times, values};

/// Speed of a ball round the axis, rad/s, from its place and velocity; 0 on the axis.
pub fn orbit([x, y, _]: [f64; 3], [u, v, _]: [f64; 3]) -> f64 {
    let square = x * x + y * y;
    if square > 0.0 {
        (x * v - y * u) / square
    } else {
        0.0
    }
}

/// The groove circle and the lever of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrooveCircle {
    /// Radius rho of the circle of groove centres, m.
    pub radius: f64,
    /// Height of its centre o on the axis, m.
    pub height: f64,
    /// Lever c, m.
    pub lever: f64,
}

/// What a contact sees of both bodies at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Bodies {
    /// Place, velocity and angular velocity of the ball in space.
    pub ball: [Vector; 3],
    /// Displacement of what carries the ring, and its rate: three translations, two tilts.
    pub carrier: [[Jet; 5]; 2],
    /// Motion of an elastic groove, radial and axial, m.
    pub groove: [Jet; 2],
    /// Velocity of the elastic patch along t and q, m/s.
    pub patch: [Jet; 2],
    /// Speed of the ring about its own axis, rad/s.
    pub spin: f64,
}

/// A contact's place.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Place of the ball in the ring's frame, b', m.
    pub seen: Vector,
    /// Distance of the ball from the ring's axis, m.
    pub radius: Jet,
    /// l, m.
    pub reach: [Jet; 2],
}

/// Directions of a contact in space.
#[derive(Clone, Copy, Debug)]
pub struct ContactFrame {
    /// Rotation of the ring, by columns.
    pub columns: [Vector; 3],
    /// Turning of the ring by unit rates of its tilts.
    pub tilts: [Vector; 2],
    /// Direction of rolling.
    pub rolling: Vector,
    /// Across it along the groove.
    pub lateral: Vector,
    /// From the ball's centre to the raceway.
    pub normal: Vector,
}

/// Slip in a frame.
#[derive(Clone, Copy, Debug)]
pub struct SlipJets {
    /// Along t and q at the centre, m/s; then turning about t, q and n, rad/s.
    pub slip: [Jet; 5],
}

/// Where a ball at `ball` stands to a ring carried to `carrier`.
pub fn standing(groove: &GrooveCircle, ball: Vector, carrier: [Jet; 5], motion: [Jet; 2]) -> Standing {
    let columns = rotation([carrier[3], carrier[4]]);
    let y = minus(
        minus(ball, fixed([0.0, 0.0, groove.height])),
        [carrier[0], carrier[1], carrier[2]],
    );
    let seen = columns.map(|column| dot(column, y));
    let radius = (seen[0] * seen[0] + seen[1] * seen[1]).sqrt();
    Standing {
        seen,
        radius,
        reach: [radius + -groove.radius - motion[0], seen[2] - motion[1]],
    }
}

/// Directions of a contact whose ball is seen at `seen` (its length does not matter across the axis) with l along
/// `reach`, on a ring with these tilts.
pub fn frame(seen: Vector, reach: [Jet; 2], tilts: [Jet; 2]) -> ContactFrame {
    let columns = rotation(tilts);
    let out = (seen[0] * seen[0] + seen[1] * seen[1]).sqrt().recip();
    let (cos, sin) = (seen[0] * out, seen[1] * out);
    let short = (reach[0] * reach[0] + reach[1] * reach[1]).sqrt().recip();
    let [radial, axial] = reach.map(|l| l * short);
    let in_space = |v: Vector| {
        let parts = [0, 1, 2].map(|i| times(v[i], columns[i]));
        plus(plus(parts[0], parts[1]), parts[2])
    };
    let rolling = in_space([-sin, cos, Jet::default()]);
    let normal = in_space([radial * cos, radial * sin, axial]);
    ContactFrame {
        columns,
        tilts: turnings(tilts),
        rolling,
        lateral: cross(normal, rolling),
        normal,
    }
}

impl ContactFrame {
    /// Slip of a ball and a ring in this frame.
    pub fn slip(&self, groove: &GrooveCircle, bodies: &Bodies) -> SlipJets {
        let [place, velocity, turning] = bodies.ball;
        let [at, rate] = bodies.carrier;
        let ring = plus(
            scaled(bodies.spin, self.columns[2]),
            plus(times(rate[3], self.tilts[0]), times(rate[4], self.tilts[1])),
        );
        let lever = scaled(groove.lever, self.normal);
        let arm = minus(
            plus(place, lever),
            plus(fixed([0.0, 0.0, groove.height]), [at[0], at[1], at[2]]),
        );
        let ball = plus(velocity, cross(turning, lever));
        let raceway = plus([rate[0], rate[1], rate[2]], cross(ring, arm));
        let (slip, turning) = (minus(ball, raceway), minus(turning, ring));
        SlipJets {
            slip: [
                dot(slip, self.rolling) - bodies.patch[0],
                dot(slip, self.lateral) - bodies.patch[1],
                dot(turning, self.rolling),
                dot(turning, self.lateral),
                dot(turning, self.normal),
            ],
        }
    }

    /// Directions as plain numbers: t, q, n.
    pub fn directions(&self) -> [[f64; 3]; 3] {
        [self.rolling, self.lateral, self.normal].map(values)
    }
}

/// Columns of the rotation by the vector (x, y, 0): I + s K + c K^2 with K = [theta]x, s = sin/theta, c = (1 - cos)/
/// theta^2.
fn rotation([x, y]: [Jet; 2]) -> [Vector; 3] {
    let square = x * x + y * y;
    let series = |terms: [f64; 5]| {
        let mut sum = Jet::constant(terms[4]);
        for term in terms[..4].iter().rev() {
            sum = sum * square + *term;
        }
        sum
    };
    let s = series([1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
    let c = series([0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0]);
    let both = c * x * y;
    [
        [-(c * y * y) + 1.0, both, -(s * y)],
        [both, -(c * x * x) + 1.0, s * x],
        [s * y, -(s * x), -(c * square) + 1.0],
    ]
}

/// Turning by unit rates of both tilts: J e_i = e_i + theta x e_i / 2 + theta x (theta x e_i) / 6.
fn turnings([x, y]: [Jet; 2]) -> [Vector; 2] {
    let theta = [x, y, Jet::default()];
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|e| {
        let once = cross(theta, fixed(e));
        let twice = cross(theta, once);
        plus(plus(fixed(e), scaled(0.5, once)), scaled(1.0 / 6.0, twice))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jets(x: [f64; 2]) -> [Jet; 2] {
        [Jet::length(0, x[0]), Jet::length(1, x[1])]
    }

    /// Wrong: the ring would shear when it tilts, or tilt rates turn it about another axis. R is orthogonal to
    /// round-off, and dR = J dtheta x R to the order of the series.
    #[test]
    fn a_tilt_is_a_rotation() {
        let at = [0.04, -0.03];
        let columns = rotation(jets(at));
        for i in 0..3 {
            for j in 0..3 {
                let expected = if i == j { 1.0 } else { 0.0 };
                let found = dot(columns[i], columns[j]).value;
                assert!((found - expected).abs() < 4e-16, "{i} {j}: {found}");
            }
        }
        for (tilt, turning) in turnings(jets(at)).into_iter().enumerate() {
            for column in columns {
                let expected = values(cross(turning, column));
                for (k, entry) in column.iter().enumerate() {
                    let off = (entry.slope[tilt] - expected[k]).abs();
                    assert!(off < 0.05f64.powi(3) / 12.0, "{off}");
                }
            }
        }
    }
}
