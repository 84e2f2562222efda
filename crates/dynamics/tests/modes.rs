//! Natural modes: closed forms, convergence with the mesh, agreement with statics.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::support::rings::{Level, ring, ring_model};
use crate::support::{Case, equilibrium, on_threads};
use contact::Side;
use dynamics::modes::{bearing_modes, ring_modes};
use dynamics::{
    ContactMode, DampingLaws, Hold, Linearisation, Mode, ModeSet, Model, ModesSettings, RingModel,
    RingSupport, StaticSolution, StaticSolver,
};
use mesh::{ElementKind, Section, revolve};

const SMALL: Level = Level::hex8(54, 6, 1, 2);

fn settings(number: usize) -> ModesSettings {
    ModesSettings {
        number,
        shift: None,
        backend: dynamics::Backend::Auto,
    }
}

fn alone(side: Side, ring: &RingModel, support: RingSupport, number: usize) -> ModeSet {
    ring_modes(side, ring, support, settings(number), &mut |_| ()).unwrap()
}

fn loaded(model: &Model, solution: &StaticSolution, number: usize) -> ModeSet {
    bearing_modes(model, solution, settings(number), &mut |_| ()).unwrap()
}

fn frequencies(set: &ModeSet) -> Vec<f64> {
    set.modes.iter().map(|m| m.frequency).collect()
}

fn elastic(set: &ModeSet) -> Vec<f64> {
    let modes = set.modes.iter().filter(|m| !m.is_rigid);
    modes.map(|m| m.frequency).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a / b - 1.0).abs())
        .fold(0.0, f64::max)
}

/// A ring of square section, side `side`, mean radius `radius`, m, with 3 x 3 elements: torsion warps the section.
fn square_ring(radius: f64, side: f64, sectors: usize) -> RingModel {
    let n = 3;
    let node = |i: usize, j: usize| i * (n + 1) + j;
    let place = |i: usize| i as f64 / n as f64 - 0.5;
    let grid = |m: usize| (0..m).flat_map(move |i| (0..m).map(move |j| (i, j)));
    let points = grid(n + 1).map(|(i, j)| [radius + side * place(i), side * place(j)]);
    let quads = grid(n).map(|(i, j)| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
    let edge = |i: usize| (0..n).map(|j| [node(i, j), node(i, j + 1)]).collect();
    let groups = BTreeMap::from([("raceway".to_string(), edge(n)), ("bore".to_string(), edge(0))]);
    let section = Section::new(points.collect(), quads.collect(), &groups).unwrap();
    let mesh = revolve(&section, sectors, ElementKind::Hex20, &[]).unwrap();
    let mut model = ring_model(Side::Inner, mesh, Hold::Clamped);
    model.groove.centre_radius = radius;
    model
}

/// Wrong: natural frequencies of rings. Thin ring, Love (Mathematical Theory of Elasticity, 4th ed., art. 293):
/// bending in its plane, w^2 = E I/(rho A R^4) n^2 (n^2-1)^2/(n^2+1), and across it, with E I/(G J) for the 1, J =
/// 0.1406 a^4. The theory leaves out shear, extension and rotary inertia, of order (n a/R)^2.
#[test]
fn a_thin_ring_bends_as_love_says() {
    let (radius, side) = (0.1, 4e-3);
    let ring = square_ring(radius, side, 96);
    let set = alone(Side::Inner, &ring, RingSupport::Free, 14);
    let steel = ring.material;
    let inertia = side.powi(4) / 12.0;
    let twist = inertia * 2.0 * (1.0 + steel.poisson_ratio) / (0.1406 * side.powi(4));
    let scale = steel.young_modulus * inertia / (steel.density * side * side * radius.powi(4));
    let love = |n: f64, one: f64| (scale * n * n * (n * n - 1.0).powi(2) / (n * n + one)).sqrt() / TAU;
    let expected = [love(2.0, twist), love(2.0, 1.0), love(3.0, twist), love(3.0, 1.0)];
    let found = elastic(&set);
    assert_eq!(found.len(), 8, "six rigid motions");
    for (i, f) in expected.iter().enumerate() {
        let n = [2.0, 2.0, 3.0, 3.0][i];
        let theory = (n * side / radius) * (n * side / radius);
        for found in [found[2 * i], found[2 * i + 1]] {
            println!(
                "n = {n}: {found:.4} Hz, Love {f:.4} Hz, {:+.2e} of {theory:.1e}",
                found / f - 1.0
            );
            assert!((found / f - 1.0).abs() < theory, "{found} {f}");
        }
        assert!(
            (found[2 * i] / found[2 * i + 1] - 1.0).abs() < 1e-7,
            "double modes"
        );
    }
}

/// Wrong: a free ring would resist rigid motions, have other than six, or its elastic modes would not converge with
/// the mesh. omega^2 of rigid motions is below 1e-6 of the first elastic one.
#[test]
fn free_rings_converge_and_have_six_rigid_motions() {
    for side in Side::BOTH {
        let find = |level| alone(side, &ring(side, level, Hold::Clamped), RingSupport::Free, 10);
        let fine = find(Level::hex20(56, 10, 3, 3));
        for (level, limit) in [
            (Level::hex20(48, 8, 2, 3), 1e-3),
            (Level::hex8(90, 10, 3, 3), 1.5e-2),
        ] {
            let set = find(level);
            let rigid: Vec<&Mode> = set.modes.iter().filter(|m| m.is_rigid).collect();
            assert_eq!(rigid.len(), 6);
            let first = elastic(&set)[0];
            let largest = rigid
                .iter()
                .map(|m| (m.frequency / first).powi(2))
                .fold(0.0, f64::max);
            let difference = largest_difference(&elastic(&set), &elastic(&fine));
            println!(
                "{} {level:?}: {} dofs, {} steps, {:?} s, first {first:.2} Hz, rigid {largest:.1e}, {difference:.2e}",
                side.name(),
                set.n_unknowns,
                set.steps,
                set.laps
            );
            assert!(largest < 1e-6, "{largest:e}");
            assert!(difference < limit, "{difference:e}");
        }
    }
}

/// Wrong: clamping would not hold, or a mean-motion hold would stiffen what it must leave free. Modes of two and more
/// waves round the ring have no mean motion of the bore, so they are those of the free ring; the others must rise
/// from zero.
#[test]
fn held_rings_have_the_modes_their_hold_leaves() {
    for side in Side::BOTH {
        let free = elastic(&alone(
            side,
            &ring(side, SMALL, Hold::Clamped),
            RingSupport::Free,
            20,
        ));
        let mean = alone(
            side,
            &ring(side, SMALL, Hold::MeanMotion),
            RingSupport::AsHeld,
            14,
        );
        assert!(mean.modes.iter().all(|m| !m.is_rigid), "{:?}", frequencies(&mean));
        // The two ovals are the lowest of both.
        assert!(largest_difference(&free[..2], &frequencies(&mean)[..2]) < 1e-8);
        let shared = frequencies(&mean);
        let shared = shared
            .iter()
            .filter(|f| free.iter().any(|g| (*f / g - 1.0).abs() < 1e-7));
        assert!(shared.count() >= 6);
        let clamped = alone(side, &ring(side, SMALL, Hold::Clamped), RingSupport::AsHeld, 4);
        println!("{}: free {:?}", side.name(), &free[..4]);
        println!(
            "mean {:?}, clamped {:?}",
            frequencies(&mean),
            frequencies(&clamped)
        );
        assert!(frequencies(&clamped)[0] > 10.0 * free[0]);
    }
}

/// Wrong: modes of a clamped ring would depend on its mesh. The edges of the clamped surface are singular, which makes
/// convergence slower than that of free rings.
#[test]
fn coarse_and_fine_clamped_rings_agree() {
    let find = |level| {
        let ring = ring(Side::Inner, level, Hold::Clamped);
        elastic(&alone(Side::Inner, &ring, RingSupport::AsHeld, 6))
    };
    let (coarse, fine) = (find(Level::hex20(36, 6, 2, 2)), find(Level::hex20(48, 8, 2, 3)));
    println!("clamped: {coarse:?} {fine:?}");
    assert!(largest_difference(&coarse, &fine) < 1e-2);
}

/// Stiffness of one contact [[rr, rz], [rz, zz]] from its reported force, angle and approach: k n n^T + Q/l (1 - n
/// n^T), k = 3/2 K^(2/3) Q^(1/3).
fn tangent(model: &Model, solution: &StaticSolution, side: Side) -> [[f64; 2]; 2] {
    let ball = &solution.balls[0];
    let contact = if side == Side::Inner {
        &ball.inner
    } else {
        &ball.outer
    };
    let k = 1.5 * model.hertz[side.index()].stiffness.powf(2.0 / 3.0) * contact.force_n.cbrt();
    let across = contact.force_n / (model.geometry.touching_distance(side) + contact.approach_m);
    let (s, c) = contact.contact_angle_rad.sin_cos();
    [
        [k * c * c + across * s * s, (k - across) * s * c],
        [(k - across) * s * c, k * s * s + across * c * c],
    ]
}

/// Frequencies, Hz, of a small problem by a characteristic polynomial's roots: Jacobi rotations of M^-1/2 K M^-1/2.
fn small_frequencies(k: &[&[f64]], m: &[f64]) -> Vec<f64> {
    let n = m.len();
    let mut a: Vec<Vec<f64>> = (0..n)
        .map(|i| (0..n).map(|j| k[i][j] / (m[i] * m[j]).sqrt()).collect())
        .collect();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
                let (s, c) = angle.sin_cos();
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for j in 0..n {
                    (a[p][j], a[q][j]) = (c * a[p][j] - s * a[q][j], s * a[p][j] + c * a[q][j]);
                }
            }
        }
    }
    (0..n).map(|i| a[i][i].max(0.0).sqrt() / TAU).collect()
}

/// Frequencies of a bearing with rigid rings under pure thrust, tilt locked, whose shaft has the mass `shaft`: by
/// symmetry the balls and z move together, x and y go with one wave of the balls, and the other waves leave the shaft
/// at rest.
fn thrust_frequencies(model: &Model, solution: &StaticSolution, shaft: f64) -> Vec<f64> {
    let [inner, outer] = Side::BOTH.map(|side| tangent(model, solution, side));
    let ball = [0, 1].map(|i| [0, 1].map(|j| inner[i][j] + outer[i][j]));
    let (z, m) = (model.geometry.n_balls, model.ball_mass());
    // Coordinates of a wave: balls radial and axial with norm 1, shaft.
    let with_shaft = |direction: usize, share: f64| {
        let (r, a) = (-share * inner[0][direction], -share * inner[1][direction]);
        small_frequencies(
            &[
                &[ball[0][0], ball[0][1], r],
                &[ball[1][0], ball[1][1], a],
                &[r, a, share * share * inner[direction][direction]],
            ],
            &[m, m, shaft],
        )
    };
    let mut all = with_shaft(1, (z as f64).sqrt());
    for _ in 0..2 {
        all.extend(with_shaft(0, (0.5 * z as f64).sqrt()));
    }
    let alone = small_frequencies(&[&ball[0], &ball[1]], &[m, m]);
    (0..z - 3).for_each(|_| all.extend(&alone));
    all.sort_by(f64::total_cmp);
    all
}

/// Wrong: the contact tangent, its geometric part, or the masses. 2 kN thrust on rigid rings: all 39 modes by symmetry.
#[test]
fn a_rigid_bearing_has_the_modes_of_its_symmetry() {
    let mut model = Case::axial(2000.0).rigid();
    model.shaft_mass = 0.8;
    let solution = equilibrium(&model);
    let set = loaded(&model, &solution, 50);
    let expected = thrust_frequencies(&model, &solution, 0.8);
    assert_eq!(set.modes.len(), 39);
    let difference = largest_difference(&frequencies(&set), &expected);
    println!("lowest {:?}, highest {:.1} Hz", &expected[..6], expected[38]);
    assert!(difference < 1e-9, "{difference:e}");
    for mode in &set.modes {
        assert!((mode.kinetic.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(mode.bound < 1e-6 * mode.frequency, "{}", mode.bound);
    }
}

/// Wrong: a shaft without mass would be refused or get a frequency of its own: it follows the balls.
#[test]
fn a_shaft_without_mass_follows_quasi_statically() {
    let mut model = Case::axial(2000.0).rigid();
    let solution = equilibrium(&model);
    let set = loaded(&model, &solution, 50);
    assert_eq!(set.modes.len(), 36, "two modes per ball");
    model.shaft_mass = 1e-9;
    let light = thrust_frequencies(&model, &solution, 1e-9);
    assert!(largest_difference(&frequencies(&set), &light[..36]) < 1e-6);
}

/// Wrong: balls without load would fill the lowest modes with motions at zero frequency, hold the others, or move in
/// them. What is left has two modes per loaded ball and those of the shaft, with elastic rings too. Residuals are of
/// the whole matrices.
#[test]
fn unloaded_balls_take_no_part_in_modes() {
    let mut case = Case::axial(100.0);
    case.radial = 3000.0;
    let mut model = case.rigid();
    model.shaft_mass = 0.8;
    let solution = equilibrium(&model);
    let unloaded: Vec<bool> = solution.balls.iter().map(|b| b.inner.force_n == 0.0).collect();
    let n_loose = unloaded.iter().filter(|is_loose| **is_loose).count();
    let n_loaded = unloaded.len() - n_loose;
    let set = loaded(&model, &solution, 50);
    assert!(n_loose > 2);
    assert_eq!([set.loose_balls, set.modes.len()], [n_loose, 2 * n_loaded + 3]);
    assert_eq!(set.n_unknowns, 2 * n_loaded + 3);
    assert!(
        set.modes
            .iter()
            .all(|mode| !mode.is_rigid && mode.residual < 1e-6)
    );
    for mode in &set.modes {
        let balls = mode.shape.balls.iter().zip(&unloaded);
        assert!(
            balls
                .filter(|(_, is_loose)| **is_loose)
                .all(|(u, _)| u.norm() == 0.0)
        );
    }
    // The same by Lanczos.
    let mut elastic = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    elastic.shaft_mass = 0.8;
    let solution = equilibrium(&elastic);
    let set = loaded(&elastic, &solution, 12);
    assert!(set.steps > 0 && set.loose_balls > 2 && set.modes.len() == 12);
    assert!(
        set.modes
            .iter()
            .all(|mode| !mode.is_rigid && mode.residual < 1e-6)
    );
}

/// Wrong: rings would be coupled to balls and shaft otherwise than rigid ones when they are stiff. Rings 1e4 times
/// stiffer than steel, their mass on the shaft of the rigid model.
#[test]
fn stiff_rings_have_the_modes_of_rigid_ones() {
    let mut model = Case::axial(2000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    // Contacts that know nothing of each other: the expected tangents are those.
    model.sphere = Default::default();
    model.shaft_mass = 0.5;
    for ring in &mut model.rings {
        let ring = std::sync::Arc::get_mut(ring.as_mut().unwrap()).unwrap();
        ring.material.young_modulus *= 1e4;
    }
    let solution = equilibrium(&model);
    let inner = model.ring(Side::Inner).unwrap();
    let carried = fem::inertia(&inner.mesh, &inner.material).unwrap().mass;
    let set = loaded(&model, &solution, 39);
    let expected = thrust_frequencies(&model, &solution, 0.5 + carried);
    let difference = largest_difference(&frequencies(&set), &expected);
    println!(
        "{} unknowns, {} steps, {difference:.2e}",
        set.n_unknowns, set.steps
    );
    assert!(difference < 1e-3, "{difference:e}");
    let balls = &set.modes[20];
    assert!(balls.kinetic[2] > 0.9, "{:?}", balls.kinetic);
}

/// Wrong: the stiffness of the modes would not be that of the equilibrium's own change under load. A heavy shaft on the
/// bearing: omega^2 = (dF/du)/m, with the slope of the static displacement under the load, for both holds.
#[test]
fn a_heavy_shaft_swings_on_the_static_stiffness() {
    let mass = 1e4;
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let build = |axial: f64, radial: f64| {
            let case = Case {
                radial,
                ..Case::axial(axial)
            };
            let mut model = case.flexible(ContactMode::Patch, SMALL, hold);
            model.shaft_mass = mass;
            let solution = equilibrium(&model);
            (model, solution)
        };
        let (model, solution) = build(2000.0, 0.0);
        let set = loaded(&model, &solution, 3);
        let step = 1.0;
        let slope = |dof: usize, load: [f64; 2]| {
            let at = |sign: f64| {
                build(2000.0 + sign * load[0], sign * load[1])
                    .1
                    .displacements
                    .shaft[dof]
            };
            2.0 * step / (at(1.0) - at(-1.0))
        };
        let axial = (slope(2, [step, 0.0]) / mass).sqrt() / TAU;
        let radial = (slope(0, [0.0, step]) / mass).sqrt() / TAU;
        println!("{hold:?}: {:?}, static {axial} {radial}", frequencies(&set));
        let mut expected = [axial, radial, radial];
        expected.sort_by(f64::total_cmp);
        // Rings and balls swing along: their mass over the shaft's is 4e-5.
        assert!(largest_difference(&frequencies(&set), &expected) < 4e-5);
        assert!(set.modes.iter().all(|m| m.kinetic[3] > 0.999));
    }
}

/// Wrong: a shaft would tilt without inertia, or a rigid ring's would differ from a flexible one's. A rotor of much
/// inertia on the bearing: omega^2 = (dM/dt)/I, with the slope of the static tilt under the moment.
#[test]
fn a_heavy_rotor_tilts_on_the_static_stiffness() {
    let inertia = 1e2;
    for hold in [None, Some(Hold::Clamped), Some(Hold::MeanMotion)] {
        let build = |moment: f64| {
            let case = Case {
                moment,
                free_tilt: true,
                ..Case::axial(2000.0)
            };
            let mut model = match hold {
                Some(hold) => case.flexible(ContactMode::Patch, SMALL, hold),
                None => case.rigid(),
            };
            for dof in 0..3 {
                model.shaft[dof] = dynamics::ShaftDof::Prescribed(if dof == 2 { 10e-6 } else { 0.0 });
            }
            model.shaft_inertia.transverse = inertia;
            let solution = equilibrium(&model);
            (model, solution)
        };
        let (model, solution) = build(0.0);
        let set = loaded(&model, &solution, 2);
        let tilt = |moment: f64| build(moment).1.displacements.shaft[3];
        let moment = 0.1;
        let expected = (2.0 * moment / (tilt(moment) - tilt(-moment)) / inertia).sqrt() / TAU;
        println!("{hold:?}: {:?}, static {expected}", frequencies(&set));
        // The slope is not quite straight: with a tenth of the moment a hundredth of the difference is left.
        assert!(largest_difference(&frequencies(&set), &[expected; 2]) < 3e-5);
        assert!(set.modes.iter().all(|m| m.kinetic[3] > 0.999));
    }
}

/// Wrong: patches of a bearing that vibrates would stay where they are, as those of its stiffness do not. A rotor of
/// much mass and inertia: all five frequencies from the stiffness of the bearing, which has patches that go along.
#[test]
fn patches_go_along_as_in_the_stiffness() {
    let (mass, inertia) = (1e4, 1e2);
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let case = Case {
            radial: 1000.0,
            free_tilt: true,
            ..Case::axial(2000.0)
        };
        let mut model = case.flexible(ContactMode::Patch, SMALL, hold);
        model.shaft_mass = mass;
        model.shaft_inertia.transverse = inertia;
        let mut solver = StaticSolver::new(&model).unwrap();
        let solution = solver.solve(&model, None).unwrap();
        let settings = ModesSettings {
            shift: Some(20.0),
            ..settings(5)
        };
        let found = frequencies(&bearing_modes(&model, &solution, settings, &mut |_| ()).unwrap());
        let masses = [mass, mass, mass, inertia, inertia];
        let of = |bearing: Linearisation| {
            let k = bearing.stiffness().unwrap();
            let half = |i: usize| [0, 1, 2, 3, 4].map(|j| 0.5 * (k[i][j] + k[j][i]));
            let rows = [0, 1, 2, 3, 4].map(half);
            let mut expected = small_frequencies(&rows.each_ref().map(|row| row.as_slice()), &masses);
            expected.sort_by(f64::total_cmp);
            expected
        };
        let moving = of(Linearisation::new(&model, &solver, &solution, DampingLaws::default()).unwrap());
        let stays = of(Linearisation::as_solved(&model, &solution).unwrap());
        let [error, before] = [&moving, &stays].map(|expected| largest_difference(&found, expected));
        println!(
            "{hold:?}: {found:?}, {moving:?}, {stays:?}: {error:.1e} off, {before:.1e} of patches that stay"
        );
        // Rings and balls swing along: their mass is 3e-5 of the shaft's.
        assert!(error < 1e-5 && before > 50.0 * error, "{error} {before}");
    }
}

/// Wrong: shapes or frequencies would depend on the number of threads.
#[test]
fn modes_have_the_same_bits_on_any_number_of_threads() {
    let find = |threads: usize| {
        on_threads(threads, || {
            let mut model = Case::axial(2000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
            model.shaft_mass = 1.0;
            let solution = equilibrium(&model);
            loaded(&model, &solution, 6).modes
        })
    };
    assert!(find(1) == find(2), "modes differ");
}

/// Wrong: choices without modes would be ignored instead of refused.
#[test]
fn what_has_no_modes_is_refused_by_name() {
    let model = Case::axial(1000.0).flexible(ContactMode::Facet, SMALL, Hold::Clamped);
    let solution = equilibrium(&Case::axial(1000.0).rigid());
    let error = bearing_modes(&model, &solution, settings(3), &mut |_| ()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("natural modes cannot have contact.mode = \"facet\""),
        "{text}"
    );
}
