//! Elastic fields of a ring whose bore or seat is moved or pressed by its partner, each for a unit of what does it.
//!
//! ```text
//! clamped       w = motion on the held surface,  K w = 0 elsewhere;   p = (K w) . n / A
//! mean motion   K w = n (a pressure of 1 Pa);                         u = n . w / A
//! n_a = integral of N_a e dA,   A = n . e
//! ```
//!
//! e is the radial direction into the ring: outwards at a bore, inwards at a seat. So p and u are conjugate means over
//! the held surface, p u A is the work of the partner, and n is its uniform pressure. Turning at omega changes them
//! by Betti's theorem: of a clamped ring p falls by omega^2 f . w / A, of the other u grows by as much, f the nodal
//! forces of a rotation at 1 rad/s. Displacements are elastic, relative to the free ring, in the frame of its mesh.
//!
//! Validity: small strain; the held surface neither lifts nor slips, except that in its mean motion nothing but the
//! pressure acts on it. Cost: one factorisation and a solve per field, and a pass over the elements per field of a
//! clamped ring, at the start; memory: 24 B per node and field.

use std::sync::Arc;

/// What moves or presses the held surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeatAction {
    /// A clamped surface moves into the ring by 1 m.
    Radial,
    /// A clamped surface stretches along the axis: u_z = z - z_c, z_c the plane of the groove centres.
    Stretch,
    /// A clamped surface moves outwards by cos(order (azimuth - high)), m.
    Wave {
        /// Waves round the circumference.
        order: usize,
        /// Azimuth of a crest in the frame of the mesh, rad.
        high: f64,
    },
    /// A uniform pressure of 1 Pa on a surface that is held in its mean motion.
    Pressure,
}

/// What one action does, per unit of it.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatField {
    /// Displacement of the nodes, `[n_nodes][3]` flat.
    pub displacement: Arc<Vec<f64>>,
    /// Mean pressure of the partner on the ring, Pa; of a wave its amplitude, at the crest.
    pub pressure: f64,
    /// Mean displacement of the held surface into the ring, m.
    pub into_ring: f64,
    /// Motion of the bottom of the groove [radial, axial], m: the straight line over z that fits the raceway best, at
    /// the plane of the groove centres.
    pub groove: [f64; 2],
    /// f . w / A: what a turning ring changes, per (rad/s)^2; see the module.
    pub spin: f64,
}
