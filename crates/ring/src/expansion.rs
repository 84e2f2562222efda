//! Growth of a ring that turns, and what its stress does to further displacements.
//!
//! A ring that turns with W is under the centrifugal load W^2 rho (x, y, 0). Its stress W^2 s_1 is in equilibrium with
//! that load before anything else acts, and works on the squares of the gradients of a displacement w:
//!
//! ```text
//! energy  W^2/2 integral of s_1 : (grad w^T grad w)  =  W^2/2 w K_1 w,      load on the ring  - W^2 K_1 w
//! ```
//!
//! the stress stiffness ([`fem::prestress`]). s_1 is that of the ring as it is held at rest: clamped, or in its mean
//! motion, where it is that of a free ring. A free ring has the same.
//!
//! w is the total displacement in the turning frame. That is right for a ring whose bore carries nothing, to second
//! order and for large speeds: on a rigid tilt R t the load of the turned stress, K_1 R t, is the centrifugal load
//! turned with the ring, so that a tilt needs no moment but that of a gyroscope, and the elastic part of a tilt is
//! stiffened as the rigid one. A bore that is held pulls on the ring besides, and turns with it; what that would do to
//! the moment on the shaft is known ([`crate::ElasticBody`], `tilt_by_stress`) and taken out by whoever moves the
//! shaft.
//!
//! Left out: the stress of a changing speed, of fits, of temperatures and of the bearing's forces.

use crate::division::body_load;
use crate::error::RingError;
use crate::model::{Hold, RingModel};
use crate::statics::{RingSolver, StaticSettings};

/// Displacements of a ring under the centrifugal load of unit speed as it is held, m s^2, `[n_dofs]`. Collective.
pub fn centrifugal_expansion(ring: &RingModel, settings: StaticSettings) -> Result<Vec<f64>, RingError> {
    let density = ring.material.density;
    let load = body_load(ring, settings.name, settings.backend, |[x, y, _]| {
        [density * x, density * y, 0.0]
    })?;
    let solver = match ring.hold {
        Hold::Clamped | Hold::MeanMotion => RingSolver::new(ring, settings)?,
        Hold::Free => {
            let mean = RingModel {
                hold: Hold::MeanMotion,
                ..ring.untied()
            };
            RingSolver::new(&mean, settings)?
        }
    };
    Ok(solver.solve(load, 1))
}
