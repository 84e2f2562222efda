//! The stiffness of a bearing against closed forms and against differences of whole equilibria.

use dynamics::effects::{BallCentrifugal, GyroscopicMoment, MomentShares, RingDamping, SpringPreload};
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::{BallSpeeds, RingSpeeds, Speed};
use dynamics::stiffness::{N_SHAFT, ShaftMatrix, softest};
use dynamics::{
    ContactMode, DampingLaws, Hold, Linearisation, Model, ShaftDof, StaticSolution, StaticSolver,
};

use crate::support::rings::Level;
use crate::support::{Case, relative};

const SMALL: Level = Level::hex8(54, 6, 1, 2);

/// Stiffness about the equilibrium of a model, and the equilibrium.
fn linear(model: &Model) -> (Linearisation, StaticSolution) {
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve(model, None).unwrap();
    let found = Linearisation::new(model, &solver, &solution, DampingLaws::default()).unwrap();
    (found, solution)
}

/// Lengths by which entries are compared: tilts count by the radius of the inner groove.
fn scaled(model: &Model, matrix: &ShaftMatrix) -> ShaftMatrix {
    let arm = model.geometry.centre_radius(contact::Side::Inner);
    let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / arm };
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[i][j] * scale(i) * scale(j)))
}

/// Largest difference of scaled entries over the largest entry.
fn difference(model: &Model, a: &ShaftMatrix, b: &ShaftMatrix) -> f64 {
    let (a, b) = (scaled(model, a), scaled(model, b));
    let entries = a.as_flattened().iter().zip(b.as_flattened());
    let largest = a.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    entries.fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / largest
}

/// The same by reactions of equilibria with all dofs of the shaft prescribed, central differences with Richardson's
/// extrapolation; loads on the shaft that change with its tilt are in it.
fn by_reactions(mut model: Model, solution: &StaticSolution, step: f64) -> ShaftMatrix {
    let mut solver = StaticSolver::new(&model).unwrap();
    let q = solution.displacements.shaft;
    let arm = model.geometry.centre_radius(contact::Side::Inner);
    let mut matrix = [[0.0; N_SHAFT]; N_SHAFT];
    for j in 0..N_SHAFT {
        let h = if j < 3 { step } else { step / arm };
        let mut reaction = |shift: f64| {
            let mut at = q;
            at[j] += shift;
            model.shaft = at.map(ShaftDof::Prescribed);
            solver.solve(&model, Some(solution)).unwrap().shaft_reaction
        };
        let [a, b, c, d] = [-h, -2.0 * h, h, 2.0 * h].map(&mut reaction);
        for i in 0..N_SHAFT {
            matrix[i][j] = (8.0 * (c[i] - a[i]) - (d[i] - b[i])) / (12.0 * h);
        }
    }
    matrix
}

fn with_loads(found: &Linearisation) -> ShaftMatrix {
    let (stiffness, loads) = (found.stiffness().unwrap(), found.load_stiffness);
    std::array::from_fn(|i| std::array::from_fn(|j| stiffness[i][j] + loads[i][j]))
}

fn combined() -> Case {
    Case {
        radial: 1000.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    }
}

/// Wrong: a term of the tangent would be missing or have a wrong sign. Pure thrust, rigid rings: every ball is two
/// contacts in line, a spring of stiffness k along the line of the groove centres, of length s, and Q/s across.
#[test]
fn thrust_on_rigid_rings_has_its_closed_form() {
    for (axial, projects) in [200.0, 2000.0, 10_000.0]
        .into_iter()
        .flat_map(|n| [(n, false), (n, true)])
    {
        let mut model = Case::axial(axial).rigid();
        model.contact.projects_grooves = projects;
        let (found, solution) = linear(&model);
        let g = &model.geometry;
        let (z, lever) = (g.n_balls as f64, g.centre_radius(contact::Side::Inner));
        let ball = &solution.balls[0].inner;
        let (sin, cos) = ball.contact_angle_rad.sin_cos();
        let series: f64 = model.hertz.iter().map(|h| h.stiffness.powf(-2.0 / 3.0)).sum();
        let (q, k) = (ball.force_n, 1.5 * ball.force_n.cbrt() / series);
        let length = g.groove_distance() + q.powf(2.0 / 3.0) * series;
        let across = q / length;
        // A circle that moves across has points that move inwards, and one that tilts as well has others.
        let bent = if projects { 0.0 } else { q };
        let radial = k * cos * cos + across * sin * sin - bent * cos / lever;
        let axial = k * sin * sin + across * cos * cos;
        let coupling = (k - across) * sin * cos - bent * sin / lever;
        // A tilt of the circle of groove centres takes its points inwards, where the balls press them.
        let tilt = lever * (lever * axial - q * cos);
        let half = 0.5 * z;
        let mut expected = [[0.0; N_SHAFT]; N_SHAFT];
        for (i, stiffness) in [half * radial, half * radial, z * axial, half * tilt, half * tilt]
            .into_iter()
            .enumerate()
        {
            expected[i][i] = stiffness;
        }
        for (i, j, sign) in [(0, 4, -1.0), (1, 3, 1.0)] {
            expected[i][j] = sign * half * lever * coupling;
            expected[j][i] = expected[i][j];
        }
        let stiffness = found.stiffness().unwrap();
        let off = difference(&model, &expected, &stiffness);
        assert!(off < 1e-9, "{axial} N: {off}\n{expected:?}\n{stiffness:?}");
    }
}

/// Wrong: the tangent would not be the slope of the reactions. Rigid rings, balls as spheres, all dofs loaded, a load
/// point off the plane; some balls unloaded.
#[test]
fn reactions_of_rigid_rings_grow_by_the_stiffness() {
    for radial in [1000.0, 6000.0] {
        let mut case = Case {
            radial,
            moment: 3.0,
            load_point: 2e-3,
            ..combined()
        };
        case.free_tilt = radial < 2000.0;
        let model = case.spheres();
        let (found, solution) = linear(&model);
        let unloaded = solution.balls.iter().filter(|b| b.inner.force_n == 0.0).count();
        assert_eq!(unloaded > 0, radial > 2000.0, "{unloaded}");
        let expected = by_reactions(case.spheres(), &solution, 1e-8);
        let off = difference(&model, &expected, &with_loads(&found));
        assert!(
            off < 1e-7,
            "{radial}: {off}\n{expected:?}\n{:?}",
            with_loads(&found)
        );
        assert!(
            found.load_stiffness[3][3] != 0.0,
            "the load point is off the plane"
        );
    }
}

/// Wrong: loads that follow the contact angles would be taken as dead. A fast bearing: its matrix is not symmetric.
#[test]
fn loads_that_follow_the_contact_angles_are_in_it() {
    for ball_speeds in [BallSpeeds::FreeAngle, BallSpeeds::OuterControl] {
        let build = || {
            let mut model = combined().spheres();
            let speeds = RingSpeeds::from(Speed::constant(3000.0));
            model.effects.push(Box::new(BallCentrifugal {
                speeds: speeds.clone(),
                slip: [0.0; 2],
                ball_speeds,
            }));
            model.effects.push(Box::new(GyroscopicMoment {
                speeds,
                slip: [0.0; 2],
                shares: MomentShares {
                    inner: 0.5,
                    outer: 1.5,
                },
                ball_speeds,
            }));
            model.tolerances.force = 1e-13;
            model
        };
        let model = build();
        let (found, solution) = linear(&model);
        let expected = by_reactions(build(), &solution, 1e-8);
        let stiffness = with_loads(&found);
        let off = difference(&model, &expected, &stiffness);
        assert!(off < 1e-7, "{off}\n{expected:?}\n{stiffness:?}");
        let s = scaled(&model, &stiffness);
        let skew = (s[0][1] - s[1][0]).abs().max((s[2][4] - s[4][2]).abs());
        assert!(skew > 1e-6 * s[0][0], "{skew} of {}", s[0][0]);
    }
}

/// Wrong: a seat that slides would be taken as fixed. Its spring is in series with the bearing along z.
#[test]
fn a_sliding_seat_is_in_series() {
    let spring = 5e6;
    let build = |stiffness: f64| {
        let mut model = Case::axial(0.0).rigid();
        model.effects.push(Box::new(SpringPreload {
            seat: dynamics::interactions::seat_spring::Seat {
                mass: 0.0,
                force: 500.0,
                stiffness,
            },
        }));
        model.shaft[2] = ShaftDof::Prescribed(0.0);
        model
    };
    let model = build(spring);
    let (found, solution) = linear(&model);
    let fixed =
        Case::axial(solution.balls[0].inner.force_n * 18.0 * solution.balls[0].inner.contact_angle_rad.sin());
    let (bearing, _) = linear(&fixed.rigid());
    let (alone, both) = (bearing.stiffness().unwrap(), found.stiffness().unwrap());
    let series = 1.0 / (1.0 / alone[2][2] + 1.0 / spring);
    assert!(relative(both[2][2], series) < 1e-9, "{} {series}", both[2][2]);
    assert!(relative(both[0][0], alone[0][0]) < 1e-9);
}

/// Wrong: rings would not yield as they do in an equilibrium, whose patches move and grow with their contacts.
/// Differences of whole equilibria, held in both ways, on a coarse mesh and on a fine one, where patches count most.
#[test]
fn reactions_of_flexible_rings_grow_by_the_stiffness() {
    let fine = Level::hex8(108, 12, 3, 4);
    for (hold, level) in [
        (Hold::Clamped, SMALL),
        (Hold::MeanMotion, SMALL),
        (Hold::MeanMotion, fine),
    ] {
        let case = Case {
            load_point: 2e-3,
            ..combined()
        };
        let model = || case.flexible(ContactMode::Patch, level, hold);
        let (found, solution) = linear(&model());
        let expected = by_reactions(model(), &solution, 1e-7);
        let off = difference(&model(), &expected, &with_loads(&found));
        let (rigid, _) = linear(&case.spheres());
        let softer = difference(&model(), &rigid.stiffness().unwrap(), &found.stiffness().unwrap());
        eprintln!("{hold:?} {level:?}: {off:.2e}, flexible against rigid rings {softer:.2e}");
        assert!(off < 2e-5, "{off}\n{expected:?}\n{:?}", with_loads(&found));
        assert!(softer > 1e3 * off, "rings yield {softer}, of which {off} is off");
    }
}

/// Wrong: damping would not be what two contacts in series have. Thrust: the ball is held by both, so along the line of
/// the centres c k_o^2 + c k_i^2 over (k_i + k_o)^2.
#[test]
fn damping_of_contacts_under_thrust_has_its_closed_form() {
    let model = Case::axial(2000.0).rigid();
    let law = ContactDamping {
        coefficient: 50.0,
        full_approach: 1e-6,
    };
    let laws = DampingLaws {
        contacts: Some(law),
        rings: Some(RingDamping {
            mass: 0.0,
            stiffness: 1e-7,
        }),
    };
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let found = Linearisation::new(&model, &solver, &solution, laws).unwrap();
    let (_, damping) = found.of_shaft().unwrap();
    let ball = &solution.balls[0].inner;
    let tangent = model
        .hertz
        .each_ref()
        .map(|h| 1.5 * h.stiffness.powf(2.0 / 3.0) * ball.force_n.cbrt());
    let [inner, outer] = tangent;
    let sum = inner + outer;
    let along = 50.0 * (inner * inner + outer * outer) / (sum * sum);
    let (sin, cos) = ball.contact_angle_rad.sin_cos();
    let damping = damping.unwrap();
    assert!(
        relative(damping[2][2], 18.0 * along * sin * sin) < 1e-9,
        "{}",
        damping[2][2]
    );
    assert!(
        relative(damping[0][0], 9.0 * along * cos * cos) < 1e-9,
        "{}",
        damping[0][0]
    );
}

/// Wrong: damping in proportion to the stiffness of rings would not be in proportion to what they yield. Of rigid
/// contacts only the rings would yield; here their share of the compliance is small, and squared by the load path.
#[test]
fn damping_of_rings_is_what_they_lose() {
    let model = combined().flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    let rings = RingDamping {
        mass: 3.0,
        stiffness: 1e-6,
    };
    let laws = DampingLaws {
        contacts: None,
        rings: Some(rings),
    };
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let found = Linearisation::new(&model, &solver, &solution, laws).unwrap();
    assert!(found.leaves_out_mass_damping);
    let (_, damping) = found.of_shaft().unwrap();
    // Rings moved by a shaft that moves: twice the strain energy of the difference is d^T C d over the factor.
    let step = 1e-7;
    let mut moved = combined().flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    let mut at = solution.displacements.shaft;
    at[2] += step;
    moved.shaft = at.map(ShaftDof::Prescribed);
    let ended = solver.solve(&moved, Some(&solution)).unwrap();
    let mut energy = 0.0;
    for side in contact::Side::BOTH {
        let (a, b) = (
            solution.elastic[side.index()].as_ref().unwrap(),
            ended.elastic[side.index()].as_ref().unwrap(),
        );
        // Forces that hold the change, times the change: by the contact forces through the grooves.
        let change: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - a).collect();
        for (ball, foot) in solution.footprints(side).iter().enumerate() {
            let force = |s: &StaticSolution| {
                let c = s.balls[ball].contact(side);
                let sign = side.sign();
                let (sin, cos) = c.contact_angle_rad.sin_cos();
                [sign * c.force_n * cos, sign * c.force_n * sin]
            };
            let (f, g) = (force(&solution), force(&ended));
            let measured = foot.weights.measure(&change);
            energy += (g[0] - f[0]) * measured[0] + (g[1] - f[1]) * measured[1];
        }
    }
    let expected = rings.stiffness * energy / (step * step);
    let found = damping.unwrap()[2][2];
    assert!(relative(found, expected) < 5e-3, "{found} {expected}");
}

/// Wrong: facets, whose forces jump, would have a stiffness.
#[test]
fn facets_are_refused() {
    let model = Case::axial(2000.0).flexible(ContactMode::Facet, SMALL, Hold::Clamped);
    let mut solver = StaticSolver::new(&model).unwrap();
    let solution = solver.solve(&model, None).unwrap();
    let error = Linearisation::new(&model, &solver, &solution, DampingLaws::default())
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "a stiffness cannot be had with contact.mode = \"facet\", whose contacts jump from facet to facet; use \
         \"patch\""
    );
}

/// Wrong: an unstable direction would not be found, or lengths and angles be compared as they are.
#[test]
fn the_softest_motion_is_found_with_tilts_as_lengths() {
    let mut matrix = [[0.0; N_SHAFT]; N_SHAFT];
    for (i, k) in [3e8, 2e8, 1e8, 5e4, -2e4].into_iter().enumerate() {
        matrix[i][i] = k;
    }
    // A skew part has no energy.
    (matrix[0][1], matrix[1][0]) = (1e9, -1e9);
    let found = softest(&matrix, 0.01).unwrap();
    assert!(
        relative(found.lowest, -2e8) < 1e-12 && relative(found.largest, 5e8) < 1e-12,
        "{found:?}"
    );
    assert_eq!(found.dof, 4);
}
