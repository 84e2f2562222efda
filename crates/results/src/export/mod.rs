//! Steps in forms of other tools: VTU for those that read VTK's XML formats, CSV for all others.

pub mod csv;
pub mod integration_points;
pub mod vtu;
