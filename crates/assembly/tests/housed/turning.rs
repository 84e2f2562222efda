//! Bearings in one body or on one that turns, in equilibria over time.

use assembly::ShaftLoads;
use dynamics::Pose;
use dynamics::effects::Now;

use super::shaft::{HELD_BELOW, on_one};
use super::*;

const BALLS: usize = 18;

/// Where all parts have gone on by one ball pitch, in the frame of each bearing: balls stand where their neighbours
/// stood, and so do sectors of the rings.
fn one_pitch_on(list: &Assembly, sides: &[Side]) -> Vec<Pose> {
    let pitch = std::f64::consts::TAU / BALLS as f64;
    let pose = |bearing: &MountedBearing| {
        let angle = bearing.place.orientation.turned_angle(pitch);
        let mut pose = Pose {
            now: Now {
                cage_angle: angle,
                ..Now::default()
            },
            ..Pose::default()
        };
        sides
            .iter()
            .for_each(|side| pose.ring_angles[side.index()] = angle);
        pose
    };
    list.bearings.iter().map(pose).collect()
}

/// The same list at the start and a pitch on, each from nothing.
fn start_and_pitch(list: &mut Assembly, sides: &[Side]) -> [AssemblySolution; 2] {
    let start = at_rest(list);
    let poses = one_pitch_on(list, sides);
    let mut solver = AssemblySolver::new(list).unwrap();
    [start, solver.solve_at(list, &poses, None).unwrap()]
}

/// Wrong: balls that go round would not press on a housing where they are, or the forces that bearings hand on through
/// it be those of the start. A pitch on, with the mesh of the inner rings, all is as it was.
#[test]
fn a_pair_in_one_housing_is_the_same_a_ball_pitch_on() {
    let mut list = pair(in_one(true, 5e9), [0, 1]);
    let [start, on] = start_and_pitch(&mut list, &[Side::Inner]);
    let off = off(&on.shaft.displacements, &start.shaft.displacements);
    assert!(off < 1e-8, "{off:e}");
    for (i, bearing) in list.bearings.iter().enumerate() {
        for ball in 0..BALLS {
            // Azimuths grow along the turn of the cage, which is the other one in a bearing that is turned.
            let before = match bearing.place.orientation {
                Orientation::PlusZ => (ball + 1) % BALLS,
                Orientation::MinusZ => (ball + BALLS - 1) % BALLS,
            };
            let [found, expected] =
                [(&on, ball), (&start, before)].map(|(s, b)| s.bearings[i].balls[b].outer.force_n);
            assert!(
                (found - expected).abs() < 1e-6 * expected.max(1.0),
                "{ball}: {found} {expected}"
            );
        }
    }
}

/// Wrong: an elastic shaft that carries both rings would not turn with them. A shaft whose end is held round its whole
/// face is the same a ball pitch on; one that is held below alone is the same only if the load turns with it.
#[test]
fn a_pair_on_one_elastic_shaft_turns_with_it() {
    let turned_load = |list: &mut Assembly, pitch: f64| {
        let (sin, cos) = pitch.sin_cos();
        let load = std::mem::take(&mut list.load.on_dofs);
        list.load = ShaftLoads::at_origin(vec![
            cos * load[0] - sin * load[1],
            sin * load[0] + cos * load[1],
            load[2],
            cos * load[3] - sin * load[4],
            sin * load[3] + cos * load[4],
        ]);
    };
    let pitch = std::f64::consts::TAU / BALLS as f64;
    let mut list = tied_pair(Side::Inner, on_one(true, HELD_BELOW), [0, 1]);
    let start = at_rest(&mut list);
    let poses = one_pitch_on(&list, &[Side::Inner]);
    let mut solver = AssemblySolver::new(&list).unwrap();
    let other = solver.solve_at(&mut list, &poses, None).unwrap();
    turned_load(&mut list, pitch);
    let found = solver
        .solve_at(&mut list, &poses, Some(&other.as_start()))
        .unwrap();
    let (sin, cos) = pitch.sin_cos();
    let q = &start.shaft.displacements;
    let expected = [
        cos * q[0] - sin * q[1],
        sin * q[0] + cos * q[1],
        q[2],
        cos * q[3] - sin * q[4],
        sin * q[3] + cos * q[4],
    ];
    let off_turned = off(&found.shaft.displacements, &expected);
    let off_other = off(&other.shaft.displacements, q);
    assert!(off_turned < 1e-8, "{off_turned:e}");
    assert!(off_other > 1e-4, "{off_other:e}: the shaft is held below alone");
}
