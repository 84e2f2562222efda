//! Whether the steps of a scene can follow what happens in it: balls that pass, loads and motions that change.
//!
//! ```text
//! balls pass a point of the inner raceway    Z |omega_i - omega_c| / (2 pi) times per second
//! balls pass a point of the outer raceway    Z |omega_c| / (2 pi) times per second
//! ```
//! (Harris, Rolling Bearing Analysis, 4th ed., chapter 8). With n steps per period the amplitude that a step's mean
//! load has is sinc(pi / n) of the true one: 0.996 with 20 steps, 0.64 with two, none with one. With fewer than two
//! steps per period a motion shows another frequency than that of the load, and balls change places unseen: that is
//! refused. Equilibria in time are right each for itself, and adaptive steps may become smaller: they are warned of.

use std::f64::consts::TAU;

use contact::surface::Spall;
use contact::{BearingGeometry, Profiles, Side};
use dynamics::kinematics::{BothRings, Kinematics};
use input::{Quantity, Schedule, TIME};

use crate::error::BuildError;
use crate::tables::{Analysis, Scene};

/// Steps in the time in which a contact passes its own half-width, at a sharp edge.
const STEPS_PER_EDGE: f64 = 5.0;
/// TimeSteps per period from which a result is one.
const STEPS_PER_PERIOD: f64 = 20.0;
/// TimeSteps per period below which a motion shows another frequency (Nyquist).
const LEAST_STEPS: f64 = 2.0;
/// Ball pitches from row to row from which lives of rings may be off by 3 %.
const WIDE_ROWS: f64 = 0.5;
/// Ball pitches from row to row that are enough for lives to 1 %, with seven balls of which two carry.
pub const CLOSE_ROWS: f64 = 0.25;
/// Steps of a pulse from which its shape is there.
const STEPS_PER_PULSE: f64 = 10.0;

/// TimeSteps in time.
struct TimeSteps {
    table: &'static str,
    step: f64,
    duration: f64,
    /// Steps from one with fields to the next.
    output_every: u64,
    /// Whether what is not resolved makes all results wrong.
    is_fixed_motion: bool,
}

/// What is said about steps.
#[derive(Default)]
struct Said {
    problems: Vec<String>,
    warnings: Vec<String>,
}

/// What the steps of a scene show badly: a sentence each. `half_widths` are those of the ellipses along the track, m,
/// inner first; 0 is unknown.
pub fn unresolved(scene: &Scene, geometry: &BearingGeometry, half_widths: BothRings) -> Vec<String> {
    judged(scene, geometry, half_widths).warnings
}

/// Fails where the steps of a scene cannot show what happens.
pub fn require_resolvable(scene: &Scene, geometry: &BearingGeometry) -> Result<(), BuildError> {
    let problems = judged(scene, geometry, [0.0; 2]).problems;
    if problems.is_empty() {
        return Ok(());
    }
    Err(BuildError::Unresolvable {
        path: scene.path.clone(),
        problems,
    })
}

fn judged(scene: &Scene, geometry: &BearingGeometry, half_widths: BothRings) -> Said {
    let mut said = Said::default();
    let Some(steps) = TimeSteps::of(scene) else {
        return said;
    };
    judge_passing(scene, geometry, &steps, &mut said);
    judge_rows(scene, geometry, &steps, &mut said);
    for (key, schedule) in schedules(scene) {
        judge_schedule(&key, &schedule, &steps, &mut said);
    }
    judge_speed(scene, &steps, &mut said);
    for track in worn_tracks(scene, geometry, half_widths) {
        track.judge(&steps, &mut said);
        track.judge_edges(&steps, &mut said);
    }
    said
}

impl TimeSteps {
    fn of(scene: &Scene) -> Option<TimeSteps> {
        match &scene.analysis {
            Analysis::Dynamic(dynamic) => Some(TimeSteps {
                table: "dynamic",
                step: dynamic.step,
                duration: dynamic.duration,
                output_every: dynamic.output_every,
                is_fixed_motion: dynamic.adaptive.is_none(),
            }),
            Analysis::QuasiStatic(quasi) => Some(TimeSteps {
                table: "quasi_static",
                step: quasi.step,
                duration: quasi.duration,
                output_every: quasi.output_every,
                is_fixed_motion: false,
            }),
            Analysis::Static | Analysis::Sweep(_) | Analysis::Modes(_) => None,
        }
    }

    /// Judges something that repeats `rate` times per second: `what` is a sentence without its end.
    fn judge_rate(&self, what: &str, rate: f64, said: &mut Said) {
        let n = 1.0 / (rate * self.step);
        if n >= STEPS_PER_PERIOD {
            return;
        }
        let advice = 1.0 / (rate * STEPS_PER_PERIOD);
        let numbers = format!(
            "{what}, {n:.2} steps of {} per period; expected {STEPS_PER_PERIOD} or more: {}.step of {} or less",
            time(self.step),
            self.table,
            time_below(advice)
        );
        if n < LEAST_STEPS && self.is_fixed_motion {
            said.problems.push(format!(
                "{numbers}; with fewer than {LEAST_STEPS} no result is right"
            ));
        } else {
            said.warnings.push(numbers);
        }
    }
}

/// Balls that pass a point of a raceway, at the largest speed.
fn judge_passing(scene: &Scene, geometry: &BearingGeometry, steps: &TimeSteps, said: &mut Said) {
    let turning = Kinematics::new(geometry, scene.effects.slip());
    // Equilibria in time are seen from the housing, in which the loads stand.
    let has_inertia = steps.table == "dynamic";
    let passing = |speeds: BothRings| {
        let cage = turning.of_cage(speeds);
        let rates = match has_inertia {
            true => [
                ("inner raceway", speeds[0] - cage),
                ("outer raceway", cage - speeds[1]),
            ],
            false if speeds[1] == 0.0 => [("outer raceway", cage); 2],
            false => [("housing", cage); 2],
        };
        let rates = rates.map(|(what, rate)| (what, scene.bearing.balls as f64 * rate.abs() / TAU));
        if rates[0].1 > rates[1].1 {
            rates[0]
        } else {
            rates[1]
        }
    };
    let Some(speeds) = &scene.speed else { return };
    let largest = speeds.at_largest(|speeds| passing(speeds).1);
    let (what, rate) = passing(largest);
    if rate == 0.0 {
        return;
    }
    let turns = largest.map(|speed: f64| {
        let turns = speed.abs() / TAU;
        format!("{:.1} rpm ({:.3} turns a step)", 60.0 * turns, turns * steps.step)
    });
    let turns = match largest {
        [_, 0.0] => turns[0].clone(),
        _ => format!("{} inside and {} outside", turns[0], turns[1]),
    };
    let what = format!("at {turns} balls pass a point of the {what} {rate:.1} times per second");
    steps.judge_rate(&what, rate, said);
}

/// Rows of the tables, from which a life is counted, at the largest speed of the cage.
fn judge_rows(scene: &Scene, geometry: &BearingGeometry, steps: &TimeSteps, said: &mut Said) {
    let (Some(speeds), Some(_)) = (&scene.speed, &scene.life) else {
        return;
    };
    // Steps with fields have rows besides.
    let every = scene.output.tables_every.min(steps.output_every);
    let turning = Kinematics::new(geometry, scene.effects.slip());
    let cage = |speeds: BothRings| turning.of_cage(speeds).abs();
    let rate = scene.bearing.balls as f64 * cage(speeds.at_largest(cage)) / TAU;
    let pitches = rate * steps.step * every as f64;
    if every > 1 && pitches > WIDE_ROWS {
        let enough = every as f64 * CLOSE_ROWS / pitches;
        said.warnings.push(format!(
            "[life]: rows of balls.csv lie {pitches:.2} ball pitches apart; where forces differ round the bearing, \
             expected {CLOSE_ROWS} or less: output.tables_every of {} or less",
            enough.floor().max(1.0)
        ));
    }
}

/// The keys of a scene that have a schedule, and it.
fn schedules(scene: &Scene) -> Vec<(String, Schedule)> {
    let loads = scene.effects.schedules().into_iter();
    let loads = loads.map(|(name, schedule)| (format!("effects.{name}"), schedule));
    let dofs = ["x", "y", "z", "tilt_x", "tilt_y"].map(|dof| format!("shaft.{dof}"));
    loads
        .chain(dofs.into_iter().zip(scene.shaft.schedules.clone()))
        .collect()
}

fn judge_schedule(key: &str, schedule: &Schedule, steps: &TimeSteps, said: &mut Said) {
    let mut warn = |text: String| said.warnings.push(format!("{key}.schedule: {text}"));
    let end = steps.duration;
    match schedule {
        Schedule::Constant => {}
        Schedule::Harmonic {
            frequency, amplitude, ..
        } => {
            if *amplitude != 0.0 && *frequency != 0.0 {
                let what = format!("{key}.schedule: a harmonic of {frequency} Hz");
                steps.judge_rate(&what, frequency.abs(), said);
            }
        }
        Schedule::Impact { start, duration } => warn_of_impact((*start, *duration), steps, &mut warn),
        Schedule::Ramp {
            from,
            to,
            start,
            duration,
        } => {
            if *start >= end && from != to {
                warn(format!(
                    "the ramp begins at {}, the run ends at {}",
                    time(*start),
                    time(end)
                ));
            } else if *duration < steps.step && from != to {
                warn(format!(
                    "a ramp of {} is shorter than a step of {}: it is a jump",
                    time(*duration),
                    time(steps.step)
                ));
            }
        }
        Schedule::Step { at, before, after } => {
            if *at >= end && before != after {
                warn(format!(
                    "the step is at {}, the run ends at {}",
                    time(*at),
                    time(end)
                ));
            }
        }
        Schedule::Table { times, .. } => warn_of_table(times, steps, &mut warn),
    }
}

/// An impact that the run does not reach, or that is too short for its steps.
fn warn_of_impact((start, duration): (f64, f64), steps: &TimeSteps, warn: &mut impl FnMut(String)) {
    if start >= steps.duration {
        warn(format!(
            "the impact begins at {}, the run ends at {}",
            time(start),
            time(steps.duration)
        ));
    } else if duration < STEPS_PER_PULSE * steps.step {
        warn(format!(
            "an impact of {} is {:.2} steps of {}; expected {STEPS_PER_PULSE} or more: {}.step of {} or \
             less; {}",
            time(duration),
            duration / steps.step,
            time(steps.step),
            steps.table,
            time_below(duration / STEPS_PER_PULSE),
            match steps.table {
                "dynamic" => "its impulse is whole, its shape is not there",
                _ => "its peak may lie between two instants",
            }
        ));
    }
}

/// A speed that changes within a step.
fn judge_speed(scene: &Scene, steps: &TimeSteps, said: &mut Said) {
    if let Some(speed) = &scene.speed {
        for side in Side::BOTH {
            let mut warn = |text: String| said.warnings.push(format!("speed.{}: {text}", side.name()));
            warn_of_table(&speed.of(side).times, steps, &mut warn);
        }
    }
}

/// Profiles of a body, and how fast contacts run over them.
struct WornTrack<'s> {
    /// Such as "a ball passes".
    passes: &'static str,
    /// Such as "the outer ring".
    body: String,
    profiles: &'s Profiles,
    /// Of the track, m.
    radius: f64,
    /// Of the contact on the body at the largest speed, rad/s.
    rate: f64,
    /// Half-width of the ellipses along the track, m; 0: unknown.
    half_width: f64,
}

/// All bodies at the largest speed of contacts over them; none where nothing turns.
fn worn_tracks<'s>(
    scene: &'s Scene,
    geometry: &BearingGeometry,
    half_widths: BothRings,
) -> Vec<WornTrack<'s>> {
    let Some(speeds) = &scene.speed else {
        return Vec::new();
    };
    let turning = Kinematics::new(geometry, scene.effects.slip());
    let largest = |rate: &dyn Fn(BothRings) -> f64| rate(speeds.at_largest(rate));
    let ring = |side: Side| WornTrack {
        passes: "a ball passes",
        body: format!("the {} ring", side.name()),
        profiles: &scene.profiles.raceways[side.index()],
        radius: geometry.centre_radius(side) + side.sign() * geometry.groove_radius(side),
        rate: largest(&|speeds| (turning.of_cage(speeds) - speeds[side.index()]).abs()),
        half_width: half_widths[side.index()],
    };
    let ball = |(ball, profiles)| WornTrack {
        passes: "a raceway passes",
        body: format!("ball {ball}"),
        profiles,
        radius: 0.5 * geometry.ball_diameter,
        rate: largest(&|speeds| turning.rolled(speeds).abs()),
        half_width: half_widths[0].min(half_widths[1]),
    };
    let rings = Side::BOTH.into_iter().map(ring);
    rings.chain(scene.profiles.balls.iter().map(ball)).collect()
}

impl WornTrack<'_> {
    /// Judges the shortest spall or dent and the shortest wave.
    fn judge(&self, steps: &TimeSteps, said: &mut Said) {
        let profiles = self.profiles;
        let spalls = profiles.spalls.iter().zip(1..);
        let spalls = spalls.map(|(spall, number)| (spall.length, format!("spall {number}")));
        let dents = profiles.dents.iter().zip(1..);
        let dents = dents.map(|(dent, number)| (2.0 * dent.reach(), format!("dent {number}")));
        let waves = profiles.waves.iter().map(|wave| wave.order).max();
        let waves = waves.map(|order| {
            let length = TAU * self.radius / order as f64;
            (length, format!("a wave of order {order}"))
        });
        let shortest = spalls.chain(dents).min_by(|a, b| a.0.total_cmp(&b.0));
        for (length, what) in shortest.into_iter().chain(waves) {
            let needed = length / (self.radius * self.rate * STEPS_PER_PERIOD);
            if steps.step > needed {
                said.warnings.push(format!(
                    "{} {what} of {} in {}, {:.2} steps of {}; expected {STEPS_PER_PERIOD} or more: {}.step of {} or \
                     less",
                    self.passes,
                    self.body,
                    time_about(STEPS_PER_PERIOD * needed),
                    STEPS_PER_PERIOD * needed / steps.step,
                    time(steps.step),
                    steps.table,
                    time_below(needed)
                ));
            }
        }
    }
}

impl WornTrack<'_> {
    /// Judges the edges of spalls that are sharp for the ellipses: a fifth of the time in which a contact passes its
    /// own half-width shows them.
    fn judge_edges(&self, steps: &TimeSteps, said: &mut Said) {
        let is_sharp = |spall: &Spall| spall.edge < 2.0 * self.half_width;
        let needed = self.half_width / (STEPS_PER_EDGE * self.radius * self.rate);
        let sharp = self.profiles.spalls.iter().position(is_sharp);
        if let Some(spall) = sharp.filter(|_| steps.step > needed) {
            said.warnings.push(format!(
                "{} the edge of spall {} of {} within {}, in which the ellipse moves by its half-width of {:.3} mm; a \
                 step of {} smears it: {}.step of {} or less keeps it",
                self.passes,
                spall + 1,
                self.body,
                time_about(STEPS_PER_EDGE * needed),
                1e3 * self.half_width,
                time(steps.step),
                steps.table,
                time_below(needed)
            ));
        }
    }
}

/// Points of a table that lie within a step of the run.
fn warn_of_table(times: &[f64], steps: &TimeSteps, warn: &mut dyn FnMut(String)) {
    let within = times
        .windows(2)
        .filter(|pair| pair[1] > 0.0 && pair[0] < steps.duration);
    let smallest = within.map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    // Times on the grid of the steps differ from it by round-off.
    if smallest < (1.0 - 1e-9) * steps.step {
        warn(format!(
            "its points are {} apart, less than a step of {}: what happens between is not seen",
            time(smallest),
            time(steps.step)
        ));
    }
}

/// Two digits of a time, not more than it.
pub fn time_below(seconds: f64) -> String {
    let unit = 10f64.powi(seconds.log10().floor() as i32 - 1);
    time((seconds / unit * (1.0 + 1e-9)).floor() * unit)
}

/// A time that was computed, with as many digits as a reader needs: five.
fn time_about(seconds: f64) -> String {
    let unit = 10f64.powi(seconds.log10().floor() as i32 - 4);
    time((seconds / unit).round() * unit)
}

fn time(seconds: f64) -> String {
    Quantity::<TIME>::about(seconds).to_string()
}
