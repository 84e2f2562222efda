//! Waves, roughness, measured heights, dents and shoulders.

use contact::Side;

use super::bearings::Load;
use super::record::Record;
use super::surfaces::{Rolling, dents, measured, rough, usual};
use super::{HardCase, Pace};

/// Waves, dents, roughness, shoulders.
pub fn cases() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        slow(
            "surface_waves_unload_balls",
            "every second ball loses contact and is thrown back",
            "rigid rings, 300 N, 3000 rpm, order 9 of 8 um outside, dt 5 us, 20 ms",
            |r| {
                let case = Rolling {
                    dt: 5e-6,
                    duration: 20e-3,
                    ..Rolling::at(300.0, 3000.0)
                };
                let course = case.waves(Side::Outer, 9, 8e-6).holds(r);
                r.that("balls lose contact", course.open > 0);
            },
        ),
        slow(
            "surface_waves_of_order_2000",
            "waves as short as the ellipse, 27 a period of the ball",
            "rigid rings, 2 kN, 1800 rpm, order 2000 of 0.2 um on both rings, dt 2 us",
            |r| {
                let case = Rolling::at(2000.0, 1800.0).waves(Side::Outer, 2000, 0.2e-6);
                case.waves(Side::Inner, 1999, 0.2e-6).holds(r);
            },
        ),
        slow(
            "surface_no_preload",
            "5 N on 18 balls that bounce over waves a hundred times their approach",
            "rigid rings, 5 N, 3000 rpm, order 19 of 2 um outside, dt 5 us, 20 ms",
            |r| {
                let case = Rolling {
                    dt: 5e-6,
                    duration: 20e-3,
                    ..Rolling::at(5.0, 3000.0)
                };
                let course = case.waves(Side::Outer, 19, 2e-6).holds(r);
                r.that("balls lose contact", course.open > 0);
            },
        ),
        slow(
            "surface_rough",
            "a thousand waves on each ring at once",
            "rigid rings, 1 kN, 6000 rpm, orders 2 to 1000 from 0.5 um on, dt 2 us, 2 ms",
            |r| {
                let case = Rolling {
                    duration: 2e-3,
                    ..Rolling::at(1000.0, 6000.0)
                };
                let case = case.with(Side::Outer, |p| p.waves = rough(2..=1000, 0.5e-6));
                case.with(Side::Inner, |p| p.waves = rough(2..=900, 0.5e-6))
                    .holds(r);
            },
        ),
        slow(
            "surface_rough_flexible",
            "the same on rings that ring, with a radial load and shoulders",
            "both rings flexible, 1 kN, 500 N radial, 6000 rpm, orders 2 to 300, dt 5 us, 1 ms",
            |r| {
                let case = Rolling {
                    radial: Load::dead(500.0),
                    shoulders: Some([-0.5, 0.5]),
                    is_flexible: true,
                    dt: 5e-6,
                    duration: 1e-3,
                    ..Rolling::at(1000.0, 6000.0)
                };
                case.with(Side::Outer, |p| p.waves = rough(2..=300, 0.3e-6))
                    .holds(r);
            },
        ),
        slow(
            "surface_measured",
            "a table of heights without any smoothness, and a bump 8 um high ahead of ball 0",
            "rigid rings, 1 kN, 1800 rpm, 720 x 4 heights up to 1 um on both rings, dt 2 us, 2 ms",
            bump,
        ),
        slow(
            "surface_dents",
            "a chain of dents whose rims throw the balls",
            "rigid rings, 500 N, 6000 rpm, 0.3 mm wide, rims of 2 um, every 3 deg on both rings, dt 1 us, 0.6 ms",
            |r| {
                let case = Rolling {
                    dt: 1e-6,
                    ..Rolling::at(500.0, 6000.0)
                };
                let angle = case.contact_angle();
                let case = case.with(Side::Outer, |p| p.dents = dents(angle, 0.0524, 15e-6, 2e-6));
                case.with(Side::Inner, |p| p.dents = dents(angle, 0.0524, 15e-6, 2e-6))
                    .holds(r);
            },
        ),
        slow(
            "surface_dents_with_high_rims",
            "rims as high as the dents are deep, higher than the approach",
            "rigid rings, 100 N, 10 000 rpm, rims of 10 um every 5 deg outside, dt 1 us, 0.6 ms",
            |r| {
                let case = Rolling {
                    dt: 1e-6,
                    ..Rolling::at(100.0, 10_000.0)
                };
                let angle = case.contact_angle();
                let case = case.with(Side::Outer, |p| p.dents = dents(angle, 0.0873, 10e-6, 10e-6));
                let course = case.holds(r);
                r.that("balls lose contact", course.open > 0);
            },
        ),
        slow(
            "surface_spall_on_the_shoulder",
            "a spall in the part of the ellipse that the shoulder has left",
            "rigid rings, 2 kN, 1800 rpm, outer shoulder 6 deg beyond the contact, spall across it, dt 2 us",
            shoulder,
        ),
        slow(
            "surface_unequal_balls",
            "balls of different diameters over waves: a few carry all",
            "rigid rings, 100 N, 6000 rpm, diameters 10 um apart, order 20 of 1 um inside, dt 5 us, 5 ms",
            |r| {
                let case = Rolling {
                    oversizes: (0..18).map(|i| 1e-6 * f64::from((7 * i) % 11 - 5)).collect(),
                    dt: 5e-6,
                    duration: 5e-3,
                    ..Rolling::at(100.0, 6000.0)
                };
                let course = case.waves(Side::Inner, 20, 1e-6).holds(r);
                r.that("balls are without load", course.open > 0);
            },
        ),
    ]
}

fn bump(record: &mut Record) {
    let peak = |height: f64, record: &mut Record| {
        let case = Rolling {
            duration: 2e-3,
            ..Rolling::at(1000.0, 1800.0)
        };
        let case = case.with(Side::Outer, |p| p.tables.push(measured(height)));
        case.with(Side::Inner, |p| p.tables.push(measured(0.0)))
            .holds(record)
            .peak
    };
    let without = peak(0.0, record);
    let with = peak(8e-6, record);
    record.that(
        &format!("the bump raises the largest force from {without:.0} N to {with:.0} N"),
        with > 1.2 * without,
    );
}

fn shoulder(record: &mut Record) {
    let angle = usual().contact_angle();
    let mut spall = usual().spall(0, 1e-3, 5e-6);
    (spall.groove_angle, spall.width) = (angle + 6f64.to_radians(), 0.4e-3);
    let case = Rolling {
        shoulders: Some([-0.5, angle + 6f64.to_radians()]),
        ..usual()
    };
    case.with(Side::Outer, |p| p.spalls.push(spall)).holds(record);
}
