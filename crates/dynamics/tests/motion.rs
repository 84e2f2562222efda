//! Motion in time: energy, equilibrium, rolling.

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, on_threads, states_from};
use dynamics::effects::RingDamping;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, StaticSolution};

fn settings(dt: f64) -> MotionSettings {
    MotionSettings::conserving(dt, Speed::constant(0.0))
}

const SMALL: Level = Level::hex8(54, 6, 1, 2);

/// The same bearing under another load: the step of the load at t = 0.
fn reloaded(model: &Model, case: &Case) -> Model {
    let mut other = Model {
        rings: model.rings.clone(),
        ..case.spheres()
    };
    other.contact.mode = model.contact.mode;
    other.shaft_mass = model.shaft_mass;
    other
}

/// The bearing under 1 kN of thrust at rest, and the same under a radial force (N) that comes at t = 0.
fn radial_step(radial: f64) -> (Model, StaticSolution) {
    let before = Case::axial(1000.0);
    let model = before.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    (reloaded(&model, &Case { radial, ..before }), equilibrium(&model))
}

fn run(model: &Model, start: &StaticSolution, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    states_from(&motion, motion.start(start), n)
}

/// Wrong: a bearing at rest would start to move by itself. The start is the static equilibrium, to its tolerance.
#[test]
fn a_bearing_in_equilibrium_stays_there() {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let model = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let solution = equilibrium(&model);
    let states = run(&model, &solution, settings(1e-5), 10);
    let last = states.last().unwrap();
    for (a, b) in states[0].balls.iter().zip(&last.balls) {
        assert!((*a - *b).norm() < 1e-12, "{a:?} {b:?}");
    }
    assert!(
        last.ledger.kinetic.iter().sum::<f64>() < 1e-12 * last.ledger.largest,
        "{:?}",
        last.ledger
    );
    assert!(last.ledger.relative_defect().abs() < 1e-9);
}

/// Wrong: the discrete gradient would not conserve energy with flexible rings and patches when balls unload and
/// meet again. 1 kN axial, radial step 0 to 5 kN, tilt locked: the ledger closes to 1e-6 of the largest energy.
#[test]
fn the_ledger_closes_when_balls_unload() {
    let (loaded, solution) = radial_step(5000.0);
    for dt in [2e-5, 1e-5] {
        let states = run(&loaded, &solution, settings(dt), (3e-3 / dt) as usize);
        let open = states
            .iter()
            .map(|s| s.forces.iter().filter(|f| f.norm() == 0.0).count())
            .max()
            .unwrap();
        let worst = states
            .iter()
            .map(|s| s.ledger.relative_defect().abs())
            .fold(0.0, f64::max);
        let energy = states.iter().map(|s| s.ledger.total()).fold(0.0, f64::max);
        println!(
            "dt {dt}: defect {worst:.2e}, largest energy {energy:.4} J, up to {open} contacts open, {:?}",
            states.last().unwrap().ledger
        );
        assert!(open > 8, "{open}");
        assert!(worst < 1e-6, "{worst}");
    }
}

/// Wrong: rolling would not pass through the equilibria of its azimuths. 1800 rpm, 2 kN and 1 kN radial, from static
/// equilibrium; the forces follow the static ones at the same azimuths.
#[test]
fn slow_rolling_follows_the_static_forces() {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let model = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let solution = equilibrium(&model);
    let speed = Speed::constant(1800.0 * std::f64::consts::PI / 30.0);
    let motion = Motion::new(
        &model,
        MotionSettings {
            speeds: speed.into(),
            ..settings(1e-5)
        },
    )
    .unwrap();
    let mut state = motion.start(&solution);
    let mut worst = 0.0f64;
    let mut cache = StepCache::default();
    for step in 1..=300u64 {
        state = motion.step(&state, &mut cache).unwrap().0;
        if step.is_multiple_of(60) {
            let phase = motion.ball_azimuth(0, motion.time(step) - 0.5e-5);
            let mut turned = reloaded(&model, &Case { phase, ..case });
            turned.contact.mode = ContactMode::Patch;
            let rest = equilibrium(&turned);
            for (ball, f) in rest.balls.iter().zip(state.forces.iter().step_by(2)) {
                worst = worst.max((f.norm() / ball.inner.force_n - 1.0).abs());
            }
            println!("step {step}: worst {worst:.2e}");
        }
    }
    assert!(worst < 1e-3, "{worst}");
    assert!(state.ledger.relative_defect().abs() < 1e-6, "{:?}", state.ledger);
}

/// Wrong: the ledger would not notice a scheme that makes energy. Pointwise trapezoidal contact on the unloading case
/// gains energy while every Newton converges; this is kept as the test of the alarm.
#[test]
fn pointwise_contact_gains_energy_and_the_ledger_tells() {
    let (loaded, solution) = radial_step(5000.0);
    let scheme = ContactScheme::Pointwise;
    let motion = Motion::new(
        &loaded,
        MotionSettings {
            scheme,
            ..settings(2e-5)
        },
    )
    .unwrap();
    let mut state = motion.start(&solution);
    let mut largest = 0.0f64;
    let mut cache = StepCache::default();
    for _ in 0..150 {
        // In the end balls are thrown out of the groove, which is an error of its own.
        let Ok((next, _)) = motion.step(&state, &mut cache) else {
            break;
        };
        state = next;
        largest = largest.max(state.ledger.relative_defect());
    }
    println!(
        "pointwise: defect {largest:.2e} after {} steps, total {:.4} J",
        state.step,
        state.ledger.total()
    );
    assert!(largest > 1e-3, "the alarm's tolerance is 1e-6: {largest:.2e}");
}

/// Wrong: contact damping or Rayleigh damping would feed energy, or their losses would be missing in the ledger.
#[test]
fn damped_motion_loses_what_the_ledger_says() {
    let (loaded, solution) = radial_step(2000.0);
    let damping = ContactDamping {
        coefficient: 50.0,
        full_approach: 1e-6,
    };
    let damped = MotionSettings {
        contact_damping: Some(damping),
        rayleigh: RingDamping {
            mass: 100.0,
            stiffness: 1e-7,
        },
        ..settings(1e-5)
    };
    let states = run(&loaded, &solution, damped, 100);
    for pair in states.windows(2) {
        assert!(pair[1].ledger.contact_loss >= pair[0].ledger.contact_loss);
        assert!(pair[1].ledger.rayleigh_loss >= pair[0].ledger.rayleigh_loss);
    }
    let last = states.last().unwrap().ledger;
    assert!(last.contact_loss > 1e-6 && last.rayleigh_loss > 1e-8, "{last:?}");
    assert!(last.relative_defect().abs() < 1e-9, "{last:?}");
}

/// Wrong: the result would depend on the number of threads.
#[test]
fn motion_has_the_same_bits_on_any_number_of_threads() {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let solve = |threads: usize| {
        on_threads(threads, || {
            let model = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
            let solution = equilibrium(&model);
            let speed = Speed::constant(1000.0);
            run(
                &model,
                &solution,
                MotionSettings {
                    speeds: speed.into(),
                    ..settings(1e-5)
                },
                5,
            )
        })
    };
    assert!(solve(1) == solve(2), "states differ");
}

/// Wrong: a rigid bearing could not move, or ball centrifugal force would not act: at speed the outer contacts carry
/// more than the inner by m omega_c^2 r / cos of the angles, here against the static equilibrium with the same loads.
#[test]
fn rigid_rings_carry_the_centrifugal_force_of_the_balls() {
    let mut model = Case::axial(500.0).rigid();
    model.shaft_mass = 1.0;
    let speed = Speed::constant(3000.0);
    let effect = dynamics::effects::BallCentrifugal {
        speeds: speed.clone().into(),
        slip: [0.0; 2],
        ball_speeds: dynamics::kinematics::BallSpeeds::FreeAngle,
    };
    model.effects.push(Box::new(effect));
    let solution = equilibrium(&model);
    let b = &solution.balls[0];
    let radial =
        b.outer.force_n * b.outer.contact_angle_rad.cos() - b.inner.force_n * b.inner.contact_angle_rad.cos();
    let kinematics = dynamics::kinematics::Kinematics::new(&model.geometry, [0.0; 2]);
    let cage = kinematics.cage * 3000.0;
    let radius = model.geometry.ball_centre().radial + b.displacement_m.radial;
    let expected = model.ball_mass() * cage * cage * radius;
    assert!((radial / expected - 1.0).abs() < 1e-9, "{radial} {expected}");
    let states = run(
        &model,
        &solution,
        MotionSettings {
            speeds: speed.into(),
            ..settings(1e-5)
        },
        50,
    );
    let last = states.last().unwrap();
    assert!((last.balls[0].radial - states[0].balls[0].radial).abs() < 1e-10);
    assert!(last.ledger.relative_defect().abs() < 1e-9, "{:?}", last.ledger);
}

/// Wrong: choices that motion does not know would be ignored instead of refused.
#[test]
fn unsupported_choices_are_refused_by_name() {
    let error = |model: &Model| Motion::new(model, settings(1e-5)).err().unwrap().to_string();
    let facet = error(&Case::axial(1000.0).flexible(ContactMode::Facet, SMALL, Hold::Clamped));
    assert!(
        facet.contains("a moving bearing cannot have contact.mode = \"facet\"; use \"patch\""),
        "{facet}"
    );
}

/// Wrong: patches that follow an oscillating contact angle would feed it. A ball of a bearing at rest is pushed along
/// its grooves, where only geometry holds it and nothing damps it: its energy stays what it was, and what patches
/// take in half a period they give back in the next. (A patch that is late by half a step makes it grow, by 40 %
/// within these 5 ms on this mesh, without bound in longer runs.)
#[test]
fn moving_patches_do_not_feed_an_oscillating_ball() {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let model = case.flexible(ContactMode::Patch, Level::hex8(90, 12, 2, 2), Hold::Clamped);
    let motion = Motion::new(&model, settings(1e-5)).unwrap();
    let mut state = motion.start(&equilibrium(&model));
    state.ball_velocities[4] = [0.0, 1e-3].into();
    state = motion.with_energies(state);
    let (mut largest, mut work) = ([0.0f64; 5], [0.0; 5]);
    let mut cache = StepCache::default();
    for step in 0..500 {
        state = motion.step(&state, &mut cache).unwrap().0;
        let part = step / 100;
        largest[part] = largest[part].max(state.ledger.kinetic[2]);
        work[part] += state.ledger.patch_work / 100.0;
    }
    println!("largest energy of the balls {largest:?}, mean work of patches {work:?}, by millisecond, J");
    assert!(largest[4] < 1.1 * largest[0], "{largest:?}");
    assert!(
        (work[4] - work[0]).abs() < 0.1 * largest[0],
        "{work:?} {largest:?}"
    );
}

/// Steps until one fails, and its error.
fn failure(model: &Model, state: MotionState, settings: MotionSettings) -> String {
    let motion = Motion::new(model, settings).unwrap();
    let mut state = state;
    let mut cache = StepCache::default();
    for _ in 0..100_000 {
        match motion.step(&state, &mut cache) {
            Ok((next, _)) => state = next,
            Err(error) => return error.to_string(),
        }
    }
    panic!("nothing failed: {:?}", state.shaft);
}

/// Wrong: a shaft without mass that nothing touches would be "a singular matrix", or go anywhere.
#[test]
fn a_massless_shaft_that_nothing_touches_is_named() {
    let model = Case::axial(-10.0).rigid();
    let motion = Motion::new(&model, settings(1e-5)).unwrap();
    let error = failure(&model, motion.rest([0.0; 5], [0.0; 5]), settings(1e-5));
    let expected = "z of the shaft is free, but it has no mass and no ball touches it";
    assert!(error.contains(expected), "{error}");
}

/// Wrong: a ring that is shot out of the bearing would fly on for ever and be called a result.
#[test]
fn a_shaft_that_leaves_the_bearing_stops_the_motion() {
    let mut model = Case::axial(0.0).rigid();
    model.shaft_mass = 0.5;
    let motion = Motion::new(&model, settings(1e-6)).unwrap();
    let state = motion.rest([0.0; 5], [0.0, 0.0, -3000.0, 0.0, 0.0]);
    let error = failure(&model, motion.with_energies(state), settings(1e-6));
    assert!(error.contains("z of the shaft is at -"), "{error}");
    assert!(
        error.contains("beyond 4.500 mm: it has left the bearing"),
        "{error}"
    );
}

/// Wrong: more balls than the mesh can tell apart would end in a panic.
#[test]
fn a_mesh_with_too_few_nodes_round_is_named() {
    let case = Case::axial(1000.0);
    let mut model = case.flexible(ContactMode::Patch, Level::hex8(6, 1, 1, 1), Hold::Clamped);
    model.geometry.n_balls = 18;
    let error = dynamics::StaticSolver::new(&model)
        .unwrap()
        .solve(&model, None)
        .err()
        .unwrap()
        .to_string();
    assert!(error.contains("to tell 18 balls apart"), "{error}");
}

/// Wrong: a ring that its load pulls off its only ball would find the far side of a groove, which is not there.
#[test]
fn a_ball_that_presses_where_no_groove_is_is_refused() {
    let case = Case {
        radial: -1000.0,
        free_axial: false,
        ..Case::axial(0.0)
    };
    let mut model = case.rigid();
    model.geometry.n_balls = 1;
    model.shaft[1] = dynamics::ShaftDof::Prescribed(0.0);
    let statics = dynamics::StaticSolver::new(&model).unwrap().solve(&model, None);
    let error = statics.err().unwrap().to_string();
    let expected = "ball 0 presses on the inner ring at a contact angle of";
    assert!(error.contains(expected), "{error}");
    model.shaft_mass = 0.5;
    let motion = Motion::new(&model, settings(1e-5)).unwrap();
    let error = failure(&model, motion.rest([0.0; 5], [0.0; 5]), settings(1e-5));
    assert!(error.contains("ball 0 presses on the"), "{error}");
}

/// Wrong: a load below the resolution of positions would keep Newton busy instead of being called no load.
#[test]
fn a_load_below_round_off_is_no_load() {
    let statics = |model: &Model| dynamics::StaticSolver::new(model).unwrap().solve(model, None);
    let error = statics(&Case::axial(1e-310).rigid()).err().unwrap().to_string();
    assert!(
        error.contains("of the shaft is free but nothing resists it"),
        "{error}"
    );
}
