//! Meshes with too few elements round a raceway for the balls that load it.
//!
//! A ball's force is spread over a patch of a few elements in semi-axis ([`contact::LeastSize`]). Where that reaches
//! the next ball, neighbours load the same elements, and what the ring yields between them is lost.

use std::f64::consts::{PI, TAU};

use contact::{Side, spacings_in_side};
use dynamics::{ContactMode, Model, RACEWAY_GROUP, RingModel};
use mesh::Mesh;

/// A sentence where the patches of a ring reach the next ball; its mesh is in a file.
pub fn reaches_next_ball(model: &Model, side: Side, ring: &RingModel, path: &str) -> Option<String> {
    if model.contact.mode != ContactMode::Patch {
        return None;
    }
    let n_balls = model.geometry.n_balls as f64;
    let needed = model.contact.least_patch.spacings * n_balls / spacings_in_side(ring.mesh.kind.facet_kind());
    let found = elements_round(&ring.mesh)?;
    (found < needed * (1.0 - 1e-9)).then(|| {
        format!(
            "mesh {path} of the {} ring has {found:.0} elements round its raceway for {n_balls} balls: the patch over \
             which the force of a ball is spread reaches the next one, and forces may be off by more than 5 %; \
             expected at least {:.0}, better {:.0}",
            side.name(),
            needed.ceil(),
            3.0 * needed.ceil()
        )
    })
}

/// Elements round the raceway, by the mean angle of a facet.
fn elements_round(mesh: &Mesh) -> Option<f64> {
    let facets = mesh.group(RACEWAY_GROUP);
    let span = |facet: &mesh::Facet| {
        let azimuths = mesh.facet_nodes(*facet).map(|node| {
            let [x, y, _] = mesh.nodes[node];
            y.atan2(x)
        });
        let azimuths: Vec<f64> = azimuths.collect();
        let beside = azimuths
            .iter()
            .map(|a| (a - azimuths[0] + PI).rem_euclid(TAU) - PI);
        let (low, high) = beside.fold((0.0f64, 0.0f64), |(low, high), a| (low.min(a), high.max(a)));
        high - low
    };
    let mean = facets.iter().map(span).sum::<f64>() / facets.len() as f64;
    (mean > 0.0).then(|| TAU / mean)
}
