//! Revolved rings: volumes, periodicity, groove, orientation, numbering.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

use mesh::{
    Arc, ElementKind, Facet, Mesh, Origin, RingSide, Section, Snap, Torus, check_mesh, check_torus,
    check_unit, require_groups, revolve,
};

use crate::{relative_volume, revolved, ring, section};

const SIDES: [RingSide; 2] = [RingSide::Outer, RingSide::Inner];
const KINDS: [ElementKind; 2] = [ElementKind::Hex8, ElementKind::Hex20];

/// If this failed, nodes would not lie at their azimuths, and mass and stiffness of the rings would be off from the
/// start. A tube of straight section is made of sectors of angle h = 2t bounded by chords (hex8) or parabolas through
/// the middle of the arc (hex20; area 2/3 of chord times sagitta), so its volume is known in closed form.
#[test]
fn a_tube_has_the_volume_of_its_chords_and_parabolas() {
    let points = vec![
        [1.0, 0.0],
        [1.5, 0.0],
        [2.0, 0.0],
        [1.0, 3.0],
        [1.5, 3.0],
        [2.0, 3.0],
    ];
    let tube = Section::new(points, vec![[0, 1, 4, 3], [1, 2, 5, 4]], &BTreeMap::new()).unwrap();
    for n in [3, 4, 7, 12, 90] {
        let t = PI / n as f64;
        let chords = 0.5 * (2.0 * t).sin();
        let parabolas = chords + 4.0 / 3.0 * t.sin() * (1.0 - t.cos());
        for (kind, share) in [(ElementKind::Hex8, chords), (ElementKind::Hex20, parabolas)] {
            let exact = n as f64 * share * (2.0_f64.powi(2) - 1.0) * 3.0;
            let relative = mesh::volume(&revolve(&tube, n, kind, &[]).unwrap()) / exact - 1.0;
            // Rounding of a sum over up to 180 elements.
            assert!(relative.abs() < 1e-14, "{kind:?}, {n} sectors: {relative:e}");
        }
    }
}

/// If this failed, the raised order would not pay: the section's arc is off by h^4 only, below 2e-5 here.
#[test]
fn a_quadratic_ring_has_the_volume_of_the_closed_form() {
    for side in SIDES {
        let error = relative_volume(&revolved(side, 90, ElementKind::Hex20), side);
        assert!(error.abs() < 2e-5, "{side:?}: {error:e}");
        assert!(
            relative_volume(&revolved(side, 90, ElementKind::Hex8), side).abs() > 1e-4,
            "hex8 is cruder"
        );
    }
}

/// If this failed, the cyclic solver's blocks would differ from sector to sector.
#[test]
fn all_sectors_are_one_sector_turned() {
    for kind in KINDS {
        let n_sectors = 36;
        let mesh = revolved(RingSide::Outer, n_sectors, kind);
        let (m, q) = (mesh.n_nodes() / n_sectors, mesh.n_elements() / n_sectors);
        let n = kind.n_nodes();
        for sector in 0..n_sectors {
            let (s, c) = (TAU * sector as f64 / n_sectors as f64).sin_cos();
            for i in 0..m {
                let (x, y) = (mesh.nodes[i], mesh.nodes[sector * m + i]);
                let turned = [c * x[0] - s * x[1], s * x[0] + c * x[1]];
                // Rounding of 0.04 m: a few units in the last place.
                assert!(
                    (turned[0] - y[0]).hypot(turned[1] - y[1]) < 4e-17,
                    "{kind:?} sector {sector} node {i}"
                );
                assert_eq!(x[2].to_bits(), y[2].to_bits(), "axial positions are copies");
            }
            for k in 0..q * n {
                let turned = (mesh.connectivity[k] + sector * m) % mesh.n_nodes();
                assert_eq!(
                    turned,
                    mesh.connectivity[sector * q * n + k],
                    "{kind:?} sector {sector}"
                );
            }
        }
    }
}

/// If this failed, quarter turns would carry rounding that makes exactly equal sectors differ.
#[test]
fn a_quarter_turn_is_exact() {
    let mesh = revolved(RingSide::Inner, 12, ElementKind::Hex20);
    let quarter = mesh.n_nodes() / 4;
    for i in 0..mesh.n_nodes() {
        let (x, y) = (mesh.nodes[i], mesh.nodes[(i + quarter) % mesh.n_nodes()]);
        assert_eq!([-x[1], x[0], x[2]], y, "node {i}");
    }
}

/// If this failed, the contact's exact torus and the mesh's raceway would be two surfaces.
#[test]
fn raceway_nodes_lie_on_the_torus() {
    for side in SIDES {
        let geometry = ring(side).geometry().unwrap();
        for kind in KINDS {
            let mesh = revolved(side, 18, kind);
            let origin = Origin::of_generated("revolved", 1e-3, &mesh);
            // Rounding of 0.04 m is 7e-18 m per operation.
            check_torus(&mesh, &origin, "raceway", &geometry.torus(), 5e-17).unwrap();
            assert!(mesh.group_nodes("raceway").len() >= 18 * 9);
        }
    }
}

/// If this failed, a mesh with another groove would be accepted, or the message would not say how far it is off.
#[test]
fn another_torus_is_refused_with_its_worst_node() {
    let mesh = revolved(RingSide::Outer, 18, ElementKind::Hex8);
    let mut origin = Origin::of_generated("m.msh", 1e-3, &mesh);
    origin.node_tags.iter_mut().for_each(|tag| *tag += 1000);
    let right = ring(RingSide::Outer).geometry().unwrap().torus();
    let wrong = Torus {
        groove_radius: right.groove_radius + 1e-6,
        ..right
    };
    check_torus(&mesh, &origin, "raceway", &wrong, 1.1e-6).unwrap();
    let error = check_torus(&mesh, &origin, "raceway", &wrong, 1e-9)
        .unwrap_err()
        .to_string();
    assert!(error.contains("is -1.000e-6 m off the groove torus"), "{error}");
    assert!(
        error.starts_with("m.msh: node 1") && error.contains("(162 of 162 nodes are)"),
        "{error}"
    );
    let error = check_torus(&mesh, &origin, "track", &right, 1e-9)
        .unwrap_err()
        .to_string();
    assert!(error.contains("no facet group \"track\""), "{error}");
}

/// Wrong: a user whose mesh has straight sides would be sent to compare diameters that are right.
#[test]
fn straight_sides_of_a_fine_mesh_are_named() {
    let mut mesh = revolved(RingSide::Outer, 18, ElementKind::Hex20);
    for facet in mesh.group("raceway").to_vec() {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        for i in 0..4 {
            let [a, b] = [nodes[i], nodes[(i + 1) % 4]].map(|node| mesh.nodes[node]);
            mesh.nodes[nodes[4 + i]] = [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]));
        }
    }
    let origin = Origin::of_generated("m.msh", 1e-3, &mesh);
    let torus = ring(RingSide::Outer).geometry().unwrap().torus();
    let error = check_torus(&mesh, &origin, "raceway", &torus, 1e-6)
        .unwrap_err()
        .to_string();
    let advice = "only mid-side nodes are off, so that the elements of second order have straight sides: mesh the \
                  geometry itself with Mesh.SecondOrderLinear = 0, which puts them on the groove";
    assert!(error.contains(advice), "{error}");
}

/// If this failed, a mesh in millimetres taken for metres would be solved a thousand times too large.
#[test]
fn a_wrong_unit_is_told_with_the_right_one() {
    let mesh = revolved(RingSide::Outer, 18, ElementKind::Hex8);
    let origin = Origin::of_generated("m.msh", 1e-3, &mesh);
    check_unit(&mesh, &origin, 80e-3).unwrap();
    for (unit, name) in [(1.0, "mm"), (1e-6, "mm"), (0.0254, "mm")] {
        let scale = unit / 1e-3;
        let nodes = mesh.nodes.iter().map(|x| x.map(|c| c * scale)).collect();
        let scaled = Mesh {
            nodes,
            ..mesh.clone()
        };
        let origin = Origin {
            unit,
            ..origin.clone()
        };
        let error = check_unit(&scaled, &origin, 80e-3).unwrap_err().to_string();
        assert!(
            error.contains(&format!("seem to be in {name}: state a mesh unit of \"{name}\"")),
            "{error}"
        );
    }
    let error = check_unit(&mesh, &origin, 0.5).unwrap_err().to_string();
    assert!(error.contains("no common unit fits"), "{error}");
}

/// If this failed, pressure on the raceway would act from the wrong side.
#[test]
fn facets_of_revolved_groups_face_outwards() {
    for (side, seat) in [(RingSide::Outer, "seat"), (RingSide::Inner, "bore")] {
        let outward = if side == RingSide::Outer { 1.0 } else { -1.0 };
        for kind in KINDS {
            let mesh = revolved(side, 18, kind);
            let origin = Origin::of_generated("revolved", 1e-3, &mesh);
            check_mesh(&mesh, &origin).unwrap();
            require_groups(&mesh, "revolved", &["raceway", seat, "shoulder", "face"]).unwrap();
            for (group, sign) in [("raceway", -outward), (seat, outward)] {
                assert!(mesh.group(group).len() >= 18 * 8);
                for &facet in mesh.group(group) {
                    let x: Vec<[f64; 3]> = mesh.facet_nodes(facet).take(4).map(|n| mesh.nodes[n]).collect();
                    let (a, b) = (sub(x[2], x[0]), sub(x[3], x[1]));
                    let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2]];
                    let radial = normal[0] * (x[0][0] + x[2][0]) + normal[1] * (x[0][1] + x[2][1]);
                    assert!(sign * radial > 0.0, "{side:?} {kind:?} {group} {facet:?}");
                }
            }
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// If this failed, a revolve that cannot succeed would give a wrong mesh instead of a reason.
#[test]
fn impossible_revolves_say_why() {
    let section = section(RingSide::Outer);
    let snap = ring(RingSide::Outer).geometry().unwrap().snap();
    let text = |n, kind, snaps: &[Snap]| revolve(&section, n, kind, snaps).unwrap_err().to_string();
    assert!(text(12, ElementKind::Tet10, &[]).contains("expected hex8 or hex20"));
    assert!(text(2, ElementKind::Hex8, &[]).contains("2 sectors do not make a ring"));
    let named = Snap {
        group: "track".to_string(),
        ..snap.clone()
    };
    let error = text(12, ElementKind::Hex8, &[named]);
    assert!(
        error.contains("no edges named \"track\"; groups are \"face\", \"raceway\", \"seat\", \"shoulder\""),
        "{error}"
    );
    let other = Snap {
        arc: Arc {
            radius: 4.65e-3,
            ..snap.arc
        },
        ..snap
    };
    let error = text(12, ElementKind::Hex8, &[other]);
    assert!(
        error.contains("1.000e-4 m off the circle of radius 4.65e-3 m"),
        "{error}"
    );
}

/// Wrong: a rank that keeps a part of a mesh would put forces on other nodes, or lose a part of a surface.
#[test]
fn a_mesh_with_some_of_its_elements_keeps_its_nodes_and_their_facets() {
    let whole = revolve(&section(RingSide::Inner), 12, ElementKind::Hex8, &[]).unwrap();
    let raceway = whole.group("raceway").to_vec();
    let surface: BTreeSet<usize> = raceway.iter().map(|f| f.element).collect();
    let kept: Vec<usize> = (0..whole.n_elements())
        .filter(|e| surface.contains(e) || e % 7 == 3)
        .collect();
    assert!(kept.len() < whole.n_elements());
    let part = whole.clone().with_elements(&kept);
    assert_eq!(part.nodes, whole.nodes);
    for (place, &e) in kept.iter().enumerate() {
        assert_eq!(part.element(place), whole.element(e));
    }
    assert_eq!(part.n_elements(), kept.len());
    let nodes = |mesh: &Mesh, facets: &[Facet]| -> Vec<Vec<usize>> {
        let nodes = |&facet: &Facet| mesh.facet_nodes(facet).collect();
        facets.iter().map(nodes).collect()
    };
    let whole_nodes = nodes(&whole, &raceway);
    assert!(nodes(&part, part.group("raceway")) == whole_nodes);
    assert!(part.group("bore").len() < whole.group("bore").len());
    let none = whole.with_elements(&[]);
    assert!(none.group("raceway").is_empty() && none.connectivity.is_empty());
}
