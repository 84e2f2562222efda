//! What a run leaves behind: `summary.json`, tables, VTKHDF files, a table on the screen, and how it ended.
//!
//! [`files::Files`] writes a run step by step from a [`snapshot::Snapshot`] of each. [`survey`] finds what only whole
//! meshes tell, before ranks divide them. A command that does not end well is a [`failure::Failure`].

pub mod about;
pub mod answer;
pub mod bodies;
pub mod body_stress;
pub mod campbell;
pub mod console;
pub mod cut;
pub mod disk;
pub mod export;
mod facet_search;
pub mod failure;
pub mod fields;
pub mod files;
pub mod film;
pub mod folder;
mod free_columns;
pub mod gauges;
pub mod integrity;
pub mod list_memory;
pub mod load_matrix;
pub mod log;
pub mod memory;
pub mod modes;
pub mod motion_fields;
pub mod mounting;
pub mod on_ball;
pub mod probe_places;
pub mod probes;
pub mod rainflow;
pub mod reduction;
mod region;
pub mod rest_state;
mod ring_stress;
pub mod seat;
pub mod several;
pub mod several_modes;
pub mod several_print;
pub mod several_stiffness;
mod shaft_sections;
pub mod shown;
pub mod snapshot;
pub mod state_arrays;
pub mod stiffness;
pub mod stop;
mod stress_points;
mod subsurface;
pub mod summary;
pub mod survey;
pub mod table;
mod tables;
pub mod tilt;
mod timed_near_field;
pub mod watch;
pub mod whole;
