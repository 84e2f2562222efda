//! What a result file holds, without reading its values: names, shapes, sizes and texts.

use std::collections::BTreeMap;
use std::path::Path;

use crate::dataset::CheckedFile;
use crate::error::CheckpointError;
use crate::mesh_file::{MESH_FILE, MESH_HASH};
use crate::names::INDEX_FILE;
use crate::seal::{verify_seal, verify_structure};
use crate::step::{POINT_DATA, STEP, read_about, read_contents, run_of_file};

/// One array of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArrayDescription {
    /// Path in the file.
    pub path: String,
    /// Type of its numbers, as the HDF5 library calls it.
    pub kind: String,
    /// Shape, rows first.
    pub shape: Vec<usize>,
    /// Bytes of its values, uncompressed.
    pub bytes: u64,
}

/// A mesh or step file, or one of fields of the whole run.
#[derive(Debug)]
pub struct FileDescription {
    /// Bytes of the file.
    pub bytes: u64,
    /// Its arrays.
    pub arrays: Vec<ArrayDescription>,
    /// Number and time, s, of a step; None for others.
    pub step: Option<(u64, f64)>,
    /// Scene of a step.
    pub scene: Option<String>,
    /// Texts about the run, with `program_version` and `mesh_hash` where the file has them.
    pub about: BTreeMap<String, String>,
    /// Why the file is not as it was written, if it is not.
    pub damage: Option<CheckpointError>,
}

/// Describes a mesh or step file. Every byte is verified; damage of values is reported, not an error, as long as the
/// structure can be trusted.
pub fn describe(path: &Path) -> Result<FileDescription, CheckpointError> {
    verify_structure(path)?;
    let damage = verify_seal(path).err();
    let file = CheckedFile::open(path)?;
    let bytes = std::fs::metadata(path)
        .map_err(CheckpointError::io("read", path))?
        .len();
    if path.file_name().is_some_and(|name| name == MESH_FILE) {
        let names = [
            "Points",
            "Connectivity",
            "Offsets",
            "Types",
            "CellData/body",
            "CellData/radius",
        ];
        let paths = names.map(|name| format!("/VTKHDF/{name}"));
        let mut about = BTreeMap::from([("mesh_hash".to_string(), file.text(MESH_HASH)?)]);
        about.extend(run_of_file(&file)?.map(|run| ("run".to_string(), run)));
        return Ok(FileDescription {
            bytes,
            arrays: arrays(&file, &paths)?,
            step: None,
            scene: None,
            about,
            damage,
        });
    }
    if !file.has(STEP) {
        let fields = file.members(POINT_DATA)?;
        let paths: Vec<String> = fields.iter().map(|name| format!("{POINT_DATA}/{name}")).collect();
        return Ok(FileDescription {
            bytes,
            arrays: arrays(&file, &paths)?,
            step: None,
            scene: None,
            // The index of all steps has no texts: they are those of the steps.
            about: match path.file_name().is_some_and(|name| name == INDEX_FILE) {
                true => BTreeMap::new(),
                false => read_about(path)?,
            },
            damage,
        });
    }
    let contents = read_contents(&file)?;
    Ok(FileDescription {
        bytes,
        arrays: arrays(&file, &contents.arrays)?,
        step: Some((contents.step, contents.time)),
        scene: Some(contents.scene),
        about: read_about(path)?,
        damage,
    })
}

fn arrays(file: &CheckedFile, paths: &[String]) -> Result<Vec<ArrayDescription>, CheckpointError> {
    let array = |path: &String| {
        let (shape, kind) = (file.listed_shape(path)?, file.descriptor(path)?);
        let n = shape.iter().fold(1, |n: usize, &extent| n.saturating_mul(extent));
        Ok(ArrayDescription {
            path: path.clone(),
            bytes: n.saturating_mul(kind.size()) as u64,
            kind: kind.to_string(),
            shape,
        })
    };
    paths.iter().map(array).collect()
}
