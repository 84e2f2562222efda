//! A contact patch: nodal weights that spread a contact force over the raceway and measure its motion.
//!
//! The force Q is spread as a semi-ellipsoidal pressure over an ellipse on the torus with semi-axes [along the
//! groove, rolling direction], each the larger of the Hertz semi-axis and a few node spacings, in the rolling direction
//! of a length too, or the elements' error would stay the same share of a stress that grows with refinement. Its
//! consistent nodal weights w_a sum to 1. The elastic motion of the groove centre is measured with the *same*
//! weights: u_c = u_bar + omega x (x_c - x_bar), u_bar the weighted mean displacement of the patch and omega its
//! rotation by weighted least squares. This is exact for rigid motion, and force and motion are conjugate, so
//! tangents are symmetric and energy is conserved. Only the meridian components [radial, axial] of u_c enter the
//! contact; a tangential motion of a torus changes no gap.

use crate::error::ContactError;
use crate::halfspace::patch_compliance;
use crate::hertz::Elastic;
use crate::patch_shape::PatchShape;
use crate::pressure::{NodeSlopes, NodeSums};
use crate::quadrature::PressureRule;
use crate::raceway::RacewaySurface;
use crate::vector::cross;
use crate::weights::NodalWeights;
use mesh::NodePositions;

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

impl Patch {
    /// Weights of the patch on `surface`; `nodes` are the mesh's coordinates, m, `elastic` the ring's constants.
    pub fn new(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
        elastic: Elastic,
    ) -> Result<Patch, ContactError> {
        let sums = NodeSums::new(surface, nodes, rule, shape)?;
        Ok(Patch::of_sums(surface, &sums, shape, elastic))
    }

    /// The same with weights of the slope, the growth of the groove centre's motion [radial, axial] with the azimuth,
    /// 1/rad.
    pub fn with_slope(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
        elastic: Elastic,
    ) -> Result<(Patch, NodalWeights), ContactError> {
        let (sums, slopes) = NodeSums::with_slopes(surface, nodes, rule, shape)?;
        let slope = slope_weights(surface, (&sums, &slopes), shape.azimuth);
        Ok((Patch::of_sums(surface, &sums, shape, elastic), slope))
    }

    /// The same of a free ball, with two more weights: of traction, the mean motion of the patch along the rolling
    /// direction t and along q = n x t, n the normal into the ring, which spread forces by the same pressure; and of
    /// the slope.
    pub fn of_free_ball(
        surface: &RacewaySurface,
        nodes: &NodePositions,
        rule: &PressureRule,
        shape: PatchShape,
        elastic: Elastic,
    ) -> Result<(Patch, [NodalWeights; 2]), ContactError> {
        let (sums, slopes) = NodeSums::with_slopes(surface, nodes, rule, shape)?;
        let patch = Patch::of_sums(surface, &sums, shape, elastic);
        let slope = slope_weights(surface, (&sums, &slopes), shape.azimuth);
        Ok((patch, [traction_weights(surface, sums, shape), slope]))
    }

    fn of_sums(surface: &RacewaySurface, sums: &NodeSums, shape: PatchShape, elastic: Elastic) -> Patch {
        let inertia = sums.inertia();
        let (sin, cos) = shape.azimuth.sin_cos();
        let lever = axpy(surface.groove.centre(shape.azimuth), -1.0, sums.mean);
        let directions = [[cos, sin, 0.0], [0.0, 0.0, 1.0]];
        let twists = directions.map(|e| solve3(inertia, cross(lever, e)));
        let nodal = sums.weights.iter().zip(&sums.moments);
        let coefficients = nodal
            .map(|(weight, moment)| [0, 1].map(|i| axpy(cross(twists[i], *moment), *weight, directions[i])))
            .collect();
        let weights = NodalWeights {
            nodes: sums.nodes.clone(),
            coefficients,
        };
        Patch {
            shape,
            weights,
            compliance: patch_compliance(shape.semi_axes, elastic),
        }
    }
}

fn traction_weights(surface: &RacewaySurface, sums: NodeSums, shape: PatchShape) -> NodalWeights {
    let ((sin, cos), (across, along)) = (shape.azimuth.sin_cos(), shape.angle.sin_cos());
    let sign = surface.groove.side.sign();
    let rolling = [-sin, cos, 0.0];
    let lateral = [-sign * across * cos, -sign * across * sin, sign * along];
    let scaled = |w: &f64| [rolling, lateral].map(|e| e.map(|x| w * x));
    NodalWeights {
        coefficients: sums.weights.iter().map(scaled).collect(),
        nodes: sums.nodes,
    }
}

/// The growth of the weights of [`Patch::of_sums`] with the azimuth. With d the direction, t = I^-1 (l x d) the twist,
/// m the moments and w the weights of the nodes, weights are w d + t x m, and
///
/// ```text
/// t' = I^-1 (l' x d + l x d' - I' t),    l' = e_z x c - mean',    d' = e_z x d
/// ```
fn slope_weights(
    surface: &RacewaySurface,
    (sums, slopes): (&NodeSums, &NodeSlopes),
    azimuth: f64,
) -> NodalWeights {
    let (inertia, growth) = (sums.inertia(), sums.inertia_slope(slopes));
    let (sin, cos) = azimuth.sin_cos();
    let centre = surface.groove.centre(azimuth);
    let lever = axpy(centre, -1.0, sums.mean);
    let lever_slope = axpy(cross([0.0, 0.0, 1.0], centre), -1.0, slopes.mean);
    let directions = [[cos, sin, 0.0], [0.0, 0.0, 1.0]];
    let turned = directions.map(|d| cross([0.0, 0.0, 1.0], d));
    let twists = directions.map(|d| solve3(inertia, cross(lever, d)));
    let twist_slopes = [0, 1].map(|i| {
        let by_inertia = growth.map(|row| (0..3).map(|j| row[j] * twists[i][j]).sum::<f64>());
        let moved = axpy(cross(lever_slope, directions[i]), 1.0, cross(lever, turned[i]));
        solve3(inertia, axpy(moved, -1.0, by_inertia))
    });
    let of_node = |node: usize| {
        [0, 1].map(|i| {
            let weight = axpy([0.0; 3], slopes.weights[node], directions[i]);
            let weight = axpy(weight, sums.weights[node], turned[i]);
            let twist = cross(twist_slopes[i], sums.moments[node]);
            axpy(
                axpy(weight, 1.0, twist),
                1.0,
                cross(twists[i], slopes.moments[node]),
            )
        })
    };
    NodalWeights {
        coefficients: (0..sums.nodes.len()).map(of_node).collect(),
        nodes: sums.nodes.clone(),
    }
}

/// a + s b.
fn axpy(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
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
