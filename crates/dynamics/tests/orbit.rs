//! The way of the balls round the bearing: modes at speed beside a motion, and damping of contacts that balls pass.

use contact::Side;
use dynamics::interactions::contact_damping::{ContactDamping, coefficient};
use dynamics::kinematics::{Kinematics, RingSpeeds, Speed};
use dynamics::model::ShaftInertia;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::whirl::{TurningShaft, Whirl, WhirlMode, turning_inertia};
use dynamics::{
    ContactMode, DampingLaws, Hold, Linearisation, Model, ShaftDof, StaticSolution, StaticSolver,
};

use crate::support::lines::{PUSH, Push, line_at, line_near, of_middle_rule};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, states_from};

const SPEED: f64 = 4000.0;
const DAMPING: ContactDamping = ContactDamping {
    coefficient: 30.0,
    full_approach: 1e-6,
};

/// A light rotor on rigid rings: its balls have a fifth of its mass.
fn rotor() -> Model {
    let mut model = Case {
        load_point: 15e-3,
        ..Case::axial(2000.0)
    }
    .rigid();
    model.shaft = [ShaftDof::Free; 5];
    model.shaft_mass = 0.25;
    model.shaft_inertia = ShaftInertia {
        transverse: 2.4e-4,
        polar: 3.1e-4,
    };
    model
}

fn orbit(model: &Model) -> f64 {
    Kinematics::new(&model.geometry, [0.0; 2]).of_cage([SPEED, 0.0])
}

fn laws(damping: Option<ContactDamping>) -> DampingLaws {
    DampingLaws {
        contacts: damping,
        rings: None,
    }
}

/// Modes across the axis, with balls that go round with `orbit`, rad/s.
fn modes(model: &Model, damping: Option<ContactDamping>, orbit: f64) -> Vec<WhirlMode> {
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve(model, None).unwrap();
    let bearing = Linearisation::new(model, &solver, &solution, laws(damping)).unwrap();
    let bearing = bearing.passing(orbit).going_round(model.ball_mass(), orbit);
    let inertia = turning_inertia(model).unwrap();
    let shaft = TurningShaft::new(model, &bearing, inertia, SPEED).unwrap();
    let all = shaft.modes().unwrap().into_iter();
    all.filter(|m| m.shaft_share > 0.5 && m.whirl != Whirl::Axial)
        .collect()
}

/// x and y of the shaft in time after a push.
fn record(damping: Option<ContactDamping>, (dt, n): (f64, usize)) -> Vec<[f64; 2]> {
    let mut model = rotor();
    let start = equilibrium(&model);
    model.effects.push(Box::new(Push));
    let settings = MotionSettings {
        contact_damping: damping,
        ..MotionSettings::conserving(dt, Speed::constant(SPEED))
    };
    let motion = Motion::new(&model, settings).unwrap();
    let (mut state, mut cache) = (motion.start(&start), StepCache::default());
    let mut record = vec![];
    for step in 0..n {
        state = motion.step(&state, &mut cache).unwrap().0;
        if dt * step as f64 > PUSH[0] {
            record.push([state.shaft[0], state.shaft[1]]);
        }
    }
    record
}

fn signed(mode: &WhirlMode) -> f64 {
    match mode.whirl {
        Whirl::Backward => -mode.frequency,
        _ => mode.frequency,
    }
}

/// Wrong: modes at speed would lack the inertia of balls on their way round, which a motion has. A light rotor, whose
/// balls have a fifth of its mass, moves in time after a push; the lines of its pairs are where the modes say. With
/// balls that stand they are off by some per cent.
#[test]
fn a_rotor_whirls_in_time_as_its_modes_with_balls_on_their_way_say() {
    let dt = 2e-6;
    let record = record(None, (dt, 12000));
    let model = rotor();
    let [still, going] = [0.0, orbit(&model)].map(|orbit| modes(&model, None, orbit));
    let worst = |modes: &[WhirlMode]| {
        let off = modes.iter().take(4).map(|mode| {
            let found = of_middle_rule(line_near(&record, dt, signed(mode)), dt);
            println!("{:.3} Hz, in time {found:.3}", signed(mode));
            (found / signed(mode) - 1.0).abs()
        });
        off.fold(0.0, f64::max)
    };
    let [with, without] = [&going, &still].map(|modes| worst(modes));
    assert!(with < 1e-5, "{with}");
    assert!(without > 1e-2, "{without}");
}

/// Wrong: contacts would be damped as if their balls stood, in motion or in modes: damping that goes round with the
/// balls takes less from a shaft that whirls along with them, and more from one that whirls against them. By two halves
/// of a record in time.
#[test]
fn damping_goes_round_with_the_balls() {
    let (dt, n) = (2e-6, 16000);
    let damping = Some(ContactDamping {
        coefficient: 10.0,
        ..DAMPING
    });
    let record = record(damping, (dt, n));
    let model = rotor();
    let [still, going] = [0.0, orbit(&model)].map(|orbit| modes(&model, damping, orbit));
    let half = record.len() / 2;
    for (with, without) in going.iter().zip(&still).take(4) {
        let line = line_near(&record, dt, signed(with));
        let [first, last] = [&record[..half], &record[half..2 * half]].map(|part| line_at(part, dt, line));
        let rate = (first / last).ln() / (half as f64 * dt);
        let found = rate / (std::f64::consts::TAU * with.frequency);
        println!(
            "{:.2} Hz: {:.4e}, in time {found:.4e}, of balls that stand {:.4e}",
            signed(with),
            with.damping_ratio,
            without.damping_ratio
        );
        let off = [with, without].map(|mode| (found / mode.damping_ratio - 1.0).abs());
        // The low pair turns about where the contacts' lines meet, and hardly presses them.
        let [most, least] = match with.damping_ratio {
            ratio if ratio < 1e-4 => [3e-2, 0.15],
            _ => [4e-3, 0.03],
        };
        assert!(off[0] < most && off[1] > least, "{off:?}");
    }
}

/// Wrong: balls that pass a shaft under a load across would not be pressed and let go against damping. With the
/// approaches d of the equilibria along the way of a ball, damping presses the shaft by the sum of c W d' along the
/// normals, and loses c (W d')^2; the shaft moves across the load, and what moves the balls round brings the loss.
#[test]
fn damping_moves_a_shaft_across_its_load() {
    let model = loaded(0.0);
    let start = equilibrium(&model);
    let settings = MotionSettings {
        contact_damping: Some(DAMPING),
        ..MotionSettings::conserving(1e-5, Speed::constant(SPEED))
    };
    let motion = Motion::new(&model, settings).unwrap();
    let (mut state, mut cache) = (motion.start(&start), StepCache::default());
    // Balls pass 18 times in a turn of the cage; the second half is taken as steady.
    let turn = (std::f64::consts::TAU / orbit(&model) / 1e-5).round() as usize;
    let (mut across, mut before) = (0.0, state.ledger);
    for step in 0..2 * turn {
        if step == turn {
            before = state.ledger;
        }
        state = motion.step(&state, &mut cache).unwrap().0;
        if step >= turn {
            across += state.shaft[1] / turn as f64;
        }
    }
    let (expected, loss) = of_passing(turn as f64 * 1e-5);
    let found = state.ledger.contact_loss - before.contact_loss;
    println!("across {across:.5e} m, {expected:.5e}; loss {found:.5e} J, {loss:.5e}");
    assert!((across / expected - 1.0).abs() < 1e-2, "{across} {expected}");
    assert!((found / loss - 1.0).abs() < 1e-2, "{found} {loss}");
    let brought = state.ledger.patch_work - before.patch_work;
    assert!((brought / found - 1.0).abs() < 1e-2, "{brought} {found}");
    assert!(state.ledger.defect().abs() < 1e-9 * state.ledger.largest);
}

/// A bearing under a load across, whose first ball stands at this azimuth.
fn loaded(phase: f64) -> Model {
    let mut model = Case {
        radial: 500.0,
        phase,
        ..Case::axial(1000.0)
    }
    .rigid();
    model.shaft_mass = 1.0;
    model
}

/// Displacement of the shaft across its load, m, and the loss in a time, J, by equilibria alone.
fn of_passing(time: f64) -> (f64, f64) {
    let model = loaded(0.0);
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let linear = Linearisation::new(&model, &solver, &solution, laws(None)).unwrap();
    let (stiffness, w, step) = (linear.stiffness().unwrap(), orbit(&model), 1e-3);
    let [low, high] = [-step, step].map(|phase| equilibrium(&loaded(phase)));
    let (mut force, mut loss) = (0.0, 0.0);
    for (ball, at) in solution.balls.iter().enumerate() {
        let approach = |of: &StaticSolution, side: Side| of.balls[ball].contact(side).approach_m;
        let of_side = |side: Side| {
            let rate = w * (approach(&high, side) - approach(&low, side)) / (2.0 * step);
            let d = approach(&solution, side);
            let [c, _] = coefficient(&DAMPING, d);
            // Stiffnesses of contacts under one force go with 1/d.
            (c * rate, c * rate * rate, 1.0 / d)
        };
        let [inner, outer] = Side::BOTH.map(of_side);
        loss += (inner.1 + outer.1) * time;
        // The ball gives way until both press it alike.
        let pressed = (inner.2 * outer.0 + outer.2 * inner.0) / (inner.2 + outer.2);
        force -= pressed * at.contact(Side::Inner).contact_angle_rad.cos() * at.azimuth_rad.sin();
    }
    (force / stiffness[1][1], loss)
}

/// Wrong: damping on elastic rings, which are measured in frames that turn with them, would go round with their speed
/// besides that of the balls: a shaft would leave the direction of its load several times as far. Elastic rings at four
/// pairs of speeds, in time and by the matrices of the equilibrium.
#[test]
fn damping_goes_round_with_the_balls_along_elastic_rings() {
    let mut model = Case {
        radial: 300.0,
        ..Case::axial(1000.0)
    }
    .flexible(ContactMode::Patch, Level::hex8(36, 4, 1, 1), Hold::Clamped);
    model.shaft_mass = 1.0;
    let damping = ContactDamping {
        coefficient: 2e4,
        full_approach: 1e-7,
    };
    let mut solver = StaticSolver::new(&model).unwrap();
    let start = solver.solve(&model, None).unwrap();
    let linear = || Linearisation::new(&model, &solver, &start, laws(Some(damping))).unwrap();
    for speeds in [[600.0, 0.0], [0.0, 600.0], [600.0, -600.0], [600.0, 600.0]] {
        let orbit = Kinematics::new(&model.geometry, [0.0; 2]).of_cage(speeds);
        let (stiffness, _) = linear().passing(orbit).of_shaft().unwrap();
        let expected = -stiffness[1][0] / stiffness[1][1];
        let [inner, outer] = speeds.map(Speed::constant);
        let settings = MotionSettings {
            contact_damping: Some(damping),
            ..MotionSettings::conserving(1e-5, RingSpeeds { inner, outer })
        };
        let motion = Motion::new(&model, settings).unwrap();
        let states = states_from(&motion, motion.start(&start), 500);
        let late = &states[250..];
        let [x, y] = [0, 1].map(|dof| late.iter().map(|state| state.shaft[dof]).sum::<f64>());
        println!("{speeds:?}: {:.5}, {expected:.5}", y / x);
        assert!((y / x - expected).abs() < 1e-3 * expected.abs(), "{speeds:?}");
        assert!(states[500].ledger.defect().abs() < 1e-9 * states[500].ledger.largest);
    }
}

/// Wrong: rotor dynamics would be given damping that stands, of a rotor that is stable at all speeds. A damping c that
/// goes round with W pulls across by c W, on shifts and tilts alike.
#[test]
fn the_stiffness_of_the_shaft_has_damping_that_goes_round() {
    let model = rotor();
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let light = ContactDamping {
        coefficient: 0.03,
        ..DAMPING
    };
    let linear = |law| Linearisation::new(&model, &solver, &solution, laws(law)).unwrap();
    let (w, of) = (orbit(&model), linear(Some(light)).passing(orbit(&model)));
    let (with, damping) = of.of_shaft().unwrap();
    let (without, damping) = (linear(None).stiffness().unwrap(), damping.unwrap());
    // d/dpsi of a shift along x is one along y, of a tilt about x one about y.
    for (i, j, k, sign) in [(0, 1, 0, 1.0), (1, 0, 1, -1.0), (3, 4, 3, 1.0), (4, 3, 4, -1.0)] {
        let (found, expected) = (with[i][j] - without[i][j], sign * w * damping[i][k]);
        assert!(
            (found / expected - 1.0).abs() < 1e-6,
            "{i} {j}: {found} {expected}"
        );
    }
    assert!((with[2][2] / without[2][2] - 1.0).abs() < 1e-9);
    // Without damping nothing changes, bit for bit.
    let still = linear(None).passing(w).stiffness().unwrap();
    assert!(still == without);
}

/// Wrong: of a shaft that has tilted, damping that goes round would be that of an upright one; a slow mode that hardly
/// presses its contacts then has a damping ratio that is off by per cents. By whole equilibria of displaced shafts: a
/// contact whose approach is d(q) closes by W d'(q) as its ball passes, with d' over all balls.
#[test]
fn damping_goes_round_a_tilted_shaft() {
    let mut model = rotor();
    // The shaft goes where all balls stay loaded.
    model.shaft[3..].copy_from_slice(&[1.5e-3, -0.8e-3].map(ShaftDof::Prescribed));
    let at = equilibrium(&model).displacements.shaft;
    let light = ContactDamping {
        coefficient: 0.03,
        full_approach: 1e-9,
    };
    let displaced = |model: &mut Model, q: [f64; 5]| {
        model.shaft = q.map(ShaftDof::Prescribed);
        equilibrium(model)
    };
    let centre = displaced(&mut model, at);
    let solver = StaticSolver::new(&model).unwrap();
    let linear = |law| Linearisation::new(&model, &solver, &centre, laws(law)).unwrap();
    let w = orbit(&model);
    let with = linear(Some(light)).passing(w).stiffness().unwrap();
    let without = linear(None).stiffness().unwrap();

    let sizes = [1e-8, 1e-8, 1e-8, 1e-6, 1e-6];
    let mut grown = vec![];
    for (dof, h) in sizes.into_iter().enumerate() {
        let mut of = |by: f64| {
            let mut q = at;
            q[dof] += by;
            displaced(&mut model, q).balls
        };
        let [low, high] = [of(-h), of(h)];
        let of_side = |side: Side| {
            let pairs = low.iter().zip(&high).map(move |pair| {
                let [a, b] = [pair.0, pair.1].map(|ball| ball.contact(side).approach_m);
                (b - a) / (2.0 * h)
            });
            pairs.collect::<Vec<f64>>()
        };
        grown.push(Side::BOTH.map(of_side));
    }
    let n = centre.balls.len();
    let slope = |of: &[f64], i: usize| {
        let others = (0..n).filter(|j| *j != i).map(|j| {
            let half = std::f64::consts::PI * (i as f64 - j as f64) / n as f64;
            let sign = if (i + j).is_multiple_of(2) { 0.5 } else { -0.5 };
            of[j] * sign
                / if n.is_multiple_of(2) {
                    half.tan()
                } else {
                    half.sin()
                }
        });
        others.sum::<f64>()
    };
    let entry = |i: usize, j: usize| {
        let of_side = |side: usize| {
            (0..n)
                .map(|k| grown[i][side][k] * slope(&grown[j][side], k))
                .sum::<f64>()
        };
        0.03 * w * (of_side(0) + of_side(1))
    };
    let arm = model.geometry.centre_radius(Side::Inner);
    let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / arm };
    let largest = entry(0, 1).abs();
    for (i, j) in (0..25).map(|k| (k / 5, k % 5)) {
        let off = (with[i][j] - without[i][j] - entry(i, j)).abs() * scale(i) * scale(j) / largest;
        assert!(
            off < 2e-5,
            "{i} {j}: {off:e} {} {}",
            with[i][j] - without[i][j],
            entry(i, j)
        );
    }
}
