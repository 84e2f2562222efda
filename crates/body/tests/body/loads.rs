//! Loads on all of a body: closed forms of a column, a beam and a disc, its matrices, and its oscillators.

use std::sync::Arc;

use body::{BesideRing, BodyLoad, SeatTie, SeatTraction};

use super::vibration::coarse;
use super::*;

/// Displacement of all nodes and motion of the seat under a load alone.
fn under(body: Surrounding, load: BodyLoad) -> [Vec<f64>; 2] {
    let tie = SeatTie::to_seat(Arc::new(body), 0);
    alone(&tie, load)
}

/// The same where a joint carries nothing.
fn alone(tie: &SeatTie, load: BodyLoad) -> [Vec<f64>; 2] {
    let free = vec![0.0; tie.own().len()];
    let acting = BesideRing {
        load: Some(load),
        ..BesideRing::default()
    };
    let nothing = SeatTraction {
        forces: free.clone(),
        motion: free,
    };
    [
        tie.displacement(&nothing, acting).unwrap(),
        tie.moved_by(acting).unwrap(),
    ]
}

fn weight(acceleration: [f64; 3]) -> BodyLoad {
    BodyLoad {
        acceleration,
        ..BodyLoad::default()
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&off) / largest(b)
}

/// Wrong: a body would not feel its weight, or feel another. A column on its face, Poisson's ratio 0, sinks by
/// rho g (L s - s^2 / 2) / E at the height s, which elements of 20 nodes have exactly.
#[test]
fn a_column_sinks_under_its_weight() {
    let length = 0.1;
    let mesh = beam(length, 4);
    let nodes: Vec<[f64; 3]> = mesh.nodes.to_vec();
    let body = made(mesh, material(0.0), "face", basis(2, 1)).unwrap();
    let [field, seat] = under(body.with_loads(None).unwrap(), weight([0.0, 0.0, -9.81]));
    let sunk = |s: f64| -7800.0 * 9.81 * (length * s - 0.5 * s * s) / 200e9;
    let sinks = |[_, _, z]: &[f64; 3]| [0.0, 0.0, sunk(z - 0.5 * WIDTH + length)];
    let expected: Vec<f64> = nodes.iter().flat_map(sinks).collect();
    let error = off(&field, &expected);
    println!("column: {error:e}");
    assert!(error < 1e-6, "{error:e}");
    let middle = sunk(length - 0.5 * WIDTH);
    assert!((seat[2] / middle - 1.0).abs() < 5e-3, "{} {middle}", seat[2]);
}

/// A tube from its `face` over a length, with the seat inside at its end.
fn beam(length: f64, rows: usize) -> Mesh {
    let mut points = Vec::new();
    let long = length - WIDTH;
    let at: Vec<f64> = (0..=rows)
        .map(|j| -0.5 * WIDTH - long * (1.0 - j as f64 / rows as f64))
        .chain([0.0, 0.5 * WIDTH])
        .collect();
    for z in &at {
        points.extend([[INNER, *z], [OUTER, *z]]);
    }
    let quads = (0..at.len() - 1).map(|j| [2 * j, 2 * j + 1, 2 * j + 3, 2 * j + 2]);
    let seat = (rows..rows + 2).map(|j| [2 * j, 2 * j + 2]).collect();
    let groups = BTreeMap::from([("seat_a".to_string(), seat), ("face".to_string(), vec![[0, 1]])]);
    let section = Section::new(points, quads.collect(), &groups).unwrap();
    revolve(&section, 32, ElementKind::Hex20, &[]).unwrap()
}

/// Wrong: a body would sag more or less than a beam. A tube held at one end, across gravity: Timoshenko's beam with
/// Cowper's coefficient of a hollow circle (J. Appl. Mech. 33 (1966) 335), at the nodes of the seat.
#[test]
fn a_beam_sags_under_its_weight() {
    let length = 0.8;
    let mesh = beam(length, 40);
    let places: Vec<[f64; 3]> = mesh.nodes.to_vec();
    let seat = mesh.group_nodes("seat_a");
    let body = made(mesh, material(0.0), "face", basis(2, 1)).unwrap();
    let [field, _] = under(body.with_loads(None).unwrap(), weight([0.0, -9.81, 0.0]));
    let area = PI * (OUTER * OUTER - INNER * INNER);
    let inertia = 0.25 * PI * (OUTER.powi(4) - INNER.powi(4));
    let m2 = (INNER / OUTER).powi(2);
    let kappa = 6.0 * (1.0 + m2).powi(2) / (7.0 * (1.0 + m2).powi(2) + 20.0 * m2);
    let q = 7800.0 * 9.81 * area;
    let (bending, shear) = (200e9 * inertia, kappa * 100e9 * area);
    let sag = |z: f64| {
        let s = z - 0.5 * WIDTH + length;
        q / bending * (length * length * s * s / 4.0 - length * s.powi(3) / 6.0 + s.powi(4) / 24.0)
            + q / shear * (length * s - 0.5 * s * s)
    };
    let n = seat.len() as f64;
    let found = -seat.iter().map(|&node| field[3 * node + 1]).sum::<f64>() / n;
    let expected = seat.iter().map(|&node| sag(places[node][2])).sum::<f64>() / n;
    let tip = q * length.powi(4) / (8.0 * bending);
    println!("beam: {found:e} m, {expected:e} m; Euler's tip {tip:e} m");
    assert!((found / expected - 1.0).abs() < 3e-3, "{found:e} {expected:e}");
    assert!(
        (tip / expected - 1.0).abs() > 5e-3,
        "the shear is seen: {tip:e} {expected:e}"
    );
}

/// A disc that turns, held outside, Poisson's ratio 0, with so many layers: the largest errors of the radial
/// displacement under the centrifugal force and the tangential one under the Euler force at the seat. Both are
/// A r + B / r and a term r^3 (Timoshenko and Goodier, Theory of Elasticity, 3rd ed., art. 32).
fn disc(layers: usize) -> [f64; 2] {
    let mesh = tube(ElementKind::Hex20, 64, [layers, 1]);
    let places: Vec<[f64; 3]> = mesh.nodes.to_vec();
    let seat = mesh.group_nodes("seat_a");
    let (a, b, e, rho) = (INNER, OUTER, 200e9, 7800.0);
    let moved = |load: BodyLoad| {
        let body = made(
            tube(ElementKind::Hex20, 64, [layers, 1]),
            material(0.0),
            "outside",
            basis(2, 1),
        );
        let body = body.unwrap().on_shaft(&[0.0]).unwrap().with_loads(None).unwrap();
        under(body, load).into_iter().next().unwrap()
    };
    // A in A r + B / r + C r^3 of what stands at b, and the value at a.
    let at_seat = |slope: f64, c: f64| a * (-slope / (b * b) - c * b * b) + slope / a + c * a.powi(3);
    let speed: f64 = 3000.0;
    let c = -rho * speed * speed / (8.0 * e);
    // No radial stress at a: A - B / a^2 + 3 C a^2 = 0, with A = -B / b^2 - C b^2.
    let slope = c * (3.0 * a * a - b * b) / (1.0 / (a * a) + 1.0 / (b * b));
    let radial = at_seat(slope, c);
    let rate = 1e6;
    let shear = 100e9;
    let of_euler = rho * rate / (8.0 * shear);
    // No shear at a: -2 B / a^2 + 2 C a^2 = 0.
    let tangential = at_seat(of_euler * a.powi(4), of_euler);
    let grown = moved(BodyLoad {
        speed,
        ..BodyLoad::default()
    });
    let turned = moved(BodyLoad {
        rate,
        ..BodyLoad::default()
    });
    let mut worst = [0.0f64; 2];
    for &node in &seat {
        let [x, y, _] = places[node];
        let (u, v) = (&grown[3 * node..3 * node + 3], &turned[3 * node..3 * node + 3]);
        worst[0] = worst[0].max(((x * u[0] + y * u[1]) / a / radial - 1.0).abs());
        worst[1] = worst[1].max(((x * v[1] - y * v[0]) / a / tangential - 1.0).abs());
    }
    worst
}

/// Wrong: a shaft would grow otherwise by its turning than a disc does.
#[test]
fn a_disc_that_turns_grows_as_its_closed_form() {
    let errors = [1, 2, 4].map(disc);
    println!("growth and twist: {errors:?}");
    assert!(errors[2].iter().all(|e| *e < 1e-4), "{errors:?}");
    assert!(errors[1][0] < 0.3 * errors[0][0], "{errors:?}");
}

/// Wrong: a housing of another program would have another weight than its mesh, or one without a mass would get one.
#[test]
fn a_body_of_its_matrices_sags_as_that_of_its_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    let mut files = write_matrix(dir.path(), &mesh, "outside");
    let load = weight([3.0, -9.81, 2.0]);
    let of_mesh = made(mesh, material(0.3), "outside", basis(3, 1)).unwrap();
    let expected = under(of_mesh.with_loads(None).unwrap(), load);
    let matrix = MatrixBody::read(&files).unwrap();
    let found = under(
        condensed(&matrix).unwrap().with_loads(Some(&matrix)).unwrap(),
        load,
    );
    for (found, expected) in found.iter().zip(&expected) {
        let error = off(found, expected);
        assert!(error < 1e-8, "{error:e}");
    }
    files.mass = None;
    let matrix = MatrixBody::read(&files).unwrap();
    let without = condensed(&matrix).unwrap().with_loads(Some(&matrix)).unwrap();
    assert!(without.loads.is_none());
}

/// Wrong: a body would sag otherwise in motion than at rest: its seat by what the modes leave out, its inside as
/// shown, or by the rigid motion of a shaft that carries it.
#[test]
fn oscillators_stand_under_a_load_as_the_body_at_rest() {
    let load = BodyLoad {
        acceleration: [3.0, -9.81, 2.0],
        speed: 5.0,
        rate: 4.0,
    };
    for is_carried in [false, true] {
        let body = coarse();
        let body = match is_carried {
            true => body.on_shaft(&[0.01]).unwrap(),
            false => body,
        };
        let body = Arc::new(body.with_loads(None).unwrap());
        let modes = Arc::new(body.modes(150e3).unwrap());
        let tie = SeatTie::to_seat(body.clone(), 0).in_motion(modes.clone());
        let at = tie.at_rest_under(Some(load));
        let [whole, expected] = alone(&tie, load);
        let seat = off(&modes.seat_motion(&at), &expected);
        let shown = off(&tie.moved(&at, Some(load)).unwrap(), &whole);
        let reduced = off(&tie.moved(&at, None).unwrap(), &whole);
        println!("seat {seat:e}, whole {shown:e}, by modes alone {reduced:e}");
        assert!(seat < 1e-7 && shown < 1e-7, "{seat:e} {shown:e}");
        assert!((1e-6..0.3).contains(&reduced), "{reduced:e}");
    }
}
