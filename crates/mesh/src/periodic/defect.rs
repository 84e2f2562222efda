//! Rings that are periodic up to a defect: some nodes of a periodic ring stand elsewhere, or some of its elements are
//! missing.
//!
//! The ring without the defect, the *regular* ring, has N times the sector that most sectors share.
//!
//! A node is regular when most of a few turns by whole sectors take it to a node. Turns that take a regular node to
//! no node show a vacancy. Every node that is not regular belongs to the vacancy nearest to it; what vacancies are
//! left are *absent* nodes, which missing elements alone have. So a node may move by less than half of the distance
//! to its neighbours. An element that turns in most sectors into another one is missing in the others
//! ([`super::missing`]). The regular ring so found must be periodic in the strict sense of [`super`]; groups of
//! facets do not count. More elements than the regular ring has, such as a refined patch, are no defect in this
//! sense.
//!
//! The number of sectors is that of the gaps between the nodes on a circle, as most of a few elements have it.
//!
//! Cost: about 200 comparisons per node for the number of sectors, 7 searches for the turns; products of moved nodes
//! and vacancies; N searches for each missing element.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use super::images::node_images;
use super::locator::{Locator, distance};
use super::missing::missing_elements;
use super::reason::NotNearlyPeriodic;
use super::strays::strays;
use super::{Periodicity, gcd, sectors};
use crate::mesh::Mesh;

/// Elements that are asked for the number of sectors.
const SAMPLES: usize = 9;

/// A ring that would be periodic if some of its nodes stood elsewhere and it had some elements more. Nodes and
/// elements of the regular ring have the numbers of the mesh; absent nodes and missing elements follow.
#[derive(Clone, Debug, PartialEq)]
pub struct NearlyPeriodic {
    /// Sectors of the regular ring.
    pub periodicity: Periodicity,
    /// Nodes that stand elsewhere, ascending, and where they would be, m.
    pub moved: Vec<(usize, [f64; 3])>,
    /// Largest distance of a moved node from its place, m.
    pub largest_move: f64,
    /// Where the nodes would be that the mesh lacks, m.
    pub absent: Vec<[f64; 3]>,
    /// Nodes of the elements that the mesh lacks, `[n_missing][kind.n_nodes()]`, flat.
    pub missing: Vec<usize>,
}

impl NearlyPeriodic {
    /// The mesh without its defect, without groups.
    pub fn regular(&self, mesh: &Mesh) -> Mesh {
        regular(mesh, &self.moved, &self.absent, &self.missing)
    }

    /// Number of missing elements, whose numbers in the regular ring follow those of the mesh.
    pub fn n_missing(&self, mesh: &Mesh) -> usize {
        self.missing.len() / mesh.kind.n_nodes()
    }

    /// Elements of the mesh with a moved node, ascending.
    pub fn elements(&self, mesh: &Mesh) -> Vec<usize> {
        let is_moved = |node: &usize| self.moved.binary_search_by_key(node, |m| m.0).is_ok();
        let has_moved = |&e: &usize| mesh.element(e).iter().any(is_moved);
        (0..mesh.n_elements()).filter(has_moved).collect()
    }

    /// Number of sectors with a moved node.
    pub fn n_sectors_moved(&self) -> usize {
        self.count_sectors(self.moved.iter().map(|m| m.0))
    }

    /// Number of sectors that begin in a missing element.
    pub fn n_sectors_missing(&self, mesh: &Mesh) -> usize {
        let elements = self.missing.chunks_exact(mesh.kind.n_nodes());
        // The first of two neighbouring sectors, also across the last one.
        let n = self.periodicity.n_sectors();
        let first = |element: &[usize]| {
            let of = |node: &usize| self.periodicity.sites()[*node].sector;
            let is_first = |node: &&usize| {
                element
                    .iter()
                    .all(|other| (of(other) + n - of(node)) % n <= n / 2)
            };
            element.iter().find(is_first).copied()
        };
        self.count_sectors(elements.filter_map(first))
    }

    fn count_sectors(&self, nodes: impl Iterator<Item = usize>) -> usize {
        let sites = self.periodicity.sites();
        let sectors: BTreeSet<usize> = nodes.map(|node| sites[node].sector).collect();
        sectors.len()
    }
}

/// The mesh with moved nodes at their places, absent nodes and missing elements.
fn regular(mesh: &Mesh, moved: &[(usize, [f64; 3])], absent: &[[f64; 3]], missing: &[usize]) -> Mesh {
    let mut nodes = [&*mesh.nodes, absent].concat();
    moved.iter().for_each(|&(node, x)| nodes[node] = x);
    Mesh {
        kind: mesh.kind,
        nodes: nodes.into(),
        connectivity: [&mesh.connectivity[..], missing].concat(),
        groups: BTreeMap::new(),
    }
}

/// The ring as a periodic one with a defect, which is empty when only groups of facets differ; or why it is not one.
/// `tolerance` as for [`crate::find_periodicity`].
pub fn find_nearly_periodic(mesh: &Mesh, tolerance: f64) -> Result<NearlyPeriodic, NotNearlyPeriodic> {
    let radii: Vec<f64> = mesh.nodes.iter().map(|x| x[0].hypot(x[1])).collect();
    let tolerance = tolerance * radii.iter().copied().fold(0.0, f64::max);
    if mesh.n_elements() == 0 || radii.iter().any(|&r| r.is_nan() || r <= tolerance) {
        return Err(NotNearlyPeriodic::NoPattern);
    }
    let most = usual_sectors(mesh, &radii, tolerance).ok_or(NotNearlyPeriodic::NoPattern)?;
    let locator = Locator::new(&mesh.nodes, tolerance);
    let mut first_reason = NotNearlyPeriodic::NoPattern;
    for n in (2..=most).rev().filter(|n| most % n == 0) {
        match with_sectors(mesh, &locator, n) {
            Ok(found) => return Ok(found),
            Err(reason) if n == most => first_reason = reason,
            Err(_) => {}
        }
    }
    Err(first_reason)
}

/// The largest number of sectors that most of a few elements allow.
fn usual_sectors(mesh: &Mesh, radii: &[f64], tolerance: f64) -> Option<usize> {
    let mut votes: BTreeMap<usize, usize> = BTreeMap::new();
    let last = mesh.n_elements() - 1;
    for i in 0..SAMPLES {
        let nodes = mesh.element(i * last / (SAMPLES - 1));
        let counts = nodes.iter().map(|&n| gaps(mesh, radii, n, tolerance));
        *votes.entry(counts.fold(0, gcd)).or_default() += 1;
    }
    let (&n, _) = votes.iter().max_by_key(|&(n, votes)| (*votes, *n))?;
    (n >= 2).then_some(n)
}

/// How often the usual gap between neighbours on the circle of a node goes round it; 1 of a node that is alone.
fn gaps(mesh: &Mesh, radii: &[f64], node: usize, tolerance: f64) -> usize {
    let (r, z) = (radii[node], mesh.nodes[node][2]);
    let on_circle =
        |(x, radius): &(&[f64; 3], &f64)| (*radius - r).abs() <= tolerance && (x[2] - z).abs() <= tolerance;
    let circle = mesh.nodes.iter().zip(radii).filter(on_circle);
    let mut azimuths: Vec<f64> = circle.map(|(x, _)| x[1].atan2(x[0])).collect();
    azimuths.sort_by(f64::total_cmp);
    let mut gaps: Vec<f64> = azimuths.windows(2).map(|pair| pair[1] - pair[0]).collect();
    gaps.sort_by(f64::total_cmp);
    match gaps.get(gaps.len() / 2) {
        Some(&gap) if gap > 0.0 => (TAU / gap).round() as usize,
        _ => 1,
    }
}

/// The ring with `n` sectors and a defect.
fn with_sectors(mesh: &Mesh, locator: &Locator, n: usize) -> Result<NearlyPeriodic, NotNearlyPeriodic> {
    let (strays, vacancies) = strays(mesh, locator, n)?;
    let mut moved = Vec::new();
    let mut is_taken = vec![false; vacancies.len()];
    for &node in &strays {
        let x = &mesh.nodes[node];
        let distances = vacancies.iter().map(|v| distance(x, v));
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        match nearest {
            Some((place, distance)) if !std::mem::replace(&mut is_taken[place], true) => {
                moved.push((node, vacancies[place], distance));
            }
            _ => return Err(NotNearlyPeriodic::Node { n_sectors: n, node }),
        }
    }
    moved.retain(|&(_, _, distance)| distance > locator.tolerance());
    let largest_move = moved.iter().fold(0.0, |most, m| m.2.max(most));
    let moved: Vec<(usize, [f64; 3])> = moved.into_iter().map(|(node, x, _)| (node, x)).collect();
    let left = vacancies.iter().zip(&is_taken).filter(|(_, taken)| !**taken);
    let absent: Vec<[f64; 3]> = left.map(|(x, _)| *x).collect();
    let incomplete = regular(mesh, &moved, &absent, &[]);
    let locator = Locator::new(&incomplete.nodes, locator.tolerance());
    let (images, _) = node_images(&incomplete, &locator, n).map_err(NotNearlyPeriodic::Regular)?;
    let missing = missing_elements(&incomplete, &images, n)?;
    let whole = regular(mesh, &moved, &absent, &missing);
    if let Some(node) = without_element(mesh).or_else(|| without_element(&whole)) {
        return Err(NotNearlyPeriodic::Node { n_sectors: n, node });
    }
    Ok(NearlyPeriodic {
        periodicity: sectors(&whole, &locator, n).map_err(NotNearlyPeriodic::Regular)?,
        moved,
        largest_move,
        absent,
        missing,
    })
}

/// The first node that no element has.
fn without_element(mesh: &Mesh) -> Option<usize> {
    let mut has_element = vec![false; mesh.n_nodes()];
    mesh.connectivity
        .iter()
        .for_each(|&node| has_element[node] = true);
    has_element.iter().position(|has| !has)
}
