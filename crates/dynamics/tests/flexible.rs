//! Flexible rings: convergence of ball forces and contact angles, limits, symmetries, and what facets get wrong.

use std::path::Path;
use std::sync::Arc;

use crate::support::rings::{Level, ring_model};
use crate::support::{Case, equilibrium, relative};
use contact::Side;
use dynamics::{ContactMode, Hold, Model, ShaftDof, StaticSolution};

const COARSE: Level = Level::hex8(90, 6, 1, 2);
const MEDIUM: Level = Level::hex8(180, 10, 3, 4);
const FINE: Level = Level::hex8(306, 16, 4, 6);

fn patch(case: &Case, level: Level, hold: Hold) -> StaticSolution {
    equilibrium(&case.flexible(ContactMode::Patch, level, hold))
}

/// Largest differences of ball forces (relative to the largest force) and of contact angles (deg).
fn difference(a: &StaticSolution, b: &StaticSolution) -> (f64, f64) {
    let scale = b.balls.iter().map(|x| x.inner.force_n).fold(0.0, f64::max);
    let pairs = || a.balls.iter().zip(&b.balls);
    let force = pairs()
        .map(|(x, y)| (x.inner.force_n - y.inner.force_n).abs() / scale)
        .fold(0.0, f64::max);
    let loaded = pairs().filter(|(x, y)| x.inner.force_n > 0.0 && y.inner.force_n > 0.0);
    let angle = loaded.map(|(x, y)| (x.inner.contact_angle_rad - y.inner.contact_angle_rad).abs());
    (force, angle.fold(0.0, f64::max).to_degrees())
}

fn thrust() -> Case {
    Case::axial(2000.0)
}

fn radial(free_tilt: bool) -> Case {
    Case {
        radial: 1000.0,
        free_tilt,
        ..thrust()
    }
}

/// Wrong: forces would depend on the mesh. Between the two finest of three meshes forces change by less than 0.2 % and
/// contact angles by less than 0.1 deg, and less than between the two coarser ones.
#[test]
fn patch_contact_converges_over_three_meshes() {
    let cases = [thrust(), radial(true)];
    // One factorisation per mesh serves both cases.
    let [coarse, medium, fine] = [COARSE, MEDIUM, FINE].map(|level| {
        let mut model = cases[0].flexible(ContactMode::Patch, level, Hold::Clamped);
        let mut solver = dynamics::StaticSolver::new(&model).unwrap();
        cases.map(|case| {
            model = Model {
                rings: model.rings.clone(),
                ..case.spheres()
            };
            model.contact.mode = ContactMode::Patch;
            solver.solve(&model, None).unwrap()
        })
    });
    for i in 0..cases.len() {
        let (before, _) = difference(&coarse[i], &medium[i]);
        let (force, angle) = difference(&medium[i], &fine[i]);
        println!("forces change by {before:.2e}, then {force:.2e}; angles by {angle:.4} deg");
        assert!(force < 2e-3 && angle < 0.1, "{force} {angle}");
        assert!(force < before, "{before} {force}");
    }
}

/// Wrong: one way of holding the rings or the shaft would not converge.
#[test]
fn every_support_converges() {
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        for free_tilt in [false, true] {
            let (coarse, medium) = (Level::hex8(108, 8, 2, 3), MEDIUM);
            let case = radial(free_tilt);
            let (force, angle) = difference(&patch(&case, coarse, hold), &patch(&case, medium, hold));
            println!("{hold:?}, tilt free {free_tilt}: {force:.2e} {angle:.4} deg");
            assert!(
                force < 4e-3 && angle < 0.1,
                "{hold:?} {free_tilt}: {force} {angle}"
            );
        }
    }
}

/// Wrong: a ball would feel where it stands between nodes, and rolling would make it vibrate. Ball on a node, a quarter
/// and half way to the next; contact at three places between two nodes of the groove.
#[test]
fn the_place_between_nodes_does_not_matter() {
    let mut forces = Vec::new();
    for groove in [10, 11, 12] {
        for share in [0.0, 0.25, 0.5] {
            let case = Case {
                phase: share * (360.0 / 180.0f64).to_radians(),
                ..thrust()
            };
            let solution = patch(&case, Level { groove, ..MEDIUM }, Hold::Clamped);
            forces.push(solution.balls[0].inner.force_n);
        }
        let same_mesh = &forces[forces.len() - 3..];
        let spread = same_mesh
            .iter()
            .map(|f| relative(*f, same_mesh[0]))
            .fold(0.0, f64::max);
        assert!(spread < 3e-4, "round the ring: {spread}");
    }
    let spread = forces.iter().map(|f| relative(*f, forces[0])).fold(0.0, f64::max);
    println!("spread {spread:.2e} over {forces:?}");
    assert!(spread < 1e-3, "{spread}");
}

/// Wrong: one kind of element would give another bearing. hex8, hex20 and (inner ring) tet10 agree within 0.3 %.
#[test]
fn element_kinds_agree() {
    let hex8 = patch(&thrust(), MEDIUM, Hold::Clamped);
    let hex20 = patch(&thrust(), Level::hex20(90, 8, 2, 3), Hold::Clamped);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/7010c_inner_tet10.msh");
    let mesh = mesh::read_msh(path, 1e-3).unwrap();
    let mut model = thrust().flexible(ContactMode::Patch, MEDIUM, Hold::Clamped);
    model.rings[0] = Some(Arc::new(ring_model(Side::Inner, mesh, Hold::Clamped)));
    let tet10 = equilibrium(&model);
    let mean = |s: &StaticSolution| s.balls.iter().map(|b| b.inner.force_n).sum::<f64>() / 18.0;
    println!(
        "hex8 {:.3} N, hex20 {:.3} N, tet10 {:.3} N",
        mean(&hex8),
        mean(&hex20),
        mean(&tet10)
    );
    let ((a, _), (b, _)) = (difference(&hex8, &hex20), difference(&tet10, &hex20));
    assert!(a < 3e-3, "hex8 against hex20: {a}");
    assert!(b < 3e-3, "tet10 against hex20: {b}");
}

/// Wrong: the flexible bearing would not contain the rigid one. Rings 1e4 times stiffer (1e5 where the bore may
/// ovalise, which is an order softer), the same Hertz contacts.
#[test]
fn stiff_rings_give_the_rigid_bearing() {
    for (hold, factor) in [(Hold::Clamped, 1e4), (Hold::MeanMotion, 1e5)] {
        let case = radial(true);
        let mut model = case.flexible(ContactMode::Patch, COARSE, hold);
        for slot in &mut model.rings {
            let mut ring = ring_model(
                slot.as_ref().unwrap().groove.side,
                slot.as_ref().unwrap().mesh.clone(),
                hold,
            );
            ring.material.young_modulus *= factor;
            *slot = Some(Arc::new(ring));
        }
        let (force, angle) = difference(&equilibrium(&model), &equilibrium(&case.spheres()));
        assert!(force < 1e-4 && angle < 1e-2, "{hold:?}: {force} {angle}");
    }
}

/// Wrong: contacts would see the numbering or the Cartesian axes of the mesh. 18 equal sectors, 18 equal forces.
#[test]
fn thrust_on_a_periodic_mesh_is_cyclic() {
    for level in [COARSE, Level::hex20(36, 4, 1, 1)] {
        let solution = patch(&thrust(), level, Hold::Clamped);
        for ball in &solution.balls {
            let first = &solution.balls[0];
            assert!(relative(ball.inner.force_n, first.inner.force_n) < 1e-10);
            assert!(relative(ball.outer.contact_angle_rad, first.outer.contact_angle_rad) < 1e-10);
        }
    }
}

/// Wrong: forces would not balance on flexible rings, or the energies would not belong to the forces.
#[test]
fn flexible_equilibrium_balances_forces_and_work() {
    for case in [
        radial(true),
        Case {
            radial: 3000.0,
            ..Case::axial(500.0)
        },
    ] {
        let solution = patch(&case, COARSE, Hold::MeanMotion);
        let residual = solution.shaft_residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
        assert!(residual < 1e-9 * case.axial.max(case.radial), "{residual}");
        for b in &solution.balls {
            let (i, o) = (&b.inner, &b.outer);
            assert!(
                (i.force_n - o.force_n).abs() < 1e-9 * 1000.0,
                "{} {}",
                i.force_n,
                o.force_n
            );
        }
        assert!(
            solution.work_defect.abs() < 1e-9 * solution.load_work,
            "{}",
            solution.work_defect
        );
        assert!(solution.strain_energy > 0.0);
    }
}

/// Wrong: warm starts along a sweep would lead elsewhere than a cold start.
#[test]
fn a_warm_start_gives_the_cold_answer() {
    let first = radial(false).flexible(ContactMode::Patch, COARSE, Hold::Clamped);
    let mut second = Case {
        radial: 2500.0,
        ..radial(false)
    }
    .flexible(ContactMode::Patch, COARSE, Hold::Clamped);
    let mut solver = dynamics::StaticSolver::new(&first).unwrap();
    let start = solver.solve(&first, None).unwrap();
    second.rings = first.rings.clone();
    let warm = solver.solve(&second, Some(&start)).unwrap();
    let (force, angle) = difference(&warm, &equilibrium(&second));
    assert!(force < 1e-8 && angle < 1e-6, "{force} {angle}");
}

/// Wrong: a sweep would call a ball off the groove that only its start has there: the shaft driven from one tilt to the
/// opposite one passes through places where no ball is in equilibrium.
#[test]
fn a_warm_start_after_a_large_drive_gives_the_cold_answer() {
    let mut model = thrust().flexible(ContactMode::Patch, COARSE, Hold::Clamped);
    let mut solver = dynamics::StaticSolver::new(&model).unwrap();
    model.shaft[4] = ShaftDof::Prescribed(5e-3);
    let start = solver.solve(&model, None).unwrap();
    model.shaft[4] = ShaftDof::Prescribed(-5e-3);
    let warm = solver.solve(&model, Some(&start)).unwrap();
    let (force, angle) = difference(&warm, &solver.solve(&model, None).unwrap());
    assert!(force < 1e-8 && angle < 1e-6, "{force} {angle}");
}

/// Wrong: light loads on flexible rings would be refused: round-off moves their forces by more than the tolerance.
#[test]
fn light_loads_settle() {
    let light = patch(&Case::axial(1e-4), COARSE, Hold::Clamped);
    let rigid = equilibrium(&Case::axial(1e-4).rigid());
    let (force, _) = difference(&light, &rigid);
    assert!(force < 1e-3, "{force}");
}

/// Wrong: unloaded balls, which may be anywhere, would be looked for on the facets, or a ball beyond the rim would be
/// blamed on the place of the mesh. Radial load alone: the balls opposite to it are loose. Smaller balls have a free
/// contact angle of 61 deg, and the groove ends at 58 deg.
#[test]
fn only_loaded_balls_can_leave_the_groove() {
    for mode in [ContactMode::Patch, ContactMode::Facet] {
        let loose = Case {
            radial: 50e3,
            ..Case::axial(0.0)
        };
        let mut model = loose.flexible(mode, COARSE, Hold::Clamped);
        let mut solver = dynamics::StaticSolver::new(&model).unwrap();
        assert!(solver.solve(&model, None).is_ok(), "{mode:?}");
        model.effects = Case::axial(100.0).rigid().effects;
        model.geometry.ball_diameter = 8.6e-3;
        let error = solver.solve(&model, None).err().unwrap().to_string();
        assert!(
            error.contains("leaves the inner raceway: contact angle"),
            "{mode:?}: {error}"
        );
    }
}

/// Wrong: the comparison mode would not show the two known errors of facets, or the default would share them.
/// Divergence: a finer mesh indents more under the nodes of one facet, so the contact angle rises (1.7 deg from 180
/// to 540 elements round for one-node loads in an independent prototype), while patches change by less than 0.05 deg.
/// Ripple: over one element the chord error changes the force by several percent, patches by less than 0.03 %.
#[test]
fn facets_diverge_and_ripple_where_patches_do_not() {
    let solve = |mode, level, phase| {
        let model = Case { phase, ..thrust() }.flexible(mode, level, Hold::Clamped);
        equilibrium(&model).balls[0]
    };
    let degrees = |mode, level| solve(mode, level, 0.0).inner.contact_angle_rad.to_degrees();
    let facet = [COARSE, MEDIUM, FINE].map(|level| degrees(ContactMode::Facet, level));
    println!("contact angle on facets: {facet:?} deg");
    assert!(facet[2] - facet[1] > 0.3, "{facet:?}");
    let half = (1.0f64).to_radians();
    let ripple = |mode| {
        relative(
            solve(mode, MEDIUM, 0.0).inner.force_n,
            solve(mode, MEDIUM, half).inner.force_n,
        )
    };
    let (facets, patches) = (ripple(ContactMode::Facet), ripple(ContactMode::Patch));
    println!("ripple: facets {facets:.2e}, patches {patches:.2e}");
    assert!(facets > 0.02, "{facets}");
    assert!(patches < 3e-4, "{patches}");
}

/// Wrong: quadratic facets, whose mid-nodes lie on the arc, would ripple by their chords. They still count the local
/// compliance twice, which differs under a node and between nodes: the chord's share is what is tested here.
#[test]
fn quadratic_facets_have_no_chord_error() {
    let level = Level::hex20(90, 8, 2, 2);
    let model: Model = thrust().flexible(ContactMode::Facet, level, Hold::Clamped);
    let ring = model.ring(Side::Outer).unwrap();
    let surface = contact::FacetSurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
    // A ball that touches the bottom of the groove.
    let radius = ring.groove.centre_radius + model.geometry.touching_distance(Side::Outer);
    for i in 0..20 {
        let azimuth = 0.01 * i as f64;
        let centre = [radius * azimuth.cos(), radius * azimuth.sin(), 0.0];
        let foot = surface.foot(centre, 6e-3, |n| ring.mesh.nodes[n]);
        let foot = foot.unwrap();
        let nodes = foot
            .nodes
            .iter()
            .map(|&n| ring.mesh.nodes[n])
            .zip(foot.weights.iter().copied());
        let chord = ring.groove.chord_offset(0.0, nodes);
        assert!(chord.abs() < 2e-8, "{azimuth}: {chord}");
    }
}
