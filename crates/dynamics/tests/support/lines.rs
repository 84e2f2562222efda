//! Lines in the spectrum of a shaft that moves in time after a push.

use dynamics::effects::{Effect, Loads, Now};
use dynamics::{DynamicsError, Model};

/// A force across for a short while, off the plane of the balls, so that it tilts the shaft as well.
pub struct Push;

/// Its length, s, and largest force, N.
pub const PUSH: [f64; 2] = [3e-4, 4.0];

impl Effect for Push {
    fn name(&self) -> &'static str {
        "push"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        if now.time < PUSH[0] {
            let share = (std::f64::consts::PI * now.time / PUSH[0]).sin();
            loads.add_shaft_force_at(model.load_point, [PUSH[1] * share * share, 0.0, 0.0]);
        }
        Ok(())
    }
}

/// Size of the line of x + i y of a record at a frequency, Hz, signed by the sense of turning, under a window whose
/// side lobes are below 1e-4 (Blackman and Harris).
pub fn line_at(record: &[[f64; 2]], dt: f64, f: f64) -> f64 {
    let n = record.len() as f64;
    let (mut re, mut im) = (0.0, 0.0);
    for (k, [x, y]) in record.iter().enumerate() {
        let t = std::f64::consts::TAU * (k as f64 + 0.5) / n;
        let window = 0.35875 - 0.48829 * t.cos() + 0.14128 * (2.0 * t).cos() - 0.01168 * (3.0 * t).cos();
        let (sin, cos) = (std::f64::consts::TAU * f * dt * k as f64).sin_cos();
        re += window * (x * cos + y * sin);
        im += window * (y * cos - x * sin);
    }
    re.hypot(im)
}

/// Frequency near a guess, Hz, at which a line is largest.
pub fn line_near(record: &[[f64; 2]], dt: f64, guess: f64) -> f64 {
    let n = record.len() as f64;
    let (mut low, mut high) = (guess - 0.3 / (n * dt), guess + 0.3 / (n * dt));
    for _ in 0..40 {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if line_at(record, dt, a) < line_at(record, dt, b) {
            low = a;
        } else {
            high = b;
        }
    }
    0.5 * (low + high)
}

/// The frequency of a motion in time of which the middle rule makes this line: it turns by 2 atan(w h / 2) a step.
pub fn of_middle_rule(line: f64, dt: f64) -> f64 {
    (std::f64::consts::PI * line * dt).tan() / (std::f64::consts::PI * dt)
}
