//! A spring that presses the outer ring along the axis: balance, the mirror of a load on the shaft, the ledger, modes.

use std::f64::consts::TAU;

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use dynamics::effects::{
    AxialForce, BallCentrifugal, Gravity, GyroscopicMoment, MomentShares, RadialForce, SpringPreload,
};
use dynamics::interactions::seat_spring::Seat;
use dynamics::kinematics::Speed;
use dynamics::modes::bearing_modes;
use dynamics::motion::{Ladder, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, ContactMode, Hold, Model, ModesSettings, ShaftDof, StaticSolution, StaticSolver};
use input::Schedule;

const SMALL: Level = Level::hex8(54, 6, 1, 2);
const FORCE: f64 = 500.0;

/// The model on a locked shaft, with a spring instead of its loads.
fn sprung(mut model: Model, stiffness: f64, mass: f64) -> Model {
    model.effects.clear();
    model.effects.push(Box::new(SpringPreload {
        seat: Seat {
            mass,
            force: FORCE,
            stiffness,
        },
    }));
    model.shaft = [ShaftDof::Prescribed(0.0); 5];
    model
}

fn with_shaft(mut model: Model, z: f64) -> Model {
    model.shaft[2] = ShaftDof::Prescribed(z);
    model
}

/// Bearings with rigid rings, and with flexible ones that are held in both ways.
fn bearings() -> Vec<Model> {
    let case = Case::axial(FORCE);
    vec![
        case.rigid(),
        case.flexible(ContactMode::Patch, SMALL, Hold::Clamped),
        case.flexible(ContactMode::Patch, SMALL, Hold::MeanMotion),
    ]
}

/// Axial force of all balls on the outer ring, N.
fn on_outer(solution: &StaticSolution) -> f64 {
    let contacts = solution.balls.iter().map(|ball| &ball.outer);
    contacts.map(|c| c.force_n * c.contact_angle_rad.sin()).sum()
}

/// Wrong: the spring would press with another force, or the seat slide the other way. A constant force on the outer
/// ring is the mirror of the same force on the shaft: equal ball forces, opposite displacements.
#[test]
fn a_constant_force_is_the_mirror_of_an_axial_load() {
    for (loaded, bare) in bearings().into_iter().zip(bearings()) {
        let by_load = equilibrium(&loaded);
        let by_spring = equilibrium(&sprung(bare, 0.0, 0.0));
        let (z, seat) = (by_load.displacements.shaft[2], by_spring.displacements.seat);
        assert!((z + seat).abs() < 1e-9 * z.abs(), "{z} {seat}");
        for (a, b) in by_load.balls.iter().zip(&by_spring.balls) {
            assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-9);
            assert!(relative(a.outer.contact_angle_rad, b.outer.contact_angle_rad) < 1e-9);
        }
        assert!(relative(on_outer(&by_spring), FORCE) < 1e-9);
        assert!(by_spring.work_defect.abs() < 1e-9 * by_spring.load_work.abs().max(1e-6));
    }
}

/// Wrong: the preload would not follow F0 + k u when the shaft moves. A soft spring keeps it, a stiff one does not.
#[test]
fn the_force_follows_the_spring_as_the_shaft_moves() {
    for stiffness in [1e4, 1e7] {
        for (z, bearing) in [-5e-6, 0.0, 5e-6].into_iter().zip(bearings()) {
            let found = equilibrium(&with_shaft(sprung(bearing, stiffness, 0.0), z));
            let spring = FORCE + stiffness * found.displacements.seat;
            assert!(relative(on_outer(&found), spring) < 1e-9, "{z} {stiffness}");
        }
    }
}

fn run(motion: &Motion<'_>, mut state: MotionState, n: usize) -> MotionState {
    let mut cache = StepCache::default();
    for _ in 0..n {
        state = motion.step(&state, &mut cache).unwrap().0;
        assert!(
            state.ledger.relative_defect().abs() < 1e-9,
            "step {}: {:?}",
            state.step,
            state.ledger
        );
    }
    state
}

/// Wrong: a sprung bearing would not stay in its equilibrium, or the spring make energy when a blow moves the ring:
/// with a mass that slides and without one, rigid and flexible rings.
#[test]
fn a_motion_keeps_the_balance_and_the_ledger() {
    for mass in [0.0, 0.3] {
        for bearing in bearings() {
            let mut model = sprung(bearing, 1e6, mass);
            let rest = equilibrium(&model);
            let speed = Speed::constant(100.0);
            let still = {
                let motion = Motion::new(&model, MotionSettings::conserving(1e-5, speed.clone())).unwrap();
                run(&motion, motion.start(&rest), 20).seat.unwrap()
            };
            let seat = rest.displacements.seat;
            // Balls on few elements roll over a ripple.
            assert!((still[0] - seat).abs() < 0.02 * seat.abs(), "{still:?} {seat}");
            model.shaft[0] = ShaftDof::Free;
            model.shaft_mass = 1.0;
            model.effects.push(Box::new(RadialForce {
                value: 800.0,
                direction: 0.0,
                schedule: Schedule::Constant,
            }));
            let motion = Motion::new(&model, MotionSettings::conserving(1e-5, speed)).unwrap();
            let moved = run(&motion, motion.start(&rest), 60);
            assert!(
                (moved.seat.unwrap()[0] - seat).abs() > 1e-8,
                "the blow moves the seat"
            );
        }
    }
}

/// Wrong: integrators that dissipate would gain from the spring, or the ladder of steps lose the seat.
#[test]
fn a_dissipating_integrator_only_takes_energy_from_the_spring() {
    let mut model = sprung(Case::axial(FORCE).rigid(), 1e6, 0.3);
    let rest = equilibrium(&model);
    model.shaft[2] = ShaftDof::Prescribed(2e-6);
    let settings = MotionSettings {
        integrator: dynamics::motion::Integrator::hht(0.1),
        ladder: Ladder {
            halvings: 3,
            tolerance: None,
        },
        ..MotionSettings::conserving(1e-5, Speed::constant(0.0))
    };
    let motion = Motion::new(&model, settings).unwrap();
    let start = motion.with_accelerations(motion.start(&rest)).unwrap();
    let end = run(&motion, start, 100);
    assert!(end.ledger.numerical_loss > 0.0, "{:?}", end.ledger);
}

/// Wrong: the spring would have no place in modes. A heavy seat on the bearing's axial stiffness and the spring:
/// omega^2 = (k + K)/m, K from the forces of two equilibria.
#[test]
fn a_heavy_seat_swings_on_spring_and_balls() {
    let (mass, stiffness) = (1000.0, 5e7);
    for bearing in [
        Case::axial(FORCE).rigid(),
        Case::axial(FORCE).flexible(ContactMode::Patch, SMALL, Hold::Clamped),
    ] {
        let at = |z: f64| {
            let mut model = with_shaft(sprung(Case::axial(FORCE).rigid(), stiffness, mass), z);
            model.rings = bearing.rings.clone();
            model.contact.mode = bearing.contact.mode;
            let found = equilibrium(&model);
            (model, found)
        };
        let approach = |s: &StaticSolution, z: f64| z - s.displacements.seat;
        let (h, (model, middle)) = (1e-8, at(0.0));
        let [(_, low), (_, high)] = [at(-h), at(h)];
        let slope = (on_outer(&high) - on_outer(&low)) / (approach(&high, h) - approach(&low, -h));
        let expected = ((stiffness + slope) / mass).sqrt() / TAU;
        let settings = ModesSettings {
            number: 4,
            shift: None,
            backend: Backend::Auto,
        };
        let modes = bearing_modes(&model, &middle, settings, &mut |_| ())
            .unwrap()
            .modes;
        let found = modes
            .iter()
            .find(|mode| !mode.is_rigid && mode.frequency > 0.5 * expected)
            .unwrap();
        assert!(
            relative(found.frequency, expected) < 1e-3,
            "{} {expected}",
            found.frequency
        );
    }
}

/// Wrong: what slides with a ring would have no weight, or a flexible ring its weight twice. Under 1000 g along the
/// axis the balls carry the spring less the weight.
#[test]
fn what_slides_has_its_weight() {
    let (mass, g) = (0.2, -1e4);
    for bearing in bearings() {
        let ring = bearing.rings[1]
            .as_ref()
            .map_or(0.0, |ring| ring.node_masses("outer").unwrap().total);
        let mut model = sprung(bearing, 1e6, mass);
        // Forces along the normals alone.
        model.sphere = Default::default();
        let gravity = Gravity::new([0.0, 0.0, g], Schedule::Constant, &model.rings).unwrap();
        model.effects.push(Box::new(gravity));
        let found = equilibrium(&model);
        let spring = FORCE + 1e6 * found.displacements.seat;
        let expected = spring - (mass + ring) * g;
        assert!(
            relative(on_outer(&found), expected) < 1e-9,
            "{} {expected}",
            on_outer(&found)
        );
        assert!(found.work_defect.abs() < 1e-9 * found.load_work.abs());
        let motion = Motion::new(&model, MotionSettings::conserving(1e-5, Speed::constant(0.0))).unwrap();
        let (start, seat) = (motion.start(&found), found.displacements.seat);
        let still = run(&motion, start, 10).seat.unwrap();
        assert!((still[0] - seat).abs() < 1e-6 * seat.abs(), "{still:?} {seat}");
    }
}

/// Wrong: friction that carries a gyroscopic moment would work on the seat and not be counted.
#[test]
fn forces_across_the_contacts_are_in_the_balance() {
    let speed = Speed::constant(2000.0);
    for bearing in bearings() {
        let mut model = sprung(bearing, 1e6, 0.0);
        model.effects.push(Box::new(BallCentrifugal {
            speeds: speed.clone().into(),
            slip: Default::default(),
            ball_speeds: Default::default(),
        }));
        model.effects.push(Box::new(GyroscopicMoment {
            speeds: speed.clone().into(),
            slip: Default::default(),
            shares: MomentShares::OUTER_CONTROL,
            ball_speeds: Default::default(),
        }));
        let found = equilibrium(&model);
        let scale = found.load_work.abs();
        assert!(
            found.work_defect.abs() < 1e-8 * scale,
            "{:e} of {scale:e}",
            found.work_defect
        );
    }
}

/// Wrong: a bearing that slides as a whole would be taken as held, or the cause not be named.
#[test]
fn nothing_that_holds_the_axis_is_said() {
    let mut model = sprung(Case::axial(FORCE).rigid(), 0.0, 0.0);
    model.shaft[2] = ShaftDof::Free;
    model.effects.push(Box::new(BallCentrifugal {
        speeds: Speed::constant(2000.0).into(),
        slip: Default::default(),
        ball_speeds: Default::default(),
    }));
    let hint =
        "the outer ring slides too: lock or prescribe shaft.z, or give effects.spring_preload.stiffness";
    let solve = |model: &Model| StaticSolver::new(model).unwrap().solve(model, None);
    let error = solve(&model).err().unwrap().to_string();
    assert!(error.contains(hint), "{error}");
    model.effects.push(Box::new(AxialForce {
        value: FORCE,
        schedule: Schedule::Constant,
    }));
    let error = solve(&model).err().unwrap().to_string();
    assert!(
        error.contains("z of the shaft is free but nothing resists it"),
        "{error}"
    );
    assert!(error.contains(hint), "{error}");
}

/// Wrong: a seat without mass whose balls do not touch yet would be told to give the shaft a mass.
#[test]
fn a_seat_that_nothing_places_has_its_own_remedy() {
    let model = sprung(Case::axial(FORCE).rigid(), 0.0, 0.0);
    let motion = Motion::new(&model, MotionSettings::conserving(1e-5, Speed::constant(0.0))).unwrap();
    let start = motion.rest([0.0; 5], [0.0; 5]);
    let error = motion
        .step(&start, &mut StepCache::default())
        .unwrap_err()
        .to_string();
    let expected = "give effects.spring_preload its mass or a stiffness, or start from equilibrium";
    assert!(
        error.contains("z of the outer ring's seat is free") && error.contains(expected),
        "{error}"
    );
}
