//! Spalls: balls fall in, hit their ends, and come out.

use contact::Side;
use contact::surface::sag;
use dynamics::kinematics::Speed;
use dynamics::motion::MotionState;

use super::bearings::{Load, RPM};
use super::plot::Plot;
use super::record::Record;
use super::steps::settings;
use super::surfaces::{ENTRY, Rolling, at_rest, outer_force, usual};
use super::{HardCase, Pace};
use crate::util::lockstep::small_motion;
use crate::util::{Dir, with_line};

pub fn cases() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    let fast = |name, why, settings, run| HardCase::new(name, Pace::Fast, why, settings, run);
    vec![
        slow(
            "surface_sharp_spall",
            "edges without ramps: the ball falls freely and hits the far end",
            "rigid rings, 2 kN, 1800 rpm, spall of 1 mm and 0.2 mm depth, dt 2 us, 0.6 ms",
            sharp,
        ),
        slow(
            "surface_steps_1_to_20_us",
            "steps beyond the time in which a contact passes an edge",
            "the same, dt 1, 2, 5, 10 and 20 us",
            steps,
        ),
        slow(
            "surface_deeper_than_the_sag",
            "a floor that no ball reaches: the ball may sink as far as its roundness lets it and no more",
            "the same, spall of 2 mm and 1 mm depth, damped, 1 ms",
            deep,
        ),
        slow(
            "surface_longer_than_the_pitch",
            "a spall of 20 mm, balls 13 mm apart: two balls are in it",
            "rigid rings, 2 kN, 1800 rpm, 20 um deep, dt 5 us, 4 ms",
            long,
        ),
        slow(
            "surface_two_balls_in_spalls",
            "balls that face each other fall at once: the shaft must not move across",
            "rigid rings, 2 kN, 1800 rpm, two sharp spalls of 1 mm, dt 2 us, 0.6 ms",
            two,
        ),
        slow(
            "surface_all_balls_in_spalls",
            "all balls lose the ring at once and are caught at once",
            "rigid rings, 2 kN, 1800 rpm, 18 sharp spalls of 0.7 mm, dt 2 us, 0.6 ms",
            all,
        ),
        slow(
            "surface_start_in_a_spall",
            "the motion starts from an equilibrium with a ball over the hole",
            "rigid rings, 2 kN, 1800 rpm, spall of 2 mm under ball 0 at t = 0, dt 2 us",
            start_inside,
        ),
        slow(
            "surface_load_jumps_in_a_spall",
            "the load comes while a ball hangs over the hole",
            "rigid rings, 0.5 to 8 kN in 10 us at t = 0, in the middle of a spall of 1 mm, dt 2 us",
            jump,
        ),
        slow(
            "surface_smaller_than_the_ellipse",
            "a hole of 0.2 mm by 0.2 mm in an ellipse of 1.5 mm",
            "rigid rings, 2 kN, 1800 rpm, dt 1 us, 0.3 ms",
            pinhole,
        ),
        slow(
            "surface_10_000_and_30_000_rpm",
            "the ball crosses 1 mm in 60 and 20 us, less than its own period",
            "rigid rings, 2 kN, sharp spall of 1 mm, dt 1 us, 0.3 ms",
            fast_shaft,
        ),
        slow(
            "surface_spall_dissipating",
            "integrators that take energy while surfaces do work",
            "rigid rings, 2 kN, 1800 rpm, sharp spall of 1 mm, dt 5 us, 7 settings",
            dissipating,
        ),
        slow(
            "surface_spall_flexible",
            "a blow on rings that ring, with patches that follow",
            "both rings flexible, 2 kN, 500 N radial, 1800 rpm, sharp spall of 1 mm, dt 5 us, 0.6 ms",
            flexible_spall,
        ),
        slow(
            "surface_reversal",
            "the ball stops in the spall and rolls out as it came in",
            "rigid rings, 2 kN, 1800 to -1800 rpm in 0.4 ms, sharp spall of 1 mm, dt 2 us, 0.8 ms",
            reversal,
        ),
        fast(
            "surface_spall_at_rest",
            "an energy that is not convex: equilibria from a scratch to a hole without a floor",
            "rigid rings, 2 kN, 1 kN radial on the ball over a spall of 1 mm, 0.1 um to 1 mm deep",
            at_rest,
        ),
        fast(
            "surface_spall_and_cut",
            "a spall of the profile where the mesh has a hole would count twice",
            "the small motion of the tests with both on the outer ring",
            cut,
        ),
        fast(
            "surface_free_balls",
            "what is not computed must be refused before anything runs",
            "contact.ball = \"sphere\" beside a spall and free balls",
            free_balls,
        ),
    ]
}

fn sharp(record: &mut Record) {
    let case = usual().over(1e-3, 0.2e-3);
    let mut least = f64::INFINITY;
    let course = case.seen(record, |state| least = least.min(outer_force(state, 0)));
    record.below("least force of the ball, N", least, 1.0);
    // The ball meets the far end with half of v k L and is stopped by its contact: sqrt(m k) times that, some kN.
    record.below("largest force, N", course.peak, 2000.0);
}

fn steps(record: &mut Record) {
    let (mut curves, mut means) = (Vec::new(), Vec::new());
    for dt in [1e-6, 2e-6, 5e-6, 10e-6, 20e-6] {
        let course = Rolling {
            dt,
            ..usual().over(1e-3, 0.2e-3)
        }
        .holds(record);
        means.push(course.mean_shaft[2]);
        let mut plot = record.plot.take().map(|plot| plot.curves).unwrap_or_default();
        plot.iter_mut()
            .for_each(|c| c.name = format!("dt {:.0} us", 1e6 * dt));
        curves.extend(plot);
    }
    for (mean, dt) in means[1..].iter().zip([2, 5, 10, 20]) {
        record.near(
            &format!("mean place of the shaft with {dt} us, m,"),
            *mean,
            means[0],
            1e-2,
        );
    }
    record.plot = Some(Plot {
        x: "time, ms",
        y: "force, N",
        curves,
    });
}

fn deep(record: &mut Record) {
    let length = 2e-3;
    let case = Rolling {
        is_damped: true,
        duration: 1e-3,
        ..usual().over(length, 1e-3)
    };
    let geometry = case.smooth().geometry;
    let angle = case.contact_angle();
    let along =
        |state: &MotionState| state.balls[0].radial * angle.cos() + state.balls[0].axial * angle.sin();
    let (mut first, mut most) = (None, 0.0f64);
    case.seen(record, |state| {
        let sunk = along(state) - *first.get_or_insert_with(|| along(state));
        most = most.max(sunk);
    });
    let sag = sag(&geometry, Side::Outer, angle, length);
    record.note(format!(
        "the ball sinks by {:.1} um of {:.1} um",
        1e6 * most,
        1e6 * sag
    ));
    // The blow at the end presses it in by a few micrometres more.
    record.below("depth to which the ball sinks, m", most, sag + 10e-6);
    record.that("it sinks", most > 0.2 * sag);
}

fn long(record: &mut Record) {
    let case = Rolling {
        dt: 5e-6,
        duration: 4e-3,
        ..usual().over(20e-3, 20e-6)
    };
    let mut both = 0usize;
    let n = 18;
    case.seen(record, |state| {
        let light = |ball: &usize| outer_force(state, *ball) < 1.0;
        both = both.max((0..n).filter(light).count());
    });
    record.that(
        &format!("{both} balls are without load at once, 2 at least"),
        both >= 2,
    );
}

fn two(record: &mut Record) {
    let spalls = [0, 9].map(|ball| usual().spall(ball, 1e-3, 0.2e-3));
    let case = usual().with(Side::Outer, |p| p.spalls = spalls.to_vec());
    let (mut across, mut along) = (0.0f64, 0.0f64);
    let mut first = None;
    case.seen(record, |state| {
        let z = *first.get_or_insert(state.shaft[2]);
        across = across.max(state.shaft[0].hypot(state.shaft[1]));
        along = along.max((state.shaft[2] - z).abs());
    });
    record.below("way across over the way along", across / along, 1e-6);
}

fn all(record: &mut Record) {
    let spalls = (0..18).map(|ball| usual().spall(ball, 0.7e-3, 0.2e-3)).collect();
    let case = usual().with(Side::Outer, |p| p.spalls = spalls);
    let (mut across, mut along) = (0.0f64, 0.0f64);
    let mut first = None;
    let course = case.seen(record, |state| {
        let z = *first.get_or_insert(state.shaft[2]);
        across = across.max(state.shaft[0].hypot(state.shaft[1]));
        along = along.max((state.shaft[2] - z).abs());
    });
    record.that("all outer contacts are open at once", course.open >= 18);
    // Rows of the surface stand a 400th of a spall apart, not alike in all 18.
    record.below("way across over the way along", across / along, 5e-3);
}

fn start_inside(record: &mut Record) {
    let mut spall = usual().spall(0, 2e-3, 0.2e-3);
    spall.azimuth = 0.0;
    let case = usual().with(Side::Outer, |p| p.spalls.push(spall));
    let mut first = None;
    case.seen(record, |state| {
        first.get_or_insert_with(|| outer_force(state, 0));
    });
    let force = first.unwrap_or(f64::NAN);
    record.below("force of the ball at the start, N", force, 1.0);
}

fn jump(record: &mut Record) {
    let mut spall = usual().spall(0, 1e-3, 0.2e-3);
    spall.azimuth = 0.0;
    let case = Rolling {
        axial: Load::jump(500.0, 8000.0),
        ..usual()
    };
    case.with(Side::Outer, |p| p.spalls.push(spall)).holds(record);
}

fn pinhole(record: &mut Record) {
    let mut spall = usual().spall(0, 0.2e-3, 20e-6);
    spall.width = 0.2e-3;
    let case = Rolling {
        dt: 1e-6,
        duration: 0.3e-3,
        ..usual()
    };
    let (mut first, mut least) = (None, f64::INFINITY);
    case.with(Side::Outer, |p| p.spalls.push(spall))
        .seen(record, |state| {
            let force = outer_force(state, 0);
            first.get_or_insert(force);
            least = least.min(force);
        });
    let kept = least / first.unwrap_or(f64::NAN);
    record.note(format!("the contact keeps {:.1} % of its force", 1e2 * kept));
    record.that(
        "it feels the hole, and keeps most of its force",
        kept < 0.999 && kept > 0.8,
    );
}

fn fast_shaft(record: &mut Record) {
    for rpm in [10_000.0, 30_000.0] {
        let case = Rolling {
            dt: 1e-6,
            duration: 0.3e-3,
            ..Rolling::at(2000.0, rpm)
        };
        case.over(1e-3, 0.2e-3).holds(record);
    }
}

fn dissipating(record: &mut Record) {
    for (name, integrator, scheme) in settings() {
        if scheme != dynamics::interactions::discrete_gradient::ContactScheme::DiscreteGradient {
            continue;
        }
        let case = Rolling {
            dt: 5e-6,
            integrator,
            ..usual().over(1e-3, 0.2e-3)
        };
        let course = case.holds(record);
        record.note(name);
        record.below(&format!("{name}: largest force, N"), course.peak, 2000.0);
    }
}

fn flexible_spall(record: &mut Record) {
    let case = Rolling {
        radial: Load::dead(500.0),
        is_flexible: true,
        dt: 5e-6,
        ..usual()
    };
    case.over(1e-3, 0.2e-3).holds(record);
}

fn reversal(record: &mut Record) {
    let speed = 1800.0 * RPM;
    let case = usual().over(1e-3, 0.2e-3);
    // Half of the way through the spall takes ENTRY and 165 us at full speed.
    let start = ENTRY + 60e-6;
    let case = Rolling {
        speeds: Speed::table(vec![start, start + 0.2e-3], vec![speed, -speed]).into(),
        duration: 0.8e-3,
        ..case
    };
    let mut forces = Vec::new();
    case.seen(record, |state| forces.push(outer_force(state, 0)));
    let [first, last] = [forces[0], forces[forces.len() - 1]];
    let least = forces.iter().copied().fold(first, f64::min);
    record.note(format!(
        "ball 0 carries {first:.0} N before, {least:.0} N inside and {last:.0} N at the end"
    ));
    record.that(
        "the ball is in the spall and comes out again",
        least < 0.8 * first && last > 0.8 * first,
    );
}

const SPALL: &str = "[[profiles.spall]]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"18 deg\"\n\
                     length = \"0.5 mm\"\nwidth = \"2 mm\"\ndepth = \"50 um\"\n\n";

fn cut(record: &mut Record) {
    let dir = small_motion();
    let hole = "[[outer.cut]]\nazimuth = [\"-10 deg\", \"10 deg\"]\nz = [\"-3 mm\", \"3 mm\"]\n\n";
    dir.write("scene.toml", dir.text("scene.toml") + "\n" + hole + SPALL);
    refused(
        record,
        &dir,
        "spall 1 of the outer ring lies where its mesh has no raceway: it would count twice",
    );
}

fn free_balls(record: &mut Record) {
    let scene = with_line(
        "[static]",
        "[static]",
        &(SPALL.to_string() + "[static]\n\n[balls]\nmotion = \"free\"\n"),
    );
    refused(
        record,
        &Dir::with_scene(&scene.replace("[contact]", "[contact]\nball = \"sphere\"")),
        "contact.ball is \"sphere\"; beside profiles both contacts of a ball are on their own, use \"half_space\"",
    );
}

/// `raceway run` must refuse the scene, and write nothing.
fn refused(record: &mut Record, dir: &Dir, part: &str) {
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out"]);
    record.that("the exit code is 2", outcome.code == Some(2));
    record.says(outcome.stderr.trim(), part);
    record.that("nothing is written", !dir.path("out").exists());
}
