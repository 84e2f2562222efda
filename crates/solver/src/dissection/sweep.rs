//! The best plane of one direction, from the exact separator sizes of all planes.

use super::part::{CutSizes, Subdomain};

/// Price and sides of the elements at the cheapest cut between consecutive keys (`[n_elements]`, one per element).
/// `None` when every cut leaves a side without nodes. Time O(n_elements (log n_elements + nodes per element)).
pub(super) fn best_plane(part: &Subdomain, keys: &[f64]) -> Option<(f64, Vec<bool>)> {
    let n = part.n_elements();
    let mut sorted: Vec<usize> = (0..n).collect();
    sorted.sort_by(|&a, &b| keys[a].total_cmp(&keys[b]).then(a.cmp(&b)));
    let mut rank = vec![0; n];
    sorted.iter().enumerate().for_each(|(place, &e)| rank[e] = place);
    // A node is on the cut before place k when its first element comes before k and its last does not.
    let (mut begins, mut ends) = (vec![0_usize; n + 1], vec![0_usize; n + 1]);
    for node in 0..part.n_nodes() {
        let ranks = part.node_elements(node).iter().map(|&e| rank[e]);
        let (first, last) = ranks.fold((usize::MAX, 0), |(low, high), r| (low.min(r), high.max(r)));
        begins[first + 1] += 1;
        ends[last + 1] += 1;
    }
    let (mut begun, mut ended) = (0, 0);
    let mut best = (f64::INFINITY, 0);
    for cut in 1..n {
        begun += begins[cut];
        ended += ends[cut];
        let sizes = CutSizes {
            separator: begun - ended,
            sides: [ended, part.n_nodes() - begun],
        };
        let cost = sizes.cost();
        if cost < best.0 {
            best = (cost, cut);
        }
    }
    let (cost, cut) = best;
    cost.is_finite()
        .then(|| (cost, rank.iter().map(|&r| r >= cut).collect()))
}

/// Moves the jump of the azimuths (rad) from pi to the widest gap between them.
pub(super) fn unwrap_azimuth(azimuths: &mut [f64]) {
    let mut sorted = azimuths.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(&least), Some(&largest)) = (sorted.first(), sorted.last()) else {
        return;
    };
    let turn = std::f64::consts::TAU;
    let mut widest = (least + turn - largest, f64::NEG_INFINITY);
    for pair in sorted.windows(2) {
        if pair[1] - pair[0] > widest.0 {
            widest = (pair[1] - pair[0], pair[1]);
        }
    }
    azimuths
        .iter_mut()
        .filter(|azimuth| **azimuth < widest.1)
        .for_each(|azimuth| *azimuth += turn);
}
