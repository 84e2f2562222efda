//! Rotational periodicity: the number of sectors, the sites of nodes, and the reasons against.

use mesh::{
    ElementKind, Mesh, NotPeriodic, PERIODIC_TOLERANCE, Periodicity, RingSide, find_periodicity, read_msh,
    revolve,
};

use crate::{revolved, section};

/// A fixed permutation of 0..n.
fn shuffled(n: usize, seed: u64) -> Vec<usize> {
    let mut keys: Vec<(u64, usize)> = (0..n)
        .map(|i| {
            let mixed = (i as u64 + seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9), i)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, i)| i).collect()
}

/// The same body with nodes and elements in another order.
pub fn renumbered(mesh: &Mesh) -> Mesh {
    let (node_order, element_order) = (shuffled(mesh.n_nodes(), 1), shuffled(mesh.n_elements(), 2));
    let mut new_node = vec![0; mesh.n_nodes()];
    let mut new_element = vec![0; mesh.n_elements()];
    for (new, &old) in node_order.iter().enumerate() {
        new_node[old] = new;
    }
    for (new, &old) in element_order.iter().enumerate() {
        new_element[old] = new;
    }
    let mut groups = mesh.groups.clone();
    for facets in groups.values_mut() {
        facets.iter_mut().for_each(|f| f.element = new_element[f.element]);
        facets.sort_unstable();
    }
    Mesh {
        kind: mesh.kind,
        nodes: node_order.iter().map(|&old| mesh.nodes[old]).collect(),
        connectivity: element_order
            .iter()
            .flat_map(|&old| mesh.element(old).iter().map(|&node| new_node[node]))
            .collect(),
        groups,
    }
}

/// Straight-edged quadratic tetrahedra, six to a hexahedron round its diagonal: periodic, without a mirror plane.
fn tetrahedra(hexes: &Mesh) -> Mesh {
    const KUHN: [[usize; 4]; 6] = [
        [0, 1, 2, 6],
        [0, 2, 3, 6],
        [0, 3, 7, 6],
        [0, 7, 4, 6],
        [0, 4, 5, 6],
        [0, 5, 1, 6],
    ];
    let kind = ElementKind::Tet10;
    let (mut nodes, mut connectivity) = (hexes.nodes.clone(), Vec::new());
    let mut mids = std::collections::BTreeMap::new();
    for e in 0..hexes.n_elements() {
        for corners in KUHN.map(|tet| tet.map(|corner| hexes.element(e)[corner])) {
            connectivity.extend(corners);
            for &[a, b] in kind.edges() {
                let pair = [corners[a].min(corners[b]), corners[a].max(corners[b])];
                connectivity.push(*mids.entry(pair).or_insert_with(|| {
                    let middle = [0, 1, 2].map(|i| 0.5 * (nodes[pair[0]][i] + nodes[pair[1]][i]));
                    nodes.push(middle);
                    nodes.len() - 1
                }));
            }
        }
    }
    Mesh {
        kind,
        nodes,
        connectivity,
        groups: std::collections::BTreeMap::new(),
    }
}

/// A turn by a sector must add one to the sector and keep the section node, for every node.
pub fn assert_sites_turn(mesh: &Mesh, found: &Periodicity) {
    let (n, width) = (found.n_sectors(), found.n_section_nodes());
    assert_eq!(n * width, mesh.n_nodes());
    let (sin, cos) = (std::f64::consts::TAU / n as f64).sin_cos();
    for (node, site) in found.sites().iter().enumerate() {
        assert_eq!(found.nodes()[site.sector * width + site.section_node], node);
        let next = found.nodes()[(site.sector + 1) % n * width + site.section_node];
        let ([x, y, z], there) = (mesh.nodes[node], mesh.nodes[next]);
        let turned = [cos * x - sin * y, sin * x + cos * y, z];
        for i in 0..3 {
            assert!((turned[i] - there[i]).abs() < 1e-15, "node {node} of {site:?}");
        }
    }
}

/// Wrong: rings would be refused as not periodic, or cut into fewer sectors than they have, because of their numbering.
#[test]
fn the_largest_number_of_sectors_is_found_in_any_numbering() {
    for (kind, n) in [
        (ElementKind::Hex8, 36),
        (ElementKind::Hex8, 37),
        (ElementKind::Hex20, 36),
        (ElementKind::Hex20, 15),
    ] {
        let ring = revolved(RingSide::Inner, n, kind);
        for mesh in [renumbered(&ring), ring] {
            let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
            assert_eq!(found.n_sectors(), n, "{kind:?}");
            assert_sites_turn(&mesh, &found);
            assert_eq!(found.elements().len() * n, mesh.n_elements());
            // Rounding of coordinates of up to 30 mm.
            assert!(found.deviation() < 1e-16, "{:e}", found.deviation());
            let half_way = found.half_way().expect("every node lies on a plane or half-way");
            let n_half = half_way.iter().filter(|&&half| half).count();
            // Half of the points of a quadratic ring lie on arcs, unless node 0 itself does.
            let n_points = section(RingSide::Inner).points().len();
            let n_edges = found.n_section_nodes() - 2 * n_points;
            match kind {
                ElementKind::Hex8 => assert_eq!(n_half, 0),
                _ => assert!(
                    n_half == n_points || n_half == n_points + n_edges,
                    "{n_half} half-way"
                ),
            }
        }
    }
}

/// Wrong: node 0 of a ring that the program revolved would not be section node 0 of sector 0, as the docs say.
#[test]
fn a_revolved_ring_keeps_its_own_numbering() {
    for kind in [ElementKind::Hex8, ElementKind::Hex20] {
        let mesh = revolved(RingSide::Outer, 24, kind);
        let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
        assert!(found.nodes().iter().copied().eq(0..mesh.n_nodes()), "{kind:?}");
        assert!(found.elements().iter().copied().eq(0..mesh.n_elements() / 24));
    }
}

/// Wrong: tetrahedra, whose nodes lie anywhere in a sector, would be taken for a section with a mirror plane.
#[test]
fn a_ring_of_tetrahedra_is_periodic_without_a_mirror_plane() {
    let mesh = renumbered(&tetrahedra(&revolved(RingSide::Inner, 20, ElementKind::Hex8)));
    let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
    assert_eq!(found.n_sectors(), 20);
    assert_sites_turn(&mesh, &found);
    assert_eq!(found.half_way(), None);
}

/// Wrong: a ring with a mark on every third sector would be solved as if every sector had it.
#[test]
fn marks_on_some_sectors_make_larger_sectors() {
    let mut mesh = revolved(RingSide::Inner, 36, ElementKind::Hex8);
    let per_sector = mesh.n_elements() / 36;
    let bore = mesh.groups["bore"].clone();
    let marked = bore.into_iter().filter(|f| (f.element / per_sector) % 3 == 1);
    mesh.groups.insert("marks".to_string(), marked.collect());
    let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
    assert_eq!(found.n_sectors(), 12);
    assert_sites_turn(&mesh, &found);
    assert_eq!(found.half_way(), None, "sectors of three have planes at thirds");
    let width = mesh.n_nodes() / 36;
    for s in (0..36).step_by(4) {
        mesh.nodes[s * width + 2][2] += 1e-5;
    }
    // Period 4 in the nodes and 3 in the marks: sectors of 12, and 3 of them.
    assert_eq!(
        find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap().n_sectors(),
        3
    );
}

/// Wrong: a defect would go unnoticed, and the sectors solved for would not be those of the ring.
#[test]
fn the_first_difference_is_named() {
    let ring = revolved(RingSide::Inner, 37, ElementKind::Hex8);
    let width = ring.n_nodes() / 37;
    let reason = |mesh: &Mesh| find_periodicity(mesh, PERIODIC_TOLERANCE).unwrap_err();

    let mut dented = ring.clone();
    let dent = 5 * width + 3;
    dented.nodes[dent][0] += 1e-8;
    let found = reason(&dented);
    // The node a sector before the dent is the first that misses its partner.
    let is_before = matches!(&found, NotPeriodic::Node { n_sectors: 37, node, .. } if *node == dent - width);
    assert!(is_before, "{found}");
    assert!(found.to_string().contains("meets no node within 3"), "{found}");

    let mut cut = ring.clone();
    cut.connectivity.drain(8 * 70..8 * 71);
    cut.groups.clear();
    assert!(matches!(reason(&cut), NotPeriodic::Element { n_sectors: 37, .. }));

    let mut unmarked = ring.clone();
    unmarked.groups.get_mut("raceway").unwrap().remove(11);
    let found = reason(&unmarked);
    assert!(
        found.to_string().contains("is not in its group \"raceway\""),
        "{found}"
    );

    let mut alone = ring.clone();
    alone.nodes.iter_mut().take(width).for_each(|x| x[2] += 1e-6);
    assert!(matches!(
        reason(&alone),
        NotPeriodic::Node { .. } | NotPeriodic::Alone { .. }
    ));

    let mut pinned = ring.clone();
    pinned.nodes[7] = [0.0, 0.0, 1e-3];
    assert_eq!(reason(&pinned), NotPeriodic::OnAxis { node: 7 });
    let empty = Mesh {
        connectivity: Vec::new(),
        ..ring
    };
    assert_eq!(reason(&empty), NotPeriodic::Empty);
}

/// Wrong: a clamped bore would not be found to be whole rings of nodes, or half a bore would pass for one.
#[test]
fn held_nodes_are_section_nodes_when_whole_rings_are_held() {
    let mesh = renumbered(&revolved(RingSide::Inner, 30, ElementKind::Hex20));
    let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
    let mut held = mesh.group_nodes("bore");
    let section = found.section_nodes(&held).unwrap();
    assert_eq!(section.len() * 30, held.len());
    let missing = held.pop().unwrap();
    assert_eq!(found.section_nodes(&held), Err(found.sites()[missing]));
}

/// Wrong: a ring whose coordinates were written with few digits would be called exactly periodic.
#[test]
fn the_deviation_is_that_of_the_coordinates() {
    let mut mesh = revolve(&section(RingSide::Inner), 48, ElementKind::Hex8, &[]).unwrap();
    let rounded = |x: f64| (x * 1e12).round() / 1e12;
    mesh.nodes.iter_mut().flatten().for_each(|x| *x = rounded(*x));
    let found = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
    assert_eq!(found.n_sectors(), 48);
    assert!(
        (1e-13..2e-12).contains(&found.deviation()),
        "{:e}",
        found.deviation()
    );
}

/// Wrong: the rings that come with the program, read back from their files, would be solved as general meshes; or
/// Gmsh's free mesh of tetrahedra would be taken for a periodic one.
#[test]
fn stored_rings_are_periodic_and_a_free_mesh_is_not() {
    let stored = |name: &str| {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../meshes/");
        read_msh(format!("{path}{name}"), 1e-3).unwrap()
    };
    for name in ["7010c_inner_coarse.msh", "7010c_outer_coarse.msh"] {
        let found = find_periodicity(&stored(name), PERIODIC_TOLERANCE).unwrap();
        assert_eq!(found.n_sectors(), 90);
        assert!(found.half_way().is_some());
        assert!(found.deviation() < 1e-16, "{:e}", found.deviation());
    }
    let reason = find_periodicity(&stored("7010c_inner_tet10.msh"), PERIODIC_TOLERANCE).unwrap_err();
    let is_node = matches!(reason, NotPeriodic::Node { .. } | NotPeriodic::Alone { .. });
    assert!(is_node, "{reason}");
}
