//! The first hour of a new user: from an empty folder and a designation to a page of results.

use std::process::{Command, Stdio};

use crate::util::tables::Table;
use crate::util::{Dir, RIGID};

/// Whether Gmsh can be started here.
pub fn has_gmsh() -> bool {
    let mut gmsh = Command::new("gmsh");
    let outcome = gmsh
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    outcome.is_ok_and(|status| status.success())
}

/// `raceway` with these words, which must succeed.
#[track_caller]
fn done(dir: &Dir, words: &str) -> String {
    let outcome = dir.raceway(&words.split(' ').collect::<Vec<_>>());
    assert_eq!(outcome.code, Some(0), "raceway {words}: {}", outcome.stderr);
    outcome.stdout + &outcome.stderr
}

/// The forces of the balls balance the load of the scene that `init` writes: 3 kN of thrust, or 2 kN along +x.
#[track_caller]
fn assert_balance(dir: &Dir, results: &str, [thrust, radial]: [f64; 2]) {
    let balls = Table::read(dir, &format!("{results}/balls.csv"));
    let force = balls.column("inner_force_n");
    let angle = balls.column("inner_contact_angle_rad");
    let azimuth = balls.column("azimuth_rad");
    let mut sum = [0.0; 2];
    for ((q, a), phi) in force.iter().zip(&angle).zip(&azimuth) {
        sum[0] += q * a.sin();
        sum[1] += q * a.cos() * phi.cos();
    }
    // Contact angles turn with the deformed rings by less than 1e-3 rad.
    assert!((sum[0] - thrust).abs() < 2e-3 * (thrust + radial), "{sum:?}");
    assert!((sum[1] - radial).abs() < 2e-3 * (thrust + radial), "{sum:?}");
}

/// Wrong: a catalogue and this program would not be enough to get from a bearing to a figure.
#[test]
fn a_designation_leads_to_meshes_results_figures_and_a_page() {
    if !has_gmsh() {
        eprintln!("skipped: the meshes of this test are made by Gmsh, which is not installed");
        return;
    }
    for (designation, load) in [("7208", [3000.0, 0.0]), ("6206", [0.0, 2000.0])] {
        let dir = Dir::empty();
        let said = done(&dir, &format!("init {designation}"));
        let expected = format!(
            "{designation}.toml is written\n3 of its numbers are estimates, marked ESTIMATE: replace them by \
             those of a catalogue or a drawing\nnext: raceway mesh {designation}.toml, which needs Gmsh; then \
             raceway run \
             {designation}.toml\n"
        );
        assert_eq!(said, expected);
        assert!(done(&dir, &format!("mesh {designation}.toml")).contains("hex8 elements"));
        let said = done(&dir, &format!("run {designation}.toml"));
        assert!(said.contains("assumed: bearing: pitch_diameter and "), "{said}");
        assert!(!said.contains("warning: "), "{said}");
        let results = format!("results/{designation}");
        assert_balance(&dir, &results, load);
        done(&dir, &format!("plot {results}"));
        done(&dir, &format!("report {results}"));
        assert!(
            dir.path(&format!("{results}/figures/raceway_inner.png"))
                .is_file()
        );
        let page = dir.text(&format!("{results}/report.html"));
        assert!(page.contains(&format!("<h1>{designation}</h1>")) && page.contains("<svg"));
    }
}

/// Wrong: the scene of a designation could not be solved without Gmsh either, or the way to its meshes were not said.
#[test]
fn without_gmsh_rigid_rings_are_solved_and_missing_meshes_name_their_command() {
    for (designation, load) in [("7208", [3000.0, 0.0]), ("6206", [0.0, 2000.0])] {
        let dir = Dir::empty();
        done(&dir, &format!("init {designation}"));
        let scene = format!("{designation}.toml");
        let outcome = dir.raceway(&["run", &scene]);
        assert_eq!(outcome.code, Some(2));
        let expected = format!("build it with \"raceway mesh {scene}\", which needs Gmsh");
        assert!(outcome.stderr.contains(&expected), "{}", outcome.stderr);
        let patches = ["--set", "stress.near_field=false"];
        let run = [&["run", &scene, "--out", "out"][..], &RIGID, &patches].concat();
        let outcome = dir.raceway(&run);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert_balance(&dir, "out", load);
        let summary = dir.text("out/summary.json");
        assert!(summary.contains("\"assumed\": ["), "{summary}");
    }
}

/// Wrong: a scene on which a user has worked would be lost, or flags would not be read as quantities.
#[test]
fn init_replaces_nothing_and_takes_the_numbers_of_a_catalogue() {
    let dir = Dir::empty();
    dir.write("7208.toml", "mine");
    let outcome = dir.raceway(&["init", "7208"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("error: 7208.toml exists already; give another file with --out"),
        "{}",
        outcome.stderr
    );
    assert_eq!(dir.text("7208.toml"), "mine");
    let outcome = dir.raceway(&["init", "7208", "--out", "own one.toml"]);
    let next = "next: raceway mesh 'own one.toml', which needs Gmsh; then raceway run 'own one.toml'";
    assert!(
        outcome.stdout.contains(next),
        "Wrong: no shell takes it: {}",
        outcome.stdout
    );
    let flags = [
        "--balls",
        "14",
        "--ball-diameter",
        "11.906 mm",
        "--pitch-diameter",
        "60 mm",
    ];
    let outcome = dir.raceway(&[&["init", "7208", "--out", "b.toml"], &flags[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let text = dir.text("b.toml");
    assert!(
        text.contains("ball_diameter = \"11.906 mm\"") && text.contains("mesh = \"b_inner.msh\""),
        "{text}"
    );
    let cases = [
        (
            &["init", "7208", "--bore", "40"][..],
            "\"40\" has no unit; expected a length such as \"9 mm\"",
        ),
        (
            &["init", "NU206", "--out", "c.toml"],
            "error: \"NU206\" is no bearing that is known here; expected a series",
        ),
        (
            &["init", "7208", "--balls", "0"],
            "invalid value '0' for '--balls <BALLS>': 0 is not in 3..=1000",
        ),
        (
            &["init", "--out", "c.toml"],
            "error: --bore is missing; expected a series 60, 62, 63, 618, 619, 70, 72, 73, 718 or 719",
        ),
        (
            &["init", "6206", "--ball-diameter", "18 mm", "--out", "c.toml"],
            "bearing.width is 16 mm; it must be at least the ball diameter 18 mm",
        ),
    ];
    for (arguments, part) in cases {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(
            outcome.stderr.contains(part),
            "{part}\nis not in\n{}",
            outcome.stderr
        );
        assert!(!dir.path("c.toml").exists());
    }
}

/// Wrong: a designation as catalogues print it would have to be quoted, or flags have no short names.
#[test]
fn init_takes_a_designation_of_several_words() {
    let dir = Dir::empty();
    let said = done(&dir, "init 7014 ACD/P4A");
    assert!(said.starts_with("7014_acd_p4a.toml is written\n"), "{said}");
    let text = dir.text("7014_acd_p4a.toml");
    assert!(
        text.contains("title = \"7014 ACD/P4A\"") && text.contains("contact_angle = \"25 deg\""),
        "{text}"
    );
    done(&dir, "init 6203-2RS1/C3 --clearance 12um --out a.toml");
    assert!(dir.text("a.toml").contains("radial_clearance = \"12 um\""));
    done(&dir, "init 7208 --angle 30deg --out b.toml");
    assert!(dir.text("b.toml").contains("contact_angle = \"30 deg\""));
    let help = done(&dir, "help init");
    let place = |option: &str| help.find(option).unwrap_or_else(|| panic!("{option}\n{help}"));
    assert!(
        place("--width") < place("--threads") && place("--out") < place("--json"),
        "{help}"
    );
}

/// Wrong: help would not find a key of a scene, or end with a success for a word that it does not know.
#[test]
fn help_has_commands_and_keys_of_scenes() {
    let dir = Dir::empty();
    assert!(done(&dir, "help scene").starts_with("# Reference of scenes\n"));
    let said = done(&dir, "help scene pitch_diameter");
    assert!(
        said.starts_with("[bearing] ") && said.contains("contact_angle = \"40 deg\""),
        "{said}"
    );
    // A word in the middle of a name, or behind a dot.
    let said = done(&dir, "help scene gauge");
    assert!(said.starts_with("[probes.gauge.g1] "), "{said}");
    let said = done(&dir, "help scene harmonic");
    assert!(said.contains("schedule.harmonic = { frequency = "), "{said}");
    assert!(done(&dir, "help mesh").contains("Usage: raceway mesh"));
    let cases = [
        (
            &["help", "scene", "cheese"][..],
            "error: no table and no key of a scene has the name \"cheese\"; expected one such as bearing, shaft.z or \
             contact_angle, and raceway help scene lists all",
        ),
        (
            &["help", "cheese"],
            "error: there is no command \"cheese\"; commands are init, run, ",
        ),
    ];
    for (arguments, part) in cases {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(
            outcome.stderr.contains(part),
            "{part}\nis not in\n{}",
            outcome.stderr
        );
    }
}

/// Wrong: a package would have no man page and no completions, or they would lack a command.
#[test]
fn completions_and_the_man_page_know_the_commands() {
    let dir = Dir::empty();
    let man = done(&dir, "man");
    assert!(
        man.contains(".TH raceway 1") && man.contains("\\-\\-threads"),
        "{man}"
    );
    // The pages that it names are there.
    let said = done(&dir, "man --out man/man1");
    let names = man.replace("\\-", "-");
    let named = names.lines().filter_map(|line| line.strip_suffix("(1)"));
    let named: Vec<&str> = named.filter(|name| name.starts_with("raceway-")).collect();
    assert!(
        said.contains(&format!("{} man pages in man/man1", named.len() + 1)),
        "{said}"
    );
    for name in named {
        let page = dir.text(&format!("man/man1/{name}.1"));
        assert!(
            page.contains(&format!(".TH {name} 1")) && page.contains("quiet"),
            "{page}"
        );
    }
    dir.write("file", "");
    let refused = dir.raceway(&["man", "--out", "file"]);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused
            .stderr
            .starts_with("error: cannot write man pages into file: "),
        "{}",
        refused.stderr
    );
    let words = [
        done(&dir, "completions bash"),
        done(&dir, "completions fish"),
        man,
    ];
    for text in words {
        for command in ["init", "run", "resume", "mesh", "report"] {
            assert!(text.contains(command), "no {command} in\n{text}");
        }
    }
}
