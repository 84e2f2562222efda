//! A bearing in an elastic housing through the whole program: files, balance of the seat, figures, refusals.

use std::path::Path;

use checkpoint::{read_mesh, read_step, read_table, step_file_name};

use crate::util::Dir;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::{Table, number, summary};

/// A folder with the delivered scene and its meshes.
fn delivered() -> Dir {
    let dir = Dir::empty();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for name in ["scenes", "meshes"] {
        std::os::unix::fs::symlink(root.join(name), dir.path(name)).unwrap();
    }
    dir
}

/// If this failed, the tractions of the seat would not be those that carry the bearing, or a user would find no
/// housing in tables, step files and figures. 10 kN downwards come through the balls to the seat: the integral of its
/// tractions, by the trapezoidal rule round it, which is exact for its orders, and Simpson's across. The forces at the
/// nodes balance exactly (`dynamics/tests/housing.rs`); these 17 rows of nodes, 2 mm apart at the edges, integrate the
/// second degree with an error of 1 %, which is in the pressure: 1.6 % in all.
#[test]
fn the_seat_carries_the_load_and_files_show_the_housing() {
    let dir = delivered();
    let run = dir.raceway(&["run", "scenes/6010_plummer_block.toml", "--out", "run"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let told = "seat of the outer ring in body \"plummer block\": 225 functions";
    assert!(run.stdout.contains(told), "{}", run.stdout);
    let seat = Table::read(&dir, "run/seat_outer.csv");
    let column = |name: &str| seat.column(name);
    let (azimuth, pressure, shear) = (
        column("azimuth_rad"),
        column("pressure_pa"),
        column("shear_tangential_pa"),
    );
    let simpson = |i: usize| match i % 9 {
        0 | 8 => 1.0 / 3.0,
        j if j % 2 == 1 => 4.0 / 3.0,
        _ => 2.0 / 3.0,
    };
    let area = |i: usize| simpson(i) * 2e-3 * 40e-3 * std::f64::consts::TAU / 144.0;
    let force = |direction: f64| -> f64 {
        let of = |i: usize| {
            let (sin, cos) = (azimuth[i] - direction).sin_cos();
            area(i) * (-pressure[i] * cos - shear[i] * sin)
        };
        (0..azimuth.len()).map(of).sum()
    };
    let up = force(std::f64::consts::FRAC_PI_2);
    assert!((up / 10e3 - 1.0).abs() < 0.02, "{up} N upwards on the ring");
    assert!(force(0.0).abs() < 50.0, "{} N sideways", force(0.0));
    let summary = summary(&dir, "run");
    assert_eq!(number(&summary, "/seat/functions"), 225.0);
    assert!(number(&summary, "/seat/energy_share_last_orders") < 0.02);
    assert!(number(&summary, "/seat/body_energy_j") > 0.0);
    assert!(number(&summary, "/energy_j/defect").abs() < 1e-9 * number(&summary, "/energy_j/strain"));
    let plot = dir.raceway(&["plot", "run"]);
    assert_eq!(plot.code, Some(0), "{}", plot.stderr);
    assert!(
        plot.stdout.contains("seat_pressure") && plot.stdout.contains("seat_motion"),
        "{}",
        plot.stdout
    );
}

/// If this failed, a body that is not there, does not fit or is not held would end in anything but a message.
#[test]
fn bodies_that_do_not_fit_end_with_a_message() {
    let dir = delivered();
    let refused = |set: &[&str], expected: &str| {
        let sets = set.iter().flat_map(|set| ["--set", set]);
        let first = ["run", "scenes/6010_plummer_block.toml", "--out", "bad"];
        let run = dir.raceway(&first.into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(
            run.stderr.contains(expected),
            "{}\nexpected: {expected}",
            run.stderr
        );
        assert!(!dir.path("bad").exists());
    };
    refused(
        &["outer.support=\"clamped\""],
        "but outer.support is not \"body\"",
    );
    refused(&["solver.backend=\"sector\""], "does not tie a ring to a body");
    refused(&["speed.outer=\"100 rpm\""], "speed.outer turns the outer ring");
}

/// If this failed, regions and extremes would lack the housing, which comes after the balls in all files, or take its
/// stress for that of rings. Extremes over a sweep of two loads are those of the two step files, of every point; a
/// region of azimuths holds the housing, one near the grooves does not; without stress in step files the extremes are
/// the same.
#[test]
fn regions_and_extremes_hold_the_housing() {
    let dir = delivered();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("scenes/6010_plummer_block.toml")).unwrap();
    let sweep = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"2 kN\", \"10 kN\"]\n";
    let text = text.replace("[static]                             # one equilibrium", sweep);
    dir.write("sweep.toml", text.replace("../meshes", "meshes"));
    let run = |out: &str, set: &[&str]| {
        let sets = set.iter().flat_map(|set| ["--set", set]);
        let first = [
            "run",
            "sweep.toml",
            "--out",
            out,
            "--set",
            "output.reduction.every=1",
        ];
        let run = dir.raceway(&first.into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let table = read_table(&dir.path(out).join("reduction.vtkhdf"), None).unwrap();
        table
            .fields
            .into_iter()
            .find(|field| field.name == "von_mises_maximum")
            .unwrap()
            .values
    };
    let in_sector = [
        "output.region.azimuth=[\"-100 deg\", \"-80 deg\"]",
        "output.precision=f64",
    ];
    let most = run("sector", &in_sector);
    let grid = read_mesh(&dir.path("sector")).unwrap();
    let steps = [0, 1].map(|n| {
        read_step(&dir.path("sector").join(step_file_name(n)))
            .unwrap()
            .points
    });
    let [small, large] = steps.each_ref().map(|points| points.von_mises.as_ref().unwrap());
    let inside = steps[1].in_region.as_ref().unwrap();
    let mut of_body = vec![false; most.len()];
    for (ends, _) in grid
        .offsets
        .windows(2)
        .zip(&grid.body)
        .filter(|(_, body)| **body == 3)
    {
        for &point in &grid.connectivity[ends[0] as usize..ends[1] as usize] {
            of_body[point as usize] = true;
        }
    }
    let (mut kept, mut left, mut stressed) = (0, 0, 0);
    for i in (0..most.len()).filter(|&i| of_body[i]) {
        let [x, y, _] = grid.points[i];
        let in_sector = (y.atan2(x).to_degrees() + 90.0).abs() <= 10.0 + 1e-6;
        assert_eq!(inside[i] == 1.0, in_sector, "point {i} at {x} {y}");
        match in_sector {
            true => {
                assert_eq!(most[i], small[i].max(large[i]), "point {i}");
                kept += 1;
            }
            false => {
                assert!(large[i].is_nan());
                left += 1;
            }
        }
        stressed += usize::from(most[i] > 1e5);
    }
    assert!(
        kept > 100 && left > 1000 && stressed > 1000,
        "{kept} {left} {stressed}"
    );
    let without = ["output.stress=none", "output.precision=f64"];
    assert!(run("none", &without) == most);
    let near = ["output.region.raceway_distance=1 mm", "output.precision=f64"];
    assert!(run("near", &near) == most);
    let near = read_step(&dir.path("near").join(step_file_name(1)))
        .unwrap()
        .points;
    let near = near.in_region.unwrap();
    assert!((0..most.len()).all(|i| !(of_body[i] && near[i] == 1.0)));
    assert!(near.iter().filter(|&&inside| inside == 1.0).count() > 1000);
}

/// The delivered bearing on a shaft of 5 kg with an unbalance, which turns at 3000 rpm; 12 steps, a file every fourth.
fn in_motion(dir: &Dir) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("scenes/6010_plummer_block.toml")).unwrap();
    let motion = "[speed]\ninner = \"3000 rpm\"\n[effects.unbalance]\nmass = \"20 g\"\neccentricity = \"30 mm\"\n\
                  [dynamic]\nduration = \"240 us\"\nstep = \"20 us\"\noutput_every = 4\n";
    let text = text.replace("[static]                             # one equilibrium", motion);
    let text = text.replace("load_point = \"0 mm\"", "load_point = \"0 mm\"\nmass = \"5 kg\"");
    dir.write("motion.toml", text.replace("../meshes", "meshes"));
}

/// If this failed, a housing would not move, or be left out of step files; a run that is cut and goes on, or has other
/// threads, would have other bits.
#[test]
fn a_housing_moves_and_goes_on_to_the_same_bits() {
    let dir = delivered();
    in_motion(&dir);
    let run = dir.raceway(&["run", "motion.toml", "--out", "whole", "--threads", "1"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let told = "its seat is tied to a body by 225 functions, and the body moves by these and by its";
    assert!(run.stderr.contains(told), "{}", run.stderr);
    let summary = summary(&dir, "whole");
    let energy = |name: &str| number(&summary, &format!("/energy_j/{name}"));
    assert!(energy("defect").abs() < 1e-9 * energy("total"));
    assert!(energy("kinetic_outer") > 0.0);
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let resumed = dir.raceway(&["resume", "cut", "--step", "4", "--threads", "2"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_same_run(&dir, "whole", "cut");
    let grid = read_mesh(&dir.path("whole")).unwrap();
    let of_body = |cell: usize| grid.body[cell] == 3;
    let ends = |cell: usize| grid.offsets[cell] as usize..grid.offsets[cell + 1] as usize;
    let cells = (0..grid.body.len()).filter(|&cell| of_body(cell));
    let points: Vec<usize> = cells
        .flat_map(|cell| grid.connectivity[ends(cell)].iter().map(|&p| p as usize))
        .collect();
    let [first, last] = [0, 12].map(|step| {
        read_step(&dir.path("whole").join(step_file_name(step)))
            .unwrap()
            .points
    });
    let most = |of: &dyn Fn(usize) -> f64| points.iter().map(|&p| of(p)).fold(0.0, f64::max);
    let moved = |p: usize| {
        (0..3)
            .map(|c| (last.displacement[p][c] - first.displacement[p][c]).abs())
            .fold(0.0, f64::max)
    };
    assert!(
        most(&|p| first.displacement[p][1].abs()) > 1e-6,
        "it stands under the load"
    );
    assert!(most(&moved) > 1e-10, "it moves by {} m", most(&moved));
    assert!(most(&|p| last.von_mises.as_ref().unwrap()[p]) > 1e5);
}

/// If this failed, modes would be those of a bearing without its housing.
#[test]
fn natural_modes_in_a_housing_are_refused() {
    let dir = delivered();
    in_motion(&dir);
    let run = dir.raceway(&["run", "motion.toml", "--out", "bad", "--set", "modes.number=4"]);
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(
        run.stderr.contains("are not solved, but the scene has [modes]"),
        "{}",
        run.stderr
    );
    assert!(!dir.path("bad").exists());
}
