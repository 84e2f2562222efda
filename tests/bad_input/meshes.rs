//! Meshes that must be refused by the whole program: a good one with a few lines of its text changed.

use mesh::{Facet, Mesh, MshFormat, RingSide};

use super::text::{Text, changed, replaced};
use super::{assert_refused, run};
use crate::util::rings::{self, Level, TINY};
use crate::util::{Dir, SCENE};

/// Name, content of `inner.msh`, and the essential parts of the message.
type Case = (&'static str, Vec<u8>, &'static [&'static str]);

/// The good mesh, changed as a mesh.
fn rebuilt(change: impl FnOnce(&mut Mesh)) -> Vec<u8> {
    let mut mesh = rings::ring(RingSide::Inner, TINY);
    change(&mut mesh);
    rings::file(&mesh, 1e-3, MshFormat::Ascii)
}

/// An element inside the ring again, its nodes in another order.
fn an_element_twice() -> Vec<u8> {
    let mut mesh = rings::ring(RingSide::Inner, Level { thickness: 3, ..TINY });
    let grouped: Vec<usize> = mesh.groups.values().flatten().map(|f| f.element).collect();
    let inside = (0..mesh.n_elements()).find(|e| !grouped.contains(e)).unwrap();
    let mut copy = mesh.element(inside).to_vec();
    copy[..4].rotate_left(1);
    copy[4..].rotate_left(1);
    mesh.connectivity.extend(copy);
    rings::file(&mesh, 1e-3, MshFormat::Ascii)
}

/// A second ring beside the first.
fn two_parts(mesh: &mut Mesh) {
    let (n, e) = (mesh.n_nodes(), mesh.n_elements());
    mesh.nodes
        .extend(mesh.nodes.to_vec().iter().map(|x| [x[0], x[1], x[2] + 0.05]));
    mesh.connectivity
        .extend(mesh.connectivity.clone().iter().map(|i| i + n));
    for facets in mesh.groups.values_mut() {
        let second = facets.iter().map(|f| Facet {
            element: f.element + e,
            face: f.face,
        });
        *facets = facets.iter().copied().chain(second.collect::<Vec<_>>()).collect();
    }
}

/// Files that are not what their name says, or not all of it.
fn files() -> Vec<Case> {
    let text = &rings::tiny_texts()[0];
    let until = |end: &str| text.split(end).next().unwrap().as_bytes().to_vec();
    vec![
        (
            "an empty file",
            Vec::new(),
            &[
                "error: inner.msh is not a gmsh mesh: expected \"$MeshFormat\" first, found an empty file; write one \
                 with `gmsh -3 -format msh41`",
            ],
        ),
        (
            "a picture",
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec(),
            &[
                "error: inner.msh is not a gmsh mesh: expected \"$MeshFormat\" first, found \"\u{fffd}PNG\\r\\n",
            ],
        ),
        (
            "a table",
            b"x,y,z\n1,2,3\n".to_vec(),
            &["expected \"$MeshFormat\" first, found \"x,y,z\\n1,2,3\\n\"; write one with"],
        ),
        (
            "a file cut off behind its nodes",
            until("$EndNodes"),
            &[
                "error: inner.msh, line 523: expected $EndNodes, found the end of the file; the file is truncated or \
                 damaged, write it again",
            ],
        ),
        (
            "a file cut off before its elements",
            until("$Elements"),
            &["error: inner.msh"],
        ),
        (
            "a file cut off among its first nodes",
            changed(|t| {
                let first = t.section("Nodes") + 20;
                t.0.truncate(first);
            }),
            &["error: inner.msh, line 17: the header announces 252 nodes, but there are at most"],
        ),
        (
            "a file cut off in a number",
            changed(|t| {
                *t.node(150) = "1.0 2.0 3.0e".to_string();
                let last = t.section("Nodes") + 2 + t.n_nodes() + 150;
                t.0.truncate(last + 1);
            }),
            &[
                "error: inner.msh, line 420: expected a node coordinate, found \"3.0e\"; the file is truncated or \
                 damaged, write it again",
            ],
        ),
        (
            "another version",
            replaced("4.1 0 8", "4 0 8"),
            &[
                "error: inner.msh is in MSH 4 text, which is not read; expected MSH 4.1 (text or binary) or MSH 2.2 \
                 (text), convert it with `gmsh inner.msh -save -format msh41 -o new.msh`",
            ],
        ),
        (
            "a count beyond the file",
            changed(|t| {
                let line = t.section("Nodes") + 1;
                t.0[line] = "1 1000000000000000 1 1000000000000000".to_string();
            }),
            &["the header announces 1000000000000000 nodes, but there are at most"],
        ),
        (
            "a word for a number",
            changed(|t| *t.node(5) = "1.0 two 3.0".to_string()),
            &[
                "error: inner.msh, line 275: expected a node coordinate, found \"two\"; the file is truncated or \
                 damaged, write it again",
            ],
        ),
        (
            "not a number",
            changed(|t| *t.node(7) = "nan 0 0".to_string()),
            &[
                "error: inner.msh: node 7 has the coordinates (NaN, 0, 0), which are not finite; mesh the geometry \
                 again",
            ],
        ),
        (
            "a tag twice",
            changed(|t| *t.node_tag(2) = "1".to_string()),
            &[
                "error: inner.msh has two nodes with tag 1; tags must be unique, renumber the mesh in gmsh and write \
                 it again",
            ],
        ),
        (
            "an element twice",
            changed(|t| *t.element(2) = t.element(1).clone()),
            &["error: inner.msh has two elements with tag 1; tags must be unique"],
        ),
        (
            "an unknown node",
            changed(|t| *t.element(3) = "3 1 2 3 4 5 6 7 99999".to_string()),
            &[
                "error: inner.msh: element 3 names node 99999, which the file does not define; write the file again",
            ],
        ),
    ]
}

/// Meshes that are read, but are no ring that can be computed.
fn rings_that_are_none() -> Vec<Case> {
    vec![
        (
            "no raceway",
            replaced("\"raceway\"", "\"track\""),
            &[
                "error: mesh inner.msh has no facet group \"raceway\"; groups are \"bore\", \"track\"; name it in the \
                 .geo: Physical Surface(\"raceway\") = {...};",
            ],
        ),
        (
            "no bore",
            replaced("\"bore\"", "\"hole\""),
            &[
                "error: mesh inner.msh has no facet group \"bore\"; groups are \"hole\", \"raceway\"; name it in the \
                 .geo: Physical Surface(\"bore\") = {...};",
            ],
        ),
        (
            "an empty bore",
            rebuilt(|m| m.groups.get_mut("bore").unwrap().clear()),
            &["error: mesh inner.msh has an empty facet group \"bore\"; groups are \"bore\", \"raceway\""],
        ),
        (
            "no volume",
            replaced("\"ring\"", "\"body\""),
            &[
                "error: inner.msh has no physical Volume \"ring\" with elements; physical Volumes are \"body\"; name \
                 the ring's Volume so in the .geo: Physical Volume(\"ring\") = {...};",
            ],
        ),
        (
            "an element inside out",
            rebuilt(|m| m.connectivity[..8].rotate_left(4)),
            &[
                "error: inner.msh: element 1 is inverted, its jacobian determinant falls to -",
                "(1 such elements); expected a positive one everywhere; refine or smooth the mesh there, or turn the \
                 element's nodes round",
            ],
        ),
        (
            "an orphan node",
            changed(|t| {
                t.add_node("0 0 0");
            }),
            &[
                "error: inner.msh: node 253 is used by no volume element (1 such nodes); expected none, they make the \
                 stiffness singular; save without -save_all, or delete the point they are on",
            ],
        ),
        (
            "two nodes at one place",
            changed(|t| {
                let coordinates = t.node(1).clone();
                let copy = t.add_node(&coordinates);
                let nodes = t.element(1).replacen(" 1 ", &format!(" {copy} "), 1);
                *t.element(1) = nodes;
            }),
            &[
                "error: inner.msh: nodes 1 and 253 coincide (0.000e0 m apart",
                "expected one node per place; use Coherence in the .geo or Mesh > Remove duplicate nodes",
            ],
        ),
        (
            "an element that stands twice",
            an_element_twice(),
            &[
                "have the same corners, so the body would be twice as stiff and heavy there; expected each element \
                 once: remove the copies, in gmsh by `gmsh.model.mesh.removeDuplicateElements()`",
            ],
        ),
        (
            "a facet of the raceway in the bore",
            changed(Text::share_a_facet),
            &[
                "error: inner.msh: a face of element ",
                "is in group \"raceway\" and in group \"bore\"; expected each in one of them, as what holds the \
                 ring would hold its raceway there",
            ],
        ),
        (
            "two rings",
            rebuilt(two_parts),
            &[
                "error: inner.msh: the ring is in 2 unconnected parts (element 1 begins one of 108 elements); \
                 expected one part; merge the interfaces (Coherence) or keep one ring per file",
            ],
        ),
        (
            "27-node hexahedra",
            changed(|t| t.retype(12, 27)),
            &[
                "error: inner.msh: \"ring\" holds 108 elements of type 27-node hexahedron (the first is element 1); \
                 expected 8-node hexahedra, 20-node hexahedra or 10-node tetrahedra; set \
                 Mesh.SecondOrderIncomplete=1",
            ],
        ),
        (
            "4-node tetrahedra",
            changed(|t| t.retype(4, 4)),
            &[
                "elements of type 4-node tetrahedron (the first is element 1)",
                "mesh again with `gmsh -3 -order 2` (Mesh.ElementOrder=2), linear tetrahedra are far too stiff",
            ],
        ),
        (
            "a raceway inside",
            changed(|t| {
                let last = t.section("EndElements") - 1;
                let tag = t.0[last].split(' ').next().unwrap().to_string();
                let words: Vec<String> = t.element(1).split_whitespace().map(str::to_string).collect();
                t.0[last] = format!("{tag} {}", words[1..5].join(" "));
            }),
            &[
                "of group \"raceway\" is inside",
                "between two elements; expected a boundary face of exactly one element of \"ring\"; correct the group \
                 in the .geo",
            ],
        ),
        (
            "a raceway with a hole",
            rebuilt(|m| m.groups.get_mut("raceway").unwrap().truncate(36)),
            &[
                "group \"raceway\" has 50.0 % of the circle and 50.0 % of the area of its surface: 36 of 72 faces",
            ],
        ),
    ]
}

/// A folder with the tests' scene and the tiny meshes of both rings.
pub fn tiny() -> Dir {
    let dir = Dir::with_scene(SCENE);
    let [inner, outer] = rings::tiny_texts();
    dir.write("inner.msh", inner);
    dir.write("outer.msh", outer);
    dir
}

/// If this failed, the other tests here could pass for another reason than the one they name.
#[test]
fn the_mesh_that_is_damaged_is_good_before() {
    let outcome = tiny().raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// If this failed, a damaged or foreign file would be taken for a mesh, crash the program, or not be recognised.
#[test]
fn damaged_files_are_refused_with_place_and_remedy() {
    let dir = tiny();
    for (name, content, parts) in files() {
        dir.write("inner.msh", content);
        assert_refused(name, &dir, &[], &run(&[]), parts);
    }
}

/// If this failed, a mesh that is no sound body would be solved into nonsense.
#[test]
fn unsound_rings_are_refused_with_entity_and_remedy() {
    let dir = tiny();
    for (name, content, parts) in rings_that_are_none() {
        dir.write("inner.msh", content);
        assert_refused(name, &dir, &[], &run(&[]), parts);
    }
}

/// If this failed, the outer ring would be less well checked than the inner.
#[test]
fn the_outer_ring_is_checked_like_the_inner() {
    let dir = tiny();
    dir.write("outer.msh", "");
    let part = "error: outer.msh is not a gmsh mesh: expected \"$MeshFormat\" first, found an empty file";
    assert_refused("outer", &dir, &[], &run(&[]), &[part]);
    assert_refused("outer, check", &dir, &[], &["check", "scene.toml"], &[part]);
}
