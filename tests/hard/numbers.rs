//! Late times, denormals, decades of load, tolerances that cannot be.

use dynamics::StaticSolver;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings};

use super::bearings::{Load, RPM, conserving, equilibrium_at, rigid, set_loads};
use super::course::march;
use super::record::Record;
use super::{HardCase, Pace};
use crate::util::{Dir, RIGID, SCENE};

use super::invariance::{loaded, results};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "late_time",
            Pace::Fast,
            "10^4 s in steps of 1 us: the clock has lost 12 digits",
            "the same motion from step 10^10 on, at rest",
            late,
        ),
        case(
            "late_time_turning",
            Pace::Fast,
            "the same at 1800 rpm, after 300 000 turns",
            "azimuths of balls at step 10^10 against integers",
            late_turning,
        ),
        case(
            "duration_of_1e4_s",
            Pace::Fast,
            "the number of steps must not depend on round-off",
            "10^4 s in steps of 1 us, 7.7 s in steps of 1.1 us, by the program's check",
            duration,
        ),
        case(
            "denormal_load",
            Pace::Fast,
            "forces below the smallest normal number",
            "1e-310 N axial; displacement 1e-310 m at the start",
            denormal,
        ),
        case(
            "tiny_and_huge_loads",
            Pace::Fast,
            "12 decades of load",
            "1e-6 to 1e6 N axial, rigid rings, against Q ~ load",
            decades,
        ),
        case(
            "wrong_tolerances",
            Pace::Fast,
            "a run that is not converged must not be called one",
            "solver.tolerance 1e-300, 0, 1, nan; ledger_tolerance 0, -1, nan, 1e-300",
            tolerances,
        ),
        case(
            "one_round_only",
            Pace::Fast,
            "the same with too few iterations",
            "max_iterations = 1 at flexible rings",
            one_round,
        ),
    ]
}

fn late(record: &mut Record) {
    let mut model = rigid(Load::dead(1e3), Load::dead(500.0));
    let start = equilibrium_at(&model, 0.0).unwrap();
    set_loads(&mut model, Load::dead(1e3), Load::dead(2e3));
    let motion = Motion::new(&model, conserving(1e-6)).unwrap();
    let early = motion.start(&start);
    let mut late = early.clone();
    late.step = 10_000_000_000;
    record.near("time, s,", motion.time(late.step), 1e4, 1e-15);
    let (early, late) = (march(&motion, early, 500), march(&motion, late, 500));
    record.closed(&early);
    record.closed(&late);
    record.that("the number of steps is exact", late.last.step == 10_000_000_500);
    let same = early.last.shaft == late.last.shaft && early.last.balls == late.last.balls;
    record.that("the same motion, bit for bit", same);
}

fn late_turning(record: &mut Record) {
    let model = rigid(Load::dead(2e3), Load::dead(1e3));
    let speed = Speed::constant(1800.0 * RPM);
    let motion = Motion::new(
        &model,
        MotionSettings {
            speeds: speed.into(),
            ..conserving(1e-6)
        },
    )
    .unwrap();
    let mut state = motion.start(&equilibrium_at(&model, 0.0).unwrap());
    // The equilibrium where the balls stand then, so that nothing jumps.
    let step = 10_000_000_000;
    let time = motion.time(step);
    let turned = motion.ball_azimuth(0, time);
    let mut there = rigid(Load::dead(2e3), Load::dead(1e3));
    there.geometry.first_ball_azimuth = turned;
    let rest = equilibrium_at(&there, 0.0).unwrap();
    state.balls = rest.displacements.balls.clone();
    state.shaft = rest.displacements.shaft;
    state.step = step;
    record.note(format!("{:.0} turns of the cage", turned / std::f64::consts::TAU));
    let state = motion.with_energies(state);
    let hertz = rest.hertz_energy;
    let mut state = state;
    state.ledger.hertz = hertz;
    let course = march(&motion, motion.with_energies(state), 1000);
    record.closed(&course);
    let x0 = rest.displacements.shaft;
    record.near("mean x, m,", course.mean_shaft[0], x0[0], 1e-3);
    record.near("mean z, m,", course.mean_shaft[2], x0[2], 1e-3);
}

fn duration(record: &mut Record) {
    let check = |duration: &str, step: &str| {
        let text = format!("[dynamic]\nduration = \"{duration}\"\nstep = \"{step}\"\noutput_every = 100000");
        let dir = Dir::with_scene(&SCENE.replace("[static]", &text));
        dir.raceway(&[&["check", "scene.toml"][..], &RIGID[..]].concat())
    };
    let too_long = check("10000 s", "1 us");
    record.that("10^10 steps end with code 2", too_long.code == Some(2));
    record.says(too_long.stderr.trim(), "more than 1e8, check both units");
    for (duration, step, n) in [
        ("100 s", "1 us", "100000000"),
        ("0.3 s", "0.1 ms", "3000"),
        ("7.7 s", "1.1 us", "7000000"),
    ] {
        let outcome = check(duration, step);
        let printed = outcome.stdout.replace([' ', ','], "");
        record.that(
            &format!("{duration} in steps of {step} are {n} steps"),
            outcome.code == Some(0) && printed.contains(n),
        );
    }
}

fn denormal(record: &mut Record) {
    let tiny = rigid(Load::dead(1e-310), Load::dead(0.0));
    match equilibrium_at(&tiny, 0.0) {
        Ok(solution) => record.that(
            "a finite answer",
            results(&solution).iter().all(|x| x.is_finite()),
        ),
        Err(error) => record.says(&error.to_string(), "nothing resists it"),
    }
    let model = rigid(Load::dead(1e3), Load::dead(0.0));
    let start = equilibrium_at(&model, 0.0).unwrap();
    let motion = Motion::new(&model, conserving(5e-6)).unwrap();
    let mut state = motion.start(&start);
    state.shaft[0] = 1e-310;
    state.ball_velocities[0] = [1e-310, -1e-320].into();
    let course = march(&motion, state, 200);
    record.closed(&course);
}

fn decades(record: &mut Record) {
    let mut angles = Vec::new();
    for exponent in -6..=5 {
        let load = 10f64.powi(exponent);
        let model = rigid(Load::dead(load), Load::dead(0.0));
        let solution = StaticSolver::new(&model).unwrap().solve(&model, None).unwrap();
        let sum: f64 = solution
            .balls
            .iter()
            .map(|b| b.inner.force_n * b.inner.contact_angle_rad.sin())
            .sum();
        record.near(
            &format!("axial force of the balls at {load:e} N"),
            sum,
            load,
            1e-7,
        );
        angles.push(solution.balls[0].inner.contact_angle_rad);
    }
    record.that(
        "contact angles grow with the load",
        angles.windows(2).all(|a| a[1] > a[0]),
    );
}

fn tolerances(record: &mut Record) {
    let dynamic = "[dynamic]\nduration = \"0.1 ms\"\nstep = \"10 us\"";
    let dir = Dir::with_scene(&SCENE.replace("[static]", dynamic));
    for set in [
        "solver.tolerance=1e-300",
        "solver.tolerance=0.0",
        "solver.tolerance=1.0",
        "solver.tolerance=nan",
        "dynamic.ledger_tolerance=0.0",
        "dynamic.ledger_tolerance=-1.0",
        "dynamic.ledger_tolerance=nan",
        "dynamic.ledger_tolerance=1e-300",
    ] {
        let arguments = [
            &["run", "scene.toml", "--out", "out", "--set", set][..],
            &RIGID[..],
        ]
        .concat();
        let outcome = dir.raceway(&arguments);
        let key = set.split('=').next().unwrap();
        record.that(
            &format!("{set} ends with code 2 or 3, not {:?}", outcome.code),
            matches!(outcome.code, Some(2 | 3)),
        );
        record.that(
            &format!("the error of {set} names the key"),
            outcome.stderr.contains(key),
        );
        std::fs::remove_dir_all(dir.path("out")).ok();
    }
}

fn one_round(record: &mut Record) {
    let mut model = loaded();
    model.tolerances.max_rounds = 1;
    let error = equilibrium_at(&model, 0.0)
        .err()
        .map_or(String::new(), |e| e.to_string());
    record.says(&error, "contact places do not settle after 1 rounds");
}
