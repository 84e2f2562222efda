//! Free balls on real surfaces: edges that throw balls which nothing guides, and marks that turn with them.

use contact::Side;

use super::bearings::Load;
use super::free_balls::Rolling;
use super::free_cage::cage;
use super::record::Record;
use super::surface_balls::{spalled, worn};
use super::surfaces::{Rolling as Surfaces, outer_force, rough};
use super::{HardCase, Pace};

/// What surfaces give to contacts over the largest energy: balls and drives take it, so that nothing is left.
const NOTHING: f64 = 1e-9;
/// The same on elastic rings, whose patches move a little along the track.
const LITTLE: f64 = 1e-4;

pub fn cases() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        slow(
            "free_surfaces_sharp_spall",
            "a ball that nothing guides falls off an edge, is stopped by the next, and may only lose what ball and \
             drive gain",
            "rigid rings, 2 kN, 1800 rpm, sharp spall of 1 mm outside, friction 0 and 0.07, dt 2, 5, 10 us, 0.6 ms",
            sharp,
        ),
        slow(
            "free_surfaces_waves_no_preload",
            "balls fly from crest to crest and are driven by what they touch there",
            "rigid rings, 20 N, 6000 rpm, waves of order 40, 2 um, on both rings, dt 5 us, 4 ms",
            |r| {
                let surfaces = surfaces(20.0, 6000.0);
                let surfaces = surfaces.waves(Side::Outer, 40, 2e-6).waves(Side::Inner, 37, 2e-6);
                let case = Rolling {
                    axial: Load::dead(20.0),
                    dt: 5e-6,
                    ..Rolling::run_up(6000.0, 6000.0, 1e-3)
                };
                let course = over(case, surfaces).with(4e-3).rolled(r, NOTHING, |_| ());
                r.that("contacts open", course.open > 0);
            },
        ),
        slow(
            "free_surfaces_reversal_in_a_spall",
            "balls turn back on rough rings and in a spall: a contact that hardly moves on has no quotient",
            "rigid rings, 500 N, 120 to -120 rpm in 2 ms, rough rings, spall under ball 0, dt 10 us, 3 ms",
            |r| {
                let mut surfaces = surfaces(500.0, 120.0).over(0.5e-3, 10e-6);
                let spall = &mut surfaces.profiles[Side::Outer.index()].spalls[0];
                spall.azimuth -= 1e-3;
                let surfaces = rough_rings(surfaces);
                let case = Rolling {
                    axial: Load::dead(500.0),
                    ..Rolling::run_up(120.0, -120.0, 2e-3)
                };
                over(case, surfaces).rolled(r, NOTHING, |_| ());
            },
        ),
        slow(
            "free_surfaces_from_a_stand",
            "nothing turns at the start, then all does: slopes push balls before anything rolls, and most skid",
            "rigid rings, 200 N, 0 to 3000 rpm in 2 ms, rough rings and a rough ball, cage of 0.2 mm, dt 10 us, 3 ms",
            |r| {
                let mut surfaces = rough_rings(surfaces(200.0, 3000.0));
                surfaces.balls.insert(3, worn(0.1, 0.5e-3, 20e-6));
                let case = Rolling {
                    axial: Load::dead(200.0),
                    cage: Some(cage(0.2e-3)),
                    ..Rolling::run_up(0.0, 3000.0, 2e-3)
                };
                over(case, surfaces).rolled(r, NOTHING, |_| ());
            },
        ),
        slow(
            "free_surfaces_spalled_ball",
            "a ball falls off its own edge at either raceway, and its turning feels it",
            "rigid rings, 2 kN, 3000 rpm, sharp spall of 1 mm on ball 0, 0.2 mm deep, dt 2 us, 6 ms",
            spalled_ball,
        ),
        slow(
            "free_surfaces_ball_spall_meets_spall",
            "edges upon edges: the work of both surfaces is divided between ball and drive",
            "rigid rings, 2 kN, 1800 rpm, sharp spalls of 0.8 mm on ball 0 and 1 mm outside, dt 2 us, 0.6 ms",
            |r| {
                let mut surfaces = surfaces(2000.0, 1800.0).over(1e-3, 0.2e-3);
                surfaces.balls.insert(0, spalled(-0.06, 0.8e-3, 0.2e-3));
                let case = Rolling {
                    dt: 2e-6,
                    ..Rolling::run_up(1800.0, 1800.0, 1e-3)
                };
                over(case, surfaces).with(0.6e-3).rolled(r, NOTHING, |_| ());
            },
        ),
        slow(
            "free_surfaces_all_rough_light_load",
            "no ball is a sphere, none like another, rings are rough, and load is light",
            "rigid rings, 300 N, 6000 rpm, rough balls of 0.2 um, each spalled, rough rings, dt 5 us, 2 ms",
            |r| {
                let mut surfaces = rough_rings(surfaces(300.0, 6000.0));
                for ball in 0..18 {
                    let longitude = 2.399_963 * ball as f64;
                    surfaces.balls.insert(ball, worn(longitude, 0.5e-3, 50e-6));
                }
                let case = Rolling {
                    axial: Load::dead(300.0),
                    dt: 5e-6,
                    ..Rolling::run_up(6000.0, 6000.0, 1e-3)
                };
                over(case, surfaces).with(2e-3).rolled(r, NOTHING, |_| ());
            },
        ),
        slow(
            "free_surfaces_tumbling_ball",
            "a ball whose axis lies along its way: its parallels cross the track at all angles",
            "rigid rings, 1 kN, 3000 rpm, no friction, ball 0 rough and spinning about three axes, dt 2 us, 4 ms",
            tumbling,
        ),
        slow(
            "free_surfaces_flexible_cage",
            "patches, surfaces, slopes of bent rings and pockets act on the same balls",
            "flexible rings, 500 N, 300 N radial, 3000 to 6000 rpm in 1 ms, rough rings, spalled ball, cage, dt 5 us, \
             1 ms",
            |r| {
                let mut surfaces = rough_rings(surfaces(500.0, 3000.0)).over(0.5e-3, 10e-6);
                surfaces.balls.insert(2, worn(-0.1, 0.5e-3, 20e-6));
                let case = Rolling {
                    axial: Load::dead(500.0),
                    radial: Load::dead(300.0),
                    is_flexible: true,
                    cage: Some(cage(0.2e-3)),
                    dt: 5e-6,
                    ..Rolling::run_up(3000.0, 6000.0, 1e-3)
                };
                over(case, surfaces).with(1e-3).rolled(r, LITTLE, |_| ());
            },
        ),
    ]
}

/// Smooth strips of rigid rings under an axial load, N, at a speed, rpm.
fn surfaces(axial: f64, rpm: f64) -> Surfaces {
    Surfaces::at(axial, rpm)
}

fn rough_rings(surfaces: Surfaces) -> Surfaces {
    let surfaces = surfaces.with(Side::Outer, |p| p.waves.extend(rough(3..=60, 0.3e-6)));
    surfaces.with(Side::Inner, |p| p.waves.extend(rough(4..=70, 0.3e-6)))
}

fn over(case: Rolling, surfaces: Surfaces) -> Rolling {
    Rolling {
        surfaces: Some(surfaces),
        ..case
    }
}

fn sharp(record: &mut Record) {
    for friction in [0.0, 0.07] {
        for dt in [2e-6, 5e-6, 10e-6] {
            let surfaces = surfaces(2000.0, 1800.0).over(1e-3, 0.2e-3);
            let case = Rolling {
                friction,
                dt,
                ..Rolling::run_up(1800.0, 1800.0, 1e-3)
            };
            let mut least = f64::INFINITY;
            let course = over(case, surfaces)
                .with(0.6e-3)
                .rolled(record, NOTHING, |state| {
                    least = least.min(outer_force(state, 0));
                });
            record.below("least force of the ball, N", least, 1.0);
            record.below("largest force, N", course.peak, 2000.0);
        }
    }
}

fn spalled_ball(record: &mut Record) {
    let mut surfaces = surfaces(2000.0, 3000.0);
    surfaces.balls.insert(0, spalled(-0.3, 1e-3, 0.2e-3));
    let case = Rolling {
        dt: 2e-6,
        ..Rolling::run_up(3000.0, 3000.0, 1e-3)
    };
    let mut empty = [0; 2];
    over(case, surfaces).with(6e-3).rolled(record, NOTHING, |state| {
        for side in Side::BOTH {
            empty[side.index()] += usize::from(state.forces[side.index()].norm() < 1.0);
        }
    });
    record.that(
        "both contacts of the ball lose their load",
        empty.iter().all(|n| *n > 0),
    );
}

fn tumbling(record: &mut Record) {
    let mut surfaces = surfaces(1000.0, 3000.0);
    let mut profiles = spalled(-0.3, 0.5e-3, 10e-6);
    profiles.waves = rough(2..=20, 0.3e-6);
    surfaces.balls.insert(0, profiles);
    let case = Rolling {
        axial: Load::dead(1000.0),
        friction: 0.0,
        dt: 2e-6,
        spin: Some([700.0, -900.0, 400.0]),
        ..Rolling::run_up(3000.0, 3000.0, 1e-3)
    };
    let mut norm = 0.0f64;
    over(case, surfaces).with(4e-3).rolled(record, NOTHING, |state| {
        let q = state.free.as_ref().unwrap().orientations[0];
        norm = norm.max((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs());
    });
    record.below("departure of the orientation from a rotation", norm, 1e-14);
}
