//! Ratings and lives through the whole program: of a scene, of equilibria, sweeps, histories and load spectra.

use serde_json::Value;

use crate::util::tables::number;
use crate::util::{Dir, RIGID, SCENE, assert_close, with_line};

/// What all lives here are told besides the loads.
pub const LIFE: &str = "[life]\ncontact_angle = \"15 deg\"\nspeed = \"1800 rpm\"\nviscosity_ratio = 1.5\n\
                    contamination = 0.6\n\n[static]";
const SWEEP: &str = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0 kN\", \"1 kN\", \"4 kN\"]";
/// A turn and a little, by which no position of a ring is left out.
pub const TURN: &str =
    "[quasi_static]\nduration = \"35 ms\"\nstep = \"0.1 ms\"\n\n[speed]\ninner = \"1800 rpm\"\n";

/// A folder with a scene of rigid rings with `[life]`.
fn scene(analysis: &str) -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", analysis));
    dir.run("out", &RIGID);
    dir
}

/// What the command says.
pub fn life(dir: &Dir, arguments: &[&str]) -> String {
    let outcome = dir.raceway(&[&["life"], arguments].concat());
    assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
    outcome.stdout
}

/// What it wrote into a folder of results.
pub fn life_file(dir: &Dir, folder: &str) -> Value {
    serde_json::from_str(&dir.text(&format!("{folder}/life.json"))).unwrap()
}

/// The command must refuse with this text.
fn refused(dir: &Dir, arguments: &[&str], expected: &str) {
    let outcome = dir.raceway(&[&["life"], arguments].concat());
    assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
    assert!(
        outcome.stderr.contains(expected),
        "{arguments:?}: {}",
        outcome.stderr
    );
}

/// Wrong: a user would not find the numbers of ISO 281 and ISO 16281, or others than the forces of the balls give.
#[test]
fn an_equilibrium_has_its_life() {
    let dir = scene(&LIFE.replace("[static]", "[static]\n"));
    let said = life(&dir, &["out"]);
    for part in [
        "ISO 281, catalogue",
        "26.587 kN",
        "ISO 16281",
        "life L_nmr",
        "note: nothing turns in this run",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let found = life_file(&dir, "out");
    assert_close("C_r", number(&found, "/c_r_n"), 26587.0, 1e-4);
    let slip = scene(&LIFE.replace("[life]", "[life]\nrating = \"27 N\""));
    let said_of_slip = life(&slip, &["out"]);
    let part = "life.rating is 27 N, and the dimensions give 26587 N: check its unit";
    assert!(
        said_of_slip.contains(part) && !said.contains("check its unit"),
        "{said_of_slip}"
    );
    // F_a / (Z D^2) = 1.3717: X 0.44, Y 1.1910.
    assert_close("P", number(&found, "/p_n"), 440.0 + 2.0 * 1190.95, 1e-4);
    let table = crate::util::tables::Table::read(&dir, "out/balls.csv");
    let mean = |side: &str, power: f64| {
        let forces = table.column(&format!("{side}_force_n"));
        (forces.iter().map(|q| q.powf(power)).sum::<f64>() / forces.len() as f64).powf(1.0 / power)
    };
    let rings = [("inner", 3.0, "/q_ci_n"), ("outer", 10.0 / 3.0, "/q_ce_n")];
    let sum: f64 = rings
        .iter()
        .map(|(side, power, rating)| {
            let (load, rating) = (mean(side, *power), number(&found, rating));
            assert_close(side, number(&found, &format!("/{side}/q_e_n")), load, 1e-12);
            assert_close(side, number(&found, &format!("/{side}/q_c_n")), rating, 1e-15);
            (load / rating).powf(10.0 / 3.0)
        })
        .sum();
    let l10r = number(&found, "/l10r_revolutions");
    assert_close("L_10r", l10r, 1e6 * sum.powf(-0.9), 1e-12);
    let p_ref = number(&found, "/c_r_n") / (1e-6 * l10r).cbrt();
    assert_close("P_ref", number(&found, "/p_ref_n"), p_ref, 1e-12);
    let modified = number(&found, "/a_iso") * l10r;
    assert_close("L_nmr", number(&found, "/l_nmr_revolutions"), modified, 1e-12);
    let hours = l10r / (1800.0 * 60.0);
    assert_close("hours", number(&found, "/l10r_hours"), hours, 1e-12);
    assert_eq!(found["kappa"], 1.5);
    for (name, ending) in [("life_round", "svg"), ("life_round", "png")] {
        assert!(
            dir.path(&format!("out/figures/{name}.{ending}")).exists(),
            "{name}.{ending}"
        );
    }
    let svg = dir.text("out/figures/life_round.svg");
    assert_eq!(figure::clashes(&svg).unwrap(), Vec::<String>::new());
    // What the run itself found, and its page.
    let summary = crate::util::tables::summary(&dir, "out");
    for key in ["/l10r_revolutions", "/inner/q_e_n", "/l_nmr_revolutions"] {
        assert_eq!(number(&summary["life"], key), number(&found, key), "{key}");
    }
    assert_eq!(dir.raceway(&["report", "out"]).code, Some(0));
    let page = dir.text("out/report.html");
    assert!(page.contains("<h2>Life</h2>") && page.contains("P_ref, ISO 16281"));
    // Other life, same run.
    life(&dir, &["out", "--set", "life.reliability=95"]);
    let other = life_file(&dir, "out");
    assert_close(
        "L_nmr",
        number(&other, "/l_nmr_revolutions"),
        0.64 * modified,
        1e-12,
    );
    life(&dir, &["out", "--set", "life=none"]);
    let other = life_file(&dir, "out");
    assert_eq!(
        [&other["a_iso"], &other["kappa"], &other["l10r_hours"]],
        [&Value::Null; 3]
    );
    let notes = other["notes"].to_string();
    assert!(
        notes.contains("no a_ISO: no contamination factor: life.contamination"),
        "{notes}"
    );
    refused(
        &dir,
        &["out", "--set", "effects.axial_force.value=1 kN"],
        "a finished run keeps its scene; only life.* may be changed here",
    );
}

/// Wrong: the points of a sweep would have each other's lives.
#[test]
fn a_sweep_has_a_life_at_every_point() {
    let dir = scene(&LIFE.replace("[static]", SWEEP));
    let said = life(&dir, &["out"]);
    assert!(said.contains("effects.radial_force.value_n"), "{said}");
    let found = life_file(&dir, "out");
    let at = |point: usize, key: &str| number(&found, &format!("/sweep/points/{point}/{key}"));
    assert!((0..2).all(|i| at(i, "l10r_revolutions") > at(i + 1, "l10r_revolutions")));
    assert_eq!((at(1, "value"), at(2, "value")), (1e3, 4e3));
    assert_close(
        "last",
        number(&found, "/l10r_revolutions"),
        at(2, "l10r_revolutions"),
        1e-15,
    );
    let alone = scene(LIFE);
    life(&alone, &["out"]);
    let alone = number(&life_file(&alone, "out"), "/l10r_revolutions");
    assert_close("the same as alone", at(1, "l10r_revolutions"), alone, 1e-9);
    for name in ["life", "life_round"] {
        let svg = dir.text(&format!("out/figures/{name}.svg"));
        assert_eq!(figure::clashes(&svg).unwrap(), Vec::<String>::new(), "{name}");
    }
}

/// Wrong: counting passes through the whole program would differ from the static formula: under preload alone not at
/// all, under a radial force by how finely balls sample the raceway.
#[test]
fn a_turning_bearing_lives_as_the_one_at_rest() {
    let life_table = LIFE
        .replace("speed = \"1800 rpm\"\n", "")
        .replace("[static]", TURN);
    for (radial, tolerance) in [("0 kN", 1e-12_f64), ("1 kN", 1e-4)] {
        let force = format!("value = \"{radial}\"");
        let lives = [LIFE, &life_table].map(|analysis| {
            let text = with_line("[static]", "[static]", analysis);
            let dir = Dir::with_scene(&text.replace("value = \"1 kN\"", &force));
            dir.run("out", &RIGID);
            life(&dir, &["out"]);
            let found = life_file(&dir, "out");
            ["l10r_revolutions", "l10r_hours", "p_n"].map(|key| number(&found, &format!("/{key}")))
        });
        for (i, what) in ["L_10r", "hours", "P"].iter().enumerate() {
            assert_close(
                &format!("{what}, {radial}"),
                lives[0][i],
                lives[1][i],
                tolerance.max(1e-9 * i as f64),
            );
        }
    }
}

/// Wrong: two bearings of which one turns its outer ring would live alike under a radial force.
#[test]
fn the_ring_that_turns_spreads_its_damage() {
    let outer = TURN.replace("inner =", "outer =");
    let analysis = LIFE
        .replace("speed = \"1800 rpm\"\n", "")
        .replace("[static]", &outer);
    let dir = scene(&analysis);
    life(&dir, &["out"]);
    let found = life_file(&dir, "out");
    let gain = |side: &str| {
        let [even, life] =
            ["even_revolutions", "l10r_revolutions"].map(|key| number(&found, &format!("/{side}/{key}")));
        even / life - 1.0
    };
    // The equivalent forces of the two formulas differ by more than a per cent here.
    assert!(
        gain("inner") > 0.02 && gain("outer") < 1e-3,
        "{} {}",
        gain("inner"),
        gain("outer")
    );
}

/// Wrong: a load spectrum would not add damage by shares of turns. Rigid rings under preload alone have equal forces,
/// so 1/L is the sum of share over life.
#[test]
fn a_load_spectrum_adds_damage() {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", LIFE));
    for (out, force) in [("light", "1 kN"), ("heavy", "3 kN")] {
        let axial = format!("effects.axial_force.value={force}");
        let set = ["--set", &axial, "--set", "effects.radial_force=none"];
        dir.run(out, &[&RIGID[..], &set].concat());
        life(&dir, &[out]);
    }
    let spectrum = "title = \"shift\"\n[[conditions]]\nresults = \"light\"\nshare = 0.7\n\
                    [[conditions]]\nresults = \"heavy\"\nshare = 0.3\n";
    dir.write("spectrum.toml", spectrum);
    let said = life(&dir, &["--spectrum", "spectrum.toml", "--out", "both"]);
    assert!(
        said.contains("heavy: 0.3000 of time, 0.3000 of the turns"),
        "{said}"
    );
    let (light, heavy, both) = (
        life_file(&dir, "light"),
        life_file(&dir, "heavy"),
        life_file(&dir, "both"),
    );
    for key in [
        "/l10r_revolutions",
        "/l_nmr_revolutions",
        "/inner/l10r_revolutions",
        "/l10r_hours",
    ] {
        let [light, heavy, both] = [&light, &heavy, &both].map(|file| number(file, key));
        assert_close(key, 1.0 / both, 0.7 / light + 0.3 / heavy, 1e-12);
    }
    let p = [&light, &heavy].map(|file| number(file, "/p_n").powi(3));
    assert_close(
        "P",
        number(&both, "/p_n"),
        (0.7 * p[0] + 0.3 * p[1]).cbrt(),
        1e-12,
    );
    assert_eq!(both["conditions"].as_array().map(Vec::len), Some(2));
    let with = |from: &str, to: &str, expected: &str| {
        dir.write("bad.toml", spectrum.replacen(from, to, 1));
        refused(&dir, &["--spectrum", "bad.toml"], expected);
    };
    with(
        "0.3",
        "0.2",
        "bad.toml: the shares of time add up to 0.8999999999999999; expected 1",
    );
    with(
        "0.7",
        "-0.7",
        "the share of light is -0.7; expected a share of time above 0, at most 1",
    );
    with("share = 0.7", "", "has no key \"share\", which is required");
    with(
        "\"heavy\"",
        "\"nowhere\"",
        "condition nowhere: nowhere is no folder",
    );
    with(
        "share = 0.3",
        "share = 0.3\npoint = 4",
        "condition heavy: point is 4; the results have points 0 to 0",
    );
    with(
        "share = 0.3",
        "share = 0.3\nspeed = \"9 rpm\"",
        "condition heavy: speed is given, but the scene of the results has one",
    );
    with(
        "share = 0.3",
        "share = 0.3\nspeed = 9",
        "9 is a number without a unit",
    );
    dir.write("bad.toml", "title = \"none\"\nconditions = []\n");
    refused(
        &dir,
        &["--spectrum", "bad.toml"],
        "the spectrum has no [[conditions]]",
    );
    refused(&dir, &["--spectrum", "nowhere.toml"], "cannot read nowhere.toml");
}

/// Wrong: a spectrum of two bearings, or of conditions of unknown speeds, would have a life.
#[test]
fn conditions_of_a_spectrum_belong_together() {
    let dir = Dir::with_scene(SCENE);
    dir.run("plain", &RIGID);
    let run = |out: &str, table: &str| {
        dir.write("scene.toml", with_line("[static]", "[static]", table));
        dir.run(out, &RIGID);
    };
    run("rated", "[life]\nrating = \"20 kN\"\n\n[static]");
    run("fast", "[life]\nspeed = \"1800 rpm\"\n\n[static]");
    let spectrum = |other: &str, more: &str| {
        let text = format!(
            "conditions = [{{ results = \"plain\", share = 0.5{more} }}, {{ results = \"{other}\", share = 0.5 }}]"
        );
        dir.write("spectrum.toml", text);
    };
    spectrum("rated", "");
    let expected = "rated is of another bearing or rating than plain; expected the same in all conditions";
    refused(&dir, &["--spectrum", "spectrum.toml"], expected);
    spectrum("fast", "");
    let expected = "plain has no speed, other conditions do; give its speed, such as speed = \"1800 rpm\"";
    refused(&dir, &["--spectrum", "spectrum.toml"], expected);
    spectrum("fast", ", speed = \"600 rpm\"");
    let said = life(&dir, &["--spectrum", "spectrum.toml"]);
    assert!(
        said.contains("plain: 0.5000 of time, 0.2500 of the turns"),
        "{said}"
    );
}

/// Wrong: a rating would need a run, or not say where its numbers come from.
#[test]
fn a_rating_needs_no_run() {
    let dir = Dir::with_scene(SCENE);
    let said = life(&dir, &["--rating", "scene.toml", "--out", "rated"]);
    for part in [
        "dynamic rating C_r                26.59",
        "note: nominal contact angle 14.93 deg: the free contact angle",
        "no a_ISO: no contamination factor: life.contamination",
        "note: P is that of [effects.axial_force] and [effects.radial_force] alone",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let found = life_file(&dir, "rated");
    let expected = 1e6 * (number(&found, "/c_r_n") / number(&found, "/p_n")).powi(3);
    assert_close("L_10", number(&found, "/l10_revolutions"), expected, 1e-13);
    // A catalogue's own numbers.
    let set = ["--set", "life.rating=25 kN", "--set", "life.static_rating=20 kN"];
    life(
        &dir,
        &[&["--rating", "scene.toml", "--out", "rated"][..], &set].concat(),
    );
    let found = life_file(&dir, "rated");
    assert_eq!(
        [number(&found, "/c_r_n"), number(&found, "/c_0r_n")],
        [25e3, 20e3]
    );
    assert_close("C_u", number(&found, "/c_u_n"), 20e3 / 22.0, 1e-15);
    let without = [
        "--set",
        "effects.axial_force=none",
        "--set",
        "effects.radial_force=none",
    ];
    let said = life(&dir, &[&["--rating", "scene.toml"][..], &without].concat());
    assert!(
        said.contains("no P: the scene has no axial and no radial force"),
        "{said}"
    );
    let prescribed = life(&dir, &["--rating", "scene.toml", "--set", "shaft.z=10 um"]);
    assert!(
        prescribed.contains("no P: the scene prescribes where the shaft is, not its load"),
        "{prescribed}"
    );
    refused(
        &dir,
        &["--rating", "scene.toml", "--set", "life.reliability=91"],
        "life.reliability is 91",
    );
    let flat = ["--set", "bearing.outer_raceway_diameter=74.3 mm"];
    let expected = "ISO 281 rates radial bearings of 0 to 45 deg";
    refused(&dir, &[&["--rating", "scene.toml"][..], &flat].concat(), expected);
    assert!(!dir.raceway(&["life"]).stderr.is_empty());
    assert_eq!(
        dir.raceway(&["life", "out", "--rating", "scene.toml"]).code,
        Some(2)
    );
}

/// Wrong: a life would be counted from results that are damaged, unfinished or of something else, or a file of the
/// user's be lost.
#[test]
fn results_that_cannot_be_trusted_have_no_life() {
    let dir = scene(LIFE);
    refused(
        &dir,
        &["nowhere"],
        "nowhere is no folder; expected the results of a run",
    );
    std::fs::create_dir(dir.path("empty")).unwrap();
    refused(
        &dir,
        &["empty"],
        "empty has no summary.json; expected the results of a run that has ended",
    );
    let (summary, balls) = (dir.text("out/summary.json"), dir.text("out/balls.csv"));
    dir.write(
        "out/summary.json",
        summary.replacen("\"finished\"", "\"stopped: signal 15\"", 1),
    );
    refused(
        &dir,
        &["out"],
        "out holds a run that has not finished (stopped: signal 15); resume it, or run it again",
    );
    dir.write("out/summary.json", &summary[..summary.len() / 2]);
    refused(&dir, &["out"], "summary.json is damaged");
    dir.write("out/summary.json", &summary);
    dir.write("out/balls.csv", balls.replacen("0.", "1.", 1));
    refused(&dir, &["out"], "life is counted from whole results only");
    std::fs::remove_file(dir.path("out/balls.csv")).unwrap();
    refused(&dir, &["out"], "balls.csv");
    dir.write("out/balls.csv", &balls);
    dir.write("out/life.json", "mine");
    refused(
        &dir,
        &["out"],
        "life.json was not written by this command, so it is not written over",
    );
    std::fs::remove_file(dir.path("out/life.json")).unwrap();
    assert_eq!(
        [life(&dir, &["out"]).is_empty(), life(&dir, &["out"]).is_empty()],
        [false; 2]
    );
}

/// Wrong: a history in which nothing rolls would have a life.
#[test]
fn nothing_rolls_without_a_speed() {
    let still = "[life]\n\n[quasi_static]\nduration = \"1 ms\"\nstep = \"0.1 ms\"";
    let dir = scene(still);
    let summary = crate::util::tables::summary(&dir, "out");
    let notes = summary["life"]["notes"].to_string();
    assert!(
        notes.contains("no life: the rings do not turn against each other"),
        "{notes}"
    );
    refused(
        &dir,
        &["out"],
        "the rings do not turn against each other in this run",
    );
}

/// Wrong: an equilibrium could not be told that its inner ring stands, since [speed] would be refused in it: means of
/// the ball forces with the exponent 10/3 on the ring that stands, 3 on the one that turns.
#[test]
fn an_equilibrium_lives_by_the_ring_that_stands() {
    let table = LIFE.replace("speed = \"1800 rpm\"\n", "");
    let found = ["inner", "outer"].map(|ring| {
        let speed = format!("[speed]\n{ring} = \"1800 rpm\"\n\n[static]");
        let dir = scene(&table.replace("[static]", &speed));
        life(&dir, &["out"]);
        let forces = crate::util::tables::Table::read(&dir, "out/balls.csv").column("inner_force_n");
        let mean = |exponent: f64| {
            let powers = forces.iter().map(|force| force.powf(exponent));
            (powers.sum::<f64>() / forces.len() as f64).powf(1.0 / exponent)
        };
        let found = life_file(&dir, "out");
        assert!(number(&found, "/l10r_hours") > 0.0);
        (
            number(&found, "/inner/l10r_revolutions"),
            [mean(3.0), mean(10.0 / 3.0)],
        )
    });
    let [(turns, [mean, _]), (stands, [_, uneven])] = found;
    assert_close("inner ring", stands / turns, (mean / uneven).powi(3), 1e-9);
    assert!(stands < 0.99 * turns, "{stands} {turns}");
}
