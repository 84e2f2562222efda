//! The pressure of a patch on the nodes of a raceway: their weights and first moments.
//!
//! With the points q of the pressure, of weights w_q, and the shape functions N_a, a facet keeps `sum of w N_a` and
//! `sum of w N_a N_b`. As points lie where shape functions put them, x_q = `sum over b of N_b x_b`, these give all
//! moments; points need no position of their own.

use fem::facet;
use mesh::{FacetKind, NodePositions};

use crate::error::ContactError;
use crate::patch::PatchShape;
use crate::quadrature::PressureRule;
use crate::raceway::{RacewaySurface, unwrap_near};

/// Sums over the points of a pressure, by node.
pub(crate) struct NodeSums {
    /// The nodes that the patch touches, ascending.
    pub nodes: Vec<usize>,
    /// Weight of each.
    pub weights: Vec<f64>,
    /// Mean position of the pressure, m.
    pub mean: [f64; 3],
    /// Positions of the nodes from the mean, m.
    pub arms: Vec<[f64; 3]>,
    /// Weight times the arms of the points, by node, m.
    pub moments: Vec<[f64; 3]>,
}

impl NodeSums {
    /// Of the patch `shape` on `surface`; `nodes` are the mesh's coordinates, m.
    pub fn new(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
    ) -> Result<NodeSums, ContactError> {
        match surface.kind {
            FacetKind::Quad4 => Ok(gather(surface, nodes, &integrate::<4>(surface, rule, shape)?)),
            FacetKind::Tri6 => Ok(gather(surface, nodes, &integrate::<6>(surface, rule, shape)?)),
            FacetKind::Quad8 => Ok(gather(surface, nodes, &integrate::<8>(surface, rule, shape)?)),
        }
    }

    /// Inertia of the pressure about its mean, m^2: `sum of w (|r|^2 I - r r^T)`.
    pub fn inertia(&self) -> [[f64; 3]; 3] {
        let mut square = [[0.0; 3]; 3];
        for (arm, moment) in self.arms.iter().zip(&self.moments) {
            for i in 0..3 {
                (0..3).for_each(|j| square[i][j] += arm[i] * moment[j]);
            }
        }
        let trace = square[0][0] + square[1][1] + square[2][2];
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { trace } else { 0.0 } - square[i][j]))
    }
}

/// Sums over the points of one facet with N nodes.
struct FacetSums<const N: usize> {
    facet: usize,
    /// Of the weights times each shape function.
    weights: [f64; N],
    /// Of the weights times the products of two of them.
    products: [[f64; N]; N],
}

/// Sums by facet, in the order in which the points meet them.
fn integrate<const N: usize>(
    surface: &RacewaySurface,
    rule: &PressureRule,
    patch: PatchShape,
) -> Result<Vec<FacetSums<N>>, ContactError> {
    let groove = &surface.groove;
    let centre = surface.locate(patch.azimuth, patch.angle)?;
    let spacing = surface.spacing(centre);
    let spacings = (patch.semi_axes[0] / spacing[0]).max(patch.semi_axes[1] / spacing[1]);
    let middle = unwrap_near(patch.azimuth, 0.0);
    let mut sums: Vec<FacetSums<N>> = Vec::new();
    // Number in the sums of each facet, counted from 1.
    let mut numbers = vec![0; surface.n_facets()];
    let mut facet = centre.facet;
    for (point, weight) in rule.points(spacings) {
        let angle = patch.angle + patch.semi_axes[0] * point[0] / groove.groove_radius;
        let azimuth = middle + patch.semi_axes[1] * point[1] / groove.radius(angle);
        let location = surface.locate_near(facet, azimuth, angle)?;
        facet = location.facet;
        if numbers[facet] == 0 {
            sums.push(FacetSums {
                facet,
                weights: [0.0; N],
                products: [[0.0; N]; N],
            });
            numbers[facet] = sums.len();
        }
        let shape = facet::shape(surface.kind, location.xi);
        sums[numbers[facet] - 1].add(weight, &shape);
    }
    Ok(sums)
}

impl<const N: usize> FacetSums<N> {
    fn add(&mut self, weight: f64, shape: &[f64; facet::MAX_FACET_NODES]) {
        for a in 0..N {
            let share = weight * shape[a];
            self.weights[a] += share;
            (0..N).for_each(|b| self.products[a][b] += share * shape[b]);
        }
    }
}

/// Sums by node.
fn gather<const N: usize>(
    surface: &RacewaySurface,
    positions: &NodePositions,
    facets: &[FacetSums<N>],
) -> NodeSums {
    let all = facets.iter().flat_map(|f| surface.facet_nodes(f.facet));
    let mut nodes: Vec<usize> = all.copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let number = |node: &usize| nodes.partition_point(|n| n < node);
    let numbers = |f: &FacetSums<N>| -> [usize; N] {
        let facet = surface.facet_nodes(f.facet);
        std::array::from_fn(|a| number(&facet[a]))
    };
    let numbers: Vec<[usize; N]> = facets.iter().map(numbers).collect();
    let mut weights = vec![0.0; nodes.len()];
    for (sums, numbers) in facets.iter().zip(&numbers) {
        (0..N).for_each(|a| weights[numbers[a]] += sums.weights[a]);
    }
    let at: Vec<[f64; 3]> = nodes.iter().map(|&node| positions[node]).collect();
    let mut mean = [0.0; 3];
    for (x, w) in at.iter().zip(&weights) {
        (0..3).for_each(|i| mean[i] += w * x[i]);
    }
    let arms: Vec<[f64; 3]> = at.iter().map(|x| [0, 1, 2].map(|i| x[i] - mean[i])).collect();
    let mut moments = vec![[0.0; 3]; nodes.len()];
    for (sums, numbers) in facets.iter().zip(&numbers) {
        for a in 0..N {
            let moment = &mut moments[numbers[a]];
            for b in 0..N {
                let (product, arm) = (sums.products[a][b], arms[numbers[b]]);
                (0..3).for_each(|i| moment[i] += product * arm[i]);
            }
        }
    }
    NodeSums {
        nodes,
        weights,
        mean,
        arms,
        moments,
    }
}
