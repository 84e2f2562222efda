//! A bearing in an elastic housing through the whole program: files, balance of the seat, figures, refusals.

use std::path::Path;

use crate::util::Dir;
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
