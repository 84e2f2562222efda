//! The incompatible modes of the 8-node hexahedron, `1 - xi_k^2`, k = 1, 2, 3, in each displacement component.
//!
//! Their gradients are taken with the Jacobian of the element's centre and scaled so that they integrate to zero,
//! `dP_k/dx = (det J_0 / det J) J_0^-1 dP_k/dxi`: constant stress does no work on them and the patch test holds on
//! any mesh (Taylor, Beresford and Wilson, International Journal for Numerical Methods in Engineering 10, 1976,
//! 1211-1219, doi:10.1002/nme.1620100602, the element QM6; Wilson, Taylor, Doherty and Ghaboussi, 1973, for the
//! modes).

use mesh::ElementKind;

use crate::error::FemError;
use crate::geometry::{ElementCoordinates, InverseMap, invert, jacobian};
use crate::table::gradients_by_component;

/// Geometry of one element's incompatible modes.
pub(crate) struct IncompatibleModes {
    /// The map at the centre.
    centre: InverseMap,
}

impl IncompatibleModes {
    /// The modes of element `e`; refuses an element inverted at its centre.
    pub fn new(x: &ElementCoordinates, e: usize) -> Result<IncompatibleModes, FemError> {
        let modes = IncompatibleModes::unchecked(x);
        if modes.centre.det > 0.0 {
            return Ok(modes);
        }
        let mut position = [0.0; 3];
        for node in &x[..8] {
            for i in 0..3 {
                position[i] += 0.125 * node[i];
            }
        }
        let kind = ElementKind::Hex8.name();
        Err(FemError::NonPositiveJacobian {
            element: e,
            kind,
            position,
            det: modes.centre.det,
        })
    }

    /// The modes of an element known to be valid.
    pub fn unchecked(x: &ElementCoordinates) -> IncompatibleModes {
        let dn = gradients_by_component(ElementKind::Hex8, [0.0; 3]);
        IncompatibleModes {
            centre: invert(&jacobian(8, &dn, x)),
        }
    }

    /// Gradient of mode `k`, 1/m, at a reference point where the Jacobian's determinant is `det`.
    pub fn gradient(&self, k: usize, xi: [f64; 3], det: f64) -> [f64; 3] {
        let scale = -2.0 * xi[k] * self.centre.det / det;
        [0, 1, 2].map(|j| scale * self.centre.inverse[j][k])
    }

    /// `dxi_k/dx_j` at the centre, 1/m, as `[j][k]`.
    pub fn inverse(&self) -> &[[f64; 3]; 3] {
        &self.centre.inverse
    }

    /// Determinant of the Jacobian at the centre, m^3.
    pub fn det(&self) -> f64 {
        self.centre.det
    }
}
