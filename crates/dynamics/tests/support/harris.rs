//! Harris's equations of a fast bearing under thrust, solved without the program.

use dynamics::Model;
use dynamics::kinematics::BallSpeeds;

/// Harris's high-speed equations for one ball of a row under thrust, rigid rings: residuals over (ball radial, ball
/// axial, shaft axial), and [Q_i, Q_o, a_i, a_o]. Nothing of the program but the numbers of the bearing; friction
/// acts in the directions that the documentation of the effect derives.
fn harris(
    (model, ball_speeds): (&Model, BallSpeeds),
    thrust: f64,
    omega: f64,
    shares: [f64; 2],
    x: [f64; 3],
) -> ([f64; 3], [f64; 4]) {
    let g = &model.geometry;
    let (diameter, pitch) = (g.ball_diameter, g.pitch_diameter());
    let free = g.free_contact_angle();
    let arms = [
        g.inner_groove_radius - 0.5 * diameter,
        g.outer_groove_radius - 0.5 * diameter,
    ];
    // Legs of the triangles between groove centres and ball centre; the ball starts where it touches both.
    let outer = [arms[1] * free.cos() + x[0], arms[1] * free.sin() + x[1]];
    let inner = [arms[0] * free.cos() - x[0], arms[0] * free.sin() + x[2] - x[1]];
    let force = |leg: [f64; 2], arm: f64, k: f64| k * (leg[0].hypot(leg[1]) - arm).max(0.0).powf(1.5);
    let (q_i, q_o) = (
        force(inner, arms[0], model.hertz[0].stiffness),
        force(outer, arms[1], model.hertz[1].stiffness),
    );
    let (a_i, a_o) = (inner[1].atan2(inner[0]), outer[1].atan2(outer[0]));
    let gamma = diameter / pitch;
    let mass = std::f64::consts::PI / 6.0 * diameter.powi(3) * 7800.0;
    let pitch_angle = (a_o.sin() / (a_o.cos() + gamma)).atan();
    let [cage, spin] = match ball_speeds {
        BallSpeeds::FreeAngle => [
            0.5 * omega * (1.0 - gamma * free.cos()),
            0.5 * omega / gamma * (1.0 - (gamma * free.cos()).powi(2)),
        ],
        BallSpeeds::OuterControl => {
            let surface = |a: f64| a.cos() + pitch_angle.tan() * a.sin();
            let sum = surface(a_o) / (1.0 + gamma * a_o.cos()) + surface(a_i) / (1.0 - gamma * a_i.cos());
            [
                omega * (1.0 - gamma * a_i.cos()) / (1.0 + (a_i - a_o).cos()),
                omega / (sum * gamma * pitch_angle.cos()),
            ]
        }
    };
    let moment = mass * diameter * diameter / 10.0 * spin * cage * pitch_angle.sin();
    let t = shares.map(|share| share * moment / diameter);
    let centrifugal = mass * cage * cage * (0.5 * pitch + x[0]);
    (
        [
            q_i * a_i.cos() - q_o * a_o.cos() - t[0] * a_i.sin() + t[1] * a_o.sin() + centrifugal,
            q_i * a_i.sin() - q_o * a_o.sin() + t[0] * a_i.cos() - t[1] * a_o.cos(),
            thrust / g.n_balls as f64 - q_i * a_i.sin() - t[0] * a_i.cos(),
        ],
        [q_i, q_o, a_i, a_o],
    )
}

/// Their solution by Newton with difference quotients.
pub fn solve_harris(model: (&Model, BallSpeeds), thrust: f64, omega: f64, shares: [f64; 2]) -> [f64; 4] {
    let mut x = [2e-6, 10e-6, 25e-6];
    for _ in 0..100 {
        let (r, _) = harris(model, thrust, omega, shares, x);
        let h = 1e-11;
        let mut matrix = [[0.0; 4]; 3];
        for j in 0..3 {
            let (mut low, mut high) = (x, x);
            (low[j], high[j]) = (x[j] - h, x[j] + h);
            let (l, u) = (
                harris(model, thrust, omega, shares, low).0,
                harris(model, thrust, omega, shares, high).0,
            );
            (0..3).for_each(|i| matrix[i][j] = (u[i] - l[i]) / (2.0 * h));
        }
        (0..3).for_each(|i| matrix[i][3] = -r[i]);
        let step = eliminate(matrix);
        let longest = step.iter().fold(0.0f64, |m, s| m.max(s.abs()));
        let share = (3e-6 / longest).min(1.0);
        (0..3).for_each(|i| x[i] += share * step[i]);
    }
    let (r, found) = harris(model, thrust, omega, shares, x);
    assert!(
        r.iter().all(|r| r.abs() < 1e-8),
        "the reference did not converge: {r:?}"
    );
    found
}

/// Solution of three equations, right-hand side last, by Gauss with pivoting.
fn eliminate(mut m: [[f64; 4]; 3]) -> [f64; 3] {
    for i in 0..3 {
        let pivot = (i..3)
            .max_by(|a, b| m[*a][i].abs().total_cmp(&m[*b][i].abs()))
            .unwrap();
        m.swap(i, pivot);
        for row in 0..3 {
            if row != i {
                let share = m[row][i] / m[i][i];
                (0..4).for_each(|k| m[row][k] -= share * m[i][k]);
            }
        }
    }
    [0, 1, 2].map(|i| m[i][3] / m[i][i])
}
