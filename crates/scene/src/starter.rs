//! A commented scene to start from, of a designation or of main dimensions: what `raceway init` writes.
//!
//! Bore, outside diameter and width are those of ISO 15 ([`crate::designations`]). What is inside is the maker's:
//! unless they are given, balls are estimated, and the scene says so where they stand:
//!
//! - ball diameter 0.3 (D - d), pitch diameter (d + D) / 2;
//! - balls of a deep groove bearing: as many as an eccentric inner ring lets in, 195 degrees of the pitch circle;
//! - balls of an angular contact bearing: 0.88 of what the pitch circle holds;
//! - clearance of a deep groove bearing: the middle of its group in ISO 5753-1, group N without a suffix.
//!
//! They are within a ball or two, and some per cent of the diameter, of the bearings in `scenes/`.

use std::f64::consts::PI;

use input::{ANGLE, FORCE, LENGTH, Quantity, ten_digits};

use crate::designations::{DESIGNATIONS, Listed, clearance_of, listed, material_of_balls};

/// What is known of the bearing.
#[derive(Clone, Debug, Default)]
pub struct StarterRequest {
    /// Such as `7208` or `6206`; suffixes C, AC and B say the contact angle.
    pub designation: Option<String>,
    /// Bore diameter.
    pub bore: Option<Quantity<LENGTH>>,
    /// Outside diameter.
    pub outside: Option<Quantity<LENGTH>>,
    /// Width.
    pub width: Option<Quantity<LENGTH>>,
    /// Number of balls.
    pub balls: Option<usize>,
    /// Ball diameter.
    pub ball_diameter: Option<Quantity<LENGTH>>,
    /// Diameter of the circle of ball centres.
    pub pitch_diameter: Option<Quantity<LENGTH>>,
    /// Free contact angle; a bearing without one is a deep groove bearing.
    pub contact_angle: Option<Quantity<ANGLE>>,
    /// Radial clearance, from extreme to extreme.
    pub radial_clearance: Option<Quantity<LENGTH>>,
}

/// Whether the bearing has a contact angle of its own.
enum BearingKind {
    Angular(f64),
    /// Radial clearance, mm.
    Deep(f64),
}

/// A number of the scene, and why it has this value.
struct SketchNumber {
    size: f64,
    note: &'static str,
}

impl SketchNumber {
    fn new(given: Option<f64>, otherwise: f64, note: &'static str) -> SketchNumber {
        match given {
            Some(size) => SketchNumber { size, note: "given" },
            None => SketchNumber {
                size: ten_digits(otherwise),
                note,
            },
        }
    }
}

/// Lengths in mm.
struct Sketch {
    name: String,
    bore: f64,
    outside: f64,
    width: f64,
    balls: SketchNumber,
    ball: SketchNumber,
    pitch: SketchNumber,
    kind: BearingKind,
    angle_note: String,
    /// Material of the balls, and a note on it.
    material: (&'static str, String),
}

/// Name of the file: that of the bearing, without what file names do not have.
pub fn file_name(wanted: &StarterRequest) -> String {
    let name = wanted.designation.as_deref().unwrap_or("bearing").to_lowercase();
    let kept = name.chars().map(|c| {
        if c.is_ascii_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    });
    kept.collect()
}

/// The text of a scene; meshes are named after `stem` and stand beside it. Fails with what is missing.
pub fn scene_text(wanted: &StarterRequest, stem: &str) -> Result<String, String> {
    let bearing = find(wanted)?;
    let loads = loads(&bearing);
    Ok([
        heading(&bearing),
        table_of_bearing(&bearing),
        tables_of_rings(&bearing, stem),
        loads,
    ]
    .join("\n"))
}

fn find(wanted: &StarterRequest) -> Result<Sketch, String> {
    let listed = wanted.designation.as_deref().map(listed).transpose()?;
    let mm = |length: &Option<Quantity<LENGTH>>| length.as_ref().map(|length| ten_digits(1e3 * length.si()));
    let main = |given: &Option<Quantity<LENGTH>>, of_list: Option<f64>, flag: &str| {
        mm(given)
            .or(of_list)
            .ok_or_else(|| format!("{flag} is missing; {DESIGNATIONS}"))
    };
    let bore = main(&wanted.bore, listed.as_ref().map(|l| l.bore), "--bore")?;
    let outside = main(&wanted.outside, listed.as_ref().map(|l| l.outside), "--outside")?;
    let width = main(&wanted.width, listed.as_ref().map(|l| l.width), "--width")?;
    if !(0.0 < bore && bore < outside && width > 0.0) {
        return Err(format!(
            "bore {bore} mm, outside diameter {outside} mm and width {width} mm are no bearing; expected lengths above \
             0 and a bore smaller than the outside diameter"
        ));
    }
    let (kind, angle_note) = kind_of(wanted, listed.as_ref(), bore)?;
    let ball = SketchNumber::new(
        mm(&wanted.ball_diameter),
        0.3 * (outside - bore),
        "ESTIMATE, 0.3 (D - d)",
    );
    let pitch = SketchNumber::new(
        mm(&wanted.pitch_diameter),
        0.5 * (bore + outside),
        "ESTIMATE, (d + D) / 2",
    );
    let half = (ball.size / pitch.size).clamp(0.0, 1.0).asin();
    let balls = match kind {
        BearingKind::Angular(_) => (0.88 * PI / half).round(),
        BearingKind::Deep(_) => 1.0 + (195f64.to_radians() / (2.0 * half)).floor(),
    };
    let size = || format!("{bore} x {outside} x {width} mm");
    Ok(Sketch {
        name: wanted.designation.clone().unwrap_or_else(size),
        bore,
        outside,
        width,
        balls: SketchNumber::new(wanted.balls.map(|n| n as f64), balls.max(3.0), "ESTIMATE"),
        ball,
        pitch,
        kind,
        angle_note,
        material: material_of_balls(listed.as_ref()),
    })
}

/// Whether a bearing has a contact angle or a clearance, and where that comes from; `bore` in mm.
fn kind_of(
    wanted: &StarterRequest,
    listed: Option<&Listed>,
    bore: f64,
) -> Result<(BearingKind, String), String> {
    let degrees = wanted
        .contact_angle
        .as_ref()
        .map(|angle| ten_digits(angle.si().to_degrees()));
    let clearance = wanted.radial_clearance.as_ref().map(|c| ten_digits(1e3 * c.si()));
    let of_list = listed.and_then(|l| l.degrees);
    Ok(match (degrees, clearance, listed) {
        (Some(degrees), _, _) => (BearingKind::Angular(degrees), "given".into()),
        (None, Some(clearance), _) => (BearingKind::Deep(clearance), "given".into()),
        (None, None, None) => return Err(format!("--contact-angle is missing; {DESIGNATIONS}")),
        (None, None, Some(listed)) => match of_list {
            Some(degrees) => (BearingKind::Angular(degrees), listed.angle_note.clone()),
            None => (
                BearingKind::Deep(clearance_of(bore, listed.group)),
                listed.group_note.clone(),
            ),
        },
    })
}

fn heading(bearing: &Sketch) -> String {
    let name = &bearing.name;
    format!(
        r#"# {name}, at rest under one load. Written by raceway init.
#
# Replace what is marked ESTIMATE by the numbers of a catalogue or a drawing, then:
#   raceway mesh FILE      builds the meshes of both rings (needs Gmsh)
#   raceway run FILE       solves; figures: raceway plot DIR, all on one page: raceway report DIR
# All keys: raceway help scene. A key that this file lacks has its default.

title = "{name}"
"#
    )
}

/// A key with its value, and a note where there is one.
fn line(key: &str, value: String, note: &str) -> String {
    let text = format!("{key} = {value}");
    match note {
        "" => format!("{text}\n"),
        note => format!("{text:<37}# {note}\n"),
    }
}

fn angle_or_clearance(b: &Sketch) -> String {
    match b.kind {
        BearingKind::Angular(degrees) => line(
            "contact_angle",
            format!("\"{degrees} deg\""),
            &format!("free of load: {}", b.angle_note),
        ),
        BearingKind::Deep(clearance) => {
            // With much clearance a ball right under the load carries alone, and the shaft is free across it.
            let half_a_pitch = format!("\"{} deg\"", ten_digits(180.0 / b.balls.size));
            let note = format!("from one extreme to the other: {}", b.angle_note);
            let clearance = format!("\"{} um\"", ten_digits(1e3 * clearance));
            let two = "two balls share a load along +x";
            line("radial_clearance", clearance, &note) + &line("first_ball_azimuth", half_a_pitch, two)
        }
    }
}

fn table_of_bearing(b: &Sketch) -> String {
    let mm = |size: f64| format!("\"{size} mm\"");
    [
        "[bearing]\n".to_string(),
        line("bore_diameter", mm(b.bore), "d"),
        line("outside_diameter", mm(b.outside), "D"),
        line("width", mm(b.width), "B"),
        line("balls", b.balls.size.to_string(), b.balls.note),
        line("ball_diameter", mm(b.ball.size), b.ball.note),
        line(
            "pitch_diameter",
            mm(b.pitch.size),
            &format!("circle of the ball centres: {}", b.pitch.note),
        ),
        angle_or_clearance(b),
        line(
            "inner_curvature_ratio",
            "0.52".into(),
            "groove radius over ball diameter; ISO 281 rates 0.52 inside",
        ),
        line("outer_curvature_ratio", "0.53".into(), "and 0.53 outside"),
        "\n[materials]\n".to_string(),
        line(
            "rings",
            "\"bearing steel\"".into(),
            "or \"M50\", \"440C\", or a table of numbers",
        ),
        line("balls", format!("\"{}\"", b.material.0), &b.material.1),
        "\n[contact]\n".to_string(),
        line("mode", "\"patch\"".into(), "exact groove on any mesh"),
    ]
    .concat()
}

fn tables_of_rings(b: &Sketch, stem: &str) -> String {
    let sectors = 6.0 * b.balls.size;
    let ring = |name: &str, on: &str, held: &str| {
        let mesh = format!("mesh = \"{stem}_{name}.msh\"");
        let table = format!("[{name}]");
        let section = format!("[{name}.section]");
        let sectors = format!("sectors = {sectors}");
        format!(
            r#"{table:<37}# the ring {on}, a finite-element body
{mesh:<37}# raceway mesh builds it from the section below
mesh_unit = "mm"
support = "clamped"                  # a stiff {held} holds every node; "mean_motion": only the mean

{section:<37}# shoulders: by rule, or shoulder_diameters = ["... mm", "... mm"]
element = "hex8"
{sectors:<37}# elements round the ring, a multiple of the balls
groove_elements = 12                 # across the groove
thickness_elements = 3
shoulder_elements = 2
grading = 1.2                        # finer towards the groove
"#
        )
    };
    [
        ring("inner", "on the shaft", "shaft"),
        ring("outer", "in the housing", "housing"),
    ]
    .join("\n")
}

/// Shaft and load: thrust on an angular contact bearing, a radial force on a deep groove bearing.
fn loads(b: &Sketch) -> String {
    let size = b.balls.size * b.ball.size * b.ball.size;
    let value = |factor: f64| {
        let digits: f64 = format!("{:.0e}", factor * size).parse().unwrap_or(1000.0);
        format!("value = \"{}\"", Quantity::<FORCE>::from_si(digits))
    };
    let (z, note, load) = match b.kind {
        BearingKind::Angular(_) => (
            "z = \"free\"".to_string(),
            "the axial force sets it; + is the direction of preload",
            format!(
                r#"[effects.axial_force]
{:<37}# EXAMPLE: put in your load

# [effects.radial_force]
# value = "1 kN"
# direction = "0 deg"
"#,
                value(1.5)
            ),
        ),
        BearingKind::Deep(clearance) => {
            let distance = 0.05 * b.ball.size;
            let cos = 1.0 - clearance.max(0.0) / (2.0 * distance);
            let play = 1e3 * distance * (1.0 - cos * cos).max(0.0).sqrt();
            (
                format!("z = \"{} um\"", (-play * 1e3).round() / 1e3 + 0.0),
                "grooves opposite each other: no thrust; A sin a0 from zero",
                format!(
                    r#"[effects.radial_force]
{:<37}# EXAMPLE: put in your load
direction = "0 deg"                  # azimuth, from +x towards +y
"#,
                    value(2.0)
                ),
            )
        }
    };
    format!(
        r#"[shaft]                              # motions from the state where all balls just touch both raceways
x = "free"                           # "free", "locked" or a value
y = "free"
{z:<37}# {note}
tilt_x = "locked"                    # a stiff shaft in two bearings; "free": it may tilt
tilt_y = "locked"
load_point = "0 mm"

{load}
[stress]
near_field = true                    # stress under the balls is that of the Hertz ellipses

[static]                             # one equilibrium
"#
    )
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::tables::{MeshFiles, Scene};

    fn named(designation: &str) -> StarterRequest {
        StarterRequest {
            designation: Some(designation.into()),
            ..StarterRequest::default()
        }
    }

    fn read(wanted: &StarterRequest) -> Scene {
        let text = scene_text(wanted, "test").unwrap();
        Scene::parse(&text, Path::new("test.toml"), &[], MeshFiles::MayBeMissing)
            .unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    /// Wrong: a scene of some bearing would be refused, or its balls would overlap.
    #[test]
    fn every_bearing_of_the_list_gives_a_scene() {
        for series in ["60", "62", "63", "70", "72", "73"] {
            for code in 0..=20 {
                for suffix in if series.starts_with('7') {
                    &["", "C", "AC", "B"][..]
                } else {
                    &["", "-2RS"]
                } {
                    let scene = read(&named(&format!("{series}{code:02}{suffix}")));
                    assert!(
                        scene.bearing.balls >= 6 && scene.bearing.balls <= 25,
                        "{series}{code:02}"
                    );
                    assert!(scene.inner.section.is_some() && scene.outer.section.is_some());
                }
            }
        }
    }

    /// Wrong: dimensions would not be those of catalogues. From the catalogues of the makers.
    #[test]
    fn main_dimensions_are_those_of_catalogues() {
        let known = [
            ("6206", [30., 62., 16.]),
            ("7208", [40., 80., 18.]),
            ("7010C", [50., 80., 16.]),
            ("6308", [40., 90., 23.]),
            ("6000", [10., 26., 8.]),
            ("7320B", [100., 215., 47.]),
            ("6220", [100., 180., 34.]),
        ];
        for (designation, dimensions) in known {
            let b = read(&named(designation)).bearing;
            let found = [b.bore_diameter, b.outside_diameter, b.width].map(|length| ten_digits(1e3 * length));
            assert_eq!(found, dimensions, "{designation}");
        }
    }

    /// Wrong: estimates would be far from real bearings: 9 balls of 9.525 mm (6206), 14 of 11.9 mm (7208), 18 of 9 mm
    /// (7010C), 14 of 8.731 mm (6010), 8 of 15.081 mm (6308).
    #[test]
    fn estimates_are_near_real_bearings() {
        let real = [
            ("6206", 9, 9.525),
            ("7208", 14, 11.9),
            ("7010C", 18, 9.0),
            ("6010", 14, 8.731),
            ("6308", 8, 15.081),
        ];
        for (designation, balls, diameter) in real {
            let b = read(&named(designation)).bearing;
            assert!(b.balls.abs_diff(balls) <= 2, "{designation}: {} balls", b.balls);
            assert!(
                (1e3 * b.ball_diameter / diameter - 1.0).abs() < 0.05,
                "{designation}: {}",
                b.ball_diameter
            );
        }
        let text = scene_text(&named("7208"), "test").unwrap();
        assert_eq!(text.matches("ESTIMATE").count(), 4, "{text}");
    }

    /// Wrong: given numbers would be called estimates, or suffixes be read as other angles.
    #[test]
    fn given_numbers_are_used_as_they_are() {
        let wanted = StarterRequest {
            balls: Some(15),
            ball_diameter: Some("11.906 mm".parse().unwrap()),
            pitch_diameter: Some("60 mm".parse().unwrap()),
            ..named("7208AC")
        };
        let scene = read(&wanted);
        assert_eq!(
            (scene.bearing.balls, scene.bearing.ball_diameter),
            (15, 11.906e-3)
        );
        assert!((scene.bearing.free_contact_angle().to_degrees() - 25.0).abs() < 1e-6);
        let text = scene_text(&wanted, "test").unwrap();
        assert_eq!(
            text.matches("ESTIMATE").count(),
            1,
            "only the sentence of the heading\n{text}"
        );
    }

    /// Wrong: a deep groove bearing would be pressed against one side by the place of its shaft.
    #[test]
    fn the_grooves_of_a_deep_groove_bearing_stand_opposite_each_other() {
        let scene = read(&named("6206"));
        let geometry = crate::build::geometry(&scene);
        let crate::tables::ShaftMotion::Prescribed(z) = scene.shaft.z else {
            panic!("{:?}", scene.shaft.z)
        };
        assert!((z + geometry.axial_offset()).abs() < 1e-9, "{z}");
    }

    /// Wrong: a user without a listed bearing would not learn what to give.
    #[test]
    fn what_is_missing_is_named() {
        let message = |wanted: &StarterRequest| scene_text(wanted, "test").unwrap_err();
        assert_eq!(
            message(&named("NU206")),
            format!("\"NU206\" is no bearing that is known here; {DESIGNATIONS}")
        );
        assert_eq!(
            message(&named("6225")),
            format!("\"6225\" is no bearing that is known here; {DESIGNATIONS}")
        );
        assert_eq!(
            message(&StarterRequest::default()),
            format!("--bore is missing; {DESIGNATIONS}")
        );
        let lengths = StarterRequest {
            bore: Some("25 mm".parse().unwrap()),
            outside: Some("52 mm".parse().unwrap()),
            width: Some("15 mm".parse().unwrap()),
            ..StarterRequest::default()
        };
        assert_eq!(
            message(&lengths),
            format!("--contact-angle is missing; {DESIGNATIONS}")
        );
        let wrong = StarterRequest {
            bore: Some("62 mm".parse().unwrap()),
            ..named("6206")
        };
        assert!(
            message(&wrong).starts_with("bore 62 mm, outside diameter 62 mm and width 16 mm are no bearing")
        );
    }
}
