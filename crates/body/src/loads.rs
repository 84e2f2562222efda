//! Loads on all of a body: its weight, and the centrifugal and Euler forces of its turning.
//!
//! A load is the mass matrix times a field of accelerations. With the places X of the undeformed body,
//!
//! ```text
//! w = M (g,  W^2 (x, y, 0),  W' (y, -x, 0)),     v = K^-1 (w + Phi lam)
//! ```
//!
//! v is exact, of the seats and of the inside. In motion w acts on the oscillators ([`crate::vibration`]) by their
//! shapes beside the motion of the shaft, p = (X, phi)^T w. The weight as a whole acts on the shaft that carries the
//! body. At rest the seats of the reduced body move as those of the whole, as X is among its shapes; what the modes
//! leave out of the inside is added where it is shown.
//!
//! Cost: once, a solve for each of up to five unit loads.

/// Unit loads: accelerations along x, y and z, the square of a speed, an angular acceleration.
pub(crate) const N_LOADS: usize = 5;

/// A load on all of a body, as the bearing of a seat sees it in the frame of its ring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyLoad {
    /// Uniform acceleration, m/s^2, `[3]` in x, y, z.
    pub acceleration: [f64; 3],
    /// Speed of the frame, rad/s, where its inertia acts on the undeformed body.
    pub speed: f64,
    /// Rate of that speed, rad/s^2.
    pub rate: f64,
}

impl BodyLoad {
    /// Its acceleration alone.
    pub fn weight(self) -> BodyLoad {
        BodyLoad {
            acceleration: self.acceleration,
            ..BodyLoad::default()
        }
    }

    /// Its turning alone; None of a frame that stands.
    pub fn turning(self) -> Option<BodyLoad> {
        let turns = self.speed != 0.0 || self.rate != 0.0;
        turns.then_some(BodyLoad {
            acceleration: [0.0; 3],
            ..self
        })
    }

    /// Factors of the unit loads of a body whose bearing may stand turned by 180 deg about x.
    pub(crate) fn factors(&self, is_turned: bool) -> [f64; N_LOADS] {
        let way = if is_turned { -1.0 } else { 1.0 };
        let [x, y, z] = self.acceleration;
        [x, way * y, way * z, self.speed * self.speed, way * self.rate]
    }
}

/// What a body does under unit loads on all of it.
pub struct UnitLoads {
    /// The loads on the free dofs, N.
    pub(crate) forces: Vec<Vec<f64>>,
    /// Displacements of all dofs, m.
    pub(crate) fields: Vec<Vec<f64>>,
    /// Motion of the functions of all seats, m.
    pub(crate) seats: Vec<Vec<f64>>,
}

/// The same of its oscillators.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ModalLoads {
    /// Loads on the oscillators.
    pub loads: Vec<Vec<f64>>,
    /// Where the oscillators stand under them.
    pub at_rest: Vec<Vec<f64>>,
    /// What these leave out of the displacement of all dofs, m.
    pub beyond: Vec<Vec<f64>>,
}

/// What acts on a body besides the ring of one of its seats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BesideRing<'a> {
    /// Forces on its other seats, N, over the functions of all seats.
    pub others: Option<&'a [f64]>,
    /// Load on all of it.
    pub load: Option<BodyLoad>,
}

impl UnitLoads {
    /// Motion of the functions of all seats under loads with these factors, m.
    pub(crate) fn seat_motion(&self, factors: [f64; N_LOADS]) -> Vec<f64> {
        sum(&self.seats, factors)
    }

    /// Displacement of all dofs, m.
    pub(crate) fn displacement(&self, factors: [f64; N_LOADS]) -> Vec<f64> {
        sum(&self.fields, factors)
    }

    /// Work of the loads over the displacement that they make by themselves, J.
    pub(crate) fn own_work(&self, free: &[usize], factors: [f64; N_LOADS]) -> f64 {
        let (force, field) = (sum(&self.forces, factors), self.displacement(factors));
        free.iter().zip(force).map(|(&dof, f)| f * field[dof]).sum()
    }

    /// Bytes of all.
    pub(crate) fn bytes(&self) -> usize {
        let lists = [&self.forces, &self.fields, &self.seats];
        size_of::<f64>() * lists.into_iter().flatten().map(Vec::len).sum::<usize>()
    }
}

impl ModalLoads {
    /// Loads on the oscillators under loads with these factors.
    pub fn on_oscillators(&self, factors: [f64; N_LOADS]) -> Vec<f64> {
        sum(&self.loads, factors)
    }

    /// Where the oscillators stand under them.
    pub fn at_rest(&self, factors: [f64; N_LOADS]) -> Vec<f64> {
        sum(&self.at_rest, factors)
    }

    /// What that leaves out of the displacement of all dofs, m.
    pub fn beyond(&self, factors: [f64; N_LOADS]) -> Vec<f64> {
        sum(&self.beyond, factors)
    }

    /// Bytes of all.
    pub fn bytes(&self) -> usize {
        let lists = [&self.loads, &self.at_rest, &self.beyond];
        size_of::<f64>() * lists.into_iter().flatten().map(Vec::len).sum::<usize>()
    }
}

/// Vectors of unit loads times their factors, summed.
fn sum(of_units: &[Vec<f64>], factors: [f64; N_LOADS]) -> Vec<f64> {
    let mut sum = vec![0.0; of_units.first().map_or(0, Vec::len)];
    for (unit, factor) in of_units.iter().zip(factors) {
        sum.iter_mut().zip(unit).for_each(|(s, u)| *s += factor * u);
    }
    sum
}
