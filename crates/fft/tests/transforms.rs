//! Transforms against their sums, for lengths of all kinds.

use std::f64::consts::TAU;

use fft::num_complex::Complex64;

fn samples(n: usize) -> Vec<f64> {
    (0..n)
        .map(|j| (0.7 * j as f64).sin() + (j * j % 11) as f64)
        .collect()
}

#[test]
fn lines_are_the_sums_of_the_samples() {
    for n in [1, 2, 7, 48, 97, 180] {
        let forward = fft::forward(n);
        let mut lines = forward.make_output_vec();
        assert_eq!(lines.len(), n / 2 + 1);
        forward.process(&mut samples(n), &mut lines).unwrap();
        for (k, line) in lines.iter().enumerate() {
            let turned = |(j, x): (usize, f64)| x * Complex64::cis(-TAU * (j * k) as f64 / n as f64);
            let sum: Complex64 = samples(n).into_iter().enumerate().map(turned).sum();
            assert!(
                (line - sum).norm() < 1e-12 * (n * n) as f64,
                "{n}, {k}: {line} {sum}"
            );
        }
    }
}

#[test]
fn the_way_back_gives_n_times_the_samples() {
    for n in [1, 2, 7, 48, 97, 180] {
        let (forward, inverse) = (fft::forward(n), fft::inverse(n));
        let (mut lines, mut back) = (forward.make_output_vec(), inverse.make_output_vec());
        forward.process(&mut samples(n), &mut lines).unwrap();
        inverse.process(&mut lines, &mut back).unwrap();
        for (x, y) in samples(n).into_iter().zip(back) {
            assert!((n as f64 * x - y).abs() < 1e-12 * (n * n) as f64, "{n}: {x} {y}");
        }
    }
}
