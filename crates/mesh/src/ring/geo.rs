//! Geometry files for Gmsh: the section of a ring in quadrangles, and the whole ring in tetrahedra.
//!
//! Both are parametric (lengths in mm) and can be edited. They set neither the file version nor the element order,
//! because such lines in a .geo override the command line.

use std::fmt::Write;

use super::{RingSection, RingSide, millimetre_digits};
use crate::error::MeshError;

/// The 2-D section: x = r, y = z, four transfinite patches of quads; groups `ring`, `raceway`, `seat` or `bore`,
/// `shoulder`, `face`. Mesh it with [`crate::mesh_section_with_gmsh`], read it with [`crate::read_section`] in mm.
pub fn ring_geo(ring: &RingSection) -> Result<String, MeshError> {
    ring.validate()?;
    let [left, right] = groove_elements(ring)?;
    let mut text = head(
        ring,
        "gmsh -2 -order 1 -format msh41",
        "x = radius, y = axial position",
    );
    let [shoulder_left, shoulder_right] = ring.shoulder_elements;
    let counts = [
        (
            "groove_elements_left",
            left.to_string(),
            "elements on the groove below y = 0",
        ),
        (
            "groove_elements_right",
            right.to_string(),
            "elements on the groove above y = 0",
        ),
        (
            "shoulder_elements_left",
            shoulder_left.to_string(),
            "elements on the shoulder below",
        ),
        (
            "shoulder_elements_right",
            shoulder_right.to_string(),
            "elements on the shoulder above",
        ),
        (
            "thickness_elements",
            ring.thickness_elements.to_string(),
            "elements from raceway to seat",
        ),
        (
            "grading",
            ring.grading.to_string(),
            "growth of the elements towards the seat",
        ),
    ];
    text.push_str(&constants(&counts));
    text.push_str(DERIVED);
    text.push_str(SECTION);
    let seat = ring.side.seat_group();
    text.push_str(&format!("Physical Curve(\"{seat}\", 2) = {{5, 6, 7, 8}};\n"));
    Ok(text)
}

/// The whole ring about the z axis for quadratic tetrahedra of about `size` (m), nodes on the torus; groups as in
/// [`ring_geo`]. Mesh it with [`crate::mesh_tets_with_gmsh`], read it with [`crate::read_msh`] in mm. The mesh
/// numbers of the section are not used. Up to a `size` of 0.4 groove radii all meshes tried were valid; coarser ones
/// may hold inverted elements, which [`crate::read_msh`] refuses.
pub fn ring_tet_geo(ring: &RingSection, size: f64) -> Result<String, MeshError> {
    ring.validate()?;
    if !(size.is_finite() && size > 0.0 && size <= ring.seat_diameter) {
        let expected = "expected a positive length below the ring's diameter, such as 2 mm".to_string();
        let value = format!("{} mm", millimetre_digits(size));
        return Err(MeshError::Measure {
            name: "size",
            value,
            expected,
        });
    }
    let mut text = head(ring, "gmsh -3 -order 2 -format msh41", "axis = z");
    text.push_str(&constants(&[("size", millimetre_digits(size), "element size")]));
    text.push_str(DERIVED);
    text.push_str(SOLID);
    let seat = ring.side.seat_group();
    text.push_str(&format!("Physical Surface(\"{seat}\", 2) = {{o[7]}};\n"));
    Ok(text)
}

/// Divides the elements of the groove by the angles of its halves.
fn groove_elements(ring: &RingSection) -> Result<[usize; 2], MeshError> {
    let angles = ring.geometry()?.groove_angles;
    let n = ring.groove_elements;
    let share = n as f64 * angles[0] / (angles[0] + angles[1]);
    let left = (share.round() as usize).clamp(1, n - 1);
    Ok([left, n - left])
}

/// First lines of the section of a ring, by which it is known as one of this program.
pub(crate) fn section_head(side: RingSide, source: &str) -> String {
    let name = match side {
        RingSide::Inner => "inner",
        RingSide::Outer => "outer",
    };
    format!(
        "// {name} ring of a ball bearing; lengths in mm, x = radius, y = axial position, {source}\n\
         // mesh it with: gmsh -2 -order 1 -format msh41 FILE\n"
    )
}

/// Comment and measures.
fn head(ring: &RingSection, command: &str, axes: &str) -> String {
    let (name, side) = match ring.side {
        RingSide::Inner => ("inner", "-1"),
        RingSide::Outer => ("outer", "1"),
    };
    let mut text = format!(
        "// {name} ring of a ball bearing; lengths in mm, {axes}, groove centres at 0\n// mesh it with: {command} \
         FILE\n"
    );
    let _ = writeln!(
        text,
        "side = {side}; // 1: the body lies outside the groove, -1: inside"
    );
    let measures = [
        ("seat_diameter", ring.seat_diameter, "bore or outside diameter"),
        (
            "raceway_diameter",
            ring.raceway_diameter,
            "diameter at the groove bottom",
        ),
        ("groove_radius", ring.groove_radius, "groove radius"),
        (
            "shoulder_diameter_left",
            ring.shoulder_diameters[0],
            "diameter of the shoulder below the groove",
        ),
        (
            "shoulder_diameter_right",
            ring.shoulder_diameters[1],
            "diameter of the shoulder above the groove",
        ),
        ("width", ring.width, "width"),
        (
            "groove_offset",
            ring.groove_offset,
            "groove centres above the middle of the width",
        ),
    ];
    text.push_str(&constants(
        &measures.map(|(key, value, note)| (key, millimetre_digits(value), note)),
    ));
    text
}

fn constants(list: &[(&str, String, &str)]) -> String {
    let lines: Vec<String> = list
        .iter()
        .map(|(key, value, note)| format!("  {key} = {{{value}, Name \"{note}\"}}"))
        .collect();
    format!("DefineConstant[\n{}\n];\n", lines.join(",\n"))
}

/// Radii and axial positions, common to both files.
const DERIVED: &str = "\
seat = seat_diameter/2; bottom = raceway_diameter/2; centre = bottom - side*groove_radius;
left = shoulder_diameter_left/2; right = shoulder_diameter_right/2;
groove_left = -Sqrt(groove_radius^2 - (left - centre)^2);
groove_right = Sqrt(groove_radius^2 - (right - centre)^2);
face_left = -width/2 - groove_offset; face_right = width/2 - groove_offset;
";

/// Points 1-5 along the raceway side, 6-10 along the seat, 11 the groove centre.
const SECTION: &str = "\
Point(1) = {left, face_left, 0}; Point(2) = {left, groove_left, 0}; Point(3) = {bottom, 0, 0};
Point(4) = {right, groove_right, 0}; Point(5) = {right, face_right, 0};
Point(6) = {seat, face_left, 0}; Point(7) = {seat, groove_left, 0}; Point(8) = {seat, 0, 0};
Point(9) = {seat, groove_right, 0}; Point(10) = {seat, face_right, 0}; Point(11) = {centre, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 11, 3}; Circle(3) = {3, 11, 4}; Line(4) = {4, 5};
Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 9}; Line(8) = {9, 10};
Line(11) = {1, 6}; Line(12) = {2, 7}; Line(13) = {3, 8}; Line(14) = {4, 9}; Line(15) = {5, 10};
Curve Loop(1) = {1, 12, -5, -11}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 13, -6, -12}; Plane Surface(2) = {2};
Curve Loop(3) = {3, 14, -7, -13}; Plane Surface(3) = {3};
Curve Loop(4) = {4, 15, -8, -14}; Plane Surface(4) = {4};
Transfinite Curve{1, 5} = shoulder_elements_left + 1; Transfinite Curve{4, 8} = shoulder_elements_right + 1;
Transfinite Curve{2, 6} = groove_elements_left + 1; Transfinite Curve{3, 7} = groove_elements_right + 1;
Transfinite Curve{11, 12, 13, 14, 15} = thickness_elements + 1 Using Progression grading;
Transfinite Surface{1, 2, 3, 4}; Recombine Surface{1, 2, 3, 4};
Physical Surface(\"ring\", 1) = {1, 2, 3, 4};
Physical Curve(\"raceway\", 1) = {2, 3};
Physical Curve(\"shoulder\", 3) = {1, 4};
Physical Curve(\"face\", 4) = {11, 15};
";

/// The extrusion returns the start surface, the volume, then one surface per curve in the order of the loop. The
/// start surface is no part of the ring; left in, its nodes are saved though no element uses them. Twelve elements per
/// turn of curvature keep most elements of the groove from turning inside out when `size` is large.
const SOLID: &str = "\
SetFactory(\"OpenCASCADE\");
Point(1) = {left, 0, face_left}; Point(2) = {left, 0, groove_left}; Point(3) = {bottom, 0, 0};
Point(4) = {right, 0, groove_right}; Point(5) = {right, 0, face_right};
Point(6) = {seat, 0, face_right}; Point(7) = {seat, 0, face_left}; Point(8) = {centre, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 8, 3}; Circle(3) = {3, 8, 4}; Line(4) = {4, 5};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7}; Plane Surface(1) = {1};
o[] = Extrude{{0, 0, 1}, {0, 0, 0}, 2*Pi}{ Surface{1}; };
Delete{ Surface{1}; }
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size/4; Mesh.MeshSizeFromCurvature = 12;
Physical Volume(\"ring\", 1) = {o[1]};
Physical Surface(\"raceway\", 1) = {o[3], o[4]};
Physical Surface(\"shoulder\", 3) = {o[2], o[5]};
Physical Surface(\"face\", 4) = {o[6], o[8]};
";
