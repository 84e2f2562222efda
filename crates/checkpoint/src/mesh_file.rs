//! The file `mesh.hdf`: all bodies as one VTKHDF unstructured grid, to which every step links.

use std::path::Path;

use crate::atomic::{self, Format};
use crate::dataset::{CheckedFile, create_group, create_vtkhdf, write_array, write_text};
use crate::error::CheckpointError;
use crate::grid::Grid;
use crate::seal::verify_seal;
use crate::storage::Compression;

/// Name of the file in the result folder.
pub(crate) const MESH_FILE: &str = "mesh.hdf";

/// Fingerprint of the mesh, in `mesh.hdf` and in every step.
pub(crate) const MESH_HASH: &str = "/restart/mesh_hash";

/// Writes `mesh.hdf`. It is small beside the steps, so it is never compressed.
pub(crate) fn write_mesh(dir: &Path, grid: &Grid) -> Result<(), CheckpointError> {
    atomic::write_hdf(dir, MESH_FILE, Format::Earliest, |file| {
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
        Ok(["Points", "Connectivity", "Offsets", "Types"]
            .map(|name| format!("/VTKHDF/{name}"))
            .to_vec())
    })
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

/// Fails unless `mesh.hdf` in `dir` holds this grid.
pub(crate) fn require_same_mesh(dir: &Path, grid: &Grid) -> Result<(), CheckpointError> {
    let path = dir.join(MESH_FILE);
    verify_seal(&path)?;
    let (expected, found) = (grid.fingerprint(), CheckedFile::open(&path)?.text(MESH_HASH)?);
    if expected == found {
        return Ok(());
    }
    Err(CheckpointError::MeshMismatch {
        path,
        expected,
        found,
    })
}
