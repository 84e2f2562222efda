//! Schedules: how a load or an imposed displacement changes in time, as a dimensionless factor of its value.
//!
//! | kind | factor |
//! |---|---|
//! | constant | 1 |
//! | ramp | `from` before `start`, linear to `to` at `start + duration`, constant after |
//! | step | `before` while t < `at`, `after` from t = `at` on: exactly at its time a step has happened |
//! | impact | half sine, sin(pi (t - start)/duration) between `start` and `start + duration`, else 0 |
//! | harmonic | mean + amplitude sin(2 pi frequency t + phase) |
//! | table | linear between its times, constant before the first and after the last |
//!
//! A rate at a corner is that of the time after it. The jump of a step is in no rate.
//!
//! Loads of a time step are means over its length ([`Schedule::mean`]), in closed form, so a step of any size gives
//! the whole impulse, also of a pulse that is shorter than the step. The interval has the length of the step and its
//! middle at the weighted time of the integrator, so one that dissipates leaves out (1/2 - alpha_f) steps at the very
//! start of a run.

use std::f64::consts::PI;

/// A dimensionless factor of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Schedule {
    /// 1 at all times.
    #[default]
    Constant,
    /// Linear from one factor to another.
    Ramp {
        /// Factor up to the start.
        from: f64,
        /// Factor from the end on.
        to: f64,
        /// Time at which it begins to change, s.
        start: f64,
        /// Time it takes, s, positive.
        duration: f64,
    },
    /// A sudden change.
    Step {
        /// Time of the change, s.
        at: f64,
        /// Factor before.
        before: f64,
        /// Factor at `at` and after.
        after: f64,
    },
    /// One half of a sine wave with the peak 1.
    Impact {
        /// Time at which it begins, s.
        start: f64,
        /// Time it lasts, s, positive.
        duration: f64,
    },
    /// A sine wave about a mean.
    Harmonic {
        /// Frequency, Hz.
        frequency: f64,
        /// Phase at t = 0, rad.
        phase: f64,
        /// Mean factor.
        mean: f64,
        /// Largest departure from the mean.
        amplitude: f64,
    },
    /// Linear between given times.
    Table {
        /// Times, s, strictly growing, `[n]`, n at least 1.
        times: Vec<f64>,
        /// Factors, `[n]`.
        factors: Vec<f64>,
    },
}

impl Schedule {
    /// The factor at time `t` in s.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Schedule::Constant => 1.0,
            Schedule::Ramp {
                from,
                to,
                start,
                duration,
            } => from + (to - from) * ((t - start) / duration).clamp(0.0, 1.0),
            Schedule::Step { at, before, after } => {
                if t < *at {
                    *before
                } else {
                    *after
                }
            }
            Schedule::Impact { start, duration } => {
                let share = (t - start) / duration;
                if (0.0..1.0).contains(&share) {
                    (PI * share).sin()
                } else {
                    0.0
                }
            }
            Schedule::Harmonic {
                frequency,
                phase,
                mean,
                amplitude,
            } => mean + amplitude * (2.0 * PI * frequency * t + phase).sin(),
            Schedule::Table { times, factors } => piecewise_linear(times, factors, t)[0],
        }
    }

    /// Rate of the factor at time `t`, 1/s.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Schedule::Constant | Schedule::Step { .. } => 0.0,
            Schedule::Ramp {
                from,
                to,
                start,
                duration,
            } => {
                if (0.0..1.0).contains(&((t - start) / duration)) {
                    (to - from) / duration
                } else {
                    0.0
                }
            }
            Schedule::Impact { start, duration } => {
                let share = (t - start) / duration;
                if (0.0..1.0).contains(&share) {
                    PI / duration * (PI * share).cos()
                } else {
                    0.0
                }
            }
            Schedule::Harmonic {
                frequency,
                phase,
                amplitude,
                ..
            } => {
                let omega = 2.0 * PI * frequency;
                amplitude * omega * (omega * t + phase).cos()
            }
            Schedule::Table { times, factors } => piecewise_linear(times, factors, t)[1],
        }
    }

    /// Mean of the factor over an interval of `width` seconds (0: the instant) about the time `centre`.
    pub fn mean(&self, centre: f64, width: f64) -> f64 {
        let (from, to) = (centre - 0.5 * width, centre + 0.5 * width);
        let piecewise = |corners: &[f64]| {
            let inside = corners.iter().copied().filter(|c| from < *c && *c < to);
            let places: Vec<f64> = std::iter::once(from).chain(inside).chain([to]).collect();
            let length = to - from;
            if places.len() == 2 || length <= 0.0 {
                return self.at(centre);
            }
            let pieces = places.windows(2);
            pieces
                .map(|p| (p[1] - p[0]) / length * 0.5 * (self.at(p[0]) + self.at(p[1])))
                .sum()
        };
        match self {
            Schedule::Constant => 1.0,
            Schedule::Ramp { start, duration, .. } => piecewise(&[*start, start + duration]),
            Schedule::Table { times, .. } => piecewise(times),
            Schedule::Step { at, before, after } if from < *at && *at < to => {
                let share = (at - from) / (to - from);
                share * before + (1.0 - share) * after
            }
            Schedule::Step { .. } => self.at(centre),
            Schedule::Impact { start, duration } => {
                let (low, high) = (from.max(*start), to.min(start + duration));
                if width == 0.0 || low >= high {
                    return if width == 0.0 { self.at(centre) } else { 0.0 };
                }
                let rate = PI / duration;
                let middle = (rate * (0.5 * (low + high) - start)).sin();
                middle * sinc(0.5 * rate * (high - low)) * (high - low) / (to - from)
            }
            Schedule::Harmonic { frequency, mean, .. } => {
                mean + (self.at(centre) - mean) * sinc(PI * frequency * width)
            }
        }
    }

    /// Bound of the factor's size at all times; it is reached, but for a harmonic that ends before its peak.
    pub fn peak(&self) -> f64 {
        match self {
            Schedule::Constant | Schedule::Impact { .. } => 1.0,
            Schedule::Ramp { from, to, .. } => from.abs().max(to.abs()),
            Schedule::Step { before, after, .. } => before.abs().max(after.abs()),
            Schedule::Harmonic { mean, amplitude, .. } => mean.abs() + amplitude.abs(),
            Schedule::Table { factors, .. } => factors.iter().fold(0.0, |m, f| f.abs().max(m)),
        }
    }
}

/// sin(x) / x.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// Value and rate at `t` of the function that is linear between growing `times` and constant outside.
pub fn piecewise_linear(times: &[f64], values: &[f64], t: f64) -> [f64; 2] {
    let i = times.partition_point(|x| *x <= t);
    if i == 0 {
        return [values[0], 0.0];
    }
    if i == times.len() {
        return [values[i - 1], 0.0];
    }
    let rate = (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
    let share = (t - times[i - 1]) / (times[i] - times[i - 1]);
    [values[i - 1] + share * (values[i] - values[i - 1]), rate]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Schedule {
        Schedule::Ramp {
            from: 0.5,
            to: 2.0,
            start: 1.0,
            duration: 3.0,
        }
    }

    fn impact() -> Schedule {
        Schedule::Impact {
            start: 1.0,
            duration: 2.0,
        }
    }

    fn harmonic() -> Schedule {
        Schedule::Harmonic {
            frequency: 0.25,
            phase: PI / 2.0,
            mean: 3.0,
            amplitude: -0.5,
        }
    }

    fn table() -> Schedule {
        Schedule::Table {
            times: vec![1.0, 2.0, 4.0],
            factors: vec![0.0, 1.0, -3.0],
        }
    }

    fn step() -> Schedule {
        Schedule::Step {
            at: 1.0,
            before: -0.5,
            after: 0.25,
        }
    }

    /// Wrong: a load would come too early, too late or with another size. Closed forms; exact but for one sine.
    #[test]
    fn factors_are_their_closed_forms() {
        let half = 0.5f64.sqrt();
        let cases = [
            (Schedule::default(), vec![(-1.0, 1.0), (7.0, 1.0)]),
            (
                ramp(),
                vec![(0.0, 0.5), (1.0, 0.5), (2.0, 1.0), (4.0, 2.0), (9.0, 2.0)],
            ),
            (
                impact(),
                vec![
                    (0.9, 0.0),
                    (1.0, 0.0),
                    (1.5, half),
                    (2.0, 1.0),
                    (2.5, half),
                    (3.0, 0.0),
                    (4.0, 0.0),
                ],
            ),
            (
                harmonic(),
                vec![(0.0, 2.5), (1.0, 3.0), (2.0, 3.5), (3.0, 3.0), (4.0, 2.5)],
            ),
            (
                table(),
                vec![
                    (0.0, 0.0),
                    (1.5, 0.5),
                    (2.0, 1.0),
                    (3.0, -1.0),
                    (4.0, -3.0),
                    (5.0, -3.0),
                ],
            ),
        ];
        for (schedule, points) in cases {
            for (t, factor) in points {
                assert!(
                    (schedule.at(t) - factor).abs() < 4e-16,
                    "{schedule:?} at {t}: {}",
                    schedule.at(t)
                );
                assert!(schedule.at(t).abs() <= schedule.peak());
            }
        }
    }

    /// Wrong: a step would happen one instant off its time: from exactly its time on it has the value after it.
    #[test]
    fn a_step_has_happened_exactly_at_its_time() {
        assert_eq!(step().at(1.0f64.next_down()), -0.5);
        assert_eq!(step().at(1.0), 0.25);
        assert_eq!(step().rate(1.0), 0.0);
        assert_eq!(step().peak(), 0.5);
    }

    /// Wrong: a step of a motion would get another impulse than the load has, a short pulse none or twice its own.
    /// Sums of 40 000 middle values: their error is below a jump over their number.
    #[test]
    fn means_are_those_of_the_values() {
        for schedule in [Schedule::default(), ramp(), step(), impact(), harmonic(), table()] {
            for (centre, width) in [
                (0.0, 1.0),
                (1.0, 0.5),
                (1.3, 0.2),
                (2.0, 1.5),
                (2.0, 9.0),
                (3.9, 1.0),
                (9.0, 1.0),
            ] {
                let n = 40_000;
                let place = |i: usize| centre - 0.5 * width + width * (i as f64 + 0.5) / n as f64;
                let sum: f64 = (0..n).map(|i| schedule.at(place(i))).sum();
                let mean = schedule.mean(centre, width);
                assert!(
                    (mean - sum / n as f64).abs() < 3e-5,
                    "{schedule:?} {centre} {width}: {mean}"
                );
                let instant = schedule.mean(centre, 0.0);
                assert_eq!(instant.to_bits(), schedule.at(centre).to_bits());
            }
        }
    }

    /// Wrong: steps late in a long run would get loads with the round-off of the time. A ramp's middle, 10^4 s after
    /// zero.
    #[test]
    fn means_late_in_a_run_keep_their_digits() {
        let late = Schedule::Impact {
            start: 1e4,
            duration: 1.0,
        };
        assert!((late.mean(1e4 + 0.5, 1e-6) - 1.0).abs() < 1e-9);
        let ramp = Schedule::Ramp {
            from: 1.0,
            to: 2.0,
            start: 0.0,
            duration: 2e4,
        };
        assert_eq!(ramp.mean(1e4, 1e-6), 1.5);
    }

    /// Wrong: a driven shaft would have a velocity that is not that of its displacement. Central differences, whose
    /// error is h^2/6 times the third derivative (below 4 here) plus round-off 1e-16/h.
    #[test]
    fn rates_are_derivatives() {
        let h = 1e-5;
        for schedule in [Schedule::default(), ramp(), step(), impact(), harmonic(), table()] {
            for i in 0..50 {
                let t = 0.013 + 0.1 * i as f64;
                let numeric = (schedule.at(t + h) - schedule.at(t - h)) / (2.0 * h);
                assert!(
                    (schedule.rate(t) - numeric).abs() < 2e-10,
                    "{schedule:?} at {t}: {numeric}"
                );
            }
        }
    }

    /// Wrong: at a corner the rate would be that of the past, and a driven shaft would start a step late.
    #[test]
    fn at_a_corner_the_rate_is_that_of_the_time_after() {
        assert_eq!((ramp().rate(1.0), ramp().rate(4.0)), (0.5, 0.0));
        assert_eq!((impact().rate(1.0), impact().rate(3.0)), (PI / 2.0, 0.0));
        assert_eq!((table().rate(2.0), table().rate(4.0)), (-2.0, 0.0));
    }
}
