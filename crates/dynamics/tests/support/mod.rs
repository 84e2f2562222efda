//! Bearings for the tests of this crate.

#![allow(dead_code)]

use contact::{BearingGeometry, HertzContact, LeastSize, Side, SphereCompliance};
use dynamics::effects::{AxialForce, Effect, Moment, RadialForce};
use dynamics::model::ShaftInertia;
use dynamics::motion::{Motion, MotionState, StepCache};
use dynamics::{ContactMode, ContactSettings, Model, ShaftDof, StaticSolution, StaticSolver, Tolerances};
use fem::Material;
use input::Schedule;

/// The least patch of a scene of quadratic elements that asks for none.
pub const LEAST_PATCH: LeastSize = LeastSize {
    spacings: 2.0,
    rolling: 1.89e-3,
};

/// A load case of the 7010C.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub axial: f64,
    pub radial: f64,
    pub moment: f64,
    pub load_point: f64,
    pub phase: f64,
    pub interference: f64,
    pub free_axial: bool,
    pub free_tilt: bool,
}

impl Case {
    pub fn axial(axial: f64) -> Case {
        Case {
            axial,
            radial: 0.0,
            moment: 0.0,
            load_point: 0.0,
            phase: 0.0,
            interference: 0.0,
            free_axial: true,
            free_tilt: false,
        }
    }

    /// The model with rigid rings.
    pub fn rigid(&self) -> Model {
        let mut geometry = BearingGeometry::reference_7010c();
        geometry.first_ball_azimuth = self.phase;
        if self.interference > 0.0 {
            geometry.outer_raceway_diameter =
                geometry.inner_raceway_diameter + 2.0 * geometry.ball_diameter - self.interference;
        }
        let steel = steel();
        let elastic = dynamics::model::elastic(&steel);
        let mut effects: Vec<Box<dyn Effect>> = vec![Box::new(AxialForce {
            value: self.axial,
            schedule: Schedule::Constant,
        })];
        effects.push(Box::new(RadialForce {
            value: self.radial,
            direction: 0.0,
            schedule: Schedule::Constant,
        }));
        effects.push(Box::new(Moment {
            value: [self.moment, 0.0],
            schedule: Schedule::Constant,
        }));
        let dof = |free: bool| {
            if free {
                ShaftDof::Free
            } else {
                ShaftDof::Prescribed(0.0)
            }
        };
        Model {
            hertz: Side::BOTH.map(|side| HertzContact::new(&geometry, side, elastic, elastic)),
            sphere: SphereCompliance::default(),
            surfaces: Default::default(),
            film_lift: [0.0; 2],
            shoulders: Default::default(),
            geometry,
            rings: [None, None],
            other_seats: [None, None],
            weighs_carried: true,
            mounting: Default::default(),
            ball_material: steel,
            ball_inner_diameter: 0.0,
            ring_material: steel,
            shaft: [
                dof(true),
                dof(true),
                dof(self.free_axial),
                dof(self.free_tilt),
                dof(self.free_tilt),
            ],
            shaft_schedules: Default::default(),
            shaft_mass: 0.0,
            shaft_inertia: ShaftInertia::default(),
            load_point: self.load_point,
            cage: None,
            contact: ContactSettings {
                mode: ContactMode::Rigid,
                least_patch: LEAST_PATCH,
                projects_grooves: !self.free_tilt,
            },
            effects,
            backend: dynamics::Backend::Auto,
            tolerances: Tolerances::default(),
        }
    }
}

pub fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).unwrap()
}

/// Static equilibrium of a model.
pub fn equilibrium(model: &Model) -> StaticSolution {
    StaticSolver::new(model).unwrap().solve(model, None).unwrap()
}

/// A state and those after it, of `n` steps.
pub fn states_from(motion: &Motion, start: MotionState, n: usize) -> Vec<MotionState> {
    let (mut states, mut cache) = (vec![start], StepCache::default());
    for _ in 0..n {
        states.push(motion.step(states.last().unwrap(), &mut cache).unwrap().0);
    }
    states
}

/// What is found on a number of threads.
pub fn on_threads<T: Send>(threads: usize, find: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(find)
}

/// Relative difference.
pub fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / a.abs().max(b.abs())
}

pub mod finite;
pub mod graded;
pub mod harris;
pub mod lines;
pub mod mounting;
pub mod rings;
pub mod worn;

use dynamics::Hold;
use rings::{Level, ring};

impl Case {
    /// The model with rigid rings and balls that yield as spheres.
    pub fn spheres(&self) -> Model {
        let mut model = self.rigid();
        let elastic = dynamics::model::elastic(&model.ball_material);
        model.sphere = SphereCompliance::new(elastic, model.geometry.ball_diameter, &model.hertz);
        model
    }

    /// The model with both rings flexible, on spheres but for facets.
    pub fn flexible(&self, mode: ContactMode, level: Level, hold: Hold) -> Model {
        let mut model = match mode {
            ContactMode::Facet => self.rigid(),
            ContactMode::Patch | ContactMode::Rigid => self.spheres(),
        };
        model.contact.mode = mode;
        model.rings = Side::BOTH.map(|side| Some(std::sync::Arc::new(ring(side, level, hold))));
        model
    }
}
