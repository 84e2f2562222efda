//! A ring whose vectors are coordinates, whatever solves it.

use std::sync::Arc;

use super::columns::{NodalBody, NodalSolver};
use super::step::NodalFactor;
use crate::body::{ElasticBody, HeldRing, RingShape};
use crate::error::RingError;
use crate::integrator::StepScheme;
use crate::matrices::{Matrix, NodalMatrices};
use crate::memory::MotionMemory;
use crate::state::RingState;
use crate::step::StepFactor;
use crate::vectors::dot;

impl<S: NodalSolver> ElasticBody for NodalBody<S> {
    fn held(&self) -> &HeldRing {
        &self.held
    }

    fn matrices(&self) -> &dyn NodalMatrices {
        self.solver.matrices()
    }

    fn solver_name(&self) -> &'static str {
        self.solver.name()
    }

    fn solver_note(&self) -> String {
        self.solver.note()
    }

    fn memory(&self) -> Option<MotionMemory> {
        self.solver.memory(&self.held)
    }

    fn shape(&self) -> RingShape {
        RingShape {
            length: self.held.coordinates.n(),
            kind: "coordinates",
            oscillators: 0,
        }
    }

    fn of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        y
    }

    fn state_of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        y
    }

    fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        x.to_vec()
    }

    fn nodal(&self, x: &[f64]) -> Vec<f64> {
        self.held.coordinates.expand(x)
    }

    fn nodal_at(&self, whole: &[f64], _: &[usize]) -> Vec<f64> {
        self.nodal(whole)
    }

    fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        let (matrices, coordinates) = (self.solver.matrices(), &self.held.coordinates);
        match matrix {
            Matrix::Mass => dot(a, &matrices.mass_product(coordinates, b)),
            Matrix::Stiffness => dot(a, &matrices.stiffness_product(coordinates, b)),
            Matrix::Stress => {
                let product = matrices.nodal_stress_product(&coordinates.expand(b));
                product.map_or(0.0, |product| dot(a, &coordinates.reduce(&product)))
            }
        }
    }

    fn energies(&self, state: &RingState) -> [f64; 2] {
        let matrices = self.solver.matrices();
        let strained = self.held.without_rigid_motion(state.displacement());
        matrices.energies(&self.held.coordinates, state.velocity(), &strained)
    }

    fn step_factor(self: Arc<Self>, scheme: StepScheme) -> Result<Box<dyn StepFactor>, RingError> {
        let columns = self.solver.factor(&self.held, self.held.effective(scheme))?;
        Ok(Box::new(NodalFactor::new(self, columns, scheme)))
    }
}
