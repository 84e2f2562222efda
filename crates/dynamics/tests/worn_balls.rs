//! Balls that are no spheres, at rest and in motion: how they turn, when raceways meet their marks, and the ledger.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::support::rings::Level;
use crate::support::worn::spall;
use crate::support::{Case, equilibrium};
use contact::surface::Wave;
use contact::{BallSurface, Profiles, Side, StripLaw, StripSurface};
use dynamics::kinematics::{Kinematics, Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, Pose, StaticSolver};

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// 1800 rpm, rad/s.
const SPEED: f64 = 60.0 * PI;

/// Smooth grooves of strips, and a ball with profiles.
fn with_ball(mut model: Model, ball: usize, profiles: &Profiles) -> Model {
    let geometry = model.geometry;
    for side in Side::BOTH {
        let law = StripLaw::new(&model.hertz[side.index()], geometry.groove_radius(side));
        let surface = StripSurface::new(law, (&geometry, side), None, &Profiles::default()).unwrap();
        model.surfaces.strips[side.index()] = Some(Arc::new(surface));
    }
    let surface = |side| {
        let equator = geometry.free_contact_angle();
        Arc::new(BallSurface::new((&geometry, side), equator, profiles).unwrap())
    };
    model.surfaces.balls.insert(ball, Side::BOTH.map(surface));
    model
}

fn wave(order: usize, amplitude: f64) -> Profiles {
    Profiles {
        waves: vec![Wave {
            order,
            amplitude,
            phase: 0.0,
        }],
        ..Profiles::default()
    }
}

fn run(model: &Model, dt: f64, duration: f64) -> Vec<MotionState> {
    let motion = Motion::new(model, MotionSettings::conserving(dt, Speed::constant(SPEED))).unwrap();
    let mut states = vec![motion.start(&equilibrium(model))];
    let mut cache = StepCache::default();
    for _ in 0..(duration / dt).round() as usize {
        let next = motion.step(states.last().unwrap(), &mut cache).unwrap().0;
        states.push(next);
    }
    states
}

fn heavy(case: &Case) -> Model {
    let mut model = case.rigid();
    model.shaft_mass = 2.0;
    model
}

fn combined() -> Case {
    Case {
        radial: 1000.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    }
}

/// Wrong: what is on a ball would be felt by another law than its diameter. A profile that is the same all over the
/// ball is a ball of another diameter: equilibria to the 1e-10 at which Newton stops, and motions after 50 steps, which
/// start from these.
#[test]
fn a_level_profile_is_a_ball_of_another_diameter() {
    let (ball, height) = (3, 0.4e-6);
    let worn = with_ball(heavy(&combined()), ball, &wave(0, height));
    let mut larger = with_ball(heavy(&combined()), ball, &Profiles::default());
    larger.surfaces.oversizes = (0..18)
        .map(|i| if i == ball { 2.0 * height } else { 0.0 })
        .collect();
    let (a, b) = (equilibrium(&worn), equilibrium(&larger));
    let scale = a.displacements.shaft[2].abs();
    for i in 0..5 {
        let off = a.displacements.shaft[i] - b.displacements.shaft[i];
        assert!(off.abs() < 1e-10 * scale, "{i}: {off}");
    }
    for (a, b) in a.balls.iter().zip(&b.balls) {
        assert!((a.inner.force_n - b.inner.force_n).abs() < 1e-10 * 2000.0);
        assert!((a.outer.contact_angle_rad - b.outer.contact_angle_rad).abs() < 1e-10);
    }
    // The ball is felt.
    let smooth = equilibrium(&with_ball(heavy(&combined()), ball, &Profiles::default()));
    assert!(a.balls[ball].outer.force_n - smooth.balls[ball].outer.force_n > 1.0);
    let [a, b] = [worn, larger].map(|model| run(&model, 1e-5, 5e-4).pop().unwrap());
    for i in 0..5 {
        let off = a.shaft[i] - b.shaft[i];
        assert!(off.abs() < 1e-10 * scale, "{i}: {off}");
    }
}

/// Wrong: a ball would roll at another speed than its rings drive it, so that its marks meet the raceways at other
/// times. The least force of each contact over a turn of the ball is where the spall is under it: outside when the ball
/// has rolled by minus its longitude, inside half a turn later, both once a turn. Equilibria a hundredth of a turn
/// apart.
#[test]
fn both_raceways_meet_a_mark_once_a_turn_of_the_ball() {
    let case = Case::axial(2000.0);
    let longitude = 1.0;
    let model = with_ball(case.rigid(), 0, &spall(longitude, 0.5e-3, 20e-6));
    let rolling = Rolling::new(&model.geometry, Speed::constant(SPEED), [0.0; 2]);
    let period = TAU / rolling.spin(0.0);
    let mut solver = StaticSolver::new(&model).unwrap();
    let n = 200;
    let forces: Vec<[f64; 2]> = (0..=n)
        .map(|i| {
            let pose = rolling.pose(2.0 * period * f64::from(i) / f64::from(n));
            let found = solver.solve_at(&model, &pose, None).unwrap();
            [found.balls[0].inner.force_n, found.balls[0].outer.force_n]
        })
        .collect();
    // The ball carries the same at both contacts, so that each passage is seen by both.
    let full = forces.iter().map(|f| f[1]).fold(0.0, f64::max);
    let mut falls = Vec::new();
    for i in 1..n as usize {
        let f = |k: usize| forces[k][1];
        if f(i) < 0.9 * full && f(i) < f(i - 1) && f(i) <= f(i + 1) {
            falls.push(2.0 * i as f64 / f64::from(n));
        }
    }
    let outer = 1.0 - longitude / TAU;
    let expected = [outer - 0.5, outer, outer + 0.5, outer + 1.0];
    assert_eq!(falls.len(), 4, "{falls:?}");
    for (found, expected) in falls.iter().zip(expected) {
        assert!((found - expected).abs() < 0.011, "{found} {expected}");
    }
}

/// Wrong: the angle by which balls have rolled would not be the integral of their spin, at changing speeds of both
/// rings and with slip; the orientation of a run would drift, or not be found again by a resume. To round-off after 10
/// 000 steps, each from its own time alone.
#[test]
fn balls_roll_by_the_integral_of_their_spin() {
    let geometry = Case::axial(1.0).rigid().geometry;
    let speeds = dynamics::kinematics::RingSpeeds {
        inner: Speed::table(vec![0.0, 0.3, 1.0], vec![10.0, 300.0, -50.0]),
        outer: Speed::constant(-20.0),
    };
    let rolling = Rolling::new(&geometry, speeds, [0.01, 0.02]);
    let (dt, mut sum) = (1e-4, 0.0);
    for step in 0..10_000 {
        // Simpson's rule is exact of linear speeds, whose corners are on the grid.
        let [a, b, c] = [0.0, 0.5, 1.0].map(|s| rolling.spin((f64::from(step) + s) * dt));
        sum += dt * (a + 4.0 * b + c) / 6.0;
        let rolled = rolling.pose(dt * f64::from(step + 1)).rolled;
        assert!((rolled - sum).abs() < 1e-9, "{step}: {rolled} {sum}");
    }
}

/// Wrong: energy would be made or lost where a mark rolls under a raceway. Defect of the ledger over its largest energy
/// through passages of both raceways; the ball's surface does work, in its line.
#[test]
fn the_ledger_closes_while_a_mark_is_rolled_over() {
    let spin = Kinematics::new(&Case::axial(1.0).rigid().geometry, [0.0; 2]).ball * SPEED;
    // Outer contact after 0.25 ms; a second mark inside after 0.6 ms.
    let mut profiles = spall(-0.25e-3 * spin, 1e-3, 200e-6);
    let [inside] = spall(PI - 0.6e-3 * spin, 0.5e-3, 3e-6).spalls[..] else {
        panic!("one spall")
    };
    profiles.spalls.push(inside);
    for dt in [1e-6, 5e-6] {
        let states = run(&with_ball(heavy(&Case::axial(2000.0)), 0, &profiles), dt, 0.8e-3);
        let mut work = 0.0f64;
        for (step, state) in states.iter().enumerate() {
            let defect = state.ledger.relative_defect();
            assert!(defect.abs() < 1e-9, "{dt} {step}: {defect}");
            work = work.max(state.ledger.profile_work.abs());
        }
        assert!(work > 1e-3 * states.last().unwrap().ledger.largest, "{work}");
        let least = |from: f64, to: f64| {
            let within = states.iter().enumerate().filter(|(step, _)| {
                let time = dt * *step as f64;
                from < time && time < to
            });
            let force = |s: &MotionState| s.forces[1].norm();
            within.map(|(_, s)| force(s)).fold(f64::INFINITY, f64::min)
        };
        let before = equilibrium(&heavy(&Case::axial(2000.0))).balls[0].outer.force_n;
        let [outside, inside] = [least(0.1e-3, 0.4e-3), least(0.5e-3, 0.7e-3)];
        assert!(outside < 0.2 * before, "{outside} {before}");
        assert!(inside < 0.9 * before, "{inside} {before}");
    }
}

/// Wrong: patches of elastic rings and surfaces of balls would do each other's work. A rough ball in elastic rings
/// under combined load, and a spall: the ledger closes.
#[test]
fn the_ledger_closes_with_a_rough_ball_in_elastic_rings() {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    model.sphere = Default::default();
    model.shaft_mass = 1.0;
    let mut profiles = spall(-0.1, 0.5e-3, 4e-6);
    profiles.waves = (2..12)
        .map(|order| Wave {
            order,
            amplitude: 0.3e-6 / order as f64,
            phase: (order * order) as f64,
        })
        .collect();
    let model = with_ball(model, 0, &profiles);
    let states = run(&model, 4e-6, 0.3e-3);
    for (step, state) in states.iter().enumerate() {
        let defect = state.ledger.relative_defect();
        assert!(defect.abs() < 1e-9, "{step}: {defect}");
    }
    assert!(states.last().unwrap().ledger.profile_work != 0.0);
}

/// Wrong: waves of a ball would act otherwise than waves do. Of even orders both ends of a diameter are high at once,
/// of odd ones opposite: the total approach, and with it the load of a ball between rings that do not move, changes
/// with even orders alone. Twice the amplitude as one more diameter, to the second order.
#[test]
fn even_waves_of_a_ball_are_felt_as_its_diameter() {
    let case = Case::axial(2000.0);
    let smooth = equilibrium(&case.rigid());
    let height = 1e-9;
    let held = |order: usize| {
        let mut model = with_ball(case.rigid(), 0, &wave(order, height));
        for (dof, q) in model.shaft.iter_mut().zip(smooth.displacements.shaft) {
            *dof = dynamics::ShaftDof::Prescribed(q);
        }
        let found = StaticSolver::new(&model)
            .and_then(|mut solver| solver.solve_at(&model, &Pose::default(), None))
            .unwrap();
        found.balls[0].outer.force_n - smooth.balls[0].outer.force_n
    };
    let diameter = held(0);
    assert!(diameter > 1e-3, "{diameter}");
    for order in 1..6 {
        let expected = if order % 2 == 0 { diameter } else { 0.0 };
        let found = held(order);
        // The envelope of a wave is off by its slope's square.
        assert!(
            (found - expected).abs() < 2e-3 * diameter,
            "{order}: {found} {diameter}"
        );
    }
}
