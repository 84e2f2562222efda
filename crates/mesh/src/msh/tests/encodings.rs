//! All encodings and numberings of one mesh give one mesh.

use super::*;
use crate::geometry::volume;

/// If this failed, a file from a machine of the other byte order would be refused or read as noise.
#[test]
fn text_and_binary_of_both_byte_orders_give_the_same_mesh() {
    let expected = read(&brick(Encoding::Ascii, PLAIN, IN_ORDER)).unwrap();
    assert_eq!(expected.n_nodes(), 8);
    assert_eq!(expected.group("raceway").len(), 1);
    assert!(
        (volume(&expected) - 1.0).abs() < 1e-15,
        "a unit cube, rounding only"
    );
    for encoding in ENCODINGS {
        assert_eq!(
            read(&brick(encoding, PLAIN, IN_ORDER)).unwrap(),
            expected,
            "{encoding:?}"
        );
    }
}

/// If this failed, renumbered files (dense tags in another order) would become inverted elements without a word.
#[test]
fn renumbered_nodes_give_the_same_elements() {
    let expected = read(&brick(Encoding::Ascii, PLAIN, IN_ORDER)).unwrap();
    for encoding in ENCODINGS {
        let mesh = read(&brick(encoding, PLAIN, [5, 2, 7, 0, 3, 6, 1, 4])).unwrap();
        assert_eq!(mesh, expected, "file order must not matter, {encoding:?}");
        let tags = [6, 2, 8, 1, 4, 7, 3, 5];
        let mesh = read(&brick(encoding, tags, [5, 2, 7, 0, 3, 6, 1, 4])).unwrap();
        let place = |mesh: &Mesh| mesh.element(0).iter().map(|&n| mesh.nodes[n]).collect::<Vec<_>>();
        assert_eq!(
            place(&mesh),
            place(&expected),
            "tags must not matter, {encoding:?}"
        );
    }
}

/// If this failed, files with gaps in their numbering (anything edited in gmsh) would be misread or exhaust memory.
#[test]
fn sparse_tags_give_the_same_mesh() {
    let expected = read(&brick(Encoding::Ascii, PLAIN, IN_ORDER)).unwrap();
    let tags = [3, 17, 400, 5_000, 60_000, 700_000, 8_000_000, 4_000_000_000];
    for encoding in ENCODINGS {
        assert_eq!(
            read(&brick(encoding, tags, [7, 6, 5, 4, 3, 2, 1, 0])).unwrap(),
            expected,
            "{encoding:?}"
        );
    }
}

/// If this failed, the unit of a mesh would be forgotten.
#[test]
fn coordinates_are_scaled_by_the_unit() {
    let path = Path::new("t.msh");
    let raw = RawMsh::parse(path, TEXT.as_bytes()).unwrap();
    let (mesh, origin) = mesh_of(&raw, path, 1e-3).unwrap();
    assert_eq!(mesh.nodes[1], [2e-3, 0.0, 0.0]);
    assert_eq!(origin.node_tags, (1..=12).collect::<Vec<_>>());
    assert_eq!(origin.element_tags, [7, 8]);
}

/// If this failed, files with comments, periodicity, data or Windows line ends would be refused.
#[test]
fn other_sections_and_line_ends_are_skipped() {
    let expected = read(TEXT.as_bytes()).unwrap();
    let periodic = "$Periodic\n1\n2 26 1\n16 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1\n1\n5 1\n$EndPeriodic\n";
    let with = TEXT.replace("$Elements", &format!("{periodic}$Elements"));
    let with = format!("$Comments\nby $Nodes\n$EndComments\n{with}$NodeData\n1\n\"T\"\n$EndNodeData\n");
    assert_eq!(read(with.as_bytes()).unwrap(), expected);
    assert_eq!(read(TEXT.replace('\n', "\r\n").as_bytes()).unwrap(), expected);
}

/// If this failed, a second body in the file (a ball, a housing) would be taken for a fault of the ring.
#[test]
fn volumes_outside_the_ring_are_left_out() {
    let more = TEXT
        .replace("8 12 6 1\n", "8 12 6 2\n")
        .replace(
            "6 -1 26 13 17 21 25 \n",
            "6 -1 26 13 17 21 25 \n2 0 0 0 9 9 9 0 0 \n",
        )
        .replace("15 12 1 12", "15 16 1 16")
        .replace(
            "3 1 0 0\n$EndNodes",
            "3 2 0 4\n13\n14\n15\n16\n7 7 7\n8 7 7\n7 8 7\n7 7 8\n$EndNodes",
        )
        .replace("4 8 1 8", "5 9 1 9")
        .replace("$EndElements", "3 2 4 1\n9 13 14 15 16\n$EndElements");
    assert_eq!(read(more.as_bytes()).unwrap(), read(TEXT.as_bytes()).unwrap());
}
