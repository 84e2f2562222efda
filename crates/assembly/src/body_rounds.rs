//! When rounds of the forces on bodies that carry several bearings end, and how exactly each is solved.

use crate::mixing::dot;

/// Change of the forces on a body over their size that may be left where rounds no longer get on, and after how many.
const BODY_FLOOR: f64 = 1e-7;
const BODY_PATIENCE: usize = 3;
/// Tolerance of the forces in a round over the change of the forces on the bodies in the one before, and the most. The
/// last round has the tolerance of the scene.
const SHARE_OF_CHANGE: f64 = 1e-2;
pub const LOOSEST: f64 = 1e-4;

/// Tolerance of the forces in the round after one that changed the forces on the bodies by this share: where that might
/// have been the last, it is that of the scene.
pub fn tolerance_after(change: f64, is_last: bool) -> f64 {
    match is_last {
        true => 0.0,
        false => LOOSEST.min(SHARE_OF_CHANGE * change),
    }
}

/// Not `f64::max`: what is no number is no small change.
pub fn largest(changes: &[f64]) -> f64 {
    changes
        .iter()
        .fold(0.0, |most, c| if *c <= most { most } else { *c })
}

/// Change of forces over their size.
pub fn change(x: &[f64], found: &[f64]) -> f64 {
    let difference: Vec<f64> = found.iter().zip(x).map(|(g, x)| g - x).collect();
    let size = dot(found, found).max(dot(x, x)).sqrt();
    match size == 0.0 {
        true => 0.0,
        false => dot(&difference, &difference).sqrt() / size,
    }
}

/// Whether what is left is what the balance of shaft and rings leaves: it has not halved for some rounds.
pub fn has_stalled(history: &[f64], change: f64) -> bool {
    let before = history.len().checked_sub(BODY_PATIENCE).map(|i| history[i]);
    change <= BODY_FLOOR && before.is_some_and(|before| change > 0.5 * before)
}
