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
use super::ring_state::{RingState, within_part};
use super::space::Space;
use super::space_defect::{RowValues, Terms};
use super::vectors::{add, combined};
use crate::effects::FrameTurn;
use crate::solution::dot;
use crate::sparse::SparseLoad;

/// What a step of a ring starts from.
#[derive(Clone)]
pub(super) struct StepStart<'a> {
    pub state: &'a RingState,
    /// Turning of its frame, when the inertia acts.
    pub turn: Option<FrameTurn>,
    /// Motion of the rows of a defect that the inertia is to fit; None: the velocity stays.
    pub moved: Option<Vec<f64>>,
}

/// Where the rows of a defect come from when contacts meet a predictor.
pub(super) enum Rows<'a> {
    /// They are found.
    Found(StepStart<'a>),
    /// They stay, as the predictor does.
    Of(Option<DefectStep>),
}

impl<'a> StepStart<'a> {
    /// With the first guess of the inertia.
    pub fn first(state: &'a RingState, turn: Option<FrameTurn>) -> StepStart<'a> {
        StepStart {
            state,
            turn,
            moved: None,
        }
    }
}

impl RingFactor {
    /// The step of a ring in harmonic space whose predictor is known, with contacts at `feet`.
    pub(super) fn prepare_solved(
        &self,
        body: &RingBody,
        (state, turn): (&RingState, Option<FrameTurn>),
        predictor: Arc<PooledVector>,
        feet: &[NodalWeights],
    ) -> RingStep {
        let clock = Instant::now();
        let factor = self.harmonics();
        let contacts = functionals(body, feet);
        let all: Vec<&SparseLoad> = contacts.iter().chain(&body.mount).collect();
        let start = self.measure(body, &all, state.displacement());
        let (defect, moved, compliance) = self.meet(
            (body, Rows::Found(StepStart::first(state, turn))),
            factor,
            &predictor,
            feet,
            &all,
        );
        RingStep {
            predicted: sum(&start, &moved),
            predictor: Predictor::Harmonic(predictor, defect),
            start,
            compliance,
            seconds: [0.0, 0.0, clock.elapsed().as_secs_f64()],
            contacts,
        }
    }

    /// The factor of a ring whose steps are in harmonic space.
    fn harmonics(&self) -> &CyclicFactor {
        match &self.factor {
            Factored::Cyclic(factor) => factor,
            Factored::Sparse(_) | Factored::Sectors(_) => {
                unreachable!("harmonics are solved by their factor")
            }
        }
    }

    /// What a pass over the harmonics of a ring needs; None of a ring whose state is not in harmonic space.
    pub(super) fn pass<'a>(&'a self, body: &'a RingBody) -> Option<Pass<'a>> {
        match (&self.factor, &body.space) {
            (Factored::Cyclic(factor), Space::Harmonic(space)) => Some(Pass {
                space,
                nodes: body.regular_nodes(),
                factor,
                integrator: self.integrator,
                dt: self.dt,
                history: self.history(body),
            }),
            _ => None,
        }
    }

    /// Rows of a defect in a step with the regular ring's predictor `predictor`; `answers` is V.
    pub(super) fn defect_step(
        &self,
        (body, from): (&RingBody, StepStart<'_>),
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
        let found;
        let values = match from.state.row_values() {
            Some(values) => values,
            None => {
                found = of_space.of_state(from.state);
                &found
            }
        };
        let mut known = of_space.known(terms, values, predictor);
        let inertia = from.turn.map_or(Vec::new(), |turn| {
            let RowValues(start) = values;
            let start = start.each_ref().map(Vec::as_slice);
            let [mut w, mut v] = [(); 2].map(|()| vec![0.0; start[0].len()]);
            let dw = from.moved.as_deref();
            within_part(self.integrator, self.dt, dw, start, [&mut w, &mut v]);
            of_space.inertia(turn, [&w, &v])
        });
        // Of the inertia there are rows of the regular ring as well.
        known.iter_mut().zip(&inertia).for_each(|(q, f)| *q += f);
        DefectStep::under(defect, known, inertia, answers)
    }

    /// Another predictor of a step in harmonic space.
    pub(super) fn replace_predictor(
        &self,
        body: &RingBody,
        step: &mut RingStep,
        predictor: Arc<PooledVector>,
        from: StepStart<'_>,
    ) {
        let factor = self.harmonics();
        let all: Vec<&SparseLoad> = step.contacts.iter().chain(&body.mount).collect();
        step.predicted = sum(&step.start, &self.measure(body, &all, &predictor));
        let Predictor::Harmonic(_, correction) = &mut step.predictor else {
            unreachable!("a step of harmonics")
        };
        let correction = correction
            .take()
            .zip(factor.defect.as_ref())
            .map(|(old, defect)| {
                let defect = &defect.answer;
                let new = self.defect_step((body, from), (factor, defect), &predictor, old.into_answers());
                add(&mut step.predicted, &new.motion(defect));
                new
            });
        step.predictor = Predictor::Harmonic(predictor, correction);
    }

    /// Motion of the rows of a defect between two states of harmonic space; None without a defect.
    pub(super) fn moved_rows(&self, body: &RingBody, states: [&RingState; 2]) -> Option<Vec<f64>> {
        let Space::Harmonic(space) = &body.space else {
            return None;
        };
        let defect = space.defect.as_ref()?;
        let [old, new] = states.map(|state| match state.row_values() {
            Some(RowValues([w, ..])) => w.clone(),
            None => defect.values(state.displacement()),
        });
        Some(combined([1.0, -1.0], &new, &old))
    }

    /// Work of the inertia of the turning frame on the rows of a defect between two states, J, beyond that of the regular ring's.
    pub(super) fn frame_work(&self, body: &RingBody, step: &RingStep, states: [&RingState; 2]) -> f64 {
        match &step.predictor {
            Predictor::Harmonic(_, Some(correction)) if !correction.inertia().is_empty() => {
                let moved = self.moved_rows(body, states).unwrap_or_default();
                dot(correction.inertia(), &moved)
            }
            _ => 0.0,
        }
    }

    /// The increment of a ring in harmonic space under these forces, before it is solved for.
    pub(super) fn forces<'a>(
        &'a self,
        body: &RingBody,
        step: &'a RingStep,
        contacts: &[f64],
        mount: &[f64],
    ) -> Increment<'a> {
        let factor = self.harmonics();
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
    pub(super) fn harmonics(&self) -> &Arc<PooledVector> {
        match &self.predictor {
            Predictor::Harmonic(predictor, _) => predictor,
            Predictor::Columns(_) | Predictor::Sectors(_) => unreachable!("a step of harmonics"),
        }
    }
}
