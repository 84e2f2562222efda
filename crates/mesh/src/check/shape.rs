//! No element may be inside out or flat: det J > 0 at its nodes and integration points.

use std::ops::Range;

use crate::element::ElementKind;
use crate::error::MeshError;
use crate::geometry::{Gradients, determinant, element_coordinates, gradients, quadrature, reference_nodes};
use crate::mesh::Mesh;
use crate::origin::Origin;

/// An element is degenerate when det J falls to this share of its mean; far below what any useful element has
/// (a few per cent) and far above rounding.
const DEGENERATE: f64 = 1e-6;

/// The worst of the bad elements of a mesh.
pub(crate) struct Worst {
    pub(crate) element: usize,
    /// Smallest det J, m^3.
    pub(crate) smallest: f64,
    /// Mean of |det J|, m^3.
    pub(crate) mean: f64,
    /// Number of bad elements.
    pub(crate) count: usize,
}

/// No element may be bad.
pub(crate) fn check_shape(mesh: &Mesh, origin: &Origin) -> Result<(), MeshError> {
    let Some(bad) = worst_element(mesh, 0..mesh.n_elements()) else {
        return Ok(());
    };
    let unit = origin.unit.powi(3);
    Err(MeshError::BadElement {
        path: origin.path.clone(),
        element: origin.element_tags[bad.element],
        problem: if bad.smallest < -DEGENERATE * bad.mean {
            "inverted"
        } else {
            "degenerate"
        },
        worst: bad.smallest / unit,
        mean: bad.mean / unit,
        count: bad.count,
    })
}

/// The worst bad element of a range, if there is any: det J is looked at in all nodes, all integration points and,
/// for the tetrahedron, the points of its four-point rule.
pub(crate) fn worst_element(mesh: &Mesh, elements: Range<usize>) -> Option<Worst> {
    let table = sample_gradients(mesh.kind);
    let mut x = Vec::with_capacity(20);
    let mut worst: Option<Worst> = None;
    let mut count = 0;
    for element in elements {
        element_coordinates(mesh, element, &mut x);
        let (mut smallest, mut sum) = (f64::INFINITY, 0.0);
        for g in &table {
            let det_j = determinant(&x, g);
            smallest = smallest.min(det_j);
            sum += det_j.abs();
        }
        let mean = sum / table.len() as f64;
        // Written so that an overflow to NaN or infinity is bad, too.
        let is_good = smallest > DEGENERATE * mean && mean.is_finite();
        if is_good {
            continue;
        }
        count += 1;
        let is_worst = |w: &Worst| ratio(smallest, mean) < ratio(w.smallest, w.mean);
        if worst.as_ref().is_none_or(is_worst) {
            worst = Some(Worst {
                element,
                smallest,
                mean,
                count,
            });
        }
    }
    worst.map(|w| Worst { count, ..w })
}

fn ratio(smallest: f64, mean: f64) -> f64 {
    if mean > 0.0 { smallest / mean } else { 0.0 }
}

fn sample_gradients(kind: ElementKind) -> Vec<Gradients> {
    let mut points = reference_nodes(kind);
    points.extend(quadrature(kind).into_iter().map(|(xi, _)| xi));
    if kind == ElementKind::Tet10 {
        // Four-point rule of degree 2 (Hammer, Marlowe, Stroud 1956).
        let (a, b) = (0.585_410_196_624_968_5, 0.138_196_601_125_010_5);
        points.extend([[b, b, b], [a, b, b], [b, a, b], [b, b, a]]);
    }
    points.into_iter().map(|xi| gradients(kind, xi)).collect()
}
