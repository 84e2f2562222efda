//! The section of a ring: quadrilaterals in the (r, z) half plane, with named boundary edges.
//!
//! Stored counter-clockwise with r to the right and z upwards. A section is valid by construction: quads convex,
//! one connected part, no two nodes at one place, every named edge on the boundary, all radii positive.

mod read;
mod revolve;

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::check::{check_coincident_nodes, check_connected};
use crate::error::MeshError;
use crate::msh::not_boundary;
use crate::origin::Origin;

pub use read::{read_section, read_section_with_origin};
pub use revolve::{Arc, Snap, revolve};

/// One edge of one quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SectionEdge {
    /// Quad index.
    pub quad: usize,
    /// Edge `i` joins the quad's nodes `i` and `i + 1` (modulo 4).
    pub edge: usize,
}

/// The section of a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    points: Vec<[f64; 2]>,
    quads: Vec<[usize; 4]>,
    groups: BTreeMap<String, Vec<SectionEdge>>,
}

impl Section {
    /// A section from points (r, z) in m, quads turning either way, and boundary edges as pairs of nodes.
    pub fn new(
        points: Vec<[f64; 2]>,
        quads: Vec<[usize; 4]>,
        groups: &BTreeMap<String, Vec<[usize; 2]>>,
    ) -> Result<Section, MeshError> {
        let origin = Origin {
            path: PathBuf::from("section"),
            unit: 1.0,
            node_tags: (1..=points.len() as u64).collect(),
            element_tags: (1..=quads.len() as u64).collect(),
        };
        let groups = groups.iter().map(|(name, edges)| {
            let tagged = edges.iter().enumerate().map(|(i, edge)| (i as u64 + 1, *edge));
            (name.clone(), tagged.collect())
        });
        Section::checked(points, quads, groups.collect(), &origin)
    }

    /// The same with tags for the messages; edges are (tag, nodes).
    pub(crate) fn checked(
        points: Vec<[f64; 2]>,
        mut quads: Vec<[usize; 4]>,
        groups: BTreeMap<String, Vec<(u64, [usize; 2])>>,
        origin: &Origin,
    ) -> Result<Section, MeshError> {
        check_points(&points, &quads, origin)?;
        for (quad, &tag) in quads.iter_mut().zip(&origin.element_tags) {
            turn_counter_clockwise(quad, &points, tag, origin)?;
        }
        let nodes: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let connectivity: Vec<usize> = quads.iter().flatten().copied().collect();
        check_coincident_nodes(&nodes, 4, &connectivity, origin)?;
        check_connected(points.len(), 4, &connectivity, origin)?;
        let groups = boundary_groups(&quads, groups, origin)?;
        Ok(Section {
            points,
            quads,
            groups,
        })
    }

    /// Points (r, z), m, `[n_points][2]`.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Point indices of the quads, counter-clockwise, `[n_quads][4]`.
    pub fn quads(&self) -> &[[usize; 4]] {
        &self.quads
    }

    /// Boundary edges by name, sorted by quad and edge.
    pub fn groups(&self) -> &BTreeMap<String, Vec<SectionEdge>> {
        &self.groups
    }

    /// The two point indices of an edge.
    pub fn edge_points(&self, edge: SectionEdge) -> [usize; 2] {
        let quad = self.quads[edge.quad];
        [quad[edge.edge], quad[(edge.edge + 1) % 4]]
    }

    /// Area, m^2.
    pub fn area(&self) -> f64 {
        let doubled = |quad: &[usize; 4]| -> f64 {
            let [a, b, c, d] = quad.map(|n| self.points[n]);
            (c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1])
        };
        0.5 * self.quads.iter().map(doubled).sum::<f64>()
    }
}

/// Points must be finite and off the axis, and quads must name them all.
fn check_points(points: &[[f64; 2]], quads: &[[usize; 4]], origin: &Origin) -> Result<(), MeshError> {
    let wrong = |problem: String| {
        Err(MeshError::Section {
            path: origin.path.clone(),
            problem,
        })
    };
    if quads.is_empty() {
        return wrong("there are no quads, expected at least one".to_string());
    }
    let mut used = vec![false; points.len()];
    for (quad, tag) in quads.iter().zip(&origin.element_tags) {
        for &n in quad {
            let Some(used) = used.get_mut(n) else {
                return wrong(format!(
                    "quad {tag} names point {n}, but there are only {} points",
                    points.len()
                ));
            };
            *used = true;
        }
    }
    for (i, p) in points.iter().enumerate() {
        let tag = origin.node_tags[i];
        if !(p[0].is_finite() && p[1].is_finite() && p[0] > 0.0) {
            return wrong(format!(
                "node {tag} is at r = {:e} m, z = {:e} m; expected x = radius > 0 and y = axial position of the ring",
                p[0], p[1]
            ));
        }
        if !used[i] {
            let (path, node) = (origin.path.clone(), tag);
            return Err(MeshError::OrphanNodes {
                path,
                node,
                kind: "surface",
                count: 1,
            });
        }
    }
    Ok(())
}

/// Reverses a clockwise quad; one that is not convex is an error.
fn turn_counter_clockwise(
    quad: &mut [usize; 4],
    points: &[[f64; 2]],
    tag: u64,
    origin: &Origin,
) -> Result<(), MeshError> {
    let corner = |quad: &[usize; 4], i: usize| {
        let [a, b, c] = [(i + 3) % 4, i, (i + 1) % 4].map(|j| points[quad[j]]);
        (c[0] - b[0]) * (a[1] - b[1]) - (a[0] - b[0]) * (c[1] - b[1])
    };
    if (0..4).map(|i| corner(quad, i)).sum::<f64>() < 0.0 {
        quad.swap(1, 3);
    }
    let areas: [f64; 4] = std::array::from_fn(|i| corner(quad, i));
    let mean = areas.iter().map(|a| a.abs()).sum::<f64>() / 4.0;
    let worst = areas.iter().copied().fold(f64::INFINITY, f64::min);
    if worst > 1e-6 * mean && mean.is_finite() {
        return Ok(());
    }
    let problem = if worst < -1e-6 * mean {
        "inverted"
    } else {
        "degenerate"
    };
    let (path, area) = (origin.path.clone(), origin.unit.powi(2));
    let (worst, mean) = (worst / area, mean / area);
    Err(MeshError::BadElement {
        path,
        element: tag,
        problem,
        worst,
        mean,
        count: 1,
    })
}

/// Finds the quad behind each named edge.
fn boundary_groups(
    quads: &[[usize; 4]],
    groups: BTreeMap<String, Vec<(u64, [usize; 2])>>,
    origin: &Origin,
) -> Result<BTreeMap<String, Vec<SectionEdge>>, MeshError> {
    let mut behind: BTreeMap<[usize; 2], Vec<SectionEdge>> = BTreeMap::new();
    for (quad, nodes) in quads.iter().enumerate() {
        for edge in 0..4 {
            let key = sorted([nodes[edge], nodes[(edge + 1) % 4]]);
            behind.entry(key).or_default().push(SectionEdge { quad, edge });
        }
    }
    let mut found = BTreeMap::new();
    for (name, edges) in groups {
        let mut of_group = Vec::with_capacity(edges.len());
        for (tag, nodes) in edges {
            let wrong = |problem| Err(not_boundary(&origin.path, &name, tag, problem));
            match behind.get(&sorted(nodes)).map(Vec::as_slice) {
                None => return wrong("no edge of it"),
                Some([edge]) => of_group.push(*edge),
                Some(_) => return wrong("inside it, between two elements"),
            }
        }
        of_group.sort_unstable();
        if of_group.windows(2).any(|pair| pair[0] == pair[1]) {
            let problem = format!(
                "group \"{name}\" holds an edge twice; expected each once, check the group in the .geo"
            );
            return Err(MeshError::Section {
                path: origin.path.clone(),
                problem,
            });
        }
        found.insert(name, of_group);
    }
    Ok(found)
}

/// The smaller index first.
pub(crate) fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
