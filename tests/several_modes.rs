//! Natural modes of several bearings on one shaft through the whole program: tables, step files, figures.

use crate::several::{PAIR, flexible_pair, pair, succeeds};
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
