//! Temperatures that change in time or vary with the radius: against constant ones, closed forms and balances.

use crate::support::mounting::{ALPHA, RINGS, at, fit, fitted, flexible, mount, mounted_model, unmounted};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use contact::{BearingGeometry, Meridian, Side};
use dynamics::kinematics::{RingSpeeds, Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::mounting::{Conditions, Mounting, RadialProfile, RingTemperature, TemperatureSchedule};
use dynamics::{ContactMode, Hold, Model, QuasiStaticMotion};

const SMALL: Level = Level::hex8(36, 6, 1, 2);

fn case() -> Case {
    Case {
        radial: 500.0,
        ..Case::axial(2000.0)
    }
}

fn ramp(from: f64, to: f64, duration: f64) -> TemperatureSchedule {
    TemperatureSchedule {
        times: vec![0.0, duration],
        values: vec![from + 273.15, to + 273.15],
    }
}

/// Inner ring, balls and shaft that become 20 K warmer, on a fit.
fn warming(duration: f64) -> Conditions {
    let mut conditions = at(20.0, 20.0, 20.0, [20.0, 20.0]);
    conditions.fits = fitted().fits;
    let warm = conditions.temperatures.as_mut().unwrap();
    warm.rings[0] = RingTemperature::Uniform(ramp(20.0, 40.0, duration));
    warm.balls = ramp(20.0, 40.0, duration);
    warm.partners[0] = Some(ramp(20.0, 40.0, duration));
    conditions
}

/// The same conditions at one temperature of inner ring, balls and shaft.
fn warmed(celsius: f64) -> Conditions {
    let mut conditions = at(celsius, 20.0, celsius, [celsius, 20.0]);
    conditions.fits = fitted().fits;
    conditions
}

fn profile(radii: &[f64], celsius: &[f64]) -> RadialProfile {
    RadialProfile {
        radii: radii.into(),
        values: celsius.iter().map(|t| t + 273.15).collect(),
    }
}

/// A bearing whose inner ring has a temperature by radius; all else is at 20 degC.
fn by_radius(profile: RadialProfile) -> Conditions {
    let mut conditions = at(20.0, 20.0, 20.0, [20.0, 20.0]);
    conditions.temperatures.as_mut().unwrap().rings[0] = RingTemperature::Radial(profile);
    conditions
}

/// Wrong: an instant of a schedule would not be the bearing at the temperatures of that instant. Rounds stop at 1e-10.
#[test]
fn an_instant_of_a_schedule_is_the_bearing_at_its_temperatures() {
    let models: [(fn() -> Model, f64); 2] = [
        (|| case().rigid(), 1e-9),
        (|| case().flexible(ContactMode::Patch, SMALL, Hold::Clamped), 1e-8),
    ];
    for (model, tolerance) in models {
        let moving = mounted_model(model(), &warming(10e-3));
        let rolling = Rolling::new(&moving.geometry, Speed::constant(0.0), [0.0; 2]);
        let mut quasi = QuasiStaticMotion::new(&moving, rolling, 5e-3).unwrap();
        // Before the end, at it, and after it.
        for (step, celsius) in [(1, 30.0), (2, 40.0), (3, 40.0)] {
            let found = quasi.step(step, None).unwrap();
            let expected = equilibrium(&mounted_model(model(), &warmed(celsius)));
            for (a, b) in found.balls.iter().zip(&expected.balls) {
                assert!(
                    relative(a.inner.force_n, b.inner.force_n) < tolerance,
                    "{celsius}"
                );
                assert!((a.outer.contact_angle_rad - b.outer.contact_angle_rad).abs() < tolerance);
            }
        }
        let clearance = moving.mounting.report.as_ref().unwrap().clearances.operating;
        let expected = mounted_model(model(), &warmed(40.0)).mounting.report.unwrap();
        assert_eq!(clearance, expected.clearances.operating);
    }
}

/// Wrong: a table of one temperature would cost steps, or change their bits.
#[test]
fn a_schedule_that_stays_is_a_constant_to_the_bit() {
    let mut scheduled = warmed(40.0);
    let warm = scheduled.temperatures.as_mut().unwrap();
    warm.rings[0] = RingTemperature::Uniform(ramp(40.0, 40.0, 1.0));
    warm.balls = ramp(40.0, 40.0, 1.0);
    let model = || case().flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let [a, b] = [scheduled, warmed(40.0)].map(|conditions| mounted_model(model(), &conditions));
    assert!(!a.mounting.changes());
    let run = |model: &Model| {
        let (states, _) = steps(model, 1e-5, 4);
        let last = states.last().unwrap();
        let bits = Meridian::flat(&last.forces).into_iter().chain(last.shaft);
        bits.map(|x| x.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(run(&a), run(&b));
}

/// States of a motion from its equilibrium on, and the motion's model at work.
fn steps(model: &Model, dt: f64, n: usize) -> (Vec<MotionState>, f64) {
    let rest = equilibrium(model);
    let motion = Motion::new(model, MotionSettings::conserving(dt, RingSpeeds::default())).unwrap();
    let (mut states, mut cache) = (vec![motion.start(&rest)], StepCache::default());
    // Work of growth against the mean forces: F . (motion of the groove centre), F times the growth of ball and groove.
    let mut work = 0.0;
    for step in 0..n {
        let next = motion.step(&states[step], &mut cache).unwrap().0;
        let ends = [step, step + 1].map(|step| model.mounting.at(motion.time(step as u64)));
        for (index, force) in next.forces.iter().enumerate() {
            let side = Side::BOTH[index % 2];
            let [from, to] = ends.each_ref().map(|at| at.groove_motion(side, None));
            let grown = ends[1].touching_growth(side) - ends[0].touching_growth(side);
            let moved = force.dot(from - to);
            work += moved - force.norm() * grown;
        }
        states.push(next);
    }
    (states, work)
}

/// Wrong: energy would come from nowhere as bodies become warm. The ledger closes; the work of temperature is that of
/// the mean contact forces over the growth, with an error of the second order in the step.
#[test]
fn the_work_of_temperatures_closes_the_ledger() {
    let mut errors = Vec::new();
    for (dt, n) in [(2e-6, 100), (1e-6, 200)] {
        let model = mounted_model(case().rigid(), &warming(2e-4));
        let (states, work) = steps(&model, dt, n);
        let last = states.last().unwrap();
        assert!(
            last.ledger.relative_defect().abs() < 1e-9,
            "{}",
            last.ledger.relative_defect()
        );
        assert!(last.ledger.temperature_work.abs() > 0.05 * last.ledger.largest);
        assert!(last.ledger.patch_work.abs() < 1e-12 * last.ledger.largest);
        errors.push((last.ledger.temperature_work - work).abs() / last.ledger.largest);
    }
    assert!(errors[0] < 1e-3 && errors[1] < 0.35 * errors[0], "{errors:?}");
    let model = mounted_model(
        case().flexible(ContactMode::Patch, SMALL, Hold::Clamped),
        &warming(2e-4),
    );
    let (states, _) = steps(&model, 2e-6, 60);
    let last = states.last().unwrap();
    assert!(
        last.ledger.relative_defect().abs() < 1e-8,
        "{}",
        last.ledger.relative_defect()
    );
    assert!(last.ledger.temperature_work.abs() > 0.01 * last.ledger.largest);
}

/// Wrong: a rigid ring would not grow as a tube with its temperatures: both surfaces by the mean over the section.
/// Linear over the wall, T = T_a + s (r - a): mean T_a + s (2 (b^3 - a^3) / (3 (b^2 - a^2)) - a).
#[test]
fn a_rigid_ring_grows_by_the_mean_temperature_of_its_tube() {
    let (a, b) = (25e-3, 28.005e-3);
    let slope = 10.0 / (b - a);
    let mean = 30.0 + slope * (2.0 * (b * b * b - a * a * a) / (3.0 * (b * b - a * a)) - a);
    let warm = mount(&RINGS, &by_radius(profile(&[a, b], &[30.0, 40.0])));
    let one = mount(&RINGS, &at(mean, 20.0, 20.0, [20.0, 20.0]));
    let [found, expected] = [&warm, &one].map(|mounting| mounting.rings[0].centre_growth);
    assert!(relative(found, expected) < 1e-12, "{found} {expected}");
    let [found, expected] = [warm, one].map(|mounting| mounting.report.unwrap().clearances.operating.radial);
    assert!((found - expected).abs() < 1e-15);
    // Beyond the radii that are given the temperature stays.
    let held = mount(&RINGS, &by_radius(profile(&[20e-3, 21e-3], &[90.0, 40.0])));
    let one = mount(&RINGS, &at(40.0, 20.0, 20.0, [20.0, 20.0]));
    assert!(relative(held.rings[0].centre_growth, one.rings[0].centre_growth) < 1e-12);
}

/// Wrong: a flexible ring would not grow where it is warm. A profile of one value is that value; a ring in its mean
/// motion that is 10 K warmer at the bore than at the shoulder grows at its groove by what its section has in the mean:
/// less than the tube to the groove bottom, more than that to the shoulder.
#[test]
fn a_flexible_ring_grows_as_its_temperatures_say() {
    let rings = flexible(Hold::MeanMotion);
    let even = mount(&rings, &by_radius(profile(&[25e-3, 28e-3], &[40.0, 40.0])));
    let one = mount(&rings, &at(40.0, 20.0, 20.0, [20.0, 20.0]));
    let growth = |mounting: &Mounting| {
        let clearances = mounting.report.as_ref().unwrap().clearances;
        clearances.unmounted.radial - clearances.operating.radial
    };
    assert!(relative(growth(&even), growth(&one)) < 1e-9);
    let field = even.rings[0].field.as_ref().unwrap();
    assert!(field.iter().all(|u| u.abs() < 1e-18));
    let steep = profile(&[25e-3, 30.2e-3], &[30.0, 20.0]);
    let [found, bottom] = [&rings, &RINGS].map(|rings| growth(&mount(rings, &by_radius(steep.clone()))));
    let shoulder = ALPHA * (steep.tube_mean([25e-3, 30.2e-3]) - 293.15) * 56.01e-3;
    assert!(shoulder < found && found < bottom, "{shoulder} {found} {bottom}");
}

/// Wrong: elastic rings would take another clearance or contact angle from warmth than their closed forms: 10 K of
/// inner ring and balls are those of grooves and balls that have grown, cos a0 = 1 - P_d/(2 A), to a hundredth of the
/// change.
#[test]
fn a_warm_flexible_inner_ring_has_the_clearance_and_contact_angle_of_a_larger_one() {
    let model = |conditions: &Conditions| {
        let model = case().flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
        mounted_model(model, conditions)
    };
    let warm = model(&at(30.0, 20.0, 30.0, [30.0, 20.0]));
    let clearances = warm.mounting.report.as_ref().unwrap().clearances;
    let loss = clearances.unmounted.radial - clearances.operating.radial;
    assert!((loss - 10.0 * ALPHA * (56.01e-3 + 18e-3)).abs() < 1e-15, "{loss}");
    let e = 1.0 + 10.0 * ALPHA;
    let distance = e * (4.65e-3 - 9e-3) + 4.75e-3;
    let angle = (1.0 - clearances.operating.radial / (2.0 * distance)).acos();
    assert!((clearances.operating.free_contact_angle - angle).abs() < 1e-12);
    let mut grown = model(&Conditions::default());
    grown.geometry.inner_raceway_diameter *= e;
    grown.geometry.inner_groove_radius *= e;
    grown.geometry.ball_diameter *= e;
    let cold = model(&Conditions::default());
    let mean = |model: &Model| {
        let balls = equilibrium(model).balls;
        balls.iter().map(|ball| ball.inner.contact_angle_rad).sum::<f64>() / balls.len() as f64
    };
    let [cold, warm, grown] = [&cold, &warm, &grown].map(mean);
    assert!(cold - warm > 0.01, "{cold} {warm}");
    assert!(
        (warm - grown).abs() < 0.01 * (cold - warm),
        "{cold} {warm} {grown}"
    );
}

/// Wrong: the stress of uneven temperatures would be missing. Free of loads it balances: over the section of a ring in
/// its mean motion the hoop force is zero, with tension where the ring is colder than the mean.
#[test]
fn the_hoop_stress_of_uneven_temperatures_balances() {
    let rings = flexible(Hold::MeanMotion);
    let mounting = mount(&rings, &by_radius(profile(&[25e-3, 30.2e-3], &[40.0, 20.0])));
    let (ring, own) = (
        rings[0].as_deref().unwrap(),
        mounting.rings[0].own_stress.as_ref().unwrap(),
    );
    let stress = dynamics::PointStress::new(ring, "inner", dynamics::Backend::Auto).unwrap();
    let points = stress.point_positions();
    let moved = stress.at_points(mounting.rings[0].field.as_ref().unwrap());
    let (mut sum, mut size, mut bore, mut shoulder) = (0.0, 0.0, Vec::new(), Vec::new());
    for ((x, a), b) in points.iter().zip(&moved).zip(&own.points) {
        let r = x[0].hypot(x[1]);
        let [c, s] = [x[0] / r, x[1] / r];
        let t: [f64; 6] = std::array::from_fn(|i| a[i] + b[i]);
        let hoop = s * s * t[0] + c * c * t[1] - 2.0 * s * c * t[3];
        // Points of one radius stand for equal shares of the section; weights of 1/r make volumes sections.
        (sum, size) = (sum + hoop / r, size + hoop.abs() / r);
        if r < 25.5e-3 {
            bore.push(hoop);
        }
        if r > 29.5e-3 {
            shoulder.push(hoop);
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    assert!(
        mean(&bore) < -5e6 && mean(&shoulder) > 5e6,
        "{} {}",
        mean(&bore),
        mean(&shoulder)
    );
    // Elements differ in size by a factor of two, so that equal weights err by some tenths.
    assert!(sum.abs() < 0.5 * size, "{sum} {size}");
}

/// Wrong: a schedule that loosens a turning ring, or makes it yield, would end in the middle of a run.
#[test]
fn schedules_are_looked_at_to_their_end() {
    let geometry = BearingGeometry::reference_7010c();
    let mut bearing = unmounted(&geometry, &RINGS);
    bearing.speeds = [100.0, 0.0];
    let mut cooling = warming(1.0);
    cooling.temperatures.as_mut().unwrap().partners[0] = Some(ramp(20.0, -20.0, 1.0));
    let said = Mounting::new(&bearing, &cooling).unwrap_err().to_string();
    assert!(
        said.starts_with("the inner ring lets go of its partner at 0 rpm, with its -24.50 um"),
        "{said}"
    );
    let mut hot = warming(1.0);
    hot.fits = [fit(80e-6, 0.0), None];
    hot.temperatures.as_mut().unwrap().partners[0] = Some(ramp(20.0, 100.0, 1.0));
    bearing.yield_strength = Some(400e6);
    let said = Mounting::new(&bearing, &hot).unwrap_err().to_string();
    assert!(
        said.starts_with("the fit of the inner ring presses with "),
        "{said}"
    );
}
