//! Steps in forms of other tools: VTU for those that read VTK's XML formats, CSV for all others.

mod blocks;
pub mod csv;
pub mod integration_points;
pub mod list;
pub mod multiblock;
pub mod vtu;
