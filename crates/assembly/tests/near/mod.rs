//! Numbers that are nearly equal.

/// Fails where the relative error is larger.
#[track_caller]
pub fn assert_near(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(
        error <= tolerance,
        "found {found:e}, expected {expected:e}: error {error:.1e}"
    );
}
