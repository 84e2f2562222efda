//! What input consists of, whatever it is for: quantities with units, schedules, lists of problems.
//!
//! The crate knows serde, but no file format. Its types read themselves from any.
//! ```
//! use input::{FORCE, Problems, Quantity};
//! let force: Quantity<FORCE> = "2 kN".parse()?;
//! assert_eq!(force.si(), 2000.0);
//! let mut problems = Problems::default();
//! problems.require_positive(&force, "axial_force", "a force");
//! assert!(problems.into_texts().is_empty());
//! # Ok::<(), input::UnitError>(())
//! ```

mod conductance;
mod expansion;
mod problems;
pub mod schedule;
mod schedule_table;
mod shell;
mod temperature;
pub mod units;

pub use conductance::Conductance;
pub use expansion::Expansion;
pub use problems::Problems;
pub use schedule::Schedule;
pub use schedule_table::{Clock, RawSchedule, check_schedule, require_growing, schedule_of};
pub use shell::{shell_quoted, shell_word};
pub use temperature::Temperature;
pub use units::{
    ACCELERATION, ANGLE, ANGULAR_SPEED, AnyQuantity, DAMPING, DENSITY, DYNAMIC_VISCOSITY, Dimension, FORCE,
    HERTZ_STIFFNESS, INERTIA, KINDS, Kind, LENGTH, MASS, MOMENT, PRESSURE_COEFFICIENT, Quantity, RATE, SPEED,
    STIFFNESS, STRESS, TIME, UnitError, VISCOSITY, bare_number, kind_of_dimension, parse_unit, ten_digits,
};
