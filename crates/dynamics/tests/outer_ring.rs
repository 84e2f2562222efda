//! An outer ring that turns, alone and beside the inner one.

use std::f64::consts::PI;

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative, states_from};
use contact::Side;
use dynamics::effects::{BallCentrifugal, FrameRotation, Gravity, GyroscopicMoment, MomentShares};
use dynamics::kinematics::{BallSpeeds, Kinematics, RingSpeeds, Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{ContactMode, Hold, Model, Pose, QuasiStaticMotion, ShaftDof, StaticSolution, StaticSolver};
use input::Schedule;

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// 12 000 rpm, rad/s.
const SPEED: f64 = 400.0 * PI;

fn speeds(inner: f64, outer: f64) -> RingSpeeds {
    RingSpeeds {
        inner: Speed::constant(inner),
        outer: Speed::constant(outer),
    }
}

fn add_centrifugal(model: &mut Model, speeds: &RingSpeeds) {
    model.effects.push(Box::new(BallCentrifugal {
        speeds: speeds.clone(),
        slip: [0.0; 2],
        ball_speeds: BallSpeeds::FreeAngle,
    }));
}

fn add_frame(model: &mut Model, speeds: &RingSpeeds) {
    model.effects.push(Box::new(FrameRotation::new(speeds.clone())));
}

fn run(model: &Model, start: &StaticSolution, speeds: &RingSpeeds, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, MotionSettings::conserving(5e-6, speeds.clone())).unwrap();
    let states = states_from(&motion, motion.start(start), n);
    let defect = states.last().unwrap().ledger.relative_defect().abs();
    assert!(defect < 1e-8, "{defect}");
    states
}

/// Largest difference of two sets of contact forces over the largest force.
fn difference(a: &MotionState, b: &MotionState) -> f64 {
    let largest = a.forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    let pairs = a.forces.iter().zip(&b.forces);
    let worst = pairs.map(|(a, b)| (*a - *b).norm());
    worst.fold(0.0, f64::max) / largest
}

/// Wrong: the centrifugal force and the gyroscopic moment of the balls would not be those of the cage that both rings
/// drive. Balls do not know which ring turns: with the cage at (1 + gamma) / 2 omega_o and the spin the other way
/// round they have the forces of an inner ring at a speed that gives the same product; without the moment, the same
/// cage speed gives the same equilibrium.
#[test]
fn balls_feel_the_cage_whichever_ring_turns() {
    let case = Case::axial(500.0);
    let turning = Kinematics::new(&case.rigid().geometry, [0.0; 2]);
    let solve = |speeds: RingSpeeds| {
        let mut model = case.rigid();
        add_centrifugal(&mut model, &speeds);
        equilibrium(&model)
    };
    let outer = solve(speeds(0.0, SPEED));
    let inner = solve(speeds(SPEED * (1.0 - turning.cage) / turning.cage, 0.0));
    let still = solve(speeds(0.0, 0.0));
    let angle = |s: &StaticSolution| s.balls[0].inner.contact_angle_rad;
    assert!(angle(&outer) - angle(&still) > 0.02, "no effect of the speed");
    assert!(relative(angle(&outer), angle(&inner)) < 1e-13);
    // Closed form of a locked axis: m r omega_c^2 is what the outer contact has more than the inner one.
    let gamma = case.rigid().geometry.ball_diameter / case.rigid().geometry.pitch_diameter()
        * case.rigid().geometry.free_contact_angle().cos();
    let model = case.rigid();
    let radius = model.geometry.ball_centre().radial + outer.balls[0].displacement_m.radial;
    let force = model.ball_mass() * radius * (0.5 * (1.0 + gamma) * SPEED).powi(2);
    let radial = |c: &dynamics::balls::ContactResult| c.force_n * c.contact_angle_rad.cos();
    let found = radial(&outer.balls[0].outer) - radial(&outer.balls[0].inner);
    assert!(relative(found, force) < 1e-9, "{found} {force}");
}

/// Wrong: the gyroscopic moment would take a wrong spin or cage speed. Its size is J omega_s omega_c sin beta with the
/// spin of the relative speed; rings that turn against each other so that the cage stands have none, and neither have
/// rings that turn together.
#[test]
fn the_gyroscopic_moment_needs_spin_and_cage() {
    let model = Case::axial(500.0).rigid();
    let turning = Kinematics::new(&model.geometry, [0.0; 2]);
    let moment = |inner: f64, outer: f64| {
        let effect = GyroscopicMoment {
            speeds: speeds(inner, outer),
            slip: [0.0; 2],
            shares: MomentShares::OUTER_CONTROL,
            ball_speeds: BallSpeeds::FreeAngle,
        };
        effect.moment(&model, &Default::default(), 0)
    };
    let inner = moment(SPEED, 0.0);
    assert!(inner > 0.0);
    assert_eq!(moment(SPEED, SPEED), 0.0);
    let standing = moment(SPEED, -SPEED * turning.cage / (1.0 - turning.cage));
    assert!(standing.abs() < 1e-14 * inner, "{standing}");
    // The outer ring alone: the spin turns round, the cage does not.
    let outer = moment(0.0, SPEED);
    assert!(relative(outer, -inner * (1.0 - turning.cage) / turning.cage) < 1e-13);
}

/// Wrong: contacts would run along the wrong ring, or at a wrong speed. The mirror of an inner ring that turns by
/// -omega is an outer ring that turns by omega, seen from that ring. Without a direction in space (thrust alone)
/// and without inertia of frames every contact meets the same nodes of both meshes, step by step.
#[test]
fn an_outer_ring_is_the_mirror_of_an_inner_ring() {
    let model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let start = equilibrium(&model);
    let mirror = [speeds(-SPEED, 0.0), speeds(0.0, SPEED)].map(|speeds| run(&model, &start, &speeds, 60));
    let worst = (0..=60)
        .map(|step| difference(&mirror[0][step], &mirror[1][step]))
        .fold(0.0, f64::max);
    let moved = difference(&mirror[0][0], &mirror[0][60]);
    println!("mirror {worst:.1e}, ripple {moved:.1e}");
    assert!(worst < 1e-9, "{worst}");
    assert!(moved > 1e-6, "no contact moved: {moved}");
}

/// Wrong: rings that turn together would roll. Nothing rolls: every contact stays on its nodes, the spin is zero, and a
/// bearing in the equilibrium of its turning rests in it, with the inertia of both frames.
#[test]
fn nothing_rolls_between_rings_of_equal_speed() {
    let both = speeds(SPEED, SPEED);
    let mut model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    add_centrifugal(&mut model, &both);
    let rolling = Rolling::new(&model.geometry, both.clone(), [0.0; 2]);
    let pose = rolling.pose(3e-4);
    for side in Side::BOTH {
        assert!((pose.frame_angle(side) - SPEED * 3e-4).abs() < 1e-15);
    }
    assert!((pose.now.cage_angle - SPEED * 3e-4).abs() < 1e-15);
    assert_eq!(rolling.spin(3e-4), 0.0);
    let start = equilibrium(&model);
    let states = run(&model, &start, &both, 40);
    let worst = states
        .iter()
        .map(|state| difference(&states[0], state))
        .fold(0.0, f64::max);
    println!("forces change by {worst:.1e}");
    assert!(worst < 1e-9, "{worst}");
}

/// Wrong: the inertia of the outer ring's frame would act on the inner ring, or not at all. At rest the raceway of an
/// outer ring on its mean motion grows by rho omega^2 r^3 / E (a thin ring that turns; Timoshenko, Strength of
/// Materials II), taken here at the mean radius of the ring.
#[test]
fn a_turning_outer_ring_grows() {
    let turning = speeds(0.0, SPEED);
    let grow = |speeds: &RingSpeeds| {
        let mut model = Case::axial(0.0).flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
        // The shaft is held a little off its contacts: nothing but inertia acts.
        model.shaft = [0.0, 0.0, -20e-6, 0.0, 0.0].map(ShaftDof::Prescribed);
        add_frame(&mut model, speeds);
        let solution = equilibrium(&model);
        Side::BOTH.map(|side| mean_growth(&model, &solution, side))
    };
    let [inner, outer] = grow(&turning);
    let model = Case::axial(0.0).flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    let ring = model.ring(Side::Outer).unwrap();
    let radii = ring.mesh.nodes.iter().map(|x| x[0].hypot(x[1]));
    let (low, high) = radii.fold((f64::MAX, 0.0), |(a, b): (f64, f64), r| (a.min(r), b.max(r)));
    let (mean, steel) = (0.5 * (low + high), &ring.material);
    let expected = steel.density * SPEED * SPEED * mean.powi(3) / steel.young_modulus;
    println!("inner {inner:.3e}, outer {outer:.3e}, thin ring {expected:.3e}");
    assert!(inner.abs() < 1e-12 * outer, "{inner}");
    assert!(relative(outer, expected) < 0.05, "{outer} {expected}");
    // And as the inner ring does when it turns.
    let [inner, outer] = grow(&speeds(SPEED, 0.0));
    assert!(outer.abs() < 1e-12 * inner && inner > 0.0, "{inner} {outer}");
}

/// Mean radial displacement of the nodes of a ring, m.
fn mean_growth(model: &Model, solution: &StaticSolution, side: Side) -> f64 {
    let ring = model.ring(side).unwrap();
    let u = solution.elastic[side.index()].as_ref().unwrap();
    let radial = |(x, u): (&[f64; 3], &[f64])| (x[0] * u[0] + x[1] * u[1]) / x[0].hypot(x[1]);
    ring.mesh
        .nodes
        .iter()
        .zip(u.chunks_exact(3))
        .map(radial)
        .sum::<f64>()
        / ring.mesh.n_nodes() as f64
}

/// Wrong: a load that is fixed in space would turn with the outer ring. Weight across the axis on a ring that has
/// turned by whole elements is the same equilibrium; by half an element it is another one by the ripple of the mesh,
/// not by the load.
#[test]
fn weight_keeps_its_direction_on_a_turning_outer_ring() {
    let mut model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    // A thousand times the weight, so that it shows.
    let weight = Gravity::new([9810.0, 0.0, 0.0], Schedule::Constant, &model.rings).unwrap();
    model.effects.push(Box::new(weight));
    let at = |elements: f64| {
        let pose = Pose {
            ring_angles: [0.0, 2.0 * PI / 54.0 * elements],
            ..Pose::default()
        };
        StaticSolver::new(&model)
            .unwrap()
            .solve_at(&model, &pose, None)
            .unwrap()
    };
    let [still, whole, quarter] = [at(0.0), at(5.0), at(13.5)];
    let worst = |other: &StaticSolution| {
        let pairs = still.balls.iter().zip(&other.balls);
        pairs
            .map(|(a, b)| relative(a.outer.force_n, b.outer.force_n))
            .fold(0.0, f64::max)
    };
    let spread = relative(still.balls[0].outer.force_n, still.balls[9].outer.force_n);
    println!(
        "whole {:.1e}, quarter turn {:.1e}, spread {spread:.1e}",
        worst(&whole),
        worst(&quarter)
    );
    assert!(spread > 0.01, "the weight does not show: {spread}");
    assert!(worst(&whole) < 1e-9);
    assert!(worst(&quarter) < 1e-3);
}

/// Wrong: equilibria in time would leave the outer ring where it was. Under thrust the equilibria of a turning outer
/// ring repeat when the cage has passed one element of each ring.
#[test]
fn equilibria_in_time_turn_the_outer_ring() {
    let model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let turning = speeds(0.0, SPEED);
    let rolling = Rolling::new(&model.geometry, turning, [0.0; 2]);
    let mirrored = Rolling::new(&model.geometry, speeds(-SPEED, 0.0), [0.0; 2]);
    let solve = |rolling: Rolling| {
        let mut quasi = QuasiStaticMotion::new(&model, rolling, 7e-5).unwrap();
        quasi.step(3, None).unwrap()
    };
    let (outer, inner) = (solve(rolling), solve(mirrored));
    for (a, b) in outer.balls.iter().zip(&inner.balls) {
        assert!(relative(a.outer.force_n, b.outer.force_n) < 1e-9);
        assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-9);
    }
    let turn = (outer.balls[0].azimuth_rad - inner.balls[0].azimuth_rad).rem_euclid(2.0 * PI);
    assert!((turn - SPEED * 2.1e-4).abs() < 1e-12, "{turn}");
}
