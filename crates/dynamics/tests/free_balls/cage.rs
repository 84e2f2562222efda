//! A free cage: impacts, momentum, ledger, and what it does to the balls.

use contact::Side;
use dynamics::ShaftDof;
use dynamics::effects::RadialForce;
use dynamics::interactions::cage::{Cage, Land};
use dynamics::interactions::traction::Creep;
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{CageState, Ladder, Motion, MotionSettings, MotionState, StepCache};
use input::Schedule;

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::equilibrium;

/// A cage of 12 g, with clearances as bearings of this size have them.
pub fn cage() -> Cage {
    Cage {
        mass: 0.012,
        polar: 1.2e-5,
        transverse: 6.5e-6,
        pocket_clearance: 0.2e-3,
        pocket_offsets: Vec::new(),
        stiffness: 2e8,
        restitution: 0.6,
        friction: 0.1,
        land: None,
    }
}

fn land(side: Side) -> Land {
    Land {
        side,
        radius: if side == Side::Inner { 30e-3 } else { 35e-3 },
        width: 10e-3,
        clearance: 0.3e-3,
        viscosity: 0.0,
    }
}

fn cage_of(state: &MotionState) -> &CageState {
    state.free.as_ref().unwrap().cage.as_ref().unwrap()
}

fn with_ladder(dt: f64, speeds: &RingSpeeds) -> MotionSettings {
    MotionSettings {
        ladder: Ladder {
            halvings: 5,
            tolerance: None,
        },
        ..settings(dt, speeds)
    }
}

/// Wrong: energy would appear or go without a line in the ledger, or friction and impacts give some back. A change of
/// speed under a radial load, so that balls push the cage and it them, guided by each land and by none.
#[test]
fn the_ledger_closes_with_a_cage_and_no_loss_ever_falls() {
    for guide in [None, Some(Side::Inner), Some(Side::Outer)] {
        let speeds = RingSpeeds::from(Speed::table(vec![0.0, 1e-3], vec![rpm(4000.0), rpm(9000.0)]));
        let mut model = freed(thrust(300.0), coulomb(0.07, Creep::Elastic), &speeds);
        model.effects.push(Box::new(RadialForce {
            value: 2000.0,
            direction: 0.3,
            schedule: Schedule::Constant,
        }));
        model.cage = Some(Cage {
            pocket_clearance: 10e-6,
            land: guide.map(|side| Land {
                viscosity: 0.01,
                clearance: 10e-6,
                ..land(side)
            }),
            ..cage()
        });
        let motion = Motion::new(&model, with_ladder(1e-5, &speeds)).unwrap();
        let mut start = motion.start(&equilibrium(&model));
        if let Some(state) = start.free.as_mut().and_then(|free| free.cage.as_mut()) {
            state.rates[0] = 0.05;
            state.rates[3] = 0.7;
        }
        let start = motion.with_energies(start);
        let (mut losses, mut worst) = ([0.0; 3], 0.0f64);
        let (mut met, mut landed) = (0, 0);
        // Unguided, balls without load would shift it off the axis.
        let n = if guide.is_some() { 200 } else { 100 };
        let last = run(&motion, start, n, |state| {
            let ledger = state.ledger.cage.unwrap();
            let now = [ledger.impact_loss, ledger.friction_loss, ledger.drag_loss];
            assert!(
                now.iter().zip(losses).all(|(a, b)| *a >= b),
                "{now:?} after {losses:?}"
            );
            losses = now;
            worst = worst.max(state.ledger.relative_defect().abs());
            let n = cage_of(state).pockets.len();
            met += cage_of(state).met[..n].iter().filter(|v| **v > 0.0).count();
            landed += cage_of(state).met[n..].iter().filter(|v| **v > 0.0).count();
        });
        println!(
            "{guide:?}: defect {worst:e} {:?} met {met} {landed}",
            last.ledger.cage
        );
        assert!(worst < 1e-9, "{guide:?}: {worst}");
        assert!(
            met > 10 && losses[0] > 0.0 && losses[1] > 0.0,
            "{guide:?}: {met} {losses:?}"
        );
        assert_eq!(landed > 0, guide.is_some(), "{guide:?}");
    }
}

/// A cage that the balls never meet, in a land without friction and rebounding in full; or without a land.
fn thrown(land: Option<Land>, place: [f64; 2], rates: [f64; 6], each: impl FnMut(&MotionState)) -> [f64; 2] {
    let speeds = RingSpeeds::from(Speed::constant(0.0));
    let mut model = freed(thrust(500.0), coulomb(0.07, Creep::Elastic), &speeds);
    model.cage = Some(Cage {
        pocket_clearance: 4e-3,
        restitution: 1.0,
        friction: 0.0,
        land,
        ..cage()
    });
    let motion = Motion::new(&model, with_ladder(1e-5, &speeds)).unwrap();
    let mut start = motion.start(&equilibrium(&model));
    let thrown = start.free.as_mut().unwrap().cage.as_mut().unwrap();
    thrown.place[..2].copy_from_slice(&place);
    thrown.rates = rates;
    let start = motion.with_energies(start);
    let [mut energies, mut moments] = [energy_of(&start), moment_of(&start)].map(|first| [first; 2]);
    let mut each = each;
    run(&motion, start, 200, |state| {
        for (range, now) in [
            (&mut energies, energy_of(state)),
            (&mut moments, moment_of(state)),
        ] {
            *range = [range[0].min(now), range[1].max(now)];
        }
        each(state);
    });
    [energies, moments].map(|[low, high]| (high - low) / high.abs().max(low.abs()))
}

/// Kinetic energy of the cage and strain of its land, J.
fn energy_of(state: &MotionState) -> f64 {
    state.ledger.cage.map_or(0.0, |c| c.kinetic + c.strain)
}

/// Moment of momentum of the cage about the axis to the second order of its tilts, N m s.
fn moment_of(state: &MotionState) -> f64 {
    let CageState { place, rates, .. } = cage_of(state);
    let crossed = |i: usize| place[i] * rates[i + 1] - place[i + 1] * rates[i];
    let tilted = 1.0 - 0.5 * (place[3] * place[3] + place[4] * place[4]);
    0.012 * crossed(0) + 6.5e-6 * crossed(3) + 1.2e-5 * rates[5] * tilted
}

/// Wrong: a free cage in a land would gain energy or turn by itself. Thrown off the middle without friction, rebounds
/// in full: energy and moment of momentum stay to 1e-12 while it rebounds and tilts.
#[test]
fn a_cage_thrown_in_its_land_keeps_energy_and_moment_of_momentum() {
    let guide = Land {
        clearance: 50e-6,
        ..land(Side::Outer)
    };
    for rates in [
        [0.1, 0.4, 0.01, 0.0, 0.0, 0.0],
        [0.1, 0.4, 0.01, 2.0, -1.0, 0.0],
        [0.1, 0.4, 0.01, 2.0, -1.0, 10.0],
    ] {
        let mut hits = 0;
        let [energy, moment] = thrown(Some(guide), [20e-6, 0.0], rates, |state| {
            hits += cage_of(state).met[18..].iter().filter(|v| **v > 0.0).count();
        });
        println!("{rates:?}: {energy:e} {moment:e}");
        assert!(hits > 5, "{hits}");
        assert!(energy < 1e-12, "{rates:?}: {energy:e}");
        assert!(moment < 1e-12, "{rates:?}: {moment:e}");
    }
}

/// Wrong: a cage that meets nothing would be pushed. Its momentum, energy and moment of momentum stay to 1e-12.
#[test]
fn a_cage_that_meets_nothing_keeps_its_momentum() {
    let rates = [0.1, 0.4, 0.01, 0.2, -0.1, 10.0];
    let [energy, moment] = thrown(None, [20e-6, 0.0], rates, |state| {
        for (now, first) in cage_of(state).rates.iter().zip(rates).take(3) {
            assert!((now / first - 1.0).abs() < 1e-12, "{now} {first}");
        }
    });
    println!("{energy:e} {moment:e}");
    assert!(energy < 1e-12 && moment < 1e-12, "{energy:e} {moment:e}");
}

/// Wrong: a ball would rebound from its pocket with another restitution. A ball without friction runs into a heavy
/// cage: to 1e-3 in the limit of small steps, for any restitution and speed.
#[test]
fn a_ball_rebounds_from_its_pocket_with_the_restitution_given() {
    for (restitution, speed, stiffness) in [
        (0.3, 0.2, 2e8),
        (0.6, 0.02, 2e8),
        (0.6, 1.0, 2e8),
        (0.6, 0.2, 2e9),
        (0.9, 0.2, 2e8),
        (1.0, 0.2, 2e8),
    ] {
        let speeds = RingSpeeds::from(Speed::constant(0.0));
        let mut model = freed(thrust(500.0), coulomb(0.0, Creep::Elastic), &speeds);
        model.cage = Some(Cage {
            mass: 1e6,
            polar: 1e6,
            transverse: 1e6,
            pocket_clearance: 10e-6,
            restitution,
            stiffness,
            friction: 0.0,
            ..cage()
        });
        let motion = Motion::new(&model, settings(1e-6, &speeds)).unwrap();
        let mut start = motion.start(&equilibrium(&model));
        let free = start.free.as_mut().unwrap();
        let [x, y, _] = free.places[0];
        let out = x.hypot(y);
        free.velocities[0] = [-speed * y / out, speed * x / out, 0.0];
        let mut state = motion.with_energies(start);
        let (mut cache, mut has_met) = (StepCache::default(), false);
        for _ in 0..4000 {
            (state, _) = motion.step(&state, &mut cache).unwrap();
            let touches = cage_of(&state).met[0] > 0.0;
            if has_met && !touches {
                break;
            }
            has_met |= touches;
        }
        let found = -state.free.as_ref().unwrap().orbit(0) * out / speed;
        println!("{restitution} {speed} {stiffness}: {found}");
        assert!(
            has_met && (found - restitution).abs() < 1e-3,
            "{restitution} {speed}: {found}"
        );
    }
}

/// A cage without friction in a bearing under steady thrust, thrown with a share of the balls' speed: mean speed of the
/// balls, its own over the last third of the run, and the largest force of a pocket in three parts of the run.
fn thrown_between_balls(share: f64) -> ([f64; 2], [f64; 3]) {
    let speeds = RingSpeeds::from(Speed::constant(rpm(3000.0)));
    let mut model = freed(thrust(1000.0), coulomb(0.07, Creep::Elastic), &speeds);
    model.cage = Some(Cage {
        friction: 0.0,
        pocket_clearance: 4e-6,
        restitution: 0.3,
        ..cage()
    });
    let motion = Motion::new(&model, with_ladder(1e-5, &speeds)).unwrap();
    let mut start = motion.start(&equilibrium(&model));
    let thrown = start.free.as_mut().unwrap().cage.as_mut().unwrap();
    thrown.rates[5] *= share;
    let (mut forces, mut turned) = ([0.0f64; 3], 0.0);
    let last = run(&motion, motion.with_energies(start), 3000, |state| {
        let pockets = cage_of(state).pockets.iter().flatten();
        let part = (state.step as usize - 1) / 1000;
        forces[part] = pockets.fold(forces[part], |m: f64, f| m.max(f.abs()));
        turned += if part == 2 {
            1e-5 * cage_of(state).rates[5]
        } else {
            0.0
        };
    });
    let free = last.free.as_ref().unwrap();
    let mean = (0..18).map(|ball| free.orbit(ball)).sum::<f64>() / 18.0;
    ([mean, turned / 1e-2], forces)
}

/// Wrong: balls that roll alike would not carry a cage that is too fast or too slow along, or would go on driving it.
/// Each impact leaves 0.3 of the speed between cage and balls, so that less and less force is left, and the mean speed
/// is that of the balls to the play of a pocket over the time.
#[test]
fn in_steady_thrust_balls_take_a_cage_without_friction_along() {
    for share in [0.95, 1.0, 1.05] {
        let ([mean, cage], forces) = thrown_between_balls(share);
        println!("{share}: {mean} {cage} {forces:?}");
        let play = 4e-6 / 32.5e-3 / 1e-2;
        assert!((cage - mean).abs() < play, "{share}: {cage} {mean}");
        // Without balls that yield and losses: the energy of the cage's inertia at 18 balls as strain.
        let speed = (share - 1.0) * mean * 32.5e-3;
        let energy = 0.5 * 1.2e-5 / 32.5e-3f64.powi(2) / 18.0 * speed * speed;
        let hit = 2e8 * (2.5 * energy / 2e8).powf(0.6);
        assert!(
            (forces[0] - hit).abs() <= 0.3 * hit + 0.01,
            "{share}: {forces:?} {hit}"
        );
        assert!(forces[2] < 0.05, "{share}: {forces:?}");
    }
}

/// Balls that advance and fall behind on their way round, under thrust and a radial force on a shaft that may tilt.
fn drifting(pocket_clearance: Option<f64>) -> (Vec<f64>, f64, f64) {
    let speeds = RingSpeeds::from(Speed::constant(rpm(6000.0)));
    let mut model = freed(thrust(1000.0), coulomb(0.07, Creep::Elastic), &speeds);
    model.effects.push(Box::new(RadialForce {
        value: 500.0,
        direction: 0.0,
        schedule: Schedule::Constant,
    }));
    let solution = equilibrium(&model);
    let orbits: Vec<f64> = solution
        .balls
        .iter()
        .map(|ball| ball.free.unwrap().orbit_rad_per_s)
        .collect();
    model.cage = pocket_clearance.map(|pocket_clearance| Cage {
        pocket_clearance,
        friction: 0.0,
        ..cage()
    });
    let (dt, n) = (2e-5, 1100);
    let motion = Motion::new(&model, with_ladder(dt, &speeds)).unwrap();
    let start = motion.start(&solution);
    let radius = model.geometry.ball_centre().radial;
    let mut turned = [0.0; 18];
    let mut before: Vec<f64> = (0..18)
        .map(|ball| start.free.as_ref().unwrap().azimuth(ball))
        .collect();
    let (mut largest, mut pressed) = (0.0f64, 0.0f64);
    run(&motion, start, n, |state| {
        let free = state.free.as_ref().unwrap();
        for ball in 0..18 {
            let now = free.azimuth(ball);
            turned[ball] += (now - before[ball] + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
                - std::f64::consts::PI;
            before[ball] = now;
        }
        let mean = turned.iter().sum::<f64>() / 18.0;
        largest = turned
            .iter()
            .fold(largest, |m, t| m.max((t - mean).abs() * radius));
        let pockets = free.cage.iter().flat_map(|cage| cage.pockets.as_flattened());
        pressed = pockets.fold(pressed, |m, f| m.max(f.abs()));
    });
    (orbits, largest, pressed)
}

/// Wrong: orbits round a loaded bearing would not bring balls together and apart as their contact angles have it. The
/// drift of a ball against the others is the integral of its speed over the mean along its way round. Speeds are those
/// of the equilibrium, which leaves out how fast the place of a ball changes: 10 %. With more clearance than the drift
/// no pocket presses, with less balls touch.
#[test]
fn balls_drift_by_the_integral_of_their_speeds_and_meet_the_cage_where_it_is_narrower() {
    let (orbits, found, _) = drifting(None);
    // Fourier series of the speeds at 18 places, integrated.
    let mean = orbits.iter().sum::<f64>() / 18.0;
    let wave = |k: usize, phase: f64| {
        let at = |ball: usize| (k as f64 * std::f64::consts::TAU * ball as f64 / 18.0 + phase).cos();
        (0..18)
            .map(|ball| (orbits[ball] / mean - 1.0) * at(ball))
            .sum::<f64>()
            / 9.0
    };
    let waves: Vec<[f64; 2]> = (1..9)
        .map(|k| [wave(k, 0.0), wave(k, -0.5 * std::f64::consts::PI)])
        .collect();
    let drift = |psi: f64| {
        let of = |(i, [c, s]): (usize, &[f64; 2])| {
            let k = (i + 1) as f64;
            (c * (k * psi).sin() - s * (k * psi).cos()) / k
        };
        waves.iter().enumerate().map(of).sum::<f64>()
    };
    // From where a ball starts to wherever it comes; the mean of all balls does not drift.
    let values: Vec<f64> = (0..360).map(|i| drift(f64::from(i).to_radians())).collect();
    let start = |ball: usize| values[20 * ball];
    let furthest = |from: f64| values.iter().fold(0.0f64, |m, v| m.max((v - from).abs()));
    let expected = 32.512e-3 * (0..18).map(start).map(furthest).fold(0.0f64, f64::max);
    println!("drift {found:e} expected {expected:e}");
    assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
    let (_, _, free) = drifting(Some(4.0 * expected));
    let (_, _, narrow) = drifting(Some(0.4 * expected));
    println!("forces {free} {narrow}");
    assert!(free == 0.0 && narrow > 0.1, "{free} {narrow}");
}

/// Azimuth, deg, at which a ball begins to press its pocket, and the largest force of that touch, N, positive where it
/// presses on; by ball, those of the settled way round.
type Touches = Vec<Vec<[f64; 2]>>;

/// Balls on a shaft that keeps straight, under thrust and a radial force, in pockets narrower than their drift:
/// touches of the last two ways round, and the sum of the sizes of all forces along them, N.
fn touched() -> ([Touches; 2], Vec<f64>) {
    let speeds = RingSpeeds::from(Speed::constant(rpm(6000.0)));
    let mut model = freed(thrust(1000.0), coulomb(0.07, Creep::Elastic), &speeds);
    model.effects.push(Box::new(RadialForce {
        value: 2000.0,
        direction: 0.0,
        schedule: Schedule::Constant,
    }));
    (3..5).for_each(|tilt| model.shaft[tilt] = ShaftDof::Prescribed(0.0));
    model.cage = Some(Cage {
        pocket_clearance: 20e-6,
        friction: 0.0,
        restitution: 0.3,
        ..cage()
    });
    let (dt, settling) = (2e-5, 3500);
    let motion = Motion::new(&model, with_ladder(dt, &speeds)).unwrap();
    let start = run(&motion, motion.start(&equilibrium(&model)), settling, |_| {});
    let orbits = start.free.as_ref().unwrap();
    let mean = (0..18).map(|ball| orbits.orbit(ball)).sum::<f64>() / 18.0;
    let turn = (std::f64::consts::TAU / mean / dt).round() as usize;
    let (mut touches, mut sums) = ([(); 2].map(|()| vec![Vec::new(); 18]), Vec::new());
    let (mut pressed, mut ways) = ([true; 18], [0; 18]);
    // What has begun to touch is seen to its end.
    run(&motion, start, 2 * turn + turn / 20, |state| {
        let free = state.free.as_ref().unwrap();
        let forces: Vec<f64> = cage_of(state).pockets.iter().map(|force| force[0]).collect();
        for (ball, &force) in forces.iter().enumerate() {
            if force != 0.0 && !pressed[ball] {
                ways[ball] = sums.len() / turn;
                let azimuth = free.azimuth(ball).to_degrees().rem_euclid(360.0);
                let of_way: Option<&mut Touches> = touches.get_mut(ways[ball]);
                of_way.into_iter().for_each(|all| all[ball].push([azimuth, 0.0]));
            }
            pressed[ball] = force != 0.0;
            let last = touches.get_mut(ways[ball]).and_then(|all| all[ball].last_mut());
            if let (true, Some(last)) = (pressed[ball], last) {
                last[1] = if force.abs() > last[1].abs() {
                    force
                } else {
                    last[1]
                };
            }
        }
        sums.push(forces.iter().map(|f| f.abs()).sum());
    });
    sums.truncate(2 * turn);
    (touches, sums)
}

/// Wrong: forces of the cage would come at other times than those at which balls run together and apart. A settled ball
/// touches its pocket at the same places on every way round, as all others do, in front and behind by turns; so all
/// forces together repeat with the ball pass frequency of a place in space.
#[test]
fn drifting_balls_touch_once_per_turn_at_each_place_and_together_at_the_ball_pass_frequency() {
    let ([first, second], sums) = touched();
    println!("{:?}", second[0]);
    let places = &second[0];
    assert!(places.len() >= 2 && places.len().is_multiple_of(2), "{places:?}");
    for own in first.iter().chain(&second) {
        assert_eq!(own.len(), places.len(), "{own:?} {places:?}");
        for place in places {
            let away = |touch: &&[f64; 2]| ((touch[0] - place[0] + 180.0).rem_euclid(360.0) - 180.0).abs();
            let nearest = own.iter().min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
            // What impacts of neighbours leave of the cage's wobble.
            assert!(away(&nearest) < 4.0, "{own:?} {places:?}");
            assert!((nearest[1] / place[1] - 1.0).abs() < 0.2, "{own:?} {places:?}");
        }
        assert!(own.windows(2).all(|two| two[0][1] * two[1][1] < 0.0), "{own:?}");
    }
    // The share of the lines at multiples of the ball pass frequency in the whole variation.
    let n = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / n;
    let variance = sums.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / n;
    let line = |per_turn: usize| {
        let phase = |i: usize| std::f64::consts::TAU * 2.0 * per_turn as f64 * i as f64 / n;
        let of = |wave: fn(f64) -> f64| {
            sums.iter()
                .enumerate()
                .map(|(i, f)| f * wave(phase(i)))
                .sum::<f64>()
        };
        2.0 * (of(f64::cos).powi(2) + of(f64::sin).powi(2)) / (n * n)
    };
    let share = (1..20).map(|k| line(18 * k)).sum::<f64>() / variance;
    println!("share of the ball pass frequency {share}");
    assert!(share > 0.9, "{share}");
}
