//! Where the wall time goes: a tree of named laps.
//!
//! A lap is named by its path, `"contact/newton"`: what is added to it is added to `contact` as well. So the seconds
//! of a lap include those of its parts. Whoever works carries its [`Laps`]: there is no global, and nothing that is
//! computed depends on them.
//!
//! ```
//! let mut laps = timer::Laps::default();
//! let sum = laps.time("contact/newton", || 1 + 1);
//! laps.add("contact/patches", 0.5);
//! assert_eq!(sum, 2);
//! assert!(laps.seconds("contact") >= 0.5 + laps.seconds("contact/newton"));
//! ```
//!
//! A lap costs one or two readings of the clock and a search among its neighbours, less than half a microsecond.

mod laps;
mod shared;
mod stopwatch;

pub use laps::{Lap, Laps};
pub use shared::SharedLaps;
pub use stopwatch::Stopwatch;
