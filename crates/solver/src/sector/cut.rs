//! Where a ring is cut into sectors: near equal shares of the work, through as few nodes as possible.
//!
//! Elements are sorted by the azimuth of their centroids; a sector is a run of them. A run of layers with m nodes in
//! a cross-section has O(m^2) entries of the factor per layer, that is O(m) per element: an element's work is taken
//! as the number of nodes across the ring where it stands. Where layers are alike these are equal numbers of
//! elements. Each cut is sought within a quarter of a share around its place for equal work, so that a layered mesh
//! is cut between layers whatever their number. Time O(n_elements log n_elements).

/// Sector of each element, `[n_elements]`, 0 to `n_sectors - 1` round the ring. Other arguments as
/// [`crate::angular_dissection`]; `n_sectors` is at most the number of elements.
pub(super) fn sectors_of_elements(
    points: &[[f64; 3]],
    elements: &[usize],
    nodes_per_element: usize,
    n_sectors: usize,
) -> Vec<usize> {
    let (sorted, azimuths) = by_azimuth(points, elements, nodes_per_element);
    let mut sector = vec![0; sorted.len()];
    if n_sectors == 1 {
        return sector;
    }
    let crossing = nodes_across(points.len(), elements, nodes_per_element, &sorted);
    let cuts = cuts(&crossing, &work(&crossing, &azimuths), n_sectors);
    // What lies before the first cut belongs to the last sector: the ring is closed.
    let mut current = n_sectors - 1;
    let mut next = 0;
    for (position, &e) in sorted.iter().enumerate() {
        if next < cuts.len() && cuts[next] == position {
            current = next;
            next += 1;
        }
        sector[e] = current;
    }
    sector
}

/// Elements by the azimuth of their centroids, and those azimuths, ascending.
fn by_azimuth(points: &[[f64; 3]], elements: &[usize], nodes_per_element: usize) -> (Vec<usize>, Vec<f64>) {
    let azimuth: Vec<f64> = elements
        .chunks_exact(nodes_per_element)
        .map(|nodes| {
            let sum = |c: usize| nodes.iter().map(|&n| points[n][c]).sum::<f64>();
            sum(1).atan2(sum(0))
        })
        .collect();
    let mut sorted: Vec<usize> = (0..azimuth.len()).collect();
    sorted.sort_by(|&a, &b| azimuth[a].total_cmp(&azimuth[b]).then(a.cmp(&b)));
    let azimuths = sorted.iter().map(|&e| azimuth[e]).collect();
    (sorted, azimuths)
}

/// Azimuths nearer than this, rad, are the same but for round-off.
const SAME_AZIMUTH: f64 = 1e-9;

/// Work of each element by position, `[n_elements]`: the number of nodes across the ring in front of all elements of
/// its azimuth, whose order among themselves is a matter of round-off.
fn work(crossing: &[usize], azimuths: &[f64]) -> Vec<usize> {
    let n = crossing.len();
    let begins = |&p: &usize| {
        let before = match p {
            0 => azimuths[n - 1] - std::f64::consts::TAU,
            p => azimuths[p - 1],
        };
        azimuths[p] - before > SAME_AZIMUTH
    };
    let first = (0..n).find(begins).unwrap_or(0);
    let (mut work, mut across) = (vec![0; n], 1);
    for p in (first..n).chain(0..first) {
        if begins(&p) {
            across = crossing[p].max(1);
        }
        work[p] = across;
    }
    work
}

/// Number of nodes with elements on both sides of a cut before position p, `[n_elements]`. Round the ring a node's
/// elements lie in the arc that is left without the widest gap between them.
fn nodes_across(
    n_nodes: usize,
    elements: &[usize],
    nodes_per_element: usize,
    sorted: &[usize],
) -> Vec<usize> {
    let n = sorted.len();
    let mut positions = vec![Vec::new(); n_nodes];
    for (position, &e) in sorted.iter().enumerate() {
        for &node in &elements[nodes_per_element * e..nodes_per_element * (e + 1)] {
            positions[node].push(position);
        }
    }
    // Number of arcs that begin to cross minus those that end, at each position.
    let mut change = vec![0_isize; n + 1];
    let mut add = |from: usize, to: usize| {
        if from < to {
            change[from] += 1;
            change[to] -= 1;
        }
    };
    for list in positions.iter().filter(|list| list.len() > 1) {
        let (first, last) = (list[0], list[list.len() - 1]);
        let mut widest = (first + n - last, list.len());
        for (i, pair) in list.windows(2).enumerate() {
            if pair[1] - pair[0] > widest.0 {
                widest = (pair[1] - pair[0], i);
            }
        }
        if widest.1 == list.len() {
            add(first + 1, last + 1);
        } else {
            add(list[widest.1 + 1] + 1, n);
            add(0, list[widest.1] + 1);
        }
    }
    let mut across = 0;
    change[..n]
        .iter()
        .map(|c| {
            across += c;
            across.unsigned_abs()
        })
        .collect()
}

/// Ascending positions of the cuts.
fn cuts(crossing: &[usize], work: &[usize], n_sectors: usize) -> Vec<usize> {
    let n = crossing.len();
    let first = first_cut(crossing, n / (4 * n_sectors));
    // Work of the elements between the first cut and each position.
    let mut done = vec![0];
    for i in 0..n {
        done.push(done[i] + work[(first + i) % n]);
    }
    let reach = done[n] / (4 * n_sectors);
    let mut found = vec![0];
    for k in 1..n_sectors {
        let target = k * done[n] / n_sectors;
        let near =
            done.partition_point(|&w| w + reach < target)..done.partition_point(|&w| w <= target + reach);
        let best = near.min_by_key(|&i| (crossing[(first + i) % n], done[i].abs_diff(target), i));
        let nearest = done.partition_point(|&w| w < target);
        // No sector is left without elements.
        found.push(best.unwrap_or(nearest).clamp(found[k - 1] + 1, n + k - n_sectors));
    }
    let mut cuts: Vec<usize> = found.into_iter().map(|i| (first + i) % n).collect();
    cuts.sort_unstable();
    cuts
}

/// Position within `reach` of the first one, both ways round, with the fewest nodes across, the nearest of equals.
fn first_cut(crossing: &[usize], reach: usize) -> usize {
    let n = crossing.len();
    let near = (n - reach..=n + reach).map(|p| p % n);
    near.min_by_key(|&p| (crossing[p], p.min(n - p), p)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed row of bars, bar i from node i to node i + 1.
    fn bars(n: usize) -> (Vec<[f64; 3]>, Vec<usize>) {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let points = (0..n).map(|i| [angle(i).cos(), angle(i).sin(), 0.0]).collect();
        let elements = (0..n).flat_map(|i| [i, (i + 1) % n]).collect();
        (points, elements)
    }

    /// Wrong: sectors would be no arcs of the ring, or one would be empty.
    #[test]
    fn sectors_are_arcs_of_near_equal_size() {
        for (n, n_sectors) in [(7, 1), (7, 2), (16, 4), (17, 5), (16, 16), (100, 7)] {
            let (points, elements) = bars(n);
            let sector = sectors_of_elements(&points, &elements, 2, n_sectors);
            let changes = (0..n).filter(|&e| sector[e] != sector[(e + 1) % n]).count();
            assert_eq!(changes, if n_sectors == 1 { 0 } else { n_sectors }, "{sector:?}");
            for s in 0..n_sectors {
                let size = sector.iter().filter(|&&x| x == s).count() as f64;
                let equal = n as f64 / n_sectors as f64;
                assert!(
                    size >= 1.0 && (size - equal).abs() <= 0.5 * equal + 1.0,
                    "{sector:?}"
                );
            }
        }
    }
}
