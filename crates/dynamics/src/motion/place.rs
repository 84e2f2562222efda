//! Contact sites and patches at one instant of a motion.

use contact::patch::PatchShape;
use contact::{NodalWeights, Patch, Side};
use rayon::prelude::*;

use super::run::Motion;
use super::state::MotionState;
use crate::error::DynamicsError;
use crate::footprint::{on_groove, require_on_groove};
use crate::model::elastic;
use crate::problem::Site;

impl Motion<'_> {
    /// Contact sites at a time, and the weights of their patches on each flexible ring.
    pub(super) fn place(
        &self,
        state: &MotionState,
        time: f64,
    ) -> Result<(Vec<Site>, [Vec<NodalWeights>; 2]), DynamicsError> {
        let contacts: Vec<usize> = (0..2 * self.model.geometry.n_balls).collect();
        let placed: Result<Vec<_>, DynamicsError> = contacts
            .par_iter()
            .map(|&index| self.place_contact(state, index, time))
            .collect();
        let (mut sites, mut feet) = (Vec::new(), [Vec::new(), Vec::new()]);
        for (site, weights) in placed? {
            feet[site.side.index()].extend(weights);
            sites.push(site);
        }
        Ok((sites, feet))
    }

    /// One contact: its site and, on a flexible ring, its weights.
    fn place_contact(
        &self,
        state: &MotionState,
        index: usize,
        time: f64,
    ) -> Result<(Site, Option<NodalWeights>), DynamicsError> {
        let model = self.model;
        let (ball, side) = (index / 2, Side::BOTH[index % 2]);
        let azimuth = self.ball_azimuth(ball, time);
        let mut site = Site::new(model, ball, side, azimuth);
        let (Some(ring), Some(body)) = (model.ring(side), &self.rings[side.index()]) else {
            return Ok((site, None));
        };
        let force = state.forces[index];
        let loaded = force != [0.0; 2];
        if loaded {
            require_on_groove(&body.surface, ball, state.angles[index])?;
        }
        let angle = on_groove(&body.surface, state.angles[index], loaded);
        let axes = model.hertz[side.index()].semi_axes(force[0].hypot(force[1]));
        let shape = PatchShape::new(
            &body.surface,
            azimuth - self.frame_angle(side, time),
            angle,
            axes,
            model.contact.patch_spacings,
        )?;
        let patch = Patch::new(
            &body.surface,
            &ring.mesh.nodes,
            &body.rule,
            shape,
            elastic(&ring.material),
        )?;
        site.law.patch_compliance = patch.compliance;
        Ok((site, Some(patch.weights)))
    }
}
