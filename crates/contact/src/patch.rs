//! A contact patch: nodal weights that spread a contact force over the raceway and measure its motion.
//!
//! The force Q is spread as a semi-ellipsoidal pressure over an ellipse on the torus with semi-axes [along the
//! groove, rolling direction], each the larger of the Hertz semi-axis and a few node spacings. Its
//! consistent nodal weights w_a sum to 1. The elastic motion of the groove centre is measured with the *same*
//! weights: u_c = u_bar + omega x (x_c - x_bar), u_bar the weighted mean displacement of the patch and omega its
//! rotation by weighted least squares. This is exact for rigid motion, and force and motion are conjugate, so
//! tangents are symmetric and energy is conserved. Only the meridian components [radial, axial] of u_c enter the
//! contact; a tangential motion of a torus changes no gap.

use crate::error::ContactError;
use crate::halfspace::patch_compliance;
use crate::hertz::Elastic;
use crate::quadrature::PressureRule;
use crate::raceway::RacewaySurface;
use crate::vector::cross;
use crate::weights::NodalWeights;
use fem::facet;
use mesh::NodePositions;

/// Share of the way to the groove's edge that a patch may fill.
const EDGE_SHARE: f64 = 0.98;

/// Where and how large a patch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchShape {
    /// Azimuth of the ball in the ring's frame, rad.
    pub azimuth: f64,
    /// Contact angle, rad.
    pub angle: f64,
    /// Semi-axes [along the groove, rolling direction], m.
    pub semi_axes: [f64; 2],
    /// The Hertz ellipse reaches beyond the edge of the groove: edge contact, Hertz theory does not hold.
    pub truncated: bool,
}

/// A contact force spread over the raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Shape it was made for.
    pub shape: PatchShape,
    /// Nodal weights: they spread the force and measure the motion of the groove centre.
    pub weights: NodalWeights,
    /// Half-space compliance of the patch c_s, m/N.
    pub compliance: f64,
}

impl PatchShape {
    /// Shape at an azimuth and contact angle, at least the Hertz ellipse `hertz_axes` (m) and `n_spacings` node
    /// spacings, at most up to the edge of the groove.
    pub fn new(
        surface: &RacewaySurface,
        azimuth: f64,
        angle: f64,
        hertz_axes: [f64; 2],
        n_spacings: f64,
    ) -> Result<PatchShape, ContactError> {
        let spacing = surface.spacing(surface.locate(azimuth, angle)?);
        let room = EDGE_SHARE * surface.rim_distance(angle);
        let along = hertz_axes[0].max(n_spacings * spacing[0]).min(room);
        let rolling = hertz_axes[1].max(n_spacings * spacing[1]);
        Ok(PatchShape {
            azimuth,
            angle,
            semi_axes: [along, rolling],
            truncated: is_truncated(surface, angle, hertz_axes),
        })
    }
}

/// Whether a Hertz ellipse of semi-axes `hertz_axes`, m, at a contact angle, rad, reaches beyond the edge of the groove.
pub fn is_truncated(surface: &RacewaySurface, angle: f64, hertz_axes: [f64; 2]) -> bool {
    hertz_axes[0] > EDGE_SHARE * surface.rim_distance(angle)
}

impl Patch {
    /// Weights of the patch on `surface`; `nodes` are the mesh's coordinates, m, `elastic` the ring's constants.
    pub fn new(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
        elastic: Elastic,
    ) -> Result<Patch, ContactError> {
        let samples = sample(surface, nodes, rule, shape)?;
        let mean = samples
            .iter()
            .fold([0.0; 3], |m, s| axpy(m, s.weight, s.position));
        let mut inertia = [[0.0; 3]; 3];
        let mut touched = Touched::new(surface, &samples);
        for s in &samples {
            let arm = axpy(s.position, -1.0, mean);
            add_inertia(&mut inertia, s.weight, arm);
            touched.add(s, arm);
        }
        let (sin, cos) = shape.azimuth.sin_cos();
        let lever = axpy(surface.groove.centre(shape.azimuth), -1.0, mean);
        let directions = [[cos, sin, 0.0], [0.0, 0.0, 1.0]];
        let twists = directions.map(|e| solve3(inertia, cross(lever, e)));
        let coefficients = touched
            .sums
            .iter()
            .map(|(weight, moment)| [0, 1].map(|i| axpy(cross(twists[i], *moment), *weight, directions[i])))
            .collect();
        let weights = NodalWeights {
            nodes: touched.nodes,
            coefficients,
        };
        Ok(Patch {
            shape,
            weights,
            compliance: patch_compliance(shape.semi_axes, elastic),
        })
    }
}

/// A quadrature point of the pressure on the mesh.
struct Sample {
    weight: f64,
    position: [f64; 3],
    facet: usize,
    shape: [f64; facet::MAX_FACET_NODES],
}

/// The nodes that a patch touches and their sums over its quadrature points.
struct Touched {
    /// Ascending.
    nodes: Vec<usize>,
    /// Ascending, with the number in `nodes` of each of their nodes.
    facets: Vec<(usize, [usize; facet::MAX_FACET_NODES])>,
    n: usize,
    /// Weight, and weight times arm, by node.
    sums: Vec<(f64, [f64; 3])>,
}

impl Touched {
    fn new(surface: &RacewaySurface, samples: &[Sample]) -> Touched {
        let mut facets: Vec<usize> = samples.iter().map(|s| s.facet).collect();
        facets.sort_unstable();
        facets.dedup();
        let all = facets.iter().flat_map(|&f| surface.facet_nodes(f));
        let mut nodes: Vec<usize> = all.copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let numbers = |f: usize| {
            let mut numbers = [0; facet::MAX_FACET_NODES];
            for (number, node) in numbers.iter_mut().zip(surface.facet_nodes(f)) {
                *number = nodes.partition_point(|n| n < node);
            }
            (f, numbers)
        };
        Touched {
            facets: facets.iter().map(|&f| numbers(f)).collect(),
            n: surface.kind.n_nodes(),
            sums: vec![(0.0, [0.0; 3]); nodes.len()],
            nodes,
        }
    }

    fn add(&mut self, sample: &Sample, arm: [f64; 3]) {
        let found = self.facets.partition_point(|f| f.0 < sample.facet);
        let numbers = &self.facets[found].1[..self.n];
        for (&number, value) in numbers.iter().zip(sample.shape) {
            let w = sample.weight * value;
            let (weight, moment) = &mut self.sums[number];
            *weight += w;
            *moment = axpy(*moment, w, arm);
        }
    }
}

fn sample(
    surface: &RacewaySurface,
    nodes: &NodePositions,
    rule: &PressureRule,
    patch: PatchShape,
) -> Result<Vec<Sample>, ContactError> {
    let groove = &surface.groove;
    let spacing = surface.spacing(surface.locate(patch.azimuth, patch.angle)?);
    let spacings = (patch.semi_axes[0] / spacing[0]).max(patch.semi_axes[1] / spacing[1]);
    let mut samples = Vec::new();
    for (point, weight) in rule.points(spacings) {
        let angle = patch.angle + patch.semi_axes[0] * point[0] / groove.groove_radius;
        let azimuth = patch.azimuth + patch.semi_axes[1] * point[1] / groove.radius(angle);
        let location = surface.locate(azimuth, angle)?;
        let mut s = Sample {
            weight,
            position: [0.0; 3],
            facet: location.facet,
            shape: facet::shape(surface.kind, location.xi),
        };
        for (&node, &value) in surface.facet_nodes(location.facet).iter().zip(&s.shape) {
            s.position = axpy(s.position, value, nodes[node]);
        }
        samples.push(s);
    }
    Ok(samples)
}

/// a + s b.
fn axpy(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Adds w (|r|^2 I - r r^T).
fn add_inertia(inertia: &mut [[f64; 3]; 3], weight: f64, arm: [f64; 3]) {
    let square: f64 = arm.iter().map(|x| x * x).sum();
    for i in 0..3 {
        for j in 0..3 {
            let diagonal = if i == j { square } else { 0.0 };
            inertia[i][j] += weight * (diagonal - arm[i] * arm[j]);
        }
    }
}

/// Solves a 3x3 system by Cramer's rule; the patch's inertia is well conditioned because it spans an area.
fn solve3(a: [[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let column = |j: usize| [a[0][j], a[1][j], a[2][j]];
    let (c0, c1, c2) = (column(0), column(1), column(2));
    let dot = |x: [f64; 3], y: [f64; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let det = dot(c0, cross(c1, c2));
    [
        dot(b, cross(c1, c2)) / det,
        dot(c0, cross(b, c2)) / det,
        dot(c0, cross(c1, b)) / det,
    ]
}
