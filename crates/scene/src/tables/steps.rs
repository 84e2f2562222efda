//! Equal steps in time: what `[dynamic]` and `[quasi_static]` have in common.

use input::{Problems, Quantity, TIME, ten_digits};

/// Duration over step may differ from a whole number by this part: their round-off is a million times less.
const WHOLE_TOLERANCE: f64 = 1e-9;
/// Longer runs are slips of the unit, and beyond this `WHOLE_TOLERANCE` tells no whole numbers apart.
const MAX_STEPS: f64 = 1e8;

/// The number of steps in the duration of a table, which must be whole; `None` when there are problems.
pub fn whole_steps(
    table: &str,
    duration: &Quantity<TIME>,
    step: &Quantity<TIME>,
    problems: &mut Problems,
) -> Option<u64> {
    let before = problems.len();
    problems.require_positive(duration, &format!("{table}.duration"), "a duration");
    problems.require_positive(step, &format!("{table}.step"), "a step");
    if problems.len() > before {
        return None;
    }
    let ratio = duration.si() / step.si();
    if ratio > MAX_STEPS {
        problems.add(format!(
            "{table}.step is {step}; the duration {duration} has {ratio:.1e} of these steps, more than 1e8, check both \
             units"
        ));
        return None;
    }
    let whole = ratio.round().max(1.0);
    if (ratio - whole).abs() <= WHOLE_TOLERANCE * whole {
        return Some(whole as u64);
    }
    problems.add(format!(
        "{table}.duration is {duration}; that is {} steps of {step}, expected a whole number; the nearest duration \
         that fits is {}",
        ten_digits(ratio),
        Quantity::<TIME>::about(whole * step.si())
    ));
    None
}

/// Steps from one field file to the next, 1 when nothing is typed.
pub fn output_every(table: &str, typed: Option<i64>, problems: &mut Problems) -> u64 {
    let key = format!("{table}.output_every");
    problems.whole(typed.unwrap_or(1), &key, 1, MAX_STEPS as i64) as u64
}
