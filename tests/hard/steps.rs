//! The same cases at steps from 1 to 50 us with every integrator a scene offers: stable, stopped with an error, or
//! caught by the ledger.
//!
//! A run that comes to its end with a closed ledger must also be right: forces bounded, and up to 20 us (a ball's
//! period is 23 us) its mean place that of the reference, average acceleration at 1 us, to a share of the way that
//! the shaft makes in it. (After an impact the shaft swings about the place where it was: its mean is no measure, its
//! swing is.) Integrators that dissipate must not give back what they took: Newmark's in the energy at every step,
//! the others in their own norm (`norm`), once the loads rest and where steps resolve the balls.

use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::motion::ledger::LOSSY;
use dynamics::motion::{Integrator, MotionSettings};
use dynamics::{Model, ShaftDof};
use input::Schedule;

use super::bearings::{Load, RPM, conserving, equilibrium_at, flexible, rigid, transient};
use super::course::Course;
use super::norm::watched;
use super::record::{LEDGER, Record};
use super::{HardCase, Pace};

/// Step sizes, us.
const ALL: [f64; 5] = [1.0, 5.0, 10.0, 20.0, 50.0];
const COARSE: [f64; 3] = [10.0, 20.0, 50.0];
/// Largest step whose mean place is compared, us.
const RESOLVED: f64 = 20.0;
/// Share of the largest way from the start by which mean places may differ.
const MEAN: f64 = 0.15;
/// A swing may be smaller or larger than that of the reference by this share.
const SWING: f64 = 0.25;
/// Share of the largest energy that an integrator with memory may give back in its norm in steps of at most `FINE`
/// us, after `QUIET` s, when all loads rest: the difference between the discrete gradient and the forces at both ends
/// of a step.
const GIVEN_BACK: f64 = 0.01;
const FINE: f64 = 10.0;
const QUIET: f64 = 70e-6;
/// A run may not have a larger force than so many times that of the reference.
const PEAK: f64 = 3.0;
/// Time of every run, s.
const DURATION: f64 = 1e-3;

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    let all = "1 to 50 us, 11 settings, 1 ms, 4 halvings";
    vec![
        case(
            "steps_unloading_coarse",
            Pace::Slow,
            "half the balls unload, in steps up to two periods of a ball",
            "10 to 50 us, 11 settings, 1 ms, rigid rings",
            |r| table(r, &unloading(), &COARSE, 0.0),
        ),
        case("steps_unloading", Pace::Slow, "half the balls unload", all, |r| {
            table(r, &unloading(), &ALL, 0.0)
        }),
        case(
            "steps_radial",
            Pace::Slow,
            "radial 200 N to 2 kN in 10 us on 1 kN",
            all,
            |r| table(r, &radial(), &ALL, 0.0),
        ),
        case("steps_axial", Pace::Slow, "axial 2 to 20 kN in 10 us", all, |r| {
            table(r, &axial(), &ALL, 0.0)
        }),
        case(
            "steps_thrown_out",
            Pace::Slow,
            "axial 2 kN to 100 N in 10 us",
            all,
            |r| table(r, &thrown_out(), &ALL, 0.0),
        ),
        case(
            "steps_impact",
            Pace::Slow,
            "10 kN for 50 us, down to one step",
            all,
            |r| swing_table(r, &impact(), &ALL),
        ),
        case(
            "steps_loose",
            Pace::Slow,
            "0.05 mm of clearance, radial 0 to 1 kN in 10 us",
            all,
            |r| table(r, &loose(), &ALL, 0.0),
        ),
        case(
            "steps_turning",
            Pace::Slow,
            "half the balls unload at 18 000 rpm",
            all,
            |r| table(r, &unloading(), &ALL, 18_000.0),
        ),
        case(
            "steps_flexible",
            Pace::Slow,
            "half the balls unload, rings that answer",
            "10 to 50 us, 11 settings, 1 ms, both rings flexible",
            |r| table(r, &unloading_flexible(), &COARSE, 0.0),
        ),
        case(
            "smallest_step_fails",
            Pace::Fast,
            "a step that fails at every size must stop the run and say where",
            "half the balls unload, dt 50 us, local error of 1e-9 asked for, two halvings",
            floor,
        ),
    ]
}

/// All settings a scene offers.
pub fn settings() -> Vec<(&'static str, Integrator, ContactScheme)> {
    let gradient = ContactScheme::DiscreteGradient;
    let pointwise = ContactScheme::Pointwise;
    vec![
        (
            "average_acceleration",
            Integrator::average_acceleration(),
            gradient,
        ),
        ("chung_hulbert 0.8", Integrator::chung_hulbert(0.8), gradient),
        ("chung_hulbert 0.5", Integrator::chung_hulbert(0.5), gradient),
        ("chung_hulbert 0", Integrator::chung_hulbert(0.0), gradient),
        ("hht 0.1", Integrator::hht(0.1), gradient),
        ("hht 0.33", Integrator::hht(0.33), gradient),
        ("newmark 0.25 0.5", Integrator::newmark(0.25, 0.5), gradient),
        ("newmark 0.3025 0.6", Integrator::newmark(0.3025, 0.6), gradient),
        (
            "average_acceleration, pointwise",
            Integrator::average_acceleration(),
            pointwise,
        ),
        (
            "chung_hulbert 0.8, pointwise",
            Integrator::chung_hulbert(0.8),
            pointwise,
        ),
        ("hht 0.1, pointwise", Integrator::hht(0.1), pointwise),
    ]
}

fn unloading() -> Model {
    locked_in_place(rigid(Load::dead(100.0), Load::jump(0.0, 3e3)))
}

fn unloading_flexible() -> Model {
    locked_in_place(flexible(Load::dead(100.0), Load::jump(0.0, 3e3)))
}

fn locked_in_place(mut model: Model) -> Model {
    let rest = equilibrium_at(&model, 0.0).unwrap();
    model.shaft[2] = ShaftDof::Prescribed(rest.displacements.shaft[2]);
    model
}

fn radial() -> Model {
    rigid(Load::dead(1e3), Load::jump(200.0, 2e3))
}

fn axial() -> Model {
    rigid(Load::jump(2e3, 20e3), Load::dead(0.0))
}

fn thrown_out() -> Model {
    rigid(Load::jump(2e3, 100.0), Load::dead(0.0))
}

fn impact() -> Model {
    let pulse = Schedule::Impact {
        start: 0.0,
        duration: 50e-6,
    };
    rigid(Load::dead(1e3), Load(10e3, pulse))
}

fn loose() -> Model {
    let mut model = rigid(Load::dead(500.0), Load::jump(0.0, 1e3));
    let g = &mut model.geometry;
    g.outer_raceway_diameter = g.inner_raceway_diameter + 2.0 * g.ball_diameter + 0.05e-3;
    model
}

/// What became of a run.
enum End {
    Stable,
    /// Its ledger did not close.
    Caught(f64),
    /// It stopped with an error.
    Stopped(String),
    /// Its numbers are wrong, and the program says why: the integrator took this share of the energy.
    Lossy(f64),
    /// It came to its end, but its numbers are wrong.
    Silent(String),
}

/// What of a run is compared with the reference.
#[derive(Clone, Copy, PartialEq)]
enum Measure {
    /// The mean place of the shaft.
    Mean,
    /// Its largest way from the start.
    Swing,
}

fn table(record: &mut Record, model: &Model, steps: &[f64], rpm: f64) {
    compare(record, model, (steps, Measure::Mean), rpm);
}

fn swing_table(record: &mut Record, model: &Model, steps: &[f64]) {
    compare(record, model, (steps, Measure::Swing), 0.0);
}

fn compare(record: &mut Record, model: &Model, (steps, measure): (&[f64], Measure), rpm: f64) {
    let with = |dt: f64| MotionSettings {
        speeds: dynamics::kinematics::Speed::constant(rpm * RPM).into(),
        ..conserving(1e-6 * dt)
    };
    let reference = transient(model, with(1.0), DURATION);
    record.closed(&reference);
    let mut text = "| setting |".to_string();
    steps.iter().for_each(|dt| text.push_str(&format!(" {dt} us |")));
    text.push_str(&format!("\n|---|{}", "---|".repeat(steps.len())));
    let (mut counts, mut most_back) = ([0; 3], 0.0f64);
    for (name, integrator, scheme) in settings() {
        text.push_str(&format!("\n| {name} |"));
        for dt in steps {
            let settings = MotionSettings {
                integrator,
                scheme,
                ..with(*dt)
            };
            let (course, back) = if model.rings.iter().any(Option::is_some) {
                (transient(model, settings, DURATION), None)
            } else {
                let (course, back) = watched(model, settings, DURATION, QUIET);
                (course, Some(back))
            };
            let end = judge(&course, &reference, (*dt, measure));
            text.push_str(&format!(" {} |", word(&end)));
            let place = match end {
                End::Stable | End::Silent(_) | End::Lossy(_) => 0,
                End::Caught(_) => 1,
                End::Stopped(_) => 2,
            };
            counts[place] += 1;
            let setting = Setting {
                name,
                dt: *dt,
                integrator,
                scheme,
            };
            must_hold(record, &setting, &course, &end);
            if scheme == ContactScheme::DiscreteGradient && !integrator.is_conserving() {
                most_back = most_back.max(loses(record, &setting, (&course, back)));
            }
        }
    }
    let [stable, caught, stopped] = counts;
    record.note(format!(
        "{stable} stable, {caught} caught by the ledger, {stopped} stopped with an error, none silently wrong"
    ));
    if model.rings.iter().all(Option::is_none) {
        record.note(format!(
            "at any step an integrator with memory gives back up to {most_back:.1e} of the largest energy in its norm"
        ));
    }
    record.that(
        "the comparison fails somewhere, or the case is not hard",
        caught + stopped > 0,
    );
    record.tables.push(text);
}

/// One place of a table.
struct Setting {
    name: &'static str,
    /// Step, us.
    dt: f64,
    integrator: Integrator,
    scheme: ContactScheme,
}

/// No run may be silently wrong; with the discrete gradient the ledger closes, and average acceleration is stable.
fn must_hold(record: &mut Record, setting: &Setting, course: &Course, end: &End) {
    let Setting { name, dt, .. } = setting;
    if let End::Silent(why) = end {
        record.that(&format!("{name} at {dt} us is not silently wrong: {why}"), false);
    }
    if setting.scheme != ContactScheme::DiscreteGradient {
        return;
    }
    record.note_defect(course.defect);
    if setting.integrator.is_conserving() {
        let text = format!("{name} at {dt} us is stable{}", course.ending());
        record.that(&text, matches!(end, End::Stable));
    } else {
        let text = format!("the ledger of {name} at {dt} us closes{}", course.ending());
        record.that(&text, !matches!(end, End::Caught(_)));
    }
}

/// What a dissipating integrator took it must keep: Newmark's at every step, the others in their norm but for a
/// share; `back` is what it gave back there, J, unknown for flexible rings. Gives the share of one that is only
/// noted.
fn loses(record: &mut Record, setting: &Setting, (course, back): (&Course, Option<f64>)) -> f64 {
    let Setting {
        name, dt, integrator, ..
    } = setting;
    let largest = course.last.ledger.largest;
    let back = back.unwrap_or(0.0) / largest;
    if integrator.old == [0.0; 2] {
        let share = course.given_back / largest;
        let text = format!("share of the energy that {name} at {dt} us gives back");
        record.below(&text, share, 1e-12);
    } else if *dt <= FINE {
        let text = format!("share that {name} at {dt} us gives back in its norm");
        record.below(&text, back, GIVEN_BACK);
    }
    back
}

/// Numbers that are wrong without a word, unless the program warns of the integrator's loss.
fn wrong(course: &Course, why: String) -> End {
    let share = course.last.ledger.numerical_share();
    if share > LOSSY {
        End::Lossy(share)
    } else {
        End::Silent(why)
    }
}

fn judge(course: &Course, reference: &Course, (dt, measure): (f64, Measure)) -> End {
    if let Some(error) = &course.error {
        return match error.contains("ledger") {
            true => End::Caught(course.defect),
            false => End::Stopped(error.clone()),
        };
    }
    let largest = |q: [f64; 5]| q.into_iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let off = largest([0, 1, 2, 3, 4].map(|i| course.mean_shaft[i] - reference.mean_shaft[i]));
    let way = reference.excursion;
    if !course.is_finite() || course.defect.is_nan() || course.defect > LEDGER {
        End::Silent("not finite".to_string())
    } else if course.peak > PEAK * reference.peak {
        wrong(
            course,
            format!(
                "a force of {:.0} N, the reference has {:.0} N",
                course.peak, reference.peak
            ),
        )
    } else if measure == Measure::Swing && dt <= RESOLVED && (course.excursion / way - 1.0).abs() > SWING {
        wrong(
            course,
            format!(
                "a swing of {:.1e} m, the reference has {way:.1e} m",
                course.excursion
            ),
        )
    } else if measure == Measure::Mean && dt <= RESOLVED && off > MEAN * way {
        wrong(
            course,
            format!("mean place off by {off:.1e} m of a way of {way:.1e} m"),
        )
    } else {
        End::Stable
    }
}

fn word(end: &End) -> String {
    match end {
        End::Stable => "stable".to_string(),
        End::Lossy(share) => format!("warns: {:.0} % lost", 100.0 * share),
        End::Caught(defect) => format!("ledger {defect:.0e}"),
        End::Stopped(error) => format!("stopped: {}", error.split([':', ';']).next().unwrap_or_default()),
        End::Silent(why) => format!("**wrong**: {why}"),
    }
}

fn floor(record: &mut Record) {
    let model = unloading();
    let mut settings = conserving(5e-5);
    settings.ladder = dynamics::motion::Ladder {
        halvings: 2,
        tolerance: Some(1e-9),
    };
    let start = equilibrium_at(&model, 0.0).unwrap();
    let course = super::course::from_equilibrium(&model, &start, settings, 40);
    let error = course.error.clone().unwrap_or_default();
    record.says(&error, "the step of 1.250e-5 s (2 times halved) from t =");
    record.says(&error, "the local error is");
    record.that("its last good state is finite", course.is_finite());
}
