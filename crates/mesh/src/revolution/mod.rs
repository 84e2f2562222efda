//! Rings whose shape is a body of revolution about the axis z though their mesh is not: the outline of the section.
//!
//! A half plane through the axis meets the surface of such a ring in one closed curve. Nodes of the surface near the
//! plane, put in order along that curve, lie on the outline: lines and arcs are fitted to them. Then every node of the
//! surface must lie on the outline, and every facet on one piece of it. Planes at other azimuths are tried until one
//! does; if none does, the outline that most nodes lie on tells where the ring is otherwise.
//!
//! Mid-side nodes count where they are off the middle of their edges, as Gmsh's of second order are, which lie on the
//! geometry. In the middle of their edges they say nothing of it.
//!
//! Cost: one sort of the faces, and one distance per node of the surface and piece of the outline for each plane that
//! is tried; most rings need one.

mod axis;
mod fit;
mod geo;
mod groups;
mod outline;
mod reason;
mod surface;

use std::f64::consts::TAU;

use crate::geometry::volume;
use crate::mesh::Mesh;
use outline::{area_and_volume, nearest};
use surface::MeshSurface;

pub use axis::OwnAxis;
pub use geo::{GrooveOfOutline, RevolvedOutline, SectionFineness, groove_of, outline_geo, revolve_outline};
pub use groups::group_outline;
pub use outline::{OutlineCurve, OutlinePiece};
pub use reason::{NotRevolved, OffOutline};

/// Usual tolerance of [`find_revolution`], as a share of the ring's largest radius: that of the checks of groups.
pub const REVOLVED_TOLERANCE: f64 = 1e-5;

/// Half planes that are tried.
const PLANES: usize = 12;
/// The first one's azimuth as a share of the angle between them: where a mesh of sectors has no nodes.
const FIRST: f64 = 0.37;

/// A body of revolution about the axis z.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolution {
    /// Outline of its section, counter-clockwise with r to the right and z upwards.
    pub outline: Vec<OutlinePiece>,
    /// Largest distance of a node of the surface from the outline, m.
    pub deviation: f64,
    /// Nodes of the surface that were compared.
    pub n_nodes: usize,
    /// Area of the section, m2.
    pub area: f64,
    /// Volume of the body of revolution, m3: that of the mesh up to its chords.
    pub volume: f64,
    /// Volume of the mesh, m3.
    pub mesh_volume: f64,
}

/// The section of a ring about the axis z, whose surface nodes all lie on it to `tolerance` in m, or the reason why
/// there is none.
pub fn find_revolution(mesh: &Mesh, tolerance: f64) -> Result<Revolution, NotRevolved> {
    let surface = MeshSurface::new(mesh);
    let off = match search(&surface, tolerance) {
        Ok((outline, deviation, n_nodes)) => {
            let [area, volume_of_outline] = area_and_volume(&outline);
            return Ok(Revolution {
                outline,
                deviation,
                n_nodes,
                area,
                volume: volume_of_outline,
                mesh_volume: volume(mesh),
            });
        }
        Err(off) => off,
    };
    let Some((axis, moved)) = axis::about_own_axis(mesh) else {
        return Err(off);
    };
    if axis.is_z(mesh, tolerance) {
        return Err(off);
    }
    match search(&MeshSurface::new(&moved), tolerance) {
        Ok(_) => Err(NotRevolved::OtherAxis(axis)),
        Err(_) => Err(off),
    }
}

/// Whether a mesh is a body of revolution about the axis z, by one half plane: [`find_revolution`] tells where it is
/// not.
pub fn is_revolved(mesh: &Mesh, tolerance: f64) -> bool {
    let surface = MeshSurface::new(mesh);
    if surface
        .nodes
        .iter()
        .any(|&node| surface.points[node].r <= tolerance)
    {
        return false;
    }
    let nodes = counted_nodes(&surface, tolerance);
    outline_at(&surface, &nodes, TAU * FIRST / PLANES as f64, tolerance)
        .is_ok_and(|outline| off_outline(&surface, &nodes, &outline, tolerance).is_ok())
}

/// An outline that all nodes lie on, their largest distance, and how many there are.
fn search(surface: &MeshSurface, tolerance: f64) -> Result<(Vec<OutlinePiece>, f64, usize), NotRevolved> {
    if let Some(&node) = surface
        .nodes
        .iter()
        .find(|&&node| surface.points[node].r <= tolerance)
    {
        return Err(NotRevolved::OnAxis { node });
    }
    let nodes = counted_nodes(surface, tolerance);
    let mut best: Option<OffOutline> = None;
    let mut curves = None;
    for plane in 0..PLANES {
        let azimuth = TAU * (plane as f64 + FIRST) / PLANES as f64;
        let outline = match outline_at(surface, &nodes, azimuth, tolerance) {
            Ok(outline) => outline,
            Err(n_curves) => {
                curves = curves.or(Some((azimuth, n_curves)));
                continue;
            }
        };
        match off_outline(surface, &nodes, &outline, tolerance) {
            Ok(deviation) => return Ok((outline, deviation, nodes.len())),
            Err(off) => {
                if best.as_ref().is_none_or(|best| off.n_off < best.n_off) {
                    best = Some(off);
                }
            }
        }
    }
    Err(match (best, curves) {
        (Some(off), _) => NotRevolved::Off(off),
        (None, Some((azimuth, n_curves))) => NotRevolved::Curves { azimuth, n_curves },
        (None, None) => NotRevolved::Curves {
            azimuth: 0.0,
            n_curves: 0,
        },
    })
}

/// Corners of the surface, and the mid-side nodes that are off the middle of their edges; all of these if one is.
fn counted_nodes(surface: &MeshSurface, tolerance: f64) -> Vec<usize> {
    let is_curved = |&[middle, a, b]: &[usize; 3]| {
        let [m, a, b] = [middle, a, b].map(|node| surface.points[node]);
        let x = |p: surface::Cylindrical| [p.r * p.azimuth.cos(), p.r * p.azimuth.sin(), p.z];
        let [m, a, b] = [m, a, b].map(x);
        let square: f64 = (0..3).map(|c| (m[c] - 0.5 * (a[c] + b[c])).powi(2)).sum();
        square.sqrt() > tolerance
    };
    let mut nodes = surface.nodes.clone();
    if surface.middles.iter().any(is_curved) {
        nodes.extend(surface.middles.iter().map(|middle| middle[0]));
        nodes.sort_unstable();
    }
    nodes
}

/// The outline by the nodes near a half plane, counter-clockwise, or the number of closed curves if it is not one.
fn outline_at(
    surface: &MeshSurface,
    nodes: &[usize],
    azimuth: f64,
    tolerance: f64,
) -> Result<Vec<OutlinePiece>, usize> {
    let curves = surface.cut(azimuth).ok_or(0_usize)?;
    let [curve] = curves.as_slice() else {
        return Err(curves.len());
    };
    let curve: Vec<OutlinePiece> = (0..curve.len())
        .map(|i| OutlinePiece {
            start: curve[i],
            end: curve[(i + 1) % curve.len()],
            curve: OutlineCurve::Line,
            groups: Vec::new(),
        })
        .filter(|piece| piece.length() > 0.0)
        .collect();
    let half = 0.5 * TAU / PLANES as f64;
    let is_near = |&&node: &&usize| surface.points[node].azimuth_from(azimuth).abs() <= half;
    let mut placed: Vec<(usize, f64, [f64; 2])> = nodes
        .iter()
        .filter(is_near)
        .map(|&node| {
            let place = surface.points[node].place();
            let (piece, share, _) = nearest(&curve, place);
            (piece, share, place)
        })
        .collect();
    placed.sort_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).expect("places are finite"));
    let points: Vec<[f64; 2]> = placed.iter().map(|p| p.2).collect();
    let mut outline = fit::pieces(&points, tolerance);
    if area_and_volume(&outline)[0] < 0.0 {
        outline = outline.iter().rev().map(reversed).collect();
    }
    if outline.is_empty() { Err(1) } else { Ok(outline) }
}

fn reversed(piece: &OutlinePiece) -> OutlinePiece {
    OutlinePiece {
        start: piece.end,
        end: piece.start,
        curve: match piece.curve {
            OutlineCurve::Line => OutlineCurve::Line,
            OutlineCurve::Arc { circle, sweep } => OutlineCurve::Arc {
                circle,
                sweep: -sweep,
            },
        },
        groups: piece.groups.clone(),
    }
}

/// Largest distance of a node from an outline, m, or what is off it.
fn off_outline(
    surface: &MeshSurface,
    nodes: &[usize],
    outline: &[OutlinePiece],
    tolerance: f64,
) -> Result<f64, OffOutline> {
    let mut deviation = 0.0_f64;
    // (distance, node) of what is off.
    let mut off: Vec<(f64, usize)> = Vec::new();
    // The piece that each node is nearest to.
    let mut pieces = vec![0; surface.points.len()];
    for &node in nodes {
        let (piece, _, distance) = nearest(outline, surface.points[node].place());
        pieces[node] = piece;
        deviation = deviation.max(distance);
        if distance > tolerance {
            off.push((distance, node));
        }
    }
    if off.is_empty() {
        let facets = surface.corners_of_facets();
        off.extend(facets.filter_map(|corners| across(surface, &pieces, corners, outline, tolerance)));
    }
    if off.is_empty() {
        return Ok(deviation);
    }
    Err(OffOutline::new(surface, &off, nodes.len(), tolerance))
}

/// Distance and node of a facet that lies on no piece of the outline though its corners do, such as one of a wall
/// across the section.
fn across(
    surface: &MeshSurface,
    pieces: &[usize],
    corners: &[u32],
    outline: &[OutlinePiece],
    tolerance: f64,
) -> Option<(f64, usize)> {
    let places = || corners.iter().map(|&node| surface.points[node as usize].place());
    let has_all = |piece: &OutlinePiece| places().all(|place| piece.nearest(place).1 <= 2.0 * tolerance);
    // A corner of the outline is on two pieces, and round-off decides which is nearest: a facet between two such
    // corners may lie on a piece that is nearest to neither, so that the others are tried too.
    let mut near = corners.iter().map(|&node| &outline[pieces[node as usize]]);
    if near.any(has_all) || outline.iter().any(has_all) {
        return None;
    }
    let sum = places().fold([0.0; 2], |sum, place| [sum[0] + place[0], sum[1] + place[1]]);
    let middle = sum.map(|c| c / corners.len() as f64);
    Some((nearest(outline, middle).2, corners[0] as usize))
}
