//! A flexible ring over a part of a step by its ports: groove and patch of every contact, on which forces act, and its
//! mount.

use contact::Side;
use ring::ElasticStep;

use super::free_state::FreeState;
use super::run::Motion;
use super::span::PartSpan;
use super::state::MotionState;
use crate::bearing::carrier;
use crate::compliance;
use crate::error::DynamicsError;
use crate::system::{ElasticPorts, Follow};

impl Motion<'_> {
    /// A flexible ring by its ports: contacts move freely, the mount follows its partner. With free balls Newton starts
    /// from ports that go on as in the part before, which saves an iteration.
    pub(super) fn ports(
        &self,
        state: &MotionState,
        span: PartSpan,
        side: Side,
        step: &dyn ElasticStep,
    ) -> Result<ElasticPorts, DynamicsError> {
        let (answer, n_balls) = (step.answer(), self.n_balls());
        let angle = |share: f64| self.frame_angle(side, span.at(share));
        let goes_on = |free: &FreeState| {
            let courses = free.courses.iter().skip(side.index()).step_by(2);
            let velocities = courses.flat_map(|course| course.velocity);
            let ports = answer.start.iter().zip(velocities);
            ports.map(|(at, velocity)| at + span.dt * velocity).collect()
        };
        Ok(ElasticPorts {
            name: side.name(),
            guess: state.free.as_ref().map_or_else(Vec::new, goes_on),
            start: answer.start.clone(),
            offset: answer.predicted.clone(),
            at_forces: Vec::new(),
            stiffness: compliance::inverse(side, answer.start.len(), n_balls, &answer.compliance)?,
            n_moving: self.n_moving(),
            follow: carrier(side, n_balls, self.model.seat().is_some()).map(|body| Follow {
                body,
                frame: [angle(1.0 - self.settings.integrator.alpha_f), angle(1.0)],
            }),
        })
    }

    /// Ports of a flexible ring that move freely.
    fn n_moving(&self) -> usize {
        2 * self.feet_per_contact() * self.n_balls()
    }
}
