//! Files by gmsh in all forms, and a second opinion.

use mesh::{ElementKind, Facet, Mesh, read_msh, require_groups, volume};

use crate::data;

/// If this failed, the form in which gmsh writes a mesh would change the mesh.
#[test]
fn all_forms_of_one_gmsh_mesh_are_the_same_mesh() {
    let expected = read_msh(data("box_hex8.msh"), 1e-3).unwrap();
    assert_eq!((expected.n_nodes(), expected.n_elements()), (12, 2));
    let groups: Vec<(&str, usize)> = expected
        .groups
        .iter()
        .map(|(name, f)| (name.as_str(), f.len()))
        .collect();
    assert_eq!(groups, [("raceway", 2), ("seat", 2)]);
    for name in ["box_hex8_binary.msh", "box_hex8_v22.msh"] {
        assert_eq!(read_msh(data(name), 1e-3).unwrap(), expected, "{name}");
    }
}

/// If this failed, a partitioned file would lose elements, or turn them inside out as other readers do.
#[test]
fn partitioned_files_are_the_unpartitioned_mesh() {
    let expected = read_msh(data("box_hex8.msh"), 1e-3).unwrap();
    for name in ["box_hex8_partitioned.msh", "box_hex8_partitioned_binary.msh"] {
        let mesh = read_msh(data(name), 1e-3).unwrap();
        assert_eq!(mesh.nodes, expected.nodes, "{name}");
        assert_eq!(corners(&mesh), corners(&expected), "{name}");
        assert!(
            ["raceway", "seat"].iter().all(|g| mesh.group(g).len() == 2),
            "{name}"
        );
        assert_eq!(mesh.group_nodes("seat"), expected.group_nodes("seat"), "{name}");
    }
}

/// If this failed, every partitioned ring would be refused for the arc centres gmsh writes along, or a stray node in
/// any other file would be dropped in silence.
#[test]
fn unused_points_are_dropped_from_partitioned_files_only() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.msh");
    for (name, is_read) in [("box_hex8_partitioned.msh", true), ("box_hex8.msh", false)] {
        let text = std::fs::read_to_string(data(name)).unwrap();
        let (head, nodes) = text.split_once("$Nodes\n").unwrap();
        let (counts, rest) = nodes.split_once('\n').unwrap();
        let counts: Vec<usize> = counts
            .split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect();
        let (blocks, n) = (counts[0] + 1, counts[1] + 1);
        std::fs::write(
            &path,
            format!("{head}$Nodes\n{blocks} {n} 1 99\n0 1 0 1\n99\n5 5 5\n{rest}"),
        )
        .unwrap();
        match read_msh(&path, 1.0) {
            Ok(mesh) => assert!(is_read && mesh.n_nodes() == 12, "{name}"),
            Err(error) => assert!(
                !is_read && error.to_string().contains("node 99 is used by no volume"),
                "{error}"
            ),
        }
    }
}

/// Sorted node lists of all elements: partitioning renumbers elements.
fn corners(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut lists: Vec<Vec<usize>> = (0..mesh.n_elements()).map(|e| mesh.element(e).to_vec()).collect();
    lists.sort();
    lists
}

/// If this failed, mid-nodes would sit on wrong edges: shape functions of hex20 and tet10 would be permuted.
#[test]
fn each_mid_node_lies_in_the_middle_of_its_edge() {
    for (name, kind) in [
        ("box_hex20.msh", ElementKind::Hex20),
        ("box_hex20_parametric.msh", ElementKind::Hex20),
        ("box_tet10.msh", ElementKind::Tet10),
    ] {
        let mesh = read_msh(data(name), 1.0).unwrap();
        assert_eq!(mesh.kind, kind, "{name}");
        for e in 0..mesh.n_elements() {
            let nodes = mesh.element(e);
            for (i, &[a, b]) in kind.edges().iter().enumerate() {
                let mid = mesh.nodes[nodes[kind.n_corners() + i]];
                for c in 0..3 {
                    let middle = 0.5 * (mesh.nodes[nodes[a]][c] + mesh.nodes[nodes[b]][c]);
                    // Gmsh places nodes by curve parameters, to about 1e-13 of the length 1.
                    assert!(
                        (mid[c] - middle).abs() < 1e-11,
                        "{name}, element {e}, edge {i}: {mid:?}"
                    );
                }
            }
        }
        // The box is 1 x 1 x 1; straight edges, so rounding only.
        assert!((volume(&mesh) - 1.0).abs() < 1e-11, "{name}: {}", volume(&mesh));
    }
}

/// If this failed, pressure would pull instead of push on some facets.
#[test]
fn facet_normals_point_outwards() {
    for name in ["box_hex8.msh", "box_hex20.msh", "box_tet10.msh"] {
        let mesh = read_msh(data(name), 1.0).unwrap();
        for (group, sign) in [("raceway", -1.0), ("seat", 1.0)] {
            let mut area = 0.0;
            for &facet in mesh.group(group) {
                let z = doubled_area_z(&mesh, facet);
                assert!(sign * z > 0.0, "{name}: {group} {facet:?}");
                area += 0.5 * sign * z;
            }
            assert!(
                (area - 1.0).abs() < 1e-11,
                "{name}: {group} covers {area} of the unit square"
            );
        }
    }
}

/// z component of twice the area of the facet's polygon of corners.
fn doubled_area_z(mesh: &Mesh, facet: Facet) -> f64 {
    let n = mesh.kind.facet_kind().n_corners();
    let x: Vec<[f64; 3]> = mesh
        .facet_nodes(facet)
        .take(n)
        .map(|node| mesh.nodes[node])
        .collect();
    (0..n)
        .map(|i| x[i][0] * x[(i + 1) % n][1] - x[(i + 1) % n][0] * x[i][1])
        .sum()
}

/// If this failed, the reader would disagree with an independent one about a plain file.
#[test]
fn mshio_reads_the_same_nodes_and_elements() {
    for (name, n_nodes) in [("box_hex8_binary.msh", 8), ("box_hex20.msh", 20)] {
        let ours = read_msh(data(name), 1.0).unwrap();
        let bytes = std::fs::read(data(name)).unwrap();
        let theirs = mshio::parse_msh_bytes(&bytes).map_err(|e| e.to_string()).unwrap();
        let blocks = &theirs.data.nodes.as_ref().unwrap().node_blocks;
        let nodes: Vec<[f64; 3]> = blocks
            .iter()
            .flat_map(|b| b.nodes.iter().map(|n| [n.x, n.y, n.z]))
            .collect();
        assert_eq!(ours.nodes.to_vec(), nodes, "{name}");
        let blocks = &theirs.data.elements.as_ref().unwrap().element_blocks;
        let volumes = blocks.iter().filter(|b| b.entity_dim == 3);
        let elements: Vec<Vec<u64>> = volumes
            .flat_map(|b| b.elements.iter().map(|e| e.nodes.clone()))
            .collect();
        assert_eq!(elements.len(), ours.n_elements(), "{name}");
        for (e, theirs) in elements.iter().enumerate() {
            assert_eq!(theirs.len(), n_nodes);
            let order = ours.kind.gmsh_order();
            let reordered: Vec<usize> = order.iter().map(|&i| theirs[i] as usize - 1).collect();
            assert_eq!(ours.element(e), reordered, "{name}, element {e}");
        }
    }
}

/// If this failed, unsuitable but well-formed files would give no way out.
#[test]
fn unsuitable_files_name_the_remedy() {
    let text = |name: &str| read_msh(data(name), 1.0).unwrap_err().to_string();
    let error = text("box_hex27.msh");
    assert!(error.contains("2 elements of type 27-node hexahedron"), "{error}");
    assert!(error.contains("Mesh.SecondOrderIncomplete=1"), "{error}");
    let error = text("box_v22_binary.msh");
    assert!(
        error.contains("MSH 2.2 binary") && error.contains("-format msh41"),
        "{error}"
    );
    let error = text("outer_section.msh");
    assert!(
        error.contains("no physical Volume \"ring\" with elements; physical Volumes are none"),
        "{error}"
    );
    let error = text("box.geo");
    assert!(error.contains("is not a gmsh mesh"), "{error}");
    let error = text("absent.msh");
    assert!(
        error.contains("cannot read") && error.contains("absent.msh"),
        "{error}"
    );
    let error = read_msh(data("box_hex8.msh"), 0.0).unwrap_err().to_string();
    assert!(error.contains("mesh unit 0 m is not a length"), "{error}");
}

/// If this failed, a missing raceway would be found only when a ball falls through it.
#[test]
fn a_missing_group_lists_those_there() {
    let path = data("box_hex8.msh");
    let mut mesh = read_msh(&path, 1.0).unwrap();
    require_groups(&mesh, &path, &["raceway", "seat"]).unwrap();
    let error = require_groups(&mesh, &path, &["raceway", "bore"])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("has no facet group \"bore\"; groups are \"raceway\", \"seat\""),
        "{error}"
    );
    mesh.groups.insert("bore".to_string(), Vec::new());
    let error = require_groups(&mesh, &path, &["bore"]).unwrap_err().to_string();
    assert!(error.contains("an empty facet group \"bore\""), "{error}");
}
