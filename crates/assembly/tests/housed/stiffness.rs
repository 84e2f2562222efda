//! Bearings in one body to first order, against differences of equilibria.

use assembly::stiffness::LinearAssembly;
use assembly::whirl::TurningAssembly;
use dynamics::DampingLaws;
use dynamics::effects::RingDamping;
use dynamics::interactions::contact_damping::ContactDamping;
use ring::rigid::RigidInertia;

use super::shaft::{CARRIED, HELD_BELOW, on_one, on_two};
use super::*;
use crate::heavy::swings;

/// An equilibrium from another one.
fn from(solver: &mut AssemblySolver, list: &mut Assembly, start: &AssemblySolution) -> AssemblySolution {
    solver.solve(list, Some(start)).unwrap_or_else(|e| panic!("{e}"))
}

/// Loads on both bearings in the frame of the shaft.
fn loads(list: &Assembly, solution: &AssemblySolution) -> [[f64; 5]; 2] {
    [0, 1].map(|i| list.force_on_shaft(i, solution).map(|f| -f))
}

/// A pair with these joints at rest, and what that is to first order.
fn linearised(
    side: Side,
    ties: [Arc<SeatTie>; 2],
) -> (Assembly, AssemblySolver, AssemblySolution, LinearAssembly) {
    of_list(tied_pair(side, ties, [0, 1]))
}

fn of_list(mut list: Assembly) -> (Assembly, AssemblySolver, AssemblySolution, LinearAssembly) {
    let mut solver = AssemblySolver::new(&list).unwrap();
    let solution = solver.solve(&mut list, None).unwrap_or_else(|e| panic!("{e}"));
    let linear = LinearAssembly::new(&list, &solver, &solution, DampingLaws::default()).unwrap();
    (list, solver, solution, linear)
}

/// Wrong: bearings would feel each other to first order where nothing joins their seats, or not be as stiff as in
/// bodies of their own.
#[test]
fn to_first_order_a_body_in_two_parts_is_two_bodies() {
    let (.., found) = linearised(Side::Outer, in_one(false, 70e9));
    let (.., expected) = linearised(Side::Outer, in_two());
    for (found, expected) in found.stiffness.iter().zip(&expected.stiffness) {
        let error = off(found.as_flattened(), expected.as_flattened());
        assert!(error < 1e-7, "{error:e}");
    }
    for coupling in &found.couplings {
        let own = &found.stiffness[coupling.moved];
        let share = largest(coupling.stiffness.as_flattened()) / largest(own.as_flattened());
        assert!(share < 1e-8, "{share:e}");
    }
    assert!(found.couplings.len() == 2 && expected.couplings.is_empty());
}

/// Wrong: a shaft on bearings in one body would be as stiff as if each had the body for itself. Central differences of
/// equilibria under a little more and less of each load; patches move with these and are frozen in the matrix.
#[test]
fn the_stiffness_of_a_shaft_in_one_body_is_that_of_differences() {
    differences_of_shaft(Side::Outer, in_one(true, 5e9), 0.1);
}

/// Wrong: the same of bearings on one elastic shaft.
#[test]
fn the_stiffness_on_one_elastic_shaft_is_that_of_differences() {
    differences_of_shaft(Side::Inner, on_one(true, HELD_BELOW), 1e-3);
    differences_of_bearings(Side::Inner, on_one(true, HELD_BELOW));
}

/// The pair in one sleeve and on one shaft, both elastic.
pub fn in_and_on(housing: [Arc<SeatTie>; 2], shaft: [Arc<SeatTie>; 2]) -> Assembly {
    let mut list = tied_pair(Side::Outer, housing, [0, 1]);
    let on_shaft = tied_pair(Side::Inner, shaft, [0, 1]);
    for (bearing, other) in list.bearings.iter_mut().zip(on_shaft.bearings) {
        bearing.model.rings[0] = other.model.rings[0].clone();
    }
    list
}

/// Wrong: bearings that share a housing and a shaft would feel each other through one of them alone, or twice.
#[test]
fn the_stiffness_in_one_body_on_another_is_that_of_differences() {
    let list = || in_and_on(in_one(true, 5e9), on_one(true, HELD_BELOW));
    differences_of(list(), 0.1);
    differences_of_places(list());
}

/// Wrong: the same where nothing joins the seats of either body.
#[test]
fn to_first_order_bodies_in_two_parts_are_four() {
    let [found, expected] = [
        in_and_on(in_one(false, 70e9), on_one(false, CARRIED)),
        in_and_on(in_two(), on_two()),
    ];
    let [found, expected] = [found, expected].map(|list| of_list(list).3);
    for (found, expected) in found.stiffness.iter().zip(&expected.stiffness) {
        let error = off(found.as_flattened(), expected.as_flattened());
        assert!(error < 1e-7, "{error:e}");
    }
    assert!(found.couplings.len() == 2 && expected.couplings.is_empty());
}

/// Frequencies over the speed, Hz, of a pair whose shaft has an inertia besides.
fn over_speed(mut list: Assembly, heavy: &RigidInertia, speed: f64) -> (Vec<f64>, [[f64; 5]; 5]) {
    list.shaft = ShaftBody::rigid(*heavy, [None; 5]);
    let (list, solver, solution, linear) = of_list(list);
    let turning = TurningAssembly::new(&list).unwrap();
    let equations = turning.equations((&list, &solver), (&solution, &linear), speed);
    let modes = equations.unwrap().modes().unwrap();
    // The two sleeves have the part of the other in their mesh.
    let found = modes.iter().filter(|mode| mode.standing_share < 1.0 - 1e-9);
    let found = found.map(|mode| mode.frequency).filter(|f| *f > 0.0);
    (found.collect(), linear.of_shaft(&list, 0.0).unwrap())
}

/// A shaft of a mass, kg, so heavy that all else follows it.
fn heavy(mass: f64) -> RigidInertia {
    RigidInertia {
        mass,
        first_moment: 0.0,
        transverse: mass / 375.0,
        polar: mass / 500.0,
    }
}

/// Pairs in one soft housing, on a rigid shaft and on one that is a body.
fn in_shared_bodies() -> [Assembly; 2] {
    [
        tied_pair(Side::Outer, in_one(true, 5e9), [0, 1]),
        in_and_on(in_one(true, 5e9), on_one(true, HELD_BELOW)),
    ]
}

/// Wrong: modes over the speed would not have what bearings do to each other through their bodies, or have it twice. A
/// heavy shaft swings on the matrix of the shaft; where nothing joins the seats, on bodies of their own.
#[test]
fn modes_over_the_speed_have_the_bodies_that_bearings_share() {
    let heavy = heavy(3000.0);
    for list in in_shared_bodies() {
        let (found, stiffness) = over_speed(list, &heavy, 0.0);
        let expected = swings(&heavy, &stiffness);
        println!("{:?} {expected:?}", &found[..5]);
        // The balls, and the inertia of rings and shaft about another point, are what is left.
        assert!(off(&found[..5], &expected) < 1e-3, "{found:?} {expected:?}");
    }
    let of = |list| over_speed(list, &INERTIA, 800.0).0;
    let parts = of(in_and_on(in_one(false, 70e9), on_one(false, CARRIED)));
    let bodies = of(in_and_on(in_two(), on_two()));
    let [parts, bodies] = [&parts[..40], &bodies[..40]];
    assert!(off(parts, bodies) < 1e-6, "{parts:?} {bodies:?}");
}

fn differences_of_shaft(side: Side, ties: [Arc<SeatTie>; 2], least: f64) {
    differences_of(tied_pair(side, ties, [0, 1]), least);
}

/// Alone, bearings give another answer by `least` of the load or more.
fn differences_of(list: Assembly, least: f64) {
    let (mut list, mut solver, solution, linear) = of_list(list);
    let stiffness = linear.of_shaft(&list, 0.0).unwrap();
    let mut alone = linear;
    alone.couplings.clear();
    let alone = alone.of_shaft(&list, 0.0).unwrap();
    let load = list.load.clone();
    let arm = 0.03;
    let (mut worst, mut worst_alone) = (0.0f64, 0.0f64);
    for dof in 0..5 {
        let change = if dof < 3 { 2.0 } else { 2.0 * arm };
        let mut at = |sign: f64| {
            list.load.clone_from(&load);
            list.load.on_dofs[dof] += sign * change;
            from(&mut solver, &mut list, &solution).shaft.displacements
        };
        let (low, high) = (at(-1.0), at(1.0));
        let moved: Vec<f64> = low.iter().zip(&high).map(|(a, b)| 0.5 * (b - a)).collect();
        let error = |matrix: &[[f64; 5]; 5]| -> f64 {
            let left = (0..5).map(|i| {
                let load: f64 = matrix[i].iter().zip(&moved).map(|(k, q)| k * q).sum();
                let expected = if i == dof { change } else { 0.0 };
                (load - expected).abs() / if i < 3 { 2.0 } else { 2.0 * arm }
            });
            left.fold(0.0, f64::max)
        };
        worst = worst.max(error(&stiffness));
        worst_alone = worst_alone.max(error(&alone));
    }
    println!("{worst:e}, without what bearings do to each other {worst_alone:e}");
    assert!(worst < 2.5e-4 && worst_alone > least, "{worst:e} {worst_alone:e}");
}

/// Wrong: the entry of a bearing, or what it does to the other, would not be that of the body with both in it. The
/// shaft is held, and one inner ring is moved along its axis: central differences of the loads on both.
#[test]
fn what_bearings_in_one_body_do_to_each_other_is_that_of_differences() {
    differences_of_bearings(Side::Outer, in_one(true, 5e9));
}

fn differences_of_bearings(side: Side, ties: [Arc<SeatTie>; 2]) {
    differences_of_places(tied_pair(side, ties, [0, 1]));
}

fn differences_of_places(list: Assembly) {
    const STEP: f64 = 1e-7;
    let (mut list, mut solver, solution, linear) = of_list(list);
    list.shaft.held = solution.shaft.displacements.iter().map(|q| Some(*q)).collect();
    for moved in [0, 1] {
        let shift = list.bearings[moved].place.shift;
        let mut at = |sign: f64| {
            list.bearings[moved].place.shift = shift + sign * STEP;
            let found = from(&mut solver, &mut list, &solution);
            loads(&list, &found)
        };
        let (low, high) = (at(-1.0), at(1.0));
        list.bearings[moved].place.shift = shift;
        // Along its own axis.
        let sign = list.bearings[moved]
            .place
            .orientation
            .turned_vector([0.0, 0.0, 1.0])[2];
        for loaded in [0, 1] {
            let expected: Vec<f64> = (0..5)
                .map(|i| sign * (high[loaded][i] - low[loaded][i]) / (2.0 * STEP))
                .collect();
            let block = match linear
                .couplings
                .iter()
                .find(|c| (c.loaded, c.moved) == (loaded, moved))
            {
                Some(coupling) => coupling.stiffness,
                None => linear.stiffness[loaded],
            };
            let column = block.map(|row| row[2]);
            let error = off(&column, &expected);
            println!("{loaded} by {moved}: {error:e} of {expected:?}");
            // What one does to the other may be a thousandth of what it does to itself, and differences lose as much.
            let limit = if loaded == moved { 3e-4 } else { 5e-4 };
            assert!(error < limit, "{loaded} by {moved}: {error:e}");
        }
    }
    let [there, back] = [(0, 1), (1, 0)].map(|pair| {
        let of = linear.couplings.iter().find(|c| (c.loaded, c.moved) == pair);
        of.unwrap().stiffness
    });
    let mirrored: Vec<f64> = (0..25).map(|k| back[k % 5][k / 5]).collect();
    let error = off(&there.concat(), &mirrored);
    // All but the patches, which go along with their contacts, has an energy.
    assert!(error < 1e-4, "{error:e}");
}

/// Contacts and rings that damp.
const LAWS: DampingLaws = DampingLaws {
    contacts: Some(ContactDamping {
        coefficient: 500.0,
        full_approach: 1e-6,
    }),
    rings: Some(RingDamping {
        mass: 0.0,
        stiffness: 1e-6,
    }),
};

fn damped(mut list: Assembly) -> (Assembly, AssemblySolver, AssemblySolution, LinearAssembly) {
    let mut solver = AssemblySolver::new(&list).unwrap();
    let solution = solver.solve(&mut list, None).unwrap_or_else(|e| panic!("{e}"));
    let linear = LinearAssembly::new(&list, &solver, &solution, LAWS).unwrap();
    (list, solver, solution, linear)
}

/// Wrong: bearings would lose damping, or share it, in a body that does not join their seats.
#[test]
fn the_damping_in_a_body_in_two_parts_is_that_in_two_bodies() {
    let (.., found) = damped(tied_pair(Side::Outer, in_one(false, 70e9), [0, 1]));
    let (.., expected) = damped(tied_pair(Side::Outer, in_two(), [0, 1]));
    for (found, expected) in found.damping.iter().zip(&expected.damping) {
        let [found, expected] = [found.unwrap(), expected.unwrap()];
        let error = off(found.as_flattened(), expected.as_flattened());
        assert!(error < 1e-7, "{error:e}");
    }
    for coupling in &found.couplings {
        let own = found.damping[coupling.moved].unwrap();
        let share = largest(coupling.damping.unwrap().as_flattened()) / largest(own.as_flattened());
        assert!(share < 1e-7, "{share:e}");
    }
    assert!(found.couplings.len() == 2);
}

/// Wrong: the damping of a shaft on bearings in one body would not be that of its modes. A heavy shaft swings slowly on
/// both matrices, with f + e zeta / 2 pi on K + e C; the modes over the speed have bodies with all oscillators.
#[test]
fn the_damping_of_a_shaft_in_one_body_is_that_of_its_modes() {
    let heavy = heavy(30000.0);
    for mut list in in_shared_bodies() {
        list.shaft = ShaftBody::rigid(heavy, [None; 5]);
        let (list, solver, solution, linear) = damped(list);
        let turning = TurningAssembly::new(&list).unwrap();
        let equations = turning.equations((&list, &solver), (&solution, &linear), 0.0);
        let modes = equations.unwrap().modes().unwrap();
        let found: Vec<f64> = modes
            .iter()
            .filter(|mode| mode.standing_share < 1.0 - 1e-9 && mode.frequency > 0.0)
            .map(|mode| mode.damping_ratio)
            .take(5)
            .collect();
        let stiffness = linear.of_shaft(&list, 0.0).unwrap();
        let damping = linear.damping_of_shaft(&list, 0.0).unwrap().unwrap();
        let step = 1e-2 * stiffness[0][0] / damping[0][0];
        let at = |sign: f64| {
            let entry = |i: usize, j: usize| stiffness[i][j] + sign * step * damping[i][j];
            swings(
                &heavy,
                &std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            )
        };
        let pairs = at(-1.0).into_iter().zip(at(1.0));
        let expected: Vec<f64> = pairs
            .map(|(low, high)| std::f64::consts::TAU * (high - low) / (2.0 * step))
            .collect();
        println!("{found:?} {expected:?}");
        assert!(off(&found, &expected) < 2e-2, "{found:?} {expected:?}");
    }
}
