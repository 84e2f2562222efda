//! Spectra of a signal of equal steps: amplitude, power density, and the envelope of a band.
//!
//! The mean is taken out and a Hann window w laid on, so that lines do not leak far. With X the transform of w x, f_s
//! the rate and n samples:
//!
//! ```text
//! amplitude = 2 |X| / sum w              # of a line: its amplitude (within 15 % between two frequencies)
//! density   = 2 |X|^2 / (f_s sum w^2)    # its integral over a band is the mean square in it
//! envelope  = |x_b + i H x_b|            # x_b: what of x lies in the band; H: Hilbert's transform
//! ```
//!
//! Reference: Randall and Antoni, Mechanical Systems and Signal Processing 25 (2011) 485, section 3. Cost: n log n.

use fft::num_complex::Complex64;

/// A spectrum from frequency 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSpectrum {
    /// Distance of the frequencies, Hz.
    pub resolution: f64,
    /// Values at them; amplitudes in the unit of the signal, densities in its square per Hz.
    pub values: Vec<f64>,
}

/// Amplitudes of the lines of a signal with `rate` samples a second.
pub fn amplitudes(signal: &[f64], rate: f64) -> LineSpectrum {
    let window = hann(signal.len());
    let gain: f64 = window.iter().sum();
    spectrum(signal, &window, rate, |x| 2.0 * x.norm() / gain)
}

/// Power spectral density.
pub fn density(signal: &[f64], rate: f64) -> LineSpectrum {
    let window = hann(signal.len());
    let power: f64 = window.iter().map(|w| w * w).sum();
    spectrum(signal, &window, rate, |x| 2.0 * x.norm_sqr() / (rate * power))
}

/// Envelope of what of a signal lies between two frequencies, Hz.
pub fn envelope(signal: &[f64], rate: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let n = signal.len();
    let (forward, inverse) = (fft::forward(n), fft::inverse(n));
    let mut samples = signal.to_vec();
    let mut lines = forward.make_output_vec();
    forward
        .process(&mut samples, &mut lines)
        .expect("the buffers are those of the plan");
    let in_band = |k: usize| (low..=high).contains(&(k as f64 * rate / n as f64));
    let is_edge = |k: usize| k == 0 || 2 * k == n;
    // The imaginary part of an end line would be none of a real signal.
    let back = |factor: Complex64| {
        let mut part: Vec<Complex64> = (0..lines.len())
            .map(|k| {
                if in_band(k) && !is_edge(k) {
                    factor * lines[k]
                } else {
                    Complex64::ZERO
                }
            })
            .collect();
        let mut values = inverse.make_output_vec();
        inverse
            .process(&mut part, &mut values)
            .expect("the ends of the spectrum are real");
        values
    };
    let (own, turned) = (back(Complex64::ONE), back(-Complex64::I));
    own.iter()
        .zip(turned)
        .map(|(a, b)| a.hypot(b) / n as f64)
        .collect()
}

/// Second differences over the square of the step: of a displacement its acceleration, at all samples but the ends.
pub fn acceleration(displacement: &[f64], rate: f64) -> Vec<f64> {
    let of = |x: &[f64]| (x[0] - 2.0 * x[1] + x[2]) * rate * rate;
    displacement.windows(3).map(of).collect()
}

fn spectrum(signal: &[f64], window: &[f64], rate: f64, value: impl Fn(Complex64) -> f64) -> LineSpectrum {
    let n = signal.len();
    let mean = signal.iter().sum::<f64>() / n as f64;
    let mut samples: Vec<f64> = signal.iter().zip(window).map(|(x, w)| w * (x - mean)).collect();
    let forward = fft::forward(n);
    let mut lines = forward.make_output_vec();
    forward
        .process(&mut samples, &mut lines)
        .expect("the buffers are those of the plan");
    LineSpectrum {
        resolution: rate / n as f64,
        values: lines.into_iter().map(value).collect(),
    }
}

fn hann(n: usize) -> Vec<f64> {
    let turn = std::f64::consts::TAU / n as f64;
    (0..n).map(|i| 0.5 - 0.5 * (turn * i as f64).cos()).collect()
}

impl LineSpectrum {
    /// The largest frequency.
    pub fn highest(&self) -> f64 {
        self.resolution * (self.values.len() - 1) as f64
    }

    /// Frequency, Hz, and value of the largest line within two resolutions of a frequency; 0 Hz is none.
    pub fn peak_near(&self, frequency: f64) -> [f64; 2] {
        let place = frequency / self.resolution;
        let first = (place - 2.0).ceil().max(1.0) as usize;
        let last = ((place + 2.0).floor() as usize).min(self.values.len() - 1);
        let all = (first..=last).map(|k| [k as f64 * self.resolution, self.values[k]]);
        all.fold(
            [frequency, 0.0],
            |most, at| if at[1] > most[1] { at } else { most },
        )
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const RATE: f64 = 20_000.0;

    fn sampled(n: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|i| f(i as f64 / RATE)).collect()
    }

    /// Wrong: a line would not have its amplitude, or stand elsewhere. Two waves on frequencies of the record, and a
    /// mean that does not count; odd and even lengths.
    #[test]
    fn a_wave_has_its_amplitude_at_its_frequency() {
        for n in [4000, 4001] {
            let rate = n as f64 / 0.2;
            let signal: Vec<f64> = (0..n)
                .map(|i| {
                    let t = i as f64 / rate;
                    7.0 + 3.0 * (TAU * 100.0 * t + 0.4).cos() + 0.5 * (TAU * 735.0 * t).sin()
                })
                .collect();
            let found = amplitudes(&signal, rate);
            assert!((found.resolution - 5.0).abs() < 1e-12);
            assert!((found.values[20] - 3.0).abs() < 1e-10 && (found.values[147] - 0.5).abs() < 1e-10);
            assert!(found.values[60].abs() < 1e-10 && found.values[0] < 1e-10);
            assert!((found.peak_near(101.0)[0] - 100.0).abs() < 1e-9);
        }
    }

    /// Wrong: the power would depend on the length of the record. Parseval: the density integrates to the mean square.
    #[test]
    fn the_density_integrates_to_the_mean_square() {
        for n in [5000, 20_000] {
            let found = density(&sampled(n, |t| 2.0 * (TAU * 310.0 * t).sin()), RATE);
            let power: f64 = found.values.iter().sum::<f64>() * found.resolution;
            assert!((power - 2.0).abs() < 1e-3, "{power}");
        }
    }

    /// Wrong: an envelope would not show at which frequency a ringing comes again. 4 kHz modulated at 90 Hz, with a
    /// strong line outside the band: envelope 1 + 0.6 cos.
    #[test]
    fn the_envelope_of_a_band_shows_its_modulation() {
        let n = 20_000;
        let signal = sampled(n, |t| {
            (1.0 + 0.6 * (TAU * 90.0 * t).cos()) * (TAU * 4000.0 * t).cos() + 50.0 * (TAU * 200.0 * t).cos()
        });
        let found = envelope(&signal, RATE, [3000.0, 5000.0]);
        for (i, value) in found.iter().enumerate() {
            let exact = 1.0 + 0.6 * (TAU * 90.0 * i as f64 / RATE).cos();
            assert!((value - exact).abs() < 1e-9, "{i}: {value} {exact}");
        }
        assert!((amplitudes(&found, RATE).peak_near(90.0)[1] - 0.6).abs() < 1e-9);
    }

    /// Wrong: acceleration of another sign or size.
    #[test]
    fn second_differences_are_accelerations() {
        let found = acceleration(&sampled(100, |t| 0.5 * 9.81 * t * t), RATE);
        assert_eq!(found.len(), 98);
        assert!(found.iter().all(|a| (a / 9.81 - 1.0).abs() < 1e-6));
    }
}
