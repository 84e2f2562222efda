//! The file `mesh.hdf`: all bodies as one VTKHDF unstructured grid, to which every step links.

use std::fs::File;
use std::path::Path;

use crate::atomic::{self, Format};
use crate::body::Body;
use crate::dataset::{CheckedFile, create_group, create_vtkhdf, write_array, write_text};
use crate::error::CheckpointError;
use crate::grid::Grid;
use crate::seal::verify_seal;
use crate::storage::Compression;

pub(crate) use crate::error::MESH_FILE;

/// Fingerprint of the mesh, in `mesh.hdf` and in every step.
pub(crate) const MESH_HASH: &str = "/restart/mesh_hash";

/// Identity of the run, in `mesh.hdf` and in every step; absent in files of earlier versions.
pub(crate) const RUN: &str = "/restart/run";

/// The content of `mesh.hdf`, before there is a folder for it.
#[derive(Debug)]
pub struct MeshFile {
    pub(crate) n_points: usize,
    pub(crate) n_cells: usize,
    pub(crate) hash: String,
    pub(crate) run: Option<String>,
    content: Content,
}

/// Where the content is.
#[derive(Debug)]
enum Content {
    Memory(Grid),
    Disk(File),
}

impl MeshFile {
    /// That of some bodies.
    pub fn new(bodies: &[Body]) -> Result<MeshFile, CheckpointError> {
        let grid = Grid::join(bodies)?;
        Ok(MeshFile {
            n_points: grid.points.len(),
            n_cells: grid.types.len(),
            hash: grid.fingerprint(),
            run: None,
            content: Content::Memory(grid),
        })
    }

    /// The same as a file of the run with this identity. To be said before it is spooled.
    pub fn of_run(self, run: String) -> MeshFile {
        let run = Some(run);
        MeshFile { run, ..self }
    }

    /// The same on the disk of the folder `dir`, which need not exist yet, instead of in memory. No other process
    /// sees the file, and nothing is left of it when this one ends.
    pub fn spooled(self, dir: &Path) -> Result<MeshFile, CheckpointError> {
        let Content::Memory(grid) = &self.content else {
            return Ok(self);
        };
        let absolute = std::path::absolute(dir).map_err(CheckpointError::io("find folder", dir))?;
        let above = absolute.ancestors().find(|path| path.is_dir()).unwrap_or(dir);
        let fill = |file: &hdf5::File| fill(file, grid, self.run.as_deref());
        let file = atomic::write_unnamed_hdf(above, MESH_FILE, Format::Earliest, fill)?;
        Ok(MeshFile {
            content: Content::Disk(file),
            ..self
        })
    }

    /// Writes `mesh.hdf`. It is small beside the steps, so it is never compressed.
    pub(crate) fn write(&self, dir: &Path) -> Result<(), CheckpointError> {
        match &self.content {
            Content::Memory(grid) => atomic::write_hdf(dir, MESH_FILE, Format::Earliest, |file| {
                fill(file, grid, self.run.as_deref())
            }),
            Content::Disk(file) => atomic::write_copy(dir, MESH_FILE, file),
        }
    }
}

/// Fills the file, and says which data sets a message about damage shall name.
fn fill(file: &hdf5::File, grid: &Grid, run: Option<&str>) -> hdf5::Result<Vec<String>> {
    create_vtkhdf(file, [1, 0])?;
    let plain = Compression::None;
    let (n_points, n_cells) = (grid.points.len(), grid.types.len());
    let sizes = [
        ("NumberOfPoints", n_points),
        ("NumberOfCells", n_cells),
        ("NumberOfConnectivityIds", grid.connectivity.len()),
    ];
    for (name, size) in sizes {
        write_array(file, &format!("/VTKHDF/{name}"), &[1], &[size as i64], plain)?;
    }
    write_array(
        file,
        "/VTKHDF/Points",
        &[n_points, 3],
        grid.points.as_flattened(),
        plain,
    )?;
    write_array(
        file,
        "/VTKHDF/Connectivity",
        &[grid.connectivity.len()],
        &grid.connectivity,
        plain,
    )?;
    write_array(
        file,
        "/VTKHDF/Offsets",
        &[grid.offsets.len()],
        &grid.offsets,
        plain,
    )?;
    write_array(file, "/VTKHDF/Types", &[n_cells], &grid.types, plain)?;
    write_array(file, "/VTKHDF/CellData/body", &[n_cells], &grid.body, plain)?;
    write_array(file, "/VTKHDF/CellData/radius", &[n_cells], &grid.radius, plain)?;
    create_group(file, "restart")?;
    write_text(file, MESH_HASH, &grid.fingerprint())?;
    if let Some(run) = run {
        write_text(file, RUN, run)?;
    }
    Ok(["Points", "Connectivity", "Offsets", "Types"]
        .map(|name| format!("/VTKHDF/{name}"))
        .to_vec())
}

/// Reads `mesh.hdf` of the folder `dir`, every byte verified.
pub fn read_mesh(dir: &Path) -> Result<Grid, CheckpointError> {
    let path = dir.join(MESH_FILE);
    verify_seal(&path)?;
    let file = CheckedFile::open(&path)?;
    let grid = Grid {
        points: file.array::<f64>("/VTKHDF/Points")?.1.as_chunks::<3>().0.to_vec(),
        connectivity: file.array("/VTKHDF/Connectivity")?.1,
        offsets: file.array("/VTKHDF/Offsets")?.1,
        types: file.array("/VTKHDF/Types")?.1,
        body: file.array("/VTKHDF/CellData/body")?.1,
        radius: file.array("/VTKHDF/CellData/radius")?.1,
    };
    if !grid.is_sound() {
        return Err(CheckpointError::malformed(
            &path,
            "its cells do not fit its points",
        ));
    }
    let (expected, found) = (file.text(MESH_HASH)?, grid.fingerprint());
    if expected == found {
        return Ok(grid);
    }
    Err(CheckpointError::MeshMismatch {
        path,
        expected,
        found,
    })
}

/// Fails unless `mesh.hdf` in `dir` holds this mesh.
pub(crate) fn require_same_mesh(dir: &Path, mesh: &MeshFile) -> Result<(), CheckpointError> {
    let path = dir.join(MESH_FILE);
    verify_seal(&path)?;
    let (expected, found) = (mesh.hash.clone(), CheckedFile::open(&path)?.text(MESH_HASH)?);
    if expected == found {
        return Ok(());
    }
    Err(CheckpointError::MeshMismatch {
        path,
        expected,
        found,
    })
}
