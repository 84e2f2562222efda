//! Stands for the crate `dynamics` where only its schedules are needed.

#[path = "../../crates/dynamics/src/schedule.rs"]
pub mod schedule;

pub use schedule::Schedule;
