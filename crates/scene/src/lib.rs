//! Scenes: what a scene file says, checked, and the model and the meshes made from it.
//!
//! [`Scene`] reads and checks a file, whose format is on the page [`tables`]. [`build_model`] reads its meshes and
//! constructs the model; [`build_meshes`] makes meshes that it describes. It is the only crate that names TOML.

mod build;
mod coarse_round;
mod designations;
mod doubts;
mod error;
mod films;
mod half_widths;
mod housing;
mod marks;
mod meshing;
mod named_files;
mod resolution;
mod revolve_like;
mod section_record;
mod settings;
mod several;
mod starter;
mod surfaces;
pub mod tables;
mod toml_text;
mod worn_balls;

pub use build::{NodeTags, build_model, geometry, material, model_with_rings, ring_of, rolling};
pub use doubts::doubts;
pub use error::BuildError;
pub use films::mean_over_ball;
pub use housing::Rings;
pub use meshing::{build_meshes, build_missing};
pub use named_files::named_files;
pub use resolution::{CLOSE_ROWS, time_below};
pub use revolve_like::{MadeLike, RevolveLike, revolve_like};
pub use settings::{effects_context, settings, speeds};
pub use several::{assembly_with_rings, build_assembly, have_same_rings, loads as loads_on_shaft};
pub use starter::{StarterRequest, file_name, scene_text};
pub use tables::*;
pub use toml_text::{read_tables, title};
