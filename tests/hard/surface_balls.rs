//! Balls that are no spheres: marks that meet both raceways, other marks, and poles.

use contact::surface::{Spall, Wave};
use contact::{Profiles, Side};
use dynamics::kinematics::Kinematics;

use super::record::Record;
use super::surfaces::{ENTRY, Rolling, rough, usual};
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        slow(
            "surface_ball_sharp_spall",
            "a ball falls off its own edge, and meets both raceways with it half a turn apart",
            "rigid rings, 2 kN, 1800 rpm, sharp spall of 1 mm on ball 0, 0.2 mm deep, dt 2 us, 6 ms",
            sharp,
        ),
        slow(
            "surface_ball_spall_meets_spall",
            "the spall of a ball comes over the spall of the ring: edges upon edges",
            "rigid rings, 2 kN, 1800 rpm, sharp spalls of 1 mm and 0.8 mm, dt 2 us, 0.6 ms",
            meets,
        ),
        slow(
            "surface_all_balls_rough_and_spalled",
            "no ball is a sphere, none like another, and load is light",
            "rigid rings, 300 N, 6000 rpm, rough balls of 0.2 um, each spalled, damped, dt 2 us, 4 ms",
            |r| {
                let mut case = Rolling {
                    duration: 4e-3,
                    is_damped: true,
                    ..Rolling::at(300.0, 6000.0)
                };
                for ball in 0..18 {
                    let longitude = 2.399_963 * ball as f64;
                    case.balls.insert(ball, worn(longitude, 0.5e-3, 50e-6));
                }
                case.holds(r);
            },
        ),
        slow(
            "surface_ball_flexible",
            "edges of a ball on elastic rings: waves of the rings and of the ball",
            "flexible rings, 2 kN, 1800 rpm, rough ball with a spall of 0.5 mm, dt 5 us, 0.6 ms",
            |r| {
                let mut case = Rolling {
                    is_flexible: true,
                    dt: 5e-6,
                    ..usual()
                };
                let longitude = entering(&case, 0.5e-3);
                case.balls.insert(0, worn(longitude, 0.5e-3, 50e-6));
                case.holds(r);
            },
        ),
    ]
}

/// Longitude of a spall that comes under the outer raceway [`ENTRY`] after the start, rad.
fn entering(case: &Rolling, length: f64) -> f64 {
    let geometry = case.smooth().geometry;
    let spin = Kinematics::new(&geometry, [0.0; 2]).ball * case.speed;
    -spin * ENTRY - length / geometry.ball_diameter
}

pub fn spalled(longitude: f64, length: f64, depth: f64) -> Profiles {
    Profiles {
        spalls: vec![Spall {
            azimuth: longitude,
            groove_angle: 0.0,
            length,
            width: 5e-3,
            depth,
            edge: 0.0,
        }],
        ..Profiles::default()
    }
}

pub fn worn(longitude: f64, length: f64, depth: f64) -> Profiles {
    let waves: Vec<Wave> = rough(2..=20, 0.2e-6);
    Profiles {
        waves,
        ..spalled(longitude, length, depth)
    }
}

fn sharp(record: &mut Record) {
    let mut case = Rolling {
        duration: 6e-3,
        ..usual()
    };
    let longitude = entering(&case, 1e-3);
    case.balls.insert(0, spalled(longitude, 1e-3, 0.2e-3));
    let mut empty = [0; 2];
    let course = case.seen(record, |state| {
        for side in Side::BOTH {
            empty[side.index()] += usize::from(state.forces[side.index()].norm() < 1.0);
        }
    });
    record.that(
        "both contacts of the ball lose their load",
        empty.iter().all(|n| *n > 0),
    );
    record.below("largest force, N", course.peak, 3000.0);
}

fn meets(record: &mut Record) {
    let case = usual();
    let longitude = entering(&case, 0.8e-3);
    let mut case = case.over(1e-3, 0.2e-3);
    case.balls.insert(0, spalled(longitude, 0.8e-3, 0.2e-3));
    let course = case.holds(record);
    record.below("largest force, N", course.peak, 5000.0);
}
