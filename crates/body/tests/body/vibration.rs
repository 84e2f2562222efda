//! Bodies in motion: the reduced body against the whole one.

use std::f64::consts::PI;
use std::sync::Arc;

use body::{SeatTie, Surrounding};
use fem::Material;
use mesh::{ElementKind, Mesh};

use super::matrices::{of_matrix, write_matrix};
use super::{INNER, OUTER, WIDTH, basis, made, material, tube};

/// A coarse tube of steel, held outside.
pub fn coarse() -> Surrounding {
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    made(mesh, material(0.3), "outside", basis(3, 1)).unwrap()
}

/// The whole body with all its dofs: no reduction.
struct Whole {
    stiffness: sprs::CsMat<f64>,
    mass: sprs::CsMat<f64>,
    factor: dense::DenseCholesky,
}

impl Whole {
    fn new(mesh: &Mesh, material: &Material, fixed: &str) -> Whole {
        let held = mesh.group_nodes(fixed);
        let free: Vec<usize> = (0..mesh.n_dofs())
            .filter(|dof| !held.contains(&(dof / 3)))
            .collect();
        let stiffness = solver::restrict(&fem::assemble_stiffness(mesh, material).unwrap(), &free);
        let mass = solver::restrict(&fem::assemble_mass(mesh, material).unwrap(), &free);
        let dense = stiffness.to_dense();
        let flat: Vec<f64> = dense.iter().copied().collect();
        Whole {
            factor: dense::DenseCholesky::factor(free.len(), &flat).unwrap(),
            stiffness,
            mass,
        }
    }
}

impl dense::EigenProblem for Whole {
    fn n(&self) -> usize {
        self.mass.rows()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn stiffness(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        solver::products(&self.stiffness, x, n_vectors)
    }

    fn mass(&self, x: &[f64], n_vectors: usize) -> Vec<f64> {
        solver::products(&self.mass, x, n_vectors)
    }

    fn solve(&self, mut b: Vec<f64>, n: usize) -> Vec<f64> {
        self.factor.solve(&mut b, n);
        b
    }
}

/// Wrong: a housing would vibrate at other frequencies than its mesh. Modes with held seats up to ever higher
/// frequencies bring those of the reduced body down to those of the whole one, of which none is below.
#[test]
fn the_reduced_body_has_the_frequencies_of_the_whole_one() {
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    let whole = Whole::new(&mesh, &material(0.3), "outside");
    let settings = dense::LanczosSettings::new(8, 4);
    let expected = dense::lowest_pairs(&whole, settings, &mut |_| ()).unwrap().values;
    let body = made(mesh, material(0.3), "outside", basis(2, 1)).unwrap();
    let mut errors = Vec::new();
    for below in [1e3, 150e3, 300e3] {
        let modes = body.modes(below).unwrap();
        assert_eq!(modes.n(), body.n_functions() + modes.n_fixed);
        let off = |(found, right): (&f64, &f64)| {
            assert!(
                found / right > 1.0 - 1e-9,
                "a reduced body is no softer: {found} {right}"
            );
            (found / right).sqrt() - 1.0
        };
        let off = modes.squares.iter().zip(&expected).map(off).fold(0.0, f64::max);
        errors.push(off);
    }
    assert!(
        errors[2] < 1e-3 && errors[1] <= errors[0] && errors[2] <= errors[1],
        "{errors:?}"
    );
}

/// Wrong: a load at rest would move the reduced body otherwise than the exact one.
#[test]
fn the_reduced_body_is_exact_at_rest() {
    let body = coarse();
    let modes = body.modes(150e3).unwrap();
    let n = body.n_functions();
    assert!(modes.n_fixed > 0);
    let forces: Vec<f64> = (0..n).map(|i| ((7 * i + 3) % 11) as f64 - 5.0).collect();
    let row = |row: &[f64]| row.iter().zip(&forces).map(|(a, b)| a * b).sum::<f64>();
    let at: Vec<f64> = modes.of_forces.chunks_exact(n).map(row).collect();
    let direct: Vec<f64> = body.flexibility.chunks_exact(n).map(row).collect();
    let by_squares: Vec<f64> = modes.seat.chunks_exact(n).map(row).collect();
    let by_squares: Vec<f64> = by_squares
        .iter()
        .zip(&modes.squares)
        .map(|(f, s)| f / s)
        .collect();
    let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let off = |a: &[f64], b: &[f64]| {
        let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        largest(&off) / largest(b)
    };
    for oscillators in [&at, &by_squares] {
        let rows = || oscillators.iter().zip(modes.seat.chunks_exact(n));
        let seat: Vec<f64> = (0..n).map(|f| rows().map(|(x, row)| x * row[f]).sum()).collect();
        let seat = off(&seat, &direct);
        let whole = off(&body.moved(&modes, oscillators), &body.displacement(&forces));
        assert!(seat < 1e-8 && whole < 1e-8, "{seat:e} {whole:e}");
    }
}

/// Wrong: the same body would vibrate otherwise by the way it comes in, or move without a mass.
#[test]
fn a_body_of_its_matrices_vibrates_as_that_of_its_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    let mut files = write_matrix(dir.path(), &mesh, "outside");
    let of_mesh = made(mesh, material(0.3), "outside", basis(3, 1))
        .unwrap()
        .modes(150e3)
        .unwrap();
    let modes = of_matrix(&files).unwrap().modes(150e3).unwrap();
    assert_eq!(modes.n_fixed, of_mesh.n_fixed);
    for (a, b) in modes.squares.iter().zip(&of_mesh.squares) {
        assert!((a / b - 1.0).abs() < 1e-7, "{a} {b}");
    }
    let mass = dir.path().join("M.mtx");
    let text = std::fs::read_to_string(&mass).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[3] = "1 1 -1e-9";
    std::fs::write(&mass, lines.join("\n")).unwrap();
    let said = of_matrix(&files).err().unwrap();
    assert!(said.contains("the mass of node 101 in x is"), "{said}");
    files.mass = None;
    let said = of_matrix(&files).unwrap().modes(150e3).unwrap_err().to_string();
    assert!(
        said.contains("has no mass, so it is solved at rest only"),
        "{said}"
    );
}

/// Wrong: a body on a shaft would have another inertia than its mesh, or stand elsewhere than where forces and the
/// shaft put it. A tube about z, seen from 30 mm off its middle: closed forms up to what chords take.
#[test]
fn a_body_on_a_shaft_has_its_inertia_and_moves_with_it() {
    let mesh = tube(ElementKind::Hex8, 96, [2, 2]);
    let nodes: Vec<[f64; 3]> = mesh.nodes.to_vec();
    let body = made(mesh, material(0.3), "outside", basis(3, 1)).unwrap();
    let from = -0.03;
    let body = body.on_shaft(&[from]).unwrap();
    let inertia = body.carried.as_ref().unwrap().inertia;
    let squares = OUTER * OUTER + INNER * INNER;
    let mass = 7800.0 * PI * (OUTER * OUTER - INNER * INNER) * WIDTH;
    let transverse = mass * (squares / 4.0 + WIDTH * WIDTH / 12.0 + from * from);
    for (found, expected) in [
        (inertia.mass, mass),
        (inertia.polar, 0.5 * mass * squares),
        (inertia.transverse, transverse),
        (inertia.first_moment, -from * mass),
    ] {
        assert!(
            (found / expected - 1.0).abs() < 2e-3,
            "{inertia:?} {mass} {transverse}"
        );
    }
    assert!(body.carried.as_ref().unwrap().asymmetry < 1e-12);
    let modes = Arc::new(body.modes(150e3).unwrap());
    let forces: Vec<f64> = (0..body.n_functions())
        .map(|i| ((7 * i + 3) % 11) as f64 - 5.0)
        .collect();
    let q = [2e-6, -1e-6, 3e-6, 4e-5, -2e-5];
    let mut expected = body.displacement(&forces);
    let body = Arc::new(body);
    let tie = SeatTie::to_seat(body.clone(), 0).in_motion(modes.clone());
    for ([x, y, z], u) in nodes.iter().zip(expected.chunks_exact_mut(3)) {
        let z = z - from;
        let moved = [q[0] + q[4] * z, q[1] - q[3] * z, q[2] + q[3] * y - q[4] * x];
        u.iter_mut().zip(moved).for_each(|(u, m)| *u += m);
    }
    let on_shaft = tie.modes.as_ref().unwrap().on_shaft.as_ref().unwrap();
    let mut at = modes.at_rest(&forces);
    on_shaft.add_motion(q, &mut at);
    let found = body.moved(&modes, &at);
    let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let off: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
    assert!(largest(&off) < 1e-9 * largest(&expected), "{:e}", largest(&off));
    let seat = body.seats[0].measure(&expected);
    let off: Vec<f64> = modes
        .seat_motion(&at)
        .iter()
        .zip(&seat)
        .map(|(a, b)| a - b)
        .collect();
    assert!(largest(&off) < 1e-9 * largest(&seat), "{:e}", largest(&off));
    assert!((0..5).all(|k| (on_shaft.motion(&at)[k] - q[k]).abs() < 1e-8 * q[k].abs()));
    // A rigid motion has the kinetic energy of the rigid body, and no other oscillator.
    let mut velocity = vec![0.0; modes.n()];
    on_shaft.add_motion(q, &mut velocity);
    let energy: f64 = velocity.iter().map(|v| v * v).sum();
    let rigid: f64 = {
        let [x, y, z, a, b] = q;
        let across = inertia.mass * (x * x + y * y + z * z) + inertia.transverse * (a * a + b * b);
        across + 2.0 * inertia.first_moment * (x * b - y * a)
    };
    assert!((energy / rigid - 1.0).abs() < 1e-9, "{energy} {rigid}");
}
