//! Finds whether a ring's mesh is rotationally periodic: N equal sectors about the axis z, up to the numbering of
//! nodes.
//!
//! A mesh is periodic with N sectors when a turn by 2 pi / N takes every node to a node, every element to an element
//! (as a set of nodes) and every group of facets to itself. N divides the number of nodes at each (r, z), so the
//! divisors of the smallest such numbers are tried, the largest first. Every node then has a site (sector, section
//! node): a turn by one sector keeps the section node and adds one to the sector. Sector 0 holds the nodes from the
//! azimuth of node 0 to a sector's angle farther.
//!
//! Cost: n log n for sorting the nodes, then one search per node and element for each candidate that does not fail
//! earlier; memory of a few indices per node and element.

mod defect;
mod images;
mod locator;
mod missing;
mod reason;
mod strays;

use std::f64::consts::TAU;

use crate::mesh::Mesh;
use images::{element_images, facet_images, node_images};
use locator::Locator;

pub use defect::{NearlyPeriodic, find_nearly_periodic};
pub use reason::{NotNearlyPeriodic, NotPeriodic};

/// Usual tolerance of [`find_periodicity`], as a share of the ring's largest radius: well above the rounding of
/// coordinates with twelve digits, well below any element.
pub const PERIODIC_TOLERANCE: f64 = 1e-9;

/// Offsets of nodes within a sector are compared with 0 and 1/2 to this share of a sector.
const OFFSET_TOLERANCE: f64 = 1e-6;

/// The sectors of a rotationally periodic mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodicity {
    n_sectors: usize,
    nodes: Vec<usize>,
    sites: Vec<PeriodicSite>,
    elements: Vec<usize>,
    half_way: Option<Vec<bool>>,
    deviation: f64,
}

/// Place of a node in a periodic mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PeriodicSite {
    /// Sector, below [`Periodicity::n_sectors`].
    pub sector: usize,
    /// Node of the section, below [`Periodicity::n_section_nodes`].
    pub section_node: usize,
}

impl Periodicity {
    /// Largest number of equal sectors N.
    pub fn n_sectors(&self) -> usize {
        self.n_sectors
    }

    /// Nodes per sector.
    pub fn n_section_nodes(&self) -> usize {
        self.nodes.len() / self.n_sectors
    }

    /// Mesh node at every site, `[n_sectors][n_section_nodes]`, flat.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Site of every mesh node, `[n_nodes]`.
    pub fn sites(&self) -> &[PeriodicSite] {
        &self.sites
    }

    /// One element of every class of elements that turns take into each other, ascending,
    /// `[n_elements / n_sectors]`: those of lowest number. Together they are one sector of the ring.
    pub fn elements(&self) -> &[usize] {
        &self.elements
    }

    /// For each section node whether it lies half a sector beyond the plane of section node 0 (true) or in that plane
    /// (false), `[n_section_nodes]`; `None` when a node lies elsewhere. With it, the plane of node 0 may be a plane of
    /// mirror symmetry that takes every section node to itself.
    pub fn half_way(&self) -> Option<&[bool]> {
        self.half_way.as_deref()
    }

    /// Largest distance of a turned node from the node it meets, m.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// Section nodes of whole rings of nodes, ascending. The error is the first site that `nodes` lacks.
    pub fn section_nodes(&self, nodes: &[usize]) -> Result<Vec<usize>, PeriodicSite> {
        let mut named = vec![false; self.sites.len()];
        nodes.iter().for_each(|&node| named[node] = true);
        let mut section: Vec<usize> = nodes.iter().map(|&n| self.sites[n].section_node).collect();
        section.sort_unstable();
        section.dedup();
        let width = self.n_section_nodes();
        for sector in 0..self.n_sectors {
            for &section_node in &section {
                if !named[self.nodes[sector * width + section_node]] {
                    return Err(PeriodicSite { sector, section_node });
                }
            }
        }
        Ok(section)
    }
}

/// The sectors of a ring about the axis z, or the reason why there are none; nodes agree to `tolerance` times the
/// largest radius, see [`PERIODIC_TOLERANCE`].
pub fn find_periodicity(mesh: &Mesh, tolerance: f64) -> Result<Periodicity, NotPeriodic> {
    if mesh.n_elements() == 0 {
        return Err(NotPeriodic::Empty);
    }
    let radii: Vec<f64> = mesh.nodes.iter().map(|x| x[0].hypot(x[1])).collect();
    let tolerance = tolerance * radii.iter().copied().fold(0.0, f64::max);
    if let Some(node) = radii.iter().position(|&r| r.is_nan() || r <= tolerance) {
        return Err(NotPeriodic::OnAxis { node });
    }
    let counts: Vec<usize> = mesh
        .element(0)
        .iter()
        .map(|&node| companions(mesh, &radii, node, tolerance))
        .collect();
    let common = counts.iter().copied().fold(0, gcd);
    if common < 2 {
        return Err(first_difference(mesh, &counts, tolerance));
    }
    let locator = Locator::new(&mesh.nodes, tolerance);
    let mut first_reason = None;
    for n_sectors in (2..=common).rev().filter(|n| common % n == 0) {
        match sectors(mesh, &locator, n_sectors) {
            Ok(found) => return Ok(found),
            Err(reason) => first_reason = first_reason.or(Some(reason)),
        }
    }
    Err(first_reason.unwrap_or(NotPeriodic::Empty))
}

/// Why a ring is not periodic whose first element's nodes have numbers of companions without a common divisor.
fn first_difference(mesh: &Mesh, counts: &[usize], tolerance: f64) -> NotPeriodic {
    let most = counts.iter().copied().max().unwrap_or(1);
    if most > 1
        && let Err(reason) = sectors(mesh, &Locator::new(&mesh.nodes, tolerance), most)
    {
        return reason;
    }
    let place = counts.iter().position(|&count| count == most).unwrap_or(0);
    let node = mesh.element(0)[place];
    let [x, y, z] = mesh.nodes[node];
    let radius = x.hypot(y);
    NotPeriodic::Alone { node, radius, z }
}

/// Number of nodes at the radius and height of a node, itself included.
fn companions(mesh: &Mesh, radii: &[f64], node: usize, tolerance: f64) -> usize {
    let (r, z) = (radii[node], mesh.nodes[node][2]);
    let is_companion =
        |(x, radius): (&[f64; 3], &f64)| (radius - r).abs() <= tolerance && (x[2] - z).abs() <= tolerance;
    mesh.nodes
        .iter()
        .zip(radii)
        .filter(|&pair| is_companion(pair))
        .count()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The sectors, when there are `n_sectors` of them.
fn sectors(mesh: &Mesh, locator: &Locator, n_sectors: usize) -> Result<Periodicity, NotPeriodic> {
    let (images, deviation) = node_images(mesh, locator, n_sectors)?;
    let element_images = element_images(mesh, &images, n_sectors)?;
    facet_images(mesh, &images, n_sectors)?;
    let offsets = offsets(mesh, n_sectors);
    let first: Vec<usize> = (0..mesh.n_nodes())
        .filter(|&node| offsets[node].floor() == 0.0)
        .collect();
    let width = first.len();
    let mut nodes = Vec::with_capacity(mesh.n_nodes());
    nodes.extend_from_slice(&first);
    for site in 0..width * (n_sectors - 1) {
        nodes.push(images[nodes[site]]);
    }
    let sites = invert(&nodes, mesh.n_nodes(), width).map_err(|node| NotPeriodic::Node {
        n_sectors,
        node,
        position: mesh.nodes[node],
        tolerance: locator.tolerance(),
    })?;
    let half_way = first
        .iter()
        .map(|&node| half_offset(offsets[node]))
        .collect::<Option<Vec<bool>>>();
    Ok(Periodicity {
        n_sectors,
        nodes,
        sites,
        elements: representatives(&element_images),
        half_way,
        deviation,
    })
}

/// Azimuths of the nodes beyond node 0, in sectors, `[n_nodes]`; from -`OFFSET_TOLERANCE` up, moved up by as much, so
/// that the whole part is the sector.
fn offsets(mesh: &Mesh, n_sectors: usize) -> Vec<f64> {
    let [x0, y0, _] = mesh.nodes[0];
    let offset = |&[x, y, _]: &[f64; 3]| {
        let angle = (x0 * y - y0 * x).atan2(x0 * x + y0 * y);
        let turns = angle / TAU * n_sectors as f64 + OFFSET_TOLERANCE;
        if turns < 0.0 {
            turns + n_sectors as f64
        } else {
            turns
        }
    };
    mesh.nodes.iter().map(offset).collect()
}

/// Whether an offset (moved up by the tolerance) is half a sector, or none at all; `None` for any other.
fn half_offset(offset: f64) -> Option<bool> {
    let is_near = |place: f64| (offset - OFFSET_TOLERANCE - place).abs() <= OFFSET_TOLERANCE;
    if is_near(0.0) {
        Some(false)
    } else if is_near(0.5) {
        Some(true)
    } else {
        None
    }
}

/// Sites of all nodes; the error is a node that has none or that a second site takes.
fn invert(nodes: &[usize], n_nodes: usize, width: usize) -> Result<Vec<PeriodicSite>, usize> {
    let nowhere = PeriodicSite {
        sector: usize::MAX,
        section_node: usize::MAX,
    };
    let mut sites = vec![nowhere; n_nodes];
    for (i, &node) in nodes.iter().enumerate() {
        if sites[node] != nowhere {
            return Err(node);
        }
        sites[node] = PeriodicSite {
            sector: i / width,
            section_node: i % width,
        };
    }
    sites
        .iter()
        .position(|&site| site == nowhere)
        .map_or(Ok(sites), Err)
}

/// The lowest element of every cycle of turns.
fn representatives(images: &[usize]) -> Vec<usize> {
    let mut seen = vec![false; images.len()];
    let mut lowest = Vec::new();
    for start in 0..images.len() {
        if seen[start] {
            continue;
        }
        lowest.push(start);
        let mut e = start;
        while !seen[e] {
            seen[e] = true;
            e = images[e];
        }
    }
    lowest
}
