//! The Model: everything that a scene fixes and that never changes during a run, and the trait of the effects in it.
//! An effect is immutable as well: it cannot hide state.
//!
//! Frames: the outer ring's mesh is placed with its groove centres at z = 0; the inner ring's with its groove
//! centres at z = A sin a0 (the just-touching position). The shaft's origin is the axis point in the plane of the
//! inner groove centres. A ring of finite elements moves by u(x) = t + phi x (x - origin), linear in the tilts phi:
//! consistent with small strain. What the finite rotation of shaft and inner ring adds to that acts in the contacts
//! ([`crate::system::Circle`]) and in the loads ([`crate::bodies::TiltedLoads`]).

use std::sync::Arc;

use body::{BesideRing, BodyLoad};
use contact::film::FilmContact;
use contact::hertz::Elastic;
use contact::{
    BearingGeometry, BySide, HertzContact, LeastSize, Meridian, NodalWeights, Side, SphereCompliance,
};
use fem::Material;
use input::Schedule;
use ring::rigid::RigidInertia;
use ring::{Backend, Frame, RingModel};
use serde::Deserialize;
use timer::SharedLaps;

use crate::balls::BallResult;
use crate::effects::loads::{FrameTurn, Loads, Now, seen_from};
use crate::error::DynamicsError;
use crate::interactions::cage::design::Cage;
use crate::interactions::seat_spring::Seat;
use crate::interactions::traction::{Ellipse, Traction};
use crate::kinematics::RingSpeeds;
use crate::mounting::Mounting;
use crate::shoulders::Shoulders;
use crate::surfaces::Surfaces;

/// Largest tilt of the shaft, rad: a little more than 3 deg. Contacts take it exactly; the inertia of tilts is off by
/// its square.
pub const MAX_TILT: f64 = 0.055;

/// One degree of freedom of the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaftDof {
    /// Moves until forces balance.
    Free,
    /// Held at a given displacement, m or rad, times its schedule in `Model::shaft_schedules`; locked is 0.
    Prescribed(f64),
}

/// Moments of inertia of what turns with a rigid shaft, about the axis point in the plane of the inner groove centres,
/// in which its centre of mass lies, kg m^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShaftInertia {
    /// About x and y.
    pub transverse: f64,
    /// About z; at speed it makes the gyroscopic moment.
    pub polar: f64,
}

/// Inertia of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallInertia {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about any axis, kg m^2.
    pub moment: f64,
}

impl BallInertia {
    /// That of a sphere whose moment is so many times that of a solid one of its mass.
    pub fn of_sphere(mass: f64, diameter: f64, factor: f64) -> BallInertia {
        BallInertia {
            mass,
            moment: 0.1 * mass * diameter.powi(2) * factor,
        }
    }
}

/// How the raceways' shape, the forces on the rings and the local compliance are represented.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ContactMode {
    /// Exact torus, force spread over a Hertz patch, local compliance matched: accurate on any mesh.
    Patch,
    /// Facets of the mesh and their nodes, found by bounding boxes: the paper's way; counts the local compliance twice.
    Facet,
    /// Exact torus, rings do not deform: the Jones-Harris limit.
    Rigid,
}

/// Contact choices of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Mode.
    pub mode: ContactMode,
    /// How small a patch may be.
    pub least_patch: LeastSize,
    /// Whether a ball sees the point of the inner groove's circle at its azimuth, projected onto its meridian plane, as
    /// in the methods of Jones and Harris, and not where the moved circle crosses that plane.
    pub projects_grooves: bool,
}

/// Dimensionless stopping rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Change of any contact force between two rounds over the largest force.
    pub force: f64,
    /// Rounds of patch placement and Newton before giving up.
    pub max_rounds: usize,
}

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances {
            force: 1e-10,
            max_rounds: 50,
        }
    }
}

/// A bearing with its loads: see the module.
pub struct Model {
    /// Bearing dimensions.
    pub geometry: BearingGeometry,
    /// Hertz contact of each side, inner first.
    pub hertz: [HertzContact; 2],
    /// What the balls yield as spheres, beyond the half-spaces of Hertz's law; zero: nothing.
    pub sphere: SphereCompliance,
    /// Real surfaces; the default costs nothing.
    pub surfaces: Surfaces,
    /// By how much films lift balls off the grooves, inner first, m; 0 where films take no room.
    pub film_lift: BySide<f64>,
    /// What the scene tells of shoulders, for warnings.
    pub shoulders: Shoulders,
    /// Flexible rings, inner first; None is a rigid ring and costs nothing.
    pub rings: [Option<Arc<RingModel>>; 2],
    /// Forces on the other seats of the body of each ring at rest, inner first, N, over the functions of all its seats;
    /// None: it has no others, or nothing sits there.
    pub other_seats: [Option<Arc<Vec<f64>>>; 2],
    /// Whether gravity loads the shaft here with the weight of the body on it; with several bearings on one shaft
    /// whoever moves that does.
    pub weighs_carried: bool,
    /// What fits and temperatures do to rings and balls.
    pub mounting: Mounting,
    /// Ball steel.
    pub ball_material: Material,
    /// Diameter of the cavity of hollow balls, m; 0: they are solid.
    pub ball_inner_diameter: f64,
    /// Steel of the rings: contacts of rigid rings have it too.
    pub ring_material: Material,
    /// Shaft dofs x, y, z, tilt about x, tilt about y.
    pub shaft: [ShaftDof; 5],
    /// Factors over time of the prescribed ones; those of free dofs do nothing.
    pub shaft_schedules: [Schedule; 5],
    /// Mass carried by the shaft besides a flexible inner ring, kg.
    pub shaft_mass: f64,
    /// Moments of inertia of the shaft, and of a rigid inner ring on it.
    pub shaft_inertia: ShaftInertia,
    /// Axial distance of the load point from the plane of the inner groove centres, m.
    pub load_point: f64,
    /// A free cage; None: it turns as pure rolling has it, or balls are free without one.
    pub cage: Option<Cage>,
    /// Contact choices.
    pub contact: ContactSettings,
    /// Effects the scene calls for, in the order of their names.
    pub effects: Vec<Box<dyn Effect>>,
    /// Linear solver of the rings.
    pub backend: Backend,
    /// Stopping rules.
    pub tolerances: Tolerances,
}

/// From where on the inertia of a ring's elastic part in its turning frame acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaLimit {
    /// Largest speed of the ring at any time, rad/s.
    pub largest_speed: f64,
    /// Largest acceleration of it, rad/s^2.
    pub largest_acceleration: f64,
    /// Share of the forces on the ring below which the inertia is left out; 0: it always acts.
    pub negligible: f64,
}

impl InertiaLimit {
    /// Share of the forces on a ring with this first natural frequency, rad/s, that the inertia of its elastic part is:
    /// centrifugal, Coriolis and Euler forces.
    pub fn share(&self, first_frequency: f64) -> f64 {
        self.turning() / first_frequency.powi(2)
    }

    /// First natural frequency of a ring, rad/s, above which the inertia is below that share.
    pub fn frequency(&self) -> f64 {
        (self.turning() / self.negligible).sqrt()
    }

    /// Inertia per mass and displacement, 1/s^2.
    fn turning(&self) -> f64 {
        self.largest_speed * self.largest_speed + self.largest_acceleration
    }
}

/// What an effect with loads is in a bearing.
pub trait Effect: Send + Sync {
    /// Name of its scene table.
    fn name(&self) -> &'static str;

    /// Adds its loads at an instant.
    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError>;

    /// Whether it gives flexible rings weight ([`Loads::add_ring_weight`]).
    fn weighs_rings(&self) -> bool {
        false
    }

    /// Whether it is the inertia of a ring's turning frame.
    fn turns_frame(&self, _side: Side) -> bool {
        false
    }

    /// Turning of a ring's frame whose inertia it is, at a time, s; None where there is no frame.
    fn frame_turn(&self, _side: Side, _time: f64) -> Option<FrameTurn> {
        None
    }

    /// From where on the inertia of a ring's elastic part in its turning frame acts; None where there is no frame.
    fn inertia_limit(&self, _side: Side) -> Option<InertiaLimit> {
        None
    }

    /// Whether the stress of a ring in its turning frame stiffens it.
    fn stiffens(&self, _side: Side) -> bool {
        false
    }

    /// Slot of interactions: the spring that holds the outer ring along the axis, whose seat then slides.
    fn seat(&self) -> Option<Seat> {
        None
    }

    /// Uniform acceleration that acts on every mass at an instant, m/s^2: the load of a free ball, in space.
    fn acceleration(&self, _now: &Now) -> [f64; 3] {
        [0.0; 3]
    }

    /// Speed of the balls on their orbits, rad/s, whose inertia acts in an equilibrium at a time, s; None: it does not.
    fn orbit_speed(&self, _model: &Model, _time: f64) -> Option<f64> {
        None
    }

    /// Slot of free balls: speeds of the rings between which they roll in an equilibrium.
    fn rolling_speeds(&self) -> Option<&RingSpeeds> {
        None
    }

    /// Slot of free balls: their traction; balls are free where there is one.
    fn traction(&self) -> Option<&Traction> {
        None
    }

    /// Drag on a free ball over the square of its speed, N s^2/m^2.
    fn drag(&self, _model: &Model) -> f64 {
        0.0
    }

    /// What a reader of an equilibrium should know: where the effect is beyond what it assumes.
    fn warning(&self, _model: &Model, _now: &Now, _balls: &[BallResult]) -> Option<String> {
        None
    }
}

impl Model {
    /// Flexible ring of one side.
    pub fn ring(&self, side: Side) -> Option<&RingModel> {
        self.rings[side.index()].as_deref()
    }

    /// Axial shift from a ring's mesh coordinates to the assembled bearing, m.
    pub fn ring_shift(&self, side: Side) -> f64 {
        let centre_z = self.ring(side).map_or(0.0, |r| r.groove.centre_z);
        self.geometry.groove_centre(side).axial - centre_z
    }

    /// Groove centre to ball centre at zero displacement of a bearing that is mounted so, m; measured
    /// by the weights of the contact where they are known.
    pub fn reach(&self, mounting: &Mounting, side: Side, weights: Option<&NodalWeights>) -> Meridian {
        let (centre, ball) = (self.geometry.groove_centre(side), self.geometry.ball_centre());
        ball - centre - mounting.groove_motion(side, weights)
    }

    /// Distance of the centres of groove and a touching ball of a bearing that is mounted so, m.
    pub fn touching_distance(&self, mounting: &Mounting, side: Side, ball: usize) -> f64 {
        let distance = self.geometry.touching_distance(side) + mounting.touching_growth(side);
        distance - self.surfaces.larger_radius(ball) - self.film_lift[side.index()]
    }

    /// Imposed displacement of a shaft dof (0..5) at a time in s, m or rad; None: it is free.
    pub fn prescribed(&self, dof: usize, time: f64) -> Option<f64> {
        self.imposed(dof, |schedule| schedule.at(time))
    }

    /// Rate of the imposed displacement of a shaft dof, m/s or rad/s; None: it is free.
    pub fn prescribed_rate(&self, dof: usize, time: f64) -> Option<f64> {
        self.imposed(dof, |schedule| schedule.rate(time))
    }

    fn imposed(&self, dof: usize, factor: impl Fn(&Schedule) -> f64) -> Option<f64> {
        match self.shaft[dof] {
            ShaftDof::Free => None,
            ShaftDof::Prescribed(value) => Some(value * factor(&self.shaft_schedules[dof])),
        }
    }

    /// Mass of each dof of the shaft: of x, y, z in kg, of the tilts in kg m^2.
    pub fn shaft_masses(&self) -> [f64; 5] {
        let (m, i) = (self.shaft_mass, self.shaft_inertia.transverse);
        [m, m, m, i, i]
    }

    /// The ring of one side if it is tied to an elastic body.
    pub fn tied(&self, side: Side) -> Option<&RingModel> {
        self.ring(side).filter(|ring| ring.tie.is_some())
    }

    /// Inertia of the body on the shaft in which the inner ring sits; None where it is in none.
    pub fn carried_inertia(&self) -> Option<RigidInertia> {
        let ties = Side::BOTH
            .into_iter()
            .filter_map(|side| self.ring(side)?.tie.as_ref());
        ties.filter_map(|tie| tie.carried_inertia())
            .map(Into::into)
            .next()
    }

    /// What acts on the body of a ring at rest besides the ring.
    pub fn acting(&self, side: Side, load: Option<BodyLoad>) -> BesideRing<'_> {
        BesideRing {
            others: self.other_seats[side.index()]
                .as_ref()
                .map(|others| others.as_slice()),
            load,
        }
    }

    /// Load on all of the body of a ring at an instant, seen from the frame of the ring, which is turned by an angle,
    /// rad; None where the body takes none.
    pub fn body_load(&self, side: Side, now: &Now, angle: f64) -> Option<BodyLoad> {
        let tie = self.ring(side)?.tie.as_ref()?;
        tie.body.as_ref()?.loads.as_ref()?;
        let mut acceleration = [0.0; 3];
        for effect in &self.effects {
            let of_effect = effect.acceleration(now);
            (0..3).for_each(|i| acceleration[i] += of_effect[i]);
        }
        let acceleration = seen_from(acceleration, angle);
        let mut turns = self.effects.iter().filter(|_| tie.carried().is_some());
        let turn = turns.find_map(|effect| effect.frame_turn(side, now.time));
        Some(BodyLoad {
            acceleration,
            speed: turn.map_or(0.0, |turn| turn.speed),
            rate: turn.map_or(0.0, |turn| turn.acceleration),
        })
    }

    /// Motion of the seat of a ring by what else acts on its body, by functions, m; None: nothing does.
    pub(crate) fn seat_motion(&self, side: Side, load: Option<BodyLoad>) -> Option<Vec<f64>> {
        self.ring(side)?.tie.as_ref()?.moved_by(self.acting(side, load))
    }

    /// Whether a ring has the inertia of its turning frame.
    pub fn turns_frame(&self, side: Side) -> bool {
        self.effects.iter().any(|effect| effect.turns_frame(side))
    }

    /// From where on the inertia of a ring's elastic part acts; None without its turning frame.
    pub fn inertia_limit(&self, side: Side) -> Option<InertiaLimit> {
        self.effects.iter().find_map(|effect| effect.inertia_limit(side))
    }

    /// The frame of a ring, if the inertia of its elastic part acts.
    pub fn frame(&self, side: Side) -> Frame {
        let stiffens = self.effects.iter().any(|effect| effect.stiffens(side));
        match (self.turns_frame(side), stiffens) {
            (false, _) => Frame::Still,
            (true, false) => Frame::Turning,
            (true, true) => Frame::Stiffened,
        }
    }

    /// Whether the stress of its turning stiffens a ring.
    pub fn is_stiffened(&self, side: Side) -> bool {
        self.frame(side) == Frame::Stiffened
    }

    /// The seat of the outer ring, if it slides along the axis.
    pub fn seat(&self) -> Option<Seat> {
        self.effects.iter().find_map(|effect| effect.seat())
    }

    /// Speed of the balls on their orbits, rad/s, whose inertia acts in an equilibrium at a time, s; None: it does not.
    pub fn orbit_speed(&self, time: f64) -> Option<f64> {
        self.effects
            .iter()
            .find_map(|effect| effect.orbit_speed(self, time))
    }

    /// Traction of the balls, if they are free.
    pub fn traction(&self) -> Option<&Traction> {
        self.effects.iter().find_map(|effect| effect.traction())
    }

    /// Material with which the contacts of a ring deform: that of its mesh, of a rigid ring the scene's.
    fn material_of(&self, side: Side) -> &Material {
        self.ring(side).map_or(&self.ring_material, |ring| &ring.material)
    }

    /// Combined shear modulus of a ball and a ring, 2/G = 1/G_1 + 1/G_2, Pa.
    pub fn combined_shear_modulus(&self, side: Side) -> f64 {
        let ball = self.ball_material.shear_modulus();
        let ring = self.material_of(side).shear_modulus();
        2.0 / (1.0 / ball + 1.0 / ring)
    }

    /// Distance from a ball's centre to the middle of a contact where bodies approach so far, m.
    pub fn contact_lever(&self, ball: usize, approach: f64) -> f64 {
        let radius = 0.5 * self.geometry.ball_diameter + self.surfaces.larger_radius(ball);
        radius - 0.5 * approach.max(0.0)
    }

    /// Contact ellipse under a normal force, N.
    pub fn ellipse(&self, side: Side, force: f64) -> Ellipse {
        let (ball, groove) = (
            0.5 * self.geometry.ball_diameter,
            self.geometry.groove_radius(side),
        );
        Ellipse {
            semi_axes: self.hertz[side.index()].semi_axes(force),
            radius: 2.0 * groove * ball / (groove + ball),
            peak_pressure: self.hertz[side.index()].peak_pressure(force),
            film: 0.0,
        }
    }

    /// Contact of a ball with a raceway as its film sees it.
    pub fn film_contact(&self, side: Side) -> FilmContact {
        let bodies = [elastic(&self.ball_material), elastic(self.material_of(side))];
        FilmContact::of_raceway(&self.geometry, side, &self.hertz[side.index()], bodies)
    }

    /// Inertia of a ball.
    pub fn ball_inertia(&self) -> BallInertia {
        BallInertia::of_sphere(
            self.ball_mass(),
            self.geometry.ball_diameter,
            self.moment_factor(),
        )
    }

    /// Moment of inertia of a ball about any axis, kg m^2.
    pub fn ball_moment(&self) -> f64 {
        self.ball_mass() * self.geometry.ball_diameter.powi(2) / 10.0 * self.moment_factor()
    }

    /// Moment of inertia of a ball over that of a solid one of its mass, (1 - q^5)/(1 - q^3) of a hollow one whose
    /// diameters have the ratio q.
    pub fn moment_factor(&self) -> f64 {
        let ratio = self.ball_inner_diameter / self.geometry.ball_diameter;
        (1.0 - ratio.powi(5)) / (1.0 - ratio.powi(3))
    }

    /// Mass of one ball, kg.
    pub fn ball_mass(&self) -> f64 {
        let cubes = self.geometry.ball_diameter.powi(3) - self.ball_inner_diameter.powi(3);
        std::f64::consts::PI / 6.0 * cubes * self.ball_material.density
    }

    /// Loads of all effects of the model at an instant.
    pub fn loads(&self, now: &Now) -> Result<Loads, DynamicsError> {
        self.timed_loads(now, &SharedLaps::default())
    }

    /// [`Model::loads`], with the time of each effect added to `costs`.
    pub fn timed_loads(&self, now: &Now, costs: &SharedLaps) -> Result<Loads, DynamicsError> {
        let mut loads = Loads::none(self.geometry.n_balls);
        for effect in &self.effects {
            costs.time(effect.name(), || effect.add_loads(self, now, &mut loads))?;
        }
        Ok(loads)
    }
}

/// Elastic constants of a material.
pub fn elastic(material: &Material) -> Elastic {
    Elastic {
        young_modulus: material.young_modulus,
        poisson_ratio: material.poisson_ratio,
    }
}
