//! Runs the program gmsh, for those who have it.

use std::path::Path;
use std::process::Command;

use crate::error::MeshError;

/// Makes the command that starts Gmsh; arguments are added to it.
pub type Gmsh<'a> = &'a dyn Fn() -> Command;

/// Exit code of a command that did not find Gmsh, as shells have it; without a word, as Gmsh itself is not.
pub const NO_GMSH: u8 = 127;

/// Meshes the section in `geo_path` (see [`crate::ring_geo`]) with quadrangles: `gmsh -2`.
pub fn mesh_section_with_gmsh(
    gmsh: Gmsh<'_>,
    geo_path: impl AsRef<Path>,
    msh_path: impl AsRef<Path>,
) -> Result<(), MeshError> {
    run(gmsh, &["-2", "-order", "1"], geo_path.as_ref(), msh_path.as_ref())
}

/// Meshes the ring in `geo_path` (see [`crate::ring_tet_geo`]) with quadratic tetrahedra: `gmsh -3 -order 2`.
pub fn mesh_tets_with_gmsh(
    gmsh: Gmsh<'_>,
    geo_path: impl AsRef<Path>,
    msh_path: impl AsRef<Path>,
) -> Result<(), MeshError> {
    run(gmsh, &["-3", "-order", "2"], geo_path.as_ref(), msh_path.as_ref())
}

/// Runs Gmsh and checks that it left a file. Gmsh exits 0 after some errors, and writes through links, so that it
/// writes to a new name first.
fn run(gmsh: Gmsh<'_>, arguments: &[&str], geo: &Path, msh: &Path) -> Result<(), MeshError> {
    // Gmsh would mesh a file that is not there as an empty model.
    std::fs::metadata(geo).map_err(|source| MeshError::Io {
        action: "read",
        path: geo.to_path_buf(),
        source,
    })?;
    let fresh = msh.with_extension("new.msh");
    // What a killed run left under this name goes, also a link; it is gone if there was none.
    let _ = std::fs::remove_file(&fresh);
    let mut command = gmsh();
    command
        .arg(geo)
        .args(arguments)
        .args(["-format", "msh41", "-v", "2", "-o"])
        .arg(&fresh);
    let no_gmsh = || MeshError::NoGmsh {
        path: geo.to_path_buf(),
    };
    let output = command.output().map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => no_gmsh(),
        _ => MeshError::Io {
            action: "run gmsh on",
            path: geo.to_path_buf(),
            source,
        },
    })?;
    let text = [output.stdout, output.stderr].concat();
    if text.is_empty() && output.status.code() == Some(NO_GMSH.into()) {
        return Err(no_gmsh());
    }
    if !output.status.success() || !fresh.exists() {
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
    let whole = std::fs::File::open(&fresh).and_then(|file| file.sync_all());
    let written = whole.and_then(|()| std::fs::rename(&fresh, msh));
    written.map_err(|source| MeshError::Io {
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
            &|| Command::new("no-such-mesher-anywhere"),
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
        let error = run(
            &|| Command::new("echo"),
            &["-2"],
            &geo,
            &folder.path().join("a.msh"),
        );
        let text = error.unwrap_err().to_string();
        assert!(
            text.contains("could not mesh") && text.contains("a.geo"),
            "{text}"
        );
    }

    /// If this failed, a mistyped file name would be meshed as an empty geometry.
    #[test]
    fn a_missing_geometry_is_named() {
        let error = mesh_section_with_gmsh(&|| Command::new("echo"), "nowhere/a.geo", "nowhere/a.msh")
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("cannot read nowhere/a.geo"), "{error}");
    }
}
