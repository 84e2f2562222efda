//! Bearings on a shaft against closed forms of rigid rings, identities and differences.

use assembly::ShaftLoads;
use assembly::shaft::ShaftBody;
use assembly::stiffness::LinearAssembly;
use assembly::{
    Assembly, AssemblyError, AssemblySolution, AssemblySolver, BeamSection, BeamShaft, Orientation,
};
use dynamics::{DampingLaws, Linearisation, Model, StaticSolver};
use ring::rigid::RigidInertia;

use crate::lists::{At, bare, flexible, on_shaft};
use crate::near::assert_near;
use crate::support::{Case, equilibrium, steel};
use Orientation::{MinusZ, PlusZ};

fn rigid(places: &[At]) -> Assembly {
    on_shaft(ShaftBody::rigid(RigidInertia::default(), [None; 5]), places, bare)
}

fn load(assembly: &mut Assembly, position: f64, load: [f64; 5]) {
    let station = assembly.shaft.station(position);
    assembly.load.add(&station, load);
}

fn solve(assembly: &mut Assembly) -> (AssemblySolver, AssemblySolution) {
    let mut solver = AssemblySolver::new(assembly).unwrap();
    let solution = solver.solve(assembly, None).unwrap();
    (solver, solution)
}

/// Thrust of a bearing with rigid rings whose inner ring is shifted by `d` along the axis, and its slope: Jones and
/// Harris, all balls alike and both contacts in line. Nothing of the program but dimensions and Hertz constants.
fn thrust(model: &Model, d: f64) -> [f64; 2] {
    let g = &model.geometry;
    let (a, free) = (g.groove_distance(), g.free_contact_angle());
    let flex: f64 = model.hertz.iter().map(|h| h.stiffness.powf(-2.0 / 3.0)).sum();
    let k = flex.powf(-1.5);
    let (across, along) = (a * free.cos(), a * free.sin() + d);
    let s = across.hypot(along);
    let q = k * (s - a).max(0.0).powf(1.5);
    let slope = 1.5 * k * (s - a).max(0.0).sqrt() * (along / s).powi(2) + q / s * (across / s).powi(2);
    let z = g.n_balls as f64;
    [z * q * along / s, z * slope]
}

/// Shift under a thrust, by bisection.
fn shift(model: &Model, force: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1e-3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if thrust(model, middle)[0] < force {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn forces(solution: &AssemblySolution, bearing: usize) -> Vec<f64> {
    let balls = solution.bearings[bearing].balls.iter();
    balls.map(|ball| ball.inner.force_n).collect()
}

/// Wrong: what presses a pair together would not be its offset, or a bearing's stiffness not count twice. With exact
/// Hertz constants and 500 N: d0 = 16.5 um.
#[test]
fn a_back_to_back_pair_is_twice_as_stiff_as_one_bearing_under_its_preload() {
    let model = bare();
    let (preload, d0) = (500.0, shift(&bare(), 500.0));
    let mut pair = rigid(&[(0.0, PlusZ, d0), (0.03, MinusZ, d0)]);
    let (solver, solution) = solve(&mut pair);
    for bearing in 0..2 {
        assert_near(solution.bearings[bearing].shaft_reaction[2], preload, 1e-9);
    }
    let linear = LinearAssembly::new(&pair, &solver, &solution, DampingLaws::default()).unwrap();
    let found = linear.of_shaft(&pair, 0.0).unwrap()[2][2];
    let one = thrust(&model, d0)[1];
    println!("d0 = {:.4} um, pair {:.3} N/um", 1e6 * d0, 1e-6 * found);
    assert_near(found, 2.0 * one, 1e-8);
    assert_near(d0, 16.506e-6, 2e-3);
    assert_near(found, 104.7e6, 2e-3);
}

/// Wrong: the row that comes off would still carry, or its lack of stiffness stop the solution. It lifts off where the
/// other alone carries twice the shift: 3.5 times the preload of a 7010C with 500 N, as its angle grows; 2^1.5 where
/// the angle stays.
#[test]
fn the_unloaded_row_lifts_off_where_the_other_has_twice_the_shift() {
    let model = bare();
    let d0 = shift(&model, 500.0);
    let off = thrust(&model, 2.0 * d0)[0];
    println!("lifts off at {:.4} F0", off / 500.0);
    assert_near(off / 500.0, 3.5, 0.01);
    for (share, loose) in [(0.999, false), (1.001, true), (3.0, true)] {
        let mut pair = rigid(&[(0.0, PlusZ, d0), (0.03, MinusZ, d0)]);
        load(&mut pair, 0.0, [0.0, 0.0, share * off, 0.0, 0.0]);
        let (_, solution) = solve(&mut pair);
        let z = solution.shaft.displacements[2];
        let balance = thrust(&model, d0 + z)[0] - thrust(&model, d0 - z)[0];
        assert_near(balance, share * off, 1e-9);
        assert_eq!(
            forces(&solution, 1).iter().all(|f| *f < 1e-9),
            loose,
            "at {share}"
        );
    }
    // Nearly constant angle: a large contact angle under a small preload.
    let mut steep = bare();
    steep.geometry.outer_raceway_diameter += 1.2e-3;
    let d0 = shift(&steep, 1.0);
    let ratio = thrust(&steep, 2.0 * d0)[0] / 1.0;
    assert_near(ratio, 2.0f64.powf(1.5), 0.02);
}

/// Wrong: nothing would come of loads on a pair whose bearings all hang loose at the start, with any play between.
#[test]
fn loose_bearings_are_found_by_the_load() {
    let model = bare();
    let mut pair = rigid(&[(0.0, PlusZ, -20e-6), (0.03, MinusZ, -20e-6)]);
    load(&mut pair, 0.0, [0.0, 0.0, -800.0, 0.0, 0.0]);
    let (_, solution) = solve(&mut pair);
    assert!(forces(&solution, 0).iter().all(|f| *f == 0.0));
    let z = solution.shaft.displacements[2];
    assert_near(thrust(&model, -20e-6 - z)[0], 800.0, 1e-9);
    // And a load across.
    let mut pair = rigid(&[(0.0, PlusZ, -20e-6), (0.03, MinusZ, -20e-6)]);
    load(&mut pair, 0.01, [300.0, 0.0, -800.0, 0.0, 0.0]);
    let (_, solution) = solve(&mut pair);
    assert!(solution.shaft.error < 1e-9);
}

/// Wrong: face to face would not be softer under a moment. Balls push through the pressure centres, so the stiffness
/// against tilt goes with the square of their distance; the stiffness across the lines of contact is 1 % of it.
#[test]
fn under_a_moment_a_pair_is_as_stiff_as_the_square_of_its_pressure_centres_apart() {
    let model = bare();
    let d0 = shift(&model, 500.0);
    let half = 0.05;
    let tilt = |orientations: [Orientation; 2]| {
        let [first, second] = orientations;
        let mut pair = rigid(&[(-half, first, d0), (half, second, d0)]);
        let (solver, solution) = solve(&mut pair);
        let linear = LinearAssembly::new(&pair, &solver, &solution, DampingLaws::default()).unwrap();
        let before = linear.of_shaft(&pair, 0.0).unwrap()[3][3];
        // A small moment turns it as the matrix says.
        load(&mut pair, 0.0, [0.0, 0.0, 0.0, 0.5, 0.0]);
        let (_, moved) = solve(&mut pair);
        assert_near(moved.shaft.displacements[3], 0.5 / before, 1e-3);
        (before, solution.bearings[0].balls[0].inner.contact_angle_rad)
    };
    let (back, angle) = tilt([PlusZ, MinusZ]);
    let (face, _) = tilt([MinusZ, PlusZ]);
    let g = &model.geometry;
    let beyond = 0.5 * g.pitch_diameter() * angle.tan();
    // Half the distance of the inner groove centres is that of the balls and a little.
    let balls = half - (g.inner_groove_radius - 0.5 * g.ball_diameter) * g.free_contact_angle().sin();
    let facing = half + (g.inner_groove_radius - 0.5 * g.ball_diameter) * g.free_contact_angle().sin();
    let ratio = ((balls + beyond) / (facing - beyond)).powi(2);
    println!("back to back {back:.4e}, face to face {face:.4e} N m/rad, levers {ratio}");
    assert_near(back / face, ratio, 0.02);
}

/// Wrong: bearings in a row would not share what presses them both.
#[test]
fn tandem_bearings_share_the_thrust() {
    let mut set = rigid(&[(0.0, PlusZ, 0.0), (0.016, PlusZ, 0.0), (0.06, MinusZ, 0.0)]);
    load(&mut set, 0.0, [0.0, 0.0, 900.0, 0.0, 0.0]);
    let (_, solution) = solve(&mut set);
    for bearing in 0..2 {
        assert_near(solution.bearings[bearing].shaft_reaction[2], 450.0, 1e-9);
    }
    assert!(forces(&solution, 2).iter().all(|f| *f == 0.0));
}

const COMBINED: [f64; 5] = [300.0, -120.0, 400.0, 2.0, -1.0];

/// Wrong: a sign of the turned bearing. The whole assembly turned by 180 deg about x, loads and all, moves as the first
/// one, turned.
#[test]
fn an_assembly_turned_about_x_gives_turned_answers() {
    let places = [(0.0, PlusZ, 8e-6), (0.03, MinusZ, 8e-6), (0.1, MinusZ, 2e-6)];
    let turned: Vec<At> = places
        .iter()
        .map(|(z, o, s)| (-z, if *o == PlusZ { MinusZ } else { PlusZ }, *s))
        .collect();
    let (mut a, mut b) = (rigid(&places), rigid(&turned));
    load(&mut a, 0.07, COMBINED);
    load(&mut b, -0.07, MinusZ.turned(COMBINED));
    let (found, mirrored) = (solve(&mut a).1, solve(&mut b).1);
    let q: [f64; 5] = std::array::from_fn(|i| mirrored.shaft.displacements[i]);
    let scales = [1e-5, 1e-5, 1e-5, 1e-4, 1e-4];
    for (i, (a, b)) in found.shaft.displacements.iter().zip(MinusZ.turned(q)).enumerate() {
        assert!((a - b).abs() <= 1e-11 * scales[i], "{i}: {a:e} {b:e}");
    }
}

/// Place of a point of the axis at distance `s` from the origin, by the rotation vector of the shaft.
fn on_axis([a, b]: [f64; 2], s: f64) -> [f64; 3] {
    let t = a.hypot(b);
    let sinc = if t == 0.0 { 1.0 } else { t.sin() / t };
    [s * b * sinc, -s * a * sinc, s * t.cos()]
}

/// Wrong: loads on the shaft and the forces of the bearings would not balance, wherever the loads act. All do no work
/// on a small motion of the tilted shaft.
#[test]
fn bearings_carry_what_loads_along_the_shaft_ask_for() {
    let mut pair = rigid(&[(0.0, PlusZ, 10e-6), (0.05, MinusZ, 10e-6)]);
    load(&mut pair, -0.04, [500.0, 0.0, 0.0, 0.0, 0.0]);
    load(&mut pair, 0.11, [0.0, -350.0, 120.0, 1.0, 3.0]);
    let (_, solution) = solve(&mut pair);
    let q = &solution.shaft.displacements;
    let forces: Vec<(f64, [f64; 5])> = (0..2)
        .map(|i| (pair.bearings[i].place.position, pair.force_on_shaft(i, &solution)))
        .chain([
            (-0.04, [500.0, 0.0, 0.0, 0.0, 0.0]),
            (0.11, [0.0, -350.0, 120.0, 1.0, 3.0]),
        ])
        .collect();
    // Work of the forces where the tilts are by `h` larger and smaller; moments are small.
    for k in 0..2 {
        let h = 1e-4;
        let work = |sign: f64| -> f64 {
            let mut tilt = [q[3], q[4]];
            tilt[k] += sign * h;
            let of = |(s, f): &(f64, [f64; 5])| -> f64 {
                let x = on_axis(tilt, *s);
                (0..3).map(|i| f[i] * x[i]).sum::<f64>() + f[3] * tilt[0] + f[4] * tilt[1]
            };
            forces.iter().map(of).sum()
        };
        let left = (work(1.0) - work(-1.0)) / (2.0 * h);
        assert!(left.abs() < 1e-9 * 500.0 * 0.05, "{k}: {left:e}");
    }
    for k in 0..3 {
        let left: f64 = forces.iter().map(|(_, f)| f[k]).sum();
        assert!(left.abs() < 1e-10 * 500.0, "{k}: {left:e}");
    }
}

/// Wrong: forces on a tilted shaft would keep the arms of the straight one. A bearing that stands off the origin and is
/// turned round by a list, under a force along the axis and one across at other places, against the bearing alone with
/// the same forces about its own place: linear arms leave half a per cent of the tilt.
#[test]
fn a_bearing_off_the_origin_tilts_as_alone() {
    const AT: f64 = 0.07;
    for (radial, axial, place) in [(300.0, 3000.0, 0.03), (-80.0, 600.0, -0.02)] {
        let case = Case {
            radial,
            free_tilt: true,
            ..Case::axial(axial)
        };
        let mut alone = case.rigid();
        alone.load_point = place - AT;
        alone.contact.projects_grooves = true;
        alone.shaft = [dynamics::ShaftDof::Free; 5];
        let expected = equilibrium(&alone).displacements.shaft;
        let mut one = rigid(&[(AT, PlusZ, 0.0)]);
        load(&mut one, place, [radial, 0.0, axial, 0.0, 0.0]);
        let (_, solution) = solve(&mut one);
        let found = one.shaft.station(AT).displacement(&solution.shaft.displacements);
        for k in 0..5 {
            let size = if k < 3 { 1e-5 } else { 1e-3 };
            assert!(
                (found[k] - expected[k]).abs() < 1e-8 * size,
                "{k}: {found:?} {expected:?}"
            );
        }
        println!("{expected:?}");
        assert!(expected[4].abs() > 1e-4, "{expected:?}");
    }
}

/// Wrong: a bearing on a shaft would be another than the bearing alone. Combined load, all dofs free.
#[test]
fn one_bearing_on_a_shaft_is_the_bearing_alone() {
    let case = Case {
        radial: 700.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    };
    for make in [bare as fn() -> Model, flexible] {
        let mut alone = make();
        alone.effects = case.rigid().effects;
        alone.shaft = [dynamics::ShaftDof::Free; 5];
        let expected = equilibrium(&alone);
        let mut one = on_shaft(
            ShaftBody::rigid(RigidInertia::default(), [None; 5]),
            &[(0.0, PlusZ, 0.0)],
            make,
        );
        load(&mut one, 0.0, [700.0, 0.0, 2000.0, 0.0, 0.0]);
        let (_, solution) = solve(&mut one);
        for (found, ball) in solution.bearings[0].balls.iter().zip(&expected.balls) {
            assert!((found.inner.force_n - ball.inner.force_n).abs() < 1e-6 * 500.0);
        }
        // Finite tilts of 1e-4 rad change the moments of nothing here: the load acts at the origin.
        for (a, b) in solution
            .shaft
            .displacements
            .iter()
            .zip(expected.displacements.shaft)
        {
            assert!((a - b).abs() < 1e-7 * 1e-4, "{a:e} {b:e}");
        }
    }
}

/// Wrong: the answer would depend on which bearing is written first.
#[test]
fn the_order_of_the_bearings_does_not_matter() {
    let mut places = vec![(0.0, PlusZ, 9e-6), (0.03, MinusZ, 9e-6), (0.09, MinusZ, 3e-6)];
    let mut first = rigid(&places);
    places.rotate_left(1);
    let mut second = rigid(&places);
    load(&mut first, 0.06, COMBINED);
    load(&mut second, 0.06, COMBINED);
    let (a, b) = (solve(&mut first).1, solve(&mut second).1);
    for (i, (a, b)) in a
        .shaft
        .displacements
        .iter()
        .zip(&b.shaft.displacements)
        .enumerate()
    {
        let scale: f64 = if i < 3 { 1e-5 } else { 1e-4 };
        assert!(
            (a - b).abs() < 1e-12 * scale.max(a.abs()) * 10.0,
            "{i}: {a:e} {b:e}"
        );
    }
}

fn spindle(young: f64) -> BeamShaft {
    let mut material = steel();
    material.young_modulus *= young;
    let section = |from: f64, to: f64, outside: f64| BeamSection {
        from,
        to,
        outside,
        bore: 0.02,
    };
    BeamShaft {
        sections: vec![section(-0.06, -0.01, 0.06), section(-0.01, 0.12, 0.05)],
        material,
        longest_element: 0.02,
    }
}

fn on_beam(young: f64, places: &[At], loaded_at: f64, make: impl Fn() -> Model) -> Assembly {
    let stations: Vec<f64> = places.iter().map(|p| p.0).chain([loaded_at]).collect();
    on_shaft(ShaftBody::beam(&spindle(young), &stations).unwrap(), places, make)
}

/// Wrong: a beam would not become the rigid shaft as it stiffens.
#[test]
fn a_beam_of_a_million_times_the_stiffness_is_a_rigid_shaft() {
    let places = [(0.0, PlusZ, 9e-6), (0.1, MinusZ, 9e-6)];
    let (mut stiff, mut solid) = (on_beam(1e6, &places, -0.05, bare), rigid(&places));
    load(&mut stiff, -0.05, COMBINED);
    load(&mut solid, -0.05, COMBINED);
    let (a, b) = (solve(&mut stiff).1, solve(&mut solid).1);
    for (bearing, (x, y)) in a.bearings.iter().zip(&b.bearings).enumerate() {
        for (p, q) in x.balls.iter().zip(&y.balls) {
            assert!(
                (p.inner.force_n - q.inner.force_n).abs() < 1e-5 * 100.0,
                "bearing {bearing}: {} {}",
                p.inner.force_n,
                q.inner.force_n
            );
        }
    }
    // A shaft of steel gives way.
    let mut soft = on_beam(1.0, &places, -0.05, bare);
    load(&mut soft, -0.05, COMBINED);
    let (_, soft) = solve(&mut soft);
    assert!(soft.shaft.displacements[0] > b.shaft.displacements[0]);
}

/// Wrong: a matrix of the shaft at a point, a turned matrix, or a lever. Small changes of the load at the point move it
/// as the matrix says, to the square of the change.
#[test]
fn the_stiffness_of_the_shaft_is_that_of_differences() {
    for make in [
        || rigid(&[(0.0, PlusZ, 9e-6), (0.1, MinusZ, 9e-6)]),
        || rigid(&[(-0.045, PlusZ, 0.0)]),
        || on_beam(1.0, &[(0.0, PlusZ, 9e-6), (0.1, MinusZ, 9e-6)], -0.05, bare),
    ] {
        let mut assembly = make();
        load(&mut assembly, -0.05, COMBINED);
        let (solver, at) = solve(&mut assembly);
        let linear = LinearAssembly::new(&assembly, &solver, &at, DampingLaws::default()).unwrap();
        let matrix = linear.of_shaft(&assembly, -0.05).unwrap();
        let place = assembly.shaft.station(-0.05);
        let mut moved = |j: usize, sign: f64| {
            let mut change = COMBINED;
            change[j] += sign * if j < 3 { 0.02 } else { 0.0005 };
            assembly.load = ShaftLoads::none(&assembly.shaft);
            load(&mut assembly, -0.05, change);
            let (_, solution) = solve(&mut assembly);
            place.displacement(&solution.shaft.displacements)
        };
        for j in 0..5 {
            let (low, high) = (moved(j, -1.0), moved(j, 1.0));
            for i in 0..5 {
                let arm = |k: usize| if k < 3 { 1.0 } else { 0.03 };
                let load: f64 = (0..5).map(|k| matrix[i][k] * (high[k] - low[k])).sum();
                let expected = match i == j {
                    true => 2.0 * if j < 3 { 0.02 } else { 0.0005 },
                    false => 0.0,
                };
                let scale = arm(i) * if j < 3 { 0.04 } else { 0.001 / 0.03 };
                assert!(
                    (load - expected).abs() < 2e-6 * scale,
                    "{i} {j}: {load:e} {expected:e}"
                );
            }
        }
    }
}

/// Wrong: flexible rings of a pair, which share their factors, would depend on threads.
#[test]
fn flexible_pairs_have_the_same_bits_on_one_and_two_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut pair = on_beam(1.0, &[(0.0, PlusZ, 9e-6), (0.05, MinusZ, 9e-6)], -0.05, flexible);
            load(&mut pair, -0.05, COMBINED);
            let (solver, solution) = solve(&mut pair);
            assert_eq!(solver.types().len(), 1, "one factorisation for both");
            (
                solution.shaft.displacements,
                solution.bearings[1].balls[3].outer.force_n,
            )
        })
    };
    assert_eq!(run(1), run(2));
}

/// Wrong: the rings of a pair would yield otherwise than those of a bearing alone under the same preload.
#[test]
fn a_flexible_pair_is_twice_as_stiff_as_one_flexible_bearing_under_its_preload() {
    let places = [(0.0, PlusZ, 10e-6), (0.03, MinusZ, 10e-6)];
    let mut pair = on_shaft(
        ShaftBody::rigid(RigidInertia::default(), [None; 5]),
        &places,
        flexible,
    );
    let (solver, solution) = solve(&mut pair);
    assert!(solution.shaft.error < 1e-9, "{:e}", solution.shaft.error);
    let linear = LinearAssembly::new(&pair, &solver, &solution, DampingLaws::default()).unwrap();
    let found = linear.of_shaft(&pair, 0.0).unwrap()[2][2];
    let preload = solution.bearings[0].shaft_reaction[2];
    let mut alone = flexible();
    alone.effects = Case::axial(preload).rigid().effects;
    let mut solver = StaticSolver::new(&alone).unwrap();
    let one = solver.solve(&alone, None).unwrap();
    assert_near(one.displacements.shaft[2], 10e-6, 1e-8);
    let linear = Linearisation::new(&alone, &solver, &one, DampingLaws::default()).unwrap();
    assert_near(found, 2.0 * linear.stiffness().unwrap()[2][2], 1e-7);
}

/// Wrong: a shaft that nothing holds would get an answer, or a message that helps nobody.
#[test]
fn what_nothing_holds_is_said() {
    let mut pair = rigid(&[(0.0, PlusZ, 1e-5), (0.03, MinusZ, 1e-5)]);
    load(&mut pair, 0.0, [0.0, 0.0, 1e9, 0.0, 0.0]);
    let mut solver = AssemblySolver::new(&pair).unwrap();
    let error = solver.solve(&mut pair, None).err().unwrap();
    assert!(matches!(error, AssemblyError::NoEquilibrium { .. }), "{error}");
    let text = error.to_string();
    assert!(
        text.contains(
            "there is no equilibrium: z of the shaft in bearing \"number 0\" moves beyond 4.500 mm"
        ),
        "{text}"
    );
    let mut loose = rigid(&[(0.0, PlusZ, -5e-6), (0.03, MinusZ, -5e-6)]);
    let mut solver = AssemblySolver::new(&loose).unwrap();
    let error = solver.solve(&mut loose, None).err().unwrap().to_string();
    assert!(
        error.starts_with("nothing holds x of the shaft at the solution"),
        "{error}"
    );
}
