//! Steps that adapt on the ladder dt 2^-k.

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, on_threads};
use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::motion::{Ladder, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, DynamicsError, Hold, Model, ShaftDof, StaticSolution};

const SMALL: Level = Level::hex8(54, 6, 1, 2);

fn settings(dt: f64, ladder: Ladder) -> MotionSettings {
    MotionSettings {
        ladder,
        ..MotionSettings::conserving(dt, Speed::constant(0.0))
    }
}

/// 1 kN of thrust at rest, and the same under 2 kN across that come at t = 0; rigid rings on a shaft of 0.5 kg or
/// flexible.
fn radial_step(flexible: bool) -> (Model, StaticSolution) {
    let before = Case::axial(1000.0);
    let still = if flexible {
        before.flexible(ContactMode::Patch, SMALL, Hold::Clamped)
    } else {
        before.rigid()
    };
    let mut loaded = Model {
        rings: still.rings.clone(),
        ..Case {
            radial: 2000.0,
            ..before
        }
        .rigid()
    };
    loaded.contact.mode = still.contact.mode;
    loaded.shaft_mass = 0.5;
    (loaded, equilibrium(&still))
}

fn march(motion: &Motion<'_>, start: &StaticSolution, n: usize) -> (MotionState, usize, usize) {
    let (mut state, mut parts, mut retries) = (motion.start(start), 0, 0);
    let mut cache = StepCache::default();
    for _ in 0..n {
        let (next, report) = motion.step(&state, &mut cache).unwrap();
        (state, parts, retries) = (next, parts + report.substeps, retries + report.retries);
    }
    (state, parts, retries)
}

/// Wrong: the tolerance would not govern the error. Against steps of 1/64, each tenth of the tolerance lowers the
/// error, and the smallest tolerance is far better than the full step.
#[test]
fn the_tolerance_governs_the_error() {
    let (model, start) = radial_step(false);
    let at = |dt: f64, ladder: Ladder, n: usize| {
        march(&Motion::new(&model, settings(dt, ladder)).unwrap(), &start, n)
    };
    let n = 20;
    let (exact, ..) = at(1e-5 / 64.0, Ladder::default(), 64 * n);
    let error = |state: &MotionState| (state.shaft[0] - exact.shaft[0]).abs() / exact.shaft[0].abs();
    let full = error(&at(1e-5, Ladder::default(), n).0);
    let mut errors = Vec::new();
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let ladder = Ladder {
            halvings: 6,
            tolerance: Some(tolerance),
        };
        let (state, parts, retries) = at(1e-5, ladder, n);
        println!(
            "{tolerance:.0e}: error {:.2e} (full step {full:.2e}), {parts} parts, {retries} retries",
            error(&state)
        );
        assert!(parts > n && state.ledger.relative_defect().abs() < 1e-9);
        errors.push(error(&state));
    }
    assert!(errors[1] < errors[0] && errors[2] < errors[1], "{errors:?}");
    assert!(errors[2] < 0.05 * full, "{errors:?} {full}");
}

/// Wrong: flexible rings would not change their step, their ledger would not close over the changes, a rung would be
/// factored that is not used, or the result would depend on the number of threads.
#[test]
fn flexible_rings_adapt_with_kept_factors_and_the_same_bits() {
    let solve = |threads: usize| {
        on_threads(threads, || {
            let (model, start) = radial_step(true);
            let ladder = Ladder {
                halvings: 5,
                tolerance: Some(3e-3),
            };
            let motion = Motion::new(&model, settings(2e-5, ladder)).unwrap();
            let (state, parts, retries) = march(&motion, &start, 8);
            println!(
                "{parts} parts, {retries} retries, {} rungs",
                motion.n_factored_rungs()
            );
            assert!(parts > 8 && motion.n_factored_rungs() < 6);
            assert!(state.ledger.relative_defect().abs() < 1e-9, "{:?}", state.ledger);
            assert!(motion.n_coordinates(Side::Inner) > 0);
            state
        })
    };
    assert!(solve(1) == solve(2), "states differ");
}

/// Wrong: a run would go on with steps that are too inaccurate, or would not say where it stopped.
#[test]
fn the_floor_of_the_ladder_is_an_error_that_says_so() {
    let (model, start) = radial_step(false);
    let ladder = Ladder {
        halvings: 2,
        tolerance: Some(1e-9),
    };
    let motion = Motion::new(&model, settings(2e-5, ladder)).unwrap();
    let error = motion
        .step(&motion.start(&start), &mut StepCache::default())
        .err()
        .unwrap();
    assert!(
        matches!(error, DynamicsError::StepFailed { halvings: 2, .. }),
        "{error:?}"
    );
    let text = error.to_string();
    assert!(
        text.contains(
            "the step of 5.000e-6 s (2 times halved) from t = 0.000000e0 s failed: the local error is"
        ) && text.contains(
            "of the largest contact approach, expected 1.0e-9; allow smaller steps or a larger error"
        ),
        "{text}"
    );
}

/// Wrong: steps could not adapt from undeformed bodies, whose first acceleration is no error; or a driven shaft would
/// start elsewhere than it is driven. 2 kN of thrust come on at t = 0, x is held 1 um aside.
#[test]
fn undeformed_bodies_start_under_load_with_adaptive_steps() {
    let mut model = Case::axial(2000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    model.shaft[0] = ShaftDof::Prescribed(1e-6);
    let ladder = Ladder {
        halvings: 6,
        tolerance: Some(1e-2),
    };
    let motion = Motion::new(&model, settings(1e-5, ladder)).unwrap();
    let mut state = motion.rest([0.0; 5], [0.0; 5]);
    assert_eq!((state.shaft[0], state.shaft_velocity[0]), (1e-6, 0.0));
    let mut cache = StepCache::default();
    for _ in 0..20 {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    assert!(
        state.shaft[2] > 1e-6 && state.ledger.relative_defect().abs() < 1e-9,
        "{:?}",
        state.ledger
    );
}
