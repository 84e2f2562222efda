//! Speeds: run-up, reversal, a stop dead, light balls at high speed, and a million steps of steady running.

use dynamics::effects::{BallCentrifugal, FrameRotation, GyroscopicMoment, MomentShares};
use dynamics::kinematics::{BallSpeeds, Speed};
use dynamics::motion::{Motion, MotionSettings};
use dynamics::{Model, StaticSolution};

use super::bearings::{Load, RPM, conserving, equilibrium_at, flexible, rigid, transient};
use super::course::{Course, from_equilibrium, march_with};
use super::plot::{Curve, Plot};
use super::record::Record;
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "run_up",
            Pace::Fast,
            "1800 to 18 000 rpm in 1 ms: the centrifugal force of the balls grows a hundredfold",
            "2 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 5 ms",
            |r| run_up(r, [1800.0, 18_000.0], 1e-3),
        ),
        case(
            "run_up_flexible",
            Pace::Slow,
            "the same with the inertia of the turning ring: centrifugal, Coriolis, Euler, softening",
            "both rings flexible, frame rotation, gyroscopic moment, dt 5 us, 3 ms",
            run_up_flexible,
        ),
        case(
            "stop_dead",
            Pace::Fast,
            "18 000 rpm to a stand in 10 us",
            "2 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 5 ms",
            |r| run_up(r, [18_000.0, 0.0], 1e-5),
        ),
        case(
            "reversal",
            Pace::Fast,
            "6000 rpm to -6000 rpm in 1 ms, through zero",
            "2 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 5 ms",
            |r| run_up(r, [6000.0, -6000.0], 1e-3),
        ),
        case(
            "light_and_fast",
            Pace::Fast,
            "40 000 rpm with 50 N: the balls' centrifugal force is 20 times the load, inner contacts hardly touch",
            "rigid rings, shaft 0.5 kg, ball centrifugal force, dt 5 us, 20 ms, a disturbance of 10 N radial at 0",
            light_and_fast,
        ),
        case(
            "light_and_fast_gyroscopic",
            Pace::Fast,
            "the gyroscopic moment at 40 000 rpm against contacts of a few newton",
            "the same with the gyroscopic moment",
            light_gyroscopic,
        ),
        case(
            "gyroscopic_alone",
            Pace::Fast,
            "without the centrifugal force the moment is a third of the contact forces: the angles and it chase each \
             other",
            "rigid rings, 40 000 rpm, 500 N, gyroscopic moment only, 0 to 400 N radial, at rest",
            gyroscopic_alone,
        ),
        case(
            "million_steps",
            Pace::Slow,
            "drift that a short run does not show",
            "1800 rpm, 2 kN axial and 1 kN radial, rigid rings, shaft 0.5 kg, no damping, 10^6 steps of 10 us",
            |r| steady(r, 1_000_000),
        ),
        case(
            "ten_thousand_steps",
            Pace::Fast,
            "the same, shorter, for the normal tests",
            "the same, 10^4 steps",
            |r| steady(r, 10_000),
        ),
        case(
            "steady_flexible",
            Pace::Slow,
            "the same with patches that move over the elements and the seam of the mesh",
            "both rings flexible, 4000 steps of 10 us: half a turn of the cage",
            steady_flexible,
        ),
    ]
}

/// Statics must settle, in balance, with loads that are those of its angles, and must say that no friction carries
/// them.
fn gyroscopic_alone(record: &mut Record) {
    for radial in [0.0, 100.0, 400.0] {
        let mut model = rigid(Load::dead(500.0), Load::dead(radial));
        model.effects.push(Box::new(GyroscopicMoment {
            speeds: Speed::constant(40_000.0 * RPM).into(),
            slip: [0.0; 2],
            shares: MomentShares::OUTER_CONTROL,
            ball_speeds: BallSpeeds::FreeAngle,
        }));
        let rest = match equilibrium_at(&model, 0.0) {
            Ok(rest) => rest,
            Err(error) => {
                record.that(&format!("{radial} N radial has an equilibrium: {error}"), false);
                continue;
            }
        };
        let contacts = rest
            .balls
            .iter()
            .flat_map(|b| [b.inner.contact_angle_rad, b.outer.contact_angle_rad]);
        let angles: Vec<f64> = contacts.collect();
        let now = dynamics::effects::Now {
            angles: Some(&angles),
            ..Default::default()
        };
        let loads = model.loads(&now).unwrap();
        let mut worst = 0.0f64;
        for (b, ball) in rest.balls.iter().enumerate() {
            let push = |side: usize, c: &dynamics::balls::ContactResult| {
                let (sin, cos) = c.contact_angle_rad.sin_cos();
                let sign = [1.0, -1.0][side];
                let across = loads.contacts[2 * b + side];
                [
                    sign * c.force_n * cos - across.radial,
                    sign * c.force_n * sin - across.axial,
                ]
            };
            let (inner, outer) = (push(0, &ball.inner), push(1, &ball.outer));
            worst = (0..2).fold(worst, |w, i| w.max((inner[i] + outer[i]).abs()));
        }
        record.below(
            &format!("ball out of balance at {radial} N radial, N,"),
            worst,
            1e-5,
        );
        record.says(&rest.warnings.join("; "), "asks for a friction coefficient of");
    }
}

/// The turning bearing's settings at constant or changing speed, rpm.
fn turning(speed: Speed, dt: f64) -> MotionSettings {
    MotionSettings {
        speeds: speed.into(),
        ..conserving(dt)
    }
}

fn add_centrifugal(model: &mut Model, speed: &Speed) {
    model.effects.push(Box::new(BallCentrifugal {
        speeds: speed.clone().into(),
        slip: [0.0; 2],
        ball_speeds: BallSpeeds::FreeAngle,
    }));
}

fn speeds([from, to]: [f64; 2], duration: f64) -> Speed {
    Speed::table(vec![0.0, duration], vec![from * RPM, to * RPM])
}

fn plot(course: &Course) -> Option<Plot> {
    Some(Plot {
        x: "time, ms",
        y: "shaft displacement z, um",
        curves: vec![course.curve("z", 1)],
    })
}

fn run_up(record: &mut Record, rpm: [f64; 2], duration: f64) {
    let speed = speeds(rpm, duration);
    let mut model = rigid(Load::dead(2e3), Load::dead(0.0));
    add_centrifugal(&mut model, &speed);
    let course = transient(&model, turning(speed, 5e-6), 5e-3);
    record.closed(&course);
    settled_between(record, &model, &course, 5e-3);
    record.plot = plot(&course);
}

/// The mean place lies nearer to the static one after the change than the change moves it. (The balls' transverse
/// motion along the grooves, which nothing damps, shifts it: their angles swing by degrees.)
fn settled_between(record: &mut Record, model: &Model, course: &Course, end: f64) {
    let at = |t| equilibrium_at(model, t).unwrap().displacements.shaft[2];
    let (from, middle, to) = (at(0.0), at(0.5e-3), at(end));
    let span = (to - from).abs().max((to - middle).abs());
    record.note(format!(
        "z at rest {:.2} um before, {:.2} um after, mean {:.2} um",
        1e6 * from,
        1e6 * to,
        1e6 * course.mean_shaft[2]
    ));
    record.below(
        "mean place off the static one after it over the way",
        (course.mean_shaft[2] - to).abs() / span,
        0.75,
    );
}

fn run_up_flexible(record: &mut Record) {
    let speed = speeds([1800.0, 18_000.0], 1e-3);
    let mut model = flexible(Load::dead(2e3), Load::dead(0.0));
    add_centrifugal(&mut model, &speed);
    model.effects.push(Box::new(FrameRotation::new(speed.clone())));
    model.effects.push(Box::new(GyroscopicMoment {
        speeds: speed.clone().into(),
        slip: [0.0; 2],
        shares: MomentShares::OUTER_CONTROL,
        ball_speeds: BallSpeeds::FreeAngle,
    }));
    let course = transient(&model, turning(speed, 5e-6), 3e-3);
    record.closed(&course);
    settled_between(record, &model, &course, 3e-3);
    record.plot = plot(&course);
}

fn light(gyroscopic: bool) -> (Model, StaticSolution, MotionSettings) {
    let speed = Speed::constant(40_000.0 * RPM);
    let build = |radial: f64| {
        let mut model = rigid(Load::dead(50.0), Load::dead(radial));
        add_centrifugal(&mut model, &speed);
        if gyroscopic {
            model.effects.push(Box::new(GyroscopicMoment {
                speeds: speed.clone().into(),
                slip: [0.0; 2],
                shares: MomentShares::OUTER_CONTROL,
                ball_speeds: BallSpeeds::FreeAngle,
            }));
        }
        model
    };
    let start = equilibrium_at(&build(0.0), 0.0).unwrap();
    (build(10.0), start, turning(speed, 5e-6))
}

fn light_and_fast(record: &mut Record) {
    let (model, start, settings) = light(false);
    let ball = &start.balls[0];
    record.note(format!(
        "at rest {:.2} N at {:.1} deg inside, {:.1} N at {:.2} deg outside",
        ball.inner.force_n,
        ball.inner.contact_angle_rad.to_degrees(),
        ball.outer.force_n,
        ball.outer.contact_angle_rad.to_degrees()
    ));
    // Axial balance of a ball, and of all of them with the load.
    let axial = |f: f64, angle: f64| 18.0 * f * angle.sin();
    record.near(
        "axial force of the inner contacts, N,",
        axial(ball.inner.force_n, ball.inner.contact_angle_rad),
        50.0,
        1e-8,
    );
    record.near(
        "axial force of the outer contacts, N,",
        axial(ball.outer.force_n, ball.outer.contact_angle_rad),
        50.0,
        1e-8,
    );
    let course = from_equilibrium(&model, &start, settings, 4000);
    record.closed(&course);
    record.below(
        "largest force over that at rest",
        course.peak / ball.outer.force_n,
        2.0,
    );
    record.plot = Some(Plot {
        x: "time, ms",
        y: "shaft displacement, um",
        curves: vec![course.curve("x", 0), course.curve("z", 1)],
    });
}

fn light_gyroscopic(record: &mut Record) {
    let (model, start, settings) = light(true);
    let course = from_equilibrium(&model, &start, settings, 4000);
    record.closed(&course);
    record.below(
        "largest force over that at rest",
        course.peak / start.balls[0].outer.force_n,
        2.0,
    );
}

fn steady(record: &mut Record, n: usize) {
    let speed = Speed::constant(1800.0 * RPM);
    let model = rigid(Load::dead(2e3), Load::dead(1e3));
    let start = equilibrium_at(&model, 0.0).unwrap();
    let motion = Motion::new(&model, turning(speed, 1e-5)).unwrap();
    let x0 = start.displacements.shaft;
    // Kinetic energy of the balls and the way of the shaft, in ten parts of the run.
    let (mut kinetic, mut place) = (vec![0.0f64; 10], vec![0.0f64; 10]);
    let (mut curve, mut highest) = (Vec::new(), 0.0f64);
    let course = march_with(&motion, motion.start(&start), n, |s| {
        let part = ((s.step - 1) as usize * 10 / n).min(9);
        kinetic[part] = kinetic[part].max(s.ledger.kinetic.iter().sum());
        let off = (0..3).map(|i| (s.shaft[i] - x0[i]).abs()).fold(0.0, f64::max);
        place[part] = place[part].max(off);
        highest = highest.max(s.ledger.relative_defect().abs());
        if (s.step as usize).is_multiple_of(n / 200) {
            curve.push([motion.time(s.step), highest]);
        }
    });
    record.closed(&course);
    let largest = course.last.ledger.largest;
    record.note(format!(
        "largest kinetic energy in the first and the last tenth {:.2e} and {:.2e} of the largest energy; shaft within \
         {:.2e} and {:.2e} um of its start",
        kinetic[0] / largest,
        kinetic[9] / largest,
        1e6 * place[0],
        1e6 * place[9]
    ));
    record.below(
        "kinetic energy in the last tenth over the largest energy",
        kinetic[9] / largest,
        1e-4,
    );
    record.below(
        "shaft off its place in the last tenth over its displacement",
        place[9] / x0[2],
        1e-2,
    );
    record.plot = Some(Plot {
        x: "time, s",
        y: "ledger defect so far",
        curves: vec![Curve {
            name: "defect".to_string(),
            points: curve,
        }],
    });
}

fn steady_flexible(record: &mut Record) {
    let speed = Speed::constant(1800.0 * RPM);
    let model = flexible(Load::dead(2e3), Load::dead(1e3));
    let start = equilibrium_at(&model, 0.0).unwrap();
    let course = from_equilibrium(&model, &start, turning(speed, 1e-5), 4000);
    record.closed(&course);
    let x0 = start.displacements.shaft;
    record.near("mean x, m,", course.mean_shaft[0], x0[0], 2e-2);
    record.near("mean z, m,", course.mean_shaft[2], x0[2], 2e-3);
    record.plot = Some(Plot {
        x: "time, ms",
        y: "largest ball force, N",
        curves: vec![course.curve("force", 2)],
    });
}
