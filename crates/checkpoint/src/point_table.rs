//! Fields over points that belong to a run as a whole, as a file that ParaView shows: what a run has found of all its
//! steps, such as the largest stress at every point.
//!
//! The layout is that of a step file: VTKHDF 1.0 with external links to `mesh.hdf`, the fields in
//! `/VTKHDF/PointData`, texts about the run in `/restart`, checksums and seal. There is no state in it.

use std::collections::BTreeMap;
use std::path::Path;

use crate::atomic::{Format, Unsealed};
use crate::dataset::{CheckedFile, create_group, create_vtkhdf, link_mesh, write_text, write_values};
use crate::error::CheckpointError;
use crate::mesh_file::{MESH_FILE, MESH_HASH, RUN};
use crate::record::require_texts;
use crate::seal::verify_seal;
use crate::step::{ABOUT, POINT_DATA, PROGRAM_VERSION, StepOrigin, read_texts, require_run_in};
use crate::storage::{Compression, Precision};

/// Fields of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointTable {
    /// The fields, in the order of the file.
    pub fields: Vec<TableField>,
    /// Texts about them, by name (letters, digits, `_`).
    pub about: BTreeMap<String, String>,
}

/// One field over the points of all bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct TableField {
    /// Name: letters, digits, `_`.
    pub name: String,
    /// Numbers of a point: 1, or 6 of a tensor, xx yy zz xy yz xz.
    pub n_components: usize,
    /// Row-major values, `[n_points][n_components]`, flat.
    pub values: Vec<f64>,
}

/// Writes a file into `dir`, as one that gets its name later: its name, and the step up to which it knows the run.
pub(crate) fn write_table(
    dir: &Path,
    named: (&str, u64),
    table: &PointTable,
    n_points: usize,
    (origin, precision): (&StepOrigin<'_>, Precision),
) -> Result<Unsealed, CheckpointError> {
    require_texts(&table.about)?;
    for field in &table.fields {
        let found = field.values.len() / field.n_components.max(1);
        if field.n_components == 0 || field.values.len() != n_points * field.n_components {
            return Err(CheckpointError::TableLength {
                field: field.name.clone(),
                expected: n_points,
                found,
            });
        }
    }
    Unsealed::write_of_step(dir, named, Format::Earliest, |file| {
        create_vtkhdf(file, [1, 0])?;
        link_mesh(file, MESH_FILE)?;
        create_group(file, "restart")?;
        create_group(file, "restart/about")?;
        let mut contents = Vec::new();
        for field in &table.fields {
            let path = format!("{POINT_DATA}/{}", field.name);
            let shape = match field.n_components {
                1 => vec![n_points],
                n => vec![n_points, n],
            };
            write_values(file, &path, &shape, &field.values, precision, Compression::None)?;
            contents.push(path);
        }
        write_text(file, PROGRAM_VERSION, origin.program_version)?;
        write_text(file, MESH_HASH, origin.mesh_hash)?;
        if let Some(run) = origin.run {
            write_text(file, RUN, run)?;
        }
        // What the fields say of themselves goes before what the run says of its steps.
        let of_run = origin
            .about
            .iter()
            .filter(|(name, _)| !table.about.contains_key(*name));
        for (name, text) in of_run.chain(&table.about) {
            write_text(file, &format!("{ABOUT}/{name}"), text)?;
        }
        Ok(contents)
    })
}

/// Reads such a file, every byte verified; fails if it is of another run than `run`.
pub fn read_table(path: &Path, run: Option<&str>) -> Result<PointTable, CheckpointError> {
    verify_seal(path)?;
    let file = CheckedFile::open(path)?;
    require_run_in(&file, path, run)?;
    let field = |name: String| {
        let (shape, values) = file.field(&format!("{POINT_DATA}/{name}"))?;
        Ok(TableField {
            name,
            n_components: shape.get(1).copied().unwrap_or(1),
            values,
        })
    };
    let names = file.members(POINT_DATA)?;
    Ok(PointTable {
        fields: names
            .into_iter()
            .map(field)
            .collect::<Result<_, CheckpointError>>()?,
        about: read_texts(&file)?,
    })
}
