//! The file `run.vtkhdf`: all steps as one temporal VTKHDF data set without copying any.
//!
//! Mesh arrays are external links, fields are virtual data sets that map rows `k n ..`, n points or cells, to the field
//! of the k-th step file. VTK 9.3 and ParaView 5.12 and later read it; older ones show the first step only. Offsets are
//! 64-bit. A missing source reads as the fill value, which is NaN here: HDF5's default, zero, would show an
//! unloaded bearing. Cost: three opens of each step and a few hundred bytes per step and field (measured, two
//! shared cores: 2 s and 1.3 MB for 3333 steps of 3 fields).

use std::collections::BTreeMap;
use std::path::Path;

use hdf5::File;

use crate::atomic::{self, Format};
use crate::checksum::Element;
use crate::dataset::{CheckedFile, create_group, create_vtkhdf, link_mesh};
use crate::error::CheckpointError;
use crate::mesh_file::{MESH_FILE, MESH_HASH};
use crate::names::INDEX_FILE;
use crate::places::{StepPlace, sound_places};
use crate::series::write_series;
use crate::step::{CELL_DATA, POINT_DATA, read_mesh_hash, step_cell_fields};
use crate::storage::Precision;

/// What a row of a field is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum RowKind {
    Point,
    Cell,
}

impl RowKind {
    /// Group of such fields.
    fn group(self) -> &'static str {
        match self {
            RowKind::Point => POINT_DATA,
            RowKind::Cell => CELL_DATA,
        }
    }

    /// Group of their offsets in `Steps`.
    fn offsets(self) -> &'static str {
        match self {
            RowKind::Point => "PointDataOffsets",
            RowKind::Cell => "CellDataOffsets",
        }
    }
}

/// A field as the index sees it.
struct IndexedField {
    /// Rows of a step: points or cells of the mesh.
    n_rows: usize,
    /// Components per row.
    n_components: usize,
    /// The widest of all steps.
    precision: Precision,
    /// Positions among the steps that have it.
    present: Vec<usize>,
}

/// What the views show.
#[derive(Debug)]
pub struct Views {
    /// Steps in both views.
    pub n_steps: usize,
    /// Why other steps are left out.
    pub damaged: Vec<CheckpointError>,
}

/// Builds `run.hdf.series` and `run.vtkhdf` again from the committed steps, packed ones included in the latter. Steps
/// whose structure is damaged are left out; fields that some steps lack are NaN there.
pub fn rebuild_index(dir: &Path) -> Result<Views, CheckpointError> {
    let (steps, mut damaged) = sound_places(dir)?;
    if steps.is_empty() {
        let path = dir.to_path_buf();
        return Err(damaged.pop().unwrap_or(CheckpointError::NoSteps { path }));
    }
    let places: Vec<&StepPlace> = steps.iter().map(|(_, place)| place).collect();
    let n_rows = require_one_mesh(dir, &places)?;
    let fields = collect_fields(&places, n_rows)?;
    let single = steps.iter().filter(|(_, place)| !place.is_packed());
    let single: Vec<(u64, f64)> = single.map(|(time, place)| (place.step, *time)).collect();
    write_series(dir, &single)?;
    atomic::write_hdf(dir, INDEX_FILE, Format::V110, |file| {
        create_vtkhdf(file, [2, 0])?;
        link_mesh(file, MESH_FILE)?;
        for ((row, name), field) in &fields {
            let path = format!("{}/{name}", row.group());
            match field.precision {
                Precision::F32 => map_field(file, &path, field, &places, f32::NAN)?,
                Precision::F64 => map_field(file, &path, field, &places, f64::NAN)?,
            }
        }
        let times: Vec<f64> = steps.iter().map(|&(time, _)| time).collect();
        write_steps_group(file, &times, &fields)?;
        Ok(Vec::new())
    })?;
    Ok(Views {
        n_steps: steps.len(),
        damaged,
    })
}

/// Points and cells of the mesh; fails when a step belongs to another mesh.
fn require_one_mesh(dir: &Path, places: &[&StepPlace]) -> Result<[(RowKind, usize); 2], CheckpointError> {
    let mesh_path = dir.join(MESH_FILE);
    let mesh = CheckedFile::open(&mesh_path)?;
    let expected = mesh.text(MESH_HASH)?;
    for place in places {
        let found = read_mesh_hash(&place.open()?)?;
        if found != expected {
            return Err(CheckpointError::MeshMismatch {
                path: place.path.clone(),
                expected,
                found,
            });
        }
    }
    Ok([
        (RowKind::Point, mesh.shape("/VTKHDF/Points")?[0]),
        (RowKind::Cell, mesh.shape("/VTKHDF/Types")?[0]),
    ])
}

/// Fields by their rows and names.
type IndexedFields = BTreeMap<(RowKind, String), IndexedField>;

/// Which fields exist, where, and how wide.
fn collect_fields(
    places: &[&StepPlace],
    rows: [(RowKind, usize); 2],
) -> Result<IndexedFields, CheckpointError> {
    let mut fields = IndexedFields::new();
    for (k, place) in places.iter().enumerate() {
        let file = place.open()?;
        for (row, n_rows) in rows {
            let names = match row {
                RowKind::Point => file.members(POINT_DATA)?,
                RowKind::Cell => step_cell_fields(&file)?,
            };
            for name in names {
                let dataset = format!("{}/{name}", row.group());
                let (shape, precision) = (file.shape(&dataset)?, file.precision(&dataset)?);
                let n_components = shape.get(1).copied().unwrap_or(1);
                let field = fields.entry((row, name)).or_insert(IndexedField {
                    n_rows,
                    n_components,
                    precision,
                    present: Vec::new(),
                });
                if shape[0] != n_rows || n_components != field.n_components {
                    let what = format!(
                        "data set {dataset} has shape {shape:?}, expected {:?}",
                        [n_rows, field.n_components]
                    );
                    return Err(CheckpointError::malformed(&place.path, what));
                }
                if precision == Precision::F64 {
                    field.precision = precision;
                }
                field.present.push(k);
            }
        }
    }
    Ok(fields)
}

/// One virtual data set over all steps, `[n_steps field.n_rows][n_components]`.
fn map_field<T: Element + Into<hdf5::types::OwnedDynValue>>(
    file: &File,
    path: &str,
    field: &IndexedField,
    places: &[&StepPlace],
    fill: T,
) -> hdf5::Result<()> {
    let (n, n_rows) = (field.n_rows, places.len() * field.n_rows);
    let shape = |rows: usize| match field.n_components {
        1 => vec![rows],
        n => vec![rows, n],
    };
    let mut builder = file.new_dataset::<T>().obj_track_times(false).fill_value(fill);
    for &k in &field.present {
        let rows = k * n..(k + 1) * n;
        let (source, source_path) = (places[k].file_name(), places[k].below(path));
        builder = match field.n_components {
            1 => builder.virtual_map(&source, &source_path, shape(n), .., shape(n_rows), rows),
            _ => builder.virtual_map(
                &source,
                &source_path,
                shape(n),
                (.., ..),
                shape(n_rows),
                (rows, ..),
            ),
        };
    }
    builder.shape(shape(n_rows)).create(path)?;
    Ok(())
}

/// The group `Steps`: the mesh is the same for all steps, the fields advance by their rows.
fn write_steps_group(file: &File, times: &[f64], fields: &IndexedFields) -> hdf5::Result<()> {
    let n_steps = times.len();
    let group = create_group(file, "VTKHDF/Steps")?;
    group
        .new_attr::<i64>()
        .create("NSteps")?
        .write_scalar(&(n_steps as i64))?;
    let write = |name: &str, shape: &[usize], values: &[i64]| {
        let dataset = group
            .new_dataset::<i64>()
            .obj_track_times(false)
            .shape(shape)
            .create(name)?;
        dataset.write_raw(values)
    };
    let zeros = vec![0; n_steps];
    group
        .new_dataset::<f64>()
        .obj_track_times(false)
        .shape(n_steps)
        .create("Values")?
        .write_raw(times)?;
    write("PartOffsets", &[n_steps], &zeros)?;
    write("NumberOfParts", &[n_steps], &vec![1; n_steps])?;
    write("PointOffsets", &[n_steps], &zeros)?;
    write("CellOffsets", &[n_steps, 1], &zeros)?;
    write("ConnectivityIdOffsets", &[n_steps, 1], &zeros)?;
    create_group(&group, "CellDataOffsets")?;
    write("CellDataOffsets/body", &[n_steps], &zeros)?;
    write("CellDataOffsets/radius", &[n_steps], &zeros)?;
    create_group(&group, "PointDataOffsets")?;
    for ((row, name), field) in fields {
        let rows: Vec<i64> = (0..n_steps).map(|k| (k * field.n_rows) as i64).collect();
        write(&format!("{}/{name}", row.offsets()), &[n_steps], &rows)?;
    }
    Ok(())
}
