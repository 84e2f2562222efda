//! Turning shaft dofs and nodal vectors about z, between space and the frame of a ring.

/// Shaft dofs seen from a frame turned by `angle` the other way: the pairs (x, y) and (tilt x, tilt y) turn.
pub fn turn(q: [f64; 5], angle: f64) -> [f64; 5] {
    let (sin, cos) = angle.sin_cos();
    [
        cos * q[0] - sin * q[1],
        sin * q[0] + cos * q[1],
        q[2],
        cos * q[3] - sin * q[4],
        sin * q[3] + cos * q[4],
    ]
}

/// Nodal vectors turned about z.
pub fn turn_nodal(v: &[f64], angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    v.chunks_exact(3)
        .flat_map(|x| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]])
        .collect()
}
