//! Contact sites and patches at one instant of a motion.
//!
//! Along the groove a patch follows its contact with *play*, and its size follows the load with play. A patch that followed
//! every oscillation would arrive late by a step each time, off the dent that it made before: the work of moving it feeds the
//! ball's transverse modes, which nothing damps, and they grow without bound (measured: twice the amplitude in 8 ms at steps of
//! 10 us). With play, small oscillations do not move it. A patch that is a little off its contact costs no accuracy: force
//! and measure stay with each other, the groove's shape is exact, and only the structural part of the ring's compliance is
//! taken from a place a tenth of a patch away. Round the ring a patch moves with its ball.

use contact::patch::PatchShape;
use contact::{NodalWeights, Patch, Side};
use rayon::prelude::*;

use super::run::Motion;
use super::state::MotionState;
use crate::error::DynamicsError;
use crate::footprint::{loaded, on_groove, require_on_groove};
use crate::model::elastic;
use crate::problem::Site;

/// Play of a patch along the groove, semi-axes.
const PLAY: f64 = 0.1;
/// Largest load for which a patch is kept, over the present one: 9 % of its size.
const LOAD_PLAY: f64 = 1.3;

/// One contact as it is placed.
struct Placed {
    site: Site,
    weights: Option<NodalWeights>,
    /// Groove angle, rad, and load, N, of the patch.
    place: [f64; 2],
}

/// All contacts as they are placed.
pub(super) struct Placing {
    pub sites: Vec<Site>,
    /// Weights of the patches on each flexible ring.
    pub feet: [Vec<NodalWeights>; 2],
    /// Groove angle, rad, and load, N, of every patch, by site.
    pub places: Vec<[f64; 2]>,
}

impl Motion<'_> {
    /// Contacts at a time.
    pub(super) fn place(&self, state: &MotionState, time: f64) -> Result<Placing, DynamicsError> {
        let placed: Result<Vec<_>, DynamicsError> = loaded(&state.forces)
            .into_par_iter()
            .enumerate()
            .map(|(index, loaded)| self.place_contact(state, (index, loaded), time))
            .collect();
        let mut placing = Placing {
            sites: Vec::new(),
            feet: [Vec::new(), Vec::new()],
            places: Vec::new(),
        };
        for placed in placed? {
            placing.feet[placed.site.side.index()].extend(placed.weights);
            placing.sites.push(placed.site);
            placing.places.push(placed.place);
        }
        Ok(placing)
    }

    /// One contact: its site and, on a flexible ring, its patch.
    fn place_contact(
        &self,
        state: &MotionState,
        (index, loaded): (usize, bool),
        time: f64,
    ) -> Result<Placed, DynamicsError> {
        let model = self.model;
        let (ball, side) = (index / 2, Side::BOTH[index % 2]);
        let azimuth = self.ball_azimuth(ball, time);
        let mut site = Site::new(model, ball, side, azimuth);
        let (Some(ring), Some(body)) = (model.ring(side), &self.rings[side.index()]) else {
            return Ok(Placed {
                site,
                weights: None,
                place: state.places[index],
            });
        };
        let force = state.forces[index][0].hypot(state.forces[index][1]);
        if loaded {
            require_on_groove(&body.surface, ball, state.angles[index])?;
        }
        let angle = on_groove(&body.surface, state.angles[index], loaded);
        let load = state.places[index][1].clamp(force, LOAD_PLAY * force);
        let shape = |angle: f64| {
            PatchShape::new(
                &body.surface,
                azimuth - self.frame_angle(side, time),
                angle,
                model.hertz[side.index()].semi_axes(load),
                model.contact.patch_spacings,
            )
        };
        let mut patch = shape(angle)?;
        let mut place = angle;
        if loaded {
            let play = PLAY * patch.semi_axes[0] / ring.groove.groove_radius;
            place = state.places[index][0].clamp(angle - play, angle + play);
            patch = shape(place)?;
        }
        let patch = Patch::new(
            &body.surface,
            &ring.mesh.nodes,
            &body.rule,
            patch,
            elastic(&ring.material),
        )?;
        site.law.patch_compliance = patch.compliance;
        Ok(Placed {
            site,
            weights: Some(patch.weights),
            place: [place, load],
        })
    }
}
