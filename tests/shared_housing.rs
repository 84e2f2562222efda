//! Two bearings in one elastic housing through the whole program: files, bits, refusals.

use checkpoint::read_mesh;

use crate::housing::{assert_moves_and_goes_on, delivered};
use crate::util::Dir;
use crate::util::tables::{Table, number, summary};

pub const SCENE: &str = "scenes/7010c_spindle_housing.toml";
/// Few functions: these tests ask for no accuracy.
pub const FEW: [&str; 8] = [
    "--set",
    "body.0.seat.0.harmonics=3",
    "--set",
    "body.0.seat.0.across=1",
    "--set",
    "body.0.seat.1.harmonics=3",
    "--set",
    "body.0.seat.1.across=1",
];

/// If this failed, a pair in one housing would not carry its load, each bearing would show the whole housing, or a user
/// would not find the seats. The housing gives, so the nose moves further than in a stiff one.
#[test]
fn a_pair_in_one_housing_gives_more_than_in_a_stiff_one() {
    let dir = delivered();
    let run = |scene: &str, out: &str, more: &[&str]| {
        let run = dir.raceway(&[&["run", scene, "--out", out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let line = Table::read(&dir, &format!("{out}/shaft.csv"));
        line.column("x_m")[0]
    };
    let stiff = run("scenes/7010c_spindle_pair.toml", "stiff", &[]);
    let found = run(SCENE, "found", &FEW);
    assert!(found > 1.1 * stiff && found < 1.5 * stiff, "{found} {stiff}");
    let table = dir.text("found/bearings.csv");
    let at = table
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "force_x_n");
    let value = |row: &str| row.split(',').nth(at.unwrap()).unwrap().parse::<f64>().unwrap();
    let force: f64 = table.lines().skip(1).map(value).sum();
    assert!((force + 300.0).abs() < 1e-6, "{force}");
    let has_body = |name: &str| {
        let mesh = read_mesh(&dir.path(&format!("found/{name}"))).unwrap();
        mesh.body.contains(&3)
    };
    assert!(has_body("front") && !has_body("rear"));
    for name in ["front", "rear"] {
        let own = summary(&dir, &format!("found/{name}"));
        assert!(number(&own, "/seat/body_energy_j") > 0.0);
        assert!(dir.path(&format!("found/{name}/seat_outer.csv")).exists());
    }
}

/// The text of the scene for a file of the folder, up to its analysis.
fn without_analysis(dir: &Dir) -> String {
    let text = dir.text(SCENE).replace("../meshes", "meshes");
    let text = text.replace("\"types/", "\"scenes/types/");
    text.split_once("\n[static]").unwrap().0.to_string()
}

/// If this failed, a sweep that ends with an error would leave the seats of its last good point with forces of the
/// point that failed. Balls that carry 20 kN each are more than these meshes hold.
#[test]
fn a_sweep_that_fails_leaves_the_seats_of_its_last_point() {
    let dir = delivered();
    let before = without_analysis(&dir);
    for (name, values) in [("good", "\"1 N\""), ("bad", "\"1 N\", \"2 MN\"")] {
        let sweep = format!(
            "\n[effects.axial_force]\nvalue = \"1 N\"\n[sweep]\nkey = \"effects.axial_force.value\"\n\
             values = [{values}]\n"
        );
        dir.write(&format!("{name}.toml"), format!("{before}{sweep}"));
        let scene = format!("{name}.toml");
        let run = dir.raceway(&[&["run", &scene, "--out", name][..], &FEW].concat());
        assert_eq!(run.code == Some(0), name == "good", "{}", run.stderr);
    }
    for seat in ["front/seat_outer.csv", "rear/seat_outer.csv"] {
        assert!(
            dir.text(&format!("good/{seat}")) == dir.text(&format!("bad/{seat}")),
            "{seat}"
        );
    }
}

/// The scene with a step of the load in motion.
pub fn moving(dir: &Dir) {
    let below = "name = \"housing\"\nmodes_below = \"3 kHz\"";
    let before = without_analysis(dir).replace("name = \"housing\"", below);
    let motion = "\n[speed]\ninner = \"3000 rpm\"\n[effects.axial_force]\nvalue = \"300 N\"\n\
                  schedule.step = { at = \"5 us\" }\n[dynamic]\nduration = \"80 us\"\nstep = \"10 us\"\n\
                  output_every = 4\n";
    dir.write("moving.toml", format!("{before}{motion}"));
}

/// If this failed, bearings that feel each other through a housing would lose energy in motion, or would go on to other
/// bits after a resume or on another number of threads.
#[test]
fn a_pair_moves_in_one_housing_and_goes_on_to_the_same_bits() {
    let dir = delivered();
    moving(&dir);
    assert_moves_and_goes_on(&dir, "moving.toml", &FEW);
}

/// If this failed, a bearing would be given a stiffness of its own that it does not have, or sit in a seat that stands
/// elsewhere.
#[test]
fn what_one_housing_of_several_bearings_does_not_have_ends_with_a_message() {
    let dir = delivered();
    let refused = |arguments: &[&str], expected: &str| {
        let run = dir.raceway(&[arguments, &["--out", "bad"], &FEW].concat());
        assert_ne!(run.code, Some(0));
        assert!(
            run.stderr.contains(expected),
            "{}\nexpected: {expected}",
            run.stderr
        );
        assert!(!dir.path("bad").exists());
    };
    let no_stiffness = "body \"housing\" carries several bearings, which feel each other through it";
    refused(&["stiffness", SCENE], no_stiffness);
    refused(&["campbell", SCENE, "--speeds", "0..1000:500"], no_stiffness);
    let apart = "the seat of bearing \"rear\" stands 70.0000 mm along the shaft from that of \"front\", but with these \
                 positions of the bearings it is 80.2";
    refused(&["run", SCENE, "--set", "bearing.1.position=\"140 mm\""], apart);
    let turned = "stands -70.0000 mm along the shaft";
    refused(&["run", SCENE, "--set", "body.0.orientation=\"-z\""], turned);
}
