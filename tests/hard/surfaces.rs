//! Real surfaces: balls that fall into spalls and hit their ends, fly over waves, and meet what is no groove any more.

use std::collections::BTreeMap;
use std::sync::Arc;

use contact::surface::{Dent, Heights, Spall, Wave};
use contact::{BallSurface, Profiles, Side, StripLaw, StripSurface};
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::{Kinematics, RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{Model, Pose, StaticSolver};

use super::bearings::{Load, RPM, equilibrium_at, flexible, halvings, largest_ball_force, rigid, set_loads};
use super::course::{Course, march_with};
use super::plot::{Curve, Plot};
use super::record::Record;
use super::{HardCase, surface_balls, surface_spalls, surface_waves};

/// Ledger defect over the largest energy.
const CLOSED: f64 = 1e-8;
/// Time until ball 0 enters the spalls of [`Rolling::spall`], s.
pub const ENTRY: f64 = 50e-6;

pub fn cases() -> Vec<HardCase> {
    let rings = super::both(surface_spalls::cases(), surface_waves::cases());
    super::both(rings, surface_balls::cases())
}

/// A bearing that rolls over real surfaces.
pub struct Rolling {
    pub axial: Load,
    pub radial: Load,
    pub speeds: RingSpeeds,
    /// Speed at the start, rad/s.
    pub speed: f64,
    /// Profiles, inner ring first.
    pub profiles: [Profiles; 2],
    /// Profiles of balls.
    pub balls: BTreeMap<usize, Profiles>,
    /// Groove angles of the outer shoulders, rad.
    pub shoulders: Option<[f64; 2]>,
    /// How much larger each ball is, m.
    pub oversizes: Vec<f64>,
    pub is_flexible: bool,
    pub is_damped: bool,
    pub integrator: dynamics::motion::Integrator,
    pub dt: f64,
    pub duration: f64,
}

impl Rolling {
    /// Rigid rings under an axial load, N, at a speed, rpm, on smooth strips; steps of 2 us, 0.6 ms.
    pub fn at(axial: f64, rpm: f64) -> Rolling {
        Rolling {
            axial: Load::dead(axial),
            radial: Load::dead(0.0),
            speeds: Speed::constant(rpm * RPM).into(),
            speed: rpm * RPM,
            profiles: Default::default(),
            balls: BTreeMap::new(),
            shoulders: None,
            oversizes: Vec::new(),
            is_flexible: false,
            is_damped: false,
            integrator: dynamics::motion::Integrator::average_acceleration(),
            dt: 2e-6,
            duration: 0.6e-3,
        }
    }

    pub fn smooth(&self) -> Model {
        let build = if self.is_flexible { flexible } else { rigid };
        let mut model = build(self.axial.clone(), self.radial.clone());
        model.sphere = Default::default();
        if self.is_flexible {
            model.shaft_mass = super::bearings::SHAFT_MASS;
        }
        model
    }

    pub fn model(&self) -> Model {
        let mut model = self.smooth();
        self.put_on(&mut model);
        model
    }

    /// Gives a model these surfaces.
    pub fn put_on(&self, model: &mut Model) {
        for side in Side::BOTH {
            let profiles = &self.profiles[side.index()];
            let law = StripLaw::new(&model.hertz[side.index()], model.geometry.groove_radius(side));
            let shoulders = self.shoulders.filter(|_| side == Side::Outer);
            let shoulders = shoulders.map(|[low, high]| low..=high);
            let surface = StripSurface::new(law, (&model.geometry, side), shoulders, profiles);
            model.surfaces.strips[side.index()] = Some(Arc::new(surface.unwrap()));
        }
        model.surfaces.oversizes.clone_from(&self.oversizes);
        for (ball, profiles) in &self.balls {
            let geometry = model.geometry;
            let surface = |side| {
                let equator = geometry.free_contact_angle();
                Arc::new(BallSurface::new((&geometry, side), equator, profiles).unwrap())
            };
            model.surfaces.balls.insert(*ball, Side::BOTH.map(surface));
        }
    }

    /// Contact angle outside under the loads of the start, on smooth grooves, rad.
    pub fn contact_angle(&self) -> f64 {
        let solution = equilibrium_at(&self.smooth(), 0.0).unwrap();
        solution.balls[0].outer.contact_angle_rad
    }

    /// A sharp spall on the outer ring, wider than the ellipses, that a ball enters [`ENTRY`] after the start.
    pub fn spall(&self, ball: usize, length: f64, depth: f64) -> Spall {
        let geometry = self.smooth().geometry;
        let angle = self.contact_angle();
        let radius = geometry.centre_radius(Side::Outer) + geometry.groove_radius(Side::Outer) * angle.cos();
        let cage = Kinematics::new(&geometry, [0.0; 2]).cage;
        Spall {
            azimuth: geometry.azimuth(ball) + ENTRY * cage * self.speed + 0.5 * length / radius,
            groove_angle: angle,
            length,
            width: 4e-3,
            depth,
            edge: 0.0,
        }
    }

    /// With one such spall under ball 0.
    pub fn over(self, length: f64, depth: f64) -> Rolling {
        let spall = self.spall(0, length, depth);
        self.with(Side::Outer, |profiles| profiles.spalls.push(spall))
    }

    pub fn with(mut self, side: Side, add: impl FnOnce(&mut Profiles)) -> Rolling {
        add(&mut self.profiles[side.index()]);
        self
    }

    pub fn waves(self, side: Side, order: usize, amplitude: f64) -> Rolling {
        let wave = Wave {
            order,
            amplitude,
            phase: 0.3,
        };
        self.with(side, |profiles| profiles.waves.push(wave))
    }

    /// Runs it from its equilibrium; `look` sees every state.
    pub fn course(&self, mut look: impl FnMut(&MotionState)) -> (Course, Curve) {
        let model = self.model();
        let settings = MotionSettings {
            ladder: halvings(4),
            integrator: self.integrator,
            contact_damping: self.is_damped.then_some(ContactDamping {
                coefficient: 100.0,
                full_approach: 3e-6,
            }),
            ..MotionSettings::conserving(self.dt, self.speeds.clone())
        };
        let start = equilibrium_at(&model, 0.0).unwrap();
        let motion = Motion::new(&model, settings).unwrap();
        let state = motion.with_accelerations(motion.start(&start)).unwrap();
        let n = (self.duration / self.dt).round() as usize;
        let mut points = Vec::new();
        let course = march_with(&motion, state, n, |state| {
            if state.step % (n as u64 / 200).max(1) == 0 {
                points.push([1e3 * motion.time(state.step), outer_force(state, 0)]);
            }
            look(state);
        });
        let name = "outer contact of ball 0".to_string();
        (course, Curve { name, points })
    }

    /// It must end with a closed ledger, to which surfaces belong.
    pub fn holds(&self, record: &mut Record) -> Course {
        self.seen(record, |_| ())
    }

    /// The same, looking at every state.
    pub fn seen(&self, record: &mut Record, mut look: impl FnMut(&MotionState)) -> Course {
        let mut work = 0.0f64;
        let (course, curve) = self.course(|state| {
            work = work.max(state.ledger.profile_work.abs());
            look(state);
        });
        record.closed(&course);
        record.below("ledger defect with profiles", course.defect, CLOSED);
        record.that("surfaces do work", work > 0.0);
        record.note(format!(
            "largest force {:.0} N, at most {} open contacts, work of profiles up to {work:.1e} J, {} parts done again",
            course.peak, course.open, course.retries
        ));
        record.plot = Some(Plot {
            x: "time, ms",
            y: "force, N",
            curves: vec![curve],
        });
        course
    }
}

/// Force of an outer contact, N.
pub fn outer_force(state: &MotionState, ball: usize) -> f64 {
    state.forces[2 * ball + 1].norm()
}

/// 2 kN at 1800 rpm.
pub fn usual() -> Rolling {
    Rolling::at(2000.0, 1800.0)
}

/// A rough surface: a wave of each order, of an amplitude that falls as its inverse.
pub fn rough(orders: std::ops::RangeInclusive<usize>, amplitude: f64) -> Vec<Wave> {
    let first = *orders.start() as f64;
    let wave = |order: usize| Wave {
        order,
        amplitude: amplitude * first / order as f64,
        // Phases that follow no pattern: the golden angle.
        phase: 2.399_963 * (order * order) as f64,
    };
    orders.map(wave).collect()
}

/// Dents with raised rims along the track of a ring, one every `pitch` rad.
pub fn dents(angle: f64, pitch: f64, depth: f64, rim_height: f64) -> Vec<Dent> {
    let n = (std::f64::consts::TAU / pitch) as usize;
    let dent = |i: usize| Dent {
        azimuth: pitch * i as f64,
        groove_angle: angle,
        diameter: 0.3e-3,
        depth,
        rim_height,
        rim_width: 0.1e-3,
    };
    (0..n).map(dent).collect()
}

/// A measured surface: heights up to 1 um that follow no pattern, and a bump 8 um high beyond ball 0.
pub fn measured(bump: f64) -> Heights {
    let n = 720;
    let angles = [-0.2f64, 0.2, 0.36, 0.6];
    let noise = |i: usize, k: usize| (1e3 * (1.7 * (i * i) as f64 + 12.9 * k as f64).sin()).fract();
    Heights {
        azimuths: (0..n)
            .map(|i| std::f64::consts::TAU * i as f64 / n as f64)
            .collect(),
        angles: angles.to_vec(),
        heights: (0..n)
            .flat_map(|i| {
                (0..angles.len()).map(move |k| 1e-6 * noise(i, k) + if i == 1 { bump } else { 0.0 })
            })
            .collect(),
    }
}

/// Equilibria over a spall under the most loaded ball, from a scratch to deeper than the ball sinks.
pub fn at_rest(record: &mut Record) {
    let case = Rolling {
        radial: Load::dead(1000.0),
        ..Rolling::at(2000.0, 1800.0)
    };
    let mut last = f64::INFINITY;
    let mut deepest = Vec::new();
    for depth in [1e-7, 1e-6, 3e-6, 10e-6, 24e-6, 50e-6, 1e-3] {
        let mut spall = case.spall(0, 1e-3, depth);
        spall.azimuth = 0.0;
        let mut model = Rolling::at(2000.0, 1800.0)
            .with(Side::Outer, |p| p.spalls.push(spall))
            .model();
        set_loads(&mut model, Load::dead(2000.0), Load::dead(1000.0));
        let solution = StaticSolver::new(&model).and_then(|mut s| s.solve_at(&model, &Pose::default(), None));
        let Ok(solution) = solution else {
            record.that(&format!("{:.1} um: an equilibrium is found", 1e6 * depth), false);
            continue;
        };
        let force = solution.balls[0].outer.force_n;
        record.that(
            &format!(
                "{:.1} um: ball 0 carries {force:.1} N, no more than over less",
                1e6 * depth
            ),
            force <= last * (1.0 + 1e-9) && largest_ball_force(&solution).is_finite(),
        );
        last = force;
        deepest.push(force);
    }
    let [.., before, end] = deepest[..] else { return };
    record.below("difference beyond the sag, N", (end - before).abs(), 1e-6);
}
