//! A ring whose seat is tied to a moving body in functions of the seat.
//!
//! The ring is free; its mount has the functionals of the seat, g = Phi^T u, and the body is a list of oscillators xi
//! ([`body::BodyModes`]). Over a step both answer forces lam of the joint,
//!
//! ```text
//! g(end) = g_pred + A lam + B F,     F the forces of the contacts
//! y(end) = y_pred - D lam,           D = V diag(1 / s) V^T,   s = c_M + c_C (a + b omega^2) + c_K omega^2
//! g = y:     (A + D) lam = y_pred - g_pred - B F
//! ```
//!
//! and the contacts see the compliance C - B^T (A + D)^-1 B. Ring and body move by the same integrator, so the joint
//! does no work. From outside the pair is a ring without a mount.
//!
//! A body that a shaft carries is a free one. Its fixed groups are the mount, q, on which the shaft acts by forces G:
//!
//! ```text
//! y(end) = y_pred - D lam + E^T G,     q(end) = q_pred - E lam + H G
//! ```

mod step;
pub(crate) mod vibration;

use std::sync::Arc;

use dense::DenseCholesky;

use crate::body::{ElasticBody, Frame, HeldRing, RingShape};
use crate::error::RingError;
use crate::factored::FactoredBody;
use crate::integrator::StepScheme;
use crate::matrices::{Matrix, NodalMatrices};
use crate::memory::MotionMemory;
use crate::oscillators::{BodyFactor, Oscillators};
use crate::state::RingState;
use crate::step::{Feet, KnownLoad, StepFactor};

use step::{TiedFactor, TiedShaft};

/// A ring and the body to which it is tied.
pub(crate) struct TiedRing {
    /// The ring, free, with the functionals of the seat as its mount.
    ring: Arc<FactoredBody>,
    /// The same as it looks from outside: without a mount.
    held: HeldRing,
    body: Arc<Oscillators>,
}

impl TiedRing {
    /// Ties a ring, free with the functionals of the seat as its mount, to a body; `outside` is the ring without it. A
    /// ring whose own step has no `frame` that turns is turned as a rigid one.
    pub fn new(ring: Arc<FactoredBody>, outside: HeldRing, body: Oscillators, frame: Frame) -> TiedRing {
        let body = match frame {
            Frame::Still => body.with_ring(|| ring.rigid_inertia()),
            Frame::Turning | Frame::Stiffened => body,
        };
        TiedRing {
            ring,
            held: outside,
            body: Arc::new(body),
        }
    }
}

impl ElasticBody for TiedRing {
    fn held(&self) -> &HeldRing {
        &self.held
    }

    fn matrices(&self) -> &dyn NodalMatrices {
        self.ring.matrices()
    }

    fn solver_name(&self) -> &'static str {
        self.ring.solver_name()
    }

    fn solver_note(&self) -> String {
        format!("{}; {}", self.ring.solver_note(), self.body.note())
    }

    fn memory(&self) -> Option<MotionMemory> {
        let bytes = self.body.bytes();
        self.ring.memory().map(|ring| MotionMemory {
            making: ring.making + bytes,
            kept: ring.kept + bytes,
            ..ring
        })
    }

    fn shape(&self) -> RingShape {
        RingShape {
            oscillators: self.body.modes.n(),
            ..self.ring.shape()
        }
    }

    fn of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        self.ring.of_coordinates(y)
    }

    fn state_of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        self.ring.state_of_coordinates(y)
    }

    fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        self.ring.coordinates(x)
    }

    fn nodal(&self, x: &[f64]) -> Vec<f64> {
        self.ring.nodal(x)
    }

    fn is_divided(&self) -> bool {
        self.ring.is_divided()
    }

    fn to_root(&self, x: &[f64]) -> Option<Vec<f64>> {
        self.ring.to_root(x)
    }

    fn own(&self, whole: Vec<f64>) -> Vec<f64> {
        self.ring.own(whole)
    }

    fn nodal_of_whole(&self, whole: &[f64]) -> Vec<f64> {
        self.ring.nodal_of_whole(whole)
    }

    fn nodal_at(&self, whole: &[f64], nodes: &[usize]) -> Vec<f64> {
        self.ring.nodal_at(whole, nodes)
    }

    fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        self.ring.form(matrix, a, b)
    }

    fn energies(&self, state: &RingState) -> [f64; 2] {
        let [kinetic, strain] = self.body.energies(state.body());
        let ring = self.ring.energies(state);
        [ring[0] + kinetic, ring[1] + strain]
    }

    fn tied(&self) -> Option<&Oscillators> {
        Some(&self.body)
    }

    fn step_factor(self: Arc<Self>, scheme: StepScheme) -> Result<Box<dyn StepFactor>, RingError> {
        let ring = self.ring.factor(scheme)?;
        let mut joint = seat_compliance(&**self.ring, &*ring);
        let seat = self.body.has_others().then(|| joint.clone());
        let body = BodyFactor::new(self.body.clone(), scheme);
        joint.iter_mut().zip(body.softness()).for_each(|(a, d)| *a += d);
        let joint = DenseCholesky::factor(self.body.n_functions(), &joint)
            .map_err(|source| RingError::Tie { source })?;
        let shaft = TiedShaft::new(body.by_shaft(), &joint).map_err(|source| RingError::Tie { source })?;
        Ok(Box::new(TiedFactor {
            body,
            ring,
            seat,
            joint,
            shaft,
        }))
    }
}

/// A, the compliance of a ring's mount, m/N, `[n][n]` flat: what a step without contacts answers.
fn seat_compliance(ring: &dyn ElasticBody, factor: &dyn StepFactor) -> Vec<f64> {
    let none = || ring.of_coordinates(vec![0.0; ring.n()]);
    let rest = RingState::new(none(), none(), none());
    let known = Arc::new(factor.predict(&rest, KnownLoad::default()));
    let feet = Feet {
        weights: &[],
        per_contact: 1,
        seen: &[],
    };
    factor.begin(&rest, known, feet).answer().compliance.clone()
}
