//! What a run leaves behind: `summary.json`, tables, VTKHDF files, and a table on the screen.

pub mod about;
pub mod console;
pub mod cut;
pub mod disk;
pub mod fields;
pub mod files;
pub mod folder;
pub mod memory;
pub mod modes;
pub mod motion_fields;
pub mod probe_places;
pub mod probes;
pub mod ring_stress;
pub mod shown;
pub mod snapshot;
pub mod state_arrays;
pub mod stress_points;
pub mod subsurface;
pub mod summary;
pub mod tables;
pub mod timed_near_field;
