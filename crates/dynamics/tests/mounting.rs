//! Fits and temperatures against closed forms of thick tubes, at rest and in motion.

use crate::support::mounting::{
    ALPHA, I, RINGS, at, fit, fitted, flexible, message, mount, mounted_model, unmounted,
};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use contact::{BearingGeometry, Side};
use dynamics::kinematics::RingSpeeds;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::mounting::{Conditions, Mounting};
use dynamics::{ContactMode, Hold};

/// Wrong: a rigid ring would not grow as a tube on a solid shaft of its own steel: I d / d_i, 8.927 um of 10 um, with
/// E I (d_i^2 - d^2) / (2 d d_i^2) = 4.20 MPa; and in a housing twice as large shrink by 8.83 um.
#[test]
fn rigid_rings_grow_as_thick_tubes() {
    let mounting = mount(&RINGS, &fitted());
    let report = mounting.report.unwrap();
    let [inner, outer] = report.seats.map(Option::unwrap);
    let (d, bottom) = (50e-3f64, 56.01e-3f64);
    assert!(
        relative(2.0 * inner.groove_growth, I * d / bottom) < 1e-13,
        "{inner:?}"
    );
    let pressure = 207e9 * I * (bottom * bottom - d * d) / (2.0 * d * bottom * bottom);
    assert!(relative(inner.pressure, pressure) < 1e-13);
    assert!((pressure - 4.20e6).abs() < 5e3, "{pressure}");
    assert!((2.0 * outer.groove_growth + 8.83e-6).abs() < 5e-9, "{outer:?}");
    // The clearance loses what both grooves lose, and the free contact angle follows.
    let [before, after] = [report.clearances.unmounted, report.clearances.mounted];
    let loss = 2.0 * (inner.groove_growth - outer.groove_growth);
    assert!((before.radial - after.radial - loss).abs() < 1e-16);
    assert!(
        relative(
            after.free_contact_angle.cos(),
            1.0 - after.radial / (2.0 * 0.4e-3)
        ) < 1e-13
    );
    assert_eq!(report.clearances.mounted, report.clearances.operating);
}

/// Wrong: a ring would stay on its shaft at any speed. 10 um on a solid 50 mm shaft: about 27 400 rpm, 2864 rad/s,
/// with u(a) = rho omega^2 a/(4 E) [(3 + nu) b^2 + (1 - nu) a^2] of the ring and (1 - nu) rho omega^2 a^3/(4 E) of the
/// shaft.
#[test]
fn a_rigid_ring_lets_go_at_the_speed_of_turning_discs() {
    let limit = mount(&RINGS, &fitted()).report.unwrap().seats[0]
        .unwrap()
        .loosening_speed
        .unwrap();
    let (a, b, nu) = (25e-3f64, 28.005e-3f64, 0.3);
    let ring = (3.0 + nu) * b * b + (1.0 - nu) * a * a;
    let growth = 7800.0 * a / (4.0 * 207e9) * (ring - (1.0 - nu) * a * a);
    assert!(relative(limit, (0.5 * I / growth).sqrt()) < 1e-12);
    assert!((limit - 2864.0).abs() < 1.0, "{limit}");
    // The outer ring turns with its housing, which grows more.
    let outer = mount(&RINGS, &fitted()).report.unwrap().seats[1].unwrap();
    let [a, b, c] = [37.0185e-3f64, 40e-3, 80e-3].map(|r| r * r);
    let grown = (3.0 + nu) * c + (1.0 - nu) * b - (1.0 - nu) * b - (3.0 + nu) * a;
    let growth = 7800.0 * 40e-3 / (4.0 * 207e9) * grown;
    assert!(relative(outer.loosening_speed.unwrap(), (0.5 * I / growth).sqrt()) < 1e-12);
    let geometry = BearingGeometry::reference_7010c();
    let mut bearing = unmounted(&geometry, &RINGS);
    bearing.speeds = [2900.0, 0.0];
    let said = Mounting::new(&bearing, &fitted()).unwrap_err().to_string();
    let start = "the inner ring lets go of its partner at 27350 rpm, with its 10.00 um of interference, but [speed] \
                 reaches 27693 rpm;";
    assert!(said.starts_with(start), "{said}");
}

/// Wrong: an aluminium housing would grow in speed as heavy as steel, 2.9 times too much, so that its fit would seem to
/// let go at half of the speed. Turning annuli: bore u(a) = rho w^2 a/(4 E) [(3 + nu) b^2 + (1 - nu) a^2], outside u(b)
/// with both exchanged.
#[test]
fn a_light_housing_lets_go_at_its_own_speed() {
    let (e, nu, density) = (70e9, 0.33, 2700.0);
    let housing = |density| {
        let mut conditions = fitted();
        let fit = conditions.fits[1].as_mut().unwrap();
        (fit.young_modulus, fit.poisson_ratio, fit.density) = (Some(e), Some(nu), density);
        let report = mount(&RINGS, &conditions).report.unwrap();
        report.seats[1].unwrap().loosening_speed.unwrap()
    };
    let [a, b, c] = [37.0185e-3f64, 40e-3, 80e-3].map(|r| r * r);
    let limit = |density: f64| {
        let bore = density / (4.0 * e) * 40e-3 * ((3.0 + nu) * c + (1.0 - nu) * b);
        let ring = 7800.0 / (4.0 * 207e9) * 40e-3 * (3.3 * a + 0.7 * b);
        (0.5 * I / (bore - ring)).sqrt()
    };
    assert!(relative(housing(Some(density)), limit(density)) < 1e-12);
    // Without a density of its own it has that of the rings.
    assert!(relative(housing(None), limit(7800.0)) < 1e-12);
    assert!(limit(density) > 1.8 * limit(7800.0));
}

/// Wrong: a bearing that is warm all through would carry other forces than a cold one.
#[test]
fn one_temperature_changes_no_force_and_makes_no_stress() {
    let case = Case {
        radial: 500.0,
        ..Case::axial(2000.0)
    };
    let warm = at(80.0, 80.0, 80.0, [80.0, 80.0]);
    let level = Level::hex8(36, 6, 2, 3);
    let models = [
        (case.rigid(), case.rigid()),
        (
            case.flexible(ContactMode::Patch, level, Hold::Clamped),
            case.flexible(ContactMode::Patch, level, Hold::Clamped),
        ),
    ];
    for (cold, hot) in models {
        let hot = mounted_model(hot, &warm);
        assert!(hot.mounting.rings.iter().all(|ring| ring.field.is_none()));
        assert!((hot.mounting.rings[0].expansion - 60.0 * ALPHA).abs() < 1e-15);
        let (a, b) = (equilibrium(&cold), equilibrium(&hot));
        for (a, b) in a.balls.iter().zip(&b.balls) {
            assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-12);
            assert!((a.outer.contact_angle_rad - b.outer.contact_angle_rad).abs() < 1e-12);
        }
        let clearances = hot.mounting.report.unwrap().clearances;
        let [cold, warm] = [clearances.unmounted, clearances.operating];
        assert!(relative(warm.radial, cold.radial * (1.0 + 60.0 * ALPHA)) < 1e-12);
        assert!((warm.free_contact_angle - cold.free_contact_angle).abs() < 1e-12);
    }
}

/// Wrong: warm grooves and balls would not take up clearance: 10 K more of inner ring and balls take 6.44 + 2 x 1.035
/// um, and the bearing is one with these dimensions.
#[test]
fn warm_grooves_and_balls_take_up_clearance() {
    let warm = at(30.0, 20.0, 30.0, [30.0, 20.0]);
    let case = Case {
        radial: 500.0,
        ..Case::axial(2000.0)
    };
    let model = mounted_model(case.rigid(), &warm);
    let clearances = model.mounting.report.clone().unwrap().clearances;
    let loss = clearances.unmounted.radial - clearances.operating.radial;
    let expected = 10.0 * ALPHA * (56.01e-3 + 2.0 * 9e-3);
    assert!((loss - expected).abs() < 1e-17, "{loss} {expected}");
    assert!((expected - 8.511e-6).abs() < 1e-9);
    let mut grown = case.rigid();
    let e = 1.0 + 10.0 * ALPHA;
    grown.geometry.inner_raceway_diameter *= e;
    grown.geometry.inner_groove_radius *= e;
    grown.geometry.ball_diameter *= e;
    let free = grown.geometry.free_contact_angle();
    assert!((clearances.operating.free_contact_angle - free).abs() < 1e-12);
    // Statics counts the shaft from where the balls of the cold bearing just touch.
    let shift = grown.geometry.axial_offset() - model.geometry.axial_offset();
    let (a, b) = (equilibrium(&model), equilibrium(&grown));
    assert!((a.displacements.shaft[2] - b.displacements.shaft[2] - shift).abs() < 1e-12);
    for (a, b) in a.balls.iter().zip(&b.balls) {
        assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-9);
        assert!((a.inner.contact_angle_rad - b.inner.contact_angle_rad).abs() < 1e-9);
    }
}

/// Wrong: a warm shaft would not tighten its ring: 10 K are e d = 5.75 um more interference.
#[test]
fn temperature_changes_interference() {
    let mut conditions = fitted();
    conditions.temperatures = at(20.0, 20.0, 20.0, [30.0, 30.0]).temperatures;
    let [inner, outer] = mount(&RINGS, &conditions)
        .report
        .unwrap()
        .seats
        .map(Option::unwrap);
    assert!((inner.interference - I - 10.0 * ALPHA * 50e-3).abs() < 1e-18);
    assert!((outer.interference - I + 10.0 * ALPHA * 80e-3).abs() < 1e-18);
    assert!((inner.pressure / 4.20e6 - 1.575).abs() < 2e-3, "{inner:?}");
}

/// Wrong: a seat that does not press would be computed as one that does.
#[test]
fn loose_fits_are_said() {
    let loose = Conditions {
        fits: [None, fit(-5e-6, 160e-3)],
        ..Conditions::default()
    };
    let said = message(&flexible(Hold::Clamped), &loose);
    let start = "the outer ring has 5.00 um of clearance on its partner, warm as it is, but outer.support = \
                 \"clamped\"";
    assert!(said.starts_with(start), "{said}");
    for rings in [RINGS, flexible(Hold::MeanMotion)] {
        let mounting = mount(&rings, &loose);
        assert_eq!(mounting.groove_motion(Side::Outer, None).norm(), 0.0);
        let report = mounting.report.unwrap();
        assert_eq!(report.seats[1].unwrap().pressure, 0.0);
        let said = &report.warnings[0];
        assert!(
            said.starts_with("the outer ring has a clearance of 5.00 um on its seat"),
            "{said}"
        );
    }
}

/// Wrong: a fit beyond yield would be computed as elastic; a ring beyond its tempering without a word.
#[test]
fn yield_and_tempering_are_watched() {
    let geometry = BearingGeometry::reference_7010c();
    let mut bearing = unmounted(&geometry, &RINGS);
    bearing.yield_strength = Some(300e6);
    let tight = Conditions {
        fits: [fit(80e-6, 0.0), None],
        ..Conditions::default()
    };
    let said = Mounting::new(&bearing, &tight).unwrap_err().to_string();
    // p = 8 x 4.20 MPa, 2 b^2/(b^2 - a^2) = 9.849: 331 MPa.
    let start = "the fit of the inner ring presses with 33.6 MPa, which stresses it by 331 MPa (Tresca";
    assert!(said.starts_with(start), "{said}");
    let hot = mount(&RINGS, &at(150.0, 60.0, 60.0, [60.0, 60.0]))
        .report
        .unwrap();
    let start = "the inner ring is at 150 degC: beyond 120 degC a ring grows for good unless";
    assert!(hot.warnings[0].starts_with(start), "{}", hot.warnings[0]);
}

/// Wrong: a motion would begin with another groove than its equilibrium, and ring.
#[test]
fn a_motion_of_a_mounted_bearing_stays_at_its_equilibrium() {
    let case = Case {
        radial: 500.0,
        ..Case::axial(2000.0)
    };
    let mut conditions = at(40.0, 20.0, 40.0, [50.0, 20.0]);
    conditions.fits = fitted().fits;
    let level = Level::hex8(54, 6, 1, 2);
    let model = mounted_model(
        case.flexible(ContactMode::Patch, level, Hold::Clamped),
        &conditions,
    );
    let rest = equilibrium(&model);
    let settings = MotionSettings::conserving(5e-6, RingSpeeds::default());
    let motion = Motion::new(&model, settings).unwrap();
    let start = motion.start(&rest);
    let (mut state, mut cache) = (motion.start(&rest), StepCache::default());
    for _ in 0..20 {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    let largest = start.forces.iter().fold(0.0, |m: f64, f| m.max(f.norm()));
    for (a, b) in start.forces.iter().zip(&state.forces) {
        assert!((*a - *b).norm() < 1e-8 * largest, "{a:?} {b:?}");
    }
    assert!(state.ledger.relative_defect().abs() < 1e-9);
}

/// Wrong: a clamped seat that pulls in spite of interference would be said to have a clearance below zero. An inner
/// ring 16.5 K warmer than its shaft keeps 10 um - 16.5 x 11.5e-6 x 50 mm = 0.51 um; what it lacks makes it tight.
#[test]
fn a_clamped_seat_without_pressure_says_what_it_lacks() {
    let rings = flexible(Hold::Clamped);
    let with = |interference: f64| Conditions {
        fits: [fit(interference, 0.0), None],
        ..at(36.5, 20.0, 20.0, [20.0, 20.0])
    };
    let said = message(&rings, &with(I));
    let start = "the inner ring has 0.51 um of interference with its partner, warm as it is, which a seat that cannot \
                 contract along the axis takes up without pressure, but inner.support = \"clamped\"";
    assert!(said.starts_with(start), "{said}");
    let (_, rest) = said.split_once("at least ").unwrap();
    let missing: f64 = rest
        .split_once(" um more interference")
        .unwrap()
        .0
        .parse()
        .unwrap();
    assert!(missing > 0.1, "{said}");
    let seat = mount(&rings, &with(I + 1e-6 * (missing + 0.01)))
        .report
        .unwrap()
        .seats[0];
    assert!(seat.unwrap().pressure > 0.0);
    let said = message(&rings, &with(I + 1e-6 * (missing - 0.02)));
    assert!(said.contains("at least 0.02 um more interference"), "{said}");
}
