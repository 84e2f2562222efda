//! Rings that are periodic up to a defect: what it is, and the reasons against.

use mesh::{
    ElementKind, Mesh, NotNearlyPeriodic, PERIODIC_TOLERANCE, RingSide, find_nearly_periodic,
    find_periodicity,
};

use crate::periodic::{assert_sites_turn, renumbered};
use crate::revolved;

/// Wrong: a defect would be sought where none is, or it would not be found, or placed in other nodes than those that
/// were moved.
#[test]
fn a_few_moved_nodes_are_a_defect() {
    for (kind, n) in [
        (ElementKind::Hex8, 37),
        (ElementKind::Hex20, 24),
        (ElementKind::Hex8, 24),
    ] {
        let ring = renumbered(&revolved(RingSide::Inner, n, kind));
        let none = find_nearly_periodic(&ring, PERIODIC_TOLERANCE).unwrap();
        assert!(none.moved.is_empty() && none.absent.is_empty() && none.missing.is_empty());
        let mut dented = ring.clone();
        let is_near = |x: &[f64; 3]| (0.4..1.1).contains(&x[1].atan2(x[0])) && x[2] > 1e-3;
        let dented_nodes: Vec<usize> = (0..ring.n_nodes()).filter(|&i| is_near(&ring.nodes[i])).collect();
        assert!(dented_nodes.len() > 10);
        for &node in &dented_nodes {
            dented.nodes[node][2] += 1e-5 * (2.0 + (node as f64).sin());
        }
        let found = find_nearly_periodic(&dented, PERIODIC_TOLERANCE).unwrap();
        assert_eq!(found.periodicity.n_sectors(), n, "{kind:?}");
        assert!(found.moved.iter().map(|m| m.0).eq(dented_nodes.iter().copied()));
        assert!(
            (1e-5..=3e-5).contains(&found.largest_move),
            "{}",
            found.largest_move
        );
        for &(node, x) in &found.moved {
            let error = (0..3)
                .map(|i| (x[i] - ring.nodes[node][i]).abs())
                .fold(0.0, f64::max);
            assert!(error < 1e-15, "{error:e}");
        }
        assert_sites_turn(&found.regular(&dented), &found.periodicity);
        let elements = found.elements(&dented);
        let touches = |e: &usize| dented.element(*e).iter().any(|n| dented_nodes.contains(n));
        assert!(
            elements
                .iter()
                .copied()
                .eq((0..ring.n_elements()).filter(touches))
        );
        assert!(found.n_sectors_moved() < n / 4);
    }
}

/// A keyway in the bore: two rows of elements at three neighbouring sectors, across the seam of the azimuths.
fn slotted(ring: &Mesh, kind: ElementKind) -> Mesh {
    let bore = ring
        .nodes
        .iter()
        .map(|x| x[0].hypot(x[1]))
        .fold(f64::INFINITY, f64::min);
    let is_lost = |e: usize| {
        let [x, y, _] = ring.element_centre(e);
        let depth = x.hypot(y) - bore;
        x < 0.0 && y.abs() < 7e-3 && depth < 1.5e-3
    };
    let slotted = ring.clone().without_elements(is_lost).0;
    assert_eq!(slotted.kind, kind);
    slotted
}

/// Wrong: a keyway would not be found, or filled with other elements than those that are missing: volume, nodes and
/// sectors of the filled ring are those of the ring without it. In any numbering, with a dent elsewhere as well.
#[test]
fn missing_elements_are_a_defect() {
    for (kind, n) in [
        (ElementKind::Hex8, 37),
        (ElementKind::Hex20, 24),
        (ElementKind::Hex8, 36),
    ] {
        let ring = revolved(RingSide::Inner, n, kind);
        let mut mesh = renumbered(&slotted(&ring, kind));
        let n_missing = ring.n_elements() - mesh.n_elements();
        let n_absent = ring.n_nodes() - mesh.n_nodes();
        assert!(
            n_missing > 5 && n_absent > 5,
            "{n_missing} elements, {n_absent} nodes"
        );
        let dented: Vec<usize> = (0..mesh.n_nodes())
            .filter(|&i| mesh.nodes[i][0] > 29e-3)
            .collect();
        for (i, &node) in dented.iter().enumerate() {
            mesh.nodes[node][2] += 1e-5 * (2.0 + (i as f64).sin());
        }
        let found = find_nearly_periodic(&mesh, PERIODIC_TOLERANCE).unwrap();
        assert_eq!(found.periodicity.n_sectors(), n, "{kind:?}");
        assert_eq!(found.n_missing(&mesh), n_missing);
        assert_eq!(found.absent.len(), n_absent);
        assert!(found.moved.iter().map(|m| m.0).eq(dented.iter().copied()));
        assert!(
            (2..5).contains(&found.n_sectors_missing(&mesh)),
            "{}",
            found.n_sectors_missing(&mesh)
        );
        let regular = found.regular(&mesh);
        assert_eq!(
            regular.element(3),
            mesh.element(3),
            "the mesh' own elements come first"
        );
        let volumes = [&regular, &ring].map(mesh::volume);
        assert!((volumes[0] / volumes[1] - 1.0).abs() < 1e-12, "{volumes:?}");
        assert_sites_turn(&regular, &found.periodicity);
        for x in &ring.nodes {
            let apart = |y: &[f64; 3]| (0..3).map(|i| (x[i] - y[i]).powi(2)).sum::<f64>().sqrt();
            let nearest = regular.nodes.iter().map(apart).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{nearest:e}");
        }
    }
}

/// Wrong: a ring would be solved as a periodic one with a defect though it has more elements than that, or hardly any
/// of it is regular, and nobody would be told why not.
#[test]
fn larger_defects_and_more_elements_are_no_defects() {
    let ring = revolved(RingSide::Inner, 36, ElementKind::Hex8);
    let reason = |mesh: &Mesh| find_nearly_periodic(mesh, PERIODIC_TOLERANCE).unwrap_err();
    let mut wavy = ring.clone();
    for (i, x) in wavy.nodes.iter_mut().enumerate().filter(|(_, x)| x[1] > 0.0) {
        x[2] += 1e-5 * (i as f64).sin();
    }
    assert!(matches!(
        reason(&wavy),
        NotNearlyPeriodic::Large { .. } | NotNearlyPeriodic::NoPattern
    ));

    let azimuth = |e: usize| ring.element_centre(e)[1].atan2(ring.element_centre(e)[0]);
    let third = ring.clone().without_elements(|e| azimuth(e) > 1.0).0;
    assert!(matches!(
        reason(&third),
        NotNearlyPeriodic::Large { n_sectors: 36, .. }
    ));

    // One element becomes two.
    let mut refined = ring.clone();
    let (lost, first) = (ring.element(40).to_vec(), ring.n_nodes());
    for (a, b) in [(0, 1), (3, 2), (4, 5), (7, 6)] {
        let [a, b] = [a, b].map(|i| ring.nodes[lost[i]]);
        refined.nodes.push([0, 1, 2].map(|i| 0.5 * (a[i] + b[i])));
    }
    let halves = [
        [
            lost[0],
            first,
            first + 1,
            lost[3],
            lost[4],
            first + 2,
            first + 3,
            lost[7],
        ],
        [
            first,
            lost[1],
            lost[2],
            first + 1,
            first + 2,
            lost[5],
            lost[6],
            first + 3,
        ],
    ];
    refined.connectivity.splice(8 * 40..8 * 41, halves.concat());
    refined.groups.clear();
    let found = reason(&refined);
    assert!(
        matches!(
            found,
            NotNearlyPeriodic::MoreNodes {
                strays: 4,
                vacancies: 0,
                ..
            }
        ),
        "{found}"
    );
    assert!(
        found
            .to_string()
            .contains(&format!("4 nodes from node {first} on")),
        "{found}"
    );

    // An element twice as long over its neighbour: no node is new.
    let mut overlapping = ring.clone();
    let next = |node: usize| {
        find_periodicity(&ring, PERIODIC_TOLERANCE).map(|p| {
            let site = p.sites()[node];
            p.nodes()[(site.sector + 1) % 36 * p.n_section_nodes() + site.section_node]
        })
    };
    let nodes = ring.element(40);
    let far = nodes.iter().map(|&n| next(n).unwrap()).collect::<Vec<_>>();
    let long: Vec<usize> = nodes
        .iter()
        .zip(&far)
        .map(|(&n, &f)| if nodes.contains(&f) { n } else { f })
        .collect();
    overlapping.connectivity.splice(8 * 40..8 * 41, long);
    overlapping.groups.clear();
    let found = reason(&overlapping);
    assert!(
        matches!(found, NotNearlyPeriodic::MoreElements { element: 40, .. }),
        "{found}"
    );

    let mut orphaned = ring.clone();
    orphaned.connectivity = orphaned.connectivity[8 * ring.n_elements() / 36 * 2..].to_vec();
    orphaned.groups.clear();
    assert!(
        matches!(reason(&orphaned), NotNearlyPeriodic::Node { .. }),
        "{}",
        reason(&orphaned)
    );
}

/// Wrong: a ring of which a group lacks a facet would be said to have a defect in its matrices.
#[test]
fn groups_are_no_part_of_a_defect() {
    let ring = revolved(RingSide::Inner, 37, ElementKind::Hex8);
    let mut unmarked = ring.clone();
    unmarked.groups.get_mut("raceway").unwrap().remove(11);
    assert!(find_periodicity(&unmarked, PERIODIC_TOLERANCE).is_err());
    let found = find_nearly_periodic(&unmarked, PERIODIC_TOLERANCE).unwrap();
    assert!(found.moved.is_empty() && found.absent.is_empty() && found.missing.is_empty());
    assert_eq!(found.periodicity.n_sectors(), 37);
}
