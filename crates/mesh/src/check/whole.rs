//! Is a group the whole of its surface? A bore that lacks half of its facets holds the ring by the other half.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt;

use crate::error::MeshError;
use crate::mesh::{Facet, Mesh};
use crate::origin::Origin;
use crate::torus::Torus;

/// A surface of revolution about the axis z.
pub trait Revolved {
    /// Distance of a point (m) from the surface, m, of any sign.
    fn distance(&self, x: [f64; 3]) -> f64;
}

impl Revolved for Torus {
    fn distance(&self, x: [f64; 3]) -> f64 {
        Torus::distance(self, x)
    }
}

/// A cylinder about the axis z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Its radius, m.
    pub radius: f64,
}

impl Revolved for Cylinder {
    fn distance(&self, x: [f64; 3]) -> f64 {
        x[0].hypot(x[1]) - self.radius
    }
}

/// A part of a cylinder about the axis z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderPart {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// Its ends along z, m.
    pub ends: [f64; 2],
}

impl Revolved for CylinderPart {
    fn distance(&self, x: [f64; 3]) -> f64 {
        let beyond = (self.ends[0] - x[2]).max(x[2] - self.ends[1]).max(0.0);
        self.cylinder.distance(x).hypot(beyond)
    }
}

impl CylinderPart {
    /// That on which a group lies.
    pub fn of_group(mesh: &Mesh, group: &str) -> CylinderPart {
        let z = mesh
            .group_nodes(group)
            .into_iter()
            .map(|node| mesh.nodes[node][2]);
        CylinderPart {
            cylinder: Cylinder::of_group(mesh, group),
            ends: z.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
                [low.min(z), high.max(z)]
            }),
        }
    }
}

impl Cylinder {
    /// That on which most corners of a group lie: the median of their radii.
    pub fn of_group(mesh: &Mesh, group: &str) -> Cylinder {
        let facets = mesh.group(group).iter();
        let corners =
            facets.flat_map(|&facet| mesh.facet_nodes(facet).take(mesh.kind.facet_kind().n_corners()));
        let mut radii: Vec<f64> = corners
            .map(|n| mesh.nodes[n][0].hypot(mesh.nodes[n][1]))
            .collect();
        radii.sort_unstable_by(f64::total_cmp);
        Cylinder {
            radius: radii.get(radii.len() / 2).copied().unwrap_or(0.0),
        }
    }
}

/// What a group has of its surface, when the mesh has more of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coverage {
    /// Share of the circle in which it has facets.
    pub circle: f64,
    /// Share of the area that the mesh has on the surface.
    pub area: f64,
    /// Facets that it lacks, ascending.
    pub missing: Vec<Facet>,
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [circle, area] = [self.circle, self.area].map(|share| 100.0 * share);
        write!(f, "{circle:.1} % of the circle and {area:.1} % of the area")
    }
}

/// What a group has of the faces that the mesh has on a surface, to `tolerance` in m; None if it has all.
pub fn coverage(mesh: &Mesh, group: &str, surface: &impl Revolved, tolerance: f64) -> Option<Coverage> {
    let is_on: Vec<bool> = mesh
        .nodes
        .iter()
        .map(|&x| surface.distance(x).abs() <= tolerance)
        .collect();
    let n_corners = mesh.kind.facet_kind().n_corners();
    let corners = |facet: Facet| mesh.facet_nodes(facet).take(n_corners);
    // Faces on the surface by their corners; one that two elements have lies inside.
    let mut faces: BTreeMap<Vec<usize>, Vec<Facet>> = BTreeMap::new();
    for element in 0..mesh.n_elements() {
        if mesh.element(element).iter().filter(|&&node| is_on[node]).count() < n_corners {
            continue;
        }
        for face in 0..mesh.kind.n_faces() {
            let facet = Facet { element, face };
            if corners(facet).all(|node| is_on[node]) {
                let mut key: Vec<usize> = corners(facet).collect();
                key.sort_unstable();
                faces.entry(key).or_default().push(facet);
            }
        }
    }
    let own = mesh.group(group);
    let outside = faces
        .values()
        .filter(|sharing| sharing.len() == 1)
        .map(|sharing| sharing[0]);
    let mut known: Vec<Facet> = own.to_vec();
    known.sort_unstable();
    let mut missing: Vec<Facet> = outside
        .filter(|facet| known.binary_search(facet).is_err())
        .collect();
    missing.sort_unstable();
    if missing.is_empty() {
        return None;
    }
    let area = |facets: &[Facet]| {
        facets
            .iter()
            .map(|&facet| area(mesh, corners(facet)))
            .sum::<f64>()
    };
    let covered = area(own);
    Some(Coverage {
        circle: circle(own.iter().map(|&facet| span(mesh, corners(facet)))),
        area: covered / (covered + area(&missing)),
        missing,
    })
}

/// Fails when a group is not the whole of its surface; `remedy` says what to do if that is meant.
pub fn check_whole(
    mesh: &Mesh,
    origin: &Origin,
    group: &str,
    coverage: Option<Coverage>,
    remedy: &str,
) -> Result<(), MeshError> {
    let Some(Coverage {
        circle,
        area,
        missing,
    }) = coverage
    else {
        return Ok(());
    };
    Err(MeshError::PartialGroup {
        path: origin.path.clone(),
        group: group.into(),
        circle: 100.0 * circle,
        area: 100.0 * area,
        missing: missing.len(),
        total: missing.len() + mesh.group(group).len(),
        element: origin.element_tags[missing[0].element],
        remedy: remedy.into(),
    })
}

/// Area of a facet by its corners, m^2: the triangles from the first one.
fn area(mesh: &Mesh, corners: impl Iterator<Item = usize>) -> f64 {
    let x: Vec<[f64; 3]> = corners.map(|node| mesh.nodes[node]).collect();
    let from_first = |i: usize| [0, 1, 2].map(|c| x[i][c] - x[0][c]);
    let triangle = |i: usize| {
        let (a, b) = (from_first(i), from_first(i + 1));
        let cross = [0, 1, 2].map(|c| a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]);
        0.5 * cross.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    (1..x.len().saturating_sub(1)).map(triangle).sum()
}

/// Azimuths between which the corners of a facet lie, rad: the first in [0, 2 pi), the second not below it.
fn span(mesh: &Mesh, corners: impl Iterator<Item = usize>) -> [f64; 2] {
    let azimuths: Vec<f64> = corners
        .map(|node| mesh.nodes[node][1].atan2(mesh.nodes[node][0]))
        .collect();
    let Some(&first) = azimuths.first() else {
        return [0.0; 2];
    };
    // A facet is less than half the circle wide.
    let from_first = azimuths
        .iter()
        .map(|a| (a - first + 1.5 * TAU).rem_euclid(TAU) - 0.5 * TAU);
    let (low, high) = from_first.fold((0.0f64, 0.0f64), |(low, high), a| (low.min(a), high.max(a)));
    let start = (first + low).rem_euclid(TAU);
    [start, start + high - low]
}

/// Share of the circle that intervals of azimuth cover.
fn circle(spans: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut spans: Vec<[f64; 2]> = spans.collect();
    // What reaches beyond a whole turn covers the beginning of the next.
    let beyond: Vec<[f64; 2]> = spans
        .iter()
        .filter(|s| s[1] > TAU)
        .map(|s| [0.0, s[1] - TAU])
        .collect();
    spans.extend(beyond);
    spans.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut covered, mut end) = (0.0, 0.0f64);
    for [low, high] in spans {
        let high = high.min(TAU);
        covered += (high - low.max(end)).max(0.0);
        end = end.max(high);
    }
    (covered / TAU).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a message would state another share of the circle: overlaps, gaps, and a facet over azimuth 0.
    #[test]
    fn shares_of_the_circle_are_those_of_their_union() {
        let quarter = 0.25 * TAU;
        for (spans, share) in [
            (vec![], 0.0),
            (vec![[0.0, quarter]], 0.25),
            (vec![[0.0, quarter], [0.5 * quarter, 2.0 * quarter]], 0.5),
            (vec![[3.5 * quarter, 4.5 * quarter]], 0.25),
            (vec![[0.0, 2.0 * quarter], [2.0 * quarter, 4.0 * quarter]], 1.0),
        ] {
            let found = circle(spans.clone().into_iter());
            assert!((found - share).abs() < 1e-15, "{spans:?}: {found}");
        }
    }
}
