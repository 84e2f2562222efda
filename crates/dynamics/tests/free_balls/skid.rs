//! Balls that a drag holds back.

use dynamics::effects::ball_drag::BallDrag;
use dynamics::interactions::traction::Creep;
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionState};

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::equilibrium;

/// A ball of the 7010C at 10 000 rpm, whose drag at the speed of rolling is a share of 2 mu Q_i, Q_i without drag.
struct Held {
    /// Speed round the axis over that without drag, over the course.
    orbits: Vec<f64>,
    /// Mean tractions along the rolling direction over the drag, in the last quarter, inside and outside.
    tractions: [f64; 2],
    /// Defect of the ledger over the largest energy.
    defect: f64,
}

fn held(axial: f64, share: f64, steps: usize) -> Held {
    let (mu, speed) = (0.07, rpm(10_000.0));
    let speeds = RingSpeeds::from(Speed::constant(speed));
    let mut model = freed(thrust(axial), coulomb(mu, Creep::Elastic), &speeds);
    let start = |model: &dynamics::Model| {
        let motion = Motion::new(model, settings(1e-5, &speeds)).unwrap();
        motion.start(&equilibrium(model))
    };
    let free = start(&model);
    let size = |state: &MotionState| {
        let [u, v, w] = state.free.as_ref().unwrap().velocities[0];
        (u * u + v * v + w * w).sqrt()
    };
    let grip = 2.0 * mu * free.forces[0].norm();
    let unit = BallDrag { pressure: 1.0 }.coefficient(&model);
    let pressure = share * grip / (unit * size(&free).powi(2));
    model.effects.push(Box::new(BallDrag { pressure }));
    let motion = Motion::new(&model, settings(1e-5, &speeds)).unwrap();
    let orbit = |state: &MotionState| state.free.as_ref().unwrap().orbit(0);
    let rolling = orbit(&free);
    let (mut orbits, mut tractions) = (Vec::new(), [0.0; 2]);
    let last = run(&motion, free, steps, |state| {
        orbits.push(orbit(state) / rolling);
        if orbits.len() > steps - 100 {
            let drag = unit * pressure * size(state).powi(2);
            let contacts = &state.free.as_ref().unwrap().contacts;
            (0..2).for_each(|i| tractions[i] += contacts[i].action[0] / (100.0 * drag));
        }
    });
    Held {
        orbits,
        tractions,
        defect: last.ledger.relative_defect().abs(),
    }
}

/// Wrong: the grip of a ball. Against a drag of half of what both contacts can carry each has half of it, and the orbit
/// creeps; above it the ball falls behind.
#[test]
fn a_ball_held_back_creeps_and_then_breaks_away() {
    let creeps = held(200.0, 0.5, 400);
    let [inner, outer] = creeps.tractions;
    println!("{inner} {outer} {} {}", creeps.orbits[199], creeps.orbits[399]);
    assert!(
        (inner - 0.5).abs() < 0.015 && (outer - 0.5).abs() < 0.015,
        "{inner} {outer}"
    );
    let [middle, end] = [199, 399].map(|i| creeps.orbits[i]);
    assert!(end > 0.99 && (end - middle).abs() < 2e-3, "{middle} {end}");
    let skids = held(200.0, 1.05, 400);
    println!("{} {}", skids.orbits[199], skids.orbits[399]);
    assert!(
        skids.orbits[199] - skids.orbits[399] > 5e-3,
        "{:?}",
        skids.orbits[399]
    );
    assert!(creeps.defect < 1e-9 && skids.defect < 1e-9);
}

/// Balls under 2 kN at 10 000 rpm that roll without drag, and their model.
struct Rolling {
    model: dynamics::Model,
    /// Speed round the axis, rad/s, and of the centres, m/s.
    speeds: [f64; 2],
    /// 2 mu Q_i, N.
    grip: f64,
}

fn rolling() -> Rolling {
    let (mu, speeds) = (0.07, RingSpeeds::from(Speed::constant(rpm(10_000.0))));
    let model = freed(thrust(2000.0), coulomb(mu, Creep::Elastic), &speeds);
    let ball = equilibrium(&model).balls[0];
    let orbit = ball.free.unwrap().orbit_rad_per_s;
    let radius = model.geometry.ball_centre().radial + ball.displacement_m.radial;
    Rolling {
        model,
        speeds: [orbit, orbit * radius],
        grip: 2.0 * mu * ball.inner.force_n,
    }
}

impl Rolling {
    /// Speed in the equilibrium with a drag that would take this share of the grip at the speed of rolling, over that
    /// of rolling; and the share that the drag takes of the grip at the speed that is left.
    fn dragged(&mut self, share: f64) -> [f64; 2] {
        let unit = BallDrag { pressure: 1.0 }.coefficient(&self.model);
        let pressure = share * self.grip / (unit * self.speeds[1].powi(2));
        self.model.effects.push(Box::new(BallDrag { pressure }));
        let orbit = equilibrium(&self.model).balls[0].free.unwrap().orbit_rad_per_s / self.speeds[0];
        self.model.effects.pop();
        [orbit, share * orbit * orbit]
    }
}

/// Wrong: where balls skid. Under 2 kN at 10 000 rpm balls creep until their drag is 0.97 to 0.98 of 2 mu Q_i, Q_i
/// without drag: spin takes the rest of the smaller grip. No more is held at any speed down to 0.9 of that of rolling.
#[test]
fn under_high_thrust_balls_break_away_just_below_their_grip() {
    let mut rolling = rolling();
    let shares = (0..27).map(|i| 0.96 + 0.01 * f64::from(i));
    let found: Vec<[f64; 2]> = shares.map(|share| rolling.dragged(share)).collect();
    println!("{found:?}");
    assert!(found.windows(2).all(|pair| pair[1][0] < pair[0][0]));
    let [before, after] = [found[0][0], found[26][0]];
    assert!(before > 0.98 && after < 0.9, "{before} {after}");
    let most = found.iter().map(|[_, held]| *held).fold(0.0, f64::max);
    let last_hold = found.iter().rfind(|[orbit, _]| *orbit > 0.98).unwrap();
    println!("{most} {last_hold:?}");
    assert!((0.97..0.98).contains(&most), "{most}");
    assert!(last_hold[1] > 0.97, "{last_hold:?}");
}
