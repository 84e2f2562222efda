//! Equilibria that do not exist, or are not unique, or that nothing holds: an answer, or an error that names the cause.

use contact::Side;
use dynamics::{ContactMode, DynamicsError, Hold, Model, ShaftDof, StaticSolution, StaticSolver};

use super::bearings::{Load, SMALL, flexible, rigid};
use super::record::Record;
use super::support::rings::ring;
use super::support::{Case, relative};
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let case = |name, why, settings, run| HardCase::new(name, Pace::Fast, why, settings, run);
    vec![
        case(
            "load_away_from_contact",
            "one ball, and the load pulls the ring away from it",
            "1 ball, radial 1 kN away from it, z locked",
            away,
        ),
        case(
            "too_large_a_load",
            "no contact law carries it within the bearing",
            "axial 10^9 N, rigid and flexible; 10^6 N, flexible",
            too_large,
        ),
        case(
            "mirrored_equilibria",
            "pure radial load: the ring could lean to either side",
            "starts at z = +-0.3 mm, 0.2 mm of clearance, tilts locked",
            mirrored,
        ),
        case(
            "mirrored_thrust",
            "thrust of either sign presses the other flanks",
            "+-2 kN, rigid rings",
            mirrored_thrust,
        ),
        case(
            "no_load",
            "any place within the clearance is an equilibrium",
            "no load at all",
            no_load,
        ),
        case(
            "two_balls",
            "nothing holds the ring across the line of its balls",
            "2 balls at 0 and 180 deg, y free",
            two_balls,
        ),
        case(
            "tilt_on_two_balls",
            "nothing holds the tilt about the line of two balls",
            "2 balls, tilts free",
            tilt_on_two_balls,
        ),
        case(
            "ring_not_held",
            "a flexible ring without a seat",
            "outer ring with hold = free",
            not_held,
        ),
        case(
            "singular_border",
            "five free shaft motions on two balls of flexible rings",
            "2 balls, all free, 2 kN axial",
            singular_border,
        ),
        case(
            "massless_shaft_adrift",
            "a rigid ring without mass that nothing touches, in motion",
            "axial -10 N, no mass",
            adrift,
        ),
        case(
            "huge_clearance",
            "balls that no position can touch",
            "P_d above 4 A",
            impossible,
        ),
    ]
}

fn solve(model: &Model) -> Result<StaticSolution, DynamicsError> {
    StaticSolver::new(model)?.solve(model, None)
}

fn error_of(model: &Model) -> String {
    solve(model).err().map_or(String::new(), |e| e.to_string())
}

fn away(record: &mut Record) {
    let mut model = rigid(Load::dead(0.0), Load::dead(-1e3));
    model.geometry.n_balls = 1;
    model.shaft[1] = ShaftDof::Prescribed(0.0);
    model.shaft[2] = ShaftDof::Prescribed(0.0);
    record.says(
        &error_of(&model),
        "presses on the inner ring at a contact angle of",
    );
}

fn too_large(record: &mut Record) {
    let no_equilibrium = "no equilibrium: z of the shaft runs beyond";
    let load = || Load::dead(1e9);
    record.says(&error_of(&rigid(load(), Load::dead(0.0))), no_equilibrium);
    record.says(&error_of(&flexible(load(), Load::dead(0.0))), no_equilibrium);
    // 1 MN has an equilibrium within the grooves, of forces that no steel bears: the program must say that.
    match solve(&flexible(Load::dead(1e6), Load::dead(0.0))) {
        Ok(solution) => {
            record.says(
                &solution.warnings.join("; "),
                "above the static limit of bearing steel",
            );
            let axial = |b: &dynamics::balls::BallResult| b.inner.force_n * b.inner.contact_angle_rad.sin();
            let sum: f64 = solution.balls.iter().map(axial).sum();
            record.near("sum of the axial ball forces, N,", sum, 1e6, 1e-8);
            let angle = solution.balls[0].inner.contact_angle_rad.to_degrees();
            record.note(format!("1 MN: contact angle {angle:.1} deg"));
        }
        Err(error) => record.says(&error.to_string(), "leaves the"),
    }
}

fn mirrored(record: &mut Record) {
    let mut model = rigid(Load::dead(0.0), Load::dead(1e3));
    model.geometry.outer_raceway_diameter += 0.173e-3;
    let mut solver = StaticSolver::new(&model).unwrap();
    let mut from = |z: f64| {
        let mut start = solver.solve(&model, None).unwrap();
        start.displacements.shaft = [0.0, 0.0, z, 0.0, 0.0];
        solver.solve(&model, Some(&start)).unwrap()
    };
    let (up, down) = (from(0.3e-3), from(-0.3e-3));
    let middle = -model.geometry.axial_offset();
    record.note(format!(
        "z = {:.4} um from above and {:.4} um from below, the middle is {:.4} um: one equilibrium, since the energy \
         is convex",
        1e6 * up.displacements.shaft[2],
        1e6 * down.displacements.shaft[2],
        1e6 * middle
    ));
    record.near("z from above, m,", up.displacements.shaft[2], middle, 1e-6);
    record.near("z from below, m,", down.displacements.shaft[2], middle, 1e-6);
    let pairs = up.balls.iter().zip(&down.balls);
    let worst = pairs
        .map(|(a, b)| (a.inner.force_n - b.inner.force_n).abs())
        .fold(0.0, f64::max);
    record.below("difference of ball forces, N,", worst, 1e-4);
}

fn mirrored_thrust(record: &mut Record) {
    let [up, down] = [2e3, -2e3].map(|f| solve(&rigid(Load::dead(f), Load::dead(0.0))).unwrap());
    let pairs = || up.balls.iter().zip(&down.balls);
    let force = pairs()
        .map(|(a, b)| relative(a.inner.force_n, b.inner.force_n))
        .fold(0.0, f64::max);
    let angle = pairs()
        .map(|(a, b)| (a.inner.contact_angle_rad + b.inner.contact_angle_rad).abs())
        .fold(0.0, f64::max);
    record.below("difference of ball forces", force, 1e-9);
    record.below("sum of the contact angles, rad,", angle, 1e-9);
}

fn no_load(record: &mut Record) {
    record.says(
        &error_of(&rigid(Load::dead(0.0), Load::dead(0.0))),
        "of the shaft is free but nothing resists it",
    );
    record.says(
        &error_of(&flexible(Load::dead(0.0), Load::dead(0.0))),
        "of the shaft is free but nothing resists it",
    );
}

fn two_balls(record: &mut Record) {
    let mut model = rigid(Load::dead(1e3), Load::dead(0.0));
    model.geometry.n_balls = 2;
    // Balls along x: motion along y changes their distances in second order only.
    record.says(&error_of(&model), "y of the shaft is free but nothing resists it");
}

fn tilt_on_two_balls(record: &mut Record) {
    let mut model = Case {
        free_tilt: true,
        ..Case::axial(1e3)
    }
    .rigid();
    model.geometry.n_balls = 2;
    model.shaft[1] = ShaftDof::Prescribed(0.0);
    record.says(
        &error_of(&model),
        "tilt_x of the shaft is free but nothing resists it",
    );
}

fn not_held(record: &mut Record) {
    let mut model = flexible(Load::dead(2e3), Load::dead(0.0));
    model.contact.mode = ContactMode::Patch;
    model.rings[1] = Some(std::sync::Arc::new(ring(Side::Outer, SMALL, Hold::Free)));
    record.says(&error_of(&model), "the outer ring is not held");
}

fn singular_border(record: &mut Record) {
    let case = Case {
        free_tilt: true,
        ..Case::axial(2e3)
    };
    let mut model = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    model.geometry.n_balls = 2;
    // Under thrust two balls let the ring move across their line and tilt about it ever farther.
    record.says(&error_of(&model), "or a free direction is not held; lock it");
}

fn adrift(record: &mut Record) {
    let model = Case::axial(-10.0).rigid();
    let course = super::bearings::released(&model, super::bearings::conserving(1e-5), [0.0; 5], 1e-4);
    record.says(
        &course.error.unwrap_or_default(),
        "z of the shaft is free, but it has no mass and no ball touches it",
    );
}

fn impossible(record: &mut Record) {
    let mut model = rigid(Load::dead(2e3), Load::dead(0.0));
    model.geometry.outer_raceway_diameter += 2e-3;
    let error = model
        .geometry
        .validate()
        .err()
        .map_or(String::new(), |e| e.to_string());
    record.says(&error, "the balls touch no groove at any angle");
}
