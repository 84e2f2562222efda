//! A step of a ring whose vectors are coordinates.

use std::sync::Arc;

use timer::{Laps, Stopwatch};

use super::columns::{Columns, NodalBody, NodalSolver, Ports, measure};
use crate::body::{ElasticBody, frame_load};
use crate::integrator::StepScheme;
use crate::matrices::StateVectors;
use crate::pool::PooledVector;
use crate::settling::{FrameRounds, LoadChange};
use crate::state::RingState;
use crate::step::{
    ElasticStep, End, Ended, Feet, FrameTurn, Known, KnownLoad, PortAnswer, PortForces, RACEWAYS, RIGHT_SIDE,
    Settling, StepFactor, Works,
};
use crate::vectors::{add, combined, dot};

/// The factor of one ring at one step size.
pub(super) struct NodalFactor<S: NodalSolver> {
    body: Arc<NodalBody<S>>,
    columns: S::Columns,
    scheme: StepScheme,
}

/// A step under way.
struct NodalStep<'a, S: NodalSolver> {
    factor: &'a NodalFactor<S>,
    old: &'a RingState,
    known: Arc<Known>,
    ports: Ports,
    predictor: <S::Columns as Columns>::Predictor,
    answer: PortAnswer,
    laps: Laps,
    /// Inertia of the turning frame that acts.
    inertia: Option<(FrameTurn, Arc<PooledVector>)>,
    rounds: FrameRounds,
    /// The increment, once the inertia fits it.
    increment: Option<Vec<f64>>,
}

impl<S: NodalSolver> NodalFactor<S> {
    pub fn new(body: Arc<NodalBody<S>>, columns: S::Columns, scheme: StepScheme) -> NodalFactor<S> {
        NodalFactor {
            body,
            columns,
            scheme,
        }
    }

    /// Energies of a state, J, and -K w + M (history) + C (history), what the right-hand side of a step from there has
    /// but loads.
    fn of_state(&self, state: &RingState) -> ([f64; 2], Vec<f64>) {
        let held = &self.body.held;
        let [m, k] = held.history(self.scheme);
        let (v, a) = (state.velocity(), state.acceleration());
        let vectors = StateVectors {
            velocity: v,
            strained: held.without_rigid_motion(state.displacement()),
            inertial: combined(m, v, a),
            damped: combined(k, v, a),
        };
        self.body.solver.matrices().of_state(&held.coordinates, &vectors)
    }

    /// What is known of a step from a state with this `history`.
    fn known(&self, from: &RingState, load: KnownLoad, history: Vec<f64>) -> Known {
        let guess = |turn| Arc::new(self.frame_load(turn, from, None).into());
        Known {
            of: from.stamp().clone(),
            inertia: load.turn.map(guess),
            load,
            solved: None,
            history: Some(Arc::new(history.into())),
            rows: None,
        }
    }

    /// Inertia of the turning frame at the weighted time of a step with an increment, or in which the acceleration
    /// stays.
    fn frame_load(&self, turn: FrameTurn, old: &RingState, dw: Option<&[f64]>) -> Vec<f64> {
        let within = old.within(self.scheme, dw);
        frame_load(&self.body.held, self.body.solver.matrices(), turn, within)
    }
}

impl<S: NodalSolver> StepFactor for NodalFactor<S> {
    fn bytes(&self) -> usize {
        self.columns.bytes()
    }

    fn iterations(&self) -> Option<usize> {
        self.columns.iterations()
    }

    fn predict(&self, from: &RingState, load: KnownLoad) -> Known {
        self.known(from, load, self.of_state(from).1)
    }

    fn begin<'a>(
        &'a self,
        from: &'a RingState,
        known: Arc<Known>,
        contacts: Feet<'_>,
    ) -> Box<dyn ElasticStep + 'a> {
        let (mut laps, mut clock) = (Laps::default(), Stopwatch::start());
        let held = &self.body.held;
        let ports = Ports::new(held, contacts);
        let history = known
            .history
            .as_deref()
            .expect("a step in coordinates is known with its history");
        let mut side = history.to_vec();
        match (known.load.load.as_deref(), known.inertia.as_deref()) {
            (Some(load), Some(f)) => add(&mut side, &combined([1.0; 2], load, f)),
            (Some(load), None) => add(&mut side, load),
            (None, Some(f)) => add(&mut side, f),
            (None, None) => (),
        }
        let start = ports.values_at_start(held, |all| measure(all, from.displacement()));
        laps.add(RIGHT_SIDE, clock.lap());
        let (predictor, moved) = self.columns.begin(held, side, &ports);
        let turn = known.load.turn;
        Box::new(NodalStep {
            factor: self,
            old: from,
            answer: moved.into_answer(start),
            laps,
            inertia: turn.zip(known.inertia.clone()),
            rounds: FrameRounds::new(turn, self.scheme.dt, held.coordinates.n()),
            increment: None,
            predictor,
            ports,
            known,
        })
    }
}

impl<S: NodalSolver> NodalStep<'_, S> {
    fn increment(&self, forces: PortForces<'_>) -> Vec<f64> {
        let (columns, held) = (&self.factor.columns, &self.factor.body.held);
        columns.increment(held, &self.predictor, &self.ports, forces)
    }
}

impl<S: NodalSolver> ElasticStep for NodalStep<'_, S> {
    fn answer(&self) -> &PortAnswer {
        &self.answer
    }

    fn laps(&self) -> &Laps {
        &self.laps
    }

    fn move_contacts(&mut self, contacts: Feet<'_>) -> Laps {
        let (mut laps, mut clock) = (Laps::default(), Stopwatch::start());
        let held = &self.factor.body.held;
        self.ports = Ports::new(held, contacts);
        let old = self.old.displacement();
        let start = self.ports.values_at_start(held, |all| measure(all, old));
        let moved = self
            .factor
            .columns
            .move_contacts(held, &mut self.predictor, &self.ports);
        self.answer = moved.into_answer(start);
        if S::Columns::BY_TABLE {
            laps.add(RACEWAYS, clock.lap());
        }
        laps
    }

    fn at_contacts(&self, x: &[f64]) -> Vec<f64> {
        measure(&self.ports.contacts.iter().collect::<Vec<_>>(), x)
    }

    fn at_seen(&self, x: &[f64]) -> Vec<f64> {
        measure(&self.ports.seen.iter().collect::<Vec<_>>(), x)
    }

    fn settle(&mut self, forces: PortForces<'_>, scale: f64) -> Settling {
        let Some((turn, used)) = &self.inertia else {
            return Settling::Settled;
        };
        let dw = self.increment(forces);
        let new = self.factor.frame_load(*turn, self.old, Some(&dw));
        let change = combined([1.0, -1.0], &new, used);
        let [square, new_square] = [&change, &new].map(|x| dot(x, x));
        if self.rounds.is_settled(&LoadChange { square, new_square }, scale) {
            self.increment = Some(dw);
            return Settling::Settled;
        }
        let (columns, held) = (&self.factor.columns, &self.factor.body.held);
        let moved = columns.add_load(held, &mut self.predictor, change, &self.ports);
        let answers = self.answer.predicted.iter_mut().zip(&moved);
        answers.for_each(|(p, d)| *p += d);
        self.inertia = Some((*turn, Arc::new(new.into())));
        Settling::Again
    }

    fn end(&mut self, forces: PortForces<'_>, _: f64, next: Option<KnownLoad>) -> End {
        let dw = self.increment.take().unwrap_or_else(|| self.increment(forces));
        let work = |load: &[f64]| dot(load, &dw);
        let works = Works {
            load: self.known.load.load.as_deref().map_or(0.0, work),
            frame: self.inertia.as_ref().map_or(0.0, |(_, f)| work(f)),
        };
        let state = self.old.advanced(self.factor.scheme, &dw);
        let (energies, next) = match next {
            Some(load) => {
                let (energies, history) = self.factor.of_state(&state);
                (energies, Some(self.factor.known(&state, load, history)))
            }
            None => (self.factor.body.energies(&state), None),
        };
        End::Done(Box::new(Ended {
            energies,
            next,
            state,
            works,
        }))
    }
}
