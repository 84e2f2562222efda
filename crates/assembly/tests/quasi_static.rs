//! Several bearings on a shaft in equilibria over time: against one bearing alone, and against equilibria at rest.

use assembly::Orientation::{MinusZ, PlusZ};
use assembly::shaft::ShaftBody;
use assembly::{Assembly, AssemblySolution, AssemblySolver};
use dynamics::effects::{AxialForce, RadialForce};
use dynamics::kinematics::{RingSpeeds, Rolling, Speed};
use dynamics::{Model, Pose, QuasiStaticMotion, ShaftDof};
use input::Schedule;
use ring::rigid::RigidInertia;

use crate::lists::{At, bare, flexible, on_shaft};
use crate::near::assert_near;

const NOTHING: RigidInertia = RigidInertia {
    mass: 0.0,
    first_moment: 0.0,
    transverse: 0.0,
    polar: 0.0,
};
/// Between two instants the cage goes on by a third of a ball pitch, and a bit.
const DT: f64 = 0.9e-3;
const N: u64 = 6;

fn speed() -> RingSpeeds {
    RingSpeeds::from(Speed::table(vec![0.0, 5e-3], vec![150.0, 300.0]))
}

fn rolling(model: &Model, speeds: RingSpeeds) -> Rolling {
    Rolling::new(&model.geometry, speeds, [0.0; 2])
}

/// All instants under one load at position 0, each from the one before.
fn instants(
    mut list: Assembly,
    load: [f64; 5],
    poses: impl Fn(f64, &Assembly) -> Vec<Pose>,
) -> Vec<AssemblySolution> {
    list.load.add(&list.shaft.station(0.0), load);
    let mut solver = AssemblySolver::new(&list).unwrap();
    let mut all: Vec<AssemblySolution> = Vec::new();
    for n in 0..=N {
        let poses = poses(n as f64 * DT, &list);
        let start = all.last().map(AssemblySolution::as_start);
        all.push(solver.solve_at(&mut list, &poses, start.as_ref()).unwrap());
    }
    all
}

/// Every bearing rolls by itself, the shaft at the same speed.
fn turning(time: f64, list: &Assembly) -> Vec<Pose> {
    let pose = |bearing: &assembly::MountedBearing| {
        let mut speeds = speed();
        let values = &mut speeds.inner.values;
        let orientation = bearing.place.orientation;
        values.iter_mut().for_each(|w| *w = orientation.turned_angle(*w));
        rolling(&bearing.model, speeds).pose(time)
    };
    list.bearings.iter().map(pose).collect()
}

fn rigid(held: [Option<f64>; 5]) -> ShaftBody {
    ShaftBody::rigid(NOTHING, held)
}

/// A bearing whose free shaft has a load, and the other dofs stand.
fn alone(make: fn() -> Model, [x, y, z, ..]: [f64; 5], held: [Option<f64>; 5]) -> Vec<[f64; 5]> {
    let mut model = make();
    model.shaft = held.map(|held| held.map_or(ShaftDof::Free, ShaftDof::Prescribed));
    model.effects.push(Box::new(AxialForce {
        value: z,
        schedule: Schedule::Constant,
    }));
    model.effects.push(Box::new(RadialForce {
        value: x.hypot(y),
        direction: y.atan2(x),
        schedule: Schedule::Constant,
    }));
    let of_model = rolling(&model, speed());
    let mut bearing = QuasiStaticMotion::new(&model, of_model, DT).unwrap();
    let mut all = Vec::new();
    let mut last = None;
    for n in 0..=N {
        let found = bearing.step(n, last.as_ref()).unwrap();
        all.push(found.displacements.shaft);
        last = Some(found);
    }
    all
}

#[track_caller]
fn assert_same_course(found: &[AssemblySolution], expected: &[[f64; 5]], tolerance: f64) {
    let largest = |range: std::ops::Range<usize>| {
        let all = expected.iter().flat_map(|q| &q[range.clone()]);
        all.fold(0.0f64, |m, x| m.max(x.abs()))
    };
    for (n, (found, expected)) in found.iter().zip(expected).enumerate() {
        for i in 0..5 {
            let size = largest(if i < 3 { 0..3 } else { 3..5 });
            let q = found.shaft.displacements[i];
            assert!(
                (q - expected[i]).abs() <= tolerance * size,
                "instant {n}, {i}: {q:e} {:e}",
                expected[i]
            );
        }
    }
}

/// Wrong: balls of a list would not roll on as those of a bearing alone, or its instants not be equilibria. Two
/// programs of one equilibrium, whose residuals end at 1e-10 of the forces; the cycle of the balls is a thousand times
/// that.
#[test]
fn one_bearing_in_a_list_turns_as_alone() {
    // So little along the axis that some balls are loose.
    let load = [700.0, -200.0, 250.0, 0.0, 0.0];
    for make in [bare as fn() -> Model, flexible] {
        let list = on_shaft(rigid([None; 5]), &[(0.0, PlusZ, 0.0)], make);
        let found = instants(list, load, turning);
        let expected = alone(make, load, [None; 5]);
        assert_same_course(&found, &expected, 1e-9);
        let moved = (expected[1][0] - expected[0][0]).abs() / expected[0][0].abs();
        assert!(moved > 1e-6, "{moved:e}: the balls matter");
    }
}

/// Wrong: a load would be shared otherwise than evenly by bearings that are alike. Two in tandem on a shaft that does
/// not tilt, under twice the load, against one.
#[test]
fn two_in_tandem_under_twice_the_load_are_one() {
    let (load, held) = (
        [500.0, 300.0, 600.0, 0.0, 0.0],
        [None, None, None, Some(0.0), Some(0.0)],
    );
    for make in [bare as fn() -> Model, flexible] {
        let places: [At; 2] = [(0.0, PlusZ, 0.0), (0.03, PlusZ, 0.0)];
        let found = instants(
            on_shaft(rigid(held), &places, make),
            load.map(|f| 2.0 * f),
            turning,
        );
        assert_same_course(&found, &alone(make, load, held), 1e-9);
    }
}

/// Wrong: an instant would depend on what was before. Every instant is the equilibrium of balls that stand so: a pair
/// on rigid rings against the same at rest with its balls elsewhere. Not those of the start, which differ by more.
#[test]
fn an_instant_is_the_equilibrium_of_balls_that_stand_so() {
    let load = [900.0, 100.0, 200.0, 0.0, 2.0];
    let places: [At; 2] = [(0.0, PlusZ, 8e-6), (0.04, MinusZ, 8e-6)];
    let found = instants(on_shaft(rigid([None; 5]), &places, bare), load, turning);
    for (n, found) in found.iter().enumerate() {
        let mut list = on_shaft(rigid([None; 5]), &places, bare);
        list.load.add(&list.shaft.station(0.0), load);
        let poses = turning(n as f64 * DT, &list);
        for (bearing, pose) in list.bearings.iter_mut().zip(&poses) {
            bearing.model.geometry.first_ball_azimuth += pose.now.cage_angle;
        }
        let expected = AssemblySolver::new(&list)
            .unwrap()
            .solve(&mut list, None)
            .unwrap();
        for i in 0..5 {
            assert_near(
                found.shaft.displacements[i],
                expected.shaft.displacements[i],
                1e-8,
            );
        }
    }
    let apart = found[2].shaft.displacements[0] / found[0].shaft.displacements[0] - 1.0;
    assert!(apart.abs() > 1e-6, "{apart:e}");
}

/// Wrong: loads would not cycle as the balls pass. A pair whose load leaves balls loose: a ball-pass period later all
/// is as it was, half a period later it is not.
#[test]
fn a_pair_cycles_with_the_passing_of_its_balls() {
    let places: [At; 2] = [(0.0, PlusZ, 0.0), (0.04, MinusZ, 0.0)];
    let list = on_shaft(rigid([None; 5]), &places, bare);
    let steady = RingSpeeds::from(Speed::constant(300.0));
    let cage = rolling(&list.bearings[0].model, steady).pose(1.0).now.cage_angle;
    let period = std::f64::consts::TAU / (18.0 * cage);
    let poses = |time: f64, list: &Assembly| -> Vec<Pose> {
        let pose = |bearing: &assembly::MountedBearing| {
            let speed = bearing.place.orientation.turned_angle(300.0);
            let speeds = RingSpeeds::from(Speed::constant(speed));
            rolling(&bearing.model, speeds).pose(time / DT * 0.5 * period)
        };
        list.bearings.iter().map(pose).collect()
    };
    let found = instants(list, [1500.0, 0.0, 0.0, 0.0, 0.0], poses);
    let x = |n: usize| found[n].shaft.displacements[0];
    for n in 0..=4 {
        assert_near(x(n + 2), x(n), 1e-9);
    }
    let swing = (x(1) - x(0)).abs() / x(0).abs();
    assert!(swing > 1e-5, "{swing:e}");
}

/// Wrong: a run that goes on would have other bits than one that was never stopped: more than the start and the
/// tangents of the contacts would matter.
#[test]
fn an_equilibrium_follows_from_its_start_and_the_tangents() {
    let load = [900.0, 100.0, 200.0, 0.0, 2.0];
    let places: [At; 2] = [(0.0, PlusZ, 8e-6), (0.04, MinusZ, 8e-6)];
    let mut list = on_shaft(rigid([None; 5]), &places, flexible);
    list.load.add(&list.shaft.station(0.0), load);
    let mut solver = AssemblySolver::new(&list).unwrap();
    let mut next = None;
    for n in 0..3 {
        let poses = turning(n as f64 * DT, &list);
        next = Some(
            solver
                .solve_at(&mut list, &poses, next.as_ref())
                .unwrap()
                .as_start(),
        );
    }
    let (start, columns) = (next.unwrap(), solver.columns().to_vec());
    let poses = turning(3.0 * DT, &list);
    let expected = solver.solve_at(&mut list, &poses, Some(&start)).unwrap();
    let mut again = AssemblySolver::new(&list).unwrap();
    again.restore_columns(columns);
    let found = again.solve_at(&mut list, &poses, Some(&start)).unwrap();
    assert!(found.as_start() == expected.as_start());
}
