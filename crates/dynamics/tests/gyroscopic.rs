//! Gyroscopic moment of the balls: signs from first principles, Harris's equations, balance of forces and moments.

use crate::support::finite::{InnerContact, cross};
use crate::support::harris::solve_harris;
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use contact::Side;
use dynamics::effects::{BallCentrifugal, GyroscopicMoment, MomentShares, Now};
use dynamics::kinematics::{BallSpeeds, Kinematics, Speed};
use dynamics::{ContactMode, Hold, Model, Pose, StaticSolution, StaticSolver};

/// 30 000 rpm, rad/s.
const FAST: f64 = 1000.0 * std::f64::consts::PI;
/// Outer raceway control.
const OUTER: [f64; 2] = [0.0, 2.0];
/// Both raceways alike.
const BOTH: [f64; 2] = [1.0, 1.0];

fn spinning(model: Model, omega: f64, shares: Option<[f64; 2]>) -> Model {
    spinning_by(BallSpeeds::FreeAngle, model, omega, shares)
}

fn spinning_by(ball_speeds: BallSpeeds, mut model: Model, omega: f64, shares: Option<[f64; 2]>) -> Model {
    let (speed, slip) = (Speed::constant(omega), [0.0; 2]);
    model.effects.push(Box::new(BallCentrifugal {
        speeds: speed.clone().into(),
        slip,
        ball_speeds,
    }));
    if let Some(shares) = shares {
        model.effects.push(Box::new(GyroscopicMoment {
            speeds: speed.into(),
            slip,
            shares: MomentShares {
                inner: shares[0],
                outer: shares[1],
            },
            ball_speeds,
        }));
    }
    model
}

/// Wrong: the moment would turn the balls the wrong way or have another size. Vectors in space: the ball's spin axis
/// lies in its meridian plane, it rolls on the inner raceway in the direction of the turning ring and does not pivot
/// on the outer one; friction must supply the rate of its angular momentum. Round-off.
#[test]
fn friction_supplies_the_rate_of_the_angular_momentum() {
    for (shares, omega) in [(OUTER, FAST), (BOTH, FAST), ([0.5, 1.5], -0.3 * FAST)] {
        let model = spinning(Case::axial(0.0).rigid(), omega, Some(shares));
        let g = &model.geometry;
        let angles: Vec<f64> = (0..2 * g.n_balls).map(|i| 0.1 + 0.013 * i as f64).collect();
        let now = Now {
            angles: Some(&angles),
            cage_angle: 0.2,
            ..Now::default()
        };
        let loads = model.loads(&now).unwrap();
        let kinematics = Kinematics::new(g, [0.0; 2]);
        for ball in 0..g.n_balls {
            let (sin_psi, cos_psi) = (g.azimuth(ball) + 0.2).sin_cos();
            let space = |v: [f64; 2]| [v[0] * cos_psi, v[0] * sin_psi, v[1]];
            // Spin relative to the cage. On the outer ring, which turns backwards seen from the cage, the ball rolls
            // and does not pivot: the ratio of both conditions, free of the speeds, gives the pitch angle by
            // bisection.
            let a = angles[2 * ball + 1];
            let spin_at = |b: f64| [b.sin(), -b.cos()].map(|x| x * kinematics.ball * omega);
            let gamma = g.ball_diameter / g.pitch_diameter();
            let pivot = |b: f64| (a - b).tan() - gamma * a.sin() / (1.0 + gamma * a.cos());
            let (mut low, mut high) = (0.0, a);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if pivot(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let spin = space(spin_at(low));
            let radius = 0.5 * g.ball_diameter;
            let normals = Side::BOTH.map(|side| {
                let (sin, cos) = angles[2 * ball + side.index()].sin_cos();
                space([side.sign() * cos, side.sign() * sin])
            });
            let drag = cross(spin, normals[0]);
            let along = drag[1] * cos_psi - drag[0] * sin_psi;
            assert!(
                along * omega > 0.0,
                "the inner raceway would drag the ball backwards"
            );
            let inertia = model.ball_mass() * g.ball_diameter * g.ball_diameter / 10.0;
            let rate = cross([0.0, 0.0, kinematics.cage * omega], spin.map(|x| inertia * x));
            let mut moment = [0.0; 3];
            for side in Side::BOTH {
                let on_ring = loads.contacts[2 * ball + side.index()];
                let on_ball = space(on_ring.map(|f| -f).to_array());
                let normal = normals[side.index()];
                let across: f64 = (0..3).map(|i| normal[i] * on_ball[i]).sum();
                assert!(across.abs() < 1e-14, "friction acts across the normal");
                let part = cross(normal.map(|n| radius * n), on_ball);
                (0..3).for_each(|i| moment[i] += part[i]);
            }
            for i in 0..3 {
                assert!(
                    (moment[i] - rate[i]).abs() < 1e-12 * 0.1,
                    "{ball} {i}: {} {}",
                    moment[i],
                    rate[i]
                );
            }
        }
    }
}

fn first_ball(solution: &StaticSolution) -> [f64; 4] {
    let b = &solution.balls[0];
    [
        b.inner.force_n,
        b.outer.force_n,
        b.inner.contact_angle_rad,
        b.outer.contact_angle_rad,
    ]
}

/// Wrong: contact forces and angles at speed. An independent solution of Harris's equations (Rolling Bearing
/// Analysis, 4th ed., chapter 9), whose Newton converges to 1e-8 N of 100 N; speeds of the free angle, and his of
/// outer raceway control.
#[test]
fn thrust_at_speed_has_harris_solution() {
    for (thrust, speeds) in [500.0, 2000.0, 10_000.0]
        .into_iter()
        .flat_map(|thrust| [BallSpeeds::FreeAngle, BallSpeeds::OuterControl].map(|speeds| (thrust, speeds)))
    {
        for (omega, shares) in [(FAST, OUTER), (FAST, BOTH), (0.5 * FAST, OUTER), (-FAST, OUTER)] {
            let model = spinning_by(speeds, Case::axial(thrust).rigid(), omega, Some(shares));
            let found = first_ball(&equilibrium(&model));
            let expected = solve_harris((&model, speeds), thrust, omega, shares);
            for (a, b) in found.iter().zip(&expected) {
                assert!(
                    relative(*a, *b) < 1e-8,
                    "{thrust} N, {omega} rad/s, {shares:?}, {speeds:?}: {found:?} {expected:?}"
                );
            }
        }
    }
}

/// Wrong: at equal contact angles outer raceway control would not be the rolling of the cage, or the slip would be
/// lost.
#[test]
fn outer_control_at_equal_angles_is_plain_rolling() {
    let model = Case::axial(0.0).rigid();
    let g = &model.geometry;
    let free = g.free_contact_angle();
    for slip in [[0.0; 2], [0.1, 0.0], [0.02, 0.3]] {
        let (plain, control) = (
            Kinematics::new(g, slip),
            Kinematics::outer_control(g, slip, [free; 2]),
        );
        assert!(relative(control.cage, plain.cage) < 1e-14, "{slip:?}");
        // The axis is not quite parallel to the contacts' line, so the ball turns a little faster.
        let tilt = free - dynamics::kinematics::pitch_angle(g, free);
        assert!(
            relative(control.ball * tilt.cos(), plain.ball) < 1e-14,
            "{slip:?}"
        );
    }
}

/// Wrong: nobody would be told that balls at other angles than the free one are faster than the cage is taken to be.
/// Where 1 % of a contact force hangs on it there is a warning, but not where the speeds follow the angles.
#[test]
fn speeds_of_another_angle_are_warned_of() {
    let warnings = |speeds, thrust, omega| {
        let model = spinning_by(speeds, Case::axial(thrust).rigid(), omega, None);
        equilibrium(&model).warnings.join("\n")
    };
    let fast = warnings(BallSpeeds::FreeAngle, 500.0, FAST);
    assert!(
        fast.contains("which would change its centrifugal force by +"),
        "{fast}"
    );
    assert_eq!(warnings(BallSpeeds::OuterControl, 500.0, FAST), "");
    assert_eq!(warnings(BallSpeeds::FreeAngle, 2000.0, 0.1 * FAST), "");
}

/// Wrong: the moment would act against the centrifugal force instead of with it. Under outer raceway control friction
/// on the outer raceway pushes the ball back along -z, so its contact angle falls; the inner forces stay those of the
/// thrust.
#[test]
fn outer_control_lowers_the_outer_contact_angle() {
    let without = first_ball(&equilibrium(&spinning(Case::axial(2000.0).rigid(), FAST, None)));
    let with = first_ball(&equilibrium(&spinning(
        Case::axial(2000.0).rigid(),
        FAST,
        Some(OUTER),
    )));
    let fall = (without[3] - with[3]).to_degrees();
    assert!((0.5..3.0).contains(&fall), "{fall} deg");
    assert!(with[0] * with[2].sin() > 0.0 && relative(with[0] * with[2].sin(), 2000.0 / 18.0) < 1e-9);
}

/// Wrong: balls that the centrifugal force has lifted off the inner raceway would not come to rest, or not where they
/// run: in the plane of their own circle, pressed outwards by m omega_c^2 r, without any moment.
#[test]
fn balls_off_the_inner_raceway_run_in_their_plane() {
    let case = Case {
        radial: 3000.0,
        ..Case::axial(300.0)
    };
    let model = spinning(case.rigid(), FAST, Some(OUTER));
    let solution = equilibrium(&model);
    let g = &model.geometry;
    let cage = Kinematics::new(g, [0.0; 2]).cage * FAST;
    let off: Vec<_> = solution.balls.iter().filter(|b| b.inner.force_n == 0.0).collect();
    assert!((4..14).contains(&off.len()), "{} balls", off.len());
    for b in off {
        let radius = g.ball_centre().radial + b.displacement_m.radial;
        let expected = model.ball_mass() * cage * cage * radius;
        // Loads settle to 1e-10 of the largest force, about 2 kN.
        assert!(
            (b.outer.force_n - expected).abs() < 1e-6,
            "{} {expected}",
            b.outer.force_n
        );
        assert!(
            b.outer.contact_angle_rad.abs() < 1e-8,
            "{}",
            b.outer.contact_angle_rad
        );
    }
}

/// Wrong: a bearing that does not turn would feel a moment, or a share of nothing would stop the iteration.
#[test]
fn without_speed_nothing_changes() {
    let at_rest = equilibrium(&Case::axial(2000.0).rigid());
    let with = equilibrium(&spinning(Case::axial(2000.0).rigid(), 0.0, Some(OUTER)));
    assert_eq!(first_ball(&at_rest), first_ball(&with));
}

/// Wrong: the shaft would not carry what balls rub onto the inner ring. Forces at the true contact points, by hand,
/// with the load: radial force, free tilt, so every ball has its own angles. 1e-9 of the load; moments times 30 mm.
#[test]
fn friction_of_the_balls_is_balanced_by_the_shaft() {
    let case = Case {
        radial: 800.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    };
    for shares in [OUTER, BOTH] {
        let model = spinning(case.rigid(), FAST, Some(shares));
        let solution = equilibrium(&model);
        let g = &model.geometry;
        let effect = GyroscopicMoment {
            speeds: Speed::constant(FAST).into(),
            slip: [0.0; 2],
            shares: MomentShares {
                inner: shares[0],
                outer: shares[1],
            },
            ball_speeds: BallSpeeds::FreeAngle,
        };
        let angles: Vec<f64> = (solution.balls.iter())
            .flat_map(|b| [b.inner.contact_angle_rad, b.outer.contact_angle_rad])
            .collect();
        let now = Now {
            angles: Some(&angles),
            ..Now::default()
        };
        let mut force = [800.0, 0.0, 2000.0];
        let mut moment = [0.0; 3];
        for (ball, b) in solution.balls.iter().enumerate() {
            let t = shares[0] * effect.moment(&model, &now, ball) / g.ball_diameter;
            let at = InnerContact::new(&model, &solution, ball);
            // Both forces act through the groove centre. That friction is at the contact, a groove radius inwards, is a
            // couple about e_psi, as the gyroscopic moment is.
            let (normal, friction) = (at.normal.map(|n| b.inner.force_n * n), at.along.map(|e| t * e));
            let parts = [cross(at.centre, normal), cross(at.centre, friction)];
            for i in 0..3 {
                force[i] += normal[i] + friction[i];
                moment[i] += parts[0][i] + parts[1][i] - g.inner_groove_radius * t * at.beside[i];
            }
        }
        assert!(force.iter().all(|f| f.abs() < 2e-6), "{shares:?} {force:?}");
        assert!(
            moment[..2].iter().all(|m| m.abs() < 6e-8),
            "{shares:?} {moment:?}"
        );
    }
}

/// Wrong: the moment would not go round with the balls. Half a ball spacing on, the equilibrium is that of a bearing
/// whose first ball is there; a radial force makes balls differ.
#[test]
fn the_moment_goes_round_with_the_cage() {
    let case = Case {
        radial: 800.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    };
    let model = spinning(case.rigid(), FAST, Some(BOTH));
    let mut pose = Pose::default();
    pose.now.cage_angle = std::f64::consts::PI / 18.0;
    let turned = StaticSolver::new(&model)
        .unwrap()
        .solve_at(&model, &pose, None)
        .unwrap();
    let phase = pose.now.cage_angle;
    let there = equilibrium(&spinning(Case { phase, ..case }.rigid(), FAST, Some(BOTH)));
    for (a, b) in turned.balls.iter().zip(&there.balls) {
        assert!(relative(a.outer.force_n, b.outer.force_n) < 1e-9);
        assert!((a.outer.contact_angle_rad - b.outer.contact_angle_rad).abs() < 1e-9);
    }
}

/// Wrong: on flexible rings the contact loads would miss the ring, the work or the stopping rule. Virtual work of all
/// forces closes; rounds started from the solution have nothing to do; the angles are near those of rigid rings.
#[test]
fn flexible_rings_settle_with_the_moment() {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    for shares in [OUTER, BOTH] {
        let flexible = case.flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::Clamped);
        let model = spinning(flexible, FAST, Some(shares));
        let mut solver = StaticSolver::new(&model).unwrap();
        let solution = solver.solve(&model, None).unwrap();
        let scale = solution.load_work.abs();
        assert!(
            solution.work_defect.abs() < 1e-9 * scale,
            "{} {scale}",
            solution.work_defect
        );
        assert!(
            solution.shaft_residual.iter().all(|r| r.abs() < 1e-6),
            "{:?}",
            solution.shaft_residual
        );
        let again = solver.solve(&model, Some(&solution)).unwrap();
        let rigid = equilibrium(&spinning(case.rigid(), FAST, Some(shares)));
        for ((a, b), r) in solution.balls.iter().zip(&again.balls).zip(&rigid.balls) {
            assert!(relative(a.outer.force_n, b.outer.force_n) < 1e-8);
            assert!((a.outer.contact_angle_rad - b.outer.contact_angle_rad).abs() < 1e-8);
            let off = (a.outer.contact_angle_rad - r.outer.contact_angle_rad).to_degrees();
            assert!(off.abs() < 0.6, "{off} deg");
        }
    }
}
