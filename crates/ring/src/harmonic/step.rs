//! A step of a ring in harmonic space, around its pass over the harmonics ([`super::pass`]): its contacts meet the
//! predictor, their forces make the increment.

use std::sync::Arc;

use timer::{Laps, Stopwatch};

use super::defect_step::{DefectFactor, DefectStep};
use super::factor::CyclicFactor;
use super::harmonics::HarmonicBody;
use super::pass::{Acting, Increment, Pass, Turned};
use super::space_defect::{SpaceDefect, Terms};
use super::touch::Meeting;
use crate::integrator::StepScheme;
use crate::nodal::columns::{Moved, Ports};
use crate::pool::PooledVector;
use crate::settling::FrameRounds;
use crate::state::{RingState, RowValues, within_part};
use crate::step::{
    ElasticStep, End, Ended, Feet, FrameTurn, Known, KnownLoad, PortAnswer, PortForces, RACEWAYS, Settling,
    StepFactor, Works,
};
use crate::vectors::{add, combined, dot, sum};

/// The factor of one ring at one step size.
pub(super) struct HarmonicFactor {
    body: Arc<HarmonicBody>,
    factor: CyclicFactor,
    scheme: StepScheme,
}

/// A step under way.
struct HarmonicStep<'a> {
    factor: &'a HarmonicFactor,
    old: &'a RingState,
    known: Arc<Known>,
    /// Values of the start on the rows of a defect.
    rows: Option<Arc<RowValues>>,
    ports: Ports,
    /// Of the regular ring, the first half of its solve, harmonics and the rows of the border.
    predictor: Arc<PooledVector>,
    /// What a defect makes of it.
    defect: Option<DefectStep>,
    answer: PortAnswer,
    laps: Laps,
    /// Inertia of the turning frame that acts.
    inertia: Option<(FrameTurn, Arc<PooledVector>)>,
    rounds: FrameRounds,
}

impl HarmonicFactor {
    pub fn new(body: Arc<HarmonicBody>, factor: CyclicFactor, scheme: StepScheme) -> HarmonicFactor {
        HarmonicFactor { body, factor, scheme }
    }

    fn pass(&self) -> Pass<'_> {
        Pass {
            space: &self.body.space,
            nodes: self.body.nodes(),
            factor: &self.factor,
            scheme: self.scheme,
            history: self.body.held.history(self.scheme),
        }
    }

    /// Rows of a defect in a step from `start` with the regular ring's predictor; `answers` is V, `moved` the motion
    /// of the rows that the inertia of the frame is to fit, where its acceleration does not stay that of the start.
    fn defect_step(
        &self,
        (of_space, defect): (&SpaceDefect, &DefectFactor),
        (start, turn, moved): (&RowValues, Option<FrameTurn>, Option<&[f64]>),
        predictor: &[f64],
        answers: Vec<f64>,
    ) -> DefectStep {
        let held = &self.body.held;
        let terms = Terms {
            history: held.history(self.scheme),
            effective: held.effective(self.scheme),
        };
        let mut known = of_space.known(terms, start, predictor);
        let inertia = turn.map_or(Vec::new(), |turn| {
            let RowValues(start) = start;
            let start = start.each_ref().map(Vec::as_slice);
            let [mut w, mut v] = [(); 2].map(|()| vec![0.0; start[0].len()]);
            within_part(self.scheme, moved, start, [&mut w, &mut v]);
            of_space.inertia(turn, [&w, &v])
        });
        // Of the inertia there are rows of the regular ring as well.
        known.iter_mut().zip(&inertia).for_each(|(q, f)| *q += f);
        DefectStep::under(&defect.answer, known, inertia, answers)
    }

    /// The defect in harmonic space and of the factor; a ring has both or none.
    fn defect(&self) -> Option<(&SpaceDefect, &DefectFactor)> {
        let of_space = self.body.space.defect.as_ref();
        of_space.zip(self.factor.responses.defect.as_ref())
    }
}

impl StepFactor for HarmonicFactor {
    fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    fn iterations(&self) -> Option<usize> {
        self.factor.iterations()
    }

    fn predict(&self, from: &RingState, load: KnownLoad) -> Known {
        let predicted = self.pass().predict(from, &load);
        let defect = self.body.space.defect.as_ref();
        Known {
            of: from.stamp().clone(),
            inertia: load.turn.map(|_| Arc::new(predicted.inertia)),
            load,
            solved: Some(Arc::new(predicted.solved)),
            history: None,
            rows: defect.map(|defect| Arc::new(defect.of_state(from))),
        }
    }

    fn begin<'a>(
        &'a self,
        from: &'a RingState,
        known: Arc<Known>,
        contacts: Feet<'_>,
    ) -> Box<dyn ElasticStep + 'a> {
        let mut clock = Stopwatch::start();
        let held = &self.body.held;
        let solved = known.solved.clone();
        let predictor = solved.expect("a ring in harmonic space predicts by its pass");
        let turn = known.load.turn;
        let mut step = HarmonicStep {
            factor: self,
            old: from,
            rows: known.rows.clone(),
            ports: Ports::new(held, contacts),
            inertia: turn.zip(known.inertia.clone()),
            rounds: FrameRounds::new(turn, self.scheme.dt, held.coordinates.n()),
            predictor,
            defect: None,
            answer: PortAnswer::default(),
            laps: Laps::default(),
            known,
        };
        let Meeting { step: defect, moved } = {
            let rows = step.rows.as_deref();
            self.factor
                .meet(held, &step.ports, &step.predictor, |defect, answers| {
                    let of_space = self.body.space.defect.as_ref();
                    let of_space = of_space.expect("it has the defect of its ring");
                    let rows = rows.expect("rows of a defect are found with the predictor");
                    let from = (rows, turn, None);
                    self.defect_step((of_space, defect), from, &step.predictor, answers)
                })
        };
        step.defect = defect;
        step.answer_with(moved);
        step.laps.add(RACEWAYS, clock.lap());
        Box::new(step)
    }
}

impl HarmonicStep<'_> {
    /// Values of functionals on what contacts and partner touch.
    fn measure(&self, x: &[f64]) -> Vec<f64> {
        let (held, factor) = (&self.factor.body.held, &self.factor.factor);
        self.ports.values(held, |all| factor.measure(x, all))
    }

    /// Takes what the ports see of the predictor.
    fn answer_with(&mut self, moved: Moved) {
        let (held, factor) = (&self.factor.body.held, &self.factor.factor);
        let old = self.old.displacement();
        let start = self.ports.values_at_start(held, |all| factor.measure(old, all));
        self.answer = moved.into_answer(start);
    }

    /// The increment under these forces, before it is solved for.
    fn forces(&self, forces: PortForces<'_>) -> Increment<'_> {
        let factor = &self.factor.factor;
        let by_defect = factor.by_defect(self.defect.as_ref(), forces);
        let loads = self.ports.loads(&self.factor.body.held, forces).chain(by_defect);
        Increment {
            forces: factor.forces(loads),
            rest: &self.predictor,
        }
    }

    /// Goes on with another predictor; `moved` is the motion of the rows of a defect that its inertia fits.
    fn replace_predictor(&mut self, predictor: Arc<PooledVector>, moved: Option<Vec<f64>>) {
        self.answer.predicted = sum(&self.answer.start, &self.measure(&predictor));
        if let (Some(old), Some(defect)) = (self.defect.take(), self.factor.defect()) {
            let rows = self.rows.as_deref();
            let rows = rows.expect("rows of a defect are found with the predictor");
            let turn = self.inertia.as_ref().map(|(turn, _)| *turn);
            let from = (rows, turn, moved.as_deref());
            let new = self
                .factor
                .defect_step(defect, from, &predictor, old.into_answers());
            add(&mut self.answer.predicted, &new.motion(&defect.1.answer));
            self.defect = Some(new);
        }
        self.predictor = predictor;
    }

    /// Adds a load to the predictor; one solve.
    fn add_load(&mut self, mut load: Vec<f64>) {
        let factor = &self.factor.factor;
        factor.begin_in_place(&mut load);
        let whole: &mut PooledVector = Arc::make_mut(&mut self.predictor);
        add(whole, &load);
        let mut moved = self.measure(&load);
        if let (Some(defect), Some(step)) = (&factor.responses.defect, &mut self.defect) {
            let corrected = step.add(&defect.answer, &factor.at_rows(&defect.answer, &load));
            moved.iter_mut().zip(corrected).for_each(|(m, d)| *m += d);
        }
        let answers = self.answer.predicted.iter_mut().zip(&moved);
        answers.for_each(|(p, d)| *p += d);
    }

    /// Goes on with the inertia and the predictor of a trial.
    fn go_on(&mut self, turned: Turned, scale: f64) {
        self.rounds.advance(&turned.change, scale);
        self.replace_predictor(Arc::new(turned.predictor), turned.rows);
        if let Some((_, used)) = &mut self.inertia {
            *used = Arc::new(turned.inertia);
        }
    }

    /// Goes on with another inertia than the one that acted, after a step has ended with the values `rows` of a defect.
    fn replace_inertia(&mut self, new: &PooledVector, rows: Option<&RowValues>) {
        let Some((turn, used)) = &self.inertia else { return };
        let (turn, change) = (*turn, combined([1.0, -1.0], new, used));
        self.add_load(change);
        if let Some(moved) = self.moved_rows(rows) {
            self.replace_predictor(self.predictor.clone(), Some(moved));
        }
        self.inertia = Some((turn, Arc::new(new.to_vec().into())));
        self.rounds.reopen();
    }

    /// Motion of the rows of a defect from the start of the step to these values.
    fn moved_rows(&self, end: Option<&RowValues>) -> Option<Vec<f64>> {
        let (RowValues([new, ..]), RowValues([old, ..])) = (end?, self.rows.as_deref()?);
        Some(combined([1.0, -1.0], new, old))
    }

    /// Work of the inertia of the turning frame on the rows of a defect, J, beyond that of the regular ring's.
    fn frame_work(&self, end: Option<&RowValues>) -> f64 {
        match &self.defect {
            Some(step) if !step.inertia().is_empty() => {
                dot(step.inertia(), &self.moved_rows(end).unwrap_or_default())
            }
            _ => 0.0,
        }
    }
}

impl ElasticStep for HarmonicStep<'_> {
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
        let old = self.defect.take();
        let Meeting { step, moved } =
            self.factor
                .factor
                .meet(held, &self.ports, &self.predictor, |_, answers| {
                    old.expect("a ring keeps its defect").met_by(answers)
                });
        self.defect = step;
        self.answer_with(moved);
        laps.add(RACEWAYS, clock.lap());
        laps
    }

    fn at_contacts(&self, x: &[f64]) -> Vec<f64> {
        let contacts: Vec<_> = self.ports.contacts.iter().collect();
        self.factor.factor.measure(x, &contacts)
    }

    fn at_seen(&self, x: &[f64]) -> Vec<f64> {
        let seen: Vec<_> = self.ports.seen.iter().collect();
        self.factor.factor.measure(x, &seen)
    }

    fn settle(&mut self, forces: PortForces<'_>, scale: f64) -> Settling {
        let Some((turn, used)) = self.inertia.as_ref().filter(|_| self.rounds.is_open()) else {
            return Settling::Settled;
        };
        let increment = self.forces(forces);
        let turned = self
            .factor
            .pass()
            .turn(self.old, increment, (*turn, used), &self.predictor);
        if self.rounds.is_settled(&turned.change, scale) {
            self.rounds.close();
            return Settling::Settled;
        }
        self.go_on(turned, scale);
        Settling::Again
    }

    fn end(&mut self, forces: PortForces<'_>, scale: f64, next: Option<KnownLoad>) -> End {
        let turn = self.inertia.as_ref().map(|(turn, _)| *turn);
        let checked = turn.filter(|_| self.rounds.is_checked_at_end());
        let acting = Acting {
            load: self.known.load.load.as_deref(),
            inertia: self.inertia.as_ref().map(|(_, f)| &f[..]),
            turn: checked,
        };
        let ended = self
            .factor
            .pass()
            .end(self.old, self.forces(forces), acting, next.as_ref());
        let (new, change) = &ended.renewed;
        if checked.is_some() && !self.rounds.is_settled(change, scale) {
            self.replace_inertia(new, ended.rows.as_ref());
            return End::Again;
        }
        let works = Works {
            load: ended.works[0],
            frame: ended.works[1] + self.frame_work(ended.rows.as_ref()),
        };
        let rows = ended.rows.map(Arc::new);
        let next = next.zip(ended.next).map(|(load, predicted)| Known {
            of: ended.state.stamp().clone(),
            inertia: load.turn.map(|_| Arc::new(predicted.inertia)),
            load,
            solved: Some(Arc::new(predicted.solved)),
            history: None,
            rows,
        });
        End::Done(Box::new(Ended {
            state: ended.state,
            works,
            energies: ended.energies,
            next,
        }))
    }
}
