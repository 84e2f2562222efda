//! Shape functions and reference gradients tabulated at the points of a rule.

use mesh::ElementKind;

use crate::element::{self, MAX_NODES};
use crate::quadrature::VolumeRule;

/// Shape functions at integration points; gradients by component, so that loops over nodes are contiguous.
pub(crate) struct ShapeTable {
    /// Element kind.
    pub kind: ElementKind,
    /// Reference points, `[n_points][3]`.
    pub points: Vec<[f64; 3]>,
    /// Weights, `[n_points]`.
    pub weights: Vec<f64>,
    /// Values, `[n_points][MAX_NODES]`.
    pub values: Vec<[f64; MAX_NODES]>,
    /// Reference gradients, `[n_points][3][MAX_NODES]`.
    pub gradients: Vec<[[f64; MAX_NODES]; 3]>,
}

impl ShapeTable {
    /// Tabulates the functions of a kind at the points of a rule.
    pub fn new(kind: ElementKind, rule: &VolumeRule) -> ShapeTable {
        ShapeTable {
            kind,
            points: rule.points.clone(),
            weights: rule.weights.clone(),
            values: rule.points.iter().map(|&xi| element::shape(kind, xi)).collect(),
            gradients: rule
                .points
                .iter()
                .map(|&xi| gradients_by_component(kind, xi))
                .collect(),
        }
    }

    /// Number of integration points.
    pub fn n_points(&self) -> usize {
        self.weights.len()
    }
}

/// Reference gradients at a point, `[3][MAX_NODES]`.
pub(crate) fn gradients_by_component(kind: ElementKind, xi: [f64; 3]) -> [[f64; MAX_NODES]; 3] {
    let mut by_component = [[0.0; MAX_NODES]; 3];
    for (a, gradient) in element::gradients(kind, xi).into_iter().enumerate() {
        for i in 0..3 {
            by_component[i][a] = gradient[i];
        }
    }
    by_component
}
