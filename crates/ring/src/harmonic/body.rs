//! A periodic ring whose vectors are harmonics of its free nodes, then the dofs of the shaft that carries its bore.

use std::sync::Arc;

use solver::cyclic::Definite;

use super::harmonics::HarmonicBody;
use super::space::{from_harmonics, to_harmonics};
use super::step::HarmonicFactor;
use crate::body::{ElasticBody, HeldRing, RingShape};
use crate::error::RingError;
use crate::integrator::StepScheme;
use crate::matrices::{Matrix, NodalMatrices};
use crate::memory::MotionMemory;
use crate::state::RingState;
use crate::step::StepFactor;

impl ElasticBody for HarmonicBody {
    fn held(&self) -> &HeldRing {
        &self.held
    }

    fn matrices(&self) -> &dyn NodalMatrices {
        &self.stencils
    }

    fn solver_name(&self) -> &'static str {
        "cyclic"
    }

    fn solver_note(&self) -> String {
        self.harmonics.note.clone()
    }

    fn memory(&self) -> Option<MotionMemory> {
        let memory = self.harmonics.sizes(&self.held).memory();
        Some(match self.stencils.stress {
            Some(_) => memory.stiffened(),
            None => memory,
        })
    }

    fn shape(&self) -> RingShape {
        RingShape {
            length: self.space.whole_len(),
            kind: "harmonics",
            oscillators: 0,
        }
    }

    fn of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        to_harmonics(&self.space.ring, &y)
    }

    fn state_of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        let mut x = self.of_coordinates(y);
        if let Some(defect) = &self.space.defect {
            defect.fill(&mut x);
        }
        x
    }

    fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        from_harmonics(&self.space.ring, x)
    }

    fn is_divided(&self) -> bool {
        self.space.ring.is_shared()
    }

    fn to_root(&self, x: &[f64]) -> Option<Vec<f64>> {
        let (harmonics, border) = x.split_at(self.space.ring.harmonic_len());
        let mut whole = self.space.ring.to_root(harmonics)?;
        whole.extend_from_slice(border);
        Some(whole)
    }

    fn own(&self, whole: Vec<f64>) -> Vec<f64> {
        let ring = &self.space.ring;
        if !ring.is_shared() {
            return whole;
        }
        [&whole[ring.own_harmonics()], &whole[ring.whole_len()..]].concat()
    }

    fn nodal_of_whole(&self, whole: &[f64]) -> Vec<f64> {
        let coordinates = from_harmonics(&self.space.ring.alone(), whole);
        self.held.coordinates.expand(&coordinates)
    }

    /// Only the section nodes of the chosen ones are transformed.
    fn nodal_at(&self, whole: &[f64], nodes: &[usize]) -> Vec<f64> {
        let (ring, coordinates) = (self.space.ring.alone(), &self.held.coordinates);
        let (harmonics, q) = whole.split_at(ring.harmonic_len());
        let free = nodes.iter().filter_map(|&node| coordinates.free_node(node));
        let part = ring.section_part(&[], free);
        let found = ring.field_at(&part, harmonics);
        let mut field = vec![f64::NAN; coordinates.expanded()];
        for &node in nodes {
            let u = match coordinates.free_node(node) {
                Some(number) => [0, 1, 2].map(|i| found.value(3 * number + i)),
                None => coordinates.held_displacement(node, q),
            };
            field[3 * node..3 * node + 3].copy_from_slice(&u);
        }
        field
    }

    fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        self.space.form(matrix, a, b)
    }

    fn energies(&self, state: &RingState) -> [f64; 2] {
        self.space.energies(state)
    }

    fn vibrates_above(&self, frequency: f64) -> Result<Definite, RingError> {
        let above = self.harmonics.vibrate_above(&self.held, frequency);
        above.map_err(|source| RingError::Solver {
            side: self.held.name,
            source,
        })
    }

    fn step_factor(self: Arc<Self>, scheme: StepScheme) -> Result<Box<dyn StepFactor>, RingError> {
        let factor = self
            .harmonics
            .factor(&self.held, &self.stencils, self.held.effective(scheme))?;
        Ok(Box::new(HarmonicFactor::new(self, factor, scheme)))
    }
}
