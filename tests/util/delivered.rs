//! Folders with the scenes and meshes that are delivered.

use std::path::Path;

use super::Dir;

/// A folder with the delivered scene and its meshes.
pub fn delivered() -> Dir {
    let dir = Dir::empty();
    for name in ["scenes", "meshes"] {
        std::os::unix::fs::symlink(root().join(name), dir.path(name)).unwrap();
    }
    dir
}

/// A folder with scenes of the type 7010C and their meshes, where that type has the coarse meshes of its rings: a
/// seventh of the dofs, for what asks for no accuracy.
pub fn coarse(scenes: &[&str]) -> Dir {
    let dir = Dir::empty();
    std::os::unix::fs::symlink(root().join("meshes"), dir.path("meshes")).unwrap();
    std::fs::create_dir_all(dir.path("scenes/types")).unwrap();
    let read = |name: &str| std::fs::read_to_string(root().join(name)).unwrap();
    for name in scenes {
        dir.write(name, read(name));
    }
    let mut kind = read("scenes/types/7010c.toml");
    for (fine, coarse) in [
        ("7010c_inner.msh", "7010c_inner_coarse.msh"),
        ("7010c_outer.msh", "7010c_outer_coarse.msh"),
        ("sectors = 180", "sectors = 90"),
        ("groove_elements = 12", "groove_elements = 6"),
        ("thickness_elements = 4", "thickness_elements = 2"),
        ("shoulder_elements = 3", "shoulder_elements = 1"),
    ] {
        assert!(kind.contains(fine), "the type has no {fine}");
        kind = kind.replace(fine, coarse);
    }
    dir.write("scenes/types/7010c.toml", kind);
    dir
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
