//! Natural modes of several bearings on one shaft through the whole program: tables, step files, figures.

use crate::modes::modes_are_not_resumed;
use crate::several::{PAIR, flexible_pair, pair, succeeds, with_type};
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, assert_close};

/// A column of a table that has words in others.
pub fn column(dir: &Dir, file: &str, name: &str) -> Vec<f64> {
    let text = dir.text(file);
    let mut lines = text.lines().map(|line| line.split(','));
    let i = lines
        .next()
        .and_then(|mut head| head.position(|column| column == name));
    let i = i.unwrap_or_else(|| panic!("{file} has no column {name}"));
    lines
        .map(|mut row| row.nth(i).unwrap().parse().unwrap())
        .collect()
}

/// Wrong: a user would not find the modes of a list, a bearing would have others than its shaft, or they would be other
/// modes than those of the Campbell diagram at rest, which rigid rings share with it.
#[test]
fn a_list_has_its_natural_modes() {
    let dir = pair("[modes]\nnumber = 24");
    let check = succeeds(&dir, &["check", "pair.toml"]);
    assert!(
        check
            .stdout
            .contains("analysis modes, the 24 lowest of all bearings with their shaft")
    );
    let run = succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    assert!(run.stdout.contains("bearings on their shaft:"), "{}", run.stdout);
    let all = |name: &str| column(&dir, "out/modes.csv", name);
    let frequencies = all("frequency_hz");
    assert!(frequencies.len() == 24 && frequencies.is_sorted());
    let shares = ["kinetic_inner", "kinetic_outer", "kinetic_balls", "kinetic_shaft"];
    let shares = shares.map(all);
    for i in 0..24 {
        let sum: f64 = shares.iter().map(|column| column[i]).sum();
        assert_close("shares", sum, 1.0, 1e-12);
    }
    let told = summary(&dir, "out");
    assert_close(
        "frequency",
        number(&told, "/modes/frequency_hz/3"),
        frequencies[3],
        1e-12,
    );
    assert_eq!(told["analysis"], "modes");
    let balls = all("kinetic_balls");
    let [fronts, rears] =
        ["front", "rear"].map(|name| column(&dir, &format!("out/{name}/modes.csv"), "kinetic_balls"));
    (0..24).for_each(|i| assert_close("balls", fronts[i] + rears[i], balls[i], 1e-12));
    // The largest displacement of a bearing or component of the shaft is 1.
    let shaft = Table::read(&dir, "out/mode_shaft.csv");
    let [x, y, z] = ["x", "y", "z"].map(|name| shaft.column(name));
    let components = x.iter().chain(&y).chain(&z);
    let largest = components.fold(0.0f64, |most, u| most.max(u.abs()));
    assert!((0.5..1.0 + 1e-9).contains(&largest), "{largest}");
    assert!(dir.path("out/front/step_000024.hdf").exists());
    modes_are_not_resumed(&dir);
    succeeds(&dir, &["plot", "out"]);
    assert!(
        dir.path("out/figures/frequencies.svg").exists() && dir.path("out/figures/shaft_line.svg").exists()
    );
    dir.write("rest.toml", format!("{PAIR}\n[static]\n"));
    succeeds(
        &dir,
        &[
            "campbell",
            "rest.toml",
            "--speeds",
            "0..1000:1000",
            "--out",
            "campbell",
            "--number",
            "6",
        ],
    );
    let at_rest = column(&dir, "campbell/campbell.csv", "frequency_hz");
    for frequency in &at_rest[..at_rest.len() / 2] {
        let off = frequencies
            .iter()
            .map(|f| (f / frequency - 1.0).abs())
            .fold(1.0, f64::min);
        assert!(off < 1e-6 || *frequency > frequencies[23], "{frequency}: {off:e}");
    }
}

/// Wrong: `check` would forecast the start at rest alone, a fraction of what the search for modes takes, so that a run
/// would die where it should be refused. Elastic rings, so many modes that vectors are most of it; 30 % as for bodies.
#[test]
fn the_memory_of_modes_of_a_list_is_forecast() {
    let dir = flexible_pair("[modes]\nnumber = 60");
    let check = succeeds(&dir, &["check", "pair.toml", "--json", "--quiet"]);
    let found: serde_json::Value = serde_json::from_str(&check.stdout).unwrap();
    let forecast = number(&found, "/peak_memory_bytes");
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let measured = number(&summary(&dir, "out"), "/peak_memory_bytes");
    println!("{forecast:e} {measured:e}");
    assert!(
        (measured / forecast - 1.0).abs() < 0.3,
        "{forecast:e} {measured:e}"
    );
}

/// Rows of a mode in `mode_shaft.csv`: position and a component.
fn shape(dir: &Dir, out: &str, mode: usize, component: &str) -> Vec<[f64; 2]> {
    let table = Table::read(dir, &format!("{out}/mode_shaft.csv"));
    let [modes, z, u] = ["mode", "position_m", component].map(|name| table.column(name));
    let rows = (0..modes.len()).filter(|&i| modes[i] == mode as f64);
    rows.map(|i| [z[i], u[i]]).collect()
}

/// A pair 1 m apart on a slender uniform shaft, 10 mm from its ends, without a load.
const SLENDER: [(&str, &str); 7] = [
    ("\"60 mm\"", "\"10 mm\""),
    ("\"130 mm\"", "\"1010 mm\""),
    ("\"20 um\"", "\"1 mm\""),
    ("to = \"200 mm\"", "to = \"1020 mm\""),
    ("\"50 mm\"", "\"5 mm\""),
    ("bore = \"20 mm\"", "bore = \"0 mm\""),
    (
        "force = [\"300 N\", \"0 N\", \"200 N\"]",
        "force = [\"0 N\", \"0 N\", \"0 N\"]",
    ),
];

/// Wrong: a user would see other mode shapes of a shaft than those of a beam. A shaft of 5 mm at whose ends bearings of
/// 50 mm sit is clamped there: cosh bz - cos bz - s (sinh bz - sin bz), b L = 4.7300, 7.8532, 10.9956 (Blevins,
/// Formulas for Natural Frequency and Mode Shape, 1979, table 8-1), all of them double. The tilt of the bearings and
/// elements of 10 mm are most of what is left.
#[test]
fn a_shaft_in_two_stiff_bearings_has_the_shapes_of_a_clamped_beam() {
    let dir = with_type();
    let scene = SLENDER.iter().fold(PAIR.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let scene = scene.replace(
        "[[shaft.section]]",
        "element_length = \"10 mm\"\n\n[[shaft.section]]",
    );
    dir.write("slender.toml", format!("{scene}\n[modes]\nnumber = 6\n"));
    succeeds(&dir, &["run", "slender.toml", "--out", "out"]);
    let frequencies = column(&dir, "out/modes.csv", "frequency_hz");
    let mut worst = 0.0f64;
    let stiffness_over_mass = 207e9 * 0.0025f64.powi(2) / 4.0 / 7800.0;
    for (i, k) in [4.730_040_7, 7.853_204_6, 10.995_607_8].into_iter().enumerate() {
        let expected = k * k * stiffness_over_mass.sqrt() / std::f64::consts::TAU;
        for mode in [2 * i, 2 * i + 1] {
            assert_close("frequency", frequencies[mode], expected, 5e-3);
            let [x, y] = ["x", "y"].map(|component| shape(&dir, "out", mode + 1, component));
            assert_eq!(x.len(), 103);
            let clamped = |position: f64| {
                // In the bearings and beyond them it stands.
                let z = (position - 0.01).clamp(0.0, 1.0);
                let factor = (k.cosh() - k.cos()) / (k.sinh() - k.sin());
                (k * z).cosh() - (k * z).cos() - factor * ((k * z).sinh() - (k * z).sin())
            };
            // In any plane: both components are the shape times a factor, and the larger one is not small.
            let product = |u: &[[f64; 2]]| u.iter().map(|[z, u]| u * clamped(*z)).sum::<f64>();
            let square = x.iter().map(|[z, _]| clamped(*z).powi(2)).sum::<f64>();
            let factors = [&x, &y].map(|u| product(u) / square);
            let most = factors[0].hypot(factors[1]);
            assert!(most > 0.3, "{factors:?}");
            for (u, factor) in [&x, &y].into_iter().zip(factors) {
                for [z, u] in u {
                    worst = worst.max((u - factor * clamped(*z)).abs() / most);
                }
            }
        }
    }
    println!("{worst:e} {frequencies:?}");
    assert!(worst < 0.01, "{worst:e}");
    succeeds(&dir, &["plot", "out"]);
    let figure = dir.text("out/figures/shaft_modes.svg");
    for text in [
        format!("1: {:.1} Hz, at", frequencies[0]),
        "front".into(),
        "rear".into(),
    ] {
        assert!(figure.contains(&text), "{text}");
    }
    assert!(dir.path("out/figures/shaft_modes_2.svg").exists());
}

/// Wrong: a rigid shaft would be drawn bent.
#[test]
fn a_rigid_shaft_stays_straight_in_its_modes() {
    let bearings = PAIR.split("[shaft]").next().unwrap();
    let dir = with_type();
    let shaft = "[shaft]\nmodel = \"rigid\"\nx = \"free\"\ny = \"free\"\nz = \"free\"\ntilt_x = \"free\"\n\
                 tilt_y = \"free\"\nmass = \"2 kg\"\ntransverse_inertia = \"5e-3 kg m2\"\n\
                 polar_inertia = \"1e-3 kg m2\"\n\n[modes]\nnumber = 10\n";
    dir.write("rigid.toml", format!("{bearings}{shaft}"));
    succeeds(&dir, &["run", "rigid.toml", "--out", "out"]);
    let mut tilted = 0;
    for mode in 1..=10 {
        for (component, tilt, sign) in [("x", "tilt_y_per_m", 1.0), ("y", "tilt_x_per_m", -1.0)] {
            let (line, tilts) = (
                shape(&dir, "out", mode, component),
                shape(&dir, "out", mode, tilt),
            );
            let [[z0, u0], ..] = line[..] else {
                panic!("{line:?}")
            };
            assert_eq!(line.len(), 3);
            tilted += usize::from(tilts[0][1].abs() > 0.5);
            for ([z, u], [_, tilt]) in line.into_iter().zip(tilts) {
                assert!((u - u0 - sign * tilt * (z - z0)).abs() < 1e-12);
            }
        }
    }
    assert!(tilted > 1);
}

/// Wrong: `number` modes would be those of balls that touch nothing, or a user not be told that they are left out. An
/// offset of less than nothing takes the bearings apart: no row is loaded, and the shaft is held by itself alone.
#[test]
fn balls_that_carry_nothing_are_left_out_of_modes() {
    let bearings = PAIR
        .split("[shaft]")
        .next()
        .unwrap()
        .replace("\"20 um\"", "\"-40 um\"");
    let dir = with_type();
    let shaft = "[shaft]\nmodel = \"rigid\"\nx = \"locked\"\ny = \"locked\"\nz = \"free\"\n\
                 tilt_x = \"locked\"\ntilt_y = \"locked\"\nmass = \"2 kg\"\n\n\
                 [effects.axial_force]\nvalue = \"200 N\"\n\n[modes]\nnumber = 10\n";
    dir.write("apart.toml", format!("{bearings}{shaft}"));
    let run = succeeds(&dir, &["run", "apart.toml", "--out", "out"]);
    let told = "warning: bearings on their shaft: 18 balls carry nothing, with neither stiffness nor coupling; 36 \
                motions at zero frequency are left out of the modes";
    assert!(run.stdout.contains(told), "{}", run.stdout);
    let frequencies = column(&dir, "out/modes.csv", "frequency_hz");
    assert!(
        frequencies.len() == 10 && frequencies[0] > 100.0,
        "{frequencies:?}"
    );
    let loose = column(&dir, "out/rear/modes.csv", "kinetic_balls");
    assert!(loose.iter().all(|share| *share == 0.0), "{loose:?}");
    // The front bearing alone under the load has the same ones.
    let [front, _] = bearings
        .split_once("[[bearing]]\nname = \"rear\"")
        .map(|(front, _)| [front, ""])
        .unwrap();
    dir.write("front.toml", format!("{front}{shaft}"));
    succeeds(&dir, &["run", "front.toml", "--out", "alone"]);
    let alone = column(&dir, "alone/modes.csv", "frequency_hz");
    for (a, b) in frequencies.iter().zip(&alone) {
        assert_close("frequency", *a, *b, 1e-7);
    }
}
