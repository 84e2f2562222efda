//! Equilibria in which every ball rolls steadily under friction.

use contact::SemiAxes;
use contact::film::{FilmContact, Lubricant};
use dynamics::balls::BallResult;
use dynamics::effects::RadialForce;
use dynamics::effects::ball_drag::BallDrag;
use dynamics::interactions::steady_rolling::{SteadyBall, SteadyContact, SteadyRolling};
use dynamics::interactions::traction::law::SlipTable;
use dynamics::interactions::traction::{Creep, Ellipse, LimitingShear, PatchPoints, Traction, TractionLaw};
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::model::BallInertia;
use dynamics::motion::Motion;
use dynamics::{ShaftDof, StaticSolution};
use input::Schedule;

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::{equilibrium, relative};

fn speeds(n: f64) -> RingSpeeds {
    RingSpeeds::from(Speed::constant(rpm(n)))
}

fn under_thrust(axial: f64, speed: f64, mu: f64) -> StaticSolution {
    under_thrust_with(axial, speed, mu, Creep::Elastic)
}

fn under_thrust_with(axial: f64, speed: f64, mu: f64, creep: Creep) -> StaticSolution {
    equilibrium(&freed(thrust(axial), coulomb(mu, creep), &speeds(speed)))
}

/// Wrong: a motion would begin with a transient, or equilibrium and motion would have other equations of traction.
/// Balls of a motion that starts from the equilibrium go on as they were.
#[test]
fn a_motion_stays_in_the_equilibrium_of_rolling_balls() {
    for (axial, speed) in [(2000.0, 1800.0), (500.0, 10_000.0), (2000.0, 30_000.0)] {
        let speeds = speeds(speed);
        let model = freed(thrust(axial), coulomb(0.07, Creep::Elastic), &speeds);
        let solution = equilibrium(&model);
        let friction = solution.steady.as_ref().unwrap().friction();
        let motion = Motion::new(&model, settings(2e-6, &speeds)).unwrap();
        let start = motion.start(&solution);
        let first = start.free.clone().unwrap();
        let last = run(&motion, start, 200, |_| {});
        let free = last.free.as_ref().unwrap();
        let found = motion.friction(&last).unwrap();
        let orbit = relative(free.orbit(5), first.orbit(5));
        let spin = |index: usize| {
            let expected = solution.balls[5].free.as_ref().unwrap();
            let expected = [expected.inner, expected.outer][index].spin_rad_per_s;
            (free.contacts[10 + index].slip.turning[2] - expected).abs() / rpm(speed)
        };
        let torque = relative(found.torque_n_m, friction.torque_n_m);
        // Nothing but the rings acts on balls that stay: what one ring loses is what the other has.
        let [at_rest, in_motion] = [friction, found].map(|of| relative(-of.outer_torque_n_m, of.torque_n_m));
        assert!(at_rest < 1e-8 && in_motion < 1e-4, "{at_rest:e} {in_motion:e}");
        let rolling = [friction, found].map(|of| of.kinematic_cage_speed_rad_per_s);
        assert!(relative(rolling[0], rolling[1]) < 1e-14, "{rolling:?}");
        println!(
            "{axial} {speed}: {orbit:e} {:e} {:e} {torque:e} {at_rest:e} {in_motion:e}",
            spin(0),
            spin(1)
        );
        assert!(orbit < 1e-5, "{orbit}");
        assert!(spin(0) < 1e-4 && spin(1) < 1e-4, "{} {}", spin(0), spin(1));
        assert!(torque < 2e-3, "{torque}");
    }
}

/// Wrong: race control would be put in by hand, or the power would not be the torque's. Under thrust net tractions of a
/// ball's contacts are opposite and tiny, orbits are those of rolling to 1.5e-3, torque is in proportion to friction,
/// and both contacts spin, in shares not far from half and half.
#[test]
fn under_slow_thrust_both_contacts_spin_and_torque_goes_with_friction() {
    let mut torques = Vec::new();
    for mu in [0.01, 0.07, 0.15] {
        let solution = under_thrust_with(2000.0, 100.0, mu, Creep::Ratio(1e-5));
        let friction = solution.steady.as_ref().unwrap().friction();
        let ball = solution.balls[0].free.unwrap();
        let [inner, outer] = [ball.inner, ball.outer];
        let share = inner.spin_rad_per_s.abs() / (inner.spin_rad_per_s.abs() + outer.spin_rad_per_s.abs());
        println!(
            "mu {mu}: share of the inner spin {share}, torque {}",
            friction.torque_n_m
        );
        assert!((0.3..0.7).contains(&share), "{share}");
        let net =
            [inner, outer].map(|contact| contact.traction_n[0] / (mu * solution.balls[0].inner.force_n));
        assert!((net[0] + net[1]).abs() < 1e-6 && net[0].abs() < 4e-3, "{net:?}");
        let power = friction.torque_n_m * rpm(100.0);
        assert!(
            relative(friction.power_w, power) < 1e-6,
            "{} {power}",
            friction.power_w
        );
        let rolling = solution.steady.as_ref().unwrap().balls[0].orbit;
        let angle =
            0.5 * (solution.balls[0].inner.contact_angle_rad + solution.balls[0].outer.contact_angle_rad);
        let gamma = 9e-3 * angle.cos() / 65.0235e-3;
        assert!(
            relative(rolling, 0.5 * rpm(100.0) * (1.0 - gamma)) < 2.5e-3,
            "{rolling}"
        );
        torques.push(friction.torque_n_m / mu);
    }
    assert!(
        relative(torques[0], torques[1]) < 0.05 && relative(torques[1], torques[2]) < 0.05,
        "{torques:?}"
    );
}

/// Wrong: lateral tractions would not carry the gyroscopic moment, J w_c x w, or a fast ball would be held by a
/// threshold.
#[test]
fn lateral_tractions_balance_the_gyroscopic_moment() {
    for speed in [3000.0, 10_000.0, 30_000.0] {
        let solution = under_thrust(2000.0, speed, 0.07);
        let steady = solution.steady.as_ref().unwrap();
        let (rolls, ball) = (&steady.balls[0], &solution.balls[0]);
        let moment = 2.0 / 5.0 * ball_mass() * 4.5e-3f64.powi(2) * rolls.orbit * rolls.turning[0];
        let free = ball.free.unwrap();
        let levers = [ball.inner, ball.outer].map(|contact| 4.5e-3 - 0.5 * contact.approach_m);
        let taken = -levers[0] * free.inner.traction_n[1] - levers[1] * free.outer.traction_n[1]
            + rolls
                .tractions
                .iter()
                .map(|traction| traction.action[2])
                .sum::<f64>();
        println!(
            "{speed}: {moment:e} {taken:e} slip {:?}",
            rolls.slips.map(|slip| slip.centre[1])
        );
        assert!(relative(moment, taken) < 1e-6, "{moment} {taken}");
        // Viscous through the spin: some lateral slip at any speed.
        assert!(rolls.turning[1] != 0.0);
    }
}

fn ball_mass() -> f64 {
    7800.0 * std::f64::consts::PI / 6.0 * 9e-3f64.powi(3)
}

/// Wrong: drag would not be shared by both contacts, or a ball that the inner ring leaves would stop the solver. A drag
/// brakes the orbit; a radial load unloads balls, which the cage then carries.
#[test]
fn drag_is_shared_and_unloaded_balls_go_with_the_others() {
    let speeds = speeds(10_000.0);
    let mut model = freed(thrust(500.0), coulomb(0.07, Creep::Elastic), &speeds);
    // 1/2 rho C_d with 20 kg/m3 and 10.
    model.effects.push(Box::new(BallDrag { pressure: 100.0 }));
    let solution = equilibrium(&model);
    let free = solution.balls[0].free.unwrap();
    let speed = free.orbit_rad_per_s * solution.steady.as_ref().unwrap().balls[0].out;
    let drag = 0.5 * 20.0 * 10.0 * std::f64::consts::PI * 4.5e-3f64.powi(2) * speed * speed;
    let sum = free.inner.traction_n[0] + free.outer.traction_n[0];
    println!(
        "{drag} {:?}",
        [free.inner.traction_n[0], free.outer.traction_n[0]]
    );
    assert!(relative(sum, drag) < 1e-6, "{sum} {drag}");
    assert!(relative(free.inner.traction_n[0], 0.5 * drag) < 0.05, "{free:?}");

    let mut model = freed(thrust(200.0), coulomb(0.07, Creep::Elastic), &speeds);
    model.effects.push(Box::new(RadialForce {
        value: 3000.0,
        direction: 0.0,
        schedule: Schedule::Constant,
    }));
    // The other side comes off where the rings can neither come closer along the axis nor tilt.
    model.shaft[2..].fill(ShaftDof::Prescribed(0.0));
    model.shaft[2] = ShaftDof::Prescribed(-60e-6);
    let solution = equilibrium(&model);
    let open = solution
        .balls
        .iter()
        .filter(|ball| ball.inner.force_n == 0.0)
        .count();
    let orbits: Vec<f64> = solution
        .balls
        .iter()
        .map(|b| b.free.unwrap().orbit_rad_per_s)
        .collect();
    println!(
        "open {open} {:?} {orbits:?}",
        solution.balls.iter().map(|b| b.inner.force_n).collect::<Vec<_>>()
    );
    assert!(
        open > 0 && orbits.iter().all(|orbit| *orbit > 0.3 * rpm(10_000.0)),
        "{orbits:?}"
    );
    let (a, b) = (solution.balls[1].free.unwrap(), solution.balls[17].free.unwrap());
    // Traction round the axis moves the shaft a little across the load.
    assert!(relative(a.orbit_rad_per_s, b.orbit_rad_per_s) < 1e-5);
}

/// Wrong: drag would stop balls that are hardly loaded, round for round, until nothing presses them outwards and no
/// equilibrium is found. The cage pushes them, and no others. A load across of four times the thrust leaves the other
/// side so light.
#[test]
fn the_cage_pushes_balls_that_drag_would_stop() {
    let speeds = speeds(6000.0);
    for (axial, across, pushes) in [(400.0, 1600.0, true), (100.0, 400.0, false)] {
        let mut model = freed(thrust(axial), coulomb(0.07, Creep::Elastic), &speeds);
        model.effects.push(Box::new(RadialForce {
            value: across,
            direction: 0.12,
            schedule: Schedule::Constant,
        }));
        model.effects.push(Box::new(BallDrag { pressure: 5.0 }));
        model.shaft[3..].fill(ShaftDof::Prescribed(0.0));
        model.contact.projects_grooves = true;
        let solution = equilibrium(&model);
        let balls = &solution.balls;
        let orbit = |ball: usize| balls[ball].free.unwrap().orbit_rad_per_s;
        let force = |ball: &usize| balls[*ball].inner.force_n;
        let cage: f64 = (0..balls.len()).map(|ball| force(&ball) * orbit(ball)).sum();
        let cage = cage / (0..balls.len()).map(|ball| force(&ball)).sum::<f64>();
        let slowest = (0..balls.len()).map(orbit).fold(f64::INFINITY, f64::min);
        let limit = cage - 0.1 * rpm(6000.0);
        println!("{axial} N: cage {cage}, slowest {slowest}, limit {limit}");
        assert!(slowest > 0.999 * limit, "{slowest} {limit}");
        assert!(!pushes || slowest < 1.001 * limit, "{slowest} {limit}");
    }
}

/// Wrong: where balls skid. Under a growing drag the orbit creeps, then breaks away just below 2 mu Q_i, because spin
/// takes a little of the grip.
#[test]
fn the_orbit_breaks_away_before_the_grip_of_both_contacts() {
    let (mu, speeds) = (0.07, speeds(1000.0));
    let free = equilibrium(&freed(thrust(200.0), coulomb(mu, Creep::Elastic), &speeds));
    let rolling = free.steady.as_ref().unwrap().balls[0];
    let grip = 2.0 * mu * free.balls[0].inner.force_n;
    let orbit = |share: f64| {
        let mut model = freed(thrust(200.0), coulomb(mu, Creep::Elastic), &speeds);
        let unit = BallDrag { pressure: 1.0 }.coefficient(&model);
        // A drag of this share at the speed that the ball has.
        let mut speed = rolling.orbit * rolling.out;
        let mut ratio = 1.0;
        for _ in 0..60 {
            model.effects.retain(|effect| effect.name() != "ball_drag");
            let pressure = share * grip / (unit * speed * speed);
            model.effects.push(Box::new(BallDrag { pressure }));
            let found = equilibrium(&model);
            let ball = found.steady.as_ref().unwrap().balls[0];
            ratio = ball.orbit / rolling.orbit;
            if ratio < 0.3 || (ball.orbit * ball.out / speed - 1.0).abs() < 1e-6 {
                break;
            }
            speed = ball.orbit * ball.out;
        }
        ratio
    };
    let found = [0.5, 0.9, 0.98, 1.0].map(orbit);
    println!("{found:?}");
    assert!(found.windows(2).all(|pair| pair[0] > pair[1]), "{found:?}");
    assert!(found[2] > 0.99 && found[3] < 0.95, "{found:?}");
}

/// Wrong: a film that shears would have another traction in an equilibrium than in motion, or depend on what it should
/// not: the torque goes with the limit where the oil is stiff, and with the viscosity where it is thin.
#[test]
fn a_film_that_shears_rolls_the_same_in_equilibrium_and_in_motion() {
    let film = |limit: f64, viscosity: f64, pressure_coefficient: f64| Traction {
        law: TractionLaw::LimitingShear(LimitingShear {
            eyring: 5e6,
            limit,
            lubricant: Lubricant {
                viscosity,
                pressure_coefficient,
            },
        }),
        ..coulomb(0.0, Creep::Elastic)
    };
    let solved = |traction: &Traction, n: f64| {
        let model = freed(thrust(2000.0), traction.clone(), &speeds(n));
        let solution = equilibrium(&model);
        (model, solution)
    };
    let torque = |traction: &Traction, n: f64| solved(traction, n).1.steady.unwrap().friction().torque_n_m;
    let traction = film(0.08, 0.04, 2.2e-8);
    let (model, start) = solved(&traction, 1800.0);
    let motion = Motion::new(&model, settings(1e-5, &speeds(1800.0))).unwrap();
    let last = run(&motion, motion.start(&start), 100, |_| ());
    let moving: f64 = last
        .free
        .unwrap()
        .contacts
        .iter()
        .step_by(2)
        .map(|c| c.torque)
        .sum();
    let still = start.steady.as_ref().unwrap().friction().torque_n_m;
    println!("torque {still} at rest, {moving} in motion");
    assert!((moving / still - 1.0).abs() < 1e-5, "{moving} {still}");
    // Eyring's stress is far above this limit: dry friction.
    let stiff = film(1e-3, 4.0, 2.2e-8);
    let dry = torque(&coulomb(1e-3, Creep::Elastic), 1800.0);
    assert!(
        (torque(&stiff, 1800.0) / dry - 1.0).abs() < 0.01,
        "{} {dry}",
        torque(&stiff, 1800.0)
    );
    // An oil that hardly stiffens is Newton's fluid: eta/h_c goes with eta^(1 - 0.67), where nothing gyroscopic slips.
    let thin = |viscosity: f64| torque(&film(0.08, viscosity, 1e-9), 100.0);
    let ratio = thin(0.08) / thin(0.04);
    assert!((ratio / 2f64.powf(0.33) - 1.0).abs() < 0.01, "{ratio}");
}

/// Wrong: where drag nearly stops a ball, loads would go to and fro about an equilibrium that a little less drag has,
/// and none be found. The shaft is in balance, and the tractions of every ball that both rings press and no cage pushes
/// carry its drag.
#[test]
fn equilibria_that_drag_has_moved_are_found() {
    for (axial, across, direction) in [(100.0, 400.0, 0.12), (100.0, 400.0, 0.24), (400.0, 1600.0, 0.174)] {
        let mut model = freed(thrust(axial), coulomb(0.07, Creep::Elastic), &speeds(6000.0));
        model.effects.push(Box::new(RadialForce {
            value: across,
            direction,
            schedule: Schedule::Constant,
        }));
        let drag = BallDrag { pressure: 5.0 };
        let coefficient = drag.coefficient(&model);
        model.effects.push(Box::new(drag));
        model.shaft[3..].fill(ShaftDof::Prescribed(0.0));
        let solution = equilibrium(&model);
        let residual = solution.shaft_residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
        assert!(residual < 1e-6 * across, "{residual}");
        let steady = solution.steady.as_ref().unwrap();
        let slowest = steady
            .balls
            .iter()
            .fold(f64::INFINITY, |m, ball| m.min(ball.orbit));
        let rolls = |(ball, free): &(&BallResult, &SteadyRolling)| {
            ball.inner.force_n > 0.0 && free.orbit > slowest * (1.0 + 1e-9)
        };
        let mut rolling = 0;
        for (_, ball) in solution.balls.iter().zip(&steady.balls).filter(rolls) {
            let carried: f64 = ball.tractions.iter().map(|traction| traction.action[0]).sum();
            let expected = coefficient * (ball.orbit * ball.out).powi(2);
            assert!(
                (carried - expected).abs() < 1e-6 * expected,
                "{carried} {expected}"
            );
            rolling += 1;
        }
        assert!(rolling >= 8, "{rolling}");
    }
}

/// A ball of a 7204 of 40 deg at 10 000 rpm of the outer ring, with forces, N, and contact angles, deg, inner first.
fn fast_ball<'t>(traction: &'t Traction, forces: [f64; 2], angles: [f64; 2]) -> SteadyBall<'t> {
    let diameter: f64 = 7.938e-3;
    let mass = 7800.0 * std::f64::consts::PI / 6.0 * diameter.powi(3);
    let contact = |side: usize| {
        let (sign, speed) = [(-1.0, 0.0), (1.0, rpm(10_000.0))][side];
        let (force, angle) = (forces[side], angles[side].to_radians());
        // Semi-axes and pressure of 10 N, which grow with the root of third order.
        let (axes, pressure) = [([2.83e-4, 3.08e-5], 5.5e8), ([2.34e-4, 4.05e-5], 5.0e8)][side];
        let size = (force / 10.0).cbrt();
        SteadyContact {
            normal: [sign * angle.cos(), sign * angle.sin()],
            lever: 0.5 * diameter,
            force,
            ellipse: Ellipse {
                semi_axes: SemiAxes {
                    groove: size * axes[0],
                    rolling: size * axes[1],
                },
                radius: 4e-3,
                peak_pressure: size * pressure,
                film: 0.0,
            },
            film: FilmContact {
                radius: 4e-3,
                modulus: 2.3e11,
                ellipticity: 8.0,
            },
            speed,
            shear_modulus: 8e10,
        }
    };
    SteadyBall {
        out: 16.75e-3,
        inertia: BallInertia {
            mass,
            moment: 0.1 * mass * diameter * diameter,
        },
        drag: 0.0,
        contacts: [contact(0), contact(1)],
        traction,
        on_strips: [None, None],
    }
}

/// Wrong: where friction falls with slip or grows slowly, a light fast ball whose axis turns far from that of rolling
/// would find no steady state, and the equilibrium of its bearing would be refused. Its own motion leads to one.
#[test]
fn light_fast_balls_come_to_roll_under_any_law() {
    let table = |slips: &[f64], coefficients: &[f64]| Traction {
        law: TractionLaw::Table(SlipTable::new(slips.to_vec(), coefficients.to_vec())),
        creep: Creep::Elastic,
        places: PatchPoints::new([3, 15]),
    };
    let laws = [
        table(&[0.0, 0.05, 1.0], &[0.0, 0.06, 0.04]),
        table(&[0.0, 0.05, 1.0], &[0.0, 0.05, 0.05]),
        table(&[0.0, 0.5, 10.0], &[0.0, 0.06, 0.04]),
        coulomb(0.05, Creep::Elastic),
    ];
    for traction in &laws {
        for inner in [0.05, 0.5, 2.0, 6.0, 25.0, 140.0] {
            for angle in [42.0, 50.0, 60.0, 70.0] {
                for cage in [None, Some(516.0), Some(600.0)] {
                    let ball = fast_ball(traction, [inner, inner + 7.5], [angle, 60.0 - 0.5 * angle]);
                    let found = ball.solve(cage);
                    let case = format!("{:?} {inner} N {angle} deg {cage:?}", traction.law);
                    let rolls = found.unwrap_or_else(|left| panic!("{case}: {left:e}")).unwrap();
                    let net: f64 = rolls.tractions.iter().map(|traction| traction.action[0]).sum();
                    assert!(
                        cage.is_some() || net.abs() < 1e-8 * (inner + 7.5),
                        "{case}: {net:e}"
                    );
                }
            }
        }
    }
}
