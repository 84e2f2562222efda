//! Several bearings on a shaft through time, against one bearing alone, modes of the same equations, and ledgers.

use assembly::ShaftLoads;
use assembly::motion::AssemblyCache;
use assembly::shaft::ShaftBody;
use assembly::stiffness::LinearAssembly;
use assembly::whirl::{equations, turning_shaft};
use assembly::{
    Assembly, AssemblyMotion, AssemblySolver, AssemblyState, BeamSection, BeamShaft, Orientation, PointMass,
};
use contact::Side;
use dynamics::effects::{AxialForce, Now, RadialForce};
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{DampingLaws, Model, ShaftDof};
use fem::Material;
use input::Schedule;
use ring::rigid::RigidInertia;

use crate::lists::{At, bare, flexible, on_shaft};
use crate::near::assert_near;
use crate::support::equilibrium;
use Orientation::{MinusZ, PlusZ};

pub const INERTIA: RigidInertia = RigidInertia {
    mass: 1.5,
    first_moment: 0.0,
    transverse: 2e-3,
    polar: 1e-3,
};

/// Bearings on a shaft under a load at position 0.
fn loaded(shaft: ShaftBody, places: &[At], load: [f64; 5], make: impl Fn() -> Model) -> Assembly {
    let mut list = on_shaft(shaft, places, make);
    list.load.add(&list.shaft.station(0.0), load);
    list
}

fn beam() -> ShaftBody {
    let beam = BeamShaft {
        sections: vec![BeamSection {
            from: -0.05,
            to: 0.1,
            outside: 0.05,
            bore: 0.02,
        }],
        material: Material::new(207e9, 0.3, 7800.0).unwrap(),
        longest_element: 0.03,
    };
    let mut shaft = ShaftBody::beam(&beam, &[0.0, 0.04]).unwrap();
    shaft.add_mass(&PointMass {
        position: -0.05,
        mass: 0.4,
        transverse: 2e-4,
        polar: 3e-4,
    });
    shaft
}

/// A speed in the shaft's frame, as a bearing of an orientation sees it.
fn seen(speed: &Speed, orientation: Orientation) -> RingSpeeds {
    let mut speeds = RingSpeeds::from(speed.clone());
    let values = &mut speeds.inner.values;
    values.iter_mut().for_each(|w| *w = orientation.turned_angle(*w));
    speeds
}

/// Puts a force on the shaft of a bearing alone.
fn set_load(model: &mut Model, [x, y, z, ..]: [f64; 5]) {
    let schedule = Schedule::Constant;
    model.effects.clear();
    model.effects.push(Box::new(AxialForce {
        value: z,
        schedule: schedule.clone(),
    }));
    model.effects.push(Box::new(RadialForce {
        value: x.hypot(y),
        direction: y.atan2(x),
        schedule,
    }));
}

/// Runs from the equilibrium under the assembly's load, `n` steps of `dt` under another one at position 0.
pub fn run(
    mut assembly: Assembly,
    (dt, n): (f64, usize),
    speed: &Speed,
    load: impl Fn(f64) -> [f64; 5] + Sync,
    mut note: impl FnMut(&AssemblyMotion<'_>, &AssemblyState),
) -> AssemblyState {
    let solution = AssemblySolver::new(&assembly)
        .unwrap()
        .solve(&mut assembly, None)
        .unwrap();
    assembly.release();
    let settings = assembly
        .bearings
        .iter()
        .map(|b| MotionSettings::conserving(dt, seen(speed, b.place.orientation)));
    let settings: Vec<_> = settings.collect();
    let shaft = assembly.shaft.clone();
    let load_at = |now: &Now<'_>| {
        let mut sum = ShaftLoads::none(&shaft);
        sum.add(&shaft.station(0.0), load(now.time));
        Ok(sum)
    };
    let motion = AssemblyMotion::new(&assembly, settings, speed.clone(), Box::new(load_at)).unwrap();
    let (mut state, mut cache) = (motion.start(&solution), AssemblyCache::default());
    note(&motion, &state);
    for _ in 0..n {
        (state, _) = motion.step(&state, &mut cache).unwrap_or_else(|e| panic!("{e}"));
        note(&motion, &state);
    }
    state
}

/// Wrong: a shaft that a list carries would move otherwise than that of one bearing. The same inertia, speed and loads:
/// two programs of one step, whose residuals end at 1e-10 of the forces. The list lacks the square of its tilts,
/// 0.6 mrad, in its inertia.
#[test]
fn one_bearing_in_a_list_moves_as_alone() {
    let speed = Speed::table(vec![0.0, 1e-3], vec![500.0, 900.0]);
    let (dt, n) = (1e-5, 100);
    let (rest, after) = ([0.0, 0.0, 900.0, 0.0, 0.0], [300.0, -100.0, 1200.0, 0.0, 0.0]);
    for make in [bare as fn() -> Model, flexible] {
        let list = loaded(
            ShaftBody::rigid(INERTIA, [None; 5]),
            &[(0.0, PlusZ, 0.0)],
            rest,
            make,
        );
        let found = run(list, (dt, n), &speed, |_| after, |_, _| {});
        let mut model = make();
        model.shaft = [ShaftDof::Free; 5];
        model.shaft_mass = INERTIA.mass;
        model.shaft_inertia = dynamics::model::ShaftInertia {
            transverse: INERTIA.transverse,
            polar: INERTIA.polar,
        };
        set_load(&mut model, rest);
        let solution = equilibrium(&model);
        set_load(&mut model, after);
        let motion = Motion::new(
            &model,
            MotionSettings::conserving(dt, RingSpeeds::from(speed.clone())),
        )
        .unwrap();
        let (mut state, mut cache) = (motion.start(&solution), StepCache::default());
        for _ in 0..n {
            (state, _) = motion.step(&state, &mut cache).unwrap();
        }
        let largest = |q: &[f64]| q.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        println!("{:?}\n{:?}", found.shaft, state.shaft);
        for (range, size) in [
            (0..3, largest(&state.shaft[..3])),
            (3..5, largest(&state.shaft[3..])),
        ] {
            for i in range {
                let error = (found.shaft[i] - state.shaft[i]).abs();
                assert!(error < 1e-8 * size, "{i}: {:?} {:?}", found.shaft, state.shaft);
            }
        }
    }
}

/// Wrong: energy would come from the way in which shaft and bearings are put together. A pair on a beam that speeds up
/// and gets a load across; elastic rings; every ledger closes by itself, and what leaves the shaft enters the bearings.
#[test]
fn ledgers_of_shaft_and_bearings_close() {
    let speed = Speed::table(vec![0.0, 1e-3], vec![400.0, 1200.0]);
    for make in [bare as fn() -> Model, flexible] {
        let places = [(0.0, PlusZ, 8e-6), (0.04, MinusZ, 8e-6)];
        let list = loaded(beam(), &places, [0.0; 5], make);
        let mut worst = [0.0f64; 3];
        let last = run(
            list,
            (1e-5, 100),
            &speed,
            |_| [400.0, 0.0, 100.0, 0.0, 2.0],
            |_, state| {
                let of_bearings: f64 = state.bearings.iter().map(|b| b.ledger.imposed_work).sum();
                let passed = (of_bearings - state.ledger.bearing_work) / state.ledger.scale;
                let defects = state.bearings.iter().map(|b| b.ledger.relative_defect().abs());
                let now = [
                    state.ledger.relative_defect().abs(),
                    defects.fold(0.0, f64::max),
                    passed.abs(),
                ];
                worst = [0, 1, 2].map(|i| worst[i].max(now[i]));
            },
        );
        println!("{worst:?} {:?}", last.ledger);
        assert!(last.ledger.kinetic > 0.0 && last.ledger.strain > 0.0);
        assert!(worst.iter().all(|defect| *defect < 1e-9), "{worst:?}");
    }
}

/// Wrong: a rigid shaft that tilts would leave its equilibrium, or gain energy, because it had the arms of a straight
/// shaft in one place and those of the tilted one in another. A bearing off the origin that the list turns round: under
/// the loads of its equilibrium it rests, under others its ledgers close.
#[test]
fn a_rigid_shaft_that_tilts_rests_and_closes_its_ledgers() {
    let start = [80.0, 5.0, 900.0, 0.0, 0.4];
    let places = [(0.05, PlusZ, 0.0)];
    for make in [bare as fn() -> Model, flexible] {
        // Balls that stand are those of the equilibrium.
        for (after, speed) in [(start, 0.0), ([-65.0, 15.0, 1300.0, 0.3, 0.4], 500.0)] {
            let list = loaded(ShaftBody::rigid(INERTIA, [None; 5]), &places, start, make);
            let (mut first, mut moved): (Option<Vec<f64>>, f64) = (None, 0.0);
            let mut worst = [0.0f64; 3];
            let last = run(
                list,
                (1e-5, 100),
                &Speed::constant(speed),
                |_| after,
                |_, state| {
                    let at_start = first.get_or_insert_with(|| state.shaft.clone());
                    let changes = state
                        .shaft
                        .iter()
                        .zip(at_start.iter())
                        .map(|(a, b)| (a - b).abs());
                    moved = changes.fold(moved, f64::max);
                    let of_bearing = &state.bearings[0].ledger;
                    let passed = of_bearing.imposed_work - state.ledger.bearing_work;
                    let now = [
                        state.ledger.relative_defect().abs(),
                        of_bearing.relative_defect().abs(),
                        passed.abs() / state.ledger.scale,
                    ];
                    worst = [0, 1, 2].map(|i| worst[i].max(now[i]));
                },
            );
            println!("{moved:e} {worst:?} {:?}", last.shaft);
            match after == start {
                true => assert!(
                    moved < 1e-11 && last.shaft[4].abs() > 5e-4,
                    "{moved:e} {:?}",
                    last.shaft
                ),
                false => assert!(worst.iter().all(|defect| *defect < 1e-9), "{worst:?}"),
            }
        }
    }
}

/// Wrong: inertia, stiffness or gyroscopic terms of the shaft and its bearings would differ from those of the linear
/// equations. Small free oscillations after a kick, against the first mode in each direction: 0.2 % of what the step
/// and the amplitude leave.
#[test]
fn a_kicked_pair_swings_with_the_frequencies_of_its_modes() {
    let places = [(0.0, PlusZ, 12e-6), (0.04, MinusZ, 12e-6)];
    let make = || loaded(ShaftBody::rigid(INERTIA, [None; 5]), &places, [0.0; 5], bare);
    let mut list = make();
    let mut solver = AssemblySolver::new(&list).unwrap();
    let solution = solver.solve(&mut list, None).unwrap();
    let linear = LinearAssembly::new(&list, &solver, &solution, DampingLaws::default()).unwrap();
    let shaft = turning_shaft(&list).unwrap();
    let modes = equations(&list, &shaft, &linear, 0.0).unwrap().modes().unwrap();
    let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
    println!("{frequencies:?}");
    // A steady load along z of which the motion knows nothing before its start.
    let (dt, n) = (2e-6, 2000);
    let mut z = Vec::new();
    run(
        make(),
        (dt, n),
        &Speed::constant(0.0),
        |_| [0.0, 0.0, 1.0, 0.0, 0.0],
        |_, state| z.push(state.shaft[2]),
    );
    let mean = z.iter().sum::<f64>() / z.len() as f64;
    let crossings: Vec<f64> = (1..z.len())
        .filter(|&i| z[i - 1] < mean && z[i] >= mean)
        .map(|i| dt * (i as f64 - (z[i] - mean) / (z[i] - z[i - 1])))
        .collect();
    let periods = crossings.len() - 1;
    let found = periods as f64 / (crossings[periods] - crossings[0]);
    let nearest = frequencies
        .iter()
        .min_by(|a, b| (*a - found).abs().total_cmp(&(*b - found).abs()));
    assert_near(found, *nearest.unwrap(), 2e-3);
}

/// Wrong: the step of shaft and bearings would be of another order than that of a bearing. Halved steps: the error of
/// place and forces falls to a quarter.
#[test]
fn the_motion_is_of_second_order() {
    let speed = Speed::constant(600.0);
    let end = |halvings: i32| {
        let parts = 2.0f64.powi(halvings);
        let places = [(0.0, PlusZ, 10e-6), (0.04, MinusZ, 10e-6)];
        let list = loaded(ShaftBody::rigid(INERTIA, [None; 5]), &places, [0.0; 5], bare);
        // Grows smoothly from nothing, so that nothing jumps at the start.
        let load = |t: f64| [300.0 * (t / 2e-4).powi(2), 0.0, 0.0, 0.0, 0.0];
        run(list, (4e-6 / parts, 50 << halvings), &speed, load, |_, _| {}).shaft
    };
    let all: Vec<Vec<f64>> = (0..4).map(end).collect();
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let gaps: Vec<f64> = all.windows(2).map(|two| apart(&two[0], &two[1])).collect();
    println!("{gaps:?}");
    for two in gaps.windows(2) {
        assert!((3.4..4.6).contains(&(two[0] / two[1])), "{gaps:?}");
    }
}

/// Wrong: a bearing that is turned would not be the mirror of the other. A pair that is pressed from both sides alike
/// stays alike: no motion along the axis, equal forces in both rows.
#[test]
fn a_pair_under_a_load_in_its_middle_stays_alike() {
    let places = [(-0.02, PlusZ, 10e-6), (0.02, MinusZ, 10e-6)];
    let list = loaded(ShaftBody::rigid(INERTIA, [None; 5]), &places, [0.0; 5], bare);
    let last = run(
        list,
        (1e-5, 200),
        &Speed::constant(0.0),
        |_| [800.0, 0.0, 0.0, 0.0, 0.0],
        |_, _| {},
    );
    assert!(
        last.shaft[2].abs() < 1e-12 && last.shaft[0] > 1e-7,
        "{:?}",
        last.shaft
    );
    for ball in 0..18 {
        // About x: azimuth psi of one is -psi of the other.
        let mirrored = (18 - ball) % 18;
        for side in Side::BOTH {
            let [a, b] = [(0, ball), (1, mirrored)]
                .map(|(bearing, ball)| last.bearings[bearing].forces[2 * ball + side.index()].norm());
            assert!((a - b).abs() < 1e-6 * a.max(1.0), "{ball} {side:?}: {a} {b}");
        }
    }
}
