//! From an outline to a ring of equal sectors: its groove, its geometry file for Gmsh, and the revolved mesh.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::outline::{OutlineCurve, OutlinePiece, nearest};
use super::surface::boundary;
use crate::element::ElementKind;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::ring::{RingSide, millimetre_digits, section_head};
use crate::section::{Arc, Snap, read_section, revolve};

/// Name of the group of the groove.
const RACEWAY: &str = "raceway";
/// Length unit of the files that Gmsh reads and writes, m.
const GMSH_UNIT: f64 = 1e-3;
/// Longest arc of one curve of Gmsh, rad: its arcs are less than half a circle.
const LONGEST_CURVE: f64 = 2.5;
/// What a group of an arc that is no group of the ring is called.
const ARC: &str = "raceway mesh: arc ";

/// The groove of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrooveOfOutline {
    /// Inner or outer ring.
    pub side: RingSide,
    /// The circle of the groove.
    pub arc: Arc,
    /// Its ends, (r, z), m, the lower one first.
    pub ends: [[f64; 2]; 2],
    /// Length along the groove, m.
    pub length: f64,
    /// Mean diameter of the bore or seat, m.
    pub held_diameter: f64,
    /// Axial positions of the ends of the ring, m.
    pub faces: [f64; 2],
}

impl GrooveOfOutline {
    /// Diameter at the groove bottom, m.
    pub fn raceway_diameter(&self) -> f64 {
        2.0 * (self.arc.centre_r + self.side.sign() * self.arc.radius)
    }
}

/// How finely a section and its ring are divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionFineness {
    /// hex8 or hex20.
    pub kind: ElementKind,
    /// Elements round the ring.
    pub sectors: usize,
    /// Elements across the groove.
    pub groove_elements: usize,
    /// Elements from raceway to bore or seat, at least.
    pub thickness_elements: usize,
    /// Growth of the element size away from the raceway, each against the one before; 1 is even.
    pub grading: f64,
}

/// The groove of an outline: its group `raceway`, which must be arcs of one circle to `tolerance` in m, and the group
/// `bore` or `seat`, which says which ring it is.
pub fn groove_of(
    outline: &[OutlinePiece],
    path: &Path,
    tolerance: f64,
) -> Result<GrooveOfOutline, MeshError> {
    let wrong = |problem: String| MeshError::Section {
        path: path.to_path_buf(),
        problem,
    };
    let of_group = |name: &str| -> Vec<&OutlinePiece> {
        outline
            .iter()
            .filter(|piece| piece.groups.iter().any(|g| g == name))
            .collect()
    };
    let raceway = of_group(RACEWAY);
    let sides = [RingSide::Inner, RingSide::Outer].map(|side| (side, of_group(side.seat_group())));
    let held: Vec<_> = sides.iter().filter(|(_, pieces)| !pieces.is_empty()).collect();
    let (false, [(side, held)]) = (raceway.is_empty(), held.as_slice()) else {
        return Err(wrong(
            "expected facet groups \"raceway\" and either \"bore\" (inner ring) or \"seat\" (outer ring); name the \
             surfaces so, as Physical Surface"
                .to_string(),
        ));
    };
    let arc = one_arc(&raceway, tolerance).map_err(wrong)?;
    let mut ends: Vec<[f64; 2]> = raceway
        .iter()
        .flat_map(|piece| [piece.start, piece.end])
        .collect();
    ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let points = || outline.iter().map(|piece| piece.start[1]);
    let held_length: f64 = held.iter().map(|piece| piece.length()).sum();
    let weighted = |piece: &&OutlinePiece| piece.length() * (piece.start[0] + piece.end[0]);
    Ok(GrooveOfOutline {
        side: *side,
        arc,
        ends: [ends[0], ends[ends.len() - 1]],
        length: raceway.iter().map(|piece| piece.length()).sum(),
        held_diameter: held.iter().map(weighted).sum::<f64>() / held_length,
        faces: [
            points().fold(f64::INFINITY, f64::min),
            points().fold(f64::NEG_INFINITY, f64::max),
        ],
    })
}

/// The circle of all pieces of a raceway, to a tolerance, m.
fn one_arc(raceway: &[&OutlinePiece], tolerance: f64) -> Result<Arc, String> {
    let mut arc: Option<Arc> = None;
    for piece in raceway {
        let OutlineCurve::Arc { circle, .. } = piece.curve else {
            return Err(format!(
                "group \"raceway\" is straight from {} to {}; expected arcs of one circle",
                place(piece.start),
                place(piece.end)
            ));
        };
        let first = *arc.get_or_insert(circle);
        let apart = (circle.centre_r - first.centre_r).hypot(circle.centre_z - first.centre_z);
        if apart + (circle.radius - first.radius).abs() > 10.0 * tolerance {
            return Err(format!(
                "group \"raceway\" has arcs of {:.4} mm about {} and of {:.4} mm about {}; expected arcs of one circle",
                1e3 * first.radius,
                place([first.centre_r, first.centre_z]),
                1e3 * circle.radius,
                place([circle.centre_r, circle.centre_z])
            ));
        }
    }
    Ok(arc.expect("a raceway has pieces"))
}

fn place([r, z]: [f64; 2]) -> String {
    format!("r = {:.4} mm, z = {:.4} mm", 1e3 * r, 1e3 * z)
}

/// The section of an outline for Gmsh: x = r, y = z, in mm, meshed with quads that grow away from the groove. Groups
/// are those of the outline; mesh it with [`crate::mesh_section_with_gmsh`], revolve it with [`revolve_outline`].
pub fn outline_geo(
    outline: &[OutlinePiece],
    groove: &GrooveOfOutline,
    fineness: &SectionFineness,
) -> Result<String, MeshError> {
    check(fineness)?;
    let mut text = section_head(groove.side, "of the outline of a mesh");
    let curves = curves_of(outline);
    let point = |text: &mut String, number: usize, [r, z]: [f64; 2]| {
        let [r, z] = [r, z].map(millimetre_digits);
        let _ = writeln!(text, "Point({number}) = {{{r}, {z}, 0}};");
    };
    for (i, (piece, _)) in curves.iter().enumerate() {
        point(&mut text, i + 1, piece.start);
    }
    let n = curves.len();
    for (i, (piece, _)) in curves.iter().enumerate() {
        let (number, next) = (i + 1, (i + 1) % n + 1);
        match piece.curve {
            OutlineCurve::Line => {
                let _ = writeln!(text, "Line({number}) = {{{number}, {next}}};");
            }
            OutlineCurve::Arc { circle, .. } => {
                point(&mut text, n + number, [circle.centre_r, circle.centre_z]);
                let _ = writeln!(text, "Circle({number}) = {{{number}, {}, {next}}};", n + number);
            }
        }
    }
    let all: Vec<String> = (1..=n).map(|number| number.to_string()).collect();
    let _ = writeln!(
        text,
        "Curve Loop(1) = {{{}}}; Plane Surface(1) = {{1}};",
        all.join(", ")
    );
    write_sizes(&mut text, &curves, groove, fineness);
    let _ = writeln!(text, "Physical Surface(\"ring\") = {{1}};");
    for (group, numbers) in groups_of(&curves) {
        let _ = writeln!(text, "Physical Curve(\"{group}\") = {{{}}};", numbers.join(", "));
    }
    Ok(text)
}

/// Element sizes: h = h_0 + (grading - 1) d at the distance d from the circle of the groove, at most the thickness over
/// its number of elements. Gmsh meshes with twice that size and then divides every element, so that only quads arise
/// whatever the outline. Numbers along the curves are given, their sum is even, or the coarse mesh needs a triangle.
fn write_sizes(
    text: &mut String,
    curves: &[(OutlinePiece, usize)],
    groove: &GrooveOfOutline,
    fineness: &SectionFineness,
) {
    let size = Size::new(groove, fineness);
    let mut numbers: Vec<usize> = curves
        .iter()
        .map(|(piece, _)| size.coarse_number(piece))
        .collect();
    if numbers.iter().sum::<usize>() % 2 == 1 {
        let others = (0..curves.len()).filter(|&i| !is_raceway(&curves[i].0));
        let longest = others.max_by(|&a, &b| curves[a].0.length().total_cmp(&curves[b].0.length()));
        longest.into_iter().for_each(|i| numbers[i] += 1);
    }
    for (i, n) in numbers.iter().enumerate() {
        let _ = writeln!(text, "Transfinite Curve{{{}}} = {n} + 1;", i + 1);
    }
    let arc = groove.arc;
    let [cr, cz, radius] = [arc.centre_r, arc.centre_z, arc.radius].map(millimetre_digits);
    let [first, most] = [2.0 * size.first, 2.0 * size.most].map(millimetre_digits);
    let growth = 2.0 * (fineness.grading - 1.0);
    let _ = write!(
        text,
        "Field[1] = MathEval;\n\
         Field[1].F = \"{first} + {growth} * abs(sqrt((x - ({cr}))^2 + (y - ({cz}))^2) - {radius})\";\n\
         Field[2] = MathEval; Field[2].F = \"{most}\";\n\
         Field[3] = Min; Field[3].FieldsList = {{1, 2}}; Background Field = 3;\n\
         Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.Algorithm = 6;\n\
         Mesh.RecombineAll = 1; Mesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1;\n"
    );
}

/// Element size over the section, m.
struct Size {
    groove: GrooveOfOutline,
    /// On the groove.
    first: f64,
    /// Growth per distance from the circle of the groove.
    growth: f64,
    /// Largest.
    most: f64,
}

impl Size {
    fn new(groove: &GrooveOfOutline, fineness: &SectionFineness) -> Size {
        let first = groove.length / fineness.groove_elements as f64;
        let thickness = 0.5 * (groove.raceway_diameter() - groove.held_diameter).abs();
        Size {
            groove: *groove,
            first,
            growth: fineness.grading - 1.0,
            most: (thickness / fineness.thickness_elements as f64).max(first),
        }
    }

    fn at(&self, [r, z]: [f64; 2]) -> f64 {
        let arc = self.groove.arc;
        let distance = ((r - arc.centre_r).hypot(z - arc.centre_z) - arc.radius).abs();
        (self.first + self.growth * distance).min(self.most)
    }

    /// Half of the elements along a curve.
    fn coarse_number(&self, piece: &OutlinePiece) -> usize {
        const POINTS: usize = 32;
        let elements = match is_raceway(piece) {
            true => piece.length() / self.first,
            false => {
                let shares = (0..POINTS).map(|i| (i as f64 + 0.5) / POINTS as f64);
                let per_length = shares.map(|share| 1.0 / self.at(piece.at(share))).sum::<f64>();
                per_length * piece.length() / POINTS as f64
            }
        };
        ((0.5 * elements).round() as usize).max(1)
    }
}

fn check(fineness: &SectionFineness) -> Result<(), MeshError> {
    let whole = [
        ("groove elements", fineness.groove_elements, 2, 1000),
        ("thickness elements", fineness.thickness_elements, 1, 1000),
        ("sectors", fineness.sectors, 3, 100_000),
    ];
    for (name, value, least, most) in whole {
        if !(least..=most).contains(&value) {
            return Err(MeshError::Measure {
                name,
                value: value.to_string(),
                expected: format!("expected {least} to {most}"),
            });
        }
    }
    if fineness.groove_elements % 2 == 1 {
        return Err(MeshError::Measure {
            name: "groove elements",
            value: fineness.groove_elements.to_string(),
            expected: "expected an even number: every element of a coarse section is divided".to_string(),
        });
    }
    if (1.0..=3.0).contains(&fineness.grading) {
        return Ok(());
    }
    Err(MeshError::Measure {
        name: "grading",
        value: fineness.grading.to_string(),
        expected: "expected 1 (even) to 3".to_string(),
    })
}

fn is_raceway(piece: &OutlinePiece) -> bool {
    piece.groups.iter().any(|group| group == RACEWAY)
}

/// Curves of Gmsh: pieces, long arcs in parts, each with the number of its piece.
fn curves_of(outline: &[OutlinePiece]) -> Vec<(OutlinePiece, usize)> {
    let parts = |(number, piece): (usize, &OutlinePiece)| {
        let n = match piece.curve {
            OutlineCurve::Line => 1,
            OutlineCurve::Arc { sweep, .. } => (sweep.abs() / LONGEST_CURVE).ceil() as usize,
        };
        let share = move |i: usize| i as f64 / n as f64;
        let piece = piece.clone();
        (0..n).map(move |i| (piece.part(share(i), share(i + 1)), number))
    };
    outline.iter().enumerate().flat_map(parts).collect()
}

/// Groups with the numbers of their curves; arcs that are no raceway have one each beside.
fn groups_of(curves: &[(OutlinePiece, usize)]) -> BTreeMap<String, Vec<String>> {
    let mut groups: BTreeMap<String, Vec<String>> = Default::default();
    for (i, (piece, number)) in curves.iter().enumerate() {
        let number_of_curve = (i + 1).to_string();
        for group in &piece.groups {
            groups
                .entry(group.clone())
                .or_default()
                .push(number_of_curve.clone());
        }
        if matches!(piece.curve, OutlineCurve::Arc { .. }) && !is_raceway(piece) {
            groups
                .entry(format!("{ARC}{number}"))
                .or_default()
                .push(number_of_curve);
        }
    }
    groups
}

/// A ring made of an outline.
#[derive(Clone, Debug)]
pub struct RevolvedOutline {
    /// Its mesh.
    pub mesh: Mesh,
    /// Largest distance of the edges of its section from the outline, m: the sagitta of the chords of arcs, or of the
    /// parabolas of hex20.
    pub section_distance: f64,
}

/// The ring of a section that [`crate::mesh_section_with_gmsh`] made; nodes of hex20 lie on its arcs.
pub fn revolve_outline(
    outline: &[OutlinePiece],
    groove: &GrooveOfOutline,
    fineness: &SectionFineness,
    section_path: &Path,
) -> Result<RevolvedOutline, MeshError> {
    let section = read_section(section_path, GMSH_UNIT)?;
    let mut snaps = vec![Snap {
        group: RACEWAY.to_string(),
        arc: groove.arc,
    }];
    if fineness.kind == ElementKind::Hex20 {
        let arcs = outline.iter().enumerate().filter(|(_, piece)| !is_raceway(piece));
        snaps.extend(arcs.filter_map(|(number, piece)| match piece.curve {
            OutlineCurve::Arc { circle, .. } => Some(Snap {
                group: format!("{ARC}{number}"),
                arc: circle,
            }),
            OutlineCurve::Line => None,
        }));
    }
    let mut mesh = revolve(&section, fineness.sectors, fineness.kind, &snaps)?;
    mesh.groups.retain(|name, _| !name.starts_with(ARC));
    Ok(RevolvedOutline {
        section_distance: section_distance(outline, &mesh),
        mesh,
    })
}

/// Largest distance from an outline of the edges that the half plane at azimuth 0, one between sectors, has of a
/// mesh's surface.
fn section_distance(outline: &[OutlinePiece], mesh: &Mesh) -> f64 {
    let n_corners = mesh.kind.facet_kind().n_corners();
    let in_plane = |node: usize| mesh.nodes[node][1] == 0.0 && mesh.nodes[node][0] > 0.0;
    let place = |node: usize| [mesh.nodes[node][0], mesh.nodes[node][2]];
    let mut worst = 0.0_f64;
    for facet in boundary(mesh, n_corners) {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        for i in 0..n_corners {
            let (a, b) = (nodes[i], nodes[(i + 1) % n_corners]);
            if !(in_plane(a) && in_plane(b)) {
                continue;
            }
            let [p, q] = [a, b].map(place);
            let point = match nodes.get(n_corners + i) {
                None => [0, 1].map(|c| 0.5 * (p[c] + q[c])),
                Some(&middle) => {
                    let m = place(middle);
                    [0, 1].map(|c| 0.375 * p[c] + 0.75 * m[c] - 0.125 * q[c])
                }
            };
            worst = worst.max(nearest(outline, point).2);
        }
    }
    worst
}
