//! Free balls: friction and speeds that may break a step.

use contact::SphereCompliance;
use dynamics::effects::BallCentrifugal;
use dynamics::effects::traction::FreeBalls;
use dynamics::interactions::cage::Cage;
use dynamics::interactions::traction::law::{Curve as Law, CurvePoints};
use dynamics::interactions::traction::{Creep, PatchPoints, Traction, TractionLaw};
use dynamics::kinematics::{BallSpeeds, RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState};

use super::bearings::{Load, RPM, equilibrium_at, flexible, halvings, rigid};
use super::course::{Course, march_with};
use super::free_cage::{self, cage};
use super::plot::{Curve, Plot};
use super::record::Record;
use super::{HardCase, Pace, surfaces};

/// Ledger defect over the largest energy.
pub const CLOSED: f64 = 1e-9;

pub fn cases() -> Vec<HardCase> {
    super::both(balls(), free_cage::cases())
}

fn balls() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        slow(
            "free_balls_friction_0",
            "nothing turns the balls: their turning must stay to the last digit while the shaft swings",
            "rigid rings, 2 kN, 500 N radial from 0 on, 6000 rpm, dt 10 us, 2 ms",
            frictionless,
        ),
        slow(
            "free_balls_friction_1",
            "friction as large as the normal force: ten times stiffer, and it carries the balls across their grooves",
            "rigid rings, 2 kN, 3000 to 6000 rpm in 1 ms, friction 1, dt 10 us, 3 ms",
            |r| {
                let case = Rolling {
                    friction: 1.0,
                    ..Rolling::run_up(3000.0, 6000.0, 1e-3)
                };
                case.holds(r);
            },
        ),
        slow(
            "free_balls_no_preload",
            "0.5 N on 18 balls: friction is a hundredth of what the turning balls would need",
            "rigid rings, 0.5 N, 1000 to 2000 rpm in 2 ms, dt 10 us, 5 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(0.5),
                    ..Rolling::run_up(1000.0, 2000.0, 2e-3)
                };
                case.holds(r);
            },
        ),
        slow(
            "free_balls_lose_both_contacts",
            "the preload goes in 10 us and a radial load stays: balls fly between the rings and are caught again",
            "rigid rings, 300 N to 1 N, 40 N radial, 3000 rpm, dt 5 us, 10 ms, a cage with 0.2 mm of clearance",
            loses_contacts,
        ),
        slow(
            "free_balls_reversal",
            "slip changes its sign in every contact, and nothing rolls at the turn",
            "rigid rings, 1 kN, 600 to -600 rpm in 2 ms, dt 10 us, 3 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(1000.0),
                    ..Rolling::run_up(600.0, -600.0, 2e-3)
                };
                case.holds(r);
            },
        ),
        slow(
            "free_balls_stop_from_10_000_rpm",
            "the ring stands after 1 ms, the balls turn on: gross slip everywhere, then none",
            "rigid rings, 1 kN, 10 000 rpm to a stand in 1 ms, dt 10 us, 5 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(1000.0),
                    ..Rolling::run_up(10_000.0, 0.0, 1e-3)
                };
                case.with(5e-3).holds(r);
            },
        ),
        slow(
            "free_balls_40_000_rpm",
            "the inner contacts carry a fraction of the outer ones, and less than the gyroscopic moment asks for",
            "rigid rings, 500 N, 40 000 rpm, dt 5 us, 3 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(500.0),
                    dt: 5e-6,
                    ..Rolling::run_up(40_000.0, 40_000.0, 1e-3)
                };
                case.holds(r);
            },
        ),
        slow(
            "free_balls_falling_branch",
            "traction that falls with slip has two solutions, and its tangent pushes the wrong way",
            "rigid rings, 200 N, 2000 to 8000 rpm in 2 ms, curve 0.09 at 0.02 m/s, 0.02 beyond, dt 10 us, 3 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(200.0),
                    is_falling: true,
                    ..Rolling::run_up(2000.0, 8000.0, 2e-3)
                };
                case.holds(r);
            },
        ),
        slow(
            "free_balls_steps_1_to_20_us",
            "friction is 10 to 1000 times stiffer than the step resolves",
            "rigid rings, 500 N, 200 N radial, 3000 to 6000 rpm in 1 ms, dt 1, 5, 10, 20 us, 2 ms",
            steps,
        ),
        slow(
            "free_balls_flexible",
            "slope forces of both rings, patches that follow balls whose course nobody knows before",
            "both rings flexible, 500 N, 300 N radial, 3000 to 9000 rpm in 1 ms, dt 10 us, 2 ms",
            |r| {
                let case = Rolling {
                    axial: Load::dead(500.0),
                    radial: Load::dead(300.0),
                    is_flexible: true,
                    ..Rolling::run_up(3000.0, 9000.0, 1e-3)
                };
                case.with(2e-3).holds(r);
            },
        ),
    ]
}

/// A bearing whose balls are free.
pub struct Rolling {
    pub axial: Load,
    pub radial: Load,
    pub speeds: RingSpeeds,
    pub friction: f64,
    /// Whether traction falls with slip instead.
    pub is_falling: bool,
    pub cage: Option<Cage>,
    pub is_flexible: bool,
    /// Surfaces of rings and balls; None: they are smooth.
    pub surfaces: Option<surfaces::Rolling>,
    /// Turning of ball 0 at the start in space, rad/s, where it does not roll.
    pub spin: Option<[f64; 3]>,
    pub dt: f64,
    pub duration: f64,
}

impl Rolling {
    /// 2 kN of thrust, friction 0.07, no cage; the inner ring changes its speed, rpm, over a time, s.
    pub fn run_up(from: f64, to: f64, over: f64) -> Rolling {
        Rolling {
            axial: Load::dead(2000.0),
            radial: Load::dead(0.0),
            speeds: Speed::table(vec![0.0, over], vec![from * RPM, to * RPM]).into(),
            friction: 0.07,
            is_falling: false,
            cage: None,
            is_flexible: false,
            surfaces: None,
            spin: None,
            dt: 1e-5,
            duration: 3e-3,
        }
    }

    pub fn with(self, duration: f64) -> Rolling {
        Rolling { duration, ..self }
    }

    fn traction(&self) -> Traction {
        let falling = CurvePoints {
            at_rest: 0.0,
            most: 0.09,
            slip_of_most: 0.02,
            at_large: 0.02,
        };
        Traction {
            law: match self.is_falling {
                true => TractionLaw::Curve(Law::new(falling)),
                false => TractionLaw::Coulomb(self.friction),
            },
            creep: Creep::Elastic,
            places: PatchPoints::new([3, 15]),
        }
    }

    /// Runs it; `look` sees every state. The balls roll as in the equilibrium at the start.
    pub fn course(&self, mut look: impl FnMut(&MotionState)) -> (Course, Curve) {
        let build = if self.is_flexible { flexible } else { rigid };
        let mut model = build(self.axial.clone(), self.radial.clone());
        model.sphere = SphereCompliance::default();
        model.effects.push(Box::new(FreeBalls {
            traction: self.traction(),
            at_start: BallCentrifugal {
                speeds: self.speeds.clone(),
                slip: [0.0; 2],
                ball_speeds: BallSpeeds::OuterControl,
            },
        }));
        model.cage.clone_from(&self.cage);
        if let Some(surfaces) = &self.surfaces {
            surfaces.put_on(&mut model);
        }
        let settings = MotionSettings {
            ladder: halvings(6),
            ..MotionSettings::conserving(self.dt, self.speeds.clone())
        };
        let start = equilibrium_at(&model, 0.0).unwrap();
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.with_accelerations(motion.start(&start)).unwrap();
        if let (Some(spin), Some(free)) = (self.spin, &mut state.free) {
            free.turnings[0] = spin;
            state = motion.with_energies(state);
        }
        let n = (self.duration / self.dt).round() as usize;
        let mut points = Vec::new();
        let course = march_with(&motion, state, n, |state| {
            if state.step % (n as u64 / 200).max(1) == 0 {
                points.push([1e3 * motion.time(state.step), mean_orbit(state) / RPM]);
            }
            look(state);
        });
        let name = "mean speed of the balls round the axis".to_string();
        (course, Curve { name, points })
    }

    /// It must end with a closed ledger, and no loss may fall.
    pub fn holds(&self, record: &mut Record) {
        self.seen(record, |_| ());
    }

    /// The same on real surfaces, whose work is that of balls and drives but for this share of the largest energy.
    pub fn rolled(&self, record: &mut Record, share: f64, mut look: impl FnMut(&MotionState)) -> Course {
        let (mut work, mut largest) = (0.0f64, 0.0f64);
        let course = self.seen(record, |state| {
            work = work.max(state.ledger.profile_work.abs());
            largest = largest.max(state.ledger.largest);
            look(state);
        });
        record.below(
            "work of surfaces that nobody has, of the largest energy",
            work / largest,
            share,
        );
        course
    }

    fn seen(&self, record: &mut Record, mut look: impl FnMut(&MotionState)) -> Course {
        let (mut last, mut falls) = ([0.0; 5], 0);
        let (course, orbit) = self.course(|state| {
            let now = losses(state);
            falls += now.iter().zip(last).filter(|(a, b)| **a < *b).count();
            last = now;
            look(state);
        });
        record.closed(&course);
        record.below("ledger defect with friction", course.defect, CLOSED);
        record.that("no loss ever falls", falls == 0);
        let [friction, drag, impacts, rubbing, land] = last;
        record.note(format!(
            "lost {:.3e} J to traction, {:.1e} J to impacts, {:.1e} J to the friction of the cage, {:.1e} J to drag; \
             {} parts done again",
            friction,
            impacts,
            rubbing,
            drag + land,
            course.retries
        ));
        record.plot = Some(Plot {
            x: "time, ms",
            y: "speed, rpm",
            curves: vec![orbit],
        });
        course
    }
}

/// Losses so far, J: traction, drag of balls; impacts, friction and drag of the cage.
fn losses(state: &MotionState) -> [f64; 5] {
    let friction = state.ledger.friction.unwrap_or_default();
    let cage = state.ledger.cage.unwrap_or_default();
    [
        friction.loss,
        friction.drag_loss,
        cage.impact_loss,
        cage.friction_loss,
        cage.drag_loss,
    ]
}

fn mean_orbit(state: &MotionState) -> f64 {
    let free = state.free.as_ref().unwrap();
    let n = free.places.len();
    (0..n).map(|ball| free.orbit(ball)).sum::<f64>() / n as f64
}

fn frictionless(record: &mut Record) {
    let case = Rolling {
        friction: 0.0,
        radial: Load::jump(0.0, 500.0),
        ..Rolling::run_up(6000.0, 6000.0, 1e-3)
    };
    let mut first = None;
    let mut change = 0.0f64;
    case.with(2e-3).seen(record, |state| {
        let turnings = &state.free.as_ref().unwrap().turnings;
        let first = first.get_or_insert_with(|| turnings.clone());
        let size = first[0].iter().map(|w| w * w).sum::<f64>().sqrt();
        for (now, then) in turnings.as_flattened().iter().zip(first.as_flattened()) {
            change = change.max((now - then).abs() / size);
        }
    });
    record.below("change of a ball's turning", change, 1e-12);
}

fn loses_contacts(record: &mut Record) {
    let case = Rolling {
        axial: Load::jump(300.0, 1.0),
        radial: Load::dead(40.0),
        cage: Some(cage(0.2e-3)),
        dt: 5e-6,
        ..Rolling::run_up(3000.0, 3000.0, 1e-3)
    };
    let (mut in_air, mut caught) = (vec![false; 18], 0);
    let course = case.with(10e-3).seen(record, |state| {
        for (ball, flew) in in_air.iter_mut().enumerate() {
            let flies = (0..2).all(|side| state.forces[2 * ball + side].norm() == 0.0);
            caught += usize::from(*flew && !flies);
            *flew = flies;
        }
    });
    record.that("balls lose both contacts and find them again", caught > 0);
    record.note(format!("{caught} catches, at most {} open contacts", course.open));
}

fn steps(record: &mut Record) {
    let mut curves = Vec::new();
    let mut ends = Vec::new();
    for dt in [1e-6, 5e-6, 1e-5, 2e-5] {
        let case = Rolling {
            axial: Load::dead(500.0),
            radial: Load::dead(200.0),
            dt,
            ..Rolling::run_up(3000.0, 6000.0, 1e-3)
        };
        let course = case.with(2e-3).seen(record, |_| ());
        ends.push(mean_orbit(&course.last));
        let mut curve = record.plot.take().map(|plot| plot.curves).unwrap_or_default();
        curve
            .iter_mut()
            .for_each(|c| c.name = format!("dt {:.0} us", 1e6 * dt));
        curves.extend(curve);
    }
    for (end, dt) in ends[1..].iter().zip([5, 10, 20]) {
        record.near(
            &format!("speed of the balls with {dt} us, rad/s,"),
            *end,
            ends[0],
            1e-3,
        );
    }
    record.plot = Some(Plot {
        x: "time, ms",
        y: "speed, rpm",
        curves,
    });
}
