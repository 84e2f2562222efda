//! Damaged and unsuitable files: each has its message, and none can panic, hang or exhaust the memory.

use super::*;

/// What is done to [`TEXT`] (a piece and its replacement), and what the message must contain.
const EDITS: &[(&str, &str, &str)] = &[
    (
        "$MeshFormat\n",
        "solid ascii\n",
        "t.msh is not a gmsh mesh: expected \"$MeshFormat\" first, found \"solid ascii",
    ),
    ("$MeshFormat\n", "$Nodes\n", "is not a gmsh mesh"),
    (
        "4.1 0 8",
        "4.1 0",
        "t.msh, line 3: expected version, file type and data size, found \"4.1 0\"",
    ),
    (
        "4.1 0 8",
        "4.0 0 8",
        "is in MSH 4.0 text, which is not read; expected MSH 4.1",
    ),
    ("4.1 0 8", "2.2 1 8", "is in MSH 2.2 binary, which is not read"),
    (
        "4.1 0 8",
        "4.1 2 8",
        "expected file type 0 (text) or 1 (binary), found \"2\"",
    ),
    ("4.1 0 8", "4.1 1 16", "expected data size 4 or 8, found \"16\""),
    (
        "4.1 0 8",
        "4.1 1 8",
        "byte 24: expected the number 1 that tells the byte order",
    ),
    (
        "$EndMeshFormat",
        "$EndMesh",
        "line 3: expected $EndMeshFormat, found \"$EndMesh\"",
    ),
    (
        "4\n1 4 \"rim\"",
        "3\n1 4 \"rim\"",
        "line 9: expected $EndPhysicalNames, found \"3\"",
    ),
    (
        "4\n1 4 \"rim\"",
        "5\n1 4 \"rim\"",
        "expected a dimension from 0 to 3, found \"$EndPhysicalNames\"",
    ),
    (
        "4\n1 4 \"rim\"",
        "999999999999 \"rim\"",
        "the header announces 999999999999 physical names",
    ),
    (
        "1 4 \"rim\"",
        "7 4 \"rim\"",
        "line 6: expected a dimension from 0 to 3, found 7",
    ),
    (
        "1 4 \"rim\"",
        "1 4 rim",
        "expected a physical name in quotes, found \"rim\"",
    ),
    (
        "2 3 \"seat\"",
        "2 2 \"seat\"",
        "expected one name per physical group, found \"seat\"",
    ),
    (
        "3 1 \"ring\"",
        "3 1 \"body\"",
        "t.msh has no physical Volume \"ring\" with elements; physical Volumes are \"body\"",
    ),
    (
        "3 1 \"ring\"",
        "3 9 \"ring\"",
        "has no physical Volume \"ring\" with elements; physical Volumes are \"ring\"",
    ),
    (
        "8 12 6 1\n",
        "8 12 6 99999999\n",
        "the header announces 99999999 volumes, but there are at most",
    ),
    (
        "15 12 1 12",
        "15 13 1 12",
        "line 81: the header announces 13 nodes, but there are 12",
    ),
    (
        "15 12 1 12",
        "15 18446744073709551615 1 12",
        "announces 18446744073709551615 nodes, but there are at most",
    ),
    (
        "15 12 1 12",
        "15 -12 1 12",
        "line 42: expected nodes, found \"-12\"",
    ),
    ("15 12 1 12", "14 12 1 12", "expected $EndNodes, found \"3\""),
    (
        "1.5 1 0\n",
        "1.5 1\n",
        "line 73: expected a dimension from 0 to 3, found 6",
    ),
    (
        "1.5 1 0\n",
        "1.5 x 0\n",
        "line 72: expected a node coordinate, found \"x\"",
    ),
    (
        "1.5 1 0\n",
        "1.5 nan 0\n",
        "node 10 has the coordinates (1.5, NaN, 0), which are not finite",
    ),
    (
        "1.5 1 0\n",
        "1.5 1e400 0\n",
        "node 10 has the coordinates (1.5, inf, 0), which are not finite",
    ),
    (
        "\n10\n1.5 1 0\n",
        "\n11\n1.5 1 0\n",
        "t.msh has two nodes with tag 11",
    ),
    (
        "1 3 0 1\n10",
        "5 3 0 1\n10",
        "expected a dimension from 0 to 3, found 5",
    ),
    (
        "1 3 0 1\n10",
        "1 3 7 1\n10",
        "expected 0, or 1 for parametric nodes, found 7",
    ),
    (
        "4 8 1 8\n",
        "4 9 1 8\n",
        "the header announces 9 elements, but there are 8",
    ),
    (
        "8 9 2 3 10 11 6 7 12",
        "7 9 2 3 10 11 6 7 12",
        "t.msh has two elements with tag 7",
    ),
    (
        "8 9 2 3 10 11 6 7 12",
        "8 9 2 3 10 11 6 7 99",
        "element 8 names node 99, which the file does not define",
    ),
    (
        "8 9 2 3 10 11 6 7 12",
        "8 11 6 7 12 9 2 3 10",
        "element 8 is inverted, its jacobian determinant falls to",
    ),
    (
        "\n8\n1 1 1\n",
        "\n8\n1.1666666666666667 0.6666666666666666 0.6666666666666666\n",
        "element 7 is degenerate",
    ),
    ("3 1 5 2\n", "3 1 4 2\n", "expected $EndElements"),
    (
        "3 1 5 2\n",
        "3 1 3 2\n",
        "expected elements of dimension 3, found 4-node quadrangle",
    ),
    (
        "3 1 5 2\n",
        "3 1 55 2\n",
        "expected an element type of the format, found 55",
    ),
    (
        "2 26 3 2\n5 5 11 12 8",
        "2 26 3 2\n5 9 11 12 10",
        "element 5 of group \"seat\" is inside it, between two elements",
    ),
    (
        "2 26 3 2\n5 5 11 12 8",
        "2 26 3 2\n5 5 11 12 9",
        "element 5 of group \"seat\" is no face of it",
    ),
    (
        "2 26 3 2\n5 5 11 12 8",
        "2 26 3 2\n5 11 6 7 12",
        "element 6 of group \"seat\" is the same face as another",
    ),
    ("\n12\n1.5 1 1\n", "\n12\n1.5 1 0\n", "nodes 10 and 12 coincide"),
    (
        "$EndElements\n",
        "$EndElements\nrubbish",
        "expected a section such as $Nodes, found \"rubbish\"",
    ),
    (
        "$EndElements\n",
        "",
        "expected $EndElements, found the end of the file",
    ),
    (
        "$EndElements\n",
        "$EndElements\n$Nodes\n0 0 0 0\n$EndNodes\n",
        "expected one section $Nodes, found a second",
    ),
    (
        "$EndElements\n",
        "$EndElements\n$Data\n",
        "expected $EndData, found the end of the file",
    ),
    (
        "3 1 0 0\n$EndNodes",
        "3 1 0 1\n13\n9 9 9\n$EndNodes",
        "the header announces 12 nodes, but there are 13",
    ),
];

/// If this failed, a user with such a file would not learn what is wrong, or compute on it.
#[test]
fn each_damaged_file_has_its_message() {
    let mut failures = Vec::new();
    for (i, (piece, replacement, expected)) in EDITS.iter().enumerate() {
        assert_eq!(
            TEXT.matches(piece).count(),
            1,
            "edit {i} is not unique: {piece:?}"
        );
        let error = read(TEXT.replace(piece, replacement).as_bytes())
            .expect_err(expected)
            .to_string();
        if !(error.contains(expected) && error.contains("t.msh")) {
            failures.push(format!(
                "edit {i}, {piece:?} to {replacement:?}:\n  {error}\nlacks\n  {expected}"
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Two edits at once, where one alone would only be a wrong count.
fn edited(edits: &[(&str, &str)]) -> String {
    edits.iter().fold(TEXT.to_string(), |text, (piece, replacement)| {
        assert_eq!(text.matches(piece).count(), 1, "{piece:?}");
        text.replace(piece, replacement)
    })
}

/// If this failed, a node no element uses would make the stiffness singular much later.
#[test]
fn an_orphan_node_is_named() {
    let text = edited(&[
        ("15 12 1 12", "15 13 1 13"),
        ("3 1 0 0\n$EndNodes", "3 1 0 1\n13\n9 9 9\n$EndNodes"),
    ]);
    let error = read(text.as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("node 13 is used by no volume element (1 such nodes)"),
        "{error}"
    );
}

/// If this failed, two rings in one file would be solved as one body with six free rigid motions.
#[test]
fn two_separate_parts_are_an_error() {
    let text = edited(&[
        ("15 12 1 12", "15 16 1 16"),
        (
            "3 1 0 0\n$EndNodes",
            "3 1 0 4\n13\n14\n15\n16\n1.6 0 0\n1.6 1 0\n1.6 0 1\n1.6 1 1\n$EndNodes",
        ),
        ("8 9 2 3 10 11 6 7 12", "8 13 2 3 14 15 6 7 16"),
        ("4 9 2 3 10", "4 13 2 3 14"),
        ("6 11 6 7 12", "6 15 6 7 16"),
    ]);
    let error = read(text.as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("the ring is in 2 unconnected parts (element 7 begins one of 1 elements)"),
        "{error}"
    );
}

/// If this failed, elements that are not read would give no hint of what to change.
#[test]
fn mixed_kinds_are_counted() {
    let text = edited(&[
        ("4 8 1 8\n", "5 9 1 9\n"),
        ("$EndElements", "3 1 6 1\n9 1 9 10 5 11 12\n$EndElements"),
    ]);
    let error = read(text.as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("holds 1 elements of type 6-node prism (the first is element 9)"),
        "{error}"
    );
    assert!(error.contains("recombine every surface"), "{error}");
    let nodes: Vec<String> = (1..=10).map(|n| n.to_string()).collect();
    let tet = format!("3 1 11 1\n9 {}\n$EndElements", nodes.join(" "));
    let text = edited(&[("4 8 1 8\n", "5 9 1 9\n"), ("$EndElements", &tet)]);
    let error = read(text.as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("\"ring\" mixes 2 x 8-node hexahedron, 1 x 10-node tetrahedron"),
        "{error}"
    );
}

/// If this failed, an interrupted copy could pass for a mesh, or crash the program.
#[test]
fn every_truncation_is_an_error() {
    for encoding in ENCODINGS {
        let data = brick(encoding, PLAIN, IN_ORDER);
        let end = data.len() - 1;
        for length in 0..end {
            assert!(
                read(&data[..length]).is_err(),
                "{encoding:?} cut to {length} of {}",
                data.len()
            );
        }
        assert!(read(&data[..end]).is_ok(), "only the last line end is missing");
    }
    let end = TEXT.trim_end().len();
    for length in 0..end {
        assert!(read(&TEXT.as_bytes()[..length]).is_err(), "cut to {length}");
    }
}

/// If this failed, a flipped bit could crash the program or make it ask for the whole memory.
#[test]
fn random_damage_never_panics_and_never_yields_an_invalid_mesh() {
    // Knuth's MMIX generator; the high bits are good enough to choose bytes.
    let mut state = 20_240_229_u64;
    let mut random = |n: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let (mut accepted, mut refused) = (0, 0);
    for encoding in ENCODINGS {
        let data = brick(encoding, PLAIN, IN_ORDER);
        for _ in 0..4000 {
            let mut damaged = data.clone();
            for _ in 0..=random(3) {
                let at = random(damaged.len());
                damaged[at] ^= 1 << random(8);
            }
            match read(&damaged) {
                Ok(mesh) => {
                    accepted += 1;
                    assert!(mesh.nodes.iter().flatten().all(|c| c.is_finite()));
                    assert!(mesh.connectivity.iter().all(|&n| n < mesh.n_nodes()));
                    assert!(crate::geometry::volume(&mesh) > 0.0);
                }
                Err(_) => refused += 1,
            }
        }
    }
    // Most bits of a coordinate or a bounding box may change and leave a legal file; most others may not.
    assert!(
        accepted > 1000 && refused > 5000,
        "{accepted} accepted, {refused} refused"
    );
}
