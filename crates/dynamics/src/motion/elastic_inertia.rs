//! Whether the inertia of a turning ring's elastic part acts, or is nothing and left out.
//!
//! Of the loads of a turning frame ([`crate::effects::frame_rotation`]) those on the undeformed ring are known, and
//! those of its rigid motion act on the shaft ([`crate::bodies::FrameInertia`]). What is left is that of the elastic
//! part u_e: centrifugal, Coriolis and Euler forces on it, which depend on the motion and take rounds in every step.
//! Beside the stiffness they are of the order
//!
//! ```text
//! |W^2 M u_e|  <=  (W / w_1)^2 |K u_e|          in the norm of M^-1, w_1 the first natural frequency as held
//! ```
//!
//! the Euler force W' / w_1^2, and the Coriolis force on a shape of n waves that stands in space 2 n times the first.
//! Where (W^2 + W') / w_1^2 stays below a limit of the scene for the largest speed and acceleration, they are left out:
//! the step is that of a frame that stands, under the load of the undeformed ring. Free vibrations feel the Coriolis
//! force to first order: their frequencies lack a splitting by up to 2 W / w_1 of themselves.
//!
//! An upper bound of w_1 comes first, at next to no cost. Only where it does not decide the ring is asked whether w_1
//! is above the limit ([`ring::first_frequency`]). The choice follows from scene and meshes alone: the largest speed is
//! that of the whole table of speeds, however long the run.
//! These rings keep all: free ones and those tied to a body, whose rigid motion the shaft does not take; those whose
//! stress stiffens them, because the scene asks for that; and those on a shaft that moves across its axis whose own
//! inertia is not that of a body of revolution, as `FrameInertia` has it.

use contact::Side;
use ring::first_frequency::{FrequencyBounds, first_frequency_above, first_frequency_bound};
use ring::statics::StaticSettings;
use ring::{ElasticBody, Frame, FrameTurn, Hold, RingModel};

use super::mass_load::mass_load;
use crate::bearing::partner;
use crate::error::DynamicsError;
use crate::model::{InertiaLimit, Model};

/// Inertia of a ring's elastic part that is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// First natural frequency of the ring as it is held, rad/s.
    pub first_frequency: FrequencyBounds,
    /// Largest speed and acceleration, and the share of the forces below which nothing acts.
    pub limit: InertiaLimit,
    /// Generalised loads of the undeformed ring by the square of the speed and by the acceleration, of unit values.
    undeformed: [Vec<f64>; 2],
}

impl LeftOut {
    /// Share of the forces on the ring that is left out, at most.
    pub fn share(&self) -> f64 {
        self.limit.share(self.first_frequency.least)
    }

    /// What is left out, for a log.
    pub fn note(&self) -> String {
        let FrequencyBounds { least, most } = self.first_frequency;
        let in_khz = |frequency: f64| frequency / std::f64::consts::TAU / 1e3;
        format!(
            "the inertia of its elastic part is left out in its turning frame: at most {:.1e} of the forces, (largest \
             speed^2 + acceleration) / (first natural frequency, {:.4} to {:.4} kHz)^2, is below \
             effects.frame_rotation.negligible = {:e}; free vibrations lack the splitting of their frequencies by up \
             to 2 speed / frequency = {:.1e}",
            self.share(),
            in_khz(least),
            in_khz(most),
            self.limit.negligible,
            2.0 * self.limit.largest_speed / least
        )
    }

    /// Load of the undeformed ring in its frame, a vector of the body.
    pub(super) fn load(&self, turn: FrameTurn) -> Vec<f64> {
        let [square, rate] = &self.undeformed;
        let sum = |(a, b): (&f64, &f64)| turn.speed * turn.speed * a + turn.acceleration * b;
        square.iter().zip(rate).map(sum).collect()
    }
}

/// What is left out of a ring with this body in its turning frame; None where all acts. The inner ring of a bearing
/// that `wobbles` moves across its axis. Collective.
pub(super) fn left_out(
    (model, side): (&Model, Side),
    (ring, body): (&RingModel, &dyn ElasticBody),
    wobbles: bool,
) -> Result<Option<LeftOut>, DynamicsError> {
    let Some(limit) = model.inertia_limit(side) else {
        return Ok(None);
    };
    let is_on_partner = ring.hold != Hold::Free && ring.tie.is_none();
    let is_asked = model.frame(side) == Frame::Turning && limit.negligible > 0.0;
    if !is_asked || !is_on_partner {
        return Ok(None);
    }
    let bounds = FrequencyBounds {
        least: limit.frequency(),
        most: first_frequency_bound(body, ring),
    };
    if bounds.most.is_nan() || bounds.most <= bounds.least {
        return Ok(None);
    }
    if side.choose(wobbles, false) && body.unroundness() >= limit.negligible {
        return Ok(None);
    }
    let settings = StaticSettings {
        name: side.name(),
        partner: partner(model, side),
        backend: model.backend,
        n_contacts: 1,
    };
    let first_frequency = first_frequency_above((body, ring), bounds, settings)?;
    Ok(first_frequency.map(|first_frequency| LeftOut {
        first_frequency,
        limit,
        undeformed: undeformed(body),
    }))
}

/// Loads of unit speed and of unit acceleration on the undeformed ring, vectors of the body. Collective.
fn undeformed(body: &dyn ElasticBody) -> [Vec<f64>; 2] {
    [
        mass_load(body, |[x, y, _]| [x, y, 0.0]),
        mass_load(body, |[x, y, _]| [y, -x, 0.0]),
    ]
}
