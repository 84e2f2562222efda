//! Nodes that do not turn into nodes, and places where a node would have to be.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use super::locator::{Locator, distance};
use super::reason::NotNearlyPeriodic;
use crate::mesh::Mesh;

/// Most moved or absent nodes: beyond, the ring has no regular rest that would pay.
const MOST_NODES: usize = 2000;
/// Largest share of moved or absent nodes.
const LARGEST_SHARE: f64 = 0.25;

/// Nodes that most turns take to no node, ascending, and at least as many places that lack a node.
pub(super) fn strays(
    mesh: &Mesh,
    locator: &Locator,
    n_sectors: usize,
) -> Result<(Vec<usize>, Vec<[f64; 3]>), NotNearlyPeriodic> {
    let n = n_sectors;
    // Two neighbours and places all round: a defect is near few of them.
    let turns: BTreeSet<usize> = [1, n - 1, n / 5, 2 * n / 5, n / 2, 3 * n / 5, 4 * n / 5]
        .into_iter()
        .filter(|&turn| turn > 0)
        .collect();
    let turns: Vec<[f64; 2]> = turns
        .iter()
        .map(|&turn| (TAU * turn as f64 / n as f64).sin_cos().into())
        .collect();
    let limit = MOST_NODES.min((LARGEST_SHARE * mesh.n_nodes() as f64) as usize);
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
        if strays.len() > limit || vacancies.len() > limit {
            return Err(NotNearlyPeriodic::Large { n_sectors, limit });
        }
    }
    if strays.len() > vacancies.len() {
        return Err(NotNearlyPeriodic::MoreNodes {
            n_sectors,
            strays: strays.len(),
            first: strays[0],
            vacancies: vacancies.len(),
        });
    }
    Ok((strays, vacancies))
}
