//! The time loop's step: from one State to the next, in parts on the ladder dt 2^-k if need be.
//!
//! Each ring lives in a frame turned by its theta(t): its contacts stand at azimuth minus theta, loads that are fixed
//! in space are turned into it. Contacts of a step are placed at the azimuths of its
//! weighted time. Factors of a rung are made when it is first used, and kept.

use std::sync::{Arc, OnceLock};

use contact::Side;
use timer::SharedLaps;

use crate::kinematics::{Kinematics, RingSpeeds};
use ring::memory::forecast_motion_peak;
use ring::rigid::RigidInertia;
use ring::statics::iterations_note;
use ring::{
    BodySettings, FactoredBody, Frame, FrameTurn, Hold, Inventory, MadeRing, Oscillators, RingModel,
    StepFactor, StepScheme, body_beside, require_stiffening,
};

use super::elastic_inertia::{LeftOut, left_out};
use super::mass_load::UnitWeights;
use super::state::MotionSettings;
use crate::bearing::partner;
use crate::costs;
use crate::effects::Loads;
use crate::error::DynamicsError;
use crate::model::{ContactMode, Model, ShaftDof};
use crate::raceway::Raceway;
use crate::whirl::shaft_inertia;

/// Factors of both rings at one step size.
pub(super) type Rung = [Option<Arc<dyn StepFactor>>; 2];

/// A flexible ring and its raceway.
pub struct MovingRing {
    /// The elastic body.
    pub body: Arc<FactoredBody>,
    /// Where contacts find it.
    pub raceway: Arc<Raceway>,
    /// What the body is made with.
    settings: BodySettings,
    /// Inertia of its elastic part in its turning frame, where that is nothing.
    pub(super) left_out: Option<LeftOut>,
    /// What it weighs, where an effect gives it weight.
    pub(super) weights: Option<Arc<UnitWeights>>,
}

/// A model ready to move.
pub struct Motion<'a> {
    pub(super) model: &'a Model,
    pub(super) settings: MotionSettings,
    pub(super) kinematics: Kinematics,
    pub(super) rings: [Option<MovingRing>; 2],
    /// Rigid inertia of a flexible inner ring, zero of a rigid one, where ring or shaft turns and may move across its
    /// axis.
    pub(super) turning: Option<RigidInertia>,
    /// Rigid inertia of all that moves with the shaft, where that may tilt.
    pub(super) tilting: Option<RigidInertia>,
    /// Moment that the stress of the inner ring at unit speed holds against a tilt, N m s^2.
    pub(super) tilt_by_stress: f64,
    /// Tells this motion from others.
    pub(super) token: Arc<()>,
    rungs: Vec<OnceLock<Rung>>,
    /// Seconds so far, by effect.
    pub costs: SharedLaps,
}

impl<'a> Motion<'a> {
    /// Assembles both rings and factors them for the full step.
    pub fn new(model: &'a Model, settings: MotionSettings) -> Result<Motion<'a>, DynamicsError> {
        Motion::beside(&[], model, settings)
    }

    /// The same beside other bearings, with whose rings it shares what is alike.
    pub fn beside(
        others: &[Motion<'_>],
        model: &'a Model,
        settings: MotionSettings,
    ) -> Result<Motion<'a>, DynamicsError> {
        check_kind(model)?;
        check_free(model, &settings)?;
        let build = |side: Side| {
            let ring = model.ring(side);
            ring.map(|ring| moving_ring((ring, side), model, &settings, others))
                .transpose()
        };
        let [inner, outer] = model.backend.try_on_sides(build)?;
        let (turns, tilts) = (wobbles(model, &settings.speeds), tilts(model));
        let inertia = inner
            .as_ref()
            .filter(|_| turns || tilts)
            .map(|ring| ring.body.rigid_inertia());
        // A ring on a body turns where it sits, as a rigid one, or with a frame of its own.
        let tied = inner.as_ref().and_then(|ring| ring.body.tied());
        let is_turned = tied.is_some_and(|body| body.turns_ring());
        let turning = turns.then(|| inertia.filter(|_| !is_turned).unwrap_or_default());
        let tilting = tilts.then(|| {
            let ring = inertia.filter(|_| is_on_shaft(model)).unwrap_or_default();
            let carried = model.carried_inertia().unwrap_or_default();
            shaft_inertia(model).with(ring).with(carried)
        });
        let [frame, _] = Side::BOTH.map(|side| model.frame(side));
        let tilt_by_stress = match frame {
            Frame::Stiffened => inner.as_ref().map_or(0.0, |ring| ring.body.tilt_by_stress()),
            Frame::Still | Frame::Turning => 0.0,
        };
        let kinematics = Kinematics::new(&model.geometry, settings.slip);
        let rungs = (0..=settings.ladder.halvings).map(|_| OnceLock::new()).collect();
        let motion = Motion {
            model,
            kinematics,
            rings: [inner, outer],
            turning,
            tilting,
            tilt_by_stress,
            settings,
            token: Arc::new(()),
            rungs,
            costs: costs::of_effects(model),
        };
        motion.rung(0)?;
        Ok(motion)
    }

    /// The same on a shaft whose places move by small tilts: inertia at large ones would be that of another motion.
    pub fn of_small_tilts(mut self) -> Motion<'a> {
        self.tilting = None;
        self
    }

    /// Factors of a rung; made when first asked for.
    pub(super) fn rung(&self, k: u32) -> Result<&Rung, DynamicsError> {
        let cell = &self.rungs[k as usize];
        if let Some(rung) = cell.get() {
            return Ok(rung);
        }
        let dt = self.step_size(k);
        let scheme = StepScheme {
            integrator: self.settings.integrator,
            dt,
        };
        let build = |side: Side| {
            let factor = |ring: &MovingRing| ring.body.factor(scheme);
            self.rings[side.index()].as_ref().map(factor).transpose()
        };
        let rung = self.model.backend.try_on_sides(build)?;
        // A second thread may have been faster: it made the same bits.
        Ok(cell.get_or_init(|| rung))
    }

    /// Number of rungs that have factors.
    pub fn n_factored_rungs(&self) -> usize {
        self.rungs.iter().filter(|r| r.get().is_some()).count()
    }

    /// What both rings hold: coordinates, matrices, and the factors of the rungs in use.
    pub fn inventory(&self) -> Inventory {
        let rings = self.rings.iter().flatten();
        let bodies = rings.fold(Inventory::default(), |sum, ring| sum + ring.body.inventory());
        let rungs = self.rungs.iter().filter_map(OnceLock::get);
        Inventory {
            matrices: bodies.matrices + rungs.flatten().flatten().count(),
            ..bodies
        }
    }

    /// What moves.
    pub fn model(&self) -> &Model {
        self.model
    }

    /// The elastic body round a ring; None without one.
    pub fn tied(&self, side: Side) -> Option<&Oscillators> {
        self.rings[side.index()].as_ref()?.body.tied()
    }

    /// Forecast of the largest resident memory after the start, bytes, with `n_threads` threads while `queued` steps
    /// wait to be written; None when a ring is in sectors.
    pub fn memory_forecast(&self, queued: usize, n_threads: usize) -> Option<usize> {
        let memory = |ring: &Option<MovingRing>| ring.as_ref().map(|ring| ring.body.memory());
        match self.rings.each_ref().map(memory) {
            [Some(None), _] | [_, Some(None)] => None,
            [inner, outer] => {
                let rings = [inner.flatten(), outer.flatten()];
                Some(forecast_motion_peak(rings, queued, n_threads))
            }
        }
    }

    /// Bytes of all factors.
    pub fn factor_bytes(&self) -> usize {
        let rungs = self.rungs.iter().filter_map(OnceLock::get);
        rungs.flatten().flatten().map(|factor| factor.bytes()).sum()
    }

    /// Linear solver of a flexible ring: `cyclic` or `sparse`.
    pub fn solver_name(&self, side: Side) -> Option<&'static str> {
        self.rings[side.index()]
            .as_ref()
            .map(|ring| ring.body.solver_name())
    }

    /// The linear solver of a flexible ring and why it is that one, for a log.
    pub fn solver_note(&self, side: Side) -> Option<String> {
        let mut note = self.rings[side.index()].as_ref()?.body.solver_note();
        let rung = self.rungs.first().and_then(OnceLock::get)?;
        if let Some(iterations) = rung[side.index()].as_ref().and_then(|f| f.iterations()) {
            note.push_str(&iterations_note(iterations));
        }
        Some(note)
    }

    /// What is left out of the inertia of a ring's elastic part; None where all acts.
    pub fn left_out(&self, side: Side) -> Option<&LeftOut> {
        self.rings[side.index()].as_ref()?.left_out.as_ref()
    }

    /// Whether the inertia of its turning frame acts on the elastic part of a ring.
    pub(super) fn has_elastic_inertia(&self, side: Side) -> bool {
        self.model.turns_frame(side) && self.left_out(side).is_none()
    }

    /// Turning of the frame of a ring whose elastic part has inertia in it.
    pub(super) fn elastic_turn(&self, side: Side, loads: &Loads) -> Option<FrameTurn> {
        loads.frames[side.index()].filter(|_| self.left_out(side).is_none())
    }

    /// Load of the undeformed ring where its elastic part has no inertia, a vector of the body.
    pub(super) fn undeformed_load(&self, side: Side, loads: &Loads) -> Option<Vec<f64>> {
        Some(self.left_out(side)?.load(loads.frames[side.index()]?))
    }

    /// Number of balls.
    pub fn n_balls(&self) -> usize {
        self.model.geometry.n_balls
    }

    /// Number of generalised coordinates of a ring; 0 for a rigid one.
    pub fn n_coordinates(&self, side: Side) -> usize {
        self.rings[side.index()].as_ref().map_or(0, |ring| ring.body.n())
    }

    /// Step size of a rung, s.
    pub fn step_size(&self, k: u32) -> f64 {
        self.settings.dt / (1u64 << k) as f64
    }

    /// Time of a step number, s.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.settings.dt
    }

    /// Azimuth of a ball at a time, rad.
    pub fn ball_azimuth(&self, ball: usize, time: f64) -> f64 {
        self.model.geometry.azimuth(ball) + self.cage_angle(time)
    }

    /// Turning of the body on the shaft under a ring at a time; None where there is none, or it stands.
    pub(super) fn body_turn(&self, side: Side, time: f64) -> Option<FrameTurn> {
        let speed = self.settings.speeds.of(side);
        let is_carried = self.tied(side).is_some_and(|body| body.on_shaft().is_some());
        (is_carried && !speed.is_zero()).then(|| FrameTurn {
            speed: speed.at(time),
            acceleration: speed.rate(time),
        })
    }

    /// Angle by which the frame of a ring is turned in space, rad.
    pub(super) fn frame_angle(&self, side: Side, time: f64) -> f64 {
        self.settings.speeds.of(side).angle(time)
    }

    /// Angle the cage has turned since the start, rad.
    pub(super) fn cage_angle(&self, time: f64) -> f64 {
        self.kinematics.cage_angle(&self.settings.speeds, time)
    }
}

/// Assembles a ring with what it shares with those of other bearings, and finds whether its elastic part has inertia in
/// its turning frame.
fn moving_ring(
    (ring, side): (&RingModel, Side),
    model: &Model,
    settings: &MotionSettings,
    others: &[Motion<'_>],
) -> Result<MovingRing, DynamicsError> {
    let rings = others.iter().filter_map(|other| {
        let (moving, ring) = (other.rings[side.index()].as_ref()?, other.model.ring(side)?);
        Some((other, moving, ring))
    });
    let made = rings.clone().map(|(_, moving, ring)| MadeRing {
        ring,
        settings: moving.settings,
        body: &moving.body,
    });
    let made: Vec<_> = made.collect();
    let own = |frame: Frame| BodySettings {
        partner: partner(model, side),
        damping: [settings.rayleigh.mass, settings.rayleigh.stiffness],
        backend: model.backend,
        frame,
    };
    let body = |frame: Frame| body_beside(side.name(), ring, own(frame), &made);
    let turning = body(model.frame(side))?;
    let wobbles = wobbles(model, &settings.speeds);
    let left_out = left_out((model, side), (ring, &**turning), wobbles)?;
    let (frame, body) = match left_out {
        Some(_) => {
            drop(turning);
            (Frame::Still, body(Frame::Still)?)
        }
        None => (model.frame(side), turning),
    };
    let mut alike = rings.filter(|(_, _, like)| like.is_like(ring));
    let raceway = alike
        .clone()
        .find(|(other, ..)| other.model.contact.mode == model.contact.mode)
        .map(|(_, moving, _)| moving.raceway.clone());
    let weights = model.effects.iter().any(|effect| effect.weighs_rings()).then(|| {
        let known = alike.find_map(|(_, moving, _)| moving.weights.clone());
        known.unwrap_or_else(|| Arc::new(UnitWeights::of(&**body)))
    });
    Ok(MovingRing {
        raceway: raceway.unwrap_or_else(|| Arc::new(Raceway::new(ring, model.contact.mode))),
        weights,
        body,
        settings: own(frame),
        left_out,
    })
}

/// Whether inertia turns with a shaft that may move across its axis or tilt.
fn wobbles(model: &Model, speeds: &RingSpeeds) -> bool {
    let moves = |dof: usize| model.shaft[dof] != ShaftDof::Prescribed(0.0);
    let has_inertia = is_on_shaft(model) || model.shaft_inertia.polar > 0.0;
    has_inertia && !speeds.inner.is_zero() && [0, 1, 3, 4].into_iter().any(moves)
}

/// Whether the shaft may tilt.
fn tilts(model: &Model) -> bool {
    [3, 4]
        .into_iter()
        .any(|dof: usize| model.shaft[dof] != ShaftDof::Prescribed(0.0))
}

/// Whether an elastic inner ring moves with the shaft.
fn is_on_shaft(model: &Model) -> bool {
    model
        .ring(Side::Inner)
        .is_some_and(|ring| ring.hold != Hold::Free)
}

/// Refuses what kinematic balls know and free ones do not.
fn check_free(model: &Model, settings: &MotionSettings) -> Result<(), DynamicsError> {
    let refuse = |what: &'static str| Err(DynamicsError::NotInMotion { what });
    if model.traction().is_none() {
        return Ok(());
    }
    if !settings.integrator.is_conserving() {
        return refuse(
            "balls.motion = \"free\" with an integrator that dissipates; use integrator = \"average_acceleration\"",
        );
    }
    Ok(())
}

/// Refuses what statics knows and motion does not, before the bodies of the rings are made.
pub fn check_supported(model: &Model) -> Result<(), DynamicsError> {
    check_kind(model)?;
    for side in Side::BOTH {
        if let (true, Some(ring)) = (model.is_stiffened(side), model.ring(side)) {
            require_stiffening(side.name(), ring, model.backend)?;
        }
    }
    Ok(())
}

/// The same but for what the making of these bodies refuses.
fn check_kind(model: &Model) -> Result<(), DynamicsError> {
    let refuse = |what: &'static str| Err(DynamicsError::NotInMotion { what });
    if model.contact.mode == ContactMode::Facet {
        return refuse("contact.mode = \"facet\"; use \"patch\"");
    }
    if model.surfaces.has_strips() && model.mounting.changes() {
        return refuse(
            "real surfaces ([[profiles.*]], contact.edges) beside temperatures that change; keep [effects.temperature] \
             constant",
        );
    }
    Ok(())
}
