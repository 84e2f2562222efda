//! What the tests of this crate share.

/// Fails unless a number is within a relative tolerance of another.
#[track_caller]
pub fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(
        error <= tolerance,
        "{what}: {found} instead of {expected}, off by {error:.2e}"
    );
}
