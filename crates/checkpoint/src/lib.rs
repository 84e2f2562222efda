//! Writes the steps of a run as HDF5 files that are both checkpoint and ParaView result, and reads them back.
//!
//! A result folder holds
//!
//! | file | content | written |
//! |---|---|---|
//! | `mesh.hdf` | all bodies as one unstructured grid, cell arrays `body` and `radius` | once, first |
//! | `step_NNNNNN.hdf` | the fields of one step and everything a restart needs | once per step |
//! | `pack_NNNNNN_NNNNNN.hdf` | many steps in one file, see [`pack`] | on request |
//! | others ([`point_table`]) | fields of the run as a whole | by name, when the caller says |
//! | `run.hdf.series` | names and real times of the steps, for ParaView 5.11 and later | after each step |
//! | `run.vtkhdf` | the same steps as one temporal data set, for VTK 9.3, ParaView 5.12 and later | at the end |
//! | `.raceway.lock` | who writes here, see [`lock`] | while a run writes |
//!
//! A step file is VTKHDF version 1.0 whose mesh is external links to `mesh.hdf`; what a restart needs besides the
//! fields stands in the group `/restart`, which VTK ignores. Files appear under their final name only when they are
//! complete and on the disk ([`output`]), every data set carries a checksum of its name, type, shape and values
//! (attribute `crc32`), and a seal at the end of the file covers all its bytes, so that a damaged file is refused
//! before the HDF5 library, which may crash on it, opens it. The last two files are derived from the steps and can be
//! built again at any time ([`rebuild_index`]).
//!
//! This crate computes nothing: what it writes is what it was given.
//!
//! References: VTK File Formats, "VTKHDF File Format", Kitware, versions 1.0 and 2.0; HDF5 File Format
//! Specification version 3.0, The HDF Group.

pub mod background;
pub mod body;
pub mod cells;
pub mod error;
pub mod grid;
pub mod growing;
pub mod index;
pub mod lock;
pub mod output;
pub mod pack;
pub mod point_table;
pub mod record;
pub mod series;
pub mod step;
pub mod storage;

mod atomic;
mod checksum;
mod dataset;
mod describe;
mod field;
mod folder;
mod mesh_file;
mod names;
mod places;
mod region;
mod regular;
mod seal;
mod step_writer;

pub use background::{BackgroundOutput, Companion, Made, Written};
pub use body::{Body, CellKind, point_ranges};
pub use cells::{CellFields, IntegrationPointStress};
pub use checksum::file_checksum;
pub use describe::{ArrayDescription, FileDescription, describe};
pub use error::{CheckpointError, MESH_FILE};
pub use folder::{
    begin_anew, clear_unfinished_start, committed_steps, is_unfinished_start, new_superseded_folder,
    newest_step, require_run, run_of,
};
pub use grid::Grid;
pub use growing::{FileStamp, GrowingFile, Stamps, start_of};
pub use index::{Views, rebuild_index};
pub use lock::{FolderLock, may_not_write, open_lock};
pub use mesh_file::{MeshFile, read_mesh};
pub use names::{INDEX_FILE, SERIES_FILE, step_file_name};
pub use output::{Output, Resumed};
pub use pack::{pack_steps, unpack_steps};
pub use places::{all_steps, packs, point_field_names, read_any_step};
pub use point_table::{PointTable, TableField, read_table};
pub use record::{PointFields, StateArray, StepRecord};
pub use regular::{open_own, open_regular};
pub use step::{has_state, read_about, read_stamps, read_step, read_step_time};
pub use storage::{Compression, ErrorBound, Precision, Storage};
