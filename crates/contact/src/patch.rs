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
        nodes: &[[f64; 3]],
        rule: &PressureRule,
        shape: PatchShape,
        elastic: Elastic,
    ) -> Result<Patch, ContactError> {
        let samples = sample(surface, nodes, rule, shape)?;
        let mean = samples
            .iter()
            .fold([0.0; 3], |m, s| axpy(m, s.weight, s.position));
        let mut inertia = [[0.0; 3]; 3];
        let mut terms: Vec<(usize, f64, [f64; 3])> = Vec::with_capacity(8 * samples.len());
        for s in &samples {
            let arm = axpy(s.position, -1.0, mean);
            add_inertia(&mut inertia, s.weight, arm);
            for &(node, value) in &s.shape[..s.n] {
                let w = s.weight * value;
                terms.push((node, w, [w * arm[0], w * arm[1], w * arm[2]]));
            }
        }
        // Stable: terms of one node keep the order of the quadrature points.
        terms.sort_by_key(|t| t.0);
        let (sin, cos) = shape.azimuth.sin_cos();
        let lever = axpy(surface.groove.centre(shape.azimuth), -1.0, mean);
        let directions = [[cos, sin, 0.0], [0.0, 0.0, 1.0]];
        let twists = directions.map(|e| solve3(inertia, cross(lever, e)));
        let mut weights = NodalWeights::default();
        for group in terms.chunk_by(|a, b| a.0 == b.0) {
            let weight: f64 = group.iter().map(|t| t.1).sum();
            let moment = group.iter().fold([0.0; 3], |m, t| axpy(m, 1.0, t.2));
            weights.nodes.push(group[0].0);
            weights
                .coefficients
                .push([0, 1].map(|i| axpy(cross(twists[i], moment), weight, directions[i])));
        }
        Ok(Patch {
            shape,
            weights,
            compliance: patch_compliance(shape.semi_axes, elastic),
        })
    }
}

struct Sample {
    weight: f64,
    position: [f64; 3],
    n: usize,
    shape: [(usize, f64); 8],
}

fn sample(
    surface: &RacewaySurface,
    nodes: &[[f64; 3]],
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
        let values = facet::shape(surface.kind, location.xi);
        let facet_nodes = surface.facet_nodes(location.facet);
        let mut s = Sample {
            weight,
            position: [0.0; 3],
            n: facet_nodes.len(),
            shape: [(0, 0.0); 8],
        };
        for (a, &node) in facet_nodes.iter().enumerate() {
            s.position = axpy(s.position, values[a], nodes[node]);
            s.shape[a] = (node, values[a]);
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
