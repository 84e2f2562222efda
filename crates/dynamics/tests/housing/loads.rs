//! Loads on all of a body: the weight of a housing and of a shaft, against ring and body meshed as one, at rest and in
//! motion, its ledger and its bits.

use std::sync::Arc;

use body::{SeatTie, Surrounding};
use contact::{Meridian, Side};
use dynamics::effects::{FrameRotation, Gravity};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, Hold, Model, RingModel, ShaftDof};
use input::Schedule;

use super::motion::{histories_of, struck};
use super::shaft::{as_one, free, hollow_shaft, inner};
use super::{
    bearing, difference, equilibrium, every_fifth, forces, harmonics, outer, space, surrounding, tube,
};
use crate::support::{on_threads, steel};

/// A gravity by which bodies sag as much as the loads bend them, m/s^2.
const GRAVITY: [f64; 3] = [3e4, -6e4, 2e4];
/// Step, s.
const STEP: f64 = 1e-5;

/// A ring on a body that feels loads on all of it, moving with its modes below a frequency or at rest.
fn tied_to(ring: RingModel, body: Surrounding, below: Option<f64>) -> RingModel {
    let body = Arc::new(body.with_loads(None).unwrap());
    let tie = SeatTie::to_seat(body.clone(), 0);
    let tie = match below {
        Some(below) => tie.in_motion(Arc::new(body.modes(below).unwrap())),
        None => tie,
    };
    RingModel {
        tie: Some(Arc::new(tie)),
        ..ring
    }
}

fn in_housing(mesh: mesh::Mesh, [n, across]: [usize; 2], below: Option<f64>) -> RingModel {
    let ring = outer(Hold::MeanMotion);
    let body = surrounding(mesh, space(&ring, harmonics(n, across)), steel());
    tied_to(ring, body, below)
}

fn on_shaft(mesh: mesh::Mesh, [n, across]: [usize; 2], below: Option<f64>) -> RingModel {
    let ring = inner(Hold::MeanMotion);
    let body = surrounding(mesh, space(&ring, harmonics(n, across)), steel());
    let body = body.on_shaft(&[ring.groove.centre_z]).unwrap();
    tied_to(ring, body, below)
}

/// Ring and housing as one mesh.
fn housing_as_one(layers: usize) -> RingModel {
    RingModel {
        mesh: tube(&outer(Hold::Clamped), layers).1,
        held_group: "feet",
        ..outer(Hold::Clamped)
    }
}

fn heavy(mut model: Model, schedule: Schedule) -> Model {
    let gravity = Gravity::new(GRAVITY, schedule, &model.rings).unwrap();
    model.effects.push(Box::new(gravity));
    model
}

/// Largest differences of the displacement of a ring, of the ball forces and of the shaft from those of one mesh.
fn differences(side: Side, model: &Model, one: &Model) -> [f64; 3] {
    let [found, expected] = [model, one].map(equilibrium);
    let (at, n_ring) = (side.index(), model.ring(side).unwrap().mesh.n_dofs());
    let of_one = &expected.elastic[at].as_ref().unwrap()[..n_ring];
    let work = found.work_defect.abs() / found.load_work;
    assert!(work < 1e-9, "the virtual work does not close: {work:e}");
    [
        difference(found.elastic[at].as_ref().unwrap(), of_one),
        difference(&forces(&found), &forces(&expected)),
        difference(&found.displacements.shaft, &expected.displacements.shaft),
    ]
}

/// Wrong: a housing would not sag, or not as the body that it is together with its ring. With all functions of the
/// nodes both are the same; without its weight they are not.
#[test]
fn a_housing_sags_as_one_mesh_with_its_ring() {
    let own = tube(&outer(Hold::Clamped), 3).0;
    let one = heavy(bearing(housing_as_one(3), Backend::Sparse), Schedule::Constant);
    let off = |functions: [usize; 2]| {
        let model = bearing(in_housing(own.clone(), functions, None), Backend::Auto);
        differences(Side::Outer, &heavy(model, Schedule::Constant), &one)
    };
    let [few, all] = [[12, 2], [18, 6]].map(off);
    let ring = outer(Hold::MeanMotion);
    let light = surrounding(own, space(&ring, harmonics(18, 6)), steel());
    let light = RingModel {
        tie: Some(Arc::new(SeatTie::to_seat(Arc::new(light), 0))),
        ..ring
    };
    let light = heavy(bearing(light, Backend::Auto), Schedule::Constant);
    let light = differences(Side::Outer, &light, &one);
    println!("few {few:?}, all {all:?}, without weight {light:?}");
    assert!(all.iter().all(|off| *off < 1e-9), "{all:?}");
    assert!(few[0] < 0.02 && few[1] < 1e-2, "{few:?}");
    assert!(light[0] > 0.1 && light[2] > 0.01, "{light:?}");
}

/// The same of a shaft.
#[test]
fn a_shaft_sags_as_one_mesh_with_its_ring() {
    let own = hollow_shaft(3).0;
    let one = heavy(
        super::shaft::bearing(as_one(3), Backend::Sparse),
        Schedule::Constant,
    );
    let off = |ring: RingModel| {
        let model = super::shaft::bearing(ring, Backend::Auto);
        differences(Side::Inner, &heavy(model, Schedule::Constant), &one)
    };
    let all = off(on_shaft(own.clone(), [18, 6], None));
    let light = off(super::shaft::on_shaft(own, [18, 6], None));
    println!("all {all:?}, as a rigid one {light:?}");
    assert!(all.iter().all(|off| *off < 1e-9), "{all:?}");
    assert!(light[0] > 0.05, "{light:?}");
}

/// Half of the weight goes on a sudden.
fn half() -> Schedule {
    Schedule::Step {
        before: 1.0,
        after: 0.5,
        at: 3.25 * STEP,
    }
}

/// States of the motion from the equilibrium, every fifth of `n` steps.
fn course(model: &Model, speed: f64, n: usize) -> Vec<MotionState> {
    let settings = MotionSettings::conserving(STEP, Speed::constant(speed));
    let motion = Motion::new(model, settings).unwrap();
    every_fifth(&motion, motion.start(&equilibrium(model)), n)
}

/// Wrong: energy would come from nowhere, or go.
fn assert_closed(states: &[MotionState]) {
    for state in states {
        let ledger = &state.ledger;
        assert!(ledger.relative_defect().abs() < 1e-9, "{ledger:?}");
    }
}

/// Wrong: a housing that moves would not feel its weight, or the weight would make energy that no line of the ledger
/// has. Half of gravity goes on a sudden: as one mesh with its ring.
#[test]
fn a_housing_moves_under_its_weight_as_one_mesh() {
    let (own, n) = (tube(&outer(Hold::Clamped), 3).0, 30);
    let one = heavy(struck(housing_as_one(3), Backend::Sparse), half());
    let expected = histories_of(&course(&one, 100.0, n), Side::Outer);
    let ring = in_housing(own, [18, 6], Some(60e3));
    let states = course(&heavy(struck(ring, Backend::Auto), half()), 100.0, n);
    let found = histories_of(&states, Side::Outer);
    let errors = [0, 1].map(|i| difference(&found[i], &expected[i]));
    println!("shaft and forces: {errors:?}");
    assert!(errors[0] < 1e-2 && errors[1] < 2e-2, "{errors:?}");
    assert_closed(&states);
}

/// The same of a shaft that turns: gravity turns in its frame.
#[test]
fn a_turning_shaft_moves_under_its_weight_as_one_mesh() {
    let (own, n) = (hollow_shaft(3).0, 30);
    let of = |model: Model| {
        let mut model = heavy(model, half());
        model.shaft[3] = ShaftDof::Prescribed(0.0);
        model.shaft[4] = ShaftDof::Prescribed(0.0);
        course(&model, 1000.0, n)
    };
    let expected = histories_of(&of(free(as_one(3), Backend::Sparse)), Side::Inner);
    let states = of(free(on_shaft(own, [18, 6], Some(60e3)), Backend::Auto));
    let found = histories_of(&states, Side::Inner);
    let errors = [0, 1].map(|i| difference(&found[i], &expected[i]));
    println!("shaft and forces: {errors:?}");
    assert!(errors[0] < 2e-3 && errors[1] < 1e-2, "{errors:?}");
    assert_closed(&states);
}

/// Wrong: a bearing in a heavy housing, or on a heavy shaft, would not stay where it is in equilibrium, or its joint
/// would seem to carry in motion what it does not at rest.
#[test]
fn an_equilibrium_under_weight_stays() {
    let housed = struck(
        in_housing(tube(&outer(Hold::Clamped), 2).0, [6, 2], Some(20e3)),
        Backend::Auto,
    );
    let mut shafted = free(on_shaft(hollow_shaft(2).0, [6, 2], Some(20e3)), Backend::Auto);
    shafted.shaft[3] = ShaftDof::Prescribed(0.0);
    shafted.shaft[4] = ShaftDof::Prescribed(0.0);
    for (side, model) in [(Side::Outer, housed), (Side::Inner, shafted)] {
        assert_stays(&heavy(model, Schedule::Constant), side);
    }
}

/// A bearing stays in its equilibrium, and the joint of a ring carries in motion what it carries at rest.
pub fn assert_stays(model: &Model, side: Side) {
    let rest = equilibrium(model);
    let motion = Motion::new(model, MotionSettings::conserving(STEP, Speed::constant(0.0))).unwrap();
    let (mut state, mut cache) = (motion.start(&rest), StepCache::default());
    for _ in 0..20 {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    let off = difference(&state.shaft, &rest.displacements.shaft);
    assert!(off < 1e-7, "{off:e}");
    assert!(state.ledger.kinetic.iter().sum::<f64>() < 1e-12 * state.ledger.strain[side.index()]);
    let ring = model.ring(side).unwrap();
    let (tie, functions) = (
        ring.tie.clone().unwrap(),
        ring.seat_functions(side.name()).unwrap(),
    );
    let acting = model.acting(side, rest.body_load(model, side));
    let field = rest.elastic[side.index()].as_ref().unwrap();
    let expected = tie.traction(&functions.unwrap(), field, acting).unwrap();
    let moved = state.rings[side.index()].as_ref().unwrap().body().unwrap();
    let found = motion.tied(side).unwrap();
    let found = found.traction(moved, motion.body_load(&state, side)).unwrap();
    let errors = [
        difference(&found.forces, &expected.forces),
        difference(&found.motion, &expected.motion),
    ];
    println!("{}: {errors:?}", side.name());
    assert!(errors[0] < 1e-5 && errors[1] < 1e-6, "{errors:?}");
}

/// Wrong: threads would change bits under loads on a body, or a body that could be loaded but is not would move
/// otherwise than one that nobody asked.
#[test]
fn loads_on_a_body_keep_the_bits() {
    let own = tube(&outer(Hold::Clamped), 2).0;
    let moved = |threads: usize| {
        on_threads(threads, || {
            let ring = in_housing(own.clone(), [6, 2], Some(20e3));
            course(&heavy(struck(ring, Backend::Auto), half()), 100.0, 10)
        })
    };
    let [one, two] = [1, 2].map(moved);
    assert!(one.last() == two.last());
    let unloaded = |ring: RingModel| course(&struck(ring, Backend::Auto), 100.0, 10);
    let asked = unloaded(in_housing(own.clone(), [6, 2], Some(20e3)));
    assert!(asked.last() == unloaded(super::motion::on_moving_body(own, 6, 20e3)).last());
}

/// Speed of the shafts that grow, rad/s.
const FAST: f64 = 3000.0;

fn turning(mut model: Model) -> Model {
    let frame = FrameRotation::new(Speed::constant(FAST));
    model.effects.push(Box::new(frame));
    model
}

/// Wrong: a shaft that turns would not grow, or not as the body that it is together with its ring.
#[test]
fn a_turning_shaft_grows_as_one_mesh_with_its_ring() {
    let own = hollow_shaft(3).0;
    let one = turning(super::shaft::bearing(as_one(3), Backend::Sparse));
    let off = |ring: RingModel| {
        let model = super::shaft::bearing(ring, Backend::Auto);
        differences(Side::Inner, &turning(model), &one)
    };
    let all = off(on_shaft(own.clone(), [18, 6], None));
    let still = off(super::shaft::on_shaft(own, [18, 6], None));
    println!("all {all:?}, the ring alone {still:?}");
    assert!(all.iter().all(|off| *off < 1e-9), "{all:?}");
    assert!(still[0] > 0.05 && still[2] > 1e-3, "{still:?}");
}

/// Wrong: in motion a turning shaft would grow otherwise than one mesh with its ring, its ring would be turned twice,
/// or the ledger would lack what turns it. It begins undeformed, with a blow on shaft and tilt.
#[test]
fn a_growing_shaft_moves_as_one_mesh() {
    let (own, n) = (hollow_shaft(3).0, 30);
    let of = |model: Model| {
        let model = turning(model);
        let motion = Motion::new(&model, MotionSettings::conserving(STEP, Speed::constant(FAST))).unwrap();
        let start = motion.rest([0.0, 0.0, 12e-6, 0.0, 0.0], [0.05, 0.0, 0.03, 0.0, 1.0]);
        every_fifth(&motion, start, n)
    };
    let expected = of(free(as_one(3), Backend::Sparse));
    let states = of(free(on_shaft(own, [18, 6], Some(60e3)), Backend::Auto));
    let [found, expected] = [&states, &expected].map(|states| {
        let tilts = states.iter().flat_map(|state| state.shaft[3..].to_vec());
        let [shaft, forces] = histories_of(states, Side::Inner);
        [shaft, tilts.collect(), forces]
    });
    let errors = [0, 1, 2].map(|i| difference(&found[i], &expected[i]));
    println!("shaft, tilts and forces: {errors:?}");
    assert!(
        errors[0] < 2e-3 && errors[1] < 2e-3 && errors[2] < 1e-2,
        "{errors:?}"
    );
    assert_closed(&states);
}

/// Wrong: a shaft that turns steadily would not stay as it has grown, as long as nothing but an axial force acts.
#[test]
fn a_grown_shaft_stays() {
    let mut model = free(on_shaft(hollow_shaft(2).0, [6, 2], Some(20e3)), Backend::Auto);
    model.effects.clear();
    model.shaft = [
        ShaftDof::Prescribed(0.0),
        ShaftDof::Prescribed(0.0),
        ShaftDof::Prescribed(12e-6),
        ShaftDof::Prescribed(0.0),
        ShaftDof::Prescribed(0.0),
    ];
    let model = turning(model);
    let rest = equilibrium(&model);
    let motion = Motion::new(&model, MotionSettings::conserving(STEP, Speed::constant(FAST))).unwrap();
    let start = motion.start(&rest);
    let first = start.forces.clone();
    let state = every_fifth(&motion, start, 20).pop().unwrap();
    let [now, first] = [&state.forces, &first].map(|forces| Meridian::flat(forces));
    let off = difference(&now, &first);
    println!("forces after 20 steps: {off:e}");
    assert!(off < 2e-2, "{off:e}");
}
