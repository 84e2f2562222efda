//! Balls that swing along their grooves, and where that leaves the shaft.
//!
//! A ball pressed with force Q swings across its line of contact like a pendulum: the forces of both contacts turn
//! with it, and their stiffness is Q (1/l_i + 1/l_o), l the distance from a groove centre to the ball centre. A swing s
//! presses the ball by e = s^2/2 (1/l_i + 1/l_o) deeper into both grooves. In the mean its potential energy Q e is its
//! kinetic energy E, so e = E/Q. The ball then carries Q'(D) E/Q = 3/2 E/D more, D the approaches of both contacts
//! together, for Q ~ D^(3/2): the balls push the shaft back against its load as such forces would.
//!
//! Contact damping acts along the normal, which a swing moves only by its square. Swings therefore lose their energy
//! as E^2: it falls as 1/t, not exponentially, and with it what is off the equilibrium.

use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{Model, StaticSolution};

use super::bearings::{equilibrium_at, transient};
use super::course::march_with;
use super::record::Record;

/// Time before the first span, s, and its length.
const BEGIN: f64 = 20e-3;
/// Spans over which means are taken, each as long as the time before it.
const SPANS: usize = 3;
/// Largest share of the departure that swings leave unexplained: loose balls that touch, the shaft's own vibration.
const UNEXPLAINED: f64 = 0.2;

/// With damping the place comes to the static one as swings die: in each span what is off is at most half of that
/// before, it is what swings account for, and the last is below `limit` of the displacement. `held_back` gives the
/// bearing under the loads that it ends with, less an axial and a radial force, N.
pub fn die_out(
    record: &mut Record,
    (model, settings): (&Model, MotionSettings),
    held_back: impl Fn([f64; 2]) -> Model,
    limit: f64,
) {
    let rest = equilibrium_at(&held_back([0.0; 2]), 0.0).unwrap();
    let place = shaft(&rest);
    let mut state = transient(model, settings.clone(), BEGIN).last;
    let motion = Motion::new(model, settings).unwrap();
    let mut shares = Vec::new();
    for span in 0..SPANS {
        let n = state.step as usize;
        let mut energies = vec![0.0; state.balls.len()];
        let course = march_with(&motion, state, n, |state| {
            add_swings(model, &rest, state, &mut energies)
        });
        record.closed(&course);
        energies.iter_mut().for_each(|e| *e /= n as f64);
        let pushed = equilibrium_at(&held_back(pushes(&rest, &energies)), 0.0).unwrap();
        let mean = [course.mean_shaft[0], course.mean_shaft[2]];
        let off = distance(mean, place);
        let unexplained = distance(mean, shaft(&pushed)) / off;
        record.below(
            &format!("departure that swings do not explain, span {span}, share,"),
            unexplained,
            UNEXPLAINED,
        );
        shares.push(off / place[0].hypot(place[1]));
        state = course.last;
    }
    for pair in shares.windows(2) {
        record.below(
            "settled place off the static one over that of the span before",
            pair[1] / pair[0],
            0.5,
        );
    }
    record.below(
        "settled place off the static one, share,",
        shares[SPANS - 1],
        limit,
    );
    record.note(format!(
        "off by {:.2} %, {:.2} % and {:.2} % of the displacement",
        1e2 * shares[0],
        1e2 * shares[1],
        1e2 * shares[2]
    ));
}

/// Displacement along x and z, m.
fn shaft(solution: &StaticSolution) -> [f64; 2] {
    let q = solution.displacements.shaft;
    [q[0], q[2]]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Adds the kinetic energy of every ball across its line of contact at rest, J.
fn add_swings(model: &Model, rest: &StaticSolution, state: &MotionState, energies: &mut [f64]) {
    for ((energy, ball), v) in energies.iter_mut().zip(&rest.balls).zip(&state.ball_velocities) {
        let (sin, cos) = ball.inner.contact_angle_rad.sin_cos();
        *energy += 0.5 * model.ball_mass() * (v.axial * cos - v.radial * sin).powi(2);
    }
}

/// Axial and radial force of the swings of loaded balls on the shaft, N, against its load.
fn pushes(rest: &StaticSolution, energies: &[f64]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (ball, energy) in rest
        .balls
        .iter()
        .zip(energies)
        .filter(|(b, _)| b.inner.force_n > 0.0)
    {
        let force = 1.5 * energy / (ball.inner.approach_m + ball.outer.approach_m);
        let (sin, cos) = ball.inner.contact_angle_rad.sin_cos();
        sum[0] += force * sin;
        sum[1] += force * cos * ball.azimuth_rad.cos();
    }
    sum
}
