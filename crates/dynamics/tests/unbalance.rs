//! An unbalanced shaft: tilting moment, momentum, the Jeffcott rotor, the ledger, equilibria of a turning bearing.

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use contact::Side;
use dynamics::effects::unbalance::Unbalance;
use dynamics::effects::{self, Now, RadialForce};
use dynamics::kinematics::{Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, QuasiStaticMotion, ShaftDof};
use input::Schedule;

/// Mass times eccentricity, kg m.
const MOMENT: f64 = 2e-5;
/// One that moves the shaft by much less than its contacts approach, kg m.
const SMALL_MOMENT: f64 = 1e-7;
/// Where it stands on the ring at the start, rad.
const ANGLE: f64 = 0.4;

fn unbalanced(mut model: Model, speed: &Speed, position: f64) -> Model {
    model.effects.push(Box::new(Unbalance {
        speed: speed.clone(),
        moment: MOMENT,
        angle: ANGLE,
        position,
    }));
    model
}

/// Direction to the mass and its rate in space.
fn directions(speed: &Speed, time: f64) -> [[f64; 2]; 2] {
    let (sin, cos) = (ANGLE + speed.angle(time)).sin_cos();
    let rate = speed.at(time);
    [[cos, sin], [-rate * sin, rate * cos]]
}

fn run(motion: &Motion<'_>, start: MotionState, n: usize, mut each: impl FnMut(&MotionState)) {
    let (mut state, mut cache) = (start, StepCache::default());
    for _ in 0..n {
        state = motion.step(&state, &mut cache).unwrap().0;
        each(&state);
    }
}

/// Wrong: an unbalance off the groove plane would not tilt, or the other way than a force at that place does. Position
/// e_z x F, and nothing on balls and rings.
#[test]
fn off_the_groove_plane_it_tilts_as_a_force_there_does() {
    let speed = Speed::constant(300.0);
    let mut model = Case::axial(0.0).rigid();
    model.effects.clear();
    let bare = effects::Loads::none(model.geometry.n_balls);
    let model = unbalanced(model, &speed, 0.04);
    let found = model.loads(&Now::default()).unwrap();
    let force = [ANGLE.cos(), ANGLE.sin()].map(|x| MOMENT * 9e4 * x);
    let expected = [force[0], force[1], 0.0, -0.04 * force[1], 0.04 * force[0]];
    for (a, b) in found.shaft.iter().zip(expected) {
        assert!((a - b).abs() < 1e-15, "{:?}", found.shaft);
    }
    assert_eq!(found.lever, [0.04 * force[0], 0.04 * force[1], 0.0]);
    let rest = effects::Loads {
        shaft: [0.0; 5],
        lever: [0.0; 3],
        ..found
    };
    assert_eq!(rest, bare);
}

/// A shaft of 4 kg that no ball touches.
fn floating(speed: &Speed) -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.effects.clear();
    model.geometry.inner_raceway_diameter -= 0.1e-3;
    let back = model.geometry.ball_centre().axial - model.geometry.groove_centre(Side::Inner).axial;
    model.shaft[2] = ShaftDof::Prescribed(back);
    model.shaft_mass = 4.0;
    unbalanced(model, speed, 0.0)
}

/// Wrong: momentum would come from nowhere while the speed changes. M v + m e d/dt (cos psi, sin psi) is kept to
/// round-off at every step, over both corners of a ramp that lie inside of steps. Without any momentum the shaft goes
/// round the common centre of mass, x = -(m e / M) (cos psi, sin psi); the trapezoidal rule is off by (Omega dt)^2 /
/// 12 a step.
#[test]
fn a_free_shaft_and_its_unbalance_keep_their_momentum() {
    let speed = Speed::table(vec![0.93e-3, 2.57e-3], vec![500.0, 1500.0]);
    let model = floating(&speed);
    let motion = Motion::new(&model, MotionSettings::conserving(1e-4, speed.clone())).unwrap();
    let momentum = |state: &MotionState, time: f64| {
        let [_, rate] = directions(&speed, time);
        [0, 1].map(|i| model.shaft_mass * state.shaft_velocity[i] + MOMENT * rate[i])
    };
    let share = -MOMENT / model.shaft_mass;
    let [direction, rate] = directions(&speed, 0.0);
    let planar = |v: [f64; 2]| [share * v[0], share * v[1], 0.0, 0.0, 0.0];
    let start = motion.rest(planar(direction), planar(rate));
    let scale = MOMENT * 1500.0;
    let mut fastest = 0.0f64;
    run(&motion, start, 40, |state| {
        let now = momentum(state, motion.time(state.step));
        let change = now[0].hypot(now[1]) / scale;
        assert!(change < 1e-12, "step {}: {change:.1e}", state.step);
        let [direction, _] = directions(&speed, motion.time(state.step));
        let off = [0, 1].map(|i| state.shaft[i] / share - direction[i]);
        assert!(off[0].hypot(off[1]) < 0.01, "step {}: {off:?}", state.step);
        fastest = fastest.max(state.shaft_velocity[0].abs());
        assert!(state.ledger.relative_defect().abs() < 1e-11, "{:?}", state.ledger);
    });
    assert!(fastest > 0.2 * scale, "{fastest}: it does not move");
}

/// Wrong: size or phase of the whirl of a Jeffcott rotor. On a spring of stiffness k its amplitude is m e Omega^2 /
/// (k - M Omega^2): with the mass below resonance, against it above, where it turns about its centre of mass.
#[test]
fn the_whirl_is_that_of_a_jeffcott_rotor() {
    let preload = 500.0;
    let stiffness = {
        let at = |radial: f64| {
            let case = Case {
                radial,
                ..Case::axial(preload)
            };
            equilibrium(&case.rigid()).displacements.shaft[0]
        };
        1.0 / at(1.0)
    };
    let mass = 8.0f64;
    let natural = (stiffness / mass).sqrt();
    for ratio in [0.5, 3.0] {
        let omega = ratio * natural;
        let speed = Speed::constant(omega);
        let mut model = Case::axial(preload).rigid();
        model.effects.push(Box::new(Unbalance {
            speed: speed.clone(),
            moment: SMALL_MOMENT,
            angle: ANGLE,
            position: 0.0,
        }));
        model.shaft_mass = mass;
        let amplitude = SMALL_MOMENT * omega * omega / (stiffness - mass * omega * omega);
        let turn = 2.0 * std::f64::consts::PI / omega;
        let motion = Motion::new(&model, MotionSettings::conserving(turn / 400.0, speed.clone())).unwrap();
        // From the equilibrium without unbalance onto its orbit; balls follow within their own high frequencies.
        let centre = equilibrium(&Case::axial(preload).rigid());
        let mut start = motion.start(&centre);
        let [direction, rate] = directions(&speed, 0.0);
        for i in 0..2 {
            start.shaft[i] = amplitude * direction[i];
            start.shaft_velocity[i] = amplitude * rate[i];
        }
        let start = motion.with_energies(start);
        let mut worst = 0.0f64;
        run(&motion, start, 400, |state| {
            let [direction, _] = directions(&speed, motion.time(state.step));
            let off = [0, 1].map(|i| state.shaft[i] - amplitude * direction[i]);
            worst = worst.max(off[0].hypot(off[1]) / amplitude.abs());
        });
        // 54 g of balls move along with 8 kg, and the stiffness is that of small displacements.
        println!(
            "{ratio} of resonance: amplitude {:.3} um, off by {worst:.1e}",
            1e6 * amplitude
        );
        assert!(worst < 0.01, "{ratio}: {worst}");
    }
}

/// Wrong: the work of the force would be missing in the ledger, with rigid or with flexible rings, while the speed
/// changes.
#[test]
fn the_ledger_closes_with_an_unbalance() {
    let speed = Speed::table(vec![0.1e-3, 0.5e-3], vec![800.0, 2000.0]);
    let flexible = Case::axial(500.0).flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::Clamped);
    for model in [Case::axial(500.0).rigid(), flexible] {
        let mut model = unbalanced(model, &speed, 0.02);
        model.shaft_mass = 2.0;
        let motion = Motion::new(&model, MotionSettings::conserving(1e-5, speed.clone())).unwrap();
        let mut work = 0.0;
        run(&motion, motion.start(&equilibrium(&model)), 60, |state| {
            let defect = state.ledger.relative_defect();
            assert!(defect.abs() < 1e-9, "step {}: {defect}", state.step);
            work = state.ledger.load_work;
        });
        assert!(work.abs() > 1e-9, "{work}: the load does no work");
    }
}

/// Wrong: an equilibrium in time would have the force of another instant. It is that of a bearing under a radial
/// force of the same size and direction, to the round-off that Newton leaves.
#[test]
fn equilibria_in_time_are_those_under_its_force() {
    let speed = Speed::constant(600.0);
    let plain = Case::axial(500.0).rigid();
    let model = unbalanced(Case::axial(500.0).rigid(), &speed, 0.0);
    let rolling = |model: &Model| Rolling::new(&model.geometry, speed.clone(), [0.0; 2]);
    let mut turning = QuasiStaticMotion::new(&model, rolling(&model), 1e-3).unwrap();
    for step in 0..4 {
        let found = turning.step(step, None).unwrap();
        let mut pushed = Case::axial(500.0).rigid();
        pushed.effects.push(Box::new(RadialForce {
            value: MOMENT * 3.6e5,
            direction: ANGLE + 0.6 * step as f64,
            schedule: Schedule::Constant,
        }));
        let mut fixed = QuasiStaticMotion::new(&pushed, rolling(&plain), 1e-3).unwrap();
        let expected = fixed.step(step, None).unwrap();
        for (a, b) in found.balls.iter().zip(&expected.balls) {
            assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-11, "step {step}");
        }
    }
}
