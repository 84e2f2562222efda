//! The facet groups of a body of revolution as parts of its outline.

use std::collections::BTreeMap;

use super::Revolution;
use super::outline::OutlinePiece;
use super::surface::MeshSurface;
use crate::error::MeshError;
use crate::mesh::{Facet, Mesh};
use crate::origin::Origin;

/// Where a facet lies: its piece of the outline, and the share of the piece's length at its middle.
type BandPlace = (usize, f64);

/// The outline of a body of revolution, divided where its facet groups end, each piece with the groups that have it.
/// A group must go all round the ring wherever it is.
pub fn group_outline(
    mesh: &Mesh,
    origin: &Origin,
    revolution: &Revolution,
    tolerance: f64,
) -> Result<Vec<OutlinePiece>, MeshError> {
    let surface = MeshSurface::new(mesh);
    let outline = &revolution.outline;
    let sites: Vec<BandPlace> = (0..surface.facets.len())
        .map(|facet| site(&surface, outline, facet))
        .collect();
    let index: BTreeMap<Facet, usize> = surface.facets.iter().enumerate().map(|(i, &f)| (f, i)).collect();
    let mut ends: Vec<Vec<f64>> = outline.iter().map(|_| vec![0.0, 1.0]).collect();
    let mut members: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (name, facets) in &mesh.groups {
        let own: Vec<usize> = facets.iter().map(|facet| index[facet]).collect();
        for (piece, share) in group_ends(&surface, outline, &sites, &own, tolerance)
            .map_err(|nodes| not_round(origin, &surface, name, nodes))?
        {
            ends[piece].push(share);
        }
        members.insert(name, own);
    }
    let mut parts: Vec<Vec<OutlinePiece>> = Vec::new();
    for (piece, ends) in outline.iter().zip(&mut ends) {
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b) * piece.length() <= 4.0 * tolerance);
        // The last end is 1, whatever was near it.
        let last = ends.len() - 1;
        ends[last] = 1.0;
        parts.push(ends.windows(2).map(|pair| piece.part(pair[0], pair[1])).collect());
    }
    let part_of = |(piece, share): BandPlace| {
        (
            piece,
            ends[piece]
                .partition_point(|&end| end <= share)
                .clamp(1, ends[piece].len() - 1)
                - 1,
        )
    };
    // Groups end on circles about the axis only, so that a facet speaks for all of its part.
    for (name, own) in &members {
        let mut found: Vec<(usize, usize)> = own.iter().map(|&facet| part_of(sites[facet])).collect();
        found.sort_unstable();
        found.dedup();
        found
            .into_iter()
            .for_each(|(piece, part)| parts[piece][part].groups.push(name.to_string()));
    }
    Ok(parts.into_iter().flatten().collect())
}

/// The piece on which a facet lies, and where on it its middle is.
fn site(surface: &MeshSurface, outline: &[OutlinePiece], facet: usize) -> BandPlace {
    let corners = &surface.corners[surface.n_corners * facet..][..surface.n_corners];
    let places: Vec<[f64; 2]> = corners
        .iter()
        .map(|&n| surface.points[n as usize].place())
        .collect();
    let worst = |piece: &OutlinePiece| places.iter().map(|&p| piece.nearest(p).1).fold(0.0, f64::max);
    let distances: Vec<f64> = outline.iter().map(worst).collect();
    let piece = (0..outline.len())
        .min_by(|&a, &b| distances[a].total_cmp(&distances[b]))
        .unwrap_or(0);
    let shares = places.iter().map(|&p| outline[piece].nearest(p).0);
    (piece, shares.sum::<f64>() / places.len() as f64)
}

/// Where a group ends inside pieces; the nodes of an edge of its border that does not go round the axis otherwise.
fn group_ends(
    surface: &MeshSurface,
    outline: &[OutlinePiece],
    sites: &[BandPlace],
    own: &[usize],
    tolerance: f64,
) -> Result<Vec<BandPlace>, [usize; 2]> {
    let mut edges: Vec<([u32; 2], usize)> = Vec::new();
    for &facet in own {
        let corners = &surface.corners[surface.n_corners * facet..][..surface.n_corners];
        for i in 0..corners.len() {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            edges.push(([a.min(b), a.max(b)], facet));
        }
    }
    edges.sort_unstable();
    let mut found = Vec::new();
    for same in edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1) {
        let (nodes, facet) = same[0];
        let nodes = nodes.map(|node| node as usize);
        let piece = &outline[sites[facet].0];
        let shares = nodes.map(|node| piece.nearest(surface.points[node].place()).0);
        if (shares[0] - shares[1]).abs() * piece.length() > 4.0 * tolerance {
            return Err(nodes);
        }
        found.push((sites[facet].0, 0.5 * (shares[0] + shares[1])));
    }
    Ok(found)
}

fn not_round(origin: &Origin, surface: &MeshSurface, group: &str, nodes: [usize; 2]) -> MeshError {
    let point = surface.points[nodes[0]];
    MeshError::GroupNotRound {
        path: origin.path.clone(),
        group: group.to_string(),
        nodes: nodes.map(|node| origin.node_tags[node]),
        azimuth: point.azimuth.to_degrees().rem_euclid(360.0),
        r: 1e3 * point.r,
        z: 1e3 * point.z,
    }
}
