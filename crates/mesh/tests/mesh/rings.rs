//! Sections and the measures of rings.

use std::collections::BTreeMap;

use mesh::{RingSection, RingSide, Section, read_section, ring_geo, ring_tet_geo};

use crate::{data, ring, section};

type Parts = (Vec<[f64; 2]>, Vec<[usize; 4]>, BTreeMap<String, Vec<[usize; 2]>>);

/// Two quads side by side in the half plane, the second turning clockwise.
fn two_quads() -> Parts {
    let points = vec![
        [1.0, 0.0],
        [2.0, 0.0],
        [3.0, 0.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [3.0, 1.0],
    ];
    let groups = BTreeMap::from([
        ("raceway".to_string(), vec![[3, 0]]),
        ("seat".to_string(), vec![[2, 5]]),
    ]);
    (points, vec![[0, 1, 4, 3], [1, 4, 5, 2]], groups)
}

/// If this failed, the sections by gmsh would not be the ring's.
#[test]
fn sections_by_gmsh_have_their_points_groups_and_area() {
    for (side, seat) in [(RingSide::Outer, "seat"), (RingSide::Inner, "bore")] {
        let section = section(side);
        assert_eq!((section.points().len(), section.quads().len()), (13 * 4, 12 * 3));
        let lengths: Vec<(&str, usize)> = section
            .groups()
            .iter()
            .map(|(k, v)| (k.as_str(), v.len()))
            .collect();
        let mut expected = vec![("face", 6), ("raceway", 8), (seat, 12), ("shoulder", 4)];
        expected.sort_unstable();
        assert_eq!(lengths, expected);
        let (g, r) = (ring(side).geometry().unwrap(), ring(side));
        // Rectangle from the seat to the shoulder less a circular segment of half angle t, of which eight chords
        // leave eight slivers.
        let t = g.groove_angles[0];
        let height = 0.5 * (r.seat_diameter - r.shoulder_diameters[0]).abs();
        let slivers = 8.0 * 0.5 * ((t / 4.0) - (t / 4.0).sin());
        let exact = height * r.width - g.groove_radius.powi(2) * (t - t.sin() * t.cos() - slivers);
        let relative = section.area() / exact - 1.0;
        // Gmsh writes 16 digits; cancellation takes two.
        assert!(relative.abs() < 1e-13, "{side:?}: {relative:e}");
        for &edge in &section.groups()["raceway"] {
            for n in section.edge_points(edge) {
                let [r, z] = section.points()[n];
                // Gmsh writes 16 digits of numbers near 35 mm.
                assert!(((r - g.centre_radius).hypot(z) - g.groove_radius).abs() < 1e-16);
            }
        }
    }
}

/// If this failed, the turning sense of a drawing would decide over the sign of volumes.
#[test]
fn quads_are_stored_counter_clockwise() {
    let (points, quads, groups) = two_quads();
    let section = Section::new(points, quads, &groups).unwrap();
    assert_eq!(section.quads()[1], [1, 2, 5, 4]);
    assert_eq!(section.area(), 2.0);
    let seat = section.groups()["seat"][0];
    assert_eq!(section.edge_points(seat), [2, 5]);
}

/// If this failed, a wrong section would be revolved into a wrong ring.
#[test]
fn wrong_sections_are_refused_by_name() {
    type Spoil = fn(&mut Vec<[f64; 2]>, &mut Vec<[usize; 4]>, &mut BTreeMap<String, Vec<[usize; 2]>>);
    let cases: [(Spoil, &str); 10] = [
        (
            |p, _, _| p[0][0] = -1.0,
            "node 1 is at r = -1e0 m, z = 0e0 m; expected x = radius > 0",
        ),
        (|p, _, _| p[4][1] = f64::NAN, "node 5 is at r = 2e0 m, z = NaN m"),
        (|p, _, _| p[3] = [1.9, 0.1], "element 1 is inverted"),
        (|p, _, _| p[3] = [2.0, 2.0], "element 1 is degenerate"),
        (
            |_, q, _| q[1][0] = 9,
            "quad 2 names point 9, but there are only 6 points",
        ),
        (
            |p, _, _| p.push([4.0, 0.0]),
            "node 7 is used by no surface element",
        ),
        (|_, q, _| q.clear(), "there are no quads"),
        (
            |_, _, g| drop(g.insert("worn".into(), vec![[1, 4]])),
            "element 1 of group \"worn\" is inside it",
        ),
        (
            |_, _, g| drop(g.insert("worn".into(), vec![[0, 4]])),
            "element 1 of group \"worn\" is no edge of it",
        ),
        (
            |_, _, g| drop(g.insert("worn".into(), vec![[0, 1], [1, 0]])),
            "group \"worn\" holds an edge twice",
        ),
    ];
    for (spoil, expected) in cases {
        let (mut points, mut quads, mut groups) = two_quads();
        spoil(&mut points, &mut quads, &mut groups);
        let error = Section::new(points, quads, &groups).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}\nlacks\n{expected}");
    }
}

/// If this failed, a 3-D file or one out of the plane would be flattened in silence.
#[test]
fn sections_must_be_flat_quads() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(data("outer_section.msh")).unwrap();
    let path = folder.path().join("s.msh");
    let error = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        read_section(&path, 1e-3).unwrap_err().to_string()
    };
    let found = error("\n34.3 -8 0\n0 2", "\n34.3 -8 0.5\n0 2");
    assert!(
        found.contains("node 1 has the third coordinate 5e-1; expected 0"),
        "{found}"
    );
    let found = error("\"ring\"", "\"steel\"");
    assert!(
        found.contains("no physical Surface \"ring\" with elements; physical Surfaces are \"steel\""),
        "{found}"
    );
    let found = read_section(data("box_hex8.msh"), 1.0).unwrap_err().to_string();
    assert!(found.contains("no physical Surface \"ring\""), "{found}");
}

/// If this failed, measures that make no ring would reach gmsh and come back as its internal error.
#[test]
fn measures_that_make_no_ring_are_named() {
    type Spoil = fn(&mut RingSection);
    let cases: [(RingSide, Spoil, &str); 12] = [
        (
            RingSide::Outer,
            |r| r.width = -16e-3,
            "width is -16 mm; expected a positive length",
        ),
        (
            RingSide::Outer,
            |r| r.groove_radius = f64::NAN,
            "groove_radius is NaN mm",
        ),
        (
            RingSide::Outer,
            |r| r.groove_offset = f64::INFINITY,
            "groove_offset is inf mm; expected a finite",
        ),
        (
            RingSide::Outer,
            |r| r.seat_diameter = 74e-3,
            "raceway_diameter is 74.037 mm; expected below the seat_diameter of 74 mm",
        ),
        (
            RingSide::Inner,
            |r| r.seat_diameter = 57e-3,
            "raceway_diameter is 56.01 mm; expected above the seat_diameter of 57 mm",
        ),
        (
            RingSide::Outer,
            |r| r.shoulder_diameters[0] = 64e-3,
            "shoulder_diameters[0] is 64 mm; expected between the groove centres' 64.537 mm",
        ),
        (
            RingSide::Inner,
            |r| r.shoulder_diameters[1] = 56e-3,
            "shoulder_diameters[1] is 56 mm; expected between the groove centres' 65.31 mm and the groove bottom's \
             56.01 mm",
        ),
        (
            RingSide::Outer,
            |r| r.width = 8e-3,
            "width is 8 mm; with the groove 0 mm off the middle it leaves no shoulder at -z",
        ),
        (
            RingSide::Outer,
            |r| r.groove_offset = 4e-3,
            "width is 16 mm; with the groove 4 mm off the middle it leaves no shoulder at +z",
        ),
        (
            RingSide::Outer,
            |r| r.groove_elements = 1,
            "groove_elements is 1; expected between 2 and 10000",
        ),
        (
            RingSide::Outer,
            |r| r.shoulder_elements[1] = 0,
            "shoulder_elements[1] is 0; expected between 1",
        ),
        (
            RingSide::Outer,
            |r| r.grading = 9.0,
            "grading is 9; expected a growth",
        ),
    ];
    for (side, spoil, expected) in cases {
        let mut ring = ring(side);
        spoil(&mut ring);
        let error = ring_geo(&ring).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}\nlacks\n{expected}");
        assert_eq!(ring_tet_geo(&ring, 2e-3).unwrap_err().to_string(), error);
    }
    let error = ring_tet_geo(&ring(RingSide::Outer), 0.0).unwrap_err().to_string();
    assert!(error.contains("size is 0 mm"), "{error}");
}

/// If this failed, a counterbored ring or one with an offset groove could not be drawn, or its numbers would be lost.
#[test]
fn geometry_files_carry_the_measures_in_millimetres() {
    let mut ring = ring(RingSide::Outer);
    ring.shoulder_diameters = [73e-3, 68.6e-3];
    ring.groove_offset = 0.5e-3;
    let text = ring_geo(&ring).unwrap();
    for expected in [
        "raceway_diameter = {74.037,",
        "shoulder_diameter_left = {73,",
        "groove_offset = {0.5,",
        // The low shoulder's half of the groove spans 27.0 of 91.8 degrees: two of eight elements.
        "groove_elements_left = {2,",
        "groove_elements_right = {6,",
        "Physical Curve(\"seat\", 2) = {5, 6, 7, 8};",
    ] {
        assert!(text.contains(expected), "{text}\nlacks {expected}");
    }
    assert!(
        !text.contains("MshFileVersion") && !text.contains("ElementOrder"),
        "they override the command line"
    );
    let text = ring_tet_geo(&crate::ring(RingSide::Inner), 1.5e-3).unwrap();
    assert!(
        text.contains("side = -1;") && text.contains("size = {1.5,") && text.contains("\"bore\""),
        "{text}"
    );
}

/// If this failed, the closed form used to judge volumes would itself be wrong: a ring whose groove is nearly flat
/// must tend to a tube, and the 7010C outer ring must have 17560.83 mm^3 (independent: Pappus by hand).
#[test]
fn the_closed_form_volume_is_right() {
    let outer = ring(RingSide::Outer).volume().unwrap();
    assert!((outer * 1e9 - 17560.83).abs() < 0.005, "{outer:e}");
    // Second way: midpoint rule over z with 20000 strips, error far below 1e-8.
    for side in [RingSide::Outer, RingSide::Inner] {
        let (r, g) = (ring(side), ring(side).geometry().unwrap());
        let sign = if side == RingSide::Outer { 1.0 } else { -1.0 };
        let n = 20_000;
        let h = r.width / n as f64;
        let area = |i: usize| {
            let z: f64 = -0.5 * r.width + (i as f64 + 0.5) * h;
            let groove = g.centre_radius + sign * (g.groove_radius.powi(2) - z * z).max(0.0).sqrt();
            let is_groove = z > g.groove_z[0] && z < g.groove_z[1];
            let inside = if is_groove {
                groove
            } else {
                0.5 * r.shoulder_diameters[0]
            };
            sign * std::f64::consts::PI * (0.25 * r.seat_diameter.powi(2) - inside * inside)
        };
        let sum: f64 = (0..n).map(|i| area(i) * h).sum();
        let relative = r.volume().unwrap() / sum - 1.0;
        assert!(relative.abs() < 1e-7, "{side:?}: {relative:e}");
    }
}
