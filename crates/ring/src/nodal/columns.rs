//! What the steps of a ring in coordinates ask of its linear solver: a predictor and columns of the contacts.

use contact::NodalWeights;

use crate::body::HeldRing;
use crate::error::RingError;
use crate::matrices::NodalMatrices;
use crate::memory::MotionMemory;
use crate::sparse::{SparseLoad, sparse_dot};
use crate::step::{Feet, PortAnswer, PortForces};
use crate::vectors::sum;

/// A ring and what solves it.
pub struct NodalBody<S> {
    pub(crate) held: HeldRing,
    pub(crate) solver: S,
}

/// The linear solver of a ring before its step size is known.
pub(crate) trait NodalSolver: Send + Sync + 'static {
    /// What it makes for one step size.
    type Columns: Columns;

    fn matrices(&self) -> &dyn NodalMatrices;
    fn name(&self) -> &'static str;
    fn note(&self) -> String;

    /// Forecast of the memory of a motion, where there is one.
    fn memory(&self, _: &HeldRing) -> Option<MotionMemory> {
        None
    }

    /// The factor of c_M M + c_K K.
    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<Self::Columns, RingError>;
}

/// A factored effective matrix: its answers at the ports of a step.
pub(crate) trait Columns: Send + Sync {
    /// The increment without forces, and what unit forces add.
    type Predictor: Send;

    /// Whether contacts move without a solve.
    const BY_TABLE: bool;

    fn bytes(&self) -> usize;

    /// Of a ring with a defect, see [`solver::cyclic::Defect::iterations`].
    fn iterations(&self) -> Option<usize> {
        None
    }

    /// The predictor under a right-hand side, `[n]`, and what ports see of it.
    fn begin(&self, held: &HeldRing, side: Vec<f64>, ports: &Ports) -> (Self::Predictor, Moved);

    /// What the ports see when the contacts lie elsewhere.
    fn move_contacts(&self, held: &HeldRing, predictor: &mut Self::Predictor, ports: &Ports) -> Moved;

    /// Adds a load, `[n]`, to the predictor; one solve. What the ports see more of it.
    fn add_load(
        &self,
        held: &HeldRing,
        predictor: &mut Self::Predictor,
        load: Vec<f64>,
        ports: &Ports,
    ) -> Vec<f64>;

    /// The increment under forces at the ports, `[n]`.
    fn increment(
        &self,
        held: &HeldRing,
        predictor: &Self::Predictor,
        ports: &Ports,
        forces: PortForces<'_>,
    ) -> Vec<f64>;
}

/// What the ports of a step are.
pub(crate) struct Ports {
    /// Nodal weights of the contacts.
    pub places: Vec<NodalWeights>,
    /// How many of them a contact has.
    pub per_contact: usize,
    /// Functionals of the contacts, two of each nodal weights.
    pub contacts: Vec<SparseLoad>,
    /// Functionals of what is only measured.
    pub seen: Vec<SparseLoad>,
}

/// What the ports see.
pub(crate) struct Moved {
    /// Motion without forces.
    pub predicted: Vec<f64>,
    /// Compliance, row-major.
    pub compliance: Vec<f64>,
}

impl Moved {
    /// The answer of ports with these values at the start of the step, those that are only measured last.
    pub fn into_answer(self, mut start: Vec<f64>) -> PortAnswer {
        let seen = start.split_off(self.predicted.len());
        PortAnswer {
            predicted: sum(&start, &self.predicted),
            seen,
            start,
            compliance: self.compliance,
        }
    }
}

impl Ports {
    pub fn new(held: &HeldRing, feet: Feet<'_>) -> Ports {
        Ports {
            contacts: held.coordinates.of_contacts(feet.weights),
            seen: held.coordinates.of_contacts(feet.seen),
            places: feet.weights.to_vec(),
            per_contact: feet.per_contact,
        }
    }

    /// Values of contacts and mount by what measures functionals.
    pub fn values(&self, held: &HeldRing, measure: impl FnOnce(&[&SparseLoad]) -> Vec<f64>) -> Vec<f64> {
        self.values_with(&[], held, measure)
    }

    /// Values of contacts, mount and what is only measured.
    pub fn values_at_start(
        &self,
        held: &HeldRing,
        measure: impl FnOnce(&[&SparseLoad]) -> Vec<f64>,
    ) -> Vec<f64> {
        self.values_with(&self.seen, held, measure)
    }

    fn values_with(
        &self,
        seen: &[SparseLoad],
        held: &HeldRing,
        measure: impl FnOnce(&[&SparseLoad]) -> Vec<f64>,
    ) -> Vec<f64> {
        let units = held.mount.units();
        let mount = units.unwrap_or(&held.mount.rows);
        let all: Vec<&SparseLoad> = self.contacts.iter().chain(mount).chain(seen).collect();
        let mut values = measure(&all);
        if units.is_some() {
            let own = self.contacts.len()..self.contacts.len() + mount.len();
            let of_mount = held.mount.of_units(&values[own.clone()]);
            values.splice(own, of_mount);
        }
        values
    }

    /// Generalised loads of forces at the ports, index and value.
    pub fn loads<'a>(
        &'a self,
        held: &'a HeldRing,
        forces: PortForces<'a>,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let contacts = self.contacts.iter().zip(forces.contacts);
        let contacts = contacts.flat_map(|(functional, f)| functional.iter().map(move |&(i, w)| (i, f * w)));
        contacts.chain(held.mount.loads(forces.mount))
    }
}

/// Compliance of `size` ports, of which the first `contacts` are those of contacts, exactly symmetric, from the
/// `motion(i, j)` of port i under a unit force on contact j and the mount's own compliance.
pub(super) fn column_compliance(
    [size, contacts]: [usize; 2],
    mount: &[f64],
    motion: impl Fn(usize, usize) -> f64,
) -> Vec<f64> {
    let mut compliance = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..=i {
            let value = if j < contacts {
                motion(i, j)
            } else {
                mount[(size - contacts) * (i - contacts) + j - contacts]
            };
            (compliance[size * i + j], compliance[size * j + i]) = (value, value);
        }
    }
    compliance
}

/// Values of functionals of coordinates.
pub(super) fn measure(functionals: &[&SparseLoad], x: &[f64]) -> Vec<f64> {
    functionals.iter().map(|g| sparse_dot(g, x)).collect()
}
