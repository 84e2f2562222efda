//! Loads and weights on boundary facets: `f_a = integral of N_a t dA`.
//!
//! Integrated with [`crate::quadrature::facet_rule`]: a constant pressure is exact also on curved facets, so a closed
//! surface under pressure has no net force. Facets are taken in the order given.

use mesh::{Facet, Mesh};

use crate::facet::{self, MAX_FACET_NODES};
use crate::quadrature;

/// Nodal forces of a pressure that pushes on the facets against their outward normal, N, `[3 n_nodes]`; Pa.
pub fn pressure_load(mesh: &Mesh, facets: &[Facet], pressure: f64) -> Vec<f64> {
    let mut load = vec![0.0; mesh.n_dofs()];
    for_each_point(mesh, facets, |nodes, n, _, area| {
        add_force(&mut load, nodes, n, area.map(|a| -pressure * a));
    });
    load
}

/// Nodal forces of a traction, N, `[3 n_nodes]`; the traction, Pa, is a function of the position, m, and of the outward
/// unit normal.
pub fn traction_load<F>(mesh: &Mesh, facets: &[Facet], traction: F) -> Vec<f64>
where
    F: Fn([f64; 3], [f64; 3]) -> [f64; 3],
{
    let mut load = vec![0.0; mesh.n_dofs()];
    for_each_point(mesh, facets, |nodes, n, x, area| {
        let size = norm(area);
        if size > 0.0 {
            let t = traction(x, area.map(|a| a / size));
            add_force(&mut load, nodes, n, t.map(|t| size * t));
        }
    });
    load
}

/// Integral of every shape function over the facets, m^2, as (node, weight), sorted by node.
///
/// The weights sum to the area; divided by it they give the mean of a nodal field over the surface. Corner weights of
/// serendipity facets are negative.
pub fn facet_node_weights(mesh: &Mesh, facets: &[Facet]) -> Vec<(usize, f64)> {
    let mut nodes: Vec<usize> = facets.iter().flat_map(|&f| mesh.facet_nodes(f)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut weights = vec![0.0; nodes.len()];
    for_each_point(mesh, facets, |facet_nodes, n, _, area| {
        let size = norm(area);
        for (node, n) in facet_nodes.iter().zip(n) {
            let place = nodes
                .binary_search(node)
                .expect("every facet's nodes were collected above");
            weights[place] += size * n;
        }
    });
    nodes.into_iter().zip(weights).collect()
}

/// Area of the facets, m^2.
pub fn area(mesh: &Mesh, facets: &[Facet]) -> f64 {
    let mut total = 0.0;
    for_each_point(mesh, facets, |_, _, _, area| total += norm(area));
    total
}

/// Calls `visit(nodes, shape functions, position, weighted area vector)` at every integration point of every facet.
fn for_each_point<V>(mesh: &Mesh, facets: &[Facet], mut visit: V)
where
    V: FnMut(&[usize], &[f64], [f64; 3], [f64; 3]),
{
    let kind = mesh.kind.facet_kind();
    let n = kind.n_nodes();
    let rule = quadrature::facet_rule(kind);
    let values: Vec<[f64; MAX_FACET_NODES]> = rule.points.iter().map(|&xi| facet::shape(kind, xi)).collect();
    let (mut nodes, mut x) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for &f in facets {
        nodes.clear();
        nodes.extend(mesh.facet_nodes(f));
        x.clear();
        x.extend(nodes.iter().map(|&node| mesh.nodes[node]));
        for ((&xi, &weight), values) in rule.points.iter().zip(&rule.weights).zip(&values) {
            let (point, area) = facet::point_and_area(kind, &x, xi);
            visit(&nodes, &values[..n], point, area.map(|a| weight * a));
        }
    }
}

/// Adds `N_a force` to every node.
fn add_force(load: &mut [f64], nodes: &[usize], n: &[f64], force: [f64; 3]) {
    for (&node, &n) in nodes.iter().zip(n) {
        for i in 0..3 {
            load[3 * node + i] += n * force[i];
        }
    }
}

/// Length of a vector.
fn norm(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
