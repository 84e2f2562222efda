//! The pressure of a patch on the nodes of a raceway: their weights and first moments.
//!
//! With the points q of the pressure, of weights w_q, and the shape functions N_a, a facet keeps `sum of w N_a` and
//! `sum of w N_a N_b`. As points lie where shape functions put them, x_q = `sum over b of N_b x_b`, these give all
//! moments; points need no position of their own.

use fem::facet;
use mesh::{FacetKind, NodePositions};

use crate::error::ContactError;
use crate::patch_shape::PatchShape;
use crate::quadrature::PressureRule;
use crate::raceway::{Location, RacewaySurface};
use crate::unwrap::unwrap_near;

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
            FacetKind::Quad4 => NodeSums::of_facets::<4>(surface, nodes, rule, shape),
            FacetKind::Tri6 => NodeSums::of_facets::<6>(surface, nodes, rule, shape),
            FacetKind::Quad8 => NodeSums::of_facets::<8>(surface, nodes, rule, shape),
        }
    }

    fn of_facets<const N: usize>(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
    ) -> Result<NodeSums, ContactError> {
        let facets = integrate::<N>(surface, rule, shape, |_, _| ())?;
        Ok(gather(surface, nodes, &facets).0)
    }

    /// The same, and the growth of the sums as the patch turns about the axis.
    pub fn with_slopes(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
    ) -> Result<(NodeSums, NodeSlopes), ContactError> {
        match surface.kind {
            FacetKind::Quad4 => slopes_of_facets::<4>(surface, nodes, rule, shape),
            FacetKind::Tri6 => slopes_of_facets::<6>(surface, nodes, rule, shape),
            FacetKind::Quad8 => slopes_of_facets::<8>(surface, nodes, rule, shape),
        }
    }

    /// Inertia of the pressure about its mean, m^2: `sum of w (|r|^2 I - r r^T)`.
    pub fn inertia(&self) -> [[f64; 3]; 3] {
        self.inertia_of(&self.moments)
    }

    /// Growth of the inertia.
    pub fn inertia_slope(&self, slopes: &NodeSlopes) -> [[f64; 3]; 3] {
        // The mean moves all arms alike, and all moments together are zero.
        self.inertia_of(&slopes.moments)
    }

    fn inertia_of(&self, moments: &[[f64; 3]]) -> [[f64; 3]; 3] {
        let mut square = [[0.0; 3]; 3];
        for (arm, moment) in self.arms.iter().zip(moments) {
            for i in 0..3 {
                (0..3).for_each(|j| square[i][j] += arm[i] * moment[j]);
            }
        }
        let trace = square[0][0] + square[1][1] + square[2][2];
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { trace } else { 0.0 } - square[i][j]))
    }
}

/// Growth of the sums over the points of a pressure with its azimuth, per rad.
pub(crate) struct NodeSlopes {
    /// Of the weight of each node.
    pub weights: Vec<f64>,
    /// Of its moment, m.
    pub moments: Vec<[f64; 3]>,
    /// Of the mean position, m.
    pub mean: [f64; 3],
}

/// Sums over the points of one facet with N nodes.
struct FacetSums<const N: usize> {
    facet: usize,
    /// Of the weights times each shape function.
    weights: [f64; N],
    /// Of the weights times the products of two of them.
    products: [[f64; N]; N],
}

/// Sums over the points of one facet with N nodes, with the growth of the shape functions at points that turn.
struct FacetSlopes<const N: usize> {
    /// Of the weights times the growth of each shape function.
    weights: [f64; N],
    /// Of the weights times the growth of one of them and another.
    products: [[f64; N]; N],
}

/// Sums by facet, in the order in which the points meet them; each goes on to `see` with its weight and place.
fn integrate<const N: usize>(
    surface: &RacewaySurface,
    rule: &PressureRule,
    patch: PatchShape,
    mut see: impl FnMut((usize, Location), (f64, &[f64; facet::MAX_FACET_NODES])),
) -> Result<Vec<FacetSums<N>>, ContactError> {
    let groove = &surface.groove;
    let centre = surface.locate(patch.azimuth, patch.angle)?;
    let spacing = surface.spacing(centre);
    let spacings = (patch.semi_axes.groove / spacing[0]).max(patch.semi_axes.rolling / spacing[1]);
    let middle = unwrap_near(patch.azimuth, 0.0);
    let mut sums: Vec<FacetSums<N>> = Vec::new();
    // Number in the sums of each facet, counted from 1.
    let mut numbers = vec![0; surface.n_facets()];
    let mut facet = centre.facet;
    for (point, weight) in rule.points(spacings) {
        let angle = patch.angle + patch.semi_axes.groove * point[0] / groove.groove_radius;
        let azimuth = middle + patch.semi_axes.rolling * point[1] / groove.radius(angle);
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
        see((numbers[facet] - 1, location), (weight, &shape));
    }
    Ok(sums)
}

fn slopes_of_facets<const N: usize>(
    surface: &RacewaySurface,
    nodes: &NodePositions,
    rule: &PressureRule,
    shape: PatchShape,
) -> Result<(NodeSums, NodeSlopes), ContactError> {
    let mut slopes: Vec<FacetSlopes<N>> = Vec::new();
    let facets = integrate::<N>(surface, rule, shape, |(number, location), (weight, shape)| {
        if number == slopes.len() {
            slopes.push(FacetSlopes {
                weights: [0.0; N],
                products: [[0.0; N]; N],
            });
        }
        let [x, y] = surface.azimuth_slope(location);
        let gradients = facet::gradients(surface.kind, location.xi);
        let sums = &mut slopes[number];
        for a in 0..N {
            let share = weight * (gradients[a][0] * x + gradients[a][1] * y);
            sums.weights[a] += share;
            (0..N).for_each(|b| sums.products[a][b] += share * shape[b]);
        }
    })?;
    let (sums, numbers) = gather(surface, nodes, &facets);
    let grown = gather_slopes(&sums, &slopes, &numbers);
    Ok((sums, grown))
}

/// Growth of the sums by node: the moments m_a = `sum over b of P_ab (x_b - mean)` grow with the products P and with
/// the mean.
fn gather_slopes<const N: usize>(
    sums: &NodeSums,
    facets: &[FacetSlopes<N>],
    numbers: &[[usize; N]],
) -> NodeSlopes {
    let mut weights = vec![0.0; sums.nodes.len()];
    let mut moments = vec![[0.0; 3]; sums.nodes.len()];
    for (slopes, numbers) in facets.iter().zip(numbers) {
        for a in 0..N {
            weights[numbers[a]] += slopes.weights[a];
            for b in 0..N {
                let (growth, arm) = (
                    slopes.products[a][b] + slopes.products[b][a],
                    sums.arms[numbers[b]],
                );
                (0..3).for_each(|i| moments[numbers[a]][i] += growth * arm[i]);
            }
        }
    }
    let mut mean = [0.0; 3];
    for (arm, weight) in sums.arms.iter().zip(&weights) {
        (0..3).for_each(|i| mean[i] += weight * arm[i]);
    }
    for (moment, weight) in moments.iter_mut().zip(&sums.weights) {
        (0..3).for_each(|i| moment[i] -= weight * mean[i]);
    }
    NodeSlopes {
        weights,
        moments,
        mean,
    }
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

/// Sums by node, and of each facet the numbers of its nodes among them.
fn gather<const N: usize>(
    surface: &RacewaySurface,
    positions: &NodePositions,
    facets: &[FacetSums<N>],
) -> (NodeSums, Vec<[usize; N]>) {
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
    let sums = NodeSums {
        nodes,
        weights,
        mean,
        arms,
        moments,
    };
    (sums, numbers)
}
