//! Tests of arcs of balls that have turned.

use std::f64::consts::PI;

use super::*;
use crate::geometry::{BearingGeometry, Side};
use crate::surface::{Dent, Heights, Profiles, Spall, Wave};
use crate::worn_line::WornLine;

/// The meridian plane of a contact in the frame of a ball that has turned from its start by an angle about an axis.
fn seen(equator: f64, (axis, turned): ([f64; 3], f64), angle: f64) -> SeenMeridian {
    let (sin, cos) = equator.sin_cos();
    let frame = [[cos, 0.0, sin], [0.0, -1.0, 0.0], [sin, 0.0, -cos]];
    let turn = |v: [f64; 3]| {
        let across = crate::vector::cross(axis, v);
        let along = crate::vector::dot(axis, v);
        let (sin, cos) = f64::sin_cos(turned);
        [0, 1, 2].map(|i| v[i] * cos + across[i] * sin + axis[i] * along * (1.0 - cos))
    };
    let of_ball = |v: [f64; 3]| frame.map(|k| crate::vector::dot(turn(k), v));
    SeenMeridian {
        out: of_ball([1.0, 0.0, 0.0]),
        axial: of_ball([0.0, 0.0, 1.0]),
        angle,
    }
}

/// Wrong: a ball in space would be read elsewhere than one whose turning is given. A ball with a spall, a table and
/// waves that has rolled about its axis: the arc has the same missing material as the line, at the corners and between
/// them, for either raceway.
#[test]
fn an_arc_of_a_ball_that_rolled_is_its_line() {
    let geometry = BearingGeometry::reference_7010c();
    let equator = geometry.free_contact_angle();
    let profiles = Profiles {
        spalls: vec![Spall {
            azimuth: 1.0,
            groove_angle: 0.1,
            length: 1e-3,
            width: 0.6e-3,
            depth: 3e-6,
            edge: 0.1e-3,
        }],
        waves: vec![Wave {
            order: 7,
            amplitude: 1e-6,
            phase: 0.4,
        }],
        tables: vec![Heights {
            azimuths: vec![0.0, 2.0, 4.0],
            angles: vec![-0.2, 0.0, 0.3],
            heights: vec![0.0, 1e-6, -1e-6, 2e-6, 0.0, 1e-6, 0.0, 3e-6, 1e-6],
        }],
        ..Profiles::default()
    };
    let axis = [equator.sin(), 0.0, -equator.cos()];
    for side in Side::BOTH {
        let surface = BallSurface::new((&geometry, side), equator, &profiles).unwrap();
        for rolled in [0.0, 0.9, -1.0, 2.2, 5.3] {
            let missing = surface.missing_at(rolled);
            let line = surface.line(&missing);
            let arc = surface.arc(&seen(equator, (axis, rolled), equator + 0.05));
            let on_arc = surface.line_along(&arc);
            assert!(arc.angles.windows(2).all(|a| a[0] < a[1]));
            let between = |line: &WornLine<'_>, angle: f64| {
                let piece = line.angles.partition_point(|a| *a <= angle);
                line.piece(piece, angle).1
            };
            for i in -250..=250 {
                let angle = equator + 1e-3 * f64::from(i) + 1e-4;
                let (a, b) = (between(&line, angle), between(&on_arc, angle));
                assert!((a - b).abs() < 1e-17, "{side:?} {rolled} {angle}: {a} {b}");
            }
        }
    }
}

/// Wrong: a ball that turns about another axis would have its marks elsewhere. A dent on a ball turned about axes of
/// all directions so that its place comes under the contact at a contact angle: the arc is deepest there.
#[test]
fn an_arc_meets_a_mark_wherever_the_ball_has_turned() {
    let geometry = BearingGeometry::reference_7010c();
    let equator = geometry.free_contact_angle();
    let dent = Dent {
        azimuth: 0.7,
        groove_angle: -0.2,
        diameter: 0.6e-3,
        depth: 1e-7,
        rim_height: 0.0,
        rim_width: 0.0,
    };
    let profiles = Profiles {
        dents: vec![dent],
        ..Profiles::default()
    };
    for side in Side::BOTH {
        let surface = BallSurface::new((&geometry, side), equator, &profiles).unwrap();
        for spin in 0..12 {
            // The place of the dent in space at the start, then the contact at the angle 0.3, and the turn between
            // them.
            let from = place(equator, dent.azimuth, dent.groove_angle);
            let to = [0.3f64.cos(), 0.0, 0.3f64.sin()].map(|x| side.sign() * x);
            let half = [0, 1, 2].map(|i| from[i] + to[i]);
            let size = crate::vector::dot(half, half).sqrt();
            // Half a turn about the bisector, then a turn about the contact's normal.
            let about = half.map(|x| x / size);
            let mut found = seen(equator, (about, PI), 0.3);
            let spun = |v: [f64; 3]| {
                let n = place_of(&found, side, 0.3);
                let (sin, cos) = f64::sin_cos(0.5 * f64::from(spin));
                let across = crate::vector::cross(n, v);
                let along = crate::vector::dot(n, v);
                [0, 1, 2].map(|i| v[i] * cos + across[i] * sin + n[i] * along * (1.0 - cos))
            };
            found = SeenMeridian {
                out: spun(found.out),
                axial: spun(found.axial),
                ..found
            };
            let arc = surface.arc(&found);
            let deepest = (0..arc.angles.len()).max_by(|a, b| arc.missing[*a].total_cmp(&arc.missing[*b]));
            let deepest = deepest.unwrap();
            // Points are 1 deg apart, the dent has a radius of 3.8 deg: a depth 1 - (0.5/3.8)^2 at least.
            assert!(
                (arc.angles[deepest] - 0.3).abs() < 0.6f64.to_radians() && arc.missing[deepest] > 0.97e-7,
                "{side:?} {spin}: {} {}",
                arc.angles[deepest],
                arc.missing[deepest]
            );
        }
    }
}

/// Where a place of a ball stands in space at the start, in the meridian frame.
fn place(equator: f64, longitude: f64, latitude: f64) -> [f64; 3] {
    let (sin, cos) = equator.sin_cos();
    let (x, y) = (latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin());
    let z = -latitude.sin();
    [x * cos + z * sin, -y, x * sin - z * cos]
}

/// The place that a raceway meets at a contact angle, in the frame of the ball.
fn place_of(seen: &SeenMeridian, side: Side, angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [0, 1, 2].map(|i| side.sign() * (cos * seen.out[i] + sin * seen.axial[i]))
}
