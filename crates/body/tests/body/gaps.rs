//! Seats that lack a part of their cylinder.

use std::f64::consts::TAU;

use mesh::{ElementKind, Facet, Mesh};

use crate::{basis, made, material, tube};

/// Wrong: nobody would know that a ring is held by a part of its seat: a group of which a third of the facets was lost
/// gave other displacements without a word. A third of the circle, from end to end.
#[test]
fn a_seat_that_lacks_facets_says_so() {
    let whole = tube(ElementKind::Hex8, 36, [2, 2]);
    let gaps = |mesh: Mesh| made(mesh, material(0.3), "outside", basis(2, 1)).unwrap().gaps;
    assert_eq!(gaps(whole.clone()), []);
    let mut cut = whole;
    let centre = |facet: &Facet| {
        let nodes = cut.facet_nodes(*facet).take(4);
        nodes.fold([0.0; 2], |[x, y], n| [x + cut.nodes[n][0], y + cut.nodes[n][1]])
    };
    let is_kept = |facet: &Facet| {
        let [x, y] = centre(facet);
        y.atan2(x).rem_euclid(TAU) < 2.0 / 3.0 * TAU
    };
    let kept: Vec<Facet> = cut.group("seat_a").iter().copied().filter(is_kept).collect();
    cut.groups.insert("seat_a".to_string(), kept);
    let [(name, coverage)] = &gaps(cut)[..] else {
        panic!("one seat lacks facets")
    };
    assert_eq!(name, "seat_a");
    assert!((coverage.circle - 2.0 / 3.0).abs() < 1e-9, "{}", coverage.circle);
    assert!((coverage.area - 2.0 / 3.0).abs() < 1e-9, "{}", coverage.area);
}
