//! A body that a shaft carries, such as a hollow end of it with the seat of an inner ring.
//!
//! Its fixed groups move with the shaft: its displacement is a rigid motion R q of the shaft and what it yields beside
//! that. At rest the ring stands on what it yields. In motion R q has inertia, and accelerates what yields.

/// Motions of a shaft: x, y, z, tilts about x and y.
pub const N_SHAFT: usize = 5;
/// Inertia of a body as one of revolution, about the origin of the tilts of its shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedInertia {
    /// Mass, kg.
    pub mass: f64,
    /// Mass times the distance of its centre from the origin along z, kg m.
    pub first_moment: f64,
    /// Moment of inertia about x and y through the origin, kg m^2.
    pub transverse: f64,
    /// Moment of inertia about z, kg m^2.
    pub polar: f64,
}

/// How a shaft carries a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// Inertia of the body as one of revolution, about the origin of the shaft's tilts.
    pub inertia: CarriedInertia,
    /// How far it is from one of revolution: largest entry of its inertia that such a body has not, over its mass or
    /// what its radius of gyration makes of that.
    pub asymmetry: f64,
    /// R^T M R of the motions of the shaft, `[5][5]` flat.
    pub(crate) matrix: Vec<f64>,
    /// M R on the free dofs, by motion.
    pub(crate) pushes: Vec<Vec<f64>>,
    /// R of the functions of all seats, m per m or rad, by motion.
    pub(crate) seats: Vec<Vec<f64>>,
    /// Where the bearing of each seat stands.
    pub(crate) places: Vec<ShaftPlace>,
    /// The origin of the tilts along the body's own z, m.
    pub(crate) origin: f64,
}

/// Where a bearing stands on the shaft, seen from the body at the origin of its tilts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftPlace {
    /// Distance along z of the body, m.
    pub(crate) distance: f64,
    /// Whether it is turned by 180 deg about x.
    pub(crate) is_turned: bool,
}

impl ShaftPlace {
    /// The motion of the shaft there, of that of the body.
    pub fn there(&self, [x, y, z, tilt_x, tilt_y]: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let [x, y] = [x + self.distance * tilt_y, y - self.distance * tilt_x];
        self.turned([x, y, z, tilt_x, tilt_y])
    }

    /// The motion of the body, of that of the shaft there.
    pub fn here(&self, there: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let [x, y, z, tilt_x, tilt_y] = self.turned(there);
        [
            x - self.distance * tilt_y,
            y + self.distance * tilt_x,
            z,
            tilt_x,
            tilt_y,
        ]
    }

    /// An inertia about the origin of the body's tilts as a bearing there sees it.
    pub fn seen(&self, inertia: CarriedInertia) -> CarriedInertia {
        let way = if self.is_turned { -1.0 } else { 1.0 };
        CarriedInertia {
            first_moment: way * inertia.first_moment,
            ..inertia
        }
    }

    fn turned(&self, [x, y, z, tilt_x, tilt_y]: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        match self.is_turned {
            true => [x, -y, -z, tilt_x, -tilt_y],
            false => [x, y, z, tilt_x, tilt_y],
        }
    }
}

impl Carried {
    /// Motions of the shaft that are orthonormal in R^T M R, by Gram and Schmidt.
    pub(crate) fn orthonormal(&self) -> [[f64; N_SHAFT]; N_SHAFT] {
        let mut found: [[f64; N_SHAFT]; N_SHAFT] = Default::default();
        for k in 0..N_SHAFT {
            let mut q = [0.0; N_SHAFT];
            q[k] = 1.0;
            // Once more against round-off.
            for earlier in found[..k].iter().chain(&found[..k]) {
                let share = dot(earlier, &self.momentum(q));
                (0..N_SHAFT).for_each(|i| q[i] -= share * earlier[i]);
            }
            let size = dot(&q, &self.momentum(q)).sqrt();
            found[k] = q.map(|x| x / size);
        }
        found
    }

    /// R^T M R q: what a motion of the shaft takes, kg m and kg m^2 per unit of it.
    pub(crate) fn momentum(&self, q: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        [0, 1, 2, 3, 4].map(|i| dot(&self.matrix[N_SHAFT * i..N_SHAFT * (i + 1)], &q))
    }

    /// Motion of the functions of all seats with the shaft, m.
    pub fn seat_motion(&self, q: [f64; N_SHAFT]) -> Vec<f64> {
        let mut sum = vec![0.0; self.seats[0].len()];
        for (row, q) in self.seats.iter().zip(q) {
            sum.iter_mut().zip(row).for_each(|(s, r)| *s += r * q);
        }
        sum
    }
}

/// Product of two vectors.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Rows of a matrix times one number each, summed.
pub(crate) fn combined(rows: &[f64], factors: &[f64]) -> Vec<f64> {
    let width = rows.len().checked_div(factors.len()).unwrap_or(0);
    let mut sum = vec![0.0; width];
    for (row, factor) in rows.chunks_exact(width.max(1)).zip(factors) {
        sum.iter_mut().zip(row).for_each(|(s, r)| *s += factor * r);
    }
    sum
}
