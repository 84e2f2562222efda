//! Meshes written and read back.

use mesh::{
    ElementKind, Facet, MshFormat, Overwrite, RingSide, read_msh, read_msh_with_origin, read_record,
    write_msh, write_msh_with_record,
};

use crate::{data, revolved};

const FORMATS: [MshFormat; 2] = [MshFormat::Ascii, MshFormat::Binary];

/// If this failed, a generated mesh would not be the one computed on after it went through a file.
#[test]
fn a_mesh_read_back_has_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mut meshes = vec![read_msh(data("box_tet10.msh"), 1.0).unwrap()];
    meshes.push(revolved(RingSide::Outer, 12, ElementKind::Hex8));
    meshes.push(revolved(RingSide::Inner, 12, ElementKind::Hex20));
    meshes[1].groups.insert("empty".to_string(), Vec::new());
    for mesh in &meshes {
        for format in FORMATS {
            let path = folder.path().join("m.msh");
            write_msh(&path, mesh, 1.0, format, Overwrite::Replace).unwrap();
            let (back, origin) = read_msh_with_origin(&path, 1.0).unwrap();
            assert_eq!(&back, mesh, "{:?} {format:?}", mesh.kind);
            assert_eq!(origin, mesh::Origin::of_generated(&path, 1.0, mesh));
        }
    }
}

/// If this failed, what a mesh was made from would get lost or change the mesh, or another program could not read the
/// file.
#[test]
fn a_record_is_read_back_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = revolved(RingSide::Outer, 12, ElementKind::Hex8);
    let (with, without) = (folder.path().join("with.msh"), folder.path().join("without.msh"));
    let record = "outer.section.sectors = 12; bearing.width = 16 mm";
    write_msh_with_record(&with, &mesh, 1.0, Overwrite::Replace, record).unwrap();
    write_msh(&without, &mesh, 1.0, MshFormat::Binary, Overwrite::Replace).unwrap();
    assert_eq!(read_record(&with).unwrap().as_deref(), Some(record));
    assert_eq!(read_record(&without).unwrap(), None);
    assert_eq!(read_msh(&with, 1.0).unwrap(), read_msh(&without, 1.0).unwrap());
    let section = format!("$Comments\nmade by raceway mesh from {record}\n$EndComments\n");
    let [with, without] = [with, without].map(|path| std::fs::read(path).unwrap());
    let at = with
        .windows(section.len())
        .position(|bytes| bytes == section.as_bytes())
        .unwrap();
    assert_eq!([&with[..at], &with[at + section.len()..]].concat(), without);
    assert!(mshio::parse_msh_bytes(&with).is_ok());
}

/// If this failed, millimetres would not survive a file; one unit in the last place is lost at most.
#[test]
fn millimetres_survive_to_the_last_place() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = revolved(RingSide::Outer, 12, ElementKind::Hex20);
    for format in FORMATS {
        let path = folder.path().join("m.msh");
        write_msh(&path, &mesh, 1e-3, format, Overwrite::Replace).unwrap();
        let back = read_msh(&path, 1e-3).unwrap();
        assert_eq!(
            (back.kind, &back.connectivity, &back.groups),
            (mesh.kind, &mesh.connectivity, &mesh.groups)
        );
        for (a, b) in back.nodes.iter().flatten().zip(mesh.nodes.iter().flatten()) {
            // One rounding in the division, one in the product.
            assert!((a - b).abs() <= 2.0 * f64::EPSILON * b.abs(), "{a:e} from {b:e}");
        }
    }
}

/// If this failed, a second opinion would not understand our files.
#[test]
fn mshio_reads_what_we_write() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = revolved(RingSide::Inner, 6, ElementKind::Hex20);
    for format in FORMATS {
        let path = folder.path().join("m.msh");
        write_msh(&path, &mesh, 1.0, format, Overwrite::Replace).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let theirs = mshio::parse_msh_bytes(&bytes).map_err(|e| e.to_string()).unwrap();
        let blocks = theirs.data.nodes.unwrap().node_blocks;
        let nodes: Vec<[f64; 3]> = blocks
            .iter()
            .flat_map(|b| b.nodes.iter().map(|n| [n.x, n.y, n.z]))
            .collect();
        assert_eq!(nodes, mesh.nodes.to_vec(), "{format:?}");
        let elements = theirs.data.elements.unwrap();
        let n_facets: usize = mesh.groups.values().map(Vec::len).sum();
        assert_eq!(
            elements.num_elements as usize,
            mesh.n_elements() + n_facets,
            "{format:?}"
        );
    }
}

/// If this failed, a mesh could be lost to a mistyped name.
#[test]
fn a_file_is_replaced_only_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.msh");
    let mesh = read_msh(data("box_hex8.msh"), 1.0).unwrap();
    std::fs::write(&path, "$MeshFormat precious").unwrap();
    let error = write_msh(&path, &mesh, 1.0, MshFormat::Ascii, Overwrite::Refuse)
        .unwrap_err()
        .to_string();
    assert!(error.contains("exists already and is not overwritten"), "{error}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "$MeshFormat precious");
    write_msh(&path, &mesh, 1.0, MshFormat::Ascii, Overwrite::Replace).unwrap();
    assert_eq!(read_msh(&path, 1.0).unwrap(), mesh);
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "no temporary file is left: {left:?}");
}

/// If this failed, the file would silently lose one of two groups.
#[test]
fn overlapping_groups_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.msh");
    let mut mesh = read_msh(data("box_hex8.msh"), 1.0).unwrap();
    let facet: Facet = mesh.group("raceway")[1];
    mesh.groups.insert("worn".to_string(), vec![facet]);
    let error = write_msh(&path, &mesh, 1.0, MshFormat::Binary, Overwrite::Refuse)
        .unwrap_err()
        .to_string();
    let expected = format!(
        "face {} of element {} is in the groups \"raceway\" and \"worn\"",
        facet.face,
        facet.element + 1
    );
    assert!(error.contains(&expected), "{error}");
    mesh.groups.clear();
    mesh.groups.insert("a\"b".to_string(), vec![facet]);
    let error = write_msh(&path, &mesh, 1.0, MshFormat::Ascii, Overwrite::Refuse)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("does not fit the format") && !path.exists(),
        "{error}"
    );
}

/// If this failed, `raceway mesh --force` would replace a scene that stands in the place of a mesh by a slip.
#[test]
fn only_a_mesh_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = revolved(RingSide::Outer, 12, ElementKind::Hex8);
    let path = folder.path().join("scene.toml");
    for content in ["[static]", "", "$MeshForma"] {
        std::fs::write(&path, content).unwrap();
        let error = write_msh(&path, &mesh, 1.0, MshFormat::Ascii, Overwrite::Replace).unwrap_err();
        let cause = std::error::Error::source(&error).unwrap().to_string();
        assert!(error.to_string().starts_with("cannot write "), "{error}");
        assert_eq!(
            cause,
            "it is no mesh, so it is not written over; move it away or choose another name"
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), content);
    }
}
