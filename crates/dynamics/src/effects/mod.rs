//! Effects: loads and other physics that a scene may ask for, one file each.
//!
//! The file of an effect holds its table in a scene ([`EffectTable`]), checks, equations, the slots of the bearing that
//! it fills, its rule of thumb and its price. A new one is its file, and here its `mod`, its field and its entry in
//! [`Effects::list`]. A table that is absent is never constructed and costs nothing.

pub mod axial_force;
pub mod ball_centrifugal;
pub mod ball_drag;
pub mod cage_slip;
pub mod contact_damping;
pub mod fit;
pub mod frame_rotation;
pub mod gravity;
pub mod gyroscopic_moment;
pub(crate) mod loads;
pub mod moment;
pub mod orbit_inertia;
pub mod radial_force;
pub mod rayleigh_damping;
pub mod rules;
pub mod seat_form;
pub mod spring_preload;
pub mod steady_balls;
mod table;
pub mod temperature;
pub mod traction;
pub mod unbalance;

pub use axial_force::AxialForce;
pub use ball_centrifugal::BallCentrifugal;
pub use frame_rotation::{FrameRotation, static_inertia};
pub use gravity::Gravity;
pub use gyroscopic_moment::{GyroscopicMoment, MomentShares};
pub use loads::{AtEquilibrium, FrameTurn, Loads, Now, RingWeight};
pub(crate) use loads::{resultant, sum_of};

pub use crate::model::Effect;
pub use moment::Moment;
pub use orbit_inertia::OrbitInertia;
pub use radial_force::RadialForce;
pub use spring_preload::SpringPreload;
pub use table::{About, Context, EffectEntry, EffectTable, Need, RingDamping, Setting, SpeedRole, Trial};
pub use traction::{FreeBalls, REPLACED_BY_FREE_BALLS};

use input::{Problems, Schedule};
use serde::Deserialize;

use crate::error::DynamicsError;
use crate::interactions::contact_damping::ContactDamping;
use crate::kinematics::SlipRatios;
use crate::mounting::Conditions;
use rules::{Case, PeakLoad, Remark};

/// The tables `[effects.*]` of a scene.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "tables [effects.*]")]
pub struct Effects {
    /// Force on the shaft along z.
    pub axial_force: Option<axial_force::AxialForceTable>,
    /// Force on the shaft across z.
    pub radial_force: Option<radial_force::RadialForceTable>,
    /// Moment on the shaft.
    pub moment: Option<moment::MomentTable>,
    /// Weight.
    pub gravity: Option<gravity::GravityTable>,
    /// Centrifugal force of the balls.
    pub ball_centrifugal: Option<ball_centrifugal::BallCentrifugalTable>,
    /// Gyroscopic moment of the balls.
    pub gyroscopic_moment: Option<gyroscopic_moment::GyroscopicMomentTable>,
    /// Inertia of balls on their orbits, in equilibria.
    pub orbit_inertia: Option<orbit_inertia::OrbitInertiaTable>,
    /// Slip of balls on the raceways.
    pub cage_slip: Option<cage_slip::CageSlipTable>,
    /// Inertia of the inner ring's turning frame.
    pub frame_rotation: Option<frame_rotation::FrameRotationTable>,
    /// Damping of contacts.
    pub contact_damping: Option<contact_damping::ContactDampingTable>,
    /// Damping of the rings.
    pub rayleigh_damping: Option<rayleigh_damping::RayleighDampingTable>,
    /// Spring that presses the outer ring along the axis.
    pub spring_preload: Option<spring_preload::SpringPreloadTable>,
    /// A mass off the axis of shaft and inner ring.
    pub unbalance: Option<unbalance::UnbalanceTable>,
    /// Traction of free balls.
    pub traction: Option<traction::TractionTable>,
    /// Drag on free balls.
    pub ball_drag: Option<ball_drag::BallDragTable>,
    /// Interference of the rings with shaft and housing.
    pub fit: Option<fit::FitTable>,
    /// Temperatures of all bodies.
    pub temperature: Option<temperature::TemperatureTable>,
    /// Seats that are not round.
    pub seat_form: Option<seat_form::SeatFormTable>,
}

impl Effects {
    /// Every effect there is, in the order of the fields, with or without its table.
    pub fn list(&self) -> Vec<&dyn EffectEntry> {
        // Without `..`: a field that is not in the list does not compile.
        let Effects {
            axial_force,
            radial_force,
            moment,
            gravity,
            ball_centrifugal,
            gyroscopic_moment,
            orbit_inertia,
            cage_slip,
            frame_rotation,
            contact_damping,
            rayleigh_damping,
            spring_preload,
            unbalance,
            traction,
            ball_drag,
            fit,
            temperature,
            seat_form,
        } = self;
        vec![
            axial_force,
            radial_force,
            moment,
            gravity,
            ball_centrifugal,
            gyroscopic_moment,
            orbit_inertia,
            cage_slip,
            frame_rotation,
            contact_damping,
            rayleigh_damping,
            spring_preload,
            unbalance,
            traction,
            ball_drag,
            fit,
            temperature,
            seat_form,
        ]
    }

    /// The effects that the scene has.
    fn on(&self) -> impl Iterator<Item = (About, &dyn EffectTable)> {
        let entries = self.list().into_iter();
        entries.filter_map(|entry| Some((entry.about(), entry.table()?)))
    }

    /// Names of the effects that the scene has, in their order.
    pub fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.on().map(|(about, _)| about.name).collect();
        names.sort_unstable();
        names
    }

    /// Checks values, and that speed and analysis give each effect something to do.
    pub fn check(&self, context: Context, problems: &mut Problems) {
        for (about, table) in self.on() {
            table.check(context, problems);
            about.check_needs(context, problems);
        }
    }

    /// Whether an effect that the scene has takes its speed in some way.
    pub fn use_speed(&self, takes: impl Fn(SpeedRole) -> bool) -> bool {
        self.on().any(|(about, _)| takes(about.speed))
    }

    /// Loads, in the order of the effects' names.
    pub fn loads(&self, setting: Setting<'_>) -> Result<Vec<Box<dyn Effect>>, DynamicsError> {
        let found = self.on().filter_map(|(_, table)| table.load(setting).transpose());
        let mut loads = found.collect::<Result<Vec<_>, _>>()?;
        loads.sort_by_key(|load| load.name());
        Ok(loads)
    }

    /// How the bearing is mounted and how warm it is.
    pub fn conditions(&self) -> Conditions {
        let mut conditions = Conditions::default();
        self.on().for_each(|(_, table)| table.mount(&mut conditions));
        conditions
    }

    /// Slip ratios at the inner and outer raceway.
    pub fn slip(&self) -> SlipRatios {
        self.on().find_map(|(_, table)| table.slip()).unwrap_or_default()
    }

    /// Damping of contacts along their normal.
    pub fn contact_damping(&self) -> Option<ContactDamping> {
        self.on().find_map(|(_, table)| table.contact_damping())
    }

    /// Damping of the rings.
    pub fn ring_damping(&self) -> Option<RingDamping> {
        self.on().find_map(|(_, table)| table.ring_damping())
    }

    /// Largest forces on the shaft at a speed in rad/s.
    pub fn peak_load(&self, speed: f64) -> PeakLoad {
        let sum = self.on().fold(PeakLoad::default(), |sum, (_, table)| {
            let load = table.peak_load(speed);
            PeakLoad {
                axial: sum.axial + load.axial,
                radial: sum.radial + load.radial,
                spring: sum.spring + load.spring,
            }
        });
        PeakLoad {
            axial: sum.axial.max(sum.spring),
            ..sum
        }
    }

    /// Whether a load changes in time by a schedule.
    pub fn are_scheduled(&self) -> bool {
        !self.schedules().is_empty()
    }

    /// Names of the effects whose loads change in time, and the factors of these.
    pub fn schedules(&self) -> Vec<(&'static str, Schedule)> {
        let all = self.on().map(|(about, table)| (about.name, table.schedule()));
        all.filter(|(_, schedule)| *schedule != Schedule::Constant)
            .collect()
    }

    /// What the rules of thumb say: a sentence each, with estimate and formula.
    pub fn advice(&self, case: &Case<'_>) -> Vec<Remark> {
        let has_free_balls = self.names().contains(&"traction");
        let is_replaced =
            |name: &str| has_free_balls && REPLACED_BY_FREE_BALLS.iter().any(|(of, _)| *of == name);
        let entries = self.list();
        let asked = entries.iter().filter(|entry| !is_replaced(entry.about().name));
        asked.flat_map(|entry| entry.advice(case)).collect()
    }
}

/// Headers of the tables of all effects that take the speed in some way: `[effects.a], [effects.b] or [effects.c]`.
pub fn headers_that_use_speed(takes: impl Fn(SpeedRole) -> bool) -> String {
    let none = Effects::default();
    let users = none.list().into_iter().map(|entry| entry.about());
    let mut names: Vec<&str> = users.filter(|a| takes(a.speed)).map(|a| a.name).collect();
    names.sort_unstable();
    let headers: Vec<String> = names.iter().map(|name| format!("[effects.{name}]")).collect();
    match headers.as_slice() {
        [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        few => few.concat(),
    }
}
