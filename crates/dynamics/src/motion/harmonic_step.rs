//! What a ring in harmonic space does in a step around its pass over the harmonics ([`super::pass`]): its contacts meet the predictor, and
//! their forces make the increment.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use contact::NodalWeights;
use solver::cyclic::Defect;

use super::body::RingBody;
use super::defect::DefectStep;
use super::effective::{CyclicFactor, Factored};
use super::pass::{Increment, Pass};
use super::pool::PooledVector;
use super::ring::{Predictor, RingFactor, RingStep, acting, functionals, sum};
use super::ring_state::RingState;
use super::space::Space;
use super::space_defect::Terms;
use crate::sparse::SparseLoad;

impl RingFactor {
    /// The step of a ring in harmonic space whose predictor is known, with contacts at `feet`.
    pub(super) fn prepare_solved(
        &self,
        body: &RingBody,
        state: &RingState,
        predictor: Arc<PooledVector>,
        feet: &[NodalWeights],
    ) -> RingStep {
        let clock = Instant::now();
        let Factored::Cyclic(factor) = &self.factor else {
            unreachable!("harmonics are solved by their factor")
        };
        let contacts = functionals(body, feet);
        let all: Vec<&SparseLoad> = contacts.iter().chain(&body.mount).collect();
        let start = self.measure(body, &all, state.displacement());
        let (defect, moved, compliance) = self.meet((body, state), factor, &predictor, feet, &all);
        RingStep {
            predicted: sum(&start, &moved),
            predictor: Predictor::Harmonic(predictor, defect),
            start,
            compliance,
            seconds: [0.0, clock.elapsed().as_secs_f64()],
            contacts,
        }
    }

    /// What a pass over the harmonics of a ring needs; None of a ring whose state is not in harmonic space.
    pub(super) fn pass<'a>(&'a self, body: &'a RingBody) -> Option<Pass<'a>> {
        match (&self.factor, &body.space) {
            (Factored::Cyclic(factor), Space::Harmonic(space)) => Some(Pass {
                space,
                nodes: body.nodes(),
                factor,
                integrator: self.integrator,
                dt: self.dt,
                history: self.history(body),
            }),
            _ => None,
        }
    }

    /// Rows of a defect in a step from `state` with the regular ring's predictor `predictor`; `answers` is V.
    pub(super) fn defect_step(
        &self,
        (body, state): (&RingBody, &RingState),
        (factor, defect): (&CyclicFactor, &Defect),
        predictor: &[f64],
        answers: Vec<f64>,
    ) -> DefectStep {
        let Space::Harmonic(space) = &body.space else {
            return DefectStep::new(factor.at_rows(defect, predictor), answers);
        };
        let of_space = space.defect.as_ref().expect("it has the defect of its ring");
        let terms = Terms {
            history: self.history(body),
            effective: body.effective_coefficients(self.integrator, self.dt),
        };
        let known = match state.row_values() {
            Some(values) => of_space.known(terms, values, predictor),
            None => of_space.known(terms, &of_space.of_state(state), predictor),
        };
        DefectStep::under(defect, known, answers)
    }

    /// Another predictor of a step in harmonic space, without a defect.
    pub(super) fn replace_predictor(&self, body: &RingBody, step: &mut RingStep, predictor: PooledVector) {
        let all: Vec<&SparseLoad> = step.contacts.iter().chain(&body.mount).collect();
        step.predicted = sum(&step.start, &self.measure(body, &all, &predictor));
        step.predictor = Predictor::Harmonic(Arc::new(predictor), None);
    }

    /// The increment of a ring in harmonic space under these forces, before it is solved for.
    pub(super) fn forces<'a>(
        &'a self,
        body: &RingBody,
        step: &'a RingStep,
        contacts: &[f64],
        mount: &[f64],
    ) -> Increment<'a> {
        let Factored::Cyclic(factor) = &self.factor else {
            unreachable!("harmonics are solved by their factor")
        };
        let Predictor::Harmonic(_, correction) = &step.predictor else {
            unreachable!("a step of harmonics")
        };
        let by_defect = factor.by_defect(correction.as_ref(), contacts, mount);
        let forces = factor.forces(acting(body, step, contacts, mount).chain(by_defect));
        Increment {
            forces: Some(forces),
            rest: Cow::Borrowed(step.harmonics()),
        }
    }
}

impl RingStep {
    /// The predictor in harmonic space.
    pub(super) fn harmonics(&self) -> &[f64] {
        match &self.predictor {
            Predictor::Harmonic(predictor, _) => predictor,
            Predictor::Columns(_) | Predictor::Sectors(_) => unreachable!("a step of harmonics"),
        }
    }
}
