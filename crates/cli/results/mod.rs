//! What a run leaves behind: `summary.json`, tables, VTKHDF files, and a table on the screen.

pub mod console;
pub mod fields;
pub mod folder;
pub mod summary;
pub mod tables;
