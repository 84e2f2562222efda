//! Two bearings on one hollow elastic shaft that turns: against two shafts, the order of the list, ledgers.

use super::*;

/// A wall whose inside is carried by the shaft.
pub const CARRIED: Wall = Wall {
    thickness: -0.4,
    held: [0.0, 1.0],
};
/// The same at one side alone, so that the shaft bends.
pub const HELD_BELOW: Wall = Wall {
    held: [0.5, 1.0],
    ..CARRIED
};

fn inner() -> RingModel {
    ring(Side::Inner, LEVEL, Hold::MeanMotion)
}

/// Distance of the seats of bearings that stand [`APART`]: their grooves are not in the middle of their bores.
fn apart(ring: &RingModel, space: &SeatSpace) -> f64 {
    APART + 2.0 * (ring.groove.centre_z - space.middle)
}

fn carried(mesh: Mesh, space: SeatSpace, seats: &[(&str, bool)]) -> Arc<Surrounding> {
    carried_of(207e9, mesh, space, seats)
}

fn carried_of(young: f64, mesh: Mesh, space: SeatSpace, seats: &[(&str, bool)]) -> Arc<Surrounding> {
    let origins = vec![inner().groove.centre_z; seats.len()];
    Arc::new(standing(mesh, space, seats, young).on_shaft(&origins).unwrap())
}

fn hollow(space: &SeatSpace, is_joined: bool, wall: Wall) -> Mesh {
    sleeve(
        space.radius,
        &bands(space, apart(&inner(), space), is_joined),
        wall,
    )
}

pub fn on_one(is_joined: bool, wall: Wall) -> [Arc<SeatTie>; 2] {
    on_one_of(207e9, is_joined, wall)
}

/// The same of another stiffness.
pub fn on_one_of(young: f64, is_joined: bool, wall: Wall) -> [Arc<SeatTie>; 2] {
    let space = space(&inner());
    let body = carried_of(
        young,
        hollow(&space, is_joined, wall),
        space,
        &[("seat_front", false), ("seat_rear", true)],
    );
    let modes = Arc::new(body.modes(20e3).unwrap());
    [0, 1].map(|seat| tie(&body, &modes, seat))
}

/// The same in the frame of the second, which comes first.
pub fn on_one_turned(wall: Wall) -> [Arc<SeatTie>; 2] {
    let space = space(&inner());
    let mut mesh = hollow(&space, true, wall);
    let turned = |x: &mut [f64; 3]| *x = [x[0], -x[1], -x[2]];
    mesh.nodes.iter_mut().for_each(turned);
    let body = carried(mesh, space, &[("seat_rear", false), ("seat_front", true)]);
    let modes = Arc::new(body.modes(20e3).unwrap());
    [1, 0].map(|seat| tie(&body, &modes, seat))
}

pub fn on_two() -> [Arc<SeatTie>; 2] {
    let space = space(&inner());
    [("seat_front", false), ("seat_rear", true)].map(|(name, is_turned)| {
        let all = bands(&space, apart(&inner(), &space), false);
        let own: Vec<Band> = all.into_iter().filter(|band| band.seat == Some(name)).collect();
        let body = carried(sleeve(space.radius, &own, CARRIED), space, &[(name, is_turned)]);
        let modes = Arc::new(body.modes(20e3).unwrap());
        tie(&body, &modes, 0)
    })
}

const BLOW: [f64; 5] = [1200.0, 100.0, 500.0, 0.0, -2.0];

/// Wrong: bearings would feel each other where nothing joins their seats but the shaft, at rest or in motion, or the
/// inertia of the shaft's body would count twice.
#[test]
fn a_shaft_in_two_parts_is_two_shafts() {
    let list = |ties| tied_pair(Side::Inner, ties, [0, 1]);
    let [found, expected] = [on_one(false, CARRIED), on_two()];
    let [a, b] = [&found, &expected].map(|ties| at_rest(&mut list(ties.clone())));
    let at_rest = off(&a.shaft.displacements, &b.shaft.displacements);
    println!("{at_rest:e} at rest");
    assert!(at_rest < 1e-9, "{at_rest:e}");
    let [a, b] = [found, expected].map(|ties| moved(list(ties), BLOW, |_, _| {}));
    let off = off(&a.shaft, &b.shaft);
    assert!(off < 1e-7, "{off:e}");
}

/// Wrong: energy would come from the joints of a shaft with several rings or from its turning, its copies in the
/// bearings would part, or it would matter which bearing stands first.
#[test]
fn ledgers_close_and_copies_of_a_shaft_stay_together() {
    let mut worst = [0.0f64; 2];
    let note = |_: &AssemblyMotion<'_>, state: &AssemblyState| {
        let defects = state.bearings.iter().map(|b| b.ledger.relative_defect().abs());
        worst[0] = worst[0].max(defects.fold(state.ledger.relative_defect().abs(), f64::max));
        // The first five are rigid: bearings are mounted with an offset.
        let [a, b] = [0, 1].map(|i| &oscillators_of(Side::Inner, state, i)[5..]);
        worst[1] = worst[1].max(off(a, b));
    };
    let state = moved(
        tied_pair(Side::Inner, on_one(true, HELD_BELOW), [0, 1]),
        BLOW,
        note,
    );
    println!("{worst:?} {:?}", state.shaft);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-7, "{worst:?}");
    let turned = tied_pair(Side::Inner, on_one_turned(HELD_BELOW), [1, 0]);
    let turned = moved(turned, BLOW, |_, _| {});
    let off = off(&turned.shaft, &state.shaft);
    assert!(off < 1e-7, "{off:e}");
}

/// Wrong: the shaft would start from anywhere but where the forces of both seats hold it.
#[test]
fn a_motion_of_a_shaft_without_a_change_stays_at_rest() {
    let mut first: Option<AssemblyState> = None;
    let mut largest = 0.0f64;
    let list = tied_pair(Side::Inner, on_one(true, HELD_BELOW), [0, 1]);
    let note = |_: &AssemblyMotion<'_>, state: &AssemblyState| {
        let start = first.get_or_insert_with(|| state.clone());
        let [now, then] = [state, &*start].map(|state| oscillators_of(Side::Inner, state, 0));
        largest = largest.max(off(now, then));
        // What the shaft's body does to the rings is the load of the equilibrium.
        largest = largest.max(0.1 * off(state.loads.as_flattened(), start.loads.as_flattened()));
    };
    run(list, (1e-5, 5), &Speed::constant(0.0), |_| LOAD, note);
    assert!(largest < 1e-7, "{largest:e}");
}
