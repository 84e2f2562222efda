//! What every table `[effects.NAME]` of a scene says of itself: its checks, the slots of the bearing that it fills,
//! when it matters, and how its price is found.
//!
//! A slot is a place where the bearing takes what effects bring. Each is a method of [`EffectTable`] that brings
//! nothing unless a table says otherwise:
//!
//! | slot | method | who reads it |
//! |---|---|---|
//! | loads, and the inertia of a turning frame | `load` | equilibria and steps, by [`Effect`] |
//! | kinematics of the cage | `slip` | [`crate::kinematics`] |
//! | terms of the raceway contact | `contact_damping` | [`crate::interactions::discrete_gradient`] |
//! | damping of rings | `ring_damping` | the elastic bodies |
//! | fits and temperatures | `mount` | [`crate::mounting`] |

use std::sync::Arc;

use contact::film::Lubricant;
use input::{Clock, Problems, Quantity, Schedule};
use ring::RingModel;

use super::rules::{Case, PeakLoad, Remark};
use crate::error::DynamicsError;
use crate::interactions::contact_damping::ContactDamping;
use crate::kinematics::{BallSpeeds, RingSpeeds, SlipRatios};
use crate::model::Effect;
use crate::mounting::Conditions;

/// A load beyond this is a slip of the unit, N and N m.
const MAX_LOAD: f64 = 1e9;

/// What is known of an effect whether or not a scene has it.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Name of its table.
    pub name: &'static str,
    /// The table as a scene has it, header and all, with every key.
    pub example: &'static str,
    /// What it takes from the speeds of the rings.
    pub speed: SpeedRole,
    /// What else a scene must have.
    pub needs: &'static [Need],
    /// What `raceway prices` turns on; None: a load that is not varied.
    pub trial: Option<Trial>,
}

/// What an effect takes from the speeds of the rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedRole {
    /// Nothing.
    None,
    /// It changes how parts roll: nothing in an equilibrium by itself.
    Rolling,
    /// It makes a force of it, in an equilibrium too.
    Force,
    /// It makes a force on balls of it, whose speeds may follow their contact angles.
    BallForce,
    /// It makes a force of it, in an equilibrium too, and does without one.
    Optional,
}

/// What a scene must have, or an effect does nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Inertia: motion in time.
    Inertia,
    /// A finite-element ring that turns.
    FlexibleTurning,
    /// An inner ring that turns.
    TurningInner,
    /// Thermal expansion of rings and balls.
    Expansion,
    /// Balls that follow each other on one course, which stands in space.
    OneCourse,
    /// The centrifugal force of the balls, which presses all of them on a raceway.
    BallCentrifugal,
}

/// Values with which `raceway prices` turns an effect on.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// In words; empty for a table without keys.
    pub what: &'static str,
    /// Keys of the table and their values, as for `--set`.
    pub keys: &'static [(&'static str, &'static str)],
}

/// What the effects of a scene have to go with.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// Whether equilibria are computed, not motion with inertia.
    pub is_without_inertia: bool,
    /// Whether loads may change in time.
    pub clock: Clock,
    /// Whether the table `[speed]` of the scene names a ring, inner first.
    pub has_speed: [bool; 2],
    /// Whether a ring is a finite-element body, inner first.
    pub is_flexible: [bool; 2],
    /// Diameters of bore and seat, m; None where the scene has no sane ones.
    pub seat_diameters: [Option<f64>; 2],
    /// Whether the scene has the thermal expansion of rings and balls.
    pub has_expansion: [bool; 2],
    /// Whether the scene has a lubricant.
    pub has_lubricant: bool,
    /// Mass of all that turns with the shaft, kg; None where the scene leaves it open, or meshes have a part of it.
    pub turning_mass: Option<f64>,
    /// What keeps balls from following each other on one course, by its key; None: nothing does.
    pub parts_courses: Option<&'static str>,
    /// Whether the scene has the centrifugal force of the balls.
    pub has_ball_centrifugal: bool,
}

impl Context {
    /// The rings that turn, in words, if none of them is flexible.
    fn rigid_that_turn(&self) -> Option<&'static str> {
        let [inner, outer] = [0, 1].map(|i| self.has_speed[i].then_some(self.is_flexible[i]));
        match (inner, outer) {
            (Some(true), _) | (_, Some(true)) | (None, None) => None,
            (Some(false), None) => Some("the inner ring is rigid"),
            (None, Some(false)) => Some("the outer ring is rigid"),
            (Some(false), Some(false)) => Some("both rings are rigid"),
        }
    }
}

/// What loads are made with.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// Speeds of the rings.
    pub speeds: &'a RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
    /// Contact angles that the speeds of balls follow.
    pub ball_speeds: BallSpeeds,
    /// Flexible rings, inner first; None is a rigid ring.
    pub rings: &'a [Option<Arc<RingModel>>; 2],
    /// The oil, where a scene has one.
    pub lubricant: Option<Lubricant>,
}

/// Damping matrix of the rings, C = mass M + stiffness K.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RingDamping {
    /// Factor of the mass matrix, 1/s.
    pub mass: f64,
    /// Factor of the stiffness matrix, s.
    pub stiffness: f64,
}

/// A table of a scene.
pub trait EffectTable {
    /// What is known without a scene.
    fn about() -> About
    where
        Self: Sized;

    /// Rule of thumb for `raceway check`: sentences on an effect that is off and matters, or on and does not.
    fn advice(_table: Option<&Self>, _case: &Case<'_>) -> Vec<Remark>
    where
        Self: Sized,
    {
        Vec::new()
    }

    /// Checks its values; what a scene must have is checked for all tables alike.
    fn check(&self, _context: Context, _problems: &mut Problems) {}

    /// Slot of loads.
    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(None)
    }

    /// Slot of kinematics: slip ratios at the inner and outer raceway.
    fn slip(&self) -> Option<SlipRatios> {
        None
    }

    /// Slot of contact terms: damping along the normal.
    fn contact_damping(&self) -> Option<ContactDamping> {
        None
    }

    /// Slot of ring damping.
    fn ring_damping(&self) -> Option<RingDamping> {
        None
    }

    /// Slot of mounting: interference, temperatures, forms of seats.
    fn mount(&self, _conditions: &mut Conditions) {}

    /// Largest forces on the shaft at a speed in rad/s: what rules of thumb compare with.
    fn peak_load(&self, _speed: f64) -> PeakLoad {
        PeakLoad::default()
    }

    /// Factor of its load over time.
    fn schedule(&self) -> Schedule {
        Schedule::Constant
    }
}

/// A table that a scene may have.
pub trait EffectEntry {
    /// What is known of it.
    fn about(&self) -> About;

    /// The table, if the scene has it.
    fn table(&self) -> Option<&dyn EffectTable>;

    /// Its rule of thumb.
    fn advice(&self, case: &Case<'_>) -> Vec<Remark>;
}

impl<T: EffectTable> EffectEntry for Option<T> {
    fn about(&self) -> About {
        T::about()
    }

    fn table(&self) -> Option<&dyn EffectTable> {
        self.as_ref().map(|table| table as &dyn EffectTable)
    }

    fn advice(&self, case: &Case<'_>) -> Vec<Remark> {
        T::advice(self.as_ref(), case)
    }
}

impl About {
    /// Whether the effect can do something in a scene.
    pub fn fits(&self, context: Context) -> bool {
        let mut problems = Problems::default();
        self.check_needs(context, &mut problems);
        problems.is_empty()
    }

    /// Reports what the scene lacks for the effect to do something.
    pub fn check_needs(&self, context: Context, problems: &mut Problems) {
        let name = self.name;
        let needs_one = !matches!(self.speed, SpeedRole::None | SpeedRole::Optional);
        if needs_one && context.has_speed == [false; 2] {
            problems.add(format!(
                "[effects.{name}] needs the speed of a ring; add [speed] with inner = \"1800 rpm\" or \
                 remove the effect"
            ));
        }
        for need in self.needs {
            match need {
                Need::FlexibleTurning => {
                    if let Some(rigid) = context.rigid_that_turn() {
                        problems.add(format!(
                            "[effects.{name}] is the inertia of a flexible ring that turns, but {rigid}; remove it"
                        ));
                    }
                }
                Need::TurningInner if context.has_speed == [false, true] => problems.add(format!(
                    "[effects.{name}] turns with the inner ring, but [speed] has outer alone; add inner, or remove \
                     the effect"
                )),
                Need::Inertia if context.is_without_inertia => problems.add(format!(
                    "[effects.{name}] does nothing in a scene without inertia; remove it, or compute motion with \
                     [dynamic]"
                )),
                Need::Expansion => {
                    for (body, is_known) in ["rings", "balls"].into_iter().zip(context.has_expansion) {
                        if !is_known {
                            problems.add(format!(
                                "[effects.{name}] needs the thermal expansion of the {body}; add \
                                 materials.{body}.expansion, such as \"11.5e-6 /K\" of bearing steel"
                            ));
                        }
                    }
                }
                Need::BallCentrifugal if !context.has_ball_centrifugal => problems.add(format!(
                    "[effects.{name}] needs [effects.ball_centrifugal], without which nothing holds unloaded balls; \
                     add it, or remove the effect"
                )),
                Need::OneCourse => {
                    if let Some(key) = context.parts_courses {
                        problems.add(format!(
                            "[effects.{name}] takes balls to follow each other on one course, but with {key} each has \
                             its own; remove one of both"
                        ));
                    }
                }
                Need::TurningInner | Need::Inertia | Need::BallCentrifugal => {}
            }
        }
    }
}

/// Reports a load that is beyond any bearing at the peak of its schedule.
pub(super) fn require_load<const KIND: usize>(
    load: &Quantity<KIND>,
    schedule: &Schedule,
    key: &str,
    problems: &mut Problems,
) {
    let rule = match schedule {
        Schedule::Constant => "that is more than any bearing carries, check its unit",
        _ => "times its schedule that is more than any bearing carries, check its unit and factors",
    };
    let size = load.si().abs();
    problems.require(size * schedule.peak() <= MAX_LOAD, key, load, rule);
}
