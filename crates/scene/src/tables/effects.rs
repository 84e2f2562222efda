//! `[effects.*]`: one optional table per effect; an effect without its table costs nothing.

use input::{
    ACCELERATION, ANGLE, Clock, FORCE, MOMENT, Problems, Quantity, RawSchedule, Schedule, Scheduled,
    check_schedule,
};
use serde::Deserialize;

use super::damping::{ContactDamping, RawContactDamping, RawRayleighDamping, RayleighDamping};
use super::gyroscopic::RawGyroscopicMoment;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "tables [effects.*]")]
pub struct RawEffects {
    axial_force: Option<RawAxialForce>,
    radial_force: Option<RawRadialForce>,
    moment: Option<RawMoment>,
    gravity: Option<RawGravity>,
    ball_centrifugal: Option<RawBallCentrifugal>,
    gyroscopic_moment: Option<RawGyroscopicMoment>,
    cage_slip: Option<RawCageSlip>,
    frame_rotation: Option<RawFrameRotation>,
    contact_damping: Option<RawContactDamping>,
    rayleigh_damping: Option<RawRayleighDamping>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.axial_force]")]
struct RawAxialForce {
    value: Quantity<FORCE>,
    schedule: Option<RawSchedule>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.radial_force]")]
struct RawRadialForce {
    value: Quantity<FORCE>,
    direction: Quantity<ANGLE>,
    schedule: Option<RawSchedule>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.moment]")]
struct RawMoment {
    x: Quantity<MOMENT>,
    y: Quantity<MOMENT>,
    schedule: Option<RawSchedule>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.gravity]")]
struct RawGravity {
    acceleration: Quantity<ACCELERATION>,
    direction: [f64; 3],
    schedule: Option<RawSchedule>,
}

/// As typed: the table has no keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.ball_centrifugal]")]
struct RawBallCentrifugal {}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.cage_slip]")]
struct RawCageSlip {
    inner: f64,
    outer: f64,
}

/// As typed: the table has no keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.frame_rotation]")]
struct RawFrameRotation {}

/// What the effects have to go with.
#[derive(Clone, Copy, Debug)]
pub struct EffectsContext {
    /// Whether equilibria are computed, not motion with inertia.
    pub is_without_inertia: bool,
    /// Whether loads may change in time.
    pub clock: Clock,
    /// Whether the scene has the table `[speed]`.
    pub has_speed: bool,
    /// Whether the inner ring is a finite-element body.
    pub has_flexible_inner: bool,
}

/// The effects a scene calls for.
#[derive(Clone, Debug, PartialEq)]
pub struct Effects {
    /// Force on the shaft along z, N, + = the direction of preload.
    pub axial_force: Option<Scheduled<f64>>,
    /// Force on the shaft across z.
    pub radial_force: Option<Scheduled<RadialForce>>,
    /// Moment on the shaft about x and y, N m.
    pub moment: Option<Scheduled<[f64; 2]>>,
    /// Acceleration of gravity, m/s2, `[3]` in x, y, z.
    pub gravity: Option<Scheduled<[f64; 3]>>,
    /// Whether balls feel the centrifugal force of their revolution with the cage.
    pub ball_centrifugal: bool,
    /// Shares of the balls' gyroscopic moment at the inner and at the outer raceway, sum 2.
    pub gyroscopic_moment: Option<[f64; 2]>,
    /// Whether the inner ring feels the inertia of its turning frame.
    pub frame_rotation: bool,
    /// Shares of the rolling motion lost at the inner and at the outer raceway, dimensionless, 0 to below 1.
    pub cage_slip: Option<[f64; 2]>,
    /// Damping of contacts, only in motion.
    pub contact_damping: Option<ContactDamping>,
    /// Damping of the rings, only in motion.
    pub rayleigh_damping: Option<RayleighDamping>,
}

/// A force across the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialForce {
    /// Size, N; negative points the other way.
    pub value: f64,
    /// Azimuth it points to, rad, from +x towards +y.
    pub direction: f64,
}

/// A gravity beyond a million times the earth's is a slip of the unit, m/s2.
const MAX_ACCELERATION: f64 = 1e7;
/// A load beyond this is a slip of the unit, N and N m.
const MAX_LOAD: f64 = 1e9;

impl Effects {
    /// Names of the effects that add no loads but change the steps of a motion.
    pub fn inside_steps(&self) -> Vec<&'static str> {
        let effects = [
            ("cage_slip", self.cage_slip.is_some()),
            ("contact_damping", self.contact_damping.is_some()),
            ("rayleigh_damping", self.rayleigh_damping.is_some()),
        ];
        effects
            .into_iter()
            .filter(|(_, is_there)| *is_there)
            .map(|(name, _)| name)
            .collect()
    }
}

impl RawEffects {
    /// Whether an effect needs the speed in a scene at rest too.
    pub fn use_speed_at_rest(&self) -> bool {
        self.ball_centrifugal.is_some() || self.frame_rotation.is_some() || self.gyroscopic_moment.is_some()
    }

    /// Checks sizes and directions, and that speed and analysis give each effect something to do.
    pub fn check(&self, context: EffectsContext, problems: &mut Problems) -> Effects {
        let clock = context.clock;
        let effects = Effects {
            axial_force: self.axial_force.as_ref().map(|f| f.check(clock, problems)),
            radial_force: self.radial_force.as_ref().map(|f| f.check(clock, problems)),
            moment: self.moment.as_ref().map(|m| m.check(clock, problems)),
            gravity: self.gravity.as_ref().map(|g| g.check(clock, problems)),
            ball_centrifugal: self.ball_centrifugal.is_some(),
            frame_rotation: self.frame_rotation.is_some(),
            gyroscopic_moment: self.gyroscopic_moment.as_ref().map(|g| g.check(problems)),
            cage_slip: self.cage_slip.as_ref().map(|s| s.check(problems)),
            contact_damping: self.contact_damping.as_ref().map(|d| d.check(problems)),
            rayleigh_damping: self.rayleigh_damping.as_ref().map(|d| d.check(problems)),
        };
        self.check_context(context, problems);
        effects
    }

    fn check_context(&self, context: EffectsContext, problems: &mut Problems) {
        let turning = [
            ("ball_centrifugal", self.ball_centrifugal.is_some()),
            ("gyroscopic_moment", self.gyroscopic_moment.is_some()),
            ("cage_slip", self.cage_slip.is_some()),
            ("frame_rotation", self.frame_rotation.is_some()),
        ];
        for (name, is_there) in turning {
            if is_there && !context.has_speed {
                problems.add(format!(
                    "[effects.{name}] needs the speed of the inner ring; add [speed] with inner = \"1800 rpm\" or \
                     remove the effect"
                ));
            }
        }
        if self.frame_rotation.is_some() && !context.has_flexible_inner {
            problems.add(
                "[effects.frame_rotation] is the inertia of a flexible inner ring, but the inner ring is rigid; remove it"
                    .to_string(),
            );
        }
        let moving = [
            ("contact_damping", self.contact_damping.is_some()),
            ("rayleigh_damping", self.rayleigh_damping.is_some()),
        ];
        for (name, is_there) in moving {
            if is_there && context.is_without_inertia {
                problems.add(format!(
                    "[effects.{name}] does nothing in a scene without inertia; remove it, or compute motion with [dynamic]"
                ));
            }
        }
    }
}

/// Reports a load that is beyond any bearing at the peak of its schedule.
fn require_load<const KIND: usize>(
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

impl RawAxialForce {
    fn check(&self, clock: Clock, problems: &mut Problems) -> Scheduled<f64> {
        let schedule = check_schedule(self.schedule.as_ref(), "effects.axial_force", clock, problems);
        require_load(&self.value, &schedule, "effects.axial_force.value", problems);
        Scheduled {
            value: self.value.si(),
            schedule,
        }
    }
}

impl RawRadialForce {
    fn check(&self, clock: Clock, problems: &mut Problems) -> Scheduled<RadialForce> {
        let schedule = check_schedule(self.schedule.as_ref(), "effects.radial_force", clock, problems);
        require_load(&self.value, &schedule, "effects.radial_force.value", problems);
        let value = RadialForce {
            value: self.value.si(),
            direction: self.direction.si(),
        };
        Scheduled { value, schedule }
    }
}

impl RawMoment {
    fn check(&self, clock: Clock, problems: &mut Problems) -> Scheduled<[f64; 2]> {
        let schedule = check_schedule(self.schedule.as_ref(), "effects.moment", clock, problems);
        require_load(&self.x, &schedule, "effects.moment.x", problems);
        require_load(&self.y, &schedule, "effects.moment.y", problems);
        Scheduled {
            value: [self.x.si(), self.y.si()],
            schedule,
        }
    }
}

impl RawCageSlip {
    fn check(&self, problems: &mut Problems) -> [f64; 2] {
        for (key, slip) in [
            ("effects.cage_slip.inner", self.inner),
            ("effects.cage_slip.outer", self.outer),
        ] {
            let rule = "expected 0 (pure rolling) to below 1, the share of the rolling motion that is lost";
            problems.require((0.0..1.0).contains(&slip), key, slip, rule);
        }
        [self.inner, self.outer]
    }
}

impl RawGravity {
    fn check(&self, clock: Clock, problems: &mut Problems) -> Scheduled<[f64; 3]> {
        let (key, g) = ("effects.gravity.acceleration", self.acceleration.si());
        problems.require(
            (0.0..=MAX_ACCELERATION).contains(&g),
            key,
            &self.acceleration,
            "expected 0 to 1e7 m/s2, its direction is a key of its own",
        );
        let length = self.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        problems.require(
            length > 0.0 && length.is_finite(),
            "effects.gravity.direction",
            format!("{:?}", self.direction),
            "expected a vector with a direction such as [0.0, -1.0, 0.0]; its length does not matter",
        );
        Scheduled {
            value: self.direction.map(|d| g * d / length),
            schedule: check_schedule(self.schedule.as_ref(), "effects.gravity", clock, problems),
        }
    }
}
