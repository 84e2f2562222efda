//! Inertia of the elastic part of a turning ring: left out where it is nothing, and only there.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::support::rings::{Level, ring};
use crate::support::{Case, equilibrium, on_threads, states_from};
use contact::Side;
use dynamics::effects::{FrameRotation, Loads, Now, static_inertia};
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::Speed;
use dynamics::model::InertiaLimit;
use dynamics::modes::ring_modes;
use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{
    Backend, ContactMode, DynamicsError, Effect, Hold, Model, ModesSettings, RingModel, RingSupport, Sectors,
    StaticSolution,
};
use ring::first_frequency::{FrequencyBounds, first_frequency, first_frequency_above, first_frequency_bound};
use ring::statics::StaticSettings;
use ring::{BodySettings, ElasticBody, Frame, Partner, elastic_body};

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// A limit that every ring of these tests keeps below.
const ALL: f64 = 1e-2;

fn rpm(speed: f64) -> f64 {
    speed * PI / 30.0
}

fn backends() -> [Backend; 3] {
    let sectors = Sectors {
        n_sectors: Some(5),
        ..Sectors::default()
    };
    [Backend::Auto, Backend::Sparse, Backend::Sector(sectors)]
}

/// Both rings, clamped and in their mean motion.
fn held_rings() -> impl Iterator<Item = (Side, RingModel)> {
    let sides = Side::BOTH.into_iter();
    let held = |side| [Hold::Clamped, Hold::MeanMotion].map(|hold| (side, ring(side, SMALL, hold)));
    sides.flat_map(held)
}

/// First natural frequency of a ring, rad/s, as modes have it.
fn first_of_modes(side: Side, ring: &RingModel) -> f64 {
    let settings = ModesSettings {
        number: 2,
        shift: None,
        backend: Backend::Auto,
    };
    let modes = ring_modes(side, ring, RingSupport::AsHeld, settings, &mut |_| ()).unwrap();
    TAU * modes.modes[0].frequency
}

/// A ring on a shaft in its turning frame, and what statics makes it with.
fn on_shaft(side: Side, ring: &RingModel, backend: Backend) -> (Arc<dyn ElasticBody>, StaticSettings) {
    let (name, partner) = (side.name(), Partner::SHAFT);
    let of_body = BodySettings {
        partner,
        damping: [0.0; 2],
        backend,
        frame: Frame::Turning,
    };
    let settings = StaticSettings {
        name,
        partner,
        backend,
        n_contacts: 1,
    };
    (elastic_body(name, ring, of_body).unwrap(), settings)
}

/// Wrong: what is left out would be judged by another frequency than that of the ring, or the quick bound would not be
/// one, or so poor that it never decides. Both rings, clamped and in their mean motion, against the modes of the ring
/// as it is held, with all linear solvers.
#[test]
fn the_first_frequency_is_that_of_the_modes_and_below_its_bound() {
    for (side, ring) in held_rings() {
        let expected = first_of_modes(side, &ring);
        for backend in backends() {
            let (body, settings) = on_shaft(side, &ring, backend);
            let found = first_frequency(&*body, &ring, settings).unwrap();
            let bound = first_frequency_bound(&*body, &ring);
            let off = found.square.sqrt() / expected - 1.0;
            println!(
                "{side:?} {:?} {backend:?}: {:.6} kHz, off by {off:.1e}, error {:.1e}; bound {:.4}",
                ring.hold,
                found.square.sqrt() / TAU / 1e3,
                found.error / found.square,
                bound / expected
            );
            // A Rayleigh quotient is no less than the value; its error is about the square of the residual.
            assert!(off > -1e-9 && off < 1e-3, "{off:e}");
            assert!(found.least() <= expected && found.error < 2e-2 * found.square);
            assert!(bound > expected && bound < 1.3 * expected, "{bound} {expected}");
        }
    }
}

/// Wrong: a ring would pass for stiffer than it is, so that inertia which acts is left out, or for softer, or the
/// threads would decide. A hundredth below and above the frequency of the modes, and far from it.
#[test]
fn the_first_frequency_is_above_what_is_less_and_not_above_what_is_more() {
    for (side, ring) in held_rings() {
        let expected = first_of_modes(side, &ring);
        for backend in backends() {
            let (body, settings) = on_shaft(side, &ring, backend);
            let most = first_frequency_bound(&*body, &ring);
            let above = |share: f64| {
                let least = share * expected;
                let bounds = FrequencyBounds { least, most };
                let found = [1, 2].map(|threads| {
                    on_threads(threads, || {
                        first_frequency_above((&*body, &ring), bounds, settings).unwrap()
                    })
                });
                assert_eq!(found[0], found[1], "threads decide");
                found[0]
            };
            let shares: &[f64] = match backend {
                Backend::Auto => &[1e-6, 0.3, 0.99],
                // One search, whatever the limit.
                _ => &[0.99],
            };
            for &share in shares {
                let bounds = above(share).unwrap();
                println!("{side:?} {:?} {backend:?} {share}: {bounds:?}", ring.hold);
                assert!(bounds.least <= expected && bounds.least >= share * expected);
                // As exact as the modes are, and for a log.
                assert!(bounds.most >= (1.0 - 1e-9) * expected && bounds.most <= 1.1 * bounds.least);
            }
            assert_eq!(above(1.01), None);
            assert_eq!(above(most / expected * 0.999_999), None);
        }
    }
}

/// Bearing under 1 kN of thrust that has rolled for a while.
fn bearing(hold: Hold, effects: Vec<Box<dyn Effect>>) -> Model {
    let case = Case {
        radial: 300.0,
        free_tilt: true,
        ..Case::axial(1000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, SMALL, hold);
    model.effects.extend(effects);
    model
}

/// Steps of a bearing whose contacts are damped.
fn settings(speed: &Speed) -> MotionSettings {
    MotionSettings {
        contact_damping: Some(ContactDamping {
            coefficient: 50.0,
            full_approach: 1e-6,
        }),
        ..MotionSettings::conserving(1e-5, speed.clone())
    }
}

fn run(model: &Model, start: &StaticSolution, speed: &Speed, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings(speed)).unwrap();
    states_from(&motion, motion.start(start), n)
}

/// A turning frame without the load of the undeformed ring.
struct NoLoad {
    negligible: f64,
    speed: f64,
}

impl Effect for NoLoad {
    fn name(&self) -> &'static str {
        "no_load"
    }

    fn add_loads(&self, _: &Model, _: &Now, _: &mut Loads) -> Result<(), DynamicsError> {
        Ok(())
    }

    fn turns_frame(&self, side: Side) -> bool {
        side == Side::Inner
    }

    fn inertia_limit(&self, side: Side) -> Option<InertiaLimit> {
        self.turns_frame(side).then_some(InertiaLimit {
            largest_speed: self.speed,
            largest_acceleration: 0.0,
            negligible: self.negligible,
        })
    }
}

/// The centrifugal load of undeformed rings as a load of its own, that stands in space.
struct Undeformed(Speed);

impl Effect for Undeformed {
    fn name(&self) -> &'static str {
        "undeformed"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let mut frames = Loads::none(model.geometry.n_balls);
        FrameRotation::new(self.0.clone()).add_loads(model, now, &mut frames)?;
        let angle = self.0.angle(now.time);
        let (sin, cos) = angle.sin_cos();
        let turned = |f: Vec<f64>| -> Vec<f64> {
            let of_node = |f: &[f64]| [cos * f[0] - sin * f[1], sin * f[0] + cos * f[1], f[2]];
            f.chunks_exact(3).flat_map(of_node).collect()
        };
        loads.rings = static_inertia(model, &frames)?.map(|load| load.map(turned));
        Ok(())
    }
}

fn assert_same_bits(a: &[MotionState], b: &[MotionState]) {
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.forces, b.forces);
        assert_eq!((a.shaft, a.shaft_velocity), (b.shaft, b.shaft_velocity));
        assert_eq!((&a.balls, &a.ball_velocities), (&b.balls, &b.ball_velocities));
        let rings = a.rings.iter().flatten().zip(b.rings.iter().flatten());
        rings.for_each(|(a, b)| assert_eq!(a.displacement(), b.displacement()));
        assert_eq!(a.ledger, b.ledger);
    }
}

/// Largest difference of the forces of two runs, over the largest force.
fn off(a: &[MotionState], b: &[MotionState]) -> f64 {
    let forces = |states: &[MotionState]| states.iter().flat_map(|s| s.forces.clone()).collect::<Vec<_>>();
    let (a, b) = (forces(a), forces(b));
    let largest = a.iter().map(|f| f.norm()).fold(0.0, f64::max);
    let pairs = a.iter().zip(&b);
    pairs.map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max) / largest
}

/// Wrong: a ring whose elastic inertia is left out would still be solved as one that has it: other bits, more rounds.
/// Without the load of the undeformed ring the run has the bits of one without the effect, on one thread and on two.
#[test]
fn what_is_left_out_has_the_bits_of_a_run_without_the_effect() {
    let speed = Speed::constant(rpm(1800.0));
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let left = NoLoad {
            negligible: ALL,
            speed: speed.largest(),
        };
        let plain = bearing(hold, Vec::new());
        let start = equilibrium(&plain);
        let expected = run(&plain, &start, &speed, 20);
        let model = bearing(hold, vec![Box::new(left)]);
        for threads in [1, 2] {
            let found = on_threads(threads, || run(&model, &start, &speed, 20));
            assert_same_bits(&found, &expected);
        }
    }
}

/// Wrong: the load of the undeformed ring would go with its elastic inertia, or be another: it is that of an
/// equilibrium put on the ring as a load of its own. With a speed that grows.
#[test]
fn the_load_of_the_undeformed_ring_stays() {
    let speed = Speed::table(vec![0.0, 1e-3], vec![rpm(2000.0), rpm(3000.0)]);
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let left = FrameRotation::new(speed.clone()).negligible_below(ALL);
        let model = bearing(hold, vec![Box::new(left)]);
        let start = equilibrium(&model);
        let found = run(&model, &start, &speed, 20);
        let by_hand = run(
            &bearing(hold, vec![Box::new(Undeformed(speed.clone()))]),
            &start,
            &speed,
            20,
        );
        let without = run(&bearing(hold, Vec::new()), &start, &speed, 20);
        let (same, other) = (off(&found, &by_hand), off(&found, &without));
        let defect = found[20].ledger.relative_defect();
        println!("{hold:?}: {same:.1e}; without the load {other:.1e}; ledger {defect:.1e}");
        assert!(same < 1e-11 && other > 1e3 * same, "{same:e} {other:e}");
        assert!(defect.abs() < 1e-9, "{defect:e}");
    }
}

/// Wrong: more would be left out than the share that the log says, or the choice would be made at another speed. A
/// bearing that rolls from its equilibrium: forces with and without differ by less than the share; with a limit just
/// below it, and with 0, everything acts and bits are those of an effect without a limit.
#[test]
fn forces_differ_by_less_than_the_share_that_is_left_out() {
    for (hold, speed) in [(Hold::Clamped, rpm(10e3)), (Hold::MeanMotion, rpm(1e3))] {
        let speed = Speed::constant(speed);
        let effect = |negligible: f64| -> Vec<Box<dyn Effect>> {
            vec![Box::new(
                FrameRotation::new(speed.clone()).negligible_below(negligible),
            )]
        };
        let whole = bearing(hold, vec![Box::new(FrameRotation::new(speed.clone()))]);
        let start = equilibrium(&whole);
        let left_model = bearing(hold, effect(ALL));
        let motion = Motion::new(&left_model, settings(&speed)).unwrap();
        let left = motion.left_out(Side::Inner).unwrap();
        assert!(motion.left_out(Side::Outer).is_none());
        // What is left out, and its bound by that of the frequency.
        let lowest = first_of_modes(Side::Inner, left_model.rings[0].as_ref().unwrap());
        let (share, bound) = ((speed.largest() / lowest).powi(2), left.share());
        assert!(bound >= share && bound < 1.21 * share, "{bound} {share}");
        let n = 150;
        let all = run(&whole, &start, &speed, n);
        let off = off(&all, &run(&left_model, &start, &speed, n));
        let note = left.note();
        println!("{hold:?}: share {share:.2e}, forces differ by {off:.2e}\n{note}");
        assert!(off < share && off > 0.0, "{off:e} {share:e}");
        for negligible in [0.0, 0.98 * share] {
            let model = bearing(hold, effect(negligible));
            assert!(
                Motion::new(&model, settings(&speed))
                    .unwrap()
                    .left_out(Side::Inner)
                    .is_none()
            );
            assert_same_bits(&run(&model, &start, &speed, 3), &all[..4]);
        }
        let model = bearing(hold, effect(1.02 * share));
        assert!(
            Motion::new(&model, settings(&speed))
                .unwrap()
                .left_out(Side::Inner)
                .is_some()
        );
    }
}

/// Wrong: a ring would lose inertia that the shaft does not take for it, or stiffness that the scene asks for.
#[test]
fn free_and_stiffened_rings_keep_their_inertia() {
    let speed = Speed::constant(rpm(100.0));
    let turning = || FrameRotation::new(speed.clone()).negligible_below(ALL);
    let left_out = |hold: Hold, effect: FrameRotation| {
        let mut model = bearing(hold, vec![Box::new(effect)]);
        if hold == Hold::Free {
            model.rings[1] = None;
        }
        let motion = Motion::new(&model, settings(&speed)).unwrap();
        motion.left_out(Side::Inner).is_some()
    };
    assert!(left_out(Hold::MeanMotion, turning()));
    assert!(!left_out(Hold::MeanMotion, turning().stiffened()));
    assert!(!left_out(Hold::Free, turning()));
}
