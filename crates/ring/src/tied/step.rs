//! A step of a ring and the body to which it is tied.

use std::sync::Arc;

use body::{N_SHAFT, SeatModes, lane_dot, length};
use dense::{DenseCholesky, DenseError};
use timer::Laps;

use crate::oscillators::{BodyFactor, BodyFrame, BodyStep, ShaftSoftness};
use crate::state::{BodyState, RingState};
use crate::step::{
    BodyAlone, ElasticStep, End, Feet, Known, KnownLoad, PortAnswer, PortForces, Settling, StepFactor,
};
use crate::vectors::sum;

/// Factors of ring and joint at one step size.
pub(super) struct TiedFactor {
    pub body: BodyFactor,
    pub ring: Arc<dyn StepFactor>,
    /// A, where the body carries other rings.
    pub seat: Option<Vec<f64>>,
    /// A + D.
    pub joint: DenseCholesky,
    pub shaft: TiedShaft,
}

/// The shaft that carries the body; of a body that stands all is empty.
#[derive(Default)]
pub(super) struct TiedShaft {
    /// E, `[n_shaft][n_functions]` flat.
    of_seat: Vec<f64>,
    /// (A + D)^-1 E^T, `[n_shaft][n_functions]` flat.
    joint: Vec<f64>,
    /// Motion of the shaft under its own forces, the ring on the body, `[n_shaft][n_shaft]` flat.
    own: Vec<f64>,
    /// Forces of the shaft on the body without the ring, by its motion, `[n_shaft][n_shaft]` flat.
    alone: Vec<f64>,
    n: usize,
}

impl TiedShaft {
    /// From what the shaft does to the body alone, and A + D.
    pub fn new(body: ShaftSoftness, joint: &DenseCholesky) -> Result<TiedShaft, DenseError> {
        if body.own.is_empty() {
            return Ok(TiedShaft::default());
        }
        let (width, n) = (joint.n(), N_SHAFT);
        let mut solved = body.of_seat.clone();
        joint.solve(&mut solved, n);
        let alone = DenseCholesky::factor(n, &body.own)?.inverse();
        let mut own = body.own;
        for i in 0..n {
            for j in 0..=i {
                let [e, x] =
                    [(&body.of_seat, i), (&solved, j)].map(|(of, k)| &of[width * k..width * (k + 1)]);
                let value = own[n * i + j] - lane_dot(e, x);
                (own[n * i + j], own[n * j + i]) = (value, value);
            }
        }
        Ok(TiedShaft {
            of_seat: body.of_seat,
            joint: solved,
            own,
            alone,
            n,
        })
    }
}

/// Change of the inertia of a turning frame over the size of the loads at which it stays as it is.
const LIMIT: f64 = 1e-11;
/// The same where rounds no longer contract.
const FLOOR: f64 = 1e-6;
/// A round that leaves more than this of the change before it no longer contracts.
const STALLED: f64 = 0.5;

/// A step under way.
struct TiedStep<'a> {
    factor: &'a TiedFactor,
    ring: Box<dyn ElasticStep + 'a>,
    old: &'a BodyState,
    body: BodyStep,
    /// Motion of the seat at the end without loads of others on the body, m.
    own_seat: Vec<f64>,
    /// Motion of the shaft at the end without loads of others on the body or forces of the shaft.
    unloaded: Vec<f64>,
    /// The same with the loads of others, but without what turns the ring.
    alone: Vec<f64>,
    /// Mean load of others on the oscillators; empty: none.
    others: Vec<f64>,
    /// The same of a load on all of the body, by its weight and by its turning.
    on_body: [Vec<f64>; 2],
    /// Their sum.
    of_body: Vec<f64>,
    /// Inertia of the turning frame of the body; None where it does not turn.
    frame: Option<BodyFrame>,
    answer: PortAnswer,
    /// B, `[n_ports][n_functions]` flat.
    coupling: Vec<f64>,
    /// lam without forces on the contacts, N.
    known: Vec<f64>,
    /// (A + D)^-1 B, `[n_ports][n_functions]` flat.
    by_port: Vec<f64>,
}

impl StepFactor for TiedFactor {
    fn bytes(&self) -> usize {
        let n = self.body.body.n_functions();
        let seat = self.seat.as_ref().map_or(0, Vec::len);
        self.ring.bytes() + size_of::<f64>() * (n * n + seat)
    }

    fn seat_compliance(&self) -> Option<&[f64]> {
        self.seat.as_deref()
    }

    fn body_compliance(&self, seat: &SeatModes) -> Option<Vec<f64>> {
        Some(self.body.softness_by(seat, &self.shaft.alone))
    }

    fn iterations(&self) -> Option<usize> {
        self.ring.iterations()
    }

    fn predict(&self, from: &RingState, load: KnownLoad) -> Known {
        self.ring.predict(from, load)
    }

    fn begin<'a>(
        &'a self,
        from: &'a RingState,
        known: Arc<Known>,
        contacts: Feet<'_>,
    ) -> Box<dyn ElasticStep + 'a> {
        let old = from
            .body()
            .expect("the state of a tied ring has that of its body");
        let frame = self.body.frame(known.load.body_turn, old);
        let on_body = self.body.body.on_oscillators(known.load.body_load);
        let of_body = summed(&on_body[0], &on_body[1]);
        let mut step = TiedStep {
            factor: self,
            ring: self.ring.begin(from, known, contacts),
            unloaded: Vec::new(),
            alone: Vec::new(),
            others: Vec::new(),
            frame,
            body: self.body.step(old, &of_body),
            of_body,
            on_body,
            own_seat: Vec::new(),
            old,
            answer: PortAnswer::default(),
            coupling: Vec::new(),
            known: Vec::new(),
            by_port: Vec::new(),
        };
        step.unloaded.clone_from(&step.body.shaft[1]);
        step.alone.clone_from(&step.body.shaft[1]);
        step.own_seat.clone_from(&step.body.seat);
        if step.frame.is_some() {
            step.step_body();
        }
        step.meet();
        Box::new(step)
    }
}

impl TiedStep<'_> {
    /// What the contacts see of ring and body from what the ports of the ring see.
    fn meet(&mut self) {
        let (ring, n) = (self.ring.answer(), self.body.seat.len());
        let (size, shaft) = (ring.start.len(), &self.factor.shaft);
        let ports = size - n;
        let all = ports + shaft.n;
        let row = |i: usize| &ring.compliance[size * i..size * (i + 1)];
        let coupling: Vec<f64> = (0..ports).flat_map(|i| &row(i)[ports..]).copied().collect();
        let mut by_port = coupling.clone();
        self.factor.joint.solve(&mut by_port, ports);
        let rows: Vec<&[f64]> = coupling.chunks_exact(n).collect();
        let solved: Vec<&[f64]> = by_port.chunks_exact(n).collect();
        let mut compliance = vec![0.0; all * all];
        for i in 0..ports {
            for j in 0..=i {
                let value = row(i)[j] - lane_dot(rows[i], solved[j]);
                (compliance[all * i + j], compliance[all * j + i]) = (value, value);
            }
        }
        for k in 0..shaft.n {
            let by_shaft = &shaft.joint[n * k..n * (k + 1)];
            for (i, row) in rows.iter().enumerate() {
                let value = lane_dot(row, by_shaft);
                (compliance[all * i + ports + k], compliance[all * (ports + k) + i]) = (value, value);
            }
            let own = &shaft.own[shaft.n * k..shaft.n * (k + 1)];
            compliance[all * (ports + k) + ports..all * (ports + k + 1)].copy_from_slice(own);
        }
        self.answer = PortAnswer {
            start: [&ring.start[..ports], &self.body.shaft[0]].concat(),
            seen: ring.seen.clone(),
            predicted: Vec::new(),
            compliance,
        };
        (self.coupling, self.by_port) = (coupling, by_port);
        self.predict();
    }

    /// What the contacts see without forces on them, from what ring and body do by themselves.
    fn predict(&mut self) {
        let (ring, n) = (self.ring.answer(), self.body.seat.len());
        let ports = ring.start.len() - n;
        let gaps = self.body.seat.iter().zip(&ring.predicted[ports..]);
        let mut known: Vec<f64> = gaps.map(|(y, g)| y - g).collect();
        self.factor.joint.solve(&mut known, 1);
        let rows = ring.predicted.iter().zip(self.coupling.chunks_exact(n));
        self.answer.predicted = rows.map(|(p, row)| p + lane_dot(row, &known)).collect();
        let of_seat = self.factor.shaft.of_seat.chunks_exact(n);
        let shaft = self.body.shaft[1].iter().zip(of_seat);
        self.answer
            .predicted
            .extend(shaft.map(|(q, e)| q - lane_dot(e, &known)));
        self.known = known;
    }

    /// The body under all loads that are known.
    fn step_body(&mut self) {
        let factor = &self.factor.body;
        let Some(frame) = &self.frame else {
            self.body = factor.step(self.old, &summed(&self.of_body, &self.others));
            self.alone.clone_from(&self.body.shaft[1]);
            return;
        };
        let mut load = summed(&frame.load, &self.of_body);
        let shaft_at_end = |load: &[f64]| factor.step(self.old, load).shaft[1].clone();
        let unloaded = shaft_at_end(&load);
        load.iter_mut().zip(&self.others).for_each(|(sum, p)| *sum += p);
        let alone = shaft_at_end(&load);
        load.iter_mut().zip(&frame.of_ring).for_each(|(sum, p)| *sum += p);
        self.body = factor.step(self.old, &load);
        (self.unloaded, self.alone) = (unloaded, alone);
    }

    /// A round for the inertia of the turning frame of the body under these forces.
    fn settle_body(&mut self, forces: PortForces<'_>, lam: &[f64]) -> Settling {
        let factor = &self.factor.body;
        let Some(frame) = &mut self.frame else {
            return Settling::Settled;
        };
        let moved = factor.advanced(self.old, &self.body, lam, forces.mount);
        let [load, of_ring] = factor.frame_between(frame.turn, [self.old, &moved]);
        let off = |a: &[f64], b: &[f64]| length(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
        let size = length(&load) + length(&of_ring) + length(&factor.body.modes.loads(lam));
        let change = off(&load, &frame.load) + off(&of_ring, &frame.of_ring);
        let change = change / size.max(f64::MIN_POSITIVE);
        let stalls = change > STALLED * frame.change && change <= FLOOR;
        if change <= LIMIT || stalls {
            return Settling::Settled;
        }
        (frame.load, frame.of_ring, frame.change) = (load, of_ring, change);
        self.step_body();
        self.predict();
        Settling::Again
    }

    /// Forces of the joint on the ring under forces on the contacts, and of the shaft on the body, N.
    fn joint(&self, forces: PortForces<'_>) -> Vec<f64> {
        let mut lam = self.known.clone();
        for (by_port, force) in self.by_port.chunks_exact(lam.len()).zip(forces.contacts) {
            lam.iter_mut().zip(by_port).for_each(|(l, b)| *l -= force * b);
        }
        let by_shaft = self.factor.shaft.joint.chunks_exact(lam.len());
        for (by_shaft, force) in by_shaft.zip(forces.mount) {
            lam.iter_mut().zip(by_shaft).for_each(|(l, b)| *l += force * b);
        }
        lam
    }
}

impl ElasticStep for TiedStep<'_> {
    fn answer(&self) -> &PortAnswer {
        &self.answer
    }

    fn laps(&self) -> &Laps {
        self.ring.laps()
    }

    fn move_contacts(&mut self, contacts: Feet<'_>) -> Laps {
        let laps = self.ring.move_contacts(contacts);
        self.meet();
        laps
    }

    fn forces_of_joint(&self, forces: PortForces<'_>) -> Option<Vec<f64>> {
        Some(self.joint(forces))
    }

    fn load_on_body(&self, joint: &[f64]) -> Vec<f64> {
        let mut load = self.factor.body.body.modes.loads(joint);
        load.iter_mut().for_each(|p| *p = -*p);
        // What turns the ring goes through its seat too.
        if let Some(frame) = &self.frame {
            load.iter_mut().zip(&frame.of_ring).for_each(|(p, f)| *p += f);
        }
        load
    }

    fn load_body(&mut self, load: &[f64]) {
        self.others = load.to_vec();
        self.step_body();
        self.predict();
    }

    fn move_seat(&mut self, motion: &[f64]) {
        let seat = self.own_seat.iter().zip(motion);
        self.body.seat = seat.map(|(own, by_others)| own + by_others).collect();
        self.predict();
    }

    fn body_alone(&self) -> Option<BodyAlone> {
        let stiffness = &self.factor.shaft.alone;
        (!stiffness.is_empty()).then(|| BodyAlone {
            stiffness: stiffness.clone(),
            predicted: self.alone.clone(),
            unloaded: self.unloaded.clone(),
        })
    }

    fn force_of_body(&self, forces: PortForces<'_>) -> Option<[f64; 5]> {
        let modes = &self.factor.body.body.modes;
        let shaft = modes.on_shaft.as_ref()?;
        let lam = self.joint(forces);
        let rigid = modes.rows().take(N_SHAFT).map(|row| lane_dot(row, &lam));
        Some(shaft.resultant(&rigid.collect::<Vec<_>>()))
    }

    fn at_contacts(&self, x: &[f64]) -> Vec<f64> {
        self.ring.at_contacts(x)
    }

    fn at_seen(&self, x: &[f64]) -> Vec<f64> {
        self.ring.at_seen(x)
    }

    fn settle(&mut self, forces: PortForces<'_>, scale: f64) -> Settling {
        let lam = self.joint(forces);
        let of_body = self.settle_body(forces, &lam);
        if of_body == Settling::Again {
            return of_body;
        }
        let settling = self.ring.settle(on_both(forces, &lam), scale);
        if settling == Settling::Again {
            self.meet();
        }
        settling
    }

    fn end(&mut self, forces: PortForces<'_>, scale: f64, next: Option<KnownLoad>) -> End {
        let lam = self.joint(forces);
        match self.ring.end(on_both(forces, &lam), scale, next) {
            End::Done(mut ended) => {
                let factor = &self.factor.body;
                let moved = factor.advanced(self.old, &self.body, &lam, forces.mount);
                let work = |load: &[f64]| -> f64 {
                    let change = moved.0[0].iter().zip(&self.old.0[0]);
                    change.zip(load).map(|((b, a), f)| f * (b - a)).sum()
                };
                let [weight, turning] = &self.on_body;
                ended.works.load += work(weight);
                ended.works.frame += work(turning);
                if let Some(frame) = &self.frame {
                    ended.works.frame += work(&summed(&frame.load, &frame.of_ring));
                }
                let [kinetic, strain] = factor.body.energies(Some(&moved));
                ended.energies[0] += kinetic;
                ended.energies[1] += strain;
                ended.state = std::mem::take(&mut ended.state).with_body(Some(moved));
                End::Done(ended)
            }
            End::Again => {
                self.meet();
                End::Again
            }
        }
    }
}

/// The sum of two loads on oscillators, each of which may be empty: none.
fn summed(a: &[f64], b: &[f64]) -> Vec<f64> {
    match (a, b) {
        (a, []) => a.to_vec(),
        ([], b) => b.to_vec(),
        (a, b) => sum(a, b),
    }
}

/// The forces at the ports of the ring: those of the contacts, and of the joint.
fn on_both<'f>(forces: PortForces<'f>, joint: &'f [f64]) -> PortForces<'f> {
    PortForces {
        contacts: forces.contacts,
        mount: joint,
    }
}
