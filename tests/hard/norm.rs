//! The norm in which a dissipating integrator loses energy, of a bearing with rigid rings.
//!
//! `ring::integrator` derives it: E + dt^2 M [(x - e^2) a^2 / 2 + e v c / dt + e^2 c a + x e c^2 / (2 d)], with c the
//! part of the acceleration that the forces at the instant do not explain. For linear bodies it falls at every step;
//! contacts add the difference between the mean of the forces at both ends of a step and the discrete gradient.

use contact::{Meridian, Side};
use dynamics::Model;
use dynamics::effects::Now;
use dynamics::interactions::raceway_contact::Site;
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState};

use super::bearings::equilibrium_at;
use super::course::{Course, march_with};

/// A motion, and what its integrator gave back in its own norm at most after it had taken it, J; from the time
/// `quiet`, s, on, when loads rest: the norm does not know what a changing load is.
pub fn watched(model: &Model, settings: MotionSettings, duration: f64, quiet: f64) -> (Course, f64) {
    let start = equilibrium_at(model, 0.0).unwrap();
    let n = (duration / settings.dt).round() as usize;
    let (integrator, dt) = (settings.integrator, settings.dt);
    let motion = Motion::new(model, settings).unwrap();
    let state = motion.with_accelerations(motion.start(&start)).unwrap();
    let stored = |state: &MotionState| memory(model, &motion, integrator, dt, state);
    let first = stored(&state);
    let (mut most, mut back) = (f64::NEG_INFINITY, 0.0f64);
    let course = march_with(&motion, state, n, |state| {
        if motion.time(state.step) < quiet {
            return;
        }
        let loss = state.ledger.numerical_loss - (stored(state) - first);
        most = most.max(loss);
        back = back.max(most - loss);
    });
    (course, back)
}

/// What the norm holds besides the energy, J: of balls and shaft.
fn memory(model: &Model, motion: &Motion<'_>, scheme: Integrator, dt: f64, state: &MotionState) -> f64 {
    let (d, e) = (scheme.alpha_f - scheme.alpha_m, 0.5 - scheme.alpha_f);
    if scheme.old == [0.0; 2] || d == 0.0 {
        // Without memory: the energy itself.
        return 0.0;
    }
    let x = (e + 0.5 * d) * (e + 0.5 * d);
    let of = |mass: f64, v: f64, a: f64, force: f64| {
        if mass == 0.0 {
            return 0.0;
        }
        let c = a - force / mass;
        let sum = 0.5 * (x - e * e) * a * a + e * v * c / dt + e * e * c * a + 0.5 * x * e / d * c * c;
        mass * dt * dt * sum
    };
    let (balls, shaft) = forces(model, motion, state);
    let mass = model.ball_mass();
    let of_ball = |b: usize, i: usize| {
        of(
            mass,
            state.ball_velocities[b].to_array()[i],
            state.ball_accelerations[b].to_array()[i],
            balls[b].to_array()[i],
        )
    };
    let of_balls: f64 = (0..balls.len()).map(|b| of_ball(b, 0) + of_ball(b, 1)).sum();
    let free = (0..3).filter(|i| model.prescribed(*i, 0.0).is_none());
    let of_shaft = free.map(|i| {
        of(
            model.shaft_mass,
            state.shaft_velocity[i],
            state.shaft_acceleration[i],
            shaft[i],
        )
    });
    of_balls + of_shaft.sum::<f64>()
}

/// Forces on balls [radial, axial] and on the shaft at the instant of a state, N.
fn forces(model: &Model, motion: &Motion<'_>, state: &MotionState) -> (Vec<Meridian>, [f64; 5]) {
    let time = motion.time(state.step);
    let now = Now {
        time,
        ..Now::default()
    };
    let loads = model.loads(&now).unwrap();
    let (mut balls, mut shaft) = (loads.balls.clone(), loads.shaft);
    for index in 0..state.approaches.len() {
        let (ball, side) = (index / 2, Side::BOTH[index % 2]);
        let site = Site::new(
            model,
            &model.mounting,
            ball,
            side,
            motion.ball_azimuth(ball, time),
        );
        let size =
            side.sign() * model.hertz[side.index()].stiffness * state.approaches[index].max(0.0).powf(1.5);
        let (sin, cos) = state.angles[index].sin_cos();
        // On the ring along l; the ball gets the negative.
        let force = Meridian::new(size * cos, size * sin);
        balls[ball] = balls[ball] - force;
        if side == Side::Inner {
            for (sum, row) in shaft.iter_mut().zip(site.carrier_rows()) {
                *sum += row.dot(force);
            }
        }
    }
    (balls, shaft)
}
