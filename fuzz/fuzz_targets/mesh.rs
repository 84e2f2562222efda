//! Any bytes as a Gmsh file: a ring or a section is read or refused, without a panic, a hang or an absurd allocation.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

fn path() -> PathBuf {
    static DIR: OnceLock<TempDir> = OnceLock::new();
    DIR.get_or_init(|| tempfile::tempdir().unwrap()).path().join("ring.msh")
}

fuzz_target!(|data: &[u8]| {
    let path = path();
    std::fs::write(&path, data).unwrap();
    if let Ok((mesh, _)) = mesh::read_msh_with_origin(&path, 1e-3) {
        assert!(mesh.nodes.iter().flatten().all(|x| x.is_finite()));
        assert!(mesh.connectivity.iter().all(|n| *n < mesh.n_nodes()));
        let _ = mesh::find_periodicity(&mesh, mesh::PERIODIC_TOLERANCE);
    } else {
        let _ = mesh::read_section(&path, 1e-3);
    }
});
