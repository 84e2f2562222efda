//! A flexible ring over a part of a step by its ports: groove and patch of every contact, on which forces act, and its
//! mount. The slopes of free balls are only seen: they are no unknowns.

use contact::Side;
use ring::{ElasticStep, PortAnswer};

use super::run::Motion;
use super::span::Span;
use super::state::MotionState;
use crate::bearing::carrier;
use crate::compliance;
use crate::error::DynamicsError;
use crate::interactions::free_contact::{FREE_PORTS, FREE_SEEN};
use crate::system::{ElasticPorts, Follow, SeenMotion};

/// Which functionals of a ring's answer are ports, and which are only seen.
pub(super) struct PortOrder {
    ports: Vec<usize>,
    seen: Vec<usize>,
}

impl PortOrder {
    /// Values of ports, and of what is seen.
    pub fn split(&self, values: &[f64]) -> [Vec<f64>; 2] {
        [&self.ports, &self.seen].map(|places| places.iter().map(|&i| values[i]).collect())
    }

    /// Rows `rows` of the compliance, row-major over ports.
    fn compliance(&self, answer: &PortAnswer, rows: &[usize]) -> Vec<f64> {
        let n = answer.start.len();
        let entry = |&i: &usize| self.ports.iter().map(move |&j| answer.compliance[n * i + j]);
        rows.iter().flat_map(entry).collect()
    }
}

impl Motion<'_> {
    /// The order of the functionals of an answer.
    pub(super) fn order(&self, answer: &PortAnswer) -> PortOrder {
        let (n, n_balls) = (answer.start.len(), self.n_balls());
        let per_ball = 2 * self.feet_per_contact();
        let is_free = self.model.traction().is_some();
        let is_seen = |i: usize| is_free && i < per_ball * n_balls && i % per_ball >= FREE_PORTS;
        let (seen, ports) = (0..n).partition(|&i| is_seen(i));
        PortOrder { ports, seen }
    }

    /// A flexible ring by its ports: contacts move freely, the mount follows its partner.
    pub(super) fn ports(
        &self,
        state: &MotionState,
        span: Span,
        side: Side,
        step: &dyn ElasticStep,
    ) -> Result<ElasticPorts, DynamicsError> {
        let (answer, n_balls) = (step.answer(), self.n_balls());
        let order = self.order(answer);
        let n = order.ports.len();
        let stiffness = match order.seen.is_empty() {
            true => compliance::inverse(side, n, n_balls, &answer.compliance)?,
            false => compliance::inverse(side, n, n_balls, &order.compliance(answer, &order.ports))?,
        };
        let [start, seen_start] = order.split(&answer.start);
        let [offset, seen_offset] = order.split(&answer.predicted);
        let by_forces = order.compliance(answer, &order.seen);
        let angle = |share: f64| self.frame_angle(side, span.at(share));
        Ok(ElasticPorts {
            name: side.name(),
            guess: self.guess((state, span), side, (&order, &start), step),
            start,
            offset,
            at_forces: Vec::new(),
            seen: SeenMotion {
                start: seen_start,
                offset: seen_offset,
                by_ports: product(&by_forces, &stiffness, n),
            },
            stiffness,
            n_moving: self.n_moving(),
            follow: carrier(side, n_balls, self.model.seat().is_some()).map(|body| Follow {
                body,
                frame: [angle(1.0 - self.settings.integrator.alpha_f), angle(1.0)],
            }),
        })
    }

    /// Where Newton starts: with free balls all goes on at the velocity of the start, which saves an iteration.
    fn guess(
        &self,
        (state, span): (&MotionState, Span),
        side: Side,
        (order, start): (&PortOrder, &[f64]),
        step: &dyn ElasticStep,
    ) -> Vec<f64> {
        let ring = state.rings[side.index()].as_ref();
        let Some(ring) = ring.filter(|_| !order.seen.is_empty()) else {
            return Vec::new();
        };
        let velocity = step.at_contacts(ring.velocity());
        let contacts = order.ports[..self.n_moving()].iter().zip(start);
        contacts.map(|(&i, at)| at + span.dt * velocity[i]).collect()
    }

    /// Ports of a flexible ring that move freely.
    fn n_moving(&self) -> usize {
        let seen = if self.model.traction().is_some() {
            FREE_SEEN
        } else {
            0
        };
        (2 * self.feet_per_contact() - seen) * self.n_balls()
    }
}

/// A B of row-major matrices, B `[n][n]`.
fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut all = vec![0.0; a.len()];
    for (sum, row) in all.chunks_exact_mut(n.max(1)).zip(a.chunks_exact(n.max(1))) {
        for (factor, b) in row.iter().zip(b.chunks_exact(n)) {
            sum.iter_mut().zip(b).for_each(|(sum, b)| *sum += factor * b);
        }
    }
    all
}
