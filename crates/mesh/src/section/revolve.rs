//! Revolves a section about the axis z into equal sectors: a mesh that is exactly rotationally periodic.
//!
//! Numbering is regular. With m points, e edges (sorted by their end points) and q quads in the section:
//! - hex8: node = sector m + point;
//! - hex20: node = sector (2 m + e) + {point | m + edge | m + e + point}: the points and mid-edge nodes of the
//!   meridian plane at azimuth 2 pi sector / n, then the points half a sector farther, which lie on their arcs;
//! - element = sector q + quad, between the planes of its sector and the next.
//!
//! All planes are the same (r, z) values turned by (cos, sin), and these are computed in one octant and reflected,
//! so that radii and opposite sectors agree to the last bits. A mid-edge node lies in the middle of its straight
//! edge, or on the groove circle if its edge belongs to a snapped group.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_4;

use super::{Section, sorted};
use crate::check::worst_element;
use crate::element::ElementKind;
use crate::error::{MeshError, quoted_list};
use crate::mesh::{Facet, Mesh};

/// A circle in the (r, z) half plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Radial position of the centre, m.
    pub centre_r: f64,
    /// Axial position of the centre, m.
    pub centre_z: f64,
    /// Radius, m.
    pub radius: f64,
}

/// A group of edges and the circle its nodes are put on.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// Name of the edge group, such as `raceway`.
    pub group: String,
    /// The circle.
    pub arc: Arc,
}

/// Section points may be off the circle they are snapped to by this share of its radius: what a file with seven
/// digits has. More is another groove.
const SNAP: f64 = 1e-6;

/// Points of the section after snapping, and its edges with their mid-points.
struct Raised {
    points: Vec<[f64; 2]>,
    edges: BTreeMap<[usize; 2], usize>,
    mids: Vec<[f64; 2]>,
}

/// Revolves `section` into `n_sectors` equal sectors of `kind` (hex8 or hex20). Facet groups are the section's.
///
/// Nodes and elements are numbered sector by sector: with m points, e edges and q quads in the section, a sector has
/// m nodes (hex8) or 2 m + e (hex20) and q elements, and the next sector's numbers are larger by as many, modulo
/// their total. Cost: proportional to the nodes made.
pub fn revolve(
    section: &Section,
    n_sectors: usize,
    kind: ElementKind,
    snaps: &[Snap],
) -> Result<Mesh, MeshError> {
    if kind == ElementKind::Tet10 {
        return Err(wrong("tet10 elements cannot be revolved; expected hex8 or hex20"));
    }
    if n_sectors < 3 {
        return Err(wrong(format!(
            "{n_sectors} sectors do not make a ring; expected at least 3, such as 90"
        )));
    }
    let raised = raise(section, snaps)?;
    let mesh = Mesh {
        kind,
        nodes: turned_nodes(&raised, n_sectors, kind).into(),
        connectivity: turned_elements(section, &raised, n_sectors, kind),
        groups: turned_groups(section, n_sectors),
    };
    // All sectors are equal, so one speaks for all.
    if let Some(bad) = worst_element(&mesh, 0..section.quads().len()) {
        return Err(wrong(format!(
            "quad {} becomes an inverted or flat element (smallest det J {:.3e} of a mean {:.3e}); use more elements \
             across the groove or more sectors",
            bad.element + 1,
            bad.smallest,
            bad.mean
        )));
    }
    Ok(mesh)
}

fn wrong(problem: impl Into<String>) -> MeshError {
    MeshError::Revolve {
        problem: problem.into(),
    }
}

/// Snaps points and mid-points to their circles.
fn raise(section: &Section, snaps: &[Snap]) -> Result<Raised, MeshError> {
    let mut edges = BTreeMap::new();
    for quad in section.quads() {
        for i in 0..4 {
            edges.insert(sorted([quad[i], quad[(i + 1) % 4]]), 0);
        }
    }
    for (index, slot) in edges.values_mut().enumerate() {
        *slot = index;
    }
    let mut points = section.points().to_vec();
    let middle =
        |&[a, b]: &[usize; 2], p: &[[f64; 2]]| [0.5 * (p[a][0] + p[b][0]), 0.5 * (p[a][1] + p[b][1])];
    let mut on_circle: BTreeMap<usize, &Arc> = BTreeMap::new();
    for snap in snaps {
        for pair in snapped_edges(section, snap)? {
            for n in pair {
                points[n] = snap_point(points[n], snap, n)?;
            }
            on_circle.insert(edges[&pair], &snap.arc);
        }
    }
    let mut mids: Vec<[f64; 2]> = edges.keys().map(|pair| middle(pair, &points)).collect();
    for (edge, arc) in on_circle {
        mids[edge] = project(mids[edge], arc);
    }
    Ok(Raised { points, edges, mids })
}

/// Edges of the group of a snap, as sorted pairs of points.
fn snapped_edges(section: &Section, snap: &Snap) -> Result<Vec<[usize; 2]>, MeshError> {
    let edges = section
        .groups()
        .get(&snap.group)
        .filter(|edges| !edges.is_empty());
    let Some(edges) = edges else {
        let groups = quoted_list(section.groups().keys().map(String::as_str));
        return Err(wrong(format!(
            "it has no edges named \"{}\"; groups are {groups}",
            snap.group
        )));
    };
    Ok(edges
        .iter()
        .map(|&edge| sorted(section.edge_points(edge)))
        .collect())
}

fn snap_point(p: [f64; 2], snap: &Snap, index: usize) -> Result<[f64; 2], MeshError> {
    let Arc {
        centre_r,
        centre_z,
        radius,
    } = snap.arc;
    let deviation = (p[0] - centre_r).hypot(p[1] - centre_z) - radius;
    if deviation.abs() <= SNAP * radius {
        return Ok(project(p, &snap.arc));
    }
    Err(wrong(format!(
        "point {} of group \"{}\" (r = {:e} m, z = {:e} m) is {deviation:.3e} m off the circle of radius {radius:e} m \
         about r = {centre_r:e} m, z = {centre_z:e} m; expected at most {:.1e} m; compare the bearing's groove with \
         the section's",
        index + 1,
        snap.group,
        p[0],
        p[1],
        SNAP * radius
    )))
}

/// The point of the circle in the direction of `p` from its centre.
fn project(p: [f64; 2], arc: &Arc) -> [f64; 2] {
    let d = [p[0] - arc.centre_r, p[1] - arc.centre_z];
    let scale = arc.radius / d[0].hypot(d[1]);
    [arc.centre_r + scale * d[0], arc.centre_z + scale * d[1]]
}

/// (cos, sin) of k/n of a turn, exact at the multiples of a quarter turn and symmetric in all octants.
fn direction(k: usize, n: usize) -> [f64; 2] {
    let eighths = 8 * (k % n);
    let (octant, rest) = (eighths / n, eighths % n);
    let part = if octant % 2 == 0 { rest } else { n - rest };
    let (s, c) = (FRAC_PI_4 * part as f64 / n as f64).sin_cos();
    match octant {
        0 => [c, s],
        1 => [s, c],
        2 => [-s, c],
        3 => [-c, s],
        4 => [-c, -s],
        5 => [-s, -c],
        6 => [s, -c],
        _ => [c, -s],
    }
}

fn turned_nodes(raised: &Raised, n_sectors: usize, kind: ElementKind) -> Vec<[f64; 3]> {
    let mut nodes = Vec::with_capacity(n_sectors * nodes_per_sector(raised, kind));
    for sector in 0..n_sectors {
        let turn = |[c, s]: [f64; 2]| move |p: &[f64; 2]| [p[0] * c, p[0] * s, p[1]];
        let plane = direction(2 * sector, 2 * n_sectors);
        nodes.extend(raised.points.iter().map(turn(plane)));
        if kind == ElementKind::Hex20 {
            let half_way = direction(2 * sector + 1, 2 * n_sectors);
            nodes.extend(raised.mids.iter().map(turn(plane)));
            nodes.extend(raised.points.iter().map(turn(half_way)));
        }
    }
    nodes
}

fn nodes_per_sector(raised: &Raised, kind: ElementKind) -> usize {
    let m = raised.points.len();
    if kind == ElementKind::Hex20 {
        2 * m + raised.mids.len()
    } else {
        m
    }
}

fn turned_elements(section: &Section, raised: &Raised, n_sectors: usize, kind: ElementKind) -> Vec<usize> {
    let (m, n_edges) = (raised.points.len(), raised.mids.len());
    let per_sector = nodes_per_sector(raised, kind);
    let mut connectivity = Vec::with_capacity(n_sectors * section.quads().len() * kind.n_nodes());
    for sector in 0..n_sectors {
        let here = sector * per_sector;
        let there = (sector + 1) % n_sectors * per_sector;
        for &[a, b, c, d] in section.quads() {
            // Seen along +azimuth a counter-clockwise quad of (r, z) turns the other way: reverse it.
            let face = [a, d, c, b];
            connectivity.extend(face.map(|p| here + p));
            connectivity.extend(face.map(|p| there + p));
            if kind == ElementKind::Hex20 {
                let mids = [[a, d], [d, c], [c, b], [b, a]].map(|pair| m + raised.edges[&sorted(pair)]);
                connectivity.extend(mids.map(|e| here + e));
                connectivity.extend(mids.map(|e| there + e));
                connectivity.extend(face.map(|p| here + m + n_edges + p));
            }
        }
    }
    connectivity
}

/// Edge `i` of a quad sweeps face `5 - i` of its hexahedra.
fn turned_groups(section: &Section, n_sectors: usize) -> BTreeMap<String, Vec<Facet>> {
    let n_quads = section.quads().len();
    let turned = |sector: usize| {
        move |edge: &super::SectionEdge| Facet {
            element: sector * n_quads + edge.quad,
            face: 5 - edge.edge,
        }
    };
    let mut groups = BTreeMap::new();
    for (name, edges) in section.groups() {
        let mut facets: Vec<Facet> = (0..n_sectors).flat_map(|s| edges.iter().map(turned(s))).collect();
        facets.sort_unstable();
        groups.insert(name.clone(), facets);
    }
    groups
}
