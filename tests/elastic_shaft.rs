//! Inner rings on elastic shafts through the whole program: files, balance, bits, refusals.

use std::collections::BTreeSet;

use checkpoint::{read_mesh, read_step, step_file_name};
use mesh::{MshFormat, Overwrite, read_body_msh, write_msh};

use crate::housing::assert_moves_and_goes_on;
use crate::shared_housing::{in_motion, without_analysis};
use crate::util::Dir;
use crate::util::delivered::{coarse, delivered};
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::{Table, number, summary};

const SCENE: &str = "scenes/7010c_hollow_spindle.toml";
/// Few functions: these tests ask for no accuracy.
const FEW: [&str; 8] = [
    "--set",
    "body.0.seat.0.harmonics=3",
    "--set",
    "body.0.seat.1.harmonics=3",
    "--set",
    "body.0.seat.0.across=1",
    "--set",
    "body.0.seat.1.across=1",
];

/// Values of a column of `bearings.csv`.
fn of_bearings(dir: &Dir, out: &str, name: &str) -> Vec<f64> {
    let table = dir.text(&format!("{out}/bearings.csv"));
    let mut lines = table.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name);
    lines
        .map(|row| row.split(',').nth(at.unwrap()).unwrap().parse().unwrap())
        .collect()
}

/// If this failed, a spindle of finite elements would not carry its load or its own weight, each bearing would show the
/// whole of it, or a user would not find the seats.
#[test]
fn a_spindle_of_finite_elements_carries_its_loads_and_its_weight() {
    let dir = coarse(&[SCENE]);
    let run = dir.raceway(&[&["run", SCENE, "--out", "found"][..], &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let sum = |name: &str| of_bearings(&dir, "found", name).iter().sum::<f64>();
    assert!((sum("force_x_n") + 300.0).abs() < 1e-6, "{}", sum("force_x_n"));
    let (body, _) = read_body_msh(dir.path("meshes/hollow_spindle.msh"), 1e-3).unwrap();
    let weight = 9.81 * (1.2 + 7800.0 * mesh::volume(&body));
    assert!(
        (sum("force_y_n") - weight).abs() < 1e-6 * weight,
        "{} {weight}",
        sum("force_y_n")
    );
    let has_body = |name: &str| {
        read_mesh(&dir.path(&format!("found/{name}")))
            .unwrap()
            .body
            .contains(&4)
    };
    assert!(has_body("front") && !has_body("rear"));
    for name in ["front", "rear"] {
        let own = summary(&dir, &format!("found/{name}"));
        assert!(number(&own, "/seat_inner/body_energy_j") > 0.0);
        assert!(dir.path(&format!("found/{name}/seat_inner.csv")).exists());
    }
    let beside =
        of_bearings(&dir, "found", "x_m")[0] - Table::read(&dir, "found/front/shaft.csv").column("x_m")[0];
    let [mean, _] = mean_of_seat(&dir);
    assert!(
        mean.abs() > 1e-8 && (beside / mean - 1.0).abs() < 0.05,
        "{beside:e} {mean:e}"
    );
    let line = Table::read(&dir, "found/shaft.csv");
    assert_eq!(line.column("x_m")[0], of_bearings(&dir, "found", "x_m")[0]);
    let plot = dir.raceway(&["plot", "found/front"]);
    assert_eq!(plot.code, Some(0), "{}", plot.stderr);
    assert!(dir.path("found/front/figures/seat_pressure_inner.svg").exists());
}

/// Wrong: modes of a list on an elastic shaft would be shown as the motion of its fixed end, in the frame of another
/// bearing, or with a line that is not where the rings are. Rings are turned both ways, and follow the sections at
/// which they sit; few functions, so to a few per cent.
#[test]
fn the_line_of_a_mode_goes_through_the_sections_of_an_elastic_shaft() {
    let dir = coarse(&[SCENE]);
    let scene = without_analysis(&dir, SCENE);
    dir.write("modes.toml", format!("{scene}\n[modes]\nnumber = 2\n"));
    let run = dir.raceway(&[&["run", "modes.toml", "--out", "found"][..], &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let table = Table::read(&dir, "found/mode_shaft.csv");
    let [modes, z, x, y, tilt] =
        ["mode", "position_m", "x", "y", "tilt_y_per_m"].map(|name| table.column(name).to_vec());
    let rows: Vec<usize> = (0..modes.len()).filter(|&i| modes[i] == 2.0).collect();
    assert!(rows.len() > 20, "{} places", rows.len());
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    assert!(z[first] < 0.01 && z[last] > 0.2, "{} {}", z[first], z[last]);
    assert!(
        (tilt[last] / tilt[first] - 1.0).abs() > 0.05,
        "it bends: {} {}",
        tilt[first],
        tilt[last]
    );
    let at = |line: &[f64], place: f64| {
        let after = *rows.iter().find(|&&i| z[i] > place).unwrap();
        let share = (place - z[after - 1]) / (z[after] - z[after - 1]);
        (1.0 - share) * line[after - 1] + share * line[after]
    };
    let most = rows.iter().map(|&i| x[i].hypot(y[i])).fold(0.0, f64::max);
    for (name, place, turn) in [("front", 0.06, 1.0), ("rear", 0.13, -1.0)] {
        let folder = dir.path(&format!("found/{name}"));
        let grid = read_mesh(&folder).unwrap();
        let shape = read_step(&folder.join(step_file_name(2))).unwrap();
        let ring = (0..grid.body.len()).filter(|&cell| grid.body[cell] == 0);
        let nodes: BTreeSet<usize> = ring.flat_map(|cell| grid.cell(cell)).collect();
        let mean = |c: usize| {
            let sum: f64 = nodes.iter().map(|&n| 1e3 * shape.points.displacement[n][c]).sum();
            sum / nodes.len() as f64
        };
        for (found, expected) in [(mean(0), at(&x, place)), (turn * mean(1), at(&y, place))] {
            assert!(
                (found - expected).abs() < 0.03 * most,
                "{name}: {found} {expected} of {most}"
            );
        }
    }
    // A reader of the other bearing learns where the shaft is.
    let line = "body       \"spindle\" is in the files of ../front; raceway export of the folder above, --to vtu, has \
                all bearings with their bodies";
    let info = dir.raceway(&["info", "found/rear"]);
    assert!(info.stdout.contains(line), "{}", info.stdout);
    assert!(!dir.raceway(&["info", "found/front"]).stdout.contains("body  "));
    assert!(
        run.stdout
            .contains("bearing \"rear\": body \"spindle\" is in the files of ../front")
    );
    assert_eq!(
        summary(&dir, "found/rear")["bodies_shown_in"]["spindle"],
        "../front"
    );
}

/// Weights across the seat.
const SIMPSON: [f64; 9] = [1.0, 4.0, 2.0, 4.0, 2.0, 4.0, 2.0, 4.0, 1.0];

/// Mean motion across the axis of the front seat beside the shaft, in the frame of its ring, by Simpson's rule, m.
fn mean_of_seat(dir: &Dir) -> [f64; 2] {
    let table = Table::read(dir, "found/front/seat_inner.csv");
    let columns = ["azimuth_rad", "radial_m", "tangential_m"].map(|name| table.column(name));
    let [azimuth, radial, tangential] = columns;
    let rows = azimuth.iter().zip(radial.iter().zip(&tangential)).enumerate();
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for (i, (azimuth, (radial, tangential))) in rows {
        let (sin, cos) = azimuth.sin_cos();
        sum[0] += SIMPSON[i % 9] * (radial * cos - tangential * sin);
        sum[1] += SIMPSON[i % 9] * (radial * sin + tangential * cos);
        weights += SIMPSON[i % 9];
    }
    sum.map(|sum| sum / weights)
}

/// Where the front seat of each row of the table of bearings is beside the rigid shaft, across the axis, m.
fn front_beside_shaft(dir: &Dir) -> Vec<[f64; 2]> {
    let rigid = Table::read(dir, "found/front/shaft.csv");
    let [x, y] = ["x_m", "y_m"].map(|name| {
        let front = of_bearings(dir, "found", name).into_iter().step_by(2);
        let beside = front.zip(rigid.column(name)).map(|(seat, shaft)| seat - shaft);
        beside.collect::<Vec<f64>>()
    });
    x.into_iter().zip(y).map(Into::into).collect()
}

/// Distance of two points across the axis.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Force of the front seat's pressure and shear on its ring across the axis, N, by Simpson's rule on a bore of 50 mm.
fn force_of_seat(dir: &Dir) -> [f64; 2] {
    let table = Table::read(dir, "found/front/seat_inner.csv");
    let columns = ["azimuth_rad", "z_m", "pressure_pa", "shear_tangential_pa"].map(|name| table.column(name));
    let [azimuth, z, pressure, shear] = columns;
    let area = std::f64::consts::TAU * 0.025 * (z[8] - z[0]);
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for (i, azimuth) in azimuth.iter().enumerate() {
        let (sin, cos) = azimuth.sin_cos();
        let weight = SIMPSON[i % 9];
        sum[0] += weight * (pressure[i] * cos - shear[i] * sin);
        sum[1] += weight * (pressure[i] * sin + shear[i] * cos);
        weights += weight;
    }
    sum.map(|sum| area * sum / weights)
}

/// Wrong: pressure of a shaft on its ring would pass for a pull. It stands against the forces of the balls on the ring.
#[test]
fn a_shaft_presses_its_ring_against_the_balls() {
    let dir = coarse(&[SCENE]);
    let loads = [
        "--set",
        "effects.radial_force={value = \"2 kN\", direction = \"30 deg\"}",
    ];
    let run = dir.raceway(&[&["run", SCENE, "--out", "found"][..], &loads, &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let balls = Table::read(&dir, "found/front/balls.csv");
    let columns = ["azimuth_rad", "inner_force_n", "inner_contact_angle_rad"].map(|name| balls.column(name));
    let [azimuth, force, angle] = columns;
    let mut pressed = [0.0; 2];
    for (azimuth, (force, angle)) in azimuth.iter().zip(force.iter().zip(&angle)) {
        let (sin, cos) = azimuth.sin_cos();
        pressed[0] += force * angle.cos() * cos;
        pressed[1] += force * angle.cos() * sin;
    }
    let found = force_of_seat(&dir);
    assert!(
        apart(found, pressed) < 0.05 * apart(pressed, [0.0; 2]),
        "{found:?} {pressed:?}"
    );
}

/// Wrong: the line of a spindle that turns under loads that stand would turn with it. Three places over half a turn;
/// meanwhile balls pass, which bends it by little.
#[test]
fn the_line_of_a_turning_spindle_stands_under_loads_that_stand() {
    let dir = coarse(&[SCENE]);
    let scene = without_analysis(&dir, SCENE);
    let analysis = "\n[speed]\ninner = \"3000 rpm\"\n[quasi_static]\nduration = \"10 ms\"\nstep = \"5 ms\"\n";
    dir.write("turning.toml", scene + analysis);
    let run = dir.raceway(&[&["run", "turning.toml", "--out", "found"][..], &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found = front_beside_shaft(&dir);
    assert_eq!(found.len(), 3);
    let size = apart(found[0], [0.0; 2]);
    for place in &found[1..] {
        assert!(apart(*place, found[0]) < 0.1 * size, "{found:?}");
    }
}

/// Wrong: in motion the line would be in the frame of the ring. At the end the shaft has turned by 14.4 deg.
#[test]
fn the_line_of_a_moving_spindle_is_in_space() {
    let dir = coarse(&[SCENE]);
    in_motion(&dir, SCENE, ["spindle", "30000 rpm"]);
    let run = dir.raceway(&[&["run", "moving.toml", "--out", "found"][..], &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found = *front_beside_shaft(&dir).last().unwrap();
    let [x, y] = mean_of_seat(&dir);
    let (sin, cos) = 14.4f64.to_radians().sin_cos();
    let expected = [cos * x - sin * y, sin * x + cos * y];
    let off = apart(found, expected) / apart(expected, [0.0; 2]);
    assert!(off < 0.05, "{found:?} {expected:?}");
}

/// If this failed, a pair on one spindle would lose energy in motion, or would go on to other bits after a resume or on
/// another number of threads.
#[test]
fn a_pair_moves_on_one_spindle_and_goes_on_to_the_same_bits() {
    let dir = coarse(&[SCENE]);
    in_motion(&dir, SCENE, ["spindle", "6000 rpm"]);
    let growing = dir.text("moving.toml") + "\n[effects.frame_rotation]\n";
    dir.write("moving.toml", growing);
    assert_moves_and_goes_on(&dir, "moving.toml", &FEW);
}

/// One bearing with a coarse ring on the front seat of a spindle, which sags and grows.
fn alone(dir: &Dir, mesh: &str) {
    let text = dir
        .text("scenes/7010c_1800rpm_coarse.toml")
        .replace("../meshes", "meshes");
    let body = format!(
        "[[body]]\nname = \"spindle\"\nmesh = \"{mesh}\"\nmesh_unit = \"mm\"\nfixed = [\"nose\"]\n\
         modes_below = \"3 kHz\"\n\
         material = {{ young_modulus = \"207 GPa\", poisson_ratio = 0.3, density = \"7800 kg/m3\" }}\n\
         [[body.seat]]\nring = \"inner\"\ngroup = \"seat_front\"\nharmonics = 4\n[shaft] "
    );
    let text = text
        .replacen("support = \"clamped\" ", "support = \"body\" ", 1)
        .replace("[shaft] ", &body)
        .replace("duration = \"10 ms\"", "duration = \"240 us\"")
        .replace("output_every = 20", "output_every = 4");
    let loads = "\n[effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0.0, -1.0, 0.0]\n\
                 [effects.frame_rotation]\n";
    dir.write("alone.toml", text + loads);
}

/// Where the points of a body within a region of the mesh stand in step 12, beside their places turned by an angle, m.
fn beside_turned(dir: &Dir, body: u8, angle: f64, is_inside: impl Fn([f64; 3]) -> bool) -> Vec<[f64; 3]> {
    let grid = read_mesh(&dir.path("whole")).unwrap();
    let step = read_step(&dir.path("whole").join(step_file_name(12))).unwrap();
    let moved = step.points.displacement;
    let ends = |cell: usize| grid.offsets[cell] as usize..grid.offsets[cell + 1] as usize;
    let cells = (0..grid.body.len()).filter(|&cell| grid.body[cell] == body);
    let mut points: Vec<usize> = cells
        .flat_map(|cell| grid.connectivity[ends(cell)].iter().map(|&p| p as usize))
        .collect();
    points.sort_unstable();
    points.dedup();
    let (sin, cos) = angle.sin_cos();
    let beside = |p: usize| {
        let ([x, y, z], u) = (grid.points[p], moved[p]);
        [
            x + u[0] - cos * x + sin * y,
            y + u[1] - sin * x - cos * y,
            z + u[2] - z,
        ]
    };
    let inside = points.into_iter().filter(|&p| is_inside(grid.points[p]));
    inside.map(beside).collect()
}

/// If this failed, step files would show the shaft elsewhere than the ring on it, such as not turned; it would lose
/// energy, or other threads and a resume would have other bits. Seat and bore are moved alike beside their turning.
#[test]
fn a_shaft_turns_with_its_ring_and_goes_on_to_the_same_bits() {
    let dir = delivered();
    alone(&dir, "meshes/hollow_spindle.msh");
    let run = dir.raceway(&["run", "alone.toml", "--out", "whole", "--threads", "1"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found = summary(&dir, "whole");
    let energy = |name: &str| number(&found, &format!("/energy_j/{name}"));
    assert!(energy("defect").abs() < 1e-9 * energy("total"));
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let resumed = dir.raceway(&["resume", "cut", "--step", "4", "--threads", "2"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_same_run(&dir, "whole", "cut");
    // 1800 rpm over 240 us.
    let angle = 60.0 * std::f64::consts::PI * 240e-6;
    let is_seat = |[x, y, z]: [f64; 3]| (x.hypot(y) - 25e-3).abs() < 1e-6 && z.abs() < 8.2e-3;
    let mean = |body: u8| {
        let all = beside_turned(&dir, body, angle, is_seat);
        assert!(all.len() > 50, "{} of {body}", all.len());
        [0, 1, 2].map(|c| all.iter().map(|u| u[c]).sum::<f64>() / all.len() as f64)
    };
    let shaft = *Table::read(&dir, "whole/shaft.csv").column("x_m").last().unwrap();
    let [ring, body] = [0, 4].map(mean);
    assert!(
        shaft > 1e-6 && (ring[0] - shaft).abs() < 0.5 * shaft,
        "{ring:?} {shaft}"
    );
    for c in 0..3 {
        assert!((ring[c] - body[c]).abs() < 0.05 * shaft, "{ring:?} {body:?}");
    }
    // Not turned, a place at a radius of 25 mm would stand 1 mm away.
    let all = beside_turned(&dir, 4, angle, |_| true);
    assert!(all.iter().flatten().all(|u| u.abs() < 0.2e-3));
}

/// If this failed, a shaft that is out of balance would turn as if it were not.
#[test]
fn a_shaft_that_is_not_round_does_not_turn() {
    let dir = delivered();
    let (mut mesh, _) = read_body_msh(dir.path("meshes/hollow_spindle.msh"), 1e-3).unwrap();
    let bent = |x: &mut [f64; 3]| x[0] += 0.3 * (x[2] - 145e-3).max(0.0);
    mesh.nodes.iter_mut().for_each(bent);
    write_msh(
        dir.path("bent.msh"),
        &mesh,
        1e-3,
        MshFormat::Binary,
        Overwrite::Refuse,
    )
    .unwrap();
    // That a ring's mesh was written does not matter but for the name of its volume.
    let bytes = std::fs::read(dir.path("bent.msh")).unwrap();
    let at = bytes.windows(6).position(|w| w == b"\"ring\"").unwrap();
    let bytes = [&bytes[..at], b"\"body\"", &bytes[at + 6..]].concat();
    std::fs::write(dir.path("bent.msh"), bytes).unwrap();
    alone(&dir, "bent.msh");
    let run = dir.raceway(&["run", "alone.toml", "--out", "bad"]);
    assert_ne!(run.code, Some(0));
    let expected = "body \"spindle\" is on the shaft, but its inertia differs by";
    assert!(run.stderr.contains(expected), "{}", run.stderr);
    assert!(
        run.stderr
            .contains("unbalance and unequal moments of inertia of a body are not solved"),
        "{}",
        run.stderr
    );
}
