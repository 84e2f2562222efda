//! One ball on Hertz springs against closed forms: impact, rattling, and the order of every integrator.
//!
//! The ball is one of two in a 7010C with rigid rings, run by `Motion` as any bearing. The inner ring is held where
//! both groove centres lie in one plane, so that a ball that moves radially meets both raceways head on: outer at r +
//! 0, inner after the radial clearance.

use contact::Side;
use dynamics::effects::{Effect, Loads, Now};
use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{DynamicsError, Model, ShaftDof};

use super::bearings::conserving;
use super::course::{march, march_with};
use super::record::Record;
use super::support::Case;
use super::{HardCase, Pace};

/// Duration of a Hertz impact over (largest approach / speed) (Johnson 1985, eq. 11.24).
const HERTZ_DURATION: f64 = 2.943_275;

pub fn cases() -> Vec<HardCase> {
    let stiff = "ball between both raceways, pressed by an imposed axial shift, set free 0.2 um beside its place; \
                 errors after 4 periods at 200 and 400 steps a period against a Runge-Kutta solution of the same \
                 equation";
    vec![
        HardCase {
            name: "hertz_impact",
            pace: Pace::Fast,
            why: "stiffness grows from zero at touch; impact lasts 40 us",
            settings: "ball at 0.1 m/s against the outer raceway; dt = duration / 200; average acceleration, discrete \
                       gradient",
            run: hertz_impact,
        },
        HardCase {
            name: "hertz_impact_coarse",
            pace: Pace::Fast,
            why: "the whole impact is shorter than a step",
            settings: "the same at dt = 0.3, 1, 3 and 10 durations",
            run: hertz_impact_coarse,
        },
        HardCase {
            name: "bouncing_ball",
            pace: Pace::Fast,
            why: "100 impacts, each an occasion to gain energy",
            settings: "ball under 1000 g on the outer raceway, dropped by 5 um; dt = period / 400",
            run: bouncing_ball,
        },
        HardCase {
            name: "rattling_ball",
            pace: Pace::Fast,
            why: "a ball that flies between both raceways without any force or damping",
            settings: "speed 0.05 m/s, 13.5 um of radial clearance, 20 000 steps of 2 us",
            run: rattling_ball,
        },
        HardCase {
            name: "stiff_oscillator_orders",
            pace: Pace::Fast,
            why: "order can be lost where the force is a mean over the step",
            settings: stiff,
            run: |record| orders(record, 1.0),
        },
        HardCase {
            name: "stiff_oscillator_orders_k_1e4",
            pace: Pace::Fast,
            why: "the same with contacts 10 000 times stiffer: 4 MHz",
            settings: stiff,
            run: |record| orders(record, 1e4),
        },
    ]
}

/// Two balls between rigid rings whose groove centres lie in one plane; contacts `stiffer` times as stiff as Hertz.
fn lonely_balls(stiffer: f64) -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.effects.clear();
    model.geometry.n_balls = 2;
    let back = -model.geometry.axial_offset();
    model.shaft = [0.0, 0.0, back, 0.0, 0.0].map(ShaftDof::Prescribed);
    model.hertz = model.hertz.map(|h| h.with_stiffness(stiffer * h.stiffness));
    model
}

/// Radial displacement of a ball at which it just touches a raceway head on, and its axial one.
fn touching(model: &Model, side: Side) -> [f64; 2] {
    let g = &model.geometry;
    let x = g.ball_centre();
    [
        g.centre_radius(side) + side.sign() * g.touching_distance(side) - x.radial,
        -x.axial,
    ]
}

/// Both balls at a radial displacement, moving outwards with `speed`.
fn thrown(motion: &Motion<'_>, at: [f64; 2], speed: f64) -> MotionState {
    let mut state = motion.rest([0.0; 5], [0.0; 5]);
    state.balls = vec![at.into(); 2];
    state.ball_velocities = vec![[speed, 0.0].into(); 2];
    // Nothing is pressed.
    state.ledger.hertz = 0.0;
    motion.with_energies(state)
}

/// Largest approach and duration of an impact at `speed` on one raceway (Johnson 1985, eqs. 11.23 and 11.24).
fn impact(model: &Model, side: Side, speed: f64) -> [f64; 2] {
    let k = model.hertz[side.index()].stiffness;
    let deepest = (1.25 * model.ball_mass() * speed * speed / k).powf(0.4);
    [deepest, HERTZ_DURATION * deepest / speed]
}

fn hertz_impact(record: &mut Record) {
    let (model, speed) = (lonely_balls(1.0), 0.1);
    let [deepest, duration] = impact(&model, Side::Outer, speed);
    let dt = duration / 200.0;
    let motion = Motion::new(&model, conserving(dt)).unwrap();
    let mut approach = 0.0f64;
    let mut contact = 0.0;
    let course = march_with(
        &motion,
        thrown(&motion, touching(&model, Side::Outer), speed),
        260,
        |s| {
            approach = approach.max(s.approaches[1]);
            if s.forces[1].norm() != 0.0 {
                contact += dt;
            }
        },
    );
    record.closed(&course);
    record.near("largest approach", approach, deepest, 2e-4);
    // The first and the last step touch for a part only.
    record.near("duration", contact, duration, 2.0 / 200.0);
    record.near("speed after", course.last.ball_velocities[0].radial, -speed, 1e-9);
    let force = model.hertz[1].stiffness * deepest.powf(1.5);
    record.near("largest mean force of a step", course.peak, force, 1e-3);
    record.plot = Some(super::plot::Plot {
        x: "time, ms",
        y: "force, N",
        curves: vec![course.curve("force", 2)],
    });
}

fn hertz_impact_coarse(record: &mut Record) {
    let (model, speed) = (lonely_balls(1.0), 0.1);
    let [_, duration] = impact(&model, Side::Outer, speed);
    for share in [0.3, 1.0, 3.0, 10.0] {
        let motion = Motion::new(&model, conserving(share * duration)).unwrap();
        let mut at = touching(&model, Side::Outer);
        at[0] -= 1e-6;
        let mut fastest = 0.0f64;
        let course = march_with(&motion, thrown(&motion, at, speed), 1000, |s| {
            fastest = fastest.max(s.ball_velocities[0].radial.abs());
        });
        record.closed(&course);
        record.below(
            &format!("speed at any time over the first, dt = {share} durations,"),
            fastest / speed,
            1.0 + 1e-9,
        );
        let far = course.last.balls[0].radial.abs();
        record.below("distance from the middle over the clearance", far / 13.5e-6, 20.0);
    }
}

/// A constant radial force on every ball, N.
struct BallForce(f64);

impl Effect for BallForce {
    fn name(&self) -> &'static str {
        "ball_force"
    }

    fn add_loads(&self, _: &Model, _: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.balls.iter_mut().for_each(|f| f.radial += self.0);
        Ok(())
    }
}

fn bouncing_ball(record: &mut Record) {
    let mut model = lonely_balls(1.0);
    let (g, height) = (9.81e3, 5e-6);
    model.effects.push(Box::new(BallForce(model.ball_mass() * g)));
    let speed = (2.0 * g * height).sqrt();
    // Time between impacts: flight and the impact itself under its own weight, by quadrature of the energy.
    let contact = contact_time(&model, speed, g);
    let period = 2.0 * speed / g + contact;
    let dt = period / 400.0;
    let motion = Motion::new(&model, conserving(dt)).unwrap();
    let mut at = touching(&model, Side::Outer);
    at[0] -= height;
    let mut impacts = Vec::new();
    let mut before = 0.0;
    let n = 100 * 400;
    let course = march_with(&motion, thrown(&motion, at, 0.0), n, |s| {
        let v = s.ball_velocities[0].radial;
        if before > 0.0 && v <= 0.0 {
            // The turning point inside the impact, between two steps.
            impacts.push(motion.time(s.step) - dt * v / (v - before));
        }
        before = v;
    });
    record.closed(&course);
    record.that("99 impacts or more", impacts.len() >= 99);
    let measured = (impacts[impacts.len() - 1] - impacts[0]) / (impacts.len() - 1) as f64;
    record.near("period", measured, period, 3e-4);
    let highest = course.last.ledger.total() - course.last.ledger.load_work;
    record.below(
        "energy that is missing after 100 impacts",
        (highest / course.last.ledger.largest).abs(),
        1e-9,
    );
}

/// Time from touch to parting under a constant force that presses: twice the integral of dx / v(x), with x = X sin^2.
fn contact_time(model: &Model, speed: f64, g: f64) -> f64 {
    let (k, m) = (model.hertz[1].stiffness, model.ball_mass());
    let square = |x: f64| speed * speed + 2.0 * g * x - 0.8 * k / m * x.powf(2.5);
    let (mut low, mut high) = (0.0, 2.0 * impact(model, Side::Outer, speed)[0]);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if square(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    let n = 20_000;
    let h = 0.5 * std::f64::consts::PI / n as f64;
    let slice = |i: usize| {
        let (sin, cos) = (h * (i as f64 + 0.5)).sin_cos();
        2.0 * low * sin * cos / square(low * sin * sin).max(1e-300).sqrt() * h
    };
    2.0 * (0..n).map(slice).sum::<f64>()
}

fn rattling_ball(record: &mut Record) {
    let (model, speed) = (lonely_balls(1.0), 0.05);
    let [a, b] = Side::BOTH.map(|side| touching(&model, side));
    let gap = b[0] - a[0];
    let durations: f64 = Side::BOTH
        .iter()
        .map(|&side| impact(&model, side, speed)[1])
        .sum();
    let period = 2.0 * gap / speed + durations;
    let motion = Motion::new(&model, conserving(2e-6)).unwrap();
    let mut turns = Vec::new();
    let mut before = speed;
    let middle = [0.5 * (a[0] + b[0]), a[1]];
    let course = march_with(&motion, thrown(&motion, middle, speed), 20_000, |s| {
        let v = s.ball_velocities[0].radial;
        if before > 0.0 && v <= 0.0 {
            turns.push(motion.time(s.step));
        }
        before = v;
    });
    record.closed(&course);
    let measured = (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64;
    record.note(format!("{} impacts on each raceway", turns.len()));
    record.near("period of a round", measured, period, 5e-3);
    let energy = course.last.ledger.total() / course.last.ledger.initial;
    record.near("energy at the end over the first", energy, 1.0, 1e-9);
}

/// Radial acceleration of a ball between both raceways in the meridian plane, written anew.
struct Squeezed {
    mass: f64,
    stiffness: [f64; 2],
    /// Groove centres from the ball's reference position, and distance of touching.
    grooves: [[f64; 3]; 2],
}

impl Squeezed {
    fn acceleration(&self, x: [f64; 2]) -> [f64; 2] {
        let mut a = [0.0; 2];
        for side in 0..2 {
            let [r, z, touching] = self.grooves[side];
            let l = [x[0] - r, x[1] - z];
            let length = l[0].hypot(l[1]);
            let force = self.stiffness[side] * (length - touching).max(0.0).powf(1.5);
            (0..2).for_each(|i| a[i] -= force * l[i] / length / self.mass);
        }
        a
    }

    /// The classical Runge-Kutta scheme from rest, `n` steps to time `t`.
    fn solve(&self, start: [f64; 2], t: f64, n: usize) -> [f64; 2] {
        let h = t / n as f64;
        let (mut x, mut v) = (start, [0.0; 2]);
        let add = |a: [f64; 2], s: f64, b: [f64; 2]| [a[0] + s * b[0], a[1] + s * b[1]];
        for _ in 0..n {
            let a1 = self.acceleration(x);
            let (v2, x2) = (add(v, 0.5 * h, a1), add(x, 0.5 * h, v));
            let a2 = self.acceleration(x2);
            let (v3, x3) = (add(v, 0.5 * h, a2), add(x, 0.5 * h, v2));
            let a3 = self.acceleration(x3);
            let (v4, x4) = (add(v, h, a3), add(x, h, v3));
            let a4 = self.acceleration(x4);
            for i in 0..2 {
                x[i] += h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
                v[i] += h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
            }
        }
        x
    }
}

/// Every setting has its order on the oscillation of a ball whose contacts are `stiffer` times as stiff as Hertz.
fn orders(record: &mut Record, stiffer: f64) {
    let mut model = lonely_balls(stiffer);
    let squeeze = 20e-6;
    model.shaft = [0.0, 0.0, squeeze, 0.0, 0.0].map(ShaftDof::Prescribed);
    let g = &model.geometry;
    let at = g.ball_centre();
    let groove = |side: Side| {
        let c = g.groove_centre(side);
        let shift = if side == Side::Inner { squeeze } else { 0.0 };
        [
            c.radial - at.radial,
            c.axial + shift - at.axial,
            g.touching_distance(side),
        ]
    };
    let equation = Squeezed {
        mass: model.ball_mass(),
        stiffness: Side::BOTH.map(|s| model.hertz[s.index()].stiffness),
        grooves: Side::BOTH.map(groove),
    };
    let rest = super::bearings::equilibrium_at(&model, 0.0).unwrap();
    let normal = rest.balls[0].outer.contact_angle_rad;
    let place = rest.displacements.balls[0];
    let start = [
        place.radial + 0.2e-6 * normal.cos(),
        place.axial + 0.2e-6 * normal.sin(),
    ];
    let stiffness = 3.0 * model.hertz[1].stiffness * rest.balls[0].outer.approach_m.sqrt();
    let period = std::f64::consts::TAU * (equation.mass / stiffness).sqrt();
    let t = 4.0 * period;
    let exact = equation.solve(start, t, 20_000);
    let gradient = ContactScheme::DiscreteGradient;
    let settings = [
        (
            "average_acceleration",
            Integrator::average_acceleration(),
            gradient,
            2.0,
        ),
        ("chung_hulbert 0.8", Integrator::chung_hulbert(0.8), gradient, 2.0),
        ("chung_hulbert 0", Integrator::chung_hulbert(0.0), gradient, 2.0),
        ("hht 0.1", Integrator::hht(0.1), gradient, 2.0),
        ("newmark 0.25 0.5", Integrator::newmark(0.25, 0.5), gradient, 2.0),
        (
            "newmark 0.3025 0.6",
            Integrator::newmark(0.3025, 0.6),
            gradient,
            1.0,
        ),
        (
            "average_acceleration, pointwise",
            Integrator::average_acceleration(),
            ContactScheme::Pointwise,
            2.0,
        ),
    ];
    for (name, integrator, scheme, order) in settings {
        let error = |n: usize| {
            let settings = MotionSettings {
                integrator,
                scheme,
                ..conserving(t / n as f64)
            };
            let motion = Motion::new(&model, settings).unwrap();
            let mut state = motion.rest([0.0; 5], [0.0; 5]);
            state.balls = vec![start.into(); 2];
            state.angles = rest
                .balls
                .iter()
                .flat_map(|b| [b.inner, b.outer].map(|c| c.contact_angle_rad))
                .collect();
            // The accelerations of the start, exactly.
            state.ball_accelerations = vec![equation.acceleration(start).into(); 2];
            let mut state = motion.with_energies(state);
            let mut cache = StepCache::default();
            for _ in 0..n {
                state = motion.step(&state, &mut cache).unwrap().0;
            }
            let x = state.balls[0];
            (x.radial - exact[0]).hypot(x.axial - exact[1])
        };
        let [coarse, fine] = [800, 1600].map(error);
        let rate = (coarse / fine).log2();
        record.note(format!(
            "{name}: error {:.1e} of the amplitude, order {rate:.2}",
            fine / 0.2e-6
        ));
        record.below(
            &format!("{name}: departure from order {order}"),
            (rate - order).abs(),
            0.15,
        );
    }
    let motion = Motion::new(&model, conserving(t / 40.0)).unwrap();
    let mut state = motion.rest([0.0; 5], [0.0; 5]);
    state.balls = vec![start.into(); 2];
    let course = march(&motion, motion.with_energies(state), 4000);
    record.closed(&course);
}
