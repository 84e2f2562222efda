//! What a run leaves behind: `summary.json`, tables, VTKHDF files, and a table on the screen.

pub mod console;
pub mod fields;
pub mod files;
pub mod folder;
pub mod modes;
pub mod motion_fields;
pub mod snapshot;
pub mod summary;
pub mod tables;
