//! The sections of rings whose shape is a body of revolution though their mesh is not.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::PathBuf;

use mesh::{
    ElementKind, Mesh, NotRevolved, Origin, OutlineCurve, OutlinePiece, REVOLVED_TOLERANCE, Revolution,
    RingSide, Section, SectionFineness, find_revolution, groove_of, group_outline, is_revolved, outline_geo,
    revolve,
};

use crate::{revolved, ring};

/// The free mesh of the 7010C's inner ring, quadratic tetrahedra of Gmsh.
fn free_ring() -> (Mesh, Origin) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../meshes/7010c_inner_tet10.msh");
    mesh::read_msh_with_origin(path, 1e-3).unwrap()
}

fn origin_of(mesh: &Mesh) -> Origin {
    Origin {
        path: PathBuf::from("ring.msh"),
        unit: 1.0,
        node_tags: (1..=mesh.n_nodes() as u64).collect(),
        element_tags: (1..=mesh.n_elements() as u64).collect(),
    }
}

/// The usual tolerance, m.
fn tolerance(mesh: &Mesh) -> f64 {
    REVOLVED_TOLERANCE * mesh.nodes.iter().map(|x| x[0].hypot(x[1])).fold(0.0, f64::max)
}

fn find(mesh: &Mesh) -> Result<Revolution, NotRevolved> {
    find_revolution(mesh, tolerance(mesh))
}

/// Corners and arcs of an outline by their groups.
fn of_group<'a>(outline: &'a [OutlinePiece], group: &str) -> Vec<&'a OutlinePiece> {
    outline
        .iter()
        .filter(|piece| piece.groups.iter().any(|g| g == group))
        .collect()
}

/// Wrong: the periodic ring would be another one than the free one: another groove, bore or width.
#[test]
fn a_free_mesh_gives_the_dimensions_that_it_was_made_from() {
    let (mesh, origin) = free_ring();
    let found = find(&mesh).unwrap();
    assert!(found.deviation < 1e-12, "{:e}", found.deviation);
    let outline = group_outline(&mesh, &origin, &found, tolerance(&mesh)).unwrap();
    let groove = groove_of(&outline, &origin.path, tolerance(&mesh)).unwrap();
    let exact = ring(RingSide::Inner);
    let geometry = exact.geometry().unwrap();
    assert_eq!(groove.side, RingSide::Inner);
    // Coordinates have 16 digits; the circle of least squares loses three.
    for (is, should) in [
        (groove.arc.radius, exact.groove_radius),
        (groove.arc.centre_r, geometry.centre_radius),
        (groove.arc.centre_z, 0.0),
        (groove.held_diameter, exact.seat_diameter),
        (groove.raceway_diameter(), exact.raceway_diameter),
        (groove.faces[1] - groove.faces[0], exact.width),
        (groove.ends[0][1], geometry.groove_z[0]),
        (2.0 * groove.ends[1][0], exact.shoulder_diameters[1]),
    ] {
        assert!((is - should).abs() < 1e-12, "{is:e} {should:e}");
    }
    // One arc, one bore, two shoulders, two faces.
    let counts = ["raceway", "bore", "shoulder", "face"].map(|group| of_group(&outline, group).len());
    assert_eq!((outline.len(), counts), (6, [1, 1, 2, 2]));
    assert!((found.volume / exact.volume().unwrap() - 1.0).abs() < 1e-10);
    // Quadratic elements of 1.6 mm on radii of 25 to 30 mm.
    assert!((found.mesh_volume / found.volume - 1.0).abs() < 1e-4);
}

/// Wrong: the closed form of a groove and of chords would not hold for hexahedra, whose arcs are known by few points.
#[test]
fn rings_of_sectors_give_their_own_section() {
    for side in [RingSide::Inner, RingSide::Outer] {
        for kind in [ElementKind::Hex8, ElementKind::Hex20] {
            let mesh = revolved(side, 54, kind);
            let found = find(&mesh).unwrap();
            let origin = origin_of(&mesh);
            let outline = group_outline(&mesh, &origin, &found, tolerance(&mesh)).unwrap();
            let groove = groove_of(&outline, &origin.path, tolerance(&mesh)).unwrap();
            assert!(
                (groove.arc.radius - ring(side).groove_radius).abs() < 1e-12,
                "{side:?} {kind:?}"
            );
            assert!(
                (found.volume / ring(side).volume().unwrap() - 1.0).abs() < 1e-10,
                "{side:?} {kind:?}"
            );
        }
    }
}

/// A section with chamfers at the bore and at one face, and a step in the left shoulder; also its corners. It has
/// `rows` elements from the bore to the shoulders.
fn stepped(rows: u32) -> (Section, Vec<[f64; 2]>) {
    let bore = |z: f64| 25e-3 + (0.5e-3 - (8e-3 - z.abs())).max(0.0);
    let top = |z: f64| match z {
        z if z < -5.0e-3 => 29.2e-3,
        z if z < -4.6e-3 => 29.2e-3 + (z + 5.0e-3) / 0.4e-3 * 1.0e-3,
        z if z > 7.6e-3 => 30.2e-3 - (z - 7.6e-3),
        z => {
            let groove = 32.655e-3 - (4.65e-3_f64.powi(2) - (z * z).min(4.65e-3_f64.powi(2))).sqrt();
            groove.min(30.2e-3)
        }
    };
    let end = (4.65e-3_f64.powi(2) - (32.655e-3_f64 - 30.2e-3).powi(2)).sqrt();
    let mut stations = vec![-8e-3, -7.5e-3, -6.5e-3, -5.0e-3, -4.6e-3, -4.3e-3];
    stations.extend((0..=12).map(|i| -end + 2.0 * end * f64::from(i) / 12.0));
    stations.extend([4.6e-3, 6e-3, 7.5e-3, 7.6e-3, 8e-3]);
    let mut points = Vec::new();
    for &z in &stations {
        points.extend((0..=rows).map(|i| {
            let share = f64::from(i) / f64::from(rows);
            [bore(z) + share * (top(z) - bore(z)), z]
        }));
    }
    let n = rows as usize + 1;
    let mut quads = Vec::new();
    let mut groups: BTreeMap<String, Vec<[usize; 2]>> = BTreeMap::new();
    for s in 0..stations.len() - 1 {
        quads.extend((0..n - 1).map(|i| [s * n + i, s * n + i + 1, (s + 1) * n + i + 1, (s + 1) * n + i]));
        let (low, high) = (stations[s], stations[s + 1]);
        let middle = 0.5 * (low + high);
        if middle.abs() < end {
            groups
                .entry("raceway".into())
                .or_default()
                .push([(s + 1) * n - 1, (s + 2) * n - 1]);
        }
        if middle.abs() < 7.5e-3 {
            groups
                .entry("bore".into())
                .or_default()
                .push([s * n, (s + 1) * n]);
        }
    }
    let corners = [
        [25.5e-3, -8e-3],
        [25e-3, -7.5e-3],
        [25e-3, 7.5e-3],
        [25.5e-3, 8e-3],
        [29.8e-3, 8e-3],
        [30.2e-3, 7.6e-3],
        [30.2e-3, end],
        [30.2e-3, -end],
        [30.2e-3, -4.6e-3],
        [29.2e-3, -5e-3],
        [29.2e-3, -8e-3],
    ];
    (Section::new(points, quads, &groups).unwrap(), corners.to_vec())
}

/// Wrong: chamfers and steps would be rounded off or left out.
#[test]
fn chamfers_and_steps_are_corners_of_the_outline() {
    let (section, corners) = stepped(4);
    let mesh = revolve(&section, 72, ElementKind::Hex8, &[]).unwrap();
    let found = find(&mesh).unwrap();
    let origin = origin_of(&mesh);
    let outline = group_outline(&mesh, &origin, &found, tolerance(&mesh)).unwrap();
    assert_eq!(outline.len(), corners.len(), "{outline:#?}");
    for corner in &corners {
        let near = |piece: &OutlinePiece| (piece.start[0] - corner[0]).hypot(piece.start[1] - corner[1]);
        let distance = outline.iter().map(near).fold(f64::INFINITY, f64::min);
        assert!(distance < 1e-12, "{corner:?} {distance:e}");
    }
    assert_eq!(
        outline
            .iter()
            .filter(|p| matches!(p.curve, OutlineCurve::Arc { .. }))
            .count(),
        1
    );
    let [raceway, bore] = ["raceway", "bore"].map(|group| of_group(&outline, group));
    assert_eq!((raceway.len(), bore.len()), (1, 1));
    assert!((bore[0].length() - 15e-3).abs() < 1e-12);
    // Gmsh gets every corner, and the groups by the numbers of their curves.
    let groove = groove_of(&outline, &origin.path, tolerance(&mesh)).unwrap();
    let fineness = SectionFineness {
        kind: ElementKind::Hex8,
        sectors: 90,
        groove_elements: 12,
        thickness_elements: 4,
        grading: 1.2,
    };
    let geo = outline_geo(&outline, &groove, &fineness).unwrap();
    assert_eq!(geo.matches("\nLine(").count(), 10, "{geo}");
    assert_eq!(geo.matches("\nCircle(").count(), 1, "{geo}");
    assert!(geo.contains("Physical Curve(\"bore\") = {"), "{geo}");
    let error = outline_geo(
        &outline,
        &groove,
        &SectionFineness {
            sectors: 2,
            ..fineness
        },
    )
    .unwrap_err();
    assert_eq!(error.to_string(), "sectors is 2; expected 3 to 100000");
}

/// Wrong: whether `mesh --revolve-like` took a ring with chamfers or faces of one element would depend on the angle by
/// which the mesh is turned, that is on round-off.
#[test]
fn faces_and_chamfers_of_one_element_are_found_at_any_angle() {
    for rows in [1, 4] {
        let (section, corners) = stepped(rows);
        let upright = revolve(&section, 24, ElementKind::Hex8, &[]).unwrap();
        for angle in [0.0_f64, 0.3, 0.71, 1.1, 1.9, 2.5, 3.0, 4.0] {
            let (sin, cos) = angle.sin_cos();
            let mut mesh = upright.clone();
            mesh.nodes
                .iter_mut()
                .for_each(|x| *x = [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]]);
            let found = find(&mesh).unwrap_or_else(|reason| panic!("{rows} rows, {angle} rad: {reason}"));
            assert_eq!(found.outline.len(), corners.len(), "{rows} rows, {angle} rad");
        }
    }
}

/// Wrong: a ring with a keyway or a hole would lose it in silence.
#[test]
fn what_is_missing_from_a_ring_is_told_with_its_place() {
    let (free, _) = free_ring();
    let keyway = |mesh: &Mesh, e: usize| {
        let [x, y, _] = mesh.element_centre(e);
        (y.atan2(x).to_degrees() - 90.0).abs() < 6.0 && x.hypot(y) < 26.4e-3
    };
    let hole = |mesh: &Mesh, e: usize| {
        let [x, y, z] = mesh.element_centre(e);
        x < 0.0 && y.hypot(z - 6e-3) < 1.5e-3
    };
    let slit = |mesh: &Mesh, e: usize| {
        let [x, y, _] = mesh.element_centre(e);
        x < 0.0 && y.abs() < 1e-3
    };
    type Lost<'a> = &'a dyn Fn(&Mesh, usize) -> bool;
    let regular = revolved(RingSide::Inner, 90, ElementKind::Hex8);
    let cases: [(&Mesh, Lost<'_>, f64); 5] = [
        (&free, &keyway, 90.0),
        (&free, &hole, 180.0),
        (&free, &slit, 180.0),
        (&regular, &keyway, 90.0),
        (&regular, &slit, 180.0),
    ];
    for (i, (mesh, lost, azimuth)) in cases.into_iter().enumerate() {
        let (cut, _) = mesh.clone().without_elements(|e| lost(mesh, e));
        assert!(cut.n_elements() < mesh.n_elements(), "case {i}");
        assert!(
            is_revolved(mesh, tolerance(mesh)) && !is_revolved(&cut, tolerance(mesh)),
            "case {i}"
        );
        let reason = find(&cut).unwrap_err();
        let NotRevolved::Off(off) = reason else {
            panic!("case {i}: {reason}")
        };
        assert!(
            (off.azimuth.to_degrees() - azimuth).abs() < 12.0,
            "case {i}: {reason}"
        );
        assert!(
            (off.between[1] - off.between[0]).to_degrees() < 30.0,
            "case {i}: {reason}"
        );
        assert!(off.distance > 0.3e-3 && off.distance < 4e-3, "case {i}: {reason}");
        let text = reason.to_string();
        assert!(
            text.contains("nodes of its surface are off the section that the others have, by up to"),
            "{text}"
        );
        assert!(text.contains("they lie between azimuths"), "{text}");
    }
}

/// Wrong: an oval ring would be made round.
#[test]
fn an_oval_ring_is_no_body_of_revolution() {
    let (mut mesh, _) = free_ring();
    mesh.nodes.iter_mut().for_each(|x| x[0] *= 1.0 + 1e-4);
    let reason = find(&mesh).unwrap_err();
    let NotRevolved::Off(off) = reason else {
        panic!("{reason}")
    };
    assert!(
        off.n_off > off.n_nodes / 2 && off.distance > 2e-6 && off.distance < 2e-5,
        "{reason}"
    );
}

/// Wrong: a ring that is only turned and moved would be refused without saying so, or taken for one about z.
#[test]
fn a_tilted_or_shifted_ring_is_told_its_own_axis() {
    let (mesh, _) = free_ring();
    let (tilt, foot) = (2.0_f64.to_radians(), [0.3e-3, -0.1e-3]);
    let mut moved = mesh.clone();
    moved.nodes.iter_mut().for_each(|x| {
        let (sin, cos) = tilt.sin_cos();
        *x = [
            cos * x[0] + sin * x[2] + foot[0],
            x[1] + foot[1],
            cos * x[2] - sin * x[0],
        ];
    });
    let reason = find(&moved).unwrap_err();
    let NotRevolved::OtherAxis(axis) = reason else {
        panic!("{reason}")
    };
    // The moments of the elements are those of a body of revolution up to their chords.
    assert!((axis.tilt - tilt).abs() < 1e-6, "{reason}");
    assert!((0..2).all(|i| (axis.point[i] - foot[i]).abs() < 1e-7), "{reason}");
    assert!(axis.azimuth.min(TAU - axis.azimuth) < 1e-4, "{reason}");
    assert!(
        reason
            .to_string()
            .contains("turn and move the mesh so that its axis is z"),
        "{reason}"
    );
}

/// Wrong: a ring along x or y would be told which of its nodes are off a section about z, not that it lies along x.
#[test]
fn a_ring_along_x_or_y_is_told_so() {
    let upright = revolved(RingSide::Inner, 45, ElementKind::Hex8);
    type Turn = fn([f64; 3]) -> [f64; 3];
    let about_x: Turn = |x| [x[2] + 2e-3, x[0], x[1]];
    let about_y: Turn = |x| [x[1], x[2] + 2e-3, x[0]];
    for (turned, along, azimuth) in [(about_x, 0, 0.0), (about_y, 1, 90.0f64)] {
        let mut mesh = upright.clone();
        mesh.nodes.iter_mut().for_each(|x| *x = turned(*x));
        let reason = find(&mesh).unwrap_err();
        let NotRevolved::OtherAxis(axis) = reason else {
            panic!("{reason}")
        };
        assert!((axis.tilt.to_degrees() - 90.0).abs() < 1e-6, "{reason}");
        // Either end may be the upper one.
        let off = axis.azimuth - azimuth.to_radians();
        assert!(off.sin().abs() < 1e-6, "{reason}");
        assert!(axis.point[(along + 1) % 3].abs() < 1e-9, "{reason}");
    }
}

/// Wrong: a bore that is held over half of the circle would be held all round in the new mesh, or not at all.
#[test]
fn a_group_that_does_not_go_round_is_refused() {
    let mut mesh = revolved(RingSide::Inner, 90, ElementKind::Hex8);
    let found = find(&mesh).unwrap();
    let half: Vec<_> = mesh
        .group("bore")
        .iter()
        .copied()
        .filter(|f| mesh.element_centre(f.element)[1] > 0.0)
        .collect();
    mesh.groups.insert("bore".into(), half);
    let origin = origin_of(&mesh);
    let text = group_outline(&mesh, &origin, &found, tolerance(&mesh))
        .unwrap_err()
        .to_string();
    assert!(text.contains("group \"bore\" ends between the nodes"), "{text}");
    assert!(
        text.contains("expected groups that go all round the ring"),
        "{text}"
    );
}

/// Wrong: a bore of which a strip is held would be held over its whole width.
#[test]
fn a_strip_of_a_surface_is_a_piece_of_its_own() {
    let mut mesh = revolved(RingSide::Inner, 90, ElementKind::Hex8);
    let found = find(&mesh).unwrap();
    let strip: Vec<_> = mesh
        .group("bore")
        .iter()
        .copied()
        .filter(|f| mesh.element_centre(f.element)[2].abs() < 2e-3)
        .collect();
    assert!(!strip.is_empty());
    mesh.groups.insert("bore".into(), strip);
    let outline = group_outline(&mesh, &origin_of(&mesh), &found, tolerance(&mesh)).unwrap();
    let bore = of_group(&outline, "bore");
    assert_eq!((bore.len(), outline.len()), (1, 8));
    let reach = mesh
        .group_nodes("bore")
        .iter()
        .map(|&n| mesh.nodes[n][2])
        .fold(0.0, f64::max);
    assert!(
        (bore[0].start[1].abs() - reach).abs() < 1e-12 && bore[0].length() < 5e-3,
        "{bore:?} {reach}"
    );
}

/// Wrong: a section without a groove would be meshed, or the user would not learn which names are missing.
#[test]
fn a_section_without_a_groove_is_refused() {
    let mesh = revolved(RingSide::Inner, 90, ElementKind::Hex8);
    let found = find(&mesh).unwrap();
    let message = |groups: &[(&str, &str)]| {
        let mut other = mesh.clone();
        other.groups = groups
            .iter()
            .map(|&(name, of)| (name.to_string(), mesh.group(of).to_vec()))
            .collect();
        let origin = origin_of(&other);
        let outline = group_outline(&other, &origin, &found, tolerance(&other)).unwrap();
        groove_of(&outline, &origin.path, tolerance(&other))
            .unwrap_err()
            .to_string()
    };
    let names = "expected facet groups \"raceway\" and either \"bore\" (inner ring) or \"seat\" (outer ring)";
    for groups in [
        &[("groove", "raceway"), ("bore", "bore")][..],
        &[("raceway", "raceway")],
        &[("raceway", "raceway"), ("bore", "bore"), ("seat", "face")],
    ] {
        let text = message(groups);
        assert!(text.contains(names), "{text}");
    }
    let text = message(&[("raceway", "bore"), ("bore", "raceway")]);
    assert!(
        text.contains("group \"raceway\" is straight from r = 25.0000 mm"),
        "{text}"
    );
    assert!(text.contains("expected arcs of one circle"), "{text}");
}
