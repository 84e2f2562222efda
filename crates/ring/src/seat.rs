//! Elastic fields of a ring whose bore or seat is moved or pressed by its partner, each for a unit of what does it.
//!
//! ```text
//! clamped       w = motion on the held surface,  K w = 0 elsewhere;   p = (K w) . n / A
//! mean motion   K w = n (a pressure of 1 Pa);                         u = n . w / A
//! own strain    K w = f;  clamped: w = 0 on the held surface, p = (K w - f) . n / A;   else u = n . w / A
//! n_a = integral of N_a e dA,   A = n . e
//! ```
//!
//! e is the radial direction into the ring: outwards at a bore, inwards at a seat. So p and u are conjugate means over
//! the held surface, p u A is the work of the partner, and n is its uniform pressure. Turning at omega changes them by
//! Betti's theorem: of a clamped ring p falls by omega^2 f . w / A, of the other u grows by as much, f the nodal forces
//! of a rotation at 1 rad/s. A ring strains by itself where its temperature varies with the radius: f and the stress
//! that goes with it are those of [`fem::StressRecovery::held_stress`]. Displacements are elastic, relative to the free
//! ring, in the frame of its mesh.
//!
//! Validity: small strain; the held surface neither lifts nor slips, except that in its mean motion nothing but the
//! pressure acts on it. Cost: one factorisation and a solve per field, and a pass over the elements per field of a
//! clamped ring, at the start; memory: 24 B per node and field.

use std::sync::Arc;

/// What moves or presses the held surface.
#[derive(Clone, Debug, PartialEq)]
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
    /// The ring strains by itself, by this much at each radius; the held surface is not moved or pressed.
    OwnStrain(RadialProfile),
}

/// A quantity over the radius: linear between its radii, constant inside the first and outside the last.
#[derive(Clone, Debug, PartialEq)]
pub struct RadialProfile {
    /// Radii, m, growing, `[n]`, n at least 1.
    pub radii: Arc<[f64]>,
    /// Values, `[n]`.
    pub values: Arc<[f64]>,
}

/// Stress of a ring that strains by itself, besides that of its displacement.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnStress {
    /// At the nodes, Pa, `[n_nodes][6]`.
    pub nodal: Vec<[f64; 6]>,
    /// At the integration points, Pa, `[n_elements * points_per_element][6]`.
    pub points: Vec<[f64; 6]>,
}

impl RadialProfile {
    /// Value at a radius, m.
    pub fn at(&self, radius: f64) -> f64 {
        let (radii, values) = (&self.radii, &self.values);
        match radii.partition_point(|r| *r <= radius) {
            0 => values[0],
            after if after == radii.len() => values[after - 1],
            after => {
                let share = (radius - radii[after - 1]) / (radii[after] - radii[after - 1]);
                values[after - 1] + share * (values[after] - values[after - 1])
            }
        }
    }

    /// Mean over the section of a tube between two radii, m: 2 / (b^2 - a^2) times the integral of T r.
    pub fn tube_mean(&self, radii: [f64; 2]) -> f64 {
        let [a, b] = [radii[0].min(radii[1]), radii[0].max(radii[1])];
        let inside = self.radii.iter().copied().filter(|r| a < *r && *r < b);
        let places: Vec<f64> = std::iter::once(a).chain(inside).chain([b]).collect();
        let pieces = places.windows(2).map(|piece| {
            let ([r, s], [t, u]) = ([piece[0], piece[1]], [self.at(piece[0]), self.at(piece[1])]);
            // Simpson's rule is exact: T r is of the second degree.
            let middle = 0.25 * (r + s) * (t + u);
            (s - r) / 6.0 * (t * r + 4.0 * middle + u * s)
        });
        2.0 * pieces.sum::<f64>() / (b * b - a * a)
    }

    /// The same profile of other values.
    pub fn map(&self, value: impl Fn(f64) -> f64) -> RadialProfile {
        RadialProfile {
            radii: self.radii.clone(),
            values: self.values.iter().map(|v| value(*v)).collect(),
        }
    }
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
    /// Of a ring that strains by itself the stress besides that of its displacement.
    pub own_stress: Option<Arc<OwnStress>>,
    /// f . w / A: what a turning ring changes, per (rad/s)^2; see the module.
    pub spin: f64,
}
