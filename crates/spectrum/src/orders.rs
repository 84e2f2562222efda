//! Order tracking: a signal of equal steps in time becomes one of equal steps in angle.
//!
//! ```text
//! t_k = theta^-1(theta_0 + k d),  x_k = x(t_k),  d = (theta_n - theta_0)/n
//! ```
//!
//! Both functions go between samples by the cubic through four of them (Lagrange): with f the frequency of a line and
//! f_s the rate, it is off by (3/128) (2 pi f/f_s)^4 of its amplitude at most: 0.6 % at f_s/9, 4 % at f_s/5.5.
//! A line that follows the angle stays one line while the speed changes; its order is its number of periods a turn.
//! Reference: Fyfe and Munck, Mechanical Systems and Signal Processing 11 (1997) 187, section 2. Cost: n.

use std::f64::consts::TAU;

use anyhow::ensure;

/// A signal of equal angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampled {
    /// Values, as many as there were.
    pub values: Vec<f64>,
    /// Samples a turn.
    pub rate: f64,
    /// Largest order that samples of time show at the highest speed.
    pub highest: f64,
    /// Turns of the whole signal.
    pub turns: f64,
}

/// Resamples a signal at equal angles, rad, that must grow, or fall, all the time.
pub fn resample(values: &[f64], angles: &[f64]) -> anyhow::Result<Resampled> {
    let n = angles.len();
    let sign = (angles[n - 1] - angles[0]).signum();
    let angles: Vec<f64> = angles.iter().map(|a| sign * a).collect();
    let turns_back = angles.windows(2).position(|pair| pair[1] <= pair[0]);
    ensure!(
        turns_back.is_none(),
        "the tachometer stands or turns back at sample {} of {n}; expected a part of the run, with --from and --to, in \
         which it turns one way",
        turns_back.unwrap_or(0)
    );
    let step = (angles[n - 1] - angles[0]) / (n - 1) as f64;
    let fastest = angles
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(0.0, f64::max);
    let mut interval = 0;
    let at = |k: usize| {
        let angle = (angles[0] + k as f64 * step).min(angles[n - 1]);
        while interval + 2 < n && angles[interval + 1] < angle {
            interval += 1;
        }
        let place = invert(&angles, interval, angle);
        cubic(values, interval, place)
    };
    Ok(Resampled {
        values: (0..n).map(at).collect(),
        rate: TAU / step,
        highest: 0.5 * TAU / fastest,
        turns: (angles[n - 1] - angles[0]) / TAU,
    })
}

/// Place in an interval, 0 to 1, at which the cubic through the samples around it has a value.
fn invert(angles: &[f64], interval: usize, angle: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // The cubic of angles that grow is close to a line: bisection and secant meet within few rounds.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cubic(angles, interval, middle) < angle {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The cubic through the four samples around an interval, at its ends the first or last four.
fn cubic(values: &[f64], interval: usize, place: f64) -> f64 {
    let first = interval.saturating_sub(1).min(values.len() - 4);
    let t = interval as f64 + place - first as f64;
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| values[first + i]);
    let [t1, t2, t3] = [t - 1.0, t - 2.0, t - 3.0];
    -a * t1 * t2 * t3 / 6.0 + b * t * t2 * t3 / 2.0 - c * t * t1 * t3 / 2.0 + d * t * t1 * t2 / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fourier::amplitudes;

    /// Speed from 10 to 30 turns a second within a second.
    fn run_up(n: usize) -> Vec<f64> {
        (0..n)
            .map(|i| i as f64 / n as f64)
            .map(|t| TAU * (10.0 * t + 10.0 * t * t))
            .collect()
    }

    /// Wrong: a line that follows the shaft would be smeared over all its frequencies, or stand at another order.
    #[test]
    fn a_wave_of_a_rising_speed_is_one_line_at_its_order() {
        let angles = run_up(8000);
        let values: Vec<f64> = angles.iter().map(|a| 0.3 + 2.0 * (7.0 * a).sin()).collect();
        let turned = resample(&values, &angles).unwrap();
        let spectrum = amplitudes(&turned.values, turned.rate);
        let [order, amplitude] = spectrum.peak_near(7.0);
        // Hann's window between two lines: up to 15 % less; resolution one over the turns, 20.
        assert!((order - 7.0).abs() <= 0.5 / turned.turns + 1e-9, "{order}");
        assert!((1.65..2.02).contains(&amplitude), "{amplitude}");
        // In time the same wave is spread from 70 to 210 Hz.
        let in_time = amplitudes(&values, 8000.0);
        let largest = in_time.values.iter().copied().fold(0.0, f64::max);
        assert!(largest < 0.6, "{largest}");
        assert!((turned.turns - 20.0).abs() < 0.01 && (turned.highest - 8000.0 / 60.0).abs() < 0.1);
    }

    /// Wrong: interpolation would be of lower order than it says: half the step, a sixteenth of the error.
    #[test]
    fn the_error_of_resampling_is_of_fourth_order() {
        let error = |n: usize| {
            let angles = run_up(n);
            let values: Vec<f64> = angles.iter().map(|a| (3.0 * a).sin()).collect();
            let turned = resample(&values, &angles).unwrap();
            let step = (angles[n - 1] - angles[0]) / (n - 1) as f64;
            let exact = (0..n).map(|k| (3.0 * k as f64 * step).sin());
            exact
                .zip(&turned.values)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max)
        };
        let ratio = error(2000) / error(4000);
        assert!((14.0..18.0).contains(&ratio), "{ratio}");
    }

    /// Wrong: an angle that turns back would be taken for one that does not.
    #[test]
    fn a_shaft_that_turns_back_is_refused() {
        let angles: Vec<f64> = (0..100).map(|i| (0.03 * i as f64).sin()).collect();
        let message = resample(&angles, &angles).unwrap_err().to_string();
        assert!(
            message.contains("the tachometer stands or turns back at sample 52 of 100"),
            "{message}"
        );
    }
}
