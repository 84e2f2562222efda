//! A shaft so heavy that it swings on the 5 x 5 stiffness of its bearings.

use ring::rigid::RigidInertia;

/// Its frequencies, Hz, ascending; masses of rings and balls, and products of inertia, are left out.
pub fn swings(heavy: &RigidInertia, stiffness: &[[f64; 5]; 5]) -> Vec<f64> {
    let root = |i: usize| if i < 3 { heavy.mass } else { heavy.transverse }.sqrt();
    let scaled: Vec<f64> = (0..25)
        .map(|k| stiffness[k / 5][k % 5] / (root(k / 5) * root(k % 5)))
        .collect();
    let squares = dense::symmetric_eigen(5, &scaled).unwrap().0;
    squares.iter().map(|w| w.sqrt() / std::f64::consts::TAU).collect()
}
