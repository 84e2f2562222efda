//! Weight of the balls, of flexible rings, of elastic bodies round them and of the shaft's own mass.
//!
//! Balls have it in their meridian planes; the cage carries the rest. The shaft's acts at the load point.
//!
//! The weight of a ring is its nodal masses, the integrals of rho N_a over the ring, times the acceleration. The masses
//! are integrated once per ring, 8 bytes per node; a motion has their load of unit accelerations along x, y and z in
//! the ring's coordinates ([`crate::motion`]), 24 bytes per dof, so that an instant turns three numbers.
//!
//! An elastic body in which a ring sits sags under its mass matrix times the acceleration
//! ([`Model::body_load`](crate::Model::body_load), [`body::UnitLoads`]). The weight of one on the shaft as a whole acts
//! on the shaft.
//!
//! Rule of thumb: weight of shaft, inner ring and balls over the load.

use std::sync::Arc;

use contact::Side;
use input::{ACCELERATION, Problems, Quantity, RawSchedule, Schedule, check_schedule, schedule_of};
use serde::Deserialize;

use super::loads::{Loads, Now, RingWeight};
use super::rules::{Case, Remark, judge, share_of};
use super::table::{self, About, Context, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::model::{Effect, Model};
use ring::{NodeMasses, RingModel};

const EXAMPLE: &str = r#"[effects.gravity]
acceleration = "9.81 m/s2"
direction = [0.0, -1.0, 0.0]    # its length does not matter
schedule.step = { at = "1 ms" } # optional: its factor over time, as of axial_force
"#;

/// A gravity beyond a million times the earth's is a slip of the unit, m/s2.
const MAX_ACCELERATION: f64 = 1e7;
/// Acceleration of the earth, m/s2.
const EARTH: f64 = 9.81;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.gravity]")]
pub struct GravityTable {
    acceleration: Quantity<ACCELERATION>,
    direction: [f64; 3],
    schedule: Option<RawSchedule>,
}

impl GravityTable {
    /// Acceleration, m/s2, `[3]` in x, y, z.
    pub fn acceleration(&self) -> [f64; 3] {
        let g = self.acceleration.si();
        let length = self.length();
        self.direction.map(|d| g * d / length)
    }

    /// The same at an instant, or its mean over an interval.
    pub fn acceleration_at(&self, now: &Now<'_>) -> [f64; 3] {
        let factor = now.factor(&table::EffectTable::schedule(self));
        self.acceleration().map(|g| factor * g)
    }

    /// Length of the direction.
    fn length(&self) -> f64 {
        self.direction.iter().map(|d| d * d).sum::<f64>().sqrt()
    }
}

impl table::EffectTable for GravityTable {
    fn about() -> About {
        About {
            name: "gravity",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: Some(Trial {
                what: "9.81 m/s2 along -y",
                keys: &[("acceleration", "9.81 m/s2"), ("direction", "[0.0, -1.0, 0.0]")],
            }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let load = case.load.axial.max(case.load.radial);
        if !case.has_own_shaft || load == 0.0 {
            return Vec::new();
        }
        let carried = case.model.carried_inertia().map_or(0.0, |body| body.mass);
        let rotor = case.model.shaft_mass + carried + case.inner_ring_mass();
        let weight = (rotor + case.n_balls() * case.model.ball_mass()) * EARTH;
        let ratio = weight / load;
        let estimate = format!(
            "shaft, inner ring and balls weigh about m g = {weight:.1} N, {}",
            share_of(ratio, "the load")
        );
        judge("gravity", table.is_some(), ratio, &estimate)
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let g = self.acceleration.si();
        problems.require(
            (0.0..=MAX_ACCELERATION).contains(&g),
            "effects.gravity.acceleration",
            &self.acceleration,
            "expected 0 to 1e7 m/s2, its direction is a key of its own",
        );
        let length = self.length();
        problems.require(
            length > 0.0 && length.is_finite(),
            "effects.gravity.direction",
            format!("{:?}", self.direction),
            "expected a vector with a direction such as [0.0, -1.0, 0.0]; its length does not matter",
        );
        check_schedule(self.schedule.as_ref(), "effects.gravity", context.clock, problems);
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        let gravity = Gravity::new(
            self.acceleration(),
            table::EffectTable::schedule(self),
            setting.rings,
        )?;
        Ok(Some(Box::new(gravity)))
    }

    fn schedule(&self) -> Schedule {
        schedule_of(self.schedule.as_ref())
    }
}

/// Uniform gravity.
pub struct Gravity {
    /// Acceleration, m/s^2.
    acceleration: [f64; 3],
    /// Its factor over time.
    schedule: Schedule,
    /// Nodal masses of the flexible rings; None is a rigid ring.
    node_masses: [Option<Arc<NodeMasses>>; 2],
}

impl Gravity {
    /// Gravity of an acceleration (m/s^2) and its schedule on a bearing with the given flexible rings.
    pub fn new(
        acceleration: [f64; 3],
        schedule: Schedule,
        rings: &[Option<Arc<RingModel>>; 2],
    ) -> Result<Gravity, DynamicsError> {
        let masses = |side: Side| {
            let ring = rings[side.index()].as_ref();
            ring.map(|ring| ring.node_masses(side.name())).transpose()
        };
        Ok(Gravity {
            acceleration,
            schedule,
            node_masses: Side::try_both(masses)?,
        })
    }
}

impl Effect for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn weighs_rings(&self) -> bool {
        true
    }

    fn acceleration(&self, now: &Now) -> [f64; 3] {
        let factor = now.factor(&self.schedule);
        self.acceleration.map(|a| factor * a)
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let g = self.acceleration(now);
        let mass = model.ball_mass();
        for (ball, load) in loads.balls.iter_mut().enumerate() {
            let (sin, cos) = (model.geometry.azimuth(ball) + now.cage_angle).sin_cos();
            load.radial += mass * (g[0] * cos + g[1] * sin);
            load.axial += mass * g[2];
        }
        loads.add_shaft_force_at(model.load_point, g.map(|a| model.shaft_mass * a));
        if let Some(inertia) = model.carried_inertia().filter(|_| model.weighs_carried) {
            // As a whole: what it sags by itself is `Model::body_load`.
            let centre = inertia.first_moment / inertia.mass;
            loads.add_shaft_force_at(centre, g.map(|a| inertia.mass * a));
        }
        loads.seat += model.seat().map_or(0.0, |seat| seat.mass * g[2]);
        for side in Side::BOTH {
            let (Some(ring), Some(of_ring)) = (model.ring(side), &self.node_masses[side.index()]) else {
                continue;
            };
            let NodeMasses { total, moment, .. } = &**of_ring;
            // Moment of all weights about the shaft's origin: that of the mass moment.
            let [x, y, z] = [moment[0], moment[1], moment[2] - total * ring.groove.centre_z];
            let about_x = y * g[2] - z * g[1];
            let about_y = z * g[0] - x * g[2];
            let resultant = [total * g[0], total * g[1], total * g[2], about_x, about_y];
            let weight = RingWeight {
                mass: *total,
                acceleration: g,
            };
            loads.add_ring_weight(side, weight, resultant);
        }
        Ok(())
    }
}
