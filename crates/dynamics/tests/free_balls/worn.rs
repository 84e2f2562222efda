//! Free balls with profiles of their own: marks that turn with them.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use contact::surface::{Heights, Wave};
use contact::{BallSurface, Profiles, Side};
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::model::BallInertia;
use dynamics::motion::{Motion, MotionState};
use dynamics::{Model, ShaftDof};

use super::bearings::{rpm, run, settings};
use super::flexible::flexible;
use super::surfaces::{after, turning, wave, with_strips};
use crate::support::worn::spall;
use crate::support::{equilibrium, steel};

/// Smooth grooves of strips, and a ball with profiles.
pub fn with_ball(mut model: Model, ball: usize, profiles: &Profiles) -> Model {
    for side in Side::BOTH {
        if model.surfaces.strips[side.index()].is_none() {
            model = with_strips(model, side, &Profiles::default());
        }
    }
    let geometry = model.geometry;
    let surface = |side| {
        let equator = geometry.free_contact_angle();
        Arc::new(BallSurface::new((&geometry, side), equator, profiles).unwrap())
    };
    model.surfaces.balls.insert(ball, Side::BOTH.map(surface));
    model
}

/// Speed at which a ball rolls in its meridian plane, rad/s, in the equilibrium.
fn rolling(model: &Model) -> f64 {
    let [orbit, radial, round, axial] = equilibrium(model).steady.unwrap().balls[0].rates();
    (radial * radial + round * round + (axial - orbit).powi(2)).sqrt()
}

fn force(state: &MotionState, site: usize) -> f64 {
    state.forces[site].norm()
}

/// Wrong: energy would be made or lost where a mark of a free ball rolls under a raceway. The ledger through passages
/// of either raceway, without friction and with it; what the mark gives is kinetic energy of the ball, so that its line
/// is zero to round-off.
#[test]
fn the_ledger_closes_as_a_mark_rolls_under_either_raceway() {
    for (friction, dt) in [(0.0, 1e-6), (0.0, 5e-6), (0.07, 5e-6)] {
        let (model, speeds) = turning(friction, 3000.0);
        let rate = rolling(&turning(0.07, 3000.0).0);
        let mut profiles = spall(-0.2e-3 * rate, 1e-3, 200e-6);
        profiles
            .spalls
            .extend(spall(PI - 0.45e-3 * rate, 0.5e-3, 3e-6).spalls);
        let model = with_ball(model, 0, &profiles);
        let (mut worst, mut work, mut least, mut moment) = (0.0f64, 0.0f64, [f64::INFINITY; 2], 0.0f64);
        let mut first = [0.0; 2];
        let last = after(&model, &speeds, (dt, (0.6e-3 / dt) as usize), |state| {
            worst = worst.max(state.ledger.relative_defect().abs());
            work = work.max(state.ledger.profile_work.abs());
            for side in 0..2 {
                if first[side] == 0.0 {
                    first[side] = force(state, side);
                }
                least[side] = least[side].min(force(state, side));
                moment = moment.max(state.free.as_ref().unwrap().track[side][1].abs());
            }
        });
        println!("{friction} {dt}: {worst:e} {work:e} {least:?} of {first:?}, {moment}");
        assert!(worst < 1e-9, "{worst}");
        assert!(work < 1e-9 * last.ledger.largest, "{work}");
        assert!(
            least[1] < 0.3 * first[1] && least[0] < 0.9 * first[0],
            "{least:?}"
        );
        assert!(moment > 1e-3, "{moment}");
        let norms = last.free.unwrap().orientations;
        for q in norms {
            assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }
}

/// Wrong: a ball in smooth grooves would get a torque about the axis from nothing. Without friction: moment of momentum
/// about the axis, of its orbit and of its turning, over a rough ball's motion; the axis of the shaft is held.
#[test]
fn a_rough_ball_keeps_its_moment_of_momentum_about_the_axis() {
    let (model, speeds) = turning(0.0, 3000.0);
    let mut profiles = wave(5, 0.5e-6);
    profiles.waves.extend(wave(8, 0.4e-6).waves);
    profiles.spalls = spall(-0.3, 0.5e-3, 10e-6).spalls;
    let mut model = with_ball(model, 4, &profiles);
    for dof in [0, 1, 3, 4] {
        model.shaft[dof] = ShaftDof::Prescribed(0.0);
    }
    let BallInertia { mass, moment } = model.ball_inertia();
    let moment = |state: &MotionState| {
        let free = state.free.as_ref().unwrap();
        let (p, v, w) = (free.places[4], free.velocities[4], free.turnings[4]);
        [mass * (p[0] * v[1] - p[1] * v[0]), moment * w[2]]
    };
    let motion = Motion::new(&model, settings(4e-6, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    let first = moment(&start);
    let last = moment(&run(&motion, start, 250, |_| {}));
    let (orbit, spin) = (last[0] - first[0], last[1] - first[1]);
    println!("{orbit:e} {spin:e} of {first:?}");
    assert!(spin.abs() > 1e-5 * first[1].abs(), "{spin}");
    // Newton leaves 1e-9 of the contact forces.
    assert!(
        (orbit + spin).abs() < 1e-5 * spin.abs() + 1e-12 * first[0],
        "{orbit} {spin}"
    );
}

/// Wrong: the moment across the way a ball rolls would be left out or have another size. Heights that fall with the
/// latitude are a sphere whose centre is off by their slope k along the axis: the force of a contact has the moment k Q
/// about the ball's centre, in the direction of rolling; its changes over a step are those of the angular velocity.
#[test]
fn a_slope_across_the_ball_is_a_centre_that_is_off() {
    let (model, speeds) = turning(0.0, 1800.0);
    let slope = 2e-6;
    let profiles = Profiles {
        tables: vec![Heights {
            azimuths: vec![0.0, 2.0, 4.0],
            angles: vec![-0.5, 0.0, 0.5],
            heights: [-0.5 * slope, 0.0, 0.5 * slope].repeat(3),
        }],
        ..Profiles::default()
    };
    let model = with_ball(model, 0, &profiles);
    let state = after(&model, &speeds, (1e-6, 3), |_| {});
    let free = state.free.as_ref().unwrap();
    for side in 0..2 {
        let [x, y, _] = free.places[0];
        let (cos, sin) = (x / x.hypot(y), y / x.hypot(y));
        let [_, m_x, m_y, m_z] = free.track[side];
        let along = -sin * m_x + cos * m_y;
        let across = (cos * m_x + sin * m_y).hypot(m_z);
        let expected = slope * force(&state, side);
        println!("{side}: {along:e} {across:e} {expected:e}");
        assert!((along.abs() / expected - 1.0).abs() < 0.02, "{along} {expected}");
        assert!(across < 0.02 * expected, "{across} {expected}");
    }
    // Both contacts push the same way off the centre: the moments of a diameter's ends are opposite.
    assert!(free.track[0][2] * free.track[1][2] < 0.0);
}

/// Wrong: orientation and marks would be of another order than the motion. A rough ball without friction: its turning,
/// in steps that are halved, against those of a quarter of the least step. A wave of no height makes the grid fine.
#[test]
fn a_rough_ball_moves_to_second_order() {
    let (model, speeds) = turning(0.0, 3000.0);
    let mut profiles = wave(6, 0.5e-6);
    profiles.waves.extend(wave(9, 0.4e-6).waves);
    profiles.waves.push(Wave {
        order: 20_000,
        amplitude: 0.0,
        phase: 0.0,
    });
    let model = with_ball(model, 4, &profiles);
    let duration = 0.1e-3;
    let ends = [1e-6, 0.5e-6, 0.25e-6, 0.0625e-6].map(|dt| {
        let n = (duration / dt + 0.5) as usize;
        after(&model, &speeds, (dt, n), |_| {}).free.unwrap()
    });
    let off = |i: usize| {
        let parts = (0..3).map(|k| (ends[i].turnings[4][k] - ends[3].turnings[4][k]).abs());
        parts.fold(0.0, f64::max)
    };
    let (a, b, c) = (off(0), off(1), off(2));
    println!("{a:e} {b:e} {c:e} {:?}", ends[3].turnings[4]);
    assert!(
        (3.0..5.5).contains(&(a / b)) && (3.0..5.5).contains(&(b / c)),
        "{a} {b} {c}"
    );
}

/// Wrong: a free ball's mark would meet the raceways at other times than its rolling brings it there. With friction, a
/// mark on the equator: passages of the outer raceway a turn apart, of the inner one half a turn later.
#[test]
fn a_mark_meets_both_raceways_once_a_turn() {
    let speed = 6000.0;
    let (mut model, speeds) = turning(0.1, speed);
    model.shaft_mass = 100.0;
    let rate = rolling(&model);
    let period = TAU / rate;
    let model = with_ball(model, 0, &spall(-0.2e-3 * rate, 0.5e-3, 4e-6));
    let dt = 2e-6;
    let n = (1.3 * period / dt) as usize;
    let mut course = Vec::new();
    after(&model, &speeds, (dt, n), |state| {
        course.push(force(state, 1));
    });
    // Both contacts of a ball carry about the same, so that each passage is seen by the outer one.
    for turns in [0.0, 0.5, 1.0] {
        let expected = 0.2e-3 + turns * period;
        let near = |time: f64| (time - expected).abs() < 0.15 * period;
        let within = course
            .iter()
            .enumerate()
            .filter(|(i, _)| near(dt * (*i + 1) as f64));
        let least = within.min_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        let found = dt * (least.0 + 1) as f64;
        println!("{turns}: {found} {expected} {}", least.1);
        assert!(*least.1 < 0.95 * course[0], "{}", least.1);
        assert!((found - expected).abs() < 0.01 * period, "{found} {expected}");
    }
}

/// Wrong: a profile would move a ball without being there. No depth on a ball against smooth strips.
#[test]
fn a_mark_of_no_depth_is_no_mark() {
    let (model, speeds) = turning(0.07, 3000.0);
    let smooth = after(&model, &speeds, (1e-5, 40), |_| {}).free.unwrap();
    let model = with_ball(model, 0, &spall(-0.1, 1e-3, 0.0));
    let marked = after(&model, &speeds, (1e-5, 40), |_| {}).free.unwrap();
    for ball in 0..18 {
        for i in 0..3 {
            let (x, y) = (smooth.places[ball][i], marked.places[ball][i]);
            assert!((x - y).abs() < 1e-12, "{ball} {i}: {x} {y}");
        }
    }
    let none = &rpm(1.0);
    assert!(
        marked.track[0].iter().all(|x| x.abs() < 1e-9 * none),
        "{:?}",
        marked.track[0]
    );
}

/// Wrong: marks of ball and ring would count each other's work, or elastic rings take what they do not get. A rough
/// ball on rough raceways of elastic rings under combined load: the ledger, and the works of the surfaces.
#[test]
fn the_ledger_closes_with_a_rough_ball_on_rough_elastic_rings() {
    let speeds = RingSpeeds::from(Speed::constant(rpm(3000.0)));
    let mut model = flexible(800.0, &speeds, steel());
    model.sphere = Default::default();
    let model = with_strips(model, Side::Outer, &wave(40, 0.2e-6));
    let model = with_strips(model, Side::Inner, &wave(31, 0.2e-6));
    let mut profiles = spall(-0.1, 0.5e-3, 4e-6);
    profiles.waves = wave(11, 0.3e-6).waves;
    let model = with_ball(model, 0, &profiles);
    let (mut worst, mut works) = (0.0f64, [0.0f64; 2]);
    after(&model, &speeds, (5e-6, 60), |state| {
        worst = worst.max(state.ledger.relative_defect().abs());
        works[0] = works[0].max(state.ledger.profile_work.abs());
        works[1] = works[1].max(state.ledger.friction.unwrap().drive_work.abs());
    });
    println!("defect {worst:e} {works:?}");
    assert!(worst < 1e-9, "{worst}");
    assert!(works[0] < 1e-3 * works[1], "{works:?}");
}

/// Wrong: the shares of ball and ring would not add up. A rough ball on rough rigid rings: their works are those of
/// balls and drives, so that the line of surfaces stays empty, and a state goes on to the same bits.
#[test]
fn a_rough_ball_and_rough_rings_share_their_work() {
    let (model, speeds) = turning(0.07, 6000.0);
    let model = with_strips(model, Side::Outer, &wave(40, 0.2e-6));
    let model = with_strips(model, Side::Inner, &wave(31, 0.2e-6));
    let model = with_ball(model, 0, &wave(11, 0.3e-6));
    let motion = Motion::new(&model, settings(5e-6, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    let whole = run(&motion, start.clone(), 40, |state| {
        let (ledger, defect) = (&state.ledger, state.ledger.relative_defect());
        assert!(defect.abs() < 1e-10, "{defect}");
        assert!(
            ledger.profile_work.abs() < 1e-10 * ledger.largest,
            "{}",
            ledger.profile_work
        );
    });
    let halves = run(&motion, run(&motion, start, 17, |_| {}), 23, |_| {});
    assert_eq!(format!("{whole:?}"), format!("{halves:?}"));
}
