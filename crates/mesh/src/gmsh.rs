//! Runs the program gmsh, for those who have it.

use std::path::Path;
use std::process::Command;

use crate::error::MeshError;

/// Meshes the section in `geo_path` (see [`crate::ring_geo`]) with quadrangles: `gmsh -2`.
pub fn mesh_section_with_gmsh(
    geo_path: impl AsRef<Path>,
    msh_path: impl AsRef<Path>,
) -> Result<(), MeshError> {
    run(
        "gmsh".as_ref(),
        &["-2", "-order", "1"],
        geo_path.as_ref(),
        msh_path.as_ref(),
    )
}

/// Meshes the ring in `geo_path` (see [`crate::ring_tet_geo`]) with quadratic tetrahedra: `gmsh -3 -order 2`.
pub fn mesh_tets_with_gmsh(geo_path: impl AsRef<Path>, msh_path: impl AsRef<Path>) -> Result<(), MeshError> {
    run(
        "gmsh".as_ref(),
        &["-3", "-order", "2"],
        geo_path.as_ref(),
        msh_path.as_ref(),
    )
}

/// Runs `program` and checks that it left a file. Gmsh exits 0 after some errors, so an old file is moved out of
/// the way by writing to a new name first.
fn run(program: &Path, arguments: &[&str], geo: &Path, msh: &Path) -> Result<(), MeshError> {
    // Gmsh would mesh a file that is not there as an empty model.
    std::fs::metadata(geo).map_err(|source| MeshError::Io {
        action: "read",
        path: geo.to_path_buf(),
        source,
    })?;
    let fresh = msh.with_extension("new.msh");
    let mut command = Command::new(program);
    command
        .arg(geo)
        .args(arguments)
        .args(["-format", "msh41", "-v", "2", "-o"])
        .arg(&fresh);
    let output = command.output().map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => MeshError::NoGmsh {
            path: geo.to_path_buf(),
        },
        _ => MeshError::Io {
            action: "run gmsh on",
            path: geo.to_path_buf(),
            source,
        },
    })?;
    if !output.status.success() || !fresh.exists() {
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        let lines: Vec<&str> = text
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty())
            .collect();
        let last = lines[lines.len().saturating_sub(5)..].join("; ");
        let output_text = if last.is_empty() {
            "it said nothing".to_string()
        } else {
            last
        };
        // A partial file must not be taken for a mesh; that it may be absent is fine.
        let _ = std::fs::remove_file(&fresh);
        return Err(MeshError::GmshFailed {
            path: geo.to_path_buf(),
            status: output.status.to_string(),
            output: output_text,
        });
    }
    std::fs::rename(&fresh, msh).map_err(|source| MeshError::Io {
        action: "write",
        path: msh.to_path_buf(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this failed, a user without gmsh would see an operating system's error and not know what to install.
    #[test]
    fn without_gmsh_the_error_says_how_to_get_it() {
        let folder = tempfile::tempdir().unwrap();
        let geo = folder.path().join("a.geo");
        std::fs::write(&geo, "Point(1) = {0, 0, 0};").unwrap();
        let error = run(
            "no-such-mesher-anywhere".as_ref(),
            &["-2"],
            &geo,
            &folder.path().join("a.msh"),
        );
        let text = error.unwrap_err().to_string();
        assert!(
            text.contains("apt-get install gmsh") && text.contains("pip install gmsh"),
            "{text}"
        );
    }

    /// If this failed, a program that ends well without a mesh would count as success.
    #[test]
    fn a_run_that_leaves_no_mesh_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let geo = folder.path().join("a.geo");
        std::fs::write(&geo, "Point(1) = {0, 0, 0};").unwrap();
        let error = run("echo".as_ref(), &["-2"], &geo, &folder.path().join("a.msh"));
        let text = error.unwrap_err().to_string();
        assert!(
            text.contains("could not mesh") && text.contains("a.geo"),
            "{text}"
        );
    }

    /// If this failed, a mistyped file name would be meshed as an empty geometry.
    #[test]
    fn a_missing_geometry_is_named() {
        let error = mesh_section_with_gmsh("nowhere/a.geo", "nowhere/a.msh")
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("cannot read nowhere/a.geo"), "{error}");
    }
}
