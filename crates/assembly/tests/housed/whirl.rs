//! Modes over the speed of two bearings with elastic bodies under their rings: at rest the natural modes, a body that
//! hardly yields, the order of the list.

use assembly::ShaftLoads;
use assembly::modes::modes;
use assembly::stiffness::LinearAssembly;
use assembly::whirl::TurningAssembly;
use dynamics::whirl::{Whirl, WhirlMode};
use dynamics::{Backend, DampingLaws, ModesSettings, ShaftDof};
use ring::rigid::RigidInertia;

use super::shaft::{CARRIED, HELD_BELOW, on_one, on_one_of, on_one_turned, on_two};
use super::stiffness::in_and_on;
use super::*;

/// A shaft beside the bodies, heavier than the balls.
const HEAVY: RigidInertia = RigidInertia {
    mass: 3.0,
    first_moment: 0.0,
    transverse: 8e-3,
    polar: 6e-3,
};

/// Modes at a speed in which more than a share of the energy is not that of the balls.
fn over_speed(list: &mut Assembly, speed: f64, least: f64) -> Vec<WhirlMode> {
    let mut solver = AssemblySolver::new(list).unwrap();
    let solution = solver.solve(list, None).unwrap_or_else(|e| panic!("{e}"));
    let linear = LinearAssembly::new(list, &solver, &solution, DampingLaws::default()).unwrap();
    let equations =
        TurningAssembly::new(list)
            .unwrap()
            .equations((list, &solver), (&solution, &linear), speed);
    let mut modes = equations.unwrap().modes().unwrap();
    modes.retain(|mode| mode.frequency > 0.0 && mode.shaft_share + mode.standing_share > least);
    modes
}

fn heavy(mut list: Assembly) -> Assembly {
    list.shaft = ShaftBody::rigid(HEAVY, [None; 5]);
    list.be_linear_in_bodies();
    list
}

/// Wrong: mass and stiffness would not belong together. In a sleeve, on a shaft that is held on one side, and both: the
/// lowest modes are those of rings with all their mass, which are static here.
#[test]
fn at_rest_the_modes_over_the_speed_are_the_natural_ones() {
    for (what, list) in [
        ("housing", pair(in_one(true, 70e9), [0, 1])),
        ("shaft", tied_pair(Side::Inner, on_one(true, HELD_BELOW), [0, 1])),
        ("both", in_and_on(in_one(true, 70e9), on_one(true, HELD_BELOW))),
    ] {
        let mut list = heavy(list);
        let found = over_speed(&mut list, 0.0, 0.5);
        let solution = at_rest(&mut list);
        let settings = ModesSettings {
            number: 110,
            shift: None,
            backend: Backend::Auto,
        };
        let natural = modes(&list, &solution, settings, &mut |_| ()).unwrap().modes;
        let is_shown =
            |mode: &&dynamics::modes::ModeOfSeveral| !mode.whole.is_rigid && mode.whole.kinetic[2] < 0.5;
        let natural: Vec<f64> = natural
            .iter()
            .filter(is_shown)
            .map(|mode| mode.whole.frequency)
            .collect();
        let found: Vec<f64> = found.iter().map(|mode| mode.frequency).collect();
        assert!(
            found.len() > 4 && natural.len() > 4,
            "{what}: {found:?} {natural:?}"
        );
        for (found, natural) in found.iter().zip(&natural).take(5) {
            println!("{what}: {found} {natural}");
            assert!((found / natural - 1.0).abs() < 5e-3, "{what}: {found} {natural}");
        }
    }
}

/// Wrong: the gyroscopic terms of the body, the rings in its seats or the way they turn would be off. A body that
/// hardly yields is a rigid shaft with its inertia, on rings that are held likewise.
#[test]
fn a_body_that_hardly_yields_is_a_rigid_shaft_over_the_speed() {
    let ties = on_one_of(207e13, true, CARRIED);
    let inertia = RigidInertia::from(ties[0].carried().unwrap().inertia);
    let mut soft = heavy(tied_pair(Side::Inner, ties, [0, 1]));
    let mut rigid = heavy(tied_pair(Side::Inner, on_one(true, CARRIED), [0, 1]));
    let held = Arc::new(ring(Side::Inner, LEVEL, Hold::Clamped));
    for bearing in &mut rigid.bearings {
        bearing.model.rings[0] = Some(held.clone());
    }
    let mount = rigid.mounts()[0].station;
    rigid.shaft.add_inertia(&mount, &inertia);
    for speed in [0.0, 2000.0] {
        let [found, expected] = [&mut soft, &mut rigid].map(|list| over_speed(list, speed, 0.5));
        for (found, expected) in found.iter().zip(&expected).take(5) {
            let off = (found.frequency / expected.frequency - 1.0).abs();
            println!(
                "{} {} {:?} {:?}",
                found.frequency, expected.frequency, found.whirl, expected.whirl
            );
            assert!(
                off < 2e-2 && found.whirl == expected.whirl,
                "{found:?} {expected:?}"
            );
            assert!((found.roundness - expected.roundness).abs() < 0.05);
        }
        let split = |modes: &[WhirlMode]| {
            let of = |whirl| {
                modes
                    .iter()
                    .find(|mode| mode.whirl == whirl)
                    .map_or(0.0, |mode| mode.frequency)
            };
            of(Whirl::Forward) - of(Whirl::Backward)
        };
        let [found, expected] = [split(&found), split(&expected)];
        assert!(
            (found - expected).abs() <= 0.02 * expected.abs(),
            "{found} {expected}"
        );
    }
}

/// Wrong: it would matter in whose frame the body is made: a turned body would turn the other way.
#[test]
fn over_the_speed_the_order_of_the_list_does_not_matter() {
    let mut first = heavy(tied_pair(Side::Inner, on_one(true, HELD_BELOW), [0, 1]));
    let mut other = heavy(tied_pair(Side::Inner, on_one_turned(HELD_BELOW), [1, 0]));
    let [first, other] = [&mut first, &mut other].map(|list| over_speed(list, 3000.0, 0.3));
    assert!(first.iter().any(|mode| mode.whirl == Whirl::Forward));
    assert!(first.iter().any(|mode| mode.whirl == Whirl::Backward));
    for (a, b) in first.iter().zip(&other).take(8) {
        let off = (a.frequency / b.frequency - 1.0).abs();
        assert!(off < 1e-6 && a.whirl == b.whirl, "{a:?} {b:?}");
        assert!((a.roundness - b.roundness).abs() < 1e-4, "{a:?} {b:?}");
    }
}

/// Wrong: a bearing alone would not be a list of one: the shaft's own mass, the body on it or its ring would be lost.
#[test]
fn over_the_speed_a_list_of_one_is_the_bearing_alone() {
    const SPEED: f64 = 2000.0;
    let mut list = tied_pair(Side::Inner, on_two(), [0, 1]);
    list.bearings.truncate(1);
    list.shaft = ShaftBody::rigid(RigidInertia::default(), [None; 5]);
    list.load = ShaftLoads::at_origin(vec![50.0, -20.0, 400.0, 0.0, 0.3]);
    let model = &mut list.bearings[0].model;
    model.shaft_mass = HEAVY.mass;
    model.shaft_inertia.transverse = HEAVY.transverse;
    model.shaft_inertia.polar = HEAVY.polar;
    let expected = over_speed(&mut list, SPEED, 0.3);
    let mut solver = AssemblySolver::new(&list).unwrap();
    let solution = solver.solve(&mut list, None).unwrap_or_else(|e| panic!("{e}"));
    let linear = LinearAssembly::new(&list, &solver, &solution, DampingLaws::default()).unwrap();
    // A bearing alone has the loads of its shaft, whose moments change with the tilt.
    let mut own = linear.bearings.into_iter().next().unwrap();
    own.load_stiffness = linear.of_levers;
    let model = &mut list.bearings[0].model;
    model.shaft = [ShaftDof::Free; 5];
    let alone = TurningAssembly::of_one("alone", model).unwrap().unwrap();
    let stands = (solver.of_bearing(0), &solution.bearings[0]);
    let equations = alone.equations_of_one(model, stands, &own, SPEED);
    let mut found = equations.unwrap().modes().unwrap();
    found.retain(|mode| mode.frequency > 0.0 && mode.shaft_share > 0.3);
    assert!(found.len() > 4 && found.len() == expected.len());
    for (a, b) in found.iter().zip(&expected) {
        let off = (a.frequency / b.frequency - 1.0).abs();
        assert!(off < 1e-9 && a.whirl == b.whirl, "{a:?} {b:?}");
    }
    // Without what turns pairs do not split: the shaft's and the body's spin does.
    assert!(found.iter().any(|mode| mode.whirl == Whirl::Forward));
}
