//! Writes a small result with invented fields, to try viewers and scripts on: two grooved rings of quadratic
//! hexahedra, 18 balls that travel one ball spacing in six steps, a stress that decays around each contact.
//!
//! Usage: `cargo run --release -p raceway-checkpoint --example synthetic_rings -- FOLDER`

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

use checkpoint::{Body, CellFields, Output, PointFields, StateArray, StepRecord, Storage, point_ranges};
use mesh::{ElementKind, Mesh};

/// Pitch radius, ball radius and half width of the rings, m.
const PITCH_RADIUS: f64 = 32.5e-3;
const BALL_RADIUS: f64 = 4.75e-3;
const HALF_WIDTH: f64 = 8e-3;
const N_BALLS: usize = 18;
const N_STEPS: u64 = 6;
/// Elements over the thickness, over the width and around a ring.
const ELEMENTS: [usize; 3] = [3, 8, 90];
/// The corners, then the mid-nodes, of a hexahedron on a lattice of half elements.
const HEX20_LATTICE: [[usize; 3]; 20] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2],
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2],
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1],
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: synthetic_rings FOLDER")?;
    let outer = ring(|z| (PITCH_RADIUS + groove(z), 40e-3));
    let inner = ring(|z| (25e-3, PITCH_RADIUS - groove(z)));
    let bodies = [
        Body::from_mesh("outer_ring", 0, &outer, [0.0; 3]),
        Body::from_mesh("inner_ring", 1, &inner, [0.0, 0.0, 0.1e-3]),
        Body::balls("balls", 2, &centres(0.0), BALL_RADIUS),
    ];
    let mut output = Output::create(Path::new(&folder), &bodies, Storage::default())?;
    for step in 0..N_STEPS {
        output.write_step(&record(step, &bodies))?;
    }
    output.finish()?;
    println!(
        "{} points, {N_STEPS} steps in {folder}",
        point_ranges(&bodies)[2].end
    );
    Ok(())
}

/// Distance of a raceway from the pitch circle at the axial position `z`, m: a circle of the ball's radius,
/// with shoulders where it ends.
fn groove(z: f64) -> f64 {
    (BALL_RADIUS.powi(2) - z * z)
        .max((0.45 * BALL_RADIUS).powi(2))
        .sqrt()
}

/// A ring of hex20 elements between the radii `bounds(z)`, m.
fn ring(bounds: impl Fn(f64) -> (f64, f64)) -> Mesh {
    let [n_r, n_z, n_theta] = ELEMENTS;
    let mut node_of = BTreeMap::new();
    let mut mesh = Mesh {
        kind: ElementKind::Hex20,
        nodes: Default::default(),
        connectivity: Vec::new(),
        groups: BTreeMap::new(),
    };
    for (e_theta, e_z, e_r) in
        (0..n_theta).flat_map(|t| (0..n_z).flat_map(move |z| (0..n_r).map(move |r| (t, z, r))))
    {
        for [a, b, c] in HEX20_LATTICE {
            let key = (2 * e_r + a, (2 * e_theta + b) % (2 * n_theta), 2 * e_z + c);
            let node = *node_of.entry(key).or_insert_with(|| {
                let z = HALF_WIDTH * (key.2 as f64 / n_z as f64 - 1.0);
                let (r_0, r_1) = bounds(z);
                let r = r_0 + (r_1 - r_0) * key.0 as f64 / (2 * n_r) as f64;
                let theta = TAU * key.1 as f64 / (2 * n_theta) as f64;
                mesh.nodes.push([r * theta.cos(), r * theta.sin(), z]);
                mesh.nodes.len() - 1
            });
            mesh.connectivity.push(node);
        }
    }
    mesh
}

/// Centres of the balls, m, with the cage turned by `angle`, rad.
fn centres(angle: f64) -> Vec<[f64; 3]> {
    let centre = |ball: usize| {
        let theta = angle + TAU * ball as f64 / N_BALLS as f64;
        [PITCH_RADIUS * theta.cos(), PITCH_RADIUS * theta.sin(), 0.0]
    };
    (0..N_BALLS).map(centre).collect()
}

/// Invented fields: an oval outer ring, uniaxial radial stress around the balls, larger on the side of +x.
fn record(step: u64, bodies: &[Body]) -> StepRecord {
    let angle = TAU / N_BALLS as f64 * step as f64 / N_STEPS as f64;
    let now = centres(angle);
    let mut points = PointFields::default();
    let (mut stress, mut von_mises) = (Vec::new(), Vec::new());
    let (mut force_inner, mut force_outer) = (Vec::new(), Vec::new());
    for x in bodies[..2].iter().flat_map(|body| &body.points) {
        let r = x[0].hypot(x[1]);
        let (c, s) = (x[0] / r, x[1] / r);
        let oval = 2e-6 * (2.0 * s.atan2(c)).cos();
        points.displacement.push([oval * c, oval * s, 0.0]);
        let value: f64 = now
            .iter()
            .map(|&ball| 1.2e9 * load(ball) * decay(*x, ball))
            .sum::<f64>()
            + 2e7;
        stress.push([-value * c * c, -value * s * s, 0.0, -value * c * s, 0.0, 0.0]);
        von_mises.push(value);
        force_inner.push([0.0; 3]);
        force_outer.push([0.0; 3]);
    }
    for (ball, start) in now.iter().zip(&bodies[2].points) {
        let (c, s, force) = (
            ball[0] / PITCH_RADIUS,
            ball[1] / PITCH_RADIUS,
            400.0 * load(*ball),
        );
        points.displacement.push([0, 1, 2].map(|i| ball[i] - start[i]));
        stress.push([0.0; 6]);
        von_mises.push(0.0);
        force_inner.push([force * c, force * s, 0.0]);
        force_outer.push([-force * c, -force * s, 0.0]);
    }
    points.stress = Some(stress);
    points.von_mises = Some(von_mises);
    points.force_inner = Some(force_inner);
    points.force_outer = Some(force_outer);
    let state = BTreeMap::from([("cage_angle".to_string(), StateArray::Real(vec![angle]))]);
    StepRecord {
        step,
        time: 1.25e-5 * step as f64,
        points,
        cells: CellFields::default(),
        scene: "# invented\n".to_string(),
        state,
        tables: None,
    }
}

/// Share of the load a ball at this place carries.
fn load(ball: [f64; 3]) -> f64 {
    0.55 + 0.45 * ball[0] / PITCH_RADIUS
}

/// Decay of stress with the distance from the surface of a ball.
fn decay(x: [f64; 3], ball: [f64; 3]) -> f64 {
    let d: f64 = [0, 1, 2]
        .map(|i| (x[i] - ball[i]).powi(2))
        .iter()
        .sum::<f64>()
        .sqrt()
        - BALL_RADIUS;
    (-(d / 0.7e-3).powi(2)).exp() * (-(x[2] / 1.5e-3).powi(2)).exp()
}
