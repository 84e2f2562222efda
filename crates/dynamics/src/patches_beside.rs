//! Patches of a flexible ring beside those of an equilibrium: what changes as they move and grow.

use std::collections::BTreeMap;

use contact::{Meridian, NodalWeights, Side};

use crate::error::DynamicsError;
use crate::footprint::place;
use crate::interactions::raceway_contact::{RacewayContacts, Site, SiteState, on_rings};
use crate::model::Model;
use crate::raceway::Raceway;

/// Step of a contact angle, rad: a small part of an element across the groove.
const ANGLE_STEP: f64 = 1e-3;
/// Step of a force over it.
const SIZE_STEP: f64 = 1e-2;

/// In what a patch changes: its contact angle, rad, and the force after which it has its size, N.
pub(crate) const KINDS: [usize; 2] = [0, 1];

/// Contacts of a bearing that stand, and the time, s, of its temperatures.
pub(crate) struct StandingContacts<'a> {
    pub model: &'a Model,
    pub time: f64,
    pub contacts: &'a RacewayContacts,
    pub states: &'a [SiteState],
}

/// One place of all patches of a ring.
struct Beside {
    contacts: RacewayContacts,
    weights: Vec<NodalWeights>,
}

/// The patches of a ring before and after each of the [`KINDS`].
pub(crate) struct PatchesBeside {
    side: Side,
    kinds: [[Beside; 2]; 2],
    /// Sizes of the forces by ball, N.
    sizes: Vec<f64>,
}

impl PatchesBeside {
    /// Of the ring on a side.
    pub(crate) fn new(
        standing: &StandingContacts<'_>,
        side: Side,
        raceway: &Raceway,
    ) -> Result<PatchesBeside, DynamicsError> {
        // Without loads beside those of contacts.
        let forces = on_rings(standing.states);
        let at = |angle: f64, size: f64| standing.beside((side, raceway), angle, (&forces, size));
        let own = forces.iter().skip(side.index()).step_by(2);
        Ok(PatchesBeside {
            side,
            kinds: [
                [at(-ANGLE_STEP, 1.0)?, at(ANGLE_STEP, 1.0)?],
                [at(0.0, 1.0 - SIZE_STEP)?, at(0.0, 1.0 + SIZE_STEP)?],
            ],
            sizes: own.map(|force| force.norm()).collect(),
        })
    }

    /// Whether the ball presses on the ring.
    pub(crate) fn is_loaded(&self, ball: usize) -> bool {
        self.sizes[ball] > 0.0
    }

    /// Size of the force of a ball, N.
    pub(crate) fn size(&self, ball: usize) -> f64 {
        self.sizes[ball]
    }

    /// Distance of the two places of a loaded patch.
    pub(crate) fn step(&self, kind: usize, ball: usize) -> f64 {
        match kind {
            0 => 2.0 * ANGLE_STEP,
            _ => 2.0 * SIZE_STEP * self.sizes[ball],
        }
    }

    /// A contact with its patch at the two places.
    pub(crate) fn sites(&self, kind: usize, ball: usize) -> [&Site; 2] {
        let site = 2 * ball + self.side.index();
        self.kinds[kind]
            .each_ref()
            .map(|place| &place.contacts.sites[site])
    }

    /// Growth of the motion of the groove that a loaded patch measures in a field of the ring: m per unit of the kind.
    pub(crate) fn growth_of_motion(&self, kind: usize, ball: usize, field: &[f64]) -> Meridian {
        let at = self.weights(kind, ball).map(|weights| weights.measure(field));
        let [low, high] = at.map(Meridian::from);
        (high - low).map(|change| change / self.step(kind, ball))
    }

    /// The load dw f of a loaded patch that moves under a force, per radian, as the first direction, and per newton of
    /// its size as the second.
    pub(crate) fn growth_of_load(&self, ball: usize, force: Meridian) -> NodalWeights {
        let mut sums: BTreeMap<usize, [[f64; 3]; 2]> = BTreeMap::new();
        for kind in KINDS {
            let step = self.step(kind, ball);
            for (weights, sign) in self.weights(kind, ball).into_iter().zip([-1.0, 1.0]) {
                for (&node, [radial, axial]) in weights.nodes.iter().zip(&weights.coefficients) {
                    let sum = &mut sums.entry(node).or_default()[kind];
                    for i in 0..3 {
                        sum[i] += sign * (radial[i] * force.radial + axial[i] * force.axial) / step;
                    }
                }
            }
        }
        let (nodes, coefficients) = sums.into_iter().unzip();
        NodalWeights { nodes, coefficients }
    }

    fn weights(&self, kind: usize, ball: usize) -> [&NodalWeights; 2] {
        self.kinds[kind].each_ref().map(|place| &place.weights[ball])
    }
}

impl StandingContacts<'_> {
    /// Patches at contact angles that are larger by `angle` and of forces `size` times as large.
    fn beside(
        &self,
        (side, raceway): (Side, &Raceway),
        angle: f64,
        (forces, size): (&[Meridian], f64),
    ) -> Result<Beside, DynamicsError> {
        let mounting = self.model.mounting.at(self.time);
        let mut states = self.states.to_vec();
        states.iter_mut().for_each(|state| state.angle += angle);
        let forces: Vec<Meridian> = forces.iter().map(|f| f.map(|x| size * x)).collect();
        let mut contacts = self.contacts.clone();
        let feet = place(
            self.model,
            &mounting,
            side,
            raceway,
            &mut contacts,
            &states,
            &forces,
        )?;
        Ok(Beside {
            contacts,
            weights: feet.into_iter().map(|foot| foot.weights).collect(),
        })
    }
}
