//! Free balls that yield as spheres between their contacts.

use contact::SphereCompliance;
use dynamics::Model;
use dynamics::effects::{Moment, RadialForce};
use dynamics::interactions::traction::Creep;
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionState, StepCache};
use input::Schedule;

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use super::flexible::flexible;
use crate::support::{equilibrium, steel};

/// The same with balls that yield as spheres.
pub fn sphere(mut model: Model) -> Model {
    let elastic = dynamics::model::elastic(&model.ball_material);
    model.sphere = SphereCompliance::new(elastic, model.geometry.ball_diameter, &model.hertz);
    model
}

fn constant(n: f64) -> RingSpeeds {
    RingSpeeds::from(Speed::constant(rpm(n)))
}

/// Under thrust, a force across and a moment, on tori.
fn combined(speeds: &RingSpeeds, mu: f64) -> Model {
    let mut model = freed(thrust(2000.0), coulomb(mu, Creep::Elastic), speeds);
    model.contact.projects_grooves = false;
    model.effects.push(Box::new(RadialForce {
        value: 800.0,
        direction: 0.4,
        schedule: Schedule::Constant,
    }));
    model.effects.push(Box::new(Moment {
        value: [2.0, -1.0],
        schedule: Schedule::Constant,
    }));
    model
}

fn forces(state: &MotionState) -> Vec<f64> {
    state.forces.iter().map(|f| f.norm()).collect()
}

fn largest_change(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().copied().fold(0.0, f64::max);
    a.iter()
        .zip(b)
        .fold(0.0, |worst, (a, b)| f64::max(worst, (a - b).abs()))
        / largest
}

/// Wrong: the contacts of a free ball would be those of half-spaces, or of another law than in the equilibrium before:
/// a motion would start with a jump. Slow balls on rigid rings that tilt, and on elastic ones. That spheres are stiffer
/// is a thousand times what the first steps change.
#[test]
fn a_motion_has_the_forces_of_its_equilibrium() {
    let speeds = constant(10.0);
    let mut elastic = flexible(800.0, &speeds, steel());
    elastic.contact.projects_grooves = false;
    for (model, name) in [(combined(&speeds, 0.07), "rigid"), (elastic, "elastic")] {
        let half_spaces = equilibrium(&model);
        let model = sphere(model);
        let at_rest = equilibrium(&model);
        let motion = Motion::new(&model, settings(1e-6, &speeds)).unwrap();
        let start = motion.start(&at_rest);
        let before = forces(&start);
        let other: Vec<f64> = half_spaces
            .balls
            .iter()
            .flat_map(|ball| [ball.inner.force_n, ball.outer.force_n])
            .collect();
        let mut worst = 0.0f64;
        run(&motion, start, 4, |state| {
            worst = worst.max(largest_change(&before, &forces(state)));
        });
        let of_sphere = largest_change(&before, &other);
        println!("{name}: {worst:.1e}, spheres change {of_sphere:.1e}");
        assert!(worst < 2e-5 && of_sphere > 5e-4, "{name}: {worst} {of_sphere}");
    }
}

/// Wrong: free balls would swing otherwise than those of the cage where both have the same mechanics: without speed and
/// friction, kicked along the axis, balls stay in their meridian planes.
#[test]
fn without_speed_and_friction_balls_move_as_those_of_the_cage() {
    let speeds = constant(0.0);
    let free = sphere(freed(thrust(500.0), coulomb(0.0, Creep::Elastic), &speeds));
    let mut kinematic = sphere(thrust(500.0));
    kinematic.contact.projects_grooves = false;
    let course = |model: &Model| {
        let motion = Motion::new(model, settings(2e-6, &speeds)).unwrap();
        let mut start = motion.start(&equilibrium(model));
        // Balls unload and press again.
        start.shaft_velocity[2] = -0.15;
        let mut course = Vec::new();
        run(&motion, motion.with_energies(start), 400, |state| {
            assert!(state.ledger.relative_defect().abs() < 1e-11);
            course.push([
                state.shaft[2],
                state.balls[3].radial,
                state.balls[3].axial,
                state.forces[6].norm(),
            ]);
        });
        course
    };
    let [a, b] = [course(&free), course(&kinematic)];
    for k in 0..4 {
        let size = b.iter().fold(0.0, |m, x| f64::max(m, x[k].abs()));
        let off = a
            .iter()
            .zip(&b)
            .fold(0.0, |m, (a, b)| f64::max(m, (a[k] - b[k]).abs()));
        println!("{k}: {size:e} {:.1e}", off / size);
        assert!(off < 1e-9 * size, "{k}: {off} of {size}");
    }
    assert!(a.iter().any(|x| x[3] == 0.0), "balls unload");
}

/// Wrong: what both contacts share would make or lose energy where balls unload, rub and change their speed, or Newton
/// would need many more iterations than with half-spaces.
#[test]
fn the_ledger_closes_and_newton_hardly_notices() {
    let speeds = RingSpeeds::from(Speed::table(
        vec![0.0, 2e-3, 4e-3],
        [2000.0, 4000.0, 1000.0].map(rpm).to_vec(),
    ));
    let mut radial = combined(&speeds, 0.07);
    radial.effects.push(Box::new(RadialForce {
        value: 2500.0,
        direction: 0.0,
        schedule: Schedule::Constant,
    }));
    let elastic = flexible(800.0, &speeds, steel());
    for (model, name) in [(radial, "rigid"), (elastic, "elastic")] {
        let iterations = |model: &Model| {
            let motion = Motion::new(model, settings(1e-5, &speeds)).unwrap();
            let mut state = motion.start(&equilibrium(model));
            let (mut cache, mut sum, mut worst) = (StepCache::default(), 0, 0.0f64);
            for _ in 0..100 {
                let (next, report) = motion.step(&state, &mut cache).unwrap();
                sum += report.newton_iterations;
                worst = worst.max(next.ledger.relative_defect().abs());
                state = next;
            }
            (sum, worst)
        };
        let (half_spaces, spheres) = (iterations(&model), iterations(&sphere(model)));
        println!("{name}: iterations and defect {half_spaces:?}, of spheres {spheres:?}");
        assert!(spheres.1 < 1e-9 && 4 * spheres.0 < 5 * half_spaces.0, "{name}");
    }
}
