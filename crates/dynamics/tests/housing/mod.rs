//! A ring tied to an elastic body: against the holds of rigid partners, and against ring and body meshed as one.

mod loads;
mod modes;
mod motion;
mod shaft;
mod shared;
mod smooth;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::support::rings::{Level, ring, turned};
use crate::support::{Case, equilibrium, on_threads, steel};
use body::{BesideRing, BodySeat, SeatBasis, SeatCylinder, SeatSpace, SeatTie, Surrounding};
use contact::Side;
use dynamics::motion::{Motion, MotionState, StepCache};
use dynamics::{Backend, ContactMode, Hold, Model, RingModel, StaticSolution};
use fem::Material;
use mesh::{Facet, Mesh, Origin};
use ring::statics::RingSolver;
use ring::{BodySettings, Frame, Partner, elastic_body, require_stiffening};

const LEVEL: Level = Level::hex8(36, 4, 1, 2);

fn outer(hold: Hold) -> RingModel {
    ring(Side::Outer, LEVEL, hold)
}

fn space(ring: &RingModel, basis: SeatBasis) -> SeatSpace {
    let nodes = ring.mesh.group_nodes(ring.held_group);
    let numbered = nodes.iter().map(|&n| (n as u64, ring.mesh.nodes[n]));
    let space = SeatSpace::on(&SeatCylinder::of_nodes("the seat", numbered).unwrap(), basis);
    space.on_ring(nodes.iter().map(|&node| ring.mesh.nodes[node]))
}

fn harmonics(harmonics: usize, across: usize) -> SeatBasis {
    SeatBasis::Harmonics { harmonics, across }
}

fn tied(tie: SeatTie) -> RingModel {
    RingModel {
        tie: Some(Arc::new(tie)),
        ..outer(Hold::MeanMotion)
    }
}

fn solver(ring: &RingModel) -> RingSolver {
    let model = Case::axial(0.0).flexible(ContactMode::Patch, LEVEL, Hold::Clamped);
    RingSolver::new(ring, dynamics::statics::settings(&model, Side::Outer)).unwrap()
}

/// Forces on the raceway at two azimuths, turned by an angle, N.
fn load(ring: &RingModel, turned: f64) -> Vec<f64> {
    let mut load = vec![0.0; ring.mesh.n_dofs()];
    for (node, w) in fem::facet_node_weights(&ring.mesh, ring.mesh.group("raceway")) {
        let [x, y, z] = ring.mesh.nodes[node];
        let azimuth = y.atan2(x) - turned;
        let push = 4e6 * w * ((azimuth - 0.3).cos().powi(9) + 0.5 * (2.0 * azimuth).sin() + 40.0 * z);
        let r = x.hypot(y);
        load[3 * node] += push * x / r;
        load[3 * node + 1] += push * y / r;
        load[3 * node + 2] += 0.3 * push;
    }
    load
}

fn largest(u: &[f64]) -> f64 {
    u.iter().fold(0.0, |most, x| x.abs().max(most))
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&off) / largest(b)
}

/// Wrong: the joint would hold more or less than the mean motion when it ties nothing else.
#[test]
fn the_six_rigid_functions_on_a_rigid_body_are_the_mean_motion() {
    let held = outer(Hold::MeanMotion);
    let tied = tied(SeatTie::to_rigid(space(&held, SeatBasis::Rigid)));
    let load = load(&held, 0.0);
    let expected = solver(&held).solve(load.clone(), 1);
    let off = difference(&solver(&tied).solve(load, 1), &expected);
    assert!(off < 1e-12, "{off:e}");
}

/// Wrong: a ring that turns with the body round it would move as if its stress were that of a ring alone.
#[test]
fn a_tied_ring_is_not_stiffened_by_its_stress() {
    let tied = tied(SeatTie::to_rigid(space(
        &outer(Hold::MeanMotion),
        SeatBasis::Rigid,
    )));
    let settings = BodySettings {
        partner: Partner::AT_REST,
        damping: [0.0; 2],
        backend: Backend::Auto,
        frame: Frame::Stiffened,
    };
    let error = elastic_body("outer", &tied, settings).err().unwrap();
    assert_eq!(
        error.to_string(),
        "effects.frame_rotation.stress_stiffening is not there for the outer ring: it is tied to a body; remove it, \
         or set it to false"
    );
    let before = require_stiffening("outer", &tied, Backend::Auto).unwrap_err();
    assert_eq!(before.to_string(), error.to_string());
}

/// Wrong: more functions on a rigid body would not come to a clamped seat.
#[test]
fn ever_more_functions_on_a_rigid_body_clamp_the_seat() {
    let clamped = outer(Hold::Clamped);
    let load = load(&clamped, 0.0);
    let expected = solver(&clamped).solve(load.clone(), 1);
    let mut errors = Vec::new();
    for (n, p) in [(2, 1), (6, 2), (12, 4), (17, 6)] {
        let tied = tied(SeatTie::to_rigid(space(&clamped, harmonics(n, p))));
        errors.push(difference(&solver(&tied).solve(load.clone(), 1), &expected));
    }
    println!("{errors:?}");
    assert!(
        errors.windows(2).all(|e| e[1] < 0.6 * e[0]) && errors[3] < 5e-3,
        "{errors:?}"
    );
}

/// Wrong: with all orders and degrees that its nodes have, a seat on a rigid body would still move somewhere. 36 nodes
/// round and 7 across take N = 18, of which there is the cosine alone, and P = 6. However the ring stands, the seat is
/// clamped; with the order before the last it is not. A force on one node has all orders.
#[test]
fn all_functions_on_a_rigid_body_are_the_clamped_seat() {
    for angle in [0.0, 0.02] {
        let clamped = turned(outer(Hold::Clamped), angle);
        let mut load = load(&clamped, 0.0);
        load[3 * clamped.mesh.group_nodes("raceway")[7] + 1] -= 500.0;
        let expected = solver(&clamped).solve(load.clone(), 1);
        let off = |n: usize| {
            let space = space(&clamped, harmonics(n, 6));
            let ring = RingModel {
                tie: Some(Arc::new(SeatTie::to_rigid(space))),
                ..turned(outer(Hold::MeanMotion), angle)
            };
            let functions = ring.seat_functions("outer").unwrap().unwrap();
            let off = difference(&solver(&ring).solve(load.clone(), 1), &expected);
            (functions.n(), 3 * functions.nodes.len(), off)
        };
        let (functions, dofs, error) = off(18);
        assert_eq!(functions, dofs);
        println!("turned by {angle}: {error:e}, one order less {:e}", off(17).2);
        assert!(error < 1e-9 && off(17).2 > 1e-6, "{error:e}");
    }
}

/// A tube outside the seat, whose inner nodes are those of the ring, in layers up to 58 mm: alone, and with the ring.
/// It is held at its feet.
fn tube(ring: &RingModel, layers: usize) -> (Mesh, Mesh) {
    wrapped(ring, layers, 1.45, |[x, y]| y < -0.7 * x.hypot(y))
}

/// Layers on the held group of a ring, up to its radius times a scale; the last ones are held where so is asked for.
fn wrapped(ring: &RingModel, layers: usize, to: f64, is_held: impl Fn([f64; 2]) -> bool) -> (Mesh, Mesh) {
    let seat = ring.mesh.group_nodes(ring.held_group);
    let number: BTreeMap<usize, usize> = seat.iter().enumerate().map(|(i, &n)| (n, i)).collect();
    let (n, first) = (seat.len(), ring.mesh.n_nodes());
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    for layer in 0..=layers {
        let scale = 1.0 + (to - 1.0) * layer as f64 / layers as f64;
        nodes.extend(seat.iter().map(|&node| {
            let [x, y, z] = ring.mesh.nodes[node];
            [scale * x, scale * y, z]
        }));
    }
    let (mut connectivity, mut groups) = (Vec::new(), BTreeMap::<String, Vec<Facet>>::new());
    for layer in 0..layers {
        for &facet in ring.mesh.group(ring.held_group) {
            let element = connectivity.len() / 8;
            let corners: Vec<usize> = ring.mesh.facet_nodes(facet).map(|n| number[&n]).collect();
            connectivity.extend(corners.iter().map(|c| n * layer + c));
            connectivity.extend(corners.iter().map(|c| n * (layer + 1) + c));
            let mut add = |name: &str, face| {
                groups
                    .entry(name.into())
                    .or_default()
                    .push(Facet { element, face });
            };
            if layer == 0 {
                add("seat_a", 0);
            }
            let middle: [f64; 2] = [0, 1].map(|c| corners.iter().map(|&i| nodes[i][c]).sum::<f64>() / 4.0);
            if layer + 1 == layers && is_held(middle) {
                add("feet", 1);
            }
        }
    }
    let own = Mesh {
        kind: ring.mesh.kind,
        nodes: nodes.clone().into(),
        connectivity: connectivity.clone(),
        groups: groups.clone(),
    };
    let mut both = ring.mesh.clone();
    let n_elements = both.n_elements();
    let of_both = |i: usize| if i < n { seat[i] } else { first + i - n };
    let mut all: Vec<[f64; 3]> = both.nodes.to_vec();
    all.extend(&nodes[n..]);
    both.nodes = all.into();
    both.connectivity.extend(connectivity.into_iter().map(of_both));
    for (name, facets) in groups {
        let moved = facets.into_iter().map(|f| Facet {
            element: f.element + n_elements,
            ..f
        });
        both.groups.insert(name, moved.collect());
    }
    (own, both)
}

fn surrounding(mesh: Mesh, space: SeatSpace, material: Material) -> Surrounding {
    let origin = Origin::of_generated("tube", 1.0, &mesh);
    let seat = BodySeat {
        name: "seat_a".into(),
        space,
        middle: None,
        is_turned: false,
    };
    let fixed = ["feet".to_string()];
    Surrounding::of_mesh("housing", (mesh, &origin), material, &fixed, &[seat]).unwrap()
}

fn on_body(mesh: Mesh, basis: SeatBasis) -> RingModel {
    let space = space(&outer(Hold::MeanMotion), basis);
    tied(SeatTie::to_seat(Arc::new(surrounding(mesh, space, steel())), 0))
}

fn bearing(outer: RingModel, backend: Backend) -> Model {
    let case = Case {
        radial: 3000.0,
        ..Case::axial(1000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, LEVEL, Hold::Clamped);
    model.rings[1] = Some(Arc::new(outer));
    Model { backend, ..model }
}

/// States of a motion, every fifth of `n` steps.
fn every_fifth(motion: &Motion<'_>, mut state: MotionState, n: usize) -> Vec<MotionState> {
    let (mut cache, mut states) = (StepCache::default(), Vec::new());
    for step in 1..=n {
        state = motion.step(&state, &mut cache).unwrap().0;
        if step % 5 == 0 {
            states.push(state.clone());
        }
    }
    states
}

fn forces(solution: &StaticSolution) -> Vec<f64> {
    solution.balls.iter().map(|ball| ball.outer.force_n).collect()
}

/// Wrong: ring and housing tied in functions would not be the body that they are together. One mesh of both, with the
/// same nodes, is held at the same feet.
#[test]
fn ring_and_housing_tied_in_functions_are_those_of_one_mesh() {
    let (own, both) = tube(&outer(Hold::Clamped), 5);
    let one = RingModel {
        mesh: both,
        held_group: "feet",
        ..outer(Hold::Clamped)
    };
    let n_ring = outer(Hold::Clamped).mesh.n_dofs();
    let one = equilibrium(&bearing(one, Backend::Sparse));
    let expected = &one.elastic[1].as_ref().unwrap()[..n_ring];
    let (mut moved, mut pushed) = (Vec::new(), Vec::new());
    for n in [2, 4, 8, 12] {
        let model = bearing(on_body(own.clone(), harmonics(n, 2)), Backend::Auto);
        let solution = equilibrium(&model);
        moved.push(difference(solution.elastic[1].as_ref().unwrap(), expected));
        pushed.push(difference(&forces(&solution), &forces(&one)));
        let work = solution.work_defect.abs() / solution.load_work;
        assert!(work < 1e-9, "the virtual work does not close: {work:e}");
    }
    println!("displacements {moved:?}, forces {pushed:?}");
    assert!(
        moved.windows(2).all(|e| e[1] < e[0]) && moved[3] < 0.01,
        "{moved:?}"
    );
    assert!(pushed[3] < 1e-3, "{pushed:?}");
}

/// Wrong: a bearing in plastic or rubber, which yields by more than its grooves are apart, would have no equilibrium:
/// the grooves would go where the body lets them, and leave balls and shaft behind.
#[test]
fn a_bearing_in_a_soft_housing_finds_its_equilibrium() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    for young_modulus in [1e9, 3e8] {
        let soft = Material {
            young_modulus,
            ..steel()
        };
        let space = space(&outer(Hold::MeanMotion), harmonics(4, 2));
        let body = Arc::new(surrounding(own.clone(), space, soft));
        let solution = equilibrium(&bearing(tied(SeatTie::to_seat(body, 0)), Backend::Auto));
        let moved = solution.displacements.shaft[0].hypot(solution.displacements.shaft[2]);
        let work = solution.work_defect.abs() / solution.load_work;
        println!("{young_modulus:e} Pa: the shaft moves by {moved:e} m, work {work:e}");
        assert!(moved > 2e-4 && work < 1e-9, "{moved:e} m, {work:e}");
    }
}

/// Wrong: the housing would matter no more than a clamped seat, or the joint would carry other than the loads.
#[test]
fn the_joint_carries_the_loads_and_the_body_follows() {
    let (own, _) = tube(&outer(Hold::Clamped), 3);
    let ring = on_body(own, harmonics(12, 2));
    let load = load(&ring, 0.0);
    let u = solver(&ring).solve(load.clone(), 1);
    let tie = ring.tie.clone().unwrap();
    let functions = ring.seat_functions("outer").unwrap().unwrap();
    let traction = tie.traction(&functions, &u, BesideRing::default()).unwrap();
    let mut sum = load.clone();
    functions.add_load(&traction.forces, &mut sum);
    for c in 0..3 {
        let total: f64 = sum.iter().skip(c).step_by(3).sum();
        assert!(total.abs() < 1e-7 * largest(&load) * load.len() as f64, "{total}");
    }
    let on_body = tie.forces_on_body(&traction, None);
    let body = tie.body.as_ref().unwrap().displacement(&on_body);
    let there = tie.body.as_ref().unwrap().seats[0].measure(&body);
    assert!(difference(&there, &traction.motion) < 1e-9);
    // The work of the loads is the energy of both.
    let work: f64 = 0.5 * load.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
    let product = fem::stiffness_product(&ring.mesh, &ring.material, &u).unwrap();
    let own: f64 = 0.5 * product.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
    assert!(
        (own + traction.energy() - work).abs() < 1e-9 * work,
        "{own} {} {work}",
        traction.energy()
    );
    let share = traction.convergence(tie.space.basis).unwrap();
    assert!(share.last_orders < 1e-3 && share.last_degree < 0.1, "{share:?}");
}

/// Wrong: a solver of harmonics and one of the whole matrix would see other joints.
#[test]
fn all_solvers_of_the_ring_give_the_same_joint() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    let solved = |backend| equilibrium(&bearing(on_body(own.clone(), harmonics(6, 2)), backend));
    let [a, b] = [Backend::Cyclic, Backend::Sparse].map(solved);
    assert!(difference(a.elastic[1].as_ref().unwrap(), b.elastic[1].as_ref().unwrap()) < 1e-8);
    assert!(difference(&forces(&a), &forces(&b)) < 1e-8);
}

/// Wrong: the answer would depend on where azimuth 0 is: body and load are turned by two sectors.
#[test]
fn turning_body_and_load_turns_the_answer() {
    let angle = 2.0 * std::f64::consts::TAU / 36.0;
    let (sin, cos) = angle.sin_cos();
    let turn = |x: &[f64]| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]];
    let (own, _) = tube(&outer(Hold::Clamped), 3);
    let mut turned_mesh = own.clone();
    turned_mesh.nodes = own.nodes.iter().map(|x| turn(x)).collect::<Vec<_>>().into();
    let [here, there] = [own, turned_mesh].map(|mesh| on_body(mesh, harmonics(8, 2)));
    let u = solver(&here).solve(load(&here, 0.0), 1);
    let v = solver(&there).solve(load(&there, angle), 1);
    let find = |x: [f64; 3]| {
        let near = |y: &[f64; 3]| (0..3).all(|c| (x[c] - y[c]).abs() < 1e-9);
        here.mesh.nodes.iter().position(near).unwrap()
    };
    let mut expected = vec![0.0; v.len()];
    for (node, x) in here.mesh.nodes.iter().enumerate().step_by(7) {
        let image = find(turn(x));
        expected[3 * image..3 * image + 3].copy_from_slice(&turn(&u[3 * node..3 * node + 3]));
        let off = (0..3)
            .map(|c| (expected[3 * image + c] - v[3 * image + c]).abs())
            .fold(0.0, f64::max);
        assert!(off < 1e-9 * largest(&u), "node {node}: {off:e}");
    }
}

/// Wrong: threads would change bits of a bearing in a housing.
#[test]
fn a_bearing_in_a_housing_has_the_same_bits_on_one_and_two_threads() {
    let bits = |threads: usize| {
        on_threads(threads, || {
            let (own, _) = tube(&outer(Hold::Clamped), 2);
            let solution = equilibrium(&bearing(on_body(own, harmonics(6, 2)), Backend::Auto));
            let bits = solution.elastic[1].as_ref().unwrap().iter().map(|u| u.to_bits());
            bits.collect::<Vec<_>>()
        })
    };
    assert_eq!(bits(1), bits(2));
}

/// Wrong: a soft housing would not change what it changes: contacts and the shaft. The compliance of the contacts is
/// measured against single solves.
#[test]
fn the_compliance_of_contacts_is_that_of_single_loads() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    let model = bearing(on_body(own, harmonics(6, 2)), Backend::Auto);
    let solution = equilibrium(&model);
    let ring = model.ring(Side::Outer).unwrap();
    let solver = RingSolver::new(ring, dynamics::statics::settings(&model, Side::Outer)).unwrap();
    let feet = solution.footprints(Side::Outer);
    let contacts: Vec<_> = feet.iter().map(|foot| foot.weights.clone()).collect();
    let n = 2 * contacts.len();
    let compliance = solver.compliance(&contacts);
    let scale = largest(&compliance);
    for j in [0, 7, 20] {
        let mut load = vec![0.0; solver.n_dofs()];
        let unit = [[1.0, 0.0], [0.0, 1.0]][j % 2];
        contacts[j / 2].add_load(unit, &mut load);
        let u = solver.solve(load, 1);
        for (i, contact) in contacts.iter().enumerate() {
            let motion = contact.measure(&u);
            for c in 0..2 {
                let off = (motion[c] - compliance[n * (2 * i + c) + j]).abs();
                assert!(off < 1e-9 * scale, "{i} {j} {c}: {off:e}");
            }
        }
    }
}
