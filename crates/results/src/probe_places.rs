//! Where node probes lie: the mesh node nearest to the point of the scene.

use anyhow::anyhow;
use contact::Side;
use dynamics::RACEWAY_GROUP;
use dynamics::RingModel;
use mesh::Mesh;
use scene::{NodeProbe, RingName, SectionPoint};
use serde::Serialize;

use crate::failure::Failure;

/// A probed node, as `summary.json` reports it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodePlace {
    /// Name of the probe.
    pub name: String,
    /// `inner` or `outer`.
    pub ring: &'static str,
    /// Gmsh tag of the node in the mesh file.
    pub tag: u64,
    /// Index of the node among those of its ring, from 0.
    pub node: usize,
    /// Azimuth of the node on its ring, rad.
    pub azimuth_rad: f64,
    /// Its distance from the axis, m.
    pub r_m: f64,
    /// Its axial distance from the plane of the groove centres, m.
    pub z_m: f64,
    /// Its distance from the point of the scene, m.
    pub distance_m: f64,
}

/// The side of a ring's name.
pub fn side_of(ring: RingName) -> Side {
    match ring {
        RingName::Inner => Side::Inner,
        RingName::Outer => Side::Outer,
    }
}

/// The node of a probe on its ring, whose nodes have the given tags.
pub fn place(probe: &NodeProbe, ring: &RingModel, tags: &[u64]) -> Result<NodePlace, Failure> {
    let (mesh, groove) = (&ring.mesh, &ring.groove);
    let (nodes, [r, z]) = match probe.point {
        SectionPoint::Groove(angle) => {
            require_on_raceway(probe, ring, angle)?;
            let axial = groove.groove_radius * groove.direction(angle)[1];
            (mesh.group_nodes(RACEWAY_GROUP), [groove.radius(angle), axial])
        }
        SectionPoint::Anywhere { radius, z } => ((0..mesh.n_nodes()).collect(), [radius, z]),
    };
    let (sin, cos) = probe.azimuth.sin_cos();
    let point = [r * cos, r * sin, groove.centre_z + z];
    let (node, distance) = nearest(mesh, &nodes, point);
    let size = element_size(mesh, node);
    let [x, y, node_z] = mesh.nodes[node];
    let found = NodePlace {
        name: probe.name.clone(),
        ring: probe.ring.key(),
        tag: tags[node],
        node,
        azimuth_rad: y.atan2(x),
        r_m: x.hypot(y),
        z_m: node_z - groove.centre_z,
        distance_m: distance,
    };
    if distance <= size {
        return Ok(found);
    }
    Err(Failure::User(anyhow!(
        "probes.node.{}: the point at azimuth {:.3} deg, r {:.4} mm, z {:.4} mm is {:.4} mm from the nearest node of \
         the {} ring, farther than the {:.4} mm that an element measures there; that node is at azimuth {:.3} deg, r \
         {:.4} mm, z {:.4} mm",
        probe.name,
        probe.azimuth.to_degrees(),
        1e3 * r,
        1e3 * z,
        1e3 * distance,
        found.ring,
        1e3 * size,
        found.azimuth_rad.to_degrees(),
        1e3 * found.r_m,
        1e3 * found.z_m
    )))
}

/// Fails when a groove angle lies beyond the rims of the raceway.
fn require_on_raceway(probe: &NodeProbe, ring: &RingModel, angle: f64) -> Result<(), Failure> {
    let nodes = ring.mesh.group_nodes(RACEWAY_GROUP).into_iter();
    let angles = nodes.map(|node| ring.groove.coordinates(ring.mesh.nodes[node])[1]);
    let (low, high) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| {
        (low.min(a), high.max(a))
    });
    if (low..=high).contains(&angle) {
        return Ok(());
    }
    Err(Failure::User(anyhow!(
        "probes.node.{}.groove_angle is {:.3} deg; the raceway of the {} ring reaches from {:.3} to {:.3} deg",
        probe.name,
        angle.to_degrees(),
        probe.ring.key(),
        low.to_degrees(),
        high.to_degrees()
    )))
}

/// The first of the nodes that are nearest to a point, and its distance, m.
fn nearest(mesh: &Mesh, nodes: &[usize], point: [f64; 3]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for &node in nodes {
        let distance = between(mesh.nodes[node], point);
        if distance < best.1 {
            best = (node, distance);
        }
    }
    best
}

/// Largest distance of a node from another one of its elements, m.
fn element_size(mesh: &Mesh, node: usize) -> f64 {
    let elements = (0..mesh.n_elements()).map(|e| mesh.element(e));
    let around = elements.filter(|element| element.contains(&node)).flatten();
    around
        .map(|&other| between(mesh.nodes[node], mesh.nodes[other]))
        .fold(0.0, f64::max)
}

fn between(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}
