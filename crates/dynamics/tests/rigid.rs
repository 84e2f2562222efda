//! Rigid rings: the Jones-Harris limit against closed forms and balance laws.

use contact::{BearingGeometry, SphereCompliance};
use dynamics::effects::Gravity;
use dynamics::{DynamicsError, Model, ShaftDof, StaticSolver};
use input::Schedule;

use crate::support::finite::{InnerContact, cross, on_tilts, rotation, times};
use crate::support::{Case, equilibrium, relative};

/// Wrong: the thrust equilibrium. Harris (4th ed.), eq. 7.30-7.33: F = Z K A^1.5 sin a (cos a0/cos a - 1)^1.5, with
/// the two contacts in series. Tolerance: both sides are solved to round-off.
#[test]
fn pure_thrust_has_harris_closed_form() {
    for axial in [10.0, 500.0, 2000.0, 10_000.0] {
        let model = Case::axial(axial).rigid();
        let solution = equilibrium(&model);
        let g = &model.geometry;
        let (ki, ko) = (model.hertz[0].stiffness, model.hertz[1].stiffness);
        let series = (ki.powf(-2.0 / 3.0) + ko.powf(-2.0 / 3.0)).powf(-1.5);
        let force = |a: f64| {
            let stretch = g.free_contact_angle().cos() / a.cos() - 1.0;
            g.n_balls as f64 * series * (g.groove_distance() * stretch).powf(1.5) * a.sin()
        };
        let (mut low, mut high) = (g.free_contact_angle(), 1.5);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if force(middle) < axial {
                low = middle
            } else {
                high = middle
            }
        }
        for ball in &solution.balls {
            assert!(
                relative(ball.inner.contact_angle_rad, low) < 1e-9,
                "{axial} N: {} {low}",
                ball.inner.contact_angle_rad
            );
            let expected = axial / (g.n_balls as f64 * low.sin());
            assert!(
                relative(ball.inner.force_n, expected) < 1e-9,
                "{} {expected}",
                ball.inner.force_n
            );
            assert!(relative(ball.inner.force_n, ball.outer.force_n) < 1e-11);
        }
        let expected = g.groove_distance() * g.free_contact_angle().cos() * low.tan() - g.axial_offset();
        assert!(relative(solution.displacements.shaft[2], expected) < 1e-9);
    }
}

/// Wrong: what a ball yields as a sphere would come in with a wrong sign, or the other contact's share not at all.
/// Thrust: both contacts carry Q, each is (Q/K)^(2/3) - own Q + across Q nearer, and together they take up the stretch.
/// Solid balls are stiffer than half-spaces, those with a cavity of half their diameter softer.
#[test]
fn thrust_on_spheres_has_its_closed_form() {
    for (cavity, expected) in [(0.0, 0.005..0.02), (4.5e-3, -0.05..-0.01)] {
        let mut model = Case::axial(2000.0).spheres();
        let (elastic, diameter) = (
            dynamics::model::elastic(&model.ball_material),
            model.geometry.ball_diameter,
        );
        model.sphere = SphereCompliance::of_shell(elastic, diameter, cavity, &model.hertz);
        let stiffer = check_thrust_on_spheres(&model);
        assert!(expected.contains(&stiffer), "{cavity}: {stiffer}");
    }
}

/// By how much less the shaft moves than on half-spaces.
fn check_thrust_on_spheres(model: &Model) -> f64 {
    let solution = equilibrium(model);
    let (g, sphere) = (&model.geometry, model.sphere);
    let free = g.free_contact_angle();
    let yields = |q: f64| {
        let hertz: f64 = model
            .hertz
            .iter()
            .map(|h| (q / h.stiffness).powf(2.0 / 3.0))
            .sum();
        hertz + (2.0 * sphere.across.opposite() - sphere.own[0] - sphere.own[1]) * q
    };
    let (mut low, mut high) = (free, 1.0);
    for _ in 0..100 {
        let middle: f64 = 0.5 * (low + high);
        let stretch = g.groove_distance() * (free.cos() / middle.cos() - 1.0);
        let q = 2000.0 / (g.n_balls as f64 * middle.sin());
        if yields(q) > stretch {
            low = middle
        } else {
            high = middle
        }
    }
    let q = 2000.0 / (g.n_balls as f64 * low.sin());
    for ball in &solution.balls {
        for contact in [&ball.inner, &ball.outer] {
            assert!(relative(contact.force_n, q) < 1e-9, "{} {q}", contact.force_n);
            assert!(relative(contact.contact_angle_rad, low) < 1e-9);
        }
    }
    assert!(
        solution.work_defect.abs() < 1e-9 * solution.hertz_energy,
        "{}",
        solution.work_defect
    );
    let bare = equilibrium(&Case::axial(2000.0).rigid()).displacements.shaft[2];
    1.0 - solution.displacements.shaft[2] / bare
}

/// Wrong: forces and moments on the shaft would not balance, or would not be the scene's. From 3 kN radial on half the
/// balls unload. 1e-9 of the load, as the issue asks; also from a moment and a load point off the plane.
#[test]
fn forces_and_moments_balance() {
    for (axial, radial, moment, free_tilt) in [
        (2000.0, 1000.0, 0.0, true),
        (2000.0, 3000.0, 0.0, false),
        (100.0, 3000.0, 1.0, false),
        (500.0, 200.0, 4.0, true),
    ] {
        let mut case = Case::axial(axial);
        (case.radial, case.moment, case.load_point, case.free_tilt) = (radial, moment, 1e-3, free_tilt);
        let model = case.rigid();
        let solution = equilibrium(&model);
        let [.., tilt_x, tilt_y] = solution.displacements.shaft;
        let lever = times(&rotation([tilt_x, tilt_y]), [0.0, 0.0, 1e-3]);
        let mut force = [radial, 0.0, axial];
        let mut total = cross(lever, force);
        total[0] += moment;
        for (ball, b) in solution.balls.iter().enumerate() {
            // The ball presses the inner ring along the normal at the centre of its groove.
            let at = InnerContact::new(&model, &solution, ball);
            let arm = cross(at.centre, at.normal);
            for i in 0..3 {
                force[i] += b.inner.force_n * at.normal[i];
                total[i] += b.inner.force_n * arm[i];
            }
        }
        let sum = [force.as_slice(), &on_tilts([tilt_x, tilt_y], total)].concat();
        let free = if free_tilt { 5 } else { 3 };
        for (i, s) in sum.iter().enumerate() {
            let rest = s + solution.shaft_reaction[i];
            assert!(rest.abs() < 1e-9 * axial.max(radial), "{i}: {rest}");
            assert!(
                i >= free || solution.shaft_reaction[i] == 0.0,
                "a free dof has no reaction"
            );
        }
    }
}

/// Wrong: at large tilts forces and moments would be those of small ones. A bearing that is held tilted by 3 deg, whose
/// reactions hold what balls press on the ring in space. 1e-9 of the forces.
#[test]
fn a_bearing_tilted_by_three_degrees_balances_where_it_stands() {
    for projects in [false, true] {
        tilted_by_three_degrees(projects);
    }
}

fn tilted_by_three_degrees(projects: bool) {
    let mut model = Case::axial(2000.0).rigid();
    model.contact.projects_grooves = projects;
    let tilt: [f64; 2] = [0.03, 0.0428];
    (model.shaft[3], model.shaft[4]) = (ShaftDof::Prescribed(tilt[0]), ShaftDof::Prescribed(tilt[1]));
    let solution = equilibrium(&model);
    let (mut force, mut moment, mut largest) = ([0.0, 0.0, 2000.0], [0.0; 3], 0.0f64);
    for (ball, b) in solution.balls.iter().enumerate() {
        let at = InnerContact::new(&model, &solution, ball);
        let arm = cross(at.centre, at.normal);
        for i in 0..3 {
            force[i] += b.inner.force_n * at.normal[i];
            moment[i] += b.inner.force_n * arm[i];
        }
        largest = largest.max(b.inner.force_n);
    }
    assert!(largest > 2000.0, "{largest}");
    assert!(force.iter().all(|f| f.abs() < 1e-9 * largest), "{force:?}");
    for (i, m) in on_tilts(tilt, moment).into_iter().enumerate() {
        let reaction = solution.shaft_reaction[3 + i];
        assert!((reaction + m).abs() < 1e-9 * reaction.abs(), "{m} {reaction}");
    }
    assert!(
        solution.work_defect.abs() < 1e-9 * solution.hertz_energy,
        "{}",
        solution.work_defect
    );
}

/// Wrong: unloaded balls would carry force, break the search, or lie somewhere arbitrary.
#[test]
fn unloaded_balls_rest_midway() {
    let mut case = Case::axial(100.0);
    case.radial = 3000.0;
    let solution = equilibrium(&case.rigid());
    let unloaded: Vec<_> = solution.balls.iter().filter(|b| b.inner.force_n == 0.0).collect();
    assert!(
        (6..=12).contains(&unloaded.len()),
        "{} balls unload",
        unloaded.len()
    );
    for b in unloaded {
        assert!(b.outer.force_n == 0.0 && b.inner.approach_m < 0.0);
        assert!(
            (b.inner.approach_m - b.outer.approach_m).abs() < 1e-12,
            "equal gaps"
        );
    }
}

/// Wrong: balls that Newton leaves touching one raceway, with a force below its residual, would be reported off their
/// place and with contact angles of chance. A loose bearing under a radial load alone, its shaft free to find the
/// middle.
#[test]
fn balls_that_only_touch_are_unloaded() {
    for radial in [100.0, 1000.0, 10_000.0] {
        let mut case = Case::axial(0.0);
        case.radial = radial;
        let solution = equilibrium(&case.rigid());
        for b in &solution.balls {
            let (i, o) = (&b.inner, &b.outer);
            assert!(i.force_n == 0.0 || i.force_n > 1e-6 * radial, "{} N", i.force_n);
            assert!(
                i.force_n > 0.0 || (i.approach_m - o.approach_m).abs() < 1e-12,
                "unequal gaps"
            );
            // By symmetry all forces and gaps lie in the plane of the balls; Newton finds it to 1e-10 of the load.
            assert!(
                i.contact_angle_rad.sin().abs() < 1e-6,
                "{} rad",
                i.contact_angle_rad
            );
        }
    }
}

/// Wrong: gravity would press balls at its horizon, whose weight the cage carries, against one raceway by the
/// round-off of a cosine. Two balls of 18 lie there; a thousand earths' gravity unloads them.
#[test]
fn gravity_leaves_unloaded_balls_at_its_horizon_midway() {
    let mut model = Case::axial(500.0).rigid();
    let acceleration = [0.0, -9.81e4, 0.0];
    let gravity = Gravity::new(acceleration, Schedule::Constant, &model.rings).unwrap();
    model.effects.push(Box::new(gravity));
    let solution = equilibrium(&model);
    let horizon = [&solution.balls[0], &solution.balls[9]];
    for b in horizon {
        assert!(
            b.inner.force_n == 0.0 && b.outer.force_n == 0.0,
            "{}",
            b.inner.force_n
        );
        assert!((b.inner.approach_m - b.outer.approach_m).abs() < 1e-12 && b.inner.approach_m < 0.0);
    }
}

/// Wrong: a light load would be refused because round-off of positions moves forces by more than a share of it. The
/// closed form of light thrust is Q = F / (Z sin a0), up to the rise of the contact angle.
#[test]
fn light_loads_down_to_none_are_solved() {
    for axial in [1e-2, 1e-4, 1e-6] {
        let solution = equilibrium(&Case::axial(axial).rigid());
        let sine = BearingGeometry::reference_7010c().free_contact_angle().sin();
        for b in &solution.balls {
            assert!(
                relative(b.inner.force_n, axial / (18.0 * sine)) < 2e-3,
                "{}",
                b.inner.force_n
            );
        }
    }
    // A contact angle at which the just-touching position is not exact in binary.
    let mut model = Case::axial(0.0).rigid();
    for diameter in [74.06e-3, 74.1e-3, 74.15e-3, 74.2e-3, 74.3e-3] {
        model.geometry.outer_raceway_diameter = diameter;
        model.shaft = [ShaftDof::Prescribed(0.0); 5];
        let solution = equilibrium(&model);
        assert!(solution.balls.iter().all(|b| b.inner.force_n < 1e-12));
    }
}

/// Wrong: forces far beyond what steel carries would pass without a word.
#[test]
fn pressures_beyond_the_static_limit_are_warned_of() {
    let warnings = |axial| equilibrium(&Case::axial(axial).rigid()).warnings;
    assert!(warnings(10_000.0).is_empty());
    let heavy = warnings(200_000.0);
    assert_eq!(heavy.len(), 1);
    assert!(
        heavy[0].contains("raceway, is ") && heavy[0].contains("above the static limit"),
        "{}",
        heavy[0]
    );
}

/// Wrong: the solution would not respect the mirror symmetry of load and geometry. First ball at +5 and -5 deg.
#[test]
fn mirrored_azimuth_phases_agree() {
    let solve = |phase: f64| {
        let mut case = Case::axial(2000.0);
        (case.radial, case.phase, case.free_tilt) = (1000.0, phase, true);
        equilibrium(&case.rigid())
    };
    let (plus, minus) = (solve(5f64.to_radians()), solve(-5f64.to_radians()));
    for k in 0..18 {
        let (p, m) = (&plus.balls[k], &minus.balls[(18 - k) % 18]);
        assert!(
            relative(p.inner.force_n, m.inner.force_n) < 1e-10,
            "{} {}",
            p.inner.force_n,
            m.inner.force_n
        );
    }
    let (p, m) = (plus.displacements.shaft, minus.displacements.shaft);
    for (i, sign) in [(0, 1.0), (1, -1.0), (2, 1.0), (3, -1.0), (4, 1.0)] {
        assert!(
            (p[i] - sign * m[i]).abs() < 1e-9 * p[0].abs().max(p[2].abs()),
            "{i}: {} {}",
            p[i],
            m[i]
        );
    }
}

/// Wrong: the answer would depend on the start. The energy is convex, so any start must lead to the same minimum.
#[test]
fn any_start_leads_to_the_same_equilibrium() {
    let mut case = Case::axial(2000.0);
    case.radial = 1000.0;
    let model = case.rigid();
    let mut solver = StaticSolver::new(&model).unwrap();
    let reference = solver.solve(&model, None).unwrap();
    let mut far = solver.solve(&model, None).unwrap();
    far.displacements.shaft = [1e-3, -1e-3, 0.5e-3, 1e-3, 0.0];
    far.displacements.shaft[4] = 0.0;
    far.displacements.shaft[3] = 0.0;
    far.displacements
        .balls
        .iter_mut()
        .for_each(|b| *b = [-5e-4, 7e-4].into());
    let found = solver.solve(&model, Some(&far)).unwrap();
    for (a, b) in reference.balls.iter().zip(&found.balls) {
        assert!(
            relative(a.inner.force_n, b.inner.force_n) < 1e-9,
            "{} {}",
            a.inner.force_n,
            b.inner.force_n
        );
    }
}

/// Wrong: a bearing without load would not be left in its just-touching position.
#[test]
fn no_load_moves_nothing() {
    let mut case = Case::axial(0.0);
    case.free_axial = false;
    let mut model = case.rigid();
    model.shaft = [ShaftDof::Prescribed(0.0); 5];
    let solution = equilibrium(&model);
    assert!(
        solution
            .balls
            .iter()
            .all(|b| b.inner.force_n < 1e-9 && b.displacement_m.axial.abs() < 1e-12)
    );
}

/// Wrong: a load that nothing balances would end in a number instead of an error that names the cause.
#[test]
fn loads_without_equilibrium_are_named() {
    let error = |model: &dynamics::Model| {
        StaticSolver::new(model)
            .unwrap()
            .solve(model, None)
            .err()
            .unwrap()
    };
    let crushed = error(&Case::axial(1e9).rigid()).to_string();
    assert!(
        crushed.contains("no equilibrium: z of the shaft runs beyond 4.500 mm"),
        "{crushed}"
    );
    let idle = error(&Case::axial(0.0).rigid());
    assert!(matches!(idle, DynamicsError::Unheld { .. }), "{idle}");
}

/// Wrong: a reversed thrust would not be caught by the opposite flanks of the (symmetric) grooves.
#[test]
fn reversed_thrust_mirrors_the_contact_angle() {
    let solve = |axial| equilibrium(&Case::axial(axial).rigid());
    let (plus, minus) = (solve(500.0), solve(-500.0));
    for (p, m) in plus.balls.iter().zip(&minus.balls) {
        assert!(relative(p.inner.force_n, m.inner.force_n) < 1e-10);
        assert!((p.outer.contact_angle_rad + m.outer.contact_angle_rad).abs() < 1e-10);
    }
}

/// Wrong: exact interference or a prescribed displacement would not load the balls as their closed form says.
#[test]
fn interference_loads_every_ball_alike() {
    let mut case = Case::axial(0.0);
    case.interference = 10e-6;
    let mut model = case.rigid();
    model.shaft = [ShaftDof::Prescribed(0.0); 5];
    let solution = equilibrium(&model);
    let (ki, ko) = (model.hertz[0].stiffness, model.hertz[1].stiffness);
    let series = (ki.powf(-2.0 / 3.0) + ko.powf(-2.0 / 3.0)).powf(-1.5);
    let expected = series * (0.5 * 10e-6f64).powf(1.5);
    for b in &solution.balls {
        assert!(
            relative(b.inner.force_n, expected) < 1e-9,
            "{} {expected}",
            b.inner.force_n
        );
    }
}
