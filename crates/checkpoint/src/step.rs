//! One step file: written complete, read back with every checksum verified.
//!
//! ```text
//! /VTKHDF                 Version (1,0), Type UnstructuredGrid, the mesh by external links to mesh.hdf
//!   PointData/NAME        the fields over points
//!   CellData/NAME         the fields over cells, beside the links to mesh.hdf; stress_integration_points has the
//!                         attribute layout, which says the order of points and components
//!   FieldData/time        [1], s
//! /restart                texts as attributes: scene, program_version, mesh_hash,
//!                         run: identity of the run, absent in files of earlier versions
//!                         contents: paths of all data sets, one per line, sorted
//!                         tables: a line `CRC LENGTH NAME` for each table of the run, of its start up to this step;
//!                         absent in files of earlier versions
//!   step                  [1], i64
//!   state/NAME            the arrays of the state, [n], f64 or i64; none in a step that no run goes on from
//!   about                 texts about the run as attributes, the same in every step
//! ```
//! `contents` makes the loss of a whole data set an error instead of a field that is silently absent.

use std::collections::BTreeMap;
use std::path::Path;

use hdf5::types::{IntSize, TypeDescriptor};

use crate::atomic::{Format, Unsealed};
use crate::cells::{CellFields, IntegrationPointStress, TENSOR};
use crate::checksum::Element;
use crate::dataset::{
    CheckedFile, create_group, create_vtkhdf, link_mesh, write_array, write_field, write_text,
};
use crate::error::CheckpointError;
use crate::field::IN_REGION;
use crate::growing::{Stamps, parse_stamps, stamps_text};
use crate::mesh_file::{MESH_FILE, MESH_HASH, RUN};
use crate::record::{PointFields, StateArray, StepRecord};
use crate::seal::{verify_seal, verify_structure};
use crate::storage::{Compression, Precision, Storage};

/// Group of the fields.
pub(crate) const POINT_DATA: &str = "/VTKHDF/PointData";
/// Group of the fields over cells.
pub(crate) const CELL_DATA: &str = "/VTKHDF/CellData";
/// Arrays of the mesh in that group.
pub(crate) const MESH_CELL_DATA: [&str; 2] = ["body", "radius"];
const STRESS_LAYOUT: &str = "/VTKHDF/CellData/stress_integration_points/layout";
const TIME: &str = "/VTKHDF/FieldData/time";
pub(crate) const STEP: &str = "/restart/step";
const SCENE: &str = "/restart/scene";
pub(crate) const PROGRAM_VERSION: &str = "/restart/program_version";
const CONTENTS: &str = "/restart/contents";
const TABLES: &str = "/restart/tables";
const STATE: &str = "/restart/state";
pub(crate) const ABOUT: &str = "/restart/about";

/// Texts of a step that are not of its record.
pub(crate) struct StepOrigin<'a> {
    pub program_version: &'a str,
    pub mesh_hash: &'a str,
    pub run: Option<&'a str>,
    pub about: &'a BTreeMap<String, String>,
}

/// Writes a step file `name` of `dir`, all but its seal and name; the record must have been validated.
pub(crate) fn write_step_file(
    dir: &Path,
    name: &str,
    record: &StepRecord,
    origin: &StepOrigin,
    storage: Storage,
) -> Result<Unsealed, CheckpointError> {
    Unsealed::write(dir, name, Format::Earliest, |file| {
        create_vtkhdf(file, [1, 0])?;
        link_mesh(file, MESH_FILE)?;
        fill_step(file, record, origin, storage)
    })
}

/// Writes a step into a group that has the frame of a VTKHDF grid; returns the paths of its arrays in the group.
pub(crate) fn fill_step(
    group: &hdf5::Group,
    record: &StepRecord,
    origin: &StepOrigin,
    storage: Storage,
) -> hdf5::Result<Vec<String>> {
    create_group(group, "VTKHDF/FieldData")?;
    create_group(group, "restart")?;
    create_group(group, "restart/state")?;
    let mut contents = vec![TIME.to_string(), STEP.to_string()];
    let fields = [
        (POINT_DATA, record.points.present(storage)),
        (CELL_DATA, record.cells.present(storage)),
    ];
    for (folder, fields) in fields {
        for field in fields {
            let path = format!("{folder}/{}", field.name);
            write_field(group, &path, &field, storage.compression)?;
            contents.push(path);
        }
    }
    if let Some(stress) = &record.cells.stress_integration_points {
        write_text(group, STRESS_LAYOUT, &stress.layout)?;
    }
    for (name, array) in &record.state {
        let path = format!("{STATE}/{name}");
        match array {
            StateArray::Real(values) => write_state(group, &path, values)?,
            StateArray::Integer(values) => write_state(group, &path, values)?,
        }
        contents.push(path);
    }
    write_array(group, TIME, &[1], &[record.time], Compression::None)?;
    write_array(group, STEP, &[1], &[record.step as i64], Compression::None)?;
    write_text(group, SCENE, &record.scene)?;
    if let Some(stamps) = &record.tables {
        write_text(group, TABLES, &stamps_text(stamps))?;
    }
    write_text(group, PROGRAM_VERSION, origin.program_version)?;
    write_text(group, MESH_HASH, origin.mesh_hash)?;
    if let Some(run) = origin.run {
        write_text(group, RUN, run)?;
    }
    create_group(group, "restart/about")?;
    for (name, text) in origin.about {
        write_text(group, &format!("{ABOUT}/{name}"), text)?;
    }
    contents.sort();
    write_text(group, CONTENTS, &contents.join("\n"))?;
    Ok(contents)
}

fn write_state<T: Element>(file: &hdf5::Group, path: &str, values: &[T]) -> hdf5::Result<()> {
    write_array(file, path, &[values.len()], values, Compression::None)
}

/// Reads a step file, verifying its seal and the checksum of every data set. Stress comes back as it was stored:
/// rounded to f32 unless the run chose f64, and to the run's error bound; displacement
/// is rounded if the run chose f32. Everything else comes back bit for bit.
pub fn read_step(path: &Path) -> Result<StepRecord, CheckpointError> {
    verify_seal(path)?;
    read_record(&CheckedFile::open(path)?, path)
}

/// Reads a step of a file whose structure has been verified; every value read is checked.
pub(crate) fn read_record(file: &CheckedFile, path: &Path) -> Result<StepRecord, CheckpointError> {
    require_contents(file, path)?;
    file.text(PROGRAM_VERSION)?;
    file.text(MESH_HASH)?;
    let mut record = StepRecord {
        step: read_step_number(file, path)?,
        time: file.scalar(TIME)?,
        points: PointFields::default(),
        cells: CellFields::default(),
        scene: file.text(SCENE)?,
        state: Default::default(),
        tables: stamps_of(file, path)?,
    };
    for name in file.members(POINT_DATA)? {
        read_field(file, path, &name, &mut record.points)?;
    }
    for name in step_cell_fields(file)? {
        read_cell_field(file, path, &name, &mut record.cells)?;
    }
    for name in file.members(STATE)? {
        let dataset = format!("{STATE}/{name}");
        let array = match file.descriptor(&dataset)? {
            TypeDescriptor::Integer(IntSize::U8) => StateArray::Integer(file.array(&dataset)?.1),
            _ => StateArray::Real(file.array(&dataset)?.1),
        };
        record.state.insert(name, array);
    }
    Ok(record)
}

/// Time of a step file, s, without reading its fields. What is read is verified, and so is the file's structure: the
/// library can open it safely.
pub fn read_step_time(path: &Path) -> Result<f64, CheckpointError> {
    verify_structure(path)?;
    CheckedFile::open(path)?.scalar(TIME)
}

/// Whether a step file holds a state, from which a run can go on. The file's structure is verified.
pub fn has_state(path: &Path) -> Result<bool, CheckpointError> {
    verify_structure(path)?;
    let contents = CheckedFile::open(path)?.text(CONTENTS)?;
    Ok(contents.lines().any(|dataset| dataset.starts_with(STATE)))
}

/// What a step file says about its run, by name; see [`crate::Output::describe`].
pub fn read_about(path: &Path) -> Result<BTreeMap<String, String>, CheckpointError> {
    verify_structure(path)?;
    let file = CheckedFile::open(path)?;
    let mut texts = read_texts(&file)?;
    texts.insert("program_version".to_string(), file.text(PROGRAM_VERSION)?);
    texts.insert("mesh_hash".to_string(), file.text(MESH_HASH)?);
    if let Some(run) = run_of_file(&file)? {
        texts.insert("run".to_string(), run);
    }
    Ok(texts)
}

/// Identity of the run that a step or mesh file is of; None in a file of an earlier version.
pub(crate) fn run_of_file(file: &CheckedFile) -> Result<Option<String>, CheckpointError> {
    let is_there = file.has_text(RUN)?;
    is_there.then(|| file.text(RUN)).transpose()
}

/// Fails if a step or mesh file at `path` is of another run than `expected`. A file of an earlier version says nothing.
pub(crate) fn require_run_in(
    file: &CheckedFile,
    path: &Path,
    expected: Option<&str>,
) -> Result<(), CheckpointError> {
    let (Some(expected), Some(found)) = (expected, run_of_file(file)?) else {
        return Ok(());
    };
    if found == expected {
        return Ok(());
    }
    let (path, expected) = (path.to_path_buf(), expected.to_string());
    Err(CheckpointError::OtherRun {
        path,
        expected,
        found,
    })
}

/// What a step file says about the tables of its run; None if it is of a version that kept no stamps.
pub fn read_stamps(path: &Path) -> Result<Option<Stamps>, CheckpointError> {
    verify_structure(path)?;
    stamps_of(&CheckedFile::open(path)?, path)
}

fn stamps_of(file: &CheckedFile, path: &Path) -> Result<Option<Stamps>, CheckpointError> {
    if !file.has_text(TABLES)? {
        return Ok(None);
    }
    let stamps = parse_stamps(&file.text(TABLES)?);
    let unknown = || CheckpointError::malformed(path, "its checksums of tables are of no known form");
    stamps.ok_or_else(unknown).map(Some)
}

/// The texts that [`crate::Output::describe`] set.
pub(crate) fn read_texts(file: &CheckedFile) -> Result<BTreeMap<String, String>, CheckpointError> {
    let read = |name: String| Ok((name.clone(), file.text(&format!("{ABOUT}/{name}"))?));
    file.texts(ABOUT)?.into_iter().map(read).collect()
}

/// Version of the program that wrote a step.
pub(crate) fn read_version(file: &CheckedFile) -> Result<String, CheckpointError> {
    file.text(PROGRAM_VERSION)
}

/// How the arrays of a step are stored.
pub(crate) fn read_storage(file: &CheckedFile) -> Result<Storage, CheckpointError> {
    let stress = [
        format!("{POINT_DATA}/stress"),
        format!("{POINT_DATA}/von_mises"),
        format!("{CELL_DATA}/stress_integration_points"),
        format!("{CELL_DATA}/von_mises_largest"),
    ];
    let stress = stress.iter().find(|path| file.has(path));
    let displacement = Some(format!("{POINT_DATA}/displacement")).filter(|path| file.has(path));
    // Any of them tells the level of all.
    let force = format!("{POINT_DATA}/force_inner");
    let compressed = displacement.as_ref().or(stress).unwrap_or(&force);
    Ok(Storage {
        stress: stress.map_or(Ok(Precision::default()), |path| file.precision(path))?,
        stress_error: stress.map_or(Ok(None), |path| file.error_bound(path))?,
        displacement: displacement
            .as_ref()
            .map_or(Ok(Precision::F64), |path| file.precision(path))?,
        compression: match file.has(compressed) {
            true => file.compression(compressed)?,
            false => Compression::None,
        },
    })
}

/// What a step file says about itself.
pub(crate) struct Contents {
    pub step: u64,
    pub time: f64,
    pub scene: String,
    /// Paths of its arrays.
    pub arrays: Vec<String>,
}

/// Reads number, time, scene and the names of the arrays; the structure of the file must have been verified.
pub(crate) fn read_contents(file: &CheckedFile) -> Result<Contents, CheckpointError> {
    Ok(Contents {
        step: file.scalar::<i64>(STEP)?.max(0) as u64,
        time: file.scalar(TIME)?,
        scene: file.text(SCENE)?,
        arrays: file.text(CONTENTS)?.lines().map(str::to_string).collect(),
    })
}

/// Time of a step, s.
pub(crate) fn read_time(file: &CheckedFile) -> Result<f64, CheckpointError> {
    file.scalar(TIME)
}

/// Fingerprint of the mesh a step belongs to.
pub(crate) fn read_mesh_hash(file: &CheckedFile) -> Result<String, CheckpointError> {
    file.text(MESH_HASH)
}

pub(crate) fn read_step_number(file: &CheckedFile, path: &Path) -> Result<u64, CheckpointError> {
    let step: i64 = file.scalar(STEP)?;
    u64::try_from(step).map_err(|_| {
        CheckpointError::malformed(path, format!("its step number is {step}, expected 0 or more"))
    })
}

/// Fails unless the data sets in the file are those that were written.
fn require_contents(file: &CheckedFile, path: &Path) -> Result<(), CheckpointError> {
    let contents = file.text(CONTENTS)?;
    for dataset in contents.lines() {
        if !file.has(dataset) {
            return Err(CheckpointError::malformed(
                path,
                format!("data set {dataset} is missing"),
            ));
        }
    }
    let groups = [
        (POINT_DATA, file.members(POINT_DATA)?),
        (CELL_DATA, step_cell_fields(file)?),
        (STATE, file.members(STATE)?),
    ];
    for (group, names) in groups {
        for name in names {
            let dataset = format!("{group}/{name}");
            if !contents.lines().any(|line| line == dataset) {
                return Err(CheckpointError::malformed(
                    path,
                    format!("data set {dataset} is not expected"),
                ));
            }
        }
    }
    Ok(())
}

fn read_field(
    file: &CheckedFile,
    path: &Path,
    name: &str,
    points: &mut PointFields,
) -> Result<(), CheckpointError> {
    let dataset = format!("{POINT_DATA}/{name}");
    let (shape, values) = file.field(&dataset)?;
    match (name, &shape[..]) {
        ("displacement", [_, 3]) => points.displacement = rows(&values),
        ("velocity", [_, 3]) => points.velocity = Some(rows(&values)),
        ("acceleration", [_, 3]) => points.acceleration = Some(rows(&values)),
        ("stress", [_, 6]) => points.stress = Some(rows(&values)),
        ("von_mises", [_]) => points.von_mises = Some(values),
        ("force_inner", [_, 3]) => points.force_inner = Some(rows(&values)),
        ("force_outer", [_, 3]) => points.force_outer = Some(rows(&values)),
        (IN_REGION, [_]) => points.in_region = Some(values),
        _ => return Err(unknown(path, &dataset, &shape)),
    }
    Ok(())
}

/// Names of the fields over cells that are the step's own.
pub(crate) fn step_cell_fields(file: &CheckedFile) -> Result<Vec<String>, CheckpointError> {
    let mut names = file.members(CELL_DATA)?;
    names.retain(|name| !MESH_CELL_DATA.contains(&name.as_str()));
    Ok(names)
}

fn read_cell_field(
    file: &CheckedFile,
    path: &Path,
    name: &str,
    cells: &mut CellFields,
) -> Result<(), CheckpointError> {
    let dataset = format!("{CELL_DATA}/{name}");
    let (shape, values) = file.field(&dataset)?;
    match (name, &shape[..]) {
        ("stress_integration_points", &[_, n]) if n > 0 && n % TENSOR == 0 => {
            cells.stress_integration_points = Some(IntegrationPointStress {
                points_per_cell: n / TENSOR,
                values,
                layout: file.text(STRESS_LAYOUT)?,
            });
        }
        ("von_mises_largest", [_]) => cells.von_mises_largest = Some(values),
        (IN_REGION, [_]) => cells.in_region = Some(values),
        _ => return Err(unknown(path, &dataset, &shape)),
    }
    Ok(())
}

fn unknown(path: &Path, dataset: &str, shape: &[usize]) -> CheckpointError {
    let what = format!("data set {dataset} with shape {shape:?} is not known to this version");
    CheckpointError::malformed(path, what)
}

/// Rows of a flat array.
fn rows<const N: usize>(values: &[f64]) -> Vec<[f64; N]> {
    values.as_chunks::<N>().0.to_vec()
}
