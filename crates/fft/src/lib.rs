//! Fourier transforms of real signals of any length.
//!
//! The library compiles its kernels for every kind of processor into each crate that plans a transform, half a minute
//! each time. Here it does so once; other crates plan their transforms by these functions.

use std::sync::Arc;

use realfft::RealFftPlanner;
pub use realfft::num_complex;
pub use realfft::{ComplexToReal, RealToComplex};

/// The transform of `n` real samples x into n / 2 + 1 lines X_k = sum_j x_j exp(-2 pi i j k / n). Cost: n log n.
pub fn forward(n: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(n)
}

/// The way back, unscaled: n / 2 + 1 lines, the first and for even n the last of them real, into n times the samples.
pub fn inverse(n: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(n)
}
