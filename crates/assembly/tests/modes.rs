//! Natural modes of bearings on a shaft: against one bearing alone, closed forms, the linearised bearings and their own
//! symmetry.

use assembly::modes::modes;
use assembly::shaft::ShaftBody;
use assembly::stiffness::LinearAssembly;
use assembly::whirl::{equations, turning_shaft};
use assembly::{Assembly, AssemblySolution, AssemblySolver, BeamSection, BeamShaft, Orientation, PointMass};
use dynamics::effects::{AxialForce, RadialForce};
use dynamics::modes::{ModeOfSeveral, bearing_modes};
use dynamics::{Backend, ContactMode, DampingLaws, Hold, Mode, Model, ModesSettings, ShaftDof};
use fem::Material;
use input::Schedule;
use ring::rigid::RigidInertia;

use crate::heavy::swings;
use crate::lists::{At, bare, flexible, on_shaft};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium};
use Orientation::{MinusZ, PlusZ};

const INERTIA: RigidInertia = RigidInertia {
    mass: 1.5,
    first_moment: 0.0,
    transverse: 2e-3,
    polar: 1e-3,
};
/// Half of the offset of a pair that presses it together, m.
const SHIFT: f64 = 10e-6;
const PAIR: [At; 2] = [(-0.02, PlusZ, SHIFT), (0.02, MinusZ, SHIFT)];

fn settings(number: usize) -> ModesSettings {
    ModesSettings {
        number,
        shift: None,
        backend: Backend::Auto,
    }
}

fn solve(assembly: &mut Assembly) -> (AssemblySolver, AssemblySolution) {
    let mut solver = AssemblySolver::new(assembly).unwrap();
    let solution = solver.solve(assembly, None).unwrap();
    (solver, solution)
}

/// The modes of a list about its equilibrium, each known well.
fn of_list(assembly: &mut Assembly, number: usize) -> Vec<ModeOfSeveral> {
    let (_, solution) = solve(assembly);
    let found = modes(assembly, &solution, settings(number), &mut |_| ());
    let found = found.unwrap_or_else(|e| panic!("{e}")).modes;
    for ModeOfSeveral { whole, .. } in found.iter().filter(|mode| !mode.whole.is_rigid) {
        let told = [whole.frequency, whole.bound, whole.residual];
        assert!(
            whole.bound < 1e-6 * whole.frequency && whole.residual < 1e-6,
            "{told:?}"
        );
    }
    found
}

fn beam() -> ShaftBody {
    let beam = BeamShaft {
        sections: vec![BeamSection {
            from: -0.1,
            to: 0.06,
            outside: 0.05,
            bore: 0.02,
        }],
        material: Material::new(207e9, 0.3, 7800.0).unwrap(),
        longest_element: 0.02,
    };
    let mut shaft = ShaftBody::beam(&beam, &[-0.02, 0.02]).unwrap();
    shaft.add_mass(&PointMass {
        position: -0.1,
        mass: 0.8,
        transverse: 4e-4,
        polar: 7e-4,
    });
    shaft
}

/// The same with rings that are held by their mean motion.
fn mean_motion() -> Model {
    let level = Level::hex8(54, 6, 1, 2);
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, level, Hold::MeanMotion);
    model.effects.clear();
    model
}

/// The bearing of a list alone under a force, on a shaft that carries a mass.
fn alone(make: impl Fn() -> Model, shaft: [ShaftDof; 5], mass: f64, [x, y, z]: [f64; 3]) -> Vec<Mode> {
    let mut model = make();
    let schedule = Schedule::Constant;
    model.effects = vec![
        Box::new(AxialForce {
            value: z,
            schedule: schedule.clone(),
        }),
        Box::new(RadialForce {
            value: x.hypot(y),
            direction: y.atan2(x),
            schedule,
        }),
    ];
    model.shaft = shaft;
    model.shaft_mass = mass;
    model.shaft_inertia.transverse = INERTIA.transverse;
    let found = bearing_modes(&model, &equilibrium(&model), settings(16), &mut |_| ());
    found.unwrap().modes
}

/// Wrong: a bearing would vibrate otherwise because the shaft is written apart from it: its shares, the constraints
/// that hold its inner ring, the curvature of finite tilts.
#[test]
fn a_list_of_one_bearing_is_that_bearing() {
    let force = [900.0, -300.0, 1500.0];
    for make in [bare, flexible, mean_motion] {
        let mut list = on_shaft(ShaftBody::rigid(INERTIA, [None; 5]), &[(0.0, PlusZ, 0.0)], make);
        list.load.on_dofs[..3].copy_from_slice(&force);
        let found = of_list(&mut list, 16);
        let expected = alone(make, [ShaftDof::Free; 5], INERTIA.mass, force);
        compare(&frequencies(&found), &of_modes(&expected), 1e-7);
        for (found, expected) in found.iter().zip(&expected).filter(|(_, mode)| !mode.is_rigid) {
            // Of double modes each is any of a plane.
            let shares = found.whole.kinetic.iter().zip(expected.kinetic);
            let off = shares.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-4, "{:?} {:?}", found.whole.kinetic, expected.kinetic);
        }
    }
}

fn frequencies(modes: &[ModeOfSeveral]) -> Vec<f64> {
    modes.iter().map(|mode| mode.whole.frequency).collect()
}

fn of_modes(modes: &[Mode]) -> Vec<f64> {
    modes.iter().map(|mode| mode.frequency).collect()
}

#[track_caller]
fn compare(found: &[f64], expected: &[f64], tolerance: f64) {
    let n = found.len().min(expected.len());
    assert!(n > 3, "{found:?} {expected:?}");
    let off = |(a, b): (&f64, &f64)| (a - b).abs() / b.max(1.0);
    let worst = found.iter().zip(expected).map(off).fold(0.0, f64::max);
    assert!(worst < tolerance, "{worst:e}\n{found:?}\n{expected:?}");
}

/// Frequencies of one bearing on a shaft that is held but along z, under the shift of the pair.
fn half(make: impl Fn() -> Model, z: ShaftDof, mass: f64) -> Vec<f64> {
    let held = ShaftDof::Prescribed(0.0);
    let preload = {
        let at = [held, held, ShaftDof::Prescribed(SHIFT), held, held];
        let model = Model { shaft: at, ..make() };
        equilibrium(&model).shaft_reaction[2]
    };
    of_modes(&alone(
        make,
        [held, held, z, held, held],
        mass,
        [0.0, 0.0, preload],
    ))
}

/// Wrong: bearings would feel each other through a shaft that does not move.
#[test]
fn on_a_shaft_that_is_held_every_mode_is_there_twice() {
    for make in [bare, flexible] {
        let shaft = ShaftBody::rigid(INERTIA, [Some(0.0); 5]);
        let found = frequencies(&of_list(&mut on_shaft(shaft, &PAIR, make), 20));
        let one = half(make, ShaftDof::Prescribed(SHIFT), 0.0);
        let twice: Vec<f64> = one.iter().flat_map(|f| [*f, *f]).collect();
        compare(&found, &twice[..20], 1e-6);
    }
}

/// Wrong: the shaft would not join its bearings, or not with all its mass. A pair that is alike from both ends vibrates
/// so that both do the same: one bearing with half the shaft; or the opposite, and the shaft stands.
#[test]
fn a_symmetric_pair_has_the_modes_of_one_bearing_with_half_the_shaft_and_of_one_that_is_held() {
    for make in [bare, flexible] {
        let held = [Some(0.0), Some(0.0), None, Some(0.0), Some(0.0)];
        let shaft = ShaftBody::rigid(INERTIA, held);
        let found = frequencies(&of_list(&mut on_shaft(shaft, &PAIR, make), 20));
        let together = half(make, ShaftDof::Free, 0.5 * INERTIA.mass);
        let apart = half(make, ShaftDof::Prescribed(SHIFT), 0.0);
        let mut expected = [together, apart].concat();
        expected.sort_by(f64::total_cmp);
        compare(&found, &expected[..20], 1e-6);
    }
}

/// Wrong: stiffness at rest and modes would be of two different bearings. A heavy shaft swings on the 5 x 5 matrix of
/// the pair; what rings and balls add is their share of its mass.
#[test]
fn a_heavy_shaft_swings_on_the_stiffness_of_its_pair() {
    let heavy = RigidInertia {
        mass: 2000.0,
        first_moment: 0.0,
        transverse: 5.0,
        polar: 1.0,
    };
    for make in [bare, flexible] {
        let mut list = on_shaft(ShaftBody::rigid(heavy, [None; 5]), &PAIR, make);
        list.load
            .on_dofs
            .copy_from_slice(&[200.0, -100.0, 100.0, 1.0, 2.0]);
        let (solver, solution) = solve(&mut list);
        let linear = LinearAssembly::new(&list, &solver, &solution, DampingLaws::default()).unwrap();
        let stiffness = linear.of_shaft(&list, 0.0).unwrap();
        let expected = swings(&heavy, &stiffness);
        let found = frequencies(&of_list(&mut list, 5));
        println!("{found:?} {expected:?}");
        compare(&found, &expected, 3e-4);
    }
}

/// Wrong: masses or stiffness of a beam, or places on it, would be others than those of its modes over the speed: at
/// rest these are the same for rigid rings, found from the linearised bearings by a dense method.
#[test]
fn on_a_beam_the_modes_are_those_of_the_campbell_diagram_at_rest() {
    let mut list = on_shaft(beam(), &PAIR, bare);
    let station = list.shaft.station(-0.1);
    list.load.add(&station, [40.0, -20.0, 60.0, 0.0, 0.5]);
    let (solver, solution) = solve(&mut list);
    let linear = LinearAssembly::new(&list, &solver, &solution, DampingLaws::default()).unwrap();
    let turning = turning_shaft(&list).unwrap();
    let expected = equations(&list, &turning, &linear, 0.0).unwrap().modes().unwrap();
    let expected: Vec<f64> = expected.iter().map(|mode| mode.frequency).collect();
    let found = of_list(&mut list, 40);
    compare(&frequencies(&found), &expected, 1e-6);
    // The overhung end swings most in the first mode that bends the shaft.
    assert!(found[0].whole.kinetic[3] > 0.5, "{:?}", found[0].whole.kinetic);
    for mode in &found {
        let largest = mode.shaft.iter().fold(0.0f64, |most, q| most.max(q.abs()));
        let total: f64 = mode.whole.kinetic.iter().sum();
        assert!(largest < 1e3 && (total - 1.0).abs() < 1e-12);
    }
}
