//! Rings that are periodic up to a defect: the elements of a periodic ring, of which some nodes stand elsewhere.
//!
//! A node is *regular* when most of a few turns by whole sectors take it to a node. Turns that take a regular node to no node
//! show a *vacancy*; every node that is not regular belongs to the vacancy nearest to it. Moved there, the
//! mesh must be periodic in the strict sense of [`super`], elements and groups included. So a node may move by less than half of the
//! distance to its neighbours, and elements that are missing or cut otherwise are no defect in this sense.
//!
//! The number of sectors is that of the gaps between the nodes on a circle, as most of a few elements have it.
//!
//! Cost: about 200 comparisons per node for the number of sectors, 7 searches for the turns; products of moved nodes
//! and vacancies.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use super::locator::Locator;
use super::{Periodicity, gcd, sectors};
use crate::mesh::Mesh;

/// Most moved nodes: beyond, the ring has no regular rest that would pay.
const MOST_MOVED: usize = 2000;
/// Largest share of moved nodes.
const LARGEST_SHARE: f64 = 0.25;
/// Elements that are asked for the number of sectors.
const SAMPLES: usize = 9;

/// A ring that would be periodic if some of its nodes stood elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct NearlyPeriodic {
    /// Sectors of the ring without the defect; nodes and elements have the numbers of the mesh.
    pub periodicity: Periodicity,
    /// Nodes that stand elsewhere, ascending, and where they would be, m.
    pub moved: Vec<(usize, [f64; 3])>,
    /// Largest distance of a moved node from its place, m.
    pub largest_move: f64,
}

impl NearlyPeriodic {
    /// The mesh without its defect.
    pub fn regular(&self, mesh: &Mesh) -> Mesh {
        let mut regular = mesh.clone();
        self.moved.iter().for_each(|&(node, x)| regular.nodes[node] = x);
        regular
    }

    /// Elements with a moved node, ascending.
    pub fn elements(&self, mesh: &Mesh) -> Vec<usize> {
        let is_moved = |node: &usize| self.moved.binary_search_by_key(node, |m| m.0).is_ok();
        let has_moved = |&e: &usize| mesh.element(e).iter().any(is_moved);
        (0..mesh.n_elements()).filter(has_moved).collect()
    }

    /// Number of sectors with a moved node.
    pub fn n_sectors_moved(&self) -> usize {
        let sites = self.periodicity.sites();
        let sectors: BTreeSet<usize> = self.moved.iter().map(|&(node, _)| sites[node].sector).collect();
        sectors.len()
    }
}

/// The ring as a periodic one with a defect; None when it is not one, or has no defect. `tolerance` as for
/// [`crate::find_periodicity`].
pub fn find_nearly_periodic(mesh: &Mesh, tolerance: f64) -> Option<NearlyPeriodic> {
    let radii: Vec<f64> = mesh.nodes.iter().map(|x| x[0].hypot(x[1])).collect();
    let tolerance = tolerance * radii.iter().copied().fold(0.0, f64::max);
    if mesh.n_elements() == 0 || radii.iter().any(|&r| r.is_nan() || r <= tolerance) {
        return None;
    }
    let most = usual_sectors(mesh, &radii, tolerance)?;
    let locator = Locator::new(&mesh.nodes, tolerance);
    (2..=most)
        .rev()
        .filter(|n| most % n == 0)
        .find_map(|n| with_sectors(mesh, &locator, n))
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
fn with_sectors(mesh: &Mesh, locator: &Locator, n: usize) -> Option<NearlyPeriodic> {
    let (strays, vacancies) = strays(mesh, locator, n)?;
    let mut regular = mesh.clone();
    let mut is_taken = vec![false; vacancies.len()];
    for &node in &strays {
        let distances = vacancies.iter().map(|v| distance(&mesh.nodes[node], v));
        let (place, _) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        if std::mem::replace(&mut is_taken[place], true) {
            return None;
        }
        regular.nodes[node] = vacancies[place];
    }
    let periodicity = sectors(&regular, &Locator::new(&regular.nodes, locator.tolerance()), n).ok()?;
    let by = |&node: &usize| distance(&mesh.nodes[node], &regular.nodes[node]);
    let moved: Vec<usize> = strays
        .into_iter()
        .filter(|node| by(node) > locator.tolerance())
        .collect();
    let largest_move = moved.iter().map(by).fold(0.0, f64::max);
    (!moved.is_empty()).then(|| NearlyPeriodic {
        periodicity,
        moved: moved
            .into_iter()
            .map(|node| (node, regular.nodes[node]))
            .collect(),
        largest_move,
    })
}

/// Nodes that most turns take to no node, ascending, and as many places that lack a node.
fn strays(mesh: &Mesh, locator: &Locator, n: usize) -> Option<(Vec<usize>, Vec<[f64; 3]>)> {
    // Two neighbours and places all round: a defect is near few of them.
    let turns: BTreeSet<usize> = [1, n - 1, n / 5, 2 * n / 5, n / 2, 3 * n / 5, 4 * n / 5]
        .into_iter()
        .filter(|&turn| turn > 0)
        .collect();
    let turns: Vec<[f64; 2]> = turns
        .iter()
        .map(|&turn| (TAU * turn as f64 / n as f64).sin_cos().into())
        .collect();
    let most = MOST_MOVED.min((LARGEST_SHARE * mesh.n_nodes() as f64) as usize);
    let (mut strays, mut vacancies): (Vec<usize>, Vec<[f64; 3]>) = (Vec::new(), Vec::new());
    for (node, &[x, y, z]) in mesh.nodes.iter().enumerate() {
        let turned = turns
            .iter()
            .map(|[sin, cos]| [cos * x - sin * y, sin * x + cos * y, z]);
        let lost: Vec<[f64; 3]> = turned.filter(|x| locator.find(x).is_none()).collect();
        if 2 * lost.len() > turns.len() {
            strays.push(node);
        } else {
            for x in lost {
                if vacancies
                    .iter()
                    .all(|v| distance(v, &x) > 2.0 * locator.tolerance())
                {
                    vacancies.push(x);
                }
            }
        }
        if strays.len() > most || vacancies.len() > most {
            return None;
        }
    }
    (strays.len() == vacancies.len()).then_some((strays, vacancies))
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
