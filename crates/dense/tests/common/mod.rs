//! Numbers and checks shared by the tests.
#![allow(dead_code, reason = "each test binary uses its own part")]

/// Deterministic numbers in (-1, 1): a linear congruential generator (Knuth, MMIX constants).
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Numbers(seed)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// Fails with both numbers when the relative error exceeds `tolerance`.
#[track_caller]
pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    let error = relative_error(found, expected);
    assert!(
        error <= tolerance,
        "relative error {error:.2e} exceeds {tolerance:.1e}"
    );
}

/// Largest difference relative to the largest entry of `expected`.
pub fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    found.iter().zip(expected).fold(
        0.0,
        |m: f64, (x, y)| if (x - y).abs() <= m { m } else { (x - y).abs() },
    ) / largest
}
