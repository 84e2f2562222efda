//! Modes at speed against the closed form of a rigid rotor on springs, a free gyroscope, modes at rest, and a motion.

use contact::Side;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::{Kinematics, Speed};
use dynamics::model::ShaftInertia;
use dynamics::modes::{ModesSettings, bearing_modes};
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::stiffness::ShaftMatrix;
use dynamics::whirl::{ShaftRow, TurningShaft, Whirl, WhirlMatrices, WhirlMode, turning_inertia};
use dynamics::{Backend, ContactMode, DampingLaws, Hold, Linearisation, Model, ShaftDof, StaticSolver};
use fem::Material;

use crate::support::lines::{PUSH, Push, line_near, of_middle_rule};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};

const INERTIA: ShaftInertia = ShaftInertia {
    transverse: 2.4e-4,
    polar: 3.1e-4,
};
const MASS: f64 = 0.6;

/// A rotor on a bearing under thrust, free in all directions, with balls of next to no mass.
fn rotor(axial: f64) -> Model {
    let mut model = Case::axial(axial).rigid();
    model.shaft = [ShaftDof::Free; 5];
    model.shaft_mass = MASS;
    model.shaft_inertia = INERTIA;
    model.ball_material = Material::new(207e9, 0.3, 1e-6).unwrap();
    model
}

/// Modes at a speed in rad/s, and the stiffness.
fn modes(model: &Model, speed: f64, laws: DampingLaws) -> (Vec<WhirlMode>, ShaftMatrix) {
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve(model, None).unwrap();
    let bearing = Linearisation::new(model, &solver, &solution, laws).unwrap();
    let inertia = turning_inertia(model).unwrap();
    let shaft = TurningShaft::new(model, &bearing, inertia, speed).unwrap();
    (shaft.modes().unwrap(), bearing.stiffness().unwrap())
}

/// Modes of balls that go round with their cage.
fn modes_going_round(model: &Model, speed: f64) -> Vec<WhirlMode> {
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve(model, None).unwrap();
    let bearing = Linearisation::new(model, &solver, &solution, DampingLaws::default()).unwrap();
    let orbit = Kinematics::new(&model.geometry, [0.0; 2]).of_cage([speed, 0.0]);
    let bearing = bearing.passing(orbit).going_round(model.ball_mass(), orbit);
    let inertia = turning_inertia(model).unwrap();
    let shaft = TurningShaft::new(model, &bearing, inertia, speed).unwrap();
    shaft.modes().unwrap()
}

/// Frequencies, rad/s, at which a rigid rotor whirls on springs that are alike round the axis; negative against the
/// spin. With u = x + i y and t = tilt_x + i tilt_y: (k - m w^2) u - i c t = 0, i c u + (k_t - I w^2 + I_p W w) t = 0.
fn closed_form(k: &ShaftMatrix, speed: f64) -> Vec<f64> {
    let coupling = k[1][3];
    let value = |w: f64| {
        let translation = k[0][0] - MASS * w * w;
        let tilt = k[3][3] - INERTIA.transverse * w * w + INERTIA.polar * speed * w;
        translation * tilt - coupling * coupling
    };
    // The four roots lie between samples that are much closer than they are.
    let (most, n) = (4e5, 400_000);
    let at = |i: usize| -most + 2.0 * most * i as f64 / n as f64;
    let mut roots = Vec::new();
    for i in 0..n {
        let (mut low, mut high) = (at(i), at(i + 1));
        if value(low).signum() == value(high).signum() {
            continue;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if value(middle).signum() == value(low).signum() {
                low = middle
            } else {
                high = middle
            }
        }
        roots.push(low);
    }
    roots
}

/// A shaft of 1 kg on the ground by a spring, and twelve balls of 10 g between both, each contact with 1e7 N/m and this
/// damping, N s/m.
fn shaft_and_equal_balls(damping: f64) -> TurningShaft {
    let n = 13;
    let of_contacts = |each: f64, ground: f64| {
        let mut matrix = vec![0.0; n * n];
        matrix[0] = ground + 12.0 * each;
        for i in 1..n {
            matrix[(n + 1) * i] = 2.0 * each;
            (matrix[i], matrix[n * i]) = (-each, -each);
        }
        matrix
    };
    let mut mass = of_contacts(0.0, 1.0);
    (1..n).for_each(|i| mass[(n + 1) * i] = 0.01);
    let matrices = WhirlMatrices {
        n,
        mass,
        rates: of_contacts(damping, 0.0),
        stiffness: of_contacts(1e7, 3e7),
    };
    TurningShaft::of_matrices(matrices, vec![ShaftRow { node: 0, dof: 0 }], 0.0)
}

/// Wrong: equal balls that creep back would pass for modes by what round-off makes of their frequency, or a mode that
/// swings be left out. Critical damping of balls between rings that stand is 2 sqrt(2 k m) / 2 = 447 N s/m.
#[test]
fn balls_that_creep_back_do_not_swing() {
    let critical = (2.0 * 1e7 * 0.01_f64).sqrt();
    let swinging = |damping: f64| -> Vec<WhirlMode> {
        let modes = shaft_and_equal_balls(damping).modes().unwrap();
        modes.into_iter().filter(WhirlMode::swings).collect()
    };
    assert_eq!(swinging(0.0).len(), 13);
    // Eleven of equal balls against each other, at a damping ratio of 0.99, and the shaft; all balls against the shaft
    // are damped by more.
    assert_eq!(swinging(0.99 * critical).len(), 12);
    let mut with_round_off = 0;
    for damping in [
        critical,
        1.1 * critical,
        3.0 * critical,
        10.0 * critical,
        100.0 * critical,
    ] {
        let all = shaft_and_equal_balls(damping).modes().unwrap();
        with_round_off += all
            .iter()
            .filter(|mode| mode.frequency > 0.0 && !mode.swings())
            .count();
        let swinging: Vec<&WhirlMode> = all.iter().filter(|mode| mode.swings()).collect();
        assert!(
            swinging.iter().all(|mode| mode.shaft_share > 0.5),
            "{damping}: {swinging:?}"
        );
        assert!(swinging.len() <= 1, "{damping}: {swinging:?}");
    }
    assert!(with_round_off > 0, "no round-off, so this shows nothing");
}

/// Wrong: a gyroscopic term would be missing or turn the wrong way, or forward and backward be exchanged. 4 degrees of
/// freedom in closed form, at speeds of both senses.
#[test]
fn a_rigid_rotor_on_springs_whirls_as_in_closed_form() {
    let model = rotor(1000.0);
    for speed in [500.0, 4000.0, -4000.0] {
        let (modes, k) = modes(&model, speed, DampingLaws::default());
        let mut expected = closed_form(&k, speed);
        assert_eq!(expected.len(), 4, "{expected:?}");
        expected.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let found: Vec<&WhirlMode> = modes[..5].iter().filter(|m| m.whirl != Whirl::Axial).collect();
        for (mode, w) in found.into_iter().zip(expected) {
            let f = w.abs() / std::f64::consts::TAU;
            assert!(
                relative(mode.frequency, f) < 1e-7,
                "{speed}: {} {f}",
                mode.frequency
            );
            let along = w * speed > 0.0;
            assert_eq!(mode.whirl, if along { Whirl::Forward } else { Whirl::Backward });
            assert!((mode.roundness.abs() - 1.0).abs() < 1e-6, "{}", mode.roundness);
            assert!(mode.damping_ratio.abs() < 1e-9 && mode.shaft_share > 0.999_999);
        }
        let axial = modes.iter().find(|m| m.whirl == Whirl::Axial).unwrap();
        let f = (k[2][2] / MASS).sqrt() / std::f64::consts::TAU;
        assert!(relative(axial.frequency, f) < 1e-7, "{} {f}", axial.frequency);
    }
}

/// Wrong: a fast rotor would not nutate as a free gyroscope, with I_p W / I. What the springs add is (w_0 / W)^2.
#[test]
fn a_fast_rotor_nutates_as_a_free_gyroscope() {
    let model = rotor(1.0);
    let ratio = INERTIA.polar / INERTIA.transverse;
    let off = [1e5, 2e5].map(|speed| {
        let (modes, _) = modes(&model, speed, DampingLaws::default());
        let nutation = modes[..5].last().unwrap();
        assert_eq!(nutation.whirl, Whirl::Forward);
        nutation.frequency * std::f64::consts::TAU / (ratio * speed) - 1.0
    });
    assert!(off[0] > 0.0 && off[0] < 1e-2, "{off:?}");
    assert!(
        (off[0] / off[1] - 4.0).abs() < 0.1,
        "the square of the speed: {off:?}"
    );
}

/// Wrong: without a spin the modes would not be those of `modes`: rigid rings, balls with their mass, a radial load.
#[test]
fn at_rest_they_are_the_natural_modes() {
    let mut model = Case {
        radial: 500.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    }
    .spheres();
    model.shaft_mass = MASS;
    model.shaft_inertia = INERTIA;
    let (modes, _) = modes(&model, 0.0, DampingLaws::default());
    assert_eq!(modes.len(), 41);
    let expected = natural(&model, 41);
    for (mode, f) in modes.iter().zip(&expected) {
        assert!(relative(mode.frequency, *f) < 1e-8, "{} {f}", mode.frequency);
        assert!(matches!(mode.whirl, Whirl::Planar | Whirl::Axial));
    }
}

fn natural(model: &Model, number: usize) -> Vec<f64> {
    let equilibrium = StaticSolver::new(model).unwrap().solve(model, None).unwrap();
    let settings = ModesSettings {
        number,
        shift: None,
        backend: Backend::Auto,
    };
    let set = bearing_modes(model, &equilibrium, settings, &mut |_| {}).unwrap();
    set.modes.iter().map(|mode| mode.frequency).collect()
}

/// Wrong: the mass of a flexible inner ring would not go with the shaft, or its tilt not be about the shaft's origin.
/// Rings yield without inertia of their own, and natural modes have patches that stay while the bearing tilts: the five
/// modes of the shaft are off by 5e-3 at most.
#[test]
fn flexible_rings_go_with_the_shaft() {
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let case = Case {
            free_tilt: true,
            ..Case::axial(2000.0)
        };
        let mut model = case.flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), hold);
        model.shaft_mass = 3.0;
        model.shaft_inertia = ShaftInertia {
            transverse: 3e-3,
            polar: 2e-3,
        };
        let (modes, _) = modes(&model, 0.0, DampingLaws::default());
        let expected = natural(&model, 5);
        for (mode, f) in modes.iter().zip(&expected) {
            eprintln!(
                "{hold:?}: {:.2} Hz, {:.2e} above {f:.2} Hz",
                mode.frequency,
                mode.frequency / f - 1.0
            );
            assert!(relative(mode.frequency, *f) < 6e-3, "{} {f}", mode.frequency);
        }
        assert!(
            turning_inertia(&model).unwrap().mass > 3.05,
            "the ring has a mass"
        );
    }
}

/// Wrong: damping of contacts would not be that of the modes. Along the axis: k and c in closed form, c/(2 sqrt(k m)).
#[test]
fn contacts_damp_the_axial_mode_as_in_closed_form() {
    let model = rotor(1000.0);
    let laws = DampingLaws {
        contacts: Some(ContactDamping {
            coefficient: 50.0,
            full_approach: 1e-6,
        }),
        rings: None,
    };
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let bearing = Linearisation::new(&model, &solver, &solution, laws).unwrap();
    let (k, c) = bearing.of_shaft().unwrap();
    let (modes, _) = modes(&model, 2000.0, laws);
    let of_shaft = |m: &&WhirlMode| m.whirl == Whirl::Axial && m.shaft_share > 0.99;
    let axial = modes.iter().find(of_shaft).unwrap();
    let expected = c.unwrap()[2][2] / (2.0 * (k[2][2] * MASS).sqrt());
    assert!(
        relative(axial.damping_ratio, expected) < 1e-5,
        "{} {expected}",
        axial.damping_ratio
    );
    let of_shaft = modes.iter().filter(|m| m.shaft_share > 0.99);
    let damped: Vec<f64> = of_shaft.map(|mode| mode.damping_ratio).collect();
    assert!(
        damped.len() >= 5 && damped.iter().all(|ratio| *ratio > 1e-8),
        "{damped:?}"
    );
    // Per contact c n n^T; two of them in series along the line of the centres.
    let [inner, outer] = model.hertz.each_ref().map(|h| h.stiffness.powf(2.0 / 3.0));
    let along = 50.0 * (inner * inner + outer * outer) / ((inner + outer) * (inner + outer));
    let sin = solution.balls[0].contact(Side::Inner).contact_angle_rad.sin();
    assert!(relative(c.unwrap()[2][2], 18.0 * along * sin * sin) < 1e-9);
}

/// Wrong: a free dof without inertia would be infinitely fast, or end in a message on matrices.
#[test]
fn a_free_dof_without_inertia_is_named() {
    for (mass, transverse, text) in [
        (
            0.0,
            1e-4,
            "x of the shaft is free and has no inertia, so it has no modes at speed; give shaft.mass, or",
        ),
        (
            1.0,
            0.0,
            "tilt_x of the shaft is free and has no inertia, so it has no modes at speed; give \
                    shaft.transverse_inertia, or lock it in [shaft]",
        ),
    ] {
        let mut model = rotor(1000.0);
        model.shaft_mass = mass;
        model.shaft_inertia.transverse = transverse;
        let mut solver = StaticSolver::new(&model).unwrap();
        let solution = solver.solve(&model, None).unwrap();
        let bearing = Linearisation::new(&model, &solver, &solution, DampingLaws::default()).unwrap();
        let error = TurningShaft::new(&model, &bearing, turning_inertia(&model).unwrap(), 0.0).err();
        let found = error.unwrap().to_string();
        assert!(found.starts_with(text), "{found}");
    }
}

/// Wrong: with elastic rings, forward and backward modes would not be those of the turning bearing: the gyroscopic
/// moment of ring and shaft, or what the rings yield under it. A bearing on elastic rings moves in time after a push;
/// its lines are where the modes at that speed say, on the side of their sense, and as far apart. What is left, 2e-3 of
/// a pair, is that patches follow their contacts in a motion, not in the stiffness, and the inertia of elastic rings.
#[test]
#[ignore = "twice 6000 steps of elastic rings: a minute; scripts/test-slow runs it"]
fn elastic_rings_whirl_in_time_as_their_modes_say() {
    let case = Case {
        free_tilt: true,
        load_point: 15e-3,
        ..Case::axial(2000.0)
    };
    let (speed, dt, n) = (3000.0, 1e-5, 6000);
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let mut model = case.flexible(ContactMode::Patch, Level::hex8(36, 6, 1, 2), hold);
        model.shaft_mass = 3.0;
        model.shaft_inertia = ShaftInertia {
            transverse: 3e-3,
            polar: 4e-3,
        };
        let modes = modes_going_round(&model, speed);
        let start = equilibrium(&model);
        model.effects.push(Box::new(Push));
        let motion = Motion::new(&model, MotionSettings::conserving(dt, Speed::constant(speed))).unwrap();
        let (mut state, mut cache) = (motion.start(&start), StepCache::default());
        let mut record = vec![];
        for step in 0..n {
            state = motion.step(&state, &mut cache).unwrap().0;
            if dt * f64::from(step) > PUSH[0] {
                record.push([state.shaft[0], state.shaft[1]]);
            }
        }
        let is_across = |m: &&WhirlMode| m.shaft_share > 0.9 && m.whirl != Whirl::Axial;
        let across: Vec<&WhirlMode> = modes.iter().filter(is_across).collect();
        assert_eq!(across.len(), 4);
        for pair in across.chunks_exact(2) {
            assert!(pair[0].whirl == Whirl::Backward && pair[1].whirl == Whirl::Forward);
            let signed = [-pair[0].frequency, pair[1].frequency];
            let found = signed.map(|guess| of_middle_rule(line_near(&record, dt, guess), dt));
            println!("{hold:?}: in time {found:.3?} Hz, modes {signed:.3?} Hz");
            for (found, expected) in found.iter().zip(signed) {
                assert!((found - expected).abs() < 2e-3 * signed[1], "{found} {expected}");
            }
        }
    }
}
