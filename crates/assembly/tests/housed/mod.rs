//! Two bearings in one elastic sleeve, at rest, over the speed and in motion: against two sleeves, the sleeve's
//! own balance, the order of the list, ledgers.

mod modes;
mod shaft;
mod stiffness;
mod turning;
mod whirl;

use assembly::ShaftLoads;
use std::collections::BTreeMap;
use std::sync::Arc;

use assembly::shaft::ShaftBody;
use assembly::{
    Assembly, AssemblyMotion, AssemblySolution, AssemblySolver, AssemblyState, MountedBearing, Orientation,
    Seating,
};
use body::{BodySeat, SeatBasis, SeatCylinder, SeatFunctions, SeatSpace, SeatTie, Surrounding};
use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::{ContactMode, Hold, RingModel, StaticSolver};
use fem::Material;
use mesh::{ElementKind, Facet, Mesh, Origin};

use crate::motion::{INERTIA, run};
use crate::support::Case;
use crate::support::rings::{Level, ring};
use Orientation::{MinusZ, PlusZ};

const LEVEL: Level = Level::hex8(54, 6, 1, 2);
/// Distance of the bearings, m.
const APART: f64 = 0.06;
/// Elements of a sleeve round it, across a seat, between the seats, and outwards.
const ROUND: usize = 54;
const SEAT: usize = 4;
const BETWEEN: usize = 5;
const OUTWARDS: usize = 2;
const SPEED: f64 = 500.0;

/// The seat of a ring, by functions that are few but hold an oval.
fn space(ring: &RingModel) -> SeatSpace {
    let nodes = ring.mesh.group_nodes(ring.held_group);
    let numbered = nodes.iter().map(|&n| (n as u64, ring.mesh.nodes[n]));
    let basis = SeatBasis::Harmonics {
        harmonics: 4,
        across: 1,
    };
    SeatSpace::on(&SeatCylinder::of_nodes("the seat", numbered).unwrap(), basis)
}

/// A layer of elements of a sleeve between two heights.
#[derive(Clone, Copy)]
struct Band {
    heights: [f64; 2],
    layers: usize,
    seat: Option<&'static str>,
}

/// Bands of a sleeve with its seats at 0 and at a distance, joined or in two parts.
fn bands(space: &SeatSpace, apart: f64, is_joined: bool) -> Vec<Band> {
    let half = space.half_width;
    let seat = |middle: f64, name| Band {
        heights: [middle - half, middle + half],
        layers: SEAT,
        seat: Some(name),
    };
    let between = Band {
        heights: [half, apart - half],
        layers: BETWEEN,
        seat: None,
    };
    let [front, rear] = [seat(0.0, "seat_front"), seat(apart, "seat_rear")];
    match is_joined {
        true => vec![front, between, rear],
        false => vec![front, rear],
    }
}

/// The wall of a sleeve from its seats on.
#[derive(Clone, Copy)]
struct Wall {
    /// Share of the radius of the seats by which it goes outwards; negative: inwards.
    thickness: f64,
    /// Shares of the way round between which its other surface is held.
    held: [f64; 2],
}

/// A wall that stands below.
const STANDING: Wall = Wall {
    thickness: 0.45,
    held: [0.62, 0.88],
};

/// A sleeve of bands: bands that follow each other share nodes.
fn sleeve(radius: f64, bands: &[Band], wall: Wall) -> Mesh {
    let (mut nodes, mut connectivity) = (Vec::new(), Vec::new());
    let mut groups = BTreeMap::<String, Vec<Facet>>::new();
    let mut last: Option<f64> = None;
    // Nodes of a height: round, then outwards.
    let at = |height: usize, i: usize, j: usize| (height * ROUND + i % ROUND) * (OUTWARDS + 1) + j;
    let mut heights = 0;
    for band in bands {
        let shares = (0..=band.layers).map(|k| k as f64 / band.layers as f64);
        let all: Vec<f64> = shares
            .map(|s| (1.0 - s) * band.heights[0] + s * band.heights[1])
            .collect();
        let is_joined = last == Some(band.heights[0]);
        let first = if is_joined { heights - 1 } else { heights };
        for &z in &all[usize::from(is_joined)..] {
            for i in 0..ROUND {
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / ROUND as f64).sin_cos();
                for j in 0..=OUTWARDS {
                    let r = radius * (1.0 + wall.thickness * j as f64 / OUTWARDS as f64);
                    nodes.push([r * cos, r * sin, z]);
                }
            }
            heights += 1;
        }
        for k in first..first + band.layers {
            for i in 0..ROUND {
                for j in 0..OUTWARDS {
                    let element = connectivity.len() / 8;
                    let goes_out = wall.thickness > 0.0;
                    for layer in if goes_out { [j, j + 1] } else { [j + 1, j] } {
                        connectivity.extend([
                            at(k, i, layer),
                            at(k, i + 1, layer),
                            at(k + 1, i + 1, layer),
                            at(k + 1, i, layer),
                        ]);
                    }
                    let share = (i as f64 + 0.5) / ROUND as f64;
                    let is_held = (wall.held[0]..wall.held[1]).contains(&share);
                    let [near, far] = if goes_out { [0, 1] } else { [1, 0] };
                    for (name, face) in [
                        (band.seat.filter(|_| j == 0), near),
                        ((j + 1 == OUTWARDS && is_held).then_some("feet"), far),
                    ] {
                        if let Some(name) = name {
                            groups
                                .entry(name.to_string())
                                .or_default()
                                .push(Facet { element, face });
                        }
                    }
                }
            }
        }
        last = Some(band.heights[1]);
    }
    Mesh {
        kind: ElementKind::Hex8,
        nodes: nodes.into(),
        connectivity,
        groups,
    }
}

/// A body with seats, of which some are turned against it.
fn body(mesh: Mesh, space: SeatSpace, seats: &[(&str, bool)], young: f64) -> Arc<Surrounding> {
    Arc::new(standing(mesh, space, seats, young))
}

fn standing(mesh: Mesh, space: SeatSpace, seats: &[(&str, bool)], young: f64) -> Surrounding {
    let origin = Origin::of_generated("sleeve", 1.0, &mesh);
    let seats: Vec<BodySeat> = seats
        .iter()
        .map(|&(group, is_turned)| BodySeat {
            name: group.into(),
            space,
            middle: None,
            is_turned,
        })
        .collect();
    let material = Material::new(young, 0.3, 7800.0).unwrap();
    let fixed = ["feet".to_string()];
    Surrounding::of_mesh("sleeve", (mesh, &origin), material, &fixed, &seats).unwrap()
}

/// The joint with a seat of a body that moves by some modes.
fn tie(body: &Arc<Surrounding>, modes: &Arc<body::BodyModes>, seat: usize) -> Arc<SeatTie> {
    Arc::new(SeatTie::to_seat(body.clone(), seat).in_motion(modes.clone()))
}

/// Two bearings back to back with these joints, on a free rigid shaft under a load at the first.
fn pair(ties: [Arc<SeatTie>; 2], order: [usize; 2]) -> Assembly {
    tied_pair(Side::Outer, ties, order)
}

/// The same with joints of the rings of one side.
fn tied_pair(side: Side, ties: [Arc<SeatTie>; 2], order: [usize; 2]) -> Assembly {
    let shaft = ShaftBody::rigid(INERTIA, [None; 5]);
    let places = [(0.0, PlusZ), (APART, MinusZ)];
    let other = match side {
        Side::Inner => Side::Outer,
        Side::Outer => Side::Inner,
    };
    let clamped = Arc::new(ring(other, LEVEL, Hold::Clamped));
    let bearing = |number: usize| {
        let (position, orientation) = places[number];
        let mut model = Case::axial(0.0).flexible(ContactMode::Patch, LEVEL, Hold::Clamped);
        model.effects.clear();
        model.rings[other.index()] = Some(clamped.clone());
        model.rings[side.index()] = Some(Arc::new(RingModel {
            tie: Some(ties[number].clone()),
            ..ring(side, LEVEL, Hold::MeanMotion)
        }));
        MountedBearing {
            name: format!("number {number}"),
            place: Seating {
                position,
                orientation,
                shift: 8e-6,
            },
            model,
        }
    };
    let mut load = ShaftLoads::none(&shaft);
    load.add(&shaft.station(0.0), LOAD);
    let mut list = Assembly {
        bearings: order.map(bearing).into(),
        shaft,
        load,
    };
    // As on one body for both, also where each has its own.
    if ties[0].carried().is_some() {
        list.shaft.be_linear();
    }
    list
}

const LOAD: [f64; 5] = [600.0, -200.0, 300.0, 0.0, 3.0];

/// Joints with one sleeve, in the frame of the first bearing.
fn in_one(is_joined: bool, young: f64) -> [Arc<SeatTie>; 2] {
    let space = space(&ring(Side::Outer, LEVEL, Hold::MeanMotion));
    let mesh = sleeve(space.radius, &bands(&space, APART, is_joined), STANDING);
    let body = body(mesh, space, &[("seat_front", false), ("seat_rear", true)], young);
    let modes = Arc::new(body.modes(8e3 * (young / 70e9).sqrt()).unwrap());
    [0, 1].map(|seat| tie(&body, &modes, seat))
}

/// The same in the frame of the second, which comes first.
fn in_one_turned() -> [Arc<SeatTie>; 2] {
    let space = space(&ring(Side::Outer, LEVEL, Hold::MeanMotion));
    let mut mesh = sleeve(space.radius, &bands(&space, APART, true), STANDING);
    let turned = |x: &mut [f64; 3]| *x = [x[0], -x[1], -x[2]];
    mesh.nodes.iter_mut().for_each(turned);
    let body = body(mesh, space, &[("seat_rear", false), ("seat_front", true)], 70e9);
    let modes = Arc::new(body.modes(8e3).unwrap());
    [1, 0].map(|seat| tie(&body, &modes, seat))
}

/// Joints with a sleeve each.
fn in_two() -> [Arc<SeatTie>; 2] {
    let space = space(&ring(Side::Outer, LEVEL, Hold::MeanMotion));
    let mesh = || sleeve(space.radius, &bands(&space, APART, false), STANDING);
    [("seat_front", false), ("seat_rear", true)].map(|seat| {
        let mut mesh = mesh();
        mesh.groups.retain(|name, _| name == seat.0 || name == "feet");
        let body = body(mesh, space, &[seat], 70e9);
        let modes = Arc::new(body.modes(8e3).unwrap());
        tie(&body, &modes, 0)
    })
}

fn at_rest(assembly: &mut Assembly) -> AssemblySolution {
    let mut solver = AssemblySolver::new(assembly).unwrap();
    solver.solve(assembly, None).unwrap_or_else(|e| panic!("{e}"))
}

fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, x| x.abs().max(most))
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// Wrong: bearings would feel each other where nothing joins their seats, or not be where a body of their own has them.
#[test]
fn a_body_in_two_parts_is_two_bodies() {
    let found = at_rest(&mut pair(in_one(false, 70e9), [0, 1]));
    let expected = at_rest(&mut pair(in_two(), [0, 1]));
    assert!(off(&found.shaft.displacements, &expected.shaft.displacements) < 1e-9);
    for (found, expected) in found.bearings.iter().zip(&expected.bearings) {
        let [found, expected] = [found, expected].map(|s| s.elastic[1].as_ref().unwrap());
        assert!(off(found, expected) < 1e-8);
    }
}

/// Wrong: rings of one type would be factored once more for each seat in which they sit, or a ring with the factor of
/// another would not be what it is alone in its own seat, or rings of two steels would share one.
#[test]
fn rings_of_one_type_are_factored_once_whatever_their_seats() {
    let ties = in_one(true, 70e9);
    let mut list = pair(ties.clone(), [0, 1]);
    let is_shared = |of: &AssemblySolver, side: Side| {
        let [first, second] = [0, 1].map(|i| &of.of_bearing(i).ring(side).unwrap().solver);
        first.shares_factor(second)
    };
    let solver = AssemblySolver::new(&list).unwrap();
    assert_eq!(solver.types().len(), 2, "each is tied to a seat of its own");
    assert!(Side::BOTH.iter().all(|&side| is_shared(&solver, side)));
    let n = list.bearings[1].model.ring(Side::Outer).unwrap().mesh.n_dofs();
    let load: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
    let field = |of: &StaticSolver| of.ring(Side::Outer).unwrap().solver.solve(load.clone(), 1);
    let [first, second] = [0, 1].map(|i| field(solver.of_bearing(i)));
    let alone = StaticSolver::new(&list.bearings[1].model).unwrap();
    assert!(second == field(&alone), "the bits of a ring alone");
    assert!(off(&first, &second) > 1e-3, "each has its own seat");
    list.bearings[1].model.rings[1] = Some(Arc::new(RingModel {
        tie: Some(ties[1].clone()),
        material: Material::new(200e9, 0.3, 7800.0).unwrap(),
        ..ring(Side::Outer, LEVEL, Hold::MeanMotion)
    }));
    let solver = AssemblySolver::new(&list).unwrap();
    assert_eq!(Side::BOTH.map(|side| is_shared(&solver, side)), [true, false]);
}

/// Wrong: the sleeve would not stand where the forces of both rings put it. Its displacement under both, measured on
/// each seat, is the motion of the ring there; and the seats matter to each other: alone the front one moves otherwise.
/// The soft sleeve moves as a whole on its feet by more than the bearings give.
#[test]
fn both_seats_move_with_their_rings() {
    for young in [70e9, 0.5e9] {
        let ties = in_one(true, young);
        let mut list = pair(ties.clone(), [0, 1]);
        let solution = at_rest(&mut list);
        let body = ties[0].body.as_ref().unwrap();
        let mut forces = vec![0.0; body.n_functions()];
        let mut motions = Vec::new();
        for (i, tie) in ties.iter().enumerate() {
            let model = &list.bearings[i].model;
            let functions: SeatFunctions = model
                .ring(Side::Outer)
                .unwrap()
                .seat_functions("outer")
                .unwrap()
                .unwrap();
            let acting = model.acting(Side::Outer, None);
            let field = solution.bearings[i].elastic[1].as_ref().unwrap();
            let traction = tie.traction(&functions, field, acting).unwrap();
            let own = forces[tie.own()].iter_mut();
            own.zip(&traction.forces).for_each(|(p, f)| *p = -f);
            motions.push(traction.motion);
        }
        let field = body.displacement(&forces);
        for (seat, motion) in body.seats.iter().zip(&motions) {
            let off = off(&seat.measure(&field), motion);
            assert!(off < 1e-7, "{off:e}");
        }
        forces[ties[1].own()].fill(0.0);
        let alone = body.seats[0].measure(&body.displacement(&forces));
        assert!(off(&alone, &motions[0]) > 0.05);
    }
}

/// Wrong: it would matter which bearing stands first, in whose frame the body is made: a turned seat would not be where
/// it is.
#[test]
fn the_order_of_the_list_does_not_matter() {
    let found = at_rest(&mut pair(in_one(true, 70e9), [0, 1]));
    let turned = at_rest(&mut pair(in_one_turned(), [1, 0]));
    let off = off(&turned.shaft.displacements, &found.shaft.displacements);
    assert!(off < 1e-8, "{off:e}");
}

/// A motion after the load on the shaft has changed, with what is noted of each step.
fn moved(
    list: Assembly,
    load: [f64; 5],
    note: impl FnMut(&AssemblyMotion<'_>, &AssemblyState),
) -> AssemblyState {
    run(list, (1e-5, 60), &Speed::constant(SPEED), |_| load, note)
}

/// Oscillators of the body as a bearing has them.
fn oscillators(state: &AssemblyState, bearing: usize) -> &[f64] {
    oscillators_of(Side::Outer, state, bearing)
}

fn oscillators_of(side: Side, state: &AssemblyState, bearing: usize) -> &[f64] {
    let ring = state.bearings[bearing].rings[side.index()].as_ref().unwrap();
    &ring.body().unwrap().0[0]
}

/// Wrong: a moving body would feel seats that nothing joins to it, or its copies would part. In one body of two parts
/// the modes are those of both; frequencies of the cut-off are the same.
#[test]
fn a_moving_body_in_two_parts_is_two_bodies() {
    let load = [1200.0, 100.0, 500.0, 0.0, -2.0];
    let found = moved(pair(in_one(false, 70e9), [0, 1]), load, |_, _| {});
    let expected = moved(pair(in_two(), [0, 1]), load, |_, _| {});
    let off = off(&found.shaft, &expected.shaft);
    assert!(off < 1e-7, "{off:e}");
}

/// Wrong: energy would come from the joints of a body with several rings, its copies in the bearings would part, or it
/// would start from anywhere but its equilibrium.
#[test]
fn ledgers_close_and_copies_of_a_body_stay_together() {
    let mut worst = [0.0f64; 2];
    let note = |_: &AssemblyMotion<'_>, state: &AssemblyState| {
        let defects = state.bearings.iter().map(|b| b.ledger.relative_defect().abs());
        worst[0] = worst[0].max(defects.fold(0.0, f64::max));
        worst[1] = worst[1].max(off(oscillators(state, 0), oscillators(state, 1)));
    };
    let list = pair(in_one(true, 70e9), [0, 1]);
    let state = moved(list, [1200.0, 100.0, 500.0, 0.0, -2.0], note);
    println!("{worst:?} {:?}", state.shaft);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-7, "{worst:?}");
    let turned = pair(in_one_turned(), [1, 0]);
    let turned = moved(turned, [1200.0, 100.0, 500.0, 0.0, -2.0], |_, _| {});
    let off = off(&turned.shaft, &state.shaft);
    assert!(off < 1e-7, "{off:e}");
}

/// Wrong: the body would start from anywhere but where the forces of both seats hold it. The turning of the inner rings
/// moves nothing that is round.
#[test]
fn a_motion_without_a_change_stays_at_rest() {
    let mut first: Option<AssemblyState> = None;
    let mut largest = 0.0f64;
    let list = pair(in_one(true, 70e9), [0, 1]);
    let note = |_: &AssemblyMotion<'_>, state: &AssemblyState| {
        let start = first.get_or_insert_with(|| state.clone());
        largest = largest.max(off(oscillators(state, 0), oscillators(start, 0)));
    };
    run(list, (1e-5, 5), &Speed::constant(0.0), |_| LOAD, note);
    assert!(largest < 1e-7, "{largest:e}");
}
