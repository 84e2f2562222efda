//! A bearing under thrust: free balls without race control.

use contact::Side;
use dynamics::Model;
use dynamics::interactions::traction::Creep;
use dynamics::kinematics::{Kinematics, RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionState};

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::{equilibrium, relative};

struct Steady {
    model: Model,
    state: MotionState,
    /// Speed of the inner ring, rad/s.
    speed: f64,
    /// Torque that brakes the inner ring, N m.
    torque: f64,
    /// Power lost at all contacts, W.
    power: f64,
}

/// The 7010C under thrust, after a time in which spins settle.
fn steady(axial: f64, n: f64, mu: f64) -> Steady {
    let speed = rpm(n);
    let speeds = RingSpeeds::from(Speed::constant(speed));
    let model = freed(thrust(axial), coulomb(mu, Creep::Elastic), &speeds);
    let motion = Motion::new(&model, settings(1e-5, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    let state = run(&motion, start, 250, |_| {});
    let friction = motion.friction(&state).unwrap();
    Steady {
        speed,
        torque: friction.torque_n_m,
        power: friction.power_w,
        state,
        model,
    }
}

/// Wrong: balls would be carried by something else than friction. Under thrust, slowly and without drag, the net
/// tractions of a ball are opposite and about 2e-3 mu Q, the torque goes with the coefficient and the orbit does not;
/// the power of all contacts is torque times speed.
#[test]
fn under_thrust_tractions_are_opposite_and_tiny_and_torque_goes_with_friction() {
    let [weak, strong] = [0.03, 0.07].map(|mu| (mu, steady(2000.0, 1800.0, mu)));
    for (mu, found) in [&weak, &strong] {
        let free = found.state.free.as_ref().unwrap();
        let [inner, outer] = [free.contacts[0].action[0], free.contacts[1].action[0]];
        let load = found.state.forces[0].norm();
        assert!(
            inner.abs() < 4e-3 * mu * load && inner.abs() > 1e-4 * mu * load,
            "{inner}"
        );
        assert!((inner + outer).abs() < 0.02 * inner.abs(), "{inner} {outer}");
        let drive = found.torque * found.speed;
        println!("{mu}: power {} of {drive}, orbit {}", found.power, free.orbit(0));
        assert!(relative(found.power, drive) < 1e-3, "{} {drive}", found.power);
    }
    let ratio = strong.1.torque / weak.1.torque * weak.0 / strong.0;
    assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
    let orbits = [&weak, &strong].map(|(_, found)| found.state.free.as_ref().unwrap().orbit(0));
    assert!(relative(orbits[0], orbits[1]) < 2e-4, "{orbits:?}");
}

/// Wrong: the orbit. In pure rolling without control it lies between those of both race controls, which differ little;
/// Harris (4th ed., chapter 8) by the contact angles of the ball. 1.5e-3 is what differential slip and spin leave.
#[test]
fn the_orbit_is_that_of_rolling_at_the_balls_own_angles() {
    let found = steady(2000.0, 1800.0, 0.07);
    let angles = Side::BOTH.map(|side| found.state.angles[side.index()]);
    let kinematics = Kinematics::outer_control(&found.model.geometry, [0.0; 2], angles);
    let orbit = found.state.free.as_ref().unwrap().orbit(0);
    println!("{}", orbit / (kinematics.cage * found.speed));
    assert!(relative(orbit, kinematics.cage * found.speed) < 1.5e-3);
}

/// Wrong: race control would come out as a law. With the curvature of the contact both contacts spin, in shares not far
/// from half and half, and the torque is about a third more than that of spin alone at the contact that does not
/// control.
#[test]
fn both_contacts_spin_under_thrust() {
    let found = steady(2000.0, 1800.0, 0.07);
    let contacts = &found.state.free.as_ref().unwrap().contacts;
    let (inner, outer) = (contacts[0].slip.turning[2], contacts[1].slip.turning[2]);
    println!("{inner} {outer} {}", found.torque);
    let share = inner / (inner + outer);
    assert!((0.3..0.7).contains(&share), "{share}");
    // 3/8 mu Q a E at the outer contact, which has the smaller of both, times all spin.
    let load = found.state.forces[1].norm();
    let [a, b] = found.model.hertz[1].semi_axes(load).into();
    let (_, e) = contact::elliptic::complete_elliptic(1.0 - (b / a).powi(2));
    let moment = 0.375 * 0.07 * load * a * e;
    let alone = 18.0 * moment * (inner + outer).abs() / found.speed;
    println!("{}", found.torque / alone);
    assert!(
        (1.15..1.5).contains(&(found.torque / alone)),
        "{}",
        found.torque / alone
    );
}

/// Wrong: the gyroscopic moment would be missing, or act twice. Lateral tractions carry it: J omega_c omega_r, omega_r
/// the part of the turning across the axis of the bearing; 7010C under 2 kN at 10 000 rpm 0.0138 N m by kinematic
/// speeds at its contact angles, J = 2/5 m r^2 (Harris, 4th ed., chapter 8). The pitch of the axis is a result here, so
/// that the second comparison is good to two per cent.
#[test]
fn lateral_tractions_carry_the_gyroscopic_moment() {
    let found = steady(2000.0, 10_000.0, 0.07);
    let free = found.state.free.as_ref().unwrap();
    let (r, mass) = (0.5 * found.model.geometry.ball_diameter, found.model.ball_mass());
    let ([x, y, _], w) = (free.places[0], free.turnings[0]);
    let across = (w[0] * x + w[1] * y) / x.hypot(y);
    let needed = 0.4 * mass * r * r * free.orbit(0) * across;
    let carried = -r * (free.contacts[0].action[1] + free.contacts[1].action[1]);
    println!("{carried} {needed}");
    assert!((carried / needed - 1.0).abs() < 5e-3, "{carried} {needed}");
    assert!((needed.abs() / 0.0138 - 1.0).abs() < 0.02, "{needed}");
}
